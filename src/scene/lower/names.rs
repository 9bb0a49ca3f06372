//! The tables of values that are defined once and used by name.

use std::collections::HashMap;
use std::rc::Rc;

use super::program::Program;
use super::vertex::VertexData;
use super::*;
use crate::field::Valued;
use crate::mesh::Mesh;
use crate::reader::Entry;
use crate::wording::closest;
use ninebit::vertex::Rows;

/// Longest chain of names that stand for names.
const LONGEST_CHAIN: usize = 32;

/// Names of one kind, where each is defined, and whether something uses it.
#[derive(Default)]
pub(crate) struct Index {
    what: &'static str,
    /// How to define one.
    define: String,
    /// Numbers of those that are listed; of others nothing is known, and nothing said.
    by_name: HashMap<String, Option<usize>>,
    list: Vec<Known>,
    /// There are more of which nothing is known, and nothing said.
    pub(super) unread: bool,
}

struct Known {
    name: String,
    place: Span,
    /// What is wrong keeps its name but has no index.
    index: Option<usize>,
    used: bool,
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

    /// The index of that name; `None` once the reason has been recorded. `of`: this, in the reader.
    pub(super) fn find<'a>(
        reader: &mut Reader<'a>,
        of: for<'r> fn(&'r mut Reader<'a>) -> &'r mut Index,
        raw: &Raw<'a, String>,
    ) -> Option<usize> {
        let name = reader.read(raw)?;
        let (place, full) = (reader.span(raw), reader.is_full());
        let index = of(reader);
        match index.by_name.get(&name) {
            Some(Some(number)) => {
                index.list[*number].used = true;
                return index.list[*number].index;
            }
            None if !index.unread => {}
            _ => return None,
        }
        // What is meant is looked for only where somebody reads it: names and uses may be thousands.
        let unknown = if full { Diagnostic::error("NB0208", place, "") } else { index.unknown(&name, place) };
        reader.refuse(unknown)
    }

    /// The finding that a name is not defined.
    fn unknown(&self, name: &str, place: Span) -> Diagnostic {
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

    pub(super) fn warn_unused(&self, reader: &mut Reader<'_>) {
        for Known { name, place, .. } in self.list.iter().filter(|known| !known.used) {
            let message = format!("the {} \"{}\" is not used", self.what, shorten(name));
            let help = "remove it, or check the spelling where it was meant to be used";
            reader.push(warning("NB0901", place.clone(), message, "nothing refers to it", help));
        }
    }
}

enum State<T> {
    Waiting,
    Active,
    /// `None`: the definition is wrong, which has been recorded.
    Done(Option<T>),
}

/// One table: definitions written as `S`.
pub(crate) struct Table<'a, S: Tabled<'a>> {
    index: Index,
    definitions: Vec<(Raw<'a, S>, State<S::Meaning>)>,
}

impl<'a, S: Tabled<'a>> Default for Table<'a, S> {
    fn default() -> Self {
        Table { index: Index::default(), definitions: Vec::new() }
    }
}

/// What is written in a table of definitions, and elsewhere as such or as the name of one.
pub(crate) trait Tabled<'a>: Sized + 'static {
    /// What it means.
    type Meaning: Clone;

    /// Reads one that is no name.
    fn literal(reader: &mut Reader<'a>, raw: &Raw<'a, Self>) -> Option<Self::Meaning>;

    /// Where those with names are.
    fn table<'r>(reader: &'r mut Reader<'a>) -> &'r mut Table<'a, Self>;
}

impl<'a, S: Tabled<'a>> Valued<'a> for S {
    type Value = S::Meaning;

    fn value(reader: &mut Reader<'a>, raw: &Raw<'a, S>) -> Option<S::Meaning> {
        if !raw.is_text() {
            return S::literal(reader, raw);
        }
        let index = Index::find(reader, |reader| &mut S::table(reader).index, &raw.as_other())?;
        defined::<S>(reader, index, true)
    }
}

