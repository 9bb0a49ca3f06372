//! VTX-6: lights of every kind on meshes.

use super::lighting::*;
use super::meshes;
use super::space::STRAIGHT;
use super::*;

/// The bits of the light control.
const SEPARATE: u32 = 1;
const LOCAL_EYE: u32 = 1 << 16;
const ALPHA_OF_VERTEX: u32 = 1 << 17;

/// The light of the scene in several suites.
const DIM: [f32; 3] = [0.031_373; 3];

/// Colours of a vertex.
const NO_COLORS: [[f32; 4]; 2] = [[0.0, 0.0, 0.0, 0.0], [1.0, 1.0, 1.0, 0.25]];

/// Adds those frames of Lighting_control that the fixed function draws: every light control, with and without secondary colours.
pub(super) fn controls(frames: &mut Frames) {
    let colors = [[0.0, 0.0, 0.05], [0.25, 0.0, 0.0], [0.0, 0.2, 0.4]];
    let lamps = [
        (directional(normalized([1.0, 0.0, 1.0])), colors),
        (point([1.5, 1.0, -2.5], 4.0, [0.025, 0.15, 0.02]), colors),
    ];
    for word in
        [0, SEPARATE, LOCAL_EYE, LOCAL_EYE | SEPARATE].into_iter().flat_map(|word| [word, word | ALPHA_OF_VERTEX])
    {
        let both = shading(&lamps, material(DIM, 0.4, POWER_OF_GAME), word);
        for (suffix, shading) in [("", both.clone()), ("NoSpec", without_secondary(&both))] {
            frames.paint(format!("FF_0x{word:06X}{suffix}"), 0xff23_2623, move |canvas| {
                background(canvas, [0xff20_2020, 0xff00_0000], 24);
                for places in meshes::solids() {
                    let given = [[0.0, 0.0, 0.0, 0.75], [0.0, 0.4, 0.0, 0.25]];
                    let given = of_mesh(&places, given);
                    canvas.draw(drawn(Topology::Triangles, given, &shading, SurfaceSide::Front, &summed(true, true)));
                }
            });
        }
    }
}

/// The normals of Lighting_normals, by the names of frames; the first frame gives none.
const NORMALS: [(&str, Option<[f32; 3]>); 7] = [
    ("NoNormal", None),
    ("Nz_100", Some([0.0, 0.0, 1.0])),
    ("Nz_-100", Some([0.0, 0.0, -1.0])),
    ("Nz_0", Some([1.0, 0.0, 0.0])),
    ("Nz_70", Some([std::f32::consts::FRAC_1_SQRT_2, 0.0, std::f32::consts::FRAC_1_SQRT_2])),
    ("Nz_31", Some([0.948_683_3, 0.0, 0.316_227_77])),
    ("Nz_97", Some([0.242_535_63, 0.0, 0.970_142_5])),
];

/// Adds the frames of Lighting_normals: a draw that gives no normals has the last one of the draw before. The way that vertices reach the chip
/// changes no pixel.
pub(super) fn normals(frames: &mut Frames) {
    let lamp = (Light::Infinite { direction: [0.0, 0.0, 1.0], half: [0.0; 3] }, [[0.0; 3], [0.0, 1.0, 0.7], [0.0; 3]]);
    let shading = |word| shading(&[lamp], material([0.0; 3], 1.0, POWER_10), word);
    let triangle = |left: f32, right: f32, z: f32, normals: [[f32; 3]; 3], word: u32| {
        let corners = [[left, 1.75], [right, 1.75], [left + (right - left) * 0.5, -1.75]];
        let given = corners.into_iter().zip(normals).map(|([x, y], normal)| LitVertex {
            position: [x, y, z, 1.0],
            normal,
            diffuse: [1.0; 4],
            specular: [0.0; 4],
        });
        drawn(
            Topology::Triangles,
            given,
            &shading(word),
            SurfaceSide::Front,
            &Combiners::showing(FinalRegister::PrimaryColor),
        )
    };
    for (name, normal) in NORMALS {
        let mut canvas = Canvas::new(0xff30_3030);
        if let Some(normal) = normal {
            canvas.draw(triangle(-2.75, 0.0, 3.0, [[0.0; 3], [0.0; 3], normal], ALPHA_OF_VERTEX | SEPARATE));
        }
        canvas.draw(triangle(0.0, 2.75, 1.0, [normal.unwrap_or_default(); 3], LOCAL_EYE | SEPARATE));
        let drawn = canvas.colors();
        for kind in ["", "-inlinebuf", "-inlinearrays", "-inlineelements"] {
            frames.push(format!("{name}{kind}"), drawn.clone());
        }
    }
}

