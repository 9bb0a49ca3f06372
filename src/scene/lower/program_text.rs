//! Reads the text of a program, in the scene or in a file of its own, and keeps the places of its bytes.

use std::path::Path;

use super::*;
use crate::literal::Literal;
use ninebit::diagnostic::{self, Source};
use ninebit::limits::FileLimit;
use ninebit_files::read::ReadError;
use ninebit_program::c_source::{Expansion, Style, expand};

/// The text of a program with its places.
pub(super) struct ProgramText {
    pub(super) text: String,
    origin: Origin,
    /// If the text was expanded, the place of each byte before that.
    before: Option<Vec<usize>>,
}

enum Origin {
    /// The text is in the scene: one place for each byte of the text, and one for its end.
    Scene(Vec<usize>),
    File(Arc<diagnostic::File>),
}

impl ProgramText {
    /// Reads `("...")` or `(file: "...")`. Returns `None` after recording what is wrong.
    pub(super) fn read<'a>(reader: &mut Reader<'a>, text: &'a str) -> Option<Self> {
        let inside = crate::notation::trim(text.strip_prefix('(').unwrap_or(text));
        if Raw::<String>::new(inside).is_text() {
            return inline(reader, text)?.within_limit(reader);
        }
        let fields = reader.read(&Raw::<source::ProgramFile<'a>>::new(text))?;
        let raw = fields.file(reader)?;
        Self::file(reader, &raw)
    }

    /// Reads a text in the scene. Returns `None` after recording what is wrong.
    pub(super) fn inline<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, String>) -> Option<Self> {
        literal(reader, raw)?.within_limit(reader)
    }

    /// Reads a text from a file. Returns `None` after recording what is wrong.
    pub(super) fn file<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, String>) -> Option<Self> {
        Self::file_up_to(reader, raw, reader.limits.program_file())
    }

    /// Reads a text from a file that no scene names. Returns `None` after recording what is wrong.
    pub(super) fn at(reader: &mut Reader<'_>, path: &Path) -> Option<Self> {
        let name = ninebit::shown::lossless(path);
        let file = text_at(reader, path, (&name, path), None, reader.limits.program_file())?;
        Some(ProgramText { text: file.source.text.clone(), origin: Origin::File(file), before: None })
    }

    /// Reads a text from a file with its own limit. Returns `None` after recording what is wrong.
    pub(super) fn file_up_to<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, String>, most: FileLimit) -> Option<Self> {
        let file = text_file(reader, raw, most)?;
        Some(ProgramText { text: file.source.text.clone(), origin: Origin::File(file), before: None })
    }

    fn within_limit(self, reader: &mut Reader<'_>) -> Option<Self> {
        let most = reader.limits.program_file();
        if self.text.len() as u64 > most.bytes {
            return reader.refuse(too_large(self.span(0..0), most));
        }
        Some(self)
    }

    /// Extracts the text that a language's reader takes from C source. Returns `None` after recording what is wrong.
    pub(super) fn expanded(self, reader: &mut Reader<'_>, style: Style) -> Option<Self> {
        match expand(&self.text, style, usize::try_from(reader.limits.program_bytes).unwrap_or(usize::MAX)) {
            Ok(None) => Some(self),
            Ok(Some(Expansion { text, places })) => Some(ProgramText { text, before: Some(places), ..self }),
            Err(finding) => reader.refuse(self.locate(finding)),
        }
    }

    /// Returns the place of a part before the text was expanded.
    fn before(&self, part: Span) -> Span {
        let Some(places) = &self.before else { return part };
        let place = |at: usize| places.get(at).or(places.last()).copied().unwrap_or_default();
        let start = place(part.start);
        // The replacement of a name has the place of the name.
        start..place(part.end).max(start + usize::from(!part.is_empty()))
    }

    /// Returns the place of a part in the scene; for a text in a file, the place where the scene names the file.
    pub(super) fn span(&self, part: Span) -> Span {
        let part = self.before(part);
        match &self.origin {
            Origin::Scene(places) => {
                let place = |at: usize| places.get(at).or(places.last()).copied().unwrap_or_default();
                place(part.start)..place(part.end)
            }
            Origin::File(file) => file.named.clone(),
        }
    }

    /// Records findings about the text.
    pub(super) fn push(&self, reader: &mut Reader<'_>, findings: Vec<Diagnostic>) {
        findings.into_iter().for_each(|finding| reader.push(self.locate(finding)));
    }

    /// Unwraps what was read from the text. Returns `None` after recording the findings.
    pub(super) fn parsed<T>(&self, reader: &mut Reader<'_>, read: Result<T, Vec<Diagnostic>>) -> Option<T> {
        read.map_err(|findings| self.push(reader, findings)).ok()
    }

    /// Turns a finding about the text into one about the scene or the file.
    pub(super) fn locate(&self, mut finding: Diagnostic) -> Diagnostic {
        if let Origin::File(file) = &self.origin {
            finding.span = finding.span.map(|span| self.before(span));
            for (span, _) in &mut finding.related {
                *span = self.before(span.clone());
            }
            return finding.inside(file);
        }
        finding.span = finding.span.map(|span| self.span(span));
        for (span, _) in &mut finding.related {
            *span = self.span(span.clone());
        }
        finding
    }
}

