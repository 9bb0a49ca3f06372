//! The operation `ninebit op filter`: four texels mixed, or one chosen.

use clap::Args;
use ninebit_vectors::units::ConfiguredFilter;

use super::{Common, Failure, Setup, columns, set, words};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Upper left, upper right, lower left, lower right, 0 to 255; or two numbers: one row
    #[arg(long, value_name = "TEXELS", value_parser = texels, allow_hyphen_values = true)]
    texels: Option<[i64; 4]>,
    /// Weights of the right and of the lower texels, 0 to 255 of 256; or one number: no lower texels
    #[arg(long, value_name = "U,V", value_parser = pair)]
    weights: Option<[i64; 2]>,
    /// The coordinates u and v in 1/256 texel, instead of weights
    #[arg(long, value_name = "U,V", value_parser = pair, conflicts_with = "weights", allow_hyphen_values = true)]
    at: Option<[i64; 2]>,
    /// The channel is signed: texels are -128 to 127, the register gets twice the mix
    #[arg(long)]
    signed: bool,
    #[command(flatten)]
    common: Common,
}

/// Runs the operation.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let unit = ConfiguredFilter { signed: arguments.signed, coordinates: arguments.at.is_some() };
    let (short, known) = match unit.coordinates {
        true => (["u", "v"], "u, v"),
        false => (["wu", "wv"], "wu, wv (or u, v, with `--at 0,0`)"),
    };
    let names = ["t00", "t10", "t01", "t11", short[0], short[1]];
    let per_one = |n| if n < 4 { 255 } else { 256 };
    let mut columns = columns(&unit, &names, per_one, "write `--texels A,B,C,D`");
    for column in &mut columns[..4] {
        column.signed_texel = arguments.signed;
    }
    for column in &mut columns[4..] {
        column.how_to_give = "write `--weights U,V` or `--at U,V`".to_owned();
    }
    set(&mut columns[..4], arguments.texels.into_iter().flatten())?;
    set(&mut columns[4..], arguments.at.or(arguments.weights).into_iter().flatten())?;
    let known = format!("t00, t10, t01, t11 (column, row), {known}");
    Setup::new(&unit, columns, known).drive(&arguments.common)
}

fn texels(text: &str) -> Result<[i64; 4], String> {
    match words::numbers(text).as_deref() {
        Some([a, b]) => Ok([*a, *b, *a, *b]),
        Some([a, b, c, d]) => Ok([*a, *b, *c, *d]),
        _ => Err("not two or four whole numbers with commas between".to_owned()),
    }
}

fn pair(text: &str) -> Result<[i64; 2], String> {
    match words::numbers(text).as_deref() {
        Some([u]) => Ok([*u, 0]),
        Some([u, v]) => Ok([*u, *v]),
        _ => Err("not one or two whole numbers with a comma between".to_owned()),
    }
}
