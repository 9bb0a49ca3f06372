//! `ninebit op unit`: any unit of the conformance vectors on given numbers.

use clap::Args;
use ninebit::state::Profile;
use ninebit::trace::Observer;
use ninebit_vectors::Unit;
use ninebit_vectors::column::{Column as UnitColumn, Domain, Kind};
use ninebit_vectors::unit::Conditions;
use serde_json::{Value, json};

use super::{Column, Common, Failure, Operation, PolicyArguments, Results, Setup, number, vectors, words};

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

/// A unit and its inputs.
struct Asked {
    unit: &'static dyn Unit,
    conditions: Conditions,
    inputs: Vec<UnitColumn>,
}

/// Runs a unit.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (unit, profile) = (arguments.unit, arguments.profile);
    if !unit.profiles().contains(&profile) {
        return Err(vectors::lacks(unit, profile));
    }
    let inputs = unit.inputs();
    let column = |input: &UnitColumn| {
        let (first, last) = input.kind.range();
        let (name, wants) = (input.name.as_str(), wants(input));
        // The name without what kind of column it is.
        let short = name.split_once('.').map_or(name, |(_, own)| own);
        let how = format!("write `--in {short}=VALUE`: {wants}");
        Column { wants, ..Column::new((name, short), first..=last, 1, how) }
    };
    let columns: Vec<Column> = inputs.iter().map(column).collect();
    let known = columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>().join(", ");
    let policies = arguments.policies.policies()?;
    let asked = Asked { unit, conditions: Conditions { profile, policies }, inputs };
    let mut setup = Setup { chip: Some((profile, policies)), ..Setup::new(unit.name(), columns, known, asked) };
    for (name, text) in &arguments.given {
        let Some(place) = (setup.find)(&setup.columns, name) else {
            let message = format!("`{}` has no input `{name}`", unit.name());
            return Err(Failure::usage(message, format!("its inputs are {}", setup.known)));
        };
        let column = &mut setup.columns[place];
        column.value = Some(setup.operation.read(place, column, text).ok_or_else(|| {
            let message = format!("`{text}` is out of range for `{}`", column.name);
            Failure::usage(message, format!("write {}", column.wants))
        })?);
    }
    setup.drive(&arguments.common)
}

/// What a column takes.
fn wants(input: &UnitColumn) -> String {
    match (&input.domain, &input.kind) {
        (Some(Domain::Listed(values)), kind) => {
            let values: Vec<String> = values.iter().map(|value| kind.write(*value)).collect();
            format!("one of {}", values.join(", "))
        }
        (Some(Domain::Word(bits)), _) => format!("a word of {bits} bits, such as 0x{:x}", (1_u64 << bits) - 1),
        (Some(Domain::Float(negative, limit)), _) => {
            let sign = if *negative { "" } else { ", not negative" };
            format!("the bits of a float below 2^{limit}{sign}, such as 3f800000")
        }
        _ => format!("a whole number from {} to {}", input.nth(0), input.nth(input.size() - 1)),
    }
}

impl Operation for Asked {
    fn read(&self, place: usize, _: &Column, text: &str) -> Option<i64> {
        let input = &self.inputs[place];
        let value = match &input.kind {
            Kind::Name(names) => {
                names.iter().position(|name| name.eq_ignore_ascii_case(text)).map(|place| place as i64)
            }
            kind => kind.read(text).or_else(|| number(text)),
        };
        // A column of one number is narrowed to what it takes.
        value.filter(|value| input.narrowed(*value, *value).is_some())
    }

    fn check(&self, values: &[i64]) -> Result<(), String> {
        let fits = self.unit.accepts(values, self.conditions.profile);
        if fits { Ok(()) } else { Err(format!("`{}` does not take these inputs together", self.unit.name())) }
    }

    fn run<O: Observer>(&self, values: &[i64], _: &mut O) -> Results {
        let columns = self.unit.results();
        let mut results = vec![0; columns.len()];
        self.unit.evaluate(values, &self.conditions, &mut results);
        let written = |column: &UnitColumn, value: i64| -> Value {
            match column.kind {
                Kind::Unsigned(_) | Kind::Signed(_) => json!(value),
                _ => json!(column.kind.write(value)),
            }
        };
        columns.iter().zip(results).map(|(column, value)| (column.name.clone(), written(column, value))).collect()
    }
}
