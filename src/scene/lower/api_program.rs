//! Lowers programs in the language of an API to combiners, for each draw.

use super::pixel_shader::ShaderProgram;
use super::program_text::{ProgramText, placed};
use super::unit::Units;
use super::*;
use ninebit::vertex::texgen::CoordinateSet;
use ninebit_program::Spanned;
use ninebit_program::texture_environment::{self as environment, BaseFormat, TextureEnvironment};
use ninebit_program::texture_stages::{self as stages, TextureStages};

pub(super) enum ApiProgram {
    /// Texture stages of Direct3D, and the text they were written in, if any.
    Stages(TextureStages, Option<ProgramText>),
    /// Texture environments of OpenGL, and the text they were written in, if any.
    Environment(TextureEnvironment, Option<ProgramText>),
    /// A pixel shader of Direct3D, version 1.1.
    Shader(Box<ShaderProgram>),
}

/// State of a draw that the lowering depends on or changes.
pub(super) struct Around {
    /// Whether fog is enabled.
    pub(super) fog: bool,
    /// Whether the draw has a texture shader of its own.
    pub(super) shader: bool,
    /// Whether the draw has generators of its own.
    pub(super) generators: bool,
    /// How the coordinate sets are made; `None` if all are used as they are given.
    pub(super) sets: Option<[CoordinateSet; 4]>,
    /// For each set that is rewritten at the end, the set that its s, t and r come from; its q becomes 1.
    pub(super) without_q: [Option<usize>; 4],
}

/// A program that has been lowered for a draw.
pub(super) struct DrawProgram {
    pub(super) combiners: Combiners,
    pub(super) origins: Vec<StageOrigin>,
    pub(super) shader: [ShaderStage; TEXTURE_UNITS],
}

impl DrawProgram {
    /// Wraps combiners that were written as such, which leave the units unchanged.
    pub(super) fn as_written(combiners: Combiners, units: &Units) -> Self {
        DrawProgram { combiners, origins: Vec::new(), shader: units.shader }
    }
}

impl ApiProgram {
    /// Returns the units whose instructions read a cube map.
    pub(super) fn cubes(&self) -> [bool; TEXTURE_UNITS] {
        if let ApiProgram::Shader(program) = self { program.cubes() } else { [false; TEXTURE_UNITS] }
    }

    /// Lowers the program for a draw. If it cannot be lowered, records the findings and returns the default program.
    pub(super) fn lower(&self, reader: &mut Reader<'_>, units: &Units, around: &mut Around) -> DrawProgram {
        let profile = reader.profile;
        let signed = units.bound.map(|unit| unit.is_some_and(|unit| unit.signed != [false; 4]));
        let mut shader = units.shader;
        let lowered = match self {
            ApiProgram::Stages(program, text) => {
                let bound = units.shader.map(|stage| stage.operation != ShaderOperation::None);
                let context = stages::Context { profile, bound, signed, fog: around.fog };
                let mut findings = Vec::new();
                let lowered = stages::lower(program, &context).map(|lowered| {
                    generate(&lowered.units, profile, &mut shader, around, &mut findings);
                    for (index, change) in lowered.units.iter().enumerate() {
                        let Some(bump) = &change.operation else { continue };
                        findings.extend(objection(reader, units, index, bump, around.shader));
                        (shader[index].operation, shader[index].previous) = (bump.value, index.saturating_sub(1));
                    }
                    (lowered.combiners, lowered.origins)
                });
                let lowered = lowered.and_then(|lowered| if findings.is_empty() { Ok(lowered) } else { Err(findings) });
                lowered.map_err(|findings| placed(text.as_ref(), findings))
            }
            ApiProgram::Shader(program) => program.lower(reader, units, &mut shader, around, signed),
            ApiProgram::Environment(program, text) => {
                let format = |unit: TextureUnit| reader.textures.list.get(unit.texture).map(|texture| texture.format);
                let formats = std::array::from_fn(|index| match units.shader[index].operation {
                    ShaderOperation::None => None,
                    _ => Some(units.bound[index].and_then(format).map_or(BaseFormat::Rgba, BaseFormat::from_format)),
                });
                let context = environment::Context { profile, textures: formats, signed, fog: around.fog };
                let lowered = environment::lower(program, &context).map_err(|findings| placed(text.as_ref(), findings));
                lowered.map(|lowered| (lowered.combiners, lowered.origins))
            }
        };
        match lowered {
            Ok((combiners, origins)) => DrawProgram { combiners, origins, shader },
            Err(findings) => {
                // Several draws may share a program: each finding is recorded once.
                for finding in findings {
                    if !reader.diagnostics.contains(&finding) {
                        reader.push(finding);
                    }
                }
                DrawProgram { combiners: Combiners::default(), origins: Vec::new(), shader }
            }
        }
    }
}

