//! The fixed-function pipe: eye space, skinning, lighting, generated coordinates, fog and sizes of points.
//!
//! INFERRED: the formulas are those of envytools' model of NV10 (`nvhw/pgraph_celsius_xfrm.c`, which its `hwtest` compares
//! with cards) where that chip has the state, and of xemu and Mesa's nouveau driver for what is new; they agree where they
//! overlap, unless a comment says so. Positions, eye space and fog coordinates are in the arithmetic of the transform unit
//! (VTX-5), colours in that of the light unit (VTX-6). Generated coordinates are binary32 in the order in which they are
//! written; the chip cuts them.
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule")]

mod read;

use super::{ATTRIBUTES, Attributes, Outputs, attribute};
use ninebit::number::transform::{ONE, SIGN, product, sum};
use ninebit::state::Profile;
use ninebit::vertex::light::{Shading, Surface};
use ninebit::vertex::point::PointParameters;
use ninebit::vertex::texgen::CoordinateSet;
use ninebit::vertex::unit::{self, words};
use ninebit::vertex::vector::length;
use ninebit::vertex::{EyeVertex, ModelView, ObjectVertex, Rows, Viewer};

/// The state of the fixed-function pipe, as a log set it.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedFunction {
    chip: Profile,
    /// From object space to clip space, or from eye space where vertices have weights.
    composite: Rows,
    /// The matrices to eye space, none if nothing needs them.
    model_view: Vec<Rows>,
    /// The matrices of normals, none if nothing needs them.
    normal: Vec<Rows>,
    skin: Option<Skin>,
    normalizes: bool,
    eye: [f32; 3],
    viewer_is_far: bool,
    sets: [CoordinateSet; 4],
    shading: Shading,
    fog: Option<Fog>,
    points: Option<PointParameters>,
    /// What is added to a position after its division (0x0a20).
    pub viewport_offset: [f32; 4],
    /// The methods that the enabled state needs and the log never set. They count as 0.
    pub missing: Vec<u32>,
    /// Methods whose words mean nothing that is known, with the words. They count as 0.
    pub unknown: Vec<(u32, u32)>,
}

/// How weights blend matrices.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Skin {
    /// Number of matrices, 2 to 4.
    matrices: usize,
    /// Whether the last weight is 1 less the others.
    completes: bool,
}

impl Skin {
    /// Returns the weight of each matrix.
    fn weights(self, given: [f32; 4]) -> [u32; 4] {
        let mut weights = words(given);
        if self.completes {
            let last = self.matrices - 1;
            weights[last] = weights[..last].iter().fold(1.0_f32.to_bits(), |left, weight| sum([left, weight ^ SIGN]));
        }
        weights
    }
}

/// Where the fog coordinate comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fog {
    SpecularAlpha,
    Radial,
    Planar { plane: [f32; 4], absolute: bool },
    Vertex,
}

/// A vertex in eye space.
struct Eye {
    position: [f32; 4],
    normal: [f32; 3],
    /// From the vertex to the eye.
    to_eye: [f32; 3],
    /// The vertex as light falls on it.
    surface: Surface,
}

impl FixedFunction {
    /// Transforms and lights a vertex. The position is that in the window, with w of clip space.
    pub fn run(&self, inputs: &Attributes) -> Outputs {
        let eye = self.eye(inputs);
        let position = if self.skin.is_some() { eye.position } else { inputs[attribute::POSITION] };
        let mut outputs = self.colors(&eye, inputs);
        let [right, down, far, _] = self.viewport_offset;
        outputs.position = unit::window(unit::transform(&self.composite, words(position)), [right, down, far]);
        outputs.coordinates = self.coordinates(&eye, inputs);
        outputs.fog = self.fog(&eye, inputs);
        outputs.point_size = self.points.map_or(0.0, |points| f32::from(points.size(length(eye.to_eye))) / 8.0);
        outputs
    }

    /// Returns which attributes are read for certain. Texture coordinates are not among them: which sets count depends on the units.
    pub fn inputs(&self) -> [bool; ATTRIBUTES] {
        let mut read = [false; ATTRIBUTES];
        let is_lit = self.shading.lighting.is_some();
        read[attribute::POSITION] = true;
        read[attribute::WEIGHT] = self.skin.is_some();
        read[attribute::NORMAL] = is_lit;
        read[attribute::DIFFUSE] = !is_lit;
        read[attribute::SPECULAR] = !is_lit && self.shading.secondary.enabled;
        read[attribute::FOG] = matches!(self.fog, Some(Fog::Vertex));
        read
    }

