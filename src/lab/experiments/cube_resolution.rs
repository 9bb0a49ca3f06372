//! Highlights stored in a cube map: the resolution that they need.

use super::*;

/// Direction of the middle of the highlight.
const AXIS: [f64; 3] = [0.3, 0.1, 1.0];
/// Half width of the range of directions. It ends before the face does, to leave out effects at the face's edges.
const HALF_WIDTH: f64 = 0.8;

pub(super) fn experiment() -> Experiment {
    let method = |exponent: i32| {
        Method::new(format!("exponent {exponent}"), [256.0, 4.0], move |side| {
            largest_error(picture(side as usize, exponent), 0, |at| {
                highlight([HALF_WIDTH * (2.0 * at - 1.0), 0.2, 1.0], exponent)
            })
        })
    };
    Experiment::new("cube-resolution", "A highlight in a cube map")
        .moving("texels along a face's side", Scale::Doubling, (2..=8).map(|n| f64::from(1 << n)).collect())
        .measuring("largest error, 8-bit steps", 4.0)
        .by([8, 32, 128].map(method))
}

/// Returns the cosine with the axis, to a power.
fn highlight(direction: [f64; 3], exponent: i32) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cosine = dot(direction, AXIS) / (dot(direction, direction) * dot(AXIS, AXIS)).sqrt();
    pow(cosine.max(0.0), f64::from(exponent))
}

/// Draws directions along a face of the cube map; only this face, the fifth, has content.
fn picture(side: usize, exponent: i32) -> Pixels {
    let mut words = vec![0; 6 * side * side];
    for (n, word) in words[4 * side * side..5 * side * side].iter_mut().enumerate() {
        let (x, y) = (2.0 * centre(n % side, side) - 1.0, 1.0 - 2.0 * centre(n / side, side));
        *word = u32::from(byte(highlight([x, y, 1.0], exponent)));
    }
    let mut cube = Texture { kind: TextureKind::Cube, ..texture(TextureFormat::I8, side, words) };
    if let TextureImage::Texels(texels) = &mut cube.image {
        texels.height = side as u32;
    }
    let ends = [[-HALF_WIDTH, 0.2, 1.0], [HALF_WIDTH, 0.2, 1.0]];
    let row = row(WIDTH, ends, TextureUnit::new(0), Combiners::showing(FinalRegister::Texture0));
    drawn(Profile::Nv2a, WIDTH, vec![cube], vec![row])
}
