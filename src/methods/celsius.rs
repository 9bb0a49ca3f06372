//! State of the NV10 classes (Celsius) as Kelvin's words, by which draws read it.
//!
//! Most words are the same ([`Family::own`] knows their numbers). The others, and what the class does not have, stand here. Sources: the
//! register database and the hardware tests of envytools (MIT), for the origin of the window Mesa's nouveau driver (MIT).

use ninebit_program::registers::unit::{ENABLE, STAGE_CUBE, STAGE_TWO};

use crate::class::{self, Family, of_unit};
use crate::vertex::attribute;

/// TEX_FORMAT of unit 0.
pub(crate) const TEX_FORMAT: u32 = 0x220;
/// VIEW_MATRIX_ENABLE.
pub(crate) const VIEW_MATRIX_ENABLE: u32 = 0x3e8;
/// In [`VIEW_MATRIX_ENABLE`]: vertices are not transformed.
pub(crate) const PASSES: u32 = 1;
/// In [`VIEW_MATRIX_ENABLE`]: both sets of texture coordinates are divided by w.
pub(crate) const DIVIDES: u32 = 6;
/// The row of the second model-view matrix that scales vertices that are not transformed; the next one is added.
pub(crate) const PASSED_SCALE: u32 = 0x440;
/// Whose state marks draws that the model cannot draw as the chip: where it is not 0.
pub(crate) const NOT_MODELLED: [u32; 3] = [0x3f8, 0xd74, 0x1658];

/// The window coordinates of the class begin at -2048.
pub(crate) const ORIGIN: f32 = 2048.0;

/// The attributes in the order of the class's arrays, by Kelvin's numbers.
pub(crate) const ARRAY_ORDER: [usize; 8] = [0, 3, 4, 9, 10, 2, 1, 5];

/// Texture formats whose code is not Kelvin's, with it.
const FORMATS: [(u32, u32); 1] = [(0x13, 0x1b)];
/// The other formats that the class has.
const SAME_FORMATS: [u32; 15] = [0, 1, 2, 3, 4, 5, 6, 7, 0xb, 0xc, 0xe, 0xf, 0x10, 0x11, 0x12];
/// A code that no format has.
const NO_FORMAT: u32 = 0xff;
/// The origins of texel coordinates, and their value where both are corners.
const ORIGINS: (u32, u32) = (0x78, 0x50);
/// Kelvin's format of an attribute without an array.
const NO_ARRAY: u32 = 2;
/// LIGHT_MODEL, whose first bit says that specular light reads the secondary colour.
const LIGHT_MODEL: u32 = 0x294;

/// State that the class does not have, with the value that Kelvin's would have.
const CONSTANT: [(u32, u32); 12] = [
    (class::SET_TRANSFORM_EXECUTION_MODE, 0),
    (class::SET_ZMIN_MAX_CONTROL, 0x10),
    (class::SET_ANTI_ALIASING_CONTROL, 0),
    (class::SET_STIPPLE_ENABLE, 0),
    (class::SET_LIGHT_TWO_SIDE_ENABLE, 0),
    (class::SET_SHADER_CLIP_PLANE_MODE, 0),
    (class::SET_DOT_RGBMAPPING, 0),
    (class::SET_SHADER_OTHER_STAGE_INPUT, 0),
    (class::SET_TEXGEN_VIEW_MODEL, 0),
    (class::SET_LOGIC_OP_ENABLE, 0),
    (class::SET_TEXTURE_CONTROL0 + 128, 0),
    (class::SET_TEXTURE_CONTROL0 + 192, 0),
];

/// What is known of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StateWord {
    /// Kelvin's word.
    Word(u32),
    /// It was never set; its own number.
    Unset(u32),
    /// The class has nothing of the kind.
    Absent,
}

/// Returns the value of a state that the class does not have.
pub(crate) fn constant(kelvin: u32) -> Option<u32> {
    CONSTANT.iter().find(|(number, _)| *number == kelvin).map(|(_, word)| *word)
}

