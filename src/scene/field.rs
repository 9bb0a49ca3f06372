//! What the declaration of a scene's field says besides its type: how the field is read, its default, and its text in the document.

use std::ops::RangeInclusive;

use super::form::{Form, HasForm, Kind};
use super::raw::{Numbers, Raw};
use super::reader::{Name, PlainValue, Reader, quoted};
use super::source::{AlphaReference, ViewerWord};
use super::wording::shorten;
use ninebit::limits::Limits;
use ninebit::number::convert::constant;
use ninebit::state::Named;
use ninebit::vertex::Viewer;
use ninebit_program::{finding, warning};

/// Longest list of words in the column of values; the document's text names the words of longer lists.
const MAX_WORDS: usize = 9;

/// A type whose values may be defaults.
pub(super) trait DefaultValue<'a>: PlainValue<'a> {
    /// Returns the value as a scene writes it.
    fn print(value: &Self::Value) -> String;
}

macro_rules! plain_values {
    ($($type:ty => $value:ty: $read:path),+) => { $(impl<'a> PlainValue<'a> for $type {
        type Value = $value;
        fn value(reader: &mut Reader<'a>, raw: &Raw<'a, $type>) -> Option<$value> {
            $read(reader, raw)
        }
    }
    impl<'a> DefaultValue<'a> for $type {
        fn print(value: &$value) -> String {
            value.to_string()
        }
    })+ };
}
plain_values!(
    bool => bool: Reader::read,
    u8 => u8: Reader::read,
    u32 => u32: Reader::read,
    f32 => f32: Reader::finite,
    AlphaReference => u8: alpha_reference
);

/// Reads `Float(0.5)`, or a number of which the low eight bits count: APIs hold either a float or a word of 32 bits.
fn alpha_reference<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, AlphaReference>) -> Option<u8> {
    if let ("Float", rest) = raw.split() {
        let [value, ..] = reader.numbers(&Raw::<Numbers>::new(rest), "an alpha reference", 1..=1, [0.0; 4])?;
        return Some(constant(value));
    }
    let Some(word) = reader.attempt::<u32>(raw.text) else {
        let place = reader.span(raw);
        let message = format!("expected an alpha reference, found `{}`", shorten(raw.text));
        let help = "write a byte, `128`, or a float, `Float(0.5)`";
        return reader.refuse(finding("NB0205", place, message, "wrong kind of value", help));
    };
    let byte = word as u8;
    if u32::from(byte) != word {
        let place = reader.span(raw);
        let message = format!("an alpha reference has eight bits: {word:#x} counts as {byte}");
        let help = format!("write {byte} if that is what is meant");
        reader.push(warning("NB0914", place, message, "more than eight bits", help).rule("ROP-1"));
    }
    Some(byte)
}

impl<'a, T: Named> PlainValue<'a> for Name<T> {
    type Value = T;

    fn value(reader: &mut Reader<'a>, raw: &Raw<'a, Self>) -> Option<T> {
        reader.name(raw)
    }
}

impl<'a, T: Named> DefaultValue<'a> for Name<T> {
    fn print(value: &T) -> String {
        value.name().to_owned()
    }
}

impl<'a> PlainValue<'a> for ViewerWord {
    type Value = Viewer;

    /// Reads `Local`, `Infinite`, or `Infinite(x, y, z)`.
    fn value(reader: &mut Reader<'a>, raw: &Raw<'a, Self>) -> Option<Viewer> {
        const VIEWERS: &[&str] = &["Local", "Infinite"];
        match reader.variant_of(raw, "viewer", VIEWERS, 1)? {
            (0, _) => Some(Viewer::Local),
            (_, "") => Some(Viewer::FAR),
            (_, rest) => {
                let [x, y, z, _] = reader.numbers(&Raw::<Numbers>::new(rest), "a line of sight", 3..=3, [0.0; 4])?;
                Some(Viewer::Infinite([x, y, z]))
            }
        }
    }
}

impl<'a> DefaultValue<'a> for ViewerWord {
    fn print(value: &Viewer) -> String {
        match value {
            Viewer::Local => "Local".to_owned(),
            Viewer::Infinite(direction) => format!("Infinite{}", listed(direction)),
        }
    }
}

