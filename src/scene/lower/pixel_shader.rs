//! Lowers `PixelShader(...)`: Direct3D pixel shaders, version 1.1.

use super::api_program::{ApiProgram, Around};
use super::program_text::ProgramText;
use super::unit::Units;
use super::*;
use ninebit_program::c_source::Style;
use ninebit_program::pixel_shader::{self, Bump, CONSTANTS, Context, PixelShader, UnitUse};

/// A shader with its text, and the constants and bump states that the API sets beside it.
pub(super) struct ShaderProgram {
    program: PixelShader,
    text: ProgramText,
    constants: [Option<[f32; 4]>; CONSTANTS],
    bumps: [Bump; TEXTURE_UNITS],
}

/// Reads the text or the fields in the parentheses.
pub(super) fn pixel_shader<'a>(reader: &mut Reader<'a>, text: &'a str) -> Option<ApiProgram> {
    let (mut constants, mut bumps) = ([None; CONSTANTS], [Bump::default(); TEXTURE_UNITS]);
    let inside = crate::notation::trim(text.strip_prefix('(').unwrap_or(text));
    let errors = reader.errors;
    let text = if Raw::<String>::new(inside).is_text() {
        ProgramText::read(reader, text)?
    } else {
        let fields = reader.read(&Raw::<source::PixelShader<'a>>::new(text))?;
        for entry in reader.table("constant", &fields.constants) {
            if let Some(index) = register(reader, &entry.name, entry.place, 'c', CONSTANTS, "constant") {
                constants[index] = reader.value(&entry.value).map(color::floats);
            }
        }
        for entry in reader.table("bump state", &fields.bump) {
            if let Some(index) = register(reader, &entry.name, entry.place, 't', TEXTURE_UNITS, "texture register") {
                bumps[index] = bump(reader, &entry.value).unwrap_or_default();
            }
        }
        match (&fields.text, &fields.file) {
            (Some(raw), None) => ProgramText::inline(reader, raw)?,
            (Some(_), Some(raw)) => {
                let help = "keep one of `text` and `file`";
                let message = "a pixel shader is given twice";
                return reader.refuse(finding("NB0356", reader.span(raw), message, "again here", help));
            }
            (None, _) => {
                let raw = fields.file(reader)?;
                ProgramText::file(reader, &raw)?
            }
        }
    };
    let shader = shader(reader, text, constants, bumps)?;
    (reader.errors == errors).then_some(shader)
}

/// Reads the text of a shader for which the API sets constants and bump states.
pub(super) fn shader(
    reader: &mut Reader<'_>,
    text: ProgramText,
    constants: [Option<[f32; 4]>; CONSTANTS],
    bumps: [Bump; TEXTURE_UNITS],
) -> Option<ApiProgram> {
    let text = text.expanded(reader, Style::Assembler)?;
    let parsed = text.parsed(reader, pixel_shader::parse(&text.text))?;
    text.push(reader, parsed.warnings);
    let program = parsed.program;
    for read in program.constants_read() {
        let defined = program.definitions.iter().any(|definition| definition.index == read.value);
        if !defined && constants.get(usize::from(read.value)).is_some_and(Option::is_none) {
            let index = read.value;
            let help =
                format!("write `constants: {{ \"c{index}\": Float(1, 0.5, 0, 1) }}` beside the text, or `def` in it");
            reader.push(text.locate(warning("NB0910", read.span, format!("c{index} has no value"), "is 0", help)));
        }
    }
    Some(ApiProgram::Shader(Box::new(ShaderProgram { program, text, constants, bumps })))
}

/// Returns the number in a register's name. Returns `None` after recording that it is not a register.
fn register(reader: &mut Reader<'_>, name: &str, place: Span, letter: char, count: usize, what: &str) -> Option<usize> {
    let digits = name.strip_prefix(letter).filter(|digits| digits.len() == 1);
    let index = digits.and_then(|digits| digits.parse::<usize>().ok()).filter(|index| *index < count);
    if index.is_none() {
        let message = format!("there is no {what} \"{}\"", shorten(name));
        let help = format!("write \"{letter}0\" to \"{letter}{}\"", count - 1);
        reader.push(finding("NB0208", place, message, "not a register", help));
    }
    index
}

fn bump<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::BumpEnvironment<'a>>) -> Option<Bump> {
    let fields = source::BumpEnvironment { called: "bump state", ..reader.read(raw)? };
    let (matrix, luminance) = shader::bump_numbers(reader, &fields, ["a bump matrix", "a bump luminance"])?;
    Some(Bump { matrix: Some(matrix), luminance })
}

