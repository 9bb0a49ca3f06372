//! Computes raster operations and surfaces: ROP-1 to ROP-6.

use super::real::rnd255;
use ninebit::state::{BlendEquation, BlendFactor, Draw, StencilOperation, SurfaceFormat};

/// ROP-5: returns the word that a surface stores for a colour (bytes R, G, B, A).
pub fn store(format: SurfaceFormat, [r, g, b, a]: [i128; 4]) -> u32 {
    let rgb = r << 16 | g << 8 | b;
    let word = match format {
        SurfaceFormat::A8R8G8B8 => a << 24 | rgb,
        SurfaceFormat::X8R8G8B8Z => rgb,
        SurfaceFormat::X8R8G8B8O => 0xff00_0000 | rgb,
        SurfaceFormat::R5G6B5 => r >> 3 << 11 | g >> 2 << 5 | b >> 3,
        SurfaceFormat::X1R5G5B5Z => r >> 3 << 10 | g >> 3 << 5 | b >> 3,
        SurfaceFormat::X1R5G5B5O => 0x8000 | r >> 3 << 10 | g >> 3 << 5 | b >> 3,
        SurfaceFormat::X1A7R8G8B8Z => a >> 1 << 24 | rgb,
        SurfaceFormat::X1A7R8G8B8O => 0x8000_0000 | a >> 1 << 24 | rgb,
        SurfaceFormat::B8 => b,
        SurfaceFormat::G8B8 => g << 8 | b,
    };
    u32::try_from(word).unwrap()
}

/// ROP-6: returns the masks of R, G, B and A in a word. Unused bits belong to A.
fn channel_bits(format: SurfaceFormat) -> [u32; 4] {
    match format {
        SurfaceFormat::A8R8G8B8
        | SurfaceFormat::X8R8G8B8Z
        | SurfaceFormat::X8R8G8B8O
        | SurfaceFormat::X1A7R8G8B8Z
        | SurfaceFormat::X1A7R8G8B8O => [0xff_0000, 0xff00, 0xff, 0xff00_0000],
        SurfaceFormat::R5G6B5 => [0xf800, 0x07e0, 0x001f, 0],
        SurfaceFormat::X1R5G5B5Z | SurfaceFormat::X1R5G5B5O => [0x7c00, 0x03e0, 0x001f, 0x8000],
        SurfaceFormat::B8 => [0, 0, 0xff, 0],
        SurfaceFormat::G8B8 => [0, 0xff00, 0xff, 0],
    }
}

/// ROP-5: returns what a blend reads from a stored word. On 16-bit surfaces the low bits are 0.
fn load(format: SurfaceFormat, word: u32) -> [i128; 4] {
    let field = |at: u32, bits: u32| i128::from(word >> at & ((1 << bits) - 1)) << (8 - bits);
    match format {
        SurfaceFormat::A8R8G8B8 => [field(16, 8), field(8, 8), field(0, 8), field(24, 8)],
        SurfaceFormat::X8R8G8B8Z | SurfaceFormat::X8R8G8B8O => [field(16, 8), field(8, 8), field(0, 8), 255],
        SurfaceFormat::X1A7R8G8B8Z | SurfaceFormat::X1A7R8G8B8O => {
            let a = i128::from(word >> 24 & 127);
            [field(16, 8), field(8, 8), field(0, 8), a << 1 | a >> 6]
        }
        SurfaceFormat::R5G6B5 => [field(11, 5), field(5, 6), field(0, 5), 255],
        SurfaceFormat::X1R5G5B5Z | SurfaceFormat::X1R5G5B5O => [field(10, 5), field(5, 5), field(0, 5), 255],
        SurfaceFormat::B8 | SurfaceFormat::G8B8 => [0; 4],
    }
}

/// ROP-5: returns the source as a blend reads it.
fn truncate(format: SurfaceFormat, [r, g, b, a]: [i128; 4]) -> [i128; 4] {
    match format {
        SurfaceFormat::R5G6B5 => [r & 0xf8, g & 0xfc, b & 0xf8, a],
        SurfaceFormat::X1R5G5B5Z | SurfaceFormat::X1R5G5B5O => [r & 0xf8, g & 0xf8, b & 0xf8, a],
        _ => [r, g, b, a],
    }
}

