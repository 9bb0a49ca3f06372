//! The reports of a general stage to an observer. Nothing here computes a value that is used.

use super::direct::AttributedSum;
use super::general::{PlannedPortion, PlannedStage, StageOn, source_channel};
use super::mapping;
use super::output::{biased, rounded_after, scaled};
use super::registers::{self, Registers, channel_name};
use crate::number::{Lane, Sum};
use crate::state::*;
use crate::trace::{Observer, Step, plain, report};

const PRODUCT_NAMES: [&str; 3] = ["AB", "CD", "sum"];
const INPUT_NAMES: [&str; 4] = ["A", "B", "C", "D"];

/// All values that a portion computes, on numbers.
type Values<L, const N: usize> = super::general::Values<<L as Lane>::Mapped, AttributedSum<<L as Lane>::Full>, L, N>;

/// NUM-5: reports the constant colours of a stage or of the final combiner.
pub(crate) fn constants<O: Observer>(block: &str, constants: [[u8; 4]; 2], observer: &mut O) {
    for (n, constant) in constants.into_iter().enumerate() {
        for (channel, value) in constant.into_iter().enumerate() {
            let name = format!("constant{n}.{}", channel_name(channel));
            observer.step(Step::plain(block, "NUM-5", name, value).per(255).ideal(f64::from(value)));
        }
    }
}

/// Returns whether a step of a stage is wanted: one of its values, or a register that it writes.
pub(super) fn wanted<O: Observer>(stage: &PlannedStage, observer: &O) -> bool {
    let written = [&stage.rgb.portion, &stage.alpha.portion].map(|p| [p.ab_output, p.cd_output, p.sum_output]);
    let registers = written.as_flattened().iter().map(|register| registers::name(*register));
    let prefixes = [false, true].map(|alpha| StageReport::new(stage.index, alpha).prefix);
    registers.into_iter().chain(prefixes).any(|name| observer.wants(&[name])) || observer.wants(&[MUXES[stage.index]])
}

/// Reports a stage in the order of a trace: what it reads, computes and writes.
pub(super) fn stage<L: Lane, O: Observer>(
    stage: &PlannedStage,
    mux_select: MuxSelect,
    values: &StageOn<L>,
    registers: &Registers<L>,
    policies: &Policies,
    observer: &mut O,
) {
    let (rgb, alpha) = (StageReport::new(stage.index, false), StageReport::new(stage.index, true));
    if [&stage.rgb, &stage.alpha].into_iter().any(PlannedPortion::muxes) {
        let spare0 = registers.read(Register::Spare0, 3);
        rgb.mux(spare0, mux_select, policies, values.takes_cd, observer);
    }
    for (portion, report) in [(&stage.rgb, &rgb), (&stage.alpha, &alpha)] {
        if !observer.wants(&[report.prefix]) {
            continue;
        }
        for product in 0..2 {
            report.inputs(portion, product, registers, policies, observer);
        }
    }
    if rgb.wanted(&PRODUCT_NAMES, observer) {
        rgb.values(&stage.rgb, 0, &values.rgb, values.takes_cd, policies, observer);
    }
    if alpha.wanted(&PRODUCT_NAMES, observer) {
        alpha.values(&stage.alpha, 3, &values.alpha, values.takes_cd, policies, observer);
    }
    rgb.writes(&stage.rgb, 0, &values.rgb, observer);
    alpha.writes(&stage.alpha, 3, &values.alpha, observer);
}

/// The reports of one portion of a stage, with names for its steps.
struct StageReport {
    block: &'static str,
    prefix: &'static str,
    stage: usize,
}

/// Writes a table of texts with the number of each general stage.
macro_rules! of_stages {
    ($before:literal, $after:literal) => {
        of_stages!($before, $after: "0" "1" "2" "3" "4" "5" "6" "7")
    };
    ($before:literal, $after:literal: $($n:literal)*) => {
        [$(concat!($before, $n, $after)),*]
    };
}

