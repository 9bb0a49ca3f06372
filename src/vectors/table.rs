//! Writes tables as text: tab-separated, one row per line, each number in the format of its column.
//!
//! ```text
//! # ninebit-vectors 1
//! # unit product
//! # about AB: the product of two factors, rounded to the nearest 255th, saturated
//! # profile Nv2a
//! # level L0
//! # seed 1
//! # behaviour 1
//! # rules CMB-6 NUM-2 NUM-3
//! # types s10 s10 s19 s9
//! id  in.a  in.b  mid.product  out.ab  tags  grade  reach  alternatives
//! ```
//!
//! A reader skips lines that begin with `#`, reads the column names from the next line, and finds its columns by name.

use sha2::{Digest, Sha256};

/// Revision of the model's results. It is increased when any output bit of any row changes (`CHANGELOG.md`, *Numerics*).
pub const BEHAVIOUR: u32 = 1;

use super::{Column, Conditions, Level, Origin, Unit, cases, handbook, unit};
use ninebit::state::{Named, Policies, Profile};
use ninebit_files::picture::hexadecimal;

/// First line of a table: the version of the format.
pub const FORMAT: &str = "# ninebit-vectors 1";

/// Names of the columns after those of the unit.
pub const LAST: [&str; 4] = ["tags", "grade", "reach", "alternatives"];

/// The unit, chip, level and seed that determine a table.
#[derive(Clone, Copy, Debug)]
pub struct Contents {
    /// The unit whose rows the table has.
    pub unit: &'static dyn Unit,
    /// The chip whose rules they follow.
    pub profile: Profile,
    /// The level, which limits the number of rows.
    pub level: Level,
    /// The seed of the random rows.
    pub seed: u64,
}

/// A row with everything that is written about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Values of the input columns.
    pub inputs: Vec<i64>,
    /// Values of the result columns.
    pub results: Vec<i64>,
    /// Reason why the table has it.
    pub origin: Origin,
    /// Results under those other policies that change them.
    pub alternatives: Vec<unit::Alternative>,
}

/// Writer of a table. It looks up the unit's columns once.
#[derive(Debug)]
pub struct Writer {
    contents: Contents,
    inputs: Vec<Column>,
    results: Vec<Column>,
    grade: &'static str,
}

impl Writer {
    /// Returns a writer for a table.
    pub fn new(contents: Contents) -> Writer {
        let unit = contents.unit;
        let (inputs, results) = (unit.inputs(), unit.results());
        Writer { contents, inputs, results, grade: handbook::grade(unit) }
    }

    /// Returns the unit, chip, level and seed of the table.
    pub fn contents(&self) -> Contents {
        self.contents
    }

    /// Returns the columns of configuration and inputs.
    pub fn inputs(&self) -> &[Column] {
        &self.inputs
    }

    /// Returns the columns of intermediates and results.
    pub fn results(&self) -> &[Column] {
        &self.results
    }

    /// Returns the lines before the rows.
    pub fn head(&self) -> String {
        let Contents { unit, profile, level, seed } = self.contents;
        let columns = || self.inputs.iter().chain(&self.results);
        let types: Vec<String> = columns().map(|column| column.kind.code()).collect();
        let names: Vec<&str> = columns().map(|column| column.name.as_str()).collect();
        format!(
            "{FORMAT}\n# unit {}\n# about {}\n# profile {}\n# level {}\n# seed {seed}\n# behaviour {BEHAVIOUR}\n# rules {}\n# types {}\nid\t{}\t{}\n",
            unit.name(),
            unit.about(),
            profile.name(),
            level.name(),
            unit.rules().join(" "),
            types.join(" "),
            names.join("\t"),
            LAST.join("\t"),
        )
    }

    /// Computes a row.
    pub fn row(&self, inputs: &[i64], origin: Origin) -> Row {
        let Contents { unit, profile, .. } = self.contents;
        let mut results = vec![0; self.results.len()];
        let conditions = Conditions { profile, policies: Policies::DEFAULT };
        unit.evaluate(inputs, &conditions, &mut results);
        let alternatives = unit::alternatives(unit, &self.results, inputs, &conditions, &results);
        Row { inputs: inputs.to_vec(), results, origin, alternatives }
    }

    /// Returns the id of a row: twelve hexadecimal digits of a hash over unit, chip, configuration and inputs. It depends neither on other rows nor
    /// on the results.
    pub fn id(&self, inputs: &[i64]) -> String {
        let mut hash = Sha256::new();
        hash.update(format!("{}\n{}\n", self.contents.unit.name(), self.contents.profile.name()));
        for (column, value) in self.inputs.iter().zip(inputs) {
            hash.update(format!("{}={}\n", column.name, column.kind.write(*value)));
        }
        hexadecimal(&hash.finalize()[..6])
    }

    /// Returns the line of a row, without its end.
    pub fn line(&self, row: &Row) -> String {
        let numbers = self.inputs.iter().zip(&row.inputs).chain(self.results.iter().zip(&row.results));
        let mut fields = vec![self.id(&row.inputs)];
        fields.extend(numbers.map(|(column, value)| column.kind.write(*value)));
        fields.extend(self.last(row));
        fields.join("\t")
    }

    /// Returns the values of the columns `LAST`.
    pub(crate) fn last(&self, row: &Row) -> [String; 4] {
        let reach = self.contents.unit.reach(&row.inputs, &row.results).word();
        [tags(self.contents.unit, row), self.grade.to_owned(), reach.to_owned(), self.alternatives(row)]
    }

    /// Returns the changed results under other policies, as `RULE=value:out.x=1,out.y=2;...`, or `-` if nothing changes.
    fn alternatives(&self, row: &Row) -> String {
        let texts: Vec<String> = row
            .alternatives
            .iter()
            .map(|alternative| {
                let changed = alternative.changed(&self.results, &row.results);
                let changed: Vec<String> =
                    changed.map(|(column, other)| format!("{}={}", column.name, column.kind.write(other))).collect();
                format!("{}:{}", alternative.policy, changed.join(","))
            })
            .collect();
        if texts.is_empty() { "-".to_owned() } else { texts.join(";") }
    }

    /// Passes every row of the table to `take`, or with `deciding` only those that some policy or reading changes, until `take` returns an error. Returns the
    /// number of rows.
    ///
    /// # Errors
    /// Returns the error of `take`.
    pub fn each<E>(&self, deciding: bool, mut take: impl FnMut(&Row) -> Result<(), E>) -> Result<usize, E> {
        let (mut rows, mut result) = (0, Ok(()));
        let Contents { unit, profile, level, seed } = self.contents;
        cases::visit(unit, profile, level, seed, |inputs, origin| {
            if result.is_err() {
                return;
            }
            let row = self.row(inputs, origin);
            if !deciding || !row.alternatives.is_empty() {
                rows += 1;
                result = take(&row);
            }
        });
        result.map(|()| rows)
    }
}

/// Returns the tags of a row: the reason why it is there, and the rules whose policies change it. Readings are no policies.
fn tags(unit: &dyn Unit, row: &Row) -> String {
    let mut tags = vec![row.origin.word().to_owned()];
    for alternative in row.alternatives.iter().filter(|_| unit.readings().is_empty()) {
        let tag = format!("policy:{}", alternative.rule);
        if !tags.contains(&tag) {
            tags.push(tag);
        }
    }
    tags.join(",")
}
