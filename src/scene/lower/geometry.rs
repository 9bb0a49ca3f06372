//! Lowers the sources of vertices, and runs the vertex side on them.
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule")]

use std::rc::Rc;

use super::attribute::{Outputs, Source};
use super::vertex::VertexData;
use super::*;
use crate::mesh::Mesh;
use ninebit::vertex::fog::{self as vertex_fog, FogSource};
use ninebit::vertex::texgen::CoordinateSet;
use ninebit::vertex::{EyeVertex, ModelView, ObjectVertex, Rows, Viewer};

/// The vertices of a draw, as its source describes them.
pub(super) struct Geometry {
    pub(super) positions: Positions,
    pub(super) vertices: Vertices,
    pub(super) spans: VertexSpans,
    /// The mesh that the vertices are taken from, with its triangles.
    pub(super) mesh: Option<Arc<Mesh>>,
    /// The vertices before any transform, from which coordinates and fog are generated.
    pub(super) objects: Objects,
    pub(super) model_view: Rows,
    /// The vertex program that made the vertices.
    pub(super) program: Option<VertexProgram>,
}

/// The vertices that a source starts from.
pub(super) enum VertexOrigin {
    /// The vertices of a mesh, and the place of the mesh in the text.
    Mesh(Arc<Mesh>, Span),
    /// Vertices that are listed in the scene.
    Listed(Rc<VertexData>),
}

impl VertexOrigin {
    /// Reads whichever of the two is given. Returns `None` if that fails, with the reason recorded.
    pub(super) fn read<'a>(
        reader: &mut Reader<'a>,
        vertices: &Option<Raw<'a, source::VertexList>>,
        mesh: &Option<Raw<'a, source::MeshSource>>,
        opening: Span,
    ) -> Option<VertexOrigin> {
        let (code, message) = match (vertices, mesh) {
            (Some(raw), None) => return reader.value(raw).map(VertexOrigin::Listed),
            (None, Some(raw)) => return reader.value(raw).map(|mesh| VertexOrigin::Mesh(mesh, reader.span(raw))),
            (Some(_), Some(_)) => ("NB0222", "either `vertices` or `mesh`, not both"),
            (None, None) => ("NB0202", "this vertex source has neither `vertices` nor `mesh`"),
        };
        let help = "write `vertices: [...]` for listed vertices, or `mesh: Sphere(slices: 32, stacks: 16)`";
        reader.refuse(finding(code, opening, message, "in here", help))
    }

    pub(super) fn mesh(&self) -> Option<&Arc<Mesh>> {
        if let VertexOrigin::Mesh(mesh, _) = self { Some(mesh) } else { None }
    }

    /// Returns the number of vertices.
    pub(super) fn count(&self) -> usize {
        match self {
            VertexOrigin::Mesh(mesh, _) => mesh.positions.len(),
            VertexOrigin::Listed(data) => data.vertices.len(),
        }
    }

    /// Returns the places of the vertices in the text.
    pub(super) fn spans(&self) -> VertexSpans {
        match self {
            VertexOrigin::Mesh(_, place) => VertexSpans::All(place.clone()),
            VertexOrigin::Listed(data) => data.spans.clone(),
        }
    }
}

/// The vertices of a draw before any transform.
pub(super) enum Objects {
    /// The vertices of a mesh, and the number of components of each coordinate set.
    Mesh(Arc<Mesh>, [usize; 4]),
    /// Vertices that are listed in the scene.
    Listed(Rc<VertexData>),
    /// Vertices that a vertex program made. Their positions are the program's.
    Program {
        fog_coordinates: Vec<f32>,
        /// Sizes of points in 1/8 pixel, if the program writes them.
        point_sizes: Option<Vec<u16>>,
    },
}

impl Objects {
    /// Returns whether vertex `index` says itself what fog it passes on.
    fn pass_fog(&self, index: usize) -> bool {
        matches!(self, Objects::Listed(data) if data.extras[index].passes_fog)
    }

