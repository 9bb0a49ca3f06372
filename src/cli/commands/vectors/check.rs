//! The command `ninebit vectors check`: compares tables and packs with what the model computes.

use super::*;

use ninebit::threads::on_threads;
use ninebit_vectors::read::{Difference, Table};
use rayon::prelude::*;

/// Maximum number of rows that are shown for a unit.
const SHOWN: usize = 5;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The folder of the pack
    #[arg(value_name = "DIR")]
    pack: PathBuf,
}

/// Checks a pack.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (manifest, tables) = pack::open(&arguments.pack)?;
    let found: Vec<Vec<Difference>> = on_threads(0, || tables.par_iter().map(Table::differences).collect());
    let rows: usize = tables.iter().map(|table| table.rows.len()).sum();
    let differing: usize = found.iter().map(Vec::len).sum();
    let mut text = String::new();
    for (table, differences) in tables.iter().zip(&found).filter(|(_, differences)| !differences.is_empty()) {
        let name = table.writer.contents().unit.name();
        let _ = writeln!(text, "{name}: {} of {} rows differ", differences.len(), table.rows.len());
        for difference in differences.iter().take(SHOWN) {
            let Difference { line, id, column, table: expected, model, in_lanes, row } = difference;
            let _ = match in_lanes {
                false => writeln!(text, "  line {line}, row {id}: {column} is {expected}, the model has {model}"),
                true => writeln!(
                    text,
                    "  line {line}, row {id}: {column} is {expected}, in block lanes the model has {model}: a fault of this program"
                ),
            };
            let columns = table.writer.inputs().iter().chain(table.writer.results());
            let numbers = columns.zip(row.inputs.iter().chain(&row.results));
            let shown: Vec<String> = numbers.map(|(c, value)| format!("{}={}", c.name, c.kind.write(*value))).collect();
            let _ = writeln!(text, "    {}", shown.join(" "));
        }
    }
    let (profile, level, revision) = (&manifest.profile, &manifest.level, manifest.behaviour_rev);
    let verdict = if differing == 0 { "all as the model has them".to_owned() } else { format!("{differing} differ") };
    let _ = writeln!(text, "{} units, {rows} rows of {profile} {level}: {verdict}", tables.len());
    if differing > 0 && revision != BEHAVIOUR {
        let _ =
            writeln!(text, "the pack is of behaviour {revision}, the model of {BEHAVIOUR}: see CHANGELOG.md, Numerics");
    }
    write_text(&text)?;
    if differing > 0 { Err(Failure::difference()) } else { Ok(()) }
}
