//! Register combiner programs that evaluate one row, and their lines in a batch.
//!
//! Operands are bytes of texels or colours; a preceding general stage makes negative ones out of constants. Results are read from the final combiner,
//! which shows 0 to 255: a second draw shows the negated result, and a third tells -256 from -255.

use super::{Contribution, Draw, Path, Placement};
use ninebit::legality::Notation;
use ninebit::state::*;
use ninebit_program::combiner_calls::{self, Words};

/// Returns an input that reads 1.
pub(super) fn one(component: Component) -> CombinerInput {
    CombinerInput { register: Register::Zero, component, mapping: InputMapping::UnsignedInvert }
}

/// Returns an input that reads a register through a mapping.
pub(super) fn input(register: Register, component: Component, mapping: InputMapping) -> CombinerInput {
    CombinerInput { register, component, mapping }
}

/// Returns the mapping that gives a magnitude the sign of `value`.
pub(super) fn sign(value: i64) -> InputMapping {
    if value < 0 { InputMapping::SignedNegate } else { InputMapping::UnsignedIdentity }
}

/// Returns a stage of two portions without constants.
pub(super) fn stage(rgb: Portion, alpha: Portion) -> GeneralStage {
    GeneralStage { rgb, alpha, constants: [[0; 4]; 2] }
}

/// Returns a stage in which only the RGB portion writes.
pub(super) fn rgb_stage(rgb: Portion) -> GeneralStage {
    stage(rgb, Portion::idle(Component::Alpha))
}

/// Returns a portion that adds two mapped registers.
pub(super) fn adding(
    component: Component,
    [first, second]: [(Register, InputMapping); 2],
    destination: Register,
) -> Portion {
    let mut portion = Portion::idle(component);
    portion.inputs =
        [input(first.0, component, first.1), one(component), input(second.0, component, second.1), one(component)];
    portion.sum_output = destination;
    portion
}

/// Splits channels into two bytes each. Returns the mappings of both, and the bytes; `None` if the group has both -256 and a positive value.
fn halves(values: &[i64]) -> Option<([InputMapping; 2], Vec<[u8; 2]>)> {
    let split: fn(i64) -> [i64; 2] =
        if values.contains(&-256) { |v| [(-v).min(255), (-v - 255).max(0)] } else { |v| [v.max(0), (-v).max(0)] };
    let first = if values.contains(&-256) { InputMapping::SignedNegate } else { InputMapping::UnsignedIdentity };
    let bytes: Option<Vec<[u8; 2]>> = values
        .iter()
        .map(|v| {
            let [p, q] = split(*v);
            Some([u8::try_from(p).ok()?, u8::try_from(q).ok()?])
        })
        .collect();
    Some(([first, InputMapping::SignedNegate], bytes?))
}

/// Returns a stage that loads any R, G, B, A into a register from its own two constants.
pub(super) fn load(register: Register, values: [i64; 4]) -> Option<GeneralStage> {
    let constants = [Register::ConstantColor0, Register::ConstantColor1];
    let (rgb_signs, rgb) = halves(&values[..3])?;
    let (alpha_signs, alpha) = halves(&values[3..])?;
    let pair = |signs: [InputMapping; 2]| [(constants[0], signs[0]), (constants[1], signs[1])];
    let mut loading =
        stage(adding(Component::Rgb, pair(rgb_signs), register), adding(Component::Alpha, pair(alpha_signs), register));
    for (channel, bytes) in rgb.iter().chain(&alpha).enumerate() {
        for (constant, byte) in loading.constants.iter_mut().zip(bytes) {
            constant[channel] = *byte;
        }
    }
    Some(loading)
}

/// A register that is read back, and its columns.
#[derive(Clone, Debug)]
pub(super) struct Output {
    pub(super) register: Register,
    /// Pairs of a column's name and the channel that holds it.
    pub(super) columns: Vec<(String, usize)>,
}

