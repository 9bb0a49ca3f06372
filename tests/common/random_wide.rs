//! Wider random scenes. A plain random scene is changed: draws share meshes, textures and programs, use extreme numbers and programs of
//! other languages, and pass the viewer. A change that the chip does not allow is undone.

#[path = "random_broad.rs"]
pub mod broad;
#[path = "random_extreme.rs"]
pub mod extreme;
#[path = "random_front_end.rs"]
mod front_end;

use super::{Choices, PLAIN, SceneParts, Tape, build, texture};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;
use proptest::prelude::*;

/// Numbers of tape words in addition to those of a plain scene: for each draw, and for all changes.
const WIDER_DRAW: usize = 800;
const WIDER: usize = 256 + 4 * WIDER_DRAW;
/// Number of tape words of a plain scene.
const FIRST: usize = PLAIN;

/// Returns valid scenes, most of them of kinds that [`scene`](super::scene) does not return.
pub fn scene() -> BoxedStrategy<Scene> {
    Tape(FIRST + WIDER).prop_map(|tape| widened(&tape)).prop_filter("RAS-0", legal).boxed()
}

fn legal(scene: &Scene) -> bool {
    Plan::compile(scene, &PlanOptions::default()).is_ok()
}

/// Builds the scene of a tape.
fn widened(tape: &[u32]) -> Scene {
    let (first, rest) = tape.split_at(FIRST.min(tape.len()));
    let mut scene = build(first);
    let mut tape = Choices { tape: rest };
    let mut shared = tape.part(256);
    let mut c = shared.part(128);
    for texture in 0..scene.textures.len() {
        let c = &mut c.part(8);
        attempt(&mut scene, |scene| texture_format(c, &mut scene.textures[texture]));
    }
    for target in 0..scene.targets.len() {
        let c = &mut shared.part(8);
        attempt(&mut scene, |scene| {
            if c.once_in(3) {
                scene.targets[target].format = c.any();
            }
        });
        let (c, target) = (&mut shared.part(8), &mut scene.targets[target]);
        if c.once_in(4) {
            target.clip = Some(rectangle(c, target.width, target.height));
        }
        if let Some(depth) = &mut target.depth
            && depth.format.has_stencil()
            && c.once_in(2)
        {
            depth.clear_stencil = c.byte();
        }
        if scene.profile == Profile::Nv2a
            && let Some(depth) = &mut target.depth
            && c.once_in(3)
        {
            depth.format = if depth.format.has_stencil() { DepthFormat::Z24S8F } else { DepthFormat::Z16F };
            // The depths of the vertices, which are 0 to 1 or whole steps, lie on both sides of this value.
            depth.clear =
                if depth.format.has_stencil() { 0x3f_0000 + c.below(0x10_0000) } else { 0x6000 + c.below(0xa000) };
        }
    }
    for index in 0..scene.draws.len() {
        let mut c = tape.part(WIDER_DRAW);
        for change in CHANGES {
            let mut c = c.part(WIDER_DRAW / CHANGES.len());
            attempt(&mut scene, |scene| change(&mut c, scene, index));
        }
    }
    scene
}

/// Applies a change, and undoes it if it makes a legal scene illegal.
fn attempt(scene: &mut Scene, change: impl FnOnce(&mut Scene)) {
    let before = scene.clone();
    change(scene);
    if *scene != before && !legal(scene) && legal(&before) {
        *scene = before;
    }
}

