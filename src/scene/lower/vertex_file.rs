//! Lowers `Raw(...)` as a list of vertices: a file of 32-bit words.

use super::texture_source::read_file;
use super::vertex::{Extra, VertexData, too_many};
use super::*;
use crate::vertex_column::VertexColumn;

/// Reads the vertices of a file; `text` is what follows the word `Raw`. Returns `None` after recording what is wrong.
pub(super) fn vertices<'a>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, source::VertexList>,
    text: &'a str,
) -> Option<VertexData> {
    let inside = Raw::<source::RawVertices<'a>>::new(text);
    let fields = reader.read(&inside)?;
    let (file, listed) = (fields.file(reader), fields.columns(reader));
    let (file, listed) = (file?, listed?);
    let names = reader.read(&listed)?;
    let mut columns: Vec<VertexColumn> = Vec::with_capacity(names.len());
    for raw in &names {
        let column = reader.name(raw)?;
        if columns.contains(&column) {
            let message = format!("`{}` is given twice", column.name());
            return reader.refuse(finding("NB0203", reader.span(raw), message, "again here", "keep one of them"));
        }
        columns.push(column);
    }
    let size: usize = columns.iter().map(|column| 4 * column.words()).sum();
    if size == 0 {
        let help = "write `columns: [Position, DiffuseBytes]`, for example";
        return reader.refuse(finding("NB0211", reader.span(&listed), "a vertex has no column", "empty", help));
    }
    let bytes = read_file(reader, &file, reader.limits.image_file(), |bytes, _| Ok(bytes.to_vec()))?;
    let (place, count) = (reader.span(&file), bytes.len() / size);
    if !bytes.len().is_multiple_of(size) {
        let message = format!("the file has {} bytes, and each vertex takes {size}", bytes.len());
        return reader.refuse(finding("NB0235", place, message, "another length", "check `columns`"));
    }
    if count > reader.limits.vertices {
        return reader.refuse(too_many(place, count, reader.limits.vertices));
    }
    let (mut vertices, mut extras) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for (index, bytes) in bytes.chunks_exact(size).enumerate() {
        let (mut vertex, mut extra) = (Vertex::default(), Extra::default());
        let mut words = bytes.as_chunks().0;
        for column in &columns {
            let (own, rest) = words.split_at(column.words());
            words = rest;
            if let Err(Wrong { code, what }) = put(*column, own, &mut vertex, &mut extra) {
                let message = format!("`{}` of vertex {index} in the file {what}", column.name());
                let help = "check `columns`, and the program that wrote the file";
                return reader.refuse(finding(code, place, message, "in this file", help));
            }
        }
        vertices.push(vertex);
        extras.push(extra);
    }
    Some(VertexData { vertices: vertices.into(), extras, spans: VertexSpans::All(reader.span(raw)) })
}

/// What is wrong with a value.
struct Wrong {
    code: &'static str,
    what: &'static str,
}

/// Puts the words of a column into a vertex. There are as many as the column has.
fn put(column: VertexColumn, words: &[[u8; 4]], vertex: &mut Vertex, extra: &mut Extra) -> Result<(), Wrong> {
    let mut four = [0.0; 4];
    for (value, word) in four.iter_mut().zip(words) {
        *value = f32::from_le_bytes(*word);
    }
    let bytes = words.first().copied().unwrap_or_default();
    let size = u32::from_le_bytes(bytes);
    let whole = matches!(column, VertexColumn::DiffuseBytes | VertexColumn::SpecularBytes | VertexColumn::PointSize);
    let any = matches!(column, VertexColumn::FogCoordinate | VertexColumn::PassedFog);
    if !whole && !any && four.iter().any(|value| !value.is_finite()) {
        return Err(Wrong { code: "NB0207", what: "is not finite" });
    }
    match column {
        VertexColumn::Position => vertex.position = four,
        VertexColumn::Diffuse => vertex.diffuse = VertexColor::Floats(four),
        VertexColumn::DiffuseBytes => vertex.diffuse = VertexColor::Bytes(bytes),
        VertexColumn::Specular => vertex.specular = VertexColor::Floats(four),
        VertexColumn::SpecularBytes => vertex.specular = VertexColor::Bytes(bytes),
        VertexColumn::Fog if !(0.0..=1.0).contains(&four[0]) => {
            return Err(Wrong { code: "NB0206", what: "is not 0 (all fog) to 1 (no fog)" });
        }
        VertexColumn::Fog => vertex.fog = four[0],
        VertexColumn::FogCoordinate => extra.fog_coordinate = four[0],
        VertexColumn::PassedFog => (vertex.fog, extra.passes_fog) = (four[0], true),
        VertexColumn::PointSize if size > u32::from(LARGEST_SIZE) => {
            return Err(Wrong { code: "NB0206", what: "has more than nine bits" });
        }
        // Nine bits.
        VertexColumn::PointSize => extra.point_size = Some(size as u16),
        VertexColumn::T0 => vertex.texture_coordinates[0] = four,
        VertexColumn::T1 => vertex.texture_coordinates[1] = four,
        VertexColumn::T2 => vertex.texture_coordinates[2] = four,
        VertexColumn::T3 => vertex.texture_coordinates[3] = four,
    }
    Ok(())
}
