//! Reads the tables of values that are defined once and used by name.

use std::any::Any;
use std::rc::Rc;

use super::program::Program;
use super::vertex::VertexData;
use super::*;
use crate::mesh::Mesh;
use crate::names::{Definition, Index, State, Table};
use crate::reader::{Entry, PlainValue};
use ninebit::vertex::Rows;

/// Longest chain of names that stand for other names.
const LONGEST_CHAIN: usize = 32;

impl Index {
    /// Finds the index that a name has in the table `of` the reader. Returns `None` after recording what is wrong.
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
        // Similar names are looked for only if the finding is kept: there may be thousands of names and uses.
        let unknown = if full { Diagnostic::error("NB0208", place, "") } else { index.unknown(&name, place) };
        reader.refuse(unknown)
    }

    pub(super) fn warn_unused(&self, reader: &mut Reader<'_>) {
        for Definition { name, place, .. } in self.list.iter().filter(|known| !known.used) {
            let message = format!("the {} \"{}\" is not used", self.what, shorten(name));
            let help = "remove it, or check the spelling where it was meant to be used";
            reader.push(warning("NB0901", place.clone(), message, "nothing refers to it", help));
        }
    }
}

/// A type whose values may be defined in a table and used by name.
pub(crate) trait NamedValue<'a>: Sized + 'static {
    /// What a value of the type is lowered to.
    type Meaning: Clone + 'static;

    /// Reads a value that is not a name.
    fn literal(reader: &mut Reader<'a>, raw: &Raw<'a, Self>) -> Option<Self::Meaning>;

    /// Returns the table of named values.
    fn table<'r>(reader: &'r mut Reader<'a>) -> &'r mut Table<'a>;
}

impl<'a, S: NamedValue<'a>> PlainValue<'a> for S {
    type Value = S::Meaning;

    fn value(reader: &mut Reader<'a>, raw: &Raw<'a, S>) -> Option<S::Meaning> {
        if !raw.is_text() {
            return S::literal(reader, raw);
        }
        let index = Index::find(reader, |reader| &mut S::table(reader).index, &raw.as_other())?;
        defined::<S>(reader, index, true)
    }
}

/// Returns the value of a definition, which `may_be_name` allows to be the name of another.
fn defined<'a, S: NamedValue<'a>>(reader: &mut Reader<'a>, number: usize, may_be_name: bool) -> Option<S::Meaning> {
    let depth = reader.depth;
    let Table { index, definitions } = S::table(reader);
    let place = index.span_of(number);
    let (raw, state) = &mut definitions[number];
    let raw = raw.as_other::<S>();
    match state {
        State::Done(value) => return value.as_ref().and_then(|value| value.downcast_ref().cloned()),
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
    S::table(reader).definitions[number].1 = State::Done(value.clone().map(|value| Box::new(value) as Box<dyn Any>));
    value
}

/// Reads every definition of a table, whether it is used or not.
fn read_table<'a, S: NamedValue<'a>>(reader: &mut Reader<'a>, index: Index, entries: Vec<Entry<'a, S>>, chains: bool) {
    let count = entries.len();
    let table = S::table(reader);
    table.index = index;
    for (number, entry) in entries.into_iter().enumerate() {
        table.index.add(entry.name, entry.place, Some(number));
        // Other scenes may use shared definitions.
        table.index.list[number].used = entry.shared;
        table.definitions.push((entry.value.as_other(), State::Waiting));
    }
    for number in 0..count {
        defined::<S>(reader, number, chains);
    }
}

/// Declares the tables, each of which may use those before it: whether a definition may be the name of another, what the values are called in
/// messages, and how a value that is not a name is read.
macro_rules! tables {
    ($($table:ident $chains:literal, $what:literal: $source:ty => $meaning:ty, |$reader:ident, $raw:ident| $read:expr;)+) => {
        $(impl<'a> NamedValue<'a> for $source {
            type Meaning = $meaning;

            fn literal($reader: &mut Reader<'a>, $raw: &Raw<'a, Self>) -> Option<$meaning> {
                $read
            }

            fn table<'r>(reader: &'r mut Reader<'a>) -> &'r mut Table<'a> {
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

        /// Warns of definitions that nothing refers to, and forgets all names.
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
