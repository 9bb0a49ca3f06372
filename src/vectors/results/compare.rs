//! Compares results with a pack by unit, tag and policy.

use super::*;
use std::collections::{BTreeMap, HashMap};

use super::waiver::Waiver;
use crate::read::TableRow;
use crate::table::LAST;
use crate::unit::{Conditions, answers};
use crate::{Contents, Kind, Table, Unit, VectorError};
use ninebit::state::Policies;

/// Comparison of results with a pack.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Comparison {
    /// Units with results, in the order of their names.
    pub units: Vec<UnitComparison>,
    /// The other value of a policy that explains most rows beyond those it breaks, if it explains more than it breaks.
    pub explanation: Option<Explanation>,
}

/// Comparison of a unit; the counts are numbers of rows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct UnitComparison {
    /// Name of the unit.
    pub unit: &'static str,
    /// Rows that have results.
    pub asked: usize,
    /// Rows that equal the pack in all columns.
    pub exact: usize,
    /// Rows that differ, by one step of the column at most.
    pub off_by_one: usize,
    /// Rows in which a number differs by more than a step, or a name or flag differs.
    pub worse: usize,
    /// Rows whose draw failed.
    pub errors: usize,
    /// Rows of the pack that have no result.
    pub not_asked: usize,
    /// Largest difference of a number, in steps of its column.
    pub largest: u64,
    /// Shares of rows by tag: the reason why the table has a row, and the policies that change it.
    pub tags: BTreeMap<String, Share>,
    /// Other values of policies, and readings, that would explain differing rows, the best first.
    pub policies: Vec<Explanation>,
    /// Number of differing rows that a waiver accepts, or that follow from another reading of an open question.
    pub waived: usize,
    /// The waiver's reason, or the reading; `None` without either.
    pub reason: Option<String>,
    /// The first differing rows.
    pub rows: Vec<RowDifference>,
}

/// Counts of the rows with one tag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Share {
    /// Rows that have results.
    pub asked: usize,
    /// Rows whose results differ.
    pub differ: usize,
}

/// The effect of another value of a policy.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Explanation {
    /// The policy and its value, such as `CMB-3=literal`.
    pub policy: String,
    /// Number of differing rows that would agree.
    pub explains: usize,
    /// Number of agreeing rows that would differ.
    pub breaks: usize,
}

impl Explanation {
    /// Returns the explained rows minus the broken ones.
    fn gain(&self) -> i64 {
        self.explains as i64 - self.breaks as i64
    }
}

/// A differing row.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RowDifference {
    /// Id of the row that differs.
    pub id: String,
    /// Line number in the file of results, from 1.
    pub line: usize,
    /// For each differing column: name, the pack's value, the observed value. Empty if the draw failed.
    pub differences: Vec<(String, String, String)>,
    /// The pack's row as `name=value`.
    pub row: Vec<String>,
}

impl UnitComparison {
    /// Waives the rows that differ if the unit asks an open question and one reading explains all of them: rows of the other readings
    /// contradict nothing.
    fn follow_reading(&mut self, unit: &dyn Unit) {
        let follows = |best: &&Explanation| best.breaks == 0 && best.explains == self.off_by_one + self.worse;
        if !unit.readings().is_empty()
            && let Some(Explanation { policy, explains, .. }) = self.policies.first().filter(follows)
        {
            (self.waived, self.reason) = (*explains, Some(format!("{policy} is what every row shows")));
        }
    }

    /// Returns the number of rows that differ or failed and are not waived.
    fn failures(&self) -> usize {
        self.off_by_one + self.worse + self.errors - self.waived
    }
}

impl Comparison {
    /// Returns whether every row is exact or waived.
    pub fn is_clean(&self) -> bool {
        self.units.iter().all(|unit| unit.failures() == 0)
    }
}

