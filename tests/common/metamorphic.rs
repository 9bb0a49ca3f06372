//! Relations between pictures of changed scenes, which need no second engine: they see faults that both engines share.

use super::frames::difference;
use ninebit::engine::{RenderOptions, cleared, render};
use ninebit::frame::Frames;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::state::*;
use ninebit_program::registers::{decode, encode};
use ninebit_program::text;

/// A relation between a scene with its picture and a changed scene. Returns whether the scene has something to change, or the first difference
/// of the changed picture.
pub type Relation = fn(&Scene, &Frames, &mut Random) -> Result<bool, String>;

/// The relations and their names.
pub const RELATIONS: [(&str, Relation); 4] = [
    ("a clip is a mask", clip_is_mask),
    ("a sampled target is its words as a texture", target_is_texture),
    ("a printed program draws the same", printed_program),
    ("two parts of a mesh are the whole", parts_are_whole),
];

/// Checks all relations of a scene that can be planned. Returns which of them it has something to change for.
///
/// # Errors
/// The first relation that does not hold, with the first pixel that differs.
pub fn check(scene: &Scene, seed: u64) -> Result<[bool; RELATIONS.len()], String> {
    let picture = draw(scene).ok_or("the scene cannot be planned")?;
    let mut random = Random::seeded(seed);
    let mut changes = [false; RELATIONS.len()];
    for ((name, relation), changes) in RELATIONS.iter().zip(&mut changes) {
        *changes = relation(scene, &picture, &mut random).map_err(|difference| format!("{name}: {difference}"))?;
    }
    Ok(changes)
}

fn plan(scene: &Scene) -> Option<Plan> {
    Plan::compile(scene, &PlanOptions::default()).ok()
}

fn draw(scene: &Scene) -> Option<Frames> {
    Some(render(&plan(scene)?, &RenderOptions::default()))
}

/// Compares the picture of a changed scene with what it must be. A scene that is refused after its change differs, too.
fn compare(changed: &Scene, expected: &Frames, what: &str) -> Result<bool, String> {
    let frames = draw(changed).ok_or_else(|| format!("{what}: the changed scene is refused"))?;
    match difference(&frames, expected, "expected") {
        Some(difference) => Err(format!("{what}: {difference}")),
        None => Ok(true),
    }
}

fn contains(of: &Rectangle, x: u32, y: u32) -> bool {
    x >= of.x && y >= of.y && x - of.x < of.width && y - of.y < of.height
}

/// Returns the pixels that two rectangles share.
fn shared(a: &Rectangle, b: &Rectangle) -> Rectangle {
    let (x, y) = (a.x.max(b.x), a.y.max(b.y));
    let end = |start: u32, length: u32| start.saturating_add(length);
    let right = end(a.x, a.width).min(end(b.x, b.width));
    let bottom = end(a.y, a.height).min(end(b.y, b.height));
    Rectangle { x, y, width: right.saturating_sub(x), height: bottom.saturating_sub(y) }
}

/// A surface clip, the scissors of all draws, or their window clips leave pixels as they are drawn without, or as they are before the first draw.
fn clip_is_mask(scene: &Scene, picture: &Frames, random: &mut Random) -> Result<bool, String> {
    if scene.targets.is_empty() {
        return Ok(false);
    }
    let number = random.below(scene.targets.len() as u128) as usize;
    if shows_itself(scene, number) {
        return Ok(false);
    }
    let Target { width, height, .. } = scene.targets[number];
    let mut below = |end: u32| random.below(u128::from(end)) as u32;
    let (x, y) = (below(width), below(height));
    let window = Rectangle { x, y, width: 1 + below(width), height: 1 + below(height) };
    let kind = below(4);
    let mut clipped = scene.clone();
    let mut draws = clipped.draws.iter_mut().filter(|draw| draw.target == number);
    match kind {
        0 => {
            let clip = &mut clipped.targets[number].clip;
            *clip = Some(clip.map_or(window, |clip| shared(&clip, &window)));
        }
        1 => draws.for_each(|draw| {
            draw.scissor = Some(draw.scissor.map_or(window, |scissor| shared(&scissor, &window)));
        }),
        _ => {
            let clip = WindowClip { rectangles: vec![window], exclusive: kind == 3 };
            if draws.any(|draw| draw.window_clip.replace(clip.clone()).is_some()) {
                return Ok(false);
            }
        }
    }
    let mut expected = cleared(&plan(scene).ok_or("no plan")?);
    let (masked, drawn) = (&mut expected.surfaces[number], &picture.surfaces[number]);
    for (n, word) in masked.words.iter_mut().enumerate() {
        let (x, y) = (n as u32 % width, n as u32 / width);
        if contains(&window, x, y) != (kind == 3) {
            *word = drawn.words[n];
            if let Some(depth) = masked.depth.get_mut(n) {
                *depth = drawn.depth[n];
            }
        }
    }
    // Targets that show this one are other pictures.
    let mut frames = draw(&clipped).ok_or("the clipped scene is refused")?;
    let only = |frames: &mut Frames| frames.surfaces.swap_remove(number);
    let (got, expected) = (only(&mut frames), only(&mut expected));
    let [got, expected] = [got, expected].map(|surface| Frames { surfaces: vec![surface] });
    let what = ["clip", "scissor", "window clip", "exclusive window clip"][kind as usize];
    match difference(&got, &expected, "masked") {
        Some(difference) => Err(format!("{what} {window:?} of target {number}: {difference}")),
        None => Ok(true),
    }
}

