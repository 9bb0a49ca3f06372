//! Recomputes the operations of the texture shader. Single precision is computed by the processor, everything else in exact fractions.

use super::Number;

type Inputs = [(String, Number)];

fn single(inputs: &Inputs, n: usize) -> f32 {
    assert_eq!(inputs[n].1.per_one, 0, "a single-precision number");
    f32::from_bits(inputs[n].1.value as u32)
}

fn bits(value: f32) -> Number {
    Number { value: if value.is_nan() { 0x7fc0_0000 } else { value.to_bits().into() }, per_one: 0 }
}

fn value(inputs: &Inputs, n: usize) -> i128 {
    inputs[n].1.value
}

/// Returns G0 E0 + G1 E1 + G2 E2.
pub fn numerator(inputs: &Inputs) -> i128 {
    (0..3).map(|k| value(inputs, k) * value(inputs, 3 + k)).sum()
}

/// INT-4t: returns 2^24 times the numerator of a function with weights that fall short, as a whole number and a number of parts 1/P1. The
/// inputs from `x` on are the function's numbers, those from `e` on the edge functions, and those from `p` on P0, P1, P2, short0 and
/// short2.
pub fn short(inputs: &Inputs, x: usize, e: usize, p: usize) -> [i128; 2] {
    let v = |n: usize| value(inputs, n);
    let short = [v(p + 3), 0, v(p + 4)];
    let whole = (0..3).map(|k| v(x + k) * v(e + k) * ((1 << 24) - short[k])).sum();
    [whole, v(x + 1) * (0..3).map(|k| short[k] * v(p + k) * v(e + k)).sum::<i128>()]
}

/// TSH-7, INT-4t: returns a plane's quotient by D with weights that fall short, moved by so many 2^-24, or `None` if it is not as much
/// lower as the last input says. The inputs from `p` on are those of [`short`].
pub fn floor_moved(inputs: &Inputs, by: i128, p: usize) -> Option<Number> {
    let v = |n: usize| value(inputs, n);
    let (sum, [whole, part]) = (numerator(inputs), short(inputs, 0, 3, p));
    let (down, limit) = (v(6) << 24, 1 << 24);
    let exact = ((sum << 24) + by * v(6)).div_euclid(down).clamp(-limit, limit);
    let moved = whole + by * v(6);
    let rest = (moved.rem_euclid(down) * v(p + 1) + part).div_euclid(down * v(p + 1));
    let value = (moved.div_euclid(down) + rest).clamp(-limit, limit);
    (exact - value == v(p + 5)).then_some(Number { value, per_one: 256 })
}

/// Returns P1 times the result of [`short`], for numbers of 28 bits.
pub fn short_of_unit(inputs: &Inputs, x: usize, e: usize, p: usize) -> i128 {
    let [whole, part] = short(inputs, x, e, p);
    whole * value(inputs, p + 1) + part
}

/// Returns floor(scale n / d) for d > 0 and scale below 2^24, limited to 2^60. n and d may have 120 bits.
pub fn floor_of_product(n: i128, d: i128, scale: i128) -> i128 {
    let (whole, part) = (n.div_euclid(d).clamp(-1 << 36, 1 << 36), n.rem_euclid(d));
    let (mut value, mut rest) = (whole * scale, 0);
    for bit in (0..24).rev() {
        rest = 2 * rest + (scale >> bit & 1) * part;
        value += (rest / d) << bit;
        rest %= d;
    }
    value
}

/// Returns floor(scale n / D 2^exponent).
pub fn floor_number(inputs: &Inputs, scale: i128) -> i128 {
    let (n, d, exponent) = (numerator(inputs) * scale, value(inputs, 6), value(inputs, 7));
    if exponent <= 0 {
        // The floor of a floor is the floor of the whole.
        return n.div_euclid(d) >> (-exponent).min(127);
    }
    match n.checked_mul(1_i128.checked_shl(exponent as u32).unwrap_or(i128::MAX)) {
        Some(n) => n.div_euclid(d),
        None => n.signum() * i128::from(i64::MAX),
    }
}

