//! Scenes as draws for the OpenGL program: what OpenGL says of them, one text and the bytes that it points to.
//!
//! ```text
//! ninebit-scene 1
//! scene CMB-3-expand
//! size 256 192
//! needs GL_NV_register_combiners
//! texture 0 8 1 0                              8 x 1 texels R, G, B, A at byte 0
//! clear 0 0 0 255
//! draw
//! unit 0 0 NEAREST REPEAT CLAMP_TO_EDGE        unit, texture, filter, wraps
//! mask 1 1 1 1
//! blend FUNC_REVERSE_SUBTRACT ONE ONE          without it the draw replaces what is there
//! scissor 0 0 128 64                           without it all pixels are drawn; y from the top
//! combiners 1                                  and the lines of batches
//! vertices TRIANGLES 6 128                     48 bytes each: x, y; two colours; s, t, r, q of two units
//! ```
#![allow(clippy::float_arithmetic, reason = "coordinates are f32")]

use ninebit::raster::assemble::Assembly;
use ninebit::raster::stroke::Figure;
use ninebit::state::{
    AddressMode, BlendEquation, BlendFactor, Combiners, Draw, Filter, FinalRegister, MuxSelect, Named, Profile,
    Rectangle, Scene, ShadeModel, ShaderOperation, SurfaceFormat, Texture, TextureImage, TextureKind, TextureUnit,
    Vertex, VertexColor,
};
use ninebit::texture::format::expand;

use super::combiners::program_lines;

/// Largest sides of a scene: those of the program's window.
pub const LARGEST: [u32; 2] = [1024, 256];

/// The two files of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneFiles {
    /// Content of `NAME.scene.txt`.
    pub text: String,
    /// Content of `NAME.scene.raw`.
    pub raw: Vec<u8>,
}

/// Returns a scene as draws. `assemblies` has the triangles of each draw, as the plan has them.
///
/// # Errors
/// What OpenGL or the program does not have.
pub fn scene(name: &str, scene: &Scene, assemblies: &[&Assembly]) -> Result<SceneFiles, String> {
    let [target] = &scene.targets[..] else { return Err("several targets".into()) };
    if !matches!(target.format, SurfaceFormat::A8R8G8B8 | SurfaceFormat::X8R8G8B8O) {
        return Err(format!("a surface of {}", target.format.name()));
    }
    if target.width > LARGEST[0] || target.height > LARGEST[1] || target.contents.is_some() {
        return Err("a surface that is larger, or has contents".into());
    }
    let mut raw = Vec::new();
    let mut lines = vec![
        "ninebit-scene 1".to_owned(),
        format!("scene {name}"),
        format!("size {} {}", target.width, target.height),
        "needs GL_NV_register_combiners".to_owned(),
    ];
    if scene.profile == Profile::Nv2a {
        lines.push("needs GL_NV_register_combiners2".to_owned());
    }
    for (n, texture) in scene.textures.iter().enumerate() {
        let (size, texels) = texels(texture)?;
        lines.push(format!("texture {n} {} {} {}", size[0], size[1], raw.len()));
        raw.extend(texels);
    }
    let [r, g, b, a] = target.clear_color;
    lines.push(format!("clear {r} {g} {b} {a}"));
    for (draw, assembly) in scene.draws.iter().zip(assemblies) {
        lines.push("draw".to_owned());
        lines.extend(state(draw)?);
        lines.extend(program(scene.profile, &draw.combiners)?);
        let corners: Vec<Vertex> = (0..assembly.triangles.len())
            .map(|n| assembly.triangles.at(n))
            .filter(|triangle| triangle.figure == Figure::Triangle)
            .flat_map(|triangle| triangle.vertices.map(|at| assembly.vertices.at(at as usize)))
            .collect();
        lines.push(format!("vertices TRIANGLES {} {}", corners.len(), raw.len()));
        for corner in &corners {
            raw.extend(vertex(draw, corner)?);
        }
    }
    lines.push("end\n".to_owned());
    Ok(SceneFiles { text: lines.join("\n"), raw })
}

/// Returns the size of a texture and its texels, R, G, B, A.
fn texels(texture: &Texture) -> Result<([u32; 2], Vec<u8>), String> {
    let TextureImage::Texels(texels) = &texture.image else { return Err("a target as a texture".into()) };
    if texture.kind != TextureKind::TwoDimensional
        || texels.levels > 1
        || texels.border
        || texture.format.is_compressed()
    {
        return Err("a texture that is not of one level in two dimensions".into());
    }
    let colors = texels.words.iter().flat_map(|word| expand(texture.format, *word));
    Ok(([texels.width, texels.height], colors.collect()))
}

