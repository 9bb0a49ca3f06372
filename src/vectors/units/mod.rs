//! The units that vectors are made of, in the order of the pipe.

/// Defines a unit's name, its rules, and a line that says what it does. These may follow: how a frame buffer shows every row, or on which
/// inputs and results that depends (`shows`); its chips, if not both; and its columns, one by one or several at once.
macro_rules! known_as {
    (
        $name:expr, $rules:expr, $about:expr $(, $reach:ident)? $(; shows $operands:expr => $shown:expr)? $(; on $profiles:expr)?
        $(; takes [$($input:expr),+ $(,)?])? $(; gives [$($result:expr),+ $(,)?])?
    ) => {
        fn name(&self) -> &'static str {
            $name
        }

        fn about(&self) -> &'static str {
            $about
        }

        fn rules(&self) -> &'static [&'static str] {
            $rules
        }
$(
        fn reach(&self, _: &[i64], _: &[i64]) -> Reach {
            Reach::$reach
        }
)?$(
        fn reach(&self, inputs: &[i64], results: &[i64]) -> Reach {
            Reach::from_values(&inputs[$operands], &results[$shown])
        }
)?$(
        fn profiles(&self) -> &'static [Profile] {
            $profiles
        }
)?$(
        fn inputs(&self) -> Vec<Column> {
            [$(Vec::from($input)),+].concat()
        }
)?$(
        fn results(&self) -> Vec<Column> {
            [$(Vec::from($result)),+].concat()
        }
)?    };
}

/// Evaluates a unit and records its steps by one method.
///
/// - `plain run`: the method takes the inputs, the conditions and an observer, and returns the results.
/// - `run`: the results are numbers of a lane. The method also takes a function that returns the number of an input.
/// - `run; bytes from N` or `registers from N`: the method returns the intermediates, and the outputs as numbers of a lane. Rows in which an
///   input from N on varies are computed in block lanes, unless the condition holds.
macro_rules! computed {
    (plain $run:ident) => {
        fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
            put(results, self.$run(inputs, conditions, &mut Silent));
        }

        fn trace(&self, inputs: &[i64], conditions: &Conditions, recorder: &mut Recorder) {
            self.$run(inputs, conditions, recorder);
        }
    };
    ($run:ident) => {
        fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
            put(results, self.$run(inputs, |n| inputs[n] as i32, conditions, &mut Silent));
        }

        fn trace(&self, inputs: &[i64], conditions: &Conditions, recorder: &mut Recorder) {
            self.$run(inputs, |n| paired(inputs[n]), conditions, recorder);
        }
    };
    ($run:ident; $outputs:ident from $first:expr $(, unless $decides:expr)?) => {
        fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
            let (mid, out) = self.$run(inputs, |n| inputs[n] as i32, conditions, &mut Silent);
            put(results, mid.into_iter().chain(out.map(i64::from)));
        }

        fn trace(&self, inputs: &[i64], conditions: &Conditions, recorder: &mut Recorder) {
            self.$run(inputs, |n| paired(inputs[n]), conditions, recorder);
        }

        fn block(&self, inputs: &[i64], varying: usize, conditions: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
            if varying < $first $(|| $decides(inputs, varying))? {
                return None;
            }
            let rows = |rows: &block::Sixteen| self.$run(inputs, |n| rows.at(n), conditions, &mut Silent).1;
            Some(block::$outputs(inputs, varying, out, rows))
        }
    };
}

mod block;
mod clip;
mod combiner;
mod combiner_stage;
mod configured;
mod depth;
pub(super) mod final_combiner;
mod fog;
mod geometry;
mod number;
mod pixel_shader;
mod program;
mod raster;
mod reading;
mod rop;
mod sampling;
mod shader;
mod smooth;
mod stencil;
mod stroke;
mod texel;
mod texture;
mod texture_environment;
mod texture_stage;
mod vertex;

pub use configured::{
    ConfiguredAddress, ConfiguredBlend, ConfiguredCube, ConfiguredFilter, ConfiguredFinal, ConfiguredProgram,
    ConfiguredStage, register_columns,
};

use super::column::{Column, Kind};
use super::unit::{Conditions, Reach, Unit};
use ninebit::number::Pair;
use ninebit::state::{Bias, Named, Scale};

