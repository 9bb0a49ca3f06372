//! The command line. Data goes to stdout and everything else to stderr; the exit status says what kind of thing happened.

mod arguments;
mod bench;
mod captures;
mod chart;
mod check;
mod compare;
mod cost;
mod diff;
mod engine;
mod exit;
mod explain;
mod export;
mod gallery;
mod generate;
mod import;
mod inspect;
mod limits;
mod lower;
mod measure;
mod op;
mod picture;
mod planes;
mod policies;
mod program_file;
mod registers;
mod render;
mod replay;
mod rule;
mod scene;
mod score;
mod signals;
mod terminal;
mod texture;
mod trace;
mod vectors;

use std::ffi::OsString;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::builder::PossibleValuesParser;
use clap::error::{ContextKind, ContextValue};
use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use ninebit::engine::RenderOptions;
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::shown;
use ninebit::state::{Draw, Named, Policies, Profile, Scene};
use ninebit_files::catch_panic::catch_panic;
use ninebit_files::files;
use ninebit_files::output::{Compression, Destination, OutputError, encode_png, write_json, write_text};
use ninebit_scene::SceneError;
use ninebit_scene::image::{self, ImageLimits, Rgba};
use serde::Serialize;
use serde_json::json;

use arguments::{Context, Format, FormatArguments, named, one_of, up_to};
use cost::Cost;
use engine::EngineArguments;
use exit::{Exit, Failure, Report};
use program_file::ProgramArguments;
use scene::{PolicyArguments, SceneArguments, StateArguments, WorkArguments, chosen_target, load_to_draw};
use terminal::{ColorChoice, Level, Progress};

/// A deterministic, bit-accurate fixed-point model of GeForce-256-class texture units and register combiners
#[derive(Debug, Parser)]
#[command(name = "ninebit", version, after_help = exit::HELP, max_term_width = 100)]
struct Cli {
    /// Colour on stderr: on a terminal unless NO_COLOR is set, or always, or never
    #[arg(long, global = true, value_enum, default_value_t = ColorChoice::Auto, hide_possible_values = true, display_order = 900, value_name = "auto|always|never")]
    color: ColorChoice,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Check a scene without rendering it, and print what it costs
    Check(check::Arguments),
    /// Render a scene to a PNG
    Render(render::Arguments),
    /// Print how one pixel came to be, integer by integer
    Trace(trace::Arguments),
    /// Write values that traces name as arrays, of all pixels of a picture
    ///
    /// Without names it lists those that the scene has. The file is one of NumPy, for `numpy.load`: of each name an array of rows, columns, and channels
    /// where the name stands for several.
    Planes(planes::Arguments),
    /// Write a page that shows a scene in any browser: click a pixel, see its integers, change a stage
    ///
    /// The page holds the scene, its textures and the model itself as WebAssembly. It needs no network and no server.
    Inspect(inspect::Arguments),
    /// Write a site of scenes: an index of pictures with filters, each of which opens in the inspector
    ///
    /// The site needs no network and no server. What its pages share, the model above all, is one file. A scene is called as the comment at its head says
    /// before a colon, `// A lit ring: ...`, or as its file.
    Gallery(gallery::Arguments),
    /// Compare a scene with float64 arithmetic of the vendor's real-number text
    Compare(compare::Arguments),
    /// Measure how far pictures are from what they ought to show, why, and what they cost the chip
    ///
    /// Each scene says in its `truth` which light, eye, material and surface are meant; the truth is the lighting equation in float64, per pixel.
    Measure(measure::Arguments),
    /// Make scenes of a log of a real program: methods of the Xbox's 3D class, as emulators, tracers and recompilers print them
    ///
    /// State is followed from the first line on; each frame becomes a scene. A draw that needs something that neither the log nor the memory has is
    /// marked incomplete, with the reason. Without `-o` and `--explain` only counts are printed. Nothing is invented: a white texel stands for a texture that was not recorded.
    Import(import::Arguments),
    /// Write a scene as methods of the Xbox's 3D class, with the memory that they read
    ///
    /// `ninebit import` makes the same picture of them. Vertices are those that reach the rasteriser. Several scenes become one program for a console,
    /// whose answers `ninebit vectors compare` tells.
    Export(export::Arguments),
    /// Print the plan of a scene: what each draw computes, what is left out and why, what it costs
    Explain(explain::Arguments),
    /// Print pixel programs in another form: as text, as register words, or as functions of C, GLSL, WGSL or Verilog
    ///
    /// A function takes what a pixel brings and yields the stored word, or the fragment, in integers that are exactly the chip's.
    Lower(lower::Arguments),
    /// Print pixel programs as register words, each with its meaning
    Registers(registers::Arguments),
    /// Compare two pictures: where they differ, by how much, and how those pixels came to be
    ///
    /// The comparison is exact. Differing pixels that touch, corners included, are one region. With a scene, it is also said which of
    /// the pictures equals the scene's frame, and the first pixel of each listed region is traced.
    ///
    /// Exit status 0: the pictures are equal; 1: they differ.
    Diff(diff::Arguments),
    /// Run one operation of the chip on given integers, without a scene
    #[command(subcommand)]
    Op(op::Command),
    /// Describe a texture, or write what a texture unit reads of it
    Texture(texture::Arguments),
    /// Conformance vectors: tables of what the units of the chip yield
    #[command(subcommand)]
    Vectors(vectors::Command),
    /// Frames of a real NV2A, drawn again and compared with the captures
    #[command(subcommand)]
    Captures(captures::Command),
    /// Score pictures of another renderer, and name the rules that explain what differs
    ///
    /// Each frame is exact, off by one, or wrong. Wrong frames are drawn again with known shortcuts of other renderers; a pixel is explained where the rules
    /// yield the chip's bytes, and the shortcuts the other renderer's. Text that the programs printed is not compared, nor is alpha.
    ///
    /// Exit status 0: whatever differs, unless `--at-least` asks for more; 1: fewer frames are exact than that; 3: there are no pictures.
    Score(score::Arguments),
    /// Replay scenes: draw each and compare it with the expectation beside it
    ///
    /// Exit status: that of the worst scene, the highest number. 0: all are as expected; 1: one differs; 3: one is invalid; 4: something is
    /// missing, such as an expectation; 5: a limit; 6: an internal error in one; 7: a report or picture was not written.
    Replay(replay::Arguments),
    /// Print a rule of the chip: formula, grade, source, code, units; or list all rules
    Rule(rule::Arguments),
    /// List the rules that have alternatives, and their values
    Policies,
    /// List the limits that scenes are held to
    Limits,
    /// Time how long scenes take to draw
    Bench(bench::Arguments),
    /// Measure every technique afresh: pages and charts of speed, accuracy, and where methods fail
    ///
    /// Scenes are those with a truth in folders, each of which is a family; a number at the end of a file's name is the technique's
    /// parameter. Written are `speed-accuracy.md`, its pictures and data, and the section of `stability.md` on where methods fail.
    Chart(chart::Arguments),
    /// Make textures: height fields, normal maps, cube maps of vectors, tables of powers
    #[command(subcommand)]
    Generate(generate::Command),
}

