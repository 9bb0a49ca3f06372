//! ROP-1 to ROP-5: alpha test, blend equations and factors, written in the operations of an [`Algebra`]. [`run`]
//! applies them to numbers, with reports.

use super::surface;
use crate::algebra::Algebra;
use crate::combiner::direct::Direct;
use crate::combiner::registers::channel_name;
use crate::number::Lane;
use crate::state::{AlphaTest, Blend, BlendEquation, BlendFactor, SurfaceFormat};
use crate::trace::{Decision, Observer, Operand, Rule, Work, report};

const BLOCK: &str = "blend";

/// ROP-4: returns the blend factor of one channel.
#[inline(always)]
pub fn factor<A: Algebra>(
    factor: BlendFactor,
    channel: usize,
    source: &[A::Register; 4],
    destination: &[A::Register; 4],
    constant: &[A::Register; 4],
    a: &mut A,
) -> A::Register {
    match factor {
        BlendFactor::Zero => a.byte(0),
        BlendFactor::One => a.byte(255),
        BlendFactor::SourceColor => source[channel],
        BlendFactor::OneMinusSourceColor => a.complement(source[channel]),
        BlendFactor::SourceAlpha => source[3],
        BlendFactor::OneMinusSourceAlpha => a.complement(source[3]),
        BlendFactor::DestinationAlpha => destination[3],
        BlendFactor::OneMinusDestinationAlpha => a.complement(destination[3]),
        BlendFactor::DestinationColor => destination[channel],
        BlendFactor::OneMinusDestinationColor => a.complement(destination[channel]),
        BlendFactor::SourceAlphaSaturate if channel == 3 => a.byte(255),
        BlendFactor::SourceAlphaSaturate => {
            let free = a.complement(destination[3]);
            a.least(source[3], free)
        }
        BlendFactor::ConstantColor => constant[channel],
        BlendFactor::OneMinusConstantColor => a.complement(constant[channel]),
        BlendFactor::ConstantAlpha => constant[3],
        BlendFactor::OneMinusConstantAlpha => a.complement(constant[3]),
    }
}

/// ROP-2, ROP-3: returns the blended channel before clamping. `fs` and `fd` are the factors.
#[inline(always)]
pub(crate) fn equation<A: Algebra>(
    equation: BlendEquation,
    [s, d]: [A::Register; 2],
    [fs, fd]: [A::Register; 2],
    a: &mut A,
) -> A::Register {
    const RULE: Rule = Rule::Rop2;
    let products = |a: &mut A| {
        let [s, d, fs, fd] = [s, d, fs, fd].map(|v| a.plain(v));
        (a.product(RULE, s, fs), a.product(RULE, d, fd))
    };
    let sum = match equation {
        BlendEquation::Add => {
            let (source, destination) = products(a);
            a.add(RULE, source, destination)
        }
        BlendEquation::Subtract => {
            let (source, destination) = products(a);
            a.subtract(RULE, source, destination)
        }
        BlendEquation::ReverseSubtract => {
            let (source, destination) = products(a);
            a.subtract(RULE, destination, source)
        }
        BlendEquation::Min => {
            let least = a.least(s, d);
            return a.yielded(RULE, least);
        }
        BlendEquation::Max => {
            let greatest = a.greatest(s, d);
            return a.yielded(RULE, greatest);
        }
        BlendEquation::SignedAdd => {
            let signed = a.signed_byte(s);
            let sum = a.plus(d, signed);
            return a.yielded(RULE, sum);
        }
        BlendEquation::SignedReverseSubtract => {
            let signed = a.signed_byte(s);
            let difference = a.minus(d, signed);
            return a.yielded(RULE, difference);
        }
    };
    a.rounded(sum)
}

/// ROP-5: returns a fragment without the low bits that the surface drops. Alpha keeps all bits.
#[inline(always)]
pub fn truncated<A: Algebra>(format: SurfaceFormat, mut fragment: [A::Register; 4], a: &mut A) -> [A::Register; 4] {
    for (value, bits) in fragment.iter_mut().zip(surface::dropped_bits(format)).filter(|(_, bits)| *bits != 0) {
        *value = a.truncated(bits, *value);
    }
    fragment
}

/// The values of blending one channel.
#[derive(Clone, Copy, Debug)]
pub struct BlendValues<R> {
    /// The factors of source and destination (ROP-4).
    pub factors: [R; 2],
    /// The result of the equation before clamping (ROP-2, ROP-3).
    raw: R,
    /// The result, clamped to a byte.
    pub blended: R,
}

/// ROP-2 to ROP-4: blends one channel. `source` must be [`truncated`].
#[inline(always)]
pub fn evaluate<A: Algebra>(
    blend: &Blend,
    channel: usize,
    source: &[A::Register; 4],
    destination: &[A::Register; 4],
    constant: &[A::Register; 4],
    a: &mut A,
) -> BlendValues<A::Register> {
    let fs = factor(blend.source, channel, source, destination, constant, a);
    let fd = factor(blend.destination, channel, source, destination, constant, a);
    let raw = equation(blend.equation, [source[channel], destination[channel]], [fs, fd], a);
    BlendValues { factors: [fs, fd], raw, blended: a.clamped(raw) }
}

