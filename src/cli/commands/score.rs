//! The command `ninebit score`: pictures of another renderer against the chip's, and the rules that explain what differs.

mod badge;
mod card;
mod chart;
mod page;

use super::*;

use std::collections::{BTreeMap, HashSet};
use std::fmt::Write;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use ninebit::shortcut::Shortcuts;
use ninebit_files::output::write_below;
use ninebit_files::pending::PendingFolder;
use ninebit_handbook::{RULES, Rule};
use ninebit_scene::image::Rgba;
use ninebit_scene::write::{self, WriteOptions};
use ninebit_score::{Exhibit, Pictures, Run, Subject, captured, find, of_answers, of_scene};
use ninebit_vectors::{pack, results};
use serde_json::json;

use crate::replay::EntryKind;

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("against").required(true).args(["captures", "scenes", "pack"])))]
pub(crate) struct Arguments {
    /// The folder `results` of the captures: the chip's pictures, SUITE/FRAME.png
    #[arg(long, value_name = "DIR")]
    captures: Option<PathBuf>,
    /// A folder of scenes in place of the captures; what the model draws counts as right
    #[arg(long, value_name = "DIR")]
    scenes: Option<PathBuf>,
    /// A pack of vectors in place of the captures; results are folders that `ninebit-gl` wrote, a unit counts as a frame and a row as a pixel
    #[arg(long, value_name = "PACK")]
    pack: Option<PathBuf>,
    /// A folder of another renderer's pictures, SUITE/FRAME.png at any depth, or beside `--scenes` PATH/SCENE.png; may be given several times: the last folder is explained, those before are its history
    #[arg(long, value_name = "DIR", required = true)]
    results: Vec<PathBuf>,
    /// Score this suite only; may be given several times
    #[arg(long = "suite", value_name = "SUITE")]
    suites: Vec<String>,
    /// Leave out frames whose names contain this text, whatever its case; may be given several times
    #[arg(long, value_name = "TEXT")]
    without: Vec<String>,
    /// Write a report into this folder: `index.html` with pictures, `card.md` with its tables, `score.json`, `badge.svg`; an earlier report is replaced
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Look for no causes, which takes a small part of the time
    #[arg(long)]
    no_causes: bool,
    /// Exit with status 1 if less of a hundred frames are exact
    #[arg(long, value_name = "PERCENT", value_parser = clap::value_parser!(u8).range(0..=100))]
    at_least: Option<u8>,
    /// Number of threads; 0 for one per core
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    /// How to print the result
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = Format::Text)]
    format: Format,
}

/// The file of a report by which an earlier one is recognised.
const DOCUMENT: &str = "score.json";

/// The file that the inspector's pages of a report share.
const SHARED: &str = "inspector.js";

/// The name of the renderer's picture in the inspector.
const OTHER: &str = "the renderer's.png";

/// Most frames with pictures.
const MOST_EXHIBITS: usize = 40;

/// Causes that the text lists.
const SHOWN: usize = 12;

impl Arguments {
    /// Returns whether a frame is scored.
    fn wants(&self, suite: &str, name: &str) -> bool {
        let name = name.to_lowercase();
        let is_without = self.without.iter().any(|text| name.contains(&text.to_lowercase()));
        (self.suites.is_empty() || self.suites.iter().any(|wanted| wanted == suite)) && !is_without
    }
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let report = arguments.output.as_deref().map(folder).transpose()?;
    let (subjects, sets) = match (&arguments.captures, &arguments.scenes) {
        (Some(captures), _) => of_captures(captures, arguments)?,
        (_, Some(scenes)) => of_scenes(scenes, arguments)?,
        _ => (Vec::new(), Vec::new()),
    };
    let scored = || match &arguments.pack {
        Some(pack) => of_pack(pack, arguments),
        None => scored(&subjects, &sets, arguments, context),
    };
    let runs = ninebit::threads::on_threads(arguments.threads, scored)?;
    if let Some(report) = report {
        let write = || write(&report, arguments, &runs, &subjects, sets.last());
        ninebit::threads::on_threads(arguments.threads, write)?;
        report.commit()?;
    }
    let document = || format!("{:#}", ninebit_score::document(&runs));
    arguments.format.print(|| text(&runs), document)?;
    let is_enough = |run: &Run| arguments.at_least.is_none_or(|least| run.total().percent() >= f64::from(least));
    if runs.last().is_none_or(is_enough) { Ok(()) } else { Err(Failure::difference()) }
}

