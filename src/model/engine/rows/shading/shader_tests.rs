//! Compares texture shaders on rows with the definition.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, reason = "choosing triangles; a test fails by panicking")]

use crate::engine::rows::Isa;
use crate::engine::rows::equivalence_tests::{DEPTHS, Random, Third, scene, steps, triangle};
use crate::engine::{Engine, RenderOptions, Renderer};
use crate::plan::{Plan, PlanOptions};
use crate::state::*;

/// Returns a number of any magnitude, or one of a few common numbers.
fn wild(r: &mut Random) -> f32 {
    let sign = if r.below(2) == 0 { 1.0 } else { -1.0 };
    match r.below(8) {
        0 => r.of(&[0.0, -0.0, 1.0, -1.0, 0.5, 1e-45, 3e38, -3e38]),
        1 => sign * (r.unit() * 1e30 + 1.0),
        2 => sign * r.unit() * 1e-30,
        3 => sign * 2_f32.powi(r.below(200) as i32 - 100) * (1.0 + r.unit()),
        _ => sign * r.unit() * 2.0,
    }
}

/// Returns the halves of a square that faces the viewer, whose coordinates are 1 for each `scale` pixels.
fn square(r: &mut Random, scale: f32) -> [Vertex; 6] {
    let (x, y, side) = (r.below(128) as f32, r.below(64) as f32, r.of(&[16.0, 64.0, 128.0]));
    [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(right, down)| {
        let (x, y) = (x + right * side, y + down * side);
        let [mut vertex, ..] = triangle(r, true);
        vertex.position = [x, y, 0.5, 1.0];
        vertex.texture_coordinates = [[x / scale, y / scale, 0.0, 1.0]; 4];
        vertex
    })
}

/// Compares the numbers that vertices give to texture shaders, of any magnitude, and coordinates that stages move, on triangles of all
/// kinds and on squares, of which the definition computes next to nothing.
#[test]
fn texture_shaders_take_what_the_definition_takes() {
    use ShaderOperation as O;
    let mut random = Random::seeded(0xd1b5_4a32_d192_ed03);
    let bump = |matrix| O::BumpEnvironment { matrix, luminance: Some([1.0, 0.25]) };
    let (far, hardly) = (bump([3.0, -2.0, 0.5, 8.0]), bump([-1e-13, -2e-13, 1e-13, 2e-13]));
    let cull = O::CullFragment { drops_not_negative: [true, false, true, true] };
    let programs = [
        [O::Sample, far, O::DotProduct, O::DotProduct2D],
        [O::Sample, O::PassThrough, O::PassThrough, O::PassThrough],
        [O::Sample, cull, far, O::PassThrough],
        [O::Sample, hardly, O::PassThrough, O::PassThrough],
    ];
    let (mut pixels, mut defined) = (0, 0);
    for round in 0..32 {
        let small = round % 2 == 0;
        let mut vertices: Vec<Vertex> =
            (0..if small { 1024 } else { 6 }).flat_map(|_| triangle(&mut random, small)).collect();
        let squares = round % 3 == 1;
        if squares {
            // With the larger scale, 4096ths are odd.
            let scale = random.of(&[64.0, 2048.0]);
            vertices = (0..6).flat_map(|_| square(&mut random, scale)).collect();
        }
        let program = programs[round / 2 % programs.len()];
        let tame = random.below(2) == 0;
        for (n, _) in program.iter().enumerate().filter(|(_, operation)| !squares && !operation.samples()) {
            for vertex in &mut vertices {
                vertex.texture_coordinates[n] =
                    [0; 4].map(|_| if tame { random.unit() * 2.0 - 0.5 } else { wild(&mut random) });
            }
        }
        let filter = random.of(&[Filter::Linear, Filter::Nearest]);
        let mut scene =
            scene(vertices, filter, DepthFormat::Z24S8, None, [false; 2], (Third::Nothing, round % 3 == 0, 1));
        let draw = &mut scene.draws[0];
        // A dropped fragment shows what was drawn before.
        draw.depth_test = if round % 4 < 2 { None } else { draw.depth_test.take() };
        let unit = |bound| if bound { draw.textures[0] } else { None };
        draw.textures = program.map(|operation| unit(operation.samples()));
        draw.texture_shader =
            [0, 1, 2, 3].map(|n| ShaderStage { operation: program[n], ..ShaderStage::conventional(n, true) });
        draw.texture_shader[3].previous = 0;
        draw.texture_shader[2].previous = 0;
        let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
        let (drawn, by_definition) = compare(&plan, &format!("{program:?}, round {round}"));
        (pixels, defined) = (pixels + drawn, defined + by_definition);
    }
    println!("{pixels} pixels, {defined} of them by the scalar engine");
    assert!(defined < pixels / 2);
}

