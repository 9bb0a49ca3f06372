//! Whole general stages, which read all inputs before they write.

use super::block::{self, Sixteen};
use super::{CHANNELS, Column, Conditions, Kind, Reach, Unit, channels, named, paired, put, scale_takes_bias};
use ninebit::combiner::direct::Direct;
use ninebit::combiner::general::{self, PlannedPortion, PlannedStage, StageOf};
use ninebit::combiner::registers::Registers;
use ninebit::number::{Lane, Lanes16};
use ninebit::state::{Bias, CombinerInput, Component, InputMapping, MuxSelect, Portion, Profile, Register, Scale};
use ninebit::trace::{Observer, Recorder, Silent};

const INPUTS: [&str; 4] = ["a", "b", "c", "d"];
const FACTORS: [&str; 4] = ["mid.A", "mid.B", "mid.C", "mid.D"];
const OUTPUTS: [&str; 3] = ["out.ab", "out.cd", "out.third"];
const RGB: [&str; 3] = ["r", "g", "b"];

/// Registers of the four inputs of a portion.
const SOURCES: [Register; 4] =
    [Register::Texture0, Register::Texture1, Register::PrimaryColor, Register::SecondaryColor];

/// Returns a stage of which every output is needed.
fn stage(rgb: Portion, alpha: Portion) -> PlannedStage {
    let (rgb, alpha) = (PlannedPortion::whole(rgb, 7), PlannedPortion::whole(alpha, 8));
    PlannedStage { index: 0, rgb, alpha, constants: [[0; 4]; 2], reads_constants: false }
}

/// Returns a portion that reads the four registers.
fn portion(component: Component, mappings: &[i64]) -> Portion {
    let mut portion = Portion::idle(component);
    for ((input, register), mapping) in portion.inputs.iter_mut().zip(SOURCES).zip(mappings) {
        *input = CombinerInput { register, component, mapping: named(*mapping) };
    }
    portion
}

/// Returns the columns of configuration that the RGB and the alpha portion share.
fn configuration() -> Vec<Column> {
    let mut columns = INPUTS.map(|name| Column::choice::<InputMapping>(&format!("cfg.mapping_{name}"))).to_vec();
    columns.extend([Column::choice::<Scale>("cfg.scale"), Column::choice::<Bias>("cfg.bias"), Column::flag("cfg.mux")]);
    columns.push(Column::choice::<MuxSelect>("cfg.mux_select"));
    columns
}

/// An RGB portion with three outputs.
pub(super) struct GeneralStage;

/// Returns the registers of a row.
fn general_file<L: Lane>(at: impl Fn(usize) -> L) -> Registers<L> {
    let mut file = Registers::new();
    for (n, register) in SOURCES.into_iter().enumerate() {
        let first = 10 + 3 * n;
        file.load(register, [at(first), at(first + 1), at(first + 2), L::ZERO]);
    }
    file.write(Register::Spare0, 3, at(22));
    file
}

/// The values that a stage computes for tables and sweeps.
type Computed<L> = StageOf<Direct<'static, L, Silent>>;

/// Runs a stage on registers.
#[inline(always)]
fn computed<L: Lane>(stage: &PlannedStage, mux: i64, file: &Registers<L>, conditions: &Conditions) -> Computed<L> {
    general::evaluate(stage, named(mux), file, &mut Direct::new(&conditions.policies, &mut Silent))
}

/// Returns a factor in halves, as tables write it.
fn halves(factor: <i32 as Lane>::Mapped) -> i64 {
    <i32 as Lane>::observe_factor(factor).0
}

/// Returns the stage of a row.
fn general_stage(inputs: &[i64]) -> PlannedStage {
    let mut rgb = portion(Component::Rgb, &inputs[..4]);
    (rgb.scale, rgb.bias, rgb.mux) = (named(inputs[4]), named(inputs[5]), inputs[6] != 0);
    (rgb.ab_dot_product, rgb.cd_dot_product) = (inputs[8] != 0, inputs[9] != 0);
    [rgb.ab_output, rgb.cd_output, rgb.sum_output] = [Register::Spare0, Register::Spare1, Register::Texture2];
    stage(rgb, Portion::idle(Component::Alpha))
}

