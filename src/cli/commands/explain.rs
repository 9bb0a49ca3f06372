//! `ninebit explain`.

use clap::Args;
use ninebit::engine;
use ninebit_files::output::{write_json, write_text};
use ninebit_report::explain::{explain, explanation_json, explanation_text};

use super::exit::Failure;
use super::scene::SceneArguments;
use super::{Context, Format};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Also render, and print what was counted beside what was predicted
    #[arg(long)]
    count: bool,
    /// How to print the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Prints the plan of a scene.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let (scene, plan) = arguments.scene.load(context)?;
    let draws = explain(&scene, &plan);
    let counted = arguments.count.then(|| engine::count(&plan));
    match arguments.format {
        Format::Text => write_text(&explanation_text(&plan, &draws, counted.as_deref()))?,
        Format::Json => write_json(&explanation_json(&plan, &draws, counted.as_deref()))?,
    }
    Ok(())
}
