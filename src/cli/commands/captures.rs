//! The command `ninebit captures`: frames of the chip compared with what the model draws.

mod export;

use super::*;
use std::collections::BTreeMap;
use std::fmt::Write;

use ninebit::plan::PlanError;
use ninebit::threads::on_threads;
use ninebit_captures::{Frame, SIZE, SOURCE};
use rayon::prelude::*;

use ninebit_scene::diff::{self, Difference, Options};

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

/// Maximum number of differing frames that are listed.
const SHOWN: usize = 20;

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

/// Result of a frame.
struct Outcome {
    frame: Frame,
    exact: bool,
    /// If the captured picture is available: the difference, and the first differing pixel as drawn and as captured.
    difference: Option<(Difference, [[u8; 4]; 2])>,
}

fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let known: Vec<&str> = ninebit_captures::suites().collect();
    if let Some(unknown) = arguments.suites.iter().find(|suite| !known.contains(&suite.as_str())) {
        let help = format!("the suites are {}", known.join(", "));
        return Err(Failure::usage(format!("there is no suite `{}`", shown::name(unknown)), help));
    }
    let suites: Vec<&str> = arguments.suites.iter().map(String::as_str).collect();
    let options = RenderOptions { threads: 1, ..arguments.engine.options()? };
    let policies = arguments.policies.policies()?;
    let outcomes: Vec<Outcome> = on_threads(arguments.engine.threads, || {
        let mut frames = frames(&suites)?;
        if let Some(count) = arguments.sample {
            frames = ninebit_captures::sample(frames, count);
        }
        let captures = arguments.captures.as_deref();
        let drawn = frames.into_par_iter().map(|frame| draw(frame, &options, policies, captures));
        drawn.collect::<Result<_, Failure>>()
    })?;
    let has_captures = arguments.captures.is_some();
    arguments.format.print(|| text(&outcomes, has_captures), || format!("{:#}", report(&outcomes)))?;
    if outcomes.iter().all(Outcome::is_as_known) { Ok(()) } else { Err(Failure::difference()) }
}

impl Outcome {
    /// Returns whether the frame is exact, or differs as the table says. Without the captured picture the number of differing pixels is unknown.
    fn is_as_known(&self) -> bool {
        match (self.frame.open, &self.difference) {
            (None, _) => self.exact,
            (Some(open), Some((difference, _))) => difference.different == open.pixels,
            (Some(_), None) => !self.exact,
        }
    }
}

/// Returns the failure of a frame that cannot be planned.
fn planned(frame: &Frame, errors: &[PlanError]) -> Failure {
    let errors: Vec<String> = errors.iter().map(ToString::to_string).collect();
    Failure::fault(&format!("{}/{}: {}", frame.suite, frame.name, errors.join("; ")))
}

fn draw(frame: Frame, options: &RenderOptions, policies: Policies, folder: Option<&Path>) -> Result<Outcome, Failure> {
    let pixels = frame.render(options, policies).map_err(|errors| planned(&frame, &errors))?;
    let mut outcome = Outcome { exact: frame.is(&pixels), difference: None, frame };
    let Some(folder) = folder else { return Ok(outcome) };
    let path = folder.join(outcome.frame.suite).join(format!("{}.png", outcome.frame.name));
    let capture = image::load(&path, &ImageLimits::default())?;
    let invalid = |message: String| {
        Failure::invalid("NB0524", message, "take the pictures of the source that `ninebit captures list` names")
    };
    if (capture.width(), capture.height()) != SIZE {
        return Err(invalid(format!("`{}` is {} x {}", shown::path(&path), capture.width(), capture.height())));
    }
    if !outcome.frame.is(capture.pixels()) {
        return Err(invalid(format!("`{}` is not the picture that was measured", shown::path(&path))));
    }
    // Printed letters are copied, so that they are equal.
    let mut masked = Rgba::new(SIZE.0, pixels);
    for at in outcome.frame.text.iter().flat_map(ninebit_captures::pixels) {
        let captured = capture.pixels()[at];
        if captured == ninebit_captures::LETTERS {
            masked.pixels_mut()[at] = captured;
        }
    }
    let difference = diff::compare(&masked, &capture, &Options { regions: 1, ..Options::default() });
    let difference = difference.map_err(|error| invalid(error.to_string()))?;
    outcome.exact = difference.different == 0;
    if let Some(region) = difference.regions.first() {
        let at = region.first.1 as usize * SIZE.0 as usize + region.first.0 as usize;
        outcome.difference = Some((difference, [masked.pixels()[at], capture.pixels()[at]]));
    }
    Ok(outcome)
}