impl Unit for GeneralStage {
    known_as!(
        "general-stage",
        &["CMB-1", "CMB-2", "CMB-3", "CMB-4", "CMB-5", "CMB-6", "CMB-7", "CMB-8", "CMB-9", "CMB-10", "NUM-2", "NUM-3"],
        "an RGB portion of texture0, texture1, primary and secondary: AB to spare0, CD to spare1, AB + CD or the mux to texture2";
        shows 10.. => 13..;
        takes [
            configuration(),
            ["cfg.ab_dot", "cfg.cd_dot"].map(Column::flag),
            INPUTS.map(|name| channels(&format!("in.{name}"), RGB, Column::register)).concat(),
            Column::register("in.spare0.a"),
        ];
        gives [
            FACTORS.map(|name| channels(name, RGB, |name| Column::result(name, Kind::Halves(11)))).concat(),
            Column::result("mid.takes_cd", Kind::Unsigned(1)),
            OUTPUTS.map(|name| channels(name, RGB, |name| Column::result(name, Kind::Signed(9)))).concat(),
        ]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        scale_takes_bias(inputs[4], inputs[5])
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let values = computed(&general_stage(inputs), inputs[7], &general_file(|n| inputs[n] as i32), conditions);
        put(results, values.rgb.factors.as_flattened().iter().map(|factor| halves(*factor)));
        results[12] = values.takes_cd.into();
        put(&mut results[13..], values.rgb.outputs.as_flattened().iter().copied());
    }

    fn trace(&self, inputs: &[i64], conditions: &Conditions, recorder: &mut Recorder) {
        let mut file = general_file(|n| paired(inputs[n]));
        general::run(&general_stage(inputs), named(inputs[7]), &conditions.policies, &mut file, recorder);
    }

    fn block(&self, inputs: &[i64], varying: usize, conditions: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
        let stage = general_stage(inputs);
        let rows = |rows: &Sixteen| -> [Lanes16<i32>; 9] {
            let values = computed(&stage, inputs[7], &general_file(|n| rows.at(n)), conditions);
            std::array::from_fn(|n| values.rgb.outputs[n / 3][n % 3])
        };
        // The last input steers the mux.
        let has = varying >= 10 && !(varying == 22 && inputs[6] != 0);
        has.then(|| block::registers(inputs, varying, out, rows))
    }
}

/// An alpha portion with three outputs.
pub(super) struct AlphaPortion;

/// Returns the registers of a row.
fn alpha_file<L: Lane>(at: impl Fn(usize) -> L) -> Registers<L> {
    let mut file = Registers::new();
    for (n, register) in SOURCES.into_iter().enumerate() {
        file.load(register, [L::ZERO, L::ZERO, at(12 + 2 * n), at(13 + 2 * n)]);
    }
    file.write(Register::Spare0, 3, at(20));
    file
}

/// Returns the stage of a row, each input with its component.
fn alpha_stage(inputs: &[i64]) -> PlannedStage {
    let mut alpha = portion(Component::Alpha, &inputs[..4]);
    for (input, component) in alpha.inputs.iter_mut().zip(&inputs[8..12]) {
        input.component = if *component == 0 { Component::Blue } else { Component::Alpha };
    }
    (alpha.scale, alpha.bias, alpha.mux) = (named(inputs[4]), named(inputs[5]), inputs[6] != 0);
    [alpha.ab_output, alpha.cd_output, alpha.sum_output] = [Register::Spare1, Register::Texture2, Register::Texture3];
    stage(Portion::idle(Component::Rgb), alpha)
}

