//! Programs in the language of an API, which become combiners for each draw.

use super::texture::Textures;
use super::unit::Units;
use super::*;
use crate::program::At;
use crate::program::texture_environment::{self as environment, BaseFormat, TextureEnvironment};
use crate::program::texture_stages::{self as stages, TextureStages};
use crate::state::{Combiners, ShaderStage, StageOrigin, TEXTURE_UNITS};

/// A program of an API.
pub(super) enum ApiProgram {
    /// Direct3D.
    Stages(TextureStages),
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
    /// Lowers the program for a draw; the default program once the reason that it has no form has been recorded.
    pub(super) fn lower(&self, reader: &mut Reader<'_>, units: &Units, textures: &Textures, fog: bool) -> Lowered {
        let profile = reader.profile;
        let signed = units.bound.map(|unit| unit.is_some_and(|unit| unit.signed != [false; 4]));
        let mut shader = units.shader;
        let lowered = match self {
            ApiProgram::Stages(program) => {
                let bound = units.bound.map(|unit| unit.is_some());
                stages::lower(program, &stages::Context { profile, bound, signed, fog }).map(|lowered| {
                    for (stage, change) in shader.iter_mut().zip(&lowered.units) {
                        stage.coordinate_set = change.coordinate_set.unwrap_or(stage.coordinate_set);
                        if let Some((operation, previous)) = change.operation {
                            (stage.operation, stage.previous) = (operation, previous);
                        }
                    }
                    (lowered.combiners, lowered.origins)
                })
            }
            ApiProgram::Environment(program) => {
                let format = |unit: crate::state::TextureUnit| textures.list.get(unit.texture).map(|t| t.format);
                let textures = units.bound.map(|unit| unit.and_then(format).map(BaseFormat::of));
                let context = environment::Context { profile, textures, signed, fog };
                environment::lower(program, &context).map(|lowered| (lowered.combiners, lowered.origins))
            }
        };
        match lowered {
            Ok((combiners, origins)) => Lowered { combiners, origins, shader },
            Err(findings) => {
                report(reader, findings);
                Lowered { combiners: combiner::default_program(), origins: Vec::new(), shader }
            }
        }
    }
}

/// Records findings, each once: several draws may share a program.
fn report(reader: &mut Reader<'_>, findings: Vec<Diagnostic>) {
    for finding in findings {
        if !reader.diagnostics.contains(&finding) {
            reader.push(finding);
        }
    }
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
