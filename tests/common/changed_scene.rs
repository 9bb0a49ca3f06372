//! Changes a scene at random: its vertices, and the state that decides how its triangles are drawn. What scenes are made for stays, so the
//! changed ones get where scenes from nothing seldom do. Not every one is legal.

use ninebit::random::Random;
use ninebit::state::*;

/// Changes the draws, each by a few things.
pub fn change(scene: &mut Scene, random: &mut Random) {
    let blends: Vec<Option<Blend>> = scene.draws.iter().map(|draw| draw.blend).collect();
    for draw in &mut scene.draws {
        for _ in 0..random.below(4) {
            change_vertices(&mut draw.vertices, random);
        }
        for unit in draw.textures.iter_mut().flatten() {
            for _ in 0..random.below(3) {
                change_unit(unit, random);
            }
        }
        change_tests(draw, scene.targets[draw.target].depth.is_some(), random);
        if random.once_in(4) {
            draw.blend = blends[random.below(blends.len() as u128) as usize];
        }
    }
}

fn of<T: Copy>(random: &mut Random, values: &[T]) -> T {
    random.pick(values).unwrap()
}

/// Changes one thing of all vertices, or of some.
fn change_vertices(vertices: &mut Vertices, random: &mut Random) {
    let (kind, set, axis) = (random.below(13), random.below(4) as usize, random.below(4) as usize);
    let by: f32 = of(random, &[0.0, 0.25, 0.5, 1.0, 1.25, -1.0, 3.0, 8.0, 0.015_625, 100.0]);
    let part = of(random, &[1, 1, 2, 3]);
    let mut noise = random.clone();
    let mut noise = move || (noise.below(4001) as f32 - 2000.0) / 1000.0;
    vertices.update(|n, vertex| {
        if n % part != 0 {
            return;
        }
        let (position, coordinates) = (&mut vertex.position, &mut vertex.texture_coordinates[set]);
        match kind {
            0 => position[..2].iter_mut().for_each(|x| *x += noise()),
            // On centres of pixels, or on their corners.
            1 => position[..2].iter_mut().for_each(|x| *x = x.floor() + if part == 1 { 0.5 } else { 0.0 }),
            // Slivers.
            2 => position[1] = position[0] + 0.02 * position[1],
            3 => position[..2].iter_mut().for_each(|x| *x *= if by == 0.25 { 0.25 } else { 0.9 }),
            4 => position[3] *= 1.0 + noise().abs(),
            5 => position[3] = 1.0 + (n % 3) as f32 * by.abs(),
            6 => position[2] = (position[2] * by).clamp(0.0, 1.0),
            7 => coordinates[axis] *= by,
            8 => coordinates[axis] = by,
            // Whole texels of many textures.
            9 => coordinates[..3].iter_mut().for_each(|s| *s = (*s * 64.0).floor() / 64.0),
            10 => coordinates[..3].iter_mut().for_each(|s| *s += noise()),
            11 => coordinates[3] = 1.0 + noise(),
            _ => vertex.fog *= by,
        }
    });
}

fn change_unit(unit: &mut TextureUnit, random: &mut Random) {
    match random.below(8) {
        0 => unit.min_filter = of(random, Filter::ALL),
        1 => unit.mag_filter = of(random, Filter::ALL),
        2 => unit.mip_filter = of(random, MipFilter::ALL),
        3 => (unit.address_s, unit.address_t) = (of(random, AddressMode::ALL), of(random, AddressMode::ALL)),
        4 => unit.lod_bias += random.below(1025) as i32 - 512,
        5 => unit.anisotropy = of(random, &[1, 2, 4, 8]),
        6 => unit.signed[random.below(4) as usize] ^= true,
        _ => unit.cylindrical_wrap[random.below(2) as usize] ^= true,
    }
}

fn change_tests(draw: &mut Draw, has_depth: bool, random: &mut Random) {
    match random.below(10) {
        0 if has_depth => draw.depth_test = Some(DepthTest::new(of(random, CompareFunction::ALL), random.once_in(2))),
        1 => draw.depth_test = None,
        2 => draw.cull = of(random, Cull::ALL),
        3 => draw.color_mask[random.below(4) as usize] ^= true,
        4 => draw.shade_model = of(random, ShadeModel::ALL),
        5 => draw.perspective ^= true,
        6 => {
            let mut number = || random.below(200) as u32;
            draw.scissor = Some(Rectangle { x: number(), y: number(), width: number() + 1, height: number() + 1 });
        }
        7 => draw.alpha_test = None,
        _ => {}
    }
}
