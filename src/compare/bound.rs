//! Between which numbers the error of a single rule lies: the bounds that `docs/numerics.md` states.
#![allow(clippy::float_arithmetic, reason = "bounds of errors")]

use crate::plan::{Plan, PlannedDraw};
use crate::state::{ExpandCentre, HalfBiasConstant, OutputRounding, Profile, RegisterFloor};
use crate::trace::Rule;

/// Half a step, less what a quotient by 255 cannot reach.
const NEAREST: f64 = 127.0 / 255.0;

/// Lowest and highest error, the definition minus the ideal, in steps (weights: 256ths). None is stated for TEX-15, whose error depends
/// on how small q becomes.
pub fn of(rule: Rule, plan: &Plan) -> Option<(f64, f64)> {
    let policies = &plan.policies;
    let symmetric = |n: f64| Some((-n, n));
    match rule {
        Rule::Num4 => symmetric(0.5 + 255.0 / 16384.0),
        // The floor to 4096ths comes first, then that of NUM-6.
        Rule::Num6 => Some((-1.0 - 255.0 / 4096.0, 255.0 / 4096.0)),
        Rule::Int2 => symmetric(2.5),
        // A floor, one step lower on a tie, and what the weights are off.
        Rule::Int4 => Some((-1.0 - coordinate_slack(plan), coordinate_slack(plan))),
        Rule::Tex15 => None,
        Rule::Tex1 => symmetric(0.715),
        Rule::Tex6 => symmetric(0.5),
        Rule::Tex18 => symmetric(3.0),
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
        // With half bits kept exact halves exist.
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
        Rule::Fin2 | Rule::Fin4 => symmetric(NEAREST),
        Rule::Rop2 => symmetric(NEAREST),
        // 5 bits lose up to 7 steps when they are cut; read back they are up to 7 below and, widened, up to 7 above.
        Rule::Rop5 => symmetric(7.0),
    }
}

/// How far weights that are off move a texture coordinate, in 256ths of a texel: the span of the coordinate over a triangle times the
/// relative error of its weights (INT-1, INT-6), twice because the weights' sum is off as well.
fn coordinate_slack(plan: &Plan) -> f64 {
    let draws = plan.draws.iter().filter(|draw| !draw.units.is_empty());
    let slack = draws.flat_map(|draw| (0..draw.assembly.triangles.len()).map(|n| triangle_slack(plan, draw, n)));
    // The last bits of the ideal's own float64.
    slack.fold(1e-6, f64::max)
}

fn triangle_slack(plan: &Plan, draw: &PlannedDraw, number: usize) -> f64 {
    let vertices = draw.assembly.triangles[number].vertices.map(|v| &draw.assembly.vertices[v as usize]);
    let range = |values: [f64; 3]| {
        let (low, high) = values.into_iter().fold((f64::INFINITY, -f64::INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        (low, high)
    };
    let (nearest, farthest) = range(vertices.map(|v| f64::from(v.position[3])));
    let relative = if !draw.perspective || nearest == farthest {
        0.0
    } else {
        let cut = if plan.profile == Profile::Nv10 { 2.0_f64.powi(-15) } else { 0.0 };
        2.0_f64.powi(-27) * farthest / nearest + 2.0 * cut
    };
    let span = |unit: &crate::texture::unit::PlannedUnit, axis: usize, side: u32| {
        let set = unit.state.coordinate_set;
        let (low, high) = range(vertices.map(|v| f64::from(v.texture_coordinates[set][axis])));
        (high - low) * 256.0 * f64::from(side)
    };
    let spans = draw.units.iter().flat_map(|unit| [span(unit, 0, unit.width), span(unit, 1, unit.height)]);
    // G is a floor too: 2^-27 of a step at most.
    spans.map(|span| 2.0 * relative * span + 2.0_f64.powi(-26)).fold(0.0, f64::max)
}
