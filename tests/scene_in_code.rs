//! Tests scenes that are built in code. `Plan::compile` plans any scene or says why it cannot, and every plan can be drawn.
//!
//! A normal run takes 1,500 valid random scenes and breaks each in one to four places. `NINEBIT_CODE_SCENES` sets another number,
//! `NINEBIT_CODE_SEED` selects others.
use crate::settings;
use ninebit_test_support::random_scene;

use ninebit::engine::{Engine, RenderOptions, render, trace};
use ninebit::plan::{Plan, PlanError, PlanOptions};
use ninebit::state::*;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

fn compile(scene: &Scene) -> Result<Plan, Vec<PlanError>> {
    Plan::compile(scene, &PlanOptions::default())
}

/// Returns a texture of 4 x 4 texels of one colour.
fn texture() -> Texture {
    let texture = Texture::from_words(TextureFormat::A8R8G8B8, [4, 4], vec![0xff80_4020; 16]);
    Texture { name: "grey".to_owned(), ..texture }
}

const STENCIL_TEST: StencilTest = StencilTest {
    function: CompareFunction::Equal,
    reference: 1,
    mask: 255,
    write_mask: 255,
    fail: StencilOperation::Zero,
    depth_fail: StencilOperation::Keep,
    pass: StencilOperation::Increment,
};

/// Returns a scene with a textured triangle on 8 x 8 pixels.
fn plain(profile: Profile) -> Scene {
    let depth = Some(DepthBuffer { format: DepthFormat::Z24S8, clear: 0xff_ffff, clear_stencil: 0 });
    let target = |name: &str| Target { name: name.to_owned(), depth, ..Target::new(8, 8, SurfaceFormat::A8R8G8B8) };
    let stages = [true, false, false, false];
    let mut stage = GeneralStage {
        rgb: Portion::idle(Component::Rgb),
        alpha: Portion::idle(Component::Alpha),
        constants: [[0; 4]; 2],
    };
    stage.rgb.inputs[0].register = Register::Texture0;
    stage.rgb.inputs[1].mapping = InputMapping::UnsignedInvert;
    stage.rgb.ab_output = Register::Spare0;
    let places = [[0.0, 0.0], [16.0, 0.0], [0.0, 16.0]];
    let vertices: Vec<Vertex> =
        places.iter().map(|[x, y]| Vertex { position: [*x, *y, 0.5, 1.0], ..Vertex::default() }).collect();
    let draw = Draw {
        vertices: vertices.into(),
        indices: [0, 1, 2].into(),
        textures: [Some(TextureUnit::new(0)), None, None, None],
        texture_shader: std::array::from_fn(|n| ShaderStage::conventional(n, stages[n])),
        combiners: Combiners {
            stages: vec![stage],
            mux_select: MuxSelect::Msb,
            final_combiner: FinalCombiner::initial([[0; 4]; 2]),
        },
        ..Draw::default()
    };
    let shown = Texture { name: "shown".to_owned(), image: TextureImage::Target { target: 1 }, ..texture() };
    let entries = vec![0; 256].into();
    Scene {
        profile,
        targets: vec![target("frame"), target("other")],
        textures: vec![texture(), shown],
        palettes: vec![Palette { name: "colours".to_owned(), entries }],
        draws: vec![draw],
    }
}

