//! Draws a plan on a GPU.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::PoisonError;

use ninebit::engine::{TextureWords, cleared};
use ninebit::frame::Frames;
use ninebit::plan::{Plan, PlanOptions, PlannedDraw};
use ninebit::state::{Scene, TextureImage};
use ninebit_lower::{Field, Function, Generic, Options, Setup, with_all_levels};
use ninebit_methods::export::draw_words;
use wgpu::BufferUsages;

use crate::adapter::{DISPATCH_ROW, Gpu, Pipelines};
use crate::bins::{Bins, Tiles, sorted};
use crate::failure::Failure;
use crate::text::{WORK, Way, fields, generic_shader, length, shader};

/// Tiles of all triangles of a scene, each triangle's counted for itself.
const TILES: usize = 1 << 25;

/// Up to so many triangles of a draw are dispatched one by one if they are large.
const FEW: usize = 64;

/// A triangle is large if it has so many tiles.
const LARGE: usize = 16;

/// A target in the memory of the GPU.
#[derive(Debug)]
struct Target {
    /// Words and depths, the latter zeros without a depth buffer.
    held: [wgpu::Buffer; 2],
    /// What they hold before the first draw.
    cleared: [wgpu::Buffer; 2],
}

/// What a unit reads of a target.
#[derive(Debug)]
struct TargetSource {
    unit: usize,
    target: usize,
    is_depth: bool,
    /// Whether a texel is a word of the target as it is.
    is_same: bool,
    /// First byte in the memory of the draw's units.
    at: u64,
}

/// The memory of a draw's units.
#[derive(Debug, Default)]
struct Memory {
    /// One word for each texel.
    words: Vec<u32>,
    /// The first word of each unit.
    bases: [u32; 4],
    /// Units that read targets.
    sampled: Vec<TargetSource>,
}

/// What all triangles of a draw share.
struct DrawResources<'d> {
    number: usize,
    draw: &'d PlannedDraw,
    way: Way,
    /// Words of a triangle's constants.
    length: usize,
    memory: wgpu::Buffer,
    bases: [u32; 4],
    /// The state, which the text for every draw reads.
    state: Option<wgpu::Buffer>,
}

/// Triangles that are dispatched together.
#[derive(Debug)]
struct Batch {
    group: wgpu::BindGroup,
    dispatches: Vec<Dispatch>,
}

/// Some tiles.
#[derive(Debug)]
struct Dispatch {
    /// First byte of the uniform words.
    offset: u32,
    /// Number of tiles.
    tiles: u32,
    /// Whether the triangle covers all their pixels.
    is_full: bool,
}

/// The work of a draw.
#[derive(Debug)]
struct Work {
    /// Number of the draw.
    draw: usize,
    pipelines: Pipelines,
    memory: wgpu::Buffer,
    sampled: Vec<TargetSource>,
    batches: Vec<Batch>,
}

/// A plan that is ready to be drawn on a GPU, any number of times.
#[derive(Debug)]
pub struct Renderer<'a> {
    gpu: &'a Gpu,
    plan: &'a Plan,
    cleared: Frames,
    targets: Vec<Target>,
    works: Vec<Work>,
}

/// By which text draws are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Text {
    /// Each by its own.
    OfDraw,
    /// All by one, which reads the state of each as words.
    OfEveryDraw,
}

impl Text {
    /// Returns the plan by which it draws a scene, of a plan of that scene: the text for every draw needs one that leaves out nothing.
    ///
    /// # Errors
    /// Those of planning.
    pub fn plan<'p>(self, scene: &Scene, plan: &'p Plan) -> Result<Cow<'p, Plan>, Failure> {
        if self == Text::OfDraw {
            return Ok(Cow::Borrowed(plan));
        }
        Ok(Cow::Owned(Plan::compile(scene, &PlanOptions { policies: plan.policies, prune: false })?))
    }
}

/// Makes the works of draws.
struct Builder<'a> {
    gpu: &'a Gpu,
    scene: &'a Scene,
    plan: &'a Plan,
    cleared: &'a Frames,
    targets: &'a [Target],
    layout: wgpu::BindGroupLayout,
    pipelines: HashMap<String, Pipelines>,
    /// Number of tiles that triangles of further draws may have.
    tiles: usize,
}

