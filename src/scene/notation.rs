//! RON, the notation of scene files: checks a text once, and splits its brackets into parts.
//!
//! [`Notation::check`] goes through a text once, reports where it is not well formed, and notes where each bracket closes. Afterwards
//! [`Notation::parts`] splits one bracket at its commas and skips the brackets inside it, so that every level of a scene is read
//! once. What the parts have to be is up to [`source`](super::source).

use super::literal::character;
use ninebit::place::Span;

/// A text, and the places of the brackets in what has been checked of it.
#[derive(Debug)]
pub(super) struct Notation<'a> {
    pub(super) text: &'a str,
    /// Places where each bracket opens and closes, in the order in which they open.
    brackets: Vec<(usize, usize)>,
}

/// A part of a bracket: the text between two commas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part<'a> {
    /// The text before the colon.
    pub(super) name: Option<&'a str>,
    /// The value, without white space and comments around it.
    pub(super) value: &'a str,
}

/// A bracket, split into its parts.
#[derive(Debug, PartialEq)]
pub(super) struct Bracket<'a> {
    /// The opening bracket: `(`, `[` or `{`.
    pub(super) open: u8,
    /// The parts; either all have names or none has.
    pub(super) parts: Vec<Part<'a>>,
}

/// The first place where a text is not well formed.
#[derive(Debug, PartialEq)]
pub(super) struct Fault {
    pub(super) kind: FaultKind,
    pub(super) place: Span,
}

/// Kind of a fault in a text.
#[derive(Debug, PartialEq)]
pub(super) enum FaultKind {
    /// It does not start with an opening parenthesis.
    Start,
    /// The text ends too early. Holds the place of the innermost bracket that is open, if any.
    End(Option<usize>),
    /// A comma or the closing bracket is missing.
    Comma,
    /// A colon is missing.
    Colon,
    /// This closing bracket is missing.
    Close(u8),
    /// A text in quotes does not end.
    Quote,
    /// A text in quotes has an unknown escape.
    Escape,
    /// A comment does not end.
    Comment,
    /// Something follows the value.
    Trailing,
    /// No value starts with this.
    Character(char),
    /// There is no extension of the notation that is called so.
    Extension,
    /// Too many brackets are nested.
    Nesting,
}

impl FaultKind {
    fn at(self, place: Span) -> Fault {
        Fault { kind: self, place }
    }
}

/// Extensions that a text may enable. Those that affect what is read are enabled in any case.
const EXTENSIONS: [&str; 4] = ["implicit_some", "unwrap_newtypes", "unwrap_variant_newtypes", "explicit_struct_names"];

/// A bracket that has not been closed yet.
struct Open {
    /// Index in the list of all brackets.
    index: usize,
    close: u8,
    /// Whether its parts have names, once that is known.
    named: Option<bool>,
    /// Whether it is the value of a part with a name.
    behind_colon: bool,
}

impl Open {
    /// Returns the bracket that closes one.
    fn closing(opening: char) -> u8 {
        match opening {
            '(' => b')',
            '[' => b']',
            _ => b'}',
        }
    }

    /// Returns whether its parts have names, or are keys with values.
    fn takes_names(&self) -> bool {
        self.close == b'}' || self.named == Some(true)
    }

    /// Returns whether what precedes a colon may be the name of a part. `callable` says that it is a name.
    fn takes_colon(&self, callable: bool) -> bool {
        match self.close {
            b')' => callable && self.named != Some(false),
            close => close == b'}',
        }
    }
}

