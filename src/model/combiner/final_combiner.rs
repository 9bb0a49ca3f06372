//! FIN-1 to FIN-5: the final combiner.

use super::direct::Direct;
use super::general::{component_channel, load_constants};
use super::registers::{self, Registers, channel_name};
use crate::algebra::{Algebra, Site};
use crate::number::Lane;
use crate::state::{FinalCombiner, FinalInput, FinalRegister, LerpRounding, Policies, Profile, Register};
use crate::trace::{Observer, Operand, Rule, Silent, Step, report};

/// The final combiner, with what the plan knows about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedFinal {
    /// The state of the final combiner in the scene.
    pub state: FinalCombiner,
    /// Channels that the raster operations need: R, G, B (bits 1, 2, 4) and alpha (8).
    pub live: u8,
    /// Channels of E times F that live inputs read, as bits.
    pub product: u8,
    /// Channels of SPARE0 + SECONDARY that live inputs read, as bits.
    pub sum: u8,
    /// Whether a live input reads a constant colour.
    pub reads_constants: bool,
    /// Whether A or C is not always 0, so that the linear interpolation contributes.
    pub lerps: bool,
}

impl PlannedFinal {
    /// Returns a final combiner whose channels are all needed, and whose constants are in the registers.
    pub fn whole(state: FinalCombiner) -> PlannedFinal {
        let reads = |register| state.inputs.iter().chain([&state.g]).any(|input| input.register == register);
        let product = reads(FinalRegister::ETimesF) || state.inputs[4..].iter().any(|input| !input.is_zero());
        let channels = |needed| if needed { 7 } else { 0 };
        PlannedFinal {
            state,
            live: 15,
            product: channels(product),
            sum: channels(reads(FinalRegister::Spare0PlusSecondary)),
            reads_constants: false,
            lerps: true,
        }
    }

    /// Returns the sites of the values that are needed. With `report`, values that make no difference are included.
    #[inline(always)]
    fn sites(&self, report: bool) -> u64 {
        let [sum, product, live] = [self.sum, self.product, self.live].map(u64::from);
        let lerp = if self.lerps || report { live & 7 } else { 0 };
        sum | product << 4 | live << 8 | lerp << 12
    }
}

/// 2.0, the limit that the sum of SPARE0 + SECONDARY above 1.0 and D can exceed (FIN-5).
const MAX_SUM: i32 = 510;

const BLOCK: &str = "final combiner";

/// FIN-1: returns max(0, x), or max(0, 255 - max(0, x)) if `invert` is set.
#[inline(always)]
pub fn input<A: Algebra>(x: A::Register, invert: bool, a: &mut A) -> A::Register {
    let x = a.max0(x);
    if !invert {
        return x;
    }
    let inverted = a.complement(x);
    a.max0(inverted)
}

/// FIN-2: returns A B + (1 - A) C, where A is limited to 1.0.
#[inline(always)]
pub(crate) fn lerp<A: Algebra>([x, b, c]: [A::Register; 3], a: &mut A) -> A::Register {
    let one = a.byte(255);
    let x = a.least(x, one);
    let rest = a.complement(x);
    let [x, rest, b, c] = [x, rest, b, c].map(|v| a.plain(v));
    let (ab, ac) = (a.product(Rule::Fin2, x, b), a.product(Rule::Fin2, rest, c));
    match a.policies().lerp_rounding {
        LerpRounding::Once => {
            let sum = a.add(Rule::Fin2, ab, ac);
            a.rounded(sum)
        }
        LerpRounding::Twice => {
            let (ab, ac) = (a.rounded(ab), a.rounded(ac));
            a.plus(ab, ac)
        }
    }
}

/// FIN-3: returns SPARE0 + SECONDARY.
#[inline(always)]
pub fn color_sum<A: Algebra>(
    spare0: A::Register,
    secondary: A::Register,
    state: &FinalCombiner,
    a: &mut A,
) -> A::Register {
    let (spare0, secondary) = (input(spare0, state.invert_spare0, a), input(secondary, state.invert_secondary, a));
    let sum = a.plus(spare0, secondary);
    if !state.color_sum_clamp {
        return sum;
    }
    let one = a.byte(255);
    a.least(sum, one)
}

/// FIN-4: returns E F.
#[inline(always)]
pub fn product<A: Algebra>(e: A::Register, f: A::Register, a: &mut A) -> A::Register {
    let (e, f) = (a.plain(e), a.plain(f));
    let product = a.product(Rule::Fin4, e, f);
    a.rounded(product)
}

/// All values that the final combiner computes.
#[derive(Clone, Copy, Debug)]
pub struct FinalValues<R> {
    /// The registers SPARE0 + SECONDARY and E times F, whose alpha is 0 (FIN-1).
    pub specials: Specials<R>,
    /// R, G and B of inputs A to F.
    pub inputs: [[R; 3]; 6],
    /// A B + (1 - A) C + D before clamping.
    pub raw: [R; 3],
    /// The fragment: R, G, B, A bytes.
    pub fragment: [R; 4],
}

