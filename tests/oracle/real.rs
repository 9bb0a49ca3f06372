//! Exact reading of floats, and the integer operations that the rules share.

use std::ops::Neg;

/// Returns f = m 2^e exactly, as (m, e).
pub fn split(f: f32) -> (i128, i32) {
    let bits = f.to_bits();
    let exponent = (bits >> 23 & 255) as i32;
    let fraction = i128::from(bits & 0x7f_ffff);
    let (m, e) = if exponent == 0 { (fraction, -149) } else { (fraction | 0x80_0000, exponent - 150) };
    (if bits >> 31 == 1 { -m } else { m }, e)
}

/// Returns the number of bits of a magnitude, 0 for 0.
pub fn bits(n: i128) -> i32 {
    128 - n.unsigned_abs().leading_zeros() as i32
}

/// Returns floor(n 2^e).
pub fn shift(n: i128, e: i32) -> i128 {
    if e >= 0 { n << e.min(126 - bits(n)).max(0) } else { n >> (-e).min(127) }
}

/// The number m 2^e.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    pub m: i128,
    pub e: i32,
}

impl Number {
    pub const ZERO: Number = Number { m: 0, e: 0 };

    /// Returns a float exactly. A NaN counts as 0, and an infinity as 2^128 (TSH-4).
    pub fn of(f: f32) -> Number {
        let (m, e) = split(if f.is_nan() { 0.0 } else { f });
        Number { m, e }
    }

    /// Returns the binary exponent of the magnitude, or `None` for 0.
    pub fn exponent(self) -> Option<i32> {
        (self.m != 0).then(|| bits(self.m) - 1 + self.e)
    }

    /// Cuts toward zero to the first `n` bits.
    pub fn cut(self, n: i32) -> Number {
        self.cut_at(self.e + bits(self.m) - n)
    }

    /// Cuts toward zero to a multiple of 2^last.
    pub fn cut_at(self, last: i32) -> Number {
        if last <= self.e {
            return self;
        }
        Number { m: self.m.signum() * (self.m.abs() >> (last - self.e).min(127)), e: last }
    }

    /// Rounds up to the first `n` bits.
    pub fn up(self, n: i32) -> Number {
        let cut = self.cut(n);
        let loses = self.m > 0 && cut.m << (cut.e - self.e) != self.m;
        Number { m: cut.m + i128::from(loses), e: cut.e }
    }

    /// Returns the product, whose factors have at most 60 bits.
    pub fn times(self, other: Number) -> Number {
        Number { m: self.m * other.m, e: self.e + other.e }
    }

    /// Returns this number, which is a multiple of 2^e, in units of 2^e.
    pub fn over(self, e: i32) -> i128 {
        if self.m == 0 {
            return 0;
        }
        assert!(self.e >= e && bits(self.m) + self.e - e <= 126, "{self:?} in units of 2^{e}");
        self.m << (self.e - e)
    }

    /// Returns the floor of `scale` times this number, limited to +-2^100.
    pub fn floor(self, scale: i128) -> i128 {
        floor_sum(&[(self.m * scale, self.e)])
    }

    /// Returns the value as a float of 64 bits, which is exact for the numbers of WGT-1: they have at most 53 bits.
    pub fn real(self) -> f64 {
        assert!(bits(self.m) <= 53, "{self:?}");
        self.m as f64 * 2.0_f64.powi(self.e)
    }
}

impl Neg for Number {
    type Output = Number;

    fn neg(self) -> Number {
        Number { m: -self.m, e: self.e }
    }
}

/// Returns floor(numerator / denominator) for any signs, and whether the remainder is 0.
pub fn floor_div(numerator: i128, denominator: i128) -> (i128, bool) {
    let (n, d) = if denominator < 0 { (-numerator, -denominator) } else { (numerator, denominator) };
    (n.div_euclid(d), n.rem_euclid(d) == 0)
}

/// NUM-2: divides by 255 and rounds to nearest.
pub fn rnd255(n: i128) -> i128 {
    (2 * n + 255).div_euclid(510)
}

/// NUM-6: returns the byte of a factor from v = floor(4096 f).
pub fn factor_byte(v: i128) -> i128 {
    (v - (v >> 8)) >> 4
}

/// NUM-4: returns the byte of a float colour.
pub fn color_byte(c: f32) -> i128 {
    let (m, e) = split(c);
    if m <= 0 {
        return 0;
    }
    if c >= 1.0 {
        return 255;
    }
    let size = 128 - m.leading_zeros() as i32;
    let drop = (size - 14).max(0);
    let cut = m >> drop << drop;
    // floor(255 c + 1/2) = floor((510 m 2^e + 1) / 2). e is negative here.
    let half = -e;
    if half > 100 {
        return 0;
    }
    (510 * cut + (1 << half)) >> (half + 1)
}

