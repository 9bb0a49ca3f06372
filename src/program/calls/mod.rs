//! Reads pasted C: calls of an API, definitions of arrays that they take, and lines of effect files.
//!
//! Nothing is compiled. The calls and states of a language are found wherever they are: behind `hr = ` and `pDevice->`, within
//! `FAILED(...)`, under `if (...)`. Everything else is skipped, with one note for each name.

pub(super) mod opengl;
mod value;

use crate::Span;
use std::collections::HashMap;

use super::cursor::{Cursor, GivenUp};
use super::finding::{finding, warning};
use super::lexer::{Kind, Language};
use ninebit::diagnostic::{Diagnostic, shorten};
pub(super) use value::{Part, PartKind, Value, integer, known, meant, one, out_of_range, without_prefix, wrong_kind};

/// Number of findings after which reading stops.
const MAX_FINDINGS: usize = 32;

/// What a language reads of a text.
#[derive(Debug)]
pub(super) struct Vocabulary {
    /// Endings of the names of calls that are read, separated by spaces.
    pub(super) calls: &'static str,
    /// Endings of the names of calls whose state the scene has in other fields; they are skipped without a note.
    pub(super) silent: &'static str,
    /// Names of the states of effect files that are read.
    pub(super) states: fn() -> Vec<&'static str>,
    /// What to write in place of calls that are skipped, by the ending of their names.
    pub(super) instead: &'static [(&'static str, &'static str)],
    /// Examples of statements, for messages.
    pub(super) example: &'static str,
    /// What messages call the program.
    pub(super) what: &'static str,
}

impl Vocabulary {
    fn reads(&self, call: &str) -> bool {
        self.calls.split(' ').any(|end| call.ends_with(end))
    }

    fn is_state(&self, word: &str) -> bool {
        (self.states)().iter().any(|state| state.eq_ignore_ascii_case(word))
    }
}

/// A program read from pasted text, with notes about what was skipped.
#[derive(Clone, Debug, PartialEq)]
pub struct PastedProgram<P> {
    /// The program that was read.
    pub program: P,
    /// Notes about the rest of the text; each is a warning.
    pub asides: Vec<Aside>,
}

/// A note about a part of a text that does not belong to the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Aside {
    /// The warning about this part.
    pub finding: Diagnostic,
    /// The field of a draw with the same meaning: the warning is only for draws without that field. `None` if it is for all draws.
    pub field: Option<&'static str>,
}

/// A statement that the language reads.
#[derive(Debug)]
pub(super) enum Statement<'t> {
    /// A call `name(a, b)`.
    Call { name: Span, arguments: Vec<Value<'t>> },
    /// An assignment `name = value` or `name[index] = value`.
    State { name: Span, index: Option<Value<'t>>, value: Value<'t> },
}

pub(super) struct Reader<'t> {
    pub(super) findings: Vec<Diagnostic>,
    pub(super) asides: Vec<Aside>,
    vocabulary: &'static Vocabulary,
    cursor: Cursor<'t>,
    /// Token up to which only calls are read.
    until: usize,
    /// Names for which a note has been made.
    passed: Vec<&'t str>,
    /// Arrays that the text defines, by name.
    arrays: HashMap<&'t str, Vec<Value<'t>>>,
}

impl<'t> Reader<'t> {
    pub(super) fn new(text: &'t str, vocabulary: &'static Vocabulary) -> Self {
        let cursor = Cursor::new(text, Language::C);
        let unclosed = cursor.unclosed.clone();
        let unclosed =
            unclosed.map(|at| finding("NB0103", at, "this comment does not end", "opened here", "close it with `*/`"));
        Reader {
            findings: unclosed.into_iter().collect(),
            asides: Vec::new(),
            vocabulary,
            cursor,
            until: 0,
            passed: Vec::new(),
            arrays: HashMap::new(),
        }
    }

    /// Returns the program, or the findings if there are any.
    pub(super) fn finish<P>(self, program: P) -> Result<PastedProgram<P>, Vec<Diagnostic>> {
        if self.findings.is_empty() { Ok(PastedProgram { program, asides: self.asides }) } else { Err(self.findings) }
    }

