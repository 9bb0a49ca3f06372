//! What all operations share: a unit, its inputs as options or as a table, a trace, and results with names.

use std::collections::HashSet;
use std::ffi::OsString;
use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use ninebit::number::{Lane, Pair};
use ninebit::state::{Named, POLICIES, Policies, Profile};
use ninebit::trace::{Observer, Recorder, Silent, Step};
use ninebit_report::{policies_text, policies_value, steps_text, steps_value};
use ninebit_vectors::Unit;
use ninebit_vectors::column::{Column as Input, Domain, Kind};
use ninebit_vectors::unit::{Alternative, Conditions, alternatives, observed};
use serde_json::{Map, Value, json};

use super::words::{self, number};
use super::{Failure, Format, table};
use crate::undecided;

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

impl Common {
    /// Prints a list in the chosen format.
    pub(super) fn list(&self, text: impl FnOnce() -> String, json: impl FnOnce() -> String) -> Result<(), Failure> {
        self.format.print(text, json)
    }
}

/// An input of a unit.
#[derive(Clone, Debug)]
pub(super) struct Column {
    /// Its name in traces, and the numbers that it takes.
    pub(super) input: Input,
    /// A shorter name for the command line.
    pub(super) short: String,
    /// Number that stands for 1.0. In the ideal it is 128 for a signed texel (TEX-18).
    pub(super) per_one: i64,
    /// Whether it is a signed texel.
    pub(super) signed_texel: bool,
    /// The option that gives it.
    pub(super) how_to_give: String,
    /// The given number; `None` if it is still missing.
    pub(super) value: Option<i64>,
}

impl Column {
    /// Returns a column without a value.
    pub(super) fn from_input(input: Input, short: &str, how_to_give: impl Into<String>) -> Column {
        let (short, how_to_give) = (short.to_owned(), how_to_give.into());
        Column { input, short, per_one: 1, signed_texel: false, how_to_give, value: None }
    }

    /// Returns whether it takes a number.
    fn takes(&self, value: i64) -> bool {
        self.input.narrowed(value, value).is_some()
    }

    /// Reads a number, if the column takes it.
    pub(super) fn read(&self, text: &str) -> Option<i64> {
        let value = match &self.input.kind {
            Kind::Name(names) => {
                names.iter().position(|name| name.eq_ignore_ascii_case(text)).map(|place| place as i64)
            }
            kind => kind.read(text).or_else(|| number(text)),
        };
        value.filter(|value| self.takes(*value))
    }

    /// Says which numbers it takes.
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

    /// Returns an error that says which numbers it takes.
    pub(super) fn refuses(&self, value: impl std::fmt::Display) -> Failure {
        Failure::usage(format!("{value} is out of range for `{}`", self.input.name), format!("write {}", self.wants()))
    }
}

/// Returns the columns of a unit without values. `short` are their short names, if they have some, and `per_one` returns the number that stands
/// for 1.0 in a column.
pub(super) fn columns(unit: &dyn Unit, short: &[&str], per_one: fn(usize) -> i64, how_to_give: &str) -> Vec<Column> {
    let columns = unit.inputs().into_iter().enumerate().map(|(n, input)| {
        let short = short.get(n).map_or_else(|| input.name.clone(), |short| (*short).to_owned());
        Column { per_one: per_one(n), ..Column::from_input(input, &short, how_to_give) }
    });
    columns.collect()
}

/// Sets the values of columns, from the first on.
pub(super) fn set(columns: &mut [Column], values: impl IntoIterator<Item = i64>) -> Result<(), Failure> {
    for (column, value) in columns.iter_mut().zip(values) {
        if !column.takes(value) {
            return Err(column.refuses(value));
        }
        column.value = Some(value);
    }
    Ok(())
}

/// The results in order: names and values.
pub(super) type Results = Vec<(String, Value)>;

