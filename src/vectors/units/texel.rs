//! Texels: words and blocks as bytes.

use super::shader::NV2A;
use super::{Column, Conditions, Kind, Reach, Unit, color_results, named, put};
use ninebit::state::{Named, Profile, TextureFormat};
use ninebit::texture::{compressed, format, yuv};

/// Returns a column of the formats for which `wanted` is true.
pub(super) fn formats(wanted: fn(TextureFormat) -> bool) -> Column {
    // Depth formats come last. They are compared, not expanded.
    let count = TextureFormat::ALL.iter().take_while(|format| format.depth().is_none()).count();
    let all = &TextureFormat::ALL[..count];
    let numbers: Vec<i64> = (0..).zip(all).filter(|(_, f)| wanted(**f)).map(|(n, _)| n).collect();
    Column::listed("cfg.format", Kind::Name(&TextureFormat::NAMES[..count]), &numbers)
}

fn is_compressed(format: TextureFormat) -> bool {
    matches!(format, TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5)
}

/// The bytes of a texel's word.
pub(super) struct TexelExpansion;

impl Unit for TexelExpansion {
    known_as!(
        "texel-expansion", &["TEX-1"], "the word of a texel as the bytes that a unit reads", Direct;
        takes [formats(|f| !is_compressed(f) && f != TextureFormat::P8), Column::word("in.word", 32)];
        gives [color_results(["out"])]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        inputs[1] >> named::<TextureFormat>(inputs[0]).word_bits() == 0
    }

    fn fit(&self, inputs: &mut [i64]) {
        inputs[1] &= (1 << named::<TextureFormat>(inputs[0]).word_bits()) - 1;
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        put(results, format::expand(named(inputs[0]), inputs[1] as u32));
    }
}

/// The conversion of a register from YUV.
pub(super) struct YuvConversion;

impl Unit for YuvConversion {
    known_as!(
        "yuv-conversion", &["TEX-19"], "Y, Cb and Cr, which a register holds as R, G, B, as a colour", Direct; on NV2A;
        takes [["in.y", "in.cb", "in.cr"].map(Column::byte)];
        gives [["out.r", "out.g", "out.b"].map(|name| Column::result(name, Kind::Unsigned(8)))]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        for (channel, result) in results.iter_mut().enumerate() {
            *result = yuv::converted(channel, [inputs[0], inputs[1], inputs[2]]);
        }
    }
}

/// A texel of a compressed block.
pub(super) struct CompressedBlock;

impl Unit for CompressedBlock {
    known_as!(
        "compressed-block", &["TEX-2", "TEX-3", "TEX-4"],
        "the texel in a column and row of a DXT block; DXT1 has two words, the others four", Direct;
        takes [
            formats(is_compressed),
            ["in.word0", "in.word1", "in.word2", "in.word3"].map(|name| Column::word(name, 32)),
            ["in.column", "in.row"].map(|name| Column::unsigned(name, 2, 3)),
        ];
        gives [color_results(["out"])]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        named::<TextureFormat>(inputs[0]) != TextureFormat::Dxt1 || inputs[3..5] == [0, 0]
    }

    fn fit(&self, inputs: &mut [i64]) {
        if named::<TextureFormat>(inputs[0]) == TextureFormat::Dxt1 {
            inputs[3..5].fill(0);
        }
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let format = named(inputs[0]);
        let words = [1, 2, 3, 4].map(|n| inputs[n] as u32);
        let block = if format == TextureFormat::Dxt1 { &words[..2] } else { &words[..] };
        let dithered = conditions.profile == Profile::Nv2a;
        let decoded = compressed::decode(format, dithered, block, inputs[5] as u32, inputs[6] as u32);
        put(results, decoded.bytes);
    }
}
