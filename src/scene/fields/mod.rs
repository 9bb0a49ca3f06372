//! Declarations of the fields of a scene's structures, and the tables of `docs/scene-format.md` that are made of them.
//!
//! Behind the type of a field stands, in brackets, how it is read, and behind `=` its default. Its comment is the document's text; a field without a
//! comment shares the row of the field before.
//!
//! | declaration | what the method of the field's name returns |
//! |---|---|
//! | `= default` | the value, or the default if it is absent or wrong |
//! | `[required]` | the unread value; it is an error if it is missing |
//! | `[required value]`, `[required numbers ...]` | the value |
//! | `[in range, "a lod bias"]` | the value within that range; the text names it in errors |
//! | `[up to limit, "NB0606", "the width of a target"]` | 1 to a limit of `ninebit limits`, another error beyond |
//! | `[numbers range, "a normal"]` | as many numbers in parentheses; numbers that are not written are those of the default |
//! | `[flags "four"]` | as many flags in parentheses |
//! | `[color]` | a colour; the default is given in bytes |
//! | `[one of "axis": "Horizontal", "Vertical"]` | the index of the word; that of the first if the field is absent |
//! | `[any]` | a number, also one that is not finite |
//! | `[or "words"]` | no method of its own: whoever reads the field decides what holds if it is absent, and the document says so in these words |

mod program;
mod scene;
mod texture;
mod vertex_side;

use std::fmt::Write;

use super::field::*;
use super::form::{self, Form, HasForm};
use super::notation::Notation;
use super::raw::{Entries, Numbers, Raw, ReservedValue, Tuple};
use super::reader::{COUNT, FINITE, KIND, MISSING, Name, PlainValue, RANGE, Reader, TWICE, UNKNOWN, WORD};
pub(crate) use super::source::*;
use ninebit::diagnostic::Diagnostic;
use ninebit::state::{self, VertexColor};
pub(crate) use program::*;
pub(crate) use scene::*;
pub(crate) use texture::*;
pub(crate) use vertex_side::*;

/// The name of a structure, and a function that returns its fields.
pub(super) type Structure = (&'static str, fn() -> Vec<Field>);

fn declared() -> impl Iterator<Item = &'static Structure> {
    let own = scene::STRUCTURES.iter().chain(vertex_side::STRUCTURES);
    own.chain(texture::STRUCTURES).chain(program::STRUCTURES)
}

/// Returns the names of a scene's structures, as they are declared.
pub fn structures() -> Vec<&'static str> {
    declared().map(|(name, _)| *name).collect()
}

/// Codes of the errors of single fields.
pub const CODES: [&str; 8] = [UNKNOWN, MISSING, TWICE, WORD, KIND, RANGE, FINITE, COUNT];

/// Returns the fields of one or several structures as a table of Markdown. Each is given as its name in a scene and its declared name. Returns `None`
/// if there is no such structure.
pub fn table(of: &[(&str, &str)]) -> Option<String> {
    let mut rows: Vec<[String; 5]> = Vec::new();
    for (called, structure) in of {
        let (_, fields) = declared().find(|(name, _)| name == structure)?;
        for row in rows_of(&fields()) {
            rows.push([vec![format!("`{called}`")], row].concat().try_into().ok()?);
        }
    }
    let heads = ["of", "field", "meaning", "values", "default"];
    let used = |column: usize| {
        if column == 0 { of.len() > 1 } else { rows.iter().any(|row| !row[column].is_empty()) }
    };
    let columns: Vec<usize> = (0..heads.len()).filter(|column| used(*column)).collect();
    let mut table = String::new();
    let mut line = |cells: &[&str]| {
        let cells: Vec<String> = columns.iter().map(|column| format!("| {} ", cells[*column])).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(table, "{}|", cells.concat());
    };
    line(&heads);
    line(&["---"; 5]);
    rows.iter().for_each(|row| line(&row.each_ref().map(String::as_str)));
    Some(table.replace("| --- ", "|---"))
}

/// Makes a row for each field that has a meaning, together with the fields behind it that have none.
fn rows_of(fields: &[Field]) -> Vec<Vec<String>> {
    let groups = fields.chunk_by(|_, next| next.meaning.is_empty());
    let row = |group: &[Field]| {
        let joined = |of: fn(&Field) -> &String| {
            let mut all: Vec<&str> = group.iter().map(|field| of(field).as_str()).collect();
            all.dedup();
            all.join(", ")
        };
        let names: Vec<String> = group.iter().map(|field| format!("`{}`", field.name)).collect();
        let names = match &names[..] {
            [first, .., last] if names.len() > 6 => format!("{first} to {last}"),
            _ => names.join(", "),
        };
        vec![names, group[0].meaning.to_owned(), joined(|field| &field.values), joined(|field| &field.default)]
    };
    groups.map(row).collect()
}
