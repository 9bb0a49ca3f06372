//! `ninebit generate`.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::builder::RangedI64ValueParser;
use clap::{Args, Subcommand, ValueEnum};
use ninebit::generate::normal_map::{self, HeightChannel};
use ninebit::generate::{SIDES, height_field, hemisphere};
use ninebit::output::{Compression, Destination, encode_png};
use ninebit::scene::image::{self, ImageLimits, Rgba};

use super::exit::Failure;
use super::scene::refuse_overwriting;

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Turn a height field into a normal map
    ///
    /// For every texel, the texel itself, its right neighbour and the neighbour above it are three points of the surface; the texel's
    /// normal is the normalised cross product of the two edges between them. Orientation: x (red) to the right, y (green) upward on the image, z
    /// (blue) out of it. A component n is stored as 128 + round(127 n). Alpha keeps the height.
    NormalMap(NormalMap),
    /// Make the height field of a weathered rock face, which tiles without a seam
    ///
    /// The same size and seed give the same bytes on every machine.
    HeightRocks(HeightRocks),
    /// Make the normal map of a hemisphere in a flat surface
    ///
    /// Inside the circle that touches the image's edges the normal is (x, y, sqrt(1 - x^2 - y^2)), outside it (0, 0, 1), taken at the
    /// centres of the texels. Orientation and storage are those of `normal-map`: x (red) to the right, y (green) upward on the image, z
    /// (blue) out of it; a component n is stored as 128 + round(127 n). Alpha is 255.
    ///
    /// The same size, noise and seed give the same bytes on every machine.
    HemisphereNormals(HemisphereNormals),
}

#[derive(Debug, Args)]
pub(crate) struct NormalMap {
    /// The height field, PNG or TGA; 0 is the lowest
    height: PathBuf,
    /// The normal map, a PNG; `-` is stdout
    #[arg(short, long, value_name = "NORMAL.png")]
    output: OsString,
    /// How many texels high a height of 255 is; negative turns hills into pits
    #[arg(long, default_value = "8", value_parser = finite, allow_negative_numbers = true)]
    scale: f64,
    /// The image tiles: texels at the edge look at the opposite edge (the default)
    #[arg(long, overrides_with = "no_wrap")]
    wrap: bool,
    /// The image does not tile: texels at the edge repeat their inner neighbour's slope
    #[arg(long)]
    no_wrap: bool,
    /// Which channel is the height
    #[arg(long, value_enum, default_value_t = Channel::Red)]
    channel: Channel,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Channel {
    /// Red, as in a grey image
    Red,
    /// Alpha, as in an image that carries its height along
    Alpha,
}

#[derive(Debug, Args)]
pub(crate) struct HeightRocks {
    /// The height field, a grey PNG; `-` is stdout
    #[arg(short, long, value_name = "HEIGHT.png")]
    output: OsString,
    /// Columns and rows
    #[arg(long, default_value_t = 256, value_parser = side())]
    size: u32,
    /// Which rock
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

#[derive(Debug, Args)]
pub(crate) struct HemisphereNormals {
    /// The normal map, a PNG; `-` is stdout
    #[arg(short, long, value_name = "NORMAL.png")]
    output: OsString,
    /// Columns and rows
    #[arg(long, default_value_t = 256, value_parser = side())]
    size: u32,
    /// The most that is added to each component of the hemisphere's normals, up or down, before they are brought back to unit length: 0 to
    /// 0.5. One step of the stored bytes is 1/127, about 0.008
    #[arg(long, value_name = "AMOUNT", default_value = "0", value_parser = noise, allow_negative_numbers = true)]
    noise: f64,
    /// Which noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Outside the circle write the zero vector, 128, 128, 128, in place of a flat surface
    #[arg(long)]
    zero_outside: bool,
}

/// Runs one of the generators.
pub(crate) fn run(command: &Command) -> Result<(), Failure> {
    match command {
        Command::NormalMap(arguments) => {
            let destination = Destination::from(arguments.output.as_os_str());
            refuse_overwriting(&arguments.height, &destination)?;
            let height = image::load(&arguments.height, &ImageLimits::default())?;
            let channel = match arguments.channel {
                Channel::Red => HeightChannel::Red,
                Channel::Alpha => HeightChannel::Alpha,
            };
            let options = normal_map::Options { scale: arguments.scale, wrap: !arguments.no_wrap, channel };
            write(&normal_map::from_height(&height, &options), &destination)
        }
        Command::HeightRocks(arguments) => {
            let destination = Destination::from(arguments.output.as_os_str());
            write(&height_field::rocks(arguments.size, arguments.seed), &destination)
        }
        Command::HemisphereNormals(arguments) => {
            let destination = Destination::from(arguments.output.as_os_str());
            let options = hemisphere::Options {
                size: arguments.size,
                noise: arguments.noise,
                seed: arguments.seed,
                zero_outside: arguments.zero_outside,
            };
            write(&hemisphere::normals(&options), &destination)
        }
    }
}

fn write(image: &Rgba, destination: &Destination) -> Result<(), Failure> {
    Ok(destination.write(&encode_png(image.width, image.height, &image.pixels, Compression::Small)?)?)
}

/// Reads a finite number.
fn finite(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| "not a finite number".to_owned())
}

/// Reads the strength of the noise.
fn noise(text: &str) -> Result<f64, String> {
    let most = hemisphere::MAXIMUM_NOISE;
    let amount = finite(text)?;
    if (0.0..=most).contains(&amount) { Ok(amount) } else { Err(format!("not a number from 0 to {most}")) }
}

/// Reads the side of an image.
fn side() -> RangedI64ValueParser<u32> {
    clap::value_parser!(u32).range(i64::from(*SIDES.start())..=i64::from(*SIDES.end()))
}
