//! Up to eight lights.
//!
//! Of a light with the distance d, the vector l to it and the normal n:
//!
//! ```text
//! attenuation  1 / (a0 + a1 d + a2 d^2), 0 beyond the range or outside of the cone
//! ambient      attenuation
//! diffuse      attenuation (n l), 0 if n l is negative
//! specular     attenuation f(x), 0 if n l or f's numerator is negative
//! f(x)         (x + A) / (x B + C), which Direct3D fits to x^power; x is n h of a far light and a far eye,
//!              else (x + D) / (x E + F) of x = (n h)^2 / h^2 with h = l + eye, for half the power
//! cone         the same function of min(s l + s', 1) with the words of the falloff, 0 if s l + s' is not positive
//! ```
//!
//! INFERRED: all but the cone are NV10's as envytools has them. The cone follows from the words that Direct3D and Mesa
//! compute for it, and from xemu.
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule")]

use ninebit::vertex::vector::{dot3, length, unit};

/// Where a colour of the material comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ColorSource {
    /// From the material, which the driver has multiplied into the lights' colours.
    Material,
    /// From the primary colour of the vertex.
    Diffuse,
    /// From the secondary colour of the vertex.
    Specular,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sources {
    pub(super) emission: ColorSource,
    pub(super) ambient: ColorSource,
    pub(super) diffuse: ColorSource,
    pub(super) specular: ColorSource,
}

/// The cone of a spotlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spot {
    pub(super) falloff: [f32; 3],
    pub(super) direction: [f32; 3],
    pub(super) offset: f32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Light {
    Infinite { direction: [f32; 3], half: [f32; 3] },
    Local { position: [f32; 3], attenuation: [f32; 3], range: f32, spot: Option<Spot> },
}

/// The material of one side, and the colours of the lights on it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Side {
    pub(super) sources: Sources,
    /// Light of the scene with the material's emission.
    pub(super) ambient: [f32; 3],
    /// What an ambient colour is multiplied by.
    pub(super) factor: [f32; 3],
    pub(super) alpha: f32,
    /// A to F.
    pub(super) powers: [f32; 6],
    /// Ambient, diffuse and specular colour of each light.
    pub(super) colors: Vec<[[f32; 3]; 3]>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lighting {
    pub(super) lights: Vec<Light>,
    pub(super) front: Side,
    pub(super) back: Option<Side>,
    pub(super) local_eye: bool,
    pub(super) eye_direction: [f32; 3],
}

/// A vertex to be lit.
pub(super) struct Surface {
    pub(super) point: [f32; 3],
    pub(super) normal: [f32; 3],
    /// The direction to the eye.
    pub(super) to_eye: [f32; 3],
    pub(super) diffuse: [f32; 4],
    pub(super) specular: [f32; 4],
}

/// How much of a light's three colours arrives.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shares {
    ambient: f32,
    diffuse: f32,
    specular: f32,
}

/// Returns the quotient of the unit, where 0 divided by anything is 0.
fn quotient(a: f32, b: f32) -> f32 {
    if a == 0.0 { 0.0 } else { a / b }
}

impl Spot {
    /// Returns the share that the cone lets through in the direction to the light.
    fn share(&self, to_light: [f32; 3]) -> f32 {
        let x = dot3(self.direction, to_light) + self.offset;
        if x <= 0.0 {
            return 0.0;
        }
        let [a, b, c] = self.falloff;
        let x = x.min(1.0);
        quotient((x + a).max(0.0), x * b + c)
    }
}

impl Lighting {
    /// Returns primary and secondary colour of the front. The secondary alpha is that of the vertex.
    pub(super) fn front(&self, surface: &Surface) -> [[f32; 4]; 2] {
        self.side(&self.front, surface, surface.normal)
    }

    /// Returns the colours of the back, if it is lit. Its normal is the other one. INFERRED from Mesa's driver: its sources
    /// are the front's colours of the vertex.
    pub(super) fn back(&self, surface: &Surface) -> Option<[[f32; 4]; 2]> {
        self.back.as_ref().map(|side| self.side(side, surface, surface.normal.map(|c| -c)))
    }

    fn side(&self, side: &Side, surface: &Surface, normal: [f32; 3]) -> [[f32; 4]; 2] {
        let rgb = |color: [f32; 4]| [color[0], color[1], color[2]];
        let of = |source: ColorSource, material: [f32; 3]| match source {
            ColorSource::Material => material,
            ColorSource::Diffuse => rgb(surface.diffuse),
            ColorSource::Specular => rgb(surface.specular),
        };
        let Sources { emission, ambient, diffuse, specular } = side.sources;
        let (lit, emitted) = (of(ambient, side.ambient), of(emission, side.ambient));
        let mut primary: [f32; 3] = std::array::from_fn(|k| lit[k] * side.factor[k] + emitted[k]);
        let mut secondary = [0.0; 3];
        // A material's own colours are in those of the lights.
        let [ambient, diffuse, specular] = [ambient, diffuse, specular].map(|source| of(source, [1.0; 3]));
        for (light, colors) in self.lights.iter().zip(&side.colors) {
            let shares = self.shares(light, side, surface, normal);
            for k in 0..3 {
                primary[k] += colors[0][k] * shares.ambient * ambient[k];
                primary[k] += colors[1][k] * shares.diffuse * diffuse[k];
                secondary[k] += colors[2][k] * shares.specular * specular[k];
            }
        }
        let alpha = match side.sources.diffuse {
            ColorSource::Material => side.alpha,
            ColorSource::Diffuse => surface.diffuse[3],
            ColorSource::Specular => surface.specular[3],
        };
        let with = |[r, g, b]: [f32; 3], alpha| [r, g, b, alpha];
        [with(primary, alpha), with(secondary, surface.specular[3])]
    }

    fn shares(&self, light: &Light, side: &Side, surface: &Surface, normal: [f32; 3]) -> Shares {
        let (to_light, attenuation) = match *light {
            Light::Infinite { direction, .. } => (direction, 1.0),
            Light::Local { position, attenuation: [a0, a1, a2], range, spot } => {
                let v = std::array::from_fn(|k| position[k] - surface.point[k]);
                let (distance, to_light) = (length(v), unit(v));
                let reaches =
                    if distance <= range { 1.0 / (a0 + a1 * distance + a2 * distance * distance) } else { 0.0 };
                (to_light, spot.map_or(reaches, |spot| reaches * spot.share(to_light)))
            }
        };
        let facing = dot3(normal, to_light);
        if attenuation == 0.0 || facing < 0.0 {
            return Shares { ambient: attenuation, diffuse: 0.0, specular: 0.0 };
        }
        let highlight = self.highlight(light, side, surface, normal, to_light);
        Shares { ambient: attenuation, diffuse: attenuation * facing, specular: attenuation * highlight }
    }

    fn highlight(&self, light: &Light, side: &Side, surface: &Surface, normal: [f32; 3], to_light: [f32; 3]) -> f32 {
        let [a, b, c, d, e, f] = side.powers;
        if let (Light::Infinite { half, .. }, false) = (*light, self.local_eye) {
            let x = dot3(normal, half);
            return quotient((x + a).max(0.0), x * b + c);
        }
        let eye = if self.local_eye { surface.to_eye } else { self.eye_direction };
        let half: [f32; 3] = std::array::from_fn(|k| eye[k] + to_light[k]);
        let (square, along) = (dot3(half, half), dot3(normal, half));
        if along < 0.0 {
            return 0.0;
        }
        let x = along * along;
        quotient((x + square * d).max(0.0), x * e + square * f)
    }
}
