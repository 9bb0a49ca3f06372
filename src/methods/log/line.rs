//! A line of a log.

use super::event::{Event, Write};
use crate::class::{KELVIN, SET_TRANSFORM_PROGRAM};

/// The content of a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Line {
    /// A comment, an empty line, or an event that says nothing of methods.
    Nothing,
    /// A method and its word.
    Write(Write),
    /// The same, of a method that the emulator does not handle.
    Unhandled(Write),
    /// Several of them.
    Writes(Vec<Write>),
    /// Any other event.
    Event(Event),
    /// Words alone.
    Words(Vec<u32>),
    /// A line of no known form.
    Unknown,
}

/// Reads a line without its end, which is of `class` if it names none.
pub(super) fn line(text: &str, class: u32) -> Line {
    let text = without_prefix(text);
    if text.is_empty() || text.starts_with('#') || text.starts_with("==") {
        return Line::Nothing;
    }
    if let Some(comment) = text.strip_prefix("//") {
        return dump(comment);
    }
    if let Some(rest) = text.strip_prefix("nv2a_pgraph_method") {
        return method(rest).unwrap_or(Line::Unknown);
    }
    if text.starts_with("nv2a_pgraph_flip_stall") || text.starts_with("Flip (stall)") {
        return Line::Event(Event::Flip);
    }
    if text.starts_with("nv2a_") || text.starts_with("pgraph method log") || text.starts_with("[PB]") {
        return Line::Nothing;
    }
    if let Some(rest) = text.strip_prefix("nv2a:") {
        return dprintf(rest.trim_start()).unwrap_or(Line::Unknown);
    }
    if let Some(rest) = text.strip_prefix("Moving ") {
        return moving(rest).unwrap_or(Line::Unknown);
    }
    if let Some(rest) = text.strip_prefix("[COMBINER]") {
        return combiner(rest.trim_start()).unwrap_or(Line::Unknown);
    }
    if text.starts_with("[GPU]") || text.starts_with("[FRAME]") || text.starts_with("Flip ") {
        return Line::Nothing;
    }
    if let Some((_, rest)) = text.split_once("execute_command:") {
        return bochs(rest, class).unwrap_or(Line::Unknown);
    }
    slot(text).or_else(|| words(text)).unwrap_or(Line::Unknown)
}

/// Removes QEMU's `PID@SECONDS.MICROS:`.
fn without_prefix(text: &str) -> &str {
    let prefix = text.split_once(':').filter(|(prefix, _)| {
        prefix.split_once('@').is_some_and(|(process, time)| {
            let digits =
                |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.');
            digits(process) && digits(time)
        })
    });
    prefix.map_or(text, |(_, rest)| rest.trim_start())
}

/// Reads a hexadecimal number with `0x`, up to the first character that is no digit. Returns it with what follows.
fn hexadecimal(text: &str) -> Option<(u32, &str)> {
    let digits = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"))?;
    let end = digits.find(|c: char| !c.is_ascii_hexdigit()).unwrap_or(digits.len());
    let number = u32::from_str_radix(digits.get(..end)?, 16).ok()?;
    Some((number, &digits[end..]))
}

/// Reads the number in the last `<0x...>` of a text.
fn bracketed(text: &str) -> Option<u32> {
    let (number, rest) = hexadecimal(&text[text.rfind("<0x")? + 1..])?;
    rest.starts_with('>').then_some(number)
}

/// Reads a number that ends a text or is followed by a character that ends a word.
fn number(text: &str) -> Option<u32> {
    let (number, rest) = hexadecimal(text)?;
    rest.chars().next().is_none_or(|c| !c.is_ascii_alphanumeric() && c != '?').then_some(number)
}

/// Reads what follows `nv2a_pgraph_method`.
fn method(rest: &str) -> Option<Line> {
    let (kind, rest) = rest.split_once(' ')?;
    let (subchannel, rest) = rest.trim_start().split_once(':')?;
    let (class, rest) = rest.split_once("->")?;
    let class = class.trim();
    let class = number(class).or_else(|| bracketed(class))?;
    let rest = rest.trim();
    // The marks around a dump of the whole state.
    if subchannel.trim() == "255" || class == 0xff && kind == "_unhandled" {
        return Some(Line::Nothing);
    }
    let (method, rest) = match hexadecimal(rest) {
        Some((method, rest)) => (method, rest.trim()),
        None => {
            let (name, rest) = rest.split_at(rest.find(" (").unwrap_or(rest.len()));
            (bracketed(name)?, rest.trim())
        }
    };
    if kind == "_abbrev" {
        let count = rest.rsplit_once('*').and_then(|(_, count)| count.trim().parse().ok());
        return Some(Line::Event(Event::Dropped { class, method, count }));
    }
    if rest.contains("<NO_DATA>") {
        return Some(Line::Event(Event::Dropped { class, method, count: Some(1) }));
    }
    let write = Write { class, method, word: word(rest)? };
    match kind {
        "" => Some(Line::Write(write)),
        "_unhandled" => Some(Line::Unhandled(write)),
        _ => None,
    }
}

