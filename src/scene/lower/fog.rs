//! Lowers the fog of a draw: its colour, its function, and the source of the function's coordinate.

use super::*;
use ninebit::vertex::fog::{FogEvaluation, FogSource, exponential, linear};

/// The fog of a draw.
pub(super) struct FogFields {
    /// State of the pixel pipe. If it has no function, the vertices give fog factors.
    pub(super) state: Fog,
    /// Source of the function's coordinate.
    pub(super) source: FogSource,
    /// Place of the function in the text.
    pub(super) place: Span,
}

/// Reads the fog of a draw.
pub(super) fn fog<'a>(reader: &mut Reader<'a>, raw: &Option<Raw<'a, source::Fog<'a>>>) -> FogFields {
    let chip = match reader.profile {
        Profile::Nv10 => FogEvaluation::PerVertex,
        Profile::Nv2a => FogEvaluation::PerPixel,
    };
    let fields = raw.as_ref().and_then(|raw| reader.read(raw)).unwrap_or_default();
    let [r, g, b, _] = color::bytes(fields.color(reader));
    let state = Fog { enabled: raw.is_some() && fields.enabled(reader), color: [r, g, b], function: None };
    let mut fog = FogFields { state, source: fields.coordinate_source(reader), place: 0..0 };
    let Some(raw) = &fields.mode else {
        if let Some((name, text)) = fields.written().find(|(name, _)| !["enabled", "color"].contains(name)) {
            let message = format!("`{name}` says nothing without a `mode`");
            let help = "add `mode: Linear` (or Exp, Exp2); without a mode the vertices give factors in `fog`";
            reader.push(finding("NB0223", reader.range(text), message, "belongs to a fog function", help));
        }
        return fog;
    };
    fog.place = reader.span(raw);
    let evaluation = fields.evaluation.and_then(|raw| reader.name(&raw)).unwrap_or(chip);
    let each_pixel = evaluation == FogEvaluation::PerPixel;
    reader.needs_nv2a(&fields.evaluation, each_pixel, "NB0324", ("linear fog of each pixel", "INT-5n"));
    if let Some(mode) = reader.name(raw) {
        let absolute = mode == FogMode::LinearAbs;
        reader.needs_nv2a(&fields.mode, absolute, "NB0324", ("fog mode LinearAbs", "INT-5n"));
        fog.state.function = function(reader, &fields, mode, evaluation, &fog.place);
    }
    fog
}

/// Reads the parameters of a mode, or computes them from the range or density.
fn function<'a>(
    reader: &mut Reader<'a>,
    fields: &source::Fog<'a>,
    mode: FogMode,
    evaluation: FogEvaluation,
    place: &Span,
) -> Option<FogFunction> {
    let straight = mode.is_linear();
    let numbers = [(&fields.start, "start"), (&fields.end, "end"), (&fields.density, "density")];
    let (fitting, other) = if straight { ("`start` and `end`", &numbers[2..]) } else { ("`density`", &numbers[..2]) };
    for (field, name) in other {
        if let Some(raw) = field {
            let message = format!("{} fog has no `{name}`", mode.name());
            let help = format!("{} takes {fitting}, or `parameters: (p0, p1, p2)`", mode.name());
            return reader.refuse(finding("NB0223", reader.span(raw), message, "does not go with this mode", help));
        }
    }
    if let Some(raw) = &fields.parameters {
        if let Some(field) = numbers.iter().find_map(|(field, _)| field.as_ref()) {
            let message = "fog has `parameters` or a range or density, not both";
            let found = Diagnostic::error("NB0223", reader.span(field), message).label("one or the other");
            return reader.refuse(found.related(reader.span(raw), "the parameters"));
        }
        let [p0, p1, p2, _] = fields.parameters(reader)?;
        let per_vertex = evaluation == FogEvaluation::PerVertex;
        if p2 != 0.0 && straight && !per_vertex {
            let message = format!("{} fog of each pixel has no third parameter", mode.name());
            let label = "p2 multiplies the square of the coordinate";
            let help = "write two parameters, take an exponential mode, or `evaluation: PerVertex`";
            return reader.refuse(finding("NB0223", reader.span(raw), message, label, help).rule("FOG-2"));
        }
        return Some(FogFunction { mode, p0, p1, p2, per_vertex });
    }
    let function = if straight {
        linear(mode, fields.start(reader), fields.end(reader), evaluation)
    } else {
        Some(exponential(mode, fields.density(reader), evaluation))
    };
    if function.is_some() {
        return function;
    }
    let message = "the parameters of this fog are not finite";
    let label = "start and end too close together, or too far away";
    let help = "write `start` and `end` the same for a wall of fog, or further apart";
    reader.refuse(finding("NB0207", place.clone(), message, label, help).rule("FOG-2"))
}
