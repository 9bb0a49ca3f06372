//! Tests pixel shaders against the definitions of Direct3D.

use super::Choices;
use super::direct3d::told_apart;
use super::run::{Pixel, bound, run};
use ninebit::diagnostic::Severity;
use ninebit::state::{Named, Profile, Register, Scale, ShaderOperation};
use ninebit_program::Spanned;
use ninebit_program::pixel_shader::{
    Arithmetic, Bank, Bump, CONSTANTS, Context, Definition, LoweredProgram, Mask, Modifier, Operation, PixelShader,
    Selector, ShaderRegister, Source, Target, TextureInstruction, TextureOperation, TextureSource, Version, lower,
    parse, print,
};
use proptest::prelude::*;

/// Returns a random multiple of 1/255 from -1 to 1.
fn constant(choices: &mut Choices) -> f32 {
    (choices.below(511) as f32 - 255.0) / 255.0
}

fn source(choices: &mut Choices, known: &[ShaderRegister], mask: Mask) -> Source {
    let register = choices.of(known);
    let selector = match (choices.below(5), mask) {
        (0, _) => Selector::Alpha,
        (1, Mask::Alpha) => Selector::Blue,
        _ => Selector::All,
    };
    let modifier = if choices.flag() { Modifier::Plain } else { choices.of(Modifier::ALL) };
    let negate = modifier != Modifier::Invert && choices.below(3) == 0;
    Source { register, selector, modifier, negate }
}

fn arithmetic(choices: &mut Choices, known: &[ShaderRegister], target: Target, paired: bool) -> Arithmetic {
    let operation = loop {
        let operation = choices.of(Operation::ALL);
        if operation != Operation::Dp3 || target.mask != Mask::Alpha {
            break operation;
        }
    };
    let condition = Source {
        register: ShaderRegister { bank: Bank::Temporary, index: 0 },
        selector: Selector::Alpha,
        modifier: Modifier::Plain,
        negate: false,
    };
    let sources = (0..operation.sources())
        .map(|n| match (operation, n) {
            (Operation::Cnd, 0) => condition,
            _ => source(choices, known, target.mask),
        })
        .map(Spanned::default_of)
        .collect();
    let scale = if choices.flag() { Scale::One } else { choices.of(Scale::ALL) };
    let saturate = choices.below(3) == 0;
    Arithmetic { operation, scale, saturate, target: Spanned::default_of(target), sources, paired, span: 0..0 }
}

fn registers(bank: Bank, count: u8) -> Vec<ShaderRegister> {
    (0..count).map(|index| ShaderRegister { bank, index }).collect()
}

/// Returns a random shader with `slots` arithmetic slots, which reads only registers that have a value. An instruction may still read more
/// registers than the language allows.
fn shader(choices: &mut Choices, textures: u8, slots: usize) -> PixelShader {
    let mut known = registers(Bank::Texture, textures);
    known.extend(registers(Bank::Color, 2));
    known.extend(registers(Bank::Constant, 3));
    let written: Vec<_> = registers(Bank::Temporary, 2).into_iter().chain(registers(Bank::Texture, textures)).collect();
    let mut program = PixelShader {
        version: Version::Ps11,
        definitions: (0..choices.below(4) as u8).map(|index| definition(choices, index)).collect(),
        textures: (0..textures).map(|unit| texture(TextureOperation::Tex, unit, None)).collect(),
        arithmetic: Vec::new(),
    };
    let whole = |register| Target { register, mask: Mask::All };
    let temporary = registers(Bank::Temporary, 2);
    for (n, register) in temporary.iter().enumerate().take(slots) {
        let first = Arithmetic { operation: Operation::Mov, ..arithmetic(choices, &known, whole(*register), false) };
        let sources = vec![Spanned::default_of(source(choices, &known, Mask::All))];
        program.arithmetic.push(Arithmetic { sources, ..first });
        known.push(temporary[n]);
    }
    for _ in 2..slots {
        let [one, other] = [0, 1].map(|_| choices.of(&written));
        match choices.below(4) {
            0 => {
                let flip = choices.flag();
                let masks = if flip { [Mask::Color, Mask::Alpha] } else { [Mask::Alpha, Mask::Color] };
                for (n, (register, mask)) in [one, other].into_iter().zip(masks).enumerate() {
                    program.arithmetic.push(arithmetic(choices, &known, Target { register, mask }, n == 1));
                }
            }
            1 => {
                let mask = choices.of(&[Mask::Color, Mask::Alpha]);
                program.arithmetic.push(arithmetic(choices, &known, Target { register: one, mask }, false));
            }
            _ => program.arithmetic.push(arithmetic(choices, &known, whole(one), false)),
        }
    }
    program
}

