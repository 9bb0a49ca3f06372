//! TEX-12, TEX-13: the face of a cube map that a direction meets, and the coordinates on it.

use crate::number::Choice;
use crate::state::named;

named! {
    /// Faces of a cube map, in the order in which they are stored.
    pub enum Face {
        /// Face 0, in the direction +X.
        PositiveX,
        /// Face 1, in the direction -X.
        NegativeX,
        /// Face 2, in the direction +Y.
        PositiveY,
        /// Face 3, in the direction -Y.
        NegativeY,
        /// Face 4, in the direction +Z.
        PositiveZ,
        /// Face 5, in the direction -Z.
        NegativeZ,
    }
}

/// A component of a direction, which may be negated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SignedAxis {
    /// Axis of the component: 0 for x, 1 for y, 2 for z.
    pub axis: usize,
    /// Whether the component is negated.
    pub negative: bool,
}

/// Returns whether the major axis of a direction is x and whether it is y, from whether x is not smaller than y, x than z, and y than z. Ties prefer X
/// to Y and Y to Z.
#[inline(always)]
pub fn major_axis<C: Choice>([x_y, x_z, y_z]: [C; 3]) -> [C; 2] {
    let is_x = x_y & x_z;
    [is_x, !is_x & y_z]
}

impl Face {
    /// Returns the face that a direction meets, which is that of its largest component. Ties prefer X to Y and Y to Z.
    /// The zero vector, and a vector that cannot be compared, meets +X. `zero` is the number 0.
    pub fn from_direction<T: PartialOrd + Copy>(direction: [T; 3], magnitudes: [T; 3], zero: T) -> Face {
        let [x, y, z] = magnitudes;
        Face::from_axis(major_axis([x >= y, x >= z, y >= z]), |axis| direction[axis] < zero)
    }

    /// Returns a face on the [major axis](major_axis), of whose component `is_negative` gives the sign.
    pub(crate) fn from_axis([is_x, is_y]: [bool; 2], is_negative: impl FnOnce(usize) -> bool) -> Face {
        let axis = if is_x { 0 } else { 2 - usize::from(is_y) };
        match (axis, is_negative(axis)) {
            (0, false) => Face::PositiveX,
            (0, true) => Face::NegativeX,
            (1, false) => Face::PositiveY,
            (1, true) => Face::NegativeY,
            (_, false) => Face::PositiveZ,
            (_, true) => Face::NegativeZ,
        }
    }

    /// Returns the components sc, tc and |ma| of the face, so that u = (sc/|ma| + 1)/2 and v = (tc/|ma| + 1)/2.
    pub fn components(self) -> [SignedAxis; 3] {
        let of = |(axis, negative)| SignedAxis { axis, negative };
        let (x, y, z) = ((0, false), (1, false), (2, false));
        let (minus_x, minus_y, minus_z) = ((0, true), (1, true), (2, true));
        match self {
            Face::PositiveX => [minus_z, minus_y, x],
            Face::NegativeX => [z, minus_y, minus_x],
            Face::PositiveY => [x, z, y],
            Face::NegativeY => [x, minus_z, minus_y],
            Face::PositiveZ => [x, minus_y, z],
            Face::NegativeZ => [minus_x, minus_y, minus_z],
        }
        .map(of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn face_of([x, y, z]: [i32; 3]) -> Face {
        Face::from_direction([x, y, z], [x.abs(), y.abs(), z.abs()], 0)
    }

    #[test]
    fn axes_ties_and_zero() {
        let axes = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
        assert_eq!(axes.map(face_of).as_slice(), <Face as crate::state::Named>::ALL);
        assert_eq!(
            [[1, 1, 1], [-1, 1, 1], [0, -1, 1], [0, 0, 0]].map(face_of),
            [Face::PositiveX, Face::NegativeX, Face::NegativeY, Face::PositiveX]
        );
    }

    /// u and v are within 0..1 on the chosen face.
    #[test]
    fn minor_components_are_not_larger() {
        for n in 0..33_i32.pow(3) {
            let d = [n % 33 - 16, n / 33 % 33 - 16, n / 1089 - 16];
            let [s, t, m] = face_of(d).components().map(|c| if c.negative { -d[c.axis] } else { d[c.axis] });
            assert!(m >= s.abs() && m >= t.abs(), "{d:?}");
        }
    }
}
