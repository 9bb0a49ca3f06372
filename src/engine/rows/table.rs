//! Textures laid out for rows: texels decoded once, every address mode reduced to limits and a mask.

use crate::number::Lane;
use crate::state::{AddressMode, BORDER_TEXELS, CUBE_FACES, Filter, Named, TextureKind};
use crate::texture::cube::Face;
use crate::texture::fetch::{Slice, lanes};
use crate::texture::unit::{Image, PlannedUnit};
use crate::trace::Silent;

/// How coordinates along one axis become entries of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Axis {
    /// Coordinates are limited to these first, 1/256 texel: beyond them every texel is the same.
    pub(super) low: i32,
    pub(super) high: i32,
    /// The texel of the first entry.
    pub(super) first: i32,
    /// Entries repeat after so many, a power of two less one; -1 where they do not.
    pub(super) mask: i32,
    /// Number of entries.
    pub(super) count: i32,
}

impl Axis {
    /// TEX-7 of `n` texels. `None`: a period that is no power of two.
    fn new(mode: AddressMode, n: u32, border_texels: bool) -> Option<Axis> {
        let n = n as i32;
        let limited =
            |first: i32, last: i32| Axis { low: first << 8, high: last << 8, first, mask: -1, count: last - first + 1 };
        let periodic = |count: i32| Axis { low: i32::MIN, high: i32::MAX, first: 0, mask: count - 1, count };
        let beyond = BORDER_TEXELS as i32;
        match mode {
            AddressMode::Wrap if n.count_ones() == 1 => Some(periodic(n)),
            AddressMode::Mirror if n.count_ones() == 1 => Some(periodic(2 * n)),
            AddressMode::Wrap | AddressMode::Mirror => None,
            AddressMode::ClampToEdge | AddressMode::Clamp => Some(limited(0, n - 1)),
            AddressMode::ClampToBorder if border_texels => Some(limited(-beyond, n - 1 + beyond)),
            AddressMode::ClampToBorder => Some(limited(-1, n)),
        }
    }

    /// Whether coordinates need no limits.
    pub(super) fn repeats(&self) -> bool {
        self.mask >= 0
    }
}

/// Decoded texels: R, G, B, A from the lowest byte up. Signed channels have 128 added, so that they filter as unsigned ones do.
#[derive(Clone, Debug)]
pub(super) enum Texels {
    /// One by one.
    Single(Vec<u32>),
    /// Each with its right neighbour; one more row at the end of each face.
    Pairs(Vec<[u32; 2]>),
}

/// A unit's image at level 0.
#[derive(Clone, Debug)]
pub(super) struct Table {
    /// Along u and v.
    pub(super) axes: [Axis; 2],
    /// Entries of one face.
    pub(super) face: u32,
    /// The texels.
    pub(super) texels: Texels,
}

/// What of a unit a table depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    texture: usize,
    palette: Option<usize>,
    modes: [AddressMode; 2],
    filter: Filter,
    border_color: [u8; 4],
    signed: [bool; 4],
}

impl Key {
    pub(super) fn of(unit: &PlannedUnit) -> Key {
        let state = &unit.state;
        Key {
            texture: state.texture,
            palette: state.palette,
            modes: unit.modes(),
            filter: state.mag_filter,
            border_color: state.border_color,
            signed: state.signed,
        }
    }
}

/// The axes of a unit that rows can sample. `None`: it mixes levels, is filtered at 16 bits, or has a side that does not repeat evenly.
pub(super) fn axes(unit: &PlannedUnit) -> Option<[Axis; 2]> {
    let level = unit.levels.first()?;
    if unit.needs_lod() || unit.is_wide() {
        return None;
    }
    let [s, t] = unit.modes();
    Some([Axis::new(s, level.width, unit.border)?, Axis::new(t, level.height, unit.border)?])
}

/// Texels that a table of these axes decodes.
pub(super) fn size(unit: &PlannedUnit, axes: &[Axis; 2]) -> u64 {
    let faces = if unit.kind == TextureKind::Cube { CUBE_FACES } else { 1 };
    u64::from(faces) * (axes[0].count as u64 + 1) * (axes[1].count as u64 + 1)
}

impl Table {
    /// How much it holds.
    pub(super) fn entries(&self) -> u64 {
        match &self.texels {
            Texels::Single(texels) => texels.len() as u64,
            Texels::Pairs(texels) => texels.len() as u64,
        }
    }

    /// Decodes level 0 of a unit.
    pub(super) fn new(unit: &PlannedUnit, axes: [Axis; 2], image: &Image<'_, i32>) -> Table {
        let faces: &[Face] = if unit.kind == TextureKind::Cube { Face::ALL } else { &[Face::PositiveX] };
        let [columns, rows] = axes;
        let linear = unit.state.mag_filter == Filter::Linear;
        let (mut single, mut pairs) = (Vec::new(), Vec::new());
        let mut line = Vec::with_capacity(columns.count as usize + 1);
        for face in faces {
            let slice = Slice { unit, level: &unit.levels[0], face: *face };
            let texel = |x: i32, y: i32| {
                let texel = slice.texel(image.words, i64::from(x), i64::from(y));
                let channels = lanes::<i32, Silent>(unit, image, &texel, &mut Silent);
                let biased: [u8; 4] = std::array::from_fn(|n| {
                    let bias = if unit.state.signed[n] { 128 } else { 0 };
                    (channels[n].decision() + bias) as u8
                });
                u32::from_le_bytes(biased)
            };
            for y in 0..rows.count + i32::from(linear) {
                line.clear();
                line.extend((0..=columns.count).map(|x| texel(columns.first + x, rows.first + y)));
                if linear {
                    pairs.extend(line.windows(2).map(|pair| [pair[0], pair[1]]));
                } else {
                    single.extend(&line[..columns.count as usize]);
                }
            }
        }
        let face = columns.count * (rows.count + i32::from(linear));
        Table { axes, face: face as u32, texels: if linear { Texels::Pairs(pairs) } else { Texels::Single(single) } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::address::address;

    /// The entry of every coordinate holds the texel that the address modes give, and its neighbour the next one.
    #[test]
    fn entries_are_what_the_modes_say() {
        for mode in AddressMode::ALL {
            for (n, border) in [(1, false), (4, false), (16, false), (6, false), (8, true), (5, true)] {
                let Some(axis) = Axis::new(*mode, n, border) else {
                    assert!(matches!(mode, AddressMode::Wrap | AddressMode::Mirror) && n.count_ones() != 1);
                    continue;
                };
                for f in -20_000..20_000_i32 {
                    let limited = f.clamp(axis.low, axis.high);
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
}
