//! What a draw computes for every pixel, as values that depend on values: constants folded, identities dropped, equal values shared.
//!
//! Each value has a range, found when it is made. A clamp that cannot clamp and a maximum that is never taken disappear by it.

use super::kernels;
use crate::state::{Bias, InputMapping, MuxSelect, Scale};
use std::collections::HashMap;

/// A value of every pixel: its number in the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Value(pub(super) u16);

/// What the operations start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Input {
    /// A channel of the interpolated diffuse.
    Primary(usize),
    /// A channel of the interpolated specular.
    Secondary(usize),
    /// The fog factor.
    Fog,
    /// A channel of what a texture unit yields.
    Texture(usize, usize),
    /// A channel of what the surface holds.
    Destination(usize),
}

/// Most products in one sum: two dot products.
pub(super) const MOST: usize = 6;

/// Pairs whose products are added.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Pairs {
    /// How many.
    pub(super) count: usize,
    /// The pairs, first and second factor in turn; zeros past the end.
    pub(super) values: [Value; 2 * MOST],
}

/// How a value comes about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Node {
    /// The same in every pixel.
    Constant(i16),
    /// Given.
    Input(Input),
    /// CMB-2 to CMB-5.
    Map(InputMapping, Value),
    /// NUM-2 of a sum of products, not saturated.
    Sum(Pairs),
    /// NUM-2 of a product of two bytes.
    Bytes(Value, Value),
    /// NUM-2 of a difference of two products.
    Difference([Value; 4]),
    /// CMB-8 of two vectors that are still to be expanded (CMB-3), read as unsigned.
    UnsignedDot([Value; 6]),
    /// CMB-9 and NUM-3.
    Output(Bias, Scale, Value),
    /// CMB-10: by the first; the second where it takes CD, otherwise the third.
    Select(MuxSelect, [Value; 3]),
    /// a + b.
    Add(Value, Value),
    /// a - b.
    Minus(Value, Value),
    /// The smaller.
    Least(Value, Value),
    /// The larger.
    Greatest(Value, Value),
    /// Limited to 0..=255.
    Clamp(Value),
    /// ROP-5: without so many low bits.
    Truncate(u32, Value),
    /// A byte as two's complement (ROP-3), negated if told so.
    Signed(bool, Value),
}

impl Node {
    /// The values that it is made of.
    pub(super) fn operands(&self) -> Vec<Value> {
        match self {
            Node::Constant(_) | Node::Input(_) => Vec::new(),
            Node::Map(_, v) | Node::Output(_, _, v) | Node::Clamp(v) | Node::Truncate(_, v) | Node::Signed(_, v) => {
                vec![*v]
            }
            Node::Sum(pairs) => pairs.values[..2 * pairs.count].to_vec(),
            Node::Difference(v) => v.to_vec(),
            Node::UnsignedDot(v) => v.to_vec(),
            Node::Select(_, v) => v.to_vec(),
            Node::Bytes(a, b) | Node::Add(a, b) | Node::Minus(a, b) | Node::Least(a, b) | Node::Greatest(a, b) => {
                vec![*a, *b]
            }
        }
    }

    /// The same of other values.
    pub(super) fn renamed(self, name: impl Fn(Value) -> Value) -> Node {
        match self {
            Node::Constant(_) | Node::Input(_) => self,
            Node::Map(mapping, v) => Node::Map(mapping, name(v)),
            Node::Sum(mut pairs) => {
                for value in &mut pairs.values[..2 * pairs.count] {
                    *value = name(*value);
                }
                Node::Sum(pairs)
            }
            Node::Difference(v) => Node::Difference(v.map(name)),
            Node::UnsignedDot(v) => Node::UnsignedDot(v.map(name)),
            Node::Output(bias, scale, v) => Node::Output(bias, scale, name(v)),
            Node::Select(mux, v) => Node::Select(mux, v.map(name)),
            Node::Bytes(a, b) => Node::Bytes(name(a), name(b)),
            Node::Add(a, b) => Node::Add(name(a), name(b)),
            Node::Minus(a, b) => Node::Minus(name(a), name(b)),
            Node::Least(a, b) => Node::Least(name(a), name(b)),
            Node::Greatest(a, b) => Node::Greatest(name(a), name(b)),
            Node::Clamp(v) => Node::Clamp(name(v)),
            Node::Truncate(bits, v) => Node::Truncate(bits, name(v)),
            Node::Signed(negated, v) => Node::Signed(negated, name(v)),
        }
    }
}

