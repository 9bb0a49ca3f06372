//! Views: the same rows for readers that want no text.
//!
//! `hex` packs a row into one word, the first column in its top bits, for `$readmemh`; `json`, `svh` and `h` say which bits a column has. `jsonl` has one
//! object a row. `gpu` has draws ([`gpu`]).

use std::io::{self, Write};

use serde_json::{Map, Value, json};

use super::column::{Column, Kind};
use super::gpu;
use super::table::{Row, Writer};
use crate::state::named;

named! {
    /// What is written beside a table.
    pub enum View {
        /// Packed words for `$readmemh`, with layouts for Verilog and C.
        Hex,
        /// One JSON object a row.
        Jsonl,
        /// Draws for a graphics card, of units that one can show.
        Gpu,
    }
}

/// Writes a file and tells how many rows it has.
type WriteFile = fn(&Writer, bool, &mut dyn Write) -> io::Result<usize>;

impl View {
    /// The files of the view for a unit: extension, and what writes it.
    pub fn files(self, unit: &str) -> Vec<(&'static str, WriteFile)> {
        match self {
            View::Gpu if gpu::recipes(unit).is_empty() => Vec::new(),
            View::Gpu => vec![("gpu.txt", gpu::write::text), ("gpu.raw", gpu::write::raw)],
            View::Hex => vec![("hex", hex), ("layout.json", layout_json), ("svh", verilog_header), ("h", c_header)],
            View::Jsonl => vec![("jsonl", jsonl)],
        }
    }
}

/// A column's place in a packed row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slice {
    /// The column.
    pub column: Column,
    /// Its most significant bit.
    pub high: u32,
    /// Its least significant bit.
    pub low: u32,
}

/// Where the columns lie in a packed row, and the bits of the row.
pub fn layout(writer: &Writer) -> (Vec<Slice>, u32) {
    let columns = || writer.inputs().iter().chain(writer.results());
    let width: u32 = columns().map(|column| column.kind.bits()).sum();
    let mut high = width;
    let slices = columns().map(|column| {
        let low = high - column.kind.bits();
        let slice = Slice { column: column.clone(), high: high - 1, low };
        high = low;
        slice
    });
    (slices.collect(), width)
}

/// A row as one hexadecimal word.
pub fn packed(slices: &[Slice], width: u32, row: &Row) -> String {
    let mut digits = vec![0_u8; width.div_ceil(4) as usize];
    for (slice, value) in slices.iter().zip(row.inputs.iter().chain(&row.results)) {
        for bit in slice.low..=slice.high {
            if value >> (bit - slice.low) & 1 != 0 {
                digits[(bit / 4) as usize] |= 1 << (bit % 4);
            }
        }
    }
    digits.iter().rev().map(|digit| char::from_digit(u32::from(*digit), 16).unwrap_or('0')).collect()
}

fn hex(writer: &Writer, deciding: bool, out: &mut dyn Write) -> io::Result<usize> {
    let (slices, width) = layout(writer);
    writer.each(deciding, |row| writeln!(out, "{}", packed(&slices, width, row)))
}

fn jsonl(writer: &Writer, deciding: bool, out: &mut dyn Write) -> io::Result<usize> {
    writer.each(deciding, |row| {
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
        writeln!(out, "{}", Value::Object(object))
    })
}

fn layout_json(writer: &Writer, _: bool, out: &mut dyn Write) -> io::Result<usize> {
    let (slices, width) = layout(writer);
    let fields: Vec<Value> = slices
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
    let value =
        json!({ "format": "ninebit-layout-1", "unit": writer.contents().unit.name(), "bits": width, "fields": fields });
    writeln!(out, "{value:#}")?;
    Ok(0)
}

/// A column's name as an identifier: `cfg.mapping_a` is `CFG_MAPPING_A`.
fn identifier(name: &str) -> String {
    name.replace(['.', '-'], "_").to_uppercase()
}

fn verilog_header(writer: &Writer, _: bool, out: &mut dyn Write) -> io::Result<usize> {
    let (slices, width) = layout(writer);
    writeln!(out, "// Bits of a row of {}.hex", writer.contents().unit.name())?;
    writeln!(out, "localparam ROW_BITS = {width};")?;
    for slice in &slices {
        let name = identifier(&slice.column.name);
        writeln!(out, "localparam {name}_HIGH = {}, {name}_LOW = {};", slice.high, slice.low)?;
        if let Kind::Name(names) = slice.column.kind {
            for (value, variant) in names.iter().enumerate() {
                writeln!(out, "localparam {name}_{} = {value};", identifier(variant))?;
            }
        }
    }
    Ok(0)
}

fn c_header(writer: &Writer, _: bool, out: &mut dyn Write) -> io::Result<usize> {
    let (slices, width) = layout(writer);
    let unit = identifier(writer.contents().unit.name());
    writeln!(out, "/* Columns of {0}.tsv, and their bits in a row of {0}.hex. */", writer.contents().unit.name())?;
    writeln!(out, "#ifndef NINEBIT_{unit}_H\n#define NINEBIT_{unit}_H\n\n#define {unit}_ROW_BITS {width}")?;
    for (number, slice) in slices.iter().enumerate() {
        let name = format!("{unit}_{}", identifier(&slice.column.name));
        writeln!(out, "#define {name} {number}\n#define {name}_HIGH {}\n#define {name}_LOW {}", slice.high, slice.low)?;
        if let Kind::Name(names) = slice.column.kind {
            for (value, variant) in names.iter().enumerate() {
                writeln!(out, "#define {name}_{} {value}", identifier(variant))?;
            }
        }
    }
    writeln!(out, "\n#endif")?;
    Ok(0)
}
