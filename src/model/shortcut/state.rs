//! The state of a plan under shortcuts, and which shortcuts can change its frames.
#![allow(clippy::float_arithmetic, reason = "vertices and matrices as another renderer prepares them")]

use super::{Shortcut, Shortcuts, depths, texels};
use crate::plan::{Plan, PlannedDraw};
use crate::raster::ideal;
use crate::rop::surface;
use crate::state::{
    BlendEquation, DepthFormat, DotMapping, DotRounding, ExpandCentre, Filter, FogFunction, FogMode, LineRasterization,
    Lines, MuxNegative, OutputRounding, Policies, RegisterFloor, ShaderOperation, SumRounding,
};
use crate::texture::stage::PlannedShaderStage;

/// Changes policies.
pub(super) fn policies(mut policies: Policies, shortcuts: Shortcuts) -> Policies {
    let has = |shortcut| shortcuts.contains(shortcut);
    if has(Shortcut::LiteralExpand) {
        policies.expand_centre = ExpandCentre::Literal;
    }
    if has(Shortcut::EachProduct) {
        (policies.sum_rounding, policies.dot_rounding) = (SumRounding::Each, DotRounding::Each);
    }
    if has(Shortcut::LateRounding) {
        policies.output_rounding = OutputRounding::AfterScale;
    }
    if has(Shortcut::SymmetricRegisters) {
        policies.register_floor = RegisterFloor::Symmetric;
    }
    if has(Shortcut::MuxByBit) {
        policies.mux_negative = MuxNegative::Bit7;
    }
    policies
}

/// Changes a plan.
pub(super) fn change(mut plan: Plan, shortcuts: Shortcuts) -> Plan {
    let has = |shortcut| shortcuts.contains(shortcut);
    plan.policies = policies(plan.policies, shortcuts);
    texels::convert(&mut plan, shortcuts);
    if has(Shortcut::BlackTargets) {
        texels::blacken(&mut plan);
    }
    for draw in &mut plan.draws {
        if has(Shortcut::UnsignedChannels) {
            draw.units.iter_mut().for_each(|unit| unit.state.signed = [false; 4]);
        }
        if has(Shortcut::PlainSignedBlend)
            && let Some(blend) = &mut draw.blend
        {
            blend.equation = match blend.equation {
                BlendEquation::SignedAdd => BlendEquation::Add,
                BlendEquation::SignedReverseSubtract => BlendEquation::ReverseSubtract,
                equation => equation,
            };
        }
        draw.perspective |= has(Shortcut::AlwaysPerspective);
        if has(Shortcut::ThinLines) {
            draw.assembly.lines = THIN;
        }
        if has(Shortcut::WhiteUnbound) {
            draw.unbound_color = [255; 4];
        }
        change_shader(draw, shortcuts);
        if has(Shortcut::VertexFog) || has(Shortcut::BiasOutside) {
            fog_at_vertices(draw, has(Shortcut::BiasOutside));
        }
    }
    depths::change(&mut plan, shortcuts);
    plan
}

/// A line of one pixel.
const THIN: Lines = Lines { width: 8, rasterization: LineRasterization::Bresenham };

/// Changes the texture shader of a draw.
fn change_shader(draw: &mut PlannedDraw, shortcuts: Shortcuts) {
    let Some(shader) = &mut draw.shader else { return };
    let has = |shortcut| shortcuts.contains(shortcut);
    for stage in &mut shader.stages {
        if has(Shortcut::HemisphereAsColor) && stage.state.mapping == DotMapping::HiloHemisphere {
            stage.state.mapping = DotMapping::ZeroToOne;
        }
        stage.unit_normals = has(Shortcut::UnitNormals);
        match &mut stage.state.operation {
            ShaderOperation::BumpEnvironment { matrix, luminance } => {
                if has(Shortcut::NoLuminance) {
                    *luminance = None;
                }
                if has(Shortcut::OffsetsOf127) {
                    *matrix = matrix.map(|entry| entry * 128.0 / 127.0);
                }
                stage.signed_luminance = has(Shortcut::LuminanceOf254);
                stage.lights_alpha = has(Shortcut::LuminanceOfAlpha);
            }
            operation @ ShaderOperation::DotReflectConstantEye { .. } if has(Shortcut::NoConstantReflection) => {
                // Its colour is 0 (TSH-4).
                *operation = ShaderOperation::DotProduct;
            }
            _ => {}
        }
    }
}

