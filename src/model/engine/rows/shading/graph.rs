//! The values that a draw computes for every pixel, each made of earlier ones. Constants are folded, identities are dropped, and equal
//! values are shared.
//!
//! Each value has a range from the beginning, by which clamps that cannot clamp and maxima that are never taken disappear.

use super::kernels;
use super::node::{Input, MAX_PRODUCTS, Mapping, Mux, Node, Pairs, Value};
use crate::algebra::Algebra;
use crate::state::{Bias, ExpandCentre, HalfBiasConstant, InputMapping, MuxNegative, MuxSelect, Policies, Scale};
use crate::trace::Rule;
use std::collections::HashMap;

/// A factor, in halves of a step if `halves` is set (CMB-4=127.5).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factor {
    value: Value,
    halves: bool,
}

/// A sum before it is rounded.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Total {
    /// A sum of products.
    Products(Products),
    /// The first product less the second.
    Difference([Factor; 4]),
    /// CMB-10: selects CD or AB.
    Select(Choice, Products, Products),
}

/// Products that are added.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Products(usize, [(Factor, Factor); MAX_PRODUCTS]);

/// The value that steers a mux, and the mux.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice(Mux, Value);

impl Total {
    /// Returns the products. Only sums of products are added or selected.
    fn products(self) -> Products {
        match self {
            Total::Products(products) => products,
            // The order of the rules never asks for these.
            Total::Difference([a, b, ..]) => Products::one(a, b),
            Total::Select(_, cd, _) => cd,
        }
    }
}

impl Products {
    fn one(a: Factor, b: Factor) -> Products {
        Products(1, [(a, b); MAX_PRODUCTS])
    }

    fn all(&self) -> &[(Factor, Factor)] {
        &self.1[..self.0]
    }

    fn and(mut self, other: Products) -> Products {
        for pair in other.all() {
            self.1[self.0] = *pair;
            self.0 += 1;
        }
        self
    }
}

/// The mapping that [`Node::UnsignedDot`] applies to its factors.
const EXPANDED: Mapping =
    Mapping { of: InputMapping::ExpandNormal, centre: ExpandCentre::Centred, half: HalfBiasConstant::Half128 };

/// Least and largest value.
type Range = (i16, i16);

/// The graph: values, each made of earlier ones.
#[derive(Debug)]
pub(crate) struct Graph {
    nodes: Vec<(Node, Range)>,
    known: HashMap<Node, Value>,
    policies: Policies,
}

impl Graph {
    pub(crate) fn new(policies: Policies) -> Graph {
        Graph { nodes: Vec::new(), known: HashMap::new(), policies }
    }

    /// Returns how a value is computed.
    pub(crate) fn node(&self, value: Value) -> Node {
        self.nodes[usize::from(value.0)].0
    }

    fn range(&self, value: Value) -> Range {
        self.nodes[usize::from(value.0)].1
    }

    /// Returns the value if it is the same in every pixel.
    fn known_constant(&self, value: Value) -> Option<i16> {
        let (low, high) = self.range(value);
        (low == high).then_some(low)
    }

    /// Returns whether a value is this constant.
    fn is(&self, value: Value, constant: i16) -> bool {
        self.known_constant(value) == Some(constant)
    }

    pub(crate) fn constant(&mut self, value: i16) -> Value {
        self.add(Node::Constant(value), (value, value))
    }

    /// Adds an input with a given range.
    pub(crate) fn input(&mut self, input: Input, range: Range) -> Value {
        self.add(Node::Input(input), range)
    }

    fn add(&mut self, node: Node, range: Range) -> Value {
        let node = if range.0 == range.1 { Node::Constant(range.0) } else { node };
        if let Some(value) = self.known.get(&node) {
            return *value;
        }
        let value = Value(self.nodes.len() as u16);
        self.nodes.push((node, range));
        self.known.insert(node, value);
        value
    }

    /// Adds a mapping of a value.
    fn mapped(&mut self, mapping: Mapping, v: Value) -> Value {
        let (low, high) = self.range(v);
        match mapping.of {
            InputMapping::SignedIdentity => return v,
            InputMapping::UnsignedIdentity if low >= 0 => return v,
            InputMapping::UnsignedIdentity => {
                if let Some(dot) = self.unsigned_dot(v) {
                    return dot;
                }
            }
            _ => {}
        }
        // Every mapping is monotone, so the ends of the range suffice.
        let ends = [kernels::mapped(mapping, low), kernels::mapped(mapping, high)];
        self.add(Node::Map(mapping, v), (ends[0].min(ends[1]), ends[0].max(ends[1])))
    }

