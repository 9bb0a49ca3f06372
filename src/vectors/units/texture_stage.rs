//! One Direct3D texture stage.

use super::program::{self, RULES, Through, lowered_by};
use super::texture_environment::some;
use super::{Column, Conditions, Reach, Unit, bytes, colors, named, paired, put};
use ninebit::state::{Combiners, Named, Profile, Register};
use ninebit::trace::{Recorder, Silent};
use ninebit_program::Spanned;
use ninebit_program::texture_stages::{
    ArgumentSource, Context, Half, Operation, StageArgument, TextureStage, TextureStages, lower,
};

/// An operation of Direct3D with the arguments Texture and Current.
pub(super) struct Stage;

/// Returns whether an operation combines colours. Disable ends the cascade, and the two bump operations move coordinates (`bump-offset`,
/// `bump-luminance`).
fn combines(operation: Operation) -> bool {
    operation != Operation::Disable && !operation.is_bump()
}

fn half(operation: Operation, arguments: [StageArgument; 3]) -> Half {
    Half { operation: Spanned::default_of(operation), arguments: arguments.map(Spanned::default_of) }
}

fn copy(source: ArgumentSource) -> TextureStage {
    let argument = StageArgument::new(source);
    let select = || half(Operation::SelectArg1, [argument; 3]);
    TextureStage { color: select(), alpha: select(), ..TextureStage::initial(0) }
}

/// Number of columns of configuration.
const CONFIGURATION: usize = 5;

/// Index of the first column of the texture factor.
const FACTOR: usize = CONFIGURATION + 12;

fn operation(inputs: &[i64]) -> Operation {
    named(inputs[0])
}

/// Returns the lowered stage of a row, or `None` if the chip cannot run it.
fn lowered(inputs: &[i64], profile: Profile) -> Option<Combiners> {
    let operation = operation(inputs);
    let argument =
        |source, flags: &[i64]| StageArgument { source, complement: flags[0] != 0, alpha_replicate: flags[1] != 0 };
    let arguments = [
        StageArgument::new(ArgumentSource::TextureFactor),
        argument(ArgumentSource::Texture, &inputs[1..3]),
        argument(ArgumentSource::Current, &inputs[3..5]),
    ];
    let alpha = if operation.is_color_only() { Operation::SelectArg2 } else { operation };
    let tested =
        TextureStage { color: half(operation, arguments), alpha: half(alpha, arguments), ..TextureStage::initial(1) };
    let stages = match operation {
        Operation::PreModulate => vec![tested, copy(ArgumentSource::Current)],
        _ => vec![copy(ArgumentSource::Texture), tested],
    };
    let stages = TextureStages { stages, texture_factor: bytes(&inputs[FACTOR..]), specular_enable: false };
    let bound = [true, true, false, false];
    let context = Context { profile, bound, signed: [false; 4], fog: false };
    lower(&stages, &context).map(|lowered| lowered.combiners).ok()
}

/// Returns the registers of a pixel.
fn places(inputs: &[i64]) -> [(Register, usize); 3] {
    let (own, other) = match operation(inputs) {
        Operation::PreModulate => (Register::Texture0, Register::Texture1),
        _ => (Register::Texture1, Register::Texture0),
    };
    [(own, CONFIGURATION), (other, CONFIGURATION + 4), (Register::PrimaryColor, CONFIGURATION + 8)]
}

impl Unit for Stage {
    known_as!(
        "texture-stage", RULES,
        "a Direct3D texture stage: ColorOp and, where alpha can be it, AlphaOp of Arg1 Texture, Arg2 Current, Arg0 TextureFactor; PreModulate takes `other` as the next stage's texture, all others as Current", Direct;
        takes [
            some("cfg.operation", combines),
            ["cfg.complement1", "cfg.alpha_replicate1", "cfg.complement2", "cfg.alpha_replicate2"].map(Column::flag),
            colors(&["texture", "other", "diffuse", "factor"]),
        ];
        gives [program::results()]
    );

    lowered_by!(lowered, places, |_, varying| Through::of_column(varying, CONFIGURATION, FACTOR));

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        // Inputs that are not read do not vary.
        let operation: Operation = named(inputs[0]);
        let [_, first, second] = operation.reads();
        (first || inputs[1..3] == [0; 2]) && (second || operation.is_color_only() || inputs[3..5] == [0; 2])
    }

    fn fit(&self, inputs: &mut [i64]) {
        let operation: Operation = named(inputs[0]);
        let [_, first, second] = operation.reads();
        if !first {
            inputs[1..3].fill(0);
        }
        if !second && !operation.is_color_only() {
            inputs[3..5].fill(0);
        }
    }

    fn regressions(&self) -> Vec<Vec<i64>> {
        // Each operation once on middle greys and their neighbours, where halves and biases show.
        let colors = [127, 128, 129, 64, 128, 127, 255, 200, 90, 60, 30, 128, 255, 127, 1, 100];
        let rows = (0..).zip(Operation::ALL).filter(|(_, operation)| combines(**operation));
        rows.map(|(n, _)| [vec![n, 0, 0, 0, 0], colors.to_vec()].concat()).collect()
    }
}
