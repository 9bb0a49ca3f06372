//! Depths on rows. The definition's integers are held as doubles, exactly; docs/exactness.md has the argument.
#![allow(
    clippy::float_arithmetic,
    reason = "whole numbers, and cuts at powers of two, of which docs/exactness.md gives account"
)]

use super::depth_words::{OUTSIDE, Words};
use super::kernels::{PerLane, STEP};
use super::planes::edge_lines;
use super::quotient::{EXPONENT, IOTA_REAL, Line, MAGIC, Positions, cut, floor, nearest, position};
use super::reciprocal::{ReciprocalLine, bits_of_reciprocal, power_of_two};
use super::setup::{PixelBatch, whole_steps};
use crate::engine::context::TriangleContext;
use crate::raster::depth::{difference, largest_edge, w_ratio};
use crate::raster::interpolate::most_dominant;
use crate::state::VertexDepths;
use std::ops::Range;

/// Bits of a double below its first 24.
const BELOW_24_BITS: u64 = (1 << 29) - 1;

/// 2^-28, the last of 29 bits relative to the first.
const LAST_BIT: f64 = 1.0 / (1_u64 << 28) as f64;

/// Bits of the exponent of 1.
const ONE: u64 = 1023 << 52;

/// Marks a depth that the definition has to compute. No buffer has it.
pub(super) const UNKNOWN: u32 = u32::MAX;

/// Number of lanes that run one step before the next step begins. A step has a long latency, which processors hide by the other lanes only
/// if the step is short.
const CHUNK: usize = 64;

/// Intermediate results of a chunk. Aligned, because vectors are stored and loaded.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Steps {
    /// Edge numbers of the two vertices that are not the reference, in multiples of 2^(X-28), where X is the exponent of the largest. In a
    /// w buffer those of vertices 0 and 2, then of 1.
    edges: [[f64; CHUNK]; 3],
    /// Sum of all three, each floored.
    sums: [f64; CHUNK],
    /// Depth of the reference vertex.
    references: [f64; CHUNK],
    /// Differences of the two other depths from it; later these differences times their weights.
    terms: [[f64; CHUNK]; 2],
    /// 1 if the definition has to decide.
    close: [u64; CHUNK],
    /// Reciprocals of the current triangle.
    reciprocals: ReciprocalLine,
}

impl Default for Steps {
    fn default() -> Self {
        let zeros = [0.0; CHUNK];
        Steps {
            edges: [zeros; 3],
            sums: zeros,
            references: zeros,
            terms: [zeros; 2],
            close: [0; CHUNK],
            reciprocals: ReciprocalLine::default(),
        }
    }
}

/// The two vertices that are not the reference, for each reference.
const OTHERS: [[usize; 2]; 3] = [[1, 2], [0, 2], [0, 1]];

/// Depths at the vertices of a triangle, the largest depth of the buffer, and the steps besides flooring.
#[derive(Clone, Copy, Debug)]
struct Depths<'a> {
    z: [f64; 3],
    /// Differences of the depths of the [two other vertices](OTHERS) from each vertex.
    differences: [[f64; 2]; 3],
    /// Factors of edge numbers in a w buffer (DEP-6). There `z` holds w.
    ratios: [f64; 3],
    full: f64,
    words: Words<'a>,
}

