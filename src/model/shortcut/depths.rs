//! Depth buffers of floats as another renderer keeps them: fractions of a largest number.
//!
//! A plan keeps the numbers themselves in the widest float format: comparisons come out the same. Where words are shown they become what the
//! renderer reads back.
#![allow(clippy::float_arithmetic, reason = "another renderer's depths")]

use super::{Shortcut, Shortcuts};
use crate::plan::Plan;
use crate::state::{DepthFormat, DepthRange, TextureImage};

/// The number that counts as 1.0 in a buffer of 16-bit floats, and of 24-bit ones.
const LARGEST: [f32; 2] = [511.9375, 1e30];

/// The least word above 0: its fraction of the larger number is the least normal one of single precision.
pub(super) const LEAST: u32 = 1.175_494_4e-8_f32.to_bits() >> 7;

/// Returns whether float depths are fractions.
pub(super) fn scales(shortcuts: Shortcuts) -> bool {
    shortcuts.contains(Shortcut::ScaledDepths) || shortcuts.contains(Shortcut::HalfDepths)
}

fn largest(format: DepthFormat) -> f32 {
    LARGEST[usize::from(format == DepthFormat::Z24S8F)]
}

/// Changes the depth buffers of a plan.
pub(super) fn change(plan: &mut Plan, shortcuts: Shortcuts) {
    for depth in plan.targets.iter_mut().filter_map(|target| target.depth.as_mut()) {
        if depth.format == DepthFormat::Z16 && shortcuts.contains(Shortcut::CutDepths) {
            depth.clear = cut_clear(depth.clear);
        }
    }
    // Textures read words of the chip's formats.
    let are_read = plan.textures.iter().any(|texture| matches!(texture.image, TextureImage::Depth { .. }));
    if !scales(shortcuts) || are_read {
        return;
    }
    for draw in plan.draws.iter_mut().filter(|draw| draw.depth_format.is_float()) {
        if let Some(test) = &mut draw.depth_test {
            let highest = largest(draw.depth_format);
            match &mut test.range {
                Some(range) if range.clamps => range.highest = range.highest.min(highest),
                Some(_) => {}
                none => *none = Some(DepthRange { lowest: 0.0, highest, clamps: true, drops_triangles: false }),
            }
        }
        draw.depth_format = DepthFormat::Z24S8F;
    }
    for depth in plan.targets.iter_mut().filter_map(|target| target.depth.as_mut()) {
        if depth.format.is_float() {
            depth.clear = clear(depth.format, depth.clear, shortcuts.contains(Shortcut::HalfDepths));
            depth.format = DepthFormat::Z24S8F;
        }
    }
}

/// Returns the depth that a 16-bit clear leaves where it is divided by 65,535 in single precision, and cut when it is read.
fn cut_clear(clear: u32) -> u32 {
    (f64::from(clear as f32 / 65535.0) * 65535.0) as u32
}

/// Returns the word of 24 bits that a clear leaves. A number that is none counts as the largest.
fn clear(format: DepthFormat, word: u32, of_halves: bool) -> u32 {
    let number = match format {
        _ if word == 0 => 0.0,
        DepthFormat::Z16F if of_halves => of_half(word) * LARGEST[0],
        DepthFormat::Z16F => f32::from_bits((word << 11).wrapping_add(0x3c00_0000)),
        _ => f32::from_bits(word << 7),
    };
    let word = number.min(largest(format)).to_bits() >> 7;
    if word < LEAST { 0 } else { word }
}

/// Returns the depth that is read from a buffer of a format after `change`.
pub fn shown_depth(shortcuts: Shortcuts, format: DepthFormat, word: u32) -> u32 {
    if !scales(shortcuts) || !format.is_float() {
        return word;
    }
    // Half of a step more, because the word was cut.
    let fraction = match word {
        0 => 0.0,
        word if word >= largest(format).to_bits() >> 7 => 1.0,
        word => f32::from_bits(word << 7 | 1 << 6) / largest(format),
    };
    match format {
        DepthFormat::Z16F => to_half(fraction, shortcuts.contains(Shortcut::CutDepths)),
        _ => (f64::from(fraction) * 16_777_215.0) as u32,
    }
}

/// Returns the half-precision word of a number from 0 to 1, cut or to nearest.
fn to_half(number: f32, cut: bool) -> u32 {
    let exponent = ((number.to_bits() >> 23) as i32 - 127).max(-14);
    let steps = f64::from(number) * f64::from((1 << 10) as f32 * f32::from_bits(((127 - exponent) as u32) << 23));
    let steps = if cut { steps.floor() } else { steps.round_ties_even() };
    (exponent + 14) as u32 * 1024 + steps as u32
}

/// Returns the number from 0 to 1 of a half-precision word. What is no number is 0.
fn of_half(word: u32) -> f32 {
    let (exponent, mantissa) = (word >> 10 & 31, (word & 1023) as f32);
    match exponent {
        31 => 0.0,
        0 => mantissa * f32::from_bits((127 - 24) << 23),
        _ => (1024.0 + mantissa) * f32::from_bits((127 + exponent - 25) << 23),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_go_back_and_forth() {
        for word in 0..=0x3c00 {
            assert_eq!((to_half(of_half(word), true), to_half(of_half(word), false)), (word, word));
        }
        assert_eq!((to_half(0.12534 / 511.9375, true), to_half(0.12534 / 511.9375, false)), (3074, 3075));
        assert_eq!((of_half(0xffff), of_half(0x3c00)), (0.0, 1.0));
    }

    /// Clears that a public renderer's pictures show one step lower, and others.
    #[test]
    fn some_clears_lose_a_step() {
        for clear in [0xf, 0x400b, 0x8007, 0xc003, 0xf555] {
            assert_eq!(cut_clear(clear), clear - 1);
        }
        for clear in [0, 0x564, 0xab9, 0xfaaa, 0xffff] {
            assert_eq!(cut_clear(clear), clear);
        }
    }

    #[test]
    fn words_are_shown_as_they_are_read_back() {
        let scaled = Shortcuts::NONE.with(Shortcut::ScaledDepths);
        let shown = |format, word, of_halves| shown_depth(scaled, format, clear(format, word, of_halves));
        assert_eq!(shown(DepthFormat::Z16F, 0xffff, false), 0x3c00);
        assert_eq!(shown(DepthFormat::Z16F, 0xffff, true), 0);
        assert_eq!((shown(DepthFormat::Z16F, 0x400b, false), shown(DepthFormat::Z16F, 0xf, false)), (3075, 257));
        assert_eq!(shown(DepthFormat::Z24S8F, 0xff_ffff, false), 0xff_ffff);
        assert_eq!(shown(DepthFormat::Z24S8F, 0xf4_6001, false), 0xff_ffff);
        assert_eq!(shown(DepthFormat::Z24S8F, 0xbf_400b, false), 0);
        assert_eq!(clear(DepthFormat::Z24S8F, 0x3f_c023, false), 0);
        assert_eq!(shown_depth(Shortcuts::NONE, DepthFormat::Z16F, 7), 7);
    }
}
