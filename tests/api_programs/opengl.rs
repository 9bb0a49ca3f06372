//! Tests the texture environment against the formulas of OpenGL.

use super::Choices;
use super::direct3d::{finish, told_apart};
use super::run::{Pixel, agrees};
use ninebit::state::{Named, Profile, Scale};
use ninebit_program::Spanned;
use ninebit_program::texture_environment::{
    BaseFormat, Context, EnvironmentSource, Function, Half, Mode, Operand, TextureEnvironment, Unit, lower,
};
use proptest::prelude::*;

fn half(choices: &mut Choices, mode: Mode, alpha: bool) -> Half {
    let functions: Vec<Function> = match mode {
        Mode::Combine4 => vec![Function::Add, Function::AddSigned],
        _ => Function::ALL.iter().copied().filter(|function| !(alpha && function.is_dot())).collect(),
    };
    let sources: Vec<EnvironmentSource> = EnvironmentSource::ALL
        .iter()
        .copied()
        .filter(|source| mode == Mode::Combine4 || *source != EnvironmentSource::Zero)
        .collect();
    let operands = if alpha { &Operand::ALL[2..] } else { Operand::ALL };
    Half {
        function: Spanned::default_of(choices.of(&functions)),
        sources: std::array::from_fn(|_| Spanned::default_of(choices.of(&sources))),
        operands: std::array::from_fn(|_| Spanned::default_of(choices.of(operands))),
        scale: choices.of(&[Scale::One, Scale::Two, Scale::Four]),
    }
}

fn environment(choices: &mut Choices, units: usize) -> TextureEnvironment {
    let unit = |choices: &mut Choices| {
        let mode = if choices.flag() { Mode::Combine } else { choices.of(Mode::ALL) };
        Unit {
            mode,
            rgb: half(choices, mode, false),
            alpha: half(choices, mode, true),
            color: choices.color(),
            ..Unit::initial()
        }
    };
    TextureEnvironment { units: (0..units).map(|_| unit(choices)).collect(), color_sum: choices.flag() }
}

/// Returns the colour of a texture after the swizzle of its base format.
fn sampled(pixel: &Pixel, unit: usize, format: BaseFormat) -> [f64; 4] {
    let [r, g, b, a] = Pixel::real(pixel.textures[unit]);
    match format {
        BaseFormat::Alpha => [0.0, 0.0, 0.0, a],
        BaseFormat::Luminance | BaseFormat::Rgb => [r, g, b, 1.0],
        BaseFormat::LuminanceAlpha | BaseFormat::Rgba => [r, g, b, a],
        BaseFormat::Intensity => [r, g, b, b],
    }
}

/// Makes the texture colours of a pixel possible for their formats, with equal channels where the format stores only one.
fn held(pixel: &mut Pixel, textures: &[Option<BaseFormat>; 4]) {
    for (color, format) in pixel.textures.iter_mut().zip(textures) {
        let [r, .., a] = *color;
        match format {
            Some(BaseFormat::Luminance | BaseFormat::LuminanceAlpha) => *color = [r, r, r, a],
            Some(BaseFormat::Intensity) => *color = [r; 4],
            _ => {}
        }
    }
}

fn other(source: EnvironmentSource) -> Option<usize> {
    EnvironmentSource::ALL[1..5].iter().position(|known| *known == source)
}

fn reference(program: &TextureEnvironment, context: &Context, pixel: &Pixel) -> [f64; 4] {
    let primary = Pixel::real(pixel.diffuse);
    let mut previous = primary;
    for (index, format) in context.textures.iter().enumerate() {
        let Some(format) = *format else { continue };
        let unit = &program.units[index];
        let texture = sampled(pixel, index, format);
        let result = match unit.mode {
            Mode::Combine | Mode::Combine4 => combined(unit, index, context, pixel, previous, primary),
            mode => Some(classic(mode, format, texture, previous, Pixel::real(unit.color))),
        };
        if let Some(result) = result {
            previous = result.map(|channel| channel.clamp(0.0, 1.0));
        }
    }
    finish(previous, program.color_sum, context.fog, pixel)
}

