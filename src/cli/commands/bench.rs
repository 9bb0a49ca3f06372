//! The command `ninebit bench`: times of rendering scenes.
#![allow(clippy::float_arithmetic, reason = "times")]

use super::*;
use std::fmt::Write;
use std::time::Instant;

use ninebit::engine::Renderer;
use ninebit::threads;
use ninebit_files::read::page;

use super::scene::{SceneFailure, each};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scene files; expectations (`*.expect.ron`) among them are passed over
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    state: StateArguments,
    #[command(flatten)]
    engine: EngineArguments,
    #[command(flatten)]
    work: WorkArguments,
    /// Frames that are timed of each scene
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: u32,
    #[command(flatten)]
    format: FormatArguments,
}

/// Measurements of a scene.
#[derive(Debug, Serialize)]
struct Measurement {
    scene: String,
    /// Name of the engine.
    engine: &'static str,
    /// Number of covered pixels of all draws.
    shaded_pixels: u64,
    frames: u32,
    /// Time of reading, checking and planning.
    load_microseconds: f64,
    /// Time of decoding textures, compiling draws and starting threads.
    prepare_microseconds: f64,
    /// Time of the draws of a frame, without the clear.
    frame_microseconds: Spread,
    /// The same per shaded pixel. A pixel counts once for each draw that shades it.
    ns_per_shaded_pixel: Spread,
    /// Share of pixels that the scalar engine drew for the fast one.
    scalar_share: f64,
    /// Peak resident memory of the process while the scene was measured, if the system reports it.
    peak_memory_bytes: Option<u64>,
}

/// Distribution of times.
#[derive(Clone, Copy, Debug, Serialize)]
struct Spread {
    least: f64,
    p10: f64,
    median: f64,
    p90: f64,
}

impl Spread {
    /// Computes the distribution of times in ascending order, at least one, each multiplied by a factor.
    fn from_times(times: &[f64], factor: f64) -> Spread {
        let at = |tenths: usize| factor * times[(times.len() - 1) * tenths / 10];
        Spread { least: at(0), p10: at(1), median: at(5), p90: at(9) }
    }
}

#[derive(Debug, Serialize)]
struct Document {
    format: &'static str,
    version: &'static str,
    /// The requested engine.
    engine: &'static str,
    isa: &'static str,
    threads: usize,
    scenes: Vec<Measurement>,
    failed: Vec<SceneFailure>,
}

/// Draws each scene many times and prints how long that takes.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let options = arguments.engine.options()?;
    let mut isa = "";
    let is_scene = |path: &&PathBuf| !path.to_string_lossy().ends_with(".expect.ron");
    let scenes: Vec<&Path> = arguments.scenes.iter().filter(is_scene).map(PathBuf::as_path).collect();
    if scenes.is_empty() {
        return Err(Failure::usage(
            "nothing to measure",
            "expectations (`*.expect.ron`) are no scenes; name the scene",
        ));
    }
    let measured = each(&scenes, context, |path| {
        // Resets the peak of resident memory where the system allows it; elsewhere earlier scenes count.
        let _ = std::fs::write("/proc/self/clear_refs", "5");
        let mut last = Instant::now();
        let mut lap = || {
            let now = Instant::now();
            let spent = now.duration_since(last).as_secs_f64() * 1e6;
            last = now;
            spent
        };
        let (_, plan) = load_to_draw(path, &arguments.state, arguments.work, context)?;
        let load_microseconds = lap();
        let renderer = Renderer::new(&plan, &options);
        let prepare_microseconds = lap();
        isa = renderer.isa().name();
        let (mut frames, statistics) = renderer.render();
        let shaded_pixels: u64 = statistics.shaded_pixels.iter().sum();
        lap();
        let mut times: Vec<f64> = (0..arguments.frames)
            .map(|_| {
                // Against the depths of the frame before, most fragments would fail.
                renderer.clear(&mut frames);
                lap();
                renderer.redraw(&mut frames);
                lap()
            })
            .collect();
        times.sort_by(f64::total_cmp);
        Ok(Measurement {
            scene: shown::lossless(path),
            engine: renderer.engine().name(),
            shaded_pixels,
            frames: arguments.frames,
            load_microseconds,
            prepare_microseconds,
            frame_microseconds: Spread::from_times(&times, 1.0),
            ns_per_shaded_pixel: Spread::from_times(&times, 1e3 / (shaded_pixels.max(1) as f64)),
            scalar_share: statistics.scalar_pixels as f64 / (shaded_pixels.max(1) as f64),
            peak_memory_bytes: peak_memory(),
        })
    });
    let end = measured.end();
    let document = Document {
        format: "ninebit-bench-1",
        version: env!("CARGO_PKG_VERSION"),
        engine: options.engine.name(),
        isa,
        threads: threads::count(options.threads),
        scenes: measured.made,
        failed: measured.failed,
    };
    if !document.scenes.is_empty() {
        let json = || serde_json::to_string_pretty(&document).unwrap_or_default();
        arguments.format.get().print(|| text(&document), json)?;
    }
    end
}

/// Returns the peak resident memory in bytes, or `None` if the system does not report it.
fn peak_memory() -> Option<u64> {
    let status = page(Path::new("/proc/self/status"))?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1024 * line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?)
}

fn text(document: &Document) -> String {
    let Document { engine, isa, threads, .. } = document;
    let threads = shown::count(*threads as u64, "thread");
    let mut text = format!(
        "engine {engine}, {isa}, {threads}. ns a shaded pixel: median (10 % of the frames below, 90 % below).\n\
         {:>10} {:>10} {:>10} {:>10} {:>22}  scene\n",
        "pixels", "ms set-up", "MB peak", "ms a frame", "ns a pixel"
    );
    for measured in &document.scenes {
        let pixel = measured.ns_per_shaded_pixel;
        let spread = format!("{:.3} ({:.3}, {:.3})", pixel.median, pixel.p10, pixel.p90);
        let peak = measured.peak_memory_bytes.map_or_else(|| "-".to_owned(), |n| format!("{:.1}", n as f64 / 1e6));
        let set_up = (measured.load_microseconds + measured.prepare_microseconds) / 1e3;
        let (frame, pixels) = (measured.frame_microseconds.median / 1e3, measured.shaded_pixels);
        let scene = shown::name(&measured.scene);
        let _ = writeln!(text, "{pixels:>10} {set_up:>10.3} {peak:>10} {frame:>10.3} {spread:>22}  {scene}");
        if measured.scalar_share > 0.0 {
            let _ = writeln!(text, "{:>66}  by the scalar engine: {:.3} %", "", 100.0 * measured.scalar_share);
        }
    }
    text
}
