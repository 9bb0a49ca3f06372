//! Computes where a unit samples: INT-4, INT-4t, TEX-11, TEX-12, TEX-13, TEX-15, and the coordinates of the texture shader.

use super::raster::{Sample, Setup};
use super::real::{align, bits, floor_div, floor_sum, shift, split};

/// TEX-15: the limit of 65536 texels, in 1/256 texel. It also applies to coordinates that the texture shader computes.
const LIMIT: i128 = 1 << 24;

/// The number m 2^e, as (m, e).
pub type Exact = (i128, i32);

/// The source of a unit's coordinates at one pixel.
#[derive(Clone, Debug)]
pub enum Place {
    /// s and t of a coordinate set, divided by q if q is not 1.
    Set(usize),
    /// s, t, r of a coordinate set as a direction.
    Direction(usize),
    /// s and t of a coordinate set, each moved by 1/128 of a number (TSH-7).
    Moved(usize, [Exact; 2]),
    /// Two bytes, and the divisor that makes them coordinates (TSH-6).
    Bytes([i128; 2], i128),
    /// s and t that the dot unit computes (TSH-4).
    Floats([f32; 2]),
    /// A direction that the dot unit computes.
    Vector([f32; 3]),
}

/// Coordinates on a face: sc and tc as `minor`, and for each of them |ma| in the same unit as `major`.
struct Projected {
    minor: [i128; 2],
    major: [i128; 2],
}

/// TEX-12: returns (sc, tc) and ma of a direction on a face.
fn project<T: Copy>(face: usize, [x, y, z]: [T; 3], minus: impl Fn(T) -> T) -> ([T; 2], T) {
    match face {
        0 => ([minus(z), minus(y)], x),
        1 => ([z, minus(y)], minus(x)),
        2 => ([x, z], y),
        3 => ([x, minus(z)], minus(y)),
        4 => ([x, minus(y)], z),
        _ => ([minus(x), minus(y)], minus(z)),
    }
}

/// TEX-12, TEX-13: returns the face of the component with the largest magnitude. X precedes Y, and Y precedes Z.
fn face_of<T: Copy + PartialOrd>([x, y, z]: [T; 3], [ax, ay, az]: [T; 3], zero: T) -> usize {
    let (axis, value) = if ax >= ay && ax >= az {
        (0, x)
    } else if ay >= az {
        (1, y)
    } else {
        (2, z)
    };
    2 * axis + usize::from(value < zero)
}

/// Returns two floats as integers of the same unit. If one is tiny compared with the other, only its sign is certain.
fn same_unit(a: f32, b: f32) -> [i128; 2] {
    let ((m, e), (n, f)) = (split(a), split(b));
    if e >= f { [m << (e - f).min(70), n] } else { [m, n << (f - e).min(70)] }
}

impl Setup {
    fn plane(&self, x: [f32; 3], size: u32) -> [i128; 3] {
        std::array::from_fn(|k| {
            let (m, e) = split(x[k]);
            shift(self.p[k] * 256 * i128::from(size) * m, e)
        })
    }

    fn component(&self, set: usize, n: usize) -> [f32; 3] {
        self.vertices.each_ref().map(|v| v.texture_coordinates[set][n])
    }

    /// TEX-15: returns nine products in 28 bits with a common exponent, truncated toward zero.
    fn three(&self, set: usize, which: [usize; 3]) -> [[i128; 3]; 3] {
        let parts: [(i128, i32); 9] = std::array::from_fn(|n| {
            let (m, e) = split(self.vertices[n % 3].texture_coordinates[set][which[n / 3]]);
            (self.p[n % 3] * m, e)
        });
        let sizes = align(parts.map(|(m, e)| (m.abs(), e)), 28);
        let nine: [i128; 9] = std::array::from_fn(|n| parts[n].0.signum() * sizes[n]);
        [0, 3, 6].map(|a| [nine[a], nine[a + 1], nine[a + 2]])
    }

    fn total(sample: &Sample, x: [i128; 3]) -> i128 {
        (0..3).map(|k| x[k] * sample.e[k]).sum()
    }

