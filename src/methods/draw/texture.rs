//! Texture units, and the images and palettes that they read from memory.

use std::sync::Arc;

use ninebit::state::{
    AddressMode, BORDER_TEXELS, CUBE_FACES, ColorKey, CompareFunction, MipFilter, Named, Palette, ShadowComparison,
    ShadowReference, Texels, TextureFormat, TextureKind, TextureUnit,
};

use ninebit_program::registers::color_of;
use ninebit_program::registers::unit::{
    ADDRESS_MODES, ANISOTROPY, BORDER_COLOR, COLOR_KEY, COLOR_KEYS, CUBE, DIMENSIONS, FORMAT, FORMATS, LEVELS,
    MAG_FILTER, MAG_FILTERS, MAX_LOD, MIN_FILTER, MIN_FILTERS, MIN_LOD, MODES, RECTANGLE, SHADOW_FUNCTIONS, SIGNED,
    SIZES,
};

use super::view::View;
use crate::celsius;
use crate::class::{self, Family, of_unit};
use crate::gap::Gap;
use crate::memory::{self, Layout, Memory};

/// Bytes between the faces of a cube map are a multiple of this.
pub(crate) const FACE_BYTES: u64 = 128;

/// Least sides of an image that has border texels.
pub(crate) const BORDERED_SIDE: u32 = 16;

/// An image in memory as a unit reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Image {
    /// Address of the first byte.
    pub(crate) address: u32,
    /// How it is addressed.
    pub(crate) kind: TextureKind,
    /// How its words encode colours.
    pub(crate) format: TextureFormat,
    /// Columns, rows and layers of the first level.
    pub(crate) size: [u32; 3],
    /// Number of levels.
    pub(crate) levels: u32,
    /// Whether it has border texels.
    pub(crate) border: bool,
    /// Bytes from row to row; `None` if it is swizzled or compressed.
    pub(crate) pitch: Option<u32>,
}

/// Reads the image of a unit; `None` if the model has no such texture, which is noted.
pub(crate) fn image(view: &mut View<'_>, unit: usize) -> Option<Image> {
    let mut word = |method| view.get(of_unit(method, unit));
    let (address, format) = (word(class::SET_TEXTURE_OFFSET), word(class::SET_TEXTURE_FORMAT));
    let code = FORMAT.value_in(format);
    let Some((_, texels, linear)) = FORMATS.iter().find(|(number, ..)| *number == code).copied() else {
        view.note(Gap::NotModelled(format!("texture format 0x{code:02x} of unit {unit}")));
        return None;
    };
    if view.family() == Family::Celsius && !celsius::begins_at_corners(view.own(celsius::TEX_FORMAT + 4 * unit as u32))
    {
        view.note(Gap::NotModelled(format!("texel coordinates from the texels' centres at unit {unit}")));
    }
    let cube = CUBE.is_set(format);
    let dimensions = DIMENSIONS.value_in(format);
    if linear {
        let rectangle = view.get(of_unit(class::SET_TEXTURE_IMAGE_RECT, unit));
        let pitch = view.get(of_unit(class::SET_TEXTURE_CONTROL1, unit)) >> 16;
        let [width, height] = RECTANGLE.map(|field| field.value_in(rectangle));
        let size = [width, height, 1];
        if size.contains(&0) || size.iter().any(|side| *side > 4096) {
            view.bad(of_unit(class::SET_TEXTURE_IMAGE_RECT, unit));
            return None;
        }
        if texels.is_paired() && width % 2 == 1 {
            view.note(Gap::NotModelled(format!("texels in pairs on an odd width at unit {unit}")));
            return None;
        }
        let (kind, pitch) = (TextureKind::Rectangle, Some(pitch));
        return Some(Image { address, kind, format: texels, size, levels: 1, border: false, pitch });
    }
    let [u, v, p] = SIZES.map(|field| 1_u32 << field.value_in(format).min(12));
    let kind = match (cube, dimensions) {
        (true, 2) => TextureKind::Cube,
        (false, 3) => TextureKind::ThreeDimensional,
        (false, 1 | 2) => TextureKind::TwoDimensional,
        _ => {
            view.note(Gap::NotModelled(format!("a texture of {dimensions} dimensions at unit {unit}")));
            return None;
        }
    };
    let size = match kind {
        TextureKind::ThreeDimensional => [u, v, p],
        _ if dimensions == 1 => [u, 1, 1],
        _ => [u, v, 1],
    };
    let border = !BORDER_COLOR.is_set(format);
    let longest = size.into_iter().max().unwrap_or(1);
    let written = LEVELS.value_in(format).max(1);
    let mut levels = written.min(longest.ilog2() + 1);
    if kind == TextureKind::ThreeDimensional && levels > 1 {
        let filter = MIN_FILTER.value_in(view.get(of_unit(class::SET_TEXTURE_FILTER, unit)));
        if filter > 2 {
            view.note(Gap::NotModelled(format!("levels of a volume at unit {unit}")));
        }
        levels = 1;
    }
    Some(Image { address, kind, format: texels, size, levels, border, pitch: None })
}

