//! Lowers draws, in the order of the text.

use std::collections::HashMap;

use super::api_program::{Around, DrawProgram};
use super::geometry::{geometry, vertex_side};
use super::program::Program;
use super::*;
use crate::mesh::Mesh;

/// A lowered draw, with what the rest of the lowering needs of it.
pub(super) struct LoweredDraw {
    pub(super) draw: Draw,
    pub(super) spans: DrawSpans,
    /// The mesh that its vertices are taken from. It is kept only if the scene has a truth.
    pub(super) mesh: Option<Arc<Mesh>>,
    /// The field `truth`, if written: whether the draw takes part in the scene's truth, and the place of the field.
    pub(super) truth: Option<(bool, Span)>,
}

/// Reads the draws, with their places.
pub(super) fn draws<'a>(
    reader: &mut Reader<'a>,
    raw: &Option<Raw<'a, source::List<'a, source::Draw<'a>>>>,
    keeps_meshes: bool,
) -> Vec<LoweredDraw> {
    let list = raw.as_ref().and_then(|raw| reader.read(raw)).unwrap_or_default();
    if let Some(raw) = raw
        && list.len() > reader.limits.draws
    {
        let found = too_many("NB0604", reader.span(raw), list.len(), "draws", "draws", reader.limits.draws);
        reader.push(found.help("put several triangles into one draw; `ninebit limits` prints what is allowed"));
        return Vec::new();
    }
    let mut draws: Vec<LoweredDraw> = Vec::with_capacity(list.len());
    let mut seen: HashMap<String, Span> = HashMap::new();
    let mut written: Vec<bool> = reader.targets.list.iter().map(|target| target.contents.is_some()).collect();
    let mut budget = Budget { vertices: reader.limits.vertices, indices: reader.limits.indices, spent: false };
    for (index, raw) in list.iter().enumerate() {
        let Some(fields) = reader.read(raw) else { continue };
        let mut place = reader.opening(raw.text);
        let mut name = format!("draw {index}");
        if let Some(raw) = &fields.name
            && let Some(given) = reader.read(raw)
        {
            place = reader.span(raw);
            if let Some(first) = seen.get(&given) {
                reader.push(crate::wording::twice("draw", &given, place.clone(), first.clone()));
            }
            seen.insert(given.clone(), place.clone());
            name = given;
        }
        if let Some(mut draw) = draw(reader, &fields, (name, place), &mut budget, &written) {
            draw.mesh = draw.mesh.filter(|_| keeps_meshes);
            if let Some(flag) = written.get_mut(draw.draw.target) {
                *flag = true;
            }
            draws.push(draw);
        }
        if budget.spent {
            break;
        }
    }
    draws
}

/// Numbers of vertices and indices that the rest of the scene may have.
struct Budget {
    vertices: usize,
    indices: usize,
    spent: bool,
}

