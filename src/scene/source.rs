//! Reads the values of a scene file from their text, and declares the structures with their fields.
//!
//! Every field is the unread text of a value ([`Raw`]). All fields are optional here: the code that uses a field decides what holds if it is
//! absent, and `docs/scene-format.md` says so. Variants (`Window(...)`, `File(...)`) are split by their readers.

use super::literal::{Literal, Number};
use super::notation::{Notation, trim};
use super::raw::{Entries, Few, Numbers, Raw, Tuple};

/// The reason that a value is not what is expected.
pub(super) enum Mismatch<'a> {
    /// The value is of another kind.
    Kind,
    /// The value is a whole number that is too large or too small.
    Range,
    /// The value has an unknown field; holds its name and those that exist.
    Unknown(&'a str, &'static [&'static str]),
    /// The value has a field of this name twice.
    Twice(&'a str),
}

/// A type that can be read from a well-formed text.
pub(super) trait FromSource<'a>: Sized {
    /// Description in the singular, with an article, for "expected ...".
    const EXPECTED: &'static str;

    /// Reads the text of a value, except for the brackets inside it.
    ///
    /// # Errors
    /// The first reason that the text is not what is expected.
    fn read(notation: &Notation<'a>, text: &'a str) -> Result<Self, Mismatch<'a>>;

    /// Returns what is wrong with single fields of a value that is read all the same.
    fn faults(&self) -> &[Mismatch<'a>] {
        &[]
    }

    /// Returns what was probably meant by a text of the wrong kind, as advice.
    fn meant(_text: &str) -> Option<String> {
        None
    }
}

macro_rules! expected {
    ($(<$life:lifetime $(, $of:ident)*> $type:ty: $expected:literal, |$notation:pat_param, $text:ident| $read:expr;)+) => {
        $(impl<$life $(, $of)*> FromSource<$life> for $type {
            const EXPECTED: &'static str = $expected;
            fn read($notation: &Notation<$life>, $text: &$life str) -> Result<Self, Mismatch<$life>> {
                $read
            }
        })+
    };
}
expected! {
    <'a> String: "a text in double quotes", |_, text| {
        let literal = Literal::from_text(text).ok_or(Mismatch::Kind)?;
        Ok(literal.characters().map(|(character, _)| character).collect())
    };
    <'a> u8: "a whole number from 0 to 255", |_, text| number(text);
    <'a> u32: "a whole number from 0 to 4294967295", |_, text| number(text);
    <'a> f32: "a number", |_, text| number(text);
    <'a> Few<u8>: "one to four bytes in parentheses", |notation, text| few(notation, text);
    <'a> Numbers: "one to four numbers in parentheses", |notation, text| few(notation, text);
    <'a> Vec<u32>: "a list of whole numbers, such as `[0, 1, 2]`", |notation, text| {
        items(notation, text, b'[')?.into_iter().map(number).collect()
    };
    <'a, T> Vec<Raw<'a, T>>: "a list in square brackets", |notation, text| {
        Ok(items(notation, text, b'[')?.into_iter().map(Raw::new).collect())
    };
    <'a, T> Tuple<'a, T>: "values in parentheses, such as `(1, 2, 3)`", |notation, text| {
        Ok(Tuple(items(notation, text, b'(')?.into_iter().map(Raw::new).collect()))
    };
    <'a, T> Entries<'a, T>: "a table in braces, such as `{ \"name\": ... }`", |notation, text| {
        let entries = notation.entries(text, b'{').ok_or(Mismatch::Kind)?;
        Ok(Entries(entries.into_iter().map(|(key, value)| (Raw::new(key), Raw::new(value))).collect()))
    };
}

impl<'a> FromSource<'a> for bool {
    const EXPECTED: &'static str = "`true` or `false`";

    fn read(_: &Notation<'a>, text: &'a str) -> Result<Self, Mismatch<'a>> {
        text.parse().map_err(|_| Mismatch::Kind)
    }

    fn meant(text: &str) -> Option<String> {
        let meant = match text.to_ascii_lowercase().as_str() {
            "true" | "yes" | "on" | "1" => "true",
            "false" | "no" | "off" | "0" => "false",
            _ => return None,
        };
        Some(format!("did you mean `{meant}`?"))
    }
}