/// Computes the depths of a batch's pixels. Returns how many of them the definition computed.
#[inline(always)]
pub(super) fn depths<const FMA: bool, const ROW: bool>(
    context: &TriangleContext<'_>,
    batch: PixelBatch<'_>,
    (out, steps): (&mut PerLane<u32>, &mut Steps),
) -> u64 {
    let (triangle, plane, draw) = (&context.triangle, &context.depth, context.draw);
    let Some(test) = &draw.depth_test else { return 0 };
    let e = triangle.edges(batch.first.0, batch.first.1);
    let format = draw.depth_format;
    let full = f64::from(format.largest());
    let words = Words::new(plane.offset, test.range.as_ref(), format);
    let z = plane.w.unwrap_or(plane.z);
    let between = |a: usize, b: usize| f64::from(difference(z[a], z[b]));
    let differences = all_differences(between(1, 0), between(2, 0), between(2, 1));
    let depths = Depths { z: z.map(f64::from), differences, ratios: [1.0; 3], full, words };
    let edges = edge_lines(triangle, &e);
    // The lanes after those of a row are not in use yet, so they may be overwritten.
    let out = if ROW { &mut out[batch.lane..] } else { &mut out[batch.lanes()] };
    let along_row = ((e, triangle.a), batch.count);
    let whole = |z: &f32| *z >= 0.0 && *z < 16_777_216.0 && z.fract() == 0.0;
    // Far from the limits of binary32, so that ratios are.
    let moderate = |w: &f32| (1e-18..1e30).contains(w);
    // Whether depths are floored and nothing else.
    let is_plain = words.are_floors();
    let unknown = if let Some(w) = plane.w {
        if words.can_add_offset() && w.iter().all(moderate) {
            let ratio = |(mantissa, exponent): (i64, i32)| mantissa as f64 * power_of_two(exponent);
            let ratios = w.map(|of| ratio(w_ratio(w[1], of)));
            let depths = Depths { ratios, ..depths };
            if is_plain {
                depths.along::<FMA, ROW, false, true>(batch.at, edges, along_row, steps, out)
            } else {
                depths.along::<FMA, ROW, true, true>(batch.at, edges, along_row, steps, out)
            }
        } else {
            out.fill(UNKNOWN);
            true
        }
    } else if is_plain && (test.vertex_depths == VertexDepths::Fractions || plane.z.iter().all(whole)) {
        depths.along::<FMA, ROW, false, false>(batch.at, edges, along_row, steps, out)
    } else if words.can_add_offset() && differences.as_flattened().iter().all(|difference| difference.is_finite()) {
        depths.along::<FMA, ROW, true, false>(batch.at, edges, along_row, steps, out)
    } else {
        out.fill(UNKNOWN);
        true
    };
    let mut defined = 0;
    if unknown {
        for (n, depth) in out[..batch.count].iter_mut().enumerate().filter(|(_, depth)| **depth == UNKNOWN) {
            *depth = context.depth_word(&batch.sample(n, triangle)).unwrap_or(OUTSIDE);
            defined += 1;
        }
    }
    defined
}

/// Returns the differences of the depths of the [two other vertices](OTHERS) from each vertex.
#[inline(always)]
pub(super) fn all_differences(first: f64, second: f64, third: f64) -> [[f64; 2]; 3] {
    [[first, second], [-first, third], [-second, -third]]
}

/// Returns the reference of a pixel of a row, and up to which of `count` pixels all have it. The third argument has the row's edge functions
/// at its first pixel and their slopes.
fn same_reference(first: usize, count: usize, (e, slopes): ([i64; 3], [i64; 3])) -> (usize, usize) {
    let edges = |x: usize| [0, 1, 2].map(|k| e[k] + slopes[k] * x as i64);
    let reference = largest_edge(edges(first));
    let mut until = first;
    while until < count {
        let e = edges(until);
        if largest_edge(e) != reference {
            break;
        }
        // Nothing changes before the reference's edge number becomes smaller than its power of two, or another one reaches that or the next.
        let power = 1 << e[reference].ilog2();
        let mut more = (count - until) as i64;
        for k in 0..3 {
            let comes_first = largest_edge([0, 1, 2].map(|n| i64::from(n == k || n == reference))) == k;
            let (distance, slope) = if k == reference {
                (e[k] - power + 1, -slopes[k])
            } else if comes_first {
                (power - e[k], slopes[k])
            } else {
                (2 * power - e[k], slopes[k])
            };
            if slope > 0 {
                more = more.min((distance - 1) / slope + 1);
            }
        }
        until += more as usize;
    }
    (reference, until)
}

