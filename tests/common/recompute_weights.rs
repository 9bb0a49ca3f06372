//! Recomputes weights, and the numbers that are interpolated by them, in whole numbers with a power of two.

use super::{Number, shader};
use std::cmp::Ordering;

type Inputs = [(String, Number)];

/// The number m 2^e.
#[derive(Clone, Copy, Debug)]
pub struct Exact {
    pub m: i128,
    pub e: i32,
}

impl Exact {
    /// Converts an operand, which may be in binary32.
    pub fn new(n: Number) -> Exact {
        if n.per_one == 0 {
            let (m, e) = shader::apart(f32::from_bits(n.value as u32));
            return Exact { m, e }.odd();
        }
        // Units of these numbers are powers of two.
        Exact { m: n.value, e: n.exponent - n.per_one.ilog2() as i32 }.odd()
    }

    /// Strips zeros, so that equal numbers have equal parts.
    fn odd(mut self) -> Exact {
        while self.m != 0 && self.m % 2 == 0 {
            (self.m, self.e) = (self.m / 2, self.e + 1);
        }
        if self.m == 0 { Exact { m: 0, e: 0 } } else { self }
    }

    pub fn is_equal(self, other: Exact) -> bool {
        let (a, b) = (self.odd(), other.odd());
        (a.m, a.e) == (b.m, b.e)
    }

    fn number(self) -> Number {
        let Exact { m, e } = self.odd();
        Number { value: m, per_one: 1, exponent: e }
    }

    /// Returns the place of the first bit.
    fn first(self) -> i32 {
        self.m.unsigned_abs().ilog2() as i32 + self.e
    }

    /// Cuts the number to a multiple of 2^place.
    fn cut_at(self, place: i32) -> Exact {
        let down = place - self.e;
        if down <= 0 || self.m == 0 {
            return self;
        }
        let kept = if down > 126 { 0 } else { self.m / (1 << down) };
        Exact { m: kept, e: place }
    }

    fn cut(self, bits: i32) -> Exact {
        if self.m == 0 { self } else { self.cut_at(self.first() - bits + 1) }
    }

    fn times(self, other: Exact) -> Exact {
        Exact { m: self.m * other.m, e: self.e + other.e }
    }

    fn plus(self, other: Exact) -> Exact {
        if self.m == 0 || other.m == 0 {
            return if self.m == 0 { other } else { self };
        }
        let e = self.e.min(other.e);
        Exact { m: (self.m << (self.e - e)) + (other.m << (other.e - e)), e }
    }

    fn minus(self, other: Exact) -> Exact {
        self.plus(Exact { m: -other.m, ..other })
    }

    /// Compares magnitudes.
    fn larger(self, other: Exact) -> Ordering {
        match (self.m, other.m) {
            (0, 0) => Ordering::Equal,
            (0, _) => Ordering::Less,
            (_, 0) => Ordering::Greater,
            _ => {
                let at = |n: Exact| n.m.unsigned_abs() << (100 - n.m.unsigned_abs().ilog2());
                self.first().cmp(&other.first()).then(at(self).cmp(&at(other)))
            }
        }
    }
}

/// Returns the place of the last of `bits` bits of the largest number, or `None` if all are 0.
fn last_bit(terms: &[Exact], bits: i32) -> Option<i32> {
    terms.iter().filter(|term| term.m != 0).map(|term| term.first()).max().map(|first| first - bits + 1)
}

/// WGT-1 (3): returns R.
fn reciprocal(x: Exact) -> Exact {
    let Exact { m, e: power } = x.odd();
    let (m, sign) = (m.abs(), m.signum());
    if m == 1 {
        return Exact { m: sign, e: -power };
    }
    let s = m.ilog2() as i32;
    let n = Exact { m, e: -s };
    let two_less = |n: Exact| Exact { m: 2, e: 0 }.minus(n);
    let c = 2 * ((m << 7) >> s) + 1;
    let first = Exact { m: (65536 + c) / (2 * c), e: -7 };
    let second = two_less(first.times(n.cut_at(-14))).times(first);
    let second = second.plus(Exact { m: 1, e: -16 }).cut_at(-15);
    let third = two_less(second.times(n)).cut_at(-30).times(second).cut_at(-29);
    Exact { m: sign * third.m, e: third.e - s - power }
}

