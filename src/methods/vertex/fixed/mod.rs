//! The fixed-function pipe: eye space, skinning, lighting, generated coordinates, fog and sizes of points.
//!
//! INFERRED: the formulas are those of envytools' model of NV10 (`nvhw/pgraph_celsius_xfrm.c`, which its `hwtest` compares
//! with cards) where that chip has the state, and of xemu and Mesa's nouveau driver for what is new; they agree where they
//! overlap, unless a comment says so. Positions, eye space and fog coordinates are in the arithmetic of the transform unit
//! (VTX-5). Generated coordinates and light are binary32 in the order in which they are written; the chip cuts
//! the first, and its light unit has 14 significant bits.
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule")]

mod light;
mod read;

use super::{ATTRIBUTES, Attributes, Outputs, attribute};
use light::{Lighting, Surface};
use ninebit::number::transform::{SIGN, is_zero, product, reciprocal, sum};
use ninebit::state::Profile;
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
    lighting: Option<Lighting>,
    specular: Specular,
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

/// What becomes of secondary colours.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Specular {
    enabled: bool,
    /// Whether specular light is kept apart from the primary colour.
    separate: bool,
    /// Whether alpha is that of the vertex, in place of 1.
    keeps_alpha: bool,
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
    /// The position divided by its w.
    point: [f32; 3],
    normal: [f32; 3],
    /// From the vertex to the eye.
    to_eye: [f32; 3],
    /// The same, of unit length or zero.
    toward: [f32; 3],
    distance: f32,
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
        let is_lit = self.lighting.is_some();
        read[attribute::POSITION] = true;
        read[attribute::WEIGHT] = self.skin.is_some();
        read[attribute::NORMAL] = is_lit;
        read[attribute::DIFFUSE] = !is_lit;
        read[attribute::SPECULAR] = !is_lit && self.specular.enabled;
        read[attribute::FOG] = matches!(self.fog, Some(Fog::Vertex));
        read
    }

    fn eye(&self, inputs: &Attributes) -> Eye {
        let weights = inputs[attribute::WEIGHT];
        let position = self.blended(&self.model_view, weights, inputs[attribute::POSITION]);
        let [x, y, z, w] = position;
        let point = if is_zero(w) { [x, y, z] } else { [x, y, z].map(|c| product(c, reciprocal(w))) };
        let [x, y, z, _] = inputs[attribute::NORMAL];
        let [x, y, z, _] = self.blended(&self.normal, weights, [x, y, z, 0.0]);
        let normal = if self.normalizes { unit::direction([x, y, z]).0 } else { [x, y, z] };
        let to_eye = std::array::from_fn(|k| sum([self.eye[k].to_bits(), point[k] ^ SIGN]));
        let (toward, distance) = unit::direction(to_eye);
        let real = |v: [u32; 3]| v.map(f32::from_bits);
        Eye {
            position: position.map(f32::from_bits),
            point: real(point),
            normal: real(normal),
            to_eye: real(to_eye),
            toward: real(toward),
            distance: f32::from_bits(distance),
        }
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
        let [x, y, z] = eye.point;
        match self.fog {
            None => 0.0,
            // INFERRED, from xemu: limited to 0 to 1.
            Some(Fog::SpecularAlpha) => inputs[attribute::SPECULAR][3].clamp(0.0, 1.0),
            Some(Fog::Radial) => eye.distance,
            Some(Fog::Planar { plane, absolute }) => {
                let distance = f32::from_bits(unit::dot(words([x, y, z, 1.0]), words(plane)));
                if absolute { distance.abs() } else { distance }
            }
            Some(Fog::Vertex) => inputs[attribute::FOG][0],
        }
    }

    /// Returns outputs of which the colours are right.
    fn colors(&self, eye: &Eye, inputs: &Attributes) -> Outputs {
        let mut outputs = Outputs {
            position: [0.0; 4],
            diffuse: inputs[attribute::DIFFUSE],
            specular: inputs[attribute::SPECULAR],
            back_diffuse: inputs[attribute::BACK_DIFFUSE],
            back_specular: inputs[attribute::BACK_SPECULAR],
            fog: 0.0,
            point_size: 0.0,
            coordinates: [[0.0; 4]; 4],
        };
        if let Some(lighting) = &self.lighting {
            let surface = Surface {
                point: eye.point,
                normal: eye.normal,
                to_eye: eye.toward,
                diffuse: outputs.diffuse,
                specular: outputs.specular,
            };
            [outputs.diffuse, outputs.specular] = lighting.front(&surface);
            if let Some(back) = lighting.back(&surface) {
                [outputs.back_diffuse, outputs.back_specular] = back;
            }
        }
        self.secondary(&mut outputs, inputs);
        outputs
    }

    /// Puts specular light where it belongs. INFERRED, from xemu.
    fn secondary(&self, outputs: &mut Outputs, inputs: &Attributes) {
        let Specular { enabled, separate, keeps_alpha } = self.specular;
        if enabled && !separate {
            if self.lighting.is_some() {
                for k in 0..3 {
                    outputs.diffuse[k] += outputs.specular[k];
                    outputs.back_diffuse[k] += outputs.back_specular[k];
                }
            }
            outputs.specular = inputs[attribute::SPECULAR];
            outputs.back_specular = inputs[attribute::BACK_SPECULAR];
        }
        for color in [&mut outputs.specular, &mut outputs.back_specular] {
            if !enabled {
                *color = super::DEFAULT;
            } else if !keeps_alpha {
                color[3] = 1.0;
            }
        }
    }
}

#[cfg(test)]
mod tests;
