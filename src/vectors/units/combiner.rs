//! The parts of a general combiner stage, one channel at a time.

use super::{Column, Conditions, Kind, Reach, Unit, block, named, scale_takes_bias};
use ninebit::algebra::Algebra;
use ninebit::combiner::direct::Direct;
use ninebit::combiner::{general, mapping, output};
use ninebit::number::{Factor, Lane};
use ninebit::state::{self, Bias, Component, MuxSelect, Portion, Scale};
use ninebit::trace::{Observer, Rule, Silent, Step};

/// Kind of a sum of products in tables: in 1/65025.
const WIDE: Kind = Kind::Signed(19);

/// Returns a factor in steps of 1/255 as the combiner represents it.
fn factor(value: i64) -> <i32 as Lane>::Mapped {
    ninebit::number::Register::factor(value as i32)
}

/// Returns a full-width sum in 1/65025. It is whole, because no input has half a step.
fn wide(sum: <i32 as Lane>::Full) -> i64 {
    i32::observe_sum(sum).0 / 4
}

/// Rounds and saturates a sum without bias and scale.
fn written(raw: <i32 as Lane>::Full, conditions: &Conditions) -> i64 {
    let rounded: i32 = ninebit::number::Sum::rounded(raw);
    ninebit::number::Register::saturated(rounded, conditions.policies.register_floor).into()
}

/// A register through a mapping.
pub(super) struct InputMapping;

impl Unit for InputMapping {
    known_as!(
        "input-mapping", &["CMB-2", "CMB-3", "CMB-4", "CMB-5"],
        "a register through one of the eight input mappings becomes a factor";
        takes [Column::choice::<state::InputMapping>("cfg.mapping"), Column::register("in.x")];
        gives [Column::result("out.factor", Kind::Halves(11))]
    );

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let [mapped] = mapping::map([inputs[1] as i32], named(inputs[0]), &conditions.policies);
        results[0] = i32::observe_factor(mapped).0;
    }

    fn reach(&self, inputs: &[i64], results: &[i64]) -> Reach {
        Reach::from_values(&inputs[1..], &[results[0] / 2])
    }
}

/// The product of A and B, or of C and D (CMB-6).
pub(super) struct Product;

impl Unit for Product {
    known_as!(
        "product", &["CMB-6", "NUM-2", "NUM-3"],
        "AB: the product of two factors, rounded to the nearest 255th, saturated"; shows .. => 1..;
        takes [Column::factor("in.a"), Column::factor("in.b")];
        gives [Column::result("mid.product", WIDE), Column::result("out.ab", Kind::Signed(9))]
    );

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let raw = factor(inputs[0]).product(factor(inputs[1]));
        results[0] = wide(raw);
        results[1] = written(raw, conditions);
    }

    fn block(&self, inputs: &[i64], varying: usize, _: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
        // The order of factors does not matter.
        Some(block::multiply_add(0, inputs[1 - varying] as i16, inputs[varying] as i16, out.as_chunks_mut().0))
    }

    fn regressions(&self) -> Vec<Vec<i64>> {
        vec![vec![100, 200], vec![-256, 256], vec![-256, -256]]
    }
}

/// A B + C D.
pub(super) struct Sum;

impl Unit for Sum {
    known_as!(
        "sum", &["CMB-7", "NUM-2", "NUM-3"],
        "AB + CD: the sum of two products at full width, rounded once, saturated"; shows .. => 3..;
        takes [["in.a", "in.b", "in.c", "in.d"].map(Column::factor)];
        gives [Column::results(["mid.ab", "mid.cd", "mid.sum"], WIDE), Column::result("out.sum", Kind::Signed(9))]
    );

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let mut silent = Silent;
        let mut direct = Direct::<i32, _>::new(&conditions.policies, &mut silent);
        let [ab, cd] = [[0, 1], [2, 3]].map(|[a, b]| direct.product(Rule::Cmb6, factor(inputs[a]), factor(inputs[b])));
        let sum = general::sum(ab, cd, &mut direct);
        let [ab, cd, sum] = [ab, cd, sum].map(|sum| sum.sum);
        results[..3].copy_from_slice(&[ab, cd, sum].map(wide));
        results[3] = written(sum, conditions);
    }

    fn block(&self, inputs: &[i64], varying: usize, _: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
        // The order of products does not matter.
        let [first, other, a, b] = [varying, varying ^ 1, varying ^ 2, varying ^ 3].map(|n| inputs[n] as i16);
        Some(block::multiply_add(Factor::product(a, b), other, first, out.as_chunks_mut().0))
    }
}

