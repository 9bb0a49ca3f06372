//! Stages, final combiner and blend as equations, of what is left in the plan. Inputs are written as in the combiner language.

use crate::combiner::final_combiner::PlannedFinal;
use crate::combiner::general::{PlannedPortion, PlannedStage};
use crate::plan::PlannedDraw;
use crate::program::text::words::{final_operand, operand, register};
use crate::rop::blend::{is_signed, uses_factors};
use crate::state::{
    Bias, BlendEquation, BlendFactor, CombinerInput, Component, FinalInput, FinalRegister, InputMapping, MuxSelect,
    Named, Portion, Register, Scale,
};

/// A term; products bind closer than sums.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Term {
    Zero,
    One,
    Plain(String),
    Sum(String),
}

impl Term {
    fn sum(self) -> String {
        match self {
            Term::Zero => "0".to_string(),
            Term::One => "1".to_string(),
            Term::Plain(text) | Term::Sum(text) => text,
        }
    }

    fn factor(self) -> String {
        match self {
            Term::Sum(text) => format!("({text})"),
            other => other.sum(),
        }
    }

    fn times(self, other: Term) -> Term {
        match (self, other) {
            (Term::Zero, _) | (_, Term::Zero) => Term::Zero,
            (Term::One, x) | (x, Term::One) => x,
            (a, b) => Term::Plain(format!("{} * {}", a.factor(), b.factor())),
        }
    }

    fn plus(self, other: Term) -> Term {
        match (self, other) {
            (Term::Zero, x) | (x, Term::Zero) => x,
            (a, b) => Term::Sum(format!("{} + {}", a.sum(), b.sum())),
        }
    }

    fn complement(self) -> Term {
        match self {
            Term::Zero => Term::One,
            Term::One => Term::Zero,
            x => Term::Sum(format!("1 - {}", x.factor())),
        }
    }
}

fn input(input: &CombinerInput, alpha: bool) -> Term {
    match (input.register, input.mapping) {
        (
            Register::Zero,
            InputMapping::UnsignedIdentity | InputMapping::SignedIdentity | InputMapping::SignedNegate,
        ) => Term::Zero,
        (Register::Zero, InputMapping::UnsignedInvert) => Term::One,
        _ => Term::Plain(operand(input, alpha)),
    }
}

fn product(portion: &Portion, n: usize, alpha: bool) -> Term {
    let [a, b] = [0, 1].map(|k| input(&portion.inputs[2 * n + k], alpha));
    if [portion.ab_dot_product, portion.cd_dot_product][n] {
        Term::Plain(format!("{} . {}", a.factor(), b.factor()))
    } else {
        a.times(b)
    }
}

fn output(portion: &Portion, term: Term) -> String {
    let biased = match portion.bias {
        Bias::None => term,
        Bias::NegativeHalf => Term::Sum(format!("{} - 1/2", term.sum())),
    };
    let whole = |text: Term| match text {
        Term::Plain(text) if text.contains(' ') => format!("({text})"),
        other => other.factor(),
    };
    match portion.scale {
        Scale::One => biased.sum(),
        Scale::Two => format!("2 * {}", whole(biased)),
        Scale::Four => format!("4 * {}", whole(biased)),
        Scale::Half => format!("1/2 * {}", whole(biased)),
    }
}

/// The channels of a destination that count: `rgb`, or those of them.
fn live(mask: u8) -> String {
    super::channels(mask)
}

/// What a stage computes, of what is needed.
pub(super) fn stage(stage: &PlannedStage, mux_select: MuxSelect) -> Vec<String> {
    let mut lines = Vec::new();
    for (n, constant) in [Register::ConstantColor0, Register::ConstantColor1].into_iter().enumerate() {
        if reads(&stage.rgb, constant) || reads(&stage.alpha, constant) {
            let [r, g, b, a] = stage.constants[n];
            lines.push(format!("{} = {r}, {g}, {b}, {a}", register(constant)));
        }
    }
    lines.extend(portion(&stage.rgb, false, mux_select));
    lines.extend(portion(&stage.alpha, true, mux_select));
    lines.iter().map(|line| format!("stage {}: {line}", stage.index)).collect()
}

/// Whether a product that is needed has the register for a factor.
fn reads(planned: &PlannedPortion, register: Register) -> bool {
    (0..2).any(|n| {
        let inputs = &planned.portion.inputs[2 * n..2 * n + 2];
        planned.product_channels(n) != 0 && inputs.iter().any(|input| input.register == register)
    })
}

