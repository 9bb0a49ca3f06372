//! KEY-1: four units in every key mode. Each unit draws two quads of its texture: one with its key, and one with another word as the key.

use super::*;

/// The colour keys of the four units, A8R8G8B8.
const KEYS: [u32; 4] = [0xf000_00ff, 0xf1ff_00ff, 0xf280_0080, 0xf3ff_0000];
/// Words, A8R8G8B8, that take the key's place in the second quad of each unit.
const OTHERS: [u32; 4] = [0xf470_7071, 0xf570_7072, 0xf670_7073, 0xf770_7074];
/// Background colours of the upper two quarters, A8R8G8B8.
const GREYS: [u32; 2] = [0xfdcc_cccc, 0xfe99_9999];

/// Returns the word of a chequered field at a texel; a field has `size` texels a side.
fn checker(x: u32, y: u32, [first, second]: [u32; 2], size: u32) -> u32 {
    if (x / size + y / size).is_multiple_of(2) { first } else { second }
}

/// Returns the texture of a unit. Its quarters alternate between: a grey and the key; a grey and the other word; the key's colour with the other
/// word's alpha and with alpha 255; another unit's key colour with either alpha.
fn texture(unit: usize) -> Texture {
    let (key, other) = (KEYS[unit], OTHERS[unit]);
    let next = KEYS[usize::from(unit == 0)];
    let with_alpha = |color: u32, alpha: u32| color & 0xff_ffff | alpha & 0xff00_0000;
    linear_texture(TextureFormat::A8R8G8B8, 64, |x, y| match (x / 32, y / 32) {
        (0, 0) => checker(x, y, [GREYS[0], key], 8),
        (_, 0) => checker(x - 32, y, [GREYS[1], other], 4),
        (0, _) => checker(x, y - 32, [with_alpha(key, other), key | 0xff00_0000], 8),
        _ => checker(x - 32, y - 32, [with_alpha(next, key), with_alpha(next, other)], 8),
    })
}

fn key(word: u32, mode: ColorKeyMode) -> ColorKey {
    ColorKey { color: argb(word), mode }
}

/// Returns the corners of a square around a point of the plane z = 0.1, seen from z = -7 with a field of view of 45 degrees. `offset` is the
/// viewport's offset in pixels.
fn square(center: [f32; 2], offset: f32) -> Vec<[f32; 2]> {
    // 240 / tan(22.5 degrees) is the size in pixels of one unit at distance 1.
    const SCALE: f32 = 579.411_2 / 7.1;
    let place = |[x, y]: [f32; 2]| {
        let (right, up) = (x + center[0], y + center[1]);
        [320.0 + SCALE * right + offset, 240.0 - SCALE * up + offset]
    };
    corners([-0.75, 0.75, 0.75, -0.75]).map(place).to_vec()
}

fn keyed(unit: usize, place: Vec<[f32; 2]>, state: TextureUnit, combiners: Combiners) -> Draw {
    let draw = quads(&place, VertexColor::Bytes([255; 4]), FETCHED[unit]);
    Draw { combiners, ..textured(draw, unit, state, corners([0.0, 0.0, 64.0, 64.0])) }
}

fn drawing(clear: u32, textures: Vec<Texture>, draws: Vec<Draw>) -> FrameDrawing {
    let scene: Scene = scene(vec![frame_buffer(clear)], textures, draws);
    FrameDrawing::colors(scene)
}

/// Adds the frames of Color_key.
pub(super) fn frames(frames: &mut Frames) {
    let textures: Vec<Texture> = (0..4).map(texture).collect();
    let centers = [
        [[-2.6, 1.25], [-1.0, 1.25]],
        [[1.0, 1.25], [2.6, 1.25]],
        [[-2.6, -1.25], [-1.0, -1.25]],
        [[1.0, -1.25], [2.6, -1.25]],
    ];
    let modes = [
        ("Disabled", None),
        ("Alpha", Some(ColorKeyMode::Alpha)),
        ("Color", Some(ColorKeyMode::Color)),
        ("AlphaColor", Some(ColorKeyMode::Texel)),
    ];
    for (prefix, ignores_alpha) in [("", false), ("IgnAlphaCh_", true)] {
        for (suffix, mode) in modes {
            for (kind, offset) in [("FixedTex", 0.53125), ("ProgTex", 0.0)] {
                let mut draws = Vec::new();
                for unit in 0..4 {
                    for (center, word) in centers[unit].into_iter().zip([KEYS[unit], OTHERS[unit]]) {
                        let color_key = mode.map(|mode| key(word, mode));
                        let state = TextureUnit { color_key, ..nearest(unit) };
                        let register = FETCHED[unit];
                        let combiners = if ignores_alpha { opaque(register) } else { Combiners::showing(register) };
                        draws.push(keyed(unit, square(center, offset), state, combiners));
                    }
                }
                frames.push(format!("{prefix}{kind}_{suffix}"), drawing(0xff00_cc00, textures.clone(), draws));
            }
        }
    }
    let shown = || Combiners::showing(FinalRegister::Texture0);
    let texel =
        |unit: usize, word: u32| TextureUnit { color_key: Some(key(word, ColorKeyMode::Texel)), ..nearest(unit) };
    let plain = keyed(0, square([-1.6, 0.0], 0.0), texel(0, KEYS[0]), shown());
    let mut unread = keyed(0, square([1.6, 0.0], 0.0), texel(0, KEYS[0]), shown());
    unread.textures[1] = Some(texel(1, KEYS[1] | 0xff00_0000));
    unread.texture_shader[1] = ninebit::state::ShaderStage::conventional(1, true);
    frames.push("UnsampledTex", drawing(0xff00_cc00, textures, vec![plain, unread]));
    let opposites = [0xcc00_ff00, 0x0000_ff00];
    let without_alpha = linear_texture(TextureFormat::X8R8G8B8, 64, |x, y| checker(x, y, opposites, 16));
    let draw = keyed(0, square([0.0, 0.0], 0.0), texel(0, 0xcc00_ff00), shown());
    frames.push("XAlphaFormat", drawing(0xff99_9999, vec![without_alpha], vec![draw]));
}