impl Image {
    /// Returns the bytes that a face takes with all levels.
    pub(crate) fn face_bytes(&self) -> u64 {
        (0..self.levels).map(|level| self.level_bytes(level)).sum()
    }

    /// Returns the bytes from its first to its last, at most; a pitch has rows of that many.
    pub(crate) fn bytes(&self) -> u64 {
        let faces = if self.kind == TextureKind::Cube { u64::from(CUBE_FACES) } else { 1 };
        match self.pitch {
            Some(pitch) => u64::from(pitch) * u64::from(self.size[1]),
            None if self.border => {
                let [width, height] = self.stored().map(u64::from);
                width * height * u64::from(self.format.bytes())
            }
            None => faces * self.face_bytes().next_multiple_of(FACE_BYTES),
        }
    }

    /// Returns columns and rows in memory of an image with border texels.
    fn stored(&self) -> [u32; 2] {
        [self.size[0], self.size[1]].map(|side| (2 * side).max(BORDERED_SIDE))
    }

    /// Returns columns, rows and layers of a level.
    pub(crate) fn level(&self, level: u32) -> [u32; 3] {
        self.size.map(|side| (side >> level).max(1))
    }

    fn level_bytes(&self, level: u32) -> u64 {
        let [width, height, depth] = self.level(level);
        let words = self.format.words(width, height) as u64 * u64::from(depth);
        words * if self.format.is_compressed() { 4 } else { u64::from(self.format.bytes()) }
    }

    /// Reads the texels from memory.
    ///
    /// # Errors
    /// Memory does not hold them, or they have a form that is not modelled.
    pub(crate) fn texels(&self, memory: &Memory) -> Result<Texels, Gap> {
        let what = || format!("a texture of {} x {} {}", self.size[0], self.size[1], self.format.name());
        let outside = || Gap::OutsideMemory(what(), self.address.into());
        if memory.is_empty() {
            return Err(Gap::NoMemory(what(), self.address.into()));
        }
        let layout = self.pitch.map_or(Layout::Swizzled, Layout::Pitch);
        let [width, height, layers] = self.size;
        let mut all = Vec::new();
        if self.border {
            if self.kind != TextureKind::TwoDimensional || self.format.is_compressed() || self.levels > 1 {
                return Err(Gap::NotModelled(format!("border texels of {}", what())));
            }
            // The texture begins at the fourth texel.
            let stored = self.stored();
            let words = memory::words(memory, self.address.into(), self.format, [stored[0], stored[1], 1], layout);
            let words = words.ok_or_else(outside)?;
            let [columns, rows] = [width, height].map(|side| side + 2 * BORDER_TEXELS);
            for row in 0..rows {
                let first = (row * stored[0]) as usize;
                all.extend_from_slice(&words[first..first + columns as usize]);
            }
        } else {
            let faces = if self.kind == TextureKind::Cube { CUBE_FACES } else { 1 };
            for face in 0..faces {
                let step = self.face_bytes().next_multiple_of(FACE_BYTES);
                let mut address = u64::from(self.address) + u64::from(face) * step;
                for level in 0..self.levels {
                    all.extend(
                        memory::words(memory, address, self.format, self.level(level), layout).ok_or_else(outside)?,
                    );
                    address += self.level_bytes(level);
                }
            }
        }
        Ok(Texels { width, height, levels: self.levels, layers, border: self.border, words: Arc::from(all) })
    }
}

impl Image {
    /// Returns the texels that stand for an image that is not known: one, white, of each face.
    pub(crate) fn absent(&self) -> Texels {
        let faces = if self.kind == TextureKind::Cube { CUBE_FACES as usize } else { 1 };
        let bits = self.format.word_bits();
        let word = if self.format.is_compressed() || bits == 32 { u32::MAX } else { (1 << bits) - 1 };
        let words: Vec<u32> = vec![word; self.format.words(1, 1) * faces];
        Texels { width: 1, height: 1, levels: 1, layers: 1, border: false, words: words.into() }
    }
}

/// Reads the palette of a unit: its address and number of entries.
pub(crate) fn palette(view: &mut View<'_>, unit: usize) -> (u32, usize) {
    let word = view.get(of_unit(class::SET_TEXTURE_PALETTE, unit));
    (word & !0x3f, 256 >> (word >> 2 & 3))
}