    /// Reads up to the next statement; `None` at the end of the text.
    pub(super) fn next(&mut self) -> Option<Statement<'t>> {
        while !self.cursor.is_done() && self.findings.len() < MAX_FINDINGS {
            if self.cursor.at < self.until {
                if !self.is_call(self.cursor.at) {
                    self.cursor.advance();
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

    /// Returns the text at a place.
    pub(super) fn word(&self, span: &Span) -> &'t str {
        self.cursor.text(span)
    }

    /// Checks that a call has as many arguments as its function takes. Returns `None` after recording that it has not.
    pub(super) fn takes(&mut self, name: &Span, wanted: usize, written: usize) -> Option<()> {
        if written != wanted {
            let message = format!("{} has {wanted} arguments, not {written}", self.word(name));
            self.findings.push(finding("NB0211", name.clone(), message, "this call", "write them all"));
        }
        (written == wanted).then_some(())
    }

    /// Makes a note about something that does not belong to the program, once for each name.
    pub(super) fn pass(&mut self, span: Span, name: &'t str, message: &str, label: &str, help: &str) {
        if self.asides.len() >= MAX_FINDINGS || self.passed.contains(&name) {
            return;
        }
        self.passed.push(name);
        self.asides.push(Aside { finding: warning("NB0917", span, message, label, help), field: None });
    }

    /// Makes a note about a state for which the draw has a field, once for each name.
    pub(super) fn aside(&mut self, span: Span, name: &'t str, message: &str, help: &str, field: Option<&'static str>) {
        let before = self.asides.len();
        self.pass(span, name, message, "no part of the program", help);
        if let Some(aside) = self.asides.get_mut(before) {
            (aside.finding.code, aside.field) = ("NB0918", field);
        }
    }

    /// Returns the values of an array, which is given by its name or written out.
    pub(super) fn list<'v>(&'v self, value: &'v Value<'t>) -> Option<&'v [Value<'t>]> {
        match &value.parts[..] {
            [Part { kind: PartKind::List(values), .. }] => Some(values),
            [Part { kind: PartKind::Name, text, .. }] => self.arrays.get(text).map(|values| &values[..]),
            _ => None,
        }
    }

    /// Records that something else was expected here, and returns `None`.
    fn expected<T>(&mut self, what: &str) -> Option<T> {
        let message = format!("expected {what}, found {}", self.cursor.current_token("the end of the text"));
        let help = format!("write {}", self.vocabulary.example);
        self.findings.push(finding("NB0103", self.cursor.span(), message, "not a statement from here", help));
        None
    }

    fn sign(&mut self, sign: char) -> Option<()> {
        if self.cursor.take(sign) {
            return Some(());
        }
        self.expected(&format!("`{sign}`"))
    }

    /// Skips to the next statement: after a semicolon, or to the start of a line.
    fn recover(&mut self) {
        self.cursor.advance();
        self.cursor.skip_to(|cursor| cursor.is_new_line() || cursor.kind_at(cursor.at - 1) == Some(Kind::Sign(';')));
    }

    fn is_call(&self, at: usize) -> bool {
        self.cursor.kind_at(at) == Some(Kind::Word)
            && self.cursor.kind_at(at + 1) == Some(Kind::Sign('('))
            && self.vocabulary.reads(self.cursor.text_at(at))
    }

