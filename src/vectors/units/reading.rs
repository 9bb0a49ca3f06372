//! Questions that no capture decides. A row follows one reading: the model follows the first, or refuses such a draw. A card's answers name the
//! reading that holds.

use super::depth::{LEAST_W, floats, test};
use super::fog::factor;
use super::raster::{fit, geometry, is_covered, triangle};
use super::sampling::compared;
use super::texture::planned;
use super::{Column, Conditions, Kind, Reach, Unit, color_results, float, named, put, sized};
use ninebit::number::Blend;
use ninebit::raster::binary::Binary;
use ninebit::raster::depth::{DepthPlane, offset, slope, word};
use ninebit::raster::setup::Triangle;
use ninebit::state::{
    self, AddressMode, ColorKeyMode, CompareFunction, DepthFormat, DepthTest, FogFunction, FogMode, Named,
    PolygonOffset, Profile, ShadowReference, TextureFormat, TextureUnit, depth_stencil,
};
use ninebit::texture::{address, anisotropy, color_key, filter, format};
use ninebit::trace::Silent;
use ninebit::vertex::fog::{LightFog, square};

state::named! {
    /// Readings of what a shadow comparison shows under a linear filter.
    enum ShadowReading {
        /// Every depth is compared, and the results are mixed.
        ComparedThenMixed,
        /// The depths are mixed, and the mixture is compared.
        MixedThenCompared,
        /// The nearest depth is compared.
        Nearest,
    }
}

state::named! {
    /// Readings of what a colour key does under a linear filter.
    enum KeyReading {
        /// The key is applied to every texel, and all are mixed.
        KeyedThenMixed,
        /// The texels are mixed, and the key is applied to the mixture.
        MixedThenKeyed,
        /// The texels are mixed, and what the nearest one matches decides.
        Nearest,
    }
}

state::named! {
    /// Readings of the slope that the factor of a polygon offset multiplies in a w buffer.
    enum SlopeReading {
        /// Zero: a factor adds nothing.
        None,
        /// That of w, linear from vertex to vertex.
        VertexW,
        /// That of z, as in a z buffer.
        Z,
        /// That of w at the pixel: the larger difference from the pixels on the right and below.
        PixelW,
    }
}

state::named! {
    /// Readings of what the third parameter of fog multiplies.
    enum ThirdReading {
        /// The square of d.
        Square,
        /// Nothing: it adds nothing.
        None,
        /// d.
        Linear,
    }
}

state::named! {
    /// Readings of the weights of four taps.
    enum WeightReading {
        /// What each covers of the footprint.
        Shares,
        /// A quarter each.
        Equal,
    }
}

state::named! {
    /// Readings of what a linear filter reads outside the image where the address mode is `ClampToBorder`.
    enum BorderReading {
        /// The border colour.
        Border,
        /// The texel at the edge.
        Edge,
    }
}

/// Returns the columns of the weights of the right and the lower texels.
fn weights() -> [Column; 2] {
    ["in.weight_u", "in.weight_v"].map(Column::byte)
}

/// TEX-6: mixes four numbers, row by row, by the two weights in 256ths.
fn mixed(numbers: [i64; 4], weights: &[i64]) -> i64 {
    filter::bilinear(numbers.map(|n| n as i32), weights[0] as i32, weights[1] as i32, |step| step).into()
}

/// TEX-5: returns the number of the nearest of four texels. The centre of the first is at 128/256.
fn nearest(weights: &[i64]) -> usize {
    (filter::nearest(128 + weights[0]) + 2 * filter::nearest(128 + weights[1])) as usize
}

/// A shadow comparison under a linear filter.
pub(super) struct FilteredShadow;

