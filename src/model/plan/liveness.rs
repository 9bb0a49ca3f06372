//! Liveness: runs the order of a pixel on a [`Trail`], to find which values of a draw are read and which are the same
//! in every pixel.

use crate::algebra::{Algebra, Site, Trail, Value};
use crate::combiner::final_combiner::{self, PlannedFinal};
use crate::combiner::general::{self, PlannedPortion, PlannedStage};
use crate::combiner::registers::{REGISTERS, Registers, bit, initially_undefined};
use crate::rop::blend;
use crate::state::*;

const RGB: u8 = 7;
const ALPHA: u8 = 8;

/// All values that a draw's combiners compute.
pub(super) struct DrawValues<'d> {
    combiners: &'d Combiners,
    trail: Trail,
    /// The registers before the first stage.
    initial: Registers<Value>,
    /// The sites and constants of each stage.
    stages: Vec<Part>,
    last: Part,
    fragment: [Value; 4],
}

/// The values of a stage or of the final combiner.
struct Part {
    sites: Vec<(Site, Value)>,
    constants: [[Value; 4]; 2],
}

impl Part {
    /// Collects the values of a part after its text has been run.
    fn close(registers: &Registers<Value>, trail: &mut Trail) -> Part {
        let constants = [Register::ConstantColor0, Register::ConstantColor1];
        Part { sites: trail.take_sites(), constants: constants.map(|register| registers.values[register as usize]) }
    }

    /// Returns the sites whose values are needed, and whether one of the constants is.
    fn needed(&self, needed: &impl Fn(Value) -> bool) -> (u64, bool) {
        let sites = self.sites.iter().filter(|(_, value)| needed(*value)).fold(0, |all, (site, _)| all | site.0);
        (sites, self.constants.as_flattened().iter().any(|value| needed(*value)))
    }
}

/// The parts of a draw's combiners that are needed, and the registers and units that they read.
pub(super) struct Liveness {
    pub(super) stages: Vec<PlannedStage>,
    pub(super) final_combiner: PlannedFinal,
    pub(super) primary: u8,
    pub(super) secondary: u8,
    pub(super) fog: u8,
    pub(super) units: [u8; TEXTURE_UNITS],
    /// Whether the colour of each unit is converted (TEX-19).
    pub(super) yuv: [bool; TEXTURE_UNITS],
    /// Whether the dot product of each unit is needed.
    pub(super) dots: [bool; TEXTURE_UNITS],
    pub(super) spare0_alpha: bool,
    pub(super) undefined: u64,
}

