//! The operation `ninebit op filter`: four texels mixed, or one chosen.

use clap::Args;
use ninebit::number::{Lane, Paired};
use ninebit::state::{TextureFormat, TextureUnit};
use ninebit::texture::planned::PlannedUnit;
use ninebit::texture::report::Report;
use ninebit::texture::unit;
use ninebit::trace::{Observer, Rule};
use ninebit_vectors::units;
use serde_json::json;

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

/// A unit whose texels and weights are given.
struct Mix {
    unit: PlannedUnit,
    /// The last two columns are coordinates instead of weights.
    coordinates: bool,
}

/// Mixes four texels.
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
    // One channel stands for all: they do not touch each other.
    let state = TextureUnit { signed: [arguments.signed; 4], ..TextureUnit::new(0) };
    let unit = PlannedUnit { live: 1, ..units::planned(state, TextureFormat::A8R8G8B8) };
    let known = format!("t00, t10, t01, t11 (column, row), {known}");
    let columns = texels.into_iter().chain(last).collect();
    Setup::new("filter", columns, known, Mix { unit, coordinates }).drive(&arguments.common)
}

impl Operation for Mix {
    fn run<O: Observer>(&self, values: &[i64], observer: &mut O) -> Results {
        let report = Report { unit: &self.unit, prefix: "" };
        let exact = |value: i64| value as f64;
        let texel = |n: usize| {
            // As the unit expands texels: s/128 in the ideal of a signed channel.
            let denominator = if self.unit.state.signed[0] { 128 } else { 255 };
            [Paired::texel(values[n] as i32, values[n] as i32, denominator); 4]
        };
        let coordinates = [values[4], values[5]];
        let weights = if self.coordinates {
            let ideal = coordinates.map(exact);
            unit::footprint_weights::<Paired, O>(&report, coordinates, ideal, Rule::Int4, observer).1
        } else {
            coordinates.map(|weight| Paired::weight(weight as i32, || exact(weight)))
        };
        let mixed = unit::mix(&report, [texel(0), texel(1), texel(2), texel(3)], weights, observer);
        let register = unit::load(&self.unit, mixed, "", observer);
        vec![("mix".to_owned(), json!(mixed[0].fixed)), ("register".to_owned(), json!(register[0].fixed))]
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
