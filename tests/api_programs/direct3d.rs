//! Tests texture stages against the formulas of Direct3D.

use super::Choices;
use super::run::{Pixel, agrees, run};
use ninebit::state::{Combiners, Named, Profile, ShaderOperation};
use ninebit_program::Spanned;
use ninebit_program::texture_stages::{
    ArgumentSource, Context, Half, Operation, ResultArgument, STAGES, StageArgument, TextureStage, TextureStages, lower,
};
use proptest::prelude::*;

/// Returns a random argument of a stage. It names the texture only if the stage has one.
fn argument(choices: &mut Choices, texture: bool) -> Spanned<StageArgument> {
    let source = match choices.of(ArgumentSource::ALL) {
        ArgumentSource::Texture if !texture => ArgumentSource::Temp,
        source => source,
    };
    let [complement, alpha_replicate] = [0, 1].map(|_| choices.below(4) == 0);
    Spanned::default_of(StageArgument { source, complement, alpha_replicate })
}

/// Returns a random operation for colour or alpha of stage `index`, with its arguments. Only stages with a texture unit have textures.
fn half(choices: &mut Choices, index: usize, alpha: bool) -> Half {
    let units = Profile::Nv2a.texture_units();
    let possible = |op: &Operation| match op {
        Operation::PreModulate | Operation::BumpEnvMap | Operation::BumpEnvMapLuminance => index + 1 < units,
        Operation::BlendTextureAlpha | Operation::BlendTextureAlphaPM => index < units,
        _ => true,
    };
    let operations: Vec<Operation> =
        Operation::ALL.iter().copied().filter(|op| !(alpha && op.is_color_only()) && possible(op)).collect();
    Half {
        operation: Spanned::default_of(choices.of(&operations)),
        arguments: std::array::from_fn(|_| argument(choices, index < units)),
    }
}

/// Returns a random cascade of at most `most` stages.
pub(super) fn stages(choices: &mut Choices, most: usize) -> TextureStages {
    let count = 1 + choices.below(most);
    let stages = (0..count)
        .map(|index| TextureStage {
            color: half(choices, index, false),
            alpha: half(choices, index, true),
            result: if choices.below(4) == 0 { ResultArgument::Temp } else { ResultArgument::Current },
            constant: choices.color(),
            ..TextureStage::initial(index)
        })
        .collect();
    TextureStages { stages, texture_factor: choices.color(), specular_enable: choices.flag() }
}

