//! The program `ninebit-gpu`: draws scenes on a GPU. Data goes to stdout, messages to stderr.

mod captures;

use std::ffi::OsStr;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::{Args, Parser, Subcommand, ValueEnum};
use cpu_time::ProcessTime;
use ninebit::engine::{self, RenderOptions, render};
use ninebit::frame::Frames;
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::shown;
use ninebit::state::{Policies, Scene};
use ninebit_files::catch_panic::catch_panic;
use ninebit_files::files;
use ninebit_files::output::{Compression, Destination, encode_png, write_text};
use ninebit_gpu::{Failure, Gpu, Renderer, Text, adapters, description, difference};
use walkdir::WalkDir;

/// Draws scenes of ninebit on a GPU, by the rules printed as WGSL: with the words of `ninebit render`
#[derive(Debug, Parser)]
#[command(name = "ninebit-gpu", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Render a scene to a PNG
    Render {
        /// The scene file
        scene: PathBuf,
        /// The picture, a PNG; `-` is stdout
        #[arg(short, long, value_name = "FRAME.png")]
        output: PathBuf,
        /// Which render target to write [default: the scene's first]
        #[arg(long, value_name = "NAME")]
        target: Option<String>,
        #[command(flatten)]
        drawing: Drawing,
        #[command(flatten)]
        chosen: EngineChoice,
    },
    /// Time how long scenes take to draw, by the GPU and by our engine
    ///
    /// Times are the least of all frames. A frame is cleared and drawn; set-up, which prints and compiles shaders and fills buffers, comes before. `cpu` is the time that the threads of this
    /// process take for a frame: all of it with a driver that runs on the CPU.
    Bench {
        /// The scene files
        #[arg(required = true, value_name = "SCENE")]
        scenes: Vec<PathBuf>,
        /// Frames of each scene
        #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=10_000))]
        frames: u32,
        /// Threads of our engine; 0 takes all cores
        #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=256))]
        threads: u16,
        #[command(flatten)]
        drawing: Drawing,
        #[command(flatten)]
        chosen: EngineChoice,
    },
    /// Draw scenes by the GPU and by our engine, and compare every stored word
    ///
    /// Exit status: that of the worst scene. 0: all are equal; 1: one differs; 3: one is invalid, or not printed.
    Replay {
        /// Scene files, and folders of which every scene is taken
        #[arg(required = true, value_name = "DIR|SCENE")]
        places: Vec<PathBuf>,
        #[command(flatten)]
        drawing: Drawing,
    },
    /// Draw captured frames of a real NV2A by the GPU, and compare every stored word with our engine's and the frames with the captures
    ///
    /// Exit status 0: all words are equal, and all frames exact, but for those of which the table says that a rule is open; 1: others differ.
    Captures(captures::Arguments),
    /// List the adapters of this machine
    Adapters,
}

/// What draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Engine {
    /// A GPU, by printed shaders
    Gpu,
    /// Our engine on the CPU
    Cpu,
}

/// The choice of what draws.
#[derive(Debug, Args)]
struct EngineChoice {
    /// What draws
    #[arg(long, value_enum, value_name = "ENGINE", default_value_t = Engine::Gpu)]
    engine: Engine,
}

impl EngineChoice {
    /// Opens the adapter, unless our engine draws.
    fn open(&self, drawing: &Drawing) -> Result<Option<Gpu>, Failure> {
        (self.engine == Engine::Gpu).then(|| drawing.open()).transpose()
    }
}

/// Options for drawing.
#[derive(Debug, Args)]
struct Drawing {
    /// The adapter: its number, or a part of its name [default: the first that `adapters` lists]
    #[arg(long, value_name = "NAME|INDEX")]
    adapter: Option<String>,
    /// Choose an alternative of a rule; `ninebit policies` lists them
    #[arg(long = "policy", value_name = "RULE=VALUE")]
    policies: Vec<String>,
    /// Draw every draw by one text, which reads its state as words: `ninebit lower --generic --whole --to wgsl`
    #[arg(long)]
    generic: bool,
}

impl Drawing {
    /// Opens the adapter and says which.
    fn open(&self) -> Result<Gpu, Failure> {
        let gpu = Gpu::open(self.adapter.as_deref())?;
        say(&format!("note: drawn by {}\n", gpu.name));
        Ok(gpu)
    }

    /// Returns the text that draws.
    fn text(&self) -> Text {
        if self.generic { Text::OfEveryDraw } else { Text::OfDraw }
    }

    /// Returns the chosen alternatives.
    fn policies(&self) -> Result<Policies, Failure> {
        let mut policies = Policies::DEFAULT;
        for policy in &self.policies {
            let help = "`ninebit policies` lists the rules and their values";
            policies.set(policy).map_err(|error| Failure::usage(error.to_string(), help))?;
        }
        Ok(policies)
    }

