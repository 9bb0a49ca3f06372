//! Lines and points: the pixels that they cover (LIN-1, LIN-2, PNT-1), and the edge functions that weigh their ends.
//!
//! A line from A to B is set up as a triangle (A, A, B) whose edge functions are E = (0, L - t, t), where t grows from 0 at A to L at B; a point as
//! one whose edge functions are (0, 1, 0). So WGT-1, DEP-1 and all that follows from them hold for both.

use super::GUARD;
use super::setup::Triangle;
use crate::number::Integer;
use crate::state::{CompareFunction, LineRasterization, Lines, PointRasterization, PolygonStipple, named};

named! {
    /// What a draw consists of.
    #[derive(Default)]
    pub enum Figure {
        /// A triangle.
        #[default]
        Triangle = "triangle",
        /// A line.
        Line = "line",
        /// A point.
        Point = "point",
    }
}

/// A limit of a figure's pixels: a i + b j + c is not negative inside, for pixel (i, j).
pub(crate) type Side = [i64; 3];

/// No limit.
const ANYWHERE: Side = [0; 3];

/// A half-open range of columns or rows.
pub(crate) type Range = (i64, i64);

/// Returns the columns and rows within which a line between two positions in 1/16 pixel covers pixels.
pub(crate) fn line_box([from, to]: [[i64; 2]; 2], lines: Lines) -> [Range; 2] {
    let ends = [0, 1].map(|axis| (from[axis].min(to[axis]), from[axis].max(to[axis])));
    if lines.rasterization != LineRasterization::Bresenham {
        let reach = i64::from(lines.width.div_ceil(16));
        let end = |most: i64| if lines.width == 0 { i64::MIN } else { (most >> 4) + reach + 1 };
        return ends.map(|(least, most)| ((least >> 4) - reach, end(most).max((least >> 4) - reach)));
    }
    let forward = [0, 1].map(|axis| to[axis] > from[axis]);
    // Pixels of the other axis lie at most half a pixel beyond the ends; the sides decide.
    let mut of = ends.map(|(least, most)| ((least - 9) >> 4, ((most + 9) >> 4) + 1));
    let above = |n: i64| (n + 15) >> 4;
    if is_x_major(from, to) {
        let ((least, most), late) = (ends[0], i64::from(!forward[0]));
        of[0] = ((least >> 4) + late, (most >> 4) + late);
    } else {
        let ((least, most), early) = (ends[1], i64::from(forward[1]));
        of[1] = (above(least) - early, above(most) - early);
    }
    of
}

/// LIN-2: returns whether a line steps from column to column.
fn is_x_major(from: [i64; 2], to: [i64; 2]) -> bool {
    (to[0] - from[0]).abs() >= (to[1] - from[1]).abs()
}

/// PNT-1: returns the columns and rows that a point of some size in 1/8 pixel covers.
pub(crate) fn point_box(at: [i64; 2], size: u16, rasterization: PointRasterization) -> [Range; 2] {
    if rasterization == PointRasterization::Thin {
        // As along the minor axis of LIN-2: a pixel has its left and its lower edge.
        let [column, row] = [at[0] >> 4, (at[1] - 1) >> 4];
        return [(column, column + 1), (row, row + 1)];
    }
    let half = i64::from(size);
    at.map(|at| match half {
        0 => (at >> 4, (at >> 4) + 1),
        // A distance d of pixel and point counts where -half <= d <= half, but the upper end does not where half is a power of two.
        _ => ((at - half + 7) >> 4, ((at + half - 8 - i64::from(size.is_power_of_two())) >> 4) + 1),
    })
}

/// PNT-2: returns floor(2^`bits` n (1/2 + d / 2 size)) of a picture of n texels, for a distance d of pixel and point. A whole number right of the
/// centre or below it is one less, unless the size is a power of two. A point without size has 1/2.
#[inline]
pub fn sprite_coordinate<I: Integer>(d: I, size: I, n: I, bits: I) -> I {
    let (zero, one) = (I::new(0), I::new(1));
    let (above, half) = ((n * (size + d)).up(bits), size.greatest(one));
    let quotient = above.magnitude().quotient(half.up(one));
    let is_whole = (above.magnitude() - quotient * half.up(one)).is_zero();
    let floor = (zero - quotient - zero.or(is_whole, one)).or(above.is_negative(), quotient);
    let is_power = half.compared(CompareFunction::Equal, one.up(half.bits() - one));
    let is_late = zero.is_below(d) & is_whole & !is_power;
    n.up(bits).down(one).or(size.is_zero(), floor - one.or(is_late, zero))
}

/// STP-1: returns whether filled triangles draw a pixel. Bits of a word lie as the bytes of a picture do: those of the first byte are the first
/// columns, from the highest bit down.
#[inline]
pub fn stipples(stipple: &PolygonStipple, i: i64, j: i64) -> bool {
    let word = stipple.0[31 - (j & 31) as usize];
    word.swap_bytes() << (i & 31) >> 31 != 0
}

