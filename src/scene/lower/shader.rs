//! Lowers the texture shader of a draw, and checks that the chip allows its stages in their order (TSH-10).

use super::unit::Units;
use super::*;
use ninebit::legality;

/// Names of the operations; the last two are recognised and refused.
const OPERATIONS: &[&str] = &[
    "None",
    "Sample",
    "Sample2D",
    "SampleCube",
    "PassThrough",
    "CullFragment",
    "BumpEnvironment",
    "DependentAlphaRed",
    "DependentGreenBlue",
    "DotProduct",
    "DotProduct2D",
    "DotProduct3D",
    "DotProductCube",
    "DotReflectDiffuse",
    "DotReflectSpecular",
    "DotReflectConstantEye",
    "DotProductDepth",
    "Brdf",
];

/// Places of a stage, and of those of its parts that may be wrong.
struct Places {
    stage: Span,
    previous: Option<Span>,
    mapping: Option<Span>,
}

/// Reads the texture shader of a draw into its units, which stay conventional if there is none.
pub(super) fn shader<'a>(
    reader: &mut Reader<'a>,
    units: &mut Units,
    raw: &Option<Raw<'a, source::List<'a, source::ShaderStage>>>,
) {
    let Some(raw) = raw else { return };
    let Some(list) = reader.read(raw) else { return };
    let lacks = target::needs_nv2a(reader.profile, true, "NB0340", reader.span(raw), "a texture shader", "TSH-10");
    if reader.accept(lacks).is_none() {
        return;
    }
    let places: [Option<Places>; TEXTURE_UNITS] = std::array::from_fn(|index| {
        units.shader[index].operation = ShaderOperation::None;
        list.get(index).and_then(|raw| self::stage(reader, raw, &mut units.shader[index]))
    });
    if let Some(extra) = list.get(TEXTURE_UNITS) {
        let message = format!("there is no texture unit {TEXTURE_UNITS}");
        let help = "units 0 to 3 are the entries of this list";
        reader.push(finding("NB0319", reader.span(extra), message, "one too many", help).rule("TSH-10"));
    }
    for (index, places) in places.iter().enumerate() {
        if let Some(places) = places {
            previous(reader, &mut units.shader, index, places);
            if order(reader, &units.shader, index, places) {
                texture(reader, units, index, places);
            }
        }
        let written = &units.places[index];
        if units.bound[index].is_some() && !units.shader[index].operation.samples() {
            let operation = units.shader[index].operation.name();
            let message = format!("unit {index} has a texture that is not sampled");
            let label = format!("its stage of the texture shader is {operation}");
            let help = "write `Unbound` here, or a stage that samples";
            reader.push(warning("NB0905", written.clone(), message, label, help).rule("TSH-10"));
        }
    }
}

/// Reads one stage: an operation, or fields with an operation among them. Returns `None` after recording what is wrong.
fn stage<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::ShaderStage>, stage: &mut ShaderStage) -> Option<Places> {
    if !raw.text.starts_with('(') {
        stage.operation = operation(reader, &raw.as_other())?;
        return Some(Places { stage: reader.span(raw), previous: None, mapping: None });
    }
    let fields = reader.read(&raw.as_other::<source::StageState<'a>>())?;
    let raw = fields.operation(reader);
    stage.coordinate_set = fields.coordinates(reader).map_or(stage.coordinate_set, |set| set as usize);
    stage.previous = fields.previous(reader).map_or(stage.previous, |unit| unit as usize);
    stage.mapping = fields.mapping(reader);
    stage.operation = operation(reader, raw.as_ref()?)?;
    let (previous, mapping) = (reader.place(&fields.previous), reader.place(&fields.mapping));
    Some(Places { stage: reader.place(&raw)?, previous, mapping })
}

fn operation<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::ShaderOperation>) -> Option<ShaderOperation> {
    let (kind, rest) = reader.variant(raw, "texture shader operation", OPERATIONS)?;
    let takes = matches!(OPERATIONS[kind], "CullFragment" | "BumpEnvironment" | "DotReflectConstantEye");
    if kind < OPERATIONS.len() - 2 && !takes && !rest.is_empty() {
        return reader.unknown_variant(raw, "texture shader operation", OPERATIONS);
    }
    Some(match OPERATIONS[kind] {
        "None" => ShaderOperation::None,
        "Sample" => ShaderOperation::Sample,
        "Sample2D" => ShaderOperation::Sample2D,
        "SampleCube" => ShaderOperation::SampleCube,
        "PassThrough" => ShaderOperation::PassThrough,
        "CullFragment" => cull(reader, rest)?,
        "BumpEnvironment" => bump(reader, rest, raw.text)?,
        "DependentAlphaRed" => ShaderOperation::DependentAlphaRed,
        "DependentGreenBlue" => ShaderOperation::DependentGreenBlue,
        "DotProduct" => ShaderOperation::DotProduct,
        "DotProduct2D" => ShaderOperation::DotProduct2D,
        "DotProduct3D" => ShaderOperation::DotProduct3D,
        "DotProductCube" => ShaderOperation::DotProductCube,
        "DotReflectDiffuse" => ShaderOperation::DotReflectDiffuse,
        "DotReflectSpecular" => ShaderOperation::DotReflectSpecular,
        "DotReflectConstantEye" => {
            let fields = source::ConstantEye { opening: raw.text, called: "operation", ..fields(reader, rest)? };
            let [x, y, z, _] = fields.eye(reader)?;
            ShaderOperation::DotReflectConstantEye { eye: [x, y, z] }
        }
        name => {
            let what = match name {
                "DotProductDepth" => "dot products that replace the depth",
                _ => "bidirectional reflectance lookups",
            };
            reader.not_built(reader.span(raw), what);
            return None;
        }
    })
}

