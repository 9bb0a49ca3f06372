//! Equations of stages, final combiner and blend, as far as the plan has kept them: the order of a pixel evaluated on [`EquationText`]. Inputs are written
//! as in the combiner language.

use ninebit::algebra::Algebra;
use ninebit::combiner::final_combiner::{self, PlannedFinal};
use ninebit::combiner::general::{self, PlannedPortion, PlannedStage};
use ninebit::combiner::registers::Registers;
use ninebit::plan::PlannedDraw;
use ninebit::rop::blend;
use ninebit::state::{Bias, FinalRegister, InputMapping, MuxSelect, Named, Policies, Register, Scale};
use ninebit::trace::Rule;
use ninebit_program::text::words::{mapped, register};

/// A term; products bind closer than sums.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Term {
    Zero,
    One,
    /// An atom, which is written as it is.
    Plain(String),
    /// A register or special input of the final combiner, clamped to 0 from below.
    Unsigned(String),
    Product(String),
    Sum(String),
    /// A sum that can exceed 1.
    Above(String),
}

impl Term {
    fn sum(self) -> String {
        match self {
            Term::Zero => "0".to_string(),
            Term::One => "1".to_string(),
            Term::Plain(text) | Term::Unsigned(text) | Term::Product(text) | Term::Sum(text) | Term::Above(text) => {
                text
            }
        }
    }

    fn factor(self) -> String {
        match self {
            Term::Sum(text) | Term::Above(text) => format!("({text})"),
            other => other.sum(),
        }
    }

    /// Returns the term, in parentheses unless it is one word.
    fn whole(self) -> String {
        match self {
            Term::Product(text) => format!("({text})"),
            other => other.factor(),
        }
    }
}

/// Index of a term.
#[derive(Clone, Copy, Debug)]
struct Text(usize);

/// The algebra that prints the order of a pixel. A portion is printed once, as its first channel.
#[derive(Debug, Default)]
struct EquationText {
    terms: Vec<Term>,
    policies: Policies,
}

impl EquationText {
    fn push(&mut self, term: Term) -> Text {
        self.terms.push(term);
        Text(self.terms.len() - 1)
    }

    fn term(&self, text: Text) -> Term {
        self.terms[text.0].clone()
    }

    fn text(&self, text: Text) -> String {
        self.term(text).sum()
    }

    /// Returns registers that hold their own names: colour, blue and alpha as the component that an input reads.
    fn registers(&mut self) -> Registers<Text> {
        let zero = self.push(Term::Zero);
        let mut registers = Registers::from_value(zero);
        for of in Register::ALL.iter().filter(|of| **of != Register::Zero) {
            for (channel, suffix) in ["", "", ".b", ".a"].into_iter().enumerate() {
                let name = self.push(Term::Plain(format!("{}{suffix}", register(*of))));
                registers.write(*of, channel, name);
            }
        }
        registers
    }

    fn times(&mut self, a: Text, b: Text) -> Text {
        let term = match (self.term(a), self.term(b)) {
            (Term::Zero, _) | (_, Term::Zero) => Term::Zero,
            (Term::One, x) | (x, Term::One) => x,
            (a, b) => Term::Product(format!("{} * {}", a.factor(), b.factor())),
        };
        self.push(term)
    }
}

impl Algebra for EquationText {
    type Register = Text;
    type Factor = Text;
    type Sum = Text;
    type Choice = &'static str;

