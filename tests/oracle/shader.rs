//! Computes the texture units in order, each of which may read earlier ones: TEX-16, TSH-1 to TSH-10.

use super::coordinate::{Place, lod};
use super::raster::{Sample, Setup};
use super::real::{Number, factor_byte, floor_div, floor_sum, nearest_f32, split};
use super::sampling;
use super::tally::{count, count_named};
use super::texel::{Color, signed};
use super::texture::Image;
use super::weights::sum;
use ninebit::state::{DependentScale, DotMapping, Draw, Policies, ShaderOperation};
use std::cell::RefCell;
use std::collections::HashMap;

/// The units of one draw on one triangle.
pub struct Units<'a> {
    draw: &'a Draw,
    images: &'a [Option<Image>],
    setup: &'a Setup,
    policies: &'a Policies,
    /// The triangle as units with a cylindrical wrap use it.
    wrapped: [Option<Setup>; 4],
    /// The lod of each unit at each quad, once it has been computed.
    lods: RefCell<HashMap<(usize, i128, i128), i128>>,
}

impl<'a> Units<'a> {
    pub fn new(draw: &'a Draw, images: &'a [Option<Image>], setup: &'a Setup, policies: &'a Policies) -> Units<'a> {
        let wrapped = |k: usize| {
            let unit = images[k].as_ref()?.unit;
            sampling::wrapped(setup, &unit, draw.texture_shader[k].coordinate_set)
        };
        let wrapped = [0, 1, 2, 3].map(wrapped);
        Units { draw, images, setup, policies, wrapped, lods: RefCell::default() }
    }

    /// Returns the four texture registers of a covered pixel, or `None` if a unit drops the fragment.
    pub fn registers(&self, i: i128, j: i128, sample: &Sample) -> Option<[[i128; 4]; 4]> {
        let kept = (0..4).all(|k| match self.draw.texture_shader[k].operation {
            ShaderOperation::CullFragment { drops_not_negative } => !self.culled(k, sample, drops_not_negative),
            // KEY-1
            operation if operation.samples() => {
                self.images[k].as_ref().is_none_or(|image| !image.drops(&self.sampled(k, image, i, j, sample)))
            }
            _ => true,
        });
        count("fragment", if kept { "kept" } else { "culled" });
        kept.then(|| {
            let registers = [0, 1, 2, 3].map(|k| self.unit(k, i, j, sample).register);
            if self.draw.convert_yuv { registers.map(from_yuv) } else { registers }
        })
    }

    /// TSH-10: returns whether a unit drops the fragment by the signs of its coordinates.
    fn culled(&self, k: usize, sample: &Sample, drops_not_negative: [bool; 4]) -> bool {
        let set = self.draw.texture_shader[k].coordinate_set;
        (0..4).any(|c| {
            let number = self.setup.number(sample, |v| v.texture_coordinates[set][c]);
            (number.m >= 0) == drops_not_negative[c]
        })
    }

    /// Returns the colour that a unit yields at a pixel.
    fn unit(&self, k: usize, i: i128, j: i128, sample: &Sample) -> Color {
        let stage = &self.draw.texture_shader[k];
        count("operation", stage.operation.name());
        if let (ShaderOperation::Sample2D | ShaderOperation::DotProduct3D, Some(image)) =
            (stage.operation, &self.images[k])
        {
            count("other kind", image.kind());
        }
        match stage.operation {
            ShaderOperation::None | ShaderOperation::CullFragment { .. } => Color::plain([0, 0, 0, 255]),
            ShaderOperation::DotProduct => Color::plain([0; 4]),
            ShaderOperation::PassThrough => Color::plain([0, 1, 2, 3].map(|c| {
                // TSH-9
                let number = self.setup.number(sample, |v| v.texture_coordinates[stage.coordinate_set][c]);
                factor_byte(number.floor(4096).clamp(0, 4096))
            })),
            _ => {
                // TEX-16
                let Some(image) = &self.images[k] else { return Color::plain([0, 0, 0, 255]) };
                let color = self.sampled(k, image, i, j, sample);
                match stage.operation {
                    ShaderOperation::BumpEnvironment { luminance: Some(luminance), .. } => {
                        self.luminance(color, self.previous(k, i, j, sample)[0], luminance)
                    }
                    _ => color,
                }
            }
        }
    }

    /// Returns the colour that a unit samples, before it is multiplied by luminance.
    fn sampled(&self, k: usize, image: &Image, i: i128, j: i128, sample: &Sample) -> Color {
        let place = self.place(k, i, j, sample);
        let setup = self.setup_of(k);
        if let Some(shadow) = image.unit.shadow {
            return image.compare(shadow, setup, sample, &place, self.draw.texture_shader[k].coordinate_set);
        }
        let taps = match image.unit.anisotropy {
            1 => vec![([0, 0], 256)],
            limit => sampling::taps(self.corners(k, image, i, j), limit),
        };
        let lod = image.limited_lod(self.lod(k, image, i, j));
        image.sample(setup, sample, &place, lod, &taps)
    }

    /// Returns the triangle as a unit uses it.
    fn setup_of(&self, k: usize) -> &Setup {
        self.wrapped[k].as_ref().unwrap_or(self.setup)
    }

    /// TEX-11: returns the coordinates at the pixels of the quad that contains a pixel.
    fn corners(&self, k: usize, image: &Image, i: i128, j: i128) -> [Option<[i128; 2]>; 3] {
        let (left, top) = (i & !1, j & !1);
        let mut face = None;
        [(left, top), (left + 1, top), (left, top + 1)].map(|(i, j)| {
            let sample = self.setup.sample(i, j)?;
            let place = self.place(k, i, j, &sample);
            let setup = self.setup_of(k);
            let face = *face.get_or_insert_with(|| place.face(setup, &sample));
            place.fine(setup, &sample, image.scale(0), face)
        })
    }

    /// Returns the bytes that a unit reads from the earlier unit on which it depends.
    fn previous(&self, k: usize, i: i128, j: i128, sample: &Sample) -> [i128; 4] {
        self.unit(self.draw.texture_shader[k].previous, i, j, sample).bytes
    }

    /// TSH-8: multiplies R, G and B by the luminance, as the register holds them, where signed channels are doubled. Negative values count
    /// as 0.
    fn luminance(&self, color: Color, red: i128, [scale, offset]: [f32; 2]) -> Color {
        let ((ms, es), (mo, eo)) = (split(scale), split(offset));
        // 4096 (c / 255) (red / 255 scale + offset) = c (red scale + 255 offset) 4096 / 65025.
        let lit = |c: i128| {
            let c = c.max(0);
            let fine = floor_sum(&[(c * red * ms, es + 12 + 30), (255 * c * mo, eo + 12 + 30)]);
            let v = floor_div(fine, 65025 << 30).0.max(0);
            factor_byte(v).min(255)
        };
        let [r, g, b, _] = color.register;
        let bytes = [lit(r), lit(g), lit(b), color.bytes[3]];
        Color { bytes, register: [bytes[0], bytes[1], bytes[2], color.register[3]] }
    }

    /// Returns where a unit samples.
    fn place(&self, k: usize, i: i128, j: i128, sample: &Sample) -> Place {
        let stage = &self.draw.texture_shader[k];
        let set = stage.coordinate_set;
        let dot = |unit: usize| self.dot(unit, i, j, sample);
        if let Some((d, n)) = self.setup.sprite(i, j).filter(|_| k == 3 && self.draw.point_sprite) {
            return Place::Sprite(d, n);
        }
        let is_cube = self.images[k].as_ref().is_some_and(Image::is_cube);
        let toward = |vector: [f32; 3]| if is_cube { Place::Vector(vector) } else { Place::PlaneVector(vector) };
        match stage.operation {
            ShaderOperation::BumpEnvironment { matrix, .. } => {
                // TSH-7: both bytes are two's complement regardless of the flags. The sums are in single precision.
                let [_, g, b, _] = self.previous(k, i, j, sample).map(|v| signed(true, v, 8) as f32);
                let [m0, m1, m2, m3] = matrix;
                Place::Moved(set, [m0 * b + m3 * g, m1 * b + m2 * g].map(Number::of))
            }
            ShaderOperation::DependentAlphaRed => {
                let [r, _, _, a] = self.previous(k, i, j, sample);
                Place::Bytes([a, r], self.whole())
            }
            ShaderOperation::DependentGreenBlue => {
                let [_, g, b, _] = self.previous(k, i, j, sample);
                Place::Bytes([g, b], self.whole())
            }
            ShaderOperation::DotProduct2D => Place::Floats([dot(k - 1), dot(k)]),
            ShaderOperation::DotProduct3D if is_cube => Place::Ends([dot(k - 2), dot(k - 1)]),
            ShaderOperation::DotProduct3D => Place::Floats([dot(k - 2), dot(k - 1)]),
            ShaderOperation::DotProductCube => toward([dot(k - 2), dot(k - 1), dot(k)]),
            ShaderOperation::DotReflectDiffuse => toward([dot(k - 1), dot(k), dot(k + 1)]),
            ShaderOperation::DotReflectSpecular => {
                let eye = [k - 2, k - 1, k].map(|unit| {
                    let set = self.draw.texture_shader[unit].coordinate_set;
                    self.float(sample, set, 3)
                });
                toward(reflect([dot(k - 2), dot(k - 1), dot(k)], eye))
            }
            ShaderOperation::DotReflectConstantEye { eye } => toward(reflect([dot(k - 2), dot(k - 1), dot(k)], eye)),
            ShaderOperation::Sample2D if is_cube => Place::Face(set),
            ShaderOperation::Sample2D => Place::Layer(set),
            ShaderOperation::SampleCube => Place::Plane(set),
            _ if is_cube => Place::Direction(set),
            _ => Place::Set(set),
        }
    }

    /// TSH-6: returns the divisor of a byte, which counts as 1.
    fn whole(&self) -> i128 {
        match self.policies.dependent_scale {
            DependentScale::Over255 => 255,
            DependentScale::Over256 => 256,
        }
    }

    /// TSH-4: returns an interpolated coordinate, rounded to single precision.
    fn float(&self, sample: &Sample, set: usize, c: usize) -> f32 {
        self.setup.number(sample, |v| v.texture_coordinates[set][c]).real() as f32
    }

    /// TSH-1 to TSH-4: returns the dot product of a unit.
    fn dot(&self, k: usize, i: i128, j: i128, sample: &Sample) -> f32 {
        let stage = &self.draw.texture_shader[k];
        count_named(stage.mapping);
        let v = mapped(stage.mapping, self.previous(k, i, j, sample));
        let [s, t, r] = [0, 1, 2].map(|c| self.float(sample, stage.coordinate_set, c));
        aligned([v[0] * s, v[1] * t, v[2] * r])
    }

    /// TEX-11: returns the lod of the quad that contains a pixel.
    fn lod(&self, k: usize, image: &Image, i: i128, j: i128) -> i128 {
        let key = (k, i >> 1, j >> 1);
        if let Some(lod) = self.lods.borrow().get(&key) {
            return *lod;
        }
        let lod = lod(self.corners(k, image, i, j));
        count("lod", if lod == -32768 { "least" } else { "measured" });
        self.lods.borrow_mut().insert(key, lod);
        lod
    }
}

