//! A second model of the chip, written from the rules alone: slow, in straight lines, with exact integers of 128 bits.
//!
//! It shares no code with the crate except for the scene that it reads (`ninebit::state`) and the surfaces that it returns, so an error in
//! one of the two models shows as a difference.
#![allow(
    missing_docs,
    missing_debug_implementations,
    clippy::unwrap_used,
    clippy::float_arithmetic,
    reason = "a model that only tests ask, and that reads the floats of scenes"
)]

pub mod block;
pub mod combiner;
pub mod coordinate;
pub mod fog;
pub mod light;
pub mod raster;
pub mod real;
pub mod rop;
pub mod sampling;
pub mod shader;
pub mod stroke;
pub mod tally;
pub mod texel;
pub mod texture;
pub mod weights;

use combiner::Registers;
use ninebit::frame::Surface;
use ninebit::state::{Draw, Policies, Rectangle, Scene, Target, WindowClip};
use raster::{Sample, Setup};
use shader::Units;
use texture::Image;

/// Returns every surface of the scene after all draws.
pub fn render(scene: &Scene, policies: &Policies) -> Vec<Surface> {
    let mut surfaces: Vec<Surface> = scene
        .targets
        .iter()
        .map(|t| {
            let pixels = (t.width * t.height) as usize;
            Surface {
                width: t.width,
                height: t.height,
                format: t.format,
                words: t.contents.as_ref().map_or_else(
                    || vec![rop::store(t.format, t.clear_color.map(i128::from)); pixels],
                    |words| words.to_vec(),
                ),
                depth: t.depth_contents.as_ref().map_or_else(
                    || t.depth.map_or(Vec::new(), |d| vec![d.clear + (u32::from(d.clear_stencil) << 24); pixels]),
                    |words| words.to_vec(),
                ),
            }
        })
        .collect();
    for draw in &scene.draws {
        render_draw(scene, draw, policies, &mut surfaces);
    }
    surfaces
}

fn render_draw(scene: &Scene, draw: &Draw, policies: &Policies, surfaces: &mut [Surface]) {
    let images: Vec<Option<Image>> =
        draw.textures.iter().map(|unit| unit.map(|unit| Image::new(scene, unit, surfaces))).collect();
    let target = &scene.targets[draw.target];
    let surface = &mut surfaces[draw.target];
    let (mut left, mut top, mut right, mut bottom) = (0, 0, u64::from(target.width), u64::from(target.height));
    if let Some(s) = draw.scissor {
        (left, top) = (u64::from(s.x), u64::from(s.y));
        right = right.min(left + u64::from(s.width));
        bottom = bottom.min(top + u64::from(s.height));
    }
    for figure in raster::figures(draw) {
        let Some(setup) = Setup::new(draw, scene.profile, figure) else { continue };
        let units = Units::new(draw, &images, &setup, policies);
        for j in top..bottom {
            for i in left..right {
                let (_, covered) = setup.edges(i.into(), j.into());
                if !covered || clipped(draw, target, (i, j)) || (setup.is_filled() && !stroke::patterned(draw, i, j)) {
                    continue;
                }
                let sample = setup.drawn_sample(i.into(), j.into());
                // TSH-10
                let Some(textures) = units.registers(i.into(), j.into(), &sample) else { continue };
                let mut color = shade(draw, textures, &setup, &sample, policies);
                if let Some(samples) = setup.samples(i.into(), j.into()) {
                    let is_outside = sample.edges.iter().any(|edge| *edge < 0);
                    tally::count("samples", if is_outside { "of a centre outside" } else { "of a centre inside" });
                    color[3] = color[3] * samples as i128 / 8;
                }
                let at = (j * u64::from(target.width) + i) as usize;
                // The order is ROP-1, STN-1, DEP-2.
                if let Some(test) = draw.alpha_test
                    && !test.function.passes(color[3] as u32, test.reference.into())
                {
                    continue;
                }
                if let Some(buffer) = target.depth
                    && (draw.depth_test.is_some() || draw.stencil_test.is_some())
                {
                    let (mut stencil, mut stored) = (surface.depth[at] >> 24, surface.depth[at] % (1 << 24));
                    // DEP-4 comes before both tests.
                    let incoming = match &draw.depth_test {
                        Some(test) => match setup.depth(&sample, test, buffer.format) {
                            Some(depth) => depth,
                            None => continue,
                        },
                        None => 0,
                    };
                    let passed = rop::stencil_and_depth(draw, incoming, &mut stencil, &mut stored);
                    surface.depth[at] = (stencil << 24) + stored;
                    if !passed {
                        continue;
                    }
                }
                surface.words[at] = rop::write(draw, target.format, surface.words[at], color);
            }
        }
    }
}

/// CLP-1, CLP-2: returns whether clip rectangles exclude a pixel.
fn clipped(draw: &Draw, target: &Target, (x, y): (u64, u64)) -> bool {
    let inside = |r: &Rectangle| {
        let reaches = |at: u64, from: u32, size: u32| at >= u64::from(from) && at < u64::from(from) + u64::from(size);
        reaches(x, r.x, r.width) && reaches(y, r.y, r.height)
    };
    let window = match &draw.window_clip {
        Some(WindowClip { rectangles, exclusive: true }) => rectangles.iter().any(inside),
        Some(WindowClip { rectangles, exclusive: false }) => !rectangles.iter().any(inside),
        None => false,
    };
    window || target.clip.is_some_and(|clip| !inside(&clip))
}

/// Returns the colour of a fragment, bytes R, G, B, A.
fn shade(draw: &Draw, textures: [[i128; 4]; 4], setup: &Setup, sample: &Sample, policies: &Policies) -> [i128; 4] {
    let [r, g, b] = draw.fog.color.map(i128::from);
    let weights = weights::colour_weights(sample.b);
    let registers = Registers {
        fog: [r, g, b, if draw.fog.enabled { fog::factor(setup, sample, draw.fog.function) } else { 255 }],
        primary: setup.color(weights, |v| v.diffuse),
        secondary: setup.color(weights, |v| v.specular),
        textures,
        // CMB-13: SPARE0 begins with the alpha of TEXTURE0.
        spare0: [0, 0, 0, textures[0][3]],
        spare1: [0; 4],
    };
    combiner::run(registers, &draw.combiners, policies)
}