/// Draws a plan by both engines, by each instruction set. Returns the numbers of pixels that all sets drew, and of those that the
/// scalar engine drew for them.
pub(crate) fn compare(plan: &Plan, what: &str) -> (u64, u64) {
    let draw = |engine, isa| Renderer::new(plan, &RenderOptions { engine, isa, ..RenderOptions::default() }).render();
    let (wanted, _) = draw(Engine::Scalar, None);
    let (mut pixels, mut defined) = (0, 0);
    for isa in Isa::ALL {
        let (got, statistics) = draw(Engine::Fast, Some(*isa));
        assert!(got == wanted, "{isa:?}, {what}: {:?}", plan.draws[0].assembly);
        pixels += statistics.shaded_pixels.iter().sum::<u64>();
        defined += statistics.scalar_pixels;
    }
    (pixels, defined)
}

/// Compares dependent reads of textures with levels, whose level of detail takes the results of other pixels of the quad, also of those
/// beyond the triangle: on triangles of all kinds, where the definition computes hardly anything, and on squares.
#[test]
fn dependent_reads_with_levels_are_those_of_the_definition() {
    use ShaderOperation as O;
    let mut random = Random::seeded(0x2545_f491_4f6c_dd1d);
    let bump = O::BumpEnvironment { matrix: [0.25, -0.5, 0.125, 0.375], luminance: None };
    let eye = O::DotReflectConstantEye { eye: [0.5, -0.25, 1.0] };
    let programs = [
        [O::Sample, bump, bump, O::DependentGreenBlue],
        [O::Sample, O::DotProduct, O::DotProduct, O::DotReflectSpecular],
        [O::Sample, O::DependentAlphaRed, O::DotProduct, O::DotProduct2D],
        [O::Sample, O::DotProduct, O::DotProduct, eye],
        [O::Sample, bump, O::DotProduct, O::DotProduct2D],
        [O::Sample, O::DotProduct, O::DotProduct, O::DotProductCube],
    ];
    let (mut pixels, mut defined) = (0, 0);
    for round in 0..42 {
        let (small, squares) = (round % 2 == 0, round % 4 == 1);
        let count = if small { 256 } else { 3 };
        let mut vertices: Vec<Vertex> = (0..count).flat_map(|_| triangle(&mut random, small)).collect();
        if squares {
            vertices = (0..4).flat_map(|_| square(&mut random, 64.0)).collect();
        }
        // Normals come from layers of a volume in some rounds, or from comparisons of depths.
        let third = match round % 7 {
            1 => Third::Layers(random.of(&[AddressMode::Wrap, AddressMode::ClampToEdge])),
            3 | 4 => Third::Reference(random.of(DEPTHS)),
            _ => Third::Nothing,
        };
        if third != Third::Nothing {
            let (times, set) = (steps(&mut random, third), random.of(&[2, 3]));
            for vertex in &mut vertices {
                let [s, t, r, q] = vertex.texture_coordinates[set];
                vertex.texture_coordinates[0] = [s, t, r * times, q];
            }
        }
        let program = programs[round / 2 % programs.len()];
        for vertex in &mut vertices {
            let near = vertex.texture_coordinates[0];
            for (n, operation) in program.iter().enumerate().skip(1) {
                let bumps = matches!(operation, O::BumpEnvironment { .. });
                vertex.texture_coordinates[n] = if bumps { near } else { [0; 4].map(|_| random.unit() * 2.0 - 0.5) };
            }
            // They are divided by q in others.
            if round % 5 == 2 && third == Third::Nothing {
                vertex.texture_coordinates[0] = vertex.texture_coordinates[2];
            }
        }
        let filter = random.of(&[Filter::Linear, Filter::Nearest]);
        let of = |third| scene(vertices.clone(), filter, DepthFormat::Z24S8, None, [true; 2], (third, false, 1));
        let [flat, cube, _, levels] = of(Third::Nothing).draws[0].textures;
        let mut scene = of(third);
        let draw = &mut scene.draws[0];
        let first = match third {
            Third::Nothing if round % 3 == 0 => flat,
            Third::Nothing => levels,
            _ => draw.textures[3],
        };
        draw.textures = std::array::from_fn(|n| match program[n] {
            O::Sample => first,
            operation if !operation.samples() => None,
            O::DotReflectSpecular | O::DotProductCube | O::DotReflectConstantEye { .. } => cube,
            _ => levels,
        });
        // Texels of one of sixteen colours drop their fragments.
        if round % 8 == 5 {
            let TextureImage::Texels(texels) = &mut scene.textures[2].image else { panic!("texels") };
            texels.words = texels.words.iter().map(|word| word & 0x0101_0101).collect::<Vec<u32>>().into();
            for unit in draw.textures.iter_mut().skip(1).flatten().filter(|unit| unit.texture == 2) {
                (unit.min_filter, unit.mag_filter, unit.mip_filter) =
                    (Filter::Nearest, Filter::Nearest, MipFilter::Nearest);
                unit.color_key = Some(ColorKey { color: [0; 4], mode: ColorKeyMode::Texel });
            }
        }
        draw.texture_shader = std::array::from_fn(|n| ShaderStage {
            operation: program[n],
            previous: if program[n] == O::DependentGreenBlue { 2 } else { 0 },
            ..ShaderStage::conventional(n, true)
        });
        let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
        let (drawn, by_definition) = compare(&plan, &format!("{program:?}, round {round}"));
        (pixels, defined) = (pixels + drawn, defined + by_definition);
    }
    println!("{pixels} pixels, {defined} of them by the scalar engine");
    assert!(defined * 10 < pixels);
}