fn text(outcomes: &[Outcome], has_captures: bool) -> String {
    let mut text = format!("{:<32}frames   exact         pixels\n", "suite");
    for suite in ninebit_captures::suites() {
        let of: Vec<&Outcome> = outcomes.iter().filter(|outcome| outcome.frame.suite == suite).collect();
        if of.is_empty() {
            continue;
        }
        let exact = of.iter().filter(|outcome| outcome.exact).count();
        let pixels: u64 = of.iter().map(|outcome| outcome.frame.compared()).sum();
        let _ = writeln!(text, "{suite:<32}{:>6}{exact:>8}{pixels:>15}", of.len());
    }
    let mut open = BTreeMap::<&str, (usize, u64)>::new();
    for known in outcomes.iter().filter(|outcome| outcome.is_as_known()).filter_map(|outcome| outcome.frame.open) {
        let of = open.entry(known.rule).or_default();
        *of = (of.0 + 1, of.1 + known.pixels);
    }
    for (rule, (frames, pixels)) in &open {
        let _ = writeln!(text, "open, {rule}: {}, {}", shown::count(*frames as u64, "frame"), diff::pixels(*pixels));
    }
    let differing: Vec<&Outcome> = outcomes.iter().filter(|outcome| !outcome.is_as_known()).collect();
    for Outcome { frame, difference, exact } in differing.iter().take(SHOWN) {
        let name = format!("{}/{}", frame.suite, frame.name);
        let _ = match difference {
            None if *exact => writeln!(text, "{name}: exact, and the table says that it is not"),
            None => writeln!(text, "{name}: another picture than the captured one"),
            Some((difference, [here, captured])) => {
                let (x, y) = difference.regions[0].first;
                let pixels = diff::pixels(difference.different);
                writeln!(text, "{name}: {pixels} differ; {x},{y} is {here:?}, captured {captured:?}")
            }
        };
    }
    if differing.len() > SHOWN {
        let _ = writeln!(text, "and {} more", differing.len() - SHOWN);
    }
    if !differing.is_empty() && !has_captures {
        text.push_str("with the captured pictures (`--captures DIR`) it is said which pixels\n");
    }
    let exact = outcomes.iter().filter(|outcome| outcome.exact).count();
    let _ = match differing.len() {
        0 if exact == outcomes.len() => writeln!(text, "{exact} frames: all exact"),
        0 => writeln!(text, "{} frames: {exact} exact, the others as known", outcomes.len()),
        count => writeln!(text, "{} frames: {count} differ", outcomes.len()),
    };
    text
}

fn report(outcomes: &[Outcome]) -> serde_json::Value {
    let frame = |outcome: &Outcome| {
        let frame = &outcome.frame;
        json!({
            "suite": frame.suite,
            "frame": frame.name,
            "compared_pixels": frame.compared(),
            "exact": outcome.exact,
            "open": frame.open.map(|open| json!({ "rule": open.rule, "pixels": open.pixels })),
            "differing_pixels": outcome.difference.as_ref().map(|(difference, _)| difference.different),
        })
    };
    json!({
        "format": "ninebit-captures-1",
        "version": env!("CARGO_PKG_VERSION"),
        "source": SOURCE,
        "frames": outcomes.iter().map(frame).collect::<Vec<_>>(),
    })
}