impl<'a> Renderer<'a> {
    /// Prints the shaders of a scene's draws, compiles them and fills buffers.
    ///
    /// # Errors
    /// Limits of the adapter; what its driver says; what the scalar engine alone draws; state that no words set, if they are read.
    pub fn new(gpu: &'a Gpu, scene: &Scene, plan: &'a Plan, text: Text) -> Result<Renderer<'a>, Failure> {
        let cleared = cleared(plan);
        let mut targets = Vec::new();
        for surface in &cleared.surfaces {
            let mut depth = surface.depth.clone();
            depth.resize(surface.words.len(), 0);
            let both = [("the words of a target", &surface.words), ("the depths of a target", &depth)];
            let held = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
            let [words, depths] = both.map(|(what, of)| gpu.buffer(what, of, held));
            let [first_words, first_depths] = both.map(|(what, of)| gpu.buffer(what, of, BufferUsages::COPY_SRC));
            targets.push(Target { held: [words?, depths?], cleared: [first_words?, first_depths?] });
        }
        let mut works = Vec::new();
        let layout = layout(gpu, text);
        let (pipelines, tiles) = (HashMap::new(), TILES);
        let mut builder = Builder { gpu, scene, plan, cleared: &cleared, targets: &targets, layout, pipelines, tiles };
        let options = Options { policies: plan.policies, ..Options::default() };
        for (number, draw) in plan.draws().iter().enumerate() {
            if let Some(part) = ninebit_lower::unprinted(draw, text == Text::OfDraw) {
                return Err(Failure::scalar(number, part));
            }
            works.extend(match text {
                Text::OfDraw => builder.own(number, draw, &Function::of_pixel(scene, plan, number, &options))?,
                Text::OfEveryDraw => builder.generic(number, draw)?,
            });
        }
        gpu.wait()?;
        Ok(Renderer { gpu, plan, cleared, targets, works })
    }

    /// Clears the targets and draws everything.
    ///
    /// # Errors
    /// What the driver says.
    pub fn draw(&self) -> Result<(), Failure> {
        let gpu = self.gpu;
        let mut encoder = gpu.encoder();
        for target in &self.targets {
            for (held, cleared) in target.held.iter().zip(&target.cleared) {
                encoder.copy_buffer_to_buffer(cleared, 0, held, 0, held.size());
            }
        }
        for Work { draw, pipelines, memory, sampled, batches } in &self.works {
            let draw = *draw;
            for of in sampled {
                let held = &self.targets[of.target].held[usize::from(of.is_depth)];
                if of.is_same {
                    encoder.copy_buffer_to_buffer(held, 0, memory, of.at, held.size());
                    continue;
                }
                gpu.queue.submit([std::mem::replace(&mut encoder, gpu.encoder()).finish()]);
                let frames = self.frames()?;
                let words = TextureWords::new(self.plan, &self.plan.draws()[draw..=draw], &frames.surfaces);
                let texels = words.memories(&self.plan.draws()[draw]);
                gpu.queue.write_buffer(memory, of.at, bytemuck::cast_slice(&texels[of.unit]));
            }
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            for batch in batches {
                for Dispatch { offset, tiles, is_full } in &batch.dispatches {
                    pass.set_pipeline(&pipelines[usize::from(*is_full)]);
                    pass.set_bind_group(0, &batch.group, &[*offset]);
                    pass.dispatch_workgroups((*tiles).min(DISPATCH_ROW), tiles.div_ceil(DISPATCH_ROW), 1);
                }
            }
        }
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()
    }

    /// Returns what the targets hold.
    ///
    /// # Errors
    /// What the driver says.
    pub fn frames(&self) -> Result<Frames, Failure> {
        let mut frames = self.cleared.clone();
        for (target, surface) in self.targets.iter().zip(&mut frames.surfaces) {
            surface.words = self.gpu.read(&target.held[0])?;
            if !surface.depth.is_empty() {
                surface.depth = self.gpu.read(&target.held[1])?;
            }
        }
        Ok(frames)
    }
}

