//! Results of replayed scenes.

use std::path::PathBuf;

use serde_json::Value;

use super::cause::Cause;
use crate::expectation::Mismatch;
use ninebit::diagnostic::ErrorKind;
use ninebit::shown;
use ninebit_files::catch_panic::Panic;
use ninebit_report::SideBySideLine;
use ninebit_scene::diff::{self, CHANNELS, histogram_text, pixels, share};

/// Result of a replayed scene.
#[derive(Clone, Debug)]
pub struct SceneReplay {
    /// Name in reports: [`Entry::name`](super::Entry::name).
    pub name: String,
    /// The scene's file, or the expectation if it has no scene.
    pub path: PathBuf,
    /// Outcome of the comparison.
    pub outcome: Outcome,
    /// Problems with pictures and other files that could not be written.
    pub unwritten: Vec<Problem>,
}

/// Outcome of a scene.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// The picture is as expected.
    Match,
    /// The expectation was written.
    Blessed {
        /// The previous digest, if there was one.
        before: Option<String>,
        /// The new digest.
        after: String,
    },
    /// The scene was not drawn, with the reason.
    Skipped(String),
    /// The picture differs.
    Differs(Box<Difference>),
    /// The scene could not be compared.
    Failed(Problem),
}

/// Origin of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProblemKind {
    /// The scene, or one of its files.
    Scene(ErrorKind),
    /// An output that was not written.
    Output,
    /// A fault of this program.
    Internal,
}

/// Reason why something could not be done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Origin, which determines the exit status.
    pub kind: ProblemKind,
    /// Error code, as `docs/errors.md` lists it.
    pub code: &'static str,
    /// Message in one line.
    pub message: String,
    /// Full message of several lines.
    pub text: String,
    /// Line and column in the scene's file, from 1.
    pub place: Option<(usize, usize)>,
}

impl From<ErrorKind> for ProblemKind {
    fn from(kind: ErrorKind) -> ProblemKind {
        ProblemKind::Scene(kind)
    }
}

impl Problem {
    /// Returns a problem with advice to the user.
    pub(super) fn new(
        kind: impl Into<ProblemKind>,
        code: &'static str,
        message: impl Into<String>,
        help: &str,
    ) -> Self {
        let message = message.into();
        let text = format!("error[{code}]: {message}\n  help: {help}");
        Problem { kind: kind.into(), code, message, text, place: None }
    }

    /// Returns the problem for a fault of this program.
    pub(super) fn internal(panic: &Panic) -> Self {
        Problem::new(ProblemKind::Internal, Panic::CODE, panic.to_string(), Panic::HELP)
    }

    /// Returns the exit status of the problem.
    pub fn exit_code(&self) -> u8 {
        match self.kind {
            ProblemKind::Scene(kind) => kind.exit_code(),
            ProblemKind::Internal => 6,
            ProblemKind::Output => 7,
        }
    }
}

/// Text for a difference whose expected picture is not known.
const ONLY_DIGEST: &str = "\
Only the digest of the expected picture is known, so it cannot be said where it differs. `--expected` takes a folder of
pictures of an earlier run, `picture` in the expectation a file.
";

/// Difference between a scene and its expectation.
#[derive(Clone, Debug)]
pub struct Difference {
    /// Name of the target.
    pub target: String,
    /// The expected digest.
    pub expected: String,
    /// Digest of the drawn picture, with masked pixels set to 0.
    pub drawn: String,
    /// The mismatch that the comparison found.
    pub mismatch: Mismatch,
    /// The single change that yields the expected picture, if one was found.
    pub cause: Option<Cause>,
    /// Comparison with the expected picture, if it is known.
    pub known: Option<Comparison>,
    /// The drawn picture as PNG.
    pub picture: Vec<u8>,
    /// Further remarks for people, one line each.
    pub remarks: Vec<String>,
}

