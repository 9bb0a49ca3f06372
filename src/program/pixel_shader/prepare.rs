//! Adds the stages that have to run before an instruction so that it fits one stage.

use super::constants::Pool;
use super::factor::Preparation;
use super::lower::{Lowering, StagePortion};
use super::scratch::{Set, free};
use super::{Arithmetic, Operation, print};
use crate::Span;
use crate::cascade::{TEXTURES, one, too_many_constants};
use crate::finding::finding;
use ninebit::state::{CombinerInput, Component, InputMapping, Portion, Profile, Register, Scale, StageOrigin};

impl Lowering {
    /// Adds a stage before the instruction. Returns `None` after recording that nothing helps.
    pub(super) fn prepare(&mut self, need: Preparation, slot: &[Arithmetic], live: Set, span: &Span) -> Option<()> {
        let idle = |component| (Portion::idle(component), true);
        let mut pool = if self.profile == Profile::Nv10 { self.pool } else { Pool::default() };
        let ([rgb, alpha], what) = match need {
            Preparation::Limit(register) => (
                [self.limited(register, false), self.limited(register, true)],
                format!("{} limited to 0..1", name(register)),
            ),
            Preparation::Alpha(register) => {
                ([idle(Component::Rgb), self.copied_alpha(register)], format!("the alpha of {}", name(register)))
            }
            Preparation::Constant(index) => {
                let register = self.scratch(live, span)?;
                let constant = self.constants.get(usize::from(index)).copied().unwrap_or_default();
                let halves = [false, true].map(|alpha| self.loaded(constant, alpha, register, &mut pool));
                if let Some(slot) = self.held.constants.get_mut(usize::from(index)) {
                    *slot = Some(register);
                }
                let [Some(rgb), Some(alpha)] = halves else {
                    self.findings.push(too_many_constants(self.profile, span.clone()));
                    return None;
                };
                ([rgb, alpha], format!("c{index}"))
            }
            Preparation::Factor(n) => {
                let register = self.scratch(live, span)?;
                let instruction = slot.get(n)?;
                let source = instruction.sources.first()?;
                let copy = Arithmetic {
                    operation: Operation::Mov,
                    scale: Scale::One,
                    saturate: false,
                    target: instruction.target.clone(),
                    sources: vec![source.clone()],
                    paired: false,
                    span: span.clone(),
                };
                let mut halves = [idle(Component::Rgb), idle(Component::Alpha)];
                for alpha in [true, false] {
                    if instruction.target.value.mask.has(alpha) {
                        match self.portion(&copy, n, alpha, &mut pool) {
                            Ok((mut portion, positive)) => {
                                for output in [&mut portion.ab_output, &mut portion.sum_output] {
                                    *output = if *output == Register::Zero { *output } else { register };
                                }
                                halves[usize::from(alpha)] = (portion, positive);
                            }
                            Err(need) => return self.prepare(need, slot, live, span),
                        }
                    }
                }
                if let Some(slot) = self.held.factors.get_mut(n) {
                    *slot = Some(register);
                }
                (halves, "the first source".to_owned())
            }
            Preparation::Refused => {
                let message = "this instruction has no form in the register combiners";
                let help = "write it with other modifiers, or in two instructions";
                self.findings.push(finding("NB0379", span.clone(), message, "no form", help).rule("CMB-12"));
                return None;
            }
        };
        if self.profile == Profile::Nv10 {
            self.pool = pool;
        }
        let instruction = slot.first().map(|first| format!(", for {}", print::instruction(first))).unwrap_or_default();
        let origin = format!("pixel shader: {what}{instruction}");
        self.push(rgb, alpha, pool, StageOrigin { rgb: origin.clone(), alpha: origin }, span.clone());
        Some(())
    }

    /// Makes a portion that loads a constant with both signs, as the difference of two constants.
    fn loaded(&self, constant: [i16; 4], alpha: bool, register: Register, pool: &mut Pool) -> Option<StagePortion> {
        let component = if alpha { Component::Alpha } else { Component::Rgb };
        let [r, g, b, a] = constant;
        let mut portion = Portion::idle(component);
        let mut input = |sign: i16, mapping| {
            let byte = |c: i16| (sign * c).clamp(0, 255) as u8;
            let found = if alpha { pool.alpha(byte(a)) } else { pool.color([r, g, b].map(byte)) };
            found.map(|(register, component)| CombinerInput { register, component, mapping })
        };
        let (positive, negative) = (input(1, InputMapping::SignedIdentity)?, input(-1, InputMapping::SignedNegate)?);
        portion.inputs = [positive, one(alpha), negative, one(alpha)];
        portion.sum_output = register;
        Some((portion, false))
    }

    fn scratch(&mut self, live: Set, span: &Span) -> Option<Register> {
        let mut found = free(live, &self.held.taken, self.profile);
        if found.is_none() {
            // Constants can be loaded again.
            self.held.keep(|_| false);
            found = free(live, &self.held.taken, self.profile);
        }
        match found {
            Some(register) => self.held.taken.push(register),
            None => self.no_register(span),
        }
        found
    }

    pub(super) fn no_register(&mut self, span: &Span) {
        let message = "this instruction needs a register more than are free";
        let help = "write it in two instructions, or read fewer texture registers after it";
        self.findings.push(finding("NB0379", span.clone(), message, "for a value in between", help).rule("CMB-12"));
    }

    /// Makes a portion that replaces x by max(0, x), if that is still to be done.
    fn limited(&self, register: Register, alpha: bool) -> StagePortion {
        let value = self.value(register);
        if alpha && value.alpha_is_blue {
            return self.copied_alpha(register);
        }
        let component = if alpha { Component::Alpha } else { Component::Rgb };
        if !value.halves[usize::from(alpha)].limit {
            return (Portion::idle(component), true);
        }
        (rewritten(register, component, InputMapping::UnsignedIdentity, alpha), true)
    }

    /// Makes a portion that copies blue to alpha, unchanged.
    pub(super) fn copied_alpha(&self, register: Register) -> StagePortion {
        let half = self.value(register).halves[1];
        let mapping = if half.limit { InputMapping::UnsignedIdentity } else { InputMapping::SignedIdentity };
        (rewritten(register, Component::Blue, mapping, true), half.limit || !half.negative)
    }
}

/// Returns the shader's name of a register.
fn name(register: Register) -> String {
    match TEXTURES.iter().position(|texture| *texture == register) {
        Some(unit) => format!("t{unit}"),
        None if register == Register::Spare0 => "r0".to_owned(),
        None => "r1".to_owned(),
    }
}

/// Makes a portion that writes a mapped component of a register to the register itself.
fn rewritten(register: Register, component: Component, mapping: InputMapping, alpha: bool) -> Portion {
    let mut portion = Portion::idle(if alpha { Component::Alpha } else { Component::Rgb });
    (portion.inputs[0], portion.inputs[1]) = (CombinerInput { register, component, mapping }, one(alpha));
    portion.ab_output = register;
    portion
}
