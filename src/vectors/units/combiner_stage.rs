//! Whole general stages: everything is read before anything is written.

use super::block::{self, Sixteen};
use super::{Column, Conditions, Kind, Reach, Unit, channels, named, put, scale_takes_bias};
use ninebit::combiner::general::{self, PlannedPortion, PlannedStage};
use ninebit::combiner::registers::Registers;
use ninebit::number::Lane;
use ninebit::state::{Bias, CombinerInput, Component, InputMapping, MuxSelect, Portion, Profile, Register, Scale};
use ninebit::trace::Silent;

const INPUTS: [&str; 4] = ["a", "b", "c", "d"];
const FACTORS: [&str; 4] = ["mid.A", "mid.B", "mid.C", "mid.D"];
const OUTPUTS: [&str; 3] = ["out.ab", "out.cd", "out.third"];
const RGB: [&str; 3] = ["r", "g", "b"];

/// Where the four inputs of a tested portion come from.
const SOURCES: [Register; 4] =
    [Register::Texture0, Register::Texture1, Register::PrimaryColor, Register::SecondaryColor];

/// A stage whose every output is needed.
fn stage(rgb: Portion, alpha: Portion) -> PlannedStage {
    let (rgb, alpha) = (PlannedPortion::whole(rgb, 7), PlannedPortion::whole(alpha, 8));
    PlannedStage { index: 0, rgb, alpha, constants: [[0; 4]; 2], reads_constants: false }
}

/// A portion that reads the four sources.
fn portion(component: Component, mappings: &[i64]) -> Portion {
    let mut portion = Portion::idle(component);
    for ((input, register), mapping) in portion.inputs.iter_mut().zip(SOURCES).zip(mappings) {
        *input = CombinerInput { register, component, mapping: named(*mapping) };
    }
    portion
}

/// The configuration that the RGB and the alpha portion share.
fn configuration() -> Vec<Column> {
    let mut columns = INPUTS.map(|name| Column::choice::<InputMapping>(&format!("cfg.mapping_{name}"))).to_vec();
    columns.extend([Column::choice::<Scale>("cfg.scale"), Column::choice::<Bias>("cfg.bias"), Column::flag("cfg.mux")]);
    columns.push(Column::choice::<MuxSelect>("cfg.mux_select"));
    columns
}

/// An RGB portion with three outputs.
pub(super) struct GeneralStage;

/// The registers of a row.
fn general_file<L: Lane>(at: impl Fn(usize) -> L) -> Registers<L> {
    let mut file = Registers::new();
    for (n, register) in SOURCES.into_iter().enumerate() {
        let first = 10 + 3 * n;
        file.load(register, [at(first), at(first + 1), at(first + 2), L::ZERO]);
    }
    file.write(Register::Spare0, 3, at(22));
    file
}

/// R, G, B of AB, CD and the third output.
fn general_stage<L: Lane>(inputs: &[i64], mut file: Registers<L>, conditions: &Conditions) -> [L; 9] {
    let outputs = [Register::Spare0, Register::Spare1, Register::Texture2];
    let mut rgb = portion(Component::Rgb, &inputs[..4]);
    (rgb.scale, rgb.bias, rgb.mux) = (named(inputs[4]), named(inputs[5]), inputs[6] != 0);
    (rgb.ab_dot_product, rgb.cd_dot_product) = (inputs[8] != 0, inputs[9] != 0);
    [rgb.ab_output, rgb.cd_output, rgb.sum_output] = outputs;
    let stage = stage(rgb, Portion::idle(Component::Alpha));
    general::run(&stage, named(inputs[7]), &conditions.policies, &mut file, &mut Silent);
    std::array::from_fn(|n| file.read(outputs[n / 3], n % 3))
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
        let file = general_file(|n| inputs[n] as i32);
        let takes_cd =
            ninebit::combiner::output::mux_takes_cd(inputs[22] as i32, named(inputs[7]), &conditions.policies);
        // The factors by themselves: a trace of each row would be far slower.
        for (n, input) in portion(Component::Rgb, &inputs[..4]).inputs.iter().enumerate() {
            let x: [i32; 3] = std::array::from_fn(|channel| file.read(input.register, channel));
            let factors = ninebit::combiner::mapping::map(x, input.mapping, &conditions.policies);
            for (channel, factor) in factors.into_iter().enumerate() {
                results[3 * n + channel] = <i32 as Lane>::observe_factor(factor).0;
            }
        }
        results[12] = takes_cd.into();
        put(&mut results[13..], general_stage(inputs, file, conditions));
    }

    fn block(&self, inputs: &[i64], varying: usize, conditions: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
        let rows = |rows: &Sixteen| general_stage(inputs, general_file(|n| rows.at(n)), conditions);
        // The mux decides by the last.
        let has = varying >= 10 && !(varying == 22 && inputs[6] != 0);
        has.then(|| block::registers(inputs, varying, out, rows))
    }
}

/// An alpha portion with three outputs.
pub(super) struct AlphaPortion;

