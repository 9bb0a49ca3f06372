//! Equations of texture shader stages: `dot1 = (s, t, r) of set 1 . ZeroToOne(tex0)`.

use super::channels;
use ninebit::state::ShaderOperation;
use ninebit::texture::stage::PlannedShader;

/// Returns the equations of a stage before its unit samples.
pub(super) fn before(shader: &PlannedShader, index: usize) -> Vec<String> {
    let planned = &shader.stages[index];
    let state = &planned.state;
    if !planned.runs() {
        return Vec::new();
    }
    let (set, previous) = (state.coordinate_set, format!("tex{}", state.previous));
    let mut lines = Vec::new();
    if planned.dots {
        lines.push(format!("dot{index} = (s, t, r) of set {set} . {:?}({previous})", state.mapping));
    }
    let at = |place: String| format!("tex{index} is sampled {place}");
    let vector = "(dot1, dot2, dot3)";
    let place = match state.operation {
        ShaderOperation::PassThrough => {
            lines.push(format!("tex{index}.{} = (s, t, r, q) of set {set}, limited to 0..1", channels(planned.live)));
            return lines;
        }
        ShaderOperation::CullFragment { drops_not_negative } => {
            let tests: Vec<String> = ["s", "t", "r", "q"]
                .iter()
                .zip(drops_not_negative)
                .map(|(name, not_negative)| format!("{name} {} 0", if not_negative { ">=" } else { "<" }))
                .collect();
            lines.push(format!("drop if {} of set {set}", tests.join(" or ")));
            return lines;
        }
        ShaderOperation::None | ShaderOperation::Sample | ShaderOperation::DotProduct => return lines,
        ShaderOperation::Sample2D => at(format!("at (s/q, t/q) of set {set}, as of two dimensions")),
        ShaderOperation::SampleCube => at(format!("toward (s, t, r) of set {set}, as of a cube map")),
        ShaderOperation::BumpEnvironment { matrix: [m0, m1, m2, m3], .. } => at(format!(
            "at (s + ({m0} B + {m3} G) / 128, t + ({m1} B + {m2} G) / 128) of set {set}, B and G of {previous} as signed bytes"
        )),
        ShaderOperation::DependentAlphaRed => at(format!("at ({previous}.a, {previous}.r)")),
        ShaderOperation::DependentGreenBlue => at(format!("at ({previous}.g, {previous}.b)")),
        ShaderOperation::DotProduct2D => at(format!("at (dot{}, dot{index})", index.saturating_sub(1))),
        ShaderOperation::DotProduct3D => at("at (dot1, dot2)".to_owned()),
        ShaderOperation::DotProductCube | ShaderOperation::DotReflectDiffuse => at(format!("toward {vector}")),
        ShaderOperation::DotReflectSpecular => {
            let sets = [1, 2, 3].map(|index: usize| shader.stages[index].state.coordinate_set.to_string());
            at(format!("toward e reflected about {vector}, e being q of sets {}", sets.join(", ")))
        }
        ShaderOperation::DotReflectConstantEye { eye: [x, y, z] } => {
            at(format!("toward ({x}, {y}, {z}) reflected about {vector}"))
        }
    };
    if planned.live != 0 {
        lines.push(place);
    }
    lines
}

/// Returns the equation that a stage applies to the sampled colour, if any.
pub(super) fn after(shader: &PlannedShader, index: usize) -> Option<String> {
    let planned = &shader.stages[index];
    let ShaderOperation::BumpEnvironment { luminance: Some([scale, offset]), .. } = planned.state.operation else {
        return None;
    };
    let colors = channels(planned.live & 7);
    let previous = planned.state.previous;
    (!colors.is_empty())
        .then(|| format!("tex{index}.{colors} = tex{index}.{colors} * (tex{previous}.r * {scale} + {offset})"))
}