type Change = fn(&mut Choices<'_>, &mut Scene, usize);

/// The changes to a draw, in order.
const CHANGES: [Change; 12] = [
    share_mesh,
    share_texture,
    front_end::change,
    share_program,
    view,
    extreme_w,
    extreme_coordinates,
    lods,
    stencil_and_clips,
    color_keys,
    depths,
    samplings,
];

/// Returns a rectangle that begins within the target. It may be empty.
fn rectangle(c: &mut Choices<'_>, width: u32, height: u32) -> Rectangle {
    Rectangle { x: c.below(width), y: c.below(height), width: c.below(width + 2), height: c.below(height + 2) }
}

/// Adds a stencil test, if the target has a stencil buffer, and a window clip.
fn stencil_and_clips(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let draw = &mut scene.draws[index];
    let target = &scene.targets[draw.target];
    if target.depth.is_some_and(|depth| depth.format.has_stencil()) && c.below(3) != 0 {
        draw.stencil_test = Some(StencilTest {
            function: if c.once_in(2) { CompareFunction::Always } else { c.any() },
            reference: c.byte(),
            mask: if c.once_in(3) { c.byte() } else { 255 },
            write_mask: if c.once_in(3) { c.byte() } else { 255 },
            fail: c.any(),
            depth_fail: c.any(),
            pass: c.any(),
        });
    }
    if c.once_in(4) {
        let count = c.size(1, WINDOW_CLIP_RECTANGLES as u32);
        let rectangles = (0..count).map(|_| rectangle(c, target.width, target.height)).collect();
        draw.window_clip = Some(WindowClip { rectangles, exclusive: c.once_in(2) });
    }
}

/// Gives a draw depths in steps, within the buffer's range and beyond it, a depth range, an offset, or a w buffer.
#[allow(clippy::float_arithmetic, reason = "choosing depths")]
fn depths(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let Scene { targets, draws, .. } = scene;
    let draw = &mut draws[index];
    let (Some(test), Some(buffer)) = (&mut draw.depth_test, targets[draw.target].depth) else { return };
    let full = buffer.format.largest();
    // Steps are sixteenths or whole numbers, so that the oracle's integers do not overflow.
    let step = |c: &mut Choices<'_>| {
        let whole = (c.word() % (full + full / 4)) as f32;
        match c.below(4) {
            0 => whole / 16.0,
            1 => -whole / 16.0,
            2 => f32::from(c.byte()),
            _ => whole,
        }
    };
    if c.once_in(2) && matches!(draw.positions, Positions::Window) {
        test.vertex_depths = VertexDepths::Steps;
        draw.vertices.map_positions(|[x, y, _, w]| [x, y, step(c), w]);
    }
    if c.once_in(3) {
        let (a, b) = (step(c), step(c));
        test.range = Some(DepthRange {
            lowest: a.min(b),
            highest: a.max(b),
            clamps: c.once_in(2),
            drops_triangles: c.once_in(3),
        });
    }
    if c.once_in(3) {
        test.offset = PolygonOffset { bias: step(c), factor: f32::from(c.byte()) / 16.0 - 4.0 };
    }
    if c.once_in(5) {
        (test.w_buffer, test.offset.factor) = (true, 0.0);
        if c.once_in(2) {
            // Scales w so that it spans many steps of the buffer.
            let scale = c.pick(&[16.0, 1024.0, 65536.0]);
            draw.vertices.map_positions(|[x, y, z, w]| [x, y, z, (w * scale).min(1_048_576.0)]);
        }
    }
}

/// Adds colour keys. Most of them are the colour of a texel.
fn color_keys(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let Scene { textures, palettes, draws, .. } = scene;
    for unit in draws[index].textures.iter_mut().flatten() {
        let mut c = c.part(12);
        if !c.once_in(4) {
            continue;
        }
        let mut word = c.word();
        if let (TextureImage::Texels(texels), 0..3) = (&textures[unit.texture].image, c.below(4)) {
            word = texels.words[c.word() as usize % texels.words.len()];
        }
        let format = textures[unit.texture].format;
        let bytes = match (format, unit.palette) {
            (TextureFormat::P8, Some(palette)) => {
                let entries = &palettes[palette].entries;
                let [b, g, r, a] = entries[word as usize & (entries.len() - 1)].to_le_bytes();
                [r, g, b, a]
            }
            _ if format.is_compressed() || format == TextureFormat::P8 => c.bytes(),
            _ => ninebit::texture::format::expand(format, word),
        };
        unit.color_key = Some(ColorKey { color: bytes, mode: c.any() });
        (unit.min_filter, unit.mag_filter) = (Filter::Nearest, Filter::Nearest);
        unit.mip_filter = [MipFilter::None, MipFilter::Nearest][c.below(2) as usize];
    }
}

/// Makes units compare depths, read volumes, take several taps, wrap cylindrically, or sample textures of another kind.
#[allow(clippy::float_arithmetic, reason = "choosing coordinates")]
fn samplings(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let function = c.any();
    for k in 0..scene.profile.texture_units() {
        let c = &mut c.part(14);
        if scene.draws[index].textures[k].is_none() {
            continue;
        }
        match c.below(6) {
            0 => attempt(scene, |scene| compares(c, scene, (index, k), function)),
            1 => attempt(scene, |scene| reads_layers(c, scene, (index, k))),
            2 => attempt(scene, |scene| {
                let set = scene.draws[index].texture_shader[k].coordinate_set;
                let Some(unit) = &mut scene.draws[index].textures[k] else { return };
                unit.anisotropy = 2 << c.below(3);
                let stretch = c.pick(&[1.0, 6.0, 40.0]);
                (unit.min_filter, unit.mip_filter, unit.color_key) = (unit.mag_filter, MipFilter::None, None);
                scene.draws[index].vertices.update(|_, vertex| vertex.texture_coordinates[set][1] *= stretch);
            }),
            3 => attempt(scene, |scene| {
                let Some(unit) = &mut scene.draws[index].textures[k] else { return };
                unit.cylindrical_wrap = [c.once_in(2), c.below(3) != 0];
            }),
            _ => attempt(scene, |scene| texture::other_kind(scene, (index, k))),
        }
    }
}

