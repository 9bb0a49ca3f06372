//! The operation `ninebit op address`: one texture coordinate to a texel index, in an address mode.

use clap::Args;
use ninebit::state::{AddressMode, TextureFormat, TextureKind};
use ninebit_vectors::units::ConfiguredAddress;
use serde_json::json;

use super::{CommandLine, Common, Context, Failure, ProfileArgument, Setup, columns, set, texture_checks, words};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// What happens outside the image: wrap, mirror, clamp_to_edge, clamp_to_border, clamp
    #[arg(long, value_name = "MODE", value_parser = words::address_mode)]
    mode: AddressMode,
    /// The texel's index, perhaps outside
    #[arg(long, value_name = "I", allow_hyphen_values = true)]
    index: Option<i64>,
    /// Texels along the image's side, a power of two
    #[arg(long, value_name = "N")]
    size: u32,
    #[command(flatten)]
    profile: ProfileArgument,
    #[command(flatten)]
    common: Common,
}

/// Runs the operation.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let Arguments { mode, size, .. } = *arguments;
    let (line, checks) = (CommandLine::of_this_process(), texture_checks(&arguments.profile));
    let (kind, format) = (TextureKind::TwoDimensional, TextureFormat::A8R8G8B8);
    let findings = [
        checks.sides(kind, format, [size, 1], line.value_range(&["size"])),
        checks.address_mode(mode, line.value_range(&["mode"])),
    ];
    line.accept(findings.into_iter().flatten(), context)?;
    let unit = ConfiguredAddress { mode, size };
    let how = "write `--index I`, or give a table with `--inputs`";
    let mut columns = columns(&unit, &["index"], |_| 1, how);
    set(&mut columns, arguments.index)?;
    let written = |_: &_, texel| if texel < 0 { json!("border") } else { json!(texel) };
    Setup { written, ..Setup::new(&unit, columns, "index") }.drive(&arguments.common)
}
