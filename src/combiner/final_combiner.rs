//! FIN-1 to FIN-5: the final combiner.

use super::registers::{self, Registers, channel_name};
use crate::number::{Factor, Lane, Sum};
use crate::state::{Component, FinalCombiner, FinalInput, FinalRegister, LerpRounding, Policies, Profile, Register};
use crate::trace::{Observer, Operand, Rule, Step, Work, report};

/// The final combiner with what the plan found out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedFinal {
    /// The state.
    pub state: FinalCombiner,
    /// Channels R, G, B (bits 1, 2, 4) and alpha (8) that the raster operations need.
    pub live: u8,
    /// Channels of E times F that live inputs read.
    pub product: u8,
    /// Channels of SPARE0 + SECONDARY that live inputs read.
    pub sum: u8,
    /// A live input reads a constant.
    pub reads_constants: bool,
    /// A or C is not always 0, so that the lerp contributes.
    pub lerps: bool,
}

/// SPARE0 + SECONDARY above 1.0 enters the lerp and D: the sum can pass 2.0 (FIN-5).
const TWO: i32 = 510;

const BLOCK: &str = "final combiner";

/// FIN-1: max(0, x), or max(0, 255 - max(0, x)).
#[inline(always)]
pub fn input<L: Lane>(x: L, invert: bool) -> L {
    if invert { (L::ONE - x.max0()).max0() } else { x.max0() }
}

/// FIN-2: clamp(A B + (1 - A) C + D), the unclamped value first.
#[inline(always)]
pub fn lerp_add<L: Lane, O: Observer>([a, b, c, d]: [L; 4], rounding: LerpRounding, observer: &mut O) -> L {
    let ab = a.factor().product(b.factor());
    let ac = (L::ONE - a).factor().product(c.factor());
    observer.count(Work::Products, 2);
    match rounding {
        LerpRounding::Once => {
            observer.count(Work::Roundings, 1);
            observer.settle(Rule::Fin2, (ab + ac).rounded()) + d
        }
        LerpRounding::Twice => {
            observer.count(Work::Roundings, 2);
            observer.settle(Rule::Fin2, ab.rounded()) + observer.settle(Rule::Fin2, ac.rounded()) + d
        }
    }
}

/// FIN-3: the colour sum.
#[inline(always)]
pub fn color_sum<L: Lane>(spare0: L, secondary: L, state: &FinalCombiner) -> L {
    let sum = input(spare0, state.invert_spare0) + input(secondary, state.invert_secondary);
    if state.color_sum_clamp { sum.least(L::ONE) } else { sum }
}

/// FIN-4: E F.
#[inline(always)]
pub fn product<R: crate::number::Register>(e: R, f: R) -> R {
    e.factor().product(f.factor()).rounded()
}

