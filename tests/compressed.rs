//! Blocks of DXT1, DXT3 and DXT5 against a decoder that others wrote (`bcdec_rs`), and where and why the two differ.
//!
//! That decoder's colours are the bytes nearest to the real numbers. The chips' are not: end points are widened by repeating bits (3 of 31 is 24,
//! not 25), thirds are taken of bytes already rounded (TEX-2), nv2a dithers DXT1 (TEX-3), nv10 mixes it at five and six bits (TEX-4). Which
//! texel gets which mix, and which is transparent, must be the same.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use ninebit::state::TextureFormat;
use ninebit_test_support::blocks::differences;

/// One step: where bits are repeated, and where a third of rounded bytes falls on the other side.
#[test]
fn dxt3_and_dxt5_are_within_a_step() {
    let dxt3 = differences(TextureFormat::Dxt3, true, &|block, out| bcdec_rs::bc2(block, out, 16));
    assert_eq!(dxt3, [(-1, 1), (-1, 1), (-1, 1), (0, 0)]);
    let dxt5 = differences(TextureFormat::Dxt5, true, &|block, out| bcdec_rs::bc3(block, out, 16));
    // The other decoder adds 1 before it divides by 7 or 5, which rounds up only from six sevenths or four fifths of a step on; the
    // chip rounds to the nearest.
    assert_eq!(dxt5, [(-1, 1), (-1, 1), (-1, 1), (0, 1)]);
}

/// Dither of three bits moves red and blue, of two bits green; dark colours fall to 0.
#[test]
fn dxt1_of_nv2a_is_dithered() {
    let found = differences(TextureFormat::Dxt1, true, &|block, out| bcdec_rs::bc1(block, out, 16));
    assert_eq!(found, [(-14, 5), (-6, 3), (-14, 5), (0, 0)]);
}

/// A third or half of five bits is up to half a 31st off.
#[test]
fn dxt1_of_nv10_is_mixed_at_its_own_width() {
    let found = differences(TextureFormat::Dxt1, false, &|block, out| bcdec_rs::bc1(block, out, 16));
    assert_eq!(found, [(-3, 5), (-2, 3), (-3, 5), (0, 0)]);
}
