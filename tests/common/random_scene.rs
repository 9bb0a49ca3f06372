//! Random valid scenes that vary all of the state.
//!
//! A scene is built from a tape of choices, in which 0 always means the plainest choice. Shrinking sets ranges of the tape to 0, so a
//! failing scene loses what its failure does not need.

#[path = "random_stroke.rs"]
mod stroke;
#[path = "random_texture.rs"]
mod texture;
#[path = "random_wide.rs"]
pub mod wide;

use ninebit::plan::{Plan, PlanOptions};
use ninebit::raster::project::ClipPlane;
use ninebit::state::*;
use ninebit::vertex::fog::passed;
use proptest::prelude::*;
use proptest::strategy::{NewTree, ValueTree};
use proptest::test_runner::TestRunner;

/// Whether scenes contain per-pixel fog functions and texture shaders.
pub const FOG_FUNCTIONS: bool = true;
pub const TEXTURE_SHADERS: bool = true;

/// How vertices make triangles.
pub const TRIANGLES: [Topology; 6] = [
    Topology::Triangles,
    Topology::TriangleStrip,
    Topology::TriangleFan,
    Topology::Quads,
    Topology::QuadStrip,
    Topology::Polygon,
];

/// Numbers of tape words: shared by all draws, for each draw, for all vertices of a draw, for each vertex, for each stage, and for the
/// units of a draw.
const SHARED: usize = 1024;
const DRAW: usize = 1280;
const VERTICES: usize = 768;
const VERTEX: usize = 48;
const STAGE: usize = 64;
const UNITS: usize = 160;
/// Number of tape words for the lines, points and patterns of a draw.
const STROKE: usize = 112;
/// Number of tape words of a scene.
const PLAIN: usize = SHARED + 4 * DRAW + 4 * STROKE;

/// Returns valid scenes whose vertices lie in the domain of RAS-0, so that the guard band cuts nothing.
pub fn scene() -> BoxedStrategy<Scene> {
    const SIDES: u8 = ClipPlane::Left.bit() | ClipPlane::Right.bit() | ClipPlane::Top.bit() | ClipPlane::Bottom.bit();
    let fits = |scene: &Scene| {
        let plan = Plan::compile(scene, &PlanOptions::default());
        plan.is_ok_and(|plan| plan.draws().iter().all(|draw| draw.assembly.clipping.planes & SIDES == 0))
    };
    Tape(PLAIN).prop_map(|tape| build(&tape)).prop_filter("RAS-0", fits).boxed()
}

/// Returns scenes like [`scene`]s, without smooth edges and vertices behind the eye or far away: they are not printed.
pub fn sharp() -> BoxedStrategy<Scene> {
    let sharp = |mut scene: Scene| {
        for draw in &mut scene.draws {
            draw.smooth_polygons = false;
            if draw.lines.rasterization == LineRasterization::RectangularSmooth {
                draw.lines.rasterization = LineRasterization::Rectangular;
            }
            if matches!(draw.positions, Positions::Window) {
                let near = |n: f32| n.clamp(-4095.0, 4095.0);
                draw.vertices.map_positions(|[x, y, z, w]| [near(x), near(y), z, w.abs()]);
            }
        }
        scene
    };
    scene().prop_map(sharp).boxed()
}

/// A strategy for tapes of the given number of words.
#[derive(Debug)]
struct Tape(usize);

#[derive(Debug)]
struct TapeTree {
    tape: Vec<u32>,
    stretch: usize,
    at: usize,
    blanked: Option<(usize, Vec<u32>)>,
}

impl Strategy for Tape {
    type Tree = TapeTree;
    type Value = Vec<u32>;

    fn new_tree(&self, runner: &mut TestRunner) -> NewTree<Self> {
        let tape: Vec<u32> = (0..self.0).map(|_| runner.rng().next_u32()).collect();
        Ok(TapeTree { stretch: DRAW, tape, at: 0, blanked: None })
    }
}

impl ValueTree for TapeTree {
    type Value = Vec<u32>;

    fn current(&self) -> Vec<u32> {
        self.tape.clone()
    }

    fn simplify(&mut self) -> bool {
        while self.stretch > 0 {
            while self.at < self.tape.len() {
                let (from, to) = (self.at, self.tape.len().min(self.at + self.stretch));
                self.at = to;
                if self.tape[from..to].iter().any(|w| *w != 0) {
                    self.blanked = Some((from, self.tape[from..to].to_vec()));
                    self.tape[from..to].fill(0);
                    return true;
                }
            }
            (self.at, self.stretch) = (0, self.stretch / 2);
        }
        false
    }

