//! Compares the frames of both engines for random triangles of all kinds, textures, fogs and depths.
//!
//! `NINEBIT_EQUIVALENCE_PIXELS=250000000 cargo test --release --lib rows::equivalence_tests` compares many; without the variable, a small part of
//! them.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, reason = "choosing triangles; a test fails by panicking")]

use super::shading::shader_tests::compare;
use crate::plan::{Plan, PlanOptions};
use crate::state::*;

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

/// The random numbers of the tests.
pub(super) struct Random(crate::random::Random);

impl Random {
    pub(super) fn seeded(seed: u64) -> Random {
        Random(crate::random::Random::seeded(seed))
    }

    pub(super) fn below(&mut self, n: u64) -> u64 {
        self.0.below(n.into()) as u64
    }

    pub(super) fn unit(&mut self) -> f32 {
        (self.0.bits() >> 40) as f32 / (1_u64 << 24) as f32
    }

    pub(super) fn of<T: Copy>(&mut self, values: &[T]) -> T {
        values[self.below(values.len() as u64) as usize]
    }
}

/// Returns a random triangle: tiny ones, slivers, ones far beyond the frame, with one w, with few values of w and coordinates, with steep
/// w, with one texel for each pixel, and right triangles whose weights and coordinates have many ties. If `small` is set, all of these are
/// tiny.
pub(super) fn triangle(r: &mut Random, small: bool) -> [Vertex; 3] {
    // Half of the triangles are tiny, because these have only few pixels each.
    let kind = r.below(18);
    let kind = if kind < 9 { kind } else { 0 };
    let aligned = r.below(3) == 0;
    let (cx, cy) = (r.unit() * WIDTH as f32, r.unit() * HEIGHT as f32);
    let lean = [r.unit() - 0.5, r.unit() - 0.5, r.unit()];
    let (x0, y0) = (r.below(64) as f32, r.below(64) as f32);
    let legs = [r.of(&[8.0, 10.0, 64.0, 96.0, 128.0, 100.0, 320.0]), r.of(&[8.0, 12.0, 64.0, 80.0, 120.0, 256.0])];
    let legs = if small { [0; 2].map(|_| r.of(&[1.0, 2.0, 4.0, 5.0, 8.0, 10.0, 14.0])) } else { legs };
    let turn = r.below(3) as usize;
    let mut vertices = [Vertex::default(); 3];
    let looks_one_way = r.below(8) == 0;
    for (k, vertex) in vertices.iter_mut().enumerate() {
        let (x, y) = match kind {
            0..7 if small => (cx + 16.0 * (r.unit() - 0.5), cy + 16.0 * (r.unit() - 0.5)),
            0 => (cx + 11.0 * (r.unit() - 0.5), cy + 11.0 * (r.unit() - 0.5)),
            1 => (cx + k as f32 * 200.0 * lean[0] + r.unit(), cy + k as f32 * 200.0 * lean[1] + r.unit()),
            2 => ((r.unit() - 0.5) * 8000.0, (r.unit() - 0.5) * 8000.0),
            7 | 8 => {
                let corner = [(0.0, 0.0), (legs[0], 0.0), (0.0, legs[1])][(k + turn) % 3];
                (x0 + corner.0, y0 + corner.1)
            }
            _ => (r.unit() * 1.4 * WIDTH as f32 - 90.0, r.unit() * 1.4 * HEIGHT as f32 - 90.0),
        };
        let (x, y) = if aligned { (x.floor(), y.floor()) } else { (x, y) };
        let w = match kind {
            3 => 1.0,
            4 | 7 => r.of(&[1.0, 1.0, 2.0, 4.0]),
            5 => 0.01 + 30.0 * r.unit() * r.unit(),
            6 => 1e-3 + 1e3 * r.unit(),
            8 => 1.0,
            _ => 0.5 + lean[2] + 0.2 * r.unit(),
        };
        let st = match kind {
            3 | 8 if aligned => [x / 64.0, y / 64.0],
            4 | 7 => [r.below(9) as f32 / 4.0 - 1.0, r.below(9) as f32 / 4.0 - 1.0],
            6 => [600.0 * (r.unit() - 0.5), 600.0 * (r.unit() - 0.5)],
            _ => [8.0 * (r.unit() - 0.5), 8.0 * (r.unit() - 0.5)],
        };
        let direction = match kind {
            4 | 7 => [0; 3].map(|_| r.below(5) as f32 - 2.0),
            _ => [0; 3].map(|_| r.unit() - 0.5),
        };
        let z = if aligned { r.below(9) as f32 / 8.0 } else { r.unit() * 1.2 - 0.1 };
        vertex.position = [x, y, z, w];
        vertex.fog = match kind {
            7 | 8 => r.below(33) as f32 / 8.0,
            5 | 6 => 1.0 + r.unit(),
            _ => 4.0 * r.unit() - 0.25,
        };
        vertex.diffuse = VertexColor::Bytes([0; 4].map(|_| r.0.bits() as u8));
        vertex.texture_coordinates[0] = [st[0], st[1], 0.0, 1.0];
        let q = match kind {
            4 | 7 | 8 => r.of(&[1.0, 2.0, 4.0, -0.5]),
            // Some have no sign.
            5 | 6 => 2.0 * r.unit() - 0.7,
            _ if lean[0] < 0.0 => -0.5 - r.unit(),
            _ => 0.5 + 2.0 * r.unit(),
        };
        vertex.texture_coordinates[2] = [st[0] * q, st[1] * q, z * q, q];
        vertex.texture_coordinates[3] = [st[0], st[1], z, 1.0];
        vertex.texture_coordinates[1] = [direction[0], direction[1], direction[2], 1.0];
    }
    if looks_one_way {
        let [first, ..] = vertices;
        for vertex in &mut vertices {
            vertex.texture_coordinates[1..3].copy_from_slice(&first.texture_coordinates[1..3]);
        }
    }
    vertices
}

