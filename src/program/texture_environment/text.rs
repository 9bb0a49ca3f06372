//! Reads the texture environment from pasted text: calls of glTexEnv, with ARB_texture_env_combine and NV_texture_env_combine4.

use super::*;
use crate::calls::opengl::{self, bare, capability, choose, color, is_vector, numbered, table, whole};
use crate::calls::{PastedProgram, Reader, Statement, Value, Vocabulary, wrong_kind};

/// What is read of OpenGL for the texture environment.
static ENVIRONMENT: Vocabulary = Vocabulary {
    calls: "TexEnvi TexEnvf TexEnviv TexEnvfv ActiveTexture ActiveTextureARB glEnable glDisable \
            LightModeli LightModelf LightModeliv LightModelfv",
    silent: "BindTexture",
    states: Vec::new,
    instead: opengl::INSTEAD,
    example: "`glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);`",
    what: "the texture environment",
};

/// Reads the text, starting from the API's initial state.
///
/// # Errors
/// Findings about whatever is not a statement, or sets something that the API does not have.
pub fn parse(text: &str) -> Result<PastedProgram<TextureEnvironment>, Vec<Diagnostic>> {
    let reader = Reader::new(text, &ENVIRONMENT);
    let mut parser = Parser { reader, program: TextureEnvironment::default(), unit: 0 };
    while let Some(statement) = parser.reader.next() {
        if let Statement::Call { name, arguments } = statement {
            // What is wrong with a call has been recorded.
            let _ = parser.call(&name, &arguments);
        }
    }
    parser.reader.finish(parser.program)
}

struct Parser<'t> {
    reader: Reader<'t>,
    program: TextureEnvironment,
    /// The active texture unit.
    unit: usize,
}

/// A parameter of the environment. The `bool` says that it belongs to alpha, the number is that of the argument.
#[derive(Clone, Copy)]
enum Parameter {
    Mode,
    Color,
    Function(bool),
    Scale(bool),
    Source(bool, usize),
    Operand(bool, usize),
}

const MODES: &str = "REPLACE MODULATE DECAL BLEND ADD COMBINE COMBINE4";
const FUNCTIONS: &str =
    "REPLACE MODULATE ADD ADD_SIGNED INTERPOLATE SUBTRACT DOT3_RGB DOT3_RGBA DOT3_RGB_EXT DOT3_RGBA_EXT";
const SOURCES: &str = "TEXTURE TEXTURE0 TEXTURE1 TEXTURE2 TEXTURE3 CONSTANT PRIMARY_COLOR PREVIOUS ZERO";
const OPERANDS: &str = "SRC_COLOR ONE_MINUS_SRC_COLOR SRC_ALPHA ONE_MINUS_SRC_ALPHA";

/// Returns the names of the parameters. OpenGL 1.5 writes SRC for SOURCE.
fn parameters() -> Vec<(String, Parameter)> {
    let mut table =
        vec![("TEXTURE_ENV_MODE".to_owned(), Parameter::Mode), ("TEXTURE_ENV_COLOR".to_owned(), Parameter::Color)];
    for (alpha, half) in [(false, "RGB"), (true, "ALPHA")] {
        table.push((format!("COMBINE_{half}"), Parameter::Function(alpha)));
        table.push((format!("{half}_SCALE"), Parameter::Scale(alpha)));
        for n in 0..4 {
            table.push((format!("SOURCE{n}_{half}"), Parameter::Source(alpha, n)));
            table.push((format!("SRC{n}_{half}"), Parameter::Source(alpha, n)));
            table.push((format!("OPERAND{n}_{half}"), Parameter::Operand(alpha, n)));
        }
    }
    table
}

