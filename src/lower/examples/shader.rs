//! Prints a combiner program as a GLSL function, for an emulator that compiles a shader for each program.
//!
//! `cargo run -p ninebit-lower --example shader`

use ninebit::state::{Combiners, GeneralStage, Register};
use ninebit_lower::{Function, Language, Named, Options};

fn main() {
    let mut stage = GeneralStage::default();
    stage.rgb.inputs[0].register = Register::Texture0;
    stage.rgb.inputs[1].register = Register::PrimaryColor;
    stage.rgb.ab_output = Register::Spare0;
    let program = Combiners { stages: vec![stage], ..Combiners::default() };
    let function = Function::of_program(&program, &Options::default());
    let named = Named { name: "shade".to_string(), about: "texture times colour".to_string(), function: &function };
    println!("{}", Language::Glsl.print(&[named]));
}
