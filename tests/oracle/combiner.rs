//! Computes general stages (CMB) and the final combiner (FIN), with all policies.

use super::real::rnd255;
use ninebit::state::{
    Bias, CombinerInput, Combiners, Component, DotRounding, ExpandCentre, FinalInput, FinalRegister, HalfBiasConstant,
    InputMapping, LerpRounding, MuxNegative, MuxSelect, OutputRounding, Policies, Portion, Register, RegisterFloor,
    Scale, SumRounding,
};

/// The registers with R, G, B, A each, in units of 1/255.
#[derive(Clone)]
pub struct Registers {
    pub fog: [i128; 4],
    pub primary: [i128; 4],
    pub secondary: [i128; 4],
    pub textures: [[i128; 4]; 4],
    pub spare0: [i128; 4],
    pub spare1: [i128; 4],
}

impl Registers {
    fn read(&self, register: Register, constants: &[[u8; 4]; 2]) -> [i128; 4] {
        match register {
            Register::Zero => [0; 4],
            Register::ConstantColor0 => constants[0].map(i128::from),
            Register::ConstantColor1 => constants[1].map(i128::from),
            Register::Fog => self.fog,
            Register::PrimaryColor => self.primary,
            Register::SecondaryColor => self.secondary,
            Register::Texture0 => self.textures[0],
            Register::Texture1 => self.textures[1],
            Register::Texture2 => self.textures[2],
            Register::Texture3 => self.textures[3],
            Register::Spare0 => self.spare0,
            Register::Spare1 => self.spare1,
        }
    }

    fn write(&mut self, register: Register) -> Option<&mut [i128; 4]> {
        match register {
            Register::PrimaryColor => Some(&mut self.primary),
            Register::SecondaryColor => Some(&mut self.secondary),
            Register::Texture0 => Some(&mut self.textures[0]),
            Register::Texture1 => Some(&mut self.textures[1]),
            Register::Texture2 => Some(&mut self.textures[2]),
            Register::Texture3 => Some(&mut self.textures[3]),
            Register::Spare0 => Some(&mut self.spare0),
            Register::Spare1 => Some(&mut self.spare1),
            Register::Zero | Register::ConstantColor0 | Register::ConstantColor1 | Register::Fog => None,
        }
    }
}

/// CMB-2 to CMB-5: maps an input. The result is in half units, because CMB-4=127.5 needs a half.
fn map(mapping: InputMapping, x: i128, policies: &Policies) -> i128 {
    let positive = x.max(0);
    let expanded = match policies.expand_centre {
        ExpandCentre::Centred => 2 * (positive - 128),
        ExpandCentre::Literal => 2 * positive - 255,
    };
    let half = match policies.half_bias {
        HalfBiasConstant::Half128 => 256,
        HalfBiasConstant::Half127 => 254,
        HalfBiasConstant::Half127And5 => 255,
    };
    match mapping {
        InputMapping::UnsignedIdentity => 2 * positive,
        InputMapping::UnsignedInvert => 2 * (255 - positive),
        InputMapping::ExpandNormal => 2 * expanded,
        InputMapping::ExpandNegate => 2 * (-expanded).min(255),
        InputMapping::HalfBiasNormal => 2 * positive - half,
        InputMapping::HalfBiasNegate => half - 2 * positive,
        InputMapping::SignedIdentity => 2 * x,
        InputMapping::SignedNegate => 2 * (-x).min(255),
    }
}

/// One unit of a register in raw values, which are in quarter units times 255.
const STEP: i128 = 4 * 255;

/// CMB-6: returns floor(raw / 255 + 1/2).
fn round(raw: i128) -> i128 {
    (2 * raw + STEP).div_euclid(2 * STEP)
}

/// CMB-9, NUM-3: returns the register value of a raw value.
fn finish(raw: i128, portion: &Portion, policies: &Policies) -> i128 {
    let bias = if portion.bias == Bias::NegativeHalf { 128 } else { 0 };
    let value = match policies.output_rounding {
        OutputRounding::BeforeScale => {
            let v = round(raw) - bias;
            match portion.scale {
                Scale::One => v,
                Scale::Two => 2 * v,
                Scale::Four => 4 * v,
                Scale::Half => (v + 1) >> 1,
            }
        }
        OutputRounding::AfterScale => {
            // A factor of two more makes the scale x1/2 exact.
            let doubled = match portion.scale {
                Scale::One => 2,
                Scale::Two => 4,
                Scale::Four => 8,
                Scale::Half => 1,
            } * (raw - bias * STEP);
            (doubled + STEP).div_euclid(2 * STEP)
        }
    };
    let floor = match policies.register_floor {
        RegisterFloor::Full => -256,
        RegisterFloor::Symmetric => -255,
    };
    value.clamp(floor, 255)
}

/// CMB-10: returns whether the mux selects CD.
fn mux_set(select: MuxSelect, value: i128, policies: &Policies) -> bool {
    match select {
        MuxSelect::Lsb => value & 1 == 1,
        MuxSelect::Msb if value >= 0 => value >= 128,
        MuxSelect::Msb => policies.mux_negative == MuxNegative::Bit7 && value & 128 != 0,
    }
}

