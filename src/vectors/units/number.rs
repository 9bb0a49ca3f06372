//! Numbers that are given as floats: colours, positions and depths.

use super::{Column, Conditions, Kind, Reach, Unit, float};
use ninebit::number::convert;

/// A float vertex colour as a byte.
pub(super) struct VertexColor;

impl Unit for VertexColor {
    known_as!(
        "vertex-color", &["NUM-4"],
        "a float vertex colour c becomes a byte: clamped to 0..1, cut to 14 significant bits, floor(255 c + 1/2)", Direct;
        takes [Column::float("in.color", true, 2)]; gives [Column::result("out.byte", Kind::Unsigned(8))]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        results[0] = convert::vertex_color(float(inputs[0])).into();
    }

    fn regressions(&self) -> Vec<Vec<i64>> {
        // Infinities and NaN, and colours that fifteen significant bits would round up to the next byte.
        let bits = [0x7f80_0000, 0xff80_0000, 0x7fc0_0000, 0x8000_0000, 0x3b00_8200, 0x3efd_fe00, 0x3f7d_7e00];
        bits.map(|bits| vec![bits]).to_vec()
    }
}

/// A float constant as a byte.
pub(super) struct ConstantColor;

impl Unit for ConstantColor {
    known_as!(
        "constant-color", &["NUM-0"],
        "a float constant c becomes a byte: floor(255 c + 1/2) after clamping to 0..1, exactly", Direct;
        takes [Column::float("in.color", true, 2)]; gives [Column::result("out.byte", Kind::Unsigned(8))]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        results[0] = convert::constant(float(inputs[0])).into();
    }
}

/// A window coordinate in 1/16 pixel.
pub(super) struct VertexSnap;

impl Unit for VertexSnap {
    known_as!(
        "vertex-snap", &["RAS-1"], "a window coordinate becomes 1/16 pixel, truncated toward zero", Geometry;
        takes [Column::float("in.coordinate", true, 12)]; gives [Column::result("out.snapped", Kind::Signed(17))]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        results[0] = convert::snap(float(inputs[0]));
    }
}

/// A depth in the buffer's units.
pub(super) struct Depth;

impl Unit for Depth {
    known_as!(
        "depth", &["DEP-1"], "a depth z becomes floor(z (2^bits - 1)), clamped to the buffer's range", Geometry;
        takes [Column::listed("cfg.bits", Kind::Unsigned(5), &[16, 24]), Column::float("in.depth", true, 2)];
        gives [Column::result("out.depth", Kind::Unsigned(24))]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        results[0] = convert::depth(float(inputs[1]), inputs[0] as u32);
    }
}
