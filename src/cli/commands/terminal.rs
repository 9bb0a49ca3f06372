//! Colour and progress on stderr.

use std::io::{IsTerminal, Write, stderr};
use std::time::Duration;

use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use ninebit::shown;

use super::exit::Report;

/// When to colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ColorChoice {
    /// On a terminal, unless NO_COLOR is set or TERM is `dumb`.
    #[default]
    Auto,
    /// Even into files and pipes.
    Always,
    /// Not even on a terminal.
    Never,
}

impl ColorChoice {
    /// Returns whether messages on stderr are coloured.
    pub(crate) fn on_stderr(self) -> bool {
        let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        match self {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            ColorChoice::Auto => {
                stderr().is_terminal() && !set("NO_COLOR") && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
            }
        }
    }

    /// Converts the choice for the command line parser.
    pub(crate) fn for_clap(self) -> clap::ColorChoice {
        match self {
            ColorChoice::Auto => clap::ColorChoice::Auto,
            ColorChoice::Always => clap::ColorChoice::Always,
            ColorChoice::Never => clap::ColorChoice::Never,
        }
    }
}

/// Severity of a message on stderr.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Level {
    /// `error`, in bold red.
    Error,
    /// `warning`, in bold yellow.
    Warning,
    /// `note`, in bold green.
    Note,
}

/// Prints a report to stderr. Errors of stderr are ignored.
pub(crate) fn print(level: Level, report: &Report, color: bool) {
    let text = match report {
        Report::Silent => return,
        Report::Text(text) => format!("{}\n", text.trim_end()),
        Report::Scene(error) => format!("{}\n", error.render(color).trim_end()),
        Report::Message { code, message, help } => {
            let (word, paint) = match level {
                Level::Error => ("error", "\x1b[1;31m"),
                Level::Warning => ("warning", "\x1b[1;33m"),
                Level::Note => ("note", "\x1b[1;32m"),
            };
            let code = code.map_or(String::new(), |code| format!("[{code}]"));
            let (paint, reset) = if color { (paint, "\x1b[0m") } else { ("", "") };
            let help = help.as_ref().map_or(String::new(), |help| format!("  help: {help}\n"));
            format!("{paint}{word}{code}{reset}: {}\n{help}", shown::lines(message))
        }
    };
    let _ = stderr().lock().write_all(text.as_bytes());
}

/// A progress bar on stderr. It stays invisible if stderr is no terminal, and for short work.
pub(crate) struct Progress {
    bar: ProgressBar,
    started: std::time::Instant,
}

/// Time before the bar appears.
const PATIENCE: Duration = Duration::from_millis(400);

impl Progress {
    /// Returns a bar that is still invisible.
    pub(crate) fn new(what: &'static str, color: bool) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        let template = if color {
            "{msg} [{bar:40.cyan}] {percent}% {eta} left"
        } else {
            "{msg} [{bar:40}] {percent}% {eta} left"
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.set_message(what);
        Progress { bar, started: std::time::Instant::now() }
    }

    /// Sets the progress. May be called from any thread.
    pub(crate) fn report(&self, done: u64, total: u64) {
        if self.bar.is_hidden() && stderr().is_terminal() && self.started.elapsed() > PATIENCE {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_length(total);
        self.bar.set_position(done);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
