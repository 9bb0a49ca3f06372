//! Reads lines of the language one after the other. Lines that cannot be read are reported and skipped, so that one run shows all errors.

use super::check::natural;
use super::{InstructionPlaces, ShaderText, operand};
use crate::Span;
use crate::cursor::{Cursor, GivenUp, Read};
use crate::finding::{finding, foreign, header, warning};
use crate::lexer::{Kind, Language};
use crate::spelling::closest;
use ninebit::diagnostic::{Diagnostic, shorten};
use ninebit::vertex::shader::{Instruction, Opcode, SourceRegister, VertexShader};

/// Number of findings after which reading stops.
const MAX_FINDINGS: usize = 64;

/// Number of instructions after which reading stops; no legal program is as long.
const MAX_INSTRUCTIONS: usize = 1024;

/// State while a program is read.
pub(super) struct Parser<'t> {
    pub(super) cursor: Cursor<'t>,
    findings: Vec<Diagnostic>,
    written: ShaderText,
    /// Index of the first token of the line.
    start: usize,
    version: Option<Span>,
}

/// Reads a program without checking what it does: unwritten registers, too many slots and the like are accepted.
///
/// # Errors
/// Findings about whatever is not an instruction, a definition or a version.
pub fn parse(text: &str) -> Result<ShaderText, Vec<Diagnostic>> {
    let (written, findings) = lines(text);
    if findings.is_empty() { Ok(written) } else { Err(findings) }
}

/// Reads every line that can be read. Also returns what is wrong with the others.
pub(super) fn lines(text: &str) -> (ShaderText, Vec<Diagnostic>) {
    let written = ShaderText {
        shader: VertexShader::default(),
        places: Vec::new(),
        definitions: Vec::new(),
        warnings: Vec::new(),
    };
    let cursor = Cursor::new(text, Language::ASSEMBLER);
    let mut parser = Parser { cursor, findings: Vec::new(), written, start: 0, version: None };
    if let Some(span) = parser.cursor.unclosed.clone() {
        parser.refuse("NB0108", span, "this comment does not end", "opened here", "close it with `*/`");
    }
    for comment in std::mem::take(&mut parser.cursor.comments) {
        parser.hidden(&comment);
    }
    if let Some(span) = header(text) {
        parser.findings.push(foreign(text, span, "NB0108", "a vertex program begins with `vs.1.1`"));
        return (parser.written, parser.findings);
    }
    while !parser.cursor.is_done()
        && parser.findings.len() < MAX_FINDINGS
        && parser.written.shader.instructions.len() < MAX_INSTRUCTIONS
    {
        parser.start = parser.cursor.at;
        let _given_up = parser.line().is_err();
        parser.skip_line();
    }
    parser.findings.sort_by_key(Diagnostic::order);
    (parser.written, parser.findings)
}

fn opcode(word: &str) -> Option<Opcode> {
    Opcode::ALL.iter().copied().find(|opcode| opcode.word().eq_ignore_ascii_case(word))
}

