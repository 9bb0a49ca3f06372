//! Compares the generic text with the model: random words of both chips, and pixels of each through compiled C and through a shader. Tests whose
//! tools are not installed are ignored.
//!
//! `NINEBIT_GENERIC_PROGRAMS` is the number of programs, `NINEBIT_GENERIC_LEVEL=1` uses tables of level L1, `NINEBIT_GENERIC_SEED` selects other
//! programs; `CC`, `NINEBIT_LOWER_CFLAGS` and `NINEBIT_LOWER_PYTHON` are as in `languages`.
#![allow(missing_docs, unreachable_pub, dead_code, reason = "modules share files of which each uses its part")]
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

#[path = "common/setting.rs"]
mod setting;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use libtest_mimic::{Arguments, Failed, Trial};
use ninebit::combiner::direct::Direct;
use ninebit::combiner::registers::Registers;
use ninebit::random::Random;
use ninebit::rop::{blend, surface};
use ninebit::state::*;
use ninebit::trace::Silent;
use ninebit_lower::Generic;
use ninebit_program::registers::raster::{self, Method};
use ninebit_program::registers::{RegisterWords, Word, decode, encode, refusal, stored};
use ninebit_vectors::cases::Level;
use ninebit_vectors::gpu::{self, Case, recipes};
use ninebit_vectors::table::{Contents, Writer};
use ninebit_vectors::units;
use setting::{GIVEN, any_policies, any_value, bytes, compiler, drawing, python, run, setting, works};

/// Number of words for a pixel: state, inputs, expected word.
const COLUMNS: usize = 128;
/// Number of words for inputs: primary, secondary, fog, four textures, destination.
const INPUTS: usize = 29;

/// Returns random words that the chip accepts. Many bytes are 0, because the text skips what is 0.
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

/// Returns state, inputs and stored word for pixels of random programs, `rows` for each program.
fn pixels(generic: &Generic, programs: usize, rows: usize, random: &mut Random) -> Vec<u32> {
    let chip = generic.chip;
    let state: usize = generic.words().iter().map(|(_, count, _)| count).sum();
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
            for register in GIVEN {
                let value = any_value(register, random);
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

/// Returns the options of a generic text: both chips, mostly with the default policies.
fn generic(n: usize, random: &mut Random) -> Generic {
    let chip = if n % 3 == 2 { Profile::Nv10 } else { Profile::Nv2a };
    let policies = if n % 4 == 3 { any_policies(random) } else { Policies::DEFAULT };
    Generic { chip, policies }
}

/// C program that reads pixels from a file and compares results; with an argument it also prints them.
const MAIN: &str = r#"
#include "ninebit_combiners.h"
#include <stdio.h>
#include <string.h>

int main(int count, char **arguments)
{
    static uint32_t row[128];
    FILE *file = fopen("pixels.bin", "rb");
    long n = 0, wrong = 0;
    (void)arguments;
    if (!file) return 2;
    while (fread(row, sizeof row, 1, file) == 1) {
        struct nb_state state;
        struct nb_inputs inputs;
        uint32_t got, want;
        memcpy(&state, row, sizeof state);
        memcpy(&inputs, row + sizeof state / 4, sizeof inputs);
        want = row[(sizeof state + sizeof inputs) / 4];
        got = nb_pixel(&state, &inputs);
        if (count > 1) printf("%08x\n", (unsigned)got);
        if (got != want && wrong++ == 0) fprintf(stderr, "pixel %ld: %08x, not %08x\n", n, (unsigned)got, (unsigned)want);
        n++;
    }
    fclose(file);
    fprintf(stderr, "%ld pixels, %ld wrong\n", n, wrong);
    return wrong != 0 || n == 0;
}
"#;

fn compile(text: &Generic, level: &str, change: impl Fn(String) -> String, folder: &Path) -> Result<(), Failed> {
    let sources = text.c99();
    for (name, text) in [
        ("ninebit_combiners.h", sources.header),
        ("ninebit_combiners.c", change(sources.source)),
        ("main.c", MAIN.to_string()),
    ] {
        std::fs::write(folder.join(name), text)?;
    }
    let flags = std::env::var("NINEBIT_LOWER_CFLAGS").unwrap_or_default();
    let mut build = Command::new(compiler());
    build.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", level]).args(flags.split_whitespace());
    Ok(run(build.args(["-o", "pixels", "main.c", "ninebit_combiners.c"]), folder)?)
}

/// Largest number of lines that the C may have.
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
        compile(&text, "-O1", |source| source, folder.path())?;
        let pixels = pixels(&text, batch.min(programs - first), 4, &mut random);
        std::fs::write(folder.path().join("pixels.bin"), bytes(&pixels))?;
        run(&mut Command::new("./pixels"), folder.path()).map_err(|failed| format!("batch {n}, {text:?}: {failed}"))?;
    }
    println!("generic C: {programs} programs, 4 pixels each");
    Ok(())
}