fn draw<'a>(
    reader: &mut Reader<'a>,
    fields: &source::Draw<'a>,
    (name, place): (String, Span),
    budget: &mut Budget,
    written: &[bool],
) -> Option<LoweredDraw> {
    let target = fields.target.as_ref().map_or(Some(0), |raw| target::find(reader, raw));
    if let Some(raw) = &fields.clear {
        return clear(reader, (fields, raw), (name, place), target?);
    }
    let truth = fields.truth.as_ref().and_then(|raw| Some((reader.read(raw)?, reader.span(raw))));
    let mut geometry = fields.vertices(reader).and_then(|raw| geometry(reader, target.unwrap_or(0), &raw));
    let sets = texgen::sets(reader, &fields.texgen, &fields.texture_matrices);
    let viewer = fields.viewer(reader);
    let fog = fog::fog(reader, &fields.fog);
    let mut units = unit::units(reader, &fields.textures);
    shader::shader(reader, &mut units, &fields.texture_shader);
    let program = fields.program.as_ref().map(|raw| reader.value(raw));
    let topology = fields.topology(reader);
    let mut around = Around {
        fog: fog.state.enabled,
        shader: fields.texture_shader.is_some(),
        generators: fields.texgen.is_some(),
        sets,
        without_q: [None; 4],
    };
    let program = program.flatten();
    if let Some(program) = program.as_deref() {
        asides(reader, fields, program);
    }
    let (lowered, reads) = match program.as_deref() {
        Some(program) => program.lower(reader, &units, &mut around),
        None => (DrawProgram::as_written(Combiners::default(), &units), Default::default()),
    };
    if let Some(made) = &mut geometry
        && !vertex_side(reader, made, &around.sets, &fog, viewer, &place)
    {
        geometry = None;
    }
    if let Some(made) = &mut geometry {
        made.without_q(&around.without_q);
    }
    let mut draw = Draw {
        name,
        target: target.unwrap_or(0),
        positions: geometry.as_ref().map_or(Positions::Window, |geometry| geometry.positions),
        topology,
        shade_model: fields.shade_model(reader),
        provoking_vertex: fields.provoking_vertex(reader),
        perspective: fields.perspective(reader),
        cull: fields.cull(reader),
        front_face: fields.front_face(reader),
        polygon_modes: PolygonModes {
            front: fields.front_polygon_mode(reader),
            back: fields.back_polygon_mode(reader),
        },
        polygon_stipple: stipple(reader, &fields.polygon_stipple),
        smooth_polygons: fields.smooth_polygons(reader),
        lines: lines(reader, fields),
        // Nine bits.
        point_size: fields.point_size(reader) as u16,
        point_rasterization: fields.point_rasterization(reader),
        point_sprite: sprite(reader, fields),
        convert_yuv: conversion(reader, fields),
        scissor: scissor(reader, target, fields),
        fog: fog.state,
        textures: units.bound,
        texture_shader: lowered.shader,
        combiners: lowered.combiners,
        program_origin: lowered.origins,
        ..Draw::default()
    };
    raster::operations(reader, fields, &mut draw);
    for (unit, read) in reads.iter().enumerate() {
        if let (Some(read), ShaderOperation::None) = (read, units.shader[unit].operation) {
            let message = format!("texture unit {unit} is read but has no texture");
            let help = "give the draw `textures: [...]` with an entry for this unit";
            let found = warning("NB0902", read.clone(), message, "gives black, opaque", help).rule("TEX-16");
            reader.push(found.related(place.clone(), "in this draw"));
        }
    }
    let bound = units.bound.iter().zip(&units.places).filter_map(|(unit, place)| Some((unit.as_ref()?, place)));
    for (unit, place) in bound {
        feedback(reader, reader.textures.list[unit.texture].image.target(), draw.target, place, written);
    }
    let geometry = geometry?;
    draw.point_sizes = point::sizes(reader, &fields.point_parameters, &geometry, draw.point_size);
    draw.vertices = geometry.vertices;
    draw.edge_flags = edge_flags(reader, &fields.hidden_edges, draw.vertices.len());
    draw.vertex_program = geometry.program;
    draw.indices = indices(reader, fields, geometry.mesh.as_deref(), draw.vertices.len(), topology)?;
    target?;
    budget.take(reader, &draw, &place)?;
    let spans = DrawSpans { draw: place, vertices: geometry.spans, units: units.places };
    Some(LoweredDraw { draw, spans, mesh: geometry.mesh, truth })
}

/// Reads a clear among the draws.
fn clear<'a>(
    reader: &mut Reader<'a>,
    (fields, raw): (&source::Draw<'a>, &Raw<'a, source::ClearDraw<'a>>),
    (name, place): (String, Span),
    target: usize,
) -> Option<LoweredDraw> {
    if let Some((name, text)) = fields.written().find(|(name, _)| !["name", "target", "clear"].contains(name)) {
        let message = format!("a clear has no `{name}`");
        let help =
            "write the clear and the draw as two entries of `draws`; only `name` and `target` stand beside `clear`";
        let found = finding("NB0225", reader.range(text), message, "belongs to a draw", help);
        reader.push(found.related(reader.span(raw), "the clear"));
    }
    let draw = raster::clear(reader, raw, target)?.draw(name, target);
    let spans = DrawSpans { draw: place.clone(), vertices: VertexSpans::All(place), ..DrawSpans::default() };
    Some(LoweredDraw { draw, spans, mesh: None, truth: None })
}

