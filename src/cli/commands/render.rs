//! The command `ninebit render`: renders scenes to pictures.

use super::*;
use std::time::Instant;

use ninebit::engine;
use ninebit::frame::Surface;
use ninebit::state::{DepthFormat, Target};
use ninebit_files::output::encode_grey_png;
use serde_json::{Map, Value};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// The picture, a PNG; `-` is stdout
    #[arg(short, long, value_name = "FRAME.png", value_parser = picture::output("png"))]
    output: Destination,
    /// Write an alpha of 255 in every pixel of the picture
    #[arg(long, conflicts_with = "alpha")]
    opaque: bool,
    /// Write the alpha that is stored, which viewers show as see-through; it is written anyway, but not without a note
    #[arg(long)]
    alpha: bool,
    /// Which render target to write [default: the scene's first]
    #[arg(long, value_name = "NAME")]
    target: Option<String>,
    #[command(flatten)]
    engine: EngineArguments,
    #[command(flatten)]
    work: WorkArguments,
    /// Its depth buffer: NAME.png, grey of 16 bits, the upper 16 of each depth; any other name, words as the chip stores them, little-endian: two
    /// bytes of Z16, four of Z24S8, whose low byte is the stencil
    #[arg(long, value_name = "FILE", value_parser = picture::depths())]
    depth: Option<Destination>,
    /// Its stored colours: words, little-endian, as many bytes as the format has, row by row from the top
    #[arg(long, value_name = "FILE.raw", value_parser = picture::output("raw"))]
    raw: Option<Destination>,
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
    let destinations =
        || [Some(&arguments.output), arguments.depth.as_ref(), arguments.raw.as_ref()].into_iter().flatten();
    let statistics_wanted = arguments.stats.is_some() || matches!(arguments.format, Format::Json);
    let to_stdout = destinations().filter(|destination| **destination == Destination::Stdout).count();
    if statistics_wanted && to_stdout == 1 {
        let message = "the picture and the statistics cannot both go to stdout";
        return Err(Failure::usage(message, "write the picture to a file"));
    }
    if to_stdout > 1 {
        return Err(Failure::usage("only one output can go to stdout", "write the others to files"));
    }
    let options = arguments.engine.options()?;
    let mut clock = Clock::start();
    let (scene, plan) = arguments.scene.load_to_draw(arguments.work, context)?;
    destinations().try_for_each(Destination::check)?;
    let target = chosen_target(&scene, arguments.target.as_deref())?;
    let depth_buffer = scene.targets[target].depth;
    if arguments.depth.is_some() && depth_buffer.is_none() {
        let name = shown::name(&scene.targets[target].name).into_owned();
        let help = "leave out `--depth`, or write `depth: Z24S8` in the target";
        return Err(Failure::usage(format!("the target `{name}` has no depth buffer"), help));
    }
    clock.lap("load");
    let (frames, statistics) = {
        let progress = Progress::new("rendering", context.color);
        engine::render_counted(&plan, &options, &|done, total| progress.report(done as u64, total as u64))
    };
    clock.lap("render");
    // Frees memory for the picture.
    drop(plan);
    let surface = &frames.surfaces[target];
    let mut pixels = surface.rgba8();
    if arguments.opaque {
        pixels.iter_mut().for_each(|pixel| pixel[3] = 255);
    }
    arguments.output.write(&encode_png(surface.width, surface.height, &pixels, Compression::Fast)?)?;
    if let (Some(destination), Some(buffer)) = (&arguments.depth, depth_buffer) {
        destination.write(&depths(surface, buffer.format, destination)?)?;
    }
    if let Some(destination) = &arguments.raw {
        destination.write(&little_endian(&surface.words, surface.format.bytes() as usize))?;
    }
    clock.lap("write");
    let clear = pixels.iter().filter(|pixel| pixel[3] < 255).count() as u64;
    if clear > 0 && !arguments.alpha {
        let message = format!(
            "{} of the picture have an alpha below 255: viewers show them see-through",
            shown::count(clear, "pixel")
        );
        let help = "`--opaque` writes the colours alone; `--alpha` says that alpha is wanted";
        terminal::print(Level::Note, &Report::message(None, &message, help), context.color);
    }

    if statistics_wanted {
        let target = |(target, surface): (&Target, &Surface)| {
            json!({
                "name": target.name, "width": surface.width, "height": surface.height,
                "format": surface.format.name(), "sha256": ninebit_files::picture::surface_digest(surface),
            })
        };
        let targets: Value = scene.targets.iter().zip(&frames.surfaces).map(target).collect();
        let draws = scene.draws.iter().zip(&statistics.shaded_pixels);
        let draws: Value = draws.map(|(draw, shaded)| json!({ "name": draw.name, "shaded_pixels": shaded })).collect();
        let value = json!({
            "format": "ninebit-stats-1",
            "version": env!("CARGO_PKG_VERSION"),
            "profile": scene.profile.name(),
            "cost": Cost::from_scene(&scene),
            "shaded_pixels": statistics.shaded_pixels.iter().sum::<u64>(),
            "draws": draws,
            "targets": targets,
            "microseconds": clock.laps,
        });
        write_json(&format!("{value:#}"))?;
    }
    Ok(())
}

/// Encodes a depth buffer in the format that the destination's name implies.
fn depths(surface: &Surface, format: DepthFormat, destination: &Destination) -> Result<Vec<u8>, OutputError> {
    let bits = format.bits();
    match destination {
        Destination::File(path) if picture::is_png(path) => {
            encode_grey_png(surface.width, surface.height, &picture::upper_depths(surface, format))
        }
        _ if bits == 24 => Ok(little_endian(&surface.chip_depth_words().collect::<Vec<_>>(), 4)),
        _ => Ok(little_endian(&surface.depth, 2)),
    }
}

/// Encodes words of `bytes` bytes each.
fn little_endian(words: &[u32], bytes: usize) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes().into_iter().take(bytes)).collect()
}

/// Stopwatch for the wall-clock times of steps.
struct Clock {
    last: Instant,
    laps: Map<String, Value>,
}

impl Clock {
    fn start() -> Self {
        Clock { last: Instant::now(), laps: Map::new() }
    }

    /// Ends a step and records its time.
    fn lap(&mut self, step: &str) {
        let now = Instant::now();
        let spent = u64::try_from((now - self.last).as_micros()).unwrap_or(u64::MAX);
        self.laps.insert(step.to_owned(), spent.into());
        self.last = now;
    }
}
