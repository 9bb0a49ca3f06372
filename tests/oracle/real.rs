//! Exact readings of f32 and the few integer helpers that the rules share.

/// f = m * 2^e, exactly.
pub fn split(f: f32) -> (i128, i32) {
    let bits = f.to_bits();
    let exponent = (bits >> 23 & 255) as i32;
    let fraction = i128::from(bits & 0x7f_ffff);
    let (m, e) = if exponent == 0 { (fraction, -149) } else { (fraction | 0x80_0000, exponent - 150) };
    (if bits >> 31 == 1 { -m } else { m }, e)
}

/// floor(n * 2^e).
pub fn shift(n: i128, e: i32) -> i128 {
    if e >= 0 { n << e.min(60) } else { n >> (-e).min(127) }
}

/// Block floating point: the largest magnitude gets exactly `keep` bits, the others share its exponent, floored.
pub fn align<const N: usize>(values: [(i128, i32); N], keep: i32) -> [i128; N] {
    let top = values
        .iter()
        .filter(|(m, _)| *m != 0)
        .map(|(m, e)| 128 - m.unsigned_abs().leading_zeros() as i32 + e)
        .max()
        .unwrap_or(0);
    values.map(|(m, e)| shift(m, e + keep - top))
}

/// floor(numerator / denominator), whatever the signs; and whether nothing remains.
pub fn floor_div(numerator: i128, denominator: i128) -> (i128, bool) {
    let (n, d) = if denominator < 0 { (-numerator, -denominator) } else { (numerator, denominator) };
    (n.div_euclid(d), n.rem_euclid(d) == 0)
}

/// NUM-2.
pub fn rnd255(n: i128) -> i128 {
    (2 * n + 255).div_euclid(510)
}

/// NUM-6 from v = floor(4096 f).
pub fn factor_byte(v: i128) -> i128 {
    (v - (v >> 8)) >> 4
}

/// NUM-4.
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
    // floor(255 c + 1/2) = floor((510 m 2^e + 1) / 2); e is negative here.
    let half = -e;
    if half > 100 {
        return 0;
    }
    (510 * cut + (1 << half)) >> (half + 1)
}