// Planes have a name for every value of every pixel: formatting these would take a fifth of their time.
/// Largest number of general stages of a profile.
const MAX_STAGES: usize = 8;
const RGB_BLOCKS: [&str; MAX_STAGES] = of_stages!("general stage ", " rgb");
const ALPHA_BLOCKS: [&str; MAX_STAGES] = of_stages!("general stage ", " alpha");
const MUX_BLOCKS: [&str; MAX_STAGES] = of_stages!("general stage ", " mux");
const RGB_PREFIXES: [&str; MAX_STAGES] = of_stages!("stage", ".rgb");
const ALPHA_PREFIXES: [&str; MAX_STAGES] = of_stages!("stage", ".alpha");
const MUXES: [&str; MAX_STAGES] = of_stages!("stage", ".mux");

impl StageReport {
    fn new(stage: usize, alpha: bool) -> Self {
        let (blocks, prefixes) = if alpha { (&ALPHA_BLOCKS, &ALPHA_PREFIXES) } else { (&RGB_BLOCKS, &RGB_PREFIXES) };
        StageReport { block: blocks[stage], prefix: prefixes[stage], stage }
    }

    /// Returns whether a value of the portion is wanted whose name begins with one of these.
    fn wanted<O: Observer>(&self, names: &[&str], observer: &O) -> bool {
        observer.wants(&[self.prefix]) && names.iter().any(|name| observer.wants(&[self.prefix, ".", name, "."]))
    }

    fn mux<L: Lane, O: Observer>(
        &self,
        spare0_alpha: L,
        select: MuxSelect,
        policies: &Policies,
        takes_cd: bool,
        observer: &mut O,
    ) {
        let operation = match select {
            MuxSelect::Msb if policies.mux_negative == MuxNegative::Bit7 => "mux_bit7",
            MuxSelect::Msb => "mux_msb",
            MuxSelect::Lsb => "mux_lsb",
        };
        observer.step(
            Step::plain(MUX_BLOCKS[self.stage], "CMB-10", MUXES[self.stage], takes_cd)
                .by(operation, vec![report::register("spare0.a", spare0_alpha)])
                .note(if takes_cd { "set: takes CD" } else { "clear: takes AB" }.to_string()),
        );
    }

    /// Reports the inputs of AB (0) or CD (1) that are read.
    fn inputs<L: Lane, O: Observer>(
        &self,
        planned: &PlannedPortion,
        product: usize,
        registers: &Registers<L>,
        policies: &Policies,
        observer: &mut O,
    ) {
        for n in [2 * product, 2 * product + 1] {
            if !self.wanted(&[INPUT_NAMES[n]], observer) {
                continue;
            }
            let input = &planned.portion.inputs[n];
            let read = self.read_channels(planned, product);
            for channel in (0..4).filter(|c| read >> c & 1 != 0) {
                let source = source_channel(input, channel);
                let x = registers.read(input.register, source);
                let [factor] = mapping::map([x], input.mapping, policies);
                let name = [self.prefix, ".", INPUT_NAMES[n], ".", channel_name(channel)].concat();
                let operand = [registers::name(input.register), ".", channel_name(source)].concat();
                observer.step(
                    report::factor_step::<L>(self.block, mapping::rule(input.mapping).name(), name, factor)
                        .by(mapping::operation(input.mapping), vec![report::register(operand, x)]),
                );
            }
        }
    }

    /// Reports products, the third output, and how each output becomes a register.
    fn values<L: Lane, O: Observer, const N: usize>(
        &self,
        planned: &PlannedPortion,
        first: usize,
        values: &Values<L, N>,
        takes_cd: bool,
        policies: &Policies,
        observer: &mut O,
    ) {
        let portion = &planned.portion;
        for product in 0..2 {
            let dot = [portion.ab_dot_product, portion.cd_dot_product][product];
            let rounding = dot.then_some(policies.dot_rounding);
            let needed = planned.product_channels(product);
            self.products::<L, O, N>(product, (needed, first), rounding, values, observer);
        }
        for n in 0..3 {
            for c in 0..N {
                let channel = first + c;
                let blue = n < 2 && planned.blue_to_alpha[n] && channel == 2;
                let live = planned.live[n] >> channel & 1 != 0 || blue;
                if !live || !observer.wants(&self.product_parts(n, channel)) {
                    continue;
                }
                let raw = if n == 2 { values.third[c].sum } else { values.products[n][c].sum };
                if n == 2 {
                    let selected = portion.mux.then_some(takes_cd);
                    let products = [values.products[0][c].sum, values.products[1][c].sum];
                    self.third::<L, O>(channel, products, raw, selected, policies.sum_rounding, observer);
                }
                self.output::<L, O>(portion, raw, values.outputs[n][c], (n, channel), policies, observer);
            }
        }
    }

