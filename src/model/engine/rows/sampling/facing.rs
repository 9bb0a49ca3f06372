//! TEX-12 on rows: the face that a direction meets, without branches.
#![allow(clippy::float_arithmetic, reason = "signs of components, and small whole numbers")]

use crate::engine::rows::lanes::larger;
use crate::raster::weights::{Number, quotient};
use crate::texture::cube::Face;
use std::ops::{Add, Neg};

/// TEX-12: the face that a direction meets.
#[derive(Clone, Copy)]
pub(crate) struct Facing {
    on_x: bool,
    on_y: bool,
    /// Whether the major component is negative.
    is_negative: bool,
}

impl Facing {
    /// Chooses X before Y and Y before Z, as `Face::from_direction`. One choice at a time, because compilers turn nested ones into branches.
    #[inline(always)]
    pub(crate) fn new<T: Copy + PartialOrd + Neg<Output = T> + Default>([x, y, z]: [T; 3]) -> Facing {
        let (a, b, c) = (larger(x, -x), larger(y, -y), larger(z, -z));
        let on_x = (a >= b) & (a >= c);
        let on_y = !on_x & (b >= c);
        let major = if on_y { y } else { z };
        let major = if on_x { x } else { major };
        Facing { on_x, on_y, is_negative: major < T::default() }
    }

    /// Returns s, t and the major component of a direction on the face. The last is not positive if the direction points away from it.
    #[inline(always)]
    pub(crate) fn components<T: Copy + Neg<Output = T>>(self, [x, y, z]: [T; 3]) -> [T; 3] {
        let turned = |v: T| if self.is_negative { -v } else { v };
        let other = turned(if self.on_x { -z } else { x });
        let s = if self.on_y { x } else { other };
        let t = if self.on_y { turned(z) } else { -y };
        let major = if self.on_y { y } else { z };
        [s, t, turned(if self.on_x { x } else { major })]
    }

    /// Returns the number of the face, as a float of the direction's type: vectors of other widths take longer.
    #[inline(always)]
    pub(crate) fn number<T: Copy + From<f32> + Add<Output = T>>(self) -> T {
        let [x, y, z] = [Face::PositiveX, Face::PositiveY, Face::PositiveZ].map(|face| T::from(face as u32 as f32));
        let axis = if self.on_y { y } else { z };
        let axis = if self.on_x { x } else { axis };
        axis + if self.is_negative { T::from(1.0) } else { T::from(0.0) }
    }
}

/// TEX-12: returns the floors of u and v on a face, from s, t and the major component of a direction. The middle of the face has the coordinates `middle`.
/// They are 0 where the major component is not positive.
#[inline(always)]
pub(crate) fn floors_on_face([s, t, m]: [f64; 3], middle: f64) -> [f64; 2] {
    let (middle, by) = if m > 0.0 { (middle, m) } else { (0.0, 1.0) };
    let reciprocal = by.reciprocal::<true>();
    // Numbers of 24 bits times a power of two.
    [s, t].map(|minor| middle + (middle * quotient(minor, reciprocal)).floor())
}
