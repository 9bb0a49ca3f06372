//! The command `ninebit vectors diff`: shows the differences of two packs.

use super::*;
use std::collections::HashMap;

use ninebit_vectors::read::{Table, TableRow};

/// Maximum number of rows that are shown for a unit.
const SHOWN: usize = 3;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The folder of a pack
    #[arg(value_name = "A")]
    first: PathBuf,
    /// The folder of another
    #[arg(value_name = "B")]
    second: PathBuf,
}

/// Compares two packs.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (a, first) = pack::open(&arguments.first)?;
    let (b, second) = pack::open(&arguments.second)?;
    if a.profile != b.profile {
        let help = "packs of one chip can be compared";
        return Err(Failure::usage(format!("the packs are of {} and of {}", a.profile, b.profile), help));
    }
    let mut text = String::new();
    let mut differs = false;
    let mut names: Vec<&str> = first.iter().chain(&second).map(|table| table.writer.contents().unit.name()).collect();
    names.sort_unstable();
    names.dedup();
    for name in names {
        let find = |tables: &'_ [Table]| tables.iter().position(|table| table.writer.contents().unit.name() == name);
        let (rows_a, rows_b) = (find(&first).map(|n| &first[n]), find(&second).map(|n| &second[n]));
        let (Some(table_a), Some(table_b)) = (rows_a, rows_b) else {
            differs = true;
            let _ = writeln!(text, "{name}: only in {}", if rows_a.is_some() { "the first" } else { "the second" });
            continue;
        };
        let by_id: HashMap<&str, &TableRow> = table_a.rows.iter().map(|row| (row.id.as_str(), row)).collect();
        let (mut added, mut changed) = (0, Vec::new());
        for row in &table_b.rows {
            match by_id.get(row.id.as_str()) {
                None => added += 1,
                Some(before) if before.results != row.results => changed.push((*before, row)),
                Some(_) => {}
            }
        }
        let removed = table_a.rows.len() + added - table_b.rows.len();
        if added + removed + changed.len() == 0 {
            continue;
        }
        differs = true;
        let _ = writeln!(text, "{name}: {added} rows more, {removed} fewer, {} changed", changed.len());
        for (before, after) in changed.iter().take(SHOWN) {
            let columns = table_a.writer.results().iter().zip(before.results.iter().zip(&after.results));
            let changes: Vec<String> = columns
                .filter(|(_, (a, b))| a != b)
                .map(|(column, (a, b))| {
                    format!("{} {} -> {}", column.name, column.kind.write(*a), column.kind.write(*b))
                })
                .collect();
            let _ = writeln!(text, "  row {}: {}", before.id, changes.join(", "));
        }
    }
    if !differs {
        text.push_str("the same rows\n");
    }
    write_text(&text)?;
    if differs { Err(Failure::difference()) } else { Ok(()) }
}
