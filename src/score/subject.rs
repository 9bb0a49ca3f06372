//! The frames that are scored.

use std::path::{Path, PathBuf};

use ninebit::engine::RenderOptions;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::shortcut::{self, Mask, Shortcuts};
use ninebit::state::{Policies, Rectangle, Scene};
use ninebit_captures::{Frame, FrameMismatch, PreparedFrame};

/// A frame that the model draws.
pub trait Drawing: Send + Sync {
    /// Returns what draws the frame, or `None` if the scene cannot be planned.
    fn renderer(&self) -> Option<Box<dyn Renderer>>;
    /// Returns the scene, or `None` if no scene is the frame.
    fn scene(&self) -> Option<Scene>;
}

/// What draws a frame, several times.
pub trait Renderer {
    /// Returns R, G, B, A of every pixel, or of those of the mask in their order, as a renderer with shortcuts draws them; `None` if the scene
    /// cannot be planned.
    fn draw(&self, shortcuts: Shortcuts, mask: Mask<'_>) -> Option<Vec<[u8; 4]>>;
    /// Returns the shortcuts that can change the frame.
    fn shortcuts(&self) -> Shortcuts;
}

impl Drawing for Frame {
    fn renderer(&self) -> Option<Box<dyn Renderer>> {
        Some(Box::new(self.prepare(Policies::DEFAULT).ok()?))
    }
    fn scene(&self) -> Option<Scene> {
        Frame::scene(self, &RenderOptions::default()).ok()?
    }
}

impl Renderer for PreparedFrame {
    fn draw(&self, shortcuts: Shortcuts, mask: Mask<'_>) -> Option<Vec<[u8; 4]>> {
        self.render(&RenderOptions::default(), shortcuts, mask).ok()
    }
    fn shortcuts(&self) -> Shortcuts {
        PreparedFrame::shortcuts(self)
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
pub fn captured(folder: &Path, pictures: &[(String, String)]) -> Result<Vec<Subject>, FrameMismatch> {
    let mut frames: std::collections::BTreeMap<(String, String), Frame> = ninebit_captures::frames(&[])?
        .into_iter()
        .map(|frame| ((frame.suite.to_owned(), frame.name.clone()), frame))
        .collect();
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
impl Drawing for Scene {
    fn renderer(&self) -> Option<Box<dyn Renderer>> {
        Some(Box::new(Plan::compile(self, &PlanOptions::default()).ok()?))
    }
    fn scene(&self) -> Option<Scene> {
        Some(self.clone())
    }
}

impl Renderer for Plan {
    fn draw(&self, shortcuts: Shortcuts, mask: Mask<'_>) -> Option<Vec<[u8; 4]>> {
        let frames = shortcut::drawn(self, shortcuts, &RenderOptions::default(), mask);
        let surface = frames.surfaces.first()?;
        Some(mask.map_or_else(|| surface.rgba8(), |wanted| surface.rgba8_of(&wanted.of(&surface.words))))
    }
    fn shortcuts(&self) -> Shortcuts {
        shortcut::concerning(self)
    }
}

/// Returns the subject of a scene: what the model draws counts as right. A scene without a target has none.
pub fn of_scene(suite: String, name: String, scene: Scene) -> Option<Subject> {
    let width = scene.targets.first()?.width;
    let drawing = Some(Box::new(scene) as Box<dyn Drawing>);
    Some(Subject { suite, name, truth: Truth::Model(width), text: Vec::new(), drawing })
}
