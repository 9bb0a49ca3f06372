//! The command `ninebit vectors compare`: compares a card's results with a pack.

use super::*;

use ninebit_vectors::pack::Manifest;
use ninebit_vectors::results::compare::{self, Comparison, Explanation, UnitComparison};
use ninebit_vectors::results::{self, Device, waiver};
use serde_json::json;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The folder of the pack, or of the console's program, that was drawn
    #[arg(value_name = "PACK")]
    pack: PathBuf,
    /// The folder of results: an unpacked archive of vectors/harness/gl, or of a console's program
    #[arg(value_name = "RESULTS")]
    results: PathBuf,
    /// A file of differences that are known: unit, maximum, count, reason
    #[arg(long, value_name = "FILE")]
    waivers: Option<PathBuf>,
    /// Rows of a unit that are shown
    #[arg(long, value_name = "N", default_value_t = 3)]
    rows: usize,
    /// How to print the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Compares results with a pack.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(root) = scenes::root(&arguments.pack) {
        return compare_scenes(arguments, &root);
    }
    let waivers = arguments.waivers.as_deref().map(waiver::read).transpose()?.unwrap_or_default();
    let (manifest, tables) = pack::open(&arguments.pack)?;
    let results = results::open(&arguments.results, &manifest)?;
    let comparison = compare::compare(&tables, &results, &waivers, arguments.rows)?;
    let answers = scenes::compare(&arguments.pack, &arguments.results)?;
    let json = || {
        let value = json!({
            "format": "ninebit-comparison-1",
            "pack": manifest.root,
            "profile": manifest.profile,
            "level": manifest.level,
            "behaviour_rev": manifest.behaviour_rev,
            "device": results.device,
            "comparison": comparison,
            "scenes": scenes_json(&answers),
        });
        format!("{value:#}")
    };
    arguments.format.print(|| text(&manifest, &results.device, &comparison) + &scenes_text(&answers), json)?;
    end(comparison.is_clean(), &answers)
}

/// Compares what a console drew with the scenes of its program.
fn compare_scenes(arguments: &Arguments, root: &str) -> Result<(), Failure> {
    let device = results::device(&arguments.results, root)?;
    let answers = scenes::compare(&arguments.pack, &arguments.results)?;
    let json = || {
        let value = json!({
            "format": "ninebit-comparison-1",
            "pack": root,
            "device": device,
            "comparison": Comparison { units: Vec::new(), explanation: None },
            "scenes": scenes_json(&answers),
        });
        format!("{value:#}")
    };
    let text = || format!("{}scenes {root:.12}\n{}", device_text(&device), scenes_text(&answers));
    arguments.format.print(text, json)?;
    end(true, &answers)
}

fn end(is_clean: bool, answers: &[scenes::Answer]) -> Result<(), Failure> {
    if is_clean && answers.iter().all(|answer| answer.differing == 0) { Ok(()) } else { Err(Failure::difference()) }
}

fn scenes_json(answers: &[scenes::Answer]) -> serde_json::Value {
    let value = |answer: &scenes::Answer| json!({ "scene": answer.scene, "reading": answer.reading, "differing": answer.differing });
    answers.iter().map(value).collect()
}

fn device_text(device: &Device) -> String {
    [&device.vendor, &device.renderer, &device.version].map(|name| shown::name(name)).join(", ") + "\n"
}

fn scenes_text(answers: &[scenes::Answer]) -> String {
    let mut text = String::new();
    for scenes::Answer { scene, reading, differing } in answers {
        let count = if *differing > 0 { format!(", {differing} pixels differ") } else { String::new() };
        let _ = writeln!(text, "{scene:<24}{reading}{count}");
    }
    if text.is_empty() { text } else { format!("\nscenes\n{text}") }
}

fn text(manifest: &Manifest, device: &Device, comparison: &Comparison) -> String {
    let mut text = device_text(device);
    let (profile, level, revision) = (&manifest.profile, &manifest.level, manifest.behaviour_rev);
    let _ = writeln!(text, "{profile} {level}, behaviour {revision}, pack {:.12}\n", manifest.root);
    let _ = writeln!(
        text,
        "{:<24}{:>8}{:>8}{:>12}{:>8}{:>8}{:>8}{:>11}",
        "unit", "asked", "exact", "off by one", "worse", "errors", "waived", "not asked"
    );
    for unit in &comparison.units {
        let UnitComparison { asked, exact, off_by_one, worse, errors, waived, not_asked, .. } = unit;
        let _ = writeln!(
            text,
            "{:<24}{asked:>8}{exact:>8}{off_by_one:>12}{worse:>8}{errors:>8}{waived:>8}{not_asked:>11}",
            unit.unit
        );
    }
    for unit in comparison.units.iter().filter(|unit| unit.exact < unit.asked) {
        details(unit, &mut text);
    }
    match &comparison.explanation {
        Some(Explanation { policy, explains, breaks }) => {
            let _ = writeln!(
                text,
                "\n{policy} explains the most: {explains} rows that differ would not, {breaks} that agree would differ"
            );
        }
        None if comparison.units.iter().any(|unit| unit.exact < unit.asked) => {
            text.push_str("\nno other value of a policy explains more rows than it breaks\n");
        }
        None => text.push_str("\neverything that was asked is exact\n"),
    }
    text
}

/// Writes the differences of a unit.
fn details(unit: &UnitComparison, text: &mut String) {
    let differing = unit.asked - unit.exact;
    let _ = writeln!(text, "\n{}: {differing} of {} rows differ, by {} at most", unit.unit, unit.asked, unit.largest);
    if let Some(reason) = &unit.reason {
        let word = if unit.waived > 0 { "waived" } else { "beyond the waiver" };
        let _ = writeln!(text, "  {word}: {}", shown::name(reason));
    }
    let tags = unit.tags.iter().filter(|(_, share)| share.differ > 0);
    let tags: Vec<String> = tags.map(|(tag, share)| format!("{tag} {} of {}", share.differ, share.asked)).collect();
    let _ = writeln!(text, "  by tag: {}", tags.join(", "));
    for Explanation { policy, explains, breaks } in &unit.policies {
        let _ = writeln!(text, "  {policy} would explain {explains} and break {breaks}");
    }
    for row in &unit.rows {
        let differences =
            row.differences.iter().map(|(column, pack, found)| format!("{column} is {found}, not {pack}"));
        let mut differences = differences.collect::<Vec<_>>().join(", ");
        if differences.is_empty() {
            differences.push_str("the draw failed");
        }
        let _ = writeln!(text, "  row {} (line {}): {}", shown::name(&row.id), row.line, shown::name(&differences));
        let _ = writeln!(text, "    {}", row.row.join(" "));
    }
}
