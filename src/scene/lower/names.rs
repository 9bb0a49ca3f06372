//! The tables of values that are defined once and used by name.

use std::cell::RefCell;
use std::collections::HashMap;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;

use super::program::Program;
use super::vertex::VertexData;
use super::*;
use crate::mesh::Mesh;
use crate::raw::{Entries, Numbers};
use crate::reader::{Entry, NamedVector};
use ninebit::state::{Blend, VertexColor};
use ninebit::vertex::Rows;

/// Longest chain of names that stand for names.
const LONGEST_CHAIN: usize = 32;

/// How a definition of the table is read. The last argument counts the names followed so far.
pub(super) type Evaluate<'e, 'a, S, T> = &'e dyn Fn(&mut Reader<'a>, &Table<'a, S, T>, &Raw<'a, S>, usize) -> Option<T>;

enum State<T> {
    Waiting,
    Active,
    /// `None`: the definition is wrong, which has been recorded.
    Done(Option<T>),
}

/// One table: definitions written as `S` that mean a `T`.
pub(super) struct Table<'a, S, T> {
    what: &'static str,
    table: &'static str,
    entries: Vec<Entry<'a, S>>,
    by_name: HashMap<String, usize>,
    states: RefCell<Vec<State<T>>>,
    used: RefCell<Vec<bool>>,
}

impl<'a, S, T: Clone> Table<'a, S, T> {
    fn new(what: &'static str, table: &'static str, entries: Vec<Entry<'a, S>>) -> Self {
        let by_name = entries.iter().enumerate().map(|(index, entry)| (entry.name.clone(), index)).collect();
        let states = RefCell::new(entries.iter().map(|_| State::Waiting).collect());
        let used = RefCell::new(vec![false; entries.len()]);
        Table { what, table, entries, by_name, states, used }
    }

    /// Reads every definition, used or not.
    fn evaluate_all(&self, reader: &mut Reader<'a>, evaluate: Evaluate<'_, 'a, S, T>) {
        for index in 0..self.entries.len() {
            self.entry(reader, index, evaluate, 0);
        }
    }

    fn entry(
        &self,
        reader: &mut Reader<'a>,
        index: usize,
        evaluate: Evaluate<'_, 'a, S, T>,
        depth: usize,
    ) -> Option<T> {
        let entry = &self.entries[index];
        match &self.states.borrow()[index] {
            State::Done(value) => return value.clone(),
            State::Active => {
                let message = format!("the {} \"{}\" is defined by itself", self.what, shorten(&entry.name));
                let help = "give one of the names in the circle a value of its own";
                return reader.refuse(finding("NB0210", entry.place.clone(), message, "leads back to itself", help));
            }
            State::Waiting => {}
        }
        if depth > LONGEST_CHAIN {
            let message = format!("more than {LONGEST_CHAIN} names that stand for names");
            let help = "refer to the value more directly";
            return reader.refuse(finding("NB0602", entry.place.clone(), message, "the chain is too long here", help));
        }
        self.states.borrow_mut()[index] = State::Active;
        let value = evaluate(reader, self, &entry.value, depth + 1);
        self.states.borrow_mut()[index] = State::Done(value.clone());
        value
    }

    /// The value of a name.
    pub(super) fn get(
        &self,
        reader: &mut Reader<'a>,
        raw: &Raw<'a, S>,
        evaluate: Evaluate<'_, 'a, S, T>,
        depth: usize,
    ) -> Option<T> {
        let name = reader.read(&raw.as_other::<String>())?;
        let Some(index) = self.by_name.get(&name).copied() else {
            let known = self.entries.iter().map(|entry| entry.name.as_str());
            let define = format!("define it in `names: ({}: {{ ... }})`", self.table);
            return unknown_name(reader, reader.span(raw), self.what, &name, known, &define);
        };
        self.used.borrow_mut()[index] = true;
        self.entry(reader, index, evaluate, depth)
    }

    fn warn_unused(&self, reader: &mut Reader<'a>) {
        for (entry, used) in self.entries.iter().zip(&*self.used.borrow()) {
            if !used && !entry.shared {
                reader.push(unused(self.what, &entry.name, entry.place.clone()));
            }
        }
    }
}