/// The registers of a row.
fn alpha_file<L: Lane>(at: impl Fn(usize) -> L) -> Registers<L> {
    let mut file = Registers::new();
    for (n, register) in SOURCES.into_iter().enumerate() {
        file.load(register, [L::ZERO, L::ZERO, at(12 + 2 * n), at(13 + 2 * n)]);
    }
    file.write(Register::Spare0, 3, at(20));
    file
}

/// The portion, each input with its component.
fn alpha_inputs(inputs: &[i64]) -> Portion {
    let mut alpha = portion(Component::Alpha, &inputs[..4]);
    for (input, component) in alpha.inputs.iter_mut().zip(&inputs[8..12]) {
        input.component = if *component == 0 { Component::Blue } else { Component::Alpha };
    }
    alpha
}

/// AB, CD and the third output.
fn alpha_portion<L: Lane>(inputs: &[i64], mut file: Registers<L>, conditions: &Conditions) -> [L; 3] {
    let outputs = [Register::Spare1, Register::Texture2, Register::Texture3];
    let mut alpha = alpha_inputs(inputs);
    (alpha.scale, alpha.bias, alpha.mux) = (named(inputs[4]), named(inputs[5]), inputs[6] != 0);
    [alpha.ab_output, alpha.cd_output, alpha.sum_output] = outputs;
    let stage = stage(Portion::idle(Component::Rgb), alpha);
    general::run(&stage, named(inputs[7]), &conditions.policies, &mut file, &mut Silent);
    outputs.map(|register| file.read(register, 3))
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
        let file = alpha_file(|n| inputs[n] as i32);
        for (n, input) in alpha_inputs(inputs).inputs.iter().enumerate() {
            let x = file.read(input.register, general::source_channel(input, 3));
            let [factor] = ninebit::combiner::mapping::map([x], input.mapping, &conditions.policies);
            results[n] = <i32 as Lane>::observe_factor(factor).0;
        }
        put(&mut results[4..], alpha_portion(inputs, file, conditions));
    }

    fn block(&self, inputs: &[i64], varying: usize, conditions: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
        let rows = |rows: &Sixteen| alpha_portion(inputs, alpha_file(|n| rows.at(n)), conditions);
        let has = varying >= 12 && !(varying == 20 && inputs[6] != 0);
        has.then(|| block::registers(inputs, varying, out, rows))
    }
}

/// A dot product's blue in the alpha of its destination.
pub(super) struct BlueToAlpha;

/// Blue of AB and CD, then alpha of SPARE0 and SPARE1.
fn blue_to_alpha<L: Lane>(inputs: &[i64], at: impl Fn(usize) -> L, conditions: &Conditions) -> [L; 4] {
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
    general::run(&stage, MuxSelect::Msb, &conditions.policies, &mut file, &mut Silent);
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
        put(results, blue_to_alpha(inputs, |n| inputs[n] as i32, conditions));
    }

    fn block(&self, inputs: &[i64], varying: usize, conditions: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
        let rows = |rows: &Sixteen| {
            let [_, _, spare0, spare1] = blue_to_alpha(inputs, |n| rows.at(n), conditions);
            [spare0, spare1]
        };
        (varying >= 3).then(|| block::registers(inputs, varying, out, rows))
    }
}

/// A register value handed from one stage to the next.
pub(super) struct TwoStages;

/// Red of SPARE0 after each.
fn two_stages<L: Lane>(inputs: &[i64], at: impl Fn(usize) -> L, conditions: &Conditions) -> [L; 2] {
    let signed = [InputMapping::SignedIdentity as i64; 4];
    let mut first = portion(Component::Rgb, &signed);
    (first.scale, first.bias, first.sum_output) = (named(inputs[0]), named(inputs[1]), Register::Spare0);
    let mut second = portion(Component::Rgb, &signed);
    let spare0 = CombinerInput { register: Register::Spare0, component: Component::Rgb, mapping: named(inputs[2]) };
    second.inputs[0] = spare0;
    second.inputs[1].mapping = named(inputs[3]);
    second.sum_output = Register::Spare0;
    let mut file = Registers::new();
    for (n, register) in SOURCES.into_iter().enumerate() {
        file.load(register, [at(4 + n); 4]);
    }
    let alpha = Portion::idle(Component::Alpha);
    let mut after = stage(second, alpha);
    after.index = 1;
    [stage(first, alpha), after].map(|stage| {
        general::run(&stage, MuxSelect::Msb, &conditions.policies, &mut file, &mut Silent);
        file.read(Register::Spare0, 0)
    })
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
        let [between, after] = two_stages(inputs, |n| inputs[n] as i32, conditions);
        let [mapped] = ninebit::combiner::mapping::map([between], named(inputs[2]), &conditions.policies);
        results[0] = between.into();
        results[1] = <i32 as Lane>::observe_factor(mapped).0;
        results[2] = after.into();
    }

    fn block(&self, inputs: &[i64], varying: usize, conditions: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
        let rows = |rows: &Sixteen| {
            let [_, after] = two_stages(inputs, |n| rows.at(n), conditions);
            [after]
        };
        (varying >= 4).then(|| block::registers(inputs, varying, out, rows))
    }
}
