//! Smooth polygons and lines: eight samples of a pixel (SMO-1), and colours where its centre is not covered (SMO-2).

use super::binary::Binary;
use super::setup::Triangle;
use super::stroke::{Figure, Range, Side, within};

/// Samples of a pixel.
pub const SAMPLES: i64 = 8;

/// SMO-1: returns the distance of sample k from the pixel's centre, right and down in 1/16 pixel.
pub fn offset(k: i64) -> [i64; 2] {
    [6 * k % 16 - 8, 2 * k - 8]
}

/// SMO-1: returns an alpha where so many samples are covered.
pub fn covered_alpha(alpha: i64, samples: i64) -> i64 {
    alpha * samples / SAMPLES
}

/// Returns the pixels that have samples between the outermost centres of a half-open range of pixels: a sample is less than a pixel from the centre.
pub(super) fn widened((first, end): Range) -> Range {
    (first - 1, end + 1)
}

/// Returns a limit as it is at a sample. Slopes are multiples of 16.
fn at_sample([a, b, c]: Side, k: i64) -> Side {
    let [right, down] = offset(k);
    [a, b, c + a / 16 * right + b / 16 * down]
}

/// SMO-2: returns 256 b toward zero, of a weight b of WGT-1 of any sign. A weight is below 2^31, because no sum is less than the 29th bit of its largest
/// term.
pub fn color_weight(b: Binary) -> i64 {
    b.steps(-8)
}

/// SMO-2: returns a colour channel of the vertices with weights W0 and W2, limited to what they have.
pub fn color(c: [u8; 3], [w0, w2]: [i64; 2]) -> u8 {
    let [first, second, third] = c.map(i64::from);
    let sum = first * w0 + second * (256 - w0 - w2) + third * w2;
    let (least, most) = (first.min(second).min(third), first.max(second).max(third));
    ((sum + 128) >> 8).clamp(least, most) as u8
}

impl Triangle {
    /// Returns a triangle with smooth edges.
    #[must_use]
    pub fn smooth(self) -> Triangle {
        Triangle { is_smooth: true, rows: widened(self.rows), columns: widened(self.columns), ..self }
    }

    /// SMO-1: returns how many samples of a pixel smooth edges cover, 0 to 8.
    pub fn covered_samples(&self, i: i64, j: i64) -> i64 {
        let is_in = |range: Range, n: i64| (range.0..range.1).contains(&n);
        if !is_in(self.columns, i) || !is_in(self.rows, j) {
            return 0;
        }
        let limits = self.smooth_limits();
        let covers = |k: &i64| {
            limits.iter().all(|limit| {
                let [a, b, c] = at_sample(*limit, *k);
                a * i + b * j + c >= 0
            })
        };
        (0..SAMPLES).filter(covers).count() as i64
    }

    /// Returns the columns of row j from the first to the last in which smooth edges cover samples, as a half-open range within `columns`.
    pub(super) fn smooth_span(&self, j: i64, columns: Range) -> Range {
        if !(self.rows.0..self.rows.1).contains(&j) {
            return (0, 0);
        }
        let columns = (columns.0.max(self.columns.0), columns.1.min(self.columns.1));
        let limits = self.smooth_limits();
        let spans = (0..SAMPLES).map(|k| within(limits.map(|limit| at_sample(limit, k)), j, columns));
        let covered = spans.filter(|span| span.0 < span.1);
        covered.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((0, 0))
    }

    fn smooth_limits(&self) -> [Side; 4] {
        if self.figure != Figure::Triangle {
            return self.sides;
        }
        let [first, second, third] = self.limits();
        [first, second, third, third]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::state::{LineRasterization, Lines};

    /// The samples lie in eight columns and eight rows, one in each.
    #[test]
    fn samples_as_captured() {
        let offsets: Vec<[i64; 2]> = (0..SAMPLES).map(offset).collect();
        assert_eq!(offsets, [[-8, -8], [-2, -6], [4, -4], [-6, -2], [0, 0], [6, 2], [-4, 4], [2, 6]]);
        assert_eq!(
            (0..=8).map(|n| covered_alpha(255, n)).collect::<Vec<_>>(),
            [0, 31, 63, 95, 127, 159, 191, 223, 255]
        );
    }

    /// The pixels with samples lie within the span, and both ends of it have some.
    #[test]
    fn spans_hold_the_pixels_with_samples() {
        let mut random = Random::seeded(7);
        for round in 0..2000 {
            let mut at = || random.below(400) as i64 - 60;
            let [x, y] = [[at(), at(), at()], [at(), at(), at()]];
            let mut figure = Triangle::default();
            if round % 2 == 0 {
                let lines =
                    Lines { width: (at() + 60) as u16 / 8, rasterization: LineRasterization::RectangularSmooth };
                figure = Triangle::line([[x[0], y[0]], [x[1], y[1]]], lines);
            } else if figure.place_corners(x, y) {
                figure = figure.smooth();
            } else {
                continue;
            }
            for j in -8..30 {
                let (low, high) = figure.span(j, (-8, 30));
                let with: Vec<i64> = (-8..30).filter(|i| figure.covered_samples(*i, j) > 0).collect();
                let ends = with.first().zip(with.last()).map(|(first, last)| (*first, last + 1));
                assert_eq!(ends.unwrap_or((0, 0)), (low, high.max(low)), "{x:?} {y:?} {j}");
            }
        }
    }

    #[test]
    fn colors_stay_among_those_of_the_vertices() {
        assert_eq!(
            [color([10, 20, 30], [-400, 0]), color([10, 20, 30], [0, 700]), color([10, 20, 30], [128, 0])],
            [30, 30, 15]
        );
        assert_eq!([-0.003_f32, -0.004, 1.5].map(|b| color_weight(Binary::new(b))), [0, -1, 384]);
    }
}
