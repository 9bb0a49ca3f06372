//! Bounds for the error of a single rule, as `docs/rules` states them.
#![allow(clippy::float_arithmetic, reason = "bounds of errors")]

use ninebit::plan::{Plan, PlannedDraw};
use ninebit::raster::ideal;
use ninebit::state::*;
use ninebit::texture::planned::PlannedUnit;
use ninebit::trace::Rule;

/// Largest error of rounding a quotient by 255: less than half a step, because halves do not occur.
const NEAREST: f64 = 127.0 / 255.0;

/// Returns the lowest and highest error, the definition minus the ideal, in steps (for weights in 256ths). Returns `None` where no bound is stated:
/// the error of SMO-2 depends on how small the triangle is, that of TEX-15 on how small q becomes, and the taps of TEX-17 depend on that.
pub fn error_range(rule: Rule, plan: &Plan) -> Option<(f64, f64)> {
    let policies = &plan.policies;
    let symmetric = |n: f64| Some((-n, n));
    let floor = |slack: f64| Some((-1.0 - slack, slack));
    let is_outside = plan.draws().iter().any(|draw| draw.assembly.has_smooth_edges());
    match rule {
        // Weights outside of a triangle have no bound.
        Rule::Num6 | Rule::Fog2 | Rule::Fog4 | Rule::Int4 | Rule::Tsh7 | Rule::Tsh9 if is_outside => None,
        Rule::Num4 => symmetric(0.5 + 255.0 / 16384.0),
        // The floor to 4096ths, then that of NUM-6.
        Rule::Num6 => floor(2.0 * 255.0 * weights(plan) + 255.0 / 4096.0),
        Rule::Fog2 => floor(fog_slack(plan) + 255.0 / 4096.0),
        // Entries and bytes are rounded, the chord of a segment lies up to 0.96 above the curve, and e is floored to 4096ths where its slope
        // is up to 16 ln 2; at the table's end the curve is 1.
        Rule::Fog4 => {
            let slack = fog_slack(plan) + 255.0 * 11.1 / 4096.0 + 1.0;
            Some((-1.0 - slack, 1.0 + slack))
        }
        Rule::Int2 => symmetric(2.5 + 2.0 * 255.0 * weights(plan)),
        // A floor, the error of the weights, and the cuts of the terms.
        Rule::Int4 => floor(coordinate_slack(plan)),
        // A floor.
        Rule::Smo1 => floor(1e-6),
        Rule::Smo2 | Rule::Tex12 | Rule::Tex15 | Rule::Tex20 | Rule::Tex9 | Rule::Tex17 => None,
        // The ideal follows these coordinates, so only the floor and the last bits of float64 remain.
        Rule::Tsh4 | Rule::Tsh6 => floor(1e-6),
        // A quotient by q magnifies the error of the weights, as in TEX-15.
        Rule::Tsh7 if projects(plan) => None,
        Rule::Tsh7 => floor(coordinate_slack(plan)),
        Rule::Tsh8 => floor(255.0 / 4096.0),
        Rule::Tsh9 => floor(number_slack(plan) + 255.0 / 4096.0),
        // Each byte of a 16-bit half is off by up to the value of the other byte.
        Rule::Tex1 if plan.draws().iter().flat_map(|draw| &draw.units).any(PlannedUnit::is_wide) => symmetric(1.01),
        Rule::Tex1 => symmetric(0.715),
        // A unit test of the decoder finds the extremes.
        Rule::Tex2 => symmetric(1.016),
        Rule::Tex3 => Some((-13.71, 5.484)),
        Rule::Tex4 => Some((-3.42, 4.791)),
        Rule::Tex6 => symmetric(0.5),
        // Three roundings of half a step, doubled, and s/128 for s/127.5.
        Rule::Tex18 => symmetric(4.0),
        // A unit test of the conversion finds the extremes.
        Rule::Tex19 => Some((-3.12, 4.66)),
        Rule::Cmb2 => symmetric(0.0),
        Rule::Cmb3 => match policies.expand_centre {
            ExpandCentre::Centred => symmetric(1.0),
            ExpandCentre::Literal => symmetric(0.0),
        },
        Rule::Cmb4 => match policies.half_bias {
            HalfBiasConstant::Half128 | HalfBiasConstant::Half127 => symmetric(0.5),
            HalfBiasConstant::Half127And5 => symmetric(0.0),
        },
        // -256 negated is 255.
        Rule::Cmb5 => Some((-1.0, 0.0)),
        // With half bits kept, exact halves occur.
        Rule::Cmb6 | Rule::Cmb7 | Rule::Cmb8 if policies.half_bias == HalfBiasConstant::Half127And5 => symmetric(0.5),
        Rule::Cmb6 | Rule::Cmb7 | Rule::Cmb8 => symmetric(NEAREST),
        Rule::Cmb9 => match policies.output_rounding {
            // Biased: -1/2, twice that when doubled. Halved: 0 or 1/2.
            OutputRounding::BeforeScale => Some((-1.0, 0.5)),
            OutputRounding::AfterScale => Some((-1.5, 0.5)),
        },
        Rule::Num3 => match policies.register_floor {
            // The real-number text stops at -255.
            RegisterFloor::Full => Some((-1.0, 0.0)),
            RegisterFloor::Symmetric => symmetric(0.0),
        },
        Rule::Fin2 | Rule::Fin4 | Rule::Rop2 => symmetric(NEAREST),
        // Truncation to 5 bits loses up to 7 steps; the value read back is up to 7 steps below and, widened, up to 7 above.
        Rule::Rop5 => symmetric(7.0),
    }
}

