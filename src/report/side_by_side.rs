//! Two traces of one pixel side by side.

use std::fmt::Write;

use similar::algorithms::{Capture, Compact, Replace, myers};
use similar::{DiffOp, DiffTag};

use super::text::{expression, graded, legend, step_value};
use ninebit::engine::{DrawTrace, PixelTrace};
use ninebit::shown;
use ninebit::trace::Step;

/// A line of two traces: a step of one of them, or of both.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SideBySideLine {
    /// The draw and the hardware block, if this line is their first.
    pub heading: Option<String>,
    /// Name of the step.
    pub name: String,
    /// Id of its rule; may be empty.
    pub rule: &'static str,
    /// Expression and integer in the first trace; `None` if it has no such step.
    pub first: Option<(String, String)>,
    /// Expression and integer in the second trace; `None` if it has no such step.
    pub second: Option<(String, String)>,
}

impl SideBySideLine {
    /// Returns whether the integers of the traces differ.
    pub fn differs(&self) -> bool {
        let integer = |side: &Option<(String, String)>| side.as_ref().map(|(_, integer)| integer.clone());
        integer(&self.first) != integer(&self.second)
    }
}

/// Aligns two traces of the same pixel, with steps of the same name on one line.
pub fn side_by_side(first: &PixelTrace, second: &PixelTrace) -> Vec<SideBySideLine> {
    let mut lines = Vec::new();
    let same = |a: &DrawTrace, b: &DrawTrace| (a.draw, a.triangle) == (b.draw, b.triangle);
    for draw in &first.draws {
        let other = second.draws.iter().find(|other| same(draw, other));
        draw_lines(&mut lines, draw, &draw.steps, other.map_or(&[][..], |other| &other.steps));
    }
    for draw in second.draws.iter().filter(|draw| !first.draws.iter().any(|other| same(draw, other))) {
        draw_lines(&mut lines, draw, &[], &draw.steps);
    }
    lines
}

fn draw_lines(lines: &mut Vec<SideBySideLine>, draw: &DrawTrace, first: &[Step], second: &[Step]) {
    let names = |steps: &[Step]| -> Vec<(String, String)> {
        steps.iter().map(|step| (step.block.clone(), step.name.clone())).collect()
    };
    let mut block: Option<String> = None;
    let mut line = |a: Option<&Step>, b: Option<&Step>| {
        let Some(step) = a.or(b) else { return };
        let heading = (block.as_deref() != Some(step.block.as_str())).then(|| {
            let draw = if block.is_none() { format!("draw {} `{}`: ", draw.draw, draw.name) } else { String::new() };
            format!("{draw}{}", step.block)
        });
        block = Some(step.block.clone());
        let side = |step: &Step| (expression(step), step_value(step));
        let (name, first, second) = (step.name.clone(), a.map(side), b.map(side));
        lines.push(SideBySideLine { heading, name, rule: step.rule, first, second });
    };
    for op in difference(&names(first), &names(second)) {
        let (tag, old, new) = op.as_tag_tuple();
        if tag == DiffTag::Equal {
            old.zip(new).for_each(|(a, b)| line(first.get(a), second.get(b)));
        } else {
            old.for_each(|n| line(first.get(n), None));
            new.for_each(|n| line(None, second.get(n)));
        }
    }
}

/// Returns the operations that make the second of the first. The algorithm is called by its name, because a choice at run time compiles them all.
fn difference<T: std::hash::Hash + Eq>(first: &[T], second: &[T]) -> Vec<DiffOp> {
    let mut operations = Compact::new(Replace::new(Capture::new()), first, second);
    let Ok(()) = myers::diff(&mut operations, first, 0..first.len(), second, 0..second.len());
    operations.into_inner().into_inner().into_ops()
}

/// Returns the lines as a text table. `titles` are the headings of the first and second trace. Lines that differ begin with `>`.
pub fn side_by_side_text(titles: [&str; 2], lines: &[SideBySideLine]) -> String {
    crate::written(|out| write(out, titles, lines))
}

fn write(out: &mut String, titles: [&str; 2], lines: &[SideBySideLine]) -> std::fmt::Result {
    let integer =
        |side: &Option<(String, String)>| side.as_ref().map_or("-".to_owned(), |(_, integer)| integer.clone());
    let widest = |f: &dyn Fn(&SideBySideLine) -> usize, least: usize| lines.iter().map(f).max().unwrap_or(0).max(least);
    let name = widest(&|line| line.name.chars().count(), 4);
    let a = widest(&|line| integer(&line.first).len(), titles[0].len());
    let b = widest(&|line| integer(&line.second).len(), titles[1].len());
    writeln!(out, "    {:name$}  {:>a$}  {:>b$}  {:11}how", "what", titles[0], titles[1], "rule")?;
    for line in lines {
        if let Some(heading) = &line.heading {
            writeln!(out, "  {}", shown::name(heading))?;
        }
        let mark = if line.differs() { '>' } else { ' ' };
        let how = match (&line.first, &line.second) {
            (Some((a, _)), Some((b, _))) if a != b && !(a.is_empty() && b.is_empty()) => format!("{a}   |   {b}"),
            (Some((how, _)), _) | (_, Some((how, _))) => how.clone(),
            _ => String::new(),
        };
        let row = format!(
            "  {mark} {:name$}  {:>a$}  {:>b$}  {:11}{how}",
            line.name,
            integer(&line.first),
            integer(&line.second),
            graded(line.rule)
        );
        writeln!(out, "{}", row.trim_end())?;
    }
    if lines.is_empty() { Ok(()) } else { writeln!(out, "{}", legend()) }
}