/// The finding that nothing uses a definition.
fn unused(what: &str, name: &str, place: Range<usize>) -> Diagnostic {
    Diagnostic::warning("NB0901", place, format!("the {what} \"{}\" is not used", shorten(name)))
        .label("nothing refers to it")
        .help("remove it, or check the spelling where it was meant to be used")
}

/// The names of a table that becomes a list. What is wrong keeps its name but has no index.
pub(super) struct Index {
    what: &'static str,
    /// How to define one.
    define: &'static str,
    by_name: HashMap<String, Option<usize>>,
    names: Vec<(String, Range<usize>)>,
    used: Vec<bool>,
}

impl Index {
    pub(super) fn new(what: &'static str, define: &'static str) -> Self {
        Index { what, define, by_name: HashMap::new(), names: Vec::new(), used: Vec::new() }
    }

    pub(super) fn add(&mut self, name: String, place: Range<usize>, index: Option<usize>) {
        self.by_name.insert(name.clone(), index);
        self.names.push((name, place));
        self.used.push(false);
    }

    /// Names of which nothing is known, and nothing said.
    pub(super) fn unread(&mut self, names: impl Iterator<Item = String>) {
        self.by_name = names.map(|name| (name, None)).collect();
    }

    /// The index of that name; `None` once the reason has been recorded.
    pub(super) fn find<'a>(&mut self, reader: &mut Reader<'a>, raw: &Raw<'a, String>) -> Option<usize> {
        let name = reader.read(raw)?;
        if let Some(index) = self.by_name.get(&name) {
            if let Some(used) = self.names.iter().position(|(known, _)| *known == name) {
                self.used[used] = true;
            }
            return *index;
        }
        let known = self.names.iter().map(|(name, _)| name.as_str());
        unknown_name(reader, reader.span(raw), self.what, &name, known, self.define)
    }

    pub(super) fn warn_unused(&self, reader: &mut Reader<'_>) {
        for ((name, place), used) in self.names.iter().zip(&self.used) {
            if !used {
                reader.push(unused(self.what, name, place.clone()));
            }
        }
    }
}

/// All tables.
pub(super) struct Names<'a> {
    /// Where the files lie that programs name.
    pub(super) folder: PathBuf,
    /// Mesh files that have been read, by their names; `None`: one that cannot be, which has been recorded.
    pub(super) mesh_files: RefCell<HashMap<String, Option<Arc<Mesh>>>>,
    colors: Table<'a, source::Color, VertexColor>,
    matrices: Table<'a, source::Matrix, Rows>,
    vertices: Table<'a, source::VertexList, Rc<VertexData>>,
    meshes: Table<'a, source::MeshSource, Arc<Mesh>>,
    programs: Table<'a, source::Program, Rc<Program>>,
    blends: Table<'a, source::BlendSource, Blend>,
}

impl<'a> Names<'a> {
    /// Reads every table and every definition.
    pub(super) fn read(
        reader: &mut Reader<'a>,
        own: &Option<Raw<'a, source::Names<'a>>>,
        shared: &Option<Raw<'a, source::Names<'a>>>,
        folder: &Path,
    ) -> Self {
        let own = own.as_ref().and_then(|raw| reader.read(raw));
        let shared = shared.as_ref().and_then(|raw| reader.read(raw));
        let field = |of: &Option<source::Names<'a>>| of.as_ref().and_then(|tables| tables.vectors);
        read_vectors(reader, &field(&own), &field(&shared));
        macro_rules! table {
            ($field:ident, $what:literal) => {{
                let of = |of: &Option<source::Names<'a>>| of.as_ref().and_then(|tables| tables.$field);
                let entries = reader.tables($what, &of(&own), &of(&shared));
                Table::new($what, stringify!($field), entries)
            }};
        }
        let names = Names {
            folder: folder.to_path_buf(),
            mesh_files: RefCell::default(),
            colors: table!(colors, "colour"),
            matrices: table!(matrices, "matrix"),
            vertices: table!(vertices, "vertex list"),
            meshes: table!(meshes, "mesh"),
            programs: table!(programs, "program"),
            blends: table!(blends, "blend function"),
        };
        names.colors.evaluate_all(reader, &evaluate_color);
        names.matrices.evaluate_all(reader, &matrix::evaluate);
        names.evaluate_others(reader);
        names
    }

