//! CMB-1, CMB-6 to CMB-11: the general combiner stages.
//!
//! [`evaluate`] and [`write()`] are the rules, written in the operations of an [`Algebra`]. [`run`] applies them to
//! numbers, with reports.

use super::direct::{AttributedSum, Direct};
use super::output::takes_cd;
use super::registers::Registers;
use super::report;
use crate::algebra::{Algebra, Site};
use crate::number::{Factor, Lane};
use crate::state::*;
use crate::trace::{Decision, Observer, Rule};

/// CMB-8: returns the sum of three full-width products, without rounding.
#[inline(always)]
pub fn dot_product<F: Factor>(a: [F; 3], b: [F; 3]) -> F::Sum {
    a[0].product(b[0]) + a[1].product(b[1]) + a[2].product(b[2])
}

/// CMB-8: returns the dot product of two vectors of factors at full width.
#[inline(always)]
pub fn dot<A: Algebra>([a0, a1, a2]: [A::Factor; 3], [b0, b1, b2]: [A::Factor; 3], a: &mut A) -> A::Sum {
    const RULE: Rule = Rule::Cmb8;
    let [x, y, z] = [a.product(RULE, a0, b0), a.product(RULE, a1, b1), a.product(RULE, a2, b2)];
    match a.policies().dot_rounding {
        DotRounding::Once => {
            let sum = a.add(RULE, x, y);
            a.add(RULE, sum, z)
        }
        DotRounding::Each => {
            let [x, y, z] = [a.rounded(x), a.rounded(y), a.rounded(z)];
            let sum = a.plus(x, y);
            let sum = a.plus(sum, z);
            a.widened(RULE, sum)
        }
    }
}

/// CMB-7: returns AB + CD at full width.
#[inline(always)]
pub fn sum<A: Algebra>(ab: A::Sum, cd: A::Sum, a: &mut A) -> A::Sum {
    match a.policies().sum_rounding {
        SumRounding::Once => a.add(Rule::Cmb7, ab, cd),
        SumRounding::Each => {
            let (ab, cd) = (a.rounded(ab), a.rounded(cd));
            let sum = a.plus(ab, cd);
            a.widened(Rule::Cmb7, sum)
        }
    }
}

/// Returns the third output at full width: the mux (CMB-10) or the sum (CMB-7).
#[inline(always)]
pub fn third<A: Algebra>(mux: bool, takes_cd: A::Choice, ab: A::Sum, cd: A::Sum, a: &mut A) -> A::Sum {
    if mux { a.select(takes_cd, cd, ab) } else { sum(ab, cd, a) }
}

/// CMB-9: rounds, biases, scales and saturates an output.
#[inline(always)]
pub fn output<A: Algebra>(portion: &Portion, raw: A::Sum, a: &mut A) -> A::Register {
    let value = match a.policies().output_rounding {
        OutputRounding::BeforeScale => {
            let rounded = a.rounded(raw);
            a.scaled(portion.bias, portion.scale, rounded)
        }
        OutputRounding::AfterScale => a.rounded_after(portion.bias, portion.scale, raw),
    };
    a.saturated(value)
}

/// All values that a portion computes, for its `N` channels: three in an RGB portion, one in an alpha portion. `F`, `S`
/// and `R` are the factors, sums and registers of an [`Algebra`].
#[derive(Clone, Copy, Debug)]
pub struct Values<F, S, R, const N: usize> {
    /// A, B, C, D after their mappings.
    pub factors: [[F; N]; 4],
    /// AB and CD at full width.
    pub products: [[S; N]; 2],
    /// The sum or mux at full width.
    pub third: [S; N],
    /// AB, CD and the sum or mux as registers.
    pub outputs: [[R; N]; 3],
}

/// All values that a stage computes.
#[derive(Clone, Copy, Debug)]
pub struct StageValues<F, S, R, C> {
    /// Whether muxes take CD.
    pub takes_cd: C,
    /// The RGB portion.
    pub rgb: Values<F, S, R, 3>,
    /// The alpha portion.
    pub alpha: Values<F, S, R, 1>,
}

