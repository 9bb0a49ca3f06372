//! Strips of pictures: the picture of each technique for a light, and its error below.

use super::canvas::{Canvas, Image, TextAnchor};
use super::labels::{Rect, text_width};
use super::page::number;
use super::questions::Light;
use crate::accuracy::Pictures;
use ninebit_scene::generate::byte;

/// Side of a picture in pixels.
const TILE: f64 = 128.0;
const GAP: f64 = 14.0;
/// Maximum number of pictures in a row.
const MOST_ACROSS: usize = 7;
/// Number of lines for a name.
const LINES: usize = 3;
/// Height in pixels of a caption: the name, and a line for the error.
const CAPTION: f64 = 60.0;
const INK: &str = "#222222";
const PALE: &str = "#767676";
/// Error in steps that is shown in full colour.
const FULL: f64 = 64.0;
const LEGEND: &str = "Below each picture its error: red is too bright, blue too dark; full colour from 64 steps on, half of it at 16, a quarter at 4.";

/// Returns the strip of a light: the truth, then its techniques from the most accurate on.
pub(super) fn of_light(light: &Light<'_>) -> Canvas {
    let ways = light.techniques();
    // Rows of about the same length: none ends with a single picture.
    let rows = (ways.len() + 1).div_ceil(MOST_ACROSS);
    let across = (ways.len() + 1).div_ceil(rows);
    let height = CAPTION + 2.0 * TILE + GAP + 10.0;
    let width = (2.0 * GAP + across as f64 * (TILE + GAP)).max(text_width(LEGEND, 11.0) + 32.0);
    let mut canvas = Canvas::new(width, 66.0 + rows as f64 * height);
    canvas.text([16.0, 26.0], TextAnchor::Start, 15, INK, &light.title);
    canvas.text([16.0, 46.0], TextAnchor::Start, 11, PALE, LEGEND);
    let place = |n: usize| [16.0 + (n % across) as f64 * (TILE + GAP), 62.0 + (n / across) as f64 * height];
    if let Some(first) = ways.first() {
        let [x, y] = place(0);
        caption(&mut canvas, [x, y], "the truth", "float64, rounded");
        canvas.image(tile(x, y + CAPTION), image(&first.accuracy.pictures, truth));
    }
    for (n, way) in ways.iter().enumerate() {
        let [x, y] = place(n + 1);
        caption(&mut canvas, [x, y], &way.title, &format!("{} rms", number(way.rms())));
        canvas.image(tile(x, y + CAPTION), image(&way.accuracy.pictures, pixel_color));
        canvas.image(tile(x, y + CAPTION + TILE + 4.0), image(&way.accuracy.pictures, error));
    }
    canvas
}

fn tile(x: f64, y: f64) -> Rect {
    Rect { x, y, width: TILE, height: TILE }
}

/// Writes a name, and a line below.
fn caption(canvas: &mut Canvas, [x, y]: [f64; 2], name: &str, below: &str) {
    let mut lines = vec![String::new()];
    for word in name.split(' ') {
        let last = lines.len() - 1;
        let longer = format!("{} {word}", lines[last]).trim().to_owned();
        if lines[last].is_empty() || text_width(&longer, 11.0) <= TILE + GAP - 4.0 {
            lines[last] = longer;
        } else {
            lines.push(word.to_owned());
        }
    }
    for (n, line) in lines.iter().take(LINES).enumerate() {
        canvas.text([x, y + 12.0 + 14.0 * n as f64], TextAnchor::Start, 11, INK, line);
    }
    canvas.text([x, y + CAPTION - 6.0], TextAnchor::Start, 11, PALE, below);
}

/// Scales a picture to a fixed size by nearest sampling.
fn image(pictures: &Pictures, of: fn(&Pictures, usize) -> [u8; 3]) -> Image {
    let side = TILE as usize;
    let [width, height] = [pictures.width, pictures.height].map(|n| n as usize);
    let at = |n: usize| (n / side * height / side) * width + n % side * width / side;
    Image { width: side, pixels: (0..side * side).map(|n| of(pictures, at(n))).collect() }
}

/// Colour of pixels without a truth, on which dark edges stand out.
const GROUND: [u8; 3] = [150, 158, 168];

fn pixel_color(pictures: &Pictures, at: usize) -> [u8; 3] {
    let [r, g, b, _] = pictures.shown[at];
    if pictures.truth[at].is_some() { [r, g, b] } else { GROUND }
}

fn truth(pictures: &Pictures, at: usize) -> [u8; 3] {
    pictures.truth[at].map_or(GROUND, |color| color.map(byte))
}

/// Returns the colour of a pixel's largest channel error: white for none, red for too bright, blue for too dark.
fn error(pictures: &Pictures, at: usize) -> [u8; 3] {
    let Some(color) = pictures.truth[at] else { return [238; 3] };
    let errors = [0, 1, 2].map(|n| f64::from(pictures.shown[at][n]) - 255.0 * color[n]);
    let largest = errors.into_iter().fold(0.0_f64, |most, error| if error.abs() > most.abs() { error } else { most });
    let strength = (largest.abs() / FULL).min(1.0).sqrt();
    let toward = |full: u8| (255.0 - (255.0 - f64::from(full)) * strength).round() as u8;
    if largest > 0.0 { [200, 30, 20].map(toward) } else { [25, 60, 190].map(toward) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_has_its_colour() {
        let of = |byte: u8, truth: Option<f64>| {
            let pictures =
                Pictures { width: 1, height: 1, shown: vec![[byte; 4]], truth: vec![truth.map(|value| [value; 3])] };
            error(&pictures, 0)
        };
        assert_eq!(of(51, Some(0.2)), [255; 3]);
        assert_eq!(of(255, Some(0.0)), [200, 30, 20]);
        assert_eq!(of(0, Some(1.0)), [25, 60, 190]);
        assert_eq!(of(16, Some(0.0)), [228, 143, 138]);
        assert_eq!(of(16, None), [238; 3]);
    }
}
