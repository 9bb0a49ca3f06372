//! Prints pieces as functions.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::pieces::{Case, Piece, mapped};
use super::text::Printer;
use crate::code::Kind;
use crate::language::Body;

/// Returns rules as a comment.
fn remark(rules: &str) -> String {
    if rules.is_empty() { String::new() } else { format!(" /* {rules} */") }
}

/// Length of lines that are filled with several statements.
pub(super) const FILLED: usize = 132;

/// Joins statements as long as they fit into a line.
fn filled(statements: Vec<String>) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for statement in statements {
        match lines.last_mut() {
            Some(last) if last.len() + statement.len() < FILLED => *last += &format!(" {statement}"),
            _ => lines.push(statement),
        }
    }
    lines
}

/// Returns the label of a case.
fn label(case: &Case) -> String {
    if case.value > 15 { format!("case {:#x}u:", case.value) } else { format!("case {}u:", case.value) }
}

/// Prints cases with the same statements, in one line if they fit.
fn dense_case(cases: &[&Case], statements: &[String], is_default: bool) -> String {
    let mut labels =
        filled(cases.iter().map(|case| label(case)).chain(is_default.then(|| "default:".to_string())).collect());
    let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    let names = names.iter().enumerate().filter(|(n, name)| !names[..*n].contains(name)).map(|(_, name)| *name);
    let names = format!("/* {} */", names.collect::<Vec<_>>().join(", "));
    let both = format!("{} {} break; {names}", labels.join(" "), statements.join(" "));
    if statements.len() <= 1 && both.len() < FILLED + 40 {
        return format!("    {both}\n");
    }
    labels.last_mut().into_iter().for_each(|last| *last += &format!(" {names}"));
    let mut out: String = labels.iter().map(|line| format!("    {line}\n")).collect();
    statements.iter().for_each(|line| _ = writeln!(out, "        {line}"));
    out + "        break;\n"
}

/// Prints pieces as functions.
pub(super) fn pieces_text(printer: &Printer<'_>, pieces: &[Piece]) -> String {
    pieces.iter().map(|piece| printer.piece(piece)).collect()
}

impl Printer<'_> {
    /// Prints a piece as a function.
    pub(super) fn piece(&self, piece: &Piece) -> String {
        let kind = match piece.kind {
            Kind::Binary => "@binary",
            Kind::Word => "@uint",
            Kind::Number if piece.is_wide() => "@long",
            Kind::Number => "@int",
        };
        let mut parameters: Vec<String> = piece.chooses.iter().map(|name| format!("@uint {name}")).collect();
        parameters.extend((!piece.parameters.is_empty()).then(|| piece.parameters.to_string()));
        let way = if piece.each.is_some() { "@both" } else { "@out" };
        parameters.extend(piece.array.iter().map(|array| format!("{way} {kind} {array}")));
        let yields = if piece.array.is_some() { "void" } else { kind };
        let mut out = format!("/* {} */\n@fn {yields} {}({})\n{{\n", piece.about, piece.name, parameters.join(", "));
        let is_one = piece.chooses.is_none();
        let place = |n: usize| match piece.array {
            Some(array) => {
                let index = if piece.each.is_some() { "c".to_string() } else { n.to_string() };
                format!("{}[{index}]", array.split('[').next().unwrap_or_default())
            }
            None if is_one => "return".to_string(),
            None => "result".to_string(),
        };
        if let Some(chooses) = piece.chooses {
            if piece.array.is_none() {
                let _ = writeln!(out, "    {kind} result;");
            }
            let _ = writeln!(out, "    switch ({chooses}) {{");
        }
        // Cases with equal code are printed together.
        let mut groups: Vec<(Vec<&Case>, Vec<String>)> = Vec::new();
        for case in &piece.cases {
            let lines = self.statements(piece, case, &place);
            match groups.iter_mut().find(|(_, known)| *known == lines) {
                Some((cases, _)) => cases.push(case),
                None => groups.push((vec![case], lines)),
            }
        }
        for (n, (cases, lines)) in groups.iter().enumerate() {
            if !is_one && self.is_dense() {
                out.push_str(&dense_case(cases, lines, n == 0));
                continue;
            }
            if !is_one {
                for case in cases {
                    let _ = writeln!(out, "    {} /* {} */", label(case), case.name);
                }
                if n == 0 {
                    out.push_str("    default:\n");
                }
            }
            let indent = if is_one { "    " } else { "        " };
            lines.iter().for_each(|line| _ = writeln!(out, "{indent}{line}"));
            if !is_one {
                out.push_str("        break;\n");
            }
        }
        if !is_one {
            out.push_str("    }\n");
            if piece.array.is_none() {
                out.push_str("    return result;\n");
            }
        }
        out + "}\n\n"
    }

    /// Prints the piece that maps inputs as a table.
    pub(super) fn table(&self, piece: &Piece) -> String {
        let rows = mapped(self.generic.policies);
        let mut out = format!(
            "/* {} Of each mapping its register's values -256 to 255. */\nstatic const int16_t nb_mapping[{}][512] = {{\n",
            piece.about,
            rows.len()
        );
        for (case, row) in piece.cases.iter().zip(rows) {
            let body = Body::from_lines(self.syntax, &case.lines, &case.results, &[]);
            let (_, rules) = body.result(case.results[0], piece.kind);
            let _ = writeln!(out, "    {{ /* {}{}{rules} */", case.name, if rules.is_empty() { "" } else { ": " });
            for line in row.chunks(32) {
                let numbers: Vec<String> = line.iter().map(i64::to_string).collect();
                let _ = writeln!(out, "        {},", numbers.join(", "));
            }
            out.push_str("    },\n");
        }
        out + "};\n\n"
    }

    /// Returns the statements of a case.
    fn statements(&self, piece: &Piece, case: &Case, place: &impl Fn(usize) -> String) -> Vec<String> {
        let body = Body::within(self.longest, self.syntax, &case.lines, (&case.results, &[]));
        let declares = !body.declarations.is_empty() && piece.chooses.is_some();
        let mut inner: Vec<String> = body.declarations.clone();
        let (mut results, mut all_rules) = (Vec::new(), BTreeSet::new());
        for (n, result) in case.results.iter().enumerate() {
            let (value, rules) = body.result(*result, piece.kind);
            let value = if piece.is_wide() { body.widened(*result, value) } else { value };
            let equals = if piece.array.is_none() && piece.chooses.is_none() { "" } else { " =" };
            // A value that does not change needs no assignment.
            if place(n) == value {
                continue;
            }
            let comment = if self.is_dense() { String::new() } else { remark(&rules) };
            results.push(format!("{}{equals} {value};{comment}", place(n)));
            all_rules.extend(rules.split(", ").filter(|rule| !rule.is_empty()).map(str::to_string));
        }
        if self.is_dense() {
            let rules: Vec<String> = all_rules.into_iter().collect();
            results = filled(results);
            results.last_mut().into_iter().for_each(|last| last.push_str(&remark(&rules.join(", "))));
        }
        inner.extend(results);
        let block = |lines: &[String], out: &mut Vec<String>| {
            if declares {
                out.push("{".to_string());
                out.extend(lines.iter().map(|line| format!("    {line}")));
                out.push("}".to_string());
            } else {
                out.extend(lines.iter().cloned());
            }
        };
        let mut out: Vec<String> = Vec::new();
        match piece.each {
            Some(count) => (0..count).for_each(|c| {
                let lines: Vec<String> = inner.iter().map(|line| line.replace("[c]", &format!("[{c}]"))).collect();
                block(&lines, &mut out);
            }),
            None => block(&inner, &mut out),
        }
        out
    }
}