/// Compares textures of another kind than their stage (TEX-20), which the definition draws for levels only. Sides of flat ones differ.
#[test]
fn textures_of_another_kind_are_those_of_the_definition() {
    use ShaderOperation as O;
    let mut random = Random::seeded(0x94d0_49bb_1331_11eb);
    let eye = O::DotReflectConstantEye { eye: [0.5, -0.25, 1.0] };
    let programs = [
        [O::SampleCube, O::Sample2D, O::SampleCube, O::Sample2D],
        [O::Sample, O::DotProduct, O::DotProduct, O::DotProductCube],
        [O::Sample, O::DotProduct, O::DotProduct, O::DotReflectSpecular],
        [O::Sample, O::DotProduct, O::DotReflectDiffuse, eye],
        [O::Sample, O::DotProduct, O::DotProduct, O::DotProduct3D],
    ];
    let (mut pixels, mut defined) = (0, 0);
    for round in 0..60 {
        let small = round % 3 == 0;
        let mut vertices: Vec<Vertex> =
            (0..if small { 256 } else { 4 }).flat_map(|_| triangle(&mut random, small)).collect();
        let (program, has_faces) = (programs[round % programs.len()], (round / programs.len()).is_multiple_of(2));
        for vertex in &mut vertices {
            match program[0] {
                O::SampleCube => {
                    let [plane, direction, ratio, _] = vertex.texture_coordinates;
                    vertex.texture_coordinates = [direction, ratio, ratio, plane];
                }
                _ => {
                    for set in &mut vertex.texture_coordinates[1..] {
                        *set = [0; 4].map(|_| if round % 4 == 0 { wild(&mut random) } else { random.unit() - 0.5 });
                        set[3] *= if has_faces && program[3] == O::DotProduct3D { 0.0 } else { 1.0 };
                    }
                }
            }
        }
        let filter = random.of(&[Filter::Linear, Filter::Nearest]);
        let mut scene = scene(vertices, filter, DepthFormat::Z24S8, None, [false; 2], (Third::Nothing, false, 1));
        let side = random.of(&[32, 64, 128]);
        if let TextureImage::Texels(texels) = &mut scene.textures[0].image {
            (texels.width, texels.height) = (side, 64 * 64 / side);
        }
        let draw = &mut scene.draws[0];
        let mode = random.of(AddressMode::ALL);
        let [flat, cube, ..] = draw.textures;
        let flat = flat.map(|unit| TextureUnit { address_s: mode, border_color: [9, 200, 77, 255], ..unit });
        draw.textures = program.map(|operation| match operation {
            O::Sample2D => cube,
            O::DotProduct3D if has_faces => cube,
            operation => flat.filter(|_| operation.samples()),
        });
        draw.texture_shader = std::array::from_fn(|n| ShaderStage {
            operation: program[n],
            previous: 0,
            mapping: random.of(DotMapping::ALL),
            ..ShaderStage::conventional(n, true)
        });
        let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
        let (drawn, by_definition) = compare(&plan, &format!("{program:?}, round {round}"));
        (pixels, defined) = (pixels + drawn, defined + by_definition);
    }
    println!("{pixels} pixels, {defined} of them by the scalar engine");
    assert!(defined < pixels / 2);
}
