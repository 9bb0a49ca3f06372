//! A drawing of texts, lines, marks and pictures, as SVG and as PNG.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use kuva::backend::png::PngBackend;
pub(super) use kuva::render::render::TextAnchor;
use kuva::render::render::{Primitive, Scene};
use std::fmt::Write;

use super::labels::Rect;
use super::picture::{text, text_of};
use ninebit_files::output::{Compression, OutputError, encode_png};

/// Typefaces of all drawings.
pub(super) const FONT: &str = "DejaVu Sans, Liberation Sans, Arial, sans-serif";

/// A picture of opaque pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: usize,
    /// R, G, B of each pixel, row by row from the top.
    pub pixels: Vec<[u8; 3]>,
}

impl Image {
    /// Encodes it as small as a decoder of PNG allows: greys take a byte each.
    fn png(&self) -> Result<Vec<u8>, OutputError> {
        let [width, height] = [self.width, self.pixels.len() / self.width.max(1)].map(|side| side as u32);
        let grey = self.pixels.iter().all(|[r, g, b]| r == g && g == b);
        let (bytes, color) = if grey {
            (self.pixels.iter().map(|pixel| pixel[0]).collect(), ExtendedColorType::L8)
        } else {
            (self.pixels.as_flattened().to_vec(), ExtendedColorType::Rgb8)
        };
        let mut out = Vec::new();
        PngEncoder::new_with_quality(&mut out, CompressionType::Best, FilterType::Adaptive)
            .write_image(&bytes, width, height, color)
            .map_err(|error| OutputError::Encode { width, height, reason: error.to_string() })?;
        Ok(out)
    }
}

/// Pixels of the PNG for one of the SVG, in each direction.
const SCALE: f32 = 2.0;

/// A drawing. Sizes and positions are in pixels of the SVG, from the top left; the PNG has [`SCALE`] times as many in each direction.
pub(super) struct Canvas {
    size: [f64; 2],
    scene: Scene,
    images: Vec<(Rect, Image)>,
}

impl Canvas {
    /// Returns a white drawing.
    pub(super) fn new(width: f64, height: f64) -> Canvas {
        let mut scene = Scene::new(width, height);
        scene.background_color = Some("#ffffff".to_owned());
        scene.font_family = Some(FONT.to_owned());
        Canvas { size: [width, height], scene, images: Vec::new() }
    }

    /// Returns a drawing that continues a scene.
    pub(super) fn over(scene: Scene, size: [f64; 2]) -> Canvas {
        Canvas { size, scene, images: Vec::new() }
    }

    /// Adds a text whose baseline is at `y`.
    pub(super) fn text(&mut self, at: [f64; 2], anchor: TextAnchor, size: u32, color: &str, content: &str) {
        self.scene.add(text(at, anchor, size, Some(color), content));
    }

    /// Adds a straight line.
    pub(super) fn line(&mut self, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], color: &str, stroke_width: f64) {
        let stroke = color.into();
        self.scene.add(Primitive::Line { x1, y1, x2, y2, stroke, stroke_width, stroke_dasharray: None });
    }

    /// Adds a filled rectangle.
    pub(super) fn rectangle(&mut self, place: Rect, color: &str) {
        let Rect { x, y, width, height } = place;
        let fill = color.into();
        self.scene.add(Primitive::Rect { x, y, width, height, fill, stroke: None, stroke_width: None, opacity: None });
    }

    /// Adds a disc, filled or as a ring.
    pub(super) fn disc(&mut self, [cx, cy]: [f64; 2], r: f64, color: &str, filled: bool) {
        let fill = if filled { color } else { "#ffffff" }.into();
        let (stroke, stroke_width) = (Some(color.into()), Some(1.5));
        self.scene.add(Primitive::Circle { cx, cy, r, fill, fill_opacity: None, stroke, stroke_width });
    }

    /// Adds a picture that fills a rectangle, without interpolation.
    pub(super) fn image(&mut self, place: Rect, image: Image) {
        self.images.push((place, image));
    }

    /// Draws it as SVG.
    ///
    /// # Errors
    /// Returns an error if a picture in it cannot be encoded.
    pub(super) fn svg(&self) -> Result<String, OutputError> {
        let mut svg = text_of(&self.scene).trim_end().trim_end_matches("</svg>").to_owned();
        for (Rect { x, y, width, height }, image) in &self.images {
            let png = STANDARD.encode(image.png()?);
            // Writing to a string cannot fail.
            let _ = write!(
                svg,
                r#"<image x="{x}" y="{y}" width="{width}" height="{height}" preserveAspectRatio="none" style="image-rendering:pixelated" href="data:image/png;base64,{png}"/>"#
            );
        }
        Ok(svg + "</svg>\n")
    }

    /// Draws it as PNG.
    ///
    /// # Errors
    /// Returns an error if it cannot be encoded.
    pub(super) fn png(&self) -> Result<Vec<u8>, OutputError> {
        let [width, height] = self.size.map(|side| (side * f64::from(SCALE)) as u32);
        let fail = |reason| OutputError::Encode { width, height, reason };
        let drawn = PngBackend::new().with_scale(SCALE).render_scene(&self.scene).map_err(fail)?;
        let drawn = image::load_from_memory(&drawn).map_err(|error| fail(error.to_string()))?.to_rgba8();
        let (width, height) = drawn.dimensions();
        let mut pixels: Vec<[u8; 4]> = drawn.pixels().map(|pixel| pixel.0).collect();
        for (place, image) in &self.images {
            let rows = image.pixels.len() / image.width.max(1);
            let [left, top, columns, lines] = [place.x, place.y, place.width, place.height]
                .map(|length| (length * f64::from(SCALE)).round() as usize);
            for line in 0..lines.min((height as usize).saturating_sub(top)) {
                for column in 0..columns.min((width as usize).saturating_sub(left)) {
                    let [r, g, b] = image.pixels[line * rows / lines * image.width + column * image.width / columns];
                    pixels[(top + line) * width as usize + left + column] = [r, g, b, 255];
                }
            }
        }
        encode_png(width, height, &pixels, Compression::Small)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_stand_in_both_formats() {
        let mut canvas = Canvas::new(60.0, 40.0);
        let image = Image { width: 2, pixels: vec![[255, 0, 0], [0, 255, 0], [0, 0, 255], [9, 9, 9]] };
        canvas.image(Rect { x: 10.0, y: 20.0, width: 10.0, height: 10.0 }, image);
        canvas.text([2.0, 12.0], TextAnchor::Start, 10, "#000000", "a < b");
        let svg = canvas.svg().unwrap();
        assert!(svg.contains("a &lt; b") && svg.contains("data:image/png;base64,"));
        assert!(svg.ends_with("</svg>\n") && svg.matches("</svg>").count() == 1);
        let png = image::load_from_memory(&canvas.png().unwrap()).unwrap().to_rgb8();
        assert_eq!(png.dimensions(), (120, 80));
        let at = |x, y| png.get_pixel(x, y).0;
        assert_eq!(
            [at(21, 41), at(39, 41), at(21, 59), at(39, 59)],
            [[255, 0, 0], [0, 255, 0], [0, 0, 255], [9, 9, 9]]
        );
        assert_eq!(at(19, 41), [255, 255, 255]);
    }
}
