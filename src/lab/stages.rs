//! Helpers to build scenes in code: stages, combiners and plans.

use ninebit::diagnostic::Source;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;
use ninebit_scene::SceneError;

/// Compiles a scene. Errors are reported like those of a scene file.
pub(crate) fn planned(scene: &Scene) -> Result<Plan, Box<SceneError>> {
    Plan::compile(scene, &PlanOptions::default()).map_err(|errors| {
        let diagnostics = errors.iter().map(|error| error.diagnostic(None)).collect();
        let source = Source { name: "a scene built in code".to_owned(), text: String::new() };
        Box::new(SceneError { diagnostics, suppressed: 0, source })
    })
}

/// Makes the frame of a scene `side` pixels wide and high.
pub(crate) fn resize(scene: &mut Scene, side: usize) {
    for target in &mut scene.targets {
        (target.width, target.height) = (side as u32, side as u32);
    }
    for draw in &mut scene.draws {
        if let Positions::Clip(viewport) = &mut draw.positions {
            (viewport.width, viewport.height) = (side as f32, side as f32);
        }
    }
}

/// Returns an input: the colour of a register through a mapping.
pub(crate) fn mapped(mapping: InputMapping, register: Register) -> CombinerInput {
    CombinerInput { register, mapping, component: Component::Rgb }
}

/// Returns an input: the colour of a register, expanded to a signed vector.
pub(crate) fn expanded(register: Register) -> CombinerInput {
    mapped(InputMapping::ExpandNormal, register)
}

/// Returns an input: the colour of a register, unmapped.
pub(crate) fn plain(register: Register) -> CombinerInput {
    mapped(InputMapping::UnsignedIdentity, register)
}

/// Returns an input that reads 1.
pub(crate) fn one() -> CombinerInput {
    mapped(InputMapping::UnsignedInvert, Register::Zero)
}

/// Returns a stage that computes SPARE0 = A B.
pub(crate) fn product(a: CombinerInput, b: CombinerInput) -> GeneralStage {
    let mut stage = GeneralStage::default();
    stage.rgb.inputs[..2].copy_from_slice(&[a, b]);
    stage.rgb.ab_output = Register::Spare0;
    stage
}

/// Returns a stage that computes SPARE0 = A . B.
pub(crate) fn dot_product(a: CombinerInput, b: CombinerInput) -> GeneralStage {
    let mut stage = product(a, b);
    stage.rgb.ab_dot_product = true;
    stage
}

/// Returns a stage that computes SPARE0 = A + C.
pub(crate) fn sum(a: CombinerInput, c: CombinerInput) -> GeneralStage {
    let mut stage = GeneralStage::default();
    stage.rgb.inputs = [a, one(), c, one()];
    stage.rgb.sum_output = Register::Spare0;
    stage
}

/// Returns combiners that show SPARE0 and have one constant colour in all stages.
pub(crate) fn program([r, g, b]: [u8; 3], stages: Vec<GeneralStage>) -> Combiners {
    let mut combiners = Combiners { stages, ..Combiners::showing(FinalRegister::Spare0) };
    combiners.final_combiner.constants[0] = [r, g, b, 255];
    combiners.stages.iter_mut().for_each(|stage| stage.constants[0] = [r, g, b, 255]);
    combiners
}
