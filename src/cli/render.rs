//! `ninebit render`.

use std::ffi::OsString;
use std::time::Instant;

use clap::{Args, ValueEnum};
use ninebit::engine;
use ninebit::output::{Compression, Destination, encode_png, write_stdout};
use ninebit::state::Named;
use serde_json::json;

use super::Context;
use super::cost::Cost;
use super::engine::EngineArguments;
use super::exit::Failure;
use super::scene::{SceneArguments, chosen_target, refuse_overwriting};
use super::terminal::Progress;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// The picture, a PNG; `-` is stdout
    #[arg(short, long, value_name = "FRAME.png")]
    output: OsString,
    /// Which render target to write [default: the scene's first]
    #[arg(long, value_name = "NAME")]
    target: Option<String>,
    #[command(flatten)]
    engine: EngineArguments,
    /// Print statistics to stdout
    #[arg(long, value_enum, value_name = "FORMAT")]
    stats: Option<Stats>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Stats {
    /// One JSON object
    Json,
}

/// Renders a scene and writes one of its targets.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let destination = Destination::from(arguments.output.as_os_str());
    if arguments.stats.is_some() && destination == Destination::Stdout {
        return Err(Failure::usage(
            "the picture and the statistics cannot both go to stdout",
            "write the picture to a file",
        ));
    }
    refuse_overwriting(&arguments.scene.scene, &destination)?;

    let options = arguments.engine.options()?;

    let mut clock = Clock::start();
    let (scene, plan) = arguments.scene.load(context)?;
    let target = chosen_target(&scene, arguments.target.as_deref())?;
    clock.lap("load");
    let (frames, statistics) = {
        let progress = Progress::new("rendering", context.color);
        engine::render_counted(&plan, &options, &|done, total| progress.report(done as u64, total as u64))
    };
    clock.lap("render");
    // The picture takes its place in memory.
    drop(plan);
    let surface = &frames.surfaces[target];
    let pixels = surface.rgba8();
    destination.write(&encode_png(surface.width, surface.height, &pixels, Compression::Fast)?)?;
    clock.lap("write");

    if let Some(Stats::Json) = arguments.stats {
        let targets: Vec<_> = scene
            .targets
            .iter()
            .zip(&frames.surfaces)
            .map(|(target, surface)| {
                json!({
                    "name": target.name, "width": surface.width, "height": surface.height,
                    "format": surface.format.name(), "sha256": surface.digest(),
                })
            })
            .collect();
        let draws: Vec<_> = scene
            .draws
            .iter()
            .zip(&statistics.shaded_pixels)
            .map(|(draw, shaded)| json!({ "name": draw.name, "shaded_pixels": shaded }))
            .collect();
        let value = json!({
            "format": "ninebit-stats-1",
            "version": env!("CARGO_PKG_VERSION"),
            "profile": scene.profile.name(),
            "cost": Cost::of(&scene),
            "shaded_pixels": statistics.shaded_pixels.iter().sum::<u64>(),
            "draws": draws,
            "targets": targets,
            "microseconds": clock.laps,
        });
        write_stdout(format!("{value:#}\n").as_bytes())?;
    }
    Ok(())
}

/// Wall-clock times of the steps.
struct Clock {
    last: Instant,
    laps: serde_json::Map<String, serde_json::Value>,
}

impl Clock {
    fn start() -> Self {
        Clock { last: Instant::now(), laps: serde_json::Map::new() }
    }

    /// Ends a step.
    fn lap(&mut self, step: &str) {
        let now = Instant::now();
        let spent = u64::try_from((now - self.last).as_micros()).unwrap_or(u64::MAX);
        self.laps.insert(step.to_owned(), spent.into());
        self.last = now;
    }
}
