//! Texture coordinates: where a unit samples on each level of each kind of texture, at a pixel and at its quad.

mod describe;

use super::cube::{Face, SignedAxis, major_axis};
use super::lod::Quad;
use super::other_kind::{of_direction, on_face as on_a_face};
use super::planned::PlannedUnit;
use super::report::Report;
use crate::number::Integer;
use crate::raster::binary::Binary;
use crate::raster::interpolate::{COORDINATE_LIMIT, FARTHEST, Sample, coordinate, divided, ratio};
use crate::raster::stroke::sprite_coordinate;
use crate::raster::weights::Linear;
use crate::raster::{ideal, setup::Triangle};
use crate::state::{AddressMode, DepthFormat, Level, Named, TextureKind, TriangleVertices};
use crate::trace::{Observer, Operand, Rule, Step, plain};

/// The coordinates of a unit, set up for one triangle: the components that they are computed from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coordinates {
    /// s and t, where q is 1 at all three vertices (INT-4). On a face t is negated, here and below (TEX-20).
    Plane([Linear<Binary>; 2]),
    /// s, t and q, for the ratios s/q and t/q (TEX-15).
    Ratio([Linear<Binary>; 3]),
    /// The direction s, t, r (TEX-12, TEX-20). q is ignored.
    Direction([Linear<Binary>; 3]),
    /// The place in a point (PNT-2): its position in 1/16 pixel, and its size in 1/8 pixel.
    Sprite {
        /// x and y of the point.
        at: [i64; 2],
        /// Its size.
        size: u16,
    },
}

impl Coordinates {
    /// Sets up the coordinates of a triangle. `vertices` holds s, t, r, q of its vertices.
    #[allow(clippy::float_arithmetic, reason = "TEX-20: a change of sign")]
    #[inline]
    pub fn new(vertices: [[f32; 4]; 3], unit: &PlannedUnit) -> Coordinates {
        let mut set = wrapped(unit, vertices);
        if unit.is_on_face() {
            set = set.map(|[s, t, r, q]| [s, -t, r, q]);
        }
        let component = |n: usize| Linear::new(set.map(|vertex| vertex[n]));
        if unit.takes_direction() {
            Coordinates::Direction([component(0), component(1), component(2)])
        } else if set.map(|vertex| vertex[3]) == [1.0; 3] {
            Coordinates::Plane([component(0), component(1)])
        } else {
            Coordinates::Ratio([component(0), component(1), component(3)])
        }
    }
}

/// CYL-1: moves a coordinate, s or t, of a triangle's vertices by whole repeats to within half a repeat of that of the
/// first vertex.
#[allow(clippy::float_arithmetic, reason = "CYL-1: repeats are counted and taken off in binary32")]
#[inline]
pub(crate) fn wrapped_axis(unit: &PlannedUnit, axis: usize, [first, mut second, mut third]: [f32; 3]) -> [f32; 3] {
    if unit.state.cylindrical_wrap[axis] && unit.modes()[axis] != AddressMode::Mirror {
        for value in [&mut second, &mut third] {
            let ahead = *value - first;
            // A distance of exactly half a repeat is kept.
            *value -= if ahead > 0.0 { (ahead - 0.5).ceil().max(0.0) } else { (ahead + 0.5).floor().min(0.0) };
        }
    }
    [first, second, third]
}

/// CYL-1 for both s and t of a triangle's vertices, of which s, t, r and q are given.
#[inline]
pub fn wrapped(unit: &PlannedUnit, mut vertices: [[f32; 4]; 3]) -> [[f32; 4]; 3] {
    for axis in [0, 1] {
        let [a, b, c] = vertices;
        let [a, b, c] = wrapped_axis(unit, axis, [a[axis], b[axis], c[axis]]);
        (vertices[0][axis], vertices[1][axis], vertices[2][axis]) = (a, b, c);
    }
    vertices
}

/// Returns the face that a direction meets.
pub(crate) fn face_of(direction: [Binary; 3]) -> Face {
    let [x, y, z] = direction;
    let axis = major_axis([x.is_no_smaller(y), x.is_no_smaller(z), y.is_no_smaller(z)]);
    Face::from_axis(axis, |axis| direction[axis].mantissa < 0)
}

/// Returns sc, tc and |ma| of a direction on a face.
pub(crate) fn on_face(direction: [Binary; 3], face: Face) -> [Binary; 3] {
    let signed = |SignedAxis { axis, negative }| if negative { direction[axis].negated() } else { direction[axis] };
    face.components().map(signed)
}

