//! Reads the statements of the final combiner.

use super::parser::{GivenUp, Parser, Source};
use super::words::{find, registers};
use crate::finding::{finding, warning};
use crate::{Place, Span};
use ninebit::state::{Component, FinalCombiner, FinalInput, FinalRegister};

/// What the statements so far have set, with their places.
#[derive(Default)]
pub(super) struct Final {
    rgb: Option<([FinalInput; 4], Span)>,
    alpha: Option<(FinalInput, Span)>,
    product: Option<([FinalInput; 2], Span)>,
    sum: Option<([bool; 2], Span)>,
    clamp: Option<Span>,
}

const ZERO: FinalInput = FinalInput { register: FinalRegister::Zero, component: Component::Rgb, invert: false };
const ONE: FinalInput = FinalInput { register: FinalRegister::Zero, component: Component::Rgb, invert: true };

impl Final {
    pub(super) fn statement(&mut self, parser: &mut Parser<'_>) -> Result<(), GivenUp> {
        let start = parser.cursor.span();
        match parser.cursor.word() {
            "clamp_color_sum" => {
                parser.call()?;
                parser.once(&mut self.clamp, start);
            }
            "final_product" => {
                parser.cursor.advance();
                parser.sign('=')?;
                let e = operand(parser, 4)?;
                parser.sign('*')?;
                let f = operand(parser, 5)?;
                parser.sign(';')?;
                set(parser, &mut self.product, [e, f], start);
            }
            "color_sum" => {
                parser.cursor.advance();
                parser.sign('=')?;
                let spare0 = side(parser, FinalRegister::Spare0)?;
                parser.sign('+')?;
                let secondary = side(parser, FinalRegister::SecondaryColor)?;
                parser.sign(';')?;
                set(parser, &mut self.sum, [spare0, secondary], start);
            }
            _ => self.out(parser)?,
        }
        Ok(())
    }

    /// Reads `out.rgb = ...;` or `out.a = ...;`.
    fn out(&mut self, parser: &mut Parser<'_>) -> Result<(), GivenUp> {
        let start = parser.cursor.span().start;
        parser.cursor.advance();
        parser.sign('.')?;
        let what = parser.cursor.word();
        let span = start..parser.cursor.span().end;
        if !matches!(what, "rgb" | "a") {
            return Err(parser.unknown_or_expected("output", &["rgb", "a"]));
        }
        parser.cursor.advance();
        parser.sign('=')?;
        if what == "a" {
            let g = operand(parser, 6)?;
            parser.sign(';')?;
            set(parser, &mut self.alpha, g, span);
        } else {
            let inputs = rgb(parser)?;
            parser.sign(';')?;
            set(parser, &mut self.rgb, inputs, span);
        }
        Ok(())
    }

    /// Returns whether there has been any statement.
    pub(super) fn is_written(&self) -> bool {
        self.rgb.is_some() || self.alpha.is_some() || self.aside().is_some()
    }

    /// Returns the place of the first statement that only serves others.
    fn aside(&self) -> Option<Span> {
        let product = self.product.as_ref().map(|(_, span)| span);
        product.or(self.sum.as_ref().map(|(_, span)| span)).or(self.clamp.as_ref()).cloned()
    }

    /// Returns the state of the final combiner. Without any statement it is OpenGL's initial state; otherwise an output that is not written is 0.
    pub(super) fn finish(self, parser: &mut Parser<'_>, constants: [[u8; 4]; 2]) -> FinalCombiner {
        let initial = FinalCombiner::initial(constants);
        let mut half = |span: &Span, message: &str, help: &str| {
            let label = "the final combiner has no other output";
            parser.findings.push(warning("NB0915", span.clone(), message, label, help).rule("FIN-1"));
        };
        match (&self.rgb, &self.alpha, self.aside()) {
            (Some(_), Some(_), _) | (None, None, None) => {}
            (Some((_, span)), None, _) => {
                let help = "write `out.a = spare0.a;` for the alpha that the stages made, or `out.a = zero;`";
                half(span, "without `out.a` the alpha is 0", help);
            }
            (None, Some((_, span)), _) => {
                let help = "write `out.rgb = spare0;` for the colour that the stages made, or `out.rgb = zero;`";
                half(span, "without `out.rgb` the colour is black", help);
            }
            (None, None, Some(span)) => {
                let help = "write `out.rgb = ...;`, or leave the whole final combiner out";
                parser.give_up(finding("NB0202", span, "this final combiner has no `out.rgb`", "without it", help));
            }
        }
        if self.rgb.is_none() && self.alpha.is_none() {
            return initial;
        }
        let [a, b, c, d] = self.rgb.map_or([ZERO; 4], |(inputs, _)| inputs);
        let [e, f] = self.product.map_or([ZERO; 2], |(inputs, _)| inputs);
        let [invert_spare0, invert_secondary] = self.sum.map_or([false; 2], |(inverts, _)| inverts);
        FinalCombiner {
            inputs: [a, b, c, d, e, f],
            g: self.alpha.map_or(FinalInput::zero(Component::Alpha), |(g, _)| g),
            color_sum_clamp: self.clamp.is_some(),
            invert_spare0,
            invert_secondary,
            constants,
        }
    }
}

