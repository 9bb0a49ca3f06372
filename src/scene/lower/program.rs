//! Lowers pixel programs of all languages.

use std::path::Path;

use super::api_program::{ApiProgram, Around, DrawProgram};
use super::program_text::{ProgramText, placed};
use super::unit::Units;
use super::*;
use ninebit::legality::{Notation, check};
use ninebit::state::named;
use ninebit_program::c_source::Style;
use ninebit_program::text::{self, words::Words};
use ninebit_program::{Aside, PastedProgram, Places};
use ninebit_program::{combiner_calls, texture_environment as environment, texture_stages as stages};

/// A pixel program of a draw.
pub(crate) struct Program {
    pub(super) form: Form,
    /// What the program's text says about the draw besides the program.
    pub(super) asides: Asides,
}

/// Warnings about states in a pasted text, each with the draw's field for the same state.
pub(super) type Asides = Vec<(Diagnostic, &'static str)>;

/// Form of a program.
pub(super) enum Form {
    /// A program for the combiners.
    Combiners(ProgramData),
    /// A program for an API: what it is lowered to depends on the draw.
    Api(ApiProgram),
}

/// A program for the combiners, and the places that only a draw can judge.
pub(super) struct ProgramData {
    pub(super) combiners: Combiners,
    /// For each texture unit, the first place that reads it.
    pub(super) reads: [Option<Span>; 4],
}

const KINDS: &[&str] = &[
    "Combiners",
    "TextureStages",
    "TextureEnvironment",
    "CombinerText",
    "PixelShader",
    "RegisterWords",
    "CombinerCalls",
];

/// Reads a pixel program.
pub(super) fn program<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Program>) -> Option<Program> {
    let (kind, rest) = reader.variant(raw, "pixel program", KINDS)?;
    let errors = reader.errors;
    let mut asides = Vec::new();
    let form = match kind {
        0 => {
            let (combiners, places) = combiner::combiners(reader, rest)?;
            Form::Combiners(judge(reader, combiners, &places, &combiner::Fields, None))
        }
        1 => Form::Api(texture_stages::read(reader, rest, &mut asides)?),
        2 => Form::Api(texture_environment::read(reader, rest, &mut asides)?),
        4 => Form::Api(pixel_shader::pixel_shader(reader, rest)?),
        3 | 6 => {
            let language = if kind == 3 { ProgramLanguage::Combiners } else { ProgramLanguage::CombinerCalls };
            let text = ProgramText::read(reader, rest)?;
            written(reader, language, text, &mut asides)?
        }
        _ => {
            let (combiners, places, inside) = register_words::program(reader, rest)?;
            Form::Combiners(judge(reader, combiners, &places, &Words, inside.as_ref()))
        }
    };
    // Errors of programs for an API are reported only once a draw lowers them.
    (reader.errors == errors || matches!(form, Form::Api(_))).then_some(Program { form, asides })
}

named! {
    /// The language of a pixel program in a file of its own, by its name on the command line.
    pub enum ProgramLanguage =>
    /// Returns a line about the language.
    about: &'static str {
        /// The combiner language.
        Combiners = "combiners" => "The combiner language",
        /// Names or methods of registers with their words.
        Registers = "registers" => "Register words: names or methods with their words",
        /// Calls of NV_register_combiners.
        CombinerCalls = "combiner-calls" => "Calls of NV_register_combiners",
        /// Direct3D's texture stages.
        TextureStages = "texture-stages" => "Calls or effect states of Direct3D's texture stages",
        /// OpenGL's texture environment.
        TextureEnvironment = "texture-environment" => "Calls of OpenGL's texture environment",
        /// Direct3D's pixel shaders.
        PixelShader = "pixel-shader" => "A Direct3D pixel shader, ps.1.1",
    }
}

/// Reads a pixel program from a file that no scene names. Returns `None` after recording what is wrong.
pub(super) fn in_file(reader: &mut Reader<'_>, path: &Path, language: ProgramLanguage) -> Option<Program> {
    let (errors, mut asides) = (reader.errors, Vec::new());
    let text = ProgramText::at(reader, path)?;
    let form = written(reader, language, text, &mut asides)?;
    (reader.errors == errors).then_some(Program { form, asides })
}

