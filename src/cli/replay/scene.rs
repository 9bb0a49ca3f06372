//! Replay of one scene: it is read, drawn, compared and, if it differs, analysed.

use std::path::{Path, PathBuf};

use super::Options;
use super::bless::{self, refused, unwritten};
use super::cause::{self, ReplayCause};
use super::find::{Entry, EntryKind};
use super::outcome::{Comparison, Difference, Origin, Outcome, Pixel, Problem, ProblemKind, SceneReplay, Traces};
use super::panels::panels;
use crate::expectation::{Expectation, Mismatch, masked_digest};
use ninebit::diagnostic::{ErrorKind, Severity};
use ninebit::engine::{self, RenderOptions};
use ninebit::frame::Surface;
use ninebit::plan::Plan;
use ninebit::shown;
use ninebit::state::Named;
use ninebit_files::output::{Compression, OutputError, encode_png, write_below};
use ninebit_report::{side_by_side, side_by_side_text, trace_text, trace_value};
use ninebit_scene as scene;
use ninebit_scene::SceneError;
use ninebit_scene::diff;
use ninebit_scene::image::{self, ImageLimits, Rgba};

/// Replays one scene.
pub(super) fn replay(entry: &Entry, options: &Options) -> SceneReplay {
    let mut unwritten = Vec::new();
    let path = shown::path(&entry.path);
    let outcome = match &entry.kind {
        EntryKind::Scene => draw(entry, options, &mut unwritten),
        EntryKind::Orphan => {
            let message = format!("`{path}` has no scene beside it");
            Err(Problem::new(ErrorKind::Missing, "NB1203", message, "remove it, or bring the scene back"))
        }
        EntryKind::Unreadable(reason) => {
            let message = format!("`{path}` cannot be read: {reason}");
            let help = "check its permissions; whatever lies in it has not been replayed";
            Err(Problem::new(ErrorKind::Invalid, "NB1204", message, help))
        }
    };
    let outcome = outcome.unwrap_or_else(Outcome::Failed);
    let mut replayed = SceneReplay { name: entry.name.clone(), path: entry.path.clone(), outcome, unwritten };
    if let Some(folder) = &options.artifacts {
        write_artifacts(&mut replayed, folder);
    }
    replayed
}

/// Returns the path of a scene's file in a folder of artifacts.
fn artifact_path(folder: &Path, name: &str, extension: &str) -> PathBuf {
    folder.join(format!("{name}.{extension}"))
}

/// Writes the details of a difference.
fn write_artifacts(replayed: &mut SceneReplay, folder: &Path) {
    let Outcome::Differs(difference) = &replayed.outcome else { return };
    let mut files = vec![
        ("drawn.png", difference.picture.clone()),
        ("txt", shown::lines(&difference.text()).into_owned().into_bytes()),
    ];
    if let Some(known) = &difference.known {
        files.push(("difference.png", known.panels.clone()));
    }
    for (extension, bytes) in files {
        if let Err(error) = write_below(&artifact_path(folder, &replayed.name, extension), &bytes) {
            replayed.unwritten.push(unwritten(error));
        }
    }
}