    /// Returns a dot product of expanded vectors that is only read as unsigned, or `None` if `v` is no such product.
    fn unsigned_dot(&mut self, v: Value) -> Option<Value> {
        let Node::Output(Bias::None, Scale::One, _, sum) = self.node(v) else { return None };
        let Node::Sum(pairs) = self.node(sum) else { return None };
        let mut vectors = [Value(0); 6];
        for (vector, factor) in vectors.iter_mut().zip(&pairs.values) {
            let Node::Map(EXPANDED, unexpanded) = self.node(*factor) else { return None };
            *vector = unexpanded;
        }
        (pairs.count == 3).then(|| self.add(Node::UnsignedDot(vectors), (0, 255)))
    }

    /// Adds a sum of products, rounded by NUM-2.
    fn rounded_sum(&mut self, pairs: &[(Value, Value)]) -> Value {
        let mut left: Vec<(Value, Value)> = Vec::with_capacity(pairs.len());
        left.extend(pairs.iter().filter(|(a, b)| !self.is(*a, 0) && !self.is(*b, 0)));
        match left[..] {
            [] => return self.constant(0),
            [one] => {
                if let Some(v) = self.times_one(one) {
                    return v;
                }
                let (a, b) = (one.0.min(one.1), one.0.max(one.1));
                if self.are_bytes(&[a, b]) {
                    let ends = self.product_range(a, b);
                    return self.add(Node::Bytes([a, b]), (kernels::rounded(ends.0), kernels::rounded(ends.1)));
                }
            }
            [one, other] => {
                if let (Some(a), Some(b)) = (self.times_one(one), self.times_one(other)) {
                    return self.added(a, b);
                }
            }
            _ => {}
        }
        let (mut low, mut high) = (0, 0);
        for (a, b) in &left {
            let ends = self.product_range(*a, *b);
            (low, high) = (low + ends.0, high + ends.1);
        }
        self.add(Node::Sum(Pairs::new(&left)), (kernels::rounded(low), kernels::rounded(high)))
    }

    /// Adds the conversion of Y, Cb and Cr (TEX-19).
    pub(crate) fn converted(&mut self, color: [Value; 3]) -> [Value; 3] {
        let known = color.map(|value| self.known_constant(value));
        [0, 1, 2].map(|channel| match known {
            [Some(y), Some(cb), Some(cr)] => self.constant(kernels::converted(channel, [y, cb, cr])),
            _ => self.add(Node::Converted(channel, color), (0, 255)),
        })
    }

    fn are_bytes(&self, values: &[Value]) -> bool {
        values.iter().all(|v| self.range(*v).0 >= 0 && self.range(*v).1 <= 255)
    }

    /// Adds a sum of two products of bytes that is at most 255.
    fn byte_sum(&mut self, pairs: Pairs) -> Value {
        let [a, b, c, d, ..] = pairs.values;
        let (first, second) = (self.product_range(a, b), self.product_range(c, d));
        let range = [first.0 + second.0, first.1 + second.1].map(|sum| kernels::rounded(sum).min(255));
        self.add(Node::ByteSum([a, b, c, d]), (range[0], range[1]))
    }

    /// Returns a value limited to 255 if it is a sum of two products of bytes, and `None` otherwise.
    fn limited(&mut self, x: Value) -> Option<Value> {
        let Node::Sum(pairs) = self.node(x) else { return None };
        (pairs.count == 2 && self.are_bytes(&pairs.values[..4])).then(|| self.byte_sum(pairs))
    }

    /// Returns whether the factors are in halves, the factors, and the range of their sum, which is in quarters if the factors are in
    /// halves.
    fn pairs(&mut self, products: &Products) -> (bool, Vec<(Value, Value)>, (i32, i32)) {
        let halves = products.all().iter().any(|(a, b)| a.halves || b.halves);
        let mut whole = |factor: Factor| {
            if halves && !factor.halves { self.added(factor.value, factor.value) } else { factor.value }
        };
        let pairs: Vec<_> = products.all().iter().map(|(a, b)| (whole(*a), whole(*b))).collect();
        let range = pairs.iter().map(|(a, b)| self.product_range(*a, *b));
        let range = range.fold((0, 0), |(low, high), ends| (low + ends.0, high + ends.1));
        (halves, pairs, range)
    }

