//! Register combiners: the register file, the general stages and the final combiner.

pub mod direct;
pub mod final_combiner;
pub mod general;
pub mod mapping;
pub mod output;
pub mod registers;
mod report;

use crate::algebra::Algebra;
use crate::state::{Combiners, Policies, Register};
use crate::trace::Silent;
use direct::Direct;
use general::{PlannedPortion, PlannedStage};
use registers::Registers;

impl Combiners {
    /// Runs the program on the registers of one pixel. Returns R, G, B, A as they reach the raster operations.
    ///
    /// A register holds -256 to 255, and a byte of the pixel 0 to 255. The caller loads what the pixel provides:
    /// textures, primary and secondary colour, and fog. The constant colours come from the program, and the alpha of
    /// SPARE0 starts as that of TEXTURE0 (CMB-13). The program is not checked;
    /// [`legality::check`](crate::legality::check) does that.
    ///
    /// The example `stage` runs a program on every pair of bytes.
    pub fn run(&self, registers: Registers<i32>, policies: &Policies) -> [u8; 4] {
        let mut observer = Silent;
        let constants = |_: &mut _, of: [[u8; 4]; 2], _| of.map(|constant| constant.map(i32::from));
        let fragment = self.evaluate(registers, constants, &mut Direct::new(policies, &mut observer));
        fragment.map(|channel| channel.clamp(0, 255) as u8)
    }

    /// Evaluates the program in an algebra. Returns R, G, B, A of the fragment.
    ///
    /// `registers` holds what a pixel provides; the alpha of SPARE0 starts as that of TEXTURE0 (CMB-13). `constants` is
    /// called before each stage, with its number, and before the final combiner, with `None`. It is given the program's
    /// own bytes and returns the two constant colours.
    pub fn evaluate<A: Algebra>(
        &self,
        mut registers: Registers<A::Register>,
        mut constants: impl FnMut(&mut A, [[u8; 4]; 2], Option<usize>) -> [[A::Register; 4]; 2],
        a: &mut A,
    ) -> [A::Register; 4] {
        registers.write(Register::Spare0, 3, registers.read(Register::Texture0, 3));
        let load = |registers: &mut Registers<A::Register>, [first, second]: [_; 2]| {
            registers.load(Register::ConstantColor0, first);
            registers.load(Register::ConstantColor1, second);
        };
        for (index, stage) in self.stages.iter().enumerate() {
            let (rgb, alpha) = (PlannedPortion::whole(stage.rgb, 7), PlannedPortion::whole(stage.alpha, 8));
            let planned = PlannedStage { index, rgb, alpha, constants: stage.constants, reads_constants: true };
            load(&mut registers, constants(a, stage.constants, Some(index)));
            let values = general::evaluate(&planned, self.mux_select, &registers, a);
            general::write(&planned, &values, &mut registers, a);
        }
        load(&mut registers, constants(a, self.final_combiner.constants, None));
        final_combiner::evaluate(&self.final_combiner, &registers, a).fragment
    }
}