    /// Returns what the vertex side needs to know of vertex `index`.
    pub(super) fn at(&self, index: usize, vertex: &Vertex) -> ObjectVertex {
        match self {
            Objects::Mesh(mesh, dimensions) => {
                let [x, y, z] = mesh.positions[index];
                let normal = mesh.normals[index];
                ObjectVertex { position: [x, y, z, 1.0], normal, fog_coordinate: 0.0, dimensions: *dimensions }
            }
            Objects::Listed(data) => {
                let vertex::Extra { normal, fog_coordinate, dimensions, .. } = data.extras[index];
                ObjectVertex { position: data.vertices.position(index), normal, fog_coordinate, dimensions }
            }
            Objects::Program { fog_coordinates, .. } => ObjectVertex {
                position: vertex.position,
                normal: [0.0; 3],
                fog_coordinate: fog_coordinates[index],
                dimensions: [4; 4],
            },
        }
    }
}

impl Geometry {
    /// Rewrites coordinate sets: each takes s, t and r of the given set, and q = 1.
    pub(super) fn without_q(&mut self, sets: &[Option<usize>; 4]) {
        if sets.iter().all(Option::is_none) {
            return;
        }
        let made = self.vertices.iter().map(|mut vertex| {
            let given = vertex.texture_coordinates;
            for (set, from) in vertex.texture_coordinates.iter_mut().zip(sets) {
                if let Some([s, t, r, _]) = from.and_then(|from| given.get(from)) {
                    *set = [*s, *t, *r, 1.0];
                }
            }
            vertex
        });
        self.vertices = made.collect();
    }
}

/// Applies generated texture coordinates, texture matrices and fog to the vertices. Returns `false` if that fails, with a finding recorded.
pub(super) fn vertex_side(
    reader: &mut Reader<'_>,
    geometry: &mut Geometry,
    sets: &Option<[CoordinateSet; 4]>,
    fog: &fog::FogFields,
    viewer: Viewer,
    draw: &Span,
) -> bool {
    let spans = DrawSpans { draw: draw.clone(), vertices: geometry.spans.clone(), ..DrawSpans::default() };
    if fog.state.function.is_none()
        && geometry.program.as_ref().is_some_and(|program| program.writes_fog)
        && let Some(index) = geometry.vertices.iter().position(|vertex| vertex.fog.is_nan())
    {
        // Infinite factors are clamped. With a mode, FOG-4 and FOG-5 say what a NaN gives.
        let message = format!("oFog of vertex {index} is not a number");
        let label = "what the vertex program makes of it";
        let help = "look for 0 times infinity, rsq of 0, and differences of infinities";
        reader.push(finding("NB0207", spans.vertex(index), message, label, help).rule("VTX-3"));
        return false;
    }
    if sets.is_none() && fog.state.function.is_none() {
        return true;
    }
    if let Some(program) = &geometry.program
        && let Some(finding) = beside_program(program, sets.is_some(), fog, draw)
    {
        reader.push(finding);
        return false;
    }
    if let (Some(_), FogSource::Vertex, Some(_), None) =
        (&fog.state.function, fog.source, &geometry.mesh, &geometry.program)
    {
        let message = "the vertices of a mesh give no fog coordinates";
        let help =
            "add `coordinate_source: EyePlaneAbsolute` (or EyePlane, EyeRadial), and `model_view` to the vertices";
        reader.push(finding("NB0222", fog.place.clone(), message, "needs them from the vertices", help).rule("FOG-2"));
        return false;
    }
    let model_view = ModelView::new(&geometry.model_view);
    let made = geometry.vertices.iter().enumerate().map(|(index, mut vertex)| {
        let object = geometry.objects.at(index, &vertex);
        let eye = EyeVertex::new(&object, &model_view, viewer);
        if let Some(sets) = sets {
            let given = vertex.texture_coordinates;
            vertex.texture_coordinates = [0, 1, 2, 3].map(|set| sets[set].at(&eye, &given, reader.profile));
        }
        if let Some(function) = fog.state.function.as_ref().filter(|_| !geometry.objects.pass_fog(index)) {
            // The coordinate may be any float: FOG-4 and FOG-5 say what becomes of those that are not finite.
            let coordinate = vertex_fog::coordinate(fog.source, &eye, vertex.position);
            vertex.fog = vertex_fog::passed(function, reader.profile, coordinate);
            vertex.fog_coordinate = Some(coordinate);
        }
        if vertex.texture_coordinates.iter().flatten().all(|c| c.is_finite()) {
            return Some(vertex);
        }
        let message = format!("a texture coordinate of vertex {index} is not finite");
        let help = "use smaller numbers in the matrices, in the planes or in the position";
        reader.refuse(finding("NB0207", spans.vertex(index), message, "beyond all numbers", help).rule("TSH-11"))
    });
    let Some(made) = made.collect() else { return false };
    geometry.vertices = made;
    true
}

