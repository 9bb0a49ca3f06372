//! Compares listings of arithmetic in texts about the techniques with the model.

use ninebit::combiner::general::dot_product;
use ninebit::combiner::mapping::expand_normal;
use ninebit::number::Sum;

/// Returns the dot product of an early text on DOT3, in single precision: bytes are scaled about 127.5, negative results become 0, and the
/// result is multiplied by 255.
fn listed(a: [u8; 3], b: [u8; 3]) -> f32 {
    let scaled = |byte: u8| (f32::from(byte) - 127.5) / 127.5;
    let dot = scaled(a[0]) * scaled(b[0]) + scaled(a[1]) * scaled(b[1]) + scaled(a[2]) * scaled(b[2]);
    (dot * 255.0).max(0.0)
}

/// Returns the result of the chip: expanded inputs, the dot product, and what a picture shows of it (CMB-3, CMB-8, NUM-2).
fn model(a: [u8; 3], b: [u8; 3]) -> i32 {
    let vector = |bytes: [u8; 3]| bytes.map(|byte| expand_normal(i32::from(byte)));
    dot_product(vector(a), vector(b)).rounded().clamp(0, 255)
}

/// Visits a million pairs of vectors: all combinations of ten bytes over the whole range, both middle values included.
fn sample(mut visit: impl FnMut([u8; 3], [u8; 3])) {
    let steps = [0, 34, 68, 102, 127, 128, 153, 187, 221, 255];
    for n in 0..10_usize.pow(6) {
        let byte = |place: u32| steps[n / 10_usize.pow(place) % 10];
        visit([byte(0), byte(1), byte(2)], [byte(3), byte(4), byte(5)]);
    }
}

/// If the dot product is at most 1, the results differ by a few levels. The chip centres on 128 and rounds, the listing centres on 127.5
/// and truncates.
#[test]
fn the_listed_dot_product_is_the_model_s_within_a_few_levels() {
    let (mut largest, mut equal, mut count) = (0, 0_u64, 0_u64);
    sample(|a, b| {
        let value = listed(a, b);
        if value <= 255.0 {
            let difference = (value as i32 - model(a, b)).abs();
            largest = largest.max(difference);
            equal += u64::from(difference == 0);
            count += 1;
        }
    });
    // 588,110 of the 945,000 results are equal.
    assert_eq!((count, equal, largest), (945_000, 588_110, 5));
}

/// Above 1 the chip is limited to 255. The listing's conversion to a byte keeps the low eight bits and begins again at 0.
#[test]
fn above_one_the_listing_wraps_and_the_chip_does_not() {
    let (mut above, mut wrapped) = (0_u64, 0_u64);
    sample(|a, b| {
        let value = listed(a, b);
        if value >= 256.0 {
            above += 1;
            let low = (value as u32 & 0xff) as i32;
            wrapped += u64::from(low < model(a, b));
            assert!(model(a, b) >= 249, "{a:?} {b:?}");
        }
    });
    assert_eq!((above, wrapped), (51_808, 51_568));
}
