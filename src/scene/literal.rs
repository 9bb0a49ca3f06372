//! Reads literals of scene files: texts in quotes, and numbers.

use ninebit::place::Span;

/// A text in quotes.
pub(super) struct Literal<'a> {
    value: &'a str,
    /// Range of the text between the quotes.
    inside: Span,
    /// Whether the text is raw: a backslash then stands for itself.
    raw: bool,
}

impl<'a> Literal<'a> {
    /// Recognises a text in quotes; `None` if the value is something else.
    pub(super) fn from_text(value: &'a str) -> Option<Self> {
        let signs = value.strip_prefix('r').map(|rest| rest.bytes().take_while(|byte| *byte == b'#').count());
        let start = signs.map_or(1, |signs| signs + 2);
        let end = value.len().checked_sub(signs.map_or(1, |signs| signs + 1))?;
        let quotes = value.as_bytes().get(start - 1) == Some(&b'"') && value.get(start..end).is_some();
        quotes.then(|| Literal { value, inside: start..end, raw: signs.is_some() })
    }

    /// Returns the characters that the text stands for, and where in the value each one starts.
    pub(super) fn characters(&self) -> impl Iterator<Item = (char, usize)> {
        let mut at = self.inside.start;
        std::iter::from_fn(move || {
            let rest = &self.value[at..self.inside.end];
            let place = at;
            let (said, length) =
                if self.raw { rest.chars().next().map(|next| (next, next.len_utf8())) } else { character(rest) }?;
            at += length;
            Some((said, place))
        })
    }

    /// Returns the place in the value where the text ends.
    pub(super) fn end(&self) -> usize {
        self.inside.end
    }
}

/// Reads the next character of a text in quotes. Returns it and its length in the source; `None` if an escape is malformed.
pub(super) fn character(literal: &str) -> Option<(char, usize)> {
    let first = literal.chars().next()?;
    if first != '\\' {
        return Some((first, first.len_utf8()));
    }
    let kind = literal[1..].chars().next()?;
    let hexadecimal = |digits: &str| {
        let plain = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_hexdigit());
        plain.then(|| u32::from_str_radix(digits, 16).ok().and_then(char::from_u32))?
    };
    Some(match kind {
        'n' => ('\n', 2),
        'r' => ('\r', 2),
        't' => ('\t', 2),
        '0' => ('\0', 2),
        '\\' | '"' | '\'' => (kind, 2),
        'x' => (hexadecimal(literal.get(2..4)?)?, 4),
        'u' => {
            let inside = literal[2..].strip_prefix('{')?;
            let digits = &inside[..inside.find('}')?];
            (hexadecimal(digits)?, digits.len() + 4)
        }
        _ => return None,
    })
}

/// A type of numbers that scenes write.
pub(super) trait Number: Sized + Copy + Default {
    /// Reads a number; `Ok(None)` if it does not fit into the type.
    ///
    /// # Errors
    /// The text is no such number.
    fn number(text: &str) -> Result<Option<Self>, ()>;
}

/// Reads a whole number: decimal, or in base 16, 8 or 2 after `0x`, `0o`, `0b`; `_` may separate digits. Returns `Ok(None)` below 0 or
/// beyond 64 bits.
fn whole(text: &str) -> Result<Option<u64>, ()> {
    let (negative, digits) = match text.as_bytes().first() {
        Some(b'-') => (true, &text[1..]),
        Some(b'+') => (false, &text[1..]),
        _ => (false, text),
    };
    let (radix, digits) = match digits.get(..2) {
        Some("0x") => (16, &digits[2..]),
        Some("0o") => (8, &digits[2..]),
        Some("0b") => (2, &digits[2..]),
        _ => (10, digits),
    };
    let mut value = Some(0u64);
    for (n, character) in digits.chars().enumerate() {
        if character == '_' && n > 0 {
            continue;
        }
        let digit = character.to_digit(radix).ok_or(())?;
        value = value.and_then(|value| value.checked_mul(radix.into())?.checked_add(digit.into()));
    }
    if digits.is_empty() {
        return Err(());
    }
    Ok(value.filter(|value| !negative || *value == 0))
}

impl Number for u8 {
    fn number(text: &str) -> Result<Option<Self>, ()> {
        whole(text).map(|value| value?.try_into().ok())
    }
}

impl Number for u32 {
    fn number(text: &str) -> Result<Option<Self>, ()> {
        whole(text).map(|value| value?.try_into().ok())
    }
}

impl Number for f32 {
    fn number(text: &str) -> Result<Option<Self>, ()> {
        let magnitude = text.strip_prefix(['-', '+']).unwrap_or(text);
        let digits = |byte: u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+' | b'e' | b'E' | b'_');
        let decimal = magnitude.bytes().all(digits) && !magnitude.starts_with('_');
        if !decimal && !matches!(magnitude, "inf" | "NaN") {
            return Err(());
        }
        let value = if text.contains('_') { text.replace('_', "").parse() } else { text.parse() };
        value.map(Some).map_err(|_| ())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_say_what_is_in_quotes() {
        let read = |value| {
            let literal = Literal::from_text(value)?;
            let (said, places): (String, Vec<usize>) = literal.characters().unzip();
            Some((said, places, literal.end()))
        };
        assert_eq!(read("\"ab\""), Some(("ab".into(), vec![1, 2], 3)));
        assert_eq!(read("r#\"a\"b\"#"), Some(("a\"b".into(), vec![3, 4, 5], 6)));
        assert_eq!(read(r#""a\nb\u{e4}c""#), Some(("a\nb\u{e4}c".into(), vec![1, 2, 4, 5, 11], 12)));
        assert_eq!(read(r#""\x41\\""#), Some(("A\\".into(), vec![1, 5], 7)));
        assert_eq!(read("\"\""), Some((String::new(), vec![], 1)));
        for other in ["", "r", "red", "b\"a\"", "'a'", "1", "(\"a\")"] {
            assert_eq!(read(other), None, "{other}");
        }
    }

    #[test]
    fn numbers_as_they_may_be_written() {
        for (text, value) in
            [("7", 7), ("+7", 7), ("0x1F", 31), ("0b1_01", 5), ("0o17", 15), ("1_000", 1000), ("-0", 0)]
        {
            assert_eq!(u32::number(text), Ok(Some(value)), "{text}");
        }
        for text in ["-1", "4294967296", "99999999999999999999999", "0x1_0000_0000"] {
            assert_eq!(u32::number(text), Ok(None), "{text}");
        }
        for text in ["", "-", "0x", "_1", "1.0", "1e3", "a", "\"1\""] {
            assert_eq!(u32::number(text), Err(()), "{text}");
        }
        for (text, value) in
            [("1", 1.0), ("-1.5e-3", -0.0015), ("+.5", 0.5), ("5.", 5.0), ("1_0.5", 10.5), ("-inf", f32::NEG_INFINITY)]
        {
            assert_eq!(f32::number(text), Ok(Some(value)), "{text}");
        }
        assert!(matches!(f32::number("NaN"), Ok(Some(value)) if value.is_nan()));
        for text in ["", "-", "infinity", "nan", "e", "1e", "0x10", "_1", "1.2.3"] {
            assert_eq!(f32::number(text), Err(()), "{text}");
        }
    }
}
