//! Reads raw values, collects what is wrong with them, and reports it in the terms of the format.

mod syntax;

use ninebit::place::Span;
use ninebit::shown;
use std::collections::HashMap;
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::Path;

use super::assets::Assets;
use super::diagnostic::{Diagnostic, needs_nv2a};
use super::names::{Names, Targets, Textures};
use super::notation::Notation;
use super::raw::{Entries, Few, Numbers, Raw, ReservedValue, Tuple};
use super::source::{FromSource, Mismatch};
use super::wording::{closest, describe, shorten, twice, words};
use ninebit::legality::texture::TextureChecks;
use ninebit::limits::Limits;
use ninebit::state::{Named, Profile};
use ninebit_program::finding;

/// Code of an unknown field.
pub(super) const UNKNOWN: &str = "NB0201";
/// Code of a missing field that has no default.
pub(super) const MISSING: &str = "NB0202";
/// Code of a field that is given twice.
pub(super) const TWICE: &str = "NB0203";
/// Code of an unknown word.
pub(super) const WORD: &str = "NB0204";
/// Code of a value of the wrong kind.
pub(super) const KIND: &str = "NB0205";
/// Code of a value that is out of range.
pub(super) const RANGE: &str = "NB0206";
/// Code of a number that is not finite.
pub(super) const FINITE: &str = "NB0207";
/// Code of too few or too many values.
pub(super) const COUNT: &str = "NB0211";

/// A type whose values can be read without the context of a draw.
pub(super) trait PlainValue<'a>: Sized {
    /// What a value is read as.
    type Value;

    /// Reads the value. Returns `None` after recording what is wrong.
    fn value(reader: &mut Reader<'a>, raw: &Raw<'a, Self>) -> Option<Self::Value>;
}

/// Number of findings that are kept; further ones are only counted.
const MAX_DIAGNOSTICS: usize = 64;

