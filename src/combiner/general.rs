//! CMB-1, CMB-6 to CMB-11: one general combiner stage.
//!
//! [`dot_product`] and [`output`] are the rules that blocks of pixels share; [`run`] is a whole stage with every policy.

use super::mapping;
use super::registers::Registers;
use super::report::StageReport;
use crate::number::{Factor, Lane, Sum};
use crate::state::{
    Bias, CombinerInput, Component, DotRounding, MuxNegative, MuxSelect, OutputRounding, Policies, Portion, Register,
    RegisterFloor, Scale, SumRounding,
};
use crate::trace::{Decision, Observer, Rule, Work};

/// CMB-8: the sum of three full-width products, not yet rounded.
#[inline(always)]
pub fn dot_product<F: Factor>(a: [F; 3], b: [F; 3]) -> F::Sum {
    a[0].product(b[0]) + a[1].product(b[1]) + a[2].product(b[2])
}

/// CMB-9: rounded, biased, scaled, saturated. `settle` is told what each rule yields and returns what goes on.
#[inline(always)]
pub fn output<S: Sum>(
    raw: S,
    bias: Bias,
    scale: Scale,
    floor: RegisterFloor,
    mut settle: impl FnMut(OutputStep, S::Register) -> S::Register,
) -> S::Register
where
    S::Register: crate::number::Register,
{
    let v = settle(OutputStep::Rounded, raw.rounded());
    finished(v, bias, scale, floor, settle)
}

/// What [`output`] does after the rounding.
#[inline(always)]
pub fn finished<R: crate::number::Register>(
    v: R,
    bias: Bias,
    scale: Scale,
    floor: RegisterFloor,
    mut settle: impl FnMut(OutputStep, R) -> R,
) -> R {
    let v = settle(OutputStep::Scaled, scaled(biased(v, bias), scale));
    settle(OutputStep::Saturated, v.saturated(floor))
}

/// What [`output`] has done to a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputStep {
    /// NUM-2.
    Rounded,
    /// CMB-9.
    Scaled,
    /// NUM-3.
    Saturated,
}

#[inline(always)]
pub(super) fn biased<R: crate::number::Register>(v: R, bias: Bias) -> R {
    match bias {
        Bias::None => v,
        Bias::NegativeHalf => v - R::HALF,
    }
}

#[inline(always)]
pub(super) fn scaled<R: crate::number::Register>(v: R, scale: Scale) -> R {
    match scale {
        Scale::One => v,
        Scale::Two => v + v,
        Scale::Four => (v + v) + (v + v),
        Scale::Half => v.halved(),
    }
}

/// CMB-9=after: biased and scaled at full width, then rounded; not yet saturated.
#[inline(always)]
pub(super) fn rounded_after<L: Lane>(raw: L::Full, bias: Bias, scale: Scale) -> L {
    let raw = match bias {
        Bias::None => raw,
        Bias::NegativeHalf => raw - L::HALF.widened(),
    };
    match scale {
        Scale::One => raw.rounded(),
        Scale::Two => (raw + raw).rounded(),
        Scale::Four => ((raw + raw) + (raw + raw)).rounded(),
        Scale::Half => L::rounded_half(raw),
    }
}

/// CMB-10: whether the mux takes CD.
#[inline]
pub fn mux_takes_cd<L: Lane>(spare0_alpha: L, select: MuxSelect, policies: &Policies) -> bool {
    takes_cd(spare0_alpha.decision(), select, policies)
}

/// CMB-10 of SPARE0's alpha as an integer.
#[inline(always)]
pub fn takes_cd(v: i32, select: MuxSelect, policies: &Policies) -> bool {
    match select {
        MuxSelect::Lsb => v & 1 != 0,
        MuxSelect::Msb => match policies.mux_negative {
            MuxNegative::Sign => v >= 128,
            MuxNegative::Bit7 => v & 128 != 0,
        },
    }
}

/// A portion with what the plan found out: which channels of which output anybody reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedPortion {
    /// The state.
    pub portion: Portion,
    /// Channels of AB, CD and the sum or mux that are needed: bits R, G, B in an RGB portion, bit A (8) in an alpha portion.
    pub live: [u8; 3],
    /// AB's and CD's blue are needed in the alpha of their destination.
    pub blue_to_alpha: [bool; 2],
}

