//! What became of a scene.

use std::path::PathBuf;

use serde_json::Value;

use super::cause::Cause;
use crate::expectation::Mismatch;
use ninebit::diagnostic::ErrorKind;
use ninebit::shown;
use ninebit_files::catch_panic::Panic;
use ninebit_report::SideBySideLine;
use ninebit_scene::diff::{self, CHANNELS, histogram_text, pixels, share};

/// A scene that was replayed.
#[derive(Clone, Debug)]
pub struct Replayed {
    /// What reports call it: [`Entry::name`](super::Entry::name).
    pub name: String,
    /// The scene's file; of an expectation without scene that one.
    pub path: PathBuf,
    /// What became of it.
    pub outcome: Outcome,
    /// Pictures and other files of it that could not be written.
    pub unwritten: Vec<Problem>,
}

/// What becomes of a scene.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// It shows what is expected.
    Match,
    /// Its expectation was written.
    Blessed {
        /// The digest that stood there, if there was one.
        before: Option<String>,
        /// The digest that stands there now.
        after: String,
    },
    /// It was not drawn, and why.
    Skipped(String),
    /// It shows something else.
    Differs(Box<Difference>),
    /// Nothing can be said about what it shows.
    Failed(Problem),
}

/// Whose problem it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProblemKind {
    /// The scene's, or that of a file of it.
    Scene(ErrorKind),
    /// An output's, which was not written.
    Output,
    /// A fault of this program.
    Internal,
}

/// Why something could not be done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// What a caller does about it.
    pub kind: ProblemKind,
    /// The code of `docs/errors.md`.
    pub code: &'static str,
    /// What is wrong, in one line.
    pub message: String,
    /// All there is to say, several lines.
    pub text: String,
    /// Line and column of the scene's file, from 1.
    pub place: Option<(usize, usize)>,
}

impl Problem {
    /// A problem with something to do about it.
    pub(super) fn new(kind: ErrorKind, code: &'static str, message: impl Into<String>, help: &str) -> Self {
        let message = message.into();
        let text = format!("error[{code}]: {message}\n  help: {help}");
        Problem { kind: ProblemKind::Scene(kind), code, message, text, place: None }
    }

    /// A fault of this program.
    pub(super) fn internal(panic: &Panic) -> Self {
        let (code, message) = (Panic::CODE, panic.to_string());
        let text = format!("error[{code}]: {message}\n  help: {}", Panic::HELP);
        Problem { kind: ProblemKind::Internal, code, message, text, place: None }
    }

    /// Exit status that goes with it.
    pub fn exit_code(&self) -> u8 {
        match self.kind {
            ProblemKind::Scene(kind) => kind.exit_code(),
            ProblemKind::Internal => 6,
            ProblemKind::Output => 7,
        }
    }
}

/// What there is to say where the expected picture is not known.
const ONLY_DIGEST: &str = "\
Only the digest of the expected picture is known, so it cannot be said where it differs. `--expected` takes a folder of
pictures of an earlier run, `picture` in the expectation a file.
";

/// How a scene differs from what is expected.
#[derive(Clone, Debug)]
pub struct Difference {
    /// Name of the target.
    pub target: String,
    /// The digest that is expected.
    pub expected: String,
    /// The digest of what is compared of the picture that was drawn.
    pub drawn: String,
    /// What the expectation says.
    pub mismatch: Mismatch,
    /// The one change that yields what is expected.
    pub cause: Option<Cause>,
    /// What the expected picture shows, where it is known.
    pub known: Option<Known>,
    /// The picture that was drawn, a PNG.
    pub picture: Vec<u8>,
    /// Something else that is worth saying.
    pub remarks: Vec<String>,
}

/// Where an expected picture comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The picture that the expectation names.
    File(PathBuf),
    /// It was drawn in another way, which yields the expected digest.
    Cause,
}

/// An expected picture and the drawn one beside each other.
#[derive(Clone, Debug)]
pub struct Known {
    /// Where the expected picture comes from.
    pub origin: Origin,
    /// The drawn picture less the expected one.
    pub difference: diff::Difference,
    /// The first pixel that differs, in reading order.
    pub first: Pixel,
    /// Expected, drawn and amplified difference in one picture, a PNG.
    pub panels: Vec<u8>,
    /// How often the difference is amplified.
    pub scale: u8,
    /// How the first pixel came to be.
    pub traces: Option<Traces>,
}

/// A pixel of two pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel {
    /// Column, 0 on the left.
    pub x: u32,
    /// Row, 0 at the top.
    pub y: u32,
    /// R, G, B, A that are expected.
    pub expected: [u8; 4],
    /// R, G, B, A that were drawn.
    pub drawn: [u8; 4],
}

/// How a pixel came to be, and how it comes to be as expected.
#[derive(Clone, Debug)]
pub struct Traces {
    /// Both as one text; or only the first, where it is not known how the expected pixel comes to be.
    pub text: String,
    /// Both side by side; empty if only one is known.
    pub lines: Vec<SideBySideLine>,
    /// The trace of the drawn pixel as a document.
    pub drawn: Value,
    /// The trace of the expected one.
    pub expected: Option<Value>,
}

