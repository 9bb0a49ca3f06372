//! Textures as tables for rows. Texels are decoded once, and every address mode becomes limits and a mask.

use crate::number::Lane;
use crate::state::{
    AddressMode, BORDER_TEXELS, CUBE_FACES, ColorKey, CompareFunction, Filter, Level, ShadowComparison,
    ShadowReference, TextureFormat, TextureKind, depth_of,
};
use crate::texture::address::address;
use crate::texture::color_key;
use crate::texture::fetch::{Slice, lanes, palette_entry};
use crate::texture::format;
use crate::texture::planned::{Image, PlannedUnit};
use crate::texture::shadow;
use crate::trace::Silent;

/// How coordinates along an axis map to entries of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Axis {
    /// Limits of coordinates, 1/256 texel. Beyond them all texels are the same.
    pub(crate) low: i32,
    pub(crate) high: i32,
    /// Texel of the first entry.
    pub(crate) first: i32,
    /// Mask of the index: one less than the period if that is a power of two, otherwise -1.
    pub(crate) mask: i32,
    /// Period of coordinates, 1/256 texel, if it is not a power of two.
    pub(crate) period: Option<i32>,
    /// Number of entries.
    pub(crate) count: i32,
}

impl Axis {
    /// TEX-7: returns the axis of `n` texels.
    fn new(mode: AddressMode, n: u32, border_texels: bool) -> Axis {
        let n = n as i32;
        let limited = |first: i32, last: i32| Axis {
            low: first << 8,
            high: last << 8,
            first,
            mask: -1,
            count: last - first + 1,
            period: None,
        };
        let periodic = |count: i32| {
            let even = count.count_ones() == 1;
            let (mask, period) = if even { (count - 1, None) } else { (-1, Some(count << 8)) };
            Axis { low: i32::MIN, high: i32::MAX, first: 0, mask, count, period }
        };
        let beyond = BORDER_TEXELS as i32;
        match mode {
            AddressMode::Wrap => periodic(n),
            AddressMode::Mirror => periodic(2 * n),
            AddressMode::ClampToEdge | AddressMode::Clamp => limited(0, n - 1),
            AddressMode::ClampToBorder if border_texels => limited(-beyond, n - 1 + beyond),
            AddressMode::ClampToBorder => limited(-1, n),
        }
    }

    /// Returns whether coordinates have no limits.
    pub(crate) fn repeats(&self) -> bool {
        self.mask >= 0
    }

    /// Reduces coordinates modulo the period.
    #[inline(always)]
    pub(crate) fn reduce(&self, coordinates: &mut [i32]) {
        let Some(period) = self.period else { return };
        // By a reciprocal, because no vector has an instruction that divides integers. The quotient of a number below 2^32 is at most one
        // too small.
        let (divisor, half) = (period as u32, 1 << 31);
        let (reciprocal, less) = ((1_u64 << 32) / u64::from(divisor), (half % divisor) as i32);
        for c in coordinates {
            let above = *c as u32 ^ half;
            let quotient = ((u64::from(above) * reciprocal) >> 32) as u32;
            let rest = above - quotient * divisor;
            let rest = rest.min(rest.wrapping_sub(divisor)) as i32 - less;
            *c = rest + (period & (rest >> 31));
        }
    }

    /// Returns the axis of a smaller level, whose side is shifted by some bits. `count` stays.
    #[inline(always)]
    pub(crate) fn shifted(&self, side: i32, shift: i32) -> Axis {
        let shorter = (side - (side >> shift)) << 8;
        Axis { high: if self.repeats() { self.high } else { self.high - shorter }, mask: self.mask >> shift, ..*self }
    }

    /// Returns the entry of a coordinate within its limits.
    #[inline(always)]
    pub(crate) fn entry(&self, coordinate: i32) -> i32 {
        ((coordinate >> 8) - self.first) & self.mask
    }
}

/// A texel and the one below it, so that a footprint is two entries side by side: half the loads, and half the lines of the cache.
pub(crate) type Column = [u32; 2];

/// Returns the columns of rows of so many texels. The last row only lies below.
fn columns(rows: &[u32], wide: usize) -> Vec<Column> {
    rows.iter().zip(rows.iter().skip(wide)).map(|(upper, lower)| [*upper, *lower]).collect()
}

