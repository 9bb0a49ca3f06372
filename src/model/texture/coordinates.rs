//! Texture coordinates: where a unit samples on each level of each kind of texture, at a pixel and at its quad.

use super::cube::{Face, Signed};
use super::lod::Quad;
use super::planned::PlannedUnit;
use super::report::{Report, linear, shortfall};
use crate::raster::attribute::Attribute;
use crate::raster::depth::Binary;
use crate::raster::interpolate::{COORDINATE_LIMIT, Floored, Sample};
use crate::raster::{ideal, setup::Triangle};
use crate::state::{AddressMode, DepthFormat, Level, Named, TextureKind, TriangleVertices};
use crate::trace::{Observer, Operand, Rule, Step, plain};

/// The coordinates of a unit, set up for one triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// q is 1 at all three vertices, so that u and v of level 0 are linear functions over D (INT-4).
    Plane([[i64; 3]; 2]),
    /// Linear functions of s, t and q, for the ratios s/q and t/q (TEX-15).
    Ratio([[i64; 3]; 3]),
    /// Linear functions of the direction s, t, r into a cube map (TEX-12). q is ignored.
    Direction([[i64; 3]; 3]),
}

impl Coordinates {
    /// Sets up the coordinates of a triangle. `vertices` holds s, t, r, q of its vertices.
    #[inline(always)]
    pub fn new(triangle: &Triangle, vertices: [[f32; 4]; 3], unit: &PlannedUnit) -> Coordinates {
        let [a, b, c] = wrapped(unit, vertices);
        let component = |n: usize| [a[n], b[n], c[n]];
        if unit.kind == TextureKind::Cube {
            return Coordinates::Direction(triangle.direction([component(0), component(1), component(2)]));
        }
        if component(3) == [1.0; 3] {
            let [width, height] = unit.scale(&unit.levels[0]);
            Coordinates::Plane([triangle.coordinate(component(0), width), triangle.coordinate(component(1), height)])
        } else {
            Coordinates::Ratio(triangle.direction([component(0), component(1), component(3)]))
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

/// VOL-1: returns r of the vertices as a linear function over D, or r and q if the coordinates are ratios.
pub(crate) fn layer_planes(
    triangle: &Triangle,
    coordinates: &Coordinates,
    [r, q]: [[f32; 3]; 2],
    layers: u32,
) -> ([i64; 3], Option<[i64; 3]>) {
    match coordinates {
        Coordinates::Ratio(_) => {
            let [r, q, _] = triangle.direction([r, q, q]);
            (r, Some(q))
        }
        Coordinates::Plane(_) | Coordinates::Direction(_) => (triangle.coordinate(r, layers), None),
    }
}

/// Returns the linear functions of sc, tc and |ma| of a direction on a face.
pub(crate) fn on_face(direction: &[[i64; 3]; 3], face: Face) -> [[i64; 3]; 3] {
    face.components().map(
        |Signed { axis, negative }| {
            if negative { direction[axis].map(|g| -g) } else { direction[axis] }
        },
    )
}

/// Coordinates of the ideal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Real {
    /// The face of a cube map that they lie on.
    pub face: Face,
    /// s and t, where 1.0 spans the whole image, or texels of a rectangle.
    pub st: [f64; 2],
}

/// INT-4, INT-4t: returns the operation that yields a coordinate on a plane, and its operands after the edge functions.
fn on_plane(at: &Sample<'_>) -> (&'static str, Vec<Operand>) {
    let denominator = plain("D", at.d);
    if at.triangle.loses_on_planes() {
        return ("floor_plane_short", [vec![denominator], shortfall(at)].concat());
    }
    ("floor_plane", vec![denominator])
}

/// The coordinates at which a unit samples. Implementations differ in where the coordinates come from.
pub trait SampleCoordinates {
    /// Returns the face of a cube map, or [`Face::PositiveX`] for other kinds of texture.
    fn face(&self) -> Face;
    /// Returns u and v on a level, in 1/256 texel.
    fn on(&self, level: &Level) -> [Floored; 2];
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
        floored: [Floored; 2],
        ideal: [f64; 2],
        observer: &mut O,
    );
    /// Reports how the coordinates of the quad are computed.
    fn describe_quad<O: Observer>(&self, report: &Report<'_>, observer: &mut O);

    /// VOL-1: returns the coordinate among `layers` layers, in 1/256 layer. Only interpolated coordinates have one; for
    /// others it is 0.
    fn layer(&self, _layers: u32) -> Floored {
        Floored { value: 0, lowered: 0 }
    }
    /// Returns the ideal's r/q, or 0 if the coordinates are not interpolated.
    fn real_r(&self) -> f64 {
        0.0
    }
    /// Reports how the layer coordinate is computed.
    fn describe_layer<O: Observer>(&self, _report: &Report<'_>, _layers: u32, _settled: Floored, _observer: &mut O) {}
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
pub struct Interpolated<'a> {
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
pub(crate) fn quad_samples(triangle: &Triangle, (i, j): (i64, i64)) -> [Sample<'_>; 3] {
    let (i, j) = (i & !1, j & !1);
    [(i, j), (i + 1, j), (i, j + 1)].map(|(i, j)| Sample::new(triangle, triangle.edges(i, j)))
}

impl Interpolated<'_> {
    fn face_at(direction: &[[i64; 3]; 3], at: &Sample<'_>) -> Face {
        let sums = direction.map(|g| at.sum(&g));
        Face::from_direction(sums, sums.map(i128::abs), 0)
    }

    /// Returns the coordinates of one pixel of the quad on a face, in 1/65536 texel of level 0, or `None` if it lies
    /// behind the viewer.
    fn at_quad(&self, at: &Sample<'_>, face: Face) -> Option<[i64; 2]> {
        let [width, height] = self.unit.scale(&self.unit.levels[0]).map(i128::from);
        let floor = |numerator: i128, denominator: i128| {
            let limit = 1 << 62;
            (denominator > 0).then(|| numerator.div_euclid(denominator).clamp(-limit, limit) as i64)
        };
        if at.d <= 0 {
            return None;
        }
        match self.coordinates {
            Coordinates::Plane(g) => {
                let along = |n: usize| floor(at.sum(&g[n]) << 8, i128::from(at.d));
                Some([along(0)?, along(1)?])
            }
            Coordinates::Ratio([s, t, q]) => {
                let q = at.sum(q);
                Some([floor((at.sum(s) * width) << 16, q)?, floor((at.sum(t) * height) << 16, q)?])
            }
            Coordinates::Direction(direction) => {
                let [s, t, m] = on_face(direction, face).map(|g| at.sum(&g));
                Some([floor(((s + m) * width) << 15, m)?, floor(((t + m) * height) << 15, m)?])
            }
        }
    }

    /// Returns one component of the vertices' coordinates.
    fn component(&self, n: usize) -> [f32; 3] {
        self.vertices.coordinates(self.unit.stage.coordinate_set).map(|vertex| vertex[n])
    }

    /// Returns the [`layer_planes`] of these coordinates.
    fn layer_planes(&self, layers: u32) -> ([i64; 3], Option<[i64; 3]>) {
        layer_planes(self.at.triangle, self.coordinates, [self.component(2), self.component(3)], layers)
    }

    /// Returns r, and q if it is not 1 at all three vertices.
    fn reference_parts(&self) -> (Attribute, Option<Attribute>) {
        let q = self.component(3);
        let r = self.at.triangle.attribute(self.component(2));
        (r, (q != [1.0; 3]).then(|| self.at.triangle.attribute(q)))
    }

    /// Returns the ideal's weights of the vertices, for edge functions that need not be covered.
    fn weights(&self, e: [i64; 3]) -> [f64; 3] {
        ideal::barycentrics(self.at.triangle, e, self.vertices.position(3), self.perspective)
    }

    fn real_at(&self, weights: [f64; 3], face: Option<Face>) -> Real {
        let set = wrapped(self.unit, self.vertices.coordinates(self.unit.stage.coordinate_set));
        let component = |n: usize| ideal::mix(weights, set.map(|v| f64::from(v[n])));
        if let Coordinates::Direction(_) = self.coordinates {
            return real_direction([component(0), component(1), component(2)], face);
        }
        let q = component(3);
        Real { face: Face::PositiveX, st: [0, 1].map(|n| ideal::quotient(component(n), q)) }
    }
}

/// TEX-12 in real numbers: returns the coordinates of a direction on the given face or, without one, on the face that
/// it meets.
pub(crate) fn real_direction(direction: [f64; 3], face: Option<Face>) -> Real {
    let face = face.unwrap_or_else(|| Face::from_direction(direction, direction.map(f64::abs), 0.0));
    #[allow(clippy::float_arithmetic, reason = "the ideal's direction")]
    let [s, t, m] = face.components().map(|c| {
        let component = direction[c.axis];
        if c.negative { -component } else { component }
    });
    #[allow(clippy::float_arithmetic, reason = "the ideal's coordinates")]
    let st = [s, t].map(|c| if m == 0.0 { 0.0 } else { (c / m + 1.0) / 2.0 });
    Real { face, st }
}

impl SampleCoordinates for Interpolated<'_> {
    fn face(&self) -> Face {
        match self.coordinates {
            Coordinates::Direction(direction) => Self::face_at(direction, self.at),
            Coordinates::Plane(_) | Coordinates::Ratio(_) => Face::PositiveX,
        }
    }

    fn on(&self, level: &Level) -> [Floored; 2] {
        let [width, height] = self.unit.scale(level);
        match self.coordinates {
            Coordinates::Plane(g) => {
                let [s, t] = self.unit.plane_shifts(level);
                [self.at.coordinate(&g[0].map(|g| g >> s)), self.at.coordinate(&g[1].map(|g| g >> t))]
            }
            Coordinates::Ratio([s, t, q]) => [self.at.ratio(s, q, width), self.at.ratio(t, q, height)],
            Coordinates::Direction(direction) => {
                let [s, t, m] = on_face(direction, Self::face_at(direction, self.at));
                [self.at.face_coordinate(&s, &m, width), self.at.face_coordinate(&t, &m, height)]
            }
        }
    }

    fn quad(&self) -> Option<Quad> {
        let samples = quad_samples(self.at.triangle, self.pixel);
        let face = match self.coordinates {
            Coordinates::Direction(direction) => Self::face_at(direction, &samples[0]),
            Coordinates::Plane(_) | Coordinates::Ratio(_) => Face::PositiveX,
        };
        let [origin, right, lower] = samples.map(|at| self.at_quad(&at, face));
        Some([origin?, right?, lower?])
    }

    fn real(&self, face: Option<Face>) -> Real {
        self.real_at(self.at.ideal.unwrap_or_else(|| self.weights(self.at.e)), face)
    }

    fn real_quad(&self) -> Option<[[f64; 2]; 3]> {
        let samples = quad_samples(self.at.triangle, self.pixel);
        if samples.iter().any(|at| at.d <= 0) {
            return None;
        }
        let [origin, right, lower] = samples.map(|at| self.weights(at.e));
        let origin = self.real_at(origin, None);
        Some([origin.st, self.real_at(right, Some(origin.face)).st, self.real_at(lower, Some(origin.face)).st])
    }

    fn rule(&self) -> Rule {
        match self.coordinates {
            Coordinates::Plane(_) => Rule::Int4,
            Coordinates::Ratio(_) => Rule::Tex15,
            Coordinates::Direction(_) => Rule::Tex12,
        }
    }

    fn describe<O: Observer>(
        &self,
        report: &Report<'_>,
        level: &Level,
        floored: [Floored; 2],
        ideal: [f64; 2],
        observer: &mut O,
    ) {
        let edges = (0..3).map(|k| plain(format!("E{k}"), self.at.e[k]));
        let sides = self.unit.scale(level);
        let shifts = self.unit.plane_shifts(level);
        let direction = self.tell_direction(report, observer);
        for (axis, letter) in ["u", "v"].into_iter().enumerate() {
            let lowered = plain("lowered", floored[axis].lowered);
            let size = plain("size", sides[axis]);
            let (rule, operation, mut inputs) = match self.coordinates {
                Coordinates::Plane(g) => {
                    let g = g[axis].map(|g| g >> shifts[axis]);
                    ("INT-4", on_plane(self.at).0, report.planes("INT-4", &format!("G_{letter}"), &g, observer))
                }
                Coordinates::Ratio(planes) => {
                    let mut inputs = report.planes("INT-4", &format!("N_{letter}"), &planes[axis], observer);
                    inputs.extend(report.planes("INT-4", "N_q", &planes[2], observer));
                    ("TEX-15", "floor_ratio", inputs)
                }
                Coordinates::Direction(_) => ("TEX-12", ["floor_face_u", "floor_face_v"][axis], direction.clone()),
            };
            inputs.extend(edges.clone());
            match self.coordinates {
                Coordinates::Plane(_) => inputs.extend(on_plane(self.at).1),
                Coordinates::Ratio(_) => {
                    inputs.push(size);
                    inputs.extend(shortfall(self.at));
                }
                Coordinates::Direction(_) => {
                    inputs.push(plain(report.name("face"), self.face() as i64));
                    inputs.push(size);
                }
            }
            inputs.push(lowered);
            report.coordinate(rule, letter, floored[axis], ideal[axis], (operation, inputs), observer);
        }
    }

    fn layer(&self, layers: u32) -> Floored {
        match self.layer_planes(layers) {
            (r, Some(q)) => self.at.ratio(&r, &q, layers),
            (r, None) => self.at.coordinate(&r),
        }
    }

    fn real_r(&self) -> f64 {
        let weights = self.at.ideal.unwrap_or_else(|| self.weights(self.at.e));
        let component = |n: usize| ideal::mix(weights, self.component(n).map(f64::from));
        ideal::quotient(component(2), component(3))
    }

    fn describe_layer<O: Observer>(&self, report: &Report<'_>, layers: u32, floored: Floored, observer: &mut O) {
        let (r, q) = self.layer_planes(layers);
        let (rule, operation, mut inputs) = match q {
            None => ("INT-4", on_plane(self.at).0, report.planes("INT-4", "G_w", &r, observer)),
            Some(q) => {
                let mut inputs = report.planes("INT-4", "N_w", &r, observer);
                inputs.extend(report.planes("INT-4", "N_wq", &q, observer));
                ("TEX-15", "floor_ratio", inputs)
            }
        };
        inputs.extend((0..3).map(|k| plain(format!("E{k}"), self.at.e[k])));
        if q.is_some() {
            inputs.push(plain("size", layers));
            inputs.extend(shortfall(self.at));
        } else {
            inputs.extend(on_plane(self.at).1);
        }
        inputs.push(plain("lowered", floored.lowered));
        let ideal = real_coordinate(self.real_r(), layers);
        report.coordinate(rule, "w", floored, ideal, (operation, inputs), observer);
    }

    fn reference(&self) -> Binary {
        let (r, q) = self.reference_parts();
        let r = self.at.attribute(&r);
        q.map_or_else(|| r.binary(), |q| r.binary_ratio(&self.at.attribute(&q)))
    }

    fn describe_reference<O: Observer>(&self, report: &Report<'_>, format: DepthFormat, word: u32, observer: &mut O) {
        let (r, q) = self.reference_parts();
        let index = self.unit.index;
        let mut inputs = linear(index, 2, &r, self.at, observer);
        let operation = if q.is_some() { "depth_word_of_ratio" } else { "depth_word" };
        inputs.extend(q.map(|q| linear(index, 3, &q, self.at, observer)).into_iter().flatten());
        inputs.push(plain(format.name(), 0));
        let real = ideal::in_words(format, self.real_r());
        observer.step(
            Step::given(&report.block(), "SHD-1", report.name("reference"), word).by(operation, inputs).ideal(real),
        );
    }

    fn describe_quad<O: Observer>(&self, report: &Report<'_>, observer: &mut O) {
        let Some(quad) = self.quad() else { return };
        let triangle = self.at.triangle;
        let (i, j) = (self.pixel.0 & !1, self.pixel.1 & !1);
        let direction = self.tell_direction(report, observer);
        let samples = quad_samples(triangle, self.pixel);
        let sides = self.unit.scale(&self.unit.levels[0]);
        for (n, pixel) in [(i, j), (i + 1, j), (i, j + 1)].into_iter().enumerate() {
            let edge = |k: usize| report.name(&format!("quad{n}.E{k}"));
            for k in 0..3 {
                let step = Step::given(&report.block(), "TEX-11", edge(k), samples[n].e[k]);
                observer.step(step.by("edge_function", edge_function(triangle, k, pixel)));
            }
            if let Coordinates::Direction(_) = self.coordinates
                && n == 0
            {
                let mut inputs = direction.clone();
                inputs.extend((0..3).map(|k| plain(edge(k), samples[0].e[k])));
                self.tell_face(report, "quad0.face", &samples[0], inputs, observer);
            }
            for (axis, letter) in ["u", "v"].into_iter().enumerate() {
                let edges = (0..3).map(|k| plain(edge(k), samples[n].e[k]));
                let size = plain("size", sides[axis]);
                let (operation, inputs) = match self.coordinates {
                    Coordinates::Plane(g) => {
                        let mut inputs = report.planes("INT-4", &format!("G_{letter}"), &g[axis], observer);
                        inputs.extend(edges);
                        inputs.extend((0..3).map(|k| plain(format!("P{k}"), triangle.p[k])));
                        ("quad_plane", inputs)
                    }
                    Coordinates::Ratio(planes) => {
                        let mut inputs = report.planes("INT-4", &format!("N_{letter}"), &planes[axis], observer);
                        inputs.extend(report.planes("INT-4", "N_q", &planes[2], observer));
                        inputs.extend(edges);
                        inputs.push(size);
                        ("quad_ratio", inputs)
                    }
                    Coordinates::Direction(planes) => {
                        let mut inputs = direction.clone();
                        inputs.extend(edges);
                        let face = Self::face_at(planes, &samples[0]) as i64;
                        inputs.push(plain(report.name("quad0.face"), face));
                        inputs.push(size);
                        (["quad_face_u", "quad_face_v"][axis], inputs)
                    }
                };
                report.quad_coordinate((n, letter), quad[n][axis], (operation, inputs), observer);
            }
        }
    }
}

impl Interpolated<'_> {
    /// Reports the direction at the vertices and the face of this pixel, and returns the direction as operands. Does
    /// nothing for other coordinates.
    fn tell_direction<O: Observer>(&self, report: &Report<'_>, observer: &mut O) -> Vec<Operand> {
        let Coordinates::Direction(direction) = self.coordinates else { return Vec::new() };
        let mut planes = Vec::new();
        for (letter, g) in ["N_x", "N_y", "N_z"].into_iter().zip(direction) {
            planes.extend(report.planes("TEX-12", letter, g, observer));
        }
        let mut inputs = planes.clone();
        inputs.extend((0..3).map(|k| plain(format!("E{k}"), self.at.e[k])));
        self.tell_face(report, "face", self.at, inputs, observer);
        planes
    }

    fn tell_face<O: Observer>(
        &self,
        report: &Report<'_>,
        name: &str,
        at: &Sample<'_>,
        inputs: Vec<Operand>,
        observer: &mut O,
    ) {
        let Coordinates::Direction(direction) = self.coordinates else { return };
        let face = Self::face_at(direction, at);
        let step = Step::given(&report.block(), "TEX-12", report.name(name), face as i64);
        observer.step(step.by("cube_face", inputs).note(Named::name(face).to_string()));
    }
}

/// Returns the operands of edge function `k` of a triangle at a pixel.
pub(crate) fn edge_function(triangle: &Triangle, k: usize, (x, y): (i64, i64)) -> Vec<Operand> {
    let slopes = [("a", triangle.a), ("b", triangle.b), ("c", triangle.c)];
    let slopes = slopes.map(|(letter, of)| plain(format!("{letter}{k}"), of[k]));
    slopes.into_iter().chain([plain("x", x), plain("y", y)]).collect()
}

/// Returns the ideal's coordinate on a level in 1/256 texel, limited as in TEX-15.
#[allow(clippy::float_arithmetic, reason = "the ideal's coordinate")]
pub fn real_coordinate(coordinate: f64, side: u32) -> f64 {
    let limit = COORDINATE_LIMIT as f64;
    let coordinate = coordinate * 256.0 * f64::from(side);
    if coordinate.is_nan() { 0.0 } else { coordinate.clamp(-limit, limit) }
}