/// Scores each folder. Only the last is explained.
fn scored(
    subjects: &[Subject],
    sets: &[Pictures],
    arguments: &Arguments,
    context: Context,
) -> Result<Vec<Run>, Failure> {
    let asked: HashSet<(&str, &str)> = subjects.iter().map(|one| (one.suite.as_str(), one.name.as_str())).collect();
    let is_asked = |(suite, name): &(String, String)| asked.contains(&(suite.as_str(), name.as_str()));
    // Of several runs an early one may lack them.
    if let Some(set) = sets.last().filter(|_| !sets.iter().flat_map(|set| &set.files).any(is_asked)) {
        let message = format!("`{}` has no picture of a frame that is scored", shown::path(&set.folder));
        let (suite, name) = subjects.first().map(|one| (one.suite.clone(), one.name.clone())).unwrap_or_default();
        let help = format!("it is looked for as `{}`", shown::path(&Path::new(&suite).join(format!("{name}.png"))));
        return Err(Failure::invalid("NB0526", message, help));
    }
    let progress = Progress::new("scoring", context.color);
    let one = |(n, set): (usize, &Pictures)| {
        let explain = n + 1 == sets.len() && !arguments.no_causes;
        let before = (n * subjects.len()) as u64;
        let rest = (sets.len() - 1 - n) as u64 * subjects.len() as u64;
        ninebit_score::run(subjects, set, explain, &|done, all| progress.report(before + done, before + all + rest))
    };
    Ok(sets.iter().enumerate().map(one).collect::<Result<_, _>>()?)
}

/// Scores the answers of devices to a pack. Only the last are explained.
fn of_pack(place: &Path, arguments: &Arguments) -> Result<Vec<Run>, Failure> {
    let (manifest, tables) = pack::open(place)?;
    let mut runs = Vec::new();
    for (n, folder) in arguments.results.iter().enumerate() {
        let mut answers = results::open(folder, &manifest)?;
        answers.units.retain(|unit| arguments.wants(unit.unit.name(), &unit.asked[1]));
        let name = format!("{}, {}", shown::name(&answers.device.renderer), shown::name(&answers.device.version));
        let explain = n + 1 == arguments.results.len() && !arguments.no_causes;
        runs.push(of_answers(name, &tables, &answers, explain)?);
    }
    Ok(runs)
}

/// Begins the folder of a report.
fn folder(place: &Path) -> Result<PendingFolder, Failure> {
    if !place.exists() {
        return Ok(PendingFolder::create(place)?);
    }
    let pending = if place.join(DOCUMENT).is_file() { PendingFolder::replacing(place)? } else { None };
    pending.ok_or_else(|| {
        let message = format!("`{}` exists, and is no report", shown::path(place));
        Failure::usage(message, "name a folder that does not exist, or an earlier report, which is replaced")
    })
}

fn unreadable(place: &Path, error: &dyn std::fmt::Display) -> Failure {
    let message = format!("`{}` cannot be read: {error}", shown::path(place));
    Failure::invalid("NB0526", message, "name a folder of pictures")
}

/// Returns the folders of pictures below a place, of which there is at least one.
fn pictures(place: &Path) -> Result<Vec<Pictures>, Failure> {
    let found = find(place).map_err(|error| unreadable(place, &error))?;
    if found.is_empty() {
        return Err(unreadable(place, &"there is no SUITE/FRAME.png in it"));
    }
    Ok(found)
}

/// Returns the frames of the captures, and the folders of results.
fn of_captures(captures: &Path, arguments: &Arguments) -> Result<(Vec<Subject>, Vec<Pictures>), Failure> {
    let chip = pictures(captures)?.swap_remove(0);
    let is_wanted = |(suite, name): &&(String, String)| arguments.wants(suite, name);
    let files: Vec<(String, String)> = chip.files.iter().filter(is_wanted).cloned().collect();
    if files.is_empty() {
        let help = "name a folder of the captures as the suite, and leave out less";
        return Err(Failure::usage("the captures have no such frames", help));
    }
    let subjects = captured(&chip.folder, &files).map_err(|unmatched| Failure::fault(&unmatched.to_string()))?;
    let mut sets = Vec::new();
    for place in &arguments.results {
        sets.extend(pictures(place)?);
    }
    Ok((subjects, wanted(sets, arguments)))
}

