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
}

impl Language {
    /// Prints draws as functions from a pixel, its triangle and the memories of textures to the stored words. Returns `None` for Verilog, in which only
    /// the rules of a pixel's colours are printed.
    pub fn print_whole(self, draws: &[Draw<'_>]) -> Option<String> {
        let (whole, syntax): (&dyn WholeSyntax, &'static dyn Syntax) = match self {
            Language::C99 => (&c::C99, &c::C99),
            Language::Glsl => (&glsl::Glsl, &glsl::Glsl),
            Language::Wgsl => (&wgsl::Wgsl, &wgsl::Wgsl),
            Language::Verilog => return None,
        };
        let mut out = whole.whole_head();
        let lines = || draws.iter().flat_map(|draw| draw.function.lines.iter().chain(&draw.setup.lines));
        let helpers: BTreeSet<Helper> = lines().filter_map(|line| line.operation.helper()).collect();
        let tables: BTreeSet<Table> = lines().filter_map(|line| line.operation.table()).collect();
        for (name, table) in TABLES.into_iter().filter(|(_, table)| tables.contains(table)) {
            out.push_str(&whole.table(name, table));
        }
        for helper in Helper::ALL.into_iter().filter(|helper| helpers.contains(helper)) {
            let (lines, result) = helper.lines();
            let body = Body::within(LONGEST, syntax, &lines, (&[result], &[]));
            out.push_str(&whole.helper(helper));
            out.push_str(&body.printed());
            out.push_str(&whole.result(body.operand(result, helper.kind()).open()));
        }
        let (lines, result) = coverage();
        let body = Body::within(LONGEST, syntax, &lines, (&[result], &[]));
        out.push_str(&whole.coverage(&body.printed(), &body.operand(result, Kind::Number).term()));
        for draw in draws {
            out.push_str(&whole.setup(draw));
            out.push('\n');
            let named = Named { name: draw.name.clone(), about: draw.about.clone(), function: draw.function };
            out.push_str(&function(syntax, &named));
        }
        Some(out)
    }

    /// Returns how a function of this language reads a constant of a triangle.
    pub fn field(self, field: Field) -> String {
        self.syntax().input(Input::Triangle(field))
    }
}

impl Body<'_> {
    /// Returns the declarations as lines.
    pub(super) fn printed(&self) -> String {
        self.declarations.iter().map(|line| format!("    {line}\n")).collect()
    }
}
