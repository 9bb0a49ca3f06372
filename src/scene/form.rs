//! Describes what the values of a type look like in a scene's text.

use super::raw::{Entries, Few, Raw, ReservedValue, Tuple};
use super::reader::{Name, quoted};
use ninebit::state::Named;

/// The name of a field or variant, and a function that returns the form of its value.
pub(super) type Entry = (&'static str, fn() -> Form);

/// The form of a value.
#[derive(Clone, Copy)]
pub(super) enum Form {
    /// Fields in parentheses, with the name and form of each.
    Fields(fn() -> Vec<Entry>),
    /// A list in square brackets.
    List(fn() -> Form),
    /// Values in parentheses without names.
    Tuple(fn() -> Form),
    /// A table in braces.
    Table(fn() -> Form),
    /// A word, with a value of its own form in parentheses.
    Variant(&'static [Entry]),
    /// A value of the given form, or a text: the name of such a value, or the value of its field with that name, as a texture unit's texture.
    OrName(fn() -> Form, Option<&'static str>),
    /// A value without parts.
    Value(Kind),
}

/// The kind of a value without parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A colour: three or four bytes in parentheses, or `Float(...)`, or a name.
    Color,
    /// A whole number.
    Whole {
        /// The largest value that is accepted.
        most: u32,
    },
    /// A number of any kind.
    Number,
    /// Up to four numbers in parentheses.
    Numbers,
    /// One of some words.
    Choice(&'static [&'static str]),
    /// A text in quotes.
    Text,
    /// A value whose form is not described.
    Other,
}

/// Most fields that advice names.
const FEW: usize = 12;

/// Returns advice for a value that stands in place of a structure: the first of its fields that takes the word or the list, or all fields if they are few.
pub(super) fn field_of(fields: &[Entry], value: &str) -> Option<String> {
    let is_list = value.trim_start_matches(|c: char| c == '(' || c.is_whitespace()).starts_with('[');
    let takes = |(_, form): &&Entry| match form() {
        Form::Value(Kind::Choice(words)) => words.contains(&value),
        Form::List(_) => is_list,
        _ => false,
    };
    let written = if is_list { "[...]" } else { value };
    let advice = fields.iter().find(takes).map(|(name, _)| format!("write `({name}: {written})`"));
    let names = || quoted(&fields.iter().map(|(name, _)| *name).collect::<Vec<_>>());
    advice.or_else(|| (fields.len() <= FEW).then(|| format!("fields here: {}", names())))
}

/// A type whose values have a known form.
pub(super) trait HasForm {
    /// Returns the form of the type's values.
    fn form() -> Form;
}

macro_rules! forms {
    ($($($type:ty),+ => $form:expr;)+) => { $($(impl HasForm for $type { fn form() -> Form { $form } })+)+ };
}
pub(super) use forms;
forms! {
    String => Form::Value(Kind::Text);
    u8 => Form::Value(Kind::Whole { most: 255 });
    u32 => Form::Value(Kind::Whole { most: u32::MAX });
    f32 => Form::Value(Kind::Number);
    bool => Form::Value(Kind::Choice(&["false", "true"]));
    Few<f32> => Form::Value(Kind::Numbers);
    Vec<u32>, ReservedValue => Form::Value(Kind::Other);
}
impl<T: Named> HasForm for Name<T> {
    fn form() -> Form {
        Form::Value(Kind::Choice(T::NAMES))
    }
}
impl<T: HasForm> HasForm for Vec<Raw<'_, T>> {
    fn form() -> Form {
        Form::List(T::form)
    }
}
impl<T: HasForm> HasForm for Entries<'_, T> {
    fn form() -> Form {
        Form::Table(T::form)
    }
}
impl<T: HasForm> HasForm for Tuple<'_, T> {
    fn form() -> Form {
        Form::Tuple(T::form)
    }
}