/// Decoded texels: R, G, B, A from the lowest byte up. 128 is added to signed channels, so that they are filtered like unsigned ones.
#[derive(Clone, Debug)]
pub(crate) enum Texels {
    /// Texels that are read one at a time.
    Single(Vec<u32>),
    /// Texels for footprints, with one more at the end of each row, of every level if the unit needs a level of detail. All rows are as long as the
    /// widest.
    Footprints(Vec<Column>),
    /// The same of 16-bit halves, with the high half in the high bits. 32,768 is added to signed ones. Units that do not filter read them, too.
    Halves(Vec<Column>),
    /// The footprints of the only channel that varies, by its number: each entry has a texel, its right neighbour, and the two below.
    One(usize, Vec<u32>),
    /// Single depths, and the comparison with a reference.
    Depths(Vec<u32>, CompareFunction),
}

/// The contents of a channel of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Channel {
    /// The same byte everywhere.
    Constant(u8),
    /// The same as the first such channel, by its number.
    Of(usize),
}

/// Finds constant and equal channels.
struct Facts {
    first: u32,
    /// Bits in which a texel differs from the first.
    varying: u32,
    /// Bits in which a channel differs from the channel 1, 2 or 3 further, in some texel.
    unequal: [u32; 3],
}

impl Facts {
    fn new(first: u32) -> Facts {
        Facts { first, varying: 0, unequal: [0; 3] }
    }

    fn see(&mut self, texel: u32) {
        self.varying |= texel ^ self.first;
        for (n, unequal) in self.unequal.iter_mut().enumerate() {
            *unequal |= texel ^ (texel >> (8 * (n + 1)));
        }
    }

    fn channels(&self, signed: [bool; 4]) -> [Channel; 4] {
        let byte = |bits: u32, n: usize| bits.to_le_bytes()[n];
        std::array::from_fn(|n| {
            if byte(self.varying, n) == 0 {
                return Channel::Constant(byte(self.first, n));
            }
            let equal = |k: &usize| signed[*k] == signed[n] && byte(self.unequal[n - k - 1], *k) == 0;
            Channel::Of((0..n).find(equal).unwrap_or(n))
        })
    }
}

/// The image of a unit: level 0, or all levels if it needs a level of detail.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    /// Axes along u and v.
    pub(crate) axes: [Axis; 2],
    /// Number of entries of a row.
    pub(crate) pitch: i32,
    /// Number of entries of a face.
    pub(crate) face: u32,
    /// The decoded texels.
    pub(crate) texels: Texels,
    /// Contents of the channels. 128 is added to signed ones.
    pub(crate) channels: [Channel; 4],
    /// Positions of the levels, if the unit needs a level of detail.
    pub(crate) levels: Vec<LevelPosition>,
}

/// The position of a level in a table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LevelPosition {
    pub(crate) axes: [Axis; 2],
    /// Index of its first entry.
    pub(crate) first: i32,
    /// Number of entries of a row.
    pub(crate) pitch: i32,
}

/// The properties of a unit that its table depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Key {
    texture: usize,
    palette: Option<usize>,
    modes: [AddressMode; 2],
    /// Address mode along the layers of a volume.
    layers: Option<AddressMode>,
    /// Whether it reads footprints instead of single texels.
    linear: bool,
    /// Number of levels that any level of detail of the unit can reach, if it needs one.
    levels: Option<usize>,
    /// Whether constant and equal channels are left out.
    folds: bool,
    border_color: [u8; 4],
    signed: [bool; 4],
    color_key: Option<ColorKey>,
    shadow: Option<ShadowComparison>,
}

impl Key {
    pub(crate) fn from_unit(unit: &PlannedUnit, folds: bool) -> Key {
        let state = &unit.state;
        Key {
            texture: state.texture,
            palette: state.palette,
            modes: unit.modes(),
            layers: (unit.kind == TextureKind::ThreeDimensional).then_some(state.address_r),
            linear: linear(unit),
            levels: unit.needs_lod().then_some(unit.levels.len()),
            folds,
            border_color: state.border_color,
            signed: state.signed,
            color_key: state.color_key,
            shadow: state.shadow,
        }
    }
}

/// Returns whether a unit reads footprints, on some level at least.
fn linear(unit: &PlannedUnit) -> bool {
    unit.needs_lod() || unit.is_wide() || unit.state.mag_filter == Filter::Linear
}

