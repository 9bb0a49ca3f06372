//! Computes the examples of the section "Texture shader".

use crate::handbook::beside_rows;
use crate::pixel::{Pixel, covering, scene};
use ninebit::state::*;

fn texture(name: &str, kind: TextureKind, width: u32, words: &[u32]) -> Texture {
    let height = words.len() as u32 / width / if kind == TextureKind::Cube { CUBE_FACES } else { 1 };
    let texels = Texels { width, height, levels: 1, layers: 1, border: false, words: words.into() };
    let (name, format) = (name.to_string(), TextureFormat::A8R8G8B8);
    Texture { name, kind, format, image: TextureImage::Texels(texels) }
}

fn stage(operation: ShaderOperation, mapping: DotMapping) -> ShaderStage {
    ShaderStage { operation, mapping, ..ShaderStage::conventional(0, false) }
}

/// Returns a pixel that shows the register of the last stage. Unit 0 fetches `word`. Other units that sample read `second`. The coordinates
/// are the same at all vertices.
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

/// Returns the single-precision number that a step yields.
fn float(pixel: &Pixel, name: &str) -> f32 {
    let step = pixel.step(name);
    assert_eq!(step.per_one, 0, "{name} is a single-precision number");
    f32::from_bits(step.value as u32)
}

#[test]
fn examples_of_dot_products() {
    beside_rows("TSH-1").gives("a fifth", 13_421_773.0 / (1 << 26) as f32, 0.2);
    beside_rows("TSH-3").gives("x", 256 * 76 + 204, 19_660);

    let tsh4 = beside_rows("TSH-4");
    tsh4.shows("y", f32::from_bits(0x3e00_8081).into(), 8, "0.12549020");
    tsh4.shows("the sum", f32::from_bits(0x3f20_2020).into(), 8, "0.62549019");
}

#[test]
fn examples_of_reflections() {
    let tsh5 = beside_rows("TSH-5");
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
    let tsh7 = beside_rows("TSH-7");
    let moved = |blue: u32, matrix: [f32; 4]| {
        let bump = ShaderOperation::BumpEnvironment { matrix, luminance: None };
        let stages = [SAMPLE, bump].map(|operation| stage(operation, DotMapping::ZeroToOne));
        let half = [0.5, 0.5, 0.0, 1.0];
        shaded(blue, &stages, white(TextureKind::TwoDimensional, 64), [half; 4], Policies::DEFAULT).value("unit1.u")
    };
    tsh7.gives("192", i32::from(192_u8 as i8), -64);
    let matrix = [0.5, 0.0, 0.0, 0.0];
    tsh7.gives("u", [0, 64, 192].map(|blue| moved(blue, matrix)), [8192, 12_288, 4096]);
}

#[test]
fn examples_of_colors() {
    let tsh8 = beside_rows("TSH-8");
    let bump = ShaderOperation::BumpEnvironment { matrix: [0.0; 4], luminance: Some([1.5, 0.1]) };
    let stages = [SAMPLE, bump].map(|operation| stage(operation, DotMapping::ZeroToOne));
    let second = texture("second", TextureKind::TwoDimensional, 1, &[0x0000_00c8]);
    let pixel = shaded(128 << 16, &stages, second, [[0.0; 4]; 4], Policies::DEFAULT);
    let real = 200.0 / 255.0 * (128.0 / 255.0 * 1.5 + f64::from(0.1_f32));
    tsh8.shows("4096 f", 4096.0 * real, 2, "2740.12").gives("by hand", (2740 - 10) >> 4, 170);
    tsh8.shows("the real number", 255.0 * pixel.step("texture1.b").ideal.unwrap(), 2, "170.59");

    let tsh9 = beside_rows("TSH-9");
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

    let tsh10 = beside_rows("TSH-10");
    let culled = |t: f32| {
        let stages = [stage(ShaderOperation::CullFragment { drops_not_negative: [false; 4] }, DotMapping::ZeroToOne)];
        let second = white(TextureKind::TwoDimensional, 1);
        shaded(0, &stages, second, [[0.0, t, 0.0, 1.0]; 4], Policies::DEFAULT).word
    };
    // The surface is cleared to 0. A fragment that is kept is opaque black.
    tsh10.gives("kept and dropped", [0.0, -0.001].map(culled), [0xff00_0000, 0]);
}
