//! Clipping (RAS-6, RAS-7) and the mapping from clip space to the window, in f32 and in exactly this order of
//! operations.
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule; set-up quantises afterwards")]

use super::{BAND, SMALLEST_W};
use crate::number::convert::snap;
use crate::state::{ClipDepth, Named, Vertex, VertexColor, Viewport, named};

named! {
    /// A plane that triangles are clipped at (RAS-6). The order of the variants is the order of clipping.
    pub enum ClipPlane {
        /// z = -w, or z = 0 if clip-space depths start at 0.
        Near = "near",
        /// z = w.
        Far = "far",
        /// w = 2^-20.
        W = "w",
        /// The left edge of the guard band.
        Left = "left",
        /// The right edge of the guard band.
        Right = "right",
        /// The top edge of the guard band.
        Top = "top",
        /// The bottom edge of the guard band.
        Bottom = "bottom",
    }
}

impl ClipPlane {
    /// The planes of the clip volume.
    const VOLUME: [ClipPlane; 3] = [ClipPlane::Near, ClipPlane::Far, ClipPlane::W];
    /// The planes of the guard band.
    const SIDES: [ClipPlane; 4] = [ClipPlane::Left, ClipPlane::Right, ClipPlane::Top, ClipPlane::Bottom];

    /// Returns the bit of the plane in a set of planes.
    pub const fn bit(self) -> u8 {
        1 << self as u8
    }

    /// Returns the planes of a set, in order.
    pub fn in_set(set: u8) -> impl Iterator<Item = ClipPlane> {
        ClipPlane::VOLUME.into_iter().chain(ClipPlane::SIDES).filter(move |plane| set & plane.bit() != 0)
    }

    /// Returns the names of the planes of a set, separated by commas.
    pub fn names(set: u8) -> String {
        ClipPlane::in_set(set).map(|plane| plane.name()).collect::<Vec<_>>().join(", ")
    }

    /// Returns the distance of a position from the plane. It is negative outside.
    fn distance(self, [x, y, z, w]: [f32; 4], viewport: &Viewport) -> f32 {
        let (half_width, half_height) = (viewport.width / 2.0, viewport.height / 2.0);
        match self {
            ClipPlane::Near => match viewport.clip_depth {
                ClipDepth::MinusOneToOne => w + z,
                ClipDepth::ZeroToOne => z,
            },
            ClipPlane::Far => w - z,
            ClipPlane::W => w - SMALLEST_W,
            ClipPlane::Left => x * half_width + w * (BAND + (viewport.x + half_width)),
            ClipPlane::Right => w * (BAND - (viewport.x + half_width)) - x * half_width,
            ClipPlane::Top => w * (BAND + (viewport.y + half_height)) - y * half_height,
            ClipPlane::Bottom => y * half_height + w * (BAND - (viewport.y + half_height)),
        }
    }

    /// Moves a position that is near the plane onto it.
    fn snap(self, position: &mut [f32; 4], viewport: &Viewport) {
        let (half_width, half_height) = (viewport.width / 2.0, viewport.height / 2.0);
        let [x, y, z, w] = position;
        match self {
            ClipPlane::Near => match viewport.clip_depth {
                ClipDepth::MinusOneToOne => *z = -*w,
                ClipDepth::ZeroToOne => *z = 0.0,
            },
            ClipPlane::Far => *z = *w,
            ClipPlane::W => *w = SMALLEST_W,
            ClipPlane::Left => *x = -(*w * (BAND + (viewport.x + half_width))) / half_width,
            ClipPlane::Right => *x = *w * (BAND - (viewport.x + half_width)) / half_width,
            ClipPlane::Top => *y = *w * (BAND + (viewport.y + half_height)) / half_height,
            ClipPlane::Bottom => *y = -(*w * (BAND - (viewport.y + half_height))) / half_height,
        }
    }

    /// Returns whether a position is inside. NaN counts as inside, because it is refused later.
    fn inside(self, position: [f32; 4], viewport: &Viewport) -> bool {
        let distance = self.distance(position, viewport);
        distance >= 0.0 || distance.is_nan()
    }

    /// RAS-7: returns the vertex where the edge from `inside` to `outside` crosses the plane.
    fn crossing(self, inside: &Vertex, outside: &Vertex, viewport: &Viewport) -> Vertex {
        let [near, far] = [inside, outside].map(|vertex| self.distance(vertex.position, viewport));
        let t = match self {
            // The difference of the distances is that of the w.
            ClipPlane::W => near / (inside.position[3] - outside.position[3]),
            _ => near / (near - far),
        };
        let mut vertex = mixed(inside, outside, t);
        self.snap(&mut vertex.position, viewport);
        vertex
    }