/// Returns a limit that holds at 0 on right edges and on horizontal top edges only (LIN-1).
fn tied([a, b, c]: Side) -> Side {
    let counts = a < 0 || (a == 0 && b > 0);
    [a, b, c - i64::from(!counts)]
}

fn negated(side: Side) -> Side {
    side.map(|n| -n)
}

impl Triangle {
    /// Returns a line between two positions in 1/16 pixel, below 2^16 in magnitude. It has one w.
    pub fn line(ends: [[i64; 2]; 2], lines: Lines) -> Triangle {
        let mut line = Triangle::default();
        line.place_line(ends, lines);
        line
    }

    /// Returns a point at a position in 1/16 pixel, below 2^16 in magnitude, of a size in 1/8 pixel.
    pub fn point(at: [i64; 2], size: u16, rasterization: PointRasterization) -> Triangle {
        let mut point = Triangle::default();
        point.place_point(at, size, rasterization);
        point
    }

    /// Sets all fields that do not depend on w to those of a line between two positions in 1/16 pixel.
    pub(crate) fn place_line(&mut self, [from, to]: [[i64; 2]; 2], lines: Lines) {
        debug_assert!(from.iter().chain(&to).all(|n| n.abs() < GUARD));
        let ([dx, dy], [x, y]) = ([to[0] - from[0], to[1] - from[1]], from);
        // 16 (i - x) + 8 and 16 (j - y) + 8 are the distances of a pixel's centre from the first end.
        let (along, length) = match lines.rasterization {
            LineRasterization::Rectangular | LineRasterization::RectangularSmooth => {
                ([16 * dx, 16 * dy, (8 - x) * dx + (8 - y) * dy], dx * dx + dy * dy)
            }
            // The position at which the line leaves a column or a row.
            LineRasterization::Bresenham if is_x_major(from, to) => match dx {
                0.. => ([16, 0, 16 - x], dx),
                _ => ([-16, 0, x], -dx),
            },
            LineRasterization::Bresenham => match dy {
                0.. => ([0, 16, 16 - y], dy),
                _ => ([0, -16, y], -dy),
            },
        };
        let rest = [-along[0], -along[1], length - along[2]];
        self.stroke(Figure::Line, [ANYWHERE, rest, along], line_box([from, to], lines));
        self.doubled_area = length;
        self.is_smooth = lines.rasterization == LineRasterization::RectangularSmooth;
        self.sides = match lines.rasterization {
            LineRasterization::Rectangular | LineRasterization::RectangularSmooth => {
                let across = [-32 * dy, 32 * dx, 2 * ((8 - y) * dx - (8 - x) * dy)];
                let (major, minor) = (dx.abs().max(dy.abs()), dx.abs().min(dy.abs()));
                let reach = i64::from(lines.width) * (2 * major + minor);
                let within = |[a, b, c]: Side| tied([a, b, c + reach]);
                [within(across), within(negated(across)), tied(along), tied(rest)]
            }
            LineRasterization::Bresenham if is_x_major(from, to) => steps([x, y], [dx, dy], false),
            // The roles of the axes are exchanged.
            LineRasterization::Bresenham => steps([y, x], [dy, dx], true).map(|[a, b, c]| [b, a, c]),
        };
    }

    /// Sets all fields that do not depend on w to those of a point.
    pub(crate) fn place_point(&mut self, at: [i64; 2], size: u16, rasterization: PointRasterization) {
        debug_assert!(at.iter().all(|n| n.abs() < GUARD));
        self.stroke(Figure::Point, [ANYWHERE, [0, 0, 1], ANYWHERE], point_box(at, size, rasterization));
        (self.doubled_area, self.sides) = (1, [ANYWHERE; 4]);
    }

    fn stroke(&mut self, figure: Figure, edges: [Side; 3], [columns, rows]: [Range; 2]) {
        (self.figure, self.columns, self.rows) = (figure, columns, rows);
        for k in 0..3 {
            [self.a[k], self.b[k], self.c[k]] = edges[k];
        }
        (self.owns, self.counter_clockwise, self.is_smooth) = ([true; 3], false, false);
    }

    /// Returns the columns of row j that a line or a point covers, as a half-open range within `columns`.
    pub(super) fn stroke_span(&self, j: i64, columns: Range) -> Range {
        let columns = (columns.0.max(self.columns.0), columns.1.min(self.columns.1));
        if (self.rows.0..self.rows.1).contains(&j) { within(self.sides, j, columns) } else { (0, 0) }
    }
}

/// Returns the columns of row j within some limits, as a half-open range within `columns`.
#[inline]
pub(super) fn within<const N: usize>(limits: [Side; N], j: i64, (mut low, mut high): Range) -> Range {
    for [a, b, c] in limits {
        let r = b * j + c;
        match a {
            0 if r < 0 => return (0, 0),
            0 => {}
            a if a > 0 => low = low.max(-r.div_euclid(a)),
            a => high = high.min(r.div_euclid(-a) + 1),
        }
    }
    (low, high.max(low))
}