/// Least and largest.
type Range = (i16, i16);

/// Values, each made of earlier ones.
#[derive(Debug, Default)]
pub(super) struct Graph {
    nodes: Vec<(Node, Range)>,
    known: HashMap<Node, Value>,
}

impl Graph {
    /// How a value comes about.
    pub(super) fn node(&self, value: Value) -> Node {
        self.nodes[usize::from(value.0)].0
    }

    fn range(&self, value: Value) -> Range {
        self.nodes[usize::from(value.0)].1
    }

    /// The value, if it is the same in every pixel.
    fn known_constant(&self, value: Value) -> Option<i16> {
        let (low, high) = self.range(value);
        (low == high).then_some(low)
    }

    /// Whether a value is this constant.
    fn is(&self, value: Value, constant: i16) -> bool {
        self.known_constant(value) == Some(constant)
    }

    pub(super) fn constant(&mut self, value: i16) -> Value {
        self.add(Node::Constant(value), (value, value))
    }

    /// A given value of this range.
    pub(super) fn input(&mut self, input: Input, range: Range) -> Value {
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

    /// CMB-2 to CMB-5.
    pub(super) fn map(&mut self, mapping: InputMapping, v: Value) -> Value {
        let (low, high) = self.range(v);
        match mapping {
            InputMapping::SignedIdentity => return v,
            InputMapping::UnsignedIdentity if low >= 0 => return v,
            InputMapping::UnsignedIdentity => {
                if let Some(dot) = self.unsigned_dot(v) {
                    return dot;
                }
            }
            _ => {}
        }
        // Every mapping is monotone.
        let ends = [kernels::mapped(mapping, low), kernels::mapped(mapping, high)];
        self.add(Node::Map(mapping, v), (ends[0].min(ends[1]), ends[0].max(ends[1])))
    }

    /// A dot product of expanded vectors, of which only what is not negative is read.
    fn unsigned_dot(&mut self, v: Value) -> Option<Value> {
        let Node::Output(Bias::None, Scale::One, sum) = self.node(v) else { return None };
        let Node::Sum(pairs) = self.node(sum) else { return None };
        let mut vectors = [Value(0); 6];
        for (vector, factor) in vectors.iter_mut().zip(&pairs.values) {
            let Node::Map(InputMapping::ExpandNormal, unexpanded) = self.node(*factor) else { return None };
            *vector = unexpanded;
        }
        (pairs.count == 3).then(|| self.add(Node::UnsignedDot(vectors), (0, 255)))
    }

    /// NUM-2 of the sum of products.
    pub(super) fn sum(&mut self, pairs: &[(Value, Value)]) -> Value {
        let mut left: Vec<(Value, Value)> = Vec::with_capacity(pairs.len());
        left.extend(pairs.iter().filter(|(a, b)| !self.is(*a, 0) && !self.is(*b, 0)));
        match left[..] {
            [] => return self.constant(0),
            [one] => {
                if let Some(v) = self.times_one(one) {
                    return v;
                }
                let (a, b) = (one.0.min(one.1), one.0.max(one.1));
                let bytes = [a, b].into_iter().all(|v| self.range(v).0 >= 0 && self.range(v).1 <= 255);
                if bytes {
                    let ends = self.product_range(a, b);
                    return self.add(Node::Bytes(a, b), (kernels::rounded(ends.0), kernels::rounded(ends.1)));
                }
            }
            [one, other] => {
                if let (Some(a), Some(b)) = (self.times_one(one), self.times_one(other)) {
                    return self.plus(a, b);
                }
            }
            _ => {}
        }
        let (mut low, mut high) = (0, 0);
        for (a, b) in &left {
            let ends = self.product_range(*a, *b);
            (low, high) = (low + ends.0, high + ends.1);
        }
        let mut values = [Value(0); 2 * MOST];
        for (n, (a, b)) in left.iter().enumerate() {
            (values[2 * n], values[2 * n + 1]) = (*a.min(b), *a.max(b));
        }
        let node = Node::Sum(Pairs { count: left.len(), values });
        self.add(node, (kernels::rounded(low), kernels::rounded(high)))
    }

    /// The other factor where one is 1.0: 255 a, divided by 255, loses nothing.
    fn times_one(&self, (a, b): (Value, Value)) -> Option<Value> {
        if self.is(a, 255) { Some(b) } else { self.is(b, 255).then_some(a) }
    }

    fn product_range(&self, a: Value, b: Value) -> (i32, i32) {
        let ((a0, a1), (b0, b1)) = (self.range(a), self.range(b));
        let of = |a: i16, b: i16| i32::from(a) * i32::from(b);
        let all = [of(a0, b0), of(a0, b1), of(a1, b0), of(a1, b1)];
        (all.into_iter().fold(i32::MAX, i32::min), all.into_iter().fold(i32::MIN, i32::max))
    }

    /// NUM-2 of a b - c d.
    pub(super) fn difference(&mut self, [a, b, c, d]: [Value; 4]) -> Value {
        if self.is(c, 0) || self.is(d, 0) {
            return self.sum(&[(a, b)]);
        }
        if let (Some(first), Some(second)) = (self.times_one((a, b)), self.times_one((c, d))) {
            let (x, y) = (self.range(first), self.range(second));
            return self.add(Node::Minus(first, second), (x.0 - y.1, x.1 - y.0));
        }
        let (first, second) = (self.product_range(a, b), self.product_range(c, d));
        let range = (kernels::rounded(first.0 - second.1), kernels::rounded(first.1 - second.0));
        self.add(Node::Difference([a, b, c, d]), range)
    }

    /// CMB-9 and NUM-3.
    pub(super) fn output(&mut self, bias: Bias, scale: Scale, v: Value) -> Value {
        let (low, high) = self.range(v);
        let plain = bias == Bias::None && scale == Scale::One;
        if plain && low >= -256 && high <= 255 {
            return v;
        }
        let range = (kernels::finished(low, bias, scale), kernels::finished(high, bias, scale));
        self.add(Node::Output(bias, scale, v), range)
    }

    /// CMB-10.
    pub(super) fn select(&mut self, mux: MuxSelect, by: Value, cd: Value, ab: Value) -> Value {
        if ab == cd {
            return ab;
        }
        if let Some(by) = self.known_constant(by) {
            return if kernels::takes_cd(by, mux) { cd } else { ab };
        }
        let (c, a) = (self.range(cd), self.range(ab));
        self.add(Node::Select(mux, [by, cd, ab]), (c.0.min(a.0), c.1.max(a.1)))
    }

    pub(super) fn plus(&mut self, a: Value, b: Value) -> Value {
        match (self.known_constant(a), self.known_constant(b)) {
            (Some(0), _) => b,
            (_, Some(0)) => a,
            _ => {
                let (x, y) = (self.range(a), self.range(b));
                self.add(Node::Add(a.min(b), a.max(b)), (x.0 + y.0, x.1 + y.1))
            }
        }
    }

    pub(super) fn least(&mut self, a: Value, b: Value) -> Value {
        let (x, y) = (self.range(a), self.range(b));
        if x.1 <= y.0 {
            a
        } else if y.1 <= x.0 {
            b
        } else {
            self.add(Node::Least(a, b), (x.0.min(y.0), x.1.min(y.1)))
        }
    }

    pub(super) fn greatest(&mut self, a: Value, b: Value) -> Value {
        let (x, y) = (self.range(a), self.range(b));
        if x.0 >= y.1 {
            a
        } else if y.0 >= x.1 {
            b
        } else {
            self.add(Node::Greatest(a, b), (x.0.max(y.0), x.1.max(y.1)))
        }
    }

    pub(super) fn clamp(&mut self, v: Value) -> Value {
        let (low, high) = self.range(v);
        if low >= 0 && high <= 255 {
            return v;
        }
        self.add(Node::Clamp(v), (low.clamp(0, 255), high.clamp(0, 255)))
    }

    pub(super) fn truncate(&mut self, bits: u32, v: Value) -> Value {
        if bits == 0 {
            return v;
        }
        let (low, high) = self.range(v);
        self.add(Node::Truncate(bits, v), (low >> bits << bits, high >> bits << bits))
    }

    /// ROP-3: a byte as two's complement.
    pub(super) fn signed(&mut self, negated: bool, v: Value) -> Value {
        self.add(Node::Signed(negated, v), (-128, 128))
    }
}
