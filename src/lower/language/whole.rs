//! Prints draws whole: what their functions share, helpers, set-up, coverage, and a function for each.

use std::collections::BTreeSet;

use super::*;
use crate::setup::{Setup, coverage};
use crate::triangle::Field;

/// Length of a value's text above which it has a line of its own.
pub(super) const LONGEST: usize = 90;

/// A draw whose whole pixel is printed.
#[derive(Debug)]
pub struct Draw<'f> {
    /// Name: a letter, then letters, digits and underscores.
    pub name: String,
    /// Description in one line.
    pub about: String,
    /// The function of a pixel.
    pub function: &'f Function,
    /// What makes the constants of its triangles.
    pub setup: &'f Setup,
}

/// The syntax of a language in which draws are printed whole.
pub(crate) trait WholeSyntax: Syntax {
    /// Prints what stands before all helpers.
    fn whole_head(&self) -> String;
    /// Prints the functions of numbers, with structures before them.
    fn functions(&self, structures: &str) -> String;
    /// Prints the beginning of a helper.
    fn helper(&self, helper: Helper) -> String;
    /// Prints the end of a helper.
    fn result(&self, value: String) -> String {
        format!("    return {value};\n}}\n")
    }
    /// Prints a table.
    fn table(&self, name: &str, table: Table) -> String;
    /// Prints the function that tells whether a triangle covers a pixel, around its lines.
    fn coverage(&self, lines: &str, test: &str) -> String;
    /// Prints a function that makes the constants of a triangle; nothing where the host makes them.
    fn setup(&self, _draw: &Draw<'_>) -> String {
        String::new()
    }
    /// Prints a function that draws pixels of a row; nothing where processors draw them in parallel.
    fn row(&self, _draw: &Draw<'_>) -> String {
        String::new()
    }
}

impl Language {
    /// Prints draws as functions from a pixel, its triangle and the memories of textures to the stored words. Returns `None` for Verilog, in which only
    /// the rules of a pixel's colours are printed.
    pub fn print_whole(self, draws: &[Draw<'_>]) -> Option<String> {
        let (whole, syntax) = self.whole_syntax()?;
        let mut out = whole.whole_head();
        let lines = || draws.iter().flat_map(|draw| draw.function.lines.iter().chain(&draw.setup.lines));
        out.push_str(&calls((whole, syntax), lines));
        for draw in draws {
            out.push_str(&whole.setup(draw));
            out.push('\n');
            let named = NamedFunction { name: draw.name.clone(), about: draw.about.clone(), function: draw.function };
            out.push_str(&function(syntax, &named));
            out.push_str(&whole.row(draw));
        }
        Some(out)
    }

    fn whole_syntax(self) -> Option<(&'static dyn WholeSyntax, &'static dyn Syntax)> {
        Some(match self {
            Language::C99 => (&c::C99, &c::C99),
            Language::Glsl => (&glsl::Glsl, &glsl::Glsl),
            Language::Wgsl => (&wgsl::Wgsl, &wgsl::Wgsl),
            Language::Verilog => return None,
        })
    }

    /// Returns how a function of this language reads a constant of a triangle.
    pub fn field(self, field: Field) -> String {
        self.syntax().input(Input::Triangle(field))
    }
}

/// Prints what lines call, without the structures: functions of numbers, tables, helpers and coverage.
pub(crate) fn shared<'l, L: Iterator<Item = &'l Line>>(language: Language, lines: impl Fn() -> L) -> String {
    let both = language.whole_syntax();
    both.map_or_else(String::new, |(whole, syntax)| whole.functions("") + &calls((whole, syntax), lines) + "\n")
}

/// Prints tables, helpers and coverage.
fn calls<'l, L: Iterator<Item = &'l Line>>(
    (whole, syntax): (&dyn WholeSyntax, &'static dyn Syntax),
    lines: impl Fn() -> L,
) -> String {
    let mut out = String::new();
    let mut called: BTreeSet<Helper> = lines().filter_map(|line| line.operation.helper()).collect();
    let mut helpers = Vec::new();
    // A helper calls earlier ones.
    for helper in Helper::ALL.into_iter().rev() {
        if called.contains(&helper) {
            let (lines, result) = helper.lines();
            called.extend(lines.iter().filter_map(|line| line.operation.helper()));
            helpers.insert(0, (helper, (lines, result)));
        }
    }
    let mut tables: BTreeSet<Table> = lines().filter_map(|line| line.operation.table()).collect();
    tables.extend(helpers.iter().flat_map(|(_, (lines, _))| lines).filter_map(|line| line.operation.table()));
    for (name, table) in TABLES.into_iter().filter(|(_, table)| tables.contains(table)) {
        out.push_str(&whole.table(name, table));
    }
    for (helper, (lines, result)) in helpers {
        let body = Body::within(LONGEST, syntax, &lines, (&[result], &[]));
        out.push_str(&whole.helper(helper));
        out.push_str(&body.printed());
        out.push_str(&whole.result(body.operand(result, helper.kind()).open()));
    }
    let (lines, result) = coverage();
    let body = Body::within(LONGEST, syntax, &lines, (&[result], &[]));
    out + &whole.coverage(&body.printed(), &body.operand(result, Kind::Number).term())
}

impl Body<'_> {
    /// Converts a result's text to 64 bits, unless it has them.
    pub(crate) fn widened(&self, operand: Operand, text: String) -> String {
        if self.is_wide(operand) { text } else { self.syntax.widened(text) }
    }

    /// Returns the declarations as lines.
    pub(super) fn printed(&self) -> String {
        self.declarations.iter().map(|line| format!("    {line}\n")).collect()
    }
}