/// The texture formats with depths.
pub(super) const DEPTHS: &[TextureFormat] =
    &[TextureFormat::Z16, TextureFormat::Z24S8, TextureFormat::Z16F, TextureFormat::Z24S8F];

/// Returns a factor for an r of 0 to 1, after which r spans the layers or the range of the depth format, or a part of it.
pub(super) fn steps(r: &mut Random, third: Third) -> f32 {
    match third {
        Third::Reference(format) => match format.depth() {
            Some(depth) if depth.is_float() => r.of(&[1.0, 600.0, 1e30, 3e38]),
            _ => r.of(&[8.0, 1000.0, 65535.0, 16_777_215.0]),
        },
        _ => r.of(&[1.0, 1.0, 0.375, 4.0]),
    }
}

/// Returns a fog function whose factors lie between 0 and 1 for some coordinates, or `None`.
fn fog(r: &mut Random) -> Option<FogFunction> {
    let round = r.below(3) == 0;
    let [p0, p1] = match r.below(4) {
        0 => return None,
        _ if round => [r.of(&[1.5, 2.0, 2.5, 1.0]), r.of(&[-0.125, -0.25, -1.0, -0.5])],
        1 => [1.0 + 2.0 * r.unit(), -r.unit()],
        _ => [3.0 * r.unit() - 0.5, 2.0 * r.unit() - 1.0],
    };
    Some(FogFunction { mode: r.of(FogMode::ALL), p0, p1, p2: 0.0, per_vertex: r.below(4) == 0 })
}

/// The purpose of the third coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Third {
    Nothing,
    /// Layers of a volume, with an address mode.
    Layers(AddressMode),
    /// A depth that is compared with texels of this format.
    Reference(TextureFormat),
}

