//! Examples of levels and cube maps.

use crate::handbook::example;
use crate::pixel::{Pixel, covering, scene};
use ninebit::state::*;
use ninebit::texture::anisotropy;
use ninebit::texture::cube::Face;
use ninebit::texture::lod::log2_ratio;

/// A pixel that shows TEXTURE0 of a white texture, sampled at s, t, r plus so much a pixel along x.
fn sampled(kind: TextureKind, side: u32, levels: u32, st: [f32; 3], step: [f32; 3], unit: TextureUnit) -> Pixel {
    let mut draw = covering(Vertex::default());
    // The vertices lie where they lie: coordinates that grow by `step` from pixel to pixel and are `st` at the centre of the first.
    draw.vertices.update(|_, vertex| {
        let x = vertex.position[0] - 0.5;
        let along = |n: usize| st[n] + step[n] * x;
        vertex.texture_coordinates = [[along(0), along(1), along(2), 1.0]; TEXTURE_UNITS];
    });
    draw.textures[0] = Some(unit);
    draw.texture_shader[0] = ShaderStage::conventional(0, true);
    draw.combiners = Combiners::showing(FinalRegister::Texture0);
    let mut scene = scene(Profile::Nv2a, SurfaceFormat::A8R8G8B8, [0; 4], vec![draw]);
    let (_, face) = Level::chain(TextureFormat::L8, side, side, levels, false);
    let faces = if kind == TextureKind::Cube { CUBE_FACES as usize } else { 1 };
    let texels =
        Texels { width: side, height: side, levels, layers: 1, border: false, words: vec![255; faces * face].into() };
    let (name, format, image) = ("white".to_string(), TextureFormat::L8, TextureImage::Texels(texels));
    scene.textures.push(Texture { name, kind, format, image });
    Pixel::from_scene(&scene, Policies::DEFAULT)
}

#[test]
fn examples_of_levels() {
    let tex9 = example(
        "TEX-9",
        "ratio 8 and bias 1.2: lod = 768 + 307 = 1075, levels 4 and 5, weight 51; nearest: level 1203 >> 8 = 4.",
    );
    let unit =
        |mip_filter: MipFilter| TextureUnit { lod_bias: (256.0_f32 * 1.2) as i32, mip_filter, ..TextureUnit::new(0) };
    let eight = [8.0 / 256.0, 0.0, 0.0];
    let linear = sampled(TextureKind::TwoDimensional, 256, 9, [0.25; 3], eight, unit(MipFilter::Linear));
    tex9.gives("log2", linear.value("unit0.log2_ratio"), 768).gives("bias", unit(MipFilter::None).lod_bias, 307);
    tex9.gives("lod", linear.value("unit0.lod"), 1075);
    tex9.gives("levels", ["unit0.level", "unit0.next_level"].map(|name| linear.value(name)), [4, 5]);
    tex9.gives("weight", linear.value("unit0.weight_lod"), 51);
    let nearest = sampled(TextureKind::TwoDimensional, 256, 9, [0.25; 3], eight, unit(MipFilter::Nearest));
    tex9.gives("nearest", nearest.value("unit0.level"), 4).gives("rounding", (1075 + 128, 1203 >> 8), (1203, 4));

    let tex10 = example("TEX-10", "ratio 8: 768. Ratio 3: floor(405.75) = 405.");
    let ratio = |texels: i64| log2_ratio(Some([[0, 0], [65536 * texels, 0], [0, 0]]));
    tex10.gives("8", ratio(8), 768).gives("3", ratio(3), 405).shows("log2 3", 256.0 * 3.0_f64.log2(), 2, "405.75");

    let tex11 = example(
        "TEX-11",
        "3 texels a pixel along u and 4 along v, across one step right: 5 texels, floor(256 log2 5) = 594.",
    );
    let unit = TextureUnit { mip_filter: MipFilter::Linear, ..TextureUnit::new(0) };
    let five = sampled(TextureKind::TwoDimensional, 64, 7, [0.5; 3], [3.0 / 64.0, 4.0 / 64.0, 0.0], unit);
    tex11.gives("log2", five.value("unit0.log2_ratio"), 594).gives("5", ratio(5), 594);
}