/// TSH-4: returns the sum of three floats, each cut at the 24th bit of the largest, cut to 24 bits. One that is not finite makes it a sum of doubles.
pub fn cut_sum(terms: [f32; 3]) -> f32 {
    if terms.iter().any(|term| !term.is_finite()) {
        return terms.iter().map(|term| f64::from(*term)).sum::<f64>() as f32;
    }
    let x = terms.map(|term| {
        let (m, e) = shader::apart(term);
        Exact { m, e }.odd()
    });
    let Some(place) = last_bit(&x, 24) else { return 0.0 };
    let Exact { m, e } = x.iter().fold(Exact { m: 0, e: 0 }, |sum, term| sum.plus(term.cut_at(place))).cut(24);
    (m as f64 * 2.0_f64.powi(e)) as f32
}

pub fn number(operation: &str, inputs: &Inputs) -> Number {
    let x: Vec<Exact> = inputs.iter().map(|input| Exact::new(input.1)).collect();
    let one = Exact { m: 1, e: 0 };
    let result = match operation {
        "cut_24" => x[0].cut(24),
        "cut_24_product" => x[0].cut(24).times(x[1]).cut(24),
        "edge_sum" => {
            let place = last_bit(&x, 29).unwrap_or(0);
            let sum = x.iter().fold(Exact { m: 0, e: 0 }, |sum, term| sum.plus(term.cut_at(place)));
            if sum.m == 0 { Exact { m: 1, e: place } } else { sum }
        }
        "reciprocal" => reciprocal(x[0]),
        "rest_24" => {
            let rest = one.minus(x[0]).minus(x[1]);
            let cut = rest.cut(24);
            if cut.is_equal(rest) { cut } else { Exact { m: cut.m + rest.m.signum(), ..cut } }
        }
        "number" => x[0],
        "number_product" => x[0].times(x[1]),
        "align_24" => last_bit(&x, 24).map_or(x[0], |place| x[0].cut_at(place)),
        "number_sum" => x[0].plus(x[1]).plus(x[2]),
        _ => {
            let f = |k: usize| f32::from_bits(inputs[k].1.value as u32);
            let difference = (f(0) - f(1)).clamp(f32::MIN, f32::MAX);
            let kept = if difference.abs() < f32::MIN_POSITIVE { 0.0 } else { difference };
            return Number::new(kept.to_bits().into(), 0);
        }
    };
    result.number()
}

/// TEX-15: returns x/y for a y other than 0.
fn divided(x: Exact, y: Exact) -> Exact {
    x.cut(24).times(reciprocal(y)).cut(24)
}

/// Returns floor(scale x) or floor(scale x / y), limited, as so many parts of 1. A division by 0 is infinite, and 0/0 is 0.
pub fn floor(of: &[Number], scale: i128, per_one: i128, limit: i128) -> Number {
    let one = Exact { m: 1, e: 0 };
    let (x, y) = match (Exact::new(of[0]), of.get(1).map(|y| Exact::new(*y))) {
        (x, Some(y)) if y.m != 0 => (divided(x, y), one),
        (x, y) => (x, y.unwrap_or(one)),
    };
    Number::new(quotient(Exact { m: x.m * scale, e: x.e }, y, limit), per_one)
}

/// Returns scale x toward zero, as so many parts of 1.
pub fn toward_zero(x: Number, scale: i128) -> Number {
    let x = Exact::new(x);
    let magnitude = quotient(Exact { m: x.m.abs() * scale, e: x.e }, Exact { m: 1, e: 0 }, i128::MAX);
    Number::new(magnitude * x.m.signum(), scale)
}

