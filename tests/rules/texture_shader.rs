//! Examples of the section "Texture shader".

use crate::handbook::example;
use crate::pixel::{Pixel, covering, scene};
use ninebit::state::*;
use ninebit::texture::shader;

fn texture(name: &str, kind: TextureKind, width: u32, words: &[u32]) -> Texture {
    let height = words.len() as u32 / width / if kind == TextureKind::Cube { CUBE_FACES } else { 1 };
    let texels = Texels { width, height, levels: 1, layers: 1, border: false, words: words.into() };
    let (name, format) = (name.to_string(), TextureFormat::A8R8G8B8);
    Texture { name, kind, format, image: TextureImage::Texels(texels) }
}

fn stage(operation: ShaderOperation, mapping: DotMapping) -> ShaderStage {
    ShaderStage { operation, mapping, ..ShaderStage::conventional(0, false) }
}

/// A pixel of a texture shader: unit 0 fetches `word`, the others sample `second` where they sample, at the same coordinates for all
/// vertices; the last register that a stage makes is shown.
fn shaded(word: u32, stages: &[ShaderStage], second: Texture, sets: [[f32; 4]; 4], policies: Policies) -> Pixel {
    let mut draw = covering(Vertex { texture_coordinates: sets, ..Vertex::default() });
    for (index, stage) in stages.iter().enumerate() {
        draw.texture_shader[index] = ShaderStage { coordinate_set: index, ..*stage };
        let nearest = TextureUnit {
            min_filter: Filter::Nearest,
            mag_filter: Filter::Nearest,
            ..TextureUnit::new(usize::from(index > 0))
        };
        draw.textures[index] = stage.operation.samples().then_some(nearest);
    }
    let last = [FinalRegister::Texture0, FinalRegister::Texture1, FinalRegister::Texture2, FinalRegister::Texture3];
    draw.combiners = Combiners::showing(last[stages.len() - 1]);
    let mut scene = scene(Profile::Nv2a, SurfaceFormat::A8R8G8B8, [0; 4], vec![draw]);
    scene.textures = vec![texture("first", TextureKind::TwoDimensional, 1, &[word]), second];
    Pixel::from_scene(&scene, policies)
}

fn white(kind: TextureKind, side: u32) -> Texture {
    let faces = if kind == TextureKind::Cube { CUBE_FACES } else { 1 };
    texture("second", kind, side, &vec![u32::MAX; (faces * side * side) as usize])
}

const SAMPLE: ShaderOperation = ShaderOperation::Sample;

/// The single-precision number that a step yields.
fn float(pixel: &Pixel, name: &str) -> f32 {
    let step = pixel.step(name);
    assert_eq!(step.per_one, 0, "{name} is a single-precision number");
    f32::from_bits(step.value as u32)
}

/// A dot product of stages 1 and 2 that samples 64 texels, stage 1's from these coordinates.
fn dotted(word: u32, mapping: DotMapping, str: [f32; 3]) -> Pixel {
    let stages = [SAMPLE, ShaderOperation::DotProduct, ShaderOperation::DotProduct2D].map(|o| stage(o, mapping));
    let [s, t, r] = str;
    let second = white(TextureKind::TwoDimensional, 64);
    shaded(word, &stages, second, [[0.0; 4], [s, t, r, 1.0], [0.0; 4], [0.0; 4]], Policies::DEFAULT)
}

