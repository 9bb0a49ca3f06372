//! Kinds and ranges of values.

/// Kind of a value: a number, or the bits of a stored word or texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// Two's complement, within 64 bits.
    Number,
    /// 32 bits without a sign.
    Word,
    /// A number of the interpolator: a mantissa of 32 bits and a power of two.
    Binary,
}

/// The least and the largest value of a range, both inclusive.
pub type Range = (i64, i64);

/// Returns the range that encloses all ranges.
pub(crate) fn enclosing(ranges: impl Iterator<Item = Range>) -> Range {
    ranges.fold((i64::MAX, i64::MIN), |all, one| (all.0.min(one.0), all.1.max(one.1)))
}

/// Returns whether numbers of a range need more than 32 bits.
pub(crate) fn is_wide(range: Range) -> bool {
    range.0 < i32::MIN.into() || range.1 > i32::MAX.into()
}

/// The range of mantissas of binary numbers.
pub(crate) const MANTISSA: Range = (-i32::MAX as i64, i32::MAX as i64);

/// The range of mantissas of coordinates, and of what rules take that say no more.
pub(crate) const COORDINATE: Range = (-(1 << 26), 1 << 26);

/// The range of mantissas of normal numbers.
pub(crate) const NORMAL: Range = (-(1 << 24), 1 << 24);

/// The range of exponents of binary numbers.
pub(crate) const EXPONENT: Range = (-16000, 16000);

/// The range of binary numbers, which says nothing.
pub(crate) const ANY_BINARY: Range = (i64::MIN, i64::MAX);

/// Bits of a binary number's exponent where both parts are one number.
const EXPONENT_BITS: u32 = 16;

/// Returns a binary number as one.
pub fn packed(mantissa: i64, exponent: i64) -> i64 {
    mantissa << EXPONENT_BITS | (exponent + (1 << (EXPONENT_BITS - 1)))
}

/// Returns mantissa and exponent of a binary number that is one number.
pub(crate) fn unpacked(packed: i64) -> (i64, i64) {
    (packed >> EXPONENT_BITS, (packed & ((1 << EXPONENT_BITS) - 1)) - (1 << (EXPONENT_BITS - 1)))
}