/// ROP-2 to ROP-5 in an algebra: blends the `channels` (bits R, G, B, A) of a fragment. The others are those of the
/// source.
pub fn blend<A: Algebra>(
    blend: &Blend,
    channels: u8,
    constant: &[A::Register; 4],
    source: &[A::Register; 4],
    destination: &[A::Register; 4],
    a: &mut A,
) -> [A::Register; 4] {
    let mut out = *source;
    for channel in (0..4).filter(|c| channels >> c & 1 != 0) {
        out[channel] = evaluate(blend, channel, source, destination, constant, a).blended;
    }
    out
}

/// Blends the `channels` (bits R, G, B, A) of a fragment with the contents of the surface. The others are those of the
/// source.
///
/// `source` must be truncated to the surface's precision, except for its alpha (ROP-5).
#[inline]
pub fn run<L: Lane, O: Observer>(
    blend: &Blend,
    channels: u8,
    constant: [u8; 4],
    source: &[L; 4],
    destination: &[L; 4],
    observer: &mut O,
) -> [L; 4] {
    let constant = constant.map(L::byte);
    let mut out = *source;
    for channel in (0..4).filter(|c| channels >> c & 1 != 0) {
        if O::MEASURES && matches!(blend.equation, BlendEquation::SignedAdd | BlendEquation::SignedReverseSubtract) {
            let negative = |byte: i32| i64::from(byte >= 128);
            let s = source[channel];
            observer.decided(Decision::Sign, negative(s.decision()), || negative(s.ideal_decision()));
        }
        observer.count(Work::Blends, 1);
        let mut direct = Direct::plain(observer);
        let values = evaluate(blend, channel, source, destination, &constant, &mut direct);
        out[channel] = values.blended;
        if O::ON {
            report_channel(blend, channel, source, destination, &constant, &values, observer);
        }
    }
    out
}

/// ROP-1: returns whether an alpha passes the test.
#[inline]
pub fn alpha_test<L: Lane, O: Observer>(test: &AlphaTest, alpha: L, observer: &mut O) -> bool {
    let passes = |alpha: i32| test.function.passes(i64::from(alpha.clamp(0, 255)), i64::from(test.reference));
    let passed = match observer.observe_alpha(alpha) {
        Some(fine) => test.function.passes(fine, i64::from(test.reference) << 16),
        None => passes(alpha.decision()),
    };
    observer.decided(Decision::AlphaTest, i64::from(passed), || i64::from(passes(alpha.ideal_decision())));
    if O::ON {
        let inputs =
            vec![report::register("fragment.a", alpha), crate::trace::byte("alpha_test.reference", test.reference)];
        observer.step(
            crate::trace::Step::plain("alpha test", "ROP-1", "alpha_test.passed", passed)
                .by(compare_operation(test.function), inputs)
                .note(if passed { "passes" } else { "fails: the fragment is dropped" }.to_string()),
        );
    }
    passed
}

/// Returns the operation that traces show for a comparison.
pub(crate) fn compare_operation(function: crate::state::CompareFunction) -> &'static str {
    use crate::state::CompareFunction;
    match function {
        CompareFunction::Never => "never",
        CompareFunction::Less => "less",
        CompareFunction::Equal => "equal",
        CompareFunction::LessOrEqual => "less_or_equal",
        CompareFunction::Greater => "greater",
        CompareFunction::NotEqual => "not_equal",
        CompareFunction::GreaterOrEqual => "greater_or_equal",
        CompareFunction::Always => "always",
    }
}

fn report_channel<L: Lane, O: Observer>(
    blend: &Blend,
    channel: usize,
    source: &[L; 4],
    destination: &[L; 4],
    constant: &[L; 4],
    &BlendValues { factors, raw, blended: out }: &BlendValues<L>,
    observer: &mut O,
) {
    let suffix = channel_name(channel);
    let mut operands: Vec<Operand> = vec![
        report::register(format!("source.{suffix}"), source[channel]),
        report::register(format!("destination.{suffix}"), destination[channel]),
    ];
    if matches!(blend.equation, BlendEquation::Add | BlendEquation::Subtract | BlendEquation::ReverseSubtract) {
        for (name, kind, value) in [("Fs", blend.source, factors[0]), ("Fd", blend.destination, factors[1])] {
            let (operation, inputs) = factor_operation(kind, channel, source, destination, constant);
            let name = format!("blend.{name}.{suffix}");
            operands.push(observer.tell(report::register_step(BLOCK, "ROP-4", name, value).by(operation, inputs)));
        }
    }
    let (rule, operation) = match blend.equation {
        BlendEquation::Add => ("ROP-2", "blend_add"),
        BlendEquation::Subtract => ("ROP-2", "blend_subtract"),
        BlendEquation::ReverseSubtract => ("ROP-2", "blend_reverse_subtract"),
        BlendEquation::Min => ("ROP-2", "minimum"),
        BlendEquation::Max => ("ROP-2", "maximum"),
        BlendEquation::SignedAdd => ("ROP-3", "signed_add"),
        BlendEquation::SignedReverseSubtract => ("ROP-3", "signed_reverse_subtract"),
    };
    let clamped = (raw.observe().0 != out.observe().0).then(|| "clamped".to_string());
    let name = format!("blend.raw.{suffix}");
    let inputs = vec![observer.tell(report::register_step(BLOCK, rule, name, raw).by(operation, operands))];
    let step = report::register_step(BLOCK, rule, format!("blend.{suffix}"), out);
    observer.step(step.by("clamp_0_255", inputs).note(clamped));
}

