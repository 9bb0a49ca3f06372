//! TSH-4, TSH-5 and TSH-7 on rows: the dot unit, by the text of [`crate::texture::dot`]. Since Rust never fuses operations by itself, each lane has
//! the bits of the definition.
#![allow(clippy::float_arithmetic, reason = "the chip's dot unit is a float unit (TSH-4)")]

use crate::engine::rows::lanes::{BLOCK, Lanes, nearest, nearest_32};
use crate::engine::rows::sampling::facing::{Facing, floors_on_face};
use crate::number::convert::factor;
use crate::state::DotMapping;
use crate::texture::dot;
use std::ops::{Mul, Neg};

/// A float for each pixel of a block.
pub(crate) type Floats = [f32; BLOCK];

/// TSH-1 to TSH-3: how a register becomes three fractions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Remap {
    /// One fraction of each byte.
    Bytes(Linear),
    /// Fractions of two 16-bit halves, by a mapping of TSH-3.
    Halves(DotMapping),
}

impl Remap {
    pub(crate) fn new(mapping: DotMapping) -> Remap {
        Linear::new(mapping).map_or(Remap::Halves(mapping), Remap::Bytes)
    }

    /// Computes the fractions of the registers R, G, B and A. `doubled` tells which of them hold twice the byte.
    #[inline(always)]
    pub(crate) fn run(
        self,
        lanes: Lanes,
        registers: [Option<&[i16; BLOCK]>; 4],
        doubled: [bool; 4],
        out: [&mut Floats; 3],
    ) {
        match self {
            Remap::Bytes(linear) => {
                for n in 0..3 {
                    if let Some(register) = registers[n] {
                        linear.run(lanes, register, doubled[n], out[n]);
                    }
                }
            }
            Remap::Halves(mapping) => {
                let [Some(r), Some(g), Some(b), Some(a)] = registers else { return };
                let down = doubled.map(u32::from);
                let [x, y, z] = out;
                // Two loops, so that each has a constant mapping.
                macro_rules! each {
                    ($mapping:expr) => {
                        for n in 0..lanes.count() {
                            let bytes = [r[n] >> down[0], g[n] >> down[1], b[n] >> down[2], a[n] >> down[3]];
                            let bytes = [bytes[0] as u8, bytes[1] as u8, bytes[2] as u8, bytes[3] as u8];
                            [x[n], y[n], z[n]] = dot::remap($mapping, bytes);
                        }
                    };
                }
                if mapping == DotMapping::Hilo1 { each!(DotMapping::Hilo1) } else { each!(DotMapping::HiloHemisphere) }
            }
        }
    }
}

/// TSH-1 and TSH-2: a mapping whose numerators are a linear function of the byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Linear {
    signed: bool,
    times: i16,
    plus: i16,
    whole: i16,
}

impl Linear {
    /// Returns `None` if the mapping is not linear.
    fn new(mapping: DotMapping) -> Option<Linear> {
        let of = |byte: u8| dot::fractions(mapping, [i32::from(byte); 4]);
        let (plus, whole) = of(0)[0];
        let times = of(1)[0].0 - plus;
        let [times, plus, whole] = [times, plus, whole].map(|n| i16::try_from(n).ok());
        let remap = Linear { signed: of(128)[0].0 < of(127)[0].0, times: times?, plus: plus?, whole: whole? };
        let fits = |byte: u8| of(byte) == [(i32::from(remap.numerator(i16::from(byte))), i32::from(remap.whole)); 3];
        (0..=255).all(fits).then_some(remap)
    }

    #[inline(always)]
    fn numerator(self, byte: i16) -> i16 {
        let byte = if self.signed { i16::from(byte as i8) } else { byte & 255 };
        byte.wrapping_mul(self.times).wrapping_add(self.plus)
    }

    /// Computes the fractions of a channel. `doubled` tells whether it holds twice the byte.
    #[inline(always)]
    fn run(self, lanes: Lanes, register: &[i16; BLOCK], doubled: bool, out: &mut Floats) {
        let whole = f32::from(self.whole);
        for n in 0..lanes.count() {
            out[n] = f32::from(self.numerator(register[n] >> u32::from(doubled))) / whole;
        }
    }
}

/// A number of the dot unit in a lane.
///
/// Sums are computed in single precision, in steps of the 24th bit of the largest term: terms are whole numbers below 2^24, and what a sum of two such
/// numbers loses is a whole one, too, as is the difference of the sum and either term. No number stands for a sum of terms below the smallest step, and
/// for one of three terms of which any is infinite: these lanes are computed in doubles.
#[derive(Clone, Copy)]
struct Lane(f32);

