//! Pasted C: calls of an API, definitions of arrays that they take, and lines of effect files.
//!
//! Nothing is compiled. The calls and states that a language reads are found wherever they stand: behind `hr = ` and `pDevice->`, within
//! `FAILED(...)`, under `if (...)`. Everything else is passed over, with one note for each name.

pub(super) mod opengl;
mod value;

use std::collections::HashMap;
use std::ops::Range;

use super::finding::finding;
use super::lexer::{Kind, Language, Token, tokens};
use ninebit::diagnostic::{Diagnostic, shorten};
pub(super) use value::{Part, PartKind, Value, integer, known, one, out_of_range, without_prefix, wrong_kind};

/// Findings beyond this many are not gathered.
const MOST_FINDINGS: usize = 32;

/// What a language reads of a text.
#[derive(Debug)]
pub(super) struct Vocabulary {
    /// Ends of the names of calls that are read.
    pub(super) calls: &'static [&'static str],
    /// Ends of the names of calls that say what the scene says itself: passed over without a word.
    pub(super) silent: &'static [&'static str],
    /// States of effect files that are read.
    pub(super) states: &'static [&'static [&'static str]],
    /// What to write instead of calls that are passed over.
    pub(super) instead: &'static [(&'static str, &'static str)],
    /// Two statements, for messages.
    pub(super) example: &'static str,
    /// What the text is said to be, for messages.
    pub(super) what: &'static str,
}

impl Vocabulary {
    fn reads(&self, call: &str) -> bool {
        self.calls.iter().any(|end| call.ends_with(end))
    }

    fn all_states(&self) -> impl Iterator<Item = &'static str> {
        self.states.iter().copied().flatten().copied()
    }

    fn is_state(&self, word: &str) -> bool {
        self.all_states().any(|state| state.eq_ignore_ascii_case(word))
    }
}

/// A program from pasted text, and what was passed over.
#[derive(Clone, Debug, PartialEq)]
pub struct Pasted<P> {
    /// What the text says.
    pub program: P,
    /// What it says besides, each a warning.
    pub asides: Vec<Aside>,
}

/// Something in a text that is no part of the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Aside {
    /// The warning about it.
    pub finding: Diagnostic,
    /// The field of a draw that says the same; the warning is for draws without it. `None`: for all.
    pub field: Option<&'static str>,
}

/// A statement that is read.
#[derive(Debug)]
pub(super) enum Statement<'t> {
    /// `name(a, b)`
    Call { name: Range<usize>, arguments: Vec<Value<'t>> },
    /// `name = value` or `name[index] = value`
    State { name: Range<usize>, index: Option<Value<'t>>, value: Value<'t> },
}

/// Why a statement was given up: the reason has been recorded.
struct GivenUp;

pub(super) struct Reader<'t> {
    pub(super) text: &'t str,
    pub(super) findings: Vec<Diagnostic>,
    pub(super) asides: Vec<Aside>,
    vocabulary: &'static Vocabulary,
    tokens: Vec<Token>,
    at: usize,
    /// Before this token only calls that are read count.
    until: usize,
    /// Names that are passed over.
    passed: Vec<&'t str>,
    /// Arrays that the text defines.
    arrays: HashMap<&'t str, Vec<Value<'t>>>,
}

impl<'t> Reader<'t> {
    pub(super) fn new(text: &'t str, vocabulary: &'static Vocabulary) -> Self {
        let (tokens, unclosed) = tokens(text, Language::C);
        let unclosed =
            unclosed.map(|at| finding("NB0103", at, "this comment does not end", "opened here", "close it with `*/`"));
        Reader {
            text,
            findings: unclosed.into_iter().collect(),
            asides: Vec::new(),
            vocabulary,
            tokens,
            at: 0,
            until: 0,
            passed: Vec::new(),
            arrays: HashMap::new(),
        }
    }

    /// The program, unless something was wrong.
    pub(super) fn finish<P>(self, program: P) -> Result<Pasted<P>, Vec<Diagnostic>> {
        if self.findings.is_empty() { Ok(Pasted { program, asides: self.asides }) } else { Err(self.findings) }
    }