/// Finds state of the fixed vertex pipe beside a vertex program, which takes the place of that pipe.
fn beside_program(program: &VertexProgram, sets: bool, fog: &fog::FogFields, draw: &Span) -> Option<Diagnostic> {
    if sets {
        let message = "coordinates are generated or multiplied beside a vertex program";
        let help =
            "the program takes the place of `texgen` and `texture_matrices`: compute in it what goes to oT0 to oT3";
        return Some(finding("NB0389", draw.clone(), message, "in this draw", help).rule("VTX-3"));
    }
    fog.state.function.as_ref()?;
    let finding = |message: &str, label: &str, help: &str| {
        Some(finding("NB0389", fog.place.clone(), message, label, help).rule("VTX-3"))
    };
    if matches!(fog.source, FogSource::EyePlane | FogSource::EyePlaneAbsolute | FogSource::EyeRadial) {
        let help = "take `coordinate_source: Depth` or `W`, or leave it out and write the coordinate to oFog";
        return finding("behind a vertex program there is no eye space", "needs it for this fog", help);
    }
    if fog.source == FogSource::Vertex && !program.writes_fog {
        return finding(
            "fog with a mode reads the coordinate in oFog, which nothing writes",
            "needs the coordinate",
            "write it there: `mov oFog.x, r0.w`",
        );
    }
    None
}

const SOURCES: &[&str] = &["Window", "Matrix", "Program"];

pub(super) fn geometry<'a>(
    reader: &mut Reader<'a>,
    target: usize,
    raw: &Raw<'a, source::VertexSource>,
) -> Option<Geometry> {
    let (kind, rest) = reader.variant(raw, "vertex source", SOURCES)?;
    match kind {
        0 => {
            let list = Raw::<crate::raw::Tuple<'a, source::VertexList>>::new(rest);
            let parts = reader.read(&list)?.0;
            let [list] = parts[..] else {
                let message = "expected one list of vertices in these parentheses";
                let help = "write `Window([(position: (10, 20)), ...])`";
                return reader.refuse(finding("NB0211", reader.span(&list), message, "here", help));
            };
            let data = reader.value(&list)?;
            Some(Geometry {
                positions: Positions::Window,
                vertices: data.vertices.clone(),
                spans: data.spans.clone(),
                mesh: None,
                objects: Objects::Listed(data),
                model_view: matrix::IDENTITY,
                program: None,
            })
        }
        1 => matrix_geometry(reader, target, rest),
        _ => vertex_program::geometry(reader, target, rest),
    }
}

fn matrix_geometry<'a>(reader: &mut Reader<'a>, target: usize, text: &'a str) -> Option<Geometry> {
    let opening = reader.opening(text);
    let fields = reader.read(&Raw::<source::MatrixVertices<'a>>::new(text))?;
    let raw_matrix = fields.matrix(reader);
    let mut matrix = raw_matrix.and_then(|raw| reader.value(&raw));
    if let Some((raw, known)) = raw_matrix.zip(matrix.as_ref())
        && matrix::flattens(known)
    {
        let message = "this matrix takes all positions onto one line of the screen";
        let help = "look for a scale of 0, and for rows that are multiples of each other";
        reader.push(finding("NB0237", reader.span(&raw), message, "x, y and w depend on one another", help));
        matrix = None;
    }
    let model_view = fields.model_view.as_ref().map_or(Some(matrix::IDENTITY), |raw| reader.value(raw));
    let viewport = viewport(reader, &fields.viewport, target);
    let viewport = with_clip_depth(viewport, fields.clip_depth(reader));
    let listed = fields.vertices.as_ref().filter(|_| fields.mesh.is_none());
    let attributes = [&fields.diffuse, &fields.specular, &fields.t0, &fields.t1, &fields.t2, &fields.t3];
    if let (Some(_), Some(attribute)) = (listed, attributes.iter().find_map(|field| field.as_ref())) {
        let message = "listed vertices have no mesh attributes";
        let help = "write colours and texture coordinates in the vertices, or use `mesh: ...`";
        reader.push(finding("NB0222", reader.span(attribute), message, "needs a mesh", help));
    }
    // An unknown field may be one of the two, misspelt.
    if !fields.faults.is_empty() && fields.vertices.is_none() && fields.mesh.is_none() {
        return None;
    }
    let given = VertexOrigin::read(reader, &fields.vertices, &fields.mesh, opening.clone());
    let of_mesh = fields.mesh.is_some() && fields.vertices.is_none();
    let outputs = of_mesh.then(|| outputs(reader, &fields));
    let given = given?;
    let (mut vertices, objects) = match (&given, outputs) {
        (VertexOrigin::Mesh(mesh, _), Some(outputs)) => {
            (attribute::vertices(mesh, &outputs), Objects::Mesh(Arc::clone(mesh), outputs.dimensions()))
        }
        (VertexOrigin::Listed(data), _) => (data.vertices.clone(), Objects::Listed(Rc::clone(data))),
        (VertexOrigin::Mesh(..), None) => return None,
    };
    let (matrix, model_view) = (matrix?, model_view?);
    vertices.map_positions(|position| ninebit::vertex::transform(&matrix, position));
    let finite = |vertex: usize| vertices.position(vertex).iter().all(|value| value.is_finite());
    if let Some(bad) = (0..vertices.len()).find(|vertex| !finite(*vertex)) {
        let spans = DrawSpans { draw: opening, vertices: given.spans(), ..DrawSpans::default() };
        let message = format!("the matrix takes vertex {bad} beyond all numbers");
        let help = "use smaller numbers in the matrix or in the position";
        reader.push(finding("NB0207", spans.vertex(bad), message, "not finite after the matrix", help).rule("RAS-0"));
        return None;
    }
    Some(Geometry {
        positions: Positions::Clip(viewport),
        vertices,
        spans: given.spans(),
        mesh: given.mesh().cloned(),
        objects,
        model_view,
        program: None,
    })
}

