//! CMB-1, CMB-6 to CMB-11: one general combiner stage.
//!
//! [`dot_product`] and [`output`] are the rules that blocks of pixels share; [`run`] is a whole stage with every policy.

use super::mapping;
use super::registers::Registers;
use super::report::StageReport;
use crate::number::{Factor, Lane, Register as _, Sum};
use crate::state::{
    Bias, CombinerInput, Component, DotRounding, MuxNegative, MuxSelect, OutputRounding, Policies, Portion, Register,
    RegisterFloor, Scale, SumRounding,
};
use crate::trace::Observer;

/// CMB-8: the sum of three full-width products, not yet rounded.
#[inline(always)]
pub fn dot_product<F: Factor>(a: [F; 3], b: [F; 3]) -> F::Sum {
    a[0].product(b[0]) + a[1].product(b[1]) + a[2].product(b[2])
}

/// CMB-9: rounded, biased, scaled, saturated.
#[inline(always)]
pub fn output<S: Sum>(raw: S, bias: Bias, scale: Scale, floor: RegisterFloor) -> S::Register
where
    S::Register: crate::number::Register,
{
    scaled(biased(raw.rounded(), bias), scale).saturated(floor)
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
    let v = spare0_alpha.decision();
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
}

/// What a portion hands to its destinations: AB, CD, sum or mux, by channel.
struct Outputs<L> {
    values: [[L; 4]; 3],
    blue: [L; 2],
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
    for (n, register) in [Register::ConstantColor0, Register::ConstantColor1].into_iter().enumerate() {
        registers.load(register, stage.constants[n].map(L::byte));
    }
    let cd = mux_takes_cd(registers.read(Register::Spare0, 3), mux_select, policies);
    let context = Context { policies, takes_cd: cd, index: stage.index };
    if O::ON && [&stage.rgb, &stage.alpha].into_iter().any(|p| p.portion.mux && p.live[2] != 0) {
        let spare0 = registers.read(Register::Spare0, 3);
        StageReport::new(stage.index, false).mux(spare0, mux_select, policies, cd, observer);
    }
    let rgb = (!stage.rgb.is_idle()).then(|| context.evaluate::<L, O>(&stage.rgb, false, registers, observer));
    let alpha = (!stage.alpha.is_idle()).then(|| context.evaluate::<L, O>(&stage.alpha, true, registers, observer));
    for (planned, outputs, channels) in [(&stage.rgb, rgb, 0..3), (&stage.alpha, alpha, 3..4)] {
        let Some(outputs) = outputs else { continue };
        let destinations = [planned.portion.ab_output, planned.portion.cd_output, planned.portion.sum_output];
        for (n, destination) in destinations.into_iter().enumerate() {
            for channel in channels.clone() {
                if planned.live[n] >> channel & 1 != 0 {
                    context.write(registers, destination, channel, outputs.values[n][channel], n, "CMB-1", observer);
                }
            }
            if n < 2 && planned.blue_to_alpha[n] {
                context.write(registers, destination, 3, outputs.blue[n], n, "CMB-11", observer);
            }
        }
    }
}

struct Context<'a> {
    policies: &'a Policies,
    takes_cd: bool,
    index: usize,
}

