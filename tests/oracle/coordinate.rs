//! Computes where a unit samples: INT-4, TEX-11, TEX-12, TEX-13, TEX-15, TEX-20, and the coordinates of the texture shader.

use super::raster::{Sample, Setup};
use super::real::{Number, bits, floor_div, floor_sum};
use super::weights::reciprocal;

/// INT-4: the limit of 65536 texels, in 1/256 texel. It also applies to coordinates that the texture shader computes.
const LIMIT: i128 = 1 << 24;

/// The source of a unit's coordinates at one pixel.
#[derive(Clone, Debug)]
pub enum Place {
    /// s and t of a coordinate set, divided by q.
    Set(usize),
    /// s, t, r of a coordinate set as a direction.
    Direction(usize),
    /// s and t of a coordinate set, each moved by 1/128 of a number (TSH-7).
    Moved(usize, [Number; 2]),
    /// Two bytes, and the divisor that makes them coordinates (TSH-6).
    Bytes([i128; 2], i128),
    /// s and t that the dot unit computes (TSH-4).
    Floats([f32; 2]),
    /// A direction that the dot unit computes.
    Vector([f32; 3]),
    /// TEX-20: s and t as of `Set`, of the first layer of a volume.
    Layer(usize),
    /// TEX-20: s and t as of `Set`, on face +X of a cube map.
    Face(usize),
    /// TEX-20: a direction into an image of two dimensions, of a coordinate set or of the dot unit.
    Plane(usize),
    PlaneVector([f32; 3]),
    /// TEX-20: ends of face +X by the signs of numbers of the dot unit.
    Ends([f32; 2]),
    /// PNT-2: the pixel's distances from a point in 1/16 pixel, and the point's size in 1/8 pixel.
    Sprite([i128; 2], i128),
}

/// PNT-2: returns floor(scale (1/2 + d / 2n)), where d / 2n is a little less if d is above 0 and n has more than one bit.
fn sprite(d: i128, n: i128, scale: i128) -> i128 {
    if n == 0 {
        return scale.div_euclid(2);
    }
    let less = i128::from(d > 0 && n.count_ones() > 1);
    (4 * scale * (n + d) - less).div_euclid(8 * n)
}

/// TEX-12: returns (sc, tc) and ma of a direction on a face.
fn project(face: usize, [x, y, z]: [Number; 3]) -> ([Number; 2], Number) {
    match face {
        0 => ([-z, -y], x),
        1 => ([z, -y], -x),
        2 => ([x, z], y),
        3 => ([x, -z], -y),
        4 => ([x, -y], z),
        _ => ([-x, -y], -z),
    }
}

/// TEX-12, TEX-13: returns the face of the component with the largest magnitude. X precedes Y, and Y precedes Z.
fn face_of(v: [Number; 3]) -> usize {
    let [x, y, z] = v.map(Number::real);
    let [ax, ay, az] = [x, y, z].map(f64::abs);
    let (axis, value) = if ax >= ay && ax >= az {
        (0, x)
    } else if ay >= az {
        (1, y)
    } else {
        (2, z)
    };
    2 * axis + usize::from(value < 0.0)
}

impl Setup {
    fn component(&self, sample: &Sample, set: usize, n: usize) -> Number {
        self.number(sample, |v| v.texture_coordinates[set][n])
    }

    fn vector(&self, sample: &Sample, set: usize) -> [Number; 3] {
        [0, 1, 2].map(|n| self.component(sample, set, n))
    }

    /// TEX-15: returns q, or `None` where it is 1 at the vertices (INT-4).
    fn q(&self, sample: &Sample, set: usize) -> Option<Number> {
        let is_one = self.vertices.iter().all(|vertex| vertex.texture_coordinates[set][3] == 1.0);
        (!is_one).then(|| self.component(sample, set, 3))
    }

    fn plane(&self, sample: &Sample, set: usize) -> [Number; 2] {
        [0, 1].map(|n| self.component(sample, set, n))
    }
}

