//! Compares printed text with the lines that it is printed from: random programs and draws, compiled and run by installed tools. A language whose
//! tools are missing is ignored.
//!
//! `NINEBIT_LOWER_CASES` is the number of functions in each language, `NINEBIT_LOWER_ROWS` the number of pixels for each, `NINEBIT_LOWER_SEED`
//! selects other functions. `CC` names the C compiler and `NINEBIT_LOWER_CFLAGS` its options; `NINEBIT_LOWER_PYTHON` names a Python with
//! `moderngl`, `wgpu` and `numpy`.
#![allow(missing_docs, unreachable_pub, dead_code, reason = "modules share files of which each uses its part")]
#![allow(clippy::unwrap_used, clippy::float_arithmetic, reason = "tests fail by panicking")]

#[path = "common/setting.rs"]
mod setting;
#[path = "common/traced.rs"]
mod traced;
use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use libtest_mimic::{Arguments, Failed, Trial};
use ninebit::engine::{RenderOptions, render, trace};
use ninebit::frame::Surface;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::state::{Policies, Scene};
use ninebit_lower::code::{Kind, Test, run_changed, value_of};
use ninebit_lower::{Function, Input, Language, NamedFunction, Options, Result, Textures};
use ninebit_test_support::{random_program, random_scene};
use proptest::strategy::{Strategy, ValueTree};
use setting::{any_policies, bytes, compiler, drawing, python, runner, setting, works};
use traced::Traced;

/// Numbers of columns in the pool of inputs: those with bytes, those with registers, and all of them, of which the rest are words.
const BYTES: usize = 32;
const REGISTERS: usize = 16;
const COLUMNS: usize = 64;

/// Returns random functions: programs and draws in turn.
fn functions(count: usize, seed: u64) -> Vec<Function> {
    let mut runner = runner(seed);
    let (programs, scenes) = (random_program::combiners(), random_scene::scene());
    let mut random = Random::seeded(seed);
    let mut functions: Vec<Function> = Vec::new();
    while functions.len() < count {
        // A function that is the same in every pixel is hardly worth a test.
        if functions.last().is_some_and(|last| last.lines.is_empty()) && !random.once_in(4) {
            functions.pop();
        }
        let policies = if random.once_in(2) { Policies::DEFAULT } else { any_policies(&mut random) };
        let textures = if random.once_in(3) { Textures::Registers } else { Textures::Words };
        let options = Options { policies, uniform: random.once_in(3), textures, fragment: random.once_in(8) };
        if functions.len().is_multiple_of(2) {
            let mut program = programs.new_tree(&mut runner).unwrap().current();
            // No chip has more stages, and the structures have no place for their constants.
            program.stages.truncate(8);
            functions.push(Function::of_program(&program, &options));
            continue;
        }
        let scene = scenes.new_tree(&mut runner).unwrap().current();
        let plan = Plan::compile(&scene, &PlanOptions { prune: false, policies }).unwrap();
        let number = random.below(scene.draws.len() as u128) as usize;
        functions.push(Function::of_draw(&scene, &scene.draws[number], &plan.draws()[number], &options));
    }
    functions
}

/// Returns numbers for inputs: `rows` rows of [`COLUMNS`].
fn pool(rows: usize, seed: u64) -> Vec<u32> {
    let mut random = Random::seeded(seed ^ 0x9b);
    (0..rows * COLUMNS)
        .map(|at| {
            let often = random.below(6);
            match at % COLUMNS {
                0..BYTES => match often {
                    0 => 0,
                    1 => 255,
                    2 => 128,
                    _ => random.below(256) as u32,
                },
                column if column < BYTES + REGISTERS => {
                    (match often {
                        0 => -256,
                        1 => 255,
                        _ => random.below(512) as i32 - 256,
                    }) as u32
                }
                _ => random.bits() as u32,
            }
        })
        .collect()
}