    /// Reads and plans a scene.
    fn load(&self, path: &Path) -> Result<(Scene, Plan), Failure> {
        let policies = self.policies()?;
        let loaded = ninebit_scene::load(path, &Limits::default())?;
        say(&loaded.render_warnings(false));
        loaded.affordable(Limits::default().shaded_pixels)?;
        Ok((loaded.scene, loaded.plan.under(policies)))
    }
}

/// Writes a text to stderr, whose errors are ignored.
fn say(text: &str) {
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

fn main() -> ExitCode {
    files::watch();
    let cli = Cli::parse();
    let done = catch_panic(|| run(&cli.command)).unwrap_or_else(|panic| Err(panic.into()));
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            say(&failure.text());
            ExitCode::from(failure.exit())
        }
    }
}

fn run(command: &Command) -> Result<(), Failure> {
    match command {
        Command::Render { scene, output, target, drawing, chosen } => {
            picture(scene, output.as_os_str(), target.as_deref(), (drawing, chosen))
        }
        Command::Bench { scenes, frames, threads, drawing, chosen } => {
            bench(scenes, *frames, *threads, (drawing, chosen))
        }
        Command::Replay { places, drawing } => replay(places, drawing),
        Command::Captures(arguments) => captures::run(arguments),
        Command::Adapters => list(),
    }
}

/// Prints the adapters.
fn list() -> Result<(), Failure> {
    let all = adapters();
    if all.is_empty() {
        // Says what to install.
        return Gpu::open(None).map(|_| ());
    }
    let text: String = all.iter().enumerate().map(|(n, adapter)| format!("{n}: {}\n", description(adapter))).collect();
    Ok(write_text(&text)?)
}

/// Renders a scene.
fn picture(
    path: &Path,
    output: &OsStr,
    target: Option<&str>,
    (drawing, chosen): (&Drawing, &EngineChoice),
) -> Result<(), Failure> {
    let (scene, plan) = drawing.load(path)?;
    let destination = Destination::from(output);
    destination.check()?;
    let index = scene.targets.iter().position(|of| target.is_none_or(|name| of.name == name)).ok_or_else(|| {
        let names: Vec<_> = scene.targets.iter().map(|target| shown::name(&target.name)).collect();
        let message = format!("there is no target `{}`", shown::name(target.unwrap_or_default()));
        Failure::usage(message, format!("the scene has {}", names.join(", ")))
    })?;
    let frames = match chosen.open(drawing)? {
        Some(gpu) => drawn(&gpu, &scene, &plan, drawing.text())?,
        None => by_engine(&plan),
    };
    let surface = &frames.surfaces[index];
    let png = encode_png(surface.width, surface.height, &surface.rgba8(), Compression::Fast)?;
    Ok(destination.write(&png)?)
}

/// Draws a scene by the GPU.
fn drawn(gpu: &Gpu, scene: &Scene, plan: &Plan, text: Text) -> Result<Frames, Failure> {
    let plan = text.plan(scene, plan)?;
    let renderer = Renderer::new(gpu, scene, &plan, text)?;
    renderer.draw()?;
    renderer.frames()
}

/// Draws a scene by our engine.
fn by_engine(plan: &Plan) -> Frames {
    render(plan, &RenderOptions { threads: 0, ..RenderOptions::default() })
}

/// Times frames of the GPU. Returns set-up, and of a frame the time and that of the CPU, in milliseconds.
fn time_of_gpu(gpu: &Gpu, scene: &Scene, plan: &Plan, (text, frames): (Text, u32)) -> Result<[f64; 3], Failure> {
    let started = Instant::now();
    let plan = text.plan(scene, plan)?;
    let renderer = Renderer::new(gpu, scene, &plan, text)?;
    // The driver compiles at the first frame.
    renderer.draw()?;
    let set_up = milliseconds(started.elapsed());
    let times = (0..frames).map(|_| timed(|| renderer.draw())).collect::<Result<_, _>>()?;
    let [frame, cpu] = least(times);
    Ok([set_up, frame, cpu])
}

