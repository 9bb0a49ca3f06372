//! The same surface with more and more state: what is not asked for costs nothing.

use std::path::Path;

use serde::Serialize;

use super::timing::{Effort, Spread, frames};
use ninebit::engine::{Engine, RenderOptions, count};
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::trace::Work;
use ninebit_scene::{SceneError, parse};

/// The scene, with places for what varies.
const TEMPLATE: &str = include_str!("surface.ron");

/// What a surface has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Surface {
    /// General stages, 0 to 2.
    pub stages: usize,
    /// Texture units, 0 to 2.
    pub units: usize,
    /// Units read four texels.
    pub filtered: bool,
    /// Alpha is computed and written.
    pub alpha: bool,
    /// The colour is added to what is there.
    pub blend: bool,
    /// Fog.
    pub fog: bool,
    /// State that nothing sees: a stage and a unit whose results are not read.
    pub unused: bool,
}

/// What a surface costs for each pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfaceCost {
    /// What it has, in words.
    pub name: String,
    /// Texels that are looked up.
    pub texels: f64,
    /// Steps of filters, products and roundings, and channels blended.
    pub operations: f64,
    /// Bytes of the frame buffer, read and written.
    pub bytes: f64,
    /// The fast engine, nanoseconds.
    pub fast: Spread,
    /// The definition, nanoseconds.
    pub scalar: Spread,
}

/// The surfaces in the order of the table.
pub fn surfaces() -> Vec<(&'static str, Surface)> {
    let plain = Surface::default();
    let lit = Surface { stages: 1, units: 1, filtered: true, ..plain };
    let two = Surface { stages: 2, units: 2, ..lit };
    vec![
        ("a vertex colour: no stage, no unit", plain),
        ("no stage, 1 unit, one texel", Surface { units: 1, ..plain }),
        ("no stage, 1 unit, filtered", Surface { units: 1, filtered: true, ..plain }),
        ("1 stage, no unit", Surface { stages: 1, ..plain }),
        ("1 stage, 1 unit", lit),
        ("2 stages, 1 unit", Surface { stages: 2, ..lit }),
        ("1 stage, 2 units", Surface { units: 2, ..lit }),
        ("2 stages, 2 units", two),
        ("2 stages, 2 units, alpha", Surface { alpha: true, ..two }),
        ("2 stages, 2 units, blend", Surface { blend: true, ..two }),
        ("2 stages, 2 units, fog", Surface { fog: true, ..two }),
        ("2 stages, 2 units, alpha, blend, fog", Surface { alpha: true, blend: true, fog: true, ..two }),
        ("1 stage, 1 unit, and one of each that nothing reads", Surface { unused: true, ..lit }),
    ]
}

/// The scene of a template, with what stands in its places.
///
/// # Errors
/// The scene is not accepted: a fault of the template.
pub(super) fn planned(template: &str, parts: &[(&str, &str)]) -> Result<Plan, Box<SceneError>> {
    let text = parts.iter().fold(template.to_owned(), |text, (place, with)| text.replace(&format!("<{place}>"), with));
    Ok(parse(&text, Path::new("template.ron"), &Limits::default())?.plan)
}

