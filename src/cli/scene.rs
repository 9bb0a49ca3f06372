//! What the commands on scenes share: the file, the policies, the plan.

use std::path::{Path, PathBuf};

use clap::Args;
use ninebit::limits::Limits;
use ninebit::output::Destination;
use ninebit::plan::Plan;
use ninebit::scene::{self, ErrorKind, Loaded, SceneError};
use ninebit::state::{Draw, Policies, Scene};
use ninebit::truth::Truth;

use super::Context;
use super::exit::{Exit, Failure, Report};
use super::terminal::{self, Level};

/// The scene and how to read it.
#[derive(Debug, Args)]
pub(crate) struct SceneArguments {
    /// The scene file
    pub(crate) scene: PathBuf,
    #[command(flatten)]
    policies: PolicyArguments,
}

/// The answers to what no capture decides.
#[derive(Debug, Default, Args)]
pub(crate) struct PolicyArguments {
    /// Choose an alternative of a rule; `ninebit policies` lists them
    #[arg(long = "policy", value_name = "RULE=VALUE")]
    policies: Vec<String>,
}

impl SceneArguments {
    /// Reads, checks and plans the scene; warnings go to stderr.
    pub(crate) fn load(&self, context: Context) -> Result<(Scene, Plan), Failure> {
        load(&self.scene, &self.policies, context)
    }
}

/// Reads, checks and plans the scene file at `path`; warnings go to stderr.
pub(crate) fn load(path: &Path, policies: &PolicyArguments, context: Context) -> Result<(Scene, Plan), Failure> {
    let (loaded, policies) = read(path, policies, context)?;
    Ok((loaded.scene, Plan { policies, ..loaded.plan }))
}

/// The same of a scene that says what its picture ought to show.
pub(crate) fn load_with_truth(
    path: &Path,
    policies: &PolicyArguments,
    context: Context,
) -> Result<((Scene, Plan), Truth), Failure> {
    let (loaded, policies) = read(path, policies, context)?;
    let Some(truth) = loaded.truth else {
        return Err(Failure::invalid(
            "NB0396",
            format!("`{}` does not say what its picture ought to show", path.display()),
            "give the scene a `truth: (lights: [...])`; docs/scene-format.md describes it",
        ));
    };
    Ok(((loaded.scene, Plan { policies, ..loaded.plan }), truth))
}

fn read(path: &Path, policies: &PolicyArguments, context: Context) -> Result<(Loaded, Policies), Failure> {
    let policies = policies.policies()?;
    let loaded = scene::load(path, &Limits::default()).map_err(|error| refused(&error, context))?;
    if !loaded.warnings.is_empty() {
        terminal::print(Level::Warning, &Report::Text(loaded.render_warnings(context.color)), context.color);
    }
    Ok((loaded, policies))
}

impl PolicyArguments {
    /// Whether none is chosen.
    pub(crate) fn is_empty(&self) -> bool {
        self.policies.is_empty()
    }

    /// The policies of the command line.
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

/// A scene that was not accepted.
pub(crate) fn refused(error: &SceneError, context: Context) -> Failure {
    let exit = match error.kind() {
        ErrorKind::Invalid => Exit::Invalid,
        ErrorKind::Missing => Exit::Missing,
        ErrorKind::Limit => Exit::Limit,
    };
    Failure { exit, report: Report::Text(error.render(context.color)) }
}

/// Index of the target of that name, or of the first.
pub(crate) fn chosen_target(scene: &Scene, name: Option<&str>) -> Result<usize, Failure> {
    let Some(name) = name else { return Ok(0) };
    scene.targets.iter().position(|target| target.name == name).ok_or_else(|| {
        let names: Vec<_> = scene.targets.iter().map(|target| format!("`{}`", target.name)).collect();
        Failure::usage(format!("the scene has no target `{name}`"), format!("its targets: {}", names.join(", ")))
    })
}

/// The draws that are meant, with their numbers: one, or all.
pub(crate) fn chosen_draws(scene: &Scene, number: Option<usize>) -> Result<Vec<(usize, &Draw)>, Failure> {
    let all = scene.draws.iter().enumerate();
    let Some(number) = number else { return Ok(all.collect()) };
    if number >= scene.draws.len() {
        let names: Vec<String> = all.take(16).map(|(n, draw)| format!("{n} `{}`", draw.name)).collect();
        let message = format!("the scene has no draw {number}");
        return Err(Failure::usage(message, format!("its draws: {}", names.join(", "))));
    }
    Ok(all.skip(number).take(1).collect())
}

/// Refuses to write over what is read.
pub(crate) fn refuse_overwriting(input: &Path, output: &Destination) -> Result<(), Failure> {
    let Destination::File(output) = output else { return Ok(()) };
    match (input.canonicalize(), output.canonicalize()) {
        (Ok(input), Ok(place)) if input == place => {
            Err(Failure::usage(format!("`{}` is the input", output.display()), "write the output to another file"))
        }
        _ => Ok(()),
    }
}
