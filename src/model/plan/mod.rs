//! The plan: a scene, reduced to what can reach its frames before any pixel is drawn.
//!
//! Once a [`Plan`] exists, nothing can fail any more. With [`PlanOptions::prune`] (the default), outputs, channels,
//! units and reads whose results cannot be seen are left out; the frames have the same bytes without it.

mod check;
mod error;
mod fold;
mod liveness;
pub mod windows;

use crate::combiner::final_combiner::PlannedFinal;
use crate::combiner::general::PlannedStage;
use crate::limits::Limits;
use crate::raster::TEXEL_LIMIT;
use crate::raster::assemble::{Assembly, assemble};
use crate::rop::{stencil, surface};
use crate::state::*;
use crate::texture::planned::PlannedUnit;
use crate::texture::stage::{PlannedShader, PlannedShaderStage};
pub use error::PlanError;
use liveness::{DrawValues, Liveness};

/// Options of planning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanOptions {
    /// The alternatives of rules that no capture decides.
    pub policies: Policies,
    /// Whether to leave out what cannot reach a frame.
    pub prune: bool,
}

impl Default for PlanOptions {
    fn default() -> Self {
        PlanOptions { policies: Policies::DEFAULT, prune: true }
    }
}

/// A scene that is ready to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The chip that draws.
    pub profile: Profile,
    /// The policies in force. They may be changed afterwards, because planning does not depend on them.
    pub policies: Policies,
    /// Render targets, in the order of the scene.
    pub(crate) targets: Vec<Target>,
    /// Textures, in the order of the scene.
    pub(crate) textures: Vec<Texture>,
    /// Draws in order, which name targets and textures that are there.
    pub(crate) draws: Vec<PlannedDraw>,
}

/// A draw, reduced to what can reach its target.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedDraw {
    /// Name that messages and traces show.
    pub name: String,
    /// Index into [`Plan::targets`].
    pub target: usize,
    /// Format of the target.
    pub surface: SurfaceFormat,
    /// The pixels that may be drawn: rectangles that neither overlap nor are empty (CLP-1, CLP-2).
    pub windows: Vec<Rectangle>,
    /// Vertices in window coordinates, and triangles.
    pub assembly: Assembly,
    /// Whether colours are interpolated or flat.
    pub shade_model: ShadeModel,
    /// Whether attributes are interpolated in perspective, with w (WGT-1).
    pub perspective: bool,
    /// Which faces are culled.
    pub cull: Cull,
    /// Which winding makes a front face.
    pub front_face: FrontFace,
    /// The pattern that filled triangles have.
    pub polygon_stipple: Option<PolygonStipple>,
    /// Whether points have coordinates of their own in unit [`SPRITE_UNIT`] (PNT-2).
    pub point_sprite: bool,
    /// Channels of the primary colour that are read, as bits R, G, B, A.
    pub primary: u8,
    /// Channels of the secondary colour that are read, as bits R, G, B, A.
    pub secondary: u8,
    /// Channels of the fog register that are read, as bits R, G, B, A.
    pub fog_channels: u8,
    /// Fog colour and function.
    pub fog: Fog,
    /// The bound units that are read.
    pub units: Vec<PlannedUnit>,
    /// The texture shader, if there is one. The units then run as its stages.
    pub shader: Option<PlannedShader>,
    /// Channels that are read of each unit without an operation or a texture, as bits R, G, B, A (TEX-16).
    pub unbound: [u8; TEXTURE_UNITS],
    /// R, G, B, A of those units.
    pub unbound_color: [u8; 4],
    /// Units whose registers are converted from YUV (TEX-19): those of which combiners read colours.
    pub yuv: [bool; TEXTURE_UNITS],
    /// Whether SPARE0's initial alpha is read (CMB-13).
    pub spare0_alpha: bool,
    /// Registers that are read before anything writes them (CMB-13), as `bits`.
    pub undefined: u64,
    /// The general stages that are needed.
    pub stages: Vec<PlannedStage>,
    /// The source text of each general stage of the scene. May be empty.
    pub program_origin: Vec<StageOrigin>,
    /// Whether a vertex program made the vertices.
    pub vertex_program: bool,
    /// The bit of SPARE0's alpha that selects the output of muxes (CMB-10).
    pub mux_select: MuxSelect,
    /// The final combiner, with what is needed of it.
    pub final_combiner: PlannedFinal,
    /// Alpha test, unless it always passes.
    pub alpha_test: Option<AlphaTest>,
    /// Stencil test, unless it always passes and changes nothing.
    pub stencil_test: Option<StencilTest>,
    /// Depth test, if the target has a depth buffer.
    pub depth_test: Option<DepthTest>,
    /// Format of the target's depth buffer. It has no meaning if there is none.
    pub depth_format: DepthFormat,
    /// Blending, if the surface allows it.
    pub blend: Option<Blend>,
    /// Channels that are blended, as bits R, G, B, A.
    pub blended: u8,
    /// Blend constant as R, G, B, A bytes.
    pub blend_constant: [u8; 4],
    /// Bits of the stored word that are written.
    pub write_mask: u32,
    /// Channels that the written bits keep, as bits R, G, B, A.
    pub written: u8,
    /// The results of constant folding, which precedes the rest of planning.
    pub folded: DrawFacts,
}