/// Coordinates of the ideal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Real {
    /// The face of a cube map that they lie on.
    pub face: Face,
    /// s and t, where 1.0 spans the whole image, or texels of a rectangle.
    pub st: [f64; 2],
}

/// The coordinates at which a unit samples. Implementations differ in where the coordinates come from.
pub trait SampleCoordinates {
    /// Returns the face of a cube map, or [`Face::PositiveX`] for other kinds of texture.
    fn face(&self) -> Face;
    /// Returns u and v on a level, in 1/256 texel.
    fn on(&self, level: &Level) -> [i64; 2];
    /// TEX-11: returns u and v at the quad, on the face of its top-left pixel. Returns `None` if part of the quad lies
    /// behind the viewer.
    fn quad(&self) -> Option<Quad>;
    /// Returns the ideal's coordinates, on the given face or, without one, on their own.
    fn real(&self, face: Option<Face>) -> Real;
    /// Returns the ideal's s and t at the quad, or `None` if part of the quad lies behind the viewer.
    fn real_quad(&self) -> Option<[[f64; 2]; 3]>;
    /// Returns the rule that yields u and v.
    fn rule(&self) -> Rule;
    /// Reports how u and v on a level are computed.
    fn describe<O: Observer>(
        &self,
        report: &Report<'_>,
        level: &Level,
        floored: [i64; 2],
        ideal: [f64; 2],
        observer: &mut O,
    );
    /// Reports how the coordinates of the quad are computed.
    fn describe_quad<O: Observer>(&self, report: &Report<'_>, observer: &mut O);

    /// VOL-1: returns the coordinate among `layers` layers, in 1/256 layer. Only interpolated coordinates have one; for
    /// others it is 0.
    fn layer(&self, _layers: u32) -> i64 {
        0
    }
    /// Returns the ideal's r/q, or 0 if the coordinates are not interpolated.
    fn real_r(&self) -> f64 {
        0.0
    }
    /// Reports how the layer coordinate is computed.
    fn describe_layer<O: Observer>(&self, _report: &Report<'_>, _layers: u32, _settled: i64, _observer: &mut O) {}
    /// SHD-1: returns r/q in steps of a depth buffer, or 0 if the coordinates are not interpolated.
    fn reference(&self) -> Binary {
        Binary::default()
    }
    /// Reports how the reference word is computed.
    fn describe_reference<O: Observer>(
        &self,
        _report: &Report<'_>,
        _format: DepthFormat,
        _word: u32,
        _observer: &mut O,
    ) {
    }
}

/// Coordinates that are interpolated from the vertices.
#[derive(Clone, Copy, Debug)]
pub struct VertexCoordinates<'a> {
    /// The unit that samples.
    pub unit: &'a PlannedUnit,
    /// The coordinates that were set up for the triangle.
    pub coordinates: &'a Coordinates,
    /// The sample point of the pixel.
    pub at: &'a Sample<'a>,
    /// Column and row of the pixel.
    pub pixel: (i64, i64),
    /// The vertices of the triangle, for the ideal.
    pub vertices: TriangleVertices<'a>,
    /// Whether the ideal divides by the w of the vertices.
    pub perspective: bool,
}

/// Returns samples at the top-left pixel of a pixel's quad and at its right and lower neighbours.
pub(crate) fn quad_samples(triangle: &Triangle, pixel: (i64, i64)) -> [Sample<'_>; 3] {
    quad_pixels(pixel).map(|(i, j)| Sample::new(triangle, triangle.edges(i, j)))
}

/// Returns the pixels of a pixel's quad that determine the level of detail: the top-left one and its right and lower neighbours.
pub(crate) fn quad_pixels((i, j): (i64, i64)) -> [(i64, i64); 3] {
    let (i, j) = (i & !1, j & !1);
    [(i, j), (i + 1, j), (i, j + 1)]
}

impl VertexCoordinates<'_> {
    fn face_at(direction: &[Linear<Binary>; 3], at: &Sample<'_>) -> Face {
        face_of([at.value(&direction[0]), at.value(&direction[1]), at.value(&direction[2])])
    }

    /// Returns the distances of a pixel's centre from the sprite's point, in 1/16 pixel.
    fn from_point(at: [i64; 2], (i, j): (i64, i64)) -> [i64; 2] {
        [16 * i + 8 - at[0], 16 * j + 8 - at[1]]
    }

