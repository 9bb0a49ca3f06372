//! Reads the state of the fixed-function pipe from the words that a log set.

use super::{FixedFunction, Fog, Skin};
use ninebit::state::Profile;
use ninebit::vertex::Rows;
use ninebit::vertex::light::{ColorSource, Light, Lighting, SecondaryColor, Shading, Side, Sources, Spot};
use ninebit::vertex::point::PointParameters;
use ninebit::vertex::texgen::{CoordinateSet, Generator};

/// The methods, by nxdk's names.
mod method {
    pub(super) const LIGHT_CONTROL: u32 = 0x0294;
    pub(super) const COLOR_MATERIAL: u32 = 0x0298;
    pub(super) const FOG_GEN_MODE: u32 = 0x02a0;
    pub(super) const FOG_ENABLE: u32 = 0x02a4;
    pub(super) const LIGHTING_ENABLE: u32 = 0x0314;
    pub(super) const POINT_PARAMS_ENABLE: u32 = 0x0318;
    pub(super) const SKIN_MODE: u32 = 0x0328;
    pub(super) const NORMALIZATION_ENABLE: u32 = 0x03a4;
    pub(super) const MATERIAL_EMISSION: u32 = 0x03a8;
    pub(super) const MATERIAL_ALPHA: u32 = 0x03b4;
    pub(super) const SPECULAR_ENABLE: u32 = 0x03b8;
    pub(super) const LIGHT_ENABLE_MASK: u32 = 0x03bc;
    pub(super) const TEXGEN_S: u32 = 0x03c0;
    pub(super) const TEXTURE_MATRIX_ENABLE: u32 = 0x0420;
    pub(super) const MODEL_VIEW_MATRIX: u32 = 0x0480;
    pub(super) const INVERSE_MODEL_VIEW_MATRIX: u32 = 0x0580;
    pub(super) const COMPOSITE_MATRIX: u32 = 0x0680;
    pub(super) const TEXTURE_MATRIX: u32 = 0x06c0;
    pub(super) const TEXGEN_PLANE_S: u32 = 0x0840;
    pub(super) const TEXGEN_VIEW_MODEL: u32 = 0x09cc;
    pub(super) const FOG_PLANE: u32 = 0x09d0;
    pub(super) const SPECULAR_PARAMS: u32 = 0x09e0;
    pub(super) const SCENE_AMBIENT_COLOR: u32 = 0x0a10;
    pub(super) const VIEWPORT_OFFSET: u32 = 0x0a20;
    pub(super) const POINT_PARAMS: u32 = 0x0a30;
    pub(super) const EYE_POSITION: u32 = 0x0a50;
    pub(super) const BACK_LIGHT: u32 = 0x0c00;
    pub(super) const LIGHT: u32 = 0x1000;
    pub(super) const BACK_SCENE_AMBIENT_COLOR: u32 = 0x17a0;
    pub(super) const BACK_MATERIAL_ALPHA: u32 = 0x17ac;
    pub(super) const BACK_MATERIAL_EMISSION: u32 = 0x17b0;
    pub(super) const TWO_SIDE_LIGHT_EN: u32 = 0x17c4;
    pub(super) const EYE_DIRECTION: u32 = 0x17e0;
    pub(super) const BACK_SPECULAR_PARAMS: u32 = 0x1e28;
    pub(super) const SHADER_STAGE_PROGRAM: u32 = 0x1e70;
}
use method::*;

/// The words of a log, with a list of those that were asked for in vain.
struct Words<'a> {
    get: &'a mut dyn FnMut(u32) -> Option<u32>,
    missing: Vec<u32>,
    unknown: Vec<(u32, u32)>,
}

impl Words<'_> {
    fn word(&mut self, method: u32) -> u32 {
        (self.get)(method).unwrap_or_else(|| {
            self.missing.push(method);
            0
        })
    }

    fn flag(&mut self, method: u32) -> bool {
        self.word(method) != 0
    }

    fn floats<const N: usize>(&mut self, method: u32) -> [f32; N] {
        std::array::from_fn(|n| f32::from_bits(self.word(method + 4 * n as u32)))
    }

    fn float(&mut self, method: u32) -> f32 {
        f32::from_bits(self.word(method))
    }

    fn rows(&mut self, method: u32) -> Rows {
        [0, 1, 2, 3].map(|row| self.floats(method + 16 * row))
    }

    /// Notes a word that means nothing, and returns nothing for it.
    fn unknown<T>(&mut self, method: u32, word: u32) -> Option<T> {
        self.unknown.push((method, word));
        None
    }
}

/// What the enabled state asks of the vertex in eye space.
#[derive(Default)]
struct Needs {
    position: bool,
    normal: bool,
    eye: bool,
}

