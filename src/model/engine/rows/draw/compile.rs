//! Compiles the draws of a plan to rows, and decodes their textures.

use crate::engine::TextureWords;
use crate::engine::rows::sampling::sampler::{self, Sampler};
use crate::engine::rows::sampling::table::{self, Key, Table};
use crate::engine::rows::shading::build;
use crate::engine::rows::shading::compiled::CompiledDraw;
use crate::engine::rows::shading::node::{Input, Node, Value};
use crate::engine::rows::shading::shader::{self, Shader};
use crate::plan::{Plan, PlannedDraw};
use crate::rop::surface;
use crate::state::TextureImage;
use crate::texture::planned::{Image, PlannedUnit};
use crate::texture::stage::PlannedShader;
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

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

    /// Returns whether the scalar engine draws a draw.
    pub(crate) fn is_scalar(&self, draw: usize) -> bool {
        self.draws[draw].is_scalar
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
    let mut is_scalar = samplers.is_none();
    let mut compiled = CompiledDraw { samplers: samplers.unwrap_or_default(), ..CompiledDraw::default() };
    emit(&built, draw, &mut compiled);
    if let Some(planned) = &draw.shader {
        begin_textures(planned, &mut compiled);
    }
    let textures = compiled.textures;
    compiled.samplers.retain(|sampler| textures[sampler.unit].iter().any(Option::is_some) || sampler.key.is_some());
    if draw.shader.is_some() && !is_scalar {
        let shader = Shader::new(draw, &compiled.samplers, plan.policies.dependent_scale);
        is_scalar = shader.is_none();
        compiled.shader = shader.map(Arc::new);
    }
    // Each stage of a texture shader has its own coordinates.
    let sharing = if draw.shader.is_none() { compiled.samplers.len() } else { 0 };
    for n in 1..sharing {
        let (earlier, later) = compiled.samplers.split_at_mut(n);
        later[0].shares = earlier.iter().position(|other| sampler::share(draw, other, &later[0]));
    }
    let kills = draw.kills();
    let samples = textures.iter().flatten().any(Option::is_some) || kills;
    compiled.is_scalar = (is_scalar && samples) || draw.assembly.scalar_part().is_some();
    compiled.takes_quads = compiled.samplers.iter().any(Sampler::takes_quads);
    compiled.drops_late = kills || draw.alpha_test.is_some() || draw.stencil_test.is_some();
    let tests_late = compiled.drops_late && (draw.depth_test.is_some() || draw.stencil_test.is_some());
    compiled.writes_whole = draw.write_mask == surface::write_mask(draw.surface, [true; 4]);
    compiled.merges = compiled.drops_late || draw.depth_test.is_some() || !compiled.writes_whole;
    compiled.reads_surface = tests_late || compiled.destination.iter().any(Option::is_some);
    compiled.read = [compiled.primary, compiled.secondary]
        .map(|slots| u32::from_le_bytes(slots.map(|slot| if slot.is_some() { 255 } else { 0 })));
    let weighs = compiled.shader.is_some() || compiled.fog.is_some() || !compiled.samplers.is_empty();
    compiled.interpolates = weighs || compiled.read != [0; 2] || draw.depth_test.is_some();
    compiled
}

/// Gives rows to the registers of a texture shader's stages, also to those that only later stages read.
fn begin_textures(planned: &PlannedShader, compiled: &mut CompiledDraw) {
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

/// Returns the samplers of a draw, or `None` if rows cannot sample all of its units or the tables do not pay.
fn samplers(plan: &Plan, draw: &PlannedDraw, tables: &mut Tables) -> Option<Vec<Sampler>> {
    let mut samplers = Vec::with_capacity(draw.units.len());
    for (index, unit) in draw.units.iter().enumerate() {
        let axes = table::axes(unit)?;
        let depends = draw.shader.is_some() && shader::is_dependent(&unit.stage.operation);
        let folds = draw.shader.is_none();
        let key = Key::from_unit(unit, folds);
        let known = tables.made.iter().find(|(other, _)| *other == key).map(|(_, table)| Arc::clone(table));
        if known.is_none() && !tables.pays(&key, unit, table::size(unit, &axes)) {
            return None;
        }
        let table = match (&plan.textures[unit.state.texture].image, known) {
            (_, Some(table)) => Some(table),
            (TextureImage::Texels(texels), None) => {
                let image = Image { words: &texels.words, memory: None };
                let table = Arc::new(Table::new(unit, &axes, &image, folds));
                tables.made.push((key, Arc::clone(&table)));
                Some(table)
            }
            (TextureImage::Target { .. } | TextureImage::Depth { .. }, None) => None,
        };
        let sampler = Sampler::new(draw, index, depends, table);
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
