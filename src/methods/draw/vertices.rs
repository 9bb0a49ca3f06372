//! The vertices of a draw: attributes from where the program put them, through the vertex program or the fixed-function pipe.
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule")]

use std::collections::HashMap;

use ninebit::number::convert::snap;
use ninebit::number::transform::{product, sum};
use ninebit::raster::assemble;
use ninebit::state::{
    ClipDepth, DepthFormat, Draw, PolygonMode, Positions, Vertex, VertexColor, VertexDepths, Vertices, Viewport,
};
use ninebit::vertex::fog;
use ninebit::vertex::point::eighths;

use super::view::View;
use crate::celsius;
use crate::class::{self, Family};
use crate::gap::Gap;
use crate::memory::Memory;
use crate::state::{Batch, State};
use crate::vertex::fixed::FixedFunction;
use crate::vertex::formats::ArrayFormat;
use crate::vertex::microcode::{CONSTANTS, Constants, Program, SLOTS};
use crate::vertex::{ATTRIBUTES, Attributes, DEFAULT, Outputs, attribute};

/// Fills in the vertices of a draw; returns whether there are any.
pub(crate) fn vertices_of(
    view: &mut View<'_>,
    memory: &Memory,
    batch: &Batch,
    depth: DepthFormat,
    draw: &mut Draw,
) -> bool {
    for (method, count) in &batch.dropped {
        view.note(Gap::Dropped(view.family(), *method, *count));
    }
    for method in &batch.open {
        view.note(Gap::NotModelled(view.family().label(*method)));
    }
    if batch.cut {
        view.note(Gap::TooMany("the draw has more vertices than a scene may have; the rest is left out".into()));
    }
    let stage = Stage::read(view);
    let (attributes, indices) = attributes_and_indices(view, memory, batch, &stage.reads());
    let mut transform = stage;
    let outputs: Vec<Outputs> = attributes.iter().map(|attributes| transform.run(attributes)).collect();
    let points = draw.topology == ninebit::state::Topology::Points;
    if points && view.enabled(class::SET_POINT_PARAMS_ENABLE) {
        draw.point_sizes = Some(outputs.iter().map(|output| eighths(output.point_size.into())).collect());
    }
    // The fixed-function pipe has seen to it.
    let specular = matches!(transform, Stage::Fixed(..)) || view.enabled(class::SET_SPECULAR_ENABLE);
    if view.get_or(class::SET_LIGHT_TWO_SIDE_ENABLE, 0) != 0 && draw.topology.has_faces() {
        view.note(Gap::NotModelled("colours of back faces".into()));
    }
    let (positions, places) = place(view, draw, &outputs, depth);
    if let (Positions::Clip(_), Some(test)) = (&positions, &mut draw.depth_test) {
        test.vertex_depths = VertexDepths::Fractions;
    }
    draw.positions = positions;
    let (fog, chip) = (draw.fog, view.family().profile());
    let vertex = |(output, position): (&Outputs, [f32; 4])| {
        let finite = |set: [f32; 4]| set.map(|number| if number.is_finite() { number } else { 0.0 });
        let color =
            |color: [f32; 4]| VertexColor::Floats(color.map(|c| if c.is_nan() { 0.0 } else { c.clamp(0.0, 1.0) }));
        let coordinate = (fog.enabled && fog.function.is_some()).then_some(output.fog);
        let passed = fog.function.map_or(1.0, |function| fog::passed(&function, chip, output.fog));
        Vertex {
            position,
            diffuse: color(output.diffuse),
            specular: if specular { color(output.specular) } else { VertexColor::Bytes([0; 4]) },
            fog: if fog.enabled { passed } else { 1.0 },
            fog_coordinate: coordinate,
            texture_coordinates: output.coordinates.map(finite),
        }
    };
    draw.vertices = outputs.iter().zip(places).map(vertex).collect::<Vertices>();
    // POL-1: flags count for edges alone.
    let edges = [draw.polygon_modes.front, draw.polygon_modes.back].contains(&PolygonMode::Line);
    if edges && batch.edge_flags.contains(&false) && batch.edge_flags.len() == draw.vertices.len() {
        draw.edge_flags = Some(batch.edge_flags.as_slice().into());
    }
    draw.indices = indices.into();
    !draw.indices.is_empty()
}

