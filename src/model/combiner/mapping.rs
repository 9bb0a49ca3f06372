//! CMB-2 to CMB-5: input mappings.

use crate::number::{Lane, Register};
use crate::state::{ExpandCentre, HalfBiasConstant, InputMapping, Policies};
use crate::trace::Rule;

/// CMB-2: returns max(0, x).
#[inline(always)]
pub fn unsigned_identity<R: Register>(x: R) -> R {
    x.max0()
}

/// CMB-2: returns 255 - max(0, x).
#[inline(always)]
pub fn unsigned_invert<R: Register>(x: R) -> R {
    R::ONE - x.max0()
}

/// CMB-3: returns 2 (max(0, x) - 128).
#[inline(always)]
pub fn expand_normal<R: Register>(x: R) -> R::Expanded {
    (x.max0() - R::HALF).twice()
}

/// Applies any mapping under any policy to several channels.
#[inline(always)]
pub fn map<L: Lane, const N: usize>(x: [L; N], mapping: InputMapping, policies: &Policies) -> [L::Mapped; N] {
    match mapping {
        InputMapping::UnsignedIdentity => each(x, |x| unsigned_identity(x).factor()),
        InputMapping::UnsignedInvert => each(x, |x| unsigned_invert(x).factor()),
        InputMapping::ExpandNormal => each(x, |x| expand(x, policies)),
        InputMapping::ExpandNegate => each(x, |x| L::negated(expand(x, policies))),
        InputMapping::HalfBiasNormal => each(x, |x| half_bias(x.max0(), L::HALF, policies)),
        InputMapping::HalfBiasNegate => each(x, |x| L::negated(half_bias(x.max0(), L::HALF, policies))),
        InputMapping::SignedIdentity => each(x, L::factor),
        InputMapping::SignedNegate => each(x, |x| L::negated(x.factor())),
    }
}

/// Applies a function to several channels. A loop, because functions passed to those of arrays are not always inlined.
#[inline(always)]
fn each<L: Lane, const N: usize>(x: [L; N], map: impl Fn(L) -> L::Mapped) -> [L::Mapped; N] {
    let mut all = [L::ZERO.factor(); N];
    for n in 0..N {
        all[n] = map(x[n]);
    }
    all
}

/// Applies any mapping under any policy to one channel.
#[inline(always)]
pub(crate) fn map_one<L: Lane>(x: L, mapping: InputMapping, policies: &Policies) -> L::Mapped {
    let [mapped] = map([x], mapping, policies);
    mapped
}

/// CMB-3 with its alternative, in which 2x - 255 is (x - 128) + (x - 127).
#[inline(always)]
fn expand<L: Lane>(x: L, policies: &Policies) -> L::Mapped {
    match policies.expand_centre {
        ExpandCentre::Centred => expand_normal(x),
        ExpandCentre::Literal => {
            let low = x.max0() - L::HALF;
            (low + low + L::STEP).factor()
        }
    }
}

/// CMB-4 with its alternatives.
#[inline(always)]
fn half_bias<L: Lane>(x: L, half: L, policies: &Policies) -> L::Mapped {
    match policies.half_bias {
        HalfBiasConstant::Half128 => (x - half).factor(),
        HalfBiasConstant::Half127 => (x - half + L::STEP).factor(),
        HalfBiasConstant::Half127And5 => L::halfway(x - half, x - half + L::STEP),
    }
}

/// Returns the rule that defines a mapping.
pub fn rule(mapping: InputMapping) -> Rule {
    match mapping {
        InputMapping::UnsignedIdentity | InputMapping::UnsignedInvert => Rule::Cmb2,
        InputMapping::ExpandNormal | InputMapping::ExpandNegate => Rule::Cmb3,
        InputMapping::HalfBiasNormal | InputMapping::HalfBiasNegate => Rule::Cmb4,
        InputMapping::SignedIdentity | InputMapping::SignedNegate => Rule::Cmb5,
    }
}

/// Returns the operation that traces show for a mapping.
pub(crate) fn operation(mapping: InputMapping) -> &'static str {
    match mapping {
        InputMapping::UnsignedIdentity => "unsigned_identity",
        InputMapping::UnsignedInvert => "unsigned_invert",
        InputMapping::ExpandNormal => "expand_normal",
        InputMapping::ExpandNegate => "expand_negate",
        InputMapping::HalfBiasNormal => "half_bias_normal",
        InputMapping::HalfBiasNegate => "half_bias_negate",
        InputMapping::SignedIdentity => "signed_identity",
        InputMapping::SignedNegate => "signed_negate",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Halves;
    use crate::state::Named;

    /// Compares every mapping of every register value under every policy with integer statements, in halves.
    #[test]
    fn all_mappings_of_all_values() {
        for expand_centre in ExpandCentre::ALL {
            for half_bias in HalfBiasConstant::ALL {
                let policies = Policies { expand_centre: *expand_centre, half_bias: *half_bias, ..Policies::DEFAULT };
                for x in -256..=255_i32 {
                    let m = x.max(0);
                    let centre = match expand_centre {
                        ExpandCentre::Centred => 256,
                        ExpandCentre::Literal => 255,
                    };
                    let half = match half_bias {
                        HalfBiasConstant::Half128 => 256,
                        HalfBiasConstant::Half127 => 254,
                        HalfBiasConstant::Half127And5 => 255,
                    };
                    for mapping in InputMapping::ALL {
                        let want = match mapping {
                            InputMapping::UnsignedIdentity => 2 * m,
                            InputMapping::UnsignedInvert => 2 * (255 - m),
                            InputMapping::ExpandNormal => 2 * (2 * m - centre),
                            InputMapping::ExpandNegate => (2 * (centre - 2 * m)).min(510),
                            InputMapping::HalfBiasNormal => 2 * m - half,
                            InputMapping::HalfBiasNegate => half - 2 * m,
                            InputMapping::SignedIdentity => 2 * x,
                            InputMapping::SignedNegate => (-2 * x).min(510),
                        };
                        assert_eq!(map([x], *mapping, &policies), [Halves(want)], "{mapping:?} {x} {policies:?}");
                    }
                }
            }
        }
    }

    /// CMB-2: ZERO inverted is exactly 255. CMB-5: minus one is the negation of one.
    #[test]
    fn ones() {
        assert_eq!(map([0], InputMapping::UnsignedInvert, &Policies::DEFAULT), [Halves(510)]);
        assert_eq!(map([255], InputMapping::SignedNegate, &Policies::DEFAULT), [Halves(-510)]);
    }
}
