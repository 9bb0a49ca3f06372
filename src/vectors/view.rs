//! Views: the rows of a table in other formats.
//!
//! `hex` packs a row into one word for `$readmemh`, with the first column in its top bits; `json`, `svh` and `h` files give each column's bits.
//! `jsonl` has one object per row. `c` has an array of structures, for tests without a parser. `gpu` has draws ([`gpu`](super::gpu)).

use std::fmt::Write;

use serde_json::{Map, Value, json};

use super::table::LAST;
use super::{Column, Kind, Row, Writer};
use ninebit::state::named;

named! {
    /// A format that is written beside a table.
    pub enum View {
        /// Packed words for `$readmemh`, with layouts for Verilog and C.
        Hex,
        /// One JSON object a row.
        Jsonl,
        /// An array of structures for C.
        C,
        /// Draws for a graphics card, for units whose results it can show.
        Gpu,
    }
}

/// The functions that write a file of a view.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Content {
    /// A text that does not depend on the rows.
    Whole(fn(&Layout) -> String),
    /// A header, and a line for each row.
    Rows(fn(&Writer) -> String, fn(&Layout, &Row) -> String),
}

/// The canonical table: extension and content.
pub(crate) const TABLE: (&str, Content) = ("tsv", Content::Rows(Writer::head, |layout, row| layout.writer.line(row)));

impl View {
    /// Returns extension and content of each file of the view.
    pub(crate) fn files(self) -> Vec<(&'static str, Content)> {
        match self {
            View::Hex => vec![
                ("hex", Content::Rows(|_| String::new(), packed)),
                ("layout.json", Content::Whole(layout_json)),
                ("svh", Content::Whole(verilog_header)),
                ("h", Content::Whole(c_header)),
            ],
            View::C => {
                vec![
                    ("rows.h", Content::Whole(rows_header)),
                    ("rows.inc", Content::Rows(|_| String::new(), initializer)),
                ]
            }
            // Batches are written when all rows are known.
            View::Gpu => Vec::new(),
            View::Jsonl => vec![("jsonl", Content::Rows(|_| String::new(), |layout, row| object(layout.writer, row)))],
        }
    }
}

/// The bits of a column in a packed row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slice {
    /// The column that the bits hold.
    pub column: Column,
    /// Most significant bit.
    pub high: u32,
    /// Least significant bit.
    pub low: u32,
}

/// Layout of a packed row.
#[derive(Debug)]
pub struct Layout<'w> {
    /// The writer of the table.
    writer: &'w Writer,
    /// The columns in the order of the table, which is from the top bits down.
    pub slices: Vec<Slice>,
    /// Number of bits in a row.
    pub width: u32,
}

impl<'w> Layout<'w> {
    /// Returns the layout of a table, with the first column in the top bits.
    pub fn new(writer: &'w Writer) -> Layout<'w> {
        let columns = || writer.inputs().iter().chain(writer.results());
        let width: u32 = columns().map(|column| column.kind.bits()).sum();
        let mut high = width;
        let slices = columns().map(|column| {
            let low = high - column.kind.bits();
            let slice = Slice { column: column.clone(), high: high - 1, low };
            high = low;
            slice
        });
        Layout { writer, slices: slices.collect(), width }
    }

    fn unit(&self) -> &'static str {
        self.writer.contents().unit.name()
    }
}

/// Returns a row as one hexadecimal word.
pub fn packed(layout: &Layout, row: &Row) -> String {
    let mut digits = vec![0_u8; layout.width.div_ceil(4) as usize];
    for (slice, value) in layout.slices.iter().zip(row.inputs.iter().chain(&row.results)) {
        for bit in slice.low..=slice.high {
            if value >> (bit - slice.low) & 1 != 0 {
                digits[(bit / 4) as usize] |= 1 << (bit % 4);
            }
        }
    }
    digits.iter().rev().map(|digit| char::from_digit(u32::from(*digit), 16).unwrap_or('0')).collect()
}

/// Returns a row as a JSON object.
fn object(writer: &Writer, row: &Row) -> String {
    let mut object = Map::new();
    object.insert("id".to_owned(), json!(writer.id(&row.inputs)));
    let numbers = row.inputs.iter().chain(&row.results);
    for (column, value) in writer.inputs().iter().chain(writer.results()).zip(numbers) {
        let value = match column.kind {
            Kind::Name(_) | Kind::Halves(_) => Value::from(column.kind.write(*value)),
            Kind::Unsigned(_) | Kind::Signed(_) | Kind::Hex(_) => json!(value),
        };
        object.insert(column.name.clone(), value);
    }
    for (name, text) in LAST.into_iter().zip(writer.last(row)) {
        object.insert(name.to_owned(), Value::from(text));
    }
    Value::Object(object).to_string()
}

/// Returns a row as a C initializer: the numbers of its columns, then its id.
fn initializer(layout: &Layout, row: &Row) -> String {
    let columns = layout.slices.iter().map(|slice| &slice.column.kind);
    let numbers = columns.zip(row.inputs.iter().chain(&row.results)).map(|(kind, value)| match kind {
        Kind::Hex(_) => format!("{value:#x}u"),
        _ => value.to_string(),
    });
    format!("{{{}, \"{}\"}},", numbers.collect::<Vec<_>>().join(", "), layout.writer.id(&row.inputs))
}

