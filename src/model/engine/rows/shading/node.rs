//! The values of a graph, and how each of them is computed.

use crate::state::{
    Bias, ExpandCentre, HalfBiasConstant, InputMapping, MuxNegative, MuxSelect, Policies, RegisterFloor, Scale,
};

/// Number of a value in the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Value(pub(crate) u16);

/// An input of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Input {
    /// A channel of the interpolated diffuse colour.
    Primary(usize),
    /// A channel of the interpolated specular colour.
    Secondary(usize),
    /// The fog factor.
    Fog,
    /// A channel of a texture unit's result.
    Texture(usize, usize),
    /// A channel of the destination colour.
    Destination(usize),
}

/// Largest number of products in a sum: two dot products.
pub(crate) const MAX_PRODUCTS: usize = 6;

/// Pairs of factors whose products are added.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Pairs {
    /// Number of pairs.
    pub(crate) count: usize,
    /// First and second factor of each pair in turn; zeros past the end.
    pub(crate) values: [Value; 2 * MAX_PRODUCTS],
}

impl Pairs {
    pub(crate) fn new(pairs: &[(Value, Value)]) -> Pairs {
        let mut values = [Value(0); 2 * MAX_PRODUCTS];
        for (n, (a, b)) in pairs.iter().enumerate() {
            (values[2 * n], values[2 * n + 1]) = (*a.min(b), *a.max(b));
        }
        Pairs { count: pairs.len(), values }
    }
}

/// A mapping with the policies that concern it. Other policies have their defaults.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Mapping {
    /// CMB-2 to CMB-5.
    pub(crate) of: InputMapping,
    /// CMB-3: the centre of the expand mappings.
    pub(crate) centre: ExpandCentre,
    /// CMB-4. With 127.5 the mapping yields halves.
    pub(crate) half: HalfBiasConstant,
}

impl Mapping {
    /// Returns a mapping that no policy concerns.
    pub(crate) fn plain(of: InputMapping) -> Mapping {
        Mapping { of, centre: ExpandCentre::Centred, half: HalfBiasConstant::Half128 }
    }

    pub(crate) fn new(of: InputMapping, policies: &Policies) -> Mapping {
        let plain = Mapping::plain(of);
        match of {
            InputMapping::ExpandNormal | InputMapping::ExpandNegate => {
                Mapping { centre: policies.expand_centre, ..plain }
            }
            InputMapping::HalfBiasNormal | InputMapping::HalfBiasNegate => {
                Mapping { half: policies.half_bias, ..plain }
            }
            _ => plain,
        }
    }
}

/// The mux, with its policy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Mux(pub(crate) MuxSelect, pub(crate) MuxNegative);

/// How a value is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Node {
    /// The same value in every pixel.
    Constant(i16),
    /// An input of the pixel.
    Input(Input),
    /// CMB-2 to CMB-5.
    Map(Mapping, Value),
    /// NUM-2 of a sum of products, not saturated.
    Sum(Pairs),
    /// NUM-2 of a sum of products of halves (CMB-4=127.5).
    HalfSum(Pairs),
    /// CMB-9=after of a sum of products, not saturated. The flag tells whether factors are in halves.
    After(Bias, Scale, bool, Pairs),
    /// NUM-2 of a product of two bytes.
    Bytes([Value; 2]),
    /// NUM-2 of a sum of two products of bytes, at most 255.
    ByteSum([Value; 4]),
    /// NUM-2 of a difference of two products.
    Difference([Value; 4]),
    /// CMB-8 of two vectors that are expanded first (CMB-3), read as unsigned.
    UnsignedDot([Value; 6]),
    /// CMB-9, not saturated.
    Scaled(Bias, Scale, Value),
    /// CMB-9 and NUM-3.
    Output(Bias, Scale, RegisterFloor, Value),
    /// CMB-10: the first value decides between CD, the second, and AB, the third.
    Select(Mux, [Value; 3]),
    /// a + b.
    Add([Value; 2]),
    /// a - b.
    Minus([Value; 2]),
    /// The smaller of two values.
    Least([Value; 2]),
    /// The larger of two values.
    Greatest([Value; 2]),
    /// Limited to 0..=255.
    Clamp(Value),
    /// ROP-5: clears so many low bits.
    Truncate(u32, Value),
    /// A byte as two's complement (ROP-3).
    Signed(Value),
    /// TEX-19: channel 0, 1 or 2 of a colour, of Y, Cb and Cr.
    Converted(usize, [Value; 3]),
}

impl Node {
    /// Returns the values that it is computed from.
    pub(crate) fn operands(&mut self) -> &mut [Value] {
        match self {
            Node::Constant(_) | Node::Input(_) => &mut [],
            Node::Map(_, v)
            | Node::Scaled(_, _, v)
            | Node::Output(_, _, _, v)
            | Node::Clamp(v)
            | Node::Truncate(_, v)
            | Node::Signed(v) => std::slice::from_mut(v),
            Node::Sum(pairs) | Node::HalfSum(pairs) | Node::After(_, _, _, pairs) => {
                &mut pairs.values[..2 * pairs.count]
            }
            Node::Bytes(v) | Node::Add(v) | Node::Minus(v) | Node::Least(v) | Node::Greatest(v) => v,
            Node::ByteSum(v) | Node::Difference(v) => v,
            Node::UnsignedDot(v) => v,
            Node::Select(_, v) | Node::Converted(_, v) => v,
        }
    }

    /// Returns the node with its values renamed.
    pub(crate) fn renamed(mut self, name: impl Fn(Value) -> Value) -> Node {
        for value in self.operands() {
            *value = name(*value);
        }
        self
    }
}
