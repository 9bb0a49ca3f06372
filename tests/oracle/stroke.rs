//! Lines, points and patterns, pixel by pixel: LIN-1, LIN-2, PNT-1, POL-1, STP-1; the samples of smooth edges: SMO-1.

use ninebit::state::{
    Cull, Draw, FrontFace, LineRasterization, Lines, PointRasterization, PolygonMode, PolygonModes, ProvokingVertex,
    Topology,
};

/// What a draw draws, with vertices in clip or window space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Triangle,
    /// From the second vertex to the third; the first is the second once more.
    Line,
    Point,
}

/// The state of a draw's lines and points.
#[derive(Clone, Copy)]
pub struct Strokes {
    pub lines: Lines,
    pub point_size: u16,
    pub points: PointRasterization,
}

/// Returns the positions in the index list of what a draw's lines or points have as vertices, and that of the provoking one.
pub fn split(draw: &Draw) -> Option<Vec<(Kind, [usize; 3], usize)>> {
    let n = draw.indices.len();
    let last = draw.provoking_vertex == ProvokingVertex::Last;
    let line = |a: usize, b: usize| (Kind::Line, [a, a, b], if last { b } else { a });
    Some(match draw.topology {
        Topology::Points => (0..n).map(|k| (Kind::Point, [k, k, k], k)).collect(),
        Topology::Lines => (0..n / 2).map(|k| line(2 * k, 2 * k + 1)).collect(),
        Topology::LineStrip => (0..n.saturating_sub(1)).map(|k| line(k, k + 1)).collect(),
        Topology::LineLoop if n > 1 => (0..n).map(|k| line(k, if k + 1 == n { 0 } else { k + 1 })).collect(),
        Topology::LineLoop => Vec::new(),
        _ => return None,
    })
}

/// POL-1: returns what is drawn of a triangle that turns by `cross` on the screen, as pairs of its vertices, or `None` if it is filled. `place` is its
/// number among those of its draw, which are `count`.
///
/// `corners` are the positions of the triangle's vertices in the index list.
pub fn of_triangle(
    draw: &Draw,
    (cross, corners): (i128, [usize; 3]),
    place: usize,
    count: usize,
) -> Option<(Kind, Vec<[usize; 2]>)> {
    let front = (cross > 0) == (draw.front_face == FrontFace::Clockwise);
    let hidden = match draw.cull {
        Cull::None => false,
        Cull::Front => front,
        Cull::Back => !front,
    };
    let mode = if front { draw.polygon_modes.front } else { draw.polygon_modes.back };
    if draw.polygon_modes == PolygonModes::FILL || (mode == PolygonMode::Fill && cross != 0 && !hidden) {
        return None;
    }
    if hidden || mode == PolygonMode::Fill {
        return Some((Kind::Line, Vec::new()));
    }
    let even = place.is_multiple_of(2);
    // Whether an edge lies within a quad, a strip of quads or a polygon.
    let inner = |from: usize, to: usize| match draw.topology {
        Topology::Quads => [from, to] == if even { [2, 0] } else { [0, 1] },
        Topology::QuadStrip => [from, to] == if even { [1, 2] } else { [0, 1] },
        Topology::Polygon => ([from, to] == [2, 0] && place + 1 < count) || ([from, to] == [0, 1] && place > 0),
        _ => false,
    };
    let flag = |from: usize| match (&draw.edge_flags, draw.topology) {
        (Some(flags), Topology::Triangles | Topology::Quads | Topology::Polygon) => {
            flags[draw.indices[corners[from]] as usize]
        }
        _ => true,
    };
    let edges = [[1, 2], [2, 0], [0, 1]].into_iter().filter(|[from, to]| !inner(*from, *to) && flag(*from));
    Some(match mode {
        PolygonMode::Line => (Kind::Line, edges.collect()),
        _ => (Kind::Point, edges.map(|[from, _]| [from, from]).collect()),
    })
}

/// STP-1: returns whether a filled triangle has pixels here.
pub fn patterned(draw: &Draw, x: u64, y: u64) -> bool {
    let Some(stipple) = &draw.polygon_stipple else { return true };
    let word = stipple.0[31 - (y % 32) as usize];
    let byte = word.to_le_bytes()[(x % 32 / 8) as usize];
    (byte >> (7 - x % 8)) % 2 == 1
}

/// SMO-1: the samples of a pixel, in 1/16 from its upper left corner.
pub const SAMPLES: [[i128; 2]; 8] = [[0, 0], [6, 2], [12, 4], [2, 6], [8, 8], [14, 10], [4, 12], [10, 14]];

