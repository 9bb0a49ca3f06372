//! Observation: the pixel pipe reports each rule that it applies to an observer.
//!
//! A trace is not a separate code path. The functions of the pipe take an [`Observer`]; with [`Silent`] the reports are
//! compiled away, and a recorder keeps them. Each [`Step`] names the rule, the operation and its inputs, the resulting
//! integer, the real number that it stands for, and the ideal.

mod rule;

pub use crate::number::Part;
pub use rule::{Decision, Rule, Work};

use crate::number::Lane;
use crate::state::SurfaceFormat;

/// Receives reports about a pixel.
///
/// There are two kinds of reports: [`step`](Observer::step) describes a step in words, for traces, and the other
/// methods are cheap, for measurements of whole frames. Reports that an observer does not want cost nothing.
pub trait Observer {
    /// Whether steps are wanted. If `false`, the compiler drops them.
    const ON: bool;
    /// Whether rules, decisions and work are wanted. If `false`, the compiler drops them.
    const MEASURES: bool = false;
    /// Whether work is counted. The pipe then computes nothing that is not needed.
    const COUNTS: bool = false;
    /// Returns whether some step is wanted whose name begins with these parts, joined. Groups of steps ask before they are described.
    fn wants(&self, _parts: &[&str]) -> bool {
        Self::ON
    }
    /// Returns whether some step is wanted whose name begins with one of these.
    fn wants_any(&self, beginnings: &[&str]) -> bool {
        beginnings.iter().any(|beginning| self.wants(&[beginning]))
    }
    /// Receives the application of a rule.
    fn step(&mut self, step: Step);
    /// Like [`step`](Self::step), but returns the result as an operand of later steps.
    fn tell(&mut self, step: Step) -> Operand {
        let Step { name, value, per_one, exponent, .. } = &step;
        let operand = Operand { name: name.clone(), value: *value, per_one: *per_one, exponent: *exponent };
        self.step(step);
        operand
    }
    /// Receives a value that a rule has yielded, and returns the value to continue with. It may only differ in the
    /// ideal.
    fn observe<L: Lane>(&mut self, _rule: Rule, value: L) -> L {
        value
    }
    /// Like [`observe`](Self::observe), for a factor.
    fn observe_factor<L: Lane>(&mut self, _rule: Rule, factor: L::Mapped) -> L::Mapped {
        factor
    }
    /// Like [`observe`](Self::observe), for a weight.
    fn observe_weight<L: Lane>(&mut self, _rule: Rule, weight: L::Weight) -> L::Weight {
        weight
    }
    /// Receives the depth that a test compares, of a buffer whose largest is given. Returns the depth to continue with.
    fn observe_depth(&mut self, word: u32, _largest: u32, _ideal: impl FnOnce() -> f64) -> u32 {
        word
    }
    /// Receives the alpha that a test compares. Returns it in 65536ths if it is not to be rounded.
    fn observe_alpha<L: Lane>(&mut self, _alpha: L) -> Option<i64> {
        None
    }
    /// Receives R, G, B, A as a surface is about to store them. Returns what it stores.
    fn observe_store(&mut self, _format: SurfaceFormat, bytes: [u8; 4]) -> [u8; 4] {
        bytes
    }
    /// Receives a decision. `ideal` returns what the ideal would have decided.
    fn decided(&mut self, _decision: Decision, _outcome: i64, _ideal: impl FnOnce() -> i64) {}
    /// Receives the lookup of a texel, at its place inside the image.
    fn fetched(&mut self, _texture: usize, _at: (u32, u32)) {}
    /// Receives an amount of work that was done.
    fn count(&mut self, _work: Work, _amount: u64) {}
}

/// An observer that ignores everything, at no cost.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    const ON: bool = false;
    fn step(&mut self, _step: Step) {}
}

/// An observer that keeps all steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recorder {
    /// The steps, in the order in which the rules were applied.
    pub steps: Vec<Step>,
}

impl Observer for Recorder {
    const ON: bool = true;
    fn step(&mut self, step: Step) {
        self.steps.push(step);
    }
}

