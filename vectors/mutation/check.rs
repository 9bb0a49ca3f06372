//! Checks packs against the model under each of many mutations, and names the units that notice: what a mutation run asks.
//!
//! `check COUNT PACK...` prints `NUMBER CHIP UNIT` for every unit that notices a mutation, number 0 being none, and `NUMBER done` after the last.

use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, mpsc};
use std::time::Duration;

use ninebit::mutant;
use ninebit::state::{Named, Policies};
use ninebit_vectors::pack;
use ninebit_vectors::read::{Table, TableRow};
use ninebit_vectors::unit::Conditions;

/// A loop that should settle something in a step or two, and does not: that is noticed, too.
const PATIENCE: Duration = Duration::from_secs(300);

/// Whether the model says something else of some row. What other policies would yield is left out: it takes most of the time.
fn differs(table: &Table) -> bool {
    let conditions = Conditions { profile: table.writer.contents().profile, policies: Policies::DEFAULT };
    let differs = |row: &TableRow| {
        let mut results = vec![0; row.results.len()];
        table.writer.contents().unit.evaluate(&row.inputs, &conditions, &mut results);
        results != row.results
    };
    table.rows.iter().any(differs)
}

/// The units that notice a mutation.
fn noticed(number: u32, tables: &[Table]) -> Vec<String> {
    mutant::choose(number);
    let noticed = |table: &&Table| {
        // A mutant may well break an assertion.
        std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| differs(table))).unwrap_or(true)
    };
    let name = |table: &Table| format!("{} {}", table.writer.contents().profile.name(), table.writer.contents().unit.name());
    tables.iter().filter(noticed).map(name).collect()
}

fn main() -> ExitCode {
    std::panic::set_hook(Box::new(|_| {}));
    let mut arguments = std::env::args_os().skip(1);
    let count: u32 = arguments.next().and_then(|count| count.to_str()?.parse().ok()).unwrap_or(0);
    let mut tables = Vec::new();
    for folder in arguments {
        match pack::open(Path::new(&folder)) {
            Ok((_, more)) => tables.extend(more),
            Err(error) => {
                eprintln!("{error}");
                return ExitCode::from(3);
            }
        }
    }
    let (tables, next) = (Arc::new(tables), Arc::new(AtomicU32::new(0)));
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    let threads: Vec<_> = (0..workers)
        .map(|_| {
            let (tables, next) = (Arc::clone(&tables), Arc::clone(&next));
            std::thread::spawn(move || {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number > count {
                        return;
                    }
                    let (send, receive) = mpsc::channel();
                    let own = Arc::clone(&tables);
                    std::thread::spawn(move || send.send(noticed(number, &own)));
                    let units = receive.recv_timeout(PATIENCE).unwrap_or(vec!["Nv2a (does not end)".to_owned()]);
                    units.iter().for_each(|unit| println!("{number} {unit}"));
                    println!("{number} done");
                }
            })
        })
        .collect();
    threads.into_iter().for_each(|thread| drop(thread.join()));
    ExitCode::SUCCESS
}
