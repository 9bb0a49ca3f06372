//! Helpers: functions that a printed text calls. Each is a piece of the rules, which the model computes and the printer reads.

use ninebit::number::{Integer, newton_root, round_bits, shift, split_bits};
use ninebit::raster::binary::Binary;
use ninebit::raster::depth;
use ninebit::raster::interpolate::{FARTHEST, across_face, divided, ratio_coordinate};
use ninebit::raster::stroke::sprite_coordinate;
use ninebit::raster::weights::Number as _;
use ninebit::texture::{lod, shader, single};

use crate::input::Local;
use crate::kind::{ANY_BINARY, COORDINATE, EXPONENT, Kind, MANTISSA, NORMAL, Range, packed, unpacked};

/// Whether numbers can be negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Sign {
    /// None is, as where a pixel is covered.
    Positive,
    /// Some may be.
    Any,
}

/// A helper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Helper {
    /// A number times a power of two.
    Shifted,
    /// An edge function to 24 bits.
    Cut(Sign),
    /// A product to 24 bits.
    Product(Sign),
    /// The product of a number and a reciprocal to 24 bits.
    Share(Sign),
    /// The sum of three edge numbers.
    Sum(Sign),
    /// The reciprocal of such a sum.
    Reciprocal(Sign),
    /// 1 less two weights.
    Rest(Sign),
    /// The binary exponent of a positive number.
    Exponent,
    /// The number between those of three vertices, and whether weights can be negative.
    Linear(Sign),
    /// The depth between those of three vertices: three products.
    Depth,
    /// A floor of a number times a size.
    Floor,
    /// The same for distant numbers.
    FarFloor,
    /// The quotient of two numbers to 24 bits.
    Quotient,
    /// A coordinate s/q, by the quotient.
    Ratio,
    /// A coordinate on a face, by a quotient.
    Face,
    /// The same for distant numbers.
    FarFace,
    /// The level of detail of a quad.
    Level,
    /// A binary32 number, of which bits are given.
    Split,
    /// The binary32 number nearest to a number.
    Rounded,
    /// A product of binary32 numbers.
    SingleProduct,
    /// A sum of binary32 numbers.
    SingleSum,
    /// The aligned sum of three binary32 numbers.
    AlignedSum,
    /// A quotient of whole numbers in binary32.
    SingleQuotient,
    /// A displaced coordinate.
    Moved,
    /// A binary32 number as a coordinate.
    Float,
    /// The same for distant numbers.
    FarFloat,
    /// A channel times a luminance.
    Luminance,
    /// A place in a point.
    Sprite,
    /// 1 less two weights of a w buffer.
    CutRest,
    /// The root of a whole number.
    Root,
}

/// A parameter or a result.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Value<I> {
    Number(I),
    Binary(Binary<I>),
}

/// What a parameter may be.
const BINARY: (Kind, Range) = (Kind::Binary, ANY_BINARY);

const fn number(low: i64, high: i64) -> (Kind, Range) {
    (Kind::Number, (low, high))
}

/// Twice the largest size of an image (TEX-20), and the one of coordinates in texels.
const SIZE: (Kind, Range) = number(1, 8192);

/// The bits of a binary32 number.
const BITS: (Kind, Range) = number(0, u32::MAX as i64);

/// Numbers of up to 62 bits.
const WIDE: (Kind, Range) = number(-(1 << 62), 1 << 62);

/// Limits of quads: distant coordinates, with half an image.
const FAR: i64 = FARTHEST + (1 << 32);