/// Adds the frames of Lighting_range: the reach of a light, over a square turned by 45 degrees and two rectangles.
pub(super) fn ranges(frames: &mut Frames) {
    let (range, attenuation) = (8.0, [0.000_1, 0.0, 0.0]);
    let colors = [[0.05; 3], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let at = [0.0, 0.0, -7.0];
    for (name, light) in [
        ("Directional", directional([0.0, 0.0, 1.0])),
        ("Point", point(at, range, attenuation)),
        ("Spot", spotlight(at, range, attenuation, [45.0, 10.0], [0.0, -0.494_592, 1.494_592])),
    ] {
        let shading = shading(&[(light, colors)], material(DIM, 0.75, POWER_OF_GAME), SEPARATE | ALPHA_OF_VERTEX);
        frames.paint(name, 0xff23_2623, move |canvas| {
            background(canvas, [0xff20_2020, 0xff90_9090], 24);
            let back = [-std::f32::consts::FRAC_1_SQRT_2, std::f32::consts::FRAC_1_SQRT_2];
            let turned = space::rotated([STRAIGHT, back, STRAIGHT]);
            let turn = |[x, y, z]: [f32; 3]| {
                let [x, y, z, _] = space::in_single([x, y, z, 1.0], &turned);
                [x, y, z]
            };
            let places: Vec<meshes::Place> =
                meshes::grid().into_iter().map(|(position, normal)| (turn(position), turn(normal))).collect();
            let both = summed(true, true);
            canvas.draw(drawn(Topology::Triangles, of_mesh(&places, NO_COLORS), &shading, SurfaceSide::Front, &both));
            for (left, z) in [(24.0, -2.0), (640.0 - (24.0 + 128.0), 2.0)] {
                let world = unprojected_corners(sized([left, 64.0], [128.0, 256.0]), z, &inverse());
                let given = world.into_iter().zip(TILTED).map(|(position, normal)| LitVertex {
                    position,
                    normal,
                    diffuse: [1.0, 0.5, 1.0, 0.25],
                    specular: [0.0, 0.5, 1.0, 0.25],
                });
                canvas.draw(drawn(Topology::Quads, given, &shading, SurfaceSide::Front, &both));
            }
        });
    }
}

/// The normals of the corners of quads, clockwise from the upper left.
pub(super) const TILTED: [[f32; 3]; 4] = {
    let (side, front) = (0.099_014_75, -0.990_147_54);
    [[-side, -side, front], [side, -side, front], [side, side, front], [-side, side, front]]
};

/// A frame of Lighting_spotlight: its name, the angles of the cones, the attenuation and the words of the falloff.
type Cone = (String, [f32; 2], [f32; 3], [f32; 3]);

fn cones() -> Vec<Cone> {
    let falloffs = [
        [0.0, -0.494_592, 1.494_592],
        [-0.0, 1.0, 0.0],
        [-0.000_244, 0.500_122, 0.499_634],
        [-0.170_208, -0.855_843, 1.685_635],
        [-0.706_496, -2.507_095, 2.800_6],
        [-0.932_112, -3.097_628, 3.165_516],
        [-0.986_137, -3.165_117, 3.178_98],
        [-0.993_286, -2.953_324, 2.960_038],
        [-0.996_561, -3.084_043, 3.087_482],
        [0.0; 3],
    ];
    let (angles, constant, square) = ([30.0, 10.0], [1.0, 0.0, 0.0], falloffs[3]);
    // The program's -0.0 is a constant 0.
    let number = |c: f32| format!("{:.6}", c + 0.0);
    let by_falloff = falloffs.map(|f| (format!("FoFixed_{}", f.map(number).join("_")), angles, constant, f));
    let pairs = [[25.0, 5.0], [25.0, 0.0], [10.0, 25.0], [10.0, 10.0], [0.0, 0.0], [-10.0, -10.0_f32]];
    let by_angles = pairs.map(|pair| (format!("PTFixed_{}", pair.map(number).join("_")), pair, constant, square));
    let attenuations = [
        [0.0, 0.0, 0.0],
        [0.5, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [10.0, 0.0, 0.0],
        [0.05, 0.25, 0.0],
        [0.05, 0.0, 0.25],
        [0.05, 0.05, 0.05],
    ];
    let by_attenuation = attenuations.map(|a| (format!("AtFixed_{}", a.map(number).join("_")), angles, a, square));
    by_falloff.into_iter().chain(by_angles).chain(by_attenuation).collect()
}

/// Adds the frames of Lighting_spotlight: cones of all shapes.
pub(super) fn spotlights(frames: &mut Frames) {
    for (name, angles, attenuation, falloff) in cones() {
        let light = spotlight([0.0, 0.0, -7.0], 15.0, attenuation, angles, falloff);
        let lamp = (light, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 0.5]]);
        let control = ALPHA_OF_VERTEX | LOCAL_EYE | SEPARATE;
        let shading = shading(&[lamp], material([0.01; 3], 0.4, POWER_OF_GAME), control);
        frames.paint(name, 0xff23_2623, move |canvas| {
            background(canvas, [0xff11_1111, 0xff00_0000], 16);
            for places in [meshes::grid(), meshes::cylinder()] {
                let given = [[1.0, 0.0, 1.0, 1.0], [0.0, 0.4, 0.0, 0.25]];
                let given = of_mesh(&places, given);
                canvas.draw(drawn(Topology::Triangles, given, &shading, SurfaceSide::Front, &summed(true, true)));
            }
        });
    }
}