/// Reads the fields in parentheses behind an operation. Without parentheses, all fields are absent.
fn fields<'a, T: source::FromSource<'a> + Default>(reader: &mut Reader<'a>, rest: &'a str) -> Option<T> {
    if rest.is_empty() { Some(T::default()) } else { reader.read(&Raw::new(rest)) }
}

fn cull<'a>(reader: &mut Reader<'a>, rest: &'a str) -> Option<ShaderOperation> {
    let fields = fields::<source::CullFragment<'a>>(reader, rest)?;
    let signs = [fields.s(reader)?, fields.t(reader)?, fields.r(reader)?, fields.q(reader)?];
    let drops_not_negative = signs.map(|sign| sign == 1);
    Some(ShaderOperation::CullFragment { drops_not_negative })
}

fn bump<'a>(reader: &mut Reader<'a>, rest: &'a str, opening: &'a str) -> Option<ShaderOperation> {
    let fields = source::BumpEnvironment { opening, called: "operation", ..fields(reader, rest)? };
    let names = ["a bump environment matrix", "a luminance (scale and offset)"];
    let (matrix, luminance) = bump_numbers(reader, &fields, names)?;
    Some(ShaderOperation::BumpEnvironment { matrix, luminance })
}

/// Reads the matrix of a bump environment, and its luminance as scale and offset. The texts are what messages call the two.
pub(super) fn bump_numbers<'a>(
    reader: &mut Reader<'a>,
    fields: &source::BumpEnvironment<'a>,
    [matrix, luminance]: [&str; 2],
) -> Option<([f32; 4], Option<[f32; 2]>)> {
    let raw = fields.matrix(reader)?;
    let matrix = reader.numbers(&raw, matrix, 4..=4, [0.0; 4])?;
    let luminance = reader.perhaps(&fields.luminance, |reader, raw| reader.numbers(raw, luminance, 2..=2, [0.0; 4]))?;
    Some((matrix, luminance.map(|[scale, offset, ..]| [scale, offset])))
}

/// Checks the earlier unit that a stage reads: unit 0 for stage 1, unit 0 or 1 for stage 2, any of the three for stage 3.
fn previous(reader: &mut Reader<'_>, shader: &mut [ShaderStage; TEXTURE_UNITS], index: usize, places: &Places) {
    let ShaderStage { operation, previous, .. } = shader[index];
    let refuse = |reader: &mut Reader<'_>, place: &Span, message: String, help: &str| {
        reader.push(finding("NB0342", place.clone(), message, "has no meaning", help).rule("TSH-10"));
    };
    if let Some(place) = &places.previous {
        if !operation.reads_previous() {
            let message = format!("{} reads no earlier unit", operation.name());
            refuse(reader, place, message, "leave `previous` out");
            shader[index].previous = index.saturating_sub(1);
        } else if previous >= index {
            reader.push(legality::shader::later_unit(index, previous, Some(place.clone())));
            shader[index].previous = index.saturating_sub(1);
        }
    }
    if let Some(place) = &places.mapping
        && !operation.is_dot()
    {
        let message = format!("{} maps no colour to a vector", operation.name());
        refuse(reader, place, message, "leave `mapping` out; the dot products have it");
    }
}

/// Checks by TSH-10 which operation follows which. Returns whether the operation may stand at this stage.
fn order(reader: &mut Reader<'_>, shader: &[ShaderStage; TEXTURE_UNITS], index: usize, places: &Places) -> bool {
    reader.accept(legality::shader::order(shader, index, Some(places.stage.clone()), places.previous.clone()));
    ShaderStage::misplaced(shader, index).is_none()
}

/// Checks that the texture that a stage samples exists and is of a kind that fits.
fn texture(reader: &mut Reader<'_>, units: &Units, index: usize, places: &Places) {
    let operation = units.shader[index].operation;
    if !operation.samples() {
        return;
    }
    let Some(unit) = units.bound[index] else {
        if units.places[index].is_empty() {
            reader.push(legality::shader::unbound(index, Some(places.stage.clone())));
        }
        return;
    };
    let Some(texture) = reader.textures.list.get(unit.texture) else { return };
    if let Some(finding) = legality::shader::kind(&operation, texture.kind, Some(places.stage.clone())) {
        reader.push(finding.related(units.places[index].clone(), "the texture of its unit"));
    }
}
