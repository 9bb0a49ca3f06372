//! VTX-6: colours of materials, their sources, and their alpha.

use super::lighting::*;
use super::*;

/// The light control of these programs.
const SEPARATE: u32 = 1;
const LOCAL_EYE: u32 = 1 << 16;
const ALPHA_OF_VERTEX: u32 = 1 << 17;

/// A light straight behind the viewer whose half vector is zero.
const BEHIND: Light = Light::Infinite { direction: [0.0, 0.0, 1.0], half: [0.0; 3] };

/// Colours of Material_color_source: of the vertices, and of the legend.
const VERTEX_DIFFUSE: [f32; 4] = [0.1, 0.4, 0.1, 0.25];
const VERTEX_SPECULAR: [f32; 4] = [0.4, 0.1, 0.1, 0.25];
const LEGEND: [[f32; 3]; 7] =
    [[0.1, 0.4, 0.1], [0.4, 0.1, 0.1], [0.2; 3], [0.0, 0.4, 0.0], [0.4, 0.0, 0.0], [0.0, 0.0, 0.4], [0.1; 3]];

/// Draws a quad of the world for a rectangle of the screen, at depth 0 of the world.
fn quad(edges: [f32; 4], diffuse: [f32; 4], shading: &Shading, combiners: &Combiners) -> Draw {
    let given = unprojected_corners(edges, 0.0, &inverse()).into_iter().map(|position| LitVertex {
        position,
        normal: [0.0, 0.0, -1.0],
        diffuse,
        specular: VERTEX_SPECULAR,
    });
    drawn(Topology::Quads, given, shading, SurfaceSide::Front, combiners)
}

/// Draws three rows of one material: primary colour, secondary colour, both. The right halves are opaque.
fn swatch(canvas: &mut Canvas, [left, top]: [f32; 2], shading: &Shading) {
    for (row, [primary, secondary]) in [[true, false], [false, true], [true, true]].into_iter().enumerate() {
        let top = top + 32.0 * row as f32;
        let combiners = summed(primary, secondary);
        let mut opaque = combiners.clone();
        (opaque.final_combiner.g.register, opaque.final_combiner.g.invert) = (FinalRegister::Zero, true);
        for (left, combiners) in [(left, &combiners), (left + 64.0, &opaque)] {
            canvas.draw(quad(sized([left, top], [64.0, 32.0]), VERTEX_DIFFUSE, shading, combiners));
        }
    }
}

/// Draws nine materials with their own sources, and the legend of colours.
fn swatches(canvas: &mut Canvas, sources: [Sources; 9], shading: &Shading) {
    background(canvas, [0xff20_2020, 0xff90_9090], 20);
    for (sources, place) in sources.into_iter().zip(places([126.0, 100.0], [132.0, 100.0], 3)) {
        let mut shading = shading.clone();
        if let Some(lighting) = &mut shading.lighting {
            lighting.front.sources = sources;
        }
        swatch(canvas, place, &shading);
    }
    let unlit = Shading { lighting: None, ..shading.clone() };
    for ([r, g, b], top) in LEGEND.into_iter().zip(0_u8..) {
        let place = sized([16.0, 120.0 + 25.0 * f32::from(top)], [94.0, 25.0]);
        canvas.draw(quad(place, [r, g, b, 1.0], &unlit, &summed(true, false)));
    }
}

