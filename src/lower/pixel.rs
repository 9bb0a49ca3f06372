//! From the state of a draw, or from a program alone, to the code of its pixels.

use ninebit::combiner::registers::Registers;
use ninebit::number::Register as _;
use ninebit::plan::PlannedDraw;
use ninebit::rop::{blend, surface};
use ninebit::state::*;
use ninebit::texture::planned::PlannedUnit;

use crate::code::{Code, Line, Operand, Operation, Range, Test, collected};
use crate::input::Input;
use crate::number::{Number, Word};
use crate::order::{Block, Listing};
use crate::texel::Sampler;

/// What a printed function is given of textures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Textures {
    /// What each unit yields, as the registers hold it.
    #[default]
    Registers,
    /// Fetched words and weights; the filter is part of the function. Units of a texture shader give registers all the same.
    Words,
}

/// How a function is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Answers to what no capture decides.
    pub policies: Policies,
    /// Constants of the draw are given, and not part of the text: one text serves all draws that differ in nothing else.
    pub uniform: bool,
    /// What is given of textures.
    pub textures: Textures,
    /// The function ends with the fragment, before the raster operations.
    pub fragment: bool,
}

/// What a function yields.
#[derive(Clone, Copy, Debug)]
pub enum Result {
    /// R, G, B, A of the fragment, each 0 to 255.
    Fragment([Operand; 4]),
    /// The surface's new word, and the alpha test: where it fails, the surface keeps its word.
    Stored {
        /// The surface's new word.
        word: Operand,
        /// None: every fragment passes.
        test: Option<Test>,
    },
}

/// What a pixel comes to.
#[derive(Debug)]
pub struct Function {
    /// The operations, in order. All of them are used.
    pub lines: Vec<Line>,
    /// What is yielded.
    pub result: Result,
    /// Constants of the draw are given.
    pub uniform: bool,
}

/// The raster operations.
struct Raster {
    alpha_test: Option<AlphaTest>,
    blend: Option<Blend>,
    blend_constant: [u8; 4],
    surface: SurfaceFormat,
    write_mask: u32,
}

/// Where the inputs of a function come from.
struct Builder<'a> {
    code: &'a Code,
    options: Options,
}

impl<'a> Builder<'a> {
    fn given(&self, input: Input) -> Number<'a> {
        Number::new(self.code, self.code.input(input, input.range()))
    }

    fn channels(&self, input: impl Fn(usize) -> Input) -> [Number<'a>; 4] {
        [0, 1, 2, 3].map(|channel| self.given(input(channel)))
    }

    /// Constants of the draw.
    fn constants<const N: usize>(&self, bytes: [u8; N], input: impl Fn(usize) -> Input) -> [Number<'a>; N] {
        let uniform = self.options.uniform;
        std::array::from_fn(|n| if uniform { self.given(input(n)) } else { Number::Constant(bytes[n].into()) })
    }

    /// The registers with all inputs that a pixel can bring; units are `texture`'s.
    fn registers(&self, fog: [Number<'a>; 4], texture: impl FnMut(usize) -> [Number<'a>; 4]) -> Registers<Number<'a>> {
        const UNITS: [Register; 4] = [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3];
        let mut registers = Registers::from_value(Number::ZERO);
        registers.load(Register::PrimaryColor, self.channels(Input::Primary));
        registers.load(Register::SecondaryColor, self.channels(Input::Secondary));
        registers.load(Register::Fog, fog);
        for (register, value) in UNITS.into_iter().zip((0..4).map(texture)) {
            registers.load(register, value);
        }
        registers
    }

    fn fragment(&self, combiners: &Combiners, registers: Registers<Number<'a>>) -> [Number<'a>; 4] {
        let mut listing = Listing::new(self.code, self.options.policies);
        let constants = |listing: &mut Listing<'a>, bytes: [[u8; 4]; 2], stage: Option<usize>| {
            listing.enter(stage.map_or(Block::Final, Block::Stage));
            [0, 1].map(|n: usize| {
                self.constants(bytes[n], |channel| match stage {
                    Some(stage) => Input::StageConstant(stage, n, channel),
                    None => Input::FinalConstant(n, channel),
                })
            })
        };
        combiners.evaluate(registers, constants, &mut listing).map(|channel| channel.limited(0, 255))
    }

    fn stored(&self, raster: &Raster, fragment: [Number<'a>; 4]) -> Result {
        let code = self.code;
        let mut listing = Listing::new(code, self.options.policies);
        listing.enter(Block::Raster);
        code.by("ROP-1");
        let test = raster.alpha_test.map(|test| {
            let [reference] = self.constants([test.reference], |_| Input::AlphaReference);
            fragment[3].compared(test.function, reference)
        });
        let held = Word(self.given(Input::Destination));
        let mut channels = fragment;
        if let Some(state) = &raster.blend {
            let source = blend::truncated(raster.surface, fragment, &mut listing);
            code.by("ROP-5");
            let destination = surface::channels(raster.surface, held).map(Word::number);
            for (n, name) in ["r", "g", "b", "a"].into_iter().enumerate() {
                code.name(destination[n].operand(), || format!("destination_{name}"));
            }
            let constant = self.constants(raster.blend_constant, Input::BlendConstant);
            channels = blend::blend(state, 15, &constant, &source, &destination, &mut listing);
            for (n, name) in ["r", "g", "b", "a"].into_iter().enumerate() {
                code.name(channels[n].operand(), || format!("blend_{name}"));
            }
        }
        code.by("ROP-5");
        let word = surface::packed(raster.surface, channels.map(|channel| channel.limited(0, 255).word()));
        code.by("ROP-6");
        let word = surface::masked(held, word, raster.write_mask);
        code.name(word.0.operand(), || "stored".to_string());
        match test.and_then(|test| code.decided(test)) {
            // Every fragment is dropped, whatever it is.
            Some(false) => {
                let never = Test(CompareFunction::NotEqual, [Operand::Constant(0); 2]);
                Result::Stored { word: held.0.operand(), test: Some(never) }
            }
            Some(true) => Result::Stored { word: word.0.operand(), test: None },
            None => Result::Stored { word: word.0.operand(), test },
        }
    }
}

