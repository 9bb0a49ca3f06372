//! TEX-7, TEX-8: texel indices outside the image.

use crate::state::AddressMode;

/// The index inside 0..n of texel `i`, or `None` for the border colour. `n` is a power of two.
#[inline]
pub fn address(mode: AddressMode, i: i64, n: u32) -> Option<u32> {
    let last = i64::from(n) - 1;
    match mode {
        AddressMode::Wrap => Some((i & last) as u32),
        AddressMode::Mirror => {
            let folded = i & (2 * last + 1);
            Some(folded.min(2 * last + 1 - folded) as u32)
        }
        AddressMode::ClampToEdge | AddressMode::Clamp => Some(i.clamp(0, last) as u32),
        AddressMode::ClampToBorder => u32::try_from(i).ok().filter(|i| *i < n),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every mode for power-of-two sizes up to 64, against its statement.
    #[test]
    fn modes_by_their_statement() {
        for n in [1_i64, 2, 4, 8, 16, 32, 64] {
            for i in -4096..=4096_i64 {
                let got = |mode| address(mode, i, n as u32).map(i64::from);
                assert_eq!(got(AddressMode::Wrap), Some(i.rem_euclid(n)));
                let period = i.rem_euclid(2 * n);
                assert_eq!(got(AddressMode::Mirror), Some(if period < n { period } else { 2 * n - 1 - period }));
                assert_eq!(got(AddressMode::ClampToEdge), Some(i.max(0).min(n - 1)));
                assert_eq!(got(AddressMode::Clamp), got(AddressMode::ClampToEdge));
                assert_eq!(got(AddressMode::ClampToBorder), (0..n).contains(&i).then_some(i));
            }
        }
    }
}
