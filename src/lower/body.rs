//! The lines of helpers, read from the rules.

use ninebit::raster::binary::Binary;

use crate::code::{Code, Kind, Line, Operand, Operation, Range};
use crate::helper::{Helper, Value};
use crate::input::Input;
use crate::number::Number;

impl Helper {
    /// Returns the lines of the helper, and the result.
    pub(crate) fn lines(self) -> (Vec<Line>, Operand) {
        let code = Code::default();
        code.by(self.about().2);
        let given: Vec<Value<Number<'_>>> = self
            .parameters()
            .iter()
            .enumerate()
            .map(|(at, (kind, range))| {
                let input = Input::Local(self.parameter(at, *kind, *range));
                let operand = code.input(input, *range);
                match kind {
                    Kind::Binary => Value::Binary(parts(&code, operand, self.mantissas())),
                    _ => Value::Number(Number::new(&code, operand)),
                }
            })
            .collect();
        let result = match self.read(&given) {
            Value::Number(number) => number.operand(),
            Value::Binary(Binary { mantissa, exponent }) => {
                code.make(Operation::Binary(mantissa.operand(), exponent.operand()))
            }
        };
        let (lines, renamed) = code.reachable(&[result]);
        (lines, renamed(result))
    }
}

/// Returns the parts of a binary number, whose mantissa is within a range.
pub(crate) fn parts(code: &Code, operand: Operand, mantissas: Range) -> Binary<Number<'_>> {
    let mantissa = code.make(Operation::Mantissa(operand));
    code.narrow(mantissa, mantissas);
    Binary {
        mantissa: Number::new(code, mantissa),
        exponent: Number::new(code, code.make(Operation::Exponent(operand))),
    }
}