/// The text that is read, and the findings so far.
pub(super) struct Reader<'a> {
    pub(super) notation: Notation<'a>,
    pub(super) limits: &'a Limits,
    /// Source of the files that the scene names.
    pub(super) assets: &'a dyn Assets,
    /// The scene's profile. Before that has been read it is NV2A, which allows more.
    pub(super) profile: Profile,
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) errors: usize,
    pub(super) suppressed: usize,
    /// Folder of the files that the scene names.
    pub(super) folder: &'a Path,
    /// Current nesting of matrices and of names that stand for others.
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
            // Warnings are repeated once the errors are mended; until then they would only hide them.
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

    /// Records a finding and returns `None`.
    pub(super) fn refuse<T>(&mut self, diagnostic: Diagnostic) -> Option<T> {
        self.push(diagnostic);
        None
    }

    /// Records a finding if there is one. Returns `None` if so.
    pub(super) fn accept(&mut self, finding: Option<Diagnostic>) -> Option<()> {
        finding.map_or(Some(()), |finding| self.refuse(finding))
    }

    /// Returns the checks of textures for the profile and the limits.
    pub(super) fn texture_checks(&self) -> TextureChecks {
        TextureChecks { profile: self.profile, largest_side: self.limits.texture_side }
    }

    /// Returns whether a further error would only be counted, so that its message need not be made.
    pub(super) fn is_full(&self) -> bool {
        self.errors > 0 && self.diagnostics.len() >= MAX_DIAGNOSTICS
    }

    /// Returns the place of a slice of the text.
    pub(super) fn range(&self, part: &str) -> Span {
        self.notation.range(part)
    }

    pub(super) fn span<T>(&self, raw: &Raw<'a, T>) -> Span {
        self.range(raw.text)
    }

    /// Returns the place of a field, if it is written.
    pub(super) fn place<T>(&self, field: &Option<Raw<'a, T>>) -> Option<Span> {
        field.as_ref().map(|raw| self.span(raw))
    }

    /// Checks that a part of the text is well formed. Returns `None` after recording where it is not.
    pub(super) fn check<T>(&mut self, text: &'a str) -> Option<Raw<'a, T>> {
        let checked = self.notation.check(self.range(text), self.limits.nesting);
        checked.map(Raw::new).map_err(|fault| self.push(self.syntax(fault))).ok()
    }

    /// Reads a value that is well formed. Returns `None` after recording what is wrong.
    pub(super) fn read<T: FromSource<'a>>(&mut self, raw: &Raw<'a, T>) -> Option<T> {
        let said = |reader: &Self, mismatch: &Mismatch<'a>| {
            let finding = reader.mismatch(raw.text, mismatch, T::EXPECTED);
            match T::meant(raw.text).filter(|_| matches!(mismatch, Mismatch::Kind)) {
                Some(meant) => finding.help(meant),
                None => finding,
            }
        };
        match T::read(&self.notation, raw.text) {
            Ok(value) => {
                for fault in value.faults() {
                    let finding = said(self, fault);
                    self.push(finding);
                }
                Some(value)
            }
            Err(mismatch) => {
                let finding = said(self, &mismatch);
                self.refuse(finding)
            }
        }
    }

    /// Reads a value if possible; records nothing.
    pub(super) fn attempt<T: FromSource<'a>>(&self, text: &'a str) -> Option<T> {
        T::read(&self.notation, text).ok()
    }

    /// Reads a value that needs no further context. Returns `None` after recording what is wrong.
    pub(super) fn value<T: PlainValue<'a>>(&mut self, raw: &Raw<'a, T>) -> Option<T::Value> {
        T::value(self, raw)
    }

    /// Reads something one level deeper in a value that may contain others of its kind.
    pub(super) fn deeper<T>(&mut self, read: impl FnOnce(&mut Self) -> T) -> T {
        self.depth += 1;
        let value = read(self);
        self.depth -= 1;
        value
    }

    /// Returns the place of a value's first character, which stands for the whole value in messages.
    pub(super) fn opening(&self, text: &str) -> Span {
        self.range(text.get(..1).unwrap_or(text))
    }

    /// Returns the value of a field that has to be written, after recording a finding if it is not.
    pub(super) fn required<T>(
        &mut self,
        raw: &Option<Raw<'a, T>>,
        field: &str,
        owner: &str,
        place: Span,
        faults: &[Mismatch<'a>],
    ) -> Option<Raw<'a, T>> {
        // An unknown field beside it may be this one, misspelt.
        if raw.is_none() && faults.is_empty() {
            let message = format!("this {owner} has no `{field}`");
            let help = format!("add `{field}: ...`; it has no default");
            self.push(finding(MISSING, place, message, format!("`{field}` is missing"), help));
        }
        *raw
    }

    /// Reads the name of a value of a state enumeration.
    pub(super) fn name<T: Named>(&mut self, raw: &Raw<'a, Name<T>>) -> Option<T> {
        let (head, rest) = raw.split();
        if let (Some(value), "") = (T::from_name(head), rest) {
            return Some(value);
        }
        self.unknown_variant(raw, &words(T::TYPE), T::NAMES)
    }

    /// Splits `Variant(...)`. Returns the index of the variant in `variants` and the text after it, or `None` after recording that it is not
    /// one of them.
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

    /// Splits `Variant(...)` like [`variant`](Self::variant), but refuses parentheses after the first `plain` variants.
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

    /// Returns the index of a field's word in `words`: the first if the field is not written.
    pub(super) fn choice<T>(&mut self, raw: &Option<Raw<'a, T>>, what: &str, words: &[&'static str]) -> Option<usize> {
        raw.as_ref().map_or(Some(0), |raw| self.variant(raw, what, words).map(|(index, _)| index))
    }

    /// Reads an optional field. Returns `Some(None)` if it is not written, and `None` if it is wrong.
    pub(super) fn perhaps<T, U>(
        &mut self,
        field: &Option<Raw<'a, T>>,
        read: impl FnOnce(&mut Self, &Raw<'a, T>) -> Option<U>,
    ) -> Option<Option<U>> {
        field.as_ref().map_or(Some(None), |raw| read(self, raw).map(Some))
    }

    /// Records that a value is none of `known`.
    pub(super) fn unknown_variant<T, U>(&mut self, raw: &Raw<'a, T>, what: &str, known: &[&'static str]) -> Option<U> {
        let (head, rest) = raw.split();
        let list = quoted(known);
        let diagnostic = if head.is_empty() {
            let message = format!("expected {}, found {}", shown::a(what), describe(raw.text));
            finding(KIND, self.span(raw), message, "wrong kind of value", format!("write one of {list}"))
        } else if known.contains(&head) {
            let message = format!("`{head}` takes nothing in parentheses");
            finding(KIND, self.range(rest), message, "not expected here", format!("write just `{head}`"))
        } else {
            let help = match closest(head, known.iter().copied()) {
                Some(name) => format!("did you mean `{name}`? All of them: {list}"),
                None => format!("write one of {list}"),
            };
            finding(WORD, self.range(head), format!("there is no {what} `{}`", shorten(head)), "not known", help)
        };
        self.refuse(diagnostic)
    }

    /// Reads finite numbers in parentheses. Their number has to be in `counts`; numbers that are not written keep `defaults`.
    pub(super) fn numbers(
        &mut self,
        raw: &Raw<'a, Numbers>,
        what: &str,
        counts: RangeInclusive<usize>,
        defaults: [f32; 4],
    ) -> Option<[f32; 4]> {
        self.numbers_written(raw, what, counts, defaults).map(|(values, _)| values)
    }

    /// Reads numbers like [`numbers`](Self::numbers). Also returns how many are written.
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
            // Something is wrong: the numbers are read again one by one to find out which.
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

    /// Reads a number that is neither infinite nor NaN.
    pub(super) fn finite(&mut self, raw: &Raw<'a, f32>) -> Option<f32> {
        let value = self.read(raw)?;
        if value.is_finite() {
            return Some(value);
        }
        let message = if value.is_nan() { "NaN is not a position, colour or size" } else { "this number is infinite" };
        let help = "numbers are 32-bit floats: at most about 3.4e38 away from zero";
        self.refuse(finding(FINITE, self.span(raw), message, "not a finite number", help).rule("NUM-0"))
    }

    /// Reads a number in `range`; `said` adds to the finding that it is outside.
    pub(super) fn within<T: PlainValue<'a, Value = T> + PartialOrd + Display>(
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
        let help = format!("write {} to {}", range.start(), range.end());
        self.refuse(said(finding(RANGE, self.span(raw), format!("{what} cannot be {value}"), "out of range", help)))
    }

    /// Reads a whole number from 1 to `limit`; `code` is the code of numbers beyond it.
    pub(super) fn up_to(&mut self, raw: &Raw<'a, u32>, what: &str, limit: u32, code: &'static str) -> Option<u32> {
        let value = self.read(raw)?;
        if value <= limit {
            return self.within(raw, what, 1..=limit, |finding| finding);
        }
        let help = format!("write 1 to {limit}; `ninebit limits` prints what is allowed");
        self.refuse(finding(code, self.span(raw), format!("{what} is {value}; {limit} are allowed"), "too large", help))
    }

    /// Reads as many flags in parentheses as `defaults` has. `counted` is the message for another number of flags; `said` adds to the finding.
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

    /// Records that the format reserves something that is not implemented.
    pub(super) fn not_built(&mut self, span: Span, what: &str) {
        let (message, label) = (format!("not built yet: {what}"), "reserved for a later version");
        let note = "the format reserves this so that it can be added without a change of version";
        self.push(finding("NB0401", span, message, label, "leave it out").note(note));
    }

    /// Refuses a field that is written on NV10 if it `needs` NV2A. `what` is its name in the message.
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

    /// Refuses a reserved field.
    pub(super) fn reserve(&mut self, field: &Option<Raw<'a, ReservedValue>>, what: &str) {
        if let Some(raw) = field {
            self.not_built(self.span(raw), what);
        }
    }

    /// Reads the entries of a table, except those whose key is wrong or occurred before.
    pub(super) fn table<T>(&mut self, what: &str, field: &Option<Raw<'a, Entries<'a, T>>>) -> Vec<Entry<'a, T>> {
        self.tables(what, field, &None)
    }

    /// Reads the entries of a table of the scene, and of one that it shares with other scenes.
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
}

/// Returns words in backquotes, separated by commas.
pub(super) fn quoted(words: &[&str]) -> String {
    words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

/// Writes a range of counts: "3", or "2 to 4".
fn wanted(counts: &RangeInclusive<usize>) -> String {
    let (least, most) = (counts.start(), counts.end());
    if least == most { format!("{most}") } else { format!("{least} to {most}") }
}

/// An entry of a table.
pub(super) struct Entry<'a, T> {
    pub(super) name: String,
    /// Place of the name.
    pub(super) place: Span,
    pub(super) value: Raw<'a, T>,
    /// Whether the entry comes from a table that other scenes may use.
    pub(super) shared: bool,
}

/// A value that is the name of a `T`, which is a state enumeration.
pub(super) struct Name<T>(std::marker::PhantomData<fn() -> T>);

/// Makes the finding that there is more of something than a limit allows.
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
    finding(code, place, message, "too many", "`ninebit limits` prints what is allowed")
}
