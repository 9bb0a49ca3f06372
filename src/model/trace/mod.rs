//! Observation: the pixel pipe reports each rule that it applies to whoever listens.
//!
//! A trace is not another code path. The functions of the pipe take an [`Observer`]; [`Silent`] makes the reports vanish, a recorder keeps
//! them. Each [`Step`] names the rule, what it computed from what, the integer, the real number that it stands for, and the ideal.

mod rule;

pub use crate::number::Part;
pub use rule::{Decision, Rule, Work};

use crate::number::Lane;

/// Receives the steps of a pixel.
///
/// There are two kinds of reports: [`step`](Observer::step) in words, for traces, and the others in passing, for measurements of whole
/// frames. What an observer does not want costs nothing.
pub trait Observer {
    /// Whether anybody listens; `false` lets the compiler drop the steps.
    const ON: bool;
    /// Whether rules, decisions and work are wanted; `false` lets the compiler drop them.
    const MEASURES: bool = false;
    /// Whether work is counted: then nothing is computed along that is not needed.
    const COUNTS: bool = false;
    /// One rule has been applied.
    fn step(&mut self, step: Step);
    /// The same; what it yielded, as an operand of later steps.
    fn tell(&mut self, step: Step) -> Operand {
        let Step { name, value, per_one, .. } = &step;
        let operand = Operand { name: name.clone(), value: *value, per_one: *per_one };
        self.step(step);
        operand
    }
    /// A rule has yielded a value; what is returned goes on in its place. It may differ in the ideal only.
    fn observe<L: Lane>(&mut self, _rule: Rule, value: L) -> L {
        value
    }
    /// A rule has yielded a factor.
    fn observe_factor<L: Lane>(&mut self, _rule: Rule, factor: L::Mapped) -> L::Mapped {
        factor
    }
    /// A rule has yielded a weight.
    fn observe_weight<L: Lane>(&mut self, _rule: Rule, weight: L::Weight) -> L::Weight {
        weight
    }
    /// A decision has been taken; `ideal` is what the ideal would have decided.
    fn decided(&mut self, _decision: Decision, _outcome: i64, _ideal: impl FnOnce() -> i64) {}
    /// A texel of a texture was looked up, at its place inside the image.
    fn fetched(&mut self, _texture: usize, _at: (u32, u32)) {}
    /// Work was done.
    fn count(&mut self, _work: Work, _amount: u64) {}
}

/// An observer that ignores everything, at no cost.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    const ON: bool = false;
    fn step(&mut self, _step: Step) {}
}

/// Keeps the steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recorder {
    /// In the order in which the rules were applied.
    pub steps: Vec<Step>,
}

impl Observer for Recorder {
    const ON: bool = true;
    fn step(&mut self, step: Step) {
        self.steps.push(step);
    }
}

/// The value of `per_one` for single-precision numbers, whose bit pattern the integer is (TSH-4).
pub const SINGLE: i64 = 0;

/// A named operand of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Operand {
    /// The name of an earlier step, or of something given.
    pub name: String,
    /// The operand as an integer.
    pub value: i64,
    /// How many make 1.0: 255 for registers and bytes, 256 for weights and texel coordinates, 1 for plain integers, [`SINGLE`] for floats.
    pub per_one: i64,
}

/// One application of a rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The hardware block.
    pub block: String,
    /// Rule id of `docs/numerics.md`; empty for what is merely given.
    pub rule: &'static str,
    /// What was computed. A later step of the same name supersedes it, as a register write does.
    pub name: String,
    /// How: a fixed vocabulary, listed in `docs/trace-format.md`.
    pub operation: &'static str,
    /// The operands, in the order of the operation.
    pub inputs: Vec<Operand>,
    /// The result as an integer.
    pub value: i64,
    /// How many make 1.0; [`SINGLE`]: the integer is the bit pattern of a single-precision number.
    pub per_one: i64,
    /// The float64 ideal in the unit of the real value.
    pub ideal: Option<f64>,
    /// A remark for the reader: a tie, a saturation, an undefined value.
    pub note: Option<String>,
    /// Of a word that was read from a texture: where it lies.
    pub texel: Option<TexelAddress>,
}

/// Where a texel lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexelAddress {
    /// Number of the texture in the scene.
    pub texture: usize,
    /// The face of a cube map, 0 to 5 for +X, -X, +Y, -Y, +Z, -Z; 0 of others.
    pub face: usize,
    /// The level, 0 the largest.
    pub level: usize,
    /// Column and row on the level.
    pub at: [i64; 2],
}

impl Step {
    /// A plain integer (per one: 1) without operands.
    pub fn given(block: &str, rule: &'static str, name: impl Into<String>, value: impl Into<i64>) -> Step {
        Step {
            block: block.to_string(),
            rule,
            name: name.into(),
            operation: "given",
            inputs: Vec::new(),
            value: value.into(),
            per_one: 1,
            ideal: None,
            note: None,
            texel: None,
        }
    }

