//! Fields of the structures of a scene: what is declared of each beside its type, and the tables of `docs/scene-format.md`, which are made of that.
//!
//! In brackets behind the type of a field stands how it is read, behind `=` its default. The comments are the document's; a field without one shares the
//! row of the field before.
//!
//! | declared | read by the method of its name |
//! |---|---|
//! | `= default` | the value, or the default if it is absent or wrong |
//! | `[required]` | the unread value; that it is missing is an error |
//! | `[required value]`, `[required numbers ...]` | the value |
//! | `[in range, "a lod bias"]` | the value within that range; what it is called, for the error |
//! | `[up to limit, "NB0606", "the width of a target"]` | 1 to a limit of `ninebit limits`, another error beyond |
//! | `[numbers range, "a normal"]` | so many numbers in parentheses; of the default those that are not written |
//! | `[flags "four"]` | so many flags in parentheses |
//! | `[color]` | a colour; its default is bytes |
//! | `[one of "axis": "Horizontal", "Vertical"]` | the index of the word; that of the first if it is absent |
//! | `[any]` | a number, also one that is not finite |
//! | `[or "words"]` | nothing: its readers say what holds where it is absent, the document in these words |

mod program;
mod scene;
mod texture;

use std::fmt::Write;

use super::field::*;
use super::form::{Described, Form};
use super::notation::Notation;
use super::raw::{Entries, Numbers, Raw, Reserved, Tuple};
use super::reader::{COUNT, FINITE, KIND, MISSING, Name, RANGE, Reader, TWICE, UNKNOWN, Valued, WORD};
pub(crate) use super::source::*;
use ninebit::diagnostic::Diagnostic;
use ninebit::state::{self, VertexColor};
pub(crate) use program::*;
pub(crate) use scene::*;
pub(crate) use texture::*;

/// Names of structures, and the fields of each.
pub(super) type Structure = (&'static str, fn() -> Vec<Field>);

fn declared() -> impl Iterator<Item = &'static Structure> {
    scene::STRUCTURES.iter().chain(texture::STRUCTURES).chain(program::STRUCTURES)
}

/// The structures of a scene, by the names of their declarations.
pub fn structures() -> Vec<&'static str> {
    declared().map(|(name, _)| *name).collect()
}

/// Codes of what is wrong with a field as such.
pub const CODES: [&str; 8] = [UNKNOWN, MISSING, TWICE, WORD, KIND, RANGE, FINITE, COUNT];

/// The fields of one structure, or of several, with what each is called in a scene, as a table of Markdown. `None`: there is no such structure.
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

/// A row for each field that has a meaning, and those behind it without one.
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
