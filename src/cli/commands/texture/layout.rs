//! Layout of a texture's faces and levels in one picture.
//!
//! Six faces form a cross: -X, +Z, +X, -Z in a row, with +Y above and -Y below +Z. Level 0 is on the left, the others below one another on its right.
//! Layers of a volume are in rows. What no texel covers is transparent.

use std::ops::Range;

use ninebit::state::TextureKind;
use ninebit::texture::show::{self, LevelPicture};
use ninebit_scene::image::Rgba;

use super::source::TextureSource;

/// Column and row of each face in the cross, in the order +X, -X, +Y, -Y, +Z, -Z.
const CROSS: [(u32, u32); 6] = [(2, 1), (0, 1), (1, 0), (1, 2), (1, 1), (3, 1)];

/// Returns the picture of the given faces and levels.
pub(super) fn picture(opened: &TextureSource, faces: Range<u32>, levels: Range<u32>) -> Rgba {
    let levels: Vec<Rgba> = levels.map(|level| of_level(opened, &faces, level)).collect();
    let Some((first, rest)) = levels.split_first() else { return empty(1, 1) };
    let column = rest.iter().map(|level| level.width()).max().unwrap_or(0);
    let below: u32 = rest.iter().map(|level| level.height()).sum();
    let mut picture = empty(first.width() + column, first.height().max(below));
    copy_into(&mut picture, (0, 0), first);
    let mut y = 0;
    for level in rest {
        copy_into(&mut picture, (first.width(), y), level);
        y += level.height();
    }
    picture
}

/// Returns the picture of one level: a face, the cross of its faces, or its layers.
fn of_level(opened: &TextureSource, faces: &Range<u32>, level: u32) -> Rgba {
    let show = |face: u32| {
        let shown = show::level(&opened.texels, opened.format, &opened.palette, opened.dithered, face, level);
        // The caller has checked that face and level exist.
        shown.map_or_else(|| empty(1, 1), |LevelPicture { width, pixels, .. }| Rgba::new(width, pixels))
    };
    if faces.len() == 1 {
        return show(faces.start);
    }
    let mut picture: Option<Rgba> = None;
    let count = faces.len() as u32;
    let across = if opened.kind == TextureKind::Cube { 4 } else { count.isqrt().next_power_of_two() };
    let down = if opened.kind == TextureKind::Cube { 3 } else { count.div_ceil(across) };
    for face in faces.clone() {
        let cross = CROSS.get(face as usize).filter(|_| opened.kind == TextureKind::Cube);
        let (column, row) = cross.copied().unwrap_or((face % across, face / across));
        let shown = show(face);
        let picture = picture.get_or_insert_with(|| empty(across * shown.width(), down * shown.height()));
        copy_into(picture, (column * shown.width(), row * shown.height()), &shown);
    }
    picture.unwrap_or_else(|| empty(1, 1))
}

fn empty(width: u32, height: u32) -> Rgba {
    Rgba::new(width, vec![[0; 4]; width as usize * height as usize])
}

/// Copies a picture into a larger one.
fn copy_into(picture: &mut Rgba, (x, y): (u32, u32), part: &Rgba) {
    let width = part.width() as usize;
    for (row, pixels) in part.pixels().chunks(width).enumerate() {
        let at = (y as usize + row) * picture.width() as usize + x as usize;
        picture.pixels_mut()[at..at + width].copy_from_slice(pixels);
    }
}
