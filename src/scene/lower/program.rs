//! Pixel programs: which language one is in, and what all of them have in common.

use super::api_program::ApiProgram;
use super::program_text::{ProgramText, placed};
use super::*;
use ninebit::legality::{Notation, check};
use ninebit::state::Combiners;
use ninebit_program::c_source::Style;
use ninebit_program::combiner_calls;
use ninebit_program::text::{self, words::Words};
use ninebit_program::{Aside, Pasted, Places};

/// A program as a draw takes it.
pub(crate) struct Program {
    pub(super) form: Form,
    /// What its text says of the draw besides.
    pub(super) asides: Asides,
}

/// Warnings about states in a pasted text, each with the field of the draw that says the same.
pub(super) type Asides = Vec<(Diagnostic, &'static str)>;

/// What a program is written in.
pub(super) enum Form {
    /// Written for the combiners.
    Combiners(ProgramData),
    /// Written for an API: what it becomes depends on the draw.
    Api(ApiProgram),
}

/// A program for the combiners, and what only a draw can judge.
pub(super) struct ProgramData {
    pub(super) combiners: Combiners,
    /// The first place that reads each texture unit.
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
    let api = |form: Option<ApiProgram>, asides| form.map(|form| Program { form: Form::Api(form), asides });
    let data = match kind {
        0 => {
            let (combiners, places) = combiner::combiners(reader, rest)?;
            judge(reader, combiners, &places, &combiner::Fields, None)
        }
        1 => return api(texture_stages::read(reader, rest, &mut asides), asides),
        2 => return api(texture_environment::read(reader, rest, &mut asides), asides),
        3 => {
            let program = ProgramText::read(reader, rest)?.expanded(reader, Style::Combiners)?;
            let read = program.parsed(reader, text::read(&program.text))?;
            program.push(reader, read.warnings);
            judge(reader, read.combiners, &read.places, &Words, Some(&program))
        }
        4 => return api(pixel_shader::pixel_shader(reader, rest), asides),
        6 => {
            let text = ProgramText::read(reader, rest)?.expanded(reader, Style::Calls)?;
            let combiner_calls::Program { combiners, places } =
                pasted(reader, &text, combiner_calls::parse(&text.text), &mut asides)?;
            judge(reader, combiners, &places, &combiner_calls::Words, Some(&text))
        }
        _ => {
            let (combiners, places, inside) = register_words::program(reader, rest)?;
            judge(reader, combiners, &places, &Words, inside.as_ref())
        }
    };
    (reader.errors == errors).then_some(Program { form: Form::Combiners(data), asides })
}

/// The program of a pasted text, its warnings told or kept for the draws. `None` once the reasons that it is none have been recorded.
pub(super) fn pasted<P>(
    reader: &mut Reader<'_>,
    text: &ProgramText,
    pasted: Result<Pasted<P>, Vec<Diagnostic>>,
    asides: &mut Asides,
) -> Option<P> {
    let Pasted { program, asides: found } = text.parsed(reader, pasted)?;
    for Aside { finding, field } in found {
        match field {
            Some(field) => asides.push((text.place(finding), field)),
            None => reader.push(text.place(finding)),
        }
    }
    Some(program)
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
    placed(inside, checked.findings).into_iter().for_each(|finding| reader.push(finding));
    let reads = checked.reads.map(|read| match (read, inside) {
        (Some(place), Some(text)) => Some(text.span(place)),
        (read, _) => read,
    });
    ProgramData { combiners, reads }
}

/// The calls of a program of an API, if it is given by these, as a text or in a file, and not by fields at once. `what`: how it and its fields are called.
/// `None` once the reason that they cannot be read has been recorded.
pub(super) fn calls<'a>(
    reader: &mut Reader<'a>,
    fields: Option<Span>,
    text: &Option<Raw<'a, String>>,
    file: &Option<Raw<'a, String>>,
    (what, name): (&str, &str),
) -> Option<Option<ProgramText>> {
    let given = [fields, text.as_ref().map(|raw| reader.span(raw)), file.as_ref().map(|raw| reader.span(raw))];
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
