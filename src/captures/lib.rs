//! Captured frames of a real NV2A, drawn again by the model. This crate holds what the programs drew; a table holds digests of what the
//! chip showed.
//!
//! The frames are those of [nxdk_pgraph_tests_golden_results](https://github.com/abaire/nxdk_pgraph_tests_golden_results) (CC0), drawn by the
//! programs of [nxdk_pgraph_tests](https://github.com/abaire/nxdk_pgraph_tests) (MIT). `vectors/captures/frames.tsv` has a row for each frame: the
//! areas where the programs printed text, which are not compared, and the SHA-256 of the captured pixels outside them.
#![allow(clippy::float_arithmetic, reason = "positions that programs gave the chip")]

mod assets;
mod attributes;
mod blend;
mod borders;
mod clears;
mod clip;
mod color_key;
mod combiner;
mod counting;
mod depth;
mod depth_range;
mod draws;
mod extreme_w;
mod faces;
mod fog;
mod fog_carryover;
mod images;
mod kinds;
mod lighting;
mod lights;
mod lines;
mod materials;
mod memory;
mod meshes;
mod points;
mod polygon_offset;
mod primitives;
mod rounding;
mod sampling;
mod shader;
mod shadow;
mod smooth;
mod space;
mod specular;
mod stencil;
mod swizzle;
mod table;
mod texel_formats;
mod texgen;
mod transfers;
pub mod verdict;

pub use table::KnownDifference;

use draws::*;
use images::checker;
use memory::{put_back, put_memory, seen_as, shown_as_565};
use ninebit::engine::{RenderOptions, cleared, render};
use ninebit::frame::Frames as Rendered;
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanError, PlanOptions};
use ninebit::rop::surface;
use ninebit::shortcut::{self, Mask, Shortcuts};
use ninebit::state::*;
use ninebit_data::CAPTURED;
use ninebit_files::picture::hexadecimal;
use sha2::{Digest, Sha256};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;
use table::Row;

/// Width and height of every frame in pixels.
pub const SIZE: (u32, u32) = (640, 480);

/// The repository and commit that the captures come from.
pub const SOURCE: &str = "abaire/nxdk_pgraph_tests_golden_results (CC0-1.0), commit 902343e2";

/// R, G, B and A of the letters that the programs printed.
pub const LETTERS: [u8; 4] = [255, 255, 255, 0];

/// The drawing of one frame: a scene whose first target is the frame buffer.
#[derive(Clone, Debug)]
struct FrameDrawing {
    scene: Scene,
    /// Scenes that are drawn first. The memory of the first target of each becomes the texels of the texture of the same number.
    before: Vec<Scene>,
    /// Whether these targets are swizzled in memory.
    is_swizzled: bool,
    /// Draws on the frame buffer's memory in a narrower format. Each row begins at the same address as before.
    view: Option<Scene>,
    /// The buffer that the capture shows: words of depth and stencil as A8R8G8B8, 16-bit words as R5G6B5.
    shown: Buffer,
}

impl FrameDrawing {
    /// Returns a frame that shows the colours of a scene's first target.
    fn colors(scene: Scene) -> FrameDrawing {
        FrameDrawing { scene, before: Vec::new(), is_swizzled: false, view: None, shown: Buffer::Color }
    }
}

/// Returns the variants of an enumeration with their names in those of frames. `names` has to be in the order of the variants.
fn named<T: Named>(names: &'static str) -> impl Iterator<Item = (&'static str, T)> {
    names.split(' ').zip(T::ALL.iter().copied())
}

/// A captured frame.
#[derive(Clone)]
pub struct Frame {
    /// The suite of the test programs that it belongs to.
    pub suite: &'static str,
    /// The frame's name: the picture's file name without its extension.
    pub name: String,
    make: Make,
    /// Areas where the programs printed text. Pixels there are not compared.
    pub text: Vec<Rectangle>,
    digest: &'static str,
    /// The known difference from the capture; `None` if the frame is exact.
    pub open: Option<KnownDifference>,
}

impl fmt::Debug for Frame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Frame").field(&self.suite).field(&self.name).finish()
    }
}

/// An error of this crate: rows of the table that no code draws, or frames that have no row.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{} frames and rows do not meet: {}", .0.len(), .0[..self.0.len().min(3)].join("; "))]
pub struct FrameMismatch(Vec<String>);

