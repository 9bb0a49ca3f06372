//! TSH-1 to TSH-9, TEX-12: cube maps, dot products, reflections, bump maps and their luminance, dependent reads.

use super::space::{DEGREES_45, DEGREES_225, Matrix, STRAIGHT};
use super::texel_formats::{Variant, converting, packed, texture, variants};
use super::*;
use images::{Color, four_gradients, gradient, luminance, solid};

/// The corners of a cube's six faces.
const CUBE: [[[f32; 3]; 4]; 6] = [
    [[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]],
    [[1.0, -1.0, -1.0], [-1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [1.0, 1.0, -1.0]],
    [[1.0, -1.0, 1.0], [1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0]],
    [[-1.0, -1.0, -1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, 1.0, -1.0]],
    [[-1.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]],
    [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, -1.0, 1.0]],
];

/// Edges (left, top, right, bottom) of the faces in the unfolded normal map.
const UNFOLDED: [[f32; 4]; 6] = [
    [0.25, 0.375, 0.5, 0.625],
    [0.75, 0.375, 1.0, 0.625],
    [0.5, 0.375, 0.75, 0.625],
    [0.0, 0.375, 0.25, 0.625],
    [0.25, 0.625, 0.5, 0.875],
    [0.25, 0.125, 0.5, 0.375],
];

/// Returns the model matrices of the two cubes.
fn models() -> [Matrix; 2] {
    [([-1.5, 0.0, 2.0], DEGREES_45), ([1.5, 0.0, 2.0], DEGREES_225)]
        .map(|(place, angle)| space::product(space::rotated([angle, DEGREES_45, STRAIGHT]), space::moved_by(place)))
}

fn homogeneous([x, y, z]: [f32; 3]) -> [f32; 4] {
    [x, y, z, 1.0]
}

/// Draws the front faces of both cubes. `coordinates` returns the texture coordinates of a vertex, given its model, face and corner.
pub(super) fn cubes(
    canvas: &mut Canvas,
    coordinates: impl Fn(&Matrix, [usize; 2]) -> [[f32; 4]; TEXTURE_UNITS],
    state: impl Fn(Draw) -> Draw,
) {
    canvas.frame_buffer().depth = Some(FAR_DEPTHS);
    for model in models() {
        let position = |point| space::programmed_by(&[model, space::eye(), space::window()], homogeneous(point));
        let mut vertices = Vec::new();
        for (face, points) in CUBE.into_iter().enumerate() {
            let corners = points.map(position);
            let corner = |n: usize| corners[n % 4].map(f64::from);
            let area: f64 = (0..4).map(|n| corner(n)[0] * corner(n + 1)[1] - corner(n + 1)[0] * corner(n)[1]).sum();
            if area <= 0.0 {
                continue;
            }
            vertices.extend(corners.into_iter().enumerate().map(|(n, [x, y, z, w])| {
                let (position, diffuse) = ([x, y, z / 65535.0, w], VertexColor::Bytes([255; 4]));
                Vertex { position, diffuse, texture_coordinates: coordinates(&model, [face, n]), ..Vertex::default() }
            }));
        }
        let depth_test = Some(DepthTest::new(CompareFunction::Less, true));
        canvas.draw(state(Draw { depth_test, ..draw(Topology::Quads, vertices) }));
    }
}

/// Returns a cube map of chequered faces.
fn chequered() -> Texture {
    let faces = [
        [0xff77_77ff, 0xff22_2222],
        [0xff55_3366, 0xffdd_dddd],
        [0xff55_ff55, 0xff22_2222],
        [0xff33_aaaa, 0xffdd_dddd],
        [0xffff_5555, 0xff22_2222],
        [0xffaa_aa33, 0xffdd_dddd],
    ];
    images::cube(TextureFormat::A8B8G8R8, 64, faces.map(|words| checker(words.map(abgr), 4)))
}

