//! Report as text.

use std::fmt::Write;

use crate::replay::{Outcome, SceneReplay, Summary};
use ninebit::shown;

/// Returns one line for each scene that is not as expected, the full messages of those that failed, and the counts.
pub fn text(all: &[SceneReplay]) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write(&mut out, all);
    out
}

fn write(out: &mut String, all: &[SceneReplay]) -> std::fmt::Result {
    for one in all {
        match &one.outcome {
            Outcome::Match => {}
            Outcome::Failed(problem) => {
                writeln!(out, "{:8} {}", one.status(), shown::path(&one.path))?;
                for line in shown::lines(&problem.text).lines() {
                    writeln!(out, "{}", format!("    {line}").trim_end())?;
                }
            }
            _ => writeln!(out, "{:8} {}: {}", one.status(), shown::path(&one.path), one.message())?,
        }
        for problem in &one.unwritten {
            writeln!(out, "{:8} {} {}", "", problem.code, shown::name(&problem.message))?;
        }
    }
    writeln!(out, "{}", Summary::from_replays(all))
}