impl Function {
    /// The function of a program alone, of at most eight stages: from registers to the fragment. All four textures, both colours and all of fog are given.
    pub fn of_program(combiners: &Combiners, options: &Options) -> Function {
        let code = Code::default();
        let builder = Builder { code: &code, options: *options };
        let registers = builder
            .registers(builder.channels(Input::Fog), |unit| builder.channels(|channel| Input::Texture(unit, channel)));
        let fragment = builder.fragment(combiners, registers).map(Number::operand);
        Function::new(code, Result::Fragment(fragment), options)
    }

    /// The function of a draw of a scene: from what is interpolated and sampled to the stored word.
    ///
    /// `plan` is the scene's, made without pruning or with: it tells what the units sample.
    pub fn of_draw(scene: &Scene, draw: &Draw, planned: &PlannedDraw, options: &Options) -> Function {
        let code = Code::default();
        let builder = Builder { code: &code, options: *options };
        let [r, g, b] = builder.constants(draw.fog.color, Input::FogColor);
        // CMB-13: without fog the factor is 1.
        let factor = if draw.fog.enabled { builder.given(Input::Fog(3)) } else { Number::ONE };
        let registers = builder.registers([r, g, b, factor], |n| {
            let idle = match draw.texture_shader[n].operation {
                ShaderOperation::None => true,
                operation => operation.samples() && draw.textures[n].is_none(),
            };
            if idle {
                // TEX-16.
                return [Number::ZERO, Number::ZERO, Number::ZERO, Number::ONE];
            }
            let unit = planned.units.iter().find(|unit| unit.index == n);
            match unit {
                Some(unit) if options.textures == Textures::Words && planned.shader.is_none() && reads_words(unit) => {
                    let sampler = Sampler::new(unit);
                    let border = builder.constants(unit.state.border_color, |c| Input::BorderColor(n, c));
                    sampler.register(border, |input| builder.given(input), &code)
                }
                // Only signed channels are ever negative, and what texture shaders make of them.
                Some(unit) if unit.state.signed == [false; 4] && planned.shader.is_none() => {
                    let byte = |channel: usize| code.input(Input::Texture(n, channel), (0, 255));
                    [0, 1, 2, 3].map(|channel| Number::new(&code, byte(channel)))
                }
                _ => builder.channels(|channel| Input::Texture(n, channel)),
            }
        });
        let fragment = builder.fragment(&draw.combiners, registers);
        let result = if options.fragment {
            Result::Fragment(fragment.map(Number::operand))
        } else {
            let surface = scene.targets[draw.target].format;
            let raster = Raster {
                alpha_test: draw.alpha_test,
                blend: draw.blend.filter(|_| surface::blends(surface)),
                blend_constant: draw.blend_constant,
                surface,
                write_mask: surface::write_mask(surface, draw.color_mask),
            };
            builder.stored(&raster, fragment)
        };
        Function::new(code, result, options)
    }

    /// Keeps what the result is made of, and numbers it anew.
    fn new(code: Code, result: Result, options: &Options) -> Function {
        let (lines, renamed) = code.kept(&result.operands());
        Function { lines, result: result.renamed(renamed), uniform: options.uniform }
    }

    /// What an input that it reads can be.
    pub fn range(&self, input: Input) -> Range {
        let line = self.lines.iter().find(|line| line.operation == Operation::Input(input));
        line.map_or(input.range(), |line| line.range)
    }

    /// The inputs that it reads, in their order.
    pub fn inputs(&self) -> Vec<Input> {
        let input = |line: &Line| if let Operation::Input(input) = line.operation { Some(input) } else { None };
        let mut inputs: Vec<Input> = self.lines.iter().filter_map(input).collect();
        // Where the test fails, the surface keeps its word.
        if matches!(self.result, Result::Stored { test: Some(_), .. }) {
            inputs.push(Input::Destination);
        }
        inputs.sort();
        inputs.dedup();
        inputs
    }
}

impl Result {
    /// Every value in it.
    pub fn operands(&self) -> Vec<Operand> {
        collected(|name| _ = self.renamed(name))
    }

    fn renamed(self, mut name: impl FnMut(Operand) -> Operand) -> Result {
        match self {
            Result::Fragment(channels) => Result::Fragment(channels.map(name)),
            Result::Stored { word, test } => {
                let test = test.map(|Test(function, operands)| Test(function, operands.map(&mut name)));
                Result::Stored { word: name(word), test }
            }
        }
    }
}

/// Whether what a unit yields is made of a texel's words by a filter alone: it compares nothing, and its texel is one of a plane.
fn reads_words(unit: &PlannedUnit) -> bool {
    let state = &unit.state;
    state.color_key.is_none()
        && state.shadow.is_none()
        && state.anisotropy == 1
        && unit.kind != TextureKind::ThreeDimensional
}