impl ShaderProgram {
    /// Returns the units whose instructions read a cube map.
    pub(super) fn cubes(&self) -> [bool; TEXTURE_UNITS] {
        let mut cubes = [false; TEXTURE_UNITS];
        for texture in &self.program.textures {
            use pixel_shader::TextureOperation::{Texm3x3spec, Texm3x3tex, Texm3x3vspec};
            if let Some(cube) = cubes.get_mut(usize::from(texture.unit.value)) {
                *cube = matches!(texture.operation, Texm3x3tex | Texm3x3spec | Texm3x3vspec);
            }
        }
        cubes
    }

    /// Lowers the shader to combiners with their origins, and writes its texture instructions into `shader`.
    pub(super) fn lower(
        &self,
        reader: &mut Reader<'_>,
        units: &Units,
        shader: &mut [ShaderStage; TEXTURE_UNITS],
        around: &mut Around,
        signed: [bool; TEXTURE_UNITS],
    ) -> Result<(Combiners, Vec<StageOrigin>), Vec<Diagnostic>> {
        let constants = self.constants.map(Option::unwrap_or_default);
        let context = Context { profile: reader.profile, signed, fog: around.fog, constants, bumps: self.bumps };
        let place = |findings: Vec<Diagnostic>| -> Vec<Diagnostic> {
            findings.into_iter().map(|finding| self.text.locate(finding)).collect()
        };
        let lowered = pixel_shader::lower(&self.program, &context).map_err(place)?;
        let mut findings = Vec::new();
        for (index, using) in lowered.units.iter().enumerate() {
            if units.bound[index].is_some() && !using.as_ref().is_some_and(|using| using.operation.samples()) {
                unsampled(reader, units, index);
            }
            let Some(using) = using else {
                // On Nv10 all units sample, but nothing reads the result of this one.
                if reader.profile == Profile::Nv2a {
                    shader[index].operation = ShaderOperation::None;
                }
                continue;
            };
            findings
                .extend(objection(reader, units, index, using, around.shader).map(|finding| self.text.locate(finding)));
            shader[index].operation = using.operation;
            (shader[index].previous, shader[index].mapping) = (using.previous, using.mapping);
        }
        without_q(shader, &mut around.without_q);
        if findings.is_empty() { Ok((lowered.combiners, lowered.origins)) } else { Err(findings) }
    }
}

/// Gives each `texkill` a coordinate set whose q is 1: its own, or one that no other unit reads. The instruction looks at s, t and r, but the chip
/// tests q as well (TSH-10).
fn without_q(shader: &mut [ShaderStage; TEXTURE_UNITS], sets: &mut [Option<usize>; 4]) {
    for index in 0..TEXTURE_UNITS {
        if !matches!(shader[index].operation, ShaderOperation::CullFragment { .. }) {
            continue;
        }
        let from = shader[index].coordinate_set;
        let read = |set: usize| {
            let mut others = shader.iter().enumerate().filter(|(other, _)| *other != index);
            others.any(|(_, stage)| stage.operation != ShaderOperation::None && stage.coordinate_set == set)
        };
        if let Some(to) = std::iter::once(from).chain(0..4).find(|set| !read(*set)) {
            sets[to] = Some(from);
            shader[index].coordinate_set = to;
        }
    }
}

/// Warns that a unit has a texture that is not sampled.
fn unsampled(reader: &mut Reader<'_>, units: &Units, index: usize) {
    let place = units.places[index].clone();
    let label = format!("no instruction of the pixel shader samples into t{index}");
    let help = format!("write `Unbound` here, or `tex t{index}` in the shader");
    reader.push(warning("NB0905", place, format!("unit {index} has a texture that is not sampled"), label, help));
}

/// Returns the finding that a unit cannot do what the shader asks of it, if so.
fn objection(reader: &Reader<'_>, units: &Units, index: usize, using: &UnitUse, shader: bool) -> Option<Diagnostic> {
    let place = using.span.clone();
    if shader {
        let message = "texture instructions beside a texture shader";
        let (label, help) = ("becomes a texture shader itself", "leave the draw's `texture_shader` out");
        return Some(finding("NB0352", place, message, label, help).rule("TSH-10"));
    }
    if !using.operation.samples() {
        return None;
    }
    let Some(unit) = units.bound[index] else {
        if !units.places[index].is_empty() {
            return None;
        }
        let message = format!("t{index} is sampled, but unit {index} has no texture");
        let help = format!("give the draw `textures: [...]` with an entry for unit {index}");
        return Some(finding("NB0343", place, message, "nothing to sample", help).rule("TSH-10"));
    };
    let texture = reader.textures.list.get(unit.texture)?;
    let fits = using.operation.kinds();
    (!fits.contains(&texture.kind)).then(|| {
        let names: Vec<&str> = fits.iter().map(|kind| kind.name()).collect();
        let message = format!("this does not sample a texture of kind {}, which unit {index} has", texture.kind.name());
        let help = "give the unit another texture, or take the instruction for this kind";
        finding("NB0343", place, message, format!("needs {}", names.join(" or ")), help).rule("TSH-10")
    })
}