/// Returns the column of each input of a function.
fn columns(function: &Function) -> Vec<(Input, usize)> {
    let mut taken = [0; 3];
    let inputs = function.inputs().into_iter();
    inputs
        .map(|input| {
            // An input that is known to be a byte must not read a negative register.
            let (class, first, count) = match (input.kind(), function.range(input).0 < 0) {
                (Kind::Word, _) => (2, BYTES + REGISTERS, COLUMNS - BYTES - REGISTERS),
                (_, true) => (1, BYTES, REGISTERS),
                _ => (0, 0, BYTES),
            };
            taken[class] += 1;
            (input, first + (taken[class] - 1) % count)
        })
        .collect()
}

/// Returns the results of the lines for each row: R, G, B, A, or the word and whether the fragment passed.
fn expected(function: &Function, pool: &[u32]) -> Vec<u32> {
    expected_with(function, pool, None)
}

/// Returns the results if the last bit of one line's value is inverted.
fn expected_with(function: &Function, pool: &[u32], turned: Option<usize>) -> Vec<u32> {
    let columns = columns(function);
    let mut out = Vec::new();
    for row in pool.chunks_exact(COLUMNS) {
        let column = |input: Input| columns.iter().find(|(known, _)| *known == input).unwrap().1;
        let given = |input: Input| match input.kind() {
            Kind::Word => row[column(input)].into(),
            Kind::Number | Kind::Binary => (row[column(input)] as i32).into(),
        };
        let values = run_changed(&function.lines, given, |line, value| {
            // The value has to stay in its range.
            let least = function.lines[line].range.0;
            if turned == Some(line) {
                least + ((value - least) ^ 1).min(function.lines[line].range.1 - least)
            } else {
                value
            }
        });
        match function.result {
            Result::Fragment(channels) => out.extend(channels.map(|channel| value_of(&values, channel) as u32)),
            Result::Pixel { .. } => panic!("no whole pixel was asked for"),
            Result::Stored { word, test } => {
                let passed =
                    test.is_none_or(|Test(test, [a, b])| test.passes(value_of(&values, a), value_of(&values, b)));
                // If the test fails, the destination stays.
                let kept = if passed { 0 } else { row[column(Input::Destination)] };
                out.extend([if passed { value_of(&values, word) as u32 } else { kept }, passed.into(), 0, 0]);
            }
        }
    }
    out
}

/// A batch of functions in a folder: the pool, the expected results, and a text for each tool.
struct Batch<'f> {
    folder: &'f Path,
    functions: &'f [Function],
    rows: usize,
}

