//! The fog factor.

use super::named;
use crate::number::convert::{factor_byte, split};
use crate::raster::fog;
use crate::state::{FogFunction, FogMode, Profile};
use crate::vectors::column::{Column, Kind};
use crate::vectors::unit::{Conditions, Reach, Unit};

/// The factor of a pixel's fog coordinate, and its byte.
#[derive(Debug)]
pub(super) struct FogFactor;

impl Unit for FogFactor {
    fn name(&self) -> &'static str {
        "fog-factor"
    }

    fn about(&self) -> &'static str {
        "the fog factor of a coordinate by a mode's function of two parameters, in 4096ths, and FOG.a"
    }

    fn rules(&self) -> &'static [&'static str] {
        &["INT-5", "NUM-6"]
    }

    fn profiles(&self) -> &'static [Profile] {
        &[Profile::Nv2a]
    }

    fn inputs(&self) -> Vec<Column> {
        let mut columns = vec![Column::choice::<FogMode>("cfg.mode")];
        columns.extend(["in.p0", "in.p1", "in.coordinate"].map(|name| Column::float(name, true, 8)));
        columns
    }

    fn results(&self) -> Vec<Column> {
        vec![Column::result("out.factor", Kind::Unsigned(13)), Column::result("out.byte", Kind::Unsigned(8))]
    }

    fn fit(&self, inputs: &mut [i64]) {
        // Parameters as a start and an end or a density give them: p0 near 1.5, p1 small and mostly negative.
        if inputs[3] & 3 != 0 {
            let near = (inputs[1] & 0x003f_ffff) as u32;
            inputs[1] = i64::from(0x3f80_0000 | near);
            let exponent = 127 - 2 - (inputs[2] & 7) as u32;
            inputs[2] = i64::from(0x8000_0000 | exponent << 23 | (inputs[2] as u32 & 0x007f_ffff));
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let float = |n: usize| f32::from_bits(inputs[n] as u32);
        let function = FogFunction { mode: named(inputs[0]), p0: float(1), p1: float(2) };
        let factor = fog::evaluate(&function, split(float(3)));
        (results[0], results[1]) = (factor.value, factor_byte(factor.value).into());
    }

    fn reach(&self, _: &[i64], _: &[i64]) -> Reach {
        Reach::Geometry
    }
}
