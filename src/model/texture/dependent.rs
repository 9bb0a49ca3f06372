//! Dependent reads: where a stage of the texture shader samples if its coordinates come from earlier units.

use super::coordinates::{Real, SampleCoordinates, face_of, on_face};
use super::cube::Face;
use super::lod::Quad;
use super::other_kind::{end_of_face, of_direction};
use super::planned::PlannedUnit;
use super::real::RealTarget;
use super::report::Report;
use super::shader;
use super::shader_report;
use crate::raster::binary::Binary;
use crate::raster::interpolate::{COORDINATE_LIMIT, FARTHEST, Sample};
use crate::raster::weights::Linear;
use crate::state::{DependentScale, Level, TriangleVertices};
use crate::trace::{Observer, Rule};

/// The coordinates of a dependent read.
#[derive(Clone, Copy, Debug)]
pub enum Target<'a> {
    /// Interpolated coordinates that are displaced (TSH-7).
    Moved(Displacement<'a>),
    /// Two bytes of a colour (TSH-6).
    Bytes([u8; 2], DependentScale),
    /// Two results of the dot unit, where 1.0 spans the whole image, or texels of a rectangle (TSH-4).
    Floats([f32; 2]),
    /// Two results of the dot unit whose signs choose ends of face +X (TEX-20).
    Ends([f32; 2]),
    /// A direction that the dot unit computed (TSH-4, TSH-5).
    Vector([f32; 3]),
}

/// TSH-7: s and t, and their displacement.
#[derive(Clone, Copy, Debug)]
pub struct Displacement<'a> {
    /// s and t of the vertices. q has no effect.
    pub st: &'a [Linear<Binary>; 2],
    /// The sample point of the pixel.
    pub at: &'a Sample<'a>,
    /// The vertices of the triangle, for traces.
    pub vertices: TriangleVertices<'a>,
    /// The matrix m0 to m3 in register order.
    pub matrix: [f32; 4],
    /// Blue and green bytes of the earlier unit.
    pub blue_green: [u8; 2],
}

/// Returns a vector of the dot unit as numbers.
fn direction(vector: [f32; 3]) -> [Binary; 3] {
    shader::direction(vector.map(|component| component.to_bits().into()))
}

impl Displacement<'_> {
    /// Returns the entries of the matrix that multiply blue and green: along u, then along v.
    pub(crate) fn entries(&self) -> [[f32; 2]; 2] {
        let [m0, m1, m2, m3] = self.matrix;
        [[m0, m3], [m1, m2]]
    }

    /// Returns the displacements along u and v, in 128ths of the image.
    pub(crate) fn offsets(&self) -> [f32; 2] {
        self.entries().map(|entries| shader::offset(entries, self.blue_green))
    }

    /// Returns the displaced coordinates in 2^-`power` texel of a level.
    fn on(&self, unit: &PlannedUnit, level: &Level, power: i64, limit: i64) -> [i64; 2] {
        let (sides, offsets) = (unit.scale(level), self.offsets());
        std::array::from_fn(|n| {
            let (value, offset) = (self.at.value(&self.st[n]), offsets[n].to_bits().into());
            shader::moved(value, offset, sides[n].into(), power, limit)
        })
    }
}

