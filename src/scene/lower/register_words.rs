//! Lowers `RegisterWords(...)`: combiners given as the words of a chip's registers.

use super::program_text::{ProgramText, placed};
use super::*;
use ninebit_program::Places;
use ninebit_program::registers::{Word, WordText, read};

/// Reads a program with the places of its parts. Also returns the text that the places refer to, if it is not the scene. Returns `None`
/// after recording what is wrong.
pub(super) fn program<'a>(reader: &mut Reader<'a>, text: &'a str) -> Option<(Combiners, Places, Option<ProgramText>)> {
    let fields = reader.read(&Raw::<source::RegisterWords<'a>>::new(text))?;
    let opening = reader.opening(text);
    let mut inside = None;
    let given = match (&fields.nv10, &fields.nv20, &fields.text, &fields.file) {
        (Some(raw), None, None, None) => {
            let fields = reader.read(raw)?;
            words(reader, Profile::Nv10, fields.written(), opening)
        }
        (None, Some(raw), None, None) => {
            let fields = reader.read(raw)?;
            words(reader, Profile::Nv2a, fields.written(), opening)
        }
        (None, None, Some(raw), None) => {
            inside = Some(ProgramText::inline(reader, raw)?);
            listed(reader, inside.as_ref()?)?
        }
        (None, None, None, Some(raw)) => {
            inside = Some(ProgramText::file(reader, raw)?);
            listed(reader, inside.as_ref()?)?
        }
        _ => {
            let label = "one of `nv10`, `nv20`, `text` and `file` is to be here";
            let help =
                "write `RegisterWords(nv10: (rc_in_rgb: [0x08040000], ...))`, `nv20: (...)`, or `file: \"words.txt\"`";
            return reader.refuse(finding("NB0202", opening, "register words are those of one chip", label, help));
        }
    };
    if given.wrong {
        return None;
    }
    let (combiners, places) = decoded(reader, given.written, inside.as_ref())?;
    Some((combiners, places, inside))
}

/// Reads the program from words in a text of their own.
pub(super) fn of_text(reader: &mut Reader<'_>, text: &ProgramText) -> Option<(Combiners, Places)> {
    let given = listed(reader, text)?;
    decoded(reader, given.written, Some(text))
}

fn decoded(reader: &mut Reader<'_>, words: WordText, inside: Option<&ProgramText>) -> Option<(Combiners, Places)> {
    let found = |findings| placed(inside, findings).into_iter().for_each(|finding| reader.push(finding));
    words.program().map_err(found).ok()
}

/// Reads words in a text of their own, for the scene's chip.
fn listed(reader: &mut Reader<'_>, text: &ProgramText) -> Option<WordReader> {
    let written = text.parsed(reader, read(&text.text, reader.profile))?;
    Some(WordReader { written, wrong: false })
}

/// Words, and whether one of them could not be read.
struct WordReader {
    written: WordText,
    wrong: bool,
}

impl WordReader {
    fn set(&mut self, reader: &mut Reader<'_>, word: Word, index: usize, raw: &Raw<'_, u32>, value: Option<u32>) {
        self.wrong |= value.is_none();
        self.written.set(word, index, value.unwrap_or(0), reader.range(raw.text));
    }

    fn list<'a>(&mut self, reader: &mut Reader<'a>, word: Word, raw: &Raw<'a, source::List<'a, u32>>) {
        let Some(list) = reader.read(raw) else {
            self.wrong = true;
            return;
        };
        let most = word.count(self.written.words.chip);
        if let Some(extra) = list.get(most) {
            let message = format!("there are {most} words of {}, not {}", word.name(), list.len());
            reader.push(Diagnostic::error("NB0211", reader.span(extra), message).label("too many from here"));
            self.wrong = true;
        }
        for (index, raw) in list.iter().enumerate().take(most) {
            let value = reader.read(raw);
            self.set(reader, word, index, raw, value);
        }
    }
}

/// Reads the words of a chip. `fields` are the fields that are written.
fn words<'a>(
    reader: &mut Reader<'a>,
    chip: Profile,
    fields: impl Iterator<Item = (&'static str, &'a str)>,
    opening: Span,
) -> WordReader {
    let mut given = WordReader { written: WordText::new(chip, opening), wrong: false };
    for (name, text) in fields {
        let word = Word::ALL.iter().copied().find(|word| word.name() == name);
        match word.map(|word| (word, word.count(chip))) {
            Some((word, 1)) => {
                let raw = Raw::new(text);
                let value = reader.read(&raw);
                given.set(reader, word, 0, &raw, value);
            }
            Some((word, _)) => given.list(reader, word, &Raw::new(text)),
            None => {}
        }
    }
    given
}