/// A unit with the values of its inputs.
pub(in crate::commands) struct Setup<'u> {
    /// The unit.
    pub(super) unit: &'u dyn Unit,
    /// The chip and the policies.
    pub(super) conditions: Conditions,
    /// Whether the results depend on chip and policies, which are then printed.
    pub(super) depends: bool,
    /// The inputs.
    pub(super) columns: Vec<Column>,
    /// Returns the index of the column with a name, which may be a short one.
    pub(super) find: fn(&[Column], &str) -> Option<usize>,
    /// Names that `find` knows, for messages.
    pub(super) known: String,
    /// Returns a result as it is printed.
    pub(super) written: fn(&Input, i64) -> Value,
    /// Columns of a table that are no inputs and are passed over.
    pub(super) passed_over: Vec<String>,
}

/// Returns a result as JSON has it: a number, or the text of tables.
fn written(column: &Input, value: i64) -> Value {
    match column.kind {
        Kind::Unsigned(_) | Kind::Signed(_) => json!(value),
        _ => json!(column.kind.write(value)),
    }
}

impl<'u> Setup<'u> {
    /// Sets up a unit that is the same on all chips and whose columns are found by their own names.
    pub(super) fn new(unit: &'u dyn Unit, columns: Vec<Column>, known: impl Into<String>) -> Setup<'u> {
        let find =
            |columns: &[Column], name: &str| columns.iter().position(|c| c.input.name == name || c.short == name);
        let conditions = Conditions { profile: Profile::Nv10, policies: Policies::DEFAULT };
        let passed_over = Vec::new();
        Setup { unit, conditions, depends: false, columns, find, known: known.into(), written, passed_over }
    }

    /// Returns the results of a row. Columns of one name are one result, an array. The observer receives the steps.
    pub(super) fn results(&self, values: &[i64], observer: &mut impl Observer) -> Results {
        let mut results = Results::new();
        for (column, value) in self.unit.results().iter().zip(observed(self.unit, values, &self.conditions, observer)) {
            let value = (self.written)(column, value);
            match results.last_mut().filter(|(name, _)| *name == column.name) {
                Some((_, Value::Array(all))) => all.push(value),
                Some((_, first)) => *first = json!([first, value]),
                None => results.push((column.name.clone(), value)),
            }
        }
        results
    }

    /// Returns an error if the values of the columns do not go together.
    pub(super) fn check(&self, values: &[i64]) -> Result<(), String> {
        let fits = self.unit.accepts(values, self.conditions.profile);
        if fits { Ok(()) } else { Err(format!("`{}` does not take these inputs together", self.unit.name())) }
    }

    /// Returns what each open rule would change: the rule, its value, and the results that would be others. `None` for a unit without such rules.
    fn alternatives(&self, values: &[i64]) -> Option<Vec<AlternativeResults>> {
        let open = |rule: &&str| POLICIES.iter().any(|policy| policy.rule == *rule);
        let asks = self.unit.rules().iter().any(open) || !self.unit.readings().is_empty();
        if !self.depends || !asks {
            return None;
        }
        let columns = self.unit.results();
        let own = observed(self.unit, values, &self.conditions, &mut Silent);
        let found = alternatives(self.unit, &columns, values, &self.conditions, &own);
        let changed = |alternative: &Alternative| {
            let results = alternative.changed(&columns, &own).filter(|(column, _)| !column.name.starts_with("mid."));
            let results = results.map(|(column, value)| (column.name.clone(), (self.written)(column, value)));
            AlternativeResults {
                rule: alternative.rule,
                policy: alternative.policy.clone(),
                results: results.collect(),
            }
        };
        Some(found.iter().map(changed).collect())
    }

    /// Computes and prints the results of the given values, or of a table of cases.
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
        self.check(&values)
            .map_err(|message| Failure::usage(message, "`ninebit vectors export` shows rows that go together"))?;
        let told = self.compute_row(&values);
        common.format.print(|| told.text(), || format!("{:#}\n", told.value()))
    }

