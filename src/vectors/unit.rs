//! What is tested: a unit of the chip as a function from integers to integers.

use std::ops::Range;

use super::Column;
use super::digest::Digesting;
use ninebit::state::{POLICIES, Policies, Policy, Profile, named};
use ninebit::trace::Recorder;

/// What holds besides a row's own numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Conditions {
    /// The chip whose rules apply.
    pub profile: Profile,
    /// Rules that have alternatives.
    pub policies: Policies,
}

/// A unit: columns that it reads, columns that it yields, and the function between them, which is the model's own.
pub trait Unit: Sync {
    /// Its name: lower case, words joined by `-`; also that of its files.
    fn name(&self) -> &'static str;

    /// What it does, in one line.
    fn about(&self) -> &'static str;

    /// The rules that it applies, by id.
    fn rules(&self) -> &'static [&'static str];

    /// The chips that have it.
    fn profiles(&self) -> &'static [Profile] {
        &[Profile::Nv10, Profile::Nv2a]
    }

    /// Configuration and inputs, `cfg.` and `in.`.
    fn inputs(&self) -> Vec<Column>;

    /// Intermediates and results, `mid.` and `out.`.
    fn results(&self) -> Vec<Column>;

    /// Computes the results of one row; both slices are as long as their columns.
    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]);

    /// Records the steps of one row, with the ideal beside the integers; none where the unit is a function without reports.
    fn trace(&self, _inputs: &[i64], _conditions: &Conditions, _recorder: &mut Recorder) {}

    /// Computes rows that follow each other at once, in block lanes, where the unit has a form of them: the same inputs but one, `varying`, which counts up
    /// from where it is. All of them go together. `out` has room for exactly those rows: the numbers of the `out.` columns, each in as many whole bytes
    /// as its bits need, low byte first.
    ///
    /// Returns how many rows have an output that is the least, and how many one that is the greatest, that the column's type holds; `None`: there is no such
    /// form of these rows. What it yields is what [`evaluate`](Self::evaluate) yields: tests and `ninebit vectors check` hold the two together.
    fn block(&self, _inputs: &[i64], _varying: usize, _conditions: &Conditions, _out: &mut [u8]) -> Option<[u64; 2]> {
        None
    }

    /// Computes rows of which only the input `varying` varies, over these places of its column, and hands on those whose inputs go together.
    ///
    /// No unit overrides this. A provided method is compiled for each unit, which saves a call through a table for every row.
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

    /// Whether the inputs make sense together on this chip. Of a unit with [`block`](Self::block), rows between two that do, and of which one input varies, do.
    fn accepts(&self, _inputs: &[i64], _profile: Profile) -> bool {
        true
    }

    /// Makes drawn inputs fit each other, where few would by chance.
    fn fit(&self, _inputs: &mut [i64]) {}

    /// Rows that are always there: examples of the handbook, what was once wrong.
    fn regressions(&self) -> Vec<Vec<i64>> {
        Vec::new()
    }

    /// How a frame buffer of eight bits shows the row.
    fn reach(&self, _inputs: &[i64], _results: &[i64]) -> Reach {
        Reach::Inside
    }
}

impl std::fmt::Debug for dyn Unit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

named! {
    /// How a draw can show what a row says.
    pub enum Reach =>
    /// The word in the table.
    word: &'static str {
        /// Operands as texels, constants or vertex colours, the result as it is stored.
        Direct => "direct",
        /// An operand is negative or above 255: a general stage before makes it.
        StageBefore => "stage-before",
        /// The result is negative: two draws, as it is and negated.
        TwoDraws => "two-draws",
        /// Both of these.
        StageBeforeTwoDraws => "stage-before+two-draws",
        /// Geometry shows it: which pixels are covered, or which texel is met.
        Geometry => "geometry",
        /// Nothing shows it by itself; units that use it do.
        Inside => "inside",
    }
}

impl Reach {
    /// Whether operands and result fit a frame buffer.
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

/// What a row would yield if a rule were read otherwise.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alternative {
    /// The rule and the value, `CMB-3=literal`.
    pub policy: String,
    /// The results, a number for each result column.
    pub results: Vec<i64>,
}

/// The policies that change an `out.` column of a row, one at a time.
///
/// `columns` are those of the results, which the caller has looked up once.
pub fn alternatives(
    unit: &dyn Unit,
    columns: &[Column],
    inputs: &[i64],
    profile: Profile,
    results: &[i64],
) -> Vec<Alternative> {
    let mut found = Vec::new();
    for (policy, value, policies) in other_policies() {
        let mut other = vec![0; results.len()];
        unit.evaluate(inputs, &Conditions { profile, policies }, &mut other);
        if columns.iter().zip(other.iter().zip(results)).any(|(c, (a, b))| a != b && c.name.starts_with("out.")) {
            found.push(Alternative { policy: format!("{}={value}", policy.rule), results: other });
        }
    }
    found
}

/// Every value of every policy that is not the default: the policy, the value, and all policies with it.
pub(crate) fn other_policies() -> impl Iterator<Item = (&'static Policy, &'static str, Policies)> {
    let values = POLICIES.iter().flat_map(|policy| policy.values.iter().enumerate().map(move |value| (policy, value)));
    values.filter_map(|(policy, (index, (value, _)))| {
        let mut policies = Policies::DEFAULT;
        let differs = policies.chosen(policy.rule) != index;
        policies.choose(policy.rule, index);
        differs.then_some((policy, *value, policies))
    })
}
