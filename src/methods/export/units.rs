//! Words of the texture units, the texture shader and the combiners.

use ninebit::plan::texture_size;
use ninebit::state::{Draw, Scene, ShaderOperation, ShadowReference, Texture, TextureImage, TextureKind, TextureUnit};
use ninebit_program::registers::unit::*;
use ninebit_program::registers::{color_word, encode};

use super::memory::{MemoryMap, pitch};
use super::state::code;
use super::{ExportError, Words, refuse};
use crate::celsius;
use crate::class::{self, Family, of_unit};

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
        programs |= operation(words, index, &stage.operation, kind) << (STAGE_BITS * index as u32);
        if stage.operation.reads_previous() && index > 1 {
            inputs |= PREVIOUS[index - 2].put(stage.previous as u32);
        }
        if stage.operation.is_dot() && index > 0 {
            mappings |= code(&DOT_MAPPINGS, stage.mapping) << (MAPPING_BITS * (index as u32 - 1));
        }
        if let ShaderOperation::CullFragment { drops_not_negative } = stage.operation {
            let bits = (0..4).filter(|n| drops_not_negative[*n]).map(|n| 1 << n).sum::<u32>();
            culls |= bits << (CLIP_BITS * index as u32);
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
        Op::Sample2D => STAGE_TWO,
        Op::SampleCube => STAGE_CUBE,
        Op::PassThrough => STAGE_PASS_THROUGH,
        Op::CullFragment { .. } => STAGE_CULL,
        Op::BumpEnvironment { matrix, luminance } => {
            for (n, number) in (0..).zip(matrix) {
                words.number(of_unit(class::SET_TEXTURE_SET_BUMP_ENV_MAT, index) + 4 * n, *number);
            }
            let Some([scale, offset]) = luminance else { return STAGE_BUMP };
            words.number(of_unit(class::SET_TEXTURE_SET_BUMP_ENV_SCALE, index), *scale);
            words.number(of_unit(class::SET_TEXTURE_SET_BUMP_ENV_OFFSET, index), *offset);
            STAGE_BUMP_LUMINANCE
        }
        Op::DotProduct2D => STAGE_DOT_2D,
        Op::DotReflectDiffuse => STAGE_REFLECT_DIFFUSE,
        Op::DotReflectSpecular => STAGE_REFLECT_SPECULAR,
        Op::DotProduct3D => STAGE_DOT_3D,
        Op::DotProductCube => STAGE_DOT_CUBE,
        Op::DependentAlphaRed => STAGE_ALPHA_RED,
        Op::DependentGreenBlue => STAGE_GREEN_BLUE,
        Op::DotProduct => STAGE_DOT,
        Op::DotReflectConstantEye { eye } => {
            for (n, number) in (0..).zip(eye) {
                words.number(class::SET_EYE_VECTOR + 4 * n, *number);
            }
            STAGE_REFLECT_CONSTANT
        }
    }
}

/// Returns SET_TEXTURE_CONTROL0 of a unit that samples.
fn control(unit: &TextureUnit) -> u32 {
    let key = unit.color_key.map_or(0, |key| code(&COLOR_KEYS, key.mode));
    ENABLE.put(1)
        | MIN_LOD.put(unit.min_lod as u32)
        | MAX_LOD.put(unit.max_lod as u32)
        | ANISOTROPY.put(unit.anisotropy.ilog2())
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
        set(class::SET_TEXTURE_IMAGE_RECT, RECTANGLE[0].put(width) | RECTANGLE[1].put(height));
    }
    let [s, t, r] = [unit.address_s, unit.address_t, unit.address_r].map(|mode| code(&ADDRESS_MODES, mode));
    let [wrap_s, wrap_t] = unit.cylindrical_wrap.map(u32::from);
    let address = MODES[0].put(s) | wrap_s << 4 | MODES[1].put(t) | wrap_t << 12 | MODES[2].put(r);
    if celsius {
        let Some(word) = celsius::texture_format(format, address) else {
            return refuse(format!("texture `{}` has a format that GeForce 256 does not have", texture.name));
        };
        set(class::SET_TEXTURE_FORMAT, word);
    } else {
        set(class::SET_TEXTURE_FORMAT, format);
        set(class::SET_TEXTURE_ADDRESS, address);
    }
    let signs: u32 = SIGNED.into_iter().zip(unit.signed).map(|(field, signed)| field.put(signed.into())).sum();
    let min = code(&MIN_FILTERS, (unit.min_filter, unit.mip_filter));
    let mag = code(&MAG_FILTERS, unit.mag_filter);
    let filters = MAG_FILTER.put(mag) | MIN_FILTER.put(min) | LOD_BIAS.put(unit.lod_bias as u32);
    set(class::SET_TEXTURE_FILTER, signs | filters | 1 << 13);
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
    let mut word =
        1 | DIMENSIONS.put(dimensions) | FORMAT.put(*code) | CUBE.put((texture.kind == TextureKind::Cube).into());
    let (levels, layers, border) = match &texture.image {
        TextureImage::Texels(texels) => (texels.levels, texels.layers, texels.border),
        _ => (1, 1, false),
    };
    word |= BORDER_COLOR.put((!border).into()) | LEVELS.put(levels);
    if !linear {
        let (width, height) = texture_size(scene, index);
        let logs = SIZES.into_iter().zip([width, height, layers]);
        word |= logs.map(|(field, side)| field.put(side.ilog2())).sum::<u32>();
    }
    Ok(word)
}