/// Compares results with the tables of their pack. Reports at most `shown` rows of each unit.
///
/// # Errors
/// Returns an error if there are results of a unit or row that the pack does not have.
pub fn compare(
    tables: &[Table],
    results: &Results,
    waivers: &[Waiver],
    shown: usize,
) -> Result<Comparison, VectorError> {
    let mut units = Vec::new();
    let mut totals: Vec<Explanation> = Vec::new();
    for of_unit in &results.units {
        let (name, table) = (of_unit.unit.name(), table_of(tables, of_unit)?);
        let pairs = paired(table, of_unit)?;
        let mut compared = unit(table, of_unit, &pairs, shown);
        for explanation in &compared.policies {
            match totals.iter_mut().find(|total| total.policy == explanation.policy) {
                Some(total) => {
                    total.explains += explanation.explains;
                    total.breaks += explanation.breaks;
                }
                None => totals.push(explanation.clone()),
            }
        }
        if let Some(waiver) = waivers.iter().find(|waiver| waiver.unit == name) {
            let differing = compared.off_by_one + compared.worse;
            // Beyond its limits a waiver accepts nothing: the known difference has changed.
            let holds = differing <= waiver.count && compared.largest <= waiver.maximum;
            compared.waived = if holds { differing } else { 0 };
            compared.reason = Some(waiver.reason.clone());
        }
        units.push(compared);
    }
    let explanation = totals.into_iter().max_by_key(Explanation::gain).filter(|best| best.gain() > 0);
    Ok(Comparison { units, explanation })
}

/// Pairs each row of results with the pack's row.
fn paired<'r>(table: &'r Table, results: &'r UnitResults) -> Result<Vec<(&'r TableRow, &'r ResultRow)>, VectorError> {
    let by_id: HashMap<&str, &TableRow> = table.rows.iter().map(|row| (row.id.as_str(), row)).collect();
    let pair = |row: &'r ResultRow| match by_id.get(row.id.as_str()) {
        Some(expected) => Ok((*expected, row)),
        None => {
            let message = format!("the pack has no row {}", row.id);
            Err(VectorError::line("NB1035", &results.path, row.line, message, "name the pack that was drawn"))
        }
    };
    results.rows.iter().map(pair).collect()
}

/// Returns for each row of results by how much each observed column lies above what the model yields under policies; `None` if the draw
/// failed. Names and flags count by their numbers.
///
/// # Errors
/// Returns an error if there are results of a row that the pack does not have.
pub fn deviations(
    table: &Table,
    results: &UnitResults,
    policies: Policies,
) -> Result<Vec<Option<Vec<i64>>>, VectorError> {
    let Contents { unit, profile, .. } = table.writer.contents();
    let of = |(row, result): (&TableRow, &ResultRow)| {
        let mut yields = vec![0; row.results.len()];
        unit.evaluate(&row.inputs, &Conditions { profile, policies }, &mut yields);
        let apart = |(column, value): (&ObservedColumn, &i64)| value - expected(&yields, column);
        result.values.as_ref().map(|values| results.columns.iter().zip(values).map(apart).collect())
    };
    Ok(paired(table, results)?.into_iter().map(of).collect())
}

/// Returns the table of a unit in a pack.
///
/// # Errors
/// Returns an error if the pack has no such unit.
pub fn table_of<'t>(tables: &'t [Table], results: &UnitResults) -> Result<&'t Table, VectorError> {
    let name = results.unit.name();
    let found = tables.iter().find(|table| table.writer.contents().unit.name() == name);
    found.ok_or_else(|| {
        let message = format!("the pack has no unit `{name}`");
        VectorError::line("NB1035", &results.path, 2, message, "name the pack that was drawn")
    })
}

/// Returns the expected number of an observed column.
fn expected(results: &[i64], column: &ObservedColumn) -> i64 {
    results[column.column] >> column.shift
}