impl Context<'_> {
    fn report(&self, alpha: bool) -> StageReport {
        StageReport::new(self.index, alpha)
    }

    #[inline]
    fn evaluate<L: Lane, O: Observer>(
        &self,
        planned: &PlannedPortion,
        alpha: bool,
        registers: &Registers<L>,
        observer: &mut O,
    ) -> Outputs<L> {
        let portion = &planned.portion;
        let (first, last) = if alpha { (3, 4) } else { (0, 3) };
        let zero = L::ZERO.factor();
        let mut factors = [[zero; 4]; 4];
        let mut products = [[zero.product(zero); 4]; 2];
        for product in 0..2 {
            let dot = [portion.ab_dot_product, portion.cd_dot_product][product];
            let needed = planned.product_channels(product);
            let read = if dot && needed != 0 { 7 } else { needed };
            for n in [2 * product, 2 * product + 1] {
                for channel in (first..last).filter(|c| read >> c & 1 != 0) {
                    let input = &portion.inputs[n];
                    let x = registers.read(input.register, source_channel(input, channel));
                    factors[n][channel] = mapping::map(x, input.mapping, self.policies);
                    if O::ON {
                        self.report(alpha).input(input, n, channel, registers, factors[n][channel], observer);
                    }
                }
            }
            let (a, b) = (&factors[2 * product], &factors[2 * product + 1]);
            if dot {
                if needed != 0 {
                    let raw = self.dot::<L>([a[0], a[1], a[2]], [b[0], b[1], b[2]]);
                    products[product] = [raw; 4];
                }
            } else {
                for channel in (first..last).filter(|c| needed >> c & 1 != 0) {
                    products[product][channel] = a[channel].product(b[channel]);
                }
            }
            if O::ON {
                let rounding = dot.then_some(self.policies.dot_rounding);
                self.report(alpha).products::<L, O>(product, needed, rounding, &factors, &products[product], observer);
            }
        }
        let mut outputs = Outputs { values: [[L::ZERO; 4]; 3], blue: [L::ZERO; 2] };
        for channel in first..last {
            for n in 0..3 {
                if planned.live[n] >> channel & 1 != 0 {
                    let raw = match n {
                        2 => self.third::<L, O>(portion, channel, &products, alpha, observer),
                        n => products[n][channel],
                    };
                    outputs.values[n][channel] = self.finish(portion, raw, n, channel, alpha, observer);
                }
            }
        }
        for n in 0..2 {
            if planned.blue_to_alpha[n] {
                outputs.blue[n] = if planned.live[n] & BLUE != 0 {
                    outputs.values[n][2]
                } else {
                    self.finish(portion, products[n][2], n, 2, alpha, observer)
                };
            }
        }
        outputs
    }

    /// CMB-8 with its alternative.
    #[inline(always)]
    fn dot<L: Lane>(&self, a: [L::Mapped; 3], b: [L::Mapped; 3]) -> L::Full {
        match self.policies.dot_rounding {
            DotRounding::Once => dot_product(a, b),
            DotRounding::Each => {
                let term = |n: usize| a[n].product(b[n]).rounded();
                (term(0) + term(1) + term(2)).widened()
            }
        }
    }

    /// CMB-7 or CMB-10: the third output before bias and scale.
    #[inline(always)]
    fn third<L: Lane, O: Observer>(
        &self,
        portion: &Portion,
        channel: usize,
        products: &[[L::Full; 4]; 2],
        alpha: bool,
        observer: &mut O,
    ) -> L::Full {
        let (ab, cd) = (products[0][channel], products[1][channel]);
        let raw = if portion.mux {
            if self.takes_cd { cd } else { ab }
        } else {
            match self.policies.sum_rounding {
                SumRounding::Once => ab + cd,
                SumRounding::Each => (ab.rounded() + cd.rounded()).widened(),
            }
        };
        if O::ON {
            let selected = portion.mux.then_some(self.takes_cd);
            self.report(alpha).third::<L, O>(channel, [ab, cd], raw, selected, self.policies.sum_rounding, observer);
        }
        raw
    }

    /// CMB-9 with its alternative.
    #[inline(always)]
    fn finish<L: Lane, O: Observer>(
        &self,
        portion: &Portion,
        raw: L::Full,
        n: usize,
        channel: usize,
        alpha: bool,
        observer: &mut O,
    ) -> L {
        let floor = self.policies.register_floor;
        let value = match self.policies.output_rounding {
            OutputRounding::BeforeScale => output(raw, portion.bias, portion.scale, floor),
            OutputRounding::AfterScale => rounded_after::<L>(raw, portion.bias, portion.scale).saturated(floor),
        };
        if O::ON {
            self.report(alpha).output::<L, O>(portion, raw, value, (n, channel), self.policies, observer);
        }
        value
    }

    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "one register write and what the trace says of it")]
    fn write<L: Lane, O: Observer>(
        &self,
        registers: &mut Registers<L>,
        destination: Register,
        channel: usize,
        value: L,
        n: usize,
        rule: &'static str,
        observer: &mut O,
    ) {
        registers.write(destination, channel, value);
        if O::ON {
            self.report(channel == 3 && rule != "CMB-11").write(destination, channel, value, n, rule, observer);
        }
    }
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
