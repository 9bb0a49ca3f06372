//! Turns a cascade of equations into general stages: one stage for each equation of colour and the equation of alpha beside it.
//!
//! APIs clamp the result of every stage to 0..1. The combiners clamp a written register only to -1..1, so the lower limit is left to
//! whoever reads the register: a value that may be negative is read by a mapping that takes max(0, x), never by a signed one.

use super::finding::finding;
use crate::Span;
use ninebit::diagnostic::Diagnostic;
use ninebit::state::*;

/// The registers of the texture units.
pub(crate) const TEXTURES: [Register; TEXTURE_UNITS] =
    [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3];

/// Source of an argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// The constant 0.
    Zero,
    /// A constant colour: bytes R, G, B, A.
    Constant([u8; 4]),
    /// The interpolated diffuse colour (primary colour).
    Primary,
    /// The interpolated specular colour (secondary colour).
    Secondary,
    /// The colour of the texture unit with this number.
    Texture(usize),
    /// The result of the stages before.
    Current,
    /// A second result, which is 0 until a stage writes it.
    Temporary,
}

/// The channels of a source that an argument reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Channel {
    /// R, G, B in an equation of colour, A in one of alpha.
    Own,
    /// Blue, in an equation of alpha.
    Blue,
    /// Alpha, in any equation.
    Alpha,
}

/// An argument of an equation: x, or 1 - x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Argument {
    /// Source of x.
    pub(crate) source: Source,
    /// The channels of the source that are read.
    pub(crate) channel: Channel,
    /// Whether the argument is 1 - x.
    pub(crate) complement: bool,
}

impl Argument {
    /// The argument 0.
    pub(crate) const ZERO: Argument = Argument::new(Source::Zero);
    /// The argument 1, the complement of 0.
    pub(crate) const ONE: Argument = Argument { complement: true, ..Argument::ZERO };

    /// Makes the argument that reads a source's own channels.
    pub(crate) const fn new(source: Source) -> Argument {
        Argument { source, channel: Channel::Own, complement: false }
    }

    /// Returns the argument that reads the source's alpha instead; a complement stays.
    pub(crate) const fn alpha(self) -> Argument {
        Argument { channel: Channel::Alpha, ..self }
    }

    /// Returns the argument 1 - x.
    pub(crate) const fn inverted(self) -> Argument {
        Argument { complement: !self.complement, ..self }
    }
}

/// The mapping of an argument in a product.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Use {
    /// The value x itself.
    Plain,
    /// 2x - 1.
    Expanded,
    /// x - 1/2.
    HalfBiased,
}

/// An equation of a stage: A B + C D, or A B - C D, or the dot product of A and B. The result is biased, scaled and clamped to 0..1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Equation {
    ab: [Argument; 2],
    cd: Option<[Argument; 2]>,
    form: Form,
    bias: Bias,
    scale: Scale,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Sum,
    /// A - C, where B and D are 1.
    Difference,
    /// The sum of (2a - 1)(2b - 1) over R, G, B.
    Dot,
    /// A + (C - 1/2), where B and D are 1: bias and scale 4 cannot be combined.
    HalfBiased,
}

impl Equation {
    const fn from_products(ab: [Argument; 2], cd: Option<[Argument; 2]>, form: Form) -> Equation {
        Equation { ab, cd, form, bias: Bias::None, scale: Scale::One }
    }

    /// Returns the equation a.
    pub(crate) const fn copy(a: Argument) -> Equation {
        Equation::product(a, Argument::ONE)
    }

    /// Returns the equation a b.
    pub(crate) const fn product(a: Argument, b: Argument) -> Equation {
        Equation::from_products([a, b], None, Form::Sum)
    }

    /// Returns the equation a b + c d.
    pub(crate) const fn products(ab: [Argument; 2], cd: [Argument; 2]) -> Equation {
        Equation::from_products(ab, Some(cd), Form::Sum)
    }

    /// Returns the equation a + b.
    pub(crate) const fn sum(a: Argument, b: Argument) -> Equation {
        Equation::products([a, Argument::ONE], [b, Argument::ONE])
    }

    /// Returns the equation f a + (1 - f) b.
    pub(crate) const fn lerp(f: Argument, a: Argument, b: Argument) -> Equation {
        Equation::products([a, f], [b, f.inverted()])
    }

    /// Returns the equation a - b.
    pub(crate) const fn difference(a: Argument, b: Argument) -> Equation {
        Equation::from_products([a, Argument::ONE], Some([b, Argument::ONE]), Form::Difference)
    }

