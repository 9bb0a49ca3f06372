//! The operation `ninebit op address`: one texture coordinate to a texel index, in an address mode.

use clap::Args;
use ninebit::state::{AddressMode, TextureFormat, TextureKind};
use ninebit::texture::report::address_step;
use ninebit::trace::{Observer, Silent, plain};
use ninebit_vectors::Unit;
use ninebit_vectors::units::NearestAddress;
use serde_json::json;

use super::unit::plain_row;
use super::{
    COORDINATES, Column, CommandLine, Common, Context, Failure, Operation, ProfileArgument, Results, Setup, set,
    texture_checks, words,
};

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

/// Returns the results of a unit of addresses for a coordinate in 1/256 texel, an address mode and a side in texels.
pub(super) fn addressed(unit: &dyn Unit, (mode, size): (AddressMode, u32), coordinate: i64) -> Vec<i64> {
    plain_row(unit, &[mode as i64, 0, size.into(), coordinate], &mut Silent)
}

/// The operation: an address mode and a side.
struct Address {
    mode: AddressMode,
    size: u32,
}

/// Runs the operation.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let Arguments { mode, size, .. } = *arguments;
    let (line, checks) = (CommandLine::of_this_process(), texture_checks(&arguments.profile));
    let (kind, format) = (TextureKind::TwoDimensional, TextureFormat::A8R8G8B8);
    let findings = [
        checks.sides(kind, format, [size, 1], line.place(&["size"])),
        checks.address_mode(mode, line.place(&["mode"])),
    ];
    line.accept(findings.into_iter().flatten(), context)?;
    let how = "write `--index I`, or give a table with `--inputs`";
    let mut columns = vec![Column::new(("index", "index"), COORDINATES, 1, how)];
    set(&mut columns, arguments.index)?;
    Setup::new("address", columns, "index", Address { mode, size }).drive(&arguments.common)
}

impl Operation for Address {
    fn run<O: Observer>(&self, values: &[i64], observer: &mut O) -> Results {
        // A texel's first coordinate is 256 times its index.
        let found = addressed(&NearestAddress, (self.mode, self.size), 256 * values[0]);
        let texel = (found[1] != 0).then_some(found[2]);
        if O::ON {
            let inputs = vec![plain("index", values[0]), plain("size", i64::from(self.size))];
            let mut step = address_step("address", "texel", self.mode, false, inputs, texel.unwrap_or(values[0]));
            if texel.is_none() {
                step = step.note("outside: the border colour".to_owned());
            }
            observer.step(step);
        }
        vec![("texel".to_owned(), texel.map_or(json!("border"), |texel| json!(texel)))]
    }
}
