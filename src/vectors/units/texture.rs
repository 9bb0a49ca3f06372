//! Coordinates of texture units, and the linear filter.

use super::raster::with_place;
use super::{Column, Conditions, Kind, Reach, Unit, float, named, paired, put};
use ninebit::number::{Lane, Pair};
use ninebit::state::*;
use ninebit::texture::coordinates::{Coordinates, SampleCoordinates, VertexCoordinates, real_coordinate};
use ninebit::texture::cube::Face;
use ninebit::texture::dependent::{Dependent, Target};
use ninebit::texture::planned::PlannedUnit;
use ninebit::texture::report::Report;
use ninebit::texture::{address, filter, lod, unit};
use ninebit::trace::{Observer, Recorder, Silent};

const SIZES: [i64; 9] = [1, 2, 3, 4, 17, 64, 100, 256, 4096];

/// Returns unit 0 with a two-dimensional texture of this format and one texel.
pub(super) fn planned(state: TextureUnit, format: TextureFormat) -> PlannedUnit {
    let (levels, face_words) = Level::chain(format, 1, 1, 1, false);
    PlannedUnit {
        index: 0,
        state,
        stage: ShaderStage::conventional(0, true),
        kind: TextureKind::TwoDimensional,
        format,
        levels,
        face_words,
        layers: 1,
        border: false,
        dithered: false,
        palette: None,
        live: 15,
    }
}

/// Returns the columns of mode, size, and a coordinate in 1/256 texel.
fn addressing() -> [Column; 4] {
    [
        Column::choice::<AddressMode>("cfg.mode"),
        Column::flag("cfg.border_texels"),
        Column::listed("cfg.size", Kind::Unsigned(13), &SIZES),
        Column::signed("in.u", 24, -(1 << 23), (1 << 23) - 1),
    ]
}

/// Returns the columns of the coordinates' differences to the pixels on the right and below, 1/65536 texel.
pub(super) fn footprint() -> [Column; 4] {
    ["in.u_right", "in.v_right", "in.u_lower", "in.v_lower"].map(|name| Column::signed(name, 34, -(1 << 32), 1 << 32))
}

/// Moves coordinates close to the image in most rows.
fn near(inputs: &mut [i64]) {
    if inputs[3] & 3 != 0 {
        inputs[3] = inputs[3].rem_euclid((inputs[2] + 8) * 768) - (inputs[2] + 8) * 256;
    }
}

/// Addresses a texel index. Returns whether it is inside, and the texel.
fn addressed(inputs: &[i64], index: i64) -> [i64; 2] {
    let found = address::address(named(inputs[0]), index, inputs[2] as u32, inputs[1] != 0);
    [found.is_some().into(), found.unwrap_or(0)]
}

/// The nearest texel.
pub(super) struct NearestAddress;

impl Unit for NearestAddress {
    known_as!(
        "nearest-address", &["TEX-5", "TEX-7", "TEX-8"],
        "the texel that the nearest filter meets at a coordinate in 1/256 texel, brought inside; not inside: the border colour", Geometry;
        takes [addressing()];
        gives [
            Column::result("mid.index", Kind::Signed(17)),
            Column::result("out.inside", Kind::Unsigned(1)),
            Column::result("out.texel", Kind::Signed(14)),
        ]
    );

    fn fit(&self, inputs: &mut [i64]) {
        near(inputs);
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        results[0] = filter::nearest(inputs[3]);
        [results[1], results[2]] = addressed(inputs, results[0]);
    }
}

/// The two texels of the linear filter along one axis.
pub(super) struct LinearAddress;

impl Unit for LinearAddress {
    known_as!(
        "linear-address", &["TEX-6", "TEX-7", "TEX-8"],
        "the two texels that the linear filter mixes along one axis, brought inside, and the weight of the second in 256ths", Geometry;
        takes [addressing()];
        gives [
            Column::result("mid.index", Kind::Signed(17)),
            Column::result("out.weight", Kind::Unsigned(8)),
            Column::result("out.inside0", Kind::Unsigned(1)),
            Column::result("out.texel0", Kind::Signed(14)),
            Column::result("out.inside1", Kind::Unsigned(1)),
            Column::result("out.texel1", Kind::Signed(14)),
        ]
    );

    fn fit(&self, inputs: &mut [i64]) {
        near(inputs);
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let (index, weight) = filter::linear(inputs[3]);
        (results[0], results[1]) = (index, weight.into());
        [results[2], results[3]] = addressed(inputs, index);
        [results[4], results[5]] = addressed(inputs, index + 1);
    }
}

pub(super) struct LinearStep;

