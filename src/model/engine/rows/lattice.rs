//! Boundary numbers: exponents, mantissas and whole numbers beside which rules change or roundings tie, as test suites of arithmetic draw them.
//!
//! Unit tests of the model and random scenes draw from the same lattice. `next` yields random words, for which 0 means the plainest choice.
#![allow(unreachable_pub, dead_code, clippy::float_arithmetic, reason = "each test uses a part, and chooses numbers")]

/// Draws an element of a list.
pub fn pick<T: Copy>(next: &mut impl FnMut() -> u32, of: &[T]) -> T {
    of[next() as usize % of.len()]
}

/// Returns the low 23 bits of a binary32 number: none, all, one, runs from either end, and ties with their neighbours at any bit.
pub fn mantissa(next: &mut impl FnMut() -> u32) -> u32 {
    const ALL: u32 = 0x7f_ffff;
    let kind = next() % 10;
    let (at, bits) = (next() % 23, next());
    let tie = bits << (at + 1) | 1 << at;
    ALL & match kind {
        0 => 0,
        1 => ALL,
        2 => 1 << at,
        3 => !(1 << at),
        4 => ALL << at,
        5 => (1 << at) - 1,
        6 => tie,
        7 => tie.wrapping_sub(1),
        8 => tie.wrapping_add(1),
        _ => bits,
    }
}

/// Returns a number whose exponent is `least` to `most`, half of the time an end, 0 or a neighbour of these, of either sign.
pub fn within(next: &mut impl FnMut() -> u32, (least, most): (i32, i32)) -> f32 {
    let span = (most - least) as u32 + 1;
    let near = [0.clamp(least, most), least, most, (least + 1).min(most), (most - 1).max(least), 1.clamp(least, most)];
    let exponent = if next().is_multiple_of(2) { pick(next, &near) } else { least + (next() % span) as i32 };
    let magnitude = match exponent {
        // Subnormal.
        ..-126 => mantissa(next) >> (-127 - exponent).clamp(0, 22),
        _ => ((exponent.min(127) + 127) as u32) << 23 | mantissa(next),
    };
    f32::from_bits(magnitude | (next() % 4 / 3) << 31)
}

/// Returns a finite number of any magnitude: also zeros of both signs, the largest, the least normal and subnormal ones.
pub fn any(next: &mut impl FnMut() -> u32) -> f32 {
    const RANGES: [(i32, i32); 8] =
        [(-4, 4), (-24, 24), (-64, 64), (20, 34), (-34, -20), (-149, 127), (120, 127), (-149, -120)];
    match next() % 10 {
        8 => pick(next, &[0.0, -0.0]),
        9 => pick(next, &[f32::MAX, f32::MIN_POSITIVE, f32::from_bits(1), f32::from_bits(0x7f_ffff), f32::MIN]),
        range => within(next, RANGES[range as usize]),
    }
}

/// Returns a number or one of its neighbours; a finite one stays finite.
pub fn beside(next: &mut impl FnMut() -> u32, number: f32) -> f32 {
    let moved = match next() % 6 {
        3 => number.next_up(),
        4 => number.next_down(),
        5 => number.next_up().next_up(),
        _ => number,
    };
    if moved.is_finite() { moved } else { number }
}

/// Returns a whole number of a range: its ends, 0, powers of two, each or a neighbour, or any.
pub fn whole(next: &mut impl FnMut() -> u32, (low, high): (i64, i64)) -> i64 {
    let power = 1_i64 << (next() % 40);
    let number = match next() % 6 {
        0 => 0_i64.clamp(low, high),
        1 => low,
        2 => high,
        3 => power,
        4 => -power,
        _ => low + i64::from(next()) % (high - low + 1),
    };
    (number + i64::from(next() % 3) - 1).clamp(low, high)
}

/// Returns a byte at an end, at the middle, or beside one of these, or any.
pub fn byte(next: &mut impl FnMut() -> u32) -> u8 {
    const NEAR: [u8; 12] = [255, 0, 128, 127, 1, 254, 129, 126, 64, 63, 192, 2];
    if next() % 4 < 3 { pick(next, &NEAR) } else { next() as u8 }
}

/// Returns a float colour: beside a byte, beside the tie between two bytes, or beyond the ends.
pub fn colour(next: &mut impl FnMut() -> u32) -> f32 {
    let byte = f32::from(byte(next));
    match next() % 5 {
        0 | 1 => beside(next, byte / 255.0),
        2 | 3 => beside(next, (byte + 0.5) / 255.0),
        _ => within(next, (-20, 3)),
    }
}