    /// Returns the equation of the dot product: the sum over R, G, B of (2a - 1)(2b - 1).
    pub(crate) const fn dot(a: Argument, b: Argument) -> Equation {
        Equation::from_products([a, b], None, Form::Dot)
    }

    /// Returns the equation a + b - 1/2, times 1, 2 or 4.
    pub(crate) fn signed_sum(a: Argument, b: Argument, scale: Scale) -> Equation {
        match scale {
            Scale::Four | Scale::Half => Equation {
                scale,
                ..Equation::from_products([a, Argument::ONE], Some([b, Argument::ONE]), Form::HalfBiased)
            },
            _ => Equation { bias: Bias::NegativeHalf, scale, ..Equation::sum(a, b) },
        }
    }

    /// Returns the equation minus 1/2, which only scales 1 and 2 allow.
    pub(crate) const fn biased(self) -> Equation {
        Equation { bias: Bias::NegativeHalf, ..self }
    }

    /// Returns the equation times a scale.
    pub(crate) const fn scaled(self, scale: Scale) -> Equation {
        Equation { scale, ..self }
    }

    /// Returns whether the result can be negative before it is clamped.
    fn is_signed(&self) -> bool {
        self.form != Form::Sum || self.bias != Bias::None
    }
}

/// The alpha result of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Alpha {
    /// The result of its own equation.
    Equation(Equation),
    /// The dot product of the colour's equation.
    DotProduct,
}

/// Destination of a stage's result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Destination {
    /// The colour that the next stage reads as [`Source::Current`], in SPARE0.
    Current,
    /// The colour that the next stage reads as [`Source::Temporary`], in SPARE1.
    Temporary,
}

/// What the final combiner does after the last stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct End {
    /// Whether the secondary colour is added, with the sum clamped to 1.0.
    pub(crate) specular: bool,
    /// Whether the result is blended with the fog colour by the fog factor.
    pub(crate) fog: bool,
}

/// A result and the register that holds it.
#[derive(Clone, Copy, Debug)]
struct Value {
    register: Register,
    /// Whether the alpha is in the blue channel: a dot product on a chip without blue-to-alpha.
    alpha_is_blue: bool,
    signed: bool,
}

/// General stages under construction.
#[derive(Debug)]
pub(crate) struct Cascade {
    profile: Profile,
    /// Whether the colour of each texture unit can be negative.
    signed_textures: [bool; 4],
    stages: Vec<GeneralStage>,
    origins: Vec<StageOrigin>,
    places: Vec<Span>,
    /// Constants so far: those of the current stage, or on NV10 of the whole program.
    constants: Vec<[u8; 4]>,
    current: Value,
    temporary: Option<Value>,
    findings: Vec<Diagnostic>,
}

/// The result of lowering a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoweredProgram<U = ()> {
    /// The program as state of the chip.
    pub combiners: Combiners,
    /// What each general stage was made from.
    pub origins: Vec<StageOrigin>,
    /// What the program changes in the texture units, if it can.
    pub units: U,
}

impl Cascade {
    /// Makes a cascade without stages, in which the current colour is the primary colour.
    pub(crate) fn new(profile: Profile, signed_textures: [bool; 4]) -> Cascade {
        Cascade {
            profile,
            signed_textures,
            stages: Vec::new(),
            origins: Vec::new(),
            places: Vec::new(),
            constants: Vec::new(),
            current: Value { register: Register::PrimaryColor, alpha_is_blue: false, signed: false },
            temporary: None,
            findings: Vec::new(),
        }
    }

    /// Adds a stage. Findings about it have the place `span`; reports show its `origin`.
    pub(crate) fn stage(&mut self, span: Span, rgb: &Equation, alpha: Alpha, target: Destination, origin: StageOrigin) {
        if self.profile == Profile::Nv2a {
            self.constants.clear();
        }
        let register = match target {
            Destination::Current => Register::Spare0,
            Destination::Temporary => Register::Spare1,
        };
        let blue_to_alpha = alpha == Alpha::DotProduct && self.profile == Profile::Nv2a;
        let mut rgb_portion = self.portion(rgb, false, register, &span);
        rgb_portion.ab_blue_to_alpha = blue_to_alpha;
        let (alpha_portion, signed_alpha) = match &alpha {
            Alpha::Equation(equation) => (self.portion(equation, true, register, &span), equation.is_signed()),
            Alpha::DotProduct => (Portion::idle(Component::Alpha), true),
        };
        let constants = [0, 1].map(|n| self.constants.get(n).copied().unwrap_or_default());
        self.stages.push(GeneralStage { rgb: rgb_portion, alpha: alpha_portion, constants });
        self.origins.push(origin);
        self.places.push(span);
        let value = Value {
            register,
            alpha_is_blue: alpha == Alpha::DotProduct && !blue_to_alpha,
            signed: rgb.is_signed() || signed_alpha,
        };
        match target {
            Destination::Current => self.current = value,
            Destination::Temporary => self.temporary = Some(value),
        }
    }

