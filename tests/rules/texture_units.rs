//! Computes the examples of the section "Texture units".

use crate::handbook::beside_rows;
use crate::interpolation::of_the_section;
use crate::pixel::{Pixel, covering, scene};
use ninebit::state::*;
use ninebit_oracle::weights;

/// Returns a pixel that shows TEXTURE0, where unit 0 samples a row of texels at s with t = 0 and the given q.
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
    let tex1 = beside_rows("TEX-1");
    for (red, real) in [(20, "164.52"), (3, "24.68")] {
        let texel = sampled(TextureFormat::R5G6B5, &[red << 11], 0.0, 1.0, |_| {});
        tex1.shows("the real number", 255.0 * texel.step("texture0.r").ideal.unwrap(), 2, real);
    }

    let tex6 = beside_rows("TEX-6");
    let linear = |unit: &mut TextureUnit| (unit.min_filter, unit.mag_filter) = (Filter::Linear, Filter::Linear);
    let mixed = sampled(TextureFormat::L8, &[0, 10, 200, 0], 435.0 / 1024.0, 1.0, linear);
    tex6.gives("u", mixed.value("unit0.u"), 435).shows("in texels", 435.0 / 256.0, 1, "1.7");
    tex6.gives("the sum of L", 10 * (256 - 51) + 200 * 51 + 128, 12_378);
    tex6.shows("the real number", 255.0 * mixed.step("texture0.r").ideal.unwrap(), 2, "47.85");

    let tex8 = beside_rows("TEX-8");
    for (mode, mixed) in [(AddressMode::Wrap, 85), (AddressMode::ClampToEdge, 70)] {
        // s = 1 is the edge of the image, half way between the centres of texels 3 and 4.
        let pixel = sampled(TextureFormat::L8, &[100, 10, 20, 70], 1.0, 1.0, |unit| {
            linear(unit);
            unit.address_s = mode;
        });
        tex8.gives(mode.name(), pixel.value("texture0.r"), mixed);
    }

    let tex15 = beside_rows("TEX-15");
    let b = weights::weights(of_the_section().edges(10, 1).map(i128::from), None).unwrap();
    for sign in [1.0, -1.0] {
        let q = weights::linear([0.0, sign, -7.0 * sign], b).real();
        tex15.gives("q", q, f64::from(sign) * 2_f64.powi(-23));
        tex15.gives("whether the quotient passes the limit", 256.0 * 64.0 / q.abs() > 2_f64.powi(24), true);
    }

    let tex16 = beside_rows("TEX-16");
    let unbound = Draw { combiners: Combiners::showing(FinalRegister::Texture1), ..covering(Vertex::default()) };
    let scene = scene(Profile::Nv10, SurfaceFormat::A8R8G8B8, [1, 2, 3, 4], vec![unbound]);
    tex16.gives("the word that shows it", Pixel::from_scene(&scene, Policies::DEFAULT).word, 0xff00_0000);

    let tex18 = beside_rows("TEX-18");
    let signed = sampled(TextureFormat::A8R8G8B8, &[0xff7f_8000], 0.0, 1.0, |unit| unit.signed = [true; 4]);
    tex18.gives("0x7f", signed.value("texture0.r"), 254).gives("0x80", signed.value("texture0.g"), -256);
}