/// The two registers that exist only in the final combiner.
#[derive(Clone, Copy, Debug)]
pub struct Specials<R> {
    /// SPARE0 + SECONDARY.
    pub sum: [R; 4],
    /// E times F.
    pub product: [R; 4],
}

/// FIN-1 to FIN-4 in an algebra. The constant colours must be loaded.
#[inline(always)]
pub fn evaluate<A: Algebra>(
    state: &FinalCombiner,
    registers: &Registers<A::Register>,
    a: &mut A,
) -> FinalValues<A::Register> {
    let zero = a.byte(0);
    let mut specials = Specials { sum: [zero; 4], product: [zero; 4] };
    let mut inputs = [[zero; 3]; 6];
    let sum: [A::Register; 3] = a.registers(Site::color_sum(0), |a, c| {
        color_sum(registers.read(Register::Spare0, c), registers.read(Register::SecondaryColor, c), state, a)
    });
    specials.sum[..3].copy_from_slice(&sum);
    for n in [4, 5] {
        let from = &state.inputs[n];
        inputs[n] = a.registers(Site::final_product(0), |a, c| read(from, c, registers, &specials, a));
    }
    let product: [A::Register; 3] = a.registers(Site::final_product(0), |a, c| product(inputs[4][c], inputs[5][c], a));
    specials.product[..3].copy_from_slice(&product);
    for n in 0..4 {
        let (from, site) = (&state.inputs[n], if n == 3 { Site::fragment(0) } else { Site::lerp(0) });
        inputs[n] = a.registers(site, |a, c| read(from, c, registers, &specials, a));
    }
    let lerps: [A::Register; 3] =
        a.registers(Site::lerp(0), |a, c| lerp([inputs[0][c], inputs[1][c], inputs[2][c]], a));
    let raw = [0, 1, 2].map(|c: usize| a.plus(lerps[c], inputs[3][c]));
    let rgb: [A::Register; 3] = a.registers(Site::fragment(0), |a, c| a.clamped(raw[c]));
    let mut fragment = [rgb[0], rgb[1], rgb[2], zero];
    fragment[3] = a.register(Site::fragment(3), |a| read(&state.g, 3, registers, &specials, a));
    FinalValues { specials, inputs, raw, fragment }
}

/// Returns the value that an input reads, before FIN-1.
#[inline(always)]
fn source<R: Copy>(from: &FinalInput, channel: usize, registers: &Registers<R>, specials: &Specials<R>) -> R {
    let source = component_channel(from.component, channel);
    match from.register {
        FinalRegister::Spare0PlusSecondary => specials.sum[source],
        FinalRegister::ETimesF => specials.product[source],
        register => registers.read(general(register), source),
    }
}

#[inline(always)]
fn read<A: Algebra>(
    from: &FinalInput,
    channel: usize,
    registers: &Registers<A::Register>,
    specials: &Specials<A::Register>,
    a: &mut A,
) -> A::Register {
    input(source(from, channel, registers, specials), from.invert, a)
}

/// Runs the final combiner. Returns the fragment.
#[inline]
pub fn run<L: Lane, O: Observer>(
    planned: &PlannedFinal,
    profile: Profile,
    policies: &Policies,
    registers: &mut Registers<L>,
    observer: &mut O,
) -> [L; 4] {
    // Other values are not kept.
    values(planned, profile, policies, registers, observer).fragment
}

/// Does what [`run`] does, and returns all values, of which those that nothing needs are zero.
#[inline(always)]
pub fn values<L: Lane, O: Observer>(
    planned: &PlannedFinal,
    profile: Profile,
    policies: &Policies,
    registers: &mut Registers<L>,
    observer: &mut O,
) -> FinalValues<L> {
    let mut direct = Direct::new(policies, observer).only(planned.sites(O::ON));
    if planned.reads_constants {
        load_constants(planned.state.constants, registers, &mut direct);
    }
    let values = evaluate(&planned.state, registers, &mut direct);
    if O::ON && observer.wants_any(&["final.", "fragment."]) {
        report_all(planned, &values, profile, policies, registers, observer);
    }
    values
}

