//! Constant folding: what the state alone settles for every pixel of a draw. Nothing here depends on a policy.

use crate::combiner::final_combiner;
use crate::combiner::general::source_channel;
use crate::combiner::registers::{bit, bits, initially_undefined};
use crate::state::{
    AddressMode, Bias, Blend, BlendEquation, BlendFactor, CombinerInput, Component, Draw, FinalInput, FinalRegister,
    GeneralStage, InputMapping, Portion, Register, ShaderOperation, Texture, TextureFormat, TextureImage, TextureUnit,
    VertexColor, Vertices,
};
use crate::texture::format::expand;

/// The factor's byte, if it is the same for every pixel and every one of the channels.
fn constant(factor: BlendFactor, constant: [u8; 4], channels: u8) -> Option<u8> {
    let color = |invert: bool| {
        let mut bytes = (0..4).filter(|n| channels >> n & 1 != 0).map(|n| constant[n] ^ if invert { 255 } else { 0 });
        let first = bytes.next()?;
        bytes.all(|byte| byte == first).then_some(first)
    };
    match factor {
        BlendFactor::Zero => Some(0),
        BlendFactor::One => Some(255),
        BlendFactor::ConstantColor => color(false),
        BlendFactor::OneMinusConstantColor => color(true),
        BlendFactor::ConstantAlpha => Some(constant[3]),
        BlendFactor::OneMinusConstantAlpha => Some(255 - constant[3]),
        _ => None,
    }
}

/// Whether the blend yields its source: S 1 + D 0, where rounding gives S back.
pub(super) fn replaces(blend: &Blend, blend_constant: [u8; 4], channels: u8) -> bool {
    let factor = |f| constant(f, blend_constant, channels);
    blend.equation == BlendEquation::Add && factor(blend.source) == Some(255) && factor(blend.destination) == Some(0)
}

/// Whether the blend yields its destination; `zero` says that the source is 0 in every channel that is written.
pub(super) fn keeps(blend: &Blend, blend_constant: [u8; 4], channels: u8, zero: bool) -> bool {
    let factor = |f| constant(f, blend_constant, channels);
    let nothing = zero || factor(blend.source) == Some(0);
    match blend.equation {
        BlendEquation::Add | BlendEquation::ReverseSubtract => {
            let whole = zero && blend.destination == BlendFactor::OneMinusSourceColor;
            nothing && (whole || factor(blend.destination) == Some(255))
        }
        BlendEquation::SignedAdd | BlendEquation::SignedReverseSubtract | BlendEquation::Max => zero,
        BlendEquation::Subtract | BlendEquation::Min => false,
    }
}

/// Channels of a texture that are 0 in every texel, bits R, G, B, A. None of blocks, indices and halves of sixteen bits is looked into.
pub(super) fn black_channels(texture: &Texture) -> u8 {
    let TextureImage::Texels(texels) = &texture.image else { return 0 };
    let format = texture.format;
    if format.is_compressed() || matches!(format, TextureFormat::P8 | TextureFormat::R16B16 | TextureFormat::Y16) {
        return 0;
    }
    let mut black = 15;
    for word in texels.words.iter() {
        let shown = expand(format, *word);
        black &= (0..4).filter(|n| shown[*n] == 0).fold(0, |bits, n| bits | 1 << n);
        if black == 0 {
            break;
        }
    }
    black
}

/// Channels of the fragment that are 0 whatever the pixel, bits R, G, B, A. `black` are the textures' [`black_channels`].
pub(super) fn zero_fragment(draw: &Draw, black: &[u8]) -> u8 {
    let mut zero = initially_zero(draw, black);
    for stage in &draw.combiners.stages {
        zero = after_stage(stage, with_constants(zero, stage.constants));
    }
    let state = &draw.combiners.final_combiner;
    let zero = with_constants(zero, state.constants);
    let plain = |input: &FinalInput, channel: usize| {
        let source = match input.component {
            Component::Rgb => channel,
            Component::Blue => 2,
            Component::Alpha => 3,
        };
        match input.register {
            FinalRegister::Spare0PlusSecondary if source < 3 => {
                let term = |register, invert: bool| !invert && zero & bit(register, source) != 0;
                term(Register::Spare0, state.invert_spare0) && term(Register::SecondaryColor, state.invert_secondary)
            }
            FinalRegister::ETimesF if source < 3 => state.inputs[4..].iter().any(|input| {
                let source = if input.component == Component::Rgb { source } else { 3 };
                !input.invert && zero & bit(final_combiner::general(input.register), source) != 0
            }),
            FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF => true,
            register => zero & bit(final_combiner::general(register), source) != 0,
        }
    };
    let is_zero = |input: &FinalInput, channel: usize| !input.invert && plain(input, channel);
    // ZERO inverted.
    let is_one = |input: &FinalInput| input.invert && input.register == FinalRegister::Zero;
    let [a, b, c, d, ..] = &state.inputs;
    let mut fragment = 0;
    for channel in 0..3 {
        let ab = is_zero(a, channel) || is_zero(b, channel);
        let ac = is_one(a) || is_zero(c, channel);
        if ab && ac && is_zero(d, channel) {
            fragment |= 1 << channel;
        }
    }
    fragment | if is_zero(&state.g, 3) { 8 } else { 0 }
}

