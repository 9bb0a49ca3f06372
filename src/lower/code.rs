//! Code of a pixel: integer operations in order, each with its range. Equal operations are shared, and those that change nothing are left out.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;

use ninebit::state::CompareFunction;

use crate::input::Input;
pub(crate) use crate::kind::{ANY_BINARY, COORDINATE, EXPONENT, MANTISSA, NORMAL, enclosing};
pub use crate::kind::{Kind, Range, packed};
pub use crate::operation::{Operand, Operation, Test};
pub(crate) use crate::operation::{Table, collected};

/// A line of code: an operation and what is known of its result.
#[derive(Clone, Debug)]
pub struct Line {
    /// The operation, with its operands.
    pub(crate) operation: Operation,
    /// Range of the result.
    pub range: Range,
    /// Id of the rule that asks for the operation.
    pub(crate) rule: &'static str,
    /// Name of the result, if the chip's documents have one.
    pub name: Option<String>,
}

/// Code under construction: lines, each of which uses earlier ones.
#[derive(Debug, Default)]
pub(crate) struct Code {
    lines: RefCell<Vec<Line>>,
    known: RefCell<HashMap<Operation, u32>>,
    rule: Cell<&'static str>,
    /// Whether divisors that are no constants may be other than powers of two.
    any_divisors: Cell<bool>,
}

impl Code {
    /// Returns the lines on which `roots` depend, renumbered, and a function that maps operands to the new numbers.
    pub(crate) fn reachable(self, roots: &[Operand]) -> (Vec<Line>, impl Fn(Operand) -> Operand + use<>) {
        let lines = self.lines.into_inner();
        let mut used = vec![false; lines.len()];
        let mut open: Vec<Operand> = roots.to_vec();
        while let Some(operand) = open.pop() {
            if let Some(line) = operand.line().filter(|line| !std::mem::replace(&mut used[*line], true)) {
                open.extend(lines[line].operation.operands());
            }
        }
        let mut number = 0;
        let numbers: Vec<u32> = used
            .iter()
            .map(|used| {
                number += u32::from(*used);
                number.wrapping_sub(1)
            })
            .collect();
        let renamed = move |operand: Operand| match operand {
            Operand::Line(line) => Operand::Line(numbers[line as usize]),
            constant => constant,
        };
        let lines = lines.into_iter().zip(&used).filter(|(_, used)| **used);
        let lines = lines.map(|(line, _)| Line { operation: line.operation.renamed(&renamed), ..line }).collect();
        (lines, renamed)
    }

    /// Says that divisors may be other than powers of two.
    pub(crate) fn allow_any_divisors(&self) {
        self.any_divisors.set(true);
    }

    /// Returns whether divisors may be other than powers of two.
    pub(crate) fn allows_any_divisors(&self) -> bool {
        self.any_divisors.get()
    }

    /// Sets the rule of the lines that are made from now on.
    pub(crate) fn by(&self, rule: &'static str) {
        self.rule.set(rule);
    }

    /// Names a value, unless it has a name.
    pub(crate) fn name(&self, operand: Operand, name: impl FnOnce() -> String) {
        if let Operand::Line(line) = operand {
            let line = &mut self.lines.borrow_mut()[line as usize];
            if line.name.is_none() && !matches!(line.operation, Operation::Input(_)) {
                line.name = Some(name());
            }
        }
    }

    /// Narrows the range of a value that is known to stay within it, even if its operands alone would allow more.
    pub(crate) fn narrow(&self, operand: Operand, (low, high): Range) {
        if let Operand::Line(line) = operand {
            let range = &mut self.lines.borrow_mut()[line as usize].range;
            *range = (range.0.max(low), range.1.min(high));
        }
    }

    /// Narrows the range of a value, and of what it is a sum or quotient of with a constant.
    pub(crate) fn narrow_all(&self, operand: Operand, (low, high): Range) {
        self.narrow(operand, (low, high));
        match self.operation(operand) {
            Some(Operation::Add(a, Operand::Constant(c))) => self.narrow_all(a, (low - c, high - c)),
            Some(Operation::Subtract(a, Operand::Constant(c))) => self.narrow_all(a, (low + c, high + c)),
            Some(Operation::Quotient(a, by)) => self.narrow_all(a, (low * by, high * by + by - 1)),
            _ => {}
        }
    }

    /// Returns the range of a value.
    pub(crate) fn range(&self, operand: Operand) -> Range {
        match operand {
            Operand::Constant(value) => (value, value),
            Operand::Line(line) => self.lines.borrow()[line as usize].range,
        }
    }

