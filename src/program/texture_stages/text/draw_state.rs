//! Render states for which a scene's draw has fields: what to write there.

use crate::calls::{Part, PartKind, Value, without_prefix};
use crate::finding::warning;
use crate::{Aside, Span};
use ninebit::state::{BlendEquation, BlendFactor, CompareFunction, Named as _, StencilOperation};

/// A field of the draw, the states that it stands for, by name and D3DRS value, and a function that returns the field as a scene writes it for the
/// values of the states; `None` if the draw's default means the same. The first of several states switches the others on.
type Group = (&'static str, &'static [(&'static str, u32)], fn(&Values) -> Option<String>);

const GROUPS: [Group; 8] = [
    ("blend", &[("AlphaBlendEnable", 27), ("SrcBlend", 19), ("DestBlend", 20), ("BlendOp", 171)], blend),
    ("alpha_test", &[("AlphaTestEnable", 15), ("AlphaRef", 24), ("AlphaFunc", 25)], alpha_test),
    ("depth_test", &[("ZEnable", 7), ("ZWriteEnable", 14), ("ZFunc", 23)], depth_test),
    (
        "stencil_test",
        &[
            ("StencilEnable", 52),
            ("StencilFail", 53),
            ("StencilZFail", 54),
            ("StencilPass", 55),
            ("StencilFunc", 56),
            ("StencilRef", 57),
            ("StencilMask", 58),
            ("StencilWriteMask", 59),
        ],
        stencil_test,
    ),
    (
        "fog",
        &[
            ("FogEnable", 28),
            ("FogColor", 34),
            ("FogTableMode", 35),
            ("FogStart", 36),
            ("FogEnd", 37),
            ("FogDensity", 38),
            ("RangeFogEnable", 48),
            ("FogVertexMode", 140),
        ],
        fog,
    ),
    ("cull", &[("CullMode", 22)], cull),
    ("shade_model", &[("ShadeMode", 9)], shade_model),
    ("color_mask", &[("ColorWriteEnable", 168)], color_mask),
];

/// Returns the names of all these states.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    GROUPS.iter().flat_map(|(_, states, _)| states.iter().map(|(name, _)| *name))
}

/// Names of the API's render states that are skipped.
pub(super) const OTHER_STATES: &str = "Lighting Ambient LocalViewer ColorVertex NormalizeNormals \
    DiffuseMaterialSource SpecularMaterialSource AmbientMaterialSource EmissiveMaterialSource \
    DitherEnable FillMode LastPixel LinePattern Clipping ClipPlaneEnable \
    ZBias ZVisible DepthBias SlopeScaleDepthBias EdgeAntialias Antialias MultisampleAntialias MultisampleMask \
    TextureHandle TexturePerspective TextureMapBlend TextureMag TextureMin TextureAddress \
    MonoEnable Rop2 PlaneMask SubPixel StippledAlpha StippleEnable ColorKeyEnable Extents \
    VertexBlend IndexedVertexBlendEnable TweenFactor PointSize PointSize_Min PointSize_Max \
    PointSpriteEnable PointScaleEnable PointScale_A PointScale_B PointScale_C \
    SoftwareVertexProcessing PatchEdgeStyle PatchSegments DebugMonitorToken ScissorTestEnable SRGBWriteEnable \
    BlendFactor SeparateAlphaBlendEnable SrcBlendAlpha DestBlendAlpha BlendOpAlpha TwoSidedStencilMode \
    Wrap0 Wrap1 Wrap2 Wrap3 Wrap4 Wrap5 Wrap6 Wrap7 VertexShader PixelShader";

/// Returns what to write instead of one of [`OTHER_STATES`].
pub(super) fn instead(state: &str) -> &'static str {
    match state {
        "Lighting" | "Ambient" | "ColorVertex" | "NormalizeNormals" => {
            "nothing is lit here: give the vertices the colours that they have once they are lit"
        }
        "LocalViewer" => "the draw's `viewer` says it: `Local`, or `Infinite(0, 0, 1)`",
        "TexturePerspective" => "the draw's `perspective` says it",
        "DitherEnable" => "the draw's `dither` can only be `false`: what the chip does is not known",
        "ScissorTestEnable" => "the draw's `scissor` has the rectangle",
        "BlendFactor" => "the draw's `blend_constant` has the colour",
        "PixelShader" => "write a pixel shader as the draw's `program: PixelShader(...)`",
        "VertexShader" => "write a vertex program as the draw's `vertices: Program(text: ...)`",
        _ => "no field of a scene says it",
    }
}

/// The value of a state: a word without its prefix, a number, or something else.
#[derive(Clone, Debug)]
enum StateValue {
    Word(String),
    Number(u32),
    Other,
}

/// Values of states by name, in the order of their last statements.
type Values = Vec<(&'static str, StateValue)>;

/// What the text says about the draw.
#[derive(Debug, Default)]
pub(super) struct DrawStates {
    /// For each group, the place of its first state, and the values.
    groups: [Option<(Span, Values)>; GROUPS.len()],
}

impl DrawStates {
    /// Takes a state if it belongs to a group. Returns whether it does.
    pub(super) fn take(&mut self, name: &str, number: Option<u32>, span: &Span, value: &Value<'_>) -> bool {
        for ((_, states, _), slot) in GROUPS.iter().zip(&mut self.groups) {
            let found = states.iter().find(|(known, n)| known.eq_ignore_ascii_case(name) || number == Some(*n));
            if let Some((name, _)) = found {
                let (_, values) = slot.get_or_insert_with(|| (span.clone(), Vec::new()));
                values.retain(|(known, _)| known != name);
                values.push((*name, state_value(value)));
                return true;
            }
        }
        false
    }

    /// Returns a warning for each field, for draws that do not have it.
    pub(super) fn asides(self) -> Vec<Aside> {
        let groups = GROUPS.into_iter().zip(self.groups);
        let asides = groups.filter_map(|((field, states, written), taken)| {
            let (span, values) = taken?;
            if states.len() > 1 && off(&values, states[0].0) {
                return None;
            }
            let written = written(&values)?;
            let names: Vec<String> = values.iter().map(|(name, _)| name.to_uppercase()).collect();
            let (last, rest) = names.split_last()?;
            let message = match rest {
                [] => format!("{last} is a state of the draw"),
                _ => format!("{} and {last} are states of the draw", rest.join(", ")),
            };
            let help = format!("write it in the draw: `{written}`");
            let finding = warning("NB0918", span, message, "no part of a pixel program", help);
            Some(Aside { finding, field: Some(field) })
        });
        asides.collect()
    }
}

fn state_value(value: &Value<'_>) -> StateValue {
    const PREFIXES: &[&str] = &["D3DBLENDOP_", "D3DBLEND_", "D3DCMP_", "D3DCULL_", "D3DSHADE_", "D3DFOG_", "D3DZB_"];
    match &value.parts[..] {
        [Part { kind: PartKind::Integer(number), .. }] => StateValue::Number(*number),
        [Part { kind: PartKind::Name, text, .. }] => {
            StateValue::Word(without_prefix(text, PREFIXES).1.to_ascii_uppercase())
        }
        _ => StateValue::Other,
    }
}

fn find<'v>(values: &'v Values, name: &str) -> Option<&'v StateValue> {
    values.iter().find(|(known, _)| *known == name).map(|(_, value)| value)
}