/// Assigns coordinate sets to the units: a chosen set, or one made by generators or a stage's transform. A set that is made gets the number of its
/// unit, unless another unit reads the set of that number as it was given; it then gets the first number that no unit reads.
fn generate(
    changes: &[stages::UnitChange; TEXTURE_UNITS],
    profile: Profile,
    shader: &mut [ShaderStage; TEXTURE_UNITS],
    around: &mut Around,
    findings: &mut Vec<Diagnostic>,
) {
    let mut taken = [false; 4];
    for (stage, change) in shader.iter_mut().zip(changes) {
        stage.coordinate_set = change.coordinate_set.unwrap_or(stage.coordinate_set);
        if change.generation.is_none() && change.transform.is_none() && stage.operation != ShaderOperation::None {
            taken[stage.coordinate_set] = true;
        }
    }
    let written = around.sets;
    for (index, change) in changes.iter().enumerate() {
        let made = match (&change.generation, &change.transform) {
            (Some(made), _) => Some((made.value.name(), "generates coordinates as well", &made.span)),
            (None, Some(made)) => Some(("a transform of coordinates", "makes coordinates as well", &made.span)),
            (None, None) => None,
        };
        let Some((what, label, place)) = made else { continue };
        if around.generators {
            // These flags come from another stage, about which there has been a finding.
            if place.is_empty() {
                continue;
            }
            let message = format!("{what} beside the draw's texgen");
            findings.push(finding("NB0352", place.clone(), message, label, "leave one of them out").rule("TSH-11"));
            continue;
        }
        let free = std::iter::once(index).chain(0..profile.texture_units()).find(|set| !taken[*set]);
        let Some(set) = free else { continue };
        taken[set] = true;
        let input = std::mem::replace(&mut shader[index].coordinate_set, set);
        let sets = around.sets.get_or_insert_with(|| [0, 1, 2, 3].map(CoordinateSet::given));
        sets[set] = CoordinateSet {
            generators: change.generation.as_ref().map_or([None; 4], |made| texgen::whole(made.value)),
            matrix: written.and_then(|sets| sets[index].matrix),
            transform: change.transform.as_ref().map(|made| made.value),
            ..CoordinateSet::given(input)
        };
    }
}

/// Returns the finding that a unit cannot look up where the texture before it moves the coordinates, if so.
fn objection(
    reader: &Reader<'_>,
    units: &Units,
    index: usize,
    bump: &Spanned<ShaderOperation>,
    shader: bool,
) -> Option<Diagnostic> {
    if shader {
        let message = "a bump environment map beside a texture shader";
        let label = "becomes a texture shader itself";
        let help = "leave the draw's `texture_shader` out, or write a BumpEnvironment stage there and Disable here";
        return Some(finding("NB0352", bump.span.clone(), message, label, help).rule("TSH-10"));
    }
    let texture = units.bound[index].and_then(|unit| reader.textures.list.get(unit.texture))?;
    (texture.kind == TextureKind::Cube).then(|| {
        let message = format!("texture {index} is a cube map, whose coordinates are not moved");
        let label = "moves coordinates of the next texture";
        let help = "bind a two-dimensional texture to the next unit";
        finding("NB0343", bump.span.clone(), message, label, help).rule("TSH-10")
    })
}

/// Reads a name and its place into `slot`, which stays unchanged if nothing is written.
pub(super) fn name_at<'a, T: ninebit::state::Named>(
    reader: &mut Reader<'a>,
    raw: &Option<Raw<'a, crate::reader::Name<T>>>,
    slot: &mut Spanned<T>,
) {
    if let Some(raw) = raw
        && let Some(value) = reader.name(raw)
    {
        *slot = Spanned { value, span: reader.span(raw) };
    }
}