    fn complicate(&mut self) -> bool {
        if let Some((from, words)) = self.blanked.take() {
            self.tape[from..from + words.len()].copy_from_slice(&words);
        }
        self.simplify()
    }
}

/// Reads words of a tape. After the end, every word is 0.
struct Choices<'a> {
    tape: &'a [u32],
}

impl<'a> Choices<'a> {
    fn word(&mut self) -> u32 {
        let Some((first, rest)) = self.tape.split_first() else { return 0 };
        self.tape = rest;
        *first
    }

    /// Takes the next `n` words as a tape of their own, so that later choices do not depend on how many of these are used.
    fn part(&mut self, n: usize) -> Choices<'a> {
        let (part, rest) = self.tape.split_at(n.min(self.tape.len()));
        self.tape = rest;
        Choices { tape: part }
    }

    fn below(&mut self, n: u32) -> u32 {
        self.word() % n
    }

    fn size(&mut self, from: u32, to: u32) -> u32 {
        from + self.below(to - from + 1)
    }

    /// Returns true in one of `n` cases.
    fn once_in(&mut self, n: u32) -> bool {
        self.below(n) == n - 1
    }

    fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len() as u32) as usize]
    }

    fn any<T: Named>(&mut self) -> T {
        self.pick(T::ALL)
    }

    fn byte(&mut self) -> u8 {
        let word = self.word();
        match word & 3 {
            0 => [0, 255, 128, 64, 127, 1, 32, 192][(word >> 8 & 7) as usize],
            _ => (word >> 8) as u8,
        }
    }

    fn bytes(&mut self) -> [u8; 4] {
        std::array::from_fn(|_| self.byte())
    }

    /// Returns a multiple of 2^-20 in [0, 1).
    fn unit(&mut self) -> f32 {
        (self.word() >> 12) as f32 / 1_048_576.0
    }

    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }
}

/// Builds the scene of a tape.
pub fn build(tape: &[u32]) -> Scene {
    let mut tape = Choices { tape };
    let mut c = tape.part(SHARED);
    let profile = if c.once_in(3) { Profile::Nv10 } else { Profile::Nv2a };
    let large = c.once_in(100);
    let targets: Vec<Target> = (0..c.size(1, 3)).map(|n| target(&mut c, profile, n, large && n == 0)).collect();
    let palettes: Vec<Palette> = (0..c.size(1, 2)).map(|n| texture::palette(&mut c, n)).collect();
    let mut textures: Vec<Texture> = (0..c.size(2, 4)).map(|n| texture::texels(&mut c, profile, n)).collect();
    textures.extend(targets.iter().enumerate().filter_map(|(n, t)| texture::view(&mut c, profile, n, t)));
    let count = [2, 3, 4, 1][c.below(4) as usize];
    let given = SceneParts { profile, targets: &targets, textures: &textures, palettes: palettes.len() };
    let mut draws_tape = tape.part(4 * DRAW);
    let mut draws: Vec<Draw> = (0..count).map(|n| draw(&mut draws_tape.part(DRAW), &given, n)).collect();
    for draw in &mut draws {
        stroke::stroke(&mut tape.part(STROKE), (profile, &textures), draw);
    }
    Scene { profile, targets, textures, palettes, draws }
}

/// The resources that draws refer to.
struct SceneParts<'a> {
    profile: Profile,
    targets: &'a [Target],
    textures: &'a [Texture],
    palettes: usize,
}