fn draw(entry: &Entry, options: &Options, unwritten_files: &mut Vec<Problem>) -> Result<Outcome, Problem> {
    let folder = entry.path.parent().unwrap_or(Path::new(""));
    let path = entry.path.with_extension("expect.ron");
    let expectation = Expectation::read(&path).map_err(|error| refused(&path, &error))?;
    if let Some(expectation) = &expectation {
        let missing = expectation.missing(folder).map_err(|error| refused(&path, &error))?;
        if let Some(first) = missing.first() {
            let capture = if expectation.capture.is_some() { "captured frames: " } else { "" };
            return Ok(Outcome::Skipped(format!("needs {capture}`{}`, which is not here", shown::name(first))));
        }
    }
    let loaded = scene::load(&entry.path, &options.limits).map_err(|error| not_accepted(&error))?;
    loaded.affordable(options.limits.shaded_pixels).map_err(|error| not_accepted(&error))?;
    if let Some(profile) = options.profile.filter(|profile| *profile != loaded.scene.profile) {
        let (is, asked) = (loaded.scene.profile.name(), profile.name());
        return Ok(Outcome::Skipped(format!("is a scene of {is}, not {asked}")));
    }
    let target = match &expectation {
        Some(expectation) => loaded.scene.targets.iter().position(|target| target.name == expectation.target),
        None => Some(0),
    };
    let plan = loaded.plan.under(options.policies);
    let Some(name) = target.and_then(|target| plan.targets().get(target)).map(|target| target.name.clone()) else {
        let expected = expectation.map(|expectation| expectation.target).unwrap_or_default();
        let message = format!("`{}`: the scene has no target `{}`", shown::path(&path), shown::name(&expected));
        let names: Vec<String> =
            plan.targets().iter().map(|target| format!("`{}`", shown::name(&target.name))).collect();
        let help = format!("its targets: {}", names.join(", "));
        return Err(Problem::new(ErrorKind::Invalid, "NB1206", message, &help));
    };
    let target = target.unwrap_or(0);
    let render = RenderOptions { threads: 1, ..options.render };
    let surface = engine::render(&plan, &render).surfaces.swap_remove(target);
    if let Some(pictures) = &options.pictures
        && let Err(error) = png(surface.width, surface.height, &surface.rgba8())
            .and_then(|png| write_below(&artifact_path(pictures, &entry.name, "png"), &png))
    {
        unwritten_files.push(unwritten(error));
    }
    let Some(expectation) = expectation else {
        if options.bless {
            return bless::write(&path, folder, &name, &surface, None);
        }
        let message = format!("`{}` has no expectation beside it", shown::path(&entry.path));
        let help = "`ninebit replay --bless` writes one; look at the picture first";
        return Err(Problem::new(ErrorKind::Missing, "NB1202", message, help));
    };
    let compare = |surface: &Surface| expectation.compare(surface, folder);
    match compare(&surface).map_err(|error| refused(&path, &error))? {
        None => Ok(Outcome::Match),
        Some(_) if options.bless && bless::allowed(&expectation) => {
            bless::write(&path, folder, &name, &surface, Some(&expectation))
        }
        Some(mismatch) => {
            let subject = Subject { entry, folder, plan: &plan, target, render, expectation: &expectation, options };
            subject.look_into(mismatch, &surface).map(|difference| Outcome::Differs(Box::new(difference)))
        }
    }
}

/// Converts the errors of an invalid scene to a problem.
fn not_accepted(error: &SceneError) -> Problem {
    let first = error.diagnostics.iter().find(|finding| finding.severity == Severity::Error);
    // For an error in another file, the place is where the scene names that file.
    let span = first.and_then(|finding| finding.file.as_ref().map(|file| file.named.clone()).or(finding.span.clone()));
    let more = error.diagnostics.len() + error.suppressed;
    let message = first.map_or(String::new(), |finding| finding.message.clone());
    Problem {
        kind: ProblemKind::Scene(error.kind()),
        code: first.map_or("NB0101", |finding| finding.code),
        message: if more > 1 { format!("{message}, and {} more", more - 1) } else { message },
        text: error.render(false).trim_end().to_owned(),
        place: span.map(|span| error.source.position(span.start)),
    }
}

fn png(width: u32, height: u32, pixels: &[[u8; 4]]) -> Result<Vec<u8>, OutputError> {
    encode_png(width, height, pixels, Compression::Fast)
}

/// A scene that is not as expected, with all that is needed to analyse it.
struct Subject<'a> {
    entry: &'a Entry,
    folder: &'a Path,
    plan: &'a Plan,
    target: usize,
    render: RenderOptions,
    expectation: &'a Expectation,
    options: &'a Options,
}

