//! Recipes for OpenGL's stencil, fog, depth textures and volume textures.
#![allow(clippy::float_arithmetic, reason = "coordinates that OpenGL is handed")]

use super::fixed::drawn;
use super::{Case, Contribution, Draw, Path, Placement, byte};
use ninebit::state::{AddressMode, DepthFormat, ShadowReference, StencilOperation};
use std::f32::consts::LN_2;

/// Returns the binary32 number that a word encodes, or `None` if it is not finite.
fn number(bits: i64) -> Option<f32> {
    u32::try_from(bits).ok().map(f32::from_bits).filter(|value| value.is_finite())
}

/// Returns r and q of the row, or `None` if a card may not be able to represent r/q.
fn projected(case: &Case) -> Option<[f32; 2]> {
    let [r, q] = case.numbers(["in.r", "in.q"]).map(number);
    let (r, q) = (r?, q?);
    (q > 0.0 && (2.0_f32.powi(-20)..=2.0_f32.powi(20)).contains(&q) && (r / q).abs() <= 2.0_f32.powi(24))
        .then_some([r, q])
}

fn bytes(values: [f32; 2]) -> Vec<u8> {
    values.map(f32::to_le_bytes).concat()
}

/// OpenGL's names of stencil operations, in the order of their values.
pub(super) const STENCIL_OPERATIONS: &str = "KEEP ZERO REPLACE INCR DECR INVERT INCR_WRAP DECR_WRAP";

/// Reads the stored byte from the stencil. A second draw without a depth test, whose fragments have the colour 1, shows whether the test passes.
pub(super) fn stencil_test(case: &Case) -> Option<Placement> {
    let function = case.word("cfg.function", super::fixed::FUNCTIONS);
    let operations = ["cfg.fail", "cfg.depth_fail", "cfg.pass"];
    let words = operations.map(|name| case.word(name, STENCIL_OPERATIONS));
    let wraps = operations.map(|name| case.choice::<StencilOperation>(name));
    let wraps = wraps.iter().any(|op| matches!(op, StencilOperation::Increment | StencilOperation::Decrement));
    let names = ["in.reference", "in.mask", "in.write_mask", "in.stored", "in.depth_passes"];
    let row = names.map(|name| byte(case.number(name)));
    let row = row.into_iter().collect::<Option<Vec<u8>>>()?;
    let draw = |depth_test: u8, read| Draw {
        state: vec![format!("stencil {function} {}", words.join(" ")), format!("depth_test {depth_test}")],
        reads: vec![read],
        combiners: None,
    };
    let needs = if wraps { vec!["GL_EXT_stencil_wrap"] } else { vec![] };
    let sources = vec![("primary", vec![1; 4]), ("stencil0", row)];
    let draws = vec![draw(1, Contribution::byte("out.stored", 4)), draw(0, Contribution::byte("out.passes", 0))];
    Some(Placement { draws, ..drawn(Path::Common, needs, vec![], sources, vec![]) })
}

/// Draws white in black fog of density 1. The coordinate is that of the middle of the step, so that small errors of a driver's parameters do not
/// matter.
pub(super) fn fog_table(case: &Case) -> Option<Placement> {
    let steps = case.number("in.steps");
    let below = f32::from(i16::try_from(-steps).ok()?);
    let below = if steps == 0 { 0.0 } else { below - 0.5 };
    let (mode, d) = match case.word("cfg.mode", "EXP EXP2") {
        "EXP" => ("EXP", below * LN_2 / 256.0),
        "EXP2" => ("EXP2", below / 4096.0 * (32.0 * LN_2).sqrt()),
        _ => return None,
    };
    let sources = vec![("fog0", d.to_le_bytes().to_vec())];
    let (needs, state) = (vec!["GL_EXT_fog_coord"], vec![format!("fog {mode}")]);
    (steps <= 0).then(|| drawn(Path::Common, needs, state, sources, vec![Contribution::byte("out.byte", 0)]))
}

