//! Reads the statements of a portion of a general stage.

use super::parser::{Parser, Read, Source};
use super::words::{MAPPINGS, find, registers};
use crate::cascade::one;
use crate::finding::finding;
use crate::{Part, Place, Span};
use ninebit::legality::only_final;
use ninebit::state::{Bias, CombinerInput, Component, FinalRegister, InputMapping, Portion, Register, Scale};

/// State while the statements of a portion are read.
pub(super) struct PortionReader {
    stage: usize,
    alpha: bool,
    pub(super) portion: Portion,
    /// Places of the products so far.
    products: Vec<Span>,
    /// Place of the sum or mux.
    third: Option<Span>,
    scale: Option<Span>,
    bias: Option<Span>,
}

const CALLS: [&str; 5] = [
    "scale_by_two",
    "scale_by_four",
    "scale_by_one_half",
    "bias_by_negative_one_half",
    "bias_by_negative_one_half_scale_by_two",
];

impl PortionReader {
    pub(super) fn new(stage: usize, alpha: bool) -> Self {
        PortionReader {
            stage,
            alpha,
            portion: Portion::idle(if alpha { Component::Alpha } else { Component::Rgb }),
            products: Vec::new(),
            third: None,
            scale: None,
            bias: None,
        }
    }

    fn at(&self, part: Part) -> Place {
        Place::General { stage: self.stage, alpha: self.alpha, part }
    }

    pub(super) fn statement(&mut self, parser: &mut Parser<'_>) -> Read<()> {
        let span = parser.cursor.span();
        let word = parser.cursor.word();
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

    /// Reads `spare0 = ...;`.
    fn assignment(&mut self, parser: &mut Parser<'_>) -> Read<()> {
        let start = parser.cursor.span().start;
        let (output, written) = self.destination(parser)?;
        parser.sign('=')?;
        if let third @ ("sum" | "mux") = parser.cursor.word() {
            parser.call()?;
            if let Some(first) = self.third.clone() {
                parser.twice(start..parser.cursor.end(), first, "the third result of this portion");
                return Ok(());
            }
            self.third = Some(start..parser.cursor.end());
            self.portion.sum_output = output;
            self.portion.mux = third == "mux";
            parser.places.set(self.at(Part::Output(2)), written);
            return Ok(());
        }
        let n = self.products.len();
        if n == 2 {
            let (span, message) = (start..parser.cursor.end(), "a portion has two products");
            let help = "use another stage; `sum()` and `mux()` give the two products together";
            return Err(parser.give_up(finding("NB0364", span, message, "the third", help).rule("CMB-12")));
        }
        let first = self.operand(parser, 2 * n)?;
        let sign = parser.cursor.span();
        let dot = parser.cursor.take('.');
        let second = if dot || parser.cursor.take('*') {
            self.operand(parser, 2 * n + 1)?
        } else {
            // A single register is multiplied by one.
            one(self.alpha)
        };
        let mut blue = None;
        if parser.cursor.take(',') {
            blue = Some(parser.cursor.span());
            if parser.cursor.word() != "blue_to_alpha" {
                return Err(parser.unknown_or_expected("property of a product", &["blue_to_alpha"]));
            }
            parser.cursor.advance();
        }
        if !parser.cursor.take(';') {
            return Err(parser.expected("`*`, `.` or `;`"));
        }
        let portion = &mut self.portion;
        (portion.inputs[2 * n], portion.inputs[2 * n + 1]) = (first, second);
        let (out, is_dot, to_alpha) = if n == 0 {
            (&mut portion.ab_output, &mut portion.ab_dot_product, &mut portion.ab_blue_to_alpha)
        } else {
            (&mut portion.cd_output, &mut portion.cd_dot_product, &mut portion.cd_blue_to_alpha)
        };
        (*out, *is_dot, *to_alpha) = (output, dot, blue.is_some());
        parser.places.set(self.at(Part::Output(n)), written);
        if dot {
            parser.places.set(self.at(Part::Dot(n)), sign);
        }
        if let Some(span) = blue {
            parser.places.set(self.at(Part::BlueToAlpha(n)), span);
        }
        self.products.push(start..parser.cursor.end());
        Ok(())
    }

    /// Reads a destination register, or `discard`.
    fn destination(&self, parser: &mut Parser<'_>) -> Read<(Register, Span)> {
        let span = parser.cursor.span();
        if parser.cursor.word() == "discard" {
            parser.cursor.advance();
            return Ok((Register::Zero, span));
        }
        let register = find(parser.cursor.word()).and_then(general);
        let Some(register) = register.filter(|register| *register != Register::Zero) else {
            let known: Vec<&str> = registers().take(12).skip(4).chain(["discard"]).chain(CALLS).collect();
            return Err(parser.unknown_or_expected("destination or statement", &known));
        };
        parser.cursor.advance();
        if let Some((component, span)) = parser.component() {
            let own = if self.alpha { Component::Alpha } else { Component::Rgb };
            if component != own {
                let (what, help) = if self.alpha {
                    ("alpha", "write other components in `rgb { ... }`")
                } else {
                    ("RGB", "write alpha in `alpha { ... }`, or add `, blue_to_alpha` to a product (Nv2a)")
                };
                let message = format!("this portion writes {what}");
                let finding = finding("NB0311", span, message, "not this component", help).rule("CMB-12");
                return Err(parser.give_up(finding));
            }
        }
        Ok((register, span.start..parser.cursor.end()))
    }

    /// Reads `tex0`, `-tex0`, `expand(tex0.a)` or `-expand(tex0)`.
    fn operand(&self, parser: &mut Parser<'_>, n: usize) -> Read<CombinerInput> {
        let start = parser.cursor.span().start;
        let negative = parser.cursor.take('-');
        let function = MAPPINGS.iter().find(|(name, _, _)| *name == parser.cursor.word());
        let mapping = match function {
            Some((_, mapping, _)) if !negative => *mapping,
            Some((_, _, Some(negated))) => *negated,
            Some((name, _, None)) => {
                let (span, message) = (start..parser.cursor.span().end, format!("there is no `-{name}`"));
                let help = "a plain register can be negated, `expand` and `half_bias` too";
                return Err(parser.give_up(finding("NB0311", span, message, "not negated", help).rule("CMB-5")));
            }
            None if negative => InputMapping::SignedNegate,
            None => InputMapping::SignedIdentity,
        };
        if function.is_some() {
            parser.cursor.advance();
            parser.sign('(')?;
        } else if find(parser.cursor.word()).is_none() && !parser.cursor.word().is_empty() {
            let known: Vec<&str> = registers().take(12).chain(MAPPINGS.iter().map(|(name, ..)| *name)).collect();
            return Err(parser.unknown("input", &known));
        }
        let Source { register, component, span } = parser.register()?;
        let Some(register) = general(register) else {
            let name = super::words::register(register);
            return Err(parser.give_up(only_final(span, name, "use it in `out.rgb = ...`")));
        };
        if function.is_some() {
            parser.sign(')')?;
        }
        parser.places.set(self.at(Part::Input(n)), start..parser.cursor.end());
        let plain = if self.alpha { Component::Alpha } else { Component::Rgb };
        if let Some((_, span)) = &component {
            parser.places.set(self.at(Part::Component(n)), span.clone());
        }
        let component = component.map_or(plain, |(component, _)| component);
        Ok(CombinerInput { register, component, mapping })
    }
}

/// Returns the register of general stages; `None` if only the final combiner has it.
fn general(register: FinalRegister) -> Option<Register> {
    match register {
        FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF => None,
        other => Some(ninebit::combiner::final_combiner::general(other)),
    }
}
