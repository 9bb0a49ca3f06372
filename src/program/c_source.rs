//! Extracts programs from C source: joins texts between quotes, and replaces names that `#define` defines.
#![allow(clippy::result_large_err, reason = "the first error ends the text: it is made once")]

use crate::Span;
use std::collections::HashMap;

use super::finding::finding;
use super::lexer::length;
use ninebit::diagnostic::{Diagnostic, shorten};

/// Deepest nesting of names in the values of names.
const MAX_NESTING: usize = 16;

/// How programs of a language are written in C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Assembler of shaders: between quotes or not, possibly with `#define`.
    Assembler,
    /// The combiner language: between quotes or not; `#` begins a comment.
    Combiners,
    /// Calls of an API: C itself, possibly with `#define`.
    Calls,
}

/// A text after the expansion, and where its bytes come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Expansion {
    /// The text for the language's reader.
    pub text: String,
    /// The place in the given text of each byte, and of the end. Bytes of a name's value have the place of the name.
    pub places: Vec<usize>,
}

/// Joins texts between quotes and replaces defined names by their values. The result has at most `most` bytes. Returns `None` if the text needs no
/// expansion.
///
/// # Errors
/// A directive is not supported, a quote is not closed, or the result is too large.
pub fn expand(text: &str, style: Style, most: usize) -> Result<Option<Expansion>, Diagnostic> {
    let joined = match style {
        Style::Assembler | Style::Combiners if quoted(text) => Some(walk(text, style, true, most)?),
        _ => None,
    };
    let inside = joined.as_ref().map_or(text, |joined| joined.text.as_str());
    if style == Style::Combiners || !inside.lines().any(|line| line.trim_start().starts_with('#')) {
        return Ok(joined);
    }
    let place = |at: usize| joined.as_ref().map_or(at, |joined| joined.places.get(at).copied().unwrap_or(text.len()));
    let expanded = walk(inside, style, false, most).map_err(|mut finding| {
        finding.span = finding.span.map(|span| place(span.start)..place(span.end));
        finding
    })?;
    let places = expanded.places.iter().map(|at| place(*at)).collect();
    Ok(Some(Expansion { text: expanded.text, places }))
}

/// Returns whether a text has quotes: one opens outside comments and directives.
fn quoted(text: &str) -> bool {
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        match c {
            '"' => return true,
            '#' | ';' => at += line(rest),
            '/' if comment(rest) > 0 => at += comment(rest),
            _ => at += c.len_utf8(),
        }
    }
    false
}

/// Returns the number of bytes up to the end of the line.
fn line(rest: &str) -> usize {
    rest.find('\n').unwrap_or(rest.len())
}

/// Returns the length in bytes of the C comment that begins here; 0 if there is none.
fn comment(rest: &str) -> usize {
    if rest.starts_with("//") {
        return line(rest);
    }
    rest.strip_prefix("/*").map_or(0, |inside| inside.find("*/").map_or(rest.len(), |end| end + 4))
}

fn is_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

struct Walk<'t> {
    /// Values of the defined names.
    defined: HashMap<&'t str, &'t str>,
    /// Whether only the texts between quotes go into the result.
    joining: bool,
    most: usize,
    result: Expansion,
}

fn walk(text: &str, style: Style, joining: bool, most: usize) -> Result<Expansion, Diagnostic> {
    let result = Expansion { text: String::with_capacity(text.len()), places: Vec::with_capacity(text.len() + 1) };
    let mut walk = Walk { defined: HashMap::new(), joining, most, result };
    let (mut at, mut first) = (0, true);
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        if c == '#' && first && style != Style::Combiners {
            let length = directive_length(rest);
            if !walk.directive(&rest[..length], at, joining || style == Style::Calls)? {
                walk.push_outside(&rest[..length], at, false)?;
            }
            at += length;
            continue;
        }
        first = c == '\n' || first && c.is_whitespace();
        at += walk.piece(text, at, None)?;
    }
    let mut result = walk.result;
    result.places.push(text.len());
    Ok(result)
}

/// Returns the length in bytes of a directive: its line, and those that are continued by a backslash.
fn directive_length(rest: &str) -> usize {
    let mut end = line(rest);
    while rest[..end].trim_end_matches('\r').ends_with('\\') && end < rest.len() {
        end += 1 + line(&rest[end + 1..]);
    }
    end
}