/// Reads state by Kelvin's number. `own` has the class's own words.
pub(crate) fn state_word(kelvin: u32, own: impl Fn(u32) -> Option<u32>) -> StateWord {
    let read = |number: u32| own(number).map_or(StateWord::Unset(number), StateWord::Word);
    let then = |known: StateWord, change: &dyn Fn(u32) -> u32| match known {
        StateWord::Word(word) => StateWord::Word(change(word)),
        other => other,
    };
    match (Family::Celsius.own(kelvin), unit_of(kelvin)) {
        (None, Some((class::SET_TEXTURE_ADDRESS, unit))) => own_of_unit(class::SET_TEXTURE_FORMAT, unit)
            .map_or(StateWord::Word(0), |number| then(read(number), &address)),
        (None, _) if kelvin == class::SET_SHADER_STAGE_PROGRAM => stages(&own),
        // NV15 and later have it; for NV10 nothing sets it.
        (Some(number), _) if kelvin == class::SET_LOGIC_OP_ENABLE => StateWord::Word(own(number).unwrap_or(0)),
        (None, _) if attribute_of(kelvin).is_some() => StateWord::Word(NO_ARRAY),
        // Generators and matrices of the sets that only Kelvin has.
        (None, _) if (0x3c0..0x400).contains(&kelvin) || (0x420..0x430).contains(&kelvin) => StateWord::Word(0),
        (None, _) => constant(kelvin).map_or(StateWord::Absent, StateWord::Word),
        (Some(number), Some((class::SET_TEXTURE_FORMAT, _))) => then(read(number), &format),
        (Some(number), Some((class::SET_TEXTURE_FILTER, _))) => then(read(number), &filter),
        (Some(number), _) => match kelvin {
            class::SET_LIGHT_CONTROL => then(read(number), &|word| word & 0x1_0000 | word >> 1 & 1),
            class::SET_COLOR_MATERIAL => {
                let vertex_specular = own(LIGHT_MODEL).unwrap_or(0) & 1 != 0;
                then(read(number), &|word| material(word, vertex_specular))
            }
            class::SET_FOG_GEN_MODE => then(read(number), &|mode| if mode == 0 { 6 } else { mode }),
            _ if is_window(kelvin) => then(read(number), &window),
            _ => match attribute_of(kelvin) {
                Some(attribute) => then(read(number), &|word| array(word, attribute)),
                None => read(number),
            },
        },
    }
}

/// Returns the own number and word of a state that has this word in Kelvin; `None` if the class has no such word.
pub(crate) fn own(kelvin: u32, word: u32) -> Option<(u32, u32)> {
    let number = Family::Celsius.own(kelvin)?;
    let word = match (kelvin, unit_of(kelvin)) {
        (_, Some((class::SET_TEXTURE_FILTER, _))) => word & 0x1fff | (word >> 16 & 7) << 24 | (word >> 24 & 7) << 28,
        (class::SET_FOG_GEN_MODE, _) => {
            if word == 6 {
                0
            } else {
                word
            }
        }
        _ if is_window(kelvin) => window(word),
        _ => word,
    };
    Some((number, word))
}

/// Returns the word of a texture's format that has these words in Kelvin; `None` if the class has no such format.
pub(crate) fn texture_format(format: u32, address: u32) -> Option<u32> {
    let code = format >> 8 & 0xff;
    let renamed = FORMATS.iter().find(|(_, kelvin)| *kelvin == code).map(|(own, _)| *own);
    let code = renamed.or_else(|| SAME_FORMATS.contains(&code).then_some(code))?;
    let sides = (format >> 20 & 0xff) << 16;
    Some(format & 7 | ORIGINS.1 | code << 7 | (format >> 16 & 0xf) << 12 | sides | modes(address))
}

/// Returns whether texel coordinates begin at the corners of texels, by the own word of a texture's format.
pub(crate) fn begins_at_corners(format: u32) -> bool {
    format & ORIGINS.0 == ORIGINS.1
}

fn modes(address: u32) -> u32 {
    (address & 7) << 24 | (address >> 4 & 1) << 27 | (address >> 8 & 7) << 28 | (address >> 12 & 1) << 31
}

