//! Splits texts into tokens: words, numbers, texts and signs, for every language of programs.

use crate::Span;

/// Kind of a token; its text is found by its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Letters, digits and underscores, not starting with a digit; or a version, `ps.1.1`.
    Word,
    /// Starts with a digit, or with a point and a digit; has no sign.
    Number,
    /// A text in quotes, including the quotes.
    Text,
    /// The two characters `->`.
    Arrow,
    /// Any other character.
    Sign(char),
}

/// A token with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) span: Span,
    /// Whether it is the first token of its line.
    pub(super) first: bool,
}

/// The lexical rules of a language. All languages have the comments of C.
#[derive(Clone, Copy, Debug)]
pub(super) struct Language {
    /// Sign that begins a comment to the end of the line, besides `//`.
    comment: Option<char>,
    /// Whether versions such as `ps.1.1` are one word.
    versions: bool,
    /// Whether numbers include all letters and points that follow them: `0x3f80`, `0.5f`, `1UL`, and malformed numbers.
    greedy_numbers: bool,
    /// Whether there are texts in quotes, and arrows.
    c: bool,
}

impl Language {
    /// The combiner language.
    pub(super) const COMBINERS: Language =
        Language { comment: Some('#'), versions: false, greedy_numbers: false, c: false };
    /// Assembler of shaders.
    pub(super) const ASSEMBLER: Language =
        Language { comment: Some(';'), versions: true, greedy_numbers: false, c: false };
    /// Words of registers.
    pub(super) const WORDS: Language = Language { comment: Some('#'), versions: false, greedy_numbers: true, c: false };
    /// Calls of an API in C, and lines of effect files.
    pub(super) const C: Language = Language { comment: None, versions: false, greedy_numbers: true, c: true };
}

/// The tokens of a text, without comments and spaces.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Tokens {
    pub(super) tokens: Vec<Token>,
    /// Place where a comment is opened that does not end.
    pub(super) unclosed: Option<Span>,
    /// Comments that begin with the language's own sign, without that sign.
    pub(super) comments: Vec<Span>,
}

/// Splits a text into tokens.
pub(super) fn tokens(text: &str, language: Language) -> Tokens {
    let (mut tokens, mut unclosed, mut comments) = (Vec::new(), None, Vec::new());
    let (mut at, mut first) = (0, true);
    while let Some(c) = text.get(at..).and_then(|rest| rest.chars().next()) {
        let rest = &text[at..];
        if c == '\n' || c == '\r' {
            first = true;
            at += 1;
        } else if c.is_whitespace() {
            at += c.len_utf8();
        } else if language.comment == Some(c) || rest.starts_with("//") {
            let length = rest.find(['\n', '\r']).unwrap_or(rest.len());
            if language.comment == Some(c) {
                comments.push(at + 1..at + length);
            }
            at += length;
        } else if let Some(comment) = rest.strip_prefix("/*") {
            let end = comment.find("*/");
            if end.is_none() {
                unclosed = Some(at..at + 2);
            }
            let length = end.map_or(rest.len(), |end| end + 4);
            first |= rest[..length].contains('\n');
            at += length;
        } else {
            let (kind, length) = token(rest, c, language);
            tokens.push(Token { kind, span: at..at + length, first });
            first = false;
            at += length;
        }
    }
    Tokens { tokens, unclosed, comments }
}

fn token(rest: &str, c: char, language: Language) -> (Kind, usize) {
    let letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let second = rest[c.len_utf8()..].chars().next().unwrap_or(' ');
    if c.is_ascii_digit() || c == '.' && second.is_ascii_digit() {
        return (Kind::Number, if language.greedy_numbers { greedy(rest) } else { number(rest) });
    }
    if letter(c) {
        let word = length(rest, letter);
        let version = language.versions
            && ["ps", "vs", "xps"].iter().any(|kind| rest[..word].eq_ignore_ascii_case(kind))
            && rest[word..].starts_with('.');
        let dotted = length(&rest[word..], |c| c.is_ascii_digit() || c == '.');
        return (Kind::Word, if version { word + dotted } else { word });
    }
    if language.c && rest.starts_with("->") {
        return (Kind::Arrow, 2);
    }
    if language.c && c == '"' {
        return (Kind::Text, quoted(rest));
    }
    (Kind::Sign(c), c.len_utf8())
}

