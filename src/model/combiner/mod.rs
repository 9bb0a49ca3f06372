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
    /// Runs the program on the registers of one pixel: R, G, B, A as they reach the raster operations.
    ///
    /// A register holds -256 to 255, a byte of the pixel 0 to 255. Load what the pixel brings: textures, primary and secondary colour, fog. The constants are
    /// the program's, and the alpha of SPARE0 begins as that of TEXTURE0 (CMB-13). Legality is not asked for: [`legality::check`](crate::legality::check)
    /// does that.
    ///
    /// ```
    /// use ninebit::combiner::registers::Registers;
    /// use ninebit::state::{CombinerInput, Combiners, Component, FinalCombiner, FinalRegister, GeneralStage, InputMapping, Policies, Portion, Register};
    ///
    /// // SPARE0 = expand(TEXTURE0) . expand(PRIMARY), shown as it is.
    /// let input = |register| CombinerInput { register, mapping: InputMapping::ExpandNormal, component: Component::Rgb };
    /// let mut rgb = Portion { ab_dot_product: true, ab_output: Register::Spare0, ..Portion::idle(Component::Rgb) };
    /// (rgb.inputs[0], rgb.inputs[1]) = (input(Register::Texture0), input(Register::PrimaryColor));
    /// let mut program = Combiners { stages: vec![GeneralStage { rgb, ..GeneralStage::default() }], ..Combiners::default() };
    /// program.final_combiner = FinalCombiner::default();
    /// program.final_combiner.inputs[3].register = FinalRegister::Spare0; // D
    ///
    /// let mut registers = Registers::new();
    /// registers.load(Register::Texture0, [128, 128, 255, 255]);
    /// registers.load(Register::PrimaryColor, [128, 200, 230, 255]);
    /// assert_eq!(program.run(registers, &Policies::DEFAULT), [203, 203, 203, 255]);
    /// ```
    pub fn run(&self, registers: Registers<i32>, policies: &Policies) -> [u8; 4] {
        let mut observer = Silent;
        let constants = |_: &mut _, of: [[u8; 4]; 2], _| of.map(|constant| constant.map(i32::from));
        let fragment = self.evaluate(registers, constants, &mut Direct::new(policies, &mut observer));
        fragment.map(|channel| channel.clamp(0, 255) as u8)
    }

    /// The program on values of any kind: R, G, B, A of the fragment.
    ///
    /// `registers` hold what a pixel brings; the alpha of SPARE0 begins as that of TEXTURE0 (CMB-13). `constants` says before each stage, by its number, and before
    /// the final combiner (`None`) what the two constant colours are, given the program's own bytes.
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
