//! Computes the colours of lit vertices: VTX-5 and VTX-6, of finite numbers that stay far from the ends of the range.

use super::fog::{self, light as word};
use super::real::{Number, bits, shift};

/// Where a colour of the material comes from.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    Material,
    Diffuse,
    Specular,
}

/// A light: far away, or at a place, with the words of its cone if it has one (axis, offset, falloff).
#[derive(Clone, Copy, Debug)]
pub enum Light {
    Far { direction: [f32; 3], half: [f32; 3] },
    Near { position: [f32; 3], attenuation: [f32; 3], range: f32, cone: Option<([f32; 3], f32, [f32; 3])> },
}

/// Red of a material, and of the ambient, diffuse and specular colour of each light.
#[derive(Clone, Debug)]
pub struct Material {
    /// Emission, ambient, diffuse, specular.
    pub sources: [Source; 4],
    pub scene: f32,
    pub factor: f32,
    pub powers: [f32; 6],
    pub lights: Vec<(Light, [f32; 3])>,
    pub local_eye: bool,
}

const ZERO: Number = Number::ZERO;
const ONE: Number = Number { m: 1, e: 0 };

/// The unit that computes: its significant bits, and how many more a sum keeps of its terms.
#[derive(Clone, Copy)]
struct Unit {
    size: i32,
    guard: i32,
}

/// VTX-5
const TRANSFORM: Unit = Unit { size: 24, guard: 5 };
/// VTX-6: the part for vectors, and the part for single numbers.
const VECTORS: Unit = Unit { size: 14, guard: 5 };
const SINGLE: Unit = Unit { size: 14, guard: 0 };

/// FOG-1: returns a finite number as a word of the light unit.
fn to_word(x: Number) -> Number {
    match word(x.real() as f32) {
        fog::Light::Number(m, e) => Number { m, e },
        other => panic!("{other:?}"),
    }
}

/// Returns the size of a number without its last bits: its first `count` bits.
fn first_bits(x: Number, count: i32) -> i128 {
    shift(x.m.abs(), count - bits(x.m))
}

fn is_negative(x: Number) -> bool {
    x.m < 0
}

impl Unit {
    fn product(self, a: Number, b: Number) -> Number {
        a.times(b).cut(self.size)
    }

    fn sum(self, terms: &[Number]) -> Number {
        let Some(top) = terms.iter().filter_map(|term| term.exponent()).max() else { return ZERO };
        self.exact_sum(terms, top + 1 - self.size - self.guard)
    }

    /// The sum of terms that are cut to multiples of 2^grid.
    fn exact_sum(self, terms: &[Number], grid: i32) -> Number {
        let m = terms.iter().map(|term| shift(term.cut_at(grid).m, term.cut_at(grid).e - grid)).sum();
        Number { m, e: grid }.cut(self.size)
    }

    fn dot(self, a: [Number; 3], b: [Number; 3]) -> Number {
        self.sum(&[0, 1, 2].map(|k| self.product(a[k], b[k])))
    }
}

/// The middle of all mantissas in [1, 2) that share six bits with this one, in 128ths.
fn middle(x: Number) -> i128 {
    2 * first_bits(x, 7) + 1
}

/// VTX-6: 1/x by one step from floor(128 / c).
fn reciprocal(x: Number) -> Number {
    let first = (1 << 14) / middle(x);
    let second = (((1 << 21) - first * first_bits(x, 14)) * first) >> 14;
    // It has 13 bits, and the reciprocal of [1, 2) is at most 1.
    Number { m: x.m.signum() * second, e: 1 - x.e - bits(x.m) - 13 }
}

/// VTX-5: 1/sqrt x by two steps.
fn root(x: Number) -> Number {
    let power = x.e + bits(x.m) - 1;
    let odd = power.rem_euclid(2);
    let m = first_bits(x, 24) << odd;
    // s = floor(2^7 / sqrt c + 1/2) of the middle c in [1, 4).
    let c = middle(x) << odd;
    let first = (1..=127).rev().find(|s: &i128| (2 * s - 1) * (2 * s - 1) * c <= 1 << 23).unwrap_or(1);
    let second = (((3 << 37) - first * first * m) * first) >> 32;
    let third = (((3 << 49) - second * second * m) * second) >> 39;
    Number { m: third, e: -(power - odd) / 2 - 24 }
}

fn three(v: [f32; 3]) -> [Number; 3] {
    v.map(Number::of)
}

fn words(v: [f32; 3]) -> [Number; 3] {
    three(v).map(to_word)
}

/// Returns the direction of a vector, its length and its square.
fn direction(v: [Number; 3]) -> ([Number; 3], Number, Number) {
    let square = TRANSFORM.dot(v, v);
    if square.m == 0 {
        return ([ZERO; 3], ZERO, ZERO);
    }
    let root = root(square);
    (v.map(|c| TRANSFORM.product(c, root)), TRANSFORM.product(square, root), square)
}