/// Returns a scene of triangles that read the diffuse colour, a plane texture, a cube map and a projected texture, and fog, and that test
/// depth or w. All textures are filtered or none is. `cube` and `projected` give the latter two textures levels that are mixed. The first
/// texture may be anisotropic. With a third coordinate, the last two textures are volumes or depths.
pub(super) fn scene(
    vertices: Vec<Vertex>,
    filter: Filter,
    depth: DepthFormat,
    fog: Option<FogFunction>,
    [cube, projected]: [bool; 2],
    (third, w_buffer, anisotropy): (Third, bool, u32),
) -> Scene {
    let texture = |kind, side: u32, faces: u32, levels: u32| Texture {
        name: String::new(),
        kind,
        format: TextureFormat::A8R8G8B8,
        image: TextureImage::Texels(Texels {
            width: side,
            height: side,
            levels,
            layers: if kind == TextureKind::ThreeDimensional { faces } else { 1 },
            border: false,
            words: (0..Level::chain(TextureFormat::A8R8G8B8, side, side, levels, false).1 as u32 * faces)
                .map(|n| n.wrapping_mul(0x9e37_79b9))
                .collect::<Vec<u32>>()
                .into(),
        }),
    };
    let unit = |texture| Some(TextureUnit { min_filter: filter, mag_filter: filter, ..TextureUnit::new(texture) });
    let flat = unit(0).map(|unit| TextureUnit { anisotropy, ..unit });
    let mixed = |texture| {
        unit(texture).map(|unit| TextureUnit {
            min_filter: Filter::Linear,
            mip_filter: if filter == Filter::Linear { MipFilter::Linear } else { MipFilter::Nearest },
            lod_bias: 400,
            ..unit
        })
    };
    let nearest =
        |texture| TextureUnit { min_filter: Filter::Nearest, mag_filter: Filter::Nearest, ..TextureUnit::new(texture) };
    let with_r = match third {
        Third::Nothing => None,
        Third::Layers(address_r) => Some(TextureUnit { address_r, ..nearest(3) }),
        Third::Reference(_) => {
            let shadow = Some(ShadowComparison { function: CompareFunction::Less, reference: ShadowReference::R });
            Some(TextureUnit { shadow, ..nearest(4) })
        }
    };
    let (volume, mut depths) =
        (texture(TextureKind::ThreeDimensional, 16, 8, 1), texture(TextureKind::TwoDimensional, 16, 1, 1));
    if let Third::Reference(format) = third {
        depths.format = format;
    }
    let input = |register| CombinerInput { register, component: Component::Rgb, mapping: InputMapping::SignedIdentity };
    let mut rgb = Portion::idle(Component::Rgb);
    rgb.inputs = [Register::Texture0, Register::PrimaryColor, Register::Texture1, Register::Texture2].map(input);
    rgb.sum_output = Register::Spare0;
    let stage = GeneralStage { rgb, alpha: Portion::idle(Component::Alpha), constants: [[0; 4]; 2] };
    let mut inputs = [FinalInput::zero(Component::Rgb); 6];
    inputs[3].register = FinalRegister::Spare0;
    inputs[0].register = FinalRegister::PrimaryColor;
    inputs[1].register = FinalRegister::Texture3;
    let draw = Draw {
        indices: (0..vertices.len() as u32).collect(),
        vertices: vertices.into(),
        fog: Fog { enabled: true, color: [0; 3], function: fog },
        textures: [
            flat,
            if cube { mixed(1) } else { unit(1) },
            with_r.or(if projected { mixed(2) } else { flat }),
            with_r.or(mixed(2)),
        ],
        texture_shader: [0, 1, 2, 3].map(|unit| ShaderStage::conventional(unit, true)),
        combiners: Combiners {
            stages: vec![stage],
            final_combiner: FinalCombiner {
                inputs,
                g: FinalInput { register: FinalRegister::Fog, ..FinalInput::zero(Component::Alpha) },
                color_sum_clamp: false,
                ..FinalCombiner::default()
            },
            ..Combiners::default()
        },
        depth_test: Some(DepthTest { w_buffer, ..DepthTest::new(CompareFunction::Always, true) }),
        ..Draw::default()
    };
    let target = Target {
        depth: Some(DepthBuffer { format: depth, clear: 0, clear_stencil: 0 }),
        ..Target::new(WIDTH, HEIGHT, SurfaceFormat::A8R8G8B8)
    };
    Scene {
        profile: Profile::Nv2a,
        targets: vec![target],
        textures: vec![
            texture(TextureKind::TwoDimensional, 64, 1, 1),
            texture(TextureKind::Cube, 16, 6, 5),
            texture(TextureKind::TwoDimensional, 64, 1, 7),
            volume,
            depths,
        ],
        palettes: vec![],
        draws: vec![draw],
    }
}