/// Adds the frames of Material_color_source.
pub(super) fn sources(frames: &mut Frames) {
    use ColorSource::{Diffuse, Material, Specular};
    let light = directional([0.0, 0.0, 1.0]);
    let lamps = [(light, [[0.1; 3], [0.0, 0.4, 0.0], [0.4, 0.0, 0.0]]), (light, [[0.25; 3]; 3])];
    // Which of diffuse colour, specular colour, emission and ambient colour come from the vertex.
    let taken = [
        [1, 0, 0, 0],
        [1, 1, 0, 0],
        [0, 1, 0, 0],
        [1, 0, 1, 0],
        [1, 1, 1, 1],
        [0, 1, 0, 1],
        [0, 0, 1, 0],
        [0, 0, 1, 1],
        [0, 0, 0, 1],
    ];
    for (suffix, factor) in [("", 0.0), ("_me0_15", 0.15), ("_me0_5", 0.5), ("_me1_0", 1.0)] {
        let of = |lamps: &[Lamp], scene: [f32; 3]| {
            let material = Side { factor: [factor; 3], ..material(scene, 0.75, POWER_125) };
            shading(lamps, material, SEPARATE | ALPHA_OF_VERTEX)
        };
        for (name, source) in
            [("FromMaterial", Material), ("FromVertexDiffuse", Diffuse), ("FromVertexSpecular", Specular)]
        {
            let sources = taken.map(|taken| {
                let [diffuse, specular, emission, ambient] = taken.map(|n| if n == 1 { source } else { Material });
                Sources { emission, ambient, diffuse, specular }
            });
            for (count, lights) in [(1, ""), (2, "_2light")] {
                let shading = of(&lamps[..count], [0.2, 0.2, 0.2 + 0.4]);
                frames.paint(format!("{name}{suffix}{lights}"), 0xff30_3030, move |canvas| {
                    swatches(canvas, sources, &shading);
                });
            }
        }
        let pairs = [
            [Diffuse, Diffuse],
            [Specular, Diffuse],
            [Diffuse, Specular],
            [Specular, Specular],
            [Material, Specular],
            [Specular, Material],
            [Material, Diffuse],
            [Diffuse, Material],
            [Material, Material],
        ];
        let sources = pairs.map(|[emission, ambient]| Sources { emission, ambient, ..Sources::MATERIAL });
        let shading = of(&lamps[..1], [0.2; 3]);
        let name = format!("Emissive{}", if suffix.is_empty() { "_me0" } else { suffix });
        frames.paint(name, 0xff30_3030, move |canvas| swatches(canvas, sources, &shading));
    }
}

/// Returns the two triangles of a rectangle: the normals of the first point ahead, those of the second back.
fn halves([left, top, right, bottom]: [f32; 4], z: f32, colors: [[[f32; 4]; 2]; 4], first: f32) -> Vec<LitVertex> {
    let given = |n: usize, normal: f32| {
        let [x, y] = corners([left, top, right, bottom])[n];
        let [diffuse, specular] = colors[n];
        LitVertex { position: [x, y, z, 1.0], normal: [0.0, 0.0, normal], diffuse, specular }
    };
    [(0, first), (1, first), (2, first), (0, 1.0), (2, 1.0), (3, 1.0)].map(|(n, normal)| given(n, normal)).to_vec()
}

/// Adds the frames of Material_color: products of lights and materials that the program computes.
pub(super) fn colors(frames: &mut Frames) {
    for name in ["001_RG0_11", "011_rBg_11", "011_rG0_B1", "301_rG0_11", "310_rG0_11", "311_rG0_11"] {
        let color = |at: usize| match name.as_bytes().get(at) {
            Some(b'R') => [1.0, 0.0, 0.0],
            Some(b'r') => [0.5, 0.0, 0.0],
            Some(b'G') => [0.0, 1.0, 0.0],
            Some(b'g') => [0.0, 0.5, 0.0],
            Some(b'B') => [0.0, 0.0, 1.0],
            Some(b'1') => [1.0; 3],
            Some(b'3') => [0.33; 3],
            _ => [0.0_f32; 3],
        };
        let times = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|k| a[k] * b[k]);
        let (scene, own, light) = (color(0), color(1), color(2));
        let (diffuse, specular, emission) = (color(4), color(5), color(6));
        let ambient = [0, 1, 2].map(|k| scene[k] * own[k] + emission[k]);
        let lamp = (BEHIND, [times(scene, light), times(diffuse, color(8)), times(specular, color(9))]);
        let shading = shading(&[lamp], material(ambient, 1.0, POWER_125), LOCAL_EYE | SEPARATE);
        let given = halves([-2.75, 1.75, 2.75, -1.75], 0.0, [[[1.0; 4]; 2]; 4], -1.0);
        let primary = Combiners::showing(FinalRegister::PrimaryColor);
        let drawn = drawn(Topology::Triangles, given.into_iter(), &shading, SurfaceSide::Front, &primary);
        frames.push(name, one(0xff30_3030, None, drawn));
    }
}

/// Colours of the corners of Material_alpha's two rectangles, clockwise from the upper left: diffuse and specular.
const ALPHA_COLORS: [[[[f32; 4]; 2]; 4]; 2] = [
    [
        [[0.4, 0.1, 0.1, 0.25], [0.0, 1.0, 0.0, 0.5]],
        [[0.5, 0.5, 0.5, 1.0], [0.0, 1.0, 1.0, 0.75]],
        [[0.0, 0.0, 1.0, 1.0], [1.0, 1.0, 0.0, 0.5]],
        [[0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.1]],
    ],
    [
        [[1.0, 1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.25]],
        [[0.0, 0.3, 0.8, 0.15], [0.9, 0.9, 0.4, 0.33]],
        [[1.0, 0.0, 0.0, 0.75], [0.95, 0.5, 0.8, 0.05]],
        [[0.5, 0.5, 0.5, 1.0], [0.3, 0.3, 1.0, 1.0]],
    ],
];

