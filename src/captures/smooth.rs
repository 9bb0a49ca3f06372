//! LIN-2, SMO-1, SMO-2: the shapes of 3D_primitive, smooth or not.

use super::*;

const BACKGROUND: u32 = 0xff30_3030;

/// The ways that vertices reach the chip, which change no pixel, and how often a frame's buffer shows its picture: of faces with `-ls-ps` and `-ps`, of
/// lines with `-ls` and `-ls-ps`.
const KINDS: [(&str, [usize; 4]); 4] = [
    ("", [3, 2, 3, 2]),
    ("-inlinearrays", [1, 1, 1, 1]),
    ("-inlinebuf", [2, 1, 2, 1]),
    ("-inlineelements", [2, 1, 2, 1]),
];

/// Adds the frames of 3D_primitive.
///
/// The programs draw with smooth lines (`-ls`) and polygons (`-ps`) on a surface of two samples a pixel, and blend the sample in the pixel's centre with
/// a frame buffer that they do not clear. It holds what they showed three frames before, and so on.
pub(super) fn solids(frames: &mut Frames) {
    for (name, shape) in primitives::solids() {
        for (kind, [both, polygons, lines, both_of_lines]) in KINDS {
            let faces = shape.topology.has_faces();
            let repeats = match shape.topology {
                Topology::Points => [None; 3],
                _ if faces => [None, Some(both), Some(polygons)],
                _ => [Some(lines), Some(both_of_lines), None],
            };
            frames.push(format!("{name}{kind}"), one(BACKGROUND, None, shape.clone()));
            for (smooth, times) in ["-ls", "-ls-ps", "-ps"].into_iter().zip(repeats) {
                let before = if !faces && kind == "-inlinearrays" && smooth == "-ls" { earlier(name) } else { name };
                let drawn = match times {
                    None => one(BACKGROUND, None, shape.clone()),
                    Some(times) => over(before, &shape, times),
                };
                frames.push(format!("{name}{kind}{smooth}"), drawn);
            }
        }
    }
}

/// Returns the shape that the programs show before another one.
fn earlier(name: &str) -> &'static str {
    match name {
        "Lines" => "LineStrip",
        "LineStrip" => "LineLoop",
        _ => "",
    }
}

/// Returns a frame that shows the smooth picture of a shape several times, over that of the shape `before`. The first frame of all lies over
/// Texture_signed_component_tests' last one.
fn over(before: &str, shape: &Draw, times: usize) -> FrameDrawing {
    let mut canvas = Canvas::new(BACKGROUND);
    match primitives::solids().find(|(name, _)| *name == before) {
        Some((_, sharp)) => {
            canvas.frame_buffer().depth = Some(FAR_DEPTHS);
            canvas.draw(sharp);
        }
        None => texel_formats::blend_ramps(&mut canvas, BlendEquation::SignedReverseSubtract),
    }
    let picture = canvas.target(Target { depth: Some(FAR_DEPTHS), ..frame_buffer(BACKGROUND) });
    canvas.draw_into(picture, [smooth(shape.clone())]);
    let texture = canvas.shown(picture, TextureKind::Rectangle, TextureFormat::A8R8G8B8);
    let [width, height] = [640.0, 480.0];
    for _ in 0..times {
        let whole = [0.0, 0.0, width, height];
        canvas.draw(Draw { blend: OVER, ..pasted(whole, 0, nearest(texture), whole) });
    }
    canvas.colors()
}

/// Returns the draw with smooth edges, blended by their alpha.
pub(super) fn smooth(draw: Draw) -> Draw {
    let lines = Lines { rasterization: LineRasterization::RectangularSmooth, ..Lines::default() };
    Draw { smooth_polygons: true, lines, blend: OVER, ..draw }
}