/// Reads the entries of a palette from memory.
///
/// # Errors
/// Memory does not hold them.
pub(crate) fn entries(memory: &Memory, (address, count): (u32, usize)) -> Result<Palette, Gap> {
    let what = || format!("a palette of {count} colours");
    if memory.is_empty() {
        return Err(Gap::NoMemory(what(), address.into()));
    }
    let words = (0..count as u64).map(|n| memory.word(u64::from(address) + 4 * n)).collect::<Option<Vec<u32>>>();
    let words = words.ok_or_else(|| Gap::OutsideMemory(what(), address.into()))?;
    Ok(Palette { name: format!("palette {address:08x}"), entries: words.into() })
}

/// Reads the state of a unit that samples; its texture and palette are filled in by the caller. `projects` says that the stage projects in three
/// dimensions.
pub(crate) fn unit(view: &mut View<'_>, unit: usize, image: &Image, projects: bool) -> TextureUnit {
    let method = |method| of_unit(method, unit);
    let address = view.get(method(class::SET_TEXTURE_ADDRESS));
    let control = view.get(method(class::SET_TEXTURE_CONTROL0));
    let filter = view.get(method(class::SET_TEXTURE_FILTER));
    let mut state = TextureUnit::new(0);
    let modes = MODES.map(|field| {
        let code = field.value_in(address);
        ADDRESS_MODES.iter().find(|(_, value)| *value == code).map(|(mode, _)| *mode)
    });
    let used = match image.kind {
        TextureKind::Cube => 0,
        TextureKind::ThreeDimensional => 3,
        _ => 2,
    };
    if modes[..used].contains(&None) {
        view.bad(method(class::SET_TEXTURE_ADDRESS));
    }
    let [s, t, r] = modes.map(|mode| mode.unwrap_or(AddressMode::Wrap));
    (state.address_s, state.address_t) = if used > 0 { (s, t) } else { (AddressMode::Wrap, AddressMode::Wrap) };
    state.address_r = if used > 2 { r } else { AddressMode::Wrap };
    state.cylindrical_wrap = [4, 12].map(|bit| address >> bit & 1 != 0 && image.kind == TextureKind::TwoDimensional);
    filters(view, unit, filter, &mut state);
    (state.min_lod, state.max_lod) = (MIN_LOD.value_in(control) as i32, MAX_LOD.value_in(control) as i32);
    if image.levels == 1 {
        // There is no other level.
        state.mip_filter = MipFilter::None;
    }
    // Signed, of thirteen bits.
    state.lod_bias = (filter << 19) as i32 >> 19;
    state.signed = SIGNED.map(|field| field.is_set(filter));
    if [state.address_s, state.address_t, state.address_r].contains(&AddressMode::ClampToBorder) && !image.border {
        state.border_color = color_of(view.get(method(class::SET_TEXTURE_BORDER_COLOR)));
    }
    let anisotropy = 1 << ANISOTROPY.value_in(control);
    state.anisotropy = anisotropy;
    if control >> 2 & 1 != 0 {
        view.note(Gap::NotModelled(format!("texels of alpha 0 that remove the pixel at unit {unit}")));
    }
    if let Some((mode, _)) = COLOR_KEYS.into_iter().find(|(_, code)| *code == COLOR_KEY.value_in(control)) {
        let color = color_of(view.get(class::SET_COLOR_KEY_COLOR + 4 * unit as u32));
        state.color_key = Some(ColorKey { color, mode });
    }
    if image.format.depth().is_some() {
        let word = view.get(class::SET_SHADOW_COMPARE_FUNC);
        let function = SHADOW_FUNCTIONS.iter().find(|(_, value)| *value == word).map(|(function, _)| *function);
        if function.is_none() {
            view.bad(class::SET_SHADOW_COMPARE_FUNC);
        }
        let reference = if projects { ShadowReference::R } else { ShadowReference::Zero };
        state.shadow = Some(ShadowComparison { function: function.unwrap_or(CompareFunction::Never), reference });
    }
    state
}

fn filters(view: &mut View<'_>, unit: usize, filter: u32, state: &mut TextureUnit) {
    let (min, mag) = (MIN_FILTER.value_in(filter), MAG_FILTER.value_in(filter));
    match MIN_FILTERS.iter().find(|(_, value)| *value == min) {
        Some(((filter, levels), _)) => (state.min_filter, state.mip_filter) = (*filter, *levels),
        None if min == 7 => view.note(Gap::NotModelled(format!("a convolution filter at unit {unit}"))),
        None => view.bad(of_unit(class::SET_TEXTURE_FILTER, unit)),
    }
    match MAG_FILTERS.iter().find(|(_, code)| *code == mag) {
        Some((filter, _)) => state.mag_filter = *filter,
        None if mag == 4 => view.note(Gap::NotModelled(format!("a convolution filter at unit {unit}"))),
        None => view.bad(of_unit(class::SET_TEXTURE_FILTER, unit)),
    }
}
