//! Writes the tables of `docs/languages/programs.md`, `docs/languages/pixel-shader.md` and `docs/languages/registers.md`: the combiners that each operation becomes, as
//! the lowering yields them, and the register words of the chips.

use crate::repository::at;
use std::fs;

use crate::pages::hold;
use ninebit::state::{Combiners, Named, Profile};
use ninebit_program::Spanned;
use ninebit_program::pixel_shader;
use ninebit_program::registers::Word;
use ninebit_program::text::print;
use ninebit_program::texture_environment::{
    self as environment, BaseFormat, EnvironmentSource, Function, Mode, Operand,
};
use ninebit_program::texture_stages::{self as stages, ArgumentSource, Half, Operation, StageArgument, TextureStage};

/// Returns the RGB portion of a general stage as statements of the combiner language.
fn portion(combiners: &Combiners, stage: usize) -> String {
    let text = print(combiners);
    let inside =
        text.split("rgb {").nth(stage + 1).unwrap_or_else(|| panic!("stage {stage} writes no colour:\n{text}"));
    let lines: Vec<&str> = inside.split('}').next().unwrap().lines().map(str::trim).filter(|l| !l.is_empty()).collect();
    format!("`{}`", lines.join(" "))
}

/// Returns the doc comments on the variants of an enumeration, in order, without the full stop.
fn comments(file: &str, enumeration: &str) -> Vec<String> {
    let source = fs::read_to_string(at(file)).unwrap();
    // The line of a variant may be followed by values of its own with their comments.
    let (_, rest) = source.split_once(&format!("pub enum {enumeration} ")).unwrap();
    let body = rest.split_once("{\n").unwrap().1.split("\n    }").next().unwrap();
    let lines = body.lines().filter_map(|line| line.trim().strip_prefix("/// "));
    lines.map(|line| line.trim_end_matches('.').to_owned()).collect()
}

fn written<T>(value: T) -> Spanned<T> {
    Spanned::default_of(value)
}

/// Returns the statements that the stage of a Direct3D operation becomes. The arguments are the specular colour (a0), the texture (a1) and
/// the diffuse colour (a2).
fn direct3d(operation: Operation) -> String {
    if operation == Operation::Disable || operation.is_bump() {
        return String::new();
    }
    let half = |operation| Half {
        operation: written(operation),
        arguments: [ArgumentSource::Specular, ArgumentSource::Texture, ArgumentSource::Diffuse]
            .map(|source| written(StageArgument::new(source))),
    };
    let stage = TextureStage { color: half(operation), ..TextureStage::initial(0) };
    let next = TextureStage { color: half(Operation::SelectArg2), ..TextureStage::initial(1) };
    let program = stages::TextureStages { stages: vec![stage, next], ..Default::default() };
    let context = stages::Context { profile: Profile::Nv2a, bound: [true; 4], signed: [false; 4], fog: false };
    portion(&stages::lower(&program, &context).unwrap().combiners, 0)
}

#[test]
fn direct3d_operations() {
    let meanings = comments("src/program/texture_stages/operation.rs", "Operation");
    let mut table = "| operation | value | result | RGB of the general stage |\n|---|---:|---|---|\n".to_owned();
    for (operation, meaning) in Operation::ALL.iter().zip(meanings) {
        let (value, result) = meaning.split_once(": ").unwrap();
        table += &format!("| `{}` | {value} | {result} | {} |\n", operation.name(), direct3d(*operation));
    }
    hold("docs/languages/programs.md", "tests/api_programs (Direct3D)", &table);
}

/// Returns the statements that the unit of an OpenGL function becomes. The arguments are the texture (a0), the primary colour (a1), the
/// alpha of the environment colour (a2) and, for `Combine4`, the texture again (a3).
fn opengl(mode: Mode, function: Function) -> String {
    let sources = [
        EnvironmentSource::Texture,
        EnvironmentSource::PrimaryColor,
        EnvironmentSource::Constant,
        EnvironmentSource::Texture,
    ];
    let mut unit = environment::Unit { mode, color: [255, 128, 64, 128], ..environment::Unit::initial() };
    unit.rgb.function = written(function);
    unit.rgb.sources = sources.map(written);
    unit.rgb.operands[3] = written(Operand::SourceColor);
    if mode == Mode::Combine4 {
        unit.alpha.function = written(function);
    }
    let program = environment::TextureEnvironment { units: vec![unit], color_sum: false };
    let textures = [Some(BaseFormat::Rgba), None, None, None];
    let context = environment::Context { profile: Profile::Nv2a, textures, signed: [false; 4], fog: false };
    portion(&environment::lower(&program, &context).unwrap().combiners, 0)
}

#[test]
fn opengl_functions() {
    let meanings = comments("src/program/texture_environment/mod.rs", "Function");
    let mut table = "| function | result | RGB of the general stage |\n|---|---|---|\n".to_owned();
    for (function, meaning) in Function::ALL.iter().zip(meanings) {
        let combine = opengl(Mode::Combine, *function);
        let meant = meaning.split(". Combine4: ").next().unwrap();
        table += &format!("| `{}` | {meant} | {combine} |\n", function.name());
        if let Some(sums) = meaning.split("Combine4: ").nth(1) {
            table +=
                &format!("| `{}` of `Combine4` | {sums} | {} |\n", function.name(), opengl(Mode::Combine4, *function));
        }
    }
    hold("docs/languages/programs.md", "tests/api_programs (OpenGL)", &table);
}