#[test]
fn examples_of_dot_products() {
    let red = |v: u32, mapping: DotMapping| float(&dotted(v << 16, mapping, [1.0; 3]), "unit1.vector.x");
    let tsh1 = example("TSH-1", "v = 51 is 0.2: 13421773 / 2^26.");
    let fifth = red(51, DotMapping::ZeroToOne);
    tsh1.gives("51", fifth, 13_421_773.0 / (1 << 26) as f32).gives("as a number", fifth, 0.2);

    let tsh2 = example(
        "TSH-2",
        "v = 255 is 1 in the first, -1/255 in the second, -1/127 in the third; v = 0 is -128/127, 1/255, 0.",
    );
    let maps = [DotMapping::MinusOneToOneD3d, DotMapping::MinusOneToOneGl, DotMapping::MinusOneToOne];
    tsh2.gives("255", maps.map(|mapping| red(255, mapping)), [1.0, -1.0 / 255.0, -1.0 / 127.0]);
    tsh2.gives("0", maps.map(|mapping| red(0, mapping)), [-128.0 / 127.0, 1.0 / 255.0, 0.0]);

    let tsh3 = example(
        "TSH-3",
        "A, R, G, B = 76, 204, 0, 0: x = 19660, unsigned 19660/65535; hemisphere 19660/32768, 0, and 13107 / 2^14.",
    );
    let word = 76 << 24 | 204 << 16;
    let vector = |mapping| {
        let pixel = dotted(word, mapping, [1.0; 3]);
        ["unit1.vector.x", "unit1.vector.y", "unit1.vector.z"].map(|name| float(&pixel, name))
    };
    tsh3.gives("x", 256 * 76 + 204, 19_660);
    tsh3.gives("unsigned", vector(DotMapping::Hilo1), [19_660.0 / 65_535.0, 0.0, 1.0]);
    let third = 13_107.0 / (1 << 14) as f32;
    tsh3.gives("hemisphere", vector(DotMapping::HiloHemisphere), [19_660.0 / 32_768.0, 0.0, third]);

    let tsh4 = example(
        "TSH-4",
        "R, G, B = 255, 128, 0 and s, t, r = 0.5, 0.25, 1: 0.5 + 0.12549020 + 0 = 0.62549019; on 64 texels u = 10248, \
         texel 40.",
    );
    let pixel = dotted(0x00ff_8000, DotMapping::ZeroToOne, [0.5, 0.25, 1.0]);
    let products = ["unit1.product.x", "unit1.product.y", "unit1.product.z"].map(|name| float(&pixel, name));
    tsh4.gives("x and z", [products[0], products[2]], [0.5, 0.0]);
    tsh4.shows("y", f64::from(products[1]), 8, "0.12549020");
    tsh4.shows("the sum", f64::from(float(&pixel, "unit1.dot")), 8, "0.62549019");
    tsh4.gives("u", pixel.value("unit2.u"), 10_248).gives("texel", pixel.value("unit2.x"), 40);
}

#[test]
fn examples_of_reflections() {
    let tsh5 = example("TSH-5", "n = (0, 0, 2), e = (0.25, -0.5, 1): n.e = 2, n.n = 4, k = 4, r = (-1, 2, 4).");
    let stages = [
        SAMPLE,
        ShaderOperation::DotProduct,
        ShaderOperation::DotProduct,
        ShaderOperation::DotReflectConstantEye { eye: [0.25, -0.5, 1.0] },
    ]
    .map(|operation| stage(operation, DotMapping::ZeroToOne));
    let (second, z) = (white(TextureKind::Cube, 4), [2.0, 0.0, 0.0, 1.0]);
    let pixel = shaded(0x00ff_0000, &stages, second, [[0.0; 4], [0.0; 4], [0.0; 4], z], Policies::DEFAULT);
    tsh5.gives("n", [1, 2, 3].map(|n| float(&pixel, &format!("unit{n}.dot"))), [0.0, 0.0, 2.0]);
    let parts = ["toward", "square", "scale"].map(|name| float(&pixel, &format!("unit3.{name}")));
    tsh5.gives("n.e, n.n, k", parts, [2.0, 4.0, 4.0]);
    let vector = ["x", "y", "z"].map(|axis| float(&pixel, &format!("unit3.reflection.{axis}")));
    tsh5.gives("r", vector, [-1.0, 2.0, 4.0]);
}

