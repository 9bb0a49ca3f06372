//! Reads operands: registers with their swizzles and write masks.

use super::parser::Parser;
use crate::Span;
use crate::cursor::{GivenUp, Read};
use crate::spelling::closest;
use ninebit::diagnostic::shorten;
use ninebit::vertex::shader::*;

/// A kind of registers: the name in documents, the number of registers, what they are, and a function that returns the register of a number.
type Family = (&'static str, usize, &'static str, fn(usize) -> Register);

const FAMILIES: &[Family] = &[
    ("v", INPUTS, "inputs", |n| Register::Source(SourceRegister::Input(n))),
    ("r", TEMPORARIES, "temporaries", |n| Register::Source(SourceRegister::Temporary(n))),
    ("c", CONSTANTS, "constants", |n| Register::Source(SourceRegister::Constant { index: n, relative: false })),
    ("a", 1, "address register", |_| Register::Destination(DestinationRegister::Address)),
    ("oPos", 0, "position", |_| Register::Destination(DestinationRegister::Position)),
    ("oFog", 0, "fog factor", |_| Register::Destination(DestinationRegister::Fog)),
    ("oPts", 0, "point size", |_| Register::Destination(DestinationRegister::PointSize)),
    ("oD", 2, "colours", |n| Register::Destination(DestinationRegister::Color(n))),
    ("oT", COORDINATES, "sets of texture coordinates", |n| Register::Destination(DestinationRegister::Coordinates(n))),
];

const ALL: &str = "v0 to v15, r0 to r11, c0 to c95, a0, oPos, oD0, oD1, oT0 to oT3, oFog, oPts";

/// A register of the language.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Register {
    Source(SourceRegister),
    Destination(DestinationRegister),
    /// `c[...]`; its brackets follow.
    Constants,
}

/// Reads the destination of an instruction.
pub(super) fn destination(parser: &mut Parser<'_>) -> Read<(Destination, Span)> {
    let start = parser.cursor.span().start;
    if let Some(minus) = parser.sign('-') {
        let help = "negate the sources instead";
        return Err(parser.refuse("NB0380", minus, "a result cannot be negated", "not before what is written", help));
    }
    let (found, span) = register(parser)?;
    let register = match found {
        Register::Destination(register) => register,
        Register::Source(SourceRegister::Temporary(index)) => DestinationRegister::Temporary(index),
        Register::Source(_) | Register::Constants => {
            let name = parser.cursor.text(&span).to_owned();
            let message = format!("`{name}` cannot be written");
            let help = "write to r0 to r11 or an output, such as oPos; `def` gives a constant its value";
            return Err(parser.refuse("NB0380", span, &message, "only read", help));
        }
    };
    let mask = match modifier(parser)? {
        None => match register {
            DestinationRegister::Address | DestinationRegister::Fog | DestinationRegister::PointSize => 1,
            _ => 15,
        },
        Some(span) => mask(parser, parser.cursor.text(&span), span.clone(), register)?,
    };
    Ok((Destination { register, mask }, start..parser.cursor.end()))
}

/// Reads a source of an instruction.
pub(super) fn source(parser: &mut Parser<'_>) -> Read<(Source, Span)> {
    let start = parser.cursor.span().start;
    let negate = parser.sign('-').is_some();
    let (found, span) = register(parser)?;
    let register = match found {
        Register::Source(register) => register,
        Register::Constants => relative(parser)?,
        Register::Destination(register) => {
            let name = parser.cursor.text(&span).to_owned();
            let help = match register {
                DestinationRegister::Address => "use it in `c[a0.x + 4]`",
                _ => "keep the value in a temporary, and move it to the output as well",
            };
            let message = format!("`{name}` cannot be read");
            return Err(parser.refuse("NB0380", span, &message, "only written", help));
        }
    };
    let swizzle = match modifier(parser)? {
        None => [0, 1, 2, 3],
        Some(span) => swizzle(parser, parser.cursor.text(&span), span.clone())?,
    };
    Ok((Source { register, swizzle, negate }, start..parser.cursor.end()))
}

/// Reads the name of a register, or `c` before a bracket.
fn register(parser: &mut Parser<'_>) -> Read<(Register, Span)> {
    let span = parser.word();
    let word = parser.cursor.text(&span).to_owned();
    if word.is_empty() {
        return Err(parser.expected("a register"));
    }
    let letters = word.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = &word[letters.len()..];
    let Some((name, count, what, of)) = FAMILIES.iter().find(|(name, ..)| name.eq_ignore_ascii_case(letters)) else {
        return Err(unknown(parser, &word, span));
    };
    if digits.is_empty() != (*count == 0) {
        let brackets = *name == "c" && parser.cursor.is('[');
        return if brackets { Ok((Register::Constants, span)) } else { Err(unknown(parser, &word, span)) };
    }
    let number = digits.parse::<usize>().unwrap_or(usize::MAX);
    if *count > 0 && number >= *count {
        let have = if *count == 1 { "there is one".to_owned() } else { format!("there are {count}") };
        let message = format!("there is no register {}: {have} {what}", shorten(&word));
        let help = match *count {
            1 => format!("write {name}0"),
            count => format!("write {name}0 to {name}{}", count - 1),
        };
        return Err(parser.refuse("NB0206", span, &message, "out of range", &help));
    }
    Ok((of(number), span))
}

