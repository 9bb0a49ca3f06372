//! What all operations share: named integers in, a trace and named results out.

use std::collections::HashSet;
use std::ffi::OsString;
use std::fmt::Write;
use std::ops::RangeInclusive;
use std::path::PathBuf;

use clap::Args;
use ninebit::number::{Lane, Paired};
use ninebit::state::{Named, Policies, Profile};
use ninebit::trace::{Observer, Recorder, Step};
use ninebit_report::{policies_text, policies_value, steps_text, steps_value};
use ninebit_vectors::column::{Column as Input, Domain, Kind};
use serde_json::{Map, Value, json};

use super::words::{self, number};
use super::{Failure, Format, table};

/// The option that chooses a chip.
#[derive(Debug, Args)]
pub(super) struct ProfileArgument {
    /// The chip: nv10 or nv2a
    #[arg(long, value_name = "PROFILE", default_value = "nv10", value_parser = words::profile)]
    pub(super) profile: Profile,
}

/// Options of every operation.
#[derive(Debug, Args)]
pub(super) struct Common {
    /// How to print it
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = Format::Text, conflicts_with = "inputs")]
    format: Format,
    /// Many cases: a table whose header names inputs and whose lines are cases, `-` for stdin; printed with the results
    #[arg(long, value_name = "FILE.tsv")]
    inputs: Option<PathBuf>,
    /// Where the table of results goes [default: stdout]
    #[arg(short, long, value_name = "OUT.tsv", requires = "inputs")]
    output: Option<OsString>,
}

/// An integer that an operation takes.
#[derive(Clone, Debug)]
pub(super) struct Column {
    /// Its name in traces, and what it takes.
    pub(super) input: Input,
    /// A shorter name by which it may be given.
    pub(super) short: String,
    /// How many make 1.0; of a signed texel, in the ideal, 128 do (TEX-18).
    pub(super) per_one: i64,
    /// A signed texel.
    pub(super) signed_texel: bool,
    /// How to give it on the command line.
    pub(super) how_to_give: String,
    /// What was given; `None` if it must be given yet.
    pub(super) value: Option<i64>,
}

impl Column {
    /// A column of whole numbers that must be given yet.
    pub(super) fn new(
        (name, short): (&str, &str),
        range: RangeInclusive<i64>,
        per_one: i64,
        how_to_give: impl Into<String>,
    ) -> Column {
        let input = Input::signed(name, 64, *range.start(), *range.end());
        Column { per_one, ..Column::from_input(input, short, how_to_give) }
    }

    /// A column that must be given yet.
    pub(super) fn from_input(input: Input, short: &str, how_to_give: impl Into<String>) -> Column {
        let (short, how_to_give) = (short.to_owned(), how_to_give.into());
        Column { input, short, per_one: 1, signed_texel: false, how_to_give, value: None }
    }

    /// Whether it takes a number.
    fn takes(&self, value: i64) -> bool {
        self.input.narrowed(value, value).is_some()
    }

    /// The number that a text means, if the column takes it.
    pub(super) fn read(&self, text: &str) -> Option<i64> {
        let value = match &self.input.kind {
            Kind::Name(names) => {
                names.iter().position(|name| name.eq_ignore_ascii_case(text)).map(|place| place as i64)
            }
            kind => kind.read(text).or_else(|| number(text)),
        };
        value.filter(|value| self.takes(*value))
    }

    /// What it takes, in words.
    pub(super) fn wants(&self) -> String {
        let input = &self.input;
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

    /// An error that says what it takes.
    pub(super) fn refuses(&self, value: impl std::fmt::Display) -> Failure {
        Failure::usage(format!("{value} is out of range for `{}`", self.input.name), format!("write {}", self.wants()))
    }
}

/// Gives columns, from the first, their values.
pub(super) fn set(columns: &mut [Column], values: impl IntoIterator<Item = i64>) -> Result<(), Failure> {
    for (column, value) in columns.iter_mut().zip(values) {
        if !column.takes(value) {
            return Err(column.refuses(value));
        }
        column.value = Some(value);
    }
    Ok(())
}

/// Coordinates of texels, in whole ones or in 1/256.
pub(super) const COORDINATES: RangeInclusive<i64> = -16_777_216..=16_777_215;

/// What comes out: names and values, in order.
pub(super) type Results = Vec<(String, Value)>;

/// What is done with the integers.
pub(super) trait Operation {
    /// Whether values of all columns go together; if not, what is wrong.
    fn check(&self, _values: &[i64]) -> Result<(), String> {
        Ok(())
    }