fn items<'a>(notation: &Notation<'a>, text: &'a str, open: u8) -> Result<Vec<&'a str>, Mismatch<'a>> {
    notation.items(text, open).ok_or(Mismatch::Kind)
}

fn number<'a, N: Number>(text: &'a str) -> Result<N, Mismatch<'a>> {
    N::number(text).map_err(|()| Mismatch::Kind)?.ok_or(Mismatch::Range)
}

fn few<'a, N: Number>(notation: &Notation<'a>, text: &'a str) -> Result<Few<N>, Mismatch<'a>> {
    let items = items(notation, text, b'(')?;
    let mut values = [N::default(); 4];
    for (n, item) in items.iter().enumerate() {
        *values.get_mut(n).ok_or(Mismatch::Kind)? = number(item)?;
    }
    Ok(Few { values, count: items.len() })
}

/// Fields that were called otherwise: the old name, which is still read, and the new one.
const RENAMED: [(&str, &str); 2] = [("ab_dot", "ab_dot_product"), ("cd_dot", "cd_dot_product")];

/// Returns the name of a field that is written by its old name; other names stay.
pub(super) fn renamed(name: &str) -> &str {
    RENAMED.iter().find(|(old, _)| *old == name).map_or(name, |(_, new)| new)
}

/// Reads the written fields of a structure, and passes each to `field` with its index in `names`. `called` may stand before the parentheses.
/// Returns the unknown fields and those that are given again.
///
/// # Errors
/// It is no structure.
pub(super) fn fields<'a>(
    notation: &Notation<'a>,
    text: &'a str,
    called: &str,
    names: &'static [&'static str],
    mut field: impl FnMut(usize, &'a str),
) -> Result<Vec<Mismatch<'a>>, Mismatch<'a>> {
    let mut faults = Vec::new();
    let inside = text.strip_prefix(called).map_or(text, trim);
    let mut written = vec![false; names.len()];
    for (name, value) in notation.entries(inside, b'(').ok_or(Mismatch::Kind)? {
        let Some(index) = names.iter().position(|known| *known == renamed(name)) else {
            faults.push(Mismatch::Unknown(name, names));
            continue;
        };
        if std::mem::replace(&mut written[index], true) {
            faults.push(Mismatch::Twice(name));
            continue;
        }
        // As in RON, a value may be `None` or `Some(...)`.
        let some = value.strip_prefix("Some").and_then(|rest| notation.items(trim(rest), b'('));
        match some.as_deref() {
            _ if value == "None" => {}
            Some([value]) => field(index, value),
            _ => field(index, value),
        }
    }
    Ok(faults)
}

