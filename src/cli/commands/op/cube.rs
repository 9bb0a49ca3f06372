//! The operation `ninebit op cube`: a direction to a face of a cube map and coordinates on it.

use clap::Args;
use ninebit::state::{TextureFormat, TextureKind};
use ninebit_vectors::units::ConfiguredCube;

use super::{CommandLine, Common, Context, Failure, ProfileArgument, Setup, columns, set, texture_checks};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The direction; its length does not matter
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    direction: Option<[i64; 3]>,
    /// Texels along a side of each face, a power of two
    #[arg(long, value_name = "N", default_value_t = 256)]
    size: u32,
    #[command(flatten)]
    profile: ProfileArgument,
    #[command(flatten)]
    common: Common,
}

/// Looks up a cube map.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let side = arguments.size;
    let line = CommandLine::of_this_process();
    let (kind, format) = (TextureKind::Cube, TextureFormat::R5G6B5);
    let finding = texture_checks(&arguments.profile).sides(kind, format, [side; 2], line.value_range(&["size"]));
    line.accept(finding, context)?;
    let unit = ConfiguredCube { side };
    let how = "write `--direction X,Y,Z`, or give a table with `--inputs`";
    let mut columns = columns(&unit, &["x", "y", "z"], |_| 1, how);
    set(&mut columns, arguments.direction.into_iter().flatten())?;
    Setup::new(&unit, columns, "x, y, z").drive(&arguments.common)
}

/// Reads three decimal numbers, as integers of the same ratios.
fn direction(text: &str) -> Result<[i64; 3], String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let digits = |part: &str| part.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    let most = parts.iter().map(|part| digits(part)).max().unwrap_or(0);
    let whole = |part: &str| -> Option<i64> {
        let zeros = "0".repeat(most - digits(part));
        let (sign, part) = part.strip_prefix('-').map_or((1, part), |rest| (-1, rest));
        let plain = part.replacen('.', "", 1);
        let valid = !plain.is_empty() && plain.bytes().all(|digit| digit.is_ascii_digit());
        let value: i64 = (plain + &zeros).parse().ok().filter(|_| valid)?;
        Some(sign * value)
    };
    let values: Option<Vec<i64>> = parts.iter().map(|part| whole(part)).collect();
    match values.as_deref() {
        Some([x, y, z]) if most <= 9 => Ok([*x, *y, *z]),
        _ => Err("not three decimal numbers with commas between, of at most nine decimals".to_owned()),
    }
}
