//! Words, numbers and signs of a pixel shader.

use std::ops::Range;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Letters, digits and underscores, not starting with a digit; or a version, `ps.1.1`.
    Word,
    /// A number without a sign.
    Number,
    /// Any other character.
    Sign(char),
}

/// A token and its bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) place: Range<usize>,
    /// The first of its line.
    pub(super) first: bool,
}

/// All tokens. A comment starts at `//` or `;` and ends with its line, or stands between `/*` and `*/`.
pub(super) fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let (mut at, mut first) = (0, true);
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        if c == '\n' || c == '\r' {
            first = true;
            at += 1;
        } else if c.is_whitespace() {
            at += c.len_utf8();
        } else if c == ';' || rest.starts_with("//") {
            at += rest.find(['\n', '\r']).unwrap_or(rest.len());
        } else if let Some(comment) = rest.strip_prefix("/*") {
            let length = comment.find("*/").map_or(rest.len(), |end| end + 4);
            first |= rest[..length].contains('\n');
            at += length;
        } else {
            let (kind, length) = token(rest, c);
            tokens.push(Token { kind, place: at..at + length, first });
            first = false;
            at += length;
        }
    }
    tokens
}

fn token(rest: &str, c: char) -> (Kind, usize) {
    let letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let digit = |c: char| c.is_ascii_digit();
    let second = rest[c.len_utf8()..].chars().next().unwrap_or(' ');
    if digit(c) || c == '.' && digit(second) {
        return (Kind::Number, number(rest));
    }
    if !letter(c) {
        return (Kind::Sign(c), c.len_utf8());
    }
    let word = length(rest, letter);
    // `ps.1.1`: the version is one word.
    let version = ["ps", "vs", "xps"].iter().any(|kind| rest[..word].eq_ignore_ascii_case(kind));
    let dotted = length(&rest[word..], |c| digit(c) || c == '.');
    (Kind::Word, if version && rest[word..].starts_with('.') { word + dotted } else { word })
}

/// Bytes of a number: digits, a fraction, an exponent, the `f` of C.
fn number(rest: &str) -> usize {
    let digits = |text: &str| length(text, |c| c.is_ascii_digit());
    let mut end = digits(rest);
    if rest[end..].starts_with('.') {
        end += 1 + digits(&rest[end + 1..]);
    }
    if let Some(exponent) = rest[end..].strip_prefix(['e', 'E']) {
        let sign = usize::from(exponent.starts_with(['+', '-']));
        let power = digits(&exponent[sign..]);
        end += if power > 0 { 1 + sign + power } else { 0 };
    }
    end + usize::from(rest[end..].starts_with(['f', 'F']))
}

/// Bytes of the characters at the front that are `part` of a token.
fn length(text: &str, part: impl Fn(char) -> bool) -> usize {
    text.find(|c| !part(c)).unwrap_or(text.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_are_words_numbers_and_signs() {
        let text = "ps.1.1 ; x\nDP3_sat r1.a,1-t0_bx2 // y\r\n/* z\n*/+def c0, -.5f 1e-3 2.e \u{e4}";
        let parts: Vec<_> = tokens(text).into_iter().map(|token| (text[token.place].to_owned(), token.first)).collect();
        let firsts: Vec<&str> = parts.iter().filter(|(_, first)| *first).map(|(part, _)| part.as_str()).collect();
        assert_eq!(firsts, ["ps.1.1", "DP3_sat", "+"]);
        let all: Vec<&str> = parts.iter().map(|(part, _)| part.as_str()).collect();
        let after = ["def", "c0", ",", "-", ".5f", "1e-3", "2.", "e", "\u{e4}"];
        assert_eq!(all[1..10], ["DP3_sat", "r1", ".", "a", ",", "1", "-", "t0_bx2", "+"]);
        assert_eq!(all[10..], after);
    }

    #[test]
    fn a_comment_that_is_not_closed_ends_the_text() {
        assert!(tokens("/* x").is_empty() && tokens("/*/ x").is_empty() && tokens("; x").is_empty());
    }
}