    fn portion(&mut self, equation: &Equation, alpha: bool, register: Register, span: &Span) -> Portion {
        let mut portion = Portion::idle(if alpha { Component::Alpha } else { Component::Rgb });
        let used = if equation.form == Form::Dot { Use::Expanded } else { Use::Plain };
        portion.inputs[0] = self.input(&equation.ab[0], used, alpha, span);
        portion.inputs[1] = self.input(&equation.ab[1], used, alpha, span);
        if let Some([c, d]) = &equation.cd {
            let [c, d] = match equation.form {
                Form::Difference => self.negative(c, alpha, span),
                Form::HalfBiased => [self.input(c, Use::HalfBiased, alpha, span), one(alpha)],
                Form::Sum | Form::Dot => {
                    [self.input(c, Use::Plain, alpha, span), self.input(d, Use::Plain, alpha, span)]
                }
            };
            portion.inputs[2] = c;
            portion.inputs[3] = d;
        }
        if equation.form == Form::Dot {
            portion.ab_dot_product = true;
            portion.ab_output = register;
        } else {
            portion.sum_output = register;
        }
        portion.bias = equation.bias;
        portion.scale = equation.scale;
        portion
    }

    /// Returns inputs C and D whose product is -x. Where x cannot be negative, they are -x and 1. Otherwise they are max(0, x) or 1 - max(0, x),
    /// and ZERO expanded, which is -1 in real numbers and -256 in integers (CMB-3).
    fn negative(&mut self, x: &Argument, alpha: bool, span: &Span) -> [CombinerInput; 2] {
        let plain = self.input(x, Use::Plain, alpha, span);
        if !x.complement && !self.may_be_negative(x.source) {
            return [CombinerInput { mapping: InputMapping::SignedNegate, ..plain }, one(alpha)];
        }
        [plain, CombinerInput { mapping: InputMapping::ExpandNormal, ..one(alpha) }]
    }

    fn may_be_negative(&self, source: Source) -> bool {
        match source {
            Source::Current => self.current.signed,
            Source::Temporary => self.temporary.is_some_and(|value| value.signed),
            Source::Texture(unit) => self.signed_textures.get(unit).copied().unwrap_or(false),
            Source::Zero | Source::Constant(_) | Source::Primary | Source::Secondary => false,
        }
    }

    fn input(&mut self, argument: &Argument, used: Use, alpha: bool, span: &Span) -> CombinerInput {
        let plain = |register| Value { register, alpha_is_blue: false, signed: false };
        let value = match argument.source {
            Source::Zero => plain(Register::Zero),
            Source::Primary => plain(Register::PrimaryColor),
            Source::Secondary => plain(Register::SecondaryColor),
            Source::Texture(unit) => plain(TEXTURES[unit.min(3)]),
            Source::Current => self.current,
            Source::Temporary => self.temporary.unwrap_or(plain(Register::Zero)),
            Source::Constant(color) => plain(self.constant(color, span)),
        };
        let component = match (argument.channel, alpha) {
            (Channel::Own, false) => Component::Rgb,
            // The three colour channels of a dot product are equal.
            (Channel::Alpha, false) if value.alpha_is_blue => Component::Rgb,
            (Channel::Own | Channel::Alpha, true) if value.alpha_is_blue => Component::Blue,
            (Channel::Blue, true) => Component::Blue,
            _ => Component::Alpha,
        };
        let mapping = match (used, argument.complement) {
            (Use::Plain, false) => InputMapping::UnsignedIdentity,
            (Use::Plain, true) => InputMapping::UnsignedInvert,
            (Use::Expanded, false) => InputMapping::ExpandNormal,
            // 2 (1 - x) - 1 = 1 - 2x.
            (Use::Expanded, true) => InputMapping::ExpandNegate,
            (Use::HalfBiased, false) => InputMapping::HalfBiasNormal,
            // (1 - x) - 1/2 = 1/2 - x.
            (Use::HalfBiased, true) => InputMapping::HalfBiasNegate,
        };
        CombinerInput { register: value.register, component, mapping }
    }