/// TEX-19: returns the colour of a register with Y, Cb, Cr and alpha.
fn from_yuv([y, cb, cr, alpha]: [i128; 4]) -> [i128; 4] {
    count("register", "converted");
    let part = |factor: i128, value: i128, divisor: i128| (factor * value).div_euclid(divisor);
    let light = part(149, y, 128);
    let red = light + 2 * part(409, cr, 512) - 223;
    let green = light - 2 * part(100, cb, 512) - 2 * part(208, cr, 512) + 136;
    let blue = light + part(129, cb, 64) - 277;
    let [red, green, blue] = [red, green, blue].map(|value| value.clamp(0, 255));
    [red, green, blue, alpha]
}

/// TSH-1 to TSH-3: returns the vector of a texel's bytes.
fn mapped(mapping: DotMapping, bytes: [i128; 4]) -> [f32; 3] {
    let [r, g, b, a] = bytes;
    let each = |f: &dyn Fn(i128) -> f32| [f(r), f(g), f(b)];
    match mapping {
        DotMapping::ZeroToOne => each(&|v| nearest_f32(v, 255, 0)),
        DotMapping::MinusOneToOneD3d => each(&|v| nearest_f32(v - 128, 127, 0)),
        DotMapping::MinusOneToOneGl => each(&|v| nearest_f32(2 * signed(true, v, 8) + 1, 255, 0)),
        DotMapping::MinusOneToOne => each(&|v| nearest_f32(signed(true, v, 8), 127, 0)),
        DotMapping::Hilo1 => {
            let [high, low] = [a << 8 | r, g << 8 | b].map(|v| nearest_f32(v, 65535, 0));
            [high, low, 1.0]
        }
        DotMapping::HiloHemisphere => {
            let [high, low] = [a << 8 | r, g << 8 | b].map(|v| signed(true, v, 16));
            let left = (1 << 30) - high * high - low * low;
            let (third, power) = if left > 0 { root_in_pieces(left) } else { (0, 0) };
            [nearest_f32(high, 32768, 0), nearest_f32(low, 32768, 0), nearest_f32(third, 1, power)]
        }
    }
}

