//! VTX-6: the colours of vertices in the fixed-function pipe, from up to eight lights on both sides of a surface.
//!
//! Of a light with the distance d, the vector l to it and the normal n:
//!
//! ```text
//! attenuation  1 / (a0 + a1 d + a2 d^2), 0 beyond the range, times the share of the cone
//! ambient      attenuation
//! diffuse      attenuation (n l), 0 if n l is negative
//! specular     attenuation f(x), 0 if n l or f's numerator is negative
//! f(x)         (x + A) / (x B + C), which Direct3D fits to x^power; x is n h of a far light and a far eye,
//!              else (y D + x) / (y F + x E) of x = (n h)^2 and y = h^2 with h = l + eye, for half the power
//! cone         the first function of s l + s', at most 1, with the words of the falloff, 0 if s l + s' is negative
//! ```
//!
//! Distances and directions are the transform unit's (VTX-5), all else is in words of [`number::light`](crate::number::light).

use super::unit::{self, words};
use crate::number::light::{
    ONE, SIGN, add_product, dot, multiply_add, product, reciprocal, single_product, single_sum, sum, word,
};
use crate::number::transform::{self, is_negative};

/// Where a colour of the material comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorSource {
    /// From the material, which the driver has multiplied into the lights' colours.
    Material,
    /// From the primary colour of the vertex.
    Diffuse,
    /// From the secondary colour of the vertex.
    Specular,
}

/// The sources of a material's colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sources {
    /// The source of the light that the surface emits.
    pub emission: ColorSource,
    /// The source of the ambient colour.
    pub ambient: ColorSource,
    /// The source of the diffuse colour, and of alpha.
    pub diffuse: ColorSource,
    /// The source of the specular colour.
    pub specular: ColorSource,
}

impl Sources {
    /// All colours from the material.
    pub const MATERIAL: Sources = Sources {
        emission: ColorSource::Material,
        ambient: ColorSource::Material,
        diffuse: ColorSource::Material,
        specular: ColorSource::Material,
    };
}

/// The cone of a spotlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// A, B and C of the function over the cone.
    pub falloff: [f32; 3],
    /// The axis, scaled.
    pub direction: [f32; 3],
    /// What is added to the product of the axis and the direction to the light.
    pub offset: f32,
}

/// Where a light stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// A light far away.
    Infinite {
        /// The direction to the light.
        direction: [f32; 3],
        /// The direction between those to the light and to an eye far away.
        half: [f32; 3],
    },
    /// A light in eye space.
    Local {
        /// Its place.
        position: [f32; 3],
        /// The divisor as a polynomial of the distance.
        attenuation: [f32; 3],
        /// The largest distance that it reaches.
        range: f32,
        /// Its cone, if it is a spotlight.
        spot: Option<Spot>,
    },
}

/// The material of one side, and the colours of the lights on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Side {
    /// The sources of the colours.
    pub sources: Sources,
    /// Light of the scene with the material's emission.
    pub ambient: [f32; 3],
    /// What a colour of the vertex is multiplied by as ambient colour, or as emission if the ambient colour is the material's.
    pub factor: [f32; 3],
    /// The material's alpha.
    pub alpha: f32,
    /// A to F.
    pub powers: [f32; 6],
    /// Ambient, diffuse and specular colour of each light.
    pub colors: Vec<[[f32; 3]; 3]>,
}

/// The lights, and the surface that they light.
#[derive(Clone, Debug, PartialEq)]
pub struct Lighting {
    /// The lights in order.
    pub lights: Vec<Light>,
    /// The front's material.
    pub front: Side,
    /// The back's material.
    pub back: Option<Side>,
    /// Whether each vertex has its own direction to the eye.
    pub local_eye: bool,
    /// The direction to an eye far away.
    pub eye_direction: [f32; 3],
}

/// What becomes of secondary colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SecondaryColor {
    /// Whether there are secondary colours.
    pub enabled: bool,
    /// Whether specular light is kept apart from the primary colour.
    pub separate: bool,
    /// Whether alpha is that of the vertex, in place of 1.
    pub keeps_alpha: bool,
}

/// The state that gives vertices their colours.
#[derive(Clone, Debug, PartialEq)]
pub struct Shading {
    /// The lights, if lighting is enabled.
    pub lighting: Option<Lighting>,
    /// What becomes of secondary colours.
    pub secondary: SecondaryColor,
}