fn definition(choices: &mut Choices, index: u8) -> Definition {
    Definition { index, value: std::array::from_fn(|_| constant(choices)), span: 0..0 }
}

fn texture(operation: TextureOperation, unit: u8, source: Option<TextureSource>) -> TextureInstruction {
    TextureInstruction {
        operation,
        unit: Spanned::default_of(unit),
        source: source.map(Spanned::default_of),
        eye: None,
        span: 0..0,
    }
}

/// Returns the shader without the places in its text, so that shaders from different texts compare equal.
fn bare(mut program: PixelShader) -> PixelShader {
    program.definitions.iter_mut().for_each(|definition| definition.span = 0..0);
    for texture in &mut program.textures {
        (texture.span, texture.unit.span) = (0..0, 0..0);
        texture.source.iter_mut().for_each(|source| source.span = 0..0);
        texture.eye.iter_mut().for_each(|eye| eye.span = 0..0);
    }
    for instruction in &mut program.arithmetic {
        (instruction.span, instruction.target.span) = (0..0, 0..0);
        instruction.sources.iter_mut().for_each(|source| source.span = 0..0);
    }
    program
}

/// The registers of the language while a shader runs.
struct State {
    banks: [Vec<[f64; 4]>; 4],
    /// Whether a condition was so close to one half that rounding may decide it.
    close: bool,
}

impl State {
    fn new(program: &PixelShader, context: &Context, pixel: &Pixel) -> State {
        let mut constants = context.constants;
        for definition in &program.definitions {
            constants[usize::from(definition.index)] = definition.value;
        }
        // The chip stores constants as multiples of 1/255.
        let held = |c: f32| (f64::from(c.clamp(-1.0, 1.0)) * 255.0).round() / 255.0;
        let constants = constants.map(|color| color.map(held)).to_vec();
        let textures = pixel.textures.map(Pixel::real).to_vec();
        let colors = vec![Pixel::real(pixel.diffuse), Pixel::real(pixel.specular)];
        State { banks: [constants, vec![[0.0; 4]; 2], textures, colors], close: false }
    }

    fn register(&mut self, register: ShaderRegister) -> &mut [f64; 4] {
        &mut self.banks[register.bank as usize][usize::from(register.index)]
    }

    fn read(&mut self, source: &Source) -> [f64; 4] {
        let value = *self.register(source.register);
        let value = match source.selector {
            Selector::All => value,
            Selector::Alpha => [value[3]; 4],
            Selector::Blue => [value[2]; 4],
        };
        value.map(|x| {
            let y = match source.modifier {
                Modifier::Plain => x,
                Modifier::Bias => x.max(0.0) - 0.5,
                Modifier::SignedScale => 2.0 * x.max(0.0) - 1.0,
                Modifier::Invert => 1.0 - x.max(0.0),
            };
            if source.negate { -y } else { y }
        })
    }

    fn result(&mut self, instruction: &Arithmetic) -> [f64; 4] {
        let s: Vec<[f64; 4]> = instruction.sources.iter().map(|source| self.read(&source.value)).collect();
        let condition = self.banks[1][0][3];
        let compares = !(instruction.paired && instruction.target.value.mask == Mask::Color);
        self.close |= instruction.operation == Operation::Cnd && compares && (condition - 0.5).abs() < 1e-9;
        let value = |n: usize| match instruction.operation {
            Operation::Mov => s[0][n],
            Operation::Add => s[0][n] + s[1][n],
            Operation::Sub => s[0][n] - s[1][n],
            Operation::Mul => s[0][n] * s[1][n],
            Operation::Mad => s[0][n] * s[1][n] + s[2][n],
            Operation::Lrp => {
                let f = s[0][n].max(0.0);
                f * s[1][n] + (1.0 - f) * s[2][n]
            }
            Operation::Dp3 => (0..3).map(|n| s[0][n] * s[1][n]).sum(),
            Operation::Cnd if condition > 0.5 || !compares => s[1][n],
            Operation::Cnd => s[2][n],
        };
        let factor = match instruction.scale {
            Scale::One => 1.0,
            Scale::Two => 2.0,
            Scale::Four => 4.0,
            Scale::Half => 0.5,
        };
        let least = if instruction.saturate { 0.0 } else { -1.0 };
        [0, 1, 2, 3].map(|n| (value(n) * factor).clamp(least, 1.0))
    }

