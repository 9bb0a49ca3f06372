//! Values of a scene that know their place in the text.
//!
//! A [`Raw`] holds the text of a value; the [`Reader`](super::reader::Reader) reads it as a `T` when it is needed. The place of the text in the
//! file is the difference of two addresses. A value that cannot be read does not affect the values around it.

use std::marker::PhantomData;

use super::notation::{trim, word};

/// The text of a value that is to be read as a `T`.
pub(super) struct Raw<'a, T> {
    /// The text, without white space and comments in front.
    pub(super) text: &'a str,
    of: PhantomData<fn() -> T>,
}

impl<'a, T> Raw<'a, T> {
    pub(super) fn new(text: &'a str) -> Self {
        Raw { text: trim(text), of: PhantomData }
    }

    /// Returns the same text, to be read as a `U`.
    pub(super) fn as_other<U>(&self) -> Raw<'a, U> {
        Raw { text: self.text, of: PhantomData }
    }

    /// Returns whether the value is a text in quotes, which names something that is defined elsewhere.
    pub(super) fn is_text(&self) -> bool {
        self.text.starts_with(['"']) || self.text.starts_with("r\"") || self.text.starts_with("r#")
    }

    /// Returns the identifier that the value starts with (empty if none), and the text that follows it.
    pub(super) fn split(&self) -> (&'a str, &'a str) {
        word(self.text)
    }
}

impl<T> Clone for Raw<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Raw<'_, T> {}

/// The entries of a map in the order of the text; a key may occur twice.
pub(super) struct Entries<'a, T>(pub(super) Vec<(Raw<'a, String>, Raw<'a, T>)>);

/// Values in parentheses without names, in any number.
pub(super) struct Tuple<'a, T>(pub(super) Vec<Raw<'a, T>>);

/// One to four plain values in parentheses, read at once: large scenes consist mostly of these.
#[derive(Clone, Copy)]
pub(super) struct Few<N> {
    pub(super) values: [N; 4],
    pub(super) count: usize,
}

/// Coordinates, vectors and other groups of one to four numbers.
pub(super) type Numbers = Few<f32>;

/// A value that the format reserves and this version refuses without reading it.
pub(super) struct ReservedValue;