    /// Returns the channels of the inputs of a product that are read.
    fn read_channels(&self, planned: &PlannedPortion, product: usize) -> u8 {
        let dot = [planned.portion.ab_dot_product, planned.portion.cd_dot_product][product];
        match planned.product_channels(product) {
            0 => 0,
            _ if dot => 7,
            needed => needed,
        }
    }

    /// Reports the needed channels of a product. `rounding` is present for a dot product.
    fn products<L: Lane, O: Observer, const N: usize>(
        &self,
        product: usize,
        (needed, first): (u8, usize),
        rounding: Option<DotRounding>,
        values: &Values<L, N>,
        observer: &mut O,
    ) {
        let operand = |n: usize, c: usize| {
            let name = [self.prefix, ".", INPUT_NAMES[n], ".", channel_name(first + c)].concat();
            report::factor::<L>(name, values.factors[n][c])
        };
        let (rule, operation) = match rounding {
            Some(DotRounding::Once) => ("CMB-8", "dot_product"),
            Some(DotRounding::Each) => ("CMB-8", "dot_product_rounded"),
            None => ("CMB-6", "product"),
        };
        for c in (0..N).filter(|c| needed >> (first + c) & 1 != 0) {
            if !observer.wants(&self.product_parts(product, first + c)) {
                continue;
            }
            let name = self.product_name(product, first + c);
            let pairs = if rounding.is_some() { 0..N } else { c..c + 1 };
            let inputs = pairs.flat_map(|c| [operand(2 * product, c), operand(2 * product + 1, c)]).collect();
            let raw = values.products[product][c].sum;
            observer.step(report::sum_step::<L>(self.block, rule, name, raw).by(operation, inputs));
        }
    }

    /// Reports the third output. `selected` is present for a mux, and says whether CD was taken.
    fn third<L: Lane, O: Observer>(
        &self,
        channel: usize,
        products: [L::Full; 2],
        raw: L::Full,
        selected: Option<bool>,
        rounding: SumRounding,
        observer: &mut O,
    ) {
        let mut inputs = vec![
            report::sum::<L>(self.product_name(0, channel), products[0]),
            report::sum::<L>(self.product_name(1, channel), products[1]),
        ];
        let (rule, operation) = match (selected, rounding) {
            (Some(takes_cd), _) => {
                inputs.push(plain(MUXES[self.stage], takes_cd));
                ("CMB-10", "select")
            }
            (None, SumRounding::Each) => ("CMB-7", "add_rounded"),
            (None, SumRounding::Once) => ("CMB-7", "add"),
        };
        let name = self.product_name(2, channel);
        observer.step(report::sum_step::<L>(self.block, rule, name, raw).by(operation, inputs));
    }