    /// Returns the coordinates of one pixel of the quad on a face, in 1/65536 texel of level 0, or `None` if it lies
    /// behind the viewer.
    fn at_quad(&self, at: &Sample<'_>, pixel: (i64, i64), face: Face) -> Option<[i64; 2]> {
        let sides = self.unit.scale(&self.unit.levels[0]);
        let [width, height] = sides.map(i64::from);
        if at.is_behind() {
            return None;
        }
        let at = match self.coordinates {
            Coordinates::Plane([s, t]) => {
                Some([quad_coordinate(at.value(s), width), quad_coordinate(at.value(t), height)])
            }
            Coordinates::Ratio(of) => {
                let [s, t, q] = of.map(|f| at.value(&f));
                (q.mantissa > 0).then(|| [quad_ratio(s, q, width), quad_ratio(t, q, height)])
            }
            Coordinates::Direction(direction) => {
                let direction = on_face(direction.map(|f| at.value(&f)), face);
                (direction[2].mantissa > 0).then(|| of_direction(self.unit, direction, [width, height], 16))
            }
            Coordinates::Sprite { at, size } => {
                let [x, y] = Self::from_point(*at, pixel);
                let of = |d: i64, side: i64| sprite_coordinate(d, (*size).into(), side, 16);
                Some([of(x, width), of(y, height)])
            }
        };
        if self.unit.is_on_face() { at.map(|uv| uv.map(|u| on_a_face(u, width, 16))) } else { at }
    }

    /// Returns one component of the vertices' coordinates.
    fn component(&self, n: usize) -> [f32; 3] {
        self.vertices.coordinates(self.unit.stage.coordinate_set).map(|vertex| vertex[n])
    }

    /// Returns r, and q if the coordinates are ratios.
    fn r_and_q(&self) -> (Binary, Option<Binary>) {
        let of = |n: usize| self.at.value(&Linear::new(self.component(n)));
        (of(2), (self.component(3) != [1.0; 3]).then(|| of(3)))
    }

    /// Returns the ideal's weights of the vertices, for edge functions that need not be covered.
    fn weights(&self, e: [i64; 3]) -> [f64; 3] {
        ideal::barycentrics(self.at.triangle, e, self.vertices.position(3), self.perspective)
    }

    fn real_at(&self, weights: [f64; 3], pixel: (i64, i64), face: Option<Face>) -> Real {
        if let Coordinates::Sprite { at, size } = self.coordinates {
            return Real { face: Face::PositiveX, st: Self::from_point(*at, pixel).map(|d| real_sprite(d, *size)) };
        }
        let set = wrapped(self.unit, self.vertices.coordinates(self.unit.stage.coordinate_set));
        let component = |n: usize| ideal::mix(weights, set.map(|v| f64::from(v[n])));
        if let Coordinates::Direction(_) = self.coordinates {
            return real_direction(self.unit.kind, [component(0), component(1), component(2)], face);
        }
        let q = component(3);
        let st = [0, 1].map(|n| ideal::quotient(component(n), q));
        Real { face: Face::PositiveX, st: if self.unit.is_on_face() { real_on_face(st) } else { st } }
    }
}

/// TEX-20 in real numbers: returns coordinates on face +X.
#[allow(clippy::float_arithmetic, reason = "the ideal's coordinates")]
fn real_on_face([s, t]: [f64; 2]) -> [f64; 2] {
    [(1.0 + s) / 2.0, (1.0 - t) / 2.0]
}

/// TEX-12, TEX-20 in real numbers: returns the coordinates on an image of a direction on the given face or, without one, on the face that
/// it meets.
pub(crate) fn real_direction(kind: TextureKind, direction: [f64; 3], face: Option<Face>) -> Real {
    let face = face.unwrap_or_else(|| Face::from_direction(direction, direction.map(f64::abs), 0.0));
    #[allow(clippy::float_arithmetic, reason = "the ideal's direction")]
    let [s, t, m] = face.components().map(|c| {
        let component = direction[c.axis];
        if c.negative { -component } else { component }
    });
    #[allow(clippy::float_arithmetic, reason = "the ideal's coordinates")]
    let st = match kind {
        TextureKind::Cube => [s, t].map(|c| if m == 0.0 { 0.0 } else { (c / m + 1.0) / 2.0 }),
        _ if m == 0.0 => [f64::NEG_INFINITY, f64::INFINITY],
        _ => [s / m, -t / m],
    };
    Real { face, st }
}

