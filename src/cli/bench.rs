//! `ninebit bench`.
#![allow(clippy::float_arithmetic, reason = "times")]

use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use ninebit::engine::Renderer;
use ninebit::output::write_stdout;
use ninebit::state::Named;
use serde::Serialize;

use super::Context;
use super::engine::EngineArguments;
use super::exit::Failure;
use super::scene::{PolicyArguments, load};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scene files
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    policies: PolicyArguments,
    #[command(flatten)]
    engine: EngineArguments,
    /// Frames that are timed of each scene
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: u32,
    /// Print one JSON document
    #[arg(long)]
    json: bool,
}

/// What was measured of a scene.
#[derive(Debug, Serialize)]
struct Measured {
    scene: String,
    /// Covered pixels of all draws.
    shaded_pixels: u64,
    frames: u32,
    /// Reading, checking and planning.
    load_microseconds: f64,
    /// Decoding textures, compiling draws, starting threads.
    prepare_microseconds: f64,
    /// The draws of a frame, without the clear.
    frame_microseconds: Spread,
    nanoseconds_per_pixel: Spread,
}

/// The middle of some times, and the least.
#[derive(Clone, Copy, Debug, Serialize)]
struct Spread {
    median: f64,
    least: f64,
}

#[derive(Debug, Serialize)]
struct Document {
    format: &'static str,
    version: &'static str,
    engine: &'static str,
    isa: &'static str,
    threads: usize,
    scenes: Vec<Measured>,
}

/// Draws each scene many times and prints how long that takes.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let options = arguments.engine.options()?;
    let mut document = Document {
        format: "ninebit-bench-1",
        version: env!("CARGO_PKG_VERSION"),
        engine: options.engine.name(),
        isa: "",
        threads: options.threads,
        scenes: Vec::new(),
    };
    for path in &arguments.scenes {
        let mut last = Instant::now();
        let mut lap = || {
            let now = Instant::now();
            let spent = now.duration_since(last).as_secs_f64() * 1e6;
            last = now;
            spent
        };
        let (_, plan) = load(path, &arguments.policies, context)?;
        let load_microseconds = lap();
        let renderer = Renderer::new(&plan, &options);
        let prepare_microseconds = lap();
        document.isa = renderer.isa().name();
        let (mut frames, statistics) = renderer.render();
        let shaded_pixels: u64 = statistics.shaded_pixels.iter().sum();
        lap();
        let mut times: Vec<f64> = (0..arguments.frames)
            .map(|_| {
                renderer.redraw(&mut frames);
                lap()
            })
            .collect();
        times.sort_by(f64::total_cmp);
        let frame_microseconds = Spread { median: times[times.len() / 2], least: times[0] };
        let pixel = |microseconds: f64| 1e3 * microseconds / (shaded_pixels.max(1) as f64);
        document.scenes.push(Measured {
            scene: path.display().to_string(),
            shaded_pixels,
            frames: arguments.frames,
            load_microseconds,
            prepare_microseconds,
            frame_microseconds,
            nanoseconds_per_pixel: Spread {
                median: pixel(frame_microseconds.median),
                least: pixel(frame_microseconds.least),
            },
        });
    }
    let text = if arguments.json {
        serde_json::to_string_pretty(&document).unwrap_or_default() + "\n"
    } else {
        text(&document)
    };
    Ok(write_stdout(text.as_bytes())?)
}

fn text(document: &Document) -> String {
    let mut text = format!(
        "engine {}, {}, {} thread(s); 0 is one a core. Medians of the frames, least in brackets.\n\
         {:>10} {:>18} {:>18}  scene\n",
        document.engine, document.isa, document.threads, "pixels", "ms a frame", "ns a pixel"
    );
    for measured in &document.scenes {
        let spread = |spread: Spread, unit: f64| format!("{:.3} ({:.3})", spread.median / unit, spread.least / unit);
        let _ = writeln!(
            text,
            "{:>10} {:>18} {:>18}  {}",
            measured.shaded_pixels,
            spread(measured.frame_microseconds, 1e3),
            spread(measured.nanoseconds_per_pixel, 1.0),
            measured.scene
        );
    }
    text
}
