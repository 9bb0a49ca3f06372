//! Computes covered pixels from vertices, and everything that is interpolated.

use super::real::{Number, bits, color_byte, shift, split};
use super::stroke::{self, Kind, Strokes};
use super::weights;
use ninebit::state::{
    ClipDepth, Cull, DepthFormat, DepthTest, Draw, FrontFace, LineRasterization, PolygonOffset, Positions, Profile,
    ProvokingVertex, ShadeModel, Topology, Vertex, VertexColor, VertexDepths, Viewport,
};

/// RAS-6: vertices with a smaller w are clipped away.
const NEAREST_W: f32 = 1.0 / 1_048_576.0;

/// RAS-4, RAS-5: returns for each triangle the three positions in the index list, and the position of its provoking vertex.
pub fn split_topology(draw: &Draw) -> Vec<([usize; 3], usize)> {
    let n = draw.indices.len();
    let last = draw.provoking_vertex == ProvokingVertex::Last;
    let pick = |first: usize, second: usize| if last { second } else { first };
    let mut out = Vec::new();
    match draw.topology {
        Topology::Triangles => {
            for k in 0..n / 3 {
                out.push(([3 * k, 3 * k + 1, 3 * k + 2], pick(3 * k, 3 * k + 2)));
            }
        }
        Topology::TriangleStrip => {
            for i in 0..n.saturating_sub(2) {
                let order = if i % 2 == 0 { [i, i + 1, i + 2] } else { [i + 1, i, i + 2] };
                out.push((order, pick(i, i + 2)));
            }
        }
        Topology::TriangleFan => {
            for i in 1..n.saturating_sub(1) {
                out.push(([0, i, i + 1], pick(i, i + 1)));
            }
        }
        Topology::Quads => {
            for q in (0..n / 4).map(|q| 4 * q) {
                out.push(([q, q + 1, q + 2], q + 3));
                out.push(([q, q + 2, q + 3], q + 3));
            }
        }
        Topology::QuadStrip => {
            for q in (0..(n / 2).saturating_sub(1)).map(|q| 2 * q) {
                out.push(([q, q + 1, q + 2], q + 3));
                out.push(([q + 2, q + 1, q + 3], q + 3));
            }
        }
        Topology::Polygon => {
            for i in 1..n.saturating_sub(1) {
                out.push(([0, i, i + 1], 0));
            }
        }
        Topology::Points | Topology::Lines | Topology::LineStrip | Topology::LineLoop => {}
    }
    out
}

fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

fn mix_color(a: VertexColor, b: VertexColor, t: f32) -> VertexColor {
    if let (VertexColor::Bytes(p), VertexColor::Bytes(q)) = (a, b)
        && p == q
    {
        return a;
    }
    let floats = |c: VertexColor| match c {
        VertexColor::Bytes(b) => b.map(|b| f32::from(b) / 255.0),
        VertexColor::Floats(f) => f,
    };
    let (p, q) = (floats(a), floats(b));
    VertexColor::Floats(std::array::from_fn(|k| mix(p[k], q[k], t)))
}

/// RAS-6: distance of the guard band from the window's origin, in pixels.
const BAND: f32 = 4095.9375;

/// RAS-6: returns the signed distance of a position from plane 0 to 6: near, far, w, left, right, top, bottom.
fn distance(plane: usize, [x, y, z, w]: [f32; 4], port: &Viewport) -> f32 {
    let (h, g) = (port.width / 2.0, port.height / 2.0);
    let (c, d) = (port.x + h, port.y + g);
    match plane {
        0 if port.clip_depth == ClipDepth::ZeroToOne => z,
        0 => w + z,
        1 => w - z,
        2 => w - NEAREST_W,
        3 => x * h + w * (BAND + c),
        4 => w * (BAND - c) - x * h,
        5 => w * (BAND + d) - y * g,
        _ => y * g + w * (BAND - d),
    }
}

