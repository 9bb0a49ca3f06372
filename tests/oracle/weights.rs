//! Computes the weights of the vertices, and what is linear in them: WGT-1.

use super::real::{Number, bits};
use std::cmp::Reverse;

/// WGT-1 (1): returns the edge numbers, from edge functions and, with perspective, from w of the vertices.
pub fn edge_numbers(edges: [i128; 3], w: Option<[Number; 3]>) -> [Number; 3] {
    let edges = edges.map(|edge| Number { m: edge, e: 0 }.cut(24));
    let Some(w) = w.filter(|w| w[0] != w[1] || w[1] != w[2]) else { return edges };
    std::array::from_fn(|k| {
        if k == 1 {
            return edges[k];
        }
        let ratio = w[1].times(reciprocal(w[k]));
        edges[k].times(ratio.cut(24)).cut(24)
    })
}

/// Returns the aligned sum: each term is cut toward zero at bit `n` of the largest one, then all are added.
pub fn sum(terms: [Number; 3], n: i32) -> Number {
    let Some(top) = terms.into_iter().filter_map(Number::exponent).max() else { return Number::ZERO };
    let last = top - n + 1;
    Number { m: terms.into_iter().map(|term| term.cut_at(last).over(last)).sum(), e: last }
}

/// WGT-1 (2): returns S, which outside of a triangle may have any sign but is not 0.
pub fn total(edges: [Number; 3]) -> Number {
    let sum = sum(edges, 29);
    if sum.m == 0 { Number { m: 1, ..sum } } else { sum }
}

/// WGT-1 (3): returns R of a number other than 0 that has at most 31 bits.
pub fn reciprocal(s: Number) -> Number {
    if s.m < 0 {
        return -reciprocal(-s);
    }
    let length = bits(s.m);
    if s.m == 1 << (length - 1) {
        return Number { m: 1, e: 1 - length - s.e };
    }
    let m = Number { m: s.m, e: 1 - length };
    let two = |m: Number| Number { m: (2_i128 << -m.e) - m.m, e: m.e };
    // Twice 128 times the middle is a whole number: the middle lies half a step of seven bits above the lower end.
    let doubled = 2 * m.floor(128) + 1;
    let first = Number { m: (2 * 32768 + doubled).div_euclid(2 * doubled), e: -7 };
    let near = Number { m: m.floor(1 << 14), e: -14 };
    let second = two(first.times(near)).times(first);
    let second = Number { m: (second.floor(1 << 16) + 1).div_euclid(2), e: -15 };
    let factor = Number { m: two(second.times(m)).floor(1 << 30), e: -30 };
    Number { m: factor.times(second).floor(1 << 29), e: -28 - length - s.e }
}

/// WGT-1 (4): returns the weights before one of them becomes the rest.
pub fn shares(edges: [Number; 3], r: Number) -> [Number; 3] {
    edges.map(|edge| edge.times(r).cut(24))
}

/// WGT-1 (5): returns the vertex whose weight has the largest exponent of those above 0.
pub fn dominant(b: [Number; 3]) -> usize {
    let size = b.map(|b| if b.m > 0 { b.exponent() } else { None });
    if size[0] == size[1] && size[1] == size[2] {
        return 2;
    }
    // In this order each vertex beats the next one.
    let ahead = |a: usize, b: usize| size[a] >= size[b];
    (0..3).find(|k| ahead(*k, (k + 1) % 3) && size[*k] > size[(k + 2) % 3]).unwrap_or(2)
}

/// Returns what two weights leave of 1, exactly.
pub fn rest(b: [Number; 3], d: usize) -> Number {
    let terms = [Number { m: 1, e: 0 }, -b[(d + 1) % 3], -b[(d + 2) % 3]];
    let last = terms.iter().filter(|term| term.m != 0).map(|term| term.e).min().unwrap_or(0);
    Number { m: terms.into_iter().map(|term| term.over(last)).sum(), e: last }
}

