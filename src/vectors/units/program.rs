//! Programs of APIs as tables: one stage, unit or instruction, lowered to combiners as for a draw, and run on the registers of one pixel.

use crate::combiner::final_combiner::{self, PlannedFinal};
use crate::combiner::general::{self, PlannedPortion, PlannedStage};
use crate::combiner::registers::Registers;
use crate::state::{Combiners, Register};
use crate::trace::Silent;
use crate::vectors::column::{Column, Kind};
use crate::vectors::unit::Conditions;

pub(super) const CHANNELS: [&str; 4] = ["r", "g", "b", "a"];

/// Rules behind every lowered program.
pub(super) const RULES: &[&str] = &[
    "CMB-1", "CMB-2", "CMB-3", "CMB-4", "CMB-5", "CMB-6", "CMB-7", "CMB-8", "CMB-9", "CMB-11", "NUM-2", "NUM-3",
    "NUM-5", "FIN-1", "FIN-2",
];

/// Byte columns, four for each name.
pub(super) fn colors(names: &[&str]) -> Vec<Column> {
    let each = |name: &&str| CHANNELS.map(|channel| Column::byte(&format!("in.{name}.{channel}")));
    names.iter().flat_map(each).collect()
}

/// What the last general stage leaves in SPARE0, and the fragment.
pub(super) fn results() -> Vec<Column> {
    let mid = CHANNELS.map(|channel| Column::result(&format!("mid.spare0.{channel}"), Kind::Signed(9)));
    let out = CHANNELS.map(|channel| Column::result(&format!("out.{channel}"), Kind::Unsigned(8)));
    [mid, out].concat()
}

/// Four numbers as a colour of bytes.
pub(super) fn bytes(values: &[i64]) -> [u8; 4] {
    std::array::from_fn(|n| values[n] as u8)
}

/// Loads a register with four numbers.
pub(super) fn load(file: &mut Registers<i32>, register: Register, values: &[i64]) {
    file.load(register, std::array::from_fn(|n| values[n] as i32));
}

/// Runs a lowered program and writes the results; zeros where the chip has no form for it.
pub(super) fn run<E>(
    combiners: Result<Combiners, E>,
    mut file: Registers<i32>,
    conditions: &Conditions,
    results: &mut [i64],
) {
    let Ok(combiners) = combiners else { return results.fill(0) };
    let policies = &conditions.policies;
    // CMB-13.
    file.write(Register::Spare0, 3, file.read(Register::Texture0, 3));
    for (index, stage) in combiners.stages.iter().enumerate() {
        let (rgb, alpha) = (PlannedPortion::whole(stage.rgb, 7), PlannedPortion::whole(stage.alpha, 8));
        let planned = PlannedStage { index, rgb, alpha, constants: stage.constants, reads_constants: true };
        general::run(&planned, combiners.mux_select, policies, &mut file, &mut Silent);
    }
    for channel in 0..4 {
        results[channel] = file.read(Register::Spare0, channel).into();
    }
    let state = combiners.final_combiner;
    let planned = PlannedFinal { state, live: 15, product: 7, sum: 7, reads_constants: true, lerps: true };
    let out = final_combiner::run(&planned, conditions.profile, policies, &mut file, &mut Silent);
    for (result, value) in results[4..].iter_mut().zip(out) {
        *result = value.into();
    }
}
