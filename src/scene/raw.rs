//! Values of a scene that know their place in the text.
//!
//! RON gives no places for values, but it lends out the text of a value unread. A [`Raw`] holds that text; the
//! [`Reader`](super::reader::Reader) reads it as a `T` when it is needed. Where the text lies in the whole file is the
//! difference of two addresses, and a value that cannot be read spoils nothing around it.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{self, Deserialize, DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};

/// The text of a value that will be read as a `T`.
pub(super) struct Raw<'a, T> {
    /// Without white space and comments before it.
    pub(super) text: &'a str,
    of: PhantomData<fn() -> T>,
}

impl<'a, T> Raw<'a, T> {
    pub(super) fn new(text: &'a str) -> Self {
        Raw { text: trim(text), of: PhantomData }
    }

    /// The same text, to be read as something else.
    pub(super) fn as_other<U>(&self) -> Raw<'a, U> {
        Raw { text: self.text, of: PhantomData }
    }

    /// Whether the value is a text in quotes: the name of something defined elsewhere.
    pub(super) fn is_text(&self) -> bool {
        self.text.starts_with(['"']) || self.text.starts_with("r\"") || self.text.starts_with("r#")
    }

    /// The identifier that the value starts with (empty if none), and what follows it.
    pub(super) fn split(&self) -> (&'a str, &'a str) {
        let end = self.text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(self.text.len());
        let head = &self.text[..end];
        if head.starts_with(|c: char| c.is_ascii_digit()) { ("", self.text) } else { (head, trim(&self.text[end..])) }
    }
}

impl<T> Clone for Raw<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Raw<'_, T> {}

impl<'de: 'a, 'a> Deserialize<'de> for Raw<'a, ()> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        <&'de ron::value::RawValue>::deserialize(deserializer).map(|raw| Raw::new(raw.get_ron()))
    }
}

/// Cuts white space and comments off the front, white space off the end.
pub(super) fn trim(text: &str) -> &str {
    let mut text = text.trim();
    loop {
        if let Some(comment) = text.strip_prefix("//") {
            text = comment.find('\n').map_or("", |end| comment[end..].trim_start());
        } else if text.starts_with("/*") {
            text = text[block_comment(text)..].trim_start();
        } else {
            return text;
        }
    }
}

/// Length of the block comment, with the ones nested in it, that `text` starts with.
fn block_comment(text: &str) -> usize {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (0usize, 0);
    while at + 1 < bytes.len() {
        match &bytes[at..at + 2] {
            b"/*" => (depth, at) = (depth + 1, at + 2),
            b"*/" => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            return at;
        }
    }
    text.len()
}

/// The entries of a map in the order of the text; the same key may come twice.
pub(super) struct Entries<'a, T>(pub(super) Vec<(Raw<'a, String>, Raw<'a, T>)>);

impl<'de: 'a, 'a> Deserialize<'de> for Entries<'a, ()> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct EntriesVisitor;
        impl<'de> Visitor<'de> for EntriesVisitor {
            type Value = Vec<(Raw<'de, ()>, Raw<'de, ()>)>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("`{ \"name\": value, ... }`")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(entries)
            }
        }
        let entries = deserializer.deserialize_map(EntriesVisitor)?;
        Ok(Entries(entries.into_iter().map(|(key, value)| (key.as_other(), value)).collect()))
    }
}

/// The values of a structure's fields, in the order of their names: reads one of that name with those fields, each at most once.
pub(super) struct Fields(pub(super) &'static str, pub(super) &'static [&'static str]);

impl<'de> DeserializeSeed<'de> for Fields {
    type Value = Vec<Option<Raw<'de, ()>>>;
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_struct(self.0, self.1, self)
    }
}

impl<'de> Visitor<'de> for Fields {
    type Value = Vec<Option<Raw<'de, ()>>>;
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "struct {}", self.0)
    }
    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut values: Vec<Option<Option<Raw<'de, ()>>>> = vec![None; self.1.len()];
        while let Some(index) = map.next_key_seed(FieldName(self.1))? {
            if values[index].is_some() {
                return Err(de::Error::duplicate_field(self.1[index]));
            }
            values[index] = Some(map.next_value()?);
        }
        Ok(values.into_iter().map(Option::flatten).collect())
    }
}