/// A place on a surface in eye space, in patterns of the transform unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Surface {
    /// The position as a point.
    pub point: [u32; 3],
    /// The normal.
    pub normal: [u32; 3],
    /// The vector to the eye.
    pub to_eye: [u32; 3],
}

impl Surface {
    /// Returns the place of a vertex, given its position in eye space and the eye's.
    pub fn new([x, y, z, w]: [u32; 4], normal: [u32; 3], eye: [f32; 3]) -> Surface {
        let point = if transform::is_zero(w) {
            [x, y, z]
        } else {
            [x, y, z].map(|c| transform::product(c, transform::reciprocal(w)))
        };
        Surface { point, normal, to_eye: each(words(eye), point, difference) }
    }
}

/// VTX-5: returns a - b.
fn difference(a: u32, b: u32) -> u32 {
    transform::sum([a, b ^ SIGN])
}

/// A primary and a secondary colour.
pub type Colors = [[f32; 4]; 2];

/// How much of a light's three colours arrives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Shares {
    ambient: u32,
    diffuse: u32,
    specular: u32,
}

/// Returns the words of registers or of a vertex's numbers.
fn converted<const N: usize>(numbers: [f32; N]) -> [u32; N] {
    numbers.map(|number| word(number.to_bits()))
}

fn rgb([r, g, b, _]: [f32; 4]) -> [u32; 3] {
    converted([r, g, b])
}

fn each(a: [u32; 3], b: [u32; 3], operation: fn(u32, u32) -> u32) -> [u32; 3] {
    std::array::from_fn(|k| operation(a[k], b[k]))
}

fn add(a: u32, b: u32) -> u32 {
    sum([a, b])
}

/// Returns a colour of words with an alpha.
fn with_alpha(color: [u32; 3], alpha: f32) -> [f32; 4] {
    let [r, g, b] = color.map(f32::from_bits);
    [r, g, b, alpha]
}

/// Returns a numerator times a factor by the reciprocal of a divisor, or 0 where the numerator is negative.
fn quotient(numerator: u32, factor: u32, divisor: u32) -> u32 {
    if is_negative(numerator) {
        return 0;
    }
    single_product(single_product(numerator, factor), reciprocal(divisor))
}

impl Spot {
    /// Returns what of an attenuation the cone lets through in the direction to the light.
    fn through(&self, to_light: [u32; 3], attenuation: u32) -> u32 {
        let [x, y, z] = each(to_light, words(self.direction), transform::product);
        let x = transform::sum([x, y, z, self.offset.to_bits()]);
        if is_negative(x) {
            return 0;
        }
        // No number is more than the middle of the cone, and NaN is no less.
        let (x, [a, b, c]) = (word(x).min(ONE), converted(self.falloff));
        // Unlike that of a far light, the divisor cuts the falloff's word.
        quotient(single_sum(x, a), attenuation, multiply_add(b, x, c))
    }
}

impl Shading {
    /// Returns the colours of the front, and those of the back if it is lit. `given` are the vertex's.
    pub fn colors(&self, surface: &Surface, given: Colors) -> (Colors, Option<Colors>) {
        let Some(lighting) = &self.lighting else {
            let [primary, secondary] = given.map(|color| with_alpha(rgb(color), color[3]));
            return ([primary, self.secondary.of(secondary)], None);
        };
        let lit = |side: &Side, normal| self.lit(lighting, side, &Surface { normal, ..*surface }, given);
        let back = lighting.back.as_ref().map(|side| lit(side, surface.normal.map(|c| c ^ SIGN)));
        (lit(&lighting.front, surface.normal), back)
    }

    fn lit(&self, lighting: &Lighting, side: &Side, surface: &Surface, given: Colors) -> Colors {
        let [diffuse, specular] = given;
        let SecondaryColor { enabled, separate, .. } = self.secondary;
        let secondary = (enabled && separate).then_some([0; 3]);
        let (primary, secondary) = lighting.accumulated(side, surface, given, secondary);
        let alpha = match side.sources.diffuse {
            ColorSource::Material => side.alpha,
            ColorSource::Diffuse => diffuse[3],
            ColorSource::Specular => specular[3],
        };
        let secondary = with_alpha(secondary.unwrap_or(rgb(specular)), specular[3]);
        [with_alpha(primary, alpha), self.secondary.of(secondary)]
    }
}

