//! VTX-6: secondary colours, specular powers, and normals that are not of unit length.

use super::lighting::*;
use super::meshes;
use super::*;

/// The light of the scene.
const DIM: [f32; 3] = [0.031_373; 3];

/// The bits of the light control.
const SEPARATE: u32 = 1;
const LOCAL_EYE: u32 = 1 << 16;
const ALPHA_OF_VERTEX: u32 = 1 << 17;

/// Diffuse and specular colours of the corners of quads, clockwise from the upper left.
const CORNERS: [[[f32; 4]; 2]; 4] = [
    [[0.0, 0.0, 0.5, 1.0], [1.0, 0.0, 0.0, 0.15]],
    [[0.0, 0.0, 0.75, 1.0], [1.0, 0.0, 0.0, 0.75]],
    [[0.0, 0.0, 1.0, 1.0], [0.0, 1.0, 0.0, 1.0]],
    [[0.0, 0.0, 0.25, 1.0], [0.0, 1.0, 0.0, 0.2]],
];

/// Specular powers by the names of frames.
const POWERS: [(&str, [f32; 6]); 11] = [
    ("MechAssault", POWER_OF_GAME),
    ("NinjaGaidenBlack", [-0.932_112, -3.097_628, 3.165_516, -0.869_21, -2.935_466, 3.066_255]),
    ("AllZero", [0.0; 6]),
    ("InvMechAssault", [0.838_916, 2.887_156, -3.048_239, 0.706_496, 2.507_095, -2.800_6]),
    ("Pow0_1", [-0.0, 0.9, 0.1, -0.0, 0.95, 0.05]),
    ("Pow1_0", [-0.0, -0.494_592, 1.494_59, -0.000_244, 0.500_122, 0.499_634]),
    ("Pow2_0", [-0.170_208, -0.855_843, 1.685_63, -0.0, -0.494_592, 1.494_59]),
    ("Pow4_0", [-0.421_539, -1.705_92, 2.284_38, -0.170_208, -0.855_842, 1.685_63]),
    ("Pow8_0", [-0.647_66, -2.361_99, 2.714_33, -0.421_539, -1.705_92, 2.284_38]),
    ("Pow16_0", POWER_16),
    ("Pow24_0", [-0.863_702, -2.927_01, 3.063_31, -0.747_554, -2.618_4, 2.870_85]),
];

/// Draws four rows of four quads: secondary and primary colours, first with no secondary colours enabled, and four words of the light control.
fn rows(
    canvas: &mut Canvas,
    world: impl Fn([f32; 4]) -> [[f32; 4]; 4],
    seen: SurfaceSide,
    normals: [[f32; 3]; 4],
    colors: [[[f32; 4]; 2]; 4],
    shading: impl Fn(u32) -> Shading,
) {
    let (width, height) = (640.0_f32 / 6.0, 480.0_f32 / 6.0);
    let mut top = height + 15.0;
    for (enabled, register) in [
        (false, FinalRegister::SecondaryColor),
        (false, FinalRegister::PrimaryColor),
        (true, FinalRegister::SecondaryColor),
        (true, FinalRegister::PrimaryColor),
    ] {
        let mut left = width;
        for word in [SEPARATE | ALPHA_OF_VERTEX, SEPARATE, ALPHA_OF_VERTEX, 0] {
            let shading = shading(word);
            let shading = if enabled { shading } else { without_secondary(&shading) };
            let given = world([left, top, left + width, top + height]).into_iter().zip(normals).zip(colors);
            let given = given.map(|((position, normal), [diffuse, specular])| LitVertex {
                position,
                normal,
                diffuse,
                specular,
            });
            let combiners = Combiners::showing(register);
            canvas.draw(drawn(Topology::Quads, given, &shading, seen, &combiners));
            left += width + 15.0;
        }
        top += height + 15.0;
    }
}

