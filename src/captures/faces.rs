//! RAS-6: windings and culls, filled and as lines; w at its limits.

use super::*;

/// The w of the limits: a large number in place of infinity, another, and a small one.
fn limits(infinity: f32) -> [f32; 6] {
    [infinity, 0.980_578, 1.0 / infinity, infinity, infinity, infinity]
}

const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
const GREEN: [f32; 4] = [0.0, 1.0, 0.0, 1.0];
const BLUE: [f32; 4] = [0.0, 0.0, 1.0, 1.0];
const GREY: [f32; 4] = [0.5, 0.5, 0.5, 1.0];

/// Returns two quads and two triangles without area, as triangles: the left ones counterclockwise, with the given w, the right ones clockwise.
fn triangles(w: [f32; 6]) -> Vec<Vertex> {
    let (top, bottom) = (44.0, 430.0);
    let at = |[x, y]: [f32; 2], color: [f32; 4], w: f32| Vertex {
        position: [x, y, 0.0, w],
        diffuse: VertexColor::Floats(color),
        ..Vertex::default()
    };
    let [ul, ur, lr, ll] = corners([138.0, top, 310.0, bottom]);
    let left = [(ul, RED), (lr, BLUE), (ur, GREY), (ul, RED), (ll, GREEN), (lr, BLUE)];
    let mut vertices: Vec<Vertex> = left.into_iter().zip(w).map(|((p, color), w)| at(p, color, w)).collect();
    let [ul, ur, lr, ll] = corners([330.0, top, 502.0, bottom]);
    let right = [(ul, BLUE), (ur, GREEN), (lr, RED), (ul, BLUE), (lr, RED), (ll, GREY)];
    vertices.extend(right.into_iter().map(|(p, color)| at(p, color, 1.0)));
    let thin = |x: f32, corners: [(f32, [f32; 4]); 3]| corners.map(|(y, color)| at([x, y], color, 1.0));
    vertices.extend(thin(133.0, [(top, RED), (237.0, BLUE), (bottom, GREEN)]));
    vertices.extend(thin(507.0, [(top, BLUE), (bottom, GREY), (237.0, RED)]));
    vertices
}

/// Adds the frames of Front_face. Values that the chip does not know leave the winding before them.
pub(super) fn frames(frames: &mut Frames) {
    for (mode, w, polygon_modes) in [
        ("", [1.0; 6], PolygonModes::FILL),
        ("FM_", limits(extreme_w::MOST), PolygonModes::FILL),
        // The model's limit for lines.
        ("LM_", limits(1_048_576.0), WIREFRAME),
    ] {
        for (winding, front_face) in [
            ("CW", FrontFace::Clockwise),
            ("CCW", FrontFace::CounterClockwise),
            ("0x00", FrontFace::Clockwise),
            ("0x63", FrontFace::Clockwise),
        ] {
            for (name, cull) in [("F", Some(Cull::Front)), ("B", Some(Cull::Back)), ("FaB", None)] {
                let mut canvas = Canvas::new(0xff00_0000);
                if let Some(cull) = cull {
                    let shape = draw(Topology::Triangles, triangles(w));
                    canvas.draw(Draw { cull, front_face, polygon_modes, ..shape });
                }
                frames.push(format!("FrontFace_{mode}{winding}_CF_{name}"), canvas.colors());
            }
        }
    }
}