impl Unit for LinearStep {
    known_as!(
        "linear-step", &["TEX-6", "TEX-9"],
        "two bytes mixed by the weight of the second in 256ths: between texels, and between levels (trilinear)", Direct;
        takes [["in.first", "in.second", "in.weight"].map(Column::byte)];
        gives [Column::result("out.value", Kind::Unsigned(8))]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        results[0] = filter::lerp(inputs[0] as i32, inputs[1] as i32, inputs[2] as i32).into();
    }
}

/// Returns the columns of four texels, row by row, and of the weights of the right and the lower ones.
fn footprint_of_one_channel() -> [Column; 6] {
    let [t00, t10, t01, t11] = ["in.t00", "in.t10", "in.t01", "in.t11"].map(|name| Column::signed(name, 9, -128, 255));
    [t00, t10, t01, t11, Column::byte("in.weight_u"), Column::byte("in.weight_v")]
}

/// Returns a unit of which one channel is read. Channels do not affect each other.
pub(super) fn one_channel(signed: bool) -> PlannedUnit {
    let state = TextureUnit { signed: [signed; 4], ..TextureUnit::new(0) };
    PlannedUnit { live: 1, ..planned(state, TextureFormat::A8R8G8B8) }
}

/// Filters the texels of a row: four texels and two weights.
fn mixed<L: Lane>(unit: &PlannedUnit, row: &[i64], observer: &mut impl Observer) -> [L; 4] {
    // As the unit expands texels: s/128 in the ideal of a signed channel.
    let denominator = if unit.state.signed[0] { 128 } else { 255 };
    let texel = |n: usize| [L::texel(row[n] as i32, row[n] as i32, denominator); 4];
    let weights = [4, 5].map(|n| L::weight(row[n] as i32, || row[n] as f64));
    unit::mix(&Report { unit, prefix: "" }, [texel(0), texel(1), texel(2), texel(3)], weights, observer)
}

/// The linear filter of four texels.
pub(super) struct Bilinear;

impl Unit for Bilinear {
    known_as!(
        "bilinear", &["TEX-6"],
        "one channel of four texels mixed along u on both rows, then along v; signed channels are -128..127";
        shows ..4 => 3..;
        takes [footprint_of_one_channel()];
        gives [Column::results(["mid.row0", "mid.row1", "out.value"], Kind::Signed(9))]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        let texels = &inputs[..4];
        texels.iter().all(|t| *t >= 0) || texels.iter().all(|t| *t < 128)
    }

    fn fit(&self, inputs: &mut [i64]) {
        if inputs[..4].iter().any(|t| *t < 0) {
            inputs[..4].iter_mut().filter(|t| **t > 127).for_each(|t| *t -= 128);
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let texels = [0, 1, 2, 3].map(|n| inputs[n] as i32);
        let mut steps = results.iter_mut();
        filter::bilinear(texels, inputs[4] as i32, inputs[5] as i32, |value| {
            steps.next().into_iter().for_each(|step| *step = value.into());
            value
        });
    }

    fn trace(&self, inputs: &[i64], _: &Conditions, recorder: &mut Recorder) {
        // Texels of 0 to 127 mean the same in signed and unsigned channels.
        let unit = one_channel(inputs[..4].iter().any(|t| *t < 0));
        mixed::<Pair>(&unit, inputs, recorder);
    }
}

/// A filtered channel, loaded into its register.
pub(super) struct FilteredChannel;

impl FilteredChannel {
    /// Returns the filtered texels of a row, and the register that they become.
    fn run<L: Lane>(
        &self,
        inputs: &[i64],
        _: impl Fn(usize) -> L,
        _: &Conditions,
        observer: &mut impl Observer,
    ) -> [L; 2] {
        let unit = one_channel(inputs[0] != 0);
        let mixed = mixed(&unit, &inputs[1..], observer);
        [mixed[0], unit::load(&unit, mixed, "", observer)[0]]
    }
}

impl Unit for FilteredChannel {
    known_as!(
        "filtered-channel", &["TEX-6", "TEX-18"],
        "one channel of four texels, filtered and loaded into its register; a signed one (-128..127) is doubled";
        shows 1..5 => 1..;
        takes [Column::flag("cfg.signed"), footprint_of_one_channel()];
        gives [Column::results(["mid.value", "out.register"], Kind::Signed(9))]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        let texels = if inputs[0] != 0 { -128..128 } else { 0..256 };
        inputs[1..5].iter().all(|t| texels.contains(t))
    }

    fn fit(&self, inputs: &mut [i64]) {
        let least = -128 * inputs[0];
        inputs[1..5].iter_mut().for_each(|t| *t = (*t & 255) + least);
    }