/// Returns numbers as they are written in parentheses.
pub(super) fn listed(values: &[impl ToString]) -> String {
    format!("({})", values.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "))
}

/// The row of a field in the document.
pub(super) struct Field {
    pub(super) name: &'static str,
    /// The text for this field and for those behind it whose own is empty.
    pub(super) meaning: &'static str,
    /// The permitted values, where neither the meaning nor the type tells them.
    pub(super) values: String,
    pub(super) default: String,
}

impl Field {
    pub(super) fn new<T: HasForm>(name: &'static str, meaning: &'static str) -> Self {
        let values = match T::form() {
            Form::Value(Kind::Choice(words)) if words.len() <= MAX_WORDS && words != ["false", "true"] => quoted(words),
            Form::Value(Kind::Whole { most: 255 }) => "0 to 255".to_owned(),
            _ => String::new(),
        };
        Field { name, meaning: meaning.trim(), values, default: String::new() }
    }

    pub(super) fn or(self, default: impl Into<String>) -> Self {
        Field { default: default.into(), ..self }
    }

    /// Sets the default to a value, as a scene writes it.
    pub(super) fn written(self, default: &str) -> Self {
        self.or(format!("`{default}`"))
    }

    pub(super) fn within<T: ToString>(self, range: &RangeInclusive<T>) -> Self {
        Field { values: format!("{} to {}", range.start().to_string(), range.end().to_string()), ..self }
    }

    /// Sets the values to some words, of which the first is the default.
    pub(super) fn one_of(self, words: &[&str]) -> Self {
        Field { values: quoted(words), ..self }.written(words[0])
    }

    pub(super) fn up_to(self, limit: impl ToString) -> Self {
        self.within(&RangeInclusive::new("1".to_owned(), limit.to_string()))
    }
}

/// Returns a limit's default, for the document.
pub(super) fn limit(of: fn(&Limits) -> u32) -> u32 {
    of(&Limits::default())
}

/// Defines the method that reads a field as its declaration says.
macro_rules! read_field {
    ($field:ident $type:ty, [$(or $words:literal)?]) => {};
    ($field:ident $type:ty, [] $default:expr) => {
        pub(crate) fn $field(&self, reader: &mut Reader<'a>) -> <$type as PlainValue<'a>>::Value {
            self.$field.as_ref().and_then(|raw| PlainValue::value(reader, raw)).unwrap_or($default)
        }
    };
    ($field:ident $type:ty, [any] $default:expr) => {
        pub(crate) fn $field(&self, reader: &mut Reader<'a>) -> $type {
            self.$field.as_ref().and_then(|raw| reader.read(raw)).unwrap_or($default)
        }
    };
    ($field:ident $type:ty, [required]) => {
        pub(crate) fn $field(&self, reader: &mut Reader<'a>) -> Option<Raw<'a, $type>> {
            reader.required(&self.$field, stringify!($field), self.called, reader.range(self.opening), &self.faults)
        }
    };
    ($field:ident $type:ty, [required value]) => {
        pub(crate) fn $field(&self, reader: &mut Reader<'a>) -> Option<<$type as PlainValue<'a>>::Value> {
            let raw = reader.required(&self.$field, stringify!($field), self.called, reader.range(self.opening), &self.faults)?;
            PlainValue::value(reader, &raw)
        }
    };
    ($field:ident $type:ty, [required numbers $range:expr, $what:literal]) => {
        pub(crate) fn $field(&self, reader: &mut Reader<'a>) -> Option<[f32; 4]> {
            let raw = reader.required(&self.$field, stringify!($field), self.called, reader.range(self.opening), &self.faults)?;
            reader.numbers(&raw, $what, $range, [0.0; 4])
        }
    };
    ($field:ident $type:ty, [$(or $words:literal)? in $range:expr, $what:literal $(, $more:ident($said:expr))*]) => {
        pub(crate) fn $field(&self, reader: &mut Reader<'a>) -> Option<$type> {
            let said = |finding: Diagnostic| finding$(.$more($said))*;
            self.$field.as_ref().and_then(|raw| reader.within(raw, $what, $range, said))
        }
    };
    ($field:ident $type:ty, [in $range:expr, $what:literal $(, $more:ident($said:expr))*] $default:expr) => {
        pub(crate) fn $field(&self, reader: &mut Reader<'a>) -> $type {
            let said = |finding: Diagnostic| finding$(.$more($said))*;
            self.$field.as_ref().and_then(|raw| reader.within(raw, $what, $range, said)).unwrap_or($default)
        }
    };
    ($field:ident $type:ty, [up to $limit:ident, $code:literal, $what:literal] $default:expr) => {
        pub(crate) fn $field(&self, reader: &mut Reader<'a>) -> $type {
            let limit = reader.limits.$limit;
            self.$field.as_ref().and_then(|raw| reader.up_to(raw, $what, limit, $code)).unwrap_or($default)
        }
    };
    ($field:ident $type:ty, [$(or $words:literal)? numbers $range:expr, $what:literal]) => {
        pub(crate) fn $field(&self, reader: &mut Reader<'a>) -> Option<[f32; 4]> {
            self.$field.as_ref().and_then(|raw| reader.numbers(raw, $what, $range, [0.0; 4]))
        }
    };
    ($field:ident $type:ty, [numbers $range:expr, $what:literal] $default:expr) => {
        pub(crate) fn $field(&self, reader: &mut Reader<'a>) -> [f32; 4] {
            self.$field.as_ref().and_then(|raw| reader.numbers(raw, $what, $range, $default)).unwrap_or($default)
        }
    };
    ($field:ident $type:ty, [flags $count:literal $(, $more:ident($said:expr))*] $default:expr) => {
        pub(crate) fn $field(&self, reader: &mut Reader<'a>) -> [bool; <[bool]>::len(&$default)] {
            let counted = concat!("`", stringify!($field), "` has ", $count, " flags");
            let said = |finding: Diagnostic| finding$(.$more($said))*;
            self.$field.as_ref().and_then(|raw| reader.flags(raw, counted, $default, said)).unwrap_or($default)
        }
    };
    ($field:ident $type:ty, [one of $what:literal: $($word:literal),+]) => {
        pub(crate) fn $field(&self, reader: &mut Reader<'a>) -> Option<usize> {
            reader.choice(&self.$field, $what, &[$($word),+])
        }
    };
    ($field:ident $type:ty, [color] $default:expr) => {
        pub(crate) fn $field(&self, reader: &mut Reader<'a>) -> VertexColor {
            self.$field.as_ref().and_then(|raw| reader.value(raw)).unwrap_or(VertexColor::Bytes($default))
        }
    };
}
pub(super) use read_field;

/// Describes a field for the document as its declaration says.
macro_rules! form_of_field {
    ($field:expr, $type:ty, []) => { $field };
    ($field:expr, $type:ty, [or $words:literal]) => { $field.or($words) };
    ($field:expr, $type:ty, [] $default:expr) => { $field.written(&<$type as DefaultValue<'_>>::print(&$default)) };
    ($field:expr, $type:ty, [any] $default:expr) => { form_of_field!($field, $type, [] $default) };
    ($field:expr, $type:ty, [required $($more:tt)*]) => { $field.or("required") };
    ($field:expr, $type:ty, [$(or $words:literal)? in $range:expr, $what:literal $(, $more:ident($said:expr))*]) => {
        $field.within(&$range)$(.or($words))?
    };
    ($field:expr, $type:ty, [in $range:expr, $what:literal $(, $more:ident($said:expr))*] $default:expr) => {
        form_of_field!($field.within(&$range), $type, [] $default)
    };
    ($field:expr, $type:ty, [up to $limit:ident, $code:literal, $what:literal] $default:expr) => {
        form_of_field!($field.up_to(limit(|limits| limits.$limit)), $type, [] $default)
    };
    ($field:expr, $type:ty, [$(or $words:literal)? numbers $range:expr, $what:literal]) => { $field$(.or($words))? };
    ($field:expr, $type:ty, [numbers $range:expr, $what:literal] $default:expr) => {
        $field.written(&listed(&$default[..*$range.end()]))
    };
    ($field:expr, $type:ty, [flags $($more:tt)*] $default:expr) => { $field.written(&listed(&$default)) };
    ($field:expr, $type:ty, [one of $what:literal: $($word:literal),+]) => { $field.one_of(&[$($word),+]) };
    ($field:expr, $type:ty, [color] $default:expr) => { $field.written(&listed(&$default)) };
}
pub(super) use form_of_field;
