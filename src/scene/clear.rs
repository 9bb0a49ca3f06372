//! Clears among the draws of a scene, which state has as draws.

use std::sync::Arc;

use ninebit::state::*;

/// A rectangle of one colour, depth and stencil that passes every test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clear {
    /// Where.
    pub area: Rectangle,
    /// What the colours become; `None` if they stay.
    pub color: Option<[u8; 4]>,
    /// Which channels of them, if there is a colour.
    pub color_mask: [bool; 4],
    /// What the depths become, with its unit; `None` if they stay.
    pub depth: Option<(VertexDepths, f32)>,
    /// What the stencils become; `None` if they stay.
    pub stencil: Option<u8>,
}

impl Clear {
    /// Returns the clear as a draw.
    pub fn draw(&self, name: String, target: usize) -> Draw {
        let mut draw = Draw { name, target, ..Draw::default() };
        draw.color_mask = if self.color.is_some() { self.color_mask } else { [false; 4] };
        draw.depth_test = self
            .depth
            .map(|(vertex_depths, _)| DepthTest { vertex_depths, ..DepthTest::new(CompareFunction::Always, true) });
        draw.stencil_test = self.stencil.map(|reference| StencilTest {
            function: CompareFunction::Always,
            reference,
            mask: 255,
            write_mask: 255,
            fail: StencilOperation::Keep,
            depth_fail: StencilOperation::Keep,
            pass: StencilOperation::Replace,
        });
        let (color, z) = (self.color.unwrap_or_default(), self.depth.map_or(0.0, |(_, depth)| depth));
        let Rectangle { x, y, width, height } = self.area;
        let (columns, rows) = ([x, x.saturating_add(width)], [y, y.saturating_add(height)]);
        for (x, y) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            // Coordinates are at most 2^17, so they are exact.
            let position = [columns[x] as f32, rows[y] as f32, z, 1.0];
            draw.vertices.push(Vertex { position, diffuse: VertexColor::Bytes(color), ..Vertex::default() });
        }
        (draw.topology, draw.indices) = (Topology::Quads, Arc::new([0, 1, 2, 3]));
        draw
    }

    /// Returns the clear that a draw is, if it is one.
    pub(crate) fn from_draw(draw: &Draw) -> Option<Clear> {
        if draw.vertices.len() != 4 {
            return None;
        }
        let [first, last] = [0, 2].map(|corner| draw.vertices.position(corner));
        let VertexColor::Bytes(color) = draw.vertices.diffuse(0) else { return None };
        // Numbers that are not whole are cut, and the draw then differs.
        let [left, top, right, bottom] = [first[0], first[1], last[0], last[1]].map(|side| side as u32);
        let area = Rectangle { x: left, y: top, width: right.checked_sub(left)?, height: bottom.checked_sub(top)? };
        let clear = Clear {
            area,
            color: (draw.color_mask != [false; 4] || color != [0; 4]).then_some(color),
            color_mask: draw.color_mask,
            depth: draw.depth_test.map(|test| (test.vertex_depths, first[2])),
            stencil: draw.stencil_test.map(|test| test.reference),
        };
        (clear.draw(draw.name.clone(), draw.target) == *draw).then_some(clear)
    }
}