impl FixedFunction {
    /// Reads the state. `get` returns the word that the log set last, or `None` if it never set that method. Only the words
    /// that the enabled state needs are asked for; those of a texture coordinate set only if its stage has a program.
    pub fn read(chip: Profile, get: &mut dyn FnMut(u32) -> Option<u32>) -> FixedFunction {
        let mut words = Words { get, missing: Vec::new(), unknown: Vec::new() };
        let mut needs = Needs::default();
        let composite = words.rows(COMPOSITE_MATRIX);
        let viewport_offset = words.floats(VIEWPORT_OFFSET);
        let skin = skin(&mut words);
        needs.position |= skin.is_some();
        let sets = sets(&mut words, &mut needs);
        let shading = shading(&mut words, &mut needs);
        let fog = fog(&mut words, &mut needs);
        let points = points(&mut words, &mut needs);
        needs.position |= needs.eye;
        let count = skin.map_or(1, |skin| skin.matrices as u32);
        let mut matrices = |needed: bool, method: u32| -> Vec<Rows> {
            if needed { (0..count).map(|n| words.rows(method + 64 * n)).collect() } else { Vec::new() }
        };
        let model_view = matrices(needs.position, MODEL_VIEW_MATRIX);
        let normal = matrices(needs.normal, INVERSE_MODEL_VIEW_MATRIX);
        let normalizes = needs.normal && words.flag(NORMALIZATION_ENABLE);
        let eye = if needs.eye { words.floats(EYE_POSITION) } else { [0.0; 3] };
        let viewer_is_far = sets.iter().any(reflects) && words.flag(TEXGEN_VIEW_MODEL);
        let Words { mut missing, unknown, .. } = words;
        missing.sort_unstable();
        missing.dedup();
        FixedFunction {
            chip,
            composite,
            model_view,
            normal,
            skin,
            normalizes,
            eye,
            viewer_is_far,
            sets,
            shading,
            fog,
            points,
            viewport_offset,
            missing,
            unknown,
        }
    }
}

fn skin(words: &mut Words<'_>) -> Option<Skin> {
    let (matrices, completes) = match words.word(SKIN_MODE) {
        0 => return None,
        1 => (2, true),
        2 => (2, false),
        3 => (3, true),
        4 => (3, false),
        5 => (4, true),
        6 => (4, false),
        other => return words.unknown(SKIN_MODE, other),
    };
    Some(Skin { matrices, completes })
}

fn reflects(set: &CoordinateSet) -> bool {
    set.generators.iter().flatten().any(|made| matches!(made, Generator::SphereMap | Generator::ReflectionMap))
}

fn sets(words: &mut Words<'_>, needs: &mut Needs) -> [CoordinateSet; 4] {
    // Five bits for each stage; a log that never set them may use them all.
    let stages = (words.get)(SHADER_STAGE_PROGRAM).unwrap_or(u32::MAX);
    [0, 1, 2, 3].map(|n| {
        let mut set = CoordinateSet::given(n as usize);
        if stages >> (5 * n) & 31 == 0 {
            return set;
        }
        set.generators = [0, 1, 2, 3].map(|component| generator(words, n, component));
        for made in set.generators.iter().flatten() {
            match made {
                Generator::ObjectLinear(_) => {}
                Generator::EyeLinear(_) => needs.position = true,
                Generator::NormalMap => needs.normal = true,
                Generator::SphereMap | Generator::ReflectionMap => {
                    needs.eye = true;
                    needs.normal = true;
                }
            }
        }
        set.matrix = words.flag(TEXTURE_MATRIX_ENABLE + 4 * n).then(|| words.rows(TEXTURE_MATRIX + 64 * n));
        set
    })
}

/// Returns how a component of a coordinate set is made. The last components have no maps.
fn generator(words: &mut Words<'_>, set: u32, component: u32) -> Option<Generator> {
    let method = TEXGEN_S + 16 * set + 4 * component;
    let plane = TEXGEN_PLANE_S + 64 * set + 16 * component;
    match words.word(method) {
        0 => None,
        0x2400 => Some(Generator::EyeLinear(words.floats(plane))),
        0x2401 => Some(Generator::ObjectLinear(words.floats(plane))),
        0x2402 if component < 2 => Some(Generator::SphereMap),
        0x8511 if component < 3 => Some(Generator::NormalMap),
        0x8512 if component < 3 => Some(Generator::ReflectionMap),
        other => words.unknown(method, other),
    }
}

fn shading(words: &mut Words<'_>, needs: &mut Needs) -> Shading {
    let enabled = words.flag(SPECULAR_ENABLE);
    let control = if enabled { words.word(LIGHT_CONTROL) } else { 0 };
    let secondary = SecondaryColor { enabled, separate: control & 1 != 0, keeps_alpha: control >> 17 & 1 != 0 };
    let lighting = words.flag(LIGHTING_ENABLE).then(|| lighting(words, needs));
    Shading { lighting, secondary }
}

