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
use ninebit_files::output::{write_json, write_text};
use ninebit_report::{policies_text, policies_value, steps_text, steps_value};
use serde_json::{Map, Value, json};

use super::super::Format;
use super::super::exit::Failure;
use super::inputs::{self, number};
use super::table;

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
    /// Its name in traces.
    pub(super) name: String,
    /// What it may be.
    pub(super) range: RangeInclusive<i64>,
    /// How many make 1.0; of a signed texel, in the ideal, 128 do (TEX-18).
    pub(super) per_one: i64,
    /// A signed texel.
    pub(super) signed_texel: bool,
    /// What was given; `None` if it must be given yet.
    pub(super) value: Option<i64>,
}

/// What comes out: names and values, in order.
pub(super) type Results = Vec<(String, Value)>;

/// An operation, set up.
pub(super) trait Operation {
    /// The command's name.
    const NAME: &'static str;

    /// What results are headed with.
    fn name(&self) -> &str {
        Self::NAME
    }

    /// What it takes.
    fn columns(&self) -> &[Column];

    /// The column that a name, perhaps a short one, means: that of a register, unless the operation takes something else.
    fn find(&self, name: &str) -> Option<usize> {
        inputs::register_column(name)
    }

    /// Names that `find` knows, for messages.
    fn known(&self) -> String {
        inputs::REGISTER_NAMES.to_owned()
    }

    /// How to give a column on the command line.
    fn how_to_give(&self, column: &Column) -> String {
        format!("write `--in {}=N`", column.name)
    }

    /// The value of a column that a text means, if the column takes it.
    fn read(&self, column: usize, text: &str) -> Option<i64> {
        number(text).filter(|value| self.columns()[column].range.contains(value))
    }

    /// What a column takes.
    fn wants(&self, column: usize) -> String {
        let range = &self.columns()[column].range;
        format!("a whole number from {} to {}", range.start(), range.end())
    }

    /// Whether values of all columns go together; if not, what is wrong.
    fn check(&self, _values: &[i64]) -> Result<(), String> {
        Ok(())
    }

    /// Runs it on one value for each column.
    fn run<O: Observer>(&self, values: &[i64], observer: &mut O) -> Results;

    /// The chip and the policies, where they matter.
    fn chip(&self) -> Option<(Profile, Policies)> {
        None
    }
}

/// Runs an operation on what was given: one case, or a table of them.
pub(super) fn drive(operation: &impl Operation, common: &Common) -> Result<(), Failure> {
    match &common.inputs {
        Some(path) => table::run(operation, path, common.output.as_deref()),
        None => {
            let text = one(operation, common.format)?;
            match common.format {
                Format::Text => write_text(&text)?,
                Format::Json => write_json(&text)?,
            }
            Ok(())
        }
    }
}

/// One case with its trace.
fn one<T: Operation>(operation: &T, format: Format) -> Result<String, Failure> {
    let mut values = Vec::with_capacity(operation.columns().len());
    for column in operation.columns() {
        let missing = || Failure::usage(format!("`{}` is not given", column.name), operation.how_to_give(column));
        values.push(column.value.ok_or_else(missing)?);
    }
    operation
        .check(&values)
        .map_err(|message| Failure::usage(message, "`ninebit vectors export` shows rows that go together"))?;
    let mut recorder = Recorder::default();
    let results = operation.run(&values, &mut recorder);
    let mut steps = given(operation.columns(), &values, &recorder.steps);
    steps.append(&mut recorder.steps);
    Ok(match format {
        Format::Text => text(operation, &steps, &results),
        Format::Json => {
            let (profile, policies) = match operation.chip() {
                Some((profile, policies)) => (json!(profile.name()), policies_value(&policies)),
                None => (Value::Null, Value::Null),
            };
            let value = json!({
                "format": "ninebit-op-1",
                "operation": operation.name(),
                "profile": profile,
                "policies": policies,
                "steps": steps_value(&steps),
                "results": results.into_iter().collect::<Map<String, Value>>(),
            });
            format!("{value:#}\n")
        }
    })
}

/// Steps for the given integers that the operation reads.
fn given(columns: &[Column], values: &[i64], steps: &[Step]) -> Vec<Step> {
    let mut made: HashSet<&str> = HashSet::new();
    let mut read: HashSet<&str> = HashSet::new();
    for step in steps {
        read.extend(step.inputs.iter().map(|operand| operand.name.as_str()).filter(|name| !made.contains(name)));
        made.insert(&step.name);
    }
    let pairs = columns.iter().zip(values).filter(|(column, _)| read.contains(column.name.as_str()));
    pairs
        .map(|(column, value)| {
            let step = Step::given("given", "", column.name.clone(), *value).per(column.per_one);
            match column.per_one {
                1 => step,
                _ if column.signed_texel => step.ideal(<Paired>::texel(0, *value as i32, 128).observe().1),
                _ => step.ideal(*value as f64),
            }
        })
        .collect()
}

fn text<T: Operation>(operation: &T, steps: &[Step], results: &Results) -> String {
    let mut out = String::new();
    if let Some((profile, policies)) = operation.chip() {
        let _ = writeln!(out, "{}, profile {}", operation.name(), profile.name());
        out.push_str(&policies_text(&policies));
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

/// A result without quotes.
pub(super) fn shown(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
