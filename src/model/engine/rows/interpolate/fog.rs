//! NUM-6, FOG-2 and FOG-4 on rows.
#![allow(clippy::float_arithmetic, reason = "doubles hold every number exactly, and a sum's rounding error is known")]

use super::LaneWeights;
use crate::engine::rows::lanes::{floor_of_sum, floor_within};
use crate::number::convert::factor;
use crate::raster::fog::{CENTRE, FogPlane, TABLE_END, exponential};
use crate::raster::weights::Number;
use crate::state::FogMode;
use std::sync::LazyLock;

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

/// Computes the factors of lanes.
#[inline(always)]
pub(crate) fn factors(fog: &FogPlane<f64>, weights: LaneWeights<'_>, out: &mut [i16]) {
    match fog {
        FogPlane::NotFinite(factor) => out.fill((*factor).into()),
        FogPlane::Factor(number) => weights.each(number, out, |f| factor(floor_within(4096.0 * f, 0.0, 4096.0)) as i16),
        FogPlane::Linear(line, number) => {
            let (p0, p1) = (4096.0 * f64::from(line.p0), 4096.0 * f64::from(line.p1));
            // One call, because compilers inline no closure that two loops call.
            let sign = if line.absolute { 1 << 63 } else { 0 };
            weights.each(number, out, |f| {
                let d = f64::from_bits(f.cut().to_bits() & !sign);
                // The product of 24 bits each is exact.
                let v = floor_of_sum(p0, p1 * d) - 4096.0;
                factor(floor_within(v, 0.0, 4096.0)) as i16
            });
        }
        FogPlane::Exponential(mode, number) => {
            let bytes: &Bytes = match mode {
                FogMode::Exp => &EXP,
                FogMode::ExpAbs => &EXP_ABS,
                _ => &EXP2,
            };
            let (centre, last) = ((CENTRE + FIRST) as f64, (bytes.len() - 1) as f64);
            weights.each(number, out, |f| floor_within((4096.0 * f).floor() - centre, 0.0, last) as i16);
            for out in out {
                *out = i16::from(bytes[*out as usize % bytes.len()]);
            }
        }
    }
}
