//! `ninebit op unit`: any unit of the conformance vectors on given numbers.

use clap::Args;
use ninebit::state::{Policies, Profile};
use ninebit::trace::Observer;
use ninebit_vectors::Unit;
use ninebit_vectors::column::{Column as UnitColumn, Domain, Kind};
use ninebit_vectors::unit::Conditions;
use serde_json::{Value, json};

use super::super::exit::Failure;
use super::super::scene::PolicyArguments;
use super::super::vectors;
use super::inputs::number;
use super::operation::{Column, Common, Operation, Results, drive};
use super::words;

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
    columns: Vec<Column>,
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
        Column { name: input.name.clone(), range: first..=last, per_one: 1, signed_texel: false, value: None }
    };
    let columns = inputs.iter().map(column).collect();
    let conditions = Conditions { profile, policies: arguments.policies.policies()? };
    let mut asked = Asked { unit, conditions, inputs, columns };
    for (name, text) in &arguments.given {
        let Some(place) = asked.find(name) else {
            let message = format!("`{}` has no input `{name}`", unit.name());
            return Err(Failure::usage(message, format!("its inputs are {}", asked.known())));
        };
        let value = asked.read(place, text).ok_or_else(|| {
            let message = format!("`{text}` is out of range for `{}`", asked.inputs[place].name);
            Failure::usage(message, format!("write {}", asked.wants(place)))
        })?;
        asked.columns[place].value = Some(value);
    }
    drive(&asked, &arguments.common)
}

/// A column's name without what kind of column it is.
fn short(name: &str) -> &str {
    name.split_once('.').map_or(name, |(_, own)| own)
}

impl Operation for Asked {
    const NAME: &'static str = "unit";

    fn name(&self) -> &str {
        self.unit.name()
    }

    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn find(&self, name: &str) -> Option<usize> {
        self.inputs.iter().position(|input| input.name == name || short(&input.name) == name)
    }

    fn known(&self) -> String {
        let names: Vec<&str> = self.inputs.iter().map(|input| input.name.as_str()).collect();
        names.join(", ")
    }

    fn how_to_give(&self, column: &Column) -> String {
        let place = self.find(&column.name).unwrap_or(0);
        format!("write `--in {}=VALUE`: {}", short(&column.name), self.wants(place))
    }

    fn read(&self, column: usize, text: &str) -> Option<i64> {
        let input = &self.inputs[column];
        let value = match &input.kind {
            Kind::Name(names) => {
                names.iter().position(|name| name.eq_ignore_ascii_case(text)).map(|place| place as i64)
            }
            kind => kind.read(text).or_else(|| number(text)),
        };
        // A column of one number is narrowed to what it takes.
        value.filter(|value| input.narrowed(*value, *value).is_some())
    }

    fn wants(&self, column: usize) -> String {
        let input = &self.inputs[column];
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

    fn check(&self, values: &[i64]) -> Result<(), String> {
        let fits = self.unit.accepts(values, self.conditions.profile);
        if fits { Ok(()) } else { Err(format!("`{}` does not take these inputs together", self.unit.name())) }
    }

    fn chip(&self) -> Option<(Profile, Policies)> {
        Some((self.conditions.profile, self.conditions.policies))
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
