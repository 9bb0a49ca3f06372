//! Lowers `TextureEnvironment(...)`: the OpenGL texture environment.

use super::api_program::{ApiProgram, name_at};
use super::program::{Asides, calls, pasted};
use super::*;
use crate::reader::Name;
use crate::source::List;
use ninebit_program::Spanned;
use ninebit_program::texture_environment::{self, Half, Mode, TextureEnvironment, Unit};

/// Reads the fields in the parentheses.
pub(super) fn read<'a>(reader: &mut Reader<'a>, text: &'a str, asides: &mut Asides) -> Option<ApiProgram> {
    let fields = reader.read(&Raw::<source::TextureEnvironment<'a>>::new(text))?;
    let units = reader.place(&fields.units);
    let written = calls(reader, units, &fields.text, &fields.file, ("a texture environment is", "units"))?;
    let mut program = match &written {
        None => TextureEnvironment::default(),
        Some(written) => pasted(reader, written, texture_environment::parse(&written.text), asides)?,
    };
    program.color_sum = fields.color_sum.and_then(|raw| reader.read(&raw)).unwrap_or(program.color_sum);
    for raw in fields.units.as_ref().and_then(|raw| reader.read(raw)).unwrap_or_default() {
        let place = reader.opening(raw.text);
        let Some(fields) = reader.read(&raw) else { continue };
        program.units.push(unit(reader, &fields, place));
    }
    Some(ApiProgram::Environment(program, written))
}

fn unit<'a>(reader: &mut Reader<'a>, fields: &source::EnvironmentUnit<'a>, place: Span) -> Unit {
    let mut unit = Unit { span: place, ..Unit::initial() };
    unit.mode = fields.mode(reader);
    name_at(reader, &fields.combine_rgb, &mut unit.rgb.function);
    name_at(reader, &fields.combine_alpha, &mut unit.alpha.function);
    list(reader, &fields.sources_rgb, &mut unit.rgb.sources, "sources");
    list(reader, &fields.sources_alpha, &mut unit.alpha.sources, "sources");
    list(reader, &fields.operands_rgb, &mut unit.rgb.operands, "operands");
    list(reader, &fields.operands_alpha, &mut unit.alpha.operands, "operands");
    scale(reader, &fields.scale_rgb, &mut unit.rgb);
    scale(reader, &fields.scale_alpha, &mut unit.alpha);
    unit.color = color::bytes(fields.color(reader));
    unit.base_format = fields.base_format.as_ref().and_then(|raw| reader.name(raw));
    combine_only(reader, fields, unit.mode);
    unit
}

/// Reads a list of at most four values; values that are not listed keep their defaults.
fn list<'a, T: Named>(
    reader: &mut Reader<'a>,
    raw: &Option<Raw<'a, List<'a, Name<T>>>>,
    slots: &mut [Spanned<T>; 4],
    what: &str,
) {
    let Some(raw) = raw else { return };
    let list = reader.read(raw).unwrap_or_default();
    if list.len() > slots.len() {
        let message = format!("a unit has at most 4 {what}, not {}", list.len());
        reader.push(Diagnostic::error("NB0211", reader.span(raw), message).label("too many"));
    }
    for (slot, raw) in slots.iter_mut().zip(list) {
        name_at(reader, &Some(raw), slot);
    }
}

fn scale<'a>(reader: &mut Reader<'a>, raw: &Option<Raw<'a, u32>>, half: &mut Half) {
    let Some(raw) = raw else { return };
    half.scale = match reader.read(raw) {
        Some(1) | None => Scale::One,
        Some(2) => Scale::Two,
        Some(4) => Scale::Four,
        Some(other) => {
            let message = format!("a scale cannot be {other}");
            reader.push(finding("NB0206", reader.span(raw), message, "out of range", "write 1, 2 or 4"));
            Scale::One
        }
    };
}

/// Refuses fields that the unit's mode does not read because it does not combine: they were meant to do something.
fn combine_only<'a>(reader: &mut Reader<'a>, fields: &source::EnvironmentUnit<'a>, mode: Mode) {
    if matches!(mode, Mode::Combine | Mode::Combine4) {
        return;
    }
    let others = ["mode", "color", "base_format"];
    if let Some((_, text)) = fields.written().find(|(name, _)| !others.contains(name)) {
        let place = reader.range(text);
        let message = format!("mode {} does not combine", mode.name());
        let help = "write `mode: Combine`, or leave this out";
        reader.push(finding("NB0355", place, message, "read in modes Combine and Combine4 only", help));
    }
}
