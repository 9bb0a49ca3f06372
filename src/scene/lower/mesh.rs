//! Lowers meshes: generated, listed, or from files.

use super::program_text::ProgramText;
use super::*;
use crate::mesh::{self, Mesh, MeshError, Surface};

const KINDS: &[&str] = &["Grid", "Box", "Sphere", "Torus", "Cylinder", "Triangles", "Wavefront"];

/// Reads a mesh from its description.
pub(super) fn mesh<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::MeshSource>) -> Option<Arc<Mesh>> {
    let (kind, rest) = reader.variant(raw, "mesh", KINDS)?;
    let mesh = match KINDS[kind] {
        "Grid" => {
            let fields = reader.read(&Raw::<source::Grid<'a>>::new(rest))?;
            let (columns, rows) = (fields.columns(reader), fields.rows(reader));
            let (size, repeat) = (pair(fields.size(reader)), pair(fields.repeat(reader)));
            mesh::grid(columns?, rows?, size, repeat)
        }
        "Box" => {
            let fields = reader.read(&Raw::<source::Cuboid<'a>>::new(rest))?;
            let [width, height, depth, _] = fields.size(reader);
            Ok(mesh::cuboid([width, height, depth], pair(fields.repeat(reader))))
        }
        "Sphere" => {
            let fields = reader.read(&Raw::<source::Sphere<'a>>::new(rest))?;
            let (slices, stacks) = (fields.slices(reader), fields.stacks(reader));
            let (radius, repeat) = (fields.radius(reader), pair(fields.repeat(reader)));
            mesh::sphere(slices?, stacks?, radius, repeat)
        }
        "Torus" => {
            let fields = reader.read(&Raw::<source::Torus<'a>>::new(rest))?;
            let (slices, sides) = (fields.slices(reader), fields.sides(reader));
            let (radius, tube, repeat) = (fields.radius(reader), fields.tube(reader), pair(fields.repeat(reader)));
            mesh::torus(slices?, sides?, radius, tube, repeat)
        }
        "Cylinder" => {
            let fields = reader.read(&Raw::<source::Cylinder<'a>>::new(rest))?;
            let (slices, stacks) = (fields.slices(reader), fields.stacks(reader));
            let (radius, height, caps) = (fields.radius(reader), fields.height(reader), fields.caps(reader));
            mesh::cylinder(slices?, stacks?, radius, height, caps, pair(fields.repeat(reader)))
        }
        "Triangles" => Ok(triangles(reader, rest)?),
        _ => return wavefront(reader, rest),
    };
    let (place, most) = (reader.span(raw), reader.limits.vertices);
    match mesh {
        Ok(mesh) if mesh.positions.len() <= most => Some(Arc::new(mesh)),
        Ok(mesh) => reader.refuse(vertex::too_many(place, mesh.positions.len(), most)),
        Err(error) => {
            let code = if matches!(error, MeshError::TooFine { .. }) { "NB0603" } else { "NB0206" };
            reader.refuse(Diagnostic::error(code, place, error.to_string()).label("this mesh"))
        }
    }
}

/// Returns the first two of four numbers.
fn pair([a, b, ..]: [f32; 4]) -> [f32; 2] {
    [a, b]
}

/// Makes a mesh of listed vertices: positions, normals that are not zero, and the first coordinate set.
fn triangles<'a>(reader: &mut Reader<'a>, text: &'a str) -> Option<Mesh> {
    let fields = reader.read(&Raw::<source::Triangles<'a>>::new(text))?;
    let vertices = fields.vertices(reader);
    let data = vertices.and_then(|raw| reader.value(&raw));
    let indices = fields.indices.as_ref().map(|raw| (reader.span(raw), reader.read(raw)));
    let data = data?;
    let count = data.vertices.len();
    let (place, indices) = match indices {
        Some((place, indices)) => (place, indices?),
        None => (reader.range(text), (0..u32::try_from(count).ok()?).collect()),
    };
    if !indices.len().is_multiple_of(3) {
        let message = format!("{} indices do not make triangles", indices.len());
        return reader.refuse(finding("NB0213", place, message, "three for each", "add what is missing"));
    }
    if let Some(index) = indices.iter().find(|index| **index as usize >= count) {
        let message = format!("index {index} is past the vertices");
        reader.push(Diagnostic::error("NB0212", place, message).label(format!("this mesh has {count} vertices")));
        return None;
    }
    let surface = Surface {
        positions: (0..count)
            .map(|vertex| {
                let [x, y, z, _] = data.vertices.position(vertex);
                [x, y, z]
            })
            .collect(),
        normals: data.extras.iter().map(|extra| extra.normal).collect(),
        texture_coordinates: (0..count)
            .map(|vertex| {
                let [s, t, _, _] = data.vertices.coordinates(vertex, 0);
                [s, t]
            })
            .collect(),
        indices,
    };
    mesh::mesh(&surface)
}

/// Reads a mesh from a file; a file is read once, however many draws name it.
fn wavefront<'a>(reader: &mut Reader<'a>, text: &'a str) -> Option<Arc<Mesh>> {
    let fields = source::ProgramFile { called: "mesh", ..reader.read(&Raw::new(text))? };
    let raw = fields.file(reader)?;
    let name = reader.read(&raw)?;
    if let Some(known) = reader.names.mesh_files.get(&name) {
        return known.clone();
    }
    let file = ProgramText::file_up_to(reader, &raw, reader.limits.mesh_file());
    let mesh = file.and_then(|file| {
        let surface = mesh::wavefront(&file.text, reader.limits.vertices, reader.limits.indices);
        mesh::mesh(&file.parsed(reader, surface)?).map(Arc::new)
    });
    reader.names.mesh_files.insert(name, mesh.clone());
    mesh
}