/// Returns Kelvin's address modes of a texture's format.
fn address(word: u32) -> u32 {
    // Clamped to the edge in the third dimension, which no texture has.
    word >> 24 & 7 | (word >> 27 & 1) << 4 | (word >> 28 & 7) << 8 | (word >> 31) << 12 | 3 << 16
}

fn format(word: u32) -> u32 {
    let code = word >> 7 & 0x1f;
    let renamed = FORMATS.iter().find(|(own, _)| *own == code).map(|(_, kelvin)| *kelvin);
    let code = renamed.unwrap_or(if SAME_FORMATS.contains(&code) { code } else { NO_FORMAT });
    // Two dimensions, no border texels.
    word & 7 | 8 | 2 << 4 | code << 8 | (word >> 12 & 0xf) << 16 | (word >> 16 & 0xff) << 20
}

fn filter(word: u32) -> u32 {
    word & 0x1fff | (word >> 24 & 7) << 16 | (word >> 28 & 7) << 24
}

/// A bit for each colour says that the vertex gives it; specular light may take the secondary one.
fn material(word: u32, vertex_specular: bool) -> u32 {
    let source = |bit: u32, source: u32| ((word >> bit & 1) * source) << (2 * bit);
    source(0, 1) | source(1, 1) | source(2, 1) | source(3, if vertex_specular { 2 } else { 1 })
}

/// Adds [`ORIGIN`] to both ends of a window clip.
fn window(word: u32) -> u32 {
    (word & 0xfff ^ 0x800) | (word & 0xfff_0000 ^ 0x800_0000)
}

fn is_window(kelvin: u32) -> bool {
    (class::SET_WINDOW_CLIP_HORIZONTAL..class::SET_WINDOW_CLIP_VERTICAL + 32).contains(&kelvin)
}

/// Returns Kelvin's format of an array. INFERRED: 16-bit integers stand for themselves but in normals.
fn array(word: u32, attribute: u32) -> u32 {
    let kind = match (word & 7, attribute as usize) {
        (kind @ (0 | 4), attribute::DIFFUSE | attribute::SPECULAR) => kind,
        (2, _) => 2,
        (1, attribute::NORMAL) => 1,
        (1, _) => 5,
        // No type has this number.
        _ => 0xf,
    };
    kind | (word >> 4 & 7) << 4 | (word >> 8 & 0xff) << 8
}

/// Returns the stages of the texture shader: each enabled unit samples.
fn stages(own: &impl Fn(u32) -> Option<u32>) -> StateWord {
    let mut word = 0;
    for unit in 0..2 {
        let number = |method| own_of_unit(method, unit).unwrap_or(0);
        let (enable, format) = (number(class::SET_TEXTURE_CONTROL0), number(class::SET_TEXTURE_FORMAT));
        let Some(control) = own(enable) else { return StateWord::Unset(enable) };
        if ENABLE.is_set(control) {
            let cube = own(format).is_some_and(|format| format >> 2 & 1 != 0);
            word |= if cube { STAGE_CUBE } else { STAGE_TWO } << (5 * unit);
        }
    }
    StateWord::Word(word)
}

/// Returns the method of unit 0 and the unit, for a method of texture units.
fn unit_of(kelvin: u32) -> Option<(u32, usize)> {
    (class::SET_TEXTURE_OFFSET..class::SET_TEXTURE_OFFSET + 256)
        .contains(&kelvin)
        .then_some((kelvin & !0xc0, (kelvin >> 6 & 3) as usize))
}

fn own_of_unit(method: u32, unit: usize) -> Option<u32> {
    Family::Celsius.own(of_unit(method, unit))
}