/// A . B.
pub(super) struct DotProduct;

impl Unit for DotProduct {
    known_as!(
        "dot-product", &["CMB-8", "NUM-2", "NUM-3"],
        "A . B: the sum of three products at full width, rounded once, saturated"; shows .. => 1..;
        takes [["in.a.r", "in.a.g", "in.a.b", "in.b.r", "in.b.g", "in.b.b"].map(Column::factor)];
        gives [Column::result("mid.sum", Kind::Signed(20)), Column::result("out.dot", Kind::Signed(9))]
    );

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let [a, b] = [0, 3].map(|first| [0, 1, 2].map(|n| factor(inputs[first + n])));
        let raw = general::dot(a, b, &mut Direct::<i32, _>::new(&conditions.policies, &mut Silent)).sum;
        results[0] = wide(raw);
        results[1] = written(raw, conditions);
    }
}

/// The mux: AB or CD, by the alpha of SPARE0.
pub(super) struct Mux;

impl Unit for Mux {
    known_as!(
        "mux", &["CMB-10"], "whether the mux takes CD, by the most or the least significant bit of SPARE0.a"; shows 1.. => 1..;
        takes [Column::choice::<MuxSelect>("cfg.select"), Column::register("in.spare0.a")];
        gives [Column::result("out.takes_cd", Kind::Unsigned(1))]
    );

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        results[0] = output::mux_takes_cd(inputs[1] as i32, named(inputs[0]), &conditions.policies).into();
    }
}

/// Rounding, bias, scale and saturation of an output.
pub(super) struct ScaleBias;

impl Unit for ScaleBias {
    known_as!(
        "scale-bias", &["CMB-9", "NUM-2", "NUM-3"],
        "AB through the output of a portion: rounded to the nearest 255th, biased, scaled, saturated"; shows 2.. => 3..;
        takes [Column::choice::<Scale>("cfg.scale"), Column::choice::<Bias>("cfg.bias"), ["in.a", "in.b"].map(Column::factor)];
        gives [
            Column::result("mid.product", WIDE),
            Column::result("mid.rounded", Kind::Signed(10)),
            Column::result("mid.scaled", Kind::Signed(12)),
            Column::result("out.value", Kind::Signed(9)),
        ]
    );

    fn accepts(&self, inputs: &[i64], _: state::Profile) -> bool {
        scale_takes_bias(inputs[0], inputs[1])
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let mut portion = Portion::idle(Component::Rgb);
        (portion.scale, portion.bias) = (named(inputs[0]), named(inputs[1]));
        let mut tap = Tap::default();
        let mut direct = Direct::<i32, _>::new(&conditions.policies, &mut tap);
        let raw = direct.product(Rule::Cmb6, factor(inputs[2]), factor(inputs[3]));
        let value = general::output(&portion, raw, &mut direct);
        results.copy_from_slice(&[
            wide(raw.sum),
            tap.last_result(Rule::Cmb6),
            tap.last_result(Rule::Cmb9),
            value.into(),
        ]);
    }
}

/// An observer that keeps the results of rules.
#[derive(Debug, Default)]
struct Tap {
    observed: Vec<(Rule, i64)>,
}

impl Tap {
    /// Returns the last result of a rule, or 0 if it was not applied.
    fn last_result(&self, rule: Rule) -> i64 {
        self.observed.iter().rev().find(|(observed, _)| *observed == rule).map_or(0, |(_, value)| *value)
    }
}

impl Observer for Tap {
    const ON: bool = false;
    const MEASURES: bool = true;

    fn step(&mut self, _: Step) {}

    fn observe<L: Lane>(&mut self, rule: Rule, value: L) -> L {
        self.observed.push((rule, value.observe().0));
        value
    }
}
