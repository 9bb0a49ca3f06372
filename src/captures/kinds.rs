//! TEX-20: textures of another kind than the stage that reads them.

use super::shader::{Eye, along, cubes, dotted, normals};
use super::*;
use images::{Color, checker, gradient, radial, swizzled};
use ninebit_files::texels;

const SIDE: u32 = 64;
const FORMAT: TextureFormat = TextureFormat::A8B8G8R8;

/// Returns a cube map of noise: red and green change from texel to texel, blue every two, each face in other channels first.
fn noisy() -> Texture {
    let face = |first: u32| {
        move |x: u32, y: u32| {
            let lit = |at: u32, shift: u32| (at % 2 * 255) as u8 ^ (first >> shift) as u8;
            [lit(x, 16), lit(y, 8), lit(x / 2 + y / 2, 0), 255]
        }
    };
    images::cube(FORMAT, SIDE, [0x00_00ff, 0xff_00ff, 0x00_ff00, 0x00_ffff, 0xff_0000, 0xff_ff00].map(face))
}

/// Adds the frames of Texture_cubemap with a dot product for volumes.
pub(super) fn volume_products(frames: &mut Frames) {
    let (noise, normals) = (Arc::new(noisy()), Arc::new(normals()));
    for (name, mapping) in named("0to1 -1to1D3D -1to1GL -1to1 HiLo_1 HiLoHemi") {
        let [normals, noise] = [&normals, &noise].map(Arc::clone);
        frames.paint(format!("DotSTR3D_{name}"), 0xfe14_1414, move |canvas| {
            dotted(canvas, ShaderOperation::DotProduct3D, mapping, Eye::Along([0.0; 3]), [&normals, &noise]);
        });
    }
}

/// Adds the frames of Texture_2D_as_cubemap.
pub(super) fn planes_as_cubes(frames: &mut Frames) {
    let plane = |image: &dyn Fn(u32, u32) -> Color| images::texture(FORMAT, [SIDE; 2], image);
    let checks = Arc::new(plane(&checker([0xff44_ffff, 0xffaa_9933].map(abgr), 2)));
    let gradients = radial(SIDE, |distance| distance);
    let radial = Arc::new(plane(&|x, y| {
        let [r, g, b] = gradients(x, y);
        [r, g, b, 255]
    }));
    let normals = Arc::new(normals());
    let image = Arc::clone(&checks);
    frames.paint("Cubemap_Bad2D", 0xfe12_1212, move |canvas| {
        canvas.texture(&image);
        cubes(canvas, along(1.0), |draw| {
            let mut draw = fetching(draw, 3, nearest(0));
            draw.texture_shader[3].operation = ShaderOperation::SampleCube;
            draw
        });
    });
    let constant = ShaderOperation::DotReflectConstantEye { eye: [0.0, 0.0, -7.0] };
    for (name, operation, eye, image) in [
        ("DotReflectDiffuse", ShaderOperation::DotReflectDiffuse, Eye::Unread, &radial),
        ("DotReflectSpecConst", constant, Eye::Unread, &checks),
        ("DotReflectSpec", ShaderOperation::DotReflectSpecular, Eye::Unread, &checks),
        ("DotSTR3D", ShaderOperation::DotProduct3D, Eye::Along([0.0; 3]), &checks),
        ("DotSTRCube", ShaderOperation::DotProductCube, Eye::Vertex, &checks),
    ] {
        let [normals, image] = [&normals, image].map(Arc::clone);
        let clear = if name == "DotSTR3D" { 0xfe14_1414 } else { 0xfe13_1313 };
        frames.paint(format!("{name}_Bad2D"), clear, move |canvas| {
            dotted(canvas, operation, DotMapping::MinusOneToOneD3d, eye, [&normals, &image]);
        });
    }
}

/// Returns the draw with its first stage as one for two dimensions.
fn flat(mut draw: Draw) -> Draw {
    draw.texture_shader[0].operation = ShaderOperation::Sample2D;
    draw
}

/// Returns a volume of two layers, whose memory holds two images of two dimensions one after the other.
fn volume(images: [&dyn Fn(u32, u32) -> Color; 2]) -> Texture {
    let bits = SIDE.ilog2();
    let mut memory = vec![0; 2 * (SIDE * SIDE) as usize];
    for (n, image) in images.into_iter().enumerate() {
        for (x, y) in images::each_texel([SIDE; 2]) {
            memory[n * (SIDE * SIDE) as usize + swizzled([x, y], [bits; 2])] = texels::word(image(x, y), FORMAT);
        }
    }
    let layer = |z: u32| images::each_texel([SIDE; 2]).map(move |(x, y)| swizzled([x, y, z], [bits, bits, 1]));
    let words = [0, 1].into_iter().flat_map(layer).map(|at| memory[at]).collect();
    let texture = images::of_words(TextureKind::ThreeDimensional, FORMAT, [SIDE; 2], 1, words);
    let TextureImage::Texels(texels) = texture.image else { return texture };
    Texture { image: TextureImage::Texels(Texels { layers: 2, ..texels }), ..texture }
}

/// Adds the frames of Texture_3D_as_2D.
pub(super) fn solids_as_planes(frames: &mut Frames) {
    let large = unprojected([192.0, 112.0, 448.0, 368.0]);
    let small = |top: f32| unprojected(sized([32.0, top], [SIDE as f32; 2]));
    let colors = gradient([SIDE; 2]);
    let opaque = move |x: u32, y: u32| {
        let [r, g, b, _] = colors(x, y);
        [r, g, b, 255]
    };
    frames.paint("Cubemap_as_2D", 0xfe12_1212, move |canvas| {
        // The other faces are not read.
        let opaque = &opaque;
        let face = |n: u8| move |x: u32, y: u32| if n == 0 { opaque(x, y) } else { [n, 0, 0, 255] };
        let cube = canvas.texture(&images::cube(FORMAT, SIDE, [0, 1, 2, 3, 4, 5].map(face)));
        let plane = canvas.texture(&images::texture(FORMAT, [SIDE; 2], opaque));
        canvas.draw(flat(pasted(large, 0, nearest(cube), WHOLE)));
        canvas.draw(pasted(small(208.0), 0, nearest(plane), WHOLE));
    });
    frames.paint("Volumetric_as_2D", 0xfe13_1313, move |canvas| {
        let images: [&dyn Fn(u32, u32) -> Color; 2] =
            [&checker([0xefbb_cc33, 0x3344_9988].map(abgr), 8), &gradient([SIDE; 2])];
        let solid = canvas.texture(&volume(images));
        canvas.draw(flat(pasted(large, 0, nearest(solid), WHOLE)));
        for (image, top) in images.into_iter().zip([144.0, 272.0]) {
            let plane = canvas.texture(&images::texture(FORMAT, [SIDE; 2], image));
            canvas.draw(pasted(small(top), 0, nearest(plane), WHOLE));
        }
    });
}