/// Returns floor(x / y), limited.
fn quotient(x: Exact, y: Exact, limit: i128) -> i128 {
    if y.m == 0 || x.m == 0 {
        return limit * x.m.signum();
    }
    let (n, d, e) = (x.m * y.m.signum(), y.m.abs(), x.e - y.e);
    let bits = |n: i128| 128 - n.unsigned_abs().leading_zeros() as i32;
    if bits(n) - bits(d) + e > 64 {
        return limit * n.signum();
    }
    // A quotient below 1/2 has the floor 0 or -1.
    let floor = if e >= 0 { (n << e).div_euclid(d) } else { n.div_euclid(d << (-e).min(bits(n) - bits(d) + 2).max(0)) };
    floor.clamp(-limit, limit)
}

/// TSH-7: returns floor(256 size (s + offset / 128)).
pub fn moved(inputs: &Inputs) -> Number {
    let offset = f32::from_bits(inputs[1].1.value as u32);
    let s = Exact::new(inputs[0].1);
    let limit = 1_i128 << 24;
    let by = if offset.is_nan() { Exact { m: 0, e: 0 } } else { Exact::new(inputs[1].1) };
    let value = sum(s, Exact { e: by.e - 7, ..by }, 256 * inputs[2].1.value, limit);
    Number::new(value, 256)
}

/// Returns floor(scale (a + b)), limited. The scale is a power of two.
fn sum(a: Exact, b: Exact, scale: i128, limit: i128) -> i128 {
    let (large, small) = if a.larger(b).is_lt() { (b, a) } else { (a, b) };
    let total = if small.m == 0 || large.first() - small.first() <= 75 {
        large.plus(small)
    } else if large.first() > 60 {
        return limit * large.m.signum();
    } else {
        // Far below the last bit of the other, and below every step, only the sign counts.
        large.plus(Exact { m: small.m.signum(), e: large.e.min(-30) - 2 })
    };
    quotient(Exact { e: total.e + scale.ilog2() as i32, ..total }, Exact { m: 1, e: 0 }, limit)
}

/// FOG-2: returns floor(4096 (p0 + p1 d - 1)), limited to 0..4096.
pub fn fog_line(inputs: &Inputs, absolute: bool) -> Number {
    let [p0, p1, d] = [0, 1, 2].map(|k| Exact::new(inputs[k].1));
    let d = if absolute { Exact { m: d.m.abs(), ..d } } else { d };
    let value = sum(p0, p1.times(d), 4096, 1 << 40) - 4096;
    Number::new(value.clamp(0, 4096), 4096)
}

/// Returns the index of the face that a direction meets.
pub fn face(inputs: &Inputs) -> i128 {
    let d = [0, 1, 2].map(|k| Exact::new(inputs[k].1));
    let mut axis = 0;
    for k in [1, 2] {
        if d[k].larger(d[axis]).is_gt() {
            axis = k;
        }
    }
    2 * axis as i128 + i128::from(d[axis].m < 0)
}

/// Returns floor(per_one size (1 + q) / 2) of q = s/m on the face of input 3.
pub fn face_coordinate(inputs: &Inputs, u: bool, per_one: i128) -> Number {
    let [x, y, z] = [0, 1, 2].map(|k| Exact::new(inputs[k].1));
    let minus = |n: Exact| Exact { m: -n.m, ..n };
    let (s, t, m) = match inputs[3].1.value {
        0 => (minus(z), minus(y), x),
        1 => (z, minus(y), minus(x)),
        2 => (x, z, y),
        3 => (x, minus(z), minus(y)),
        4 => (x, minus(y), z),
        _ => (minus(x), minus(y), minus(z)),
    };
    let (minor, half) = (if u { s } else { t }, inputs[4].1.value * per_one / 2);
    if m.m == 0 {
        return Number::new(0, per_one);
    }
    let q = divided(minor, m);
    Number::new(half + quotient(Exact { m: q.m * half, e: q.e }, Exact { m: 1, e: 0 }, 1 << 61), per_one)
}

