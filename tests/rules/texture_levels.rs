//! Computes the examples of levels and cube maps.

use crate::handbook::beside_rows;
use crate::pixel::{Pixel, covering, scene};
use ninebit::state::*;

/// Returns a pixel that shows TEXTURE0 of a white texture, with the coordinates `st` at its centre, which change by `step` from pixel to
/// pixel along x.
fn sampled(kind: TextureKind, side: u32, levels: u32, st: [f32; 3], step: [f32; 3], unit: TextureUnit) -> Pixel {
    let mut draw = covering(Vertex::default());
    // At each vertex the coordinates have the value of this linear function.
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
    let tex9 = beside_rows("TEX-9");
    tex9.gives("bias", (256.0_f32 * 1.2) as i32, 307).gives("rounding", (1075 + 128, 1203 >> 8), (1203, 4));

    beside_rows("TEX-10").shows("log2 3", 256.0 * 3.0_f64.log2(), 2, "405.75");

    let tex11 = beside_rows("TEX-11");
    let unit = TextureUnit { mip_filter: MipFilter::Linear, ..TextureUnit::new(0) };
    let five = sampled(TextureKind::TwoDimensional, 64, 7, [0.5; 3], [3.0 / 64.0, 4.0 / 64.0, 0.0], unit);
    tex11.gives("log2", five.value("unit0.log2_ratio"), 594);
}

#[test]
fn examples_of_cubes() {
    let tex14 = beside_rows("TEX-14");
    let unit = TextureUnit { min_filter: Filter::Linear, mag_filter: Filter::Linear, ..TextureUnit::new(0) };
    let edge = sampled(TextureKind::Cube, 64, 1, [1.0, 0.0, -1.0], [0.0; 3], unit);
    tex14.gives("before", ["unit0.x0", "unit0.x1"].map(|name| edge.value(name)), [63, 64]);
    tex14.gives("after", ["unit0.texel00.x", "unit0.texel10.x"].map(|name| edge.value(name)), [63, 63]);
}

#[test]
fn anisotropy_takes_taps_along_the_longer_axis() {
    beside_rows("TEX-17").shows("in texels", 56_640.0 / 256.0, 2, "221.25");

    let vertical = |anisotropy: u32| TextureUnit { anisotropy, ..TextureUnit::new(0) };
    let two = sampled(TextureKind::TwoDimensional, 64, 1, [0.5; 3], [0.0, 3.0 / 64.0, 0.0], vertical(2));
    // With a step of three texels m is 1.5, and the taps lie 0.75 texels to both sides.
    let [up, down] = ["unit0.tap1.v", "unit0.tap0.v"].map(|tap| two.value(tap) - two.value("unit0.v"));
    assert_eq!((up, down, two.value("unit0.tap0.weight")), (-192, 192, 128));
}
