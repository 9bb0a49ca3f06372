//! The command `ninebit measure`: errors of pictures against the ground truth.

use super::*;

use ninebit_lab::accuracy::{accuracy_text, accuracy_value, measure};
use ninebit_scene::generate::byte;
use ninebit_scene::truth::{Truth, evaluate};

use super::scene::{each, load_with_truth};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scene files; each says in `truth` what its picture ought to show
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    state: StateArguments,
    #[command(flatten)]
    work: WorkArguments,
    /// A picture of the truth itself, rounded, a PNG; of one scene
    #[arg(long, value_name = "TRUTH.png", value_parser = picture::output("png"))]
    picture: Option<Destination>,
    /// How to print the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Measures scenes against their truths.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let picture = arguments.picture.as_ref();
    picture::beside_report(picture)?;
    if picture.is_some() && arguments.scenes.len() > 1 {
        return Err(Failure::usage("one picture of several truths", "measure one scene, or leave `--picture` out"));
    }
    let scenes: Vec<&Path> = arguments.scenes.iter().map(PathBuf::as_path).collect();
    let measured = each(&scenes, context, |path| {
        let ((scene, plan), truth) = load_with_truth(path, &arguments.state, arguments.work, context)?;
        picture.map_or(Ok(()), Destination::check)?;
        let accuracy = measure(&scene, &plan, &truth).ok_or_else(|| Failure::unseen(path))?;
        if let Some(picture) = picture {
            write_truth(&plan, &truth, picture)?;
        }
        Ok((path.to_path_buf(), accuracy))
    });
    let text = |(path, accuracy): &(PathBuf, _)| format!("{}\n{}", shown::path(path), accuracy_text(accuracy));
    let value = |(path, accuracy): &(PathBuf, _)| {
        let mut value = accuracy_value(accuracy);
        value["scene"] = shown::lossless(path).into();
        value
    };
    let document = || {
        let document = json!({
            "format": "ninebit-accuracy-2",
            "version": env!("CARGO_PKG_VERSION"),
            "scenes": measured.made.iter().map(value).collect::<Vec<_>>(),
            "failed": measured.failed,
        });
        format!("{document:#}")
    };
    if !measured.made.is_empty() {
        arguments.format.print(|| measured.made.iter().map(text).collect::<Vec<_>>().join("\n"), document)?;
    }
    measured.end()
}

/// Writes the truth of the first target, rounded to bytes; black where there is none.
fn write_truth(plan: &Plan, truth: &Truth, destination: &Destination) -> Result<(), Failure> {
    let frame = evaluate(plan, truth, 0);
    let colors = frame.pixels.iter().map(|pixel| pixel.as_ref().map_or([0; 3], |pixel| pixel.color.map(byte)));
    let pixels: Vec<[u8; 4]> = colors.map(|[r, g, b]| [r, g, b, 255]).collect();
    Ok(destination.write(&encode_png(frame.width, frame.height, &pixels, Compression::Small)?)?)
}
