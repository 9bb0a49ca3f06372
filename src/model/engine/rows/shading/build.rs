//! Builds the graph of a planned draw: the inputs of a pixel, then the order of the rules. The kernels do the arithmetic.

use super::graph::Graph;
use super::node::{Input, Value};
use crate::algebra::Algebra;
use crate::combiner::registers::Registers;
use crate::combiner::{final_combiner, general};
use crate::engine::rows::sampling::sampler::Sampler;
use crate::engine::rows::sampling::table::{Channel, Table};
use crate::number::Lane;
use crate::plan::PlannedDraw;
use crate::raster::assemble::Corner;
use crate::rop::{blend, surface};
use crate::state::{Policies, Register};
use crate::texture::chain::holds_double;
use crate::texture::planned::PlannedUnit;

/// The graph of a draw's pixels.
pub(crate) struct Built {
    /// All values that are computed.
    pub(crate) graph: Graph,
    /// Alpha of the fragment before blending, for the alpha test.
    pub(crate) alpha: Value,
    /// Stored R, G, B and A, each 0..=255.
    pub(crate) stored: [Value; 4],
}

/// Builds the graph of a draw. `samplers` are `None` if the units are sampled pixel by pixel.
pub(crate) fn build(draw: &PlannedDraw, policies: Policies, samplers: Option<&[Sampler]>) -> Built {
    let mut graph = Graph::new(policies);
    let mut registers = inputs(draw, samplers, &mut graph);
    for stage in &draw.stages {
        general::stage(stage, draw.mux_select, &mut registers, &mut graph);
    }
    let state = &draw.final_combiner.state;
    general::load_constants(state.constants, &mut registers, &mut graph);
    let fragment = final_combiner::evaluate(state, &registers, &mut graph).fragment;
    let blended = match &draw.blend {
        None => fragment,
        Some(state) => {
            let source = blend::truncated(draw.surface, fragment, &mut graph);
            let destination = destination(draw, &mut graph);
            let constant = draw.blend_constant.map(|byte| graph.byte(byte));
            blend::blend(state, draw.blended, &constant, &source, &destination, &mut graph)
        }
    };
    let stored = blended.map(|v| graph.clamped(v));
    Built { graph, alpha: fragment[3], stored }
}

/// Returns the destination colour as blending reads it: alpha is 255 if the surface stores none.
fn destination(draw: &PlannedDraw, graph: &mut Graph) -> [Value; 4] {
    [0, 1, 2, 3].map(|channel: usize| {
        if channel == 3 && surface::kept_channels(draw.surface) & 8 == 0 {
            graph.constant(255)
        } else {
            graph.input(Input::Destination(channel), (0, 255))
        }
    })
}

/// Returns the registers before the first stage (CMB-13).
fn inputs(draw: &PlannedDraw, samplers: Option<&[Sampler]>, graph: &mut Graph) -> Registers<Value> {
    let zero = graph.constant(0);
    let mut file = Registers::from_value(zero);
    let registers = &mut file.values;
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
        registers[register as usize] = match (unit, sampler.and_then(|sampler| sampler.table.as_ref())) {
            (Some(unit), Some(table)) => texture(unit, table, graph),
            _ if draw.shader.is_some() || unit.is_some() => {
                let signed = |channel: usize| unit.is_some_and(|unit| holds_double(unit, channel));
                [0, 1, 2, 3].map(|channel| graph.input(Input::Texture(n, channel), range(signed(channel))))
            }
            _ => registers[register as usize],
        };
    }
    for register in (0..UNITS.len()).filter(|n| draw.yuv[*n]).map(|n| UNITS[n] as usize) {
        let [y, cb, cr, alpha] = registers[register];
        let [r, g, b] = graph.converted([y, cb, cr]);
        registers[register] = [r, g, b, alpha];
    }
    if draw.spare0_alpha {
        registers[Register::Spare0 as usize][3] = registers[Register::Texture0 as usize][3];
    }
    file
}

/// Returns an interpolated colour. Channels that are equal at all vertices share a value, and channels that do not vary are constants.
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

/// Returns the texel of a unit. Channels that are equal in all texels share a value, and channels that do not vary are constants.
fn texture(unit: &PlannedUnit, table: &Table, graph: &mut Graph) -> [Value; 4] {
    let signed = |channel: usize| holds_double(unit, channel);
    [0, 1, 2, 3].map(|channel: usize| match table.channels[channel] {
        Channel::Constant(byte) if signed(channel) => graph.constant((i32::from(byte) - 128).signed_texel() as i16),
        Channel::Constant(byte) => graph.constant(i16::from(byte)),
        Channel::Of(other) => graph.input(Input::Texture(unit.index, other), range(signed(other))),
    })
}

/// Returns the range of a channel of a texture register.
fn range(signed: bool) -> (i16, i16) {
    if signed { (-256, 254) } else { (0, 255) }
}
