//! Random textures, palettes, texture units and texture shaders.

use super::{Choices, CoordinateStyles, SceneParts, TEXTURE_SHADERS};
use ninebit::state::*;
use std::sync::Arc;

/// Returns the formats without depth that the chip can sample in this kind of texture.
fn formats(profile: Profile, kind: TextureKind) -> Vec<TextureFormat> {
    let legal = |f: TextureFormat| match (profile, kind) {
        (Profile::Nv10, TextureKind::Rectangle) => {
            use TextureFormat::{A1R5G5B5, A8R8G8B8, I8, R5G6B5};
            matches!(f, A1R5G5B5 | R5G6B5 | A8R8G8B8 | I8)
        }
        (Profile::Nv10, _) => !f.is_nv2a_only(),
        (Profile::Nv2a, TextureKind::Rectangle) => !f.is_compressed() && f != TextureFormat::P8,
        (Profile::Nv2a, _) => !f.is_paired(),
    };
    // Depth formats are used by the wider scenes only.
    TextureFormat::ALL.iter().copied().filter(|f| legal(*f) && f.depth().is_none()).collect()
}

/// Returns a palette of 32, 64, 128 or 256 colours.
pub(super) fn palette(c: &mut Choices<'_>, n: u32) -> Palette {
    let (entries, seed) = (32 << c.below(4), c.word());
    Palette { name: format!("palette{n}"), entries: (0..entries).map(|k| scrambled(seed, k)).collect() }
}

/// Returns word `k` of a sequence whose neighbouring words are unrelated.
pub(super) fn scrambled(seed: u32, k: u32) -> u32 {
    let x = (seed ^ k.wrapping_mul(0x9e37_79b9)).wrapping_mul(0x85eb_ca6b);
    (x ^ x >> 15).wrapping_mul(0xc2b2_ae35) ^ x >> 13
}

/// Returns texels of the given sides with words that run evenly or have nothing to do with each other.
pub(super) fn filled(
    kind: TextureKind,
    format: TextureFormat,
    sides: Texels,
    (even, seed, step): (bool, u32, u32),
) -> TextureImage {
    let faces = if kind == TextureKind::Cube { CUBE_FACES } else { 1 };
    let (_, face_words) = Level::chain(format, sides.width, sides.height, sides.levels, sides.border);
    let mask = u32::MAX >> (32 - format.word_bits());
    let word = |k: u32| if even { seed.wrapping_add(step.wrapping_mul(k)) } else { scrambled(seed, k) };
    // The second texel of a pair has the chroma of the first.
    let shared = |k: u32| match format.is_paired() && k % 2 == 1 {
        true => word(k) & !0xffff | word(k - 1) & 0xffff,
        false => word(k),
    };
    let words = (0..faces * sides.layers * face_words as u32).map(|k| shared(k) & mask).collect();
    TextureImage::Texels(Texels { words, ..sides })
}

/// Returns a texture with texels of its own.
pub(super) fn texels(c: &mut Choices<'_>, profile: Profile, n: u32) -> Texture {
    let mut c = c.part(24);
    let kind = c.pick(&[TextureKind::TwoDimensional, TextureKind::Cube, TextureKind::Rectangle]);
    let format: TextureFormat = c.pick(&formats(profile, kind));
    let side = |c: &mut Choices<'_>| match kind {
        TextureKind::Rectangle => c.size(1, 24),
        _ if c.once_in(8) => 64 >> c.below(2),
        _ => 16 >> c.below(5),
    };
    let (mut width, height) = (side(&mut c), side(&mut c));
    match (kind, profile) {
        (TextureKind::Cube, _) => width = height,
        // Nv10 requires an even width.
        (TextureKind::Rectangle, _) if profile == Profile::Nv10 || format.is_paired() => width += width & 1,
        _ => {}
    }
    let most = if kind == TextureKind::Rectangle { 1 } else { Level::most(width, height) };
    let levels = if c.once_in(3) { c.size(1, most) } else { most };
    let may = profile == Profile::Nv2a && kind == TextureKind::TwoDimensional && !format.is_compressed();
    let border = may && c.once_in(4);
    // A texture takes few words of the tape. All of its texels are derived from them.
    let of_words = (c.once_in(2), c.word(), c.word());
    let sides = Texels { width, height, levels, layers: 1, border, words: Arc::default() };
    let image = filled(kind, format, sides, of_words);
    Texture { name: format!("texture{n}"), kind, format, image }
}