impl Parser<'_> {
    /// Records an error and gives up the line.
    pub(super) fn refuse(&mut self, code: &'static str, span: Span, message: &str, label: &str, help: &str) -> GivenUp {
        self.findings.push(finding(code, span, message, label, help));
        GivenUp
    }

    /// Records that something else was expected here.
    pub(super) fn expected(&mut self, what: &str) -> GivenUp {
        let (span, found) = match self.is_done() {
            true => (self.line_end()..self.line_end(), "the end of the line".to_owned()),
            false => (self.cursor.span(), self.cursor.current_token("")),
        };
        let message = format!("expected {what}, found {found}");
        let help = "write lines such as `mul r0.xyz, r1, c4.x`";
        self.refuse("NB0108", span, &message, "not an instruction from here", help)
    }

    /// Returns whether the whole line has been read.
    pub(super) fn is_done(&self) -> bool {
        self.cursor.is_new_line() && self.cursor.at > self.start
    }

    /// Returns the end of the line with the token before the current one.
    fn line_end(&self) -> usize {
        let (text, end) = (self.cursor.text, self.cursor.end());
        text[end..].find('\n').map_or(text.len(), |line| end + line + 1)
    }

    /// Skips the rest of the line. Returns its end.
    fn skip_line(&mut self) -> usize {
        while !self.is_done() {
            self.cursor.advance();
        }
        self.cursor.end()
    }

    /// Takes a word or a number, if there is one in this line. Returns its place, or an empty one.
    pub(super) fn word(&mut self) -> Span {
        let span = self.cursor.span();
        if self.is_done() || !matches!(self.cursor.kind(), Some(Kind::Word | Kind::Number)) {
            return span.start..span.start;
        }
        self.cursor.advance();
        span
    }

    /// Takes a sign, if it is the next token of this line.
    pub(super) fn sign(&mut self, sign: char) -> Option<Span> {
        let span = self.cursor.span();
        (!self.is_done() && self.cursor.take(sign)).then_some(span)
    }

    /// Warns of an instruction that has become a comment, because it follows another one behind a semicolon.
    fn hidden(&mut self, comment: &Span) {
        let inside = self.cursor.text(comment);
        let hidden = Cursor::new(inside, Language::ASSEMBLER);
        let register = |word: &str| {
            let letters = word.trim_end_matches(|c: char| c.is_ascii_digit()).to_ascii_lowercase();
            ["r", "opos", "od", "ot", "ofog", "opts"].contains(&letters.as_str())
        };
        let instruction = opcode(hidden.text_at(0)).is_some() && register(hidden.text_at(1)) && inside.contains(',');
        let between = self.cursor.text(&(self.cursor.end_before(comment.start)..comment.start));
        if instruction && between.len() < comment.start && !between.contains('\n') {
            let message = "an instruction behind a semicolon, which begins a comment";
            let span = comment.start + hidden.span().start..comment.start + inside.trim_end().len();
            let help = "write each instruction in a line of its own";
            self.written.warnings.push(warning("NB0913", span, message, "left out", help));
        }
    }

    fn line(&mut self) -> Read<()> {
        let span = self.word();
        let word = self.cursor.text(&span);
        let lower = word.to_ascii_lowercase();
        if ["vs", "ps"].contains(&lower.split(['_', '.']).next().unwrap_or_default()) {
            return self.version(span, &lower);
        }
        if lower == "def" {
            return self.definition(span);
        }
        if lower == "nop" && self.is_done() {
            return Ok(());
        }
        if lower == "dcl" || lower.starts_with("dcl_") {
            let help = "leave the line out, and name the attribute in the scene: `inputs: (v0: Position, v3: Normal)`";
            let message = "declarations are not part of vs.1.1 here";
            return Err(self.refuse("NB0108", span, message, "a declaration", help));
        }
        let Some(opcode) = opcode(word) else { return Err(self.unknown(span, word)) };
        self.instruction(opcode, span)
    }

    fn version(&mut self, span: Span, word: &str) -> Read<()> {
        let whole = span.start..self.skip_line();
        let written: String = (self.start..self.cursor.at).map(|at| self.cursor.text_at(at)).collect();
        let written = written.to_ascii_lowercase().replace('_', ".");
        if word.starts_with("ps") {
            let help = "a vertex program begins with `vs.1.1`; the pixel shader belongs into the draw's `program`";
            return Err(self.refuse("NB0108", whole, "this is a pixel shader", "not a vertex program", help));
        }
        if !["vs.1.1", "vs.1.0"].contains(&written.as_str()) {
            let message = format!("there is no version {}", shorten(&written));
            return Err(self.refuse("NB0108", whole, &message, "not known here", "write `vs.1.1`"));
        }
        if let Some(first) = self.version.clone() {
            let finding = finding("NB0388", whole, "a second version", "again here", "keep one program in a text");
            self.findings.push(finding.related(first, "first here"));
        } else if !self.written.shader.instructions.is_empty() {
            let message = "the version stands behind instructions";
            return Err(self.refuse("NB0108", whole, message, "not the first", "move it to the first line"));
        } else {
            self.version = Some(whole);
        }
        Ok(())
    }

    /// Reads `def c4, 0.5, 1, 2, 0`.
    fn definition(&mut self, word: Span) -> Read<()> {
        let (source, span) = operand::source(self)?;
        let SourceRegister::Constant { index, relative: false } = source.register else {
            let help = "write `def c0, 0, 0, 0, 1`";
            return Err(self.refuse("NB0380", span, "`def` defines a constant", "not one", help));
        };
        let mut values = Vec::new();
        while self.sign(',').is_some() {
            let mut span = self.cursor.span();
            while !self.is_done() && !self.cursor.is(',') {
                self.cursor.advance();
            }
            span.end = self.cursor.end().max(span.start);
            let number = self.cursor.text(&span).trim_end_matches(['f', 'F']);
            let plain = number.chars().all(|c| c.is_ascii_digit() || "+-.eE".contains(c));
            match number.parse::<f32>() {
                Ok(value) if plain && value.is_finite() => values.push(value),
                _ => {
                    let message = format!("`{}` is not a number", shorten(self.cursor.text(&span)));
                    let help = "write four numbers, such as `def c4, 0.5, 1.0, 2.0, 0.0`";
                    return Err(self.refuse("NB0205", span, &message, "not finite or no number", help));
                }
            }
        }
        if !self.is_done() {
            return Err(self.expected("`,`"));
        }
        let Ok(values) = <[f32; 4]>::try_from(values.as_slice()) else {
            let message = format!("a constant has four numbers, not {}", values.len());
            return Err(self.refuse("NB0211", word, &message, "this definition", "write all of x, y, z and w"));
        };
        let known = self.written.shader.definitions.iter().position(|(known, _)| *known == index);
        if let Some(first) = known.and_then(|at| self.written.definitions.get(at)).cloned() {
            let message = format!("c{index} is defined twice");
            let finding = finding("NB0388", span, message, "again here", "keep one of them");
            self.findings.push(finding.related(first, "first here"));
            return Err(GivenUp);
        }
        self.written.shader.definitions.push((index, values));
        self.written.definitions.push(span);
        Ok(())
    }

    fn instruction(&mut self, opcode: Opcode, span: Span) -> Read<()> {
        let (destination, written) = operand::destination(self)?;
        let (mut sources, mut places) = (Vec::new(), Vec::new());
        while self.sign(',').is_some() {
            let (source, span) = operand::source(self)?;
            sources.push(source);
            places.push(span);
        }
        if !self.is_done() {
            return Err(self.expected("`,` or the end of the line"));
        }
        if sources.len() != opcode.sources() {
            let count = |n: usize| if n == 1 { "1 source".to_owned() } else { format!("{n} sources") };
            let message = format!("`{}` takes {}, not {}", opcode.word(), count(opcode.sources()), sources.len());
            let help = "a destination comes first, then the sources, with commas between them";
            return Err(self.refuse("NB0211", span, &message, "this instruction", help));
        }
        let mut destination = destination;
        if let (Some((rows, _)), 15) = (opcode.matrix(), destination.mask) {
            destination.mask = natural(rows);
        }
        self.written.shader.instructions.push(Instruction { opcode, destination, sources });
        self.written.places.push(InstructionPlaces { opcode: span, destination: written, sources: places });
        Ok(())
    }

    fn unknown(&mut self, span: Span, word: &str) -> GivenUp {
        if word.is_empty() {
            return self.expected("an instruction");
        }
        let list: Vec<&str> = Opcode::ALL.iter().map(|opcode| opcode.word()).collect();
        let later = ["abs", "crs", "lrp", "mova", "nrm", "pow", "sgn", "sincos", "if", "loop", "rep", "call", "setp"];
        let help = if later.contains(&word.to_ascii_lowercase().as_str()) {
            format!("it came with later versions; vs.1.1 has {}", list.join(", "))
        } else {
            match closest(word, list.iter().copied()) {
                Some(name) => format!("did you mean `{name}`? All of them: {}, and def", list.join(", ")),
                None => format!("vs.1.1 has {}, and def", list.join(", ")),
            }
        };
        self.refuse("NB0204", span, &format!("there is no instruction `{}`", shorten(word)), "not known", &help)
    }
}
