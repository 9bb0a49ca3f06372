//! Statements of the language, one after the other. What cannot be read is recorded and passed over, so that one run shows all.

use std::ops::Range;

use super::final_part::Final;
use super::lexer::{Kind, Lexer, Token};
use super::words::{MAPPINGS, REGISTERS, find};
use crate::diagnostic::{Diagnostic, shorten};
use crate::number::convert::constant;
use crate::program::legality::only_final;
use crate::program::{Part, Place, Places};
use crate::spelling::closest;
use crate::state::{
    Bias, CombinerInput, Combiners, Component, FinalRegister, GeneralStage, InputMapping, MuxSelect, Portion, Register,
    Scale,
};

/// Findings beyond this many are not looked for.
const MOST_FINDINGS: usize = 64;

/// Why a statement was given up: the reason has been recorded.
pub(super) struct GivenUp;

type Read<T> = Result<T, GivenUp>;

/// What is known while a program is read.
pub(super) struct Parser<'t> {
    text: &'t str,
    lexer: Lexer<'t>,
    /// The token to be looked at.
    token: Token,
    /// Where the token before it ended.
    end: usize,
    findings: Vec<Diagnostic>,
    pub(super) places: Places,
}

/// A constant that is written, and where.
type Written = Option<([u8; 4], Range<usize>)>;

impl<'t> Parser<'t> {
    pub(super) fn new(text: &'t str) -> Self {
        let mut lexer = Lexer::new(text);
        let token = lexer.next();
        Parser { text, lexer, token, end: 0, findings: Vec::new(), places: Places::default() }
    }

    /// Reads the whole text.
    pub(super) fn program(mut self) -> Result<(Combiners, Places), Vec<Diagnostic>> {
        let mut shared: [Written; 2] = [None, None];
        let mut stages: Vec<(GeneralStage, [Written; 2])> = Vec::new();
        let mut mux: Option<Range<usize>> = None;
        let mut last = Final::default();
        while self.token.kind != Kind::End && self.findings.len() < MOST_FINDINGS {
            let outcome = match self.word() {
                _ if self.token.kind == Kind::Sign('{') => self.stage(&mut stages),
                "const0" => self.constant(&mut shared[0]),
                "const1" => self.constant(&mut shared[1]),
                "mux_by_least_significant_bit" => {
                    let span = self.token.span.clone();
                    self.call().map(|()| self.once(&mut mux, span))
                }
                "out" | "final_product" | "color_sum" | "clamp_color_sum" => last.statement(&mut self),
                _ => Err(self.unknown_statement(
                    "a stage `{ ... }` or a statement",
                    &[
                        "const0",
                        "const1",
                        "mux_by_least_significant_bit",
                        "final_product",
                        "color_sum",
                        "clamp_color_sum",
                        "out",
                    ],
                )),
            };
            if outcome.is_err() {
                self.recover();
                // Nothing outside a stage can be closed.
                while self.token.kind == Kind::Sign('}') {
                    self.advance();
                }
            }
        }
        let end = self.text.trim_end().len();
        self.places.set(Place::Stages, self.before(end));
        let shared = shared.map(|written| written.map_or([0; 4], |(bytes, _)| bytes));
        let final_combiner = last.finish(&mut self, shared);
        if !self.findings.is_empty() {
            return Err(self.findings);
        }
        let mux_select = if mux.is_some() { MuxSelect::Lsb } else { MuxSelect::Msb };
        let stages = stages.into_iter().map(|(mut stage, own)| {
            stage.constants = shared;
            for (slot, own) in stage.constants.iter_mut().zip(own) {
                if let Some((bytes, _)) = own {
                    *slot = bytes;
                }
            }
            stage
        });
        Ok((Combiners { stages: stages.collect(), mux_select, final_combiner }, self.places))
    }