/// What a definition of a table means; whether it may be the name of another.
fn defined<'a, S: Tabled<'a>>(reader: &mut Reader<'a>, number: usize, may_be_name: bool) -> Option<S::Meaning> {
    let depth = reader.depth;
    let Table { index, definitions } = S::table(reader);
    let place = index.place(number);
    let (raw, state) = &mut definitions[number];
    let raw = *raw;
    match state {
        State::Done(value) => return value.clone(),
        State::Active => {
            let message = format!("the {} \"{}\" is defined by itself", index.what, shorten(&index.list[number].name));
            let help = "give one of the names in the circle a value of its own";
            return reader.refuse(finding("NB0210", place, message, "leads back to itself", help));
        }
        State::Waiting if depth > LONGEST_CHAIN => {
            let message = format!("more than {LONGEST_CHAIN} names that stand for names");
            let help = "refer to the value more directly";
            return reader.refuse(finding("NB0602", place, message, "the chain is too long here", help));
        }
        State::Waiting => *state = State::Active,
    }
    let value = if may_be_name || !raw.is_text() {
        reader.deeper(|reader| S::value(reader, &raw))
    } else {
        let (message, help) = ("a definition here is a value, not another name", "use that name directly in the draws");
        reader.refuse(finding("NB0205", reader.span(&raw), message, "a name", help))
    };
    S::table(reader).definitions[number].1 = State::Done(value.clone());
    value
}

/// Reads every definition of a table, used or not.
fn read_table<'a, S: Tabled<'a>>(reader: &mut Reader<'a>, index: Index, entries: Vec<Entry<'a, S>>, chains: bool) {
    let count = entries.len();
    let table = S::table(reader);
    table.index = index;
    for (number, entry) in entries.into_iter().enumerate() {
        table.index.add(entry.name, entry.place, Some(number));
        // Other scenes may use what is shared.
        table.index.list[number].used = entry.shared;
        table.definitions.push((entry.value, State::Waiting));
    }
    for number in 0..count {
        defined::<S>(reader, number, chains);
    }
}

/// The tables in their order, each of which may use those before it: whether a definition may be the name of another, what one is called, how one
/// is read that is no name.
macro_rules! tables {
    ($($table:ident $chains:literal, $what:literal: $source:ty => $meaning:ty, |$reader:ident, $raw:ident| $read:expr;)+) => {
        /// All tables.
        #[derive(Default)]
        pub(crate) struct Names<'a> {
            /// Mesh files that have been read, by their names; `None`: one that cannot be, which has been recorded.
            pub(super) mesh_files: HashMap<String, Option<Arc<Mesh>>>,
            $($table: Table<'a, $source>),+
        }

        $(impl<'a> Tabled<'a> for $source {
            type Meaning = $meaning;

            fn literal($reader: &mut Reader<'a>, $raw: &Raw<'a, Self>) -> Option<$meaning> {
                $read
            }

            fn table<'r>(reader: &'r mut Reader<'a>) -> &'r mut Table<'a, Self> {
                &mut reader.names.$table
            }
        })+

        /// Reads every table and every definition.
        pub(super) fn read<'a>(reader: &mut Reader<'a>, own: &Field<'a>, shared: &Field<'a>) {
            let own = own.as_ref().and_then(|raw| reader.read(raw)).unwrap_or_default();
            let shared = shared.as_ref().and_then(|raw| reader.read(raw)).unwrap_or_default();
            $(
                let define = concat!("define it in `names: (", stringify!($table), ": { ... })`");
                let entries = reader.tables($what, &own.$table, &shared.$table);
                read_table(reader, Index::new($what, define), entries, $chains);
            )+
        }

        /// Warns of what nothing refers to. Nothing is known by its name afterwards.
        pub(super) fn warn_unused(reader: &mut Reader<'_>) {
            let names = std::mem::take(&mut reader.names);
            $(names.$table.index.warn_unused(reader);)+
        }
    };
}
type Field<'a> = Option<Raw<'a, source::Names<'a>>>;
tables! {
    vectors false, "vector": Numbers => ([f32; 4], usize), |reader, raw| {
        reader.numbers_written(raw, "a vector", 1..=4, [0.0, 0.0, 0.0, 1.0])
    };
    colors true, "colour": source::Color => VertexColor, |reader, raw| color::literal(reader, raw);
    matrices true, "matrix": source::Matrix => Rows, |reader, raw| matrix::literal(reader, raw);
    vertices false, "vertex list": source::VertexList => Rc<VertexData>, |reader, raw| vertex::list(reader, raw).map(Rc::new);
    meshes false, "mesh": source::MeshSource => Arc<Mesh>, |reader, raw| mesh::mesh(reader, raw);
    programs false, "program": source::Program => Rc<Program>, |reader, raw| program::program(reader, raw).map(Rc::new);
    blends false, "blend function": source::BlendSource => Blend, |reader, raw| raster::blend_function(reader, raw);
}