/// Runs the program.
pub fn main() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    signals::install();
    files::watch();
    let exit = guarded(wanted_color(&arguments).on_stderr(), || run(&arguments));
    ExitCode::from(exit as u8)
}

/// Parses the arguments and runs the command. Does not catch panics.
pub(crate) fn run(arguments: &[OsString]) -> Exit {
    let color = wanted_color(arguments);
    let matches = Cli::command().color(color.for_clap()).try_get_matches_from(arguments);
    let cli = match matches.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(error) => {
            let end = scene_as_command(&error).unwrap_or_else(|| print_parser_message(&error, arguments));
            return finish(end, color.on_stderr());
        }
    };
    let context = Context { color: cli.color.on_stderr() };
    let result = match cli.command {
        Command::Check(arguments) => check::run(&arguments, context),
        Command::Render(arguments) => render::run(&arguments, context),
        Command::Trace(arguments) => trace::run(&arguments, context),
        Command::Planes(arguments) => planes::run(&arguments, context),
        Command::Inspect(arguments) => inspect::run(&arguments, context),
        Command::Gallery(arguments) => gallery::run(&arguments, context),
        Command::Compare(arguments) => compare::run(&arguments, context),
        Command::Measure(arguments) => measure::run(&arguments, context),
        Command::Import(arguments) => import::run(&arguments, context),
        Command::Export(arguments) => export::run(&arguments, context),
        Command::Explain(arguments) => explain::run(&arguments, context),
        Command::Lower(arguments) => lower::run(&arguments, context),
        Command::Registers(arguments) => registers::run(&arguments, context),
        Command::Diff(arguments) => diff::run(&arguments, context),
        Command::Op(command) => op::run(&command, context),
        Command::Texture(arguments) => texture::run(&arguments, context),
        Command::Vectors(command) => vectors::run(&command),
        Command::Captures(command) => captures::run(&command),
        Command::Score(arguments) => score::run(&arguments, context),
        Command::Replay(arguments) => replay::run(&arguments, context),
        Command::Rule(arguments) => rule::run(&arguments),
        Command::Policies => policies::run(),
        Command::Limits => limits::run(),
        Command::Bench(arguments) => bench::run(&arguments, context),
        Command::Chart(arguments) => chart::run(&arguments, context),
        Command::Generate(command) => generate::run(&command),
    };
    finish(result, context.color)
}