/// The value of `per_one` for single-precision numbers, whose integer is their bit pattern (TSH-4).
pub const SINGLE: i64 = 0;

/// The unit of an integer: the number is value 2^`exponent` / `per_one`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// The integer that stands for 1.0, or [`SINGLE`] for the bits of a single-precision number.
    pub per_one: i64,
    /// Power of two that the integer is multiplied by.
    pub exponent: i32,
}

impl Unit {
    /// Returns the real number that an integer stands for.
    #[allow(clippy::float_arithmetic, reason = "display of the real value")]
    pub fn real(self, value: i64) -> f64 {
        if self.per_one == SINGLE {
            return f64::from(f32::from_bits(value as u32));
        }
        value as f64 * f64::from_bits(((1023 + i64::from(self.exponent)) as u64) << 52) / self.per_one as f64
    }
}

/// A named operand of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Operand {
    /// The name of an earlier step, or of a given value.
    pub name: String,
    /// The operand as an integer.
    pub value: i64,
    /// The integer that stands for 1.0: 255 for registers and bytes, 256 for weights and texel coordinates, 1 for plain
    /// integers, [`SINGLE`] for floats.
    pub per_one: i64,
    /// Power of two that the integer is multiplied by; 0 but for numbers of WGT-1.
    pub exponent: i32,
}

/// One application of a rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The hardware block.
    pub block: String,
    /// Rule id of `docs/rules`. Empty for a value that is merely given.
    pub rule: &'static str,
    /// Name of the result. A later step of the same name supersedes it, as a register write does.
    pub name: String,
    /// The operation, from a fixed vocabulary that `docs/trace-format.md` lists.
    pub operation: &'static str,
    /// The operands, in the order that the operation defines.
    pub inputs: Vec<Operand>,
    /// The result as an integer.
    pub value: i64,
    /// The integer that stands for 1.0, or [`SINGLE`] if the integer is the bit pattern of a single-precision number.
    pub per_one: i64,
    /// Power of two that the integer is multiplied by; 0 but for numbers of WGT-1.
    pub exponent: i32,
    /// The float64 ideal, in the unit of [`real`](Self::real).
    pub ideal: Option<f64>,
    /// A remark for the reader, such as a tie, a saturation, or an undefined value.
    pub note: Option<String>,
    /// The address, if the value is a word that was read from a texture.
    pub texel: Option<TexelAddress>,
}

/// The address of a texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexelAddress {
    /// Index of the texture in the scene.
    pub texture: usize,
    /// Face of a cube map, 0 to 5 for +X, -X, +Y, -Y, +Z, -Z, or layer of a volume. 0 for other kinds.
    pub face: usize,
    /// The level. 0 is the largest.
    pub level: usize,
    /// Column and row on the level.
    pub at: [i64; 2],
}

impl Step {
    /// Creates a step whose value is a plain integer, with `per_one` 1 and without operands.
    pub fn plain(block: &str, rule: &'static str, name: impl Into<String>, value: impl Into<i64>) -> Step {
        Step {
            block: block.to_string(),
            rule,
            name: name.into(),
            operation: "given",
            inputs: Vec::new(),
            value: value.into(),
            per_one: 1,
            exponent: 0,
            ideal: None,
            note: None,
            texel: None,
        }
    }

    /// Sets the operation and its operands.
    #[must_use]
    pub fn by(mut self, operation: &'static str, inputs: Vec<Operand>) -> Step {
        self.operation = operation;
        self.inputs = inputs;
        self
    }

    /// Sets the integer that stands for 1.0.
    #[must_use]
    pub fn per(mut self, per_one: i64) -> Step {
        self.per_one = per_one;
        self
    }

    /// Sets the ideal, given in units of the step's integer.
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

    /// Sets the address of the word.
    #[must_use]
    pub(crate) fn at(mut self, texel: Option<TexelAddress>) -> Step {
        self.texel = texel;
        self
    }

    /// Returns the real number that the integer stands for.
    pub fn real(&self) -> f64 {
        self.unit().real(self.value)
    }

