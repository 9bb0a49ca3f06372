//! Runs combiners without a rasteriser, in real numbers and in integers, and bounds the difference.

use ninebit::combiner::registers::Registers;
use ninebit::number::Lane;
use ninebit::state::{
    Bias, CombinerInput, Combiners, Component, InputMapping, Policies, Portion, Profile, Register, Scale,
};
use ninebit::trace::Silent;

/// The inputs of the combiners at a pixel, as bytes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pixel {
    pub(crate) diffuse: [u8; 4],
    pub(crate) specular: [u8; 4],
    pub(crate) textures: [[u8; 4]; 4],
    /// The fog colour R, G, B, then the fog factor.
    pub(crate) fog: [u8; 4],
}

impl Pixel {
    pub(crate) fn from_choices(choices: &mut super::Choices) -> Pixel {
        Pixel {
            diffuse: choices.color(),
            specular: choices.color(),
            textures: std::array::from_fn(|_| choices.color()),
            fog: choices.color(),
        }
    }

    pub(crate) fn real(bytes: [u8; 4]) -> [f64; 4] {
        bytes.map(|byte| f64::from(byte) / 255.0)
    }
}

/// Runs the combiners and returns the fragment's colour in 255ths.
pub(crate) fn run<L: Lane>(combiners: &Combiners, profile: Profile, pixel: &Pixel) -> [L; 4] {
    let mut registers = Registers::<L>::new();
    registers.load(Register::PrimaryColor, pixel.diffuse.map(L::byte));
    registers.load(Register::SecondaryColor, pixel.specular.map(L::byte));
    registers.load(Register::Fog, pixel.fog.map(L::byte));
    let units = [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3];
    for (register, color) in units.into_iter().zip(pixel.textures) {
        registers.load(register, color.map(L::byte));
    }
    let bytes = |constants: [[u8; 4]; 2], _| constants.map(|constant| constant.map(L::byte));
    combiners.observed(&mut registers, bytes, (profile, &Policies::DEFAULT), &mut Silent)
}

/// Returns how far the integers of the fragment, colour and alpha, can be from the real numbers, in 255ths. The bound adds what each rule
/// rounds. Each stage counts as off by at least `least`, which is 1 if negative results are read, because these end at -256 in place of
/// -255.
pub(crate) fn bound(combiners: &Combiners, least: f64) -> [f64; 2] {
    // Bounds for each register, colour and alpha. The inputs of a pixel are exact.
    let mut errors = [[0.0_f64; 2]; 12];
    for stage in &combiners.stages {
        let [rgb, alpha] = [(&stage.rgb, 0), (&stage.alpha, 1)]
            .map(|(portion, half)| portion_bound(portion, half, &errors).max(least));
        for (portion, half, bound) in [(&stage.rgb, 0, rgb), (&stage.alpha, 1, alpha)] {
            for output in [portion.ab_output, portion.cd_output, portion.sum_output] {
                errors[output as usize][half] = bound;
            }
        }
        if stage.rgb.ab_blue_to_alpha {
            errors[stage.rgb.ab_output as usize][1] = rgb;
        }
        errors[Register::Zero as usize] = [0.0; 2];
    }
    let spare0 = errors[Register::Spare0 as usize];
    let alpha = spare0[usize::from(combiners.final_combiner.g.component == Component::Alpha)];
    // The sum is exact. The blend with fog rounds once.
    [spare0[0] + 0.5, alpha]
}

fn portion_bound(portion: &Portion, half: usize, errors: &[[f64; 2]; 12]) -> f64 {
    let input = |input: &CombinerInput| {
        let channel = match (half, input.component) {
            (0, Component::Rgb) | (1, Component::Blue) => 0,
            _ => 1,
        };
        let error = errors[input.register as usize][channel];
        match input.mapping {
            // By CMB-3 the chip computes 2 (x - 128), the real formula 2x - 255.
            InputMapping::ExpandNormal | InputMapping::ExpandNegate => 2.0 * error + 1.0,
            InputMapping::HalfBiasNormal | InputMapping::HalfBiasNegate => error + 0.5,
            _ => error,
        }
    };
    let product = |n: usize, dot: bool| {
        let [a, b] = [input(&portion.inputs[2 * n]), input(&portion.inputs[2 * n + 1])];
        (a + b + a * b / 255.0) * if dot { 3.0 } else { 1.0 }
    };
    let sum = product(0, portion.ab_dot_product) + product(1, portion.cd_dot_product);
    let biased = sum + 0.5 + if portion.bias == Bias::None { 0.0 } else { 0.5 };
    match portion.scale {
        Scale::One => biased,
        Scale::Two => 2.0 * biased,
        Scale::Four => 4.0 * biased,
        Scale::Half => biased,
    }
}

/// Compares a lowered program with the colour that the API defines, R, G, B, A in 0..1.
pub(crate) fn agrees(combiners: &Combiners, profile: Profile, pixel: &Pixel, expected: [f64; 4]) -> Result<(), String> {
    let ideal = run::<f64>(combiners, profile, pixel);
    let fixed = run::<i32>(combiners, profile, pixel);
    let [rgb, alpha] = bound(combiners, 0.0);
    for channel in 0..4 {
        let off = (ideal[channel] / 255.0 - expected[channel]).abs();
        if off > 1e-12 {
            return Err(format!("channel {channel}: {} is not {}", ideal[channel] / 255.0, expected[channel]));
        }
        let bound = if channel < 3 { rgb } else { alpha };
        if (f64::from(fixed[channel]) - ideal[channel]).abs() > bound + 1e-9 {
            return Err(format!(
                "channel {channel}: {} is further than {bound} from {}",
                fixed[channel], ideal[channel]
            ));
        }
    }
    Ok(())
}
