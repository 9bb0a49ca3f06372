//! The generic text against the model: random words of both chips, a pixel of each through compiled C and through a shader. What is not installed is ignored.
//!
//! `NINEBIT_GENERIC_PROGRAMS` says how many programs, `NINEBIT_GENERIC_SEED` chooses others; `CC`, `NINEBIT_LOWER_CFLAGS` and `NINEBIT_LOWER_PYTHON` are as in `languages`.
#![allow(
    missing_docs,
    unreachable_pub,
    clippy::unwrap_used,
    reason = "tests fail by panicking, and the harness needs no documents"
)]

use std::path::Path;
use std::process::Command;

use libtest_mimic::{Arguments, Failed, Trial};
use ninebit::combiner::direct::Direct;
use ninebit::combiner::registers::Registers;
use ninebit::random::Random;
use ninebit::rop::{blend, surface};
use ninebit::state::{
    Blend, BlendEquation, BlendFactor, CompareFunction, Named, POLICIES, Policies, Profile, Register, SurfaceFormat,
};
use ninebit::trace::Silent;
use ninebit_lower::Generic;
use ninebit_program::registers::raster::{self, Method};
use ninebit_program::registers::{RegisterWords, Word, decode, refusal, stored};

/// Words of a pixel: state, inputs, what is expected.
const COLUMNS: usize = 128;
/// Primary, secondary, fog, four textures, destination.
const INPUTS: usize = 29;

fn setting(name: &str) -> Option<u64> {
    std::env::var(name).ok().map(|text| text.parse().unwrap_or_else(|_| panic!("{name} is no number: {text}")))
}

/// Words that the chip takes. What is 0 is often so: the text leaves out what is.
fn words(chip: Profile, random: &mut Random) -> RegisterWords {
    let mut words = RegisterWords::new(chip);
    let all: Vec<(Word, usize)> = words.all().map(|(word, index, _)| (word, index)).collect();
    for (word, index) in all {
        loop {
            let mut value = stored(word, index, random.bits() as u32, chip);
            for byte in [0xff, 0xff00, 0xff_0000, 0xff00_0000_u32] {
                if random.once_in(if matches!(word, Word::RcFinal0 | Word::RcFinal1) { 3 } else { 5 }) {
                    value &= !byte;
                }
            }
            if random.once_in(6) && matches!(word, Word::RcInRgb | Word::RcFinal0) {
                value &= 0xffff_0000;
            }
            if refusal(word, index, value, chip).is_none() {
                words.set(word, index, value);
                break;
            }
        }
    }
    words
}

