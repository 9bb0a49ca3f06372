//! The score of a card's or driver's answers to a pack of vectors: a unit is a frame, a row is a pixel.

use std::collections::{BTreeMap, HashMap};

use ninebit::shortcut::{Shortcut, Shortcuts};
use ninebit::state::{Named, Policies};
use ninebit_vectors::error::VectorError;
use ninebit_vectors::read::Table;
use ninebit_vectors::results::compare::{compare, deviations, table_of};
use ninebit_vectors::results::{Results, UnitResults};

use crate::causes::{Causes, choose};
use crate::chance::Differences;
use crate::explain::{Class, Counts, FrameScore};
use crate::run::Run;
use crate::search::Explanation;

/// The deviations of the rows of a unit; `None` where a draw failed.
type Deviations = Vec<Option<Vec<i64>>>;

/// Scores a device's answers to a pack. Its causes are the shortcuts that are policies.
///
/// # Errors
/// The answers are not those of the pack.
pub fn of_answers(name: String, tables: &[Table], results: &Results, explain: bool) -> Result<Run, VectorError> {
    let mut frames = Vec::new();
    for (unit, counted) in results.units.iter().zip(compare(tables, results, &[], 0)?.units) {
        let table = table_of(tables, unit)?;
        let of = |shortcuts: Shortcuts| deviations(table, unit, shortcuts.policies(Policies::DEFAULT));
        let own = of(Shortcuts::NONE)?;
        let counts = Counts {
            compared: counted.asked as u64,
            wrong: (counted.asked - counted.exact) as u64,
            by_one: counted.off_by_one as u64,
            far: own.iter().filter(|row| row.as_ref().is_none_or(|row| row.iter().any(|by| by.abs() > 8))).count()
                as u64,
        };
        let class = match counts {
            Counts { compared: 0, .. } => Class::Missing,
            Counts { wrong: 0, .. } => Class::Exact,
            Counts { wrong, by_one, .. } if wrong == by_one => Class::OffByOne,
            _ => Class::Wrong,
        };
        let explanation = if explain && counts.wrong > 0 { Some(explanation(unit, &own, of)?) } else { None };
        let (suite, name) = (unit.unit.name().to_owned(), unit.asked[1].clone());
        frames.push(FrameScore { suite, name, class, counts, explanation, attributed: Vec::new() });
    }
    let causes = explain.then(|| attributed(&mut frames));
    Ok(Run { name, frames, foreign: Vec::new(), causes, samples: BTreeMap::new() })
}

/// Returns the variants that can change a unit: shortcuts that are policies of its rules, and two of them.
fn variants(unit: &UnitResults) -> Vec<Shortcuts> {
    let is_policy = |shortcut: &Shortcut| {
        let rules = shortcut.reading().rules;
        let changes = Shortcuts::NONE.with(*shortcut).policies(Policies::DEFAULT) != Policies::DEFAULT;
        changes && rules.iter().any(|rule| unit.unit.rules().contains(rule))
    };
    let known: Vec<Shortcut> = Shortcut::ALL.iter().copied().filter(is_policy).collect();
    let one = known.iter().map(|shortcut| Shortcuts::NONE.with(*shortcut));
    let two = known
        .iter()
        .enumerate()
        .flat_map(|(n, first)| known[n + 1..].iter().map(|second| Shortcuts::NONE.with(*first).with(*second)));
    one.chain(two).collect()
}

fn explanation(
    unit: &UnitResults,
    own: &Deviations,
    of: impl Fn(Shortcuts) -> Result<Deviations, VectorError>,
) -> Result<Explanation, VectorError> {
    let mut found = Explanation { is_closed: true, ..Explanation::default() };
    let mut signatures = vec![0_u128; own.len()];
    let is_right = |row: &[i64]| row.iter().all(|by| *by == 0);
    for variant in variants(unit) {
        let mut predicted = Differences::default();
        let mut moves = false;
        for (n, (row, other)) in own.iter().zip(of(variant)?).enumerate() {
            let (Some(row), Some(other)) = (row, other) else { continue };
            let steps: Vec<i64> = row.iter().zip(&other).map(|(row, other)| row - other).collect();
            if !is_right(&steps) {
                moves = true;
                add(&mut predicted, &steps);
                signatures[n] |= u128::from(is_right(&other)) << found.variants.len();
            }
        }
        if moves {
            found.variants.push(variant);
            found.predicted.push(predicted);
        }
    }
    for (row, signature) in own.iter().zip(signatures) {
        let Some(row) = row else {
            *found.signatures.entry(0).or_default() += 1;
            continue;
        };
        add(&mut found.actual, row);
        if !is_right(row) {
            *found.signatures.entry(signature).or_default() += 1;
        }
    }
    Ok(found)
}

/// Counts the steps of a row's first columns as those of a pixel.
fn add(differences: &mut Differences, steps: &[i64]) {
    let channel = |n: usize| (128 + steps.get(n).map_or(0, |step| (*step).clamp(-128, 127))) as u8;
    differences.add([128; 4], [channel(0), channel(1), channel(2), 128], 1);
}

/// Chooses the causes, and counts their rows in each unit.
fn attributed(frames: &mut [FrameScore]) -> Causes {
    let mut causes = choose(frames.iter().filter_map(|frame| frame.explanation.as_ref()));
    let order = causes.narrow_first();
    let mut totals = vec![0; causes.causes.len()];
    for frame in frames {
        let Some(Explanation { variants, signatures, .. }) = &frame.explanation else { continue };
        let mut counts = HashMap::<usize, u64>::new();
        for (signature, count) in signatures {
            let yields = |variant: &Shortcuts| {
                variants.iter().position(|known| known == variant).is_some_and(|n| signature >> n & 1 != 0)
            };
            if let Some((number, _)) = order.iter().find(|(_, variant)| yields(variant)) {
                *counts.entry(*number).or_default() += count;
            }
        }
        frame.attributed.extend(counts);
        frame.attributed.sort_unstable();
        frame.attributed.iter().for_each(|(number, rows)| totals[*number] += rows);
    }
    causes.causes.iter_mut().zip(totals).for_each(|(cause, rows)| cause.pixels = rows);
    causes
}
