//! Explanation of a plan: what each draw computes, what was left out and why, and its cost.
//!
//! The program is printed as a whole, in the combiner language, and then as equations of what is left of it: `spare0.rgb = expand(tex0) .
//! expand(col0)`. Costs are predicted from the plan; a run counts the same ([`engine::count`]).

mod cost;
mod equation;
mod report;
mod shader;

pub use cost::{Cost, FragmentCost};
pub use report::{explanation_json, explanation_text};

use ninebit::engine::{self, EmptyDraw};
use ninebit::plan::{Plan, PlanOptions, PlannedDraw};
use ninebit::raster::project::ClipPlane;
use ninebit::rop::{self, surface};
use ninebit::state::*;
use ninebit::texture::planned::PlannedUnit;
use ninebit_program::text::print;
use ninebit_program::text::words::register;

/// Explanation of a draw.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DrawExplanation {
    /// Name of the draw.
    pub name: String,
    /// Name of its target.
    pub target: String,
    /// The vertex program that computed its vertices, and the number of vertices.
    pub vertex_program: Option<(VertexProgram, usize)>,
    /// The whole pixel program in the combiner language.
    pub program: String,
    /// For each general stage, the text in an API's language that it was made from; empty if the program was written for the combiners.
    pub program_origin: Vec<StageOrigin>,
    /// Equations of what the plan has kept, in order.
    pub equations: Vec<String>,
    /// Description of the clipping of its triangles; `None` if nothing was clipped.
    pub clipping: Option<String>,
    /// State that has no effect, and why.
    pub dropped: Vec<String>,
    /// Cost of what the plan has kept.
    pub cost: Cost,
    /// Cost of everything that the program asks for, which is what a chip does.
    pub asked: Cost,
}

/// Explains a plan of a scene, draw by draw.
pub fn explain(scene: &Scene, plan: &Plan) -> Vec<DrawExplanation> {
    // A scene that has a plan also has this one: pruning does not make scenes legal.
    let whole = Plan::compile(scene, &PlanOptions { policies: plan.policies, prune: false });
    let whole = whole.as_ref().unwrap_or(plan);
    let costs = |plan: &Plan| -> Vec<Cost> {
        let draws = plan.draws().iter().zip(engine::shaded(plan));
        draws.map(|(planned, shaded)| Cost::from_draw(planned, &plan.policies, shaded)).collect()
    };
    let draws = scene.draws.iter().zip(plan.draws()).zip(engine::unseen(plan));
    draws
        .zip(costs(plan).into_iter().zip(costs(whole)))
        .map(|(((draw, planned), unseen), (cost, asked))| DrawExplanation {
            name: planned.name.clone(),
            target: plan.targets()[planned.target].name.clone(),
            vertex_program: draw.vertex_program.clone().map(|program| (program, draw.vertices.len())),
            program: print(&draw.combiners),
            program_origin: draw.program_origin.clone(),
            equations: equations(scene, plan, planned),
            clipping: clipping(planned),
            dropped: dropped(scene, draw, planned, unseen),
            cost,
            asked,
        })
        .collect()
}

/// Describes the clipping of a draw's triangles (RAS-6).
fn clipping(planned: &PlannedDraw) -> Option<String> {
    let clipping = &planned.assembly.clipping;
    if clipping.planes == 0 {
        return None;
    }
    let (left, pieces, cut) = (planned.assembly.triangles.len(), clipping.pieces.len(), clipping.cut);
    let given = left - pieces + cut + clipping.removed;
    let (planes, removed) = (ClipPlane::names(clipping.planes), clipping.removed);
    Some(format!(
        "{given} triangles: {removed} removed and {cut} cut into {pieces} pieces ({planes}); {left} are drawn"
    ))
}

fn channels(mask: u8) -> String {
    (0..4).filter(|n| mask >> n & 1 != 0).map(|n| ["r", "g", "b", "a"][n]).collect()
}

fn equations(scene: &Scene, plan: &Plan, planned: &PlannedDraw) -> Vec<String> {
    let mut lines = Vec::new();
    if planned.folded.invisible.is_some() {
        return lines;
    }
    for index in 0..TEXTURE_UNITS {
        if let Some(shader) = &planned.shader {
            lines.extend(shader::before(shader, index));
        }
        if let Some(unit) = planned.units.iter().find(|unit| unit.index == index) {
            lines.push(sampled(scene, unit));
        }
        if let Some(shader) = &planned.shader {
            lines.extend(shader::after(shader, index));
        }
    }
    for (of, live) in [(Register::PrimaryColor, planned.primary), (Register::SecondaryColor, planned.secondary)] {
        if live != 0 {
            let how = planned.shade_model.name().to_lowercase();
            lines.push(format!("{}.{} = {how}(vertices)", register(of), channels(live)));
        }
    }
    lines.extend(fog(planned));
    for stage in &planned.stages {
        lines.extend(equation::stage(stage, planned.mux_select));
    }
    lines.extend(equation::final_combiner(&planned.final_combiner));
    if let Some(test) = &planned.alpha_test {
        lines.push(format!("pass if fragment.a {} {}", comparison(test.function), test.reference));
    }
    if let Some(test) = &planned.stencil_test {
        lines.extend(stencil(test));
    }
    if let Some(test) = &planned.depth_test {
        let write = if test.write { ", then store z" } else { "" };
        lines.push(format!("pass if z {} stored z{write}", comparison(test.function)));
    }
    lines.extend(equation::blend(planned));
    if planned.write_mask != 0 {
        let target = &plan.targets()[planned.target];
        lines.push(format!("store {} to `{}`, {}", channels(planned.written), target.name, target.format.name()));
    }
    lines
}

