//! Whole general stages, which read all inputs before they write.

use super::{CHANNELS, Column, Conditions, Kind, Reach, Unit, block, channels, named, paired, put, scale_takes_bias};
use ninebit::combiner::general::{self, PlannedStage, StageOn};
use ninebit::combiner::registers::Registers;
use ninebit::number::Lane;
use ninebit::state::{
    self, Bias, CombinerInput, Component, InputMapping, MuxSelect, Portion, Profile, Register, Scale,
};
use ninebit::trace::{Observer, Recorder, Silent};

const INPUTS: [&str; 4] = ["a", "b", "c", "d"];
const FACTORS: [&str; 4] = ["mid.A", "mid.B", "mid.C", "mid.D"];
const OUTPUTS: [&str; 3] = ["out.ab", "out.cd", "out.third"];
const RGB: [&str; 3] = ["r", "g", "b"];
const SIGNED: [i64; 4] = [InputMapping::SignedIdentity as i64; 4];

/// Registers of the four inputs of a portion.
const SOURCES: [Register; 4] =
    [Register::Texture0, Register::Texture1, Register::PrimaryColor, Register::SecondaryColor];

/// Runs a stage of two portions. Returns the values that it computes.
#[inline(always)]
fn run<L: Lane>(
    (rgb, alpha): (Portion, Portion),
    mux_select: MuxSelect,
    file: &mut Registers<L>,
    conditions: &Conditions,
    observer: &mut impl Observer,
) -> StageOn<L> {
    let stage = PlannedStage::whole(0, &state::GeneralStage { rgb, alpha, constants: [[0; 4]; 2] });
    general::values(&stage, mux_select, &conditions.policies, file, observer)
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

/// Returns a portion of that configuration.
fn configured(component: Component, inputs: &[i64], outputs: [Register; 3]) -> Portion {
    let [ab_output, cd_output, sum_output] = outputs;
    let (scale, bias, mux) = (named(inputs[4]), named(inputs[5]), inputs[6] != 0);
    Portion { scale, bias, mux, ab_output, cd_output, sum_output, ..portion(component, &inputs[..4]) }
}

/// Returns a factor in halves, as tables write it.
fn halves<L: Lane>(factor: L::Mapped) -> i64 {
    L::observe_factor(factor).0
}

/// An RGB portion with three outputs.
pub(super) struct GeneralStage;

impl GeneralStage {
    #[inline(always)]
    fn run<L: Lane>(
        &self,
        inputs: &[i64],
        at: impl Fn(usize) -> L,
        conditions: &Conditions,
        observer: &mut impl Observer,
    ) -> ([i64; 13], [L; 9]) {
        let outputs = [Register::Spare0, Register::Spare1, Register::Texture2];
        let mut rgb = configured(Component::Rgb, inputs, outputs);
        (rgb.ab_dot_product, rgb.cd_dot_product) = (inputs[8] != 0, inputs[9] != 0);
        let mut file = Registers::new();
        for (n, register) in SOURCES.into_iter().enumerate() {
            let first = 10 + 3 * n;
            file.load(register, [at(first), at(first + 1), at(first + 2), L::ZERO]);
        }
        file.write(Register::Spare0, 3, at(22));
        let portions = (rgb, Portion::idle(Component::Alpha));
        let values = run(portions, named(inputs[7]), &mut file, conditions, observer);
        let mut mid = [values.takes_cd.into(); 13];
        put(&mut mid[..12], values.rgb.factors.as_flattened().iter().map(|factor| halves::<L>(*factor)));
        (mid, std::array::from_fn(|n| values.rgb.outputs[n / 3][n % 3]))
    }
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

    // The last input steers the mux.
    computed!(run; registers from 10, unless |inputs: &[i64], varying| varying == 22 && inputs[6] != 0);
}

/// An alpha portion with three outputs.
pub(super) struct AlphaPortion;

impl AlphaPortion {
    #[inline(always)]
    fn run<L: Lane>(
        &self,
        inputs: &[i64],
        at: impl Fn(usize) -> L,
        conditions: &Conditions,
        observer: &mut impl Observer,
    ) -> ([i64; 4], [L; 3]) {
        let outputs = [Register::Spare1, Register::Texture2, Register::Texture3];
        let mut alpha = configured(Component::Alpha, inputs, outputs);
        for (input, component) in alpha.inputs.iter_mut().zip(&inputs[8..12]) {
            input.component = if *component == 0 { Component::Blue } else { Component::Alpha };
        }
        let mut file = Registers::new();
        for (n, register) in SOURCES.into_iter().enumerate() {
            file.load(register, [L::ZERO, L::ZERO, at(12 + 2 * n), at(13 + 2 * n)]);
        }
        file.write(Register::Spare0, 3, at(20));
        let portions = (Portion::idle(Component::Rgb), alpha);
        let values = run(portions, named(inputs[7]), &mut file, conditions, observer).alpha;
        (values.factors.map(|[factor]| halves::<L>(factor)), values.outputs.map(|[output]| output))
    }
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

    computed!(run; registers from 12, unless |inputs: &[i64], varying| varying == 20 && inputs[6] != 0);
}

/// Blue of a dot product, written to the alpha of its destination.
pub(super) struct BlueToAlpha;

impl BlueToAlpha {
    #[inline(always)]
    fn run<L: Lane>(
        &self,
        inputs: &[i64],
        at: impl Fn(usize) -> L,
        conditions: &Conditions,
        observer: &mut impl Observer,
    ) -> ([i64; 2], [L; 2]) {
        let mut rgb = portion(Component::Rgb, &SIGNED);
        (rgb.ab_output, rgb.cd_output, rgb.ab_dot_product) = (Register::Spare0, Register::Spare1, inputs[0] != 0);
        (rgb.ab_blue_to_alpha, rgb.cd_blue_to_alpha) = (inputs[1] != 0, inputs[2] != 0);
        let mut file = Registers::new();
        file.load(SOURCES[0], [at(3), at(4), at(5), L::ZERO]);
        file.load(SOURCES[1], [at(6), at(7), at(8), L::ZERO]);
        file.load(SOURCES[2], [L::ZERO, L::ZERO, at(9), L::ZERO]);
        file.load(SOURCES[3], [L::ZERO, L::ZERO, at(10), L::ZERO]);
        file.write(Register::Spare0, 3, at(11));
        file.write(Register::Spare1, 3, at(12));
        run((rgb, Portion::idle(Component::Alpha)), MuxSelect::Msb, &mut file, conditions, observer);
        let [blue, alpha] = [2, 3].map(|channel| SPARES.map(|spare| file.read(spare, channel)));
        (blue.map(|blue| blue.observe().0), alpha)
    }
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

    computed!(run; registers from 3);
}

/// A register value that one stage passes to the next.
pub(super) struct TwoStages;

impl TwoStages {
    #[inline(always)]
    fn run<L: Lane>(
        &self,
        inputs: &[i64],
        at: impl Fn(usize) -> L,
        conditions: &Conditions,
        observer: &mut impl Observer,
    ) -> ([i64; 2], [L; 1]) {
        let mut first = portion(Component::Rgb, &SIGNED);
        (first.scale, first.bias, first.sum_output) = (named(inputs[0]), named(inputs[1]), Register::Spare0);
        let mut second = portion(Component::Rgb, &SIGNED);
        let spare0 = CombinerInput { register: Register::Spare0, component: Component::Rgb, mapping: named(inputs[2]) };
        second.inputs[0] = spare0;
        second.inputs[1].mapping = named(inputs[3]);
        second.sum_output = Register::Spare0;
        let mut file = Registers::new();
        for (n, register) in SOURCES.into_iter().enumerate() {
            file.load(register, [at(4 + n); 4]);
        }
        let stages = [first, second].map(|rgb| state::GeneralStage { rgb, ..state::GeneralStage::idle([[0; 4]; 2]) });
        let [before, after] = [0, 1].map(|index| {
            let stage = PlannedStage::whole(index, &stages[index]);
            general::values(&stage, MuxSelect::Msb, &conditions.policies, &mut file, observer).rgb
        });
        let between = before.outputs[2][0].observe().0;
        ([between, halves::<L>(after.factors[0][0])], [after.outputs[2][0]])
    }
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

    computed!(run; registers from 4);
}

/// A stage whose portions write registers that they also read.
pub(super) struct BothPortions;

const SPARES: [Register; 2] = [Register::Spare0, Register::Spare1];

impl BothPortions {
    /// Returns SPARE0 and SPARE1 after the stage of a row.
    #[inline(always)]
    fn run<L: Lane>(
        &self,
        inputs: &[i64],
        at: impl Fn(usize) -> L,
        conditions: &Conditions,
        observer: &mut impl Observer,
    ) -> ([i64; 0], [L; 8]) {
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
        run((rgb, alpha), MuxSelect::Msb, &mut file, conditions, observer);
        ([], std::array::from_fn(|n| file.read(SPARES[n / 4], n % 4)))
    }
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
            ["in.spare0", "in.spare1"].map(|spare| channels(spare, CHANNELS, Column::register)).concat(),
        ];
        gives [["out.spare0", "out.spare1"].map(|spare| channels(spare, CHANNELS, |name| Column::result(name, Kind::Signed(9)))).concat()]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        inputs[2] != inputs[3]
    }

    fn fit(&self, inputs: &mut [i64]) {
        inputs[3] = 1 - inputs[2];
    }

    computed!(run; registers from 7);
}