impl Helper {
    /// All helpers, in the order of the variants.
    pub(crate) const ALL: [Helper; 37] = [
        Helper::Shifted,
        Helper::Cut(Sign::Positive),
        Helper::Product(Sign::Positive),
        Helper::Share(Sign::Positive),
        Helper::Sum(Sign::Positive),
        Helper::Reciprocal(Sign::Positive),
        Helper::Rest(Sign::Positive),
        Helper::Cut(Sign::Any),
        Helper::Product(Sign::Any),
        Helper::Share(Sign::Any),
        Helper::Sum(Sign::Any),
        Helper::Reciprocal(Sign::Any),
        Helper::Rest(Sign::Any),
        Helper::Exponent,
        Helper::Linear(Sign::Positive),
        Helper::Linear(Sign::Any),
        Helper::Depth,
        Helper::Floor,
        Helper::FarFloor,
        Helper::Quotient,
        Helper::Ratio,
        Helper::Face,
        Helper::FarFace,
        Helper::Level,
        Helper::Split,
        Helper::Rounded,
        Helper::SingleProduct,
        Helper::SingleSum,
        Helper::AlignedSum,
        Helper::SingleQuotient,
        Helper::Moved,
        Helper::Float,
        Helper::FarFloat,
        Helper::Luminance,
        Helper::Sprite,
        Helper::CutRest,
        Helper::Root,
    ];

