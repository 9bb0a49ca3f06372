//! The state of a plan under shortcuts, and which shortcuts can change its frames.
#![allow(clippy::float_arithmetic, reason = "vertices and matrices as another renderer prepares them")]

use super::{Shortcut, Shortcuts, texels};
use crate::plan::{Plan, PlannedDraw};
use crate::raster::ideal;
use crate::state::{
    BlendEquation, DepthFormat, DotRounding, ExpandCentre, Filter, FogFunction, FogMode, OutputRounding, RegisterFloor,
    ShaderOperation, SumRounding, VertexDepths,
};

/// Changes a plan.
pub(super) fn change(mut plan: Plan, shortcuts: Shortcuts) -> Plan {
    let has = |shortcut| shortcuts.contains(shortcut);
    let policies = &mut plan.policies;
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
        change_shader(draw, shortcuts);
        if has(Shortcut::VertexFog) || has(Shortcut::BiasOutside) {
            fog_at_vertices(draw, has(Shortcut::BiasOutside));
        }
    }
    if has(Shortcut::FixedDepths) {
        fix_depths(&mut plan);
    }
    plan
}

/// Changes the bump maps of a draw.
fn change_shader(draw: &mut PlannedDraw, shortcuts: Shortcuts) {
    let Some(shader) = &mut draw.shader else { return };
    for stage in &mut shader.stages {
        let ShaderOperation::BumpEnvironment { matrix, luminance } = &mut stage.state.operation else { continue };
        if shortcuts.contains(Shortcut::NoLuminance) {
            *luminance = None;
        }
        if shortcuts.contains(Shortcut::OffsetsOf127) {
            *matrix = matrix.map(|entry| entry * 128.0 / 127.0);
        }
        stage.signed_luminance = shortcuts.contains(Shortcut::LuminanceOf254);
        stage.lights_alpha = shortcuts.contains(Shortcut::LuminanceOfAlpha);
    }
}

/// Replaces fog functions by the factors of vertices. With `outside` an exponential has its bias outside the power, and magnitudes are not taken.
fn fog_at_vertices(draw: &mut PlannedDraw, outside: bool) {
    let Some(function) = draw.fog.function.take() else { return };
    let vertices = &draw.assembly.vertices;
    let known = vertices.iter().map(|vertex| (vertex.fog, vertex.fog_coordinate));
    let factors: Vec<f32> = known.map(|(fog, coordinate)| factor(&function, fog, coordinate, outside)).collect();
    draw.assembly.vertices.update(|n, vertex| vertex.fog = factors[n]);
}

fn factor(function: &FogFunction, passed: f32, coordinate: Option<f32>, outside: bool) -> f32 {
    let plain = || (ideal::fog(&Some(*function), [1.0, 0.0, 0.0], [passed; 3], [coordinate; 3]) / 255.0) as f32;
    if !outside {
        return plain();
    }
    // d, from e = p0 + p1 d where the vertices pass only that.
    let (p0, p1) = (f64::from(function.p0), f64::from(function.p1));
    let d = match coordinate {
        Some(d) => f64::from(d),
        None if !function.takes_e() => f64::from(passed),
        None if p1 == 0.0 => return plain(),
        None => (f64::from(passed) - p0) / p1,
    };
    let factor = match function.mode {
        FogMode::Linear | FogMode::LinearAbs => p0 + p1 * d - 1.0,
        FogMode::Exp | FogMode::ExpAbs => p0 + ideal::power_of_two(16.0 * p1 * d) - 1.5,
        FogMode::Exp2 | FogMode::Exp2Abs => p0 + ideal::power_of_two(-32.0 * (p1 * d) * (p1 * d)) - 1.5,
    };
    if factor.is_nan() { plain() } else { factor.clamp(0.0, 1.0) as f32 }
}

/// Stores float depths as integers: fractions of the largest number of the format.
fn fix_depths(plan: &mut Plan) {
    let largest = |format: DepthFormat| f64::from(depth_of_word(format, format.largest()));
    let fixed = |format: DepthFormat| if format == DepthFormat::Z16F { DepthFormat::Z16 } else { DepthFormat::Z24S8 };
    for draw in plan.draws.iter_mut().filter(|draw| draw.depth_test.is_some() && draw.depth_format.is_float()) {
        let (format, Some(test)) = (draw.depth_format, &mut draw.depth_test) else { continue };
        let factor = f64::from(format.largest()) / largest(format);
        let scaled = |z: f32| (f64::from(z) * factor) as f32;
        draw.assembly.vertices.map_positions(|[x, y, z, w]| [x, y, scaled(z), w]);
        test.vertex_depths = VertexDepths::Steps;
        if let Some(range) = &mut test.range {
            (range.lowest, range.highest) = (scaled(range.lowest), scaled(range.highest));
        }
        draw.depth_format = fixed(format);
    }
    for depth in plan.targets.iter_mut().filter_map(|target| target.depth.as_mut()) {
        if depth.format.is_float() {
            let (format, steps) = (depth.format, f64::from(depth.format.largest()));
            let part = f64::from(depth_of_word(format, depth.clear)) / largest(format);
            depth.clear = (part * steps).clamp(0.0, steps) as u32;
            depth.format = fixed(format);
        }
    }
}

/// DEP-3: returns the number that a word of a float format stands for. Words beyond the largest finite number are that.
fn depth_of_word(format: DepthFormat, word: u32) -> f32 {
    if word == 0 {
        return 0.0;
    }
    let number = match format {
        DepthFormat::Z16F => f32::from_bits((word << 11).wrapping_add(0x3c00_0000)),
        _ => f32::from_bits(word << 7),
    };
    if number.is_finite() { number } else { f32::MAX }
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
        Shortcut::PlainBlocks | Shortcut::CutBlocks | Shortcut::ShiftedTexels => {
            units(&|unit| texels::converts(shortcut, unit.format))
        }
        Shortcut::FloatSigned | Shortcut::UnsignedChannels => signed(),
        Shortcut::FloatCombiners => any(&|draw| !draw.stages.is_empty() || draw.blend.is_some()),
        Shortcut::FloatFog => fog(),
        Shortcut::FloatLuminance | Shortcut::LuminanceOf254 | Shortcut::NoLuminance | Shortcut::LuminanceOfAlpha => {
            bumps(true)
        }
        Shortcut::OffsetsOf127 => bumps(false),
        Shortcut::FloatPassThrough => stages(&|operation| matches!(operation, ShaderOperation::PassThrough)),
        Shortcut::FloatShader => any(&|_| true),
        Shortcut::FloatBlend => any(&|draw| draw.blend.is_some()),
        Shortcut::ExactCoordinates => units(&|_| true),
        Shortcut::UnsnappedVertices => any(&|_| true),
        Shortcut::ExactDepths => has_depths(),
        Shortcut::FixedDepths => any(&|draw| draw.depth_test.is_some() && draw.depth_format.is_float()),
        Shortcut::PlainSignedBlend => any(&|draw| {
            let equation = draw.blend.map(|blend| blend.equation);
            matches!(equation, Some(BlendEquation::SignedAdd | BlendEquation::SignedReverseSubtract))
        }),
        Shortcut::AlwaysPerspective => any(&|draw| !draw.perspective),
        Shortcut::BlackTargets => any(&|draw| plan.reads_target(draw)),
        Shortcut::VertexFog | Shortcut::BiasOutside => fog() && any(&|draw| draw.fog.function.is_some()),
        Shortcut::LiteralExpand | Shortcut::EachProduct | Shortcut::LateRounding | Shortcut::SymmetricRegisters => {
            any(&|draw| !draw.stages.is_empty())
        }
    }
}
