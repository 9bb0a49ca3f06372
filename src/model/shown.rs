//! Names and texts of others, made safe to print.
//!
//! Scenes, their files and the names of cards come from anywhere. Everything that is printed or reported of them goes
//! through here. A name can then not move a terminal's cursor, reverse the order of letters, end its line, break a
//! document, or give orders to a program that reads the log: continuous integration services obey lines that begin with
//! `::`, and `##[` or `##vso[` anywhere in a line.
//!
//! [`name`] is for a name within a line, [`lines`] for a text of several lines, [`path`] for a file, and [`json`] for a
//! document, whose content it keeps. All but `path` leave their own results unchanged.

use std::borrow::Cow;
use std::fmt::Write;
use std::path::Path;

/// Returns whether a character is shown as its number: controls, line separators, whatever Unicode calls
/// `Default_Ignorable_Code_Point`, marks of bidirectional text among it, and characters that XML 1.0 cannot hold.
fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' | '\u{180b}'..='\u{180f}'
            | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{3164}'
            | '\u{fe00}'..='\u{fe0f}' | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fffb}' | '\u{fffe}' | '\u{ffff}'
            | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}' | '\u{e0000}'..='\u{e0fff}')
}

/// Formats a number of things: `1 pixel`, `2 pixels`.
pub fn count(number: u64, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}

/// Puts the indefinite article before a name: `a mesh`, `an input`, `a unit`.
pub fn a(thing: &str) -> String {
    let begins = |with: &str| thing.get(..with.len()).is_some_and(|start| start.eq_ignore_ascii_case(with));
    let vowel = ["a", "e", "i", "o", "u"].into_iter().any(begins);
    let article = if vowel && !["uni", "use", "eu"].into_iter().any(begins) { "an" } else { "a" };
    format!("{article} {thing}")
}

/// Says that something is no whole number from 0 to `most`.
pub fn not_up_to(most: usize) -> String {
    format!("not a number from 0 to {most}")
}

/// Escapes a name or another text of one line. Characters that must not be printed become `\n`, `\t`, `\u{1b}` and so
/// on.
pub fn name(text: &str) -> Cow<'_, str> {
    escaped(text, is_hidden)
}

/// Escapes a text of several lines, each like a [`name`] except that tabs stay.
pub fn lines(text: &str) -> Cow<'_, str> {
    let line = |line| escaped(line, |c| is_hidden(c) && c != '\t');
    if text.split('\n').all(|text| matches!(line(text), Cow::Borrowed(_))) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(text.split('\n').map(line).collect::<Vec<_>>().join("\n"))
}

/// Returns whether services that run tests take a line for an order. Three colons, as before the path in a finding, are none.
fn is_order(line: &str) -> bool {
    line.trim_start().strip_prefix("::").is_some_and(|rest| !rest.starts_with(':'))
}

fn escaped(text: &str, hidden: impl Fn(char) -> bool) -> Cow<'_, str> {
    let ordering = is_order(text);
    if !ordering && !text.contains("##") && !text.contains(&hidden) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    let mut before = None;
    for c in text.chars() {
        let first_colon = ordering && c == ':' && !out.contains(r"\u{3a}");
        if hidden(c) {
            out.extend(c.escape_default());
        } else if first_colon || c == '#' && before == Some('#') {
            out.extend(c.escape_unicode());
        } else {
            out.push(c);
        }
        before = Some(c);
    }
    Cow::Owned(out)
}

/// Escapes a file's path like a [`name`]. Bytes that are not UTF-8 become `\xff` and so on.
pub fn path(path: &Path) -> String {
    name(&lossless(path)).into_owned()
}

/// Converts a path to text. Different paths have different texts, unless their names contain `\xff`.
pub fn lossless(path: &Path) -> String {
    let mut text = String::new();
    for chunk in path.as_os_str().as_encoded_bytes().utf8_chunks() {
        text.push_str(chunk.valid());
        for byte in chunk.invalid() {
            // Writing to a string cannot fail.
            let _ = write!(text, "\\x{byte:02x}");
        }
    }
    text
}

/// Escapes a JSON document without changing its content: characters that must not reach a terminal become `\u001b` and
/// so on.
pub fn json(document: &str) -> Cow<'_, str> {
    let bad = |c: char| is_hidden(c) && c != '\n';
    if !document.contains(bad) && !document.contains("##") {
        return Cow::Borrowed(document);
    }
    // Only texts between quotes contain such characters.
    let mut out = String::with_capacity(document.len() + 16);
    let mut before = None;
    for c in document.chars() {
        if bad(c) || c == '#' && before == Some('#') {
            for unit in c.encode_utf16(&mut [0; 2]) {
                let _ = write!(out, "\\u{unit:04x}");
            }
        } else {
            out.push(c);
        }
        before = Some(c);
    }
    Cow::Owned(out)
}

