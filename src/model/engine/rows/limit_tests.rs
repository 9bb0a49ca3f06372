//! Compares kernels with the definition where all numbers of a pixel lie at the ends of their ranges.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use super::lanes::{BLOCK, Lanes, PerLane};
use super::lattice::{self, pick};
use super::shading::graph::Graph;
use super::shading::kernels::run;
use super::shading::node::{Input, Node, Value};
use crate::algebra::Algebra;
use crate::combiner::direct::Direct;
use crate::combiner::general::{dot, output, third};
use crate::random::Random;
use crate::state::*;
use crate::trace::{Rule, Silent};

/// Computes values from inputs by the operations of combiners and blends, as a seed says. The first four inputs are bytes, the others registers.
fn program<A: Algebra>(a: &mut A, inputs: &[A::Register], seed: u64) -> Vec<A::Register>
where
    A::Register: Copy,
    A::Factor: Copy,
    A::Sum: Copy,
{
    let mut random = Random::seeded(seed);
    let next = &mut || random.bits() as u32;
    let mut bytes = inputs[..4].to_vec();
    let mut all = inputs.to_vec();
    for _ in 0..6 {
        let byte = |next: &mut dyn FnMut() -> u32| bytes[next() as usize % bytes.len()];
        let (s, d, sf, df) = (byte(next), byte(next), byte(next), byte(next));
        let register = |next: &mut dyn FnMut() -> u32| all[next() as usize % all.len()];
        match next() % 9 {
            // A portion of a general stage.
            0..=3 => {
                let mut product = || {
                    let [x, y]: [[A::Factor; 3]; 2] = std::array::from_fn(|_| {
                        let mapping = pick(next, InputMapping::ALL);
                        std::array::from_fn(|_| {
                            let x = register(next);
                            a.map(mapping, x)
                        })
                    });
                    if next().is_multiple_of(3) { dot(x, y, a) } else { a.product(Rule::Cmb6, x[0], y[0]) }
                };
                let (ab, cd) = (product(), product());
                let (select, by) = (pick(next, MuxSelect::ALL), register(next));
                let takes_cd = a.choice(select, by);
                let raw = third(next().is_multiple_of(3), takes_cd, ab, cd, a);
                let (bias, scale) = pick(
                    next,
                    &[
                        (Bias::None, Scale::One),
                        (Bias::None, Scale::Two),
                        (Bias::None, Scale::Four),
                        (Bias::None, Scale::Half),
                        (Bias::NegativeHalf, Scale::One),
                        (Bias::NegativeHalf, Scale::Two),
                    ],
                );
                let portion = Portion { bias, scale, ..Portion::idle(Component::Rgb) };
                all.push(output(&portion, raw, a));
            }
            4 => {
                let x = register(next);
                bytes.push(a.max0(x));
            }
            // A dot product of expanded vectors that is read as unsigned.
            5 => {
                let [x, y]: [[A::Factor; 3]; 2] = std::array::from_fn(|_| {
                    std::array::from_fn(|_| {
                        let x = register(next);
                        a.map(InputMapping::ExpandNormal, x)
                    })
                });
                let sum = dot(x, y, a);
                let register = output(&Portion::idle(Component::Rgb), sum, a);
                bytes.push(a.max0(register));
            }
            // A blend.
            6 | 7 => {
                let [s, d, sf, df] = [s, d, sf, df].map(|x| a.plain(x));
                let (x, y) = (a.product(Rule::Rop2, s, sf), a.product(Rule::Rop2, d, df));
                let sum = if next().is_multiple_of(2) { a.add(Rule::Rop2, x, y) } else { a.subtract(Rule::Rop2, x, y) };
                let rounded = a.rounded(sum);
                bytes.push(a.clamped(rounded));
            }
            _ => {
                let made = match next() % 5 {
                    0 => a.least(s, d),
                    1 => a.greatest(s, d),
                    2 => a.truncated(pick(next, &[2, 3]), s),
                    3 => {
                        let signed = a.signed_byte(s);
                        let sum = a.plus(d, signed);
                        a.clamped(sum)
                    }
                    _ => a.complement(s),
                };
                bytes.push(made);
            }
        }
        // Combiners read what blends yield, too.
        all.extend(bytes.last());
    }
    all.extend(bytes);
    all
}

/// The nodes of programs of all operations yield what the order yields on numbers, in every lane.
#[test]
fn nodes_at_the_ends_of_their_ranges() {
    let mut random = Random::seeded(77);
    let mut kinds = std::collections::BTreeMap::<String, u32>::new();
    for seed in 0..1_500 {
        let next = &mut || random.bits() as u32;
        let mut policies = Policies::DEFAULT;
        if seed % 2 == 1 {
            for policy in POLICIES {
                policies.choose(policy.rule, next() as usize % policy.values.len());
            }
        }
        let ranges: [(i16, i16); 8] =
            [(0, 255), (0, 255), (0, 255), (0, 255), (0, 255), (-256, 254), (-256, 255), (-256, 255)];
        let mut graph = Graph::new(policies);
        let inputs: Vec<Value> = (0..8).map(|n| graph.input(Input::Texture(n / 4, n % 4), ranges[n])).collect();
        let outputs = program(&mut graph, &inputs, seed);
        let count = outputs.iter().map(|value| usize::from(value.0) + 1).max().unwrap();
        let mut rows = vec![PerLane::from_value(0_i16); count];
        for (value, (low, high)) in inputs.iter().zip(ranges) {
            for lane in rows[usize::from(value.0)].block_mut() {
                *lane = lattice::whole(next, (low.into(), high.into())) as i16;
            }
        }
        for at in 0..count {
            let node = graph.node(Value(at as u16));
            if let Node::Constant(value) = node {
                rows[at] = PerLane::from_value(value);
            }
            *kinds.entry(format!("{node:?}").split(['(', '[']).next().unwrap().to_owned()).or_default() += 1;
            run(&node, at, Lanes::default(), &mut rows);
        }
        for lane in 0..BLOCK {
            let numbers: Vec<i32> = inputs.iter().map(|value| rows[usize::from(value.0)].0[lane].into()).collect();
            let wanted = program(&mut Direct::<i32, _>::new(&policies, &mut Silent), &numbers, seed);
            let got = outputs.iter().map(|value| i32::from(rows[usize::from(value.0)].0[lane]));
            assert!(got.eq(wanted.iter().copied()), "seed {seed}, {policies:?}: {numbers:?}");
        }
    }
    println!("{kinds:?}");
    assert!(kinds.len() >= 19, "{kinds:?}");
}