fn portion(planned: &PlannedPortion, alpha: bool, mux_select: MuxSelect) -> Vec<String> {
    let portion = &planned.portion;
    let [ab, cd] = [0, 1].map(|n| product(portion, n, alpha));
    let third = if portion.mux {
        let condition = match mux_select {
            MuxSelect::Msb => "spare0.a >= 1/2",
            MuxSelect::Lsb => "spare0.a is odd",
        };
        Term::Plain(format!("({condition} ? {} : {})", cd.clone().sum(), ab.clone().sum()))
    } else {
        ab.clone().plus(cd.clone())
    };
    let outputs = [(ab, portion.ab_output), (cd, portion.cd_output), (third, portion.sum_output)];
    let mut lines = Vec::new();
    for (n, (term, destination)) in outputs.into_iter().enumerate() {
        let name = register(destination);
        if planned.live[n] != 0 {
            lines.push(format!("{name}.{} = {}", live(planned.live[n]), output(portion, term)));
        }
        if n < 2 && planned.blue_to_alpha[n] {
            lines.push(format!("{name}.a = blue of {}", ["AB", "CD"][n]));
        }
    }
    lines
}

/// What the final combiner computes, of what is needed.
pub(super) fn final_combiner(planned: &PlannedFinal) -> Vec<String> {
    let state = &planned.state;
    let mut lines = Vec::new();
    let all = state.inputs.iter().chain([&state.g]);
    for (n, constant) in [FinalRegister::ConstantColor0, FinalRegister::ConstantColor1].into_iter().enumerate() {
        if planned.reads_constants && all.clone().any(|input| input.register == constant) {
            let [r, g, b, a] = state.constants[n];
            lines.push(format!("final: const{n} = {r}, {g}, {b}, {a}"));
        }
    }
    if planned.live & 7 != 0 {
        let [a, b, c, d] = [0, 1, 2, 3].map(|n| final_input(planned, &state.inputs[n], false));
        let lerp = a.clone().times(b).plus(a.complement().times(c));
        lines.push(format!("fragment.{} = {}", live(planned.live & 7), lerp.plus(d).sum()));
    }
    if planned.live & 8 != 0 {
        lines.push(format!("fragment.a = {}", final_input(planned, &state.g, true).sum()));
    }
    lines
}

fn final_input(planned: &PlannedFinal, input: &FinalInput, alpha: bool) -> Term {
    let state = &planned.state;
    let term = match input.register {
        FinalRegister::Zero => Term::Zero,
        // Their alpha is 0 (FIN-1).
        FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF if input.component == Component::Alpha => {
            Term::Zero
        }
        FinalRegister::Spare0PlusSecondary => {
            let side = |of: Register, invert: bool| {
                let name = register(of);
                if invert { format!("unsigned_invert({name})") } else { name.to_string() }
            };
            let spare0 = side(Register::Spare0, state.invert_spare0);
            let sum = format!("{spare0} + {}", side(Register::SecondaryColor, state.invert_secondary));
            if state.color_sum_clamp { Term::Plain(format!("min(1, {sum})")) } else { Term::Sum(sum) }
        }
        FinalRegister::ETimesF => {
            let [e, f] = [4, 5].map(|n| final_input(planned, &state.inputs[n], false));
            e.times(f)
        }
        _ => return Term::Plain(final_operand(input, alpha)),
    };
    if input.invert { term.complement() } else { term }
}

/// The blend of what is written.
pub(super) fn blend(planned: &PlannedDraw) -> Option<String> {
    let blend = planned.blend.as_ref()?;
    let factor = |factor: BlendFactor| match factor {
        BlendFactor::Zero => Term::Zero,
        BlendFactor::One => Term::One,
        other => Term::Plain(other.name().to_string()),
    };
    let side = |name: &str, f: BlendFactor| Term::Plain(name.to_string()).times(factor(f));
    let (s, d) = (side("fragment", blend.source), side("destination", blend.destination));
    let text = match blend.equation {
        BlendEquation::Add => s.plus(d).sum(),
        BlendEquation::Subtract => format!("{} - {}", s.sum(), d.sum()),
        BlendEquation::ReverseSubtract => format!("{} - {}", d.sum(), s.sum()),
        BlendEquation::Min => "min(fragment, destination)".to_string(),
        BlendEquation::Max => "max(fragment, destination)".to_string(),
        BlendEquation::SignedAdd => "destination + signed byte(fragment)".to_string(),
        BlendEquation::SignedReverseSubtract => "destination - signed byte(fragment)".to_string(),
    };
    debug_assert!(uses_factors(blend.equation) || is_signed(blend.equation) || text.starts_with('m'));
    Some(format!("blend.{} = {text}", live(planned.blended)))
}