    /// Returns the unit of the integer.
    pub fn unit(&self) -> Unit {
        Unit { per_one: self.per_one, exponent: self.exponent }
    }
}

/// Returns a step that yields a single-precision number.
pub(crate) fn float_step(block: &str, rule: &'static str, name: impl Into<String>, value: f32, ideal: f64) -> Step {
    let Operand { value, per_one, .. } = float("", value);
    Step { per_one, ideal: Some(ideal), ..Step::plain(block, rule, name, value) }
}

/// Returns a single-precision operand. All NaNs become the same one.
pub(crate) fn float(name: impl Into<String>, value: f32) -> Operand {
    let value = if value.is_nan() { f32::NAN } else { value };
    Operand { name: name.into(), value: i64::from(value.to_bits()), per_one: SINGLE, exponent: 0 }
}

/// Returns a plain integer operand.
pub fn plain(name: impl Into<String>, value: impl Into<i64>) -> Operand {
    Operand { name: name.into(), value: value.into(), per_one: 1, exponent: 0 }
}

/// Returns an operand in steps of 1/255.
pub(crate) fn byte(name: impl Into<String>, value: impl Into<i64>) -> Operand {
    Operand { name: name.into(), value: value.into(), per_one: 255, exponent: 0 }
}

/// Returns an operand in 256ths.
pub(crate) fn part(name: impl Into<String>, value: impl Into<i64>) -> Operand {
    Operand { name: name.into(), value: value.into(), per_one: 256, exponent: 0 }
}

/// Reports of values of a lane: the integer and the ideal, in a unit in which the integer has no fraction.
pub mod report {
    use super::{Operand, Step};
    use crate::number::Lane;

    /// Returns a register or byte as an operand.
    pub(crate) fn register<L: Lane>(name: impl Into<String>, value: L) -> Operand {
        super::byte(name, value.observe().0)
    }

    /// Returns a factor as an operand, in 255ths, or in 510ths if it has a half bit.
    pub(crate) fn factor<L: Lane>(name: impl Into<String>, value: L::Mapped) -> Operand {
        let (value, per_one) = whole(L::observe_factor(value).0, 2, 255);
        Operand { name: name.into(), value, per_one, exponent: 0 }
    }

    /// Returns a sum as an operand, in 65025ths, or in a finer unit if half bits are kept.
    pub(crate) fn sum<L: Lane>(name: impl Into<String>, value: L::Full) -> Operand {
        let (value, per_one) = whole(L::observe_sum(value).0, 4, 65025);
        Operand { name: name.into(), value, per_one, exponent: 0 }
    }

    /// Returns a step that yields a register or byte.
    pub fn register_step<L: Lane>(block: &str, rule: &'static str, name: impl Into<String>, value: L) -> Step {
        let (value, ideal) = value.observe();
        Step::plain(block, rule, name, value).per(255).ideal(ideal)
    }

    /// Returns a step that yields a factor.
    pub(crate) fn factor_step<L: Lane>(block: &str, rule: &'static str, name: impl Into<String>, v: L::Mapped) -> Step {
        let (fixed, ideal) = L::observe_factor(v);
        let (value, per_one) = whole(fixed, 2, 255);
        // The ideal is in 255ths, whatever the unit of the step.
        Step { per_one, ..Step::plain(block, rule, name, value).per(255).ideal(ideal) }
    }

    /// Returns a step that yields a sum.
    pub(crate) fn sum_step<L: Lane>(block: &str, rule: &'static str, name: impl Into<String>, value: L::Full) -> Step {
        let (fixed, ideal) = L::observe_sum(value);
        let (value, per_one) = whole(fixed, 4, 65025);
        Step { per_one, ..Step::plain(block, rule, name, value).per(65025).ideal(ideal) }
    }

    /// Removes a fraction from the unit if the value is a multiple of it.
    fn whole(value: i64, fraction: i64, per_one: i64) -> (i64, i64) {
        if value % fraction == 0 { (value / fraction, per_one) } else { (value, per_one * fraction) }
    }
}