impl Unit for AlphaPortion {
    known_as!(
        "alpha-portion",
        &["CMB-1", "CMB-2", "CMB-3", "CMB-4", "CMB-5", "CMB-6", "CMB-7", "CMB-9", "CMB-10", "NUM-2", "NUM-3"],
        "an alpha portion of the blue or alpha of four registers: AB to spare1, CD to texture2, AB + CD or the mux to texture3";
        shows 12.. => 4..;
        takes [
            configuration(),
            INPUTS.map(|name| Column::names(&format!("cfg.component_{name}"), &["Blue", "Alpha"])),
            INPUTS.map(|name| channels(&format!("in.{name}"), ["b", "a"], Column::register)).concat(),
            Column::register("in.spare0.a"),
        ];
        gives [Column::results(FACTORS, Kind::Halves(11)), Column::results(OUTPUTS, Kind::Signed(9))]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        scale_takes_bias(inputs[4], inputs[5])
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let values = computed(&alpha_stage(inputs), inputs[7], &alpha_file(|n| inputs[n] as i32), conditions);
        put(results, values.alpha.factors.map(|[factor]| halves(factor)));
        put(&mut results[4..], values.alpha.outputs.map(|[output]| output));
    }

    fn trace(&self, inputs: &[i64], conditions: &Conditions, recorder: &mut Recorder) {
        let mut file = alpha_file(|n| paired(inputs[n]));
        general::run(&alpha_stage(inputs), named(inputs[7]), &conditions.policies, &mut file, recorder);
    }

    fn block(&self, inputs: &[i64], varying: usize, conditions: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
        let stage = alpha_stage(inputs);
        let rows = |rows: &Sixteen| {
            computed(&stage, inputs[7], &alpha_file(|n| rows.at(n)), conditions).alpha.outputs.map(|[output]| output)
        };
        let has = varying >= 12 && !(varying == 20 && inputs[6] != 0);
        has.then(|| block::registers(inputs, varying, out, rows))
    }
}

/// Blue of a dot product, written to the alpha of its destination.
pub(super) struct BlueToAlpha;

/// Returns blue of AB and CD, and then alpha of SPARE0 and SPARE1.
fn blue_to_alpha<L: Lane>(
    inputs: &[i64],
    at: impl Fn(usize) -> L,
    conditions: &Conditions,
    observer: &mut impl Observer,
) -> [L; 4] {
    let mut rgb = portion(Component::Rgb, &[InputMapping::SignedIdentity as i64; 4]);
    (rgb.ab_output, rgb.cd_output, rgb.ab_dot_product) = (Register::Spare0, Register::Spare1, inputs[0] != 0);
    (rgb.ab_blue_to_alpha, rgb.cd_blue_to_alpha) = (inputs[1] != 0, inputs[2] != 0);
    let mut file = Registers::new();
    file.load(SOURCES[0], [at(3), at(4), at(5), L::ZERO]);
    file.load(SOURCES[1], [at(6), at(7), at(8), L::ZERO]);
    file.load(SOURCES[2], [L::ZERO, L::ZERO, at(9), L::ZERO]);
    file.load(SOURCES[3], [L::ZERO, L::ZERO, at(10), L::ZERO]);
    file.write(Register::Spare0, 3, at(11));
    file.write(Register::Spare1, 3, at(12));
    let stage = stage(rgb, Portion::idle(Component::Alpha));
    general::run(&stage, MuxSelect::Msb, &conditions.policies, &mut file, observer);
    [(Register::Spare0, 2), (Register::Spare1, 2), (Register::Spare0, 3), (Register::Spare1, 3)]
        .map(|(register, channel)| file.read(register, channel))
}

