//! Tests vertex programs: texts are read, printed and refused as documented, and every instruction is compared with an implementation in
//! this file.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test binary")]

use crate::pages;
use crate::repository::at;
use ninebit_test_support::random_vertex_program::{instruction, shader};

use ninebit::diagnostic::Diagnostic;
use ninebit::random::Random;
use ninebit::vertex::shader::*;
use ninebit_program::vertex_shader::{parse, print, read};
use proptest::prelude::*;
use sha2::{Digest, Sha256};

fn refused(text: &str) -> Vec<Diagnostic> {
    read(text).map(|written| panic!("{text} is {written:?}")).unwrap_err()
}

#[track_caller]
fn codes(body: &str) -> Vec<&'static str> {
    refused(body).iter().map(|finding| finding.code).collect()
}

#[track_caller]
fn accepted(body: &str) -> VertexShader {
    let written = read(body).unwrap_or_else(|findings| panic!("{body}\n{findings:?}"));
    assert_eq!(written.warnings, [], "{body}");
    written.shader
}

/// Returns the codes of the warnings for a program that is otherwise valid.
#[track_caller]
fn warned(body: &str) -> Vec<&'static str> {
    let written = read(body).unwrap_or_else(|findings| panic!("{body}\n{findings:?}"));
    written.warnings.iter().map(|finding| finding.code).collect()
}

fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => -8.0_f32..8.0,
        2 => prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 1e-40, 3e38, f32::INFINITY, f32::NEG_INFINITY]),
        1 => any::<f32>(),
    ]
}

fn vector() -> impl Strategy<Value = [f32; 4]> {
    prop::array::uniform4(number())
}

/// Returns the result of one instruction as the language defines it, written independently of the program. The sources are already swizzled
/// and negated.
fn expected(opcode: Opcode, s: [f32; 4], t: [f32; 4], u: [f32; 4], rows: &[[f32; 4]]) -> [f32; 4] {
    let times = |a: f32, b: f32| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
    let by = |f: &dyn Fn(usize) -> f32| [f(0), f(1), f(2), f(3)];
    let three = |v: [f32; 4]| times(s[0], v[0]) + times(s[1], v[1]) + times(s[2], v[2]);
    let four = |v: [f32; 4]| three(v) + times(s[3], v[3]);
    let w = s[3];
    // Powers and logarithms are computed in f64 and rounded.
    let exp2 = |x: f32| f64::from(x).exp2() as f32;
    let log2 = |x: f32| f64::from(x).abs().log2() as f32;
    match opcode {
        Opcode::Mov => s,
        Opcode::Add => by(&|k| s[k] + t[k]),
        Opcode::Sub => by(&|k| s[k] - t[k]),
        Opcode::Mul => by(&|k| times(s[k], t[k])),
        Opcode::Mad => by(&|k| times(s[k], t[k]) + u[k]),
        Opcode::Dp3 => [three(t); 4],
        Opcode::Dp4 => [four(t); 4],
        Opcode::Min => by(&|k| if s[k] < t[k] { s[k] } else { t[k] }),
        Opcode::Max => by(&|k| if s[k] >= t[k] { s[k] } else { t[k] }),
        Opcode::Slt => by(&|k| f32::from(u8::from(s[k] < t[k]))),
        Opcode::Sge => by(&|k| f32::from(u8::from(s[k] >= t[k]))),
        Opcode::Rcp => [1.0 / w; 4],
        Opcode::Rsq => [(1.0 / f64::from(w).abs().sqrt()) as f32; 4],
        Opcode::Frc => by(&|k| s[k] - s[k].floor()),
        Opcode::Exp => [exp2(w); 4],
        Opcode::Expp => [exp2(w.floor()), w - w.floor(), exp2(w), 1.0],
        Opcode::Log => [log2(w); 4],
        Opcode::Logp if w == 0.0 => [f32::NEG_INFINITY, 1.0, f32::NEG_INFINITY, 1.0],
        Opcode::Logp if w.is_infinite() => [f32::INFINITY, 1.0, f32::INFINITY, 1.0],
        Opcode::Logp => {
            let mut exponent = 0.0;
            let mut mantissa = f64::from(w.abs());
            while mantissa >= 2.0 {
                (mantissa, exponent) = (mantissa / 2.0, exponent + 1.0);
            }
            while mantissa < 1.0 {
                (mantissa, exponent) = (mantissa * 2.0, exponent - 1.0);
            }
            [exponent, mantissa as f32, log2(w), 1.0]
        }
        Opcode::Dst => [1.0, times(s[1], t[1]), s[2], t[3]],
        Opcode::Lit => {
            let power = w.clamp(-127.996_09, 127.996_09);
            let lit = s[0] > 0.0 && s[1] > 0.0;
            let specular = if lit { f64::from(s[1]).powf(f64::from(power)) as f32 } else { 0.0 };
            [1.0, if s[0] > 0.0 { s[0] } else { 0.0 }, specular, 1.0]
        }
        Opcode::M3x2 => [three(rows[0]), three(rows[1]), 0.0, 0.0],
        Opcode::M3x3 => [three(rows[0]), three(rows[1]), three(rows[2]), 0.0],
        Opcode::M3x4 => [three(rows[0]), three(rows[1]), three(rows[2]), three(rows[3])],
        Opcode::M4x3 => [four(rows[0]), four(rows[1]), four(rows[2]), 0.0],
        Opcode::M4x4 => [four(rows[0]), four(rows[1]), four(rows[2]), four(rows[3])],
    }
}