/// Returns the lines of a draw's units and raster operations.
fn state(draw: &Draw) -> Result<Vec<String>, String> {
    let refusals = [
        (draw.depth_test.is_some() || draw.stencil_test.is_some(), "depths or stencil"),
        (draw.fog.enabled, "fog"),
        (draw.window_clip.is_some(), "a window clip"),
        (draw.polygon_stipple.is_some(), "a stipple"),
        (draw.shade_model == ShadeModel::Flat, "flat colours"),
        (
            draw.texture_shader
                .iter()
                .any(|stage| !matches!(stage.operation, ShaderOperation::None | ShaderOperation::Sample)),
            "a texture shader",
        ),
    ];
    if let Some((_, what)) = refusals.iter().find(|(has, _)| *has) {
        return Err((*what).to_owned());
    }
    let mut lines = Vec::new();
    for (n, unit) in draw.textures.iter().enumerate() {
        let sampled = draw.texture_shader[n].operation == ShaderOperation::Sample;
        if let (Some(unit), true) = (unit, sampled) {
            if n >= 2 {
                return Err("more than two units".into());
            }
            lines.push(self::unit(n, unit)?);
        }
    }
    if let Some(Rectangle { x, y, width, height }) = draw.scissor {
        lines.push(format!("scissor {x} {y} {width} {height}"));
    }
    if let Some(test) = draw.alpha_test {
        let function = ["NEVER", "LESS", "EQUAL", "LEQUAL", "GREATER", "NOTEQUAL", "GEQUAL", "ALWAYS"];
        // The functions are in the order of their values.
        lines.push(format!("alpha_test {} {}", function[test.function as usize], test.reference));
    }
    let mask = draw.color_mask.map(|channel| u8::from(channel).to_string());
    lines.push(format!("mask {}", mask.join(" ")));
    if let Some(blend) = draw.blend {
        let factors = [blend.source, blend.destination].map(factor);
        let [Some(source), Some(destination)] = factors else { return Err("a constant blend factor".into()) };
        let equation = match blend.equation {
            BlendEquation::Add => "FUNC_ADD",
            BlendEquation::Subtract => "FUNC_SUBTRACT",
            BlendEquation::ReverseSubtract => "FUNC_REVERSE_SUBTRACT",
            other => return Err(format!("the blend equation {}", other.name())),
        };
        lines.push(format!("blend {equation} {source} {destination}"));
    }
    Ok(lines)
}

fn unit(n: usize, unit: &TextureUnit) -> Result<String, String> {
    if unit.color_key.is_some()
        || unit.palette.is_some()
        || unit.signed != [false; 4]
        || unit.min_filter != unit.mag_filter
    {
        return Err("a unit with a key, a palette, signs or two filters".into());
    }
    let filter = if unit.mag_filter == Filter::Linear { "LINEAR" } else { "NEAREST" };
    let wraps = [unit.address_s, unit.address_t].map(|mode| match mode {
        AddressMode::Wrap => Some("REPEAT"),
        AddressMode::ClampToEdge => Some("CLAMP_TO_EDGE"),
        AddressMode::Mirror => Some("MIRRORED_REPEAT"),
        _ => None,
    });
    let [Some(s), Some(t)] = wraps else { return Err("a border colour".into()) };
    Ok(format!("unit {n} {} {filter} {s} {t}", unit.texture))
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

fn program(profile: Profile, combiners: &Combiners) -> Result<Vec<String>, String> {
    let muxes = combiners.stages.iter().any(|stage| stage.rgb.mux || stage.alpha.mux);
    if muxes && combiners.mux_select != MuxSelect::Msb {
        return Err("a mux by the lowest bit".into());
    }
    let blue = combiners.stages.iter().any(|stage| stage.rgb.ab_blue_to_alpha || stage.rgb.cd_blue_to_alpha);
    let sum_first = combiners.final_combiner.inputs[0].register == FinalRegister::Spare0PlusSecondary;
    if blue || sum_first || combiners.final_combiner.invert_spare0 || combiners.final_combiner.invert_secondary {
        return Err("combiners that OpenGL has no words for".into());
    }
    Ok(program_lines(profile, combiners))
}

/// Returns the bytes of a vertex.
fn vertex(draw: &Draw, vertex: &Vertex) -> Result<Vec<u8>, String> {
    let [x, y, _, w] = vertex.position;
    if w != 1.0 {
        return Err("perspective".into());
    }
    let mut bytes = Vec::with_capacity(48);
    [x, y].iter().for_each(|c| bytes.extend(c.to_le_bytes()));
    for color in [vertex.diffuse, vertex.specular] {
        let VertexColor::Bytes(color) = color else { return Err("colours that are no bytes".into()) };
        bytes.extend(color);
    }
    for stage in &draw.texture_shader[..2] {
        vertex.texture_coordinates[stage.coordinate_set].iter().for_each(|c| bytes.extend(c.to_le_bytes()));
    }
    Ok(bytes)
}