/// Returns a sum of whole numbers below 2^26, of which the second is below 2^24, to nearest, and what it loses.
#[inline(always)]
fn sum_and_loss(a: f32, b: f32) -> (f32, f32) {
    let sum = a + b;
    (sum, b - (sum - a))
}

impl Lane {
    /// Returns terms in steps of the 24th bit of the largest, toward zero, and such a step. It is no number if it would be below all.
    #[inline(always)]
    fn steps<const N: usize>(terms: [Lane; N]) -> ([f32; N], f32) {
        let top = terms.iter().fold(0, |top, term| term.0.abs().to_bits().max(top));
        let power = top & f32::INFINITY.to_bits();
        // 2^150, whose exponent no number has, over the power.
        let scale = f32::from_bits((277_u32 << 23).wrapping_sub(power));
        let is_small = top.wrapping_sub(1) < (24 << 23) - 1;
        let step = power.wrapping_sub(23 << 23) | if is_small { u32::MAX } else { 0 };
        (terms.map(|term| (term.0 * scale).trunc()), f32::from_bits(step))
    }

    /// Returns a sum of steps toward zero to 24 bits, if it was rounded to nearest and loses this. A zero is positive.
    #[inline(always)]
    fn cut((sum, loss): (f32, f32), step: f32) -> Lane {
        let is_too_far = loss * sum < 0.0;
        Lane(f32::from_bits(sum.to_bits().wrapping_sub(is_too_far.into())) * step + 0.0)
    }
}

impl Mul for Lane {
    type Output = Lane;
    #[inline(always)]
    fn mul(self, other: Lane) -> Lane {
        Lane(self.0 * other.0)
    }
}

impl Neg for Lane {
    type Output = Lane;
    #[inline(always)]
    fn neg(self) -> Lane {
        Lane(-self.0)
    }
}

impl dot::Number for Lane {
    const ZERO: Lane = Lane(0.0);
    const TWO: Lane = Lane(2.0);

    #[inline(always)]
    fn sum(products: [Lane; 3]) -> Lane {
        let ([a, b, c], step) = Lane::steps(products);
        let (sum, first) = sum_and_loss(a, b);
        let (sum, second) = sum_and_loss(sum, c);
        Lane::cut(sum_and_loss(sum, first + second), step)
    }

    #[inline(always)]
    fn sum_of_two(a: Lane, b: Lane) -> Lane {
        let ([a, b], step) = Lane::steps([a, b]);
        Lane::cut(sum_and_loss(a, b), step)
    }
}

/// TSH-4: dot products of three numbers and a remapped colour.
#[inline(always)]
pub(crate) fn products(lanes: Lanes, [s, t, r]: [&Floats; 3], [x, y, z]: [&Floats; 3], out: &mut Floats) {
    let mut is_open = false;
    for n in 0..lanes.count() {
        let Lane(dot) = dot::dot([s[n], t[n], r[n]].map(Lane), [x[n], y[n], z[n]].map(Lane));
        out[n] = dot;
        is_open |= dot.is_nan();
    }
    if is_open {
        for n in 0..lanes.count() {
            out[n] = dot::dot([s[n], t[n], r[n]], [x[n], y[n], z[n]]);
        }
    }
}

/// TSH-5: reflects vectors.
#[inline(always)]
pub(crate) fn reflect(
    lanes: Lanes,
    [x, y, z]: [&Floats; 3],
    [a, b, c]: [&Floats; 3],
    [out_x, out_y, out_z]: [&mut Floats; 3],
) {
    let mut is_open = false;
    for n in 0..lanes.count() {
        let reflection = dot::reflect([x[n], y[n], z[n]].map(Lane), [a[n], b[n], c[n]].map(Lane));
        [out_x[n], out_y[n], out_z[n]] = reflection.vector.map(|Lane(component)| component);
        is_open |= out_x[n].is_nan() | out_y[n].is_nan() | out_z[n].is_nan();
    }
    if is_open {
        for n in 0..lanes.count() {
            [out_x[n], out_y[n], out_z[n]] = dot::reflect([x[n], y[n], z[n]], [a[n], b[n], c[n]]).vector;
        }
    }
}

/// TSH-7: computes how far blue and green move both coordinates, in 1/128 image. Their registers may hold twice the byte.
#[inline(always)]
pub(crate) fn moved(
    lanes: Lanes,
    [m0, m1, m2, m3]: [f32; 4],
    (blue, blue_doubled): (&[i16; BLOCK], bool),
    (green, green_doubled): (&[i16; BLOCK], bool),
    along: &mut Floats,
    down: &mut Floats,
) {
    let (down_blue, down_green) = (u32::from(blue_doubled), u32::from(green_doubled));
    for n in 0..lanes.count() {
        let (b, g) = (f32::from((blue[n] >> down_blue) as i8), f32::from((green[n] >> down_green) as i8));
        (along[n], down[n]) = (dot::moved([m0, m3], [b, g]), dot::moved([m1, m2], [b, g]));
    }
}

