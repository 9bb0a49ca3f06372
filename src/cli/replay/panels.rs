//! Expected picture, drawn picture and amplified difference in one picture.

use std::borrow::Cow;
use std::path::Path;

use ninebit_files::output::{Compression, encode_png};
use ninebit_scene::diff::{SizeError, highlight};
use ninebit_scene::image::{self, ImageLimits, Rgba};

/// Width of the gap between two panels, in pixels.
pub(in crate::replay) const GAP: usize = 8;

/// Colour of the gaps: a grey that is unlikely at the edge of a frame.
const BETWEEN: [u8; 4] = [96, 96, 96, 255];

/// Returns expected picture, drawn picture and difference from left to right, opaque, and the amplification of the difference.
pub(super) fn panels(expected: &Rgba, drawn: &Rgba) -> Result<(Rgba, u8), SizeError> {
    let difference = highlight(expected, drawn, false)?;
    let (width, height) = (expected.width() as usize, expected.height() as usize);
    let mut pixels = Vec::with_capacity((3 * width + 2 * GAP) * height);
    for y in 0..height {
        for (panel, picture) in [expected, drawn, &difference.picture].into_iter().enumerate() {
            if panel > 0 {
                pixels.extend([BETWEEN; GAP]);
            }
            let row = picture.pixels().iter().skip(y * width).take(width);
            pixels.extend(row.map(|[r, g, b, _]| [*r, *g, *b, 255]));
        }
    }
    let picture = Rgba::new((3 * width + 2 * GAP) as u32, pixels);
    Ok((picture, difference.scale))
}

/// Returns a PNG of this program without its alpha, for people to look at.
pub(in crate::replay) fn opaque(png: &[u8]) -> Cow<'_, [u8]> {
    let shown = image::decode(png, Path::new("drawn.png"), &ImageLimits::default()).ok().and_then(|picture| {
        let pixels: Vec<[u8; 4]> = picture.pixels().iter().map(|[r, g, b, _]| [*r, *g, *b, 255]).collect();
        encode_png(picture.width(), picture.height(), &pixels, Compression::Fast).ok()
    });
    shown.map_or(Cow::Borrowed(png), Cow::Owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_for_people_are_opaque() {
        let png = encode_png(2, 1, &[[1, 2, 3, 0], [4, 5, 6, 255]], Compression::Fast).expect("a small picture");
        let shown = image::decode(&opaque(&png), Path::new("a.png"), &ImageLimits::default()).expect("a PNG");
        assert_eq!(shown.pixels(), [[1, 2, 3, 255], [4, 5, 6, 255]]);
        assert_eq!(opaque(b"no PNG")[..], b"no PNG"[..]);
    }

    #[test]
    fn three_pictures_stand_side_by_side() {
        let a = Rgba::new(2, (0..4).map(|n| [n, n, n, 0]).collect());
        let mut b = a.clone();
        b.pixels_mut()[3] = [3, 3, 4, 0];
        let (picture, scale) = panels(&a, &b).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((picture.width(), picture.height(), scale), (22, 2, 128));
        let row: Vec<u8> = picture.pixels()[22..].iter().map(|pixel| pixel[2]).collect();
        assert_eq!(
            (&row[..2], &row[2..10], &row[10..12], &row[20..]),
            (&[2, 3][..], &[96; 8][..], &[2, 4][..], &[0, 128][..])
        );
        assert!(picture.pixels().iter().all(|pixel| pixel[3] == 255));
    }
}
