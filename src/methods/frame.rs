//! Frames: the draws and clears between two flips, as a scene.

mod refused;

use std::collections::HashMap;
use std::ops::Range;

use ninebit::raster::depth;
use ninebit::rop;
use ninebit::state::{
    Buffer, DepthBuffer, Draw, Named, Palette, Rectangle, Scene, ShaderOperation, TEXTURE_UNITS, Target, Texture,
    TextureFormat, TextureImage, TextureKind, TextureUnit, VertexDepths,
};
use ninebit_program::registers::unit::{ENABLE, STAGE_THREE};
use ninebit_scene::clear::Clear;

use crate::class::{self, Family};
use crate::draw::surface::{Surface, surface};
use crate::draw::texture::{Image, entries, image, palette, unit};
use crate::draw::view::View;
use crate::draw::{raster, shader, vertices};
use crate::gap::Gap;
use crate::import::Sources;
use crate::memory::{Layout, Memory, raw, words};
use crate::state::{Batch, State};

/// A draw or a clear of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Operation {
    /// Line of the log.
    pub line: u64,
    /// Number among the draws of the log, from 0; clears have none.
    pub number: Option<u64>,
    /// Index in the scene; `None` if it could not be stated at all.
    pub draw: Option<usize>,
    /// Name of what it is: `draw 3: TriangleStrip of 4 vertices`.
    pub name: String,
    /// The reasons for which it is incomplete.
    pub gaps: Vec<Gap>,
}

/// A frame of the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Number of the frame, from 0.
    pub number: u64,
    /// The scene; it has no target if nothing was drawn.
    pub scene: Scene,
    /// The draws and clears in order.
    pub drawn: Vec<Operation>,
    /// What the chip's surfaces held after the last draw, where that was dumped.
    pub held: Vec<Held>,
}

/// What a surface of the chip held after the last draw into it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Held {
    /// Index of the target in the scene.
    pub target: usize,
    /// Number of the draw in the log.
    pub draw: u64,
    /// A word for each pixel, as [`ninebit::frame::Surface::words`].
    pub words: Option<Vec<u32>>,
    /// A word for each pixel, as [`ninebit::frame::Surface::depth`].
    pub depth: Option<Vec<u32>>,
}

impl Frame {
    /// Returns whether every draw is stated as it was.
    pub fn is_complete(&self) -> bool {
        self.drawn.iter().all(|drawn| drawn.gaps.is_empty())
    }
}

/// How the frame has used a target so far.
#[derive(Clone, Debug)]
struct TargetUse {
    surface: Surface,
    uses_depth: bool,
    /// Number of draws and clears into it.
    uses: usize,
    /// Whether the log has all that it holds.
    has_contents: bool,
    /// Whether a clear of all colours, and one of all depths, comes first.
    is_cleared: [bool; 2],
    /// Bytes of the colours and of the depths before the first draw, as they were dumped.
    dumped: [Option<Vec<u8>>; 2],
    /// Number of the last draw, if no clear follows it.
    last_draw: Option<u64>,
}

impl TargetUse {
    /// Returns the words of the colours or the depths of a target, of bytes that begin where the buffer does.
    fn words(&self, target: &Target, buffer: Buffer, memory: &Memory, address: u32) -> Option<Vec<u32>> {
        let Surface { pitch, zeta_pitch, swizzled, .. } = self.surface;
        let (format, pitch) = match buffer {
            Buffer::Color => (raw(target.format), pitch),
            Buffer::Depth => (target.depth?.format.texture_format(), zeta_pitch),
        };
        let layout = swizzled.map_or(Layout::Pitch(pitch), |_| Layout::Swizzled);
        words(memory, address.into(), format, [target.width, target.height, 1], layout)
    }
}

/// Builds the scene of a frame.
#[derive(Debug, Default)]
pub(crate) struct Builder {
    number: u64,
    /// The family of the class that draws.
    family: Family,
    surfaces_in_memory: bool,
    targets: Vec<Target>,
    known: Vec<TargetUse>,
    textures: Vec<Texture>,
    images: HashMap<Image, (usize, Option<Gap>)>,
    shown: HashMap<(usize, bool, TextureKind, TextureFormat), usize>,
    palettes: Vec<Palette>,
    palette_places: HashMap<(u32, usize), usize>,
    draws: Vec<Draw>,
    drawn: Vec<Operation>,
}

