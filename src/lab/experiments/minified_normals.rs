//! Highlights on a bumpy surface that moves away from the viewer.

use super::*;
use ninebit_files::texels::halve;

const PIXELS: usize = 256;
/// Number of texels of the normal map.
const TEXELS: usize = 512;
/// Largest tilt of normals in degrees.
const TILT: f64 = 35.0;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, squarings: u32, mip_filter: MipFilter| {
        Method::new(name, [1.0, 12.0], move |texels| {
            let pixels = picture(texels, squarings, mip_filter);
            let normals: Vec<[f64; 2]> = (0..TEXELS).map(tilt).map(|tilt| [sin(tilt), cos(tilt)]).collect();
            compared(pixels, 0, |at| seen(&normals, at, texels, squarings), root_mean_square)
        })
    };
    Experiment::new("minified-normals", "A highlight on bumps that get smaller")
        .moving("texels a pixel", Scale::Real(0.02), (0..=40).map(|n| exp2(f64::from(n) / 8.0)).collect())
        .measuring("rms error, 8-bit steps", 20.0)
        .by([
            method("N . H, levels", 0, MipFilter::Linear),
            method("(N . H)^8, levels", 3, MipFilter::Linear),
            method("(N . H)^8, level 0 alone", 3, MipFilter::None),
        ])
}

/// Returns the tilt of a texel's normal: two waves of about a dozen and thirty texels.
fn tilt(texel: usize) -> f64 {
    let at = std::f64::consts::TAU * texel as f64 / TEXELS as f64;
    angle(-TILT, TILT, 0.5 + 0.25 * (sin(41.0 * at) + sin(17.0 * at + 1.0)))
}

/// Returns the mean of the highlight over the texels that a pixel covers.
fn seen(normals: &[[f64; 2]], at: f64, texels: f64, squarings: u32) -> f64 {
    const SAMPLES: usize = 64;
    let sample = |n: usize| {
        let place = at * texels * PIXELS as f64 + (centre(n, SAMPLES) - 0.5) * texels;
        // Interpolated between texels as by an exact filter, and normalised.
        let left = (place - 0.5).floor();
        let weight = place - 0.5 - left;
        let normal = |texel: f64| normals[texel.rem_euclid(TEXELS as f64) as usize];
        let (a, b) = (normal(left), normal(left + 1.0));
        let mixed = [0, 1].map(|k| a[k] + (b[k] - a[k]) * weight);
        let cosine = mixed[1] / (mixed[0] * mixed[0] + mixed[1] * mixed[1]).sqrt();
        pow(cosine, f64::from(1 << squarings))
    };
    (0..SAMPLES).map(sample).sum::<f64>() / SAMPLES as f64
}

fn picture(texels: f64, squarings: u32, mip_filter: MipFilter) -> Pixels {
    let mut normals = leaning(TEXELS, tilt);
    if let TextureImage::Texels(image) = &mut normals.image {
        let mut level = image.words.to_vec();
        let mut words = level.clone();
        while level.len() > 1 {
            level = halve(&level, level.len() as u32, 1, normals.format);
            words.extend(&level);
        }
        (image.levels, image.words) = (Level::most(image.width, 1), words.into());
    }
    let ends = [[0.0; 3], [texels * PIXELS as f64 / TEXELS as f64, 0.0, 0.0]];
    let unit = TextureUnit { mip_filter, ..TextureUnit::new(0) };
    let program = highlight(Register::Texture0, [128, 128, 255], squarings as usize);
    drawn(Profile::Nv2a, PIXELS, vec![normals], vec![row(PIXELS, ends, unit, program)])
}
