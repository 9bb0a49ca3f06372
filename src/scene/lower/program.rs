//! Pixel programs: which language one is in, and what all of them have in common.

use super::api_program::ApiProgram;
use super::names::Names;
use super::*;
use crate::program::Places;
use crate::program::legality::{Notation, check};
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
    let (combiners, places) = match kind {
        0 => combiner::combiners(reader, names, rest)?,
        1 => return texture_stages::texture_stages(reader, names, rest).map(Program::Api),
        2 => return texture_environment::texture_environment(reader, names, rest).map(Program::Api),
        _ => {
            let what = ["", "", "", "the combiner text language", "pixel shader text", "raw register words"][kind];
            reader.not_built(reader.range(&raw.text[..KINDS[kind].len()]), what);
            return None;
        }
    };
    let data = judge(reader, combiners, &places, &combiner::Fields);
    (reader.errors == errors).then_some(Program::Combiners(data))
}

/// Holds a program against the chip.
fn judge(reader: &mut Reader<'_>, combiners: Combiners, places: &Places, notation: &dyn Notation) -> ProgramData {
    let checked = check(&combiners, reader.profile, places, notation);
    checked.findings.into_iter().for_each(|finding| reader.push(finding));
    ProgramData { combiners, reads: checked.reads }
}
