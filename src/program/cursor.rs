//! A cursor over the tokens of a text, from which the parsers of all languages read.

use super::lexer::{Kind, Language, Token, Tokens, tokens};
use crate::Span;
use ninebit::diagnostic::shorten;

/// The error that a statement was given up; the reason has been recorded.
pub(super) struct GivenUp;

/// Result of reading a part of a statement.
pub(super) type Read<T> = Result<T, GivenUp>;

/// A position between the tokens of a text.
#[derive(Debug)]
pub(super) struct Cursor<'t> {
    pub(super) text: &'t str,
    tokens: Vec<Token>,
    /// Index of the current token, which is the next one to be read.
    pub(super) at: usize,
    /// Place where a comment is opened that does not end.
    pub(super) unclosed: Option<Span>,
    /// Comments that end with their line, without the language's own comment sign.
    pub(super) comments: Vec<Span>,
}

impl<'t> Cursor<'t> {
    /// Makes a cursor before the first token.
    pub(super) fn new(text: &'t str, language: Language) -> Self {
        let Tokens { tokens, unclosed, comments } = tokens(text, language);
        Cursor { text, tokens, at: 0, unclosed, comments }
    }

    /// Returns the current token; `None` after the last.
    pub(super) fn token(&self) -> Option<&Token> {
        self.tokens.get(self.at)
    }

    /// Returns the token at index `at` and those after it, with their indices.
    pub(super) fn from(&self, at: usize) -> impl Iterator<Item = (usize, &Token)> {
        self.tokens.iter().enumerate().skip(at)
    }

    /// Returns the number of tokens.
    pub(super) fn count(&self) -> usize {
        self.tokens.len()
    }

    pub(super) fn kind(&self) -> Option<Kind> {
        self.kind_at(self.at)
    }

    pub(super) fn kind_at(&self, at: usize) -> Option<Kind> {
        self.tokens.get(at).map(|token| token.kind)
    }

    /// Returns whether the cursor is after the last token.
    pub(super) fn is_done(&self) -> bool {
        self.at >= self.tokens.len()
    }

    /// Returns whether the cursor is at the first token of a line, or after the last token.
    pub(super) fn is_new_line(&self) -> bool {
        self.token().is_none_or(|token| token.first)
    }

    pub(super) fn is(&self, sign: char) -> bool {
        self.kind() == Some(Kind::Sign(sign))
    }

    /// Takes the sign if it is the current token. Returns whether it was.
    pub(super) fn take(&mut self, sign: char) -> bool {
        let found = self.is(sign);
        self.at += usize::from(found);
        found
    }

    pub(super) fn advance(&mut self) {
        self.at += 1;
    }

    /// Takes a number and the sign before it, if there is one. Returns whether the number is negative, and the place of its digits; `None` if there
    /// is no number.
    pub(super) fn signed_number(&mut self) -> Option<(bool, Span)> {
        let negative = self.take('-');
        if !negative {
            self.take('+');
        }
        let span = self.span();
        (self.kind() == Some(Kind::Number)).then(|| {
            self.advance();
            (negative, span)
        })
    }

    /// Skips tokens until `stop` holds, or to the end.
    pub(super) fn skip_to(&mut self, stop: impl Fn(&Self) -> bool) {
        while !self.is_done() && !stop(self) {
            self.advance();
        }
    }

    /// Returns the place of the token at index `at`; empty if there is none.
    pub(super) fn span_at(&self, at: usize) -> Span {
        self.tokens.get(at).map_or(0..0, |token| token.span.clone())
    }

    /// Returns the place of the current token; after the last token, the place where it ends.
    pub(super) fn span(&self) -> Span {
        self.token().map_or_else(|| self.end()..self.end(), |token| token.span.clone())
    }

    /// Returns the end of the token before the current one; 0 before the first.
    pub(super) fn end(&self) -> usize {
        self.tokens[..self.at.min(self.tokens.len())].last().map_or(0, |token| token.span.end)
    }

    /// Returns the end of the last token before a place; 0 if there is none.
    pub(super) fn end_before(&self, at: usize) -> usize {
        let count = self.tokens.partition_point(|token| token.span.end <= at);
        count.checked_sub(1).map_or(0, |last| self.tokens[last].span.end)
    }

    /// Returns the text at a place.
    pub(super) fn text(&self, span: &Span) -> &'t str {
        self.text.get(span.clone()).unwrap_or("")
    }

    /// Returns the text of the token at index `at`; empty if there is none.
    pub(super) fn text_at(&self, at: usize) -> &'t str {
        self.text(&self.span_at(at))
    }

    /// Returns the current word; empty if the current token is not a word.
    pub(super) fn word(&self) -> &'t str {
        if self.kind() == Some(Kind::Word) { self.text_at(self.at) } else { "" }
    }

    /// Returns the current token for messages; after the last token, `end`.
    pub(super) fn current_token(&self, end: &str) -> String {
        if self.is_done() { end.to_owned() } else { format!("`{}`", shorten(self.text_at(self.at))) }
    }
}
