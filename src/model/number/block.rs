//! Lanes with 16 bits of storage, for loops over blocks of pixels. Every formula that is particular to a lane is in
//! this file, with its exhaustive test; the text of the rules does not change.

use super::{Blend, Factor, Register, Sum};
use crate::state::RegisterFloor;
use std::ops::{Add, Sub};

/// Every sum that a weight rule forms is at most 255 * 256 + 128, so it fits.
impl Blend for u16 {
    type Weight = u16;
    const WHOLE: u16 = 256;
    #[inline(always)]
    fn times(self, weight: u16) -> u16 {
        self * weight
    }
    #[inline(always)]
    fn round8(self) -> u16 {
        (self + 128) >> 8
    }
}

/// Two 8-bit channels in one word, 16 bits apart, so that one multiplication serves both. Sums stay within the range of
/// `u16` in each half, so no carry crosses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Swar2(pub u32);

impl Add for Swar2 {
    type Output = Swar2;
    #[inline(always)]
    fn add(self, other: Swar2) -> Swar2 {
        Swar2(self.0 + other.0)
    }
}

impl Blend for Swar2 {
    type Weight = u32;
    const WHOLE: u32 = 256;
    #[inline(always)]
    fn times(self, weight: u32) -> Swar2 {
        Swar2(self.0 * weight)
    }
    #[inline(always)]
    fn round8(self) -> Swar2 {
        Swar2((self.0 + 0x0080_0080) >> 8 & 0x00ff_00ff)
    }
}

/// NUM-2 without a division: returns floor((2n + 255) / 510) for |n| <= 400 000. Two dot products need 393 216.
#[inline(always)]
fn rnd255(n: i32) -> i32 {
    (n * 257 + (n >> 8) + 32646) >> 16
}

/// NUM-2 of at most 255 x 255, computed in 16 bits.
#[inline(always)]
fn rounded_bytes(n: u16) -> i16 {
    // The upper half of a product of 16 bits, for which processors have an instruction.
    ((u32::from(n + 128) * 257) >> 16) as i16
}

/// NUM-2 of a product of two bytes.
#[inline(always)]
pub(crate) fn byte_product(a: i16, b: i16) -> i16 {
    rounded_bytes(a as u16 * b as u16)
}

/// NUM-2 of a sum of two products of bytes, at most 255.
#[inline(always)]
pub(crate) fn byte_sum([a, b, c, d]: [i16; 4]) -> i16 {
    let sum = (a as u16 * b as u16).saturating_add(c as u16 * d as u16);
    rounded_bytes(sum.min(255 * 255))
}

#[inline(always)]
fn saturate(v: i16, floor: RegisterFloor) -> i16 {
    match floor {
        RegisterFloor::Full => v.clamp(-256, 255),
        RegisterFloor::Symmetric => v.clamp(-255, 255),
    }
}

impl Register for i16 {
    type Factor = i16;
    type Expanded = i16;
    const ZERO: i16 = 0;
    const ONE: i16 = 255;
    const HALF: i16 = 128;
    #[inline(always)]
    fn max0(self) -> i16 {
        self.max(0)
    }
    #[inline(always)]
    fn factor(self) -> i16 {
        self
    }
    #[inline(always)]
    fn twice(self) -> i16 {
        self * 2
    }
    #[inline(always)]
    fn halved(self) -> i16 {
        (self + 1) >> 1
    }
    #[inline(always)]
    fn saturated(self, floor: RegisterFloor) -> i16 {
        saturate(self, floor)
    }
}

impl Factor for i16 {
    type Sum = i32;
    type Register = i16;
    #[inline(always)]
    fn product(self, other: i16) -> i32 {
        i32::from(self) * i32::from(other)
    }
}

impl Sum for i32 {
    type Register = i16;
    #[inline(always)]
    fn rounded(self) -> i16 {
        rnd255(self) as i16
    }
}

/// An `i16` register whose expanded factors stay halved, so that their products fit into 16 bits.
///
/// Valid only where an unsigned mapping reads the result, because a negative sum becomes some value that is not
/// positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Narrow(pub i16);

/// Half of an expanded value, -128..=127.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Half(i16);

/// A quarter of a sum of products, saturated. Sums of 16256 and more are a full register, so the saturation is
/// invisible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quarter(i16);