/// Returns the single-precision number nearest to n / D 2^exponent.
pub fn nearest_float(inputs: &Inputs) -> Number {
    let (n, d, mut exponent) = (numerator(inputs), value(inputs, 6), value(inputs, 7));
    // Takes 50 bits of the quotient and one more for the remainder. A double represents them exactly, so the conversion rounds only once.
    let (mut quotient, mut remainder) = (n.abs() / d, n.abs() % d);
    while quotient < 1 << 50 && n != 0 {
        quotient = 2 * quotient + (2 * remainder) / d;
        remainder = (2 * remainder) % d;
        exponent -= 1;
    }
    let mut rest = remainder != 0;
    while quotient >= 1 << 51 {
        rest |= quotient & 1 != 0;
        (quotient, exponent) = (quotient >> 1, exponent + 1);
    }
    let mantissa = (2 * quotient + i128::from(rest)) as f64;
    let magnitude = (mantissa * 2_f64.powi((exponent - 1).clamp(-900, 900) as i32)) as f32;
    bits(if n < 0 { -magnitude } else { magnitude })
}

pub fn remap(operation: &str, inputs: &Inputs) -> Number {
    let v = |n: usize| value(inputs, n);
    let signed = |v: i128| i128::from(v as u8 as i8);
    let half = |n: usize| 256 * v(n) + v(n + 1);
    let signed_half = |n: usize| i128::from(half(n) as u16 as i16);
    let quotient = |a: i128, b: i128| bits(a as f32 / b as f32);
    match operation {
        "remap_zero_to_one" => quotient(v(0), 255),
        "remap_d3d" => quotient(v(0) - 128, 127),
        "remap_gl" => quotient(2 * signed(v(0)) + 1, 255),
        "remap_twos_complement" => quotient(signed(v(0)), 127),
        "remap_half" => quotient(half(0), 65535),
        "remap_half_signed" => quotient(signed_half(0), 32768),
        "third_of_unit" => {
            let left = (32768 * 32768 - signed_half(0).pow(2) - signed_half(2).pow(2)).max(0);
            // Finds the largest n with 2 n <= sqrt(left), bit by bit.
            let mut n = 0;
            for bit in (0..=14).rev() {
                let more = n | 1 << bit;
                if 4 * more * more <= left {
                    n = more;
                }
            }
            quotient(n, 1 << 14)
        }
        _ => bits(1.0),
    }
}

pub fn float(operation: &str, inputs: &Inputs) -> Number {
    let f = |n: usize| single(inputs, n);
    bits(match operation {
        "float_product" => f(0) * f(1),
        "float_sum" => f(0) + f(1) + f(2),
        "float_dot" => {
            let products = [0, 2, 4].map(|n| f(n) * f(n + 1));
            products[0] + products[1] + products[2]
        }
        "float_double" => 2.0 * f(0),
        _ => {
            let products = [f(0) * f(1), f(2) * f(3)];
            products[0] - products[1]
        }
    })
}

/// Splits x into mantissa 2^exponent. Infinity counts as 2^128.
fn apart(x: f32) -> (i128, i32) {
    let field = (x.to_bits() >> 23 & 255) as i32;
    let fraction = i128::from(x.to_bits() & 0x7f_ffff);
    let mantissa = if field == 0 { fraction } else { fraction + (1 << 23) };
    (if x.is_sign_negative() { -mantissa } else { mantissa }, field.max(1) - 150)
}

/// Returns floor(2^bits n x), limited to `limit`.
fn floor_scaled(x: f32, n: i128, bits: i32, limit: i128) -> i128 {
    let (mantissa, exponent) = apart(x);
    let (product, exponent) = (mantissa * n, exponent + bits);
    if exponent > 60 {
        return product.signum() * limit;
    }
    let value = if exponent >= 0 { product << exponent } else { product >> (-exponent).min(127) };
    value.clamp(-limit, limit)
}

pub fn floor_float(inputs: &Inputs) -> i128 {
    let x = single(inputs, 0);
    if x.is_nan() { 0 } else { floor_scaled(x, value(inputs, 1), 8, 1 << 24) }
}

/// Returns x, y and z, or zero if one of them is not finite.
fn vector(inputs: &Inputs) -> [f64; 3] {
    let vector = [0, 1, 2].map(|n| f64::from(single(inputs, n)));
    if vector.iter().all(|c| c.is_finite()) { vector } else { [0.0; 3] }
}

pub fn face(inputs: &Inputs) -> i128 {
    let vector = vector(inputs);
    let largest = vector.iter().fold(0.0, |a: f64, c| a.max(c.abs()));
    let axis = vector.iter().position(|c| c.abs() == largest).unwrap();
    2 * axis as i128 + i128::from(vector[axis] < 0.0)
}

