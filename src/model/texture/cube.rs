//! TEX-12, TEX-13: which face of a cube map a direction meets, and where.

use crate::state::named;

named! {
    /// The faces, in the order in which a cube map stores them.
    pub enum Face {
        /// +X.
        PositiveX,
        /// -X.
        NegativeX,
        /// +Y.
        PositiveY,
        /// -Y.
        NegativeY,
        /// +Z.
        PositiveZ,
        /// -Z.
        NegativeZ,
    }
}

/// A component of the direction: its axis (0 x, 1 y, 2 z), and whether it enters negated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signed {
    /// 0 x, 1 y, 2 z.
    pub axis: usize,
    /// The component is taken with the other sign.
    pub negative: bool,
}

impl Face {
    /// The face that a direction meets: that of its largest component; ties X over Y over Z. The zero vector, and one that cannot be compared,
    /// meets +X. `zero` is the number 0.
    pub fn from_direction<T: PartialOrd + Copy>(direction: [T; 3], magnitudes: [T; 3], zero: T) -> Face {
        let [x, y, z] = magnitudes;
        let axis = if x >= y && x >= z {
            0
        } else if y >= z {
            1
        } else {
            2
        };
        let negative = direction[axis] < zero;
        match (axis, negative) {
            (0, false) => Face::PositiveX,
            (0, true) => Face::NegativeX,
            (1, false) => Face::PositiveY,
            (1, true) => Face::NegativeY,
            (_, false) => Face::PositiveZ,
            (_, true) => Face::NegativeZ,
        }
    }

    /// The components sc, tc and ma: u = (sc/|ma| + 1)/2, v = (tc/|ma| + 1)/2, and ma as it is not negative on this face.
    pub fn components(self) -> [Signed; 3] {
        let of = |(axis, negative)| Signed { axis, negative };
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

    /// u and v stay within 0..1 on the face that is chosen.
    #[test]
    fn minor_components_are_not_larger() {
        for n in 0..33_i32.pow(3) {
            let d = [n % 33 - 16, n / 33 % 33 - 16, n / 1089 - 16];
            let [s, t, m] = face_of(d).components().map(|c| if c.negative { -d[c.axis] } else { d[c.axis] });
            assert!(m >= s.abs() && m >= t.abs(), "{d:?}");
        }
    }
}