impl PlannedDraw {
    /// Returns whether texture units can drop fragments, by the texture shader (TSH-10) or a colour key (KEY-1).
    pub fn kills(&self) -> bool {
        self.shader.as_ref().is_some_and(PlannedShader::kills) || self.units.iter().any(|unit| unit.state.kills())
    }

    /// Returns whether every covered pixel is stored, because nothing drops or tests fragments.
    pub fn stores_all(&self) -> bool {
        !self.kills() && self.alpha_test.is_none() && self.stencil_test.is_none() && self.depth_test.is_none()
    }
}

/// Facts about a draw that hold for every pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DrawFacts {
    /// Whether blending stores the source unchanged, so that the destination is not read.
    pub replaces: bool,
    /// Whether blending keeps every colour, so that none is written.
    pub keeps: bool,
    /// Channels of the fragment that are 0 in every pixel, as bits R, G, B, A.
    pub zero: u8,
    /// The reason why nothing of the draw can be seen, if nothing can.
    pub invisible: Option<Invisible>,
}

named! {
    /// The reason why nothing of a draw can be seen.
    pub enum Invisible {
        /// It has no triangles.
        NoTriangles = "it has no triangles",
        /// Its clips leave no pixels.
        NoPixels = "its clips leave no pixel",
        /// It writes neither colour nor depth nor stencil.
        NothingWritten = "it writes neither colour nor depth nor stencil",
        /// Its fragments are 0 and are added.
        AddsZero = "its source is 0 in every channel and blending keeps what is there",
        /// Its blending keeps the destination.
        KeepsDestination = "its blend keeps what is there, whatever the source",
    }
}

impl Plan {
    /// Returns the plan under other policies.
    #[must_use]
    pub fn under(self, policies: Policies) -> Plan {
        Plan { policies, ..self }
    }

    /// Returns the plan with only those channels blended that are stored, as with [`PlanOptions::prune`].
    #[must_use]
    pub fn blending_stored_channels(mut self) -> Plan {
        self.draws.iter_mut().for_each(|draw| draw.blended = draw.written);
        self
    }

    /// Returns the render targets, in the order of the scene.
    pub fn targets(&self) -> &[Target] {
        &self.targets
    }

    /// Returns the textures, in the order of the scene.
    pub fn textures(&self) -> &[Texture] {
        &self.textures
    }

    /// Returns the draws in order.
    pub fn draws(&self) -> &[PlannedDraw] {
        &self.draws
    }

    /// Returns whether a draw reads a texture that is a render target.
    pub fn reads_target(&self, planned: &PlannedDraw) -> bool {
        planned.units.iter().any(|unit| self.textures[unit.state.texture].image.target().is_some())
    }

    /// Plans a scene within the default [`Limits`], whoever made it.
    ///
    /// # Errors
    /// Returns everything in which the scene is not valid as [`Scene`] defines. If there is nothing, returns the
    /// vertices (at most eight for each draw) that are outside the limits of RAS-0.
    pub fn compile(scene: &Scene, options: &PlanOptions) -> Result<Plan, Vec<PlanError>> {
        Plan::compile_within(scene, options, &Limits::default())
    }

