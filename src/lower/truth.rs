//! Truths of comparisons, and [`Number`] as whole numbers of the model: rules over [`Integer`] print themselves.

use std::ops::{BitAnd, BitOr, BitXor, Not};

use ninebit::number::{Choice, Integer, newton_root, split_bits};
use ninebit::state::CompareFunction;

use crate::binary::counted;
use crate::body::parts;
use crate::code::{Code, NORMAL, Operand, Operation, Table, Test};
use crate::helper::Helper;
use crate::number::Number;

/// Truth of a comparison.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Truth<'a> {
    /// The same in every pixel.
    Known(bool),
    /// That of a test.
    Of(&'a Code, Test),
}

impl<'a> Truth<'a> {
    /// Returns the truth of a test.
    pub(crate) fn new(code: &'a Code, test: Test) -> Truth<'a> {
        code.decided(test).map_or(Truth::Of(code, test), Truth::Known)
    }

    /// Returns 1 where it is true, otherwise 0.
    pub(crate) fn number(self) -> Number<'a> {
        match self {
            Truth::Known(truth) => Number::Constant(truth.into()),
            // The number that the test asks for.
            Truth::Of(code, Test(CompareFunction::NotEqual, [flag, Operand::Constant(0)]))
                if code.range(flag) == (0, 1) =>
            {
                Number::new(code, flag)
            }
            Truth::Of(code, test) => {
                Number::new(code, code.make(Operation::Select(test, [1, 0].map(Operand::Constant))))
            }
        }
    }

    /// Returns the truth of a number that is 0 or 1.
    fn from_number(number: Number<'a>, code: &'a Code) -> Truth<'a> {
        Truth::new(code, Test(CompareFunction::NotEqual, [number.operand(), Operand::Constant(0)]))
    }

    /// Returns the test; `None` if it is the same in every pixel.
    pub(crate) fn test(self) -> Option<Test> {
        match self {
            Truth::Known(_) => None,
            Truth::Of(_, test) => Some(test),
        }
    }
}

impl<'a> Not for Truth<'a> {
    type Output = Truth<'a>;
    fn not(self) -> Truth<'a> {
        use CompareFunction::*;
        match self {
            Truth::Known(truth) => Truth::Known(!truth),
            Truth::Of(code, Test(function, operands)) => {
                let inverse = match function {
                    Never => Always,
                    Always => Never,
                    Less => GreaterOrEqual,
                    GreaterOrEqual => Less,
                    Greater => LessOrEqual,
                    LessOrEqual => Greater,
                    Equal => NotEqual,
                    NotEqual => Equal,
                };
                Truth::Of(code, Test(inverse, operands))
            }
        }
    }
}