/// Returns a cube map whose faces are black in the middle, each in different channels.
fn radial() -> Texture {
    let brightness = |distance: f32| {
        if distance < 0.25 { distance / 0.25 * 0.5 } else { 0.5 + (distance - 0.25) / 0.75 * 0.5 }
    };
    let face = |channels: [bool; 3]| {
        let image = images::radial(64, brightness);
        move |x: u32, y: u32| {
            let value = image(x, y).into_iter().max().unwrap_or_default();
            let [r, g, b] = channels.map(|has| if has { value } else { 0 });
            [r, g, b, 255]
        }
    };
    let (yes, no) = (true, false);
    let channels = [[yes, no, no], [yes, no, yes], [no, yes, no], [yes, yes, no], [no, no, yes], [no, yes, yes]];
    images::cube(TextureFormat::A8B8G8R8, 64, channels.map(face))
}

/// The eye vector that the programs pass in q of the coordinates.
#[derive(Clone, Copy)]
pub(super) enum Eye {
    /// All components are 1; the operation does not read it.
    Unread,
    /// The unit vector from the eye to the vertex.
    Vertex,
    /// A constant vector.
    Along([f32; 3]),
}

/// Returns the coordinates of a corner: its place in the normal map, then the rows of a matrix for three dot products, with the eye vector in q.
fn surface(model: &Matrix, eye: Eye, [face, corner]: [usize; 2]) -> [[f32; 4]; TEXTURE_UNITS] {
    let rows = space::inverse(&space::product(space::product(*model, space::eye()), space::window()));
    let eye = match eye {
        Eye::Unread => [1.0; 3],
        Eye::Along(axis) => axis,
        Eye::Vertex => {
            let [x, y, z, _] = space::in_single(homogeneous(CUBE[face][corner]), model);
            space::direction([x, y, z + space::DISTANCE as f32])
        }
    };
    let row = |n: usize| [rows[n][0] as f32, rows[n][1] as f32, rows[n][2] as f32, eye[n]];
    [corners(UNFOLDED[face])[corner], row(0), row(1), row(2)]
}

/// Returns a texture shader stage that reads the result of the first unit.
fn stage(number: usize, operation: ShaderOperation, mapping: DotMapping) -> ShaderStage {
    ShaderStage { operation, mapping, previous: 0, ..ShaderStage::conventional(number, true) }
}

/// Draws the cubes with a texture shader that ends in `operation`.
pub(super) fn dotted(
    canvas: &mut Canvas,
    operation: ShaderOperation,
    mapping: DotMapping,
    eye: Eye,
    textures: [&Texture; 2],
) {
    let [normals, cube] = textures.map(|texture| nearest(canvas.texture(texture)));
    let state = |mut draw: Draw| {
        let is_diffuse = operation == ShaderOperation::DotReflectDiffuse;
        // A diffuse lookup needs the reflection after it (TSH-10).
        let (second, third) = if is_diffuse {
            (operation, ShaderOperation::DotReflectSpecular)
        } else {
            (ShaderOperation::DotProduct, operation)
        };
        draw.textures = [Some(normals), None, is_diffuse.then_some(cube), Some(cube)];
        draw.texture_shader = [
            ShaderStage::conventional(0, true),
            stage(1, ShaderOperation::DotProduct, mapping),
            stage(2, second, mapping),
            stage(3, third, mapping),
        ];
        draw.combiners = Combiners::showing(FETCHED[if is_diffuse { 2 } else { 3 }]);
        draw
    };
    cubes(canvas, |model, corner| surface(model, eye, corner), state);
}

/// Returns the unfolded normal map.
pub(super) fn normals() -> Texture {
    images::texture(TextureFormat::A8B8G8R8, [256, 256], assets::pixels(assets::NORMALS))
}

/// Returns coordinates that are the corners of a cube, with this q.
pub(super) fn along(q: f32) -> impl Fn(&Matrix, [usize; 2]) -> [[f32; 4]; TEXTURE_UNITS] {
    move |_, [face, corner]| {
        let [x, y, z] = CUBE[face][corner];
        [[x, y, z, q]; TEXTURE_UNITS]
    }
}