/// The values of a portion in an algebra.
type PortionOf<A, const N: usize> = Values<<A as Algebra>::Factor, <A as Algebra>::Sum, <A as Algebra>::Register, N>;

/// The values of a stage in an algebra.
pub type StageOf<A> =
    StageValues<<A as Algebra>::Factor, <A as Algebra>::Sum, <A as Algebra>::Register, <A as Algebra>::Choice>;

/// The values of a stage on the numbers of a lane.
pub type StageOn<L> = StageValues<<L as Lane>::Mapped, AttributedSum<<L as Lane>::Full>, L, bool>;

/// Computes the values of a stage from the registers before it.
#[inline(always)]
pub fn evaluate<A: Algebra>(
    stage: &PlannedStage,
    mux_select: MuxSelect,
    registers: &Registers<A::Register>,
    a: &mut A,
) -> StageOf<A> {
    let takes_cd = a.choice(mux_select, registers.read(Register::Spare0, 3));
    StageValues {
        takes_cd,
        rgb: evaluate_portion(&stage.rgb.portion, takes_cd, registers, a),
        alpha: evaluate_portion(&stage.alpha.portion, takes_cd, registers, a),
    }
}

#[inline(always)]
fn evaluate_portion<A: Algebra, const N: usize>(
    portion: &Portion,
    takes_cd: A::Choice,
    registers: &Registers<A::Register>,
    a: &mut A,
) -> PortionOf<A, N> {
    let first = first_channel::<N>();
    let [input_a, input_b, input_c, input_d] = &portion.inputs;
    let factors = [
        a.factors(Site::factor(0, first), input_a.mapping, read(input_a, first, registers)),
        a.factors(Site::factor(1, first), input_b.mapping, read(input_b, first, registers)),
        a.factors(Site::factor(2, first), input_c.mapping, read(input_c, first, registers)),
        a.factors(Site::factor(3, first), input_d.mapping, read(input_d, first, registers)),
    ];
    // A dot product is one value for all channels, as is everything that only depends on dot products.
    let [ab_dot, cd_dot] = [portion.ab_dot_product, portion.cd_dot_product];
    let ab = product(Site::product(0, first), ab_dot, &factors[0], &factors[1], a);
    let cd = product(Site::product(1, first), cd_dot, &factors[2], &factors[3], a);
    let site = Site::third_output(first);
    let third = if ab_dot && cd_dot {
        [a.sum(site, |a| third(portion.mux, takes_cd, ab[0], cd[0], a)); N]
    } else {
        a.sums(site, |a, c| third(portion.mux, takes_cd, ab[c], cd[c], a))
    };
    let outputs = [
        finish(Site::output(0, first), ab_dot, portion, &ab, a),
        finish(Site::output(1, first), cd_dot, portion, &cd, a),
        finish(Site::output(2, first), ab_dot && cd_dot, portion, &third, a),
    ];
    let products = [ab, cd];
    Values { factors, products, third, outputs }
}

/// CMB-6, CMB-8: returns AB or CD at full width. `site` is the place of its first channel.
#[inline(always)]
pub fn product<A: Algebra, const N: usize>(
    site: Site,
    is_dot: bool,
    x: &[A::Factor; N],
    y: &[A::Factor; N],
    a: &mut A,
) -> [A::Sum; N] {
    match (&x[..], &y[..]) {
        // Only RGB portions have dot products.
        ([x0, x1, x2], [y0, y1, y2]) if is_dot => [a.sum(site, |a| dot([*x0, *x1, *x2], [*y0, *y1, *y2], a)); N],
        _ => a.sums(site, |a, c| a.product(Rule::Cmb6, x[c], y[c])),
    }
}

/// Computes an output in all channels. If `is_one` is set, they are equal and computed once.
#[inline(always)]
fn finish<A: Algebra, const N: usize>(
    site: Site,
    is_one: bool,
    portion: &Portion,
    raw: &[A::Sum; N],
    a: &mut A,
) -> [A::Register; N] {
    if is_one {
        [a.register(site, |a| output(portion, raw[0], a)); N]
    } else {
        a.registers(site, |a, c| output(portion, raw[c], a))
    }
}