impl Sum for Quarter {
    type Register = Narrow;
    /// Returns floor((8m + 255) / 510) for m in 0..=16256. Negative sums become 0, larger ones 255.
    #[inline(always)]
    fn rounded(self) -> Narrow {
        let m = self.0.clamp(0, 16256) as u16 + 32;
        Narrow(((u32::from(m) * 1028) >> 16) as i16)
    }
}

impl Factor for Half {
    type Sum = Quarter;
    type Register = Narrow;
    #[inline(always)]
    fn product(self, other: Half) -> Quarter {
        Quarter(self.0 * other.0)
    }
}

/// A sum of products of [`Narrow`] registers that are not expanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NarrowSum(i32);

impl Sum for NarrowSum {
    type Register = Narrow;
    #[inline(always)]
    fn rounded(self) -> Narrow {
        Narrow(rnd255(self.0) as i16)
    }
}

impl Factor for Narrow {
    type Sum = NarrowSum;
    type Register = Narrow;
    #[inline(always)]
    fn product(self, other: Narrow) -> NarrowSum {
        NarrowSum(i32::from(self.0) * i32::from(other.0))
    }
}

wrapped! {
    Narrow: Add, add, |a, b| a + b;
    Narrow: Sub, sub, |a, b| a - b;
    Quarter: Add, add, |a, b| a.saturating_add(b);
    NarrowSum: Add, add, |a, b| a + b;
}

impl Register for Narrow {
    type Factor = Narrow;
    type Expanded = Half;
    const ZERO: Narrow = Narrow(0);
    const ONE: Narrow = Narrow(255);
    const HALF: Narrow = Narrow(128);
    #[inline(always)]
    fn max0(self) -> Narrow {
        Narrow(self.0.max(0))
    }
    #[inline(always)]
    fn factor(self) -> Narrow {
        self
    }
    #[inline(always)]
    fn twice(self) -> Half {
        Half(self.0)
    }
    #[inline(always)]
    fn halved(self) -> Narrow {
        Narrow((self.0 + 1) >> 1)
    }
    #[inline(always)]
    fn saturated(self, floor: RegisterFloor) -> Narrow {
        Narrow(saturate(self.0, floor))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn division_free_rounding_is_exact() {
        for n in -400_000..=400_000_i32 {
            assert_eq!(rnd255(n), (2 * n + 255).div_euclid(510), "{n}");
        }
    }

    #[test]
    fn products_of_bytes_are_exact() {
        for a in 0..=255_i16 {
            for b in 0..=255 {
                assert_eq!(byte_product(a, b), rnd255(i32::from(a) * i32::from(b)) as i16);
            }
        }
    }

    /// Every sum that is not limited, by one product and by two; and sums that are.
    #[test]
    fn sums_of_bytes_are_exact() {
        for n in 0..=255 * 255 {
            assert_eq!(rounded_bytes(n), rnd255(n.into()) as i16);
        }
        for a in 0..=255_i16 {
            for b in 0..=255 {
                let all = i32::from(a) * i32::from(b);
                for [c, d] in [[255, 255], [255, b], [a, 255], [255 - a, 77], [1, 254]] {
                    let wanted = rnd255(all + i32::from(c) * i32::from(d)).min(255);
                    assert_eq!(i32::from(byte_sum([a, b, c, d])), wanted, "{a} {b} {c} {d}");
                }
            }
        }
    }

    /// Tests every pair of bytes and every weight in one half, with the complements of the bytes in the other.
    #[test]
    fn two_channels_do_not_meet() {
        let step = |a: Swar2, b: Swar2, w: u32| (a.times(Swar2::WHOLE - w) + b.times(w)).round8();
        let one = |a: u32, b: u32, w: u32| (a * (256 - w) + b * w + 128) >> 8;
        for w in 0..=256 {
            for a in 0..=255 {
                for b in 0..=255 {
                    let (low, high) = (Swar2(a | (255 - a) << 16), Swar2(b | (255 - b) << 16));
                    assert_eq!(step(low, high, w).0, one(a, b, w) | one(255 - a, 255 - b, w) << 16);
                }
            }
        }
    }

    #[test]
    fn quarter_is_exact_for_every_sum() {
        for m in -32768..=32767_i16 {
            let want = (8 * i32::from(m) + 255).div_euclid(510).clamp(0, 255);
            assert_eq!(i32::from(Quarter(m).rounded().0), want, "{m}");
        }
    }
}
