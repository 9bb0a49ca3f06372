//! Compares programs with the model by running the lines that they are printed from.
#![allow(missing_docs, unreachable_pub, dead_code, reason = "modules share files of which each uses its part")]
#![allow(clippy::unwrap_used, clippy::float_arithmetic, reason = "tests fail by panicking")]

#[path = "common/setting.rs"]
mod setting;

use ninebit::combiner::registers::Registers;
use ninebit::random::Random;
use ninebit::state::{Combiners, Policies, Profile, Register};
use ninebit_lower::code::{run, value_of};
use ninebit_lower::{Function, Generic, Input, Options, Result};
use ninebit_test_support::random_program;
use proptest::strategy::{Strategy, ValueTree};
use setting::{GIVEN, any_policies, any_value, runner};

/// Returns random programs, the same ones every time.
fn programs() -> impl Iterator<Item = Combiners> {
    let mut runner = runner(23);
    std::iter::repeat_with(move || random_program::combiners().new_tree(&mut runner).unwrap().current())
}

/// Returns values that registers can hold.
fn registers(random: &mut Random) -> Registers<i32> {
    let mut registers = Registers::from_value(0);
    for register in GIVEN {
        registers.load(register, any_value(register, random));
    }
    registers
}

fn given(registers: &Registers<i32>, input: Input, program: &Combiners) -> i64 {
    let read = |register: Register, channel: usize| i64::from(registers.read(register, channel));
    match input {
        Input::Primary(c) => read(Register::PrimaryColor, c),
        Input::Secondary(c) => read(Register::SecondaryColor, c),
        Input::Fog(c) => read(Register::Fog, c),
        Input::Texture(n, c) => read(GIVEN[3 + n], c),
        Input::StageConstant(stage, n, c) => program.stages[stage].constants[n][c].into(),
        Input::FinalConstant(n, c) => program.final_combiner.constants[n][c].into(),
        input => panic!("a program does not read {input:?}"),
    }
}

#[test]
fn lines_yield_what_the_model_does() {
    let mut random = Random::seeded(23);
    for (n, program) in programs().take(3000).enumerate() {
        let policies = if n % 2 == 0 { Policies::DEFAULT } else { any_policies(&mut random) };
        let options = Options { policies, uniform: n % 3 == 0, ..Options::default() };
        let function = Function::of_program(&program, &options);
        let Result::Fragment(fragment) = function.result else { panic!("a program yields a fragment") };
        for _ in 0..32 {
            let registers = registers(&mut random);
            let values = run(&function.lines, |input| given(&registers, input, &program));
            let got = fragment.map(|channel| value_of(&values, channel) as u8);
            assert_eq!(got, program.run(registers, &policies), "program {n} {program:?} {registers:?} {policies:?}");
        }
    }
}

#[test]
fn every_step_of_the_generic_verilog_is_a_module() {
    let text = Generic { chip: Profile::Nv2a, policies: Policies::DEFAULT }.verilog();
    for name in ["nb_mapped", "nb_products", "nb_third", "nb_output", "nb_final_rgb", "nb_blended", "nb_packed"] {
        assert_eq!(text.matches(&format!("module {name} (\n")).count(), 1, "{name}");
    }
    assert_eq!(text.matches("endmodule").count(), text.matches("\nmodule ").count());
    assert!(text.contains("CMB-3") && text.contains("NUM-2"));
}
