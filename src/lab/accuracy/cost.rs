//! What a technique costs the modelled chip: counts, no cycles.

use ninebit::engine;
use ninebit::plan::{Plan, PlannedDraw};
use ninebit::state::Scene;
use ninebit::trace::Work;
use ninebit_report::explain::explain;

/// Counts of one frame. What tests or the lod may save is counted as if they saved nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HardwareCost {
    /// Draws of which something can be seen.
    pub passes: u64,
    /// Draws that are left out because nothing of them can be seen.
    pub dropped_passes: u64,
    /// The most general stages that a pass has.
    pub most_stages: u64,
    /// The most texture units that a pass reads.
    pub most_units: u64,
    /// Vertices of all passes.
    pub vertices: u64,
    /// Per final pixel: fragments of all passes.
    pub fragments: f64,
    /// Per final pixel: texture units read.
    pub fetches: f64,
    /// Per final pixel: texels read.
    pub texels: f64,
    /// Per final pixel: general stages run.
    pub stages: f64,
    /// Per final pixel: products of combiners.
    pub products: f64,
    /// Per final pixel: fragments blended with the frame buffer.
    pub blends: f64,
    /// Per final pixel: bytes of colour read from and written to surfaces.
    pub frame_buffer_bytes: f64,
}

impl HardwareCost {
    /// Of a frame with so many final pixels, which are at least 1.
    pub(super) fn of(scene: &Scene, plan: &Plan, pixels: u64) -> HardwareCost {
        let seen = |planned: &PlannedDraw| planned.folded.invisible.is_none();
        let visible: Vec<&PlannedDraw> = plan.draws.iter().filter(|planned| seen(planned)).collect();
        let most = |of: fn(&PlannedDraw) -> usize| visible.iter().map(|planned| of(planned)).max().unwrap_or(0) as u64;
        let explained = explain(scene, plan);
        let work = |kinds: &[Work]| {
            let total: u64 = explained
                .iter()
                .map(|draw| draw.cost.total())
                .map(|n| kinds.iter().map(|k| n[*k as usize]).sum::<u64>())
                .sum();
            total as f64 / pixels as f64
        };
        let each = |of: &dyn Fn(&PlannedDraw) -> u64| {
            let total: u64 = visible.iter().map(|planned| engine::fragments(plan, planned) * of(planned)).sum();
            total as f64 / pixels as f64
        };
        HardwareCost {
            passes: visible.len() as u64,
            dropped_passes: (plan.draws.len() - visible.len()) as u64,
            most_stages: most(|planned| planned.stages.len()),
            most_units: most(|planned| planned.units.len()),
            vertices: plan
                .draws
                .iter()
                .zip(&scene.draws)
                .filter(|(p, _)| seen(p))
                .map(|(_, d)| d.vertices.len() as u64)
                .sum(),
            fragments: each(&|_| 1),
            fetches: each(&|planned| planned.units.len() as u64),
            texels: work(&[Work::Texels]),
            stages: each(&|planned| planned.stages.len() as u64),
            products: work(&[Work::Products]),
            blends: each(&|planned| u64::from(planned.blend.is_some())),
            frame_buffer_bytes: work(&[Work::BytesRead, Work::BytesWritten]),
        }
    }
}
