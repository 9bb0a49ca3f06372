//! The operation `ninebit op filter`: four texels mixed, or one chosen.

use clap::Args;
use ninebit::number::Paired;
use ninebit::texture::report::Report;
use ninebit::texture::unit;
use ninebit::trace::{Observer, Rule};
use ninebit_vectors::units::{FilteredChannel, one_channel};
use serde_json::json;

use super::unit::plain_row;
use super::{COORDINATES, Column, Common, Failure, Operation, Results, Setup, set, words};

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

/// The operation: filters four texels with weights, or at coordinates.
struct Mix {
    signed: bool,
    /// Whether the last two columns are coordinates instead of weights.
    coordinates: bool,
}

/// Runs the operation.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let coordinates = arguments.at.is_some();
    let texel = |name: &str| {
        let range = if arguments.signed { -128..=127 } else { 0..=255 };
        let column =
            Column::new((&format!("unit0.texel{name}.r"), &format!("t{name}")), range, 255, "write `--texels A,B,C,D`");
        Column { signed_texel: arguments.signed, ..column }
    };
    let (names, range, known) = match coordinates {
        true => ([("unit0.u", "u"), ("unit0.v", "v")], COORDINATES, "u, v"),
        false => {
            let names = [("unit0.weight_u", "wu"), ("unit0.weight_v", "wv")];
            (names, 0..=255, "wu, wv (or u, v, with `--at 0,0`)")
        }
    };
    let mut texels = ["00", "10", "01", "11"].map(texel);
    set(&mut texels, arguments.texels.into_iter().flatten())?;
    let mut last = names.map(|names| Column::new(names, range.clone(), 256, "write `--weights U,V` or `--at U,V`"));
    set(&mut last, arguments.at.or(arguments.weights).into_iter().flatten())?;
    let known = format!("t00, t10, t01, t11 (column, row), {known}");
    let columns = texels.into_iter().chain(last).collect();
    Setup::new("filter", columns, known, Mix { signed: arguments.signed, coordinates }).drive(&arguments.common)
}

impl Operation for Mix {
    fn run<O: Observer>(&self, values: &[i64], observer: &mut O) -> Results {
        let mut row = [&[self.signed.into()], values].concat();
        if self.coordinates {
            let (unit, at) = (one_channel(self.signed), [values[4], values[5]]);
            let (report, ideal) = (Report { unit: &unit, prefix: "" }, at.map(|c| c as f64));
            let (_, weights) = unit::footprint_weights::<Paired, O>(&report, at, ideal, Rule::Int4, observer);
            row[5..].copy_from_slice(&weights.map(|weight| weight.fixed.into()));
        }
        let results = plain_row(&FilteredChannel, &row, observer);
        vec![("mix".to_owned(), json!(results[0])), ("register".to_owned(), json!(results[1]))]
    }
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