impl Builder {
    /// Makes a builder of a frame. `surfaces_in_memory` says that memory has what surfaces held before the frame.
    pub(crate) fn new(number: u64, surfaces_in_memory: bool) -> Builder {
        Builder { number, surfaces_in_memory, ..Builder::default() }
    }

    /// Returns whether nothing was drawn.
    pub(crate) fn is_empty(&self) -> bool {
        self.drawn.is_empty()
    }

    /// Takes a clear.
    pub(crate) fn clear(&mut self, state: &State, line: u64, word: u32) {
        let mut view = View::new(state);
        let name = format!("clear at line {line}");
        let draw = surface(&mut view).and_then(|surface| {
            let zeta = (word & 1 != 0, word & 2 != 0 && surface.depth.has_stencil());
            let target = self.target(&mut view, &surface, zeta.0 || zeta.1)?;
            let clear = self.clear_target(&mut view, (target, &surface), word, zeta);
            let known = &mut self.known[target];
            (known.uses, known.last_draw) = (known.uses + 1, None);
            self.draws.push(clear?.draw(name.clone(), target));
            Some(self.draws.len() - 1)
        });
        self.drawn.push(Operation { line, number: None, draw, name, gaps: view.finish() });
    }

    /// Clears a target to what it holds first; returns any other clear, if it has pixels.
    fn clear_target(
        &mut self,
        view: &mut View<'_>,
        (target, surface): (usize, &Surface),
        word: u32,
        (clears_depth, clears_stencil): (bool, bool),
    ) -> Option<Clear> {
        // R, G, B, A.
        let mask = [4, 5, 6, 7].map(|bit| word >> bit & 1 != 0);
        let mut axis = |method, start: u32, length: u32| {
            let word = view.get(method);
            let (first, last) = ((word & 0xffff).max(start), (word >> 16).min(start + length - 1));
            (first, (last + 1).saturating_sub(first))
        };
        let clip = surface.clip;
        let (x, width) = axis(class::SET_CLEAR_RECT_HORIZONTAL, clip.x, clip.width);
        let (y, height) = axis(class::SET_CLEAR_RECT_VERTICAL, clip.y, clip.height);
        let (colors, zeta) = (mask.contains(&true), clears_depth || clears_stencil);
        // CLR-1.
        let color = colors.then(|| rop::surface::read(surface.format, view.get(class::SET_COLOR_CLEAR_VALUE)));
        let zstencil = if zeta { view.get(class::SET_ZSTENCIL_CLEAR_VALUE) } else { 0 };
        let (depth_word, stencil_byte) = match surface.depth.has_stencil() {
            true => (zstencil >> 8, zstencil as u8),
            false => (zstencil & 0xffff, 0),
        };
        let area = Rectangle { x, y, width, height };
        let whole = Rectangle { x: 0, y: 0, width: self.targets[target].width, height: self.targets[target].height };
        let all = mask == [true; 4] || colors && surface.format.bytes() < 4;
        if area == whole && all {
            self.known[target].has_contents = true;
        }
        let complete = !zeta || clears_depth && (clears_stencil || !surface.depth.has_stencil());
        if self.known[target].uses == 0 && area == whole && (all || !colors) && complete {
            if let Some(color) = color {
                self.targets[target].clear_color = color;
                self.known[target].is_cleared[Buffer::Color as usize] = true;
            }
            if zeta {
                self.known[target].is_cleared[Buffer::Depth as usize] = true;
                let buffer = DepthBuffer { format: surface.depth, clear: depth_word, clear_stencil: stencil_byte };
                self.targets[target].depth = Some(buffer);
            }
            return None;
        }
        if colors {
            self.contents(view, target);
        }
        let depth = clears_depth.then(|| {
            let depth = depth::of_word(surface.depth, depth_word).unwrap_or_else(|| {
                view.note(Gap::NotModelled(format!("a clear to the float depth 0x{depth_word:x}")));
                0.0
            });
            (VertexDepths::Steps, depth)
        });
        let stencil = clears_stencil.then_some(stencil_byte);
        (width > 0 && height > 0).then_some(Clear { area, color, color_mask: mask, depth, stencil })
    }