    /// Runs the shader for one pixel and returns its colour, R, G, B, A in 0..1.
    fn run(&mut self, program: &PixelShader) -> [f64; 4] {
        for slot in program.slots() {
            let results: Vec<[f64; 4]> = slot.iter().map(|instruction| self.result(instruction)).collect();
            for (instruction, result) in slot.iter().zip(results) {
                let Target { register, mask } = instruction.target.value;
                let register = self.register(register);
                for n in 0..4 {
                    if mask.has(n == 3) {
                        register[n] = result[n];
                    }
                }
            }
        }
        self.banks[1][0].map(|c| c.clamp(0.0, 1.0))
    }
}

fn lowered(text: &str, profile: Profile) -> LoweredProgram {
    let program = parse(text).unwrap_or_else(|findings| panic!("{text}\n{findings:?}")).program;
    lower(&program, &Context::new(profile)).unwrap_or_else(|findings| panic!("{text}\n{findings:?}"))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Combiners of a random shader yield the colour that the language defines if they run in real numbers. In integers they stay within
    /// the bound of their rounding.
    #[test]
    fn shaders_are_what_the_language_says(seed in any::<u64>(), nv10 in any::<bool>()) {
        let mut choices = Choices::new(seed);
        let profile = if nv10 { Profile::Nv10 } else { Profile::Nv2a };
        let slots = 1 + choices.below(if nv10 { 2 } else { 8 });
        let program = shader(&mut choices, if nv10 { 2 } else { 4 }, slots);
        let text = print(&program);
        let parsed = match parse(&text) {
            Ok(parsed) => parsed,
            Err(findings) => {
                // The generator does not limit the registers that an instruction reads, and both instructions of a pair may write the same
                // register.
                for finding in findings.iter().filter(|finding| finding.severity == Severity::Error) {
                    prop_assert_eq!(finding.code, "NB0372", "{:?}\n{}", finding, text);
                }
                return Ok(());
            }
        };
        prop_assert_eq!(bare(parsed.program.clone()), program.clone(), "{}", text);
        let constants = std::array::from_fn(|_| std::array::from_fn(|_| constant(&mut choices)));
        let context = Context { constants, fog: false, ..Context::new(profile) };
        match lower(&program, &context) {
            Ok(lowered) => {
                prop_assert!(lowered.combiners.stages.len() <= profile.general_stages());
                prop_assert_eq!(lowered.combiners.stages.len(), lowered.origins.len());
                let [rgb, alpha] = bound(&lowered.combiners, 1.0);
                let selects = lowered.combiners.stages.iter().any(|stage| stage.rgb.mux || stage.alpha.mux);
                for _ in 0..4 {
                    let pixel = Pixel::from_choices(&mut choices);
                    let mut state = State::new(&program, &context, &pixel);
                    let expected = state.run(&program);
                    if state.close {
                        continue;
                    }
                    let ideal = run::<f64>(&lowered.combiners, profile, &pixel);
                    let fixed = run::<i32>(&lowered.combiners, profile, &pixel);
                    for n in 0..4 {
                        let off = (ideal[n] / 255.0 - expected[n]).abs();
                        prop_assert!(off < 1e-12, "{n}: {} is not {}\n{text}{pixel:?}\n{lowered:#?}", ideal[n] / 255.0, expected[n]);
                        // If the shader has a condition, the integers may decide it the other way, and no bound applies.
                        let bound = if n < 3 { rgb } else { alpha };
                        let off = (f64::from(fixed[n]) - ideal[n]).abs();
                        prop_assert!(selects || off <= bound + 1e-9, "{n}: {} further than {bound} from {}\n{text}", fixed[n], ideal[n]);
                    }
                }
            }
            Err(findings) => {
                // The shader may need more than the eight stages, or on nv10 more than two constants, or the alpha of v1.
                for finding in findings {
                    let room = if nv10 { &["NB0309", "NB0350", "NB0351", "NB0379"][..] } else { &["NB0350", "NB0379"] };
                    prop_assert!(room.contains(&finding.code), "{finding:?}\n{text}");
                }
            }
        }
    }

    /// Texture instructions, pairs and constants survive printing and reading.
    #[test]
    fn what_is_printed_is_read(seed in any::<u64>()) {
        let mut choices = Choices::new(seed);
        let mut program = shader(&mut choices, 4, 3);
        program.version = choices.of(&[Version::Ps11, Version::Ps12, Version::Ps13]);
        let row = |unit, signed_scale| Some(TextureSource { unit, signed_scale });
        use TextureOperation as Op;
        let signed = choices.flag();
        let last = choices.of(&[Op::Texm3x3tex, Op::Texm3x3spec, Op::Texm3x3vspec]);
        program.textures = match choices.below(3) {
            0 => vec![
                texture(Op::Tex, 0, None),
                texture(Op::Texm3x3pad, 1, row(0, signed)),
                texture(Op::Texm3x3pad, 2, row(0, signed)),
                texture(last, 3, row(0, signed)),
            ],
            1 => vec![
                texture(Op::Texcoord, 0, None),
                texture(choices.of(&[Op::Texbem, Op::Texbeml, Op::Texreg2ar, Op::Texreg2gb]), 1, row(0, false)),
                texture(Op::Texm3x2pad, 2, row(1, signed)),
                texture(Op::Texm3x2tex, 3, row(0, signed)),
            ],
            _ => vec![texture(Op::Tex, 0, None), texture(Op::Texkill, 2, None), texture(Op::Tex, 3, None)],
        };
        for texture in program.textures.iter_mut().filter(|texture| texture.operation == Op::Texm3x3spec) {
            texture.eye = Some(Spanned::default_of(choices.below(CONSTANTS) as u8));
        }
        let text = print(&program);
        match parse(&text) {
            Ok(parsed) => prop_assert_eq!(bare(parsed.program), program, "{}", text),
            // A shader must not read registers that the pad instructions and texkill leave without a value.
            Err(findings) => {
                for finding in findings.iter().filter(|finding| finding.severity == Severity::Error) {
                    prop_assert!(["NB0372", "NB0375"].contains(&finding.code), "{finding:?}\n{text}");
                }
            }
        }
    }

    /// Any text is either read or refused with places inside the text, and a shader that is read survives printing.
    #[test]
    fn nothing_makes_it_fail(
        text in "(?s)(ps\\.1\\.1|tex t0|mov|dp3|lrp_sat|_x2|_bx2|_bias|[rtvc][0-9]|r0|\\.a|\\.rgb|,|\\+|-|1-|def c0,1,0,0,1|texm3x2pad|;|//|\n| |[0-9.e]|\\PC){0,40}"
    ) {
        match parse(&text) {
            Err(findings) => {
                prop_assert!(!findings.is_empty());
                for finding in findings {
                    let span = finding.span.unwrap();
                    prop_assert!(text.get(span.clone()).is_some(), "{span:?} in {text:?}");
                }
            }
            Ok(parsed) => {
                let again = parse(&print(&parsed.program)).map(|again| bare(again.program));
                prop_assert_eq!(again, Ok(bare(parsed.program)));
            }
        }
    }
}

