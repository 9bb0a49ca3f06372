//! The texture shader and the combiners of a draw.

use ninebit::state::{Combiners, Named, Profile, ShaderOperation, ShaderStage, TextureKind};
use ninebit_program::registers::layout::{OWN_CONSTANTS, config, stages};
use ninebit_program::registers::unit::*;
use ninebit_program::registers::{RegisterWords, Word, decode};

use super::view::View;
use crate::class::{self, of_unit};
use crate::gap::Gap;

/// Returns the code of a stage.
pub(crate) fn code(view: &mut View<'_>, unit: usize) -> u32 {
    view.get(class::SET_SHADER_STAGE_PROGRAM) >> (STAGE_BITS * unit as u32) & ((1 << STAGE_BITS) - 1)
}

/// Returns the operation of a stage that samples a texture of this kind, by the code of the stage (TEX-20).
pub(crate) fn of_kind(
    view: &mut View<'_>,
    unit: usize,
    operation: ShaderOperation,
    kind: TextureKind,
) -> ShaderOperation {
    use ShaderOperation as Op;
    match (operation, code(view, unit), kind) {
        (Op::Sample, STAGE_TWO, TextureKind::Cube | TextureKind::ThreeDimensional) => Op::Sample2D,
        (Op::Sample, STAGE_CUBE, TextureKind::TwoDimensional) => Op::SampleCube,
        // `None` samples no kind.
        (Op::Sample, STAGE_CUBE, TextureKind::Rectangle | TextureKind::ThreeDimensional)
        | (Op::Sample, STAGE_THREE, TextureKind::Cube) => Op::None,
        _ => operation,
    }
}

/// Reads a stage of the texture shader.
pub(crate) fn stage(view: &mut View<'_>, unit: usize) -> ShaderStage {
    use ShaderOperation as Op;
    let code = code(view, unit);
    let mut stage = ShaderStage::conventional(unit, false);
    let float = |view: &mut View<'_>, method, n: u32| view.float(of_unit(method, unit) + 4 * n);
    let matrix = |view: &mut View<'_>| {
        let m = [0, 1, 2, 3].map(|n| float(view, class::SET_TEXTURE_SET_BUMP_ENV_MAT, n));
        if m.iter().all(|m| m.is_finite()) { m } else { [0.0; 4] }
    };
    stage.operation = match code {
        0 => Op::None,
        STAGE_TWO | STAGE_THREE | STAGE_CUBE => Op::Sample,
        STAGE_PASS_THROUGH => Op::PassThrough,
        STAGE_CULL => {
            let bits = view.get(class::SET_SHADER_CLIP_PLANE_MODE) >> (CLIP_BITS * unit as u32);
            // A set bit keeps what is negative.
            Op::CullFragment { drops_not_negative: [0, 1, 2, 3].map(|n| bits >> n & 1 != 0) }
        }
        STAGE_BUMP => Op::BumpEnvironment { matrix: matrix(view), luminance: None },
        STAGE_BUMP_LUMINANCE => {
            let scale = float(view, class::SET_TEXTURE_SET_BUMP_ENV_SCALE, 0);
            let offset = float(view, class::SET_TEXTURE_SET_BUMP_ENV_OFFSET, 0);
            Op::BumpEnvironment { matrix: matrix(view), luminance: Some([scale, offset]) }
        }
        STAGE_DOT_2D => Op::DotProduct2D,
        STAGE_REFLECT_DIFFUSE => Op::DotReflectDiffuse,
        STAGE_REFLECT_SPECULAR => Op::DotReflectSpecular,
        STAGE_DOT_3D => Op::DotProduct3D,
        STAGE_DOT_CUBE => Op::DotProductCube,
        STAGE_ALPHA_RED => Op::DependentAlphaRed,
        STAGE_GREEN_BLUE => Op::DependentGreenBlue,
        STAGE_DOT => Op::DotProduct,
        STAGE_REFLECT_CONSTANT => {
            Op::DotReflectConstantEye { eye: [0, 1, 2].map(|n| view.float(class::SET_EYE_VECTOR + 4 * n)) }
        }
        _ => {
            let name = match code {
                8 => "BRDF".to_owned(),
                0xa => "a dot product for depths".to_owned(),
                _ => format!("stage program 0x{code:x}"),
            };
            view.note(Gap::NotModelled(format!("{name} at unit {unit}")));
            Op::None
        }
    };
    if stage.operation.reads_previous() {
        stage.previous = match unit {
            2 | 3 => PREVIOUS[unit - 2].value_in(view.get(class::SET_SHADER_OTHER_STAGE_INPUT)) as usize,
            _ => 0,
        };
        if stage.previous >= unit.max(1) {
            view.bad(class::SET_SHADER_OTHER_STAGE_INPUT);
            stage.previous = unit.saturating_sub(1);
        }
    }
    if stage.operation.is_dot() && unit > 0 {
        let code = view.get(class::SET_DOT_RGBMAPPING) >> (MAPPING_BITS * (unit as u32 - 1)) & 0xf;
        match DOT_MAPPINGS.iter().find(|(_, value)| *value == code) {
            Some((mapping, _)) => stage.mapping = *mapping,
            None => view.note(Gap::NotModelled(format!("dot mapping {code} of unit {unit}"))),
        }
    }
    stage
}

