//! Lines of raster operations, depths, stencils and fog.
#![allow(clippy::float_arithmetic, reason = "parameters that OpenGL is handed")]

use std::f32::consts::LN_2;

use ninebit::state::{
    BlendEquation, BlendFactor, DepthFormat, DepthRange, DepthTest, Draw, FogFunction, FogMode, Named, PolygonOffset,
    Rectangle, ShadeModel, StencilTest, SurfaceFormat, Target, Vertex, VertexDepths,
};

use super::lines::{DEEPEST, Lines, function};
use crate::gpu::buffers::STENCIL_OPERATIONS;

/// Adds the lines of a draw's raster operations but those of depths.
pub(super) fn state(lines: &mut Lines, format: SurfaceFormat, draw: &Draw) -> Result<(), String> {
    let refusals = [
        (draw.window_clip.is_some(), "a window clip"),
        (draw.polygon_stipple.is_some(), "a stipple"),
        (draw.smooth_polygons, "smooth polygons"),
        (draw.shade_model == ShadeModel::Flat, "flat colours"),
    ];
    if let Some((_, what)) = refusals.iter().find(|(has, _)| *has) {
        return Err((*what).to_owned());
    }
    if let Some(Rectangle { x, y, width, height }) = draw.scissor {
        lines.add(format!("scissor {x} {y} {width} {height}"));
    }
    if let Some(test) = draw.alpha_test {
        lines.add(format!("alpha_test {} {}", function(test.function), test.reference));
    }
    let [r, g, b, a] = draw.color_mask.map(u8::from);
    // Alpha that a surface does not store stays 1 for blending.
    lines.add(format!("mask {r} {g} {b} {}", if format == SurfaceFormat::A8R8G8B8 { a } else { 0 }));
    if let Some(blend) = draw.blend {
        let factors = [blend.source, blend.destination].map(factor);
        let [Some(source), Some(destination)] = factors else { return Err("a constant blend factor".into()) };
        let equation = match blend.equation {
            BlendEquation::Add => "FUNC_ADD",
            BlendEquation::Subtract => "FUNC_SUBTRACT",
            BlendEquation::ReverseSubtract => "FUNC_REVERSE_SUBTRACT",
            other => return Err(format!("the blend equation {}", other.name())),
        };
        lines.add(format!("blend {equation} {source} {destination}"));
    }
    Ok(())
}

/// Adds the lines of the depth and the stencil test.
pub(super) fn depth_and_stencil(lines: &mut Lines, draw: &Draw, target: &Target) -> Result<(), String> {
    let format = target.depth.map_or(DepthFormat::Z24S8, |depth| depth.format);
    if format != DepthFormat::Z24S8 {
        return Err(format!("a depth buffer of {}", format.name()));
    }
    if let Some(test) = &draw.depth_test {
        let DepthTest { function: compared, write, range, offset: PolygonOffset { bias, factor }, w_buffer, .. } =
            *test;
        if w_buffer {
            return Err("a w buffer".into());
        }
        let is_whole = |range: DepthRange| {
            range.clamps && !range.drops_triangles && range.lowest <= 0.0 && f64::from(range.highest) >= DEEPEST
        };
        if !range.is_none_or(is_whole) {
            return Err("a range of depths".into());
        }
        lines.add(format!("depth {} {}", function(compared), u8::from(write)));
        if bias != 0.0 || factor != 0.0 {
            lines.add(format!("offset {factor} {bias}"));
        }
    }
    if let Some(StencilTest { function: compared, reference, mask, write_mask, fail, depth_fail, pass }) =
        draw.stencil_test
    {
        let operation = |operation| STENCIL_OPERATIONS.split(' ').nth(operation as usize).unwrap_or("KEEP");
        let words = [fail, depth_fail, pass].map(operation);
        if words.iter().any(|word| word.ends_with("_WRAP")) {
            lines.needs("GL_EXT_stencil_wrap");
        }
        let (function, words) = (function(compared), words.join(" "));
        lines.add(format!("stencil_test {function} {reference} {mask} {write_mask} {words}"));
    }
    Ok(())
}

/// Returns the depth of a vertex as a fraction of the deepest; without a depth test every depth is alike.
pub(super) fn depth(draw: &Draw, vertex: &Vertex) -> f64 {
    let z = f64::from(vertex.position[2]);
    match draw.depth_test.map(|test| test.vertex_depths) {
        Some(VertexDepths::Fractions) => z,
        Some(VertexDepths::Steps) => z / DEEPEST,
        None => 0.5,
    }
}

/// Adds the line of a fog function.
pub(super) fn fog_function(lines: &mut Lines, draw: &Draw, corners: &[Vertex]) -> Result<(), String> {
    lines.needs("GL_EXT_fog_coord");
    let Some(function) = draw.fog.function else {
        // Factors: from 0 at the end to 1 at the start.
        lines.add("fog_range 1 0".to_owned());
        return Ok(());
    };
    if matches!(function.mode, FogMode::LinearAbs | FogMode::ExpAbs | FogMode::Exp2Abs)
        && corners.iter().any(|corner| function.coordinate(corner).is_some_and(|d| d < 0.0))
    {
        return Err("fog of coordinates below 0 by their magnitude".into());
    }
    let FogFunction { mode, p0, p1, p2, .. } = function;
    let line = match mode {
        // p0 + p1 d - 1 is (end - d) / (end - start).
        FogMode::Linear | FogMode::LinearAbs if p1 != 0.0 && (p2 == 0.0 || !function.takes_e()) => {
            let length = -1.0 / p1;
            let start = (p0 - 2.0) * length;
            Some(format!("fog_range {start} {}", start + length))
        }
        // The tables are 2^(-16 x) and 2^(-32 x^2) of x = 3/2 - e.
        FogMode::Exp | FogMode::ExpAbs if (p0, p2) == (1.5, 0.0) && p1 <= 0.0 => {
            Some(format!("fog_density EXP {}", -p1 * 16.0 * LN_2))
        }
        FogMode::Exp2 | FogMode::Exp2Abs if (p0, p2) == (1.5, 0.0) && p1 <= 0.0 => {
            Some(format!("fog_density EXP2 {}", -p1 * (32.0 * LN_2).sqrt()))
        }
        _ => None,
    };
    lines.add(line.ok_or("fog by parameters that no range or density gives")?);
    Ok(())
}

fn factor(factor: BlendFactor) -> Option<&'static str> {
    Some(match factor {
        BlendFactor::Zero => "ZERO",
        BlendFactor::One => "ONE",
        BlendFactor::SourceColor => "SRC_COLOR",
        BlendFactor::OneMinusSourceColor => "ONE_MINUS_SRC_COLOR",
        BlendFactor::SourceAlpha => "SRC_ALPHA",
        BlendFactor::OneMinusSourceAlpha => "ONE_MINUS_SRC_ALPHA",
        BlendFactor::DestinationAlpha => "DST_ALPHA",
        BlendFactor::OneMinusDestinationAlpha => "ONE_MINUS_DST_ALPHA",
        BlendFactor::DestinationColor => "DST_COLOR",
        BlendFactor::OneMinusDestinationColor => "ONE_MINUS_DST_COLOR",
        BlendFactor::SourceAlphaSaturate => "SRC_ALPHA_SATURATE",
        _ => return None,
    })
}