/// Declares structures: their fields, how each is read, and its text in the document. [`fields`](super::fields) explains declarations.
macro_rules! source {
    ($($(#[doc = $about:literal])* struct $name:ident $($called:literal)? {
        $($(#[doc = $meaning:literal])* $field:ident : $type:ty $([$($read:tt)*])? $(= $default:expr)?),* $(,)?
    })+) => {
        /// The structures with the descriptions of their fields.
        pub(crate) const STRUCTURES: &[Structure] = &[$((stringify!($name), $name::described)),+];
    $(
        $(#[doc = $about])*
        #[derive(Default)]
        pub(crate) struct $name<'a> {
            /// Text at which a missing field is reported: the first character.
            pub(crate) opening: &'a str,
            /// Name of the structure in messages.
            pub(crate) called: &'static str,
            /// Unknown fields, and fields that are given again.
            pub(crate) faults: Vec<Mismatch<'a>>,
            $(pub(crate) $field: Option<Raw<'a, $type>>),*
        }
        impl<'a> $name<'a> {
            $(read_field!($field $type, [$($($read)*)?] $($default)?);)*

            /// Returns the descriptions of the fields.
            fn described() -> Vec<Field> {
                vec![$(form_of_field!(
                    Field::new::<$type>(stringify!($field), concat!($($meaning),*)), $type, [$($($read)*)?] $($default)?
                )),*]
            }

            /// Returns these fields; those that are not written are taken from `other`.
            #[allow(dead_code, reason = "asked of a few")]
            pub(crate) fn or(self, other: Self) -> Self {
                $name { opening: self.opening, called: self.called, faults: self.faults, $($field: self.$field.or(other.$field)),* }
            }

            /// Returns the names and texts of the fields that are written.
            #[allow(dead_code, reason = "asked of a few")]
            pub(crate) fn written(&self) -> impl Iterator<Item = (&'static str, &'a str)> {
                [$((stringify!($field), self.$field.as_ref().map(|raw| raw.text))),*]
                    .into_iter()
                    .filter_map(|(name, text)| Some((name, text?)))
            }
        }
        impl<'a> HasForm for $name<'a> {
            fn form() -> Form {
                Form::Fields(|| vec![$((stringify!($field), <$type as HasForm>::form)),*])
            }
        }
        impl<'a> FromSource<'a> for $name<'a> {
            const EXPECTED: &'static str = "fields in parentheses, `(field: value, ...)`";
            fn read(notation: &Notation<'a>, text: &'a str) -> Result<Self, Mismatch<'a>> {
                const NAMES: &[&str] = &[$(stringify!($field)),*];
                let mut values = [None; NAMES.len()];
                let faults = fields(notation, text, stringify!($name), NAMES, |index, value| values[index] = Some(value))?;
                let [$($field),*] = values;
                let (opening, called) = (text.get(..1).unwrap_or(text), concat!($($called)?));
                Ok($name { opening, called, faults, $($field: $field.map(Raw::new)),* })
            }
            fn faults(&self) -> &[Mismatch<'a>] {
                &self.faults
            }
            fn meant(text: &str) -> Option<String> {
                form::field_of(&[$((stringify!($field), <$type as HasForm>::form)),*], text)
            }
        }
    )+ };
}
pub(super) use source;

/// A list of values.
pub(super) type List<'a, T> = Vec<Raw<'a, T>>;

/// A colour: bytes, `Float(...)`, or a name.
pub(super) struct Color;
/// A matrix, or a name.
pub(super) struct Matrix;
/// A mesh, or a name.
pub(super) struct MeshSource;
/// `Window(...)`, `Matrix(...)`, `Program(...)`.
pub(super) struct VertexSource;
/// A list of vertices, or a name.
pub(super) struct VertexList;
/// A pixel program, or a name.
pub(super) struct Program;
/// A blend function, or a name.
pub(super) struct BlendSource;
/// `File(...)`, `Texels(...)` and so on.
pub(super) struct ImageSource;
/// The state of a unit, or only the name of its texture.
pub(super) struct Unit;
/// A stage of the texture shader: its fields, or only its operation.
pub(super) struct ShaderStage;
/// Operation of a stage of the texture shader.
pub(super) struct ShaderOperation;
pub(super) struct Attribute;
/// A constant of a vertex program: numbers, `Matrix(...)`, `Color(...)`.
pub(super) struct ShaderConstant;
/// Source of a coordinate set: `(s: ..., t: ...)`, a word, or `None`.
pub(super) struct CoordinateSource;
/// Source of a component of a coordinate set.
pub(super) struct Generator;
pub(super) struct Input;
pub(super) struct FinalInput;
/// A destination of a combiner portion.
pub(super) struct Output;
/// Source of the normals of a truth.
pub(super) struct NormalSource;
/// An argument of a texture stage.
pub(super) struct StageArgument;

/// `Count3`, or `(Count3, Projected)`.
pub(super) struct TransformFlags;
/// `Local`, `Infinite` or `Infinite(x, y, z)`.
pub(super) struct ViewerWord;
/// A byte, or `Float(...)`.
pub(super) struct AlphaReference;
/// One of a few words, which only its reader knows.
pub(super) struct Word;