impl PlannedPortion {
    /// A portion of which everything that it writes is needed, in these channels.
    pub fn whole(portion: Portion, channels: u8) -> PlannedPortion {
        let live = |output: Register| if output == Register::Zero { 0 } else { channels };
        PlannedPortion {
            portion,
            live: [portion.ab_output, portion.cd_output, portion.sum_output].map(live),
            blue_to_alpha: [
                portion.ab_blue_to_alpha && portion.ab_output != Register::Zero,
                portion.cd_blue_to_alpha && portion.cd_output != Register::Zero,
            ],
        }
    }

    /// Whether nothing of it is needed.
    pub fn is_idle(&self) -> bool {
        self.live == [0; 3] && self.blue_to_alpha == [false; 2]
    }

    /// Channels of the product AB (0) or CD (1) that some output needs.
    pub fn product_channels(&self, product: usize) -> u8 {
        self.live[product] | self.live[2] | if self.blue_to_alpha[product] { BLUE } else { 0 }
    }
}

/// The bit of blue in a set of channels.
pub const BLUE: u8 = 4;

/// A general stage with its liveness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedStage {
    /// The stage's number in the scene's state.
    pub index: usize,
    /// RGB portion.
    pub rgb: PlannedPortion,
    /// Alpha portion.
    pub alpha: PlannedPortion,
    /// Constants of the stage, R, G, B, A bytes.
    pub constants: [[u8; 4]; 2],
    /// A needed input reads one of them.
    pub reads_constants: bool,
}

/// Everything that a portion computes, for its `N` channels: three in an RGB portion, one in an alpha portion.
///
/// What the plan found dead is left at zero.
pub(super) struct Values<L: Lane, const N: usize> {
    /// A, B, C, D after their mappings.
    pub(super) factors: [[L::Mapped; N]; 4],
    /// AB and CD at full width.
    pub(super) products: [[L::Full; N]; 2],
    /// The sum or mux at full width.
    pub(super) third: [L::Full; N],
    /// AB, CD and the sum or mux as registers.
    pub(super) outputs: [[L; N]; 3],
}

/// Runs a stage: reads everything, then writes everything (CMB-1).
#[inline]
pub fn run<L: Lane, O: Observer>(
    stage: &PlannedStage,
    mux_select: MuxSelect,
    policies: &Policies,
    registers: &mut Registers<L>,
    observer: &mut O,
) {
    if stage.reads_constants {
        registers.load(Register::ConstantColor0, stage.constants[0].map(L::byte));
        registers.load(Register::ConstantColor1, stage.constants[1].map(L::byte));
    }
    let spare0 = registers.read(Register::Spare0, 3);
    let takes_cd = mux_takes_cd(spare0, mux_select, policies);
    let muxes = [&stage.rgb, &stage.alpha].into_iter().any(|p| p.portion.mux && p.live[2] != 0);
    if O::MEASURES && muxes {
        let ideal = || i64::from(self::takes_cd(spare0.ideal_decision(), mux_select, policies));
        observer.decided(Decision::Mux, i64::from(takes_cd), ideal);
    }
    let rgb = evaluate::<L, O, 3>(&stage.rgb, takes_cd, policies, registers, observer);
    let alpha = evaluate::<L, O, 1>(&stage.alpha, takes_cd, policies, registers, observer);
    if O::ON {
        if muxes {
            StageReport::new(stage.index, false).mux(spare0, mux_select, policies, takes_cd, observer);
        }
        for (portion, report) in [(&stage.rgb, false), (&stage.alpha, true)] {
            let report = StageReport::new(stage.index, report);
            for product in 0..2 {
                report.inputs(portion, product, registers, policies, observer);
            }
        }
        StageReport::new(stage.index, false).values(&stage.rgb, 0, &rgb, takes_cd, policies, observer);
        StageReport::new(stage.index, true).values(&stage.alpha, 3, &alpha, takes_cd, policies, observer);
    }
    write(&stage.rgb, 0, &rgb, stage.index, registers, observer);
    write(&stage.alpha, 3, &alpha, stage.index, registers, observer);
}

