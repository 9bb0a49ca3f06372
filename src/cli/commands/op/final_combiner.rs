//! `ninebit op final`.

use std::fmt::Write;

use clap::Args;
use ninebit::combiner::final_combiner::{self, PlannedFinal};
use ninebit::combiner::registers::channel_name;
use ninebit::state::{FinalCombiner, FinalRegister, Policies, Profile};
use ninebit::trace::Observer;
use serde_json::json;

use super::super::Context;
use super::super::exit::Failure;
use super::super::scene::PolicyArguments;
use super::super::template::Template;
use super::ProfileArgument;
use super::combiner::constants;
use super::inputs::{self, Assignment, Numbers};
use super::operation::{Column, Common, Operation, Results, drive};
use super::words::{self, Input};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Input A [default: zero]
    #[arg(long, value_name = "INPUT", value_parser = words::final_input)]
    a: Option<Input<FinalRegister>>,
    /// Input B
    #[arg(long, value_name = "INPUT", value_parser = words::final_input)]
    b: Option<Input<FinalRegister>>,
    /// Input C
    #[arg(long, value_name = "INPUT", value_parser = words::final_input)]
    c: Option<Input<FinalRegister>>,
    /// Input D
    #[arg(long, value_name = "INPUT", value_parser = words::final_input)]
    d: Option<Input<FinalRegister>>,
    /// Input E
    #[arg(long, value_name = "INPUT", value_parser = words::final_input)]
    e: Option<Input<FinalRegister>>,
    /// Input F
    #[arg(long, value_name = "INPUT", value_parser = words::final_input)]
    f: Option<Input<FinalRegister>>,
    /// Input G: alpha; left out, alpha is not computed
    #[arg(long, value_name = "INPUT", value_parser = words::final_input)]
    g: Option<Input<FinalRegister>>,
    /// spare0 + secondary may pass 1.0; otherwise it is limited
    #[arg(long)]
    no_color_sum_clamp: bool,
    /// 1 - spare0 enters the sum
    #[arg(long)]
    invert_spare0: bool,
    /// 1 - secondary enters the sum
    #[arg(long)]
    invert_secondary: bool,
    /// What a register holds, -256 to 255: REGISTER=N, =R,G,B or =R,G,B,A; REGISTER.CHANNEL=N. The rest holds 0
    #[arg(long = "in", value_name = "REGISTER=VALUES", value_parser = inputs::assignment)]
    registers: Vec<Assignment>,
    /// Constant colour 0, 0 to 255
    #[arg(long, value_name = "R,G,B,A", value_parser = inputs::color)]
    const0: Option<Numbers>,
    /// Constant colour 1, 0 to 255
    #[arg(long, value_name = "R,G,B,A", value_parser = inputs::color)]
    const1: Option<Numbers>,
    #[command(flatten)]
    profile: ProfileArgument,
    #[command(flatten)]
    policies: PolicyArguments,
    #[command(flatten)]
    common: Common,
}

/// The final combiner with register contents.
struct Final {
    planned: PlannedFinal,
    columns: Vec<Column>,
    profile: Profile,
    policies: Policies,
}

/// Runs the final combiner.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let policies = arguments.policies.policies()?;
    let mut columns = inputs::register_columns();
    inputs::assign(&mut columns, &arguments.registers)?;
    constants(&mut columns, [&arguments.const0, &arguments.const1])?;
    let template = Template { draw: program(arguments), ..Template::default() };
    let profile = arguments.profile.profile;
    let state = template.combiners(profile, context)?.final_combiner;
    drive(&Final { planned: planned(state, arguments.g.is_some()), columns, profile, policies }, &arguments.common)
}

/// The final combiner as a scene writes it, one field a line.
fn program(arguments: &Arguments) -> String {
    let inputs = [
        ("a", &arguments.a),
        ("b", &arguments.b),
        ("c", &arguments.c),
        ("d", &arguments.d),
        ("e", &arguments.e),
        ("f", &arguments.f),
        ("g", &arguments.g),
    ];
    let mut text = String::new();
    for (name, input) in inputs {
        if let Some(input) = input {
            let _ = writeln!(text, "                {name}: {},", input.scene());
        }
    }
    for (name, value) in [
        ("color_sum_clamp", !arguments.no_color_sum_clamp),
        ("invert_spare0", arguments.invert_spare0),
        ("invert_secondary", arguments.invert_secondary),
    ] {
        let _ = writeln!(text, "                {name}: {value},");
    }
    format!(
        "        program: Combiners(\n            stages: [()],\n            final_combiner: (\n{text}            ),\n        ),\n"
    )
}

/// The state, of which everything that is set is needed.
pub(super) fn planned(state: FinalCombiner, alpha: bool) -> PlannedFinal {
    let reads = |register: FinalRegister| state.inputs[..4].iter().any(|input| input.register == register);
    let product = reads(FinalRegister::ETimesF) || state.inputs[4..].iter().any(|input| !input.is_zero());
    PlannedFinal {
        state,
        live: if alpha { 15 } else { 7 },
        product: if product { 7 } else { 0 },
        sum: if reads(FinalRegister::Spare0PlusSecondary) { 7 } else { 0 },
        // The registers hold them already.
        reads_constants: false,
        lerps: true,
    }
}

impl Operation for Final {
    const NAME: &'static str = "final combiner";

    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn run<O: Observer>(&self, values: &[i64], observer: &mut O) -> Results {
        let mut registers = inputs::load(values);
        let fragment = final_combiner::run(&self.planned, self.profile, &self.policies, &mut registers, observer);
        (0..4)
            .filter(|channel| self.planned.live >> channel & 1 != 0)
            .map(|channel| (format!("fragment.{}", channel_name(channel)), json!(fragment[channel].fixed)))
            .collect()
    }

    fn chip(&self) -> Option<(Profile, Policies)> {
        Some((self.profile, self.policies))
    }
}
