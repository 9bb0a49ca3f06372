//! Units: parts of the chip as functions from integers to integers.

use std::ops::Range;

use super::Column;
use super::digest::Digesting;
use ninebit::state::{POLICIES, Policies, Policy, Profile, named};
use ninebit::trace::{Observer, Recorder};

/// The conditions of a table, besides the numbers of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Conditions {
    /// The chip whose rules apply.
    pub profile: Profile,
    /// The policies of rules with alternatives.
    pub policies: Policies,
}

/// A unit: its input columns, its result columns, and the model's own function between them.
pub trait Unit: Sync {
    /// Returns its name, which is also that of its files: lower case, with words joined by `-`.
    fn name(&self) -> &'static str;

    /// Returns a line that says what it does.
    fn about(&self) -> &'static str;

    /// Returns the ids of its rules.
    fn rules(&self) -> &'static [&'static str];

    /// Returns the chips that have it.
    fn profiles(&self) -> &'static [Profile] {
        &[Profile::Nv10, Profile::Nv2a]
    }

    /// Returns the columns of configuration and inputs, `cfg.` and `in.`.
    fn inputs(&self) -> Vec<Column>;

    /// Returns the columns of intermediates and results, `mid.` and `out.`.
    fn results(&self) -> Vec<Column>;

    /// Returns the names of the readings of an open question, if the unit asks one: no capture decides its results. The model follows
    /// the first reading, or refuses such a draw. The first column, `cfg.reading`, then has the number of the reading that a row
    /// follows, and the first of the unit's rules is the one in question.
    fn readings(&self) -> &'static [&'static str] {
        &[]
    }

    /// Computes the results of one row. Both slices are as long as their columns.
    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]);

    /// Records the steps of one row, with the ideal beside the integers. Units without reports record nothing.
    fn trace(&self, _inputs: &[i64], _conditions: &Conditions, _recorder: &mut Recorder) {}

    /// Computes consecutive rows at once in block lanes, if the unit can do that. The rows have the same inputs except for `varying`, which
    /// counts up from its value, and all of them are accepted. `out` has room for exactly these rows: the numbers of the `out.` columns,
    /// each in as many whole bytes as its bits need, low byte first.
    ///
    /// Returns the number of rows with an output that is the least of its column's type, and of rows with one that is the greatest, or
    /// `None` if the unit cannot compute these rows so. The results are those of [`evaluate`](Self::evaluate); tests and `ninebit vectors
    /// check` compare both.
    fn block(&self, _inputs: &[i64], _varying: usize, _conditions: &Conditions, _out: &mut [u8]) -> Option<[u64; 2]> {
        None
    }

    /// Computes rows of which only the input `varying` varies, over the given places of its column, and passes on those that are accepted.
    ///
    /// No unit overrides this. A provided method is compiled for each unit, which saves an indirect call for every row.
    #[allow(clippy::too_many_arguments, reason = "a loop that is compiled for each unit, and what it fills")]
    fn run(
        &self,
        inputs: &mut [i64],
        varying: usize,
        column: &Column,
        places: Range<u64>,
        conditions: &Conditions,
        results: &mut [i64],
        digest: &mut Digesting,
    ) {
        for place in places {
            inputs[varying] = column.nth(u128::from(place));
            if self.accepts(inputs, conditions.profile) {
                self.evaluate(inputs, conditions, results);
                digest.take(results);
            }
        }
    }

    /// Returns whether the inputs go together on this chip. If a unit with [`block`](Self::block) accepts two rows that differ in one
    /// input, it accepts all rows between them.
    fn accepts(&self, _inputs: &[i64], _profile: Profile) -> bool {
        true
    }

    /// Adjusts random inputs to each other, where few would fit by chance.
    fn fit(&self, _inputs: &mut [i64]) {}

    /// Returns rows that are always in tables: examples of the handbook, and earlier errors.
    fn regressions(&self) -> Vec<Vec<i64>> {
        Vec::new()
    }

    /// Returns how a frame buffer of eight bits can show the row.
    fn reach(&self, _inputs: &[i64], _results: &[i64]) -> Reach {
        Reach::Inside
    }
}

/// Returns the results of a row. The observer receives the steps.
pub fn observed<O: Observer>(unit: &dyn Unit, inputs: &[i64], conditions: &Conditions, observer: &mut O) -> Vec<i64> {
    if O::ON {
        let mut recorder = Recorder::default();
        unit.trace(inputs, conditions, &mut recorder);
        recorder.steps.into_iter().for_each(|step| observer.step(step));
    }
    let mut results = vec![0; unit.results().len()];
    unit.evaluate(inputs, conditions, &mut results);
    results
}