impl SampleCoordinates for VertexCoordinates<'_> {
    fn face(&self) -> Face {
        match self.coordinates {
            Coordinates::Direction(direction) => Self::face_at(direction, self.at),
            _ => Face::PositiveX,
        }
    }

    fn on(&self, level: &Level) -> [i64; 2] {
        let sides = self.unit.scale(level);
        let [width, height] = sides.map(i64::from);
        let at = match self.coordinates {
            Coordinates::Plane([s, t]) => [coordinate(self.at.value(s), width), coordinate(self.at.value(t), height)],
            Coordinates::Ratio(of) => {
                let [s, t, q] = of.map(|f| self.at.value(&f));
                [ratio(s, q, width), ratio(t, q, height)]
            }
            Coordinates::Direction(of) => {
                let direction = of.map(|f| self.at.value(&f));
                of_direction(self.unit, on_face(direction, face_of(direction)), [width, height], 8)
            }
            Coordinates::Sprite { at, size } => {
                let [x, y] = Self::from_point(*at, self.pixel);
                let of = |d: i64, side: i64| sprite_coordinate(d, (*size).into(), side, 8);
                [of(x, width), of(y, height)]
            }
        };
        if self.unit.is_on_face() { at.map(|u| on_a_face(u, width, 8)) } else { at }
    }

    fn quad(&self) -> Option<Quad> {
        let samples = quad_samples(self.at.triangle, self.pixel);
        let face = match self.coordinates {
            Coordinates::Direction(direction) => Self::face_at(direction, &samples[0]),
            _ => Face::PositiveX,
        };
        let pixels = quad_pixels(self.pixel);
        let [origin, right, lower] = [0, 1, 2].map(|n| self.at_quad(&samples[n], pixels[n], face));
        Some([origin?, right?, lower?])
    }

    fn real(&self, face: Option<Face>) -> Real {
        self.real_at(self.at.ideal.unwrap_or_else(|| self.weights(self.at.e)), self.pixel, face)
    }

    fn real_quad(&self) -> Option<[[f64; 2]; 3]> {
        let samples = quad_samples(self.at.triangle, self.pixel);
        if samples.iter().any(Sample::is_behind) {
            return None;
        }
        let [first, second, third] = quad_pixels(self.pixel);
        let [origin, right, lower] = samples.map(|at| self.weights(at.e));
        let origin = self.real_at(origin, first, None);
        let face = Some(origin.face);
        Some([origin.st, self.real_at(right, second, face).st, self.real_at(lower, third, face).st])
    }

    fn rule(&self) -> Rule {
        match self.coordinates {
            _ if self.unit.is_other_kind() => Rule::Tex20,
            Coordinates::Plane(_) | Coordinates::Sprite { .. } => Rule::Int4,
            Coordinates::Ratio(_) => Rule::Tex15,
            Coordinates::Direction(_) => Rule::Tex12,
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
        let sides = self.unit.scale(level);
        let numbers = self.tell_numbers(report, "", self.at, observer);
        let face = self.tell_face(report, "face", (self.at, &numbers), observer);
        for (axis, letter) in ["u", "v"].into_iter().enumerate() {
            let size = plain("size", sides[axis]);
            let other = self.unit.is_other_kind();
            let (rule, operation, inputs) = match self.coordinates {
                Coordinates::Plane(_) if !other => ("INT-4", "floor_coordinate", vec![numbers[axis].clone(), size]),
                Coordinates::Ratio(_) if !other => {
                    ("TEX-15", "floor_ratio", vec![numbers[axis].clone(), numbers[2].clone(), size])
                }
                Coordinates::Plane(_) | Coordinates::Ratio(_) => {
                    let inputs = [numbers[axis].clone()].into_iter().chain(numbers.get(2).cloned()).chain([size]);
                    ("TEX-20", ["floor_on_face_u", "floor_on_face_v"][axis], inputs.collect())
                }
                Coordinates::Direction(_) => {
                    let inputs = numbers.iter().cloned().chain(face.clone()).chain([size]).collect();
                    let (rule, operations) = if other {
                        ("TEX-20", ["floor_on_plane_u", "floor_on_plane_v"])
                    } else {
                        ("TEX-12", ["floor_face_u", "floor_face_v"])
                    };
                    (rule, operations[axis], inputs)
                }
                Coordinates::Sprite { at, size: of } => {
                    ("PNT-2", "floor_sprite", self.sprite_inputs((*at, *of), self.pixel, axis, size))
                }
            };
            report.coordinate(rule, letter, floored[axis], ideal[axis], (operation, inputs), observer);
        }
    }

    fn layer(&self, layers: u32) -> i64 {
        match self.r_and_q() {
            (r, Some(q)) => ratio(r, q, layers.into()),
            (r, None) => coordinate(r, layers.into()),
        }
    }

    fn real_r(&self) -> f64 {
        let weights = self.at.ideal.unwrap_or_else(|| self.weights(self.at.e));
        let component = |n: usize| ideal::mix(weights, self.component(n).map(f64::from));
        ideal::quotient(component(2), component(3))
    }

    fn describe_layer<O: Observer>(&self, report: &Report<'_>, layers: u32, floored: i64, observer: &mut O) {
        let mut inputs = self.tell_third(report, observer);
        let (rule, operation) =
            if inputs.len() == 1 { ("INT-4", "floor_coordinate") } else { ("TEX-15", "floor_ratio") };
        inputs.push(plain("size", layers));
        let ideal = real_coordinate(self.real_r(), layers);
        report.coordinate(rule, "w", floored, ideal, (operation, inputs), observer);
    }

    fn reference(&self) -> Binary {
        let (r, q) = self.r_and_q();
        q.map_or(r, |q| r.positive_ratio(q))
    }

    fn describe_reference<O: Observer>(&self, report: &Report<'_>, format: DepthFormat, word: u32, observer: &mut O) {
        let mut inputs = self.tell_third(report, observer);
        let operation = if inputs.len() == 1 { "depth_word" } else { "depth_word_of_ratio" };
        inputs.push(plain(format.name(), 0));
        let real = ideal::in_words(format, self.real_r());
        observer.step(
            Step::plain(&report.block(), "SHD-1", report.name("reference"), word).by(operation, inputs).ideal(real),
        );
    }

    fn describe_quad<O: Observer>(&self, report: &Report<'_>, observer: &mut O) {
        let Some(quad) = self.quad() else { return };
        let triangle = self.at.triangle;
        let samples = quad_samples(triangle, self.pixel);
        let sides = self.unit.scale(&self.unit.levels[0]);
        let mut face = None;
        for (n, (pixel, at)) in quad_pixels(self.pixel).into_iter().zip(&samples).enumerate() {
            let prefix = report.name(&format!("quad{n}."));
            report.weights(&prefix, at, pixel, observer);
            let numbers = self.tell_numbers(report, &prefix, at, observer);
            if n == 0 {
                face = self.tell_face(report, "quad0.face", (at, &numbers), observer);
            }
            for (axis, letter) in ["u", "v"].into_iter().enumerate() {
                let size = plain("size", sides[axis]);
                let other = self.unit.is_other_kind();
                let (operation, inputs) = match self.coordinates {
                    Coordinates::Plane(_) if !other => ("quad_coordinate", vec![numbers[axis].clone(), size]),
                    Coordinates::Ratio(_) if !other => {
                        ("quad_ratio", vec![numbers[axis].clone(), numbers[2].clone(), size])
                    }
                    Coordinates::Plane(_) | Coordinates::Ratio(_) => {
                        let inputs = [numbers[axis].clone()].into_iter().chain(numbers.get(2).cloned()).chain([size]);
                        (["quad_on_face_u", "quad_on_face_v"][axis], inputs.collect())
                    }
                    Coordinates::Direction(_) => {
                        let inputs = numbers.iter().cloned().chain(face.clone()).chain([size]).collect();
                        let of_face = ["quad_face_u", "quad_face_v"];
                        let operations = if other { ["quad_on_plane_u", "quad_on_plane_v"] } else { of_face };
                        (operations[axis], inputs)
                    }
                    Coordinates::Sprite { at, size: of } => {
                        ("quad_sprite", self.sprite_inputs((*at, *of), pixel, axis, size))
                    }
                };
                report.quad_coordinate((n, letter), quad[n][axis], (operation, inputs), observer);
            }
        }
    }
}