/// Returns shaders that differ in the instruction in the middle: one for each kind of instruction and each modifier.
fn variants() -> Vec<String> {
    let mut texts = Vec::new();
    let around = |instruction: &str| {
        format!("ps.1.1\ntex t0\ntex t1\nmov r0, v1\nmov r1, v0\n{instruction}\nmad_d2 r0, r1, t1, t0")
    };
    for operation in
        ["mov r1, t0", "add r1, t0, v0", "sub r1, t0, v0", "mul r1, t0, v0", "dp3 r1, t0, v0", "mad r1, t0, v0, v1"]
    {
        texts.push(around(operation));
    }
    for operation in ["lrp r1, t0, v0, v1", "cnd r1, r0.a, t0, t1", "cnd r1, r0.a, t1, t0"] {
        texts.push(around(operation));
    }
    for suffix in ["_x2", "_x4", "_d2", "_sat", "_x2_sat", "_x4_sat", "_d2_sat"] {
        texts.push(around(&format!("sub{suffix} r1, t0, v0")));
    }
    for source in ["-t0", "t0_bias", "-t0_bias", "t0_bx2", "-t0_bx2", "1-t0", "t0.a", "-t0.a", "t1", "v1"] {
        texts.push(around(&format!("mov r1, {source}")));
    }
    for masked in
        ["mov r1.rgb, t0", "mov r1.a, t0", "mov r1.a, t0.b", "mov r1.rgb, t0\n+ mov r1.a, t1", "mov r1.rgb, t0.a"]
    {
        texts.push(around(masked));
    }
    texts
}

