//! Computes the fog factor: FOG-1 to FOG-5, INT-5n, NUM-6.

use super::raster::{Sample, Setup};
use super::real::{bits, factor_byte, floor_div, floor_sum, shift, split};
use super::tally::{count, count_named};
use ninebit::state::{FogFunction, FogMode, Profile};

/// Returns the fog factor of a pixel, as a byte.
pub fn factor(setup: &Setup, sample: &Sample, function: Option<FogFunction>) -> i128 {
    let Some(function) = function else {
        // Without a function, the factors of the vertices are interpolated.
        let sum: i128 = (0..3)
            .map(|k| {
                let given = setup.vertices[k].fog;
                let (m, e) = split(if given.is_nan() { 0.0 } else { given.clamp(0.0, 1.0) });
                shift(setup.p[k] * 4096 * m, e) * sample.e[k]
            })
            .sum();
        return factor_byte(floor_div(sum, sample.d).0.clamp(0, 4096));
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
            factor_byte(in_4096ths(function.mode, (p0, p1), coordinate(setup, sample)))
        }
        mode if !finite => {
            count("fog", "not finite");
            if mode == FogMode::Exp { 255 } else { 0 }
        }
        mode => exponential(mode, steps(setup, sample)),
    }
}

/// FOG-2: returns the fog coordinate, truncated to 24 significant bits, as m 2^e.
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

/// FOG-2: returns v, the linear factor in 4096ths, limited to 0..4096.
fn in_4096ths(mode: FogMode, (p0, p1): (f32, f32), (d, de): (i128, i32)) -> i128 {
    let d = if mode == FogMode::LinearAbs { d.abs() } else { d };
    let ((p0, e0), (p1, e1)) = (split(p0), split(p1));
    floor_sum(&[(p0, e0 + 12), (d * p1, de + e1 + 12), (-1, 12)]).clamp(0, 4096)
}

/// FOG-4: returns q, with the tie of INT-4t. It is limited far outside the range of the tables.
fn steps(setup: &Setup, sample: &Sample) -> i128 {
    let (g, e) = setup.attribute_numbers(|v| v.fog);
    let sum: i128 = (0..3).map(|k| g[k] * sample.e[k]).sum();
    let up = e + 12;
    let (floor, tie) = if up > 0 {
        if sum != 0 && bits(sum) + up > 126 {
            (sum.signum() << 40, false)
        } else {
            floor_div(sum << up.min(126), sample.d)
        }
    } else {
        let (whole, tie) = floor_div(sum, sample.d);
        let floor = shift(whole, up);
        (floor, tie && (up == 0 || whole == 0 || (up > -127 && floor << -up == whole)))
    };
    let lowered = tie && !setup.exact && {
        let (_, dominant) = setup.weights(sample);
        let way: i128 = [0, 2]
            .into_iter()
            .filter(|i| *i != dominant)
            .map(|i| (g[i] * setup.p[1] - setup.p[i] * g[1]) * sample.e[i])
            .sum();
        way > 0
    };
    if lowered {
        count("fog", "tie lowered");
    }
    floor.clamp(-1 << 40, 1 << 40) - i128::from(lowered) - 6144
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