impl Depths<'_> {
    /// Returns whether some depths are unknown. `GENERAL` means that depths are not just floored, `W` that the buffer is a w buffer. `row`
    /// has the edge functions at the first pixel of a row, their slopes and the number of pixels.
    #[inline(always)]
    fn along<const FMA: bool, const ROW: bool, const GENERAL: bool, const W: bool>(
        &self,
        at: Positions<'_>,
        edges: [Line; 3],
        row: (([i64; 3], [i64; 3]), usize),
        steps: &mut Steps,
        out: &mut [u32],
    ) -> bool {
        let mut unknown = false;
        let is_plain_row = ROW && !GENERAL && !W;
        let (row, count) = row;
        // The sum of all three edge functions is the doubled area.
        let area = row.0.iter().sum();
        if is_plain_row && steps.reciprocals.area != area {
            steps.reciprocals = ReciprocalLine::new::<FMA>(area);
        }
        let (mut first, mut end) = (0, if ROW { count } else { out.len() });
        if is_plain_row && steps.reciprocals.tells {
            let mut left = end..0;
            while first < end {
                let (reference, until) = same_reference(first, end, row);
                if !self.floored::<FMA>(edges, reference, first..until, steps, out) {
                    left = left.start.min(first)..until;
                }
                first = until;
            }
            // Whole steps of the batch, although some lanes may be done.
            (first, end) = (left.start - left.start % STEP, left.end);
        }
        while first < end {
            let pixels = (end - first).min(CHUNK);
            let lanes = if ROW { first..first + whole_steps(pixels) } else { first..first + pixels };
            let out = &mut out[lanes.clone()];
            let positions = (&at.x[lanes.clone()], &at.y[lanes.clone()], &IOTA_REAL[lanes]);
            let last = f64::from(at.last);
            let close = if W || ROW && area > 1 << 24 {
                self.sums::<FMA, ROW, W>(last, positions, edges, steps);
                self.terms::<FMA, W>(out.len(), steps)
            } else {
                let unit = unit_of_weights(area);
                let scaled = self.differences.map(|[a, b]| [a * unit, b * unit]);
                self.uncut_terms::<FMA, ROW>(last, positions, edges, (bits_of_reciprocal(area), scaled), steps);
                false
            };
            self.words::<FMA, GENERAL>(steps, out);
            if close {
                for (out, close) in out.iter_mut().zip(&steps.close) {
                    // `UNKNOWN` has all bits set.
                    *out |= (*close as u32).wrapping_neg();
                }
            }
            unknown |= close;
            first += pixels;
        }
        unknown
    }

    /// Writes the words of pixels of a row that share a reference, whose depths are floored and nothing else. Lanes up to the next whole
    /// step may be overwritten. Returns `false`, and writes nothing, unless the largest terms of all these pixels have the same exponent.
    #[inline(always)]
    fn floored<const FMA: bool>(
        &self,
        edges: [Line; 3],
        reference: usize,
        pixels: Range<usize>,
        Steps { reciprocals, terms: weighted, .. }: &mut Steps,
        out: &mut [u32],
    ) -> bool {
        // A copy, which cannot overlap what is stored.
        let line = *reciprocals;
        let [one, other] = OTHERS[reference];
        let (one, other, largest) = (edges[one], edges[other], edges[reference]);
        // The weights of the two other vertices.
        let weights = |x: f64| {
            let [one, other, largest] = [one, other, largest].map(|edge| cut24(edge.at::<FMA, true>(x, 0.0)));
            let reciprocal = line.at::<FMA>(one + other + largest);
            [cut24(one * reciprocal), cut24(other * reciprocal)]
        };
        let [by_one, by_other] = self.differences[reference].map(|difference| difference * line.unit);
        let z = self.z[reference];
        let at = |pixel: usize| {
            let [one, other] = weights(pixel as f64);
            [one * by_one, other * by_other]
        };
        let Some(top) = same_power(z, at(pixels.start), at(pixels.end - 1)) else { return false };
        // The terms become multiples of 2^(Y-28).
        let scale = (1 << 28) as f64 / top;
        let (by_one, by_other) = (by_one * scale, by_other * scale);
        let start = cut::<FMA>(z * scale) + MAGIC;
        // Smaller terms yield no depth.
        let shift = (1023 + 28 - (top.to_bits() >> 52) as i32).min(31);
        let full = self.full as i32;
        let lanes = pixels.start..pixels.start + whole_steps(pixels.len());
        let [of_one, of_other] = weighted;
        for (out, xs) in out[lanes.clone()].chunks_mut(CHUNK).zip(IOTA_REAL[lanes].chunks(CHUNK)) {
            // Two short steps: see `CHUNK`.
            let (of_one, of_other, xs) = (&mut of_one[..out.len()], &mut of_other[..out.len()], &xs[..out.len()]);
            for n in 0..out.len() {
                [of_one[n], of_other[n]] = weights(xs[n]);
            }
            for n in 0..out.len() {
                let sum =
                    (cut::<FMA>(of_one[n] * by_one) + cut::<FMA>(of_other[n] * by_other) + start).to_bits() as i32;
                out[n] = (sum >> shift).max(0).min(full) as u32;
            }
        }
        true
    }

    /// Computes edge numbers, their sum, and the values that depend on the reference.
    #[inline(always)]
    fn sums<const FMA: bool, const ROW: bool, const W: bool>(
        &self,
        last: f64,
        (xs, ys, iota): (&[i16], &[i16], &[f64]),
        edges: [Line; 3],
        steps: &mut Steps,
    ) {
        let lanes = xs.len();
        let ([_, z1, _], [r0, r1, r2]) = (self.z, self.ratios);
        let [_, [a1, b1], _] = self.differences;
        let (xs, ys, iota) = (&xs[..lanes], &ys[..lanes], &iota[..lanes]);
        let Steps { edges: [one, other, middle], sums, references, terms: [of_one, of_other], .. } = steps;
        let (one, other, middle) = (&mut one[..lanes], &mut other[..lanes], &mut middle[..lanes]);
        let (sums, references) = (&mut sums[..lanes], &mut references[..lanes]);
        let (of_one, of_other) = (&mut of_one[..lanes], &mut of_other[..lanes]);
        for n in 0..lanes {
            let (x, y) = position::<ROW>(n, last, xs, ys, iota);
            let e0 = edges[0].at::<FMA, ROW>(x, y);
            let e1 = edges[1].at::<FMA, ROW>(x, y);
            let e2 = edges[2].at::<FMA, ROW>(x, y);
            let (e0, e1, e2) =
                if W { (cut24(cut24(e0) * r0), cut24(cut24(e1) * r1), cut24(cut24(e2) * r2)) } else { (e0, e1, e2) };
            let (x0, x1, x2) = (power(e0), power(e1), power(e2));
            let top = if x0 > x2 { x0 } else { x2 };
            let top = if x1 > top { x1 } else { top };
            let scale = f64::from_bits((2 * ONE + (28 << 52)).wrapping_sub(top.to_bits()));
            let (e0, e1, e2) = (cut24(e0) * scale, cut24(e1) * scale, cut24(e2) * scale);
            // The definition keeps 61 bits of the largest.
            let (e0, e1, e2) = if W { (kept(e0, 32), kept(e1, 32), kept(e2, 32)) } else { (e0, e1, e2) };
            sums[n] = floor::<FMA>(e0) + floor::<FMA>(e1) + floor::<FMA>(e2);
            if W {
                (one[n], other[n], middle[n]) = (e0, e2, e1);
                (references[n], of_one[n], of_other[n]) = (z1, a1, b1);
                continue;
            }
            let of = choose([x0, x1, x2], [e0, e1, e2], self.z, self.differences);
            (one[n], other[n], of_one[n], of_other[n], references[n]) = of;
        }
    }

    /// Does the same as [`sums`](Self::sums) and [`terms`](Self::terms) in a triangle whose doubled area is at most 2^24, as that of a small one.
    /// Nothing is cut off its edge functions, so all its pixels have the same reciprocal. `differences` are multiplied by the
    /// [unit](unit_of_weights).
    #[inline(always)]
    fn uncut_terms<const FMA: bool, const ROW: bool>(
        &self,
        last: f64,
        (xs, ys, iota): (&[i16], &[i16], &[f64]),
        edges: [Line; 3],
        (reciprocal, differences): (f64, [[f64; 2]; 3]),
        steps: &mut Steps,
    ) {
        let lanes = xs.len();
        let Steps { references, terms: [one, other], .. } = steps;
        let (ys, iota, references) = (&ys[..lanes], &iota[..lanes], &mut references[..lanes]);
        let (one, other) = (&mut one[..lanes], &mut other[..lanes]);
        for n in 0..lanes {
            let at = position::<ROW>(n, last, xs, ys, iota);
            [one[n], other[n], references[n]] = uncut_terms::<FMA, ROW>(at, edges, self.z, (reciprocal, differences));
        }
    }

    /// Multiplies differences by their weights. Returns whether some are too close to a border.
    #[inline(always)]
    fn terms<const FMA: bool, const W: bool>(&self, lanes: usize, steps: &mut Steps) -> bool {
        let Steps { edges: [one, other, middle], sums, terms: [of_one, of_other], close, .. } = steps;
        let (one, other, middle, sums) = (&one[..lanes], &other[..lanes], &middle[..lanes], &sums[..lanes]);
        let (of_one, of_other, closes) = (&mut of_one[..lanes], &mut of_other[..lanes], &mut close[..lanes]);
        let mut some = 0;
        for n in 0..lanes {
            let sum = sums[n];
            let length = power(sum);
            let quotient = length * (1_i64 << 29) as f64 / sum;
            let low = quotient - 0.1875;
            let reciprocal = floor::<FMA>(low);
            let exact = length == sum;
            // The quotient was rounded to the border between two reciprocals.
            let close = (reciprocal == low) & !exact;
            let reciprocal = if exact { (1_i64 << 29) as f64 } else { reciprocal };
            // Factor that turns products into weights.
            let unit = f64::from_bits((2 * ONE - (29 << 52)).wrapping_sub(length.to_bits()));
            let (a, b) = (cut24(one[n] * reciprocal) * unit, cut24(other[n] * reciprocal) * unit);
            let (a, b, close) =
                if W { with_rest([a, cut24(middle[n] * reciprocal) * unit, b], close) } else { (a, b, close) };
            of_one[n] *= a;
            of_other[n] *= b;
            closes[n] = u64::from(close);
            some |= closes[n];
        }
        some != 0
    }

    /// Adds the terms to the depth of the reference, and returns the words.
    #[inline(always)]
    fn words<const FMA: bool, const GENERAL: bool>(&self, steps: &mut Steps, out: &mut [u32]) {
        let lanes = out.len();
        let Steps { references, terms: [one, other], edges: [lost, ..], sums, .. } = steps;
        let (references, one, other) = (&references[..lanes], &one[..lanes], &other[..lanes]);
        let (sums, lost) = (&mut sums[..lanes], &mut lost[..lanes]);
        for n in 0..lanes {
            let terms = [one[n], other[n], references[n]];
            if GENERAL {
                (sums[n], lost[n]) = (total::<FMA>(terms), 0.0);
                continue;
            }
            out[n] = floored_word::<FMA>(terms, self.full);
        }
        if GENERAL && self.words.has_offset() {
            for (sum, lost) in sums.iter_mut().zip(&mut *lost) {
                (*sum, *lost) = self.words.with_offset(*sum);
            }
        }
        if GENERAL {
            for ((out, sum), lost) in out.iter_mut().zip(sums).zip(lost) {
                *out = self.words.word(*sum, *lost);
            }
        }
    }
}