/// A part of the expected error, and the change of the plain scene that causes it.
type Case = (&'static str, fn(&mut Scene));

fn texels(scene: &mut Scene) -> &mut Texels {
    match &mut scene.textures[0].image {
        TextureImage::Texels(texels) => texels,
        TextureImage::Target { .. } | TextureImage::Depth { .. } => panic!("texels"),
    }
}

fn unit(scene: &mut Scene) -> &mut TextureUnit {
    scene.draws[0].textures[0].as_mut().unwrap()
}

/// Moves the first vertex.
fn put(scene: &mut Scene, position: [f32; 4]) {
    scene.draws[0].vertices.update(|index, vertex| {
        if index == 0 {
            vertex.position = position;
        }
    });
}

fn set(scene: &mut Scene, coordinates: [f32; 4]) {
    scene.draws[0].vertices.update(|_, vertex| vertex.texture_coordinates[0] = coordinates);
}

/// Changes that each break one invariant of a scene.
const CASES: &[Case] = &[
    ("NB0212: draw 0: the draw goes into target 0 of 0", |s| s.targets.clear()),
    ("the fog factor of vertex 1 is no number", |s| {
        let at = |n: usize| Vertex { fog: if n == 1 { f32::NAN } else { 1.0 }, ..s.draws[0].vertices.at(n) };
        s.draws[0].vertices = [0, 1, 2].map(at).to_vec().into();
        s.draws[0].fog.enabled = true;
    }),
    ("17 render targets are more than 16", |s| s.targets = vec![s.targets[0].clone(); 17]),
    ("4097 draws are more than 4096", |s| s.draws = vec![s.draws[0].clone(); 4097]),
    ("4097 textures are more than 4096", |s| s.textures = vec![s.textures[0].clone(); 4097]),
    ("the width of target `frame` is 0", |s| s.targets[0].width = 0),
    ("the height of target `frame` is 0", |s| s.targets[0].height = 0),
    ("the width of target `frame` is 1073741824", |s| (s.targets[0].width, s.targets[0].height) = (1 << 30, 1 << 30)),
    ("the width of target `frame` is 4097", |s| s.targets[0].width = 4097),
    ("the targets take", |s| {
        for target in &mut s.targets {
            (target.width, target.height) = (4096, 4096);
        }
        s.targets.push(s.targets[0].clone());
    }),
    ("target `frame` clears a stencil that Z16 does not have", |s| {
        s.targets[0].depth = Some(DepthBuffer { format: DepthFormat::Z16, clear: 0, clear_stencil: 1 });
    }),
    ("a window clip has 1 to 8 rectangles, not 0", |s| {
        s.draws[0].window_clip = Some(WindowClip { rectangles: vec![], exclusive: false });
    }),
    ("a window clip has 1 to 8 rectangles, not 9", |s| {
        let rectangle = Rectangle { x: 0, y: 0, width: 1, height: 1 };
        s.draws[0].window_clip = Some(WindowClip { rectangles: vec![rectangle; 9], exclusive: true });
    }),
    ("target `frame` begins with 3 words", |s| s.targets[0].contents = Some(vec![0; 3].into())),
    ("target `other` begins with 0x100 at word 1", |s| {
        let pixels = (s.targets[1].width * s.targets[1].height) as usize;
        let mut words = vec![0xff; pixels];
        words[1] = 0x100;
        (s.targets[1].format, s.targets[1].contents) = (SurfaceFormat::B8, Some(words.into()));
        s.textures[1].format = TextureFormat::L8;
    }),
    ("target `frame` has contents of a depth buffer, and no depth buffer", |s| {
        let pixels = (s.targets[0].width * s.targets[0].height) as usize;
        (s.targets[0].depth, s.targets[0].depth_contents) = (None, Some(vec![0; pixels].into()));
        s.draws.iter_mut().for_each(|draw| (draw.depth_test, draw.stencil_test) = (None, None));
    }),
    ("the depth buffer of target `frame` begins with 0x10000 at word 0", |s| {
        let pixels = (s.targets[0].width * s.targets[0].height) as usize;
        s.targets[0].depth = Some(DepthBuffer { format: DepthFormat::Z16, clear: 0, clear_stencil: 0 });
        s.targets[0].depth_contents = Some(vec![1 << 16; pixels].into());
        s.draws.iter_mut().for_each(|draw| draw.stencil_test = None);
    }),
    ("target `frame` clears its depth to 0x1000000", |s| s.targets[0].depth.as_mut().unwrap().clear = 1 << 24),
    ("palette `colours` has 3 entries", |s| s.palettes[0].entries = vec![0; 3].into()),
    ("palette `colours` has 0 entries", |s| s.palettes[0].entries = vec![].into()),
    ("texture `grey`: a texture cannot be 3 x 4 (TEX-7)", |s| texels(s).width = 3),
    ("a texture cannot be 0 x 4", |s| texels(s).width = 0),
    ("a texture of 8192 x 4 is too large", |s| texels(s).width = 8192),
    ("of 1073741824 x 1073741824", |s| (texels(s).width, texels(s).height) = (1 << 30, 1 << 30)),
    ("texture `grey`: faces of a cube map cannot be 4 x 8", |s| {
        (s.textures[0].kind, texels(s).height) = (TextureKind::Cube, 8)
    }),
    ("texture `grey`: a rectangle texture cannot be DXT1", |s| {
        (s.textures[0].kind, s.textures[0].format) = (TextureKind::Rectangle, TextureFormat::Dxt1);
    }),
    ("texture `grey` has 0 levels", |s| texels(s).levels = 0),
    ("texture `grey` has 4 levels", |s| texels(s).levels = 4),
    ("texture `grey` has 4294967295 levels", |s| texels(s).levels = u32::MAX),
    ("a rectangle texture cannot have 2 levels", |s| {
        (s.textures[0].kind, texels(s).levels) = (TextureKind::Rectangle, 2)
    }),
    ("texture `grey` has 15 words", |s| texels(s).words = vec![0; 15].into()),
    ("texture `grey` has 0 words", |s| texels(s).words = vec![].into()),
    ("texture `grey` has 17 words", |s| texels(s).words = vec![0; 17].into()),
    ("texture `grey` has 16 words", |s| s.textures[0].kind = TextureKind::Cube),
    ("texture `grey` has 16 words", |s| texels(s).border = true),
    ("a texture with border texels cannot be Cube", |s| {
        (s.textures[0].kind, texels(s).border) = (TextureKind::Cube, true);
    }),
    ("word 0 of texture `grey` is 0xff804020", |s| s.textures[0].format = TextureFormat::R5G6B5),
    ("texture `shown` shows target 7 of 2", |s| s.textures[1].image = TextureImage::Target { target: 7 }),
    ("texture `shown` shows target `other` as Cube", |s| s.textures[1].kind = TextureKind::Cube),
    ("texture `shown` shows target `other` as TwoDimensional, P8", |s| {
        (s.textures[1].format, s.targets[1].format) = (TextureFormat::P8, SurfaceFormat::B8);
    }),
    ("texture `shown` shows target `other` as TwoDimensional, R5G6B5", |s| {
        s.textures[1].format = TextureFormat::R5G6B5
    }),
    ("texture `shown`: a texture cannot be 8 x 9", |s| s.targets[1].height = 9),
    ("NB0212: draw 0: the draw goes into target 7 of 2", |s| s.draws[0].target = 7),
    ("draw 0: index 2 is 99, and the draw has 3 vertices (RAS-4)", |s| s.draws[0].indices = [0, 1, 99].into()),
    ("index 0 is 0, and the draw has 0 vertices", |s| s.draws[0].vertices = Vertices::new()),
    ("the combiners have at least one general stage", |s| s.draws[0].combiners.stages.clear()),
    ("9 general stages", |s| s.draws[0].combiners.stages = vec![s.draws[0].combiners.stages[0]; 9]),
    ("Fog cannot be written", |s| s.draws[0].combiners.stages[0].rgb.cd_output = Register::Fog),
    ("two results go to Spare0", |s| s.draws[0].combiners.stages[0].rgb.cd_output = Register::Spare0),
    ("an alpha portion has no RGB", |s| s.draws[0].combiners.stages[0].alpha.inputs[0].component = Component::Rgb),
    ("bias NegativeHalf does not go with", |s| {
        (s.draws[0].combiners.stages[0].rgb.bias, s.draws[0].combiners.stages[0].rgb.scale) =
            (Bias::NegativeHalf, Scale::Four);
    }),
    ("unit 0 samples texture 99 of 2", |s| unit(s).texture = 99),
    ("texture `grey`: a texture of format A8R8G8B8 reads no palette", |s| unit(s).palette = Some(0)),
    ("the texture `grey` is of format P8 and has no palette", |s| {
        (s.textures[0].format, texels(s).words) = (TextureFormat::P8, vec![1; 16].into());
    }),
    ("unit 0 reads palette 4 of 1", |s| {
        (s.textures[0].format, texels(s).words) = (TextureFormat::P8, vec![1; 16].into());
        unit(s).palette = Some(4);
    }),
    ("unit 0 samples the target that the draw goes into", |s| (unit(s).texture, s.draws[0].target) = (1, 1)),
    ("unit 0 has lod_bias 4096", |s| unit(s).lod_bias = 4096),
    ("unit 0 has lod_bias 0, min_lod -1", |s| unit(s).min_lod = -1),
    ("min_lod 9, max_lod 8", |s| (unit(s).min_lod, unit(s).max_lod) = (9, 8)),
    ("max_lod 4096", |s| unit(s).max_lod = 4096),
    ("stage 0 takes coordinate set 4", |s| s.draws[0].texture_shader[0].coordinate_set = 4),
    ("stage 2 takes coordinate set 18446744073709551615", |s| {
        s.draws[0].texture_shader[2].coordinate_set = u64::MAX as usize;
    }),
    ("stage 1 cannot read unit 1", |s| s.draws[0].texture_shader[1].previous = 1),
    ("stage 3 cannot read unit 99", |s| s.draws[0].texture_shader[3].previous = 99),
    ("stage 1 samples, but its unit has no texture", |s| {
        s.draws[0].texture_shader[1].operation = ShaderOperation::DependentAlphaRed;
    }),
    ("DotProduct2D cannot stand at stage 0", |s| {
        s.draws[0].texture_shader[0].operation = ShaderOperation::DotProduct2D;
    }),
    ("Sample2D does not sample a texture of kind TwoDimensional", |s| {
        s.draws[0].texture_shader[0].operation = ShaderOperation::Sample2D;
    }),
    ("a number of BumpEnvironment at stage 1 is not finite", |s| {
        let matrix = [0.0, f32::NAN, 0.0, 0.0];
        s.draws[0].texture_shader[1].operation = ShaderOperation::BumpEnvironment { matrix, luminance: None };
    }),
    ("target \"frame\" has no depth buffer", |s| {
        s.targets[0].depth = None;
        s.draws[0].depth_test = Some(DepthTest::new(CompareFunction::Less, true));
    }),
    ("target \"frame\" has no stencil", |s| {
        s.targets[0].depth = Some(DepthBuffer { format: DepthFormat::Z16, clear: 0, clear_stencil: 0 });
        s.draws[0].stencil_test = Some(STENCIL_TEST);
    }),
    ("surface format B8 cannot be blended", |s| {
        s.targets[0].format = SurfaceFormat::B8;
        let (source, destination) = (BlendFactor::One, BlendFactor::One);
        s.draws[0].blend = Some(Blend { equation: BlendEquation::Add, source, destination });
    }),
    ("draw 0, vertex 0: window position", |s| put(s, [f32::NAN, 0.0, 0.0, 1.0])),
    ("lies outside the rasteriser's domain (RAS-0)", |s| put(s, [2e6, 0.0, 0.0, 1.0])),
    ("lies outside the rasteriser's domain", |s| put(s, [0.0, 0.0, f32::INFINITY, 1.0])),
    ("lies outside the rasteriser's domain", |s| put(s, [0.0, 0.0, 0.0, f32::NAN])),
    ("lies outside the rasteriser's domain", |s| put(s, [0.0, -2e6, 0.0, f32::MAX])),
    ("is not a finite number", |s| set(s, [f32::NAN, 0.0, 0.0, 1.0])),
    ("is more than 65536 texels", |s| set(s, [65536.0, 0.0, 0.0, 1.0])),
];

/// Changes that use features which nv10 lacks.
const CASES_OF_NV10: &[Case] = &[
    ("surface format G8B8 does not exist on Nv10", |s| s.targets[1].format = SurfaceFormat::G8B8),
    ("texture `grey`: texture format A8B8G8R8 does not exist on Nv10", |s| {
        s.textures[0].format = TextureFormat::A8B8G8R8
    }),
    ("a texture with border texels does not exist on Nv10", |s| texels(s).border = true),
    ("a rectangle texture cannot be 3 x 4 on Nv10", |s| {
        (s.textures[0].kind, texels(s).width) = (TextureKind::Rectangle, 3)
    }),
    ("3 general stages; Nv10 has 2", |s| s.draws[0].combiners.stages = vec![s.draws[0].combiners.stages[0]; 3]),
    ("Nv10 has no own constants", |s| s.draws[0].combiners.stages[0].constants = [[1; 4]; 2]),
    ("texture unit 2 does not exist on Nv10", |s| s.draws[0].textures[2] = Some(TextureUnit::new(0))),
    ("a texture shader does not exist on Nv10", |s| {
        s.draws[0].texture_shader[1].operation = ShaderOperation::PassThrough
    }),
    ("a border colour does not exist on Nv10", |s| unit(s).address_s = AddressMode::ClampToBorder),
    ("a signed texture channel does not exist on Nv10", |s| unit(s).signed[3] = true),
    ("a rectangle texture cannot be addressed with", |s| s.textures[0].kind = TextureKind::Rectangle),
    ("blend equation SignedAdd does not exist on Nv10", |s| {
        let (source, destination) = (BlendFactor::One, BlendFactor::One);
        s.draws[0].blend = Some(Blend { equation: BlendEquation::SignedAdd, source, destination });
    }),
];

#[test]
fn every_invariant_is_refused_by_name() {
    for (profile, cases) in [(Profile::Nv2a, CASES), (Profile::Nv10, CASES_OF_NV10)] {
        assert!(compile(&plain(profile)).is_ok(), "{:?}", compile(&plain(profile)));
        for (expected, change) in cases {
            let mut scene = plain(profile);
            change(&mut scene);
            let errors = compile(&scene).expect_err(expected);
            let told: Vec<String> = errors.iter().map(ToString::to_string).collect();
            assert!(told.iter().any(|message| message.contains(expected)), "{expected}: {told:#?}");
            assert!(errors.iter().all(|error| !error.help.is_empty()), "{told:#?}");
        }
    }
    let error: Box<dyn std::error::Error> =
        Box::new(compile(&Scene { targets: vec![], ..plain(Profile::Nv2a) }).unwrap_err().remove(0));
    assert_eq!(error.to_string(), "NB0212: texture `shown` shows target 1 of 0; add a target first");
}

// ---- hostile scenes ----

/// A source of numbers from a seed.
struct Random(ninebit::random::Random);

impl Random {
    fn next(&mut self) -> u32 {
        (self.0.bits() >> 33) as u32
    }

    fn below(&mut self, n: usize) -> usize {
        self.next() as usize % n.max(1)
    }

    fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    fn any<T: Named>(&mut self) -> T {
        self.pick(T::ALL)
    }

    fn float(&mut self) -> f32 {
        const EDGES: &[f32] = &[
            f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::MAX,
            f32::MIN,
            f32::MIN_POSITIVE,
            1e-45,
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.5,
            1_048_576.0,
            9.536_743e-7,
            9.5e-7,
            4095.99,
            4096.0,
            -4096.0,
            65536.0,
            1e10,
            -1e10,
            1e-10,
            3.0e38,
            1e19,
            -1e19,
        ];
        if self.below(4) == 0 { f32::from_bits(self.next() << 1 ^ self.next()) } else { self.pick(EDGES) }
    }

    fn whole(&mut self) -> u32 {
        const EDGES: &[u32] =
            &[0, 1, 2, 3, 4, 5, 7, 8, 9, 16, 99, 255, 256, 2047, 4095, 4096, 4097, 1 << 16, 1 << 30, 1 << 31, u32::MAX];
        self.pick(EDGES)
    }

    fn index(&mut self) -> usize {
        const EDGES: &[usize] = &[0, 1, 2, 3, 4, 5, 99, u32::MAX as usize, usize::MAX];
        self.pick(EDGES)
    }
}

/// Makes a random change to a scene, which usually breaks it.
fn hurt(scene: &mut Scene, r: &mut Random) {
    let (targets, textures, palettes, draws) =
        (scene.targets.len(), scene.textures.len(), scene.palettes.len(), scene.draws.len());
    match r.below(6) {
        0 if targets > 0 => hurt_target(&mut scene.targets[r.below(targets)], r),
        1 if textures > 0 => hurt_texture(&mut scene.textures[r.below(textures)], r),
        2 if palettes > 0 => {
            let length = r.pick(&[0, 1, 31, 32, 64, 100, 128, 255, 256, 257, 4096]);
            scene.palettes[r.below(palettes)].entries = (0..length).map(|_| r.next()).collect();
        }
        3 => match r.below(8) {
            0 => scene.profile = r.any(),
            1 => drop(scene.targets.pop()),
            2 => drop(scene.textures.pop()),
            3 => drop(scene.palettes.pop()),
            4 => scene.targets.reverse(),
            5 => scene.textures.reverse(),
            6 => scene.draws.extend_from_within(..),
            _ => scene.textures.extend_from_within(..),
        },
        _ if draws > 0 => hurt_draw(&mut scene.draws[r.below(draws)], r),
        _ => {}
    }
}

fn hurt_target(target: &mut Target, r: &mut Random) {
    match r.below(5) {
        0 => target.width = r.whole(),
        1 => target.height = r.whole(),
        2 => target.format = r.any(),
        3 => target.depth = None,
        _ => target.depth = Some(DepthBuffer { format: r.any(), clear: r.whole(), clear_stencil: r.whole() as u8 }),
    }
}

fn hurt_texture(texture: &mut Texture, r: &mut Random) {
    let TextureImage::Texels(texels) = &mut texture.image else {
        match r.below(3) {
            0 => texture.kind = r.any(),
            1 => texture.format = r.any(),
            _ => texture.image = TextureImage::Target { target: r.index() },
        }
        return;
    };
    match r.below(9) {
        0 => texture.kind = r.any(),
        1 => texture.format = r.any(),
        2 => texels.width = r.whole(),
        3 => texels.height = r.whole(),
        4 => texels.levels = r.whole(),
        5 => texels.border = !texels.border,
        6 => texels.words = texels.words.iter().copied().skip(1).collect(),
        7 => texels.words = texels.words.iter().map(|_| r.next() << 1 ^ r.next()).collect(),
        _ => texture.image = TextureImage::Target { target: r.index() },
    }
}

fn hurt_draw(draw: &mut Draw, r: &mut Random) {
    let k = r.below(TEXTURE_UNITS);
    match r.below(24) {
        0 => draw.target = r.index(),
        1 => {
            let mut indices = draw.indices.to_vec();
            let (at, index) = (r.below(indices.len()), r.whole());
            if let Some(slot) = indices.get_mut(at) {
                *slot = index;
            }
            draw.indices = indices.into();
        }
        2 => draw.indices = draw.indices.iter().copied().skip(1 + r.below(3)).collect(),
        3 => draw.topology = r.any(),
        4 => draw.vertices = draw.vertices.iter().skip(r.below(3)).collect(),
        5..=8 => {
            let (vertex, part, n) = (r.below(draw.vertices.len()), r.below(10), r.below(4));
            let (number, more) = (r.float(), r.float());
            draw.vertices.update(|index, v| match part {
                _ if index != vertex && part < 8 => {}
                0..=2 => v.position[n] = number,
                3 => v.diffuse = VertexColor::Floats([number, more, 0.5, number]),
                4 => v.specular = VertexColor::Floats([number, more, 0.5, number]),
                5 => v.fog = number,
                6 | 7 => v.texture_coordinates[k][n] = number,
                8 => v.texture_coordinates[k][3] = number,
                _ => v.position[3] = number,
            });
        }
        9 => {
            let number = |r: &mut Random| if r.below(2) == 0 { r.float() } else { r.below(64) as f32 };
            let [x, y, width, height, near, far] = std::array::from_fn(|_| number(r));
            draw.positions = Positions::Clip(Viewport {
                x,
                y,
                width,
                height,
                near,
                far,
                clip_depth: r.any(),
                depth_clamp: r.below(2) == 0,
            });
        }
        10 => {
            let [x, y, width, height] = std::array::from_fn(|_| r.whole());
            draw.scissor = Some(Rectangle { x, y, width, height });
        }
        11 => {
            draw.fog = Fog {
                enabled: true,
                color: [1, 2, 3],
                function: Some(FogFunction {
                    mode: r.any(),
                    p0: r.float(),
                    p1: r.float(),
                    p2: r.float(),
                    per_vertex: r.below(2) == 0,
                }),
            }
        }
        12 => draw.textures[k] = Some(TextureUnit::new(r.index())),
        13 => draw.textures[k] = None,
        14 => draw.texture_shader[k].coordinate_set = r.index(),
        15 => draw.texture_shader[k].previous = r.index(),
        16 => {
            let [a, b, c, d] = std::array::from_fn(|_| r.float());
            draw.texture_shader[k].operation = match r.below(11) {
                8 => ShaderOperation::Sample2D,
                9 => ShaderOperation::SampleCube,
                10 => ShaderOperation::DotProduct3D,
                0 => ShaderOperation::Sample,
                1 => ShaderOperation::DotProduct,
                2 => ShaderOperation::DotProduct2D,
                3 => ShaderOperation::DotReflectConstantEye { eye: [a, b, c] },
                4 => ShaderOperation::DependentGreenBlue,
                5 => ShaderOperation::PassThrough,
                _ => ShaderOperation::BumpEnvironment { matrix: [a, b, c, d], luminance: Some([a, d]) },
            };
        }
        17 => {
            let lods = [r.whole() as i32, r.whole() as i32, r.whole() as i32];
            if let Some(unit) = &mut draw.textures[k] {
                [unit.lod_bias, unit.min_lod, unit.max_lod] = lods;
            }
        }
        18 => {
            if let Some(unit) = &mut draw.textures[k] {
                (unit.palette, unit.address_s) = ([None, Some(r.index())][r.below(2)], r.any());
                (unit.mip_filter, unit.signed[k]) = (r.any(), !unit.signed[k]);
            }
        }
        19 => draw.combiners.stages.truncate(r.below(2)),
        20 => {
            let stages = draw.combiners.stages.clone();
            draw.combiners.stages.extend(stages);
        }
        21 => {
            let (register, component) = (r.any(), r.any());
            if let Some(stage) = draw.combiners.stages.first_mut() {
                let portion = if r.below(2) == 0 { &mut stage.rgb } else { &mut stage.alpha };
                (portion.inputs[k].register, portion.inputs[k].component) = (register, component);
                [&mut portion.ab_output, &mut portion.cd_output, &mut portion.sum_output][k % 3].clone_from(&register);
                (portion.mux, portion.ab_dot_product, portion.scale, portion.bias) =
                    (!portion.mux, k == 0, r.any(), r.any());
            }
        }
        22 => {
            let input = &mut draw.combiners.final_combiner.inputs[k];
            (input.register, input.component) = (r.any(), r.any());
        }
        _ => {
            let rectangle = Rectangle { x: r.whole(), y: r.whole(), width: r.whole(), height: r.whole() };
            draw.window_clip = Some(WindowClip { rectangles: vec![rectangle; r.below(10)], exclusive: k == 0 });
            draw.stencil_test = Some(StencilTest { function: r.any(), fail: r.any(), pass: r.any(), ..STENCIL_TEST });
            draw.depth_test = Some(DepthTest::new(r.any(), true));
            draw.blend = Some(Blend { equation: r.any(), source: r.any(), destination: r.any() });
        }
    }
}

/// Scenes with more pixels are planned but not drawn, because the scalar engine would take too long.
const MAX_PIXELS: u64 = 1 << 17;

#[test]
fn hostile_scenes_are_planned_or_refused() {
    let (count, seed): (u32, u32) =
        (settings::number("NINEBIT_CODE_SCENES", 1_500), settings::number("NINEBIT_CODE_SEED", 3));
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[seed as u8; 32]);
    let mut runner = TestRunner::new_with_rng(Config { failure_persistence: None, ..Config::default() }, rng);
    let (strategy, mut drawn) = (random_scene::scene(), 0);
    for number in 0..count {
        let mut scene = strategy.new_tree(&mut runner).unwrap().current();
        let mut random = Random(ninebit::random::Random::seeded(u64::from(seed) << 32 | u64::from(number)));
        for _ in 0..=random.below(4) {
            hurt(&mut scene, &mut random);
        }
        // A failing scene is named by its number.
        let drawing = format!("scene {number} of seed {seed}");
        let told = std::panic::catch_unwind(|| {
            let plan = match compile(&scene) {
                Ok(plan) => plan,
                Err(errors) => {
                    assert!(!errors.is_empty() && errors.len() < 200, "{drawing}: {} errors", errors.len());
                    return false;
                }
            };
            if plan.targets().iter().map(|t| u64::from(t.width) * u64::from(t.height)).sum::<u64>() > MAX_PIXELS {
                return false;
            }
            let frames = render(&plan, &RenderOptions::default());
            let defined = render(&plan, &RenderOptions { engine: Engine::Scalar, ..RenderOptions::default() });
            assert!(frames == defined, "{drawing}: the engines differ");
            trace(&plan, 0, (0, 0), None).unwrap();
            true
        });
        match told {
            Ok(planned) => drawn += u32::from(planned),
            Err(panic) => {
                eprintln!("{drawing}: {scene:#?}");
                std::panic::resume_unwind(panic);
            }
        }
    }
    println!("{drawn} of {count} hostile scenes are drawn");
    assert!(drawn > count / 20 && drawn < count, "{drawn} of {count}");
}