/// WGT-1: returns the three weights, or `None` if the sum of the edge numbers is below 0, which it is not inside a triangle.
pub fn weights(edges: [i128; 3], w: Option<[Number; 3]>) -> Option<[Number; 3]> {
    let (b, is_behind) = signed_weights(edges, w);
    (!is_behind).then_some(b)
}

/// WGT-1: returns the three weights, and whether the sum of the edge numbers is below 0.
pub fn signed_weights(edges: [i128; 3], w: Option<[Number; 3]>) -> ([Number; 3], bool) {
    let edges = edge_numbers(edges, w);
    let s = total(edges);
    let mut b = shares(edges, reciprocal(s));
    let d = dominant(b);
    b[d] = rest(b, d).up(24);
    (b, s.m < 0)
}

/// Returns what is linear with the values `f` at the vertices: the aligned sum at `n` bits of one vertex's value and of the differences
/// from it, times weights.
pub fn linear_from(reference: usize, f: [f32; 3], b: [Number; 3], n: i32) -> Number {
    let term = |k: usize| {
        let difference = (f[k] - f[reference]).clamp(f32::MIN, f32::MAX);
        if k == reference {
            Number::of(f[k])
        } else if difference.abs() < f32::MIN_POSITIVE {
            Number::ZERO
        } else {
            b[k].times(Number::of(difference))
        }
    };
    sum([0, 1, 2].map(term), n)
}

/// WGT-1 (8): returns the value of a function with the values `f` at the vertices.
pub fn linear(f: [f32; 3], b: [Number; 3]) -> Number {
    linear_from(1, f, b, 24)
}

/// WGT-1 (7), SMO-2: returns the weights of three colours in 256ths.
pub fn colour_weights(b: [Number; 3]) -> [i128; 3] {
    let toward_zero = |b: Number| if b.m < 0 { -(-b).floor(256) } else { b.floor(256) };
    let [w0, w2] = [b[0], b[2]].map(toward_zero);
    [w0, 256 - w0 - w2, w2]
}

