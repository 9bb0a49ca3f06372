//! Recipes for the register combiners.

use super::combiners::{Output, Program, input, load, one, rgb_stage, sign, stage};
use super::{Case, Contribution, Placement, byte};
use crate::units::final_combiner::{OWN, Source};
use ninebit::state::*;

const IDENTITY: InputMapping = InputMapping::UnsignedIdentity;
const SIGNED: InputMapping = InputMapping::SignedIdentity;
const NEGATE: InputMapping = InputMapping::SignedNegate;

/// The registers of A to D where a whole portion is evaluated.
const SOURCES: [Register; 4] =
    [Register::Texture0, Register::Texture1, Register::PrimaryColor, Register::SecondaryColor];

fn rgb(register: Register, mapping: InputMapping) -> CombinerInput {
    input(register, Component::Rgb, mapping)
}

fn program(case: &Case, sources: Vec<(&'static str, Vec<u8>)>) -> Program {
    Program { profile: case.profile, stages: Vec::new(), sources, fog: [0; 3] }
}

/// Returns the magnitude of a factor in all four channels, or `None` if it is not a byte.
fn magnitude(value: i64) -> Option<Vec<u8>> {
    byte(value.abs()).map(|b| vec![b; 4])
}

fn red(register: Register, column: &str) -> [Output; 1] {
    [Output { register, columns: vec![(column.to_owned(), 0)] }]
}

/// Returns a program and a portion that multiply two textures; mappings supply the signs.
fn product_of(case: &Case) -> Option<(Program, Portion)> {
    let [a, b] = case.numbers(["in.a", "in.b"]);
    let program = program(case, vec![("texture0", magnitude(a)?), ("texture1", magnitude(b)?)]);
    Some((program, multiplying([rgb(Register::Texture0, sign(a)), rgb(Register::Texture1, sign(b))])))
}

/// Returns a portion that writes a product of colours to SPARE0.
fn multiplying([a, b]: [CombinerInput; 2]) -> Portion {
    let idle = Portion::idle(Component::Rgb);
    Portion { inputs: [a, b, idle.inputs[2], idle.inputs[3]], ab_output: Register::Spare0, ..idle }
}

pub(super) fn product(case: &Case) -> Option<Placement> {
    let (mut program, portion) = product_of(case)?;
    program.stages.push(rgb_stage(portion));
    program.reading(&red(Register::Spare0, "out.ab"), |name| case.number(name))
}

pub(super) fn scale_bias(case: &Case) -> Option<Placement> {
    let (mut program, mut portion) = product_of(case)?;
    (portion.scale, portion.bias) = (case.choice("cfg.scale"), case.choice("cfg.bias"));
    program.stages.push(rgb_stage(portion));
    program.reading(&red(Register::Spare0, "out.value"), |name| case.number(name))
}

pub(super) fn sum(case: &Case) -> Option<Placement> {
    let values = case.numbers(["in.a", "in.b", "in.c", "in.d"]);
    let names = ["texture0", "texture1", "primary", "secondary"];
    let mut sources = Vec::new();
    let mut portion = Portion::idle(Component::Rgb);
    for (n, (name, value)) in names.into_iter().zip(values).enumerate() {
        sources.push((name, magnitude(value)?));
        portion.inputs[n] = rgb(SOURCES[n], sign(value));
    }
    portion.sum_output = Register::Spare0;
    let mut program = program(case, sources);
    program.stages.push(rgb_stage(portion));
    program.reading(&red(Register::Spare0, "out.sum"), |name| case.number(name))
}

/// Evaluates the dot product of two vectors, each the difference of two textures.
pub(super) fn dot_product(case: &Case) -> Option<Placement> {
    let vectors = [case.numbers(["in.a.r", "in.a.g", "in.a.b"]), case.numbers(["in.b.r", "in.b.g", "in.b.b"])];
    if case.profile == Profile::Nv10 {
        return None;
    }
    let names = [["texture0", "texture1"], ["texture2", "texture3"]];
    let registers = [[Register::Texture0, Register::Texture1], [Register::Texture2, Register::Texture3]];
    let destinations = [Register::Spare0, Register::Spare1];
    let (mut sources, mut loads) = (Vec::new(), Vec::new());
    for n in 0..2 {
        let (mut above, mut below) = (vec![0; 4], vec![0; 4]);
        for (channel, value) in vectors[n].into_iter().enumerate() {
            above[channel] = byte(value.max(0))?;
            below[channel] = byte((-value).max(0))?;
        }
        sources.extend([(names[n][0], above), (names[n][1], below)]);
        let pair = [(registers[n][0], IDENTITY), (registers[n][1], NEGATE)];
        loads.push(rgb_stage(super::combiners::adding(Component::Rgb, pair, destinations[n])));
    }
    let product = multiplying([rgb(Register::Spare0, SIGNED), rgb(Register::Spare1, SIGNED)]);
    loads.push(rgb_stage(Portion { ab_dot_product: true, ..product }));
    let program = Program { stages: loads, ..program(case, sources) };
    program.reading(&red(Register::Spare0, "out.dot"), |name| case.number(name))
}

/// Splits a register value into two texels, and returns the mappings that add up to it. The second is not 0 only for -256.
fn texels(value: i64) -> ([InputMapping; 2], [u8; 2]) {
    let (first, second) = (value.unsigned_abs().min(255), value.unsigned_abs().saturating_sub(255));
    ([sign(value), NEGATE], [first as u8, second as u8])
}

/// Evaluates an input mapping. The mapped register is a texture, or a preceding stage makes it if it is negative.
pub(super) fn input_mapping(case: &Case) -> Option<Placement> {
    let (x, factor) = (case.number("in.x"), case.number("out.factor"));
    if factor % 2 != 0 || factor > 510 {
        return None;
    }
    let (signs, [first, second]) = texels(x);
    let mut program = program(case, vec![("texture0", vec![first; 4]), ("texture1", vec![second; 4])]);
    let mut read = Register::Texture0;
    if x < 0 {
        read = Register::Spare0;
        let pair = [(Register::Texture0, signs[0]), (Register::Texture1, signs[1])];
        program.stages.push(rgb_stage(super::combiners::adding(Component::Rgb, pair, read)));
    }
    program.stages.push(rgb_stage(multiplying([rgb(read, case.choice("cfg.mapping")), one(Component::Rgb)])));
    program.reading(&red(Register::Spare0, "out.factor"), |name| case.number(name))
}

/// Evaluates the mux. The alpha portion of the first stage sets SPARE0.a; the mux then selects 0 or 1/255.
pub(super) fn mux(case: &Case) -> Option<Placement> {
    if case.choice::<MuxSelect>("cfg.select") != MuxSelect::Msb {
        return None;
    }
    let (signs, [first, second]) = texels(case.number("in.spare0.a"));
    let mut program = program(case, vec![("texture0", vec![first; 4]), ("texture1", vec![second; 4])]);
    let pair = [(Register::Texture0, signs[0]), (Register::Texture1, signs[1])];
    let making = super::combiners::adding(Component::Alpha, pair, Register::Spare0);
    program.stages.push(stage(Portion::idle(Component::Rgb), making));
    let mut portion = Portion::idle(Component::Rgb);
    portion.inputs[2] = rgb(Register::ConstantColor1, IDENTITY);
    portion.inputs[3] = one(Component::Rgb);
    (portion.mux, portion.sum_output) = (true, Register::Spare1);
    let mut choosing = rgb_stage(portion);
    choosing.constants[1] = [1; 4];
    program.stages.push(choosing);
    let last = FinalCombiner { color_sum_clamp: false, ..FinalCombiner::initial([[0; 4]; 2]) };
    let zero = FinalInput::zero(Component::Rgb);
    let read = FinalInput { register: FinalRegister::Spare1, component: Component::Rgb, invert: false };
    let last = FinalCombiner { inputs: [zero, zero, zero, read, zero, zero], ..last };
    program.finished(last, vec![Contribution::byte("out.takes_cd", 0)])
}

/// Returns whether OpenGL can select this mux.
fn muxes(case: &Case) -> bool {
    case.number("cfg.mux") == 0 || case.choice::<MuxSelect>("cfg.mux_select") == MuxSelect::Msb
}

/// Returns a portion with the row's mappings of A to D, scale, bias and mux.
fn configured(case: &Case, component: Component) -> Portion {
    let mut portion = Portion::idle(component);
    for (n, name) in ["a", "b", "c", "d"].into_iter().enumerate() {
        portion.inputs[n] = input(SOURCES[n], component, case.choice(&format!("cfg.mapping_{name}")));
    }
    portion.scale = case.choice::<Scale>("cfg.scale");
    portion.bias = case.choice::<Bias>("cfg.bias");
    portion.mux = case.number("cfg.mux") != 0;
    portion
}

/// Evaluates a whole RGB portion. Its operands are constants of preceding stages, so every row is a draw of its own.
pub(super) fn general_stage(case: &Case) -> Option<Placement> {
    if case.profile == Profile::Nv10 || !muxes(case) {
        return None;
    }
    let mut program = program(case, Vec::new());
    for (name, register) in ["a", "b", "c", "d"].into_iter().zip(SOURCES) {
        let [r, g, b] = ["r", "g", "b"].map(|channel| case.number(&format!("in.{name}.{channel}")));
        program.stages.push(load(register, [r, g, b, 0])?);
    }
    program.stages.push(load(Register::Spare0, [0, 0, 0, case.number("in.spare0.a")])?);
    let mut portion = configured(case, Component::Rgb);
    portion.ab_dot_product = case.number("cfg.ab_dot") != 0;
    portion.cd_dot_product = case.number("cfg.cd_dot") != 0;
    let outputs = [("ab", Register::Spare0), ("cd", Register::Spare1), ("third", Register::Texture2)];
    [portion.ab_output, portion.cd_output, portion.sum_output] = outputs.map(|(_, register)| register);
    program.stages.push(rgb_stage(portion));
    let outputs = outputs.map(|(name, register)| {
        let columns = ["r", "g", "b"].into_iter().enumerate();
        Output { register, columns: columns.map(|(n, channel)| (format!("out.{name}.{channel}"), n)).collect() }
    });
    program.reading(&outputs, |name| case.number(name))
}

pub(super) fn alpha_portion(case: &Case) -> Option<Placement> {
    if case.profile == Profile::Nv10 || !muxes(case) {
        return None;
    }
    let mut program = program(case, Vec::new());
    let mut portion = configured(case, Component::Alpha);
    for (n, name) in ["a", "b", "c", "d"].into_iter().enumerate() {
        let [blue, alpha] = ["b", "a"].map(|channel| case.number(&format!("in.{name}.{channel}")));
        program.stages.push(load(SOURCES[n], [0, 0, blue, alpha])?);
        if case.number(&format!("cfg.component_{name}")) == 0 {
            portion.inputs[n].component = Component::Blue;
        }
    }
    program.stages.push(load(Register::Spare0, [0, 0, 0, case.number("in.spare0.a")])?);
    let outputs = [("ab", Register::Spare1), ("cd", Register::Texture2), ("third", Register::Texture3)];
    [portion.ab_output, portion.cd_output, portion.sum_output] = outputs.map(|(_, register)| register);
    program.stages.push(stage(Portion::idle(Component::Rgb), portion));
    let outputs = outputs.map(|(name, register)| Output { register, columns: vec![(format!("out.{name}"), 3)] });
    program.reading(&outputs, |name| case.number(name))
}

pub(super) fn two_stages(case: &Case) -> Option<Placement> {
    if case.profile == Profile::Nv10 {
        return None;
    }
    let mut program = program(case, Vec::new());
    for (name, register) in ["in.a", "in.b", "in.c", "in.d"].into_iter().zip(SOURCES) {
        program.stages.push(load(register, [case.number(name); 4])?);
    }
    let mut first = Portion::idle(Component::Rgb);
    first.inputs = SOURCES.map(|register| rgb(register, SIGNED));
    first.sum_output = Register::Spare0;
    let mut second = first;
    (first.scale, first.bias) = (case.choice("cfg.scale"), case.choice("cfg.bias"));
    second.inputs[0] = rgb(Register::Spare0, case.choice("cfg.mapping_spare0"));
    second.inputs[1].mapping = case.choice("cfg.mapping_b");
    program.stages.extend([rgb_stage(first), rgb_stage(second)]);
    program.reading(&red(Register::Spare0, "out.spare0"), |name| case.number(name))
}

/// Evaluates the final combiner. General stages load its registers from constants; FOG is the fog colour.
pub(super) fn final_combiner(case: &Case) -> Option<Placement> {
    let inverts = ["cfg.invert_spare0", "cfg.invert_secondary"];
    if case.profile == Profile::Nv10 || inverts.iter().any(|name| case.number(name) != 0) {
        return None;
    }
    let mut program = program(case, Vec::new());
    let loads = [
        ("in.a", Register::Texture0),
        ("in.b", Register::Texture1),
        ("in.c", Register::PrimaryColor),
        ("in.e", Register::Texture2),
        ("in.f", Register::Texture3),
        ("in.spare0", Register::Spare0),
        ("in.secondary", Register::SecondaryColor),
        ("in.g", Register::Spare1),
    ];
    for (name, register) in loads {
        program.stages.push(load(register, [case.number(name); 4])?);
    }
    program.fog = [byte(case.number("in.d"))?; 3];
    let invert = |name: &str| case.number(&format!("cfg.invert_{name}")) != 0;
    let mut inputs = [FinalInput::zero(Component::Rgb); 6];
    for (n, name) in ["a", "b", "c", "d", "e", "f"].into_iter().enumerate() {
        let source = if n < 4 { case.choice(&format!("cfg.source_{name}")) } else { Source::Own };
        let register = source.register(OWN[n]);
        inputs[n] = FinalInput { register, component: Component::Rgb, invert: invert(name) };
    }
    let last = FinalCombiner {
        inputs,
        g: FinalInput { register: FinalRegister::Spare1, component: Component::Alpha, invert: invert("g") },
        color_sum_clamp: case.number("cfg.sum_clamp") != 0,
        invert_spare0: false,
        invert_secondary: false,
        constants: [[0; 4]; 2],
    };
    program.finished(last, vec![Contribution::byte("out.r", 0), Contribution::byte("out.a", 3)])
}
