//! Programs of APIs as tables: a stage, unit or instruction is lowered to combiners as for a draw, and runs on the registers of one pixel.

use super::{CHANNELS, Column, Conditions, Kind, block, channels, color_results};
use ninebit::combiner::final_combiner::{self, PlannedFinal};
use ninebit::combiner::general::{self, PlannedPortion, PlannedStage};
use ninebit::combiner::registers::Registers;
use ninebit::number::{Lane, Lanes16};
use ninebit::state::{Combiners, FinalRegister, MuxSelect, Register};
use ninebit::trace::Silent;

/// Rules of every lowered program.
pub(super) const RULES: &[&str] = &[
    "CMB-1", "CMB-2", "CMB-3", "CMB-4", "CMB-5", "CMB-6", "CMB-7", "CMB-8", "CMB-9", "CMB-11", "NUM-2", "NUM-3",
    "NUM-5", "FIN-1", "FIN-2",
];

/// Returns the results: SPARE0 after the last general stage, and the fragment.
pub(super) fn results() -> Vec<Column> {
    let spare0 = channels("mid.spare0", CHANNELS, |name| Column::result(name, Kind::Signed(9)));
    [spare0.to_vec(), color_results(["out"])].concat()
}

/// Registers that a row fills, each with the index of its red among the inputs. Green, blue and alpha follow.
pub(super) type Places = [(Register, usize)];

/// Returns the registers of a row.
fn file<L: Lane>(places: &Places, at: impl Fn(usize) -> L) -> Registers<L> {
    let mut file = Registers::new();
    for (register, first) in places {
        file.load(*register, [at(*first), at(first + 1), at(first + 2), at(first + 3)]);
    }
    file
}

/// A lowered program that can run.
#[derive(Clone, PartialEq)]
struct Program {
    /// Each stage with whether it reads constants.
    stages: Vec<(PlannedStage, bool)>,
    mux_select: MuxSelect,
    last: (PlannedFinal, bool),
}

const CONSTANTS: [Register; 2] = [Register::ConstantColor0, Register::ConstantColor1];

impl Program {
    fn new(combiners: &Combiners) -> Program {
        let stages = combiners.stages.iter().enumerate().map(|(index, stage)| {
            let (rgb, alpha) = (PlannedPortion::whole(stage.rgb, 7), PlannedPortion::whole(stage.alpha, 8));
            let inputs = [stage.rgb.inputs, stage.alpha.inputs];
            let reads = inputs.as_flattened().iter().any(|input| CONSTANTS.contains(&input.register));
            (PlannedStage { index, rgb, alpha, constants: stage.constants, reads_constants: false }, reads)
        });
        let state = combiners.final_combiner;
        let reads = |wanted: &[FinalRegister]| {
            state.inputs.iter().chain([&state.g]).any(|input| wanted.contains(&input.register))
        };
        let all = |wanted| if reads(&[wanted]) { 7 } else { 0 };
        let (product, sum) = (all(FinalRegister::ETimesF), all(FinalRegister::Spare0PlusSecondary));
        let last = PlannedFinal { state, live: 15, product, sum, reads_constants: false, lerps: true };
        let constants = reads(&[FinalRegister::ConstantColor0, FinalRegister::ConstantColor1]);
        Program { stages: stages.collect(), mux_select: combiners.mux_select, last: (last, constants) }
    }

    /// Returns the two constants of a general stage, or of the final combiner, which comes after the stages.
    fn constants(&self, stage: usize) -> &[[u8; 4]; 2] {
        self.stages.get(stage).map_or(&self.last.0.state.constants, |(stage, _)| &stage.constants)
    }

    /// Returns a constant of a stage as it is.
    fn constant(&self, stage: usize, n: usize, channel: usize) -> i32 {
        self.constants(stage)[n][channel].into()
    }

    /// Runs the program. Returns the fragment, and leaves the registers after the general stages in `file`. `constant` returns a constant
    /// by stage, number and channel.
    fn run<L: Lane>(
        &self,
        constant: impl Fn(usize, usize, usize) -> L,
        file: &mut Registers<L>,
        conditions: &Conditions,
    ) -> [L; 4] {
        let load = |file: &mut Registers<L>, stage: usize| {
            for (n, register) in CONSTANTS.into_iter().enumerate() {
                let channel = |channel| constant(stage, n, channel);
                file.load(register, [channel(0), channel(1), channel(2), channel(3)]);
            }
        };
        let Conditions { profile, policies } = conditions;
        // CMB-13.
        file.write(Register::Spare0, 3, file.read(Register::Texture0, 3));
        for (index, (stage, reads_constants)) in self.stages.iter().enumerate() {
            if *reads_constants {
                load(file, index);
            }
            general::run(stage, self.mux_select, policies, file, &mut Silent);
        }
        let (last, reads_constants) = &self.last;
        if *reads_constants {
            load(file, self.stages.len());
        }
        final_combiner::run(last, *profile, policies, file, &mut Silent)
    }
}

