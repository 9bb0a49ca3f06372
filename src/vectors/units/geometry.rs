//! The vertex side: triangles of primitives, clipping, and instructions of vertex programs.

use std::sync::Arc;

use super::raster::TRIANGLES;
use super::{Column, Conditions, Kind, Reach, Unit, channels, float, named, put, sized};
use ninebit::raster::project;
use ninebit::raster::triangles::Triangles;
use ninebit::state::{ClipDepth, Profile, ProvokingVertex, Vertex, Viewport};
use ninebit::vertex::shader::{
    self, Destination, DestinationRegister, Instruction, Source, SourceRegister, VertexShader,
};

/// The vertices of one triangle of a primitive.
pub(super) struct PrimitiveSplit;

/// Returns the triangles of a row's primitive.
fn triangles(inputs: &[i64]) -> Triangles {
    let indices: Arc<[u32]> = (0..inputs[2] as u32).collect();
    Triangles::split(&indices, named(inputs[0]), named(inputs[1]))
}

impl Unit for PrimitiveSplit {
    known_as!(
        "primitive-split", &["RAS-4", "RAS-5"],
        "the vertices of one triangle of a primitive, in order, and the provoking vertex", Geometry;
        takes [
            Column::names("cfg.topology", TRIANGLES),
            Column::choice::<ProvokingVertex>("cfg.provoking_vertex"),
            ["in.vertices", "in.triangle"].map(|name| Column::unsigned(name, 6, 63)),
        ];
        gives [Column::results(["out.first", "out.second", "out.third", "out.provoking"], Kind::Unsigned(6))]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        inputs[3] < triangles(inputs).len() as i64
    }

    fn fit(&self, inputs: &mut [i64]) {
        inputs[3] %= (triangles(inputs).len() as i64).max(1);
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let found = triangles(inputs).at(inputs[3] as usize);
        put(results, found.vertices.into_iter().chain([found.provoking]));
    }
}

const AXES: [&str; 4] = ["x", "y", "z", "w"];

/// Returns columns of four floats for each name.
fn vectors<const N: usize>(names: [&str; N], float: impl Fn(&str) -> Column) -> Vec<Column> {
    names.iter().flat_map(|name| channels(name, AXES, &float)).collect()
}

/// Returns four columns of results that are floats.
fn vector() -> Vec<Column> {
    vectors(["out"], |name| Column::result(name, Kind::Hex(32)))
}

/// Returns the vector whose first number is that input.
fn vector_at(inputs: &[i64], first: usize) -> [f32; 4] {
    [0, 1, 2, 3].map(|axis| float(inputs[first + axis]))
}

/// A vertex of the polygon that clipping leaves of a triangle.
pub(super) struct ClippedTriangle;

/// Returns the polygon that is left of a row's triangle, and the planes that cut it.
fn clipped(inputs: &[i64]) -> (Vec<Vertex>, u32) {
    let (x, y, near, far) = (0.0, 0.0, 0.0, 1.0);
    let (clip_depth, depth_clamp) = (named(inputs[0]), inputs[1] != 0);
    let viewport = Viewport { x, y, width: 640.0, height: 480.0, near, far, clip_depth, depth_clamp };
    let triangle = [2, 6, 10].map(|first| Vertex { position: vector_at(inputs, first), ..Vertex::default() });
    let (polygon, planes) = project::clip(&triangle, &viewport);
    (polygon, planes.into())
}

impl Unit for ClippedTriangle {
    known_as!(
        "clipped-triangle", &["RAS-6", "RAS-7"],
        "one vertex of the polygon that 640 x 480 pixels leave of a triangle in clip space (floats), and the planes that cut it: bits of near, far, w, left, right, top, bottom", Geometry;
        takes [
            Column::choice::<ClipDepth>("cfg.clip_depth"),
            Column::flag("cfg.depth_clamp"),
            vectors(["in.v0", "in.v1", "in.v2"], |name| Column::float(name, true, 12)),
            Column::unsigned("in.vertex", 4, 9),
        ];
        gives [Column::result("mid.planes", Kind::Hex(7)), Column::result("out.vertices", Kind::Unsigned(4)), vector()]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        inputs[14] < clipped(inputs).0.len() as i64
    }

    fn fit(&self, inputs: &mut [i64]) {
        // Mostly in front of the viewer, and of a size that some planes cut.
        for corner in inputs[2..14].chunks_mut(4).filter(|corner| corner[0] & 3 != 0) {
            corner.iter_mut().for_each(|number| *number = sized(*number, (-3, 7)));
            corner[3] &= 0x7fff_ffff;
        }
        inputs[14] %= (clipped(inputs).0.len() as i64).max(1);
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let (polygon, planes) = clipped(inputs);
        (results[0], results[1]) = (planes.into(), polygon.len() as i64);
        let vertex = polygon.get(inputs[14] as usize).map(|vertex| vertex.position).unwrap_or_default();
        put(&mut results[2..], vertex.map(f32::to_bits));
    }
}

/// An instruction of vertex programs.
pub(super) struct VertexInstruction;

impl Unit for VertexInstruction {
    known_as!(
        "vertex-instruction", &["VTX-1", "VTX-2"],
        "the result of an instruction of a vertex program for its sources s, t, u (floats); a matrix has the rows t, u and zeros; NaN is 7fc00000";
        takes [
            Column::names("cfg.opcode", shader::Opcode::WORDS),
            vectors(["in.s", "in.t", "in.u"], |name| Column::word(name, 32)),
        ];
        gives [vector()]
    );

    fn fit(&self, inputs: &mut [i64]) {
        // Mostly of similar magnitudes.
        if inputs[1] & 7 != 0 {
            inputs[1..].iter_mut().for_each(|bits| *bits = sized(*bits, (-5, 10)));
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let opcode = shader::Opcode::ALL[inputs[0] as usize];
        let source = |n| Source { register: SourceRegister::Input(n), swizzle: [0, 1, 2, 3], negate: false };
        let instruction = Instruction {
            opcode,
            destination: Destination { register: DestinationRegister::Coordinates(0), mask: 15 },
            sources: (0..opcode.sources()).map(source).collect(),
        };
        let program = VertexShader { instructions: vec![instruction], ..VertexShader::default() };
        let mut registers = [[0.0; 4]; shader::INPUTS];
        for (register, first) in registers.iter_mut().zip([1, 5, 9]) {
            *register = vector_at(inputs, first);
        }
        let [result, ..] = shader::evaluate(&program, &[[0.0; 4]; shader::CONSTANTS], &registers).coordinates;
        // Which NaN it is depends on the machine.
        put(results, result.map(|number| if number.is_nan() { 0x7fc0_0000 } else { number.to_bits() }));
    }
}