/// Returns whether two results are equal. Results of powers and logarithms may differ by one step, where the last bit of f64 decides.
fn same(opcode: Opcode, found: f32, want: f32) -> bool {
    if found.is_nan() || want.is_nan() {
        return found.is_nan() && want.is_nan();
    }
    let rounded = matches!(opcode, Opcode::Exp | Opcode::Expp | Opcode::Log | Opcode::Logp | Opcode::Lit);
    found == want || rounded && found.to_bits().abs_diff(want.to_bits()) <= 1
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn instructions_compute_what_their_text_says(
        mut instruction in instruction(), vectors in prop::collection::vec(vector(), 16), into in 0..TEMPORARIES,
    ) {
        // Every register holds one of sixteen vectors.
        let inputs: Inputs = std::array::from_fn(|k| vectors[k]);
        let constants: Constants = std::array::from_fn(|k| vectors[k % 16]);
        for source in &mut instruction.sources {
            if let SourceRegister::Temporary(index) = source.register {
                source.register = SourceRegister::Input(index);
            }
            if let SourceRegister::Input(index) = &mut source.register {
                *index %= 12;
            }
            if let SourceRegister::Constant { index, relative } = &mut source.register {
                (*index, *relative) = (*index % 90, false);
            }
        }
        let fetch = |n: usize, row: usize| instruction.sources.get(n).map_or([0.0; 4], |source| {
            let value = match source.register {
                SourceRegister::Input(index) => vectors[index + row],
                SourceRegister::Constant { index, .. } => vectors[(index + row) % 16],
                SourceRegister::Temporary(_) => unreachable!(),
            };
            let swizzled = source.swizzle.map(|k| value[k]);
            if source.negate { swizzled.map(|c| -c) } else { swizzled }
        });
        let rows = [0, 1, 2, 3].map(|row| fetch(1, row));
        let want = expected(instruction.opcode, fetch(0, 0), fetch(1, 0), fetch(2, 0), &rows);
        let mask = instruction.destination.mask;
        instruction.destination.register = DestinationRegister::Temporary(into);
        let all = Source { register: SourceRegister::Temporary(into), swizzle: [0, 1, 2, 3], negate: false };
        let show = Instruction {
            opcode: Opcode::Mov,
            destination: Destination { register: DestinationRegister::Coordinates(2), mask: 15 },
            sources: vec![all],
        };
        let opcode = instruction.opcode;
        let shader = VertexShader { definitions: vec![], instructions: vec![instruction, show] };
        let found = evaluate(&shader, &constants, &inputs).coordinates[2];
        for k in 0..4 {
            let want = if mask >> k & 1 != 0 { want[k] } else { 0.0 };
            prop_assert!(same(opcode, found[k], want), "{}: {:?} is not {want} in {k}", opcode.word(), found);
        }
    }

    #[test]
    fn any_program_reads_back_from_what_is_printed(shader in shader()) {
        let text = print(&shader);
        let found = parse(&text).unwrap_or_else(|findings| panic!("{text}\n{findings:?}"));
        prop_assert_eq!(&found.shader, &shader, "{}", text);
        prop_assert_eq!(found.places.len(), shader.instructions.len());
    }

    #[test]
    fn garbage_is_read_or_refused(text in "\\PC{0,80}") {
        if let Err(findings) = read(&text) {
            prop_assert!(!findings.is_empty() && findings.len() <= 128);
        }
    }

    #[test]
    fn shuffled_words_are_read_or_refused(
        words in prop::collection::vec(prop::sample::select(vec![
            "vs.1.1", "\n", "mov", "mad", "m4x4", "def", "rsq", "frc", "lit", " ", ",", ".", "-", "x", "xyz", "yzxw", "r0", "r1", "c0", "c08",
            "c[", "a0.x", "+", "]", "v3", "oPos", "oD0", "oT0", "oFog", ";", "//", "/*", "*/", "1", "0.5f", "1e3", "é",
        ]), 0..60),
    ) {
        let text = words.concat();
        match read(&text) {
            Ok(written) => prop_assert_eq!(parse(&print(&written.shader)).unwrap().shader, written.shader),
            Err(findings) => {
                for finding in findings {
                    let span = finding.span.unwrap();
                    prop_assert!(text.get(span.clone()).is_some(), "{:?} in {:?}", span, text);
                }
            }
        }
    }
}