/// Returns the colour of a unit in a mode without combining, by the table of base formats: `t` is the texture, `f` the incoming fragment,
/// `c` the environment colour.
fn classic(mode: Mode, format: BaseFormat, t: [f64; 4], f: [f64; 4], c: [f64; 4]) -> [f64; 4] {
    let alpha = t[3];
    let color = |formula: &dyn Fn(usize) -> f64| [formula(0), formula(1), formula(2)];
    let with = |rgb: [f64; 3], a: f64| [rgb[0], rgb[1], rgb[2], a];
    let same = [f[0], f[1], f[2]];
    let times = f[3] * alpha;
    let single = matches!(format, BaseFormat::Luminance | BaseFormat::Rgb);
    let kept = if single { f[3] } else { times };
    match (mode, format) {
        (Mode::Replace, BaseFormat::Alpha) => with(same, alpha),
        (Mode::Replace, _) => with(color(&|n| t[n]), if single { f[3] } else { alpha }),
        (Mode::Modulate, BaseFormat::Alpha) => with(same, times),
        (Mode::Modulate, _) => with(color(&|n| f[n] * t[n]), kept),
        (Mode::Decal, BaseFormat::Rgb) => with(color(&|n| t[n]), f[3]),
        (Mode::Decal, BaseFormat::Rgba) => with(color(&|n| f[n] * (1.0 - alpha) + t[n] * alpha), f[3]),
        (Mode::Decal, _) => f,
        (Mode::Blend, BaseFormat::Alpha) => with(same, times),
        (Mode::Blend, BaseFormat::Intensity) => {
            with(color(&|n| f[n] * (1.0 - t[n]) + c[n] * t[n]), f[3] * (1.0 - alpha) + c[3] * alpha)
        }
        (Mode::Blend, _) => with(color(&|n| f[n] * (1.0 - t[n]) + c[n] * t[n]), kept),
        (Mode::Add, BaseFormat::Alpha) => with(same, times),
        (Mode::Add, BaseFormat::Intensity) => with(color(&|n| f[n] + t[n]), f[3] + alpha),
        (Mode::Add, _) => with(color(&|n| f[n] + t[n]), kept),
        (Mode::Combine | Mode::Combine4, _) => f,
    }
}

fn factor(scale: Scale) -> f64 {
    match scale {
        Scale::Two => 2.0,
        Scale::Four => 4.0,
        _ => 1.0,
    }
}

/// Returns the colour of a combining unit, or `None` if it refers to a texture that is not there and is therefore disabled (crossbar).
fn combined(
    unit: &Unit,
    index: usize,
    context: &Context,
    pixel: &Pixel,
    previous: [f64; 4],
    primary: [f64; 4],
) -> Option<[f64; 4]> {
    let replicated = matches!(unit.rgb.function.value, Function::Dot3RgbaArb | Function::Dot3RgbaExt);
    let four = unit.mode == Mode::Combine4;
    let used = |half: &Half| match half.function.value {
        _ if four => 4,
        Function::Replace => 1,
        Function::Interpolate => 3,
        _ => 2,
    };
    let halves: Vec<&Half> = if replicated { vec![&unit.rgb] } else { vec![&unit.rgb, &unit.alpha] };
    for half in halves {
        for source in &half.sources[..used(half)] {
            if !four && other(source.value).is_some_and(|other| context.textures[other].is_none()) {
                return None;
            }
        }
    }
    let argument = |half: &Half, slot: usize, n: usize| {
        let source = half.sources[slot].value;
        let color = match source {
            EnvironmentSource::Constant => Pixel::real(unit.color),
            EnvironmentSource::PrimaryColor => primary,
            EnvironmentSource::Previous => previous,
            EnvironmentSource::Zero => [0.0; 4],
            _ => {
                let from = other(source).unwrap_or(index);
                context.textures[from].map_or([1.0; 4], |format| sampled(pixel, from, format))
            }
        };
        match half.operands[slot].value {
            Operand::SourceColor => color[n],
            Operand::OneMinusSourceColor => 1.0 - color[n],
            Operand::SourceAlpha => color[3],
            Operand::OneMinusSourceAlpha => 1.0 - color[3],
        }
    };
    let dot: f64 = (0..3).map(|n| 4.0 * (argument(&unit.rgb, 0, n) - 0.5) * (argument(&unit.rgb, 1, n) - 0.5)).sum();
    let channel = |half: &Half, n: usize| {
        let [a0, a1, a2, a3] = [0, 1, 2, 3].map(|slot| argument(half, slot, n));
        let scale = factor(half.scale);
        match half.function.value {
            Function::Add if four => (a0 * a1 + a2 * a3) * scale,
            Function::AddSigned if four => (a0 * a1 + a2 * a3 - 0.5) * scale,
            Function::Replace => a0 * scale,
            Function::Modulate => a0 * a1 * scale,
            Function::Add => (a0 + a1) * scale,
            Function::AddSigned => (a0 + a1 - 0.5) * scale,
            Function::Interpolate => (a0 * a2 + a1 * (1.0 - a2)) * scale,
            Function::Subtract => (a0 - a1) * scale,
            Function::Dot3RgbArb | Function::Dot3RgbaArb => dot * scale,
            Function::Dot3RgbExt | Function::Dot3RgbaExt => dot,
        }
    };
    let alpha = match unit.rgb.function.value {
        Function::Dot3RgbaArb => dot * factor(unit.alpha.scale),
        Function::Dot3RgbaExt => dot,
        _ => channel(&unit.alpha, 3),
    };
    Some([channel(&unit.rgb, 0), channel(&unit.rgb, 1), channel(&unit.rgb, 2), alpha])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Combiners of a random environment yield the colour that the API defines if they run in real numbers. In integers they stay within
    /// the bound of their rounding.
    #[test]
    fn environments_are_what_the_api_says(seed in any::<u64>(), nv10 in any::<bool>()) {
        let mut choices = Choices::new(seed);
        let profile = if nv10 { Profile::Nv10 } else { Profile::Nv2a };
        let units = profile.texture_units();
        let textures = std::array::from_fn(|unit| {
            (unit < units && choices.below(6) != 0).then(|| choices.of(BaseFormat::ALL))
        });
        let context = Context { profile, textures, signed: [false; 4], fog: choices.flag() };
        let program = environment(&mut choices, units);
        match lower(&program, &context) {
            Ok(lowered) => for _ in 0..4 {
                let mut pixel = Pixel::from_choices(&mut choices);
                held(&mut pixel, &textures);
                let expected = reference(&program, &context, &pixel);
                let said = agrees(&lowered.combiners, profile, &pixel, expected);
                prop_assert!(said.is_ok(), "{:?}\n{program:?}\n{pixel:?}\n{:?}", said, lowered.combiners);
            },
            // Some scales need stages of their own, for which nv10 has no room.
            Err(findings) => prop_assert!(nv10 && findings.iter().all(|finding| finding.code == "NB0350"), "{findings:?}"),
        }
    }
}