impl<'a> Notation<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Notation { text, brackets: Vec::new() }
    }

    /// Checks a part of the text, which has to hold one value in parentheses, and returns that value. Parts are checked in the order of the text.
    ///
    /// # Errors
    /// The first place where the part is not well formed.
    pub(super) fn check(&mut self, part: Span, nesting: usize) -> Result<&'a str, Fault> {
        let before = self.brackets.len();
        // A text that is not well formed is never split.
        self.walk(part, nesting).inspect_err(|_| self.brackets.truncate(before))
    }

    fn walk(&mut self, part: Span, nesting: usize) -> Result<&'a str, Fault> {
        let text = &self.text[..part.end];
        let mut at = attributes(text, blank(text, part.start)?)?;
        let whole = text[at..].trim_end();
        let (called, inside) = word(whole);
        if !inside.starts_with('(') {
            return Err(FaultKind::Start.at(at..at + called.len()));
        }
        let mut open: Vec<Open> = Vec::new();
        // State of the current part of the innermost bracket: whether a colon and a value have been seen, and whether parentheses may follow the
        // value.
        let (mut colon, mut value, mut callable) = (false, false, false);
        loop {
            at = blank(text, at)?;
            let Some(next) = text[at..].chars().next() else { break };
            let here = at..at;
            let character = FaultKind::Character(next).at(at..at + next.len_utf8());
            match next {
                '(' | '[' | '{' if !value || callable && next == '(' => {
                    if open.len() >= nesting {
                        return Err(FaultKind::Nesting.at(at..at + 1));
                    }
                    let close = Open::closing(next);
                    open.push(Open { index: self.brackets.len(), close, named: None, behind_colon: colon });
                    self.brackets.push((at, text.len()));
                    (colon, value, callable) = (false, false, false);
                    at += 1;
                }
                ')' | ']' | '}' | ',' => {
                    let Some(inner) = open.last_mut() else {
                        return Err(if value { FaultKind::Trailing.at(here) } else { character });
                    };
                    let closes = next != ',';
                    if closes && u32::from(inner.close) != next.into() {
                        return Err(FaultKind::Close(inner.close).at(here));
                    }
                    if !value && (colon || !closes) {
                        return Err(character);
                    }
                    if value && !colon && inner.takes_names() {
                        return Err(FaultKind::Colon.at(here));
                    }
                    if closes {
                        self.brackets[inner.index].1 = at;
                        (colon, value, callable) = (inner.behind_colon, true, false);
                        open.pop();
                    } else {
                        inner.named = Some(colon);
                        (colon, value, callable) = (false, false, false);
                    }
                    at += 1;
                }
                ':' => {
                    if !value || colon || !open.last().is_some_and(|inner| inner.takes_colon(callable)) {
                        return Err(if value && !open.is_empty() { FaultKind::Comma.at(here) } else { character });
                    }
                    (colon, value, callable) = (true, false, false);
                    at += 1;
                }
                _ if value => {
                    let missing = |inner: &Open| match !colon && inner.takes_names() {
                        true => FaultKind::Colon,
                        false => FaultKind::Comma,
                    };
                    return Err(open.last().map_or(FaultKind::Trailing, missing).at(here));
                }
                _ => {
                    callable = next.is_alphabetic() || next == '_';
                    value = true;
                    at = scalar(text, at)?;
                    callable &= !matches!(text.as_bytes()[at - 1], b'"' | b'\'' | b'#');
                }
            }
        }
        if open.is_empty() && value {
            return Ok(whole);
        }
        let end = text.trim_end().len();
        let bracket = open.last().map(|inner| self.brackets[inner.index].0);
        Err(FaultKind::End(bracket).at(end..end))
    }

    /// Returns the place of a slice of the text.
    pub(super) fn range(&self, part: &str) -> Span {
        let start = (part.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize).min(self.text.len());
        start..(start + part.len()).min(self.text.len())
    }

    /// Splits a value that is a bracket; `None` if it is something else.
    pub(super) fn parts(&self, value: &'a str) -> Option<Bracket<'a>> {
        let open = *value.as_bytes().first().filter(|byte| matches!(byte, b'(' | b'[' | b'{'))?;
        let start = self.range(value).start;
        let index = self.brackets.binary_search_by_key(&start, |bracket| bracket.0).ok()?;
        let text = &self.text[..self.brackets[index].1];
        let mut inner = &self.brackets[index + 1..];
        let mut parts = Vec::new();
        // State of the current part: its name, the start of its value, and the end of the last token that is neither white space nor comment.
        let (mut name, mut first, mut end) = (None, None, 0);
        let mut at = start + 1;
        loop {
            at = blank(text, at).ok()?;
            match text.as_bytes().get(at) {
                None => break,
                Some(b',') => {
                    parts.push(Part { name: name.take(), value: &text[first.take()?..end] });
                    at += 1;
                }
                Some(b':') => {
                    name = Some(&text[first.take()?..end]);
                    at += 1;
                }
                Some(b'(' | b'[' | b'{') => {
                    first.get_or_insert(at);
                    let (opens, closes) = *inner.first()?;
                    if opens != at {
                        return None;
                    }
                    inner = &inner[inner.partition_point(|bracket| bracket.0 < closes)..];
                    end = closes + 1;
                    at = end;
                }
                Some(_) => {
                    first.get_or_insert(at);
                    end = scalar(text, at).ok()?;
                    at = end;
                }
            }
        }
        if let Some(first) = first {
            parts.push(Part { name, value: &text[first..end] });
        }
        Some(Bracket { open, parts })
    }

    /// Returns the parts of a value that is a bracket of the kind `open`.
    pub(super) fn parts_in(&self, value: &'a str, open: u8) -> Option<Vec<Part<'a>>> {
        self.parts(value).filter(|bracket| bracket.open == open).map(|bracket| bracket.parts)
    }

    /// Returns the values in a bracket of the kind `open`, if none has a name.
    pub(super) fn items(&self, value: &'a str, open: u8) -> Option<Vec<&'a str>> {
        self.parts_in(value, open)?.into_iter().map(|part| part.name.is_none().then_some(part.value)).collect()
    }

    /// Returns the names and values in a bracket of the kind `open`, if all have names.
    pub(super) fn entries(&self, value: &'a str, open: u8) -> Option<Vec<(&'a str, &'a str)>> {
        self.parts_in(value, open)?.into_iter().map(|part| Some((part.name?, part.value))).collect()
    }
}

/// Returns the place after all attributes `#![enable(...)]` and the blank text behind them.
fn attributes(text: &str, mut at: usize) -> Result<usize, Fault> {
    while text[at..].starts_with('#') {
        let unexpected = || FaultKind::Character('#').at(at..at + 1);
        let end = at + text[at..].find(']').ok_or_else(unexpected)?;
        let inside = text[at + 1..end].trim_start().strip_prefix('!').map(str::trim_start);
        let inside = inside.and_then(|rest| rest.strip_prefix('[')).map(str::trim_start);
        let inside = inside.and_then(|rest| rest.strip_prefix("enable")).map(str::trim);
        let names = inside.and_then(|rest| rest.strip_prefix('(')?.strip_suffix(')')).ok_or_else(unexpected)?;
        for name in names.split(',').map(str::trim).filter(|name| !name.is_empty()) {
            if !EXTENSIONS.contains(&name) {
                let start = name.as_ptr() as usize - text.as_ptr() as usize;
                return Err(FaultKind::Extension.at(start..start + name.len()));
            }
        }
        at = blank(text, end + 1)?;
    }
    Ok(at)
}

/// Returns the place after white space and comments.
fn blank(text: &str, mut at: usize) -> Result<usize, Fault> {
    loop {
        match text.as_bytes().get(at) {
            Some(b' ' | b'\n' | b'\r' | b'\t') => at += 1,
            Some(b'/') => match text.as_bytes().get(at + 1) {
                Some(b'/') => at += text[at..].find('\n').unwrap_or(text.len() - at),
                Some(b'*') => at = comment(text, at)?,
                _ => return Ok(at),
            },
            Some(0..0x80) | None => return Ok(at),
            Some(_) => match text[at..].chars().next().filter(|next| next.is_whitespace()) {
                Some(next) => at += next.len_utf8(),
                None => return Ok(at),
            },
        }
    }
}

/// Returns the place after the comment that starts with `/*` at `start`, including the comments nested in it.
fn comment(text: &str, start: usize) -> Result<usize, Fault> {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (1, start + 2);
    while let Some(two) = bytes.get(at..at + 2) {
        match two {
            b"/*" => (depth, at) = (depth + 1, at + 2),
            b"*/" => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            return Ok(at);
        }
    }
    Err(FaultKind::Comment.at(start + 2..text.len()))
}

/// Returns the word that a value starts with (empty if none), and the text that follows it.
pub(super) fn word(value: &str) -> (&str, &str) {
    let end = value.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(value.len());
    let head = &value[..end];
    if head.starts_with(|c: char| c.is_ascii_digit()) { ("", value) } else { (head, trim(&value[end..])) }
}

/// Returns the text without white space and comments in front, and without white space at the end.
pub(super) fn trim(text: &str) -> &str {
    let text = text.trim_end();
    blank(text, 0).map_or("", |start| &text[start..])
}

/// Returns the place after a value that is not a bracket: a text in quotes, a character, a number or a word.
fn scalar(text: &str, start: usize) -> Result<usize, Fault> {
    let bytes = &text.as_bytes()[start..];
    // Byte strings and byte characters are well formed, but no field reads them.
    let at = start + usize::from(matches!(bytes, [b'b', b'"' | b'\'', ..] | [b'b', b'r', b'"' | b'#', ..]));
    match &text.as_bytes()[at..] {
        [b'"', ..] => quoted(text, at, b'"'),
        [b'\'', ..] => quoted(text, at, b'\''),
        [b'r', b'"' | b'#', ..] => raw(text, at),
        _ => {
            let word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '+' | '-');
            let length = text[at..].find(|c| !word(c)).unwrap_or(text.len() - at);
            match text[at..].chars().next() {
                Some(next) if length == 0 => Err(FaultKind::Character(next).at(at..at + next.len_utf8())),
                _ => Ok(at + length),
            }
        }
    }
}

/// Returns the place after the text or character in quotes that starts at `start`.
fn quoted(text: &str, start: usize, quote: u8) -> Result<usize, Fault> {
    let bytes = text.as_bytes();
    let mut at = start + 1;
    loop {
        match bytes.get(at) {
            None => return Err(FaultKind::Quote.at(start..start)),
            Some(byte) if *byte == quote => return Ok(at + 1),
            Some(b'\\') => {
                let Some((_, length)) = character(&text[at..]) else {
                    let end = text[at + 1..].chars().next().map_or(text.len(), |next| at + 1 + next.len_utf8());
                    return Err(FaultKind::Escape.at(at..end));
                };
                at += length;
            }
            Some(_) => at += 1,
        }
    }
}

/// Returns the place after the text `r#"..."#`, with any number of `#`, whose `r` is at `start`.
fn raw(text: &str, start: usize) -> Result<usize, Fault> {
    let signs = text[start + 1..].bytes().take_while(|byte| *byte == b'#').count();
    let inside = start + 1 + signs + 1;
    if text.as_bytes().get(inside - 1) != Some(&b'"') {
        return Err(FaultKind::Character('#').at(start + 1..start + 2));
    }
    let close = &format!("\"{}", "#".repeat(signs));
    match text[inside..].find(close) {
        Some(length) => Ok(inside + length + close.len()),
        None => Err(FaultKind::Quote.at(start..start)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the kind of the first fault, and the text there.
    fn fault(text: &str) -> Option<(FaultKind, &str)> {
        Notation::new(text).check(0..text.len(), 8).err().map(|fault| (fault.kind, &text[fault.place]))
    }

    fn items(list: &str) -> Option<Vec<&str>> {
        let mut notation = Notation::new(list);
        let whole = notation.check(0..list.len(), 8).ok()?;
        notation.items(whole, b'(')
    }

    #[test]
    fn parts_are_what_stands_between_commas() {
        assert_eq!(items("()"), Some(vec![]));
        assert_eq!(items("( a , [b, c], \"d,)\\\"\" , )"), Some(vec!["a", "[b, c]", "\"d,)\\\"\""]));
        assert_eq!(items("(/* x, */ a /* y) */, // z,\n b // w\n)"), Some(vec!["a", "b"]));
        assert_eq!(items("(a) // end"), Some(vec!["a"]));
        assert_eq!(items("(r\"a\\\", b, r#\"c), \"#, for)"), Some(vec!["r\"a\\\"", "b", "r#\"c), \"#", "for"]));
        assert_eq!(
            items("(A (1, [2]) , -1.5e-3, ',', b\"x,\", \u{a0}\u{e4})"),
            Some(vec!["A (1, [2])", "-1.5e-3", "','", "b\"x,\"", "\u{e4}"])
        );
        assert_eq!(items("(a: 1)"), None);
    }

    #[test]
    fn names_stand_before_colons() {
        let text = "#![enable(implicit_some)] Scene(a: 1, b : (c: 2), d: { \"e:\": [], \"f\" : {} },)";
        let mut notation = Notation::new(text);
        let whole = notation.check(0..text.len(), 3).unwrap();
        let fields = notation.entries(word(whole).1, b'(').unwrap();
        assert_eq!(fields, [("a", "1"), ("b", "(c: 2)"), ("d", "{ \"e:\": [], \"f\" : {} }")]);
        assert_eq!(notation.entries(fields[2].1, b'{').unwrap(), [("\"e:\"", "[]"), ("\"f\"", "{}")]);
        assert_eq!(notation.entries(fields[1].1, b'{'), None);
        assert_eq!(notation.parts(fields[0].1), None);
    }

    #[test]
    fn faults_say_what_is_missing_and_where() {
        use FaultKind::*;
        for (text, kind, place) in [
            ("", Start, ""),
            ("hello (1)x", Trailing, ""),
            ("[1]", Start, ""),
            ("two words", Start, "two"),
            ("(1", End(Some(0)), ""),
            ("(a: [1, (2)", End(Some(4)), ""),
            ("(a: )", Character(')'), ")"),
            ("(1,,)", Character(','), ","),
            ("(,)", Character(','), ","),
            ("(1 2)", Comma, ""),
            ("(a: 1 b: 2)", Comma, ""),
            ("(a: 1, b)", Colon, ""),
            ("(a: 1, b 2)", Colon, ""),
            ("(1, b: 2)", Comma, ""),
            ("(1: 2)", Comma, ""),
            ("([a: 1])", Comma, ""),
            ("(a: b: c)", Comma, ""),
            ("({ 1 })", Colon, ""),
            ("({ 1, 2 })", Colon, ""),
            ("({ 1: 2, (3) })", Colon, ""),
            ("([1)", Close(b']'), ""),
            ("({\"a\": 1)", Close(b'}'), ""),
            ("((1]", Close(b')'), ""),
            ("(1))", Trailing, ""),
            ("(1),", Trailing, ""),
            ("(\"a)", Quote, ""),
            ("(r#\"a\")", Quote, ""),
            ("(r#a)", Character('#'), "#"),
            ("(\"\\q\")", Escape, "\\q"),
            ("(\"\\u{110000}\")", Escape, "\\u"),
            ("(1 /* 2)", Comment, " 2)"),
            ("(@)", Character('@'), "@"),
            ("(: 1)", Character(':'), ":"),
            ("#![enable(time_travel)] ()", Extension, "time_travel"),
            ("#[x] ()", Character('#'), "#"),
            ("(((((((((", Nesting, "("),
        ] {
            assert_eq!(fault(text), Some((kind, place)), "{text}");
        }
    }
}
