//! The fast engine evaluates up to 384 pixels at a time: every combiner register becomes a row of 384 16-bit numbers.
//!
//! | file | knows |
//! |---|---|
//! | `node.rs`, `graph.rs`, `build.rs` | what a draw computes: values with their ranges, from the planned state |
//! | `compiled.rs` | a draw compiled to rows, and its samplers |
//! | `kernels.rs` | the rules as loops over rows |
//! | `planes.rs`, `quotient.rs`, `setup.rs` | linear functions across a triangle and a batch of its pixels, and their quotients: estimated, proved, corrected |
//! | `direction.rs`, `depth.rs`, `reciprocal.rs`, `fog.rs`, `color.rs` | interpolators of one kind of number each |
//! | `triangle.rs` | everything that varies, for a batch |
//! | `definition.rs` | what the definition computes in place of estimates |
//! | `short.rs` | what weights that fall short take off coordinates that are divided by q, moved or, by policy, on planes |
//! | `third.rs` | layers of volumes, depths to compare with |
//! | `shapes.rs`, `small.rs`, `ratios.rs`, `box_depths.rs`, `box_levels.rs` | the same for boxes of small triangles, eight at a time: corners, spans and what functions share; coordinates on planes and weights; coordinates by q, numbers, depths to compare with; depths; level 0 of textures with levels |
//! | `dda.rs` | rows with one denominator: quotients by steps, exact |
//! | `table.rs`, `fetch.rs`, `filter.rs` | textures laid out for rows; address, fetch; filter |
//! | `base_level.rs`, `quads.rs`, `lods.rs`, `levels.rs`, `taps.rs` | level 0 around a batch; coordinates at quads; their lods; levels of pixels; the taps of anisotropy |
//! | `shader.rs`, `stages.rs`, `dot.rs` | texture shaders, compiled; run stage by stage; the dot unit in single precision |
//! | `moved.rs` | coordinates that bump stages move |
//! | `dependent.rs` | levels of detail of dependent reads, from the lanes of quads |
//! | `store.rs` | surfaces: what blending reads, the tests, the store |
//! | `boxes.rs`, `draw.rs`, `band.rs` | triangles to boxes and batches; batches to blocks; blocks to the surface |
//! | `isa.rs` | the same text for several instruction sets |
//!
//! The bytes are the scalar engine's: a rule is the same text in both, and what is computed otherwise (quotients) is proved to be the same
//! integer. What rows do not cover is computed by the definition, pixel by pixel, within the same blocks.

mod band;
mod base_level;
mod box_depths;
mod box_levels;
mod boxes;
mod build;
mod color;
mod compiled;
mod dda;
mod definition;
mod dependent;
mod depth;
mod depth_words;
mod direction;
mod dot;
mod draw;
#[cfg(test)]
mod equivalence_tests;
mod fetch;
mod filter;
mod fog;
mod graph;
mod isa;
mod job;
mod kernels;
#[cfg(test)]
#[path = "../../../../tests/common/lattice.rs"]
mod lattice;
mod levels;
#[cfg(test)]
mod limit_tests;
mod lods;
mod moved;
mod node;
mod planes;
mod quads;
mod quotient;
mod ratios;
mod reciprocal;
mod setup;
mod shader;
#[cfg(test)]
mod shader_tests;
mod shapes;
#[cfg(test)]
mod share_tests;
mod short;
mod small;
mod stages;
mod store;
mod table;
mod taps;
mod third;
mod triangle;

pub(crate) use band::Block;
pub use compiled::Reason;
pub(crate) use compiled::{CompiledDraw, Reasons, Sampler};
pub(crate) use draw::run;
pub use isa::Isa;
pub(crate) use isa::Kernels;
pub(crate) use job::Job;
pub(crate) use kernels::BLOCK;

use crate::engine::TextureWords;
use crate::plan::{Plan, PlannedDraw};
use crate::rop::surface;
use crate::state::{Filter, MipFilter, TextureImage, TextureKind};
use crate::texture::planned::{Image, PlannedUnit};
use node::{Input, Node, Value};
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;
use table::{Key, Table};

/// Number of spare rows, for channels that nobody reads: one for each channel of a texel.
const SPARE: usize = 4;

/// Largest number of entries of all tables, each of four bytes, or of eight where footprints are read.
const MAX_ENTRIES: u64 = 1 << 25;

