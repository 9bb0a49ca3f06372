//! Reads raw values, gathers what is wrong with them, and says it in the words of the format.

use ninebit::place::Span;
use std::collections::HashMap;
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::Path;

use super::assets::Assets;
use super::diagnostic::{Diagnostic, needs_nv2a};
use super::names::{Names, Targets, Textures};
use super::notation::{Fault, FaultKind, Notation};
use super::raw::{Entries, Few, Numbers, Raw, Reserved, Tuple};
use super::source::{Expected, Mismatch};
use super::wording::{closest, describe, shorten, twice, words};
use ninebit::legality::texture::TextureChecks;
use ninebit::limits::Limits;
use ninebit::state::{Named, Profile};
use ninebit_program::finding;

/// A structure has no field of this name.
pub(super) const UNKNOWN: &str = "NB0201";
/// A field is missing that has no default.
pub(super) const MISSING: &str = "NB0202";
/// A field is given twice.
pub(super) const TWICE: &str = "NB0203";
/// A value is none of the words.
pub(super) const WORD: &str = "NB0204";
/// A value is of another kind.
pub(super) const KIND: &str = "NB0205";
/// A value is out of range.
pub(super) const RANGE: &str = "NB0206";
/// A number is not finite.
pub(super) const FINITE: &str = "NB0207";
/// There are too few values or too many.
pub(super) const COUNT: &str = "NB0211";

/// What a text stands for that needs nothing but itself.
pub(super) trait Valued<'a>: Sized {
    /// What is read of it.
    type Value;

    /// Reads it; `None` once the reason has been recorded.
    fn value(reader: &mut Reader<'a>, raw: &Raw<'a, Self>) -> Option<Self::Value>;
}

/// Findings beyond this many are only counted.
const MAX_DIAGNOSTICS: usize = 64;

/// The text under examination and the findings so far.
pub(super) struct Reader<'a> {
    pub(super) notation: Notation<'a>,
    pub(super) limits: &'a Limits,
    /// Where files come from.
    pub(super) assets: &'a dyn Assets,
    /// Set as soon as it is known; nv2a before, which allows more.
    pub(super) profile: Profile,
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) errors: usize,
    pub(super) suppressed: usize,
    /// Where the files lie that the scene names.
    pub(super) folder: &'a Path,
    /// Matrices inside each other, and names followed, so far.
    pub(super) depth: usize,
    pub(super) names: Names<'a>,
    pub(super) targets: Targets<'a>,
    pub(super) textures: Textures,
}

impl<'a> Reader<'a> {
    pub(super) fn new(text: &'a str, folder: &'a Path, limits: &'a Limits, assets: &'a dyn Assets) -> Self {
        Reader {
            notation: Notation::new(text),
            limits,
            assets,
            profile: Profile::Nv2a,
            diagnostics: Vec::new(),
            errors: 0,
            suppressed: 0,
            folder,
            depth: 0,
            names: Names::default(),
            targets: Targets::default(),
            textures: Textures::default(),
        }
    }

    pub(super) fn push(&mut self, diagnostic: Diagnostic) {
        let error = diagnostic.severity == super::Severity::Error;
        if error && self.errors == 0 {
            // Warnings come again when the errors are gone; until then they would only hide them.
            self.diagnostics.clear();
            self.suppressed = 0;
        }
        if !error && self.errors > 0 {
            return;
        }
        self.errors += usize::from(error);
        if self.diagnostics.len() < MAX_DIAGNOSTICS {
            self.diagnostics.push(diagnostic);
        } else {
            self.suppressed += 1;
        }
    }

    /// Records why there is no such value.
    pub(super) fn refuse<T>(&mut self, diagnostic: Diagnostic) -> Option<T> {
        self.push(diagnostic);
        None
    }

    /// Records what a check found. `None` if it found something.
    pub(super) fn accept(&mut self, finding: Option<Diagnostic>) -> Option<()> {
        finding.map_or(Some(()), |finding| self.refuse(finding))
    }

    /// What the chip and the limits take of textures.
    pub(super) fn texture_checks(&self) -> TextureChecks {
        TextureChecks { profile: self.profile, largest_side: self.limits.texture_side }
    }

    /// Whether a further error would only be counted: its words need not be chosen.
    pub(super) fn is_full(&self) -> bool {
        self.errors > 0 && self.diagnostics.len() >= MAX_DIAGNOSTICS
    }

