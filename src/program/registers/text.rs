//! Reads register words as text: lines with a name or method and its words, as in drivers, logs of pushbuffers and the Xbox's shader definitions.

use crate::{Part, Place, Places, Span};
use ninebit::diagnostic::{DOCUMENTS, Diagnostic};
use ninebit::state::{Combiners, Named, Profile};

use super::{Refusal, RegisterWords, Word, decode, word_of};
use crate::cursor::Cursor;
use crate::finding::finding;
use crate::lexer::{Kind, Language};

/// Words, with their places in a text.
#[derive(Clone, Debug)]
pub struct WordText {
    /// The words that were read.
    pub words: RegisterWords,
    places: Vec<(Word, usize, Span)>,
    /// Place that stands for words that are not written.
    opening: Span,
}

impl WordText {
    /// Makes words that are all 0. `opening` is the place of words that are not written.
    pub fn new(chip: Profile, opening: Span) -> WordText {
        WordText { words: RegisterWords::new(chip), places: Vec::new(), opening }
    }

    /// Sets a word that is written at `span`.
    pub fn set(&mut self, word: Word, index: usize, value: u32, span: Span) {
        self.places.push((word, index, span));
        self.words.set(word, index, value);
    }

    /// Returns the place where a word is written last, or the opening if it is not written.
    fn span(&self, word: Word, index: usize) -> Span {
        let found = self.places.iter().rev().find(|(known, n, _)| (*known, *n) == (word, index));
        found.map_or(self.opening.clone(), |(_, _, span)| span.clone())
    }

    /// Decodes the program of the words. Also returns the places of its parts.
    ///
    /// # Errors
    /// A finding for every word that the chip does not accept.
    pub fn program(&self) -> Result<(Combiners, Places), Vec<Diagnostic>> {
        let refused = |Refusal { code, word, index, message, help }: Refusal| {
            finding(code, self.span(word, index), message, "this word", help).rule("CMB-12")
        };
        let combiners =
            decode(&self.words).map_err(|refusals| refusals.into_iter().map(refused).collect::<Vec<_>>())?;
        let places = self.parts(&combiners);
        Ok((combiners, places))
    }