/// A scene that has no text gets the bound and the rule in its error, as one with text does.
#[test]
fn a_texture_that_is_too_large_is_told_its_bound() {
    let mut scene = plain(Profile::Nv10);
    let TextureImage::Texels(texels) = &mut scene.textures[0].image else { unreachable!("texels of its own") };
    texels.width = 8192;
    let errors = compile(&scene).unwrap_err();
    let error = errors.iter().find(|error| error.code == "NB0321").unwrap();
    assert_eq!(error.rule, Some("TEX-7"));
    assert_eq!(error.help, "a side has at most 2048 texels on Nv10: scale it down; profile Nv2a allows 4096");
}

/// Without its stage a bound texture reads opaque black (TEX-16).
#[test]
fn a_texture_bound_by_the_builder_is_sampled() {
    let word = |draw: Draw| {
        let combiners = Combiners::showing(FinalRegister::Texture0);
        let mut scene = plain(Profile::Nv2a);
        let (vertices, indices) = (scene.draws[0].vertices.clone(), scene.draws[0].indices.clone());
        scene.draws = vec![Draw { vertices, indices, combiners, ..draw }];
        render(&compile(&scene).unwrap(), &RenderOptions::default()).surfaces[0].words[0]
    };
    let bound = [Some(TextureUnit::new(0)), None, None, None];
    assert_eq!(word(Draw { textures: bound, ..Draw::default() }), 0xff00_0000);
    assert_eq!(word(Draw::default().texture(0, TextureUnit::new(0))), 0xff80_4020);
    // A stage that does something else goes on doing it.
    let mut passes = Draw::default();
    passes.texture_shader[0].operation = ShaderOperation::PassThrough;
    assert_eq!(passes.texture(0, TextureUnit::new(0)).texture_shader[0].operation, ShaderOperation::PassThrough);
}
