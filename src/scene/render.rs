//! Renders findings as text, with the lines in question and carets under the values.

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use ninebit::place::Span;

use ninebit::diagnostic::{Diagnostic, Severity, Source, floor_boundary};
use ninebit::shown;

/// Longest excerpt of a long line on either side of a mark, in bytes, so that scenes of one endless line stay readable.
const MARGIN: usize = 200;
/// Distance from the start of a line, in bytes, up to which a mark is shown with the start of its line.
const LONG_LINE: usize = 1000;

/// Renders `diagnostics` one after the other, separated by blank lines.
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
    let source = diagnostic.file.as_ref().map_or(source, |file| &file.source);
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let mut group = Group::with_title(level.primary_title(shown::name(&diagnostic.message)).id(diagnostic.code));
    if let Some(span) = &diagnostic.span {
        let line = |place: &Span| source.position(place.start).0;
        let (beside, apart): (Vec<_>, Vec<_>) =
            diagnostic.related.iter().partition(|(place, _)| line(place) == line(span));
        group = excerpt(group, source, (span, &diagnostic.label), AnnotationKind::Primary, &beside);
        for (place, label) in apart {
            group = excerpt(group, source, (place, label), AnnotationKind::Context, &[]);
        }
    } else {
        group = group.element(Origin::path(shown::name(&source.name)));
    }
    if let Some(rule) = diagnostic.rule {
        group = group.element(Level::NOTE.message(format!("rule {rule}: `ninebit rule {rule}` prints it")));
    }
    for note in &diagnostic.notes {
        group = group.element(Level::NOTE.message(shown::name(note)));
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(shown::name(help)));
    }
    group
}

/// Adds the line around a place: the first line if the value has several. The places `beside` it are in the same line.
fn excerpt<'a>(
    group: Group<'a>,
    source: &'a Source,
    (span, label): (&Span, &'a str),
    kind: AnnotationKind,
    beside: &[&'a (Span, String)],
) -> Group<'a> {
    let text = &source.text;
    let start = floor_boundary(text, span.start);
    let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
    let line_end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
    let (line, column) = source.position(start);
    // The renderer counts columns from the start of its excerpt, so for a part of a long line the column is given explicitly.
    let whole = start - line_start <= LONG_LINE;
    let from = if whole { line_start } else { floor_boundary(text, start - MARGIN) };
    let last = beside.iter().map(|(place, _)| place.end).fold(span.end, usize::max).min(start + LONG_LINE);
    let to = floor_boundary(text, line_end.min(last + MARGIN));
    let part = text[from..to].trim_end_matches('\r');
    let mark = |place: &Span| {
        let begin = floor_boundary(part, place.start.saturating_sub(from));
        let end = floor_boundary(part, place.end.saturating_sub(from)).max(begin);
        begin..begin + part[begin..end].trim_end().len()
    };
    let annotate = |kind: AnnotationKind, place: &Span, label: &'a str| {
        kind.span(mark(place)).label((!label.is_empty()).then(|| shown::name(label)))
    };
    let snippet = Snippet::source(shown::excerpt(part))
        .line_start(line)
        .annotation(annotate(kind, span, label))
        .annotations(beside.iter().map(|(place, label)| annotate(AnnotationKind::Context, place, label)));
    if whole {
        group.element(snippet.path(shown::name(&source.name)))
    } else {
        group.element(Origin::path(shown::name(&source.name)).line(line).char_column(column)).element(snippet)
    }
}
