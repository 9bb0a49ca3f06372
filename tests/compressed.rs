//! Compares decoded blocks of DXT1, DXT3 and DXT5 with another decoder, `bcdec_rs`, and states where and why they differ.
//!
//! The colours of the other decoder are the bytes nearest to the real numbers. Those of the chips differ: end points are widened by
//! repeating bits (3 of 31 is 24, not 25), thirds are taken of bytes that are already rounded (TEX-2), nv2a dithers DXT1 (TEX-3), and nv10
//! mixes DXT1 at five and six bits (TEX-4). The choice of mixture and of transparency must be the same for every texel.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use ninebit::state::TextureFormat;
use ninebit_test_support::blocks::differences;

/// The difference of one step comes from repeated bits, and from thirds of rounded bytes that round the other way.
#[test]
fn dxt3_and_dxt5_are_within_a_step() {
    let dxt3 = differences(TextureFormat::Dxt3, true, &|block, out| bcdec_rs::bc2(block, out, 16));
    assert_eq!(dxt3, [(-1, 1), (-1, 1), (-1, 1), (0, 0)]);
    let dxt5 = differences(TextureFormat::Dxt5, true, &|block, out| bcdec_rs::bc3(block, out, 16));
    // The other decoder adds 1 before it divides by 7 or 5, and so rounds up only above six sevenths or four fifths of a step. The chip
    // rounds to the nearest.
    assert_eq!(dxt5, [(-1, 1), (-1, 1), (-1, 1), (0, 1)]);
}

/// Dither shifts red and blue by up to three bits and green by up to two. Dark colours become 0.
#[test]
fn dxt1_of_nv2a_is_dithered() {
    let found = differences(TextureFormat::Dxt1, true, &|block, out| bcdec_rs::bc1(block, out, 16));
    assert_eq!(found, [(-14, 5), (-6, 3), (-14, 5), (0, 0)]);
}

/// A third or a half of a five-bit step is up to half of 1/31 off.
#[test]
fn dxt1_of_nv10_is_mixed_at_its_own_width() {
    let found = differences(TextureFormat::Dxt1, false, &|block, out| bcdec_rs::bc1(block, out, 16));
    assert_eq!(found, [(-3, 5), (-2, 3), (-3, 5), (0, 0)]);
}
