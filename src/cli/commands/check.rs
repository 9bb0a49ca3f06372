//! The command `ninebit check`: reads scenes and prints every finding, without drawing.

use super::*;
use std::fmt::Write;

use ninebit::engine;
use ninebit_report::ShadingWork;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// How to print the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Checks and plans a scene and prints its cost.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let (scene, plan) = arguments.scene.load(context)?;
    let (cost, shaded) = (Cost::from_scene(&scene), ShadingWork::from_draws(engine::shaded(&plan)));
    let value = || {
        let ShadingWork { pixels, exact, seconds } = shaded;
        let shaded = json!({ "pixels": pixels, "exact": exact, "estimated_seconds": seconds });
        json!({ "format": "ninebit-check-1", "profile": scene.profile.name(), "cost": cost, "shaded": shaded })
    };
    arguments.format.print(|| text(&scene, &cost, &shaded), || format!("{:#}", value()))
}

/// Returns the cost as a table.
fn text(scene: &Scene, cost: &Cost, shaded: &ShadingWork) -> String {
    let mut text = String::new();
    let mut row = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<16}{value}");
    };
    row("profile", scene.profile.name().to_owned());
    row("draws", format!("{} ({}, {} vertices)", cost.draws, shown::count(cost.triangles, "triangle"), cost.vertices));
    for target in &scene.targets {
        let depth = target.depth.map_or(String::new(), |depth| format!(", depth {}", depth.format.name()));
        let (width, height, format) = (target.width, target.height, target.format.name());
        row("target", format!("{}: {width} x {height}, {format}{depth}", shown::name(&target.name)));
    }
    row("target pixels", cost.target_pixels.to_string());
    row("shaded pixels", shaded.text());
    if shaded.pixels > Limits::default().shaded_pixels {
        row("", "more than the commands that draw take without `--work`".to_owned());
    }
    row("textures", format!("{} ({})", scene.textures.len(), bytes(cost.texture_bytes)));
    row("memory", format!("about {}", bytes(cost.memory_bytes)));
    text
}

/// Formats a number of bytes, rounded up.
fn bytes(count: u64) -> String {
    match count {
        0..=9_999 => format!("{count} bytes"),
        10_000..=10_239_999 => format!("{} KiB", count.div_ceil(1 << 10)),
        _ => format!("{} MiB", count.div_ceil(1 << 20)),
    }
}
