//! One unit of the OpenGL texture environment.

use super::program::{self, RULES, Through, lowered_by};
use super::{Column, Conditions, Kind, Reach, Unit, bytes, colors, named, paired, put};
use ninebit::state::{Combiners, Named, Profile, Register, Scale};
use ninebit::trace::{Recorder, Silent};
use ninebit_program::Spanned;
use ninebit_program::texture_environment::{
    BaseFormat, Context, EnvironmentSource, Function, Half, Mode, Operand, TextureEnvironment, Unit as Environment,
    lower,
};

/// Returns a column of the variants for which `wanted` is true.
pub(super) fn some<T: Named>(name: &str, wanted: impl Fn(T) -> bool) -> Column {
    let numbers: Vec<i64> = (0..).zip(T::ALL).filter(|(_, variant)| wanted(**variant)).map(|(n, _)| n).collect();
    Column::listed(name, Kind::Name(T::NAMES), &numbers)
}

fn is_combining(mode: Mode) -> bool {
    matches!(mode, Mode::Combine | Mode::Combine4)
}

/// Returns the lowered unit with a texture of that format, or `None` if the chip cannot run it.
fn lowered(unit: Environment, format: BaseFormat, profile: Profile) -> Option<Combiners> {
    let environment = TextureEnvironment { units: vec![unit], color_sum: false };
    let textures = [Some(format), None, None, None];
    let context = Context { profile, textures, signed: [false; 4], fog: false };
    lower(&environment, &context).map(|lowered| lowered.combiners).ok()
}

/// Returns the registers of a pixel: the texture's inputs from `first` on, then those of the primary colour.
fn places(first: usize) -> [(Register, usize); 2] {
    [(Register::Texture0, first), (Register::PrimaryColor, first + 4)]
}

/// The modes of OpenGL 1.1.
pub(super) struct Classic;

/// Returns a colour as a texture of a base format stores it.
fn as_format(format: BaseFormat, [r, g, b, a]: [i64; 4]) -> [i64; 4] {
    match format {
        BaseFormat::Alpha => [0, 0, 0, a],
        BaseFormat::Luminance => [r, r, r, 255],
        BaseFormat::LuminanceAlpha => [r, r, r, a],
        BaseFormat::Intensity => [r; 4],
        BaseFormat::Rgb => [r, g, b, 255],
        BaseFormat::Rgba => [r, g, b, a],
    }
}

fn texture(inputs: &[i64]) -> [i64; 4] {
    as_format(named(inputs[1]), std::array::from_fn(|n| inputs[2 + n]))
}

fn classic(inputs: &[i64], profile: Profile) -> Option<Combiners> {
    let unit = Environment { mode: named(inputs[0]), color: bytes(&inputs[10..14]), ..Environment::initial() };
    lowered(unit, named(inputs[1]), profile)
}

impl Unit for Classic {
    known_as!(
        "texture-environment", RULES,
        "an OpenGL texture unit in the modes Replace, Modulate, Decal, Blend and Add, by the texture's base format", Direct;
        takes [
            some("cfg.mode", |mode| !is_combining(mode)),
            Column::choice::<BaseFormat>("cfg.base_format"),
            colors(&["texture", "primary", "constant"]),
        ];
        gives [program::results()]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        inputs[2..6] == texture(inputs)
    }

    fn fit(&self, inputs: &mut [i64]) {
        let held = texture(inputs);
        inputs[2..6].copy_from_slice(&held);
    }

    lowered_by!(classic, |_| places(2), |_, varying| Through::of_column(varying, 2, 10));
}

/// The combine functions.
pub(super) struct Combine;

const SOURCES: [EnvironmentSource; 4] = [
    EnvironmentSource::Texture,
    EnvironmentSource::PrimaryColor,
    EnvironmentSource::Constant,
    EnvironmentSource::Texture,
];

/// Returns the operand that alpha can have in its place.
fn of_alpha(operand: Operand) -> Operand {
    match operand {
        Operand::SourceColor | Operand::SourceAlpha => Operand::SourceAlpha,
        Operand::OneMinusSourceColor | Operand::OneMinusSourceAlpha => Operand::OneMinusSourceAlpha,
    }
}

fn combine(inputs: &[i64], profile: Profile) -> Option<Combiners> {
    let (function, scale): (Function, Scale) = (named(inputs[1]), named(inputs[2]));
    let operands: [Operand; 4] = std::array::from_fn(|n| named(inputs[3 + n]));
    let half = |function, operands: [Operand; 4]| Half {
        function: Spanned::default_of(function),
        sources: SOURCES.map(Spanned::default_of),
        operands: operands.map(Spanned::default_of),
        scale,
    };
    let alpha = if function.is_dot() { Function::Modulate } else { function };
    let unit = Environment {
        mode: named(inputs[0]),
        rgb: half(function, operands),
        alpha: half(alpha, operands.map(of_alpha)),
        color: bytes(&inputs[15..19]),
        ..Environment::initial()
    };
    lowered(unit, BaseFormat::Rgba, profile)
}

impl Unit for Combine {
    known_as!(
        "texture-combine", RULES,
        "an OpenGL texture unit in the modes Combine and Combine4: arguments 0 to 3 are the texture, the primary colour, the constant and the texture; alpha has the same function, or Modulate beside a dot product of R, G, B alone", Direct;
        takes [
            some("cfg.mode", is_combining),
            Column::choice::<Function>("cfg.function"),
            some("cfg.scale", |scale: Scale| scale != Scale::Half),
            ["cfg.operand0", "cfg.operand1", "cfg.operand2", "cfg.operand3"].map(Column::choice::<Operand>),
            colors(&["texture", "primary", "constant"]),
        ];
        gives [program::results()]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        let (mode, function): (Mode, Function) = (named(inputs[0]), named(inputs[1]));
        let legal = mode == Mode::Combine || matches!(function, Function::Add | Function::AddSigned);
        legal && function.reads(mode).iter().zip(&inputs[3..7]).all(|(reads, operand)| *reads || *operand == 0)
    }

    fn fit(&self, inputs: &mut [i64]) {
        if named::<Mode>(inputs[0]) == Mode::Combine4 {
            let functions = [Function::Add, Function::AddSigned];
            inputs[1] = functions[inputs[1] as usize % 2] as i64;
        }
        let reads = named::<Function>(inputs[1]).reads(named(inputs[0]));
        for (operand, _) in inputs[3..7].iter_mut().zip(reads).filter(|(_, reads)| !reads) {
            *operand = 0;
        }
    }

    lowered_by!(combine, |_| places(7), |_, varying| Through::of_column(varying, 7, 15));
}