fn lighting(words: &mut Words<'_>, needs: &mut Needs) -> Lighting {
    needs.normal = true;
    let local_eye = words.word(LIGHT_CONTROL) >> 16 & 1 != 0;
    let mask = words.word(LIGHT_ENABLE_MASK);
    let lights: Vec<(u32, Light)> = (0..8)
        .filter(|n| mask >> (2 * n) & 3 != 0)
        .map(|n| (n, light(words, n, mask >> (2 * n) & 3, !local_eye)))
        .collect();
    let local = lights.iter().any(|(_, light)| matches!(light, Light::Local { .. }));
    needs.position |= local;
    needs.eye |= !lights.is_empty() && local_eye;
    let eye_direction = if local && !local_eye { words.floats(EYE_DIRECTION) } else { [0.0; 3] };
    let material = words.word(COLOR_MATERIAL);
    let front = Parts {
        material: material & 255,
        ambient: SCENE_AMBIENT_COLOR,
        factor: MATERIAL_EMISSION,
        alpha: MATERIAL_ALPHA,
        powers: SPECULAR_PARAMS,
        colors: LIGHT,
        step: 128,
    };
    let back = Parts {
        material: material >> 8 & 255,
        ambient: BACK_SCENE_AMBIENT_COLOR,
        factor: BACK_MATERIAL_EMISSION,
        alpha: BACK_MATERIAL_ALPHA,
        powers: BACK_SPECULAR_PARAMS,
        colors: BACK_LIGHT,
        step: 64,
    };
    let numbers: Vec<u32> = lights.iter().map(|(n, _)| *n).collect();
    let front = side(words, &front, &numbers);
    let back = words.flag(TWO_SIDE_LIGHT_EN).then(|| side(words, &back, &numbers));
    Lighting { lights: lights.into_iter().map(|(_, light)| light).collect(), front, back, local_eye, eye_direction }
}

/// Reads the light `n`. Its half vector counts only where the eye is far away.
fn light(words: &mut Words<'_>, n: u32, mode: u32, has_half: bool) -> Light {
    let base = LIGHT + 128 * n;
    if mode == 1 {
        let half = if has_half { words.floats(base + 0x28) } else { [0.0; 3] };
        return Light::Infinite { direction: words.floats(base + 0x34), half };
    }
    let spot = (mode == 3).then(|| {
        let [x, y, z, offset] = words.floats(base + 0x4c);
        Spot { falloff: words.floats(base + 0x40), direction: [x, y, z], offset }
    });
    let range = words.float(base + 0x24);
    Light::Local { position: words.floats(base + 0x5c), attenuation: words.floats(base + 0x68), range, spot }
}

/// Where the words of one side are.
struct Parts {
    material: u32,
    ambient: u32,
    factor: u32,
    alpha: u32,
    powers: u32,
    colors: u32,
    /// From the colours of one light to those of the next.
    step: u32,
}

fn side(words: &mut Words<'_>, parts: &Parts, lights: &[u32]) -> Side {
    let mut source = |low: u32| match parts.material >> low & 3 {
        0 => ColorSource::Material,
        1 => ColorSource::Diffuse,
        2 => ColorSource::Specular,
        _ => words.unknown(COLOR_MATERIAL, parts.material).unwrap_or(ColorSource::Material),
    };
    let sources = Sources { emission: source(0), ambient: source(2), diffuse: source(4), specular: source(6) };
    let alpha = if sources.diffuse == ColorSource::Material { words.float(parts.alpha) } else { 0.0 };
    let factor = words.floats(parts.factor);
    let powers = if lights.is_empty() { [0.0; 6] } else { words.floats(parts.powers) };
    let colors = lights.iter().map(|n| {
        let base = parts.colors + parts.step * n;
        [0, 12, 24].map(|color| words.floats(base + color))
    });
    let colors = colors.collect();
    Side { sources, ambient: words.floats(parts.ambient), factor, alpha, powers, colors }
}

fn fog(words: &mut Words<'_>, needs: &mut Needs) -> Option<Fog> {
    if !words.flag(FOG_ENABLE) {
        return None;
    }
    match words.word(FOG_GEN_MODE) {
        0 => Some(Fog::SpecularAlpha),
        1 => {
            needs.eye = true;
            Some(Fog::Radial)
        }
        mode @ (2 | 3) => {
            needs.position = true;
            Some(Fog::Planar { plane: words.floats(FOG_PLANE), absolute: mode == 3 })
        }
        6 => Some(Fog::Vertex),
        other => words.unknown(FOG_GEN_MODE, other),
    }
}

fn points(words: &mut Words<'_>, needs: &mut Needs) -> Option<PointParameters> {
    if !words.flag(POINT_PARAMS_ENABLE) {
        return None;
    }
    needs.eye = true;
    let attenuation = words.floats(POINT_PARAMS);
    let range = words.float(POINT_PARAMS + 12);
    // The two words between repeat the range; the chip does not use them.
    let [bias, smallest] = words.floats(POINT_PARAMS + 24);
    Some(PointParameters { attenuation, bias, range, smallest })
}