/// One portion. Channels that nobody reads are computed along where that is cheaper than asking.
#[inline(always)]
fn evaluate<L: Lane, O: Observer, const N: usize>(
    planned: &PlannedPortion,
    takes_cd: bool,
    policies: &Policies,
    registers: &Registers<L>,
    observer: &mut O,
) -> Values<L, N> {
    let portion = &planned.portion;
    let (a, b, ab) = product::<L, O, N>(planned, 0, policies, registers, observer);
    let (c, d, cd) = product::<L, O, N>(planned, 1, policies, registers, observer);
    let takes_cd = portion.mux.then_some(takes_cd);
    let [rule_ab, rule_cd] =
        [portion.ab_dot_product, portion.cd_dot_product].map(|dot| if dot { Rule::Cmb8 } else { Rule::Cmb6 });
    let third = if planned.live[2] == 0 {
        [L::ZERO.widened(); N]
    } else {
        std::array::from_fn(|n| {
            let live = planned.live[2] >> (first_channel::<N>() + n) & 1 != 0;
            third::<L, O>([ab[n], cd[n]], live.then_some([rule_ab, rule_cd]), takes_cd, policies, observer)
        })
    };
    let rule_third = match takes_cd {
        None => Rule::Cmb7,
        Some(true) => rule_cd,
        Some(false) => rule_ab,
    };
    let same = [portion.ab_dot_product, portion.cd_dot_product];
    let outputs = [
        finish_all::<L, O, N>(planned, 0, ab, same[0], rule_ab, policies, observer),
        finish_all::<L, O, N>(planned, 1, cd, same[1], rule_cd, policies, observer),
        finish_all::<L, O, N>(planned, 2, third, same[0] && same[1], rule_third, policies, observer),
    ];
    Values { factors: [a, b, c, d], products: [ab, cd], third, outputs }
}

/// The factors of AB (0) or CD (1), and their product or dot product at full width; zeros where nobody asks.
#[inline(always)]
#[allow(clippy::type_complexity, reason = "two factors and their product, unpacked at once")]
fn product<L: Lane, O: Observer, const N: usize>(
    planned: &PlannedPortion,
    which: usize,
    policies: &Policies,
    registers: &Registers<L>,
    observer: &mut O,
) -> ([L::Mapped; N], [L::Mapped; N], [L::Full; N]) {
    if planned.product_channels(which) == 0 {
        let zero = [L::ZERO.factor(); N];
        return (zero, zero, [L::ZERO.widened(); N]);
    }
    let portion = &planned.portion;
    let dot_product = if which == 0 { portion.ab_dot_product } else { portion.cd_dot_product };
    let needed = if dot_product { 7 } else { planned.product_channels(which) };
    let mut factor = |input: &CombinerInput| {
        let mut factors = mapping::map(channels::<L, N>(input, registers), input.mapping, policies);
        if O::MEASURES {
            for channel in (0..N).filter(|c| needed >> (first_channel::<N>() + c) & 1 != 0) {
                factors[channel] = observer.settle_factor::<L>(mapping::rule(input.mapping), factors[channel]);
            }
        }
        factors
    };
    let (a, b) = (factor(&portion.inputs[2 * which]), factor(&portion.inputs[2 * which + 1]));
    observer.count(Work::Products, N as u64);
    let raw = if dot_product {
        [dot::<L, O>(&a, &b, policies, observer); N]
    } else {
        std::array::from_fn(|c| a[c].product(b[c]))
    };
    (a, b, raw)
}

/// The register channel of a portion's first one: R of an RGB portion, A of an alpha portion.
const fn first_channel<const N: usize>() -> usize {
    if N == 1 { 3 } else { 0 }
}

/// Output `n` of every channel; `same` says that the channels are equal, as a dot product's are.
#[inline(always)]
fn finish_all<L: Lane, O: Observer, const N: usize>(
    planned: &PlannedPortion,
    n: usize,
    raw: [L::Full; N],
    same: bool,
    rule: Rule,
    policies: &Policies,
    observer: &mut O,
) -> [L; N] {
    let live = planned.live[n] | if n < 2 && planned.blue_to_alpha[n] { BLUE } else { 0 };
    if live == 0 {
        [L::ZERO; N]
    } else if same {
        [finish::<L, O>(raw[0], &planned.portion, Some(rule), policies, observer); N]
    } else {
        std::array::from_fn(|c| {
            // What is computed along for nobody has no error.
            let rule = (live >> (first_channel::<N>() + c) & 1 != 0).then_some(rule);
            finish::<L, O>(raw[c], &planned.portion, rule, policies, observer)
        })
    }
}

/// The channels of its register that an input brings to a portion.
#[inline(always)]
fn channels<L: Lane, const N: usize>(input: &CombinerInput, registers: &Registers<L>) -> [L; N] {
    let value = &registers.values[input.register as usize];
    match input.component {
        Component::Rgb => std::array::from_fn(|c| value[c]),
        Component::Blue => [value[2]; N],
        Component::Alpha => [value[3]; N],
    }
}

