//! Programs in the language of an API, which become combiners for each draw.

use super::pixel_shader::ShaderProgram;
use super::program_text::{ProgramText, placed};
use super::unit::Units;
use super::*;
use ninebit::vertex::texgen::CoordinateSet;
use ninebit_program::Spanned;
use ninebit_program::texture_environment::{self as environment, BaseFormat, TextureEnvironment};
use ninebit_program::texture_stages::{self as stages, TextureStages};

/// A program of an API.
pub(super) enum ApiProgram {
    /// Texture stages of Direct3D.
    Stages(TextureStages, Option<ProgramText>),
    /// Texture environments of OpenGL.
    Environment(TextureEnvironment, Option<ProgramText>),
    /// Direct3D, version 1.1 of pixel shaders.
    Shader(Box<ShaderProgram>),
}

/// What of a draw the lowering depends on, or changes.
pub(super) struct Around {
    /// Fog is enabled.
    pub(super) fog: bool,
    /// The draw has a texture shader of its own.
    pub(super) shader: bool,
    /// The draw has generators of its own.
    pub(super) generators: bool,
    /// How the coordinate sets are made, if not all are as they were given.
    pub(super) sets: Option<[CoordinateSet; 4]>,
    /// Sets that are written at the end: the set s, t and r come from, q being 1.
    pub(super) without_q: [Option<usize>; 4],
}

/// What it becomes in a draw.
pub(super) struct Lowered {
    pub(super) combiners: Combiners,
    pub(super) origins: Vec<StageOrigin>,
    pub(super) shader: [ShaderStage; TEXTURE_UNITS],
}

impl Lowered {
    /// Combiners as they are written, which leave the units as they are.
    pub(super) fn as_written(combiners: Combiners, units: &Units) -> Self {
        Lowered { combiners, origins: Vec::new(), shader: units.shader }
    }
}

impl ApiProgram {
    /// The units whose instructions read a cube map.
    pub(super) fn cubes(&self) -> [bool; TEXTURE_UNITS] {
        if let ApiProgram::Shader(program) = self { program.cubes() } else { [false; TEXTURE_UNITS] }
    }

    /// Lowers the program for a draw; the default program once the reason that it has no form has been recorded.
    pub(super) fn lower(&self, reader: &mut Reader<'_>, units: &Units, around: &mut Around) -> Lowered {
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
            Ok((combiners, origins)) => Lowered { combiners, origins, shader },
            Err(findings) => {
                // Several draws may share a program: each finding once.
                for finding in findings {
                    if !reader.diagnostics.contains(&finding) {
                        reader.push(finding);
                    }
                }
                Lowered { combiners: Combiners::default(), origins: Vec::new(), shader }
            }
        }
    }
}

/// Coordinate sets of the units: chosen, or made of generators or a stage's transform. A made one takes the set of the unit's number if no
/// other unit reads that as it was given, or else one that none reads.
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
            // Flags that another stage has brought in: it has been complained of.
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

/// What keeps a unit from looking up where the texture before it moves the coordinates.
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
        Diagnostic::error("NB0343", bump.span.clone(), message)
            .label("moves coordinates of the next texture")
            .rule("TSH-10")
            .help("bind a two-dimensional texture to the next unit")
    })
}

/// A name with its place; the default without one if nothing is written.
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
