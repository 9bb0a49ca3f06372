//! Examples of volumes, shadow comparisons and cylindrical wrap.

use crate::handbook::example;
use crate::pixel::{Pixel, covering, scene};
use ninebit::state::*;

/// A pixel that shows TEXTURE0 of a texture, nearest, at coordinates that its triangle's three vertices have.
fn sampled(texture: Texture, coordinates: [[f32; 4]; 3], change: impl Fn(&mut TextureUnit)) -> Pixel {
    let mut draw = covering(Vertex::default());
    draw.vertices.update(|n, vertex| vertex.texture_coordinates = [coordinates[n % 3]; TEXTURE_UNITS]);
    let mut unit = TextureUnit { min_filter: Filter::Nearest, mag_filter: Filter::Nearest, ..TextureUnit::new(0) };
    change(&mut unit);
    draw.texture_shader[0] = ShaderStage::conventional(0, true);
    draw.textures[0] = Some(unit);
    draw.combiners = Combiners::showing(FinalRegister::Texture0);
    let mut scene = scene(Profile::Nv2a, SurfaceFormat::A8R8G8B8, [0; 4], vec![draw]);
    scene.textures.push(texture);
    Pixel::from_scene(&scene, Policies::DEFAULT)
}

fn texture(kind: TextureKind, format: TextureFormat, [width, height, layers]: [u32; 3], words: &[u32]) -> Texture {
    let texels = Texels { width, height, levels: 1, layers, border: false, words: words.into() };
    Texture { name: "texture".to_string(), kind, format, image: TextureImage::Texels(texels) }
}

#[test]
fn examples_of_volumes() {
    let rule = example(
        "VOL-1",
        "four layers: r = 3/7 reads layer 1; r = 1 reads layer 0 where it wraps, layer 3 where it is clamped.",
    );
    let layer = |r: f32, mode: AddressMode| {
        let volume = texture(TextureKind::ThreeDimensional, TextureFormat::L8, [1, 1, 4], &[10, 20, 30, 40]);
        let pixel = sampled(volume, [[0.5, 0.5, r, 1.0]; 3], |unit| unit.address_r = mode);
        assert_eq!(pixel.value("texture0.r"), 10 * (1 + pixel.value("unit0.layer")));
        pixel.value("unit0.layer")
    };
    rule.gives("3/7", layer(3.0 / 7.0, AddressMode::Wrap), 1).gives("1", layer(1.0, AddressMode::Wrap), 0);
    rule.gives("clamped", layer(1.0, AddressMode::ClampToEdge), 3);
}

#[test]
fn examples_of_shadow_comparisons() {
    let rule = example(
        "SHD-1",
        "r = 32767 and a texel of 0x7fff in Z16: Equal is 255, Greater is 0. In two dimensions Less is 255: 0 is less.",
    );
    let compared = |function: CompareFunction, reference: ShadowReference| {
        let depths = texture(TextureKind::Rectangle, TextureFormat::Z16, [1, 1, 1], &[0x7fff]);
        let pixel = sampled(depths, [[0.5, 0.5, 32767.0, 1.0]; 3], |unit| {
            unit.shadow = Some(ShadowComparison { function, reference });
        });
        assert_eq!(pixel.value("unit0.texel.depth"), 0x7fff);
        pixel.value("texture0.g")
    };
    rule.gives("Equal", compared(CompareFunction::Equal, ShadowReference::R), 255);
    rule.gives("Greater", compared(CompareFunction::Greater, ShadowReference::R), 0);
    rule.gives("Less than 0", compared(CompareFunction::Less, ShadowReference::Zero), 255);
}

#[test]
fn examples_of_cylindrical_wrap() {
    let rule = example("CYL-1", "s of 0.9, 0.1, 0.4 is interpolated as 0.9, 1.1, 0.4.");
    let flat = || texture(TextureKind::TwoDimensional, TextureFormat::L8, [8, 1, 1], &[0, 1, 2, 3, 4, 5, 6, 7]);
    let at = |s: [f32; 3], wrap: bool| {
        let pixel = sampled(flat(), s.map(|s| [s, 0.5, 0.0, 1.0]), |unit| unit.cylindrical_wrap = [wrap, false]);
        pixel.value("unit0.u")
    };
    rule.gives("u", at([0.9, 0.1, 0.4], true), at([0.9, 1.1, 0.4], false));
    assert_ne!(at([0.9, 0.1, 0.4], true), at([0.9, 0.1, 0.4], false));
    // Exactly half a repeat stays.
    assert_eq!(at([0.75, 0.25, 1.25], true), at([0.75, 0.25, 1.25], false));
}