/// Reads the state of lines.
fn lines<'a>(reader: &mut Reader<'a>, fields: &source::Draw<'a>) -> Lines {
    // Nine bits.
    Lines { width: fields.line_width(reader) as u16, rasterization: fields.line_rasterization(reader) }
}

/// Reads whether points are sprites.
fn sprite<'a>(reader: &mut Reader<'a>, fields: &source::Draw<'a>) -> bool {
    let wanted = fields.point_sprite(reader);
    reader.needs_nv2a(&fields.point_sprite, wanted, "NB0325", ("a point sprite", "PNT-2"));
    wanted && reader.profile == Profile::Nv2a
}

/// Reads whether colours are converted from YUV.
fn conversion<'a>(reader: &mut Reader<'a>, fields: &source::Draw<'a>) -> bool {
    let wanted = fields.convert_yuv(reader);
    reader.needs_nv2a(&fields.convert_yuv, wanted, "NB0344", ("a conversion from YUV", "TEX-19"));
    wanted && reader.profile == Profile::Nv2a
}

/// Reads the pattern of filled triangles.
fn stipple<'a>(reader: &mut Reader<'a>, raw: &Option<Raw<'a, Vec<u32>>>) -> Option<PolygonStipple> {
    let raw = raw.as_ref()?;
    let words = reader.read(raw)?;
    let count = words.len();
    let Ok(words) = words.try_into() else {
        let message = format!("a stipple has 32 words, not {count}");
        let help = "write a word for each row, the last first: `0xff00ff00`";
        let found = finding("NB0211", reader.span(raw), message, format!("{count} here"), help);
        return reader.refuse(found.rule("STP-1"));
    };
    Some(PolygonStipple(words))
}

/// Reads the edge flags of a draw's vertices.
fn edge_flags<'a>(reader: &mut Reader<'a>, raw: &Option<Raw<'a, Vec<u32>>>, count: usize) -> Option<Arc<[bool]>> {
    let raw = raw.as_ref()?;
    let mut flags = vec![true; count];
    for vertex in reader.read(raw)? {
        let Some(flag) = flags.get_mut(vertex as usize) else {
            let message = format!("vertex {vertex} does not exist");
            let help = "vertices count from 0";
            let found = finding("NB0212", reader.span(raw), message, format!("this draw has {count} vertices"), help);
            return reader.refuse(found.rule("POL-1"));
        };
        *flag = false;
    }
    Some(flags.into())
}

fn scissor<'a>(reader: &mut Reader<'a>, target: Option<usize>, fields: &source::Draw<'a>) -> Option<Rectangle> {
    let (raw, target) = (fields.scissor.as_ref()?, reader.targets.list.get(target?)?.clone());
    raster::clip(reader, &target, "scissor", raw)
}

/// Warns of states in a program's text that the draw does not have. Each is reported once, though several draws may share the program.
fn asides(reader: &mut Reader<'_>, fields: &source::Draw<'_>, program: &Program) {
    for (finding, field) in &program.asides {
        let said = fields.written().any(|(name, _)| name == *field);
        if !said && !reader.diagnostics.contains(finding) {
            reader.push(finding.clone());
        }
    }
}

impl Budget {
    fn take(&mut self, reader: &mut Reader<'_>, draw: &Draw, place: &Span) -> Option<()> {
        let vertices = self.vertices.checked_sub(draw.vertices.len());
        let indices = self.indices.checked_sub(draw.indices.len());
        let (Some(vertices), Some(indices)) = (vertices, indices) else {
            self.spent = true;
            if vertices.is_none() {
                let (most, count) = (reader.limits.vertices, draw.vertices.len());
                reader.push(vertex::too_many(place.clone(), most - self.vertices + count, most));
            } else {
                let message = format!("more than {} indices in a scene", reader.limits.indices);
                let help = "`ninebit limits` prints what is allowed";
                reader.push(finding("NB0609", place.clone(), message, "too many from here", help));
            }
            return None;
        };
        (self.vertices, self.indices) = (vertices, indices);
        Some(())
    }
}

