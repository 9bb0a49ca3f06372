//! PNT-1 to PNT-3: sizes from the register, from distances and from programs; pictures on points.

use super::*;
use ninebit::vertex::point::PointParameters;

/// Multiplies unit 3's texture by the primary colour.
fn modulated(draw: Draw, texture: usize) -> Draw {
    let unit = TextureUnit { address_s: AddressMode::Wrap, address_t: AddressMode::Wrap, ..nearest(texture) };
    let combiners = program("out.rgb = lerp(tex3, col0, zero); out.a = unsigned_invert(zero);");
    Draw { combiners, ..fetching(draw, SPRITE_UNIT, unit) }
}

/// Distance of a place on the screen from the viewer, who stands before a point of the world at z.
fn distance([x, y]: [f32; 2], z: f32) -> f32 {
    let w = z + space::DISTANCE as f32;
    let [across, down] = space::eye_slope([x, y]).map(|slope| slope * w);
    (across * across + down * down + w * w).sqrt()
}

/// A size that falls with the square root of the distance.
const fn parameters(attenuation: [f32; 3], range: f32, bias: f32, smallest: f32) -> PointParameters {
    PointParameters { attenuation, bias, range, smallest }
}

/// The parameters of the points of a row, in turn.
const BASIC: [PointParameters; 13] = [
    parameters([0.0, 0.0, 0.0], 0.0, 0.0, 0.0),
    parameters([0.0, 0.0, 0.0], 0.0, 0.0, 16.0),
    parameters([0.000001, 0.0, 0.0], 16.0, 0.0, 0.0),
    parameters([0.000001, 0.0, 0.0], 16.0, 0.0, 8.0),
    parameters([4.0, 0.0, 0.0], 14.0, 0.0, 16.0),
    parameters([4.0, 0.0, 0.0], 36.0, 0.0, 4.0),
    parameters([256.0, 0.0, 0.0], 36.0, 0.0, 4.0),
    parameters([0.0, 0.25, 0.0], 39.0, 0.0, 1.0),
    parameters([0.0, 0.0, 0.05], 39.0, 0.0, 1.0),
    parameters([4.0, 0.0, 0.0], 14.0, -0.5, 16.0),
    parameters([4.0, 0.0, 0.0], 14.0, 0.5, 16.0),
    parameters([0.0, 0.0, 0.0], 15.0, -100.0, 1.0),
    parameters([0.0, 0.0, 0.0], 15.0, 100.0, 1.0),
];

/// Those of the frames `Detailed`: different biases.
fn detailed() -> Vec<PointParameters> {
    let falling = [-1.0, -0.5, -0.25, -0.01, 0.0, 0.01, 0.25, 0.5, 1.0];
    let falling = falling.map(|bias| parameters([0.0, 0.25, 0.0], 39.0, bias, 1.0));
    let constant = [-0.4, -0.25, 0.25, 0.4].map(|bias| parameters([4.0, 0.0, 0.0], 36.0, bias, 4.0));
    falling.into_iter().chain(constant).collect()
}

/// How the points of a frame get their sizes.
#[derive(Clone, Copy, PartialEq)]
enum Source {
    Register(u16),
    Distance,
}

/// Draws rows of points, each row farther away.
fn rows(canvas: &mut Canvas, all: &[PointParameters], source: Source, sprites: bool, moved: f32) {
    let fields = checker([argb(0xffff_ffff), argb(0xff33_3333)], 2);
    let texture = canvas.texture(&images::texture(TextureFormat::A8R8G8B8, [32; 2], fields));
    let (mut z, mut red) = (-5.0_f32, 0.1_f32);
    for y in (100_u16..480).step_by(48) {
        // Behind a program, what lies before the depth range is culled.
        let is_culled = moved == 0.0 && z < 0.0;
        let mut blue = 0.1_f32;
        for (x, parameters) in (20_u16..640).step_by(48).zip(all.iter().cycle()) {
            let at = [x, y].map(f32::from);
            let point_size = match source {
                Source::Register(size) => size,
                Source::Distance => parameters.size(distance(at, z)),
            };
            let color = VertexColor::Floats([red, 0.65, blue, 1.0]);
            let draw = draw(Topology::Points, vec![vertex(at.map(|n| n + moved), color)]);
            if !is_culled {
                canvas.draw(Draw { point_size, point_sprite: sprites, ..modulated(draw, texture) });
            }
            blue += 0.1;
        }
        red += 0.1;
        z += 25.0;
    }
}