/// Returns the exit status of a command, and prints its failure to stderr.
fn finish(result: Result<(), Failure>, color: bool) -> Exit {
    match result {
        Ok(()) => Exit::Success,
        Err(Failure { exit, report }) => {
            terminal::print(Level::Error, &report, color);
            exit
        }
    }
}

/// Returns the failure of a command line that names a scene where a command belongs.
fn scene_as_command(error: &clap::Error) -> Option<Result<(), Failure>> {
    let Some(ContextValue::String(given)) = error.get(ContextKind::InvalidSubcommand) else { return None };
    let path = Path::new(given);
    let is_scene = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ron"));
    (is_scene || path.is_file()).then(|| {
        let similar = if path.exists() { None } else { ninebit_scene::path::similar(path) };
        let meant = similar.map_or_else(|| path.to_path_buf(), |name| path.with_file_name(name));
        let picture = shown::path(&meant.with_extension("png"));
        let help = match is_scene {
            true => format!("did you mean `ninebit render {} -o {picture}`?", shown::path(&meant)),
            false => "`ninebit --help` lists the commands".to_owned(),
        };
        Err(Failure::usage(format!("`{}` names a file, not a command", shown::path(path)), help))
    })
}

/// Prints the parser's message: help to stdout, errors to stderr.
fn print_parser_message(error: &clap::Error, arguments: &[OsString]) -> Result<(), Failure> {
    let plain = |argument: &OsString| *shown::path(Path::new(argument)) == *argument.as_os_str();
    let printed = if arguments.iter().all(plain) {
        error.print()
    } else {
        // Colours are lost together with the characters that must not be printed.
        let text = error.render().to_string();
        let text = shown::lines(&text);
        if error.use_stderr() {
            std::io::stderr().write_all(text.as_bytes())
        } else {
            std::io::stdout().write_all(text.as_bytes())
        }
    };
    if error.use_stderr() {
        return Err(Failure { exit: Exit::Usage, report: exit::Report::Silent });
    }
    let flushed = printed.and_then(|()| std::io::stdout().flush());
    Ok(flushed.map_err(|source| OutputError::Stdout { source })?)
}

/// Runs `work`. A panic becomes a message that says how to report it.
fn guarded(color: bool, work: impl FnOnce() -> Exit) -> Exit {
    catch_panic(work).unwrap_or_else(|panic| finish(Err(panic.into()), color))
}

/// Returns the value of `--color`. It is found before the arguments are parsed, because it also applies to the parser's errors.
fn wanted_color(arguments: &[OsString]) -> ColorChoice {
    let mut choice = ColorChoice::Auto;
    let mut texts = arguments.iter().skip(1).map(|argument| argument.to_string_lossy());
    while let Some(text) = texts.next() {
        let value = match text.strip_prefix("--color") {
            _ if text == "--" => break,
            Some("") => texts.next(),
            Some(rest) => rest.strip_prefix('=').map(|value| value.to_owned().into()),
            None => None,
        };
        if let Some(Ok(given)) = value.map(|value| ColorChoice::from_str(&value, false)) {
            choice = given;
        }
    }
    choice
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn a_panic_is_an_internal_error() {
        let exit = guarded(false, || {
            std::thread::scope(|scope| scope.spawn(|| panic!("a test")).join()).expect("the worker panicked");
            Exit::Success
        });
        assert_eq!((exit, exit as u8), (Exit::Internal, 6));
    }

    #[test]
    fn colour_is_known_before_parsing() {
        let choice = |texts: &[&str]| wanted_color(&texts.iter().map(OsString::from).collect::<Vec<_>>());
        assert_eq!(choice(&["ninebit", "check", "--color", "never"]), ColorChoice::Never);
        assert_eq!(choice(&["ninebit", "--color=always", "check"]), ColorChoice::Always);
        assert_eq!(choice(&["ninebit", "check", "--color=sometimes"]), ColorChoice::Auto);
        assert_eq!(choice(&["ninebit", "check", "--", "--color=always"]), ColorChoice::Auto);
        assert_eq!(choice(&["ninebit", "--colors=always", "--color"]), ColorChoice::Auto);
    }
}
