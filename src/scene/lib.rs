//! The scene front end: text in, checked state out.
//!
//! [`load`] reads a file, [`parse`] a text. What they return draws without further checks; what they refuse comes back as
//! [`Diagnostic`]s that point into the text, all of them at once. The format is described in `docs/scene-format.md`.

pub mod assets;
pub mod dds;
pub mod diff;
mod error;
mod family;
mod field;
pub mod fields;
mod form;
pub mod generate;
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
mod wording;
mod written;

use std::path::Path;

use crate::assets::{Assets, Folder};
use crate::truth::Truth;
pub use error::SceneError;
pub use lower::{DrawSpans, ProgramLanguage, VertexSpans};
use ninebit::diagnostic;
pub use ninebit::diagnostic::{Diagnostic, ErrorKind, Severity, Source};
use ninebit::limits::{FileLimit, Limits};
use ninebit::plan::Plan;
use ninebit::shown;
use ninebit::state::{Profile, Scene};
use ninebit_files::read::{self, Kind, ReadError};
pub use render::render;
pub use written::register_words;

/// A scene that was read and checked.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// What to draw.
    pub scene: Scene,
    /// How it is drawn: planned with [`PlanOptions::default`](ninebit::plan::PlanOptions).
    pub plan: Plan,
    /// What is probably not meant.
    pub warnings: Vec<Diagnostic>,
    /// The text that the warnings and the places point into.
    pub source: Source,
    /// Places of the draws, in their order.
    pub draw_spans: Vec<DrawSpans>,
    /// What its picture ought to show, if it says so.
    pub truth: Option<Truth>,
}

impl Loaded {
    /// The warnings as text for a terminal; empty if there are none.
    pub fn render_warnings(&self, color: bool) -> String {
        render(&self.warnings, &self.source, color)
    }
}

/// Reads and checks the scene file at `path`; the files it names are looked for in its folder. `-` is standard input, whose files are looked for in the current
/// folder.
///
/// # Errors
/// The file is missing, too large or not UTF-8; the scene is not one; a file that it names cannot be used.
pub fn load(path: &Path, limits: &Limits) -> Result<Loaded, SceneError> {
    load_with(path, limits, &Folder)
}

/// [`load`], with the files that the scene names from elsewhere.
///
/// # Errors
/// As [`load`].
pub fn load_with(path: &Path, limits: &Limits, assets: &dyn Assets) -> Result<Loaded, SceneError> {
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
        ReadError::Missing => Diagnostic::error("NB0111", None, "there is no such scene file")
            .help("check the spelling and the folder; upper and lower case count"),
        ReadError::TooLarge(limit) => too_large(limit),
        error => Diagnostic::error("NB0112", None, format!("the scene file cannot be read: {error}"))
            .help("name a regular file that may be read"),
    };
    let bytes = bytes.map_err(|error| fail(finding(error), String::new()))?;
    match String::from_utf8(bytes) {
        Ok(text) => parse_with(&text, path, limits, assets),
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

/// Reads a pixel program from a file of its own, as that of the one draw of a scene for the chip `profile`: one pixel, and in each unit a white texture
/// of one texel.
///
/// # Errors
/// The file is missing, too large or not UTF-8; it is no program of the language; the chip does not take it.
pub fn load_program(
    path: &Path,
    language: ProgramLanguage,
    profile: Profile,
    limits: &Limits,
) -> Result<(Scene, Plan), SceneError> {
    let mut reader = reader::Reader::new("", Path::new(""), limits, &Folder);
    reader.profile = profile;
    let found = lower::program_file(&mut reader, path, language);
    let (mut diagnostics, suppressed) = (reader.diagnostics, reader.suppressed);
    diagnostics.sort_by_key(Diagnostic::order);
    let source = Source { name: shown::lossless(path), text: String::new() };
    found.ok_or(SceneError { diagnostics, suppressed, source })
}

/// Reads and checks a scene from its text. `origin` is its path: messages name it, and the files that the scene names are looked
/// for in its folder.
///
/// # Errors
/// Everything that is wrong with it.
pub fn parse(text: &str, origin: &Path, limits: &Limits) -> Result<Loaded, SceneError> {
    parse_with(text, origin, limits, &Folder)
}

/// [`parse`], with the files that the scene names from elsewhere.
///
/// # Errors
/// As [`parse`].
pub fn parse_with(text: &str, origin: &Path, limits: &Limits, assets: &dyn Assets) -> Result<Loaded, SceneError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let source = Source { name: shown::lossless(origin), text: text.to_owned() };
    if text.len() as u64 > limits.scene_bytes {
        let source = Source { text: String::new(), ..source };
        return Err(SceneError { diagnostics: vec![too_large(limits.scene_file())], suppressed: 0, source });
    }
    let folder = origin.parent().unwrap_or(Path::new(""));
    let family = match family::find(text, folder, limits, assets) {
        Ok(family) => family,
        Err(diagnostics) => return Err(SceneError { diagnostics, suppressed: 0, source }),
    };
    // Both texts in one, so that a place in either is a number of bytes.
    let whole = family.as_ref().map(|family| format!("{text}\n{}", family.text()));
    let whole = whole.as_deref().unwrap_or(text);
    let mut reader = reader::Reader::new(whole, folder, limits, assets);
    let shared = family.as_ref().map(|_| &whole[text.len() + 1..]);
    let found = lower::scene(&mut reader, &whole[..text.len()], shared);
    let (mut diagnostics, suppressed) = (reader.diagnostics, reader.suppressed);
    if let Some(family) = &family {
        diagnostics = diagnostics.into_iter().map(|finding| family.place(finding, text)).collect();
    }
    diagnostics.sort_by_key(Diagnostic::order);
    match found {
        Some(lower::Found { scene, plan, truth, mut spans }) => {
            if let Some(family) = &family {
                spans.iter_mut().for_each(|draw| family.keep_inside(draw, text));
            }
            Ok(Loaded { scene, plan, warnings: diagnostics, source, draw_spans: spans, truth })
        }
        None => Err(SceneError { diagnostics, suppressed, source }),
    }
}
