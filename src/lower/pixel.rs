//! Makes the code of a pixel from the state of a draw, or from a program alone.

use ninebit::combiner::registers::Registers;
use ninebit::number::Register as _;
use ninebit::plan::PlannedDraw;
use ninebit::rop::{blend, surface};
use ninebit::state::*;
use ninebit::texture::planned::PlannedUnit;
use ninebit::texture::yuv;

use crate::code::{Code, Line, Operand, Operation, Range, Test, collected};
use crate::input::Input;
use crate::number::{Number, Word};
use crate::order::{Block, Listing};
use crate::texel::{CallerTexels, Sampler};

/// The inputs of a printed function that concern textures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Textures {
    /// The colour that each unit yields, as the registers hold it.
    #[default]
    Registers,
    /// Fetched words and weights: the filter is part of the function. For units with a texture shader the registers are inputs nevertheless.
    Words,
}

/// Options of a function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Decisions about behaviour that no capture shows.
    pub policies: Policies,
    /// Whether constants of the draw are inputs instead of parts of the text. One text then serves all draws that differ only in them.
    pub uniform: bool,
    /// The inputs that concern textures.
    pub textures: Textures,
    /// Whether the function ends with the fragment, before the raster operations.
    pub fragment: bool,
}

/// Result of a function.
#[derive(Clone, Copy, Debug)]
pub enum Result {
    /// R, G, B, A of the fragment, each from 0 to 255.
    Fragment([Operand; 4]),
    /// The new word of the surface, and the alpha test. If the test fails, the surface keeps its word.
    Stored {
        /// The surface's new word.
        word: Operand,
        /// The alpha test; `None` if every fragment passes.
        test: Option<Test>,
    },
    /// The new words of a whole pixel.
    Pixel {
        /// The surface's new word, if the test holds.
        word: Operand,
        /// The new word of the depth buffer, whatever the test, if it can change.
        depth: Option<Operand>,
        /// Whether the surface takes its word; `None` if it always does.
        test: Option<Test>,
    },
}

/// The code of a pixel: a function of its inputs.
#[derive(Debug)]
pub struct Function {
    /// The operations in order; the result depends on all of them.
    pub lines: Vec<Line>,
    /// The lines that hold the result.
    pub result: Result,
    /// Whether constants of the draw are inputs.
    pub uniform: bool,
}

/// Makes the inputs of a function.
pub(crate) struct Builder<'a> {
    pub(crate) code: &'a Code,
    pub(crate) options: Options,
}

