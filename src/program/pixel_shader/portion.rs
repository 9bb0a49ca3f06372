//! Makes the portions of one general stage: the inputs of each instruction, and its output.

use super::constants::Pool;
use super::factor::{Factor, Part, Preparation, product};
use super::lower::{Lowering, StagePortion};
use super::scratch::hardware;
use super::{Arithmetic, Mask, Modifier, Operation, Target};
use ninebit::state::{Component, InputMapping, Portion, Profile, Register};

impl Lowering {
    /// Makes the portions of an instruction or pair.
    pub(super) fn stage(&self, slot: &[Arithmetic], pool: &mut Pool) -> Result<[StagePortion; 2], Preparation> {
        let mut halves = [Component::Rgb, Component::Alpha].map(|component| (Portion::idle(component), true));
        // Alpha comes first: colours can use the alphas of constants that it leaves.
        for alpha in [true, false] {
            for (n, instruction) in slot.iter().enumerate() {
                if instruction.target.value.mask.has(alpha) && !(alpha && instruction.operation == Operation::Dp3) {
                    halves[usize::from(alpha)] = self.portion(instruction, n, alpha, pool)?;
                }
            }
        }
        // On NV10 an alpha that is kept in blue is copied to alpha before a colour overwrites it.
        for instruction in slot {
            let Target { register, mask } = instruction.target.value;
            let Some(register) = hardware(register) else { continue };
            if mask == Mask::Color && self.value(register).alpha_is_blue {
                let alpha = &mut halves[1];
                if alpha.0 != Portion::idle(Component::Alpha) {
                    return Err(Preparation::Alpha(register));
                }
                *alpha = self.copied_alpha(register);
            }
        }
        Ok(halves)
    }

    pub(super) fn portion(
        &self,
        instruction: &Arithmetic,
        n: usize,
        alpha: bool,
        pool: &mut Pool,
    ) -> Result<StagePortion, Preparation> {
        let Arithmetic { operation, sources, target, scale, paired, .. } = instruction;
        let component = if alpha { Component::Alpha } else { Component::Rgb };
        let output = hardware(target.value.register).ok_or(Preparation::Refused)?;
        let mut portion = Portion { scale: *scale, ..Portion::idle(component) };
        let unit = Factor::one(alpha);
        let mut read = |n: usize, part: Part| {
            let source = &sources.get(n).ok_or(Preparation::Refused)?.value;
            self.factor(source, alpha, false, part, pool)
        };
        // A colour `cnd` behind `+` does not compare.
        let selects = *operation == Operation::Cnd && !(*paired && target.value.mask == Mask::Color);
        let (ab, cd) = match operation {
            Operation::Mov | Operation::Mul => {
                let mixed = sources.iter().position(|source| self.is_mixed(&source.value, alpha));
                let at = mixed.unwrap_or(0);
                let other = if *operation == Operation::Mul { read(1 - at.min(1), Part::Whole)? } else { unit };
                match mixed {
                    // The positive and the negative part are one product each.
                    Some(_) => {
                        let [positive, negative] = [read(at, Part::Positive)?, read(at, Part::Negative)?];
                        (product(other, positive)?, Some(product(other, negative)?))
                    }
                    None => (product(read(0, Part::Whole)?, other)?, None),
                }
            }
            Operation::Add => (product(read(0, Part::Whole)?, unit)?, Some(product(read(1, Part::Whole)?, unit)?)),
            Operation::Sub => {
                (product(read(0, Part::Whole)?, unit)?, Some(product(read(1, Part::Whole)?.minus(), unit)?))
            }
            Operation::Mad => {
                let ab = product(read(0, Part::Whole)?, read(1, Part::Whole)?)?;
                (ab, Some(product(read(2, Part::Whole)?, unit)?))
            }
            Operation::Lrp => {
                let [first, second] = [read(1, Part::Whole)?, read(2, Part::Whole)?];
                let weight = self.weight(instruction, n, alpha, pool)?;
                (product(weight, first)?, Some(product(weight.complement(), second)?))
            }
            Operation::Dp3 => (product(read(0, Part::Whole)?, read(1, Part::Whole)?)?, None),
            Operation::Cnd if selects => {
                if self.value(Register::Spare0).alpha_is_blue {
                    return Err(Preparation::Alpha(Register::Spare0));
                }
                // The mux takes CD where the condition holds (CMB-10).
                (product(read(2, Part::Whole)?, unit)?, Some(product(read(1, Part::Whole)?, unit)?))
            }
            Operation::Cnd => (product(read(1, Part::Whole)?, unit)?, None),
        };
        let ([a, b], mut positive) = ab;
        (portion.inputs[0], portion.inputs[1]) = (a, b);
        if let Some(([c, d], more)) = cd {
            (portion.inputs[2], portion.inputs[3]) = (c, d);
            positive &= more;
            portion.mux = selects;
            portion.sum_output = output;
        } else {
            portion.ab_output = output;
        }
        if *operation == Operation::Dp3 {
            portion.ab_dot_product = true;
            portion.ab_blue_to_alpha = target.value.mask == Mask::All && self.profile == Profile::Nv2a;
        }
        Ok((portion, positive))
    }

    /// Returns the first source of `lrp`, which has to be readable both as it is and as its complement.
    fn weight(&self, instruction: &Arithmetic, n: usize, alpha: bool, pool: &mut Pool) -> Result<Factor, Preparation> {
        if let Some(register) = self.held.factors.get(n).copied().flatten() {
            // It has been computed: each channel reads its own.
            let component = if alpha { Component::Alpha } else { Component::Rgb };
            return Ok(Factor::unsigned(register, component, InputMapping::UnsignedIdentity));
        }
        let source = &instruction.sources.first().ok_or(Preparation::Refused)?.value;
        if source.negate || matches!(source.modifier, Modifier::Bias | Modifier::SignedScale) {
            return Err(Preparation::Factor(n));
        }
        self.factor(source, alpha, true, Part::Whole, pool)
    }
}
