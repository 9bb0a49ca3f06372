//! Prints functions in several languages. A value has a line of its own if the chip's documents name it or if it is used more than once; other
//! values are printed where they are used.

mod c;
mod glsl;
mod pair;
mod shader;
mod verilog;
mod wgsl;
mod whole;
mod wide;

pub(crate) use c::{STRUCTURES, statements};
pub(crate) use verilog::port;
pub(crate) use whole::shared;

use std::collections::BTreeSet;

use ninebit::raster::fog;
use ninebit::raster::weights::FIRST_RECIPROCALS;
use ninebit::state::{CompareFunction, named};
use ninebit::texture::dot;

use crate::code::{Kind, Line, Operand, Operation, Range, Table, Test};
use crate::helper::Helper;
use crate::input::Input;
use crate::kind::is_wide;
use crate::pixel::{Function, Result};
pub use pair::Shaders;
pub(crate) use pair::TRIANGLES;
pub(crate) use shader::ABOUT;
pub use whole::Draw;
pub(crate) use wide::Wide;
use wide::wide_operation;

named! {
    /// A language that functions are printed in.
    pub enum Language {
        /// C99, without dependencies.
        C99 = "c99",
        /// GLSL 3.30, and GLSL ES 3.00.
        Glsl = "glsl",
        /// WGSL, the shading language of WebGPU.
        Wgsl = "wgsl",
        /// Verilog-2001: combinational modules.
        Verilog = "verilog",
    }
}

/// A function with a name.
#[derive(Debug)]
pub struct NamedFunction<'f> {
    /// Name: a letter, then letters, digits and underscores.
    pub name: String,
    /// Description in one line. Printing removes whatever would end a comment.
    pub about: String,
    /// The function to print.
    pub function: &'f Function,
}

impl Language {
    /// Prints a whole text: what all functions share, then the functions.
    pub fn print(self, functions: &[NamedFunction<'_>]) -> String {
        let syntax = self.syntax();
        let mut out = syntax.head(functions);
        for named in functions {
            out.push('\n');
            out.push_str(&function(syntax, named));
        }
        out
    }

    /// Returns how a function of this language reads an input: a member of `pixel` or `constants`, or a port.
    pub fn input(self, input: Input) -> String {
        self.syntax().input(input)
    }

    pub(crate) fn syntax(self) -> &'static dyn Syntax {
        match self {
            Language::C99 => &c::C99,
            Language::Glsl => &glsl::Glsl,
            Language::Wgsl => &wgsl::Wgsl,
            Language::Verilog => &verilog::Verilog,
        }
    }
}