/// A stream of random programs and their inputs.
struct Stream(Random);

impl Stream {
    fn next(&mut self, below: usize) -> usize {
        self.0.below(below as u128) as usize
    }

    fn number(&mut self) -> f32 {
        self.next(4001) as f32 / 500.0 - 4.0
    }

    fn source(&mut self) -> Source {
        let register = match self.next(3) {
            0 => SourceRegister::Input(self.next(INPUTS)),
            1 => SourceRegister::Temporary(self.next(TEMPORARIES)),
            _ => SourceRegister::Constant { index: self.next(CONSTANTS), relative: self.next(4) == 0 },
        };
        Source { register, swizzle: std::array::from_fn(|_| self.next(4)), negate: self.next(2) == 0 }
    }

    fn instruction(&mut self) -> Instruction {
        let opcode = Opcode::ALL[self.next(Opcode::ALL.len())];
        let register = match self.next(8) {
            0 => DestinationRegister::Position,
            1 => DestinationRegister::Coordinates(self.next(COORDINATES)),
            2 => DestinationRegister::Address,
            _ => DestinationRegister::Temporary(self.next(TEMPORARIES)),
        };
        let sources = (0..opcode.sources()).map(|_| self.source()).collect();
        Instruction { opcode, destination: Destination { register, mask: 1 + self.next(15) as u8 }, sources }
    }
}

#[test]
fn programs_give_the_same_bits_on_every_machine() {
    let mut stream = Stream(Random::seeded(1));
    let mut digest = Sha256::new();
    for _ in 0..2000 {
        let constants: Constants = std::array::from_fn(|_| std::array::from_fn(|_| stream.number()));
        let inputs: Inputs = std::array::from_fn(|_| std::array::from_fn(|_| stream.number()));
        let instructions = (0..24).map(|_| stream.instruction()).collect();
        let outputs = evaluate(&VertexShader { definitions: vec![], instructions }, &constants, &inputs);
        for value in outputs.position.iter().chain(outputs.coordinates.iter().flatten()) {
            let value = if value.is_nan() { f32::NAN.abs() } else { *value };
            digest.update(value.to_bits().to_le_bytes());
        }
    }
    let hexadecimal: String = digest.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(hexadecimal, "aaed603dc165bec2");
}