/// Returns whether a state is switched off.
fn off(values: &Values, name: &str) -> bool {
    match find(values, name) {
        Some(StateValue::Number(0)) => true,
        Some(StateValue::Word(word)) => word == "FALSE",
        _ => false,
    }
}

/// Values of a state: the API's names, in the order of its numbers from 1, and the scene's names.
type Named = (&'static str, &'static [&'static str]);

const FACTORS: Named = (
    "ZERO ONE SRCCOLOR INVSRCCOLOR SRCALPHA INVSRCALPHA DESTALPHA INVDESTALPHA DESTCOLOR INVDESTCOLOR SRCALPHASAT",
    BlendFactor::NAMES,
);
const EQUATIONS: Named = ("ADD SUBTRACT REVSUBTRACT MIN MAX", BlendEquation::NAMES);
const FUNCTIONS: Named = ("NEVER LESS EQUAL LESSEQUAL GREATER NOTEQUAL GREATEREQUAL ALWAYS", CompareFunction::NAMES);
const OPERATIONS: Named = ("KEEP ZERO REPLACE INCRSAT DECRSAT INVERT INCR DECR", StencilOperation::NAMES);

/// Returns the scene's name of a state's value.
fn named(values: &Values, state: &str, (api, scene): Named, default: &'static str) -> String {
    let found = match find(values, state) {
        Some(StateValue::Number(number)) => (0..api.split(' ').count()).nth((*number as usize).wrapping_sub(1)),
        Some(StateValue::Word(word)) => api.split(' ').position(|known| known == word),
        Some(StateValue::Other) => None,
        None => return default.to_owned(),
    };
    found.and_then(|number| scene.get(number)).copied().unwrap_or("...").to_owned()
}

fn blend(values: &Values) -> Option<String> {
    let equation = match named(values, "BlendOp", EQUATIONS, "Add").as_str() {
        "Add" => String::new(),
        other => format!("equation: {other}, "),
    };
    let [source, destination] =
        [("SrcBlend", "One"), ("DestBlend", "Zero")].map(|(state, default)| named(values, state, FACTORS, default));
    Some(format!("blend: ({equation}source: {source}, destination: {destination})"))
}

fn alpha_test(values: &Values) -> Option<String> {
    let reference = match find(values, "AlphaRef") {
        Some(StateValue::Number(number)) => (number & 255).to_string(),
        Some(_) => "...".to_owned(),
        None => "0".to_owned(),
    };
    let function = named(values, "AlphaFunc", FUNCTIONS, "Always");
    Some(format!("alpha_test: (function: {function}, reference: {reference})"))
}

fn depth_test(values: &Values) -> Option<String> {
    let function = named(values, "ZFunc", FUNCTIONS, "LessOrEqual");
    Some(format!("depth_test: (function: {function}, write: {})", !off(values, "ZWriteEnable")))
}

fn stencil_test(values: &Values) -> Option<String> {
    let mut fields = Vec::new();
    let mut field = |name: &str, state: &'static str, names: Option<Named>| {
        let Some(value) = find(values, state) else { return };
        fields.push(match (names, value) {
            (Some(names), _) => format!("{name}: {}", named(values, state, names, "...")),
            (None, StateValue::Number(number)) => format!("{name}: {}", number & 255),
            (None, StateValue::Word(_) | StateValue::Other) => format!("{name}: ..."),
        });
    };
    field("function", "StencilFunc", Some(FUNCTIONS));
    field("reference", "StencilRef", None);
    field("mask", "StencilMask", None);
    field("write_mask", "StencilWriteMask", None);
    field("fail", "StencilFail", Some(OPERATIONS));
    field("depth_fail", "StencilZFail", Some(OPERATIONS));
    field("pass", "StencilPass", Some(OPERATIONS));
    Some(format!("stencil_test: ({})", fields.join(", ")))
}

fn fog(values: &Values) -> Option<String> {
    const MODES: Named = ("EXP EXP2 LINEAR", &["Exp", "Exp2", "Linear"]);
    let none = |state| match find(values, state) {
        None | Some(StateValue::Number(0)) => true,
        Some(StateValue::Word(word)) => word == "NONE",
        Some(StateValue::Number(_) | StateValue::Other) => false,
    };
    let (table, vertex) = (!none("FogTableMode"), !none("FogVertexMode"));
    let mut fields = Vec::new();
    if table || vertex {
        let mode = named(values, if table { "FogTableMode" } else { "FogVertexMode" }, MODES, "Linear");
        let coordinate = match (table, off(values, "RangeFogEnable") || find(values, "RangeFogEnable").is_none()) {
            (true, _) => "evaluation: PerPixel, coordinate_source: W",
            (false, true) => "evaluation: PerVertex, coordinate_source: EyePlaneAbsolute",
            (false, false) => "evaluation: PerVertex, coordinate_source: EyeRadial",
        };
        let range = if mode.starts_with("Exp") { "density: ..." } else { "start: ..., end: ..." };
        fields.extend([format!("mode: {mode}"), range.to_owned(), coordinate.to_owned()]);
    }
    let color = match find(values, "FogColor") {
        Some(StateValue::Number(number)) => {
            let [_, r, g, b] = number.to_be_bytes();
            format!("({r}, {g}, {b})")
        }
        Some(_) => "...".to_owned(),
        None => "(0, 0, 0)".to_owned(),
    };
    fields.push(format!("color: {color}"));
    Some(format!("fog: ({})", fields.join(", ")))
}

fn cull(values: &Values) -> Option<String> {
    let names: Named = ("NONE CW CCW", &["None", "Clockwise", "CounterClockwise"]);
    match named(values, "CullMode", names, "None").as_str() {
        "None" => None,
        // The API says which faces are culled; in a scene those are the back faces, so the front is the other winding.
        "Clockwise" => Some("cull: Back".to_owned()),
        "CounterClockwise" => Some("cull: Back, front_face: Clockwise".to_owned()),
        other => Some(format!("cull: {other}")),
    }
}

fn shade_model(values: &Values) -> Option<String> {
    let names: Named = ("FLAT GOURAUD PHONG", &["Flat", "Smooth", "Smooth"]);
    let mode = named(values, "ShadeMode", names, "Smooth");
    (mode != "Smooth").then(|| format!("shade_model: {mode}, provoking_vertex: First"))
}

fn color_mask(values: &Values) -> Option<String> {
    match find(values, "ColorWriteEnable") {
        Some(StateValue::Number(bits)) if bits & 15 == 15 => None,
        Some(StateValue::Number(bits)) => {
            let channels = [1, 2, 4, 8].map(|bit| (bits & bit != 0).to_string());
            Some(format!("color_mask: ({})", channels.join(", ")))
        }
        _ => Some("color_mask: (true, true, true, true)".to_owned()),
    }
}