impl Batch<'_> {
    fn named(&self) -> Vec<NamedFunction<'_>> {
        let named = self.functions.iter().enumerate();
        named
            .map(|(n, function)| NamedFunction { name: format!("case{n}"), about: format!("case {n}"), function })
            .collect()
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.folder.join(name), bytes).unwrap();
    }

    fn data(&self, seed: u64) {
        let pool = pool(self.rows, seed);
        self.write("pool.bin", bytes(&pool));
        self.write("expected.bin", self.functions.iter().flat_map(|f| bytes(&expected(f, &pool))).collect::<Vec<u8>>());
        let hex = |words: &[u32]| words.iter().map(|word| format!("{word:08x}\n")).collect::<String>();
        self.write("pool.hex", hex(&pool));
        self.write("expected.hex", self.functions.iter().map(|f| hex(&expected(f, &pool))).collect::<String>());
    }

    /// Runs a command, which has to succeed.
    fn run(&self, command: &mut Command) -> std::result::Result<(), Failed> {
        let Err(failed) = setting::run(command, self.folder) else { return Ok(()) };
        // The files of a failure are kept for inspection.
        let kept = std::env::temp_dir().join("ninebit-lower-failed");
        let _ = std::fs::remove_dir_all(&kept);
        let copied = Command::new("cp").arg("-r").arg(self.folder).arg(&kept).status();
        Err(format!("{failed}\n(kept: {copied:?} {})", kept.to_string_lossy()).into())
    }

    /// Returns the functions in C, with a program that runs them.
    fn c_text(&self) -> String {
        let mut text = Language::C99.print(&self.named());
        text += "\n#include <stdio.h>\n#include <string.h>\n";
        for (n, function) in self.functions.iter().enumerate() {
            let _ = writeln!(text, "static void run{n}(const uint32_t *row, uint32_t *out)\n{{");
            text += "    struct ninebit_pixel given, *pixel = &given;\n    memset(&given, 0, sizeof given);\n    (void)row;\n";
            if function.uniform {
                text += "    struct ninebit_constants uniform, *constants = &uniform;\n    memset(&uniform, 0, sizeof uniform);\n";
            }
            for (input, column) in columns(function) {
                let kind = if input.kind() == Kind::Word { "uint32_t" } else { "int32_t" };
                let _ = writeln!(text, "    {} = ({kind})row[{column}];", Language::C99.input(input));
            }
            let constants = if function.uniform { ", constants" } else { "" };
            match function.result {
                Result::Fragment(_) => {
                    let _ = writeln!(text, "    int32_t fragment[4];\n    case{n}(pixel{constants}, fragment);");
                    text += "    for (int c = 0; c < 4; c++) out[c] = (uint32_t)fragment[c];\n}\n";
                }
                Result::Stored { .. } | Result::Pixel { .. } => {
                    let _ = writeln!(text, "    out[1] = (uint32_t)case{n}(pixel{constants}, out);\n}}");
                }
            }
        }
        let _ = writeln!(text, "static void (*const runs[])(const uint32_t *, uint32_t *) = {{");
        (0..self.functions.len()).for_each(|n| text += &format!("run{n}, "));
        let _ = write!(
            text,
            "}};\nint main(void)\n{{\n    static uint32_t pool[{rows}][{COLUMNS}], want[{rows}][4];\n    FILE *p = fopen(\"pool.bin\", \"rb\"), \
             *e = fopen(\"expected.bin\", \"rb\");\n    if (!p || !e || fread(pool, sizeof pool, 1, p) != 1) return 2;\n    for (unsigned n = 0; n < \
             {count}; n++) {{\n        if (fread(want, sizeof want, 1, e) != 1) return 2;\n        for (int row = 0; row < {rows}; row++) {{\n            \
             uint32_t got[4] = {{0, 0, 0, 0}};\n            runs[n](pool[row], got);\n            if (memcmp(got, want[row], sizeof got)) {{\n                \
             printf(\"case %u, row %d: %08x %08x %08x %08x, not %08x %08x %08x %08x\\n\", n, row, got[0], got[1], got[2], got[3], want[row][0], \
             want[row][1], want[row][2], want[row][3]);\n                return 1;\n            }}\n        }}\n    }}\n    return 0;\n}}\n",
            rows = self.rows,
            count = self.functions.len(),
        );
        text
    }

    /// Compiles the C program.
    fn compile(&self) -> std::result::Result<(), Failed> {
        let more = std::env::var("NINEBIT_LOWER_CFLAGS").unwrap_or_else(|_| "-O1".to_string());
        let mut command = Command::new(compiler());
        command.args(["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-o", "cases", "cases.c"]);
        self.run(command.args(more.split_whitespace()))
    }

    fn c99(&self) -> std::result::Result<(), Failed> {
        self.write("cases.c", self.c_text());
        self.compile()?;
        self.run(&mut Command::new("./cases"))
    }

    fn verilog(&self) -> std::result::Result<(), Failed> {
        let mut text = Language::Verilog.print(&self.named());
        let (rows, count) = (self.rows, self.functions.len());
        let _ = write!(
            text,
            "\nmodule bench;\n    reg [31:0] pool [0:{}];\n    reg [31:0] expected [0:{}];\n    integer row, failed;\n",
            rows * COLUMNS - 1,
            rows * 4 * count - 1
        );
        (0..COLUMNS).for_each(|c| text += &format!("    wire [31:0] c{c} = pool[row * {COLUMNS} + {c}];\n"));
        let mut checks = String::new();
        for (n, function) in self.functions.iter().enumerate() {
            let given = columns(function);
            let mut ports: Vec<String> = given
                .into_iter()
                .map(|(input, column)| {
                    let port = Language::Verilog.input(input);
                    match input.kind() {
                        Kind::Word => format!(".{port}(c{column})"),
                        Kind::Number | Kind::Binary => format!(".{port}(c{column}[8:0])"),
                    }
                })
                .collect();
            let got = match function.result {
                Result::Fragment(_) => {
                    text += &format!("    wire [7:0] r{n}, g{n}, b{n}, a{n};\n");
                    ports.extend(["r", "g", "b", "a"].map(|c| format!(".out_{c}({c}{n})")));
                    format!("{{24'd0, r{n}, 24'd0, g{n}, 24'd0, b{n}, 24'd0, a{n}}}")
                }
                Result::Stored { .. } | Result::Pixel { .. } => {
                    text += &format!("    wire passed{n};\n    wire [31:0] word{n};\n");
                    ports.extend([format!(".passed(passed{n})"), format!(".word(word{n})")]);
                    format!("{{word{n}, 31'd0, passed{n}, 64'd0}}")
                }
            };
            text += &format!("    case{n} test{n} ({});\n", ports.join(", "));
            let at = |k: usize| format!("expected[({n} * {rows} + row) * 4 + {k}]");
            let want = format!("{{{}, {}, {}, {}}}", at(0), at(1), at(2), at(3));
            checks += &format!(
                "            if ({got} !== {want} && failed == 0) begin\n                failed = 1;\n                \
                 $display(\"case {n}, row %0d: %h, not %h\", row, {got}, {want});\n            end\n"
            );
        }
        let _ = write!(
            text,
            "    initial begin\n        $readmemh(\"pool.hex\", pool);\n        $readmemh(\"expected.hex\", expected);\n        failed = 0;\n        \
             for (row = 0; row < {rows}; row = row + 1) begin\n            #1;\n{checks}        end\n        if (failed == 0) $display(\"all equal\");\n        \
             $finish;\n    end\nendmodule\n"
        );
        self.write("cases.v", text);
        let mut build = Command::new("iverilog");
        self.run(build.args(["-g2001", "-Wall", "-Wno-timescale", "-o", "cases.vvp", "cases.v"]))?;
        let mut shell = Command::new("sh");
        self.run(shell.args(["-c", "vvp -n cases.vvp > out.txt; cat out.txt; grep -q '^all equal' out.txt"]))
    }

    /// Writes shaders, and runs the tool that renders or computes all rows of each.
    fn shaders(&self, language: Language) -> std::result::Result<(), Failed> {
        for (n, function) in self.functions.iter().enumerate() {
            let named = NamedFunction { name: "shade".to_string(), about: format!("case {n}"), function };
            let printed = language.print(&[named]);
            let constants = if function.uniform { ", constants" } else { "" };
            let glsl = language == Language::Glsl;
            let mut body = String::new();
            for (input, column) in columns(function) {
                let (place, word) = (language.input(input), input.kind() == Kind::Word);
                let cast = match (glsl, word) {
                    (true, true) => "uint",
                    (false, true) => "u32",
                    _ => "",
                };
                let _ = writeln!(body, "    {place} = {cast}(given(row, {column}));");
            }
            let text = if glsl {
                let uniform = if function.uniform { "    NinebitConstants constants;\n" } else { "" };
                let call = match function.result {
                    Result::Fragment(_) => format!("    result = uvec4(shade(pixel{constants}));\n"),
                    Result::Stored { .. } | Result::Pixel { .. } => format!(
                        "    uint word;\n    bool passed = shade(pixel{constants}, word);\n    result = uvec4(word, passed ? 1u : 0u, 0u, 0u);\n"
                    ),
                };
                format!(
                    "#version 330\n{printed}\nuniform isampler2D pool;\nout uvec4 result;\nint given(int row, int column) {{ return texelFetch(pool, \
                     ivec2(column + {COLUMNS} * (row >> 14), row & 16383), 0).r; }}\nvoid main()\n{{\n    int row = int(gl_FragCoord.y) * 64 + int(gl_FragCoord.x);\n    NinebitPixel pixel;\n\
                     {uniform}{body}{call}}}\n"
                )
            } else {
                let uniform = if function.uniform { "    var constants: NinebitConstants;\n" } else { "" };
                let call = match function.result {
                    Result::Fragment(_) => format!("    result[row] = vec4<u32>(shade(pixel{constants}));\n"),
                    Result::Stored { .. } | Result::Pixel { .. } => format!(
                        "    let stored = shade(pixel{constants});\n    result[row] = vec4<u32>(stored.word, u32(stored.passed), 0u, 0u);\n"
                    ),
                };
                format!(
                    "{printed}\n@group(0) @binding(0) var<storage, read> pool: array<i32>;\n@group(0) @binding(1) var<storage, read_write> result: \
                     array<vec4<u32>>;\nfn given(row: u32, column: u32) -> i32 {{ return pool[row * {COLUMNS}u + column]; }}\n\
                     @compute @workgroup_size(64)\nfn main(@builtin(global_invocation_id) id: vec3<u32>) {{\n    let row = id.x;\n    var pixel: NinebitPixel;\n\
                     {uniform}{body}{call}}}\n"
                )
            };
            self.write(&format!("{n:05}.{}", if glsl { "glsl" } else { "wgsl" }), text);
        }
        let script = if language == Language::Glsl { "glsl.py" } else { "wgsl.py" };
        self.run(drawing(script).arg(self.functions.len().to_string()))
    }
}

