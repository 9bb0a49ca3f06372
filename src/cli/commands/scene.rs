//! Code that the commands on scenes share: the file, the policies, the plan.

use std::path::{Path, PathBuf};

use clap::Args;
use ninebit::diagnostic::DOCUMENTS;
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::shown;
use ninebit::state::{Draw, Policies, Scene};
use ninebit_files::catch_panic::catch_panic;
use ninebit_files::output::{OutputError, write_below};
use ninebit_scene::assets::{Assets, Folder};
use ninebit_scene::change::Change;
use ninebit_scene::truth::Truth;
use ninebit_scene::write::SceneFiles;
use ninebit_scene::{self as scene, LoadedScene, SceneError};
use serde::Serialize;

use super::terminal::{self, Level};
use super::{Context, Exit, Failure, Report};

/// Arguments for a scene and its policies.
#[derive(Debug, Args)]
pub(crate) struct SceneArguments {
    /// The scene file, `-` for standard input
    pub(crate) scene: PathBuf,
    #[command(flatten)]
    state: StateArguments,
}

/// Writes a scene with its files into a folder, and returns the path of its text, `NAME.ron`.
pub(crate) fn write_scene(folder: &Path, name: &str, scene: &SceneFiles) -> Result<PathBuf, OutputError> {
    for (file, bytes) in &scene.files {
        write_below(&folder.join(file), bytes)?;
    }
    let path = folder.join(format!("{name}.ron"));
    write_below(&path, scene.text.as_bytes())?;
    Ok(path)
}

/// Arguments that change what is drawn.
#[derive(Debug, Default, Args)]
pub(crate) struct StateArguments {
    #[command(flatten)]
    policies: PolicyArguments,
    /// Put a value at a place of the scene or its family: `draws[0].program.constants[0]=(255, 128, 0, 255)`, `names.vectors.sun=(0, 0, 1)`
    #[arg(long = "set", value_name = "PATH=VALUE")]
    changes: Vec<String>,
}

/// The limit of work for commands that draw.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct WorkArguments {
    /// Draw a scene of up to so many shaded pixels; `ninebit check` says how many it has
    #[arg(long = "work", value_name = "PIXELS", default_value_t = Limits::default().shaded_pixels)]
    pub(crate) pixels: u64,
}

/// Arguments that choose alternatives of rules.
#[derive(Debug, Default, Args)]
pub(crate) struct PolicyArguments {
    /// Choose an alternative of a rule; `ninebit policies` lists them
    #[arg(long = "policy", value_name = "RULE=VALUE")]
    policies: Vec<String>,
}

impl SceneArguments {
    /// Reads, checks and plans the scene; warnings go to stderr.
    pub(crate) fn load(&self, context: Context) -> Result<(Scene, Plan), Failure> {
        load(&self.scene, &self.state, context)
    }

    /// Like [`load`](Self::load), but refuses a scene that takes more work than allowed.
    pub(crate) fn load_to_draw(&self, work: WorkArguments, context: Context) -> Result<(Scene, Plan), Failure> {
        load_to_draw(&self.scene, &self.state, work, context)
    }
}

/// Reads, checks and plans the scene file at `path`; warnings go to stderr.
pub(crate) fn load(path: &Path, state: &StateArguments, context: Context) -> Result<(Scene, Plan), Failure> {
    let (loaded, policies) = read(path, state, context)?;
    Ok((loaded.scene, loaded.plan.under(policies)))
}

/// Like [`load`], but refuses a scene that takes more work than allowed.
pub(crate) fn load_to_draw(
    path: &Path,
    state: &StateArguments,
    work: WorkArguments,
    context: Context,
) -> Result<(Scene, Plan), Failure> {
    let (loaded, policies) = read(path, state, context)?;
    loaded.affordable(work.pixels).map_err(refused)?;
    Ok((loaded.scene, loaded.plan.under(policies)))
}

/// Reads, checks and plans a scene with a ground truth. Returns an error if it has none, or takes more work than allowed.
pub(crate) fn load_with_truth(
    path: &Path,
    state: &StateArguments,
    work: WorkArguments,
    context: Context,
) -> Result<((Scene, Plan), Truth), Failure> {
    let (loaded, policies) = read(path, state, context)?;
    loaded.affordable(work.pixels).map_err(refused)?;
    let Some(truth) = loaded.truth else {
        let message = format!("`{}` does not say what its picture ought to show", shown::path(path));
        let help = format!("give the scene a `truth: (lights: [...])`; {DOCUMENTS}/scene-format.md describes it");
        return Err(Failure::invalid("NB0396", message, help));
    };
    Ok(((loaded.scene, loaded.plan.under(policies)), truth))
}

/// Reads and checks the scene file at `path`; warnings go to stderr.
fn read(path: &Path, state: &StateArguments, context: Context) -> Result<(LoadedScene, Policies), Failure> {
    let policies = state.policies.policies()?;
    Ok((state.load(path, &Folder, context)?, policies))
}

impl StateArguments {
    /// Returns whether nothing is changed.
    pub(crate) fn is_empty(&self) -> bool {
        self.policies.is_empty() && self.changes.is_empty()
    }

    /// Returns the policies of the command line.
    pub(crate) fn policies(&self) -> Result<Policies, Failure> {
        self.policies.policies()
    }

    /// Reads, changes and checks the scene file at `path`, with the files that it names from `assets`; warnings go to stderr.
    pub(crate) fn load(&self, path: &Path, assets: &dyn Assets, context: Context) -> Result<LoadedScene, Failure> {
        let changes: Result<Vec<Change>, _> = self.changes.iter().map(|change| change.parse()).collect();
        let loaded =
            scene::load_changed(path, &Limits::default(), assets, &changes.map_err(refused)?).map_err(refused)?;
        if !loaded.warnings.is_empty() {
            terminal::print(Level::Warning, &Report::Text(loaded.render_warnings(context.color)), context.color);
        }
        Ok(loaded)
    }
}

