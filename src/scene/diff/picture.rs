//! Draws a difference as a picture.

use super::{SizeError, largest, same_size, steps};
use crate::image::Rgba;

/// A picture of a difference, with the scale of its colours.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DifferencePicture {
    /// Opaque picture. An equal pixel is dark grey (0 to 63), by the brightness of the first picture. In a differing pixel, R, G and B are their
    /// absolute differences, or that of alpha where it is larger, times `scale`.
    pub picture: Rgba,
    /// The factor: the largest power of two that takes no difference beyond 255.
    pub scale: u8,
}

/// Draws the difference of two pictures of the same size.
///
/// # Errors
/// The sizes differ.
pub fn highlight(a: &Rgba, b: &Rgba, ignore_alpha: bool) -> Result<DifferencePicture, SizeError> {
    same_size(a, b)?;
    let differences = |(a, b): (&[u8; 4], &[u8; 4])| steps(*a, *b, ignore_alpha).map(largest);
    let most = a.pixels.iter().zip(&b.pixels).flat_map(differences).max().unwrap_or(0);
    let scale = 1_u8 << (255 / most.max(1)).ilog2();
    let pixels = a
        .pixels
        .iter()
        .zip(&b.pixels)
        .map(|(from, to)| match differences((from, to)) {
            [0, 0, 0, 0] => {
                let grey = (from[..3].iter().map(|v| u16::from(*v)).sum::<u16>() / 12) as u8;
                [grey, grey, grey, 255]
            }
            [r, g, b, a] => {
                let [r, g, b] = [r, g, b].map(|v| v.max(a).saturating_mul(scale));
                [r, g, b, 255]
            }
        })
        .collect();
    Ok(DifferencePicture { picture: Rgba { width: a.width, height: a.height, pixels }, scale })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_amplified_and_the_rest_is_dark() {
        let a = Rgba { width: 3, height: 1, pixels: vec![[255, 255, 255, 0], [10, 20, 30, 40], [0, 0, 0, 0]] };
        let b = Rgba { pixels: vec![[255, 255, 255, 0], [12, 20, 15, 40], [0, 0, 0, 9]], ..a.clone() };
        let found = highlight(&a, &b, false).unwrap_or_else(|e| panic!("{e}"));
        // The largest difference is 15: 15 * 16 = 240.
        assert_eq!(found.scale, 16);
        assert_eq!(found.picture.pixels, [[63, 63, 63, 255], [32, 0, 240, 255], [144, 144, 144, 255]]);
        let same = highlight(&a, &a, false).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((same.scale, same.picture.pixels[1]), (128, [5, 5, 5, 255]));
    }
}