/// Returns a line with an error that an engineer might make; `None` if the line has no place for an error of that kind.
fn planted(line: &str, kind: usize) -> Option<String> {
    let value = line.find(" = ")? + 3;
    let (name, text) = line.split_at(value);
    let (text, comment) = text.split_at(text.rfind("/*")?);
    let swaps = [
        (" + ", " - "),
        (" - ", " + "),
        (" / 510", " / 255"),
        ("_least(", "_greatest("),
        ("_greatest(", "_least("),
        ("[0]", "[1]"),
        (" * ", " + "),
        ("128", "127"),
        (" >= ", " < "),
        (" ? ", " != 0 ? "),
        ("_r", "_g"),
    ];
    let (from, to) = swaps[kind % swaps.len()];
    (text.contains(from) && !text.contains(to)).then(|| format!("{name}{}{comment}", text.replacen(from, to, 1)))
}

/// Returns whether the last bit of the line of that name affects some rows of the pool.
fn matters(function: &Function, name: &str) -> bool {
    let Some(at) = function.lines.iter().position(|line| line.name.as_deref() == Some(name)) else { return false };
    let pool = pool(64, 7);
    expected(function, &pool) != expected_with(function, &pool, Some(at))
}

/// Plants errors in lines of printed C, one in each function: all of them have to be noticed.
fn errors_are_noticed() -> std::result::Result<(), Failed> {
    let errors = setting("NINEBIT_LOWER_ERRORS").map_or(12, |errors| errors as usize);
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let (all, mut random, mut found) = (functions(400, 7), Random::seeded(7), Vec::new());
    for (n, function) in all.iter().enumerate() {
        let batch = Batch { folder: folder.path(), functions: std::slice::from_ref(function), rows: 4096 };
        batch.data(7);
        let text = batch.c_text();
        let lines: Vec<&str> = text.lines().collect();
        // Only lines whose last bit affects the result: errors elsewhere cannot be noticed.
        let seen = |line: &str| {
            let name = line.trim_start().strip_prefix("const ").and_then(|rest| rest.split(' ').nth(1));
            name.is_some_and(|name| matters(function, name))
        };
        let chosen: Vec<usize> = (0..lines.len()).filter(|n| seen(lines[*n])).collect();
        let Some(at) = random.pick(&chosen) else { continue };
        let Some(error) = (0..4).find_map(|more| planted(lines[at], n + more)) else { continue };
        let mut changed = lines.clone();
        changed[at] = &error;
        batch.write("cases.c", changed.join("\n") + "\n");
        // An error that does not compile is noticed as well, but proves little.
        if batch.compile().is_err() {
            continue;
        }
        let noticed =
            Command::new("./cases").current_dir(batch.folder).status().is_ok_and(|status| status.code() == Some(1));
        found.push((noticed, lines[at].to_string(), error));
        if found.len() == errors {
            break;
        }
    }
    let missed: Vec<String> =
        found.iter().filter(|error| !error.0).map(|(_, was, is)| format!("{was}\n{is}")).collect();
    println!("{} of {} planted errors noticed", found.len() - missed.len(), found.len());
    match found.len() == errors && missed.is_empty() {
        true => Ok(()),
        false => Err(format!("{} errors planted; not noticed:\n{}", found.len(), missed.join("\n")).into()),
    }
}