fn target(c: &mut Choices<'_>, profile: Profile, n: u32, large: bool) -> Target {
    let (width, height) = match c.below(4) {
        _ if large => (c.size(120, 150), c.size(140, 160)),
        0 => (16, 16),
        1 if c.once_in(3) => (1 << c.below(5), 1 << c.below(5)),
        1 => (8 << c.below(3), 8 << c.below(3)),
        2 => (c.size(4, 48), c.size(4, 48)),
        _ => (c.size(13, 48), c.size(11, 48)),
    };
    let formats: &[SurfaceFormat] = match profile {
        Profile::Nv2a => SurfaceFormat::ALL,
        Profile::Nv10 => &[
            SurfaceFormat::A8R8G8B8,
            SurfaceFormat::X8R8G8B8Z,
            SurfaceFormat::X8R8G8B8O,
            SurfaceFormat::R5G6B5,
            SurfaceFormat::B8,
        ],
    };
    let format = if c.once_in(2) { c.pick(formats) } else { SurfaceFormat::A8R8G8B8 };
    let depth = c.once_in(2).then(|| {
        let format = c.pick(&[DepthFormat::Z16, DepthFormat::Z24S8]);
        let full = (1_u32 << format.bits()) - 1;
        let clear = if c.once_in(3) { c.word() & full } else { full };
        DepthBuffer { format, clear, clear_stencil: 0 }
    });
    let clear_color = c.bytes();
    // One target in four has contents, which are derived from the clear colour and take no words of the tape, so that the other choices
    // stay the same.
    let seed = u32::from_le_bytes(clear_color);
    let words = |bits: u32| {
        (0..width * height).map(|n| seed.wrapping_add(n).wrapping_mul(0x9e37_79b1) >> (32 - bits)).collect()
    };
    let contents = clear_color[3].is_multiple_of(4).then(|| words(8 * format.bytes()));
    // The same of depths, where there are textures of such words.
    let has_depths = profile == Profile::Nv2a && clear_color[2].is_multiple_of(4);
    let bits = depth.filter(|_| has_depths).map(|depth| depth.format.stored_bits());
    let depth_contents = bits.map(words);
    let name = format!("target{n}");
    Target { name, clear_color, contents, depth, depth_contents, ..Target::new(width, height, format) }
}

fn draw(c: &mut Choices<'_>, given: &SceneParts<'_>, n: u32) -> Draw {
    let SceneParts { profile, targets, textures, .. } = *given;
    let mut vertex_tape = c.part(VERTICES);
    let target = c.below(targets.len() as u32) as usize;
    let surface = &targets[target];
    let usable: Vec<usize> = (0..textures.len())
        .filter(|t| !matches!(textures[*t].image, TextureImage::Target { target: other } if other == target))
        .collect();
    let styles: CoordinateStyles = std::array::from_fn(|_| c.below(16));
    let (textures, texture_shader) = texture::units(&mut c.part(UNITS), given, &usable, &styles);
    let topology = c.pick(&TRIANGLES);
    let (mut vertices, positions) = vertices(&mut vertex_tape, topology, surface, &styles);
    let (fog, beyond) = fog(c, profile);
    if let Some((index, coordinate)) = beyond {
        let count = vertices.len();
        vertices[index as usize % count].fog = coordinate;
    }
    match fog.function {
        // The vertices get the values that the vertex side computes from these coordinates.
        Some(function) if c.once_in(2) => {
            for vertex in &mut vertices {
                vertex.fog_coordinate = Some(vertex.fog);
                vertex.fog = passed(&function, profile, vertex.fog);
            }
        }
        // Most values of exponential fog are brought near 1, where its tables lie.
        Some(function) if !function.mode.is_linear() && function.p1 < 0.1 => {
            for vertex in &mut vertices {
                vertex.fog = 1.0 + vertex.fog / 8.0;
            }
        }
        _ => {}
    }
    let mut indices: Vec<u32> = (0..vertices.len() as u32).collect();
    if c.once_in(8) {
        for index in &mut indices {
            *index = c.below(vertices.len() as u32);
        }
    }
    let blend_allowed = !matches!(surface.format, SurfaceFormat::B8 | SurfaceFormat::G8B8);
    let equations = &BlendEquation::ALL[..if profile == Profile::Nv2a { 7 } else { 5 }];
    Draw {
        name: format!("draw{n}"),
        target,
        positions,
        vertices: vertices.into(),
        indices: indices.into(),
        topology,
        shade_model: if c.once_in(5) { ShadeModel::Flat } else { ShadeModel::Smooth },
        provoking_vertex: c.any(),
        perspective: c.below(3) != 0,
        cull: if c.once_in(6) { c.any() } else { Cull::None },
        front_face: c.any(),
        polygon_modes: PolygonModes::FILL,
        edge_flags: None,
        polygon_stipple: None,
        smooth_polygons: false,
        lines: Lines::default(),
        point_size: 8,
        point_sizes: None,
        point_rasterization: PointRasterization::Rectangular,
        point_sprite: false,
        scissor: c.once_in(5).then(|| Rectangle {
            x: c.below(surface.width.div_ceil(2)),
            y: c.below(surface.height.div_ceil(2)),
            width: c.size(1, 40),
            height: c.size(1, 40),
        }),
        window_clip: None,
        stencil_test: None,
        fog,
        textures,
        texture_shader,
        convert_yuv: false,
        alpha_test: c.once_in(5).then(|| AlphaTest { function: c.any(), reference: c.byte() }),
        depth_test: (surface.depth.is_some() && c.below(3) != 0).then(|| {
            let function = if c.once_in(2) { c.any() } else { CompareFunction::LessOrEqual };
            DepthTest::new(function, c.below(4) != 0)
        }),
        blend: (blend_allowed && c.once_in(3)).then(|| Blend {
            equation: c.pick(equations),
            source: c.any(),
            destination: c.any(),
        }),
        blend_constant: c.bytes(),
        color_mask: if c.once_in(5) { std::array::from_fn(|_| c.below(3) != 0) } else { [true; 4] },
        combiners: combiners(c, profile),
        program_origin: vec![],
        vertex_program: None,
    }
}

