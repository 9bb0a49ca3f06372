//! Which outputs of the combiners anybody reads: backwards from the stored word to the interpolators and texture units.

use crate::combiner::final_combiner::{self, PlannedFinal};
use crate::combiner::general::{PlannedPortion, PlannedStage, source_channel};
use crate::combiner::registers::{bit, initially_undefined};
use crate::rop::blend;
use crate::state::{
    Blend, BlendFactor, Combiners, Component, DotMapping, Draw, FinalInput, FinalRegister, Portion, Register,
    ShaderOperation, ShaderStage, TEXTURE_UNITS,
};

/// Every channel of both constant colours.
const CONSTANTS: u64 = 255 << (4 * Register::ConstantColor0 as usize);

const RGB: u8 = 7;
const ALPHA: u8 = 8;

/// What a draw's combiners need, and what of them is needed.
pub(super) struct Liveness {
    pub(super) stages: Vec<PlannedStage>,
    pub(super) final_combiner: PlannedFinal,
    pub(super) primary: u8,
    pub(super) secondary: u8,
    pub(super) fog: u8,
    pub(super) units: [u8; TEXTURE_UNITS],
    /// Units whose dot products are needed.
    pub(super) dots: [bool; TEXTURE_UNITS],
    pub(super) spare0_alpha: bool,
    pub(super) undefined: u64,
}

impl Liveness {
    /// `written` are the channels that the surface stores; without `prune` everything counts as read.
    pub(super) fn of(draw: &Draw, alpha_test: bool, blend: Option<Blend>, written: u8, prune: bool) -> Liveness {
        let fragment = if prune { fragment_channels(alpha_test, blend, written) } else { RGB | ALPHA };
        let (final_combiner, mut live) = final_liveness(&draw.combiners, fragment);
        let mut stages: Vec<PlannedStage> = Vec::new();
        for (index, stage) in draw.combiners.stages.iter().enumerate().rev() {
            let [rgb, alpha] = [(&stage.rgb, RGB), (&stage.alpha, ALPHA)].map(|(portion, channels)| PlannedPortion {
                portion: *portion,
                live: outputs(portion).map(|d| live_channels(d, channels, live, prune)),
                blue_to_alpha: [
                    portion.ab_blue_to_alpha && live_channels(portion.ab_output, ALPHA, live, prune) != 0,
                    portion.cd_blue_to_alpha && live_channels(portion.cd_output, ALPHA, live, prune) != 0,
                ],
            });
            live &= !(written_bits(&stage.rgb, RGB) | written_bits(&stage.alpha, ALPHA));
            let read = read_bits(&rgb, RGB) | read_bits(&alpha, ALPHA);
            live |= read;
            if !(rgb.is_idle() && alpha.is_idle()) {
                let reads_constants = read & CONSTANTS != 0;
                stages.push(PlannedStage { index, rgb, alpha, constants: stage.constants, reads_constants });
            }
        }
        stages.reverse();
        if !prune {
            live = u64::MAX;
        }
        let channels = |register: Register| (live >> (4 * register as usize) & 15) as u8;
        let mut units = [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3].map(channels);
        // CMB-13: SPARE0's alpha starts as texture 0's.
        let spare0_alpha = channels(Register::Spare0) & ALPHA != 0;
        units[0] |= if spare0_alpha { ALPHA } else { 0 };
        let dots = shader_liveness(&draw.texture_shader, &mut units);
        Liveness {
            stages,
            final_combiner,
            primary: channels(Register::PrimaryColor),
            secondary: channels(Register::SecondaryColor),
            fog: channels(Register::Fog),
            units,
            dots,
            spare0_alpha,
            undefined: live & initially_undefined(),
        }
    }
}

/// What the stages of a texture shader read of one another, backwards: adds the channels to `units`, and says whose dot products are needed.
fn shader_liveness(shader: &[ShaderStage; TEXTURE_UNITS], units: &mut [u8; TEXTURE_UNITS]) -> [bool; TEXTURE_UNITS] {
    let mut dots = [false; TEXTURE_UNITS];
    for index in (0..TEXTURE_UNITS).rev() {
        let stage = &shader[index];
        if units[index] != 0 {
            let channels = match stage.operation {
                ShaderOperation::BumpEnvironment { luminance: Some(_), .. } if units[index] & RGB != 0 => RGB,
                ShaderOperation::BumpEnvironment { .. } | ShaderOperation::DependentGreenBlue => 2 | 4,
                ShaderOperation::DependentAlphaRed => 1 | ALPHA,
                _ => 0,
            };
            units[stage.previous] |= channels;
            match stage.operation {
                ShaderOperation::DotProduct2D => dots[index.saturating_sub(1)..=index].fill(true),
                ShaderOperation::DotProductCube
                | ShaderOperation::DotReflectDiffuse
                | ShaderOperation::DotReflectSpecular
                | ShaderOperation::DotReflectConstantEye { .. } => dots[1..].fill(true),
                _ => {}
            }
        }
        // Stage 2 may need the dot product of stage 3, which then reads a unit before both.
        for (dot, stage) in dots.iter().zip(shader).skip(index) {
            if *dot {
                let halves = matches!(stage.mapping, DotMapping::Hilo1 | DotMapping::HiloHemisphere);
                units[stage.previous] |= if halves { RGB | ALPHA } else { RGB };
            }
        }
    }
    dots
}