/// Plants errors that an engineer might make, an operator, a constant or a name. Some in every function have to be noticed, and so does each one
/// that changes what a program of the sample reads.
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
        // Numbers of the table have a test of their own.
        let is_code = |line: &str| !line.trim_start().starts_with(|c: char| c == '-' || c.is_ascii_digit());
        let all: Vec<usize> = (first..lines.len()).filter(|n| lines[*n].contains(from) && is_code(lines[*n])).collect();
        for at in all.iter().step_by(all.len().div_ceil(2)) {
            let mut changed = lines.clone();
            let line = changed[*at].replacen(from, to, 1);
            changed[*at] = &line;
            let changed = changed.join("\n") + "\n";
            planted += 1;
            if compile(&text, "-O0", |_| changed.clone(), folder.path()).is_ok()
                && run(&mut Command::new("./pixels"), folder.path()).is_ok()
            {
                missed.push(line);
            }
        }
    }
    println!("{} of {planted} planted errors noticed", planted - missed.len());
    if missed.is_empty() { Ok(()) } else { Err(missed.join("\n").into()) }
}

/// Compares the table of mappings, number by number, with the formulas of the handbook.
fn table() -> Result<(), Failed> {
    let source = Generic { chip: Profile::Nv2a, policies: Policies::DEFAULT }.c99().source;
    let (_, table) = source.split_once("nb_mapping[8][512] = {").unwrap();
    let (table, _) = table.split_once("};").unwrap();
    let code = table.lines().map(|line| line.split_once("/*").map_or(line, |(code, _)| code));
    let numbers: Vec<i32> =
        code.flat_map(|line| line.split([',', '{', '}'])).filter_map(|n| n.trim().parse().ok()).collect();
    assert_eq!(numbers.len(), 8 * 512);
    for (at, number) in numbers.into_iter().enumerate() {
        let (x, mapping) = (at as i32 % 512 - 256, InputMapping::ALL[at / 512]);
        let positive = x.max(0);
        let expected = match mapping {
            InputMapping::UnsignedIdentity => positive,
            InputMapping::UnsignedInvert => 255 - positive,
            InputMapping::ExpandNormal => 2 * (positive - 128),
            InputMapping::ExpandNegate => (2 * (128 - positive)).min(255),
            InputMapping::HalfBiasNormal => positive - 128,
            InputMapping::HalfBiasNegate => 128 - positive,
            InputMapping::SignedIdentity => x,
            InputMapping::SignedNegate => (-x).min(255),
        };
        assert_eq!(number, expected, "{} of {x}", mapping.name());
    }
    Ok(())
}

/// Uses one shader for all programs: each pixel brings the words of its own program.
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
        run(drawing("glsl.py").args(["1", &COLUMNS.to_string()]), folder.path())?;
        println!("generic GLSL of {:?}: {programs} programs", text.chip);
    }
    Ok(())
}

/// The pixels that show a row of a table, and a check of their stored words.
type Shown = (Vec<Vec<u32>>, Box<dyn Fn(&[u32]) -> bool>);