/// Reads the combiners; `None` if the chip does not accept their words, which is noted.
pub(crate) fn combiners(view: &mut View<'_>) -> Option<Combiners> {
    let chip = view.family().profile();
    let mut words = RegisterWords::new(chip);
    let (word, index) = config(chip);
    let config = view.own(word.method(chip) + 4 * index as u32);
    let of_stages = stages(chip);
    let count = of_stages.value_in(config).clamp(1, chip.general_stages() as u32);
    let rest = config & !of_stages.put(of_stages.most());
    words.set(word, index, if chip == Profile::Nv2a { rest & 0x0001_1100 } else { rest } | of_stages.put(count));
    let own = OWN_CONSTANTS.map(|field| chip == Profile::Nv2a && field.is_set(config));
    for of in Word::ALL.iter().filter(|of| of.count(chip) > 0) {
        let used = match of {
            Word::RcColor | Word::RcFinal0 | Word::RcFinal1 => of.count(chip),
            Word::RcConstantColor0 if !own[0] => 1,
            Word::RcConstantColor1 if !own[1] => 1,
            _ => (count as usize).min(of.count(chip)),
        };
        for at in (0..used).filter(|at| (*of, *at) != (word, index)) {
            let method = of.method(chip) + 4 * at as u32;
            let constant = matches!(of, Word::RcColor | Word::RcConstantColor0 | Word::RcConstantColor1);
            // Constants that no input reads are never set by programs.
            let value = if constant { view.state().get(method).unwrap_or(0) } else { view.own(method) };
            words.set(*of, at, value);
        }
    }
    match decode(&words) {
        Ok(combiners) => {
            constants(view, &combiners, own);
            Some(combiners)
        }
        Err(refusals) => {
            for refusal in refusals {
                view.note(Gap::NotModelled(refusal.message));
            }
            None
        }
    }
}

/// Notes constants that a program reads and the log never set.
fn constants(view: &mut View<'_>, combiners: &Combiners, own: [bool; 2]) {
    use ninebit::state::{FinalRegister, Register};
    let chip = view.family().profile();
    let mut needs = |word: Word, index: usize| {
        let method = word.method(chip) + 4 * index as u32;
        if view.state().get(method).is_none() {
            view.missing_own(method);
        }
    };
    for (n, stage) in combiners.stages.iter().enumerate() {
        for (k, register) in [Register::ConstantColor0, Register::ConstantColor1].into_iter().enumerate() {
            let portions = [&stage.rgb, &stage.alpha];
            if portions.iter().any(|portion| portion.inputs.iter().any(|input| input.register == register)) {
                match chip {
                    Profile::Nv10 => needs(Word::RcColor, k),
                    Profile::Nv2a => {
                        needs([Word::RcConstantColor0, Word::RcConstantColor1][k], if own[k] { n } else { 0 });
                    }
                }
            }
        }
    }
    let inputs = combiners.final_combiner.inputs.iter().chain([&combiners.final_combiner.g]);
    for input in inputs {
        for (k, register) in [FinalRegister::ConstantColor0, FinalRegister::ConstantColor1].into_iter().enumerate() {
            if input.register == register {
                needs(Word::RcColor, k);
            }
        }
    }
}