/// A pixel's centre.
pub const CENTRE: [i128; 2] = [8, 8];

/// SMO-1: returns how many samples of a pixel a smooth line covers.
pub fn samples(of: &Strokes, ends: [[i128; 2]; 2], pixel: [i128; 2]) -> usize {
    SAMPLES.iter().filter(|sample| wide(of.lines.width.into(), ends, pixel, **sample).1).count()
}

/// Returns the edge functions of a line or a point at a pixel, and whether it covers the pixel.
pub fn edges(of: &Strokes, kind: Kind, ends: [[i128; 2]; 2], pixel: [i128; 2]) -> ([i128; 3], bool) {
    if kind == Kind::Point {
        let covered = match of.points {
            PointRasterization::Rectangular => point(of.point_size.into(), ends[0], pixel),
            PointRasterization::Thin => thin_point(ends[0], pixel),
        };
        return ([0, 1, 0], covered);
    }
    match of.lines.rasterization {
        LineRasterization::Rectangular => wide(of.lines.width.into(), ends, pixel, CENTRE),
        LineRasterization::RectangularSmooth => {
            let width = i128::from(of.lines.width);
            let covered = SAMPLES.iter().any(|sample| wide(width, ends, pixel, *sample).1);
            (wide(width, ends, pixel, CENTRE).0, covered)
        }
        LineRasterization::Bresenham => thin(ends, pixel),
    }
}

fn point(n: i128, at: [i128; 2], pixel: [i128; 2]) -> bool {
    (0..2).all(|axis| {
        let d = 16 * pixel[axis] + 8 - at[axis];
        match n {
            0 => at[axis].div_euclid(16) == pixel[axis],
            // The upper end counts unless n is 1, 2, 4 and so on.
            _ => -n <= d && d <= n && (d < n || n.count_ones() > 1),
        }
    })
}

fn thin_point([x, y]: [i128; 2], [i, j]: [i128; 2]) -> bool {
    (16 * i..16 * i + 16).contains(&x) && (16 * j + 1..=16 * j + 16).contains(&y)
}

fn wide(n: i128, [from, to]: [[i128; 2]; 2], pixel: [i128; 2], sample: [i128; 2]) -> ([i128; 3], bool) {
    let d = [to[0] - from[0], to[1] - from[1]];
    let p = [0, 1].map(|axis| 16 * pixel[axis] + sample[axis] - from[axis]);
    let square = d[0] * d[0] + d[1] * d[1];
    let along = p[0] * d[0] + p[1] * d[1];
    let across = 2 * (p[1] * d[0] - p[0] * d[1]);
    let (major, minor) = (d[0].abs().max(d[1].abs()), d[0].abs().min(d[1].abs()));
    let reach = n * (2 * major + minor);
    // Each limit with the direction in which it grows.
    let limits = [
        (along, d),
        (square - along, [-d[0], -d[1]]),
        (reach - across, [d[1], -d[0]]),
        (reach + across, [-d[1], d[0]]),
    ];
    let holds = |(e, [x, y]): (i128, [i128; 2])| e > 0 || (e == 0 && (x < 0 || (x == 0 && y > 0)));
    let h = (n + 15) / 16;
    let boxed = (0..2).all(|axis| {
        let (least, most) = (from[axis].min(to[axis]), from[axis].max(to[axis]));
        (least.div_euclid(16) - h..=most.div_euclid(16) + h).contains(&pixel[axis])
    });
    ([0, square - along, along], n > 0 && boxed && limits.into_iter().all(holds))
}

fn thin([from, to]: [[i128; 2]; 2], pixel: [i128; 2]) -> ([i128; 3], bool) {
    let d = [to[0] - from[0], to[1] - from[1]];
    let major = usize::from(d[0].abs() < d[1].abs());
    let minor = 1 - major;
    let forward = d[major] > 0;
    // Where the line leaves the column or the row.
    let leaves = 16 * (pixel[major] + i128::from(forward));
    let length = d[major].abs();
    let steps = if forward { leaves - from[major] } else { from[major] - leaves };
    let edges = [0, length - steps, steps];
    let (least, most) = (from[major].min(to[major]), from[major].max(to[major]));
    let on = if major == 0 { least < leaves && leaves <= most } else { least <= leaves && leaves < most };
    if !on {
        return (edges, false);
    }
    // The other axis at the centre, times the length.
    let at = from[minor] * length + (16 * pixel[major] + 8 - from[major]) * d[minor] * d[major].signum();
    let (start, end) = (16 * pixel[minor] * length, (16 * pixel[minor] + 16) * length);
    (edges, if major == 0 { start < at && at <= end } else { start <= at && at < end })
}
