//! The command `ninebit captures`: frames of the chip compared with what the model draws.

mod export;

use super::*;
use std::fmt::Write;

use ninebit::plan::PlanError;
use ninebit::threads::on_threads;
use ninebit_captures::verdict::{self, Verdict, WrongPicture};
use ninebit_captures::{Frame, SOURCE};
use rayon::prelude::*;

/// Frames of a real NV2A, drawn again.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// List all captured suites: how many frames each has, and how many of these are drawn here, exactly or not
    List,
    /// Draw captured frames and compare them with the captures
    ///
    /// No picture is needed: a table has the digest of every captured frame, without the text that the programs printed into it. With the pictures,
    /// which anybody may have (CC0), the pixels that differ are shown.
    ///
    /// Exit status 0: all frames are exact, but for those of which the table says that a rule is open; 1: others differ, or one of those
    /// differs otherwise; 4: a picture is missing.
    Check(CheckArguments),
    /// Write a captured frame as a scene, with the files of its textures
    ///
    /// The scene draws what the program drew, in its own folder: `ninebit render` and `ninebit inspect` show it. Its path is printed.
    Export(export::ExportArguments),
}

#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    /// Draw this suite only; may be given several times
    #[arg(long = "suite", value_name = "SUITE")]
    suites: Vec<String>,
    /// Draw about so many frames only: of each suite as large a part, at least one
    #[arg(long, value_name = "COUNT")]
    sample: Option<usize>,
    /// The folder `results` of the captures: compare with its pictures, SUITE/FRAME.png
    #[arg(long, value_name = "DIR")]
    captures: Option<PathBuf>,
    #[command(flatten)]
    policies: PolicyArguments,
    #[command(flatten)]
    engine: EngineArguments,
    /// How to print the result
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = Format::Text)]
    format: Format,
}

/// Runs a subcommand.
pub(crate) fn run(command: &Command) -> Result<(), Failure> {
    match command {
        Command::List => list(),
        Command::Check(arguments) => check(arguments),
        Command::Export(arguments) => export::export(arguments),
    }
}

fn frames(suites: &[&str]) -> Result<Vec<Frame>, Failure> {
    ninebit_captures::frames(suites).map_err(|unmatched| Failure::fault(&unmatched.to_string()))
}

fn list() -> Result<(), Failure> {
    let all = frames(&[])?;
    let mut text = format!("source  {SOURCE}\n\n{:<34}captured   drawn   exact\n", "suite");
    let mut line = |suite: &str, captured: usize, drawn: &[&Frame]| {
        let exact = drawn.iter().filter(|frame| frame.open.is_none()).count();
        let _ = writeln!(text, "{suite:<34}{captured:>8}{:>8}{exact:>8}", drawn.len());
    };
    for (suite, captured) in ninebit_captures::captured() {
        line(suite, captured, &all.iter().filter(|frame| frame.suite == suite).collect::<Vec<_>>());
    }
    line("all", ninebit_captures::captured().map(|(_, captured)| captured).sum(), &all.iter().collect::<Vec<_>>());
    Ok(write_text(&text)?)
}

fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    if let Some([error, help]) = verdict::unknown_suite(&arguments.suites) {
        return Err(Failure::usage(error, help));
    }
    let suites: Vec<&str> = arguments.suites.iter().map(String::as_str).collect();
    let options = RenderOptions { threads: 1, ..arguments.engine.options()? };
    let policies = arguments.policies.policies()?;
    let verdicts: Vec<Verdict> = on_threads(arguments.engine.threads, || {
        let mut frames = frames(&suites)?;
        if let Some(count) = arguments.sample {
            frames = ninebit_captures::sample(frames, count);
        }
        let captures = arguments.captures.as_deref();
        let drawn = frames.into_par_iter().map(|frame| draw(frame, &options, policies, captures));
        drawn.collect::<Result<_, Failure>>()
    })?;
    let has_captures = arguments.captures.is_some();
    arguments.format.print(|| verdict::text(&verdicts, has_captures), || format!("{:#}", report(&verdicts)))?;
    if verdicts.iter().all(Verdict::is_as_known) { Ok(()) } else { Err(Failure::difference()) }
}

/// Returns the failure of a frame that cannot be planned.
fn planned(frame: &Frame, errors: &[PlanError]) -> Failure {
    let errors: Vec<String> = errors.iter().map(ToString::to_string).collect();
    Failure::fault(&format!("{}/{}: {}", frame.suite, frame.name, errors.join("; ")))
}

fn draw(frame: Frame, options: &RenderOptions, policies: Policies, folder: Option<&Path>) -> Result<Verdict, Failure> {
    let pixels = frame.render(options, policies).map_err(|errors| planned(&frame, &errors))?;
    let path = folder.map(|folder| verdict::path(folder, &frame));
    let capture = path.as_ref().map(|path| image::load(path, &ImageLimits::default())).transpose()?;
    let wrong = |WrongPicture(message)| Failure::invalid(WrongPicture::CODE, message, WrongPicture::HELP);
    Verdict::new(frame, pixels, path.as_deref().zip(capture.as_ref())).map_err(wrong)
}

fn report(verdicts: &[Verdict]) -> serde_json::Value {
    let frame = |verdict: &Verdict| {
        let frame = &verdict.frame;
        json!({
            "suite": frame.suite,
            "frame": frame.name,
            "compared_pixels": frame.compared(),
            "exact": verdict.exact,
            "open": frame.open.map(|open| json!({ "rule": open.rule, "pixels": open.pixels })),
            "differing_pixels": verdict.difference.as_ref().map(|(difference, _)| difference.different),
        })
    };
    json!({
        "format": "ninebit-captures-1",
        "version": env!("CARGO_PKG_VERSION"),
        "source": SOURCE,
        "frames": verdicts.iter().map(frame).collect::<Vec<_>>(),
    })
}
