//! Writes texture units and stages of the texture shader.
#![allow(clippy::float_arithmetic, reason = "registers of the lod become the floats of a scene, exactly")]

use super::node::{Fields, Node};
use super::texture::{Palettes, Textures};
use ninebit::state::*;

/// Writes the units of a draw and its texture shader, unless they are those of a draw that says nothing.
pub(super) fn units(
    fields: &mut Fields,
    draw: &Draw,
    scene: &Scene,
    (textures, palettes): (&Textures, &Palettes),
) -> Result<(), String> {
    // A chip without a texture shader has no unit that is bound and does nothing; what is bound there is not seen.
    let is_bound = |(unit, stage): (&Option<TextureUnit>, &ShaderStage)| {
        unit.filter(|_| scene.profile == Profile::Nv2a || stage.operation.samples())
    };
    let bound: Vec<Option<TextureUnit>> = draw.textures.iter().zip(&draw.texture_shader).map(is_bound).collect();
    let used = bound.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
    let mut list = Vec::with_capacity(used);
    for (index, of) in bound.iter().enumerate().take(used) {
        list.push(match of {
            None => Node::word("Unbound"),
            Some(of) => {
                let set = draw.texture_shader[index].coordinate_set;
                unit(of, (index, set), scene.profile, (textures, palettes))
                    .map_err(|reason| format!("unit {index}: {reason}"))?
            }
        });
    }
    if !list.is_empty() {
        fields.put("textures", Node::list(list));
    }
    let conventional = bound.iter().zip(&draw.texture_shader).all(|(unit, stage)| {
        stage.operation == if unit.is_some() { ShaderOperation::Sample } else { ShaderOperation::None }
    });
    if !conventional {
        let stages = &draw.texture_shader;
        let used = stages.iter().rposition(|stage| stage.operation != ShaderOperation::None).map_or(0, |n| n + 1);
        let stages = stages.iter().enumerate().take(used).map(|(n, of)| stage(of, n, bound[n].is_some()));
        fields.put("texture_shader", Node::list(stages));
    }
    Ok(())
}

/// Returns a unit; only its texture's name if it has no other state. It takes coordinates from a `set`.
fn unit(
    unit: &TextureUnit,
    (index, set): (usize, usize),
    profile: Profile,
    (textures, palettes): (&Textures, &Palettes),
) -> Result<Node, String> {
    let name = textures.name(unit.texture).ok_or_else(|| format!("it samples texture {}", unit.texture))?;
    let default = TextureUnit::new(0);
    let mut fields = Fields::new("");
    if let Some(palette) = unit.palette.filter(|_| unit.palette != textures.palette(unit.texture)) {
        fields.put("palette", Node::text(palettes.name(palette)?));
    }
    if set != index {
        fields.put("coordinates", Node::whole(u32::try_from(set).unwrap_or(u32::MAX)));
    }
    address(&mut fields, unit, profile);
    if [unit.min_filter, unit.mag_filter] != [Filter::Linear; 2] {
        fields.put("min_filter", Node::word(unit.min_filter.name()));
        fields.put("mag_filter", Node::word(unit.mag_filter.name()));
    }
    fields.word("mip_filter", unit.mip_filter, default.mip_filter);
    if profile == Profile::Nv2a {
        fields.color("border_color", unit.border_color, default.border_color);
    }
    if unit.signed != default.signed {
        fields.put("signed", Node::flags(&unit.signed));
    }
    for (name, value, default) in [
        ("lod_bias", unit.lod_bias, default.lod_bias),
        ("min_lod", unit.min_lod, default.min_lod),
        ("max_lod", unit.max_lod, default.max_lod),
    ] {
        // Thirteen bits.
        fields.number(name, value as f32 / 256.0, default as f32 / 256.0);
    }
    fields.whole("anisotropy", unit.anisotropy, default.anisotropy.into());
    if unit.cylindrical_wrap != default.cylindrical_wrap {
        fields.put("cylindrical_wrap", Node::flags(&unit.cylindrical_wrap));
    }
    if let Some(key) = unit.color_key {
        let mut of_key = Fields::new("");
        of_key.put("color", Node::color(key.color));
        of_key.put("mode", Node::word(key.mode.name()));
        fields.put("color_key", of_key);
    }
    if let Some(shadow) = unit.shadow {
        let mut comparison = Fields::new("");
        comparison.put("function", Node::word(shadow.function.name()));
        comparison.word("reference", shadow.reference, ShadowReference::R);
        fields.put("shadow", comparison);
    }
    if fields.is_empty() {
        return Ok(Node::text(name));
    }
    let mut whole = Fields::new("");
    whole.put("texture", Node::text(name));
    whole.append(fields);
    Ok(whole.into())
}

/// Writes the address modes: one for all axes, or one for each that differs from the first.
fn address(fields: &mut Fields, unit: &TextureUnit, profile: Profile) {
    let [s, t, r] = [unit.address_s, unit.address_t, unit.address_r];
    // A chip without borders has no third axis to say so for.
    let r = if profile == Profile::Nv10 && r == AddressMode::ClampToBorder { s } else { r };
    fields.word("address", s, AddressMode::Wrap);
    fields.word("address_t", t, s);
    fields.word("address_r", r, s);
}

/// Returns a stage of the texture shader; only its operation if the rest is its default.
fn stage(stage: &ShaderStage, index: usize, bound: bool) -> Node {
    let operation = operation(&stage.operation);
    let mut fields = Fields::new("");
    if stage.operation.reads_previous() && stage.previous != index.saturating_sub(1) {
        fields.put("previous", Node::whole(u32::try_from(stage.previous).unwrap_or(u32::MAX)));
    }
    if stage.operation.is_dot() {
        fields.word("mapping", stage.mapping, DotMapping::ZeroToOne);
    }
    // A bound unit says itself which coordinates it takes.
    if !bound && stage.coordinate_set != index && stage.operation != ShaderOperation::None {
        fields.put("coordinates", Node::whole(u32::try_from(stage.coordinate_set).unwrap_or(u32::MAX)));
    }
    if fields.is_empty() {
        return operation;
    }
    let mut whole = Fields::new("");
    whole.put("operation", operation);
    whole.append(fields);
    whole.into()
}

fn operation(operation: &ShaderOperation) -> Node {
    let mut fields = Fields::new(operation.name());
    match operation {
        ShaderOperation::CullFragment { drops_not_negative } => {
            for (name, drops) in ["s", "t", "r", "q"].into_iter().zip(drops_not_negative) {
                if *drops {
                    fields.put(name, Node::word("NotNegative"));
                }
            }
        }
        ShaderOperation::BumpEnvironment { matrix, luminance } => {
            fields.put("matrix", Node::numbers(matrix));
            if let Some(luminance) = luminance {
                fields.put("luminance", Node::numbers(luminance));
            }
        }
        ShaderOperation::DotReflectConstantEye { eye } => fields.put("eye", Node::numbers(eye)),
        _ => {}
    }
    if fields.is_empty() { Node::word(operation.name()) } else { fields.into() }
}