/// State, inputs and stored word of pixels of random programs, `rows` of each.
fn pixels(generic: &Generic, programs: usize, rows: usize, random: &mut Random) -> Vec<u32> {
    let chip = generic.chip;
    let members = generic.words();
    let state: usize = members.iter().map(|(_, count, _)| count).sum();
    assert!(state + INPUTS < COLUMNS);
    let mut out = Vec::with_capacity(programs * rows * COLUMNS);
    for _ in 0..programs {
        let words = words(chip, random);
        let program = decode(&words).unwrap();
        let function = random.pick(CompareFunction::ALL).unwrap();
        let equations: Vec<_> =
            BlendEquation::ALL.iter().filter(|one| chip == Profile::Nv2a || !one.is_nv2a_only()).collect();
        let formats: Vec<_> =
            SurfaceFormat::ALL.iter().filter(|one| chip == Profile::Nv2a || !one.is_nv2a_only()).collect();
        let [tests, blends] = [2, 2].map(|n| random.once_in(n));
        let [source, destination] = [0; 2].map(|_| random.pick(BlendFactor::ALL).unwrap());
        let (equation, format) = (*random.pick(&equations).unwrap(), *random.pick(&formats).unwrap());
        let (reference, constant) = (random.below(256) as u32, random.bits() as u32);
        let mask = if random.once_in(2) { 0x0101_0101 } else { random.bits() as u32 & 0x0101_0101 };
        let raster = |method: Method| match method {
            Method::SurfaceFormat => raster::surface_format(format),
            Method::AlphaTestEnable => tests.into(),
            Method::BlendEnable => blends.into(),
            Method::AlphaFunc => raster::compare_function(function),
            Method::AlphaRef => reference,
            Method::BlendFuncSfactor => raster::blend_factor(source),
            Method::BlendFuncDfactor => raster::blend_factor(destination),
            Method::BlendColor => constant,
            Method::BlendEquation => raster::blend_equation(equation),
            Method::ColorMask => mask,
        };
        let mut given: Vec<u32> = words.all().map(|(_, _, value)| value).collect();
        given.extend(Method::ALL.iter().map(|method| raster(*method)));
        assert_eq!(given.len(), state);
        for _ in 0..rows {
            let start = out.len();
            out.extend(&given);
            let mut registers = Registers::new();
            for register in [
                Register::PrimaryColor,
                Register::SecondaryColor,
                Register::Fog,
                Register::Texture0,
                Register::Texture1,
                Register::Texture2,
                Register::Texture3,
            ] {
                let low = if register as usize >= Register::Texture0 as usize { -256 } else { 0 };
                let channel = |_: usize| match random.below(8) {
                    0 => 255,
                    1 => low,
                    2 => 128,
                    _ => low + random.below((256 - low) as u128) as i32,
                };
                let value = [0, 1, 2, 3].map(channel);
                registers.load(register, value);
                out.extend(value.map(|channel| channel as u32));
            }
            let held = random.bits() as u32;
            out.push(held);
            let fragment = program.run(registers, &generic.policies);
            let kept = !tests || function.passes(u32::from(fragment[3]), reference);
            let mut channels = fragment.map(i32::from);
            if blends && surface::blends(format) {
                let state = Blend { equation, source, destination };
                let from = blend::truncated(format, channels, &mut Direct::plain(&mut Silent));
                let [b, g, r, a] = constant.to_le_bytes();
                let to = surface::read(format, held).map(i32::from);
                channels = blend::run(&state, 15, [r, g, b, a], &from, &to, &mut Silent);
            }
            let written = [16, 8, 0, 24].map(|bit| mask >> bit & 1 == 1);
            let word = surface::pack(format, channels.map(|channel| channel as u8));
            let after = surface::masked(held, word, surface::write_mask(format, written));
            out.push(if kept { after } else { held });
            out.resize(start + COLUMNS, 0);
        }
    }
    out
}

/// Generic texts: both chips as they are, and now and then under other policies.
fn generic(n: usize, random: &mut Random) -> Generic {
    let chip = if n % 3 == 2 { Profile::Nv10 } else { Profile::Nv2a };
    let mut policies = Policies::DEFAULT;
    if n % 4 == 3 {
        for policy in POLICIES {
            let (value, _) = random.pick(policy.values).unwrap();
            policies.set(&format!("{}={value}", policy.rule)).unwrap();
        }
    }
    Generic { chip, policies }
}

fn run(command: &mut Command, folder: &Path) -> Result<(), Failed> {
    let output = command.current_dir(folder).output().map_err(|error| format!("{command:?}: {error}"))?;
    if output.status.success() {
        return Ok(());
    }
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    Err(format!("{command:?}:\n{}", text.chars().take(4000).collect::<String>()).into())
}

/// Reads pixels from a file and compares what they come to.
const MAIN: &str = r#"
#include "ninebit_combiners.h"
#include <stdio.h>
#include <string.h>

