//! TEX-9 to TEX-11 for boxes of small triangles: level 0 of a sampler around them, set up eight at a time.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::base_level::{BaseLevel, Slopes, bounds_on_planes, least_around, up_of_quads};
use super::compiled::Sampler;
use super::quotient::{Line, SLACK, larger, power, whole};
use super::ratios::OfVertices;
use super::shapes::{Each, Edges, GROUP, Lines, smaller, sum};

/// Level 0 of a sampler whose coordinates are divided by D.
#[derive(Debug, Default)]
pub(super) struct BoxLevels {
    /// u and v, 1/256 texel.
    lines: [Lines; 2],
    /// As in [`BaseLevel`].
    off: Each<f64>,
    floors: Each<f64>,
    gaps: [Each<f64>; 2],
    /// As in [`Slopes`].
    denominator: [Each<f32>; 2],
    right: [Each<f32>; 2],
    below: [Each<f32>; 2],
    cross: [Each<f32>; 2],
    margins: [Each<f32>; 2],
}

impl BoxLevels {
    /// Sets up all boxes, of so many columns and rows, from s and t. `shifts` are those of the smallest level. Clears `proves` where nothing would be
    /// proved.
    #[inline(always)]
    pub(super) fn set_up<const FMA: bool>(
        &mut self,
        (edges, [columns, rows]): (&Edges, &[Each<f64>; 2]),
        at: &[OfVertices; 2],
        (sampler, shifts): (&Sampler, [u32; 2]),
        proves: &mut Each<i32>,
    ) {
        let (mut g, mut reach) = ([[[0.0; GROUP]; 3]; 2], [[0.0; GROUP]; 2]);
        for axis in 0..2 {
            let (side, shift) = (f64::from(256 * sampler.sides[axis]), shifts[axis] as i32);
            let (step, steps) = (power(shift), power(-shift));
            for n in 0..GROUP {
                let place = |k: usize| f64::from(at[axis][k][n]) * side;
                let [a, b, c] = [place(0), place(1), place(2)];
                (g[axis][0][n], g[axis][1][n], g[axis][2][n]) =
                    (a * edges.p[0][n], b * edges.p[1][n], c * edges.p[2][n]);
                reach[axis][n] = larger(larger(a.abs(), b.abs()), c.abs()) + 260.0;
                // Then they are whole on every level, and nothing is lost.
                let is_whole = |at: f64| whole(at * steps) == at * steps;
                let gap = edges.gap[n] * step;
                self.gaps[axis][n] = if is_whole(a) & is_whole(b) & is_whole(c) { gap } else { 0.0 };
            }
        }
        let [(along, of_u), (down, of_v)] = [edges.function::<FMA>(&g[0]), edges.function::<FMA>(&g[1])];
        let up = sampler.up.map(|up| up_of_quads(up) / 256.0);
        for n in 0..GROUP {
            let at = |of: &[Each<f64>; 3]| [of[0][n], of[1][n], of[2][n]];
            let (p, denominator, reach) = (at(&edges.p), edges.denominator.of(n), [reach[0][n], reach[1][n]]);
            let around = [columns[n] + 1.0, rows[n] + 1.0];
            let lowest = least_around(denominator, 1.0, around);
            let of_d = sum::<FMA>(&p, &at(&edges.terms));
            let least = smaller(smaller(p[0], p[1]), p[2]);
            let (range, floors) = bounds_on_planes((lowest, of_d), [of_u[n], of_v[n]], reach, least);
            let base = BaseLevel {
                along: along.of(n).plus(denominator.times(up[0])),
                down: down.of(n).plus(denominator.times(up[1])),
                denominator,
                lowest,
                reach: around,
                // Values at the vertices are not floored here.
                off: range * SLACK + floors,
                floors,
                ..BaseLevel::default()
            };
            let (slopes, is) = Slopes::with_proof(&base);
            for (to, line) in self.lines.iter_mut().zip([base.along, base.down]) {
                (to.c[n], to.x[n], to.y[n]) = (line.c, line.x, line.y);
            }
            (self.off[n], self.floors[n]) = (base.off, base.floors);
            for k in 0..2 {
                (self.denominator[k][n], self.right[k][n]) = (slopes.denominator[k], slopes.right[k]);
                (self.below[k][n], self.cross[k][n]) = (slopes.below[k], slopes.cross[k]);
                self.margins[k][n] = slopes.margins[k];
            }
            proves[n] &= -i32::from(is & base.proves(range, lowest));
        }
    }

    /// Returns level 0 around a box where D is the `denominator`.
    #[inline(always)]
    pub(super) fn of(&self, n: usize, denominator: Line, sampler: &Sampler) -> BaseLevel<'static> {
        let both = |of: &[Each<f32>; 2]| [of[0][n], of[1][n]];
        let gap = |axis: usize| (self.gaps[axis][n], if self.gaps[axis][n] > 0.0 { u32::MAX } else { 0 });
        BaseLevel {
            along: self.lines[0].of(n),
            down: self.lines[1].of(n),
            denominator,
            up: sampler.up.map(up_of_quads),
            off: self.off[n],
            floors: self.floors[n],
            by_d: true,
            gaps: [gap(0), gap(1)],
            slopes: Some(Slopes {
                denominator: both(&self.denominator),
                right: both(&self.right),
                below: both(&self.below),
                cross: both(&self.cross),
                margins: both(&self.margins),
            }),
            ..BaseLevel::default()
        }
    }
}