/// Runs the final combiner: R, G, B, A bytes, those that nothing needs left at zero.
#[inline]
pub fn run<L: Lane, O: Observer>(
    planned: &PlannedFinal,
    profile: Profile,
    policies: &Policies,
    registers: &mut Registers<L>,
    observer: &mut O,
) -> [L; 4] {
    let state = &planned.state;
    if planned.reads_constants {
        registers.load(Register::ConstantColor0, state.constants[0].map(L::byte));
        registers.load(Register::ConstantColor1, state.constants[1].map(L::byte));
    }
    let mut specials = Specials { sum: [L::ZERO; 4], product: [L::ZERO; 4] };
    for channel in (0..3).filter(|c| planned.sum >> c & 1 != 0) {
        let operands = [registers.read(Register::Spare0, channel), registers.read(Register::SecondaryColor, channel)];
        specials.sum[channel] = color_sum(operands[0], operands[1], state);
        if O::ON {
            report_sum(state, channel, operands, specials.sum[channel], observer);
        }
    }
    for channel in (0..3).filter(|c| planned.product >> c & 1 != 0) {
        let [e, f] = [4, 5].map(|n| read(&state.inputs[n], n, channel, registers, &specials, observer));
        observer.count(Work::Products, 1);
        observer.count(Work::Roundings, 1);
        specials.product[channel] = observer.settle(Rule::Fin4, product(e, f));
        if O::ON {
            let suffix = channel_name(channel);
            let inputs = vec![
                report::register(format!("final.E.{suffix}"), e),
                report::register(format!("final.F.{suffix}"), f),
            ];
            let name = format!("final.EF.{suffix}");
            observer.step(
                report::register_step(BLOCK, "FIN-4", name, specials.product[channel]).by("product_round_255", inputs),
            );
        }
    }
    let mut out = [L::ZERO; 4];
    for channel in (0..3).filter(|c| planned.live >> c & 1 != 0) {
        if !planned.lerps && !O::ON {
            // 0 B + (1 - 0) 0 + D.
            out[channel] = read(&state.inputs[3], 3, channel, registers, &specials, observer).clamped();
            continue;
        }
        let [a, b, c, d] = [0, 1, 2, 3].map(|n| read(&state.inputs[n], n, channel, registers, &specials, observer));
        let raw = lerp_add([a.least(L::ONE), b, c, d], policies.lerp_rounding, observer);
        out[channel] = raw.clamped();
        if O::ON {
            report_rgb(channel, [a, b, c, d], raw, out[channel], profile, policies, observer);
        }
    }
    if planned.live & 8 != 0 {
        out[3] = read(&state.g, 6, 3, registers, &specials, observer);
        if O::ON {
            let inputs = vec![report::register("final.G.a", out[3])];
            observer.step(report::register_step(BLOCK, "FIN-4", "fragment.a", out[3]).by("write", inputs));
        }
    }
    out
}

/// The two registers that exist only here. Their alpha is 0 (FIN-1).
struct Specials<L> {
    sum: [L; 4],
    product: [L; 4],
}

#[inline(always)]
fn read<L: Lane, O: Observer>(
    from: &FinalInput,
    n: usize,
    channel: usize,
    registers: &Registers<L>,
    specials: &Specials<L>,
    observer: &mut O,
) -> L {
    let source = match from.component {
        Component::Rgb => channel,
        Component::Blue => 2,
        Component::Alpha => 3,
    };
    let register = general(from.register);
    let x = match from.register {
        FinalRegister::Spare0PlusSecondary => specials.sum[source],
        FinalRegister::ETimesF => specials.product[source],
        _ => registers.read(register, source),
    };
    let value = input(x, from.invert);
    if O::ON {
        let operand = match from.register {
            FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF if source == 3 => "zero.a".to_string(),
            FinalRegister::Spare0PlusSecondary => format!("final.sum.{}", channel_name(source)),
            FinalRegister::ETimesF => format!("final.EF.{}", channel_name(source)),
            _ => format!("{}.{}", registers::name(register), channel_name(source)),
        };
        let name = format!("final.{}.{}", ["A", "B", "C", "D", "E", "F", "G"][n], channel_name(channel));
        let operation = if from.invert { "final_invert" } else { "unsigned_identity" };
        let inputs = vec![report::register(operand, x)];
        observer.step(report::register_step(BLOCK, "FIN-1", name, value).by(operation, inputs));
    }
    value
}

/// The general register behind a final one; ZERO for the two special ones.
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
        let value = input(x, invert);
        let name = format!("final.sum.{register}.{suffix}");
        let operation = if invert { "final_invert" } else { "unsigned_identity" };
        let operand = report::register(format!("{register}.{suffix}"), x);
        observer.step(report::register_step(BLOCK, "FIN-3", name.clone(), value).by(operation, vec![operand]));
        terms.push(report::register(name, value));
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
    let wrong = profile == Profile::Nv10 && raw.observe().0 > i64::from(TWO);
    let note =
        wrong.then(|| "above 2.0: the real part gives a wrong value that nobody has recorded (FIN-5)".to_string());
    let name = format!("final.rgb.{suffix}");
    let value = raw.observe().0;
    observer.step(report::register_step(BLOCK, "FIN-2", name.clone(), raw).by(operation, operands).note(note));
    let step: Step = report::register_step(BLOCK, "FIN-2", format!("fragment.{suffix}"), out);
    let clamped = (value != out.observe().0).then(|| "clamped".to_string());
    observer.step(step.by("clamp_0_255", vec![report::register(name, raw)]).note(clamped));
}
