//! KEY-1: texels of one colour made transparent, black, or left out.

use super::planned::PlannedUnit;
use super::report::Report;
use crate::number::Lane;
use crate::state::{ColorKey, ColorKeyMode};
use crate::trace::Observer;

/// Channels that are compared: all, or R, G and B of a format without alpha.
fn compared(unit: &PlannedUnit) -> usize {
    if unit.format.has_alpha() { 4 } else { 3 }
}

/// The key as lanes hold a texel: bytes, of signed channels two's complement.
pub(super) fn as_lanes(unit: &PlannedUnit, key: &ColorKey) -> [i32; 4] {
    std::array::from_fn(|n| {
        let byte = key.color[n];
        if unit.state.signed[n] { i32::from(byte as i8) } else { i32::from(byte) }
    })
}

/// A texel's lanes as bytes of a word, R the lowest, with the bits that are compared of those.
pub fn as_word(unit: &PlannedUnit, key: &ColorKey) -> (u32, u32) {
    let mask = if compared(unit) == 4 { u32::MAX } else { 0x00ff_ffff };
    (u32::from_le_bytes(key.color) & mask, mask)
}

/// Channels that a match makes 0.
pub(super) fn cleared(mode: ColorKeyMode) -> [bool; 4] {
    match mode {
        ColorKeyMode::Alpha => [false, false, false, true],
        ColorKeyMode::Color => [true; 4],
        ColorKeyMode::Texel => [false; 4],
    }
}

/// A texel, whose lanes are bytes, behind the unit's key, and whether the fragment is dropped.
#[inline]
pub fn apply<L: Lane, O: Observer>(
    unit: &PlannedUnit,
    key: &ColorKey,
    texel: [L; 4],
    observer: &mut O,
) -> ([L; 4], bool) {
    let wanted = as_lanes(unit, key);
    let matched = (0..compared(unit)).all(|n| texel[n].decision() == wanted[n]);
    let cleared = cleared(key.mode);
    let keyed: [L; 4] = std::array::from_fn(|n| if matched && cleared[n] { L::ZERO } else { texel[n] });
    if O::ON {
        Report { unit, prefix: "" }.color_key(key, (compared(unit), matched), (&texel, &keyed), observer);
    }
    (keyed, matched && key.mode == ColorKeyMode::Texel)
}