/// Returns the names of all suites, in the order of the table.
pub fn suites() -> impl Iterator<Item = &'static str> {
    SUITES.iter().map(|(name, _)| *name)
}

/// Returns the names of all captured suites, drawn or not, and how many frames each has.
pub fn captured() -> impl Iterator<Item = (&'static str, usize)> {
    let line = |line: &'static str| line.split_once('\t').and_then(|(name, count)| Some((name, count.parse().ok()?)));
    CAPTURED.lines().filter_map(line)
}

/// Builds a frame's scenes on demand: all frames together would take much memory.
type Make = Arc<dyn Fn() -> FrameDrawing + Send + Sync>;

/// The frames of a suite by name.
#[derive(Default)]
struct Frames(Vec<(String, Make)>);

impl Frames {
    /// Adds a frame whose scene is built already.
    fn push(&mut self, name: impl Into<String>, drawn: FrameDrawing) {
        self.make(name, move || drawn.clone());
    }

    /// Adds two frames of a scene: its colours, and its words of depth and stencil.
    fn both(&mut self, name: &str, scene: Scene) {
        self.push(format!("{name}_ZB"), FrameDrawing { shown: Buffer::Depth, ..FrameDrawing::colors(scene.clone()) });
        self.push(name, FrameDrawing::colors(scene));
    }

    /// Adds a frame whose scene is built on demand.
    fn make(&mut self, name: impl Into<String>, make: impl Fn() -> FrameDrawing + Send + Sync + 'static) {
        self.0.push((name.into(), Arc::new(make)));
    }

    /// Adds a frame that is drawn on demand, on a frame buffer cleared to `clear`.
    fn paint(&mut self, name: impl Into<String>, clear: u32, paint: impl Fn(&mut Canvas) + Send + Sync + 'static) {
        self.make(name, move || {
            let mut canvas = Canvas::new(clear);
            paint(&mut canvas);
            canvas.colors()
        });
    }
}

