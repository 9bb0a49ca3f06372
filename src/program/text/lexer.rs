//! Words, numbers and signs.

use std::ops::Range;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Letters, digits and underscores, not starting with a digit.
    Word,
    /// Digits, perhaps with a point.
    Number,
    /// Any other character.
    Sign(char),
    /// Nothing is left.
    End,
}

/// A token and its bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) span: Range<usize>,
}

/// Takes a text apart.
#[derive(Clone, Debug)]
pub(super) struct Lexer<'t> {
    text: &'t str,
    at: usize,
}

impl<'t> Lexer<'t> {
    pub(super) fn new(text: &'t str) -> Self {
        let mut lexer = Lexer { text, at: 0 };
        lexer.blank();
        // What programs of the well-known assembler start with.
        if text[lexer.at..].starts_with("!!RC1.0") {
            lexer.at += "!!RC1.0".len();
        }
        lexer
    }

    /// Moves over white space and comments.
    fn blank(&mut self) {
        loop {
            let rest = &self.text[self.at..];
            let trimmed = rest.trim_start();
            self.at += rest.len() - trimmed.len();
            if trimmed.starts_with("//") || trimmed.starts_with('#') {
                self.at += trimmed.find('\n').unwrap_or(trimmed.len());
            } else if let Some(comment) = trimmed.strip_prefix("/*") {
                self.at += comment.find("*/").map_or(trimmed.len(), |end| end + 4);
            } else {
                return;
            }
        }
    }

    pub(super) fn next(&mut self) -> Token {
        self.blank();
        let rest = &self.text[self.at..];
        let Some(first) = rest.chars().next() else {
            let end = self.text.trim_end().len();
            return Token { kind: Kind::End, span: end..end };
        };
        let digit = |c: char| c.is_ascii_digit();
        let letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let (kind, length) = if digit(first) {
            let whole = length(rest, digit);
            let fraction = rest[whole..].strip_prefix('.').map_or(0, |rest| length(rest, digit));
            (Kind::Number, if fraction > 0 { whole + 1 + fraction } else { whole })
        } else if letter(first) {
            (Kind::Word, length(rest, letter))
        } else {
            (Kind::Sign(first), first.len_utf8())
        };
        let start = self.at;
        self.at += length;
        Token { kind, span: start..self.at }
    }
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
        let text = " !!RC1.0 tex0.a*1.50 // x\n # y\n/* z */ 2.b \u{e4}";
        let mut lexer = Lexer::new(text);
        let mut parts = Vec::new();
        loop {
            let token = lexer.next();
            parts.push(text[token.span.clone()].to_owned());
            if token.kind == Kind::End {
                break;
            }
        }
        assert_eq!(parts, ["tex0", ".", "a", "*", "1.50", "2", ".", "b", "\u{e4}", ""]);
    }

    #[test]
    fn a_comment_that_is_not_closed_ends_the_text() {
        assert_eq!(Lexer::new("/* x").next().kind, Kind::End);
        assert_eq!(Lexer::new("/*/ x").next().kind, Kind::End);
    }
}