/// Adds the frames of Texture_cubemap.
pub(super) fn cube_maps(frames: &mut Frames) {
    let [checks, radial] = [chequered(), radial()].map(Arc::new);
    let normals = Arc::new(normals());
    for (name, q) in [("", 1.0), ("_q0.0", 0.0), ("_q-0.0", -0.0), ("_q1.0", 1.0), ("_q-1.0", -1.0)] {
        let checks = Arc::clone(&checks);
        frames.paint(format!("Cubemap{name}"), 0xfe12_1212, move |canvas| {
            canvas.texture(&checks);
            cubes(canvas, along(q), |draw| fetching(draw, 3, nearest(0)));
        });
    }
    for (name, mapping) in named("0to1 -1to1D3D -1to1GL -1to1 HiLo_1 HiLoHemi") {
        let mut make = |prefix: String, operation, eye, cube: &Arc<Texture>| {
            let [normals, cube] = [&normals, cube].map(Arc::clone);
            frames.paint(format!("{prefix}_{name}"), 0xfe13_1313, move |canvas| {
                dotted(canvas, operation, mapping, eye, [&normals, &cube]);
            });
        };
        let constant = |eye| ShaderOperation::DotReflectConstantEye { eye };
        make("DotSTRCube".into(), ShaderOperation::DotProductCube, Eye::Vertex, &radial);
        make("DotReflectDiffuse".into(), ShaderOperation::DotReflectDiffuse, Eye::Unread, &checks);
        make("DotReflectSpec".into(), ShaderOperation::DotReflectSpecular, Eye::Unread, &radial);
        make("DotReflectSpecConst".into(), constant([0.0, 0.0, -7.0]), Eye::Unread, &radial);
        for (axis, eye) in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().enumerate() {
            make(format!("DotReflectSpec_{axis}"), ShaderOperation::DotReflectSpecular, Eye::Along(eye), &radial);
            make(format!("DotReflectConst_{axis}"), constant(eye), Eye::Unread, &checks);
        }
    }
    super::kinds::volume_products(frames);
}

/// Returns the texture coordinates of a rectangle's four corners.
fn corners(edges: [f32; 4]) -> [[f32; 4]; 4] {
    draws::corners(edges).map(|[s, t]| [s, t, 0.0, 1.0])
}

/// Returns a rectangle with three coordinate sets, which shows what the unit `shows` fetched.
fn with_sets(edges: [f32; 4], sets: [[[f32; 4]; 4]; 3], shows: usize) -> Draw {
    let draw = rectangle(edges, VertexColor::Bytes([255; 4]));
    let vertices = draw.vertices.iter().enumerate().map(|(n, vertex)| {
        let [first, second, third] = sets.map(|set| set[n]);
        Vertex { texture_coordinates: [first, second, third, [0.0, 0.0, 0.0, 1.0]], ..vertex }
    });
    Draw { vertices: vertices.collect(), combiners: Combiners::showing(FETCHED[shows]), ..draw }
}

const NO_SET: [[f32; 4]; 4] = [[0.0, 0.0, 0.0, 1.0]; 4];

/// Returns the draw with a texture shader: the first unit reads `first`, the stages after it perform `operations`, and the last of them reads `last`.
fn shaded(
    mut draw: Draw,
    first: TextureUnit,
    operations: &[ShaderOperation],
    mapping: DotMapping,
    last: TextureUnit,
) -> Draw {
    (draw.textures[0], draw.texture_shader[0]) = (Some(first), ShaderStage::conventional(0, true));
    for (number, operation) in (1..).zip(operations) {
        draw.texture_shader[number] = stage(number, *operation, mapping);
    }
    draw.textures[operations.len()] = Some(last);
    draw
}

/// Returns the normalised vector, with q = 1.
fn unit_vector(vector: [f32; 3]) -> [f32; 4] {
    let [x, y, z] = vector;
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, y / length, z / length, 1.0]
}

const LARGE: [f32; 4] = [192.0, 112.0, 448.0, 368.0];
const TEXELS: [f32; 4] = [0.0, 0.0, 128.0, 128.0];

/// Returns the bump map of waves and the image that it displaces, with coordinates in texels.
fn water() -> [Texture; 2] {
    [assets::WATER, assets::SEEN].map(|file| {
        let image = assets::pixels(file);
        images::in_texels(images::texture(TextureFormat::A8R8G8B8, [128, 128], image))
    })
}