fn unknown(parser: &mut Parser<'_>, word: &str, span: Span) -> GivenUp {
    let known = ["v0", "r0", "c0", "a0", "oPos", "oFog", "oPts", "oD0", "oD1", "oT0", "oT1", "oT2", "oT3"];
    let help = match closest(word, known) {
        Some(name) => format!("did you mean `{name}`? Registers: {ALL}"),
        None => format!("registers: {ALL}"),
    };
    parser.refuse("NB0204", span, &format!("there is no register `{}`", shorten(word)), "not known", &help)
}

/// Reads `[a0.x + 4]`, `[4 + a0.x]` or `[4]`.
fn relative(parser: &mut Parser<'_>) -> Read<SourceRegister> {
    let Some(open) = parser.sign('[') else { return Err(parser.expected("`[`")) };
    let (mut relative, mut index) = (false, None);
    loop {
        let span = parser.word();
        let word = parser.cursor.text(&span).to_ascii_lowercase();
        if word == "a0" && !relative {
            relative = true;
            let component = match parser.sign('.') {
                Some(_) => parser.word(),
                None => span.clone(),
            };
            if !parser.cursor.text(&component).eq_ignore_ascii_case("x") {
                let message = "the address register is read as a0.x";
                return Err(parser.refuse("NB0380", component, message, "has no other component", "write `a0.x`"));
            }
        } else if let (Ok(number), None) = (word.parse::<usize>(), index) {
            if number >= CONSTANTS {
                let message = format!("there is no constant c{number}");
                return Err(parser.refuse("NB0206", span, &message, "out of range", "write 0 to 95"));
            }
            index = Some(number);
        } else {
            let message = "expected a0.x or a number in these brackets";
            return Err(parser.refuse("NB0108", open, message, "opened here", "write `c[a0.x + 4]`"));
        }
        if parser.sign(']').is_some() {
            break;
        }
        if parser.sign('+').is_none() {
            return Err(parser.expected("`+` or `]`"));
        }
    }
    Ok(SourceRegister::Constant { index: index.unwrap_or(0), relative })
}

/// Takes the letters behind a point, if there is one.
fn modifier(parser: &mut Parser<'_>) -> Read<Option<Span>> {
    if parser.sign('.').is_none() {
        return Ok(None);
    }
    let span = parser.word();
    if span.is_empty() { Err(parser.expected("components, such as `.xyz`")) } else { Ok(Some(span)) }
}

/// Returns the number of a component.
fn component(letter: char) -> Option<usize> {
    "xyzw".find(letter.to_ascii_lowercase())
}

fn swizzle(parser: &mut Parser<'_>, word: &str, span: Span) -> Read<[usize; 4]> {
    let components: Option<Vec<usize>> = word.chars().map(component).collect();
    match components.as_deref() {
        // With fewer than four letters the last one is repeated.
        Some(list @ [.., last]) if list.len() <= 4 => Ok(std::array::from_fn(|k| *list.get(k).unwrap_or(last))),
        _ => Err(letters(parser, word, span, "a swizzle", "one to four of x, y, z, w, such as `.yzxw` or `.x`")),
    }
}

fn mask(parser: &mut Parser<'_>, word: &str, span: Span, register: DestinationRegister) -> Read<u8> {
    let components: Option<Vec<usize>> = word.chars().map(component).collect();
    let ascending = |list: &[usize]| list.windows(2).all(|pair| pair[0] < pair[1]);
    let Some(list) = components.filter(|list| !list.is_empty() && ascending(list)) else {
        return Err(letters(parser, word, span, "a write mask", "some of x, y, z, w in this order, such as `.xyz`"));
    };
    let mask = list.iter().fold(0, |mask, k| mask | 1 << k);
    let name = match register {
        DestinationRegister::Address => "a0",
        DestinationRegister::Fog => "oFog",
        DestinationRegister::PointSize => "oPts",
        _ => return Ok(mask),
    };
    if mask == 1 {
        return Ok(mask);
    }
    let message = format!("{name} has one component");
    Err(parser.refuse("NB0384", span, &message, "more than that", &format!("write `{name}.x`")))
}

fn letters(parser: &mut Parser<'_>, word: &str, span: Span, what: &str, help: &str) -> GivenUp {
    let colors = word.chars().all(|c| "rgba".contains(c.to_ascii_lowercase()));
    let help = if colors {
        "components of vertex programs are x, y, z, w, in place of r, g, b, a".to_owned()
    } else {
        format!("write {help}")
    };
    parser.refuse("NB0384", span, &format!("`.{}` is not {what}", shorten(word)), "these components", &help)
}
