//! Words of the texture units, the texture shader and the combiners.

use ninebit::plan::texture_size;
use ninebit::state::{
    ColorKeyMode, Draw, Filter, Scene, ShaderOperation, ShadowReference, Texture, TextureImage, TextureKind,
    TextureUnit,
};
use ninebit_program::registers::{color_word, encode};

use super::memory::{MemoryMap, pitch};
use super::state::code;
use super::{ExportError, Words, refuse};
use crate::celsius;
use crate::class::{self, Family, STAGE_CUBE, STAGE_THREE, STAGE_TWO, of_unit};
use crate::draw::shader::DOT_MAPPINGS;
use crate::draw::texture::{ADDRESS_MODES, FORMATS, MIN_FILTERS, SHADOW_FUNCTIONS};

/// Sets the units, the shader and the combiners of a draw.
pub(super) fn units(words: &mut Words, scene: &Scene, placed: &MemoryMap, draw: &Draw) -> Result<(), ExportError> {
    let (mut programs, mut mappings, mut inputs, mut culls) = (0, 0, 0, 0);
    for index in 0..scene.profile.texture_units() {
        let stage = &draw.texture_shader[index];
        let unit = draw.textures[index].as_ref().filter(|_| stage.operation.samples());
        words.set(of_unit(class::SET_TEXTURE_CONTROL0, index), unit.map_or(0, control));
        if let Some(unit) = unit {
            self::unit(words, scene, placed, (index, unit))?;
        }
        let kind = unit.map(|unit| (scene.textures[unit.texture].kind, unit.shadow));
        programs |= operation(words, index, &stage.operation, kind) << (5 * index);
        if stage.operation.reads_previous() && index > 1 {
            inputs |= (stage.previous as u32) << (8 + 4 * index);
        }
        if stage.operation.is_dot() && index > 0 {
            mappings |= code(&DOT_MAPPINGS, stage.mapping) << (4 * (index - 1));
        }
        if let ShaderOperation::CullFragment { drops_not_negative } = stage.operation {
            let bits = (0..4).filter(|n| drops_not_negative[*n]).map(|n| 1 << n).sum::<u32>();
            culls |= bits << (4 * index);
        }
    }
    if words.family == Family::Celsius {
        // What samples and how is said by the units.
        combiners(words, scene, draw);
        return Ok(());
    }
    words.set(class::SET_SHADER_STAGE_PROGRAM, programs);
    words.set(class::SET_DOT_RGBMAPPING, mappings);
    words.set(class::SET_SHADER_OTHER_STAGE_INPUT, inputs);
    words.set(class::SET_SHADER_CLIP_PLANE_MODE, culls);
    combiners(words, scene, draw);
    Ok(())
}

fn combiners(words: &mut Words, scene: &Scene, draw: &Draw) {
    for (word, index, value) in encode(&draw.combiners, scene.profile).all() {
        words.own(word.method(scene.profile) + 4 * index as u32, value);
    }
}

/// Returns the code of an operation, and sets its words.
fn operation(
    words: &mut Words,
    index: usize,
    operation: &ShaderOperation,
    kind: Option<(TextureKind, Option<ninebit::state::ShadowComparison>)>,
) -> u32 {
    use ShaderOperation as Op;
    match operation {
        Op::None => 0,
        Op::Sample => match kind {
            None => 0,
            Some((TextureKind::Cube, _)) => STAGE_CUBE,
            Some((TextureKind::ThreeDimensional, _)) => STAGE_THREE,
            Some((_, Some(shadow))) if shadow.reference == ShadowReference::R => STAGE_THREE,
            _ => STAGE_TWO,
        },
        Op::PassThrough => 4,
        Op::CullFragment { .. } => 5,
        Op::BumpEnvironment { matrix, luminance } => {
            for (n, number) in (0..).zip(matrix) {
                words.number(of_unit(class::SET_TEXTURE_SET_BUMP_ENV_MAT, index) + 4 * n, *number);
            }
            let Some([scale, offset]) = luminance else { return 6 };
            words.number(of_unit(class::SET_TEXTURE_SET_BUMP_ENV_SCALE, index), *scale);
            words.number(of_unit(class::SET_TEXTURE_SET_BUMP_ENV_OFFSET, index), *offset);
            7
        }
        Op::DotProduct2D => 9,
        Op::DotReflectDiffuse => 0xb,
        Op::DotReflectSpecular => 0xc,
        Op::DotProductCube => 0xe,
        Op::DependentAlphaRed => 0xf,
        Op::DependentGreenBlue => 0x10,
        Op::DotProduct => 0x11,
        Op::DotReflectConstantEye { eye } => {
            for (n, number) in (0..).zip(eye) {
                words.number(class::SET_EYE_VECTOR + 4 * n, *number);
            }
            0x12
        }
    }
}