    /// Returns the part of a polygon that is inside the plane, in the polygon's order.
    fn cut(self, polygon: &[Vertex], viewport: &Viewport) -> Vec<Vertex> {
        let inside = |vertex: &Vertex| self.inside(vertex.position, viewport);
        let mut left = Vec::with_capacity(polygon.len() + 1);
        for (k, from) in polygon.iter().enumerate() {
            let to = &polygon[(k + 1) % polygon.len()];
            match (inside(from), inside(to)) {
                (true, true) => left.push(*from),
                (true, false) => left.extend([*from, self.crossing(from, to, viewport)]),
                (false, true) => left.push(self.crossing(to, from, viewport)),
                (false, false) => {}
            }
        }
        left
    }
}

/// Returns the planes of the clip volume that apply. Clamped depths are not clipped.
fn volume(viewport: &Viewport) -> &'static [ClipPlane] {
    if viewport.depth_clamp { &ClipPlane::VOLUME[2..] } else { &ClipPlane::VOLUME }
}

/// Returns the set of the clip volume's planes that a position is outside of.
pub fn beyond(position: [f32; 4], viewport: &Viewport) -> u8 {
    volume(viewport).iter().filter(|plane| !plane.inside(position, viewport)).map(|plane| plane.bit()).sum()
}

/// RAS-0: returns whether the rasteriser accepts a window position, which is within 4096 pixels of the origin.
pub(crate) fn in_band([x, y, ..]: [f32; 4]) -> bool {
    [x, y].iter().all(|n| n.abs() <= 4096.0 && snap(*n).abs() < super::GUARD)
}

/// Returns the window position of a clip-space position whose w is at least `SMALLEST_W`.
pub fn window(clip: [f32; 4], viewport: &Viewport) -> [f32; 4] {
    let w = clip[3];
    let ndc = [clip[0] / w, clip[1] / w, clip[2] / w];
    [
        viewport.x + (ndc[0] + 1.0) * (viewport.width / 2.0),
        viewport.y + (1.0 - ndc[1]) * (viewport.height / 2.0),
        viewport.near + (ndc[2] + 1.0) * ((viewport.far - viewport.near) / 2.0),
        w,
    ]
}

/// Clips a clip-space triangle (RAS-6), a line or a point. Returns what is left as a polygon in its order, and the set of
/// planes that cut it. The first two vertices of a line are its ends; those after them are the same.
///
/// A new vertex is always computed from the inside vertex toward the outside one, so that adjacent triangles share it.
pub fn clip(corners: &[Vertex], viewport: &Viewport) -> (Vec<Vertex>, u8) {
    let (mut polygon, mut planes) = (corners.to_vec(), 0);
    let mut cut = |polygon: &mut Vec<Vertex>, plane: ClipPlane| {
        if !polygon.iter().all(|vertex| plane.inside(vertex.position, viewport)) {
            planes |= plane.bit();
            *polygon = plane.cut(polygon, viewport);
        }
    };
    for plane in volume(viewport) {
        cut(&mut polygon, *plane);
    }
    if !polygon.iter().all(|vertex| in_band(window(vertex.position, viewport))) {
        for plane in ClipPlane::SIDES {
            cut(&mut polygon, plane);
        }
    }
    (polygon, planes)
}

/// Interpolates between two vertices: a + (b - a) t for each number.
fn mixed(a: &Vertex, b: &Vertex, t: f32) -> Vertex {
    let mix = |a: f32, b: f32| a + (b - a) * t;
    let color = |a: VertexColor, b: VertexColor| {
        if let (VertexColor::Bytes(x), VertexColor::Bytes(y)) = (a, b)
            && x == y
        {
            return a;
        }
        let (a, b) = (floats(a), floats(b));
        VertexColor::Floats(std::array::from_fn(|n| mix(a[n], b[n])))
    };
    Vertex {
        position: std::array::from_fn(|n| mix(a.position[n], b.position[n])),
        diffuse: color(a.diffuse, b.diffuse),
        specular: color(a.specular, b.specular),
        fog: mix(a.fog, b.fog),
        fog_coordinate: a.fog_coordinate.zip(b.fog_coordinate).map(|(a, b)| mix(a, b)),
        texture_coordinates: std::array::from_fn(|set| {
            std::array::from_fn(|n| mix(a.texture_coordinates[set][n], b.texture_coordinates[set][n]))
        }),
    }
}

