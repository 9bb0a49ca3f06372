//! TEX-1 to TEX-4, TEX-7, TEX-8: fetches texels by their indices and converts them to channels.
//!
//! A texel has up to four *lanes*: R, G, B, A, or the 16-bit halves of formats that are filtered at 16 bits.

use super::address::address;
use super::planned::{Image, PlannedUnit};
use super::{compressed, format};
use crate::number::{Integer, Lane};
use crate::state::{AddressMode, BORDER_TEXELS, Level, Named, TextureFormat, TextureKind};
use crate::trace::{Observer, Rule, Work};

/// One texel of the footprint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Texel {
    /// Column and row, which are negative or past the end for border texels. `None` is the border colour.
    pub at: Option<[i64; 2]>,
    /// Raw word of the texel, or for a compressed format the index of its block's first word.
    pub word: u32,
}

/// One image of a texture: a level of a face, or a layer of a volume.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slice<'a> {
    /// The unit that samples.
    pub unit: &'a PlannedUnit,
    /// The level that is read.
    pub level: &'a Level,
    /// Number of the face or layer. `None` is outside the layers of a volume, where everything is the border colour.
    pub image: Option<usize>,
}

impl PlannedUnit {
    /// Returns the factors of coordinates on a level: its sides, or 1 for rectangles, whose coordinates are in texels.
    pub fn scale(&self, level: &Level) -> [u32; 2] {
        if self.kind == TextureKind::Rectangle { [1, 1] } else { [level.width, level.height] }
    }

    /// Returns the shifts in bits from linear functions of level 0 (INT-4) to those of a level. Shifting is exact
    /// because sides are powers of two and the floor of a floor is a floor.
    pub(crate) fn plane_shifts(&self, level: &Level) -> [u32; 2] {
        let (sides, whole) = (self.scale(level), self.scale(&self.levels[0]));
        [sides[0].leading_zeros() - whole[0].leading_zeros(), sides[1].leading_zeros() - whole[1].leading_zeros()]
    }

    /// Returns the index of a texel in an image of a level of this width, which is not compressed.
    #[inline(always)]
    pub fn texel_offset<I: Integer>(&self, width: I, x: I, y: I) -> I {
        let beyond = I::new(if self.border { BORDER_TEXELS.into() } else { 0 });
        (y + beyond) * (width + beyond + beyond) + x + beyond
    }

    /// Returns the [shifts](Self::plane_shifts) of the smallest level, which are the largest.
    pub(crate) fn largest_shifts(&self) -> [u32; 2] {
        self.levels.last().map_or([0; 2], |smallest| self.plane_shifts(smallest))
    }

    /// Returns the address modes along s and t. Cube maps stay on the face (TEX-14).
    pub fn modes(&self) -> [AddressMode; 2] {
        match self.kind {
            TextureKind::Cube => [AddressMode::ClampToEdge; 2],
            TextureKind::TwoDimensional | TextureKind::Rectangle | TextureKind::ThreeDimensional => {
                [self.state.address_s, self.state.address_t]
            }
        }
    }

    /// Returns whether texels are filtered at 16 bits, as halves.
    pub fn is_wide(&self) -> bool {
        matches!(self.format, TextureFormat::R16B16 | TextureFormat::Y16)
    }

    /// Returns the lanes that are read, as bit n for lane n: channels R, G, B, A, or the high and the low half.
    pub(crate) fn live_lanes(&self) -> u8 {
        let any = |channels: u8| u8::from(self.live & channels != 0);
        if self.is_wide() { any(1 | 8) | any(2 | 4) << 1 } else { self.live }
    }

    /// Returns whether a lane is two's complement (TEX-18). Halves use the flags of A (high) and G (low). The high half
    /// of Y16, which is constant, never is.
    pub fn signed_lane(&self, lane: usize) -> bool {
        match (self.format, lane) {
            (TextureFormat::R16B16, 0) => self.state.signed[3],
            (TextureFormat::Y16, 0) => false,
            (TextureFormat::R16B16 | TextureFormat::Y16, _) => self.state.signed[1],
            (_, lane) => self.state.signed[lane],
        }
    }
}

