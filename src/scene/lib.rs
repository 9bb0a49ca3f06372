//! The front end of scenes: reads text, returns checked state; and writes state as text.
//!
//! [`load`] reads a file, [`parse`] a text, [`write::scene`] writes one. Scenes that they return can be drawn without further checks. Scenes that they refuse are returned as
//! [`Diagnostic`]s that point into the text, all of them at once. `docs/scene-format.md` describes the format.

pub mod assets;
pub mod change;
pub mod clear;
pub mod data;
pub mod dds;
pub mod diff;
mod error;
mod family;
mod field;
pub mod fields;
mod form;
pub mod generate;
mod heading;
pub mod image;
mod literal;
mod lower;
pub mod mesh;
mod names;
mod notation;
pub mod outline;
pub mod path;
mod raw;
mod reader;
mod render;
mod source;
pub mod truth;
pub mod vector;
mod vertex_column;
mod wording;
pub mod write;

use std::path::Path;

use crate::assets::{Assets, Folder};
use crate::truth::Truth;
pub use error::SceneError;
pub use heading::Heading;
pub use lower::{DrawSpans, ProgramLanguage, VertexSpans};
use ninebit::diagnostic;
pub use ninebit::diagnostic::{Diagnostic, ErrorKind, Severity, Source};
use ninebit::engine;
use ninebit::limits::{FileLimit, Limits};
use ninebit::plan::Plan;
use ninebit::shown;
use ninebit::state::{Profile, Scene};
use ninebit_files::read::{self, Kind, ReadError};
pub use render::render;
pub use write::register_words;

/// A scene that was read and checked.
#[derive(Clone, Debug)]
pub struct LoadedScene {
    /// State of the scene.
    pub scene: Scene,
    /// Plan of the scene, made with [`PlanOptions::default`](ninebit::plan::PlanOptions).
    pub plan: Plan,
    /// Findings about what is probably unintended.
    pub warnings: Vec<Diagnostic>,
    /// The text that the warnings and places point into.
    pub source: Source,
    /// Places of the draws in the text, in the order of the draws.
    pub draw_spans: Vec<DrawSpans>,
    /// What the picture ought to show, if the scene has a truth.
    pub truth: Option<Truth>,
    /// The file of the scene's family as it was read: its name in the scene, and its text after all changes.
    pub family: Option<Source>,
}

impl LoadedScene {
    /// Checks that drawing the scene takes no more than `most` shaded pixels; [`Limits::shaded_pixels`] is what programs allow by themselves.
    ///
    /// # Errors
    /// It takes more.
    pub fn affordable(&self, most: u64) -> Result<(), SceneError> {
        let Err(error) = engine::affordable(&self.plan, most) else { return Ok(()) };
        let place = error.draw.and_then(|draw| self.draw_spans.get(draw)).map(|spans| spans.draw.clone());
        let finding = error.diagnostic(place).label("most of them in this draw");
        Err(SceneError { diagnostics: vec![finding], suppressed: 0, source: self.source.clone() })
    }

    /// Returns the warnings as text for a terminal; empty if there are none.
    pub fn render_warnings(&self, color: bool) -> String {
        render(&self.warnings, &self.source, color)
    }
}

/// Reads and checks the scene file at `path`. The files that the scene names are looked for in its folder. The path `-` is standard input; its
/// files are looked for in the current folder.
///
/// # Errors
/// The file is missing, too large or not UTF-8; it is no valid scene; a file that it names cannot be used.
pub fn load(path: &Path, limits: &Limits) -> Result<LoadedScene, SceneError> {
    load_with(path, limits, &Folder)
}

/// Like [`load`], but reads the files that the scene names from `assets`.
///
/// # Errors
/// Those of [`load`].
pub fn load_with(path: &Path, limits: &Limits, assets: &dyn Assets) -> Result<LoadedScene, SceneError> {
    load_changed(path, limits, assets, &[])
}

/// Like [`load_with`], but changes the scene before it is read. Findings and places are about the changed text.
///
/// # Errors
/// Those of [`load`]; a change that leads nowhere.
pub fn load_changed(
    path: &Path,
    limits: &Limits,
    assets: &dyn Assets,
    changes: &[change::Change],
) -> Result<LoadedScene, SceneError> {
    let name = shown::lossless(path);
    let fail = |finding: Diagnostic, text: String| SceneError {
        diagnostics: vec![finding],
        suppressed: 0,
        source: Source { name: name.clone(), text },
    };
    let bytes = if path == Path::new("-") {
        read::all(std::io::stdin(), limits.scene_file())
    } else {
        read::bytes(path, Kind::Stream, limits.scene_file())
    };
    let finding = |error| match error {
        ReadError::Missing => Diagnostic::error("NB0111", None, "there is no such scene file").help(path::advice(path)),
        ReadError::TooLarge(limit) => too_large(limit),
        error => Diagnostic::error("NB0112", None, format!("the scene file cannot be read: {error}"))
            .help("name a regular file that may be read"),
    };
    let bytes = bytes.map_err(|error| fail(finding(error), String::new()))?;
    match String::from_utf8(bytes) {
        Ok(text) => parse_changed(&text, path, limits, assets, changes),
        Err(error) => {
            let at = error.utf8_error().valid_up_to();
            let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
            let finding = Diagnostic::error("NB0102", at..at + '\u{fffd}'.len_utf8(), "the scene is not UTF-8 text")
                .label("no character is written like this")
                .help("save the file as UTF-8");
            Err(fail(finding, text))
        }
    }
}