fn alone(unit: Unit) -> ninebit::state::Combiners {
    let program = TextureEnvironment { units: vec![unit], color_sum: false };
    let textures = [Some(BaseFormat::Rgba), None, None, None];
    lower(&program, &Context { profile: Profile::Nv2a, textures, signed: [false; 4], fog: false }).unwrap().combiners
}

fn all_apart(programs: &[(String, ninebit::state::Combiners)]) {
    for (n, (a, first)) in programs.iter().enumerate() {
        for (b, second) in &programs[..n] {
            assert!(told_apart(first, second), "{a} and {b}");
        }
    }
}

#[test]
fn every_two_modes_and_functions_differ_somewhere() {
    let color = [200, 30, 110, 180];
    let mut programs = Vec::new();
    for mode in Mode::ALL.iter().filter(|mode| !matches!(mode, Mode::Combine | Mode::Combine4)) {
        programs.push((format!("{mode:?}"), alone(Unit { mode: *mode, color, ..Unit::initial() })));
    }
    all_apart(&programs);
    let mut programs = Vec::new();
    for (mode, functions) in [(Mode::Combine, Function::ALL), (Mode::Combine4, &Function::ALL[2..4])] {
        for function in functions {
            let mut unit = Unit { mode, color, ..Unit::initial() };
            unit.rgb.function.value = *function;
            unit.rgb.scale = Scale::Two;
            unit.rgb.sources[3].value = EnvironmentSource::Texture;
            unit.alpha.function.value = if mode == Mode::Combine4 { Function::Add } else { Function::Replace };
            programs.push((format!("{mode:?} {function:?}"), alone(unit)));
        }
    }
    all_apart(&programs);
}

#[test]
fn a_unit_that_reads_a_disabled_texture() {
    let mut unit = Unit { mode: Mode::Combine, ..Unit::initial() };
    unit.rgb.function.value = Function::Replace;
    unit.rgb.sources[0].value = EnvironmentSource::Texture1;
    let passes = alone(unit.clone());
    assert_eq!(passes.stages.len(), 1);
    assert_eq!(passes.stages[0].rgb.inputs[0].register, ninebit::state::Register::PrimaryColor);
    unit.mode = Mode::Combine4;
    unit.rgb.function.value = Function::Add;
    unit.alpha.function.value = Function::Add;
    // The last product is 1 times the previous colour, and the other is 0.
    unit.rgb.operands[3].value = Operand::SourceColor;
    assert_eq!(alone(unit).stages[0].rgb.inputs[0].register, ninebit::state::Register::Zero);
}
