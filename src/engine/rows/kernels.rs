//! The rules on rows: each kernel is a rule's text in a loop over the pixels of a block.

use super::BLOCK;
use super::graph::{MOST, Node, Value};
use crate::combiner::final_combiner::product;
use crate::combiner::general::{self, dot_product};
use crate::combiner::mapping::{expand_normal, map_one, unsigned_identity};
use crate::number::{Factor, Lane, Narrow, Sum, byte_product};
use crate::rop::blend;
use crate::state::{Bias, BlendEquation, InputMapping, MuxSelect, Policies, RegisterFloor, Scale};

/// Lanes that a piece may write past its end: pieces are handled in whole steps.
pub(super) const STEP: usize = 16;

/// Lanes of a row: a block's, and what pieces write past its end; whole cache lines.
pub(super) const LANES: usize = BLOCK + 2 * STEP;

/// One number for each pixel of a block.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Row(pub(super) [i16; LANES]);

impl Row {
    pub(super) fn of(value: i16) -> Row {
        Row([value; LANES])
    }

    pub(super) fn fill(&mut self, value: i16) {
        self.0.fill(value);
    }

    /// The lanes of the block.
    #[inline(always)]
    pub(super) fn block(&self) -> &[i16; BLOCK] {
        let Some((block, _)) = self.0.split_first_chunk() else { return &[0; BLOCK] };
        block
    }

    /// The same, to be written.
    #[inline(always)]
    pub(super) fn block_mut(&mut self) -> &mut [i16; BLOCK] {
        let (block, _) = self.0.split_at_mut(BLOCK);
        // As long as it says.
        block.try_into().unwrap_or_else(|_| unreachable!("a row is longer than a block"))
    }
}

/// A mapping of one register.
#[inline(always)]
pub(super) fn mapped(mapping: InputMapping, x: i16) -> i16 {
    // Halves, which are even under the default policies.
    (map_one(i32::from(x), mapping, &Policies::DEFAULT).0 >> 1) as i16
}

/// NUM-2.
#[inline(always)]
pub(super) fn rounded(sum: i32) -> i16 {
    sum.rounded()
}

/// CMB-9 and NUM-3 of what has been rounded.
#[inline(always)]
pub(super) fn finished(v: i16, bias: Bias, scale: Scale) -> i16 {
    general::finished(v, bias, scale, RegisterFloor::Full, |_, v| v)
}

/// CMB-10.
#[inline(always)]
pub(super) fn takes_cd(spare0_alpha: i16, mux: MuxSelect) -> bool {
    general::takes_cd(i32::from(spare0_alpha), mux, &Policies::DEFAULT)
}

/// NUM-2 of a sum of products.
#[inline(always)]
fn sum<const N: usize>(rows: [&[i16; BLOCK]; N], n: usize) -> i16 {
    let mut total = rows[0][n].product(rows[1][n]);
    let mut k = 2;
    while k < N {
        total += rows[k][n].product(rows[k + 1][n]);
        k += 2;
    }
    total.rounded()
}

/// ROP-2 of one channel, not yet clamped.
#[inline(always)]
fn difference([a, b, c, d]: [i16; 4]) -> i16 {
    let (a, b, c, d) = (i32::from(a), i32::from(b), i32::from(c), i32::from(d));
    blend::equation(BlendEquation::Subtract, a, c, b, d) as i16
}

/// ROP-3: what is added to the destination.
#[inline(always)]
fn signed(negated: bool, s: i16) -> i16 {
    let equation = if negated { BlendEquation::SignedReverseSubtract } else { BlendEquation::SignedAdd };
    blend::equation(equation, i32::from(s), 0, 0, 0) as i16
}

#[inline(always)]
fn unsigned_dot(a: [i16; 3], b: [i16; 3]) -> i16 {
    // Written out: `map` on arrays is not always inlined, and what is not inlined lacks the caller's instruction set.
    let a = [expand_normal(Narrow(a[0])), expand_normal(Narrow(a[1])), expand_normal(Narrow(a[2]))];
    let b = [expand_normal(Narrow(b[0])), expand_normal(Narrow(b[1])), expand_normal(Narrow(b[2]))];
    unsigned_identity(dot_product(a, b).rounded()).0
}

/// A loop over the block. As a parameter of its own the result is known not to overlap the operands.
#[inline(always)]
fn each(out: &mut [i16; BLOCK], f: impl Fn(usize) -> i16) {
    for n in 0..BLOCK {
        out[n] = f(n);
    }
}

/// A mapping of a row; `mapping` is a constant where this is called, so that the loop holds one text.
#[inline(always)]
fn map_row(mapping: InputMapping, v: &[i16; BLOCK], out: &mut [i16; BLOCK]) {
    each(out, |n| mapped(mapping, v[n]))
}

/// CMB-9 and NUM-3 of a row; `bias` and `scale` likewise.
#[inline(always)]
fn finish_row(bias: Bias, scale: Scale, v: &[i16; BLOCK], out: &mut [i16; BLOCK]) {
    each(out, |n| finished(v[n], bias, scale))
}