/// Returns the finished outputs of a portion in `channels` channels: AB, CD, and the sum or mux.
fn portion_outputs(
    portion: &Portion,
    mapped: [[i128; 3]; 4],
    channels: usize,
    set: bool,
    policies: &Policies,
) -> [[i128; 3]; 3] {
    let product = |x: usize, y: usize, dot: bool| -> [i128; 3] {
        let terms: [i128; 3] = std::array::from_fn(|c| if c < channels { mapped[x][c] * mapped[y][c] } else { 0 });
        if !dot {
            return terms;
        }
        // CMB-8
        let sum = match policies.dot_rounding {
            DotRounding::Once => terms.iter().sum(),
            DotRounding::Each => terms.iter().map(|t| round(*t) * STEP).sum(),
        };
        [sum; 3]
    };
    let ab = product(0, 1, portion.ab_dot_product);
    let cd = product(2, 3, portion.cd_dot_product);
    let third: [i128; 3] = std::array::from_fn(|c| match (portion.mux, policies.sum_rounding) {
        (true, _) => {
            if set {
                cd[c]
            } else {
                ab[c]
            }
        }
        // CMB-7
        (false, SumRounding::Once) => ab[c] + cd[c],
        (false, SumRounding::Each) => (round(ab[c]) + round(cd[c])) * STEP,
    });
    [ab, cd, third].map(|output| output.map(|raw| finish(raw, portion, policies)))
}

/// CMB-1: runs one stage, whose inputs are all read before an output is written.
fn stage(registers: &mut Registers, stage: &ninebit::state::GeneralStage, select: MuxSelect, policies: &Policies) {
    let old = registers.clone();
    let set = mux_set(select, old.spare0[3], policies);
    let input = |i: &CombinerInput| -> [i128; 3] {
        let r = old.read(i.register, &stage.constants);
        let picked = match i.component {
            Component::Rgb => [r[0], r[1], r[2]],
            Component::Blue => [r[2]; 3],
            Component::Alpha => [r[3]; 3],
        };
        picked.map(|x| map(i.mapping, x, policies))
    };
    let rgb = portion_outputs(&stage.rgb, [0, 1, 2, 3].map(|k| input(&stage.rgb.inputs[k])), 3, set, policies);
    let alpha = portion_outputs(&stage.alpha, [0, 1, 2, 3].map(|k| input(&stage.alpha.inputs[k])), 1, set, policies);
    let destinations = |p: &Portion| [p.ab_output, p.cd_output, p.sum_output];
    let to_alpha = [stage.rgb.ab_blue_to_alpha, stage.rgb.cd_blue_to_alpha, false];
    for (k, destination) in destinations(&stage.rgb).into_iter().enumerate() {
        if let Some(register) = registers.write(destination) {
            register[..3].copy_from_slice(&rgb[k]);
            // CMB-11
            if to_alpha[k] {
                register[3] = rgb[k][2];
            }
        }
    }
    for (k, destination) in destinations(&stage.alpha).into_iter().enumerate() {
        if let Some(register) = registers.write(destination) {
            register[3] = alpha[k][0];
        }
    }
}

/// FIN-1: applies identity or invert. The result is never negative.
fn limit(x: i128, invert: bool) -> i128 {
    if invert { (255 - x.max(0)).max(0) } else { x.max(0) }
}

/// FIN-1 to FIN-4: returns the bytes R, G, B, A of the pixel.
fn finish_pixel(registers: &Registers, combiners: &Combiners, policies: &Policies) -> [i128; 4] {
    let f = &combiners.final_combiner;
    // FIN-3
    let sum: [i128; 3] = std::array::from_fn(|c| {
        let s = limit(registers.secondary[c], f.invert_secondary) + limit(registers.spare0[c], f.invert_spare0);
        if f.color_sum_clamp { s.min(255) } else { s }
    });
    let plain = |register: FinalRegister| {
        let same = match register {
            FinalRegister::Zero => Register::Zero,
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
            FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF => return None,
        };
        Some(registers.read(same, &f.constants))
    };
    let read = |input: &FinalInput, ef: [i128; 3]| -> [i128; 3] {
        let r = plain(input.register).unwrap_or(match input.register {
            FinalRegister::ETimesF => [ef[0], ef[1], ef[2], 0],
            _ => [sum[0], sum[1], sum[2], 0],
        });
        let picked = match input.component {
            Component::Rgb => [r[0], r[1], r[2]],
            Component::Blue => [r[2]; 3],
            Component::Alpha => [r[3]; 3],
        };
        picked.map(|x| limit(x, input.invert))
    };
    // FIN-4
    let (e, g) = (read(&f.inputs[4], [0; 3]), read(&f.inputs[5], [0; 3]));
    let ef: [i128; 3] = std::array::from_fn(|c| rnd255(e[c] * g[c]));
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| read(&f.inputs[k], ef));
    let mut out = [0; 4];
    for k in 0..3 {
        let a = a[k].min(255);
        let (near, far) = (a * b[k], (255 - a) * c[k]);
        // FIN-2
        let lerp = match policies.lerp_rounding {
            LerpRounding::Once => rnd255(near + far),
            LerpRounding::Twice => rnd255(near) + rnd255(far),
        };
        out[k] = (lerp + d[k]).clamp(0, 255);
    }
    out[3] = read(&f.g, [0; 3])[0].min(255);
    out
}

/// Runs all stages and the final combiner.
pub fn run(mut registers: Registers, combiners: &Combiners, policies: &Policies) -> [i128; 4] {
    for s in &combiners.stages {
        stage(&mut registers, s, combiners.mux_select, policies);
    }
    finish_pixel(&registers, combiners, policies)
}
