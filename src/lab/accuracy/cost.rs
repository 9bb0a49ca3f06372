//! What a technique costs the modelled chip: counts, no cycles.

use ninebit::plan::Plan;
use ninebit::state::Scene;
use ninebit::trace::Work;
use ninebit_report::explain::{Cost, explain};

/// What a frame costs, counted twice.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HardwareCost {
    /// As the program asks for it: what a chip pays, which runs what it is told.
    pub asked: FrameCost,
    /// Without what nothing can see: what the plan keeps, and what is drawn here.
    pub pruned: FrameCost,
}

/// Counts of one frame. What tests or the lod may save is counted as if they saved nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameCost {
    /// Draws of the frame.
    pub passes: u64,
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
    pub(super) fn from_scene(scene: &Scene, plan: &Plan, pixels: u64) -> HardwareCost {
        let explained = explain(scene, plan);
        let vertices = || scene.draws.iter().map(|draw| draw.vertices.len() as u64);
        let asked: Vec<(&Cost, u64)> = explained.iter().map(|draw| &draw.asked).zip(vertices()).collect();
        let pruned: Vec<(&Cost, u64)> = explained.iter().map(|draw| &draw.cost).zip(vertices()).collect();
        HardwareCost { asked: FrameCost::from_draws(&asked, pixels), pruned: FrameCost::from_draws(&pruned, pixels) }
    }
}

impl FrameCost {
    /// Of draws, each with its vertices.
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

    /// Amounts for each final pixel, by name.
    pub fn per_pixel(&self) -> [(&'static str, f64); 7] {
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

    /// Counts of the whole frame, by name.
    pub fn counts(&self) -> [(&'static str, u64); 4] {
        [
            ("passes", self.passes),
            ("most stages", self.most_stages),
            ("most units", self.most_units),
            ("vertices", self.vertices),
        ]
    }
}
