//! Writes expectations from drawn pictures.

use std::path::Path;

use super::outcome::{Outcome, Problem, ProblemKind};
use crate::expectation::{Expectation, ExpectationError, depth_digest, masked_digest};
use ninebit::frame::Surface;
use ninebit::shown;
use ninebit_files::output::{Compression, Destination, OutputError, encode_png, write_file};
use ninebit_scene::path::resolve;

/// Returns whether the expectation may be replaced: captures and allowances are pictures from elsewhere.
pub(super) fn allowed(expectation: &Expectation) -> bool {
    expectation.capture.is_none() && expectation.allowance.is_none()
}

/// Writes the expectation that `surface` meets to `path`, replacing `before`, and the picture that it names.
///
/// # Errors
/// Returns an error if the mask cannot be used, or a file cannot be written.
pub(super) fn write(
    path: &Path,
    folder: &Path,
    target: &str,
    surface: &Surface,
    before: Option<&Expectation>,
) -> Result<Outcome, Problem> {
    let mut expectation = before.cloned().unwrap_or_else(|| Expectation::from_surface(target, surface));
    (expectation.width, expectation.height) = (surface.width, surface.height);
    let compared = expectation.compared(folder).map_err(|error| refused(path, &error))?;
    let pixels = surface.rgba8();
    let mut masked = pixels.clone();
    expectation.sha256 = masked_digest(surface.width, surface.height, &mut masked, &compared);
    expectation.depth = expectation.depth.map(|_| depth_digest(surface));
    if let Some(picture) = &expectation.picture {
        let png = encode_png(surface.width, surface.height, &pixels, Compression::Small).map_err(unwritten)?;
        // The name is checked even if there is no such file yet.
        let place = match resolve(folder, picture) {
            Ok(place) => place,
            Err(error) if error.is_missing() => folder.join(picture),
            Err(error) => return Err(refused(path, &error.into())),
        };
        Destination::File(place).write(&png).map_err(unwritten)?;
    }
    write_file(path, expectation.to_text().as_bytes()).map_err(unwritten)?;
    Ok(Outcome::Blessed { before: before.map(|before| before.sha256.clone()), after: expectation.sha256 })
}

/// Returns the problem of an expectation that cannot be used.
pub(super) fn refused(path: &Path, error: &ExpectationError) -> Problem {
    Problem::new(error.kind(), error.code(), format!("`{}`: {error}", shown::path(path)), &error.help())
}

/// Returns the problem of an output that was not written.
pub(super) fn unwritten(error: OutputError) -> Problem {
    Problem::new(ProblemKind::Output, error.code(), error.to_string(), error.help())
}
