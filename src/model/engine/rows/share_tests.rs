//! Kinds of draws of which rows compute nearly everything: cube maps with levels across faces, and levels, taps and colour keys with and
//! without a texture shader.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, reason = "choosing triangles; a test fails by panicking")]

use super::equivalence_tests::{Random, Third, options, scene};
use super::shader_tests::compare;
use crate::plan::Plan;
use crate::state::*;

/// Columns and rows of the mesh.
const SIDES: [f32; 2] = [160.0, 120.0];

/// Returns a rectangle, cut into so many columns and rows. Everything is random in its corners, and bilinear between them.
fn mesh(r: &mut Random, cells: u32) -> Vec<Vertex> {
    let (left, top) = (r.below(64) as f32, r.below(64) as f32);
    let dense = r.of(&[2.0, 10.0, 40.0]);
    let corners = [0; 4].map(|_| {
        let w = 1.0 + r.unit();
        let direction = [0; 3].map(|_| 2.0 * r.unit() - 1.0);
        (w, direction, [0; 4].map(|_| dense * r.unit()))
    });
    let at = |x: u32, y: u32| {
        let (x, y) = (x as f32 / cells as f32, y as f32 / cells as f32);
        let weights = [(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y];
        let mix = |of: &dyn Fn(usize) -> f32| (0..4).map(|n| weights[n] * of(n)).sum::<f32>();
        let direction = [0, 1, 2].map(|axis| mix(&|n| corners[n].1[axis]));
        let [s, t, a, b] = [0, 1, 2, 3].map(|k| mix(&|n| corners[n].2[k]));
        let texture_coordinates = [
            [s, t, 0.0, 1.0],
            [direction[0], direction[1], direction[2], 1.0],
            [a, b, 0.0, 1.0],
            [s / dense, t / dense, a / dense, b / dense],
        ];
        let position = [left + x * SIDES[0], top + y * SIDES[1], 0.5, mix(&|n| corners[n].0)];
        Vertex { position, texture_coordinates, ..Vertex::default() }
    };
    let cell = |n: u32| {
        let (x, y) = (n % cells, n / cells);
        [(0, 0), (1, 0), (0, 1), (1, 0), (1, 1), (0, 1)].map(|(right, below)| at(x + right, y + below))
    };
    (0..cells * cells).flat_map(cell).collect()
}

#[test]
fn the_definition_computes_less_than_a_twentieth() {
    let mut random = Random::seeded(0x8cb9_2ba7_2f3d_8dd7);
    let mut all = [[0; 2]; 4];
    for round in 0..48 {
        let kind = round % 4;
        let (levels, keyed) = ([kind == 0, kind == 1 || kind == 3], kind == 3);
        let filter = if keyed { Filter::Nearest } else { random.of(&[Filter::Linear, Filter::Nearest]) };
        let taps = if kind == 2 { random.of(&[2, 4, 8]) } else { 1 };
        let cells = random.of(&[1, 4, 13]);
        let vertices = mesh(&mut random, cells);
        let mut scene = scene(vertices, filter, DepthFormat::Z24S8, None, levels, (Third::Nothing, false, taps));
        if kind == 2 && random.below(2) == 0 {
            scene.textures[0].format = TextureFormat::R16B16;
        }
        let draw = &mut scene.draws[0];
        draw.textures[3] = None;
        draw.textures[0].as_mut().unwrap().signed = [random.below(4) == 0; 4];
        if keyed {
            let image = &mut scene.textures[2].image;
            let TextureImage::Texels(texels) = image else { panic!("texels") };
            texels.words = texels.words.iter().map(|word| word & 0x0101_0101).collect::<Vec<u32>>().into();
            let unit = draw.textures[2].as_mut().unwrap();
            unit.min_filter = Filter::Nearest;
            // One of sixteen texels.
            unit.color_key = Some(ColorKey { color: [0; 4], mode: ColorKeyMode::Texel });
            unit.signed[0] = random.below(2) == 0;
            if random.below(2) == 0 {
                unit.mip_filter = MipFilter::None;
            }
        }
        draw.texture_shader[3] = ShaderStage::conventional(3, false);
        if random.below(2) == 0 {
            draw.texture_shader[3].operation = ShaderOperation::PassThrough;
        }
        let plan = Plan::compile(&scene, &options(round % 3 == 0)).unwrap();
        let (drawn, defined) = compare(&plan, &format!("round {round}"));
        all[kind][0] += drawn;
        all[kind][1] += defined;
    }
    println!("{all:?}");
    assert!(all.iter().all(|[drawn, defined]| defined * 20 < *drawn), "{all:?}");
}
