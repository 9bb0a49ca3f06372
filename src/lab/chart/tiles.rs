//! Pictures side by side, each with its caption.

use super::canvas::{Canvas, Image, TextAnchor};
use super::labels::{Rect, text_width};
use ninebit_files::output::OutputError;

/// A picture and its caption.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tile {
    /// The caption, a line.
    pub caption: String,
    /// Width in pixels.
    pub width: usize,
    /// R, G, B of each pixel, row by row from the top.
    pub pixels: Vec<[u8; 3]>,
}

const GAP: f64 = 14.0;
/// Width from which on a picture is large enough.
const WIDE: usize = 256;
const CAPTION: f64 = 18.0;

/// Returns rows of pictures as SVG. They are enlarged a whole number of times, to 256 pixels or more.
///
/// # Errors
/// Returns an error if a picture cannot be encoded.
pub fn svg(rows: &[Vec<Tile>]) -> Result<String, OutputError> {
    let size = |tile: &Tile| {
        let times = WIDE.div_ceil(tile.width.max(1));
        [tile.width, tile.pixels.len() / tile.width.max(1)].map(|side| (side * times) as f64)
    };
    let across = |tile: &Tile| size(tile)[0].max(text_width(&tile.caption, 12.0)) + GAP;
    let high = |row: &Vec<Tile>| row.iter().map(|tile| size(tile)[1]).fold(0.0, f64::max) + CAPTION + GAP;
    let width = rows.iter().map(|row| row.iter().map(across).sum::<f64>()).fold(0.0, f64::max) + GAP;
    let mut canvas = Canvas::new(width.ceil(), rows.iter().map(high).sum::<f64>() + GAP / 2.0);
    let mut y = GAP / 2.0;
    for row in rows {
        let mut x = GAP;
        for tile in row {
            let [width, height] = size(tile);
            canvas.text([x, y + 12.0], TextAnchor::Start, 12, "#222222", &tile.caption);
            let image = Image { width: tile.width, pixels: tile.pixels.clone() };
            canvas.image(Rect { x, y: y + CAPTION, width, height }, image);
            x += across(tile);
        }
        y += high(row);
    }
    canvas.svg()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pictures_are_enlarged() {
        let tile = |width, pixels: usize| Tile { caption: "a".to_owned(), width, pixels: vec![[9; 3]; pixels] };
        let drawn = svg(&[vec![tile(100, 200), tile(300, 300)]]).unwrap();
        assert!(drawn.contains(r#"width="300" height="6""#) && drawn.contains(r#"width="300" height="1""#), "{drawn}");
    }
}
