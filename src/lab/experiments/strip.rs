//! What the scenes of experiments are made of: strips of pixels, rows of texels, and the errors of what is drawn.

use std::fmt::Write;
use std::path::Path;

use super::{cos, encode, sin};
use ninebit::engine::{RenderOptions, render};
use ninebit::limits::Limits;
pub(super) use ninebit_scene::generate::byte;
use ninebit_scene::{SceneError, parse};

/// Pixels of a strip.
pub(super) const WIDTH: usize = 256;

/// Draws a scene; R, G, B, A of its first target.
pub(super) fn draw(text: &str) -> Result<Vec<[u8; 4]>, Box<SceneError>> {
    let loaded = parse(text, Path::new("experiment.ron"), &Limits::default())?;
    let frames = render(&loaded.plan, &RenderOptions::default());
    Ok(frames.surfaces.first().map(ninebit::frame::Surface::rgba8).unwrap_or_default())
}

/// A scene whose target is one row of pixels, black and transparent at first.
pub(super) fn scene(profile: &str, width: usize, names: &str, textures: &str, draws: &str) -> String {
    format!(
        "(version: 1, profile: {profile}, names: ({names}), targets: [(name: \"frame\", width: {width}, height: 1, \
         clear: (color: (0, 0, 0, 0)))], textures: {{ {textures} }}, draws: [{draws}])"
    )
}

/// Vertices that cover the row; `left` and `right` are further fields of those at its ends.
pub(super) fn row(width: usize, left: &str, right: &str) -> String {
    format!(
        "vertices: Window([(position: (0, 0), {left}), (position: ({width}, 0), {right}), (position: ({width}, 1), {right}), \
         (position: (0, 1), {left})]), topology: Quads"
    )
}

/// The row with coordinate set 0 running from 0 to 1.
pub(super) fn whole_row(width: usize) -> String {
    row(width, "t0: (0, 0)", "t0: (1, 0)")
}

/// A texture of one row of colours.
pub(super) fn colors(name: &str, texels: impl Iterator<Item = [u8; 3]>) -> String {
    let words: Vec<String> = texels.map(|[r, g, b]| format!("ff{r:02x}{g:02x}{b:02x}")).collect();
    format!("\"{name}\": (source: Texels(width: {}, height: 1, rows: [\"{}\"])), ", words.len(), words.join(" "))
}

/// A texture of rows of bytes, read as red, green, blue and alpha alike.
pub(super) fn bytes(name: &str, width: usize, texels: &[u8]) -> String {
    format!("\"{name}\": (format: I8, source: {}), ", byte_texels(width, texels))
}

/// The source of rows of bytes.
pub(super) fn byte_texels(width: usize, texels: &[u8]) -> String {
    let mut rows = String::new();
    for row in texels.chunks(width.max(1)) {
        rows.push('"');
        for byte in row {
            // Writing to a string cannot fail.
            let _ = write!(rows, "{byte:02x} ");
        }
        rows.push_str("\", ");
    }
    format!("Texels(width: {width}, height: {}, rows: [{rows}])", texels.len() / width.max(1))
}

/// The centre of a pixel along the strip, 0 to 1.
pub(super) fn centre(pixel: usize, width: usize) -> f64 {
    (pixel as f64 + 0.5) / width as f64
}

/// The angle at that share of the way between two, given in degrees.
pub(super) fn angle(low: f64, high: f64, share: f64) -> f64 {
    (low + (high - low) * share).to_radians()
}

/// The errors of a channel, in steps, against a formula of the pixel's centre; the formula is limited to 0..1.
pub(super) fn errors(pixels: &[[u8; 4]], channel: usize, ideal: impl Fn(f64) -> f64) -> Vec<f64> {
    let width = pixels.len();
    let error =
        |(x, pixel): (usize, &[u8; 4])| f64::from(pixel[channel]) - 255.0 * ideal(centre(x, width)).clamp(0.0, 1.0);
    pixels.iter().enumerate().map(error).collect()
}

/// The largest of some errors, whatever their sign.
pub(super) fn largest(errors: &[f64]) -> f64 {
    errors.iter().fold(0.0, |most: f64, error| most.max(error.abs()))
}

/// The largest error of what a scene shows in a channel.
pub(super) fn largest_error(text: &str, channel: usize, ideal: impl Fn(f64) -> f64) -> Result<f64, Box<SceneError>> {
    Ok(largest(&errors(&draw(text)?, channel, ideal)))
}

/// A program: the dot product of the normals that a register holds with a constant direction, then so many squarings.
pub(super) fn highlight(normals: &str, [r, g, b]: [u8; 3], squarings: usize) -> String {
    let squares = "(rgb: (a: Spare0, b: Spare0, ab: Spare0)), ".repeat(squarings);
    format!(
        "Combiners(constants: (({r}, {g}, {b})), stages: [(rgb: (a: ExpandNormal({normals}), b: ExpandNormal(ConstantColor0), \
         ab: Spare0, ab_dot: true)), {squares}], final_combiner: (d: Spare0))"
    )
}

/// A map of normals that lean so far along x.
pub(super) fn leaning(count: usize, tilt: impl Fn(usize) -> f64) -> String {
    colors("normals", (0..count).map(|n| encode([sin(tilt(n)), 0.0, cos(tilt(n))])))
}

/// The square root of the mean square.
pub(super) fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