impl std::fmt::Debug for dyn Unit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

named! {
    /// How a draw can show the result of a row.
    pub enum Reach =>
    /// The word in the table.
    word: &'static str {
        /// Operands are texels, constants or vertex colours, and the result is stored as it is.
        Direct => "direct",
        /// An operand is negative or above 255, so an earlier general stage has to compute it.
        StageBefore => "stage-before",
        /// The result is negative, so two draws store it as it is and negated.
        TwoDraws => "two-draws",
        /// Both an earlier stage and two draws are needed.
        StageBeforeTwoDraws => "stage-before+two-draws",
        /// Geometry shows the result: which pixels are covered, or which texel is read.
        Geometry => "geometry",
        /// No draw shows the result by itself, but units that use it do.
        Inside => "inside",
    }
}

impl Reach {
    /// Returns how operands and result fit a frame buffer.
    pub fn from_values(operands: &[i64], results: &[i64]) -> Reach {
        let bytes = |values: &[i64]| values.iter().all(|v| (0..=255).contains(v));
        match (bytes(operands), bytes(results)) {
            (true, true) => Reach::Direct,
            (false, true) => Reach::StageBefore,
            (true, false) => Reach::TwoDraws,
            (false, false) => Reach::StageBeforeTwoDraws,
        }
    }
}

/// The results of a row under another reading of a rule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alternative {
    /// The rule in question.
    pub rule: &'static str,
    /// The rule and the value of its policy, or the reading of an open question: `CMB-3=literal`, `SHD-1=Nearest`.
    pub policy: String,
    /// The results, one number for each result column.
    pub results: Vec<i64>,
}

impl Alternative {
    /// Returns the columns that are not as in `results`, with their numbers.
    pub fn changed<'c>(&'c self, columns: &'c [Column], results: &'c [i64]) -> impl Iterator<Item = (&'c Column, i64)> {
        let all = columns.iter().zip(self.results.iter().zip(results));
        all.filter(|(_, (other, own))| other != own).map(|(column, (other, _))| (column, *other))
    }
}

/// Returns the policies and readings that change the outcome of a row, one at a time; intermediates (`mid.`) are none.
///
/// `columns` are the result columns, which the caller has looked up once.
pub fn alternatives(
    unit: &dyn Unit,
    columns: &[Column],
    inputs: &[i64],
    conditions: &Conditions,
    results: &[i64],
) -> Vec<Alternative> {
    let mut found = Vec::new();
    for answer in answers(unit, &conditions.policies) {
        let (rule, policy) = (answer.rule, answer.name());
        let other = answer.evaluate(unit, inputs, conditions.profile, results.len());
        let alternative = Alternative { rule, policy, results: other };
        if alternative.changed(columns, results).any(|(column, _)| !column.name.starts_with("mid.")) {
            found.push(alternative);
        }
    }
    found
}

/// An answer to a question that rules leave open: another value of a policy than the one in force, or a reading.
pub(crate) struct Answer {
    /// The rule in question.
    pub(crate) rule: &'static str,
    value: &'static str,
    policies: Policies,
    reading: Option<i64>,
}

impl Answer {
    /// Returns the rule and the value: `CMB-3=literal`.
    pub(crate) fn name(&self) -> String {
        format!("{}={}", self.rule, self.value)
    }

    /// Returns the `count` results of a row if this is the answer.
    pub(crate) fn evaluate(&self, unit: &dyn Unit, inputs: &[i64], profile: Profile, count: usize) -> Vec<i64> {
        let (mut inputs, mut results) = (inputs.to_vec(), vec![0; count]);
        inputs[0] = self.reading.unwrap_or(inputs[0]);
        unit.evaluate(&inputs, &Conditions { profile, policies: self.policies }, &mut results);
        results
    }
}

/// Returns every value of every policy that is not in force, and every reading of the unit.
pub(crate) fn answers(unit: &dyn Unit, force: &Policies) -> impl Iterator<Item = Answer> {
    let force = *force;
    let values = POLICIES.iter().flat_map(|policy| policy.values.iter().enumerate().map(move |value| (policy, value)));
    let others = values.filter_map(move |(Policy { rule, .. }, (index, (value, _)))| {
        let mut policies = force;
        let differs = policies.chosen(rule) != index;
        policies.choose(rule, index);
        differs.then_some(Answer { rule, value, policies, reading: None })
    });
    let rule = unit.rules()[0];
    let readings = (0..).zip(unit.readings());
    others.chain(readings.map(move |(n, value)| Answer { rule, value, policies: force, reading: Some(n) }))
}
