//! From a planned draw to the graph of its pixels: which rule is applied to what. The arithmetic itself is the kernels'.

use super::Sampler;
use super::graph::{Graph, Input, Value};
use super::table::Channel;
use crate::combiner::final_combiner;
use crate::combiner::general::{PlannedPortion, PlannedStage, source_channel};
use crate::combiner::registers::REGISTERS;
use crate::number::Lane;
use crate::plan::PlannedDraw;
use crate::raster::assemble::Corner;
use crate::rop::surface;
use crate::state::{
    AddressMode, Bias, Blend, BlendEquation, BlendFactor, CombinerInput, Component, FinalInput, FinalRegister,
    InputMapping, MuxSelect, Register, Scale, TextureFormat, TextureKind,
};
use crate::texture::unit::PlannedUnit;

/// What a draw's pixels come to.
pub(super) struct Built {
    /// Everything that is computed.
    pub(super) graph: Graph,
    /// The fragment's alpha before blending, for the alpha test.
    pub(super) alpha: Value,
    /// What is stored: R, G, B, A, each 0..=255.
    pub(super) stored: [Value; 4],
}

/// Registers of one moment.
type Registers = [[Value; 4]; REGISTERS];

/// Builds the graph of a draw. Its units are sampled by `samplers`, or pixel by pixel.
pub(super) fn build(draw: &PlannedDraw, samplers: Option<&[Sampler]>) -> Built {
    let mut graph = Graph::default();
    let mut registers = inputs(draw, samplers, &mut graph);
    for planned in &draw.stages {
        stage(planned, draw.mux_select, &mut registers, &mut graph);
    }
    let fragment = final_stage(draw, &mut registers, &mut graph);
    let blended = match &draw.blend {
        None => fragment,
        Some(state) => blend(draw, state, fragment, &mut graph),
    };
    let stored = blended.map(|v| graph.clamp(v));
    Built { graph, alpha: fragment[3], stored }
}

/// The registers as a pixel brings them (CMB-13).
fn inputs(draw: &PlannedDraw, samplers: Option<&[Sampler]>, graph: &mut Graph) -> Registers {
    let zero = graph.constant(0);
    let mut registers = [[zero; 4]; REGISTERS];
    registers[Register::PrimaryColor as usize] = color(draw, |v| v.primary, Input::Primary, graph);
    registers[Register::SecondaryColor as usize] = color(draw, |v| v.secondary, Input::Secondary, graph);
    for (n, byte) in draw.fog.color.into_iter().enumerate() {
        registers[Register::Fog as usize][n] = graph.constant(i16::from(byte));
    }
    registers[Register::Fog as usize][3] =
        if draw.fog.enabled { graph.input(Input::Fog, (0, 255)) } else { graph.constant(255) };
    const UNITS: [Register; 4] = [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3];
    for (n, register) in UNITS.into_iter().enumerate() {
        if draw.unbound[n] != 0 {
            // TEX-16.
            registers[register as usize][3] = graph.constant(255);
        }
        let unit = draw.units.iter().find(|unit| unit.index == n);
        let sampler = samplers.and_then(|all| all.iter().find(|sampler| sampler.unit == n));
        registers[register as usize] = match (unit, sampler) {
            (Some(unit), Some(sampler)) => texture(unit, sampler, graph),
            _ if draw.shader.is_some() || unit.is_some() => {
                [0, 1, 2, 3].map(|channel| graph.input(Input::Texture(n, channel), (-256, 255)))
            }
            _ => registers[register as usize],
        };
    }
    if draw.spare0_alpha {
        registers[Register::Spare0 as usize][3] = registers[Register::Texture0 as usize][3];
    }
    registers
}