/// Returns the colour that Direct3D defines for a pixel, R, G, B, A in 0..1.
fn reference(program: &TextureStages, context: &Context, pixel: &Pixel) -> [f64; 4] {
    let white = [1.0; 4];
    let texture = |unit: usize| match context.bound.get(unit) {
        Some(true) => Pixel::real(pixel.textures[unit]),
        _ => white,
    };
    let factor = Pixel::real(program.texture_factor);
    let diffuse = Pixel::real(pixel.diffuse);
    let (mut current, mut temp) = (diffuse, [0.0; 4]);
    let active: Vec<&TextureStage> =
        program.stages.iter().take_while(|stage| stage.color.operation.value != Operation::Disable).collect();
    for (index, stage) in active.iter().enumerate() {
        if stage.color.operation.value.is_bump() {
            continue;
        }
        let value = |at: &Spanned<StageArgument>| {
            let argument = at.value;
            let mut color = match argument.source {
                ArgumentSource::Diffuse => diffuse,
                ArgumentSource::Current => current,
                ArgumentSource::Texture => texture(index),
                ArgumentSource::TextureFactor => factor,
                ArgumentSource::Specular => Pixel::real(pixel.specular),
                ArgumentSource::Temp => temp,
                ArgumentSource::Constant => Pixel::real(stage.constant),
            };
            if argument.alpha_replicate {
                color = [color[3]; 4];
            }
            if argument.complement { color.map(|x| 1.0 - x) } else { color }
        };
        let next = if index + 1 < active.len() { texture(index + 1) } else { white };
        let channel = |half: &Half, n: usize| {
            let [a0, a1, a2] = [0, 1, 2].map(|slot| value(&half.arguments[slot])[n]);
            let a1_alpha = value(&half.arguments[1])[3];
            let blend = |f: f64| f * a1 + (1.0 - f) * a2;
            match half.operation.value {
                Operation::Disable | Operation::BumpEnvMap | Operation::BumpEnvMapLuminance => current[n],
                Operation::SelectArg1 => a1,
                Operation::SelectArg2 => a2,
                Operation::Modulate => a1 * a2,
                Operation::Modulate2X => 2.0 * a1 * a2,
                Operation::Modulate4X => 4.0 * a1 * a2,
                Operation::Add => a1 + a2,
                Operation::AddSigned => a1 + a2 - 0.5,
                Operation::AddSigned2X => 2.0 * (a1 + a2 - 0.5),
                Operation::Subtract => a1 - a2,
                Operation::AddSmooth => a1 + a2 - a1 * a2,
                Operation::BlendDiffuseAlpha => blend(diffuse[3]),
                Operation::BlendTextureAlpha => blend(texture(index)[3]),
                Operation::BlendFactorAlpha => blend(factor[3]),
                Operation::BlendTextureAlphaPM => a1 + (1.0 - texture(index)[3]) * a2,
                Operation::BlendCurrentAlpha => blend(current[3]),
                Operation::PreModulate => a1 * next[n],
                Operation::ModulateAlphaAddColor => a1 + a1_alpha * a2,
                Operation::ModulateColorAddAlpha => a1 * a2 + a1_alpha,
                Operation::ModulateInvAlphaAddColor => (1.0 - a1_alpha) * a2 + a1,
                Operation::ModulateInvColorAddAlpha => (1.0 - a1) * a2 + a1_alpha,
                Operation::DotProduct3 => {
                    let [a, b] = [1, 2].map(|slot| value(&half.arguments[slot]));
                    (0..3).map(|n| 4.0 * (a[n] - 0.5) * (b[n] - 0.5)).sum()
                }
                Operation::MultiplyAdd => a0 + a1 * a2,
                Operation::Lerp => a0 * a1 + (1.0 - a0) * a2,
            }
            .clamp(0.0, 1.0)
        };
        let alpha = if stage.color.operation.value == Operation::DotProduct3 { &stage.color } else { &stage.alpha };
        let result = [0, 1, 2, 3].map(|n| if n < 3 { channel(&stage.color, n) } else { channel(alpha, n) });
        match stage.result {
            ResultArgument::Current => current = result,
            ResultArgument::Temp => temp = result,
        }
    }
    finish(current, program.specular_enable, context.fog, pixel)
}

/// Adds the specular colour and applies fog.
pub(super) fn finish(color: [f64; 4], specular: bool, fog: bool, pixel: &Pixel) -> [f64; 4] {
    let [add, mist] = [pixel.specular, pixel.fog].map(Pixel::real);
    let mut result = color;
    for n in 0..3 {
        if specular {
            result[n] = (color[n] + add[n]).min(1.0);
        }
        if fog {
            result[n] = mist[3] * result[n] + (1.0 - mist[3]) * mist[n];
        }
    }
    result
}