/// Draws two dot products of the waves: with the direction from the eye, and with the direction to a light.
fn dot_2d(canvas: &mut Canvas) {
    let [waves, seen] = water();
    let waves = canvas.texture(&waves);
    let seen = canvas.texture(&Texture { kind: TextureKind::TwoDimensional, ..seen });
    let points = [[-1.0, 1.0, 4.0], [1.0, 1.0, 7.0], [1.0, -2.0, 6.0], [-1.0, -2.0, 4.0]];
    let from_eye = points.map(|[x, y, z]| unit_vector([x, y, z + 7.0]));
    let to_light = points.map(|[x, y, z]| unit_vector([-1.5 - x, 5.0 - y, -z]));
    let draw = with_sets(unprojected(LARGE), [corners(TEXELS), from_eye, to_light], 2);
    let mapping = DotMapping::ZeroToOne;
    let dots = [ShaderOperation::DotProduct, ShaderOperation::DotProduct2D];
    canvas.draw(shaded(draw, nearest(waves), &dots, mapping, nearest(seen)));
}

fn dependent(canvas: &mut Canvas, operation: ShaderOperation) {
    let size = [256, 256];
    let read = canvas.texture(&images::texture(TextureFormat::A8B8G8R8, size, four_gradients(size)));
    let shown = canvas.texture(&images::texture(TextureFormat::A8B8G8R8, size, gradient(size)));
    let draw = with_sets(unprojected(LARGE), [corners(WHOLE), NO_SET, NO_SET], 1);
    canvas.draw(shaded(draw, nearest(read), &[operation], DotMapping::ZeroToOne, nearest(shown)));
}

fn pass_through(canvas: &mut Canvas) {
    let colors = [[0.0, 0.0, 1.0, 0.25], [0.0, 1.0, 0.0, 0.5], [1.0, 0.0, 0.0, 0.75], [1.0, 1.0, 0.4, 0.33]];
    let mut draw = with_sets(unprojected(LARGE), [colors, NO_SET, NO_SET], 0);
    draw.texture_shader[0] = stage(0, ShaderOperation::PassThrough, DotMapping::ZeroToOne);
    canvas.draw(draw);
}

/// Draws a texture in a white frame.
fn framed(canvas: &mut Canvas, edges: [f32; 4], texture: usize) {
    let [left, top, right, bottom] = edges;
    let frame = unprojected([left - 2.0, top - 2.0, right + 2.0, bottom + 2.0]);
    canvas.draw(rectangle(frame, VertexColor::Bytes([255; 4])));
    canvas.draw(pasted(unprojected(edges), 0, nearest(texture), TEXELS));
}

/// Returns a draw of the second texture, displaced by the first (TSH-7).
fn moved(edges: [f32; 4], [first, second]: [usize; 2], matrix: [f32; 4], luminance: Option<[f32; 2]>) -> Draw {
    let draw = with_sets(unprojected(edges), [corners(TEXELS), corners(TEXELS), NO_SET], 1);
    let operation = ShaderOperation::BumpEnvironment { matrix, luminance };
    shaded(draw, nearest(first), &[operation], DotMapping::ZeroToOne, nearest(second))
}

fn bump_environment(canvas: &mut Canvas) {
    let [waves, seen] = water().map(|texture| canvas.texture(&texture));
    framed(canvas, sized([8.0, 64.0], [128.0; 2]), seen);
    framed(canvas, sized([8.0, 208.0], [128.0; 2]), waves);
    let matrices = [
        [-1.0, 0.0, 1.0, 0.0],
        [1.0, 1.0, 1.0, 1.0],
        [0.0, 0.2, 0.0, 0.75],
        [0.5, -0.5, 0.5, -0.5],
        [0.3, 0.5, 0.7, 1.0],
        [0.0, 1.0, -1.0, 0.0],
        [0.0, 0.0, 1.0, 1.0],
        [0.5, 0.8, 0.0, 0.0],
    ];
    for (matrix, corner) in matrices.into_iter().zip(places([152.0, 64.0], [144.0; 2], 3)) {
        canvas.draw(moved(sized(corner, [128.0; 2]), [waves, seen], matrix, None));
    }
}