/// Returns the axis of a volume's layers.
pub(crate) fn layers(unit: &PlannedUnit) -> Option<Axis> {
    (unit.kind == TextureKind::ThreeDimensional).then(|| Axis::new(unit.state.address_r, unit.layers, false))
}

/// Returns the comparison of a unit's depths with r.
pub(crate) fn compares_r(unit: &PlannedUnit) -> Option<ShadowComparison> {
    unit.state.shadow.filter(|shadow| shadow.reference == ShadowReference::R)
}

/// Returns the images of a table in order. `None` stands for the border.
fn images(unit: &PlannedUnit) -> Vec<Option<usize>> {
    if let Some(axis) = layers(unit) {
        let layer = |entry| address(unit.state.address_r, i64::from(axis.first + entry), unit.layers, false);
        return (0..axis.count).map(|entry| layer(entry).map(|layer| layer as usize)).collect();
    }
    let faces = if unit.kind == TextureKind::Cube { CUBE_FACES as usize } else { 1 };
    (0..faces).map(Some).collect()
}

/// Returns the axes of the levels of a unit: of level 0, or of all levels if it needs a level of detail. Returns `None` if rows cannot
/// sample it (levels or several taps of a volume or of depths, or levels where coordinates are those of another kind).
pub(crate) fn axes(unit: &PlannedUnit) -> Option<Vec<[Axis; 2]>> {
    let single = unit.kind == TextureKind::ThreeDimensional || unit.state.shadow.is_some() || unit.is_other_kind();
    if single && (unit.needs_lod() || unit.state.anisotropy > 1) {
        return None;
    }
    let count = if unit.needs_lod() { unit.levels.len() } else { 1 };
    let [s, t] = unit.modes();
    let of = |level: &Level| [Axis::new(s, level.width, unit.border), Axis::new(t, level.height, unit.border)];
    Some(unit.levels.iter().take(count).map(of).collect())
}

/// Returns the number of texels that a table with these axes decodes.
pub(crate) fn size(unit: &PlannedUnit, axes: &[[Axis; 2]]) -> u64 {
    let images = match layers(unit) {
        Some(axis) => axis.count as u64,
        None if unit.kind == TextureKind::Cube => u64::from(CUBE_FACES),
        None => 1,
    };
    let wide = axes.first().map_or(0, |axes| axes[0].count as u64 + 1);
    images * axes.iter().map(|axes| wide * (axes[1].count as u64 + 1)).sum::<u64>()
}

impl Table {
    /// Returns the number of entries.
    pub(crate) fn entries(&self) -> u64 {
        let count = match &self.texels {
            Texels::Single(all) | Texels::One(_, all) | Texels::Depths(all, _) => all.len(),
            Texels::Footprints(all) | Texels::Halves(all) => all.len(),
        };
        count as u64
    }