/// 1.5 2^14: added to a product below 4096, it leaves the floor in the bits from the ninth up, if the product is not close to an integer.
const TWELVE_BITS: f32 = 24_576.0;

/// TSH-8: multiplies a channel by the factors of the pixels' luminance, which keep products far from integers.
#[inline(always)]
pub(crate) fn luminance<const FMA: bool>(lanes: Lanes, factors: &Floats, channel: &mut [i16; BLOCK]) {
    for n in 0..lanes.count() {
        let c = f32::from(channel[n].max(0));
        let sum = if FMA { c.mul_add(factors[n], TWELVE_BITS) } else { c * factors[n] + TWELVE_BITS };
        // A product of 4096 or more is 255 like 4095.
        let bits = (sum.to_bits() as i32).min(TWELVE_BITS.to_bits() as i32 + (4096 << 9) - 1);
        channel[n] = (bits >> 9) as i16;
    }
    // A loop of its own, so that vectors hold twice as many lanes.
    for n in 0..lanes.count() {
        channel[n] = factor(i32::from(channel[n] & 4095)) as i16;
    }
}

/// Returns whether all components are finite, without branches.
#[inline(always)]
pub(crate) fn is_finite([x, y, z]: [f32; 3]) -> bool {
    (x.abs() <= f32::MAX) & (y.abs() <= f32::MAX) & (z.abs() <= f32::MAX)
}