/// Makes a pixel of a program, with the given words by name.
fn pixel(generic: &Generic, named: &[(&str, u32)], program: &Combiners, inputs: [u32; INPUTS]) -> Vec<u32> {
    let mut out: Vec<u32> = encode(program, generic.chip).all().map(|(_, _, value)| value).collect();
    out.extend(Method::ALL.iter().map(|method| {
        let plain = match method {
            Method::SurfaceFormat => raster::surface_format(SurfaceFormat::A8R8G8B8),
            Method::ColorMask => 0x0101_0101,
            _ => 0,
        };
        named.iter().find(|(name, _)| *name == method.name()).map_or(plain, |(_, value)| *value)
    }));
    out.extend(inputs);
    out.resize(COLUMNS, 0);
    out
}

/// Makes the pixels that show a row of a unit, if the text can show it.
fn shown(generic: &Generic, unit: &str, case: &Case<'_>) -> Option<Shown> {
    let columns = case.inputs.iter().chain(case.results).zip(case.row.inputs.iter().chain(&case.row.results));
    let all: Vec<(String, i64)> = columns.map(|(column, value)| (column.name.clone(), *value)).collect();
    let number = |name: &str| all.iter().find(|(known, _)| known == name).map(|(_, value)| *value as u32).unwrap();
    let four = |name: &str| ["r", "g", "b", "a"].map(|channel| number(&format!("{name}.{channel}")));
    let word = |[r, g, b, a]: [u32; 4]| a << 24 | r << 16 | g << 8 | b;
    // The fragment is the interpolated colour.
    let plain = Combiners::showing(FinalRegister::PrimaryColor);
    let given = |primary: [u32; 4], held: u32| {
        let mut inputs = [0; INPUTS];
        inputs[..4].copy_from_slice(&primary);
        inputs[INPUTS - 1] = held;
        inputs
    };
    match unit {
        "alpha-test" => {
            let function = raster::compare_function(CompareFunction::ALL[number("cfg.function") as usize]);
            let state = [("alpha_test_enable", 1), ("alpha_func", function), ("alpha_ref", number("cfg.reference"))];
            let passes = number("out.passes") != 0;
            let inputs = given([255, 255, 255, number("in.alpha")], 0);
            Some((vec![pixel(generic, &state, &plain, inputs)], Box::new(move |words| (words[0] != 0) == passes)))
        }
        "blend" => {
            let factor = |name: &str| raster::blend_factor(BlendFactor::ALL[number(name) as usize]);
            let state = [
                ("blend_enable", 1),
                ("blend_equation", raster::blend_equation(BlendEquation::ALL[number("cfg.equation") as usize])),
                ("blend_func_sfactor", factor("cfg.source_factor")),
                ("blend_func_dfactor", factor("cfg.destination_factor")),
                ("blend_color", word(four("in.constant"))),
            ];
            let inputs = given(four("in.source"), word(four("in.destination")));
            let wanted = word(four("out"));
            Some((vec![pixel(generic, &state, &plain, inputs)], Box::new(move |words| words[0] == wanted)))
        }
        "surface-store" => {
            let format = raster::surface_format(SurfaceFormat::ALL[number("cfg.format") as usize]);
            let inputs = given(four("in"), 0);
            let wanted = number("out.word");
            let state = [("surface_format", format)];
            Some((vec![pixel(generic, &state, &plain, inputs)], Box::new(move |words| words[0] == wanted)))
        }
        _ => {
            let placements = recipes(unit).iter().filter_map(|recipe| recipe(case));
            let placement = placements.into_iter().find(|placement| placement.path == gpu::Path::Combiners)?;
            let mut inputs = [0; INPUTS];
            for (name, bytes) in &placement.sources {
                let sources = ["primary", "secondary", "fog", "texture0", "texture1", "texture2", "texture3"];
                let at = 4 * sources.iter().position(|known| known == name).unwrap();
                (0..4).for_each(|c| inputs[at + c] = bytes[c].into());
            }
            let fog = placement.state.iter().find_map(|line| line.strip_prefix("fog_color "));
            if let Some(byte) = fog.and_then(|rest| rest.split(' ').next()) {
                inputs[8..11].fill(byte.parse().unwrap());
            }
            let draws = &placement.draws;
            let pixels =
                draws.iter().map(|draw| pixel(generic, &[], draw.combiners.as_ref().unwrap(), inputs)).collect();
            let reads: Vec<Vec<gpu::Contribution>> = draws.iter().map(|draw| draw.reads.clone()).collect();
            let kinds: Vec<_> = case.results.iter().map(|column| (column.name.clone(), column.kind)).collect();
            let results = case.row.results.clone();
            Some((
                pixels,
                Box::new(move |words| {
                    let mut sums: BTreeMap<&str, i64> = BTreeMap::new();
                    for (reads, word) in reads.iter().zip(words) {
                        let channels = surface::read(SurfaceFormat::A8R8G8B8, *word);
                        for read in reads {
                            *sums.entry(&read.column).or_default() += read.weight * i64::from(channels[read.channel]);
                        }
                    }
                    sums.iter().all(|(name, sum)| {
                        let at = kinds.iter().position(|(known, _)| known == name).unwrap();
                        kinds[at].1.read(&sum.to_string()) == Some(results[at])
                    })
                }),
            ))
        }
    }
}