    /// Returns the places of the program's parts, which are those of their words.
    fn parts(&self, combiners: &Combiners) -> Places {
        let mut places = Places::default();
        let mut note = |part| {
            let (word, index) = word_of(part, self.words.chip);
            places.set(part, self.span(word, index));
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

/// Names of words besides those of [`Word`], in upper case: the names, the word, and its index.
///
/// They are the methods in the Xbox's headers and the fields of its shader definitions.
const NAMES: [(&str, Word, usize); 11] = [
    ("SET_COMBINER_ALPHA_ICW PSALPHAINPUTS", Word::RcInAlpha, 0),
    ("SET_COMBINER_COLOR_ICW PSRGBINPUTS", Word::RcInRgb, 0),
    ("SET_COMBINER_ALPHA_OCW PSALPHAOUTPUTS", Word::RcOutAlpha, 0),
    ("SET_COMBINER_COLOR_OCW PSRGBOUTPUTS", Word::RcOutRgb, 0),
    ("SET_COMBINER_FACTOR0 PSCONSTANT0", Word::RcConstantColor0, 0),
    ("SET_COMBINER_FACTOR1 PSCONSTANT1", Word::RcConstantColor1, 0),
    ("SET_COMBINER_CONTROL PSCOMBINERCOUNT", Word::RcConfig, 0),
    ("SET_COMBINER_SPECULAR_FOG_CW0 PSFINALCOMBINERINPUTSABCD", Word::RcFinal0, 0),
    ("SET_COMBINER_SPECULAR_FOG_CW1 PSFINALCOMBINERINPUTSEFG", Word::RcFinal1, 0),
    ("SET_SPECULAR_FOG_FACTOR PSFINALCOMBINERCONSTANT0 RC_COLOR0", Word::RcColor, 0),
    ("PSFINALCOMBINERCONSTANT1 RC_COLOR1", Word::RcColor, 1),
];

/// Fields of the Xbox's shader definitions that do not concern the combiners; they are skipped.
const ASIDE: &str = "PSCOMPAREMODE PSTEXTUREMODES PSDOTMAPPING PSINPUTTEXTURE PSC0MAPPING PSC1MAPPING \
                     PSFINALCOMBINERCONSTANTS";

/// Returns whether a list of words has a word.
fn has_word(words: &str, word: &str) -> bool {
    words.split(' ').any(|known| known == word)
}

/// A piece of a statement: a name, a method or a number.
struct Piece<'t> {
    text: &'t str,
    /// Whether it follows an opening bracket.
    bracketed: bool,
    span: Span,
}

impl Piece<'_> {
    /// Parses a number, which is hexadecimal if it has `0x` or eight digits.
    fn number(&self) -> Option<u32> {
        let hexadecimal = self.text.strip_prefix("0x").or_else(|| self.text.strip_prefix("0X"));
        match hexadecimal.or(Some(self.text).filter(|text| text.len() == 8)) {
            Some(digits) => u32::from_str_radix(digits, 16).ok(),
            None => self.text.parse().ok(),
        }
    }
}

/// Reads words of a chip, one statement in each line or up to `;`. A statement is a name, which may have an index in brackets, or a method; then the
/// values of that word and of those that follow it. Spaces, commas, colons, `=` and braces separate them; `//`, `#` and `/* */` begin comments.
///
/// Names are those of [`Word`], with or without the prefixes `NV_`, `NV10_`, `NV20_`, `NV097_`, the Xbox's names of methods, and the fields of its
/// shader definitions.
///
/// # Errors
/// Findings about whatever is not a statement, name, method or number.
pub fn read(text: &str, chip: Profile) -> Result<WordText, Vec<Diagnostic>> {
    let mut written = WordText::new(chip, 0..text.find('\n').unwrap_or(text.len()));
    let mut findings = Vec::new();
    let mut cursor = Cursor::new(text, Language::WORDS);
    while !cursor.is_done() {
        let mut statement: Vec<Piece<'_>> = Vec::new();
        loop {
            let span = cursor.span();
            match cursor.kind() {
                Some(Kind::Word | Kind::Number) => {
                    let bracketed = text[..span.start].ends_with(['[', '(']);
                    statement.push(Piece { text: cursor.text(&span), bracketed, span });
                }
                Some(Kind::Sign(sign)) if ";,:={}[]()".contains(sign) => {}
                _ => {
                    let help =
                        "write a line a word: `RC_IN_RGB[0] 0x08040000`, or a method and its word: `0x0ac0 0x08040000`";
                    findings.push(finding("NB0103", span, "this is no part of a list of register words", "here", help));
                }
            }
            let ended = cursor.take(';');
            if !ended {
                cursor.advance();
            }
            if ended || cursor.is_new_line() {
                break;
            }
        }
        finish(&statement, &mut written, &mut findings);
    }
    if findings.is_empty() { Ok(written) } else { Err(findings) }
}

/// Processes a statement.
fn finish(statement: &[Piece<'_>], written: &mut WordText, findings: &mut Vec<Diagnostic>) {
    let Some((name, rest)) = statement.split_first() else { return };
    let chip = written.words.chip;
    let (first, mut values) = match name.number() {
        Some(method) => (Word::of_method(method, chip), rest),
        None => {
            let upper = name.text.to_uppercase();
            let bare = ["NV_", "NV10_", "NV20_", "NV097_", "NV10TCL_", "NV20TCL_"];
            let bare = bare.iter().find_map(|prefix| upper.strip_prefix(prefix)).unwrap_or(&upper);
            if has_word(ASIDE, bare) {
                return;
            }
            let of_word = Word::ALL.iter().find(|word| word.name().to_uppercase() == bare).map(|word| (*word, 0));
            let known = of_word
                .or_else(|| NAMES.iter().find(|(names, ..)| has_word(names, bare)).map(|(_, word, n)| (*word, *n)));
            // `NAME[2] value`
            match (known, rest) {
                (Some((word, 0)), [index, values @ ..]) if word.count(chip) > 1 && is_index(index, word, chip) => {
                    (Some((word, index.text.parse().unwrap_or(0))), values)
                }
                (known, values) => (known, values),
            }
        }
    };
    let Some((word, index)) = first.filter(|(word, _)| word.count(chip) > 0) else {
        let message = match name.number() {
            Some(method) => format!("{method:#06x} is no method of the combiners"),
            None => format!("`{}` is no register of the combiners", name.text),
        };
        let help = format!("{DOCUMENTS}/languages/registers.md lists the words and methods of {}", chip.name());
        findings.push(finding("NB0204", name.span.clone(), message, "not known", help));
        return;
    };
    if values.is_empty() {
        findings.push(
            Diagnostic::error("NB0202", name.span.clone(), "a register without a word").label("what does it hold?"),
        );
    }
    if index + values.len() > word.count(chip) {
        let message = format!("there are {} words of {}", word.count(chip), word.name());
        let span =
            values.get(word.count(chip).saturating_sub(index)).map_or(name.span.clone(), |token| token.span.clone());
        findings.push(Diagnostic::error("NB0211", span, message).label("too many from here"));
        values = &[];
    }
    for (n, token) in values.iter().enumerate() {
        match token.number() {
            Some(value) => written.set(word, index + n, value, token.span.clone()),
            None => {
                let message = format!("`{}` is no word of 32 bits", token.text);
                let help = "write it with `0x`, or as eight hexadecimal digits, or in decimal";
                findings.push(finding("NB0205", token.span.clone(), message, "not a number", help));
            }
        }
    }
}

/// Returns whether a piece is the index of a word in an array.
fn is_index(token: &Piece<'_>, word: Word, chip: Profile) -> bool {
    token.bracketed && token.number().is_some_and(|n| (n as usize) < word.count(chip))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registers::describe;

    const NV20: &str = "NV097_SET_COMBINER_COLOR_ICW[0] = 0x08040000;\n0x1e40 00000c00\nPSCombinerCount: 1 // one\nRC_FINAL0 {0x0000000c}\n rc_final1, 0x00001c80";

    #[test]
    fn all_forms_are_read() {
        let written = read(NV20, Profile::Nv2a).unwrap_or_else(|findings| panic!("{findings:?}"));
        let set: Vec<(Word, usize, u32)> = written.words.all().filter(|(_, _, value)| *value != 0).collect();
        let expected = [
            (Word::RcInRgb, 0, 0x0804_0000),
            (Word::RcOutRgb, 0, 0xc00),
            (Word::RcFinal0, 0, 0xc),
            (Word::RcFinal1, 0, 0x1c80),
            (Word::RcConfig, 0, 1),
        ];
        assert_eq!(set, expected);
        assert!(written.program().is_ok());
    }

    /// The description of every word can be read back, by name and by method, for both chips.
    #[test]
    fn every_word_is_read_by_name_and_by_method() {
        for chip in [Profile::Nv10, Profile::Nv2a] {
            let mut words = RegisterWords::new(chip);
            let all: Vec<(Word, usize, u32)> = words.all().collect();
            for (n, (word, index, _)) in all.into_iter().enumerate() {
                words.set(word, index, 0x1234_0000 + n as u32);
            }
            let line = |by: &dyn Fn(&crate::registers::Description) -> String| {
                describe(&words).iter().map(|word| format!("{} {:#010x}\n", by(word), word.value)).collect::<String>()
            };
            for text in [line(&|word| word.name.clone()), line(&|word| format!("{:#06x}", word.method))] {
                let written = read(&text, chip).unwrap_or_else(|findings| panic!("{text}{findings:?}"));
                assert_eq!(written.words, words, "{text}");
            }
        }
    }

    #[test]
    fn what_is_wrong_is_said_where_it_stands() {
        let wrong = |text: &str| {
            let Err(findings) = read(text, Profile::Nv10) else { panic!("{text} is read") };
            (findings[0].code, text[findings[0].span.clone().unwrap_or(0..0)].to_string())
        };
        assert_eq!(wrong("RC_CONFIG 1"), ("NB0204", "RC_CONFIG".to_string()));
        assert_eq!(wrong("0x1234 1"), ("NB0204", "0x1234".to_string()));
        assert_eq!(wrong("RC_IN_RGB 1 2 3"), ("NB0211", "3".to_string()));
        assert_eq!(wrong("RC_IN_RGB[1] 2 3"), ("NB0211", "3".to_string()));
        assert_eq!(wrong("RC_IN_RGB[1]"), ("NB0202", "RC_IN_RGB".to_string()));
        assert_eq!(wrong("RC_FINAL0"), ("NB0202", "RC_FINAL0".to_string()));
        assert_eq!(wrong("RC_FINAL0 0xg"), ("NB0205", "0xg".to_string()));
        assert_eq!(wrong("RC_FINAL0 ? 3"), ("NB0103", "?".to_string()));
    }
}
