//! Generates tables of powers for dependent reads: textures whose rows hold v^n.
//!
//! R, G and B are v to the power n and alpha is u, at the centres of texels: u = (column + 1/2) / width, v = (row + 1/2) / height.
#![allow(clippy::float_arithmetic, reason = "input data: f64 products in a fixed order, rounded")]

use super::*;

/// Permitted sides of a table.
pub const TABLE_SIDES: std::ops::RangeInclusive<u32> = 1..=4096;

/// Generates a table of `width` columns and `height` rows, both clamped to [`TABLE_SIDES`].
pub fn table(width: u32, height: u32, exponent: u32) -> Rgba {
    let [width, height] = [width, height].map(|side| side.clamp(*TABLE_SIDES.start(), *TABLE_SIDES.end()));
    let centre = |index: u32, side: u32| (f64::from(index) + 0.5) / f64::from(side);
    let row = |row: u32| {
        let power = byte(power(centre(row, height), exponent));
        (0..width).map(move |column| [power, power, power, byte(centre(column, width))])
    };
    Rgba { width, height, pixels: (0..height).flat_map(row).collect() }
}

/// Returns `base` to the power `exponent`, by repeated squaring.
pub(crate) fn power(base: f64, exponent: u32) -> f64 {
    let (mut result, mut square, mut left) = (1.0, base, exponent);
    while left > 0 {
        if left & 1 != 0 {
            result *= square;
        }
        square *= square;
        left >>= 1;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_multiply() {
        assert_eq!([0, 1, 2, 5, 10].map(|n| power(2.0, n)), [1.0, 2.0, 4.0, 32.0, 1024.0]);
        assert_eq!(power(0.0, 0), 1.0);
    }

    #[test]
    fn rows_are_powers_and_columns_go_to_alpha() {
        let table = table(2, 4, 2);
        let of_row: Vec<u8> = table.pixels.iter().step_by(2).map(|pixel| pixel[0]).collect();
        // (1/8)^2, (3/8)^2, (5/8)^2, (7/8)^2 times 255, rounded.
        assert_eq!(of_row, [4, 36, 100, 195]);
        assert_eq!(table.pixels[0], [4, 4, 4, 64]);
        assert_eq!(table.pixels[7], [195, 195, 195, 191]);
    }
}
