//! The command `ninebit compare`: a scene in integers against ideal arithmetic.

use super::*;
use ninebit_report::compare::{
    ALL_CHANNELS, CompareOptions, HeatError, Mode, compare, comparison_json, comparison_text, heat_map,
};

use ninebit::threads::MAXIMUM as MAXIMUM_THREADS;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    work: WorkArguments,
    /// What the ideal decides by itself
    #[arg(long, value_enum, value_name = "MODE", default_value_t = ModeArgument::Free)]
    mode: ModeArgument,
    /// Which render target to compare [default: the scene's first]
    #[arg(long, value_name = "NAME")]
    target: Option<String>,
    /// A picture of the errors with its scale, a PNG
    #[arg(long, value_name = "DIFF.png", value_parser = picture::output("png"))]
    heatmap: Option<Destination>,
    #[command(flatten)]
    format: FormatArguments,
    /// Threads; 0 takes all cores
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = up_to::<MAXIMUM_THREADS>)]
    threads: usize,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ModeArgument {
    /// Everything, end to end; pixels where it decides differently are left out
    Free,
    /// Nothing: accumulated quantisation alone, told apart by its origin
    Follow,
    /// Nothing, and it starts from the model's integers at each rule: the error of each rule
    PerOp,
}

/// Compares a scene with its ideal.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let destination = arguments.heatmap.as_ref();
    picture::beside_report(destination)?;
    let mode = match arguments.mode {
        ModeArgument::Free => Mode::Free,
        ModeArgument::Follow => Mode::Follow,
        ModeArgument::PerOp => Mode::PerOp,
    };
    let (scene, plan) = arguments.scene.load_to_draw(arguments.work, context)?;
    destination.map_or(Ok(()), Destination::check)?;
    let target = chosen_target(&scene, arguments.target.as_deref())?;
    let comparison =
        compare(&plan, &CompareOptions { mode, target, threads: arguments.threads, channels: ALL_CHANNELS });
    if let Some(destination) = destination {
        let (width, height, pixels) = heat_map(&comparison).map_err(|error| no_picture(&error))?;
        destination.write(&encode_png(width, height, &pixels, Compression::Small)?)?;
    }
    let format = arguments.format.get();
    format.print(|| comparison_text(&plan, &comparison), || comparison_json(&plan, &comparison))?;
    if comparison.rules.iter().any(|rule| rule.exceeds()) {
        let message = "a rule is further from the ideal than it says";
        let help = "the table above names it, and `ninebit rule ID` prints it: please report it with the scene";
        return Err(Failure { exit: Exit::Difference, report: Report::message(None, message, help) });
    }
    Ok(())
}

fn no_picture(error: &HeatError) -> Failure {
    match error {
        HeatError::NoDifference => {
            let help = "leave out `--heatmap`; `ninebit compare` reports the frame as exact";
            Failure::invalid("NB0523", error.to_string(), help)
        }
        HeatError::NoPixels => {
            Failure::usage(error.to_string(), "`--heatmap` goes with `--mode free` and `--mode follow`")
        }
    }
}
