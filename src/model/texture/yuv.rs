//! TEX-19: the conversion of Y, Cb and Cr that texture registers hold as R, G, B.
//!
//! Of 38,365 captured colours these have others: (298, 409, 100, 208, 516) >> 8 with 128 added 33,922, without 25,672, BT.601 rounded 33,790. A
//! conversion of texels, before the texture shader, changes every pixel of a bump map's frame.

use super::report;
use crate::combiner::registers::channel_name;
use crate::number::{Integer, Lane};
use crate::trace::report::{register, register_step};
use crate::trace::{Observer, Rule};

/// TEX-19: returns channel 0 to 2 (R, G, B) of a colour, 0 to 255. The register holds Y, Cb and Cr, each -256 to 255.
#[inline(always)]
pub fn converted<I: Integer>(channel: usize, [y, cb, cr]: [I; 3]) -> I {
    let term = |factor: i64, of: I, down: i64| (I::new(factor) * of).down(I::new(down));
    let twice = |term: I| term + term;
    let luma = term(149, y, 7);
    let sum = match channel {
        0 => luma + twice(term(409, cr, 9)) - I::new(223),
        1 => luma + I::new(136) - twice(term(100, cb, 9)) - twice(term(208, cr, 9)),
        _ => luma + term(129, cb, 6) - I::new(277),
    };
    sum.limited(0, 255)
}

/// Returns a channel of the colour by ITU-R BT.601 in real numbers: Y runs from 16 to 235, Cb and Cr from 16 to 240.
#[allow(clippy::float_arithmetic, reason = "the ideal of TEX-19")]
pub(crate) fn real(channel: usize, [y, cb, cr]: [f64; 3]) -> f64 {
    // Weights of red and blue in luma.
    const RED: f64 = 0.299;
    const BLUE: f64 = 0.114;
    let luma = 255.0 / 219.0 * (y - 16.0);
    let [blue, red] =
        [(BLUE, cb), (RED, cr)].map(|(weight, chroma)| 2.0 * (1.0 - weight) * 255.0 / 224.0 * (chroma - 128.0));
    let sum = match channel {
        0 => luma + red,
        1 => luma - (BLUE * blue + RED * red) / (1.0 - RED - BLUE),
        _ => luma + blue,
    };
    sum.clamp(0.0, 255.0)
}

/// TEX-19: returns the register of a unit after the conversion. Alpha stays.
pub(crate) fn convert<L: Lane, O: Observer>(unit: usize, color: [L; 4], observer: &mut O) -> [L; 4] {
    let [y, cb, cr, alpha] = color;
    let held = [y, cb, cr].map(Lane::decision);
    let [r, g, b] = [0, 1, 2].map(|channel| {
        let value = L::mixed([y, cb, cr], converted(channel, held), |real_color| real(channel, real_color));
        observer.observe(Rule::Tex19, value)
    });
    if O::ON {
        report_colors(unit, color, [r, g, b], observer);
    }
    [r, g, b, alpha]
}

/// Reports the three channels, which read the register, and then that it is written.
fn report_colors<L: Lane, O: Observer>(unit: usize, held: [L; 4], converted: [L; 3], observer: &mut O) {
    let block = report::block(unit);
    let name = |channel: usize| format!("texture{unit}.{}", channel_name(channel));
    let channels = [0, 1, 2].map(|channel: usize| {
        let operation = ["convert_yuv_red", "convert_yuv_green", "convert_yuv_blue"][channel];
        let part = format!("unit{unit}.converted.{}", channel_name(channel));
        let inputs = [0, 1, 2].map(|n| register(name(n), held[n])).to_vec();
        observer.tell(register_step(&block, "TEX-19", part, converted[channel]).by(operation, inputs))
    });
    for (channel, operand) in channels.into_iter().enumerate() {
        let step = register_step(&block, "TEX-19", name(channel), converted[channel]);
        observer.step(step.by("write", vec![operand]));
    }
}

#[cfg(test)]
#[allow(clippy::float_arithmetic, reason = "errors against the ideal")]
mod tests {
    use super::*;

    #[test]
    fn captured_colors() {
        let all = |color: [i64; 3]| [0, 1, 2].map(|channel| converted(channel, color));
        assert_eq!(all([254, 0, 0]), [72, 255, 18]);
        assert_eq!(all([0; 3]), [0, 136, 0]);
    }

    /// TEX-19 names the largest errors, which these colours attain.
    #[test]
    fn errors_are_as_stated() {
        let mut ends = [(0.0_f64, 0.0_f64); 3];
        let mut note = |channel: usize, color: [i32; 3]| {
            let error = f64::from(converted(channel, color)) - real(channel, color.map(f64::from));
            let (low, high) = &mut ends[channel];
            (*low, *high) = (low.min(error), high.max(error));
        };
        for (y, chroma) in (0..=255).flat_map(|y| (0..=255).map(move |chroma| (y, chroma))) {
            note(0, [y, 0, chroma]);
            note(2, [y, chroma, 0]);
            (0..=255).step_by(3).for_each(|cr| note(1, [y, chroma, cr]));
        }
        let stated = [(-3.1134, 0.193), (-0.589, 4.6524), (-2.5446, 0.0)];
        for ((low, high), (least, most)) in ends.into_iter().zip(stated) {
            assert!((low - least).abs() < 1e-3 && (high - most).abs() < 1e-3, "{low} {high}");
        }
    }
}
