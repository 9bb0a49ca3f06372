//! The fixed-function pipe: arithmetic of the transform and the light unit, and lights.

use super::{Column, Conditions, Kind, Reach, Unit, channels, float, put, sized};
use ninebit::number::light::{add_product, dot, multiply_add, reciprocal, single_product, single_sum, word};
use ninebit::number::transform;
use ninebit::vertex::light::{ColorSource, Light, Lighting, SecondaryColor, Shading, Side, Sources, Spot, Surface};

/// Returns the float of each of three inputs.
fn three(inputs: &[i64], first: usize) -> [f32; 3] {
    [0, 1, 2].map(|n| float(inputs[first + n]))
}

fn words<const N: usize>(names: [&str; N]) -> [Column; N] {
    names.map(|name| Column::word(name, 32))
}

/// Returns columns of three floats for each name.
fn vectors<const N: usize>(names: [&str; N]) -> Vec<Column> {
    names.iter().flat_map(|name| channels(name, ["x", "y", "z"], |name: &str| Column::word(name, 32))).collect()
}

/// The arithmetic of the transform unit.
pub(super) struct TransformUnit;

impl Unit for TransformUnit {
    known_as!(
        "transform-unit", &["VTX-5"],
        "products a b and c d, their sum, the sum of all four numbers, and 1/a, 1/a limited, and 1/sqrt |a| (floats)", Inside;
        takes [words(["in.a", "in.b", "in.c", "in.d"])];
        gives [
            Column::results(["mid.ab", "mid.cd"], Kind::Hex(32)),
            Column::results(["out.dot", "out.sum", "out.reciprocal", "out.limited", "out.root"], Kind::Hex(32)),
        ]
    );

    fn fit(&self, inputs: &mut [i64]) {
        // Usually of similar magnitudes.
        if inputs[3] & 7 != 0 {
            inputs.iter_mut().for_each(|bits| *bits = sized(*bits, (-5, 10)));
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let [a, b, c, d] = [0, 1, 2, 3].map(|n| inputs[n] as u32);
        let (ab, cd) = (transform::product(a, b), transform::product(c, d));
        let sums = [transform::sum([ab, cd]), transform::sum([a, b, c, d])];
        let functions = [transform::reciprocal(a), transform::limited_reciprocal(a), transform::reciprocal_root(a)];
        put(results, [ab, cd].into_iter().chain(sums).chain(functions));
    }
}

/// The arithmetic of the light unit beyond that of fog.
pub(super) struct LightArithmetic;

impl Unit for LightArithmetic {
    known_as!(
        "light-arithmetic", &["VTX-6"],
        "a . b of vectors of words; a.x + b.x, a.x b.x, 1/a.x and a.x b.x + a.y in the part for single numbers; a.y + a.x b.x in that for vectors", Inside;
        takes [vectors(["in.a", "in.b"])];
        gives [
            Column::results(["out.dot", "out.sum", "out.product", "out.reciprocal"], Kind::Hex(32)),
            Column::results(["out.multiply_add", "out.add_product"], Kind::Hex(32)),
        ]
    );