/// Returns the scenes of a folder, and the folders of results.
fn of_scenes(scenes: &Path, arguments: &Arguments) -> Result<(Vec<Subject>, Vec<Pictures>), Failure> {
    let found = crate::replay::find(&[scenes.to_path_buf()])
        .map_err(|error| Failure::usage(error.to_string(), "name a folder of scenes"))?;
    let mut subjects = Vec::new();
    for entry in found.iter().filter(|entry| entry.kind == EntryKind::Scene) {
        let loaded = ninebit_scene::load(&entry.path, &Limits::default()).map_err(scene::refused)?;
        let below = entry.path.strip_prefix(scenes).unwrap_or(&entry.path);
        let text = |part: Option<&Path>| part.and_then(Path::to_str).unwrap_or_default().to_owned();
        let (suite, name) = (text(below.parent()), text(below.file_stem().map(Path::new)));
        if arguments.wants(&suite, &name) {
            subjects.extend(of_scene(suite, name, loaded.scene));
        }
    }
    if subjects.is_empty() {
        return Err(Failure::usage("there is no scene to score", "name a folder of scenes"));
    }
    let beside = |place: &PathBuf| ninebit_score::beside_scenes(place).map_err(|error| unreadable(place, &error));
    let sets = arguments.results.iter().map(beside).collect::<Result<_, _>>()?;
    Ok((subjects, wanted(sets, arguments)))
}

/// Returns folders without the pictures that are not scored.
fn wanted(mut sets: Vec<Pictures>, arguments: &Arguments) -> Vec<Pictures> {
    for set in &mut sets {
        set.files.retain(|(suite, name)| arguments.wants(suite, name));
    }
    sets
}

/// Writes the files of a report.
fn write(
    report: &PendingFolder,
    arguments: &Arguments,
    runs: &[Run],
    subjects: &[Subject],
    last: Option<&Pictures>,
) -> Result<(), Failure> {
    let Some(run) = runs.last() else { return Ok(()) };
    let exhibits = last.map_or_else(Vec::new, |last| ninebit_score::exhibits(run, subjects, last, MOST_EXHIBITS));
    let evidence = ninebit_score::evidence(run, subjects);
    for exhibit in &exhibits {
        for (kind, picture) in &exhibit.pictures {
            let path = report.path().join("pictures").join(format!("{}-{kind}.png", exhibit.file));
            write_below(&path, &png(picture)?)?;
        }
    }
    let mut inspected = Vec::new();
    for exhibit in &exhibits {
        if let Some(page) = inspector(exhibit, run)? {
            write_below(&report.path().join("scenes").join(format!("{}.html", exhibit.file)), page.as_bytes())?;
            inspected.push(exhibit.frame);
        }
    }
    if !inspected.is_empty() {
        write_below(&report.path().join(SHARED), crate::page::shared(&super::inspect::common()).as_bytes())?;
    }
    let (against, option) = match (&arguments.captures, &arguments.pack) {
        (Some(_), _) => ("captures of the chip in R, G and B, pixel by pixel", "--captures"),
        (_, Some(_)) => ("a pack of vectors; a unit counts as a frame, a row as a pixel", "--pack"),
        _ => ("the model in R, G and B, pixel by pixel", "--scenes"),
    };
    let page = page::page(&page::Report {
        title: "Scorecard",
        against,
        runs,
        exhibits: &exhibits,
        inspected: &inspected,
        evidence: &evidence,
        command: &format!("ninebit score {option} DIR --results DIR"),
    });
    write_below(&report.path().join("index.html"), page.as_bytes())?;
    let total = run.total();
    let badge = badge::badge("frames exact", &format!("{} of {}", total.exact, total.frames));
    write_below(&report.path().join("badge.svg"), badge.as_bytes())?;
    write_below(&report.path().join("card.md"), card::card(runs).as_bytes())?;
    write_below(&report.path().join(DOCUMENT), format!("{:#}\n", ninebit_score::document(runs)).as_bytes())?;
    Ok(())
}