/// The transform that a draw uses.
enum Stage {
    Program(Box<(Program, Constants)>),
    Fixed(Box<FixedFunction>, Family),
    /// Vertices that are scaled and moved, but not transformed: Celsius has this in place of programs.
    Passed(ScaleAndOffset),
}

/// The scale and what is added.
type ScaleAndOffset = [[f32; 4]; 2];

impl Stage {
    fn read(view: &mut View<'_>) -> Stage {
        if view.family() == Family::Celsius && view.own(celsius::VIEW_MATRIX_ENABLE) & celsius::PASSES != 0 {
            return passed(view);
        }
        if view.get(class::SET_TRANSFORM_EXECUTION_MODE) & 3 == 2 {
            return Stage::Program(Box::new(program(view)));
        }
        let fixed = FixedFunction::read(view.family().profile(), &mut |method| view.word(method));
        for method in &fixed.missing {
            view.missing(*method);
        }
        for (method, _) in &fixed.unknown {
            view.bad(*method);
        }
        Stage::Fixed(Box::new(fixed), view.family())
    }

    /// Returns which attributes it reads.
    fn reads(&self) -> [bool; ATTRIBUTES] {
        match self {
            Stage::Program(program) => program.0.inputs(),
            Stage::Fixed(fixed, _) => fixed.inputs(),
            Stage::Passed(_) => std::array::from_fn(|n| n == attribute::POSITION || n == attribute::DIFFUSE),
        }
    }

    fn run(&mut self, attributes: &Attributes) -> Outputs {
        match self {
            Stage::Program(program) => {
                let (program, constants) = &mut **program;
                program.run(constants, attributes)
            }
            Stage::Fixed(fixed, family) => {
                let mut outputs = fixed.run(attributes);
                if *family == Family::Celsius {
                    outputs.position = in_window(outputs.position);
                }
                outputs
            }
            Stage::Passed([scale, offset]) => {
                let [x, y, z, inverse] = std::array::from_fn(|n| {
                    let scaled = product(attributes[attribute::POSITION][n].to_bits(), scale[n].to_bits());
                    f32::from_bits(sum([scaled, offset[n].to_bits()]))
                });
                let zero = [0.0; 4];
                Outputs {
                    position: in_window([x, y, z, 1.0 / inverse]),
                    diffuse: attributes[attribute::DIFFUSE],
                    specular: attributes[attribute::SPECULAR],
                    back_diffuse: zero,
                    back_specular: zero,
                    fog: 0.0,
                    point_size: 0.0,
                    coordinates: std::array::from_fn(|set| attributes[attribute::TEXTURE + set]),
                }
            }
        }
    }
}

/// Moves a position of Celsius into the window. The class cuts sixteenths towards its own origin (envytools' model of NV10).
fn in_window([x, y, z, w]: [f32; 4]) -> [f32; 4] {
    let moved = |c: f32| if c.abs() < 2.0 * celsius::ORIGIN { snap(c) as f32 / 16.0 } else { c } + celsius::ORIGIN;
    [moved(x), moved(y), z, w]
}

/// Reads how vertices pass that are not transformed, and notes what the model does not have of it.
fn passed(view: &mut View<'_>) -> Stage {
    if view.enabled(class::SET_FOG_ENABLE) {
        view.note(Gap::NotModelled("fog of vertices that are not transformed".into()));
    }
    let divided = view.own(celsius::VIEW_MATRIX_ENABLE) & celsius::DIVIDES;
    for unit in 0..2 {
        if view.get(class::SET_SHADER_STAGE_PROGRAM) >> (5 * unit) & 0x1f != 0 && divided >> (unit + 1) & 1 == 0 {
            view.note(Gap::NotModelled(format!("coordinates of unit {unit} that are not divided by w")));
        }
    }
    let mut row = |first: u32| [0, 1, 2, 3].map(|n| f32::from_bits(view.own(first + 4 * n)));
    Stage::Passed([row(celsius::PASSED_SCALE), row(celsius::PASSED_SCALE + 16)])
}

