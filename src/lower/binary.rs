//! Reads the rules of the interpolator as calls of [helpers](crate::helper).

use ninebit::number::Integer;
use ninebit::raster::binary::Binary;
use ninebit::raster::weights;

use crate::body::parts;
use crate::code::{ANY_BINARY, Code, Kind, Operand, Operation, Range};
use crate::helper::{Helper, Sign};
use crate::input::{Input, Local};
use crate::kind::MANTISSA;
use crate::number::Number;
use crate::truth::Truth;

/// A number of the interpolator.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Interpolant<'a> {
    /// A number that the text holds.
    Known(Binary),
    /// A whole number, as an edge function is.
    Whole(&'a Code, Operand, Sign),
    /// The result of a line.
    Of(&'a Code, Operand, Sign),
}

impl<'a> Interpolant<'a> {
    /// Returns a whole number.
    pub(crate) fn whole(code: &'a Code, number: Number<'a>) -> Interpolant<'a> {
        let sign = if number.range().0 < 0 { Sign::Any } else { Sign::Positive };
        Interpolant::Whole(code, number.operand(), sign)
    }

    /// Returns the result of a line, which may be negative.
    pub(crate) fn from_line(code: &'a Code, operand: Operand) -> Interpolant<'a> {
        Interpolant::Of(code, operand, Sign::Any)
    }

    /// Returns a parameter of a printed function.
    pub(crate) fn local(code: &'a Code, name: &'static str) -> Interpolant<'a> {
        let input = Input::Local(Local { name, kind: Kind::Binary, range: ANY_BINARY });
        Interpolant::from_line(code, code.input(input, ANY_BINARY))
    }

    fn sign(self) -> Sign {
        match self {
            Interpolant::Known(known) if known.mantissa >= 0 => Sign::Positive,
            Interpolant::Known(_) => Sign::Any,
            Interpolant::Whole(.., sign) | Interpolant::Of(.., sign) => sign,
        }
    }

    /// Returns the number 1.
    pub(crate) const ONE: Interpolant<'static> = Interpolant::Known(Binary::ONE);

    /// Returns the number as one value.
    pub(crate) fn operand(self, code: &Code) -> Operand {
        match self {
            Interpolant::Known(Binary { mantissa, exponent }) => {
                code.make(Operation::Binary(Operand::Constant(mantissa), Operand::Constant(exponent)))
            }
            Interpolant::Whole(_, number, _) => code.make(Operation::Binary(number, Operand::Constant(0))),
            Interpolant::Of(_, operand, _) => operand,
        }
    }

    /// Returns mantissa and exponent, for rules that are no helpers.
    pub(crate) fn parts(self, code: &'a Code, mantissas: Range) -> Binary<Number<'a>> {
        match self {
            Interpolant::Known(Binary { mantissa, exponent }) => {
                Binary { mantissa: Number::Constant(mantissa), exponent: Number::Constant(exponent) }
            }
            of => parts(code, of.operand(code), mantissas),
        }
    }

    /// Names the value.
    pub(crate) fn named(self, name: impl FnOnce() -> String) -> Interpolant<'a> {
        if let Interpolant::Of(code, operand, _) = self {
            code.name(operand, name);
        }
        self
    }

    /// Returns a number that the text holds.
    fn known(self) -> Binary {
        if let Interpolant::Known(known) = self { known } else { Binary::ONE }
    }

    fn code(self) -> Option<&'a Code> {
        match self {
            Interpolant::Known(_) => None,
            Interpolant::Whole(code, ..) | Interpolant::Of(code, ..) => Some(code),
        }
    }

    /// Returns what a helper makes of numbers. Of known ones it is known.
    fn of_helper(
        helper: impl Fn(Sign) -> Helper,
        of: &[Interpolant<'a>],
        known: impl FnOnce(&[Binary]) -> Binary,
    ) -> Interpolant<'a> {
        let sign = of.iter().map(|number| number.sign()).max().unwrap_or(Sign::Any);
        let code = of.iter().find_map(|number| number.code());
        match code {
            Some(code) => {
                let operands: Vec<Operand> = of.iter().map(|number| number.operand(code)).collect();
                Interpolant::Of(code, call(code, helper(sign), &operands), sign)
            }
            None => {
                let of: Vec<Binary> = of.iter().map(|number| number.known()).collect();
                Interpolant::Known(known(&of))
            }
        }
    }

    /// DEP-6: returns 1 less two weights, cut.
    pub(crate) fn cut_rest(code: &'a Code, a: Interpolant<'a>, b: Interpolant<'a>) -> Interpolant<'a> {
        Interpolant::from_line(code, call(code, Helper::CutRest, &[a.operand(code), b.operand(code)]))
    }
}

