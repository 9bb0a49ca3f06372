//! Turns texture instructions into the texture shader.

use super::constants::values;
use super::lower::{Context, UnitUse};
use super::{PixelShader, TextureInstruction, TextureOperation};
use crate::finding::finding;
use ninebit::diagnostic::Diagnostic;
use ninebit::state::{DotMapping, Named, Profile, ShaderOperation, TEXTURE_UNITS};

/// Returns what each texture unit does.
pub(super) fn units(
    program: &PixelShader,
    context: &Context,
    findings: &mut Vec<Diagnostic>,
) -> [Option<UnitUse>; TEXTURE_UNITS] {
    let mut units = [const { None }; TEXTURE_UNITS];
    for texture in &program.textures {
        let index = usize::from(texture.unit.value);
        if let Some(finding) = refused(texture, context) {
            findings.push(finding);
            continue;
        }
        let source = texture.source.as_ref().map(|source| source.value);
        let previous = source.map_or(index.saturating_sub(1), |source| usize::from(source.unit));
        let signed = context.signed.get(previous).copied().unwrap_or(false);
        let mapping = match source {
            Some(source) if source.signed_scale => DotMapping::MinusOneToOneD3d,
            Some(_) if texture.operation.is_row() && signed => DotMapping::MinusOneToOne,
            _ => DotMapping::ZeroToOne,
        };
        if let Some(slot) = units.get_mut(index) {
            *slot = operation(program, context, texture, findings).map(|operation| UnitUse {
                operation,
                previous,
                mapping,
                span: texture.span.clone(),
            });
        }
    }
    units
}

/// Returns the finding that NV10 does not have an instruction, if so.
fn refused(texture: &TextureInstruction, context: &Context) -> Option<Diagnostic> {
    if context.profile == Profile::Nv2a {
        return None;
    }
    use TextureOperation as Op;
    let (index, name) = (texture.unit.value, texture.operation.name());
    if texture.operation == Op::Tex {
        let units = context.profile.texture_units();
        let message = format!("t{index}: nv10 has textures 0 to {}", units - 1);
        let help = "profile Nv2a has 4: write `profile: Nv2a`, or draw in two passes with `blend`";
        return (usize::from(index) >= units).then(|| {
            finding("NB0319", texture.unit.span.clone(), message, "a texture unit that the chip lacks", help)
                .rule("CMB-12")
        });
    }
    let instead = match texture.operation {
        Op::Texbem | Op::Texbeml => {
            "without it, emboss: texture stage 0 selects the height map, stage 1 is AddSigned of (Texture, Complement), its coordinates moved \
             toward the light, and Current"
        }
        Op::Texm3x2pad | Op::Texm3x2tex => {
            "without it, diffuse light: texture stage 0 is DotProduct3 of the normal map and the light direction, stage 1 Modulate"
        }
        Op::Texm3x3pad | Op::Texm3x3tex | Op::Texm3x3spec | Op::Texm3x3vspec => {
            "without it, reflection without bumps: `texgen: [ReflectionMap]` and a cube map"
        }
        _ => "nv10 has no form for it in one pass",
    };
    let message = format!("{name} needs the texture shader; nv10 has none");
    let help = "write `profile: Nv2a`, which has the texture shader";
    let error = finding("NB0340", texture.span.clone(), message, "not on this chip", help);
    Some(error.rule("TSH-10").note(instead))
}

fn operation(
    program: &PixelShader,
    context: &Context,
    texture: &TextureInstruction,
    findings: &mut Vec<Diagnostic>,
) -> Option<ShaderOperation> {
    use TextureOperation as Op;
    let bump = context.bumps.get(usize::from(texture.unit.value)).copied().unwrap_or_default();
    Some(match texture.operation {
        Op::Tex => ShaderOperation::Sample,
        Op::Texcoord => ShaderOperation::PassThrough,
        Op::Texkill => ShaderOperation::CullFragment { drops_not_negative: [false; 4] },
        Op::Texreg2ar => ShaderOperation::DependentAlphaRed,
        Op::Texreg2gb => ShaderOperation::DependentGreenBlue,
        Op::Texm3x2pad | Op::Texm3x3pad => ShaderOperation::DotProduct,
        Op::Texm3x2tex => ShaderOperation::DotProduct2D,
        Op::Texm3x3tex => ShaderOperation::DotProductCube,
        Op::Texm3x3vspec => ShaderOperation::DotReflectSpecular,
        Op::Texm3x3spec => {
            let constants = values(program, &context.constants);
            let eye = texture.eye.as_ref().and_then(|eye| constants.get(usize::from(eye.value)));
            let [x, y, z, _] = eye.copied().unwrap_or_default();
            ShaderOperation::DotReflectConstantEye { eye: [x, y, z] }
        }
        Op::Texbem | Op::Texbeml => {
            let luminance = texture.operation == Op::Texbeml;
            let what = match (bump.matrix, bump.luminance) {
                (Some([m00, m01, m10, m11]), scale) if scale.is_some() || !luminance => {
                    // The registers have this order.
                    let matrix = [m00, m01, m11, m10];
                    return Some(ShaderOperation::BumpEnvironment { matrix, luminance: scale.filter(|_| luminance) });
                }
                (Some(_), _) => "luminance",
                (None, _) => "bump matrix",
            };
            let (index, name) = (texture.unit.value, texture.operation.name());
            let fields = if luminance { "matrix: (1, 0, 0, 1), luminance: (1, 0)" } else { "matrix: (1, 0, 0, 1)" };
            let message = format!("{name} t{index} has no {what}");
            let help = format!(
                "the state of texture stage {index} has it: write `bump: {{ \"t{index}\": ({fields}) }}` beside the text"
            );
            findings.push(finding("NB0378", texture.span.clone(), message, "moves coordinates by it", help));
            return None;
        }
    })
}
