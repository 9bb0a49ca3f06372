//! Code of a pixel: integer operations in order, each with its range. Equal operations are shared, and those that change nothing are left out.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;

use ninebit::state::CompareFunction;

use crate::input::Input;

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

/// Kind of a value: a number, or the bits of a stored word or texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// Two's complement, within 32 bits.
    Number,
    /// 32 bits without a sign.
    Word,
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
    /// A word shifted right by a constant.
    Down(Operand, u32),
    /// A word shifted left by a constant; the result is below 2^32.
    Up(Operand, u32),
}

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
            | Operation::Down(..)
            | Operation::Up(..) => Kind::Word,
            _ => Kind::Number,
        }
    }

    /// Returns the kind of the operands.
    pub(crate) fn takes(&self) -> Kind {
        match self {
            Operation::Number(_) => Kind::Word,
            Operation::Word(_) => Kind::Number,
            _ => self.kind(),
        }
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
            Operation::Down(a, bits) => Operation::Down(name(a), bits),
            Operation::Up(a, bits) => Operation::Up(name(a), bits),
        }
    }

    /// Computes the result from the values of the operands. The result of an input is 0, since the caller knows it.
    fn of(&self, value: impl Fn(Operand) -> i64) -> i64 {
        match *self {
            Operation::Input(_) => 0,
            Operation::Add(a, b) => value(a) + value(b),
            Operation::Subtract(a, b) => value(a) - value(b),
            Operation::Multiply(a, b) | Operation::Times(a, b) => value(a) * value(b),
            Operation::Least(a, b) => value(a).min(value(b)),
            Operation::Greatest(a, b) => value(a).max(value(b)),
            Operation::Quotient(a, by) => value(a).div_euclid(by),
            Operation::Bits(a, mask) => value(a) & mask,
            Operation::Flip(a, bit) => value(a) ^ bit,
            Operation::Select(Test(function, [a, b]), [c, d]) => {
                value(if function.passes(value(a), value(b)) { c } else { d })
            }
            Operation::Number(a) | Operation::Word(a) => value(a),
            Operation::And(a, b) => value(a) & value(b),
            Operation::Or(a, b) => value(a) | value(b),
            Operation::Down(a, bits) => value(a) >> bits,
            Operation::Up(a, bits) => value(a) << bits,
        }
    }
}

/// The least and the largest value of a range, both inclusive.
pub type Range = (i64, i64);

/// Returns the range that encloses all ranges.
pub(crate) fn enclosing(ranges: impl Iterator<Item = Range>) -> Range {
    ranges.fold((i64::MAX, i64::MIN), |all, one| (all.0.min(one.0), all.1.max(one.1)))
}

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
}

impl Code {
    /// Returns the lines on which `roots` depend, renumbered, and a function that maps operands to the new numbers.
    pub(crate) fn kept(self, roots: &[Operand]) -> (Vec<Line>, impl Fn(Operand) -> Operand + use<>) {
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
        if !matches!(operation, Operation::Input(_)) && operation.operands().iter().all(constant) {
            return Operand::Constant(operation.of(|operand| value_of(&[], operand)));
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
                if (mask + 1) & mask == 0 && range(a).1 <= mask =>
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
        // The range of an operation that is monotone in each operand.
        let corners = |a: Range, b: Range| {
            let of = |a: i64, b: i64| {
                let operands = operation.operands();
                operation.of(|operand| if operand == operands[0] { a } else { b })
            };
            let all = if operation.operands()[0] == operation.operands()[1] {
                vec![of(a.0, a.0), of(a.1, a.1), if a.0 < 0 && a.1 > 0 { of(0, 0) } else { of(a.0, a.0) }]
            } else {
                vec![of(a.0, b.0), of(a.0, b.1), of(a.1, b.0), of(a.1, b.1)]
            };
            enclosing(all.into_iter().map(|value| (value, value)))
        };
        match *operation {
            Operation::Input(input) => input.range(),
            Operation::Add(a, b) => (range(a).0 + range(b).0, range(a).1 + range(b).1),
            Operation::Subtract(a, b) => (range(a).0 - range(b).1, range(a).1 - range(b).0),
            Operation::Multiply(a, b) | Operation::Times(a, b) => corners(range(a), range(b)),
            Operation::Least(a, b) => (range(a).0.min(range(b).0), range(a).1.min(range(b).1)),
            Operation::Greatest(a, b) => (range(a).0.max(range(b).0), range(a).1.max(range(b).1)),
            Operation::Quotient(a, by) => (range(a).0.div_euclid(by), range(a).1.div_euclid(by)),
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
        }
    }
}

/// Runs all lines, and returns their results. `input` returns the values of inputs.
///
/// # Panics
/// In debug builds, if a result is outside its range.
pub fn run(lines: &[Line], input: impl FnMut(Input) -> i64) -> Vec<i64> {
    run_changed(lines, input, |line, value| {
        let Line { range, .. } = &lines[line];
        debug_assert!((range.0..=range.1).contains(&value), "{value} of {:?}", lines[line]);
        value
    })
}

/// Runs all lines like [`run`], with each result replaced by `change` of its line's index and value, to find what depends on it. Ranges are not
/// checked.
pub fn run_changed(
    lines: &[Line],
    mut input: impl FnMut(Input) -> i64,
    mut change: impl FnMut(usize, i64) -> i64,
) -> Vec<i64> {
    let mut values: Vec<i64> = Vec::with_capacity(lines.len());
    for (n, line) in lines.iter().enumerate() {
        let value = match line.operation {
            Operation::Input(given) => input(given),
            operation => operation.of(|operand| value_of(&values, operand)),
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