/// Calls a helper.
pub(crate) fn call(code: &Code, helper: Helper, of: &[Operand]) -> Operand {
    let mut operands = [Operand::Constant(0); 6];
    operands[..of.len()].copy_from_slice(of);
    code.by(helper.about().2);
    code.make(Operation::Call(helper, operands))
}

/// Calls a helper whose result is a number.
pub(crate) fn counted<'a>(code: &'a Code, helper: Helper, of: &[Operand]) -> Number<'a> {
    debug_assert_eq!(helper.kind(), Kind::Number);
    Number::new(code, call(code, helper, of))
}

impl<'a> weights::Number for Interpolant<'a> {
    type Exponent = Number<'a>;
    type Choice = Truth<'a>;

    fn one() -> Interpolant<'a> {
        Interpolant::ONE
    }
    fn from_edge(edge: i64) -> Interpolant<'a> {
        Interpolant::Known(Binary::whole(edge))
    }
    fn from_f32(number: f32) -> Interpolant<'a> {
        Interpolant::Known(Binary::new(number))
    }
    fn cut(self) -> Interpolant<'a> {
        match self {
            Interpolant::Whole(code, number, sign) => {
                Interpolant::Of(code, call(code, Helper::Cut(sign), &[number]), sign)
            }
            Interpolant::Known(known) => Interpolant::Known(weights::Number::cut(known)),
            Interpolant::Of(code, _, sign) => {
                let Binary { mantissa, exponent } = weights::Number::cut(self.parts(code, MANTISSA));
                Interpolant::Of(code, code.make(Operation::Binary(mantissa.operand(), exponent.operand())), sign)
            }
        }
    }
    fn product<const BITS: u32>(self, other: Interpolant<'a>) -> Interpolant<'a> {
        let helper = |sign| if BITS == 24 { Helper::Product(sign) } else { Helper::Share(sign) };
        Interpolant::of_helper(helper, &[self, other], |of| weights::Number::product::<BITS>(of[0], of[1]))
    }
    fn linear(number: Interpolant<'a>, [first, third]: [[Interpolant<'a>; 2]; 2]) -> Interpolant<'a> {
        let sign = first[0].sign().max(third[0].sign());
        Interpolant::of_helper(
            |_| Helper::Linear(sign),
            &[first[0], first[1], number, third[0], third[1]],
            |of| weights::Number::linear(of[2], [[of[0], of[1]], [of[3], of[4]]]),
        )
    }
    fn sum_of_products(factors: [[Interpolant<'a>; 2]; 3]) -> Interpolant<'a> {
        Interpolant::of_helper(
            |_| Helper::Depth,
            factors.as_flattened(),
            |of| Binary::sum_of_products([[of[0], of[1]], [of[2], of[3]], [of[4], of[5]]]),
        )
    }
    fn sum_of_edges<const COVERED: bool>(edges: [Interpolant<'a>; 3]) -> Interpolant<'a> {
        Interpolant::of_helper(Helper::Sum, &edges, |of| Binary::sum_of_edges::<COVERED>([of[0], of[1], of[2]]))
    }
    fn reciprocal<const COVERED: bool>(self) -> Interpolant<'a> {
        Interpolant::of_helper(Helper::Reciprocal, &[self], |of| of[0].reciprocal::<COVERED>())
    }
    fn rest<const COVERED: bool>(a: Interpolant<'a>, b: Interpolant<'a>) -> Interpolant<'a> {
        let sign = if COVERED { Sign::Positive } else { Sign::Any };
        Interpolant::of_helper(|_| Helper::Rest(sign), &[a, b], |of| Binary::rest::<COVERED>(of[0], of[1]))
    }
    fn exponent<const COVERED: bool>(self) -> Number<'a> {
        match self.code() {
            Some(code) if COVERED => Number::new(code, code.make(Operation::Exponent(self.operand(code)))),
            Some(code) => counted(code, Helper::Exponent, &[self.operand(code)]),
            None => match self {
                Interpolant::Known(known) => Number::Constant(weights::Number::exponent::<COVERED>(known)),
                _ => Number::Constant(0),
            },
        }
    }
    fn is_above(a: Number<'a>, b: Number<'a>) -> Truth<'a> {
        b.is_below(a)
    }
    fn or(self, condition: Truth<'a>, other: Interpolant<'a>) -> Interpolant<'a> {
        match condition {
            Truth::Known(true) => self,
            Truth::Known(false) => other,
            Truth::Of(code, test) => {
                let of = [self.operand(code), other.operand(code)];
                Interpolant::Of(code, code.make(Operation::Choose(test, of)), self.sign().max(other.sign()))
            }
        }
    }
}