impl Slice<'_> {
    /// Returns the texel at an index that may lie outside.
    #[inline(always)]
    pub(crate) fn texel(&self, words: &[u32], x: i64, y: i64) -> Texel {
        let (x, y) = (self.column(x), self.row(y));
        self.inside(words, x, y)
    }

    /// TEX-8: returns the 2x2 footprint whose upper left texel is (x, y), row by row. Each index is wrapped separately.
    #[inline(always)]
    pub(crate) fn footprint(&self, words: &[u32], x: i64, y: i64) -> [Texel; 4] {
        let (x0, x1) = (self.column(x), self.column(x + 1));
        let (y0, y1) = (self.row(y), self.row(y + 1));
        [self.inside(words, x0, y0), self.inside(words, x1, y0), self.inside(words, x0, y1), self.inside(words, x1, y1)]
    }

    /// Returns the column that an index along s addresses, or `None` if it is outside.
    #[inline(always)]
    pub(crate) fn column(&self, x: i64) -> Option<i64> {
        address(self.unit.modes()[0], x, self.level.width, self.unit.border)
    }

    /// Returns the row that an index along t addresses, or `None` if it is outside.
    #[inline(always)]
    pub(crate) fn row(&self, y: i64) -> Option<i64> {
        address(self.unit.modes()[1], y, self.level.height, self.unit.border)
    }

    /// TEX-7: returns the texel at an addressed column and row, or the border colour, which is A8R8G8B8 for every
    /// format.
    #[inline(always)]
    pub(crate) fn inside(&self, words: &[u32], x: Option<i64>, y: Option<i64>) -> Texel {
        let (Some(x), Some(y), Some(image)) = (x, y, self.image) else {
            let [r, g, b, a] = self.unit.state.border_color.map(u32::from);
            return Texel { at: None, word: a << 24 | r << 16 | g << 8 | b };
        };
        let first = image * self.unit.face_words + self.level.offset;
        if self.unit.format.is_compressed() {
            let pitch = self.level.width.div_ceil(4) as usize;
            let block = (y as usize / 4) * pitch + x as usize / 4;
            let words = self.unit.format.bytes() as usize / 4;
            return Texel { at: Some([x, y]), word: (first + block * words) as u32 };
        }
        Texel { at: Some([x, y]), word: words[first + self.offset(x, y)] }
    }

    /// Returns the index of a texel in an image that is not compressed.
    #[inline(always)]
    fn offset(&self, x: i64, y: i64) -> usize {
        self.unit.texel_offset(self.level.width.into(), x, y) as usize
    }

    /// Returns the words of the first `count` texels of a row of an image that is not compressed; none if there is no image.
    pub(crate) fn words<'w>(&self, words: &'w [u32], y: i64, count: usize) -> &'w [u32] {
        let Some(image) = self.image else { return &[] };
        &words[image * self.unit.face_words + self.level.offset + self.offset(0, y)..][..count]
    }
}

/// Returns the palette entry of an index, in A8R8G8B8 (TEX-1).
pub(crate) fn palette_entry(unit: &PlannedUnit, index: u32) -> u32 {
    let entries = unit.palette.as_deref().unwrap_or(&[0]);
    entries[index as usize & (entries.len() - 1)]
}

/// Returns the words of a texel's compressed block.
pub(crate) fn block<'a>(unit: &PlannedUnit, words: &'a [u32], texel: &Texel) -> &'a [u32] {
    let first = texel.word as usize;
    &words[first..first + unit.format.bytes() as usize / 4]
}

