//! Families: what several scenes share, in a file of its own, `family: "name.family.ron"`.
//!
//! The file's text is appended to the scene's, and both are read as one. Names, targets and truth of the family are then values like
//! any others. Findings about the second text are moved to the file.

use ninebit::place::Span;
use std::path::Path;
use std::sync::Arc;

use super::assets::Assets;
use super::fields as source;
use super::lower::{DrawSpans, VertexSpans, shared_text};
use super::raw::Raw;
use super::reader::Reader;
use ninebit::diagnostic::{Diagnostic, File, Source};
use ninebit::limits::Limits;

/// The file of a family, which has been read and is well formed.
pub(super) struct Family {
    /// Name of the file, as the scene writes it.
    name: String,
    file: Arc<File>,
}

/// Finds the family that a scene names; `None` if it names none. Errors of the scene itself are not reported here but when it is read.
///
/// # Errors
/// The findings about the family's file.
pub(super) fn find(
    text: &str,
    folder: &Path,
    limits: &Limits,
    assets: &dyn Assets,
) -> Result<Option<Family>, Vec<Diagnostic>> {
    // Most scenes have no family: this avoids reading them twice.
    if !text.contains("family") {
        return Ok(None);
    }
    let mut reader = Reader::new(text, folder, limits, assets);
    let scene = reader.check::<source::Scene<'_>>(text).and_then(|raw| reader.read(&raw));
    let named = scene.and_then(|scene| scene.family).filter(Raw::is_text);
    let Some(named) = named else { return Ok(None) };
    let Some(file) = shared_text(&mut reader, &named) else { return Err(reader.diagnostics) };
    let mut inside = Reader::new(&file.source.text, folder, limits, assets);
    if inside.check::<source::Family<'_>>(&file.source.text).and_then(|raw| inside.read(&raw)).is_none() {
        return Err(inside.diagnostics.into_iter().map(|finding| finding.inside(&file)).collect());
    }
    let name = reader.read(&named).unwrap_or_default();
    Ok(Some(Family { name, file }))
}

impl Family {
    /// Returns the text of the file.
    pub(super) fn text(&self) -> &str {
        &self.file.source.text
    }

    /// Returns the text of the file under the name that the scene gives it.
    pub(super) fn into_source(self) -> Source {
        Source { name: self.name, text: Arc::unwrap_or_clone(self.file).source.text }
    }

    /// Returns the text of the file, to be changed.
    pub(super) fn text_mut(&mut self) -> &mut String {
        &mut Arc::make_mut(&mut self.file).source.text
    }

    /// Turns a finding about the joined texts into one about the scene or about the family's file.
    pub(super) fn locate(&self, mut finding: Diagnostic, scene: &str) -> Diagnostic {
        let start = scene.len() + 1;
        if let Some(file) = &finding.file {
            // The finding is about a third file, which the family names.
            if file.named.start >= start {
                let named = self.file.named.clone();
                finding.file = Some(Arc::new(File { source: file.source.clone(), named }));
            }
            return finding;
        }
        let inside = finding.span.as_ref().is_some_and(|span| span.start >= start);
        let shift = |span: Span| span.start - start..span.end - start;
        for (span, label) in std::mem::take(&mut finding.related) {
            match (span.start >= start, inside) {
                (true, true) => finding.related.push((shift(span), label)),
                (false, false) => finding.related.push((span, label)),
                (true, false) => finding.notes.push(said(&self.file.source, shift(span).start, &label)),
                (false, true) => {
                    let scene = Source { name: "the scene".to_owned(), text: scene.to_owned() };
                    finding.notes.push(said(&scene, span.start, &label));
                }
            }
        }
        if inside {
            finding.span = finding.span.map(shift);
            finding = finding.inside(&self.file);
        }
        finding
    }

    /// Replaces places in the family by the place where the scene names the family.
    pub(super) fn keep_inside(&self, spans: &mut DrawSpans, scene: &str) {
        let keep = |span: &mut Span| {
            if span.start > scene.len() {
                *span = self.file.named.clone();
            }
        };
        match &mut spans.vertices {
            VertexSpans::Each(list) => list.iter_mut().for_each(keep),
            VertexSpans::All(span) => keep(span),
        }
    }
}

/// Writes a label and its place in another text in words.
fn said(source: &Source, at: usize, label: &str) -> String {
    let (line, column) = source.position(at);
    format!("{}:{line}:{column}: {label}", source.name)
}
