//! Operations: what a line of code computes, and of what.

use ninebit::raster::weights::difference;
use ninebit::state::CompareFunction;

use crate::helper::Helper;
use crate::input::Input;
use crate::kind::{Kind, packed, unpacked};

/// A value: a constant, or the result of an earlier line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operand {
    /// A constant, the same in every pixel.
    Constant(i64),
    /// The result of the line with this index.
    Line(u32),
}

impl Operand {
    /// Returns the index of the line that the value is the result of; `None` if it is a constant.
    pub(crate) fn line(self) -> Option<usize> {
        match self {
            Operand::Constant(_) => None,
            Operand::Line(line) => Some(line as usize),
        }
    }
}

/// A comparison of two numbers; the first operand is on the left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Test(pub CompareFunction, pub [Operand; 2]);

/// The operation of a line, which computes a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// A value that the caller gives.
    Input(Input),
    /// a + b.
    Add(Operand, Operand),
    /// a - b.
    Subtract(Operand, Operand),
    /// a times b.
    Multiply(Operand, Operand),
    /// The smaller of a and b.
    Least(Operand, Operand),
    /// The larger of a and b.
    Greatest(Operand, Operand),
    /// The whole part of a / b, where a is not negative and b is a constant.
    Quotient(Operand, i64),
    /// The bits of a that a constant mask has, where a is not negative.
    Bits(Operand, i64),
    /// a with one bit inverted, where a is not negative and less than twice that bit.
    Flip(Operand, i64),
    /// The first value if the test holds, otherwise the second.
    Select(Test, [Operand; 2]),
    /// A word below 2^31, as a number.
    Number(Operand),
    /// A number that is not negative, as a word.
    Word(Operand),
    /// Bitwise and of two words.
    And(Operand, Operand),
    /// Bitwise or of two words.
    Or(Operand, Operand),
    /// Product of two words, which is below 2^32.
    Times(Operand, Operand),
    /// Sum of two words, which is below 2^32.
    Plus(Operand, Operand),
    /// A word shifted right by a constant.
    Down(Operand, u32),
    /// A word shifted left by a constant; the result is below 2^32.
    Up(Operand, u32),
    /// The number of significant bits of a, which is not negative.
    Length(Operand),
    /// a times 2^b, for a b from 0 to 63. What does not fit is not used.
    Raise(Operand, Operand),
    /// The floor of a over 2^b, for a b from 0 to 63.
    Lower(Operand, Operand),
    /// The bits of a that a mask has, which is a power of two less 1.
    Mask(Operand, Operand),
    /// The whole part of a / b, where a is not negative and b is positive.
    Divide(Operand, Operand),
    /// Entry a of a table.
    Entry(Table, Operand),
    /// Word a of a unit's memory.
    Fetch(usize, Operand),
    /// The binary number a 2^b.
    Binary(Operand, Operand),
    /// The mantissa of a binary number.
    Mantissa(Operand),
    /// The exponent of a binary number.
    Exponent(Operand),
    /// The first binary number if the test holds, otherwise the second.
    Choose(Test, [Operand; 2]),
    /// What a helper makes of operands, of which it may take fewer.
    Call(Helper, [Operand; 6]),
    /// The difference of two binary32 numbers, all three as bits (WGT-1).
    Difference(Operand, Operand),
}

/// A table of bytes that the rules have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Table(pub &'static [u8]);

/// Collects the operands that `renamed` passes to the function it is given.
pub(crate) fn collected(renamed: impl FnOnce(&mut dyn FnMut(Operand) -> Operand)) -> Vec<Operand> {
    let mut operands = Vec::new();
    renamed(&mut |operand| {
        operands.push(operand);
        operand
    });
    operands
}

impl Operation {
    /// Returns the kind of the result.
    pub(crate) fn kind(&self) -> Kind {
        match self {
            Operation::Input(input) => input.kind(),
            Operation::Word(_)
            | Operation::And(..)
            | Operation::Or(..)
            | Operation::Times(..)
            | Operation::Plus(..)
            | Operation::Down(..)
            | Operation::Up(..)
            | Operation::Fetch(..)
            | Operation::Difference(..) => Kind::Word,
            Operation::Binary(..) | Operation::Choose(..) => Kind::Binary,
            Operation::Call(helper, _) => helper.kind(),
            _ => Kind::Number,
        }
    }

    /// Returns the kind of the operands.
    pub(crate) fn takes(&self) -> Kind {
        match self {
            Operation::Number(_) => Kind::Word,
            Operation::Word(_) | Operation::Fetch(..) | Operation::Binary(..) | Operation::Call(..) => Kind::Number,
            Operation::Mantissa(_) | Operation::Exponent(_) => Kind::Binary,
            _ => self.kind(),
        }
    }

    /// Returns the helper that the operation calls.
    pub(crate) fn helper(&self) -> Option<Helper> {
        if let Operation::Call(helper, _) = self { Some(*helper) } else { None }
    }

    /// Returns the table that the operation reads.
    pub(crate) fn table(&self) -> Option<Table> {
        if let Operation::Entry(table, _) = self { Some(*table) } else { None }
    }