impl<'t> Walk<'t> {
    /// Processes one piece of a text: a comment, a text between quotes, a word or a sign. Returns its length. Within the value of a name, `used`
    /// is the place where the name is used, and the depth of nesting.
    fn piece(&mut self, text: &'t str, at: usize, used: Option<(usize, usize)>) -> Result<usize, Diagnostic> {
        let rest = &text[at..];
        let Some(c) = rest.chars().next() else { return Ok(0) };
        let place = used.map_or(at, |(place, _)| place);
        let commented = comment(rest);
        if commented > 0 {
            self.push_outside(&rest[..commented], place, used.is_some())?;
            return Ok(commented);
        }
        if c == '"' && self.joining {
            return self.quoted(rest, at, used);
        }
        if is_name(c) {
            let length = length(rest, is_name);
            let word = &rest[..length];
            match self.defined.get(word).copied() {
                Some(value) if !c.is_ascii_digit() => {
                    self.value(value, word, place, used.map_or(0, |(_, depth)| depth))?
                }
                _ => self.push_outside(word, place, used.is_some())?,
            }
            return Ok(length);
        }
        if self.joining && c == ',' && !self.result.text.is_empty() && !self.result.text.ends_with('\n') {
            // The comma separates the lines of a list.
            self.push("\n", place, true)?;
        }
        let length = c.len_utf8();
        self.push_outside(&rest[..length], place, used.is_some())?;
        Ok(length)
    }

    /// Processes the value of a name.
    fn value(&mut self, value: &'t str, word: &str, place: usize, depth: usize) -> Result<(), Diagnostic> {
        if depth >= MAX_NESTING {
            let message = format!("the value of `{}` leads to more than {MAX_NESTING} others", shorten(word));
            let help = "write the value itself";
            return Err(finding("NB0109", place..place + 1, message, "used here", help));
        }
        let mut at = 0;
        while at < value.len() {
            at += self.piece(value, at, Some((place, depth + 1)))?;
        }
        Ok(())
    }

    /// Adds a text between quotes, without the quotes and with its escapes resolved. Returns its length.
    fn quoted(&mut self, rest: &str, at: usize, used: Option<(usize, usize)>) -> Result<usize, Diagnostic> {
        let mut characters = rest.char_indices().skip(1).peekable();
        while let Some((offset, c)) = characters.next() {
            let place = used.map_or(at + offset, |(place, _)| place);
            match c {
                '"' => return Ok(offset + 1),
                '\n' => break,
                '\\' => {
                    let piece = match characters.next() {
                        Some((_, 'n')) => "\n",
                        Some((_, '"')) => "\"",
                        // The line is continued.
                        Some((_, '\n')) => "",
                        Some((_, '\r')) => {
                            characters.next_if(|(_, c)| *c == '\n');
                            ""
                        }
                        _ => " ",
                    };
                    self.push(piece, place, true)?;
                }
                c => self.push(c.encode_utf8(&mut [0; 4]), place, true)?,
            }
        }
        let place = used.map_or(at, |(place, _)| place);
        let help = "close it with `\"`";
        Err(finding("NB0109", place..place + 1, "this quote is not closed in its line", "opened here", help))
    }

    /// Adds a piece outside quotes, unless texts between quotes are being joined.
    fn push_outside(&mut self, piece: &str, place: usize, used: bool) -> Result<(), Diagnostic> {
        if self.joining { Ok(()) } else { self.push(piece, place, used) }
    }

    /// Adds a piece to the result. If `fixed`, all of it comes from one place.
    fn push(&mut self, piece: &str, place: usize, fixed: bool) -> Result<(), Diagnostic> {
        if self.result.text.len() + piece.len() > self.most {
            let message = format!("with the values of its names this text has more than {} bytes", self.most);
            let help = "`ninebit limits` prints what is allowed";
            return Err(finding("NB0109", place..place, message, "up to here", help));
        }
        self.result.text.push_str(piece);
        self.result.places.extend((0..piece.len()).map(|n| if fixed { place } else { place + n }));
        Ok(())
    }