/// RAS-7: returns the vertex at which the edge from the inner vertex `a` to the outer vertex `b` meets a plane.
fn crossing(plane: usize, a: &Vertex, b: &Vertex, port: &Viewport) -> Vertex {
    let (before, behind) = (distance(plane, a.position, port), distance(plane, b.position, port));
    let t = if plane == 2 { before / (a.position[3] - b.position[3]) } else { before / (before - behind) };
    let mut position: [f32; 4] = std::array::from_fn(|k| mix(a.position[k], b.position[k], t));
    let (h, g) = (port.width / 2.0, port.height / 2.0);
    let (c, d) = (port.x + h, port.y + g);
    let w = position[3];
    match plane {
        0 if port.clip_depth == ClipDepth::ZeroToOne => position[2] = 0.0,
        0 => position[2] = -w,
        1 => position[2] = w,
        2 => position[3] = NEAREST_W,
        3 => position[0] = -(w * (BAND + c)) / h,
        4 => position[0] = (w * (BAND - c)) / h,
        5 => position[1] = (w * (BAND + d)) / g,
        _ => position[1] = -(w * (BAND - d)) / g,
    }
    Vertex {
        position,
        diffuse: mix_color(a.diffuse, b.diffuse, t),
        specular: mix_color(a.specular, b.specular, t),
        fog: mix(a.fog, b.fog, t),
        fog_coordinate: None,
        texture_coordinates: std::array::from_fn(|set| {
            std::array::from_fn(|k| mix(a.texture_coordinates[set][k], b.texture_coordinates[set][k], t))
        }),
    }
}

/// RAS-6: returns the part of a polygon on the inner side of a plane.
fn half(plane: usize, polygon: &[Vertex], port: &Viewport) -> Vec<Vertex> {
    let outside: Vec<bool> = polygon.iter().map(|v| distance(plane, v.position, port) < 0.0).collect();
    let mut kept = Vec::new();
    for this in 0..polygon.len() {
        let next = (this + 1) % polygon.len();
        if !outside[this] {
            kept.push(polygon[this]);
        }
        if outside[this] != outside[next] {
            let (inner, outer) = if outside[next] { (this, next) } else { (next, this) };
            kept.push(crossing(plane, &polygon[inner], &polygon[outer], port));
        }
    }
    kept
}

/// RAS-6: returns the part of a triangle in clip space that is not clipped.
fn clipped(triangle: [Vertex; 3], port: &Viewport) -> Vec<Vertex> {
    let mut polygon = triangle.to_vec();
    for plane in if port.depth_clamp { 2..3 } else { 0..3 } {
        polygon = half(plane, &polygon, port);
    }
    if polygon.iter().any(|v| reaches_out(v, port)) {
        for plane in 3..7 {
            polygon = half(plane, &polygon, port);
        }
    }
    polygon
}

fn reaches_out(v: &Vertex, port: &Viewport) -> bool {
    let [x, y, ..] = to_window(*v, port).position;
    // RAS-1 truncates toward zero, so 65535 sixteenths is the last position inside.
    x.abs() >= 4096.0 || y.abs() >= 4096.0
}

fn to_window(mut v: Vertex, port: &Viewport) -> Vertex {
    let [x, y, z, w] = v.position;
    v.position = [
        port.x + (x / w + 1.0) * (port.width / 2.0),
        port.y + (1.0 - y / w) * (port.height / 2.0),
        port.near + (z / w + 1.0) * ((port.far - port.near) / 2.0),
        w,
    ];
    v
}

/// RAS-6: returns the part of a line in clip space that is not clipped.
fn clipped_line([mut a, mut b]: [Vertex; 2], port: &Viewport) -> Option<[Vertex; 2]> {
    let cut = |planes: std::ops::Range<usize>, a: &mut Vertex, b: &mut Vertex| {
        for plane in planes {
            match (distance(plane, a.position, port) < 0.0, distance(plane, b.position, port) < 0.0) {
                (true, true) => return None,
                (true, false) => *a = crossing(plane, b, a, port),
                (false, true) => *b = crossing(plane, a, b, port),
                (false, false) => {}
            }
        }
        Some(())
    };
    cut(if port.depth_clamp { 2..3 } else { 0..3 }, &mut a, &mut b)?;
    if reaches_out(&a, port) || reaches_out(&b, port) {
        cut(3..7, &mut a, &mut b)?;
    }
    Some([a, b])
}

