//! A surface with more and more state: state that is not used costs nothing.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::timing::{Effort, Spread, frames};
use crate::stages::*;
use ninebit::engine::{Engine, RenderOptions, count};
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::state::*;
use ninebit::trace::Work;
use ninebit_scene::{SceneError, parse};

/// The scene without the parts that vary.
const SCENE: &str = include_str!("surface.ron");

/// State of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Surface {
    /// Number of general stages, 0 to 2.
    pub stages: usize,
    /// Number of texture units, 0 to 2.
    pub units: usize,
    /// Whether units filter four texels.
    pub filtered: bool,
    /// Whether alpha is computed and written.
    pub alpha: bool,
    /// Whether the colour is added to that of the frame buffer.
    pub blend: bool,
    /// Whether the colour is blended with the fog's.
    pub fog: bool,
    /// Whether there is state without effect: a stage and a unit whose results are not read.
    pub unused: bool,
}

/// Cost of a surface per pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceCost {
    /// Description of its state.
    pub name: String,
    /// Number of texels read.
    pub texels: f64,
    /// Number of interpolations, products, roundings and blended channels.
    pub operations: f64,
    /// Bytes of the frame buffer that are read and written.
    pub bytes: f64,
    /// Time of the fast engine in nanoseconds.
    pub fast: Spread,
    /// Time of the scalar engine in nanoseconds.
    pub scalar: Spread,
}

/// Returns the surfaces with their descriptions, in the order of the table.
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

/// Parses a scene file of this folder.
///
/// # Errors
/// Returns an error if the scene is not valid, which is a fault of the file.
pub(super) fn read(text: &str) -> Result<Scene, Box<SceneError>> {
    Ok(parse(text, Path::new("chart.ron"), &Limits::default())?.scene)
}

impl Surface {
    /// Compiles the scene of this surface, `side` pixels wide and high.
    ///
    /// # Errors
    /// Returns an error if the scene is not valid, which is a fault of the file.
    pub fn plan(&self, side: usize) -> Result<Plan, Box<SceneError>> {
        let mut scene = read(SCENE)?;
        resize(&mut scene, side);
        let draw = &mut scene.draws[0];
        let filter = if self.filtered { Filter::Linear } else { Filter::Nearest };
        for index in 0..if self.unused { 2 } else { self.units } {
            let unit = TextureUnit::new(index);
            draw.textures[index] = Some(TextureUnit { min_filter: filter, mag_filter: filter, ..unit });
            draw.texture_shader[index] = ShaderStage::conventional(index, true);
        }
        let first = if self.units > 0 { Register::Texture0 } else { Register::SecondaryColor };
        let second = if self.units > 1 { Register::Texture1 } else { Register::PrimaryColor };
        let stage = |rgb: GeneralStage, a: Register, b: Register| {
            let mut stage = rgb;
            if self.alpha {
                for (input, register) in stage.alpha.inputs.iter_mut().zip([a, b]) {
                    input.register = register;
                }
                stage.alpha.ab_output = Register::Spare0;
            }
            stage
        };
        let dot = |b: Register| stage(dot_product(expanded(first), expanded(b)), first, b);
        draw.combiners.stages = match self.stages {
            0 => vec![GeneralStage::default()],
            1 => vec![dot(second)],
            _ => vec![
                dot(Register::PrimaryColor),
                stage(product(plain(Register::Spare0), plain(second)), Register::Spare0, second),
            ],
        };
        if self.unused {
            let mut unread = product(plain(Register::Texture1), plain(Register::Texture1));
            unread.rgb.ab_output = Register::Spare1;
            draw.combiners.stages.push(unread);
        }
        let shown = match (self.stages, self.units) {
            (0, 0) => FinalRegister::PrimaryColor,
            (0, _) => FinalRegister::Texture0,
            _ => FinalRegister::Spare0,
        };
        let mut mix = FinalCombiner::default();
        if self.fog {
            draw.fog = Fog { enabled: true, color: [90, 100, 110], function: None };
            mix.inputs[0] = FinalInput::zero(Component::Alpha);
            (mix.inputs[0].register, mix.inputs[1].register) = (FinalRegister::Fog, shown);
            mix.inputs[2].register = FinalRegister::Fog;
        } else {
            mix.inputs[3].register = shown;
        }
        draw.combiners.final_combiner = mix;
        let (source, destination) = (BlendFactor::One, BlendFactor::One);
        draw.blend = self.blend.then_some(Blend { equation: BlendEquation::Add, source, destination });
        planned(&scene)
    }

    /// Measures the cost.
    ///
    /// # Errors
    /// The same as [`plan`](Self::plan).
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
        // Results that nothing reads are not computed.
        let unused = of("1 stage, 1 unit, and one of each that nothing reads");
        assert_eq!((unused.texels, unused.operations, unused.bytes), (lit.texels, lit.operations, lit.bytes));
    }
}
