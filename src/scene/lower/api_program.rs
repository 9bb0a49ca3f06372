//! Programs in the language of an API, which become combiners for each draw.

use super::program_text::ProgramText;
use super::texture::Textures;
use super::unit::Units;
use super::*;
use crate::program::At;
use crate::program::texture_environment::{self as environment, BaseFormat, TextureEnvironment};
use crate::program::texture_stages::{self as stages, TextureStages};
use crate::state::{Combiners, ShaderOperation, ShaderStage, StageOrigin, TEXTURE_UNITS, TextureKind, TextureUnit};

/// A program of an API.
pub(super) enum ApiProgram {
    /// Direct3D.
    Stages(TextureStages, Option<ProgramText>),
    /// OpenGL.
    Environment(TextureEnvironment),
}

/// What it becomes in a draw.
pub(super) struct Lowered {
    pub(super) combiners: Combiners,
    pub(super) origins: Vec<StageOrigin>,
    pub(super) shader: [ShaderStage; TEXTURE_UNITS],
}

impl ApiProgram {
    /// Lowers the program for a draw, whose texture shader stands at `written` if it has one; the default program once the reason that
    /// it has no form has been recorded.
    pub(super) fn lower(
        &self,
        reader: &mut Reader<'_>,
        units: &Units,
        textures: &Textures,
        fog: bool,
        written: Option<Range<usize>>,
    ) -> Lowered {
        let profile = reader.profile;
        let signed = units.bound.map(|unit| unit.is_some_and(|unit| unit.signed != [false; 4]));
        let mut shader = units.shader;
        let lowered = match self {
            ApiProgram::Stages(program, text) => {
                let bound = units.shader.map(|stage| stage.operation != ShaderOperation::None);
                let context = stages::Context { profile, bound, signed, fog };
                let mut findings = Vec::new();
                let lowered = stages::lower(program, &context).map(|lowered| {
                    for (index, change) in lowered.units.iter().enumerate() {
                        shader[index].coordinate_set = change.coordinate_set.unwrap_or(shader[index].coordinate_set);
                        let Some(bump) = &change.operation else { continue };
                        findings.extend(objection(units, textures, index, bump, written.clone()));
                        (shader[index].operation, shader[index].previous) = (bump.value, index.saturating_sub(1));
                    }
                    (lowered.combiners, lowered.origins)
                });
                let lowered = lowered.and_then(|lowered| if findings.is_empty() { Ok(lowered) } else { Err(findings) });
                lowered.map_err(|findings| match text {
                    Some(text) => findings.into_iter().map(|finding| text.place(finding)).collect(),
                    None => findings,
                })
            }
            ApiProgram::Environment(program) => {
                let format = |unit: TextureUnit| textures.list.get(unit.texture).map(|texture| texture.format);
                let formats = std::array::from_fn(|index| match units.shader[index].operation {
                    ShaderOperation::None => None,
                    _ => Some(units.bound[index].and_then(format).map_or(BaseFormat::Rgba, BaseFormat::of)),
                });
                let context = environment::Context { profile, textures: formats, signed, fog };
                environment::lower(program, &context).map(|lowered| (lowered.combiners, lowered.origins))
            }
        };
        match lowered {
            Ok((combiners, origins)) => Lowered { combiners, origins, shader },
            Err(findings) => {
                // Several draws may share a program: each finding once.
                for finding in findings {
                    if !reader.diagnostics.contains(&finding) {
                        reader.push(finding);
                    }
                }
                Lowered { combiners: combiner::default_program(), origins: Vec::new(), shader }
            }
        }
    }
}

/// What keeps a unit from looking up where the texture before it moves the coordinates.
fn objection(
    units: &Units,
    textures: &Textures,
    index: usize,
    bump: &At<ShaderOperation>,
    written: Option<Range<usize>>,
) -> Option<Diagnostic> {
    if written.is_some() {
        return Some(
            Diagnostic::error("NB0352", bump.place.clone(), "a bump environment map beside a texture shader")
                .label("becomes a texture shader itself")
                .rule("TSH-10")
                .help("leave the draw's `texture_shader` out, or write a BumpEnvironment stage there and Disable here"),
        );
    }
    let texture = units.bound[index].and_then(|unit| textures.list.get(unit.texture))?;
    (texture.kind == TextureKind::Cube).then(|| {
        let message = format!("texture {index} is a cube map, whose coordinates are not moved");
        Diagnostic::error("NB0343", bump.place.clone(), message)
            .label("moves coordinates of the next texture")
            .rule("TSH-10")
            .help("bind a two-dimensional texture to the next unit")
    })
}

/// A name with its place; the default without one if nothing is written.
pub(super) fn name_at<'a, T: crate::state::Named>(
    reader: &mut Reader<'a>,
    raw: &Option<Raw<'a, crate::scene::reader::Name<T>>>,
    slot: &mut At<T>,
) {
    if let Some(raw) = raw
        && let Some(value) = reader.name(raw)
    {
        *slot = At { value, place: reader.span(raw) };
    }
}