    /// Returns the operation whose result a value is; `None` if it is a constant.
    pub(crate) fn operation(&self, operand: Operand) -> Option<Operation> {
        Some(self.lines.borrow()[operand.line()?].operation)
    }

    /// Returns the result of an operation: that of a simpler or an existing line if it is equal, otherwise that of a new line.
    pub(crate) fn make(&self, operation: Operation) -> Operand {
        let constant = |operand: &Operand| matches!(operand, Operand::Constant(_));
        let is_known = !matches!(operation.kind(), Kind::Binary)
            && !matches!(operation, Operation::Input(_) | Operation::Fetch(..));
        if is_known && operation.operands().iter().all(constant) {
            return Operand::Constant(operation.result(|operand| value_of(&[], operand)));
        }
        let operation = match self.simpler(operation) {
            Ok(operand) => return operand,
            Err(operation) => operation,
        };
        let range = self.range_of(&operation);
        if range.0 == range.1 { Operand::Constant(range.0) } else { self.line(operation, range, self.rule.get()) }
    }

    /// Returns the value of an input, whose range may be known to be narrower than usual.
    pub(crate) fn input(&self, input: Input, range: Range) -> Operand {
        self.line(Operation::Input(input), range, "")
    }

    /// Returns the result of the line with this operation, which is added if there is none.
    fn line(&self, operation: Operation, range: Range, rule: &'static str) -> Operand {
        let mut lines = self.lines.borrow_mut();
        Operand::Line(*self.known.borrow_mut().entry(operation).or_insert_with(|| {
            lines.push(Line { operation, range, rule, name: None });
            lines.len() as u32 - 1
        }))
    }

    /// Returns a value that equals the result of the operation, or else the operation that has to be made.
    fn simpler(&self, operation: Operation) -> Result<Operand, Operation> {
        use Operand::Constant;
        let range = |operand| self.range(operand);
        match operation {
            Operation::Input(_) => {}
            Operation::Add(a, Constant(0)) | Operation::Add(Constant(0), a) | Operation::Subtract(a, Constant(0)) => {
                return Ok(a);
            }
            // A constant goes last, and several are combined into one.
            Operation::Add(Constant(c), a) => return Ok(self.make(Operation::Add(a, Constant(c)))),
            Operation::Add(a, Constant(c)) => return self.moved(a, c),
            Operation::Subtract(a, Constant(c)) => return self.moved(a, -c),
            Operation::Subtract(Constant(c), a) => {
                // c - (d - x) and c - (x + d).
                if let Some(Operation::Subtract(Constant(d), x)) = self.operation(a) {
                    return Ok(self.make(Operation::Add(x, Constant(c - d))));
                }
                let (x, d) = self.offset(a);
                if d != 0 {
                    return Ok(self.make(Operation::Subtract(Constant(c - d), x)));
                }
            }
            Operation::Subtract(a, b) if a == b => return Ok(Constant(0)),
            Operation::Multiply(a, Constant(1))
            | Operation::Multiply(Constant(1), a)
            | Operation::Times(a, Constant(1))
            | Operation::Times(Constant(1), a)
            | Operation::Quotient(a, 1)
            | Operation::Down(a, 0)
            | Operation::Up(a, 0)
            | Operation::Or(a, Constant(0))
            | Operation::Or(Constant(0), a) => return Ok(a),
            // A constant factor goes first.
            Operation::Multiply(a, Constant(c)) => return Ok(self.make(Operation::Multiply(Constant(c), a))),
            Operation::Multiply(Constant(c), a) => {
                if let Some(Operation::Multiply(Constant(d), a)) = self.operation(a) {
                    return Ok(self.make(Operation::Multiply(Constant(c * d), a)));
                }
            }
            Operation::Least(a, b) if range(a).1 <= range(b).0 => return Ok(a),
            Operation::Least(a, b) if range(b).1 <= range(a).0 => return Ok(b),
            Operation::Greatest(a, b) if range(a).0 >= range(b).1 => return Ok(a),
            Operation::Greatest(a, b) if range(b).0 >= range(a).1 => return Ok(b),
            Operation::Bits(a, mask) | Operation::And(a, Constant(mask)) | Operation::And(Constant(mask), a)
                if (mask + 1) & mask == 0 && range(a).0 >= 0 && range(a).1 <= mask =>
            {
                return Ok(a);
            }
            Operation::Select(_, [c, d]) if c == d => return Ok(c),
            Operation::Select(test, [c, d]) => {
                if let Some(holds) = self.decided(test) {
                    return Ok(if holds { c } else { d });
                }
            }
            Operation::Number(a) | Operation::Word(a) => match (operation, self.operation(a)) {
                (Operation::Number(_), Some(Operation::Word(a))) => return Ok(a),
                (Operation::Word(_), Some(Operation::Number(a))) => return Ok(a),
                _ => {}
            },
            // Where 8 bits are repeated, nothing remains of the second copy.
            Operation::Down(a, bits) if range(a).1 >> bits == 0 => return Ok(Constant(0)),
            Operation::Raise(a, Constant(0)) | Operation::Lower(a, Constant(0)) | Operation::Divide(a, Constant(1)) => {
                return Ok(a);
            }
            Operation::Raise(Constant(0), _) => return Ok(Constant(0)),
            Operation::Mantissa(a) | Operation::Exponent(a) => {
                if let Some(Operation::Binary(mantissa, exponent)) = self.operation(a) {
                    return Ok(if matches!(operation, Operation::Mantissa(_)) { mantissa } else { exponent });
                }
            }
            Operation::Choose(_, [c, d]) if c == d => return Ok(c),
            Operation::Choose(test, [c, d]) => {
                if let Some(holds) = self.decided(test) {
                    return Ok(if holds { c } else { d });
                }
            }
            _ => {}
        }
        Err(operation)
    }