    /// Computes a row: results, steps, and what open rules would change.
    pub(in crate::commands) fn compute_row(&self, values: &[i64]) -> OperationRun<'_> {
        let mut recorder = Recorder::default();
        let results = self.results(values, &mut recorder);
        let mut steps = given_steps(&self.columns, values, &recorder.steps);
        steps.append(&mut recorder.steps);
        OperationRun { setup: self, steps, results, changed: self.alternatives(values) }
    }
}

/// An operation that was run.
pub(in crate::commands) struct OperationRun<'s> {
    setup: &'s Setup<'s>,
    steps: Vec<Step>,
    results: Results,
    changed: Option<Vec<AlternativeResults>>,
}

impl OperationRun<'_> {
    /// Returns it as JSON.
    pub(in crate::commands) fn value(&self) -> Value {
        let Conditions { profile, policies } = &self.setup.conditions;
        let depends = self.setup.depends;
        json!({
            "format": "ninebit-op-1",
            "operation": self.setup.unit.name(),
            "profile": depends.then(|| profile.name()),
            "policies": depends.then(|| policies_value(policies)),
            "steps": steps_value(&self.steps),
            "results": self.results.iter().cloned().collect::<Map<String, Value>>(),
            "alternatives": self.changed.as_ref().map(|all| all.iter().map(AlternativeResults::value).collect::<Vec<_>>()),
        })
    }

    fn text(&self) -> String {
        let mut out = String::new();
        if self.setup.depends {
            let Conditions { profile, policies } = &self.setup.conditions;
            let _ = writeln!(out, "{}, profile {}", self.setup.unit.name(), profile.name());
            out.push_str(&policies_text(policies));
        }
        out.push_str(&self.steps());
        if self.results.is_empty() {
            out.push_str("  result: nothing is written\n");
        } else {
            let results: Vec<String> =
                self.results.iter().map(|(name, value)| format!("{name} {}", result_text(value))).collect();
            let _ = writeln!(out, "  result: {}", results.join("  "));
        }
        out + &self.changes()
    }

    /// Returns the steps as a table; nothing for a unit without steps.
    pub(in crate::commands) fn steps(&self) -> String {
        if self.steps.is_empty() { String::new() } else { steps_text(&self.steps) }
    }

    /// Says which open rules would change the results, and to what.
    pub(in crate::commands) fn changes(&self) -> String {
        let Some(all) = &self.changed else { return String::new() };
        let mut out = undecided::sentence(all.iter().map(|each| each.rule), "this result") + "\n";
        for AlternativeResults { policy, results, .. } in all {
            let results: Vec<String> =
                results.iter().map(|(name, value)| format!("{name} {}", result_text(value))).collect();
            let _ = writeln!(out, "  {policy:<16} {}", results.join("  "));
        }
        out
    }
}

/// What another value of an open rule changes.
struct AlternativeResults {
    rule: &'static str,
    policy: String,
    results: Results,
}

impl AlternativeResults {
    fn value(&self) -> Value {
        json!({ "policy": self.policy, "results": self.results.iter().cloned().collect::<Map<String, Value>>() })
    }
}

/// Returns steps for the given integers that the unit reads.
fn given_steps(columns: &[Column], values: &[i64], steps: &[Step]) -> Vec<Step> {
    let mut made: HashSet<&str> = HashSet::new();
    let mut read: HashSet<&str> = HashSet::new();
    for step in steps {
        read.extend(step.inputs.iter().map(|operand| operand.name.as_str()).filter(|name| !made.contains(name)));
        made.insert(&step.name);
    }
    let pairs = columns.iter().zip(values).filter(|(column, _)| read.contains(column.input.name.as_str()));
    pairs
        .map(|(column, value)| {
            let step = Step::plain("given", "", column.input.name.clone(), *value).per(column.per_one);
            match column.per_one {
                1 => step,
                _ if column.signed_texel => step.ideal(<Pair>::texel(0, *value as i32, 128).observe().1),
                _ => step.ideal(*value as f64),
            }
        })
        .collect()
}

/// Returns the text of a result, without quotes.
pub(super) fn result_text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
