//! Turns sources into inputs of a portion: which mapping reads x, and which reads -x.

use super::constants::Pool;
use super::lower::Lowering;
use super::scratch::hardware;
use super::{Bank, Modifier, Selector, Source};
use ninebit::state::{CombinerInput, Component, InputMapping, Register};

/// What an earlier stage has to do so that an instruction fits one stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Preparation {
    /// Clamp a register to 0..1: its `_sat` was left to its readers, and this one reads the negative.
    Limit(Register),
    /// Load a constant that no single input can read into a register.
    Constant(u8),
    /// Compute the first source of `lrp`.
    Factor(usize),
    /// Copy the blue of a register to its alpha, since a dot product is there on NV10.
    Alpha(Register),
    /// No stage can prepare it.
    Refused,
}

/// The part of a constant that is read: all of it, or only its positive or its negative channels, with 0 in the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Whole,
    Positive,
    Negative,
}

/// A factor of a product: x, or -x if `negate`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Factor {
    /// Input that reads x.
    input: CombinerInput,
    /// Mapping that reads -x, if there is one.
    negated: Option<InputMapping>,
    negate: bool,
    /// Whether x is at least 0.
    positive: bool,
    /// Register that has to be clamped before -x can be read.
    limit: Option<Register>,
}

impl Factor {
    fn new(register: Register, component: Component, [mapping, negated]: [InputMapping; 2]) -> Factor {
        let input = CombinerInput { register, component, mapping };
        Factor { input, negated: Some(negated), negate: false, positive: false, limit: None }
    }

    /// Makes a factor that is never negative and whose negative no mapping reads.
    pub(super) fn unsigned(register: Register, component: Component, mapping: InputMapping) -> Factor {
        Factor { negated: None, positive: true, ..Factor::new(register, component, [mapping; 2]) }
    }

    /// Makes the factor 1.
    pub(super) fn one(alpha: bool) -> Factor {
        let component = if alpha { Component::Alpha } else { Component::Rgb };
        let mappings = [InputMapping::UnsignedInvert, InputMapping::ExpandNormal];
        Factor { positive: true, ..Factor::new(Register::Zero, component, mappings) }
    }

    /// Returns the factor with the other sign.
    pub(super) fn minus(self) -> Factor {
        Factor { negate: !self.negate, ..self }
    }

    /// Returns the factor 1 - x, of a factor that an unsigned mapping reads.
    pub(super) fn complement(self) -> Factor {
        let mapping = match self.input.mapping {
            InputMapping::UnsignedInvert => InputMapping::UnsignedIdentity,
            _ => InputMapping::UnsignedInvert,
        };
        Factor { input: CombinerInput { mapping, ..self.input }, ..self }
    }
}

/// Returns the two inputs of a product, and whether the product is at least 0.
pub(super) fn product(a: Factor, b: Factor) -> Result<([CombinerInput; 2], bool), Preparation> {
    if a.negate == b.negate {
        return Ok(([a.input, b.input], a.positive && b.positive));
    }
    // A minus sign goes to the factor that has it, if its mappings allow that; to the factor 1 last, whose negative is inexact in integers.
    let order = |factor: &Factor| match factor.negated {
        None => None,
        Some(_) if factor.negate => Some(0),
        Some(_) if factor.input.register != Register::Zero => Some(1),
        Some(_) => Some(2),
    };
    let negative =
        |factor: Factor| CombinerInput { mapping: factor.negated.unwrap_or(factor.input.mapping), ..factor.input };
    match (order(&a), order(&b)) {
        (Some(first), second) if second.is_none_or(|second| first <= second) => Ok(([negative(a), b.input], false)),
        (_, Some(_)) => Ok(([a.input, negative(b)], false)),
        _ => Err(a.limit.or(b.limit).map_or(Preparation::Refused, Preparation::Limit)),
    }
}

impl Lowering {
    /// Returns the factor that reads a source in a portion. If `unsigned`, the source is a weight: max(0, x).
    pub(super) fn factor(
        &self,
        source: &Source,
        alpha: bool,
        unsigned: bool,
        part: Part,
        pool: &mut Pool,
    ) -> Result<Factor, Preparation> {
        let component = match (source.selector, alpha) {
            (Selector::Alpha, _) | (Selector::All, true) => Component::Alpha,
            (Selector::Blue, true) => Component::Blue,
            (Selector::All | Selector::Blue, false) => Component::Rgb,
        };
        let factor = match hardware(source.register).or(self.held_constant(source.register)) {
            Some(register) => self.of_register(register, component, alpha, source.modifier, unsigned),
            None => self.of_constant(source, component, alpha, unsigned, part, pool)?,
        };
        Ok(if source.negate { factor.minus() } else { factor })
    }