#[test]
fn every_two_instructions_differ_somewhere() {
    let texts = variants();
    let programs: Vec<_> = texts.iter().map(|text| lowered(text, Profile::Nv2a).combiners).collect();
    for n in 0..programs.len() {
        for m in 0..n {
            assert!(told_apart(&programs[n], &programs[m]), "{}\n{}", texts[n], texts[m]);
        }
    }
}

#[test]
fn every_texture_instruction_has_its_operation() {
    let text = |rest: &str| format!("ps.1.1\n{rest}\nmov r0, v0");
    let bump = Bump { matrix: Some([1.0, 2.0, 3.0, 4.0]), luminance: Some([0.5, 0.25]) };
    let operations = |rest: &str| {
        let mut context = Context { bumps: [bump; 4], ..Context::new(Profile::Nv2a) };
        context.constants[3] = [0.25, -2.0, 0.5, 1.0];
        let program = parse(&text(rest)).unwrap().program;
        lower(&program, &context)
            .unwrap()
            .units
            .map(|unit| unit.map(|unit| (unit.operation, unit.previous, unit.mapping.name())))
    };
    use ShaderOperation as Op;
    let none = "ZeroToOne";
    let of = |rest: &str, unit: usize| operations(rest)[unit];
    assert_eq!(of("tex t2", 2), Some((Op::Sample, 1, none)));
    assert_eq!(of("tex t2", 0), None);
    assert_eq!(of("texcoord t0", 0), Some((Op::PassThrough, 0, none)));
    assert_eq!(of("texkill t3", 3), Some((Op::CullFragment { drops_not_negative: [false; 4] }, 2, none)));
    // The registers have the order M00, M01, M11, M10.
    let matrix = [1.0, 2.0, 4.0, 3.0];
    let moved = |luminance| Some((Op::BumpEnvironment { matrix, luminance }, 0, none));
    assert_eq!(of("tex t0\ntexbem t3, t0", 3), moved(None));
    assert_eq!(of("tex t0\ntexbeml t2, t0", 2), moved(Some([0.5, 0.25])));
    assert_eq!(of("tex t0\ntex t1\ntexreg2ar t2, t1", 2), Some((Op::DependentAlphaRed, 1, none)));
    assert_eq!(of("tex t0\ntexreg2gb t1, t0", 1), Some((Op::DependentGreenBlue, 0, none)));
    let rows = operations("tex t0\ntexm3x2pad t1, t0_bx2\ntexm3x2tex t2, t0");
    assert_eq!(rows[1], Some((Op::DotProduct, 0, "MinusOneToOneD3d")));
    assert_eq!(rows[2], Some((Op::DotProduct2D, 0, none)));
    for (last, operation) in [
        ("texm3x3tex t3, t0", Op::DotProductCube),
        ("texm3x3vspec t3, t0", Op::DotReflectSpecular),
        ("texm3x3spec t3, t0, c3", Op::DotReflectConstantEye { eye: [0.25, -1.0, 0.5] }),
    ] {
        assert_eq!(of(&format!("tex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\n{last}"), 3), Some((operation, 0, none)));
    }
    let signed = Context { signed: [true; 4], ..Context::new(Profile::Nv2a) };
    let program = parse(&text("tex t0\ntexm3x2pad t1, t0\ntexm3x2tex t2, t0")).unwrap().program;
    let units = lower(&program, &signed).unwrap().units;
    assert_eq!(units[2].as_ref().map(|unit| unit.mapping.name()), Some("MinusOneToOne"));
}