/// Returns the vertex with the largest edge function by binary exponent. Of equals 1 precedes 0, and 0 precedes 2 (DEP-1).
pub fn largest_edge(edges: [i128; 3]) -> usize {
    let order = [1, 0, 2];
    let best = (0..3).min_by_key(|n| (Reverse(bits(edges[order[*n]].max(0))), *n));
    order[best.unwrap_or(0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(m: i128, e: i32) -> Number {
        Number { m, e }
    }

    /// A triangle whose corners are (0, 0), (1536, 0) and (0, 1536) in 1/16 pixel, at the centre of pixel (10, 1).
    fn of_the_section() -> [Number; 3] {
        let b1 = 1536 * 168;
        let b2 = 1536 * 24;
        weights([1536 * 1536 - b1 - b2, b1, b2], None).unwrap()
    }

    #[test]
    fn order_of_equals() {
        let b = |sizes: [i32; 3]| dominant(sizes.map(|e| number(1, e)));
        assert_eq!([b([0, 0, -1]), b([-1, 0, 0]), b([0, -1, 0]), b([0, 0, 0])], [0, 1, 2, 2]);
        assert_eq!([b([0, -1, -1]), b([-1, 0, -1]), b([-1, -1, 0])], [0, 1, 2]);
        assert_eq!(dominant([number(-8, 0), number(1, 0), number(0, 0)]), 1);
        assert_eq!(dominant([number(-8, 0), number(0, 0), number(1, 0)]), 2);
    }

    #[test]
    fn reciprocals() {
        assert_eq!(reciprocal(number(4, 3)).over(-5), 1);
        let r = reciprocal(number(3, 0));
        // The middle of 1.5 and the next number of seven bits is 385/256, s = floor(128 256/385 + 1/2) = 85, 2 - 1.5 s/128 = 257/256,
        // and s' = floor(85 257 + 1/2) 2^-15 = 21845 2^-15. 2 - 1.5 s' is 1 + 2^-16, and R = 21845 65537 2^-31 is 357913941.25 2^-29.
        assert_eq!((r.m, r.e), (357_913_941, -30));
        // Beside 2 s is 1/2 and s' = (1 + 2^-14)/2, so that R is hardly below 1/2.
        assert_eq!(reciprocal(number((1 << 30) - 1, 0)).m, (1 << 28) - 1);
    }

    #[test]
    fn terms_below_the_last_bit_vanish() {
        let s = sum([number(1, 30), number(-3, 0), number(7, 1)], 29);
        assert_eq!((s.m, s.e), ((1 << 28) + 3, 2));
        assert_eq!(sum([Number::ZERO; 3], 29).m, 0);
    }

    /// The bounds that the handbook states: relative ones of b_k but b_d, an absolute one of their sum, and that of constants.
    #[test]
    fn weights_are_near() {
        let mut random = ninebit::random::Random::seeded(3);
        let mut word = |bits: u32| i128::from(random.bits() >> (64 - bits));
        for _ in 0..200_000 {
            let edges: [i128; 3] = std::array::from_fn(|_| {
                let bits = 1 + word(5) as u32 + word(2) as u32;
                word(bits)
            });
            let w = [0; 3].map(|_| Number { m: 1 << 23 | word(23), e: word(5) as i32 - 40 });
            let w = (word(1) == 1).then_some(w);
            let Some(b) = weights(edges, w) else {
                assert_eq!(edges, [0; 3]);
                continue;
            };
            let exact: [f64; 3] = std::array::from_fn(|k| w.map_or(1.0, |w| 1.0 / w[k].real()) * edges[k] as f64);
            let whole: f64 = exact.iter().sum();
            let (low, high) = if w.is_some() { (-4.3, 3.1) } else { (-2.2, 1.1) };
            let unit = 2.0_f64.powi(-23);
            let mut lacks = 0.0;
            let numbers = edge_numbers(edges, w);
            let d = dominant(shares(numbers, reciprocal(sum(numbers, 29))));
            for k in (0..3).filter(|k| *k != d) {
                let real = exact[k] / whole;
                let error = b[k].real() - real;
                assert!(error >= low * unit * real && error <= high * unit * real, "{edges:?} {w:?} {k}: {error:e}");
                lacks -= error;
            }
            let error = b[d].real() - exact[d] / whole - lacks;
            assert!(error > -1e-15 && error < unit / 2.0 + 1e-15, "{edges:?} {w:?}: {error:e}");
            let constant = f32::from_bits(word(31) as u32);
            if constant.is_finite() {
                assert_eq!(linear([constant; 3], b).real(), f64::from(constant));
            }
        }
    }

    /// Outside the triangle, with the most extreme edge functions and w, no integer overflows.
    #[test]
    fn outside_no_integer_overflows() {
        let mut random = ninebit::random::Random::seeded(4);
        let mut word = |bits: u32| i128::from(random.bits() >> (64 - bits));
        let (mut some, mut most) = (0, 0);
        for _ in 0..200_000 {
            let mut edge = || (word(35) >> (word(6) % 36)) * (1 - 2 * word(1));
            let (first, second) = (edge(), edge());
            // Nearly cancels the first two.
            let edges = [first, second, word(6) - first - second];
            let w = [0; 3].map(|_| Number { m: 1 << 23, e: -43 + 40 * word(1) as i32 });
            let f = [0; 3].map(|_| f32::from_bits(word(32) as u32)).map(|f| if f.is_finite() { f } else { f32::MAX });
            if let Some(b) = weights(edges, (word(1) == 1).then_some(w)) {
                some += 1;
                assert!(b.iter().any(|b| b.m > 0));
                most = most.max(b.into_iter().filter_map(Number::exponent).max().unwrap_or(0));
                assert!(bits(linear(f, b).m) <= 26);
            }
        }
        assert!(some > 10_000 && most > 20, "{some} {most}");
    }

    #[test]
    fn what_is_cut_goes_to_the_rest() {
        let b = of_the_section();
        assert!(b[2].floor(64) == 0 && b[1].floor(64) == 6 && b[0].floor(8) == 7, "{b:?}");
        assert_eq!(colour_weights(b), [224, 29, 3]);
    }
}
