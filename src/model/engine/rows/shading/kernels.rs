//! The rules on rows. Each kernel runs the text of a rule in a loop over the pixels of a block.

use super::node::{MAX_PRODUCTS, Mapping, Mux, Node, Pairs, Value};
use crate::combiner::general::dot_product;
use crate::combiner::mapping::{expand_normal, map_one, unsigned_identity};
use crate::combiner::output;
use crate::engine::rows::lanes::{BLOCK, Lanes, PerLane};
use crate::number::block::{byte_product, byte_sum};
use crate::number::{Factor, Lane, Narrow, Quarters, Sum};
use crate::state::{
    Bias, ExpandCentre, HalfBiasConstant, InputMapping, MuxNegative, MuxSelect, Policies, RegisterFloor, Scale,
};
use crate::texture::yuv;

/// Maps one register. With CMB-4=127.5 the result is in halves.
#[inline(always)]
pub(crate) fn mapped(mapping: Mapping, x: i16) -> i16 {
    let policies = Policies { expand_centre: mapping.centre, half_bias: mapping.half, ..Policies::DEFAULT };
    let halves = map_one(i32::from(x), mapping.of, &policies).0;
    (if mapping.half == HalfBiasConstant::Half127And5 { halves } else { halves >> 1 }) as i16
}

/// NUM-2: rounds a sum of products.
#[inline(always)]
pub(crate) fn rounded(sum: i32) -> i16 {
    sum.rounded()
}

/// NUM-2: rounds a sum of products of halves.
#[inline(always)]
pub(crate) fn rounded_quarters(sum: i32) -> i16 {
    Quarters(sum).rounded() as i16
}

/// CMB-9=after: scales and rounds a sum, which is in quarters if its factors are in halves.
#[inline(always)]
pub(crate) fn rounded_after(sum: i32, halves: bool, bias: Bias, scale: Scale) -> i16 {
    output::rounded_after::<i32>(Quarters(if halves { sum } else { 4 * sum }), bias, scale) as i16
}

/// CMB-9: adds the bias to a rounded number and scales it.
#[inline(always)]
pub(crate) fn scaled(v: i16, bias: Bias, scale: Scale) -> i16 {
    output::scaled(output::biased(v, bias), scale)
}

/// CMB-9 and NUM-3: adds the bias to a rounded number, scales and saturates it.
#[inline(always)]
pub(crate) fn finished(v: i16, bias: Bias, scale: Scale, floor: RegisterFloor) -> i16 {
    output::finished(v, bias, scale, floor)
}

/// CMB-10: returns whether the mux takes CD.
#[inline(always)]
pub(crate) fn takes_cd(spare0_alpha: i16, Mux(select, negative): Mux) -> bool {
    output::takes_cd(i32::from(spare0_alpha), select, negative)
}

/// Adds the products of a lane.
#[inline(always)]
fn total<const N: usize>(rows: [&[i16; BLOCK]; N], n: usize) -> i32 {
    let mut total = rows[0][n].product(rows[1][n]);
    let mut k = 2;
    while k < N {
        total += rows[k][n].product(rows[k + 1][n]);
        k += 2;
    }
    total
}

/// ROP-2: the difference of two products, not clamped yet.
#[inline(always)]
fn difference([a, b, c, d]: [i16; 4]) -> i16 {
    (a.product(b) - c.product(d)).rounded()
}

#[inline(always)]
fn unsigned_dot(a: [i16; 3], b: [i16; 3]) -> i16 {
    // Written out, because `map` on arrays is not always inlined, and a function that is not inlined lacks the caller's instruction set.
    let a = [expand_normal(Narrow(a[0])), expand_normal(Narrow(a[1])), expand_normal(Narrow(a[2]))];
    let b = [expand_normal(Narrow(b[0])), expand_normal(Narrow(b[1])), expand_normal(Narrow(b[2]))];
    unsigned_identity(dot_product(a, b).rounded()).0
}