impl Place {
    /// Returns the face, which is 0 except for cube maps, and the coordinates in 1/256 texel of a level with these sides. The sides of a
    /// rectangle count as 1.
    pub fn at(&self, setup: &Setup, sample: &Sample, size: [u32; 2]) -> (usize, [i128; 2]) {
        match self {
            Place::Set(set) | Place::Layer(set) => {
                let (st, q) = (setup.plane(sample, *set), setup.q(sample, *set));
                (0, [0, 1].map(|a| ratio(st[a], q, size[a])))
            }
            Place::Moved(set, by) => {
                (0, [0, 1].map(|a| limited(moved(setup.component(sample, *set, a), by[a], 256 * i128::from(size[a])))))
            }
            Place::Direction(set) => on_face(setup.vector(sample, *set), size[0]),
            Place::Bytes(v, whole) => (0, [0, 1].map(|a| floor_div(256 * i128::from(size[a]) * v[a], *whole).0)),
            Place::Floats(f) => (0, [0, 1].map(|a| limited(Number::of(f[a]).floor(256 * i128::from(size[a]))))),
            Place::Vector(v) => finite(*v).map_or((0, [0, 0]), |v| on_face(v, size[0])),
            Place::Sprite(d, n) => (0, [0, 1].map(|a| sprite(d[a], *n, 256 * i128::from(size[a])))),
            Place::Face(set) => {
                let ([s, t], half) = (setup.plane(sample, *set), 128 * i128::from(size[0]));
                let q = setup.q(sample, *set);
                let on = |n: Number| match q {
                    Some(q) if q.m == 0 => n.m.signum() << 23,
                    q => over(n, q).floor(half).clamp(-1 << 23, 1 << 23),
                };
                (0, [half + on(s), half + on(-t)])
            }
            Place::Plane(set) => (0, on_plane(setup.vector(sample, *set), size)),
            Place::PlaneVector(v) => (0, finite(*v).map_or([-LIMIT, LIMIT], |v| on_plane(v, size))),
            Place::Ends(f) => (0, ends(*f).map(|end| 256 * i128::from(size[0]) * end)),
        }
    }

    /// Returns another component of a coordinate set in the same way as [`Place::at`] returns s and t.
    pub fn along(&self, setup: &Setup, sample: &Sample, n: usize, size: u32) -> Option<i128> {
        let Place::Set(set) = self else { return None };
        Some(ratio(setup.component(sample, *set, n), setup.q(sample, *set), size))
    }

    /// TEX-11: returns the face on which a quad is measured.
    pub fn face(&self, setup: &Setup, sample: &Sample) -> usize {
        match self {
            Place::Direction(set) | Place::Plane(set) => face_of(setup.vector(sample, *set)),
            Place::Vector(v) | Place::PlaneVector(v) => finite(*v).map_or(0, face_of),
            _ => 0,
        }
    }