/// DEP-1: returns the terms of the two vertices that are not the reference of a pixel, and the depth of the reference, where nothing is cut off edge
/// functions. `differences` are multiplied by the [unit](unit_of_weights).
#[inline(always)]
pub(super) fn uncut_terms<const FMA: bool, const ROW: bool>(
    (x, y): (f64, f64),
    edges: [Line; 3],
    z: [f64; 3],
    (reciprocal, differences): (f64, [[f64; 2]; 3]),
) -> [f64; 3] {
    let e0 = edges[0].at::<FMA, ROW>(x, y);
    let e1 = edges[1].at::<FMA, ROW>(x, y);
    let e2 = edges[2].at::<FMA, ROW>(x, y);
    let powers = [power(e0), power(e1), power(e2)];
    let (e_one, e_other, by_one, by_other, reference) = choose(powers, [e0, e1, e2], z, differences);
    [cut24(e_one * reciprocal) * by_one, cut24(e_other * reciprocal) * by_other, reference]
}

/// Returns the word of a depth that is the sum of three terms, at most `full`, floored and nothing else.
#[inline(always)]
pub(super) fn floored_word<const FMA: bool>(terms: [f64; 3], full: f64) -> u32 {
    let depth = total::<FMA>(terms);
    let depth = if depth > 0.0 { depth } else { 0.0 };
    let depth = if depth < full { depth } else { full };
    nearest(floor::<FMA>(depth)) as u32
}