/// Makes a unit compare with a depth buffer, or with a texture whose words are taken as depths, and sets r near these depths.
#[allow(clippy::float_arithmetic, reason = "choosing coordinates")]
fn compares(c: &mut Choices<'_>, scene: &mut Scene, (draw, k): (usize, usize), function: CompareFunction) {
    let target = c.below(scene.targets.len() as u32) as usize;
    let buffer = scene.targets[target].depth.filter(|_| target != scene.draws[draw].target && c.once_in(2));
    let Some(unit) = &mut scene.draws[draw].textures[k] else { return };
    let mut texture = scene.textures[unit.texture].clone();
    if let Some(buffer) = buffer {
        let formats: Vec<TextureFormat> = TextureFormat::ALL
            .iter()
            .copied()
            .filter(|f| f.depth().is_some_and(|depth| depth.bits() == buffer.format.bits()))
            .collect();
        (texture.kind, texture.format) = (TextureKind::Rectangle, c.pick(&formats));
        texture.image = TextureImage::Depth { target };
    } else if let TextureImage::Texels(texels) = &texture.image {
        let format = c.pick(&[TextureFormat::Z16, TextureFormat::Z24S8, TextureFormat::Z16F, TextureFormat::Z24S8F]);
        let bits = if format.bytes() == 2 { 16 } else { 32 };
        let count = texels.width as usize * texels.height as usize;
        // A few different words, so that many comparisons meet equal ones.
        let words = texels.words.iter().cycle().take(count).map(|word| (word % 8 * 0x1111) << (bits - 16)).collect();
        let texels = Texels { levels: 1, layers: 1, border: false, words, ..*texels };
        (texture.format, texture.image) = (format, TextureImage::Texels(texels));
        if texture.kind == TextureKind::Cube {
            texture.kind = TextureKind::TwoDimensional;
        }
    }
    let format = texture.format;
    scene.textures.push(texture);
    unit.texture = scene.textures.len() - 1;
    unit.shadow = Some(ShadowComparison { function, reference: c.any() });
    (unit.min_filter, unit.mag_filter, unit.mip_filter) = (Filter::Nearest, Filter::Nearest, MipFilter::None);
    (unit.signed, unit.color_key, unit.palette) = ([false; 4], None, None);
    for mode in [&mut unit.address_s, &mut unit.address_t] {
        if *mode == AddressMode::ClampToBorder {
            *mode = AddressMode::Wrap;
        }
    }
    let draw = &mut scene.draws[draw];
    draw.texture_shader[k].operation = ShaderOperation::Sample;
    let (set, steps) = (draw.texture_shader[k].coordinate_set, c.below(8) as f32);
    let full = format.depth().map_or(0, DepthFormat::largest) as f32;
    let base = if format.depth().is_some_and(DepthFormat::is_float) { 0.125 } else { steps * full / 15.0 };
    let sloped = c.once_in(2);
    draw.vertices.update(|n, vertex| {
        let across = if sloped { (n % 3) as f32 * base * 0.25 } else { 0.0 };
        vertex.texture_coordinates[set][2] = (base + across).floor() * vertex.texture_coordinates[set][3];
    });
}

/// Replaces the texture of a unit by one with layers.
#[allow(clippy::float_arithmetic, reason = "choosing coordinates")]
fn reads_layers(c: &mut Choices<'_>, scene: &mut Scene, (draw, k): (usize, usize)) {
    let Some(unit) = &mut scene.draws[draw].textures[k] else { return };
    let mut texture = scene.textures[unit.texture].clone();
    let TextureImage::Texels(texels) = &texture.image else { return };
    let layers = 1 << c.below(4);
    let count = layers as usize * texture.format.words(texels.width, texels.height);
    let words = texels.words.iter().cycle().take(count).copied().collect();
    let texels = Texels { levels: 1, layers, border: false, words, ..*texels };
    (texture.kind, texture.image) = (TextureKind::ThreeDimensional, TextureImage::Texels(texels));
    scene.textures.push(texture);
    unit.texture = scene.textures.len() - 1;
    unit.address_r = c.any();
    (unit.min_filter, unit.mag_filter, unit.mip_filter) = (Filter::Nearest, Filter::Nearest, MipFilter::None);
    let draw = &mut scene.draws[draw];
    draw.texture_shader[k].operation = ShaderOperation::Sample;
    let (set, from) = (draw.texture_shader[k].coordinate_set, c.between(-1.5, 1.5));
    let step = c.pick(&[0.0, 0.25, 0.3]);
    draw.vertices.update(|n, vertex| {
        vertex.texture_coordinates[set][2] = from + (n % 4) as f32 * step;
    });
    if c.once_in(3) {
        draw.texture_shader[k].operation = ShaderOperation::Sample2D;
    }
}