/// VTX-6: x b + c, whose terms share a last bit: that of the larger of c and of a product of the factors' powers of two.
fn multiply_add(x: Number, b: Number, c: Number) -> Number {
    let (Some(first), Some(second)) = (x.exponent(), b.exponent()) else { return c };
    let top = c.exponent().map_or(first + second, |third| third.max(first + second));
    // The product keeps the bits below that the second factor brings.
    let (x, c) = (x.cut_at(top - second - 13), c.cut_at(top - 13));
    SINGLE.exact_sum(&[x.times(b), c], top - 26)
}

/// A numerator times a factor by 1/divisor; 0 below a numerator of 0.
fn quotient(numerator: Number, factor: Number, divisor: Number) -> Number {
    if is_negative(numerator) {
        return ZERO;
    }
    SINGLE.product(SINGLE.product(numerator, factor), reciprocal(divisor))
}

/// Returns the shares of ambient, diffuse and specular light.
fn shares(material: &Material, light: &Light, point: [f32; 3], normal: [f32; 3]) -> [Number; 3] {
    let normal = words(normal);
    let (to_light, attenuation) = match *light {
        Light::Far { direction, .. } => (words(direction), ONE),
        Light::Near { position, attenuation, range, cone } => {
            let (p, q) = (three(position), three(point));
            let (to_light, length, square) = direction([0, 1, 2].map(|k| TRANSFORM.sum(&[p[k], -q[k]])));
            let (length, square) = (to_word(length), to_word(square));
            if is_negative(SINGLE.sum(&[to_word(Number::of(range)), -length])) {
                return [ZERO; 3];
            }
            let mut share = reciprocal(VECTORS.dot(words(attenuation), [ONE, length, square]));
            if let Some((axis, offset, falloff)) = cone {
                let axis = three(axis);
                let [x, y, z] = [0, 1, 2].map(|k| TRANSFORM.product(to_light[k], axis[k]));
                let x = TRANSFORM.sum(&[x, y, z, Number::of(offset)]);
                let x = if x.real() > 1.0 { ONE } else { to_word(x) };
                let [a, b, c] = words(falloff);
                share = if is_negative(x) { ZERO } else { quotient(SINGLE.sum(&[x, a]), share, multiply_add(b, x, c)) };
            }
            (to_light.map(to_word), share)
        }
    };
    let facing = VECTORS.dot(normal, to_light);
    if is_negative(facing) {
        return [attenuation, ZERO, ZERO];
    }
    let [a, b, c, d, e, f] = material.powers.map(|p| to_word(Number::of(p)));
    let specular = match *light {
        Light::Far { half, .. } if !material.local_eye => {
            let x = VECTORS.dot(normal, words(half));
            quotient(SINGLE.sum(&[x, a]), attenuation, multiply_add(x, b, c))
        }
        _ => {
            let eye = if material.local_eye {
                direction(three(point).map(|c| -c)).0.map(to_word)
            } else {
                words([0.0, 0.0, -1.0])
            };
            let half = [0, 1, 2].map(|k| VECTORS.sum(&[eye[k], to_light[k]]));
            let along = VECTORS.dot(normal, half);
            if is_negative(along) {
                ZERO
            } else {
                let (x, y) = (SINGLE.product(along, along), VECTORS.dot(half, half));
                quotient(multiply_add(y, d, x), attenuation, multiply_add(y, f, SINGLE.product(x, e)))
            }
        }
    };
    [attenuation, VECTORS.product(attenuation, facing), specular]
}

/// Returns red of the primary and the secondary colour before their limits. A local eye stands at the origin. `given` are the vertex's.
pub fn red(material: &Material, is_separate: bool, point: [f32; 3], normal: [f32; 3], given: [f32; 2]) -> [Number; 2] {
    let [emission, ambient, diffuse, specular] = material.sources.map(|source| match source {
        Source::Material => None,
        Source::Diffuse => Some(to_word(Number::of(given[0]))),
        Source::Specular => Some(to_word(Number::of(given[1]))),
    });
    let [scene, factor] = [material.scene, material.factor].map(|number| to_word(Number::of(number)));
    let mut primary = match (emission, ambient) {
        (None, None) => scene,
        (Some(own), None) | (None, Some(own)) => VECTORS.sum(&[VECTORS.product(own, factor), scene]),
        (Some(emission), Some(own)) => VECTORS.sum(&[VECTORS.product(own, factor), emission]),
    };
    let mut secondary = ZERO;
    for (light, colors) in &material.lights {
        let shares = shares(material, light, point, normal);
        for (n, source) in [ambient, diffuse, specular].into_iter().enumerate() {
            let color = to_word(Number::of(colors[n]));
            // The last product enters the sum with all of its bits.
            let light = match source {
                None => shares[n].times(color),
                Some(own) => VECTORS.product(shares[n], color).times(own),
            };
            let total = if n == 2 && is_separate { &mut secondary } else { &mut primary };
            *total = VECTORS.sum(&[*total, light]);
        }
    }
    [primary, secondary]
}
