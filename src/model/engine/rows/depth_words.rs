//! DEP-3 to DEP-5 on rows: offset, range and word of a depth that is held as a double, exactly.
#![allow(clippy::float_arithmetic, reason = "sums with their exact rounding errors, and cuts at powers of two")]

use super::reciprocal::power_of_two;
use crate::raster::depth::Binary;
use crate::state::{DepthFormat, DepthRange};

/// Marks a pixel outside the draw's depth range, which is dropped (DEP-4). No buffer has it.
pub(super) const OUTSIDE: u32 = u32::MAX - 1;

/// The steps from a depth to its word.
#[derive(Clone, Copy, Debug)]
pub(super) struct Words<'a> {
    /// Polygon offset as the sum of two numbers.
    offset: [f64; 2],
    range: Option<&'a DepthRange>,
    format: DepthFormat,
}

impl<'a> Words<'a> {
    #[inline(always)]
    pub(super) fn new(offset: Binary, range: Option<&'a DepthRange>, format: DepthFormat) -> Words<'a> {
        Words { offset: two_doubles(offset), range, format }
    }

    /// Returns whether depths are floored and nothing else.
    #[inline(always)]
    pub(super) fn are_floors(&self) -> bool {
        self.range.is_none() && !self.has_offset() && !self.format.is_float()
    }

    #[inline(always)]
    pub(super) fn has_offset(&self) -> bool {
        self.offset != [0.0; 2]
    }

    /// Returns whether the offset is far from the limits of doubles. Otherwise the definition has to compute the words.
    #[inline(always)]
    pub(super) fn can_add_offset(&self) -> bool {
        !self.has_offset() || (1e-250..1e250).contains(&self.offset[0].abs())
    }

    /// DEP-5: returns the sum of a depth and the offset as a double and a number below its last bit, of which only the sign counts.
    #[inline(always)]
    pub(super) fn with_offset(&self, depth: f64) -> (f64, f64) {
        // The definition has more bits than a double, so the rounding error of the sum counts.
        let (high, rest) = two_sum(depth, self.offset[0]);
        let (rest, least) = two_sum(rest, self.offset[1]);
        let (high, rest) = two_sum(high, rest);
        (high, if rest == 0.0 { least } else { rest })
    }

    /// DEP-3 to DEP-5: returns the word of a depth that is the sum of a double and a number below its last bit.
    #[inline(always)]
    pub(super) fn word(&self, sum: f64, lost: f64) -> u32 {
        if let Some(range) = self.range {
            let (lowest, highest) = (f64::from(range.lowest), f64::from(range.highest));
            let below = sum < lowest || sum == lowest && lost < 0.0;
            let above = sum > highest || sum == highest && lost > 0.0;
            if below || above {
                return if range.clamps { word(self.format, if below { lowest } else { highest }) } else { OUTSIDE };
            }
        }
        // A number between a double and the one before it yields the same word as the latter, because words begin at doubles. Only positive
        // numbers are depths.
        let before = f64::from_bits(sum.to_bits().wrapping_sub(1));
        word(self.format, if lost < 0.0 && sum > 0.0 { before } else { sum })
    }
}

/// Returns two doubles whose sum is a number.
#[inline(always)]
fn two_doubles(n: Binary) -> [f64; 2] {
    let high = n.mantissa as f64;
    let low = n.mantissa.wrapping_sub(high as i64) as f64;
    [high, low].map(|part| part * power_of_two(n.exponent))
}

/// Returns a sum and its exact rounding error.
#[inline(always)]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let other = sum - a;
    (sum, (a - (sum - other)) + (b - other))
}

/// DEP-3: returns the word of a depth.
#[inline(always)]
pub(super) fn word(format: DepthFormat, depth: f64) -> u32 {
    if depth <= 0.0 {
        return 0;
    }
    if !format.is_float() {
        return depth.min(f64::from(format.largest())) as u32;
    }
    let (kept, bias) = if format == DepthFormat::Z16F { (12, 7) } else { (16, 127) };
    let word = (depth.to_bits() >> (52 - kept)) as i64 - ((1023 - bias) << kept);
    match word {
        ..0 => 0,
        tiny if tiny >> kept == 0 => 0,
        huge if huge >= if kept == 12 { 1 << 16 } else { 255 << 16 } => format.largest(),
        word => word as u32,
    }
}