    computed!(run);
}

/// Returns a unit with a cube map of one level.
fn cube(side: i64) -> PlannedUnit {
    let side = side as u32;
    let levels = vec![Level { offset: 0, width: side, height: side }];
    let of = planned(TextureUnit::new(0), TextureFormat::R5G6B5);
    PlannedUnit { kind: TextureKind::Cube, levels, face_words: side as usize * side as usize, ..of }
}

/// Returns the face of a look-up, and u and v on it in 1/256 texel.
fn met<O: Observer>(unit: &PlannedUnit, place: &impl SampleCoordinates, observer: &mut O) -> [i64; 3] {
    let (level, face) = (&unit.levels[0], place.face());
    let floored = place.on(level);
    if O::ON {
        let ideal = place.real(Some(face)).st.map(|c| real_coordinate(c, level.width));
        place.describe(&Report { unit, prefix: "" }, level, floored, ideal, observer);
    }
    [face as i64, floored[0], floored[1]]
}

/// A look-up in a cube map by an interpolated direction.
pub(super) struct CubeDirection;

impl CubeDirection {
    fn run(&self, inputs: &[i64], _: &Conditions, observer: &mut impl Observer) -> [i64; 3] {
        let (unit, [x, y, z]) = (cube(inputs[0]), [1, 2, 3].map(|n| inputs[n] as f32));
        let found = with_place([x, y, z, 1.0], |at, vertices| {
            let coordinates = &Coordinates::new(vertices.coordinates(0), &unit);
            let place = VertexCoordinates { unit: &unit, coordinates, at, pixel: (0, 0), vertices, perspective: true };
            met(&unit, &place, observer)
        });
        found.unwrap_or_default()
    }
}

impl Unit for CubeDirection {
    known_as!(
        "cube-direction", &["TEX-12", "TEX-13"],
        "the face of a cube map in an interpolated direction (whole numbers), and u and v on it in 1/256 texel", Geometry;
        takes [
            Column::listed("cfg.size", Kind::Unsigned(13), &[1, 2, 16, 64, 256, 512]),
            ["in.x", "in.y", "in.z"].map(|name| Column::signed(name, 26, -(1 << 24), 1 << 24)),
        ];
        gives [
            Column::result("out.face", Kind::Name(Face::NAMES)),
            Column::results(["out.u", "out.v"], Kind::Unsigned(18)),
        ]
    );

    fn fit(&self, inputs: &mut [i64]) {
        // Small numbers, some of them equal and some nearly equal.
        let small = inputs[1] & 3;
        for n in 1..4 {
            if small == 0 {
                inputs[n] = inputs[n].rem_euclid(5) - 2;
            } else if small == 1 && inputs[n] & 8 != 0 {
                inputs[n] = inputs[1] + inputs[n] % 3;
            }
            inputs[n] = inputs[n].clamp(-(1 << 24), 1 << 24);
        }
    }

    computed!(plain run);
}

/// A look-up in a cube map by a direction of the dot unit.
pub(super) struct CubeFace;

impl CubeFace {
    fn run(&self, inputs: &[i64], _: &Conditions, observer: &mut impl Observer) -> [i64; 3] {
        let unit = cube(inputs[0]);
        let target = Target::Vector([1, 2, 3].map(|n| float(inputs[n])));
        let real = target.followed(|| [0.0; 2]);
        met(&unit, &Dependent { unit: &unit, target, real, quad: None }, observer)
    }
}

impl Unit for CubeFace {
    known_as!(
        "cube-face", &["TEX-12", "TEX-13"],
        "the face of a cube map that a float direction meets, and u and v on it in 1/256 texel", Geometry;
        takes [
            Column::listed("cfg.size", Kind::Unsigned(13), &[1, 2, 16, 64, 256, 512]),
            ["in.x", "in.y", "in.z"].map(|name| Column::float(name, true, 4)),
        ];
        gives [
            Column::result("out.face", Kind::Name(Face::NAMES)),
            Column::results(["out.u", "out.v"], Kind::Unsigned(18)),
        ]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // Every direction with components -1, 0 and 1, where ties occur.
        let component = |n: i64| [0xbf80_0000, 0, 0x3f80_0000][(n % 3) as usize];
        let infinite = [0x7f80_0000, 0xff80_0000, 0x7fc0_0000].map(|bits| vec![64, bits, 0x3f80_0000, 0]);
        let lattice = (0..27).map(|n| vec![64, component(n), component(n / 3), component(n / 9)]);
        lattice.chain(infinite).collect()
    }