/// DEP-1: returns the sum of three terms, each cut to 29 bits below the first of the largest.
#[inline(always)]
fn total<const FMA: bool>([a, b, z]: [f64; 3]) -> f64 {
    let largest = if a.abs() > b.abs() { a.abs() } else { b.abs() };
    let largest = if z.abs() > largest { z.abs() } else { largest };
    // Smaller terms yield no depth.
    let top = power(if largest > 1e-200 { largest } else { 1e-200 });
    let scale = f64::from_bits((2 * ONE + (28 << 52)).wrapping_sub(top.to_bits()));
    let sum = cut::<FMA>(a * scale) + cut::<FMA>(b * scale) + cut::<FMA>(z * scale);
    sum * (top * LAST_BIT)
}

/// Returns the factor that turns edge numbers times the reciprocal of a doubled area of at most 2^24 into weights.
#[inline(always)]
pub(super) fn unit_of_weights(area: i64) -> f64 {
    power_of_two(area.leading_zeros() as i32 - 64 - 28)
}

/// DEP-1: returns the edge numbers of the two vertices that are not the reference, the differences of their depths from its depth, and its
/// depth.
#[inline(always)]
fn choose(
    [x0, x1, x2]: [f64; 3],
    [e0, e1, e2]: [f64; 3],
    [z0, z1, z2]: [f64; 3],
    [[a0, b0], [a1, b1], [a2, b2]]: [[f64; 2]; 3],
) -> (f64, f64, f64, f64, f64) {
    // One choice at a time, because compilers turn nested ones into branches.
    let second = (x1 >= x0) & (x1 >= x2);
    let first = x0 >= x2;
    let (e_one, e_other) = (if first { e1 } else { e0 }, if first { e2 } else { e1 });
    let (d_one, d_other) = (if first { a0 } else { a2 }, if first { b0 } else { b2 });
    let reference = if first { z0 } else { z2 };
    (
        if second { e0 } else { e_one },
        if second { e2 } else { e_other },
        if second { a1 } else { d_one },
        if second { b1 } else { d_other },
        if second { z1 } else { reference },
    )
}

