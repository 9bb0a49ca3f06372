//! Runs one general stage on all of its inputs, and measures how far the product of two expanded bytes, as DOT3 bump mapping computes it,
//! is from the real product.
//!
//! `cargo run -p ninebit --example stage`

use ninebit::combiner::registers::Registers;
use ninebit::state::*;

fn main() {
    let [a, b] = [Register::Texture0, Register::PrimaryColor].map(|read| read.rgb().mapped(InputMapping::ExpandNormal));
    let rgb = Portion { ab_output: Register::Spare0, ..Portion::idle(Component::Rgb) }.a(a).b(b);
    let program = Combiners {
        stages: vec![GeneralStage { rgb, ..GeneralStage::default() }],
        final_combiner: FinalCombiner::default().d(FinalRegister::Spare0.rgb()),
        ..Combiners::default()
    };
    let (mut exact, mut worst) = (0, 0);
    for (a, b) in (0..=255).flat_map(|a| (0..=255).map(move |b| (a, b))) {
        let mut registers = Registers::new();
        registers.load(Register::Texture0, [a; 4]);
        registers.load(Register::PrimaryColor, [b; 4]);
        let [red, ..] = program.run(registers, &Policies::DEFAULT);
        // The real numbers are 2 a / 255 - 1. All values here are in 65,025ths.
        let error = 255 * i32::from(red) - ((2 * a - 255) * (2 * b - 255)).max(0);
        (exact, worst) = (exact + i32::from(error.abs() <= 127), worst.max(error.abs()));
    }
    println!("{exact} of 65,536 products are the nearest of 255 steps; the worst is {worst}/65,025 off");
}
