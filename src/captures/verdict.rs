//! Verdicts on captured frames that are drawn again, by whatever draws them.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use ninebit::shown;
use ninebit_scene::diff::{self, Difference, Options};
use ninebit_scene::image::Rgba;

use crate::{Frame, LETTERS, SIZE, suites};

/// Maximum number of differing frames that are listed.
const SHOWN: usize = 20;

/// What a drawn frame is beside the captured one.
#[derive(Debug)]
pub struct Verdict {
    /// The frame.
    pub frame: Frame,
    /// Whether all compared pixels are those of the capture.
    pub exact: bool,
    /// If the captured picture is available and differs: the difference, and the first differing pixel as drawn and as captured.
    pub difference: Option<(Difference, [[u8; 4]; 2])>,
}

/// A picture that is no capture of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrongPicture(pub String);

impl WrongPicture {
    /// Code of the error.
    pub const CODE: &str = "NB0524";
    /// Advice for it.
    pub const HELP: &str = "take the pictures of the source that `ninebit captures list` names";
}

/// Returns an error and advice for the first name that is no suite of drawn frames.
pub fn unknown_suite(names: &[String]) -> Option<[String; 2]> {
    let unknown = names.iter().find(|name| !suites().any(|suite| suite == name.as_str()))?;
    let all: Vec<&str> = suites().collect();
    Some([format!("there is no suite `{}`", shown::name(unknown)), format!("the suites are {}", all.join(", "))])
}

/// Returns where the folder of the captures has the picture of a frame.
pub fn path(folder: &Path, frame: &Frame) -> PathBuf {
    folder.join(frame.suite).join(format!("{}.png", frame.name))
}

impl Verdict {
    /// Compares a drawn frame, R, G, B and A of every pixel, with the digest of the captured one, and with its picture and where that was read from.
    ///
    /// # Errors
    /// The picture is not the captured one.
    pub fn new(frame: Frame, pixels: Vec<[u8; 4]>, capture: Option<(&Path, &Rgba)>) -> Result<Verdict, WrongPicture> {
        let mut verdict = Verdict { exact: frame.is(&pixels), difference: None, frame };
        let Some((path, capture)) = capture else { return Ok(verdict) };
        if (capture.width(), capture.height()) != SIZE {
            let size = format!("{} x {}", capture.width(), capture.height());
            return Err(WrongPicture(format!("`{}` is {size}", shown::path(path))));
        }
        if !verdict.frame.is(capture.pixels()) {
            return Err(WrongPicture(format!("`{}` is not the picture that was measured", shown::path(path))));
        }
        // Printed letters are copied, so that they are equal.
        let mut masked = Rgba::new(SIZE.0, pixels);
        for at in verdict.frame.text.iter().flat_map(crate::pixels) {
            let captured = capture.pixels()[at];
            if captured == LETTERS {
                masked.pixels_mut()[at] = captured;
            }
        }
        let difference = diff::compare(&masked, capture, &Options { regions: 1, ..Options::default() });
        let difference = difference.map_err(|error| WrongPicture(error.to_string()))?;
        verdict.exact = difference.different == 0;
        if let Some(region) = difference.regions.first() {
            let at = region.first.1 as usize * SIZE.0 as usize + region.first.0 as usize;
            verdict.difference = Some((difference, [masked.pixels()[at], capture.pixels()[at]]));
        }
        Ok(verdict)
    }

    /// Returns whether the frame is exact, or differs as the table says. Without the captured picture the number of differing pixels is unknown.
    pub fn is_as_known(&self) -> bool {
        match (self.frame.open, &self.difference) {
            (None, _) => self.exact,
            (Some(open), Some((difference, _))) => difference.different == open.pixels,
            (Some(_), None) => !self.exact,
        }
    }
}

/// Returns the verdicts as a table of suites, with the frames that do not differ as the table of frames says.
pub fn text(verdicts: &[Verdict], has_captures: bool) -> String {
    let mut text = format!("{:<32}frames   exact         pixels\n", "suite");
    for suite in suites() {
        let of: Vec<&Verdict> = verdicts.iter().filter(|verdict| verdict.frame.suite == suite).collect();
        if of.is_empty() {
            continue;
        }
        let exact = of.iter().filter(|verdict| verdict.exact).count();
        let pixels: u64 = of.iter().map(|verdict| verdict.frame.compared()).sum();
        let _ = writeln!(text, "{suite:<32}{:>6}{exact:>8}{pixels:>15}", of.len());
    }
    let mut open = BTreeMap::<&str, (usize, u64)>::new();
    for known in verdicts.iter().filter(|verdict| verdict.is_as_known()).filter_map(|verdict| verdict.frame.open) {
        let of = open.entry(known.rule).or_default();
        *of = (of.0 + 1, of.1 + known.pixels);
    }
    for (rule, (frames, pixels)) in &open {
        let _ = writeln!(text, "open, {rule}: {}, {}", shown::count(*frames as u64, "frame"), diff::pixels(*pixels));
    }
    let differing: Vec<&Verdict> = verdicts.iter().filter(|verdict| !verdict.is_as_known()).collect();
    for Verdict { frame, difference, exact } in differing.iter().take(SHOWN) {
        let name = format!("{}/{}", frame.suite, frame.name);
        let _ = match difference {
            None if *exact => writeln!(text, "{name}: exact, and the table says that it is not"),
            None => writeln!(text, "{name}: another picture than the captured one"),
            Some((difference, [here, captured])) => {
                let (x, y) = difference.regions[0].first;
                let pixels = diff::pixels(difference.different);
                writeln!(text, "{name}: {pixels} differ; {x},{y} is {here:?}, captured {captured:?}")
            }
        };
    }
    if differing.len() > SHOWN {
        let _ = writeln!(text, "and {} more", differing.len() - SHOWN);
    }
    if !differing.is_empty() && !has_captures {
        text.push_str("with the captured pictures (`--captures DIR`) it is said which pixels\n");
    }
    let exact = verdicts.iter().filter(|verdict| verdict.exact).count();
    let _ = match differing.len() {
        0 if exact == verdicts.len() => writeln!(text, "{exact} frames: all exact"),
        0 => writeln!(text, "{} frames: {exact} exact, the others as known", verdicts.len()),
        count => writeln!(text, "{} frames: {count} differ", verdicts.len()),
    };
    text
}
