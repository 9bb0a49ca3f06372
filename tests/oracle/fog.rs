//! The fog factor: INT-5, INT-5n, NUM-6.

use super::raster::{Sample, Setup};
use super::real::{bits, factor_byte, floor_div, floor_sum, shift, split};
use super::tally::{count, count_named};
use ninebit::state::{FogFunction, FogMode};
use std::sync::OnceLock;

/// Fraction bits of the powers of two.
const ONE: u32 = 126;

/// FOG.a of a pixel, a byte.
pub fn factor(setup: &Setup, sample: &Sample, function: Option<FogFunction>) -> i128 {
    let v = match function {
        // INT-5n: the vertices' factors, interpolated.
        None => {
            let sum: i128 = (0..3)
                .map(|k| {
                    let (m, e) = split(setup.vertices[k].fog.clamp(0.0, 1.0));
                    shift(setup.p[k] * 4096 * m, e) * sample.e[k]
                })
                .sum();
            floor_div(sum, sample.d).0
        }
        Some(function) => {
            count_named(function.mode);
            let given = setup.vertices.iter().map(|vertex| vertex.fog).chain([function.p0, function.p1]);
            if given.into_iter().any(|number| !number.is_finite()) {
                count("fog", "not finite");
                without_a_coordinate(function.mode)
            } else {
                in_4096ths(function, coordinate(setup, sample))
            }
        }
    };
    factor_byte(v.clamp(0, 4096))
}

/// INT-5: what something that is not finite gives: no fog in three of the modes.
fn without_a_coordinate(mode: FogMode) -> i128 {
    match mode {
        FogMode::Linear | FogMode::LinearAbs | FogMode::Exp => 4096,
        FogMode::ExpAbs | FogMode::Exp2 | FogMode::Exp2Abs => 0,
    }
}

/// INT-5: the fog coordinate cut to 24 significant bits, as m 2^e.
fn coordinate(setup: &Setup, sample: &Sample) -> (i128, i32) {
    let (n, e) = setup.attribute(sample, |v| v.fog);
    if n == 0 {
        return (0, 0);
    }
    let up = 126 - bits(n);
    let q = (n.abs() << up) / sample.d;
    let drop = (bits(q) - 24).max(0);
    (n.signum() * (q >> drop), e - up + drop)
}

/// floor(4096 f), not limited below 0 or above 1.
pub fn in_4096ths(function: FogFunction, (d, de): (i128, i32)) -> i128 {
    let (p0, e0) = split(function.p0);
    let (p1, e1) = split(function.p1);
    let (product, pe) = (d * p1, de + e1);
    // f as a sum of terms.
    let terms: [(i128, i32); 3] = match function.mode {
        FogMode::Linear | FogMode::LinearAbs => [(p0, e0), (product, pe), (-1, 0)],
        FogMode::Exp | FogMode::ExpAbs => [(p0, e0), (power_of_two(product, pe + 4), -32), (-3, -1)],
        FogMode::Exp2 | FogMode::Exp2Abs => [(p0, e0), (power_of_minus_square(product, pe), -32), (-3, -1)],
    };
    let scaled = |sign: i128| floor_sum(&terms.map(|(m, e)| (sign * m, e + 12)));
    match function.mode {
        FogMode::Linear | FogMode::Exp | FogMode::Exp2 => scaled(1),
        // The magnitude: of f and -f, the one that is not negative.
        _ => scaled(1).max(scaled(-1)),
    }
}

/// floor(2^32 2^(-32 (m 2^e)^2)).
fn power_of_minus_square(m: i128, e: i32) -> i128 {
    power_of_two(-(m * m), 2 * e + 5)
}