    /// Returns the name in printed text, without its prefix; what it is; the rules.
    pub(crate) fn about(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Helper::Shifted => ("shifted", "floor(n 2^by), for -63 to 63; less or more is as these", "WGT-1"),
            Helper::Cut(Sign::Positive) => ("cut", "n to its first 24 bits", "WGT-1"),
            Helper::Cut(Sign::Any) => ("signed_cut", "n to its first 24 bits", "WGT-1"),
            Helper::Product(Sign::Positive) => ("product", "a b to its first 24 bits", "WGT-1"),
            Helper::Product(Sign::Any) => ("signed_product", "a b to its first 24 bits", "WGT-1"),
            Helper::Share(sign) => {
                let name = if sign == Sign::Any { "signed_share" } else { "share" };
                (name, "a b, of which b has 29 bits, to its first 24 bits", "WGT-1")
            }
            Helper::Sum(sign) => {
                let name = if sign == Sign::Any { "signed_sum" } else { "sum" };
                (name, "a + b + c, each to the 29th bit of the largest; not 0", "WGT-1")
            }
            Helper::Reciprocal(sign) => {
                let name = if sign == Sign::Any { "signed_reciprocal" } else { "reciprocal" };
                (name, "1 / a by two steps of Newton's method, cut to 29 bits", "WGT-1")
            }
            Helper::Rest(Sign::Positive) => ("rest", "1 - a - b, rounded up to 24 bits", "WGT-1"),
            Helper::Rest(Sign::Any) => ("signed_rest", "1 - a - b, rounded up to 24 bits", "WGT-1"),
            Helper::Exponent => ("exponent", "the binary exponent of a, if that is positive", "WGT-1"),
            Helper::Linear(sign) => {
                let name = if sign == Sign::Any { "signed_linear" } else { "linear" };
                (name, "a b + c + d e, each term to the 24th bit of the largest", "WGT-1")
            }
            Helper::Depth => ("depth", "a b + c d + e f, each term to the 29th bit of the largest", "DEP-1"),
            Helper::Floor => ("floored", "floor(size a 2^power), up to a limit", "INT-4"),
            Helper::FarFloor => ("far_floored", "floor(size a 2^power), up to a limit", "TEX-11"),
            Helper::Quotient => ("cut_quotient", "a / b by the reciprocal of b, to 24 bits; a if b is 0", "TEX-15"),
            Helper::Ratio => ("ratio", "floor(size a 2^8), up to a limit; the limit if b is 0", "TEX-15"),
            Helper::Face => ("face", "floor(2^7 size (1 + a)); 0 if b is not positive", "TEX-12"),
            Helper::FarFace => ("far_face", "floor(2^15 size (1 + a)); 0 if b is not positive", "TEX-11, TEX-12"),
            Helper::Level => {
                ("level", "floor(256 log2) of the larger distance from (a, b) to (c, d) or (e, f)", "TEX-10")
            }
            Helper::Split => ("split", "the binary32 number of these bits", "WGT-1"),
            Helper::Rounded => ("rounded", "the bits of the binary32 number nearest to n 2^exponent", "TSH-4"),
            Helper::SingleProduct => ("single_product", "a b of binary32 numbers, all as bits", "TSH-4"),
            Helper::SingleSum => ("single_sum", "a + b of binary32 numbers, all as bits", "TSH-4"),
            Helper::AlignedSum => {
                ("aligned_sum", "a + b + c of bits, each to the 24th bit of the largest, to its first 24 bits", "TSH-4")
            }
            Helper::SingleQuotient => ("single_quotient", "the bits of a / b in binary32", "TSH-1"),
            Helper::Moved => ("moved", "floor(size (a + offset / 128) 2^power), up to a limit", "TSH-7"),
            Helper::Float => ("float", "floor(size f 2^8), up to a limit; 0 for a NaN", "TSH-4"),
            Helper::FarFloat => ("far_float", "floor(size f 2^16), up to a limit; 0 for a NaN", "TSH-4, TEX-11"),
            Helper::Sprite => {
                ("sprite", "floor(2^power size (1/2 + d / 2 width)), late where right of the centre", "PNT-2")
            }
            Helper::CutRest => ("cut_rest", "1 - a - b to its first 24 bits", "DEP-6"),
            Helper::Root => ("root", "floor(sqrt(n))", "TEX-17"),
            Helper::Luminance => ("luminance", "floor(4096 c/255 (red/255 a + b)), up to 2^20", "TSH-8"),
        }
    }

    /// Returns kinds and ranges of the parameters.
    pub(crate) fn parameters(self) -> &'static [(Kind, Range)] {
        const EDGE: (Kind, Range) = number(-(1 << 54), 1 << 54);
        const COVERED: (Kind, Range) = number(0, 1 << 54);
        const COORDINATE: (Kind, Range) = number(-FAR, FAR);
        const FLOOR: [(Kind, Range); 4] = [BINARY, SIZE, number(0, 16), number(0, 1 << 24)];
        const FAR_FLOOR: [(Kind, Range); 4] = [BINARY, SIZE, number(0, 16), number(0, FARTHEST)];
        const QUOTIENT: [(Kind, Range); 2] = [number(-(1 << 16), 1 << 16), number(1, 1 << 30)];
        const MOVED: [(Kind, Range); 5] = [BINARY, BITS, SIZE, number(0, 16), number(0, FARTHEST)];
        const SHIFTED: [(Kind, Range); 2] = [WIDE, number(-(1 << 17), 1 << 17)];
        const ROUNDED: [(Kind, Range); 2] = [WIDE, (Kind::Number, EXPONENT)];
        const ROOT: [(Kind, Range); 1] = [number(0, 1 << 60)];
        const SPRITE: [(Kind, Range); 4] = [number(-(1 << 17), 1 << 17), number(0, 511), SIZE, number(0, 16)];
        const LUMINANCE: [(Kind, Range); 4] = [number(-256, 255), number(0, 255), BINARY, BINARY];
        match self {
            Helper::Cut(Sign::Positive) => &[COVERED],
            Helper::Cut(Sign::Any) => &[EDGE],
            Helper::Product(_) | Helper::Share(_) | Helper::Rest(_) | Helper::CutRest | Helper::Quotient => {
                &[BINARY; 2]
            }
            Helper::Sum(_) => &[BINARY; 3],
            Helper::Reciprocal(_) | Helper::Exponent => &[BINARY],
            Helper::Linear(_) => &[BINARY; 5],
            Helper::Depth => &[BINARY; 6],
            Helper::Floor => &FLOOR,
            Helper::FarFloor => &FAR_FLOOR,
            Helper::Ratio | Helper::Face | Helper::FarFace => &[BINARY, BINARY, SIZE],
            Helper::Level => &[COORDINATE; 6],
            Helper::Shifted => &SHIFTED,
            Helper::Split => &[BITS],
            Helper::Rounded => &ROUNDED,
            Helper::SingleProduct | Helper::SingleSum => &[BITS; 2],
            Helper::AlignedSum => &[BITS; 3],
            Helper::SingleQuotient => &QUOTIENT,
            Helper::Moved => &MOVED,
            Helper::Float | Helper::FarFloat => &[BITS, SIZE],
            Helper::Luminance => &LUMINANCE,
            Helper::Sprite => &SPRITE,
            Helper::Root => &ROOT,
        }
    }

    /// Returns the kind of the result.
    pub(crate) fn kind(self) -> Kind {
        match self.range() {
            ANY_BINARY => Kind::Binary,
            _ => Kind::Number,
        }
    }

    /// Returns the range of the result.
    pub(crate) fn range(self) -> Range {
        match self {
            Helper::Exponent => EXPONENT,
            Helper::Floor | Helper::Ratio | Helper::Face | Helper::Float => (-(1 << 24), 1 << 24),
            Helper::FarFloor | Helper::Moved | Helper::FarFloat => (-FARTHEST, FARTHEST),
            Helper::FarFace => (-FAR, FAR),
            Helper::Level => (lod::LEAST.into(), 1 << 15),
            Helper::Rounded
            | Helper::SingleProduct
            | Helper::SingleSum
            | Helper::AlignedSum
            | Helper::SingleQuotient => BITS.1,
            Helper::Shifted => WIDE.1,
            Helper::Luminance => (0, 1 << 20),
            Helper::Sprite => (-(1 << 48), 1 << 48),
            Helper::Root => (0, 1 << 30),
            _ => ANY_BINARY,
        }
    }

    /// Reads the rule in whole numbers of any type.
    pub(crate) fn read<I: Integer>(self, given: &[Value<I>]) -> Value<I> {
        let a = |at: usize| match given[at] {
            Value::Binary(binary) => binary,
            Value::Number(number) => Binary::whole(number),
        };
        let n = |at: usize| a(at).mantissa;
        Value::Binary(match self {
            Helper::Cut(_) => a(0).cut(),
            Helper::Product(_) => a(0).product::<24>(a(1)),
            Helper::Share(_) => a(0).product::<29>(a(1)),
            Helper::Sum(Sign::Positive) => Binary::sum_of_edges::<true>([a(0), a(1), a(2)]),
            Helper::Sum(Sign::Any) => Binary::sum_of_edges::<false>([a(0), a(1), a(2)]),
            Helper::Reciprocal(Sign::Positive) => a(0).reciprocal::<true>(),
            Helper::Reciprocal(Sign::Any) => a(0).reciprocal::<false>(),
            Helper::Rest(Sign::Positive) => Binary::rest::<true>(a(0), a(1)),
            Helper::Rest(Sign::Any) => Binary::rest::<false>(a(0), a(1)),
            Helper::Linear(sign) => {
                let weight = |at: usize| match (sign, a(at)) {
                    (Sign::Any, weight) => weight,
                    (Sign::Positive, Binary { mantissa, exponent }) => {
                        Binary { mantissa: mantissa.within(0, 1 << 24), exponent }
                    }
                };
                Binary::linear(a(2), [[weight(0), a(1)], [weight(3), a(4)]])
            }
            Helper::Depth => Binary::sum_of_products([[a(0), a(1)], [a(2), a(3)], [a(4), a(5)]]),
            Helper::Split => {
                let (mantissa, exponent) = split_bits(n(0));
                Binary { mantissa, exponent }
            }
            Helper::Shifted => return Value::Number(shift(n(0), n(1))),
            Helper::Rounded => return Value::Number(round_bits(n(0), n(1))),
            Helper::SingleProduct => return Value::Number(single::product(n(0), n(1))),
            Helper::SingleSum => return Value::Number(single::sum(n(0), n(1))),
            Helper::AlignedSum => return Value::Number(single::aligned_sum([n(0), n(1), n(2)])),
            Helper::SingleQuotient => return Value::Number(single::quotient(n(0), n(1))),
            Helper::Moved => return Value::Number(shader::moved(a(0), n(1), n(2), n(3), n(4))),
            Helper::Float => return Value::Number(shader::coordinate(n(0), n(1))),
            Helper::FarFloat => return Value::Number(shader::quad_coordinate(n(0), n(1))),
            Helper::Luminance => return Value::Number(shader::luminance(n(0), n(1), [a(2), a(3)])),
            Helper::Sprite => return Value::Number(sprite_coordinate(n(0), n(1), n(2), n(3))),
            Helper::CutRest => depth::cut_rest(a(0), a(1)),
            Helper::Root => return Value::Number(newton_root(n(0))),
            Helper::Exponent => return Value::Number(a(0).exponent::<false>()),
            Helper::Floor => return Value::Number(a(0).floored(n(1), n(2), n(3))),
            Helper::FarFloor => return Value::Number(a(0).far_floored(n(1), n(2), n(3))),
            Helper::Quotient => divided(a(0), a(1)),
            Helper::Ratio => return Value::Number(ratio_coordinate(a(0), a(1), n(2))),
            // On its own face a direction lies within it.
            Helper::Face => return Value::Number(across_face(a(0), a(1), n(2), 8).limited(0, 1 << 24)),
            Helper::FarFace => return Value::Number(across_face(a(0), a(1), n(2), 16)),
            Helper::Level => {
                return Value::Number(lod::log2_of_steps([[n(0), n(1)], [n(2), n(3)], [n(4), n(5)]]));
            }
        })
    }

    /// Computes the result from operands, of which binary numbers are packed.
    pub(crate) fn compute(self, operands: [i64; 6]) -> i64 {
        let given = self.parameters().iter().zip(operands).map(|((kind, _), value)| match kind {
            Kind::Binary => {
                let (mantissa, exponent) = unpacked(value);
                Value::Binary(Binary { mantissa, exponent })
            }
            _ => Value::Number(value),
        });
        match self.read(&given.collect::<Vec<_>>()) {
            Value::Number(number) => number,
            Value::Binary(Binary { mantissa, exponent }) => packed(mantissa, exponent),
        }
    }

    /// Returns the range of mantissas that the helper is given.
    pub(crate) fn mantissas(self) -> Range {
        match self {
            // The sum of edge numbers of a covered pixel is never 0.
            Helper::Reciprocal(Sign::Positive) => (1, i32::MAX.into()),
            Helper::Reciprocal(Sign::Any) => MANTISSA,
            Helper::Product(Sign::Positive) | Helper::Sum(Sign::Positive) | Helper::Rest(Sign::Positive) => {
                (0, NORMAL.1)
            }
            Helper::Share(Sign::Positive) => (0, 1 << 29),
            Helper::Share(Sign::Any) => (-(1 << 29), 1 << 29),
            Helper::Product(_) | Helper::Sum(_) | Helper::Rest(_) | Helper::CutRest => NORMAL,
            Helper::Linear(_) | Helper::Depth | Helper::Exponent => NORMAL,
            _ => COORDINATE,
        }
    }

    /// Returns a parameter of the printed function.
    pub(crate) fn parameter(self, at: usize, kind: Kind, range: Range) -> Local {
        let name = match (self, at) {
            (Helper::Cut(_) | Helper::Root, _) => "n",
            (Helper::Shifted, _) => ["n", "by"][at],
            (Helper::Rounded, _) => ["n", "exponent"][at],
            (Helper::Floor | Helper::FarFloor, 1..) => ["", "size", "power", "limit"][at],
            (Helper::Ratio | Helper::Face | Helper::FarFace, 2) => "size",
            (Helper::Moved, 1..) => ["", "offset", "size", "power", "limit"][at],
            (Helper::Float | Helper::FarFloat, _) => ["f", "size"][at],
            (Helper::Sprite, _) => ["d", "width", "size", "power"][at],
            (Helper::Luminance, 0 | 1) => ["c", "red"][at],
            (Helper::Luminance, _) => ["a", "b"][at - 2],
            _ => ["a", "b", "c", "d", "e", "f"][at],
        };
        Local { name, kind, range }
    }
}