/// A plan compiled to rows.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    draws: Vec<CompiledDraw>,
}

impl Rows {
    /// Compiles every draw.
    pub(crate) fn compile(plan: &Plan) -> Rows {
        let mut tables = Tables::default();
        for draw in &plan.draws {
            tables.want(draw);
        }
        Rows { draws: plan.draws.iter().map(|draw| compile(plan, draw, &mut tables)).collect() }
    }

    /// Returns some draws, with the tables of images that earlier draws made. Their words are in `words`.
    pub(crate) fn draws(
        &self,
        plan: &Plan,
        draws: Range<usize>,
        words: &TextureWords<'_>,
    ) -> Vec<Cow<'_, CompiledDraw>> {
        let mut made: Vec<(Key, Arc<Table>)> = Vec::new();
        let mut draw = |index: usize| {
            let compiled = &self.draws[index];
            if compiled.samplers.iter().all(|sampler| sampler.table.is_some()) {
                return Cow::Borrowed(compiled);
            }
            let mut compiled = compiled.clone();
            for sampler in compiled.samplers.iter_mut().filter(|sampler| sampler.table.is_none()) {
                let unit = &plan.draws[index].units[sampler.index];
                let key = Key::from_unit(unit, false);
                sampler.table = made.iter().find(|(other, _)| *other == key).map(|(_, table)| Arc::clone(table));
                if let (None, Some(axes)) = (&sampler.table, table::axes(unit)) {
                    let image = Image { words: words.words(unit.state.texture), memory: None };
                    let table = Arc::new(Table::new(unit, &axes, &image, false));
                    made.push((key, Arc::clone(&table)));
                    sampler.table = Some(table);
                }
            }
            Cow::Owned(compiled)
        };
        draws.map(&mut draw).collect()
    }
}

/// Estimates the number of pixels that a draw covers: at most its window for each triangle.
fn pixels(draw: &PlannedDraw) -> u64 {
    let window = draw.windows.iter().map(|window| u64::from(window.width) * u64::from(window.height)).sum::<u64>();
    (0..draw.assembly.triangles.len()).map(|number| draw.assembly.area(number).min(window)).sum()
}

/// Tables of textures, shared by draws.
#[derive(Default)]
struct Tables {
    /// Estimated number of pixels of the draws that read each table.
    wanted: Vec<(Key, u64)>,
    made: Vec<(Key, Arc<Table>)>,
}

impl Tables {
    /// Adds the pixels of a draw.
    fn want(&mut self, draw: &PlannedDraw) {
        let pixels = pixels(draw);
        for unit in &draw.units {
            let key = Key::from_unit(unit, draw.shader.is_none());
            match self.wanted.iter_mut().find(|(other, _)| *other == key) {
                Some((_, all)) => *all += pixels,
                None => self.wanted.push((key, pixels)),
            }
        }
    }

    /// Returns whether a unit's new table of some size costs less than sampling by the definition, and fits into memory.
    fn pays(&self, key: &Key, unit: &PlannedUnit, size: u64) -> bool {
        let pixels = self.wanted.iter().find(|(other, _)| other == key).map_or(0, |(_, pixels)| *pixels);
        let held: u64 = self.made.iter().map(|(_, table)| table.entries()).sum();
        size <= table::texels_per_pixel(unit) * pixels && size + held <= MAX_ENTRIES
    }
}

