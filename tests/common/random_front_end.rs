//! Random programs of other languages, as the programs of draws.

use super::super::Choices;
use ninebit::state::*;
use ninebit_program::pixel_shader::{self, Bump};
use ninebit_program::registers::{Word, decode, encode};
use ninebit_program::texture_environment::{self as environment, BaseFormat};
use ninebit_program::texture_stages::{self as stages, ArgumentSource, ResultArgument, StageArgument};
use std::fmt::Write;

/// Replaces the program of a draw with one of another language. The draw keeps its program if the language refuses the random one.
pub(super) fn change(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    match c.below(7) {
        0 => registers(c, scene, index),
        1 => texture_stages(c, scene, index),
        2 => texture_environment(c, scene, index),
        3 | 4 => shader(c, scene, index),
        _ => {}
    }
}

fn signed(draw: &Draw) -> [bool; TEXTURE_UNITS] {
    draw.textures.map(|unit| unit.is_some_and(|unit| unit.signed != [false; 4]))
}

/// Inverts random bits of the register words of the combiners.
fn registers(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let draw = &mut scene.draws[index];
    let mut words = encode(&draw.combiners, scene.profile);
    let all: Vec<(Word, usize, u32)> = words.all().collect();
    for _ in 0..c.below(4) {
        let (word, number, value) = c.pick(&all);
        words.set(word, number, value ^ 1 << c.below(32));
    }
    if let Ok(combiners) = decode(&words) {
        draw.combiners = combiners;
    }
}

fn texture_stages(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let mut program = stages::TextureStages::default();
    let count = c.size(1, scene.profile.texture_units() as u32) as usize;
    for n in 0..count {
        let mut c = c.part(24);
        let Some(stage) = program.stage_mut(n) else { continue };
        for half in [&mut stage.color, &mut stage.alpha] {
            half.operation.value = c.any();
            for argument in &mut half.arguments {
                let source: ArgumentSource = c.any();
                argument.value = StageArgument { source, complement: c.once_in(4), alpha_replicate: c.once_in(5) };
            }
        }
        stage.result = if c.once_in(5) { ResultArgument::Temp } else { ResultArgument::Current };
        stage.constant = c.bytes();
        stage.bump_matrix = [c.between(-1.0, 1.0), 0.25, -0.5, c.between(-1.0, 1.0)];
        stage.bump_luminance = [c.between(0.0, 2.0), 0.25];
    }
    (program.texture_factor, program.specular_enable) = (c.bytes(), c.once_in(3));
    let draw = &mut scene.draws[index];
    let bound = draw.textures.map(|unit| unit.is_some());
    let context = stages::Context { profile: scene.profile, bound, signed: signed(draw), fog: draw.fog.enabled };
    let Ok(lowered) = stages::lower(&program, &context) else { return };
    for (k, change) in lowered.units.iter().enumerate() {
        draw.texture_shader[k] = ShaderStage::conventional(k, bound[k]);
        if let Some(set) = change.coordinate_set {
            draw.texture_shader[k].coordinate_set = set;
        }
        if let Some(operation) = &change.operation {
            draw.texture_shader[k].operation = operation.value;
        }
    }
    (draw.combiners, draw.program_origin) = (lowered.combiners, lowered.origins);
}

fn texture_environment(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let mut program = environment::TextureEnvironment { units: Vec::new(), color_sum: c.once_in(3) };
    for _ in 0..scene.profile.texture_units() {
        let mut c = c.part(32);
        let mut unit = environment::Unit::initial();
        unit.mode = c.any();
        for half in [&mut unit.rgb, &mut unit.alpha] {
            half.function.value = c.any();
            for (source, operand) in half.sources.iter_mut().zip(&mut half.operands) {
                (source.value, operand.value) = (c.any(), c.any());
            }
            half.scale = c.pick(&[Scale::One, Scale::One, Scale::Two, Scale::Four]);
        }
        unit.color = c.bytes();
        unit.base_format = c.once_in(2).then(|| c.any());
        program.units.push(unit);
    }
    let textures = &scene.textures;
    let draw = &mut scene.draws[index];
    let formats = draw.textures.map(|unit| unit.map(|unit| BaseFormat::from_format(textures[unit.texture].format)));
    let context =
        environment::Context { profile: scene.profile, textures: formats, signed: signed(draw), fog: draw.fog.enabled };
    if let Ok(lowered) = environment::lower(&program, &context) {
        draw.texture_shader = std::array::from_fn(|k| ShaderStage::conventional(k, formats[k].is_some()));
        (draw.combiners, draw.program_origin) = (lowered.combiners, lowered.origins);
    }
}