/// PNT-2 in real numbers: returns a coordinate at a distance from the point.
#[allow(clippy::float_arithmetic, reason = "the ideal's coordinate")]
fn real_sprite(d: i64, size: u16) -> f64 {
    if size == 0 { 0.5 } else { 0.5 + d as f64 / (2.0 * f64::from(size)) }
}

/// TEX-11: returns a coordinate of an image of `size` texels in 1/65536 texel.
#[inline]
pub fn quad_coordinate<I: Integer>(value: Binary<I>, size: I) -> I {
    value.far_floored(size, I::new(16), I::new(FARTHEST))
}

/// TEX-11, TEX-15: returns s/q of an image of `size` texels in 1/65536 texel, for a q that is not 0.
#[inline]
pub fn quad_ratio<I: Integer>(s: Binary<I>, q: Binary<I>, size: I) -> I {
    quad_coordinate(divided(s, q), size)
}

/// Returns the ideal's coordinate on a level in 1/256 texel, limited as in TEX-15.
#[allow(clippy::float_arithmetic, reason = "the ideal's coordinate")]
pub fn real_coordinate(coordinate: f64, side: u32) -> f64 {
    let limit = COORDINATE_LIMIT as f64;
    let coordinate = coordinate * 256.0 * f64::from(side);
    if coordinate.is_nan() { 0.0 } else { coordinate.clamp(-limit, limit) }
}
