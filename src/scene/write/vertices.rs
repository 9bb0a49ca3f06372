//! Writes vertices: those of small draws as text, those of others as a file.

use super::draw::written_function;
use super::files::Files;
use super::node::{Fields, Node};
use crate::lower::moved_back;
use crate::vertex_column::VertexColumn;
use ninebit::state::*;
use ninebit::vertex::fog::passed;

/// Largest number of vertices of a draw that are written as text.
const LISTED_VERTICES: usize = 256;

/// What a vertex passes on as its fog, and how a scene says it.
#[derive(Clone, Copy)]
enum FogValue {
    /// A factor, 0 to 1.
    Factor(f32),
    /// The coordinate that the function of the draw makes it of.
    Coordinate(f32),
    /// What neither of these can say.
    Passed(f32),
}

/// Returns the list of a draw's vertices.
pub(super) fn list(draw: &Draw, profile: Profile, files: &mut Files) -> Result<Node, String> {
    let sizes = draw.point_sizes.as_deref();
    if let Some(sizes) = sizes.filter(|sizes| sizes.len() != draw.vertices.len()) {
        return Err(format!("it has {} sizes of points for {} vertices", sizes.len(), draw.vertices.len()));
    }
    // The function that a reader makes of what is written.
    let function = draw.fog.function.map(|function| written_function(&function, profile));
    let fog: Vec<FogValue> =
        draw.vertices.iter().map(|vertex| fog_value(&vertex, function.as_ref(), profile)).collect();
    for (index, vertex) in draw.vertices.iter().enumerate() {
        finite(&vertex).map_err(|what| format!("{what} of vertex {index} is not finite"))?;
    }
    // A file has one kind of colours.
    let mixed = |of: fn(&Vertices, usize) -> VertexColor| {
        let floats = (0..draw.vertices.len()).map(|index| matches!(of(&draw.vertices, index), VertexColor::Floats(_)));
        floats.clone().any(|float| float) && floats.clone().any(|float| !float)
    };
    if draw.vertices.len() <= LISTED_VERTICES || mixed(Vertices::diffuse) || mixed(Vertices::specular) {
        let sizes = (0..draw.vertices.len()).map(|index| sizes.map(|sizes| sizes[index]));
        let vertices = draw.vertices.iter().zip(fog).zip(sizes);
        return Ok(Node::rows(vertices.map(|((vertex, fog), size)| listed(&vertex, fog, size))));
    }
    let columns = columns(draw, &fog);
    let mut bytes = Vec::new();
    for (index, vertex) in draw.vertices.iter().enumerate() {
        for column in &columns {
            put(*column, &vertex, fog[index], sizes.map_or(0, |sizes| sizes[index]), &mut bytes);
        }
    }
    let mut source = Fields::new("Raw");
    source.put("file", Node::text(&files.add("vertices", &draw.name, bytes)));
    source.put("columns", Node::list(columns.iter().map(|column| Node::word(column.name()))));
    Ok(source.into())
}

/// Returns the source of a draw's vertices, whose list is given.
pub(super) fn source(draw: &Draw, target: &Target, list: Node) -> Result<Node, String> {
    let Positions::Clip(viewport) = &draw.positions else { return Ok(Node::call("Window", [list])) };
    let mut fields = Fields::new("Matrix");
    fields.put("matrix", Node::word("Identity"));
    fields.put_some("viewport", self::viewport(viewport, target)?);
    fields.word("clip_depth", viewport.clip_depth, ClipDepth::MinusOneToOne);
    fields.put("vertices", list);
    Ok(fields.into())
}

