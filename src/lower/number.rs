//! A lane whose values are lines of [`Code`]: rules that are written over the traits of [`ninebit::number`] print themselves in it.

use std::ops::{Add, BitAnd, BitOr, Mul, Shl, Shr, Sub};

use ninebit::number::{self, Blend, Factor as _, Integer as _, Register};
use ninebit::state::{CompareFunction, RegisterFloor};

use crate::code::{Code, Operand, Operation, Range, Test, enclosing};

/// A number: a constant, or the result of a line of code.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Number<'a> {
    /// A constant, the same in every pixel.
    Constant(i64),
    /// The result of a line of the code.
    Of(&'a Code, u32),
}

use Number::Constant;

/// Implements operators of a type: the other operand's type, and how the result is made.
macro_rules! operators {
    ($($type:ident: $operator:ident $method:ident $other:ty, |$a:ident, $b:ident| $made:expr;)+) => {
        $(impl $operator<$other> for $type<'_> {
            type Output = Self;
            fn $method(self, $b: $other) -> Self {
                let $a = self;
                $made
            }
        })+
    };
}
operators! {
    Number: Add add Self, |a, b| a.made(&[b], Operation::Add(a.operand(), b.operand()));
    Number: Sub sub Self, |a, b| a.made(&[b], Operation::Subtract(a.operand(), b.operand()));
    Number: Mul mul Self, |a, b| a.multiplied(b);
    Sum: Add add Self, |a, b| a.combined(b, |a, b| a + b);
    Sum: Sub sub Self, |a, b| a.combined(b, |a, b| a - b);
    Word: BitAnd bitand Self, |a, b| a.with(b, Operation::And);
    Word: BitOr bitor Self, |a, b| a.with(b, Operation::Or);
    Word: Mul mul Self, |a, b| a.with(b, Operation::Times);
    Pair: Add add Self, |a, b| Pair(Word(a.0.with(b.0, Operation::Plus).0.within(0, u32::MAX.into())));
    Word: Shl shl u32, |a, bits| a.with(a, |a, _| Operation::Up(a, bits));
    Word: Shr shr u32, |a, bits| a.with(a, |a, _| Operation::Down(a, bits));
}

impl<'a> Number<'a> {
    pub(crate) fn new(code: &'a Code, operand: Operand) -> Number<'a> {
        match operand {
            Operand::Constant(value) => Constant(value),
            Operand::Line(line) => Number::Of(code, line),
        }
    }

    pub(crate) fn operand(self) -> Operand {
        match self {
            Constant(value) => Operand::Constant(value),
            Number::Of(_, line) => Operand::Line(line),
        }
    }

    pub(crate) fn code(self) -> Option<&'a Code> {
        match self {
            Constant(_) => None,
            Number::Of(code, _) => Some(code),
        }
    }

    pub(crate) fn range(self) -> Range {
        match self {
            Constant(value) => (value, value),
            Number::Of(code, line) => code.range(Operand::Line(line)),
        }
    }

