//! VTX-6: vertices that the fixed function lights, in the world of the programs.

use super::meshes::Place;
use super::primitives::limited;
use super::space::{DISTANCE, Matrix};
use super::*;
pub(super) use ninebit::vertex::light::{ColorSource, Light, SecondaryColor, Shading, Side, Sources, Spot};
use ninebit::vertex::light::{Lighting, Surface};
use ninebit::vertex::unit::{self, words};

/// The six words of specular powers that several programs use: A to F.
pub(super) const POWER_OF_GAME: [f32; 6] = [-0.838_916, -2.887_156, 3.048_239, -0.706_496, -2.507_095, 2.800_6];
pub(super) const POWER_125: [f32; 6] = [-0.972_162, -3.206_37, 3.234_21, -0.945_147, -3.140_27, 3.195_12];
pub(super) const POWER_10: [f32; 6] = [-0.706_496, -2.507_1, 2.800_6, -0.500_825, -1.940_02, 2.439_2];
pub(super) const POWER_16: [f32; 6] = [-0.803_673, -2.781_3, 2.977_62, -0.647_66, -2.361_99, 2.714_33];

/// The direction in which the programs look.
const AHEAD: [f32; 3] = [0.0, 0.0, 1.0];

/// A light, with its ambient, diffuse and specular colour.
pub(super) type Lamp = (Light, [[f32; 3]; 3]);

/// A vertex as the programs give it.
#[derive(Clone, Copy)]
pub(super) struct LitVertex {
    pub(super) position: [f32; 4],
    pub(super) normal: [f32; 3],
    pub(super) diffuse: [f32; 4],
    pub(super) specular: [f32; 4],
}

/// The side of a surface that is seen.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum SurfaceSide {
    Front,
    Back,
}

/// Returns a vector of unit length as the programs compute it.
pub(super) fn normalized([x, y, z]: [f32; 3]) -> [f32; 3] {
    let inverse = 1.0 / (x * x + y * y + z * z).sqrt();
    [x * inverse, y * inverse, z * inverse]
}

/// Returns a light far away that shines in a direction. Its half vector is that of an eye behind the viewer.
pub(super) fn directional(direction: [f32; 3]) -> Light {
    let half = normalized(std::array::from_fn(|k| AHEAD[k] + direction[k]));
    Light::Infinite { direction: direction.map(|c| -c), half: half.map(|c| -c) }
}

/// Returns a point of the world in eye space.
fn in_eye_space([x, y, z]: [f32; 3]) -> [f32; 3] {
    [x, y, z + DISTANCE as f32]
}

/// Returns a light at a point of the world.
pub(super) fn point(position: [f32; 3], range: f32, attenuation: [f32; 3]) -> Light {
    Light::Local { position: in_eye_space(position), attenuation, range, spot: None }
}

/// Returns a spotlight at a point of the world that shines ahead, with the angles of its outer and inner cone in degrees.
pub(super) fn spotlight(
    position: [f32; 3],
    range: f32,
    attenuation: [f32; 3],
    angles: [f32; 2],
    falloff: [f32; 3],
) -> Light {
    let cosine = |degrees: f32| (f64::from(0.5 * (degrees * (std::f32::consts::PI / 180.0)))).cos() as f32;
    let [outer, inner] = angles.map(cosine);
    let scale = -1.0 / (inner - outer);
    let spot = Some(Spot { falloff, direction: AHEAD.map(|c| c * scale), offset: outer * scale });
    Light::Local { position: in_eye_space(position), attenuation, range, spot }
}

/// Returns a material whose colours are those of the lights.
pub(super) fn material(ambient: [f32; 3], alpha: f32, powers: [f32; 6]) -> Side {
    Side { sources: Sources::MATERIAL, ambient, factor: [0.0; 3], alpha, powers, colors: Vec::new() }
}

/// Returns secondary colours that are enabled, given the bits of the light control.
pub(super) fn control(word: u32) -> SecondaryColor {
    SecondaryColor { enabled: true, separate: word & 1 != 0, keeps_alpha: word >> 17 & 1 != 0 }
}

/// Returns the state that lights a material, given the word of the light control.
pub(super) fn shading(lamps: &[Lamp], material: Side, word: u32) -> Shading {
    let front = Side { colors: lamps.iter().map(|(_, colors)| *colors).collect(), ..material };
    let lighting = Lighting {
        lights: lamps.iter().map(|(light, _)| *light).collect(),
        front,
        back: None,
        local_eye: word >> 16 & 1 != 0,
        eye_direction: [0.0; 3],
    };
    Shading { lighting: Some(lighting), secondary: control(word) }
}

