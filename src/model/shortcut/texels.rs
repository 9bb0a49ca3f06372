//! Textures whose texels another renderer has converted to bytes beforehand.
#![allow(clippy::float_arithmetic, reason = "another renderer's numbers")]

use super::{Shortcut, Shortcuts};
use crate::plan::{Plan, PlannedDraw};
use crate::state::{Level, ShaderOperation, Texels, Texture, TextureFormat, TextureImage, TextureKind};
use crate::texture::compressed;
use crate::texture::format;

/// Returns whether a shortcut converts texels of a format.
pub(super) fn converts(shortcut: Shortcut, format: TextureFormat) -> bool {
    match shortcut {
        Shortcut::PlainBlocks => format == TextureFormat::Dxt1,
        Shortcut::CutBlocks => format.is_compressed(),
        Shortcut::ShiftedTexels => format::is_narrow(format),
        Shortcut::GreyY16 => format == TextureFormat::Y16,
        Shortcut::SignedR6G5B5 => format == TextureFormat::R6G5B5,
        _ => false,
    }
}

/// Converts the textures that the shortcuts concern to A8R8G8B8.
pub(super) fn convert(plan: &mut Plan, shortcuts: Shortcuts) {
    for index in 0..plan.textures.len() {
        let Texture { format, kind, image, .. } = &plan.textures[index];
        let Some(shortcut) = shortcuts.iter().find(|shortcut| converts(*shortcut, *format)) else { continue };
        let TextureImage::Texels(texels) = image else { continue };
        let is_offset = plan.draws.iter().any(|draw| offsets(draw, index));
        let of_texel = |word: u32| match shortcut {
            Shortcut::GreyY16 => grey(word),
            Shortcut::SignedR6G5B5 if is_offset => taken_twice(word),
            Shortcut::SignedR6G5B5 => signed(word).map(|byte| (255 * i32::from(byte as i8).max(0) / 127) as u8),
            _ => format::shifted(*format, word),
        };
        let Some(words) = converted(texels, *format, *kind, (shortcut, &of_texel)) else { continue };
        let image = TextureImage::Texels(Texels { words: words.into(), ..texels.clone() });
        let texture = &mut plan.textures[index];
        (texture.format, texture.image) = (TextureFormat::A8R8G8B8, image);
        let units = plan.draws.iter_mut().flat_map(|draw| &mut draw.units);
        for unit in units.filter(|unit| unit.state.texture == index) {
            let TextureImage::Texels(Texels { width, height, levels, border, .. }) = &plan.textures[index].image else {
                continue;
            };
            unit.format = TextureFormat::A8R8G8B8;
            if shortcut == Shortcut::SignedR6G5B5 {
                unit.state.signed = [false; 4];
            }
            let reachable = unit.levels.len();
            (unit.levels, unit.face_words) = Level::chain(unit.format, *width, *height, *levels, *border);
            unit.levels.truncate(reachable);
        }
    }
}

/// Returns whether a texture displaces the coordinates of another unit in a draw.
fn offsets(draw: &PlannedDraw, texture: usize) -> bool {
    let units = || draw.units.iter().filter(|unit| unit.state.texture == texture);
    draw.shader.iter().flat_map(|shader| &shader.stages).any(|stage| {
        let displaces = matches!(stage.state.operation, ShaderOperation::BumpEnvironment { .. });
        displaces && units().any(|unit| unit.index == stage.state.previous)
    })
}

/// Returns the bytes of a texel of Y16 as grey.
fn grey(word: u32) -> [u8; 4] {
    let grey = (((word & 0xffff) * 255 + 32767) / 65535) as u8;
    [grey, grey, grey, 255]
}

/// Returns the bytes of a texel of R6G5B5 as two's complement numbers, of which 127 is 1.0.
fn signed(word: u32) -> [u8; 4] {
    let five = |shift: u32| ((word >> shift & 31 ^ 16) * 255 / 31).wrapping_sub(128) as u8;
    [((word >> 10 & 63) * 127 / 63) as u8, five(5), five(0), 127]
}

/// Returns the bytes of a texel of R6G5B5 whose signed numbers, as fractions of 1.0, count as bytes over 255 before these are two's complement.
/// Those below -128/255 have no such byte.
fn taken_twice(word: u32) -> [u8; 4] {
    let [r, g, b, _] = signed(word).map(|byte| i32::from(byte as i8).max(-127) * 255);
    let byte = |number: i32| ((number as f32 / 127.0).round() as i32).max(-128) as u8;
    [byte(r), byte(g), byte(b), 255]
}

/// Replaces textures that read the colours of a render target by zeros.
pub(super) fn blacken(plan: &mut Plan) {
    for index in 0..plan.textures.len() {
        let TextureImage::Target { .. } = plan.textures[index].image else { continue };
        let mut units = plan.draws.iter().flat_map(|draw| &draw.units);
        let Some(level) = units.find(|unit| unit.state.texture == index).map(|unit| unit.levels[0]) else { continue };
        let (width, height) = (level.width, level.height);
        let words = vec![0; plan.textures[index].format.words(width, height)].into();
        let texels = Texels { width, height, levels: 1, layers: 1, border: false, words };
        plan.textures[index].image = TextureImage::Texels(texels);
    }
}

/// Returns the words of all images in A8R8G8B8, or `None` if there are border texels.
fn converted(
    texels: &Texels,
    format: TextureFormat,
    kind: TextureKind,
    (shortcut, of_texel): (Shortcut, &dyn Fn(u32) -> [u8; 4]),
) -> Option<Vec<u32>> {
    if texels.border {
        return None;
    }
    let (levels, face_words) = Level::chain(format, texels.width, texels.height, texels.levels, false);
    let faces = if kind == TextureKind::Cube { crate::state::CUBE_FACES } else { texels.layers };
    let mut words = Vec::new();
    for face in 0..faces as usize {
        for level in &levels {
            for (y, x) in (0..level.height).flat_map(|y| (0..level.width).map(move |x| (y, x))) {
                let first = face * face_words + level.offset;
                let bytes = if format.is_compressed() {
                    let size = format.bytes() as usize / 4;
                    let block = (y / 4 * level.width.div_ceil(4) + x / 4) as usize * size;
                    let block = texels.words.get(first + block..first + block + size)?;
                    compressed::decode_undithered(format, block, (x, y), shortcut == Shortcut::CutBlocks)
                } else {
                    let word = *texels.words.get(first + (y * level.width + x) as usize)?;
                    of_texel(word)
                };
                let [r, g, b, a] = bytes.map(u32::from);
                words.push(a << 24 | r << 16 | g << 8 | b);
            }
        }
    }
    Some(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_of_other_meanings() {
        assert_eq!((grey(0), grey(0xffff), grey(0x8080)), ([0, 0, 0, 255], [255; 4], [128, 128, 128, 255]));
        assert_eq!(signed(63 << 10 | 15 << 5 | 16), [127, 127, 128, 127]);
        assert_eq!(signed(0), [0, 3, 3, 127]);
        assert_eq!(taken_twice(63 << 10 | 15 << 5 | 24), [255, 255, 130, 255]);
        assert_eq!((taken_twice(0), taken_twice(16)), ([0, 6, 6, 255], [0, 6, 128, 255]));
    }
}