impl Unit for FilteredShadow {
    known_as!(
        "filtered-shadow", &["SHD-1", "DEP-3", "TEX-5", "TEX-6"],
        "an open question, refused in scenes: by a reading, what four depths (Z16) yield under a linear filter where r (a float) is compared", Geometry; on &[Profile::Nv2a];
        takes [
            Column::choice::<ShadowReading>("cfg.reading"),
            Column::choice::<CompareFunction>("cfg.function"),
            Column::float("in.r", false, 17),
            ["in.d00", "in.d10", "in.d01", "in.d11"].map(|name| Column::word(name, 16)),
            weights(),
        ];
        gives [Column::results(["mid.reference", "mid.mixed"], Kind::Hex(16)), Column::result("out.value", Kind::Unsigned(8))]
    );

    fn readings(&self) -> &'static [&'static str] {
        ShadowReading::NAMES
    }

    fn fit(&self, inputs: &mut [i64]) {
        // A reference among the depths.
        inputs[2] = i64::from((((inputs[3] + inputs[4] + inputs[5] + inputs[6]) / 4) as f32).to_bits());
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let shadow = state::ShadowComparison { function: named(inputs[1]), reference: ShadowReference::R };
        let at = [float(inputs[2]), 1.0];
        let compare = |depth: i64| compared(shadow, DepthFormat::Z16, depth_stencil(depth as u32, 0), at);
        let (depths, weights) = ([3, 4, 5, 6].map(|n| inputs[n]), &inputs[7..]);
        let mixture = mixed(depths, weights);
        let [reference, of_mixture] = compare(mixture);
        let value = match named(inputs[0]) {
            ShadowReading::ComparedThenMixed => mixed(depths.map(|depth| compare(depth)[1]), weights),
            ShadowReading::MixedThenCompared => of_mixture,
            ShadowReading::Nearest => compare(depths[nearest(weights)])[1],
        };
        results.copy_from_slice(&[reference, mixture, value]);
    }
}

/// A colour key under a linear filter.
pub(super) struct FilteredKey;

impl Unit for FilteredKey {
    known_as!(
        "filtered-key", &["KEY-1", "TEX-5", "TEX-6"],
        "an open question, refused in scenes: by a reading, what a colour key makes of four texels under a linear filter, all A8R8G8B8", Geometry;
        takes [
            Column::choice::<KeyReading>("cfg.reading"),
            // `Texel` drops fragments, and no reading says when.
            Column::names("cfg.mode", &["Alpha", "Color"]),
            ["in.key", "in.t00", "in.t10", "in.t01", "in.t11"].map(|name| Column::word(name, 32)),
            weights(),
        ];
        gives [color_results(["out"])]
    );

    fn readings(&self) -> &'static [&'static str] {
        KeyReading::NAMES
    }

    fn fit(&self, inputs: &mut [i64]) {
        // A texel that has the key, or all of them.
        let (key, which) = (inputs[2], inputs[2] as usize & 7);
        if which < 6 {
            inputs[3 + which % 4] = key;
        } else if which == 6 {
            inputs[3..7].fill(key);
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let bytes = |word: i64| format::expand(TextureFormat::A8R8G8B8, word as u32);
        let unit = planned(TextureUnit::new(0), TextureFormat::A8R8G8B8);
        let key = state::ColorKey { color: bytes(inputs[2]), mode: named(inputs[1]) };
        let keyed = |key, texel: [u8; 4]| color_key::apply(&unit, &key, texel.map(i32::from), &mut Silent);
        let applied = |key, texel| keyed(key, texel).0.map(|channel| channel as u8);
        let (texels, weights) = ([3, 4, 5, 6].map(|n| bytes(inputs[n])), &inputs[7..]);
        let mix = |texels: [[u8; 4]; 4]| -> [u8; 4] {
            std::array::from_fn(|channel| mixed(texels.map(|texel| texel[channel].into()), weights) as u8)
        };
        let mixture = mix(texels);
        let matches = |texel| keyed(state::ColorKey { mode: ColorKeyMode::Texel, ..key }, texel).1;
        let color = match named(inputs[0]) {
            KeyReading::KeyedThenMixed => mix(texels.map(|texel| applied(key, texel))),
            KeyReading::MixedThenKeyed => applied(key, mixture),
            // A key in the colour of the mixture takes effect on it.
            KeyReading::Nearest if matches(texels[nearest(weights)]) => {
                applied(state::ColorKey { color: mixture, ..key }, mixture)
            }
            KeyReading::Nearest => mixture,
        };
        put(results, color);
    }
}