impl Unit for BlueToAlpha {
    known_as!(
        "blue-to-alpha", &["CMB-1", "CMB-6", "CMB-8", "CMB-11", "NUM-2", "NUM-3"],
        "AB and CD of an RGB portion, whose blue also goes to the alpha of spare0 and of spare1";
        shows 3.. => 2..; on &[Profile::Nv2a];
        takes [
            ["cfg.ab_dot", "cfg.ab_to_alpha", "cfg.cd_to_alpha"].map(Column::flag),
            ["in.a.r", "in.a.g", "in.a.b", "in.b.r", "in.b.g", "in.b.b", "in.c.b", "in.d.b"].map(Column::register),
            ["in.spare0.a", "in.spare1.a"].map(Column::register),
        ];
        gives [Column::results(["mid.ab.b", "mid.cd.b", "out.spare0.a", "out.spare1.a"], Kind::Signed(9))]
    );

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        put(results, blue_to_alpha(inputs, |n| inputs[n] as i32, conditions, &mut Silent));
    }

    fn trace(&self, inputs: &[i64], conditions: &Conditions, recorder: &mut Recorder) {
        blue_to_alpha(inputs, |n| paired(inputs[n]), conditions, recorder);
    }

    fn block(&self, inputs: &[i64], varying: usize, conditions: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
        let rows = |rows: &Sixteen| {
            let [_, _, spare0, spare1] = blue_to_alpha(inputs, |n| rows.at(n), conditions, &mut Silent);
            [spare0, spare1]
        };
        (varying >= 3).then(|| block::registers(inputs, varying, out, rows))
    }
}

/// A register value that one stage passes to the next.
pub(super) struct TwoStages;

/// Returns the stages of a row.
fn two_stages(inputs: &[i64]) -> [PlannedStage; 2] {
    let signed = [InputMapping::SignedIdentity as i64; 4];
    let mut first = portion(Component::Rgb, &signed);
    (first.scale, first.bias, first.sum_output) = (named(inputs[0]), named(inputs[1]), Register::Spare0);
    let mut second = portion(Component::Rgb, &signed);
    let spare0 = CombinerInput { register: Register::Spare0, component: Component::Rgb, mapping: named(inputs[2]) };
    second.inputs[0] = spare0;
    second.inputs[1].mapping = named(inputs[3]);
    second.sum_output = Register::Spare0;
    let alpha = Portion::idle(Component::Alpha);
    [stage(first, alpha), PlannedStage { index: 1, ..stage(second, alpha) }]
}

/// Returns the registers of a row.
fn two_stages_file<L: Lane>(at: impl Fn(usize) -> L) -> Registers<L> {
    let mut file = Registers::new();
    for (n, register) in SOURCES.into_iter().enumerate() {
        file.load(register, [at(4 + n); 4]);
    }
    file
}

/// Returns the values that each stage computes.
fn two_computed<L: Lane>(
    [first, second]: &[PlannedStage; 2],
    mut file: Registers<L>,
    conditions: &Conditions,
) -> [Computed<L>; 2] {
    let before = computed(first, 0, &file, conditions);
    general::write(first, &before, &mut file, &mut Direct::plain(&mut Silent));
    [before, computed(second, 0, &file, conditions)]
}

impl Unit for TwoStages {
    known_as!(
        "two-stages", &["CMB-1", "CMB-2", "CMB-3", "CMB-4", "CMB-5", "CMB-7", "CMB-9", "NUM-2", "NUM-3"],
        "AB + CD of four registers to spare0, then spare0 and the four again: what the first stage wrote is read through any mapping";
        shows 4.. => 2..;
        takes [
            Column::choice::<Scale>("cfg.scale"),
            Column::choice::<Bias>("cfg.bias"),
            ["cfg.mapping_spare0", "cfg.mapping_b"].map(Column::choice::<InputMapping>),
            ["in.a", "in.b", "in.c", "in.d"].map(Column::register),
        ];
        gives [
            Column::result("mid.spare0", Kind::Signed(9)),
            Column::result("mid.spare0_mapped", Kind::Halves(11)),
            Column::result("out.spare0", Kind::Signed(9)),
        ]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        scale_takes_bias(inputs[0], inputs[1])
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let file = two_stages_file(|n| inputs[n] as i32);
        let [before, after] = two_computed(&two_stages(inputs), file, conditions).map(|values| values.rgb);
        let (between, out) = (before.outputs[2][0], after.outputs[2][0]);
        results.copy_from_slice(&[between.into(), halves(after.factors[0][0]), out.into()]);
    }

