//! The command `ninebit chart`: measures techniques and experiments, and writes their pages.

use super::*;
use std::cell::Cell;

use ninebit::diagnostic::DOCUMENTS;
use ninebit::engine::Isa;
use ninebit::limits::EVALUATORS;
use ninebit_files::output::{make_folder, write_below, write_file};
use ninebit_files::read::{self, Kind, ReadError};
use ninebit_lab::chart::curves::Curve;
use ninebit_lab::chart::data::Times;
use ninebit_lab::chart::evaluators::Evaluator;
use ninebit_lab::chart::page::{File, replace_section};
use ninebit_lab::chart::report::Measurements;
use ninebit_lab::chart::techniques::{self, TechniqueError};
use ninebit_lab::chart::timing::Effort;
use ninebit_lab::chart::{curves, evaluators, surfaces};
use ninebit_lab::experiments;

use super::scene::{isolated, refused};

/// The page that contains the section of experiments.
const STABILITY: &str = "stability.md";
/// Name of that section in its markers.
const SECTION: &str = "sweeps";

/// Default output folder. A file `.gitignore` in it keeps it out of version control.
const FOLDER: &str = "ninebit-chart";
/// Name and content of that file.
const IGNORE: (&str, &str) = (".gitignore", "*\n");

/// Names that mark the root of a folder under version control.
const VERSIONED: [&str; 5] = [".git", ".hg", ".jj", ".svn", ".bzr"];

/// Width and height in pixels of the surfaces that evaluators are timed on.
const SIDE: usize = 256;
/// The same with `--quick`.
const QUICK_SIDE: usize = 16;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The folder of the scenes that are measured; each folder in it is a family
    #[arg(value_name = "SCENES", default_value = "vectors/scenes/techniques")]
    scenes: PathBuf,
    /// The folder that pages and pictures are written to
    #[arg(long, value_name = "DIR", default_value = FOLDER)]
    out: PathBuf,
    /// Write over pages that are there in a folder under version control
    #[arg(long)]
    overwrite: bool,
    /// Time few frames: shows that everything works, the times mean little
    #[arg(long)]
    quick: bool,
    /// Further ways of evaluating a scene, measured elsewhere: a JSON file, as `benches/peers/evaluators.sh` writes
    #[arg(long, value_name = "FILE.json")]
    evaluators: Option<PathBuf>,
    /// Take times from a `figures.json` that this command wrote: what no clock measures is computed again
    #[arg(long, conflicts_with_all = ["quick", "evaluators"], value_name = "FIGURES.json")]
    times: Option<PathBuf>,
    /// Make one page alone
    #[arg(long, value_enum, value_name = "PAGE")]
    only: Option<Page>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Page {
    /// Speed against accuracy, in `speed-accuracy.md`
    Speed,
    /// Where methods fail, a section of `stability.md`
    Stability,
}

impl Page {
    /// Returns the names of the page and the folder beside it.
    fn names(self) -> [&'static str; 2] {
        match self {
            Page::Speed => ["speed-accuracy.md", "speed-accuracy"],
            Page::Stability => [STABILITY, "stability"],
        }
    }
}

/// Measures everything afresh and writes pages, pictures and data.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let wanted = |page| arguments.only.is_none_or(|only| only == page);
    for page in [Page::Speed, Page::Stability].into_iter().filter(|page| wanted(*page) && !arguments.overwrite) {
        keep_versioned(&arguments.out, page)?;
    }
    let elsewhere = arguments.evaluators.as_deref().map_or(Ok(Vec::new()), measured_elsewhere)?;
    let times = arguments.times.as_deref().map(known_times).transpose()?;
    let (mut files, mut page) = (Vec::new(), None);
    let mut failed = 0;
    if wanted(Page::Speed) {
        let mut measured = speed(arguments, times, context)?;
        measured.evaluators.extend(elsewhere);
        failed += measured.failed.len();
        files.extend(measured.files()?);
    }
    if wanted(Page::Stability) {
        let progress = Progress::new("where methods fail", context.color);
        let report = |done: usize, total: usize| progress.report(done as u64, total as u64);
        let measured = experiments::page::measure(&report).map_err(|error| refused(*error))?;
        let (section, pictures) = experiments::page::files(&measured)?;
        page = Some(stability_page(&arguments.out.join(STABILITY), &section));
        files.extend(pictures);
    }
    make_folder(&arguments.out)?;
    if arguments.out == Path::new(FOLDER) {
        write_file(&arguments.out.join(IGNORE.0), IGNORE.1.as_bytes())?;
    }
    for file in &files {
        write_below(&arguments.out.join(&file.path), &file.bytes)?;
    }
    if let Some(page) = page {
        // The rest of the page was read and is kept.
        write_file(&arguments.out.join(&page.path), &page.bytes)?;
    }
    if failed > 0 { Err(Failure { exit: Exit::Internal, report: Report::Silent }) } else { Ok(()) }
}

