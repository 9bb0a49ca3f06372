//! Reads register combiners as pasted OpenGL calls of NV_register_combiners and NV_register_combiners2.

use super::calls::opengl::{self, bare, capability, choose, color, flag, is_vector, numbered, table, whole};
use super::calls::{PastedProgram, Reader, Statement, Value, Vocabulary, wrong_kind};
use super::finding::finding;
use super::{Part, Place, Places};
use crate::Span;
use ninebit::diagnostic::Diagnostic;
use ninebit::legality::{Help, Notation, only_final};
use ninebit::state::*;

/// What is read of OpenGL for register combiners.
static COMBINERS: Vocabulary = Vocabulary {
    calls: "CombinerInputNV CombinerOutputNV CombinerParameteriNV CombinerParameterfNV CombinerParameterivNV \
            CombinerParameterfvNV CombinerStageParameterfvNV glEnable glDisable",
    silent: "BindTexture ActiveTexture ActiveTextureARB",
    states: Vec::new,
    instead: opengl::INSTEAD,
    example: "`glFinalCombinerInputNV(GL_VARIABLE_D_NV, GL_SPARE0_NV, GL_UNSIGNED_IDENTITY_NV, GL_RGB);`",
    what: "the register combiners",
};

/// A program read from calls.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// The program as state of the chip.
    pub combiners: Combiners,
    /// Places of its parts in the text.
    pub places: Places,
}

/// Reads the text, starting from the API's initial state. [`legality::check`](ninebit::legality::check) decides what a chip allows of it.
///
/// # Errors
/// Findings about whatever is not a statement, or sets something that the API does not have.
pub fn parse(text: &str) -> Result<PastedProgram<Program>, Vec<Diagnostic>> {
    let most = Profile::Nv2a.general_stages();
    let mut parser = Parser {
        reader: Reader::new(text, &COMBINERS),
        stages: vec![GeneralStage::initial([[0; 4]; 2]); most],
        last: FinalCombiner::initial([[0; 4]; 2]),
        count: 1,
        touched: vec![None; most],
        per_stage: None,
        own: None,
        places: Vec::new(),
    };
    while let Some(statement) = parser.reader.next() {
        if let Statement::Call { name, arguments } = statement {
            // What is wrong with a call has been recorded.
            let _ = parser.call(&name, &arguments);
        }
    }
    parser.finish()
}

struct Parser<'t> {
    reader: Reader<'t>,
    stages: Vec<GeneralStage>,
    last: FinalCombiner,
    /// Value of NUM_GENERAL_COMBINERS.
    count: usize,
    /// The first call about each stage.
    touched: Vec<Option<Span>>,
    /// Place where PER_STAGE_CONSTANTS is enabled.
    per_stage: Option<Span>,
    /// Place of the first call that sets a stage's own constant.
    own: Option<Span>,
    /// Places of parts; of a part that is written twice the last one counts.
    places: Vec<(Place, Span)>,
}

const REGISTERS: &str = "ZERO CONSTANT_COLOR0 CONSTANT_COLOR1 FOG PRIMARY_COLOR SECONDARY_COLOR \
                         TEXTURE0 TEXTURE1 TEXTURE2 TEXTURE3 SPARE0 SPARE1 SPARE0_PLUS_SECONDARY_COLOR E_TIMES_F";
const MAPPINGS: &str = "UNSIGNED_IDENTITY UNSIGNED_INVERT EXPAND_NORMAL EXPAND_NEGATE \
                        HALF_BIAS_NORMAL HALF_BIAS_NEGATE SIGNED_IDENTITY SIGNED_NEGATE";
const COMPONENTS: &[(&str, Component)] =
    &[("RGB", Component::Rgb), ("ALPHA", Component::Alpha), ("BLUE", Component::Blue)];
const VARIABLES: &str = "VARIABLE_A VARIABLE_B VARIABLE_C VARIABLE_D VARIABLE_E VARIABLE_F VARIABLE_G";
/// Parameters: the two constants with their numbers, and others.
const PARAMETERS: &[(&str, usize)] = &[
    ("CONSTANT_COLOR0", 0),
    ("CONSTANT_COLOR1", 1),
    ("NUM_GENERAL_COMBINERS", NUM_GENERAL_COMBINERS),
    ("COLOR_SUM_CLAMP", COLOR_SUM_CLAMP),
];
const NUM_GENERAL_COMBINERS: usize = 2;
const COLOR_SUM_CLAMP: usize = 3;
const SCALES: &[(&str, Scale)] = &[
    ("NONE", Scale::One),
    ("SCALE_BY_TWO", Scale::Two),
    ("SCALE_BY_FOUR", Scale::Four),
    ("SCALE_BY_ONE_HALF", Scale::Half),
];
const BIASES: &[(&str, Bias)] = &[("NONE", Bias::None), ("BIAS_BY_NEGATIVE_ONE_HALF", Bias::NegativeHalf)];