    /// INT-4t: returns on which side of a tie a number lies, in the direction of the weights that fall short. The formula also applies to
    /// earlier units at pixels of the quad that are not covered.
    fn lean(&self, sample: &Sample, x: [i128; 3]) -> i128 {
        if self.exact {
            return 0;
        }
        let (_, dominant) = self.weights(sample);
        [0, 2].into_iter().filter(|i| *i != dominant).map(|i| sample.e[i] * (x[i] * self.p[1] - self.p[i] * x[1])).sum()
    }

    /// INT-4t: returns 2^24 times the numerator of x with weights that fall short, as a whole number and a number of parts 1/P_1.
    ///
    /// Where weights 0 and 2 fall short, their edge functions count 2^24 - 1 times in place of 2^24 times, and vertex 1 has the remainder.
    fn short(&self, sample: &Sample, x: [i128; 3]) -> [i128; 2] {
        let (n, dominant) = self.weights(sample);
        let falls = |k: usize| i128::from(!self.exact && k != 1 && k != dominant);
        let whole = (0..3).map(|k| x[k] * sample.e[k] * ((1 << 24) - falls(k))).sum();
        [whole, x[1] * (0..3).map(|k| falls(k) * n[k]).sum::<i128>()]
    }

    /// Returns whether q is 1 at all vertices.
    fn is_plane(&self, set: usize) -> bool {
        self.component(set, 3) == [1.0; 3]
    }
}

impl Place {
    /// Returns the face, which is 0 except for cube maps, and the coordinates in 1/256 texel of a level with these sides. The sides of a
    /// rectangle count as 1.
    pub fn at(&self, setup: &Setup, sample: &Sample, size: [u32; 2]) -> (usize, [i128; 2]) {
        match self {
            Place::Set(set) if setup.is_plane(*set) => (0, [0, 1].map(|a| plane(setup, sample, *set, a, size[a]))),
            Place::Set(set) => {
                let [s, t, q] = setup.three(*set, [0, 1, 3]);
                (0, [ratio(setup, sample, s, q, size[0]), ratio(setup, sample, t, q, size[1])])
            }
            Place::Moved(set, by) => (0, [0, 1].map(|a| moved(setup, sample, *set, a, by[a], size[a]))),
            Place::Direction(set) => direction(setup, sample, setup.three(*set, [0, 1, 2]), size[0]),
            Place::Bytes(v, whole) => (0, [0, 1].map(|a| floor_div(256 * i128::from(size[a]) * v[a], *whole).0)),
            Place::Floats(f) => (0, [0, 1].map(|a| floor_float(f[a], 256 * i128::from(size[a])).clamp(-LIMIT, LIMIT))),
            Place::Vector(v) => {
                let Some(face) = vector_face(*v) else { return (0, [0, 0]) };
                let p = vector_on(*v, face);
                let scale = 128 * i128::from(size[0]);
                (face, [0, 1].map(|a| floor_div(scale * (p.minor[a] + p.major[a]), p.major[a]).0))
            }
        }
    }

    /// Returns another component of a coordinate set in the same way as [`Place::at`] returns s and t.
    pub fn along(&self, setup: &Setup, sample: &Sample, n: usize, size: u32) -> Option<i128> {
        let Place::Set(set) = self else { return None };
        if setup.is_plane(*set) {
            return Some(plane(setup, sample, *set, n, size));
        }
        let [r, q, _] = setup.three(*set, [n, 3, 3]);
        Some(ratio(setup, sample, r, q, size))
    }

    /// TEX-11: returns the face on which a quad is measured.
    pub fn face(&self, setup: &Setup, sample: &Sample) -> usize {
        match self {
            Place::Direction(set) => {
                let v = setup.three(*set, [0, 1, 2]).map(|x| Setup::total(sample, x));
                face_of(v, v.map(i128::abs), 0)
            }
            Place::Vector(v) => vector_face(*v).unwrap_or(0),
            _ => 0,
        }
    }