/// Reads evaluators from a file.
fn measured_elsewhere(path: &Path) -> Result<Vec<Evaluator>, Failure> {
    parsed(path, "evaluators", "`benches/peers/evaluators.sh` writes such a file", evaluators::parse)
}

/// Reads the times of an earlier run.
fn known_times(path: &Path) -> Result<Times, Failure> {
    parsed(path, "times", TIMES_HELP, Times::parse)
}

const TIMES_HELP: &str = "`ninebit chart` without `--times` measures all of them, and writes such a file";

/// Reads measurements from a file.
fn parsed<T>(
    path: &Path,
    what: &str,
    help: &str,
    parse: impl FnOnce(&[u8]) -> Result<T, String>,
) -> Result<T, Failure> {
    let bytes = read::bytes(path, Kind::Stream, EVALUATORS).map_err(|error| {
        let message = format!("the {what} of `{}` cannot be read: {error}", shown::path(path));
        match error {
            ReadError::Missing => Failure { exit: Exit::Missing, ..Failure::invalid("NB0536", message, help) },
            ReadError::TooLarge(_) => Failure { exit: Exit::Limit, ..Failure::invalid("NB0538", message, help) },
            _ => Failure::invalid("NB0537", message, help),
        }
    })?;
    parse(&bytes).map_err(|reason| {
        Failure::invalid("NB0537", format!("`{}` holds no {what}: {reason}", shown::path(path)), help)
    })
}

/// Returns an error if a page under version control would be overwritten. Runs before any measurement.
fn keep_versioned(folder: &Path, page: Page) -> Result<(), Failure> {
    let Some(path) = page.names().into_iter().map(|name| folder.join(name)).find(|path| path.exists()) else {
        return Ok(());
    };
    let ours = read::page(&folder.join(IGNORE.0)).is_some_and(|text| text == IGNORE.1);
    let place = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    let versioned = place.ancestors().any(|folder| VERSIONED.iter().any(|name| folder.join(name).exists()));
    if versioned && !ours { Err(OutputError::Versioned { path }.into()) } else { Ok(()) }
}