    /// Changes the operation and its operands.
    #[must_use]
    pub fn by(mut self, operation: &'static str, inputs: Vec<Operand>) -> Step {
        self.operation = operation;
        self.inputs = inputs;
        self
    }

    /// Changes the unit.
    #[must_use]
    pub fn per(mut self, per_one: i64) -> Step {
        self.per_one = per_one;
        self
    }

    /// Sets the ideal, a number in steps of this step's unit.
    #[must_use]
    #[allow(clippy::float_arithmetic, reason = "display of the ideal")]
    pub fn ideal(mut self, ideal: impl Into<Option<f64>>) -> Step {
        self.ideal = ideal.into().map(|i| i / self.per_one as f64);
        self
    }

    /// Sets the remark, if there is one.
    #[must_use]
    pub fn note(mut self, note: impl Into<Option<String>>) -> Step {
        self.note = note.into();
        self
    }

    /// Sets the place of the word.
    #[must_use]
    pub fn at(mut self, texel: Option<TexelAddress>) -> Step {
        self.texel = texel;
        self
    }

    /// The real number that the integer stands for.
    #[allow(clippy::float_arithmetic, reason = "display of the real value")]
    pub fn real(&self) -> f64 {
        if self.per_one == SINGLE {
            return f64::from(f32::from_bits(self.value as u32));
        }
        self.value as f64 / self.per_one as f64
    }
}

/// A step that yields a single-precision number.
pub fn float_step(block: &str, rule: &'static str, name: impl Into<String>, value: f32, ideal: f64) -> Step {
    let Operand { value, per_one, .. } = float("", value);
    Step { per_one, ideal: Some(ideal), ..Step::given(block, rule, name, value) }
}

/// A single-precision operand. All NaN count as one.
pub fn float(name: impl Into<String>, value: f32) -> Operand {
    let value = if value.is_nan() { f32::NAN } else { value };
    Operand { name: name.into(), value: i64::from(value.to_bits()), per_one: SINGLE }
}

/// A plain integer operand.
pub fn plain(name: impl Into<String>, value: impl Into<i64>) -> Operand {
    Operand { name: name.into(), value: value.into(), per_one: 1 }
}

/// An operand in steps of 1/255.
pub fn byte(name: impl Into<String>, value: impl Into<i64>) -> Operand {
    Operand { name: name.into(), value: value.into(), per_one: 255 }
}

/// An operand in 256ths.
pub fn part(name: impl Into<String>, value: impl Into<i64>) -> Operand {
    Operand { name: name.into(), value: value.into(), per_one: 256 }
}

/// Reports for values of a lane: the integer and the ideal in the unit that shows no fraction.
pub mod report {
    use super::{Operand, Step};
    use crate::number::Lane;

    /// A register or byte as an operand.
    pub fn register<L: Lane>(name: impl Into<String>, value: L) -> Operand {
        super::byte(name, value.observe().0)
    }

    /// A factor as an operand: in 255ths, or in 510ths where a half bit is kept.
    pub fn factor<L: Lane>(name: impl Into<String>, value: L::Mapped) -> Operand {
        let (value, per_one) = whole(L::observe_factor(value).0, 2, 255);
        Operand { name: name.into(), value, per_one }
    }

    /// A sum as an operand: in 65025ths, or finer where half bits are kept.
    pub fn sum<L: Lane>(name: impl Into<String>, value: L::Full) -> Operand {
        let (value, per_one) = whole(L::observe_sum(value).0, 4, 65025);
        Operand { name: name.into(), value, per_one }
    }

    /// A step that yields a register or byte.
    pub fn register_step<L: Lane>(block: &str, rule: &'static str, name: impl Into<String>, value: L) -> Step {
        let (value, ideal) = value.observe();
        Step::given(block, rule, name, value).per(255).ideal(ideal)
    }

    /// A step that yields a factor.
    pub fn factor_step<L: Lane>(block: &str, rule: &'static str, name: impl Into<String>, value: L::Mapped) -> Step {
        let (fixed, ideal) = L::observe_factor(value);
        let (value, per_one) = whole(fixed, 2, 255);
        // The ideal is counted in 255ths whatever the step's own unit.
        let mut step = Step::given(block, rule, name, value).per(255).ideal(ideal);
        step.per_one = per_one;
        step
    }

    /// A step that yields a sum.
    pub fn sum_step<L: Lane>(block: &str, rule: &'static str, name: impl Into<String>, value: L::Full) -> Step {
        let (fixed, ideal) = L::observe_sum(value);
        let (value, per_one) = whole(fixed, 4, 65025);
        let mut step = Step::given(block, rule, name, value).per(65025).ideal(ideal);
        step.per_one = per_one;
        step
    }

    /// Takes a fraction out of a value where it is whole.
    fn whole(value: i64, fraction: i64, per_one: i64) -> (i64, i64) {
        if value % fraction == 0 { (value / fraction, per_one) } else { (value, per_one * fraction) }
    }
}