/// Reads the vertex program with its constants, and notes what the log never set of them.
fn program(view: &mut View<'_>) -> (Program, Constants) {
    let state: &State = view.state();
    let start = state.get(class::SET_TRANSFORM_PROGRAM_START);
    let slots: Vec<[u32; 4]> =
        (0..SLOTS).map(|slot| [0, 1, 2, 3].map(|word| state.program(slot, word).unwrap_or(0))).collect();
    let start = start.unwrap_or(0) as usize;
    let program = Program::decode(&slots, start);
    let constants: Constants = std::array::from_fn(|n| state.constant(n).unwrap_or([0.0; 4]));
    view.get(class::SET_TRANSFORM_PROGRAM_START);
    let used = start..start + program.instructions().len();
    let known_slot = |slot: usize| (0..4).all(|word| view.state().program(slot, word).is_some());
    let slots = ranges(used.filter(|slot| !known_slot(*slot)));
    let (read, by_address) = program.constants();
    let missing = (0..CONSTANTS).filter(|n| read[*n] && view.state().constant(*n).is_none());
    let constants_missing = ranges(missing);
    if !program.is_complete() {
        view.note(Gap::NotModelled("a vertex program without an end".into()));
    }
    if by_address && (0..CONSTANTS).any(|n| view.state().constant(n).is_none()) {
        view.note(Gap::NotModelled("constants read by an address, some of which were never set".into()));
    }
    for (first, last) in slots {
        view.note(Gap::UnsetProgram("slot", first, last));
    }
    for (first, last) in constants_missing {
        view.note(Gap::UnsetProgram("constant", first, last));
    }
    (program, constants)
}

/// Joins numbers in order to ranges of neighbours.
fn ranges(numbers: impl Iterator<Item = usize>) -> Vec<(u32, u32)> {
    let mut ranges: Vec<(u32, u32)> = Vec::new();
    for number in numbers {
        let number = number as u32;
        match ranges.last_mut() {
            Some((_, last)) if *last + 1 == number => *last = number,
            _ => ranges.push((number, number)),
        }
    }
    ranges
}

/// Returns the attributes of the vertices, and the indices that the primitives have.
fn attributes_and_indices(
    view: &mut View<'_>,
    memory: &Memory,
    batch: &Batch,
    reads: &[bool; ATTRIBUTES],
) -> (Vec<Attributes>, Vec<u32>) {
    if !batch.immediate.is_empty() {
        current(view, reads);
        return (batch.immediate.clone(), (0..batch.immediate.len() as u32).collect());
    }
    if !batch.inline.is_empty() {
        return inline(view, batch, reads);
    }
    if batch.indices.is_empty() {
        return (Vec::new(), Vec::new());
    }
    let arrays = arrays(view);
    let own = current_of_others(view, &arrays, reads);
    let mut places: HashMap<u32, u32> = HashMap::new();
    let mut vertices = Vec::new();
    let mut indices = Vec::with_capacity(batch.indices.len());
    let mut lost = None;
    for index in &batch.indices {
        let place = *places.entry(*index).or_insert_with(|| {
            let mut attributes = own;
            for (attribute, array) in arrays.iter().enumerate() {
                let Some((address, format)) = array else { continue };
                let at = u64::from(*address) + u64::from(format.stride) * u64::from(*index);
                match memory.slice(at, format.bytes() as u64).and_then(|bytes| format.value(bytes)) {
                    Some(value) => attributes[attribute] = value,
                    None => lost = lost.or(Some((attribute, at))),
                }
            }
            vertices.push(attributes);
            vertices.len() as u32 - 1
        });
        indices.push(place);
    }
    if let Some((attribute, address)) = lost {
        let what = format!("vertex array {attribute}");
        view.note(if memory.is_empty() { Gap::NoMemory(what, address) } else { Gap::OutsideMemory(what, address) });
        if attribute == 0 {
            // Nothing says where the vertices are.
            return (Vec::new(), Vec::new());
        }
    }
    (vertices, indices)
}

/// Reads addresses and formats of the vertex arrays.
fn arrays(view: &mut View<'_>) -> [Option<(u32, ArrayFormat)>; ATTRIBUTES] {
    std::array::from_fn(|attribute| {
        let method = class::SET_VERTEX_DATA_ARRAY_FORMAT + 4 * attribute as u32;
        let format = match ArrayFormat::read(view.get(method)) {
            Ok(format) => format?,
            Err(_) => {
                view.bad(method);
                return None;
            }
        };
        let address = view.get(class::SET_VERTEX_DATA_ARRAY_OFFSET + 4 * attribute as u32);
        Some((address & 0x7fff_ffff, format))
    })
}