/// RAS-6: returns whether a point in clip space is left.
fn keeps_point(v: &Vertex, port: &Viewport) -> bool {
    let inside = |plane: usize| distance(plane, v.position, port) >= 0.0;
    let mut planes = if port.depth_clamp { 2..3 } else { 0..3 };
    planes.all(inside) && (!reaches_out(v, port) || (3..7).all(inside))
}

/// Returns twice the signed area of what is left of a triangle on the screen, positive if it turns clockwise (POL-1).
fn turn(draw: &Draw, triangle: [Vertex; 3]) -> i128 {
    let polygon: Vec<[i128; 2]> = match &draw.positions {
        Positions::Window => triangle.to_vec(),
        Positions::Clip(port) => clipped(triangle, port).into_iter().map(|v| to_window(v, port)).collect(),
    }
    .iter()
    .map(|v| [snap(v.position[0]), snap(v.position[1])])
    .collect();
    (0..polygon.len())
        .map(|k| {
            let (p, q) = (polygon[k], polygon[(k + 1) % polygon.len()]);
            p[0] * q[1] - p[1] * q[0]
        })
        .sum()
}

/// Returns everything that a draw consists of, in window space and in order. With flat shading all vertices have the colours of the provoking one.
///
/// A size in 1/8 pixel stands beside each; only points read it.
pub fn figures(draw: &Draw) -> Vec<(Kind, [Vertex; 3], u16)> {
    let vertex = |position: usize| draw.vertices.at(draw.indices[position] as usize);
    // PNT-3
    let size = |position: usize| match &draw.point_sizes {
        Some(sizes) => sizes[draw.indices[position] as usize],
        None => draw.point_size,
    };
    let colored = |mut corners: [Vertex; 3], provoking: usize| {
        if draw.shade_model == ShadeModel::Flat {
            let source = vertex(provoking);
            for v in &mut corners {
                (v.diffuse, v.specular) = (source.diffuse, source.specular);
            }
        }
        corners
    };
    if let Some(all) = stroke::split(draw) {
        let placed = |(kind, corners, provoking): (Kind, [usize; 3], usize)| {
            let [_, a, b] = colored(corners.map(vertex), provoking);
            placed(draw, kind, [a, b], size(corners[0]))
        };
        return all.into_iter().filter_map(placed).collect();
    }
    let mut out = Vec::new();
    let all = split_topology(draw);
    for (place, (corners, provoking)) in all.iter().enumerate() {
        let triangle = colored(corners.map(vertex), *provoking);
        if let Some((kind, parts)) = stroke::of_triangle(draw, (turn(draw, triangle), *corners), place, all.len()) {
            let part = |ends: [usize; 2]| placed(draw, kind, ends.map(|end| triangle[end]), size(corners[ends[0]]));
            out.extend(parts.into_iter().filter_map(part));
            continue;
        }
        match &draw.positions {
            Positions::Window => out.push((Kind::Triangle, triangle, 0)),
            Positions::Clip(port) => {
                let polygon: Vec<Vertex> = clipped(triangle, port).into_iter().map(|v| to_window(v, port)).collect();
                for i in 1..polygon.len().saturating_sub(1) {
                    out.push((Kind::Triangle, [polygon[0], polygon[i], polygon[i + 1]], 0));
                }
            }
        }
    }
    out
}

/// Returns a line or a point in window space, if any of it is left.
fn placed(draw: &Draw, kind: Kind, [a, b]: [Vertex; 2], size: u16) -> Option<(Kind, [Vertex; 3], u16)> {
    let [a, b] = match (&draw.positions, kind) {
        (Positions::Window, _) => [a, b],
        (Positions::Clip(port), Kind::Line) => clipped_line([a, b], port)?.map(|end| to_window(end, port)),
        (Positions::Clip(port), _) => keeps_point(&a, port).then(|| [to_window(a, port); 2])?,
    };
    Some((kind, [a, a, b], size))
}