/// Changes the format in which words are read. For render targets the texels often have another size.
fn texture_format(c: &mut Choices<'_>, texture: &mut Texture) {
    if c.once_in(2) {
        let resizes = matches!(texture.image, TextureImage::Target { .. }) && c.below(3) != 0;
        let bytes = texture.format.bytes();
        let fitting: Vec<TextureFormat> = TextureFormat::ALL
            .iter()
            .copied()
            .filter(|f| (f.bytes() != bytes) == resizes && f.is_compressed() == texture.format.is_compressed())
            .filter(|f| *f != TextureFormat::P8 && f.depth().is_none())
            .collect();
        if resizes {
            texture.kind = TextureKind::Rectangle;
        }
        if texture.format != TextureFormat::P8 {
            texture.format = c.pick(&fitting);
        }
    }
}

/// Gives the draw the mesh of another draw, with other state.
fn share_mesh(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let from = c.below(scene.draws.len() as u32) as usize;
    if !c.once_in(3) || from == index {
        return;
    }
    let Draw { vertices, indices, topology, positions, .. } = scene.draws[from].clone();
    let draw = &mut scene.draws[index];
    (draw.vertices, draw.indices, draw.topology, draw.positions) = (vertices, indices, topology, positions);
    (draw.shade_model, draw.provoking_vertex, draw.perspective) = (c.any(), c.any(), c.below(3) != 0);
}

/// Makes all units of the draw and of the next one sample the same texture, each unit with state of its own.
fn share_texture(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    if !c.once_in(2) {
        return;
    }
    let one = c.below(scene.textures.len() as u32) as usize;
    let given = SceneParts {
        profile: scene.profile,
        targets: &scene.targets,
        textures: &scene.textures,
        palettes: scene.palettes.len(),
    };
    let same_filters = c.once_in(2);
    let mut first: Option<TextureUnit> = None;
    for draw in [index, (index + 1) % scene.draws.len()] {
        for k in 0..scene.profile.texture_units() {
            let mut c = c.part(16);
            let mut unit = texture::unit(&mut c, &given, &[one]);
            if let (Some(first), true) = (first, same_filters) {
                // Only mip filter and lod limits differ between the samplers.
                unit = TextureUnit { mip_filter: unit.mip_filter, max_lod: unit.max_lod, ..first };
                unit.min_lod = unit.min_lod.min(unit.max_lod);
            }
            first.get_or_insert(unit);
            let draw = &mut scene.draws[draw];
            let idle = draw.texture_shader[k].operation == ShaderOperation::None;
            if draw.textures[k].is_some() || idle {
                draw.textures[k] = Some(unit);
            }
            if idle {
                draw.texture_shader[k].operation = ShaderOperation::Sample;
            }
        }
    }
}

/// Gives the draw the program of another draw.
fn share_program(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let from = c.below(scene.draws.len() as u32) as usize;
    if c.once_in(4) {
        scene.draws[index].combiners = scene.draws[from].combiners.clone();
        scene.draws[index].program_origin = scene.draws[from].program_origin.clone();
    }
}

