//! Lowers lists of vertices.

use super::*;

/// Listed vertices with their places.
pub(crate) struct VertexData {
    pub(super) vertices: Vertices,
    /// For each vertex, what generated coordinates and fog need.
    pub(super) extras: Vec<Extra>,
    pub(super) spans: VertexSpans,
}

/// Attributes of a vertex that only the vertex side reads.
#[derive(Clone, Copy)]
pub(super) struct Extra {
    pub(super) normal: [f32; 3],
    pub(super) fog_coordinate: f32,
    /// Number of written components of each coordinate set; 4 for a set that is not written.
    pub(super) dimensions: [usize; 4],
    /// Whether the vertex says itself what fog it passes on.
    pub(super) passes_fog: bool,
    /// Size of the vertex's point in 1/8 pixel, if it has its own.
    pub(super) point_size: Option<u16>,
}

impl Default for Extra {
    fn default() -> Self {
        Extra { normal: [0.0; 3], fog_coordinate: 0.0, dimensions: [4; 4], passes_fog: false, point_size: None }
    }
}

/// Reads a list of vertices. A vertex with errors stays in the list, so that indices can be checked.
pub(super) fn list<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::VertexList>) -> Option<VertexData> {
    if let ("Raw", file) = raw.split() {
        return vertex_file::vertices(reader, raw, file);
    }
    let list = reader.read(&raw.as_other::<source::List<'a, source::Vertex<'a>>>())?;
    if list.len() > reader.limits.vertices {
        return reader.refuse(too_many(reader.span(raw), list.len(), reader.limits.vertices));
    }
    let mut vertices = Vec::with_capacity(list.len());
    let mut extras = Vec::with_capacity(list.len());
    let mut spans = Vec::with_capacity(list.len());
    for raw in &list {
        let (vertex, extra) = vertex(reader, raw).unwrap_or_default();
        vertices.push(vertex);
        extras.push(extra);
        spans.push(reader.span(raw));
    }
    Some(VertexData { vertices: vertices.into(), extras, spans: VertexSpans::Each(spans) })
}

/// Makes the finding that the scene has more vertices than the limit.
pub(super) fn too_many(place: Span, count: usize, limit: usize) -> Diagnostic {
    let message = format!("{count} vertices are more than the {limit} that a scene may have");
    let help = "use indices to share vertices, or split the scene; `ninebit limits` prints what is allowed";
    finding("NB0603", place, message, "too many", help)
}

fn vertex<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Vertex<'a>>) -> Option<(Vertex, Extra)> {
    let fields = source::Vertex { opening: raw.text, ..reader.read(raw)? };
    let mut vertex = Vertex::default();
    if let Some(position) = fields.position(reader)
        && let Some(values) = reader.numbers(&position, "a position", 2..=4, vertex.position)
    {
        vertex.position = values;
    }
    (vertex.diffuse, vertex.specular) = (fields.diffuse(reader), fields.specular(reader));
    vertex.fog = fields.fog(reader);
    let fog_coordinate = fields.fog_coordinate(reader);
    let [x, y, z, _] = fields.normal(reader);
    // Nine bits.
    let point_size = fields.point_size(reader).map(|size| size as u16);
    let mut extra = Extra { normal: [x, y, z], fog_coordinate, point_size, ..Extra::default() };
    if let Some(fog) = fields.passed_fog.as_ref().and_then(|raw| reader.read(raw)) {
        (vertex.fog, extra.passes_fog) = (fog, true);
    }
    for (set, field) in [&fields.t0, &fields.t1, &fields.t2, &fields.t3].into_iter().enumerate() {
        if let Some(raw) = field
            && let Some((values, written)) = coordinates(reader, raw)
        {
            vertex.texture_coordinates[set] = values;
            extra.dimensions[set] = written;
        }
    }
    Some((vertex, extra))
}

/// Reads one to four texture coordinates s, t, r, q. Also returns how many are written.
pub(super) fn coordinates<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, Numbers>) -> Option<([f32; 4], usize)> {
    reader.numbers_written(raw, "a set of texture coordinates", 1..=4, [0.0, 0.0, 0.0, 1.0])
}