/// floor(2^32 2^x), x = m 2^e; an x beyond 16 counts as 16 (INT-5).
pub fn power_of_two(m: i128, e: i32) -> i128 {
    const MOST: i128 = 16;
    if m == 0 || e >= 0 || bits(m) + e > 12 {
        // An integer, or out of reach.
        let x = if bits(m) + e > 12 { m.signum() * 4096 } else { m << e.max(0) };
        return shift(1, x.clamp(-200, MOST) as i32 + 32);
    }
    let down = (-e) as u32;
    let whole = if down > 127 { m.signum().min(0) } else { m >> down };
    if down <= 126 && m == whole << down {
        return power_of_two(whole, 0);
    }
    // 2^fraction between two products of 2^(1/2), 2^(1/4), ...: the bits of the fraction, and what remains of it.
    let (mut low, mut high) = (1_u128 << ONE, 1_u128 << ONE);
    for (k, (l, h)) in roots().iter().enumerate() {
        // Bit k + 1 after the point; beyond bit 127 of a negative number all bits are ones.
        let place = down as i32 - 1 - k as i32;
        let bit = if place < 0 {
            0
        } else if place > 126 {
            i128::from(m < 0)
        } else {
            m >> place & 1
        };
        if bit == 1 {
            (low, high) = (times(low, *l), times(high, *h) + 1);
        }
    }
    // The bits not looked at add less than one step of the last.
    high = (times(high, roots()[roots().len() - 1].1) + 1).min((1 << (ONE + 1)) - 1);
    if whole >= MOST {
        return 1 << (MOST + 32);
    }
    let keep = whole as i32 + 32 - ONE as i32;
    let (l, h) = (shift(low as i128, keep), shift(high as i128, keep));
    assert_eq!(l, h, "2^({m} 2^{e}) needs more bits");
    l
}

/// 2^(1/2), 2^(1/4), ...: a lower and an upper bound of each.
fn roots() -> &'static [(u128, u128)] {
    static ROOTS: OnceLock<Vec<(u128, u128)>> = OnceLock::new();
    ROOTS.get_or_init(|| {
        let (mut low, mut high) = (2_u128 << ONE, 2_u128 << ONE);
        (0..120)
            .map(|_| {
                (low, high) = (root(low), root(high) + 1);
                (low, high)
            })
            .collect()
    })
}

/// floor(sqrt(x)) of a number 1..=2 with 126 fraction bits.
fn root(x: u128) -> u128 {
    let mut r = 0;
    for k in (0..=ONE).rev() {
        let try_this = r | 1 << k;
        let (high, low) = square(try_this, try_this);
        // r^2 <= x 2^126, with x 2^126 = (x >> 2) 2^128 + (x & 3) 2^126.
        if (high, low) <= (x >> 2, x << ONE) {
            r = try_this;
        }
    }
    r
}

/// floor(a b 2^-126).
fn times(a: u128, b: u128) -> u128 {
    let (high, low) = square(a, b);
    high << 2 | low >> ONE
}

/// The 256 bits of a product.
fn square(a: u128, b: u128) -> (u128, u128) {
    const HALF: u128 = (1 << 64) - 1;
    let (ah, al, bh, bl) = (a >> 64, a & HALF, b >> 64, b & HALF);
    let (mid, carry) = (ah * bl).overflowing_add(al * bh);
    let (low, more) = (al * bl).overflowing_add(mid << 64);
    (ah * bh + (mid >> 64) + (u128::from(carry) << 64) + u128::from(more), low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two() {
        assert_eq!(power_of_two(0, 0), 1 << 32);
        assert_eq!((power_of_two(-1, 0), power_of_two(-33, 0), power_of_two(3, 0)), (1 << 31, 0, 1 << 35));
        assert_eq!(power_of_two(-1, -140), (1 << 32) - 1);
        assert_eq!(power_of_two(1, -140), 1 << 32);
        // floor(2^32 sqrt(2)) and floor(2^32 / sqrt(2)).
        assert_eq!((power_of_two(1, -1), power_of_two(-1, -1)), (6_074_000_999, 3_037_000_499));
        for n in -400..400 {
            let want = (f64::from(n) / 64.0).exp2() * 4_294_967_296.0;
            assert!((power_of_two(n.into(), -6) as f64 - want.floor()).abs() <= 1.0, "{n}");
        }
    }
}
