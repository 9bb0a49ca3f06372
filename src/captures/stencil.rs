//! STN-1: the operations zero and replace, with and without stencil and depth test; stacks of operations, made visible by all functions.

use super::*;

fn target(stencil: u8) -> Target {
    let depth = DepthBuffer { format: DepthFormat::Z24S8, clear: 0xffff, clear_stencil: stencil };
    Target { depth: Some(depth), ..frame_buffer(0xff00_0000) }
}

fn color(r: f32, g: f32, b: f32) -> VertexColor {
    VertexColor::Floats([r, g, b, 1.0])
}

fn test(function: CompareFunction, reference: u8, pass: StencilOperation) -> StencilTest {
    let keep = StencilOperation::Keep;
    StencilTest { function, reference, mask: 255, write_mask: 255, fail: keep, depth_fail: keep, pass }
}

/// Returns a square around the centre. The programs draw it as two triangles, which cover the same pixels.
fn square(side: f32, color: VertexColor) -> Draw {
    let half = side / 2.0;
    rectangle([320.0 - half, 240.0 - half, 320.0 + half, 240.0 + half], color)
}

/// Adds the frames of Stencil.
pub(super) fn operations(frames: &mut Frames) {
    for (stencil_on, depth_on) in [(true, false), (false, true), (true, true), (false, false)] {
        for (operation, cleared, reference) in [(StencilOperation::Zero, 255, 0), (StencilOperation::Replace, 0, 1)] {
            let mut second = square(100.0, color(0.0, 0.0, 1.0));
            second.color_mask = [false; 4];
            second.stencil_test = stencil_on.then(|| test(CompareFunction::Always, reference, operation));
            second.depth_test = depth_on.then_some(DepthTest::new(CompareFunction::Always, false));
            let mut third = square(200.0, color(0.0, 1.0, 0.0));
            third.stencil_test = Some(test(CompareFunction::Equal, reference, StencilOperation::Keep));
            let name = format!(
                "Stencil_{}{}{}",
                operation.name().to_uppercase(),
                if stencil_on { "_ST" } else { "" },
                if depth_on { "_DT" } else { "" }
            );
            let draws = vec![square(200.0, color(1.0, 0.0, 0.0)), second, third];
            frames.both(&name, scene(vec![target(cleared)], vec![], draws));
        }
    }
}

/// Stencil reference value of Stencil_func.
const REFERENCE: u8 = 0x7f;

/// Adds the frames of Stencil_func.
pub(super) fn functions(frames: &mut Frames) {
    use StencilOperation::*;
    let upper: [&[StencilOperation]; 5] =
        [&[Zero], &[Replace, Decrement], &[Replace], &[Replace, Increment], &[Zero, Invert]];
    let lower: [&[StencilOperation]; 4] = [
        &[Zero, Decrement],
        &[Zero, DecrementSaturate],
        &[Zero, Invert, Increment],
        &[Zero, Invert, IncrementSaturate],
    ];
    let mut stacks = Vec::new();
    for (top, row) in [(44.0, &upper[..]), (286.0, &lower[..])] {
        let mut left = 125.0;
        for operations in row {
            let patch = |color| rectangle([left, top, left + 80.0, top + 80.0], color);
            let mut first = patch(color(0.0, 0.0, 1.0));
            first.color_mask = [true, true, true, false];
            first.stencil_test =
                Some(StencilTest { write_mask: REFERENCE, ..test(CompareFunction::Always, REFERENCE, Invert) });
            stacks.push(first);
            for operation in *operations {
                let mut next = patch(color(1.0, 1.0, 1.0));
                next.color_mask = [false; 4];
                next.stencil_test = Some(test(CompareFunction::Always, REFERENCE, *operation));
                stacks.push(next);
            }
            left += 81.0;
        }
    }
    let names = "Never Less Equal LessThanOrEqual Greater NotEqual GreaterThanOrEqual Always";
    for (name, function) in named(names) {
        let mut last = rectangle([120.0, 40.0, 530.0, 450.0], color(0.0, 0.75, 0.0));
        last.color_mask = [true, true, true, false];
        last.stencil_test = Some(test(function, REFERENCE, Keep));
        let draws = stacks.iter().cloned().chain([last]).collect();
        frames.both(name, scene(vec![target(0)], vec![], draws));
    }
}