/// TEX-19: returns a channel of a colour.
#[inline(always)]
pub(crate) fn converted(channel: usize, [y, cb, cr]: [i16; 3]) -> i16 {
    yuv::converted(channel, [i32::from(y), i32::from(cb), i32::from(cr)]) as i16
}

/// Runs a loop over lanes. `out` is a parameter of its own, so that the compiler knows that it does not overlap the operands.
#[inline(always)]
fn each(out: &mut [i16; BLOCK], lanes: Lanes, f: impl Fn(usize) -> i16) {
    for n in 0..lanes.count() {
        out[n] = f(n);
    }
}

/// Maps a row. `mapping` is constant at each call, so that each loop has one mapping.
#[inline(always)]
fn map_row(mapping: Mapping, v: &[i16; BLOCK], out: &mut [i16; BLOCK], lanes: Lanes) {
    each(out, lanes, |n| mapped(mapping, v[n]))
}

/// Maps a row whose mapping depends on policies.
#[inline(always)]
fn map_row_by_policy(mapping: Mapping, v: &[i16; BLOCK], out: &mut [i16; BLOCK], lanes: Lanes) {
    use ExpandCentre::{Centred, Literal};
    use HalfBiasConstant::{Half127, Half127And5, Half128};
    match (mapping.centre, mapping.half) {
        (Centred, Half128) => map_row(Mapping { centre: Centred, half: Half128, ..mapping }, v, out, lanes),
        (Literal, _) => map_row(Mapping { centre: Literal, half: Half128, ..mapping }, v, out, lanes),
        (_, Half127) => map_row(Mapping { centre: Centred, half: Half127, ..mapping }, v, out, lanes),
        (_, Half127And5) => map_row(Mapping { centre: Centred, half: Half127And5, ..mapping }, v, out, lanes),
    }
}

/// Computes sums of products of rows, and applies a function to them.
#[inline(always)]
fn sum_row(pairs: &Pairs, before: &[PerLane<i16>], out: &mut [i16; BLOCK], lanes: Lanes, of: impl Fn(i32) -> i16) {
    // Zeros past the last pair, whatever unused rows hold.
    let mut all: [&[i16; BLOCK]; 2 * MAX_PRODUCTS] = [&ZEROS; 2 * MAX_PRODUCTS];
    for (factor, value) in all.iter_mut().zip(&pairs.values[..2 * pairs.count]) {
        *factor = before[usize::from(value.0)].block();
    }
    let [a, b, c, d, e, f, g, h, ..] = all;
    match pairs.count {
        1 => each(out, lanes, |n| of(total([a, b], n))),
        2 => each(out, lanes, |n| of(total([a, b, c, d], n))),
        3 => each(out, lanes, |n| of(dot_product([a[n], c[n], e[n]], [b[n], d[n], f[n]]))),
        4 => each(out, lanes, |n| of(total([a, b, c, d, e, f, g, h], n))),
        _ => each(out, lanes, |n| of(total(all, n))),
    }
}

/// CMB-9 and NUM-3 of a row. `bias` and `scale` are constant at each call.
#[inline(always)]
fn finish_row(bias: Bias, scale: Scale, floor: RegisterFloor, v: &[i16; BLOCK], out: &mut [i16; BLOCK], lanes: Lanes) {
    each(out, lanes, |n| finished(v[n], bias, scale, floor))
}