/// RAS-1: returns a position in 1/16 pixel, truncated toward zero.
fn snap(x: f32) -> i128 {
    let (m, e) = split(x);
    m.signum() * shift(m.abs(), e + 4)
}

/// A triangle after set-up, or a line or a point.
#[derive(Clone)]
pub struct Setup {
    pub vertices: [Vertex; 3],
    kind: Kind,
    strokes: Strokes,
    is_smooth: bool,
    snapped: [[i128; 2]; 3],
    /// Twice the area of the triangle in units of 1/256 pixel, positive.
    area: i128,
    /// 1 if the vertices run clockwise on the screen (y down), otherwise -1.
    turn: i128,
    /// w of the vertices, with perspective.
    w: Option<[Number; 3]>,
}

/// The sample point of one pixel.
#[derive(Clone, Copy)]
pub struct Sample {
    /// Edge functions. None of them is negative if the pixel is covered.
    pub edges: [i128; 3],
    /// The weights of the vertices (WGT-1).
    pub b: [Number; 3],
}

impl Setup {
    /// Sets up a triangle: RAS-1, INT-6. Returns `None` if the area is zero or the triangle is culled.
    pub fn new(draw: &Draw, profile: Profile, (kind, vertices, point_size): (Kind, [Vertex; 3], u16)) -> Option<Setup> {
        let snapped = vertices.map(|v| [snap(v.position[0]), snap(v.position[1])]);
        let [a, b, c] = snapped;
        let cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if kind == Kind::Triangle {
            if cross == 0 {
                return None;
            }
            // RAS-8: an odd number of vertices behind the eye shows the other side.
            let behind = vertices.iter().filter(|v| v.position[3] < 0.0).count();
            let clockwise = (cross > 0) == (behind % 2 == 0);
            let front = clockwise == (draw.front_face == FrontFace::Clockwise);
            match draw.cull {
                Cull::Front if front => return None,
                Cull::Back if !front => return None,
                _ => {}
            }
        }
        // INT-6: nv10 keeps sixteen bits.
        let w = vertices.map(|v| Number::of(v.position[3]).cut(if profile == Profile::Nv10 { 16 } else { 24 }));
        let w = draw.perspective.then_some(w);
        let strokes = Strokes { lines: draw.lines, point_size, points: draw.point_rasterization };
        let smooth_lines = draw.lines.rasterization == LineRasterization::RectangularSmooth;
        let is_smooth = if kind == Kind::Triangle { draw.smooth_polygons } else { kind == Kind::Line && smooth_lines };
        Some(Setup { vertices, kind, strokes, is_smooth, snapped, area: cross.abs(), turn: cross.signum(), w })
    }

    /// PNT-2: returns the distances of a pixel from a point, and the point's size.
    pub fn sprite(&self, i: i128, j: i128) -> Option<([i128; 2], i128)> {
        let [x, y] = self.snapped[0];
        (self.kind == Kind::Point).then(|| ([16 * i + 8 - x, 16 * j + 8 - y], self.strokes.point_size.into()))
    }

    /// Returns whether it is filled, and so takes patterns and offsets.
    pub fn is_filled(&self) -> bool {
        self.kind == Kind::Triangle
    }

    /// RAS-2, RAS-3: returns the edge functions at a pixel, and whether the triangle covers it.
    pub fn edges(&self, i: i128, j: i128) -> ([i128; 3], bool) {
        if !self.is_filled() {
            let ends = [self.snapped[1], self.snapped[2]];
            return stroke::edges(&self.strokes, self.kind, ends, [i, j]);
        }
        let (edges, covered) = self.edges_at(i, j, stroke::CENTRE);
        (edges, self.samples(i, j).map_or(covered, |samples| samples > 0))
    }

