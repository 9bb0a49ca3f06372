//! Pictures and their differences.

use ninebit::engine::RenderOptions;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::shortcut::{self, Shortcuts};
use ninebit::state::{Policies, Scene};
use ninebit_files::picture::digest;
use ninebit_report::compare::{ALL_CHANNELS, CompareOptions, Mode, compare, heat_classes, heat_color};
use ninebit_scene::diff::{self, Options};
use ninebit_scene::image::Rgba;
use serde_json::{Value, json};

use crate::Refused;

/// An answer and its picture.
type ShownFrame = (Value, Vec<[u8; 4]>);

/// Compiles the plan of the first draws. The scene is planned anew, so that nothing is pruned because later draws would cover it.
pub(crate) fn stepped(scene: &Scene, until: usize, policies: Policies) -> Result<Plan, Refused> {
    let mut part = scene.clone();
    part.draws.truncate(until + 1);
    let planned = Plan::compile(&part, &PlanOptions::default());
    let planned = planned.map_err(|errors| errors.into_iter().map(|error| error.message).collect::<String>())?;
    Ok(planned.under(policies))
}

/// Draws a target. The picture holds its colours or, with `depth`, the words of its depth buffer: depth with the lowest byte first, then the stencil.
pub(crate) fn draw(plan: &Plan, shortcuts: Shortcuts, target: usize, depth: bool) -> Result<ShownFrame, Refused> {
    let frames = shortcut::drawn(plan, shortcuts, &RenderOptions::default(), None);
    let surface = &frames.surfaces[target];
    let (width, height) = (surface.width, surface.height);
    if !depth {
        let pixels = surface.rgba8();
        return Ok((json!({ "width": width, "height": height, "digest": digest(width, height, &pixels) }), pixels));
    }
    if surface.depth.is_empty() {
        return Err("this target has no depth buffer".to_owned());
    }
    let (low, high) = surface.depths().fold((u32::MAX, 0), |(low, high), depth| (low.min(depth), high.max(depth)));
    let pixels = surface.depths().zip(surface.stencils()).map(|(depth, stencil)| {
        let [low, middle, high, _] = depth.to_le_bytes();
        [low, middle, high, stencil]
    });
    Ok((json!({ "width": width, "height": height, "low": low, "high": high }), pixels.collect()))
}

/// Draws a target.
pub(crate) fn picture(plan: &Plan, shortcuts: Shortcuts, target: usize) -> Rgba {
    let frames = shortcut::drawn(plan, shortcuts, &RenderOptions::default(), None);
    let surface = &frames.surfaces[target];
    Rgba::new(surface.width, surface.rgba8())
}

/// Compares the definition with float64 arithmetic.
pub(crate) fn against_ideal(plan: &Plan, target: usize) -> ShownFrame {
    let options = CompareOptions { mode: Mode::Free, target, threads: 1, channels: ALL_CHANNELS };
    let found = compare(plan, &options);
    let largest = |errors: &[f32; 4]| errors.iter().filter(|e| !e.is_nan()).fold(0.0_f32, |most, e| most.max(e.abs()));
    let differing = found.errors.iter().filter(|errors| largest(errors) > 0.0).count();
    let worst = found.worst.iter().map(|w| {
        let error = json!({ "error": w.error(), "ideal": w.ideal, "shown": w.shown, "channel": w.channel });
        json!({ "first": [w.x, w.y], "worst": error })
    });
    let answer = json!({
        "width": found.width, "height": found.height, "differing": differing, "drawn": found.drawn,
        "diverged": found.diverged, "regions": worst.collect::<Vec<_>>(), "classes": classes(),
    });
    (answer, found.heat())
}

/// Compares a picture with one from elsewhere. Alpha is ignored, because that of screenshots has no meaning.
pub(crate) fn against_picture(this: &Rgba, second: Option<&Rgba>) -> Result<ShownFrame, Refused> {
    between(this, second.ok_or("there is no second picture")?, true)
}

/// Compares two pictures. The resulting picture shows the largest difference of each pixel's channels.
pub(crate) fn between(a: &Rgba, b: &Rgba, ignore_alpha: bool) -> Result<ShownFrame, Refused> {
    let options = Options { ignore_alpha, regions: 50 };
    let found = diff::compare(a, b, &options).map_err(|error| error.to_string())?;
    let regions = found.regions.iter().map(|region| {
        json!({
            "x": region.x, "y": region.y, "width": region.width, "height": region.height, "pixels": region.pixels,
            "first": region.first, "largest": region.largest,
        })
    });
    let regions: Vec<Value> = regions.collect();
    let channels = if ignore_alpha { 3 } else { 4 };
    let shown = |(a, b): (&[u8; 4], &[u8; 4])| {
        let largest = a[..channels].iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
        let [r, g, b] = heat_color(f64::from(largest));
        [r, g, b, 255]
    };
    let pixels = a.pixels().iter().zip(b.pixels()).map(shown).collect();
    let answer = json!({
        "width": a.width(), "height": a.height(), "differing": found.different, "region_count": found.region_count,
        "regions": regions, "classes": classes(),
    });
    Ok((answer, pixels))
}

fn classes() -> Value {
    heat_classes().into_iter().map(|(label, color)| json!({ "label": label, "color": color })).collect()
}
