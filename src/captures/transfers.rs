//! Surfaces that become textures by a blit, by the processor or in place; surfaces that a draw never reaches; results of vertex programs.

use super::*;

/// Two triangles of each corner of Texture_Framebuffer_Blit: x, y and colour.
const PATCHES: [[f32; 5]; 12] = [
    [-2.75, 1.75, 0.25, 0.25, 0.25],
    [0.0, 1.75, 0.55, 0.55, 0.55],
    [-2.75, 0.0, 0.75, 0.75, 0.75],
    [2.75, 1.75, 0.8, 0.25, 0.1],
    [2.75, 0.0, 0.1, 0.85, 0.1],
    [0.0, 0.0, 0.1, 0.25, 0.9],
    [2.75, -1.75, 0.8, 0.25, 0.9],
    [0.0, -1.75, 0.1, 0.85, 0.9],
    [2.75, 0.0, 0.85, 0.95, 0.1],
    [-2.75, -1.75, 0.2, 0.4, 0.8],
    [0.0, 0.0, 0.3, 0.5, 0.9],
    [0.0, -1.75, 0.4, 0.3, 0.7],
];

/// Adds the frames of Texture_Framebuffer_Blit: a picture of the frame buffer over it. The place of the copy changes no pixel.
pub(super) fn blits(frames: &mut Frames) {
    for name in ["FBToTexture", "FBToZetaAsTex", "FBToOldRenderTarget"] {
        frames.paint(name, 0xf044_1111, |canvas| {
            let vertex = |[x, y, r, g, b]: &[f32; 5]| {
                let diffuse = VertexColor::Floats([*r, *g, *b, 1.0]);
                Vertex { position: space::flat([*x, *y, 1.0, 1.0]), diffuse, ..Vertex::default() }
            };
            let patches = draw(Topology::Triangles, PATCHES.iter().map(vertex).collect());
            let copy = canvas.target(frame_buffer(0xf044_1111));
            canvas.draw_into(copy, [patches.clone()]);
            canvas.draw(patches);
            let texture = canvas.shown(copy, TextureKind::Rectangle, TextureFormat::A8R8G8B8);
            canvas.draw(on_screen([-2.75, 1.75, 2.75, -1.75], 0.1, nearest(texture), [0.0, 0.0, 640.0, 480.0]));
        });
    }
}

/// Returns a picture on a rectangle of the world at z, as two triangles.
fn on_screen(edges: [f32; 4], z: f32, unit: TextureUnit, texels: [f32; 4]) -> Draw {
    let (edges, texels) = (corners(edges), corners(texels));
    let vertex = |n: usize| {
        let [x, y] = edges[n];
        placed(space::flat([x, y, z, 1.0]), texels[n])
    };
    fetching(draw(Topology::Triangles, [0, 1, 2, 0, 2, 3].map(vertex).to_vec()), 0, unit)
}

/// Adds the frame of Texture_CPU_Update: a texture that has become green since the draw before.
pub(super) fn updates(frames: &mut Frames) {
    frames.paint("RGBA", 0xfe20_2020, |canvas| {
        let green = images::texture(TextureFormat::A8B8G8R8, [256; 2], images::solid([0, 0x66, 0, 255]));
        let texture = canvas.texture(&green);
        let screen = pasted([0.0, 0.0, 640.0, 480.0], 0, nearest(texture), [0.0; 4]);
        canvas.draw(without_alpha(screen, FinalRegister::Texture0));
    });
}

/// Returns a square on its corner with texels at its corners.
fn diamond(color: VertexColor, texels: [f32; 4]) -> Draw {
    let positions = [[64.0, 240.0], [320.0, 64.0], [576.0, 240.0], [320.0, 416.0]];
    let mut draw = without_alpha(quads(&positions, color, FinalRegister::PrimaryColor), FinalRegister::PrimaryColor);
    draw.vertices.update(|n, vertex| vertex.texture_coordinates = coordinates(corners(texels)[n]));
    draw
}

/// Adds the frames of Antialiasing_tests that one sample a pixel decides: pictures that the processor wrote into a surface of any number of samples, and
/// a surface of one.
pub(super) fn one_sample(frames: &mut Frames) {
    const SIDE: u32 = 128;
    let mut show = |name: &str, [first, second]: [u32; 2], border: u32| {
        frames.paint(name, 0xff05_0505, move |canvas| {
            let fields = checker([argb(first), argb(second)], 8);
            let inner = border..SIDE - border;
            let picture = |x: u32, y: u32| {
                let is_inside = inner.contains(&x) && inner.contains(&y);
                if is_inside { fields(x - border, y - border) } else { [0xcc; 4] }
            };
            let image = images::texture(TextureFormat::A8R8G8B8, [SIDE; 2], picture);
            let texture = canvas.texture(&images::in_texels(image));
            let shown = fetching(diamond(VertexColor::Bytes([255; 4]), [0.0, 0.0, 128.0, 128.0]), 0, nearest(texture));
            canvas.draw(without_alpha(shown, FinalRegister::Texture0));
        });
    };
    for samples in ["Center1", "CenterCorner2", "SquareOffset4"] {
        show(&format!("CreateSurfaceWith{samples}"), [0xff80_8080, 0xff33_33c0], 2);
    }
    show("CPUWriteIgnoresSurfaceConfig", [0xffcc_3333, 0xff33_33c0], 0);
    show("NonAACPURoundTrip", [0xff33_6666, 0xff33_ff33], 0);
    frames.paint("FBSurfaceWithCenter1", 0xff05_0505, |canvas| {
        canvas.draw(diamond(VertexColor::Floats([0.25, 0.95, 0.75, 1.0]), [0.0; 4]));
    });
}

