//! NUM-6, FOG-2 and FOG-4 on rows.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use std::sync::LazyLock;

use super::Reason;
use super::kernels::PerLane;
use super::planes::{Plane, inverse};
use super::quotient::{Line, Reciprocals, SLACK, floor_of_factor, nearest, whole};
use super::ratios::{Bounds, OfVertices};
use super::setup::{BatchSetup, PixelBatch, Setup};
use super::shapes::{Each, Edges, GROUP, Lines};
use crate::engine::context::TriangleContext;
use crate::number::convert::factor;
use crate::raster::fog::{self, CENTRE, FogPlane, TABLE_END, exponential};
use crate::raster::interpolate::Sample;
use crate::state::{FogFunction, FogMode};

/// The fog factor of a triangle's pixels.
#[derive(Clone, Copy, Debug)]
pub(super) enum Fog {
    /// It is the same everywhere.
    Same(i16),
    /// A factor in 4096ths, divided by D.
    Factor(Plane),
    /// A function of the fog coordinate.
    Function(Curve),
}

/// A fog coordinate, d' or e, which is divided by D, and its function.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve {
    coordinate: Plane,
    /// What the plane's numbers are multiplied by.
    unit: f64,
    function: Function,
}

/// A function of a fog coordinate.
#[derive(Clone, Copy, Debug)]
struct Function {
    /// Factor that turns p1 d' or e into 4096ths.
    scale: f64,
    kind: Kind,
}

impl Function {
    fn new(curve: fog::Curve) -> Function {
        match curve {
            fog::Curve::Line(line) => {
                let start = 4096.0 * (f64::from(line.p0) - 1.0);
                let sign = line.absolute.then(|| f64::from(line.p1).signum());
                Function { scale: 4096.0 * f64::from(line.p1), kind: Kind::Linear { start, sign } }
            }
            fog::Curve::Table(mode) => {
                let table = match mode {
                    FogMode::Exp => &EXP,
                    FogMode::ExpAbs => &EXP_ABS,
                    _ => &EXP2,
                };
                Function { scale: 4096.0, kind: Kind::Table(table) }
            }
        }
    }
}

/// The function of the 4096ths.
#[derive(Clone, Copy, Debug)]
enum Kind {
    /// Adds `start`, and limits the sum. With a sign, the magnitude of the 4096ths is used (FOG-2).
    Linear { start: f64, sign: Option<f64> },
    /// Looks them up (FOG-4).
    Table(&'static Bytes),
}

/// Bytes of FOG-4 from [`FIRST`] on. The last byte is repeated up to a power of two, so that an index needs no comparison.
type Bytes = [u8; (4 * TABLE_END) as usize];

/// The least q in the table. Smaller ones have the byte of this one, and larger ones that of the last.
const FIRST: i64 = -TABLE_END;

static EXP: LazyLock<Bytes> = LazyLock::new(|| bytes(FogMode::Exp));
static EXP_ABS: LazyLock<Bytes> = LazyLock::new(|| bytes(FogMode::ExpAbs));
static EXP2: LazyLock<Bytes> = LazyLock::new(|| bytes(FogMode::Exp2));

fn bytes(mode: FogMode) -> Bytes {
    std::array::from_fn(|n| exponential(mode, FIRST + n as i64))
}

/// Returns the byte of an index.
#[inline(always)]
fn byte(table: &Bytes, index: i32) -> u8 {
    table[index as usize & (table.len() - 1)]
}

/// Relative error of linear arguments: a coordinate keeps 24 bits and is rounded toward zero.
const TRUNCATED: f64 = 1.0 / (1 << 22) as f64;

/// Largest error of an estimate of 4096ths that is accepted.
const COARSEST: f64 = 4.0;

/// Upper bound of the rounding errors, relative to the terms of a sum.
const ROUNDED: f64 = 1.0 / (1_u64 << 40) as f64;

impl Fog {
    pub(super) fn new(context: &TriangleContext<'_>) -> Option<Fog> {
        let triangle = &context.triangle;
        let plane = |g: [i64; 3]| Plane::new(triangle, &inverse(triangle), g);
        let fog = context.fog.as_ref()?;
        let (attribute, curve) = match fog {
            FogPlane::Factor(g) => return Some(Fog::Factor(plane(*g))),
            FogPlane::NotFinite(byte) => return Some(Fog::Same(i16::from(*byte))),
            FogPlane::Linear(line, attribute) => (attribute, fog::Curve::Line(*line)),
            FogPlane::Exponential(mode, attribute) => (attribute, fog::Curve::Table(*mode)),
        };
        let [a, b, c] = context.vertices().fog();
        if a == b && b == c {
            // Any sample of the triangle will do.
            return Some(Fog::Same(i16::from(fog.at(&Sample::new(triangle, [1; 3])).byte)));
        }
        let (g, exponent) = attribute.numbers();
        // A power of two close to a single-precision number, and so far from the limits of double precision.
        let unit = f64::from_bits(((exponent + 1023).max(0) as u64) << 52);
        Some(Fog::Function(Curve { coordinate: plane(g), unit, function: Function::new(curve) }))
    }