/// Keeps what a statement sets, and refuses it if it is set twice.
fn set<T>(parser: &mut Parser<'_>, slot: &mut Option<(T, Span)>, value: T, span: Span) {
    parser.set(slot, value, span.clone(), span, "this");
}

/// Reads `lerp(a, b, c) + d`, `a * b + d`, `a + d`, `d`, or these with d first, as A B + (1 - A) C + D.
fn rgb(parser: &mut Parser<'_>) -> Result<[FinalInput; 4], GivenUp> {
    let mut inputs = [ZERO; 4];
    if parser.cursor.word() == "lerp" {
        lerp(parser, &mut inputs)?;
        if parser.cursor.take('+') {
            inputs[3] = operand(parser, 3)?;
        }
        return Ok(inputs);
    }
    // Which input an operand is becomes clear only behind it.
    let first = unplaced(parser, false)?;
    if parser.cursor.take('*') {
        inputs[0] = put(parser, 0, first);
        inputs[1] = operand(parser, 1)?;
        if parser.cursor.take('+') {
            inputs[3] = operand(parser, 3)?;
        }
    } else if !parser.cursor.take('+') {
        inputs[3] = put(parser, 3, first);
    } else if parser.cursor.word() == "lerp" {
        inputs[3] = put(parser, 3, first);
        lerp(parser, &mut inputs)?;
    } else {
        let second = unplaced(parser, false)?;
        if parser.cursor.take('*') {
            inputs[3] = put(parser, 3, first);
            inputs[0] = put(parser, 0, second);
            inputs[1] = operand(parser, 1)?;
        } else {
            inputs[0] = put(parser, 0, first);
            inputs[1] = ONE;
            inputs[3] = put(parser, 3, second);
        }
    }
    Ok(inputs)
}

/// Reads `lerp(a, b, c)`.
fn lerp(parser: &mut Parser<'_>, inputs: &mut [FinalInput; 4]) -> Result<(), GivenUp> {
    parser.cursor.advance();
    parser.sign('(')?;
    for (n, input) in inputs.iter_mut().take(3).enumerate() {
        if n > 0 {
            parser.sign(',')?;
        }
        *input = operand(parser, n)?;
    }
    parser.sign(')')
}

/// Reads input n of the final combiner.
fn operand(parser: &mut Parser<'_>, n: usize) -> Result<FinalInput, GivenUp> {
    let operand = unplaced(parser, n == 6)?;
    Ok(put(parser, n, operand))
}

/// Notes the place of input n.
fn put(parser: &mut Parser<'_>, n: usize, operand: Operand) -> FinalInput {
    parser.places.set(Place::FinalInput(n), operand.span);
    if let Some(component) = operand.component {
        parser.places.set(Place::FinalComponent(n), component);
    }
    operand.input
}

/// An input with its place.
struct Operand {
    input: FinalInput,
    span: Span,
    /// Place of the component, if it is written.
    component: Option<Span>,
}

/// Reads `spare0`, `spare0.a`, `unsigned_invert(spare0)` or `unsigned(spare0)`.
fn unplaced(parser: &mut Parser<'_>, alpha: bool) -> Result<Operand, GivenUp> {
    let start = parser.cursor.span().start;
    let function = parser.cursor.word();
    if parser.cursor.is('-') || matches!(function, "expand" | "half_bias") {
        let name = if function.is_empty() { "-" } else { function };
        let message = format!("the final combiner has no mapping `{name}`");
        let help = "its inputs are taken as they are, or inverted: `spare0`, `unsigned_invert(spare0)`; map in a stage";
        let finding = finding("NB0311", parser.cursor.span(), message, "not here", help).rule("FIN-1");
        return Err(parser.give_up(finding));
    }
    if function == "lerp" {
        let help = "a final combiner has one: `out.rgb = lerp(a, b, c) + d;`";
        let finding = finding("NB0104", parser.cursor.span(), "`lerp` is not an input", "not here", help);
        return Err(parser.give_up(finding.rule("FIN-1")));
    }
    let mapped = matches!(function, "unsigned" | "unsigned_invert");
    if mapped {
        parser.cursor.advance();
        parser.sign('(')?;
    } else if find(function).is_none() && !function.is_empty() {
        let known: Vec<&str> = registers().chain(["unsigned", "unsigned_invert"]).collect();
        return Err(parser.unknown("input", &known));
    }
    let Source { register, component, .. } = parser.register()?;
    if mapped {
        parser.sign(')')?;
    }
    let plain = if alpha { Component::Alpha } else { Component::Rgb };
    let (read, component) = component.map_or((plain, None), |(read, span)| (read, Some(span)));
    let input = FinalInput { register, component: read, invert: function == "unsigned_invert" };
    Ok(Operand { input, span: start..parser.cursor.end(), component })
}

/// Reads a side of the colour sum, which has to be the register `wanted`. Returns whether it is inverted.
fn side(parser: &mut Parser<'_>, wanted: FinalRegister) -> Result<bool, GivenUp> {
    let Operand { input, span, .. } = unplaced(parser, false)?;
    if input.register != wanted || input.component != Component::Rgb {
        let message = "the colour sum is that of spare0 and col1";
        let help = "write `color_sum = spare0 + col1;`, each as it is or in `unsigned_invert(...)`";
        let finding = finding("NB0104", span, message, "not this", help).rule("FIN-3");
        return Err(parser.give_up(finding));
    }
    Ok(input.invert)
}