    /// Narrows the range of a number that lies between others, because it is a mixture of them.
    pub(crate) fn between(self, others: &[Number<'a>]) -> Number<'a> {
        if let Number::Of(code, _) = self {
            code.narrow(self.operand(), enclosing(others.iter().map(|other| other.range())));
        }
        self
    }

    /// Makes an operation on this number and others. If none of them is a line, the result is computed.
    pub(crate) fn made(self, others: &[Number<'a>], operation: Operation) -> Number<'a> {
        let code = self.code().or_else(|| others.iter().find_map(|other| other.code()));
        match code {
            Some(code) => Number::new(code, code.make(operation)),
            // Constants alone do not need the caller's code.
            None => match Code::default().make(operation) {
                Operand::Constant(value) => Constant(value),
                Operand::Line(_) => Constant(0),
            },
        }
    }

    pub(crate) fn multiplied(self, other: Number<'a>) -> Number<'a> {
        self.made(&[other], Operation::Multiply(self.operand(), other.operand()))
    }

    pub(crate) fn least(self, other: Number<'a>) -> Number<'a> {
        self.made(&[other], Operation::Least(self.operand(), other.operand()))
    }

    pub(crate) fn greatest(self, other: Number<'a>) -> Number<'a> {
        self.made(&[other], Operation::Greatest(self.operand(), other.operand()))
    }

    pub(crate) fn limited(self, low: i64, high: i64) -> Number<'a> {
        self.least(Constant(high)).greatest(Constant(low))
    }

    /// Returns the floor of a quotient. Division requires a number that is not negative, so multiples of the divisor are added before and
    /// subtracted after.
    pub(crate) fn floor_divided(self, by: i64) -> Number<'a> {
        let above = (-self.range().0).max(0).div_euclid(by) + i64::from((-self.range().0).max(0) % by != 0);
        let positive = self + Constant(above * by);
        positive.made(&[], Operation::Quotient(positive.operand(), by)) - Constant(above)
    }

    /// Returns the low bits of the number in two's complement; `mask` says which.
    pub(crate) fn low_bits(self, mask: i64) -> Number<'a> {
        let period = 1 << (64 - mask.leading_zeros());
        let above = (-self.range().0).max(0);
        let positive = self + Constant((above + period - 1) / period * period);
        positive.made(&[], Operation::Bits(positive.operand(), mask))
    }

    /// Reads a number from 0 to 2^bits - 1 as two's complement.
    pub(crate) fn signed(self, bits: u32) -> Number<'a> {
        let sign = 1 << (bits - 1);
        self.made(&[], Operation::Flip(self.operand(), sign)) - Constant(sign)
    }

    /// Returns this number if the test holds, otherwise the other one.
    pub(crate) fn selected(self, test: Test, code: &'a Code, other: Number<'a>) -> Number<'a> {
        Number::new(code, code.make(Operation::Select(test, [self.operand(), other.operand()])))
    }

    /// Makes a comparison with another number.
    pub(crate) fn compared(self, function: CompareFunction, other: Number<'a>) -> Test {
        Test(function, [self.operand(), other.operand()])
    }

    /// Converts the number, which is not negative, into a word.
    pub(crate) fn word(self) -> Word<'a> {
        Word(self.made(&[], Operation::Word(self.operand())))
    }
}

impl<'a> Blend for Number<'a> {
    type Weight = Number<'a>;
    const WHOLE: Number<'a> = Constant(256);
    fn times(self, weight: Number<'a>) -> Number<'a> {
        self.multiplied(weight)
    }
    fn round8(self) -> Number<'a> {
        (self + Constant(128)).floor_divided(256)
    }
}

/// Two bytes of a word, 16 bits apart.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<'a>(pub(crate) Word<'a>);

impl<'a> Pair<'a> {
    /// Returns the lowest byte of each half.
    pub(crate) fn new(word: Word<'a>) -> Pair<'a> {
        Pair(word & Word::from(0x00ff_00ff))
    }
}

impl<'a> Blend for Pair<'a> {
    type Weight = Number<'a>;
    const WHOLE: Number<'a> = Constant(256);
    fn times(self, weight: Number<'a>) -> Pair<'a> {
        Pair(self.0 * weight.word())
    }
    fn round8(self) -> Pair<'a> {
        Pair::new((self + Pair(Word::from(0x0080_0080))).0 >> 8)
    }
}

/// A factor of a product: a number in steps of 1/255, or of half of that if `halves` (CMB-4=127.5).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factor<'a> {
    pub(crate) value: Number<'a>,
    pub(crate) halves: bool,
}

/// A sum of products, in steps of 1/65025 that are halved `halvings` times.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sum<'a> {
    pub(crate) value: Number<'a>,
    pub(crate) halvings: u32,
}

impl<'a> Sum<'a> {
    /// Returns both sums in the finer steps of the two.
    pub(crate) fn alike(self, other: Sum<'a>) -> [Sum<'a>; 2] {
        let halvings = self.halvings.max(other.halvings);
        [self, other].map(|sum| {
            let times = 1 << (halvings - sum.halvings);
            Sum { value: sum.value.multiplied(Constant(times)), halvings }
        })
    }