    /// `{ const0 = ...; rgb { ... } alpha { ... } }`
    fn stage(&mut self, stages: &mut Vec<(GeneralStage, [Written; 2])>) -> Read<()> {
        let opening = self.token.span.clone();
        self.advance();
        let index = stages.len();
        self.places.set(Place::Stage(index), opening.clone());
        let mut own: [Written; 2] = [None, None];
        let mut portions: [Option<(Portion, Range<usize>)>; 2] = [None, None];
        while self.token.kind != Kind::Sign('}') && self.findings.len() < MOST_FINDINGS {
            if self.token.kind == Kind::End {
                return Err(self.unclosed(opening));
            }
            let outcome = match self.word() {
                "const0" => self.constant(&mut own[0]),
                "const1" => self.constant(&mut own[1]),
                "rgb" => self.portion(index, false, &mut portions[0]),
                "alpha" => self.portion(index, true, &mut portions[1]),
                _ => Err(self.unknown_statement(
                    "`rgb { ... }`, `alpha { ... }` or a constant",
                    &["rgb", "alpha", "const0", "const1"],
                )),
            };
            if outcome.is_err() {
                self.recover();
            }
        }
        self.advance();
        let first = own.iter().flatten().map(|(_, span)| span.start).min();
        let last = own.iter().flatten().map(|(_, span)| span.end).max();
        if let (Some(first), Some(last)) = (first, last) {
            self.places.set(Place::StageConstants(index), first..last);
        }
        let [rgb, alpha] = portions.map(|portion| portion.map(|(portion, _)| portion));
        let stage = GeneralStage {
            rgb: rgb.unwrap_or(Portion::idle(Component::Rgb)),
            alpha: alpha.unwrap_or(Portion::idle(Component::Alpha)),
            constants: [[0; 4]; 2],
        };
        stages.push((stage, own));
        Ok(())
    }

    /// `rgb { ... }` or `alpha { ... }`
    fn portion(&mut self, stage: usize, alpha: bool, slot: &mut Option<(Portion, Range<usize>)>) -> Read<()> {
        let name = self.token.span.clone();
        self.advance();
        let opening = self.token.span.clone();
        self.sign('{')?;
        let mut reader = PortionReader {
            stage,
            alpha,
            portion: Portion::idle(if alpha { Component::Alpha } else { Component::Rgb }),
            products: Vec::new(),
            third: None,
            scale: None,
            bias: None,
        };
        while self.token.kind != Kind::Sign('}') && self.findings.len() < MOST_FINDINGS {
            if self.token.kind == Kind::End {
                return Err(self.unclosed(opening));
            }
            if reader.statement(self).is_err() {
                self.recover();
            }
        }
        self.advance();
        match slot {
            Some((_, first)) => {
                let first = first.clone();
                self.twice(name, first, "this portion");
            }
            None => *slot = Some((reader.portion, name)),
        }
        Ok(())
    }

    /// `const0 = (1.0, 0.5, 0.0, 1.0);` or `const0 = bytes(255, 128, 0, 255);`
    fn constant(&mut self, slot: &mut Written) -> Read<()> {
        let name = self.token.span.clone();
        self.advance();
        self.sign('=')?;
        let bytes = self.word() == "bytes";
        if bytes {
            self.advance();
        }
        let opening = self.token.span.start;
        self.sign('(')?;
        let mut values = Vec::new();
        loop {
            if self.token.kind != Kind::Number {
                return Err(self.expected("a number"));
            }
            values.push(self.number(bytes));
            self.advance();
            if self.token.kind != Kind::Sign(',') {
                break;
            }
            self.advance();
        }
        self.sign(')')?;
        let span = opening..self.end;
        self.sign(';')?;
        let Ok(values) = <[_; 4]>::try_from(values) else {
            self.findings.push(
                Diagnostic::error("NB0211", span, "a constant colour has four numbers: R, G, B and A")
                    .label("not four")
                    .help("write `(1.0, 0.5, 0.0, 1.0)` or `bytes(255, 128, 0, 255)`"),
            );
            return Ok(());
        };
        // What is out of range has been recorded.
        let bytes = values.map(Option::unwrap_or_default);
        match slot {
            Some((_, first)) => {
                let first = first.clone();
                self.twice(name, first, "this constant");
            }
            None => *slot = Some((bytes, name.start..span.end)),
        }
        Ok(())
    }

    /// The number at hand as a byte of a colour.
    fn number(&mut self, byte: bool) -> Option<u8> {
        let text = self.lexeme();
        let value = if byte {
            text.parse::<u8>().ok()
        } else {
            // NUM-0. Digits and a point are a number, at most infinite.
            text.parse::<f32>().ok().filter(|value| *value <= 1.0).map(constant)
        };
        if value.is_none() {
            let (range, help) = if byte {
                ("a byte of a colour is a whole number from 0 to 255", "for 0.0 to 1.0 leave `bytes` out")
            } else {
                ("a part of a colour is a number from 0.0 to 1.0", "for bytes write `bytes(255, 128, 0, 255)`")
            };
            let message = format!("`{}` is not a part of this colour", shorten(text));
            self.findings.push(
                Diagnostic::error("NB0206", self.token.span.clone(), message)
                    .label("out of range")
                    .note(range)
                    .help(help),
            );
        }
        value
    }

