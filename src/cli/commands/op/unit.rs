//! `ninebit op unit`: any unit of the conformance vectors on given numbers.

use std::fmt::Write;

use clap::Args;
use ninebit::state::Profile;
use ninebit_vectors::Unit;
use ninebit_vectors::column::Column as UnitColumn;
use ninebit_vectors::table::LAST;
use ninebit_vectors::unit::Conditions;
use serde_json::{Value, json};

use super::{Column, Common, Failure, PolicyArguments, Setup, vectors, words};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Its name: `ninebit vectors list` has them
    #[arg(value_name = "UNIT", value_parser = vectors::unit)]
    unit: &'static dyn Unit,
    /// What a column holds, written as in tables: function=Less, in.z0=3f800000, stored=0x80
    #[arg(long = "in", value_name = "COLUMN=VALUE", value_parser = assignment)]
    given: Vec<(String, String)>,
    /// The chip: nv10 or nv2a
    #[arg(long, value_name = "PROFILE", default_value = "nv2a", value_parser = words::profile)]
    profile: Profile,
    /// List its columns: what each takes, and its default
    #[arg(long, conflicts_with_all = ["given", "inputs"])]
    columns: bool,
    #[command(flatten)]
    policies: PolicyArguments,
    #[command(flatten)]
    common: Common,
}

fn assignment(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("write COLUMN=VALUE, for example stored=255")?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}

/// Runs a unit.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let unit = arguments.unit;
    let conditions = Conditions { profile: arguments.profile, policies: arguments.policies.policies()? };
    let mut setup = setup(unit, conditions)?;
    if arguments.columns {
        return arguments.common.list(|| listed(&setup), || values(&setup));
    }
    for (name, text) in &arguments.given {
        let Some(place) = (setup.find)(&setup.columns, name) else {
            let message = format!("`{}` has no input `{name}`", unit.name());
            return Err(Failure::usage(message, format!("its inputs are {}", setup.known)));
        };
        let column = &mut setup.columns[place];
        column.value = Some(column.read(text).ok_or_else(|| column.refuses(format!("`{text}`")))?);
    }
    setup.drive(&arguments.common)
}

/// Sets up a unit. Its columns have their defaults.
pub(in crate::commands) fn setup(unit: &'static dyn Unit, conditions: Conditions) -> Result<Setup<'static>, Failure> {
    if !unit.profiles().contains(&conditions.profile) {
        return Err(vectors::lacks(unit, conditions.profile));
    }
    let column = |input: UnitColumn| {
        // The name without its prefix.
        let short = input.name.split_once('.').map_or(input.name.as_str(), |(_, own)| own).to_owned();
        let value = input.default();
        let column = Column::from_input(input, &short, "");
        let how_to_give = format!("write `--in {short}=VALUE`: {}; `--columns` lists all of them", column.wants());
        Column { how_to_give, value, ..column }
    };
    let columns: Vec<Column> = unit.inputs().into_iter().map(column).collect();
    let known = columns.iter().map(|column| column.input.name.as_str()).collect::<Vec<_>>().join(", ");
    // What a pack's table has beside the inputs.
    let beside = ["id"].into_iter().chain(LAST).map(str::to_owned);
    let passed_over = beside.chain(unit.results().into_iter().map(|column| column.name)).collect();
    Ok(Setup { conditions, depends: true, passed_over, ..Setup::new(unit, columns, known) })
}

/// Returns a unit's columns for people.
fn listed(setup: &Setup<'_>) -> String {
    let mut text = format!("{}: {}\n", setup.unit.name(), setup.unit.about());
    let width = setup.columns.iter().map(|column| column.input.name.len()).max().unwrap_or(0);
    for column in &setup.columns {
        let default = column.value.map(|value| format!(" [default: {}]", column.input.kind.write(value)));
        let _ = writeln!(text, "  {:width$}  {}{}", column.input.name, column.wants(), default.unwrap_or_default());
    }
    let results: Vec<String> = setup.unit.results().into_iter().map(|column| column.name).collect();
    let _ = writeln!(text, "yields {}", results.join(", "));
    text
}

/// Returns a unit's columns for programs.
fn values(setup: &Setup<'_>) -> String {
    let column = |column: &Column| {
        let default = column.value.map(|value| column.input.kind.write(value));
        json!({ "name": column.input.name, "type": column.input.kind.code(), "takes": column.wants(), "default": default })
    };
    let columns: Vec<Value> = setup.columns.iter().map(column).collect();
    format!("{:#}\n", json!({ "format": "ninebit-columns-1", "unit": setup.unit.name(), "columns": columns }))
}
