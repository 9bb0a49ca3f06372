//! The stages of a texture shader as they are planned for a draw, and their coordinates as they are set up for a triangle.

use super::coordinates::Coordinates;
use super::planned::PlannedUnit;
use super::real::RealColor;
use crate::raster::attribute::Attribute;
use crate::raster::setup::Triangle;
use crate::state::{ShaderOperation, ShaderStage, TEXTURE_UNITS, TriangleVertices};

/// A texture shader reduced to what can reach the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedShader {
    /// The stages of the four units.
    pub stages: [PlannedShaderStage; TEXTURE_UNITS],
}

impl PlannedShader {
    /// Whether a stage can drop fragments.
    pub fn kills(&self) -> bool {
        self.stages.iter().any(|stage| matches!(stage.state.operation, ShaderOperation::CullFragment { .. }))
    }
}

/// A stage of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedShaderStage {
    /// What it does.
    pub state: ShaderStage,
    /// Index of its unit among those of the draw, if it samples.
    pub unit: Option<usize>,
    /// Channels of its register, R, G, B, A, that combiners or later stages read.
    pub live: u8,
    /// Its dot product is part of what is sampled.
    pub dots: bool,
}

impl PlannedShaderStage {
    /// Whether it has to run.
    pub fn runs(&self) -> bool {
        let drops = matches!(self.state.operation, ShaderOperation::CullFragment { .. });
        drops || self.dots || (self.live != 0 && self.state.operation != ShaderOperation::None)
    }
}

/// What a triangle's vertices give a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StageSetup {
    Nothing,
    /// Coordinates of its unit's image.
    Places(Coordinates),
    /// s, t, r, q as numbers.
    Numbers([Attribute; 4]),
}

/// The texture shader's coordinates, set up for one triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShaderSetup(pub(super) [StageSetup; TEXTURE_UNITS]);

impl ShaderSetup {
    /// Where a stage samples, before anything moves it.
    pub fn coordinates(&self, index: usize) -> Option<&Coordinates> {
        match &self.0[index] {
            StageSetup::Places(coordinates) => Some(coordinates),
            StageSetup::Nothing | StageSetup::Numbers(_) => None,
        }
    }

    /// Sets up every stage that runs.
    pub fn new(
        shader: &PlannedShader,
        units: &[PlannedUnit],
        triangle: &Triangle,
        vertices: TriangleVertices<'_>,
    ) -> Self {
        ShaderSetup(std::array::from_fn(|index| {
            let planned = &shader.stages[index];
            if !planned.runs() {
                return StageSetup::Nothing;
            }
            let set = vertices.coordinates(planned.state.coordinate_set);
            let component = |n: usize| set.map(|v| v[n]);
            match (planned.state.operation, planned.unit) {
                (ShaderOperation::Sample, Some(unit)) => {
                    StageSetup::Places(Coordinates::new(triangle, set, &units[unit]))
                }
                (ShaderOperation::BumpEnvironment { .. }, Some(unit)) => {
                    let unit = &units[unit];
                    let sides = unit.scale(&unit.levels[0]);
                    let plane = |n: usize| triangle.coordinate(component(n), sides[n]);
                    StageSetup::Places(Coordinates::Plane([plane(0), plane(1)]))
                }
                (operation, _)
                    if operation.is_dot()
                        || matches!(operation, ShaderOperation::PassThrough | ShaderOperation::CullFragment { .. }) =>
                {
                    StageSetup::Numbers([0, 1, 2, 3].map(|n| triangle.attribute(component(n))))
                }
                _ => StageSetup::Nothing,
            }
        }))
    }
}

/// A dot product, and what the ideal has in its place.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Dot {
    pub(super) fixed: f32,
    pub(super) real: f64,
}

/// The colour of an earlier unit as a stage reads it: bytes, whatever their sign flags.
#[derive(Clone, Copy, Debug)]
pub(super) struct Color {
    pub(super) unit: usize,
    pub(super) bytes: [u8; 4],
    /// The registers that they were taken from.
    pub(super) held: [i64; 4],
    /// Channels whose registers hold twice their two's complement value (TEX-18).
    pub(super) doubled: [bool; 4],
    pub(super) real: RealColor,
}