fn floats(color: VertexColor) -> [f32; 4] {
    match color {
        VertexColor::Bytes(bytes) => bytes.map(|b| f32::from(b) / 255.0),
        VertexColor::Floats(floats) => floats,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PORT: Viewport = Viewport {
        x: 0.0,
        y: 0.0,
        width: 640.0,
        height: 480.0,
        near: 0.0,
        far: 1.0,
        clip_depth: ClipDepth::MinusOneToOne,
        depth_clamp: false,
    };

    fn at(position: [f32; 4]) -> Vertex {
        Vertex { position, fog: position[0], ..Vertex::default() }
    }

    #[test]
    fn what_lies_inside_stays_as_it_is() {
        let triangle = [at([-1.0, 0.0, 0.0, 1.0]), at([1.0, 0.5, 0.25, 1.0]), at([0.0, 1.0, 1.0, 1.0])];
        assert_eq!(clip(&triangle, &PORT), (triangle.to_vec(), 0));
    }

    #[test]
    fn a_corner_behind_the_eye_is_cut_at_the_near_plane() {
        let triangle = [at([0.0, 0.0, 0.0, 1.0]), at([4.0, 0.0, -3.0, -1.0]), at([0.0, 4.0, 0.0, 1.0])];
        let (polygon, planes) = clip(&triangle, &PORT);
        assert_eq!(planes, ClipPlane::Near.bit());
        // t = 1 / (1 + 4).
        let expected = [0.8, 0.0, -0.6, 0.6];
        assert_eq!((polygon[1].position, polygon[1].fog), (expected, 0.8));
        assert_eq!(polygon.len(), 4);
        assert_eq!(polygon[1].position[2], -polygon[1].position[3]);
    }

    #[test]
    fn the_guard_band_cuts_only_what_leaves_it() {
        let far = |x: f32| [at([-1.0, 0.0, 0.0, 1.0]), at([x, 0.0, 0.0, 1.0]), at([0.0, 1.0, 0.0, 1.0])];
        assert_eq!(clip(&far(11.7), &PORT).1, 0);
        let (polygon, planes) = clip(&far(1e6), &PORT);
        assert_eq!((polygon.len(), planes), (4, ClipPlane::Right.bit()));
        assert!(polygon.iter().all(|vertex| in_band(window(vertex.position, &PORT))));
        assert_eq!(window(polygon[1].position, &PORT)[0], BAND);
    }

    #[test]
    fn limited_depths_are_not_cut() {
        let port = Viewport { depth_clamp: true, ..PORT };
        let triangle = [at([-1.0, 0.0, -9.0, 1.0]), at([1.0, 0.5, 9.0, 1.0]), at([0.0, 1.0, 0.0, 1.0])];
        assert_eq!(clip(&triangle, &port).1, 0);
        assert_eq!(clip(&triangle, &PORT).1, ClipPlane::Near.bit() | ClipPlane::Far.bit());
        let from_zero = Viewport { clip_depth: ClipDepth::ZeroToOne, ..PORT };
        let before = [at([-1.0, 0.0, -0.5, 1.0]), at([1.0, 0.5, 0.5, 1.0]), at([0.0, 1.0, 0.5, 1.0])];
        assert_eq!([clip(&before, &PORT).1, clip(&before, &from_zero).1], [0, ClipPlane::Near.bit()]);
        assert_eq!(clip(&before, &from_zero).0[0].position, [0.0, 0.25, 0.0, 1.0]);
    }

    #[test]
    fn neighbours_meet() {
        let (a, b) = (at([3.0, -2.0, 0.1, 0.7]), at([-700.0, 5.0, -9.0, -0.3]));
        let (one, other) = (at([1.0, 1.0, 0.0, 1.0]), at([-1.0, -1.0, 0.0, 1.0]));
        let new = |triangle: [Vertex; 3]| {
            let positions = clip(&triangle, &PORT).0.into_iter().map(|vertex| vertex.position.map(f32::to_bits));
            positions.collect::<std::collections::BTreeSet<_>>()
        };
        let shared = new([a, b, one]).intersection(&new([b, a, other])).count();
        assert_eq!(shared, 2);
    }
}