    /// TEX-11: returns coordinates in 2^-16 texel of level 0, without treatment of ties and for cube maps on the given face. Returns `None`
    /// if a denominator is not positive.
    pub fn fine(&self, setup: &Setup, sample: &Sample, size: [u32; 2], face: usize) -> Option<[i128; 2]> {
        let quotient = |n: i128, d: i128| (d > 0).then(|| floor_div(n, d).0);
        let scale = size.map(|n| i128::from(n) << 16);
        let both = |[u, v]: [Option<i128>; 2]| Some([u?, v?]);
        if sample.d <= 0 {
            return None;
        }
        match self {
            Place::Set(set) if setup.is_plane(*set) => both([0, 1].map(|a| {
                quotient(256 * Setup::total(sample, setup.plane(setup.component(*set, a), size[a])), sample.d)
            })),
            Place::Set(set) => {
                let [s, t, q] = setup.three(*set, [0, 1, 3]).map(|x| Setup::total(sample, x));
                both([quotient(scale[0] * s, q), quotient(scale[1] * t, q)])
            }
            Place::Moved(set, by) => both([0, 1].map(|a| {
                let total = 256 * Setup::total(sample, setup.plane(setup.component(*set, a), size[a]));
                moved_by(total, sample.d, 256 * offset(by[a], size[a]))
            })),
            Place::Direction(set) => {
                let v = setup.three(*set, [0, 1, 2]).map(|x| Setup::total(sample, x));
                let (minor, major) = project(face, v, |x| -x);
                both(minor.map(|sc| quotient((scale[0] >> 1) * (sc + major), major)))
            }
            Place::Bytes(v, whole) => both([0, 1].map(|a| quotient(scale[a] * v[a], *whole))),
            Place::Floats(f) => Some([0, 1].map(|a| floor_float(f[a], scale[a]))),
            Place::Vector(v) => {
                vector_face(*v)?;
                let p = vector_on(*v, face);
                both([0, 1].map(|a| quotient((scale[0] >> 1) * (p.minor[a] + p.major[a]), p.major[a])))
            }
        }
    }
}

/// INT-4, INT-4t: returns u = floor(sum G E / D); by the finite policy what TSH-7 moves by nothing.
fn plane(setup: &Setup, sample: &Sample, set: usize, axis: usize, size: u32) -> i128 {
    if setup.finite {
        return moved(setup, sample, set, axis, (0, 0), size);
    }
    let g = setup.plane(setup.component(set, axis), size);
    let (u, tie) = floor_div(Setup::total(sample, g), sample.d);
    if tie && setup.lean(sample, g) > 0 { u - 1 } else { u }
}

/// TEX-15, INT-4t: returns a ratio with weights that fall short.
fn ratio(setup: &Setup, sample: &Sample, s: [i128; 3], q: [i128; 3], size: u32) -> i128 {
    let [n, d] = [s, q].map(|x| {
        let [whole, part] = setup.short(sample, x);
        whole * setup.p[1] + part
    });
    if d == 0 {
        return n.signum() * LIMIT;
    }
    let (n, d) = (n * d.signum(), d.abs());
    // The fraction is multiplied bit by bit, so that no product exceeds 127 bits.
    let scale = 256 * i128::from(size);
    let (whole, part) = (n.div_euclid(d), n.rem_euclid(d));
    let (mut value, mut rest) = (0, 0);
    for bit in (0..24).rev() {
        rest = 2 * rest + (scale >> bit & 1) * part;
        value *= 2;
        // `rest` is below 3 d, so at most two subtractions replace a division.
        while rest >= d {
            rest -= d;
            value += 1;
        }
    }
    (value + whole.clamp(-2 * LIMIT, 2 * LIMIT) * scale).clamp(-LIMIT, LIMIT)
}

/// TSH-7: returns the offset in 2^-24 of 1/256 texel.
fn offset((m, e): Exact, size: u32) -> i128 {
    floor_sum(&[(m * i128::from(size), e + 25)])
}

