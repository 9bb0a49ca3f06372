//! The command `ninebit generate`: images that techniques need, as PNG files.

use super::*;

use clap::builder::RangedI64ValueParser;
use ninebit_scene::generate::cube::{self, Content};
use ninebit_scene::generate::normal_map::{self, HeightChannel};
use ninebit_scene::generate::sky::{self, HemisphereLight};
use ninebit_scene::generate::{SIDES, dds, half_components, height_field, hemisphere, occlusion, power_table};
use ninebit_scene::vector::{Vector, cross, dot, unit_or_zero};

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
    /// Make a height field of smooth noise, which tiles without a seam
    ///
    /// The same arguments give the same bytes on every machine.
    HeightNoise(HeightNoise),
    /// Find out how much of the sky each texel of a height field sees
    ///
    /// Grey, the share of the sky weighed by the cosine; alpha holds it as well. Sixteen rays go out from each texel.
    Occlusion(Occlusion),
    /// Make a cube map that holds every direction at unit length
    ///
    /// The vectors are stored as in `normal-map`.
    NormalisationCube(NormalisationCube),
    /// Make a cube map that turns a direction into the half vector between it and a light
    ///
    /// A direction looked up points from the surface to the viewer. The vectors are stored as in `normal-map`.
    HalfVectorCube(HalfVectorCube),
    /// Make a cube map of the light of a sky and a ground, looked up with a normal
    SkyCube(SkyCube),
    /// Take what is positive, or negative, of one component of a normal map as an unsigned texture
    ///
    /// All four channels hold it: 255 is 1. Chips without signed arithmetic multiply such halves.
    HalfComponent(HalfComponent),
    /// Make a table of powers for dependent reads
    ///
    /// Red, green and blue are v to the power of the exponent, alpha is u; v grows downward, both from 0 to 1 across the picture.
    PowerTable(PowerTable),
}

#[derive(Debug, Args)]
pub(crate) struct HeightNoise {
    /// The height field, a grey PNG; `-` is stdout
    #[arg(short, long, value_name = "HEIGHT.png", value_parser = picture::output("png"))]
    output: Destination,
    /// Columns and rows
    #[arg(long, default_value_t = 128, value_parser = side())]
    size: u32,
    /// Cells of the coarsest noise along a side
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=256))]
    cells: u32,
    /// How many noises are added, each twice as fine and half as strong as the one before
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=8))]
    octaves: u32,
    /// Which noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

#[derive(Debug, Args)]
pub(crate) struct Occlusion {
    #[command(flatten)]
    field: HeightField,
    /// The occlusion, a PNG; `-` is stdout
    #[arg(short, long, value_name = "OPEN.png", value_parser = picture::output("png"))]
    output: Destination,
    /// Put it into the alpha of this normal map, which has the height field's size
    #[arg(long, value_name = "NORMAL.png")]
    normal_map: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct NormalisationCube {
    #[command(flatten)]
    cube: Cube,
    /// Sixteen bits for x and for y, to be read as `R16B16` with the mapping `HiloHemisphere`, which takes z for positive
    #[arg(long)]
    halves: bool,
}

/// A cube map that is written.
#[derive(Debug, Args)]
pub(crate) struct Cube {
    /// The cube map, a DDS file; `-` is stdout
    #[arg(short, long, value_name = "CUBE.dds", value_parser = picture::output("dds"))]
    output: Destination,
    /// Columns and rows of a face: a power of two
    #[arg(long, default_value_t = 32, value_parser = cube_side)]
    size: u32,
}

#[derive(Debug, Args)]
pub(crate) struct HalfVectorCube {
    #[command(flatten)]
    cube: Cube,
    /// The direction to the light, of any length
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], required = true, value_parser = finite, allow_negative_numbers = true)]
    light: Vec<f64>,
    /// Directions looked up point from the viewer to the surface, as positions in camera space do
    #[arg(long)]
    from_viewer: bool,
}

#[derive(Debug, Args)]
pub(crate) struct SkyCube {
    #[command(flatten)]
    cube: Cube,
    /// The direction to the middle of the sky, of any length
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], default_values = ["0", "1", "0"], value_parser = finite, allow_negative_numbers = true)]
    axis: Vec<f64>,
    /// The colour of the sky, 0 to 255
    #[arg(long, num_args = 3, value_names = ["R", "G", "B"], required = true)]
    sky: Vec<u8>,
    /// The colour of the ground
    #[arg(long, num_args = 3, value_names = ["R", "G", "B"], required = true)]
    ground: Vec<u8>,
    /// How the share of the sky follows from the angle q between normal and axis
    #[arg(long, value_enum, default_value_t = Integral::Exact)]
    integral: Integral,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Integral {
    /// 1 - sin q / 2 above the horizon, sin q / 2 below
    Exact,
    /// 1/2 + cos q / 2
    Simplified,
}