#[test]
fn people_write_it_in_many_ways() {
    let plain = accepted("vs.1.1\nm4x4 oPos, v0, c8\nmad r0.xyz, -v3.zxyw, c12.x, v3.xyzz\nmov oD0, r0.xyzx\n");
    for other in [
        "VS.1.1\nM4X4 OPOS,V0,C08;\nMad R0.XYZ,-V3.ZXYW,C12.X,V3.xyz ; comment\nMOV oD0,r0.xyzx // end",
        "  vs_1_1 /* one */\n\n\tm4x4\toPos , v0 , c[8]\n mad r0 .xyz , - v3.zxyw, c12.xx, v3 . xyz;;\r\nmov oD0, r0.xyzx",
        "m4x4 oPos, v0, c8\nnop\nmad r0.xyz, -v3.zxyw, c12.x, v3.xyzz\nmov oD0.xyzw, r0.xyzx",
    ] {
        assert_eq!(accepted(other), plain, "{other}");
    }
    let table = accepted("mov a0.x, v1.x\nm4x4 oPos, v0, c[a0.x + 20]\nmov oD0, c[4+a0.x]\nmov oT0, c[a0.x]");
    assert_eq!(
        print(&table),
        "vs.1.1\nmov a0.x, v1.x\nm4x4 oPos, v0, c[a0.x + 20]\nmov oD0, c[a0.x + 4]\nmov oT0, c[a0.x]\n"
    );
    let defined = accepted("vs.1.1\ndef c3, 0.5f, -1, 2e-3, .25\nmov oPos, c3");
    assert_eq!(defined.definitions, [(3, [0.5, -1.0, 0.002, 0.25])]);
    let fog = accepted("mov oPos, v0\nmov oFog, v0.z\nmov oPts.x, v0.w");
    assert_eq!(fog.written(DestinationRegister::Fog), 1);
    assert_eq!(fog.slots(), 3);
    assert_eq!(accepted("exp r0.x, v0.x\nfrc r0.y, v0.x\nm4x3 r1.xyz, v0, c0\nmov oPos, r0.xyxy").slots(), 17);
}

#[test]
fn what_is_not_the_language_is_said() {
    let with = |line: &str| codes(&format!("{line}\nmov oPos, v0"));
    assert_eq!(with("vs.2.0"), ["NB0108"]);
    assert_eq!(with("ps.1.1"), ["NB0108"]);
    assert_eq!(with("mov oD0 v0"), ["NB0108"]);
    assert_eq!(with("dcl_position v0"), ["NB0108"]);
    assert_eq!(with("mov oD0, c[b]"), ["NB0108"]);
    assert_eq!(with("nrm oD0, v0"), ["NB0204"]);
    assert_eq!(with("mov oD0, x0"), ["NB0204"]);
    assert_eq!(with("def c0, 0, 1, b, 3"), ["NB0205"]);
    assert_eq!(with("mov oD0, r12"), ["NB0206"]);
    assert_eq!(with("mov oT4, v0"), ["NB0206"]);
    assert_eq!(with("mov oD0, c[96]"), ["NB0206"]);
    assert_eq!(with("m4x4 r0, v0, c93"), ["NB0206"]);
    assert_eq!(with("mov oD0, v0, v0"), ["NB0211"]);
    assert_eq!(with("def c0, 1, 2"), ["NB0211"]);
    assert_eq!(with("mov oD0, oD1"), ["NB0380"]);
    assert_eq!(with("mov c4, v0"), ["NB0380"]);
    assert_eq!(with("mov -r0, v0"), ["NB0380"]);
    assert_eq!(with("add a0.x, v0, v0"), ["NB0380"]);
    assert_eq!(with("mov oD0, a0.x"), ["NB0380"]);
    assert_eq!(with("add oD0, c0, c1"), ["NB0382"]);
    assert_eq!(with("mad oD0, v0, v1, c0"), ["NB0382"]);
    assert_eq!(with("mov oD0, c[a0.x]"), ["NB0383"]);
    assert_eq!(with("mov oD0, r0"), ["NB0383"]);
    assert_eq!(with("mov oD0.yx, v0"), ["NB0384"]);
    assert_eq!(with("mov oD0.rgb, v0"), ["NB0384"]);
    assert_eq!(with("mov oD0, v0.xyzwx"), ["NB0384"]);
    assert_eq!(with("frc r0, v0"), ["NB0384"]);
    assert_eq!(with("mov oFog.xy, v0"), ["NB0384"]);
    assert_eq!(with("m3x3 r0.xy, v0, c0"), ["NB0384"]);
    assert_eq!(with("mov r0, v0\nm4x4 r0, r0, c0"), ["NB0384"]);
    assert_eq!(codes("mov oD0, v0"), ["NB0386"]);
    assert_eq!(codes(""), ["NB0386"]);
    assert_eq!(with("def c0, 0, 0, 0, 0\ndef c0, 1, 1, 1, 1"), ["NB0388"]);
    let long = |lines: usize| format!("{}mov oPos, v0", "add oD0, v0, v0\n".repeat(lines));
    accepted(&long(127));
    assert_eq!(codes(&long(128)), ["NB0385"]);
}