/// Replaces fog functions by the factors of vertices. With `outside` an exponential has its bias outside of the power, the magnitude is the
/// factor's, and factors are limited where they are used.
fn fog_at_vertices(draw: &mut PlannedDraw, outside: bool) {
    let Some(function) = draw.fog.function.take() else { return };
    let vertices = &draw.assembly.vertices;
    let known = vertices.iter().map(|vertex| (vertex.fog, vertex.fog_coordinate));
    if !outside {
        let factor = |(fog, d)| (ideal::fog(&Some(function), [1.0, 0.0, 0.0], [fog; 3], [d; 3]) / 255.0) as f32;
        let factors: Vec<f32> = known.map(factor).collect();
        draw.assembly.vertices.update(|n, vertex| vertex.fog = factors[n]);
        return;
    }
    let factors: Vec<f32> = known.map(|(fog, coordinate)| unlimited_factor(&function, fog, coordinate)).collect();
    // Linear fog of what vertices pass is that less 1, limited at pixels.
    draw.fog.function = Some(FogFunction { mode: FogMode::Linear, per_vertex: true, ..function });
    draw.assembly.vertices.update(|n, vertex| (vertex.fog, vertex.fog_coordinate) = (factors[n] + 1.0, None));
}

/// Returns the factor of a vertex with the bias outside of the power, not limited but to finite numbers.
fn unlimited_factor(function: &FogFunction, passed: f32, coordinate: Option<f32>) -> f32 {
    // d, from e = p0 + p1 d where the vertices pass only that.
    let (p0, p1) = (f64::from(function.p0), f64::from(function.p1));
    let d = match coordinate {
        Some(d) => f64::from(d),
        None if !function.takes_e() => f64::from(passed),
        None if p1 == 0.0 => 0.0,
        None => (f64::from(passed) - p0) / p1,
    };
    let factor = match function.mode {
        FogMode::Linear | FogMode::LinearAbs => p0 + p1 * d - 1.0,
        FogMode::Exp | FogMode::ExpAbs => p0 + power_of_two(16.0 * p1 * d) - 1.5,
        FogMode::Exp2 | FogMode::Exp2Abs => p0 + power_of_two(-32.0 * (p1 * d) * (p1 * d)) - 1.5,
    };
    let is_absolute = matches!(function.mode, FogMode::LinearAbs | FogMode::ExpAbs | FogMode::Exp2Abs);
    let of_none = f32::from(matches!(function.mode, FogMode::Linear | FogMode::LinearAbs | FogMode::Exp));
    match if is_absolute { factor.abs() } else { factor } {
        _ if d.is_infinite() => of_none,
        factor if factor.is_nan() => of_none,
        factor => (factor as f32).clamp(-LARGEST_FACTOR, LARGEST_FACTOR),
    }
}

/// Limit of factors: so large that only their sign counts.
const LARGEST_FACTOR: f32 = 1e30;

/// Returns 2^x as [`ideal::power_of_two`] does, for every x.
fn power_of_two(x: f64) -> f64 {
    let whole = x.floor().clamp(-1000.0, 1000.0);
    ideal::power_of_two((x - whole).clamp(0.0, 1.0)) * f64::from_bits(((1023.0 + whole) as u64) << 52)
}