    /// Begins a target as it was dumped before its first draw.
    fn take_dumped(&mut self, target: usize, uses_depth: bool, sources: &Sources, number: u64) {
        let known = &mut self.known[target];
        if known.uses > 0 {
            return;
        }
        let [of_colors, of_depths] = known.is_cleared;
        if !of_colors {
            known.dumped[Buffer::Color as usize] = sources.dumps.before(number, Buffer::Color);
            known.has_contents |= known.dumped[Buffer::Color as usize].is_some();
        }
        if uses_depth && !of_depths {
            known.dumped[Buffer::Depth as usize] = sources.dumps.before(number, Buffer::Depth);
        }
    }

    /// Notes once that a target held something before the log.
    fn contents(&mut self, view: &mut View<'_>, target: usize) {
        let known = &mut self.known[target];
        if !known.has_contents {
            view.note(Gap::UnknownContents(known.surface.color.into()));
            known.has_contents = true;
        }
    }

    /// Takes a draw.
    pub(crate) fn draw(&mut self, state: &State, sources: &Sources, batch: &Batch, number: u64) {
        let mut view = View::new(state);
        self.family = state.family();
        let line = batch.line;
        let draw = self.lower(&mut view, sources, batch, number);
        let count = draw.as_ref().map_or(0, |draw| draw.indices.len());
        let primitive = raster::topology(batch.primitive).map_or("unknown primitive", Named::name);
        let name = format!("draw {number} at line {line}: {primitive} of {count} vertices");
        let draw = draw.map(|draw| {
            let known = &mut self.known[draw.target];
            (known.uses, known.last_draw) = (known.uses + 1, Some(number));
            self.draws.push(Draw { name: format!("draw {number}, line {line}"), ..draw });
            self.draws.len() - 1
        });
        self.drawn.push(Operation { line, number: Some(number), draw, name, gaps: view.finish() });
    }

    /// Takes a draw that the end of the log cuts off, and does not state it.
    pub(crate) fn unfinished(&mut self, batch: &Batch, number: u64) {
        let name = format!("draw {number} at line {}", batch.line);
        self.drawn.push(Operation {
            line: batch.line,
            number: Some(number),
            draw: None,
            name,
            gaps: vec![Gap::Unfinished],
        });
    }

    fn lower(&mut self, view: &mut View<'_>, sources: &Sources, batch: &Batch, number: u64) -> Option<Draw> {
        let memory = &sources.memory;
        let Some(topology) = raster::topology(batch.primitive) else {
            view.note(Gap::BadValue(Family::Kelvin, class::SET_BEGIN_END, batch.primitive));
            return None;
        };
        let surface = surface(view)?;
        let mut draw = Draw { topology, ..Draw::default() };
        let visible = raster::state(view, surface.depth, &mut draw);
        if !(vertices::vertices_of(view, memory, batch, surface.depth, &mut draw) && visible) {
            return None;
        }
        let tests = draw.depth_test.is_some() || draw.stencil_test.is_some();
        draw.target = self.target(view, &surface, tests)?;
        self.take_dumped(draw.target, tests, sources, number);
        self.contents(view, draw.target);
        draw.scissor = Some(surface.clip);
        draw.combiners = shader::combiners(view)?;
        self.units(view, memory, &mut draw);
        Some(draw)
    }

    /// Returns the target of a surface, which grows with its clip.
    fn target(&mut self, view: &mut View<'_>, surface: &Surface, uses_depth: bool) -> Option<usize> {
        let [width, height] = surface.size();
        let same = |known: &TargetUse| {
            known.surface.color == surface.color && known.surface.format.bytes() == surface.format.bytes()
        };
        let shares = |known: &TargetUse| {
            known.uses_depth && known.surface.zeta == surface.zeta && known.surface.color != surface.color
        };
        if uses_depth && self.known.iter().any(shares) {
            view.note(Gap::NotModelled(format!("a depth buffer (0x{:08x}) that several surfaces have", surface.zeta)));
        }
        let at = match self.known.iter().position(same) {
            Some(at) => at,
            None => {
                self.targets.push(Target {
                    name: format!("surface {:08x}", surface.color),
                    clear_color: [0, 0, 0, 0],
                    ..Target::new(width, height, surface.format)
                });
                self.known.push(TargetUse {
                    surface: *surface,
                    uses_depth: false,
                    uses: 0,
                    has_contents: self.surfaces_in_memory,
                    is_cleared: [false; 2],
                    dumped: [None, None],
                    last_draw: None,
                });
                self.known.len() - 1
            }
        };
        let (target, known) = (&mut self.targets[at], &mut self.known[at]);
        if target.format != surface.format {
            view.note(Gap::NotModelled(format!("the surface at 0x{:08x} in two formats", surface.color)));
        }
        (target.width, target.height) = (target.width.max(width), target.height.max(height));
        if uses_depth {
            if known.uses_depth && (known.surface.zeta, known.surface.depth) != (surface.zeta, surface.depth) {
                view.note(Gap::NotModelled(format!("a second depth buffer of the surface at 0x{:08x}", surface.color)));
            } else {
                (known.surface.zeta, known.surface.depth, known.uses_depth) = (surface.zeta, surface.depth, true);
                let format = surface.depth;
                target.depth.get_or_insert(DepthBuffer { format, clear: format.largest(), clear_stencil: 0 });
            }
        }
        Some(at)
    }

