//! Tests of WGT-1 on the definition and on doubles.
#![allow(clippy::float_arithmetic, reason = "choosing numbers")]

use super::binary::Binary;
use super::weights::{self, *};
use crate::random::Random;

fn double(n: Binary) -> f64 {
    n.mantissa as f64 * 2_f64.powi(n.exponent as i32)
}

/// Returns numbers of up to `bits` bits at which roundings change: powers of two, their neighbours, ties, runs of ones, and random ones.
fn boundary(random: &mut Random, bits: u32) -> i64 {
    let top = random.bits() % u64::from(bits) + 1;
    let low = random.bits() % top;
    let one = |n: u64| 1_i64 << n;
    let n = match random.bits() % 8 {
        0 => one(top - 1),
        1 => one(top - 1) - 1,
        2 => one(top - 1) + 1,
        3 => one(top - 1) + one(low) - 1,
        4 => one(top - 1) - one(low),
        5 => one(top - 1) + one(low),
        6 => (random.bits() >> (64 - top)) as i64 & !(one(low) - 1),
        _ => (random.bits() >> (64 - top)) as i64,
    };
    n.clamp(0, one(u64::from(bits)) - 1)
}

fn w(random: &mut Random) -> f32 {
    let mantissa = boundary(random, 23) as u32;
    f32::from_bits((127 - 20 + (random.bits() % 40) as u32) << 23 | mantissa)
}

fn value(random: &mut Random) -> f32 {
    let exponent = match random.bits() % 4 {
        0 => random.bits() % 255,
        1 => 100 + random.bits() % 50,
        2 => 126 + random.bits() % 3,
        _ => return if random.bits().is_multiple_of(2) { 0.0 } else { -0.0 },
    };
    f32::from_bits(((random.bits() % 2) as u32) << 31 | (exponent as u32) << 23 | boundary(random, 23) as u32)
}

/// Compares doubles with the definition, inside and outside of triangles.
#[test]
fn doubles_are_the_definition() {
    let mut random = Random::seeded(65);
    for step in 0..1_500_000 {
        let mut e: [i64; 3] = std::array::from_fn(|_| boundary(&mut random, 37));
        if step % 7 == 0 {
            e[1] = e[0];
        }
        if step % 3 == 0 {
            let k = (random.bits() % 3) as usize;
            e[k] = -e[k];
        }
        if e.iter().sum::<i64>() <= 0 {
            continue;
        }
        let corners = [w(&mut random), w(&mut random), w(&mut random)];
        let ratios = weights::ratios(corners.map(Binary::new));
        assert_eq!(ratios.map(double), weights::ratios(corners.map(f64::from)), "{corners:?}");
        let ratios = (step % 4 > 0).then_some(ratios);
        let exact = Weights::<Binary>::new(e.map(Binary::from_edge), ratios);
        let found = Weights::<f64>::new(e.map(f64::from_edge), ratios.map(|r| r.map(double)));
        let context = || format!("{e:?} {corners:?} {exact:?} {found:?}");
        assert_eq!(exact.edges.map(double), found.edges, "{}", context());
        assert_eq!(double(exact.sum), found.sum, "{}", context());
        assert_eq!(double(exact.reciprocal), found.reciprocal, "{}", context());
        assert_eq!(exact.shares.map(double), found.shares, "{}", context());
        assert_eq!(exact.b.map(double), found.b, "{}", context());
        assert_eq!(exact.dominant, found.dominant);
        let f = [value(&mut random), value(&mut random), value(&mut random)];
        let outer = |n: usize| 2 * n;
        let (b, lanes) = ([0, 1].map(|n| exact.b[outer(n)]), [0, 1].map(|n| found.b[outer(n)]));
        let [exact, found] = [double(Linear::<Binary>::new(f).at(b)), Linear::<f64>::new(f).at(lanes)];
        assert_eq!(exact, found, "{f:?} {}", context());
    }
}

/// Rests of weights that are not negative, many of them hardly beside a number of 24 bits.
#[test]
fn rests_of_weights_are_rests() {
    let mut random = Random::seeded(29);
    for step in 0..1_000_000 {
        let mut weight = || {
            let (mantissa, down) = (boundary(&mut random, 24), random.bits() % 60);
            let down = down as i32 + 1;
            Binary { mantissa, exponent: (-down - bits_of(mantissa)).into() }.cut()
        };
        let (a, mut b) = (weight(), weight());
        if step % 2 == 0 {
            // So that the sum hardly differs from a multiple of 2^-25.
            let beyond = (1_i64 << 24) - (step & 3);
            let unit = a.exponent;
            b = Binary { mantissa: beyond, exponent: unit - 24 }.cut();
        }
        if double(a) + double(b) > 0.7 {
            continue;
        }
        let rest = |a: Binary, b: Binary| double(Binary::rest::<false>(a, b));
        assert_eq!(f64::rest::<true>(double(a), double(b)), rest(a, b), "{a:?} {b:?}");
        assert_eq!(f64::rest::<true>(double(b), double(a)), rest(a, b), "{a:?} {b:?}");
        assert_eq!(double(Binary::rest::<true>(a, b)), rest(a, b), "{a:?} {b:?}");
    }
}