/// Returns random fog, and occasionally a fog coordinate that is not finite, with the number of its vertex.
fn fog(c: &mut Choices<'_>, profile: Profile) -> (Fog, Option<(u32, f32)>) {
    let mut c = c.part(16);
    let (enabled, color) = (c.once_in(2), [c.byte(), c.byte(), c.byte()]);
    let possible = FOG_FUNCTIONS;
    let extreme = c.once_in(12);
    let function = (possible && c.below(3) != 0).then(|| FogFunction {
        mode: c.any(),
        p0: match c.below(2) {
            _ if extreme => c.pick(&[1e30, -1e30, -100.0, 1e-30, 1.5, -1.5, -65535.0, -1e5]),
            0 => c.between(0.0, 3.0),
            _ => c.pick(&[1.5, 2.0, 1.0, 0.0, -1.0, 2.5]),
        },
        p1: match c.below(2) {
            _ if extreme => c.pick(&[1e30, -1e30, 1e-30, -1e-30, 1e5, -1e5]),
            0 => c.between(-1.0, 1.0),
            _ => c.pick(&[-0.125, -1.0, 0.25, 0.0, -0.090_168_44, 1e-9]),
        },
        p2: c.pick(&[0.0, 0.0, 0.0, 0.015_625, -0.01]),
        per_vertex: profile == Profile::Nv10 || c.once_in(4),
    });
    let beyond = (function.is_some() && c.once_in(16))
        .then(|| (c.word(), c.pick(&[f32::INFINITY, f32::NEG_INFINITY, f32::NAN])));
    (Fog { enabled, color, function }, beyond)
}

// ---- geometry ----

/// The kinds of coordinates that [`coordinates`] generates for each coordinate set.
type CoordinateStyles = [u32; 4];

fn vertices(
    c: &mut Choices<'_>,
    topology: Topology,
    surface: &Target,
    styles: &CoordinateStyles,
) -> (Vec<Vertex>, Positions) {
    let (width, height) = (surface.width as f32, surface.height as f32);
    let count = match topology {
        Topology::Triangles => 3 * c.size(1, 4),
        Topology::TriangleStrip | Topology::TriangleFan | Topology::Polygon => c.size(3, 8),
        Topology::Quads => 4 * c.size(1, 3),
        Topology::QuadStrip => 2 * c.size(2, 5),
        Topology::Points | Topology::Lines | Topology::LineStrip | Topology::LineLoop => c.size(2, 8),
    } as usize;
    // Styles 6 and 7, which leave the shape or go far away, are half as frequent.
    let style = c.pick(&[0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 3, 4, 1, 5]);
    let (w_style, z_style, colors, clip) = (c.below(6), c.below(4), c.below(4), c.once_in(4));
    let fog_scale = c.pick(&[1.0, 1.0, 8.0, 100.0]);
    let places = places(c, topology, style, count, [width, height]);
    let same_w = w(c, w_style);
    let near = c.once_in(2);
    let port = port(c, [width, height]);
    let vertices = (0..count)
        .map(|k| {
            let mut c = c.part(VERTEX);
            let [x, y] = places[k];
            let w = if w_style < 3 { same_w } else { w(&mut c, w_style) };
            let z = match z_style {
                0 => 0.5,
                1 => c.below(9) as f32 / 8.0,
                2 => c.unit(),
                _ => c.between(-0.25, 1.25),
            };
            let mut position = [x, y, z, w];
            if clip {
                position = to_clip(&mut c, [x / width, y / height, z], w_style, near);
            }
            Vertex {
                position,
                diffuse: color(&mut c, colors),
                specular: color(&mut c, colors),
                fog_coordinate: None,
                fog: fog_scale * if c.once_in(2) { c.between(-0.2, 1.2) } else { c.below(17) as f32 / 16.0 },
                texture_coordinates: std::array::from_fn(|set| coordinates(&mut c, styles[set], [x, y])),
            }
        })
        .collect();
    (vertices, if clip { Positions::Clip(port) } else { Positions::Window })
}

