//! Fog: words of the light unit, the table of the exponential modes, and the factor of a coordinate.

use super::raster::LARGE;
use super::{Column, Conditions, Kind, Reach, Unit, float, named, put};
use ninebit::number::light;
use ninebit::raster::fog::{FogPlane, FogStep, exponential};
use ninebit::raster::interpolate::Sample;
use ninebit::raster::setup::Triangle;
use ninebit::state::{FogFunction, FogMode, Profile};
use ninebit::vertex::fog::passed;

/// The modes with a table, in the order of the column.
const CURVES: [FogMode; 4] = [FogMode::Exp, FogMode::Exp2, FogMode::ExpAbs, FogMode::Exp2Abs];

/// Returns the fog where all vertices pass this value.
pub(super) fn factor(function: FogFunction, value: f32) -> Option<ninebit::raster::fog::FogFactor> {
    let triangle = Triangle::new(LARGE, true, Profile::Nv2a)?;
    Some(FogPlane::new(Some(function), [value; 3]).at(&Sample::new(&triangle, [1; 3])))
}

/// Returns a float of a magnitude from 2^-7 to 2^9, with the sign and the fraction of these bits.
fn moderate(bits: i64) -> i64 {
    let exponent = 120 + (bits as u32 >> 23 & 15);
    i64::from(bits as u32 & 0x807f_ffff | exponent << 23)
}

/// The fog factor if all vertices have the same coordinate: the numbers that they pass on, and the byte.
pub(super) struct FogFactor;

impl Unit for FogFactor {
    known_as!(
        "fog-factor", &["FOG-1", "FOG-2", "FOG-3", "FOG-4", "FOG-5", "INT-5n", "NUM-6"],
        "the fog of a coordinate by a mode's function of three parameters: what the vertex passes, its steps, FOG.a", Geometry;
        takes [
            Column::choice::<FogMode>("cfg.mode"),
            Column::flag("cfg.per_vertex"),
            ["in.p0", "in.p1", "in.p2"].map(|name| Column::float(name, true, 8)),
            Column::word("in.coordinate", 32),
        ];
        gives [
            Column::result("mid.passed", Kind::Hex(32)),
            Column::result("mid.steps", Kind::Signed(20)),
            Column::result("out.byte", Kind::Unsigned(8)),
        ]
    );

    fn fit(&self, inputs: &mut [i64]) {
        // Parameters as a start and an end or a density yield them: p0 near 1.5, p1 small and usually negative, p2 usually 0.
        if inputs[5] & 3 != 0 {
            inputs[5] = moderate(inputs[5]);
            let near = (inputs[2] & 0x003f_ffff) as u32;
            inputs[2] = i64::from(0x3f80_0000 | near);
            let exponent = 127 - 2 - (inputs[3] & 7) as u32;
            inputs[3] = i64::from(0x8000_0000 | exponent << 23 | (inputs[3] as u32 & 0x007f_ffff));
            inputs[4] = if inputs[5] & 12 != 0 { 0 } else { i64::from((inputs[3] as u32).wrapping_sub(3 << 23)) };
        }
    }

    fn accepts(&self, inputs: &[i64], profile: Profile) -> bool {
        // nv10 has neither coefficients at pixels nor LinearAbs.
        profile == Profile::Nv2a || (inputs[1] != 0 && named::<FogMode>(inputs[0]) != FogMode::LinearAbs)
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let (per_vertex, [p0, p1, p2, coordinate]) = (inputs[1] != 0, [2, 3, 4, 5].map(|n| float(inputs[n])));
        let function = FogFunction { mode: named(inputs[0]), p0, p1, p2, per_vertex };
        let value = passed(&function, conditions.profile, coordinate);
        let Some(found) = factor(function, value) else { return };
        results[0] = value.to_bits().into();
        results[1] = match found.from {
            FogStep::Factor(v) | FogStep::Linear(v, _) => v,
            FogStep::Exponential(q) => q.clamp(-(1 << 19), (1 << 19) - 1),
            FogStep::NotFinite => 0,
        };
        results[2] = found.byte.into();
    }
}

/// The table of the exponential modes.
pub(super) struct FogTable;

impl Unit for FogTable {
    known_as!(
        "fog-table", &["FOG-4"],
        "FOG.a of the steps by which e lies above 3/2, 4096ths, in an exponential mode", Geometry;
        takes [Column::names("cfg.mode", &["Exp", "Exp2", "ExpAbs", "Exp2Abs"]), Column::signed("in.steps", 13, -4096, 4095)];
        gives [Column::result("out.byte", Kind::Unsigned(8))]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        results[0] = exponential(CURVES[inputs[0] as usize & 3], inputs[1]).into();
    }
}

/// The arithmetic of the light unit: conversion, product and sum.
pub(super) struct LightUnit;

impl Unit for LightUnit {
    known_as!(
        "light-unit", &["FOG-1", "FOG-3"],
        "numbers as words of 14 significant bits, the product of the first two, and its sum with the third and the fourth", Geometry;
        takes [["in.a", "in.b", "in.c", "in.d"].map(|name| Column::word(name, 32))];
        gives [Column::results(["mid.a", "mid.b", "mid.c", "mid.d", "out.product", "out.sum"], Kind::Hex(32))]
    );

    fn fit(&self, inputs: &mut [i64]) {
        // Usually of similar magnitudes.
        if inputs[3] & 7 != 0 {
            for input in inputs.iter_mut() {
                *input = moderate(*input);
            }
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let words: [u32; 4] = std::array::from_fn(|n| light::word(inputs[n] as u32));
        let product = light::product(words[0], words[1]);
        let sum = light::sum([product, words[2], words[3]]);
        put(results, words.into_iter().chain([product, sum]));
    }
}