#[derive(Debug, Args)]
pub(crate) struct HalfComponent {
    /// The normal map, PNG or TGA
    normals: PathBuf,
    /// The half component, a PNG; `-` is stdout
    #[arg(short, long, value_name = "HALF.png", value_parser = picture::output("png"))]
    output: Destination,
    /// Which component
    #[arg(long, value_enum)]
    axis: Axis,
    /// What is negative, its sign turned; otherwise what is positive
    #[arg(long)]
    negative: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Axis {
    /// Red
    X,
    /// Green
    Y,
    /// Blue
    Z,
}

#[derive(Debug, Args)]
pub(crate) struct PowerTable {
    /// The table, a PNG; `-` is stdout
    #[arg(short, long, value_name = "TABLE.png", value_parser = picture::output("png"))]
    output: Destination,
    /// The power
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=65536))]
    exponent: u32,
    /// Columns
    #[arg(long, default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=4096))]
    width: u32,
    /// Rows
    #[arg(long, default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=4096))]
    height: u32,
}

#[derive(Debug, Args)]
pub(crate) struct NormalMap {
    #[command(flatten)]
    field: HeightField,
    /// Where the image's right is on the surface that the map lies on, of any length
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], default_values = ["1", "0", "0"], value_parser = finite, allow_negative_numbers = true)]
    tangent: Vec<f64>,
    /// Where that surface faces: normals become directions around it; at right angles to the tangent
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], default_values = ["0", "0", "1"], value_parser = finite, allow_negative_numbers = true)]
    normal: Vec<f64>,
    /// The normal map, a PNG; `-` is stdout
    #[arg(short, long, value_name = "NORMAL.png", value_parser = picture::output("png"))]
    output: Destination,
}

/// A height field and how it is read.
#[derive(Debug, Args)]
pub(crate) struct HeightField {
    /// The height field, PNG or TGA; 0 is the lowest
    height: PathBuf,
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
    #[arg(short, long, value_name = "HEIGHT.png", value_parser = picture::output("png"))]
    output: Destination,
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
    #[arg(short, long, value_name = "NORMAL.png", value_parser = picture::output("png"))]
    output: Destination,
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
        Command::NormalMap(NormalMap { field, tangent, normal, output }) => {
            let frame = frame(tangent, normal)?;
            let (height, options) = field.load(output)?;
            write(&normal_map::from_height_along(&height, &options, &frame), output)
        }
        Command::HeightNoise(HeightNoise { output, size, cells, octaves, seed }) => {
            write(&height_field::noise_field(*size, *cells, *octaves, *seed), output)
        }
        Command::Occlusion(arguments) => occlude(arguments),
        Command::NormalisationCube(NormalisationCube { cube, halves }) => {
            write_cube(cube, if *halves { Content::Halves } else { Content::Direction })
        }
        Command::HalfVectorCube(HalfVectorCube { cube, light, from_viewer }) => {
            let light = direction(light, "the light")?;
            write_cube(cube, Content::Half { light, from_viewer: *from_viewer })
        }
        Command::SkyCube(arguments) => {
            let [sky, ground] = [&arguments.sky, &arguments.ground].map(|bytes| sky::color(three(bytes)));
            let integral = match arguments.integral {
                Integral::Exact => sky::Integral::Exact,
                Integral::Simplified => sky::Integral::Simplified,
            };
            let axis = direction(&arguments.axis, "the middle of the sky")?;
            write_cube(&arguments.cube, Content::Sky(HemisphereLight { axis, sky, ground, integral }))
        }
        Command::HalfComponent(HalfComponent { normals, output, axis, negative }) => {
            let normals = image::load(normals, &ImageLimits::default())?;
            write(&half_components::of_normals(&normals, *axis as usize, *negative), output)
        }
        Command::PowerTable(PowerTable { output, exponent, width, height }) => {
            write(&power_table::table(*width, *height, *exponent), output)
        }
        Command::HeightRocks(HeightRocks { output, size, seed }) => write(&height_field::rocks(*size, *seed), output),
        Command::HemisphereNormals(arguments) => {
            let HemisphereNormals { size, noise, seed, zero_outside, .. } = *arguments;
            let normals = hemisphere::normals(&hemisphere::Options { size, noise, seed, zero_outside });
            write(&normals, &arguments.output)
        }
    }
}