/// Origin of an expected picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The file of the picture.
    File(PathBuf),
    /// The picture was drawn with a [`Cause`] that yields the expected digest.
    Cause,
}

/// Comparison of the expected picture with the drawn one.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Origin of the expected picture.
    pub origin: Origin,
    /// The drawn picture minus the expected one.
    pub difference: diff::Difference,
    /// The first differing pixel, row by row.
    pub first: Pixel,
    /// Expected picture, drawn picture and amplified difference side by side, as PNG.
    pub panels: Vec<u8>,
    /// Amplification of the difference.
    pub scale: u8,
    /// Traces of the first differing pixel.
    pub traces: Option<Traces>,
}

/// A pixel that differs between two pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel {
    /// Column, 0 on the left.
    pub x: u32,
    /// Row, 0 at the top.
    pub y: u32,
    /// Expected R, G, B, A.
    pub expected: [u8; 4],
    /// Drawn R, G, B, A.
    pub drawn: [u8; 4],
}

/// Traces of a pixel as drawn and as expected.
#[derive(Clone, Debug)]
pub struct Traces {
    /// Both traces as text, or only that of the drawn pixel if no change yields the expected one.
    pub text: String,
    /// Both traces side by side; empty if only one is known.
    pub lines: Vec<SideBySideLine>,
    /// Trace of the drawn pixel as JSON.
    pub drawn: Value,
    /// Trace of the expected pixel as JSON, if known.
    pub expected: Option<Value>,
}

impl Difference {
    /// Returns a summary in one line.
    pub fn verdict(&self) -> String {
        let mut text = match (&self.known, &self.mismatch) {
            (Some(known), _) => {
                let Pixel { x, y, expected, drawn } = known.first;
                let (different, all) = (known.difference.different, known.difference.pixels());
                let (part, largest) = (share(different, all), known.difference.largest());
                let (expected, drawn, all) = (color(expected), color(drawn), pixels(all));
                format!(
                    "{different} of {all} ({part}), by {largest} at most; first {x},{y}: {expected} expected, {drawn} drawn"
                )
            }
            (None, Mismatch::Digest { .. }) => {
                format!("digest {} expected, {} drawn", short_digest(&self.expected), short_digest(&self.drawn))
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

    /// Returns the full description in several lines.
    pub fn text(&self) -> String {
        self.described(str::to_owned)
    }

    /// Returns the same with a few KB of the traces: from where they part on, or of one trace the end.
    pub fn brief(&self) -> String {
        self.described(excerpt)
    }

    fn described(&self, traced: fn(&str) -> String) -> String {
        let mut text = format!("{}\n\n", self.verdict());
        let (target, expected) = (shown::name(&self.target), shown::name(&self.expected));
        text += &format!("target    {target}\nexpected  {expected}\ndrawn     {}\n", self.drawn);
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
                    text += &format!("\n{}", traced(&traces.text));
                }
            }
            None if matches!(self.mismatch, Mismatch::Size { .. } | Mismatch::Depth { .. }) => {}
            None => text += ONLY_DIGEST,
        }
        text
    }
}

/// Bytes of a trace in a brief description.
const BRIEF: usize = 4000;

/// Returns the part of a trace's text that says most: its first line, and what follows the first line that differs (`>`) under its heading; without
/// one, the end.
fn excerpt(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let Some((head, rest)) = lines.split_first() else { return String::new() };
    let fits = |lines: &mut dyn Iterator<Item = &&str>| {
        let mut bytes = 0;
        lines
            .take_while(|line| {
                bytes += line.len() + 1;
                bytes <= BRIEF
            })
            .count()
    };
    let heading = |line: &&str| line.starts_with("  ") && !line.starts_with("   ") && !line.starts_with("  >");
    let (from, to) = match rest.iter().position(|line| line.starts_with("  >")) {
        Some(parted) => {
            let from = rest[..parted].iter().rposition(heading).unwrap_or(parted);
            // Of a long block the line itself, at least.
            let from = if fits(&mut rest[from..=parted].iter()) > parted - from { from } else { parted };
            (from, from + fits(&mut rest[from..].iter()))
        }
        None => (rest.len() - fits(&mut rest.iter().rev()), rest.len()),
    };
    let left = |count: usize, what: &str| match count {
        0 => String::new(),
        count => format!("... {count} lines {what}\n"),
    };
    let kept: String = rest[from..to].iter().map(|line| format!("{line}\n")).collect();
    let after = left(rest.len() - to, "more, which `--report html=FILE` and `--artifacts DIR` have");
    format!("{head}\n{}{kept}{after}", left(from, "before, which `--report html=FILE` and `--artifacts DIR` have"))
}

