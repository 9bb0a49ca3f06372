//! The operation `ninebit op final`: the final combiner on given registers.

use clap::Args;
use ninebit::diagnostic::Diagnostic;
use ninebit::legality;
use ninebit::place::{Place, Places};
use ninebit::state::{Combiners, Component, FinalCombiner, FinalRegister, GeneralStage};
use ninebit_vectors::units::ConfiguredFinal;

use super::combiner::Options;
use super::{CommandLine, Contents, Context, Failure, FourInputs, Input, words};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    inputs: FourInputs<FinalRegister>,
    /// Input E
    #[arg(long, value_name = "INPUT", allow_hyphen_values = true, value_parser = words::input::<FinalRegister>)]
    e: Option<Input<FinalRegister>>,
    /// Input F
    #[arg(long, value_name = "INPUT", allow_hyphen_values = true, value_parser = words::input::<FinalRegister>)]
    f: Option<Input<FinalRegister>>,
    /// Input G: alpha; left out, alpha is not computed
    #[arg(long, value_name = "INPUT", allow_hyphen_values = true, value_parser = words::input::<FinalRegister>)]
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

/// Runs the final combiner.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    arguments.contents.drive(|profile| {
        let line = CommandLine::of_this_process();
        let (combiners, places, findings) = program(arguments, &line);
        let checked = legality::check(&combiners, profile, &places, &Options);
        line.accept(findings.into_iter().chain(checked.findings), context)?;
        Ok(ConfiguredFinal { state: combiners.final_combiner, alpha: arguments.g.is_some() })
    })
}

/// Returns a program with this final combiner, the places of its options, and the findings about them.
fn program(arguments: &Arguments, line: &CommandLine) -> (Combiners, Places, Vec<Diagnostic>) {
    let (mut state, mut places, mut findings) = (FinalCombiner::default(), Places::default(), Vec::new());
    let others = [("e", arguments.e), ("f", arguments.f), ("g", arguments.g)];
    for (n, (name, input)) in arguments.inputs.all().into_iter().chain(others).enumerate() {
        let Some(input) = input else { continue };
        let place = line.value_range(&[name]);
        findings.extend(input.mapping.and_then(|mapping| legality::final_mapping(place.clone(), mapping)));
        place.into_iter().for_each(|place| places.set(Place::FinalInput(n), place));
        match state.inputs.get_mut(n) {
            Some(slot) => *slot = input.into(),
            None => state.g = Input { component: input.component.or(Some(Component::Alpha)), ..input }.into(),
        }
    }
    state.color_sum_clamp = !arguments.no_color_sum_clamp;
    (state.invert_spare0, state.invert_secondary) = (arguments.invert_spare0, arguments.invert_secondary);
    let stages = vec![GeneralStage::default()];
    (Combiners { stages, final_combiner: state, ..Combiners::default() }, places, findings)
}
