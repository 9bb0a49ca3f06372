//! The operation `ninebit op program`: a whole pixel program on given registers.

use std::path::PathBuf;

use clap::Args;
use ninebit::state::Register;
use ninebit_scene::ProgramLanguage;
use ninebit_vectors::unit::Conditions;
use ninebit_vectors::units::ConfiguredProgram;

use super::{Assignment, Common, Context, Failure, ProgramArguments, Setup, StateArguments, inputs};

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
    state: StateArguments,
    #[command(flatten)]
    common: Common,
}

/// Registers that a pixel does not have: constants belong to the program, and SPARE0's alpha begins as TEXTURE0's (CMB-13).
const OWN: [Register; 4] = [Register::ConstantColor0, Register::ConstantColor1, Register::Spare0, Register::Spare1];

/// Runs a whole pixel program.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let policies = arguments.state.policies()?;
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
    let unit = ConfiguredProgram { combiners };
    let conditions = Conditions { profile: scene.profile, policies };
    let setup = Setup {
        find: |_, name| inputs::register_column(name).filter(|n| OWN.iter().all(|own| n / 4 != *own as usize)),
        known: "tex0.r, tex0.g, tex0.b, tex0.a and so on for tex1 to tex3, primary, secondary, fog".to_owned(),
        ..inputs::on_registers(&unit, columns, conditions)
    };
    setup.drive(&arguments.common)
}