int main(void)
{
    static uint32_t row[128];
    FILE *file = fopen("pixels.bin", "rb");
    long n = 0, wrong = 0;
    if (!file) return 2;
    while (fread(row, sizeof row, 1, file) == 1) {
        struct nb_state state;
        struct nb_inputs inputs;
        uint32_t got, want;
        memcpy(&state, row, sizeof state);
        memcpy(&inputs, row + sizeof state / 4, sizeof inputs);
        want = row[(sizeof state + sizeof inputs) / 4];
        got = nb_pixel(&state, &inputs);
        if (got != want && wrong++ == 0) printf("pixel %ld: %08x, not %08x\n", n, (unsigned)got, (unsigned)want);
        n++;
    }
    fclose(file);
    printf("%ld pixels, %ld wrong\n", n, wrong);
    return wrong != 0 || n == 0;
}
"#;

fn compile(text: &Generic, change: impl Fn(String) -> String, folder: &Path) -> Result<(), Failed> {
    let sources = text.c99();
    for (name, text) in [
        ("ninebit_combiners.h", sources.header),
        ("ninebit_combiners.c", change(sources.source)),
        ("main.c", MAIN.to_string()),
    ] {
        std::fs::write(folder.join(name), text)?;
    }
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_string());
    let flags = std::env::var("NINEBIT_LOWER_CFLAGS").unwrap_or_default();
    let mut build = Command::new(compiler);
    build.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-O1"]).args(flags.split_whitespace());
    run(build.args(["-o", "pixels", "main.c", "ninebit_combiners.c"]), folder)
}

/// The longest that the C is allowed to be.
const LINES: usize = 1500;

fn c99() -> Result<(), Failed> {
    let programs = setting("NINEBIT_GENERIC_PROGRAMS").map_or(4000, |n| n as usize);
    let mut random = Random::seeded(setting("NINEBIT_GENERIC_SEED").unwrap_or(23));
    let folder = tempfile::tempdir()?;
    let batch = programs.div_ceil(12).min(5000);
    for (n, first) in (0..programs).step_by(batch).enumerate() {
        let text = generic(n, &mut random);
        let sources = text.c99();
        let lines = sources.header.lines().count() + sources.source.lines().count();
        assert!(lines <= LINES, "{lines} lines");
        compile(&text, |source| source, folder.path())?;
        let pixels = pixels(&text, batch.min(programs - first), 4, &mut random);
        std::fs::write(folder.path().join("pixels.bin"), bytes(&pixels))?;
        run(&mut Command::new("./pixels"), folder.path())
            .map_err(|failed| format!("batch {n}, {text:?}: {}", failed.message().unwrap_or_default()))?;
    }
    println!("generic C: {programs} programs, 4 pixels each");
    Ok(())
}

/// An operator, a constant, a name that an engineer might have got wrong: in every function some are noticed, and so is each that changes what a program of the sample reads.
fn errors_are_noticed() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let mut random = Random::seeded(7);
    let text = Generic { chip: Profile::Nv2a, policies: Policies::DEFAULT };
    let pixels = pixels(&text, 6000, 4, &mut random);
    std::fs::write(folder.path().join("pixels.bin"), bytes(&pixels))?;
    let source = text.c99().source;
    let lines: Vec<&str> = source.lines().collect();
    let first = lines.iter().position(|line| line.contains("nb_color(")).unwrap();
    let swaps = [
        (" + ", " - "),
        (" / 510", " / 512"),
        ("_least(", "_greatest("),
        ("[0]", "[1]"),
        ("128", "127"),
        (" & 15u", " & 7u"),
    ];
    let (mut planted, mut missed) = (0, Vec::new());
    for (from, to) in swaps {
        let all: Vec<usize> = (first..lines.len()).filter(|n| lines[*n].contains(from)).collect();
        for at in all.iter().step_by(all.len().div_ceil(2)) {
            let mut changed = lines.clone();
            let line = changed[*at].replacen(from, to, 1);
            changed[*at] = &line;
            let changed = changed.join("\n") + "\n";
            planted += 1;
            if compile(&text, |_| changed.clone(), folder.path()).is_ok()
                && run(&mut Command::new("./pixels"), folder.path()).is_ok()
            {
                missed.push(line);
            }
        }
    }
    println!("{} of {planted} planted errors noticed", planted - missed.len());
    if missed.is_empty() { Ok(()) } else { Err(missed.join("\n").into()) }
}