    fn constant(&mut self, color: [u8; 4], span: &Span) -> Register {
        let found = self.constants.iter().position(|constant| *constant == color);
        let index = found.unwrap_or_else(|| {
            self.constants.push(color);
            self.constants.len() - 1
        });
        if index == 2 && found.is_none() {
            self.findings.push(too_many_constants(self.profile, span.clone()));
        }
        if index == 0 { Register::ConstantColor0 } else { Register::ConstantColor1 }
    }

    /// Returns the program with its changes of the units, or all findings: `all`, then those about the cascade. `what` is what messages call the
    /// program, such as "cascade".
    pub(crate) fn finish<U>(
        mut self,
        what: &str,
        end: End,
        mut all: Vec<Diagnostic>,
        units: U,
    ) -> Result<LoweredProgram<U>, Vec<Diagnostic>> {
        if self.current.register != Register::Spare0 {
            // No stage affects the result.
            let nothing = Cascade::new(self.profile, self.signed_textures);
            self = Cascade { current: self.current, findings: self.findings, ..nothing };
            let copy = Equation::copy(Argument::new(Source::Current));
            let origin = |part: &str| format!("no stage changes the {part} of the vertices");
            let origin = StageOrigin { rgb: origin("colour"), alpha: origin("alpha") };
            self.stage(0..0, &copy, Alpha::Equation(copy), Destination::Current, origin);
        }
        let (needed, most) = (self.stages.len(), self.profile.general_stages());
        if let Some(span) = self.places.get(most) {
            self.findings.push(too_many_stages(self.profile, needed, span.clone(), what));
        }
        all.extend(self.findings);
        if !all.is_empty() {
            return Err(all);
        }
        let constants = self.stages.last().map_or([[0; 4]; 2], |stage| stage.constants);
        if self.profile == Profile::Nv10 {
            for stage in &mut self.stages {
                stage.constants = constants;
            }
        }
        let final_combiner = final_combiner(end, self.current.alpha_is_blue, constants);
        let combiners = Combiners { stages: self.stages, mux_select: MuxSelect::Msb, final_combiner };
        Ok(LoweredProgram { combiners, origins: self.origins, units })
    }
}

/// Makes the finding that a program needs more general stages than the chip has. `what` is what messages call the program.
pub(super) fn too_many_stages(profile: Profile, needed: usize, span: Span, what: &str) -> Diagnostic {
    let help = match profile {
        Profile::Nv10 if needed <= Profile::Nv2a.general_stages() => {
            "use fewer stages, draw in two passes with `blend`, or write `profile: Nv2a`, which has 8"
        }
        _ => "use fewer stages, or draw in two passes with `blend`",
    };
    let (chip, most) = (format!("{profile:?}").to_lowercase(), profile.general_stages());
    let message = format!("this {what} needs {needed} general stages; {chip} has {most}");
    finding("NB0350", span, message, "the first too many", help).rule("CMB-12")
}

/// Makes the finding that there is no constant register left.
pub(super) fn too_many_constants(profile: Profile, span: Span) -> Diagnostic {
    let (message, help) = match profile {
        Profile::Nv10 => (
            "this program needs 3 constant colours; Nv10 has 2",
            "make two of them equal, or pass one in as the vertex's specular colour; profile Nv2a has two a stage",
        ),
        Profile::Nv2a => ("this stage needs 3 constant colours; it has 2", "make two of them equal"),
    };
    finding("NB0351", span, message, "the third is read here", help).rule("CMB-12")
}

/// Returns the input that is 1.
pub(super) fn one(alpha: bool) -> CombinerInput {
    let component = if alpha { Component::Alpha } else { Component::Rgb };
    CombinerInput { mapping: InputMapping::UnsignedInvert, ..CombinerInput::zero(component) }
}

/// Makes the final combiner. It outputs the colour, to which the secondary colour may be added: in D alone, or blended with the fog colour by A.
pub(super) fn final_combiner(end: End, alpha_is_blue: bool, constants: [[u8; 4]; 2]) -> FinalCombiner {
    let input = |register, component| FinalInput { register, component, invert: false };
    let zero = FinalInput::zero(Component::Rgb);
    let color = if end.specular { FinalRegister::Spare0PlusSecondary } else { FinalRegister::Spare0 };
    let color = input(color, Component::Rgb);
    let inputs = if end.fog {
        let [factor, fog] = [Component::Alpha, Component::Rgb].map(|component| input(FinalRegister::Fog, component));
        [factor, color, fog, zero, zero, zero]
    } else {
        [zero, zero, zero, color, zero, zero]
    };
    FinalCombiner {
        inputs,
        g: input(FinalRegister::Spare0, if alpha_is_blue { Component::Blue } else { Component::Alpha }),
        constants,
        ..FinalCombiner::default()
    }
}
