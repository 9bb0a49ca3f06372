//! Scenes with a ground truth, found in folders: their accuracy, speed and cost.

use std::path::{Path, PathBuf};
use std::{fs, io};

use super::timing::{Effort, Spread, frames};
use crate::accuracy::{self, Accuracy};
use ninebit::engine::{self, RenderOptions};
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::{Positions, Scene};
use ninebit_files::read::page;
use ninebit_scene::truth::Truth;
use ninebit_scene::{Heading, SceneError, load};

/// A scene to be measured.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    /// Name of its folder below the folder that was searched, or of that folder if the scene is directly in it.
    pub family: String,
    /// File name without the parameter and the extension.
    pub technique: String,
    /// The number at the end of the file name; `None` if there is none.
    pub parameter: Option<u32>,
    /// Path of the file.
    pub path: PathBuf,
}

impl Entry {
    /// Returns technique and parameter, separated by spaces, by which the data name it.
    pub fn name(&self) -> String {
        let words = self.technique.replace('-', " ");
        self.parameter.map_or(words.clone(), |parameter| format!("{words} {parameter}"))
    }
}

/// Measurements of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Technique {
    /// The scene that shows the technique.
    pub entry: Entry,
    /// The scene's title, or else its name.
    pub title: String,
    /// The ground truth without the part that describes the technique. Scenes with an equal truth are techniques for the same light.
    pub truth: Truth,
    /// Accuracy, and cost on the chip.
    pub accuracy: Accuracy,
    /// Time of drawing a large picture with the fast engine on one thread, in nanoseconds per final pixel.
    pub time: Spread,
}

/// Width of the pictures that are timed: so large that the setup of draws and triangles does not matter.
const LARGE: u32 = 512;

impl Technique {
    /// Returns the rms error in 8-bit steps.
    pub fn rms(&self) -> f64 {
        self.accuracy.errors.rms()
    }
}

/// Reason why a scene was not measured.
#[derive(Debug)]
pub enum TechniqueError {
    /// A folder cannot be read.
    Folder(PathBuf, io::Error),
    /// A scene is not valid.
    Scene(Box<SceneError>),
    /// No pixel of a scene that has a truth is drawn.
    Unseen(PathBuf),
}

/// Finds all scene files in a folder and its subfolders, sorted by family, technique and parameter.
///
/// # Errors
/// Returns an error if a folder cannot be read.
pub fn find(folder: &Path) -> Result<Vec<Entry>, TechniqueError> {
    let mut found = Vec::new();
    let own = folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    search(folder, &own, true, &mut found)?;
    found.sort();
    Ok(found)
}

fn search(folder: &Path, family: &str, top: bool, found: &mut Vec<Entry>) -> Result<(), TechniqueError> {
    let fail = |error| TechniqueError::Folder(folder.to_path_buf(), error);
    for entry in fs::read_dir(folder).map_err(fail)? {
        let path = entry.map_err(fail)?.path();
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        if path.is_dir() {
            search(&path, if top { &name } else { family }, false, found)?;
        } else if let Some(stem) = name.strip_suffix(".ron").filter(|stem| !stem.contains('.')) {
            let (technique, parameter) = parted(stem);
            found.push(Entry { family: family.to_owned(), technique, parameter, path });
        }
    }
    Ok(())
}

/// Splits a name such as `squaring-16` into technique and parameter.
fn parted(stem: &str) -> (String, Option<u32>) {
    let parts = stem.rsplit_once('-').and_then(|(name, number)| Some((name.to_owned(), Some(number.parse().ok()?))));
    parts.unwrap_or((stem.to_owned(), None))
}

/// Returns the title of a family: the first heading of the page in its folder, or the folder's name with spaces.
pub fn title(folder: &Path, family: &str) -> String {
    let page = page(&folder.join(family).join("README.md")).unwrap_or_default();
    let heading = page.lines().find_map(|line| line.strip_prefix("# ")).map(|line| line.replace('`', ""));
    heading.unwrap_or_else(|| family.replace('-', " "))
}