/// The syntax of a language, as far as languages differ.
pub(crate) trait Syntax {
    /// Prints what stands before all functions.
    fn head(&self, functions: &[NamedFunction<'_>]) -> String;
    /// Prints the beginning of a function: its comment, name and parameters.
    fn opening(&self, named: &NamedFunction<'_>) -> String;
    /// Prints the end of a function that yields a fragment.
    fn fragment(&self, channels: [String; 4]) -> String;
    /// Prints the end of a function that yields a word, unless the fragment fails `test`.
    fn stored(&self, word: String, test: Option<String>) -> String;
    /// Prints the end of a function of a whole pixel.
    fn pixel(&self, word: String, depth: Option<String>, test: Option<String>) -> String;
    /// Returns how an input is read.
    fn input(&self, input: Input) -> String;
    /// Prints a constant as a value of the given kind.
    fn constant(&self, value: i64, kind: Kind) -> String {
        match kind {
            Kind::Number | Kind::Binary => value.to_string(),
            Kind::Word if value > 255 => format!("{value:#x}u"),
            Kind::Word => format!("{value}u"),
        }
    }
    /// Prints an operation that is not an infix operator in every language. The operands are terms.
    fn call(&self, call: Call, operands: &[String]) -> Text;
    /// Prints an operation of numbers of which some, or the result, may need more than 32 bits. The operands are terms, each with whether it does.
    fn wide(&self, operation: Wide, operands: &[(String, bool)], result: bool) -> Text;
    /// Prints a comparison of numbers of which some need more than 32 bits.
    fn compare(&self, (a, _): (String, bool), operator: &str, (b, _): (String, bool)) -> String {
        format!("{a} {operator} {b}")
    }
    /// Converts a number to 64 bits.
    fn widened(&self, text: String) -> String {
        text
    }
    /// Converts a number of 64 bits to 32.
    fn narrowed(&self, text: String) -> String {
        text
    }
    /// Returns how a part of a binary number is read.
    fn part(&self, binary: String, is_exponent: bool) -> String {
        format!("{binary}.{}", if is_exponent { "y" } else { "x" })
    }
    /// Prints a word of a unit's memory.
    fn word(&self, unit: usize, at: String) -> String {
        format!("ninebit_texel({unit}, {at})")
    }
    /// Prints the declaration of a named value.
    fn declare(&self, name: &str, line: &Line, value: &str, comment: &str) -> String;
    /// Returns whether operands of comparisons, and numbers that become words, have to be names. In Verilog the width of any other expression depends
    /// on what surrounds it.
    fn compares_names(&self) -> bool {
        false
    }
}

/// Prints a whole function.
fn function(syntax: &'static dyn Syntax, named: &NamedFunction<'_>) -> String {
    let (body, result) = (Body::of_function(syntax, named.function, ""), named.function.result);
    let lines = body.printed();
    let end = match result {
        Result::Fragment(channels) => syntax.fragment(body.open(channels, Kind::Number)),
        Result::Pixel { word, depth, test } => {
            let word = body.operand(word, Kind::Word).open();
            let depth = depth.map(|depth| body.operand(depth, Kind::Word).open());
            syntax.pixel(word, depth, test.map(|test| body.test(test)))
        }
        Result::Stored { word, test } => {
            syntax.stored(body.operand(word, Kind::Word).open(), test.map(|test| body.test(test)))
        }
    };
    syntax.opening(named) + &lines + &end
}

/// An operation that languages write differently.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Call {
    Least,
    Greatest,
    /// The operands are the test, the value if it holds, and the value otherwise.
    Select,
    Number,
    Word,
    /// A helper, a table or a binary number.
    Named(&'static str),
}

/// Tables, with their names in printed text.
pub(crate) const TABLES: [(&str, Table); 8] = {
    let [a, b, c, d, e] = &dot::ROOT_BYTES;
    [
        ("reciprocals", Table(&FIRST_RECIPROCALS)),
        ("exponential", Table(&fog::EXPONENTIAL)),
        ("squared", Table(&fog::SQUARED)),
        ("root_low", Table(a)),
        ("root_middle", Table(b)),
        ("root_high", Table(c)),
        ("rise_low", Table(d)),
        ("rise_high", Table(e)),
    ]
};

/// A piece of text.
#[derive(Clone, Debug)]
pub(crate) enum Text {
    /// A name, a constant or a call, which needs no parentheses.
    Term(String),
    /// An expression of operators without parentheses around it.
    Open(String),
}

impl Text {
    fn length_without(&self, suffix: &str) -> usize {
        match self {
            Text::Term(text) | Text::Open(text) if suffix.is_empty() => text.len(),
            Text::Term(text) | Text::Open(text) => text.replace(suffix, "").len(),
        }
    }

    fn term(self) -> String {
        match self {
            Text::Term(text) => text,
            Text::Open(text) => format!("({text})"),
        }
    }

    fn open(self) -> String {
        match self {
            Text::Term(text) | Text::Open(text) => text,
        }
    }
}

/// The lines of a function, printed.
pub(crate) struct Body<'f> {
    /// Declarations in order.
    pub(crate) declarations: Vec<String>,
    syntax: &'static dyn Syntax,
    /// What names end with, those of the pixel's inputs too.
    suffix: &'static str,
    lines: &'f [Line],
    texts: Vec<(Text, BTreeSet<&'static str>)>,
}

impl<'f> Body<'f> {
    /// Prints lines whose results are `results`; the values `test` are compared.
    pub(crate) fn from_lines(
        syntax: &'static dyn Syntax,
        lines: &'f [Line],
        results: &[Operand],
        test: &[Operand],
    ) -> Body<'f> {
        Body::within(usize::MAX, syntax, lines, (results, test))
    }

    /// The same, where a value whose text is longer than `longest` has a line of its own.
    pub(crate) fn within(
        longest: usize,
        syntax: &'static dyn Syntax,
        lines: &'f [Line],
        used: (&[Operand], &[Operand]),
    ) -> Body<'f> {
        Body::with_suffix(longest, (syntax, ""), lines, used)
    }

    /// Prints the lines of a function, with a suffix of all names.
    fn of_function(syntax: &'static dyn Syntax, function: &'f Function, suffix: &'static str) -> Body<'f> {
        let result = function.result;
        let test = match result {
            Result::Stored { test: Some(Test(_, operands)), .. }
            | Result::Pixel { test: Some(Test(_, operands)), .. } => operands.to_vec(),
            _ => Vec::new(),
        };
        let longest = if matches!(result, Result::Pixel { .. }) { whole::LONGEST } else { usize::MAX };
        Body::with_suffix(longest, (syntax, suffix), &function.lines, (&result.operands(), &test))
    }

    fn with_suffix(
        longest: usize,
        (syntax, suffix): (&'static dyn Syntax, &'static str),
        lines: &'f [Line],
        (results, test): (&[Operand], &[Operand]),
    ) -> Body<'f> {
        let mut uses = vec![0; lines.len()];
        let all = lines.iter().flat_map(|line| line.operation.operands()).chain(results.iter().copied());
        all.filter_map(Operand::line).for_each(|line| uses[line] += 1);
        let compared = lines.iter().flat_map(|line| match line.operation {
            Operation::Least(a, b) | Operation::Greatest(a, b) | Operation::Select(Test(_, [a, b]), _) => vec![a, b],
            Operation::Word(a) => vec![a],
            _ => Vec::new(),
        });
        let mut named = vec![false; lines.len()];
        let compared = compared.chain(test.iter().copied()).filter_map(Operand::line);
        compared.for_each(|line| named[line] = syntax.compares_names());
        let mut body = Body { declarations: Vec::new(), syntax, suffix, lines, texts: Vec::with_capacity(lines.len()) };
        let (mut names, mut unnamed) = (BTreeSet::new(), 0);
        for (n, line) in lines.iter().enumerate() {
            let (text, mut rules) = body.text(line);
            let is_input = matches!(line.operation, Operation::Input(_));
            // Lines are the same with any suffix.
            let is_short = text.length_without(suffix) <= longest;
            if is_input || (line.name.is_none() && uses[n] < 2 && !named[n] && is_short) {
                body.texts.push((text, rules));
                continue;
            }
            let mut name = line.name.clone().unwrap_or_else(|| {
                unnamed += 1;
                format!("value{unnamed}")
            });
            // A name may occur twice: a later rule asks for the same value in another form.
            let stem = name.clone();
            let mut nth = 1;
            while !names.insert(name.clone()) {
                nth += 1;
                name = format!("{stem}_{nth}");
            }
            name += suffix;
            rules.remove("");
            let rules: Vec<&str> = rules.into_iter().collect();
            let range = match line.operation.kind() {
                Kind::Number => format!("{}..{}", line.range.0, line.range.1),
                Kind::Word => format!("0..{:#x}", line.range.1),
                Kind::Binary => String::new(),
            };
            let comment = match (rules.is_empty(), range.is_empty()) {
                (true, _) => range,
                (_, true) => rules.join(", "),
                _ => format!("{}: {range}", rules.join(", ")),
            };
            body.declarations.push(syntax.declare(&name, line, &text.open(), &comment));
            body.texts.push((Text::Term(name), BTreeSet::new()));
        }
        body
    }

    /// Prints an operand of the given kind.
    fn operand(&self, operand: Operand, kind: Kind) -> Text {
        match operand {
            Operand::Constant(value) if value < 0 => Text::Open(self.syntax.constant(value, kind)),
            Operand::Constant(value) => Text::Term(self.syntax.constant(value, kind)),
            Operand::Line(line) => self.texts[line as usize].0.clone(),
        }
    }

    /// Prints a result. Also returns the rules that no declaration has mentioned.
    pub(crate) fn result(&self, operand: Operand, kind: Kind) -> (String, String) {
        let rules = operand.line().into_iter().flat_map(|line| &self.texts[line].1);
        let rules: Vec<&str> = rules.copied().filter(|rule| !rule.is_empty()).collect();
        (self.operand(operand, kind).open(), rules.join(", "))
    }

    fn range(&self, operand: Operand) -> Range {
        match operand {
            Operand::Constant(value) => (value, value),
            Operand::Line(line) => self.lines[line as usize].range,
        }
    }

    fn is_wide(&self, operand: Operand) -> bool {
        let is_number = |line: usize| self.lines[line].operation.kind() == Kind::Number;
        operand.line().is_none_or(is_number) && is_wide(self.range(operand))
    }

    fn test(&self, Test(function, operands): Test) -> String {
        let [a, b] = operands.map(|operand| self.operand(operand, Kind::Number).term());
        let is_wide = operands.map(|operand| self.is_wide(operand));
        let operator = match function {
            CompareFunction::Never => return format!("{a} != {a}"),
            CompareFunction::Always => return format!("{a} == {a}"),
            CompareFunction::Less => "<",
            CompareFunction::LessOrEqual => "<=",
            CompareFunction::Equal => "==",
            CompareFunction::NotEqual => "!=",
            CompareFunction::Greater => ">",
            CompareFunction::GreaterOrEqual => ">=",
        };
        if is_wide != [false; 2] {
            return self.syntax.compare((a, is_wide[0]), operator, (b, is_wide[1]));
        }
        format!("{a} {operator} {b}")
    }

    /// Prints an operation. Also returns the rules of everything that is part of the text.
    fn text(&self, line: &Line) -> (Text, BTreeSet<&'static str>) {
        let (syntax, operation) = (self.syntax, line.operation);
        let mut rules = BTreeSet::from([line.rule]);
        rules.extend(operation.operands().into_iter().filter_map(Operand::line).flat_map(|line| &self.texts[line].1));
        let kind = operation.takes();
        let term = |operand: Operand| self.operand(operand, kind).term();
        let number = |value: i64| syntax.constant(value, kind);
        let shift = |bits: u32| syntax.constant(bits.into(), Kind::Word);
        let infix = |a: String, operator: &str, b: String| Text::Open(format!("{a} {operator} {b}"));
        if let Some(text) = self.wide(line) {
            return (text, rules);
        }
        let text = match operation {
            Operation::Input(input) => {
                let suffix = if matches!(input, Input::X | Input::Held | Input::Depth) { self.suffix } else { "" };
                return (Text::Term(syntax.input(input) + suffix), BTreeSet::new());
            }
            Operation::Add(a, b) => infix(self.summand(a, true), "+", self.summand(b, false)),
            Operation::Subtract(a, b) => infix(self.summand(a, true), "-", self.summand(b, false)),
            Operation::Multiply(a, b) | Operation::Times(a, b) => infix(term(a), "*", term(b)),
            Operation::Quotient(a, by) if self.is_shift(by) => infix(term(a), ">>", shift(by.trailing_zeros())),
            Operation::Quotient(a, by) => infix(term(a), "/", number(by)),
            Operation::Bits(a, mask) => infix(term(a), "&", number(mask)),
            Operation::Flip(a, bit) => infix(term(a), "^", number(bit)),
            Operation::And(a, b) => infix(term(a), "&", term(b)),
            Operation::Or(a, b) => infix(term(a), "|", term(b)),
            Operation::Plus(a, b) => infix(term(a), "+", term(b)),
            Operation::Down(a, bits) => infix(term(a), ">>", shift(bits)),
            Operation::Up(a, bits) => infix(term(a), "<<", shift(bits)),
            Operation::Least(a, b) => syntax.call(Call::Least, &self.open([a, b], kind)),
            Operation::Greatest(a, b) => syntax.call(Call::Greatest, &self.open([a, b], kind)),
            Operation::Number(a) => syntax.call(Call::Number, &self.open([a], kind)),
            Operation::Word(a) => syntax.call(Call::Word, &self.open([a], kind)),
            Operation::Select(test, [c, d]) | Operation::Choose(test, [c, d]) => {
                syntax.call(Call::Select, &[self.test(test), term(c), term(d)])
            }
            Operation::Mask(a, by) => infix(term(a), "&", term(by)),
            Operation::Divide(a, by) => infix(term(a), "/", term(by)),
            Operation::Length(_) | Operation::Raise(..) | Operation::Lower(..) => {
                let (mut wide, operands) = wide_operation(operation).unwrap_or((Wide::Length, Vec::new()));
                if wide == Wide::Lower && self.range(operands[1]).1 < 32 {
                    wide = Wide::ShortLower;
                }
                let operands: Vec<_> = operands.into_iter().map(|operand| (term(operand), false)).collect();
                syntax.wide(wide, &operands, false)
            }
            Operation::Entry(table, a) => {
                let name = TABLES.iter().find(|(_, known)| *known == table).map_or("", |(name, _)| name);
                Text::Term(format!("ninebit_{name}[{}]", self.index(a)))
            }
            Operation::Fetch(unit, a) => Text::Term(syntax.word(unit, self.index(a))),
            Operation::Binary(a, b) => syntax.call(Call::Named("binary"), &self.open([a, b], kind)),
            Operation::Mantissa(a) => Text::Term(syntax.part(term(a), false)),
            Operation::Exponent(a) => Text::Term(syntax.part(term(a), true)),
            Operation::Difference(a, b) => syntax.call(Call::Named("difference"), &self.open([a, b], kind)),
            Operation::Call(helper, _) => {
                let text = syntax.call(Call::Named(helper.about().0), &self.arguments(helper, operation));
                let narrows = helper.kind() == Kind::Number && is_wide(helper.range()) && !is_wide(line.range);
                if narrows { Text::Term(syntax.narrowed(text.open())) } else { text }
            }
        };
        (text, rules)
    }

    /// Prints the operands of a helper.
    fn arguments(&self, helper: Helper, operation: Operation) -> Vec<String> {
        let wanted = helper.parameters().iter().zip(operation.operands());
        wanted
            .map(|((kind, range), operand)| {
                let text = self.operand(operand, *kind).open();
                let widens = *kind == Kind::Number && is_wide(*range) && !self.is_wide(operand);
                if widens { self.syntax.widened(text) } else { text }
            })
            .collect()
    }

    /// Prints an index, which fits into 32 bits even if its range is not known to.
    fn index(&self, operand: Operand) -> String {
        let text = self.operand(operand, Kind::Number).open();
        if self.is_wide(operand) { self.syntax.narrowed(text) } else { text }
    }

    fn open<const N: usize>(&self, operands: [Operand; N], kind: Kind) -> [String; N] {
        operands.map(|operand| self.operand(operand, kind).open())
    }

    /// Returns whether a quotient is printed as a shift: what is divided is not negative, but compilers do not know that. Verilog has wires as wide as
    /// ranges, so its tools do.
    fn is_shift(&self, by: i64) -> bool {
        by & (by - 1) == 0 && !self.syntax.compares_names()
    }

    /// Prints an operand of a sum. Products need no parentheses there, nor do sums if they come first.
    fn summand(&self, operand: Operand, first: bool) -> String {
        let text = self.operand(operand, Kind::Number);
        let binds = operand.line().is_some_and(|line| match self.lines[line].operation {
            Operation::Add(..) | Operation::Subtract(..) => first,
            Operation::Quotient(_, by) => !self.is_shift(by),
            Operation::Multiply(..) => true,
            _ => false,
        });
        if binds { text.open() } else { text.term() }
    }
}

/// Returns whether some functions have constants as inputs.
fn reads_constants(functions: &[NamedFunction<'_>]) -> bool {
    functions.iter().any(|named| named.function.uniform)
}

/// Returns the letter of a channel.
fn letter(channel: usize) -> &'static str {
    ninebit::combiner::registers::channel_name(channel)
}

/// Returns text for a comment of one line.
fn comment(text: &str) -> String {
    text.replace("*/", "* /").replace(['\n', '\r'], " ")
}

/// Comment at the head of texts: how division rounds.
pub(crate) const ROUNDING: [&str; 3] = [
    "Numbers are two's complement and stay within 32 bits: nothing overflows. Registers hold -256 to 255, 1.0 is 255. Where a",
    "number below zero is divided, whole multiples of the divisor are added before and taken off after, because a quotient is",
    "the floor: (2 n + 255) / 510 is the nearest 255th (NUM-2). Each line has its rules and its range.",
];