#[test]
fn examples_of_cubes() {
    let cube = |side: u32, direction: [f32; 3], filter: Filter| {
        let unit = TextureUnit { min_filter: filter, mag_filter: filter, ..TextureUnit::new(0) };
        sampled(TextureKind::Cube, side, 1, direction, [0.0; 3], unit)
    };
    let tex12 = example(
        "TEX-12",
        "(0.5, -1, 0.25), n = 64: face -Y, u = 8192 (0.5 + 1) = 12288, v = 8192 (-0.25 + 1) = 6144: texel (48, 24).",
    );
    let pixel = cube(64, [0.5, -1.0, 0.25], Filter::Nearest);
    tex12.gives("face", pixel.value("unit0.face"), Face::NegativeY as i64);
    tex12.gives("u, v", ["unit0.u", "unit0.v"].map(|name| pixel.value(name)), [12288, 6144]);
    tex12.gives("texel", ["unit0.texel.x", "unit0.texel.y"].map(|name| pixel.value(name)), [48, 24]);

    let tex13 = example("TEX-13", "(1, -1, 1) is face +X, (0, -1, 1) face -Y, (0, 0, 0) texel (0, 0) of face +X.");
    for (direction, face) in [([1.0, -1.0, 1.0], 0), ([0.0, -1.0, 1.0], 3), ([0.0; 3], 0)] {
        tex13.gives("face", cube(8, direction, Filter::Nearest).value("unit0.face"), face);
    }
    let zero = cube(8, [0.0; 3], Filter::Nearest);
    tex13.gives("texel", ["unit0.texel.x", "unit0.texel.y"].map(|name| zero.value(name)), [0, 0]);

    let tex14 = example("TEX-14", "(1, 0, -1) with n = 4: u = 1024, texels 3 and 4 before addressing, 3 and 3 after.");
    let edge = cube(4, [1.0, 0.0, -1.0], Filter::Linear);
    tex14.gives("u", edge.value("unit0.u"), 1024);
    tex14.gives("before", ["unit0.x0", "unit0.x1"].map(|name| edge.value(name)), [3, 4]);
    tex14.gives("after", ["unit0.texel00.x", "unit0.texel10.x"].map(|name| edge.value(name)), [3, 3]);
}

#[test]
fn anisotropy_takes_taps_along_the_longer_axis() {
    let tex17 = example(
        "TEX-17",
        "l = 1.226, k = 0.2, A = 2: m = 1, taps 28/256 to both sides. l = 885: m = 442.5, taps 221.25 to both sides.",
    );
    // Lengths in 1/65536 texel, down the screen and across.
    let along = |l: f64, k: f64| {
        let [l, k] = [l, k].map(|texels| (65536.0 * texels) as i64);
        let taps = anisotropy::taps(Some([[0, 0], [k, 0], [0, l]]), 2);
        (taps.count, [taps.offsets[0][1], taps.offsets[1][1]])
    };
    tex17.gives("l = 1.226", along(1.226, 0.2), (2, [28, -28]));
    tex17.gives("l = 885", along(885.0, 0.2), (2, [56_640, -56_640])).shows("in texels", 56_640.0 / 256.0, 2, "221.25");

    let vertical = |anisotropy: u32| TextureUnit { anisotropy, ..TextureUnit::new(0) };
    let two = sampled(TextureKind::TwoDimensional, 64, 1, [0.5; 3], [0.0, 3.0 / 64.0, 0.0], vertical(2));
    // Three texels a pixel: m = 1.5, the taps 0.75 to both sides.
    let [up, down] = ["unit0.tap1.v", "unit0.tap0.v"].map(|tap| two.value(tap) - two.value("unit0.v"));
    assert_eq!((up, down, two.value("unit0.tap0.weight")), (-192, 192, 128));
}
