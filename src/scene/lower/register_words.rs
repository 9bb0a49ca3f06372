//! `RegisterWords(...)`: the combiners as the words of a chip's registers.

use super::*;
use ninebit::state::{Combiners, Named};
use ninebit_program::registers::{RegisterWords, Word, decode, word_of};
use ninebit_program::{Part, Place, Places};

/// The program of the words, and where its parts stand. `None` once the reason has been recorded.
pub(super) fn register_words<'a>(reader: &mut Reader<'a>, text: &'a str) -> Option<(Combiners, Places)> {
    let fields = reader.read(&Raw::<source::RegisterWords<'a>>::new(text))?;
    let opening = reader.range(text.get(..1).unwrap_or(text));
    let mut given = match (&fields.nv10, &fields.nv20) {
        (Some(raw), None) => nv10(reader, raw)?,
        (None, Some(raw)) => nv20(reader, raw)?,
        _ => {
            reader.push(
                Diagnostic::error("NB0202", opening, "register words are those of one chip")
                    .label("`nv10` or `nv20` is missing, or both are here")
                    .help("write `RegisterWords(nv10: (rc_in_rgb: [0x08040000], ...))` or `nv20: (...)`"),
            );
            return None;
        }
    };
    given.opening = opening;
    if given.wrong {
        return None;
    }
    match decode(&given.words) {
        Ok(combiners) => {
            let places = given.parts(&combiners);
            Some((combiners, places))
        }
        Err(refusals) => {
            for refusal in refusals {
                let place = given.place(refusal.word, refusal.index);
                reader.push(
                    Diagnostic::error(refusal.code, place, refusal.message)
                        .label("this word")
                        .rule("CMB-12")
                        .help(refusal.help),
                );
            }
            None
        }
    }
}

/// Words, and where each stands.
struct Given {
    words: RegisterWords,
    places: Vec<(Word, usize, Range<usize>)>,
    opening: Range<usize>,
    wrong: bool,
}

impl Given {
    fn new(chip: Profile) -> Self {
        Given { words: RegisterWords::new(chip), places: Vec::new(), opening: 0..0, wrong: false }
    }

    fn set(&mut self, reader: &mut Reader<'_>, word: Word, index: usize, raw: &Raw<'_, u32>, value: Option<u32>) {
        self.places.push((word, index, reader.range(raw.text)));
        match value {
            Some(value) => self.words.set(word, index, value),
            None => self.wrong = true,
        }
    }

    fn one<'a>(&mut self, reader: &mut Reader<'a>, word: Word, field: &Option<Raw<'a, u32>>) {
        if let Some(raw) = field {
            let value = reader.read(raw);
            self.set(reader, word, 0, raw, value);
        }
    }

    fn list<'a>(&mut self, reader: &mut Reader<'a>, word: Word, field: &Option<Raw<'a, source::List<'a, u32>>>) {
        let Some(raw) = field else { return };
        let Some(list) = reader.read(raw) else {
            self.wrong = true;
            return;
        };
        let most = word.count(self.words.chip);
        if let Some(extra) = list.get(most) {
            let message = format!("there are {most} words of {}, not {}", word.name(), list.len());
            let finding = Diagnostic::error("NB0211", reader.span(extra), message).label("too many from here");
            reader.push(finding);
            self.wrong = true;
        }
        for (index, raw) in list.iter().enumerate().take(most) {
            let value = reader.read(raw);
            self.set(reader, word, index, raw, value);
        }
    }

    /// Where a word stands; the beginning of all if it does not.
    fn place(&self, word: Word, index: usize) -> Range<usize> {
        let found = self.places.iter().find(|(known, n, _)| (*known, *n) == (word, index));
        found.map_or(self.opening.clone(), |(_, _, place)| place.clone())
    }

    /// Where the parts of the program stand: in their words.
    fn parts(&self, combiners: &Combiners) -> Places {
        let mut places = Places::default();
        let mut note = |place| {
            let (word, index) = word_of(place, self.words.chip);
            places.set(place, self.place(word, index));
        };
        note(Place::Stages);
        for (stage, state) in combiners.stages.iter().enumerate() {
            note(Place::Stage(stage));
            if state.constants != combiners.final_combiner.constants {
                note(Place::StageConstants(stage));
            }
            for alpha in [false, true] {
                let products = [0, 1].into_iter().flat_map(|n| [Part::Dot(n), Part::BlueToAlpha(n)]);
                let outputs = (0..3).map(Part::Output);
                let parts = (0..4).map(Part::Input).chain(outputs).chain(products).chain([Part::Scale, Part::Bias]);
                parts.for_each(|part| note(Place::General { stage, alpha, part }));
            }
        }
        (0..7).for_each(|n| note(Place::FinalInput(n)));
        places
    }
}

fn nv10<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Nv10Words<'a>>) -> Option<Given> {
    let fields = reader.read(raw)?;
    let mut given = Given::new(Profile::Nv10);
    given.list(reader, Word::RcInAlpha, &fields.rc_in_alpha);
    given.list(reader, Word::RcInRgb, &fields.rc_in_rgb);
    given.list(reader, Word::RcColor, &fields.rc_color);
    given.list(reader, Word::RcOutAlpha, &fields.rc_out_alpha);
    given.list(reader, Word::RcOutRgb, &fields.rc_out_rgb);
    given.one(reader, Word::RcFinal0, &fields.rc_final0);
    given.one(reader, Word::RcFinal1, &fields.rc_final1);
    Some(given)
}

fn nv20<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Nv20Words<'a>>) -> Option<Given> {
    let fields = reader.read(raw)?;
    let mut given = Given::new(Profile::Nv2a);
    given.list(reader, Word::RcInAlpha, &fields.rc_in_alpha);
    given.list(reader, Word::RcInRgb, &fields.rc_in_rgb);
    given.list(reader, Word::RcColor, &fields.rc_color);
    given.list(reader, Word::RcConstantColor0, &fields.rc_constant_color0);
    given.list(reader, Word::RcConstantColor1, &fields.rc_constant_color1);
    given.list(reader, Word::RcOutAlpha, &fields.rc_out_alpha);
    given.list(reader, Word::RcOutRgb, &fields.rc_out_rgb);
    given.one(reader, Word::RcFinal0, &fields.rc_final0);
    given.one(reader, Word::RcFinal1, &fields.rc_final1);
    given.one(reader, Word::RcConfig, &fields.rc_config);
    Some(given)
}