    fn policies(&self) -> &Policies {
        &self.policies
    }
    fn byte(&mut self, value: u8) -> Text {
        self.push(match value {
            0 => Term::Zero,
            255 => Term::One,
            byte => Term::Plain(format!("{byte}/255")),
        })
    }
    fn map(&mut self, mapping: InputMapping, x: Text) -> Text {
        let (term, name) = (self.term(x), if self.term(x) == Term::Zero { "zero".to_owned() } else { self.text(x) });
        let term = match (mapping, term) {
            (
                InputMapping::UnsignedIdentity | InputMapping::SignedIdentity | InputMapping::SignedNegate,
                Term::Zero,
            ) => Term::Zero,
            (InputMapping::UnsignedInvert, Term::Zero) => Term::One,
            (InputMapping::SignedIdentity, term) => term,
            (mapping, _) => Term::Plain(mapped(mapping, name)),
        };
        self.push(term)
    }
    fn plain(&mut self, x: Text) -> Text {
        x
    }
    fn product(&mut self, rule: Rule, a: Text, b: Text) -> Text {
        if rule != Rule::Cmb8 {
            return self.times(a, b);
        }
        let term = Term::Product(format!("{} . {}", self.term(a).factor(), self.term(b).factor()));
        self.push(term)
    }
    fn add(&mut self, rule: Rule, a: Text, b: Text) -> Text {
        // The first of a dot product's three terms stands for all.
        if rule == Rule::Cmb8 { a } else { self.plus(a, b) }
    }
    fn subtract(&mut self, _rule: Rule, a: Text, b: Text) -> Text {
        self.minus(a, b)
    }
    fn widened(&mut self, _rule: Rule, x: Text) -> Text {
        x
    }
    fn choice(&mut self, select: MuxSelect, _spare0_alpha: Text) -> &'static str {
        match select {
            MuxSelect::Msb => "spare0.a >= 1/2",
            MuxSelect::Lsb => "spare0.a is odd",
        }
    }
    fn select(&mut self, takes_cd: &'static str, cd: Text, ab: Text) -> Text {
        let term = Term::Plain(format!("({takes_cd} ? {} : {})", self.text(cd), self.text(ab)));
        self.push(term)
    }
    fn rounded(&mut self, sum: Text) -> Text {
        sum
    }
    fn rounded_after(&mut self, bias: Bias, scale: Scale, sum: Text) -> Text {
        self.scaled(bias, scale, sum)
    }
    fn scaled(&mut self, bias: Bias, scale: Scale, x: Text) -> Text {
        let biased = match bias {
            Bias::None => self.term(x),
            Bias::NegativeHalf => Term::Sum(format!("{} - 1/2", self.text(x))),
        };
        let times = |number: &str, term: Term| Term::Product(format!("{number} * {}", term.whole()));
        let term = match scale {
            Scale::One => biased,
            Scale::Two => times("2", biased),
            Scale::Four => times("4", biased),
            Scale::Half => times("1/2", biased),
        };
        self.push(term)
    }
    fn saturated(&mut self, x: Text) -> Text {
        x
    }
    fn max0(&mut self, x: Text) -> Text {
        match self.term(x) {
            Term::Plain(name) => self.push(Term::Unsigned(name)),
            _ => x,
        }
    }
    fn complement(&mut self, x: Text) -> Text {
        let term = match self.term(x) {
            Term::Zero => Term::One,
            Term::One => Term::Zero,
            Term::Unsigned(name) => Term::Plain(format!("unsigned_invert({name})")),
            x => Term::Sum(format!("1 - {}", x.factor())),
        };
        self.push(term)
    }
    fn plus(&mut self, a: Text, b: Text) -> Text {
        match (self.term(a), self.term(b)) {
            (Term::Zero, _) => b,
            (_, Term::Zero) => a,
            (a, b) => self.push(Term::Above(format!("{} + {}", a.sum(), b.sum()))),
        }
    }
    fn minus(&mut self, a: Text, b: Text) -> Text {
        let term = Term::Sum(format!("{} - {}", self.text(a), self.term(b).factor()));
        self.push(term)
    }
    fn least(&mut self, a: Text, b: Text) -> Text {
        let term = match (self.term(a), self.term(b)) {
            // Nothing else exceeds 1.
            (Term::Above(sum), Term::One) => Term::Product(format!("min(1, {sum})")),
            (Term::Unsigned(name), Term::One) => Term::Plain(name),
            (a, Term::One) => a,
            (a, b) => Term::Plain(format!("min({}, {})", a.sum(), b.sum())),
        };
        self.push(term)
    }
    fn greatest(&mut self, a: Text, b: Text) -> Text {
        let term = Term::Plain(format!("max({}, {})", self.text(a), self.text(b)));
        self.push(term)
    }
    fn clamped(&mut self, x: Text) -> Text {
        x
    }
    fn truncated(&mut self, _bits: u32, x: Text) -> Text {
        x
    }
    fn signed_byte(&mut self, x: Text) -> Text {
        let term = Term::Plain(format!("signed byte({})", self.text(x)));
        self.push(term)
    }
}