fn too_large(limit: FileLimit) -> Diagnostic {
    Diagnostic::error("NB0601", None, format!("the scene file is larger than {limit}"))
        .help("move repeated vertex lists to `names`, use generated meshes, or split the scene")
}

/// Reads a pixel program from a file of its own, as the program of a scene's only draw for the chip `profile`. The draw has one pixel, and each unit
/// has a white texture of one texel.
///
/// # Errors
/// The file is missing, too large or not UTF-8; it is no program of the language; the chip cannot run it.
pub fn load_program(
    path: &Path,
    language: ProgramLanguage,
    profile: Profile,
    limits: &Limits,
) -> Result<(Scene, Plan), SceneError> {
    load_program_with(path, language, profile, limits, &Folder)
}

/// Like [`load_program`], but reads the file from `assets`.
///
/// # Errors
/// Those of [`load_program`].
pub fn load_program_with(
    path: &Path,
    language: ProgramLanguage,
    profile: Profile,
    limits: &Limits,
    assets: &dyn Assets,
) -> Result<(Scene, Plan), SceneError> {
    let mut reader = reader::Reader::new("", Path::new(""), limits, assets);
    reader.profile = profile;
    let found = lower::program_file(&mut reader, path, language);
    let (mut diagnostics, suppressed) = (reader.diagnostics, reader.suppressed);
    diagnostics.sort_by_key(Diagnostic::order);
    let source = Source { name: shown::lossless(path), text: String::new() };
    found.ok_or(SceneError { diagnostics, suppressed, source })
}

/// Reads and checks a scene from its text. `origin` is the path of the text: messages show it, and the files that the scene names are looked
/// for in its folder.
///
/// # Errors
/// All findings about the scene.
pub fn parse(text: &str, origin: &Path, limits: &Limits) -> Result<LoadedScene, SceneError> {
    parse_with(text, origin, limits, &Folder)
}

/// Like [`parse`], but reads the files that the scene names from `assets`.
///
/// # Errors
/// Those of [`parse`].
pub fn parse_with(text: &str, origin: &Path, limits: &Limits, assets: &dyn Assets) -> Result<LoadedScene, SceneError> {
    parse_changed(text, origin, limits, assets, &[])
}

/// Like [`parse_with`], but changes the scene before it is read. Findings and places are about the changed text.
///
/// # Errors
/// Those of [`parse`]; a change that leads nowhere.
pub fn parse_changed(
    text: &str,
    origin: &Path,
    limits: &Limits,
    assets: &dyn Assets,
    changes: &[change::Change],
) -> Result<LoadedScene, SceneError> {
    let mut source =
        Source { name: shown::lossless(origin), text: text.strip_prefix('\u{feff}').unwrap_or(text).to_owned() };
    let folder = origin.parent().unwrap_or(Path::new(""));
    let find = |source: &Source| {
        if source.text.len() as u64 > limits.scene_bytes {
            let source = Source { text: String::new(), ..source.clone() };
            return Err(SceneError { diagnostics: vec![too_large(limits.scene_file())], suppressed: 0, source });
        }
        family::find(&source.text, folder, limits, assets).map_err(|diagnostics| SceneError {
            diagnostics,
            suppressed: 0,
            source: source.clone(),
        })
    };
    let mut family = find(&source)?;
    for change in changes {
        change.apply(&mut source.text, family.as_mut().map(family::Family::text_mut))?;
        if change.path() == "family" {
            family = find(&source)?;
        }
    }
    let text = source.text.as_str();
    // Both texts are joined, so that a place in either is one number of bytes.
    let whole = family.as_ref().map(|family| format!("{text}\n{}", family.text()));
    let whole = whole.as_deref().unwrap_or(text);
    let mut reader = reader::Reader::new(whole, folder, limits, assets);
    let shared = family.as_ref().map(|_| &whole[text.len() + 1..]);
    let found = lower::scene(&mut reader, &whole[..text.len()], shared);
    let (mut diagnostics, suppressed) = (reader.diagnostics, reader.suppressed);
    if let Some(family) = &family {
        diagnostics = diagnostics.into_iter().map(|finding| family.locate(finding, text)).collect();
    }
    diagnostics.sort_by_key(Diagnostic::order);
    match found {
        Some(lower::LoweredScene { scene, plan, truth, mut spans }) => {
            if let Some(family) = &family {
                spans.iter_mut().for_each(|draw| family.keep_inside(draw, text));
            }
            let family = family.map(family::Family::into_source);
            Ok(LoadedScene { scene, plan, warnings: diagnostics, source, draw_spans: spans, truth, family })
        }
        None => Err(SceneError { diagnostics, suppressed, source }),
    }
}