/// Adds the frames of Material_alpha: alpha of a material or of either colour of the vertex.
pub(super) fn alphas(frames: &mut Frames) {
    let colors = [0x3f6e_eeef, 0x3f3b_bbbc, 0x3f2a_aaab].map(f32::from_bits);
    let powers = [0xbf77_30e0, 0xc049_7b30, 0x404b_aef8, 0xbf6e_9ee4, 0xc046_3f88, 0x404a_97cf].map(f32::from_bits);
    let ambient = [0.0, f32::from_bits(0x3c6d_daca), 0.0];
    for (name, diffuse) in
        [("Mat", ColorSource::Material), ("VDiffuse", ColorSource::Diffuse), ("VSpec", ColorSource::Specular)]
    {
        for alpha in [-1.0_f32, 0.0, 0.05, 0.25, 0.5, 0.75, 1.0, 2.0] {
            let sources = Sources { diffuse, ..Sources::MATERIAL };
            let material = Side { sources, ..material(ambient, alpha, powers) };
            let shading = shading(&[(BEHIND, [[0.0; 3], colors, [0.0; 3]])], material, LOCAL_EYE | SEPARATE);
            let mut canvas = Canvas::new(0xff30_3030);
            let rectangles = [([-150.0, -156.0, 10.0, 150.0], 10.0, -1.0), ([-10.0, -156.0, 150.0, 150.0], 9.75, 1.0)];
            for ((edges, z, first), colors) in rectangles.into_iter().zip(ALPHA_COLORS) {
                let vertices = halves(edges, z, colors, first).into_iter().map(|given| {
                    let [x, y, ..] = given.position;
                    // Both matrices are the identity; the offset leads to the middle of the screen.
                    Vertex { position: [x + 320.0, y + 240.0, 0.0, 1.0], ..lit(&given, &shading, SurfaceSide::Front) }
                });
                canvas.draw(draw(Topology::Triangles, vertices.collect()));
            }
            frames.push(format!("MatA_S{name}_A{:X}", alpha.to_bits()), canvas.colors());
        }
    }
}

/// Adds the frame of Lighting_Two_Sided: quads from either side, with colours for the back and without.
pub(super) fn two_sides(frames: &mut Frames) {
    let lamp = (BEHIND, [[0.0; 3], [1.0, 0.0, 0.25], [0.0, 1.0, 0.0]]);
    let front = without_secondary(&shading(&[lamp], material([0.031_373; 3], 1.0, POWER_16), SEPARATE));
    let back = Side {
        colors: vec![[[0.0, 0.0, 0.25], [0.0, 0.75, 0.35], [0.66, 0.0, 0.66]]],
        ..material([0.0; 3], 0.5, [0.0; 6])
    };
    let both = with_back(&front, back);
    let quads: [([[f32; 2]; 4], f32, &Shading, SurfaceSide); 4] = [
        ([[-1.5, 0.1], [-1.25, 1.5], [-0.35, 1.5], [-0.25, 0.1]], 1.0, &both, SurfaceSide::Front),
        ([[0.25, 0.1], [1.25, 0.1], [1.35, 1.5], [0.1, 1.5]], -1.0, &both, SurfaceSide::Back),
        ([[-1.5, -1.5], [-1.25, -0.1], [-0.35, -0.1], [-0.25, -1.5]], 1.0, &front, SurfaceSide::Front),
        ([[0.25, -1.5], [1.25, -1.5], [1.35, -0.1], [0.1, -0.1]], -1.0, &front, SurfaceSide::Front),
    ];
    let mut canvas = Canvas::new(0xff42_4243);
    for (corners, normal, shading, seen) in quads {
        let given = corners.into_iter().map(|[x, y]| LitVertex {
            position: [x, y, -1.0, 1.0],
            normal: [0.0, 0.0, normal],
            diffuse: [1.0; 4],
            specular: [0.0, 1.0, 0.0, 1.0],
        });
        let quad = drawn(Topology::Quads, given, shading, seen, &Combiners::showing(FinalRegister::PrimaryColor));
        canvas.draw(Draw { cull: Cull::None, ..quad });
    }
    frames.push("TwoSidedLighting", canvas.colors());
}