impl Surface {
    /// The scene of this surface, square, so many pixels wide.
    ///
    /// # Errors
    /// The scene is not accepted: a fault of the template.
    pub fn plan(&self, side: usize) -> Result<Plan, Box<SceneError>> {
        let filter = if self.filtered { "Linear" } else { "Nearest" };
        let unit = |name: &str| format!("(texture: \"{name}\", mag_filter: {filter}, min_filter: {filter}), ");
        let units = [unit("normals"), unit("colors")][..self.units.max(if self.unused { 2 } else { 0 })].concat();
        let first = if self.units > 0 { "Texture0" } else { "SecondaryColor" };
        let second = if self.units > 1 { "Texture1" } else { "PrimaryColor" };
        let alpha = |a: &str, b: &str| match self.alpha {
            true => format!(", alpha: (a: {a}, b: {b}, ab: Spare0)"),
            false => String::new(),
        };
        let stage = |rgb: &str, a: &str, b: &str| format!("(rgb: ({rgb}){})", alpha(a, b));
        let dot = |b: &str| format!("a: ExpandNormal({first}), b: ExpandNormal({b}), ab: Spare0, ab_dot: true");
        let mut stages = match self.stages {
            0 => "()".to_owned(),
            1 => stage(&dot(second), first, second),
            _ => {
                stage(&dot("PrimaryColor"), first, "PrimaryColor")
                    + ", "
                    + &stage(&format!("a: Spare0, b: {second}, ab: Spare0"), "Spare0", second)
            }
        };
        if self.unused {
            stages += ", (rgb: (a: Texture1, b: Texture1, ab: Spare1))";
        }
        let shown = match (self.stages, self.units) {
            (0, 0) => "PrimaryColor",
            (0, _) => "Texture0",
            _ => "Spare0",
        };
        let color = if self.fog { format!("a: (Fog, Alpha), b: {shown}, c: Fog") } else { format!("d: {shown}") };
        let alpha = if self.alpha { ", g: Spare0" } else { "" };
        let side = side.to_string();
        let parts = [
            ("SIDE", side.as_str()),
            ("UNITS", units.as_str()),
            ("STAGES", stages.as_str()),
            ("COLOR", color.as_str()),
            ("ALPHA", alpha),
            ("FOG", if self.fog { "fog: (color: (90, 100, 110))," } else { "" }),
            ("BLEND", if self.blend { "blend: (source: One, destination: One)," } else { "" }),
        ];
        planned(TEMPLATE, &parts)
    }

    /// What it costs.
    ///
    /// # Errors
    /// As [`plan`](Self::plan).
    pub fn cost(&self, name: &str, side: usize, effort: &Effort) -> Result<SurfaceCost, Box<SceneError>> {
        let plan = self.plan(side)?;
        let counts = count(&plan);
        let pixels = counts.iter().map(|draw| draw.fragments).sum::<u64>().max(1);
        let of = |kinds: &[Work]| {
            let sum: u64 =
                counts.iter().map(|draw| kinds.iter().map(|kind| draw.work[*kind as usize]).sum::<u64>()).sum();
            sum as f64 / pixels as f64
        };
        let time = |engine| frames(&plan, &RenderOptions { engine, ..RenderOptions::default() }, pixels, effort);
        Ok(SurfaceCost {
            name: name.to_owned(),
            texels: of(&[Work::Texels]),
            operations: of(&[Work::Lerps, Work::Products, Work::Roundings, Work::Blends]),
            bytes: of(&[Work::BytesRead, Work::BytesWritten]),
            fast: time(Engine::Fast),
            scalar: time(Engine::Scalar),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cost_follows_use() {
        let costs: Vec<SurfaceCost> =
            surfaces().iter().map(|(name, surface)| surface.cost(name, 8, &Effort::QUICK).unwrap()).collect();
        let of = |name: &str| costs.iter().find(|cost| cost.name == name).unwrap();
        let (plain, lit, two) =
            (of("a vertex colour: no stage, no unit"), of("1 stage, 1 unit"), of("2 stages, 2 units"));
        assert_eq!((plain.texels, lit.texels, two.texels), (0.0, 4.0, 8.0));
        assert_eq!(of("no stage, 1 unit, one texel").texels, 1.0);
        assert!(plain.operations < lit.operations && lit.operations < two.operations);
        assert_eq!((two.bytes, of("2 stages, 2 units, blend").bytes), (4.0, 8.0));
        for more in ["2 stages, 2 units, alpha", "2 stages, 2 units, blend", "2 stages, 2 units, fog"] {
            assert!(of(more).operations > two.operations, "{more}");
        }
        // What nothing reads is not modelled.
        let unused = of("1 stage, 1 unit, and one of each that nothing reads");
        assert_eq!((unused.texels, unused.operations, unused.bytes), (lit.texels, lit.operations, lit.bytes));
    }
}
