//! Real numbers on texels, interpolated without rounding.

/// A picture of real numbers, `N` for each texel.
#[derive(Clone, Debug, PartialEq)]
pub struct Field<const N: usize> {
    /// Number of columns.
    pub(crate) width: u32,
    /// Number of rows.
    pub(crate) height: u32,
    /// `width * height` texels, row by row from the top.
    pub(crate) texels: Vec<[f64; N]>,
    /// Whether the picture repeats; otherwise its edges extend outward.
    pub(crate) wrap: bool,
}

impl<const N: usize> Field<N> {
    /// Interpolates bilinearly at s, t, which go from 0 to 1 across the picture. A texel's own value is at its centre.
    pub(crate) fn at(&self, [s, t]: [f64; 2]) -> [f64; N] {
        let (x, y) = (s * f64::from(self.width) - 0.5, t * f64::from(self.height) - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (right_weight, bottom_weight) = (x - left, y - top);
        let texel = |dx: f64, dy: f64| {
            let (column, row) = (self.index(left + dx, self.width), self.index(top + dy, self.height));
            self.texels.get(row * self.width as usize + column).copied().unwrap_or([0.0; N])
        };
        let corners = [texel(0.0, 0.0), texel(1.0, 0.0), texel(0.0, 1.0), texel(1.0, 1.0)];
        std::array::from_fn(|n| {
            let mix = |a: f64, b: f64, weight: f64| a + (b - a) * weight;
            let top = mix(corners[0][n], corners[1][n], right_weight);
            mix(top, mix(corners[2][n], corners[3][n], right_weight), bottom_weight)
        })
    }

    fn index(&self, texel: f64, count: u32) -> usize {
        let count = f64::from(count.max(1));
        let inside = if self.wrap { texel - (texel / count).floor() * count } else { texel.clamp(0.0, count - 1.0) };
        // `inside` may be `count` where the quotient has been rounded up.
        inside.min(count - 1.0) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_hold_at_their_centres_and_mix_between_them() {
        let mut field = Field { width: 2, height: 2, texels: vec![[0.0], [4.0], [8.0], [12.0]], wrap: false };
        assert_eq!(field.at([0.25, 0.25]), [0.0]);
        assert_eq!(field.at([0.75, 0.75]), [12.0]);
        assert_eq!(field.at([0.5, 0.5]), [6.0]);
        assert_eq!((field.at([-3.0, 0.25]), field.at([9.0, 0.25])), ([0.0], [4.0]));
        field.wrap = true;
        assert_eq!((field.at([0.0, 0.25]), field.at([1.0, 0.25]), field.at([-0.75, 2.75])), ([2.0], [2.0], [8.0]));
    }
}
