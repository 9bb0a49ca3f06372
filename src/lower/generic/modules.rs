//! Prints each step of a pixel as a Verilog module, which computes all cases in parallel and selects one by the field.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::Generic;
use super::pieces::{Case, Piece, pieces, range};
use crate::code::Operation;
use crate::input::Local;
use crate::language::{Body, Language, ROUNDING, port};

pub(super) fn verilog(generic: &Generic) -> String {
    let mut out = ROUNDING.map(|line| format!("// {line}\n")).concat();
    out.push_str("// A module for each step of a pixel. What chooses a case is the field of the register's word.\n");
    // Pieces for three channels are left out: a user instantiates the module of one channel three times.
    for piece in pieces(generic.policies).iter().filter(|piece| piece.each.is_none()) {
        out.push('\n');
        out.push_str(&module(piece));
    }
    out
}

/// Returns the local inputs of a case, in the order in which it reads them.
fn locals(case: &Case) -> impl Iterator<Item = Local> {
    case.lines.iter().filter_map(|line| match line.operation {
        Operation::Input(crate::Input::Local(local)) => Some(local),
        _ => None,
    })
}

fn module(piece: &Piece) -> String {
    let syntax = Language::Verilog.syntax();
    let array = piece.array.map(|array| array.split('[').next().unwrap_or(array));
    // Each value of an array has a port.
    let result = |n: usize| array.map_or_else(|| "result".to_string(), |array| format!("{array}{n}"));
    let results = piece.cases.first().map_or(0, |case| case.results.len());
    let locals: BTreeSet<Local> = piece.cases.iter().flat_map(locals).collect();
    let most = piece.cases.iter().map(|case| case.value).max().unwrap_or(0);
    let bits = 32 - most.leading_zeros().min(31);
    let mut ports: Vec<String> = piece.chooses.iter().map(|name| format!("input [{}:0] {name}", bits - 1)).collect();
    ports.extend(
        locals.iter().map(|local| {
            format!("input {} {}", port(local.kind, local.range), syntax.input(crate::Input::Local(*local)))
        }),
    );
    let wide = port(piece.kind, range(&piece.cases));
    ports.extend((0..results).map(|n| format!("output {wide} {}", result(n))));
    let mut out = format!("// {}\nmodule {} (\n    {}\n);\n", piece.about, piece.name, ports.join(",\n    "));
    for case in &piece.cases {
        let body = Body::from_lines(syntax, &case.lines, &case.results, &[]);
        let name = if case.name.is_empty() { String::new() } else { format!(" // {}", case.name) };
        let _ = writeln!(out, "    generate if (1) begin : case_{:x}{name}", case.value);
        body.declarations.iter().for_each(|line| _ = writeln!(out, "        {line}"));
        for (n, one) in case.results.iter().enumerate() {
            let (value, rules) = body.result(*one, piece.kind);
            let rules = if rules.is_empty() { String::new() } else { format!(" // {rules}") };
            let _ = writeln!(out, "        wire {wide} yields{n} = {value};{rules}");
        }
        out.push_str("    end endgenerate\n");
    }
    for n in 0..results {
        let mut chosen = String::new();
        // As in the other languages, the first case also stands for every other code.
        for case in piece.cases.iter().skip(1) {
            if let Some(name) = piece.chooses {
                let _ = write!(chosen, "{name} == {bits}'h{:x} ? case_{:x}.yields{n} : ", case.value, case.value);
            }
        }
        let first = piece.cases.first().map_or(0, |case| case.value);
        let _ = writeln!(out, "    assign {} = {chosen}case_{first:x}.yields{n};", result(n));
    }
    out + "endmodule\n"
}