/// Returns the inspector's page of an exhibit, drawn with the cause of most of its pixels, or `None` if no scene is the frame.
fn inspector(exhibit: &Exhibit, run: &Run) -> Result<Option<String>, Failure> {
    let (Some((scene, cause)), Some(causes)) = (&exhibit.scene, &run.causes) else { return Ok(None) };
    // What a scene's text cannot say stays without a page.
    let Ok(written) = write::scene(scene, &WriteOptions::default()) else { return Ok(None) };
    let (frame, variant) = (&run.frames[exhibit.frame], causes.causes[*cause].variant.names());
    let files: BTreeMap<String, String> =
        written.files.iter().map(|(name, bytes)| (name.clone(), STANDARD.encode(bytes))).collect();
    let data = json!({
        "name": format!("{}.ron", frame.name),
        "title": format!("{}/{}", frame.suite, frame.name),
        "picture": null,
        "text": written.text,
        "files": files,
        "chosen": {},
        "variant": variant,
        "against": { "name": OTHER, "picture": STANDARD.encode(png(&exhibit.pictures[1].1)?) },
    });
    Ok(Some(crate::page::page_beside(&frame.name, &data, &format!("../{SHARED}"))))
}

fn png(picture: &Rgba) -> Result<Vec<u8>, Failure> {
    let pixels: Vec<[u8; 4]> = picture.pixels().iter().map(|[r, g, b, _]| [*r, *g, *b, 255]).collect();
    Ok(encode_png(picture.width(), picture.height(), &pixels, Compression::Small)?)
}

/// Returns the result as text.
fn text(runs: &[Run]) -> String {
    let mut text = String::new();
    for run in runs {
        let total = run.total();
        let _ = writeln!(
            text,
            "{}\n  {} frames: {} exact, {} off by one, {} wrong, {} missing, {} unreadable; {} of {} pixels wrong",
            run.name,
            total.frames,
            total.exact,
            total.off_by_one,
            total.wrong,
            total.missing,
            total.unreadable,
            total.pixels.wrong,
            total.pixels.compared,
        );
    }
    let Some(run) = runs.last() else { return text };
    let _ = writeln!(text, "\n{:<32}frames   exact  by one   wrong pixels  explained", "suite");
    for (suite, total) in run.suites() {
        let (explained, all) = run.explained_of(suite);
        let share = if all == 0 { "-".to_owned() } else { percent(explained, all) };
        let (frames, exact, by_one, wrong) = (total.frames, total.exact, total.off_by_one, total.pixels.wrong);
        let _ = writeln!(text, "{suite:<32}{frames:>6}{exact:>8}{by_one:>8}{wrong:>15}{share:>11}");
    }
    let Some(causes) = run.causes.as_ref().filter(|causes| causes.wrong > 0) else { return text };
    let (explained, wrong) = (causes.explained(), causes.wrong);
    let _ = writeln!(
        text,
        "\n{explained} of {wrong} wrong pixels of drawn frames are explained ({})",
        percent(explained, wrong)
    );
    for cause in causes.causes.iter().take(SHOWN) {
        let rule = first_rule(cause.variant);
        let _ = writeln!(text, "{:>12}  {:<8}{:<9} {}", cause.pixels, rule, grade(rule), cause.variant.names());
    }
    if causes.causes.len() > SHOWN {
        let _ = writeln!(text, "and {} more causes", causes.causes.len() - SHOWN);
    }
    text
}

/// Returns the handbook's entry of a rule.
fn rule(id: &str) -> Option<&'static Rule<'static>> {
    RULES.iter().find(|rule| rule.id == id)
}

/// Returns the first grade of a rule.
fn grade(id: &str) -> &'static str {
    rule(id).and_then(|rule| rule.grades().first().copied()).unwrap_or_default()
}

/// Returns the main rule of a variant.
fn first_rule(variant: Shortcuts) -> &'static str {
    variant.iter().next().map_or("", |shortcut| shortcut.reading().rules[0])
}

/// Returns a share in percent with one decimal.
#[allow(clippy::float_arithmetic, reason = "a share for people")]
fn percent(part: u64, whole: u64) -> String {
    format!("{:.1} %", 100.0 * part as f64 / whole.max(1) as f64)
}

/// Returns a number with commas between thousands.
fn thousands(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (n, digit) in digits.chars().enumerate() {
        if n > 0 && (digits.len() - n).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_for_people() {
        assert_eq!([0, 999, 1000, 1_234_567].map(thousands), ["0", "999", "1,000", "1,234,567"]);
        assert_eq!((percent(1, 3).as_str(), percent(1, 0).as_str()), ("33.3 %", "100.0 %"));
    }

    #[test]
    fn every_shortcut_reads_a_rule_of_the_handbook() {
        use ninebit::shortcut::Shortcut;
        use ninebit::state::Named;
        for shortcut in Shortcut::ALL {
            for id in shortcut.reading().rules {
                assert!(rule(id).is_some(), "{} reads {id}", shortcut.name());
            }
        }
    }
}