    fn eye(&self, inputs: &Attributes) -> Eye {
        let weights = inputs[attribute::WEIGHT];
        let position = self.blended(&self.model_view, weights, inputs[attribute::POSITION]);
        let [x, y, z, _] = inputs[attribute::NORMAL];
        let [x, y, z, _] = self.blended(&self.normal, weights, [x, y, z, 0.0]);
        let normal = if self.normalizes { unit::direction([x, y, z]).0 } else { [x, y, z] };
        let surface = Surface::new(position, normal, self.eye);
        let real = |v: [u32; 3]| v.map(f32::from_bits);
        Eye { position: position.map(f32::from_bits), normal: real(normal), to_eye: real(surface.to_eye), surface }
    }

    /// Returns the sum of M v with the weight of each matrix M, or the product with the only one.
    fn blended(&self, matrices: &[Rows], weights: [f32; 4], v: [f32; 4]) -> [u32; 4] {
        let v = words(v);
        let Some(skin) = self.skin else {
            return matrices.first().map_or([0; 4], |matrix| unit::transform(matrix, v));
        };
        let weighted = matrices
            .iter()
            .zip(skin.weights(weights))
            .map(|(matrix, weight)| unit::transform(matrix, v).map(|c| product(c, weight)));
        weighted.fold([0; 4], |total, part| std::array::from_fn(|k| sum([total[k], part[k]])))
    }

    fn coordinates(&self, eye: &Eye, inputs: &Attributes) -> [[f32; 4]; 4] {
        let [x, y, z, _] = inputs[attribute::NORMAL];
        let object = ObjectVertex {
            position: inputs[attribute::POSITION],
            normal: [x, y, z],
            fog_coordinate: 0.0,
            dimensions: [4; 4],
        };
        // Only embossing reads this matrix, which the class does not have.
        let model_view = ModelView::new(&[[0.0; 4]; 4]);
        let sight = eye.to_eye.map(|c| -c);
        let vertex = EyeVertex {
            object: &object,
            model_view: &model_view,
            position: eye.position,
            normal: eye.normal,
            viewer: if self.viewer_is_far { Viewer::FAR } else { Viewer::Infinite(sight) },
        };
        let given = [0, 1, 2, 3].map(|set| inputs[attribute::TEXTURE + set]);
        [0, 1, 2, 3].map(|set| self.sets[set].at(&vertex, &given, self.chip))
    }

    fn fog(&self, eye: &Eye, inputs: &Attributes) -> f32 {
        match self.fog {
            None => 0.0,
            // INFERRED, from xemu: limited to 0 to 1.
            Some(Fog::SpecularAlpha) => inputs[attribute::SPECULAR][3].clamp(0.0, 1.0),
            Some(Fog::Radial) => f32::from_bits(unit::direction(eye.surface.to_eye).1),
            Some(Fog::Planar { plane, absolute }) => {
                let [x, y, z] = eye.surface.point;
                let distance = f32::from_bits(unit::dot([x, y, z, ONE], words(plane)));
                if absolute { distance.abs() } else { distance }
            }
            Some(Fog::Vertex) => inputs[attribute::FOG][0],
        }
    }

    /// Returns outputs of which the colours are right.
    fn colors(&self, eye: &Eye, inputs: &Attributes) -> Outputs {
        let given = [inputs[attribute::DIFFUSE], inputs[attribute::SPECULAR]];
        let ([diffuse, specular], back) = self.shading.colors(&eye.surface, given);
        let [back_diffuse, back_specular] =
            back.unwrap_or([inputs[attribute::BACK_DIFFUSE], inputs[attribute::BACK_SPECULAR]]);
        Outputs {
            position: [0.0; 4],
            diffuse,
            specular,
            back_diffuse,
            back_specular,
            fog: 0.0,
            point_size: 0.0,
            coordinates: [[0.0; 4]; 4],
        }
    }
}

#[cfg(test)]
mod tests;