    /// Splits a value into another one and a constant that is added to it.
    fn offset(&self, operand: Operand) -> (Operand, i64) {
        match self.operation(operand) {
            Some(Operation::Add(a, Operand::Constant(d))) => (a, d),
            Some(Operation::Subtract(a, Operand::Constant(d))) => (a, -d),
            _ => (operand, 0),
        }
    }

    /// Adds a constant to a value.
    fn moved(&self, a: Operand, by: i64) -> Result<Operand, Operation> {
        match self.offset(a) {
            (_, 0) if by < 0 => Err(Operation::Subtract(a, Operand::Constant(-by))),
            (_, 0) => Err(Operation::Add(a, Operand::Constant(by))),
            (x, d) => Ok(self.make(Operation::Add(x, Operand::Constant(by + d)))),
        }
    }

    /// Returns the result of a test if it is the same in every pixel.
    pub(crate) fn decided(&self, Test(function, [a, b]): Test) -> Option<bool> {
        let ((a0, a1), (b0, b1)) = (self.range(a), self.range(b));
        let decided = |always: bool, never: bool| if always { Some(true) } else { never.then_some(false) };
        match function {
            CompareFunction::Never => Some(false),
            CompareFunction::Always => Some(true),
            CompareFunction::Less => decided(a1 < b0, a0 >= b1),
            CompareFunction::LessOrEqual => decided(a1 <= b0, a0 > b1),
            CompareFunction::Greater => decided(a0 > b1, a1 <= b0),
            CompareFunction::GreaterOrEqual => decided(a0 >= b1, a1 < b0),
            CompareFunction::Equal => decided(a0 == a1 && (a0, a1) == (b0, b1), a1 < b0 || a0 > b1),
            CompareFunction::NotEqual => decided(a1 < b0 || a0 > b1, a0 == a1 && (a0, a1) == (b0, b1)),
        }
    }