/// Reads the word behind a method: `0x1`, `NAME[4] 0x1`, `(0x1)`, `(0x1 {...})`, `(1 <0x1>)`, `(0x3f800000 => 1.0)`.
fn word(text: &str) -> Option<u32> {
    if let Some(content) = text.strip_prefix('(') {
        let content = content.trim_end().strip_suffix(')').unwrap_or(content);
        return if content.ends_with('>') { bracketed(content) } else { number(content) };
    }
    number(text).or_else(|| number(text.rsplit_once(' ')?.1))
}

/// Reads `// Surface dump: frame_draw=N surface_dump=N`; any other comment is nothing.
fn dump(comment: &str) -> Line {
    let number = comment.trim_start().strip_prefix("Surface dump:").and_then(|rest| {
        let (_, number) = rest.split_once("surface_dump=")?;
        number.split_whitespace().next()?.parse().ok()
    });
    number.map_or(Line::Nothing, |number| Line::Event(Event::SurfaceDump(number)))
}

/// Reads what follows `nv2a:` in logs before traces: `pgraph method (0): 0x97 -> 0x1550 (0x3f800000)`.
fn dprintf(rest: &str) -> Option<Line> {
    let Some(rest) = rest.strip_prefix("pgraph method") else { return Some(Line::Nothing) };
    let (class, rest) = rest.split_once(':')?.1.split_once("->")?;
    let (method, rest) = hexadecimal(rest.trim())?;
    Some(Line::Write(Write { class: number(class.trim())?, method, word: word(rest.trim())? }))
}

/// Reads what follows `Moving`: `0xGET / 0xPUT: 0xM = 0xH`.
fn moving(rest: &str) -> Option<Line> {
    let (method, word) = rest.split_once(':')?.1.split_once('=')?;
    Some(Line::Write(Write { class: KELVIN, method: number(method.trim())?, word: number(word.trim())? }))
}

/// Reads what follows `[COMBINER]`: `config=0 1E60=00000101`, `config=0 1E40..1E5C: 000820D0 ...`.
fn combiner(rest: &str) -> Option<Line> {
    let Some(rest) = rest.strip_prefix("config=") else { return Some(Line::Nothing) };
    let (_, rest) = rest.split_once(' ')?;
    let hex = |text: &str| u32::from_str_radix(text, 16).ok();
    let write = |method, word| Write { class: KELVIN, method, word };
    if let Some((method, word)) = rest.split_once('=') {
        return Some(Line::Write(write(hex(method.trim())?, hex(word.trim())?)));
    }
    let (first, words) = rest.split_once("..")?;
    let (first, (_, words)) = (hex(first.trim())?, words.split_once(':')?);
    let writes =
        words.split_whitespace().zip(0_u32..).map(|(word, n)| Some(write(first.checked_add(4 * n)?, hex(word)?)));
    Some(Line::Writes(writes.collect::<Option<_>>()?))
}

/// Reads what follows Bochs' `execute_command:`; its methods count words.
fn bochs(rest: &str, class: u32) -> Option<Line> {
    let field = |name: &str| {
        let mut fields = rest.split(',').map(str::trim);
        fields.find_map(|field| number(field.strip_prefix(name)?.trim_start()))
    };
    let method = field("method")?.checked_mul(4)?;
    Some(Line::Write(Write { class: field("class").unwrap_or(class) & 0xffff, method, word: field("param")? }))
}

/// Reads a slot of a vertex program: `/* Slot 3: 0x... 0x... 0x... 0x... */`, or four words in brackets.
fn slot(text: &str) -> Option<Line> {
    let content = match text.strip_prefix("/*") {
        Some(comment) => {
            let Some(slot) = comment.trim_start().strip_prefix("Slot ") else { return Some(Line::Nothing) };
            slot.split_once(':')?.1.trim_end_matches("*/")
        }
        None => text.strip_prefix('[')?.split_once(']')?.0,
    };
    let words = content.split([' ', ',']).filter(|word| !word.is_empty()).map(number);
    let words: Vec<u32> = words.collect::<Option<_>>()?;
    let write = |(n, word): (u32, u32)| Write { class: KELVIN, method: SET_TRANSFORM_PROGRAM + 4 * n, word };
    (words.len() == 4).then(|| Line::Writes((0..).zip(words).map(write).collect()))
}

/// Reads words alone, with `0x` or of eight digits.
fn words(text: &str) -> Option<Line> {
    let parts = text.split([' ', ',', '\t', ':', '=']).filter(|word| !word.is_empty());
    let word = |part: &str| match number(part) {
        None if part.len() == 8 => u32::from_str_radix(part, 16).ok(),
        number => number,
    };
    Some(Line::Words(parts.map(word).collect::<Option<_>>()?))
}