/// Runs a lowered program on a row and writes the results, which are 0 if the chip cannot run the program.
pub(super) fn run(
    combiners: Option<Combiners>,
    places: &Places,
    inputs: &[i64],
    conditions: &Conditions,
    results: &mut [i64],
) {
    let Some(combiners) = combiners else { return results.fill(0) };
    let program = Program::new(&combiners);
    let mut file = file(places, |n| inputs[n] as i32);
    let out = program.run(|stage, n, channel| program.constant(stage, n, channel), &mut file, conditions);
    for channel in 0..4 {
        results[channel] = file.read(Register::Spare0, channel).into();
        results[4 + channel] = out[channel].into();
    }
}

/// The use of the input that counts up in a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Through {
    /// It is a channel of a register.
    Register,
    /// It decides which of two products is taken, so that rows are computed one by one.
    Decision,
    /// It is a constant.
    Constant,
}

/// Rows in block lanes: the program is lowered once, or twice where the input that counts up is among its constants. `None`: it is lowered to something
/// else for other values of that input, or to nothing.
///
/// `lower` has what a row with these inputs lowers to.
pub(super) fn block(
    inputs: &[i64],
    varying: usize,
    through: Through,
    places: &Places,
    conditions: &Conditions,
    out: &mut [u8],
    lower: impl Fn(&[i64]) -> Option<Combiners>,
) -> Option<[u64; 2]> {
    let lowered = |value: i64| {
        let mut inputs = inputs.to_vec();
        inputs[varying] = value;
        lower(&inputs).map(|combiners| Program::new(&combiners))
    };
    let is_constant = through == Through::Constant;
    let program = lowered(if is_constant { 0 } else { inputs[varying] })?;
    let other = if is_constant { lowered(255)? } else { program.clone() };
    // The two differ only in constants that equal that input.
    let counts = |stage: usize, n: usize, channel: usize| {
        [program.constants(stage)[n][channel], other.constants(stage)[n][channel]]
    };
    let mut same = other.clone();
    for ((stage, _), (own, _)) in same.stages.iter_mut().zip(&program.stages) {
        stage.constants = own.constants;
    }
    same.last.0.state.constants = program.last.0.state.constants;
    let mut channels = (0..=program.stages.len()).flat_map(|stage| (0..8).map(move |n| (stage, n / 4, n % 4)));
    let itself = |[a, b]: [u8; 2]| a == b || [a, b] == [0, 255];
    if same != program || !channels.all(|(stage, n, channel)| itself(counts(stage, n, channel))) {
        return None;
    }
    let slot = places.iter().find(|(_, first)| (*first..first + 4).contains(&varying));
    let slot = slot.map(|(register, first)| (*register, varying - first));
    if through == Through::Decision {
        let template = file(places, |n| inputs[n] as i32);
        return Some(block::bytes(inputs, varying, out, |rows| {
            let mut out = [Lanes16::all(0); 4];
            for (row, number) in rows.numbers().0.into_iter().enumerate() {
                let mut file = template;
                slot.into_iter().for_each(|(register, channel)| file.write(register, channel, number));
                let constant = |stage, n, channel| program.constant(stage, n, channel);
                let fragment = program.run(constant, &mut file, conditions);
                out.iter_mut().zip(fragment).for_each(|(lanes, value)| lanes.0[row] = value);
            }
            out
        }));
    }
    let template = file(places, |n| Lanes16::all(inputs[n] as i32));
    Some(block::bytes(inputs, varying, out, |rows| {
        let mut file = template;
        slot.into_iter().for_each(|(register, channel)| file.write(register, channel, rows.numbers()));
        let constant = |stage: usize, n: usize, channel: usize| match counts(stage, n, channel) {
            [a, b] if a == b => Lanes16::all(i32::from(a)),
            _ => rows.numbers(),
        };
        program.run(constant, &mut file, conditions)
    }))
}
