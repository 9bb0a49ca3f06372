//! Scenes as draws for the OpenGL program: what OpenGL says of them, one text and the bytes that it points to.
//!
//! ```text
//! ninebit-scene 2
//! scene CMB-3-expand
//! size 256 192
//! needs GL_NV_register_combiners
//! texture 0 8 1 0                              8 x 1 texels R, G, B, A at byte 0; `cube` has a side, `depths` the bits of a depth
//! clear 0 0 0 255
//! clear_depth 16777215 0                       in steps of 24 bits, and a stencil
//! draw
//! unit 0 0 NEAREST REPEAT CLAMP_TO_EDGE        unit, texture, filter, wraps
//! shader 1 SHADER_OPERATION_NV DEPENDENT_GB_TEXTURE_2D_NV
//! mask 1 1 1 1
//! blend FUNC_REVERSE_SUBTRACT ONE ONE          without it the draw replaces what is there
//! scissor 0 0 128 64                           without it all pixels are drawn; y from the top
//! depth LEQUAL 1                               without it there is no depth test
//! fog_density EXP 1.5                          without it there is no fog
//! combiners 1                                  and the lines of batches
//! vertices TRIANGLES 6 128                     92 bytes each: x, y, depth, w; two colours; fog; s, t, r, q of four units
//! ```
#![allow(clippy::float_arithmetic, reason = "coordinates are f32")]

mod lines;
mod raster;
mod units;

use ninebit::raster::assemble::Assembly;
use ninebit::raster::stroke::Figure;
use ninebit::state::{
    Blend, BlendFactor, Combiners, DepthFormat, Draw, FinalCombiner, FinalRegister, GeneralStage, MuxSelect, Named,
    Profile, Scene, ShaderOperation, ShadowReference, SurfaceFormat, TEXTURE_UNITS, Target, Vertex, VertexColor,
};

use super::combiners::program_lines;
use lines::{DEEPEST, Environment, Lines};
use raster::{depth, depth_and_stencil, fog_function, state};
use units::{shades, texture, units};

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
    let (mut lines, mut raw) = (Lines::default(), Vec::new());
    let environments: Option<Vec<Environment>> =
        scene.draws.iter().map(|draw| environment(target.format, draw)).collect();
    if environments.is_none() {
        lines.needs("GL_NV_register_combiners");
        if scene.profile == Profile::Nv2a {
            lines.needs("GL_NV_register_combiners2");
        }
    }
    for (n, image) in scene.textures.iter().enumerate() {
        texture(&mut lines, n, image, &mut raw)?;
    }
    clear(&mut lines, target)?;
    for (n, (draw, assembly)) in scene.draws.iter().zip(assemblies).enumerate() {
        lines.add("draw".to_owned());
        let environment = environments.as_ref().map(|all| all[n]);
        units(&mut lines, scene, draw, environment)?;
        state(&mut lines, target.format, draw)?;
        if draw.depth_test.is_some() || draw.stencil_test.is_some() {
            depth_and_stencil(&mut lines, draw, target)?;
        }
        match environment {
            Some(Environment::Texel) => lines.add("env 0 TEXTURE_ENV_MODE REPLACE".to_owned()),
            Some(Environment::Colors) => {}
            None => lines.lines.extend(program(scene.profile, &draw.combiners)?),
        }
        let triangles: Vec<_> = (0..assembly.triangles.len()).map(|n| assembly.triangles.at(n)).collect();
        if triangles.iter().any(|triangle| triangle.figure != Figure::Triangle) {
            return Err("lines or points".into());
        }
        let corners: Vec<Vertex> = triangles
            .iter()
            .flat_map(|triangle| triangle.vertices.map(|at| assembly.vertices.at(at as usize)))
            .collect();
        let secondary = |vertex: &Vertex| matches!(vertex.specular, VertexColor::Bytes([r, g, b, _]) if r | g | b != 0);
        if environment != Some(Environment::Texel) && corners.iter().any(secondary) {
            lines.needs("GL_EXT_secondary_color");
            lines.add("color_sum".to_owned());
        }
        if draw.fog.enabled {
            fog_function(&mut lines, draw, &corners)?;
        }
        if draw.convert_yuv {
            return Err("a conversion from YUV".into());
        }
        let [r, g, b] = draw.fog.color;
        lines.add(format!("fog_color {r} {g} {b}"));
        let depths = corners.iter().map(|corner| depth(draw, corner)).collect::<Vec<f64>>();
        if depths.iter().any(|depth| !(0.0..=1.0).contains(depth)) {
            lines.needs("GL_ARB_depth_clamp|GL_NV_depth_clamp");
            lines.add("depth_clamp".to_owned());
        }
        lines.add(format!("vertices TRIANGLES {} {}", corners.len(), raw.len()));
        for (corner, depth) in corners.iter().zip(depths) {
            raw.extend(vertex(scene, draw, corner, depth as f32)?);
        }
    }
    let head =
        ["ninebit-scene 2".to_owned(), format!("scene {name}"), format!("size {} {}", target.width, target.height)];
    let needs = lines.needs.iter().map(|extension| format!("needs {extension}"));
    let all: Vec<String> = head.into_iter().chain(needs).chain(lines.lines).chain(["end\n".to_owned()]).collect();
    Ok(SceneFiles { text: all.join("\n"), raw })
}