fn written(reader: &mut Reader<'_>, language: ProgramLanguage, text: ProgramText, asides: &mut Asides) -> Option<Form> {
    Some(match language {
        ProgramLanguage::Combiners => {
            let text = text.expanded(reader, Style::Combiners)?;
            let read = text.parsed(reader, text::read(&text.text))?;
            text.push(reader, read.warnings);
            Form::Combiners(judge(reader, read.combiners, &read.places, &Words, Some(&text)))
        }
        ProgramLanguage::Registers => {
            let (combiners, places) = register_words::of_text(reader, &text)?;
            Form::Combiners(judge(reader, combiners, &places, &Words, Some(&text)))
        }
        ProgramLanguage::CombinerCalls => {
            let text = text.expanded(reader, Style::Calls)?;
            let combiner_calls::Program { combiners, places } =
                pasted(reader, &text, combiner_calls::parse(&text.text), asides)?;
            Form::Combiners(judge(reader, combiners, &places, &combiner_calls::Words, Some(&text)))
        }
        ProgramLanguage::TextureStages => {
            let text = text.expanded(reader, Style::Calls)?;
            let program = pasted(reader, &text, stages::parse(&text.text), asides)?;
            Form::Api(ApiProgram::Stages(program, Some(text)))
        }
        ProgramLanguage::TextureEnvironment => {
            let text = text.expanded(reader, Style::Calls)?;
            let program = pasted(reader, &text, environment::parse(&text.text), asides)?;
            Form::Api(ApiProgram::Environment(program, Some(text)))
        }
        ProgramLanguage::PixelShader => {
            Form::Api(pixel_shader::shader(reader, text, Default::default(), Default::default())?)
        }
    })
}

impl Program {
    /// Lowers the program for a draw. Also returns, for each texture unit, the first place that reads it.
    pub(super) fn lower(
        &self,
        reader: &mut Reader<'_>,
        units: &Units,
        around: &mut Around,
    ) -> (DrawProgram, [Option<Span>; 4]) {
        match &self.form {
            Form::Combiners(program) => {
                (DrawProgram::as_written(program.combiners.clone(), units), program.reads.clone())
            }
            Form::Api(program) => (program.lower(reader, units, around), Default::default()),
        }
    }
}

/// Takes the program out of a pasted text; its warnings are recorded or kept for the draws. Returns `None` after recording what is wrong.
pub(super) fn pasted<P>(
    reader: &mut Reader<'_>,
    text: &ProgramText,
    pasted: Result<PastedProgram<P>, Vec<Diagnostic>>,
    asides: &mut Asides,
) -> Option<P> {
    let PastedProgram { program, asides: found } = text.parsed(reader, pasted)?;
    for Aside { finding, field } in found {
        match field {
            Some(field) => asides.push((text.locate(finding), field)),
            None => reader.push(text.locate(finding)),
        }
    }
    Some(program)
}

/// Checks a program against the chip. `inside` is the text that the places refer to, if it is not the scene.
fn judge(
    reader: &mut Reader<'_>,
    combiners: Combiners,
    places: &Places,
    notation: &dyn Notation,
    inside: Option<&ProgramText>,
) -> ProgramData {
    let checked = check(&combiners, reader.profile, places, notation);
    placed(inside, checked.findings).into_iter().for_each(|finding| reader.push(finding));
    let reads = checked.reads.map(|read| match (read, inside) {
        (Some(place), Some(text)) => Some(text.span(place)),
        (read, _) => read,
    });
    ProgramData { combiners, reads }
}

/// Reads the text of an API's calls, if the program is given by `text` or `file` and not by fields. `what` and `name` are what messages call
/// the program and its fields. Returns `Some(None)` if there is no text, and `None` after recording what is wrong.
pub(super) fn calls<'a>(
    reader: &mut Reader<'a>,
    fields: Option<Span>,
    text: &Option<Raw<'a, String>>,
    file: &Option<Raw<'a, String>>,
    (what, name): (&str, &str),
) -> Option<Option<ProgramText>> {
    let given = [fields, reader.place(text), reader.place(file)];
    let mut given = given.into_iter().flatten();
    let (Some(first), Some(second)) = (given.next(), given.next()) else {
        let text = match (text, file) {
            (Some(raw), _) => ProgramText::inline(reader, raw)?,
            (None, Some(raw)) => ProgramText::file(reader, raw)?,
            (None, None) => return Some(None),
        };
        return text.expanded(reader, Style::Calls).map(Some);
    };
    let message = format!("{what} given twice");
    let help = format!("keep one of `{name}`, `text` and `file`");
    reader.refuse(finding("NB0356", second, message, "again here", help).related(first, "first here"))
}