/// Returns the variables with their numbers.
fn variables() -> Vec<(&'static str, usize)> {
    VARIABLES.split(' ').zip(0..).collect()
}

impl<'t> Parser<'t> {
    /// Processes one call. Returns `None` after recording what is wrong.
    fn call(&mut self, name: &Span, arguments: &[Value<'t>]) -> Option<()> {
        let function = self.reader.word(name);
        let wanted = match function {
            _ if function.ends_with("FinalCombinerInputNV") => 4,
            _ if function.ends_with("CombinerInputNV") => 6,
            _ if function.ends_with("CombinerOutputNV") => 10,
            _ if function.contains("StageParameter") => 3,
            _ if function.contains("Parameter") => 2,
            _ => 1,
        };
        self.reader.takes(name, wanted, arguments.len())?;
        match arguments {
            [variable, input, mapping, usage] => self.final_input([variable, input, mapping, usage]),
            [stage, portion, variable, input, mapping, usage] => {
                let (stage, alpha) = self.portion(name, stage, portion)?;
                self.input((stage, alpha), [variable, input, mapping, usage])
            }
            [stage, portion, outputs @ ..] if wanted == 10 => {
                let (stage, alpha) = self.portion(name, stage, portion)?;
                self.output((stage, alpha), outputs)
            }
            [stage, parameter, value] => {
                let stage = self.stage(name, stage)?;
                let constant = choose(parameter, "constant", &PARAMETERS[..2], &mut self.reader.findings)?;
                self.own.get_or_insert(name.clone());
                self.places.push((Place::StageConstants(stage), name.clone()));
                self.stages[stage].constants[constant] = color(&mut self.reader, value, function)?;
                Some(())
            }
            [parameter, value] => self.parameter(function, parameter, value),
            [value] => {
                self.enable(name, value, function.ends_with("glEnable"));
                Some(())
            }
            _ => None,
        }
    }

    fn enable(&mut self, name: &Span, value: &Value<'t>, enable: bool) {
        match bare(self.reader.word(&value.span), &[]) {
            "PER_STAGE_CONSTANTS" => self.per_stage = enable.then(|| value.span.clone()),
            // The program is that of the combiners in any case.
            "REGISTER_COMBINERS" => {}
            _ => capability(&mut self.reader, name, value, enable),
        }
    }

    fn parameter(&mut self, function: &str, parameter: &Value<'t>, value: &Value<'t>) -> Option<()> {
        // A vector call takes a pointer to one value, which stands for that value.
        let one = self.reader.list(value).and_then(|values| values.first()).filter(|_| is_vector(function)).cloned();
        match choose(parameter, "parameter of the combiners", PARAMETERS, &mut self.reader.findings)? {
            NUM_GENERAL_COMBINERS => {
                let most = self.stages.len();
                let count = whole(one.as_ref().unwrap_or(value), &mut self.reader.findings)? as usize;
                if !(1..=most).contains(&count) {
                    let message = format!("there cannot be {count} general stages");
                    let help = format!("write 1 to {most}; Nv10 has 2");
                    self.reader.findings.push(finding("NB0206", value.span.clone(), message, "out of range", help));
                    return None;
                }
                self.count = count;
                self.places.push((Place::Stages, value.span.clone()));
            }
            COLOR_SUM_CLAMP => {
                self.last.color_sum_clamp = flag(one.as_ref().unwrap_or(value), &mut self.reader.findings)?;
            }
            constant => {
                if !is_vector(function) {
                    let help = "write `glCombinerParameterfvNV(GL_CONSTANT_COLOR0_NV, color);`";
                    return wrong_kind(value, "a pointer to four numbers", help, &mut self.reader.findings);
                }
                self.last.constants[constant] = color(&mut self.reader, value, function)?;
            }
        }
        Some(())
    }

    fn stage(&mut self, name: &Span, stage: &Value<'t>) -> Option<usize> {
        let most = self.stages.len();
        let index = numbered(stage, "COMBINER", most, "general stage", &mut self.reader.findings)?;
        self.touched[index].get_or_insert(name.clone());
        Some(index)
    }

    /// Reads the stage, and whether its alpha portion is meant.
    fn portion(&mut self, name: &Span, stage: &Value<'t>, portion: &Value<'t>) -> Option<(usize, bool)> {
        let stage = self.stage(name, stage)?;
        let alpha = choose(portion, "portion", &[("RGB", false), ("ALPHA", true)], &mut self.reader.findings)?;
        Some((stage, alpha))
    }

    fn half(&mut self, (stage, alpha): (usize, bool)) -> &mut Portion {
        let stage = &mut self.stages[stage];
        if alpha { &mut stage.alpha } else { &mut stage.rgb }
    }

    fn set(&mut self, (stage, alpha): (usize, bool), part: Part, value: &Value<'t>) {
        self.places.push((Place::General { stage, alpha, part }, value.span.clone()));
    }

    /// Reads a register of a general stage.
    fn register(&mut self, value: &Value<'t>) -> Option<Register> {
        let register = choose(value, "register", &table(REGISTERS), &mut self.reader.findings)?;
        if matches!(register, FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF) {
            let (name, help) = (Words.register(register), "use it in `glFinalCombinerInputNV`");
            self.reader.findings.push(only_final(value.span.clone(), name, help));
            return None;
        }
        Some(ninebit::combiner::final_combiner::general(register))
    }

    /// Sets an input of a portion: variable, register, mapping and components.
    fn input(&mut self, portion: (usize, bool), values: [&Value<'t>; 4]) -> Option<()> {
        let [variable, input, mapping, usage] = values;
        let n = choose(variable, "variable of a general stage", &variables()[..4], &mut self.reader.findings);
        let register = self.register(input);
        let mapping = choose(mapping, "mapping", &table(MAPPINGS), &mut self.reader.findings);
        let component = choose(usage, "component usage", COMPONENTS, &mut self.reader.findings);
        let (n, register, mapping, component) = (n?, register?, mapping?, component?);
        self.half(portion).inputs[n] = CombinerInput { register, component, mapping };
        self.set(portion, Part::Input(n), input);
        self.set(portion, Part::Component(n), usage);
        Some(())
    }

    /// Sets the outputs of a portion: AB, CD, sum, scale, bias, AB dot, CD dot, mux.
    fn output(&mut self, portion: (usize, bool), outputs: &[Value<'t>]) -> Option<()> {
        let [ab, cd, sum, scale, bias, ab_dot, cd_dot, mux] = outputs else { return None };
        let registers = [ab, cd, sum].map(|value| match bare(self.reader.word(&value.span), &[]) {
            "DISCARD" => Some(Register::Zero),
            "ZERO" => wrong_kind(value, "a register to write", "write GL_DISCARD_NV", &mut self.reader.findings),
            _ => self.register(value),
        });
        let findings = &mut self.reader.findings;
        let written = (choose(scale, "scale", SCALES, findings), choose(bias, "bias", BIASES, findings));
        let flags = [ab_dot, cd_dot, mux].map(|value| flag(value, findings));
        let ([ab_output, cd_output, sum_output], [ab_is_dot, cd_is_dot, is_mux]) = (registers, flags);
        let half = self.half(portion);
        half.ab_output = ab_output?;
        half.cd_output = cd_output?;
        half.sum_output = sum_output?;
        (half.scale, half.bias) = (written.0?, written.1?);
        half.ab_dot_product = ab_is_dot?;
        half.cd_dot_product = cd_is_dot?;
        half.mux = is_mux?;
        let parts = [
            (Part::Output(0), ab),
            (Part::Output(1), cd),
            (Part::Output(2), sum),
            (Part::Scale, scale),
            (Part::Bias, bias),
            (Part::Dot(0), ab_dot),
            (Part::Dot(1), cd_dot),
        ];
        parts.into_iter().for_each(|(part, value)| self.set(portion, part, value));
        Some(())
    }

    /// Sets an input of the final combiner.
    fn final_input(&mut self, [variable, input, mapping, usage]: [&Value<'t>; 4]) -> Option<()> {
        let findings = &mut self.reader.findings;
        let n = choose(variable, "variable of the final combiner", &variables(), findings);
        let register = choose(input, "register", &table(REGISTERS), findings);
        let mapped = choose(mapping, "mapping", &table(MAPPINGS), findings);
        let component = choose(usage, "component usage", COMPONENTS, findings);
        let (n, register, mapped, component) = (n?, register?, mapped?, component?);
        let invert = match mapped {
            InputMapping::UnsignedIdentity => false,
            InputMapping::UnsignedInvert => true,
            _ => {
                let help = "write GL_UNSIGNED_IDENTITY_NV or GL_UNSIGNED_INVERT_NV; map in a general stage";
                let message = "the final combiner has no such mapping";
                findings.push(finding("NB0311", mapping.span.clone(), message, "not here", help).rule("FIN-1"));
                return None;
            }
        };
        let input_value = FinalInput { register, component, invert };
        match self.last.inputs.get_mut(n) {
            Some(slot) => *slot = input_value,
            None => self.last.g = input_value,
        }
        self.places.push((Place::FinalInput(n), input.span.clone()));
        self.places.push((Place::FinalComponent(n), usage.span.clone()));
        Some(())
    }

    fn finish(mut self) -> Result<PastedProgram<Program>, Vec<Diagnostic>> {
        if let Some(span) = self.touched[self.count..].iter().flatten().min_by_key(|span| span.start).cloned() {
            let message = format!("GL_NUM_GENERAL_COMBINERS_NV is {}: stages beyond are not run", self.count);
            let help = "write `glCombinerParameteriNV(GL_NUM_GENERAL_COMBINERS_NV, ...)`; it is 1 where the text does not say it";
            self.reader.pass(span, "GL_NUM_GENERAL_COMBINERS_NV", &message, "of a stage beyond", help);
        }
        if let (Some(span), None) = (self.own.clone(), &self.per_stage) {
            let message = "constants of stages count with GL_PER_STAGE_CONSTANTS_NV only";
            let help = "write `glEnable(GL_PER_STAGE_CONSTANTS_NV);` (NV_register_combiners2)";
            self.reader.pass(span, "GL_PER_STAGE_CONSTANTS_NV", message, "passed over", help);
        }
        let mut places = Places::default();
        // `Places` returns the first place that was set, so the last one written goes first.
        for (part, span) in self.places.into_iter().rev() {
            if self.per_stage.is_some() || !matches!(part, Place::StageConstants(_)) {
                places.set(part, span);
            }
        }
        for (stage, span) in self.touched.into_iter().enumerate().filter_map(|(n, span)| Some((n, span?))) {
            places.set(Place::Stage(stage), span);
        }
        let mut stages = self.stages;
        stages.truncate(self.count);
        if self.per_stage.is_none() {
            stages.iter_mut().for_each(|stage| stage.constants = self.last.constants);
        }
        let combiners = Combiners { stages, mux_select: MuxSelect::Msb, final_combiner: self.last };
        self.reader.finish(Program { combiners, places })
    }
}

/// Returns the name of a mapping, without `GL_` and `_NV`.
pub fn mapping_name(mapping: InputMapping) -> &'static str {
    MAPPINGS.split(' ').nth(mapping as usize).unwrap_or_default()
}

/// Returns the name of a bias, without `GL_` and `_NV`.
pub fn bias_name(bias: Bias) -> &'static str {
    BIASES.iter().find(|(_, known)| *known == bias).map_or("", |(name, _)| *name)
}

/// OpenGL's notation for findings about legality.
#[derive(Clone, Copy, Debug)]
pub struct Words;

impl Notation for Words {
    fn register(&self, of: FinalRegister) -> &'static str {
        REGISTERS.split(' ').nth(of as usize).unwrap_or_default()
    }

    fn scale(&self, scale: Scale) -> &'static str {
        SCALES.iter().find(|(_, known)| *known == scale).map_or("", |(name, _)| *name)
    }

