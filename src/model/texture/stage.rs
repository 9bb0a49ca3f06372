//! The stages of a texture shader as planned for a draw, and their coordinates as set up for a triangle.

use super::coordinates::Coordinates;
use super::planned::PlannedUnit;
use super::real::RealColor;
use crate::raster::binary::Binary;
use crate::raster::weights::Linear;
use crate::state::{ShaderOperation, ShaderStage, TEXTURE_UNITS, TriangleVertices};

/// A texture shader, reduced to what can reach the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedShader {
    /// The stages of the four units.
    pub stages: [PlannedShaderStage; TEXTURE_UNITS],
}

impl PlannedShader {
    /// Returns whether a stage can drop fragments.
    pub(crate) fn kills(&self) -> bool {
        self.stages.iter().any(|stage| matches!(stage.state.operation, ShaderOperation::CullFragment { .. }))
    }
}

/// A planned stage of the texture shader.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedShaderStage {
    /// State of the stage.
    pub state: ShaderStage,
    /// Index of the stage's unit among those of the draw, if the stage samples.
    pub unit: Option<usize>,
    /// Channels of its register that combiners or later stages read, as bits 1, 2, 4, 8 for R, G, B, A.
    pub live: u8,
    /// Whether its dot product is needed for sampling.
    pub dots: bool,
    /// Whether normals count as unit vectors in a reflection, which TSH-5 does not assume.
    pub unit_normals: bool,
    /// Whether a luminance multiplies alpha too, which TSH-8 does not.
    pub lights_alpha: bool,
    /// Whether the ideal's luminance is a signed byte, in 254ths from its least value, which TSH-8's is not.
    pub signed_luminance: bool,
}

impl PlannedShaderStage {
    /// Returns whether the stage has to run.
    pub fn runs(&self) -> bool {
        let drops = matches!(self.state.operation, ShaderOperation::CullFragment { .. });
        drops || self.dots || (self.live != 0 && self.state.operation != ShaderOperation::None)
    }
}

/// The coordinates of a stage, set up from a triangle's vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StageSetup {
    Nothing,
    /// Coordinates on the image of its unit.
    Places(Coordinates),
    /// s, t, r, q, interpolated as numbers.
    Numbers([Linear<Binary>; 4]),
}

/// The coordinates of the texture shader, set up for one triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShaderSetup(pub(super) [StageSetup; TEXTURE_UNITS]);

impl ShaderSetup {
    /// Returns the coordinates at which a stage samples, before they are displaced. Returns `None` if the stage has no
    /// interpolated coordinates on an image.
    pub(crate) fn coordinates(&self, index: usize) -> Option<&Coordinates> {
        match &self.0[index] {
            StageSetup::Places(coordinates) => Some(coordinates),
            StageSetup::Nothing | StageSetup::Numbers(_) => None,
        }
    }

    /// Replaces the coordinates at which a stage samples, if it has any.
    pub(crate) fn replace_coordinates(&mut self, index: usize, coordinates: Coordinates) {
        if matches!(self.0[index], StageSetup::Places(_)) {
            self.0[index] = StageSetup::Places(coordinates);
        }
    }

    /// Sets up every stage that runs.
    pub fn new(shader: &PlannedShader, units: &[PlannedUnit], vertices: TriangleVertices<'_>) -> Self {
        ShaderSetup(std::array::from_fn(|index| {
            let planned = &shader.stages[index];
            if !planned.runs() {
                return StageSetup::Nothing;
            }
            let set = vertices.coordinates(planned.state.coordinate_set);
            let component = |n: usize| Linear::new(set.map(|v| v[n]));
            let operation = planned.state.operation;
            let of_numbers = operation.is_dot()
                || matches!(operation, ShaderOperation::PassThrough | ShaderOperation::CullFragment { .. });
            match (operation, planned.unit) {
                (operation, Some(unit)) if operation.samples_own() => {
                    StageSetup::Places(Coordinates::new(set, &units[unit]))
                }
                (ShaderOperation::BumpEnvironment { .. }, Some(_)) => {
                    StageSetup::Places(Coordinates::Plane([component(0), component(1)]))
                }
                _ if of_numbers => StageSetup::Numbers([0, 1, 2, 3].map(component)),
                _ => StageSetup::Nothing,
            }
        }))
    }
}

/// A dot product of the definition and of the ideal.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Dot {
    pub(super) fixed: f32,
    pub(super) real: f64,
}

/// The colour of an earlier unit as a stage reads it: as bytes, whatever their sign flags.
#[derive(Clone, Copy, Debug)]
pub(super) struct Color {
    pub(super) unit: usize,
    pub(super) bytes: [u8; 4],
    /// The registers that the bytes were taken from.
    pub(super) held: [i64; 4],
    /// Whether the register of each channel holds twice its two's complement value (TEX-18).
    pub(super) doubled: [bool; 4],
    pub(super) real: RealColor,
}