/// Measures a scene; its time only if it is not known. Returns `None` if it has no ground truth.
///
/// # Errors
/// Returns an error if the scene is not valid, or no pixel with a truth is drawn.
pub fn measure(entry: &Entry, effort: &Effort, known: Option<Spread>) -> Result<Option<Technique>, TechniqueError> {
    let limits = Limits::default();
    let loaded = load(&entry.path, &limits).and_then(|loaded| loaded.affordable(limits.shaded_pixels).map(|()| loaded));
    let loaded = loaded.map_err(|error| TechniqueError::Scene(Box::new(error)))?;
    let Some(truth) = &loaded.truth else { return Ok(None) };
    let Some(accuracy) = accuracy::measure(&loaded.scene, &loaded.plan, truth) else {
        return Err(TechniqueError::Unseen(entry.path.clone()));
    };
    let time = known.unwrap_or_else(|| {
        let large = enlarged(&loaded.scene, LARGE);
        let options = PlanOptions { policies: loaded.plan.policies, ..PlanOptions::default() };
        let plan = large.and_then(|scene| Plan::compile(&scene, &options).ok());
        let plan = plan.as_ref().unwrap_or(&loaded.plan);
        frames(plan, &RenderOptions::default(), final_pixels(plan), effort)
    });
    let truth = Truth { shading_normal: None, meshes: Vec::new(), ..truth.clone() };
    let Heading { title, .. } = Heading::new(&loaded.source.text, &entry.name());
    Ok(Some(Technique { entry: entry.clone(), title, truth, accuracy, time }))
}

/// Returns the scene enlarged to `width` pixels, or `None` if its other state does not scale in a known way.
fn enlarged(scene: &Scene, width: u32) -> Option<Scene> {
    let [target] = &scene.targets[..] else { return None };
    let factor = width as f32 / target.width as f32;
    let mut large = scene.clone();
    large.targets[0].width = width;
    large.targets[0].height = (target.height as f32 * factor) as u32;
    for draw in &mut large.draws {
        match &mut draw.positions {
            Positions::Clip(port) if draw.scissor.is_none() => {
                for side in [&mut port.x, &mut port.y, &mut port.width, &mut port.height] {
                    *side *= factor;
                }
            }
            _ => return None,
        }
    }
    Some(large)
}

/// Returns the number of fragments of the largest draw into the first target, at least 1.
fn final_pixels(plan: &Plan) -> u64 {
    let most = plan.draws().iter().filter(|draw| draw.target == 0).map(|draw| engine::fragments(plan, draw)).max();
    most.unwrap_or(1).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_larger_picture_is_the_same_picture() {
        let text = "(version: 1, profile: Nv10, targets: [(width: 16, height: 8)], draws: [(vertices: Matrix(matrix: \
                    Scale(0.5, 0.5, 1), mesh: Grid(columns: 1, rows: 1)))])";
        let loaded = ninebit_scene::parse(text, Path::new("a.ron"), &Limits::default()).unwrap();
        assert_eq!(final_pixels(&loaded.plan), 32);
        let large = enlarged(&loaded.scene, 512).unwrap();
        assert_eq!((large.targets[0].width, large.targets[0].height), (512, 256));
        assert_eq!(final_pixels(&Plan::compile(&large, &PlanOptions::default()).unwrap()), 256 * 128);
        let window = text.replace(
            "Matrix(matrix: Scale(0.5, 0.5, 1), mesh: Grid(columns: 1, rows: 1))",
            "Window([(position: (0, 0)), (position: (8, 0)), (position: (0, 8))])",
        );
        let loaded = ninebit_scene::parse(&window, Path::new("a.ron"), &Limits::default()).unwrap();
        assert!(enlarged(&loaded.scene, 512).is_none());
    }

    #[test]
    fn scenes_are_found_with_family_technique_and_parameter() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        for name in ["gloss/squaring-16.ron", "gloss/squaring-2.ron", "gloss/deep/table.ron", "flat/one-2x.ron"] {
            write(name, "");
        }
        write("flat/one-2x.expect.ron", "");
        write("gloss/README.md", "text\n# Highlights by `power`\n");
        let found = find(folder.path()).unwrap();
        let names: Vec<(String, String)> = found.iter().map(|entry| (entry.family.clone(), entry.name())).collect();
        let expected = [("flat", "one 2x"), ("gloss", "squaring 2"), ("gloss", "squaring 16"), ("gloss", "table")];
        assert_eq!(names, expected.map(|(family, name)| (family.to_owned(), name.to_owned())));
        assert_eq!(title(folder.path(), "gloss"), "Highlights by power");
        assert_eq!(title(folder.path(), "flat"), "flat");
        assert!(matches!(find(&folder.path().join("nothing")), Err(TechniqueError::Folder(..))));
    }
}