    /// Returns the factor of all pixels of a row within the triangle, if it does not vary along rows and is proved. `e` has the edge
    /// functions at one of them. D does not vary along rows.
    pub(super) fn of_row(&self, setup: &Setup<'_>, e: &[i64; 3]) -> Option<i16> {
        let curve = match self {
            Fog::Same(factor) => return Some(*factor),
            Fog::Function(curve) => curve,
            Fog::Factor(_) => return None,
        };
        let (e, real) = (e.map(|e| e as f64), &curve.coordinate.real);
        let scale = curve.scale();
        let line = real.line(&e).times(scale);
        if line.x != 0.0 {
            return None;
        }
        let reciprocal = 1.0 / setup.denominator.real.line(&e).c;
        let off = 2.0 * real.reach * SLACK * scale.abs();
        let (at, mut factor) = ([&[0.0][..], &[0.0], &[reciprocal]], [0]);
        let function = &curve.function;
        let is_proved =
            off < COARSEST && !function.look_up::<false, true>(at, line, off, &mut factor, &mut [0], &mut [0]);
        is_proved.then_some(factor[0])
    }
}

impl Setup<'_> {
    /// Computes the fog factors of a batch. `values` and `spare` are scratch space.
    #[inline(always)]
    pub(super) fn fog_factors<const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        fog: &Fog,
        (local, reciprocals): (&BatchSetup, &Reciprocals),
        values: &mut PerLane<i32>,
        spare: &mut PerLane<i32>,
        row: &mut PerLane<i16>,
    ) {
        let out = &mut row[batch.lanes()];
        let (values, spare) = (&mut values[..out.len()], &mut spare[..out.len()]);
        match fog {
            Fog::Same(factor) => out.fill(*factor),
            Fog::Factor(plane) => {
                let Some(estimate) = self.estimate_of::<ROW>(plane, (0, 0.0), local) else {
                    return self.defined_factors(batch, |_| true, out);
                };
                if reciprocals.floors::<FMA, ROW, i32>(estimate, values, |value| value) {
                    self.correct::<ROW>(batch, 0, plane, &local.e, values, spare);
                }
                for (out, value) in out.iter_mut().zip(values) {
                    *out = factor((*value).clamp(0, 4096)) as i16;
                }
            }
            Fog::Function(curve) => {
                let scale = curve.scale();
                let line = curve.coordinate.real.line(&local.real).times(scale);
                let off = local.margin::<ROW>(&curve.coordinate.real) * scale.abs();
                // NaN proves nothing either.
                let proves = off < COARSEST;
                if !proves {
                    return self.defined_factors(batch, |_| true, out);
                }
                let at = reciprocals.lanes(out.len());
                if curve.function.look_up::<FMA, ROW>(at, line, off, out, values, spare) {
                    self.defined_factors(batch, |n| spare[n] != 0, out);
                }
            }
        }
    }

    /// Computes the lanes that are not proved by the definition.
    #[inline(never)]
    fn defined_factors(&self, batch: PixelBatch<'_>, wanted: impl Fn(usize) -> bool, out: &mut [i16]) {
        let Some(fog) = &self.context.fog else { return };
        for n in (0..batch.count).filter(|n| wanted(*n)) {
            self.count_defined(Reason::Fog, 1);
            out[n] = i16::from(fog.at(&self.sample(batch, n)).byte);
        }
    }
}

impl Curve {
    /// Returns the factor that turns the plane's numbers into 4096ths.
    #[inline(always)]
    fn scale(&self) -> f64 {
        self.function.scale * self.unit
    }
}

/// The fog of boxes of small triangles, if it is a function of a coordinate.
#[derive(Debug, Default)]
pub(super) struct BoxFog {
    function: Option<Function>,
    /// 4096ths, and their largest error.
    line: Lines,
    off: Each<f64>,
}