/// The program that evaluates a row.
#[derive(Clone, Debug)]
pub(super) struct Program {
    pub(super) profile: Profile,
    pub(super) stages: Vec<GeneralStage>,
    pub(super) sources: Vec<(&'static str, Vec<u8>)>,
    /// Red, green and blue of the register FOG.
    pub(super) fog: [u8; 3],
}

impl Program {
    /// Returns the placement that reads these registers. `expected` returns a column's expected value. Returns `None` if the chip has too few stages.
    pub(super) fn reading(self, outputs: &[Output], expected: impl Fn(&str) -> i64) -> Option<Placement> {
        let limit = self.profile.general_stages();
        if self.stages.len() > limit {
            return None;
        }
        let mut draws = Vec::new();
        for output in outputs {
            let reads = |weight| {
                let read = |(column, channel): &(String, usize)| Contribution {
                    column: column.clone(),
                    channel: *channel,
                    weight,
                };
                output.columns.iter().map(read).collect::<Vec<_>>()
            };
            draws.push(self.draw(&[], &FinalCombiner::showing(FinalRegister::from(output.register)), reads(1)));
            if self.stages.len() < limit {
                for less_one in [false, true] {
                    let after = times_minus_one(output.register, less_one);
                    draws.push(self.draw(&[after], &FinalCombiner::showing(FinalRegister::Spare0), reads(-1)));
                }
            } else if output.columns.iter().any(|(column, _)| expected(column) <= 0) {
                return None;
            }
        }
        Some(self.placed(draws))
    }

    /// Returns the placement with one draw, whose final combiner is `last`.
    pub(super) fn finished(self, last: FinalCombiner, reads: Vec<Contribution>) -> Option<Placement> {
        if self.stages.len() > self.profile.general_stages() {
            return None;
        }
        let draw = self.draw(&[], &last, reads);
        Some(self.placed(vec![draw]))
    }

    /// Returns a draw with further stages after the shared ones.
    fn draw(&self, after: &[GeneralStage], last: &FinalCombiner, reads: Vec<Contribution>) -> Draw {
        let mut stages = self.stages.clone();
        stages.extend_from_slice(after);
        let mut state = vec![format!("combiners {}", stages.len())];
        for (n, stage) in stages.iter().enumerate().skip(self.stages.len()) {
            state.extend(self.stage_lines(n, stage));
        }
        state.extend(final_lines(last));
        let combiners = Combiners { stages, mux_select: MuxSelect::Msb, final_combiner: *last };
        Draw { state, reads, combiners: Some(combiners) }
    }

    fn placed(self, draws: Vec<Draw>) -> Placement {
        let mut state = Vec::new();
        for (n, stage) in self.stages.iter().enumerate() {
            state.extend(self.stage_lines(n, stage));
        }
        if self.fog != [0; 3] {
            state.push(format!("fog_color {} {} {}", self.fog[0], self.fog[1], self.fog[2]));
        }
        let mut needs = vec!["GL_NV_register_combiners"];
        if self.profile == Profile::Nv2a {
            // The extension that brings eight stages also brings constants per stage.
            needs.push("GL_NV_register_combiners2");
        }
        if self.sources.iter().any(|(name, _)| *name == "secondary") {
            needs.push("GL_EXT_secondary_color");
        }
        Placement { path: Path::Combiners, needs, state, draws, sources: self.sources }
    }