    /// Plans a scene within the given limits.
    ///
    /// # Errors
    /// Returns the same errors as [`compile`](Plan::compile).
    pub fn compile_within(scene: &Scene, options: &PlanOptions, limits: &Limits) -> Result<Plan, Vec<PlanError>> {
        let mut errors = check::check(scene, limits);
        if !errors.is_empty() {
            return Err(errors);
        }
        let mut draws = Vec::with_capacity(scene.draws.len());
        let black: Vec<u8> = scene.textures.iter().map(fold::black_channels).collect();
        let stray: Vec<bool> = scene.targets.iter().map(fold::begins_with_stray_bits).collect();
        for (index, draw) in scene.draws.iter().enumerate() {
            check_coordinates(scene, index, draw, &mut errors);
            match assemble(draw) {
                Ok(assembly) => draws.push(plan_draw(scene, draw, assembly, (&black, &stray), options)),
                Err(positions) => errors.extend(positions.into_iter().map(|p| {
                    let [x, y, _, w] = p.window;
                    let message =
                        format!("window position x = {x}, y = {y}, w = {w} lies outside the rasteriser's domain");
                    let help = match draw.positions {
                        Positions::Window => {
                            "keep |x| and |y| below 4096 pixels and w between 2^-20 and 2^20; filled triangles may have any w, below 0 in \
                             perspective, and reach 2^20 pixels"
                        }
                        Positions::Clip(_) => {
                            "keep w at most 2^20; what lies behind the viewer or far outside the view is cut off, \
                             as long as its numbers are not so large that none is left in 32 bits"
                        }
                    };
                    let error = PlanError::new("NB0322", "RAS-0", message, help);
                    PlanError { draw: Some(index), vertex: Some(p.vertex), ..error }
                })),
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        Ok(Plan {
            profile: scene.profile,
            policies: options.policies,
            targets: scene.targets.clone(),
            textures: scene.textures.clone(),
            draws,
        })
    }
}

/// Returns the columns and rows of a texture.
pub fn texture_size(scene: &Scene, texture: usize) -> (u32, u32) {
    match &scene.textures[texture].image {
        TextureImage::Texels(texels) => (texels.width, texels.height),
        TextureImage::Depth { target } => (scene.targets[*target].width, scene.targets[*target].height),
        TextureImage::Target { target } => {
            let (shown, texel) = (&scene.targets[*target], scene.textures[texture].format.bytes());
            let columns = surface::texel_columns(shown.width, shown.format.bytes(), texel);
            (columns.unwrap_or(shown.width), shown.height)
        }
    }
}

/// RAS-0 for texture coordinates: checks that they are finite, and at most 65536 texels if q is 1 and they are not a
/// direction.
fn check_coordinates(scene: &Scene, index: usize, draw: &Draw, errors: &mut Vec<PlanError>) {
    const MAX_ERRORS: usize = 8;
    let mut found = 0;
    let moves = |stage: &ShaderStage| matches!(stage.operation, ShaderOperation::BumpEnvironment { .. });
    for (unit, stage) in draw.textures.iter().zip(&draw.texture_shader) {
        if stage.operation == ShaderOperation::None {
            continue;
        }
        let sampled = unit.filter(|_| stage.operation.samples_own() || moves(stage));
        let texture = sampled.map(|unit| (&scene.textures[unit.texture], texture_size(scene, unit.texture)));
        for vertex in 0..draw.vertices.len() {
            let set = draw.vertices.coordinates(vertex, stage.coordinate_set);
            // TSH-7 ignores q.
            let plane = set[3] == 1.0 || moves(stage);
            let turns = sampled.is_some_and(|unit| unit.cylindrical_wrap != [false; 2]);
            let far = |n: usize, side: u32| plane && set[n].abs() > (TEXEL_LIMIT / i64::from(side)) as f32;
            let finite = set.iter().all(|c| c.is_finite());
            let outside = match texture {
                _ if !finite => true,
                Some((Texture { kind, .. }, _)) if stage.operation.takes_direction(*kind) => false,
                Some((Texture { kind: TextureKind::Rectangle, .. }, _)) => far(0, 1) || far(1, 1),
                Some((Texture { kind: TextureKind::ThreeDimensional, image, .. }, (width, height)))
                    if stage.operation != ShaderOperation::Sample2D =>
                {
                    let layers = if let TextureImage::Texels(texels) = image { texels.layers } else { 1 };
                    far(0, width) || far(1, height) || far(2, layers)
                }
                Some((_, (width, height))) => far(0, width) || far(1, height),
                None => false,
            };
            if turns && finite && set[3] != 1.0 && found < MAX_ERRORS {
                found += 1;
                let message = format!("a texture with a cylindrical wrap has q = {}", set[3]);
                let help = "what comes out of projected coordinates is not known: take q = 1";
                let error = PlanError::new("NB0402", "CYL-1", message, help);
                errors.push(PlanError { draw: Some(index), vertex: Some(vertex), ..error });
            }
            if outside && found < MAX_ERRORS {
                found += 1;
                let what = match texture {
                    Some((Texture { kind: TextureKind::TwoDimensional, name, .. }, (width, height))) if finite => {
                        format!(
                            "is more than 65536 texels of the {width} x {height} texture `{name}` away from its origin"
                        )
                    }
                    Some((Texture { name, .. }, _)) if finite => {
                        format!("is more than 65536 texels away from the origin of `{name}`")
                    }
                    _ => "is not a finite number".to_string(),
                };
                let message = format!("texture coordinate ({}, {}) {what}", set[0], set[1]);
                let help = "shift the coordinates by whole repeats, or split the geometry";
                let error = PlanError::new("NB0322", "RAS-0", message, help);
                errors.push(PlanError { draw: Some(index), vertex: Some(vertex), ..error });
            }
        }
    }
}

fn plan_draw(
    scene: &Scene,
    draw: &Draw,
    assembly: Assembly,
    (black, stray): (&[u8], &[bool]),
    options: &PlanOptions,
) -> PlannedDraw {
    let (target, has_stray) = (&scene.targets[draw.target], stray[draw.target]);
    let windows = windows::windows(draw, target);
    let state_mask = surface::write_mask(target.format, draw.color_mask);
    let state_blend = draw.blend.filter(|_| surface::blends(target.format));
    let depth_test = draw.depth_test.filter(|_| target.depth.is_some());
    let idle = |test: &StencilTest| test.function == CompareFunction::Always && !stencil::writes(test);
    let has_stencil = target.depth.is_some_and(|depth| depth.format.has_stencil());
    let stencil_test = draw.stencil_test.filter(|test| has_stencil && !(options.prune && idle(test)));
    let mut folded = DrawFacts::default();
    let computed = DrawValues::new(&draw.combiners, fold::initially_zero(draw, black));
    if options.prune {
        let written = written_channels(target.format, state_mask);
        folded.zero = computed.zero_fragment();
        let mut keeps_always = false;
        if let Some(blend) = &state_blend {
            (folded.replaces, keeps_always) = fold::blend(blend, draw.blend_constant, written, 0);
            let zero = if written & !folded.zero == 0 { folded.zero } else { 0 };
            folded.keeps = !has_stray && fold::blend(blend, draw.blend_constant, written, zero).1;
            keeps_always &= !has_stray;
        }
        folded.invisible = if assembly.triangles.is_empty() {
            Some(Invisible::NoTriangles)
        } else if windows.is_empty() {
            Some(Invisible::NoPixels)
        } else if depth_test.is_some_and(|test| test.write) || stencil_test.is_some_and(|test| stencil::writes(&test)) {
            None
        } else if written == 0 && (state_mask == 0 || !has_stray) {
            Some(Invisible::NothingWritten)
        } else if keeps_always {
            Some(Invisible::KeepsDestination)
        } else {
            folded.keeps.then_some(Invisible::AddsZero)
        };
    }
    let write_mask = if folded.keeps { 0 } else { state_mask };
    let blend = state_blend.filter(|_| !folded.replaces && !folded.keeps);
    let alpha_test = draw.alpha_test.filter(|t| !(options.prune && t.function == CompareFunction::Always));
    let written = written_channels(target.format, write_mask);
    let blended = if options.prune { written } else { 15 };
    let liveness = computed.liveness(draw, (target.format, alpha_test.is_some(), blend), written, options.prune);
    let sampled = |index: usize| draw.textures[index].filter(|_| draw.texture_shader[index].operation.samples());
    let units: Vec<PlannedUnit> = liveness
        .units
        .iter()
        .enumerate()
        .filter_map(|(index, live)| {
            let state = sampled(index).filter(|_| *live != 0)?;
            Some(plan_unit(scene, index, state, draw.texture_shader[index], *live))
        })
        .collect();
    let idle = |index: usize| match draw.texture_shader[index].operation {
        ShaderOperation::None => true,
        operation => operation.samples() && draw.textures[index].is_none(),
    };
    let shader = plan_shader(draw, &units, &liveness);
    PlannedDraw {
        name: draw.name.clone(),
        target: draw.target,
        surface: target.format,
        windows,
        assembly,
        shade_model: draw.shade_model,
        perspective: draw.perspective,
        cull: draw.cull,
        front_face: draw.front_face,
        polygon_stipple: draw.polygon_stipple.filter(|_| draw.topology.has_faces()),
        point_sprite: draw.point_sprite,
        primary: liveness.primary,
        secondary: liveness.secondary,
        fog_channels: liveness.fog,
        fog: draw.fog,
        units,
        shader,
        unbound: std::array::from_fn(|n| if idle(n) { liveness.units[n] } else { 0 }),
        unbound_color: [0, 0, 0, 255],
        yuv: liveness.yuv,
        spare0_alpha: liveness.spare0_alpha,
        undefined: liveness.undefined,
        stages: liveness.stages,
        program_origin: draw.program_origin.clone(),
        vertex_program: draw.vertex_program.is_some(),
        mux_select: draw.combiners.mux_select,
        final_combiner: liveness.final_combiner,
        alpha_test,
        stencil_test,
        depth_test,
        depth_format: target.depth.map_or(DepthFormat::Z16, |depth| depth.format),
        blend,
        blended,
        blend_constant: draw.blend_constant,
        write_mask,
        written,
        folded,
    }
}

/// Plans a unit with the image that it samples.
fn plan_unit(scene: &Scene, index: usize, state: TextureUnit, stage: ShaderStage, live: u8) -> PlannedUnit {
    let texture = &scene.textures[state.texture];
    let (width, height) = texture_size(scene, state.texture);
    let layers = match &texture.image {
        TextureImage::Texels(texels) => texels.layers,
        TextureImage::Target { .. } | TextureImage::Depth { .. } => 1,
    };
    let (count, border) = match &texture.image {
        TextureImage::Texels(texels) => (texels.levels, texels.border),
        TextureImage::Target { .. } | TextureImage::Depth { .. } => (1, false),
    };
    // TEX-20: of a volume a stage for two dimensions reads the first layer.
    let flat = texture.kind == TextureKind::ThreeDimensional && stage.operation == ShaderOperation::Sample2D;
    let (kind, layers) = if flat { (TextureKind::TwoDimensional, 1) } else { (texture.kind, layers) };
    // Levels that no lod can reach are left out.
    let reachable = if state.mip_filter == MipFilter::None { 1 } else { count };
    let (mut levels, face_words) = Level::chain(texture.format, width, height, count, border);
    levels.truncate(reachable as usize);
    PlannedUnit {
        index,
        state,
        stage,
        kind,
        format: texture.format,
        levels,
        face_words,
        layers,
        border,
        dithered: scene.profile == Profile::Nv2a,
        palette: state.palette.map(|palette| scene.palettes[palette].entries.clone()),
        live,
    }
}

/// Plans the texture shader of a draw. Returns `None` if its units only sample.
fn plan_shader(draw: &Draw, units: &[PlannedUnit], liveness: &Liveness) -> Option<PlannedShader> {
    let conventional = |stage: &ShaderStage| matches!(stage.operation, ShaderOperation::None | ShaderOperation::Sample);
    if draw.texture_shader.iter().all(conventional) {
        return None;
    }
    let stages = std::array::from_fn(|index| PlannedShaderStage {
        state: draw.texture_shader[index],
        unit: units.iter().position(|unit| unit.index == index),
        live: liveness.units[index],
        dots: liveness.dots[index],
        unit_normals: false,
        lights_alpha: false,
        signed_luminance: false,
    });
    Some(PlannedShader { stages })
}

/// Returns the channels R, G, B, A of the fragment that the written bits keep.
fn written_channels(format: SurfaceFormat, write_mask: u32) -> u8 {
    let (bits, kept) = (surface::channel_bits(format), surface::kept_channels(format));
    (0..4).filter(|n| bits[*n] & write_mask != 0 && kept >> n & 1 != 0).map(|n| 1 << n).sum()
}