/// Times scenes.
fn bench(
    scenes: &[PathBuf],
    frames: u32,
    threads: u16,
    (drawing, chosen): (&Drawing, &EngineChoice),
) -> Result<(), Failure> {
    let gpu = chosen.open(drawing)?;
    let mut text = format!(
        "the least of {frames} frames, {}\n{:>10} {:>10} {:>10} {:>10} {:>10} {:>10} {:>8}  scene\n",
        gpu.as_ref().map_or("our engine alone", |gpu| &gpu.name),
        "pixels",
        "ms set-up",
        "ms a frame",
        "cpu ms",
        "engine ms",
        "cpu ms",
        "times"
    );
    for path in &self::scenes(scenes) {
        let (scene, plan) = drawing.load(path)?;
        let of_gpu = gpu.as_ref().map(|gpu| time_of_gpu(gpu, &scene, &plan, (drawing.text(), frames))).transpose()?;
        let engine =
            engine::Renderer::new(&plan, &RenderOptions { threads: threads.into(), ..RenderOptions::default() });
        let (mut surfaces, statistics) = engine.render();
        let mut engine_times = Vec::new();
        for _ in 0..frames {
            engine_times.push(timed(|| {
                engine.clear(&mut surfaces);
                engine.redraw(&mut surfaces);
                Ok(())
            })?);
        }
        let [engine_frame, engine_cpu] = least(engine_times);
        let pixels: u64 = statistics.shaded_pixels.iter().sum();
        text += &format!("{pixels:>10} ");
        text += &match of_gpu {
            Some([set_up, frame, cpu]) => format!("{set_up:>10.1} {frame:>10.3} {cpu:>10.3}"),
            None => format!("{:>10} {:>10} {:>10}", "-", "-", "-"),
        };
        let times = of_gpu.map_or("-".to_string(), |[_, frame, _]| format!("{:.2}", frame / engine_frame));
        text += &format!(" {engine_frame:>10.3} {engine_cpu:>10.3} {times:>8}  {}\n", shown::path(path));
    }
    Ok(write_text(&text)?)
}

/// Runs some work. Returns how long it took, and how much of the CPU's time.
fn timed(work: impl FnOnce() -> Result<(), Failure>) -> Result<[Duration; 2], Failure> {
    let cpu = ProcessTime::try_now().ok();
    let started = Instant::now();
    work()?;
    Ok([started.elapsed(), cpu.and_then(|cpu| cpu.try_elapsed().ok()).unwrap_or_default()])
}

fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

/// Returns the least of both times, in milliseconds: other programs only add to them.
fn least(times: Vec<[Duration; 2]>) -> [f64; 2] {
    [0, 1].map(|n| times.iter().map(|time| milliseconds(time[n])).fold(f64::INFINITY, f64::min))
}

/// Compares scenes with the engine's.
fn replay(places: &[PathBuf], drawing: &Drawing) -> Result<(), Failure> {
    let scenes = scenes(places);
    if scenes.is_empty() {
        let (message, help) = ("there are no scenes here", "a scene is a file NAME.ron; look at the folder's name");
        return Err(Failure::Message { code: Some("NB1201"), exit: 4, message: message.into(), help: help.into() });
    }
    let gpu = drawing.open()?;
    let (mut equal, mut worst) = (0, 0);
    for path in &scenes {
        let name = shown::path(path);
        match catch_panic(|| compared(path, &gpu, drawing)).unwrap_or_else(|panic| Err(panic.into())) {
            Ok(None) => equal += 1,
            Ok(Some(text)) => {
                write_text(&format!("{name} differs\n{text}"))?;
                worst = worst.max(1);
            }
            Err(failure) => {
                say(&format!("{name}: {}", failure.text()));
                worst = worst.max(failure.exit());
            }
        }
    }
    write_text(&format!("{equal} of {} equal the engine's\n", shown::count(scenes.len() as u64, "scene")))?;
    if worst > 0 { Err(Failure::Printed(worst)) } else { Ok(()) }
}

/// Draws a scene twice. Returns what differs.
fn compared(path: &Path, gpu: &Gpu, drawing: &Drawing) -> Result<Option<String>, Failure> {
    let (scene, plan) = drawing.load(path)?;
    Ok(difference(&plan, &by_engine(&plan), &drawn(gpu, &scene, &plan, drawing.text())?))
}

/// Returns the scenes of places: files, and those below folders. Expectations and families are none.
fn scenes(places: &[PathBuf]) -> Vec<PathBuf> {
    let ends = |path: &Path, end: &str| path.to_string_lossy().ends_with(end);
    let of = |place: &PathBuf| -> Vec<PathBuf> {
        if !place.is_dir() {
            return vec![place.clone()];
        }
        let below = WalkDir::new(place).sort_by_file_name().into_iter().filter_map(Result::ok);
        below.map(|entry| entry.into_path()).filter(|path| ends(path, ".ron")).collect()
    };
    let is_scene = |path: &PathBuf| !ends(path, ".expect.ron") && !ends(path, ".family.ron");
    places.iter().flat_map(of).filter(is_scene).collect()
}