/// Three common shaders, and the number of stages that they need on both chips: diffuse light, a highlight, and a sky.
#[test]
fn light_as_people_write_it() {
    let diffuse =
        "PS.1.1 // light\n  tex t0; colour\n  tex\tt1 ; normals\n\ndp3_SAT  r1 , t1_BX2,v0_bx2\nMUL R0,t0,    r1;";
    for profile in [Profile::Nv10, Profile::Nv2a] {
        assert_eq!(lowered(diffuse, profile).combiners.stages.len(), 2);
    }
    let highlight =
        "ps_1_1\ntex t0\ntex t1\ndp3_sat r0, t1_bx2, v1_bx2\nmul r1, r0, r0\nmul r0, r1, r1\nmul r0, r0, t0";
    assert_eq!(lowered(highlight, Profile::Nv2a).combiners.stages.len(), 4);
    let program = parse(highlight).unwrap().program;
    let refused = lower(&program, &Context::new(Profile::Nv10)).unwrap_err();
    assert_eq!(refused.len(), 1);
    assert_eq!(refused[0].message, "this pixel shader needs 4 general stages; nv10 has 2");
    assert!(refused[0].notes[0].contains("DotProduct3"), "{refused:?}");
    // This shader has no version line, and the instruction that reads a saturated result limits it.
    let sky = "tex t0\ntex t1\ndp3_d2_sat r0, v0_bx2, t0_bx2\nadd r0, r0, c5\nlrp r0, r0, c1, c2\nmul r0, r0, t1";
    let parsed = parse(sky).unwrap();
    assert_eq!(parsed.warnings.iter().map(|warning| warning.code).collect::<Vec<_>>(), ["NB0906"]);
    assert_eq!(lower(&parsed.program, &Context::new(Profile::Nv2a)).unwrap().combiners.stages.len(), 4);
    let table = "ps.1.1\ntex t0\ntexm3x2pad t1, t0_bx2\ntexm3x2tex t2, t0_bx2\nmov r0, t2\nmul r0, r0, t3";
    let findings = parse(table).unwrap_err();
    assert_eq!(findings[0].message, "mul reads t3, which no texture instruction loads");
    assert_eq!(&table[findings[0].span.clone().unwrap()], "t3");
    let mended = table.replace("t0_bx2\nmov", "t0_bx2\ntex t3\nmov");
    assert_eq!(lowered(&mended, Profile::Nv2a).combiners.stages.len(), 2);
}

#[test]
fn cnd_takes_its_second_source_above_one_half() {
    let text = "ps.1.1\ntex t0\nmov r0, t0\ncnd r0.rgb, r0.a, v0, v1";
    let combiners = lowered(text, Profile::Nv10).combiners;
    let stage = &combiners.stages[1].rgb;
    assert!(stage.mux);
    assert_eq!(
        [stage.inputs[0].register, stage.inputs[2].register],
        [Register::SecondaryColor, Register::PrimaryColor]
    );
    let mut pixel = Pixel::from_choices(&mut Choices::new(5));
    for alpha in 0..=255 {
        pixel.textures[0][3] = alpha;
        let expected = if alpha >= 128 { pixel.diffuse } else { pixel.specular };
        let shown = run::<i32>(&combiners, Profile::Nv10, &pixel);
        assert_eq!(shown.map(|c| c as u8)[..3], expected[..3], "{alpha}");
    }
}

#[test]
fn a_saturated_result_is_never_negative_to_a_reader() {
    // Only the negative of a saturated register needs an additional stage.
    for (reader, stages) in [
        ("mov r0, r1", 2),
        ("mul r0, r1_bx2, v0", 2),
        ("sub r0, v0, r1", 2),
        ("mad r0, -r1, t0, v0", 2),
        ("mov r0, 1-r1", 2),
        ("mul r0, -r1, r1", 3),
        ("mad r0, -r1, 1-t0, v0", 3),
    ] {
        let text = format!("ps.1.1\ntex t0\nsub_sat r1, t0, v0\n{reader}");
        assert_eq!(lowered(&text, Profile::Nv2a).combiners.stages.len(), stages, "{reader}");
    }
}