/// Returns the largest relative error of the triangles' weights (WGT-1, INT-6).
fn weights(plan: &Plan) -> f64 {
    triangles(plan).map(|(draw, vertices)| relative(plan, draw, vertices)).fold(0.0, f64::max)
}

/// WGT-1: returns the largest error of an interpolated number. Each weight has its relative error, twice because the sum of all is off as well; the
/// largest term of the sum is a number of the vertices or a difference of them, and up to three terms are cut at its 24th bit.
fn number_error(relative: f64, values: [f64; 3]) -> f64 {
    let (low, high) = range(values);
    let largest = low.abs().max(high.abs()).max(high - low);
    2.0 * relative * (high - low) + 4.0 * 2.0_f64.powi(-23) * largest
}

/// Returns the largest error of a texture coordinate, in 256ths of a texel, that is due to weights and cuts.
fn coordinate_slack(plan: &Plan) -> f64 {
    let slack = triangles(plan).flat_map(|(draw, vertices)| {
        let relative = relative(plan, draw, vertices);
        draw.units.iter().flat_map(move |unit| {
            let sets = vertices.coordinates(unit.stage.coordinate_set);
            let sides = unit.scale(&unit.levels[0]);
            [0, 1].map(|axis| {
                256.0 * f64::from(sides[axis]) * number_error(relative, sets.map(|set| f64::from(set[axis])))
            })
        })
    });
    // The last bits of the ideal's own float64.
    slack.fold(1e-6, f64::max)
}

/// Returns the largest error of a fog factor, in steps, that is due to the light unit's words, the weights and the truncation to 24 bits: the
/// resulting error of d' or e times the steepest slope of the function.
fn fog_slack(plan: &Plan) -> f64 {
    let slack = triangles(plan).map(|(draw, vertices)| {
        let Some(function) = &draw.fog.function else { return 0.0 };
        let (passed, coordinates) = (vertices.fog(), vertices.fog_coordinates());
        let real: [f64; 3] = std::array::from_fn(|k| ideal::fog_of_vertex(function, passed[k], coordinates[k]));
        let (p0, p1) = if function.takes_e() { (0.0, 1.0) } else { (f64::from(function.p0), f64::from(function.p1)) };
        if !(p0.is_finite()
            && p1.is_finite()
            && passed.iter().all(|d| d.is_finite())
            && real.iter().all(|d| d.is_finite()))
        {
            return 0.0;
        }
        let largest = real.iter().fold(0.0, |n, d| d.abs().max(n));
        let rounded = (0..3).map(|k| (f64::from(passed[k]) - real[k]).abs()).fold(0.0, f64::max);
        let cut = 2.0_f64.powi(-23) * largest;
        let moved = rounded + number_error(relative(plan, draw, vertices), real) + cut;
        // 16 ln 2; the slope of 2^(-32 x^2) is steepest where x^2 is 1 / (64 ln 2).
        let slope = match function.mode {
            FogMode::Linear | FogMode::LinearAbs => p1.abs(),
            FogMode::Exp | FogMode::ExpAbs => 11.1,
            FogMode::Exp2 | FogMode::Exp2Abs => 4.05,
        };
        // The last term is the rounding of float64 where large terms cancel.
        255.0 * (slope * moved + 2.0_f64.powi(-48) * (p0.abs() + (p1 * largest).abs() + 1.0))
    });
    slack.fold(0.0, f64::max)
}

/// Returns the largest error of coordinates that become colours, in steps.
fn number_slack(plan: &Plan) -> f64 {
    let slack = triangles(plan).flat_map(|(draw, vertices)| {
        let relative = relative(plan, draw, vertices);
        let components = (0..16).map(move |n| vertices.coordinates(n / 4).map(|set| f64::from(set[n % 4])));
        components.map(move |values| 255.0 * number_error(relative, values))
    });
    slack.fold(1e-6, f64::max)
}

/// Returns whether a unit divides by a q other than 1.
fn projects(plan: &Plan) -> bool {
    triangles(plan).any(|(draw, vertices)| {
        let q = |unit: &PlannedUnit| vertices.coordinates(unit.stage.coordinate_set).map(|set| set[3]);
        draw.units.iter().any(|unit| q(unit) != [1.0; 3])
    })
}

fn triangles(plan: &Plan) -> impl Iterator<Item = (&PlannedDraw, TriangleVertices<'_>)> {
    plan.draws()
        .iter()
        .flat_map(|draw| (0..draw.assembly.triangles.len()).map(move |number| (draw, draw.assembly.triangle(number))))
}

/// Returns the largest relative error of a triangle's weights.
fn relative(plan: &Plan, draw: &PlannedDraw, vertices: TriangleVertices<'_>) -> f64 {
    let (nearest, farthest) = range(vertices.position(3).map(f64::from));
    // What e and b lose, and in perspective the ratio of w and its product.
    if !draw.perspective || nearest == farthest {
        return 2.0 * 2.0_f64.powi(-23);
    }
    let cut = if plan.profile == Profile::Nv10 { 2.0_f64.powi(-15) } else { 0.0 };
    5.0 * 2.0_f64.powi(-23) + 2.0 * cut
}

fn range(values: [f64; 3]) -> (f64, f64) {
    (values[0].min(values[1]).min(values[2]), values[0].max(values[1]).max(values[2]))
}