/// Returns whether a shortcut can change a frame of a plan.
pub(super) fn concerns(plan: &Plan, shortcut: Shortcut) -> bool {
    let draws = || plan.draws.iter().filter(|draw| draw.folded.invisible.is_none());
    let any = |test: &dyn Fn(&PlannedDraw) -> bool| draws().any(test);
    let units = |test: &dyn Fn(&crate::texture::planned::PlannedUnit) -> bool| any(&|draw| draw.units.iter().any(test));
    let stages = |test: &dyn Fn(&ShaderOperation) -> bool| {
        any(&|draw| draw.shader.as_ref().is_some_and(|s| s.stages.iter().any(|stage| test(&stage.state.operation))))
    };
    let bumps = |with: bool| {
        stages(
            &|operation| matches!(operation, ShaderOperation::BumpEnvironment { luminance, .. } if !with || luminance.is_some()),
        )
    };
    let depths = |test: &dyn Fn(DepthFormat) -> bool| {
        plan.targets.iter().filter_map(|target| target.depth).any(|depth| test(depth.format))
    };
    let has_depths = || any(&|draw| draw.depth_test.is_some());
    let signed = || units(&|unit| unit.state.signed != [false; 4]);
    let fog = || any(&|draw| draw.fog_channels & 8 != 0 && draw.fog.enabled);
    match shortcut {
        Shortcut::FloatColors => any(&|draw| draw.primary | draw.secondary != 0),
        Shortcut::FloatFilter => {
            units(&|unit| unit.state.mag_filter == Filter::Linear || unit.state.min_filter == Filter::Linear)
        }
        Shortcut::FloatBlocks => units(&|unit| unit.format.is_compressed()),
        Shortcut::FloatTexels => units(&|unit| texels::converts(Shortcut::ShiftedTexels, unit.format)),
        Shortcut::PlainBlocks
        | Shortcut::CutBlocks
        | Shortcut::ShiftedTexels
        | Shortcut::GreyY16
        | Shortcut::SignedR6G5B5 => units(&|unit| texels::converts(shortcut, unit.format)),
        Shortcut::FloatSigned | Shortcut::UnsignedChannels => signed(),
        Shortcut::FloatAlphaTest => any(&|draw| draw.alpha_test.is_some()),
        Shortcut::RoundedStores => any(&|draw| surface::dropped_bits(draw.surface) != [0; 3]),
        Shortcut::FloatCombiners => any(&|draw| !draw.stages.is_empty() || draw.blend.is_some()),
        Shortcut::FloatFog => fog(),
        Shortcut::FloatLuminance | Shortcut::LuminanceOf254 | Shortcut::NoLuminance | Shortcut::LuminanceOfAlpha => {
            bumps(true)
        }
        Shortcut::OffsetsOf127 => bumps(false),
        Shortcut::HemisphereAsColor => any(&|draw| {
            let hemisphere = |stage: &PlannedShaderStage| stage.state.mapping == DotMapping::HiloHemisphere;
            draw.shader.as_ref().is_some_and(|s| s.stages.iter().any(|stage| stage.runs() && hemisphere(stage)))
        }),
        Shortcut::NoConstantReflection => {
            stages(&|operation| matches!(operation, ShaderOperation::DotReflectConstantEye { .. }))
        }
        Shortcut::UnitNormals => stages(&|operation| {
            matches!(operation, ShaderOperation::DotReflectSpecular | ShaderOperation::DotReflectConstantEye { .. })
        }),
        Shortcut::WhiteUnbound => any(&|draw| draw.unbound != [0; 4]),
        Shortcut::FloatPassThrough => stages(&|operation| matches!(operation, ShaderOperation::PassThrough)),
        Shortcut::FloatShader => any(&|_| true),
        Shortcut::FloatBlend => any(&|draw| draw.blend.is_some()),
        Shortcut::ExactCoordinates => units(&|_| true),
        Shortcut::UnsnappedVertices => any(&|_| true),
        Shortcut::FloatDepths => has_depths(),
        Shortcut::ScaledDepths => depths(&|format| format.is_float()),
        Shortcut::HalfDepths => depths(&|format| format == DepthFormat::Z16F),
        Shortcut::CutDepths => depths(&|format| format.bits() == 16),
        Shortcut::ThinLines => any(&|draw| draw.assembly.lines != THIN),
        Shortcut::PlainSignedBlend => any(&|draw| {
            let equation = draw.blend.map(|blend| blend.equation);
            matches!(equation, Some(BlendEquation::SignedAdd | BlendEquation::SignedReverseSubtract))
        }),
        Shortcut::AlwaysPerspective => any(&|draw| !draw.perspective),
        Shortcut::BlackTargets => any(&|draw| plan.reads_target(draw)),
        Shortcut::VertexFog | Shortcut::BiasOutside => fog() && any(&|draw| draw.fog.function.is_some()),
        Shortcut::LiteralExpand
        | Shortcut::EachProduct
        | Shortcut::LateRounding
        | Shortcut::MuxByBit
        | Shortcut::SymmetricRegisters => any(&|draw| !draw.stages.is_empty()),
    }
}