impl Builder<'_> {
    /// Makes the work of a draw by its own text, unless nothing of it can be seen.
    fn own(&mut self, number: usize, draw: &PlannedDraw, function: &Function) -> Result<Option<Work>, Failure> {
        let setup = Setup::new(self.plan, draw, function);
        let fields = fields(function, &setup);
        let groups = self.sorted(number, draw, &setup, &fields)?;
        let Some(first) = groups.first() else { return Ok(None) };
        let is_few = groups.len() == 1 && first.triangles <= FEW && first.entries() >= LARGE * first.triangles;
        let way = if is_few { Way::ByTriangle } else { Way::ByTile };
        let text = shader(function, &setup, &fields, way);
        self.work((number, draw), (text, way, length(&fields)), &groups, None).map(Some)
    }

    /// Makes the work of a draw by the text for every draw, unless nothing of it can be seen.
    fn generic(&mut self, number: usize, draw: &PlannedDraw) -> Result<Option<Work>, Failure> {
        let generic = Generic { chip: self.plan.profile, policies: self.plan.policies };
        let (fields, draw) = (Field::all(), &with_all_levels(self.plan, draw));
        let groups = self.sorted(number, draw, &Setup::of_all(self.plan, draw), &fields)?;
        if groups.is_empty() {
            return Ok(None);
        }
        let words = draw_words(self.scene, draw, number)
            .map_err(|error| Failure::usage(error.to_string(), "draw it without `--generic`"))?;
        let words: HashMap<u32, u32> = words.into_iter().collect();
        let state = generic.state(|method| words.get(&method).copied().unwrap_or(0));
        let state = self.gpu.buffer(&format!("the state of draw {number}"), &state, BufferUsages::STORAGE)?;
        let text = (generic_shader(&generic), Way::ByTile, length(&fields));
        self.work((number, draw), text, &groups, Some(state)).map(Some)
    }

    /// Sorts the triangles of a draw.
    fn sorted(
        &mut self,
        number: usize,
        draw: &PlannedDraw,
        setup: &Setup,
        fields: &[Field],
    ) -> Result<Vec<Bins>, Failure> {
        let groups = sorted(self.plan, draw, setup, fields, self.tiles).ok_or_else(|| {
            Failure::limit(format!("up to draw {number}, triangles lie in more than {TILES} tiles of 16 x 16 pixels"))
        })?;
        self.tiles -= groups.iter().map(Bins::entries).sum::<usize>();
        Ok(groups)
    }

    /// Makes the work of a draw by a text, to whose triangles belong so many words.
    fn work(
        &mut self,
        (number, draw): (usize, &PlannedDraw),
        (text, way, length): (String, Way, usize),
        groups: &[Bins],
        state: Option<wgpu::Buffer>,
    ) -> Result<Work, Failure> {
        let pipelines = self.pipelines(text, number, way, state.is_some())?;
        let Memory { words, bases, sampled } = self.memory(number, draw)?;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        let memory = self.gpu.buffer(&format!("the textures of draw {number}"), &words, usage)?;
        let shared = DrawResources { number, draw, way, length, memory, bases, state };
        let batches = groups.iter().map(|bins| self.batch(&shared, bins)).collect::<Result<Vec<_>, _>>()?;
        Ok(Work { draw: number, pipelines, memory: shared.memory, sampled, batches })
    }

    /// Compiles a shader, unless another draw has the same; it is kept for other scenes if asked.
    fn pipelines(&mut self, text: String, number: usize, way: Way, is_kept: bool) -> Result<Pipelines, Failure> {
        let kept = || self.gpu.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = self.pipelines.get(&text).or(kept().get(&text)) {
            return Ok(known.clone());
        }
        let device = &self.gpu.device;
        let module = self.gpu.module(&text);
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&self.layout)],
            immediate_size: 0,
        });
        let made = |constants: &[(&str, f64)]| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(&format!("draw {number}")),
                layout: Some(&layout),
                module: &module,
                entry_point: Some("main"),
                compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
                cache: None,
            })
        };
        let partial = made(&[]);
        let full = if way == Way::ByTriangle { made(&[("is_full", 1.0)]) } else { partial.clone() };
        let pipelines = [partial, full];
        self.gpu.check()?;
        if is_kept {
            kept().insert(text, pipelines.clone());
        } else {
            self.pipelines.insert(text, pipelines.clone());
        }
        Ok(pipelines)
    }

    /// Returns the memory of a draw's units.
    fn memory(&self, number: usize, draw: &PlannedDraw) -> Result<Memory, Failure> {
        let mut memory = Memory::default();
        let words = TextureWords::new(self.plan, &self.plan.draws()[number..=number], &self.cleared.surfaces);
        for (unit, texels) in words.memories(draw).iter().enumerate() {
            let at = memory.words.len();
            memory.bases[unit] = u32::try_from(at)
                .map_err(|_| Failure::limit(format!("the textures of draw {number} have 2^32 texels or more")))?;
            let of = draw.units.iter().find(|of| of.index == unit);
            let image = of.map(|of| &self.plan.textures()[of.state.texture].image);
            if let Some((image, target)) = image.and_then(|image| Some((image, image.target()?))) {
                let is_depth = matches!(image, TextureImage::Depth { .. });
                let surface = &self.cleared.surfaces[target];
                let held = if is_depth { &surface.depth } else { &surface.words };
                let is_same = std::ptr::eq(held.as_slice(), &raw const **texels);
                memory.sampled.push(TargetSource { unit, target, is_depth, is_same, at: 4 * at as u64 });
            }
            memory.words.extend_from_slice(texels);
        }
        Ok(memory)
    }

    /// Returns the uniform words of some triangles, and their dispatches.
    fn dispatches(&self, shared: &DrawResources<'_>, bins: &Bins, tiles: &Tiles) -> (Vec<u32>, Vec<Dispatch>) {
        let surface = &self.cleared.surfaces[shared.draw.target];
        let (mut uniform, mut dispatches) = (Vec::new(), Vec::new());
        for list in &tiles.lists {
            let at = uniform.len();
            dispatches.push(Dispatch { offset: 4 * at as u32, tiles: list.count, is_full: list.is_full });
            uniform.extend([surface.width, surface.height, list.count, list.first]);
            uniform.extend(shared.bases);
            if shared.way == Way::ByTriangle {
                uniform.extend(bins.constants.chunks(shared.length).nth(list.triangle).into_iter().flatten());
                uniform.resize(at + shared.window().next_multiple_of(self.gpu.alignment()), 0);
            }
        }
        (uniform, dispatches)
    }

    /// Fills the buffers of some triangles.
    fn batch(&self, shared: &DrawResources<'_>, bins: &Bins) -> Result<Batch, Failure> {
        let tiles = match shared.way {
            Way::ByTile => bins.tiles(),
            Way::ByTriangle => bins.tiles_by_triangle(),
        };
        let (uniform, dispatches) = self.dispatches(shared, bins, &tiles);
        let of = |what: &str| format!("the {what} of draw {}", shared.number);
        let uniform = self.gpu.buffer(&of("uniform words"), &uniform, BufferUsages::UNIFORM)?;
        let tiles = self.gpu.buffer(&of("tiles"), &tiles.words, BufferUsages::STORAGE)?;
        let constants = self.gpu.buffer(&of("triangles"), &bins.constants, BufferUsages::STORAGE)?;
        let [words, depths] = &self.targets[shared.draw.target].held;
        let size = std::num::NonZeroU64::new(4 * shared.window() as u64);
        let uniform = wgpu::BufferBinding { buffer: &uniform, offset: 0, size };
        let storage = [&tiles, &constants, &shared.memory, words, depths].into_iter().chain(&shared.state);
        let storage = storage.map(wgpu::Buffer::as_entire_binding);
        let resources = [wgpu::BindingResource::Buffer(uniform)].into_iter().chain(storage);
        let entries: Vec<wgpu::BindGroupEntry<'_>> =
            (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
        let group = self.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.layout,
            entries: &entries,
        });
        self.gpu.check()?;
        Ok(Batch { group, dispatches })
    }
}

impl DrawResources<'_> {
    /// Returns the uniform words of a dispatch.
    fn window(&self) -> usize {
        WORK + if self.way == Way::ByTriangle { self.length } else { 0 }
    }
}

/// Returns the layout of all shaders' buffers.
fn layout(gpu: &Gpu, text: Text) -> wgpu::BindGroupLayout {
    let entry = |binding: u32| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: match binding {
                0 => wgpu::BufferBindingType::Uniform,
                _ => wgpu::BufferBindingType::Storage { read_only: !(4..6).contains(&binding) },
            },
            has_dynamic_offset: binding == 0,
            min_binding_size: None,
        },
        count: None,
    };
    let count = if text == Text::OfEveryDraw { 7 } else { 6 };
    let entries: Vec<_> = (0..count).map(entry).collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}
