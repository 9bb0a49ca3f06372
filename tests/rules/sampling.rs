//! Computes the examples of volumes.

use crate::handbook::beside_rows;
use crate::pixel::{Pixel, covering, scene};
use ninebit::state::*;

#[test]
fn examples_of_volumes() {
    let texture_coordinates = [[0.5, 0.5, 3.0 / 7.0, 1.0]; TEXTURE_UNITS];
    let mut draw = covering(Vertex { texture_coordinates, ..Vertex::default() });
    draw.texture_shader[0] = ShaderStage::conventional(0, true);
    draw.textures[0] =
        Some(TextureUnit { min_filter: Filter::Nearest, mag_filter: Filter::Nearest, ..TextureUnit::new(0) });
    draw.combiners = Combiners::showing(FinalRegister::Texture0);
    let mut scene = scene(Profile::Nv2a, SurfaceFormat::A8R8G8B8, [0; 4], vec![draw]);
    let texels =
        Texels { width: 1, height: 1, levels: 1, layers: 4, border: false, words: vec![10, 20, 30, 40].into() };
    let (kind, image) = (TextureKind::ThreeDimensional, TextureImage::Texels(texels));
    scene.textures.push(Texture { name: "volume".to_string(), kind, format: TextureFormat::L8, image });
    let pixel = Pixel::from_scene(&scene, Policies::DEFAULT);
    beside_rows("VOL-1").gives("the texel of layer 1", pixel.value("texture0.r"), 20);
}