/// Returns every unit of the catalogue.
pub fn all() -> Vec<&'static dyn Unit> {
    vec![
        &geometry::VertexInstruction,
        &vertex::TransformUnit,
        &vertex::LightArithmetic,
        &vertex::LightShare,
        &vertex::LightColor,
        &number::VertexColor,
        &number::ConstantColor,
        &number::VertexSnap,
        &number::Depth,
        &geometry::PrimitiveSplit,
        &geometry::ClippedTriangle,
        &raster::Coverage,
        &raster::EyeCoverage,
        &stroke::LineCoverage,
        &stroke::PointCoverage,
        &stroke::PointSize,
        &stroke::SpriteCoordinate,
        &stroke::PolygonEdge,
        &stroke::Stipple,
        &smooth::SmoothCoverage,
        &smooth::SmoothColor,
        &clip::Clip,
        &raster::VertexWeights,
        &raster::LinearNumber,
        &raster::ColorInterpolation,
        &raster::TextureCoordinate,
        &raster::DepthInterpolation,
        &stroke::LineDepth,
        &depth::PixelDepth,
        &depth::WBuffer,
        &reading::WBufferSlope,
        &depth::DepthRange,
        &depth::DepthWord,
        &fog::LightUnit,
        &fog::FogFactor,
        &reading::FogThird,
        &fog::FogTable,
        &texture::NearestAddress,
        &texture::LinearAddress,
        &reading::BorderFilter,
        &texture::LinearStep,
        &texture::Bilinear,
        &texture::FilteredChannel,
        &texture::CubeDirection,
        &texture::CubeFace,
        &texture::OtherKind,
        &texture::LevelChoice,
        &sampling::AnisotropyTaps,
        &reading::TapWeights,
        &sampling::CylindricalWrap,
        &sampling::VolumeLayer,
        &texel::TexelExpansion,
        &texel::CompressedBlock,
        &texel::YuvConversion,
        &sampling::ColorKey,
        &sampling::ShadowComparison,
        &reading::FilteredKey,
        &reading::FilteredShadow,
        &shader::Remap,
        &shader::DotProduct,
        &shader::Reflection,
        &shader::CoordinateStage,
        &shader::BumpOffset,
        &shader::Luminance,
        &shader::Dependent,
        &combiner::InputMapping,
        &combiner::Product,
        &combiner::Sum,
        &combiner::DotProduct,
        &combiner::Mux,
        &combiner::ScaleBias,
        &combiner_stage::GeneralStage,
        &combiner_stage::AlphaPortion,
        &combiner_stage::BlueToAlpha,
        &combiner_stage::TwoStages,
        &combiner_stage::BothPortions,
        &final_combiner::FinalCombiner,
        &texture_stage::Stage,
        &texture_environment::Classic,
        &texture_environment::Combine,
        &pixel_shader::Instruction,
        &rop::AlphaTest,
        &stencil::StencilTest,
        &rop::Blend,
        &rop::WriteMask,
        &rop::SurfaceStore,
        &rop::SurfaceLoad,
    ]
}

/// Returns the unit of that name.
pub fn by_name(name: &str) -> Option<&'static dyn Unit> {
    all().into_iter().find(|unit| unit.name() == name)
}

/// Returns the variant of that number, or the last one if there is none.
pub(super) fn named<T: Named>(number: i64) -> T {
    T::ALL[usize::try_from(number).unwrap_or(0).min(T::ALL.len() - 1)]
}

/// CMB-12: returns whether a scale and a bias go together, by their numbers.
fn scale_takes_bias(scale: i64, bias: i64) -> bool {
    named::<Bias>(bias) == Bias::None || matches!(named(scale), Scale::One | Scale::Two)
}

const CHANNELS: [&str; 4] = ["r", "g", "b", "a"];

/// Returns the columns of a name's channels.
fn channels<const N: usize>(name: &str, channels: [&str; N], column: impl Fn(&str) -> Column) -> [Column; N] {
    channels.map(|channel| column(&format!("{name}.{channel}")))
}

/// Returns columns of bytes, four for each name.
fn colors(names: &[&str]) -> Vec<Column> {
    names.iter().flat_map(|name| channels(&format!("in.{name}"), CHANNELS, Column::byte)).collect()
}

/// Returns results of bytes, four for each name.
fn color_results<const N: usize>(names: [&str; N]) -> Vec<Column> {
    let byte = |name: &str| Column::result(name, Kind::Unsigned(8));
    names.iter().flat_map(|name| channels(name, CHANNELS, byte)).collect()
}

/// Returns four numbers as a colour of bytes.
fn bytes(values: &[i64]) -> [u8; 4] {
    std::array::from_fn(|n| values[n] as u8)
}

/// Returns the float with these bits.
fn float(bits: i64) -> f32 {
    f32::from_bits(bits as u32)
}

/// Returns a float with the sign and the fraction of `bits`, which also choose its power of two.
fn sized(bits: i64, (first, count): (i64, i64)) -> i64 {
    bits & 0x807f_ffff | (127 + first + (bits >> 3) % count) << 23
}

/// Writes results in their order.
fn put<T: Into<i64>>(results: &mut [i64], values: impl IntoIterator<Item = T>) {
    for (result, value) in results.iter_mut().zip(values) {
        *result = value.into();
    }
}

/// Returns a register's integer with the ideal's real number.
fn paired(value: i64) -> Pair {
    Pair { fixed: value as i32, ideal: value as f64 }
}