/// Channels of the fragment that alpha test, blend and store read.
fn fragment_channels(alpha_test: bool, blend: Option<Blend>, written: u8) -> u8 {
    let alpha_factor = |f: BlendFactor| {
        matches!(f, BlendFactor::SourceAlpha | BlendFactor::OneMinusSourceAlpha | BlendFactor::SourceAlphaSaturate)
    };
    let blends_alpha = blend.is_some_and(|b| {
        blend::uses_factors(b.equation) && (alpha_factor(b.source) || alpha_factor(b.destination)) && written != 0
    });
    written | if alpha_test || blends_alpha { ALPHA } else { 0 }
}

fn final_liveness(combiners: &Combiners, fragment: u8) -> (PlannedFinal, u64) {
    let state = combiners.final_combiner;
    let mut planned = PlannedFinal { state, live: fragment, product: 0, sum: 0, reads_constants: false, lerps: true };
    planned.lerps = ![state.inputs[0], state.inputs[2]].iter().all(FinalInput::is_zero);
    let mut live = 0;
    let mut read = |input: &FinalInput, channels: u8| {
        for channel in (0..4).filter(|c| channels >> c & 1 != 0) {
            let source = match input.component {
                Component::Rgb => channel,
                Component::Blue => 2,
                Component::Alpha => 3,
            };
            match input.register {
                // Their alpha is 0 and reads nothing.
                FinalRegister::Spare0PlusSecondary if source < 3 => planned.sum |= 1 << source,
                FinalRegister::ETimesF if source < 3 => planned.product |= 1 << source,
                FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF => {}
                register => live |= bit(final_combiner::general(register), source),
            }
        }
    };
    for input in &state.inputs[..4] {
        read(input, fragment & RGB);
    }
    if fragment & ALPHA != 0 {
        read(&state.g, ALPHA);
    }
    for channel in (0..3).filter(|c| planned.product >> c & 1 != 0) {
        for input in &state.inputs[4..] {
            let source = if input.component == Component::Rgb { channel } else { 3 };
            live |= bit(final_combiner::general(input.register), source);
        }
    }
    for channel in (0..3).filter(|c| planned.sum >> c & 1 != 0) {
        live |= bit(Register::Spare0, channel) | bit(Register::SecondaryColor, channel);
    }
    planned.reads_constants = live & CONSTANTS != 0;
    (planned, live)
}

fn outputs(portion: &Portion) -> [Register; 3] {
    [portion.ab_output, portion.cd_output, portion.sum_output]
}

/// Channels of a destination, among `channels`, that are live.
fn live_channels(destination: Register, channels: u8, live: u64, prune: bool) -> u8 {
    match destination {
        Register::Zero => 0,
        _ if !prune => channels,
        register => (live >> (4 * register as usize)) as u8 & channels,
    }
}

/// Bits that a portion overwrites.
fn written_bits(portion: &Portion, channels: u8) -> u64 {
    let whole = |register: Register| {
        if register == Register::Zero { 0 } else { u64::from(channels) << (4 * register as usize) }
    };
    let mut written: u64 = outputs(portion).into_iter().fold(0, |all, register| all | whole(register));
    for (flag, register) in
        [(portion.ab_blue_to_alpha, portion.ab_output), (portion.cd_blue_to_alpha, portion.cd_output)]
    {
        if flag && register != Register::Zero {
            written |= bit(register, 3);
        }
    }
    written
}

/// Bits that a planned portion reads.
fn read_bits(planned: &PlannedPortion, channels: u8) -> u64 {
    let mut read = 0;
    for product in 0..2 {
        let dot = [planned.portion.ab_dot_product, planned.portion.cd_dot_product][product];
        let needed = planned.product_channels(product);
        let needed = if dot && needed != 0 { RGB } else { needed & channels };
        for input in &planned.portion.inputs[2 * product..2 * product + 2] {
            for channel in (0..4).filter(|c| needed >> c & 1 != 0) {
                read |= bit(input.register, source_channel(input, channel));
            }
        }
    }
    if planned.portion.mux && planned.live[2] != 0 {
        read |= bit(Register::Spare0, 3);
    }
    read
}
