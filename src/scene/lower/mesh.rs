//! Meshes: generated, listed, from files.

use std::sync::Arc;

use super::names::Names;
use super::program_text::ProgramText;
use super::*;
use crate::mesh::{self, Mesh, MeshError, Surface};

const KINDS: &[&str] = &["Grid", "Sphere", "Torus", "Cylinder", "Triangles", "Wavefront"];

/// A mesh from its description.
pub(super) fn mesh<'a>(
    reader: &mut Reader<'a>,
    names: &Names<'a>,
    raw: &Raw<'a, source::MeshSource>,
) -> Option<Arc<Mesh>> {
    let (kind, rest) = reader.variant(raw, "mesh", KINDS)?;
    let made = match KINDS[kind] {
        "Grid" => grid(reader, rest),
        "Sphere" => sphere(reader, rest),
        "Torus" => torus(reader, rest),
        "Cylinder" => cylinder(reader, rest),
        "Triangles" => Ok(triangles(reader, names, rest)),
        _ => return wavefront(reader, names, rest),
    };
    match made {
        Ok(mesh) => {
            let mesh = mesh?;
            if mesh.positions.len() <= reader.limits.vertices {
                return Some(Arc::new(mesh));
            }
            let place = reader.span(raw);
            reader.push(vertex::too_many(place, mesh.positions.len(), reader.limits.vertices));
        }
        Err(error) => {
            let code = if matches!(error, MeshError::TooFine { .. }) { "NB0603" } else { "NB0206" };
            let place = reader.span(raw);
            reader.push(Diagnostic::error(code, place, error.to_string()).label("this mesh"));
        }
    }
    None
}

/// A mesh, or `None` once the reason that it cannot be read has been recorded; or why there is no such shape.
type Made = Result<Option<Mesh>, MeshError>;

/// The two numbers of a pair.
fn pair([a, b, ..]: [f32; 4]) -> [f32; 2] {
    [a, b]
}

fn grid<'a>(reader: &mut Reader<'a>, text: &'a str) -> Made {
    let Some(fields) = reader.read(&Raw::<source::Grid<'a>>::new(text)) else { return Ok(None) };
    let (columns, rows) = (fields.columns(reader), fields.rows(reader));
    let (size, repeat) = (pair(fields.size(reader)), pair(fields.repeat(reader)));
    let (Some(columns), Some(rows)) = (columns, rows) else { return Ok(None) };
    mesh::grid(columns, rows, size, repeat).map(Some)
}

fn sphere<'a>(reader: &mut Reader<'a>, text: &'a str) -> Made {
    let Some(fields) = reader.read(&Raw::<source::Sphere<'a>>::new(text)) else { return Ok(None) };
    let (slices, stacks) = (fields.slices(reader), fields.stacks(reader));
    let (radius, repeat) = (fields.radius(reader), pair(fields.repeat(reader)));
    let (Some(slices), Some(stacks)) = (slices, stacks) else { return Ok(None) };
    mesh::sphere(slices, stacks, radius, repeat).map(Some)
}

fn torus<'a>(reader: &mut Reader<'a>, text: &'a str) -> Made {
    let Some(fields) = reader.read(&Raw::<source::Torus<'a>>::new(text)) else { return Ok(None) };
    let (slices, sides) = (fields.slices(reader), fields.sides(reader));
    let (radius, tube, repeat) = (fields.radius(reader), fields.tube(reader), pair(fields.repeat(reader)));
    let (Some(slices), Some(sides)) = (slices, sides) else { return Ok(None) };
    mesh::torus(slices, sides, radius, tube, repeat).map(Some)
}

fn cylinder<'a>(reader: &mut Reader<'a>, text: &'a str) -> Made {
    let Some(fields) = reader.read(&Raw::<source::Cylinder<'a>>::new(text)) else { return Ok(None) };
    let (slices, stacks) = (fields.slices(reader), fields.stacks(reader));
    let (radius, height) = (fields.radius(reader), fields.height(reader));
    let (caps, repeat) = (fields.caps(reader), pair(fields.repeat(reader)));
    let (Some(slices), Some(stacks)) = (slices, stacks) else { return Ok(None) };
    mesh::cylinder(slices, stacks, radius, height, caps, repeat).map(Some)
}

/// Listed vertices as a mesh: position, normal (if it is not zero) and the first coordinate set.
fn triangles<'a>(reader: &mut Reader<'a>, names: &Names<'a>, text: &'a str) -> Option<Mesh> {
    let fields = reader.read(&Raw::<source::Triangles<'a>>::new(text))?;
    let vertices = fields.vertices(reader);
    let data = vertices.and_then(|raw| names.vertices(reader, &raw));
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
    Some(mesh::mesh(&surface))
}

/// A file is read once, however many draws name it.
fn wavefront<'a>(reader: &mut Reader<'a>, names: &Names<'a>, text: &'a str) -> Option<Arc<Mesh>> {
    let fields = source::ProgramFile { called: "mesh", ..reader.read(&Raw::new(text))? };
    let raw = fields.file(reader)?;
    let name = reader.read(&raw)?;
    if let Some(known) = names.mesh_files.borrow().get(&name) {
        return known.clone();
    }
    let file = ProgramText::file_up_to(reader, names, &raw, reader.limits.mesh_file());
    let mesh = file.and_then(|file| {
        let surface = mesh::wavefront(&file.text, reader.limits.vertices, reader.limits.indices);
        Some(Arc::new(mesh::mesh(&file.parsed(reader, surface)?)))
    });
    names.mesh_files.borrow_mut().insert(name, mesh.clone());
    mesh
}
