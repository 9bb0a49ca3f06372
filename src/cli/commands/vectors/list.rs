//! The command `ninebit vectors list`: lists the units.

use super::*;

use ninebit_vectors::{cases, handbook};
use serde_json::json;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// How to print the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Lists the units.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut text = String::new();
    let mut list = Vec::new();
    for unit in units::all() {
        let (inputs, results) = (unit.inputs(), unit.results());
        let profiles: Vec<&str> = unit.profiles().iter().map(|profile| profile.name()).collect();
        let size = cases::size(&inputs);
        let grade = handbook::grade(unit);
        let _ = writeln!(text, "{:<22}{:<9}{:<10}{}", unit.name(), grade, profiles.join(" "), unit.rules().join(" "));
        let _ = writeln!(text, "    {}", unit.about());
        let column =
            |column: &ninebit_vectors::column::Column| json!({ "name": column.name, "type": column.kind.code() });
        list.push(json!({
            "name": unit.name(),
            "about": unit.about(),
            "rules": unit.rules(),
            "grade": grade,
            "profiles": profiles,
            "rows_at_all": u64::try_from(size).ok(),
            "inputs": inputs.iter().map(column).collect::<Vec<_>>(),
            "results": results.iter().map(column).collect::<Vec<_>>(),
        }));
    }
    arguments.format.print(|| text, || format!("{:#}", json!({ "format": "ninebit-units-1", "units": list })))
}