    /// Fills in the texture units and the texture shader.
    fn units(&mut self, view: &mut View<'_>, memory: &Memory, draw: &mut Draw) {
        for index in 0..TEXTURE_UNITS {
            let mut stage = shader::stage(view, index);
            if stage.operation.samples() {
                let enabled = ENABLE.is_set(view.get(class::of_unit(class::SET_TEXTURE_CONTROL0, index)));
                draw.textures[index] = if enabled { self.unit(view, memory, index, draw.target) } else { None };
                if draw.textures[index].is_none() {
                    stage.operation = ShaderOperation::None;
                }
                if let Some(unit) = &draw.textures[index] {
                    let kind = self.textures[unit.texture].kind;
                    stage.operation = shader::of_kind(view, index, stage.operation, kind);
                    if !stage.operation.samples() || !stage.operation.kinds().contains(&kind) {
                        let what = format!("a texture of kind {} at unit {index}", kind.name());
                        view.note(Gap::NotModelled(format!("{what}, which samples another")));
                        (draw.textures[index], stage.operation) = (None, ShaderOperation::None);
                    }
                }
            }
            draw.texture_shader[index] = stage;
        }
    }

    fn unit(&mut self, view: &mut View<'_>, memory: &Memory, index: usize, target: usize) -> Option<TextureUnit> {
        let image = image(view, index)?;
        let projects = shader::code(view, index) == STAGE_THREE;
        let mut state = unit(view, index, &image, projects);
        state.texture = match self.target_texture(view, &image, target) {
            Some(texture) => texture,
            None => self.texture(view, memory, &image)?,
        };
        if image.format == TextureFormat::P8 {
            let place = palette(view, index);
            let known = self.palette_places.get(&place).copied();
            state.palette = Some(match known {
                Some(palette) => palette,
                None => match entries(memory, place) {
                    Ok(palette) => {
                        self.palettes.push(palette);
                        self.palette_places.insert(place, self.palettes.len() - 1);
                        self.palettes.len() - 1
                    }
                    Err(gap) => {
                        view.note(gap);
                        let name = format!("palette {:08x}, not recorded", place.0);
                        self.palettes.push(Palette { name, entries: vec![u32::MAX; place.1].into() });
                        self.palette_places.insert(place, self.palettes.len() - 1);
                        self.palettes.len() - 1
                    }
                },
            });
        }
        Some(state)
    }

    /// Returns the texture that shows a target of the frame, if the image is one.
    fn target_texture(&mut self, view: &mut View<'_>, image: &Image, drawing: usize) -> Option<usize> {
        let color = self.known.iter().position(|known| known.surface.color == image.address && known.uses > 0);
        let depth = self
            .known
            .iter()
            .position(|known| known.uses_depth && known.surface.zeta == image.address && known.uses > 0);
        let (target, is_depth) = match (color, depth) {
            _ if image.format.depth().is_some() => (depth?, true),
            (Some(color), _) => (color, false),
            (None, _) => return None,
        };
        let state = &self.targets[target];
        let bytes = if is_depth { image.format.bytes() } else { state.format.bytes() };
        let fits = image.levels == 1
            && !image.border
            && image.size[1] == state.height
            && match image.kind {
                TextureKind::TwoDimensional => (image.size[0], image.format.bytes()) == (state.width, bytes),
                // A row's bytes, as many texels as they fill.
                TextureKind::Rectangle => image.size[0] * image.format.bytes() == state.width * bytes,
                _ => false,
            };
        if !fits || target == drawing {
            view.note(Gap::NotModelled(format!("part of the surface at 0x{:08x} as a texture", image.address)));
            return None;
        }
        let key = (target, is_depth, image.kind, image.format);
        if let Some(texture) = self.shown.get(&key) {
            return Some(*texture);
        }
        let name = format!("{} of {} {}", if is_depth { "depths" } else { "colours" }, state.name, self.textures.len());
        let image_of = if is_depth { TextureImage::Depth { target } } else { TextureImage::Target { target } };
        self.textures.push(Texture { name, kind: image.kind, format: image.format, image: image_of });
        self.shown.insert(key, self.textures.len() - 1);
        Some(self.textures.len() - 1)
    }

