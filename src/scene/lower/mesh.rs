//! Meshes: generated, listed, from files.

use std::sync::Arc;

use super::names::Names;
use super::program_text::ProgramText;
use super::*;
use crate::mesh::{self, Mesh, MeshError, Surface};
use crate::raw::Numbers;

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

fn count<'a>(
    reader: &mut Reader<'a>,
    field: &Option<Raw<'a, u32>>,
    name: &str,
    owner: &str,
    text: &'a str,
) -> Option<u32> {
    let opening = reader.range(text.get(..1).unwrap_or(text));
    reader.required(field, name, owner, opening).and_then(|raw| reader.read(&raw))
}

fn pair<'a>(
    reader: &mut Reader<'a>,
    field: &Option<Raw<'a, Numbers>>,
    name: &str,
    default: [f32; 2],
) -> Option<[f32; 2]> {
    match field {
        Some(raw) => reader.numbers(raw, name, 2, 2, [0.0; 4]).map(|[a, b, ..]| [a, b]),
        None => Some(default),
    }
}

fn length<'a>(reader: &mut Reader<'a>, field: &Option<Raw<'a, f32>>, default: f32) -> Option<f32> {
    match field {
        Some(raw) => reader.finite(raw),
        None => Some(default),
    }
}

fn repeat<'a>(reader: &mut Reader<'a>, field: &Option<Raw<'a, Numbers>>) -> Option<[f32; 2]> {
    pair(reader, field, "the repeat of a texture", [1.0, 1.0])
}

fn grid<'a>(reader: &mut Reader<'a>, text: &'a str) -> Made {
    let Some(fields) = reader.read(&Raw::<source::Grid<'a>>::new(text)) else { return Ok(None) };
    let columns = count(reader, &fields.columns, "columns", "grid", text);
    let rows = count(reader, &fields.rows, "rows", "grid", text);
    let size = pair(reader, &fields.size, "the size of a grid", [2.0, 2.0]);
    let repeat = repeat(reader, &fields.repeat);
    let (Some(columns), Some(rows), Some(size), Some(repeat)) = (columns, rows, size, repeat) else { return Ok(None) };
    mesh::grid(columns, rows, size, repeat).map(Some)
}

fn sphere<'a>(reader: &mut Reader<'a>, text: &'a str) -> Made {
    let Some(fields) = reader.read(&Raw::<source::Sphere<'a>>::new(text)) else { return Ok(None) };
    let slices = count(reader, &fields.slices, "slices", "sphere", text);
    let stacks = count(reader, &fields.stacks, "stacks", "sphere", text);
    let radius = length(reader, &fields.radius, 1.0);
    let repeat = repeat(reader, &fields.repeat);
    let (Some(slices), Some(stacks), Some(radius), Some(repeat)) = (slices, stacks, radius, repeat) else {
        return Ok(None);
    };
    mesh::sphere(slices, stacks, radius, repeat).map(Some)
}

fn torus<'a>(reader: &mut Reader<'a>, text: &'a str) -> Made {
    let Some(fields) = reader.read(&Raw::<source::Torus<'a>>::new(text)) else { return Ok(None) };
    let slices = count(reader, &fields.slices, "slices", "torus", text);
    let sides = count(reader, &fields.sides, "sides", "torus", text);
    let radius = length(reader, &fields.radius, 1.0);
    let tube = length(reader, &fields.tube, 0.375);
    let repeat = repeat(reader, &fields.repeat);
    let (Some(slices), Some(sides), Some(repeat)) = (slices, sides, repeat) else { return Ok(None) };
    let (Some(radius), Some(tube)) = (radius, tube) else { return Ok(None) };
    mesh::torus(slices, sides, radius, tube, repeat).map(Some)
}

fn cylinder<'a>(reader: &mut Reader<'a>, text: &'a str) -> Made {
    let Some(fields) = reader.read(&Raw::<source::Cylinder<'a>>::new(text)) else { return Ok(None) };
    let slices = count(reader, &fields.slices, "slices", "cylinder", text);
    let stacks = count(reader, &fields.stacks, "stacks", "cylinder", text);
    let radius = length(reader, &fields.radius, 1.0);
    let height = length(reader, &fields.height, 2.0);
    let caps = reader.or(&fields.caps, true);
    let repeat = repeat(reader, &fields.repeat);
    let (Some(slices), Some(stacks), Some(repeat)) = (slices, stacks, repeat) else { return Ok(None) };
    let (Some(radius), Some(height)) = (radius, height) else { return Ok(None) };
    mesh::cylinder(slices, stacks, radius, height, caps, repeat).map(Some)
}

/// Listed vertices as a mesh: position, normal (if it is not zero) and the first coordinate set.
fn triangles<'a>(reader: &mut Reader<'a>, names: &Names<'a>, text: &'a str) -> Option<Mesh> {
    let fields = reader.read(&Raw::<source::Triangles<'a>>::new(text))?;
    let opening = reader.range(text.get(..1).unwrap_or(text));
    let vertices = reader.required(&fields.vertices, "vertices", "mesh", opening);
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
        reader.push(Diagnostic::error("NB0213", place, message).label("three for each").help("add what is missing"));
        return None;
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
    let opening = reader.range(text.get(..1).unwrap_or(text));
    let fields = reader.read(&Raw::<source::ProgramFile<'a>>::new(text))?;
    let raw = reader.required(&fields.file, "file", "mesh", opening)?;
    let name = reader.read(&raw)?;
    if let Some(known) = names.mesh_files.borrow().get(&name) {
        return known.clone();
    }
    let file = ProgramText::file_up_to(reader, names, &raw, reader.limits.mesh_file());
    let mesh = file.and_then(|file| match mesh::wavefront(&file.text, reader.limits.vertices, reader.limits.indices) {
        Ok(surface) => Some(Arc::new(mesh::mesh(&surface))),
        Err(findings) => {
            findings.into_iter().for_each(|finding| reader.push(file.place(finding)));
            None
        }
    });
    names.mesh_files.borrow_mut().insert(name, mesh.clone());
    mesh
}
