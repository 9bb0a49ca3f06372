//! A drawing made of texts, lines, marks and pictures, as SVG and as PNG. It knows where its texts stand.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use kuva::backend::png::PngBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::render::{Primitive, Scene, TextAnchor};
use std::fmt::Write;

use super::labels::{Rect, text_width};
use super::picture::{Picture, SCALE, encode_error};
use ninebit_files::output::{Compression, OutputError, encode_png};

/// Which part of a text stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// It begins there.
    Left,
    /// Its middle is there.
    Middle,
    /// It ends there.
    Right,
}

/// Pixels of a picture, row by row, R, G, B.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels across.
    pub width: usize,
    /// Its rows one after another.
    pub pixels: Vec<[u8; 3]>,
}

/// A drawing; sizes and places are in pixels of the SVG from the top left, the PNG has twice as many each way.
pub struct Canvas {
    size: [f64; 2],
    scene: Scene,
    texts: Vec<(String, Rect)>,
    images: Vec<(Rect, Image)>,
}

impl std::fmt::Debug for Canvas {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Canvas").field("size", &self.size).field("texts", &self.texts).finish_non_exhaustive()
    }
}

impl Canvas {
    /// A white one.
    pub fn new(width: f64, height: f64) -> Canvas {
        let mut scene = Scene::new(width, height);
        scene.background_color = Some("#ffffff".to_owned());
        scene.font_family = Some("DejaVu Sans, Liberation Sans, Arial, sans-serif".to_owned());
        Canvas { size: [width, height], scene, texts: Vec::new(), images: Vec::new() }
    }

    /// A text whose baseline is at `y`.
    pub fn text(&mut self, [x, y]: [f64; 2], side: Side, size: u32, color: &str, text: &str) {
        let width = text_width(text, f64::from(size));
        let (left, anchor) = match side {
            Side::Left => (x, TextAnchor::Start),
            Side::Middle => (x - width / 2.0, TextAnchor::Middle),
            Side::Right => (x - width, TextAnchor::End),
        };
        let height = f64::from(size);
        self.texts.push((text.to_owned(), Rect { x: left, y: y - 0.8 * height, width, height }));
        let (content, color) = (text.to_owned(), Some(color.into()));
        self.scene.add(Primitive::Text { x, y, content, size, anchor, rotate: None, bold: false, color });
    }

    /// A straight line.
    pub fn line(&mut self, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], color: &str, stroke_width: f64) {
        let stroke = color.into();
        self.scene.add(Primitive::Line { x1, y1, x2, y2, stroke, stroke_width, stroke_dasharray: None });
    }

    /// A filled rectangle.
    pub fn rectangle(&mut self, place: Rect, color: &str) {
        let Rect { x, y, width, height } = place;
        let fill = color.into();
        self.scene.add(Primitive::Rect { x, y, width, height, fill, stroke: None, stroke_width: None, opacity: None });
    }

    /// A disc, filled or as a ring.
    pub fn disc(&mut self, [cx, cy]: [f64; 2], r: f64, color: &str, filled: bool) {
        let fill = if filled { color } else { "#ffffff" }.into();
        let (stroke, stroke_width) = (Some(color.into()), Some(1.5));
        self.scene.add(Primitive::Circle { cx, cy, r, fill, fill_opacity: None, stroke, stroke_width });
    }

    /// A picture in a rectangle; its pixels stay sharp.
    pub fn image(&mut self, place: Rect, image: Image) {
        self.images.push((place, image));
    }

    /// Two texts that share a place, or one that leaves the drawing, if there are any.
    pub fn collision(&self) -> Option<(&str, &str)> {
        let whole = Rect { x: 0.0, y: 0.0, width: self.size[0], height: self.size[1] };
        for (n, (text, place)) in self.texts.iter().enumerate() {
            if place.overlap(&whole) + 1e-6 < place.width * place.height {
                return Some((text, "the edge"));
            }
            let other = self.texts[n + 1..].iter().find(|(_, other)| place.overlap(other) > 0.0);
            if let Some((other, _)) = other {
                return Some((text, other));
            }
        }
        None
    }

    /// The drawing in both formats.
    ///
    /// # Errors
    /// A PNG cannot be encoded.
    pub fn draw(&self) -> Result<Picture, OutputError> {
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
    fn pictures_stand_in_both_formats_and_texts_are_known() {
        let mut canvas = Canvas::new(60.0, 40.0);
        let image = Image { width: 2, pixels: vec![[255, 0, 0], [0, 255, 0], [0, 0, 255], [9, 9, 9]] };
        canvas.image(Rect { x: 10.0, y: 20.0, width: 10.0, height: 10.0 }, image);
        canvas.text([2.0, 12.0], Side::Left, 10, "#000000", "a < b");
        assert_eq!(canvas.collision(), None);
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
        canvas.text([20.0, 14.0], Side::Middle, 10, "#000000", "over");
        assert_eq!(canvas.collision(), Some(("a < b", "over")));
        let mut canvas = Canvas::new(60.0, 40.0);
        canvas.text([58.0, 14.0], Side::Left, 10, "#000000", "out");
        assert_eq!(canvas.collision(), Some(("out", "the edge")));
    }
}