/// The factor of a polygon offset in a w buffer.
pub(super) struct WBufferSlope;

/// Returns the larger of the differences of w between a pixel and those on its right and below.
fn pixel_slope(plane: &DepthPlane, triangle: &Triangle, [column, row]: [i64; 2]) -> Binary {
    let here = plane.at(triangle.edges(column, row));
    let [right, below] = [[column + 1, row], [column, row + 1]].map(|[column, row]| {
        let there = plane.at(triangle.edges(column, row));
        let apart = there.plus(Binary { mantissa: -here.mantissa, ..here }, 62);
        Binary { mantissa: apart.mantissa.abs(), ..apart }
    });
    if right.is_below(below) { below } else { right }
}

impl Unit for WBufferSlope {
    known_as!(
        "w-buffer-slope", &["DEP-6", "DEP-3", "DEP-5"],
        "an open question, refused in scenes: by a reading, the word of a w buffer (Z24S8) at a covered pixel, from z and w of the vertices and a polygon offset's factor (floats)", Geometry;
        on &[Profile::Nv2a];
        takes [
            Column::choice::<SlopeReading>("cfg.reading"),
            geometry(),
            ["in.z0", "in.z1", "in.z2", "in.w0", "in.w1", "in.w2"].map(|name| Column::float(name, false, 24)),
            Column::float("in.factor", true, 8),
        ];
        gives [Column::result("out.word", Kind::Hex(24))]
    );

    fn readings(&self) -> &'static [&'static str] {
        SlopeReading::NAMES
    }

    fn fit(&self, inputs: &mut [i64]) {
        fit(&mut inputs[1..]);
        // Depths within the buffer, and usually a factor that leaves them there.
        for depth in &mut inputs[9..15] {
            *depth = sized(*depth, (16, 6)) & 0x7fff_ffff;
        }
        if inputs[15] & 7 != 0 {
            inputs[15] = sized(inputs[15], (-3, 6));
        }
    }

    fn accepts(&self, inputs: &[i64], profile: Profile) -> bool {
        is_covered(&inputs[1..], profile) && inputs[12..15].iter().all(|w| *w >= LEAST_W)
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let (format, [z, w]) = (DepthFormat::Z24S8, [floats(&inputs[9..12]), floats(&inputs[12..15])]);
        let triangle = triangle(&inputs[1..], None, conditions.profile).unwrap_or_default();
        let test = DepthTest { w_buffer: true, ..test() };
        let plane = DepthPlane::new(&test, format, &triangle, (z, Some(w))).unwrap_or_default();
        let pixel = [inputs[7], inputs[8]];
        let steepest = match named(inputs[0]) {
            SlopeReading::None => Binary::default(),
            SlopeReading::VertexW => slope(&triangle, w),
            SlopeReading::Z => slope(&triangle, z),
            SlopeReading::PixelW => pixel_slope(&plane, &triangle, pixel),
        };
        let offset = offset(PolygonOffset { bias: 0.0, factor: float(inputs[15]) }, steepest);
        results[0] = word(format, DepthPlane { offset, ..plane }.at(triangle.edges(pixel[0], pixel[1]))).into();
    }
}

/// The third parameter of fog.
pub(super) struct FogThird;