impl Difference {
    /// One line that says it all.
    pub fn verdict(&self) -> String {
        let mut text = match (&self.known, &self.mismatch) {
            (Some(known), _) => {
                let (difference, first) = (&known.difference, &known.first);
                format!(
                    "{} of {} ({}), by {} at most; first {},{}: {} expected, {} drawn",
                    difference.different,
                    pixels(difference.pixels()),
                    share(difference.different, difference.pixels()),
                    difference.largest(),
                    first.x,
                    first.y,
                    color(first.expected),
                    color(first.drawn),
                )
            }
            (None, Mismatch::Digest { .. }) => {
                format!("digest {} expected, {} drawn", short(&self.expected), short(&self.drawn))
            }
            (None, mismatch) => mismatch.to_string(),
        };
        match &self.cause {
            Some(cause) => text += &format!("; {cause}"),
            None if self.known.is_some() => text += "; no single policy explains it",
            None => {}
        }
        text
    }

    /// All there is to say, several lines.
    pub fn text(&self) -> String {
        let mut text = format!("{}\n\n", self.verdict());
        text += &format!(
            "target    {}\nexpected  {}\ndrawn     {}\n",
            shown::name(&self.target),
            shown::name(&self.expected),
            self.drawn
        );
        for remark in &self.remarks {
            text += &format!("{}\n", shown::name(remark));
        }
        match &self.known {
            Some(known) => {
                if let Origin::File(path) = &known.origin {
                    text += &format!("the expected picture is {}\n", shown::path(path));
                }
                let channels: Vec<_> = CHANNELS.into_iter().zip(&known.difference.channels).collect();
                text += &format!("\ndrawn less expected, in pixels:\n{}", histogram_text("difference", &channels));
                if let Some(traces) = &known.traces {
                    text += &format!("\n{}", traces.text);
                }
            }
            None if matches!(self.mismatch, Mismatch::Size { .. } | Mismatch::Depth { .. }) => {}
            None => text += ONLY_DIGEST,
        }
        text
    }
}

/// A colour as reports write it.
pub(super) fn color([r, g, b, a]: [u8; 4]) -> String {
    format!("R {r} G {g} B {b} A {a}")
}

/// The beginning of a digest.
pub(super) fn short(digest: &str) -> String {
    digest.chars().take(12).collect()
}

impl Replayed {
    /// What became of it, in a word.
    pub fn status(&self) -> &'static str {
        match &self.outcome {
            Outcome::Match => "match",
            Outcome::Blessed { .. } => "blessed",
            Outcome::Skipped(_) => "skipped",
            Outcome::Differs(_) => "differs",
            Outcome::Failed(problem) if problem.kind == ProblemKind::Scene(ErrorKind::Missing) => "missing",
            Outcome::Failed(_) => "failed",
        }
    }

    /// What there is to say about it in one [shown] line; empty for a match.
    pub fn message(&self) -> String {
        let message = match &self.outcome {
            Outcome::Match => String::new(),
            Outcome::Blessed { before: None, after } => format!("digest {}, none before", short(after)),
            Outcome::Blessed { before: Some(before), after } => {
                format!("digest {}, {} before", short(after), short(before))
            }
            Outcome::Skipped(reason) => reason.clone(),
            Outcome::Differs(difference) => difference.verdict(),
            Outcome::Failed(problem) => format!("{} {}", problem.code, problem.message),
        };
        shown::name(&message).into_owned()
    }

    /// Exit status that goes with it.
    pub fn exit_code(&self) -> u8 {
        let outcome = match &self.outcome {
            Outcome::Match | Outcome::Blessed { .. } | Outcome::Skipped(_) => 0,
            Outcome::Differs(_) => 1,
            Outcome::Failed(problem) => problem.exit_code(),
        };
        self.unwritten.iter().map(Problem::exit_code).max().unwrap_or(0).max(outcome)
    }
}

/// How many scenes ended in which way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// All scenes that were replayed.
    pub scenes: usize,
    /// Scenes that show what is expected.
    pub matching: usize,
    /// Expectations that were written.
    pub blessed: usize,
    /// Scenes that were not drawn, for want of files that are not handed out.
    pub skipped: usize,
    /// Not as expected.
    pub differing: usize,
    /// Refused, or without something that they need.
    pub failed: usize,
}

impl Summary {
    /// Counts how often each outcome occurs.
    pub fn from_replays(all: &[Replayed]) -> Self {
        let mut summary = Summary { scenes: all.len(), ..Summary::default() };
        for one in all {
            *match &one.outcome {
                Outcome::Match => &mut summary.matching,
                Outcome::Blessed { .. } => &mut summary.blessed,
                Outcome::Skipped(_) => &mut summary.skipped,
                Outcome::Differs(_) => &mut summary.differing,
                Outcome::Failed(_) => &mut summary.failed,
            } += 1;
        }
        summary
    }
}

impl std::fmt::Display for Summary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {} as expected", shown::count(self.scenes as u64, "scene"), self.matching)?;
        for (count, what) in [
            (self.differing, "different"),
            (self.failed, "failed"),
            (self.blessed, "blessed"),
            (self.skipped, "skipped"),
        ] {
            if count > 0 {
                write!(f, ", {count} {what}")?;
            }
        }
        Ok(())
    }
}