    /// Decodes the levels of a unit. `folds` tells whether the reader handles constant and equal channels itself.
    pub(crate) fn new(unit: &PlannedUnit, levels: &[[Axis; 2]], image: &Image<'_, i32>, folds: bool) -> Table {
        let images = images(unit);
        // Every unit has a level 0.
        let none = Axis { low: 0, high: 0, first: 0, mask: 0, count: 0, period: None };
        let axes = levels.first().copied().unwrap_or([none; 2]);
        let [columns, rows] = axes;
        let mixes = unit.needs_lod();
        let linear = linear(unit);
        let beyond = i32::from(linear);
        let (wide, high) = ((columns.count + beyond) as usize, (rows.count + beyond) as usize);
        let mut all = Vec::with_capacity(size(unit, levels) as usize);
        let (mut placed, comparison) = (Vec::new(), compares_r(unit));
        for (n, number) in images.iter().enumerate() {
            let start = all.len();
            for (level, axes) in unit.levels.iter().zip(levels) {
                let [columns, rows] = axes;
                if n == 0 && mixes {
                    placed.push(LevelPosition { axes: *axes, first: (all.len() - start) as i32, pitch: wide as i32 });
                }
                let slice = Slice { unit, level, image: *number };
                let column = |x: i32| slice.column(i64::from(x + columns.first));
                let at: Vec<Option<i64>> = (0..columns.count + beyond).map(column).collect();
                // Most words of a row are neighbours, which are decoded together.
                let before = at.iter().take_while(|column| **column != Some(0)).count();
                let in_order = at[before..].iter().zip(0..).take_while(|(column, n)| **column == Some(*n)).count();
                for y in 0..rows.count + beyond {
                    let row = slice.row(i64::from(y + rows.first));
                    let words = match row {
                        Some(y) if decodes_rows(unit) => slice.words(image.words, y, in_order),
                        _ => &[],
                    };
                    let (first, last) = if words.is_empty() { (0, 0) } else { (before, before + words.len()) };
                    all.extend(at[..first].iter().map(|column| decode(&slice, image, *column, row)));
                    decode_row(unit, words, &mut all);
                    all.extend(at[last..].iter().map(|column| decode(&slice, image, *column, row)));
                    // Nobody reads the entries past the end of smaller levels. They hold a texel, so that constant channels stay constant.
                    let filler = all.last().copied().unwrap_or(0);
                    all.resize(all.len() + wide - at.len(), filler);
                }
            }
        }
        let channels = match comparison {
            // The result of a comparison is the same in all channels.
            Some(_) if folds => [Channel::Of(0); 4],
            None if folds && !unit.is_wide() => {
                let mut facts = Facts::new(all.first().copied().unwrap_or(0));
                all.iter().for_each(|texel| facts.see(*texel));
                facts.channels(unit.state.signed)
            }
            _ => [0, 1, 2, 3].map(Channel::Of),
        };
        let mut distinct = (0..4).filter(|n| channels[*n] == Channel::Of(*n));
        let (one, more) = (distinct.next().unwrap_or(0), distinct.next().is_some());
        let count = columns.count as usize * rows.count as usize;
        let (texels, pitch, face) = if let Some(comparison) = comparison {
            (Texels::Depths(all, comparison.function), columns.count as usize, count)
        } else if unit.is_wide() {
            (Texels::Halves(self::columns(&all, wide)), wide, all.len() / images.len())
        } else if !linear {
            (Texels::Single(all), columns.count as usize, count)
        } else if more || mixes {
            (Texels::Footprints(self::columns(&all, wide)), wide, all.len() / images.len())
        } else {
            let byte = |texel: u32| texel >> (8 * one) & 255;
            let footprints = all.chunks(wide * high).flat_map(|face| {
                face.chunks(wide).zip(face.chunks(wide).skip(1)).flat_map(|(upper, lower)| {
                    upper.windows(2).zip(lower.windows(2)).map(|(upper, lower)| {
                        byte(upper[0]) | byte(upper[1]) << 8 | byte(lower[0]) << 16 | byte(lower[1]) << 24
                    })
                })
            });
            (Texels::One(one, footprints.collect()), columns.count as usize, count)
        };
        Table { axes, pitch: pitch as i32, face: face as u32, texels, channels, levels: placed }
    }
}

/// Returns how many texels of a unit can be decoded in the time in which the definition samples one pixel.
pub(crate) fn texels_per_pixel(unit: &PlannedUnit) -> u64 {
    if decodes_rows(unit) { 128 } else { 16 }
}

/// Returns whether [`decode_row`] decodes a unit's texels.
fn decodes_rows(unit: &PlannedUnit) -> bool {
    let is_compared = unit.state.shadow.is_some() && compares_r(unit).is_none();
    !(unit.format.is_compressed() || unit.is_wide() || is_compared || unit.state.color_key.is_some())
}

/// Does what [`decode`] does with the words of neighbouring texels.
fn decode_row(unit: &PlannedUnit, words: &[u32], all: &mut Vec<u32>) {
    if compares_r(unit).is_some() {
        all.extend(words.iter().map(|word| depth_of(*word)));
        return;
    }
    let biased = u32::from_le_bytes(unit.state.signed.map(|signed| if signed { 128 } else { 0 }));
    let entry = |bytes: [u8; 4]| u32::from_le_bytes(bytes) ^ biased;
    if unit.format == TextureFormat::P8 {
        let colors: Vec<u32> = words.iter().map(|index| palette_entry(unit, *index)).collect();
        return format::expand_all(TextureFormat::A8R8G8B8, &colors, entry, all);
    }
    format::expand_all(unit.format, words, entry, all);
}

