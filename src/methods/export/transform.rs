//! The transform of Celsius: vertices pass as they are, or, where they have fog, through the fixed-function pipe with matrices that change nothing.

use super::Words;
use crate::celsius::{DIVIDES, PASSED_SCALE, PASSES, VIEW_MATRIX_ENABLE};
use crate::class;

const SET_COMPOSITE_MATRIX: u32 = 0x680;
const SET_TEXGEN_S: u32 = 0x3c0;
const SET_TEXTURE_MATRIX_ENABLE: u32 = 0x420;
const SET_SKIN_MODE: u32 = 0x328;

/// Sets what no draw changes.
pub(super) fn initial(words: &mut Words) {
    words.set(class::SET_LIGHTING_ENABLE, 0);
    words.set(class::SET_SPECULAR_ENABLE, 1);
    // The secondary colour is apart from the primary one.
    words.own(class::SET_LIGHT_CONTROL, 2);
    words.set(SET_SKIN_MODE, 0);
    words.set(class::SET_POINT_PARAMS_ENABLE, 0);
    for unit in 0..2 {
        (0..4).for_each(|component| words.set(SET_TEXGEN_S + 16 * unit + 4 * component, 0));
        words.set(SET_TEXTURE_MATRIX_ENABLE + 4 * unit, 0);
    }
    words.set(class::SET_FOG_GEN_MODE, 6);
    words.set(class::SET_EDGE_FLAG, 1);
    for n in 0..16 {
        words.number(SET_COMPOSITE_MATRIX + 4 * n, if n % 5 == 0 { 1.0 } else { 0.0 });
    }
    for n in 0..4 {
        words.number(class::SET_VIEWPORT_OFFSET + 4 * n, 0.0);
        words.own(PASSED_SCALE + 4 * n, 1.0_f32.to_bits());
        words.own(PASSED_SCALE + 16 + 4 * n, 0);
    }
}

/// Chooses whether vertices pass or are transformed.
pub(super) fn choose(words: &mut Words, transforms: bool) {
    words.own(VIEW_MATRIX_ENABLE, DIVIDES | if transforms { 0 } else { PASSES });
}
