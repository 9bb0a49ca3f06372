//! Register combiners: the register file, the general stages and the final combiner.

pub mod direct;
pub mod final_combiner;
pub mod general;
pub mod mapping;
pub mod output;
pub mod registers;
pub(crate) mod report;

use crate::algebra::Algebra;
use crate::number::Lane;
use crate::state::{Combiners, Policies, Profile, Register};
use crate::trace::{self, Observer, Silent};
use final_combiner::PlannedFinal;
use general::PlannedStage;
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
    pub fn run(&self, mut registers: Registers<i32>, policies: &Policies) -> [u8; 4] {
        let bytes = |constants: [[u8; 4]; 2], _| constants.map(|constant| constant.map(i32::from));
        // The profile only changes what a report says.
        let fragment = self.observed(&mut registers, bytes, (Profile::Nv10, policies), &mut Silent);
        fragment.map(|channel| channel.clamp(0, 255) as u8)
    }

    /// Runs the program on the numbers of a lane and reports to an observer. Returns R, G, B, A of the fragment, and leaves
    /// the registers as the general stages and the loading of constants left them.
    ///
    /// `registers` and `constants` are those of [`evaluate`](Self::evaluate).
    pub fn observed<L: Lane, O: Observer>(
        &self,
        registers: &mut Registers<L>,
        mut constants: impl FnMut([[u8; 4]; 2], Option<usize>) -> [[L; 4]; 2],
        (profile, policies): (Profile, &Policies),
        observer: &mut O,
    ) -> [L; 4] {
        let alpha = registers.read(Register::Texture0, 3);
        registers.write(Register::Spare0, 3, alpha);
        if O::ON {
            observer.step(trace::report::register_step("given", "CMB-13", "spare0.a", alpha));
        }
        for (index, stage) in self.stages.iter().enumerate() {
            if O::ON {
                report::constants(&format!("general stage {index}"), stage.constants, observer);
            }
            registers.load_constants(constants(stage.constants, Some(index)));
            general::run(&PlannedStage::whole(index, stage), self.mux_select, policies, registers, observer);
        }
        let last = PlannedFinal::whole(self.final_combiner);
        if O::ON {
            report::constants("final combiner", last.state.constants, observer);
        }
        registers.load_constants(constants(last.state.constants, None));
        final_combiner::run(&last, profile, policies, registers, observer)
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
        for (index, stage) in self.stages.iter().enumerate() {
            let planned = PlannedStage::whole(index, stage);
            registers.load_constants(constants(a, stage.constants, Some(index)));
            let values = general::evaluate(&planned, self.mux_select, &registers, a);
            general::write(&planned, &values, &mut registers, a);
        }
        registers.load_constants(constants(a, self.final_combiner.constants, None));
        final_combiner::evaluate(&self.final_combiner, &registers, a).fragment
    }
}