/// Texture instructions of a shader, and the numbers of the registers that they load.
const FETCHES: &[(&str, &[usize])] = &[
    ("tex t0\n", &[0]),
    ("tex t0\ntex t1\n", &[0, 1]),
    ("tex t0\ntex t1\ntex t2\ntex t3\n", &[0, 1, 2, 3]),
    ("texcoord t0\ntex t1\n", &[0, 1]),
    ("tex t0\ntexkill t1\n", &[0]),
    ("tex t0\ntexbem t1, t0\n", &[0, 1]),
    ("tex t0\ntexbeml t1, t0\ntex t2\n", &[0, 1, 2]),
    ("tex t0\ntexreg2ar t1, t0\n", &[0, 1]),
    ("tex t0\ntexreg2gb t1, t0\ntex t2\n", &[0, 1, 2]),
    ("tex t0\ntexm3x2pad t1, t0_bx2\ntexm3x2tex t2, t0_bx2\n", &[0, 2]),
    ("tex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3tex t3, t0\n", &[0, 3]),
    ("tex t0\ntexm3x3pad t1, t0_bx2\ntexm3x3pad t2, t0_bx2\ntexm3x3vspec t3, t0_bx2\n", &[0, 3]),
];

/// Gives the draw a pixel shader of version 1.1.
fn shader(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let (fetches, loaded) = c.pick(FETCHES);
    let mut text = format!("ps.1.1\n{fetches}");
    let mut readable: Vec<String> = loaded.iter().map(|t| format!("t{t}")).collect();
    readable.extend(["v0", "v1", "c0", "c1"].map(str::to_owned));
    let count = c.size(1, 4);
    for n in 0..count {
        let mut c = c.part(24);
        let (operation, sources) =
            c.pick(&[("mov", 1), ("add", 2), ("sub", 2), ("mul", 2), ("dp3", 2), ("mad", 3), ("lrp", 3), ("mov", 1)]);
        let scale = c.pick(&["", "", "", "_x2", "_x4", "_d2", "_sat"]);
        let to = if n + 1 == count || c.once_in(2) { "r0" } else { "r1" };
        let _ = write!(text, "{operation}{scale} {to}");
        for _ in 0..sources {
            let register = &readable[c.below(readable.len() as u32) as usize];
            let (before, after) =
                c.pick(&[("", ""), ("", ""), ("1-", ""), ("-", ""), ("", "_bx2"), ("", "_bias"), ("", ".a")]);
            let _ = write!(text, ", {before}{register}{after}");
        }
        text.push('\n');
        if !readable.contains(&to.to_owned()) {
            readable.push(to.to_owned());
        }
    }
    let Ok(parsed) = pixel_shader::parse(&text) else { return };
    let draw = &scene.draws[index];
    let bump = |c: &mut Choices<'_>| Bump {
        matrix: Some([c.between(-1.0, 1.0), 0.5, c.between(-0.5, 0.5), -1.0]),
        luminance: Some([c.between(0.0, 2.0), 0.125]),
    };
    let context = pixel_shader::Context {
        signed: signed(draw),
        fog: draw.fog.enabled,
        constants: std::array::from_fn(|_| [c.between(-1.0, 1.0), 0.5, 0.25, c.between(0.0, 1.0)]),
        bumps: std::array::from_fn(|_| bump(c)),
        ..pixel_shader::Context::new(scene.profile)
    };
    let Ok(lowered) = pixel_shader::lower(&parsed.program, &context) else { return };
    let kinds: Vec<TextureKind> = scene.textures.iter().map(|texture| texture.kind).collect();
    let own = |t: usize| scene.textures[t].image.target() == Some(draw.target);
    let palette_free = |t: usize| scene.textures[t].format != TextureFormat::P8;
    let mut changed = draw.clone();
    for (k, using) in lowered.units.iter().enumerate() {
        let stage = &mut changed.texture_shader[k];
        let Some(using) = using else {
            (stage.operation, changed.textures[k]) = (ShaderOperation::None, None);
            continue;
        };
        (stage.operation, stage.previous, stage.mapping) = (using.operation, using.previous, using.mapping);
        if !using.operation.samples() {
            changed.textures[k] = None;
            continue;
        }
        let fits = |t: &usize| using.operation.kinds().contains(&kinds[*t]) && !own(*t);
        if changed.textures[k].is_none_or(|unit| !fits(&unit.texture)) {
            let fitting: Vec<usize> = (0..kinds.len()).filter(|t| fits(t) && palette_free(*t)).collect();
            changed.textures[k] = (!fitting.is_empty()).then(|| TextureUnit {
                address_s: AddressMode::ClampToEdge,
                address_t: AddressMode::ClampToEdge,
                ..TextureUnit::new(c.pick(&fitting))
            });
        }
    }
    (changed.combiners, changed.program_origin) = (lowered.combiners, lowered.origins);
    scene.draws[index] = changed;
}
