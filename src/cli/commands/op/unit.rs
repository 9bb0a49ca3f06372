//! `ninebit op unit`: any unit of the conformance vectors on given numbers.

use clap::Args;
use ninebit::state::Profile;
use ninebit_vectors::Unit;
use ninebit_vectors::column::Column as UnitColumn;
use ninebit_vectors::unit::Conditions;

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
    let (unit, profile) = (arguments.unit, arguments.profile);
    if !unit.profiles().contains(&profile) {
        return Err(vectors::lacks(unit, profile));
    }
    let column = |input: UnitColumn| {
        // The name without its prefix.
        let short = input.name.split_once('.').map_or(input.name.as_str(), |(_, own)| own).to_owned();
        let column = Column::from_input(input, &short, "");
        Column { how_to_give: format!("write `--in {short}=VALUE`: {}", column.wants()), ..column }
    };
    let columns: Vec<Column> = unit.inputs().into_iter().map(column).collect();
    let known = columns.iter().map(|column| column.input.name.as_str()).collect::<Vec<_>>().join(", ");
    let policies = arguments.policies.policies()?;
    let conditions = Conditions { profile, policies };
    let mut setup = Setup { conditions, depends: true, ..Setup::new(unit, columns, known) };
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
