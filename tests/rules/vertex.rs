//! Computes the examples of vertex programs and tangent bases.

use crate::handbook::{beside_rows, example};
use ninebit::limits::Limits;
use ninebit::number::convert::vertex_color;
use ninebit::state::VertexColor;
use ninebit::vertex::shader::{Constants, Inputs, evaluate, exponential, logarithm};
use ninebit::vertex::unit;
use ninebit_program::vertex_shader::read;
use ninebit_scene::mesh::{Surface, mesh};
use ninebit_scene::parse;
use std::path::Path;

/// Returns oT0 after an instruction that writes it, with the given v0 and constants from c0 on.
fn result(instruction: &str, v0: [f32; 4], constants: &[[f32; 4]]) -> [f32; 4] {
    let written = read(&format!("{instruction}\nmov oPos, v0")).unwrap();
    let mut inputs: Inputs = [[0.0; 4]; 16];
    inputs[0] = v0;
    let mut registers: Constants = [[0.0; 4]; 96];
    registers[..constants.len()].copy_from_slice(constants);
    evaluate(&written.shader, &registers, &inputs).coordinates[0]
}

#[test]
fn examples_of_vertex_programs() {
    let vtx1 = beside_rows("VTX-1");
    let v = [1.0, 2.0, 3.0, 0.0];
    vtx1.gives("rsq of 0 times 0", result("rsq r0, v0.x\nmul oT0, r0, v0", [0.0; 4], &[]), [0.0; 4]);
    let rows = [[0.0, 1.0, 0.0, 9.0], [0.0, 0.0, 1.0, 9.0], [1.0, 0.0, 0.0, 9.0]];
    vtx1.gives("m3x3", result("m3x3 oT0, v0, c0", v, &rows), [2.0, 3.0, 1.0, 1.0]);

    let vtx2 = beside_rows("VTX-2");
    vtx2.shows("2^0.5", exponential(0.5).into(), 7, "1.4142135").shows(
        "log2 10",
        logarithm(10.0).into(),
        7,
        "3.3219280",
    );
    vtx2.gives("the smallest number above 0", f32::from_bits(1), exponential(-149.0));
    vtx2.shows("log2 12", logarithm(-12.0).into(), 7, "3.5849626");

    let vtx3 = beside_rows("VTX-3");
    let text = "(version: 1, profile: Nv2a, draws: [(vertices: Program(vertices: [(position: (0, 0)), (position: (1, 0)), \
                (position: (0, 1))], constants: { c0: (0.5, 2, -1) }, text: \"mov oPos, v0 \\n mov oD0.xyz, c0\"))])";
    let vertex = parse(text, Path::new(""), &Limits::default()).unwrap().scene.draws[0].vertices.at(0);
    let VertexColor::Floats(primary) = vertex.diffuse else { panic!("{vertex:?}") };
    vtx3.gives("primary", primary.map(vertex_color), [128, 255, 0, 255]);
    vtx3.gives("secondary", vertex.specular, VertexColor::Bytes([0; 4]));

    let vtx4 = example(
        "VTX-4",
        "corners (0, 0, 0), (2, 0, 0), (0, 1, 0) with (s, t) = (0, 1), (1, 1), (0, 0): d = -1, T = (1, 0, 0), binormal (0, 1, 0). \
         With s changed in sign d = 1, T = (-1, 0, 0), mirrored, binormal (0, 1, 0).",
    );
    let triangle = |sign: f32| {
        mesh(&Surface {
            positions: vec![[0.0; 3], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            normals: vec![[0.0; 3]; 3],
            texture_coordinates: vec![[0.0, 1.0], [sign, 1.0], [0.0, 0.0]],
            indices: vec![0, 1, 2],
        })
        .unwrap()
    };
    for (sign, tangent) in [(1.0, [1.0, 0.0, 0.0]), (-1.0, [-1.0, 0.0, 0.0])] {
        let [found, binormal, _] = triangle(sign).basis(1);
        vtx4.gives("T", found, tangent).gives("binormal", binormal, [0.0, 1.0, 0.0]);
    }

    let vtx5 = beside_rows("VTX-5");
    let (_, length) = unit::direction(unit::words([3.0, 0.0, -4.0]));
    vtx5.gives("length", f32::from_bits(length), 4.9999995);
}