    /// Returns the texture of an image. Where memory does not hold it, a white texel stands for it; what the chip does not have is noted.
    fn texture(&mut self, view: &mut View<'_>, memory: &Memory, image: &Image) -> Option<usize> {
        if let Some((texture, gap)) = self.images.get(image) {
            gap.iter().for_each(|gap| view.note(gap.clone()));
            return Some(*texture);
        }
        let (texels, gap) = match image.texels(memory) {
            Ok(texels) => (texels, None),
            Err(gap) => (image.absent(), Some(gap)),
        };
        let name = format!("texture {} at {:08x}", self.textures.len(), image.address);
        let name = if gap.is_some() { format!("{name}, not recorded") } else { name };
        let image_of = TextureImage::Texels(texels);
        let texture = Texture { name, kind: image.kind, format: image.format, image: image_of };
        if let Some(message) = refused::refusal(view.family(), &texture) {
            view.note(Gap::NotModelled(message));
            return None;
        }
        self.textures.push(texture);
        gap.iter().for_each(|gap| view.note(gap.clone()));
        self.images.insert(*image, (self.textures.len() - 1, gap));
        Some(self.textures.len() - 1)
    }

    /// Forgets the images in a range of addresses, which hold others from now on.
    pub(crate) fn forget_images(&mut self, range: Range<u64>) {
        self.images.retain(|image, _| {
            let first = u64::from(image.address);
            first >= range.end || first + image.bytes() <= range.start
        });
    }

    /// Returns the frame. Draws that the model refuses are left out, with the reason.
    pub(crate) fn finish(mut self, sources: &Sources) -> Frame {
        let mut held = Vec::new();
        for (index, (target, known)) in self.targets.iter_mut().zip(&mut self.known).enumerate() {
            let Surface { color, zeta, .. } = known.surface;
            let [of_colors, of_depths] = known.is_cleared.map(|is_cleared| self.surfaces_in_memory && !is_cleared);
            if of_colors {
                target.contents = known.words(target, Buffer::Color, &sources.memory, color).map(Into::into);
            }
            if of_depths {
                target.depth_contents = known.words(target, Buffer::Depth, &sources.memory, zeta).map(Into::into);
            }
            let dumped = std::mem::take(&mut known.dumped);
            let [colors, depths] = dumped.map(|bytes| bytes.map(Memory::new));
            let words = |memory: Option<Memory>, buffer| known.words(target, buffer, &memory?, 0);
            let [colors, depths] = [words(colors, Buffer::Color), words(depths, Buffer::Depth)];
            if let Some(draw) = known.last_draw {
                let [words, depth] = [Buffer::Color, Buffer::Depth]
                    .map(|buffer| words(sources.dumps.after(draw, buffer).map(Memory::new), buffer));
                if words.is_some() || depth.is_some() {
                    held.push(Held { target: index, draw, words, depth: depth.filter(|_| known.uses_depth) });
                }
            }
            target.contents = colors.map(Into::into).or(target.contents.take());
            target.depth_contents = depths.map(Into::into).or(target.depth_contents.take());
        }
        let Builder { number, family, targets, textures, palettes, draws, mut drawn, .. } = self;
        let mut scene = Scene { profile: family.profile(), targets, textures, palettes, draws };
        for draw in &mut scene.draws {
            // Until here a target may have grown by the clip of a later draw.
            let target = &scene.targets[draw.target];
            if draw.scissor == Some(Rectangle { x: 0, y: 0, width: target.width, height: target.height }) {
                draw.scissor = None;
            }
        }
        refused::leave_all_out(&mut scene, &mut drawn);
        Frame { number, scene, drawn, held }
    }
}