/// Returns the positions of the vertices on the target, in pixels.
fn places(
    c: &mut Choices<'_>,
    topology: Topology,
    style: u32,
    count: usize,
    [width, height]: [f32; 2],
) -> Vec<[f32; 2]> {
    let mut out = Vec::with_capacity(count);
    let mut shape = [0.0; 4];
    let turn = c.below(4) as usize;
    let mirrored = c.once_in(2);
    for k in 0..count {
        let mut c = c.part(4);
        // Two of the eight styles do not use a shape.
        match style {
            6 => {
                out.push([c.between(-0.5, 1.5) * width, c.between(-0.5, 1.5) * height]);
                continue;
            }
            7 => {
                let far = if c.once_in(2) { 4095.0 } else { 100.0 };
                out.push([c.between(-far, far), c.between(-far, far)]);
                continue;
            }
            _ => {}
        }
        let corners = match topology {
            Topology::Triangles => 3,
            Topology::Quads => 4,
            _ => count,
        };
        if k % corners == 0 {
            // Origin and sides: the target, twice the target, or small whole numbers, some of whose sides are powers of two.
            shape = match style {
                0 => [0.0, 0.0, width, height],
                1 => [0.0, 0.0, 2.0 * width, 2.0 * height],
                _ => {
                    let sides = [16.0, 32.0, 8.0, 20.0, 64.0, 4.0, 40.0, 10.0];
                    [c.below(8) as f32 - 4.0, c.below(8) as f32 - 4.0, c.pick(&sides), c.pick(&sides)]
                }
            };
        }
        let k = k % corners;
        let (u, v) = match topology {
            Topology::Triangles => [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)][(k + turn) % 3],
            Topology::Quads => [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)][(k + turn) % 4],
            Topology::TriangleStrip | Topology::QuadStrip => {
                let columns = (count / 2).max(1).next_power_of_two() as f32;
                ((k / 2) as f32 / columns * 1.25, (k % 2) as f32)
            }
            _ => {
                let ring =
                    [(0.5, 0.5), (0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, 0.5), (1.0, 1.0), (0.5, 1.0), (0.0, 1.0)];
                ring[k % 8]
            }
        };
        let (u, v) = if mirrored { (v, u) } else { (u, v) };
        let mut place = [shape[0] + u * shape[2], shape[1] + v * shape[3]];
        for axis in &mut place {
            *axis += match style {
                3 => c.below(33) as f32 / 16.0 - 1.0,
                4 => c.between(-2.0, 2.0),
                _ => 0.0,
            };
        }
        if style == 5 {
            // A sliver: the vertices lie near a line.
            place[1] = shape[1] + u * shape[3] + c.between(-0.6, 0.6);
        }
        out.push(place);
    }
    out
}

fn w(c: &mut Choices<'_>, style: u32) -> f32 {
    match style {
        0 => 1.0,
        1 => c.pick(&[2.0, 0.25, 4.0, 1024.0]),
        2 => c.pick(&[3.0, 1.7, 0.3, 5.000_001]),
        3 => c.pick(&[1.0, 2.0, 4.0]),
        4 => c.between(0.25, 8.0),
        _ => c.pick(&[1.0, 1.0, 3.0, 1.0 / 1_048_576.0, 1_048_576.0, 100.0]),
    }
}

fn port(c: &mut Choices<'_>, [width, height]: [f32; 2]) -> Viewport {
    let (near, far) = c.pick(&[(0.0, 1.0), (1.0, 0.0), (0.25, 0.75)]);
    let (clip_depth, depth_clamp) = (ClipDepth::MinusOneToOne, true);
    match c.below(3) {
        0 => Viewport { x: 0.0, y: 0.0, width, height, near, far, clip_depth, depth_clamp },
        1 => Viewport { x: 0.531_25, y: 0.531_25, width, height, near, far, clip_depth, depth_clamp },
        _ => Viewport { x: -2.0, y: 3.0, width: 32.0, height: 16.0, near, far, clip_depth, depth_clamp },
    }
}