/// Returns C declarations of a row's structure and the array of all rows.
fn rows_header(layout: &Layout) -> String {
    let unit = layout.unit();
    let lower = identifier(unit).to_lowercase();
    let mut text = format!("/* The rows of {unit}.tsv: `{lower}_rows`. */\n#include <stdint.h>\n\n");
    let names = layout.slices.iter().filter_map(|slice| match slice.column.kind {
        Kind::Name(names) => Some((&slice.column.name, names)),
        _ => None,
    });
    for (column, names) in names {
        let name = format!("{}_{}", identifier(unit), identifier(column));
        let all: Vec<String> = names.iter().map(|variant| format!("{name}_{}", identifier(variant))).collect();
        let _ = writeln!(text, "enum {{ {} }};", all.join(", "));
    }
    let _ = writeln!(text, "struct {lower}_row {{");
    for Slice { column, .. } in &layout.slices {
        let sign = if column.kind.is_signed() { "" } else { "u" };
        let bits = column.kind.bits().next_power_of_two().max(8);
        let halves = if matches!(column.kind, Kind::Halves(_)) { " /* in halves */" } else { "" };
        let _ = writeln!(text, "    {sign}int{bits}_t {};{halves}", identifier(&column.name).to_lowercase());
    }
    let _ = write!(
        text,
        "    const char *id;\n}};\nstatic const struct {lower}_row {lower}_rows[] = {{\n#include \"{unit}.rows.inc\"\n}};\n"
    );
    text
}

fn layout_json(layout: &Layout) -> String {
    let fields: Vec<Value> = layout
        .slices
        .iter()
        .map(|slice| {
            let names = if let Kind::Name(names) = slice.column.kind { json!(names) } else { Value::Null };
            json!({
                "name": slice.column.name,
                "type": slice.column.kind.code().split(':').next(),
                "high": slice.high,
                "low": slice.low,
                "signed": slice.column.kind.is_signed(),
                "names": names,
            })
        })
        .collect();
    let value = json!({ "format": "ninebit-layout-1", "unit": layout.unit(), "bits": layout.width, "fields": fields });
    format!("{value:#}\n")
}

/// Converts a column's name to an identifier: `cfg.mapping_a` to `CFG_MAPPING_A`.
fn identifier(name: &str) -> String {
    name.replace(['.', '-'], "_").to_uppercase()
}

fn verilog_header(layout: &Layout) -> String {
    let mut text = format!("// Bits of a row of {}.hex\nlocalparam ROW_BITS = {};\n", layout.unit(), layout.width);
    for slice in &layout.slices {
        let name = identifier(&slice.column.name);
        let _ = writeln!(text, "localparam {name}_HIGH = {}, {name}_LOW = {};", slice.high, slice.low);
        if let Kind::Name(names) = slice.column.kind {
            for (value, variant) in names.iter().enumerate() {
                let _ = writeln!(text, "localparam {name}_{} = {value};", identifier(variant));
            }
        }
    }
    text
}

fn c_header(layout: &Layout) -> String {
    let (file, unit) = (layout.unit(), identifier(layout.unit()));
    let mut text = format!(
        "/* Columns of {file}.tsv, and their bits in a row of {file}.hex. */\n#ifndef NINEBIT_{unit}_H\n#define NINEBIT_{unit}_H\n\n#define {unit}_ROW_BITS {}\n",
        layout.width
    );
    for (number, slice) in layout.slices.iter().enumerate() {
        let name = format!("{unit}_{}", identifier(&slice.column.name));
        let (high, low) = (slice.high, slice.low);
        let _ = writeln!(text, "#define {name} {number}\n#define {name}_HIGH {high}\n#define {name}_LOW {low}");
        if let Kind::Name(names) = slice.column.kind {
            for (value, variant) in names.iter().enumerate() {
                let _ = writeln!(text, "#define {name}_{} {value}", identifier(variant));
            }
        }
    }
    text.push_str("\n#endif\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::Level;
    use crate::table::Contents;
    use crate::units;
    use ninebit::state::Profile;

    /// Checks that every member of the structure can hold every number of its column.
    #[test]
    fn structures_hold_their_rows() {
        for unit in units::all() {
            let writer = Writer::new(Contents { unit, profile: Profile::Nv2a, level: Level::L0, seed: 1 });
            let layout = Layout::new(&writer);
            let header = rows_header(&layout);
            for slice in &layout.slices {
                let member = header.lines().find(|line| {
                    let name = line.split(' ').rfind(|word| word.ends_with(';')).unwrap_or_default();
                    name.trim_end_matches(';') == identifier(&slice.column.name).to_lowercase()
                });
                let member = member.unwrap().trim();
                let (least, greatest) = slice.column.kind.range();
                let bits: u32 = member.split_once("int").unwrap().1.split_once("_t").unwrap().0.parse().unwrap();
                let signed = !member.starts_with('u');
                assert!(least >= 0 || signed, "{member}");
                assert!(i128::from(greatest) < 1 << (bits - u32::from(signed)), "{member}");
                assert!(!signed || i128::from(least) >= -(1 << (bits - 1)), "{member}");
            }
        }
    }
}
