//! The command `ninebit inspect`: a page that holds the model and a scene.

use super::*;
use std::collections::BTreeMap;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use ninebit::engine::render;
use ninebit::state::POLICIES;
use ninebit_scene::assets::Gathered;
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
    #[command(flatten)]
    work: WorkArguments,
}

/// Writes a page that shows the scene and computes it in the browser.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let policies = arguments.state.policies()?;
    let gathered = Gathered::default();
    let loaded = arguments.state.load(&arguments.scene, &gathered, context)?;
    loaded.affordable(arguments.work.pixels).map_err(refused)?;
    arguments.output.check()?;
    // The page does not reveal the folder of the scene.
    let name = match arguments.scene.file_name() {
        Some(name) if arguments.scene != Path::new("-") => shown::path(Path::new(name)),
        _ => "scene.ron".to_owned(),
    };
    let mut bundle = gathered.bundle();
    if let Some(family) = loaded.family {
        bundle.files.insert(family.name, family.text.into_bytes());
    }
    let files: BTreeMap<&String, String> =
        bundle.files.iter().map(|(name, bytes)| (name, STANDARD.encode(bytes))).collect();
    let data = json!({
        "name": name,
        "picture": first_picture(&loaded.plan, &policies)?,
        "version": env!("CARGO_PKG_VERSION"),
        "text": loaded.source.text,
        "files": files,
        "chosen": chosen(&policies),
        "policies": alternatives(),
        "rules": page::rules(),
        "undecided": { "none": undecided::sentence([], "this pixel"), "some": undecided::sentence(["{}"], "this pixel") },
    });
    Ok(arguments.output.write(page::page(&name, &data).as_bytes())?)
}

/// Returns the first target as a PNG, which is shown before the module is compiled. Returns `None` if the chosen policies may draw another picture.
fn first_picture(plan: &Plan, policies: &Policies) -> Result<Option<String>, Failure> {
    if *policies != plan.policies {
        return Ok(None);
    }
    let frames = render(plan, &RenderOptions::default());
    let Some(surface) = frames.surfaces.first() else { return Ok(None) };
    // The page's picture is opaque, whatever alpha the target has.
    let pixels: Vec<[u8; 4]> = surface.rgba8().into_iter().map(|[r, g, b, _]| [r, g, b, 255]).collect();
    Ok(Some(STANDARD.encode(encode_png(surface.width, surface.height, &pixels, Compression::Small)?)))
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
