//! Words and places of messages: what a value looks like, what was probably meant, where the parser stopped.

use std::ops::Range;

use super::diagnostic::Diagnostic;
pub(super) use super::diagnostic::shorten;
use super::raw::trim;
pub(super) use ninebit_program::spelling::closest;

/// The finding that a name is taken.
pub(super) fn twice(what: &str, name: &str, place: Range<usize>, first: Range<usize>) -> Diagnostic {
    Diagnostic::error("NB0209", place, format!("the {what} \"{}\" is defined twice", shorten(name)))
        .label("again here")
        .related(first, "first defined here")
        .help("give one of them another name")
}

/// Byte offset of a line and column (both from 1, columns in characters).
pub(super) fn offset(text: &str, line: usize, column: usize) -> usize {
    let mut start = 0;
    for _ in 1..line {
        match text[start..].find('\n') {
            Some(newline) => start += newline + 1,
            None => return text.len(),
        }
    }
    text[start..].char_indices().nth(column.saturating_sub(1)).map_or(text.len(), |(at, _)| start + at)
}

/// "ShadeModel" as "shade model".
pub(super) fn words(name: &str) -> String {
    let mut words = String::with_capacity(name.len() + 2);
    for letter in name.chars() {
        if letter.is_uppercase() && !words.is_empty() {
            words.push(' ');
        }
        words.extend(letter.to_lowercase());
    }
    words
}

/// The bracket that is still open at the end of the text, and the place where the text ends for it.
pub(super) fn unclosed(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut open, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        match bytes[at] {
            b'/' if bytes.get(at + 1).is_some_and(|next| matches!(next, b'/' | b'*')) => {
                at = text.len() - trim(&text[at..]).len();
                continue;
            }
            b'"' => {
                at += 1;
                while at < bytes.len() && bytes[at] != b'"' {
                    at += 1 + usize::from(bytes[at] == b'\\');
                }
            }
            b'(' | b'[' | b'{' => open.push(at),
            b')' | b']' | b'}' => {
                open.pop();
            }
            _ => {}
        }
        at += 1;
    }
    open.last().copied()
}

/// What a value looks like, for messages.
pub(super) fn describe(text: &str) -> String {
    match text.chars().next() {
        None => "nothing".to_owned(),
        Some('"') => format!("the text {}", shorten(text)),
        Some('(') => "values in parentheses".to_owned(),
        Some('[') => "a list in square brackets".to_owned(),
        Some('{') => "a table in braces".to_owned(),
        Some('\'') => format!("the character {}", shorten(text)),
        Some(_) => format!("`{}`", shorten(text)),
    }
}
