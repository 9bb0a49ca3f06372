//! Lines of textures, texture units and texture shaders.

use ninebit::state::{
    AddressMode, DotMapping, Draw, Filter, Named, Scene, ShaderOperation, Texels, Texture, TextureFormat, TextureImage,
    TextureKind, TextureUnit, depth_of,
};
use ninebit::texture::format::expand;

use super::lines::{Environment, Lines, function};

/// Adds the line of a texture.
pub(super) fn texture(lines: &mut Lines, n: usize, texture: &Texture, raw: &mut Vec<u8>) -> Result<(), String> {
    let TextureImage::Texels(texels) = &texture.image else { return Err("a target as a texture".into()) };
    let Texels { width, height, levels, border, words, .. } = texels;
    if *levels > 1 || *border || texture.format.is_compressed() || texture.format == TextureFormat::P8 {
        return Err("a texture of several levels, with a border, blocks or a palette".into());
    }
    let place = raw.len();
    if let Some(format) = texture.format.depth() {
        if texture.kind != TextureKind::TwoDimensional || format.is_float() {
            return Err("a texture of float depths".into());
        }
        let bits = format.bits();
        let bytes = |word: &u32| {
            if bits == 16 { word.to_le_bytes()[..2].to_vec() } else { (depth_of(*word) << 8).to_le_bytes().to_vec() }
        };
        lines.needs("GL_ARB_depth_texture");
        lines.needs("GL_ARB_shadow");
        lines.add(format!("depths {n} {width} {height} {bits} {place}"));
        raw.extend(words.iter().flat_map(bytes));
        return Ok(());
    }
    match texture.kind {
        TextureKind::TwoDimensional => lines.add(format!("texture {n} {width} {height} {place}")),
        TextureKind::Cube => {
            lines.needs("GL_ARB_texture_cube_map|GL_EXT_texture_cube_map");
            lines.add(format!("cube {n} {width} {place}"));
        }
        other => return Err(format!("a texture of the kind {}", other.name())),
    }
    raw.extend(words.iter().flat_map(|word| expand(texture.format, *word)));
    Ok(())
}

/// Returns whether a draw has a texture shader of its own.
pub(super) fn shades(draw: &Draw) -> bool {
    draw.texture_shader.iter().any(|stage| !matches!(stage.operation, ShaderOperation::None | ShaderOperation::Sample))
}

/// Adds the lines of a draw's texture units.
pub(super) fn units(
    lines: &mut Lines,
    scene: &Scene,
    draw: &Draw,
    environment: Option<Environment>,
) -> Result<(), String> {
    let shades = shades(draw);
    let bound: Vec<&TextureUnit> = draw.textures.iter().flatten().collect();
    let is_twice = |n: usize| bound[..n].iter().any(|other| other.texture == bound[n].texture && *other != bound[n]);
    if (0..bound.len()).any(is_twice) {
        return Err("a texture that two units read in two ways".into());
    }
    for (n, stage) in draw.texture_shader.iter().enumerate().take(scene.profile.texture_units()) {
        let unit = draw.textures[n].as_ref().filter(|_| stage.operation.samples());
        let kind = unit.map(|unit| scene.textures[unit.texture].kind);
        if let (Some(unit), false) = (unit, environment == Some(Environment::Colors) && !shades) {
            self::unit(lines, n, unit, &scene.textures[unit.texture])?;
        }
        if shades {
            shader(lines, draw, n, kind)?;
        }
    }
    Ok(())
}

fn unit(lines: &mut Lines, n: usize, unit: &TextureUnit, texture: &Texture) -> Result<(), String> {
    if unit.color_key.is_some()
        || unit.signed != [false; 4]
        || unit.min_filter != unit.mag_filter
        || unit.cylindrical_wrap != [false; 2]
    {
        return Err("a unit with a key, signs, cylindrical wrapping or two filters".into());
    }
    let filter = if unit.mag_filter == Filter::Linear { "LINEAR" } else { "NEAREST" };
    let mut wraps = Vec::new();
    for mode in [unit.address_s, unit.address_t] {
        wraps.push(match mode {
            AddressMode::Wrap => "REPEAT",
            AddressMode::ClampToEdge => "CLAMP_TO_EDGE",
            AddressMode::Mirror => {
                lines.needs("GL_ARB_texture_mirrored_repeat|GL_IBM_texture_mirrored_repeat");
                "MIRRORED_REPEAT"
            }
            _ => return Err("a border colour".into()),
        });
    }
    lines.add(format!("unit {n} {} {filter} {}", unit.texture, wraps.join(" ")));
    if unit.anisotropy > 1 {
        if texture.kind != TextureKind::TwoDimensional {
            return Err("an anisotropic filter of a cube map".into());
        }
        lines.needs("GL_EXT_texture_filter_anisotropic");
        lines.add(format!("anisotropy {n} {}", unit.anisotropy));
    }
    if let Some(shadow) = unit.shadow {
        let function = function(shadow.function);
        if !matches!(function, "LEQUAL" | "GEQUAL") {
            lines.needs("GL_EXT_shadow_funcs");
        }
        lines.add(format!("compare {n} {function}"));
    } else if texture.format.depth().is_some() {
        return Err("depths that are not compared".into());
    }
    Ok(())
}

