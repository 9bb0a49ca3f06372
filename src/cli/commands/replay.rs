//! The command `ninebit replay`: compares scenes with their expectations.

use super::*;
use std::ffi::OsStr;
use std::fs::OpenOptions;

use crate::replay::{Entry, Filter, Options, SceneReplay, find, part, replay, report};
use crate::shard::Shard;
use ninebit_files::output::{make_folder, write_stdout};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Scene files, and folders of which every scene is taken
    #[arg(required = true, value_name = "DIR|SCENE")]
    places: Vec<PathBuf>,
    /// Write expectations that are missing or not met anew, from what is drawn; refused where CI is set. Digests of captures stay
    #[arg(long)]
    bless: bool,
    /// Only scenes whose name matches; with `!` in front, those that do not. May be given several times
    #[arg(long = "filter", value_name = "GLOB")]
    filters: Vec<String>,
    /// Only one of N parts of the scenes: 1/4 to 4/4 are all
    #[arg(long, value_name = "I/N", value_parser = str::parse::<Shard>)]
    shard: Option<Shard>,
    /// Only scenes of this chip
    #[arg(long, value_name = "PROFILE", value_parser = PossibleValuesParser::new(Profile::NAMES))]
    profile: Option<String>,
    #[command(flatten)]
    engine: EngineArguments,
    #[command(flatten)]
    work: WorkArguments,
    #[command(flatten)]
    policies: PolicyArguments,
    /// Write reports, `-` for stdout: json=FILE, junit=FILE, html=FILE; github prints annotations. Separated by commas
    #[arg(long = "report", value_name = "REPORT", value_delimiter = ',', value_parser = report_request)]
    reports: Vec<ReportRequest>,
    /// Write what is known of each difference here: NAME.difference.png, NAME.drawn.png, NAME.txt
    #[arg(long, value_name = "DIR")]
    artifacts: Option<PathBuf>,
    /// Write the picture of every scene here, for `--expected` of later runs
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    /// Pictures of an earlier run: they show where a picture differs whose digest does
    #[arg(long, value_name = "DIR")]
    expected: Option<PathBuf>,
}

#[derive(Clone, Debug)]
enum ReportRequest {
    /// Annotations and a step summary for GitHub Actions.
    Github,
    /// The function that makes a document, and its destination.
    File(fn(&[SceneReplay]) -> String, Destination),
}

impl ReportRequest {
    /// Returns the document's destination.
    fn destination(&self) -> Option<&Destination> {
        match self {
            ReportRequest::Github => None,
            ReportRequest::File(_, destination) => Some(destination),
        }
    }
}

/// Replays scenes and writes reports. The exit status is that of the worst scene.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let options = options(arguments)?;
    let entries = entries(arguments)?;
    let documents = || arguments.reports.iter().filter_map(ReportRequest::destination);
    let stdout = documents().filter(|destination| **destination == Destination::Stdout).count();
    if stdout > 1 {
        return Err(Failure::usage("several reports cannot all go to stdout", "write all but one to files"));
    }
    // Checked before anything is drawn or written. Expectations count as inputs even if they do not exist yet.
    for entry in &entries {
        files::note(&entry.path);
        files::note(&entry.path.with_extension("expect.ron"));
    }
    files::check(documents().filter_map(Destination::path))?;
    // Created even if nothing differs, because reports may go there.
    let mut exit = Exit::Success;
    for folder in [&arguments.artifacts, &arguments.pictures].into_iter().flatten() {
        if let Err(error) = make_folder(folder) {
            exit = report_unwritten(error, context);
        }
    }
    let replayed = {
        let progress = Progress::new("replaying", context.color);
        replay(&entries, &options, &|done| progress.report(done as u64, entries.len() as u64))
    };
    if stdout == 0 {
        let mut text = report::text(&replayed);
        let differs = replayed.iter().any(|one| one.exit_code() == 1);
        if differs && arguments.artifacts.is_none() && documents().next().is_none() {
            text += "`--artifacts DIR` writes pictures and traces of what differs\n";
        }
        write_text(&text)?;
    }
    let exits = [exit, write_reports(&arguments.reports, &replayed, context)].map(|exit| exit as u8);
    let worst = replayed.iter().map(SceneReplay::exit_code).chain(exits).max().unwrap_or(0);
    match Exit::from_code(worst) {
        Exit::Success => Ok(()),
        exit => Err(Failure { exit, report: Report::Silent }),
    }
}