    computed!(plain run);
}

/// A look-up in an image of another kind than the stage's.
pub(super) struct OtherKind;

impl OtherKind {
    fn run(&self, inputs: &[i64], _: &Conditions, observer: &mut impl Observer) -> [i64; 2] {
        let [x, y, z] = [2, 3, 4].map(|n| float(inputs[n]));
        let (turns, of) = (inputs[0] != 0, cube(inputs[1]));
        let (kind, operation, set) = if turns {
            (TextureKind::TwoDimensional, ShaderOperation::SampleCube, [x, y, z, 1.0])
        } else {
            (TextureKind::Cube, ShaderOperation::Sample2D, [x, y, 0.0, z])
        };
        let unit = PlannedUnit { kind, stage: ShaderStage { operation, ..of.stage }, ..of };
        let found = with_place(set, |at, vertices| {
            let coordinates = &Coordinates::new(vertices.coordinates(0), &unit);
            let place = VertexCoordinates { unit: &unit, coordinates, at, pixel: (0, 0), vertices, perspective: true };
            met(&unit, &place, observer)
        });
        let [_, u, v] = found.unwrap_or_default();
        [u, v]
    }
}

impl Unit for OtherKind {
    known_as!(
        "other-kind", &["TEX-20"],
        "u and v in 1/256 texel of a two-dimensional image in a direction, or of a cube map at s, t and q (floats)", Geometry;
        on &[Profile::Nv2a];
        takes [
            Column::flag("cfg.direction"),
            Column::listed("cfg.size", Kind::Unsigned(13), &[1, 2, 16, 64, 256, 512]),
            ["in.x", "in.y", "in.z"].map(|name| Column::float(name, true, 4)),
        ];
        gives [Column::results(["out.u", "out.v"], Kind::Signed(26))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // Every direction with components -1, 0 and 1, and all signs of s and t over q.
        let component = |n: i64| [0xbf80_0000, 0, 0x3f80_0000][(n % 3) as usize];
        (0..54).map(|n| vec![n / 27, 64, component(n), component(n / 3), component(n / 9)]).collect()
    }

    computed!(plain run);
}

/// The filter and the levels for a level of detail.
pub(super) struct LevelChoice;

impl Unit for LevelChoice {
    known_as!(
        "level-choice", &["TEX-9", "TEX-10", "TEX-11"],
        "the lod, in 256ths, of coordinates at three pixels of a quad (1/65536 texel), then filter, levels and their weight", Geometry;
        takes [
            ["cfg.min_filter", "cfg.mag_filter"].map(Column::choice::<Filter>),
            Column::choice::<MipFilter>("cfg.mip_filter"),
            Column::unsigned("cfg.levels", 4, 10),
            Column::signed("cfg.lod_bias", 13, -4096, 4095),
            ["cfg.min_lod", "cfg.max_lod"].map(|name| Column::unsigned(name, 12, 4095)),
            footprint(),
        ];
        gives [
            Column::results(["mid.log2_ratio", "mid.lod"], Kind::Signed(16)),
            Column::result("out.filter", Kind::Name(Filter::NAMES)),
            Column::results(["out.level", "out.next_level"], Kind::Unsigned(4)),
            Column::result("out.weight", Kind::Unsigned(8)),
        ]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        inputs[3] >= 1 && inputs[5] <= inputs[6]
    }

    fn fit(&self, inputs: &mut [i64]) {
        inputs[3] = inputs[3].max(1);
        // Biases and ratios that usually lie among the levels.
        if inputs[4] & 1 == 0 {
            inputs[4] /= 8;
        }
        if inputs[5] > inputs[6] {
            inputs.swap(5, 6);
        }
        let shift = (inputs[7] ^ inputs[8]) & 15;
        inputs[7..11].iter_mut().for_each(|along| *along >>= shift);
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let state = TextureUnit {
            min_filter: named(inputs[0]),
            mag_filter: named(inputs[1]),
            mip_filter: named(inputs[2]),
            lod_bias: inputs[4] as i32,
            min_lod: inputs[5] as i32,
            max_lod: inputs[6] as i32,
            ..TextureUnit::new(0)
        };
        let side = 1 << 9;
        let (levels, face_words) = Level::chain(TextureFormat::A8R8G8B8, side, side, inputs[3] as u32, false);
        let unit = PlannedUnit { levels, face_words, ..planned(state, TextureFormat::A8R8G8B8) };
        let log2_ratio = lod::log2_ratio(Some([[0, 0], [inputs[7], inputs[8]], [inputs[9], inputs[10]]]));
        let biased = lod::biased(&unit, log2_ratio);
        let choice = lod::choose(&unit, biased);
        let (next, weight) = choice.next.unwrap_or((choice.level, 0));
        let numbers =
            [log2_ratio.into(), biased.into(), choice.filter as i64, choice.level as i64, next as i64, weight.into()];
        results.copy_from_slice(&numbers);
    }
}