fn context(choices: &mut Choices, profile: Profile) -> Context {
    let units = profile.texture_units();
    let bound = std::array::from_fn(|unit| unit < units && choices.below(4) != 0);
    Context { profile, bound, signed: [false; 4], fog: choices.flag() }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Combiners of a random cascade yield the colour that the API defines if they run in real numbers. In integers they stay within the
    /// bound of their rounding.
    #[test]
    fn cascades_are_what_the_api_says(seed in any::<u64>(), nv10 in any::<bool>()) {
        let mut choices = Choices::new(seed);
        let profile = if nv10 { Profile::Nv10 } else { Profile::Nv2a };
        let context = context(&mut choices, profile);
        // Nv10 has room for two stages. Nv2a has room for all stages of the API.
        let program = stages(&mut choices, if nv10 { 2 } else { STAGES });
        match lower(&program, &context) {
            Ok(lowered) => {
                prop_assert!(lowered.combiners.stages.len() <= profile.general_stages());
                prop_assert_eq!(lowered.combiners.stages.len(), lowered.origins.len());
                for _ in 0..4 {
                    let pixel = Pixel::from_choices(&mut choices);
                    let expected = reference(&program, &context, &pixel);
                    let said = agrees(&lowered.combiners, profile, &pixel, expected);
                    prop_assert!(said.is_ok(), "{:?}\n{program:?}\n{pixel:?}\n{:?}", said, lowered.combiners);
                }
            }
            // Nv10 has only two constants, and neither the alpha of the secondary colour nor texture shaders.
            Err(findings) => {
                prop_assert!(nv10, "{findings:?}");
                for finding in &findings {
                    prop_assert!(["NB0309", "NB0340", "NB0351"].contains(&finding.code), "{finding:?}");
                }
            }
        }
    }
}

/// Returns the combiners of a cascade with the given operations in the middle, and whether a unit scales by luminance. Arguments, current
/// colour and textures all differ, so that no two operations yield the same.
fn around(color: Operation, alpha: Operation) -> (Combiners, bool) {
    let argument = |source| Spanned::default_of(StageArgument::new(source));
    let select =
        |source| Half { operation: Spanned::default_of(Operation::SelectArg1), arguments: [source; 3].map(argument) };
    let middle = |operation| Half {
        operation: Spanned::default_of(operation),
        arguments: [ArgumentSource::Specular, ArgumentSource::Diffuse, ArgumentSource::TextureFactor].map(argument),
    };
    let stage = |index, color, alpha| TextureStage { color, alpha, ..TextureStage::initial(index) };
    let first = TextureStage {
        constant: [150, 40, 90, 70],
        ..stage(0, select(ArgumentSource::Constant), select(ArgumentSource::Constant))
    };
    let last = stage(2, select(ArgumentSource::Current), select(ArgumentSource::Current));
    let program = TextureStages {
        stages: vec![first, stage(1, middle(color), middle(alpha)), last],
        texture_factor: [200, 30, 110, 180],
        specular_enable: false,
    };
    let context = Context { profile: Profile::Nv2a, bound: [true; 4], signed: [false; 4], fog: false };
    let lowered = lower(&program, &context).unwrap();
    let luminance = lowered.units.iter().any(|unit| {
        let operation = unit.operation.as_ref().map(|at| at.value);
        matches!(operation, Some(ShaderOperation::BumpEnvironment { luminance: Some(_), .. }))
    });
    (lowered.combiners, luminance)
}

/// Returns whether two programs differ by more than three steps at some pixel.
pub(super) fn told_apart(a: &Combiners, b: &Combiners) -> bool {
    let mut choices = Choices::new(7);
    (0..256).any(|_| {
        let pixel = Pixel::from_choices(&mut choices);
        let [a, b] = [a, b].map(|combiners| run::<i32>(combiners, Profile::Nv2a, &pixel));
        (0..4).any(|n| (a[n] - b[n]).abs() > 3)
    })
}

#[test]
fn every_two_color_operations_differ_somewhere() {
    let programs: Vec<_> = Operation::ALL.iter().map(|op| (op, around(*op, Operation::SelectArg1))).collect();
    for (n, (a, (first, first_luminance))) in programs.iter().enumerate() {
        for (b, (second, second_luminance)) in &programs[..n] {
            // A bump environment map does not change the colour; it changes where the next stage samples.
            if a.is_bump() && (b.is_bump() || **b == Operation::Disable) {
                let bump = a.is_bump() && b.is_bump();
                assert!(!bump || first_luminance != second_luminance, "{a:?} and {b:?}");
                continue;
            }
            assert!(told_apart(first, second), "{a:?} and {b:?}");
        }
    }
}