/// An interpolated colour: channels that are equal at every vertex are one value, those that never differ a constant.
fn color(draw: &PlannedDraw, of: fn(&Corner) -> [u8; 4], input: fn(usize) -> Input, graph: &mut Graph) -> [Value; 4] {
    let bytes: Vec<[u8; 4]> = draw.assembly.corners.iter().map(of).collect();
    let first = bytes.first().copied().unwrap_or_default();
    [0, 1, 2, 3].map(|channel: usize| {
        if bytes.iter().all(|b| b[channel] == first[channel]) {
            return graph.constant(i16::from(first[channel]));
        }
        let same = (0..channel).find(|other| bytes.iter().all(|b| b[*other] == b[channel]));
        graph.input(input(same.unwrap_or(channel)), (0, 255))
    })
}

/// What a unit yields: channels that its format or its texels make equal are one value, constant ones a constant.
fn texture(unit: &PlannedUnit, sampler: &Sampler, graph: &mut Graph) -> [Value; 4] {
    let signed = sampler.signed;
    let range = |channel: usize| if signed[channel] { (-256, 254) } else { (0, 255) };
    if let Some(table) = &sampler.table {
        return [0, 1, 2, 3].map(|channel: usize| match table.channels[channel] {
            Channel::Constant(byte) if signed[channel] => graph.constant((i32::from(byte) - 128).signed_texel() as i16),
            Channel::Constant(byte) => graph.constant(i16::from(byte)),
            Channel::Of(other) => graph.input(Input::Texture(unit.index, other), range(other)),
        });
    }
    let stays_inside = unit.kind == TextureKind::Cube
        || unit.border
        || [unit.state.address_s, unit.state.address_t].iter().all(|mode| *mode != AddressMode::ClampToBorder);
    let plain = signed == [false; 4] && stays_inside && !unit.is_wide();
    [0, 1, 2, 3].map(|channel: usize| {
        let from = if plain { source(unit.format, channel) } else { Source::Channel(channel) };
        match from {
            Source::One => graph.constant(255),
            Source::Channel(source) => graph.input(Input::Texture(unit.index, source), range(channel)),
        }
    })
}

/// Where a channel of a texel comes from.
enum Source {
    /// The first channel that always equals it.
    Channel(usize),
    /// It is 255.
    One,
}

/// TEX-1: channels that a format makes of one another, or of nothing.
fn source(format: TextureFormat, channel: usize) -> Source {
    match (format, channel) {
        (TextureFormat::L8 | TextureFormat::A8L8, 1 | 2) | (TextureFormat::I8, _) => Source::Channel(0),
        (TextureFormat::A8, 0..=2) => Source::One,
        (
            TextureFormat::L8
            | TextureFormat::X8R8G8B8
            | TextureFormat::R5G6B5
            | TextureFormat::R6G5B5
            | TextureFormat::X1R5G5B5,
            3,
        ) => Source::One,
        _ => Source::Channel(channel),
    }
}

/// CMB-1, CMB-6 to CMB-11: one general stage. Reads everything, then writes everything.
fn stage(planned: &PlannedStage, mux: MuxSelect, registers: &mut Registers, graph: &mut Graph) {
    load_constants(planned.constants, registers, graph);
    let before = *registers;
    for (portion, first, channels) in [(&planned.rgb, 0, 3), (&planned.alpha, 3, 1)] {
        let state = &portion.portion;
        let outputs = [state.ab_output, state.cd_output, state.sum_output];
        let mut finished = [[None; 4]; 3];
        for channel in first..first + channels {
            let of = |n: usize, graph: &mut Graph| pairs(portion, n, channel, &before, graph);
            for n in 0..2 {
                let wanted = portion.live[n] >> channel & 1 != 0 || (portion.blue_to_alpha[n] && channel == 2);
                if wanted {
                    let pairs = of(n, graph);
                    finished[n][channel] = Some(finish(state.bias, state.scale, &pairs, graph));
                }
            }
            if portion.live[2] >> channel & 1 != 0 {
                let [ab, cd] = [0, 1].map(|n| of(n, graph));
                let value = if state.mux {
                    let by = before[Register::Spare0 as usize][3];
                    let [ab, cd] = [ab, cd].map(|pairs| finish(state.bias, state.scale, &pairs, graph));
                    graph.select(mux, by, cd, ab)
                } else {
                    finish(state.bias, state.scale, &[ab, cd].concat(), graph)
                };
                finished[2][channel] = Some(value);
            }
        }
        for n in 0..3 {
            let destination = &mut registers[outputs[n] as usize];
            for channel in (first..first + channels).filter(|c| portion.live[n] >> c & 1 != 0) {
                destination[channel] = finished[n][channel].unwrap_or(destination[channel]);
            }
            if n < 2 && portion.blue_to_alpha[n] {
                destination[3] = finished[n][2].unwrap_or(destination[3]);
            }
        }
    }
}