fn compile(plan: &Plan, draw: &PlannedDraw, tables: &mut Tables) -> CompiledDraw {
    let samplers = samplers(plan, draw, tables);
    // In a texture shader, texels alone do not tell what a later stage reads of an earlier one.
    let built = build::build(draw, plan.policies, samplers.as_deref().filter(|_| draw.shader.is_none()));
    let mut samples_pixels = samplers.is_none();
    let samplers = samplers.unwrap_or_default();
    let mut compiled = CompiledDraw { samplers, ..CompiledDraw::default() };
    emit(&built, draw, &mut compiled);
    if let Some(planned) = &draw.shader {
        for (slots, stage) in compiled.textures.iter_mut().zip(&planned.stages) {
            for (slot, value) in slots.iter_mut().zip(shader::initial(stage)) {
                let Some(value) = value else { continue };
                match slot {
                    Some(row) => compiled.rows[usize::from(*row)] = Some(value),
                    None => {
                        *slot = Some(compiled.rows.len() as u16);
                        compiled.rows.push(Some(value));
                    }
                }
            }
        }
    }
    let textures = compiled.textures;
    compiled.samplers.retain(|sampler| textures[sampler.unit].iter().any(Option::is_some) || sampler.key.is_some());
    if draw.shader.is_some() && !samples_pixels {
        let shader = shader::Shader::new(draw, &compiled.samplers, plan.policies.dependent_scale);
        samples_pixels = shader.is_none();
        if samples_pixels {
            compiled.samplers.clear();
        }
        compiled.completes_quads = compiled.samplers.iter().any(|sampler| sampler.depends && sampler.mixes);
        compiled.shader = shader.map(Arc::new);
    }
    // Each stage of a texture shader has its own coordinates.
    let sharing = if draw.shader.is_none() { compiled.samplers.len() } else { 0 };
    for n in 1..sharing {
        let (earlier, later) = compiled.samplers.split_at_mut(n);
        later[0].shares = earlier.iter().position(|other| share(draw, other, &later[0]));
    }
    let kills = draw.kills();
    compiled.drops_late = kills || draw.alpha_test.is_some() || draw.stencil_test.is_some();
    let tests_late = compiled.drops_late && (draw.depth_test.is_some() || draw.stencil_test.is_some());
    compiled.writes_whole = draw.write_mask == surface::write_mask(draw.surface, [true; 4]);
    compiled.merges = compiled.drops_late || draw.depth_test.is_some() || !compiled.writes_whole;
    compiled.reads_surface = tests_late || compiled.destination.iter().any(Option::is_some);
    let samples = compiled.textures.iter().flatten().any(Option::is_some) || kills;
    compiled.samples_pixels = samples_pixels && samples;
    compiled.estimates = compiled.samplers.iter().any(|sampler| sampler.pairs > 0 || sampler.third.is_some());
    compiled.plain = compiled.samplers.iter().all(|sampler| sampler.depends || sampler.is_plain())
        && !compiled.samples_pixels
        && !compiled.completes_quads;
    let are_floored = box_depths::are_floored(draw) && !compiled.completes_quads;
    compiled.depths_together = draw.depth_test.is_some() && are_floored;
    compiled.together = are_floored && (compiled.shader.is_none() || compiled.of_numbers().is_some());
    compiled.read = [compiled.primary, compiled.secondary]
        .map(|slots| u32::from_le_bytes(slots.map(|slot| if slot.is_some() { 255 } else { 0 })));
    compiled
}

/// Returns whether two samplers have the same coordinates at all vertices, and so everywhere.
fn share(draw: &PlannedDraw, one: &Sampler, other: &Sampler) -> bool {
    let [a, b] = [one, other].map(|sampler| &draw.units[sampler.index]);
    let [first, second] = [a, b].map(|unit| unit.stage.coordinate_set);
    !(one.has_images() || other.has_images() || one.depends || other.depends)
        && (one.filters, one.mixes) == (other.filters, other.mixes)
        && (!one.mixes || selection(a) == selection(b))
        && one.pairs + other.pairs == 0
        && (a.kind, a.levels[0]) == (b.kind, b.levels[0])
        && a.state.cylindrical_wrap == b.state.cylindrical_wrap
        // Coordinates are limited in place, so the axes have to be equal.
        && table::axes(a) == table::axes(b)
        && draw.assembly.vertices.same_coordinates(first, second)
}

/// Returns all that decides, beside coordinates, which levels a unit reads and where.
fn selection(unit: &PlannedUnit) -> (Filter, MipFilter, [i32; 3]) {
    let state = &unit.state;
    (state.min_filter, state.mip_filter, [state.lod_bias, state.min_lod, state.max_lod])
}