fn options(arguments: &Arguments) -> Result<Options, Failure> {
    let policies = arguments.policies.policies()?;
    if arguments.bless {
        if set("CI") {
            let help = "replay with `--bless` on your own machine, look at the pictures, and commit the expectations";
            return Err(Failure::usage("expectations are not written in continuous integration: CI is set", help));
        }
        if policies != Policies::DEFAULT {
            let help = "leave out `--policy`, or `--bless`";
            return Err(Failure::usage("expectations are written under the default policies only", help));
        }
    }
    Ok(Options {
        render: arguments.engine.options()?,
        limits: Limits { shaded_pixels: arguments.work.pixels, ..Limits::default() },
        policies,
        profile: arguments.profile.as_deref().and_then(Profile::from_name),
        bless: arguments.bless,
        expected: arguments.expected.clone(),
        pictures: arguments.pictures.clone(),
        artifacts: arguments.artifacts.clone(),
    })
}

/// Returns the selected scenes.
fn entries(arguments: &Arguments) -> Result<Vec<Entry>, Failure> {
    let filter = Filter::new(&arguments.filters).map_err(|error| {
        let help = "`*` stands for any characters, `?` for one, `{a,b}` for a or b, `[a-z]` for one of these";
        Failure::usage(error.to_string(), help)
    })?;
    let mut entries = find(&arguments.places).map_err(|error| {
        Failure::usage(error.to_string(), "replay them one after the other, or from a folder above both")
    })?;
    let all = entries.len();
    entries.retain(|entry| filter.takes(entry));
    if entries.is_empty() {
        // A run without scenes must not look like a successful one.
        let filtered = format!("the filter leaves none of {all} scenes");
        let (message, help) = match all {
            0 => ("there are no scenes here", "a scene is a file NAME.ron; look at the folder's name"),
            _ => (filtered.as_str(), "names are paths, such as `vectors/scenes/dot3/lit-stone`"),
        };
        return Err(Failure { exit: Exit::Missing, ..Failure::invalid("NB1201", message, help) });
    }
    Ok(part(entries, arguments.shard.unwrap_or(Shard::ALL)))
}

/// Writes the reports. Prints the errors of those that cannot be written. Returns the resulting status.
fn write_reports(reports: &[ReportRequest], replayed: &[SceneReplay], context: Context) -> Exit {
    let mut exit = Exit::Success;
    for wanted in reports {
        let written = match wanted {
            ReportRequest::Github => github(replayed),
            ReportRequest::File(document, destination) => destination.write(document(replayed).as_bytes()),
        };
        if let Err(error) = written {
            exit = report_unwritten(error, context);
        }
    }
    exit
}

/// Prints that an output was not written. Returns the exit status.
fn report_unwritten(error: OutputError, context: Context) -> Exit {
    let failure = Failure::from(error);
    terminal::print(Level::Error, &failure.report, context.color);
    failure.exit
}

/// Prints annotations to stdout, and appends the summary to the file that GitHub Actions names.
fn github(replayed: &[SceneReplay]) -> Result<(), OutputError> {
    write_stdout(report::annotations(replayed).as_bytes())?;
    let Some(path) = std::env::var_os("GITHUB_STEP_SUMMARY").filter(|path| !path.is_empty()).map(PathBuf::from) else {
        return Ok(());
    };
    files::claim(&path)?;
    // Other commands of the same step also write to this file.
    let file = OpenOptions::new().append(true).create(true).open(&path);
    file.and_then(|mut file| file.write_all(report::step_summary(replayed).as_bytes()))
        .map_err(|source| OutputError::Write { path, source })
}

/// Returns whether an environment variable is set, and not to a value that means no.
fn set(name: &str) -> bool {
    std::env::var(name).is_ok_and(|value| !matches!(value.to_ascii_lowercase().as_str(), "" | "0" | "false"))
}

fn report_request(text: &str) -> Result<ReportRequest, String> {
    let file = |file: &str| Destination::from(OsStr::new(file));
    match text.split_once('=') {
        None if text == "github" => Ok(ReportRequest::Github),
        Some(("json", path)) if !path.is_empty() => Ok(ReportRequest::File(report::json, file(path))),
        Some(("junit", path)) if !path.is_empty() => Ok(ReportRequest::File(report::junit, file(path))),
        Some(("html", path)) if !path.is_empty() => Ok(ReportRequest::File(report::html, file(path))),
        _ => Err("not one of json=FILE, junit=FILE, html=FILE, github".to_owned()),
    }
}