fn load_constants(constants: [[u8; 4]; 2], registers: &mut Registers, graph: &mut Graph) {
    for (register, bytes) in [Register::ConstantColor0, Register::ConstantColor1].into_iter().zip(constants) {
        registers[register as usize] = bytes.map(|byte| graph.constant(i16::from(byte)));
    }
}

/// The factors whose products make up AB (0) or CD (1) in a channel.
fn pairs(
    planned: &PlannedPortion,
    product: usize,
    channel: usize,
    registers: &Registers,
    graph: &mut Graph,
) -> Vec<(Value, Value)> {
    let state = &planned.portion;
    let dot = [state.ab_dot_product, state.cd_dot_product][product];
    let [a, b] = [&state.inputs[2 * product], &state.inputs[2 * product + 1]];
    let mut factor = |input: &CombinerInput, channel: usize| {
        graph.map(input.mapping, registers[input.register as usize][source_channel(input, channel)])
    };
    let channels = if dot { 0..3 } else { channel..channel + 1 };
    channels.map(|channel| (factor(a, channel), factor(b, channel))).collect()
}

fn finish(bias: Bias, scale: Scale, pairs: &[(Value, Value)], graph: &mut Graph) -> Value {
    let sum = graph.sum(pairs);
    graph.output(bias, scale, sum)
}

/// FIN-1 to FIN-4.
fn final_stage(draw: &PlannedDraw, registers: &mut Registers, graph: &mut Graph) -> [Value; 4] {
    let planned = &draw.final_combiner;
    let state = &planned.state;
    load_constants(state.constants, registers, graph);
    let zero = graph.constant(0);
    let mut specials = Specials { sum: [zero; 4], product: [zero; 4] };
    for channel in (0..3).filter(|c| planned.sum >> c & 1 != 0) {
        let spare0 = unsigned(registers[Register::Spare0 as usize][channel], state.invert_spare0, graph);
        let secondary = unsigned(registers[Register::SecondaryColor as usize][channel], state.invert_secondary, graph);
        let sum = graph.plus(spare0, secondary);
        let one = graph.constant(255);
        specials.sum[channel] = if state.color_sum_clamp { graph.least(sum, one) } else { sum };
    }
    for channel in (0..3).filter(|c| planned.product >> c & 1 != 0) {
        let [e, f] = [4, 5].map(|n| read(&state.inputs[n], channel, registers, &specials, graph));
        specials.product[channel] = graph.sum(&[(e, f)]);
    }
    let mut out = [zero; 4];
    for channel in (0..3).filter(|c| planned.live >> c & 1 != 0) {
        let [a, b, c, d] = [0, 1, 2, 3].map(|n| read(&state.inputs[n], channel, registers, &specials, graph));
        let one = graph.constant(255);
        let a = graph.least(a, one);
        let rest = graph.map(InputMapping::UnsignedInvert, a);
        let lerp = graph.sum(&[(a, b), (rest, c)]);
        let raw = graph.plus(lerp, d);
        out[channel] = graph.clamp(raw);
    }
    if planned.live & 8 != 0 {
        out[3] = read(&state.g, 3, registers, &specials, graph);
    }
    out
}

/// The registers that exist only in the final combiner.
struct Specials {
    sum: [Value; 4],
    product: [Value; 4],
}