/// Turns findings about a text, if there is one, into findings about the scene or a file.
pub(super) fn placed(text: Option<&ProgramText>, findings: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let place = |finding| if let Some(text) = text { text.locate(finding) } else { finding };
    findings.into_iter().map(place).collect()
}

fn too_large(place: impl Into<Option<Span>>, most: FileLimit) -> Diagnostic {
    let help = "`ninebit limits` prints what is allowed";
    finding("NB0610", place, format!("this text is larger than {most}"), "too large", help)
}

fn inline<'a>(reader: &mut Reader<'a>, text: &'a str) -> Option<ProgramText> {
    let list = Raw::<Tuple<'a, String>>::new(text);
    let parts = reader.read(&list)?.0;
    let [raw] = parts[..] else {
        let help = "write `(\"...\")`, `(r#\"...\"#)` for a text of many lines, or `(file: \"name\")`";
        return reader.refuse(finding("NB0211", reader.span(&list), "a program is one text", "here", help));
    };
    literal(reader, &raw)
}

fn literal<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, String>) -> Option<ProgramText> {
    let Some(literal) = Literal::from_text(raw.text) else {
        // This records what is wrong.
        reader.read(raw)?;
        return None;
    };
    let start = reader.span(raw).start;
    let (mut text, mut places) = (String::new(), Vec::new());
    for (character, place) in literal.characters() {
        text.push(character);
        places.extend(std::iter::repeat_n(start + place, character.len_utf8()));
    }
    places.push(start + literal.end());
    Some(ProgramText { text, origin: Origin::Scene(places), before: None })
}

/// Reads a text from a file in the scene's folder, within a limit. Returns `None` after recording what is wrong.
pub(super) fn text_file<'a>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, String>,
    most: FileLimit,
) -> Option<Arc<diagnostic::File>> {
    let name = reader.read(raw)?;
    let named = reader.span(raw);
    match reader.assets.resolve(reader.folder, &name) {
        Ok(path) => {
            let whole = reader.folder.join(&name);
            text_at(reader, &path, (&name, &whole), Some(named), most)
        }
        Err(error) => reader.refuse(finding(error.code(), named, error.to_string(), "this file", error.help())),
    }
}

/// Reads the text of a file. `name` is its name in messages, `shown` its full name, and `named` the place where the scene names it, if it does.
fn text_at(
    reader: &mut Reader<'_>,
    path: &Path,
    (name, shown): (&str, &Path),
    named: Option<Span>,
    most: FileLimit,
) -> Option<Arc<diagnostic::File>> {
    let refuse = |code, message: String, help: &str| finding(code, named.clone(), message, "this file", help);
    let bytes = match reader.assets.bytes(path, most) {
        Ok(bytes) => bytes,
        Err(ReadError::TooLarge(most)) => return reader.refuse(too_large(named, most)),
        Err(ReadError::Missing) => {
            let message = format!("`{}` does not exist", shorten(name));
            return reader.refuse(refuse("NB0502", message, "check the spelling and the folder"));
        }
        Err(error) => {
            let message = format!("`{}` cannot be read: {error}", shorten(name));
            return reader.refuse(refuse("NB0540", message, "name a regular file that may be read"));
        }
    };
    let Ok(text) = String::from_utf8(bytes) else {
        let message = format!("`{}` is not UTF-8 text", shorten(name));
        return reader.refuse(refuse("NB0541", message, "save the file as UTF-8"));
    };
    let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
    let source = Source { name: ninebit::shown::lossless(shown), text };
    Some(Arc::new(diagnostic::File { source, named: named.unwrap_or_default() }))
}
