//! Constant folding: facts that hold for every pixel of a draw, from the state alone. Nothing here depends on a policy.

use crate::algebra::{Algebra, Trail};
use crate::combiner::registers::{bit, bits, initially_undefined};
use crate::rop::{blend, surface};
use crate::state::*;
use crate::texture::format::expand;

/// Returns whether blending yields the source, and whether it yields the destination, in all of the `written` channels.
/// `zero` are the channels of the source that are 0.
pub(super) fn blend(blend: &Blend, blend_constant: [u8; 4], written: u8, zero: u8) -> (bool, bool) {
    let mut trail = Trail::folding();
    let source = [0, 1, 2, 3].map(|channel: u8| trail.input((zero >> channel & 1 != 0).then_some(0)));
    let destination = [0; 4].map(|_: u8| trail.input(None));
    let constant = blend_constant.map(|byte| trail.byte(byte));
    let stored = blend::blend(blend, written, &constant, &source, &destination, &mut trail);
    let all = |of: [_; 4]| (0..4).filter(|c| written >> c & 1 != 0).all(|c| stored[c] == of[c]);
    (all(source), all(destination))
}

/// Returns whether the contents of a target have unused bits that a store would change. Even a draw that keeps every
/// channel writes those.
pub(super) fn begins_with_stray_bits(target: &Target) -> bool {
    let stored = |word: u32| surface::pack(target.format, surface::read(target.format, word));
    target.contents.as_ref().is_some_and(|words| words.iter().any(|word| stored(*word) != *word))
}

/// Returns the channels of a texture that are 0 in every texel, as bits R, G, B, A. Compressed and palette textures,
/// and those of 16-bit halves, are not examined.
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

/// Returns the registers that are 0 in every pixel before the first stage, as bits of registers and channels.
pub(super) fn initially_zero(draw: &Draw, black: &[u8]) -> u64 {
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
        // TEX-16, and the results of stages without a texture.
        let units = [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3];
        for (register, (unit, stage)) in units.into_iter().zip(draw.textures.iter().zip(&draw.texture_shader)) {
            // Filtering zeros yields zero, whichever texels are read.
            let sampled = |unit: &TextureUnit| {
                let inside = [AddressMode::Wrap, AddressMode::Mirror, AddressMode::ClampToEdge];
                let bordered = [unit.address_s, unit.address_t].iter().any(|mode| !inside.contains(mode));
                let black = black.get(unit.texture).is_some_and(|black| black >> channel & 1 != 0);
                black && !unit.signed.contains(&true) && (!bordered || unit.border_color[channel] == 0)
            };
            let black = match stage.operation {
                operation if operation.samples_own() && unit.as_ref().is_some_and(sampled) => true,
                ShaderOperation::PassThrough => false,
                ShaderOperation::None | ShaderOperation::CullFragment { .. } => channel < 3,
                ShaderOperation::DotProduct => true,
                _ => unit.is_none() && channel < 3,
            };
            // What is converted (TEX-19) is not examined.
            if black && !(draw.convert_yuv && channel < 3) {
                zero |= bit(register, channel);
            }
        }
        if channel < 3 && draw.fog.color[channel] == 0 {
            zero |= bit(Register::Fog, channel);
        }
    }
    zero
}