/// The index of a field by its name.
struct FieldName(&'static [&'static str]);

impl<'de> DeserializeSeed<'de> for FieldName {
    type Value = usize;
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<usize, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl Visitor<'_> for FieldName {
    type Value = usize;
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("field identifier")
    }
    fn visit_str<E: de::Error>(self, name: &str) -> Result<usize, E> {
        self.0.iter().position(|known| *known == name).ok_or_else(|| E::unknown_field(name, self.0))
    }
}

/// Values in parentheses without names, as many as were written.
pub(super) struct Tuple<'a, T>(pub(super) Vec<Raw<'a, T>>);

impl<'de: 'a, 'a> Deserialize<'de> for Tuple<'a, ()> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TupleVisitor;
        impl<'de> Visitor<'de> for TupleVisitor {
            type Value = Vec<Raw<'de, ()>>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("values in parentheses")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = seq.next_element()? {
                    values.push(value);
                }
                Ok(values)
            }
        }
        deserializer.deserialize_tuple(1, TupleVisitor).map(Tuple)
    }
}

/// One to four plain values in parentheses, read in one go: most of a large scene is these.
#[derive(Clone, Copy)]
pub(super) struct Few<N> {
    pub(super) values: [N; 4],
    pub(super) count: usize,
}

impl<N: Plain + Copy + Default> Few<N> {
    /// Reads decimal numbers without the parser; `None` leaves it to the parser.
    pub(super) fn split(text: &str) -> Option<Self> {
        let inside = text.strip_prefix('(')?.strip_suffix(')')?;
        let mut few = Few { values: [N::default(); 4], count: 0 };
        let mut parts = inside.split(',').map(str::trim).peekable();
        while let Some(part) = parts.next() {
            if part.is_empty() && few.count > 0 && parts.peek().is_none() {
                break;
            }
            *few.values.get_mut(few.count)? = N::plain(part)?;
            few.count += 1;
        }
        Some(few)
    }
}

/// Numbers in decimal notation, which reads the same everywhere.
pub(super) trait Plain: Sized {
    /// `None` for everything that is not plain.
    fn plain(text: &str) -> Option<Self>;
}

impl Plain for f32 {
    fn plain(text: &str) -> Option<Self> {
        let digits = |byte: u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'e');
        text.bytes().all(digits).then(|| text.parse().ok())?
    }
}

impl Plain for u8 {
    fn plain(text: &str) -> Option<Self> {
        text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok())?
    }
}

impl Plain for u32 {
    fn plain(text: &str) -> Option<Self> {
        text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok())?
    }
}

/// Coordinates and the like.
pub(super) type Numbers = Few<f32>;

impl<'de, N: Deserialize<'de> + Copy + Default> Deserialize<'de> for Few<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct FewVisitor<N>(PhantomData<fn() -> N>);
        impl<'de, N: Deserialize<'de> + Copy + Default> Visitor<'de> for FewVisitor<N> {
            type Value = Few<N>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("one to four numbers in parentheses")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Few<N>, A::Error> {
                let mut few = Few { values: [N::default(); 4], count: 0 };
                while let Some(value) = seq.next_element()? {
                    let slot = few.values.get_mut(few.count).ok_or_else(|| de::Error::invalid_length(5, &self))?;
                    *slot = value;
                    few.count += 1;
                }
                Ok(few)
            }
        }
        deserializer.deserialize_tuple(4, FewVisitor(PhantomData))
    }
}

/// Something that the format reserves and this version refuses; never looked at.
pub(super) struct Reserved;
