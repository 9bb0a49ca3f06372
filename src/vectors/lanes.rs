//! Rows of a table in block lanes: checks the code that sweeps use against the same rows.

use super::digest::Output;
use super::{Column, Conditions, Unit};

/// Number of rows that are computed together. It is more than two groups of sixteen.
const RUN: i64 = 40;

/// Computes the `out.` numbers of a row in block lanes. Returns pairs of a result column's index and its number, or `None` if the unit has no block
/// form of the row.
///
/// The row is computed in a run along the last input for which there is a form. `turn` may be any number; it chooses the row's position in the run.
pub(crate) fn outputs(
    unit: &dyn Unit,
    [columns, results]: [&[Column]; 2],
    row: &[i64],
    turn: usize,
    conditions: &Conditions,
) -> Option<Vec<(usize, i64)>> {
    let outputs = Output::from_columns(results);
    let width: usize = outputs.iter().map(|output| output.bytes).sum();
    let mut inputs = row.to_vec();
    let along = (0..columns.len()).rev().filter(|index| columns[*index].counts());
    along.into_iter().find_map(|varying| {
        let column = &columns[varying];
        let ends = [0, column.size().saturating_sub(1)].map(|place| column.nth(place));
        let first = (row[varying] - turn as i64 % RUN).max(ends[0]);
        let last = (first + RUN - 1).min(ends[1]);
        let mut goes = |number: i64| {
            inputs[varying] = number;
            unit.accepts(&inputs, conditions.profile)
        };
        // The row is computed alone if the unit does not accept its neighbours.
        let [first, last] = if goes(first) && goes(last) { [first, last] } else { [row[varying]; 2] };
        inputs[varying] = first;
        let mut bytes = vec![0; width * (last - first + 1) as usize];
        let found = unit.block(&inputs, varying, conditions, &mut bytes);
        inputs[varying] = row[varying];
        found?;
        let mut at = width * (row[varying] - first) as usize;
        let numbers = outputs.iter().map(|output| {
            at += output.bytes;
            (output.index, output.read(&bytes[at - output.bytes..at]))
        });
        Some(numbers.collect())
    })
}