fn viewport(port: &Viewport, target: &Target) -> Result<Fields, String> {
    let near = match port.clip_depth {
        ClipDepth::MinusOneToOne => port.near,
        ClipDepth::ZeroToOne => moved_forth(port.near, port.far)
            .ok_or_else(|| format!("its viewport's depths, {} to {}, are none of a scene", port.near, port.far))?,
    };
    for (name, depth) in [("near", near), ("far", port.far)] {
        if !(0.0..=1.0).contains(&depth) {
            return Err(format!("its viewport's `{name}` is {depth}; a scene has 0 to 1"));
        }
    }
    let sides = [port.x, port.y, port.width, port.height];
    if !sides.iter().all(|side| side.is_finite()) || port.width <= 0.0 || port.height <= 0.0 {
        let [x, y, width, height] = sides;
        return Err(format!("its viewport is {width} x {height} pixels at {x},{y}"));
    }
    let mut fields = Fields::new("");
    fields.number("x", port.x, 0.0);
    fields.number("y", port.y, 0.0);
    // At most 2^12, so they are exact.
    fields.number("width", port.width, target.width as f32);
    fields.number("height", port.height, target.height as f32);
    fields.number("near", near, 0.0);
    fields.number("far", port.far, 1.0);
    fields.flag("depth_clamp", port.depth_clamp, false);
    Ok(fields)
}

/// Returns the depth that [`moved_back`] takes to `near`, if there is one.
fn moved_forth(near: f32, far: f32) -> Option<f32> {
    #[allow(clippy::float_arithmetic, reason = "undoes what the reader does in floats")]
    let middle = 0.5 * (near + far);
    let beside = [middle, middle.next_up(), middle.next_down()];
    beside.into_iter().find(|depth| moved_back(*depth, far).to_bits() == near.to_bits())
}

fn fog_value(vertex: &Vertex, function: Option<&FogFunction>, profile: Profile) -> FogValue {
    let Some(function) = function else {
        let is_factor = (0.0..=1.0).contains(&vertex.fog);
        return if is_factor { FogValue::Factor(vertex.fog) } else { FogValue::Passed(vertex.fog) };
    };
    match vertex.fog_coordinate {
        Some(d) if passed(function, profile, d).to_bits() == vertex.fog.to_bits() => FogValue::Coordinate(d),
        _ => FogValue::Passed(vertex.fog),
    }
}

/// Checks that the numbers of a vertex are finite.
///
/// # Errors
/// Some are not: the name of the attribute.
fn finite(vertex: &Vertex) -> Result<(), &'static str> {
    let all = |numbers: &[f32]| numbers.iter().all(|number| number.is_finite());
    let color = |color: &VertexColor| match color {
        VertexColor::Bytes(_) => true,
        VertexColor::Floats(floats) => all(floats),
    };
    let attributes = [
        ("the position", all(&vertex.position)),
        ("the primary colour", color(&vertex.diffuse)),
        ("the secondary colour", color(&vertex.specular)),
        ("a coordinate", all(vertex.texture_coordinates.as_flattened())),
    ];
    attributes.into_iter().find(|(_, finite)| !finite).map_or(Ok(()), |(name, _)| Err(name))
}

fn listed(vertex: &Vertex, fog: FogValue, size: Option<u16>) -> Node {
    let default = Vertex::default();
    let mut fields = Fields::new("");
    fields.put("position", written(&vertex.position, &default.position, 2));
    for (name, color, default) in
        [("diffuse", &vertex.diffuse, &default.diffuse), ("specular", &vertex.specular, &default.specular)]
    {
        match color {
            VertexColor::Bytes(_) if color == default => {}
            VertexColor::Bytes(bytes) => fields.put(name, Node::color(*bytes)),
            VertexColor::Floats(floats) => fields.put(name, Node::call("Float", floats.map(Node::number))),
        }
    }
    match fog {
        FogValue::Factor(factor) => fields.number("fog", factor, default.fog),
        FogValue::Coordinate(coordinate) => fields.number("fog_coordinate", coordinate, 0.0),
        FogValue::Passed(passed) => fields.put("passed_fog", Node::number(passed)),
    }
    if let Some(size) = size {
        fields.put("point_size", Node::whole(size));
    }
    for (name, (set, default)) in
        ["t0", "t1", "t2", "t3"].into_iter().zip(vertex.texture_coordinates.iter().zip(&default.texture_coordinates))
    {
        if set.map(f32::to_bits) != default.map(f32::to_bits) {
            fields.put(name, written(set, default, 1));
        }
    }
    fields.into()
}