    pub(super) fn matrix(&self, reader: &mut Reader<'a>, raw: &Raw<'a, source::Matrix>) -> Option<Rows> {
        matrix::evaluate(reader, &self.matrices, raw, 0)
    }

    /// Warns of what nothing refers to.
    pub(super) fn warn_unused(&self, reader: &mut Reader<'a>) {
        for vector in
            std::mem::take(&mut reader.vectors).list.into_iter().filter(|vector| !vector.used && !vector.shared)
        {
            reader.push(unused("vector", &vector.name, vector.place));
        }
        self.colors.warn_unused(reader);
        self.matrices.warn_unused(reader);
        self.vertices.warn_unused(reader);
        self.meshes.warn_unused(reader);
        self.programs.warn_unused(reader);
        self.blends.warn_unused(reader);
    }
}

/// Tables whose values are no other names: how each is read, in the draws and where it is defined.
macro_rules! plain_tables {
    ($($method:ident, $table:ident: $source:ident => $value:ty, |$reader:ident, $names:ident, $raw:ident| $read:expr;)+) => {
        impl<'a> Names<'a> {
            $(pub(super) fn $method(&self, $reader: &mut Reader<'a>, $raw: &Raw<'a, source::$source>) -> Option<$value> {
                if $raw.is_text() {
                    return self.$table.get($reader, $raw, &|_, _, _, _| None, 0);
                }
                let $names = self;
                $read
            })+

            fn evaluate_others(&self, reader: &mut Reader<'a>) {
                $(self.$table.evaluate_all(reader, &|reader, _, raw, _| {
                    value(reader, raw)?;
                    self.$method(reader, raw)
                });)+
            }
        }
    };
}
plain_tables! {
    vertices, vertices: VertexList => Rc<VertexData>, |reader, names, raw| vertex::list(reader, names, raw).map(Rc::new);
    mesh, meshes: MeshSource => Arc<Mesh>, |reader, names, raw| mesh::mesh(reader, names, raw);
    program, programs: Program => Rc<Program>, |reader, names, raw| program::program(reader, names, raw).map(Rc::new);
    blend, blends: BlendSource => Blend, |reader, _names, raw| raster::blend_function(reader, raw);
}

impl<'a> Colors<'a> for Names<'a> {
    fn color(&self, reader: &mut Reader<'a>, raw: &Raw<'a, source::Color>) -> Option<VertexColor> {
        evaluate_color(reader, &self.colors, raw, 0)
    }
}

/// Vectors first: every other value may be made of them.
fn read_vectors<'a>(
    reader: &mut Reader<'a>,
    own: &Option<Raw<'a, Entries<'a, Numbers>>>,
    shared: &Option<Raw<'a, Entries<'a, Numbers>>>,
) {
    for Entry { name, place, value: raw, shared } in reader.tables("vector", own, shared) {
        let value =
            value(reader, &raw).and_then(|()| reader.numbers_written(&raw, "a vector", 1..=4, [0.0, 0.0, 0.0, 1.0]));
        reader.vectors.add(NamedVector { name, place, value, used: false, shared });
    }
}

fn evaluate_color<'a>(
    reader: &mut Reader<'a>,
    table: &Table<'a, source::Color, VertexColor>,
    raw: &Raw<'a, source::Color>,
    depth: usize,
) -> Option<VertexColor> {
    if raw.is_text() { table.get(reader, raw, &evaluate_color, depth) } else { color::literal(reader, raw) }
}

/// Refuses a definition that is only another name, in the tables where that would say nothing.
fn value<S>(reader: &mut Reader<'_>, raw: &Raw<'_, S>) -> Option<()> {
    if !raw.is_text() {
        return Some(());
    }
    let place = reader.range(raw.text);
    let help = "use that name directly in the draws";
    reader.refuse(finding("NB0205", place, "a definition here is a value, not another name", "a name", help))
}