/// Formats a colour for reports.
pub(super) fn color([r, g, b, a]: [u8; 4]) -> String {
    format!("R {r} G {g} B {b} A {a}")
}

/// Returns the first twelve digits of a digest.
pub(super) fn short_digest(digest: &str) -> String {
    digest.chars().take(12).collect()
}

impl SceneReplay {
    /// Returns the outcome in one word.
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

    /// Returns a message in one line, made printable by [shown]; empty for a match.
    pub fn message(&self) -> String {
        let message = match &self.outcome {
            Outcome::Match => String::new(),
            Outcome::Blessed { before: None, after } => format!("digest {}, none before", short_digest(after)),
            Outcome::Blessed { before: Some(before), after } => {
                format!("digest {}, {} before", short_digest(after), short_digest(before))
            }
            Outcome::Skipped(reason) => reason.clone(),
            Outcome::Differs(difference) => difference.verdict(),
            Outcome::Failed(problem) => format!("{} {}", problem.code, problem.message),
        };
        shown::name(&message).into_owned()
    }

    /// Returns the exit status of the scene.
    pub fn exit_code(&self) -> u8 {
        let outcome = match &self.outcome {
            Outcome::Match | Outcome::Blessed { .. } | Outcome::Skipped(_) => 0,
            Outcome::Differs(_) => 1,
            Outcome::Failed(problem) => problem.exit_code(),
        };
        self.unwritten.iter().map(Problem::exit_code).max().unwrap_or(0).max(outcome)
    }
}

/// Numbers of scenes by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Summary {
    /// Number of all scenes.
    pub(crate) scenes: usize,
    /// Number of scenes that are as expected.
    pub(crate) matching: usize,
    /// Number of expectations that were written.
    pub(crate) blessed: usize,
    /// Number of scenes that were not drawn.
    pub(crate) skipped: usize,
    /// Number of scenes that differ.
    pub(crate) differing: usize,
    /// Number of scenes that failed.
    pub(crate) failed: usize,
}

impl Summary {
    /// Counts the outcomes.
    pub(crate) fn from_replays(all: &[SceneReplay]) -> Self {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brief_trace_begins_where_the_traces_part() {
        let block = |name: &str, mark: char| {
            let lines: String = (0..100).map(|n| format!("  {mark} {name}.step{n}  1  2\n")).collect();
            format!("  {name}\n{lines}")
        };
        let text = format!("pixel 1,2: both\n{}{}{}", block("first", ' '), block("second", '>'), block("third", ' '));
        let brief = excerpt(&text);
        assert!(brief.len() < BRIEF + 300, "{}", brief.len());
        let lines: Vec<&str> = brief.lines().collect();
        assert_eq!((lines[0], lines[2], lines[3]), ("pixel 1,2: both", "  second", "  > second.step0  1  2"));
        assert!(lines[1].starts_with("... 101 lines before") && brief.contains("lines more"), "{brief}");
        // Of one trace the end says how the stored word came to be.
        let one = text.replace('>', " ");
        let brief = excerpt(&one);
        assert!(brief.len() < BRIEF + 300 && brief.ends_with("    third.step99  1  2\n"), "{brief}");
        assert_eq!(excerpt("a\nb\n"), "a\nb\n");
    }
}
