//! Compares the crate with a second model that is written from the rules: every word and depth has to be the same.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test binary")]

use crate::settings;
use ninebit_oracle as model;
use ninebit_test_support::random_scene;
use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet};

use ninebit::engine::{RenderOptions, render, trace};
use ninebit::frame::Surface;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::state::{
    AddressMode, CompareFunction, DotMapping, Filter, FogFunction, FogMode, Named, POLICIES, Policies, Profile, Scene,
    ShadowReference, TextureFormat, TextureKind,
};
use ninebit::vertex::fog::passed;
use ninebit::vertex::light::{
    ColorSource, Light, Lighting, SecondaryColor, Shading, Side, Sources, Spot, Surface as LitSurface,
};
use ninebit_report::trace_text;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner};

/// Returns a runner whose scenes are the same on every machine. `NINEBIT_ORACLE_SEED` selects others.
fn runner(cases: u32) -> TestRunner {
    let config = Config {
        cases,
        max_shrink_iters: 20_000,
        max_global_rejects: cases,
        failure_persistence: None,
        ..Config::default()
    };
    let seed: u8 = settings::number("NINEBIT_ORACLE_SEED", 9);
    TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[seed; 32]))
}

/// Returns the first pixel at which two renders differ: target, x, y, and both values.
fn difference(got: &[Surface], expected: &[Surface]) -> Option<(usize, u32, u32, String)> {
    for (target, (g, e)) in got.iter().zip(expected).enumerate() {
        for (name, g, e, width) in [("word", &g.words, &e.words, g.width), ("depth", &g.depth, &e.depth, g.width)] {
            assert_eq!(g.len(), e.len(), "{name}s of target {target}");
            if g != e
                && let Some(at) = (0..g.len()).find(|at| g[*at] != e[*at])
            {
                let (x, y) = (at as u32 % width, at as u32 / width);
                return Some((target, x, y, format!("{name} {:#010x}, oracle {:#010x}", g[at], e[at])));
            }
        }
    }
    None
}

/// Compares every way to render a scene with the oracle.
fn compare(scene: &Scene, policies: &Policies) -> Result<(), String> {
    let expected = model::render(scene, policies);
    for (prune, threads) in [(true, 1), (false, 1), (true, 3)] {
        let plan = Plan::compile(scene, &PlanOptions { policies: *policies, prune }).map_err(|e| format!("{e:?}"))?;
        let frames = render(&plan, &RenderOptions { threads, ..RenderOptions::default() });
        if let Some((target, x, y, what)) = difference(&frames.surfaces, &expected) {
            let text = trace(&plan, target, (x, y), None).map_or_else(|e| format!("{e:?}"), |t| trace_text(&plan, &t));
            return Err(format!("target {target} ({x}, {y}), prune {prune}, threads {threads}: {what}\n{text}"));
        }
    }
    Ok(())
}

/// Compares random scenes, a third of them with other policies. In the first `counted` scenes each name of `wanted` has to occur `often`
/// times. Counting in all of them would take longer than drawing them.
fn run(
    cases: u32,
    scenes: BoxedStrategy<Scene>,
    (counted, often): (u32, u64),
    wanted: impl FnOnce(&mut dyn FnMut(&'static str, &[&'static str])),
) {
    let policies = prop_oneof![2 => Just(Policies::DEFAULT), 1 => policies()];
    let (done, tally) = (Cell::new(0), RefCell::new(BTreeMap::new()));
    let compared = |(scene, policies)| {
        let compare = || compare(&scene, &policies).map_err(TestCaseError::fail);
        if done.replace(done.get() + 1) >= counted {
            return compare();
        }
        let (result, met) = model::tally::during(compare);
        for (name, count) in met {
            *tally.borrow_mut().entry(name).or_insert(0) += count;
        }
        result
    };
    match runner(cases).run(&(scenes, policies), compared) {
        Err(TestError::Fail(reason, (scene, policies))) => {
            panic!("{reason}\n{policies:?}\n{scene:?}\ntests/oracle has the rules again, from their pages")
        }
        other => other.unwrap(),
    }
    let tally = tally.into_inner();
    println!("{tally:#?}");
    let least = often * u64::from(cases.min(counted)) / u64::from(counted);
    let mut missing = Vec::new();
    wanted(&mut |group, names| {
        let seldom = |name: &&&'static str| tally.get(&(group, **name)).copied().unwrap_or(0) < least;
        missing.extend(names.iter().filter(seldom).map(|name| (group, *name)));
    });
    assert!(missing.is_empty(), "too seldom: {missing:?}");
}

/// Returns any combination of policy values.
fn policies() -> impl Strategy<Value = Policies> {
    proptest::collection::vec(0..3_usize, POLICIES.len()).prop_map(|values| {
        let mut policies = Policies::DEFAULT;
        for (policy, value) in POLICIES.iter().zip(values) {
            policies.choose(policy.rule, value % policy.values.len());
        }
        policies
    })
}