    /// Reports rounding, bias, scale and saturation of output `n` (AB, CD, sum) in `channel`.
    fn output<L: Lane, O: Observer>(
        &self,
        portion: &Portion,
        raw: L::Full,
        value: L,
        (n, channel): (usize, usize),
        policies: &Policies,
        observer: &mut O,
    ) {
        let base = self.product_name(n, channel);
        let mut last = ("", raw.rounded());
        let mut step = |suffix: &'static str, rule, operation, v: L, first: bool| {
            if observer.wants(&[&base, ".", suffix]) {
                let named = |suffix: &str| [&base, ".", suffix].concat();
                let operand =
                    if first { report::sum::<L>(&base, raw) } else { report::register(named(last.0), last.1) };
                let changed = v.observe().0 != last.1.observe().0;
                let note = (suffix == "output" && changed).then(|| "saturated".to_string());
                let step = report::register_step(self.block, rule, named(suffix), v);
                observer.step(step.by(operation, vec![operand]).note(note));
            }
            last = (suffix, v);
        };
        match policies.output_rounding {
            OutputRounding::BeforeScale => {
                let rounded = raw.rounded();
                step("rounded", "NUM-2", "round_255", rounded, true);
                let v = biased(rounded, portion.bias);
                if portion.bias != Bias::None {
                    step("biased", "CMB-9", "bias", v, false);
                }
                if portion.scale != Scale::One {
                    step("scaled", "CMB-9", scale_operation(portion.scale), scaled(v, portion.scale), false);
                }
            }
            OutputRounding::AfterScale => {
                let operation = after_operation(portion.bias, portion.scale);
                step("scaled", "CMB-9", operation, rounded_after::<L>(raw, portion.bias, portion.scale), true);
            }
        }
        let saturate = match policies.register_floor {
            RegisterFloor::Full => "saturate_256",
            RegisterFloor::Symmetric => "saturate_255",
        };
        step("output", "NUM-3", saturate, value, false);
    }

    /// Reports what the outputs write.
    fn writes<L: Lane, O: Observer, const N: usize>(
        &self,
        planned: &PlannedPortion,
        first: usize,
        values: &Values<L, N>,
        observer: &mut O,
    ) {
        let portion = &planned.portion;
        let destinations = [portion.ab_output, portion.cd_output, portion.sum_output];
        let wanted = |register: &Register| observer.wants(&[registers::name(*register)]);
        let wanted = destinations.each_ref().map(wanted);
        for (n, destination) in destinations.into_iter().enumerate().filter(|(n, _)| wanted[*n]) {
            for c in (0..N).filter(|c| planned.live[n] >> (first + c) & 1 != 0) {
                self.write(destination, first + c, values.outputs[n][c], n, "CMB-1", observer);
            }
            if n < 2 && planned.blue_to_alpha[n] {
                self.write(destination, 3, values.outputs[n][N - 1], n, "CMB-11", observer);
            }
        }
    }

    fn write<L: Lane, O: Observer>(
        &self,
        destination: Register,
        channel: usize,
        value: L,
        n: usize,
        rule: &'static str,
        observer: &mut O,
    ) {
        let source_channel = if rule == "CMB-11" { 2 } else { channel };
        let source = [&self.product_name(n, source_channel), ".output"].concat();
        let name = [registers::name(destination), ".", channel_name(channel)].concat();
        observer.step(
            report::register_step(self.block, rule, name, value).by("write", vec![report::register(source, value)]),
        );
    }

    fn product_parts(&self, n: usize, channel: usize) -> [&'static str; 5] {
        [self.prefix, ".", PRODUCT_NAMES[n], ".", channel_name(channel)]
    }

    fn product_name(&self, n: usize, channel: usize) -> String {
        self.product_parts(n, channel).concat()
    }
}

fn scale_operation(scale: Scale) -> &'static str {
    match scale {
        Scale::One => "scale_1",
        Scale::Two => "scale_2",
        Scale::Four => "scale_4",
        Scale::Half => "scale_half",
    }
}

fn after_operation(bias: Bias, scale: Scale) -> &'static str {
    match (bias, scale) {
        (Bias::None, Scale::One) => "scale_1_round_255",
        (Bias::None, Scale::Two) => "scale_2_round_255",
        (Bias::None, Scale::Four) => "scale_4_round_255",
        (Bias::None, Scale::Half) => "scale_half_round_255",
        (Bias::NegativeHalf, Scale::One) => "bias_scale_1_round_255",
        (Bias::NegativeHalf, Scale::Two) => "bias_scale_2_round_255",
        (Bias::NegativeHalf, Scale::Four | Scale::Half) => "illegal",
    }
}