    fn trace(&self, inputs: &[i64], conditions: &Conditions, recorder: &mut Recorder) {
        let mut file = two_stages_file(|n| paired(inputs[n]));
        for stage in two_stages(inputs) {
            general::run(&stage, MuxSelect::Msb, &conditions.policies, &mut file, recorder);
        }
    }

    fn block(&self, inputs: &[i64], varying: usize, conditions: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
        let stages = two_stages(inputs);
        let rows = |rows: &Sixteen| {
            let [_, after] = two_computed(&stages, two_stages_file(|n| rows.at(n)), conditions);
            [after.rgb.outputs[2][0]]
        };
        (varying >= 4).then(|| block::registers(inputs, varying, out, rows))
    }
}

/// A stage whose portions write registers that they also read.
pub(super) struct BothPortions;

const SPARES: [Register; 2] = [Register::Spare0, Register::Spare1];

/// Returns SPARE0 and SPARE1 after the stage of a row. `at` gives the inputs as numbers of the lane.
fn both_portions<L: Lane>(
    inputs: &[i64],
    at: impl Fn(usize) -> L,
    conditions: &Conditions,
    observer: &mut impl Observer,
) -> [[L; 4]; 2] {
    let register = |n: usize| SPARES[inputs[n] as usize & 1];
    let copy = |register, component| {
        let input = |register, mapping| CombinerInput { register, component, mapping };
        [input(register, InputMapping::SignedIdentity), input(Register::Zero, InputMapping::UnsignedInvert)]
    };
    let (mut rgb, mut alpha) = (Portion::idle(Component::Rgb), Portion::idle(Component::Alpha));
    rgb.inputs[..2].copy_from_slice(&copy(register(0), Component::Rgb));
    rgb.inputs[2..].copy_from_slice(&copy(register(1), Component::Rgb));
    (rgb.ab_output, rgb.cd_output) = (register(2), register(3));
    let component = if inputs[5] == 0 { Component::Blue } else { Component::Alpha };
    alpha.inputs[..2].copy_from_slice(&copy(register(4), component));
    alpha.ab_output = register(6);
    let mut file = Registers::new();
    for (spare, first) in SPARES.into_iter().zip([7, 11]) {
        file.load(spare, [at(first), at(first + 1), at(first + 2), at(first + 3)]);
    }
    general::run(&stage(rgb, alpha), MuxSelect::Msb, &conditions.policies, &mut file, observer);
    SPARES.map(|spare| [0, 1, 2, 3].map(|channel| file.read(spare, channel)))
}

impl Unit for BothPortions {
    known_as!(
        "both-portions", &["CMB-1", "CMB-6", "NUM-2", "NUM-3"],
        "spare0 and spare1 after a stage: its RGB portion copies one by AB and one by CD, its alpha portion copies the blue or alpha of one";
        shows 7.. => ..;
        takes [
            ["cfg.ab", "cfg.cd", "cfg.ab_output", "cfg.cd_output", "cfg.alpha"]
                .map(|name| Column::names(name, &["Spare0", "Spare1"])),
            Column::names("cfg.alpha_component", &["Blue", "Alpha"]),
            Column::names("cfg.alpha_output", &["Spare0", "Spare1"]),
            channels("in.spare0", CHANNELS, Column::register),
            channels("in.spare1", CHANNELS, Column::register),
        ];
        gives [["out.spare0", "out.spare1"].map(|spare| channels(spare, CHANNELS, |name| Column::result(name, Kind::Signed(9)))).concat()]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        inputs[2] != inputs[3]
    }

    fn fit(&self, inputs: &mut [i64]) {
        inputs[3] = 1 - inputs[2];
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let spares = both_portions(inputs, |n| inputs[n] as i32, conditions, &mut Silent);
        put(results, spares.into_iter().flatten());
    }

    fn trace(&self, inputs: &[i64], conditions: &Conditions, recorder: &mut Recorder) {
        both_portions(inputs, |n| paired(inputs[n]), conditions, recorder);
    }
}
