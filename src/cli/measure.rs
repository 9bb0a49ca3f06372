//! `ninebit measure`.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::Args;
use ninebit::accuracy::{accuracy_text, accuracy_value, measure};
use ninebit::generate::byte;
use ninebit::output::{Compression, Destination, encode_png, write_stdout};
use ninebit::plan::Plan;
use ninebit::truth::{Truth, evaluate};
use serde_json::json;

use super::exit::Failure;
use super::scene::{PolicyArguments, load_with_truth, refuse_overwriting};
use super::{Context, Format};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scene files; each says in `truth` what its picture ought to show
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    policies: PolicyArguments,
    /// A picture of the truth itself, rounded, a PNG; of one scene
    #[arg(long, value_name = "TRUTH.png")]
    picture: Option<OsString>,
    /// How to print the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Measures scenes against their truths.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let picture = arguments.picture.as_deref().map(Destination::from);
    match (&picture, &arguments.scenes[..]) {
        (Some(Destination::Stdout), _) => {
            return Err(Failure::usage(
                "the picture and the report cannot both go to stdout",
                "write the picture to a file",
            ));
        }
        (Some(picture), [scene]) => refuse_overwriting(scene, picture)?,
        (Some(_), _) => {
            return Err(Failure::usage("one picture of several truths", "measure one scene, or leave `--picture` out"));
        }
        (None, _) => {}
    }
    let mut text = String::new();
    let mut values = Vec::new();
    for (number, path) in arguments.scenes.iter().enumerate() {
        let (loaded, truth) = load_with_truth(path, &arguments.policies, context)?;
        let (scene, plan) = loaded;
        let Some(accuracy) = measure(&scene, &plan, &truth) else {
            return Err(Failure::unseen(path));
        };
        if let Some(picture) = &picture {
            write_truth(&plan, &truth, picture)?;
        }
        match arguments.format {
            Format::Text => {
                if number > 0 {
                    text.push('\n');
                }
                text.push_str(&format!("{}\n{}", path.display(), accuracy_text(&accuracy)));
            }
            Format::Json => values.push(entry(path, accuracy_value(&accuracy))),
        }
    }
    if matches!(arguments.format, Format::Json) {
        let value = json!({ "format": "ninebit-accuracy-1", "version": env!("CARGO_PKG_VERSION"), "scenes": values });
        text = format!("{value:#}\n");
    }
    Ok(write_stdout(text.as_bytes())?)
}

fn entry(path: &Path, mut value: serde_json::Value) -> serde_json::Value {
    value["scene"] = path.display().to_string().into();
    value
}

/// The truth of the first target, rounded; black where there is none.
fn write_truth(plan: &Plan, truth: &Truth, destination: &Destination) -> Result<(), Failure> {
    let frame = evaluate(plan, truth, 0);
    let pixels: Vec<[u8; 4]> = frame
        .pixels
        .iter()
        .map(|pixel| {
            let [r, g, b] = pixel.as_ref().map_or([0; 3], |pixel| pixel.color.map(byte));
            [r, g, b, 255]
        })
        .collect();
    Ok(destination.write(&encode_png(frame.width, frame.height, &pixels, Compression::Small)?)?)
}