/// TEX-20: returns floor(per_one size s / m), s negated for v, in the direction and on the face of the inputs.
pub fn on_plane(inputs: &Inputs, u: bool, per_one: i128) -> Number {
    let [x, y, z] = [0, 1, 2].map(|k| Exact::new(inputs[k].1));
    let minus = |n: Exact| Exact { m: -n.m, ..n };
    let (s, t, m) = match inputs[3].1.value {
        0 => (minus(z), y, x),
        1 => (z, y, minus(x)),
        2 => (x, minus(z), y),
        3 => (x, z, minus(y)),
        4 => (x, y, z),
        _ => (minus(x), y, minus(z)),
    };
    if m.m == 0 {
        return Number::new(if u { -1 << 24 } else { 1 << 24 }, per_one);
    }
    let minor = if u { s } else { t };
    let q = divided(minor, m);
    Number::new(
        quotient(Exact { m: q.m * inputs[4].1.value * per_one, e: q.e }, Exact { m: 1, e: 0 }, 1 << 61),
        per_one,
    )
}

/// TEX-20: returns floor(per_one size (1 + s / q) / 2), for v of 1 - t / q. Without a q it is 1.
pub fn on_face(inputs: &Inputs, u: bool, per_one: i128) -> Number {
    let ((_, size), numbers) =
        inputs.split_last().map(|(last, rest)| (last.clone(), rest)).unwrap_or_else(|| panic!("no size"));
    let half = size.value * per_one / 2;
    let x = Exact::new(numbers[0].1);
    let x = Exact { m: if u { x.m } else { -x.m }, e: x.e };
    let limit = if per_one == 256 { 1 << 23 } else { 1 << 60 };
    let on = |x: Exact| half + quotient(Exact { m: x.m * half, e: x.e }, Exact { m: 1, e: 0 }, limit);
    let value = match numbers.get(1).map(|q| Exact::new(q.1)) {
        None => on(x),
        Some(q) if q.m == 0 => half + limit * x.m.signum(),
        Some(q) => on(divided(x, q)),
    };
    Number::new(value, per_one)
}

/// Returns the single-precision number nearest to a number of at most 53 bits, which a double holds.
pub fn nearest_float(n: Number) -> Number {
    let Exact { m, e } = Exact::new(n);
    let double = m as f64 * 2.0_f64.powi(e.max(-1000));
    Number::new((double as f32).to_bits().into(), 0)
}

/// SHD-1, DEP-3: returns the word of r, or of r/q if q follows. The last input is the name of the format.
pub fn depth_word(inputs: &Inputs) -> i128 {
    let Some(((format, _), numbers)) = inputs.split_last() else { return 0 };
    let r = Exact::new(numbers[0].1);
    let q = numbers.get(1).map_or(Exact { m: 1, e: 0 }, |q| Exact::new(q.1));
    let (bits, kept, bias) = match format.as_str() {
        "Z16" => (16, 0, 0),
        "Z24S8" => (24, 0, 0),
        "Z16F" => (16, 12, 7),
        _ => (24, 16, 127),
    };
    let full = (1 << bits) - 1;
    if r.m * q.m.signum() < 0 || r.m == 0 || (q.m == 0 && r.m < 0) {
        return 0;
    }
    if q.m == 0 {
        return full;
    }
    // 70 bits and more of the quotient.
    let quotient = Exact { m: (r.m.abs() << 96) / q.m.abs(), e: r.e - 96 - q.e };
    let top = quotient.first();
    if kept == 0 {
        return if top > 40 { full } else { (quotient.m >> (-quotient.e).clamp(0, 127)).min(full) };
    }
    match top + bias {
        ..=0 => 0,
        beyond if beyond > if kept == 12 { 15 } else { 254 } => full,
        field => (i128::from(field) << kept) + (quotient.m >> (quotient.m.ilog2() as i32 - kept)) - (1 << kept),
    }
}
