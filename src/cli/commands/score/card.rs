//! The tables of a report in Markdown, for pages of others.

use std::fmt::Write;

use ninebit_score::Run;

use super::{percent, thousands};

/// A cause is named beside a suite if it has so much of the suite's explained pixels, in percent.
const NAMED: u64 = 1;

/// Returns a row for each run, and one for each suite of the last run that the model draws, those with the most wrong pixels first.
pub(super) fn card(runs: &[Run]) -> String {
    let mut text =
        String::from("| pictures | frames | exact | off by one | wrong pixels |\n|---|---:|---:|---:|---:|\n");
    for run in runs {
        let total = run.total();
        let counts = [total.frames, total.exact, total.off_by_one].map(thousands).join(" | ");
        let (wrong, compared) = (thousands(total.pixels.wrong), thousands(total.pixels.compared));
        let _ = writeln!(text, "| {} | {counts} | {wrong} of {compared} |", run.name);
    }
    let Some((run, causes)) = runs.last().and_then(|run| Some((run, run.causes.as_ref()?))) else { return text };
    text += "\n| suite | wrong pixels | explained | causes |\n|---|---:|---:|---|\n";
    let mut suites: Vec<(&str, (u64, u64))> = run.suites().into_keys().map(|s| (s, run.explained_of(s))).collect();
    suites.retain(|(_, (_, wrong))| *wrong > 0);
    suites.sort_by_key(|(_, (_, wrong))| std::cmp::Reverse(*wrong));
    for (suite, (explained, wrong)) in suites {
        let named = run.causes_of(suite).into_iter().filter(|(_, pixels)| pixels * 100 >= explained * NAMED);
        let names: Vec<String> = named.map(|(n, _)| format!("`{}`", causes.causes[n].variant.names())).collect();
        let share = percent(explained, wrong);
        let _ = writeln!(text, "| {suite} | {} | {share} | {} |", thousands(wrong), names.join(", "));
    }
    let (explained, wrong) = (causes.explained(), causes.wrong);
    let _ = writeln!(text, "| all | {} | {} | |", thousands(wrong), percent(explained, wrong));
    text
}
