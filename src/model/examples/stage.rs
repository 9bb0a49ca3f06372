//! One general stage over all of its inputs: how far is the product of two expanded bytes, as DOT3 bump mapping takes them, from the real one?
//!
//! `cargo run -p ninebit --example stage`

use ninebit::combiner::registers::Registers;
use ninebit::state::{
    CombinerInput, Combiners, Component, FinalRegister, GeneralStage, InputMapping, Policies, Portion, Register,
};

fn main() {
    let input = |register| CombinerInput { register, mapping: InputMapping::ExpandNormal, component: Component::Rgb };
    let mut rgb = Portion { ab_output: Register::Spare0, ..Portion::idle(Component::Rgb) };
    (rgb.inputs[0], rgb.inputs[1]) = (input(Register::Texture0), input(Register::PrimaryColor));
    let mut program =
        Combiners { stages: vec![GeneralStage { rgb, ..GeneralStage::default() }], ..Combiners::default() };
    program.final_combiner.inputs[3].register = FinalRegister::Spare0; // D
    let expanded = |byte: i32| f64::from(byte) / 127.5 - 1.0;
    let (mut sum, mut worst) = (0.0, 0.0_f64);
    for (a, b) in (0..=255).flat_map(|a| (0..=255).map(move |b| (a, b))) {
        let mut registers = Registers::new();
        registers.load(Register::Texture0, [a; 4]);
        registers.load(Register::PrimaryColor, [b; 4]);
        let [red, ..] = program.run(registers, &Policies::DEFAULT);
        let error = f64::from(red) - 255.0 * (expanded(a) * expanded(b)).max(0.0);
        (sum, worst) = (sum + error / 65_536.0, worst.max(error.abs()));
    }
    println!("65,536 products, in 255ths: {sum:.3} off on average, {worst:.2} at most");
}

#[cfg(test)]
#[test]
fn runs() {
    main();
}