/// Returns the channels of its register that an input reads for a portion.
#[inline(always)]
fn read<R: Copy, const N: usize>(input: &CombinerInput, first: usize, registers: &Registers<R>) -> [R; N] {
    let value = &registers.values[input.register as usize];
    match input.component {
        Component::Rgb => std::array::from_fn(|c| value[first + c]),
        Component::Blue => [value[2]; N],
        Component::Alpha => [value[3]; N],
    }
}

/// Writes the outputs of a stage: AB, CD, then the sum or mux. Blue to alpha (CMB-11) follows each.
#[inline(always)]
pub fn write<A: Algebra>(stage: &PlannedStage, values: &StageOf<A>, registers: &mut Registers<A::Register>, a: &mut A) {
    write_portion(&stage.rgb.portion, &values.rgb, registers, a);
    write_portion(&stage.alpha.portion, &values.alpha, registers, a);
}

#[inline(always)]
fn write_portion<A: Algebra, const N: usize>(
    portion: &Portion,
    values: &PortionOf<A, N>,
    registers: &mut Registers<A::Register>,
    a: &mut A,
) {
    let first = first_channel::<N>();
    let destinations = [
        (portion.ab_output, portion.ab_blue_to_alpha),
        (portion.cd_output, portion.cd_blue_to_alpha),
        (portion.sum_output, false),
    ];
    for (n, (destination, blue_to_alpha)) in destinations.into_iter().enumerate() {
        if destination == Register::Zero {
            continue;
        }
        let written: [A::Register; N] = a.registers(Site::write(n, first), |a, c| a.written(values.outputs[n][c]));
        for (c, value) in written.into_iter().enumerate() {
            registers.write(destination, first + c, value);
        }
        if blue_to_alpha {
            let value = a.register(Site::blue_to_alpha(n), |a| a.written(values.outputs[n][N - 1]));
            registers.write(destination, 3, value);
        }
    }
}

/// Runs a stage in an algebra: loads its constants, then [`evaluate`] and [`write()`].
pub(crate) fn stage<A: Algebra>(
    stage: &PlannedStage,
    mux_select: MuxSelect,
    registers: &mut Registers<A::Register>,
    a: &mut A,
) {
    load_constants(stage.constants, registers, a);
    let values = evaluate(stage, mux_select, registers, a);
    write(stage, &values, registers, a);
}

/// Loads the constant colours of a stage or of the final combiner.
#[inline(always)]
pub(crate) fn load_constants<A: Algebra>(constants: [[u8; 4]; 2], registers: &mut Registers<A::Register>, a: &mut A) {
    registers.load_constants(constants.map(|constant| constant.map(|byte| a.byte(byte))));
}

/// A portion with its liveness: which channels of which output are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedPortion {
    /// The state of the portion in the scene.
    pub portion: Portion,
    /// Channels of AB, CD and the sum or mux that are needed: bits 1, 2, 4 for R, G, B in an RGB portion, bit 8 for A
    /// in an alpha portion.
    pub live: [u8; 3],
    /// Whether the blue of AB and CD is needed in the alpha of their destinations.
    pub blue_to_alpha: [bool; 2],
    /// Set of the [`Site`]s of all values that are needed.
    pub sites: u64,
}

impl PlannedPortion {
    /// Returns a portion whose outputs are all needed in the given channels.
    pub fn whole(portion: Portion, channels: u8) -> PlannedPortion {
        let outputs = [portion.ab_output, portion.cd_output, portion.sum_output];
        // This includes more than is needed: everything that precedes an output.
        let mut sites = 0;
        for n in (0..3).filter(|n| outputs[*n] != Register::Zero) {
            sites |= ((1 << 28) - 1) | (15 << (28 + 4 * n)) | (15 << (40 + 4 * n));
        }
        sites = (sites | 3 << 52) & Site::of_channels(if channels & 7 == 0 { 8 } else { 7 });
        PlannedPortion {
            portion,
            live: outputs.map(|output| if output == Register::Zero { 0 } else { channels }),
            blue_to_alpha: [
                portion.ab_blue_to_alpha && portion.ab_output != Register::Zero,
                portion.cd_blue_to_alpha && portion.cd_output != Register::Zero,
            ],
            sites,
        }
    }