/// Returns the targets whose pixels a draw may read.
fn shown<'s>(scene: &'s Scene, draw: &'s Draw) -> impl Iterator<Item = usize> + 's {
    draw.textures.iter().flatten().filter_map(|unit| scene.textures[unit.texture].image.target())
}

/// Returns whether pixels of a target may reach it again by way of others.
fn shows_itself(scene: &Scene, target: usize) -> bool {
    let mut holds: Vec<bool> = (0..scene.targets.len()).map(|n| n == target).collect();
    for draw in &scene.draws {
        if shown(scene, draw).any(|other| holds[other]) {
            if draw.target == target {
                return true;
            }
            holds[draw.target] = true;
        }
    }
    false
}

/// Returns whether nothing is drawn into a target after a draw that has bound a texture.
fn is_finished(scene: &Scene, target: usize, texture: usize) -> bool {
    let binds = |draw: &Draw| draw.textures.iter().flatten().any(|unit| unit.texture == texture);
    let reader = scene.draws.iter().position(binds).unwrap_or(scene.draws.len());
    scene.draws[reader..].iter().all(|draw| draw.target != target)
}

/// Textures that show finished targets or their depths may be replaced by what these hold in the end.
fn target_is_texture(scene: &Scene, picture: &Frames, _: &mut Random) -> Result<bool, String> {
    let mut raw = scene.clone();
    for (n, texture) in raw.textures.iter_mut().enumerate() {
        if !texture.image.target().is_some_and(|target| is_finished(scene, target, n)) {
            continue;
        }
        let (shown, words, bytes) = match &texture.image {
            TextureImage::Texels(_) => continue,
            TextureImage::Target { target } => {
                let shown = &picture.surfaces[*target];
                (shown, &shown.words, shown.format.bytes() as usize)
            }
            // Depths are words already.
            TextureImage::Depth { target } => {
                let shown = &picture.surfaces[*target];
                (shown, &shown.depth, texture.format.bytes() as usize)
            }
        };
        let texel = texture.format.bytes() as usize;
        let words = if texel == bytes {
            words.clone()
        } else {
            let memory: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()[..bytes].to_vec()).collect();
            let word = |bytes: &[u8]| bytes.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte));
            memory.chunks(texel).map(word).collect()
        };
        let width = shown.width * bytes as u32 / texel as u32;
        let words = words.into();
        texture.image =
            TextureImage::Texels(Texels { width, height: shown.height, levels: 1, layers: 1, border: false, words });
    }
    if raw == *scene { Ok(false) } else { compare(&raw, picture, "raw textures") }
}

/// Programs survive their text and their register words.
fn printed_program(scene: &Scene, picture: &Frames, _: &mut Random) -> Result<bool, String> {
    let [mut as_text, mut as_words] = [scene.clone(), scene.clone()];
    for (n, draw) in scene.draws.iter().enumerate() {
        if !draw.combiners.stages.is_empty() {
            let printed = text::print(&draw.combiners);
            match text::parse(&printed, scene.profile) {
                Ok(program) => as_text.draws[n].combiners = program.combiners,
                Err(findings) => return Err(format!("text of draw {n} is refused: {findings:?}\n{printed}")),
            }
        }
        match decode(&encode(&draw.combiners, scene.profile)) {
            Ok(combiners) => as_words.draws[n].combiners = combiners,
            Err(why) => return Err(format!("words of draw {n} are refused: {why:?}")),
        }
    }
    compare(&as_text, picture, "text")?;
    compare(&as_words, picture, "register words")
}

/// A draw may be divided between two of its triangles or quads.
fn parts_are_whole(scene: &Scene, picture: &Frames, random: &mut Random) -> Result<bool, String> {
    let number = random.below(scene.draws.len() as u128) as usize;
    let Some(draw) = scene.draws.get(number) else { return Ok(false) };
    let (indices, count) = (&draw.indices, draw.indices.len());
    // Corners of a step, and corners that the second part repeats.
    let (step, repeated) = match draw.topology {
        Topology::Triangles => (3, 0),
        Topology::Quads => (4, 0),
        // An even number of triangles, so that the second part begins with the same winding.
        Topology::TriangleStrip | Topology::QuadStrip => (2, 2),
        Topology::TriangleFan | Topology::Polygon => (1, 1),
        Topology::Points => (1, 0),
        Topology::Lines => (2, 0),
        Topology::LineStrip => (1, 1),
        Topology::LineLoop => return Ok(false),
    };
    // A part of a polygon has edges of its own.
    if draw.topology == Topology::Polygon && draw.polygon_modes != PolygonModes::FILL {
        return Ok(false);
    }
    let around = matches!(draw.topology, Topology::TriangleFan | Topology::Polygon);
    let at = repeated + usize::from(around) + step * random.below(count as u128 / step as u128 + 1) as usize;
    if at >= count {
        return Ok(false);
    }
    let mut divided = scene.clone();
    divided.draws[number].indices = indices[..at].into();
    let mut second = draw.clone();
    let rest = indices[at - repeated..].iter().copied();
    second.indices = if around { std::iter::once(indices[0]).chain(rest).collect() } else { rest.collect() };
    divided.draws.insert(number + 1, second);
    compare(&divided, picture, &format!("draw {number} divided at index {at}"))
}