/// TSH-3: returns r(n) of n = left / 2^30 as a whole number and the power of two that it is multiplied by.
fn root_in_pieces(left: i128) -> (i128, i32) {
    let k = (0..).find(|k| left << (2 * k) >= 1 << 28).expect("left is positive");
    // Ends of the piece, in 2^-30.
    let m = left << (2 * k);
    let width = if m < 1 << 29 { (1 << 30) / 128 } else { (1 << 30) / 64 };
    let (c, along) = (m / width * width, 1024 * (m % width) / width);
    // Roots with 60 fraction bits, which no difference of two comes near enough to a multiple of 2^-16 to mistake.
    let root = |n: i128| ((n << 90) as u128).isqrt() as i128;
    let (start, rise) = (root(c) >> 42, (root(c + width) - root(c)) >> 44);
    // start has 18 fraction bits, rise and along 26 together.
    ((256 * start + rise * along) >> 11, -15 - k)
}

/// TSH-4: returns the sum aligned at 24 bits and cut to 24 bits.
fn aligned(terms: [f32; 3]) -> f32 {
    if terms.iter().any(|term| !term.is_finite()) {
        return terms.into_iter().map(f64::from).sum::<f64>() as f32;
    }
    let sum = sum(terms.map(Number::of), 24).cut(24);
    nearest_f32(sum.m, 1, sum.e)
}

/// TSH-5: returns 2 (n.e) n - (n.n) e.
fn reflect(n: [f32; 3], e: [f32; 3]) -> [f32; 3] {
    let dot = |a: [f32; 3], b: [f32; 3]| aligned([0, 1, 2].map(|c| a[c] * b[c]));
    let (twice, square) = (2.0 * dot(n, e), dot(n, n));
    [0, 1, 2].map(|c| {
        let (along, eye) = (twice * n[c], square * e[c]);
        aligned([along, -eye, 0.0])
    })
}