#[test]
fn random_scenes_agree() {
    run(settings::number("NINEBIT_ORACLE_SCENES", 2000), random_scene::scene().boxed(), (400, 500), |need| {
        // Depth formats and volumes occur only in the wider scenes.
        let depths = TextureFormat::ALL.iter().position(|format| format.depth().is_some()).unwrap_or(0);
        need("TextureFormat", &TextureFormat::NAMES[..depths]);
        need("TextureKind", &TextureKind::NAMES[..3]);
        need("outside", AddressMode::NAMES);
        need("cube edge", &["Wrap"]);
        need("border", &["color", "texels"]);
        need("face", &["+X", "-X", "+Y", "-Y", "+Z", "-Z"]);
        need("level", &["0", "1", "2", "3", "4"]);
        for group in
            ["magnified", "minified without levels", "minified to the nearest level", "minified between levels"]
        {
            need(group, Filter::NAMES);
        }
        need("lod", &["least", "measured"]);
        need("samples", &["of a centre inside", "of a centre outside"]);
        if random_scene::FOG_FUNCTIONS {
            need(FogMode::TYPE, FogMode::NAMES);
        }
        if random_scene::TEXTURE_SHADERS {
            need(DotMapping::TYPE, DotMapping::NAMES);
            need("fragment", &["culled", "kept"]);
            need("operation", &OPERATIONS.split(' ').collect::<Vec<_>>());
        }
    });
}

#[test]
fn wider_random_scenes_agree() {
    run(
        settings::number("NINEBIT_ORACLE_WIDE_SCENES", 1000),
        random_scene::wide::scene().boxed(),
        (1000, 10),
        |need| {
            need("TextureFormat", TextureFormat::NAMES);
            need("TextureKind", TextureKind::NAMES);
            need("shadow", CompareFunction::NAMES);
            need("reference", ShadowReference::NAMES);
            need("layer", AddressMode::NAMES);
            need("layer", &["inside"]);
            need("other kind", &["Cube", "ThreeDimensional"]);
            need("taps", &["1", "2", "4", "6", "8"]);
            need("cylinder", &["moved", "stays"]);
            need("texels", &["longer than pixels", "shorter than pixels"]);
        },
    );
}

#[test]
fn random_scenes_draw_something() {
    let strategy = random_scene::scene();
    let mut runner = runner(400);
    let mut rich = || {
        let scene = strategy.new_tree(&mut runner).unwrap().current();
        let plain = Scene { draws: Vec::new(), ..scene.clone() };
        let [before, after] = [&plain, &scene].map(|scene| {
            let plan = Plan::compile(scene, &PlanOptions::default()).unwrap();
            let surfaces = render(&plan, &RenderOptions::default()).surfaces;
            surfaces.into_iter().flat_map(|surface| surface.words).collect::<Vec<u32>>()
        });
        let changed = before.iter().zip(&after).filter(|(before, after)| before != after).count();
        changed > 10 && after.into_iter().collect::<BTreeSet<u32>>().len() > 3
    };
    let rich = (0..400).filter(|_| rich()).count();
    assert!(rich >= 200, "{rich} of 400");
}

/// Returns floats of all kinds. The exponents of most of them are close, so that sums of them matter.
fn number() -> impl Strategy<Value = f32> {
    let moderate = (any::<u32>(), 118_u32..136).prop_map(|(bits, e)| bits & 0x807f_ffff | e << 23);
    // Mantissas whose middle bits are all 1 are truncated, not rounded.
    let ones = moderate.clone().prop_map(|bits| bits | 255 << 10);
    let few = (moderate.clone(), 0_u32..23).prop_map(|(bits, zeros)| bits >> zeros << zeros);
    let odd = prop::sample::select(vec![
        0,
        1 << 31,
        1,
        0x7f_ffff,
        0x80_0000,
        0x7f80_0000,
        0xff80_0000,
        0x7f80_0001,
        0x7f7f_ffff,
    ]);
    prop_oneof![6 => moderate, 2 => ones, 2 => few, 1 => any::<u32>(), 1 => odd].prop_map(f32::from_bits)
}

proptest! {
    #![proptest_config(Config { cases: 20_000, failure_persistence: None, ..Config::default() })]

    /// FOG-1, FOG-3, INT-5n: compares the value that a vertex passes on, for arbitrary floats.
    #[test]
    fn words_of_the_light_unit(
        mode in 0..FogMode::ALL.len(), p0 in number(), p1 in number(), p2 in prop_oneof![1 => Just(0.0), 1 => number()], d in number(),
        per_vertex in any::<bool>(),
    ) {
        let function = FogFunction { mode: FogMode::ALL[mode], p0, p1, p2, per_vertex };
        for profile in Profile::ALL {
            let (got, expected) = (passed(&function, *profile, d), model::fog::at_vertex(&function, *profile, d));
            let same = got.to_bits() == expected.to_bits() || (got.is_nan() && expected.is_nan());
            // Zeros of different sign count as equal.
            prop_assert!(same || (got == 0.0 && expected == 0.0), "{:?}: {:#x}, oracle {:#x}", profile, got.to_bits(), expected.to_bits());
        }
    }
}