    /// The next statement that is read; `None` at the end.
    pub(super) fn next(&mut self) -> Option<Statement<'t>> {
        while self.at < self.tokens.len() && self.findings.len() < MOST_FINDINGS {
            if self.at < self.until {
                if !self.is_call(self.at) {
                    self.at += 1;
                } else if let Some(call) = self.call() {
                    return Some(call);
                }
                continue;
            }
            match self.step() {
                Ok(Some(statement)) => return Some(statement),
                Ok(None) => {}
                Err(GivenUp) => self.recover(),
            }
        }
        None
    }

    /// The text of a place.
    pub(super) fn word(&self, place: &Range<usize>) -> &'t str {
        self.text.get(place.clone()).unwrap_or("")
    }

    /// Notes something that is no part of the program, once for each name.
    pub(super) fn pass(&mut self, place: Range<usize>, name: &'t str, message: &str, label: &str, help: &str) {
        if self.asides.len() >= MOST_FINDINGS || self.passed.contains(&name) {
            return;
        }
        self.passed.push(name);
        let finding = Diagnostic::warning("NB0917", place, message).label(label).help(help);
        self.asides.push(Aside { finding, field: None });
    }

    /// Notes a state that a field of the draw has, once for each name.
    pub(super) fn aside(
        &mut self,
        place: Range<usize>,
        name: &'t str,
        message: &str,
        help: &str,
        field: Option<&'static str>,
    ) {
        let before = self.asides.len();
        self.pass(place, name, message, "no part of the program", help);
        if let Some(aside) = self.asides.get_mut(before) {
            (aside.finding.code, aside.field) = ("NB0918", field);
        }
    }

    /// The values of an array, by its name or written out.
    pub(super) fn list<'v>(&'v self, value: &'v Value<'t>) -> Option<&'v [Value<'t>]> {
        match &value.parts[..] {
            [Part { kind: PartKind::List(values), .. }] => Some(values),
            [Part { kind: PartKind::Name, text, .. }] => self.arrays.get(text).map(|values| &values[..]),
            _ => None,
        }
    }

    fn kind_at(&self, at: usize) -> Option<Kind> {
        self.tokens.get(at).map(|token| token.kind)
    }

    fn peek(&self) -> Option<Kind> {
        self.kind_at(self.at)
    }

    fn word_at(&self, at: usize) -> &'t str {
        self.tokens.get(at).map_or("", |token| self.word(&token.place))
    }

    /// The place of the token at hand; the end of the text after the last.
    fn place(&self) -> Range<usize> {
        match (self.tokens.get(self.at), self.tokens.last()) {
            (Some(token), _) => token.place.clone(),
            (None, Some(last)) => last.place.end..last.place.end,
            (None, None) => 0..0,
        }
    }

    fn expected(&mut self, what: &str) {
        let place = self.place();
        let found = match self.word(&place) {
            "" => "the end of the text".to_owned(),
            word => format!("`{}`", shorten(word)),
        };
        let message = format!("expected {what}, found {found}");
        let help = format!("write {}", self.vocabulary.example);
        self.findings.push(finding("NB0103", place, message, "not a statement from here", help));
    }

    fn sign(&mut self, sign: char) -> Option<()> {
        if self.peek() == Some(Kind::Sign(sign)) {
            self.at += 1;
            return Some(());
        }
        self.expected(&format!("`{sign}`"));
        None
    }

    /// Skips to the next statement: behind a semicolon, or at the start of a line.
    fn recover(&mut self) {
        while self.at < self.tokens.len() {
            self.at += 1;
            let behind = self.kind_at(self.at - 1) == Some(Kind::Sign(';'));
            if behind || self.tokens.get(self.at).is_some_and(|next| next.first) {
                return;
            }
        }
    }

    fn is_call(&self, at: usize) -> bool {
        self.kind_at(at) == Some(Kind::Word)
            && self.kind_at(at + 1) == Some(Kind::Sign('('))
            && self.vocabulary.reads(self.word_at(at))
    }

    /// One step at the beginning of a statement.
    fn step(&mut self) -> Result<Option<Statement<'t>>, GivenUp> {
        match self.peek() {
            Some(Kind::Sign(';' | '{' | '}')) => {
                self.at += 1;
                Ok(None)
            }
            Some(Kind::Word) => self.at_word(),
            Some(Kind::Sign('#')) => {
                let (place, name) = (self.place(), self.word_at(self.at + 1));
                let help = "the text is read as if the line were not there; `#define NAME value` is understood";
                self.pass(place, name, "this line of the preprocessor is passed over", "not looked at", help);
                self.at += 1;
                while self.tokens.get(self.at).is_some_and(|token| !token.first) {
                    self.at += 1;
                }
                Ok(None)
            }
            _ => {
                self.expected("a call or an assignment");
                Err(GivenUp)
            }
        }
    }

    fn at_word(&mut self) -> Result<Option<Statement<'t>>, GivenUp> {
        let word = self.word_at(self.at);
        let place = self.place();
        match (word, self.kind_at(self.at + 1)) {
            ("if" | "while" | "for" | "switch", Some(Kind::Sign('('))) => {
                let message = format!("the condition of `{word}` is not looked at");
                let help = "what stands below is read as if it were run once: paste the part that is meant";
                self.pass(place, word, &message, "passed over", help);
                self.until = self.behind_brackets(self.at + 1);
                self.at += 1;
            }
            ("else" | "do" | "try", _) => self.at += 1,
            ("return" | "break" | "continue" | "goto" | "case" | "default", _) => self.until = self.statement_end(),
            (_, Some(Kind::Sign('('))) => return self.at_call(word, place),
            (_, Some(Kind::Sign('[' | '='))) if self.vocabulary.is_state(word) => {
                let statement = self.state(place).ok_or(GivenUp)?;
                self.end().ok_or(GivenUp)?;
                return Ok(Some(statement));
            }
            (_, Some(Kind::Sign('['))) if self.array(word) => {}
            (_, Some(Kind::Sign('[' | '='))) => {
                if let Some(state) = self.vocabulary.all_states().find(|state| nearly(word, state)) {
                    let message = format!("there is no state `{}`", shorten(word));
                    let help = format!("did you mean `{state}`?");
                    self.findings.push(finding("NB0204", place, message, "not known", help));
                    return Err(GivenUp);
                }
                self.pass_statement(word, place);
            }
            // What stands before a call: a pointer, a type, a name of a pass.
            (_, Some(Kind::Arrow | Kind::Sign('.' | ':'))) => self.at += 2,
            (_, Some(Kind::Word | Kind::Sign('*' | '{'))) => self.at += 1,
            _ => self.pass_statement(word, place),
        }
        Ok(None)
    }

    fn at_call(&mut self, word: &'t str, place: Range<usize>) -> Result<Option<Statement<'t>>, GivenUp> {
        if self.vocabulary.reads(word) {
            let call = self.call().ok_or(GivenUp)?;
            self.end().ok_or(GivenUp)?;
            return Ok(Some(call));
        }
        if let Some(known) = self.vocabulary.calls.iter().find(|known| nearly(word, known)) {
            let message = format!("`{}` is no call that is read here", shorten(word));
            let help = format!("did you mean `{known}`?");
            self.findings.push(finding("NB0204", place, message, "not known", help));
            return Err(GivenUp);
        }
        let end = self.behind_brackets(self.at + 1);
        if (self.at + 1..end).any(|at| self.is_call(at)) {
            // `FAILED(pDevice->...)`
            self.until = end;
            return Ok(None);
        }
        if !self.vocabulary.silent.iter().any(|silent| word.ends_with(silent)) {
            self.pass_name(word, place);
        }
        self.at = end;
        Ok(None)
    }

    fn pass_name(&mut self, word: &'t str, place: Range<usize>) {
        let vocabulary = self.vocabulary;
        let instead = vocabulary.instead.iter().find(|(name, _)| word.ends_with(name));
        let help =
            instead.map_or("nothing to do, if the scene says what it is for in fields of its own", |(_, help)| *help);
        let message = format!("`{}` is passed over", shorten(word));
        let label = format!("no part of {}", vocabulary.what);
        self.pass(place, word, &message, &label, help);
    }

    /// Passes over a statement that is not read, but for the calls in it.
    fn pass_statement(&mut self, word: &'t str, place: Range<usize>) {
        let end = self.statement_end();
        if (self.at..end).any(|at| self.is_call(at)) {
            self.until = end;
            return;
        }
        self.pass_name(word, place);
        self.at = end;
    }

    /// The token behind the bracket that closes the one at a place.
    fn behind_brackets(&self, open: usize) -> usize {
        let mut depth = 0usize;
        for (at, token) in self.tokens.iter().enumerate().skip(open) {
            match token.kind {
                Kind::Sign('(') => depth += 1,
                Kind::Sign(')') if depth <= 1 => return at + 1,
                Kind::Sign(')') => depth -= 1,
                _ => {}
            }
        }
        self.tokens.len()
    }

    /// The token behind the statement at hand: behind its semicolon, before a block or at the start of a line.
    fn statement_end(&self) -> usize {
        let mut depth = 0usize;
        for (at, token) in self.tokens.iter().enumerate().skip(self.at) {
            if depth == 0 && at > self.at && token.first {
                return at;
            }
            match token.kind {
                Kind::Sign(';') if depth == 0 => return at + 1,
                Kind::Sign('{') if depth == 0 && self.kind_at(at.wrapping_sub(1)) != Some(Kind::Sign('=')) => {
                    return at;
                }
                Kind::Sign('}') if depth == 0 => return at,
                Kind::Sign('(' | '[' | '{') => depth += 1,
                Kind::Sign(')' | ']' | '}') => depth = depth.saturating_sub(1),
                _ => {}
            }
        }
        self.tokens.len()
    }

    /// A semicolon, or nothing where the next statement begins a line.
    fn end(&mut self) -> Option<()> {
        match self.tokens.get(self.at) {
            None => Some(()),
            Some(token) if token.kind == Kind::Sign(';') => {
                self.at += 1;
                Some(())
            }
            Some(token) if token.first || token.kind == Kind::Sign('}') => Some(()),
            Some(_) => {
                self.expected("`;`");
                None
            }
        }
    }

    /// `name(a, b)`; `None` once the reason that it is none has been recorded.
    fn call(&mut self) -> Option<Statement<'t>> {
        let name = self.place();
        self.at += 2;
        let mut arguments = Vec::new();
        if self.peek() == Some(Kind::Sign(')')) {
            self.at += 1;
            return Some(Statement::Call { name, arguments });
        }
        loop {
            arguments.push(self.value()?);
            if self.peek() != Some(Kind::Sign(',')) {
                break;
            }
            self.at += 1;
        }
        self.sign(')')?;
        Some(Statement::Call { name, arguments })
    }

    fn state(&mut self, name: Range<usize>) -> Option<Statement<'t>> {
        self.at += 1;
        let mut index = None;
        if self.peek() == Some(Kind::Sign('[')) {
            self.at += 1;
            index = Some(self.value()?);
            self.sign(']')?;
        }
        self.sign('=')?;
        let value = self.value()?;
        Some(Statement::State { name, index, value })
    }

    /// Takes `name[4] = { 1, 0, 0, 1 };` if that is what stands here.
    fn array(&mut self, name: &'t str) -> bool {
        let count = usize::from(self.kind_at(self.at + 2) == Some(Kind::Number));
        let shape = [']', '=', '{'];
        if (0..3).any(|n| self.kind_at(self.at + 2 + count + n) != Some(Kind::Sign(shape[n]))) {
            return false;
        }
        let (start, findings) = (self.at, self.findings.len());
        self.at += 4 + count;
        let value = self.value().and_then(|mut value| value.parts.pop());
        if let Some(Part { kind: PartKind::List(values), .. }) = value {
            self.arrays.insert(name, values);
        } else {
            // An array of something else, which no call that is read takes.
            self.findings.truncate(findings);
            self.at = start;
            self.at = self.statement_end();
        }
        true
    }
}

/// Whether two names differ by no more than two letters in one place.
fn nearly(word: &str, known: &str) -> bool {
    let [a, b] = [word, known].map(|name| name.strip_prefix("gl").unwrap_or(name).as_bytes());
    let most = a.len().max(b.len());
    // `GetTextureStageState` is another call.
    if most < 4 || a.len().abs_diff(b.len()) > 2 || a.first() != b.first() {
        return false;
    }
    let same = |(x, y): &(&u8, &u8)| x.eq_ignore_ascii_case(y);
    let front = a.iter().zip(b).take_while(same).count();
    let back = a.iter().rev().zip(b.iter().rev()).take_while(same).count();
    front + back + 2 >= most
}