impl PolicyArguments {
    /// Returns whether no alternative is chosen.
    pub(crate) fn is_empty(&self) -> bool {
        self.policies.is_empty()
    }

    /// Returns the policies of the command line.
    pub(crate) fn policies(&self) -> Result<Policies, Failure> {
        let mut policies = Policies::DEFAULT;
        for assignment in &self.policies {
            policies.set(assignment).map_err(|error| {
                Failure::usage(error.to_string(), "`ninebit policies` lists the rules and their values")
            })?;
        }
        Ok(policies)
    }
}

/// Converts a scene's errors to a failure.
pub(crate) fn refused(error: SceneError) -> Failure {
    Failure { exit: Exit::from_code(error.exit_code()), report: Report::Scene(Box::new(error)) }
}

/// Converts the errors of options or a program that were read as a scene. `note` is printed below them.
pub(crate) fn refused_beside(error: SceneError, note: &str, context: Context) -> Failure {
    let text = format!("{}\n{note}\n", error.render(context.color));
    Failure { report: Report::Text(text), ..refused(error) }
}

/// Results of work on several scenes.
pub(crate) struct Batch<T> {
    /// Results of the scenes without a failure.
    pub(crate) made: Vec<T>,
    /// The scenes with a failure.
    pub(crate) failed: Vec<SceneFailure>,
    exit: Exit,
}

/// A scene with a failure.
#[derive(Debug, Serialize)]
pub(crate) struct SceneFailure {
    scene: String,
    /// Exit status of the failure.
    exit: u8,
    message: String,
}

/// Runs `work` for each scene. The failure of a scene is printed, and the others go on.
pub(crate) fn each<T>(
    scenes: &[&Path],
    context: Context,
    mut work: impl FnMut(&Path) -> Result<T, Failure>,
) -> Batch<T> {
    let mut each = Batch { made: Vec::new(), failed: Vec::new(), exit: Exit::Success };
    for scene in scenes {
        match isolated(scene, || work(scene)) {
            Ok(made) => each.made.push(made),
            Err(failure) => {
                terminal::print(Level::Error, &failure.report, context.color);
                let (exit, message) = (failure.exit as u8, failure.report.plain());
                each.failed.push(SceneFailure { scene: shown::lossless(scene), exit, message });
                each.exit = Exit::from_code(exit.max(each.exit as u8));
            }
        }
    }
    each
}

impl<T> Batch<T> {
    /// Returns the result of the command: the status of the worst scene.
    pub(crate) fn end(&self) -> Result<(), Failure> {
        match self.exit {
            Exit::Success => Ok(()),
            exit => Err(Failure { exit, report: Report::Silent }),
        }
    }
}

/// Runs `work`. A panic becomes a failure that names the scene.
pub(crate) fn isolated<T>(scene: &Path, work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    catch_panic(work).unwrap_or_else(|mut panic| {
        panic.message = format!("{}, of `{}`", panic.message, shown::path(scene));
        Err(panic.into())
    })
}

/// Returns the index of the named target, or of the first without a name.
pub(crate) fn chosen_target(scene: &Scene, name: Option<&str>) -> Result<usize, Failure> {
    let Some(name) = name else { return Ok(0) };
    scene.targets.iter().position(|target| target.name == name).ok_or_else(|| {
        let names: Vec<_> = scene.targets.iter().map(|target| format!("`{}`", target.name)).collect();
        Failure::usage(format!("the scene has no target `{name}`"), format!("its targets: {}", names.join(", ")))
    })
}

/// Returns the selected draws with their numbers: one, or all.
pub(crate) fn chosen_draws(scene: &Scene, number: Option<usize>) -> Result<Vec<(usize, &Draw)>, Failure> {
    let Some(number) = number else { return Ok(scene.draws.iter().enumerate().collect()) };
    match scene.draws.get(number) {
        Some(draw) => Ok(vec![(number, draw)]),
        None => Err(Failure::usage(format!("the scene has no draw {number}"), known_draws(scene))),
    }
}

/// Returns advice that lists the draws of a scene.
pub(crate) fn known_draws(scene: &Scene) -> String {
    let draws = scene.draws.iter().take(16).enumerate();
    let names: Vec<String> = draws.map(|(n, draw)| format!("{n} `{}`", draw.name)).collect();
    format!("its draws: {}", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_scene_is_apart_from_the_others() {
        let scenes = ["a.ron", "b.ron", "c.ron", "d.ron"].map(Path::new);
        let each = each(&scenes, Context { color: false }, |scene| match scene.to_str() {
            Some("b.ron") => panic!("a table of {} rows", 3),
            Some("c.ron") => Err(Failure::unseen(scene)),
            _ => Ok(scene.to_path_buf()),
        });
        assert_eq!(each.made, [Path::new("a.ron"), Path::new("d.ron")]);
        let [b, c] = &each.failed[..] else { panic!("{:?}", each.failed) };
        assert_eq!((b.scene.as_str(), b.exit, c.scene.as_str(), c.exit), ("b.ron", 6, "c.ron", 3));
        assert!(b.message.starts_with("NB0801 internal error: src/cli/commands/scene.rs:"), "{}", b.message);
        assert!(b.message.ends_with(": a table of 3 rows, of `b.ron`"), "{}", b.message);
        assert!(matches!(each.end(), Err(Failure { exit: Exit::Internal, report: Report::Silent })));
    }
}
