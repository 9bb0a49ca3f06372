//! The operation `ninebit op blend`: a fragment blended with what a surface holds.

use clap::Args;
use ninebit::combiner::registers::channel_name;
use ninebit::engine;
use ninebit::legality;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::rop::surface;
use ninebit::state::*;
use ninebit::trace::Observer;
use serde_json::json;

use super::{
    Column, CommandLine, Common, Context, Failure, Operation, ProfileArgument, Results, Setup, inputs, set, words,
};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The blend equation, for example add, subtract, min
    #[arg(long, value_name = "EQUATION", default_value = "add", value_parser = words::equation)]
    equation: BlendEquation,
    /// Factor of the source, for example source_alpha (short: sa)
    #[arg(long, value_name = "FACTOR", default_value = "one", value_parser = words::factor)]
    source_factor: BlendFactor,
    /// Factor of the destination, for example one_minus_source_alpha (short: 1-sa)
    #[arg(long, value_name = "FACTOR", default_value = "zero", value_parser = words::factor)]
    destination_factor: BlendFactor,
    /// The fragment, 0 to 255: N, R,G,B or R,G,B,A
    #[arg(long, value_name = "R,G,B,A", value_parser = inputs::color)]
    source: Option<[i64; 4]>,
    /// What the surface was given to hold, 0 to 255; it keeps what its format stores
    #[arg(long, value_name = "R,G,B,A", value_parser = inputs::color)]
    destination: Option<[i64; 4]>,
    /// The word that the surface holds, instead of `--destination`: for example 0x6000
    #[arg(long, value_name = "WORD", conflicts_with = "destination", value_parser = word)]
    stored: Option<u32>,
    /// The blend constant, 0 to 255
    #[arg(long, value_name = "R,G,B,A", default_value = "0", value_parser = inputs::color)]
    constant: [i64; 4],
    /// The surface's format, for example r5g6b5
    #[arg(long, value_name = "FORMAT", default_value = "a8r8g8b8", value_parser = words::surface)]
    surface: SurfaceFormat,
    #[command(flatten)]
    profile: ProfileArgument,
    #[command(flatten)]
    common: Common,
}

/// The planned draw of the pixel. Each case has its own colours.
struct Pixel {
    plan: Plan,
    surface: SurfaceFormat,
}

/// The inputs: their names in traces and on the command line.
const COLORS: [(&str, &str); 3] =
    [("fragment", "source"), ("destination", "destination"), ("blend_constant", "constant")];

/// Blends one pixel.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let Arguments { equation, source_factor: source, destination_factor: destination, .. } = *arguments;
    let (profile, line) = (arguments.profile.profile, CommandLine::of_this_process());
    let findings = [
        legality::surface::blend_equation(equation, profile, line.place(&["equation"])),
        legality::surface::format(arguments.surface, profile, line.place(&["surface"])),
        legality::surface::blending(arguments.surface, line.place(&["surface"])),
    ];
    line.accept(findings.into_iter().flatten(), context)?;
    let corners = [[0.0, 0.0, 0.0, 1.0], [0.0, 2.0, 0.0, 1.0], [2.0, 0.0, 0.0, 1.0]];
    let draw = Draw {
        vertices: corners.into_iter().map(|position| Vertex { position, ..Vertex::default() }).collect(),
        indices: [0, 1, 2].into(),
        combiners: Combiners::showing(FinalRegister::ConstantColor0),
        blend: Some(Blend { equation, source, destination }),
        ..Draw::default()
    };
    let targets = vec![Target::new(1, 1, arguments.surface)];
    let scene = Scene { profile, targets, draws: vec![draw], ..Scene::default() };
    // Each case has its own colours, so nothing may be pruned because of the draw's colours.
    let options = PlanOptions { prune: false, ..PlanOptions::default() };
    let mut plan = Plan::compile(&scene, &options).map_err(|_| Failure::fault("a pixel cannot be planned"))?;
    for draw in &mut plan.draws {
        draw.blended = draw.written;
    }
    let stored = arguments.stored.map(|word| surface::read(arguments.surface, word).map(i64::from));
    let given = [arguments.source, stored.or(arguments.destination), Some(arguments.constant)];
    let mut columns = Vec::new();
    for ((name, option), color) in COLORS.into_iter().zip(given) {
        let how = format!("write `--{option} R,G,B,A`, or give a table with `--inputs`");
        let channels = [0, 1, 2, 3].map(|channel| format!("{name}.{}", channel_name(channel)));
        let mut channels = channels.map(|name| Column::new((&name, &name), 0..=255, 255, how.as_str()));
        set(&mut channels, color.into_iter().flatten())?;
        columns.extend(channels);
    }
    let find = |_: &[Column], name: &str| {
        let (color, channel) = name.split_once('.')?;
        let color = COLORS.iter().position(|(own, given)| *own == color || *given == color)?;
        Some(4 * color + words::channel(channel)?)
    };
    let known = "source.r, source.g, source.b, source.a and so on for destination, constant";
    let chip = Some((arguments.profile.profile, Policies::DEFAULT));
    let pixel = Pixel { plan, surface: arguments.surface };
    Setup { find, chip, ..Setup::new("blend", columns, known, pixel) }.drive(&arguments.common)
}

impl Operation for Pixel {
    fn run<O: Observer>(&self, values: &[i64], observer: &mut O) -> Results {
        // The ranges of the columns keep every value within a byte.
        let color =
            |n: usize| -> [u8; 4] { std::array::from_fn(|channel| values[4 * n + channel].clamp(0, 255) as u8) };
        let mut plan = self.plan.clone();
        for target in &mut plan.targets {
            target.clear_color = color(1);
        }
        for draw in &mut plan.draws {
            draw.final_combiner.state.constants[0] = color(0);
            draw.blend_constant = color(2);
        }
        // The pixel exists, and the draw covers it.
        let Ok(trace) = engine::trace(&plan, 0, (0, 0), None) else { return Results::new() };
        let mut results = Results::new();
        for step in trace.draws.into_iter().flat_map(|draw| draw.steps) {
            if step.block != "blend" && step.block != "store" {
                continue;
            }
            let blended = step.name.strip_prefix("blend.").filter(|rest| rest.len() == 1);
            if blended.is_some() || step.name == "stored.word" {
                results.push((step.name.clone(), json!(step.value)));
            }
            if O::ON {
                observer.step(step);
            }
        }
        let kept = surface::kept_channels(self.surface);
        for (channel, bits) in surface::channel_bits(self.surface).into_iter().enumerate() {
            if kept >> channel & 1 != 0 {
                let field = (trace.word & bits) >> bits.trailing_zeros();
                results.push((format!("field.{}", channel_name(channel)), json!(field)));
            }
        }
        results
    }
}

fn word(text: &str) -> Result<u32, String> {
    let parsed = match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16),
        None => text.parse(),
    };
    parsed.map_err(|_| "not a word such as 0x6000".to_owned())
}