/// OpenGL's words for texels of [`DepthFormat::Z16`].
const Z16: &str = "DEPTH_COMPONENT16 DEPTH_COMPONENT UNSIGNED_SHORT";

/// Compares a texel of a depth texture. r is passed as a fraction of the deepest depth; rows where r is near a step are only asked if the texel
/// differs from it by more than one.
pub(super) fn shadow_comparison(case: &Case) -> Option<Placement> {
    let ([r, q], depth) = (projected(case)?, case.number("in.depth"));
    let (format, texel) = match case.choice("cfg.format") {
        DepthFormat::Z16 => (Z16, (depth as u16).to_le_bytes().to_vec()),
        DepthFormat::Z24S8 => {
            ("DEPTH_COMPONENT24 DEPTH_COMPONENT UNSIGNED_INT", ((depth << 8) as u32).to_le_bytes().to_vec())
        }
        _ => return None,
    };
    let deepest = if texel.len() == 2 { 65_535.0 } else { 16_777_215.0 };
    let (at, word) = (r / q, case.number("mid.reference"));
    let is_clear = (0.125..=0.875).contains(&at.fract()) && at < 65_536.0 || (word - depth).abs() > 1;
    if case.choice::<ShadowReference>("cfg.reference") != ShadowReference::R
        || !(0.0..=deepest).contains(&at)
        || !is_clear
    {
        return None;
    }
    Some(compared(case, format, vec![("texture0", texel), ("projected0", bytes([r / deepest, q]))]))
}

/// Compares texels of a depth format by the function of the row.
fn compared(case: &Case, format: &str, sources: Vec<(&'static str, Vec<u8>)>) -> Placement {
    let function = case.word("cfg.function", super::fixed::FUNCTIONS);
    let mut needs = vec!["GL_ARB_depth_texture", "GL_ARB_shadow"];
    if !matches!(function, "LEQUAL" | "GEQUAL") {
        needs.push("GL_EXT_shadow_funcs");
    }
    let parameters = [("MODE", "COMPARE_R_TO_TEXTURE"), ("FUNC", function)];
    let parameters = parameters.map(|(name, value)| format!("parameter 0 TEXTURE_COMPARE_{name} {value}"));
    let state = [vec![format!("texels 0 {format}")], parameters.to_vec()].concat();
    drawn(Path::Common, needs, state, sources, vec![Contribution::byte("out.value", 0)])
}

/// Compares four texels of a depth texture under the linear filter. Rows where r is near one of them, or near their mixture, are left out: their
/// answer depends on roundings.
pub(super) fn filtered_shadow(case: &Case) -> Option<Placement> {
    let (r, word) = (number(case.number("in.r"))?, case.number("mid.reference"));
    let depths = case.numbers(["in.d00", "in.d10", "in.d01", "in.d11"]);
    let is_clear = depths.iter().chain(&[case.number("mid.mixed")]).all(|depth| (word - depth).abs() > 1);
    let weights = case.numbers(["in.weight_u", "in.weight_v"]).map(|weight| weight as u8).to_vec();
    let texels = depths.map(|depth| (depth as u16).to_le_bytes()).concat();
    let sources = vec![("quads0", texels), ("weights0", weights), ("projected0", bytes([r / 65_535.0, 1.0]))];
    is_clear.then(|| compared(case, Z16, sources))
}

/// Reads a volume texture whose texels hold the number of their layer, within the coordinates that the model takes.
pub(super) fn volume_layer(case: &Case) -> Option<Placement> {
    let (mode, mut needs) = super::fixed::wrap(case.choice::<AddressMode>("cfg.mode"));
    needs.push("GL_EXT_texture3D");
    let state = vec![format!("layers 0 {}", case.number("cfg.layers")), format!("parameter 0 TEXTURE_WRAP_R {mode}")];
    let sources = vec![("projected0", bytes(projected(case)?))];
    let is_limited = case.number("mid.w").abs() >= 1 << 24;
    (!is_limited).then(|| drawn(Path::Common, needs, state, sources, super::fixed::numbered("out.layer")))
}