fn bump_luminance(canvas: &mut Canvas) {
    let [waves, seen] = water().map(|texture| canvas.texture(&texture));
    framed(canvas, sized([8.0, 64.0], [64.0; 2]), seen);
    framed(canvas, sized([8.0, 144.0], [64.0; 2]), waves);
    let mut left = 88.0;
    for value in [0.0, 0.5] {
        for scale in [0.0, 1.0, 2.0] {
            let mut top = 96.0;
            for offset in [0.0, 0.25, 0.75, 1.0] {
                let edges = sized([left, top], [64.0; 2]);
                canvas.draw(moved(edges, [waves, seen], [value; 4], Some([scale, offset])));
                top += 80.0;
            }
            left += 80.0;
        }
        left += 40.0;
    }
}

/// Adds the frames of Pixel_shader.
pub(super) fn programs(frames: &mut Frames) {
    frames.paint("DotST", 0xff22_2222, dot_2d);
    for (name, operation) in
        [("GreenBlue", ShaderOperation::DependentGreenBlue), ("AlphaRed", ShaderOperation::DependentAlphaRed)]
    {
        let name = format!("StageDependent{name}");
        frames.paint(name, 0xff28_2828, move |canvas| dependent(canvas, operation));
    }
    frames.paint("Passthru", 0xff22_2222, pass_through);
    frames.paint("BumpEnvMap", 0xff22_2222, bump_environment);
    frames.paint("BumpEnvMapLuminance", 0xff22_2222, bump_luminance);
}

/// Column and row of four squares. The second column and the second row treat more channels as signed.
const SQUARES: [[usize; 2]; 4] = [[0, 0], [1, 0], [0, 1], [1, 1]];

fn square_at([column, row]: [usize; 2]) -> [f32; 4] {
    let place = |n: usize, first: f32| first + 180.0 * n as f32;
    sized([place(column, 146.0), place(row, 66.0)], [168.0; 2])
}

/// Returns an image whose upper left texels are two by two fields of one colour each; the rest continues the last of them.
fn quarters(colors: [Color; 4]) -> impl images::Image {
    move |x, y| colors[usize::from(y >= 2) * 2 + usize::from(x >= 2)]
}

const SIZE: [u32; 2] = [256, 256];

/// Draws a bump map of four colours that displaces a chequered texture. `words` hold R, G, B, A from the highest byte on.
fn bumped(
    canvas: &mut Canvas,
    &Variant { format, is_grey, in_texels, .. }: &Variant,
    words: [u32; 4],
    matrix: [f32; 4],
    with_luminance: Option<[f32; 2]>,
    fields: [Color; 2],
) {
    let colors = words.map(u32::to_be_bytes).map(|color| {
        let l = luminance(color);
        if is_grey { [l, l, l, color[3]] } else { color }
    });
    let words = match format {
        // Its colour reads as white, whatever is stored.
        TextureFormat::A8 => packed(format, SIZE, solid([0; 4])),
        _ => packed(format, SIZE, quarters(colors)),
    };
    let bumps = canvas.texture(&texture(format, in_texels, SIZE, words));
    let field = canvas.texture(&images::texture(TextureFormat::A8R8G8B8, SIZE, checker(fields, 8)));
    for place in SQUARES {
        let texel = if in_texels { 1.0 } else { 1.0 / 256.0 };
        let sets = [corners([texel, texel, 3.0 * texel, 3.0 * texel]), corners(WHOLE), NO_SET];
        let [blue, green] = place.map(|n| n == 1);
        let signed = [with_luminance.is_some() && blue, green, blue, false];
        let unit = TextureUnit { signed, ..bilinear(bumps) };
        let operation = ShaderOperation::BumpEnvironment { matrix, luminance: with_luminance };
        let draw = with_sets(square_at(place), sets, 1);
        let draw = shaded(draw, unit, &[operation], DotMapping::ZeroToOne, nearest(field));
        canvas.draw(converting(format, draw));
    }
}

fn bilinear(texture: usize) -> TextureUnit {
    TextureUnit { min_filter: Filter::Linear, mag_filter: Filter::Linear, ..nearest(texture) }
}

const STRAIGHT_MATRIX: [f32; 4] = [0.3, 0.0, 0.0, 0.5];
const TURNED_MATRIX: [f32; 4] = [0.0, -0.1, 0.3, 0.0];