#[test]
fn every_two_alpha_operations_differ_somewhere() {
    let operations: Vec<_> = Operation::ALL.iter().filter(|op| !op.is_color_only()).collect();
    let programs: Vec<_> = operations.iter().map(|op| around(Operation::SelectArg1, **op).0).collect();
    for n in 0..programs.len() {
        for m in 0..n {
            assert!(told_apart(&programs[n], &programs[m]), "{:?} and {:?}", operations[n], operations[m]);
        }
    }
}

fn codes(program: &TextureStages, profile: Profile) -> Vec<(&'static str, String)> {
    let context = Context { profile, bound: [true, true, false, false], signed: [false; 4], fog: false };
    let findings = lower(program, &context).unwrap_err();
    findings.into_iter().map(|finding| (finding.code, finding.message)).collect()
}

#[test]
fn what_nv10_has_no_room_for() {
    let mut program = TextureStages::default();
    for index in 0..3 {
        let stage = program.stage_mut(index).unwrap();
        stage.color.operation.value = Operation::Add;
        stage.color.arguments[1].value.source = ArgumentSource::Diffuse;
        stage.alpha.arguments[1].value.source = ArgumentSource::Diffuse;
    }
    let said = "this cascade needs 3 general stages; nv10 has 2".to_owned();
    assert_eq!(codes(&program, Profile::Nv10), [("NB0350", said)]);
    for (index, stage) in program.stages.iter_mut().enumerate() {
        stage.constant = [index as u8; 4];
        stage.color.arguments[2].value.source = ArgumentSource::Constant;
    }
    program.stages.truncate(2);
    program.stages[0].alpha.operation.value = Operation::BlendFactorAlpha;
    assert_eq!(codes(&program, Profile::Nv10)[0].0, "NB0351");
    program.stages[0].color.operation.value = Operation::BumpEnvMap;
    assert_eq!(codes(&program, Profile::Nv10)[0].0, "NB0340");
}

#[test]
fn a_dot_product_reaches_alpha_on_both_chips() {
    let mut program = TextureStages::default();
    let stage = program.stage_mut(0).unwrap();
    stage.color.operation.value = Operation::DotProduct3;
    stage.color.arguments[2].value.source = ArgumentSource::Diffuse;
    let context = |profile| Context { profile, bound: [true; 4], signed: [false; 4], fog: false };
    let nv10 = lower(&program, &context(Profile::Nv10)).unwrap().combiners;
    let nv2a = lower(&program, &context(Profile::Nv2a)).unwrap().combiners;
    assert!(!nv10.stages[0].rgb.ab_blue_to_alpha && nv2a.stages[0].rgb.ab_blue_to_alpha);
    let mut choices = Choices::new(3);
    for _ in 0..200 {
        let pixel = Pixel::from_choices(&mut choices);
        assert_eq!(run::<i32>(&nv10, Profile::Nv10, &pixel), run::<i32>(&nv2a, Profile::Nv2a, &pixel));
    }
}

#[test]
fn a_bump_environment_map_moves_the_next_lookup() {
    let mut program = TextureStages::default();
    let stage = program.stage_mut(0).unwrap();
    stage.color.operation.value = Operation::BumpEnvMapLuminance;
    (stage.bump_matrix, stage.bump_luminance) = ([1.0, 2.0, 3.0, 4.0], [0.5, 0.25]);
    program.stage_mut(1).unwrap().color.operation.value = Operation::Modulate;
    let context = Context { profile: Profile::Nv2a, bound: [true; 4], signed: [false; 4], fog: false };
    let lowered = lower(&program, &context).unwrap();
    assert_eq!(lowered.combiners.stages.len(), 1);
    // The registers have the order M00, M01, M11, M10.
    let operation = ShaderOperation::BumpEnvironment { matrix: [1.0, 2.0, 4.0, 3.0], luminance: Some([0.5, 0.25]) };
    assert_eq!(lowered.units[1].operation.as_ref().map(|at| at.value), Some(operation));
}
