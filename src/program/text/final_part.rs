//! The statements of the final combiner.

use std::ops::Range;

use super::parser::{GivenUp, Parser, Source};
use super::words::{REGISTERS, find};
use crate::diagnostic::Diagnostic;
use crate::program::Place;
use crate::state::{Component, FinalCombiner, FinalInput, FinalRegister};

/// What the statements have said so far, each with its place.
#[derive(Default)]
pub(super) struct Final {
    rgb: Option<([FinalInput; 4], Range<usize>)>,
    alpha: Option<(FinalInput, Range<usize>)>,
    product: Option<([FinalInput; 2], Range<usize>)>,
    sum: Option<([bool; 2], Range<usize>)>,
    clamp: Option<Range<usize>>,
}

const ZERO: FinalInput = FinalInput { register: FinalRegister::Zero, component: Component::Rgb, invert: false };
const ONE: FinalInput = FinalInput { register: FinalRegister::Zero, component: Component::Rgb, invert: true };

impl Final {
    /// Reads one of them.
    pub(super) fn statement(&mut self, parser: &mut Parser<'_>) -> Result<(), GivenUp> {
        let start = parser.here();
        match parser.word() {
            "clamp_color_sum" => {
                parser.call()?;
                parser.once(&mut self.clamp, start);
            }
            "final_product" => {
                parser.advance();
                parser.sign('=')?;
                let e = operand(parser, 4)?;
                parser.sign('*')?;
                let f = operand(parser, 5)?;
                parser.sign(';')?;
                set(parser, &mut self.product, [e, f], start);
            }
            "color_sum" => {
                parser.advance();
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

    /// `out.rgb = ...;` or `out.a = ...;`
    fn out(&mut self, parser: &mut Parser<'_>) -> Result<(), GivenUp> {
        let start = parser.here().start;
        parser.advance();
        parser.sign('.')?;
        let what = parser.word();
        let span = start..parser.here().end;
        if !matches!(what, "rgb" | "a") {
            return Err(parser.unknown_or_expected("output", &["rgb", "a"]));
        }
        parser.advance();
        parser.sign('=')?;
        if what == "a" {
            let g = operand(parser, 6)?;
            parser.sign(';')?;
            set(parser, &mut self.alpha, g, span);
            return Ok(());
        }
        let inputs = rgb(parser)?;
        parser.sign(';')?;
        set(parser, &mut self.rgb, inputs, span);
        Ok(())
    }

    /// The state of it all. Without any statement it is OpenGL's initial one.
    pub(super) fn finish(self, parser: &mut Parser<'_>, constants: [[u8; 4]; 2]) -> FinalCombiner {
        let first = self.alpha.as_ref().map(|(_, span)| span.clone());
        let first = first.or(self.product.as_ref().map(|(_, span)| span.clone()));
        let first = first.or(self.sum.as_ref().map(|(_, span)| span.clone())).or(self.clamp.clone());
        let initial = FinalCombiner::initial(constants);
        let Some((inputs, _)) = self.rgb else {
            if let Some(span) = first {
                parser.give_up(
                    Diagnostic::error("NB0202", span, "this final combiner has no `out.rgb`")
                        .label("without it")
                        .help("write `out.rgb = ...;`, or leave the whole final combiner out"),
                );
            }
            return initial;
        };
        let [a, b, c, d] = inputs;
        let [e, f] = self.product.map_or([ZERO; 2], |(inputs, _)| inputs);
        let [invert_spare0, invert_secondary] = self.sum.map_or([false; 2], |(inverts, _)| inverts);
        FinalCombiner {
            inputs: [a, b, c, d, e, f],
            g: self.alpha.map_or(initial.g, |(g, _)| g),
            color_sum_clamp: self.clamp.is_some(),
            invert_spare0,
            invert_secondary,
            constants,
        }
    }
}

/// Keeps what a statement says, once.
fn set<T>(parser: &mut Parser<'_>, slot: &mut Option<(T, Range<usize>)>, value: T, span: Range<usize>) {
    match slot {
        Some((_, first)) => {
            let first = first.clone();
            parser.twice(span, first, "this");
        }
        None => *slot = Some((value, span)),
    }
}

/// `lerp(a, b, c) + d`, `a * b + d`, `a + d`, `d`: A B + (1 - A) C + D.
fn rgb(parser: &mut Parser<'_>) -> Result<[FinalInput; 4], GivenUp> {
    let mut inputs = [ZERO; 4];
    if parser.word() == "lerp" {
        parser.advance();
        parser.sign('(')?;
        for n in 0..3 {
            if n > 0 {
                parser.sign(',')?;
            }
            inputs[n] = operand(parser, n)?;
        }
        parser.sign(')')?;
    } else {
        // Where a lone operand stands in the sum is known behind it.
        let first = unplaced(parser, false)?;
        let slot = if parser.is('*') || parser.is('+') { 0 } else { 3 };
        inputs[slot] = place(parser, slot, first);
        if slot == 0 {
            inputs[1] = ONE;
        }
        if parser.is('*') {
            parser.advance();
            inputs[1] = operand(parser, 1)?;
        }
        if slot == 3 {
            return Ok(inputs);
        }
    }
    if parser.is('+') {
        parser.advance();
        inputs[3] = operand(parser, 3)?;
    }
    Ok(inputs)
}

/// Input n of the final combiner.
fn operand(parser: &mut Parser<'_>, n: usize) -> Result<FinalInput, GivenUp> {
    let operand = unplaced(parser, n == 6)?;
    Ok(place(parser, n, operand))
}

/// Notes where input n stands.
fn place(parser: &mut Parser<'_>, n: usize, operand: Operand) -> FinalInput {
    parser.places.set(Place::FinalInput(n), operand.span);
    if let Some(component) = operand.component {
        parser.places.set(Place::FinalComponent(n), component);
    }
    operand.input
}

/// An input and its place.
struct Operand {
    input: FinalInput,
    span: Range<usize>,
    /// Where the component stands, if it is written.
    component: Option<Range<usize>>,
}

/// `spare0`, `spare0.a`, `unsigned_invert(spare0)`, `unsigned(spare0)`
fn unplaced(parser: &mut Parser<'_>, alpha: bool) -> Result<Operand, GivenUp> {
    let start = parser.here().start;
    let function = parser.word();
    if parser.is('-') || matches!(function, "expand" | "half_bias") {
        let name = if function.is_empty() { "-" } else { function };
        let finding = Diagnostic::error("NB0311", parser.here(), format!("the final combiner has no mapping `{name}`"))
            .label("not here")
            .rule("FIN-1")
            .help("its inputs are taken as they are, or inverted: `spare0`, `unsigned_invert(spare0)`; map in a stage");
        return Err(parser.give_up(finding));
    }
    let mapped = matches!(function, "unsigned" | "unsigned_invert");
    if mapped {
        parser.advance();
        parser.sign('(')?;
    } else if find(function).is_none() && !function.is_empty() {
        let known: Vec<&str> =
            REGISTERS.iter().map(|(name, _)| *name).chain(["unsigned", "unsigned_invert", "lerp"]).collect();
        return Err(parser.unknown("input", &known));
    }
    let Source { register, component, .. } = parser.register()?;
    if mapped {
        parser.sign(')')?;
    }
    let plain = if alpha { Component::Alpha } else { Component::Rgb };
    let (read, component) = component.map_or((plain, None), |(read, place)| (read, Some(place)));
    let input = FinalInput { register, component: read, invert: function == "unsigned_invert" };
    Ok(Operand { input, span: start..parser.end(), component })
}

/// A side of the colour sum: the register, as it is or inverted.
fn side(parser: &mut Parser<'_>, wanted: FinalRegister) -> Result<bool, GivenUp> {
    let Operand { input, span, .. } = unplaced(parser, false)?;
    if input.register != wanted || input.component != Component::Rgb {
        let finding = Diagnostic::error("NB0104", span, "the colour sum is that of spare0 and col1")
            .label("not this")
            .rule("FIN-3")
            .help("write `color_sum = spare0 + col1;`, each as it is or in `unsigned_invert(...)`");
        return Err(parser.give_up(finding));
    }
    Ok(input.invert)
}
