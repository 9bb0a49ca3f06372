//! Vertex attributes made of meshes.
#![allow(clippy::float_arithmetic, reason = "vertices are 32-bit floats; + - * / and roots in a fixed order")]

use super::matrix::{dot, normalize, subtract};
use super::*;
use crate::mesh::Mesh;

/// Source of one attribute of the vertices.
pub(super) enum Source {
    /// A colour for all vertices.
    Color(VertexColor),
    /// Coordinates for all vertices, and how many of the four are written.
    Coordinates([f32; 4], usize),
    Position,
    Normal,
    Tangent,
    Binormal,
    TextureCoordinates,
    /// The vector toward a light or, if there is a viewer, the half vector between both.
    Toward {
        light: Light,
        viewer: Option<[f32; 3]>,
        tangent_space: bool,
    },
}

/// Position of a light, or direction toward it, in object space.
#[derive(Clone, Copy)]
pub(super) enum Light {
    Position([f32; 3]),
    Direction([f32; 3]),
}

const SOURCES: &[&str] =
    &["Position", "Normal", "Tangent", "Binormal", "TextureCoordinates", "LightVector", "HalfVector"];

/// Reads the source of an attribute; `color` says whether the attribute is a colour.
pub(super) fn source<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Attribute>, color: bool) -> Option<Source> {
    let (head, _) = raw.split();
    if color && (raw.is_text() || matches!(head, "" | "Float" | "Vector")) {
        return reader.value(&raw.as_other::<source::Color>()).map(Source::Color);
    }
    if !color && (raw.text.starts_with('(') || raw.is_text()) {
        return vertex::coordinates(reader, &raw.as_other())
            .map(|(values, written)| Source::Coordinates(values, written));
    }
    let (kind, rest) = reader.variant_of(raw, "mesh attribute", SOURCES, 5)?;
    Some(match kind {
        0 => Source::Position,
        1 => Source::Normal,
        2 => Source::Tangent,
        3 => Source::Binormal,
        4 => Source::TextureCoordinates,
        5 => {
            let fields = reader.read(&Raw::<source::LightVector<'a>>::new(rest))?;
            let light = place(reader, rest, "light", &fields.position, &fields.direction);
            let tangent_space = fields.space(reader).map(|space| space == 0);
            Source::Toward { light: light?, viewer: None, tangent_space: tangent_space? }
        }
        _ => {
            let fields = reader.read(&Raw::<source::HalfVector<'a>>::new(rest))?;
            let light = place(reader, rest, "light", &fields.position, &fields.direction);
            let viewer = fields.viewer(reader).map(|[x, y, z, _]| [x, y, z]);
            let tangent_space = fields.space(reader).map(|space| space == 0);
            Source::Toward { light: light?, viewer: Some(viewer?), tangent_space: tangent_space? }
        }
    })
}

fn point<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, Numbers>, what: &str) -> Option<[f32; 3]> {
    reader.numbers(raw, what, 3..=3, [0.0; 4]).map(|[x, y, z, _]| [x, y, z])
}

/// Reads a position or a direction, of which exactly one has to be given. Returns `None` if that fails, with the reason recorded.
pub(super) fn place<'a>(
    reader: &mut Reader<'a>,
    text: &'a str,
    what: &str,
    position: &Option<Raw<'a, Numbers>>,
    direction: &Option<Raw<'a, Numbers>>,
) -> Option<Light> {
    match (position, direction) {
        (Some(raw), None) => point(reader, raw, &format!("a position of this {what}")).map(Light::Position),
        (None, Some(raw)) => point(reader, raw, &format!("a direction of this {what}")).map(Light::Direction),
        (both, _) => {
            let message = match both {
                Some(_) => format!("this {what} has a position and a direction; one of them is enough"),
                None => format!("this {what} has neither `position` nor `direction`"),
            };
            let help =
                "write `position: (x, y, z)` for one that is near, `direction: (x, y, z)` (toward it) for one far away";
            reader.refuse(finding("NB0202", reader.opening(text), message, "in here", help))
        }
    }
}

/// Sources of the vertices' attributes.
pub(super) struct Outputs {
    pub(super) diffuse: Source,
    pub(super) specular: Source,
    pub(super) coordinates: [Source; 4],
}

impl Outputs {
    /// Returns the number of components of each coordinate set: three for vectors of a mesh, two for texture coordinates.
    pub(super) fn dimensions(&self) -> [usize; 4] {
        [0, 1, 2, 3].map(|set| match &self.coordinates[set] {
            Source::Coordinates(_, written) => *written,
            Source::TextureCoordinates => 2,
            Source::Position | Source::Normal | Source::Tangent | Source::Binormal | Source::Toward { .. } => 3,
            Source::Color(_) => 4,
        })
    }
}

/// Makes the vertices of a mesh; positions are left in object space.
pub(super) fn vertices(mesh: &Mesh, outputs: &Outputs) -> Vertices {
    let vertex = |index: usize| {
        let [x, y, z] = mesh.positions[index];
        let color = |source: &Source| match source {
            Source::Color(color) => *color,
            source => {
                let [x, y, z, _] = evaluate(mesh, index, source);
                VertexColor::Floats([0.5 + 0.5 * x, 0.5 + 0.5 * y, 0.5 + 0.5 * z, 1.0])
            }
        };
        Vertex {
            position: [x, y, z, 1.0],
            diffuse: color(&outputs.diffuse),
            specular: color(&outputs.specular),
            fog: 1.0,
            fog_coordinate: None,
            texture_coordinates: [0, 1, 2, 3].map(|set| evaluate(mesh, index, &outputs.coordinates[set])),
        }
    };
    (0..mesh.positions.len()).map(vertex).collect()
}

/// Evaluates a source at a vertex of a mesh.
pub(super) fn evaluate(mesh: &Mesh, index: usize, source: &Source) -> [f32; 4] {
    let extend = |v: [f32; 3]| [v[0], v[1], v[2], 1.0];
    let position = mesh.positions[index];
    let toward = |light: &Light| match light {
        Light::Position(light) => normalize(subtract(*light, position)),
        Light::Direction(direction) => normalize(*direction),
    };
    match source {
        Source::Color(_) => [0.0, 0.0, 0.0, 1.0],
        Source::Coordinates(values, _) => *values,
        Source::Position => extend(position),
        Source::Normal => extend(mesh.normals[index]),
        Source::Tangent => extend(mesh.tangents[index]),
        Source::Binormal => extend(mesh.binormals[index]),
        Source::TextureCoordinates => {
            let [s, t] = mesh.texture_coordinates[index];
            [s, t, 0.0, 1.0]
        }
        Source::Toward { light, viewer, tangent_space } => {
            let light = toward(light);
            let vector = viewer.map_or(light, |viewer| {
                let viewer = normalize(subtract(viewer, position));
                normalize([light[0] + viewer[0], light[1] + viewer[1], light[2] + viewer[2]])
            });
            // A light exactly at the vertex has no direction: the vector is zero, not NaN.
            let vector = if vector.iter().all(|c| c.is_finite()) { vector } else { [0.0; 3] };
            extend(if *tangent_space { mesh.basis(index).map(|axis| dot(vector, axis)) } else { vector })
        }
    }
}