    fn combined(self, other: Sum<'a>, of: impl Fn(Number<'a>, Number<'a>) -> Number<'a>) -> Sum<'a> {
        let [a, b] = self.alike(other);
        Sum { value: of(a.value, b.value), halvings: a.halvings }
    }

    /// Rounds the sum divided by `more` by NUM-2: floor((2 n + d) / (2 d)) in steps of 1/d.
    pub(crate) fn rounded_to(self, more: i64) -> Number<'a> {
        let steps = (255 * more) << self.halvings;
        if let Some(whole) = over(self.value, steps) {
            return whole;
        }
        // With an even number of steps nothing needs to be doubled.
        if steps % 2 == 0 {
            return (self.value + Constant(steps / 2)).floor_divided(steps);
        }
        (self.value.multiplied(Constant(2)) + Constant(steps)).floor_divided(2 * steps)
    }
}

/// Returns the quotient of a number whose operation shows that it is a multiple of `steps`.
fn over(value: Number<'_>, steps: i64) -> Option<Number<'_>> {
    match value {
        Constant(value) => (value % steps == 0).then_some(Constant(value / steps)),
        Number::Of(code, line) => {
            let of = |operand| over(Number::new(code, operand), steps);
            match code.operation(Operand::Line(line))? {
                Operation::Multiply(Operand::Constant(by), x) if by % steps == 0 => {
                    Some(Number::new(code, x).multiplied(Constant(by / steps)))
                }
                Operation::Add(a, b) => Some(of(a)? + of(b)?),
                Operation::Subtract(a, b) => Some(of(a)? - of(b)?),
                _ => None,
            }
        }
    }
}

impl<'a> Register for Number<'a> {
    type Factor = Factor<'a>;
    type Expanded = Factor<'a>;
    const ZERO: Number<'a> = Constant(0);
    const ONE: Number<'a> = Constant(255);
    const HALF: Number<'a> = Constant(128);
    fn max0(self) -> Number<'a> {
        self.greatest(Constant(0))
    }
    fn factor(self) -> Factor<'a> {
        Factor { value: self, halves: false }
    }
    fn twice(self) -> Factor<'a> {
        self.multiplied(Constant(2)).factor()
    }
    fn halved(self) -> Number<'a> {
        (self + Constant(1)).floor_divided(2)
    }
    fn saturated(self, floor: RegisterFloor) -> Number<'a> {
        self.limited(if floor == RegisterFloor::Full { -256 } else { -255 }, 255)
    }
}

impl<'a> number::Factor for Factor<'a> {
    type Sum = Sum<'a>;
    type Register = Number<'a>;
    fn product(self, other: Factor<'a>) -> Sum<'a> {
        let halvings = u32::from(self.halves) + u32::from(other.halves);
        Sum { value: self.value.multiplied(other.value), halvings }
    }
}

impl<'a> number::Sum for Sum<'a> {
    type Register = Number<'a>;
    fn rounded(self) -> Number<'a> {
        self.rounded_to(1)
    }
}

/// Converts a register's value into steps of a sum.
pub(crate) fn widened(x: Number<'_>) -> Sum<'_> {
    x.factor().product(Constant(255).factor())
}

/// A word: the bits of a stored word or of a texel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Word<'a>(pub(crate) Number<'a>);

impl<'a> Word<'a> {
    /// Converts the word, which is below 2^31, into a number.
    pub(crate) fn number(self) -> Number<'a> {
        self.0.made(&[], Operation::Number(self.0.operand()))
    }

    fn with(self, other: Word<'a>, operation: impl Fn(Operand, Operand) -> Operation) -> Word<'a> {
        Word(self.0.made(&[other.0], operation(self.0.operand(), other.0.operand())))
    }
}

impl From<u32> for Word<'_> {
    fn from(value: u32) -> Self {
        Word(Constant(value.into()))
    }
}

impl number::Word for Word<'_> {}