/// Adds the frames of Lighting_accumulation: up to five lights of a kind, or one of each.
pub(super) fn accumulation(frames: &mut Frames) {
    let colors = [[0.0, 0.1, 0.0], [0.2, 0.0, 0.0], [0.0, 0.0, 0.2]];
    let (at, range, attenuation) = ([0.0, 0.0, -2.0], 3.0, [1.0, 0.0, 0.0]);
    let lights = [
        ("Directional", directional([0.0, 0.0, 1.0])),
        ("Point", point(at, range, attenuation)),
        ("Spot", spotlight(at, range, attenuation, [45.0, 10.0], [0.0, -0.494_592, 1.494_592])),
    ];
    let powers = [-0.170_208, -0.855_843, 1.685_63, -0.0, -0.494_592, 1.494_59];
    let mut add = |name: String, lights: &[Light]| {
        let lamps: Vec<Lamp> = lights.iter().map(|light| (*light, colors)).collect();
        let shading = shading(&lamps, material([0.0; 3], 1.0, powers), SEPARATE | ALPHA_OF_VERTEX);
        frames.paint(name, 0xff23_2623, move |canvas| {
            background(canvas, [0xff20_2020, 0xff90_9090], 24);
            let places = meshes::grid();
            let given = of_mesh(&places, NO_COLORS);
            canvas.draw(drawn(Topology::Triangles, given, &shading, SurfaceSide::Front, &summed(true, true)));
        });
    };
    for (name, light) in lights {
        for count in [2, 4, 5] {
            add(format!("{name}-{count}"), &vec![light; count]);
        }
    }
    add(String::from("All"), &lights.map(|(_, light)| light));
}
