//! The frames that are scored.

use std::path::{Path, PathBuf};

use ninebit::engine::{RenderOptions, cleared};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::shortcut::{self, Mask, Shortcuts};
use ninebit::state::{Policies, Rectangle, Scene};
use ninebit_vectors::captures::{self, Frame, Unmatched};

/// Draws a frame.
pub trait Drawing: Send + Sync {
    /// Returns R, G, B, A of every pixel as a renderer with shortcuts draws them, or `None` if the scene cannot be planned. Pixels outside
    /// of the mask may be left undrawn.
    fn draw(&self, shortcuts: Shortcuts, mask: Mask<'_>) -> Option<Vec<[u8; 4]>>;
    /// Returns the shortcuts that can change the frame.
    fn shortcuts(&self) -> Shortcuts;
    /// Returns the scene.
    fn scene(&self) -> Scene;
}

impl Drawing for Frame {
    fn draw(&self, shortcuts: Shortcuts, mask: Mask<'_>) -> Option<Vec<[u8; 4]>> {
        self.render_with(&RenderOptions::default(), Policies::DEFAULT, shortcuts, mask).ok()
    }
    fn shortcuts(&self) -> Shortcuts {
        Frame::shortcuts(self).unwrap_or_default()
    }
    fn scene(&self) -> Scene {
        self.main_scene()
    }
}

/// The picture that a frame is compared with.
#[derive(Clone, Debug)]
pub enum Truth {
    /// A file: the chip's picture.
    File(PathBuf),
    /// What the model draws, so many pixels wide.
    Model(u32),
}

/// A frame that is scored.
pub struct Subject {
    /// The suite or folder that it belongs to.
    pub suite: String,
    /// Its name, which is that of the pictures without the extension.
    pub name: String,
    /// The picture that counts as right.
    pub truth: Truth,
    /// Areas that are not compared.
    pub text: Vec<Rectangle>,
    /// How it is drawn, if the model draws it.
    pub drawing: Option<Box<dyn Drawing>>,
}

impl std::fmt::Debug for Subject {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Subject({}/{})", self.suite, self.name)
    }
}

/// Returns a subject for each picture `SUITE/NAME.png` in the folder of captures. Those of the table of frames have areas of text, and are
/// drawn by the model.
///
/// # Errors
/// The table of frames and the drawn frames do not meet.
pub fn captured(folder: &Path, pictures: &[(String, String)]) -> Result<Vec<Subject>, Unmatched> {
    let mut frames: std::collections::BTreeMap<(String, String), Frame> =
        captures::frames(&[])?.into_iter().map(|frame| ((frame.suite.to_owned(), frame.name.clone()), frame)).collect();
    let subject = |(suite, name): &(String, String)| {
        let frame = frames.remove(&(suite.clone(), name.clone()));
        let text = frame.as_ref().map_or_else(Vec::new, |frame| frame.text.clone());
        let truth = Truth::File(folder.join(suite).join(format!("{name}.png")));
        let drawing = frame.map(|frame| Box::new(frame) as Box<dyn Drawing>);
        Subject { suite: suite.clone(), name: name.clone(), truth, text, drawing }
    };
    Ok(pictures.iter().map(subject).collect())
}

/// A scene of its own, whose first target is the picture.
struct Drawn(Scene);

impl Drawing for Drawn {
    fn draw(&self, shortcuts: Shortcuts, mask: Mask<'_>) -> Option<Vec<[u8; 4]>> {
        let plan = Plan::compile(&self.0, &PlanOptions::default()).ok()?.with_shortcuts(shortcuts);
        let mut frames = cleared(&plan);
        shortcut::render(&plan, shortcuts, &RenderOptions::default(), &mut frames, mask);
        frames.surfaces.first().map(ninebit::frame::Surface::rgba8)
    }
    fn shortcuts(&self) -> Shortcuts {
        let plan = Plan::compile(&self.0, &PlanOptions::default());
        plan.map_or(Shortcuts::NONE, |plan| shortcut::concerning(&plan))
    }
    fn scene(&self) -> Scene {
        self.0.clone()
    }
}

/// Returns the subject of a scene: what the model draws counts as right. A scene without a target has none.
pub fn of_scene(suite: String, name: String, scene: Scene) -> Option<Subject> {
    let width = scene.targets.first()?.width;
    let drawing = Some(Box::new(Drawn(scene)) as Box<dyn Drawing>);
    Some(Subject { suite, name, truth: Truth::Model(width), text: Vec::new(), drawing })
}