/// Refuses a draw that samples its own target, and warns of one that samples a target nothing was drawn into.
fn feedback(reader: &mut Reader<'_>, sampled: Option<usize>, target: usize, place: &Span, written: &[bool]) {
    let Some(sampled) = sampled else { return };
    let name = reader.targets.list.get(sampled).map_or("", |target| target.name.as_str());
    if sampled == target {
        let message = format!("this draw samples its own target \"{}\"", shorten(name));
        let help = "draw into another target and sample that one";
        reader.push(finding("NB0217", place.clone(), message, "shows the target that is drawn into", help));
    } else if !written.get(sampled).copied().unwrap_or(true) {
        let message = format!("no earlier draw draws into target \"{}\"", shorten(name));
        let help = "draws happen in the order of the text: put the one that fills this target first";
        reader.push(warning("NB0904", place.clone(), message, "shows only the clear colour", help));
    }
}

/// Returns the indices: those that are written, those of the mesh, or one for each vertex in order.
fn indices<'a>(
    reader: &mut Reader<'a>,
    fields: &source::Draw<'a>,
    mesh: Option<&Mesh>,
    vertices: usize,
    topology: Topology,
) -> Option<Arc<[u32]>> {
    if let Some(mesh) = mesh {
        let unwanted = reader.place(&fields.indices);
        let topology_raw = fields.topology.as_ref().filter(|_| topology != Topology::Triangles);
        let unwanted = unwanted.or_else(|| topology_raw.map(|raw| reader.span(raw)));
        if let Some(place) = unwanted {
            let help = "leave `indices` and `topology` out";
            reader.push(finding("NB0222", place, "a mesh brings its own triangles", "not with a mesh", help));
        }
        return Some(Arc::clone(&mesh.indices));
    }
    let Some(raw) = &fields.indices else {
        let count = u32::try_from(vertices).ok()?;
        fits(reader, fields, vertices, topology);
        return Some((0..count).collect());
    };
    let indices = reader.read(raw)?;
    if let Some(at) = indices.iter().position(|index| *index as usize >= vertices) {
        // The list is read again to find the place.
        let list = reader.read(&Raw::<source::List<'a, u32>>::new(raw.text));
        let place = list.and_then(|list| list.get(at).map(|raw| reader.span(raw)));
        let place = place.unwrap_or_else(|| reader.span(raw));
        let help = match vertices {
            0 => "add vertices first".to_owned(),
            n => format!("indices run from 0 to {}", n - 1),
        };
        let message = format!("index {} is past the vertices", indices[at]);
        return reader.refuse(finding("NB0212", place, message, format!("this draw has {vertices} vertices"), help));
    }
    fits(reader, fields, indices.len(), topology);
    Some(indices.into())
}

/// Checks that `count` indices make whole primitives.
fn fits<'a>(reader: &mut Reader<'a>, fields: &source::Draw<'a>, count: usize, topology: Topology) {
    let (fits, wanted) = match topology {
        Topology::Triangles => (count.is_multiple_of(3), "three for each"),
        Topology::Quads => (count.is_multiple_of(4), "four for each"),
        Topology::QuadStrip => (count == 0 || count >= 4 && count.is_multiple_of(2), "four, then two for each more"),
        Topology::TriangleStrip | Topology::TriangleFan | Topology::Polygon => {
            (count == 0 || count >= 3, "at least three")
        }
        Topology::Points => (true, "one for each"),
        Topology::Lines => (count.is_multiple_of(2), "two for each"),
        Topology::LineStrip | Topology::LineLoop => (count != 1, "at least two"),
    };
    if fits {
        return;
    }
    let place = match (&fields.indices, &fields.vertices) {
        (Some(raw), _) => reader.span(raw),
        (None, Some(raw)) => reader.span(raw),
        (None, None) => return,
    };
    let what = match (fields.indices.is_some(), count) {
        (true, 1) => "index does",
        (true, _) => "indices do",
        (false, 1) => "vertex does",
        (false, _) => "vertices do",
    };
    let message = format!("{count} {what} not make {}", topology.name());
    let help = "add what is missing, or choose another `topology`";
    reader.push(finding("NB0213", place, message, format!("{} needs {wanted}", topology.name()), help));
}