/// Returns the equations of a stage, as far as their results are needed.
pub(super) fn stage(stage: &PlannedStage, mux_select: MuxSelect) -> Vec<String> {
    let mut lines = Vec::new();
    for (n, constant) in [Register::ConstantColor0, Register::ConstantColor1].into_iter().enumerate() {
        if reads(&stage.rgb, constant) || reads(&stage.alpha, constant) {
            let [r, g, b, a] = stage.constants[n];
            lines.push(format!("{} = {r}, {g}, {b}, {a}", register(constant)));
        }
    }
    let mut printed = EquationText::default();
    let registers = printed.registers();
    let values = general::evaluate(stage, mux_select, &registers, &mut printed);
    let [rgb, alpha] = [values.rgb.outputs.map(|all| all[0]), values.alpha.outputs.map(|all| all[0])];
    for (planned, outputs) in [(&stage.rgb, rgb), (&stage.alpha, alpha)] {
        let portion = &planned.portion;
        let destinations = [portion.ab_output, portion.cd_output, portion.sum_output];
        for (n, (output, destination)) in outputs.into_iter().zip(destinations).enumerate() {
            let name = register(destination);
            if planned.live[n] != 0 {
                lines.push(format!("{name}.{} = {}", super::channels(planned.live[n]), printed.text(output)));
            }
            if n < 2 && planned.blue_to_alpha[n] {
                lines.push(format!("{name}.a = blue of {}", ["AB", "CD"][n]));
            }
        }
    }
    lines.iter().map(|line| format!("stage {}: {line}", stage.index)).collect()
}

/// Returns whether a needed product reads the register.
fn reads(planned: &PlannedPortion, register: Register) -> bool {
    (0..2).any(|n| {
        let inputs = &planned.portion.inputs[2 * n..2 * n + 2];
        planned.product_channels(n) != 0 && inputs.iter().any(|input| input.register == register)
    })
}

/// Returns the equations of the final combiner, as far as their results are needed.
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
    let mut printed = EquationText::default();
    let registers = printed.registers();
    let fragment = final_combiner::evaluate(state, &registers, &mut printed).fragment;
    for (live, value) in [(planned.live & 7, fragment[0]), (planned.live & 8, fragment[3])] {
        if live != 0 {
            lines.push(format!("fragment.{} = {}", super::channels(live), printed.text(value)));
        }
    }
    lines
}

/// Returns the equation of the blend, if there is one.
pub(super) fn blend(planned: &PlannedDraw) -> Option<String> {
    let state = planned.blend.as_ref()?;
    let mut printed = EquationText::default();
    let mut color = |name: &str| ["", "", "", ".a"].map(|suffix| printed.push(Term::Plain(format!("{name}{suffix}"))));
    let (source, destination, constant) = (color("fragment"), color("destination"), color("constant"));
    // Alpha is blended like colour, except that one factor is 1 there.
    let channel = if planned.blended & 7 == 0 { 3 } else { 0 };
    let values = blend::evaluate(state, channel, &source, &destination, &constant, &mut printed);
    Some(format!("blend.{} = {}", super::channels(planned.blended), printed.text(values.blended)))
}
