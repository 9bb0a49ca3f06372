//! Growth of a frame's cost: it is proportional to what is drawn and does not depend on what nothing sees.

use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use super::picture::{Axis, COLORS, Drawing, SHAPES, Series};
use super::surfaces::read;
use super::timing::{Effort, frames};
use crate::stages::*;
use ninebit::engine::{RenderOptions, Renderer};
use ninebit::plan::Plan;
use ninebit::state::{self, GeneralStage, Register};
use ninebit_scene::SceneError;

/// The scene without the parts that vary. It has a draw for each grid, the smallest first.
const SCENE: &str = include_str!("curve.ron");

/// Parameters of a scene whose cost is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scene {
    /// Width and height of the frame in pixels.
    pub side: usize,
    /// Index of the grid, which is that of its draw in the scene's file.
    pub grid: usize,
    /// Number of identical draws.
    pub draws: usize,
    /// Number of general stages, 1 to 8: dot products and, every fourth, a mux.
    pub stages: usize,
    /// Number of further stages whose results nothing reads; at most 8 together with the others.
    pub unseen: usize,
}

const PLAIN: Scene = Scene { side: 256, grid: 0, draws: 1, stages: 1, unseen: 0 };

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// The counted quantity.
    pub count: u64,
    /// Number of shaded pixels, counted once for each draw.
    pub pixels: u64,
    /// Time of a frame: the lower quartile.
    pub microseconds: f64,
}

/// A curve of a chart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Name of the counted quantity.
    pub counted: String,
    /// Its label in the chart.
    pub label: String,
    /// The points, sorted by count.
    pub points: Vec<Point>,
}

/// Returns every curve, still without points, and the scenes of its points. With `quick` it has only the first two of each.
pub fn scenes(quick: bool) -> Vec<(Curve, Vec<Scene>)> {
    let most = if quick { 2 } else { usize::MAX };
    let curve = |counted: &str, label: &str, scenes: Vec<Scene>| {
        let [counted, label] = [counted, label].map(str::to_owned);
        (Curve { counted, label, points: Vec::new() }, scenes.into_iter().take(most).collect())
    };
    let sizes = |all: &[usize], of: fn(usize) -> Scene| all.iter().map(|n| of(*n)).collect::<Vec<_>>();
    let pixels = sizes(&[32, 64, 128, 256, 512, 1024, 2048], |side| Scene { side, ..PLAIN });
    let draws = sizes(&[1, 4, 16, 64, 256, 1024], |draws| Scene { draws, side: 64, ..PLAIN });
    let triangles = sizes(&[1, 2, 3, 4, 5], |grid| Scene { grid, side: 1024, ..PLAIN });
    let stages = [1, 2, 3, 4, 5, 6, 7, 8];
    let seen = sizes(&stages, |stages| Scene { stages, ..PLAIN });
    let unseen = sizes(&stages, |stages| Scene { unseen: stages - 1, ..PLAIN });
    vec![
        curve("pixels", "pixels of a larger frame", pixels),
        curve("draws", "draws of 64 x 64 pixels", draws),
        curve("triangles", "triangles in the same 1024 x 1024", triangles),
        curve("stages", "combiner stages", seen),
        curve("stages", "stages, only the first of them seen", unseen),
    ]
}

/// Returns the scene of the file, which is parsed once.
fn base() -> Result<&'static state::Scene, Box<SceneError>> {
    static BASE: OnceLock<state::Scene> = OnceLock::new();
    if let Some(scene) = BASE.get() {
        return Ok(scene);
    }
    let scene = read(SCENE)?;
    Ok(BASE.get_or_init(|| scene))
}

/// Returns a stage with a dot product of the previous stage's result.
fn continued() -> GeneralStage {
    dot_product(expanded(Register::Spare0), expanded(Register::PrimaryColor))
}

/// Returns a stage with a mux of two products.
fn choice() -> GeneralStage {
    let mut stage = GeneralStage::default();
    stage.rgb.inputs =
        [Register::Spare0, Register::PrimaryColor, Register::Texture0, Register::PrimaryColor].map(plain);
    (stage.rgb.sum_output, stage.rgb.mux) = (Register::Spare0, true);
    stage
}

