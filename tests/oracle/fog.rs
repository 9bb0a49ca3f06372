//! Computes the fog factor: FOG-1 to FOG-5, INT-5n, NUM-6.

use super::raster::{Sample, Setup};
use super::real::{Number, bits, factor_byte, floor_sum, shift, split};
use super::tally::{count, count_named};
use ninebit::state::{FogFunction, FogMode, Profile};

/// Returns the fog factor of a pixel, as a byte.
pub fn factor(setup: &Setup, sample: &Sample, function: Option<FogFunction>) -> i128 {
    let Some(function) = function else {
        // Without a function, the factors of the vertices are interpolated.
        let f = setup.number(sample, |v| if v.fog.is_nan() { 0.0 } else { v.fog.clamp(0.0, 1.0) });
        return factor_byte(f.floor(4096).clamp(0, 4096));
    };
    count_named(function.mode);
    let mut finite = setup.vertices.iter().all(|vertex| vertex.fog.is_finite());
    match function.mode {
        FogMode::Linear | FogMode::LinearAbs => {
            // INT-5n: if the vertices have the result e, the function is e - 1.
            let (p0, p1) = if function.per_vertex { (0.0, 1.0) } else { (function.p0, function.p1) };
            finite &= p0.is_finite() && p1.is_finite();
            if !finite {
                count("fog", "not finite");
                return 255;
            }
            factor_byte(in_4096ths(function.mode, (p0, p1), setup.number(sample, |v| v.fog).cut(24)))
        }
        mode if !finite => {
            count("fog", "not finite");
            if mode == FogMode::Exp { 255 } else { 0 }
        }
        // FOG-4: 4096 (e - 3/2) is limited far outside the range of the tables.
        mode => exponential(mode, setup.number(sample, |v| v.fog).floor(4096).clamp(-1 << 40, 1 << 40) - 6144),
    }
}

/// FOG-2: returns v, the linear factor in 4096ths, limited to 0..4096.
fn in_4096ths(mode: FogMode, (p0, p1): (f32, f32), d: Number) -> i128 {
    let (d, de) = (if mode == FogMode::LinearAbs { d.m.abs() } else { d.m }, d.e);
    let ((p0, e0), (p1, e1)) = (split(p0), split(p1));
    floor_sum(&[(p0, e0 + 12), (d * p1, de + e1 + 12), (-1, 12)]).clamp(0, 4096)
}

/// FOG-4: returns the fog byte for q.
pub fn exponential(mode: FogMode, q: i128) -> i128 {
    if mode == FogMode::Exp && q >= 0 {
        return 255;
    }
    let n = q.abs();
    if n >= 2048 {
        return 0;
    }
    let entry = |i: i128| {
        let exponent =
            if matches!(mode, FogMode::Exp | FogMode::ExpAbs) { -(i as f64) / 4.0 } else { -((i * i) as f64) / 128.0 };
        (255.0 * exponent.exp2() + 0.5).floor() as i128
    };
    let (i, w) = (n / 64, n % 64);
    (entry(i) * (64 - w) + entry(i + 1) * w + 32) / 64
}

/// FOG-1: a word of the light unit, which is m 2^e with at most 14 bits in m, infinite, or not a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    Number(i128, i32),
    Infinite { negative: bool },
    NotANumber,
}

/// FOG-1: converts a float to a word of the light unit.
pub fn light(f: f32) -> Light {
    if f.is_nan() {
        return Light::NotANumber;
    }
    if f.is_infinite() {
        return Light::Infinite { negative: f < 0.0 };
    }
    if f.abs() < f32::MIN_POSITIVE {
        return Light::Number(0, 0);
    }
    let (m, e) = split(f);
    let size = m.abs();
    let size = if size >> 10 & 255 == 255 { size } else { size + 512 };
    Light::Number(m.signum() * (size >> 10), e + 10)
}

/// FOG-3: truncates to 14 significant bits toward zero, within the range of single precision.
fn fourteen(m: i128, e: i32) -> Light {
    if m == 0 || bits(m) + e < -125 {
        return Light::Number(0, 0);
    }
    if bits(m) + e > 128 {
        return Light::Number(m.signum() * 0x3fff, 114);
    }
    let drop = (bits(m) - 14).max(0);
    Light::Number(m.signum() * (m.abs() >> drop), e + drop)
}

/// FOG-3: the product of two words, `mul14`.
pub fn product(a: Light, b: Light) -> Light {
    match (a, b) {
        (Light::NotANumber, _) | (_, Light::NotANumber) => Light::NotANumber,
        (Light::Number(0, _), _) | (_, Light::Number(0, _)) => Light::Number(0, 0),
        (Light::Number(a, e), Light::Number(b, f)) => fourteen(a * b, e + f),
        _ => Light::Infinite { negative: false },
    }
}

/// FOG-3: the sum of three words, `sum14`.
pub fn sum(terms: [Light; 3]) -> Light {
    if terms.contains(&Light::NotANumber) {
        return Light::NotANumber;
    }
    let mut numbers = Vec::new();
    for term in terms {
        match term {
            Light::Number(m, e) if m != 0 => numbers.push((m, e)),
            Light::Number(..) => {}
            _ => return Light::Infinite { negative: false },
        }
    }
    let Some(top) = numbers.iter().map(|(m, e)| bits(*m) - 1 + e).max() else { return Light::Number(0, 0) };
    let last = top - 18;
    let total: i128 = numbers.iter().map(|(m, e)| m.signum() * shift(m.abs(), e - last)).sum();
    fourteen(total, last)
}

/// Returns the value of a word as a float.
pub fn number(word: Light) -> f32 {
    match word {
        Light::Number(m, e) => (m as f64 * 2.0_f64.powi(e)) as f32,
        Light::Infinite { negative } => {
            if negative {
                f32::NEG_INFINITY
            } else {
                f32::INFINITY
            }
        }
        Light::NotANumber => f32::NAN,
    }
}

/// Returns the value that a vertex passes on for the coordinate d: d' (FOG-2), or e (FOG-3, INT-5n).
pub fn at_vertex(function: &FogFunction, profile: Profile, d: f32) -> f32 {
    let straight = matches!(function.mode, FogMode::Linear | FogMode::LinearAbs);
    if straight && !function.per_vertex {
        return number(light(d));
    }
    let [c0, c1, c2] = [function.p0, function.p1, function.p2].map(light);
    let e = number(sum([c0, product(c1, light(d)), product(c2, light(d * d))]));
    if profile == Profile::Nv10 && e.is_finite() {
        // INT-5n: bit 10 is a copy of bit 11.
        let word = e.to_bits();
        return f32::from_bits(word & !(1 << 10) | (word >> 11 & 1) << 10);
    }
    e
}