/// Adds the frames of Point_params. A program's size counts where the parameters do; otherwise the register's does.
pub(super) fn parameters_varied(frames: &mut Frames) {
    let mut add = |name: &str, clear: u32, all: Vec<PointParameters>, source: Source, sprites: bool| {
        let moved = if name.ends_with("FF") { UNPROJECTED } else { 0.0 };
        frames.paint(name, clear, move |canvas| rows(canvas, &all, source, sprites, moved));
    };
    for (name, source, sprites) in [
        ("PointParamsOff_SmoothOff_128_FF", Source::Register(128), false),
        ("PointParamsOn_SmoothOn_001_FF", Source::Distance, true),
        ("PointParamsOn_SmoothOn_128_FF", Source::Distance, true),
        ("PointParamsOn_SmoothOff_128_FF", Source::Distance, false),
        ("PointParamsOn_SmoothOn_128_VS", Source::Register(128), true),
        ("PointParamsOn_SmoothOff_128_VS", Source::Register(128), false),
        ("PointParamsOff_SmoothOff_128_VS", Source::Register(8), false),
    ] {
        add(name, 0xff22_2323, BASIC.to_vec(), source, sprites);
    }
    add("Detailed_FF", 0xff22_2324, detailed(), Source::Distance, true);
    add("Detailed_VS", 0xff22_2324, detailed(), Source::Register(128), true);
    for [a, b, c] in [0, 1, 2, 3, 4, 5, 6, 7].map(|n: u8| [n & 1, n >> 1 & 1, n >> 2]) {
        let scale = [4 * a, b, c].map(f32::from);
        let name = format!("Scale_{}_{b}_{c}", 4 * a);
        frames.paint(format!("{name}_FF"), 0xff24_2323, move |canvas| {
            let size = |at, z| parameters(scale, 64.0, 0.0, 0.5).size(distance(at, z));
            scaled(canvas, size, UNPROJECTED, VertexColor::Bytes(abgr(0xff55_55ee)));
        });
        frames.paint(format!("{name}_VS"), 0xff24_2323, |canvas| {
            scaled(canvas, |_, _| 130, 0.0, VertexColor::Floats([0.93, 0.33, 0.33, 1.0]));
        });
    }
}

/// Draws 192 points, each a step farther away than the one before.
fn scaled(canvas: &mut Canvas, size: impl Fn([f32; 2], f32) -> u16, moved: f32, color: VertexColor) {
    for (at, n) in places([32.0, 116.0], [32.0; 2], 18).zip(0_u8..192) {
        let point = draw(Topology::Points, vec![vertex(at.map(|n| n + moved), color)]);
        canvas.draw(Draw { point_size: size(at, f32::from(n)), ..point });
    }
}

/// Adds the frame of Point_sprite: points with a picture or without, of a size of the register or by distance, with and without alpha test.
pub(super) fn sprites(frames: &mut Frames) {
    frames.paint("AlphaTest", 0xff33_3333, |canvas| {
        let gradients = images::four_gradients([64; 2]);
        // The programs exchange red and blue.
        let picture = move |x, y| {
            let [r, g, b, a] = gradients(x, y);
            [b, g, r, a]
        };
        let texture = canvas.texture(&images::texture(TextureFormat::A8R8G8B8, [64; 2], picture));
        let tests = [None, Some(AlphaTest { function: CompareFunction::Greater, reference: 0x7f })];
        for (alpha_test, y) in tests.into_iter().zip([96.0, 192.0]) {
            for (point_size, left) in [(LARGEST_SIZE, 180.0), (7, 372.0)] {
                for (shows, x) in [(FETCHED[SPRITE_UNIT], left), (FinalRegister::PrimaryColor, left + 96.0)] {
                    let at = [x, y].map(|n| n + UNPROJECTED);
                    let point = draw(Topology::Points, vec![vertex(at, VertexColor::Bytes([255; 4]))]);
                    let point = fetching(point, SPRITE_UNIT, nearest(texture));
                    let combiners = Combiners::showing(shows);
                    canvas.draw(Draw { combiners, point_size, point_sprite: true, alpha_test, ..point });
                }
            }
        }
    });
}