/// Returns numbers without those at the end that are their defaults, but at least so many.
fn written(values: &[f32; 4], default: &[f32; 4], least: usize) -> Node {
    let differs = |n: &usize| values[*n].to_bits() != default[*n].to_bits();
    let count = (0..4).rev().find(differs).map_or(least, |last| least.max(last + 1));
    Node::numbers(&values[..count])
}

/// Returns the columns of a file of the draw's vertices: those in which some vertex differs from the default.
fn columns(draw: &Draw, fog: &[FogValue]) -> Vec<VertexColumn> {
    let default = Vertex::default();
    let mut columns = vec![VertexColumn::Position];
    for (of, default, bytes, floats) in [
        (
            Vertices::diffuse as fn(&Vertices, usize) -> VertexColor,
            default.diffuse,
            VertexColumn::DiffuseBytes,
            VertexColumn::Diffuse,
        ),
        (Vertices::specular, default.specular, VertexColumn::SpecularBytes, VertexColumn::Specular),
    ] {
        let mut colors = (0..draw.vertices.len()).map(|index| of(&draw.vertices, index));
        if colors.clone().any(|color| matches!(color, VertexColor::Floats(_))) {
            columns.push(floats);
        } else if colors.any(|color| color != default) {
            columns.push(bytes);
        }
    }
    if fog.iter().all(|fog| matches!(fog, FogValue::Factor(_))) {
        let differs = |fog: &FogValue| matches!(fog, FogValue::Factor(factor) if *factor != default.fog);
        columns.extend(fog.iter().any(differs).then_some(VertexColumn::Fog));
    } else if fog.iter().all(|fog| matches!(fog, FogValue::Coordinate(_))) {
        columns.push(VertexColumn::FogCoordinate);
    } else {
        columns.push(VertexColumn::PassedFog);
    }
    columns.extend(draw.point_sizes.is_some().then_some(VertexColumn::PointSize));
    let sets = [VertexColumn::T0, VertexColumn::T1, VertexColumn::T2, VertexColumn::T3];
    for (set, column) in sets.into_iter().enumerate() {
        let bits = |of: [f32; 4]| of.map(f32::to_bits);
        let plain = bits(default.texture_coordinates[set]);
        if (0..draw.vertices.len()).any(|index| bits(draw.vertices.coordinates(index, set)) != plain) {
            columns.push(column);
        }
    }
    columns
}

/// Appends the words of a colour.
fn color(color: VertexColor, bytes: &mut Vec<u8>) {
    match color {
        VertexColor::Bytes(four) => bytes.extend(four),
        VertexColor::Floats(floats) => bytes.extend(floats.iter().flat_map(|value| value.to_le_bytes())),
    }
}

/// Appends the words of a column.
fn put(column: VertexColumn, vertex: &Vertex, fog: FogValue, size: u16, bytes: &mut Vec<u8>) {
    let (FogValue::Factor(own) | FogValue::Coordinate(own) | FogValue::Passed(own)) = fog;
    let mut floats = |values: &[f32]| bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    match column {
        VertexColumn::Position => floats(&vertex.position),
        VertexColumn::Diffuse | VertexColumn::DiffuseBytes => color(vertex.diffuse, bytes),
        VertexColumn::Specular | VertexColumn::SpecularBytes => color(vertex.specular, bytes),
        VertexColumn::Fog | VertexColumn::FogCoordinate => floats(&[own]),
        VertexColumn::PassedFog => floats(&[vertex.fog]),
        VertexColumn::T0 => floats(&vertex.texture_coordinates[0]),
        VertexColumn::T1 => floats(&vertex.texture_coordinates[1]),
        VertexColumn::T2 => floats(&vertex.texture_coordinates[2]),
        VertexColumn::T3 => floats(&vertex.texture_coordinates[3]),
        VertexColumn::PointSize => bytes.extend(u32::from(size).to_le_bytes()),
    }
}