/// Returns what computes the colours of a draw where its combiners do what OpenGL does without them.
fn environment(format: SurfaceFormat, draw: &Draw) -> Option<Environment> {
    let Combiners { stages, final_combiner, .. } = &draw.combiners;
    let portions = |stage: &GeneralStage| GeneralStage { constants: [[0; 4]; 2], ..*stage };
    let ends = |other: FinalCombiner| FinalCombiner { constants: other.constants, ..*final_combiner } == other;
    let [stage] = &stages[..] else { return None };
    if portions(stage) == GeneralStage::initial([[0; 4]; 2]) && ends(FinalCombiner::initial([[0; 4]; 2])) {
        return Some(Environment::Colors);
    }
    let shown = FinalCombiner::showing(FinalRegister::Texture0);
    let alpha =
        if reads_alpha(format, draw) { *final_combiner } else { FinalCombiner { g: shown.g, ..*final_combiner } };
    let is_shown =
        FinalCombiner { constants: shown.constants, color_sum_clamp: shown.color_sum_clamp, ..alpha } == shown;
    let is_sampled = draw.textures[0].is_some() && draw.texture_shader[0].operation == ShaderOperation::Sample;
    let is_texel = portions(stage) == GeneralStage::default() && is_shown && is_sampled && !shades(draw);
    (is_texel && !draw.fog.enabled).then_some(Environment::Texel)
}

/// Returns whether a draw's alpha shows in what is stored.
fn reads_alpha(format: SurfaceFormat, draw: &Draw) -> bool {
    use BlendFactor::{OneMinusSourceAlpha, SourceAlpha, SourceAlphaSaturate};
    let blends = |Blend { source, destination, .. }: Blend| {
        [source, destination].iter().any(|f| matches!(f, SourceAlpha | OneMinusSourceAlpha | SourceAlphaSaturate))
    };
    format == SurfaceFormat::A8R8G8B8 || draw.alpha_test.is_some() || draw.blend.is_some_and(blends)
}

/// Adds what the buffers hold first.
fn clear(lines: &mut Lines, target: &Target) -> Result<(), String> {
    if !matches!(target.format, SurfaceFormat::A8R8G8B8 | SurfaceFormat::X8R8G8B8O) {
        return Err(format!("a surface of {}", target.format.name()));
    }
    if target.width > LARGEST[0] || target.height > LARGEST[1] {
        return Err(format!("a surface of more than {} x {} pixels", LARGEST[0], LARGEST[1]));
    }
    if target.contents.is_some() || target.depth_contents.is_some() || target.clip.is_some() {
        return Err("a surface that has contents or a clip".into());
    }
    let [r, g, b, a] = target.clear_color;
    lines.add(format!("clear {r} {g} {b} {}", if target.format == SurfaceFormat::A8R8G8B8 { a } else { 255 }));
    if let Some(depth) = target.depth {
        // A buffer of another format counts only where a draw tests it.
        let steps = if depth.format == DepthFormat::Z24S8 { depth.clear } else { DEEPEST as u32 };
        lines.add(format!("clear_depth {steps} {}", depth.clear_stencil));
    }
    Ok(())
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
fn vertex(scene: &Scene, draw: &Draw, vertex: &Vertex, depth: f32) -> Result<Vec<u8>, String> {
    let [x, y, _, w] = vertex.position;
    let mut bytes = Vec::with_capacity(92);
    let w = if draw.perspective { w } else { 1.0 };
    [x, y, depth, w].iter().for_each(|c| bytes.extend(c.to_le_bytes()));
    for color in [vertex.diffuse, vertex.specular] {
        let VertexColor::Bytes(color) = color else { return Err("colours that are no bytes".into()) };
        bytes.extend(color);
    }
    let fog = match (draw.fog.enabled, draw.fog.function) {
        (false, _) => 0.0,
        (true, None) => vertex.fog,
        (true, Some(function)) => function.coordinate(vertex).ok_or("a fog coordinate that is not known")?,
    };
    bytes.extend(fog.to_le_bytes());
    for n in 0..TEXTURE_UNITS {
        let [s, t, r, q] = vertex.texture_coordinates[draw.texture_shader[n].coordinate_set];
        let r = match draw.textures[n]
            .and_then(|unit| Some((unit.shadow?, scene.textures[unit.texture].format.depth()?)))
        {
            Some((shadow, _)) if shadow.reference == ShadowReference::Zero => 0.0,
            Some((_, format)) => (f64::from(r) / f64::from(format.largest())) as f32,
            None => r,
        };
        [s, t, r, q].iter().for_each(|c| bytes.extend(c.to_le_bytes()));
    }
    Ok(bytes)
}
