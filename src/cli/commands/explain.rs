//! The command `ninebit explain`: a scene's program as equations, with its cost.

use super::*;
use ninebit::engine;
use ninebit_report::explain::{explain, explanation_json, explanation_text};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Also render, and print what was counted beside what was predicted
    #[arg(long)]
    count: bool,
    #[command(flatten)]
    work: WorkArguments,
    /// How to print the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Prints the plan of a scene.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let (scene, plan) = match arguments.count {
        true => arguments.scene.load_to_draw(arguments.work, context)?,
        false => arguments.scene.load(context)?,
    };
    let draws = explain(&scene, &plan);
    let counted = arguments.count.then(|| engine::count(&plan));
    let counted = counted.as_deref();
    arguments.format.print(|| explanation_text(&plan, &draws, counted), || explanation_json(&plan, &draws, counted))
}