/// FIN-1.
fn unsigned(v: Value, invert: bool, graph: &mut Graph) -> Value {
    if invert {
        let inverted = graph.map(InputMapping::UnsignedInvert, v);
        graph.map(InputMapping::UnsignedIdentity, inverted)
    } else {
        graph.map(InputMapping::UnsignedIdentity, v)
    }
}

fn read(from: &FinalInput, channel: usize, registers: &Registers, specials: &Specials, graph: &mut Graph) -> Value {
    let source = match from.component {
        Component::Rgb => channel,
        Component::Blue => 2,
        Component::Alpha => 3,
    };
    let v = match from.register {
        FinalRegister::Spare0PlusSecondary => specials.sum[source],
        FinalRegister::ETimesF => specials.product[source],
        register => registers[final_combiner::general(register) as usize][source],
    };
    unsigned(v, from.invert, graph)
}

/// ROP-2 to ROP-5, not yet clamped.
fn blend(draw: &PlannedDraw, state: &Blend, fragment: [Value; 4], graph: &mut Graph) -> [Value; 4] {
    let dropped = surface::dropped_bits(draw.surface);
    let mut source = fragment;
    for (n, bits) in dropped.into_iter().enumerate() {
        source[n] = graph.truncate(bits, fragment[n]);
    }
    let destination = [0, 1, 2, 3].map(|channel: usize| {
        // 255 where no alpha is stored.
        if channel == 3 && surface::kept_channels(draw.surface) & 8 == 0 {
            graph.constant(255)
        } else {
            graph.input(Input::Destination(channel), (0, 255))
        }
    });
    let constant = draw.blend_constant.map(|byte| graph.constant(i16::from(byte)));
    let mut out = source;
    for channel in (0..4).filter(|c| draw.blended >> c & 1 != 0) {
        let [fs, fd] =
            [state.source, state.destination].map(|f| factor(f, channel, &source, &destination, &constant, graph));
        let (s, d) = (source[channel], destination[channel]);
        out[channel] = match state.equation {
            BlendEquation::Add => graph.sum(&[(s, fs), (d, fd)]),
            BlendEquation::Subtract => graph.difference([s, fs, d, fd]),
            BlendEquation::ReverseSubtract => graph.difference([d, fd, s, fs]),
            BlendEquation::Min => graph.least(s, d),
            BlendEquation::Max => graph.greatest(s, d),
            BlendEquation::SignedAdd | BlendEquation::SignedReverseSubtract => {
                let signed = graph.signed(state.equation == BlendEquation::SignedReverseSubtract, s);
                graph.plus(d, signed)
            }
        };
    }
    out
}

/// ROP-4.
fn factor(
    factor: BlendFactor,
    channel: usize,
    source: &[Value; 4],
    destination: &[Value; 4],
    constant: &[Value; 4],
    graph: &mut Graph,
) -> Value {
    let mut one_minus = |v: Value| graph.map(InputMapping::UnsignedInvert, v);
    match factor {
        BlendFactor::Zero => graph.constant(0),
        BlendFactor::One => graph.constant(255),
        BlendFactor::SourceColor => source[channel],
        BlendFactor::OneMinusSourceColor => one_minus(source[channel]),
        BlendFactor::SourceAlpha => source[3],
        BlendFactor::OneMinusSourceAlpha => one_minus(source[3]),
        BlendFactor::DestinationAlpha => destination[3],
        BlendFactor::OneMinusDestinationAlpha => one_minus(destination[3]),
        BlendFactor::DestinationColor => destination[channel],
        BlendFactor::OneMinusDestinationColor => one_minus(destination[channel]),
        BlendFactor::SourceAlphaSaturate if channel == 3 => graph.constant(255),
        BlendFactor::SourceAlphaSaturate => {
            let free = one_minus(destination[3]);
            graph.least(source[3], free)
        }
        BlendFactor::ConstantColor => constant[channel],
        BlendFactor::OneMinusConstantColor => one_minus(constant[channel]),
        BlendFactor::ConstantAlpha => constant[3],
        BlendFactor::OneMinusConstantAlpha => one_minus(constant[3]),
    }
}