    /// A register with its component: `tex0`, `tex0.a`. The component's place if it is written.
    pub(super) fn register(&mut self) -> Read<(FinalRegister, Option<(Component, Range<usize>)>, Range<usize>)> {
        let span = self.token.span.clone();
        if self.token.kind != Kind::Word {
            return Err(self.expected("a register"));
        }
        let Some(register) = find(self.word()) else {
            let known: Vec<&str> = REGISTERS.iter().map(|(name, _)| *name).collect();
            return Err(self.unknown("register", &known));
        };
        self.advance();
        let component = self.component();
        Ok((register, component, span.start..self.end))
    }

    /// `.rgb`, `.a` or `.b` without a space before the point: anything else is an operator.
    fn component(&mut self) -> Option<(Component, Range<usize>)> {
        if self.token.kind != Kind::Sign('.') || self.token.span.start != self.end {
            return None;
        }
        let mut ahead = self.lexer.clone();
        let token = ahead.next();
        if token.span.start != self.token.span.end {
            return None;
        }
        let component = match &self.text[token.span.clone()] {
            "rgb" => Component::Rgb,
            "a" => Component::Alpha,
            "b" => Component::Blue,
            _ => return None,
        };
        self.advance();
        self.advance();
        Some((component, token.span))
    }

    // What all statements share.

    pub(super) fn advance(&mut self) {
        self.end = self.token.span.end;
        self.token = self.lexer.next();
    }

    pub(super) fn here(&self) -> Range<usize> {
        self.token.span.clone()
    }

    /// Where the token before the one at hand ended.
    pub(super) fn end(&self) -> usize {
        self.end
    }

    /// Text of the token.
    fn lexeme(&self) -> &'t str {
        &self.text[self.token.span.clone()]
    }

    /// The word at hand; empty if it is none.
    pub(super) fn word(&self) -> &'t str {
        if self.token.kind == Kind::Word { self.lexeme() } else { "" }
    }

    pub(super) fn is(&self, sign: char) -> bool {
        self.token.kind == Kind::Sign(sign)
    }

    /// Takes the sign, or says that it is missing.
    pub(super) fn sign(&mut self, sign: char) -> Read<()> {
        if !self.is(sign) {
            return Err(self.expected(&format!("`{sign}`")));
        }
        self.advance();
        Ok(())
    }

    /// `name();`
    pub(super) fn call(&mut self) -> Read<()> {
        self.advance();
        self.sign('(')?;
        self.sign(')')?;
        self.sign(';')
    }

    /// Keeps the place of a statement that may be there once.
    pub(super) fn once(&mut self, slot: &mut Option<Range<usize>>, span: Range<usize>) {
        match slot.clone() {
            Some(first) => self.twice(span, first, "this"),
            None => *slot = Some(span),
        }
    }

    pub(super) fn give_up(&mut self, finding: Diagnostic) -> GivenUp {
        self.findings.push(finding);
        GivenUp
    }

    pub(super) fn expected(&mut self, what: &str) -> GivenUp {
        let found = match self.token.kind {
            Kind::End => "the end of the program".to_owned(),
            _ => format!("`{}`", shorten(self.lexeme())),
        };
        // What is missing at the end of a line is missing there, not where the next one starts.
        let between = self.text.get(self.end..self.token.span.start).unwrap_or("");
        let (span, label) = if self.token.kind == Kind::End || between.contains('\n') {
            (self.before(self.end), "behind this")
        } else {
            (self.here(), "not expected here")
        };
        self.give_up(Diagnostic::error("NB0104", span, format!("expected {what}, found {found}")).label(label))
    }

    /// The finding that a word is none of the known ones.
    pub(super) fn unknown(&mut self, what: &str, known: &[&str]) -> GivenUp {
        let word = self.word();
        let list = known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let help = match closest(word, known.iter().copied()) {
            Some(name) => format!("did you mean `{name}`? All of them: {list}"),
            None => format!("write one of {list}"),
        };
        let message = format!("there is no {what} `{}`", shorten(word));
        self.give_up(Diagnostic::error("NB0204", self.here(), message).label("not known").help(help))
    }

    fn unknown_statement(&mut self, expected: &str, known: &[&str]) -> GivenUp {
        if self.token.kind == Kind::Word { self.unknown("statement", known) } else { self.expected(expected) }
    }

    /// Records that a statement, which has been read to its end, was there before.
    pub(super) fn twice(&mut self, span: Range<usize>, first: Range<usize>, what: &str) {
        self.findings.push(
            Diagnostic::error("NB0364", span, format!("{what} is given twice"))
                .label("again here")
                .related(first, "first here")
                .help("keep one of them"),
        );
    }

    /// The character that ends at a place.
    fn before(&self, end: usize) -> Range<usize> {
        let start = self.text.get(..end).and_then(|text| text.char_indices().next_back()).map_or(0, |(start, _)| start);
        start..end
    }

    fn unclosed(&mut self, opening: Range<usize>) -> GivenUp {
        self.give_up(
            Diagnostic::error("NB0104", opening, "this bracket is not closed")
                .label("opened here")
                .help("close it with `}`"),
        )
    }

    /// Passes over what is left of a statement, with the blocks in it: to behind its semicolon, or to a closing brace.
    fn recover(&mut self) {
        let mut depth = 0usize;
        loop {
            match self.token.kind {
                Kind::End => return,
                Kind::Sign(';') if depth == 0 => return self.advance(),
                Kind::Sign('{') => depth += 1,
                Kind::Sign('}') if depth == 0 => return,
                Kind::Sign('}') => {
                    depth -= 1;
                    if depth == 0 {
                        return self.advance();
                    }
                }
                _ => {}
            }
            self.advance();
        }
    }
}