/// Returns a clip position for a position in units of the target. `near` moves it close to the plane at which w is clipped.
fn to_clip(c: &mut Choices<'_>, [u, v, z]: [f32; 3], w_style: u32, near: bool) -> [f32; 4] {
    let (x, y, z) = (2.0 * u - 1.0, 1.0 - 2.0 * v, 2.0 * z - 1.0);
    if near {
        let unit = 1.0 / 1_048_576.0;
        let w = c.pick(&[2.0, 4.0, 1.0, 3.3, 0.5, -1.0, 0.0, -2.5]);
        let reach = f32::max(w, 1.0) * unit;
        return [x.clamp(-8.0, 8.0) * reach, y.clamp(-8.0, 8.0) * reach, z * reach, w * unit];
    }
    let w = if w_style >= 5 { 1.5 } else { w(c, w_style) };
    [x * w, y * w, z * w, w]
}

fn color(c: &mut Choices<'_>, style: u32) -> VertexColor {
    let mut c = c.part(4);
    match style {
        0 => VertexColor::Bytes(std::array::from_fn(|_| c.pick(&[255, 0, 128, 64, 32, 192]))),
        3 => VertexColor::Floats(std::array::from_fn(|_| {
            if c.once_in(2) {
                c.between(-0.1, 1.1)
            } else {
                c.pick(&[1.0, 0.0, 0.5, 0.1, 0.3, 0.700_000_05, 2.0, -3.0])
            }
        })),
        _ => VertexColor::Bytes(std::array::from_fn(|_| c.word() as u8)),
    }
}

/// Returns texture coordinates s, t, r, q.
fn coordinates(c: &mut Choices<'_>, style: u32, [x, y]: [f32; 2]) -> [f32; 4] {
    let mut c = c.part(8);
    let (x, y) = (x.clamp(-256.0, 256.0), y.clamp(-256.0, 256.0));
    let one_to_one = [x / 16.0, y / 16.0, 0.0, 1.0];
    match style {
        0 => one_to_one,
        1 => [c.below(17) as f32 / 8.0, c.below(17) as f32 / 8.0, 0.0, 1.0],
        2 | 3 => [c.between(-3.0, 3.0), c.between(-3.0, 3.0), 0.5, 1.0],
        4 => {
            let far = c.pick(&[1023.0, 4095.0]);
            [c.between(-far, far), c.pick(&[0.0, far + 1.0, -far - 1.0, 1.0 / 512.0]), 0.0, 1.0]
        }
        5 => {
            // Projected coordinates with the same ratios for every q, so that ties are preserved.
            let q = c.pick(&[1.0, 2.0, 4.0, 0.5]);
            [one_to_one[0] * q, one_to_one[1] * q, 0.0, q]
        }
        6 => [c.between(-2.0, 2.0), c.below(9) as f32 / 4.0, 0.0, c.pick(&[1.0, -1.0, 2.0, 0.0, 3.0, 0.5, -2.0])],
        7 => [c.between(-2.0, 2.0), c.between(-2.0, 2.0), 0.0, c.between(-0.5, 3.0)],
        // Texels of a rectangle. For other textures the image repeats many times.
        8 => [x, y, 0.5, 1.0],
        9 => [x / 4.0 + c.between(-0.5, 0.5), y * 0.75, 0.25, 1.0],
        // Minified, in both directions or more in one.
        10 => [x / 5.0, y / 16.0, 0.0, 1.0],
        11 => [x / 3.0 + c.between(-0.2, 0.2), y / 7.0 + c.between(-0.2, 0.2), 0.0, c.pick(&[1.0, 1.0, 1.5])],
        // Directions: arbitrary ones, ones on edges and corners of the cube, and ones that cross several faces over the target.
        12 => [c.between(-1.0, 1.0), c.between(-1.0, 1.0), c.between(-1.0, 1.0), c.between(-1.0, 2.0)],
        13 => {
            let steps = [0.0, 1.0, -1.0, 0.5, -0.5];
            [c.pick(&steps), c.pick(&steps), c.pick(&steps), c.pick(&[1.0, 0.0, -1.0])]
        }
        14 => [x / 8.0 - 1.0, 1.0 - y / 8.0, c.pick(&[1.0, 1.0, -1.0, 0.25]), 1.0],
        // Rows of a matrix that is nearly the identity, with the eye in q.
        _ => {
            let row = c.below(3) as usize;
            let mut out =
                [c.between(-0.25, 0.25), c.between(-0.25, 0.25), c.between(-0.25, 0.25), c.between(-1.0, 1.0)];
            out[row] = c.pick(&[1.0, -1.0, 0.5]);
            // Some scales are so large or so small that the dot products overflow.
            let scale = c.pick(&[1.0, 1.0, 1.0, 1.0, 1.0, 1e-25, 300.0, 1e20]);
            out.map(|x| x * scale)
        }
    }
}