/// LIN-2: returns the limits of a line that steps along the first axis from `at` by `by`: the pixel of a column is the one in which the line is at
/// the column's centre. `keeps_start` says that the start of a pixel along the second axis counts, and its end does not.
fn steps([x, y]: [i64; 2], [dx, dy]: [i64; 2], keeps_start: bool) -> [Side; 4] {
    let length = dx.abs();
    let rise = dy * dx.signum();
    // The line above the start of the pixel, times the length.
    let above = [16 * rise, -16 * length, y * length + (8 - x) * rise];
    let [a, b, c] = negated(above);
    let below = [a, b, c + 16 * length];
    let strict = |[a, b, c]: Side, is_strict: bool| [a, b, c - i64::from(is_strict)];
    [strict(above, !keeps_start), strict(below, keeps_start), ANYWHERE, ANYWHERE]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    fn line(ends: [[i64; 2]; 2], width: u16, rasterization: LineRasterization) -> Triangle {
        Triangle::line(ends, Lines { width, rasterization })
    }

    fn drawn(figure: &Triangle, i: i64, j: i64) -> bool {
        let (first, end) = figure.span(j, (-5000, 5000));
        (first..end).contains(&i)
    }

    #[test]
    fn wide_lines_as_captured() {
        use LineRasterization::Rectangular;
        let ends = [[2560, 6368], [3520, 6208]];
        let wide = line(ends, 128, Rectangular);
        assert!(drawn(&wide, 170, 396));
        assert_eq!(wide.edges(170, 396), [0, 947_200 - 165_120, 165_120]);
        // Inside of the rectangle, but above its box.
        assert!(!drawn(&line(ends, 256, Rectangular), 215, 371));
        assert!((-9..9).all(|j| !drawn(&line([[0, 0], [300, 0]], 0, Rectangular), 3, j)));
        assert!((-9..9).all(|j| !drawn(&line([[8, 8], [8, 8]], 99, Rectangular), 0, j)));
    }

    #[test]
    fn sprites_as_captured() {
        let texel = |d: i64| sprite_coordinate(d, 192, 32, 8) >> 8;
        assert_eq!([texel(48), texel(-48), texel(-192), texel(192)], [19, 12, 0, 31]);
        assert_eq!([sprite_coordinate(64, 128, 32, 0), sprite_coordinate(0, 0, 32, 8)], [24, 16 << 8]);
        // Left of the point, as quads have it.
        assert_eq!([sprite_coordinate(-129, 128, 32, 0), sprite_coordinate(-193, 192, 6, 6)], [-1, -1]);
    }

    #[test]
    fn points_as_captured() {
        use PointRasterization::{Rectangular, Thin};
        let columns = |size| point_box([404 * 16, 8], size, Rectangular)[0];
        assert_eq!([columns(24), columns(32), columns(8)], [(402, 406), (402, 406), (403, 404)]);
        let (first, end) = columns(4);
        assert!(first >= end);
        assert_eq!(columns(0), (404, 405));
        for size in [0, 8, 511] {
            assert_eq!(point_box([6464, 6464], size, Thin), [(404, 405), (403, 404)]);
            assert_eq!(point_box([6479, 6465], size, Thin), [(404, 405), (404, 405)]);
            assert_eq!(point_box([-1, 0], size, Thin), [(-1, 0), (-1, 0)]);
        }
    }

    /// A line covers what is within its limits, one by one, and nothing outside of its box; thin ones one pixel for each step.
    #[test]
    fn spans_are_the_covered_columns() {
        let mut random = Random::seeded(5);
        for round in 0..4000 {
            let mut at = || random.below(640) as i64 - 100;
            let ends = [[at(), at()], [at(), at()]];
            let width = random.below(80) as u16;
            let rasterization =
                if round % 2 == 0 { LineRasterization::Bresenham } else { LineRasterization::Rectangular };
            let line = line(ends, width, rasterization);
            let mut count = 0;
            for j in -20..60 {
                for i in -20..60 {
                    let inside = line.sides.iter().all(|[a, b, c]| a * i + b * j + c >= 0);
                    let boxed =
                        (line.columns.0..line.columns.1).contains(&i) && (line.rows.0..line.rows.1).contains(&j);
                    assert_eq!(drawn(&line, i, j), inside && boxed, "{ends:?} {width} {i} {j}");
                    if inside && boxed {
                        count += 1;
                        assert!(line.edges(i, j).iter().all(|e| *e >= 0), "{ends:?} {i} {j}");
                    }
                }
            }
            if rasterization == LineRasterization::Bresenham {
                let [columns, rows] = line_box(ends, Lines { width, rasterization });
                let steps = if is_x_major(ends[0], ends[1]) { columns } else { rows };
                assert_eq!(count, steps.1 - steps.0, "{ends:?}");
            }
        }
    }
}
