//! Tables as text: tab separated, one row a line, numbers as their columns write them.
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
//! A reader skips what begins with `#`, takes the names from the next line, and finds its columns by them.

use sha2::{Digest, Sha256};

/// The revision of what the model computes. It goes up when any output bit of any row changes (`CHANGELOG.md`, *Numerics*).
pub const BEHAVIOUR: u32 = 1;

use super::{Column, Conditions, Level, Origin, Unit, cases, handbook, unit};
use ninebit::state::{Named, Policies, Profile};
use ninebit_files::picture::hexadecimal;

/// First line of a table.
pub const FORMAT: &str = "# ninebit-vectors 1";

/// Columns after the unit's own.
pub const LAST: [&str; 4] = ["tags", "grade", "reach", "alternatives"];

/// What a table is of.
#[derive(Clone, Copy, Debug)]
pub struct Contents {
    /// The unit whose rows these are.
    pub unit: &'static dyn Unit,
    /// The chip whose rules they follow.
    pub profile: Profile,
    /// The number of rows.
    pub level: Level,
    /// The seed of the random rows.
    pub seed: u64,
}

/// A row with everything that is written of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Numbers of the input columns.
    pub inputs: Vec<i64>,
    /// Numbers of the result columns.
    pub results: Vec<i64>,
    /// Why it is there.
    pub origin: Origin,
    /// What it would yield under other policies.
    pub alternatives: Vec<unit::Alternative>,
}

/// The columns of a unit, looked up once for a whole table.
#[derive(Debug)]
pub struct Writer {
    contents: Contents,
    inputs: Vec<Column>,
    results: Vec<Column>,
    grade: &'static str,
}

impl Writer {
    /// A writer of the table of a unit on a chip.
    pub fn new(contents: Contents) -> Writer {
        let unit = contents.unit;
        let (inputs, results) = (unit.inputs(), unit.results());
        Writer { contents, inputs, results, grade: handbook::weakest(unit.rules()) }
    }

    /// What the table is of.
    pub fn contents(&self) -> Contents {
        self.contents
    }

    /// Columns of configuration and inputs.
    pub fn inputs(&self) -> &[Column] {
        &self.inputs
    }

    /// Columns of intermediates and results.
    pub fn results(&self) -> &[Column] {
        &self.results
    }

    /// The lines before the rows.
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
        unit.evaluate(inputs, &Conditions { profile, policies: Policies::DEFAULT }, &mut results);
        let alternatives = unit::alternatives(unit, &self.results, inputs, profile, &results);
        Row { inputs: inputs.to_vec(), results, origin, alternatives }
    }

    /// The id of a row: twelve hexadecimal digits of a hash over unit, chip, configuration and inputs. It does not change when rows
    /// come or go, nor with the results.
    pub fn id(&self, inputs: &[i64]) -> String {
        let mut hash = Sha256::new();
        hash.update(format!("{}\n{}\n", self.contents.unit.name(), self.contents.profile.name()));
        for (column, value) in self.inputs.iter().zip(inputs) {
            hash.update(format!("{}={}\n", column.name, column.kind.write(*value)));
        }
        hexadecimal(&hash.finalize()[..6])
    }

    /// The line of a row, without its end.
    pub fn line(&self, row: &Row) -> String {
        let numbers = self.inputs.iter().zip(&row.inputs).chain(self.results.iter().zip(&row.results));
        let mut fields = vec![self.id(&row.inputs)];
        fields.extend(numbers.map(|(column, value)| column.kind.write(*value)));
        fields.extend(self.last(row));
        fields.join("\t")
    }

    /// The values of the columns [`LAST`].
    pub fn last(&self, row: &Row) -> [String; 4] {
        let reach = self.contents.unit.reach(&row.inputs, &row.results).word();
        [tags(row), self.grade.to_owned(), reach.to_owned(), self.alternatives(row)]
    }

    /// `RULE=value:out.x=1,out.y=2;...`: what differs of the results; `-` if nothing.
    fn alternatives(&self, row: &Row) -> String {
        let texts: Vec<String> = row
            .alternatives
            .iter()
            .map(|alternative| {
                let changed = self.results.iter().zip(alternative.results.iter().zip(&row.results));
                let changed: Vec<String> = changed
                    .filter(|(_, (other, own))| other != own)
                    .map(|(column, (other, _))| format!("{}={}", column.name, column.kind.write(*other)))
                    .collect();
                format!("{}:{}", alternative.policy, changed.join(","))
            })
            .collect();
        if texts.is_empty() { "-".to_owned() } else { texts.join(";") }
    }

    /// Hands over every row of the table, with `deciding` only those that some policy changes, until one is refused. Returns their number.
    ///
    /// # Errors
    /// What `take` refuses.
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

/// Why the row is there, and the rules whose policies change it.
fn tags(row: &Row) -> String {
    let mut tags = vec![row.origin.word().to_owned()];
    for alternative in &row.alternatives {
        let rule = alternative.policy.split('=').next().unwrap_or_default();
        let tag = format!("policy:{rule}");
        if !tags.contains(&tag) {
            tags.push(tag);
        }
    }
    tags.join(",")
}
