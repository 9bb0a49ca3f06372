//! Examples of the section "Texture units".

use crate::handbook::example;
use crate::interpolation::{at, of_the_section};
use crate::pixel::{Pixel, covering, scene};
use ninebit::state::*;
use ninebit::texture::address::address;
use ninebit::texture::filter;

/// A pixel that shows TEXTURE0: unit 0 samples a row of texels at s, t = 0, with this q.
fn sampled(format: TextureFormat, words: &[u32], s: f32, q: f32, change: impl Fn(&mut TextureUnit)) -> Pixel {
    let mut draw = covering(Vertex { texture_coordinates: [[s, 0.0, 0.0, q]; TEXTURE_UNITS], ..Vertex::default() });
    let mut unit = TextureUnit { min_filter: Filter::Nearest, mag_filter: Filter::Nearest, ..TextureUnit::new(0) };
    change(&mut unit);
    draw.texture_shader[0] = ShaderStage::conventional(0, true);
    draw.textures[0] = Some(unit);
    draw.combiners = Combiners::showing(FinalRegister::Texture0);
    let mut scene = scene(Profile::Nv2a, SurfaceFormat::A8R8G8B8, [0; 4], vec![draw]);
    let texels =
        Texels { width: words.len() as u32, height: 1, levels: 1, layers: 1, border: false, words: words.into() };
    let (kind, image) = (TextureKind::TwoDimensional, TextureImage::Texels(texels));
    scene.textures.push(Texture { name: "row".to_string(), kind, format, image });
    Pixel::from_scene(&scene, Policies::DEFAULT)
}