fn bits_of(n: i64) -> i32 {
    64 - n.leading_zeros() as i32
}

/// Sums of all lengths: two steps of Newton's method stay below 1 / S, and they lack less than 4.5 units of the 29th bit.
#[test]
fn reciprocals_are_low() {
    let mut random = Random::seeded(3);
    for _ in 0..200_000 {
        let sum = boundary(&mut random, 31).clamp(1, 3 << 29);
        let Binary { mantissa, exponent } = Binary { mantissa: sum, exponent: 0 }.reciprocal::<false>();
        let (sum, mantissa) = (sum as u128, mantissa as u128);
        if sum.is_power_of_two() {
            assert_eq!(mantissa * sum, 1 << -exponent);
            continue;
        }
        assert!(mantissa * sum < 1 << -exponent && (2 * mantissa + 9) * sum > 2 << -exponent, "{sum}");
    }
}

/// Sums of captured triangles, whose reciprocals their depths decide: three are one below the floor.
#[test]
fn captured_reciprocals() {
    let r = |sum: i64| Binary { mantissa: sum, exponent: 0 }.reciprocal::<true>().mantissa;
    assert_eq!([460_800, 798_720, 39_321_600, 765_952].map(r), [305_419_896, 352_407_572, 458_129_844, 367_483_831]);
    assert_eq!([371_433_472, 371_433_476].map(r), [387_997_310, 387_997_305]);
}

#[test]
fn a_number_worked_by_hand() {
    // A captured pixel: s of .89999998, 1.10000002, 1.10000002 where b_0 is 124/128 is .90625, texel 232 of 256. The exact value lies below.
    let b = [(124, -7), (0, 0)].map(|(mantissa, exponent)| Binary { mantissa, exponent });
    let s = Linear::<Binary>::new([0.9, 1.1, 1.1]).at(b);
    assert_eq!(double(s), 0.90625);
    let b = [(0, 0), (4, -7)].map(|(mantissa, exponent)| Binary { mantissa, exponent });
    assert!(double(Linear::<Binary>::new([0.9, 0.9, 1.1]).at(b)) < 0.90625);
}

#[test]
fn equal_weights_go_round() {
    let of = |n: [i64; 3]| dominance::<Binary, true>(n.map(|n| Binary::from_edge(n).cut()));
    assert_eq!(
        [of([5, 5, 2]), of([2, 5, 5]), of([5, 2, 5]), of([4, 4, 4])],
        [[true, false], [false, false], [false, true], [false, true]]
    );
}

/// TSH-4: terms below the last bit vanish, one by one, and a sum of more bits is cut again.
#[test]
fn sums_are_cut() {
    let unit = 2.0_f32.powi(-23);
    let cases = [
        ([1.0, unit / 2.0, unit / 2.0], 1.0),
        ([1.0, -unit / 2.0, 0.0], 1.0),
        ([1.0, 1.0 + unit, 0.0], 2.0),
        ([unit, -1.0, 1.0 - unit / 2.0], 0.0),
    ];
    for (terms, wanted) in cases {
        assert_eq!(cut_sum(terms.map(f64::from)), f64::from(wanted), "{terms:?}");
        assert_eq!(cut_sum(terms.map(Binary::new)).nearest_f32(), wanted, "{terms:?}");
    }
}

/// TEX-15: a number over itself is 1 only by a power of two; of 26 bits two are cut first.
#[test]
fn quotients_are_low() {
    let below = 1.0 - 2.0_f64.powi(-24);
    for (number, by, wanted) in
        [(4.0, 4.0, 1.0), (3.0, 3.0, below), (-3.0, 3.0, -below), (67_108_863.0, 1.0, 67_108_860.0)]
    {
        assert_eq!(quotient(number, f64::reciprocal::<true>(by)), wanted, "{number} / {by}");
        let [number, by] = [number, by].map(Binary::from_double).map(|n| n.first_bits(26));
        let found = quotient(number, by.reciprocal::<true>());
        assert_eq!(double(found), wanted, "{number:?} / {by:?}");
    }
}