#[cfg(test)]
mod tests {
    use super::super::lattice;
    use super::*;
    use crate::random::Random;
    use crate::raster::depth::{DepthPlane, offset, ranged, word as defined_word};
    use crate::state::{Named, PolygonOffset};

    /// Returns the number as a double, if that holds it.
    fn real(Binary { mantissa, exponent }: Binary) -> f64 {
        mantissa as f64 * power_of_two(exponent)
    }

    #[test]
    fn offsets_ranges_and_words_are_those_of_the_definition() {
        let mut random = Random::seeded(0x2545_f491_4f6c_dd1d);
        let next = &mut || random.bits() as u32;
        let (mut equal, mut inexact, mut dropped, mut drawn) = (0, 0, 0, 0);
        for round in 0..400_000 {
            let format = lattice::pick(next, DepthFormat::ALL);
            // Sums of DEP-1 have up to 31 bits.
            let depth = match next() % 3 {
                0 => Binary {
                    mantissa: lattice::whole(next, (-(1 << 30), 1 << 30)),
                    exponent: lattice::whole(next, (-160, 90)) as i32,
                },
                1 => Binary { mantissa: lattice::whole(next, (0, 1 << 30)), exponent: -6 },
                _ => Binary::new(lattice::any(next)),
            };
            let bias = match next() % 4 {
                0 => 0.0,
                1 => lattice::whole(next, (-(1 << 24), 1 << 24)) as f32,
                2 => lattice::beside(next, -real(depth) as f32),
                _ => lattice::any(next),
            };
            let factor = if next().is_multiple_of(2) { 0.0 } else { lattice::any(next) };
            let slope = Binary {
                mantissa: lattice::whole(next, (0, 1 << 47)),
                exponent: lattice::whole(next, (-190, 110)) as i32,
            };
            let plane = DepthPlane { offset: offset(PolygonOffset { bias, factor }, slope), ..DepthPlane::default() };
            let sum = (real(depth) + real(plane.offset)) as f32;
            let mut limit = || {
                let full = format.largest() as f32;
                let of = [sum, sum, bias, real(depth) as f32, full, 0.0, lattice::any(next)];
                let limit = lattice::pick(next, &of);
                lattice::beside(next, if limit.is_finite() { limit } else { f32::MAX })
            };
            let (one, other) = (limit(), limit());
            let clamps = next().is_multiple_of(2);
            let range = DepthRange { lowest: one.min(other), highest: one.max(other), clamps, drops_triangles: false };
            let range = (next() % 4 > 0).then_some(range);
            let exact = plane.with_offset(depth);
            let defined = ranged(range.as_ref(), exact).map_or(OUTSIDE, |depth| defined_word(format, depth));
            let words = Words::new(plane.offset, range.as_ref(), format);
            if !words.can_add_offset() {
                continue;
            }
            let (high, lost) = if words.has_offset() { words.with_offset(real(depth)) } else { (real(depth), 0.0) };
            let found = words.word(high, lost);
            assert_eq!(
                found, defined,
                "{round}: {depth:?} + {:?} ({bias} {factor}) {range:?} {format:?}",
                plane.offset
            );
            equal += u32::from(range.is_some_and(|range| [range.lowest, range.highest].map(f64::from).contains(&high)));
            inexact += u32::from(lost != 0.0);
            dropped += u32::from(found == OUTSIDE);
            drawn += 1;
        }
        println!("{drawn} depths, {equal} round to a limit, {inexact} sums lose something, {dropped} outside");
        assert!(drawn > 200_000 && equal > 20_000 && inexact > 20_000 && dropped > 20_000);
    }
}