#[test]
fn examples_of_moved_coordinates() {
    let tsh6 = example(
        "TSH-6",
        "n = 256: v = 128 is u = 32896, texel 128; v = 255 is u = 65536, texel 256. Over 256: 32768 and 65280, texels 128 \
         and 255.",
    );
    let both = [DependentScale::Over255, DependentScale::Over256];
    let read = |v: u32, dependent_scale: DependentScale| {
        let stages = [SAMPLE, ShaderOperation::DependentAlphaRed].map(|o| stage(o, DotMapping::ZeroToOne));
        let policies = Policies { dependent_scale, ..Policies::DEFAULT };
        let row = texture("second", TextureKind::TwoDimensional, 256, &[0; 256]);
        let pixel = shaded(v << 24, &stages, row, [[0.0; 4]; 4], policies);
        (pixel.value("unit1.u"), pixel.value("unit1.x"))
    };
    tsh6.gives("128", both.map(|scale| read(128, scale)), [(32_896, 128), (32_768, 128)]);
    tsh6.gives("255", both.map(|scale| read(255, scale)), [(65_536, 256), (65_280, 255)]);

    let tsh7 = example(
        "TSH-7",
        "m0 = 0.5 and B = 64 move by 0.25; B = 192 is -64 and moves by -0.25. On 64 texels u = 8192 becomes 12288 and 4096.",
    );
    let moved = |blue: u32, matrix: [f32; 4]| {
        let bump = ShaderOperation::BumpEnvironment { matrix, luminance: None };
        let stages = [SAMPLE, bump].map(|operation| stage(operation, DotMapping::ZeroToOne));
        let half = [0.5, 0.5, 0.0, 1.0];
        shaded(blue, &stages, white(TextureKind::TwoDimensional, 64), [half; 4], Policies::DEFAULT).value("unit1.u")
    };
    tsh7.gives("0.25", shader::offset([0.5, 0.0], [64, 0], 1), (256 << shader::OFFSET_BITS) / 4);
    tsh7.gives("192", i32::from(192_u8 as i8), -64);
    let matrix = [0.5, 0.0, 0.0, 0.0];
    tsh7.gives("u", [0, 64, 192].map(|blue| moved(blue, matrix)), [8192, 12_288, 4096]);
}

#[test]
fn examples_of_colors() {
    let tsh8 = example(
        "TSH-8",
        "c = 200, R = 128, scale 1.5, offset 0.1: v = floor(2740.12) = 2740, (2740 - 10) >> 4 = 170 (real: 170.59).",
    );
    let bump = ShaderOperation::BumpEnvironment { matrix: [0.0; 4], luminance: Some([1.5, 0.1]) };
    let stages = [SAMPLE, bump].map(|operation| stage(operation, DotMapping::ZeroToOne));
    let second = texture("second", TextureKind::TwoDimensional, 1, &[0x0000_00c8]);
    let pixel = shaded(128 << 16, &stages, second, [[0.0; 4]; 4], Policies::DEFAULT);
    let real = 200.0 / 255.0 * (128.0 / 255.0 * 1.5 + f64::from(0.1_f32));
    tsh8.shows("4096 f", 4096.0 * real, 2, "2740.12").gives("v", pixel.value("unit1.luminance.b"), 2740);
    tsh8.gives("the byte", pixel.value("texture1.b"), 170).gives("by hand", (2740 - 10) >> 4, 170);
    tsh8.shows("the real number", 255.0 * pixel.step("texture1.b").ideal.unwrap(), 2, "170.59");

    let tsh9 = example(
        "TSH-9",
        "s = 0.3: v = floor(1228.8) = 1228, (1228 - 4) >> 4 = 76 (real: 76.50). s = 1.5 is 255, s = -1 is 0.",
    );
    let passed = |s: f32| {
        let stages = [stage(ShaderOperation::PassThrough, DotMapping::ZeroToOne)];
        let second = white(TextureKind::TwoDimensional, 1);
        shaded(0, &stages, second, [[s, 0.0, 0.0, 1.0]; 4], Policies::DEFAULT)
    };
    let third = passed(0.3);
    tsh9.shows("4096 s", 4096.0 * 0.3, 1, "1228.8").gives("v", third.value("unit0.s.4096"), 1228);
    tsh9.gives("the byte", third.value("texture0.r"), 76).gives("by hand", (1228 - 4) >> 4, 76);
    tsh9.shows("the real number", 255.0 * third.step("texture0.r").ideal.unwrap(), 2, "76.50");
    tsh9.gives("beyond", [1.5, -1.0].map(|s| passed(s).value("texture0.r")), [255, 0]);

    let tsh10 = example("TSH-10", "t = -0.001 drops the fragment where negative ones are dropped; t = 0 does not.");
    let culled = |t: f32| {
        let stages = [stage(ShaderOperation::CullFragment { drops_not_negative: [false; 4] }, DotMapping::ZeroToOne)];
        let second = white(TextureKind::TwoDimensional, 1);
        shaded(0, &stages, second, [[0.0, t, 0.0, 1.0]; 4], Policies::DEFAULT).word
    };
    // The surface is cleared to 0; what is kept is black, opaque.
    tsh10.gives("kept and dropped", [0.0, -0.001].map(culled), [0xff00_0000, 0]);
}