impl<'d> DrawValues<'d> {
    /// Runs the combiners. `zero` are the registers that are 0 in every pixel before the first stage, as bits of
    /// registers and channels.
    pub(super) fn new(combiners: &'d Combiners, zero: u64) -> DrawValues<'d> {
        let mut trail = Trail::default();
        let mut initial = Registers::from_value(trail.input(Some(0)));
        for register in Register::ALL.iter().skip(1) {
            for channel in 0..4 {
                let known = (zero & bit(*register, channel) != 0).then_some(0);
                initial.write(*register, channel, trail.input(known));
            }
        }
        // CMB-13: SPARE0's alpha starts as that of texture 0.
        let alpha = trail.written(initial.read(Register::Texture0, 3));
        initial.write(Register::Spare0, 3, alpha);
        let mut registers = initial;
        let mut stages = Vec::new();
        for stage in &combiners.stages {
            let [rgb, alpha] = [&stage.rgb, &stage.alpha].map(|portion| planned(portion, 0, 0));
            let whole = PlannedStage { rgb, alpha, ..PlannedStage::whole(0, stage) };
            general::load_constants(stage.constants, &mut registers, &mut trail);
            let values = general::evaluate(&whole, combiners.mux_select, &registers, &mut trail);
            let mut after = registers;
            general::write(&whole, &values, &mut after, &mut trail);
            stages.push(Part::close(&registers, &mut trail));
            registers = after;
        }
        let state = &combiners.final_combiner;
        general::load_constants(state.constants, &mut registers, &mut trail);
        let fragment = final_combiner::evaluate(state, &registers, &mut trail).fragment;
        let last = Part::close(&registers, &mut trail);
        DrawValues { combiners, trail, initial, stages, last, fragment }
    }

    /// Returns the channels of the fragment that are 0 in every pixel, as bits R, G, B, A.
    pub(super) fn zero_fragment(&self) -> u8 {
        (0..4).filter(|c| self.fragment[*c].known == Some(0)).map(|c| 1 << c).sum()
    }

    /// Finds what is needed. `written` are the channels that the surface stores. Without `prune` everything counts as
    /// read.
    pub(super) fn liveness(
        mut self,
        draw: &Draw,
        (surface, alpha_test, blend): (SurfaceFormat, bool, Option<Blend>),
        written: u8,
        prune: bool,
    ) -> Liveness {
        let mut stored = self.fragment;
        if let Some(state) = &blend {
            let destination = [0; 4].map(|_: u8| self.trail.input(None));
            let source = blend::truncated(surface, self.fragment, &mut self.trail);
            let constant = draw.blend_constant.map(|byte| self.trail.byte(byte));
            stored = blend::blend(state, written, &constant, &source, &destination, &mut self.trail);
        }
        let mut roots: Vec<Value> = (0..4).filter(|c| written >> c & 1 != 0).map(|c| stored[c]).collect();
        roots.extend(alpha_test.then_some(self.fragment[3]));
        if !prune {
            roots.extend(self.fragment);
            let sites = self.stages.iter().flat_map(|stage| &stage.sites);
            roots.extend(sites.filter(|(site, _)| site.writes()).map(|(_, value)| *value));
        }
        let needed = self.trail.needed(&roots);
        let mut stages = Vec::new();
        for (index, (stage, part)) in self.combiners.stages.iter().zip(&self.stages).enumerate() {
            let (sites, reads_constants) = part.needed(&needed);
            let (rgb, alpha) = (planned(&stage.rgb, RGB, sites), planned(&stage.alpha, ALPHA, sites));
            if !(rgb.is_idle() && alpha.is_idle()) {
                stages.push(PlannedStage { index, rgb, alpha, constants: stage.constants, reads_constants });
            }
        }
        let state = self.combiners.final_combiner;
        let (sites, reads_constants) = self.last.needed(&needed);
        let final_combiner = PlannedFinal {
            state,
            live: (sites >> 8) as u8 & 15,
            product: (sites >> 4) as u8 & 15,
            sum: sites as u8 & 15,
            reads_constants,
            lerps: ![state.inputs[0], state.inputs[2]].iter().all(FinalInput::is_zero),
        };
        let channels = |register: Register| {
            let values = self.initial.values[register as usize];
            (0..4).filter(|c| !prune || needed(values[*c])).map(|c| 1 << c).sum::<u8>()
        };
        let mut units = [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3].map(channels);
        let spare0_alpha = channels(Register::Spare0) & ALPHA != 0;
        let yuv = units.map(|channels| draw.convert_yuv && channels & RGB != 0);
        for (channels, _) in units.iter_mut().zip(yuv).filter(|(_, is_converted)| *is_converted) {
            *channels |= RGB;
        }
        let dots = shader_liveness(draw, &mut units);
        let live = (0..REGISTERS).fold(0, |live, n| live | u64::from(channels(Register::ALL[n])) << (4 * n));
        Liveness {
            stages,
            final_combiner,
            primary: channels(Register::PrimaryColor),
            secondary: channels(Register::SecondaryColor),
            fog: channels(Register::Fog),
            units,
            yuv,
            dots,
            spare0_alpha,
            undefined: live & initially_undefined(),
        }
    }
}

/// Returns a portion of some channels, for which the values at `sites` are needed.
fn planned(portion: &Portion, channels: u8, sites: u64) -> PlannedPortion {
    let sites = sites & Site::of_channels(channels);
    PlannedPortion {
        portion: *portion,
        live: [0, 1, 2].map(|n| (0..4).filter(|c| sites & Site::write(n, *c).0 != 0).map(|c| 1 << c).sum()),
        blue_to_alpha: [0, 1].map(|n| sites & Site::blue_to_alpha(n).0 != 0),
        sites,
    }
}

/// Finds what the stages of a texture shader read of one another, from the last stage to the first. Adds the channels
/// to `units`, and returns whose dot products are needed. The channels that a colour key compares count as read; a key
/// that drops fragments always compares (KEY-1).
fn shader_liveness(draw: &Draw, units: &mut [u8; TEXTURE_UNITS]) -> [bool; TEXTURE_UNITS] {
    let shader = &draw.texture_shader;
    let mut dots = [false; TEXTURE_UNITS];
    for index in (0..TEXTURE_UNITS).rev() {
        let stage = &shader[index];
        let keyed = draw.textures[index].filter(|unit| unit.color_key.is_some() && stage.operation.samples());
        if keyed.is_some_and(|unit| unit.kills() || units[index] != 0) {
            units[index] = RGB | ALPHA;
        }
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
                ShaderOperation::DotProduct3D => dots[index.saturating_sub(2)..index].fill(true),
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