/// Returns floor((total 2^24 + by D) / (D 2^24)), or `None` unless D > 0.
fn moved_by(total: i128, d: i128, by: i128) -> Option<i128> {
    if d <= 0 {
        return None;
    }
    let (whole, rest) = (total.div_euclid(d), total.rem_euclid(d));
    Some(whole + (by >> 24) + floor_div((rest << 24) + (by & 0xff_ffff) * d, d << 24).0)
}

/// TSH-7, INT-4t: returns s or t of a set with weights that fall short, moved by an offset. There is no division by q.
fn moved(setup: &Setup, sample: &Sample, set: usize, axis: usize, by: Exact, size: u32) -> i128 {
    let g = setup.plane(setup.component(set, axis), size);
    let ([whole, part], by) = (setup.short(sample, g), offset(by, size));
    // Both are in 2^-24 of 1/256 texel. Whole steps of the offset are added last.
    let (down, p) = (sample.d << 24, setup.p[1]);
    let sum = whole + (by & 0xff_ffff) * sample.d;
    let steps = sum.div_euclid(down) + (sum.rem_euclid(down) * p + part).div_euclid(down * p);
    ((by >> 24) + steps).clamp(-LIMIT, LIMIT)
}

/// TEX-12, TEX-13: returns the face and the coordinates of a direction. A tie is resolved by the numerator and the denominator together.
fn direction(setup: &Setup, sample: &Sample, three: [[i128; 3]; 3], size: u32) -> (usize, [i128; 2]) {
    let v = three.map(|x| Setup::total(sample, x));
    if v == [0; 3] {
        return (0, [0, 0]);
    }
    let face = face_of(v, v.map(i128::abs), 0);
    let (minor, major) = project(face, v, |x| -x);
    let (minor_plane, major_plane) = project(face, three, |x| x.map(|x| -x));
    let scale = 128 * i128::from(size);
    let u = [0, 1].map(|a| {
        let (value, tie) = floor_div(scale * (minor[a] + major), major);
        let sum: [i128; 3] = std::array::from_fn(|k| minor_plane[a][k] + major_plane[k]);
        let lean = || scale * setup.lean(sample, sum) - value * setup.lean(sample, major_plane);
        if tie && lean() > 0 { value - 1 } else { value }
    });
    (face, u)
}

/// TEX-13: returns the face of a direction of floats, or `None` for the zero vector and for components that are not finite.
fn vector_face(v: [f32; 3]) -> Option<usize> {
    (v.iter().all(|x| x.is_finite()) && v != [0.0; 3]).then(|| face_of(v, v.map(f32::abs), 0.0))
}

fn vector_on(v: [f32; 3], face: usize) -> Projected {
    let (minor, major) = project(face, v, |x| -x);
    let pairs = minor.map(|minor| same_unit(minor, major));
    Projected { minor: pairs.map(|p| p[0]), major: pairs.map(|p| p[1]) }
}

/// Returns floor(f * scale), limited for infinity and 0 for NaN.
fn floor_float(f: f32, scale: i128) -> i128 {
    if f.is_nan() {
        return 0;
    }
    if f.is_infinite() {
        return if f > 0.0 { 1 << 80 } else { -(1 << 80) };
    }
    let (m, e) = split(f);
    floor_sum(&[(m * scale, e)])
}

/// TEX-9 to TEX-11: returns the lod of a quad in 1/256, before bias and limits, from the coordinates of its top-left, right and lower
/// pixel.
pub fn lod(corners: [Option<[i128; 2]>; 3]) -> i128 {
    const LEAST: i128 = -32768;
    // Coordinates beyond 2^44 texels need not be told apart.
    let limited = corners.map(|c| c.map(|c| c.map(|c| c.clamp(-1 << 60, 1 << 60))));
    let [Some(left), Some(right), Some(lower)] = limited else { return LEAST };
    let square = |to: [i128; 2]| -> u128 { (0..2).map(|a| (to[a] - left[a]).unsigned_abs().pow(2)).sum() };
    let n = square(right).max(square(lower));
    debug_assert!(bits(n as i128) < 125);
    if n == 0 { LEAST } else { super::real::log2_in_128ths(n) - 128 * 32 }
}