/// A portion while its statements are read.
struct PortionReader {
    stage: usize,
    alpha: bool,
    portion: Portion,
    /// Places of the products so far.
    products: Vec<Range<usize>>,
    /// Place of the sum or mux.
    third: Option<Range<usize>>,
    scale: Option<Range<usize>>,
    bias: Option<Range<usize>>,
}

const CALLS: [&str; 5] = [
    "scale_by_two",
    "scale_by_four",
    "scale_by_one_half",
    "bias_by_negative_one_half",
    "bias_by_negative_one_half_scale_by_two",
];

impl PortionReader {
    fn at(&self, part: Part) -> Place {
        Place::General { stage: self.stage, alpha: self.alpha, part }
    }

    fn statement(&mut self, parser: &mut Parser<'_>) -> Read<()> {
        let span = parser.here();
        let word = parser.word();
        let scale = match word {
            "scale_by_two" | "bias_by_negative_one_half_scale_by_two" => Some(Scale::Two),
            "scale_by_four" => Some(Scale::Four),
            "scale_by_one_half" => Some(Scale::Half),
            _ => None,
        };
        let bias = word.starts_with("bias_by_negative_one_half") && CALLS.contains(&word);
        if scale.is_none() && !bias {
            return self.assignment(parser);
        }
        parser.call()?;
        if let Some(scale) = scale {
            parser.once(&mut self.scale, span.clone());
            parser.places.set(self.at(Part::Scale), span.clone());
            self.portion.scale = scale;
        }
        if bias {
            parser.once(&mut self.bias, span.clone());
            parser.places.set(self.at(Part::Bias), span);
            self.portion.bias = Bias::NegativeHalf;
        }
        Ok(())
    }

    /// `spare0 = ...;`
    fn assignment(&mut self, parser: &mut Parser<'_>) -> Read<()> {
        let start = parser.here().start;
        let (output, written) = self.destination(parser)?;
        parser.sign('=')?;
        if let third @ ("sum" | "mux") = parser.word() {
            parser.call()?;
            if let Some(first) = self.third.clone() {
                parser.twice(start..parser.end(), first, "the third result of this portion");
                return Ok(());
            }
            self.third = Some(start..parser.end());
            self.portion.sum_output = output;
            self.portion.mux = third == "mux";
            parser.places.set(self.at(Part::Output(2)), written);
            return Ok(());
        }
        let n = self.products.len();
        if n == 2 {
            let finding = Diagnostic::error("NB0364", start..parser.end(), "a portion has two products")
                .label("the third")
                .rule("CMB-12")
                .help("use another stage; `sum()` and `mux()` give the two products together");
            return Err(parser.give_up(finding));
        }
        let first = self.operand(parser, 2 * n)?;
        let sign = parser.here();
        let mut dot = false;
        let second = if parser.is('*') || parser.is('.') {
            dot = parser.is('.');
            parser.advance();
            self.operand(parser, 2 * n + 1)?
        } else {
            // A register on its own is taken times one.
            let component = if self.alpha { Component::Alpha } else { Component::Rgb };
            CombinerInput { register: Register::Zero, component, mapping: InputMapping::UnsignedInvert }
        };
        let mut blue = None;
        if parser.is(',') {
            parser.advance();
            blue = Some(parser.here());
            if parser.word() != "blue_to_alpha" {
                return Err(parser.unknown_or_expected("property of a product", &["blue_to_alpha"]));
            }
            parser.advance();
        }
        if !parser.is(';') {
            return Err(parser.expected("`*`, `.` or `;`"));
        }
        parser.advance();
        parser.places.set(self.at(Part::Output(n)), written);
        if dot {
            parser.places.set(self.at(Part::Dot(n)), sign);
        }
        if let Some(span) = blue.clone() {
            parser.places.set(self.at(Part::BlueToAlpha(n)), span);
        }
        self.products.push(start..parser.end());
        self.portion.inputs[2 * n] = first;
        self.portion.inputs[2 * n + 1] = second;
        let portion = &mut self.portion;
        let (out, is_dot, to_alpha) = if n == 0 {
            (&mut portion.ab_output, &mut portion.ab_dot_product, &mut portion.ab_blue_to_alpha)
        } else {
            (&mut portion.cd_output, &mut portion.cd_dot_product, &mut portion.cd_blue_to_alpha)
        };
        (*out, *is_dot, *to_alpha) = (output, dot, blue.is_some());
        Ok(())
    }