/// The name of a suite, and the function that adds its frames.
type Suite = (&'static str, fn(&mut Frames));

const SUITES: &[Suite] = &[
    ("3D_primitive", smooth::solids),
    ("Alpha_func", blend::alpha_function),
    ("Antialiasing_tests", transfers::one_sample),
    ("Attrib_carryover", attributes::carryover),
    ("Attrib_float", primitives::float_colors),
    ("Attrib_setter", attributes::setters),
    ("Blend_surface", blend::surfaces),
    ("Blend_tests", blend::tests),
    ("Bump_env_lum", shader::bump_maps_with_luminance),
    ("Bump_map", shader::bump_maps),
    ("Clear", clears::frames),
    ("Color_key", color_key::frames),
    ("Color_mask_blend", blend::color_mask),
    ("Combiner", combiner::frames),
    ("Depth_Clamp", depth_range::clamped),
    ("Depth_buffer", depth::formats),
    ("Depth_buffer_fixed_function", depth::fixed_function),
    ("Depth_function", clears::functions),
    ("Edge_flag", lines::edge_flags),
    ("Fog", fog::planar),
    ("Fog_carryover", fog_carryover::frames),
    ("Fog_coord_vec4", fog::of_components),
    ("Fog_exceptional_value", fog::exceptional),
    ("Fog_gen", fog::generated),
    ("Fog_inf_coord", fog::infinite),
    ("Fog_param", fog::parameters_varied),
    ("Fog_vsh", fog::of_program),
    ("Front_face", faces::frames),
    ("High_vertex_count", primitives::many_vertices),
    ("Lighting_Two_Sided", materials::two_sides),
    ("Lighting_accumulation", lights::accumulation),
    ("Lighting_control", lights::controls),
    ("Lighting_normals", lights::normals),
    ("Lighting_range", lights::ranges),
    ("Lighting_spotlight", lights::spotlights),
    ("Line_width", lines::widths),
    ("Material_alpha", materials::alphas),
    ("Material_color", materials::colors),
    ("Material_color_source", materials::sources),
    ("Overlapping_draw_modes", primitives::mixed_modes),
    ("Pixel_shader", shader::programs),
    ("Point_params", points::parameters_varied),
    ("Point_size", lines::sizes),
    ("Point_sprite", points::sprites),
    ("Shade_model", primitives::shade_model),
    ("Smoothing_control", lines::smoothing),
    ("Specular", specular::fronts),
    ("Specular_back", specular::backs),
    ("Stencil", stencil::operations),
    ("Stencil_func", stencil::functions),
    ("Stipple_tests", lines::stipples),
    ("Surface_clip", clip::surface_clip),
    ("Surface_format", blend::surface_formats),
    ("Surface_pitch", swizzle::frames),
    ("Texgen", texgen::generation),
    ("Texgen_with_texture_matrix", texgen::generation_and_matrices),
    ("TextureWrapMode", sampling::wrap_modes),
    ("Texture_2D_as_cubemap", kinds::planes_as_cubes),
    ("Texture_3D_as_2D", kinds::solids_as_planes),
    ("Texture_CPU_Update", transfers::updates),
    ("Texture_DXT", texel_formats::compressed),
    ("Texture_Framebuffer_Blit", transfers::blits),
    ("Texture_LOD_Bias", texel_formats::lod_bias),
    ("Texture_Matrix", texgen::texture_matrices),
    ("Texture_anisotropy", sampling::anisotropy),
    ("Texture_border", borders::borders),
    ("Texture_border_color", borders::border_color),
    ("Texture_cubemap", shader::cube_maps),
    ("Texture_format", texel_formats::formats),
    ("Texture_palette", texel_formats::palettes),
    ("Texture_perspective", primitives::perspective),
    ("Texture_render_target", texel_formats::render_targets),
    ("Texture_render_update_in_place", transfers::in_place),
    ("Texture_shadow_comparator", shadow::frames),
    ("Texture_perspective_enable", extreme_w::perspective),
    ("Texture_signed_component_tests", texel_formats::signed),
    ("Vertex_shader_independence_tests", transfers::independence),
    ("Vertex_shader_rounding_tests", rounding::frames),
    ("Vertex_shader_swizzle_tests", attributes::swizzles),
    ("Viewport", rounding::viewports),
    ("Volume_texture", sampling::volumes),
    ("W_buffering", polygon_offset::buffers),
    ("W_param", extreme_w::frames),
    ("Window_clip", clip::window_clip),
    ("ZMinMaxControl", depth_range::controls),
    ("ZPass_pixel_count", counting::frames),
    ("Zero_stride", primitives::one_color),
];

/// Returns the frames of the named suites in the order of the table, or of all suites if none is named.
///
/// # Errors
/// Returns an error if a frame has no row in the table, or a row has no frame.
pub fn frames(wanted: &[&str]) -> Result<Vec<Frame>, FrameMismatch> {
    let mut all = Vec::new();
    let mut unmatched = Vec::new();
    let rows: Vec<Row> = table::rows().collect();
    for (suite, make) in SUITES.iter().filter(|(suite, _)| wanted.is_empty() || wanted.contains(suite)) {
        let mut drawn = Frames::default();
        make(&mut drawn);
        for Row { name, text, digest, open, .. } in rows.iter().filter(|row| row.suite == *suite) {
            match drawn.0.iter().position(|(other, _)| other == name) {
                Some(at) => {
                    let (name, make) = drawn.0.swap_remove(at);
                    all.push(Frame { suite, name, make, text: text.clone(), digest, open: *open });
                }
                None => unmatched.push(format!("{suite}/{name} of the table is drawn by nothing")),
            }
        }
        unmatched.extend(drawn.0.iter().map(|(name, _)| format!("{suite}/{name} is not in the table")));
    }
    if unmatched.is_empty() { Ok(all) } else { Err(FrameMismatch(unmatched)) }
}

/// Returns about `count` of the frames: the same share of each suite, at least one, and evenly spread over it.
pub fn sample(frames: Vec<Frame>, count: usize) -> Vec<Frame> {
    let total = frames.len().max(1);
    let mut of_suites = BTreeMap::<&str, usize>::new();
    for frame in &frames {
        *of_suites.entry(frame.suite).or_default() += 1;
    }
    let mut numbers = BTreeMap::<&str, usize>::new();
    let is_taken = |frame: &Frame| {
        let (all, number) = (of_suites[frame.suite], numbers.entry(frame.suite).or_default());
        *number += 1;
        let taken = (all * count).div_ceil(total).min(all);
        // A frame is taken wherever this number grows: in the middle of each of `taken` equal parts.
        let before = |number: usize| (2 * number * taken + all) / (2 * all);
        before(*number) > before(*number - 1)
    };
    frames.into_iter().filter(is_taken).collect()
}

impl Frame {
    /// Draws the frame. Returns R, G, B, A of every pixel, row by row from the top.
    ///
    /// # Errors
    /// Returns the plan's errors if a scene cannot be planned.
    pub fn render(&self, options: &RenderOptions, policies: Policies) -> Result<Vec<[u8; 4]>, Vec<PlanError>> {
        self.render_with(options, policies, Shortcuts::NONE, None)
    }

    /// Draws the frame as a renderer with shortcuts does. With a mask the result is what stands in the wanted places.
    ///
    /// # Errors
    /// Those of [`render`](Self::render).
    pub fn render_with(
        &self,
        options: &RenderOptions,
        policies: Policies,
        shortcuts: Shortcuts,
        mask: Mask<'_>,
    ) -> Result<Vec<[u8; 4]>, Vec<PlanError>> {
        self.prepare(policies)?.render(options, shortcuts, mask)
    }

    /// Builds and plans the frame's scenes once, for several renders.
    ///
    /// # Errors
    /// Those of [`render`](Self::render).
    pub fn prepare(&self, policies: Policies) -> Result<PreparedFrame, Vec<PlanError>> {
        PreparedFrame::new((self.make)(), policies)
    }

    /// Returns the frame's scenes, of which none is left to be drawn before.
    fn drawn(&self, options: &RenderOptions, policies: Policies) -> Result<FrameDrawing, Vec<PlanError>> {
        let mut drawn = (self.make)();
        for (before, texture) in std::mem::take(&mut drawn.before).iter().zip(&mut drawn.scene.textures) {
            let frames = render(&planned(before, policies)?, options);
            put_memory(&frames.surfaces[0], drawn.is_swizzled, texture);
        }
        Ok(drawn)
    }

    /// Returns the frame as one scene, whose first target is the frame buffer; `None` if the program drew on that memory in two formats. What was
    /// drawn before is in the scene's first textures.
    ///
    /// # Errors
    /// Returns the plan's errors if a scene that is drawn before cannot be planned.
    pub fn scene(&self, options: &RenderOptions) -> Result<Option<Scene>, Vec<PlanError>> {
        let FrameDrawing { scene, view, .. } = self.drawn(options, Policies::DEFAULT)?;
        Ok(view.is_none().then_some(scene))
    }

    /// Returns whether a picture equals the capture outside the programs' text.
    pub fn is(&self, pixels: &[[u8; 4]]) -> bool {
        digest(pixels, &self.text) == self.digest
    }

    /// Returns the number of pixels that are compared.
    pub fn compared(&self) -> u64 {
        let area = |r: &Rectangle| u64::from(r.width) * u64::from(r.height);
        u64::from(SIZE.0) * u64::from(SIZE.1) - self.text.iter().map(area).sum::<u64>()
    }
}

/// The scenes of a frame with their plans.
#[derive(Debug)]
pub struct PreparedFrame {
    drawn: FrameDrawing,
    policies: Policies,
    before: Vec<Plan>,
    main: Plan,
    view: Option<Plan>,
}

impl PreparedFrame {
    fn new(drawn: FrameDrawing, policies: Policies) -> Result<PreparedFrame, Vec<PlanError>> {
        let before = drawn.before.iter().map(|scene| planned(scene, policies)).collect::<Result<_, _>>()?;
        let main = planned(&drawn.scene, policies)?;
        let view = drawn.view.as_ref().map(|scene| planned(scene, policies)).transpose()?;
        Ok(PreparedFrame { drawn, policies, before, main, view })
    }

    /// Returns the shortcuts that can change the frame.
    pub fn shortcuts(&self) -> Shortcuts {
        let plans = self.before.iter().chain([&self.main]).chain(&self.view);
        plans.flat_map(|plan| shortcut::concerning(plan).iter().collect::<Vec<_>>()).collect()
    }

    /// Draws the frame as a renderer with shortcuts does. With a mask the result is what stands in the wanted places.
    ///
    /// # Errors
    /// Returns the plan's errors if a scene that reads what was drawn before it cannot be planned.
    pub fn render(
        &self,
        options: &RenderOptions,
        shortcuts: Shortcuts,
        mask: Mask<'_>,
    ) -> Result<Vec<[u8; 4]>, Vec<PlanError>> {
        self.drawn(shortcuts, mask, |_, plan, mask| {
            let plan = match shortcuts.is_empty() {
                true => Cow::Borrowed(plan),
                false => Cow::Owned(plan.clone().with_shortcuts(shortcuts)),
            };
            let mut frames = cleared(&plan);
            shortcut::render(&plan, shortcuts, options, &mut frames, mask);
            Ok(frames)
        })
    }

    /// Draws the frame by whatever draws scenes with their plans. Returns R, G, B, A of every pixel, row by row from the top.
    ///
    /// # Errors
    /// Returns those of `draw`, and the plan's errors if a scene that reads what was drawn before it cannot be planned.
    pub fn render_by<E: From<Vec<PlanError>>>(
        &self,
        mut draw: impl FnMut(&Scene, &Plan) -> Result<Rendered, E>,
    ) -> Result<Vec<[u8; 4]>, E> {
        self.drawn(Shortcuts::NONE, None, |scene, plan, _| draw(scene, plan))
    }

    /// Draws the frame by `draw`, which gets a scene, its plan and what is wanted of it.
    fn drawn<E: From<Vec<PlanError>>>(
        &self,
        shortcuts: Shortcuts,
        mask: Mask<'_>,
        mut draw: impl FnMut(&Scene, &Plan, Mask<'_>) -> Result<Rendered, E>,
    ) -> Result<Vec<[u8; 4]>, E> {
        let FrameDrawing { scene, before, is_swizzled, view, shown } = &self.drawn;
        let (mut scene, mut main) = (Cow::Borrowed(scene), Cow::Borrowed(&self.main));
        if !before.is_empty() {
            for (n, (before, plan)) in before.iter().zip(&self.before).enumerate() {
                let frames = draw(before, plan, None)?;
                if let Some(texture) = scene.to_mut().textures.get_mut(n) {
                    put_memory(&frames.surfaces[0], *is_swizzled, texture);
                }
            }
            main = Cow::Owned(planned(&scene, self.policies)?);
        }
        let mut frames = draw(&scene, &main, mask.filter(|_| view.is_none()))?;
        let mut words = std::mem::take(&mut frames.surfaces[0].words);
        if let Some(view) = view {
            let mut view = view.clone();
            view.targets[0].contents = Some(seen_as(&words, SIZE.0 as usize, view.targets[0].format).into());
            let frames = draw(&view, &planned(&view, self.policies)?, None)?;
            put_back(&frames.surfaces[0], &mut words);
        }
        if *shown == Buffer::Depth
            && let Some(depth) = scene.targets[0].depth
        {
            let read = |word| shortcut::shown_depth(shortcuts, depth.format, depth_of(word));
            let surface = &mut frames.surfaces[0];
            if let Some(wanted) = mask {
                surface.depth = wanted.of(&surface.depth);
            }
            if depth.format.bits() == 16 {
                return Ok(surface.depth.iter().map(|word| shown_as_565(read(*word))).collect());
            }
            surface.depth.iter_mut().for_each(|word| *word = depth_stencil(read(*word), stencil_of(*word)));
            words = surface.chip_depth_words().collect();
        } else if let Some(wanted) = mask {
            words = wanted.of(&words);
        }
        Ok(surface::show_all(SurfaceFormat::A8R8G8B8, &words))
    }
}

/// Plans a scene of the programs.
fn planned(scene: &Scene, policies: Policies) -> Result<Plan, Vec<PlanError>> {
    Plan::compile_within(scene, &PlanOptions { policies, ..PlanOptions::default() }, &Limits::default())
}

/// Returns the indices of a rectangle's pixels in a frame.
pub fn pixels(of: &Rectangle) -> impl Iterator<Item = usize> + use<> {
    let Rectangle { x, y, width, height } = *of;
    (y..y + height).flat_map(move |row| (x..x + width).map(move |column| (row * SIZE.0 + column) as usize))
}

/// Returns the first 16 hexadecimal digits of the SHA-256 of the pixels outside the text (R, G, B, A, row by row).
fn digest(pixels: &[[u8; 4]], text: &[Rectangle]) -> String {
    let mut outside = vec![true; pixels.len()];
    for at in text.iter().flat_map(self::pixels) {
        // A rectangle of text may reach beyond a smaller picture.
        if let Some(outside) = outside.get_mut(at) {
            *outside = false;
        }
    }
    let bytes = pixels.iter().zip(outside).filter_map(|(pixel, outside)| outside.then_some(*pixel));
    let bytes: Vec<[u8; 4]> = bytes.collect();
    hexadecimal(&Sha256::digest(bytes.as_flattened())[..8])
}
