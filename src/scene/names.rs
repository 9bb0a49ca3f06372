//! Tables of values that are defined once and used by name, as the reader keeps them.

use ninebit::place::Span;
use std::any::Any;
use std::collections::HashMap;
use std::sync::Arc;

use super::diagnostic::Diagnostic;
use super::mesh::Mesh;
use super::raw::Raw;
use super::wording::{closest, shorten};
use ninebit::state::{Buffer, Palette, Target, Texture};
use ninebit_program::finding;

/// The names of one kind of values, with the place of each definition and whether it is used.
#[derive(Default)]
pub(crate) struct Index {
    pub(super) what: &'static str,
    /// The help that says how to define a value.
    pub(super) define: String,
    /// Index of each name in `list`; `None` for a name whose definition was not read, about which nothing is reported.
    pub(super) by_name: HashMap<String, Option<usize>>,
    pub(super) list: Vec<Definition>,
    /// Whether there are more definitions that were not read: unknown names are then not reported.
    pub(super) unread: bool,
}

pub(crate) struct Definition {
    pub(super) name: String,
    pub(super) place: Span,
    /// Index of the value; `None` if the definition is wrong.
    pub(super) index: Option<usize>,
    pub(super) used: bool,
}

impl Index {
    pub(super) fn new(what: &'static str, define: impl Into<String>) -> Self {
        Index { what, define: define.into(), ..Index::default() }
    }

    pub(super) fn add(&mut self, name: String, place: Span, index: Option<usize>) {
        self.by_name.insert(name.clone(), Some(self.list.len()));
        self.list.push(Definition { name, place, index, used: false });
    }

    /// Registers names whose definitions are not read.
    pub(super) fn without(&mut self, names: impl Iterator<Item = String>) {
        self.by_name = names.map(|name| (name, None)).collect();
    }

    /// Returns the place of the definition with this number.
    pub(super) fn span_of(&self, number: usize) -> Span {
        self.list.get(number).map(|known| known.place.clone()).unwrap_or_default()
    }

    /// Returns the place where a name is defined.
    pub(super) fn place_of(&self, name: &str) -> Option<Span> {
        self.by_name.get(name)?.map(|number| self.span_of(number))
    }

    /// Makes the finding that a name is not defined.
    pub(super) fn unknown(&self, name: &str, place: Span) -> Diagnostic {
        let known = self.list.iter().map(|known| known.name.as_str());
        let help = match closest(name, known.clone()) {
            Some(known) => format!("did you mean \"{}\"?", shorten(known)),
            None => {
                let list: Vec<String> = known.take(8).map(|name| format!("\"{}\"", shorten(name))).collect();
                let define = &self.define;
                if list.is_empty() { define.to_owned() } else { format!("known: {}; {define}", list.join(", ")) }
            }
        };
        finding("NB0208", place, format!("there is no {} \"{}\"", self.what, shorten(name)), "not defined", help)
    }
}

/// State of a definition while a table is read.
pub(crate) enum State {
    Waiting,
    Active,
    /// The value has been read, and its type is known to the table's readers. It is `None` if the definition is wrong, which has been recorded.
    Done(Option<Box<dyn Any>>),
}

/// The definitions of one kind of values.
#[derive(Default)]
pub(crate) struct Table<'a> {
    pub(super) index: Index,
    pub(super) definitions: Vec<(Raw<'a, ()>, State)>,
}

/// The tables of the field `names`.
#[derive(Default)]
pub(crate) struct Names<'a> {
    /// Mesh files that have been read, by name; `None` if the file cannot be read, which has been recorded.
    pub(super) mesh_files: HashMap<String, Option<Arc<Mesh>>>,
    pub(super) vectors: Table<'a>,
    pub(super) colors: Table<'a>,
    pub(super) matrices: Table<'a>,
    pub(super) vertices: Table<'a>,
    pub(super) meshes: Table<'a>,
    pub(super) programs: Table<'a>,
    pub(super) blends: Table<'a>,
}

/// The render targets, with their names.
#[derive(Default)]
pub(crate) struct Targets<'a> {
    pub(super) list: Vec<Target>,
    pub(super) index: Index,
    /// Targets that begin with the words of a texture, and the texture's name; textures are read later.
    pub(super) begins: Vec<(usize, Buffer, Raw<'a, String>)>,
}

/// The textures, with their names.
#[derive(Default)]
pub(crate) struct Textures {
    pub(super) list: Vec<Texture>,
    /// For each texture of the list, the index of its own palette.
    pub(super) palette_of: Vec<Option<usize>>,
    pub(super) palettes: Palettes,
    pub(super) index: Index,
    /// Number of bytes that further textures may take.
    pub(super) left: u64,
}

/// The palettes, with their names.
#[derive(Default)]
pub(crate) struct Palettes {
    pub(super) list: Vec<Palette>,
    pub(super) index: Index,
}