impl BoxFog {
    /// Sets up all boxes from d' or e at the vertices. Clears `proves` where nothing would be proved.
    #[inline(always)]
    pub(super) fn set_up<const FMA: bool>(
        &mut self,
        edges: &Edges,
        values: &OfVertices,
        function: &FogFunction,
        proves: &mut Each<i32>,
    ) {
        self.function = fog::Curve::new(function).map(Function::new);
        let scale = self.function.as_ref().map_or(f64::NAN, |function| function.scale);
        let (line, _, bounds) = Bounds::new::<FMA>(edges, values);
        for n in 0..GROUP {
            let of = line.of(n).times(scale);
            (self.line.c[n], self.line.x[n], self.line.y[n]) = (of.c, of.x, of.y);
            self.off[n] = bounds.off(edges, n) * scale.abs();
            // NaN proves nothing either.
            proves[n] &= -i32::from(self.off[n] < COARSEST);
        }
    }

    /// Writes the factors of a box, at these columns, rows and reciprocals of D. Returns whether some are not proved. `values` and `spare` are scratch
    /// space.
    #[inline(always)]
    pub(super) fn factors<const FMA: bool>(
        &self,
        n: usize,
        at: [&[f64]; 3],
        out: &mut [i16],
        values: &mut PerLane<i32>,
        spare: &mut PerLane<i32>,
    ) -> bool {
        let Some(function) = &self.function else { return true };
        let (values, spare) = (&mut values[..out.len()], &mut spare[..out.len()]);
        let close = function.look_up::<FMA, false>(at, self.line.of(n), self.off[n], out, values, spare);
        close && spare.iter().fold(0, |all, unknown| all | unknown) != 0
    }
}

impl Function {
    /// FOG-2 at the vertices: writes bytes, and numbers other than 0 for lanes that are not proved. Returns whether there are such lanes.
    /// `line` over D gives the 4096ths, whose error is at most `off`. `at` has columns, rows and the reciprocals of D.
    #[inline(always)]
    fn look_up<const FMA: bool, const ROW: bool>(
        &self,
        at: [&[f64]; 3],
        line: Line,
        off: f64,
        out: &mut [i16],
        values: &mut [i32],
        unknown: &mut [i32],
    ) -> bool {
        match self.kind {
            Kind::Linear { start, sign } => {
                let close = linear::<FMA, ROW>(at, line, (start, off, sign), values, unknown);
                for (out, value) in out.iter_mut().zip(&*values) {
                    *out = *value as i16;
                }
                close
            }
            Kind::Table(table) => {
                let close = steps::<FMA, ROW>(at, line, off, values, unknown);
                for (out, value) in out.iter_mut().zip(&*values) {
                    *out = i16::from(byte(table, *value));
                }
                if close {
                    // A lane is proved after all if the neighbouring steps have the same byte.
                    for (value, unknown) in values.iter().zip(unknown) {
                        let bytes = [byte(table, *value - 1), byte(table, *value), byte(table, *value + 1)];
                        *unknown = i32::from(*unknown < 0 && bytes != [bytes[1]; 3]);
                    }
                }
                close
            }
        }
    }
}

/// FOG-2: writes the bytes of the least possible factors, and numbers other than 0 for lanes that are not proved. Returns whether there are
/// such lanes. `line` over D gives p1 d', whose error is at most `off`, plus what 24 bits lose.
#[inline(always)]
fn linear<const FMA: bool, const ROW: bool>(
    [xs, ys, rs]: [&[f64]; 3],
    line: Line,
    (start, off, sign): (f64, f64, Option<f64>),
    bytes: &mut [i32],
    unknown: &mut [i32],
) -> bool {
    let mut close = 0;
    let lanes = bytes.len();
    let (unknown, xs, ys, rs) = (&mut unknown[..lanes], &xs[..lanes], &ys[..lanes], &rs[..lanes]);
    let rounding = ROUNDED * (4096.0 + start.abs());
    for n in 0..lanes {
        let argument = line.at::<FMA, ROW>(xs[n], ys[n]) * rs[n];
        let size = argument.abs();
        let argument = sign.map_or(argument, |sign| size * sign);
        let (value, error) = (start + argument, size * TRUNCATED + off + rounding);
        let low = factor(floor_of_factor::<FMA>(value - error));
        let high = factor(floor_of_factor::<FMA>(value + error));
        (bytes[n], unknown[n]) = (low, low ^ high);
        close |= unknown[n];
    }
    close != 0
}