/// Draws whole frames with shaders. Each fragment takes its inputs from the model's trace and has to yield the word that the trace stores.
/// The last fragments of the pixels have to yield the frame of the engine. `NINEBIT_LOWER_FRAMES` is the distance between the rows that are
/// drawn.
fn frames() -> std::result::Result<(), Failed> {
    let step = setting("NINEBIT_LOWER_FRAMES").map_or(1, |step| step as usize);
    for scene in ["w1", "w2", "w4"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../vectors/scenes/bench/{scene}.ron"));
        let loaded =
            ninebit_scene::load(&path, &ninebit::limits::Limits::default()).map_err(|error| error.to_string())?;
        let plan = Plan::compile(&loaded.scene, &PlanOptions { prune: false, ..PlanOptions::default() }).unwrap();
        let draws = &loaded.scene.draws;
        let options = Options { textures: Textures::Words, ..Options::default() };
        let function = |(draw, planned)| Function::of_draw(&loaded.scene, draw, planned, &options);
        let functions: Vec<Function> = draws.iter().zip(plan.draws()).map(function).collect();
        let surface = &render(&plan, &RenderOptions::default()).surfaces[0];
        let rows: Vec<u32> = (0..surface.height).step_by(step).collect();
        let parts: Vec<Vec<Given>> = std::thread::scope(|scope| {
            let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
            let (scene, plan, functions) = (&loaded.scene, &plan, &functions);
            let parts: Vec<_> = rows
                .chunks(rows.len().div_ceil(threads))
                .map(|rows| scope.spawn(move || rows_given(scene, plan, functions, surface, rows)))
                .collect();
            parts.into_iter().map(|part| part.join().unwrap()).collect()
        });
        let draws: Vec<Given> = (0..functions.len())
            .map(|draw| {
                let joined =
                    |of: fn(&Given) -> &Vec<u32>| parts.iter().flat_map(|part| of(&part[draw])).copied().collect();
                Given { pool: joined(|given| &given.pool), expected: joined(|given| &given.expected) }
            })
            .collect();
        // Every draw has as many pixels as the largest, and shaders take 64 at a time: the last one is repeated.
        let rows = draws.iter().map(|draw| draw.expected.len() / 4).max().unwrap().next_multiple_of(64);
        let filled = |words: &[u32], most: usize| -> Vec<u32> {
            let last = &words[words.len() - most..];
            words.iter().chain(last.iter().cycle()).copied().take(rows * most).collect()
        };
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let batch = Batch { folder: folder.path(), functions: &functions, rows };
        batch.write("pool.bin", draws.iter().flat_map(|draw| bytes(&filled(&draw.pool, COLUMNS))).collect::<Vec<u8>>());
        batch.write(
            "expected.bin",
            draws.iter().flat_map(|draw| bytes(&filled(&draw.expected, 4))).collect::<Vec<u8>>(),
        );
        for language in [Language::Glsl, Language::Wgsl] {
            batch.shaders(language)?;
        }
        for (draw, given) in draws.iter().enumerate() {
            println!("{scene}, draw {draw}: {} fragments, all equal in GLSL and WGSL", given.expected.len() / 4);
        }
    }
    Ok(())
}