/// Computes the row of a node from rows before it.
#[inline(always)]
pub(super) fn run(node: &Node, at: usize, rows: &mut [Row]) {
    let (before, after) = rows.split_at_mut(at);
    let Some(out) = after.first_mut() else { return };
    let out = out.block_mut();
    let row = |v: Value| before[usize::from(v.0)].block();
    match *node {
        // Filled before.
        Node::Constant(_) | Node::Input(_) => {}
        Node::Map(mapping, v) => {
            let v = row(v);
            match mapping {
                InputMapping::UnsignedIdentity => map_row(InputMapping::UnsignedIdentity, v, out),
                InputMapping::UnsignedInvert => map_row(InputMapping::UnsignedInvert, v, out),
                InputMapping::ExpandNormal => map_row(InputMapping::ExpandNormal, v, out),
                InputMapping::ExpandNegate => map_row(InputMapping::ExpandNegate, v, out),
                InputMapping::HalfBiasNormal => map_row(InputMapping::HalfBiasNormal, v, out),
                InputMapping::HalfBiasNegate => map_row(InputMapping::HalfBiasNegate, v, out),
                InputMapping::SignedIdentity => out.copy_from_slice(v),
                InputMapping::SignedNegate => map_row(InputMapping::SignedNegate, v, out),
            }
        }
        Node::Sum(pairs) => {
            // Past the last pair nothing is added, whatever the rows hold that nobody reads.
            let mut all: [&[i16; BLOCK]; 2 * MOST] = [&ZEROS; 2 * MOST];
            for (factor, value) in all.iter_mut().zip(&pairs.values[..2 * pairs.count]) {
                *factor = row(*value);
            }
            let [a, b, c, d, e, f, g, h, ..] = all;
            match pairs.count {
                1 => each(out, |n| product(a[n], b[n])),
                2 => each(out, |n| sum([a, b, c, d], n)),
                3 => each(out, |n| dot_product([a[n], c[n], e[n]], [b[n], d[n], f[n]]).rounded()),
                4 => each(out, |n| sum([a, b, c, d, e, f, g, h], n)),
                _ => each(out, |n| sum(all, n)),
            }
        }
        Node::Bytes(a, b) => {
            let (a, b) = (row(a), row(b));
            each(out, |n| byte_product(a[n], b[n]));
        }
        Node::Difference(v) => {
            let [a, b, c, d] = [row(v[0]), row(v[1]), row(v[2]), row(v[3])];
            each(out, |n| difference([a[n], b[n], c[n], d[n]]));
        }
        Node::UnsignedDot(v) => {
            let [a, b, c, d, e, f] = [row(v[0]), row(v[1]), row(v[2]), row(v[3]), row(v[4]), row(v[5])];
            each(out, |n| unsigned_dot([a[n], c[n], e[n]], [b[n], d[n], f[n]]));
        }
        Node::Output(bias, scale, v) => {
            let v = row(v);
            match (bias, scale) {
                (Bias::None, Scale::One) => finish_row(Bias::None, Scale::One, v, out),
                (Bias::None, Scale::Two) => finish_row(Bias::None, Scale::Two, v, out),
                (Bias::None, Scale::Four) => finish_row(Bias::None, Scale::Four, v, out),
                (Bias::None, Scale::Half) => finish_row(Bias::None, Scale::Half, v, out),
                (Bias::NegativeHalf, Scale::One) => finish_row(Bias::NegativeHalf, Scale::One, v, out),
                (Bias::NegativeHalf, Scale::Two) => finish_row(Bias::NegativeHalf, Scale::Two, v, out),
                // Not legal (CMB-9), and so never asked for.
                (Bias::NegativeHalf, other) => finish_row(Bias::NegativeHalf, other, v, out),
            }
        }
        Node::Select(mux, v) => {
            let [by, cd, ab] = [row(v[0]), row(v[1]), row(v[2])];
            // Both are read, whichever is taken.
            let choose = |takes_cd: bool, cd: i16, ab: i16| if takes_cd { cd } else { ab };
            match mux {
                MuxSelect::Msb => each(out, |n| choose(takes_cd(by[n], MuxSelect::Msb), cd[n], ab[n])),
                MuxSelect::Lsb => each(out, |n| choose(takes_cd(by[n], MuxSelect::Lsb), cd[n], ab[n])),
            }
        }
        Node::Add(a, b) => {
            let (a, b) = (row(a), row(b));
            each(out, |n| a[n] + b[n]);
        }
        Node::Minus(a, b) => {
            let (a, b) = (row(a), row(b));
            each(out, |n| a[n] - b[n]);
        }
        Node::Least(a, b) => {
            let (a, b) = (row(a), row(b));
            each(out, |n| a[n].min(b[n]));
        }
        Node::Greatest(a, b) => {
            let (a, b) = (row(a), row(b));
            each(out, |n| a[n].max(b[n]));
        }
        Node::Clamp(v) => {
            let v = row(v);
            each(out, |n| v[n].clamp(0, 255));
        }
        Node::Truncate(bits, v) => {
            let v = row(v);
            each(out, |n| i32::from(v[n]).truncated(bits) as i16);
        }
        Node::Signed(negated, v) => {
            let v = row(v);
            if negated {
                each(out, |n| signed(true, v[n]));
            } else {
                each(out, |n| signed(false, v[n]));
            }
        }
    }
}

static ZEROS: [i16; BLOCK] = [0; BLOCK];

#[cfg(test)]
mod tests {
    use super::super::graph::Pairs;
    use super::*;

    /// Sums of one to six products, with other numbers in the rows that nobody reads.
    #[test]
    fn sums_have_as_many_products_as_they_say() {
        for count in 1..=MOST {
            let mut rows = vec![Row::of(99); 4];
            let mut values = [Value(0); 2 * MOST];
            let mut wanted = 0;
            for (n, value) in values[..2 * count].iter_mut().enumerate() {
                *value = Value(rows.len() as u16);
                rows.push(Row::of(17 * n as i16 - 40));
            }
            for pair in 0..count as i32 {
                wanted += (34 * pair - 40) * (34 * pair - 23);
            }
            let at = rows.len();
            rows.push(Row::of(0));
            run(&Node::Sum(Pairs { count, values }), at, &mut rows);
            assert_eq!(rows[at].block(), &[wanted.rounded(); BLOCK], "{count}");
        }
    }
}
