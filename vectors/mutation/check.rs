//! Checks packs against the model and names the units that differ: what a mutation run asks of every mutant.

use std::path::Path;
use std::process::ExitCode;

use ninebit::state::Policies;
use ninebit::vectors::pack;
use ninebit::vectors::read::{Table, TableRow};
use ninebit::vectors::unit::Conditions;

/// Whether the model says something else of some row. What other policies would yield is left out: it takes most of the time.
fn differs(table: &Table) -> bool {
    let conditions = Conditions { profile: table.contents.profile, policies: Policies::DEFAULT };
    let differs = |row: &TableRow| {
        let mut results = vec![0; row.results.len()];
        table.contents.unit.evaluate(&row.inputs, &conditions, &mut results);
        results != row.results
    };
    table.rows.iter().any(differs)
}

fn main() -> ExitCode {
    let mut killed = false;
    for folder in std::env::args_os().skip(1) {
        let (manifest, tables) = match pack::open(Path::new(&folder)) {
            Ok(pack) => pack,
            Err(error) => {
                eprintln!("{error}");
                return ExitCode::from(3);
            }
        };
        for table in tables {
            // A mutant may well break an assertion: that is noticed, too.
            let noticed = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| differs(&table))).unwrap_or(true);
            if noticed {
                killed = true;
                println!("{} {}", manifest.profile, table.contents.unit.name());
            }
        }
    }
    ExitCode::from(u8::from(killed))
}