/// The names of all operations of the texture shader.
const OPERATIONS: &str = "None Sample Sample2D SampleCube PassThrough CullFragment BumpEnvironment DependentAlphaRed \
    DependentGreenBlue DotProduct DotProduct2D DotProduct3D DotProductCube DotReflectDiffuse DotReflectSpecular \
    DotReflectConstantEye";

/// A number that is a multiple of 2^-20 from -2 to 2, which may be few bits long.
fn small(random: &mut Random) -> f32 {
    let bits = random.bits();
    let short = (bits >> 40) as u32 % 20;
    ((bits as i32 >> 10) >> short << short) as f32 / 2.0_f32.powi(20)
}

/// Returns a light for the model.
fn light(light: &model::light::Light) -> Light {
    match *light {
        model::light::Light::Far { direction, half } => Light::Infinite { direction, half },
        model::light::Light::Near { position, attenuation, range, cone } => {
            let spot = cone.map(|(direction, offset, falloff)| Spot { falloff, direction, offset });
            Light::Local { position, attenuation, range, spot }
        }
    }
}

/// Returns the state of the model that lights by a material of the oracle.
fn shading(material: &model::light::Material, separate: bool) -> Shading {
    let [emission, ambient, diffuse, specular] = material.sources.map(|source| match source {
        model::light::Source::Material => ColorSource::Material,
        model::light::Source::Diffuse => ColorSource::Diffuse,
        model::light::Source::Specular => ColorSource::Specular,
    });
    let front = Side {
        sources: Sources { emission, ambient, diffuse, specular },
        ambient: [material.scene; 3],
        factor: [material.factor; 3],
        alpha: 1.0,
        powers: material.powers,
        colors: material.lights.iter().map(|(_, colors)| colors.map(|red| [red; 3])).collect(),
    };
    let lighting = Lighting {
        lights: material.lights.iter().map(|(one, _)| light(one)).collect(),
        front,
        back: None,
        local_eye: material.local_eye,
        eye_direction: [0.0, 0.0, -1.0],
    };
    let secondary = SecondaryColor { enabled: true, separate, keeps_alpha: true };
    Shading { lighting: Some(lighting), secondary }
}

/// Lights of every kind, with all sources of colours, on random vertices (VTX-5, VTX-6).
#[test]
fn lit_vertices_are_the_same() {
    use model::light::{Light, Material, Source};
    let mut random = Random::seeded(6);
    let mut counts = [0; 3];
    for case in 0..20_000_usize {
        let mut number = || small(&mut random);
        let mut three = || [number(), number(), number()];
        let (point, normal) = (three(), three());
        let [mut position, attenuation, direction, half, falloff] = [(); 5].map(|()| three());
        position[2] += 4.0;
        let attenuation = attenuation.map(|c| c.abs() + 0.125);
        let (range, offset) = (3.0 + 2.0 * number(), number());
        let first = match case % 3 {
            0 => Light::Far { direction, half },
            kind => {
                Light::Near { position, attenuation, range, cone: (kind == 2).then_some((direction, offset, falloff)) }
            }
        };
        let source = |n: usize| [Source::Material, Source::Diffuse, Source::Specular][case / n % 3];
        let second = Light::Far { direction: normal, half };
        let material = Material {
            sources: [3, 9, 27, 81].map(source),
            scene: number(),
            factor: number(),
            powers: [(); 6].map(|()| number()),
            lights: [first, second].map(|light| (light, [number(), number(), number()])).to_vec(),
            local_eye: case / 243 % 2 == 1,
        };
        let (given, separate) = ([number(), number()], case / 486 % 2 == 1);
        let [x, y, z] = point.map(f32::to_bits);
        let surface = LitSurface::new([x, y, z, 1.0_f32.to_bits()], normal.map(f32::to_bits), [0.0; 3]);
        let (colors, _) = shading(&material, separate).colors(&surface, given.map(|red| [red; 4]));
        // The oracle knows no infinities, which divisors of 0 give.
        if colors.iter().any(|color| !color[0].is_finite()) {
            continue;
        }
        let expected = model::light::red(&material, separate, point, normal, given).map(|red| red.real() as f32);
        assert_eq!(colors[0][0], expected[0], "case {case}, primary: {material:?}");
        if separate {
            assert_eq!(colors[1][0], expected[1], "case {case}, secondary: {material:?}");
        }
        counts[case % 3] += 1;
    }
    assert!(counts.iter().all(|count| *count > 6_000), "{counts:?}");
}