/// In a pair whose second instruction is the colour `cnd`, the condition has no effect. It has one if `cnd` is first.
#[test]
fn a_color_cnd_behind_plus_takes_its_second_source() {
    let text = |pair: &str| format!("ps.1.1\ntex t0\ntex t1\nmov r0, v0\n{pair}");
    let pixel = Pixel {
        diffuse: [10, 20, 30, 40],
        textures: [[50; 4], [60; 4], [0; 4], [0; 4]],
        ..Pixel::from_choices(&mut Choices::new(1))
    };
    for (pair, red) in [
        ("mov r1.a, v0\n+ cnd r0.rgb, r0.a, t0, t1", 50),
        ("cnd r0.rgb, r0.a, t0, t1\n+ mov r1.a, v0", 60),
        ("cnd r0.rgb, r0.a, t0, t1", 60),
    ] {
        let text = text(pair);
        let warned = parse(&text).unwrap().warnings.iter().any(|warning| warning.code == "NB0908");
        assert_eq!(warned, red == 50, "{text}");
        let shown = run::<i32>(&lowered(&text, Profile::Nv2a).combiners, Profile::Nv2a, &pixel);
        assert_eq!(shown[0], red, "{text}");
    }
}

/// A constant with both signs takes two products if the stage has room, otherwise it takes a register of its own.
#[test]
fn constants_of_both_signs() {
    for (body, stages) in [
        ("mov r0, c0", 1),
        ("mul r0, c0, v0", 1),
        ("mov r0, v0\nadd r0, r0, c0\nmad r0, r0, v0, -c0\ndp3 r0, r0, c0", 5),
        ("mov r0, v0\nadd r0.a, r0, c0\nadd r0, r0, c1", 3),
        ("mov r0, v0\nadd r0, r0, -c1", 2),
    ] {
        let text = format!("ps.1.1\ndef c0, 1, -1, 0.5, -0.5\ndef c1, -1, -1, 0, 0.5\n{body}");
        assert_eq!(lowered(&text, Profile::Nv2a).combiners.stages.len(), stages, "{text}");
    }
    // Such a constant is not read through an unsigned mapping, and no register is taken that is read later.
    let text = "ps.1.1\ndef c0, 1, -1, 0.5, -0.5\ntex t0\ntex t1\ntex t2\ntex t3\nmov r1, v0\nadd r0, c0, v1\n\
                mad r0, r0, t0, t1\nmad r0, r0, t2, t3\nmad r0, r0, r1, v0\nadd r0, r0, v1";
    let program = parse(text).unwrap().program;
    let refused = lower(&program, &Context::new(Profile::Nv2a));
    assert!(refused.is_ok_and(|lowered| lowered.combiners.stages.len() == 7));
}

#[test]
fn pairs_share_a_stage_and_its_constants() {
    let text = "ps.1.1\ndef c0, 1, 0.5, 0, 1\ndef c1, 0, 0, 1, 0.5\ndef c2, 0, 1, 0, 0.25\n\
                mad r0.rgb, c0, v0, c1\n+ mad r0.a, v0, c2, c1";
    let combiners = lowered(text, Profile::Nv2a).combiners;
    assert_eq!(combiners.stages.len(), 1);
    assert_eq!(combiners.stages[0].constants, [[255, 128, 0, 64], [0, 0, 255, 128]]);
}

/// Returns the code and the marked text of every finding.
fn said(text: &str) -> Vec<(&'static str, String)> {
    let findings = parse(text).unwrap_err().into_iter().filter(|finding| finding.severity == Severity::Error);
    findings.map(|finding| (finding.code, text[finding.span.unwrap()].to_owned())).collect()
}

