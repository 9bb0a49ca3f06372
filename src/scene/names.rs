//! Values that are defined once and used by name, as the reader keeps them.

use ninebit::place::Span;
use std::any::Any;
use std::collections::HashMap;
use std::sync::Arc;

use super::diagnostic::Diagnostic;
use super::mesh::Mesh;
use super::raw::Raw;
use super::wording::{closest, shorten};
use ninebit::state::{Palette, Target, Texture};
use ninebit_program::finding;

/// Names of one kind, where each is defined, and whether something uses it.
#[derive(Default)]
pub(crate) struct Index {
    pub(super) what: &'static str,
    /// How to define one.
    pub(super) define: String,
    /// Numbers of those that are listed; of others nothing is known, and nothing said.
    pub(super) by_name: HashMap<String, Option<usize>>,
    pub(super) list: Vec<Known>,
    /// There are more of which nothing is known, and nothing said.
    pub(super) unread: bool,
}

pub(crate) struct Known {
    pub(super) name: String,
    pub(super) place: Span,
    /// What is wrong keeps its name but has no index.
    pub(super) index: Option<usize>,
    pub(super) used: bool,
}

impl Index {
    pub(super) fn new(what: &'static str, define: impl Into<String>) -> Self {
        Index { what, define: define.into(), ..Index::default() }
    }

    pub(super) fn add(&mut self, name: String, place: Span, index: Option<usize>) {
        self.by_name.insert(name.clone(), Some(self.list.len()));
        self.list.push(Known { name, place, index, used: false });
    }

    /// Names of which nothing is known.
    pub(super) fn without(&mut self, names: impl Iterator<Item = String>) {
        self.by_name = names.map(|name| (name, None)).collect();
    }

    /// Where a name of the list is defined.
    pub(super) fn place(&self, number: usize) -> Span {
        self.list.get(number).map(|known| known.place.clone()).unwrap_or_default()
    }

    /// Where that name is defined.
    pub(super) fn place_of(&self, name: &str) -> Option<Span> {
        self.by_name.get(name)?.map(|number| self.place(number))
    }

    /// The finding that a name is not defined.
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

/// What is known of a definition.
pub(crate) enum State {
    Waiting,
    Active,
    /// What it means, which the readers of its table know; `None`: the definition is wrong, which has been recorded.
    Done(Option<Box<dyn Any>>),
}

/// The names of one kind of thing, and where each is defined.
#[derive(Default)]
pub(crate) struct Table<'a> {
    pub(super) index: Index,
    pub(super) definitions: Vec<(Raw<'a, ()>, State)>,
}

/// The names that a scene defines, by what they name.
#[derive(Default)]
pub(crate) struct Names<'a> {
    /// Mesh files that have been read, by their names; `None`: one that cannot be, which has been recorded.
    pub(super) mesh_files: HashMap<String, Option<Arc<Mesh>>>,
    pub(super) vectors: Table<'a>,
    pub(super) colors: Table<'a>,
    pub(super) matrices: Table<'a>,
    pub(super) vertices: Table<'a>,
    pub(super) meshes: Table<'a>,
    pub(super) programs: Table<'a>,
    pub(super) blends: Table<'a>,
}

/// The targets, and where they were named.
#[derive(Default)]
pub(crate) struct Targets<'a> {
    pub(super) list: Vec<Target>,
    pub(super) index: Index,
    /// Targets that begin as a texture, which are read later.
    pub(super) begins: Vec<(usize, Raw<'a, String>)>,
}

/// The textures, and where they were named.
#[derive(Default)]
pub(crate) struct Textures {
    pub(super) list: Vec<Texture>,
    /// Palette of each texture of the list, where it has one of its own.
    pub(super) palette_of: Vec<Option<usize>>,
    pub(super) palettes: Palettes,
    pub(super) index: Index,
    /// Bytes that textures may still take.
    pub(super) left: u64,
}

/// The palettes, and where they were named.
#[derive(Default)]
pub(crate) struct Palettes {
    pub(super) list: Vec<Palette>,
    pub(super) index: Index,
}