/// Rows of a pool, with their expected results.
#[derive(Clone, Default)]
struct Given {
    pool: Vec<u32>,
    expected: Vec<u32>,
}

/// Returns the inputs of the fragments in some rows of a frame, by draw.
fn rows_given(scene: &Scene, plan: &Plan, functions: &[Function], surface: &Surface, rows: &[u32]) -> Vec<Given> {
    let columns: Vec<Vec<(Input, usize)>> = functions.iter().map(columns).collect();
    for columns in &columns {
        assert!(
            columns.iter().enumerate().all(|(n, (_, column))| columns[..n].iter().all(|(_, other)| other != column))
        );
    }
    let mut given = vec![Given::default(); functions.len()];
    for (x, y) in rows.iter().flat_map(|y| (0..surface.width).map(move |x| (x, *y))) {
        let traced = trace(plan, 0, (x, y), None).unwrap();
        assert_eq!(traced.word, surface.words[(y * surface.width + x) as usize], "{x}, {y}");
        assert_eq!(traced.left_out, 0);
        for fragment in &traced.draws {
            let of = Traced::from_fragment(fragment);
            assert!(fragment.stored || of.dropped(), "{x}, {y}: another test dropped it");
            let mut row = [0; COLUMNS];
            for (input, column) in &columns[fragment.draw] {
                row[*column] = of.given(&scene.draws[fragment.draw], *input) as u32;
            }
            let destination = of.given(&scene.draws[fragment.draw], Input::Destination) as u32;
            let word = of.said("stored.word").map_or(destination, |word| word as u32);
            given[fragment.draw].pool.extend(row);
            given[fragment.draw].expected.extend([word, u32::from(fragment.stored), 0, 0]);
        }
    }
    given
}