/// Adds the lines of a stage of the texture shader.
fn shader(lines: &mut Lines, draw: &Draw, n: usize, kind: Option<TextureKind>) -> Result<(), String> {
    let stage = &draw.texture_shader[n];
    lines.needs("GL_NV_texture_shader");
    let turns = |kind| kind != TextureKind::Cube && stage.operation.takes_direction(kind);
    let operation = match stage.operation {
        _ if kind.is_some_and(turns) => return Err("a texture of another kind than its stage".into()),
        ShaderOperation::None => "NONE",
        ShaderOperation::Sample if kind == Some(TextureKind::Cube) => "TEXTURE_CUBE_MAP",
        ShaderOperation::Sample => "TEXTURE_2D",
        ShaderOperation::Sample2D | ShaderOperation::SampleCube | ShaderOperation::DotProduct3D => {
            return Err("a texture of another kind than its stage".into());
        }
        ShaderOperation::PassThrough => "PASS_THROUGH_NV",
        ShaderOperation::CullFragment { .. } => "CULL_FRAGMENT_NV",
        ShaderOperation::DependentAlphaRed => "DEPENDENT_AR_TEXTURE_2D_NV",
        ShaderOperation::DependentGreenBlue => "DEPENDENT_GB_TEXTURE_2D_NV",
        ShaderOperation::DotProduct => "DOT_PRODUCT_NV",
        ShaderOperation::DotProduct2D => "DOT_PRODUCT_TEXTURE_2D_NV",
        ShaderOperation::DotProductCube => "DOT_PRODUCT_TEXTURE_CUBE_MAP_NV",
        ShaderOperation::DotReflectDiffuse => "DOT_PRODUCT_DIFFUSE_CUBE_MAP_NV",
        ShaderOperation::DotReflectSpecular => "DOT_PRODUCT_REFLECT_CUBE_MAP_NV",
        ShaderOperation::DotReflectConstantEye { .. } => "DOT_PRODUCT_CONST_EYE_REFLECT_CUBE_MAP_NV",
        // The earlier unit has to have a texture of offsets, which no scene's is.
        ShaderOperation::BumpEnvironment { .. } => return Err("a texture shader that moves coordinates".into()),
    };
    lines.add(format!("shader {n} SHADER_OPERATION_NV {operation}"));
    if stage.operation.reads_previous() {
        lines.add(format!("shader {n} PREVIOUS_TEXTURE_INPUT_NV TEXTURE{}_ARB", stage.previous));
    }
    if stage.operation.is_dot() {
        let mapping = match stage.mapping {
            DotMapping::ZeroToOne => "UNSIGNED_IDENTITY_NV",
            DotMapping::MinusOneToOneD3d => "EXPAND_NORMAL_NV",
            other => return Err(format!("a dot product of bytes by {}", other.name())),
        };
        lines.add(format!("shader {n} RGBA_UNSIGNED_DOT_PRODUCT_MAPPING_NV {mapping}"));
    }
    match stage.operation {
        ShaderOperation::CullFragment { drops_not_negative } => {
            let kept = drops_not_negative.map(|drops| if drops { "LESS" } else { "GEQUAL" });
            lines.add(format!("shader {n} CULL_MODES_NV {}", kept.join(" ")));
        }
        ShaderOperation::DotReflectConstantEye { eye: [x, y, z] } => {
            lines.add(format!("shader {n} CONST_EYE_NV {x} {y} {z}"));
        }
        _ => {}
    }
    Ok(())
}
