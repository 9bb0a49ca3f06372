//! Sampling of volumes and of long footprints, colour keys, and shadow comparisons.

use super::raster;
use super::texel::formats;
use super::texture::{footprint, planned};
use super::{Column, Conditions, Kind, Reach, Unit, float, named};
use ninebit::raster::depth::word;
use ninebit::state::{
    self, AddressMode, ColorKeyMode, CompareFunction, DepthFormat, Named, Profile, ShadowReference, TextureFormat,
    TextureKind, TextureUnit, depth_stencil, largest_anisotropy,
};
use ninebit::texture::coordinates::{Coordinates, SampleCoordinates, VertexCoordinates, wrapped};
use ninebit::texture::fetch::Texel;
use ninebit::texture::planned::PlannedUnit;
use ninebit::texture::unit::layer;
use ninebit::texture::{anisotropy, color_key, format, shadow};
use ninebit::trace::Silent;

/// Calls `then` with interpolated coordinates, where all vertices have the coordinates (0, 0, r, q).
fn with_place<T>(unit: &PlannedUnit, [r, q]: [f32; 2], then: impl FnOnce(&VertexCoordinates<'_>) -> T) -> Option<T> {
    raster::with_place([0.0, 0.0, r, q], |at, vertices| {
        let coordinates = &Coordinates::new(vertices.coordinates(0), unit);
        then(&VertexCoordinates { unit, coordinates, at, pixel: (8, 8), vertices, perspective: false })
    })
}

/// The colour key of a texel.
pub(super) struct ColorKey;

impl Unit for ColorKey {
    known_as!(
        "color-key", &["KEY-1"],
        "what a colour key makes of a texel that a format's word became, both as A8R8G8B8, and whether the fragment is dropped", Geometry;
        takes [Column::choice::<ColorKeyMode>("cfg.mode"), formats(|_| true), Column::word("in.key", 32), Column::word("in.texel", 32)];
        gives [Column::result("out.texel", Kind::Hex(32)), Column::result("out.dropped", Kind::Unsigned(1))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // In each mode and format: equal, and different in one bit of each channel.
        let formats = self.inputs()[1].boundary();
        let modes = 0..ColorKeyMode::ALL.len() as i64;
        let rows = modes.flat_map(|mode| formats.clone().into_iter().map(move |format| (mode, format)));
        rows.flat_map(|(mode, format)| {
            let texel = if named::<TextureFormat>(format).has_alpha() { 0x8012_34ff } else { 0xff12_34ff };
            [0, 1 << 31, 1 << 23, 1 << 8, 1].map(|bit| vec![mode, format, texel ^ bit, texel])
        })
        .collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        // A format without alpha has the alpha 1. Most keys nearly match.
        if !named::<TextureFormat>(inputs[1]).has_alpha() {
            inputs[3] |= 0xff00_0000;
        }
        match inputs[2] & 7 {
            0..3 => inputs[2] = inputs[3],
            3 => inputs[2] = inputs[3] ^ 1 << (inputs[2] >> 3 & 31),
            4 => inputs[2] = inputs[3] ^ inputs[2] & 0xff00_0000,
            _ => {}
        }
    }

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        named::<TextureFormat>(inputs[1]).has_alpha() || inputs[3] >> 24 == 0xff
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let bytes = |word: i64| format::expand(TextureFormat::A8R8G8B8, word as u32);
        let key = state::ColorKey { color: bytes(inputs[2]), mode: named(inputs[0]) };
        let unit = planned(TextureUnit { color_key: Some(key), ..TextureUnit::new(0) }, named(inputs[1]));
        let (keyed, dropped) = color_key::apply(&unit, &key, bytes(inputs[3]).map(i32::from), &mut Silent);
        let [r, g, b, a] = keyed.map(i64::from);
        results.copy_from_slice(&[a << 24 | r << 16 | g << 8 | b, dropped.into()]);
    }
}

/// The comparison of a reference with a depth.
pub(super) struct ShadowComparison;

/// Returns the float that a word of a float format represents.
fn of_word(format: DepthFormat, depth: u32) -> f32 {
    match format {
        DepthFormat::Z16 | DepthFormat::Z24S8 => depth as f32,
        DepthFormat::Z16F => f32::from_bits((depth + 0x78000) << 11),
        DepthFormat::Z24S8F => f32::from_bits(depth << 7),
    }
}

impl Unit for ShadowComparison {
    known_as!(
        "shadow-comparison", &["DEP-3", "SHD-1"],
        "what a texture of depths yields: r/q (floats) as a word of its format, compared with a texel's depth", Geometry; on &[Profile::Nv2a];
        takes [
            Column::choice::<CompareFunction>("cfg.function"),
            Column::choice::<ShadowReference>("cfg.reference"),
            Column::choice::<DepthFormat>("cfg.format"),
            Column::float("in.r", true, 26),
            Column::float("in.q", true, 8),
            Column::word("in.depth", 24),
            Column::word("in.stencil", 8),
        ];
        gives [Column::result("mid.reference", Kind::Hex(24)), Column::result("out.value", Kind::Unsigned(8))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // The handbook's example and its neighbours, with all functions.
        let numbers = [32766.0_f32, 32767.0, 32767.75, 32768.0].map(|r| i64::from(r.to_bits()));
        let one = i64::from(1.0_f32.to_bits());
        let functions = 0..CompareFunction::ALL.len() as i64;
        let rows = functions.flat_map(|function| numbers.map(|r| vec![function, 0, 0, r, one, 0x7fff, 0]));
        rows.chain([vec![1, 1, 0, numbers[1], one, 0x7fff, 0]]).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        let format: DepthFormat = named(inputs[2]);
        inputs[5] &= i64::from(format.largest());
        if !format.has_stencil() {
            inputs[6] = 0;
        }
        // A reference equal to the texel or close to it, if q is a power of two.
        let kind = inputs[3] & 7;
        if kind < 5 {
            let power = (inputs[4] >> 2) % 5 - 2;
            inputs[4] = (127 + power) << 23;
            let bits = i64::from(of_word(format, inputs[5] as u32).to_bits()) + [0, 0, 1, -1, 600][kind as usize];
            inputs[3] = if bits > 0 { (bits + (power << 23)).clamp(0, 0x7f00_0000) } else { 0 };
        }
    }

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        let format: DepthFormat = named(inputs[2]);
        inputs[5] <= i64::from(format.largest()) && (format.has_stencil() || inputs[6] == 0)
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let comparison = state::ShadowComparison { function: named(inputs[0]), reference: named(inputs[1]) };
        let stored = depth_stencil(inputs[5] as u32, inputs[6] as u8);
        results.copy_from_slice(&compared(comparison, named(inputs[2]), stored, [float(inputs[3]), float(inputs[4])]));
    }
}

/// Compares r/q with the stored word of a depth. Returns the word of the reference, and what the texture yields.
pub(super) fn compared(shadow: state::ShadowComparison, format: DepthFormat, stored: u32, at: [f32; 2]) -> [i64; 2] {
    let texture = TextureFormat::ALL.iter().copied().find(|texture| texture.depth() == Some(format));
    let state = TextureUnit { shadow: Some(shadow), ..TextureUnit::new(0) };
    let unit = planned(state, texture.unwrap_or(TextureFormat::Z16));
    let texel = Texel { at: Some([0, 0]), word: stored };
    let found = with_place(&unit, at, |place| {
        let reference = match shadow.reference {
            ShadowReference::R => word(format, place.reference()),
            ShadowReference::Zero => 0,
        };
        let value: [i32; 4] = shadow::compare(&unit, shadow, &texel, place, &mut Silent);
        [reference.into(), value[0].into()]
    });
    found.unwrap_or_default()
}

pub(super) struct VolumeLayer;

impl Unit for VolumeLayer {
    known_as!(
        "volume-layer", &["INT-4", "TEX-7", "TEX-15", "VOL-1"],
        "the layer of a volume that r/q (floats) meets, by the address mode of r; not inside: the border colour", Geometry; on &[Profile::Nv2a];
        takes [
            Column::choice::<AddressMode>("cfg.mode"),
            Column::listed("cfg.layers", Kind::Unsigned(10), &[1, 2, 4, 8, 16, 64, 512]),
            Column::float("in.r", true, 7),
            Column::float("in.q", true, 7),
        ];
        gives [
            Column::result("mid.w", Kind::Signed(26)),
            Column::result("out.inside", Kind::Unsigned(1)),
            Column::result("out.layer", Kind::Unsigned(9)),
        ]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // Layers 0 to 3 of four, their borders, and beyond them, in every mode.
        let modes = 0..AddressMode::ALL.len() as i64;
        let ninths = (-10..=20).map(|n| i64::from((n as f32).to_bits()));
        let rows = ninths.flat_map(|r| modes.clone().map(move |mode| (mode, r)));
        let (seven, eight) = (i64::from(7.0_f32.to_bits()), i64::from(8.0_f32.to_bits()));
        rows.flat_map(|(mode, r)| [seven, eight].map(|q| vec![mode, 4, r, q])).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        // Usually around the image, with q = 1 in half of the rows.
        if inputs[3] & 3 != 0 {
            inputs[2] = inputs[2] & 0x807f_ffff | (122 + (inputs[2] >> 2) % 7) << 23;
        }
        if inputs[3] & 4 != 0 {
            inputs[3] = 127 << 23;
        } else if inputs[3] & 3 != 0 {
            inputs[3] = inputs[3] & 0x807f_ffff | (125 + (inputs[3] >> 4) % 4) << 23;
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let layers = inputs[1] as u32;
        let state = TextureUnit { address_r: named(inputs[0]), ..TextureUnit::new(0) };
        let of = planned(state, TextureFormat::A8R8G8B8);
        let unit = PlannedUnit { kind: TextureKind::ThreeDimensional, layers, ..of };
        with_place(&unit, [float(inputs[2]), float(inputs[3])], |place| {
            let found = layer::<i32, _>(&unit, place, &mut Silent);
            results[0] = place.layer(layers);
            (results[1], results[2]) = (found.is_some().into(), found.unwrap_or(0) as i64);
        });
    }
}

/// The taps of a footprint.
pub(super) struct AnisotropyTaps;

impl Unit for AnisotropyTaps {
    known_as!(
        "anisotropy-taps", &["TEX-11", "TEX-17"],
        "how many taps a footprint has, where each pair lies (1/256 texel, to both sides) and what each of the two weighs; coordinates of a quad in 1/65536 texel", Geometry;
        takes [Column::listed("cfg.limit", Kind::Unsigned(4), &[2, 4, 8]), footprint()]
    );

    fn results(&self) -> Vec<Column> {
        let mut columns = vec![Column::result("out.count", Kind::Unsigned(4))];
        for pair in 0..anisotropy::MAX_PAIRS {
            columns.extend(["u", "v"].map(|axis| Column::result(&format!("out.{axis}{pair}"), Kind::Signed(25))));
            columns.push(Column::result(&format!("out.weight{pair}"), Kind::Unsigned(9)));
        }
        columns
    }

    fn regressions(&self) -> Vec<Vec<i64>> {
        // One texel, and hardly more; twice the other axis; equal lengths; whole multiples of the limits.
        let texel = 1 << 16;
        let axes = [
            [texel, 0, 0, texel / 5],
            [texel + 1, 0, 0, texel / 5],
            [0, 80_347, 13_107, 0],
            [0, 885 * texel, 9, 0],
            [2 * texel, 0, 0, texel],
            [2 * texel, 0, 0, 2 * texel],
            [0, 3 * texel, 3 * texel, 0],
            [3 * texel, 4 * texel, texel, 0],
            [16 * texel, 0, 0, texel],
            [0, 2 * texel, 5 * texel, 0],
            [7 * texel, 0, 0, 3 * texel],
        ];
        axes.into_iter().flat_map(|axes| [2, 4, 8].map(|limit| [&[limit][..], &axes].concat())).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        // A few texels, with one axis up to sixteen times the other.
        let (all, one) = (8 + (inputs[1] & 7), inputs[2] >> 3 & 3);
        let first = if inputs[4] & 1 == 0 { 1 } else { 3 };
        for input in &mut inputs[1..5] {
            *input >>= all;
        }
        for input in &mut inputs[first..first + 2] {
            *input >>= one;
        }
    }

    fn accepts(&self, inputs: &[i64], profile: Profile) -> bool {
        inputs[0] <= i64::from(largest_anisotropy(profile))
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let quad = [[0, 0], [inputs[1], inputs[2]], [inputs[3], inputs[4]]];
        let taps = anisotropy::taps(Some(quad), inputs[0] as u32);
        results[0] = taps.count as i64;
        for (pair, result) in results[1..].chunks_mut(3).enumerate() {
            let [u, v] = taps.offsets[2 * pair];
            result.copy_from_slice(&[u, v, taps.weights[2 * pair].into()]);
        }
    }
}

/// Coordinates that are interpolated the shorter way around.
pub(super) struct CylindricalWrap;

impl Unit for CylindricalWrap {
    known_as!(
        "cylindrical-wrap", &["CYL-1"],
        "s of a triangle's vertices (floats) as they are interpolated where s wraps cylindrically; 0 has no sign", Geometry;
        takes [
            Column::choice::<AddressMode>("cfg.mode"),
            ["in.s0", "in.s1", "in.s2"].map(|name| Column::float(name, true, 8)),
        ];
        gives [Column::results(["out.s0", "out.s1", "out.s2"], Kind::Hex(32))]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // The handbook's example, and differences of halves and wholes in both directions.
        let numbers =
            [[0.9, 0.1, 0.4], [0.25, 0.75, -0.25], [0.0, 1.0, -1.0], [3.0, 0.5, 5.5], [0.0, 0.500_000_06, 1.5]];
        let modes = 0..AddressMode::ALL.len() as i64;
        let rows = modes.flat_map(|mode| numbers.map(|s: [f32; 3]| (mode, s.map(|s| i64::from(s.to_bits())))));
        rows.map(|(mode, s)| [&[mode][..], &s].concat()).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        // Quarters of repeats in every other row.
        if inputs[3] & 1 == 0 {
            for input in &mut inputs[1..] {
                let quarters = (*input >> 4) % 64 - 32;
                #[allow(clippy::float_arithmetic, reason = "choosing coordinates; the product is exact")]
                let s = quarters as f32 * 0.25;
                *input = s.to_bits().into();
            }
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let state = TextureUnit { cylindrical_wrap: [true, false], address_s: named(inputs[0]), ..TextureUnit::new(0) };
        let unit = planned(state, TextureFormat::A8R8G8B8);
        let moved = wrapped(&unit, [1, 2, 3].map(|n| [float(inputs[n]), 0.0, 0.0, 1.0]));
        for (result, [s, ..]) in results.iter_mut().zip(moved) {
            // The sign of zero depends on the machine, and nothing depends on it.
            *result = if s == 0.0 { 0 } else { s.to_bits().into() };
        }
    }
}