/// Returns the shading without secondary colours.
pub(super) fn without_secondary(shading: &Shading) -> Shading {
    Shading { secondary: SecondaryColor { enabled: false, ..shading.secondary }, ..shading.clone() }
}

/// Returns the shading with a material for the back.
pub(super) fn with_back(shading: &Shading, back: Side) -> Shading {
    let lighting = shading.lighting.clone().map(|lighting| Lighting { back: Some(back), ..lighting });
    Shading { lighting, ..shading.clone() }
}

/// Returns a vertex of the world, whose matrices leave its normal as it is.
pub(super) fn lit(given: &LitVertex, shading: &Shading, seen: SurfaceSide) -> Vertex {
    let position = unit::transform(&space::rows(&space::eye()), words(given.position));
    let surface = Surface::new(position, words(given.normal), [0.0; 3]);
    let (front, back) = shading.colors(&surface, [given.diffuse, given.specular]);
    let colors = match seen {
        SurfaceSide::Front => front,
        // Backs that nothing lights are black.
        SurfaceSide::Back => back.unwrap_or([[0.0, 0.0, 0.0, 1.0]; 2]),
    };
    let [diffuse, specular] = colors.map(|color| VertexColor::Floats(color.map(limited)));
    Vertex { position: space::flat(given.position), diffuse, specular, ..Vertex::default() }
}

/// Draws one side of what stands in the world. On the screen all of it runs clockwise.
pub(super) fn drawn(
    topology: Topology,
    given: impl Iterator<Item = LitVertex>,
    shading: &Shading,
    seen: SurfaceSide,
    combiners: &Combiners,
) -> Draw {
    let vertices = given.map(|given| lit(&given, shading, seen)).collect();
    Draw {
        combiners: combiners.clone(),
        cull: Cull::Back,
        front_face: FrontFace::Clockwise,
        ..draw(topology, vertices)
    }
}

/// Returns the vertices of a mesh of two colours.
pub(super) fn of_mesh(places: &[Place], [diffuse, specular]: [[f32; 4]; 2]) -> impl Iterator<Item = LitVertex> {
    places.iter().map(move |(position, normal)| {
        let [x, y, z] = *position;
        LitVertex { position: [x, y, z, 1.0], normal: *normal, diffuse, specular }
    })
}

/// Returns the points of the world at depth z that the programs find for the corners of a rectangle on the screen.
pub(super) fn unprojected_corners(edges: [f32; 4], z: f32, inverse: &Matrix) -> [[f32; 4]; 4] {
    corners(edges).map(|corner| space::unproject(corner, z, inverse))
}

/// Returns the matrix from window coordinates to the world.
pub(super) fn inverse() -> Matrix {
    space::inverse(&space::product(space::eye(), space::window()))
}

/// Returns combiners that add what is wanted of both colours.
pub(super) fn summed(primary: bool, secondary: bool) -> Combiners {
    let one = |wanted: bool| if wanted { "unsigned_invert(zero)" } else { "unsigned(zero)" };
    let [p, s] = [primary, secondary].map(one);
    program(&format!(
        "{{ rgb {{ discard = unsigned(col0) * {p}; discard = unsigned(col1) * {s}; spare0 = sum(); }}
           alpha {{ discard = unsigned(col0.a) * {p}; discard = unsigned(col1.a) * {s}; spare0 = sum(); }} }}
         out.rgb = spare0; out.a = spare0.a;"
    ))
}

/// Draws the chequered background at depth 1 of the world: two colours, A8B8G8R8, in fields of `size` texels.
pub(super) fn background(canvas: &mut Canvas, colors: [u32; 2], size: u32) {
    let texture =
        canvas.texture(&images::texture(TextureFormat::A8B8G8R8, [256, 256], checker(colors.map(abgr), size)));
    let world = unprojected_corners([0.0, 0.0, 640.0, 480.0], 1.0, &inverse());
    let vertices = world.into_iter().zip(corners(WHOLE)).map(|(at, texel)| placed(space::flat(at), texel));
    let draw = fetching(draw(Topology::Quads, vertices.collect()), 0, nearest(texture));
    canvas.draw(without_alpha(draw, FinalRegister::Texture0));
}