    fn help(&self, help: Help) -> &'static str {
        match help {
            Help::EmptyStage => "write `glCombinerParameteriNV(GL_NUM_GENERAL_COMBINERS_NV, 1);`",
            Help::SharedConstants => {
                "leave GL_PER_STAGE_CONSTANTS_NV out, and set the constants with glCombinerParameterfvNV; profile Nv2a has own ones"
            }
            Help::OtherRegister => "send one of them to another register, or to GL_DISCARD_NV",
            Help::BiasScale => "with a bias the scale is GL_NONE or GL_SCALE_BY_TWO_NV",
            Help::FogColor => "write GL_RGB here",
            Help::FogBlue => "write GL_BLUE for the fog colour's blue",
            Help::SecondaryAlpha => {
                "profile Nv2a defines it: write `profile: Nv2a`, or read the alpha of GL_PRIMARY_COLOR_NV"
            }
            Help::RgbComponents | Help::FinalComponents => "write GL_RGB or GL_ALPHA",
            Help::AlphaComponents | Help::FinalAlphaComponents => "write GL_ALPHA or GL_BLUE",
            Help::Writable => {
                "write to GL_SPARE0_NV, GL_SPARE1_NV, GL_PRIMARY_COLOR_NV, GL_SECONDARY_COLOR_NV or a texture register"
            }
            Help::OtherInput => "read GL_SPARE0_NV or another register",
        }
    }
}
