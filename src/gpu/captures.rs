//! The command `captures`: captured frames of a real NV2A, drawn again by the GPU.

use ninebit_captures::verdict::{self, Verdict};
use ninebit_captures::{Frame, frames};
use ninebit_scene::image::{self, ImageLimits};

use super::*;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The folder `results` of the captures: compare with its pictures, SUITE/FRAME.png
    #[arg(long, value_name = "DIR")]
    captures: Option<PathBuf>,
    /// Draw this suite only; may be given several times
    #[arg(long = "suite", value_name = "SUITE")]
    suites: Vec<String>,
    /// Draw every Nth frame only
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    step: u32,
    #[command(flatten)]
    drawing: Drawing,
    #[command(flatten)]
    chosen: EngineChoice,
}

/// Draws captured frames and compares them.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some([error, help]) = verdict::unknown_suite(&arguments.suites) {
        return Err(Failure::usage(error, help));
    }
    let wanted: Vec<&str> = arguments.suites.iter().map(String::as_str).collect();
    let policies = arguments.drawing.policies()?;
    let gpu = arguments.chosen.open(&arguments.drawing)?;
    let all = frames(&wanted).map_err(|unmatched| Failure::fault(unmatched.to_string()))?;
    let (mut verdicts, mut different) = (Vec::new(), 0);
    for frame in all.into_iter().step_by(arguments.step as usize) {
        let drawn = draw(&frame, gpu.as_ref().map(|gpu| (gpu, arguments.drawing.text())), policies);
        if drawn.as_ref().is_err_and(Failure::is_unprinted) {
            continue;
        }
        let (pixels, text) = drawn?;
        if !text.is_empty() {
            different += 1;
            write_text(&format!("{}/{} has other words than our engine's\n{text}", frame.suite, frame.name))?;
        }
        let path = arguments.captures.as_deref().map(|folder| verdict::path(folder, &frame));
        let capture = path.as_ref().map(|path| image::load(path, &ImageLimits::default())).transpose()?;
        verdicts.push(Verdict::new(frame, pixels, path.as_deref().zip(capture.as_ref()))?);
    }
    write_text(&verdict::text(&verdicts, arguments.captures.is_some()))?;
    if gpu.is_some() {
        write_text(&format!("{} of {} have our engine's words\n", verdicts.len() - different, verdicts.len()))?;
    }
    let is_as_known = different == 0 && verdicts.iter().all(Verdict::is_as_known);
    if is_as_known { Ok(()) } else { Err(Failure::Printed(1)) }
}

/// Draws a frame: by the GPU if there is one, and by our engine. Returns the pixels, and what differs.
fn draw(frame: &Frame, gpu: Option<(&Gpu, Text)>, policies: Policies) -> Result<(Vec<[u8; 4]>, String), Failure> {
    let mut text = String::new();
    let pixels = frame.prepare(policies)?.render_by(|scene, plan| {
        let wanted = by_engine(plan);
        let Some((gpu, text_of)) = gpu else { return Ok(wanted) };
        let found = drawn(gpu, scene, plan, text_of)?;
        text += &difference(plan, &wanted, &found).unwrap_or_default();
        Ok::<Frames, Failure>(found)
    })?;
    Ok((pixels, text))
}