fn speed(arguments: &Arguments, times: Option<Times>, context: Context) -> Result<Measurements, Failure> {
    let fault = |error: Box<SceneError>| refused(*error);
    let entries = techniques::find(&arguments.scenes).map_err(technique_failure)?;
    let (effort, side) = if arguments.quick { (Effort::QUICK, QUICK_SIDE) } else { (Effort::FULL, SIDE) };
    let surfaces = surfaces::surfaces();
    let curves = curves::scenes(arguments.quick);
    let points: usize = curves.iter().map(|(_, scenes)| scenes.len()).sum();
    let timed = if times.is_some() { 0 } else { evaluators::count() + surfaces.len() + points };
    let total = (entries.len() + timed) as u64;
    let progress = Progress::new("measuring", context.color);
    let done = Cell::new(0);
    let step = || {
        done.set(done.get() + 1);
        progress.report(done.get(), total);
    };
    let isa = Isa::best().name().to_owned();
    let mut measured = Measurements { isa, quick: arguments.quick, ..Measurements::default() };
    for entry in &entries {
        let technique = isolated(&entry.path, || {
            let known = times.as_ref().map(|times| times.spread_of(entry));
            let spread = known.as_ref().and_then(|known| known.as_ref().ok().copied());
            match (techniques::measure(entry, &effort, spread).map_err(technique_failure)?, known) {
                (Some(_), Some(Err(reason))) => Err(Failure::invalid("NB0537", reason, TIMES_HELP)),
                (technique, _) => Ok(technique),
            }
        });
        if let Some(technique) = unless_internal(technique, entry.name(), &mut measured.failed, context)?.flatten() {
            let title = || techniques::title(&arguments.scenes, &entry.family);
            measured.titles.entry(entry.family.clone()).or_insert_with(title);
            measured.techniques.push(technique);
        }
        step();
    }
    if measured.techniques.is_empty() {
        let message = format!("no scene in `{}` says what its picture ought to show", shown::path(&arguments.scenes));
        let help = format!("give scenes a `truth: (lights: [...])`; {DOCUMENTS}/scene-format.md describes it");
        return Err(Failure::invalid("NB0396", message, help));
    }
    if let Some(Times { isa, quick, evaluators, surfaces, curves: known, .. }) = times {
        // Names and texts are those of today.
        let points = known.into_iter().map(|curve| curve.points);
        let curves = curves.into_iter().zip(points).map(|((curve, _), points)| Curve { points, ..curve }).collect();
        return Ok(Measurements { isa, quick, evaluators, surfaces, curves, ..measured });
    }
    for (name, surface) in &surfaces {
        let cost = isolated(Path::new(name), || surface.cost(name, side, &effort).map_err(fault));
        measured.surfaces.extend(unless_internal(cost, (*name).to_owned(), &mut measured.failed, context)?);
        step();
    }
    for (mut curve, scenes) in curves {
        for scene in scenes {
            let point = isolated(Path::new(&curve.counted), || scene.point(&curve.counted, &effort).map_err(fault));
            let name = format!("a point of {}", curve.counted);
            curve.points.extend(unless_internal(point, name, &mut measured.failed, context)?);
            step();
        }
        measured.curves.push(curve);
    }
    let evaluators = isolated(Path::new("evaluators"), || evaluators::measure(side, &effort, &step).map_err(fault));
    let evaluators = unless_internal(evaluators, "evaluators".to_owned(), &mut measured.failed, context)?;
    measured.evaluators = evaluators.unwrap_or_default();
    Ok(measured)
}

/// Returns a measurement, or `None` if it ended in an internal error. Such an error is printed and recorded, and the others go on.
fn unless_internal<T>(
    measured: Result<T, Failure>,
    name: String,
    failed: &mut Vec<String>,
    context: Context,
) -> Result<Option<T>, Failure> {
    match measured {
        Err(Failure { exit: Exit::Internal, report }) => {
            terminal::print(Level::Error, &report, context.color);
            failed.push(name);
            Ok(None)
        }
        other => other.map(Some),
    }
}

/// Returns the page with its section replaced, or the section alone if there is no such page.
fn stability_page(path: &Path, section: &str) -> File {
    let page = read::page(path).and_then(|page| replace_section(&page, SECTION, section));
    File::text(STABILITY, page.unwrap_or_else(|| section.to_owned()))
}

fn technique_failure(error: TechniqueError) -> Failure {
    match error {
        TechniqueError::Scene(error) => refused(*error),
        TechniqueError::Unseen(path) => Failure::unseen(&path),
        TechniqueError::Folder(folder, error) => {
            let message = format!("the folder `{}` cannot be read: {error}", shown::path(&folder));
            let help = "name a folder of scenes, or run this in the folder of the repository";
            Failure { exit: Exit::Missing, ..Failure::usage(message, help) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_said_and_the_rest_goes_on() {
        let (context, mut failed) = (Context { color: false }, Vec::new());
        let panicked = isolated(Path::new("a.ron"), || -> Result<u32, Failure> { panic!("a table") });
        assert!(matches!(unless_internal(panicked, "a".to_owned(), &mut failed, context), Ok(None)));
        assert!(matches!(unless_internal(Ok(7), "b".to_owned(), &mut failed, context), Ok(Some(7))));
        let refused = Err::<u32, _>(Failure::unseen(Path::new("c.ron")));
        let refused = unless_internal(refused, "c".to_owned(), &mut failed, context);
        assert!(matches!(refused, Err(Failure { exit: Exit::Invalid, .. })));
        assert_eq!(failed, ["a"]);
    }
}