/// Draws two dot products of a texture whose halves are 16-bit numbers.
fn hilo(canvas: &mut Canvas, words: [u32; 4], fields: [Color; 2]) {
    let colors = words.map(u32::to_be_bytes);
    let format = TextureFormat::R16B16;
    let bumps = canvas.texture(&texture(format, false, SIZE, packed(format, SIZE, quarters(colors))));
    let field = canvas.texture(&images::texture(TextureFormat::A8R8G8B8, SIZE, checker(fields, 8)));
    for place in SQUARES {
        let texel = 1.0 / 256.0;
        let across = [0.0, 1.0, 1.0, 0.0].map(|third| [10.0, 0.0, third, 1.0]);
        let down = [0.0, 0.0, 1.0, 1.0].map(|third| [0.0, 15.0, third, 1.0]);
        let sets = [corners([texel, texel, 3.0 * texel, 3.0 * texel]), across, down];
        // G's flag makes the low half signed, and A's the high half.
        let [low, high] = place.map(|n| n == 1);
        let unit = TextureUnit { signed: [false, low, false, high], ..bilinear(bumps) };
        let dots = [ShaderOperation::DotProduct, ShaderOperation::DotProduct2D];
        canvas.draw(shaded(with_sets(square_at(place), sets, 2), unit, &dots, DotMapping::Hilo1, nearest(field)));
    }
}

/// Suffix of a frame's name, whether it uses the second bump map, and whether it uses the rotated matrix.
type Maps = [(&'static str, bool, bool); 4];

const MAPS: Maps = [("", false, false), ("_R90", false, true), ("_B", true, false), ("_B_R90", true, true)];

/// Adds the frames of Bump_map.
pub(super) fn bump_maps(frames: &mut Frames) {
    let fields = [[0xfe, 0, 0, 255], [0x22, 0x21, 0x20, 0x7f]];
    let maps =
        [[0x007f_4500, 0x0080_4500, 0x007f_4500, 0x0080_4500], [0x0045_7f00, 0x0045_7f00, 0x0045_8000, 0x0045_8000]];
    for variant in variants() {
        let name = variant.name();
        let count = match name.as_str() {
            "R16B16" => 0,
            "G8B8" => 4,
            _ => 1,
        };
        for (suffix, is_other, is_turned) in MAPS.into_iter().take(count) {
            let matrix = if is_turned { TURNED_MATRIX } else { STRAIGHT_MATRIX };
            frames.paint(format!("BumpMap_{name}{suffix}"), 0xfe20_2020, move |canvas| {
                bumped(canvas, &variant, maps[usize::from(is_other)], matrix, None, fields);
            });
        }
    }
    for (suffix, words) in [
        ("", [0x0200_0100, 0x0200_0300, 0xff00_0100, 0xff00_0300]),
        ("_B", [0x0200_0300, 0x0200_ff00, 0x0000_0300, 0x0000_ff00]),
    ] {
        frames.paint(format!("BumpMap_R16B16{suffix}"), 0xfe20_2020, move |canvas| hilo(canvas, words, fields));
    }
}

/// Adds the frames of Bump_env_lum.
pub(super) fn bump_maps_with_luminance(frames: &mut Frames) {
    let fields = [[0xfe, 0, 0, 0x7f], [0x22, 0x21, 0x20, 0x7f]];
    let maps =
        [[0x7f01_4500, 0x8003_4500, 0x7f01_4500, 0x8003_4500], [0x0001_7f00, 0x0001_7f00, 0xff03_8000, 0xff03_8000]];
    for variant in variants() {
        let name = variant.name();
        let count = if matches!(name.as_str(), "R6G5B5" | "X8R8G8B8") { 4 } else { 1 };
        for (suffix, is_other, is_turned) in MAPS.into_iter().take(count) {
            let matrix = if is_turned { TURNED_MATRIX } else { [0.3, 0.0, 0.0, 5.0] };
            frames.paint(format!("BumpEnvLum_{name}{suffix}"), 0xfe20_2020, move |canvas| {
                bumped(canvas, &variant, maps[usize::from(is_other)], matrix, Some([0.7, 0.3]), fields);
            });
        }
    }
}