#[test]
fn examples_of_texture_units() {
    let tex1 = example(
        "TEX-1",
        "red 20 of 31 becomes 20 << 3 | 20 >> 2 = 165 (real: 164.52), red 3 becomes 24 (real: 24.68).",
    );
    for (red, byte, real) in [(20, 165, "164.52"), (3, 24, "24.68")] {
        let texel = sampled(TextureFormat::R5G6B5, &[red << 11], 0.0, 1.0, |_| {});
        tex1.gives("red of the texel", texel.value("texture0.r"), byte);
        tex1.shows("the real number", 255.0 * texel.step("texture0.r").ideal.unwrap(), 2, real);
    }

    let tex5 = example("TEX-5", "u = 255, 256, -1 are texels 0, 1, -1.");
    tex5.gives("u = 255, 256, -1", [255, 256, -1].map(filter::nearest), [0, 1, -1]);

    let tex6 = example(
        "TEX-6",
        "u = 435 (1.7 texels): f = 307, texel 1, weight 51; L(10, 200, 51) = 12378 >> 8 = 48 (real: 47.85).",
    );
    let linear = |unit: &mut TextureUnit| (unit.min_filter, unit.mag_filter) = (Filter::Linear, Filter::Linear);
    let mixed = sampled(TextureFormat::L8, &[0, 10, 200, 0], 435.0 / 1024.0, 1.0, linear);
    tex6.gives("u", mixed.value("unit0.u"), 435).shows("in texels", 435.0 / 256.0, 1, "1.7");
    tex6.gives("texel", mixed.value("unit0.x0"), 1).gives("weight", mixed.value("unit0.weight_u"), 51);
    tex6.gives("the sum of L", 10 * (256 - 51) + 200 * 51 + 128, 12_378).gives("L", filter::lerp(10, 200, 51), 48);
    tex6.gives("the register", mixed.value("texture0.r"), 48);
    tex6.shows("the real number", 255.0 * mixed.step("texture0.r").ideal.unwrap(), 2, "47.85");

    let tex7 = example("TEX-7", "n = 8: wrap -1 is 7; mirror 8, 9, -1 are 7, 6, 0; clamp to edge 9 is 7.");
    tex7.gives("wrap -1", address(AddressMode::Wrap, -1, 8, false), Some(7));
    tex7.gives("mirror 8, 9, -1", [8, 9, -1].map(|i| address(AddressMode::Mirror, i, 8, false)), [7, 6, 0].map(Some));
    tex7.gives("clamp to edge 9", address(AddressMode::ClampToEdge, 9, 8, false), Some(7));

    let tex8 = example("TEX-8", "n = 8, texels 7 and 8: wrap mixes 7 and 0, clamp to edge 7 and 7.");
    let across = |mode: AddressMode| {
        let texels = [100, 10, 20, 30, 40, 50, 60, 70];
        // s = 1 lies on the edge: half way between the centres of texels 7 and 8.
        sampled(TextureFormat::L8, &texels, 1.0, 1.0, |unit| {
            linear(unit);
            unit.address_s = mode;
        })
    };
    for (mode, texels, mixed) in [(AddressMode::Wrap, [7, 0], 85), (AddressMode::ClampToEdge, [7, 7], 70)] {
        let pixel = across(mode);
        tex8.gives("texels before addressing", ["unit0.x0", "unit0.x1"].map(|x| pixel.value(x)), [7, 8]);
        tex8.gives(mode.name(), ["unit0.texel00.x", "unit0.texel10.x"].map(|x| pixel.value(x)), texels);
        tex8.gives(mode.name(), pixel.value("texture0.r"), mixed);
    }

    let tex15 = example(
        "TEX-15",
        "s = 1, q = 2 at all vertices, n = 64: u = 64 * 256 / 2 = 8192, texel 32. q = 0 and s = 1: u = 2^24. The section's \
         triangle, pixel (10, 1), s = 1: q = (0, 1, -7) is 0 there and loses -2^-27, so it is above 0: u = 2^24; q = (0, -1, 7) \
         is below: u = -2^24.",
    );
    let projected = |q: f32| sampled(TextureFormat::L8, &[0; 64], 1.0, q, |_| {});
    tex15.gives("u of 1/2", projected(2.0).value("unit0.u"), 8192);
    tex15.gives("texel of 1/2", projected(2.0).value("unit0.x"), 32);
    tex15.gives("u of 1/0", projected(0.0).value("unit0.u"), 1 << 24);
    let triangle = of_the_section();
    let sample = at(&triangle, 10, 1);
    for (sign, value) in [(1.0, 1 << 24), (-1.0, -1 << 24)] {
        let [s, q, one] = triangle.direction([[1.0; 3], [0.0, sign, -7.0 * sign], [1.0; 3]]);
        tex15.gives("q", sample.sum(&q), 0);
        // -2^-27 of 1.
        let loss = -sign as i128 * sample.sum(&one) * i128::from(triangle.p[1]);
        tex15.gives("8 times its loss", 8 * sample.shortfall(&q), loss);
        tex15.gives("u", sample.ratio(&s, &q, 64).value, value);
    }

    let tex16 = example("TEX-16", "TEXTURE1 of a draw without a second texture is (0, 0, 0, 255).");
    let unbound = Draw { combiners: Combiners::showing(FinalRegister::Texture1), ..covering(Vertex::default()) };
    let scene = scene(Profile::Nv10, SurfaceFormat::A8R8G8B8, [1, 2, 3, 4], vec![unbound]);
    tex16.gives("the word that shows it", Pixel::from_scene(&scene, Policies::DEFAULT).word, 0xff00_0000);

    let key1 = example("KEY-1", "the key 0xf00000ff does not match the texel 0xff0000ff. In X8R8G8B8 it does.");
    let keyed = |format| {
        let key = ColorKey { color: [0, 0, 255, 0xf0], mode: ColorKeyMode::Alpha };
        let pixel = sampled(format, &[0xff00_00ff], 0.0, 1.0, |unit| unit.color_key = Some(key));
        (pixel.value("unit0.key.matched"), pixel.value("texture0.a"))
    };
    key1.gives("A8R8G8B8", keyed(TextureFormat::A8R8G8B8), (0, 255));
    key1.gives("X8R8G8B8", keyed(TextureFormat::X8R8G8B8), (1, 0));

    let tex18 = example("TEX-18", "bytes 0x7f and 0x80 enter as 254 and -256.");
    let signed = sampled(TextureFormat::A8R8G8B8, &[0xff7f_8000], 0.0, 1.0, |unit| unit.signed = [true; 4]);
    tex18.gives("0x7f", signed.value("texture0.r"), 254).gives("0x80", signed.value("texture0.g"), -256);
}