/// Tests functions of a language in batches.
fn all(language: Language, count: usize, rows: usize) -> std::result::Result<(), Failed> {
    let count = setting("NINEBIT_LOWER_CASES").map_or(count, |cases| cases as usize);
    let rows = setting("NINEBIT_LOWER_ROWS").map_or(rows, |rows| rows as usize);
    let rows = if matches!(language, Language::Glsl | Language::Wgsl) { rows.next_multiple_of(64) } else { rows };
    let seed = setting("NINEBIT_LOWER_SEED").unwrap_or(23);
    let batch = if matches!(language, Language::Glsl | Language::Wgsl) { 250 } else { 100 };
    for (n, first) in (0..count).step_by(batch).enumerate() {
        let seed = seed.wrapping_add(n as u64);
        let functions = functions(batch.min(count - first), seed);
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let batch = Batch { folder: folder.path(), functions: &functions, rows };
        batch.data(seed);
        match language {
            Language::C99 => batch.c99(),
            Language::Verilog => batch.verilog(),
            Language::Glsl | Language::Wgsl => batch.shaders(language),
        }
        .map_err(|failed| format!("batch {n}: {}", failed.message().unwrap_or_default()))?;
        println!("{language:?}: {} functions on {rows} rows", (first + 100).min(count));
    }
    Ok(())
}

fn main() {
    let arguments = Arguments::from_args();
    let compiles = works(&compiler(), &["--version"]);
    let tests = [
        (Language::C99, 200, 64, compiles),
        (Language::Verilog, 60, 32, works("iverilog", &["-V"])),
        (Language::Glsl, 60, 256, works(&python(), &["-c", "import moderngl, numpy"])),
        (Language::Wgsl, 60, 256, works(&python(), &["-c", "import wgpu, numpy"])),
    ];
    let trials = tests.map(|(language, count, rows, runs)| {
        Trial::test(format!("{language:?}").to_lowercase(), move || all(language, count, rows)).with_ignored_flag(!runs)
    });
    let planted = Trial::test("planted errors are noticed", errors_are_noticed).with_ignored_flag(!compiles);
    let draws = setting("NINEBIT_LOWER_FRAMES").is_some_and(|frames| frames > 0);
    let frames = Trial::test("frames", frames).with_ignored_flag(!draws);
    libtest_mimic::run(&arguments, trials.into_iter().chain([planted, frames]).collect()).exit();
}