/// ROP-4: returns a blend factor for channel `c`.
fn factor(f: BlendFactor, c: usize, s: [i128; 4], d: [i128; 4], constant: [u8; 4]) -> i128 {
    let constant = constant.map(i128::from);
    match f {
        BlendFactor::Zero => 0,
        BlendFactor::One => 255,
        BlendFactor::SourceColor => s[c],
        BlendFactor::OneMinusSourceColor => 255 - s[c],
        BlendFactor::SourceAlpha => s[3],
        BlendFactor::OneMinusSourceAlpha => 255 - s[3],
        BlendFactor::DestinationAlpha => d[3],
        BlendFactor::OneMinusDestinationAlpha => 255 - d[3],
        BlendFactor::DestinationColor => d[c],
        BlendFactor::OneMinusDestinationColor => 255 - d[c],
        BlendFactor::SourceAlphaSaturate if c == 3 => 255,
        BlendFactor::SourceAlphaSaturate => s[3].min(255 - d[3]),
        BlendFactor::ConstantColor => constant[c],
        BlendFactor::OneMinusConstantColor => 255 - constant[c],
        BlendFactor::ConstantAlpha => constant[3],
        BlendFactor::OneMinusConstantAlpha => 255 - constant[3],
    }
}

/// ROP-2 to ROP-6: returns the new word of a pixel.
pub fn write(draw: &Draw, format: SurfaceFormat, old: u32, color: [i128; 4]) -> u32 {
    let mut out = color;
    let blends = !matches!(format, SurfaceFormat::B8 | SurfaceFormat::G8B8);
    if let (Some(blend), true) = (&draw.blend, blends) {
        let (s, d) = (truncate(format, color), load(format, old));
        for c in 0..4 {
            let source = s[c] * factor(blend.source, c, s, d, draw.blend_constant);
            let destination = d[c] * factor(blend.destination, c, s, d, draw.blend_constant);
            let s8 = if s[c] >= 128 { s[c] - 256 } else { s[c] };
            let value = match blend.equation {
                BlendEquation::Add => rnd255(source + destination),
                BlendEquation::Subtract => rnd255(source - destination),
                BlendEquation::ReverseSubtract => rnd255(destination - source),
                BlendEquation::Min => s[c].min(d[c]),
                BlendEquation::Max => s[c].max(d[c]),
                BlendEquation::SignedAdd => d[c] + s8,
                BlendEquation::SignedReverseSubtract => d[c] - s8,
            };
            out[c] = value.clamp(0, 255);
        }
    }
    let bits = channel_bits(format);
    let mask = (0..4).filter(|c| draw.color_mask[*c]).fold(0, |m, c| m | bits[c]);
    store(format, out) & mask | old & !mask
}

/// STN-1, DEP-2: returns whether a fragment passes both tests. `stencil` and `depth` are the stored values, which are updated.
pub fn stencil_and_depth(draw: &Draw, incoming: u32, stencil: &mut u32, depth: &mut u32) -> bool {
    let before = *stencil;
    // For each set bit of the write mask, the bit of the result is stored.
    let mut store = |operation: StencilOperation, reference: u32, mask: u32| {
        let new = match operation {
            StencilOperation::Keep => before,
            StencilOperation::Zero => 0,
            StencilOperation::Replace => reference,
            StencilOperation::IncrementSaturate => (before + 1).min(255),
            StencilOperation::DecrementSaturate => before.max(1) - 1,
            StencilOperation::Invert => 255 - before,
            StencilOperation::Increment => (before + 1) % 256,
            StencilOperation::Decrement => (before + 255) % 256,
        };
        *stencil = (0..8).map(|bit| (if mask >> bit & 1 == 1 { new } else { before }) & 1 << bit).sum();
    };
    if let Some(test) = draw.stencil_test {
        let (reference, mask) = (u32::from(test.reference), u32::from(test.mask));
        if !test.function.passes(reference & mask, before & mask) {
            store(test.fail, reference, test.write_mask.into());
            return false;
        }
    }
    let passed = match draw.depth_test {
        None => true,
        Some(test) => {
            let passed = test.function.passes(incoming, *depth);
            if passed && test.write {
                *depth = incoming;
            }
            passed
        }
    };
    if let Some(test) = draw.stencil_test {
        let operation = if passed { test.pass } else { test.depth_fail };
        store(operation, test.reference.into(), test.write_mask.into());
    }
    passed
}