/// Returns the attribute of an array's format.
fn attribute_of(kelvin: u32) -> Option<u32> {
    let first = class::SET_VERTEX_DATA_ARRAY_FORMAT;
    (first..first + 64).contains(&kelvin).then(|| (kelvin - first) / 4)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn word(kelvin: u32, own: &[(u32, u32)]) -> StateWord {
        state_word(kelvin, |number| own.iter().find(|(other, _)| *other == number).map(|(_, word)| *word))
    }

    #[test]
    fn textures_go_there_and_back() {
        // Two dimensions, A8R8G8B8, 3 levels of 64 x 16; mirrored and clamped.
        let (format, address) = (1 | 8 | 2 << 4 | 6 << 8 | 3 << 16 | 6 << 20 | 4 << 24, 2 | 3 << 8 | 3 << 16);
        let own = texture_format(format, address).unwrap_or(0);
        assert_eq!(own, 1 | 0x50 | 6 << 7 | 3 << 12 | 6 << 16 | 4 << 20 | 2 << 24 | 3 << 28);
        assert!(begins_at_corners(own) && !begins_at_corners(own ^ 0x18));
        assert_eq!(word(class::SET_TEXTURE_FORMAT + 64, &[(0x224, own)]), StateWord::Word(format));
        assert_eq!(word(class::SET_TEXTURE_ADDRESS + 64, &[(0x224, own)]), StateWord::Word(address));
        let kelvin = 0x0102_1fff;
        let (number, filter) = super::own(class::SET_TEXTURE_FILTER, kelvin).unwrap_or_default();
        assert_eq!((number, filter), (0x248, 0x1200_1fff));
        assert_eq!(word(class::SET_TEXTURE_FILTER, &[(0x248, filter)]), StateWord::Word(kelvin));
        // 8 bits of intensity in rows.
        assert_eq!(texture_format(0x1b << 8, 0).map(|word| word >> 7 & 0x1f), Some(0x13));
        assert_eq!(texture_format(0x3a << 8, 0), None);
    }

    #[test]
    fn what_the_class_lacks_is_told_from_what_was_not_set() {
        assert_eq!(word(class::SET_STIPPLE_ENABLE, &[]), StateWord::Word(0));
        assert_eq!(word(class::SET_EYE_VECTOR, &[]), StateWord::Absent);
        assert_eq!(word(class::SET_BLEND_ENABLE, &[]), StateWord::Unset(0x304));
        assert_eq!(word(class::SET_SHADER_STAGE_PROGRAM, &[]), StateWord::Unset(0x228));
        assert_eq!(word(class::SET_SHADER_STAGE_PROGRAM, &[(0x228, 1 << 30), (0x22c, 0)]), StateWord::Word(STAGE_TWO));
        assert_eq!(word(class::SET_VERTEX_DATA_ARRAY_FORMAT + 24, &[]), StateWord::Word(NO_ARRAY));
    }

    #[test]
    fn words_with_other_fields_are_translated() {
        // Positions of three numbers, colours of four bytes.
        assert_eq!(word(class::SET_VERTEX_DATA_ARRAY_FORMAT, &[(0xd04, 0x1832)]), StateWord::Word(0x1832));
        assert_eq!(word(class::SET_VERTEX_DATA_ARRAY_FORMAT + 12, &[(0xd0c, 0x1844)]), StateWord::Word(0x1844));
        assert_eq!(word(class::SET_FOG_GEN_MODE, &[(0x2a0, 0)]), StateWord::Word(6));
        assert_eq!(word(class::SET_COLOR_MATERIAL, &[(0x298, 0xc), (0x294, 1)]), StateWord::Word(0x90));
        assert_eq!(word(class::SET_LIGHT_CONTROL, &[(0x294, 0x1_0003)]), StateWord::Word(0x1_0001));
        // From pixel 0 to pixel 639.
        let kelvin = 639 << 16;
        assert_eq!(own(class::SET_WINDOW_CLIP_HORIZONTAL, kelvin), Some((0x2c0, (639 ^ 0x800) << 16 | 0x800)));
        let (number, clip) = own(class::SET_WINDOW_CLIP_HORIZONTAL, kelvin).unwrap_or_default();
        assert_eq!(word(class::SET_WINDOW_CLIP_HORIZONTAL, &[(number, clip)]), StateWord::Word(kelvin));
    }
}
