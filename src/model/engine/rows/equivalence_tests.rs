//! Compares weights, coordinates and faces of the rows with the definition, for millions of pixels.
//!
//! `NINEBIT_EQUIVALENCE_PIXELS=250000000 cargo test --release --lib rows::equivalence_tests` compares 10^9 quotients of 2D coordinates and
//! weights. Without the variable a small part of them is compared.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, reason = "choosing triangles; a test fails by panicking")]

use super::boxes::{HALF_STEP, batch, boxes, is_small};
use super::direction::coordinates;
use super::kernels::{PerLane, STEP};
use super::levels::{MipFetches, fetches, levels};
use super::planes::inverse;
use super::quads::Measure;
use super::setup::{PixelBatch, Setup};
use super::small::Boxes;
use super::taps::{Footprints, Pair, PairsOfQuad, taps};
use super::triangle::InterpolatorKernels;
use super::triangle::{Interpolators, Varying};
use super::{BLOCK, Reasons, Rows};
use crate::engine::TextureWords;
use crate::engine::context::TriangleContext;
use crate::engine::walk::Window;
use crate::plan::{Plan, PlanOptions};
use crate::raster::interpolate::Sample;
use crate::raster::setup::is_flat;
use crate::state::*;
use crate::texture::address::address;
use crate::texture::coordinates::SampleCoordinates;

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
        name: String::new(),
        target: 0,
        positions: Positions::Window,
        indices: (0..vertices.len() as u32).collect(),
        vertices: vertices.into(),
        topology: Topology::Triangles,
        shade_model: ShadeModel::Smooth,
        provoking_vertex: ProvokingVertex::First,
        perspective: true,
        cull: Cull::None,
        front_face: FrontFace::CounterClockwise,
        scissor: None,
        fog: Fog { enabled: true, color: [0; 3], function: fog },
        textures: [
            flat,
            if cube { mixed(1) } else { unit(1) },
            with_r.or(if projected { mixed(2) } else { flat }),
            with_r.or(mixed(2)),
        ],
        texture_shader: [0, 1, 2, 3].map(|unit| ShaderStage::conventional(unit, true)),
        vertex_program: None,
        combiners: Combiners {
            stages: vec![stage],
            mux_select: MuxSelect::Msb,
            final_combiner: FinalCombiner {
                inputs,
                g: FinalInput { register: FinalRegister::Fog, ..FinalInput::zero(Component::Alpha) },
                color_sum_clamp: false,
                invert_spare0: false,
                invert_secondary: false,
                constants: [[0; 4]; 2],
            },
        },
        program_origin: vec![],
        alpha_test: None,
        stencil_test: None,
        window_clip: None,
        depth_test: Some(DepthTest { w_buffer, ..DepthTest::new(CompareFunction::Always, true) }),
        blend: None,
        blend_constant: [0; 4],
        color_mask: [true; 4],
    };
    let target = Target {
        name: String::new(),
        width: WIDTH,
        height: HEIGHT,
        format: SurfaceFormat::A8R8G8B8,
        clear_color: [0; 4],
        contents: None,
        depth: Some(DepthBuffer { format: depth, clear: 0, clear_stencil: 0 }),
        clip: None,
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

/// Returns options for coordinates on planes that lose a finite amount, or the default ones (INT-4t).
pub(super) fn options(finite: bool) -> PlanOptions {
    let mut options = PlanOptions::default();
    options.policies.choose("INT-4t", usize::from(finite));
    options
}

/// Compares the units on planes and the weights of a box of a small triangle with the definition.
fn compare_small<const FMA: bool>(
    context: &TriangleContext<'_>,
    plain: &super::CompiledDraw,
    window: Window,
    small: &mut Boxes,
    varying: &mut Varying,
    rows: &mut [PerLane<i16>],
) -> bool {
    (small.all[0], small.count, small.current) = ((window, 0), 1, 0);
    small.corners.set(0, context);
    // Nothing is stored on a surface.
    small.set_up::<FMA>(std::slice::from_ref(context), plain, 0);
    if small.has_ratios {
        small.set_up_ratios::<FMA>(context, plain);
    }
    if small.has_levels {
        small.set_up_levels::<FMA>(context, plain);
    }
    let batch = batch::<HALF_STEP>(small.coverage(), 0);
    let mut done = if small.is_tied() {
        small.interpolate::<FMA, true>(context, plain, batch, varying, rows)
    } else {
        small.interpolate::<FMA, false>(context, plain, batch, varying, rows)
    };
    done &= !small.has_ratios || small.interpolate_ratios::<FMA>((context, plain), batch, varying, rows);
    varying.reads.iter_mut().for_each(|reads| reads.weights.fill(u16::MAX));
    done &= !small.has_levels || small.interpolate_levels((context, plain), fetches::<FMA>, batch, varying);
    let (alone, mut wanted) = (Setup::new(context, &inverse(&context.triangle)), MipFetches::default());
    if plain.depths_together {
        small.depths.write::<FMA>(0, batch, context.draw.depth_format, &mut varying.depth);
    } else {
        super::depth::depths::<FMA, false>(context, batch, varying.depths());
    }
    for n in (0..batch.count).filter(|_| done) {
        let (sample, lane) = (batch.sample(n, &context.triangle), batch.lane + n);
        for (index, sampler) in plain.samplers.iter().enumerate() {
            let unit = &context.draw.units[sampler.index];
            if sampler.mixes {
                compare_reads(&alone, sampler, batch, n, &varying.reads[index], &mut wanted);
                continue;
            }
            let place = context.sample_coordinates(unit, &sample, batch.pixel(n)).unwrap();
            let wanted = place.on(&unit.levels[0]).map(|c| c.value as i32 - sampler.bias());
            let got = varying.coordinates[index].each_ref().map(|c| c[lane]);
            assert_eq!(got, wanted, "unit {index} {:?} of {:?}", batch.pixel(n), context.vertices());
            if let Some(super::compiled::Third::Reference(format)) = sampler.third {
                let (got, wanted) =
                    (varying.references[index][lane], crate::raster::depth::word(format, place.reference()));
                assert_eq!(got, wanted, "reference of unit {index} {:?} of {:?}", batch.pixel(n), context.vertices());
            }
        }
        let fog = i16::from(context.fog.as_ref().unwrap().at(&sample).byte);
        let slot = usize::from(plain.fog.unwrap());
        assert_eq!(rows[slot].0[lane], fog, "{:?} {:?} of {:?}", batch.pixel(n), context.draw.fog, context.vertices());
        if plain.varies(context) {
            let weights = sample.weights().map(|w| w.value as u16);
            let got = varying.narrow.each_ref().map(|w| w[lane]);
            assert_eq!(got, weights, "{:?} of {:?}", batch.pixel(n), context.vertices());
        }
        let depth = context.depth_word(&sample).unwrap_or(super::depth_words::OUTSIDE);
        assert_eq!(varying.depth[lane], depth, "{:?} of {:?}", batch.pixel(n), context.vertices());
    }
    done
}

/// Compares the fetches of a pixel from a texture with levels with those of the definition.
fn compare_reads(
    setup: &Setup<'_>,
    sampler: &super::Sampler,
    batch: PixelBatch<'_>,
    n: usize,
    found: &MipFetches,
    wanted: &mut MipFetches,
) {
    setup.defined_reads(batch, n, sampler, wanted);
    let of = |reads: &MipFetches| {
        let lane = batch.lane + n;
        let coordinates = reads.coordinates.each_ref().map(|at| at.each_ref().map(|c| c[lane]));
        (reads.entries.each_ref().map(|e| e[lane]), coordinates, reads.weights[lane])
    };
    let (unit, vertices) = (sampler.index, setup.context.vertices());
    assert_eq!(of(found), of(wanted), "unit {unit} {:?} of {vertices:?}", batch.pixel(n));
}

/// Compares a batch with the definition, pixel by pixel.
fn compare<const FMA: bool, const ROW: bool>(
    interpolators: &Interpolators<'_>,
    compiled: &super::CompiledDraw,
    batch: PixelBatch<'_>,
    varying: &mut Varying,
    rows: &mut [PerLane<i16>],
) {
    // Results of an earlier batch must not pass for those of this one.
    varying.reads.iter_mut().for_each(|reads| reads.weights.fill(u16::MAX));
    let kernels = InterpolatorKernels {
        coordinates: coordinates::<FMA>,
        levels: levels::<FMA>,
        fetches: fetches::<FMA>,
        taps: taps::<FMA>,
    };
    interpolators.interpolate::<FMA, ROW>(batch, (compiled, &kernels), &[], varying, rows);
    super::depth::depths::<FMA, ROW>(interpolators.setup.context, batch, varying.depths());
    let (context, mut wanted, mut taps) = (&interpolators.setup.context, MipFetches::default(), Footprints::default());
    for n in 0..batch.count {
        let (i, j) = (batch.first.0 + i64::from(batch.at.x[n]), batch.first.1 + i64::from(batch.at.y[n]));
        let sample = Sample::new(&context.triangle, context.triangle.edges(i, j));
        let lane = batch.lane + n;
        let weights = sample.weights().map(|w| w.value as u16);
        let depth = context.depth_word(&sample).unwrap_or(super::depth_words::OUTSIDE);
        assert_eq!(varying.depth[lane], depth, "({i}, {j}) of {:?}", context.vertices());
        let fog = i16::from(context.fog.as_ref().unwrap().at(&sample).byte);
        let slot = usize::from(compiled.fog.unwrap());
        assert_eq!(rows[slot].0[lane], fog, "({i}, {j}), {:?} of {:?}", context.draw.fog, context.vertices());
        assert_eq!(varying.narrow.each_ref().map(|w| w[lane]), weights, "({i}, {j}) of {:?}", context.vertices());
        for (index, unit) in context.draw.units.iter().enumerate() {
            let place = context.sample_coordinates(unit, &sample, (i, j)).unwrap();
            let sampler = &compiled.samplers[index];
            if sampler.mixes {
                compare_reads(&interpolators.setup, sampler, batch, n, &varying.reads[index], &mut wanted);
                continue;
            }
            let bias = if compiled.samplers[index].filters { 128 } else { 0 };
            let wanted = place.on(&unit.levels[0]).map(|c| c.value as i32 - bias);
            let got = varying.coordinates[index].each_ref().map(|c| c[lane]);
            assert_eq!(got, wanted, "unit {index} ({i}, {j}) of {:?}", context.vertices());
            if sampler.pairs > 0 {
                taps.begin(sampler);
                Footprints::set(&mut taps.pairs, 0, &PairsOfQuad::defined(unit, place.quad()));
                for (got, wanted) in varying.footprints[index].pairs.iter().zip(&taps.pairs) {
                    let of =
                        |pair: &Pair, lane: usize| (pair.weights[lane], [0, 1].map(|n: usize| pair.offsets[n][lane]));
                    let (got, wanted) = (of(got, lane), of(wanted, 0));
                    assert_eq!(got, wanted, "taps of unit {index} ({i}, {j}) of {:?}", context.vertices());
                }
            }
            match &sampler.third {
                Some(super::compiled::Third::Layer(_, axis)) => {
                    let layer = |texel: i64| address(unit.state.address_r, texel, unit.layers, false);
                    let entry = i64::from(axis.first) + i64::from(varying.faces[index][lane]);
                    let wanted = layer(place.layer(unit.layers).value >> 8);
                    assert_eq!(layer(entry), wanted, "layers of unit {index} ({i}, {j}) of {:?}", context.vertices());
                }
                Some(super::compiled::Third::Reference(format)) => {
                    let wanted = crate::raster::depth::word(*format, place.reference());
                    let got = varying.references[index][lane];
                    assert_eq!(got, wanted, "reference of unit {index} ({i}, {j}) of {:?}", context.vertices());
                }
                _ => {}
            }
            if unit.kind == TextureKind::Cube {
                assert_eq!(varying.faces[index][lane], place.face() as u32, "({i}, {j}) of {:?}", context.vertices());
            }
        }
    }
}

#[test]
fn rows_interpolate_what_the_definition_does() {
    rows_interpolate(0x9e37_79b9_7f4a_7c15);
}

/// Tests the other half of the pixels. The two tests run in parallel.
#[test]
fn rows_interpolate_what_the_definition_does_elsewhere() {
    rows_interpolate(0xbf58_476d_1ce4_e5b9);
}

/// Compares half of the pixels, at random places.
fn rows_interpolate(seed: u64) {
    let all = std::env::var("NINEBIT_EQUIVALENCE_PIXELS").ok().and_then(|n| n.parse().ok()).unwrap_or(3_000_000_u64);
    let (wanted, least_drawn) = (all / 2, 10_000);
    let mut random = Random::seeded(seed);
    let (mut pixels, mut drawn, mut with_depths, mut tied, mut round) = (0, 0, 0, 0, 0_u64);
    // By the kind of coordinates: on planes, divided by q, and both with depths to compare with; on planes with levels.
    let mut proved = [0; 5];
    let (mut covers, mut small_boxes, mut reasons) = (Boxes::default(), Boxes::default(), Reasons::default());
    while pixels < wanted || drawn < least_drawn {
        round += 1;
        let filter = random.of(&[Filter::Linear, Filter::Nearest]);
        let depth = random.of(DepthFormat::ALL);
        let fog = fog(&mut random);
        // The last triangles are small, and so many that building their tables pays.
        let small = pixels >= wanted;
        let mixes = [0; 2].map(|_| random.below(2) == 0);
        let mut vertices: Vec<Vertex> =
            (0..if small { 256 } else { 64 }).flat_map(|_| triangle(&mut random, small)).collect();
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
        let scene = scene(vertices, filter, depth, fog, mixes, (third, w_buffer, anisotropy));
        let Ok(plan) = Plan::compile(&scene, &options(round % 3 == 0)) else { continue };
        let rows_of_plan = Rows::compile(&plan);
        let [compiled] = &rows_of_plan.draws(&plan, 0..1, &TextureWords::new(&plan, &[], &[]))[..] else {
            panic!("one")
        };
        assert_eq!(compiled.samplers.len(), 4);
        // Each sampler that small triangles are set up together for is put in every place that a sampler can have.
        let kinds: Vec<_> = compiled
            .samplers
            .iter()
            .filter(|sampler| sampler.is_plain())
            .map(|sampler| {
                let samplers = vec![super::Sampler { shares: None, ..sampler.clone() }; 1 + round as usize % 4];
                let of_coordinates = 2 * usize::from(sampler.third.is_some()) + usize::from(sampler.index == 2);
                let kind = if sampler.mixes { 4 } else { of_coordinates };
                (kind, super::CompiledDraw { samplers, plain: true, ..compiled.clone().into_owned() })
            })
            .collect();
        let draw = &plan.draws[0];
        let (mut varying, mut rows) = (Varying::default(), vec![PerLane::from_value(0); compiled.rows.len()]);
        varying.reads.resize(compiled.samplers.len(), MipFetches::default());
        varying.footprints.resize(compiled.samplers.len(), Footprints::default());
        varying.footprints.iter_mut().zip(&compiled.samplers).for_each(|(taps, sampler)| taps.begin(sampler));
        let mut planes = Default::default();
        let (whole, columns) = ((0, i64::from(HEIGHT)), (0, i64::from(WIDTH)));
        for number in 0..draw.assembly.triangles.len() {
            let Some(context) = TriangleContext::new(&plan, draw, number, whole) else { continue };
            let interpolators = Interpolators::new(&context, compiled, planes);
            let triangle = &interpolators.setup.context.triangle;
            let window = (triangle.rows.0.max(whole.0), triangle.rows.1.min(whole.1));
            let sides = [triangle.rows, triangle.columns].map(|(first, end)| (end - first) as i32);
            let is_flat = is_flat(context.corners().map(|corner| corner.w), draw.perspective, plan.profile);
            if is_small(sides.into(), is_flat) {
                let (mut covered, (first, end)) = (0, triangle.columns);
                covers.corners.set(0, &context);
                for part in boxes((window, (first.max(columns.0), end.min(columns.1)))) {
                    (covers.all[0], covers.count) = ((part, 0), 1);
                    covers.cover(0);
                    let coverage = covers.coverage();
                    if coverage.count == 0 {
                        continue;
                    }
                    let batch = batch::<STEP>(coverage, 0);
                    let alone = TriangleContext::new(&plan, draw, number, whole).unwrap();
                    if let Some((kind, plain)) = kinds.get(number % kinds.len().max(1)) {
                        let done = if round.is_multiple_of(4) {
                            compare_small::<true>(&alone, plain, part, &mut small_boxes, &mut varying, &mut rows)
                        } else {
                            compare_small::<false>(&alone, plain, part, &mut small_boxes, &mut varying, &mut rows)
                        };
                        proved[*kind] += u64::from(done);
                        tied += u64::from(done && small_boxes.is_tied());
                        with_depths += u64::from(done && plain.depths_together);
                    }
                    if round.is_multiple_of(4) {
                        compare::<true, false>(&interpolators, compiled, batch, &mut varying, &mut rows);
                    } else {
                        compare::<false, false>(&interpolators, compiled, batch, &mut varying, &mut rows);
                    }
                    (covered, drawn) = (covered + coverage.count, drawn + 1);
                }
                let spans = (window.0..window.1).map(|j| triangle.span(j, columns)).map(|(a, b)| (b - a) as usize);
                assert_eq!(covered, spans.sum::<usize>());
                pixels += covered as u64;
            } else {
                for j in window.0..window.1 {
                    let (mut i, end) = triangle.span(j, columns);
                    if i == end {
                        continue;
                    }
                    interpolators.begin_row::<false>((i, j), end - i, compiled, &mut varying);
                    while i < end {
                        let count = ((end - i) as usize).min(BLOCK - (j as usize % 5) * 32);
                        let batch = PixelBatch::row((i, j), count, 0);
                        if round.is_multiple_of(4) {
                            compare::<true, true>(&interpolators, compiled, batch, &mut varying, &mut rows);
                        } else {
                            compare::<false, true>(&interpolators, compiled, batch, &mut varying, &mut rows);
                        }
                        i += count as i64;
                        pixels += count as u64;
                    }
                }
            }
            planes = interpolators.given_back(&mut reasons);
        }
    }
    println!(
        "{pixels} pixels, {drawn} boxes of small triangles, {proved:?} of them proved at once, {with_depths} with depths, {tied} with ties; definition: {reasons:?}"
    );
    assert!(proved.iter().all(|boxes| *boxes > drawn / 200) && with_depths > drawn / 20 && tied > drawn / 50);
}