impl Lighting {
    /// Returns the primary colour, and the secondary one if it takes specular light.
    fn accumulated(
        &self,
        side: &Side,
        surface: &Surface,
        given: Colors,
        mut secondary: Option<[u32; 3]>,
    ) -> ([u32; 3], Option<[u32; 3]>) {
        // A material's own colours are in those of the lights.
        let of = |source: ColorSource| match source {
            ColorSource::Material => None,
            ColorSource::Diffuse => Some(rgb(given[0])),
            ColorSource::Specular => Some(rgb(given[1])),
        };
        let Sources { emission, ambient, diffuse, specular } = side.sources;
        let [emission, ambient, diffuse, specular] = [emission, ambient, diffuse, specular].map(of);
        let scene = converted(side.ambient);
        let scaled = |color| each(color, converted(side.factor), product);
        let mut primary = match (ambient, emission) {
            (Some(ambient), emitted) => each(scaled(ambient), emitted.unwrap_or(scene), add),
            (None, Some(emitted)) => each(scaled(emitted), scene, add),
            (None, None) => scene,
        };
        for (light, colors) in self.lights.iter().zip(&side.colors) {
            let shares = self.shares(light, side, surface);
            let add_light = |total: &mut [u32; 3], share: u32, color: [f32; 3], material: Option<[u32; 3]>| {
                let (share, color) = ([share; 3], converted(color));
                let (a, b) = material.map_or((share, color), |material| (each(share, color, product), material));
                *total = std::array::from_fn(|k| add_product(total[k], a[k], b[k]));
            };
            let [a, d, s] = *colors;
            add_light(&mut primary, shares.ambient, a, ambient);
            add_light(&mut primary, shares.diffuse, d, diffuse);
            add_light(secondary.as_mut().unwrap_or(&mut primary), shares.specular, s, specular);
        }
        (primary, secondary)
    }

    fn shares(&self, light: &Light, side: &Side, surface: &Surface) -> Shares {
        let (to_light, attenuation) = match *light {
            Light::Infinite { direction, .. } => (converted(direction), Some(ONE)),
            Light::Local { position, attenuation, range, spot } => {
                let v = each(words(position), surface.point, difference);
                let (to_light, length) = unit::direction(v);
                let [distance, square] = [length, unit::dot(v, v)].map(word);
                let reaches = !is_negative(single_sum(word(range.to_bits()), distance ^ SIGN));
                let attenuation = reaches.then(|| {
                    let attenuation = reciprocal(dot(converted(attenuation), [ONE, distance, square]));
                    spot.map_or(attenuation, |spot| spot.through(to_light, attenuation))
                });
                (to_light.map(word), attenuation)
            }
        };
        let Some(attenuation) = attenuation else { return Shares { ambient: 0, diffuse: 0, specular: 0 } };
        let normal = surface.normal.map(word);
        let facing = dot(normal, to_light);
        if is_negative(facing) {
            return Shares { ambient: attenuation, diffuse: 0, specular: 0 };
        }
        let [a, b, c, d, e, f] = converted(side.powers);
        let specular = match *light {
            Light::Infinite { half, .. } if !self.local_eye => {
                let x = dot(normal, converted(half));
                quotient(single_sum(x, a), attenuation, multiply_add(x, b, c))
            }
            _ => self.highlight([d, e, f], surface, normal, to_light, attenuation),
        };
        Shares { ambient: attenuation, diffuse: product(attenuation, facing), specular }
    }

    /// Returns the factor times (y d + x) / (y f + x e) of the squares x of the product of the normal and the half vector, and y of
    /// the half vector.
    fn highlight(
        &self,
        [d, e, f]: [u32; 3],
        surface: &Surface,
        normal: [u32; 3],
        to_light: [u32; 3],
        factor: u32,
    ) -> u32 {
        let eye =
            if self.local_eye { unit::direction(surface.to_eye).0.map(word) } else { converted(self.eye_direction) };
        let half = each(eye, to_light, add);
        let (square, along) = (dot(half, half), dot(normal, half));
        if is_negative(along) {
            return 0;
        }
        let x = single_product(along, along);
        let divisor = multiply_add(square, f, single_product(x, e));
        quotient(multiply_add(square, d, x), factor, divisor)
    }
}

impl SecondaryColor {
    fn of(self, color: [f32; 4]) -> [f32; 4] {
        let [r, g, b, _] = color;
        match self {
            SecondaryColor { enabled: false, .. } => [0.0, 0.0, 0.0, 1.0],
            SecondaryColor { keeps_alpha: true, .. } => color,
            SecondaryColor { keeps_alpha: false, .. } => [r, g, b, 1.0],
        }
    }
}
