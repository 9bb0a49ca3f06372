//! Values of a scene that know their place in the text.
//!
//! A [`Raw`] holds the text of a value; the [`Reader`](super::reader::Reader) reads it as a `T` when it is needed. Where the text lies in the
//! whole file is the difference of two addresses, and a value that cannot be read spoils nothing around it.

use std::marker::PhantomData;

use super::notation::{trim, word};

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
        word(self.text)
    }
}

impl<T> Clone for Raw<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Raw<'_, T> {}

/// The entries of a map in the order of the text; the same key may come twice.
pub(super) struct Entries<'a, T>(pub(super) Vec<(Raw<'a, String>, Raw<'a, T>)>);

/// Values in parentheses without names, as many as were written.
pub(super) struct Tuple<'a, T>(pub(super) Vec<Raw<'a, T>>);

/// One to four plain values in parentheses, read in one go: most of a large scene is these.
#[derive(Clone, Copy)]
pub(super) struct Few<N> {
    pub(super) values: [N; 4],
    pub(super) count: usize,
}

/// Coordinates and the like.
pub(super) type Numbers = Few<f32>;

/// Something that the format reserves and this version refuses; never looked at.
pub(super) struct Reserved;