    /// Processes the beginning of a statement.
    fn step(&mut self) -> Result<Option<Statement<'t>>, GivenUp> {
        match self.cursor.kind() {
            Some(Kind::Sign(';' | '{' | '}')) => {
                self.cursor.advance();
                Ok(None)
            }
            Some(Kind::Word) => self.at_word(),
            Some(Kind::Sign('#')) => {
                let (span, name) = (self.cursor.span(), self.cursor.text_at(self.cursor.at + 1));
                let help = "the text is read as if the line were not there; `#define NAME value` is understood";
                self.pass(span, name, "this line of the preprocessor is passed over", "not looked at", help);
                self.cursor.advance();
                self.cursor.skip_to(Cursor::is_new_line);
                Ok(None)
            }
            _ => self.expected("a call or an assignment").ok_or(GivenUp),
        }
    }

    fn at_word(&mut self) -> Result<Option<Statement<'t>>, GivenUp> {
        let word = self.cursor.text_at(self.cursor.at);
        let span = self.cursor.span();
        match (word, self.cursor.kind_at(self.cursor.at + 1)) {
            ("if" | "while" | "for" | "switch", Some(Kind::Sign('('))) => {
                let message = format!("the condition of `{word}` is not looked at");
                let help = "what stands below is read as if it were run once: paste the part that is meant";
                self.pass(span, word, &message, "passed over", help);
                self.until = self.behind_brackets(self.cursor.at + 1);
                self.cursor.advance();
            }
            ("else" | "do" | "try", _) => self.cursor.advance(),
            ("return" | "break" | "continue" | "goto" | "case" | "default", _) => self.until = self.statement_end(),
            (_, Some(Kind::Sign('('))) => return self.at_call(word, span),
            (_, Some(Kind::Sign('[' | '='))) if self.vocabulary.is_state(word) => {
                let statement = self.state(span).ok_or(GivenUp)?;
                self.end().ok_or(GivenUp)?;
                return Ok(Some(statement));
            }
            (_, Some(Kind::Sign('['))) if self.array(word) => {}
            (_, Some(Kind::Sign('[' | '='))) => {
                if let Some(state) = (self.vocabulary.states)().into_iter().find(|state| nearly(word, state)) {
                    let message = format!("there is no state `{}`", shorten(word));
                    let help = format!("did you mean `{state}`?");
                    self.findings.push(finding("NB0204", span, message, "not known", help));
                    return Err(GivenUp);
                }
                self.pass_statement(word, span);
            }
            // A pointer, a type, or the name of a pass stands before the call.
            (_, Some(Kind::Arrow | Kind::Sign('.' | ':'))) => self.cursor.at += 2,
            (_, Some(Kind::Word | Kind::Sign('*' | '{'))) => self.cursor.advance(),
            _ => self.pass_statement(word, span),
        }
        Ok(None)
    }

    fn at_call(&mut self, word: &'t str, span: Span) -> Result<Option<Statement<'t>>, GivenUp> {
        if self.vocabulary.reads(word) {
            let call = self.call().ok_or(GivenUp)?;
            self.end().ok_or(GivenUp)?;
            return Ok(Some(call));
        }
        if let Some(known) = self.vocabulary.calls.split(' ').find(|known| nearly(word, known)) {
            let message = format!("`{}` is no call that is read here", shorten(word));
            let help = format!("did you mean `{known}`?");
            self.findings.push(finding("NB0204", span, message, "not known", help));
            return Err(GivenUp);
        }
        let end = self.behind_brackets(self.cursor.at + 1);
        if (self.cursor.at + 1..end).any(|at| self.is_call(at)) {
            // `FAILED(pDevice->...)`
            self.until = end;
            return Ok(None);
        }
        if !self.vocabulary.silent.split(' ').any(|silent| word.ends_with(silent)) {
            self.pass_name(word, span);
        }
        self.cursor.at = end;
        Ok(None)
    }

    fn pass_name(&mut self, word: &'t str, span: Span) {
        let vocabulary = self.vocabulary;
        let instead = vocabulary.instead.iter().find(|(name, _)| word.ends_with(name));
        let help =
            instead.map_or("nothing to do, if the scene says what it is for in fields of its own", |(_, help)| *help);
        let message = format!("`{}` is passed over", shorten(word));
        let label = format!("no part of {}", vocabulary.what);
        self.pass(span, word, &message, &label, help);
    }

    /// Skips a statement that is not read, except for the calls in it.
    fn pass_statement(&mut self, word: &'t str, span: Span) {
        let end = self.statement_end();
        if (self.cursor.at..end).any(|at| self.is_call(at)) {
            self.until = end;
            return;
        }
        self.pass_name(word, span);
        self.cursor.at = end;
    }

    /// Returns the token after the bracket that closes the one at `open`.
    fn behind_brackets(&self, open: usize) -> usize {
        let mut depth = 0usize;
        for (at, token) in self.cursor.from(open) {
            match token.kind {
                Kind::Sign('(') => depth += 1,
                Kind::Sign(')') if depth <= 1 => return at + 1,
                Kind::Sign(')') => depth -= 1,
                _ => {}
            }
        }
        self.cursor.count()
    }

    /// Returns the token after the current statement: after its semicolon, before a block or at the start of a line.
    fn statement_end(&self) -> usize {
        let mut depth = 0usize;
        for (at, token) in self.cursor.from(self.cursor.at) {
            if depth == 0 && at > self.cursor.at && token.first {
                return at;
            }
            match token.kind {
                Kind::Sign(';') if depth == 0 => return at + 1,
                Kind::Sign('{') if depth == 0 && self.cursor.kind_at(at.wrapping_sub(1)) != Some(Kind::Sign('=')) => {
                    return at;
                }
                Kind::Sign('}') if depth == 0 => return at,
                Kind::Sign('(' | '[' | '{') => depth += 1,
                Kind::Sign(')' | ']' | '}') => depth = depth.saturating_sub(1),
                _ => {}
            }
        }
        self.cursor.count()
    }

    /// Takes a semicolon, which may be absent if the next statement begins a line.
    fn end(&mut self) -> Option<()> {
        if self.cursor.take(';') || self.cursor.is_new_line() || self.cursor.is('}') {
            return Some(());
        }
        self.expected("`;`")
    }

    /// Reads `name(a, b)`. Returns `None` after recording what is wrong.
    fn call(&mut self) -> Option<Statement<'t>> {
        let name = self.cursor.span();
        self.cursor.at += 2;
        let mut arguments = Vec::new();
        if self.cursor.take(')') {
            return Some(Statement::Call { name, arguments });
        }
        arguments.push(self.value()?);
        while self.cursor.take(',') {
            arguments.push(self.value()?);
        }
        self.sign(')')?;
        Some(Statement::Call { name, arguments })
    }

    fn state(&mut self, name: Span) -> Option<Statement<'t>> {
        self.cursor.advance();
        let mut index = None;
        if self.cursor.take('[') {
            index = Some(self.value()?);
            self.sign(']')?;
        }
        self.sign('=')?;
        let value = self.value()?;
        Some(Statement::State { name, index, value })
    }

    /// Reads `name[4] = { 1, 0, 0, 1 };`. Returns whether such a definition stands here.
    fn array(&mut self, name: &'t str) -> bool {
        let count = usize::from(self.cursor.kind_at(self.cursor.at + 2) == Some(Kind::Number));
        let shape = [']', '=', '{'];
        if (0..3).any(|n| self.cursor.kind_at(self.cursor.at + 2 + count + n) != Some(Kind::Sign(shape[n]))) {
            return false;
        }
        let (start, findings) = (self.cursor.at, self.findings.len());
        self.cursor.at += 4 + count;
        let value = self.value().and_then(|mut value| value.parts.pop());
        if let Some(Part { kind: PartKind::List(values), .. }) = value {
            self.arrays.insert(name, values);
        } else {
            // The array holds something else, and no call that is read takes it.
            self.findings.truncate(findings);
            self.cursor.at = start;
            self.cursor.at = self.statement_end();
        }
        true
    }
}

/// Returns whether two names differ by at most two letters in one place.
fn nearly(word: &str, known: &str) -> bool {
    let [a, b] = [word, known].map(|name| name.strip_prefix("gl").unwrap_or(name).as_bytes());
    let most = a.len().max(b.len());
    // `GetTextureStageState` is a call of its own.
    if most < 4 || a.len().abs_diff(b.len()) > 2 || a.first() != b.first() {
        return false;
    }
    let same = |(x, y): &(&u8, &u8)| x.eq_ignore_ascii_case(y);
    let front = a.iter().zip(b).take_while(same).count();
    let back = a.iter().rev().zip(b.iter().rev()).take_while(same).count();
    front + back + 2 >= most
}