/// Returns the floor of the sum of all m 2^e, limited to +-2^100. It is exact if at most one of them is tiny compared with the others.
pub fn floor_sum(terms: &[(i128, i32)]) -> i128 {
    let terms = || terms.iter().filter(|t| t.0 != 0);
    let top = terms().map(|t| t.1 + bits(t.0)).max().unwrap_or(0);
    // A finer term is rounded down to a step of which all others are multiples, so the floor of the sum does not change.
    let base = terms().map(|t| t.1).min().unwrap_or(0).max(top - 115);
    let sum: i128 = terms().map(|t| shift(t.0, t.1 - base)).sum();
    if base > 0 && bits(sum) + base > 100 { sum.signum() << 100 } else { shift(sum, base).clamp(-1 << 100, 1 << 100) }
}

/// Returns the float nearest to n / d 2^e, ties to even.
pub fn nearest_f32(n: i128, d: i128, e: i32) -> f32 {
    if n == 0 {
        return 0.0;
    }
    let up = 126 - bits(n);
    let numerator = n.abs() << up;
    let (q, rest) = (numerator / d, numerator % d);
    let e = e - up;
    // The result keeps 24 bits, or fewer in the range of subnormal numbers.
    let drop = (bits(q) - 24).max(-149 - e);
    let rounded = if drop > 126 {
        0
    } else {
        let (kept, lost) = (q >> drop, q & ((1 << drop) - 1));
        let half = 1 << (drop - 1);
        let up = lost > half || (lost == half && (rest != 0 || kept & 1 == 1));
        kept + i128::from(up)
    };
    // Both conversions are exact, except for numbers beyond the range of floats.
    let value = (rounded as f64 * 2.0_f64.powi(e + drop)) as f32;
    if n < 0 { -value } else { value }
}

/// Returns floor(128 log2 n) for n > 0.
pub fn log2_in_128ths(n: u128) -> i128 {
    let whole = 127 - n.leading_zeros() as i32;
    // Squares the mantissa seven times, as an interval in units of 2^-62.
    let (mut low, mut high) = if whole <= 62 {
        (n << (62 - whole), n << (62 - whole))
    } else {
        let cut = n >> (whole - 62);
        (cut, if cut << (whole - 62) == n { cut } else { cut + 1 })
    };
    let mut digits = i128::from(whole);
    for _ in 0..7 {
        let (l, h) = (low * low, high * high);
        let carries = l >> 125 == 1;
        if carries != (h >> 125 == 1) {
            return log2_by_power(n);
        }
        digits = 2 * digits + i128::from(carries);
        let down = 62 + u32::from(carries);
        (low, high) = (l >> down, (h + (1 << down) - 1) >> down);
    }
    digits
}

/// Returns the same logarithm by computing n^128 in full.
fn log2_by_power(n: u128) -> i128 {
    let mut power: Vec<u64> = (0..4).map(|k| (n >> (32 * k)) as u64 & 0xffff_ffff).collect();
    for _ in 0..7 {
        let mut square = vec![0_u64; 2 * power.len()];
        for (i, a) in power.iter().enumerate() {
            let mut carry = 0;
            for (j, b) in power.iter().enumerate() {
                let sum = square[i + j] + a * b + carry;
                (square[i + j], carry) = (sum & 0xffff_ffff, sum >> 32);
            }
            square[i + power.len()] = carry;
        }
        power = square;
    }
    let top = power.iter().rposition(|d| *d != 0).unwrap_or(0);
    32 * top as i128 + 63 - i128::from(power[top].leading_zeros())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms() {
        let cases = [1, 2, 3, 5, 255, 256, 257, u128::MAX >> 7, 1 << 100, (1 << 100) - 1, (1 << 100) + 1, 0xdead_beef];
        for n in cases {
            assert_eq!(log2_in_128ths(n), log2_by_power(n), "{n}");
            let f = (n as f64).log2() * 128.0;
            assert!((log2_by_power(n) as f64 - f).abs() < 1.001, "{n}");
        }
        for n in 1..100_000_u128 {
            assert_eq!(log2_in_128ths(n), ((n as f64).log2() * 128.0 + 1e-9).floor() as i128, "{n}");
        }
    }

    #[test]
    fn nearest_f32_agrees_with_division() {
        let mut random = ninebit::random::Random::seeded(1);
        for _ in 0..100_000 {
            let seed = random.bits();
            let (n, d) = ((seed >> 40) as i128 - (1 << 23), (seed >> 13 & 0xff_ffff) as i128 + 1);
            assert_eq!(nearest_f32(n, d, 0), n as f32 / d as f32);
        }
        assert_eq!(nearest_f32(3, 1, -150), f32::from_bits(2));
        assert_eq!(nearest_f32(1, 1, -150), 0.0);
        assert_eq!(nearest_f32(1, 1, 128), f32::INFINITY);
    }
}