fn factor_operation<L: Lane>(
    kind: BlendFactor,
    channel: usize,
    source: &[L; 4],
    destination: &[L; 4],
    constant: &[L; 4],
) -> (&'static str, Vec<Operand>) {
    let operand = |from: &str, values: &[L; 4], channel: usize| {
        vec![report::register(format!("{from}.{}", channel_name(channel)), values[channel])]
    };
    let (from, values) = match kind {
        BlendFactor::Zero => return ("constant_0", Vec::new()),
        BlendFactor::One => return ("constant_255", Vec::new()),
        BlendFactor::SourceAlphaSaturate if channel == 3 => return ("constant_255", Vec::new()),
        BlendFactor::SourceAlphaSaturate => {
            let mut inputs = operand("source", source, 3);
            inputs.extend(operand("destination", destination, 3));
            return ("saturate_factor", inputs);
        }
        BlendFactor::SourceColor
        | BlendFactor::OneMinusSourceColor
        | BlendFactor::SourceAlpha
        | BlendFactor::OneMinusSourceAlpha => ("source", source),
        BlendFactor::DestinationAlpha
        | BlendFactor::OneMinusDestinationAlpha
        | BlendFactor::DestinationColor
        | BlendFactor::OneMinusDestinationColor => ("destination", destination),
        BlendFactor::ConstantColor
        | BlendFactor::OneMinusConstantColor
        | BlendFactor::ConstantAlpha
        | BlendFactor::OneMinusConstantAlpha => ("blend_constant", constant),
    };
    let (operation, channel) = match kind {
        BlendFactor::SourceColor | BlendFactor::DestinationColor | BlendFactor::ConstantColor => ("copy", channel),
        BlendFactor::OneMinusSourceColor
        | BlendFactor::OneMinusDestinationColor
        | BlendFactor::OneMinusConstantColor => ("invert_255", channel),
        BlendFactor::SourceAlpha | BlendFactor::DestinationAlpha | BlendFactor::ConstantAlpha => ("copy", 3),
        _ => ("invert_255", 3),
    };
    (operation, operand(from, values, channel))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Silent;

    fn blend(
        equation: BlendEquation,
        source: BlendFactor,
        destination: BlendFactor,
        s: [i32; 4],
        d: [i32; 4],
    ) -> [i32; 4] {
        run(&Blend { equation, source, destination }, 15, [0x55; 4], &s, &d, &mut Silent)
    }

    /// The captured rule: one rounding after the sum, for every source byte and alpha.
    #[test]
    fn add_rounds_once() {
        for s in 0..=255 {
            for a in 0..=255 {
                for d in [0, 37, 128, 255] {
                    let n: i32 = s * a + d * (255 - a);
                    let got = blend(
                        BlendEquation::Add,
                        BlendFactor::SourceAlpha,
                        BlendFactor::OneMinusSourceAlpha,
                        [s, s, s, a],
                        [d; 4],
                    );
                    assert_eq!(got[0], (2 * n + 255).div_euclid(510));
                }
            }
        }
    }

    #[test]
    fn captured_rows() {
        // One captured row each of Blend_tests and Texture_signed_component_tests.
        assert_eq!(blend(BlendEquation::SignedAdd, BlendFactor::Zero, BlendFactor::Zero, [200; 4], [127; 4])[0], 71);
        assert_eq!(
            blend(BlendEquation::SignedReverseSubtract, BlendFactor::Zero, BlendFactor::Zero, [200; 4], [127; 4])[0],
            183
        );
        assert_eq!(blend(BlendEquation::Subtract, BlendFactor::One, BlendFactor::One, [10; 4], [20; 4]), [0; 4]);
        let saturate = blend(
            BlendEquation::Add,
            BlendFactor::SourceAlphaSaturate,
            BlendFactor::Zero,
            [255, 255, 255, 100],
            [0, 0, 0, 200],
        );
        assert_eq!(saturate, [55, 55, 55, 100]);
    }
}
