//! `ninebit op final`.

use std::fmt::Write;

use clap::Args;
use ninebit::combiner::final_combiner::{self, PlannedFinal};
use ninebit::combiner::registers::channel_name;
use ninebit::state::{FinalCombiner, FinalRegister, Policies, Profile};
use ninebit::trace::Observer;
use serde_json::json;

use super::{Contents, Context, Failure, FourInputs, Input, Operation, Results, Template, inputs, words};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    inputs: FourInputs<FinalRegister>,
    /// Input E
    #[arg(long, value_name = "INPUT", value_parser = words::input::<FinalRegister>)]
    e: Option<Input<FinalRegister>>,
    /// Input F
    #[arg(long, value_name = "INPUT", value_parser = words::input::<FinalRegister>)]
    f: Option<Input<FinalRegister>>,
    /// Input G: alpha; left out, alpha is not computed
    #[arg(long, value_name = "INPUT", value_parser = words::input::<FinalRegister>)]
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
    #[command(flatten)]
    contents: Contents,
}

/// The final combiner with register contents.
struct Final {
    planned: PlannedFinal,
    profile: Profile,
    policies: Policies,
}

/// Runs the final combiner.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    arguments.contents.drive("final combiner", |profile, policies| {
        let template = Template { draw: program(arguments), ..Template::default() };
        let state = template.combiners(profile, context)?.final_combiner;
        Ok(Final { planned: planned(state, arguments.g.is_some()), profile, policies })
    })
}

/// The final combiner as a scene writes it, one field a line.
fn program(arguments: &Arguments) -> String {
    let others = [("e", &arguments.e), ("f", &arguments.f), ("g", &arguments.g)];
    let others = others.into_iter().filter_map(|(name, input)| Some((name, input.as_ref()?.scene())));
    let mut text = String::new();
    for (name, input) in arguments.inputs.fields().chain(others) {
        let _ = writeln!(text, "                {name}: {input},");
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
    fn run<O: Observer>(&self, values: &[i64], observer: &mut O) -> Results {
        let mut registers = inputs::load(values);
        let fragment = final_combiner::run(&self.planned, self.profile, &self.policies, &mut registers, observer);
        (0..4)
            .filter(|channel| self.planned.live >> channel & 1 != 0)
            .map(|channel| (format!("fragment.{}", channel_name(channel)), json!(fragment[channel].fixed)))
            .collect()
    }
}
