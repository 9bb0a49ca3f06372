//! The operation `ninebit op program`: a whole pixel program on given registers.

use std::path::PathBuf;

use clap::Args;
use ninebit::combiner::final_combiner;
use ninebit::combiner::general::{self, PlannedPortion, PlannedStage};
use ninebit::combiner::registers::channel_name;
use ninebit::state::{Combiners, Policies, Profile, Register};
use ninebit::trace::{Observer, Step};
use ninebit_scene::ProgramLanguage;
use serde_json::json;

use super::final_combiner::planned;
use super::{
    Assignment, Common, Context, Failure, Operation, PolicyArguments, ProgramArguments, Results, Setup, inputs,
};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The program: a file in any of the languages of `--from`
    #[arg(value_name = "PROGRAM", required_unless_present = "words")]
    file: Option<PathBuf>,
    /// The program as register words: names or methods with their words, a line each
    #[arg(long, value_name = "FILE", conflicts_with = "file")]
    words: Option<PathBuf>,
    #[command(flatten)]
    program: ProgramArguments,
    /// What a pixel brings, -256 to 255: REGISTER=N, =R,G,B or =R,G,B,A; REGISTER.CHANNEL=N. The rest holds 0. Registers are tex0 to tex3, primary, secondary, fog
    #[arg(long = "in", value_name = "REGISTER=VALUES", value_parser = inputs::assignment)]
    registers: Vec<Assignment>,
    #[command(flatten)]
    policies: PolicyArguments,
    #[command(flatten)]
    common: Common,
}

/// A program with the registers of a pixel.
struct Program {
    combiners: Combiners,
    profile: Profile,
    policies: Policies,
}

/// Registers that a pixel does not have: constants belong to the program, and SPARE0's alpha begins as TEXTURE0's (CMB-13).
const OWN: [Register; 4] = [Register::ConstantColor0, Register::ConstantColor1, Register::Spare0, Register::Spare1];

/// Runs a whole pixel program.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let policies = arguments.policies.policies()?;
    let mut columns = inputs::register_columns();
    inputs::assign(&mut columns, &arguments.registers)?;
    let own = |n: usize| OWN.iter().any(|register| n / 4 == *register as usize);
    if let Some((_, column)) = columns.iter().enumerate().find(|(n, column)| own(*n) && column.value != Some(0)) {
        let message = format!("`{}` is no input of a program", column.input.name);
        let help = "constants stand in the program; give tex0 to tex3, primary, secondary and fog";
        return Err(Failure::usage(message, help));
    }
    let (file, language) = match (&arguments.file, &arguments.words) {
        (Some(file), _) => (file, arguments.program.language(file)),
        (None, Some(words)) => (words, Some(ProgramLanguage::Registers)),
        (None, None) => return Err(Failure::usage("no program is given", "name its file")),
    };
    let language = language.ok_or_else(|| {
        let help = "say it by `--from`, for example `--from registers`";
        Failure::usage("which language the program is in is not said", help)
    })?;
    let (scene, _) = arguments.program.read(file, language, context)?;
    let combiners = scene.draws.into_iter().next().map(|draw| draw.combiners).unwrap_or_default();
    let profile = scene.profile;
    let program = Program { combiners, profile, policies };
    let setup = Setup {
        find: |_, name| inputs::register_column(name).filter(|n| OWN.iter().all(|own| n / 4 != *own as usize)),
        known: "tex0.r, tex0.g, tex0.b, tex0.a and so on for tex1 to tex3, primary, secondary, fog".to_owned(),
        ..inputs::on_registers("program", columns, (profile, policies), program)
    };
    setup.drive(&arguments.common)
}

impl Operation for Program {
    fn run<O: Observer>(&self, values: &[i64], observer: &mut O) -> Results {
        let mut registers = inputs::load(values);
        registers.write(Register::Spare0, 3, registers.read(Register::Texture0, 3));
        if O::ON {
            let value = i64::from(registers.read(Register::Spare0, 3).fixed);
            observer.step(Step::given("given", "CMB-13", "spare0.a", value).per(255).ideal(value as f64));
        }
        let constants = |colors: [[u8; 4]; 2], block: &str, observer: &mut O| {
            for (n, channel) in (0..2).flat_map(|n| (0..4).map(move |channel| (n, channel))).filter(|_| O::ON) {
                let (name, value) = (format!("constant{n}.{}", channel_name(channel)), i64::from(colors[n][channel]));
                observer.step(Step::given(block, "NUM-5", name, value).per(255).ideal(value as f64));
            }
        };
        for (index, stage) in self.combiners.stages.iter().enumerate() {
            constants(stage.constants, &format!("general stage {index}"), observer);
            let (rgb, alpha) = (PlannedPortion::whole(stage.rgb, 7), PlannedPortion::whole(stage.alpha, 8));
            let planned = PlannedStage { index, rgb, alpha, constants: stage.constants, reads_constants: true };
            general::run(&planned, self.combiners.mux_select, &self.policies, &mut registers, observer);
        }
        let state = self.combiners.final_combiner;
        constants(state.constants, "final combiner", observer);
        let planned = final_combiner::PlannedFinal { reads_constants: true, ..planned(state, true) };
        let fragment = final_combiner::run(&planned, self.profile, &self.policies, &mut registers, observer);
        (0..4).map(|c| (format!("fragment.{}", channel_name(c)), json!(fragment[c].fixed))).collect()
    }
}
