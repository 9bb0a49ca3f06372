//! CMB-9, CMB-10: bias, scale and saturation of outputs, and the selection of the mux.

use crate::number::{Integer, Lane, Register, Sum};
use crate::state::{Bias, MuxNegative, MuxSelect, Policies, RegisterFloor, Scale};

/// CMB-9: applies the bias.
#[inline(always)]
pub fn biased<R: Register>(v: R, bias: Bias) -> R {
    match bias {
        Bias::None => v,
        Bias::NegativeHalf => v - R::HALF,
    }
}

/// CMB-9: applies the scale.
#[inline(always)]
pub fn scaled<R: Register>(v: R, scale: Scale) -> R {
    match scale {
        Scale::One => v,
        Scale::Two => v + v,
        Scale::Four => (v + v) + (v + v),
        Scale::Half => v.halved(),
    }
}

/// CMB-9, NUM-3: applies bias and scale to a rounded value, then saturates it.
#[inline(always)]
pub fn finished<R: Register>(v: R, bias: Bias, scale: Scale, floor: RegisterFloor) -> R {
    scaled(biased(v, bias), scale).saturated(floor)
}

/// CMB-9=after: applies bias and scale at full width, then rounds. The result is not saturated.
#[inline(always)]
pub(crate) fn rounded_after<L: Lane>(raw: L::Full, bias: Bias, scale: Scale) -> L {
    let raw = match bias {
        Bias::None => raw,
        Bias::NegativeHalf => raw - L::HALF.widened(),
    };
    match scale {
        Scale::One => raw.rounded(),
        Scale::Two => (raw + raw).rounded(),
        Scale::Four => ((raw + raw) + (raw + raw)).rounded(),
        Scale::Half => L::rounded_half(raw),
    }
}

/// CMB-10: returns whether the mux takes CD.
#[inline]
pub fn mux_takes_cd<L: Lane>(spare0_alpha: L, select: MuxSelect, policies: &Policies) -> bool {
    takes_cd(spare0_alpha.decision(), select, policies.mux_negative)
}

/// CMB-10: returns whether the mux takes CD, for SPARE0's alpha as an integer.
#[inline(always)]
pub fn takes_cd<I: Integer>(v: I, select: MuxSelect, negative: MuxNegative) -> I::Choice {
    match (select, negative) {
        (MuxSelect::Lsb, _) => !v.masked(1).is_zero(),
        (MuxSelect::Msb, MuxNegative::Sign) => !v.is_below(I::new(128)),
        (MuxSelect::Msb, MuxNegative::Bit7) => !v.masked(128).is_zero(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn muxes_decide_by_one_bit_of_every_register() {
        for v in -256..=255_i32 {
            let sides = [
                (MuxSelect::Lsb, MuxNegative::Sign, v.rem_euclid(2) == 1),
                (MuxSelect::Lsb, MuxNegative::Bit7, v.rem_euclid(2) == 1),
                (MuxSelect::Msb, MuxNegative::Sign, (128..256).contains(&v)),
                (MuxSelect::Msb, MuxNegative::Bit7, v.rem_euclid(256) >= 128),
            ];
            for (select, negative, expected) in sides {
                assert_eq!(takes_cd(v, select, negative), expected, "CMB-10: {select:?} {negative:?} of {v}");
            }
        }
    }
}
