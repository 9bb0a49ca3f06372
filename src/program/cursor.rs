//! The tokens of a text, taken one after the other: what the parsers of all languages of programs read with.

use super::lexer::{Kind, Language, Token, Tokens, tokens};
use crate::Span;
use ninebit::diagnostic::shorten;

/// Why a statement was given up: the reason has been recorded.
pub(super) struct GivenUp;

/// What was read of a statement that is not given up.
pub(super) type Read<T> = Result<T, GivenUp>;

/// A place between the tokens of a text.
#[derive(Debug)]
pub(super) struct Cursor<'t> {
    pub(super) text: &'t str,
    tokens: Vec<Token>,
    /// The number of the token at hand: the next one.
    pub(super) at: usize,
    /// Where a comment is opened that does not end.
    pub(super) unclosed: Option<Span>,
    /// Comments that end with their line, without the sign that only this language has for them.
    pub(super) comments: Vec<Span>,
}

impl<'t> Cursor<'t> {
    /// Before the first token.
    pub(super) fn new(text: &'t str, language: Language) -> Self {
        let Tokens { tokens, unclosed, comments } = tokens(text, language);
        Cursor { text, tokens, at: 0, unclosed, comments }
    }

    /// The token at hand; `None` behind the last.
    pub(super) fn token(&self) -> Option<&Token> {
        self.tokens.get(self.at)
    }

    /// This token and those behind it, with their numbers.
    pub(super) fn from(&self, at: usize) -> impl Iterator<Item = (usize, &Token)> {
        self.tokens.iter().enumerate().skip(at)
    }

    /// How many tokens there are.
    pub(super) fn count(&self) -> usize {
        self.tokens.len()
    }

    pub(super) fn kind(&self) -> Option<Kind> {
        self.kind_at(self.at)
    }

    pub(super) fn kind_at(&self, at: usize) -> Option<Kind> {
        self.tokens.get(at).map(|token| token.kind)
    }

    /// Behind the last token.
    pub(super) fn is_done(&self) -> bool {
        self.at >= self.tokens.len()
    }

    /// At the first token of a line, or behind the last.
    pub(super) fn is_new_line(&self) -> bool {
        self.token().is_none_or(|token| token.first)
    }

    pub(super) fn is(&self, sign: char) -> bool {
        self.kind() == Some(Kind::Sign(sign))
    }

    /// Takes the sign if it is at hand.
    pub(super) fn take(&mut self, sign: char) -> bool {
        let found = self.is(sign);
        self.at += usize::from(found);
        found
    }

    pub(super) fn advance(&mut self) {
        self.at += 1;
    }

    /// Passes over tokens up to one that stops it, or to the end.
    pub(super) fn skip_to(&mut self, stop: impl Fn(&Self) -> bool) {
        while !self.is_done() && !stop(self) {
            self.advance();
        }
    }

    /// The place of a token that was taken or is at hand.
    pub(super) fn span_at(&self, at: usize) -> Span {
        self.tokens.get(at).map_or(0..0, |token| token.span.clone())
    }

    /// The place of the token at hand; behind the last, where that ends.
    pub(super) fn span(&self) -> Span {
        self.token().map_or_else(|| self.end()..self.end(), |token| token.span.clone())
    }

    /// Where the token before the one at hand ends; 0 before the first.
    pub(super) fn end(&self) -> usize {
        self.tokens[..self.at.min(self.tokens.len())].last().map_or(0, |token| token.span.end)
    }

    /// Where the last token ends that lies before a place; 0 if there is none.
    pub(super) fn end_before(&self, at: usize) -> usize {
        let count = self.tokens.partition_point(|token| token.span.end <= at);
        count.checked_sub(1).map_or(0, |last| self.tokens[last].span.end)
    }

    /// The text of a place.
    pub(super) fn text(&self, span: &Span) -> &'t str {
        self.text.get(span.clone()).unwrap_or("")
    }

    /// The text of a token; empty behind the last.
    pub(super) fn text_at(&self, at: usize) -> &'t str {
        self.text(&self.span_at(at))
    }

    /// The word at hand; empty if it is none.
    pub(super) fn word(&self) -> &'t str {
        if self.kind() == Some(Kind::Word) { self.text_at(self.at) } else { "" }
    }

    /// The token at hand for messages; behind the last, what ends there.
    pub(super) fn found(&self, end: &str) -> String {
        if self.is_done() { end.to_owned() } else { format!("`{}`", shorten(self.text_at(self.at))) }
    }
}
