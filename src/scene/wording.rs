//! Makes texts of messages: describes values, and finds what was probably meant.

use super::diagnostic::Diagnostic;
pub(super) use super::diagnostic::shorten;
use ninebit::place::Span;
use ninebit_program::finding;
pub(super) use ninebit_program::spelling::closest;

/// Makes the finding that a name is defined twice.
pub(super) fn twice(what: &str, name: &str, place: Span, first: Span) -> Diagnostic {
    let message = format!("the {what} \"{}\" is defined twice", shorten(name));
    finding("NB0209", place, message, "again here", "give one of them another name")
        .related(first, "first defined here")
}

/// Writes the name of a type as words: "ShadeModel" as "shade model".
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

/// Describes what a value looks like.
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
