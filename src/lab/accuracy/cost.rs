//! Cost of a technique on the modelled chip: operation counts, not cycles.

use ninebit::plan::Plan;
use ninebit::state::Scene;
use ninebit::trace::Work;
use ninebit_report::explain::{Cost, explain};

/// Cost of a frame, before and after pruning.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HardwareCost {
    /// Cost of everything that the program asks for, which is what a chip does.
    pub asked: FrameCost,
    /// Cost without what cannot affect the picture: what the plan keeps and the model draws.
    pub pruned: FrameCost,
}

/// Operation counts of one frame. Savings by tests or by the level of detail are not taken into account.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameCost {
    /// Number of draws.
    pub passes: u64,
    /// Largest number of general stages of a pass.
    pub most_stages: u64,
    /// Largest number of texture units that a pass reads.
    pub most_units: u64,
    /// Number of vertices of all passes.
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
    /// Computes the cost of a frame. `pixels` is its number of final pixels, at least 1.
    pub(super) fn from_scene(scene: &Scene, plan: &Plan, pixels: u64) -> HardwareCost {
        let explained = explain(scene, plan);
        let vertices = || scene.draws.iter().map(|draw| draw.vertices.len() as u64);
        let asked: Vec<(&Cost, u64)> = explained.iter().map(|draw| &draw.asked).zip(vertices()).collect();
        let pruned: Vec<(&Cost, u64)> = explained.iter().map(|draw| &draw.cost).zip(vertices()).collect();
        HardwareCost { asked: FrameCost::from_draws(&asked, pixels), pruned: FrameCost::from_draws(&pruned, pixels) }
    }
}

impl FrameCost {
    /// Adds up the costs of draws, each with its number of vertices.
    fn from_draws(draws: &[(&Cost, u64)], pixels: u64) -> FrameCost {
        let seen = || draws.iter().filter(|(cost, _)| cost.seen);
        let per_pixel =
            |of: &dyn Fn(&Cost) -> u64| seen().map(|(cost, _)| of(cost)).sum::<u64>() as f64 / pixels as f64;
        let work = |kinds: &[Work]| {
            per_pixel(&|cost| {
                let total = cost.total();
                kinds.iter().map(|kind| total[*kind as usize]).sum()
            })
        };
        FrameCost {
            passes: seen().count() as u64,
            most_stages: seen().map(|(cost, _)| cost.stages).max().unwrap_or(0),
            most_units: seen().map(|(cost, _)| cost.units).max().unwrap_or(0),
            vertices: seen().map(|(_, vertices)| vertices).sum(),
            fragments: per_pixel(&|cost| cost.fragments),
            fetches: per_pixel(&|cost| cost.fragments * cost.units),
            texels: work(&[Work::Texels]),
            stages: per_pixel(&|cost| cost.fragments * cost.stages),
            products: work(&[Work::Products]),
            blends: per_pixel(&|cost| cost.fragments * u64::from(cost.blended)),
            frame_buffer_bytes: work(&[Work::BytesRead, Work::BytesWritten]),
        }
    }

    /// Returns the counts per final pixel, by name.
    pub(crate) fn per_pixel(&self) -> [(&'static str, f64); 7] {
        [
            ("fragments", self.fragments),
            ("texture fetches", self.fetches),
            ("texels", self.texels),
            ("general stages", self.stages),
            ("products", self.products),
            ("blends", self.blends),
            ("frame buffer bytes", self.frame_buffer_bytes),
        ]
    }

    /// Returns the counts of the whole frame, by name.
    pub(crate) fn counts(&self) -> [(&'static str, u64); 4] {
        [
            ("passes", self.passes),
            ("most stages", self.most_stages),
            ("most units", self.most_units),
            ("vertices", self.vertices),
        ]
    }
}