/// Adds the frame of Texture_render_update_in_place: white, without blue, without red.
pub(super) fn in_place(frames: &mut Frames) {
    frames.paint("RenderToInputTexture", 0xfe25_2525, |canvas| {
        let target = || Target::new(256, 256, SurfaceFormat::A8R8G8B8);
        let whole = [0.0, 0.0, 256.0, 256.0];
        let mut last = canvas.target(target());
        let white = rectangle(whole, VertexColor::Bytes([255; 4]));
        canvas.draw_into(last, [white]);
        for kept in ["255, 255, 0", "0, 255, 255"] {
            let texture = canvas.shown(last, TextureKind::Rectangle, TextureFormat::A8R8G8B8);
            let rgb = "rgb { spare0 = unsigned(tex0) * unsigned(const0); } alpha { spare0 = unsigned(tex0.a); }";
            let text = format!("{{ const0 = bytes({kept}, 255); {rgb} }} out.rgb = spare0; out.a = spare0.a;");
            let draw = Draw { combiners: program(&text), ..pasted(whole, 0, nearest(texture), whole) };
            last = canvas.target(target());
            canvas.draw_into(last, [draw]);
        }
        let texture = canvas.shown(last, TextureKind::Rectangle, TextureFormat::A8R8G8B8);
        canvas.draw(on_screen([-1.75, 1.75, 1.75, -1.75], 0.1, nearest(texture), whole));
    });
}

/// Adds the frames of Vertex_shader_independence_tests: what both units of the vertex processor write at once.
pub(super) fn independence(frames: &mut Frames) {
    let square = |edges: [f32; 4], color: [f32; 4]| {
        without_alpha(rectangle(edges, VertexColor::Floats(color)), FinalRegister::PrimaryColor)
    };
    frames.paint("MAC_ILU_Independence", 0xfe33_3333, move |canvas| {
        canvas.draw(square([128.0, 60.0, 512.0, 420.0], [0.5, 0.5, 1.0, 1.0]));
    });
    frames.paint("Multioutput", 0xfe33_3333, move |canvas| {
        canvas.draw(square([192.0, 128.0, 448.0, 256.0], [0.5, 0.5, 0.0, 1.0]));
        canvas.draw(square([192.0, 256.0, 448.0, 384.0], [0.5, 0.5, 0.5, 1.0]));
    });
}

/// Adds those frames of Vertex_shader_rounding_tests that show a target: one that is filled, and one whose left half is blended with itself.
pub(super) fn composites(frames: &mut Frames) {
    frames.paint("RenderTarget", 0xfe20_2020, |canvas| {
        let clear_color = [255, 0, 255, 0x7f];
        let filled = canvas.target(Target { clear_color, ..Target::new(256, 256, SurfaceFormat::A8R8G8B8) });
        let whole = [0.0, 0.0, 256.0, 256.0];
        let square = rectangle(unprojected(whole), VertexColor::Bytes(abgr(0xff88_7733)));
        canvas.draw_into(filled, [without_alpha(square, FinalRegister::PrimaryColor)]);
        let texture = canvas.shown(filled, TextureKind::Rectangle, TextureFormat::X8R8G8B8);
        let screen = on_screen([-1.75, 1.75, 1.75, -1.75], 0.1, nearest(texture), whole);
        canvas.draw(without_alpha(screen, FinalRegister::Texture0));
    });
    for z in [-4.0_f32, -2.0, 2.0] {
        frames.paint(format!("Compositing_{z}"), 0xfe20_2020, move |canvas| {
            let fields = checker([argb(0xff00_ffff), argb(0xff00_0000)], 8);
            let picture = move |x: u32, y: u32| {
                let (x, y) = (x.wrapping_sub(192), y.wrapping_sub(112));
                if x < 256 && y < 256 { fields(x, y) } else { [0; 4] }
            };
            let (whole, half) = ([0.0, 0.0, 640.0, 480.0], [0.0, 0.0, 320.0, 480.0]);
            let first = images::in_texels(images::texture(TextureFormat::A8R8G8B8, SIZE.into(), picture));
            let mut texture = canvas.texture(&first);
            let text = "{ const1 = bytes(0, 0, 0, 127); rgb { spare0 = unsigned(tex0); }
                alpha { spare0 = unsigned(tex0.a) * unsigned(const1.a); } } out.rgb = spare0; out.a = spare0.a;";
            for _ in 0..4 {
                let copy = Draw { blend: None, ..pasted(whole, 0, nearest(texture), whole) };
                let mixed = Draw { combiners: program(text), ..pasted(half, 0, nearest(texture), half) };
                let next = canvas.target(Target::new(SIZE.0, SIZE.1, SurfaceFormat::A8R8G8B8));
                canvas.draw_into(next, [copy, mixed]);
                texture = canvas.shown(next, TextureKind::Rectangle, TextureFormat::A8R8G8B8);
            }
            canvas.draw(on_screen([-1.75, 1.75, 1.75, -1.75], z, nearest(texture), whole));
        });
    }
}