    /// Where in the file a part of its text lies.
    pub(super) fn range(&self, part: &str) -> Span {
        self.notation.range(part)
    }

    pub(super) fn span<T>(&self, raw: &Raw<'a, T>) -> Span {
        self.range(raw.text)
    }

    /// Where a field stands, if it is written.
    pub(super) fn place<T>(&self, field: &Option<Raw<'a, T>>) -> Option<Span> {
        field.as_ref().map(|raw| self.span(raw))
    }

    /// Checks a part of the text. `None` once the reason has been recorded why it is not well formed.
    pub(super) fn check<T>(&mut self, text: &'a str) -> Option<Raw<'a, T>> {
        let checked = self.notation.check(self.range(text), self.limits.nesting);
        checked.map(Raw::new).map_err(|fault| self.push(self.syntax(fault))).ok()
    }

    /// Reads the value, which is known to be well formed; `None` once the reason has been recorded.
    pub(super) fn read<T: Expected<'a>>(&mut self, raw: &Raw<'a, T>) -> Option<T> {
        T::read(&self.notation, raw.text)
            .map_err(|mismatch| self.push(self.mismatch(raw.text, &mismatch, T::EXPECTED)))
            .ok()
    }

    /// Reads the value if it can be read; says nothing otherwise.
    pub(super) fn attempt<T: Expected<'a>>(&self, text: &'a str) -> Option<T> {
        T::read(&self.notation, text).ok()
    }

    /// What a value means that is needed on its own; `None` once the reason that it means nothing has been recorded.
    pub(super) fn value<T: Valued<'a>>(&mut self, raw: &Raw<'a, T>) -> Option<T::Value> {
        T::value(self, raw)
    }

    /// Reads something inside a value that may hold others of its kind.
    pub(super) fn deeper<T>(&mut self, read: impl FnOnce(&mut Self) -> T) -> T {
        self.depth += 1;
        let value = read(self);
        self.depth -= 1;
        value
    }

    /// The first character of a value, which stands for the whole.
    pub(super) fn opening(&self, text: &str) -> Span {
        self.range(text.get(..1).unwrap_or(text))
    }

    /// The value of a field that must be there.
    pub(super) fn required<T>(
        &mut self,
        raw: &Option<Raw<'a, T>>,
        field: &str,
        owner: &str,
        place: Span,
    ) -> Option<Raw<'a, T>> {
        if raw.is_none() {
            let message = format!("this {owner} has no `{field}`");
            let help = format!("add `{field}: ...`; it has no default");
            self.push(finding(MISSING, place, message, format!("`{field}` is missing"), help));
        }
        *raw
    }

    /// A name out of a state enumeration.
    pub(super) fn name<T: Named>(&mut self, raw: &Raw<'a, Name<T>>) -> Option<T> {
        let (head, rest) = raw.split();
        if let (Some(value), "") = (T::from_name(head), rest) {
            return Some(value);
        }
        self.unknown_variant(raw, &words(T::TYPE), T::NAMES)
    }

    /// Splits `Variant(...)`: the index in `variants`, and the text after the identifier. `None` once the reason has been
    /// recorded.
    pub(super) fn variant<T>(
        &mut self,
        raw: &Raw<'a, T>,
        what: &str,
        variants: &[&'static str],
    ) -> Option<(usize, &'a str)> {
        let (head, rest) = raw.split();
        match variants.iter().position(|variant| *variant == head) {
            Some(index) => Some((index, rest)),
            None => self.unknown_variant(raw, what, variants),
        }
    }

    /// [`variant`](Self::variant) where the first `plain` variants take nothing in parentheses.
    pub(super) fn variant_of<T>(
        &mut self,
        raw: &Raw<'a, T>,
        what: &str,
        variants: &[&'static str],
        plain: usize,
    ) -> Option<(usize, &'a str)> {
        let (index, rest) = self.variant(raw, what, variants)?;
        if index < plain && !rest.is_empty() {
            return self.unknown_variant(raw, what, variants);
        }
        Some((index, rest))
    }

    /// Which of some words a field is; the first if it is not written.
    pub(super) fn choice<T>(&mut self, raw: &Option<Raw<'a, T>>, what: &str, words: &[&'static str]) -> Option<usize> {
        raw.as_ref().map_or(Some(0), |raw| self.variant(raw, what, words).map(|(index, _)| index))
    }

    /// What a field is that may be left out. `None` where it is written, and wrong.
    pub(super) fn perhaps<T, U>(
        &mut self,
        field: &Option<Raw<'a, T>>,
        read: impl FnOnce(&mut Self, &Raw<'a, T>) -> Option<U>,
    ) -> Option<Option<U>> {
        field.as_ref().map_or(Some(None), |raw| read(self, raw).map(Some))
    }

    /// Records that the value is none of `known`.
    pub(super) fn unknown_variant<T, U>(&mut self, raw: &Raw<'a, T>, what: &str, known: &[&'static str]) -> Option<U> {
        let (head, rest) = raw.split();
        let list = quoted(known);
        let diagnostic = if head.is_empty() {
            Diagnostic::error(KIND, self.span(raw), format!("expected a {what}, found {}", describe(raw.text)))
                .label("wrong kind of value")
                .help(format!("write one of {list}"))
        } else if known.contains(&head) {
            Diagnostic::error(KIND, self.range(rest), format!("`{head}` takes nothing in parentheses"))
                .label("not expected here")
                .help(format!("write just `{head}`"))
        } else {
            let help = match closest(head, known.iter().copied()) {
                Some(name) => format!("did you mean `{name}`? All of them: {list}"),
                None => format!("write one of {list}"),
            };
            finding(WORD, self.range(head), format!("there is no {what} `{}`", shorten(head)), "not known", help)
        };
        self.refuse(diagnostic)
    }

    /// So many finite numbers in parentheses; those not written keep `defaults`.
    pub(super) fn numbers(
        &mut self,
        raw: &Raw<'a, Numbers>,
        what: &str,
        counts: RangeInclusive<usize>,
        defaults: [f32; 4],
    ) -> Option<[f32; 4]> {
        self.numbers_written(raw, what, counts, defaults).map(|(values, _)| values)
    }

    /// The same, and how many are written.
    pub(super) fn numbers_written(
        &mut self,
        raw: &Raw<'a, Numbers>,
        what: &str,
        counts: RangeInclusive<usize>,
        defaults: [f32; 4],
    ) -> Option<([f32; 4], usize)> {
        let (written, count) = if raw.is_text() {
            let (written, count) = self.value(raw)?;
            if !counts.contains(&count) {
                let (wanted, name) = (wanted(&counts), shorten(&self.read(&raw.as_other::<String>())?));
                let message = format!("{what} has {wanted} numbers, and the vector \"{name}\" has {count}");
                return self.refuse(Diagnostic::error(COUNT, self.span(raw), message).label("does not fit here"));
            }
            (written, count)
        } else if let Some(Few { values, count }) = self.attempt::<Numbers>(raw.text)
            && counts.contains(&count)
            && values.iter().all(|value| value.is_finite())
        {
            (values, count)
        } else {
            // Something is wrong: read it again, number by number, to find out which.
            let parts = self.read(&raw.as_other::<Tuple<'a, f32>>())?.0;
            if counts.contains(&parts.len()) {
                parts.iter().for_each(|part| _ = self.finite(part));
            } else {
                let (wanted, count) = (wanted(&counts), parts.len());
                let message = format!("{what} has {wanted} numbers, not {count}");
                let label = if count == 1 { "1 number".to_owned() } else { format!("{count} numbers") };
                self.push(Diagnostic::error(COUNT, self.span(raw), message).label(label));
            }
            return None;
        };
        let mut values = defaults;
        values[..count].copy_from_slice(&written[..count]);
        Some((values, count))
    }

    /// A number that is neither infinite nor NaN.
    pub(super) fn finite(&mut self, raw: &Raw<'a, f32>) -> Option<f32> {
        let value = self.read(raw)?;
        if value.is_finite() {
            return Some(value);
        }
        let message = if value.is_nan() { "NaN is not a position, colour or size" } else { "this number is infinite" };
        let help = "numbers are 32-bit floats: at most about 3.4e38 away from zero";
        self.refuse(finding(FINITE, self.span(raw), message, "not a finite number", help).rule("NUM-0"))
    }

    /// A number in `range`; `said` adds to the finding that it is not.
    pub(super) fn within<T: Valued<'a, Value = T> + PartialOrd + Display>(
        &mut self,
        raw: &Raw<'a, T>,
        what: &str,
        range: RangeInclusive<T>,
        said: impl FnOnce(Diagnostic) -> Diagnostic,
    ) -> Option<T> {
        let value = T::value(self, raw)?;
        if range.contains(&value) {
            return Some(value);
        }
        let finding = Diagnostic::error(RANGE, self.span(raw), format!("{what} cannot be {value}"));
        self.refuse(said(finding.label("out of range").help(format!("write {} to {}", range.start(), range.end()))))
    }

    /// A whole number from 1 to a limit; `code` is that of greater ones.
    pub(super) fn up_to(&mut self, raw: &Raw<'a, u32>, what: &str, limit: u32, code: &'static str) -> Option<u32> {
        let value = self.read(raw)?;
        if value <= limit {
            return self.within(raw, what, 1..=limit, |finding| finding);
        }
        let help = format!("write 1 to {limit}; `ninebit limits` prints what is allowed");
        self.refuse(finding(code, self.span(raw), format!("{what} is {value}; {limit} are allowed"), "too large", help))
    }

    /// As many flags in parentheses as `defaults` has; `counted` says how many of what, `said` adds to the finding that they are not.
    pub(super) fn flags<const N: usize>(
        &mut self,
        raw: &Raw<'a, Tuple<'a, bool>>,
        counted: &str,
        defaults: [bool; N],
        said: impl FnOnce(Diagnostic) -> Diagnostic,
    ) -> Option<[bool; N]> {
        let parts = self.read(raw)?.0;
        if parts.len() != N {
            let finding = Diagnostic::error(COUNT, self.span(raw), format!("{counted}, not {}", parts.len()));
            return self.refuse(said(finding.label(format!("{} here", parts.len()))));
        }
        let mut flags = defaults;
        for (flag, part) in flags.iter_mut().zip(&parts) {
            *flag = self.read(part).unwrap_or(*flag);
        }
        Some(flags)
    }

    /// Records that the format reserves something that is not built.
    pub(super) fn not_built(&mut self, span: Span, what: &str) {
        self.push(
            Diagnostic::error("NB0401", span, format!("not built yet: {what}"))
                .label("reserved for a later version")
                .note("the format reserves this so that it can be added without a change of version")
                .help("leave it out"),
        );
    }

    /// Refuses a field on NV10 that is written and `needs` NV2A: what it is, and the rule.
    pub(super) fn needs_nv2a<T>(
        &mut self,
        field: &Option<Raw<'a, T>>,
        needs: bool,
        code: &'static str,
        (what, rule): (&str, &'static str),
    ) {
        if let Some(raw) = field {
            self.accept(needs_nv2a(self.profile, needs, code, self.span(raw), what, rule));
        }
    }

    /// Refuses a field that is reserved.
    pub(super) fn reserve(&mut self, field: &Option<Raw<'a, Reserved>>, what: &str) {
        if let Some(raw) = field {
            self.not_built(self.span(raw), what);
        }
    }

    /// The entries of a table, without the ones whose key is wrong or was there before.
    pub(super) fn table<T>(&mut self, what: &str, field: &Option<Raw<'a, Entries<'a, T>>>) -> Vec<Entry<'a, T>> {
        self.tables(what, field, &None)
    }

    /// The entries of a table of the scene and of one that it shares with others.
    pub(super) fn tables<T>(
        &mut self,
        what: &str,
        own: &Option<Raw<'a, Entries<'a, T>>>,
        shared: &Option<Raw<'a, Entries<'a, T>>>,
    ) -> Vec<Entry<'a, T>> {
        let mut seen: HashMap<String, Span> = HashMap::new();
        let mut table = Vec::new();
        for (field, shared) in [(shared, true), (own, false)] {
            let Some(entries) = field.as_ref().and_then(|raw| self.read(raw)) else { continue };
            table.reserve(entries.0.len());
            for (key, value) in entries.0 {
                let place = self.span(&key);
                let Some(name) = self.read(&key) else { continue };
                if let Some(first) = seen.get(&name) {
                    self.push(twice(what, &name, place, first.clone()));
                } else {
                    seen.insert(name.clone(), place.clone());
                    table.push(Entry { name, place, value, shared });
                }
            }
        }
        table
    }

    /// Why a value is not what is expected, in the words of the format.
    fn mismatch(&self, text: &'a str, mismatch: &Mismatch<'a>, expected: &str) -> Diagnostic {
        let found = || format!("expected {expected}, found {}", describe(text));
        match mismatch {
            Mismatch::Kind => Diagnostic::error(KIND, self.range(text), found()).label("wrong kind of value"),
            Mismatch::Range => Diagnostic::error(RANGE, self.range(text), found()).label("out of range"),
            Mismatch::Unknown(field, known) => {
                let list = quoted(known);
                let help = match closest(field, known.iter().copied()) {
                    Some(name) => format!("did you mean `{name}`? Fields here: {list}"),
                    None => format!("fields here: {list}"),
                };
                Diagnostic::error(UNKNOWN, self.range(field), format!("there is no field `{}` here", shorten(field)))
                    .label("unknown field")
                    .help(help)
            }
            Mismatch::Twice(field) => {
                Diagnostic::error(TWICE, self.range(field), format!("`{}` is given twice", shorten(field)))
                    .label("again here")
                    .help("keep one of them")
            }
        }
    }

    /// An error of the notation itself.
    fn syntax(&self, Fault { kind, place }: Fault) -> Diagnostic {
        let at = shorten(&self.notation.text[place.clone()]);
        let examples = "see docs/scene-format.md for examples";
        let (message, help) = match &kind {
            FaultKind::Nesting => {
                let levels = self.limits.nesting;
                return Diagnostic::error(
                    "NB0602",
                    place,
                    format!("more than {levels} levels of brackets inside each other"),
                )
                .label("one level too many")
                .help("no part of a scene needs more than a dozen levels: look for brackets that were not closed");
            }
            FaultKind::Start => (
                "a scene starts with an opening parenthesis".into(),
                "write `(version: 1, profile: Nv2a, draws: [...])`",
            ),
            FaultKind::End(_) => ("the scene ends too early".into(), "close the brackets that are still open"),
            FaultKind::Comma => ("a comma or a closing bracket is missing".into(), "put a comma between the values"),
            FaultKind::Colon => {
                ("a colon is missing".into(), "write `field: value` in parentheses, `\"name\": value` in braces")
            }
            FaultKind::Close(b')') => {
                ("a closing `)` is missing".into(), "close the parenthesis, or put a comma before another value")
            }
            FaultKind::Close(b']') => {
                ("a closing `]` is missing".into(), "close the list, or put a comma before another value")
            }
            FaultKind::Close(_) => {
                ("a closing `}` is missing".into(), "close the table, or put a comma before another entry")
            }
            FaultKind::Quote => ("a closing quote is missing".into(), "end the text with `\"`"),
            FaultKind::Escape => {
                (format!("a text has no `{at}`"), "write `\\\\` for a backslash, or the text as `r\"...\"`")
            }
            FaultKind::Comment => ("a comment is not closed".into(), "end it with `*/`"),
            FaultKind::Trailing => (
                "something follows the end of the scene".into(),
                "a scene is one value in parentheses: look for a bracket that was closed too early",
            ),
            FaultKind::Character(c) => (format!("`{}` is not expected here", c.escape_debug()), examples),
            FaultKind::Extension => {
                (format!("there is no RON extension `{at}`"), "leave the `#![enable(...)]` line out")
            }
        };
        let label = if kind == FaultKind::Comma { "a comma before this?" } else { "here" };
        let finding = Diagnostic::error("NB0101", place, message).label(label).help(help);
        match kind {
            FaultKind::End(Some(open)) => finding.related(open..open + 1, "this bracket is still open"),
            _ => finding,
        }
    }
}

/// Words in backquotes, with commas between them.
pub(super) fn quoted(words: &[&str]) -> String {
    words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

/// "3", or "2 to 4".
fn wanted(counts: &RangeInclusive<usize>) -> String {
    let (least, most) = (counts.start(), counts.end());
    if least == most { format!("{most}") } else { format!("{least} to {most}") }
}

/// An entry of a table.
pub(super) struct Entry<'a, T> {
    pub(super) name: String,
    /// Of the name.
    pub(super) place: Span,
    pub(super) value: Raw<'a, T>,
    /// Other scenes may use it.
    pub(super) shared: bool,
}

/// Marks a value that is a name out of the state enumeration `T`.
pub(super) struct Name<T>(std::marker::PhantomData<fn() -> T>);

/// How much more of something there is than a limit allows.
pub(super) fn too_many(
    code: &'static str,
    place: Span,
    count: usize,
    what: &str,
    limit: &str,
    most: usize,
) -> Diagnostic {
    let message =
        format!("{count} {what} are {} more than the limit `{limit}` of {most} allows", count.saturating_sub(most));
    Diagnostic::error(code, place, message).label("too many").help("`ninebit limits` prints what is allowed")
}