impl Target<'_> {
    /// Returns the face of a cube map, or [`Face::PositiveX`] for other kinds of texture.
    pub(crate) fn face(&self) -> Face {
        match self {
            Target::Vector(vector) => face_of(direction(*vector)),
            Target::Moved(_) | Target::Bytes(..) | Target::Floats(_) | Target::Ends(_) => Face::PositiveX,
        }
    }

    /// Returns u and v on a level, in 1/256 texel.
    pub(crate) fn on(&self, unit: &PlannedUnit, level: &Level) -> [i64; 2] {
        let sides = unit.scale(level).map(i64::from);
        let each = |of: &dyn Fn(usize) -> i64| [of(0), of(1)];
        match self {
            Target::Moved(moved) => moved.on(unit, level, 8, COORDINATE_LIMIT),
            Target::Bytes(bytes, scale) => each(&|n| shader::dependent(bytes[n].into(), sides[n], *scale)),
            Target::Floats(floats) => each(&|n| shader::coordinate(floats[n].to_bits().into(), sides[n])),
            Target::Ends(dots) => each(&|n| end_of_face(n, dots[n].to_bits().into(), sides[n], 8)),
            Target::Vector(vector) => of_direction(unit, on_face(direction(*vector), self.face()), sides, 8),
        }
    }

    /// Returns u and v on level 0 and a face, in 1/65536 texel (TEX-11), or `None` if the direction points away from
    /// the face.
    pub(crate) fn at_quad(&self, unit: &PlannedUnit, face: Face) -> Option<[i64; 2]> {
        let level = &unit.levels[0];
        let sides = unit.scale(level).map(i64::from);
        let each = |of: &dyn Fn(usize) -> i64| [of(0), of(1)];
        Some(match self {
            Target::Moved(moved) => moved.on(unit, level, 16, FARTHEST),
            Target::Bytes(bytes, scale) => each(&|n| shader::dependent(bytes[n].into(), sides[n] << 8, *scale)),
            Target::Floats(floats) => each(&|n| shader::quad_coordinate(floats[n].to_bits().into(), sides[n])),
            Target::Ends(dots) => each(&|n| end_of_face(n, dots[n].to_bits().into(), sides[n], 16)),
            Target::Vector(vector) => {
                let direction = on_face(direction(*vector), face);
                if direction[2].mantissa <= 0 {
                    return None;
                }
                of_direction(unit, direction, sides, 16)
            }
        })
    }

    /// Returns these coordinates as real numbers, for an ideal that follows the definition. `interpolated` returns the
    /// ideal's s and t.
    pub fn followed(&self, interpolated: impl FnOnce() -> [f64; 2]) -> RealTarget {
        match self {
            Target::Moved(moved) => {
                let [blue, green] = moved.blue_green.map(f64::from);
                let color = super::real::RealColor::from_bytes([0.0, green, blue, 0.0]);
                RealTarget::moved(interpolated(), super::real::offset(moved.matrix, &color))
            }
            Target::Bytes(bytes, scale) => {
                let whole = match scale {
                    DependentScale::Over255 => 255.0,
                    DependentScale::Over256 => 256.0,
                };
                RealTarget::bytes(bytes.map(f64::from), whole)
            }
            Target::Floats(floats) => RealTarget::Coordinates(floats.map(f64::from)),
            Target::Ends(dots) => RealTarget::ends(dots.map(f64::from)),
            Target::Vector(vector) => RealTarget::Vector(vector.map(f64::from)),
        }
    }
}

/// The results of the same chain of stages at the three pixels of the quad that determine the lod.
#[derive(Clone, Copy, Debug)]
pub struct QuadTargets {
    /// u and v of the definition, on the face of the first pixel.
    pub fixed: Quad,
    /// s and t of the ideal.
    pub real: [[f64; 2]; 3],
    /// The face of the first pixel.
    pub face: Face,
}

/// Coordinates that come from an earlier unit.
#[derive(Clone, Copy, Debug)]
pub struct Dependent<'a> {
    /// The unit that samples.
    pub unit: &'a PlannedUnit,
    /// Where the unit samples.
    pub target: Target<'a>,
    /// Where the ideal samples. It is valid only if something uses real numbers.
    pub real: RealTarget,
    /// The quad, if the lod is needed and no pixel of the quad lies behind the viewer.
    pub quad: Option<QuadTargets>,
}

impl SampleCoordinates for Dependent<'_> {
    fn face(&self) -> Face {
        self.target.face()
    }

    fn on(&self, level: &Level) -> [i64; 2] {
        self.target.on(self.unit, level)
    }

    fn quad(&self) -> Option<Quad> {
        self.quad.map(|quad| quad.fixed)
    }

    fn real(&self, face: Option<Face>) -> Real {
        self.real.real(self.unit.kind, face)
    }

    fn real_quad(&self) -> Option<[[f64; 2]; 3]> {
        self.quad.map(|quad| quad.real)
    }

    fn rule(&self) -> Rule {
        match self.target {
            _ if self.unit.is_other_kind() => Rule::Tex20,
            Target::Moved(_) => Rule::Tsh7,
            Target::Bytes(..) => Rule::Tsh6,
            Target::Floats(_) | Target::Ends(_) | Target::Vector(_) => Rule::Tsh4,
        }
    }

    fn describe<O: Observer>(
        &self,
        report: &Report<'_>,
        level: &Level,
        floored: [i64; 2],
        ideal: [f64; 2],
        observer: &mut O,
    ) {
        shader_report::coordinates(self, report, level, floored, ideal, observer);
    }

    fn describe_quad<O: Observer>(&self, report: &Report<'_>, observer: &mut O) {
        shader_report::quad(self, report, observer);
    }
}
