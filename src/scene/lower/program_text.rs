//! The text of a program: in the scene or in a file of its own, and where its bytes stand.

use std::path::Path;

use super::*;
use crate::literal::Literal;
use ninebit::diagnostic::{self, Source};
use ninebit::limits::FileLimit;
use ninebit_files::read::ReadError;
use ninebit_program::c_source::{Expanded, Style, expand};

/// A text and its places.
pub(super) struct ProgramText {
    pub(super) text: String,
    origin: Origin,
    /// Where the bytes of a text that was expanded stood before.
    before: Option<Vec<usize>>,
}

enum Origin {
    /// Bytes of the scene, one place for each byte of the text and one for its end.
    Scene(Vec<usize>),
    File(Arc<diagnostic::File>),
}

impl ProgramText {
    /// Reads `("...")` or `(file: "...")`. `None` once the reason has been recorded.
    pub(super) fn read<'a>(reader: &mut Reader<'a>, text: &'a str) -> Option<Self> {
        let inside = crate::notation::trim(text.strip_prefix('(').unwrap_or(text));
        let program =
            if Raw::<String>::new(inside).is_text() { inline(reader, text)? } else { from_file(reader, text)? };
        program.within_limit(reader)
    }

    /// A text that stands in the scene. `None` once the reason that it cannot be read has been recorded.
    pub(super) fn inline<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, String>) -> Option<Self> {
        literal(reader, raw)?.within_limit(reader)
    }

    /// A text in a file. `None` once the reason that it cannot be read has been recorded.
    pub(super) fn file<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, String>) -> Option<Self> {
        Self::file_up_to(reader, raw, reader.limits.program_file())
    }

    /// A text in a file that no scene names. `None` once the reason that it cannot be read has been recorded.
    pub(super) fn at(reader: &mut Reader<'_>, path: &Path) -> Option<Self> {
        let name = ninebit::shown::lossless(path);
        let file = text_at(reader, path, (&name, path), None, reader.limits.program_file())?;
        Some(ProgramText { text: file.source.text.clone(), origin: Origin::File(file), before: None })
    }

    /// The same of a file within a limit of its own.
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

    /// The text as the reader of a language takes it: out of C. `None` once the reason that it cannot be has been recorded.
    pub(super) fn expanded(self, reader: &mut Reader<'_>, style: Style) -> Option<Self> {
        match expand(&self.text, style, usize::try_from(reader.limits.program_bytes).unwrap_or(usize::MAX)) {
            Ok(None) => Some(self),
            Ok(Some(Expanded { text, places })) => Some(ProgramText { text, before: Some(places), ..self }),
            Err(finding) => reader.refuse(self.place(finding)),
        }
    }

    /// Where a part stood before the text was expanded.
    fn before(&self, part: Span) -> Span {
        let Some(places) = &self.before else { return part };
        let place = |at: usize| places.get(at).or(places.last()).copied().unwrap_or_default();
        let start = place(part.start);
        // Parts of what a name stands for are where the name is.
        start..place(part.end).max(start + usize::from(!part.is_empty()))
    }

    /// The place in the scene of a part of the text; of a file, where the scene names it.
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
        findings.into_iter().for_each(|finding| reader.push(self.place(finding)));
    }

    /// What was read of the text. `None` once the reasons that it cannot be read have been recorded.
    pub(super) fn parsed<T>(&self, reader: &mut Reader<'_>, read: Result<T, Vec<Diagnostic>>) -> Option<T> {
        read.map_err(|findings| self.push(reader, findings)).ok()
    }

    /// A finding about the text as one about the scene or the file.
    pub(super) fn place(&self, mut finding: Diagnostic) -> Diagnostic {
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

/// Findings about a text, which have their places in it, or about the scene.
pub(super) fn placed(text: Option<&ProgramText>, findings: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let place = |finding| if let Some(text) = text { text.place(finding) } else { finding };
    findings.into_iter().map(place).collect()
}

fn too_large(place: impl Into<Option<Span>>, most: FileLimit) -> Diagnostic {
    Diagnostic::error("NB0610", place, format!("this text is larger than {most}"))
        .label("too large")
        .help("`ninebit limits` prints what is allowed")
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
        // This says what is wrong.
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

fn from_file<'a>(reader: &mut Reader<'a>, text: &'a str) -> Option<ProgramText> {
    let fields = reader.read(&Raw::<source::ProgramFile<'a>>::new(text))?;
    let raw = fields.file(reader)?;
    ProgramText::file(reader, &raw)
}

/// A text in a file of the scene's folder, within a limit. `None` once the reason that it cannot be read has been recorded.
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

/// The text of a file, whose name is shown in short and in full. `named`: where the scene names it, if one does.
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
        Err(ReadError::TooLarge(most)) => {
            return reader.refuse(too_large(named, most));
        }
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
