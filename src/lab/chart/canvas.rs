//! A drawing of texts, lines, marks and pictures, as SVG and as PNG.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use kuva::backend::png::PngBackend;
use kuva::backend::svg::SvgBackend;
pub(super) use kuva::render::render::TextAnchor;
use kuva::render::render::{Primitive, Scene};
use std::fmt::Write;

use super::labels::Rect;
use super::picture::{Picture, SCALE, encode_error, text};
use ninebit_files::output::{Compression, OutputError, encode_png};

/// A picture of opaque pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Image {
    /// Width in pixels.
    pub width: usize,
    /// R, G, B of each pixel, row by row from the top.
    pub pixels: Vec<[u8; 3]>,
}

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
        scene.font_family = Some("DejaVu Sans, Liberation Sans, Arial, sans-serif".to_owned());
        Canvas { size: [width, height], scene, images: Vec::new() }
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

    /// Draws it in both formats.
    ///
    /// # Errors
    /// Returns an error if a PNG cannot be encoded.
    pub(super) fn draw(&self) -> Result<Picture, OutputError> {
        let size = self.size.map(|side| (side * f64::from(SCALE)) as u32);
        let fail = |reason| encode_error(size, reason);
        let mut svg = SvgBackend::new().render_scene(&self.scene).trim_end().trim_end_matches("</svg>").to_owned();
        let drawn = PngBackend::new().with_scale(SCALE).render_scene(&self.scene).map_err(fail)?;
        let drawn = image::load_from_memory(&drawn).map_err(|error| fail(error.to_string()))?.to_rgba8();
        let (width, height) = drawn.dimensions();
        let mut pixels: Vec<[u8; 4]> = drawn.pixels().map(|pixel| pixel.0).collect();
        for (place, image) in &self.images {
            let rows = image.pixels.len() / image.width.max(1);
            let own: Vec<[u8; 4]> = image.pixels.iter().map(|[r, g, b]| [*r, *g, *b, 255]).collect();
            let png = STANDARD.encode(encode_png(image.width as u32, rows as u32, &own, Compression::Small)?);
            let Rect { x, y, width: across, height: down } = place;
            // Writing to a string cannot fail.
            let _ = write!(
                svg,
                r#"<image x="{x}" y="{y}" width="{across}" height="{down}" style="image-rendering:pixelated" href="data:image/png;base64,{png}"/>"#
            );
            let scale = f64::from(SCALE);
            let [left, top] = [x * scale, y * scale].map(|edge| edge.round() as usize);
            let [columns, lines] = [across * scale, down * scale].map(|side| side.round() as usize);
            for line in 0..lines.min((height as usize).saturating_sub(top)) {
                for column in 0..columns.min((width as usize).saturating_sub(left)) {
                    let from = line * rows / lines * image.width + column * image.width / columns;
                    pixels[(top + line) * width as usize + left + column] = own[from];
                }
            }
        }
        Ok(Picture { svg: svg + "</svg>\n", png: encode_png(width, height, &pixels, Compression::Small)? })
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
        let picture = canvas.draw().unwrap();
        assert!(picture.svg.contains("a &lt; b") && picture.svg.contains("data:image/png;base64,"));
        assert!(picture.svg.ends_with("</svg>\n") && picture.svg.matches("</svg>").count() == 1);
        let png = image::load_from_memory(&picture.png).unwrap().to_rgb8();
        assert_eq!(png.dimensions(), (120, 80));
        let at = |x, y| png.get_pixel(x, y).0;
        assert_eq!(
            [at(21, 41), at(39, 41), at(21, 59), at(39, 59)],
            [[255, 0, 0], [0, 255, 0], [0, 0, 255], [9, 9, 9]]
        );
        assert_eq!(at(19, 41), [255, 255, 255]);
    }
}