    fn stage_lines(&self, n: usize, stage: &GeneralStage) -> Vec<String> {
        stage_lines(self.profile, n, stage)
    }
}

/// Returns the lines of whole combiners.
pub(super) fn program_lines(profile: Profile, combiners: &Combiners) -> Vec<String> {
    let Combiners { stages, final_combiner, .. } = combiners;
    let mut lines = vec![format!("combiners {}", stages.len())];
    lines.extend(stages.iter().enumerate().flat_map(|(n, stage)| stage_lines(profile, n, stage)));
    if profile == Profile::Nv2a {
        // Those of the final combiner alone, as stages have their own.
        for (n, [r, g, b, a]) in final_combiner.constants.iter().enumerate() {
            lines.push(format!("constant {n} {r} {g} {b} {a}"));
        }
    }
    lines.extend(final_lines(final_combiner));
    lines
}

/// Returns the lines of a stage: the portions that write, and the constants that are not 0.
fn stage_lines(profile: Profile, n: usize, stage: &GeneralStage) -> Vec<String> {
    let idle = |portion: &Portion| {
        [portion.ab_output, portion.cd_output, portion.sum_output].iter().all(|r| *r == Register::Zero)
    };
    let mut lines = Vec::new();
    for (name, portion) in [("RGB", &stage.rgb), ("ALPHA", &stage.alpha)] {
        if !idle(portion) {
            lines.push(portion_line(n, name, portion));
        }
    }
    for (constant, color) in stage.constants.iter().enumerate().filter(|(_, color)| **color != [0; 4]) {
        let [r, g, b, a] = color;
        lines.push(match profile {
            Profile::Nv10 => format!("constant {constant} {r} {g} {b} {a}"),
            Profile::Nv2a => format!("stage_constant {n} {constant} {r} {g} {b} {a}"),
        });
    }
    lines
}

/// Returns a stage that writes a register times -1, or that minus one, to SPARE0. It does not depend on whether the negated mapping of -256 saturates
/// or wraps.
fn times_minus_one(register: Register, less_one: bool) -> GeneralStage {
    let portion = |component| {
        let minus_one = input(Register::ConstantColor0, component, InputMapping::SignedNegate);
        let mut portion = Portion::idle(component);
        (portion.inputs[0], portion.inputs[1]) = (input(register, component, InputMapping::SignedIdentity), minus_one);
        if less_one {
            (portion.inputs[2], portion.inputs[3]) = (minus_one, one(component));
            portion.sum_output = Register::Spare0;
        } else {
            portion.ab_output = Register::Spare0;
        }
        portion
    };
    GeneralStage { constants: [[255; 4], [0; 4]], ..stage(portion(Component::Rgb), portion(Component::Alpha)) }
}

/// Returns OpenGL's name of a register without the prefix `GL_`.
fn register_name(register: FinalRegister) -> String {
    use FinalRegister::{Fog, Texture0, Texture1, Texture2, Texture3, Zero};
    let vendor = match register {
        Zero | Fog => "",
        Texture0 | Texture1 | Texture2 | Texture3 => "_ARB",
        _ => "_NV",
    };
    format!("{}{vendor}", Words.register(register))
}

fn component_name(component: Component) -> String {
    component.name().to_uppercase()
}

/// Returns OpenGL's name of a scale or bias; all but NONE have a vendor's suffix.
fn output_name(name: &str) -> String {
    if name == "NONE" { name.to_owned() } else { format!("{name}_NV") }
}

/// Returns the line of a portion: `portion STAGE RGB|ALPHA`, three words for each of A to D, the destinations of AB, CD and the sum, scale, bias, and three flags.
fn portion_line(n: usize, name: &str, portion: &Portion) -> String {
    let mut words = vec!["portion".to_owned(), n.to_string(), name.to_owned()];
    for input in &portion.inputs {
        let mapping = format!("{}_NV", combiner_calls::mapping_name(input.mapping));
        words.extend([register_name(input.register.into()), mapping, component_name(input.component)]);
    }
    for output in [portion.ab_output, portion.cd_output, portion.sum_output] {
        let is_dropped = output == Register::Zero;
        words.push(if is_dropped { "DISCARD_NV".to_owned() } else { register_name(output.into()) });
    }
    words.extend([Words.scale(portion.scale), combiner_calls::bias_name(portion.bias)].map(output_name));
    words.extend([portion.ab_dot_product, portion.cd_dot_product, portion.mux].map(|flag| u8::from(flag).to_string()));
    words.join(" ")
}

/// Returns the lines `final VARIABLE REGISTER MAPPING COMPONENT` for the inputs that are not ZERO, and the line of the colour sum's clamp.
fn final_lines(state: &FinalCombiner) -> Vec<String> {
    let mut lines = Vec::new();
    for (name, input) in ["A", "B", "C", "D", "E", "F", "G"].into_iter().zip(state.inputs.iter().chain([&state.g])) {
        if input.is_zero() {
            continue;
        }
        let mapping = if input.invert { "UNSIGNED_INVERT_NV" } else { "UNSIGNED_IDENTITY_NV" };
        let (register, component) = (register_name(input.register), component_name(input.component));
        lines.push(format!("final VARIABLE_{name}_NV {register} {mapping} {component}"));
    }
    lines.push(format!("color_sum_clamp {}", u8::from(state.color_sum_clamp)));
    lines
}