/// Registers that hold 0 in every pixel before the first stage, as bits of registers and channels.
fn initially_zero(draw: &Draw, black: &[u8]) -> u64 {
    let mut zero = bits(Register::Zero) | initially_undefined();
    let colors = |color: fn(&Vertices, usize) -> VertexColor, channel: usize| {
        (0..draw.vertices.len()).all(|v| match color(&draw.vertices, v) {
            VertexColor::Bytes(bytes) => bytes[channel] == 0,
            VertexColor::Floats(floats) => floats[channel] <= 0.0,
        })
    };
    for channel in 0..4 {
        if colors(Vertices::diffuse, channel) {
            zero |= bit(Register::PrimaryColor, channel);
        }
        if colors(Vertices::specular, channel) {
            zero |= bit(Register::SecondaryColor, channel);
        }
        // TEX-16, and what stages without a texture yield.
        let units = [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3];
        for (register, (unit, stage)) in units.into_iter().zip(draw.textures.iter().zip(&draw.texture_shader)) {
            // A filter's mix of zeros is zero, whichever texels it takes.
            let sampled = |unit: &TextureUnit| {
                let inside = [AddressMode::Wrap, AddressMode::Mirror, AddressMode::ClampToEdge];
                let bordered = [unit.address_s, unit.address_t].iter().any(|mode| !inside.contains(mode));
                let black = black.get(unit.texture).is_some_and(|black| black >> channel & 1 != 0);
                black && !unit.signed.contains(&true) && (!bordered || unit.border_color[channel] == 0)
            };
            let black = match stage.operation {
                ShaderOperation::Sample if unit.as_ref().is_some_and(sampled) => true,
                ShaderOperation::PassThrough => false,
                ShaderOperation::None | ShaderOperation::CullFragment { .. } => channel < 3,
                ShaderOperation::DotProduct => true,
                _ => unit.is_none() && channel < 3,
            };
            if black {
                zero |= bit(register, channel);
            }
        }
        if channel < 3 && draw.fog.color[channel] == 0 {
            zero |= bit(Register::Fog, channel);
        }
    }
    zero
}

fn with_constants(zero: u64, constants: [[u8; 4]; 2]) -> u64 {
    let registers = [Register::ConstantColor0, Register::ConstantColor1];
    registers.into_iter().zip(constants).fold(zero, |zero, (register, bytes)| {
        (0..4).fold(zero & !bits(register), |zero, n| if bytes[n] == 0 { zero | bit(register, n) } else { zero })
    })
}

/// What is 0 after a stage.
fn after_stage(stage: &GeneralStage, before: u64) -> u64 {
    let mut after = before;
    for (portion, channels) in [(&stage.rgb, 0..3), (&stage.alpha, 3..4)] {
        let outputs = outputs(portion, before);
        let mut write = |register: Register, channel: usize, zero: bool| {
            if register != Register::Zero {
                after = if zero { after | bit(register, channel) } else { after & !bit(register, channel) };
            }
        };
        for channel in channels {
            write(portion.ab_output, channel, outputs[0](channel));
            write(portion.cd_output, channel, outputs[1](channel));
            write(portion.sum_output, channel, outputs[2](channel));
        }
        for (flag, register, n) in
            [(portion.ab_blue_to_alpha, portion.ab_output, 0), (portion.cd_blue_to_alpha, portion.cd_output, 1)]
        {
            if flag {
                write(register, 3, outputs[n](2));
            }
        }
    }
    after
}

/// Whether AB, CD and the sum or mux are 0, by channel.
fn outputs(portion: &Portion, zero: u64) -> [Box<dyn Fn(usize) -> bool + '_>; 3] {
    let factor = move |input: &CombinerInput, channel: usize| {
        let keeps_zero = matches!(
            input.mapping,
            InputMapping::UnsignedIdentity | InputMapping::SignedIdentity | InputMapping::SignedNegate
        );
        keeps_zero && zero & bit(input.register, source_channel(input, channel)) != 0
    };
    let product = move |n: usize, channel: usize| {
        let [a, b] = [&portion.inputs[2 * n], &portion.inputs[2 * n + 1]];
        let dot = if n == 0 { portion.ab_dot_product } else { portion.cd_dot_product };
        let one = |channel: usize| factor(a, channel) || factor(b, channel);
        if dot { (0..3).all(one) } else { one(channel) }
    };
    let unbiased = portion.bias == Bias::None;
    [
        Box::new(move |channel| unbiased && product(0, channel)),
        Box::new(move |channel| unbiased && product(1, channel)),
        Box::new(move |channel| unbiased && product(0, channel) && product(1, channel)),
    ]
}