fn outputs<'a>(reader: &mut Reader<'a>, fields: &source::MatrixVertices<'a>) -> Outputs {
    let mut color = |field: &Option<Raw<'a, source::Attribute>>, default| {
        let written = field.as_ref().and_then(|raw| attribute::source(reader, raw, true));
        written.unwrap_or(Source::Color(VertexColor::Bytes(default)))
    };
    let (diffuse, specular) = (color(&fields.diffuse, [255; 4]), color(&fields.specular, [0; 4]));
    let coordinates = [&fields.t0, &fields.t1, &fields.t2, &fields.t3].map(|field| {
        let written = field.as_ref().and_then(|raw| attribute::source(reader, raw, false));
        written.unwrap_or(Source::TextureCoordinates)
    });
    Outputs { diffuse, specular, coordinates }
}

/// Reads the viewport of a draw, which is the whole target by default.
pub(super) fn viewport<'a>(
    reader: &mut Reader<'a>,
    raw: &Option<Raw<'a, source::Viewport<'a>>>,
    target: usize,
) -> Viewport {
    let (width, height) = reader.targets.list.get(target).map_or((1, 1), |target| (target.width, target.height));
    let (width, height) = (width as f32, height as f32);
    let fields = raw.as_ref().and_then(|raw| reader.read(raw)).unwrap_or_default();
    let (x, y) = (fields.x(reader), fields.y(reader));
    let mut side = |field: &Option<Raw<'a, f32>>, whole: f32| {
        let Some((raw, value)) = field.as_ref().and_then(|raw| Some((raw, reader.finite(raw)?))) else { return whole };
        if value <= 0.0 {
            let message = "a viewport has a width and a height above 0";
            reader.push(Diagnostic::error("NB0206", reader.span(raw), message).label("out of range"));
        }
        value
    };
    let (width, height) = (side(&fields.width, width), side(&fields.height, height));
    let (near, far, depth_clamp) = (fields.near(reader), fields.far(reader), fields.depth_clamp(reader));
    Viewport { x, y, width, height, near, far, clip_depth: ClipDepth::MinusOneToOne, depth_clamp }
}

/// Returns the viewport of a clip space whose depths run from 0, if the word says so: it maps depth 0 to the middle between `near` and `far`, and
/// moving `near` back makes that middle the written `near`.
pub(super) fn with_clip_depth(viewport: Viewport, word: Option<usize>) -> Viewport {
    if word != Some(1) {
        return viewport;
    }
    Viewport { near: moved_back(viewport.near, viewport.far), clip_depth: ClipDepth::ZeroToOne, ..viewport }
}

/// Returns the end of the depths that has `near` in the middle between it and `far`.
pub(crate) fn moved_back(near: f32, far: f32) -> f32 {
    2.0 * near - far
}