    /// SMO-1: returns how many samples of a pixel are covered, or `None` without smooth edges.
    pub fn samples(&self, i: i128, j: i128) -> Option<usize> {
        let covered = || match self.kind {
            Kind::Triangle => stroke::SAMPLES.iter().filter(|sample| self.edges_at(i, j, **sample).1).count(),
            _ => stroke::samples(&self.strokes, [self.snapped[1], self.snapped[2]], [i, j]),
        };
        self.is_smooth.then(covered)
    }

    /// RAS-2, RAS-3: returns the edge functions of a triangle at a sample of a pixel, and whether it is covered.
    fn edges_at(&self, i: i128, j: i128, [right, down]: [i128; 2]) -> ([i128; 3], bool) {
        let (x, y) = (16 * i + right, 16 * j + down);
        let (mut e, mut covered) = ([0; 3], true);
        for k in 0..3 {
            // The edge is turned so that the vertices run clockwise (y down). The inside then lies to the right of s -> t.
            let (mut s, mut t) = (self.snapped[(k + 1) % 3], self.snapped[(k + 2) % 3]);
            if self.turn < 0 {
                (s, t) = (t, s);
            }
            e[k] = (t[0] - s[0]) * (y - s[1]) - (t[1] - s[1]) * (x - s[0]);
            // An edge that goes up has the inside to its right, so it is a left edge. One that goes right has it below, so it is a top
            // edge.
            // RAS-8: for a vertex behind the eye the inside lies on the other side.
            let side = if self.vertices[k].position[3] < 0.0 { -1 } else { 1 };
            let left = t[1] * side < s[1] * side;
            let top = t[1] == s[1] && t[0] * side > s[0] * side;
            covered &= e[k] * side > 0 || (e[k] == 0 && (left || top));
        }
        (e, covered)
    }

    /// WGT-1: returns the sample point of a pixel, or `None` where the edge numbers add to 0 or less, which happens outside only.
    pub fn sample(&self, i: i128, j: i128) -> Option<Sample> {
        let (edges, _) = self.edges(i, j);
        // RAS-8: edge numbers are relative to the second vertex.
        let turned = self.vertices[1].position[3] < 0.0 && self.is_filled();
        let (b, is_negative) = weights::signed_weights(edges, self.w);
        (is_negative == turned).then_some(Sample { edges, b })
    }

    /// SMO-2: returns the sample point of a pixel that is drawn, at its centre even if that is not covered.
    pub fn drawn_sample(&self, i: i128, j: i128) -> Sample {
        let (edges, _) = self.edges(i, j);
        Sample { edges, b: weights::signed_weights(edges, self.w).0 }
    }

    /// INT-2, SMO-2: interpolates one of the two vertex colours.
    pub fn color(&self, weights: [i128; 3], which: impl Fn(&Vertex) -> VertexColor) -> [i128; 4] {
        let colors = [0, 1, 2].map(|k| match which(&self.vertices[k]) {
            VertexColor::Bytes(b) => b.map(i128::from),
            VertexColor::Floats(f) => f.map(color_byte),
        });
        std::array::from_fn(|c| {
            let sum: i128 = (0..3).map(|k| colors[k][c] * weights[k]).sum();
            let mut channel = colors.map(|color| color[c]);
            channel.sort_unstable();
            ((sum + 128) >> 8).clamp(channel[0], channel[2])
        })
    }

    /// WGT-1 (8): interpolates a number of the vertices.
    pub fn number(&self, sample: &Sample, x: impl Fn(&Vertex) -> f32) -> Number {
        weights::linear(self.vertices.each_ref().map(x), sample.b)
    }