// ---- combiners ----

fn combiners(c: &mut Choices<'_>, profile: Profile) -> Combiners {
    if c.below(2) == 0 {
        return showing(c, profile);
    }
    let count = match profile {
        Profile::Nv10 => c.size(1, 2),
        Profile::Nv2a if c.once_in(3) => c.size(1, 8),
        Profile::Nv2a => c.size(1, 3),
    };
    let mux_select = c.any();
    let mut constants = [c.bytes(), c.bytes()];
    let final_combiner = FinalCombiner { constants, ..final_combiner(c, profile) };
    let stages = (0..count)
        .map(|_| {
            let mut c = c.part(STAGE);
            if profile == Profile::Nv2a {
                constants = [c.bytes(), c.bytes()];
            }
            stage(&mut c, profile, constants)
        })
        .collect();
    Combiners { stages, mux_select, final_combiner }
}

/// Returns one stage that shows two units, or fog, nearly unchanged.
fn showing(c: &mut Choices<'_>, profile: Profile) -> Combiners {
    let mut units = vec![Register::Texture0, Register::Texture1];
    if profile == Profile::Nv2a {
        units.extend([Register::Texture2, Register::Texture3]);
    }
    let (first, second) = (c.pick(&units), c.pick(&units));
    let mapping = c.pick(&[InputMapping::UnsignedIdentity, InputMapping::SignedIdentity, InputMapping::SignedNegate]);
    let halved = c.once_in(2);
    let portion = |plain: Component, component: Component| {
        let one = CombinerInput { mapping: InputMapping::UnsignedInvert, ..CombinerInput::zero(plain) };
        let shown = |register| CombinerInput { register, component, mapping };
        let other = if first == second { CombinerInput::zero(plain) } else { shown(second) };
        let scale = if halved { Scale::Half } else { Scale::One };
        Portion { inputs: [shown(first), one, other, one], sum_output: Register::Spare0, scale, ..Portion::idle(plain) }
    };
    let stage = GeneralStage {
        rgb: portion(Component::Rgb, Component::Rgb),
        alpha: portion(Component::Blue, Component::Alpha),
        constants: [[0; 4]; 2],
    };
    let input = |register, component| FinalInput { register, component, invert: false };
    let mut inputs = [input(FinalRegister::Zero, Component::Rgb); 6];
    inputs[3] = input(FinalRegister::Spare0, Component::Rgb);
    let g = match c.below(3) {
        0 => input(FinalRegister::Fog, Component::Alpha),
        _ => input(FinalRegister::Spare0, Component::Alpha),
    };
    Combiners {
        stages: vec![stage],
        mux_select: MuxSelect::Msb,
        final_combiner: FinalCombiner {
            inputs,
            g,
            color_sum_clamp: false,
            invert_spare0: false,
            invert_secondary: false,
            constants: [[0; 4]; 2],
        },
    }
}

fn stage(c: &mut Choices<'_>, profile: Profile, constants: [[u8; 4]; 2]) -> GeneralStage {
    let mut rgb = portion(c, profile, true);
    let alpha = portion(c, profile, false);
    if profile == Profile::Nv2a {
        let free =
            |d: Register| d != Register::Zero && ![alpha.ab_output, alpha.cd_output, alpha.sum_output].contains(&d);
        rgb.ab_blue_to_alpha = c.once_in(4) && free(rgb.ab_output);
        rgb.cd_blue_to_alpha = c.once_in(4) && free(rgb.cd_output);
    }
    GeneralStage { rgb, alpha, constants }
}