/// Returns a render target as a texture, if it can be sampled.
pub(super) fn view(c: &mut Choices<'_>, profile: Profile, n: usize, target: &Target) -> Option<Texture> {
    let mut c = c.part(3);
    if c.once_in(2) {
        return None;
    }
    let squares = target.width.is_power_of_two() && target.height.is_power_of_two();
    let small = target.width.max(target.height) <= 48;
    let even = profile == Profile::Nv2a || target.width.is_multiple_of(2);
    let kind = if squares && c.below(3) != 0 { TextureKind::TwoDimensional } else { TextureKind::Rectangle };
    let fitting: Vec<TextureFormat> = formats(profile, kind)
        .into_iter()
        .filter(|f| {
            f.bytes() == target.format.bytes() && !f.is_compressed() && !f.is_paired() && *f != TextureFormat::P8
        })
        .collect();
    if !small || fitting.is_empty() || (kind == TextureKind::Rectangle && !even) {
        return None;
    }
    let format = c.pick(&fitting);
    Some(Texture { name: format!("view{n}"), kind, format, image: TextureImage::Target { target: n } })
}

type Units = ([Option<TextureUnit>; TEXTURE_UNITS], [ShaderStage; TEXTURE_UNITS]);

/// Returns the units of a draw, which sample only the `usable` textures, and their texture shader.
pub(super) fn units(c: &mut Choices<'_>, given: &SceneParts<'_>, usable: &[usize], styles: &CoordinateStyles) -> Units {
    let shader = TEXTURE_SHADERS && given.profile == Profile::Nv2a && c.once_in(2);
    let operations = shader.then(|| operations(&mut c.part(48)));
    let mut stages = [0, 1, 2, 3].map(|k| ShaderStage::conventional(k, false));
    let bound = std::array::from_fn(|k| {
        let mut c = c.part(28);
        let sets = given.profile.texture_units();
        let (any_set, fitting_set) = (c.below(sets as u32) as usize, c.below(3) != 2);
        // In most cases the coordinate set suits the kind of texture.
        let set_for = |suits: &dyn Fn(u32) -> bool| {
            let suiting = (0..sets).map(|n| (any_set + n) % sets).find(|n| fitting_set && suits(styles[*n]));
            suiting.unwrap_or(any_set)
        };
        let set_of = |unit: &Option<TextureUnit>| {
            set_for(&|style| match unit.map(|unit| given.textures[unit.texture].kind) {
                Some(TextureKind::Cube) => matches!(style, 12..=14),
                Some(TextureKind::Rectangle) => matches!(style, 2 | 8 | 9),
                _ => style < 12,
            })
        };
        let previous = c.below(k.max(1) as u32) as usize;
        let mapping = c.any();
        if k >= given.profile.texture_units() {
            return None;
        }
        let Some(operation) = operations.map(|o| o[k]) else {
            let unit = (c.below(3) != 0).then(|| unit(&mut c, given, usable));
            stages[k] = ShaderStage { coordinate_set: set_of(&unit), ..ShaderStage::conventional(k, unit.is_some()) };
            return unit;
        };
        let fits = |kind: &TextureKind| match operation {
            // Cube maps need a q of 0.
            ShaderOperation::DotProduct3D => *kind == TextureKind::TwoDimensional,
            _ => operation.samples() && operation.kinds().contains(kind),
        };
        let fitting: Vec<usize> = usable.iter().copied().filter(|t| fits(&given.textures[*t].kind)).collect();
        let unit = (!fitting.is_empty()).then(|| unit(&mut c, given, &fitting));
        let coordinate_set = match operation {
            ShaderOperation::SampleCube => set_for(&|style| matches!(style, 12..=14)),
            ShaderOperation::Sample2D => set_for(&|style| style < 12),
            ShaderOperation::Sample => set_of(&unit),
            _ if operation.is_dot() => set_for(&|style| style >= 12),
            _ => any_set,
        };
        stages[k] = ShaderStage { operation, coordinate_set, previous, mapping };
        unit
    });
    repair(&mut stages, &bound);
    (bound, stages)
}

/// Returns one operation for each unit, in an order that is legal.
fn operations(c: &mut Choices<'_>) -> [ShaderOperation; TEXTURE_UNITS] {
    use ShaderOperation::*;
    let first = free(c, true);
    let eye = DotReflectConstantEye { eye: std::array::from_fn(|_| c.between(-1.0, 1.0)) };
    let last = c.pick(&[DotProductCube, DotReflectSpecular, eye, DotProduct3D]);
    match c.below(7) {
        0 | 1 => [first, free(c, false), free(c, false), free(c, false)],
        2 => [first, DotProduct, DotProduct2D, free(c, false)],
        3 => [first, free(c, false), DotProduct, DotProduct2D],
        4 => [
            first,
            DotProduct,
            DotReflectDiffuse,
            if matches!(last, DotProductCube | DotProduct3D) { eye } else { last },
        ],
        5 => [first, DotProduct, DotProduct, c.pick(&[DotProduct3D, DotProductCube])],
        _ => [first, DotProduct, DotProduct, last],
    }
}

