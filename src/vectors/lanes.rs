//! Rows of a table in block lanes, where the unit has them: what sweeps are made of is held to the same rows.

use super::digest::Output;
use super::{Column, Conditions, Unit};

/// Rows that are computed together, the wanted one among them: more than two groups of sixteen.
const RUN: i64 = 40;

/// The `out.` numbers of a row in block lanes, and the places of their columns among the results; `None` if the unit has no such form of it.
///
/// The row is computed in a run along one of its inputs: the last for which there is a form. `turn`, any number, says where in the run the row lies.
pub fn outputs(
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
        // Alone, where its neighbours do not go together.
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