#[test]
fn unwritten_components_count_where_they_matter() {
    // Nothing reads the fourth component of a cross product in a basis of three vectors.
    accepted(
        "m3x3 r3, v8, c0\nm3x3 r5, v3, c0\nmul r0, r3.zxyw, r5.yzxw\nmad r4, r3.yzxw, r5.zxyw, -r0\ndp3 oD0.x, r4, c12\nmov oPos, v0",
    );
    let found = refused("m3x3 r3, v8, c0\nmul r4, r3.yzxw, v3\nmov oD0, r4\nmov oPos, v0");
    assert_eq!(found.len(), 1);
    assert!(found[0].message.contains("r3.w"), "{found:?}");
    accepted("mov r0.x, v0\nrcp r0.y, r0.x\nmov oPos, r0.xyxy");
    assert_eq!(codes("rcp r0.y, r0.w\nmov oPos, r0.y"), ["NB0383"]);
    // Reading an unwritten register is not reported if nothing depends on the result.
    accepted("mov r1, r2\nmov oPos, v0");
}

#[test]
fn doubtful_programs_are_warned_of() {
    assert_eq!(warned("mov oPos, v0; mov oD0, v1"), ["NB0913"]);
    accepted("mov oPos, v0; mov what is there, as it is\n; mov oD0, v1");
    assert_eq!(warned("rsq r0, v0\nmov oPos, r0"), ["NB0912"]);
    assert_eq!(warned("m4x4 oPos, v0, c8\nmov oD0, c10"), ["NB0911"]);
    assert_eq!(warned("m4x4 oPos, v0, c8\ndp3 oD0, v3, -c10"), ["NB0911"]);
    assert_eq!(warned("m4x4 oPos, v0, c8\nm3x3 oD0.xyz, v3, c10"), ["NB0911"]);
    // Single rows, the upper part of the same matrix, and the constant after it are no reason for a warning.
    accepted("m4x4 oPos, v0, c8\ndp4 oD0.x, v0, c10\nm3x3 oT0.xyz, v3, c8\nmov oT1, c12\nm3x3 oT2.xyz, v3, c13");
}

/// The table of the page is generated from the comments on the instructions.
#[test]
fn the_document_lists_the_instructions() {
    let source = std::fs::read_to_string(at("src/model/vertex/shader/mod.rs")).unwrap();
    let list = source.split("opcodes! {").nth(1).unwrap().split("\n}").next().unwrap();
    let comments: Vec<&str> = list.lines().filter_map(|line| line.trim().strip_prefix("/// ")).collect();
    assert_eq!(comments.len(), Opcode::ALL.len());
    let mut table = "| instruction | result | slots |\n|---|---|---:|\n".to_owned();
    for (opcode, comment) in Opcode::ALL.iter().zip(comments) {
        let sources = match opcode.matrix() {
            Some(_) => "s, c",
            None => ["s", "s, t", "s, t, u"][opcode.sources() - 1],
        };
        let result = comment.trim_end_matches('.').replace('|', "\\|");
        table += &format!("| `{} d, {sources}` | {result} | {} |\n", opcode.word(), opcode.slots());
    }
    pages::hold("docs/languages/vertex-shader.md", "tests/vertex_programs.rs", &table);
}

/// The program in `docs/languages/vertex-shader.md` is valid.
#[test]
fn the_document_is_about_this_language() {
    let document = std::fs::read_to_string(at("docs/languages/vertex-shader.md")).unwrap();
    let program = document.split("```vs\n").nth(1).unwrap().split("```").next().unwrap();
    accepted(program);
}
