//! `ninebit trace`.

use clap::Args;
use ninebit::engine::{self, TraceError};
use ninebit::output::{write_json, write_text};
use ninebit::report::{trace_json, trace_text};
use ninebit::state::Scene;

use super::exit::Failure;
use super::scene::SceneArguments;
use super::{Context, Format};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Column and row of the pixel, from the top left
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pixel: (u32, u32),
    /// Only this draw, numbered from 0
    #[arg(long, value_name = "N")]
    draw: Option<usize>,
    /// Which render target the pixel is in [default: the scene's first]
    #[arg(long, value_name = "NAME")]
    target: Option<String>,
    /// How to print it
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = Format::Text)]
    format: Format,
}

/// Prints how one pixel came to be.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let (scene, plan) = arguments.scene.load(context)?;
    let target = super::scene::chosen_target(&scene, arguments.target.as_deref())?;
    let trace =
        engine::trace(&plan, target, arguments.pixel, arguments.draw).map_err(|error| outside(&scene, &error))?;
    match arguments.format {
        Format::Text => write_text(&trace_text(&plan, &trace))?,
        Format::Json => write_json(&trace_json(&plan, &trace))?,
    }
    Ok(())
}

fn outside(scene: &Scene, error: &TraceError) -> Failure {
    let help = match error {
        TraceError::Pixel { width, height, .. } => {
            format!("columns run from 0 to {}, rows from 0 to {}", width - 1, height - 1)
        }
        TraceError::Draw { .. } => {
            let names: Vec<String> =
                scene.draws.iter().take(16).enumerate().map(|(n, d)| format!("{n} `{}`", d.name)).collect();
            format!("its draws: {}", names.join(", "))
        }
    };
    Failure::usage(error.to_string(), help)
}

fn pixel(text: &str) -> Result<(u32, u32), String> {
    text.split_once(',')
        .and_then(|(x, y)| Some((x.trim().parse().ok()?, y.trim().parse().ok()?)))
        .ok_or_else(|| "not of the form X,Y, for example 320,240".to_string())
}