/// Draws scenes of random triangles until all instruction sets have drawn so many pixels.
fn draw(seed: u64, wanted: u64) {
    let mut random = Random::seeded(seed);
    let (mut pixels, mut scalar, mut round) = (0, 0, 0_u64);
    while pixels < wanted {
        round += 1;
        let filter = random.of(&[Filter::Linear, Filter::Nearest]);
        let depth = random.of(DepthFormat::ALL);
        let fog = fog(&mut random);
        let small = round % 3 == 0;
        let mixes = [0; 2].map(|_| random.below(2) == 0);
        let count = if small { 400 } else { 6 };
        let mut vertices: Vec<Vertex> = (0..count).flat_map(|_| triangle(&mut random, small)).collect();
        let third = match random.below(6) {
            0 | 1 => Third::Layers(random.of(AddressMode::ALL)),
            2 | 3 => Third::Reference(random.of(DEPTHS)),
            _ => Third::Nothing,
        };
        let w_buffer = random.below(3) == 0;
        // r covers as many steps as the format has, and w covers many.
        let (of_r, of_w) = (steps(&mut random, third), random.of(&[1.0, 1.0, 64.0, 65536.0, 1e9]));
        for vertex in &mut vertices {
            vertex.texture_coordinates.iter_mut().skip(2).for_each(|set| set[2] *= of_r);
            vertex.position[3] *= if w_buffer { of_w } else { 1.0 };
        }
        if random.below(4) == 0 {
            let (axis, same) = (random.below(2) as usize, random.of(&[0.0, 0.5, -1.25, 0.3]));
            for (n, vertex) in vertices.iter_mut().enumerate() {
                vertex.texture_coordinates[0][axis] = same;
                vertex.texture_coordinates[3][axis] = same;
                // Directions that differ in length only.
                vertex.texture_coordinates[1] = [same, 0.75, 2.0, 1.0].map(|component| component * (1 + n % 3) as f32);
            }
        }
        let anisotropy = random.of(&[1, 1, 2, 4, 8]);
        let mut scene = scene(vertices, filter, depth, fog, mixes, (third, w_buffer, anisotropy));
        if random.below(3) == 0 {
            scene.profile = Profile::Nv10;
        }
        let Ok(plan) = Plan::compile(&scene, &PlanOptions::default()) else { continue };
        // The scalar engine draws a w beyond RAS-0.
        if plan.draws()[0].assembly.is_far {
            continue;
        }
        let (drawn, by_scalar) = compare(&plan, &format!("round {round}"));
        (pixels, scalar) = (pixels + drawn, scalar + by_scalar);
    }
    println!("{pixels} pixels of {round} scenes, {scalar} of them by the scalar engine");
    assert!(scalar * 4 < pixels);
}

#[test]
fn frames_are_those_of_the_definition() {
    let all = std::env::var("NINEBIT_EQUIVALENCE_PIXELS").ok().and_then(|n| n.parse().ok()).unwrap_or(3_000_000);
    draw(0x243f_6a88_85a3_08d3, all / 2);
    draw(0x1319_8a2e_0370_7344, all / 2);
}