pub fn face_coordinate(inputs: &Inputs, u: bool) -> i128 {
    let [x, y, z] = vector(inputs);
    let (s, t, m) = match value(inputs, 3) {
        0 => (-z, -y, x),
        1 => (z, -y, -x),
        2 => (x, z, y),
        3 => (x, -z, -y),
        4 => (x, -y, z),
        _ => (-x, -y, -z),
    };
    if m == 0.0 {
        return 0;
    }
    // floor(128 size (s/m + 1)): the largest n with (n - 128 size) m <= 128 size s. Doubles hold both products exactly.
    let (minor, half) = (if u { s } else { t }, 128 * value(inputs, 4));
    let guess = (minor / m * half as f64).floor() as i128;
    let fits = |n: &i128| *n as f64 * m <= half as f64 * minor;
    half + (guess - 2..=guess + 2).rfind(fits).unwrap()
}

/// Returns a x + b y exactly, as numerator and exponent.
fn sum(terms: [(i128, f32); 2]) -> (i128, i32) {
    let terms = terms.map(|(factor, x)| {
        let (mantissa, exponent) = apart(x);
        (factor * mantissa, exponent)
    });
    let lowest = terms.iter().filter(|term| term.0 != 0).map(|term| term.1).min().unwrap_or(0);
    let sum = terms.iter().filter(|term| term.0 != 0).map(|(n, exponent)| n << (exponent - lowest));
    (sum.sum(), lowest)
}

pub fn bump_offset(inputs: &Inputs) -> i128 {
    let signed = |n: usize| f32::from(value(inputs, n) as u8 as i8);
    let sum = single(inputs, 0) * signed(2) + single(inputs, 1) * signed(3);
    if sum.is_nan() {
        return 0;
    }
    let (n, exponent) = apart(sum);
    let (n, exponent, limit) = (n * value(inputs, 4), exponent + 25, 1 << 50);
    let value = if exponent < 0 { n >> (-exponent).min(127) } else { n.saturating_mul(1 << exponent.min(90)) };
    value.clamp(-limit, limit)
}

pub fn luminance(inputs: &Inputs) -> i128 {
    let (n, exponent) = sum([(value(inputs, 1), single(inputs, 2)), (255, single(inputs, 3))]);
    let n = 4096 * value(inputs, 0).max(0) * n;
    let value = if exponent < 0 { n >> (-exponent).min(127) } else { n.saturating_mul(1 << exponent.min(90)) };
    value.div_euclid(255 * 255).clamp(0, 1 << 20)
}

/// SHD-1, DEP-3: returns the word of r, or of r/q if the numbers of q follow. The last input is the name of the format.
pub fn depth_word(inputs: &Inputs) -> i128 {
    let Some(((format, _), numbers)) = inputs.split_last() else { return 0 };
    let (r, q) = numbers.split_at(8.min(numbers.len()));
    let mut n = (numerator(r), value(r, 7) as i32);
    let mut d = if q.is_empty() { (value(r, 6), 0) } else { (numerator(q), value(q, 7) as i32) };
    if d.0 < 0 {
        (n.0, d.0) = (-n.0, -d.0);
    }
    let (bits, kept, bias) = match format.as_str() {
        "Z16" => (16, 0, 0),
        "Z24S8" => (24, 0, 0),
        "Z16F" => (16, 12, 7),
        _ => (24, 16, 127),
    };
    let full = (1 << bits) - 1;
    if n.0 <= 0 {
        return 0;
    }
    if d.0 == 0 {
        return full;
    }
    // Computes sixty bits of the quotient, one by one.
    let (mut quotient, mut rest, mut exponent) = (n.0 / d.0, n.0 % d.0, n.1 - d.1);
    while quotient >> 59 == 0 {
        rest *= 2;
        quotient = 2 * quotient + i128::from(rest >= d.0);
        rest %= d.0;
        exponent -= 1;
    }
    let top = 127 - quotient.leading_zeros() as i32 + exponent;
    if kept == 0 {
        return if top > 40 { full } else { (quotient >> (-exponent).clamp(0, 127)).min(full) };
    }
    let field = top + bias;
    let mantissa = quotient >> (127 - quotient.leading_zeros() as i32 - kept);
    match field {
        ..=0 => 0,
        beyond if beyond > if kept == 12 { 15 } else { 254 } => full,
        field => (i128::from(field) << kept) + mantissa - (1 << kept),
    }
}