impl<'a> BitAnd for Truth<'a> {
    type Output = Truth<'a>;
    fn bitand(self, other: Truth<'a>) -> Truth<'a> {
        match (self, other) {
            (Truth::Known(true), other) | (other, Truth::Known(true)) => other,
            (Truth::Known(false), _) | (_, Truth::Known(false)) => Truth::Known(false),
            (Truth::Of(code, test), other) => {
                let both = Operation::Select(test, [other.number().operand(), Operand::Constant(0)]);
                Truth::from_number(Number::new(code, code.make(both)), code)
            }
        }
    }
}

impl<'a> BitOr for Truth<'a> {
    type Output = Truth<'a>;
    fn bitor(self, other: Truth<'a>) -> Truth<'a> {
        match (self, other) {
            (Truth::Known(false), other) | (other, Truth::Known(false)) => other,
            (Truth::Known(true), _) | (_, Truth::Known(true)) => Truth::Known(true),
            (Truth::Of(code, test), other) => {
                let any = Operation::Select(test, [Operand::Constant(1), other.number().operand()]);
                Truth::from_number(Number::new(code, code.make(any)), code)
            }
        }
    }
}

impl<'a> BitXor for Truth<'a> {
    type Output = Truth<'a>;
    fn bitxor(self, other: Truth<'a>) -> Truth<'a> {
        match (self, other) {
            (Truth::Known(false), other) | (other, Truth::Known(false)) => other,
            (Truth::Known(true), other) | (other, Truth::Known(true)) => !other,
            (Truth::Of(code, _), _) => {
                let unequal = Test(CompareFunction::NotEqual, [self.number().operand(), other.number().operand()]);
                Truth::new(code, unequal)
            }
        }
    }
}

impl Choice for Truth<'_> {}

/// Returns the call of a helper that is part of a rule, whose lines it does not end.
fn called(helper: Helper, of: &[Number<'_>]) -> Operation {
    let mut operands = [Operand::Constant(0); 6];
    operands.iter_mut().zip(of).for_each(|(operand, number)| *operand = number.operand());
    Operation::Call(helper, operands)
}

impl<'a> Integer for Number<'a> {
    type Choice = Truth<'a>;

    fn new(value: i64) -> Number<'a> {
        Number::Constant(value)
    }
    fn bits(self) -> Number<'a> {
        let magnitude = self.magnitude();
        magnitude.made(&[], Operation::Length(magnitude.operand()))
    }
    fn up(self, by: Number<'a>) -> Number<'a> {
        self.made(&[by], Operation::Raise(self.operand(), by.operand()))
    }
    fn down(self, by: Number<'a>) -> Number<'a> {
        self.made(&[by], Operation::Lower(self.operand(), by.operand()))
    }
    fn masked(self, mask: i64) -> Number<'a> {
        // Bits that are not neighbours from the lowest up are rare.
        self.made(&[], Operation::Bits(self.operand(), mask))
    }
    fn modulo(self, by: Number<'a>) -> Number<'a> {
        match by {
            Number::Constant(by) if by & (by - 1) == 0 => self.masked(by - 1),
            Number::Constant(by) => self - self.floor_divided(by).multiplied(Number::Constant(by)),
            by if by.code().is_some_and(Code::allows_any_divisors) => {
                // As many multiples of the divisor as make any number positive.
                let multiples = by * Number::Constant((-self.range().0).max(0));
                let positive = (self + multiples).within(0, i64::MAX);
                (positive - positive.quotient(by) * by).within(0, by.range().1 - 1)
            }
            by => {
                let last = by - Number::Constant(1);
                let (most, code) = (last.range().1, last);
                code.made(&[self], Operation::Mask(self.operand(), last.operand())).within(0, most)
            }
        }
    }
    fn quotient(self, by: Number<'a>) -> Number<'a> {
        self.made(&[by], Operation::Divide(self.operand(), by.operand()))
    }
    fn compared(self, function: CompareFunction, other: Number<'a>) -> Truth<'a> {
        match (self.code().or(other.code()), self, other) {
            (Some(code), ..) => Truth::new(code, Test(function, [self.operand(), other.operand()])),
            (None, a, b) => Truth::Known(function.passes(a.range().0, b.range().0)),
        }
    }
    fn or(self, choice: Truth<'a>, other: Number<'a>) -> Number<'a> {
        match choice {
            Truth::Known(true) => self,
            Truth::Known(false) => other,
            Truth::Of(code, test) => self.selected(test, code, other),
        }
    }
    fn root(self) -> Number<'a> {
        match self.code() {
            Some(code) => counted(code, Helper::Root, &[self.operand()]),
            None => Number::Constant(newton_root(self.range().0)),
        }
    }
    fn shifted(self, by: Number<'a>) -> Number<'a> {
        self.made(&[by], called(Helper::Shifted, &[self, by]))
    }
    fn split(self) -> (Number<'a>, Number<'a>) {
        let Some(code) = self.code() else {
            let (mantissa, exponent) = split_bits(self.range().0);
            return (Number::Constant(mantissa), Number::Constant(exponent));
        };
        let parts = parts(code, code.make(called(Helper::Split, &[self])), NORMAL);
        (parts.mantissa, parts.exponent)
    }
    fn rounded(self, exponent: Number<'a>) -> Number<'a> {
        self.made(&[exponent], called(Helper::Rounded, &[self, exponent]))
    }
    fn entry(self, table: &'static [u8]) -> Number<'a> {
        self.made(&[], Operation::Entry(Table(table), self.operand()))
    }
    fn within(self, low: i64, high: i64) -> Number<'a> {
        if let Number::Of(code, _) = self {
            code.narrow_all(self.operand(), (low, high));
        }
        self
    }
    fn least(self, other: Number<'a>) -> Number<'a> {
        Number::least(self, other)
    }
    fn greatest(self, other: Number<'a>) -> Number<'a> {
        Number::greatest(self, other)
    }
    fn limited(self, low: i64, high: i64) -> Number<'a> {
        Number::limited(self, low, high)
    }
}
