//! What a picture ought to show: the lighting equation in float64, with vectors of unit length at every pixel.
//!
//! A scene's `truth` says which light, eye, material and surface are meant. [`evaluate`] takes the very pixels that the engine covers,
//! interpolates what the mesh gives at their centres in perspective, and computes the light there. Nothing in it is quantised unless the
//! truth is told to start from stored bytes; so what the chip's picture is off by is the whole error of a technique: its inputs, its
//! shortcuts, and its arithmetic.
#![allow(clippy::float_arithmetic, reason = "what pictures are measured against; no stored byte")]

mod field;
mod lighting;
mod pixels;

use std::sync::Arc;

pub use field::Field;
pub(crate) use pixels::real_color;
pub use pixels::{Pixel, TruthFrame, Visible, evaluate};

pub use crate::generate::sky::{HemisphereLight, Integral};
use crate::mesh::Mesh;
use ninebit::state::{Register, named};

named! {
    /// How a highlight is modelled.
    pub enum Model {
        /// The normal's cosine with the half vector, the mean of the directions to light and eye.
        Blinn,
        /// The reflected light's cosine with the direction to the eye.
        Phong,
    }
}
named! {
    /// The space of a register's normals.
    pub enum Space {
        /// Along tangent, binormal and normal of the mesh.
        Tangent,
        /// The space of the mesh's positions.
        Object,
    }
}
named! {
    /// A quantity of the vertices that holds a vector.
    pub enum Interpolated {
        /// The primary colour, 0..1 standing for -1..1.
        PrimaryColor,
        /// The secondary colour, 0..1 standing for -1..1.
        SecondaryColor,
        /// s, t, r of coordinate set 0.
        T0,
        /// s, t, r of coordinate set 1.
        T1,
        /// s, t, r of coordinate set 2.
        T2,
        /// s, t, r of coordinate set 3.
        T3,
    }
}

/// The place of a light or an eye, in object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// A point in object space.
    Position([f64; 3]),
    /// Far away in that direction; any length.
    Direction([f64; 3]),
}

/// A light with its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// The point or direction from which it shines.
    pub place: Place,
    /// R, G, B; 1 is full.
    pub color: [f64; 3],
}

/// The viewer: local if it has a position, infinite if it has a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eye(pub Place);

/// What a surface does with light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// R, G, B that are there without light.
    pub ambient: [f64; 3],
    /// R, G, B of diffuse light.
    pub diffuse: [f64; 3],
    /// R, G, B of highlights.
    pub specular: [f64; 3],
    /// The power of highlights.
    pub exponent: u32,
    /// How highlights are modelled.
    pub model: Model,
    /// Where the light is behind the surface there is no highlight.
    pub self_shadowing: bool,
}

/// The largest exponent of a highlight.
pub(crate) const LARGEST_EXPONENT: u32 = 65_536;

/// Where the surface's normals come from. Those of maps stand along tangent, binormal and normal of the mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum NormalSource {
    /// The mesh, interpolated.
    Mesh,
    /// Away from a point: a sphere about it.
    Radial {
        /// The point, object space.
        center: [f64; 3],
    },
    /// A hemisphere across the texture (`generate::hemisphere`), exact at every point.
    Hemisphere {
        /// Around it is the zero vector in place of a flat surface.
        zero_outside: bool,
    },
    /// Normals on texels, mixed between them and brought to unit length.
    Map(Arc<Field<3>>),
}

/// What is computed at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Equation {
    /// Light on a material, by `lighting`.
    Lighting,
    /// (2s - 1)(2t - 1), negative products being 0.
    SignedProduct,
    /// s - t, negative differences being 0.
    Difference,
    /// The dot product of two interpolated vectors, as long as they are; negative ones being 0.
    DotProduct(Interpolated, Interpolated),
}

/// Where a technique's normals are read before light falls on them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalHolder {
    /// A register when a pixel begins: a texture or a colour. Its bytes stand for -1 to 1.
    Register(Register),
    /// A unit of the texture shader that takes a dot product: the vector that its mapping makes of an earlier unit's colour (TSH-3), which may
    /// have more than eight bits a component.
    DotProduct(usize),
}

/// Where a technique's normals are, and what they mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShadingNormal {
    /// What holds the normals.
    pub holder: NormalHolder,
    /// The space of the vectors.
    pub space: Space,
}

/// What a scene's picture ought to show.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// What is computed.
    pub equation: Equation,
    /// Where the surface's normals come from.
    pub normal: NormalSource,
    /// The lights, whose contributions are added.
    pub lights: Vec<Light>,
    /// The viewer, for highlights.
    pub eye: Option<Eye>,
    /// The surface's material.
    pub material: Material,
    /// Light from all around.
    pub hemisphere: Option<HemisphereLight>,
    /// What of that light reaches a texel: 0 to 1.
    pub occlusion: Option<Arc<Field<1>>>,
    /// R, G, B that multiply everything.
    pub color_map: Option<Arc<Field<3>>>,
    /// Where the technique keeps its normals, if it has them.
    pub shading_normal: Option<ShadingNormal>,
    /// The mesh of each draw; `None` for draws that the truth says nothing of.
    pub meshes: Vec<Option<Arc<Mesh>>>,
}
