//! The operation `ninebit op cube`: a direction to a face of a cube map and coordinates on it.

use clap::Args;
use ninebit::raster::interpolate::Sample;
use ninebit::raster::setup::Triangle;
use ninebit::state::*;
use ninebit::texture::coordinates::{Coordinates, Interpolated, SampleCoordinates, real_coordinate};
use ninebit::texture::planned::PlannedUnit;
use ninebit::texture::report::Report;
use ninebit::trace::Observer;
use ninebit_vectors::units::{self, LinearAddress, NearestAddress};
use serde_json::json;

use super::address::addressed;
use super::{
    Column, CommandLine, Common, Context, Failure, Operation, ProfileArgument, Results, Setup, set, texture_checks,
};

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

/// A cube map and one triangle, at whose first vertex it is looked up.
struct Cube {
    unit: PlannedUnit,
    triangle: Triangle,
}

/// Numbers of a direction have as many bits as those of the chip's (TEX-12).
const MAX_COMPONENT: i64 = 1 << 28;

/// Looks up a cube map.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let side = arguments.size;
    let line = CommandLine::of_this_process();
    let (kind, format) = (TextureKind::Cube, TextureFormat::R5G6B5);
    let finding = texture_checks(&arguments.profile).sides(kind, format, [side; 2], line.place(&["size"]));
    line.accept(finding, context)?;
    let corners = [[0.0, 0.0, 0.0, 1.0], [2.0, 0.0, 0.0, 1.0], [0.0, 2.0, 0.0, 1.0]];
    let Some(triangle) = Triangle::new(corners, false, Profile::Nv2a) else {
        return Err(Failure::usage("the operation has no triangle", "please report this with the command line"));
    };
    let how = "write `--direction X,Y,Z`, or give a table with `--inputs`";
    let names = [("unit0.N_x0", "x"), ("unit0.N_y0", "y"), ("unit0.N_z0", "z")];
    let mut columns = names.map(|names| Column::new(names, -MAX_COMPONENT..=MAX_COMPONENT, 1, how));
    set(&mut columns, arguments.direction.into_iter().flatten())?;
    let unit = PlannedUnit {
        kind,
        levels: vec![Level { offset: 0, width: side, height: side }],
        face_words: side as usize * side as usize,
        ..units::planned(TextureUnit::new(0), format)
    };
    Setup::new("cube", columns.into(), "x, y, z", Cube { unit, triangle }).drive(&arguments.common)
}

impl Operation for Cube {
    fn run<O: Observer>(&self, values: &[i64], observer: &mut O) -> Results {
        let [x, y, z] = [values[0], values[1], values[2]];
        let sample = Sample::new(&self.triangle, [1, 0, 0]);
        let mut vertex = Vertex::default();
        vertex.texture_coordinates[self.unit.stage.coordinate_set] = [x as f32, y as f32, z as f32, 1.0];
        let vertices = Vertices::from(vec![vertex]);
        let place = Interpolated {
            unit: &self.unit,
            coordinates: &Coordinates::Direction([x, y, z].map(|n| [n, 0, 0])),
            at: &sample,
            pixel: (0, 0),
            vertices: vertices.triangle([0; 3]),
            perspective: true,
        };
        let (level, face) = (&self.unit.levels[0], place.face());
        let floored = place.on(level);
        if O::ON {
            let ideal = place.real(Some(face)).st.map(|c| real_coordinate(c, level.width));
            place.describe(&Report { unit: &self.unit, prefix: "" }, level, floored, ideal, observer);
        }
        let [u, v] = floored.map(|c| c.value);
        let clamped = (AddressMode::ClampToEdge, level.width);
        let [x, y] = [u, v].map(|c| addressed::<3>(&NearestAddress, clamped, c)[2]);
        let linear = [u, v].map(|c| addressed::<6>(&LinearAddress, clamped, c)).map(|texels| [texels[3], texels[5]]);
        let names = ["face", "u", "v", "x", "y", "linear_x", "linear_y"].map(str::to_owned);
        let values = [json!(face.name()), json!(u), json!(v), json!(x), json!(y), json!(linear[0]), json!(linear[1])];
        names.into_iter().zip(values).collect()
    }
}

/// Three decimal numbers as whole ones of the same ratios.
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