/// Checks every row of tables that a frame buffer can show. Their numbers come from another source than the programs above.
fn rows() -> Result<(), Failed> {
    let level = if setting("NINEBIT_GENERIC_LEVEL") == Some(1) { Level::L1 } else { Level::L0 };
    let text = Generic { chip: Profile::Nv2a, policies: Policies::DEFAULT };
    let folder = tempfile::tempdir()?;
    compile(&text, "-O1", |source| source, folder.path())?;
    let units = "input-mapping product sum dot-product mux scale-bias general-stage alpha-portion two-stages \
        final-combiner alpha-test blend surface-store";
    for name in units.split(' ') {
        let unit = units::by_name(name).unwrap();
        let writer = Writer::new(Contents { unit, profile: text.chip, level, seed: 1 });
        let (mut pixels, mut checks, mut all) = (Vec::new(), Vec::new(), 0);
        writer
            .each(false, |row| {
                all += 1;
                let case = Case { inputs: writer.inputs(), results: writer.results(), row, profile: text.chip };
                if let Some((shown, check)) = shown(&text, name, &case) {
                    checks.push((shown.len(), check, writer.id(&row.inputs)));
                    shown.into_iter().for_each(|pixel| pixels.extend(pixel));
                }
                Ok::<(), ()>(())
            })
            .unwrap();
        std::fs::write(folder.path().join("pixels.bin"), bytes(&pixels))?;
        // The program's status says nothing here, because single pixels have no expected word.
        let output = Command::new("./pixels").arg("words").current_dir(folder.path()).output()?;
        let lines = std::str::from_utf8(&output.stdout)?.lines();
        let words: Vec<u32> = lines.map(|word| u32::from_str_radix(word, 16).unwrap()).collect();
        assert_eq!(words.len() * COLUMNS, pixels.len(), "{name}");
        let mut at = 0;
        for (count, check, id) in &checks {
            assert!(check(&words[at..at + count]), "{name}: row {id}: {:08x?}", &words[at..at + count]);
            at += count;
        }
        assert!(10 * checks.len() > all, "{name}: {} of {all} rows are shown", checks.len());
        println!("{name}: {} of {all} rows, {} pixels", checks.len(), words.len());
    }
    Ok(())
}

fn main() {
    let arguments = Arguments::from_args();
    let compiles = works(&compiler(), &["--version"]);
    let draws = works(&python(), &["-c", "import moderngl, numpy"]);
    let trials = vec![
        Trial::test("table of mappings", table),
        Trial::test("c99", c99).with_ignored_flag(!compiles),
        Trial::test("rows of tables", rows).with_ignored_flag(!compiles),
        Trial::test("planted errors are noticed", errors_are_noticed).with_ignored_flag(!compiles),
        Trial::test("glsl", glsl).with_ignored_flag(!draws),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}