/// Returns the difference of two numbers in steps, or `None` for names, flags and words.
fn steps(kind: &Kind, expected: i64, observed: i64) -> Option<u64> {
    let apart = expected.abs_diff(observed);
    match kind {
        Kind::Unsigned(1) | Kind::Name(_) | Kind::Hex(_) => None,
        Kind::Unsigned(_) | Kind::Signed(_) => Some(apart),
        Kind::Halves(_) => Some(apart.div_ceil(2)),
    }
}

fn unit(table: &Table, results: &UnitResults, pairs: &[(&TableRow, &ResultRow)], shown: usize) -> UnitComparison {
    let columns = table.writer.results();
    let mut compared = UnitComparison {
        unit: results.unit.name(),
        asked: pairs.len(),
        exact: 0,
        off_by_one: 0,
        worse: 0,
        errors: 0,
        not_asked: table.rows.len() - pairs.len(),
        largest: 0,
        tags: BTreeMap::new(),
        policies: Vec::new(),
        waived: 0,
        reason: None,
        rows: Vec::new(),
    };
    for (row, result) in pairs {
        let mut differences = Vec::new();
        let mut off_by_one = true;
        for (column, observed) in results.columns.iter().zip(result.values.iter().flatten()) {
            let wanted = expected(&row.results, column);
            if wanted == *observed {
                continue;
            }
            let kind = &columns[column.column].kind;
            let apart = steps(kind, wanted, *observed);
            off_by_one &= apart == Some(1);
            compared.largest = compared.largest.max(apart.unwrap_or(1));
            let text = |value: i64| match column.shift {
                0 if kind.holds(value) => kind.write(value),
                _ => value.to_string(),
            };
            differences.push((column.name.clone(), text(wanted), text(*observed)));
        }
        let differs = result.values.is_none() || !differences.is_empty();
        match (&result.values, differs, off_by_one) {
            (None, ..) => compared.errors += 1,
            (_, false, _) => compared.exact += 1,
            (_, true, true) => compared.off_by_one += 1,
            (_, true, false) => compared.worse += 1,
        }
        let fields: Vec<&str> = row.text.split('\t').collect();
        for tag in fields.get(fields.len() - LAST.len()).into_iter().flat_map(|tags| tags.split(',')) {
            let share = compared.tags.entry(tag.to_owned()).or_default();
            share.asked += 1;
            share.differ += usize::from(differs);
        }
        if differs && compared.rows.len() < shown {
            let names = table.writer.inputs().iter().chain(columns);
            let row = names.zip(&fields[1..]).map(|(column, field)| format!("{}={field}", column.name)).collect();
            compared.rows.push(RowDifference { id: result.id.clone(), line: result.line, differences, row });
        }
    }
    if compared.off_by_one + compared.worse > 0 {
        compared.policies = policies(table, results, pairs);
        compared.follow_reading(results.unit);
    }
    compared
}

/// Returns the effect of every other value of the unit's policies, the best first. Values that explain nothing are left out.
fn policies(table: &Table, results: &UnitResults, pairs: &[(&TableRow, &ResultRow)]) -> Vec<Explanation> {
    let Contents { unit, profile, .. } = table.writer.contents();
    let mut found = Vec::new();
    for answer in answers(unit, &Policies::DEFAULT).filter(|answer| unit.rules().contains(&answer.rule)) {
        let mut explanation = Explanation { policy: answer.name(), explains: 0, breaks: 0 };
        for (row, result) in pairs {
            let Some(observed) = &result.values else { continue };
            let other = answer.evaluate(unit, &row.inputs, profile, row.results.len());
            let agrees = |results_of: &[i64]| {
                results.columns.iter().zip(observed).all(|(column, value)| expected(results_of, column) == *value)
            };
            match (agrees(&row.results), agrees(&other)) {
                (false, true) => explanation.explains += 1,
                (true, false) => explanation.breaks += 1,
                _ => {}
            }
        }
        if explanation.explains > 0 {
            found.push(explanation);
        }
    }
    found.sort_by_key(|explanation| -explanation.gain());
    found
}