fn portion(c: &mut Choices<'_>, profile: Profile, rgb: bool) -> Portion {
    let inputs = std::array::from_fn(|_| input(c, profile, rgb));
    let mut free: Vec<Register> = Register::ALL
        .iter()
        .copied()
        .filter(|r| !matches!(r, Register::Zero | Register::ConstantColor0 | Register::ConstantColor1 | Register::Fog))
        .filter(|r| profile == Profile::Nv2a || !matches!(r, Register::Texture2 | Register::Texture3))
        .collect();
    // SPARE0 and SPARE1 come first, so that a result is likely to be read.
    free.reverse();
    let mut output = |written: bool| {
        let place = if c.once_in(3) { c.below(free.len() as u32) } else { c.below(2) };
        if written { free.remove(place as usize) } else { Register::Zero }
    };
    let sum_output = output(true);
    let ab_output = output(true);
    let cd_output = output(true);
    let keep = c.below(8);
    let scale = if c.once_in(2) { c.any() } else { Scale::One };
    let bias = matches!(scale, Scale::One | Scale::Two) && c.once_in(3);
    Portion {
        inputs,
        sum_output: if keep == 7 { Register::Zero } else { sum_output },
        ab_output: if keep & 1 == 1 { ab_output } else { Register::Zero },
        cd_output: if keep & 2 == 2 { cd_output } else { Register::Zero },
        ab_dot_product: rgb && c.once_in(5),
        cd_dot_product: rgb && c.once_in(5),
        mux: c.once_in(4),
        scale,
        bias: if bias { Bias::NegativeHalf } else { Bias::None },
        ab_blue_to_alpha: false,
        cd_blue_to_alpha: false,
    }
}

fn input(c: &mut Choices<'_>, profile: Profile, rgb: bool) -> CombinerInput {
    let mut c = c.part(4);
    let mut readable = vec![
        Register::PrimaryColor,
        Register::Texture0,
        Register::Texture1,
        Register::SecondaryColor,
        Register::Spare0,
        Register::Spare1,
        Register::ConstantColor0,
        Register::ConstantColor1,
        Register::Fog,
        Register::Zero,
    ];
    if profile == Profile::Nv2a {
        readable.extend([Register::Texture2, Register::Texture3]);
    }
    let register = c.pick(&readable);
    let plain = if rgb { Component::Rgb } else { Component::Blue };
    let alpha = register != Register::Fog && (register != Register::SecondaryColor || profile == Profile::Nv2a);
    let wanted = if rgb { c.once_in(3) } else { c.below(3) != 2 };
    CombinerInput {
        register,
        component: if alpha && wanted { Component::Alpha } else { plain },
        mapping: if c.once_in(2) { c.any() } else { InputMapping::UnsignedIdentity },
    }
}

fn final_combiner(c: &mut Choices<'_>, profile: Profile) -> FinalCombiner {
    let mut input = |sums: bool, plain: Component, favourite: FinalRegister| {
        let mut c = c.part(4);
        let readable: Vec<FinalRegister> = FinalRegister::ALL
            .iter()
            .copied()
            .filter(|r| sums || !matches!(r, FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF))
            .filter(|r| profile == Profile::Nv2a || !matches!(r, FinalRegister::Texture2 | FinalRegister::Texture3))
            .collect();
        let register = if c.once_in(2) { c.pick(&readable) } else { favourite };
        let alpha = match register {
            FinalRegister::SecondaryColor => profile == Profile::Nv2a,
            FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF => false,
            _ => true,
        };
        let wanted = c.below(3) == if plain == Component::Blue { 1 } else { 2 };
        let component = if alpha && wanted { Component::Alpha } else { plain };
        FinalInput { register, component, invert: c.once_in(4) }
    };
    let inputs = [
        input(true, Component::Rgb, FinalRegister::PrimaryColor),
        input(true, Component::Rgb, FinalRegister::Spare0),
        input(true, Component::Rgb, FinalRegister::Spare0PlusSecondary),
        input(true, Component::Rgb, FinalRegister::Zero),
        input(false, Component::Rgb, FinalRegister::PrimaryColor),
        input(false, Component::Rgb, FinalRegister::Texture0),
    ];
    let g = input(false, Component::Blue, FinalRegister::Spare0);
    FinalCombiner {
        inputs,
        g,
        color_sum_clamp: c.once_in(2),
        invert_spare0: c.once_in(4),
        invert_secondary: c.once_in(4),
        constants: [[0; 4]; 2],
    }
}