    /// Returns whether nothing of the portion is needed.
    pub(crate) fn is_idle(&self) -> bool {
        self.live == [0; 3] && self.blue_to_alpha == [false; 2]
    }

    /// Returns whether the portion has a mux that is needed.
    pub(crate) fn muxes(&self) -> bool {
        self.portion.mux && self.live[2] != 0
    }

    /// Returns the channels of the product AB (0) or CD (1) that some output needs.
    pub fn product_channels(&self, product: usize) -> u8 {
        self.live[product] | self.live[2] | if self.blue_to_alpha[product] { BLUE } else { 0 }
    }
}

/// Bit of blue in a set of channels.
pub const BLUE: u8 = 4;

/// A general stage with its liveness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedStage {
    /// Number of the stage in the program.
    pub index: usize,
    /// The portion that computes red, green and blue.
    pub rgb: PlannedPortion,
    /// The portion that computes alpha.
    pub alpha: PlannedPortion,
    /// Constant colours 0 and 1 of the stage, as R, G, B, A bytes.
    pub constants: [[u8; 4]; 2],
    /// Whether a needed input reads a constant colour.
    pub reads_constants: bool,
}

impl PlannedStage {
    /// Returns a stage whose outputs are all needed, and whose constants are in the registers.
    pub fn whole(index: usize, stage: &GeneralStage) -> PlannedStage {
        let (rgb, alpha) = (PlannedPortion::whole(stage.rgb, 7), PlannedPortion::whole(stage.alpha, 8));
        PlannedStage { index, rgb, alpha, constants: stage.constants, reads_constants: false }
    }
}

/// CMB-1: runs a stage, which reads all inputs before it writes any output.
#[inline]
pub fn run<L: Lane, O: Observer>(
    stage: &PlannedStage,
    mux_select: MuxSelect,
    policies: &Policies,
    registers: &mut Registers<L>,
    observer: &mut O,
) {
    // Values that nobody wants are not kept.
    values(stage, mux_select, policies, registers, observer);
}

/// Does what [`run`] does, and returns the needed values.
#[inline(always)]
pub fn values<L: Lane, O: Observer>(
    stage: &PlannedStage,
    mux_select: MuxSelect,
    policies: &Policies,
    registers: &mut Registers<L>,
    observer: &mut O,
) -> StageOn<L> {
    let spare0 = registers.read(Register::Spare0, 3);
    let muxes = [&stage.rgb, &stage.alpha].into_iter().any(PlannedPortion::muxes);
    if O::MEASURES && muxes {
        let decide = |alpha: i32| i64::from(takes_cd(alpha, mux_select, policies.mux_negative));
        observer.decided(Decision::Mux, decide(spare0.decision()), || decide(spare0.ideal_decision()));
    }
    // The two sets are disjoint, because the portions' channels are.
    let sites = stage.rgb.sites | stage.alpha.sites;
    let mut direct = Direct::new(policies, observer).only(sites);
    if stage.reads_constants {
        load_constants(stage.constants, registers, &mut direct);
    }
    let values = evaluate(stage, mux_select, registers, &mut direct);
    if O::ON && report::wanted(stage, observer) {
        report::stage(stage, mux_select, &values, registers, policies, observer);
    }
    write(stage, &values, registers, &mut Direct::new(policies, observer).only(sites));
    values
}

/// Returns the register channel of a portion's first channel: R in an RGB portion, A in an alpha portion.
const fn first_channel<const N: usize>() -> usize {
    if N == 1 { 3 } else { 0 }
}

/// Returns the channel of its register that an input reads for `channel`.
#[inline(always)]
pub(crate) fn source_channel(input: &CombinerInput, channel: usize) -> usize {
    component_channel(input.component, channel)
}

/// Returns the channel that a component of a register means for `channel`.
#[inline(always)]
pub fn component_channel(component: Component, channel: usize) -> usize {
    match component {
        Component::Rgb => channel,
        Component::Blue => 2,
        Component::Alpha => 3,
    }
}