/// Returns the equations of the fog register, as far as it is read.
fn fog(planned: &PlannedDraw) -> Vec<String> {
    let mut lines = Vec::new();
    let colors = channels(planned.fog_channels & 7);
    if !colors.is_empty() {
        let [r, g, b] = planned.fog.color;
        lines.push(format!("fog.{colors} = ({r}, {g}, {b})/255"));
    }
    if planned.fog_channels & 8 != 0 {
        let factor = match planned.fog.function {
            _ if !planned.fog.enabled => "1: fog is off".to_string(),
            None => "smooth(vertices): factors".to_string(),
            Some(function) => curve(&function),
        };
        lines.push(format!("fog.a = {factor}"));
    }
    lines
}

/// Returns the fog factor as a function of the coordinate d.
fn curve(function: &FogFunction) -> String {
    let FogFunction { mode, p0, p1, p2, .. } = function;
    let square = if *p2 == 0.0 { String::new() } else { format!(" + {p2} d^2") };
    let e = format!("e = {p0} + {p1} d{square} at the vertices");
    match mode {
        FogMode::Linear if function.per_vertex => format!("e - 1, limited to 0..1, {e}"),
        FogMode::LinearAbs if function.per_vertex => format!("|e| - 1, limited to 0..1, {e}"),
        FogMode::Linear => format!("{p0} + {p1} d - 1, limited to 0..1, d being the pixel's fog coordinate"),
        FogMode::LinearAbs => format!("{p0} + {p1} |d| - 1, limited to 0..1, d being the pixel's fog coordinate"),
        FogMode::Exp => format!("2^(16 (e - 3/2)), 1 from e = 3/2 on, 0 below e = 1, {e}"),
        FogMode::ExpAbs => format!("2^(-16 |e - 3/2|), 0 from a distance of 1/2 on, {e}"),
        FogMode::Exp2 | FogMode::Exp2Abs => format!("2^(-32 (e - 3/2)^2), 0 from a distance of 1/2 on, {e}"),
    }
}

/// Returns the equation of what a unit samples.
fn sampled(scene: &Scene, unit: &PlannedUnit) -> String {
    let texture = &scene.textures[unit.state.texture].name;
    let modes = format!("{}/{}", unit.state.address_s.name(), unit.state.address_t.name());
    format!(
        "tex{}.{} = {}(`{texture}`, {} x {} {}{}, {}{})",
        unit.index,
        channels(unit.live),
        filters(unit),
        unit.levels[0].width,
        unit.levels[0].height,
        unit.format.name(),
        if unit.levels.len() > 1 { format!(", {} levels", unit.levels.len()) } else { String::new() },
        match unit.kind {
            TextureKind::Cube => "cube map".to_string(),
            TextureKind::TwoDimensional => modes,
            TextureKind::Rectangle => format!("{modes}, in texels"),
            TextureKind::ThreeDimensional => format!("{} layers, {modes}/{}", unit.layers, unit.state.address_r.name()),
        },
        extras(unit),
    )
}

/// Describes what a unit does besides addressing and filtering.
fn extras(unit: &PlannedUnit) -> String {
    let state = &unit.state;
    let mut extras = String::new();
    if state.anisotropy > 1 {
        extras += &format!(", anisotropy {}", state.anisotropy);
    }
    for (wraps, axis) in state.cylindrical_wrap.into_iter().zip(["s", "t"]) {
        if wraps {
            extras += &format!(", {axis} around a cylinder");
        }
    }
    if let Some(shadow) = &state.shadow {
        let reference = if shadow.reference == ShadowReference::R { "r/q" } else { "0" };
        extras += &format!(", {reference} {} texel", comparison(shadow.function));
    }
    extras
}

/// Describes a unit's filters: one word, or the filters for magnification and minification and the use of mip levels.
fn filters(unit: &PlannedUnit) -> String {
    let state = &unit.state;
    let [min, mag] = [state.min_filter, state.mag_filter].map(|filter| filter.name().to_lowercase());
    if !unit.needs_lod() {
        return mag;
    }
    match state.mip_filter {
        MipFilter::Linear if unit.levels.len() > 1 => format!("{mag} or {min} of two levels"),
        MipFilter::Nearest if unit.levels.len() > 1 => format!("{mag} or {min} of the nearest level"),
        _ => format!("{mag} or, minified, {min}"),
    }
}