/// Reports all values, in the order of a trace.
fn report_all<L: Lane, O: Observer>(
    planned: &PlannedFinal,
    values: &FinalValues<L>,
    profile: Profile,
    policies: &Policies,
    registers: &Registers<L>,
    observer: &mut O,
) {
    let state = &planned.state;
    let report_input = |n: usize, channel: usize, value: L, observer: &mut O| {
        let from = if n == 6 { &state.g } else { &state.inputs[n] };
        let x = source(from, channel, registers, &values.specials);
        let source = component_channel(from.component, channel);
        let operand = match from.register {
            FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF if source == 3 => "zero.a".to_string(),
            FinalRegister::Spare0PlusSecondary => format!("final.sum.{}", channel_name(source)),
            FinalRegister::ETimesF => format!("final.EF.{}", channel_name(source)),
            register => format!("{}.{}", registers::name(general(register)), channel_name(source)),
        };
        let name = format!("final.{}.{}", ["A", "B", "C", "D", "E", "F", "G"][n], channel_name(channel));
        let operation = if from.invert { "final_invert" } else { "unsigned_identity" };
        let inputs = vec![report::register(operand, x)];
        observer.step(report::register_step(BLOCK, "FIN-1", name, value).by(operation, inputs));
    };
    for channel in (0..3).filter(|c| planned.sum >> c & 1 != 0) {
        let operands = [registers.read(Register::Spare0, channel), registers.read(Register::SecondaryColor, channel)];
        report_sum(state, channel, operands, values.specials.sum[channel], observer);
    }
    for channel in (0..3).filter(|c| planned.product >> c & 1 != 0) {
        let [e, f] = [4, 5].map(|n| values.inputs[n][channel]);
        report_input(4, channel, e, observer);
        report_input(5, channel, f, observer);
        let suffix = channel_name(channel);
        let inputs =
            vec![report::register(format!("final.E.{suffix}"), e), report::register(format!("final.F.{suffix}"), f)];
        let name = format!("final.EF.{suffix}");
        let product = values.specials.product[channel];
        observer.step(report::register_step(BLOCK, "FIN-4", name, product).by("product_round_255", inputs));
    }
    for channel in (0..3).filter(|c| planned.live >> c & 1 != 0) {
        let inputs = [0, 1, 2, 3].map(|n| values.inputs[n][channel]);
        for (n, value) in inputs.into_iter().enumerate() {
            report_input(n, channel, value, observer);
        }
        report_rgb(channel, inputs, values.raw[channel], values.fragment[channel], profile, policies, observer);
    }
    if planned.live & 8 != 0 {
        let alpha = values.fragment[3];
        report_input(6, 3, alpha, observer);
        let inputs = vec![report::register("final.G.a", alpha)];
        observer.step(report::register_step(BLOCK, "FIN-4", "fragment.a", alpha).by("write", inputs));
    }
}

/// Returns the general register that a final register stands for, or ZERO for the two registers that exist only in the
/// final combiner.
pub fn general(register: FinalRegister) -> Register {
    match register {
        FinalRegister::Zero | FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF => Register::Zero,
        FinalRegister::ConstantColor0 => Register::ConstantColor0,
        FinalRegister::ConstantColor1 => Register::ConstantColor1,
        FinalRegister::Fog => Register::Fog,
        FinalRegister::PrimaryColor => Register::PrimaryColor,
        FinalRegister::SecondaryColor => Register::SecondaryColor,
        FinalRegister::Texture0 => Register::Texture0,
        FinalRegister::Texture1 => Register::Texture1,
        FinalRegister::Texture2 => Register::Texture2,
        FinalRegister::Texture3 => Register::Texture3,
        FinalRegister::Spare0 => Register::Spare0,
        FinalRegister::Spare1 => Register::Spare1,
    }
}

fn report_sum<L: Lane, O: Observer>(state: &FinalCombiner, channel: usize, operands: [L; 2], sum: L, observer: &mut O) {
    let suffix = channel_name(channel);
    let mut terms = Vec::new();
    let sources = [("spare0", state.invert_spare0), ("secondary", state.invert_secondary)];
    for ((register, invert), x) in sources.into_iter().zip(operands) {
        let value = input(x, invert, &mut Direct::plain(&mut Silent));
        let name = format!("final.sum.{register}.{suffix}");
        let operation = if invert { "final_invert" } else { "unsigned_identity" };
        let operand = report::register(format!("{register}.{suffix}"), x);
        terms.push(observer.tell(report::register_step(BLOCK, "FIN-3", name, value).by(operation, vec![operand])));
    }
    let operation = if state.color_sum_clamp { "add_limit_255" } else { "add" };
    observer.step(report::register_step(BLOCK, "FIN-3", format!("final.sum.{suffix}"), sum).by(operation, terms));
}

fn report_rgb<L: Lane, O: Observer>(
    channel: usize,
    inputs: [L; 4],
    raw: L,
    out: L,
    profile: Profile,
    policies: &Policies,
    observer: &mut O,
) {
    let suffix = channel_name(channel);
    let operands: Vec<Operand> = ["A", "B", "C", "D"]
        .into_iter()
        .zip(inputs)
        .map(|(name, x)| report::register(format!("final.{name}.{suffix}"), x))
        .collect();
    let operation = match policies.lerp_rounding {
        LerpRounding::Once => "lerp_add",
        LerpRounding::Twice => "lerp_add_rounded_twice",
    };
    let wrong = profile == Profile::Nv10 && raw.observe().0 > i64::from(MAX_SUM);
    let note =
        wrong.then(|| "above 2.0: the real part gives a wrong value that nobody has recorded (FIN-5)".to_string());
    let name = format!("final.rgb.{suffix}");
    let value = raw.observe().0;
    observer.step(report::register_step(BLOCK, "FIN-2", name.clone(), raw).by(operation, operands).note(note));
    let step: Step = report::register_step(BLOCK, "FIN-2", format!("fragment.{suffix}"), out);
    let clamped = (value != out.observe().0).then(|| "clamped".to_string());
    observer.step(step.by("clamp_0_255", vec![report::register(name, raw)]).note(clamped));
}
