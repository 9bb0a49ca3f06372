//! `ninebit trace`.

use clap::Args;
use ninebit::engine::{FRAGMENTS, TraceError, Tracer};
use ninebit::state::Scene;
use ninebit_files::output::write_stdout_with;
use ninebit_report::{write_trace_json, write_trace_text};

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
    /// Show at most so many fragments, the last ones
    #[arg(long, value_name = "N", default_value_t = FRAGMENTS, value_parser = clap::value_parser!(u64).range(1..))]
    fragments: u64,
    /// How to print it
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = Format::Text)]
    format: Format,
}

/// Prints how one pixel came to be.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let (scene, plan) = arguments.scene.load(context)?;
    let target = super::scene::chosen_target(&scene, arguments.target.as_deref())?;
    let Arguments { pixel, draw, fragments, .. } = *arguments;
    let tracer = Tracer::new(&plan, target, pixel, draw, fragments).map_err(|error| outside(&scene, &error))?;
    Ok(write_stdout_with(|out| match arguments.format {
        Format::Text => write_trace_text(out, &plan, &tracer),
        Format::Json => write_trace_json(out, &plan, &tracer),
    })?)
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
