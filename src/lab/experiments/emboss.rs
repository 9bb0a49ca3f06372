//! Embossing: the slope of a height field as the difference of two fetches.

use super::*;

/// Number of texels of the height field.
const TEXELS: usize = 64;
/// Number of texels of one wave.
const WAVE: f64 = 16.0;
/// Height of the waves; half of it is above and half below the middle.
const AMPLITUDE: f64 = 0.4;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, back: f64| {
        Method::new(name, [1.0, 7.0], move |offset| {
            let pixels = picture(offset, back);
            let steepest = 255.0 * offset * 0.5 * AMPLITUDE * std::f64::consts::TAU / WAVE;
            // The slope alone gives one half, minus the rise over the offset.
            let ideal = |at: f64| 0.5 - offset * slope(at * TEXELS as f64);
            compared(pixels, 0, ideal, |errors| 100.0 * largest(errors) / steepest)
        })
    };
    Experiment::new("emboss", "Embossing with offsets of several texels")
        .moving("offset, texels", Scale::Real(0.02), (1..=56).map(|n| f64::from(n) / 8.0).collect())
        .measuring("largest error, per cent of the steepest slope", 25.0)
        .by([method("h(s) - h(s + d)", 0.0), method("h(s - d/2) - h(s + d/2)", 0.5)])
}

/// Returns the rise of the height field per texel at a position in texels.
fn slope(at: f64) -> f64 {
    0.5 * AMPLITUDE * std::f64::consts::TAU / WAVE * cos(std::f64::consts::TAU * at / WAVE)
}

fn picture(offset: f64, back: f64) -> Pixels {
    let height = |n: usize| {
        let at = n as f64 + 0.5;
        byte(0.5 + 0.5 * AMPLITUDE * sin(std::f64::consts::TAU * at / WAVE))
    };
    let end = |s: f64| {
        let mut end = Vertex::default();
        for (set, texels) in [-back * offset, (1.0 - back) * offset].into_iter().enumerate() {
            end.texture_coordinates[set][0] = (s + texels / TEXELS as f64) as f32;
        }
        end
    };
    let inverted = mapped(InputMapping::UnsignedInvert, Register::Texture1);
    let mut difference = sum(plain(Register::Texture0), inverted);
    difference.rgb.bias = Bias::NegativeHalf;
    let vertices = quad([0.0, WIDTH as f64], [end(0.0), end(1.0)]).into();
    let draw = quads(vertices, &[TextureUnit::new(0); 2], program([0; 3], vec![difference]));
    drawn(Profile::Nv10, WIDTH, vec![bytes((0..TEXELS).map(height))], vec![draw])
}
