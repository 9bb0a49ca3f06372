//! Computes what a picture ought to show: the lighting equation in float64, with vectors of unit length at every pixel.
//!
//! A scene's `truth` describes the light, eye, material and surface. [`evaluate`] takes the pixels that the engine covers,
//! interpolates the mesh at their centres in perspective, and computes the light there. Nothing is quantised unless the
//! truth starts from stored bytes. So the difference to the chip's picture is the whole error of a technique: its inputs, its
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
    /// The model of highlights.
    pub enum Model {
        /// The normal's cosine with the half vector, the mean of the directions to light and eye.
        Blinn,
        /// The reflected light's cosine with the direction to the eye.
        Phong,
    }
}
named! {
    /// The space of the normals in a register.
    pub enum Space {
        /// Along tangent, binormal and normal of the mesh.
        Tangent,
        /// The space of the mesh's positions.
        Object,
    }
}
named! {
    /// An interpolated attribute of the vertices that holds a vector.
    pub enum VectorAttribute {
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
    /// A position in object space.
    Position([f64; 3]),
    /// Infinitely far away in this direction, which may have any length.
    Direction([f64; 3]),
}

/// A light with its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Position of the light, or direction toward it.
    pub place: Place,
    /// R, G and B; 1 is full.
    pub color: [f64; 3],
}

/// The viewer: local if it has a position, infinite if it has a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eye(pub Place);

/// The material of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// R, G and B that are there without light.
    pub ambient: [f64; 3],
    /// R, G and B of diffuse reflection.
    pub diffuse: [f64; 3],
    /// R, G and B of highlights.
    pub specular: [f64; 3],
    /// Exponent of highlights.
    pub exponent: u32,
    /// The model of highlights.
    pub model: Model,
    /// Whether the surface has no highlight where the light is behind it.
    pub self_shadowing: bool,
}

/// The largest exponent of a highlight.
pub(crate) const LARGEST_EXPONENT: u32 = 65_536;

/// Source of the surface's normals. Normals of hemispheres and maps are relative to tangent, binormal and normal of the mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum NormalSource {
    /// The interpolated normals of the mesh.
    Mesh,
    /// Directions away from a point, as on a sphere about it.
    Radial {
        /// The point, in object space.
        center: [f64; 3],
    },
    /// A hemisphere across the texture (`generate::hemisphere`), exact at every point.
    Hemisphere {
        /// Whether the normal is the zero vector around the hemisphere, instead of that of a flat surface.
        zero_outside: bool,
    },
    /// Normals on texels, interpolated and normalised.
    Map(Arc<Field<3>>),
}

/// The quantity that is computed at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Equation {
    /// Light on a material.
    Lighting,
    /// (2s - 1)(2t - 1); negative products become 0.
    SignedProduct,
    /// s - t; negative differences become 0.
    Difference,
    /// The dot product of two interpolated vectors, which are not normalised; negative products become 0.
    DotProduct(VectorAttribute, VectorAttribute),
}

/// The place where a technique's normals are read, before they are lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalHolder {
    /// A texture or colour register at the start of a pixel. Its bytes stand for -1 to 1.
    Register(Register),
    /// The unit of a texture shader's dot product. The normal is the vector that the unit's mapping makes of an earlier unit's colour (TSH-3); it may
    /// have more than eight bits a component.
    DotProduct(usize),
}

/// Where a technique keeps its normals, and in which space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShadingNormal {
    /// The place of the normals.
    pub holder: NormalHolder,
    /// The space of the normals.
    pub space: Space,
}

/// What a scene's picture ought to show.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// The quantity that is computed.
    pub equation: Equation,
    /// Source of the surface's normals.
    pub normal: NormalSource,
    /// The lights, whose contributions are added.
    pub lights: Vec<Light>,
    /// The viewer, needed for highlights.
    pub eye: Option<Eye>,
    /// The surface's material.
    pub material: Material,
    /// Light from all around, if any.
    pub hemisphere: Option<HemisphereLight>,
    /// The share of that light that reaches each texel, 0 to 1.
    pub occlusion: Option<Arc<Field<1>>>,
    /// R, G and B by which all light is multiplied.
    pub color_map: Option<Arc<Field<3>>>,
    /// Where the technique keeps its normals, if they are to be measured.
    pub shading_normal: Option<ShadingNormal>,
    /// The mesh of each draw; `None` for draws that do not take part in the truth.
    pub meshes: Vec<Option<Arc<Mesh>>>,
}
