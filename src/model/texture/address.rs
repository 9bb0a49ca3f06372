//! TEX-7, TEX-8: address modes, which handle texel indices outside the image.

use crate::number::Integer;
use crate::state::{AddressMode, BORDER_TEXELS};

/// Maps texel index `i` into 0..n. Returns `None` for the border colour. If the texture has border texels,
/// [`AddressMode::ClampToBorder`] addresses them and returns -4..n+4; the other modes never do.
#[inline(always)]
pub fn address(mode: AddressMode, i: i64, n: u32, border_texels: bool) -> Option<i64> {
    let is_outside = shows_border_color(mode, border_texels) && !(0..i64::from(n)).contains(&i);
    (!is_outside).then(|| texel_index(mode, i, n.into(), border_texels))
}

/// TEX-7: returns whether texel indices outside the image address the border colour.
#[inline(always)]
pub fn shows_border_color(mode: AddressMode, border_texels: bool) -> bool {
    mode == AddressMode::ClampToBorder && !border_texels
}

/// TEX-7, TEX-8: returns the index of the texel that index `i` addresses; for the border colour, that of the nearest one.
#[inline(always)]
pub fn texel_index<I: Integer>(mode: AddressMode, i: I, size: I, border_texels: bool) -> I {
    let last = size - I::new(1);
    match mode {
        AddressMode::Wrap => i.modulo(size),
        AddressMode::Mirror => {
            let folded = i.modulo(size + size);
            folded.least(size + last - folded)
        }
        AddressMode::ClampToBorder if border_texels => {
            let beyond = I::new(BORDER_TEXELS.into());
            i.least(last + beyond).greatest(I::new(0) - beyond)
        }
        AddressMode::ClampToEdge | AddressMode::Clamp | AddressMode::ClampToBorder => i.least(last).greatest(I::new(0)),
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
