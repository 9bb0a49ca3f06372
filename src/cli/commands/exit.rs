//! Exit statuses and failures of commands.

use std::path::Path;

use ninebit::shown;
use ninebit_files::catch_panic::Panic;
use ninebit_files::output::OutputError;
use ninebit_scene::SceneError;
use ninebit_scene::image::ImageError;

/// Exit status of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Exit {
    /// Everything is as expected.
    Success = 0,
    /// A comparison found a difference.
    Difference = 1,
    /// The command line is wrong.
    Usage = 2,
    /// A scene or one of its assets is invalid.
    Invalid = 3,
    /// A file that is needed does not exist.
    Missing = 4,
    /// A limit was exceeded.
    Limit = 5,
    /// A fault of this program.
    Internal = 6,
    /// The output was not written.
    Output = 7,
}

impl Exit {
    /// Returns the exit with a status code, or [`Exit::Internal`] if there is none.
    pub(crate) fn from_code(code: u8) -> Self {
        use Exit::{Difference, Internal, Invalid, Limit, Missing, Output, Success, Usage};
        let all = [Success, Difference, Usage, Invalid, Missing, Limit, Output];
        all.into_iter().find(|exit| *exit as u8 == code).unwrap_or(Internal)
    }
}

/// Help text about exit statuses.
pub(crate) const HELP: &str = "Exit status:
  0  as expected
  1  a difference was found
  2  the command line is wrong
  3  a scene or an asset is invalid
  4  a needed file is missing
  5  a limit was exceeded (see `ninebit limits`)
  6  internal error
  7  the output was not written";

/// Reason why a command stopped: its message for stderr and its exit status.
#[derive(Debug)]
pub(crate) struct Failure {
    /// Exit status of the process.
    pub(crate) exit: Exit,
    /// Message for stderr.
    pub(crate) report: Report,
}

/// Message for stderr.
#[derive(Debug)]
pub(crate) enum Report {
    /// No message: the exit status is enough, or something was printed already.
    Silent,
    /// Finished text, ready to print.
    Text(String),
    /// All errors of a scene.
    Scene(Box<SceneError>),
    /// A message with its code and advice.
    Message {
        /// Error code: `NB` and four digits.
        code: Option<&'static str>,
        /// The message: one line, or several lines that were made printable by [shown].
        message: String,
        /// Advice in one line.
        help: Option<String>,
    },
}

impl Failure {
    /// Returns the failure of a comparison that found a difference, which was reported on stdout.
    pub(crate) fn difference() -> Self {
        Failure { exit: Exit::Difference, report: Report::Silent }
    }

    /// Returns the failure for an invalid input.
    pub(crate) fn invalid(code: &'static str, message: impl Into<String>, help: impl Into<String>) -> Self {
        Failure { exit: Exit::Invalid, report: Report::message(Some(code), &message.into(), &help.into()) }
    }

    /// Returns the failure for a fault of this program.
    pub(crate) fn fault(message: &str) -> Self {
        let help = "please report it, with the command line";
        Failure { exit: Exit::Internal, report: Report::message(Some("NB0801"), message, help) }
    }

    /// Returns the failure for a scene of which nothing can be measured.
    pub(crate) fn unseen(scene: &Path) -> Self {
        let help = "look at the picture: is the mesh in view, and drawn into the first target?";
        Failure::invalid("NB0395", format!("no pixel of `{}` that has a truth is drawn", shown::path(scene)), help)
    }

    /// Returns the failure for an invalid command line.
    pub(crate) fn usage(message: impl Into<String>, help: impl Into<String>) -> Self {
        Failure { exit: Exit::Usage, report: Report::message(None, &message.into(), &help.into()) }
    }
}

impl Report {
    /// Returns a message of one line, whatever names it contains.
    pub(crate) fn message(code: Option<&'static str>, message: &str, help: &str) -> Self {
        let help = Some(shown::name(help).into_owned());
        Report::Message { code, message: shown::name(message).into_owned(), help }
    }

    /// Returns the text without colour.
    pub(crate) fn plain(&self) -> String {
        match self {
            Report::Silent => String::new(),
            Report::Text(text) => text.clone(),
            Report::Scene(error) => error.render(false),
            Report::Message { code, message, .. } => code.map_or(String::new(), |code| format!("{code} ")) + message,
        }
    }
}

impl From<Panic> for Failure {
    fn from(panic: Panic) -> Self {
        Failure { exit: Exit::Internal, report: Report::message(Some(Panic::CODE), &panic.to_string(), Panic::HELP) }
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        if error.is_broken_pipe() {
            // The reader has closed the pipe, which is no error.
            return Failure { exit: Exit::Success, report: Report::Silent };
        }
        let exit = if error.is_refused() { Exit::Usage } else { Exit::Output };
        Failure { exit, report: Report::message(Some(error.code()), &error.to_string(), error.help()) }
    }
}

impl From<ImageError> for Failure {
    fn from(error: ImageError) -> Self {
        let exit = match &error {
            e if e.is_limit() => Exit::Limit,
            e if e.is_missing() => Exit::Missing,
            _ => Exit::Invalid,
        };
        // The library's advice is about images that scenes name; here the command line names them.
        let help = if error.is_missing() { ninebit_scene::path::advice(error.path()) } else { error.help().to_owned() };
        Failure { exit, report: Report::message(Some(error.code()), &error.to_string(), &help) }
    }
}