impl<'t> Parser<'t> {
    fn call(&mut self, name: &Span, arguments: &[Value<'t>]) -> Option<()> {
        let function = self.reader.word(name);
        let wanted = match function {
            _ if function.contains("TexEnv") => 3,
            _ if function.contains("LightModel") => 2,
            _ => 1,
        };
        self.reader.takes(name, wanted, arguments.len())?;
        match arguments {
            [target, parameter, value] => self.environment(function, target, parameter, value)?,
            [parameter, value] if bare(self.reader.word(&parameter.span), &[]) == "LIGHT_MODEL_COLOR_CONTROL" => {
                let table = [("SEPARATE_SPECULAR_COLOR", true), ("SINGLE_COLOR", false)];
                self.program.color_sum = choose(value, "colour control", &table, &mut self.reader.findings)?;
            }
            [_, _] => {}
            // This selects the coordinate set that calls about vertices set.
            [_] if function.contains("ClientActive") => {}
            [unit] if function.contains("ActiveTexture") => {
                self.unit = numbered(unit, "TEXTURE", TEXTURE_UNITS, "texture unit", &mut self.reader.findings)?;
            }
            [value] if bare(self.reader.word(&value.span), &[]) == "COLOR_SUM" => {
                self.program.color_sum = function.ends_with("glEnable");
            }
            [value] => capability(&mut self.reader, name, value, function.ends_with("glEnable")),
            _ => {}
        }
        Some(())
    }

    /// Processes `glTexEnvi(target, parameter, value)`.
    fn environment(
        &mut self,
        function: &str,
        target: &Value<'t>,
        parameter: &Value<'t>,
        value: &Value<'t>,
    ) -> Option<()> {
        let (span, written) = (target.span.clone(), self.reader.word(&target.span));
        match bare(written, &[]) {
            "TEXTURE_ENV" => {
                let table = parameters();
                let table: Vec<(&str, Parameter)> =
                    table.iter().map(|(name, parameter)| (name.as_str(), *parameter)).collect();
                let what = "parameter of the texture environment";
                let chosen = choose(parameter, what, &table, &mut self.reader.findings)?;
                return self.set(function, chosen, parameter, value);
            }
            "TEXTURE_FILTER_CONTROL" => {
                let help = "write it in the draw: `textures: [(texture: ..., lod_bias: ...)]`";
                self.reader.aside(span, written, "a bias of levels is a state of the sampler", help, None);
            }
            "TEXTURE_SHADER" => {
                let help = "write it in the draw: `texture_shader: [Sample, ...]`";
                let field = Some("texture_shader");
                self.reader.aside(span, written, "texture shaders are states of the draw", help, field);
            }
            _ => {
                let findings = &mut self.reader.findings;
                return wrong_kind(target, "the target GL_TEXTURE_ENV", "write GL_TEXTURE_ENV", findings);
            }
        }
        Some(())
    }

    fn set(&mut self, function: &str, chosen: Parameter, parameter: &Value<'t>, value: &Value<'t>) -> Option<()> {
        let vector = is_vector(function);
        let (span, index) = (value.span.clone(), self.unit);
        if let Parameter::Color = chosen {
            if !vector {
                let help = "write `glTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, color);`";
                return wrong_kind(value, "a pointer to four numbers", help, &mut self.reader.findings);
            }
            self.unit(index, parameter).color = color(&mut self.reader, value, function)?;
            return Some(());
        }
        // A vector call takes a pointer to one value, which stands for that value.
        let one = self.reader.list(value).and_then(|values| values.first()).filter(|_| vector).cloned();
        let value = one.as_ref().unwrap_or(value);
        let findings = &mut self.reader.findings;
        match chosen {
            Parameter::Mode => {
                let mode = choose(value, "mode of the texture environment", &table(MODES), findings)?;
                self.unit(index, parameter).mode = mode;
            }
            Parameter::Function(alpha) => {
                let value = choose(value, "combine function", &table(FUNCTIONS), findings)?;
                self.half(index, parameter, alpha).function = Spanned { value, span };
            }
            Parameter::Source(alpha, n) => {
                let value = choose(value, "source", &table(SOURCES), findings)?;
                self.half(index, parameter, alpha).sources[n] = Spanned { value, span };
            }
            Parameter::Operand(alpha, n) => {
                let value = choose(value, "operand", &table(OPERANDS), findings)?;
                self.half(index, parameter, alpha).operands[n] = Spanned { value, span };
            }
            Parameter::Scale(alpha) => {
                let scale = match whole(value, findings)? {
                    1 => Scale::One,
                    2 => Scale::Two,
                    4 => Scale::Four,
                    other => {
                        let message = format!("a scale cannot be {other}");
                        findings.push(finding("NB0206", span, message, "out of range", "write 1.0, 2.0 or 4.0"));
                        return None;
                    }
                };
                self.half(index, parameter, alpha).scale = scale;
            }
            Parameter::Color => {}
        }
        Some(())
    }

    /// Returns a unit, after adding it and those before it if needed.
    fn unit(&mut self, index: usize, by: &Value<'t>) -> &mut Unit {
        let units = &mut self.program.units;
        while units.len() <= index {
            units.push(Unit::initial());
        }
        let unit = &mut units[index];
        if unit.span.is_empty() {
            unit.span = by.span.clone();
        }
        unit
    }

    fn half(&mut self, index: usize, by: &Value<'t>, alpha: bool) -> &mut Half {
        let unit = self.unit(index, by);
        if alpha { &mut unit.alpha } else { &mut unit.rgb }
    }
}