/// Returns the power of two of the largest of three terms on a row, if all pixels between two ends have the same. The first term is
/// constant, and the others, whose values at both ends are given, are linear but for less than 2^-20 of themselves.
fn same_power(z: f64, first: [f64; 2], last: [f64; 2]) -> Option<f64> {
    let ends = [0, 1].map(|n| (first[n].abs(), last[n].abs()));
    let varying = ends.iter().fold(0.0, |largest: f64, (first, last)| largest.max(*first).max(*last));
    // Smaller terms yield no depth.
    let top = power(varying.max(z.abs()).max(LEAST_TERM));
    let keeps = z.abs() >= top || ends.iter().any(|(first, last)| first.min(*last) >= top * (1.0 + NEARLY));
    let stays = keeps && varying < 2.0 * top * (1.0 - NEARLY) || top == LEAST_TERM;
    // Sums of larger terms have no fraction.
    (stays && top < (1 << 27) as f64).then_some(top)
}

/// Far below the depth 1.
const LEAST_TERM: f64 = 1.0 / (1_u64 << 60) as f64;

/// An upper bound of the relative error of terms.
const NEARLY: f64 = 1.0 / (1 << 20) as f64;

/// DEP-6: returns the first and the third weight, of which the dominant one is 1 less the others, and whether the choice was too close to a
/// border.
#[inline(always)]
fn with_rest([b0, b1, b2]: [f64; 3], close: bool) -> (f64, f64, bool) {
    let [first, third] = most_dominant([power(b0), power(b1), power(b2)]);
    // Nobody reads it if the second weight dominates. One choice at a time, because compilers turn nested ones into branches.
    let other = if first { b2 } else { b0 };
    let (one, other) = (kept(b1, 60), kept(other, 60));
    let large = if one > other { one } else { other };
    let small = if one > other { other } else { one };
    let most = 1.0 - large;
    let rest = most - small;
    // Exact rounding errors of the differences.
    let lost = ((1.0 - most) - large != 0.0) | ((most - rest) - small != 0.0);
    let same = cut24(rest * (1.0 - ROUNDINGS)) == cut24(rest * (1.0 + ROUNDINGS));
    let rest = cut24(rest);
    let b0 = if first { rest } else { b0 };
    let b2 = if third { rest } else { b2 };
    (b0, b2, close | (lost & !same & (first | third)))
}

/// An upper bound of two relative rounding errors.
const ROUNDINGS: f64 = 1.0 / (1_u64 << 50) as f64;

/// Floors a number of at most 24 bits, which is not negative, to a multiple of 2^-`bits`.
#[inline(always)]
fn kept(n: f64, bits: u32) -> f64 {
    let steps = n * (1_u64 << bits) as f64;
    // All larger numbers are whole already; some of them are too large for `floor`.
    let floored = floor::<false>(steps) * (1.0 / (1_u64 << bits) as f64);
    if steps < (1_u64 << 40) as f64 { floored } else { n }
}

/// Returns the largest power of two that is not above a positive number.
#[inline(always)]
fn power(n: f64) -> f64 {
    f64::from_bits(n.to_bits() & EXPONENT)
}

/// Keeps the first 24 significant bits.
#[inline(always)]
fn cut24(n: f64) -> f64 {
    f64::from_bits(n.to_bits() & !BELOW_24_BITS)
}
