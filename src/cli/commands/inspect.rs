//! The command `ninebit inspect`: a page that holds the model and a scene.

mod steps;

use super::*;
use std::collections::BTreeMap;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use ninebit::engine::render;
use ninebit::shortcut::{Shortcut, Shortcuts};
use ninebit::state::{Named, POLICIES};
use ninebit_scene::assets::RecordingFolder;
use ninebit_scene::{Heading, LoadedScene};
use serde_json::Value;

use super::scene::refused;
use crate::{page, undecided};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scene file, `-` for standard input
    scene: PathBuf,
    /// The page; `-` is stdout
    #[arg(short, long, value_name = "PAGE.html", value_parser = picture::output("html"))]
    output: Destination,
    #[command(flatten)]
    state: StateArguments,
    /// Begin with the picture as a renderer draws it that takes these shortcuts: `float-fog+vertex-fog`
    #[arg(long, value_name = "NAMES", value_parser = shortcuts)]
    shortcuts: Option<Shortcuts>,
    #[command(flatten)]
    work: WorkArguments,
}

/// Parses names of shortcuts.
fn shortcuts(names: &str) -> Result<Shortcuts, String> {
    let known = || Shortcut::ALL.iter().map(|shortcut| shortcut.name()).collect::<Vec<_>>().join(", ");
    Shortcuts::from_names(names).map_err(|name| format!("`{}` is not one of {}", shown::name(name), known()))
}

/// Writes a page that shows the scene and computes it in the browser.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let policies = arguments.state.policies()?;
    let gathered = RecordingFolder::default();
    let loaded = arguments.state.load(&arguments.scene, &gathered, context)?;
    loaded.affordable(arguments.work.pixels).map_err(refused)?;
    arguments.output.check()?;
    // The page does not reveal the folder of the scene.
    let name = match arguments.scene.file_name() {
        Some(name) if arguments.scene != Path::new("-") => shown::path(Path::new(name)),
        _ => "scene.ron".to_owned(),
    };
    // Policies and shortcuts may draw another picture than the one that is shown before the module is compiled.
    let is_default = policies == loaded.plan.policies && arguments.shortcuts.is_none();
    let picture = if is_default { first_picture(&loaded.plan) } else { None };
    let steps = steps::steps(&loaded.scene, policies, &loaded.source.text)?;
    let mut data = scene_data(&name, loaded, gathered, picture.as_ref())?;
    data["steps"] = steps.into();
    data["chosen"] = chosen(&policies);
    data["variant"] = arguments.shortcuts.map(Shortcuts::names).into();
    Ok(arguments.output.write(page::page(&name, &data, &common()).as_bytes())?)
}

/// Returns what a page holds of its scene. `picture` is shown before the module is compiled.
pub(super) fn scene_data(
    name: &str,
    loaded: LoadedScene,
    gathered: RecordingFolder,
    picture: Option<&Picture>,
) -> Result<Value, Failure> {
    let mut bundle = gathered.bundle();
    if let Some(family) = loaded.family {
        bundle.files.insert(family.name, family.text.into_bytes());
    }
    let files: BTreeMap<&String, String> =
        bundle.files.iter().map(|(name, bytes)| (name, STANDARD.encode(bytes))).collect();
    let png = picture.map(|(width, height, pixels)| encode_png(*width, *height, pixels, Compression::Small));
    Ok(json!({
        "name": name,
        "title": Heading::new(&loaded.source.text, "").title,
        "picture": png.transpose()?.map(|png| STANDARD.encode(png)),
        "text": loaded.source.text,
        "files": files,
        "chosen": {},
    }))
}

/// Returns what all pages hold: the handbook and the policies.
pub(super) fn common() -> Value {
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "policies": alternatives(),
        "rules": page::rules(),
        "undecided": { "none": undecided::sentence([], "this pixel"), "some": undecided::sentence(["{}"], "this pixel") },
    })
}

/// Width, height and opaque pixels, row by row.
pub(super) type Picture = (u32, u32, Vec<[u8; 4]>);

/// Draws the first target, opaque, whatever alpha it has. `None` if there is no target.
pub(super) fn first_picture(plan: &Plan) -> Option<Picture> {
    let frames = render(plan, &RenderOptions::default());
    let surface = frames.surfaces.first()?;
    Some((surface.width, surface.height, surface.rgba8().into_iter().map(|[r, g, b, _]| [r, g, b, 255]).collect()))
}

/// Returns the rules that have alternatives.
fn alternatives() -> Value {
    let rule = |policy: &ninebit::state::Policy| {
        let values: Vec<Value> =
            policy.values.iter().map(|(value, meaning)| json!({ "value": value, "meaning": meaning })).collect();
        json!({ "rule": policy.rule, "question": policy.question, "values": values })
    };
    POLICIES.iter().map(rule).collect()
}

/// Returns the value of each rule that is not at its default.
fn chosen(policies: &Policies) -> Value {
    let differing = POLICIES.iter().filter(|policy| policies.chosen(policy.rule) != 0);
    Value::Object(differing.map(|p| (p.rule.to_string(), json!(p.values[policies.chosen(p.rule)].0))).collect())
}