/// Returns the samplers of a draw, or `None` if rows cannot sample all of its units or the tables do not pay.
fn samplers(plan: &Plan, draw: &PlannedDraw, tables: &mut Tables) -> Option<Vec<Sampler>> {
    let mut samplers = Vec::with_capacity(draw.units.len());
    for (index, unit) in draw.units.iter().enumerate() {
        let axes = table::axes(unit)?;
        let key = unit.state.color_key.filter(|_| unit.state.kills()).map(|key| table::entry_of_key(unit, &key));
        let depends = draw.shader.is_some() && shader::is_dependent(&unit.stage.operation);
        let folds = draw.shader.is_none();
        let table_key = Key::from_unit(unit, folds);
        let texture = &plan.textures[unit.state.texture];
        let known = tables.made.iter().find(|(other, _)| *other == table_key).map(|(_, table)| Arc::clone(table));
        if known.is_none() && !tables.pays(&table_key, unit, table::size(unit, &axes)) {
            return None;
        }
        let table = match (&texture.image, known) {
            (_, Some(table)) => Some(table),
            (TextureImage::Texels(texels), None) => {
                let image = Image { words: &texels.words, memory: None };
                let table = Arc::new(Table::new(unit, &axes, &image, folds));
                tables.made.push((table_key, Arc::clone(&table)));
                Some(table)
            }
            (TextureImage::Target { .. } | TextureImage::Depth { .. }, None) => None,
        };
        let sides = unit.scale(&unit.levels[0]);
        let mut sampler = Sampler {
            index,
            unit: unit.index,
            filters: unit.state.mag_filter == Filter::Linear,
            cube: unit.kind == TextureKind::Cube,
            sides,
            up: [0, 1].map(|axis| {
                let same = draw.assembly.vertices.same_coordinate(unit.stage.coordinate_set, axis);
                planes::up(same, sides[axis])
            }),
            signed: [0, 1, 2, 3].map(|n| crate::texture::chain::holds_double(unit, n)),
            mixes: unit.needs_lod(),
            key,
            depends,
            pairs: unit.state.anisotropy as usize / 2,
            third: None,
            shares: None,
            table,
        };
        sampler.third = third::purpose(unit, &sampler);
        // Dependent reads have no r.
        if depends && sampler.third.is_some() {
            return None;
        }
        samplers.push(sampler);
    }
    Some(samplers)
}

/// Emits the rows that the surface depends on, in order, and no others.
fn emit(built: &build::Built, draw: &PlannedDraw, compiled: &mut CompiledDraw) {
    let wanted = |channel: usize| draw.written >> channel & 1 != 0;
    let mut outputs: Vec<Value> = (0..4).filter(|c| wanted(*c)).map(|c| built.stored[c]).collect();
    if draw.alpha_test.is_some() {
        outputs.push(built.alpha);
    }
    let count = outputs.iter().map(|v| usize::from(v.0) + 1).max().unwrap_or(0);
    let mut reached = vec![false; count];
    for value in &outputs {
        reached[usize::from(value.0)] = true;
    }
    for n in (0..count).rev() {
        if reached[n] {
            // All of them are earlier.
            for operand in built.graph.node(Value(n as u16)).operands() {
                reached[usize::from(operand.0)] = true;
            }
        }
    }
    // The first rows are the spare ones.
    compiled.rows.resize(SPARE, None);
    let mut row_of = vec![0_u16; count];
    for n in (0..count).filter(|n| reached[*n]) {
        let row = compiled.rows.len() as u16;
        row_of[n] = row;
        let node = built.graph.node(Value(n as u16));
        compiled.rows.push(match node {
            Node::Constant(value) => Some(value),
            // Lanes without a pixel hold what a lane with one may hold.
            Node::Input(_) => Some(0),
            _ => None,
        });
        match node {
            Node::Constant(_) => {}
            Node::Input(Input::Primary(channel)) => compiled.primary[channel] = Some(row),
            Node::Input(Input::Secondary(channel)) => compiled.secondary[channel] = Some(row),
            Node::Input(Input::Fog) => compiled.fog = Some(row),
            Node::Input(Input::Texture(unit, channel)) => compiled.textures[unit][channel] = Some(row),
            Node::Input(Input::Destination(channel)) => compiled.destination[channel] = Some(row),
            node => {
                let operation = node.renamed(|v| Value(row_of[usize::from(v.0)]));
                compiled.operations.push((operation, usize::from(row)));
            }
        }
    }
    for channel in (0..4).filter(|c| wanted(*c)) {
        compiled.stored[channel] = row_of[usize::from(built.stored[channel].0)];
    }
    if draw.alpha_test.is_some() {
        compiled.alpha = row_of[usize::from(built.alpha.0)];
    }
}
