//! CLP-1, CLP-2: clips on the frame buffer, on a texture that is a render target, and on narrower views of the frame buffer.

use super::*;

/// Column, row, width and height.
type Area = [u32; 4];

/// The first rectangles of Window_clip. The registers hold the last column and row, which are x + width and y + height of these.
const FIRST: [Area; 11] = [
    [0, 0, 0, 0],
    [0, 0, 256, 256],
    [8, 16, 0xf00, 0xf00],
    [0, 0, 255, 255],
    [1, 1, 254, 254],
    [1, 1, 253, 253],
    [0, 0, 128, 128],
    [0, 0, 1, 1],
    [255, 255, 1, 1],
    [256, 256, 1, 1],
    [96, 96, 64, 64],
];
/// The second rectangles of Window_clip, encoded the same way.
const SECOND: [Area; 2] = [[0, 0, 0, 0], [16, 16, 8, 8]];

fn bytes(r: u8, g: u8, b: u8) -> VertexColor {
    VertexColor::Bytes([r, g, b, 255])
}

/// Copies a rectangle of the second target to the frame buffer.
fn show(from: [f32; 4], to: [f32; 4]) -> Draw {
    Draw { blend: None, ..without_alpha(pasted(to, 0, nearest(0), from), FinalRegister::Texture0) }
}

/// Adds the frames of Window_clip: on the frame buffer, and (prefix `r`) on a texture.
pub(super) fn window_clip(frames: &mut Frames) {
    let mut cases = Vec::new();
    for exclusive in [false, true] {
        cases.extend(SECOND.iter().flat_map(|second| FIRST.map(|first| (exclusive, false, first, *second))));
        cases.push((exclusive, true, [60, 60, 64, 64], [0, 0, 64, 64]));
    }
    for (exclusive, first_is_last, first, second) in cases {
        let name = |[x, y, width, height]: Area| format!("x{x}y{y}_w{width}h{height}");
        let (order, kind) = (if first_is_last { "s" } else { "" }, if exclusive { "E" } else { "I" });
        let name = format!("{order}{kind}_{}-{}", name(first), name(second));
        let clip = |[x, y, width, height]: Area| Rectangle { x, y, width: width + 1, height: height + 1 };
        // A write to the first register sets all eight, so the second rectangle is lost if it is written before.
        let mut rectangles = vec![clip(first)];
        if !first_is_last {
            rectangles.push(clip(second));
        }
        let square = |color| rectangle([0.0, 0.0, 256.0, 256.0], color);
        let window_clip = Some(WindowClip { rectangles, exclusive });
        let draws = vec![square(bytes(0x33, 0x77, 0x88)), Draw { window_clip, ..square(bytes(0xff, 0x77, 0x33)) }];
        let direct = scene(vec![frame_buffer(0xfe11_1213)], vec![], draws.clone());
        frames.push(name.clone(), FrameDrawing::colors(direct));
        let target = Target { name: "rt".into(), ..Target::new(256, 256, SurfaceFormat::A8R8G8B8) };
        let mut draws: Vec<Draw> = draws.into_iter().map(|draw| Draw { target: 1, ..draw }).collect();
        draws.push(show([0.0, 0.0, 256.0, 256.0], [192.0, 112.0, 448.0, 368.0]));
        let textures = vec![target_texture(TextureFormat::A8R8G8B8, 1)];
        let through = scene(vec![frame_buffer(0xfe33_2233), target], textures, draws);
        frames.push(format!("r{name}"), FrameDrawing::colors(through));
    }
}

/// The clip rectangles of Surface_clip.
const CLIPS: [Area; 9] = [
    [0, 0, 0, 0],
    [0, 0, 512, 0],
    [0, 0, 0, 384],
    [0, 0, 512, 384],
    [16, 8, 512, 384],
    [0, 0, 640, 480],
    [8, 16, 632, 464],
    [0, 240, 640, 240],
    [320, 240, 320, 240],
];

/// Draws a red outline around an area, the area itself in green and one pixel larger, and a light green outline inside it. All are clipped by `clip`.
fn image([x, y, width, height]: Area, clip: Area) -> Vec<Draw> {
    let edges = |by: f32| {
        let [x, y, width, height] = [x, y, width, height].map(|n| f32::from(n as u16));
        [x - by, y - by, x + width + by, y + height + by]
    };
    let outline = |[left, top, right, bottom]: [f32; 4], color: VertexColor| {
        let sides = [
            [left, top, right, top + 4.0],
            [left, bottom - 4.0, right, bottom],
            [left, top, left + 4.0, bottom],
            [right - 4.0, top, right, bottom],
        ];
        sides.map(|side| rectangle(side, color)).to_vec()
    };
    let mut draws = outline(edges(4.0), VertexColor::Floats([1.0, 0.0, 0.0, 1.0]));
    draws.push(rectangle(edges(1.0), VertexColor::Floats([0.1, 0.6, 0.1, 1.0])));
    draws.extend(outline(edges(0.0), VertexColor::Floats([0.0, 1.0, 0.0, 1.0])));
    let [x, y, width, height] = clip;
    let scissor = Some(Rectangle { x, y, width, height });
    draws.into_iter().map(|draw| Draw { scissor, blend: None, ..draw }).collect()
}

/// Adds the frames of Surface_clip: on the frame buffer, twice with nothing but text, on views of it in narrower formats, and on a texture.
pub(super) fn surface_clip(frames: &mut Frames) {
    for name in ["DebugTextShouldClip", "XemuBug420"] {
        frames.push(name, Canvas::new(0xfc11_1155).colors());
    }
    for area in CLIPS {
        let [x, y, width, height] = area;
        let name = format!("x{x}y{y}_w{width}h{height}");
        let of = |draws| scene(vec![frame_buffer(0xfc11_1155)], vec![], draws);
        let direct = FrameDrawing::colors(of(image(area, area)));
        frames.push(format!("{name}_A8R8G8B8"), direct);
        for (suffix, format) in
            [("", SurfaceFormat::R5G6B5), ("_B8", SurfaceFormat::B8), ("_G8B8", SurfaceFormat::G8B8)]
        {
            let view = scene(vec![Target::new(SIZE.0, SIZE.1, format)], vec![], image(area, area));
            let drawn = FrameDrawing { view: Some(view), ..FrameDrawing::colors(of(vec![])) };
            frames.push(format!("{name}{suffix}"), drawn);
        }
        // On a texture, the programs replace a clip width or height of 0 by the whole width or height.
        let or = |size: u32, whole: u32| if size == 0 { whole } else { size };
        let clip = [x, y, or(width, SIZE.0), or(height, SIZE.1)];
        let edges = [x, y, x + clip[2], y + clip[3]].map(|n| f32::from(n as u16));
        let mut draws = vec![Draw { blend: None, ..rectangle(edges, bytes(0, 0, 0)) }];
        draws.extend(image(area, clip));
        let mut draws: Vec<Draw> = draws.into_iter().map(|draw| Draw { target: 1, ..draw }).collect();
        let whole = [0.0, 0.0, 640.0, 480.0];
        draws.push(show(whole, whole));
        let clear_color = [0, 0, 33, 0];
        let target = Target { name: "rt".into(), clear_color, ..Target::new(SIZE.0, SIZE.1, SurfaceFormat::R5G6B5) };
        let textures = vec![target_texture(TextureFormat::R5G6B5, 1)];
        let through = scene(vec![frame_buffer(0xff26_2422), target], textures, draws);
        frames.push(format!("rt_{name}"), FrameDrawing::colors(through));
    }
}