    fn range_of(&self, operation: &Operation) -> Range {
        let range = |operand: Operand| self.range(operand);
        // A product or a sum that does not fit is not used.
        let wide = |of: &dyn Fn(i128, i128) -> i128, a: Range, b: Range| {
            let all = [(a.0, b.0), (a.0, b.1), (a.1, b.0), (a.1, b.1)];
            enclosing(
                all.into_iter()
                    .map(|(a, b)| of(a.into(), b.into()).clamp(i64::MIN.into(), i64::MAX.into()) as i64)
                    .map(|n| (n, n)),
            )
        };
        match *operation {
            Operation::Input(input) => input.range(),
            Operation::Add(a, b) | Operation::Plus(a, b) => wide(&|a, b| a + b, range(a), range(b)),
            Operation::Subtract(a, b) => wide(&|a, b| a - b, range(a), range(b)),
            Operation::Multiply(a, b) | Operation::Times(a, b) if a == b => {
                let (low, high) = range(a);
                let least = 0.clamp(low, high);
                enclosing([low, least, high].into_iter().map(|n| wide(&|a, b| a * b, (n, n), (n, n))))
            }
            Operation::Multiply(a, b) | Operation::Times(a, b) => wide(&|a, b| a * b, range(a), range(b)),
            Operation::Least(a, b) => (range(a).0.min(range(b).0), range(a).1.min(range(b).1)),
            Operation::Greatest(a, b) => (range(a).0.max(range(b).0), range(a).1.max(range(b).1)),
            Operation::Quotient(a, by) => (range(a).0.div_euclid(by), range(a).1.div_euclid(by)),
            Operation::Bits(a, mask) if range(a).0 < 0 => (0, mask),
            Operation::Bits(a, mask) => (0, mask.min(range(a).1)),
            Operation::Flip(_, bit) => (0, 2 * bit - 1),
            Operation::And(a, b) => (0, range(a).1.min(range(b).1)),
            Operation::Or(a, b) => {
                let most = range(a).1.max(range(b).1);
                (range(a).0.max(range(b).0), (1_i64 << (64 - most.leading_zeros())) - 1)
            }
            Operation::Select(_, [c, d]) => (range(c).0.min(range(d).0), range(c).1.max(range(d).1)),
            Operation::Number(a) | Operation::Word(a) => range(a),
            Operation::Down(a, bits) => (range(a).0 >> bits, range(a).1 >> bits),
            Operation::Up(a, bits) => (range(a).0 << bits, range(a).1 << bits),
            Operation::Length(a) => (bits_of(range(a).0.max(0)), bits_of(range(a).1)),
            Operation::Raise(a, by) => match wide(&|a, by| a << by.clamp(0, 63), range(a), range(by)) {
                // What does not fit wraps.
                (low, high) if low == i64::MIN || high == i64::MAX => (i64::MIN, i64::MAX),
                fits => fits,
            },
            Operation::Lower(a, by) => wide(&|a, by| a >> by.clamp(0, 63), range(a), range(by)),
            Operation::Mask(_, by) => (0, range(by).1),
            Operation::Divide(a, by) => wide(&|a, by| a / by.max(1), range(a), range(by)),
            Operation::Entry(Table(table), _) => {
                enclosing(table.iter().map(|entry| ((*entry).into(), (*entry).into())))
            }
            Operation::Fetch(..) | Operation::Difference(..) => (0, u32::MAX.into()),
            Operation::Mantissa(_) => MANTISSA,
            Operation::Exponent(_) => EXPONENT,
            Operation::Binary(..) | Operation::Choose(..) => ANY_BINARY,
            Operation::Call(helper, _) => helper.range(),
        }
    }
}

fn bits_of(n: i64) -> i64 {
    (64 - n.leading_zeros()).into()
}

/// What a function is given while it runs: a closure gives inputs, and memories of zeros.
pub trait InputSource {
    /// Returns the value of an input.
    fn input(&mut self, input: Input) -> i64;
    /// Returns a word of a unit's memory.
    fn word(&mut self, _unit: usize, _at: i64) -> u32 {
        0
    }
}

impl<F: FnMut(Input) -> i64> InputSource for F {
    fn input(&mut self, input: Input) -> i64 {
        self(input)
    }
}

/// Runs all lines, and returns their results.
///
/// # Panics
/// In debug builds, if a result is outside its range.
pub fn run(lines: &[Line], given: impl InputSource) -> Vec<i64> {
    run_changed(lines, given, |line, value| {
        let Line { range, .. } = &lines[line];
        debug_assert!((range.0..=range.1).contains(&value), "{value} of line {line} {:?}", lines[line]);
        value
    })
}

/// Runs all lines like [`run`], with each result replaced by `change` of its line's index and value, to find what depends on it. Ranges are not
/// checked.
pub fn run_changed(lines: &[Line], mut given: impl InputSource, mut change: impl FnMut(usize, i64) -> i64) -> Vec<i64> {
    let mut values: Vec<i64> = Vec::with_capacity(lines.len());
    for (n, line) in lines.iter().enumerate() {
        let value = match line.operation {
            Operation::Input(input) => given.input(input),
            Operation::Fetch(unit, at) => given.word(unit, value_of(&values, at)).into(),
            operation => operation.result(|operand| value_of(&values, operand)),
        };
        values.push(change(n, value));
    }
    values
}

/// Returns the value of an operand, given the results of all lines.
pub fn value_of(values: &[i64], operand: Operand) -> i64 {
    match operand {
        Operand::Constant(value) => value,
        Operand::Line(line) => values[line as usize],
    }
}