    /// A register to write, or `discard`.
    fn destination(&self, parser: &mut Parser<'_>) -> Read<(Register, Range<usize>)> {
        let span = parser.here();
        if parser.word() == "discard" {
            parser.advance();
            return Ok((Register::Zero, span));
        }
        let register = find(parser.word()).and_then(general);
        let Some(register) = register.filter(|register| *register != Register::Zero) else {
            let known = REGISTERS[4..12].iter().map(|(name, _)| *name).chain(["discard"]).chain(CALLS);
            let known: Vec<&str> = known.collect();
            return Err(parser.unknown_or_expected("destination or statement", &known));
        };
        parser.advance();
        if let Some((component, place)) = parser.component() {
            let own = if self.alpha { Component::Alpha } else { Component::Rgb };
            if component != own {
                let (what, help) = if self.alpha {
                    ("alpha", "write other components in `rgb { ... }`")
                } else {
                    ("RGB", "write alpha in `alpha { ... }`, or add `, blue_to_alpha` to a product (Nv2a)")
                };
                let finding = Diagnostic::error("NB0311", place, format!("this portion writes {what}"))
                    .label("not this component")
                    .rule("CMB-12")
                    .help(help);
                return Err(parser.give_up(finding));
            }
        }
        Ok((register, span.start..parser.end()))
    }

    /// `tex0`, `-tex0`, `expand(tex0.a)`, `-expand(tex0)`
    fn operand(&self, parser: &mut Parser<'_>, n: usize) -> Read<CombinerInput> {
        let start = parser.here().start;
        let negative = parser.is('-');
        if negative {
            parser.advance();
        }
        let function = MAPPINGS.iter().find(|(name, _, _)| *name == parser.word());
        let mapping = match function {
            Some((_, mapping, _)) if !negative => *mapping,
            Some((_, _, Some(negated))) => *negated,
            Some((name, _, None)) => {
                let finding = Diagnostic::error("NB0311", start..parser.here().end, format!("there is no `-{name}`"))
                    .label("not negated")
                    .rule("CMB-5")
                    .help("a plain register can be negated, `expand` and `half_bias` too");
                return Err(parser.give_up(finding));
            }
            None if negative => InputMapping::SignedNegate,
            None => InputMapping::SignedIdentity,
        };
        if function.is_some() {
            parser.advance();
            parser.sign('(')?;
        } else if find(parser.word()).is_none() && !parser.word().is_empty() {
            let known = REGISTERS[..12].iter().map(|(name, _)| *name).chain(MAPPINGS.iter().map(|(name, _, _)| *name));
            let known: Vec<&str> = known.collect();
            return Err(parser.unknown("input", &known));
        }
        let (register, component, span) = parser.register()?;
        let Some(register) = general(register) else {
            let name = super::words::register(register);
            return Err(parser.give_up(only_final(span, name, "use it in `out.rgb = ...`")));
        };
        if function.is_some() {
            parser.sign(')')?;
        }
        parser.places.set(self.at(Part::Input(n)), start..parser.end());
        let plain = if self.alpha { Component::Alpha } else { Component::Rgb };
        let component = match component {
            Some((component, place)) => {
                parser.places.set(self.at(Part::Component(n)), place);
                component
            }
            None => plain,
        };
        Ok(CombinerInput { register, component, mapping })
    }
}

impl Parser<'_> {
    /// A word that is not known, or something that is no word.
    pub(super) fn unknown_or_expected(&mut self, what: &str, known: &[&str]) -> GivenUp {
        if self.token.kind == Kind::Word { self.unknown(what, known) } else { self.expected(&format!("a {what}")) }
    }
}

/// The register of general stages; `None` if only the final combiner has it.
fn general(register: FinalRegister) -> Option<Register> {
    match register {
        FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF => None,
        other => Some(crate::combiner::final_combiner::general(other)),
    }
}