    /// TEX-11: returns coordinates in 2^-16 texel of level 0, for cube maps on the given face. Returns `None` if a denominator is not
    /// positive.
    pub fn fine(&self, setup: &Setup, sample: &Sample, size: [u32; 2], face: usize) -> Option<[i128; 2]> {
        let scale = size.map(|n| i128::from(n) << 16);
        let on = |v: [Number; 3]| {
            let (minor, major) = project(face, v);
            (major.m > 0).then(|| minor.map(|sc| across(sc, major, scale[0] >> 1)))
        };
        let flat = |v: [Number; 3]| {
            let ([sc, tc], major) = project(face, v);
            (major.m > 0).then(|| [quotient(sc, major).floor(scale[0]), quotient(-tc, major).floor(scale[1])])
        };
        match self {
            Place::Face(set) => {
                let ([s, t], half, q) = (setup.plane(sample, *set), scale[0] >> 1, setup.q(sample, *set));
                q.is_none_or(|q| q.m > 0).then(|| [s, -t].map(|n| half + over(n, q).floor(half)))
            }
            Place::Plane(set) => flat(setup.vector(sample, *set)),
            Place::PlaneVector(v) => flat(finite(*v)?),
            Place::Ends(f) => Some(ends(*f).map(|end| scale[0] * end)),
            Place::Set(set) | Place::Layer(set) => {
                let (st, q) = (setup.plane(sample, *set), setup.q(sample, *set));
                q.is_none_or(|q| q.m > 0).then(|| [0, 1].map(|a| over(st[a], q).floor(scale[a])))
            }
            Place::Moved(set, by) => Some([0, 1].map(|a| moved(setup.component(sample, *set, a), by[a], scale[a]))),
            Place::Direction(set) => on(setup.vector(sample, *set)),
            Place::Bytes(v, whole) => Some([0, 1].map(|a| floor_div(scale[a] * v[a], *whole).0)),
            Place::Floats(f) => Some([0, 1].map(|a| Number::of(f[a]).floor(scale[a]))),
            Place::Vector(v) => on(finite(*v)?),
            Place::Sprite(d, n) => Some([0, 1].map(|a| sprite(d[a], *n, scale[a]))),
        }
    }
}

/// TEX-20: returns u and v of a direction on an image of two dimensions.
fn on_plane(v: [Number; 3], size: [u32; 2]) -> [i128; 2] {
    let ([sc, tc], major) = project(face_of(v), v);
    if major.m == 0 {
        return [-LIMIT, LIMIT];
    }
    [(sc, size[0]), (-tc, size[1])].map(|(minor, side)| quotient(minor, major).floor(256 * i128::from(side)))
}

/// TEX-20: returns 1 for the last column and the last row, otherwise 0.
fn ends([first, second]: [f32; 2]) -> [i128; 2] {
    [first < 0.0, second > 0.0].map(i128::from)
}

fn limited(u: i128) -> i128 {
    u.clamp(-LIMIT, LIMIT)
}

/// INT-4, TEX-15: returns floor(256 size s / q).
fn ratio(s: Number, q: Option<Number>, size: u32) -> i128 {
    if q.is_some_and(|q| q.m == 0) {
        return s.m.signum() * LIMIT;
    }
    limited(over(s, q).floor(256 * i128::from(size)))
}

/// INT-4, TEX-15: returns s / q for a q other than 0.
fn over(s: Number, q: Option<Number>) -> Number {
    q.map_or(s, |q| quotient(s, q))
}

/// TEX-15: returns s / q for a q other than 0.
fn quotient(s: Number, q: Number) -> Number {
    let r = reciprocal(Number { m: q.m.abs(), ..q });
    let cut = s.cut(24).times(r).cut(24);
    if q.m < 0 { -cut } else { cut }
}

/// TSH-7: returns floor(scale (f + by / 128)). There is no division by q.
fn moved(f: Number, by: Number, scale: i128) -> i128 {
    floor_sum(&[(f.m * scale, f.e), (by.m * scale, by.e - 7)])
}

/// TEX-12, TEX-13: returns the face and the coordinates of a direction.
fn on_face(v: [Number; 3], size: u32) -> (usize, [i128; 2]) {
    let face = face_of(v);
    let (minor, major) = project(face, v);
    let scale = 128 * i128::from(size);
    // The zero vector has none.
    (face, minor.map(|sc| if major.m == 0 { 0 } else { across(sc, major, scale) }))
}

/// TEX-12: returns floor(scale (1 + q)) of the quotient q of a minor and the major component.
fn across(minor: Number, major: Number, scale: i128) -> i128 {
    quotient(minor, major).floor(scale) + scale
}

/// TEX-13: returns a direction of floats, unless one is not finite. Such a direction and the zero vector read the same.
fn finite(v: [f32; 3]) -> Option<[Number; 3]> {
    v.iter().all(|x| x.is_finite()).then(|| v.map(Number::of))
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