    fn rounded_products(&mut self, products: &Products) -> Value {
        let (halves, pairs, (low, high)) = self.pairs(products);
        if !halves {
            return self.rounded_sum(&pairs);
        }
        let range = (kernels::rounded_quarters(low), kernels::rounded_quarters(high));
        self.add(Node::HalfSum(Pairs::new(&pairs)), range)
    }

    fn products_after(&mut self, bias: Bias, scale: Scale, products: &Products) -> Value {
        if scale == Scale::One {
            // A bias of whole steps commutes with the rounding.
            let rounded = self.rounded_products(products);
            return self.scaled(bias, scale, rounded);
        }
        let (halves, pairs, (low, high)) = self.pairs(products);
        let end = |sum: i32| kernels::rounded_after(sum, halves, bias, scale);
        self.add(Node::After(bias, scale, halves, Pairs::new(&pairs)), (end(low), end(high)))
    }

    /// Returns the other factor of a product by 1.0, since 255 a divided by 255 is exact.
    fn times_one(&self, (a, b): (Value, Value)) -> Option<Value> {
        if self.is(a, 255) { Some(b) } else { self.is(b, 255).then_some(a) }
    }

    fn product_range(&self, a: Value, b: Value) -> (i32, i32) {
        let ((a0, a1), (b0, b1)) = (self.range(a), self.range(b));
        let of = |a: i16, b: i16| i32::from(a) * i32::from(b);
        let all = [of(a0, b0), of(a0, b1), of(a1, b0), of(a1, b1)];
        (all.into_iter().fold(i32::MAX, i32::min), all.into_iter().fold(i32::MIN, i32::max))
    }

    /// Adds a b - c d, rounded by NUM-2.
    fn difference(&mut self, [a, b, c, d]: [Value; 4]) -> Value {
        if self.is(c, 0) || self.is(d, 0) {
            return self.rounded_sum(&[(a, b)]);
        }
        if let (Some(first), Some(second)) = (self.times_one((a, b)), self.times_one((c, d))) {
            return self.minus(first, second);
        }
        let (first, second) = (self.product_range(a, b), self.product_range(c, d));
        let range = (kernels::rounded(first.0 - second.1), kernels::rounded(first.1 - second.0));
        self.add(Node::Difference([a, b, c, d]), range)
    }

    fn selected(&mut self, Choice(mux, by): Choice, cd: Value, ab: Value) -> Value {
        if ab == cd {
            return ab;
        }
        if let Some(by) = self.known_constant(by) {
            return if kernels::takes_cd(by, mux) { cd } else { ab };
        }
        let (c, a) = (self.range(cd), self.range(ab));
        self.add(Node::Select(mux, [by, cd, ab]), (c.0.min(a.0), c.1.max(a.1)))
    }

    fn added(&mut self, a: Value, b: Value) -> Value {
        match (self.known_constant(a), self.known_constant(b)) {
            (Some(0), _) => b,
            (_, Some(0)) => a,
            _ => {
                let (x, y) = (self.range(a), self.range(b));
                self.add(Node::Add([a.min(b), a.max(b)]), (x.0 + y.0, x.1 + y.1))
            }
        }
    }
}

impl Algebra for Graph {
    type Register = Value;
    type Factor = Factor;
    type Sum = Total;
    type Choice = Choice;

    fn policies(&self) -> &Policies {
        &self.policies
    }

    fn byte(&mut self, value: u8) -> Value {
        self.constant(value.into())
    }

    fn map(&mut self, mapping: InputMapping, x: Value) -> Factor {
        let mapping = Mapping::new(mapping, &self.policies);
        Factor { value: self.mapped(mapping, x), halves: mapping.half == HalfBiasConstant::Half127And5 }
    }

    fn plain(&mut self, x: Value) -> Factor {
        Factor { value: x, halves: false }
    }

    fn product(&mut self, _rule: Rule, a: Factor, b: Factor) -> Total {
        Total::Products(Products::one(a, b))
    }

    fn add(&mut self, _rule: Rule, a: Total, b: Total) -> Total {
        Total::Products(a.products().and(b.products()))
    }

    fn subtract(&mut self, _rule: Rule, a: Total, b: Total) -> Total {
        let [(a, b), (c, d)] = [a, b].map(|total| total.products().1[0]);
        Total::Difference([a, b, c, d])
    }

    fn widened(&mut self, _rule: Rule, x: Value) -> Total {
        let one = self.constant(255);
        let [x, one] = [x, one].map(|value| Factor { value, halves: false });
        Total::Products(Products::one(x, one))
    }

