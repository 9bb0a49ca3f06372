//! Shows a level of a texture as a picture: the unfiltered colour of each texel (TEX-1 to TEX-4).

use super::compressed;
use super::format::expand;
use crate::state::{BORDER_TEXELS, Level, Texels, TextureFormat};

/// The picture of a level of a face, including border texels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LevelPicture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// R, G, B, A bytes of each texel, row by row from the top.
    pub pixels: Vec<[u8; 4]>,
}

/// Decodes every texel of a level. Returns `None` if the words hold fewer faces or levels. `palette` holds A8R8G8B8
/// words for [`TextureFormat::P8`], and its length is a power of two; without one the texels are zero. `dithered`
/// applies to DXT1 as in [`compressed::decode`].
pub fn level(
    texels: &Texels,
    format: TextureFormat,
    palette: &[u32],
    dithered: bool,
    face: u32,
    level: u32,
) -> Option<LevelPicture> {
    let (chain, face_words) = Level::chain(format, texels.width, texels.height, texels.levels, texels.border);
    let place = chain.get(level as usize)?;
    let beyond = if texels.border { 2 * BORDER_TEXELS } else { 0 };
    let (width, height) = (place.width + beyond, place.height + beyond);
    let first = face as usize * face_words + place.offset;
    let words = texels.words.get(first..first + format.words(width, height))?;
    let pixels = if format.is_compressed() {
        let (block, across) = ((format.bytes() / 4) as usize, width.div_ceil(4) as usize);
        let texel = |x: u32, y: u32| {
            let at = block * (across * (y / 4) as usize + (x / 4) as usize);
            compressed::decode(format, dithered, &words[at..at + block], x, y).bytes
        };
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect()
    } else if format == TextureFormat::P8 {
        let mask = palette.len().saturating_sub(1);
        let color = |word: &u32| expand(TextureFormat::A8R8G8B8, *word);
        let entry = |index: &u32| palette.get(*index as usize & mask).map_or([0; 4], color);
        words.iter().map(entry).collect()
    } else {
        words.iter().map(|word| expand(format, *word)).collect()
    };
    Some(LevelPicture { width, height, pixels })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texels(width: u32, height: u32, levels: u32, border: bool, words: &[u32]) -> Texels {
        Texels { width, height, levels, layers: 1, border, words: words.into() }
    }

    #[test]
    fn levels_and_faces_are_found() {
        let words: Vec<u32> = (0..30).collect();
        let cube = texels(2, 2, 2, false, &words);
        let show = |face, n| level(&cube, TextureFormat::L8, &[], true, face, n);
        let last = show(5, 1).map(|shown| (shown.width, shown.height, shown.pixels));
        assert_eq!(last, Some((1, 1, vec![[29, 29, 29, 255]])));
        assert_eq!(show(2, 0).map(|shown| shown.pixels[3]), Some([13, 13, 13, 255]));
        assert_eq!((show(6, 0), show(0, 2)), (None, None));
        let bordered = texels(1, 1, 1, true, &[7; 81]);
        let shown = level(&bordered, TextureFormat::A8, &[], true, 0, 0);
        assert_eq!(shown.map(|shown| (shown.width, shown.height)), Some((9, 9)));
    }

    #[test]
    fn palettes_mask_the_index() {
        let texture = texels(2, 1, 1, false, &[1, 33]);
        let palette: Vec<u32> = (0..32).map(|n| 0xff00_0000 | n).collect();
        let shown = level(&texture, TextureFormat::P8, &palette, true, 0, 0);
        assert_eq!(shown.map(|shown| shown.pixels), Some(vec![[0, 0, 1, 255]; 2]));
        let without = level(&texture, TextureFormat::P8, &[], true, 0, 0);
        assert_eq!(without.map(|shown| shown.pixels), Some(vec![[0; 4]; 2]));
    }

    /// Columns and rows count within the level, and blocks are stored row by row. Sides below four use part of a block.
    #[test]
    fn blocks_cover_levels() {
        let flat = |n: u32| [n << 11 | n << 27, 0];
        let words: Vec<u32> = (0..6).flat_map(flat).collect();
        let texture = texels(8, 8, 3, false, &words);
        let at = |n, x: usize, y: usize| {
            let shown = level(&texture, TextureFormat::Dxt1, &[], false, 0, n);
            shown.map(|shown| shown.pixels[y * shown.width as usize + x][0])
        };
        assert_eq!([at(0, 3, 3), at(0, 4, 3), at(0, 3, 4), at(0, 7, 7)], [0, 8, 16, 24].map(Some));
        assert_eq!([at(1, 3, 3), at(2, 1, 1)], [33, 41].map(Some));
    }
}