/// Computes the row of a node from earlier rows.
#[inline(always)]
pub(crate) fn run(node: &Node, at: usize, lanes: Lanes, rows: &mut [PerLane<i16>]) {
    let (before, after) = rows.split_at_mut(at);
    let Some(out) = after.first_mut() else { return };
    let out = out.block_mut();
    let row = |v: Value| before[usize::from(v.0)].block();
    match *node {
        // Filled beforehand.
        Node::Constant(_) | Node::Input(_) => {}
        Node::Map(mapping, v) => {
            let v = row(v);
            match mapping.of {
                InputMapping::UnsignedIdentity => {
                    map_row(Mapping::plain(InputMapping::UnsignedIdentity), v, out, lanes)
                }
                InputMapping::UnsignedInvert => map_row(Mapping::plain(InputMapping::UnsignedInvert), v, out, lanes),
                InputMapping::ExpandNormal => {
                    map_row_by_policy(Mapping { of: InputMapping::ExpandNormal, ..mapping }, v, out, lanes);
                }
                InputMapping::ExpandNegate => {
                    map_row_by_policy(Mapping { of: InputMapping::ExpandNegate, ..mapping }, v, out, lanes);
                }
                InputMapping::HalfBiasNormal => {
                    map_row_by_policy(Mapping { of: InputMapping::HalfBiasNormal, ..mapping }, v, out, lanes);
                }
                InputMapping::HalfBiasNegate => {
                    map_row_by_policy(Mapping { of: InputMapping::HalfBiasNegate, ..mapping }, v, out, lanes);
                }
                InputMapping::SignedIdentity => map_row(Mapping::plain(InputMapping::SignedIdentity), v, out, lanes),
                InputMapping::SignedNegate => map_row(Mapping::plain(InputMapping::SignedNegate), v, out, lanes),
            }
        }
        Node::Sum(pairs) => sum_row(&pairs, before, out, lanes, rounded),
        Node::HalfSum(pairs) => sum_row(&pairs, before, out, lanes, rounded_quarters),
        Node::After(bias, scale, halves, pairs) => {
            let pairs = &pairs;
            match scale {
                Scale::One => sum_row(pairs, before, out, lanes, |sum| rounded_after(sum, halves, bias, Scale::One)),
                Scale::Two => sum_row(pairs, before, out, lanes, |sum| rounded_after(sum, halves, bias, Scale::Two)),
                Scale::Four => sum_row(pairs, before, out, lanes, |sum| rounded_after(sum, halves, bias, Scale::Four)),
                Scale::Half => sum_row(pairs, before, out, lanes, |sum| rounded_after(sum, halves, bias, Scale::Half)),
            }
        }
        Node::Bytes([a, b]) => {
            let (a, b) = (row(a), row(b));
            each(out, lanes, |n| byte_product(a[n], b[n]));
        }
        Node::ByteSum(v) => {
            let [a, b, c, d] = [row(v[0]), row(v[1]), row(v[2]), row(v[3])];
            each(out, lanes, |n| byte_sum([a[n], b[n], c[n], d[n]]));
        }
        Node::Difference(v) => {
            let [a, b, c, d] = [row(v[0]), row(v[1]), row(v[2]), row(v[3])];
            each(out, lanes, |n| difference([a[n], b[n], c[n], d[n]]));
        }
        Node::UnsignedDot(v) => {
            let [a, b, c, d, e, f] = [row(v[0]), row(v[1]), row(v[2]), row(v[3]), row(v[4]), row(v[5])];
            each(out, lanes, |n| unsigned_dot([a[n], c[n], e[n]], [b[n], d[n], f[n]]));
        }
        Node::Scaled(bias, scale, v) => {
            let v = row(v);
            each(out, lanes, |n| scaled(v[n], bias, scale));
        }
        Node::Output(bias, scale, floor, v) => {
            let v = row(v);
            match (bias, scale) {
                (Bias::None, Scale::One) => finish_row(Bias::None, Scale::One, floor, v, out, lanes),
                (Bias::None, Scale::Two) => finish_row(Bias::None, Scale::Two, floor, v, out, lanes),
                (Bias::None, Scale::Four) => finish_row(Bias::None, Scale::Four, floor, v, out, lanes),
                (Bias::None, Scale::Half) => finish_row(Bias::None, Scale::Half, floor, v, out, lanes),
                (Bias::NegativeHalf, Scale::One) => finish_row(Bias::NegativeHalf, Scale::One, floor, v, out, lanes),
                (Bias::NegativeHalf, Scale::Two) => finish_row(Bias::NegativeHalf, Scale::Two, floor, v, out, lanes),
                // Not legal (CMB-9), so it never occurs.
                (Bias::NegativeHalf, other) => finish_row(Bias::NegativeHalf, other, floor, v, out, lanes),
            }
        }
        Node::Select(mux, v) => {
            let [by, cd, ab] = [row(v[0]), row(v[1]), row(v[2])];
            // By bits, because compilers turn a choice into one of addresses.
            let choose = |takes_cd: bool, cd: i16, ab: i16| ab ^ ((cd ^ ab) & -i16::from(takes_cd));
            let mut select = |mux: Mux| each(out, lanes, |n| choose(takes_cd(by[n], mux), cd[n], ab[n]));
            match mux {
                Mux(MuxSelect::Msb, MuxNegative::Sign) => select(Mux(MuxSelect::Msb, MuxNegative::Sign)),
                Mux(MuxSelect::Msb, MuxNegative::Bit7) => select(Mux(MuxSelect::Msb, MuxNegative::Bit7)),
                Mux(MuxSelect::Lsb, _) => select(Mux(MuxSelect::Lsb, MuxNegative::Sign)),
            }
        }
        Node::Add([a, b]) => {
            let (a, b) = (row(a), row(b));
            each(out, lanes, |n| a[n] + b[n]);
        }
        Node::Minus([a, b]) => {
            let (a, b) = (row(a), row(b));
            each(out, lanes, |n| a[n] - b[n]);
        }
        Node::Least([a, b]) => {
            let (a, b) = (row(a), row(b));
            each(out, lanes, |n| a[n].min(b[n]));
        }
        Node::Greatest([a, b]) => {
            let (a, b) = (row(a), row(b));
            each(out, lanes, |n| a[n].max(b[n]));
        }
        Node::Clamp(v) => {
            let v = row(v);
            each(out, lanes, |n| v[n].clamp(0, 255));
        }
        Node::Truncate(bits, v) => {
            let v = row(v);
            each(out, lanes, |n| i32::from(v[n]).truncated(bits) as i16);
        }
        Node::Signed(v) => {
            let v = row(v);
            each(out, lanes, |n| i32::from(v[n]).signed_byte() as i16);
        }
        Node::Converted(channel, v) => {
            let [y, cb, cr] = [row(v[0]), row(v[1]), row(v[2])];
            // A loop for each channel.
            match channel {
                0 => each(out, lanes, |n| converted(0, [y[n], cb[n], cr[n]])),
                1 => each(out, lanes, |n| converted(1, [y[n], cb[n], cr[n]])),
                _ => each(out, lanes, |n| converted(2, [y[n], cb[n], cr[n]])),
            }
        }
    }
}

static ZEROS: [i16; BLOCK] = [0; BLOCK];

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of one to six products, with other numbers in the rows that nobody reads.
    #[test]
    fn sums_have_as_many_products_as_they_say() {
        for count in 1..=MAX_PRODUCTS {
            let mut rows = vec![PerLane::from_value(99); 4];
            let mut values = [Value(0); 2 * MAX_PRODUCTS];
            let mut wanted = 0;
            for (n, value) in values[..2 * count].iter_mut().enumerate() {
                *value = Value(rows.len() as u16);
                rows.push(PerLane::from_value(17 * n as i16 - 40));
            }
            for pair in 0..count as i32 {
                wanted += (34 * pair - 40) * (34 * pair - 23);
            }
            let at = rows.len();
            rows.push(PerLane::from_value(0));
            run(&Node::Sum(Pairs { count, values }), at, Lanes::default(), &mut rows);
            assert_eq!(rows[at].block(), &[wanted.rounded(); BLOCK], "{count}");
        }
    }
}