/// Returns SET_TEXTURE_CONTROL0 of a unit that samples.
fn control(unit: &TextureUnit) -> u32 {
    let key = unit.color_key.map_or(0, |key| match key.mode {
        ColorKeyMode::Alpha => 1,
        ColorKeyMode::Color => 2,
        ColorKeyMode::Texel => 3,
    });
    1 << 30
        | (unit.min_lod as u32 & 0xfff) << 18
        | (unit.max_lod as u32 & 0xfff) << 6
        | unit.anisotropy.ilog2() << 4
        | key
}

/// Sets the words of a unit that samples.
fn unit(
    words: &mut Words,
    scene: &Scene,
    placed: &MemoryMap,
    (index, unit): (usize, &TextureUnit),
) -> Result<(), ExportError> {
    let texture = &scene.textures[unit.texture];
    let celsius = words.family == Family::Celsius;
    let mut set = |method, word| words.set(of_unit(method, index), word);
    let linear = texture.kind == TextureKind::Rectangle;
    set(class::SET_TEXTURE_OFFSET, placed.textures[unit.texture]);
    let format = format(scene, texture, unit.texture)?;
    if linear {
        let (width, height) = texture_size(scene, unit.texture);
        let pitch = match texture.image.target() {
            Some(target) => {
                let state = &scene.targets[target];
                let depth = matches!(texture.image, TextureImage::Depth { .. });
                pitch(state.width, if depth { texture.format.bytes() } else { state.format.bytes() })
            }
            None => pitch(width, texture.format.bytes()),
        };
        if pitch > 0xffff {
            return refuse(format!("rows of texture `{}` are too long for SET_TEXTURE_CONTROL1", texture.name));
        }
        set(class::SET_TEXTURE_CONTROL1, pitch << 16);
        set(class::SET_TEXTURE_IMAGE_RECT, width << 16 | height);
    }
    let [s, t, r] = [unit.address_s, unit.address_t, unit.address_r].map(|mode| code(&ADDRESS_MODES, mode));
    let [wrap_s, wrap_t] = unit.cylindrical_wrap.map(u32::from);
    let address = s | wrap_s << 4 | t << 8 | wrap_t << 12 | r << 16;
    if celsius {
        let Some(word) = celsius::texture_format(format, address) else {
            return refuse(format!("texture `{}` has a format that GeForce 256 does not have", texture.name));
        };
        set(class::SET_TEXTURE_FORMAT, word);
    } else {
        set(class::SET_TEXTURE_FORMAT, format);
        set(class::SET_TEXTURE_ADDRESS, address);
    }
    let signs: u32 = [29, 30, 31, 28].into_iter().zip(unit.signed).map(|(bit, signed)| u32::from(signed) << bit).sum();
    let min = code(&MIN_FILTERS, (unit.min_filter, unit.mip_filter));
    let mag = if unit.mag_filter == Filter::Linear { 2 } else { 1 };
    set(class::SET_TEXTURE_FILTER, signs | mag << 24 | min << 16 | 1 << 13 | unit.lod_bias as u32 & 0x1fff);
    if !celsius || unit.border_color != [0; 4] {
        set(class::SET_TEXTURE_BORDER_COLOR, color_word(unit.border_color));
    }
    if let Some(palette) = unit.palette {
        let length = match scene.palettes[palette].entries.len() {
            256 => 0,
            128 => 1,
            64 => 2,
            _ => 3,
        };
        set(class::SET_TEXTURE_PALETTE, placed.palettes[palette] | length << 2);
    }
    if let Some(key) = unit.color_key {
        words.set(class::SET_COLOR_KEY_COLOR + 4 * index as u32, color_word(key.color));
    }
    if let Some(shadow) = unit.shadow {
        words.set(class::SET_SHADOW_COMPARE_FUNC, code(&SHADOW_FUNCTIONS, shadow.function));
    }
    Ok(())
}

/// Returns SET_TEXTURE_FORMAT of a texture.
fn format(scene: &Scene, texture: &Texture, index: usize) -> Result<u32, ExportError> {
    let linear = texture.kind == TextureKind::Rectangle;
    let found = FORMATS.iter().find(|(_, format, with_pitch)| *format == texture.format && *with_pitch == linear);
    let Some((code, ..)) = found else {
        return refuse(format!("texture `{}` has a format without a code for its kind", texture.name));
    };
    let dimensions = if texture.kind == TextureKind::ThreeDimensional { 3 } else { 2 };
    let mut word = 1 | dimensions << 4 | code << 8 | u32::from(texture.kind == TextureKind::Cube) << 2;
    let (levels, layers, border) = match &texture.image {
        TextureImage::Texels(texels) => (texels.levels, texels.layers, texels.border),
        _ => (1, 1, false),
    };
    word |= u32::from(!border) << 3 | levels << 16;
    if !linear {
        let (width, height) = texture_size(scene, index);
        word |= width.ilog2() << 20 | height.ilog2() << 24 | layers.ilog2() << 28;
    }
    Ok(word)
}