impl Scene {
    /// Compiles the scene to a plan.
    ///
    /// # Errors
    /// Returns an error if the scene is not valid, which is a fault of the file.
    fn plan(&self) -> Result<Plan, Box<SceneError>> {
        let mut scene = base()?.clone();
        let mut draw = scene.draws.swap_remove(self.grid);
        let (texture, color) = (Register::Texture0, Register::PrimaryColor);
        let mut first = dot_product(expanded(texture), expanded(color));
        first.alpha.inputs[0].register = texture;
        first.alpha.inputs[1].register = color;
        first.alpha.ab_output = Register::Spare0;
        let seen = (1..self.stages).map(|n| if n % 4 == 3 { choice() } else { continued() });
        let mut unseen = product(plain(texture), plain(color));
        unseen.rgb.ab_output = Register::Spare1;
        draw.combiners.stages =
            std::iter::once(first).chain(seen).chain(std::iter::repeat_n(unseen, self.unseen)).collect();
        scene.draws = vec![draw; self.draws];
        resize(&mut scene, self.side);
        planned(&scene)
    }

    /// Measures the scene as a point of a curve.
    ///
    /// # Errors
    /// The plan of the scene is refused.
    pub fn point(&self, counted: &str, effort: &Effort) -> Result<Point, Box<SceneError>> {
        let plan = self.plan()?;
        let options = RenderOptions { threads: 1, ..RenderOptions::default() };
        let pixels = Renderer::new(&plan, &options).render().1.shaded_pixels.iter().sum();
        let count = match counted {
            "pixels" => pixels,
            "draws" => self.draws as u64,
            "triangles" => plan.draws().iter().map(|draw| draw.assembly.triangles.len() as u64).sum(),
            _ => (self.stages + self.unseen) as u64,
        };
        Ok(Point { count, pixels, microseconds: frames(&plan, &options, 1, effort).lower / 1000.0 })
    }
}

/// Returns the chart of all curves: what a pixel costs, over what is counted.
pub(crate) fn drawing(curves: &[Curve]) -> Drawing {
    let at = |point: &Point| [point.count as f64, point.microseconds * 1000.0 / point.pixels as f64];
    let all = || curves.iter().flat_map(|curve| &curve.points).map(at);
    let series = curves.iter().enumerate().map(|(n, curve)| Series {
        label: curve.label.clone(),
        color: COLORS[n % COLORS.len()],
        shape: Some(SHAPES[n % SHAPES.len()]),
        points: curve.points.iter().map(at).collect(),
    });
    Drawing {
        title: "What a pixel costs as a scene grows".to_owned(),
        x: Axis::logarithmic("number of them", all().map(|[count, _]| count)),
        y: Axis::linear("ns per pixel, one thread", all().map(|[_, time]| time), true),
        series: series.collect(),
        levels: Vec::new(),
        pictures: Vec::new(),
        size: [940.0, 400.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_what_the_scenes_have() {
        for (curve, scenes) in scenes(true) {
            for (n, scene) in scenes.iter().enumerate() {
                let point = scene.point(&curve.counted, &Effort::QUICK).unwrap();
                let wanted = match curve.counted.as_str() {
                    "pixels" => point.pixels,
                    "draws" => [1, 4][n],
                    "triangles" => [2 * 4 * 4, 2 * 11 * 11][n],
                    _ => n as u64 + 1,
                };
                assert_eq!(point.count, wanted, "{}", curve.counted);
                assert!(point.pixels > 0 && point.microseconds > 0.0, "{}", curve.counted);
            }
        }
    }

    /// Checks that the plan drops stages that nothing reads, and only those.
    #[test]
    fn only_seen_stages_are_planned() {
        let planned = |scene: Scene| scene.plan().unwrap().draws()[0].stages.len();
        assert_eq!(planned(Scene { stages: 8, ..PLAIN }), 8);
        assert_eq!(planned(Scene { unseen: 7, ..PLAIN }), 1);
    }
}
