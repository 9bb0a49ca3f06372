//! Writes a captured frame as a scene.

use super::super::scene::write_scene;
use super::*;
use ninebit_files::output::write_text;
use ninebit_scene::write::{self, SceneFiles, WriteOptions};

#[derive(Debug, Args)]
pub(crate) struct ExportArguments {
    /// The frame by its suite and its name: `Stencil/Stencil_REPLACE`
    #[arg(value_name = "SUITE/FRAME")]
    frame: String,
    /// The folder of the scene, which is made if it does not exist
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Write pixel programs as register words
    #[arg(long)]
    register_words: bool,
}

/// Number of frames that a message names.
const NAMED: usize = 8;

pub(super) fn export(arguments: &ExportArguments) -> Result<(), Failure> {
    let frame = find(&arguments.frame)?;
    let path = write_scene(&arguments.output, &frame.name, &scene(&frame, arguments.register_words)?)?;
    Ok(write_text(&format!("{}\n", shown::path(&path)))?)
}

/// Finds the frame of a suite and a name.
fn find(wanted: &str) -> Result<Frame, Failure> {
    let unknown = |help: String| {
        let message = format!("there is no captured frame `{}`", shown::name(wanted));
        Failure::usage(message, help)
    };
    let (suite, name) = wanted.split_once('/').unwrap_or((wanted, ""));
    if !ninebit_captures::suites().any(|known| known == suite) {
        return Err(unknown("write SUITE/FRAME; `ninebit captures list` names the suites".to_owned()));
    }
    let mut of_suite = frames(&[suite])?;
    if let Some(at) = of_suite.iter().position(|frame| frame.name == name) {
        return Ok(of_suite.swap_remove(at));
    }
    let names: Vec<&str> = of_suite.iter().take(NAMED).map(|frame| frame.name.as_str()).collect();
    let more = if of_suite.len() > NAMED { ", and so on" } else { "" };
    Err(unknown(format!("frames of {suite} are {}{more}", names.join(", "))))
}

fn scene(frame: &Frame, register_words: bool) -> Result<SceneFiles, Failure> {
    let name = format!("{}/{}", frame.suite, frame.name);
    let refused = |why: &str| Failure::invalid("NB0525", format!("{name}: {why}"), "export another frame of the suite");
    let scene = frame.scene(&RenderOptions::default()).map_err(|errors| planned(frame, &errors))?;
    let scene = scene.ok_or_else(|| refused("the program drew on one memory in two formats, which no scene does"))?;
    let head = vec![
        format!("{name}: a frame of {SOURCE}."),
        "The program printed text over the picture, which is not drawn here.".to_owned(),
    ];
    let options = WriteOptions { head, register_words, ..WriteOptions::default() };
    write::scene(&scene, &options).map_err(|error| refused(&error.to_string()))
}
