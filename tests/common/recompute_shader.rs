//! Recomputes the operations of the texture shader. Products in single precision are computed by the processor, everything else in exact fractions.

use super::{Number, weights};

type Inputs = [(String, Number)];

fn single(inputs: &Inputs, n: usize) -> f32 {
    assert_eq!(inputs[n].1.per_one, 0, "a single-precision number");
    f32::from_bits(inputs[n].1.value as u32)
}

fn bits(value: f32) -> Number {
    Number::new(if value.is_nan() { 0x7fc0_0000 } else { value.to_bits().into() }, 0)
}

fn value(inputs: &Inputs, n: usize) -> i128 {
    inputs[n].1.value
}

/// TSH-3: returns root(left / 2^30) as a numerator and a denominator.
fn root_in_pieces(left: i128) -> (i128, i128) {
    let (mut m, mut unit) = (left, 1 << 15);
    while m < 1 << 28 {
        (m, unit) = (4 * m, 2 * unit);
    }
    let width = if m < 1 << 29 { 1 << 23 } else { 1 << 24 };
    let start = m - m % width;
    // The largest r with r^2 <= n 2^30, bit by bit: the root of n / 2^30 with 30 fraction bits.
    let root = |n: i128| {
        let fits = |r: i128| r * r <= n << 30;
        (0..=30).rev().fold(0, |r: i128, bit| if fits(r | 1 << bit) { r | 1 << bit } else { r })
    };
    let (low, high) = (root(start), root(start + width));
    let along = 1024 * (m - start) / width;
    ((256 * (low >> 12) + ((high - low) >> 14) * along) >> 11, unit)
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
            let left = 32768 * 32768 - signed_half(0).pow(2) - signed_half(2).pow(2);
            let (root, unit) = if left > 0 { root_in_pieces(left) } else { (0, 1) };
            quotient(root, unit)
        }
        _ => bits(1.0),
    }
}

pub fn float(operation: &str, inputs: &Inputs) -> Number {
    let f = |n: usize| single(inputs, n);
    bits(match operation {
        "float_product" => f(0) * f(1),
        "float_sum" => weights::cut_sum([0, 1, 2].map(f)),
        "float_dot" => weights::cut_sum([0, 2, 4].map(|n| f(n) * f(n + 1))),
        "float_double" => 2.0 * f(0),
        _ => weights::cut_sum([f(0) * f(1), -(f(2) * f(3)), 0.0]),
    })
}

/// Splits x into mantissa 2^exponent. Infinity counts as 2^128.
pub fn apart(x: f32) -> (i128, i32) {
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

pub fn face_coordinate(inputs: &Inputs, u: bool) -> Number {
    let is_finite = (0..3).all(|n| single(inputs, n).is_finite());
    if is_finite { weights::face_coordinate(inputs, u, 256) } else { Number::new(0, 256) }
}

/// TEX-20: returns the coordinate of a direction of the dot unit on a two-dimensional image.
pub fn on_plane(inputs: &Inputs, u: bool) -> Number {
    let is_finite = (0..3).all(|n| single(inputs, n).is_finite());
    if is_finite { weights::on_plane(inputs, u, 256) } else { Number::new(if u { -1 << 24 } else { 1 << 24 }, 256) }
}

/// TEX-20: returns the end of a face that a sign chooses.
pub fn end(inputs: &Inputs, u: bool) -> i128 {
    let x = single(inputs, 0);
    let is_last = if u { x < 0.0 } else { x > 0.0 };
    if is_last { 256 * value(inputs, 1) } else { 0 }
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

pub fn bump_offset(inputs: &Inputs) -> Number {
    let signed = |n: usize| f32::from(value(inputs, n) as u8 as i8);
    bits(single(inputs, 0) * signed(2) + single(inputs, 1) * signed(3))
}

pub fn luminance(inputs: &Inputs) -> i128 {
    let (n, exponent) = sum([(value(inputs, 1), single(inputs, 2)), (255, single(inputs, 3))]);
    let n = 4096 * value(inputs, 0).max(0) * n;
    let value = if exponent < 0 { n >> (-exponent).min(127) } else { n.saturating_mul(1 << exponent.min(90)) };
    value.div_euclid(255 * 255).clamp(0, 1 << 20)
}
