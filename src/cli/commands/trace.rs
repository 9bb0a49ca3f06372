//! The command `ninebit trace`: prints every step of a pixel.

use super::scene::known_draws;
use super::*;
use ninebit::engine::{FRAGMENTS, TraceError, Tracer};
use ninebit_files::output::write_stdout_with;
use ninebit_report::{write_trace_json, write_trace_text, write_traces_json};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    work: WorkArguments,
    /// Column and row of the pixel, from the top left
    #[arg(long, value_name = "X,Y", value_parser = pixel, required_unless_present = "rectangle")]
    pixel: Option<(u32, u32)>,
    /// Every pixel of a rectangle instead, row by row: its first column and row, columns and rows
    #[arg(long, value_name = "X,Y,COLUMNS,ROWS", value_parser = rectangle, conflicts_with = "pixel")]
    rectangle: Option<[u32; 4]>,
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

/// Prints the steps of one pixel, or of a rectangle of pixels.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let (scene, plan) = arguments.scene.load_to_draw(arguments.work, context)?;
    let target = chosen_target(&scene, arguments.target.as_deref())?;
    let Arguments { pixel, rectangle, draw, fragments, .. } = *arguments;
    let pixels = match (pixel, rectangle) {
        (Some(pixel), _) => vec![pixel],
        (None, rectangle) => {
            let [x, y, columns, rows] = rectangle.unwrap_or_default();
            (0..rows).flat_map(|j| (0..columns).map(move |i| (x.saturating_add(i), y.saturating_add(j)))).collect()
        }
    };
    let tracer = |pixel| Tracer::new(&plan, target, pixel, draw, fragments).map_err(|error| outside(&scene, &error));
    let tracers: Vec<Tracer<'_>> = pixels.into_iter().map(tracer).collect::<Result<_, _>>()?;
    Ok(write_stdout_with(|out| match (arguments.format, &tracers[..]) {
        (Format::Text, tracers) => tracers.iter().enumerate().try_for_each(|(n, tracer)| {
            if n > 0 {
                writeln!(out)?;
            }
            write_trace_text(out, &plan, tracer)
        }),
        (Format::Json, [tracer]) if rectangle.is_none() => write_trace_json(out, &plan, tracer),
        (Format::Json, tracers) => write_traces_json(out, &plan, tracers),
    })?)
}

/// Maximum number of pixels in a rectangle.
const MAX_PIXELS: u64 = 4096;

fn rectangle(text: &str) -> Result<[u32; 4], String> {
    let [x, y, columns, rows] = rectangle_of(text)?;
    match u64::from(columns) * u64::from(rows) {
        pixels if pixels > MAX_PIXELS => Err(format!("it has {pixels} pixels; {MAX_PIXELS} are the most")),
        _ => Ok([x, y, columns, rows]),
    }
}

/// Parses a rectangle of pixels: its first column and row, columns and rows.
pub(super) fn rectangle_of(text: &str) -> Result<[u32; 4], String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[_, _, columns, rows]) if columns == 0 || rows == 0 => Err("it has no pixels".to_string()),
        Some(&[x, y, columns, rows]) => Ok([x, y, columns, rows]),
        _ => Err("not of the form X,Y,COLUMNS,ROWS, for example 320,240,4,4".to_string()),
    }
}

pub(super) fn outside(scene: &Scene, error: &TraceError) -> Failure {
    let help = match error {
        TraceError::Pixel { width, height, .. } => {
            format!("columns run from 0 to {}, rows from 0 to {}", width - 1, height - 1)
        }
        TraceError::Target { .. } => "name one of the scene's targets".to_owned(),
        TraceError::Draw { .. } => known_draws(scene),
    };
    Failure::usage(error.to_string(), help)
}

fn pixel(text: &str) -> Result<(u32, u32), String> {
    text.split_once(',')
        .and_then(|(x, y)| Some((x.trim().parse().ok()?, y.trim().parse().ok()?)))
        .ok_or_else(|| "not of the form X,Y, for example 320,240".to_string())
}