/// Escapes an excerpt of a text without changing its length in bytes, so that marks under it stay in place. Each hidden
/// character becomes one sign.
pub fn excerpt(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hidden) && !text.contains("##") {
        return Cow::Borrowed(text);
    }
    let mut before = None;
    let sign = |c: char| {
        let doubled = c == '#' && before == Some('#');
        before = Some(c);
        match c.len_utf8() {
            // Terminals draw it as the sign for a substitute.
            1 if doubled => '\u{1a}',
            2 if is_hidden(c) => '\u{b7}',
            3 if is_hidden(c) => '\u{fffd}',
            4 if is_hidden(c) => '\u{1f7e1}',
            _ => c,
        }
    };
    Cow::Owned(text.chars().map(sign).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn names_are_one_line_that_gives_no_orders() {
        assert_eq!(name("wall"), "wall");
        assert_eq!(name("a\n::error::b\u{1b}[31m"), r"a\n::error::b\u{1b}[31m");
        assert_eq!(name("::error::b"), r"\u{3a}:error::b");
        assert_eq!(name("##[error]b"), r"#\u{23}[error]b");
    }

    #[test]
    fn articles_go_by_the_sound() {
        let things = ["mesh", "input", "alpha test", "portion", "unit", "uniform", "Orthographic", "error"];
        assert_eq!(
            things.map(a),
            ["a mesh", "an input", "an alpha test", "a portion", "a unit", "a uniform", "an Orthographic", "an error"]
        );
    }

    /// Names that look the same are printed so that they can be told apart.
    #[test]
    fn characters_without_ink_are_numbers() {
        for c in "\u{ad}\u{34f}\u{115f}\u{17b4}\u{180e}\u{200b}\u{200d}\u{2060}\u{206a}\u{3164}\u{fe0f}\u{ffa0}\u{1d173}\u{e0100}".chars() {
            assert_eq!(name(&format!("wa{c}ll")), format!("wa{}ll", c.escape_unicode()));
            assert!(!excerpt(&format!("wa{c}ll")).contains(c), "{}", c.escape_unicode());
        }
    }

    /// Generates texts of characters that names contain, among them many hostile ones.
    fn hostile() -> impl Strategy<Value = String> {
        let c = prop_oneof![
            any::<char>(),
            (0_u32..0xa0).prop_map(|c| char::from_u32(c).unwrap_or('a')),
            prop::sample::select(vec![
                ':', '#', '[', ' ', '\n', '\r', '\u{1b}', '\u{202e}', '\u{2066}', '\u{2028}', '\u{ffff}'
            ])
        ];
        prop::collection::vec(c, 0..24).prop_map(|chars| chars.into_iter().collect())
    }

    fn harmless(line: &str) -> bool {
        !line.contains(is_hidden) && !is_order(line) && !line.contains("##")
    }

    proptest! {
        #[test]
        fn a_name_is_one_harmless_line(text in hostile()) {
            let shown = name(&text).into_owned();
            prop_assert!(harmless(&shown), "{shown:?}");
            prop_assert_eq!(name(&shown), shown.as_str());
            let lines = lines(&text).into_owned();
            prop_assert!(lines.split('\n').all(|line| harmless(&line.replace('\t', " "))), "{lines:?}");
        }

        #[test]
        fn a_document_keeps_its_content(text in hostile()) {
            let document = serde_json::to_string_pretty(&serde_json::json!({ &text: [&text] })).unwrap_or_default();
            let shown = json(&document).into_owned();
            prop_assert!(shown.lines().all(harmless), "{shown:?}");
            prop_assert_eq!(
                serde_json::from_str::<serde_json::Value>(&shown).ok(),
                serde_json::from_str::<serde_json::Value>(&document).ok()
            );
        }

        #[test]
        fn an_excerpt_keeps_its_places(text in hostile()) {
            let shown = excerpt(&text);
            let ends = |text: &str| text.char_indices().map(|(at, _)| at).collect::<Vec<_>>();
            prop_assert_eq!(ends(&shown), ends(&text));
            prop_assert!(!shown.contains("##"));
        }
    }

    #[test]
    fn ordinary_text_stays_as_it_is() {
        for text in ["vectors/scenes/dot3/lit-stone.ron", "Stein, größer: 3 × 4 — 石", "C# and a::b", "a\\nb"] {
            assert!(matches!(name(text), Cow::Borrowed(_)), "{text}");
        }
        assert!(matches!(lines("a\n\tb: 1\n"), Cow::Borrowed(_)));
        assert!(matches!(json("{\n  \"a\": 1\n}\n"), Cow::Borrowed(_)));
    }

    #[cfg(unix)]
    #[test]
    fn paths_that_are_no_text_stay_apart() {
        use std::os::unix::ffi::OsStrExt;
        let of = |bytes: &[u8]| path(Path::new(std::ffi::OsStr::from_bytes(bytes)));
        assert_eq!(of(b"a/\xff\xfe.ron"), r"a/\xff\xfe.ron");
        assert_ne!(of(b"\xff.ron"), of(b"\xfe.ron"));
    }
}