/// Returns the length of a number: digits, a fraction, an exponent, the `f` of C.
fn number(rest: &str) -> usize {
    let digits = |text: &str| length(text, |c| c.is_ascii_digit());
    let mut end = digits(rest);
    if rest[end..].starts_with('.') {
        end += 1 + digits(&rest[end + 1..]);
    }
    end += exponent(&rest[end..]);
    end + usize::from(rest[end..].starts_with(['f', 'F']))
}

/// Returns the length of an exponent; 0 if there is none.
fn exponent(rest: &str) -> usize {
    let Some(power) = rest.strip_prefix(['e', 'E']) else { return 0 };
    let sign = usize::from(power.starts_with(['+', '-']));
    let digits = length(&power[sign..], |c| c.is_ascii_digit());
    if digits > 0 { 1 + sign + digits } else { 0 }
}

fn greedy(rest: &str) -> usize {
    let inside = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.';
    let plain = number(rest);
    if exponent(&rest[length(rest, |c| c.is_ascii_digit() || c == '.')..]) > 0 && !rest.starts_with("0x") {
        return plain + length(&rest[plain..], inside);
    }
    length(rest, inside)
}

/// Returns the length of a text in quotes, including the quotes. Without a closing quote it ends with its line.
fn quoted(rest: &str) -> usize {
    let mut escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        match c {
            '\n' => return at,
            '"' if !escaped => return at + 1,
            _ => escaped = c == '\\' && !escaped,
        }
    }
    rest.len()
}

/// Returns the length in bytes of the characters at the front of `text` for which `part` holds.
pub(super) fn length(text: &str, part: impl Fn(char) -> bool) -> usize {
    text.find(|c| !part(c)).unwrap_or(text.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(text: &str, language: Language) -> Vec<(String, bool)> {
        tokens(text, language).tokens.into_iter().map(|token| (text[token.span].to_owned(), token.first)).collect()
    }

    fn words(text: &str, language: Language) -> Vec<String> {
        parts(text, language).into_iter().map(|(part, _)| part).collect()
    }

    #[test]
    fn tokens_of_the_combiner_language() {
        let text = " tex0.a*1.50 // x\n # y\n/* z */ .2 -1.0 tex0.col0 \u{e4}";
        let expected = ["tex0", ".", "a", "*", "1.50", ".2", "-", "1.0", "tex0", ".", "col0", "\u{e4}"];
        assert_eq!(words(text, Language::COMBINERS), expected);
    }

    #[test]
    fn tokens_of_assembler() {
        let text = "ps.1.1 ; x\nDP3_sat r1.a,1-t0_bx2 // y\r\n/* z\n*/+def c0, -.5f 1e-3 2.e \u{e4}";
        let parts = parts(text, Language::ASSEMBLER);
        let firsts: Vec<&str> = parts.iter().filter(|(_, first)| *first).map(|(part, _)| part.as_str()).collect();
        assert_eq!(firsts, ["ps.1.1", "DP3_sat", "+"]);
        let all: Vec<&str> = parts.iter().map(|(part, _)| part.as_str()).collect();
        let after = ["def", "c0", ",", "-", ".5f", "1e-3", "2.", "e", "\u{e4}"];
        assert_eq!(all[1..10], ["DP3_sat", "r1", ".", "a", ",", "1", "-", "t0_bx2", "+"]);
        assert_eq!(all[10..], after);
    }

    #[test]
    fn tokens_of_c() {
        let text = "p->Set( 0x3f80UL, 0.5f, 1e-3f, 0xe-1, \"a\\\"(\", x";
        let expected = r#"p -> Set ( 0x3f80UL , 0.5f , 1e-3f , 0xe - 1 , "a\"(" , x"#;
        assert_eq!(words(text, Language::C).join(" "), expected);
        assert_eq!(words("\"no end\nx", Language::C), ["\"no end", "x"]);
    }

    #[test]
    fn a_comment_that_is_not_closed_ends_the_text() {
        for language in [Language::COMBINERS, Language::ASSEMBLER, Language::C] {
            for text in ["/* x", "/*/ x"] {
                let Tokens { tokens, unclosed, .. } = tokens(text, language);
                assert_eq!((tokens, unclosed), (Vec::new(), Some(0..2)));
            }
        }
    }
}
