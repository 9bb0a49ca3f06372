//! Lowers the inputs of a vertex program: what its input registers hold.

use super::super::attribute::Source;
use super::*;
use ninebit::vertex::shader::INPUTS;

/// Source of an input register.
pub(super) enum Input {
    /// The program does not read the register.
    Unread,
    /// An attribute of a mesh, or a value for all vertices.
    Attribute(Source),
    /// A field of listed vertices.
    Field(Field),
}

/// A field of listed vertices.
#[derive(Clone, Copy)]
pub(super) enum Field {
    Position,
    Normal,
    Diffuse,
    Specular,
    FogCoordinate,
    Coordinates(usize),
}

/// Names of the fields; the first set of coordinates has two.
const FIELDS: &[(&str, Field)] = &[
    ("Position", Field::Position),
    ("Normal", Field::Normal),
    ("Diffuse", Field::Diffuse),
    ("Specular", Field::Specular),
    ("FogCoordinate", Field::FogCoordinate),
    ("TextureCoordinates", Field::Coordinates(0)),
    ("TextureCoordinates0", Field::Coordinates(0)),
    ("TextureCoordinates1", Field::Coordinates(1)),
    ("TextureCoordinates2", Field::Coordinates(2)),
    ("TextureCoordinates3", Field::Coordinates(3)),
];

/// Returns the default source of a register, which follows the numbers of Direct3D's fixed vertices.
fn usual(register: usize, mesh: bool) -> Option<Input> {
    let (source, field) = match (register, mesh) {
        (0, _) => (Some(Source::Position), Field::Position),
        (3, _) => (Some(Source::Normal), Field::Normal),
        (5, false) => (None, Field::Diffuse),
        (6, false) => (None, Field::Specular),
        (7, _) => (Some(Source::TextureCoordinates), Field::Coordinates(0)),
        _ => return None,
    };
    if mesh { source.map(Input::Attribute) } else { Some(Input::Field(field)) }
}

/// Reads the source of each register, and checks that every register that the program reads has one.
pub(super) fn sources<'a>(
    reader: &mut Reader<'a>,
    raw: &Option<Raw<'a, source::ShaderInputs<'a>>>,
    given: &VertexOrigin,
    (written, text): (&ShaderText, &ProgramText),
) -> Vec<Input> {
    let mut fields = [None; INPUTS];
    for (name, text) in raw.as_ref().and_then(|raw| reader.read(raw)).unwrap_or_default().written() {
        if let Some(field) = name[1..].parse().ok().and_then(|register: usize| fields.get_mut(register)) {
            *field = Some(Raw::new(text));
        }
    }
    let mesh = given.mesh().is_some();
    let mut inputs = Vec::with_capacity(INPUTS);
    for (register, (field, read)) in fields.iter().zip(written.inputs_read()).enumerate() {
        let chosen = field.as_ref().map(|raw| input(reader, raw, mesh));
        let input = match (chosen, read) {
            (Some(_), None) => {
                let place = field.as_ref().map_or(0..0, |raw| reader.span(raw));
                let message = format!("the input v{register} is not used");
                let help = "remove it, or check its number";
                reader.refuse(warning("NB0901", place, message, "the vertex program does not read it", help))
            }
            (Some(chosen), Some(_)) => chosen,
            (None, None) => None,
            (None, Some(place)) => {
                let usual = usual(register, mesh);
                if usual.is_none() {
                    let message = format!("nothing says what v{register} holds");
                    let example = if mesh { "Tangent" } else { "TextureCoordinates1" };
                    let help = format!("add it: `inputs: (v{register}: {example})`");
                    let note = "without being told, v0 is the position, v3 the normal, v7 the texture coordinates, of listed vertices v5 and v6 the colours";
                    reader.push(text.locate(finding("NB0387", place, message, "read here", help).note(note)));
                }
                usual
            }
        };
        inputs.push(input.unwrap_or(Input::Unread));
    }
    inputs
}

fn input<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Attribute>, mesh: bool) -> Option<Input> {
    let (head, rest) = raw.split();
    if mesh || head.is_empty() {
        return attribute::source(reader, raw, false).map(Input::Attribute);
    }
    if ["Tangent", "Binormal", "LightVector", "HalfVector"].contains(&head) {
        let message = format!("listed vertices have no {head}");
        let help = "use `mesh: Triangles(vertices: [...], indices: [...])`, which has tangents of its own";
        return reader.refuse(finding("NB0222", reader.span(raw), message, "needs a mesh", help));
    }
    match FIELDS.iter().find(|(word, _)| *word == head && rest.is_empty()) {
        Some((_, field)) => Some(Input::Field(*field)),
        None => {
            let words: Vec<&'static str> = FIELDS.iter().map(|(word, _)| *word).collect();
            reader.unknown_variant(raw, "vertex attribute", &words)
        }
    }
}

/// Returns the value of a register at a vertex.
pub(super) fn value(input: &Input, given: &VertexOrigin, index: usize) -> [f32; 4] {
    let (field, VertexData { vertices, extras, .. }) = match (input, given) {
        (Input::Attribute(source), VertexOrigin::Mesh(mesh, _)) => return attribute::evaluate(mesh, index, source),
        // Only a value for all vertices: other attributes need a mesh.
        (Input::Attribute(Source::Coordinates(values, _)), VertexOrigin::Listed(_)) => return *values,
        (Input::Field(field), VertexOrigin::Listed(data)) => (field, &**data),
        _ => return [0.0; 4],
    };
    match field {
        Field::Position => vertices.position(index),
        Field::Normal => {
            let [x, y, z] = extras[index].normal;
            [x, y, z, 1.0]
        }
        Field::Diffuse => color::floats(vertices.diffuse(index)),
        Field::Specular => color::floats(vertices.specular(index)),
        Field::FogCoordinate => [extras[index].fog_coordinate, 0.0, 0.0, 1.0],
        Field::Coordinates(set) => vertices.coordinates(index, *set),
    }
}