    fn of_register(
        &self,
        register: Register,
        component: Component,
        alpha: bool,
        modifier: Modifier,
        unsigned: bool,
    ) -> Factor {
        let value = self.value(register);
        let half = value.halves[usize::from(component == Component::Alpha)];
        let component = match (component, alpha) {
            (Component::Alpha, true) if value.alpha_is_blue => Component::Blue,
            // The three colour channels of a dot product are equal.
            (Component::Alpha, false) if value.alpha_is_blue => Component::Rgb,
            (component, _) => component,
        };
        let limit = half.limit.then_some(register);
        match modifier {
            Modifier::Plain if unsigned || half.limit => {
                let factor = Factor::unsigned(register, component, InputMapping::UnsignedIdentity);
                Factor { limit, ..factor }
            }
            Modifier::Plain => Factor { positive: !half.negative, ..modified(register, component, modifier) },
            _ => modified(register, component, modifier),
        }
    }

    fn of_constant(
        &self,
        source: &Source,
        component: Component,
        alpha: bool,
        unsigned: bool,
        part: Part,
        pool: &mut Pool,
    ) -> Result<Factor, Preparation> {
        let index = source.register.index;
        let [r, g, b, a] = self.constants.get(usize::from(index)).copied().unwrap_or_default();
        let channels: &[i16] = match component {
            Component::Rgb => &[r, g, b],
            Component::Blue => &[b],
            Component::Alpha => &[a],
        };
        // Every mapping but the signed ones takes max(0, x).
        let signed = source.modifier == Modifier::Plain && !unsigned;
        let negative = match part {
            Part::Whole => signed && channels.iter().all(|c| *c <= 0) && channels.iter().any(|c| *c < 0),
            Part::Positive => false,
            Part::Negative => true,
        };
        if part == Part::Whole && signed && !negative && channels.iter().any(|c| *c < 0) {
            return Err(Preparation::Constant(index));
        }
        let byte = |c: i16| if negative { -c } else { c }.clamp(0, 255) as u8;
        let found = match (component, alpha) {
            (Component::Rgb, _) => pool.color([r, g, b].map(byte)),
            (Component::Blue, _) => pool.alpha(byte(b)),
            (Component::Alpha, true) => pool.alpha(byte(a)),
            (Component::Alpha, false) => pool.scalar(byte(a)),
        };
        let (register, component) = found.ok_or(Preparation::Constant(index))?;
        let factor = match source.modifier {
            Modifier::Plain if unsigned => Factor::unsigned(register, component, InputMapping::UnsignedIdentity),
            modifier @ Modifier::Plain => Factor { positive: true, ..modified(register, component, modifier) },
            modifier => modified(register, component, modifier),
        };
        Ok(if negative { factor.minus() } else { factor })
    }

    /// Returns whether a source is a constant that no single input can read, because it has channels of both signs.
    pub(super) fn is_mixed(&self, source: &Source, alpha: bool) -> bool {
        let held = source.register.bank != Bank::Constant || self.held_constant(source.register).is_some();
        let plain = source.modifier == Modifier::Plain && source.selector == Selector::All;
        if held || alpha || !plain {
            return false;
        }
        let constant = self.constants.get(usize::from(source.register.index)).copied().unwrap_or_default();
        constant[..3].iter().any(|c| *c < 0) && constant[..3].iter().any(|c| *c > 0)
    }
}

fn modified(register: Register, component: Component, modifier: Modifier) -> Factor {
    let mappings = match modifier {
        Modifier::Bias => [InputMapping::HalfBiasNormal, InputMapping::HalfBiasNegate],
        Modifier::SignedScale => [InputMapping::ExpandNormal, InputMapping::ExpandNegate],
        Modifier::Invert => return Factor::unsigned(register, component, InputMapping::UnsignedInvert),
        Modifier::Plain => [InputMapping::SignedIdentity, InputMapping::SignedNegate],
    };
    Factor::new(register, component, mappings)
}
