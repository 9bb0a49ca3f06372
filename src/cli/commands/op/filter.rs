//! `ninebit op filter`.

use clap::Args;
use ninebit::number::{Lane, Paired};
use ninebit::state::{Level, ShaderStage, TextureFormat, TextureKind, TextureUnit};
use ninebit::texture::report::Report;
use ninebit::texture::unit::{self, PlannedUnit};
use ninebit::trace::{Observer, Rule};
use serde_json::json;

use super::super::exit::Failure;
use super::inputs::set;
use super::operation::{Column, Common, Operation, Results, drive};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Upper left, upper right, lower left, lower right, 0 to 255; or two numbers: one row
    #[arg(long, value_name = "TEXELS", value_parser = texels, allow_hyphen_values = true)]
    texels: Option<Texels>,
    /// Weights of the right and of the lower texels, 0 to 255 of 256; or one number: no lower texels
    #[arg(long, value_name = "U,V", value_parser = pair)]
    weights: Option<(i64, i64)>,
    /// The coordinates u and v in 1/256 texel, instead of weights
    #[arg(long, value_name = "U,V", value_parser = pair, conflicts_with = "weights", allow_hyphen_values = true)]
    at: Option<(i64, i64)>,
    /// The channel is signed: texels are -128 to 127, the register gets twice the mix
    #[arg(long)]
    signed: bool,
    #[command(flatten)]
    common: Common,
}

#[derive(Clone, Copy, Debug)]
struct Texels([i64; 4]);

/// A unit whose texels and weights are given.
struct Mix {
    unit: PlannedUnit,
    /// The last two columns are coordinates instead of weights.
    coordinates: bool,
    columns: Vec<Column>,
}

/// Mixes four texels.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let coordinates = arguments.at.is_some();
    let mut columns: Vec<Column> = TEXELS
        .iter()
        .map(|(name, _)| {
            let range = if arguments.signed { -128..=127 } else { 0..=255 };
            Column { name: (*name).to_owned(), range, per_one: 255, signed_texel: arguments.signed, value: None }
        })
        .collect();
    let (names, range) = if coordinates { (COORDINATES, -16_777_216..=16_777_215) } else { (WEIGHTS, 0..=255) };
    columns.extend(names.map(|(name, _)| Column {
        name: name.to_owned(),
        range: range.clone(),
        per_one: 256,
        signed_texel: false,
        value: None,
    }));
    if let Some(Texels(texels)) = arguments.texels {
        columns.iter_mut().zip(texels).try_for_each(|(column, value)| set(column, value))?;
    }
    if let Some((u, v)) = arguments.at.or(arguments.weights) {
        columns.iter_mut().skip(4).zip([u, v]).try_for_each(|(column, value)| set(column, value))?;
    }
    // One channel stands for all: they do not touch each other.
    let state = TextureUnit { signed: [arguments.signed; 4], ..TextureUnit::new(0) };
    let stage = ShaderStage::conventional(0, true);
    let unit = PlannedUnit {
        index: 0,
        state,
        stage,
        kind: TextureKind::TwoDimensional,
        format: TextureFormat::A8R8G8B8,
        levels: vec![Level { offset: 0, width: 1, height: 1 }],
        face_words: 1,
        layers: 1,
        border: false,
        dithered: false,
        palette: None,
        live: 1,
    };
    drive(&Mix { unit, coordinates, columns }, &arguments.common)
}

/// Names in traces, and short ones.
const TEXELS: [(&str, &str); 4] =
    [("unit0.texel00.r", "t00"), ("unit0.texel10.r", "t10"), ("unit0.texel01.r", "t01"), ("unit0.texel11.r", "t11")];
const WEIGHTS: [(&str, &str); 2] = [("unit0.weight_u", "wu"), ("unit0.weight_v", "wv")];
const COORDINATES: [(&str, &str); 2] = [("unit0.u", "u"), ("unit0.v", "v")];

impl Operation for Mix {
    const NAME: &'static str = "filter";

    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn find(&self, name: &str) -> Option<usize> {
        let last = if self.coordinates { COORDINATES } else { WEIGHTS };
        TEXELS.iter().chain(&last).position(|(own, short)| *own == name || *short == name)
    }

    fn known(&self) -> String {
        let last = if self.coordinates { "u, v" } else { "wu, wv (or u, v, with `--at 0,0`)" };
        format!("t00, t10, t01, t11 (column, row), {last}")
    }

    fn how_to_give(&self, column: &Column) -> String {
        let option = if column.name.contains("texel") { "--texels A,B,C,D" } else { "--weights U,V` or `--at U,V" };
        format!("write `{option}`")
    }

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

fn numbers(text: &str) -> Option<Vec<i64>> {
    text.split(',').map(|text| super::inputs::number(text.trim())).collect()
}

fn texels(text: &str) -> Result<Texels, String> {
    match numbers(text).as_deref() {
        Some([a, b]) => Ok(Texels([*a, *b, *a, *b])),
        Some([a, b, c, d]) => Ok(Texels([*a, *b, *c, *d])),
        _ => Err("not two or four whole numbers with commas between".to_owned()),
    }
}

fn pair(text: &str) -> Result<(i64, i64), String> {
    match numbers(text).as_deref() {
        Some([u]) => Ok((*u, 0)),
        Some([u, v]) => Ok((*u, *v)),
        _ => Err("not one or two whole numbers with a comma between".to_owned()),
    }
}