    /// Runs it on one value for each column.
    fn run<O: Observer>(&self, values: &[i64], observer: &mut O) -> Results;
}

/// An operation, set up.
pub(super) struct Setup<T> {
    /// What results are headed with.
    pub(super) name: &'static str,
    /// What it takes.
    pub(super) columns: Vec<Column>,
    /// The place of the column that a name, perhaps a short one, means.
    pub(super) find: fn(&[Column], &str) -> Option<usize>,
    /// Names that `find` knows, for messages.
    pub(super) known: String,
    /// The chip and the policies, where they matter.
    pub(super) chip: Option<(Profile, Policies)>,
    /// What is done.
    pub(super) operation: T,
}

impl<T: Operation> Setup<T> {
    /// An operation for which the chip does not matter, and whose columns have the names that stand in them.
    pub(super) fn new(name: &'static str, columns: Vec<Column>, known: impl Into<String>, operation: T) -> Setup<T> {
        let find =
            |columns: &[Column], name: &str| columns.iter().position(|c| c.input.name == name || c.short == name);
        Setup { name, columns, find, known: known.into(), chip: None, operation }
    }

    /// Runs it on what was given: one case, or a table of them.
    pub(super) fn drive(&self, common: &Common) -> Result<(), Failure> {
        if let Some(path) = &common.inputs {
            return table::run(self, path, common.output.as_deref());
        }
        let value = |column: &Column| {
            let missing =
                || Failure::usage(format!("`{}` is not given", column.input.name), column.how_to_give.as_str());
            column.value.ok_or_else(missing)
        };
        let values = self.columns.iter().map(value).collect::<Result<Vec<i64>, Failure>>()?;
        self.operation
            .check(&values)
            .map_err(|message| Failure::usage(message, "`ninebit vectors export` shows rows that go together"))?;
        let mut recorder = Recorder::default();
        let results = self.operation.run(&values, &mut recorder);
        let mut steps = given(&self.columns, &values, &recorder.steps);
        steps.append(&mut recorder.steps);
        let json = || {
            let value = json!({
                "format": "ninebit-op-1",
                "operation": self.name,
                "profile": self.chip.map(|(profile, _)| profile.name()),
                "policies": self.chip.map(|(_, policies)| policies_value(&policies)),
                "steps": steps_value(&steps),
                "results": results.iter().cloned().collect::<Map<String, Value>>(),
            });
            format!("{value:#}\n")
        };
        common.format.print(|| self.text(&steps, &results), json)
    }

    fn text(&self, steps: &[Step], results: &Results) -> String {
        let mut out = String::new();
        if let Some((profile, policies)) = &self.chip {
            let _ = writeln!(out, "{}, profile {}", self.name, profile.name());
            out.push_str(&policies_text(policies));
        }
        if !steps.is_empty() {
            out.push_str(&steps_text(steps));
        }
        if results.is_empty() {
            out.push_str("  result: nothing is written\n");
            return out;
        }
        let results: Vec<String> = results.iter().map(|(name, value)| format!("{name} {}", shown(value))).collect();
        let _ = writeln!(out, "  result: {}", results.join("  "));
        out
    }
}

/// Steps for the given integers that the operation reads.
fn given(columns: &[Column], values: &[i64], steps: &[Step]) -> Vec<Step> {
    let mut made: HashSet<&str> = HashSet::new();
    let mut read: HashSet<&str> = HashSet::new();
    for step in steps {
        read.extend(step.inputs.iter().map(|operand| operand.name.as_str()).filter(|name| !made.contains(name)));
        made.insert(&step.name);
    }
    let pairs = columns.iter().zip(values).filter(|(column, _)| read.contains(column.input.name.as_str()));
    pairs
        .map(|(column, value)| {
            let step = Step::given("given", "", column.input.name.clone(), *value).per(column.per_one);
            match column.per_one {
                1 => step,
                _ if column.signed_texel => step.ideal(<Paired>::texel(0, *value as i32, 128).observe().1),
                _ => step.ideal(*value as f64),
            }
        })
        .collect()
}

/// A result without quotes.
pub(super) fn shown(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