/// Returns the frames of the flags of control: their names, their lights, and whether they are lit at all.
fn controls(lamp: Lamp) -> [(&'static str, Vec<Lamp>, bool); 3] {
    [
        ("ControlFlagsLightDisable_FF", vec![], false),
        ("ControlFlagsNoLight_FF", vec![], true),
        ("ControlFlags_FF", vec![lamp], true),
    ]
}

/// Adds the frames of Specular that the fixed function draws.
pub(super) fn fronts(frames: &mut Frames) {
    let light = directional([1.0, 0.0, 1.0]);
    let colors = [[0.0, 0.0, 0.05], [0.25, 0.0, 0.0], [0.0, 0.2, 0.4]];
    for (name, lamps, is_lit) in controls((light, colors)) {
        frames.paint(name, 0xfe32_3232, move |canvas| {
            background(canvas, [0xff20_2020, 0xff00_0000], 14);
            let inverse = inverse();
            let near = |edges| corners(edges).map(|[x, y]| space::unproject_depth([x, y, 1.0, 1.0], &inverse));
            rows(canvas, near, SurfaceSide::Front, lights::TILTED, CORNERS, |word| {
                let shading = shading(&lamps, material(DIM, 0.75, POWER_16), word);
                if is_lit { shading } else { Shading { lighting: None, ..shading } }
            });
        });
    }
    for (name, powers) in POWERS {
        let lamps = [(light, colors), (point([1.5, 1.0, -2.5], 4.0, [0.025, 0.15, 0.02]), colors)];
        let shading = shading(&lamps, material([0.1; 3], 0.75, powers), SEPARATE);
        frames.paint(format!("SpecParams_FF_{name}"), 0xfe31_3131, move |canvas| {
            background(canvas, [0xff20_2020, 0xff00_0000], 20);
            solids(canvas, [[0.0, 0.0, 0.0, 0.75], [0.0, 0.4, 0.0, 0.25]], &shading, SurfaceSide::Front);
        });
    }
    for length in [0.972_f32, 0.973, 1.0, 1.008, 1.009] {
        frames.paint(format!("NonUnitNormal_{length:.3}"), 0xfe32_3232, move |canvas| disc(canvas, length));
    }
}

/// Draws the secondary colours of all meshes.
fn solids(canvas: &mut Canvas, colors: [[f32; 4]; 2], shading: &Shading, seen: SurfaceSide) {
    for places in meshes::solids() {
        let places: Vec<meshes::Place> = match seen {
            SurfaceSide::Front => places,
            SurfaceSide::Back => places.into_iter().map(|(position, [x, y, z])| (position, [x, y, -z])).collect(),
        };
        let combiners = Combiners::showing(FinalRegister::SecondaryColor);
        canvas.draw(drawn(Topology::Triangles, of_mesh(&places, colors), shading, seen, &combiners));
    }
}

/// Draws a disc whose normals stand as on a sphere, times a length.
fn disc(canvas: &mut Canvas, length: f32) {
    background(canvas, [0xff20_2020, 0xff90_9090], 14);
    let lamp = (directional([0.0, 0.0, 1.0]), [[0.0; 3], [1.0; 3], [1.0; 3]]);
    let control = SEPARATE | LOCAL_EYE | ALPHA_OF_VERTEX;
    let shading = shading(&[lamp], material([0.0; 3], 1.0, POWER_125), control);
    let inverse = inverse();
    let given = |place: [f32; 2], normal: fn([f32; 4]) -> [f32; 3]| {
        let position = space::unproject(place, 0.0, &inverse);
        let normal = normal(position).map(|c| c * length);
        LitVertex { position, normal, diffuse: [0.0; 4], specular: [0.0; 4] }
    };
    let step = (2.0 * std::f64::consts::PI) as f32 / 64.0;
    let rim = (0..=64_u8).map(|n| {
        let angle = f64::from(f32::from(n % 64) * step);
        let place = [320.0 + 128.0 * angle.cos() as f32, 240.0 + 128.0 * angle.sin() as f32];
        given(place, |[x, y, ..]| normalized([-x, -y, -3.0]))
    });
    let fan = [given([320.0, 240.0], |_| [0.0, 0.0, -1.0])].into_iter().chain(rim);
    let combiners = opaque(FinalRegister::SecondaryColor);
    canvas.draw(drawn(Topology::TriangleFan, fan, &shading, SurfaceSide::Front, &combiners));
}

/// Adds the frames of Specular_back that the fixed function draws.
pub(super) fn backs(frames: &mut Frames) {
    let light = directional([1.0, 0.0, 1.0]);
    let colors = [[0.05, 0.05, 0.0], [0.7, 0.0, 0.0], [0.0, 0.75, 0.0]];
    let normals = [[-0.1, 0.05], [0.1, 0.05], [0.1, -0.05], [-0.1, -0.05]].map(|[x, y]| normalized([x, y, 0.85]));
    // The back is lit with the front's colours of the vertex.
    let given = [[0.0, 1.0, 0.5, 1.0], [0.0, 0.0, 1.0, 0.33]];
    for (name, lamps, is_lit) in controls((light, colors)) {
        frames.paint(name, 0xfe32_3232, move |canvas| {
            background(canvas, [0xff90_9090, 0xff20_2020], 14);
            let inverse = inverse();
            let world = |edges| unprojected_corners(edges, 1.0, &inverse);
            rows(canvas, world, SurfaceSide::Back, normals, [given; 4], |word| {
                let shading = behind(&lamps, POWER_16, 0.75, word);
                if is_lit { shading } else { Shading { lighting: None, ..shading } }
            });
        });
    }
    let of_point = [[0.05, 0.05, 0.0], [0.9, 0.0, 0.0], [0.0, 0.9, 0.0]];
    for (name, powers) in POWERS {
        let lamps = [(light, colors), (point([1.5, 1.0, -2.5], 4.0, [0.025, 0.15, 0.02]), of_point)];
        let shading = behind(&lamps, powers, 0.75, SEPARATE);
        frames.paint(format!("SpecParams_FF_{name}"), 0xfe31_3131, move |canvas| {
            background(canvas, [0xff20_2020, 0xff00_0000], 20);
            solids(canvas, [[1.0, 0.0, 1.0, 0.75], [1.0, 0.0, 1.0, 0.15]], &shading, SurfaceSide::Back);
        });
    }
}

/// Returns the state that lights backs. No colour of the front counts.
fn behind(lamps: &[Lamp], powers: [f32; 6], alpha: f32, word: u32) -> Shading {
    let front = shading(lamps, material([0.0; 3], 0.15, [0.0; 6]), word);
    let colors = lamps.iter().map(|(_, colors)| *colors).collect();
    with_back(&front, Side { colors, ..material([0.0; 3], alpha, powers) })
}