/// Returns an operation that needs no dot product in an earlier unit, and for the first unit one that needs no earlier unit at all.
fn free(c: &mut Choices<'_>, first: bool) -> ShaderOperation {
    use ShaderOperation::*;
    let mut c = c.part(12);
    match c.below(if first { 8 } else { 13 }) {
        0..=2 => Sample,
        3 => Sample2D,
        4 => SampleCube,
        5 => PassThrough,
        6 => None,
        7 => CullFragment { drops_not_negative: std::array::from_fn(|_| c.once_in(4)) },
        8 => DependentAlphaRed,
        9 => DependentGreenBlue,
        _ => {
            let element = |c: &mut Choices<'_>| {
                if c.once_in(2) { c.between(-1.0, 1.0) } else { c.pick(&[0.0, 1.0, 0.25, -0.5, 0.1, 3.0]) }
            };
            let matrix = std::array::from_fn(|_| element(&mut c));
            let luminance = c.once_in(2).then(|| [element(&mut c), element(&mut c)]);
            BumpEnvironment { matrix, luminance }
        }
    }
}

/// Removes operations from units that have no fitting texture, and operations of other units that depended on them.
fn repair(stages: &mut [ShaderStage; TEXTURE_UNITS], bound: &[Option<TextureUnit>; TEXTURE_UNITS]) {
    use ShaderOperation::{BumpEnvironment, CullFragment, DotReflectDiffuse, None, Sample};
    let lacks = |k: usize, stages: &[ShaderStage; 4]| stages[k].operation.samples() && bound[k].is_none();
    if (0..4).any(|k| stages[k].operation.is_dot() && lacks(k, stages)) {
        for stage in stages.iter_mut().filter(|s| s.operation.is_dot()) {
            stage.operation = None;
        }
    }
    for k in 0..4 {
        if lacks(k, stages) {
            stages[k].operation = None;
        }
    }
    // Unit 2 samples with the dot product of unit 3.
    if stages[2].operation == DotReflectDiffuse {
        stages[3].previous = stages[3].previous.min(1);
    }
    // A bump environment in unit 1 needs a unit 0 that yields a colour.
    if matches!(stages[1].operation, BumpEnvironment { .. })
        && matches!(stages[0].operation, None | CullFragment { .. })
    {
        stages[1].operation = Sample;
    }
}

/// Makes a unit of a draw sample a texture of another kind than its stage (TEX-20). A dot product for volumes gets a cube map and q = 0.
pub(super) fn other_kind(scene: &mut Scene, (draw, k): (usize, usize)) {
    let Some(unit) = scene.draws[draw].textures[k] else { return };
    let cube = scene.textures.iter().position(|texture| texture.kind == TextureKind::Cube);
    let draw = &mut scene.draws[draw];
    let stage = &mut draw.texture_shader[k];
    stage.operation = match (stage.operation, scene.textures[unit.texture].kind) {
        (ShaderOperation::Sample, TextureKind::TwoDimensional) => ShaderOperation::SampleCube,
        (ShaderOperation::Sample, _) => ShaderOperation::Sample2D,
        (ShaderOperation::DotProductCube | ShaderOperation::DotProduct3D, _) => ShaderOperation::DotProduct3D,
        _ => return,
    };
    let set = stage.coordinate_set;
    if let (ShaderOperation::DotProduct3D, Some(texture)) = (stage.operation, cube) {
        draw.textures[k] = Some(TextureUnit { texture, palette: None, ..unit });
        draw.vertices.update(|_, vertex| vertex.texture_coordinates[set][3] = 0.0);
    }
}

pub(super) fn unit(c: &mut Choices<'_>, given: &SceneParts<'_>, usable: &[usize]) -> TextureUnit {
    let nv2a = given.profile == Profile::Nv2a;
    let texture = c.pick(usable);
    let modes: &[AddressMode] = match (given.profile, given.textures[texture].kind) {
        (Profile::Nv2a, _) => AddressMode::ALL,
        (Profile::Nv10, TextureKind::Rectangle) => &[AddressMode::ClampToEdge],
        (Profile::Nv10, _) => &[AddressMode::Wrap, AddressMode::Mirror, AddressMode::ClampToEdge, AddressMode::Clamp],
    };
    let palette = c.below(given.palettes as u32) as usize;
    let limited = c.once_in(4);
    let (min_lod, reach) = (c.below(800) as i32, c.below(800) as i32);
    TextureUnit {
        palette: (given.textures[texture].format == TextureFormat::P8).then_some(palette),
        address_s: c.pick(modes),
        address_t: c.pick(modes),
        mag_filter: c.any(),
        min_filter: c.any(),
        mip_filter: c.any(),
        lod_bias: match c.below(6) {
            0 | 1 => 0,
            2 => c.pick(&[256, -256, 128, -128, 4095, -4096]),
            _ => c.size(0, 1600) as i32 - 600,
        },
        min_lod: if limited { min_lod } else { 0 },
        max_lod: if limited { min_lod + reach } else { 4095 },
        border_color: c.bytes(),
        signed: std::array::from_fn(|_| nv2a && c.once_in(5)),
        ..TextureUnit::new(texture)
    }
}
