//! Pasted text as words, numbers and signs.

use std::ops::Range;

use crate::diagnostic::Diagnostic;
use crate::program::finding::finding;

/// What a token is; its text is in its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// Letters, digits and `_`, not starting with a digit.
    Word,
    /// Starts with a digit, or a point and a digit.
    Number,
    /// `->`
    Arrow,
    /// Any other sign.
    Symbol(char),
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    pub(super) place: Range<usize>,
    /// It is the first of its line.
    pub(super) first: bool,
}

/// Splits the text; comments and spaces are left out.
pub(super) fn tokens(text: &str, findings: &mut Vec<Diagnostic>) -> Vec<Token> {
    let mut tokens = Vec::new();
    let (mut at, mut first) = (0, true);
    while let Some(sign) = text[at..].chars().next() {
        let rest = &text[at..];
        let length = if sign == '\n' {
            first = true;
            1
        } else if sign.is_whitespace() {
            sign.len_utf8()
        } else if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or_else(
                || {
                    findings.push(finding(
                        "NB0103",
                        at..at + 2,
                        "this comment does not end",
                        "opened here",
                        "close it with `*/`",
                    ));
                    rest.len()
                },
                |end| end + 2,
            )
        } else {
            let (kind, length) = token(rest, sign);
            tokens.push(Token { kind, place: at..at + length, first });
            first = false;
            length
        };
        at += length;
    }
    tokens
}

fn token(rest: &str, sign: char) -> (TokenKind, usize) {
    let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let end = |inside: &dyn Fn(char) -> bool| rest.find(|c| !inside(c)).unwrap_or(rest.len());
    let second = rest[sign.len_utf8()..].chars().next();
    if sign.is_ascii_digit() || sign == '.' && second.is_some_and(|c| c.is_ascii_digit()) {
        (TokenKind::Number, end(&|c| word(c) || c == '.'))
    } else if word(sign) {
        (TokenKind::Word, end(&word))
    } else if rest.starts_with("->") {
        (TokenKind::Arrow, 2)
    } else {
        (TokenKind::Symbol(sign), sign.len_utf8())
    }
}
