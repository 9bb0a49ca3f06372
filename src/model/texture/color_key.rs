//! KEY-1: colour keys, which make texels of one colour transparent or black, or drop the fragment.

use super::planned::PlannedUnit;
use super::report::Report;
use crate::number::Lane;
use crate::state::{ColorKey, ColorKeyMode};
use crate::trace::Observer;

/// Returns the number of channels that are compared: four, or three (R, G, B) if the format has no alpha.
pub fn compared(unit: &PlannedUnit) -> usize {
    if unit.format.has_alpha() { 4 } else { 3 }
}

/// Returns the key in the form in which lanes hold a texel: bytes, or two's complement values for signed channels.
pub fn as_lanes(unit: &PlannedUnit, key: &ColorKey) -> [i32; 4] {
    std::array::from_fn(|n| {
        let byte = key.color[n];
        if unit.state.signed[n] { i32::from(byte as i8) } else { i32::from(byte) }
    })
}

/// Returns the key as a word of bytes with R lowest, and the mask of the bits that are compared.
pub(crate) fn as_word(unit: &PlannedUnit, key: &ColorKey) -> (u32, u32) {
    let mask = if compared(unit) == 4 { u32::MAX } else { 0x00ff_ffff };
    (u32::from_le_bytes(key.color) & mask, mask)
}

/// Returns the channels that a match sets to 0.
pub fn cleared(mode: ColorKeyMode) -> [bool; 4] {
    match mode {
        ColorKeyMode::Alpha => [false, false, false, true],
        ColorKeyMode::Color => [true; 4],
        ColorKeyMode::Texel => [false; 4],
    }
}

/// Applies the unit's key to a texel whose lanes are bytes. Returns the texel, and whether the fragment is dropped.
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