/// CMB-8 with its alternative. Only RGB portions have dot products, so there are three channels.
#[inline(always)]
pub(crate) fn dot<L: Lane, O: Observer>(
    a: &[L::Mapped],
    b: &[L::Mapped],
    policies: &Policies,
    observer: &mut O,
) -> L::Full {
    let ([a0, a1, a2], [b0, b1, b2]) = (a, b) else { return L::ZERO.widened() };
    let (a, b) = ([*a0, *a1, *a2], [*b0, *b1, *b2]);
    match policies.dot_rounding {
        DotRounding::Once => dot_product(a, b),
        DotRounding::Each => {
            observer.count(Work::Roundings, 3);
            let mut term = |n: usize| observer.settle(Rule::Cmb8, a[n].product(b[n]).rounded());
            (term(0) + term(1) + term(2)).widened()
        }
    }
}

/// CMB-7, or CMB-10 where `takes_cd` is given: the third output before bias and scale.
#[inline(always)]
pub(crate) fn third<L: Lane, O: Observer>(
    [ab, cd]: [L::Full; 2],
    rules: Option<[Rule; 2]>,
    takes_cd: Option<bool>,
    policies: &Policies,
    observer: &mut O,
) -> L::Full {
    match (takes_cd, policies.sum_rounding) {
        (Some(true), _) => cd,
        (Some(false), _) => ab,
        (None, SumRounding::Once) => ab + cd,
        (None, SumRounding::Each) => {
            observer.count(Work::Roundings, 2);
            let (ab, cd) = (ab.rounded(), cd.rounded());
            let Some(rules) = rules else { return (ab + cd).widened() };
            (observer.settle(rules[0], ab) + observer.settle(rules[1], cd)).widened()
        }
    }
}

/// CMB-9 with its alternative.
#[inline(always)]
pub(crate) fn finish<L: Lane, O: Observer>(
    raw: L::Full,
    portion: &Portion,
    rule: Option<Rule>,
    policies: &Policies,
    observer: &mut O,
) -> L {
    observer.count(Work::Roundings, 1);
    let mut settle = |step, v| match (step, rule) {
        (_, None) => v,
        (OutputStep::Rounded, Some(rule)) => observer.settle(rule, v),
        (OutputStep::Scaled, _) => observer.settle(Rule::Cmb9, v),
        (OutputStep::Saturated, _) => observer.settle(Rule::Num3, v),
    };
    match policies.output_rounding {
        OutputRounding::BeforeScale => output(raw, portion.bias, portion.scale, policies.register_floor, settle),
        OutputRounding::AfterScale => {
            let v = settle(OutputStep::Scaled, rounded_after::<L>(raw, portion.bias, portion.scale));
            settle(OutputStep::Saturated, v.saturated(policies.register_floor))
        }
    }
}

/// Writes the live channels of a portion, `first` being the register channel of its first one; CMB-11 last.
#[inline(always)]
fn write<L: Lane, O: Observer, const N: usize>(
    planned: &PlannedPortion,
    first: usize,
    values: &Values<L, N>,
    stage: usize,
    registers: &mut Registers<L>,
    observer: &mut O,
) {
    let portion = &planned.portion;
    let report = || StageReport::new(stage, first == 3);
    let mut output = |n: usize, destination: Register| {
        let value = &values.outputs[n];
        if planned.live[n] != 0 {
            // Dead channels are written along; nobody reads them.
            for c in 0..N {
                registers.write(destination, first + c, value[c]);
                if O::ON && planned.live[n] >> (first + c) & 1 != 0 {
                    report().write(destination, first + c, value[c], n, "CMB-1", observer);
                }
            }
        }
        if n < 2 && planned.blue_to_alpha[n] {
            registers.write(destination, 3, value[N - 1]);
            if O::ON {
                report().write(destination, 3, value[N - 1], n, "CMB-11", observer);
            }
        }
    };
    output(0, portion.ab_output);
    output(1, portion.cd_output);
    output(2, portion.sum_output);
}

/// The channel of its register that an input reads.
#[inline(always)]
pub fn source_channel(input: &CombinerInput, channel: usize) -> usize {
    match input.component {
        Component::Rgb => channel,
        Component::Blue => 2,
        Component::Alpha => 3,
    }
}
