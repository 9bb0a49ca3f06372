//! Compares frames with those of the engine.

use std::fmt::Write;

use ninebit::engine::trace;
use ninebit::frame::Frames;
use ninebit::plan::Plan;

/// Returns the first pixel of each target whose word or depth differs from the engine's, with how it came to be; `None` if all are equal.
pub fn difference(plan: &Plan, wanted: &Frames, found: &Frames) -> Option<String> {
    let mut text = String::new();
    for (target, (wanted, found)) in wanted.surfaces.iter().zip(&found.surfaces).enumerate() {
        for (wanted, found, of) in [(&wanted.words, &found.words, "word"), (&wanted.depth, &found.depth, "depth")] {
            let different: Vec<usize> = (0..wanted.len()).filter(|at| wanted[*at] != found[*at]).collect();
            let Some(at) = different.first() else { continue };
            let width = plan.targets()[target].width as usize;
            let pixel = ((at % width) as u32, (at / width) as u32);
            let _ = writeln!(
                text,
                "target {target}, {} pixels: {of} of {},{} is {:#x}, not {:#x}",
                different.len(),
                pixel.0,
                pixel.1,
                found[*at],
                wanted[*at]
            );
            for draw in trace(plan, target, pixel, None).map(|trace| trace.draws).unwrap_or_default() {
                let _ = writeln!(text, "    draw {}", draw.draw);
                for step in draw.steps {
                    let _ =
                        writeln!(text, "        {} = {} 2^{} ({})", step.name, step.value, step.exponent, step.rule);
                }
            }
        }
    }
    (!text.is_empty()).then_some(text)
}
