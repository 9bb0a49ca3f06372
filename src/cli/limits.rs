//! `ninebit limits`.

use std::fmt::Write;

use ninebit::output::write_stdout;
use ninebit::scene::image::ImageLimits;
use ninebit::scene::mesh::MAXIMUM_VERTICES;

use super::exit::Failure;

/// Prints the limits, one a line: name, value, unit.
pub(crate) fn run() -> Result<(), Failure> {
    let image = ImageLimits::default();
    let rows = [
        ("image side", u64::from(image.maximum_side), "pixels"),
        ("image, decoded", image.maximum_decoded_bytes, "bytes"),
        ("image file", image.maximum_file_bytes, "bytes"),
        ("mesh", u64::from(MAXIMUM_VERTICES), "vertices"),
    ];
    let mut text = String::new();
    for (name, value, unit) in rows {
        let _ = writeln!(text, "{name:<32}{value:>12} {unit}");
    }
    Ok(write_stdout(text.as_bytes())?)
}