#[test]
fn pixel_shader_instructions() {
    let meanings = comments("src/program/pixel_shader/mod.rs", "Operation");
    let mut table = "| instruction | result | RGB of the general stage |\n|---|---|---|\n".to_owned();
    for (operation, meaning) in pixel_shader::Operation::ALL.iter().zip(meanings) {
        let name = operation.name();
        let sources = match name {
            "cnd" => "r0.a, t0, v0",
            _ => ["t0", "t0, v0", "t0, v0, v1"][operation.sources() - 1],
        };
        let before = if name == "cnd" { "mov r0, v1\n" } else { "" };
        let shader = pixel_shader::parse(&format!("ps.1.1\ntex t0\n{before}{name} r0, {sources}\n")).unwrap().program;
        let lowered = pixel_shader::lower(&shader, &pixel_shader::Context::new(Profile::Nv2a)).unwrap();
        let stage = portion(&lowered.combiners, usize::from(name == "cnd"));
        table += &format!("| `{name} r0, {sources}` | {meaning} | {stage} |\n");
    }
    hold("docs/languages/pixel-shader.md", "tests/api_programs (arithmetic)", &table);
}

/// Returns a shader that ends with the given texture instruction, and the number of the register that the instruction loads.
fn texture_shader(name: &str) -> (String, usize) {
    let (before, operands, register) = match name {
        "tex" | "texcoord" | "texkill" => ("", "t0", 0),
        "texbem" | "texbeml" | "texreg2ar" | "texreg2gb" => ("tex t0", "t1, t0", 1),
        "texm3x2pad" | "texm3x3pad" => ("tex t0", "t1, t0", 1),
        "texm3x2tex" => ("tex t0\ntexm3x2pad t1, t0", "t2, t0", 2),
        "texm3x3spec" => ("tex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0", "t3, t0, c0", 3),
        _ => ("tex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0", "t3, t0", 3),
    };
    let after = match name {
        "texm3x2pad" => "texm3x2tex t2, t0\n",
        "texm3x3pad" => "texm3x3pad t2, t0\ntexm3x3tex t3, t0\n",
        _ => "",
    };
    (format!("ps.1.1\n{before}\n{name} {operands}\n{after}mov r0, v0\n"), register)
}

#[test]
fn texture_instructions() {
    let meanings = comments("src/program/pixel_shader/mod.rs", "TextureOperation");
    let mut context = pixel_shader::Context::new(Profile::Nv2a);
    for bump in &mut context.bumps {
        *bump = pixel_shader::Bump { matrix: Some([1.0, 0.0, 0.0, 1.0]), luminance: Some([1.0, 0.0]) };
    }
    let mut table = "| instruction | operation of the unit | meaning |\n|---|---|---|\n".to_owned();
    for (operation, meaning) in pixel_shader::TextureOperation::ALL.iter().zip(meanings) {
        let (text, register) = texture_shader(operation.name());
        let shader = pixel_shader::parse(&text).unwrap_or_else(|error| panic!("{text}{error:?}")).program;
        let lowered = pixel_shader::lower(&shader, &context).unwrap_or_else(|error| panic!("{text}{error:?}"));
        let does = format!("{:?}", lowered.units[register].as_ref().unwrap().operation);
        let does = does.split(|c: char| !c.is_ascii_alphanumeric()).next().unwrap();
        let written = text.lines().find(|line| line.split(' ').next() == Some(operation.name())).unwrap();
        table += &format!("| `{written}` | `{does}` | {meaning} |\n");
    }
    hold("docs/languages/pixel-shader.md", "tests/api_programs (textures)", &table);
}

/// Returns the statements for colour and alpha that a unit in a mode without combining becomes. The environment colour is const0.
fn classic(mode: Mode, format: BaseFormat) -> [String; 2] {
    let unit = environment::Unit { mode, color: [255, 128, 64, 128], ..environment::Unit::initial() };
    let program = environment::TextureEnvironment { units: vec![unit], color_sum: false };
    let textures = [Some(format), None, None, None];
    let context = environment::Context { profile: Profile::Nv2a, textures, signed: [false; 4], fog: false };
    let text = print(&environment::lower(&program, &context).unwrap().combiners);
    ["rgb {", "alpha {"].map(|portion| {
        let inside = text.split(portion).nth(1).and_then(|rest| rest.split('}').next()).unwrap_or_default();
        let lines: Vec<&str> = inside.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        format!("`{}`", lines.join(" "))
    })
}

#[test]
fn opengl_modes() {
    let mut table = "| mode | base format | RGB | alpha |\n|---|---|---|---|\n".to_owned();
    for mode in Mode::ALL.iter().filter(|mode| !matches!(mode, Mode::Combine | Mode::Combine4)) {
        for format in BaseFormat::ALL {
            let [color, alpha] = classic(*mode, *format);
            table += &format!("| `{}` | `{}` | {color} | {alpha} |\n", mode.name(), format.name());
        }
    }
    hold("docs/languages/programs.md", "tests/api_programs (OpenGL's modes)", &table);
}

#[test]
fn register_words() {
    let meanings = comments("src/program/registers/mod.rs", "Word");
    let mut table = "| word | nv10: method, words | nv20: method, words | content |\n|---|---|---|---|\n".to_owned();
    for (word, meaning) in Word::ALL.iter().zip(meanings) {
        let [nv10, nv20] = [Profile::Nv10, Profile::Nv2a].map(|chip| match word.count(chip) {
            0 => String::new(),
            count => format!("{:04x}, {count}", word.method(chip)),
        });
        table += &format!("| `{}` | {nv10} | {nv20} | {meaning} |\n", word.name());
    }
    hold("docs/languages/registers.md", "tests/api_programs", &table);
}
