//! Heat map: the errors of a comparison as a picture, with a legend.
#![allow(clippy::float_arithmetic, reason = "a picture of errors")]

use super::Comparison;

/// Reason why a comparison has no heat map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HeatError {
    /// No pixel differs, so there is nothing to scale by.
    #[error("there is nothing to show: no pixel of the frame differs from the ideal")]
    NoDifference,
    /// The mode has no errors per pixel.
    #[error("errors of single rules belong to no pixel")]
    NoPixels,
}

/// A picture: width, height, and R, G, B, A of its pixels.
pub(super) type Picture = (u32, u32, Vec<[u8; 4]>);

/// Classes of the scale: upper end in steps of 1/255, colour, and label. An error e belongs to the first class whose upper end is at least |e|.
const CLASSES: [(f64, [u8; 3], &str); 9] = [
    (0.5, [8, 12, 40], "0.5"),
    (1.0, [22, 50, 120], "1"),
    (2.0, [20, 120, 160], "2"),
    (3.0, [30, 160, 110], "3"),
    (4.0, [130, 190, 60], "4"),
    (6.0, [230, 200, 40], "6"),
    (8.0, [240, 140, 30], "8"),
    (16.0, [225, 60, 40], "16"),
    (f64::INFINITY, [255, 220, 230], "16+"),
];

/// Colour of pixels that nothing drew.
const EMPTY: [u8; 3] = [40, 40, 40];
/// Colour of pixels that are left out because a decision differs.
const DIVERGED: [u8; 3] = [200, 0, 200];

/// Size of a font dot in pixels.
const DOT: u32 = 2;
const LEGEND_ROWS: u32 = 36;
const MARGIN: u32 = 8;
const BOX: u32 = 16;

/// Draws a heat map: the colour of a pixel shows the largest error of its channels. Below the frame is a legend with the upper end of each class in
/// steps of 1/255, the colour of pixels that nothing drew, and that of those that are left out.
///
/// # Errors
/// Returns an error if no pixel differs, or the mode has no errors per pixel.
pub fn heat_map(comparison: &Comparison) -> Result<Picture, HeatError> {
    if comparison.errors.is_empty() {
        return Err(HeatError::NoPixels);
    }
    if comparison.diverged == 0 && comparison.channels.iter().all(|c| c.errors.max() == 0.0) {
        return Err(HeatError::NoDifference);
    }
    let mut entries: Vec<([u8; 3], &str)> = CLASSES.iter().map(|(_, color, label)| (*color, *label)).collect();
    entries.push((EMPTY, "none"));
    entries.push((DIVERGED, "left out"));
    const UNIT: &str = "steps";
    let text_width = |label: &str| label.chars().count() as u32 * 4 * DOT;
    let unit = MARGIN + text_width(UNIT);
    let needed = unit + MARGIN + entries.iter().map(|(_, label)| BOX + 4 + text_width(label) + MARGIN).sum::<u32>();
    let (width, rows) = (comparison.width.max(needed), comparison.height);
    let mut pixels = vec![[16, 16, 16, 255]; (width * (rows + LEGEND_ROWS)) as usize];
    for (at, shown) in comparison.heat().into_iter().enumerate() {
        let (x, y) = (at as u32 % comparison.width, at as u32 / comparison.width);
        pixels[(y * width + x) as usize] = shown;
    }
    let top = rows + (LEGEND_ROWS - BOX) / 2;
    let text = top + (BOX - 5 * DOT) / 2;
    write(&mut pixels, width, (MARGIN, text), UNIT);
    let mut left = unit + MARGIN;
    for (color, label) in entries {
        let [r, g, b] = color;
        for y in top..top + BOX {
            for x in left..left + BOX {
                let border = y == top || y == top + BOX - 1 || x == left || x == left + BOX - 1;
                pixels[(y * width + x) as usize] = if border { [160, 160, 160, 255] } else { [r, g, b, 255] };
            }
        }
        left += BOX + 4;
        write(&mut pixels, width, (left, text), label);
        left += text_width(label) + MARGIN;
    }
    Ok((width, rows + LEGEND_ROWS, pixels))
}

/// Returns the colour of an error magnitude in steps of 1/255.
pub fn heat_color(error: f64) -> [u8; 3] {
    CLASSES.iter().find(|(most, ..)| error <= *most).map_or(EMPTY, |(_, color, _)| *color)
}

/// Returns the label and colour of each class of errors, then those for pixels that nothing drew and for pixels that are left out.
pub fn heat_classes() -> Vec<(&'static str, [u8; 3])> {
    let classes = CLASSES.iter().map(|(_, color, label)| (*label, *color));
    classes.chain([("nothing drawn", EMPTY), ("left out: a test or a choice differs", DIVERGED)]).collect()
}

impl Comparison {
    /// Returns the colours of the pixels' errors, row by row, without a legend.
    pub fn heat(&self) -> Vec<[u8; 4]> {
        let shown = |errors: &[f32; 4]| {
            let largest = errors.iter().filter(|e| !e.is_nan()).map(|e| f64::from(e.abs())).reduce(f64::max);
            // Infinity marks a pixel that was drawn and is left out; NaN one that nothing drew.
            let [r, g, b] = if errors[0].is_infinite() { DIVERGED } else { largest.map_or(EMPTY, heat_color) };
            [r, g, b, 255]
        };
        self.errors.iter().map(shown).collect()
    }
}

/// Returns the glyph of a legend's character: 5 rows of 3 dots.
fn glyph(character: char) -> [u8; 5] {
    match character {
        '0' => [7, 5, 5, 5, 7],
        '1' => [2, 6, 2, 2, 7],
        '2' => [7, 1, 7, 4, 7],
        '3' => [7, 1, 7, 1, 7],
        '4' => [5, 5, 7, 1, 1],
        '5' => [7, 4, 7, 1, 7],
        '6' => [7, 4, 7, 5, 7],
        '8' => [7, 5, 7, 5, 7],
        '+' => [0, 2, 7, 2, 0],
        'e' => [7, 4, 6, 4, 7],
        'f' => [7, 4, 6, 4, 4],
        'l' => [4, 4, 4, 4, 7],
        'n' => [7, 5, 5, 5, 5],
        'o' => [7, 5, 5, 5, 7],
        'p' => [7, 5, 7, 4, 4],
        's' => [7, 4, 7, 1, 7],
        't' => [7, 2, 2, 2, 2],
        'u' => [5, 5, 5, 5, 7],
        '.' => [0, 0, 0, 0, 2],
        _ => [0; 5],
    }
}

fn write(pixels: &mut [[u8; 4]], width: u32, (left, top): (u32, u32), label: &str) {
    for (n, character) in label.chars().enumerate() {
        for (row, dots) in glyph(character).into_iter().enumerate() {
            for column in (0..3).filter(|c| dots >> (2 - c) & 1 != 0) {
                let (x, y) = (left + (n as u32 * 4 + column) * DOT, top + row as u32 * DOT);
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    pixels[((y + dy) * width + x + dx) as usize] = [230, 230, 230, 255];
                }
            }
        }
    }
}