    /// DEP-1, DEP-6: returns the number that a depth buffer holds in its own steps, from those of the vertices.
    fn depth_or_w(&self, sample: &Sample, z: [f32; 3], w_buffer: bool) -> Number {
        if !w_buffer {
            let edges = weights::edge_numbers(sample.edges, None);
            let b = weights::shares(edges, weights::reciprocal(weights::total(edges)));
            return weights::linear_from(weights::largest_edge(sample.edges), z, b, 29);
        }
        let w = self.vertices.each_ref().map(|v| v.position[3]);
        let edges = weights::edge_numbers(sample.edges, Some(w.map(Number::of)));
        // 61 bits of the largest count.
        let last = edges.iter().filter_map(|edge| edge.exponent()).max().unwrap_or(0) - 60;
        let edges = edges.map(|edge| edge.cut_at(last));
        let mut b = weights::shares(edges, weights::reciprocal(weights::total(edges)));
        let d = weights::dominant(b);
        b[d] = weights::rest(b, d).cut(24);
        weights::linear_from(1, w, b, 29)
    }

    /// DEP-1, DEP-3 to DEP-5: returns the word for the depth buffer, or `None` if the fragment is dropped.
    pub fn depth(&self, sample: &Sample, test: &DepthTest, format: DepthFormat) -> Option<u32> {
        /// Fraction bits of fixed-point sums.
        const POINT: i32 = 80;
        let fixed = |n: f32| {
            let (m, e) = split(n);
            shift(m, e + POINT)
        };
        let full = i128::from(format.largest());
        let floats = matches!(format, DepthFormat::Z16F | DepthFormat::Z24S8F);
        let z = self.vertices.each_ref().map(|v| match test.vertex_depths {
            VertexDepths::Fractions if !floats => {
                let (m, e) = split(v.position[2].clamp(0.0, 1.0));
                shift(m * full, e) as f32
            }
            _ => v.position[2],
        });
        let value = self.depth_or_w(sample, z, test.w_buffer);
        let mut depth = shift(value.m, value.e + POINT);
        // DEP-5: the larger slope, in steps of the 29th bit of the largest z.
        // LIN-3: lines and points have no offset.
        let offset = if self.is_filled() { test.offset } else { PolygonOffset::default() };
        let largest = z.map(|z| bits(fixed(z))).into_iter().max().unwrap();
        let step = largest - 29;
        let along = |axis: usize| {
            let other = 1 - axis;
            // An edge function changes along an axis by the difference of its two vertices along the other axis, times the step of a pixel.
            let sum: i128 = (0..3)
                .map(|k| {
                    let (s, t) = (self.snapped[(k + 1) % 3], self.snapped[(k + 2) % 3]);
                    (s[other] - t[other]) * 16 * (fixed(z[k]) >> 24)
                })
                .sum();
            shift(sum.abs(), 24 - step) / self.area.max(1)
        };
        let slope = if largest == 0 { 0 } else { along(0).max(along(1)) };
        let (m, e) = if test.w_buffer { (0, 0) } else { split(offset.factor) };
        depth += fixed(offset.bias) + shift(slope * m, e + step);
        if let Some(range) = test.range {
            let (lowest, highest) = (fixed(range.lowest), fixed(range.highest));
            let dropped = |beyond: &dyn Fn(f32) -> bool| range.drops_triangles && z.iter().all(|z| beyond(*z));
            if dropped(&|z| z < range.lowest) || dropped(&|z| z > range.highest) {
                return None;
            }
            if !range.clamps && !(lowest..=highest).contains(&depth) {
                return None;
            }
            depth = depth.clamp(lowest, highest);
        }
        Some(match format {
            _ if depth <= 0 => 0,
            DepthFormat::Z16 | DepthFormat::Z24S8 => (depth >> POINT).min(full) as u32,
            DepthFormat::Z16F | DepthFormat::Z24S8F => {
                // The exponent lies above the fraction, and each format has its own widths.
                let (kept, bias, last) = if full == 0xffff { (12, 7, 15) } else { (16, 127, 254) };
                let power = bits(depth) - 1;
                let fraction = shift(depth, kept - power) as u32 - (1 << kept);
                match power - POINT + bias {
                    field if field < 1 => 0,
                    field if field > last => full as u32,
                    field => ((field as u32) << kept) + fraction,
                }
            }
        })
    }
}
