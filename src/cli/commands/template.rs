//! The scene that stands for an operation's settings.

use std::path::PathBuf;

use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::state::{Combiners, Draw, Named, Profile, Scene};
use ninebit_scene as scene;

use super::scene::refused;
use super::{Context, Failure, Report};

/// One pixel covered by one triangle, and whatever the operation sets.
#[derive(Debug, Default)]
pub(crate) struct Template {
    /// Fields of the scene.
    pub(crate) scene: String,
    /// Fields of its target, of 1 x 1 pixel.
    pub(crate) target: String,
    /// Fields of its draw.
    pub(crate) draw: String,
    /// What is said under its findings, instead of that they are about options.
    pub(crate) note: Option<&'static str>,
    /// The folder of files that it names.
    pub(crate) folder: PathBuf,
}

impl Template {
    /// Reads and checks the scene. What is illegal is refused in the scene's own words.
    pub(crate) fn read(&self, profile: Profile, context: Context) -> Result<(Scene, Plan), Failure> {
        let text = format!(
            "(\n    version: 1,\n    profile: {},\n{}    targets: [(width: 1, height: 1{})],\n    draws: [(\n        \
             vertices: Window([(position: (0, 0)), (position: (0, 2)), (position: (2, 0))]),\n{}    )],\n)\n",
            profile.name(),
            self.scene,
            self.target,
            self.draw
        );
        match scene::parse(&text, &self.folder.join("what is asked for, as a scene"), &Limits::default()) {
            Ok(loaded) => Ok((loaded.scene, loaded.plan)),
            Err(error) => {
                let note = self.note.unwrap_or(
                    "the lines above are this command's options as a scene writes them; `--profile nv2a` chooses the other chip",
                );
                let text = format!("{}\n{note}\n", error.render(context.color));
                Err(Failure { report: Report::Text(text), ..refused(error) })
            }
        }
    }

    /// The combiners that the draw is given.
    pub(crate) fn combiners(&self, profile: Profile, context: Context) -> Result<Combiners, Failure> {
        let (scene, _) = self.read(profile, context)?;
        // The template has one draw.
        let none = || Failure::usage("the operation makes no draw", "please report this with the command line");
        scene.draws.into_iter().next().map(|draw: Draw| draw.combiners).ok_or_else(none)
    }
}