    fn fit(&self, inputs: &mut [i64]) {
        // Usually of similar magnitudes.
        if inputs[5] & 7 != 0 {
            inputs.iter_mut().for_each(|bits| *bits = sized(*bits, (-5, 10)));
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let [a, b] = [0, 3].map(|first| [0, 1, 2].map(|n| word(inputs[first + n] as u32)));
        let ([x, y, _], [factor, ..]) = (a, b);
        let single = [single_sum(x, factor), single_product(x, factor), reciprocal(x), multiply_add(x, factor, y)];
        put(results, [dot(a, b)].into_iter().chain(single).chain([add_product(y, x, factor)]));
    }
}

/// What a light gives to a vertex.
pub(super) struct LightShare;

impl Unit for LightShare {
    known_as!(
        "light-share", &["VTX-6"],
        "the shares of ambient, diffuse and specular light at a point in eye space, from a light far away (place: the direction to it; the half vector), at a place, or with a cone (floats)", Inside;
        takes [
            Column::names("cfg.kind", &["Infinite", "Local", "Spot"]),
            Column::flag("cfg.local_eye"),
            vectors(["in.point", "in.normal", "in.place", "in.half", "in.attenuation", "in.direction", "in.falloff"]),
            words(["in.range", "in.offset"]),
            words(["in.power.a", "in.power.b", "in.power.c", "in.power.d", "in.power.e", "in.power.f"]),
        ];
        gives [Column::results(["out.ambient", "out.diffuse", "out.specular"], Kind::Hex(32))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        vec![share(0, 0), share(0, 1), share(1, 1), share(2, 1)]
    }

    fn fit(&self, inputs: &mut [i64]) {
        // Mostly lights as programs have them: vectors near a unit long, a far range, powers from 1 to 24.
        let mixed = inputs[5] as u32;
        if mixed & 7 != 0 {
            let fitting = share(inputs[0], inputs[1]);
            inputs[2..17].iter_mut().for_each(|bits| *bits = sized(*bits, (-3, 3)));
            inputs[17..20].iter_mut().for_each(|bits| *bits = sized(*bits & 0x7fff_ffff, (-3, 4)));
            inputs[20..23].copy_from_slice(&fitting[20..23]);
            inputs[23] = if mixed & 8 == 0 { sized(inputs[23] & 0x7fff_ffff, (0, 3)) } else { fitting[23] };
            inputs[24] = fitting[24];
            inputs[25..].copy_from_slice(&fitting[25..]);
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let [point, normal, place, half, attenuation, direction, falloff] =
            [2, 5, 8, 11, 14, 17, 20].map(|first| three(inputs, first));
        let (range, offset) = (float(inputs[23]), float(inputs[24]));
        let spot = (inputs[0] == 2).then_some(Spot { falloff, direction, offset });
        let light = match inputs[0] {
            0 => Light::Infinite { direction: place, half },
            _ => Light::Local { position: place, attenuation, range, spot },
        };
        // A share of each of three colours.
        let colors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let front = Side {
            sources: Sources::MATERIAL,
            ambient: [0.0; 3],
            factor: [0.0; 3],
            alpha: 1.0,
            powers: std::array::from_fn(|n| float(inputs[25 + n])),
            colors: vec![colors],
        };
        let lighting = Lighting {
            lights: vec![light],
            front,
            back: None,
            local_eye: inputs[1] != 0,
            eye_direction: [0.0, 0.0, -1.0],
        };
        let secondary = SecondaryColor { enabled: false, separate: false, keeps_alpha: false };
        let [x, y, z] = point.map(f32::to_bits);
        let surface = Surface::new([x, y, z, transform::ONE], normal.map(f32::to_bits), [0.0; 3]);
        let shading = Shading { lighting: Some(lighting), secondary };
        let ([[ambient, diffuse, specular, _], _], _) = shading.colors(&surface, [[0.0; 4]; 2]);
        put(results, [ambient, diffuse, specular].map(f32::to_bits));
    }
}

/// Returns a row of [`LightShare`] as programs have it.
fn share(kind: i64, local_eye: i64) -> Vec<i64> {
    let numbers: [f32; 29] = [
        0.5, -0.25, 7.0, 0.1, 0.2, -0.95, 1.5, 1.0, 4.5, 0.38, 0.0, -0.92, 0.025, 0.15, 0.02, 0.0, 0.0, -3.3, -0.17,
        -0.86, 1.69, 4.0, -2.0, -0.8, -2.78, 2.98, -0.65, -2.36, 2.71,
    ];
    let place: [f32; 3] = if kind == 0 { [-0.7, 0.0, -0.7] } else { [1.5, 1.0, 4.5] };
    let mut row: Vec<i64> = [kind, local_eye].into_iter().chain(numbers.map(|n| i64::from(n.to_bits()))).collect();
    row[8..11].copy_from_slice(&place.map(|n| i64::from(n.to_bits())));
    row
}

/// The sources of a material's colours, in the order of the columns.
const SOURCES: &[&str] = &["Material", "Diffuse", "Specular"];

/// A channel of a lit vertex.
pub(super) struct LightColor;

impl Unit for LightColor {
    known_as!(
        "light-color", &["VTX-6"],
        "a channel of a vertex's primary and secondary colour under a light straight ahead, whose share is that of the normal's z, and all of whose specular light arrives (floats)", Inside;
        takes [
            ["cfg.emission", "cfg.ambient", "cfg.diffuse", "cfg.specular"].map(|name| Column::names(name, SOURCES)),
            [Column::flag("cfg.secondary"), Column::flag("cfg.separate")],
            words(["in.scene", "in.factor", "in.normal", "in.vertex.diffuse", "in.vertex.specular"]),
            words(["in.light.ambient", "in.light.diffuse", "in.light.specular"]),
        ];
        gives [Column::results(["out.primary", "out.secondary"], Kind::Hex(32))]
    );

    fn fit(&self, inputs: &mut [i64]) {
        // Mostly colours.
        if inputs[6] & 7 != 0 {
            inputs[6..].iter_mut().for_each(|bits| *bits = sized(*bits & 0x7fff_ffff, (-5, 5)));
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let source =
            |n: usize| [ColorSource::Material, ColorSource::Diffuse, ColorSource::Specular][inputs[n] as usize % 3];
        let sources = Sources { emission: source(0), ambient: source(1), diffuse: source(2), specular: source(3) };
        let [scene, factor, normal, diffuse, specular] = [6, 7, 8, 9, 10].map(|n| float(inputs[n]));
        let light = Light::Infinite { direction: [0.0, 0.0, 1.0], half: [0.0; 3] };
        let front = Side {
            sources,
            ambient: [scene; 3],
            factor: [factor; 3],
            alpha: 1.0,
            // (0 + 1) / (0 + 1).
            powers: [1.0, 0.0, 1.0, 0.0, 0.0, 0.0],
            colors: vec![[11, 12, 13].map(|n| [float(inputs[n]); 3])],
        };
        let lighting = Lighting { lights: vec![light], front, back: None, local_eye: false, eye_direction: [0.0; 3] };
        let secondary = SecondaryColor { enabled: inputs[4] != 0, separate: inputs[5] != 0, keeps_alpha: true };
        let surface = Surface { point: [0; 3], normal: [0, 0, normal.to_bits()], to_eye: [0; 3] };
        let shading = Shading { lighting: Some(lighting), secondary };
        let (colors, _) = shading.colors(&surface, [[diffuse; 4], [specular; 4]]);
        put(results, colors.map(|[red, ..]| red.to_bits()));
    }
}
