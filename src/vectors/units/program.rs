//! Programs of APIs as tables: a stage, unit or instruction is lowered to combiners as for a draw, and runs on the registers of one pixel.

use super::{CHANNELS, Column, Conditions, Kind, block, channels, color_results};
use ninebit::combiner::registers::Registers;
use ninebit::number::{Lane, Lanes16};
use ninebit::state::{Combiners, Register};
use ninebit::trace::{Observer, Silent};

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

/// Returns the constants of a general stage, or of the final combiner for `None`.
fn constants(program: &Combiners, stage: Option<usize>) -> &[[u8; 4]; 2] {
    stage.map_or(&program.final_combiner.constants, |stage| &program.stages[stage].constants)
}

/// Runs a lowered program on a row. Returns SPARE0 and the fragment, which are 0 if the chip cannot run the program.
pub(super) fn run<L: Lane>(
    program: Option<Combiners>,
    places: &Places,
    at: impl Fn(usize) -> L,
    Conditions { profile, policies }: &Conditions,
    observer: &mut impl Observer,
) -> [L; 8] {
    let Some(program) = program else { return [L::ZERO; 8] };
    let mut file = file(places, at);
    let bytes = |constants: [[u8; 4]; 2], _| constants.map(|constant| constant.map(L::byte));
    let fragment = program.observed(&mut file, bytes, (*profile, policies), observer);
    let [r, g, b, a] = [0, 1, 2, 3].map(|channel| file.read(Register::Spare0, channel));
    [r, g, b, a, fragment[0], fragment[1], fragment[2], fragment[3]]
}

/// Evaluates, records and computes in block lanes the rows of a unit that lowers a program. `lower` returns the program of a row on a chip,
/// `places` its registers, and `through` the use of an input.
macro_rules! lowered_by {
    ($lower:expr, $places:expr, $through:expr) => {
        fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
            let program = $lower(inputs, conditions.profile);
            put(results, program::run(program, &$places(inputs), |n| inputs[n] as i32, conditions, &mut Silent));
        }

        fn trace(&self, inputs: &[i64], conditions: &Conditions, recorder: &mut Recorder) {
            let program = $lower(inputs, conditions.profile);
            program::run(program, &$places(inputs), |n| paired(inputs[n]), conditions, recorder);
        }

        fn block(&self, inputs: &[i64], varying: usize, conditions: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
            let (places, through) = ($places(inputs), $through(inputs, varying)?);
            let lower = |inputs: &[i64]| $lower(inputs, conditions.profile);
            program::block(inputs, varying, through, &places, conditions, out, lower)
        }
    };
}

pub(super) use lowered_by;

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

impl Through {
    /// Returns the use of a column where registers begin at one and constants at another.
    pub(super) fn of_column(column: usize, registers: usize, constants: usize) -> Option<Through> {
        (column >= registers).then_some(if column >= constants { Through::Constant } else { Through::Register })
    }
}

/// Rows in block lanes: the program is lowered once, or twice where the input that counts up is among its constants. `None`: it is lowered to something
/// else for other values of that input, or to nothing.
///
/// `lower` returns the program of a row with these inputs.
pub(super) fn block(
    inputs: &[i64],
    varying: usize,
    through: Through,
    places: &Places,
    Conditions { profile, policies }: &Conditions,
    out: &mut [u8],
    lower: impl Fn(&[i64]) -> Option<Combiners>,
) -> Option<[u64; 2]> {
    let lowered = |value: i64| {
        let mut inputs = inputs.to_vec();
        inputs[varying] = value;
        lower(&inputs)
    };
    let is_constant = through == Through::Constant;
    let program = lowered(if is_constant { 0 } else { inputs[varying] })?;
    let other = if is_constant { lowered(255)? } else { program.clone() };
    // The two differ only in constants that equal that input.
    let mut same = other.clone();
    for (stage, own) in same.stages.iter_mut().zip(&program.stages) {
        stage.constants = own.constants;
    }
    same.final_combiner.constants = program.final_combiner.constants;
    let all = |program: &Combiners| {
        let stages = (0..program.stages.len()).map(Some).chain([None]);
        stages.flat_map(|stage| *constants(program, stage)).flatten().collect::<Vec<u8>>()
    };
    let itself = |(a, b): (u8, u8)| a == b || (a, b) == (0, 255);
    if same != program || !all(&program).into_iter().zip(all(&other)).all(itself) {
        return None;
    }
    let chip = (*profile, policies);
    if through == Through::Decision {
        return Some(block::bytes(inputs, varying, out, |rows| {
            let mut out = [Lanes16::all(0); 4];
            for (row, number) in rows.numbers().0.into_iter().enumerate() {
                let mut file = file(places, |n| if n == varying { number } else { inputs[n] as i32 });
                let bytes = |constants: [[u8; 4]; 2], _| constants.map(|constant| constant.map(i32::from));
                let fragment = program.observed(&mut file, bytes, chip, &mut Silent);
                out.iter_mut().zip(fragment).for_each(|(lanes, value)| lanes.0[row] = value);
            }
            out
        }));
    }
    Some(block::bytes(inputs, varying, out, |rows| {
        let lanes = |own: [[u8; 4]; 2], stage| {
            let other = constants(&other, stage);
            let lane = |n: usize, c: usize| {
                if own[n][c] == other[n][c] { Lanes16::all(i32::from(own[n][c])) } else { rows.numbers() }
            };
            [0, 1].map(|n| [0, 1, 2, 3].map(|c| lane(n, c)))
        };
        program.observed(&mut file(places, |n| rows.at(n)), lanes, chip, &mut Silent)
    }))
}