/// FOG-4: writes indices into the table, and negative numbers for lanes that are not proved. Returns whether there are such lanes. `line`
/// over D gives e in 4096ths, whose error is at most `off`. A tie may be one step lower (INT-4t); it is not proved, because `off` is not 0.
#[inline(always)]
fn steps<const FMA: bool, const ROW: bool>(
    [xs, ys, rs]: [&[f64]; 3],
    line: Line,
    off: f64,
    steps: &mut [i32],
    unknown: &mut [i32],
) -> bool {
    let mut close = 0;
    let lanes = steps.len();
    let (unknown, xs, ys, rs) = (&mut unknown[..lanes], &xs[..lanes], &ys[..lanes], &rs[..lanes]);
    // The index of q is q - FIRST. The floor is the integer nearest to half a step below.
    let ends = (-(CENTRE + FIRST) as f64 - 0.5, (2 * TABLE_END) as f64);
    let limit = 0.5 - (off + ROUNDED * 8192.0);
    for n in 0..lanes {
        let index = line.at::<FMA, ROW>(xs[n], ys[n]) * rs[n] + ends.0;
        let index = if index > 0.0 { index } else { 0.0 };
        let index = if index < ends.1 { index } else { ends.1 };
        steps[n] = nearest(index);
        unknown[n] = ((limit - (index - whole(index)).abs()).to_bits() >> 32) as i32;
        close |= unknown[n];
    }
    close < 0
}

#[cfg(test)]
mod tests {
    use super::super::lattice::{any, beside, pick, within};
    use super::*;
    use crate::number::convert::{factor_byte, split};
    use crate::random::Random;
    use crate::state::Named;

    /// Bytes that are proved are those of the definition, for parameters and coordinates at the limits of binary32.
    #[test]
    fn proved_bytes_are_those_of_the_definition() {
        let mut random = Random::seeded(0x1234_5678);
        let next = &mut || random.bits() as u32;
        let (mut proved, mut ends) = (0, [0; 3]);
        for round in 0..200_000 {
            let of = |next: &mut dyn FnMut() -> u32| {
                let next = &mut || next();
                if next().is_multiple_of(4) { any(next) } else { within(next, (-12, 3)) }
            };
            let (p0, p1) = (of(next), of(next));
            let function =
                FogFunction { mode: pick(next, FogMode::ALL), p0, p1, p2: 0.0, per_vertex: next().is_multiple_of(4) };
            let Some(curve) = fog::Curve::new(&function) else { continue };
            let (start, end) = ((1.0 - p0) / p1, (2.0 - p0) / p1);
            let d = match next() % 6 {
                0 => start,
                1 => end,
                // Beside the centre and the ends of the tables.
                2 => pick(next, &[1.5, 2.0, 1.0, 1.515_625]),
                3 => any(next),
                _ => of(next),
            };
            let d = beside(next, d);
            if !d.is_finite() {
                continue;
            }
            let looked_up = Function::new(curve);
            let line = Line { c: f64::from(d) * looked_up.scale, x: 0.0, y: 0.0 };
            let off = line.c.abs() / (1_u64 << 51) as f64;
            let (mut byte, mut unknown) = ([0; 16], [0; 16]);
            let at = [&[0.0; 16][..], &[0.0; 16], &[1.0; 16]];
            // NaN proves nothing either.
            let proves = off < COARSEST;
            if !proves {
                continue;
            }
            let close = looked_up.look_up::<false, false>(at, line, off, &mut byte, &mut [0; 16], &mut unknown);
            if close && unknown[0] != 0 {
                continue;
            }
            let wanted = match curve {
                fog::Curve::Line(line) => factor_byte(line.at(split(d))),
                fog::Curve::Table(mode) => {
                    exponential(mode, ((f64::from(d) * 4096.0).floor() as i64).saturating_sub(CENTRE))
                }
            };
            assert_eq!(byte, [i16::from(wanted); 16], "{round}: {function:?} at {d}");
            proved += 1;
            ends[usize::from(wanted > 0) + usize::from(wanted == 255)] += 1;
        }
        println!("{proved} proved, {ends:?}");
        assert!(proved > 60_000 && ends.iter().all(|count| *count > 2_000), "{proved} {ends:?}");
    }
}