/// Places the vertices around the viewer in perspective, some of them behind the viewer and some far away.
fn view(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    if c.below(3) != 2 {
        return;
    }
    let target = &scene.targets[scene.draws[index].target];
    let (width, height) = (target.width as f32, target.height as f32);
    let (near, far) = (c.pick(&[0.1, 1.0, 0.001]), c.pick(&[10.0, 100.0, 4.0]));
    let [a, b] = [-(far + near) / (far - near), -2.0 * far * near / (far - near)];
    let reach = c.pick(&[1.0, 4.0, 30.0, 1000.0, 1e6]);
    let floor = c.once_in(3);
    let (clip_depth, depth_clamp) = (c.any(), c.once_in(5));
    let (x, y) = if c.once_in(3) { (c.between(-40.0, 40.0), c.between(-40.0, 40.0)) } else { (0.0, 0.0) };
    let port = Viewport {
        x,
        y,
        width,
        height,
        near: c.pick(&[0.0, 1.0, 0.25]),
        far: c.pick(&[1.0, 0.0, 0.75]),
        clip_depth,
        depth_clamp,
    };
    let draw = &mut scene.draws[index];
    draw.positions = Positions::Clip(port);
    draw.vertices.update(|n, vertex| {
        let mut c = if n < 8 { c.part(4) } else { Choices { tape: &[] } };
        let [px, py, ..] = vertex.position.map(|p| if p.is_finite() { p.clamp(-4096.0, 4096.0) } else { 0.0 });
        let side = reach * (px / width - 0.5) + c.between(-0.1, 0.1);
        let up = if floor { -1.0 } else { reach * (0.5 - py / height) + c.between(-0.1, 0.1) };
        let ahead = c.pick(&[-4.0, -1.0, -2.0, 0.0, 2.0, -9.0, -300.0, -near]) + c.between(-0.5, 0.5);
        vertex.position = [side, up, a * ahead + b, -ahead];
    });
}

/// Returns a power of two from 2^`least` to 2^`most`, or a number up to twice as large.
fn extreme(c: &mut Choices<'_>, least: i32, most: i32) -> f32 {
    let mut c = c.part(4);
    let power = (least + c.below((most - least + 1) as u32) as i32) as f32;
    let number = power.exp2() * if c.once_in(2) { c.between(1.0, 2.0) } else { 1.0 };
    number.min((most as f32).exp2())
}

/// Sets w to values from 2^-20 to 2^20, either the same for all vertices or one for each.
fn extreme_w(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let draw = &mut scene.draws[index];
    if !c.once_in(3) || draw.positions != Positions::Window {
        return;
    }
    let (least, most) = c.pick(&[(-20, 20), (-20, -10), (10, 20), (-4, 4), (0, 20), (-20, 0)]);
    let same = c.once_in(4).then(|| extreme(c, least, most));
    draw.vertices.update(|n, vertex| {
        let mut c = if n < 12 { c.part(4) } else { Choices { tape: &[] } };
        let w = same.unwrap_or_else(|| extreme(&mut c, least, most));
        vertex.position[3] = w.clamp(1.0 / 1_048_576.0, 1_048_576.0);
    });
}

/// Sets q to values from 2^-20 to 2^20 of either sign, or coordinates of up to 65536 texels.
fn extreme_coordinates(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    if c.below(2) == 0 {
        return;
    }
    let style = c.below(5);
    let set = c.below(4) as usize;
    let side = c.pick(&[1.0, 4.0, 16.0, 64.0]);
    let (least, most) = c.pick(&[(-20, 20), (-20, -10), (10, 20), (-3, 3)]);
    let same = extreme(c, least, most);
    scene.draws[index].vertices.update(|n, vertex| {
        let mut c = if n < 10 { c.part(6) } else { Choices { tape: &[] } };
        let [s, t, r, q] = &mut vertex.texture_coordinates[set];
        match style {
            0 => {
                let number = extreme(&mut c, least, most);
                (*s, *t, *q) = (*s * number, *t * number, number);
            }
            1 => *q = extreme(&mut c, least, most) * if c.once_in(3) { -1.0 } else { 1.0 },
            2 => (*s, *t, *q) = (*s * same, *t * same, same),
            3 => {
                let far = 65536.0 / side;
                (*s, *t, *q) = (c.pick(&[far, -far, far - 1.0, 0.0]), c.pick(&[-far, far, 0.5, 0.0]), 1.0);
            }
            _ => {
                let number = extreme(&mut c, least, most);
                (*s, *t, *r) = (*s * number, *t * number, *r * number);
            }
        }
    });
}

/// Sets the lod bias and limits to values at the ends of their ranges and next to whole levels.
fn lods(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    for unit in scene.draws[index].textures.iter_mut().flatten() {
        let mut c = c.part(8);
        if !c.once_in(3) {
            continue;
        }
        unit.mip_filter = c.any();
        unit.lod_bias = c.pick(&[-4096, 4095, 0, 255, 256, 257, -1, -255]);
        unit.max_lod = c.pick(&[4095, 0, 1, 255, 256, 257, 1024]);
        unit.min_lod = c.pick(&[0, 0, 1, 255, 256, 512]).min(unit.max_lod);
    }
}
