//! Lowers a pixel program in a file of its own, as the program of a draw.

use std::path::Path;

use super::api_program::Around;
use super::program::{Form, in_file};
use super::unit::Units;
use super::*;

/// Makes a scene of one pixel that the program draws. Returns `None` after recording what is wrong.
pub(crate) fn program_file(reader: &mut Reader<'_>, path: &Path, language: ProgramLanguage) -> Option<(Scene, Plan)> {
    let program = in_file(reader, path, language)?;
    let cubes = if let Form::Api(program) = &program.form { program.cubes() } else { [false; TEXTURE_UNITS] };
    let white = |name: &str, kind, faces| {
        let words = vec![u32::MAX; faces].into();
        let image = Texels { width: 1, height: 1, levels: 1, layers: 1, border: false, words };
        let (name, format) = (name.to_owned(), TextureFormat::A8R8G8B8);
        Texture { name, kind, format, image: TextureImage::Texels(image) }
    };
    reader.textures.list =
        vec![white("plane", TextureKind::TwoDimensional, 1), white("cube", TextureKind::Cube, CUBE_FACES as usize)];
    let bound = |unit: usize| unit < reader.profile.texture_units();
    let units = Units {
        bound: std::array::from_fn(|unit| bound(unit).then(|| TextureUnit::new(usize::from(cubes[unit])))),
        shader: std::array::from_fn(|unit| ShaderStage::conventional(unit, bound(unit))),
        places: Default::default(),
    };
    let mut around = Around { fog: false, shader: false, generators: false, sets: None, without_q: [None; 4] };
    let (lowered, _) = program.lower(reader, &units, &mut around);
    if reader.errors > 0 {
        return None;
    }
    let corners = [[0.0, 0.0, 0.0, 1.0], [0.0, 2.0, 0.0, 1.0], [2.0, 0.0, 0.0, 1.0]];
    let draw = Draw {
        name: "draw 0".to_owned(),
        vertices: corners.into_iter().map(|position| Vertex { position, ..Vertex::default() }).collect(),
        indices: [0, 1, 2].into(),
        textures: units.bound,
        texture_shader: lowered.shader,
        combiners: lowered.combiners,
        program_origin: lowered.origins,
        ..Draw::default()
    };
    let scene = Scene {
        profile: reader.profile,
        targets: vec![Target::new(1, 1, SurfaceFormat::A8R8G8B8)],
        textures: std::mem::take(&mut reader.textures.list),
        draws: vec![draw],
        ..Scene::default()
    };
    plan(reader, &scene, &[]).map(|plan| (scene, plan))
}
