//! Prints a combiner program as a GLSL function, for an emulator that compiles a shader for each program.
//!
//! `cargo run -p ninebit-lower --example shader`

use ninebit::state::{Combiners, Component, GeneralStage, Portion, Register};
use ninebit_lower::{Function, Language, NamedFunction, Options};

fn main() {
    let rgb = Portion { ab_output: Register::Spare0, ..Portion::idle(Component::Rgb) };
    let rgb = rgb.a(Register::Texture0.rgb()).b(Register::PrimaryColor.rgb());
    let stage = GeneralStage { rgb, ..GeneralStage::default() };
    let program = Combiners { stages: vec![stage], ..Combiners::default() };
    let function = Function::of_program(&program, &Options::default());
    let named =
        NamedFunction { name: "shade".to_string(), about: "texture times colour".to_string(), function: &function };
    println!("{}", Language::Glsl.print(&[named]));
}