/// TEX-12 and TEX-13 of vectors: writes the face, and u and v on it as floors in 1/256 texel less `bias`. The third argument is scratch space.
#[inline(always)]
pub(crate) fn on_faces(
    lanes: Lanes,
    [x, y, z]: [&Floats; 3],
    (size, bias): (u32, i32),
    [along, down, majors]: [&mut Floats; 3],
    u: &mut [i32; BLOCK],
    v: &mut [i32; BLOCK],
    faces: &mut [u32; BLOCK],
) {
    let middle = 128.0 * f64::from(size);
    for n in 0..lanes.count() {
        let direction = [x[n], y[n], z[n]];
        let finite = is_finite(direction);
        let facing = Facing::new(direction);
        let [s, t, m] = facing.components(direction);
        // By bits, because compilers turn a choice into masked stores, which are slow.
        let kept = if finite { u32::MAX } else { 0 };
        let kept = |v: f32| f32::from_bits(v.to_bits() & kept);
        faces[n] = nearest_32(kept(facing.number())) as u32;
        (along[n], down[n], majors[n]) = (kept(s), kept(t), kept(m));
    }
    for n in 0..lanes.count() {
        let [s, t, m] = [along[n], down[n], majors[n]].map(f64::from);
        let [along, down] = floors_on_face([s, t, m], middle);
        (u[n], v[n]) = (nearest(along) - bias, nearest(down) - bias);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::raster::interpolate::face_coordinate;
    use crate::state::Named;
    use crate::texture::coordinates::{face_of, on_face};
    use crate::texture::dot::Number;
    use crate::texture::shader;

    /// Every byte in every channel of every mapping, plain and doubled, beside others.
    #[test]
    fn bytes_become_the_fractions_of_the_definition() {
        for mapping in DotMapping::ALL {
            let halves = matches!(mapping, DotMapping::Hilo1 | DotMapping::HiloHemisphere);
            assert_eq!(matches!(Remap::new(*mapping), Remap::Halves(_)), halves);
            for round in 0..64_u8 {
                let doubled = [0, 1, 2, 3].map(|n: u8| round >> n & 1 != 0);
                let bytes =
                    |n: usize| [1_u8, 5, 37, 101].map(|times| (n as u8).wrapping_mul(times).wrapping_add(round));
                let register = |channel: usize| -> [i16; BLOCK] {
                    std::array::from_fn(|n| {
                        let byte = bytes(n)[channel];
                        if doubled[channel] { 2 * i16::from(byte as i8) } else { i16::from(byte) }
                    })
                };
                let registers = [register(0), register(1), register(2), register(3)];
                let mut out = [[0.0; BLOCK]; 3];
                Remap::new(*mapping).run(Lanes::default(), registers.each_ref().map(Some), doubled, out.each_mut());
                for n in 0..BLOCK {
                    let got = out.each_ref().map(|out| out[n]);
                    assert_eq!(got, dot::remap(*mapping, bytes(n)), "{mapping:?} {:?}", bytes(n));
                }
            }
        }
    }

    /// Random floats of all sizes, some of them equal, round, infinite or no numbers.
    fn floats(state: &mut u64) -> Floats {
        std::array::from_fn(|_| {
            *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let bits = (*state >> 32) as u32;
            match (*state >> 24) % 16 {
                0 => f32::from_bits(bits),
                1 => (bits % 5) as f32 - 2.0,
                2 => [0.0, -0.0, f32::INFINITY, f32::NAN, 1e-40, -1e-40, 1e30, -1e30][bits as usize % 8],
                3 => (bits as i32 >> 20) as f32 / 64.0,
                _ => (bits as i32) as f32 / (1_u32 << 30) as f32,
            }
        })
    }

    /// Sums of terms of all sizes, near to one another and far apart, and of zeros of both signs, against doubles.
    #[test]
    fn sums_of_lanes_are_those_of_doubles() {
        let mut random = Random::seeded(83);
        for round in 0..4_000_000 {
            let mut term = || {
                let (kind, bits) = (random.bits() >> 32, random.bits() as u32);
                let fraction = match kind & 7 {
                    0 => 0,
                    1 => 0x7f_ffff,
                    2 => 0x7f_fffe,
                    3 => 1,
                    4 => 0x40_0000 << (bits % 2) >> (bits % 23) & 0x7f_ffff,
                    _ => bits & 0x7f_ffff,
                };
                match kind >> 3 & 7 {
                    0 => f32::from_bits(bits & 1 << 31),
                    1 => f32::from_bits(bits),
                    _ => f32::from_bits(bits & 1 << 31 | (round % 255 + (bits >> 23) % 28).min(255) << 23 | fraction),
                }
            };
            let terms = [term(), term(), term()];
            let [a, b, c] = terms.map(Lane);
            let two = (Lane::sum_of_two(a, b), f32::sum_of_two(terms[0], terms[1]), &terms[..2]);
            for (Lane(found), wanted, terms) in [(Lane::sum([a, b, c]), f32::sum(terms), &terms[..]), two] {
                let top = terms.iter().map(|term| term.abs().to_bits()).max().unwrap();
                let is_open = found.is_nan() && (0 < top && top < 24 << 23 || top >= f32::INFINITY.to_bits());
                assert!(is_open || found.to_bits() == wanted.to_bits(), "{terms:?}: {found:e}, not {wanted:e}");
            }
        }
    }

    /// Blocks with lanes that doubles compute, and without.
    #[test]
    fn blocks_have_the_results_of_the_definition() {
        let same = |a: f32, b: f32| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
        let mut state = 11;
        for round in 0..400 {
            let mut numbers = || {
                let limit = |x: f32| if round % 2 == 0 { x.clamp(-2.0, 2.0) } else { x };
                floats(&mut state).map(|x| if x.is_nan() && round % 2 == 0 { 1.0 } else { limit(x) })
            };
            let (a, b) = ([numbers(), numbers(), numbers()], [numbers(), numbers(), numbers()]);
            let (mut dots, mut vectors) = ([0.0; BLOCK], [[0.0; BLOCK]; 3]);
            products(Lanes::default(), a.each_ref(), b.each_ref(), &mut dots);
            reflect(Lanes::default(), a.each_ref(), b.each_ref(), vectors.each_mut());
            for n in 0..BLOCK {
                let [x, y] = [&a, &b].map(|of| of.each_ref().map(|of| of[n]));
                assert!(same(dots[n], dot::dot(x, y)), "{x:?} . {y:?}");
                let wanted = dot::reflect(x, y).vector;
                assert!((0..3).all(|k| same(vectors[k][n], wanted[k])), "{x:?} and {y:?}");
            }
        }
    }

    /// Faces and places on them, against the definition.
    #[test]
    fn places_are_those_of_the_definition() {
        let mut state = 7;
        let mut scratch = [[0.0; BLOCK]; 3];
        for round in 0..2_000 {
            let vector = [floats(&mut state), floats(&mut state), floats(&mut state)];
            let (size, bias) = (1_u32 << (round % 13), [0, 128][round % 2]);
            let (mut u, mut v, mut faces) = ([0; BLOCK], [0; BLOCK], [0; BLOCK]);
            let (all, of, at) = (Lanes::default(), vector.each_ref(), (size, bias));
            on_faces(all, of, at, scratch.each_mut(), &mut u, &mut v, &mut faces);
            for n in 0..BLOCK {
                let bits = |axis: usize| i64::from(vector[axis][n].to_bits());
                let direction = shader::direction([bits(0), bits(1), bits(2)]);
                let face = face_of(direction);
                let [s, t, m] = on_face(direction, face);
                let at = [s, t].map(|s| face_coordinate(s, m, size.into(), 8) as i32 - bias);
                let context = [vector[0][n], vector[1][n], vector[2][n]];
                assert_eq!((faces[n], [u[n], v[n]]), (face as u32, at), "{context:?} on {size}");
            }
        }
    }
}