    /// Returns the operands.
    pub(crate) fn operands(&self) -> Vec<Operand> {
        collected(|name| _ = self.renamed(name))
    }

    /// Returns the operation with each operand replaced by `name` of it.
    pub(crate) fn renamed(self, mut name: impl FnMut(Operand) -> Operand) -> Operation {
        match self {
            Operation::Input(_) => self,
            Operation::Add(a, b) => Operation::Add(name(a), name(b)),
            Operation::Subtract(a, b) => Operation::Subtract(name(a), name(b)),
            Operation::Multiply(a, b) => Operation::Multiply(name(a), name(b)),
            Operation::Least(a, b) => Operation::Least(name(a), name(b)),
            Operation::Greatest(a, b) => Operation::Greatest(name(a), name(b)),
            Operation::Quotient(a, by) => Operation::Quotient(name(a), by),
            Operation::Bits(a, mask) => Operation::Bits(name(a), mask),
            Operation::Flip(a, bit) => Operation::Flip(name(a), bit),
            Operation::Select(Test(function, operands), values) => {
                Operation::Select(Test(function, operands.map(&mut name)), values.map(name))
            }
            Operation::Number(a) => Operation::Number(name(a)),
            Operation::Word(a) => Operation::Word(name(a)),
            Operation::And(a, b) => Operation::And(name(a), name(b)),
            Operation::Or(a, b) => Operation::Or(name(a), name(b)),
            Operation::Times(a, b) => Operation::Times(name(a), name(b)),
            Operation::Plus(a, b) => Operation::Plus(name(a), name(b)),
            Operation::Down(a, bits) => Operation::Down(name(a), bits),
            Operation::Up(a, bits) => Operation::Up(name(a), bits),
            Operation::Length(a) => Operation::Length(name(a)),
            Operation::Raise(a, by) => Operation::Raise(name(a), name(by)),
            Operation::Lower(a, by) => Operation::Lower(name(a), name(by)),
            Operation::Mask(a, by) => Operation::Mask(name(a), name(by)),
            Operation::Divide(a, by) => Operation::Divide(name(a), name(by)),
            Operation::Entry(table, a) => Operation::Entry(table, name(a)),
            Operation::Fetch(unit, a) => Operation::Fetch(unit, name(a)),
            Operation::Binary(a, b) => Operation::Binary(name(a), name(b)),
            Operation::Mantissa(a) => Operation::Mantissa(name(a)),
            Operation::Exponent(a) => Operation::Exponent(name(a)),
            Operation::Choose(Test(function, operands), values) => {
                Operation::Choose(Test(function, operands.map(&mut name)), values.map(name))
            }
            Operation::Call(helper, mut operands) => {
                operands[..helper.parameters().len()].iter_mut().for_each(|operand| *operand = name(*operand));
                Operation::Call(helper, operands)
            }
            Operation::Difference(a, b) => Operation::Difference(name(a), name(b)),
        }
    }

    /// Computes the result from the values of the operands. The result of an input is 0, since the caller knows it.
    pub(crate) fn result(&self, value: impl Fn(Operand) -> i64) -> i64 {
        match *self {
            Operation::Input(_) | Operation::Fetch(..) => 0,
            Operation::Add(a, b) | Operation::Plus(a, b) => value(a) + value(b),
            Operation::Subtract(a, b) => value(a) - value(b),
            Operation::Multiply(a, b) | Operation::Times(a, b) => value(a) * value(b),
            Operation::Least(a, b) => value(a).min(value(b)),
            Operation::Greatest(a, b) => value(a).max(value(b)),
            Operation::Quotient(a, by) => value(a).div_euclid(by),
            Operation::Bits(a, mask) => value(a) & mask,
            Operation::Flip(a, bit) => value(a) ^ bit,
            Operation::Select(Test(function, [a, b]), [c, d]) | Operation::Choose(Test(function, [a, b]), [c, d]) => {
                value(if function.passes(value(a), value(b)) { c } else { d })
            }
            Operation::Number(a) | Operation::Word(a) => value(a),
            Operation::And(a, b) => value(a) & value(b),
            Operation::Or(a, b) => value(a) | value(b),
            Operation::Down(a, bits) => value(a) >> bits,
            Operation::Up(a, bits) => value(a) << bits,
            Operation::Length(a) => (64 - value(a).leading_zeros()).into(),
            Operation::Raise(a, by) => value(a) << value(by),
            Operation::Lower(a, by) => value(a) >> value(by),
            Operation::Mask(a, by) => value(a) & value(by),
            Operation::Divide(a, by) => value(a) / value(by),
            Operation::Entry(Table(table), a) => table[value(a) as usize].into(),
            Operation::Binary(a, b) => packed(value(a), value(b)),
            Operation::Mantissa(a) => unpacked(value(a)).0,
            Operation::Exponent(a) => unpacked(value(a)).1,
            Operation::Call(helper, operands) => helper.compute(operands.map(value)),
            Operation::Difference(a, b) => {
                let [a, b] = [a, b].map(|operand| f32::from_bits(value(operand) as u32));
                difference(a, b).to_bits().into()
            }
        }
    }
}
