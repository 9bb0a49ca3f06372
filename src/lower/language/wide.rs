//! Operations of numbers that need more than 32 bits.

use super::*;

/// An operation of numbers that may need more than 32 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wide {
    Add,
    Subtract,
    Multiply,
    Least,
    Greatest,
    Bits,
    Select,
    Length,
    Raise,
    Lower,
    /// A shift of a number of 32 bits by at most 31.
    ShortLower,
    Divide,
    /// A quotient that fits into 32 bits, by a divisor below [`DIVISOR`].
    Quotient,
    /// The product of two numbers of 32 bits, of which the second is 0 to 65535.
    Scale,
}

/// Divisors below this have a shorter division where quotients fit into 32 bits.
const DIVISOR: i64 = 1 << 58;

impl Body<'_> {
    /// Prints an operation of numbers if more than 32 bits are needed.
    pub(super) fn wide(&self, line: &Line) -> Option<Text> {
        let (mut wide, mut operands) = wide_operation(line.operation)?;
        let result = is_wide(line.range);
        if wide == Wide::Divide && !result && self.range(operands[1]).1 < DIVISOR {
            wide = Wide::Quotient;
        }
        let is_short = |operand: &Operand| self.range(*operand).0 >= 0 && self.range(*operand).1 <= 0xffff;
        if wide == Wide::Multiply && !operands.iter().any(|operand| self.is_wide(*operand)) {
            operands.sort_by_key(is_short);
            wide = if operands.last().is_some_and(is_short) { Wide::Scale } else { wide };
        }
        if !result && !operands.iter().any(|operand| self.is_wide(*operand)) {
            return None;
        }
        let mut terms: Vec<(String, bool)> = operands
            .iter()
            .map(|operand| (self.operand(*operand, Kind::Number).term(), self.is_wide(*operand)))
            .collect();
        if let Operation::Select(test, _) = line.operation {
            terms.insert(0, (self.test(test), false));
        }
        Some(self.syntax.wide(wide, &terms, result))
    }
}

/// Returns the operation as one that may be wide, and the operands that may be.
pub(super) fn wide_operation(operation: Operation) -> Option<(Wide, Vec<Operand>)> {
    Some(match operation {
        Operation::Add(a, b) => (Wide::Add, vec![a, b]),
        Operation::Subtract(a, b) => (Wide::Subtract, vec![a, b]),
        Operation::Multiply(a, b) => (Wide::Multiply, vec![a, b]),
        Operation::Least(a, b) => (Wide::Least, vec![a, b]),
        Operation::Greatest(a, b) => (Wide::Greatest, vec![a, b]),
        Operation::Bits(a, mask) => (Wide::Bits, vec![a, Operand::Constant(mask)]),
        Operation::Mask(a, mask) => (Wide::Bits, vec![a, mask]),
        Operation::Select(_, values) => (Wide::Select, values.to_vec()),
        Operation::Length(a) => (Wide::Length, vec![a]),
        Operation::Raise(a, by) => (Wide::Raise, vec![a, by]),
        Operation::Lower(a, by) => (Wide::Lower, vec![a, by]),
        Operation::Divide(a, by) => (Wide::Divide, vec![a, by]),
        Operation::Quotient(a, by) => (Wide::Divide, vec![a, Operand::Constant(by)]),
        _ => return None,
    })
}
