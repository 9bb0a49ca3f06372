//! TEX-7, TEX-8: address modes, which handle texel indices outside the image.

use crate::state::{AddressMode, BORDER_TEXELS};

/// Maps texel index `i` into 0..n. Returns `None` for the border colour. If the texture has border texels,
/// [`AddressMode::ClampToBorder`] addresses them and returns -4..n+4; the other modes never do.
#[inline(always)]
pub fn address(mode: AddressMode, i: i64, n: u32, border_texels: bool) -> Option<i64> {
    let size = i64::from(n);
    match mode {
        AddressMode::Wrap if n.is_power_of_two() => Some(i & (size - 1)),
        AddressMode::Wrap => Some(i.rem_euclid(size)),
        AddressMode::Mirror => {
            let last = 2 * size - 1;
            let folded = if n.is_power_of_two() { i & last } else { i.rem_euclid(2 * size) };
            Some(folded.min(last - folded))
        }
        AddressMode::ClampToEdge | AddressMode::Clamp => Some(i.clamp(0, size - 1)),
        AddressMode::ClampToBorder if border_texels => {
            let beyond = i64::from(BORDER_TEXELS);
            Some(i.clamp(-beyond, size - 1 + beyond))
        }
        AddressMode::ClampToBorder => (0..size).contains(&i).then_some(i),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares every mode with its statement, for all sizes up to 64.
    #[test]
    fn modes_by_their_statement() {
        for n in 1..=64_i64 {
            for i in -4096..=4096_i64 {
                let got = |mode| address(mode, i, n as u32, false);
                assert_eq!(got(AddressMode::Wrap), Some(i.rem_euclid(n)));
                let period = i.rem_euclid(2 * n);
                assert_eq!(got(AddressMode::Mirror), Some(if period < n { period } else { 2 * n - 1 - period }));
                assert_eq!(got(AddressMode::ClampToEdge), Some(i.max(0).min(n - 1)));
                assert_eq!(got(AddressMode::Clamp), got(AddressMode::ClampToEdge));
                assert_eq!(got(AddressMode::ClampToBorder), (0..n).contains(&i).then_some(i));
                let bordered = address(AddressMode::ClampToBorder, i, n as u32, true);
                assert_eq!(bordered, Some(i.max(-4).min(n + 3)));
            }
        }
    }
}
