//! NUM-6, FOG-2 and FOG-4 on rows.
#![allow(clippy::float_arithmetic, reason = "doubles hold every number exactly, and a sum's rounding error is known")]

use super::Weighted;
use crate::engine::rows::lanes::{floor_of_sum, floor_within};
use crate::number::convert::factor;
use crate::raster::fog::{self, CENTRE, TABLE_END, exponential, limited, not_finite};
use crate::raster::weights::{Linear, Number};
use crate::state::{FogFunction, FogMode};
use std::sync::LazyLock;

/// The fog of a triangle's pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Fog {
    /// It is the same everywhere.
    Same(i16),
    /// An interpolated factor (INT-5n).
    Factor(Linear<f64>),
    /// A line over the coordinate d' (FOG-2): 4096 p0, 4096 p1, and whether the magnitude is used.
    Line(Linear<f64>, [f64; 2], bool),
    /// A table over the coordinate e (FOG-4).
    Table(Linear<f64>, &'static Bytes),
}

/// Bytes of FOG-4 from [`FIRST`] on, up to the first of which all that follow are the same.
type Bytes = [u8; (2 * TABLE_END) as usize + 1];

/// The least q in the table. Smaller ones have the byte of this one, and larger ones that of the last.
const FIRST: i64 = -TABLE_END;

static EXP: LazyLock<Bytes> = LazyLock::new(|| bytes(FogMode::Exp));
static EXP_ABS: LazyLock<Bytes> = LazyLock::new(|| bytes(FogMode::ExpAbs));
static EXP2: LazyLock<Bytes> = LazyLock::new(|| bytes(FogMode::Exp2));

fn bytes(mode: FogMode) -> Bytes {
    std::array::from_fn(|n| exponential(mode, FIRST + n as i64))
}

impl Fog {
    /// Sets up a triangle from the factors of its vertices, or from the coordinates of the function.
    #[inline(always)]
    pub(crate) fn new(function: Option<&FogFunction>, vertices: [f32; 3]) -> Fog {
        let Some(function) = function else {
            let [a, b, c] = vertices;
            return Fog::Factor(Linear::new([limited(a), limited(b), limited(c)]));
        };
        let finite = vertices[0].is_finite() && vertices[1].is_finite() && vertices[2].is_finite();
        match fog::Curve::new(function).filter(|_| finite) {
            None => Fog::Same(i16::from(not_finite(function.mode))),
            Some(fog::Curve::Line(line)) => {
                let scaled = [line.p0, line.p1].map(|p| 4096.0 * f64::from(p));
                Fog::Line(Linear::new(vertices), scaled, line.absolute)
            }
            Some(fog::Curve::Table(mode)) => Fog::Table(
                Linear::new(vertices),
                match mode {
                    FogMode::Exp => &EXP,
                    FogMode::ExpAbs => &EXP_ABS,
                    _ => &EXP2,
                },
            ),
        }
    }

    /// Computes the factors of lanes.
    #[inline(always)]
    pub(crate) fn factors(&self, weights: Weighted<'_>, out: &mut [i16]) {
        match self {
            Fog::Same(factor) => out.fill(*factor),
            Fog::Factor(number) => weights.each(number, out, |f| factor(floor_within(4096.0 * f, 0.0, 4096.0)) as i16),
            Fog::Line(number, [p0, p1], absolute) => {
                let (p0, p1) = (*p0, *p1);
                // One call, because compilers inline no closure that two loops call.
                let sign = if *absolute { 1 << 63 } else { 0 };
                weights.each(number, out, |f| {
                    let d = f64::from_bits(f.cut().to_bits() & !sign);
                    // The product of 24 bits each is exact.
                    let v = floor_of_sum(p0, p1 * d) - 4096.0;
                    factor(floor_within(v, 0.0, 4096.0)) as i16
                });
            }
            Fog::Table(number, bytes) => {
                let (centre, last) = ((CENTRE + FIRST) as f64, (bytes.len() - 1) as f64);
                weights.each(number, out, |f| floor_within((4096.0 * f).floor() - centre, 0.0, last) as i16);
                for out in out {
                    *out = i16::from(bytes[*out as usize % bytes.len()]);
                }
            }
        }
    }
}