/// Returns the current attributes, and notes those that are read and were never set.
fn current(view: &mut View<'_>, reads: &[bool; ATTRIBUTES]) -> Attributes {
    current_of_others(view, &[None; ATTRIBUTES], reads)
}

fn current_of_others(
    view: &mut View<'_>,
    arrays: &[Option<(u32, ArrayFormat)>; ATTRIBUTES],
    reads: &[bool; ATTRIBUTES],
) -> Attributes {
    let missing = (0..ATTRIBUTES).filter(|n| reads[*n] && arrays[*n].is_none() && !view.state().knows_attribute(*n));
    for (first, last) in ranges(missing) {
        view.note(Gap::UnsetProgram("attribute", first, last));
    }
    view.state().attributes
}

/// Reads vertices that lie among the words of the log.
fn inline(view: &mut View<'_>, batch: &Batch, reads: &[bool; ATTRIBUTES]) -> (Vec<Attributes>, Vec<u32>) {
    let arrays = arrays(view);
    let own = current_of_others(view, &arrays, reads);
    let mut offsets = [0; ATTRIBUTES];
    let mut size = 0_usize;
    let order = match view.family() {
        Family::Kelvin => &std::array::from_fn::<usize, ATTRIBUTES, _>(|n| n)[..],
        Family::Celsius => &celsius::ARRAY_ORDER,
    };
    for attribute in order {
        if let Some((_, format)) = arrays[*attribute] {
            offsets[*attribute] = size.next_multiple_of(format.number.bytes());
            size = offsets[*attribute] + format.bytes();
        }
    }
    let size = size.next_multiple_of(4);
    let bytes: Vec<u8> = batch.inline.iter().flat_map(|word| word.to_le_bytes()).collect();
    if size == 0 {
        view.note(Gap::NotModelled("inline vertices without an array's format".into()));
        return (Vec::new(), Vec::new());
    }
    if !bytes.len().is_multiple_of(size) {
        view.note(Gap::NotModelled(format!("{} bytes of inline vertices, which have {size} each", bytes.len())));
    }
    let vertices = bytes.chunks_exact(size).map(|vertex| {
        let mut attributes = own;
        for ((attribute, array), offset) in attributes.iter_mut().zip(&arrays).zip(offsets) {
            if let Some((_, format)) = array {
                *attribute = format.value(&vertex[offset..]).unwrap_or(DEFAULT);
            }
        }
        attributes
    });
    let vertices: Vec<Attributes> = vertices.collect();
    let count = vertices.len() as u32;
    (vertices, (0..count).collect())
}

/// Returns how the positions of a draw are stated. Window positions are, unless a vertex lies where the rasteriser's model ends: then the draw is clipped,
/// which the chip does not do.
fn place(view: &mut View<'_>, draw: &Draw, outputs: &[Outputs], depth: DepthFormat) -> (Positions, Vec<[f32; 4]>) {
    // RAS-8 counts no larger w, and a scene has finite ones.
    let window: Vec<[f32; 4]> = outputs.iter().map(|output| assemble::limit_w(output.position)).collect();
    let draw = Draw { positions: Positions::Window, ..draw.clone() };
    if window.iter().all(|position| assemble::takes_position(&draw, *position)) {
        return (Positions::Window, window);
    }
    // x' = x + (X/w + 1) width/2 with a width of 2 and x = -1; y points down.
    let viewport = Viewport {
        x: -1.0,
        y: -1.0,
        width: 2.0,
        height: 2.0,
        near: 0.0,
        far: 1.0,
        clip_depth: ClipDepth::MinusOneToOne,
        depth_clamp: true,
    };
    let steps = if depth.is_float() { 1.0 } else { depth.largest() as f32 };
    let clip = |position: [f32; 4]| {
        let [x, y, z, w] = position;
        let ndc = [x, -y, 2.0 * (z / steps) - 1.0, 1.0];
        let clip = ndc.map(|n| n * w);
        if clip.iter().all(|n| n.is_finite()) { clip } else { [0.0, 0.0, 0.0, -1.0] }
    };
    view.note(Gap::NotModelled(
        "vertices too far outside, or of figures that are not filled behind the viewer, which are clipped here".into(),
    ));
    (Positions::Clip(viewport), outputs.iter().map(|output| clip(output.position)).collect())
}