impl<'a> Builder<'a> {
    pub(crate) fn input(&self, input: Input) -> Number<'a> {
        Number::new(self.code, self.code.input(input, input.range()))
    }

    fn channels(&self, input: impl Fn(usize) -> Input) -> [Number<'a>; 4] {
        [0, 1, 2, 3].map(|channel| self.input(input(channel)))
    }

    /// Returns constants of the draw, as inputs or as constants of the text.
    pub(crate) fn constants<const N: usize>(&self, bytes: [u8; N], input: impl Fn(usize) -> Input) -> [Number<'a>; N] {
        let uniform = self.options.uniform;
        std::array::from_fn(|n| if uniform { self.input(input(n)) } else { Number::Constant(bytes[n].into()) })
    }

    /// Returns the registers with all inputs that a pixel may have; `texture` returns those of a unit.
    fn registers(&self, fog: [Number<'a>; 4], texture: impl FnMut(usize) -> [Number<'a>; 4]) -> Registers<Number<'a>> {
        loaded([self.channels(Input::Primary), self.channels(Input::Secondary), fog], texture)
    }

    pub(crate) fn fragment(&self, combiners: &Combiners, registers: Registers<Number<'a>>) -> [Number<'a>; 4] {
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

    /// ROP-1: returns the alpha test of a draw.
    pub(crate) fn alpha_test(&self, draw: &Draw, fragment: [Number<'a>; 4]) -> Option<Test> {
        self.code.by("ROP-1");
        draw.alpha_test.map(|test| {
            let [reference] = self.constants([test.reference], |_| Input::AlphaReference);
            fragment[3].compared(test.function, reference)
        })
    }

    /// Blends and stores. Returns what the surface holds afterwards, where it holds `held`.
    pub(crate) fn word(
        &self,
        draw: &Draw,
        surface: SurfaceFormat,
        fragment: [Number<'a>; 4],
        held: Word<'a>,
    ) -> Word<'a> {
        let code = self.code;
        let mut listing = Listing::new(code, self.options.policies);
        listing.enter(Block::Raster);
        let mut channels = fragment;
        if let Some(state) = draw.blend.as_ref().filter(|_| surface::blends(surface)) {
            let source = blend::truncated(surface, fragment, &mut listing);
            code.by("ROP-5");
            let destination = surface::channels(surface, held).map(Word::number);
            for (n, name) in ["r", "g", "b", "a"].into_iter().enumerate() {
                code.name(destination[n].operand(), || format!("destination_{name}"));
            }
            let constant = self.constants(draw.blend_constant, Input::BlendConstant);
            channels = blend::blend(state, 15, &constant, &source, &destination, &mut listing);
            for (n, name) in ["r", "g", "b", "a"].into_iter().enumerate() {
                code.name(channels[n].operand(), || format!("blend_{name}"));
            }
        }
        code.by("ROP-5");
        let word = surface::packed(surface, channels.map(|channel| channel.limited(0, 255).word()));
        code.by("ROP-6");
        let word = surface::masked(held, word, surface::write_mask(surface, draw.color_mask));
        code.name(word.0.operand(), || "stored".to_string());
        word
    }

    /// Applies the raster operations of a draw.
    fn stored(&self, draw: &Draw, surface: SurfaceFormat, fragment: [Number<'a>; 4]) -> Result {
        let code = self.code;
        let test = self.alpha_test(draw, fragment);
        let held = Word(self.input(Input::Destination));
        let word = self.word(draw, surface, fragment, held);
        match test.and_then(|test| code.decided(test)) {
            // Every fragment is dropped, whatever its alpha.
            Some(false) => {
                let never = Test(CompareFunction::NotEqual, [Operand::Constant(0); 2]);
                Result::Stored { word: held.0.operand(), test: Some(never) }
            }
            Some(true) => Result::Stored { word: word.0.operand(), test: None },
            None => Result::Stored { word: word.0.operand(), test },
        }
    }
}

/// Returns registers with the two colours and fog; `texture` returns what a unit loads.
pub(crate) fn loaded<'a>(
    [primary, secondary, fog]: [[Number<'a>; 4]; 3],
    texture: impl FnMut(usize) -> [Number<'a>; 4],
) -> Registers<Number<'a>> {
    const UNITS: [Register; 4] = [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3];
    let mut registers = Registers::from_value(Number::ZERO);
    registers.load(Register::PrimaryColor, primary);
    registers.load(Register::SecondaryColor, secondary);
    registers.load(Register::Fog, fog);
    for (register, value) in UNITS.into_iter().zip((0..4).map(texture)) {
        registers.load(register, value);
    }
    registers
}

/// TEX-16: what a unit without a texture gives: opaque black.
pub(crate) const UNBOUND: [Number<'static>; 4] = [Number::ZERO, Number::ZERO, Number::ZERO, Number::ONE];

/// TEX-19: returns the register of a unit, converted from YUV if the draw says so.
pub(crate) fn converted<'a>(code: &'a Code, draw: &Draw, register: [Number<'a>; 4]) -> [Number<'a>; 4] {
    let [y, cb, cr, alpha] = register;
    if !draw.convert_yuv {
        return register;
    }
    code.by("TEX-19");
    let [r, g, b] = [0, 1, 2].map(|channel| yuv::converted(channel, [y, cb, cr]));
    [r, g, b, alpha]
}

/// Returns whether unit `n` of a draw has no texture where it needs one.
pub(crate) fn is_idle(draw: &Draw, n: usize) -> bool {
    match draw.texture_shader[n].operation {
        ShaderOperation::None => true,
        operation => operation.samples() && draw.textures[n].is_none(),
    }
}

impl Function {
    /// Makes the function of a program alone, with at most eight stages, from registers to the fragment. All four textures, both colours and all
    /// of fog are inputs.
    pub fn of_program(combiners: &Combiners, options: &Options) -> Function {
        let code = Code::default();
        let builder = Builder { code: &code, options: *options };
        let registers = builder
            .registers(builder.channels(Input::Fog), |unit| builder.channels(|channel| Input::Texture(unit, channel)));
        let fragment = builder.fragment(combiners, registers).map(Number::operand);
        Function::new(code, Result::Fragment(fragment), options)
    }

    /// Makes the function of a draw of a scene, from interpolated and sampled values to the stored word.
    ///
    /// `planned` comes from the scene's plan, made with or without pruning, and tells what the units sample.
    pub fn of_draw(scene: &Scene, draw: &Draw, planned: &PlannedDraw, options: &Options) -> Function {
        let code = Code::default();
        let builder = Builder { code: &code, options: *options };
        let [r, g, b] = builder.constants(draw.fog.color, Input::FogColor);
        // CMB-13: without fog the factor is 1.
        let factor = if draw.fog.enabled { builder.input(Input::Fog(3)) } else { Number::ONE };
        let registers = builder.registers([r, g, b, factor], |n| {
            if is_idle(draw, n) {
                return converted(&code, draw, UNBOUND);
            }
            let unit = planned.units.iter().find(|unit| unit.index == n);
            match unit {
                Some(unit) if options.textures == Textures::Words && planned.shader.is_none() && reads_words(unit) => {
                    let sampler = Sampler::new(unit);
                    let border = builder.constants(unit.state.border_color, |c| Input::BorderColor(n, c));
                    let register = sampler.register(border, &CallerTexels(n, |input| builder.input(input)), &code).0;
                    converted(&code, draw, register)
                }
                // Only signed channels, and results of texture shaders, can be negative.
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
            builder.stored(draw, scene.targets[draw.target].format, fragment)
        };
        Function::new(code, result, options)
    }

    /// Makes a function of the lines on which the result depends, renumbered.
    pub(crate) fn new(code: Code, result: Result, options: &Options) -> Function {
        let (lines, renamed) = code.reachable(&result.operands());
        Function { lines, result: result.renamed(renamed), uniform: options.uniform }
    }

    /// Returns the range of an input as the function reads it.
    pub fn range(&self, input: Input) -> Range {
        let line = self.lines.iter().find(|line| line.operation == Operation::Input(input));
        line.map_or(input.range(), |line| line.range)
    }

    /// Returns the inputs that the function reads, sorted.
    pub fn inputs(&self) -> Vec<Input> {
        let input = |line: &Line| if let Operation::Input(input) = line.operation { Some(input) } else { None };
        let mut inputs: Vec<Input> = self.lines.iter().filter_map(input).collect();
        // If the test fails, the surface keeps its word.
        if matches!(self.result, Result::Stored { test: Some(_), .. }) {
            inputs.push(Input::Destination);
        }
        inputs.sort();
        inputs.dedup();
        inputs
    }
}

impl Result {
    /// Returns all operands of the result.
    pub(crate) fn operands(&self) -> Vec<Operand> {
        collected(|name| _ = self.renamed(name))
    }

    fn renamed(self, mut name: impl FnMut(Operand) -> Operand) -> Result {
        match self {
            Result::Fragment(channels) => Result::Fragment(channels.map(name)),
            Result::Stored { word, test } => {
                let test = test.map(|Test(function, operands)| Test(function, operands.map(&mut name)));
                Result::Stored { word: name(word), test }
            }
            Result::Pixel { word, depth, test } => {
                let test = test.map(|Test(function, operands)| Test(function, operands.map(&mut name)));
                Result::Pixel { word: name(word), depth: depth.map(&mut name), test }
            }
        }
    }
}

/// Returns whether a unit's colour is computed from words of texels by a filter alone: nothing is compared, and texels come from one plane.
fn reads_words(unit: &PlannedUnit) -> bool {
    let state = &unit.state;
    state.color_key.is_none()
        && state.shadow.is_none()
        && state.anisotropy == 1
        && unit.kind != TextureKind::ThreeDimensional
}
