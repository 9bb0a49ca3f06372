//! Findings as text with the offending lines and carets under the exact values.

use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

use super::diagnostic::{Diagnostic, Severity, Source, floor_boundary};

/// Longest excerpt of a line on either side of a mark, in bytes: scenes of one endless line stay readable.
const MARGIN: usize = 200;

/// Renders `diagnostics`, one after the other, a blank line between them.
pub fn render(diagnostics: &[Diagnostic], source: &Source, color: bool) -> String {
    let renderer = if color { Renderer::styled() } else { Renderer::plain() };
    let mut text = String::new();
    for (index, diagnostic) in diagnostics.iter().enumerate() {
        if index > 0 {
            text.push('\n');
        }
        text.push_str(&renderer.render(&[group(diagnostic, source)]));
        text.push('\n');
    }
    text
}

fn group<'a>(diagnostic: &'a Diagnostic, source: &'a Source) -> Group<'a> {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let mut group = Group::with_title(level.primary_title(diagnostic.message.as_str()).id(diagnostic.code));
    if let Some(span) = &diagnostic.span {
        let (line, column) = source.position(span.start);
        group = group
            .element(Origin::path(source.name.as_str()).line(line).char_column(column))
            .element(excerpt(source, span, &diagnostic.label, AnnotationKind::Primary));
        for (place, label) in &diagnostic.related {
            let (line, column) = source.position(place.start);
            group = group
                .element(Origin::path(source.name.as_str()).line(line).char_column(column))
                .element(excerpt(source, place, label, AnnotationKind::Context));
        }
    } else {
        group = group.element(Origin::path(source.name.as_str()));
    }
    if let Some(rule) = diagnostic.rule {
        group = group.element(Level::NOTE.message(format!("rule {rule} in docs/numerics.md")));
    }
    for note in &diagnostic.notes {
        group = group.element(Level::NOTE.message(note.as_str()));
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(help.as_str()));
    }
    group
}

/// The line around `span`; of a value of many lines, the first.
fn excerpt<'a>(
    source: &'a Source,
    span: &Range<usize>,
    label: &'a str,
    kind: AnnotationKind,
) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
    let text = &source.text;
    let start = floor_boundary(text, span.start);
    let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
    let line_end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
    let end = floor_boundary(text, span.end).clamp(start, line_end);
    let mark = text[start..end].trim_end().len();
    let from = floor_boundary(text, line_start.max(start.saturating_sub(MARGIN)));
    let to = floor_boundary(text, line_end.min((start + mark).saturating_add(MARGIN)));
    let shown = text[from..to].trim_end_matches('\r');
    let mark = start - from..(start - from + mark).min(shown.len());
    let (line, _) = source.position(start);
    let annotation = kind.span(mark).label((!label.is_empty()).then_some(label));
    Snippet::source(shown).line_start(line).annotation(annotation)
}