/// Returns the lanes of a texel.
#[inline(always)]
pub(crate) fn lanes<L: Lane, O: Observer>(
    unit: &PlannedUnit,
    image: &Image<'_, L>,
    texel: &Texel,
    observer: &mut O,
) -> [L; 4] {
    observer.count(Work::Texels, 1);
    let Some(at) = texel.at else {
        return if unit.is_wide() {
            wide_lanes(unit, halves(unit.format, texel))
        } else {
            format::lanes::<L>(TextureFormat::A8R8G8B8, texel.word, &unit.state.signed)
        };
    };
    let mut rule = Rule::Tex1;
    let mut lanes = match unit.format {
        TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5 => {
            let [x, y] = at.map(|i| i as u32);
            let decoded = compressed::decode(unit.format, unit.dithered, block(unit, image.words, texel), x, y);
            rule = match (unit.format, unit.dithered) {
                (TextureFormat::Dxt1, true) => Rule::Tex3,
                (TextureFormat::Dxt1, false) => Rule::Tex4,
                _ => Rule::Tex2,
            };
            compressed_lanes(&decoded, &unit.state.signed)
        }
        TextureFormat::P8 => {
            let word = palette_entry(unit, texel.word);
            format::lanes::<L>(TextureFormat::A8R8G8B8, word, &unit.state.signed)
        }
        TextureFormat::R16B16 | TextureFormat::Y16 => wide_lanes(unit, halves(unit.format, texel)),
        format => format::lanes::<L>(format, texel.word, &unit.state.signed),
    };
    if unit.levels.len() == 1 && !unit.border {
        let place = at.map(|i| i as u32);
        observer.fetched(unit.state.texture, (place[0], place[1]));
        if let Some((memory, channels)) = image.memory {
            let held = &memory[place[1] as usize * unit.levels[0].width as usize + place[0] as usize];
            for n in (0..4).filter(|n| channels >> n & 1 != 0) {
                lanes[n] = lanes[n].remember(held[n], unit.state.signed[n]);
            }
            rule = Rule::Rop5;
        }
    }
    let off = image.memory.is_some() || format::is_narrow(unit.format) || unit.format.is_compressed();
    if O::MEASURES && off && !unit.is_wide() {
        for channel in (0..4).filter(|n| !unit.state.signed[*n] && unit.live >> n & 1 != 0) {
            lanes[channel] = observer.observe(rule, lanes[channel]);
        }
    }
    lanes
}

/// Returns the halves of a texel of a format that is filtered at 16 bits. The high half of Y16 is 255 in both bytes.
/// The halves of a border colour are its bytes, A and R, G and B, for every format.
pub(crate) fn halves(format: TextureFormat, texel: &Texel) -> [u32; 2] {
    let (high, low) = (texel.word >> 16, texel.word & 0xffff);
    if has_no_high_half(format, texel) { [0xffff, low] } else { [high, low] }
}

/// Returns whether the high half of a texel is constant instead of stored.
pub(crate) fn has_no_high_half(format: TextureFormat, texel: &Texel) -> bool {
    format == TextureFormat::Y16 && texel.at.is_some()
}

fn compressed_lanes<L: Lane>(decoded: &compressed::DecodedTexel, signed: &[bool; 4]) -> [L; 4] {
    std::array::from_fn(|n| {
        let byte = decoded.bytes[n];
        if signed[n] {
            let s = i32::from(byte as i8);
            L::texel(s, s, 128)
        } else {
            let (numerator, denominator) = decoded.ideal[n];
            L::texel(i32::from(byte), numerator, denominator)
        }
    })
}

/// Returns the high and the low half as lanes 0 and 1.
fn wide_lanes<L: Lane>(unit: &PlannedUnit, halves: [u32; 2]) -> [L; 4] {
    let half = |lane: usize| {
        if unit.signed_lane(lane) {
            let s = i32::from(halves[lane] as u16 as i16);
            L::texel(s, s, 32768)
        } else {
            let v = halves[lane] as i32;
            L::texel(v, v, 65535)
        }
    };
    [half(0), half(1), L::ZERO, L::ZERO]
}

/// Returns the name that traces give to the format of an expanded texel, which is the format that [`format::expand`]
/// takes.
pub(crate) fn expanded_as(unit: &PlannedUnit, texel: &Texel) -> &'static str {
    match unit.format {
        _ if texel.at.is_none() => TextureFormat::A8R8G8B8.name(),
        TextureFormat::P8 | TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5 => {
            TextureFormat::A8R8G8B8.name()
        }
        format => format.name(),
    }
}