    /// Processes `#define NAME value` and `#undef NAME`. Returns whether the directive was one of them. If `others`, other directives are left to the
    /// caller.
    fn directive(&mut self, directive: &'t str, at: usize, others: bool) -> Result<bool, Diagnostic> {
        let inside = directive[1..].trim_start();
        let word = &inside[..length(inside, is_name)];
        let rest = inside[word.len()..].trim_start();
        let name = &rest[..length(rest, is_name)];
        let place: Span = at..at + directive.trim_end().len().max(1);
        match word {
            "define" if !name.is_empty() && !rest[name.len()..].starts_with('(') => {
                let value = rest[name.len()..].trim_matches(|c: char| c.is_whitespace() || c == '\\');
                let value = &value[..value.find("//").unwrap_or(value.len())];
                self.defined.insert(name, value.trim_end());
                Ok(true)
            }
            "undef" => {
                self.defined.remove(name);
                Ok(true)
            }
            // The directive is empty.
            "" => Ok(true),
            _ if others => Ok(false),
            "define" if !name.is_empty() => {
                let message = format!("`{}` is defined with parameters", shorten(name));
                let help = "this understands `#define NAME value`: write the values in their place";
                Err(finding("NB0109", place, message, "not expanded", help))
            }
            _ => {
                let message = format!("the directive `#{}` is not understood", shorten(word));
                let help = "this understands `#define NAME value` and `#undef NAME`: leave the line out";
                Err(finding("NB0109", place, message, "not read", help))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn expanded(text: &str, style: Style) -> String {
        expand(text, style, 1 << 16).unwrap().map_or(text.to_owned(), |expanded| expanded.text)
    }

    #[test]
    fn texts_between_quotes_are_joined() {
        let c = "const char shader[] = // of the floor\n    \"ps.1.1\\n\"\n    \"tex t0 ; \\\"base\\\"\\n\" /* x */\n    \"mov r0, t0\\n\";\n";
        assert_eq!(expanded(c, Style::Assembler), "ps.1.1\ntex t0 ; \"base\"\nmov r0, t0\n");
        let places = expand(c, Style::Assembler, 1 << 16).unwrap().unwrap().places;
        assert_eq!(&c[places[0]..places[0] + 6], "ps.1.1");
        assert_eq!(expanded("{ \"ps.1.1\", \"tex t0\" }", Style::Assembler), "ps.1.1\ntex t0");
        assert_eq!(expanded("\"!!RC1.0\\n\" \"out.rgb = col0;\\n\"", Style::Combiners), "!!RC1.0\nout.rgb = col0;\n");
        let name = "#define LIGHT \"c0\"\n\"mul r0, t0, \" LIGHT \"\\n\"";
        assert_eq!(expanded(name, Style::Assembler), "mul r0, t0, c0\n");
        // Within a comment of the assembler, quotes mean nothing.
        assert_eq!(expand("ps.1.1 ; \"x\"\ntex t0", Style::Assembler, 99), Ok(None));
    }

    #[test]
    fn names_are_put_in_their_place() {
        let text =
            "#define LIGHT c0 // of the sun\n#define DOT dp3 r0, t0_bx2, LIGHT\nps.1.1\nDOT\nmul r0.rgb, r0, LIGHT.a";
        assert_eq!(expanded(text, Style::Assembler), "\n\nps.1.1\ndp3 r0, t0_bx2, c0\nmul r0.rgb, r0, c0.a");
        let places = expand(text, Style::Assembler, 1 << 16).unwrap().unwrap().places;
        let at = "\n\nps.1.1\ndp3".len();
        assert_eq!(&text[places[at]..places[at] + 3], "DOT");
        assert_eq!(expanded("#define A 1\n#undef A\nA", Style::Calls), "\n\nA");
        assert_eq!(expanded("#ifdef A\nf(\"A\");", Style::Calls), "#ifdef A\nf(\"A\");");
        assert_eq!(expanded("# a comment\nout.rgb = col0;", Style::Combiners), "# a comment\nout.rgb = col0;");
        assert_eq!(expanded("\"#define X c1\\n\" \"mov r0, X\"", Style::Assembler), "\nmov r0, c1");
    }

    #[test]
    fn what_is_not_understood_is_refused() {
        for text in
            ["#define TWICE(x) x, x\nmov r0, c0", "#include \"x.h\"\nmov r0, c0", "#define A A\nA", "\"ps.1.1\n"]
        {
            assert_eq!(
                expand(text, Style::Assembler, 1 << 16).map_err(|finding| finding.code),
                Err("NB0109"),
                "{text}"
            );
        }
        let names: String = (0..15).map(|n| format!("#define A{n} A{0} A{0} A{0} A{0}\n", n + 1)).collect();
        let bomb = expand(&format!("{names}#define A15 xxxx\nA0"), Style::Calls, 1 << 16);
        assert_eq!(bomb.map_err(|finding| finding.code), Err("NB0109"));
    }

    proptest! {
        #[test]
        fn nothing_makes_it_fail(
            text in "([A-C \n\";,/*\\\\]|#define |#undef |\\PC){0,60}",
            style in prop::sample::select(vec![Style::Assembler, Style::Combiners, Style::Calls]),
        ) {
            match expand(&text, style, 500) {
                Ok(Some(expanded)) => {
                    prop_assert_eq!(expanded.places.len(), expanded.text.len() + 1);
                    prop_assert!(expanded.text.len() <= 500);
                    prop_assert!(expanded.places.iter().all(|place| *place <= text.len()));
                }
                Ok(None) => {}
                Err(finding) => prop_assert!(finding.span.is_some_and(|span| span.start <= text.len())),
            }
        }
    }
}
