//! `ninebit render`.

use std::time::Instant;

use clap::{Args, ValueEnum};
use ninebit::engine;
use ninebit::state::Named;
use ninebit_files::output::{Compression, Destination, encode_png, write_json};
use serde_json::json;

use super::cost::Cost;
use super::engine::EngineArguments;
use super::exit::Failure;
use super::scene::{SceneArguments, chosen_target};
use super::terminal::Progress;
use super::{Context, Format, picture};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// The picture, a PNG; `-` is stdout
    #[arg(short, long, value_name = "FRAME.png", value_parser = picture::png())]
    output: Destination,
    /// Which render target to write [default: the scene's first]
    #[arg(long, value_name = "NAME")]
    target: Option<String>,
    #[command(flatten)]
    engine: EngineArguments,
    /// What stdout says: nothing, or statistics as one JSON document
    #[arg(long, value_enum, default_value_t = Format::Text, conflicts_with = "stats")]
    format: Format,
    #[arg(long, value_enum, hide = true)]
    stats: Option<Stats>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Stats {
    /// One JSON object
    Json,
}

/// Renders a scene and writes one of its targets.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let destination = &arguments.output;
    let statistics_wanted = arguments.stats.is_some() || matches!(arguments.format, Format::Json);
    if statistics_wanted && *destination == Destination::Stdout {
        return Err(Failure::usage(
            "the picture and the statistics cannot both go to stdout",
            "write the picture to a file",
        ));
    }
    let options = arguments.engine.options()?;
    let mut clock = Clock::start();
    let (scene, plan) = arguments.scene.load(context)?;
    destination.check()?;
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

    if statistics_wanted {
        let targets: Vec<_> = scene
            .targets
            .iter()
            .zip(&frames.surfaces)
            .map(|(target, surface)| {
                json!({
                    "name": target.name, "width": surface.width, "height": surface.height,
                    "format": surface.format.name(), "sha256": ninebit_files::picture::surface_digest(surface),
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
        write_json(&format!("{value:#}"))?;
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
