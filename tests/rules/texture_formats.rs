//! Computes the examples of compressed textures.

use crate::handbook::beside_rows;
use crate::pixel::{Pixel, covering, scene};
use ninebit::state::*;

/// Returns a pixel that shows TEXTURE0, sampled at texel (x, 0) of one block.
fn sampled(profile: Profile, format: TextureFormat, words: &[u32], x: u32) -> Pixel {
    let s = (x as f32 + 0.5) / 4.0;
    let mut draw = covering(Vertex { texture_coordinates: [[s, 0.0, 0.0, 1.0]; TEXTURE_UNITS], ..Vertex::default() });
    draw.texture_shader[0] = ShaderStage::conventional(0, true);
    draw.textures[0] =
        Some(TextureUnit { min_filter: Filter::Nearest, mag_filter: Filter::Nearest, ..TextureUnit::new(0) });
    draw.combiners = Combiners::showing(FinalRegister::Texture0);
    draw.combiners.final_combiner.g =
        FinalInput { register: FinalRegister::Texture0, component: Component::Alpha, invert: false };
    let mut scene = scene(profile, SurfaceFormat::A8R8G8B8, [0; 4], vec![draw]);
    let texels = Texels { width: 4, height: 4, levels: 1, layers: 1, border: false, words: words.into() };
    let (kind, image) = (TextureKind::TwoDimensional, TextureImage::Texels(texels));
    scene.textures.push(Texture { name: "block".to_string(), kind, format, image });
    Pixel::from_scene(&scene, Policies::DEFAULT)
}

/// Returns the word of two colours that have only red.
fn reds(first: u32, second: u32) -> u32 {
    first << 11 | second << 27
}

#[test]
fn examples_of_compressed_textures() {
    let real = |pixel: &Pixel, name: &str| 255.0 * pixel.step(name).ideal.unwrap();
    let tex2 = beside_rows("TEX-2");
    let block = [200 | 10 << 8 | 3 << 22, 0, reds(28, 29), 0b10_01_00];
    let texel = sampled(Profile::Nv2a, TextureFormat::Dxt5, &block, 2);
    tex2.shows("the real third", real(&texel, "texture0.r"), 2, "233.06");
    tex2.shows("the real alpha", real(&texel, "texture0.a"), 2, "145.71");

    let tex3 = beside_rows("TEX-3");
    let texel = sampled(Profile::Nv2a, TextureFormat::Dxt1, &[reds(16, 0), 0], 0);
    tex3.gives("n", [132 & 7, (132 + 7) & 7], [4, 3]).shows("the real red", real(&texel, "texture0.r"), 2, "131.61");

    let texel = sampled(Profile::Nv10, TextureFormat::Dxt1, &[reds(24, 31), 0b10], 0);
    beside_rows("TEX-4").shows("the real red", real(&texel, "texture0.r"), 2, "226.21");
}