impl HeightField {
    /// Reads the picture and its options. Returns an error if the output would overwrite it.
    fn load(&self, destination: &Destination) -> Result<(Rgba, normal_map::Options), Failure> {
        files::note(&self.height);
        destination.check()?;
        let height = image::load(&self.height, &ImageLimits::default())?;
        let channel = match self.channel {
            Channel::Red => HeightChannel::Red,
            Channel::Alpha => HeightChannel::Alpha,
        };
        Ok((height, normal_map::Options { scale: self.scale, wrap: !self.no_wrap, channel }))
    }
}

fn occlude(arguments: &Occlusion) -> Result<(), Failure> {
    let Occlusion { field, output, normal_map } = arguments;
    let (height, options) = field.load(output)?;
    let mut picture = occlusion::picture(&height, &options);
    if let Some(path) = normal_map {
        let normals = image::load(path, &ImageLimits::default())?;
        let (width, height) = (normals.width(), normals.height());
        let (columns, rows) = (picture.width(), picture.height());
        if (width, height) != (columns, rows) {
            let message = format!("the normal map is {width} x {height}, the height field {columns} x {rows}");
            return Err(Failure::invalid("NB0521", message, "make the normal map from this height field"));
        }
        for (pixel, [r, g, b, _]) in picture.pixels_mut().iter_mut().zip(normals.pixels()) {
            *pixel = [*r, *g, *b, pixel[3]];
        }
    }
    write(&picture, output)
}

fn write_cube(arguments: &Cube, content: Content) -> Result<(), Failure> {
    Ok(arguments.output.write(&dds::cube(&cube::faces(arguments.size, content)))?)
}

fn write(image: &Rgba, destination: &Destination) -> Result<(), Failure> {
    Ok(destination.write(&encode_png(image.width(), image.height(), image.pixels(), Compression::Small)?)?)
}

/// Returns the three values of an argument; clap has checked that there are three.
fn three<T: Copy + Default>(values: &[T]) -> [T; 3] {
    std::array::from_fn(|n| values.get(n).copied().unwrap_or_default())
}

/// Parses a direction. Returns an error for the zero vector.
fn direction(values: &[f64], what: &str) -> Result<[f64; 3], Failure> {
    let vector = three(values);
    if vector == [0.0; 3] {
        let advice = format!("write the direction to {what}, of any length");
        return Err(Failure::usage("the zero vector points nowhere", advice));
    }
    Ok(vector)
}

/// Returns tangent, binormal and normal of unit length, given tangent and normal.
fn frame(tangent: &[f64], normal: &[f64]) -> Result<[Vector; 3], Failure> {
    let [tangent, normal] = [direction(tangent, "the right")?, direction(normal, "the outside")?].map(unit_or_zero);
    if !(-1e-6..=1e-6).contains(&dot(tangent, normal)) {
        let advice = "write two directions whose products of components add up to 0";
        return Err(Failure::usage("tangent and normal are not at right angles", advice));
    }
    Ok([tangent, cross(normal, tangent), normal])
}

/// Parses a finite number.
fn finite(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| "not a finite number".to_owned())
}

/// Parses the strength of the noise.
fn noise(text: &str) -> Result<f64, String> {
    let most = hemisphere::MAXIMUM_NOISE;
    let amount = finite(text)?;
    if (0.0..=most).contains(&amount) { Ok(amount) } else { Err(format!("not a number from 0 to {most}")) }
}

/// Parses the side of a cube map's face.
fn cube_side(text: &str) -> Result<u32, String> {
    let (least, most) = (cube::CUBE_SIDES.start(), cube::CUBE_SIDES.end());
    let side: Option<u32> = text.parse().ok();
    side.filter(|side| side.is_power_of_two() && cube::CUBE_SIDES.contains(side))
        .ok_or_else(|| format!("not a power of two from {least} to {most}"))
}

/// Returns the parser of an image's side.
fn side() -> RangedI64ValueParser<u32> {
    clap::value_parser!(u32).range(i64::from(*SIDES.start())..=i64::from(*SIDES.end()))
}