/// One shader for all programs: each pixel has the words of its own.
fn glsl() -> Result<(), Failed> {
    let programs = setting("NINEBIT_GENERIC_PROGRAMS").map_or(2048, |n| n as usize).min(16384).next_multiple_of(64);
    let mut random = Random::seeded(setting("NINEBIT_GENERIC_SEED").unwrap_or(23));
    let folder = tempfile::tempdir()?;
    // Compiling such a shader takes long.
    let texts: &[usize] = if setting("NINEBIT_GENERIC_PROGRAMS").is_some() { &[0, 2, 3] } else { &[0] };
    for n in texts.iter().copied() {
        let text = generic(n, &mut random);
        let (mut body, mut column) = (String::new(), 0);
        let mut next = || {
            column += 1;
            format!("given({})", column - 1)
        };
        for (name, count, _) in text.words() {
            for at in 0..count {
                let place = if count > 1 { format!("{name}[{at}]") } else { name.to_string() };
                body.push_str(&format!("    state.{place} = uint({});\n", next()));
            }
        }
        for place in ["primary", "secondary", "fog", "texture[0]", "texture[1]", "texture[2]", "texture[3]"] {
            let all: Vec<String> = (0..4).map(|_| next()).collect();
            body.push_str(&format!("    inputs.{place} = ivec4({});\n", all.join(", ")));
        }
        body.push_str(&format!("    inputs.destination = uint({});\n", next()));
        let shader = format!(
            "#version 330\n{}\nuniform isampler2D pool;\nout uvec4 result;\nint given(int column) {{ return texelFetch(pool, ivec2(column, \
             int(gl_FragCoord.y) * 64 + int(gl_FragCoord.x)), 0).r; }}\nvoid main()\n{{\n    NinebitState state;\n    NinebitInputs inputs;\n{body}    \
             result = uvec4(nb_pixel(state, inputs), 0u, 0u, 0u);\n}}\n",
            text.glsl()
        );
        let pixels = pixels(&text, programs, 1, &mut random);
        let expected: Vec<u32> = pixels.chunks_exact(COLUMNS).flat_map(|row| [row[column], 0, 0, 0]).collect();
        std::fs::write(folder.path().join("00000.glsl"), shader)?;
        std::fs::write(folder.path().join("pool.bin"), bytes(&pixels))?;
        std::fs::write(folder.path().join("expected.bin"), bytes(&expected))?;
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tools/glsl.py");
        let mut command = Command::new(python());
        command
            .env("LIBGL_ALWAYS_SOFTWARE", "1")
            .env("GALLIUM_DRIVER", "llvmpipe")
            .env("NINEBIT_COLUMNS", COLUMNS.to_string());
        run(command.arg(script).arg("1"), folder.path())?;
        println!("generic GLSL of {:?}: {programs} programs", text.chip);
    }
    Ok(())
}

fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

fn python() -> String {
    std::env::var("NINEBIT_LOWER_PYTHON").unwrap_or_else(|_| "python3".to_string())
}

fn works(program: &str, arguments: &[&str]) -> bool {
    Command::new(program).args(arguments).output().is_ok_and(|output| output.status.success())
}

fn main() {
    let arguments = Arguments::from_args();
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_string());
    let compiles = works(&compiler, &["--version"]);
    let draws = works(&python(), &["-c", "import moderngl, numpy"]);
    let trials = vec![
        Trial::test("c99", c99).with_ignored_flag(!compiles),
        Trial::test("planted errors are noticed", errors_are_noticed).with_ignored_flag(!compiles),
        Trial::test("glsl", glsl).with_ignored_flag(!draws),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}