#[test]
fn the_rules_of_the_language() {
    for (body, code, marked) in [
        ("cmp r0, v0, v0, v0", "NB0370", "cmp"),
        ("texld r0, t0", "NB0370", "texld"),
        ("movv r0, v0", "NB0204", "movv"),
        ("mov_x8 r0, v0", "NB0204", "x8"),
        ("mov_sat_sat r0, v0", "NB0371", "sat"),
        ("mov r2, v0", "NB0206", "r2"),
        ("mov r0, c8", "NB0206", "c8"),
        ("mov r0, o0", "NB0204", "o0"),
        ("mov r0", "NB0211", "mov"),
        ("mov r0, v0, v1", "NB0211", ","),
        ("mov r0 v0", "NB0103", "v0"),
        ("mov r0.r, v0\nmov r0, v0", "NB0371", "r"),
        ("mov v0, v1\nmov r0, v0", "NB0371", "v0"),
        ("mov r0, v0.r", "NB0371", "r"),
        ("mov r0, v0.b", "NB0371", "v0.b"),
        ("mov r0, -1-v0", "NB0371", "-1-v0"),
        ("mov r0, v0_bx2_bias", "NB0371", "bias"),
        ("mov r0, 2-v0", "NB0205", "2"),
        ("dp3 r0.a, v0, v1\nmov r0, v0", "NB0371", "r0.a"),
        ("mov r0, v0\ncnd r0, r0, v0, v1", "NB0371", "r0"),
        ("mov r0, v0\nmov r1, v0\ncnd r0, r1.a, v0, v1", "NB0371", "r1.a"),
        ("mad r0, c0, c1, c2", "NB0372", "c2"),
        ("tex t0\ntex t1\ntex t2\nmad r0, t0, t1, t2", "NB0372", "t2"),
        ("mov r0, v0\ntex t0", "NB0373", "tex"),
        ("mov r0, v0\ndef c0, 0, 0, 0, 0", "NB0373", "c0"),
        ("tex t1\ntex t0\nmov r0, t0", "NB0373", "t0"),
        ("tex t0\ntexm3x2pad t1, t0\nmov r0, v0", "NB0373", "texm3x2pad"),
        ("tex t0\ntexm3x2tex t1, t0\nmov r0, v0", "NB0373", "texm3x2tex"),
        ("texreg2ar t1, t0\nmov r0, v0", "NB0375", "t0"),
        ("texkill t0\nmov r0, t0", "NB0375", "t0"),
        ("mov r0, r1", "NB0375", "r1"),
        ("mov r0.rgb, v0\nmov r0, r0", "NB0375", "r0"),
        ("tex t0\ntexreg2ar t1, t0_bx2\nmov r0, v0", "NB0371", "t0_bx2"),
        ("tex_sat t0\nmov r0, v0", "NB0371", "sat"),
        ("tex v0\nmov r0, v0", "NB0371", "v0"),
        ("+mov r0.a, v0\nmov r0, v0", "NB0376", "mov"),
        ("mov r0.rgb, v0\n+mov r1.rgb, v0\nmov r0, v0", "NB0376", "r1.rgb"),
        ("mov r0, v0\n+mov r1.a, v0", "NB0376", "r1.a"),
        ("mov r0.rgb, v0\n+mov r0.a, v0\n+mov r1.a, v0", "NB0376", "mov"),
        ("mov r1, v0", "NB0377", "r1"),
        ("def c0, 1, 1, 1, 1\ndef c0, 0, 0, 0, 0\nmov r0, c0", "NB0364", "c0"),
        ("def c0, 1, 1, 1\nmov r0, c0", "NB0211", "def"),
        ("def c0, 1e99, 0, 0, 0\nmov r0, c0", "NB0207", "1e99"),
    ] {
        let text = format!("ps.1.1\n{body}");
        let found = said(&text);
        assert_eq!(found, [(code, marked.to_owned())], "{text}");
    }
    let nine = format!("ps.1.1\n{}", "mov r0, v0\n".repeat(9));
    assert_eq!(said(&nine), [("NB0374", "mov".to_owned())]);
    assert_eq!(said("ps.1.4\nmov r0, r1"), [("NB0370", "ps.1.4".to_owned())]);
    assert_eq!(said("ps.1.0\nmov r0.rgb, v0\n+mov r1.a, v0"), [("NB0376", "r1.a".to_owned())]);
    assert_eq!(said("ps.1.0\nmul r0, v0, v1"), [("NB0372", "v1".to_owned())]);
    assert_eq!(said(""), [("NB0103", String::new())]);
}