    fn choice(&mut self, select: MuxSelect, spare0_alpha: Value) -> Choice {
        let negative = match select {
            MuxSelect::Msb => self.policies.mux_negative,
            MuxSelect::Lsb => MuxNegative::Sign,
        };
        Choice(Mux(select, negative), spare0_alpha)
    }

    fn select(&mut self, takes_cd: Choice, cd: Total, ab: Total) -> Total {
        Total::Select(takes_cd, cd.products(), ab.products())
    }

    fn rounded(&mut self, sum: Total) -> Value {
        match sum {
            Total::Products(products) => self.rounded_products(&products),
            // A difference of the blend, whose factors are whole.
            Total::Difference(factors) => self.difference(factors.map(|factor| factor.value)),
            Total::Select(choice, cd, ab) => {
                let (cd, ab) = (self.rounded_products(&cd), self.rounded_products(&ab));
                self.selected(choice, cd, ab)
            }
        }
    }

    fn rounded_after(&mut self, bias: Bias, scale: Scale, sum: Total) -> Value {
        if let Total::Select(choice, cd, ab) = sum {
            let [cd, ab] = [cd, ab].map(|products| self.products_after(bias, scale, &products));
            return self.selected(choice, cd, ab);
        }
        self.products_after(bias, scale, &sum.products())
    }

    fn scaled(&mut self, bias: Bias, scale: Scale, x: Value) -> Value {
        if (bias, scale) == (Bias::None, Scale::One) {
            return x;
        }
        let (low, high) = self.range(x);
        let range = (kernels::scaled(low, bias, scale), kernels::scaled(high, bias, scale));
        self.add(Node::Scaled(bias, scale, x), range)
    }

    fn saturated(&mut self, x: Value) -> Value {
        let floor = self.policies.register_floor;
        let saturated = |v: i16| kernels::finished(v, Bias::None, Scale::One, floor);
        let (low, high) = self.range(x);
        let range = (saturated(low), saturated(high));
        if let Some(limited) = self.limited(x) {
            return limited;
        }
        // Computed in one step with its saturation.
        match self.node(x) {
            Node::Scaled(bias, scale, v) => self.add(Node::Output(bias, scale, floor, v), range),
            _ if range == (low, high) => x,
            _ => self.add(Node::Output(Bias::None, Scale::One, floor, x), range),
        }
    }

    fn max0(&mut self, x: Value) -> Value {
        self.mapped(Mapping::plain(InputMapping::UnsignedIdentity), x)
    }

    fn complement(&mut self, x: Value) -> Value {
        if self.range(x).0 >= 0 {
            return self.mapped(Mapping::plain(InputMapping::UnsignedInvert), x);
        }
        let one = self.constant(255);
        self.minus(one, x)
    }

    fn plus(&mut self, a: Value, b: Value) -> Value {
        self.added(a, b)
    }

    fn minus(&mut self, a: Value, b: Value) -> Value {
        let (x, y) = (self.range(a), self.range(b));
        self.add(Node::Minus([a, b]), (x.0 - y.1, x.1 - y.0))
    }

    fn least(&mut self, a: Value, b: Value) -> Value {
        let (x, y) = (self.range(a), self.range(b));
        if x.1 <= y.0 {
            a
        } else if y.1 <= x.0 {
            b
        } else {
            self.add(Node::Least([a, b]), (x.0.min(y.0), x.1.min(y.1)))
        }
    }

    fn greatest(&mut self, a: Value, b: Value) -> Value {
        let (x, y) = (self.range(a), self.range(b));
        if x.0 >= y.1 {
            a
        } else if y.0 >= x.1 {
            b
        } else {
            self.add(Node::Greatest([a, b]), (x.0.max(y.0), x.1.max(y.1)))
        }
    }

    fn clamped(&mut self, v: Value) -> Value {
        let (low, high) = self.range(v);
        if low >= 0 && high <= 255 {
            return v;
        }
        if let Some(limited) = self.limited(v) {
            return limited;
        }
        self.add(Node::Clamp(v), (low.clamp(0, 255), high.clamp(0, 255)))
    }

    fn truncated(&mut self, bits: u32, v: Value) -> Value {
        if bits == 0 {
            return v;
        }
        let (low, high) = self.range(v);
        self.add(Node::Truncate(bits, v), (low >> bits << bits, high >> bits << bits))
    }

    fn signed_byte(&mut self, x: Value) -> Value {
        self.add(Node::Signed(x), (-128, 127))
    }
}