/// Decodes a texel to bytes, with 128 added to signed ones, or to 16-bit halves, with 32,768 added to signed ones. `None` stands for an
/// index outside of the image.
#[inline]
fn decode(slice: &Slice<'_>, image: &Image<'_, i32>, column: Option<i64>, row: Option<i64>) -> u32 {
    let texel = slice.inside(image.words, column, row);
    let unit = slice.unit;
    if compares_r(unit).is_some() {
        return depth_of(texel.word);
    }
    if let Some(shadow) = unit.state.shadow {
        return if shadow::passes(shadow, 0, &texel) { u32::MAX } else { 0 };
    }
    let channels = lanes::<i32, Silent>(unit, image, &texel, &mut Silent);
    if unit.is_wide() {
        let half = |lane: usize| {
            let bias = if unit.signed_lane(lane) { 32_768 } else { 0 };
            (channels[lane].decision() + bias) as u32 & 0xffff
        };
        return half(0) << 16 | half(1);
    }
    let key = unit.state.color_key;
    // Keys that drop fragments are compared at the fetch.
    let keyed = key.map_or(channels, |key| color_key::apply(unit, &key, channels, &mut Silent).0);
    u32::from_le_bytes(std::array::from_fn(|n| {
        let bias = if unit.state.signed[n] { 128 } else { 0 };
        (keyed[n].decision() + bias) as u8
    }))
}

/// Returns a colour key as an entry of single texels, and the mask of the compared bits.
pub(crate) fn entry_of_key(unit: &PlannedUnit, key: &ColorKey) -> (u32, u32) {
    let (word, mask) = color_key::as_word(unit, key);
    let biased = unit.state.signed.map(|signed| if signed { 128 } else { 0 });
    ((word ^ u32::from_le_bytes(biased)) & mask, mask)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Named;

    /// The entry of every coordinate holds the texel that the address modes give, and its neighbour the next one.
    #[test]
    fn entries_are_what_the_modes_say() {
        for mode in AddressMode::ALL {
            for (n, border) in [(1, false), (4, false), (16, false), (6, false), (8, true), (5, true)] {
                let axis = Axis::new(*mode, n, border);
                for f in -20_000..20_000_i32 {
                    let mut limited = [f.clamp(axis.low, axis.high)];
                    axis.reduce(&mut limited);
                    let [limited] = limited;
                    let entry = ((limited >> 8) - axis.first) & axis.mask;
                    assert!((0..axis.count).contains(&entry), "{mode:?} {n} {f}");
                    let at = |i: i32| address(*mode, i64::from(i), n, border);
                    assert_eq!(at(axis.first + entry), at(f >> 8), "{mode:?} {n} {f}");
                    // Where the limits changed the weight, both texels are the same.
                    let next = at(axis.first + entry + 1);
                    let (weight, wanted) = (limited & 255, f & 255);
                    let same = weight == wanted && next == at((f >> 8) + 1);
                    let alone = weight == 0 && at(f >> 8) == at((f >> 8) + 1);
                    assert!(same || alone, "{mode:?} {n} {f}");
                }
            }
        }
    }

    /// Remainders by all kinds of periods, of the largest numbers too.
    #[test]
    fn periods_are_taken_off() {
        let mut random = crate::random::Random::seeded(9);
        for round in 0..4_000 {
            let side = 1 + (random.bits() % (1 << (1 + round % 13))) as u32;
            let axis = Axis { period: Some((side << 8) as i32), ..Axis::new(AddressMode::Wrap, 3, false) };
            let numbers: Vec<i32> = (0..64).map(|n| (random.bits() as i32) >> (n % 20)).collect();
            let mut reduced = [numbers.clone(), vec![i32::MIN, i32::MAX, 0, -1]].concat();
            let wanted: Vec<i32> = reduced.iter().map(|n| n.rem_euclid((side << 8) as i32)).collect();
            axis.reduce(&mut reduced);
            assert_eq!(reduced, wanted, "{side}");
        }
    }

    /// The axes of levels are those of level 0, shifted.
    #[test]
    fn axes_of_levels_are_shifted() {
        for mode in AddressMode::ALL {
            for (bits, border) in (0..=12).flat_map(|bits| [(bits, false), (bits, true)]) {
                let largest = Axis::new(*mode, 1 << bits, border);
                for shift in 0..=bits {
                    let axis = Axis::new(*mode, 1 << (bits - shift), border);
                    assert_eq!(Axis { count: largest.count, ..axis }, largest.shifted(1 << bits, shift), "{mode:?}");
                    assert_eq!(axis.period, None);
                }
            }
        }
    }
}
