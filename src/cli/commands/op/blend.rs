//! The operation `ninebit op blend`: a fragment blended with what a surface holds.

use clap::Args;
use ninebit::legality;
use ninebit::rop::surface;
use ninebit::state::*;
use ninebit_vectors::unit::Conditions;
use ninebit_vectors::units::ConfiguredBlend;

use super::{Column, CommandLine, Common, Context, Failure, ProfileArgument, Setup, columns, inputs, set, words};

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

/// The inputs: their names in traces and on the command line.
const COLORS: [(&str, &str); 3] =
    [("fragment", "source"), ("destination", "destination"), ("blend_constant", "constant")];

/// Blends one pixel.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let Arguments { equation, source_factor: source, destination_factor: destination, .. } = *arguments;
    let (profile, line) = (arguments.profile.profile, CommandLine::of_this_process());
    let findings = [
        legality::surface::blend_equation(equation, profile, line.value_range(&["equation"])),
        legality::surface::format(arguments.surface, profile, line.value_range(&["surface"])),
        legality::surface::blending(arguments.surface, line.value_range(&["surface"])),
    ];
    line.accept(findings.into_iter().flatten(), context)?;
    let unit = ConfiguredBlend::new(Blend { equation, source, destination }, arguments.surface, profile)
        .map_err(|_| Failure::fault("a pixel cannot be planned"))?;
    let stored = arguments.stored.map(|word| surface::read(arguments.surface, word).map(i64::from));
    let given = [arguments.source, stored.or(arguments.destination), Some(arguments.constant)];
    let mut columns = columns(&unit, &[], |_| 255, "");
    for ((own, (_, option)), color) in columns.chunks_mut(4).zip(COLORS).zip(given) {
        for column in &mut *own {
            column.how_to_give = format!("write `--{option} R,G,B,A`, or give a table with `--inputs`");
        }
        set(own, color.into_iter().flatten())?;
    }
    let find = |_: &[Column], name: &str| {
        let (color, channel) = name.split_once('.')?;
        let color = COLORS.iter().position(|(own, given)| *own == color || *given == color)?;
        Some(4 * color + words::channel(channel)?)
    };
    let known = "source.r, source.g, source.b, source.a and so on for destination, constant";
    let conditions = Conditions { profile, policies: Policies::DEFAULT };
    Setup { find, conditions, depends: true, ..Setup::new(&unit, columns, known) }.drive(&arguments.common)
}

fn word(text: &str) -> Result<u32, String> {
    let parsed = match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16),
        None => text.parse(),
    };
    parsed.map_err(|_| "not a word such as 0x6000".to_owned())
}