impl Subject<'_> {
    fn look_into(&self, mismatch: Mismatch, surface: &Surface) -> Result<Difference, Problem> {
        let (width, height) = (surface.width, surface.height);
        let drawn = Rgba::new(width, surface.rgba8());
        let picture = png(width, height, drawn.pixels()).map_err(unwritten)?;
        let mut difference = Difference {
            target: self.expectation.target.clone(),
            expected: self.expectation.sha256.clone(),
            drawn: ninebit_files::picture::surface_digest(surface),
            mismatch,
            cause: None,
            known: None,
            picture,
            remarks: Vec::new(),
        };
        if [width, height] == [self.expectation.width, self.expectation.height] {
            self.compare_pictures(drawn, &mut difference)?;
        }
        Ok(difference)
    }

    /// Sets pixels that are not compared to 0, 0, 0, 0. Returns the digest.
    fn masked(&self, picture: &mut Rgba, compared: &[bool]) -> String {
        masked_digest(picture.width(), picture.height(), picture.pixels_mut(), compared)
    }

    fn compare_pictures(&self, mut drawn: Rgba, difference: &mut Difference) -> Result<(), Problem> {
        let path = self.entry.path.with_extension("expect.ron");
        let compared = self.expectation.compared(self.folder).map_err(|error| refused(&path, &error))?;
        difference.drawn = self.masked(&mut drawn, &compared);
        let mut expected = self.expected_picture(&compared, &mut difference.remarks);
        let first = expected.as_ref().and_then(|(picture, _)| first_pixel(picture, &drawn));
        let matches =
            |surface: &Surface| self.expectation.compare(surface, self.folder).is_ok_and(|mismatch| mismatch.is_none());
        let found = cause::find(self.plan, &self.render, self.target, first, &matches);
        if let (None, Some(ReplayCause { surface, .. })) = (&expected, &found) {
            let mut picture = Rgba::new(surface.width, surface.rgba8());
            self.masked(&mut picture, &compared);
            expected = Some((picture, Origin::Cause));
        }
        difference.cause = found.as_ref().map(|found| found.cause);
        if let Some((picture, origin)) = expected {
            difference.known = self.compare_known(&picture, origin, &drawn, found.as_ref())?;
        }
        Ok(())
    }

    /// Returns the expected picture and its origin, if it is found.
    fn expected_picture(&self, compared: &[bool], remarks: &mut Vec<String>) -> Option<(Rgba, Origin)> {
        let expectation = self.expectation;
        let file =
            |name: &String| (self.folder.join(name), expectation.image(self.folder, name).map_err(|e| e.to_string()));
        let earlier = self.options.expected.as_ref().map(|folder| {
            let path = artifact_path(folder, &self.entry.name, "png");
            let image = image::load(&path, &ImageLimits::default()).map_err(|error| error.to_string());
            (path, image)
        });
        let candidates = [expectation.picture.as_ref().map(file), earlier];
        for (path, image) in candidates.into_iter().flatten() {
            match image {
                Ok(mut picture) if [picture.width(), picture.height()] == [expectation.width, expectation.height] => {
                    if self.masked(&mut picture, compared) == expectation.sha256 {
                        return Some((picture, Origin::File(path)));
                    }
                    remarks.push(format!("{} is another picture than the expected one", shown::path(&path)));
                }
                Ok(_) => remarks.push(format!("{} has another size than the expected picture", shown::path(&path))),
                Err(error) => remarks.push(error),
            }
        }
        let (path, image) = file(&expectation.allowance.as_ref()?.picture);
        let mut picture = image.ok()?;
        self.masked(&mut picture, compared);
        Some((picture, Origin::File(path)))
    }

    /// Compares both pictures. Returns `None` if they are equal.
    fn compare_known(
        &self,
        expected: &Rgba,
        origin: Origin,
        drawn: &Rgba,
        found: Option<&ReplayCause>,
    ) -> Result<Option<Comparison>, Problem> {
        let Some(first) = first_pixel(expected, drawn) else { return Ok(None) };
        let compared = diff::compare(expected, drawn, &diff::Options::default());
        let (Ok(difference), Ok((panels, scale))) = (compared, panels(expected, drawn)) else { return Ok(None) };
        let panels = png(panels.width(), panels.height(), panels.pixels()).map_err(unwritten)?;
        let traces = self.traces(first, found);
        Ok(Some(Comparison { origin, difference, first, panels, scale, traces }))
    }

    fn traces(&self, first: Pixel, found: Option<&ReplayCause>) -> Option<Traces> {
        let at = (first.x, first.y);
        let drawn = engine::trace(self.plan, self.target, at, None).ok()?;
        let value = trace_value(self.plan, &drawn);
        let other = found.and_then(|found| Some((found, engine::trace(&found.plan, self.target, at, None).ok()?)));
        Some(match other {
            Some((found, expected)) if found.plan.policies != self.plan.policies => {
                let lines = side_by_side(&expected, &drawn);
                let parted = lines.iter().find(|line| line.differs());
                let parted = parted.map_or(String::new(), |line| format!(", first in {} ({})", line.name, line.rule));
                let (Pixel { x, y, .. }, both) = (first, side_by_side_text(["expected", "drawn"], &lines));
                let text =
                    format!("pixel {x},{y}: as expected, and as it is drawn; `>` where they differ{parted}\n{both}");
                Traces { text, lines, drawn: value, expected: Some(trace_value(&found.plan, &expected)) }
            }
            _ => Traces { text: trace_text(self.plan, &drawn), lines: Vec::new(), drawn: value, expected: None },
        })
    }
}

/// Returns the first pixel in which two pictures of the same size differ.
fn first_pixel(expected: &Rgba, drawn: &Rgba) -> Option<Pixel> {
    let at = expected.pixels().iter().zip(drawn.pixels()).position(|(a, b)| a != b)?;
    let (x, y) = (at as u32 % expected.width(), at as u32 / expected.width());
    Some(Pixel { x, y, expected: expected.pixels()[at], drawn: drawn.pixels()[at] })
}
