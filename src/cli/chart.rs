//! `ninebit chart`.

use std::cell::Cell;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use ninebit::chart::page::{File, replace_section};
use ninebit::chart::report::Measured;
use ninebit::chart::techniques::{self, TechniqueError};
use ninebit::chart::timing::Effort;
use ninebit::chart::{curves, evaluators, surfaces};
use ninebit::output::write_below;
use ninebit::read;
use ninebit::scene::SceneError;
use ninebit::sweep;

use super::Context;
use super::exit::{Exit, Failure, Report};
use super::scene::refused;
use super::terminal::Progress;

/// The page that sweeps share with what is not made here, and the markers of their section in it.
const STABILITY: &str = "stability.md";
const SECTION: &str = "sweeps";

/// Pixels along the sides of the surfaces that evaluators are timed on.
const SIDE: usize = 256;
const QUICK_SIDE: usize = 16;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The folder of the scenes that are measured; each folder in it is a family
    #[arg(value_name = "SCENES", default_value = "vectors/scenes/techniques")]
    scenes: PathBuf,
    /// The folder that pages and pictures are written to
    #[arg(long, value_name = "DIR", default_value = "docs")]
    out: PathBuf,
    /// Time few frames: shows that everything works, the times mean little
    #[arg(long)]
    quick: bool,
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

/// Measures everything afresh and writes pages, pictures and data.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let wanted = |page| arguments.only.is_none_or(|only| only == page);
    let mut files = Vec::new();
    if wanted(Page::Speed) {
        files.extend(speed(arguments, context)?.files()?);
    }
    if wanted(Page::Stability) {
        let progress = Progress::new("where methods fail", context.color);
        let report = |done: usize, total: usize| progress.report(done as u64, total as u64);
        let measured = sweep::page::measure(&report).map_err(|error| refused(&error, context))?;
        let (section, pictures) = sweep::page::files(&measured)?;
        files.push(stability_page(&arguments.out.join(STABILITY), &section));
        files.extend(pictures);
    }
    write(&arguments.out, &files)
}

fn speed(arguments: &Arguments, context: Context) -> Result<Measured, Failure> {
    let failed = |error: TechniqueError| technique_failure(error, context);
    let fault = |error: Box<SceneError>| refused(&error, context);
    let entries = techniques::find(&arguments.scenes).map_err(failed)?;
    let (effort, side) = if arguments.quick { (Effort::QUICK, QUICK_SIDE) } else { (Effort::FULL, SIDE) };
    let surfaces = surfaces::surfaces();
    let curves = curves::scenes(arguments.quick);
    let points: usize = curves.iter().map(|(_, scenes)| scenes.len()).sum();
    let total = (entries.len() + evaluators::count() + surfaces.len() + points) as u64;
    let progress = Progress::new("measuring", context.color);
    let done = Cell::new(0);
    let step = || {
        done.set(done.get() + 1);
        progress.report(done.get(), total);
    };
    let mut measured = Measured { quick: arguments.quick, ..Measured::default() };
    for entry in &entries {
        if let Some(technique) = techniques::measure(entry, &effort).map_err(failed)? {
            let title = || techniques::title(&arguments.scenes, &entry.family);
            measured.titles.entry(entry.family.clone()).or_insert_with(title);
            measured.techniques.push(technique);
        }
        step();
    }
    if measured.techniques.is_empty() {
        return Err(Failure::invalid(
            "NB0396",
            format!("no scene in `{}` says what its picture ought to show", arguments.scenes.display()),
            "give scenes a `truth: (lights: [...])`; docs/scene-format.md describes it",
        ));
    }
    for (name, surface) in &surfaces {
        measured.surfaces.push(surface.cost(name, side, &effort).map_err(fault)?);
        step();
    }
    for (mut curve, scenes) in curves {
        for scene in scenes {
            curve.points.push(scene.point(curve.counted, &effort).map_err(fault)?);
            step();
        }
        measured.curves.push(curve);
    }
    measured.evaluators = evaluators::measure(side, &effort, &step).map_err(fault)?;
    Ok(measured)
}

/// The page with its section; without such a page, the section alone.
fn stability_page(path: &Path, section: &str) -> File {
    let page = read::page(path).and_then(|page| replace_section(&page, SECTION, section));
    File::text(STABILITY, page.unwrap_or_else(|| section.to_owned()))
}

fn write(folder: &Path, files: &[File]) -> Result<(), Failure> {
    for file in files {
        write_below(&folder.join(&file.path), &file.bytes)?;
    }
    Ok(())
}

fn technique_failure(error: TechniqueError, context: Context) -> Failure {
    match error {
        TechniqueError::Scene(error) => refused(&error, context),
        TechniqueError::Unseen(path) => Failure::unseen(&path),
        TechniqueError::Folder(folder, error) => Failure {
            exit: Exit::Missing,
            report: Report::Message {
                code: None,
                message: format!("the folder `{}` cannot be read: {error}", folder.display()),
                help: Some("name a folder of scenes, or run this in the folder of the repository".to_owned()),
            },
        },
    }
}
