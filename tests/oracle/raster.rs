//! Computes covered pixels from vertices, and everything that is interpolated.

use super::real::{align, color_byte, floor_div, shift, split};
use ninebit::state::{
    ClipDepth, Cull, DepthFormat, DepthTest, Draw, FrontFace, Positions, Profile, ProvokingVertex, ShadeModel,
    Topology, Vertex, VertexColor, VertexDepths, Viewport,
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
    let reaches_out = |v: &Vertex| {
        let [x, y, ..] = to_window(*v, port).position;
        // RAS-1 truncates toward zero, so 65535 sixteenths is the last position inside.
        x.abs() >= 4096.0 || y.abs() >= 4096.0
    };
    if polygon.iter().any(reaches_out) {
        for plane in 3..7 {
            polygon = half(plane, &polygon, port);
        }
    }
    polygon
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

/// Returns every triangle of a draw in window space, in order. With flat shading all vertices have the colours of the provoking one.
pub fn triangles(draw: &Draw) -> Vec<[Vertex; 3]> {
    let vertex = |position: usize| draw.vertices.at(draw.indices[position] as usize);
    let mut out = Vec::new();
    for (corners, provoking) in split_topology(draw) {
        let mut triangle = corners.map(vertex);
        if draw.shade_model == ShadeModel::Flat {
            let source = vertex(provoking);
            for v in &mut triangle {
                (v.diffuse, v.specular) = (source.diffuse, source.specular);
            }
        }
        match &draw.positions {
            Positions::Window => out.push(triangle),
            Positions::Clip(port) => {
                let polygon: Vec<Vertex> = clipped(triangle, port).into_iter().map(|v| to_window(v, port)).collect();
                for i in 1..polygon.len().saturating_sub(1) {
                    out.push([polygon[0], polygon[i], polygon[i + 1]]);
                }
            }
        }
    }
    out
}

/// RAS-1: returns a position in 1/16 pixel, truncated toward zero.
fn snap(x: f32) -> i128 {
    let (m, e) = split(x);
    m.signum() * shift(m.abs(), e + 4)
}

/// A triangle after set-up.
#[derive(Clone)]
pub struct Setup {
    pub vertices: [Vertex; 3],
    snapped: [[i128; 2]; 3],
    /// Twice the area of the triangle in units of 1/256 pixel, positive.
    area: i128,
    /// 1 if the vertices run clockwise on the screen (y down), otherwise -1.
    turn: i128,
    /// The perspective weights P of the vertices.
    pub p: [i128; 3],
    /// INT-3: whether the exception for exact weights applies.
    pub exact: bool,
    /// INT-4t: whether coordinates on planes lose 2^-24 S rather than its limit.
    pub finite: bool,
}

/// The sample point of one pixel.
#[derive(Clone, Copy)]
pub struct Sample {
    /// Edge functions. None of them is negative if the pixel is covered.
    pub e: [i128; 3],
    /// Whether the triangle covers the pixel (RAS-3).
    pub covered: bool,
    /// D, the sum of P E, which is positive if the pixel is covered.
    pub d: i128,
}

impl Setup {
    /// Sets up a triangle: RAS-1, INT-6 and P. Returns `None` if the area is zero or the triangle is culled.
    pub fn new(draw: &Draw, profile: Profile, vertices: [Vertex; 3]) -> Option<Setup> {
        let snapped = vertices.map(|v| [snap(v.position[0]), snap(v.position[1])]);
        let [a, b, c] = snapped;
        let cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if cross == 0 {
            return None;
        }
        let clockwise = cross > 0;
        let front = clockwise == (draw.front_face == FrontFace::Clockwise);
        match draw.cull {
            Cull::Front if front => return None,
            Cull::Back if !front => return None,
            _ => {}
        }
        // INT-6: nv10 keeps sixteen of the 24 significant bits.
        let w = vertices.map(|v| match profile {
            Profile::Nv10 => {
                let (m, e) = split(v.position[3]);
                (m >> 8 << 8, e)
            }
            Profile::Nv2a => split(v.position[3]),
        });
        let other = |i: usize, j: usize| (w[i].0 * w[j].0, w[i].1 + w[j].1);
        let p = if draw.perspective {
            align([other(1, 2), other(2, 0), other(0, 1)], 28).map(|p| p.max(1))
        } else {
            [1 << 27; 3]
        };
        let same = w[0] == w[1] && w[1] == w[2];
        let exact = cross.abs().count_ones() == 1 && (!draw.perspective || same);
        Some(Setup { vertices, snapped, area: cross.abs(), turn: cross.signum(), p, exact, finite: false })
    }

    /// RAS-2, RAS-3, INT-1: returns the sample point of a pixel.
    pub fn sample(&self, i: i128, j: i128) -> Sample {
        let (x, y) = (16 * i + 8, 16 * j + 8);
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
            let left = t[1] < s[1];
            let top = t[1] == s[1] && t[0] > s[0];
            covered &= e[k] > 0 || (e[k] == 0 && (left || top));
        }
        Sample { e, covered, d: (0..3).map(|k| self.p[k] * e[k]).sum() }
    }

    /// INT-3: returns the weights P E, and which of them is dominant.
    pub fn weights(&self, sample: &Sample) -> ([i128; 3], usize) {
        let n = std::array::from_fn(|k| self.p[k] * sample.e[k]);
        (n, dominant(n, sample.d))
    }

    /// INT-2, INT-3: returns the weights of the three colours in 256ths.
    pub fn color_weights(&self, sample: &Sample) -> [i128; 3] {
        let (n, dominant) = self.weights(sample);
        let weight = |k: usize| {
            let (q, tie) = floor_div(256 * n[k], sample.d);
            if tie && q > 0 && k != dominant && !self.exact { q - 1 } else { q }
        };
        let (w0, w2) = (weight(0), weight(2));
        [w0, 256 - w0 - w2, w2]
    }

    /// INT-2: interpolates one of the two vertex colours.
    pub fn color(&self, weights: [i128; 3], which: impl Fn(&Vertex) -> VertexColor) -> [i128; 4] {
        let colors = [0, 1, 2].map(|k| match which(&self.vertices[k]) {
            VertexColor::Bytes(b) => b.map(i128::from),
            VertexColor::Floats(f) => f.map(color_byte),
        });
        std::array::from_fn(|c| {
            let sum: i128 = (0..3).map(|k| colors[k][c] * weights[k]).sum();
            (sum + 128) >> 8
        })
    }

    /// TSH-4, FOG-2: interpolates a number of the vertices. Returns the numerator and its exponent; the denominator is D of the sample.
    pub fn attribute(&self, sample: &Sample, x: impl Fn(&Vertex) -> f32) -> (i128, i32) {
        let (g, exponent) = self.attribute_numbers(x);
        ((0..3).map(|k| g[k] * sample.e[k]).sum(), exponent)
    }

    /// Returns the products of the numbers with P in 62 bits, with a common exponent.
    pub fn attribute_numbers(&self, x: impl Fn(&Vertex) -> f32) -> ([i128; 3], i32) {
        let parts: [(i128, i32); 3] = std::array::from_fn(|k| {
            let (m, e) = split(x(&self.vertices[k]));
            (self.p[k] * m, e)
        });
        let Some(top) = parts.iter().filter(|p| p.0 != 0).map(|p| p.1 + super::real::bits(p.0)).max() else {
            return ([0; 3], 0);
        };
        let exponent = top - 62;
        (parts.map(|part| shift(part.0, part.1 - exponent)), exponent)
    }

    /// DEP-1, DEP-3 to DEP-5: returns the word for the depth buffer, or `None` if the fragment is dropped.
    pub fn depth(&self, sample: &Sample, test: &DepthTest, format: DepthFormat) -> Option<u32> {
        /// Fraction bits of fixed-point sums.
        const POINT: i32 = 80;
        let fixed = |n: f32| {
            let (m, e) = split(n);
            shift(m, e + POINT)
        };
        let bits = |n: i128| 128 - n.unsigned_abs().leading_zeros() as i32;
        let keep =
            |n: i128, step: i32| if step > 0 { n.signum() * (n.abs() >> step.min(127) << step.min(127)) } else { n };
        let full = i128::from(format.largest());
        let floats = matches!(format, DepthFormat::Z16F | DepthFormat::Z24S8F);
        let z = self.vertices.each_ref().map(|v| match test.vertex_depths {
            VertexDepths::Fractions if !floats => {
                let (m, e) = split(v.position[2].clamp(0.0, 1.0));
                shift(m * full, e) as f32
            }
            _ => v.position[2],
        });
        // DEP-6: edge functions are multiplied by w_1/w_k, with 24 bits each. The largest gets 61 bits.
        let w = self.vertices.each_ref().map(|v| v.position[3]);
        let in_perspective = |k: usize| {
            let ((m, e), (n, f)) = (split(w[1]), split(w[k]));
            let ratio = (m << 60) / n;
            let ratio = keep(ratio, bits(ratio) - 24);
            let zeros = ratio.trailing_zeros() as i32;
            let edge = keep(sample.e[k], bits(sample.e[k]) - 24);
            let product = edge * (ratio >> zeros);
            (keep(product, bits(product) - 24), e - f - 60 + zeros)
        };
        // Edge functions have 24 bits. Their sum has steps of the 29th bit of the largest.
        let edges = match test.w_buffer {
            true => align([0, 1, 2].map(in_perspective), 61),
            false => sample.e.map(|e| keep(e, bits(e) - 24)),
        };
        let values = if test.w_buffer { w } else { z };
        let step = edges.iter().map(|e| bits(*e)).max().unwrap() - 29;
        let sum = edges.iter().map(|e| keep(*e, step)).sum::<i128>().max(1);
        // 1 / sum in units of 2^-(28 + bits of the sum). It has 29 bits and is 3/16 of the last bit too low, except for powers of two.
        let length = bits(sum);
        let power = sum == 1 << (length - 1);
        let reciprocal = if power { 1 << 29 } else { ((1 << (28 + length + 4)) - 3 * sum).div_euclid(16 * sum) };
        let order = [1, 0, 2];
        let size = |k: usize| bits(sample.e[k].max(0));
        let largest = order.into_iter().find(|k| (0..3).all(|other| size(other) <= size(*k))).unwrap();
        let reference = if test.w_buffer { 1 } else { largest };
        let mut weights = edges.map(|edge| {
            let weight = edge * reciprocal;
            keep(weight, bits(weight) - 24)
        });
        if test.w_buffer {
            // The dominant weight, chosen by exponents, is 1 minus the others.
            let class = weights.map(|weight| if weight > 0 { bits(weight) } else { -1 });
            let dominant = match class {
                [a, b, c] if a >= b && a > c => 0,
                [a, b, c] if c > b && c >= a || a == b && b == c => 2,
                _ => 1,
            };
            let others = weights[(dominant + 1) % 3] + weights[(dominant + 2) % 3];
            let rest = (1 << (28 + length)) - others;
            weights[dominant] = keep(rest, bits(rest) - 24);
        }
        let terms = [0, 1, 2].map(|k| {
            if k == reference {
                return fixed(values[k]);
            }
            let weight = weights[k];
            let zeros = weight.trailing_zeros().min(100) as i32;
            let (m, e) = split(values[k] - values[reference]);
            shift((weight >> zeros) * m, zeros - (28 + length) + e + POINT)
        });
        let step = terms.iter().map(|term| bits(*term)).max().unwrap() - 29;
        let mut depth: i128 = terms.iter().map(|term| keep(*term, step)).sum();
        // DEP-5: the larger slope, in steps of the 29th bit of the largest z.
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
            shift(sum.abs(), 24 - step) / self.area
        };
        let slope = if largest == 0 { 0 } else { along(0).max(along(1)) };
        let (m, e) = if test.w_buffer { (0, 0) } else { split(test.offset.factor) };
        depth += fixed(test.offset.bias) + shift(slope * m, e + step);
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

/// INT-3: returns the weight with the largest binary exponent, where an exact power of two counts as slightly less. A weight that is not
/// positive, which only occurs outside the triangle, is never dominant.
fn dominant(n: [i128; 3], d: i128) -> usize {
    let class = n.map(|n| {
        if n <= 0 {
            return u32::MAX;
        }
        let mut c = 0;
        while n << (c + 1) <= d {
            c += 1;
        }
        c
    });
    let beats = |a: usize, b: usize| class[a] <= class[b];
    if class[0] == class[1] && class[1] == class[2] {
        2
    } else if beats(0, 1) && class[0] < class[2] {
        0
    } else if beats(1, 2) && class[1] < class[0] {
        1
    } else {
        2
    }
}