/// Returns the equations of the stencil test: what passes, and what is stored.
fn stencil(test: &StencilTest) -> Vec<String> {
    let masked = |name: &str, mask: u8| if mask == 255 { name.to_string() } else { format!("({name} & {mask:#04x})") };
    let reference = test.reference & test.mask;
    let mut lines = Vec::new();
    if test.function != CompareFunction::Always {
        let stored = masked("stored stencil", test.mask);
        lines.push(format!("pass if {reference} {} {stored}", comparison(test.function)));
    }
    if rop::stencil::writes(test) {
        let bits = if test.write_mask == 255 { String::new() } else { format!(", bits {:#04x}", test.write_mask) };
        let [fail, depth_fail, pass] = [test.fail, test.depth_fail, test.pass].map(|operation| match operation {
            StencilOperation::Replace => format!("{}", test.reference),
            operation => operation.name().to_string(),
        });
        lines.push(format!("store stencil: {pass}; {depth_fail} where z fails; {fail} where the stencil fails{bits}"));
    }
    lines
}

fn comparison(function: CompareFunction) -> &'static str {
    match function {
        CompareFunction::Never => "never",
        CompareFunction::Less => "<",
        CompareFunction::Equal => "=",
        CompareFunction::LessOrEqual => "<=",
        CompareFunction::Greater => ">",
        CompareFunction::NotEqual => "!=",
        CompareFunction::GreaterOrEqual => ">=",
        CompareFunction::Always => "always, whatever",
    }
}

/// Returns the state that is not in the plan, and why.
fn dropped(scene: &Scene, draw: &Draw, planned: &PlannedDraw, unseen: Option<EmptyDraw>) -> Vec<String> {
    let mut lines: Vec<String> =
        unseen.map(|unseen| format!("the whole draw: {}", unseen.reason)).into_iter().collect();
    if planned.folded.invisible.is_some() {
        return lines;
    }
    for (index, unit) in draw.textures.iter().enumerate() {
        let Some(unit) = unit else { continue };
        let name = &scene.textures[unit.texture].name;
        match planned.units.iter().find(|planned| planned.index == index) {
            None if !draw.texture_shader[index].operation.samples() => {
                let operation = draw.texture_shader[index].operation.name();
                lines.push(format!(
                    "texture unit {index}, `{name}`: the texture shader does not sample it ({operation})"
                ));
            }
            None => lines.push(format!("texture unit {index}, `{name}`: nothing that is needed reads tex{index}")),
            Some(planned) if planned.live != 15 => {
                lines.push(format!("tex{index}.{}: nothing that is needed reads it", channels(15 & !planned.live)));
            }
            Some(_) => {}
        }
    }
    for (of, live) in [(Register::PrimaryColor, planned.primary), (Register::SecondaryColor, planned.secondary)] {
        if live != 15 {
            let name = register(of);
            lines.push(format!("{name}.{}: nothing that is needed reads it", channels(15 & !live)));
        }
    }
    for (index, stage) in draw.combiners.stages.iter().enumerate() {
        let kept = planned.stages.iter().find(|planned| planned.index == index);
        for (state, all, what) in [(&stage.rgb, 7, "rgb"), (&stage.alpha, 8, "alpha")] {
            let kept = kept.map(|stage| if what == "rgb" { &stage.rgb } else { &stage.alpha });
            let outputs = [("AB", state.ab_output), ("CD", state.cd_output), ("sum", state.sum_output)];
            for (n, (output, destination)) in outputs.into_iter().enumerate() {
                if destination == Register::Zero {
                    continue;
                }
                let live = kept.map_or(0, |portion| portion.live[n]);
                if live != all {
                    let (name, dead) = (register(destination), channels(all & !live));
                    lines.push(format!("stage {index} {what} {output}: {name}.{dead} is not read afterwards"));
                }
            }
        }
    }
    let fragment = planned.final_combiner.live;
    if fragment & 8 == 0 {
        lines.push("fragment.a: it is not tested, blended or stored".to_string());
    }
    if fragment & 7 != 7 {
        lines.push(format!("fragment.{}: it is neither blended nor stored", channels(7 & !fragment)));
    }
    if fragment & 7 != 0 && !planned.final_combiner.lerps {
        lines.push("final combiner A, B, C: A and C are 0, so D alone counts".to_string());
    }
    if let Some(test) = &draw.alpha_test
        && planned.alpha_test.is_none()
    {
        lines.push(format!("alpha test: {} passes every fragment", test.function.name()));
    }
    lines.extend(draw.blend.as_ref().and_then(|blend| dropped_blend(blend, planned)));
    lines
}

fn dropped_blend(blend: &Blend, planned: &PlannedDraw) -> Option<String> {
    let Blend { equation, source, destination } = blend;
    let state = format!("blend {}, {}, {}", equation.name(), source.name(), destination.name());
    if !surface::blends(planned.surface) {
        Some(format!("{state}: {} surfaces do not blend", planned.surface.name()))
    } else if planned.folded.replaces {
        Some(format!("{state}: it stores the source as it is, the destination is not read"))
    } else if planned.folded.keeps {
        Some(format!("{state}: it keeps what is there, no colour is written"))
    } else {
        None
    }
}
