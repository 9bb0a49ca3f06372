//! Pixel programs: which language one is in, and what all of them have in common.

use super::api_program::ApiProgram;
use super::names::Names;
use super::program_text::ProgramText;
use super::*;
use crate::program::Places;
use crate::program::legality::{Notation, check};
use crate::program::text::{self, words::Words};
use crate::state::Combiners;

/// A program as a draw takes it.
pub(super) enum Program {
    /// Written for the combiners.
    Combiners(ProgramData),
    /// Written for an API: what it becomes depends on the draw.
    Api(ApiProgram),
}

/// A program for the combiners, and what only a draw can judge.
pub(super) struct ProgramData {
    pub(super) combiners: Combiners,
    /// The first place that reads each texture unit.
    pub(super) reads: [Option<Range<usize>>; 4],
}

const KINDS: &[&str] =
    &["Combiners", "TextureStages", "TextureEnvironment", "CombinerText", "PixelShader", "RegisterWords"];

/// Reads a pixel program.
pub(super) fn program<'a>(
    reader: &mut Reader<'a>,
    names: &Names<'a>,
    raw: &Raw<'a, source::Program>,
) -> Option<Program> {
    let (kind, rest) = reader.variant(raw, "pixel program", KINDS)?;
    let errors = reader.errors;
    let data = match kind {
        0 => {
            let (combiners, places) = combiner::combiners(reader, names, rest)?;
            judge(reader, combiners, &places, &combiner::Fields, None)
        }
        1 => return texture_stages::texture_stages(reader, names, rest).map(Program::Api),
        2 => return texture_environment::texture_environment(reader, names, rest).map(Program::Api),
        3 => {
            let program = ProgramText::read(reader, names, rest)?;
            match text::read(&program.text) {
                Ok((combiners, places)) => judge(reader, combiners, &places, &Words, Some(&program)),
                Err(findings) => {
                    findings.into_iter().for_each(|finding| reader.push(program.place(finding)));
                    return None;
                }
            }
        }
        4 => return pixel_shader::pixel_shader(reader, names, rest).map(Program::Api),
        _ => {
            let (combiners, places) = register_words::register_words(reader, rest)?;
            judge(reader, combiners, &places, &Words, None)
        }
    };
    (reader.errors == errors).then_some(Program::Combiners(data))
}

/// Holds a program against the chip. `inside`: the text that the places are of, if it is not the scene.
fn judge(
    reader: &mut Reader<'_>,
    combiners: Combiners,
    places: &Places,
    notation: &dyn Notation,
    inside: Option<&ProgramText>,
) -> ProgramData {
    let checked = check(&combiners, reader.profile, places, notation);
    for finding in checked.findings {
        reader.push(match inside {
            Some(text) => text.place(finding),
            None => finding,
        });
    }
    let reads = checked.reads.map(|read| match (read, inside) {
        (Some(place), Some(text)) => Some(text.span(place)),
        (read, _) => read,
    });
    ProgramData { combiners, reads }
}