impl Unit for FogThird {
    known_as!(
        "fog-third", &["FOG-3", "FOG-1", "FOG-4"],
        "an open question: by a reading, FOG.a of a coordinate in the mode Exp with the parameters 3/2, p1 and p2 (floats)", Geometry;
        on &[Profile::Nv2a];
        takes [
            Column::choice::<ThirdReading>("cfg.reading"),
            ["in.p1", "in.p2", "in.coordinate"].map(|name| Column::float(name, true, 8)),
        ];
        gives [Column::result("out.byte", Kind::Unsigned(8))]
    );

    fn readings(&self) -> &'static [&'static str] {
        ThirdReading::NAMES
    }

    fn fit(&self, inputs: &mut [i64]) {
        // Usually both terms leave e below 3/2 and within the table.
        if inputs[3] & 7 > 2 {
            for parameter in &mut inputs[1..3] {
                *parameter = sized(*parameter, (-6, 4)) | 1 << 31;
            }
            inputs[3] = sized(inputs[3], (-2, 4)) & 0x7fff_ffff;
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let [p1, p2, d] = [1, 2, 3].map(|n| float(inputs[n]));
        let function = FogFunction { mode: FogMode::Exp, p0: 1.5, p1, p2, per_vertex: false };
        let third = match named(inputs[0]) {
            ThirdReading::Square => square(d),
            ThirdReading::None => 0.0,
            ThirdReading::Linear => d,
        };
        let passed = f32::from_bits(LightFog::of(&function, [d, third]).sum);
        results[0] = factor(function, passed).map_or(0, |found| found.byte.into());
    }
}

/// The weights of four taps.
pub(super) struct TapWeights;

impl Unit for TapWeights {
    known_as!(
        "tap-weights", &["TEX-17"],
        "an open question: by a reading, four taps mixed, the two inner ones first; a footprint's length in 1/65536 texel, with no width", Geometry;
        on &[Profile::Nv2a];
        takes [
            Column::choice::<WeightReading>("cfg.reading"),
            // Others have fewer taps or more.
            [Column::signed("in.length", 20, (2 << 16) + 1, 4 << 16)],
            ["in.tap0", "in.tap1", "in.tap2", "in.tap3"].map(Column::byte),
        ];
        gives [Column::results(["mid.inner", "out.value"], Kind::Unsigned(8))]
    );

    fn readings(&self) -> &'static [&'static str] {
        WeightReading::NAMES
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let weights = match named(inputs[0]) {
            WeightReading::Shares => anisotropy::taps(Some([[0, 0], [inputs[1], 0], [0, 0]]), 4).weights,
            WeightReading::Equal => [64; anisotropy::MAX_TAPS],
        };
        let sum: i32 = inputs[2..].iter().zip(weights).map(|(tap, weight)| (*tap as i32).times(weight)).sum();
        put(results, [weights[0], sum.round8()]);
    }
}

/// The border colour of nv10 under a linear filter.
pub(super) struct BorderFilter;

impl Unit for BorderFilter {
    known_as!(
        "border-filter", &["TEX-7", "TEX-6"],
        "an open question, refused in scenes: by a reading, a channel of two texels and a border colour at a coordinate in 1/256 texel, filtered along one axis", Geometry;
        on &[Profile::Nv10];
        takes [
            Column::choice::<BorderReading>("cfg.reading"),
            [Column::signed("in.u", 12, -1024, 1535)],
            ["in.t0", "in.t1", "in.border"].map(Column::byte),
        ];
        gives [Column::results(["mid.weight", "out.value"], Kind::Unsigned(8))]
    );

    fn readings(&self) -> &'static [&'static str] {
        BorderReading::NAMES
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let mode = match named(inputs[0]) {
            BorderReading::Border => AddressMode::ClampToBorder,
            BorderReading::Edge => AddressMode::ClampToEdge,
        };
        let (index, weight) = filter::linear(inputs[1]);
        let texel = |n| address::address(mode, n, 2, false).map_or(inputs[4], |n| inputs[2 + n as usize]) as i32;
        put(results, [weight, filter::lerp(texel(index), texel(index + 1), weight)]);
    }
}
