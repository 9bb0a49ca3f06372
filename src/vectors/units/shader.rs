//! The texture shader's arithmetic.

use super::raster::with_place;
use super::{
    CHANNELS, Column, Conditions, Kind, Reach, Unit, bytes, channels, color_results, float, named, paired, put,
};
use ninebit::number::Lane;
use ninebit::number::convert::split;
use ninebit::raster::binary::Binary;
use ninebit::raster::interpolate::COORDINATE_LIMIT;
use ninebit::state::{DotMapping, Profile, ShaderOperation, ShaderStage};
use ninebit::texture::chain::Chain;
use ninebit::texture::stage::{PlannedShader, PlannedShaderStage, ShaderSetup};
use ninebit::texture::{dot, shader};
use ninebit::trace::{Observer, Recorder, Silent};

pub(super) const NV2A: &[Profile] = &[Profile::Nv2a];

/// A colour as a vector of the dot unit.
pub(super) struct Remap;

impl Unit for Remap {
    known_as!(
        "shader-remap", &["TSH-1", "TSH-2", "TSH-3"], "a colour's bytes as the three floats that the dot unit reads"; on NV2A;
        takes [Column::choice::<DotMapping>("cfg.mapping"), channels("in", CHANNELS, Column::byte)];
        gives [Column::results(["out.x", "out.y", "out.z"], Kind::Hex(32))]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        put(results, dot::remap(named(inputs[0]), bytes(&inputs[1..])).map(f32::to_bits));
    }
}

/// The dot product of coordinates and a colour.
pub(super) struct DotProduct;

impl Unit for DotProduct {
    known_as!(
        "shader-dot-product", &["TSH-1", "TSH-2", "TSH-3", "TSH-4"],
        "the dot product of float coordinates and a remapped colour, in single precision"; on NV2A;
        takes [
            Column::choice::<DotMapping>("cfg.mapping"),
            channels("in", CHANNELS, Column::byte),
            ["in.s", "in.t", "in.q"].map(|name| Column::float(name, true, 8)),
        ];
        gives [Column::results(["mid.product_x", "mid.product_y", "mid.product_z", "out.dot"], Kind::Hex(32))]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let color = dot::remap(named(inputs[0]), bytes(&inputs[1..]));
        let products = dot::products([5, 6, 7].map(|n| float(inputs[n])), color);
        put(results, products.into_iter().chain([dot::Number::sum(products)]).map(f32::to_bits));
    }
}

/// The reflection of an eye vector about a normal.
pub(super) struct Reflection;

impl Unit for Reflection {
    known_as!(
        "shader-reflection", &["TSH-5"], "the eye vector reflected about a normal of any length, in single precision"; on NV2A;
        takes [["in.nx", "in.ny", "in.nz", "in.ex", "in.ey", "in.ez"].map(|name| Column::float(name, true, 8))];
        gives [Column::results(
            ["mid.toward", "mid.square", "mid.scale", "out.x", "out.y", "out.z"],
            Kind::Hex(32),
        )]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let [nx, ny, nz, ex, ey, ez] = [0, 1, 2, 3, 4, 5].map(|n| float(inputs[n]));
        let found = dot::reflect([nx, ny, nz], [ex, ey, ez]);
        let parts = [found.toward, found.square, found.scale];
        put(results, parts.into_iter().chain(found.vector).map(f32::to_bits));
    }
}

/// A stage of the texture shader that reads coordinates, but no texture.
pub(super) struct CoordinateStage;

impl CoordinateStage {
    /// Returns 1 and the colour of the stage of a row, or 0 if it drops the fragment.
    fn run<L: Lane>(
        &self,
        inputs: &[i64],
        _: impl Fn(usize) -> L,
        conditions: &Conditions,
        observer: &mut impl Observer,
    ) -> [L; 5] {
        let operation = match inputs[0] {
            0 => ShaderOperation::None,
            1 => ShaderOperation::PassThrough,
            _ => ShaderOperation::CullFragment { drops_not_negative: [1, 2, 3, 4].map(|n| inputs[n] != 0) },
        };
        let idle = PlannedShaderStage {
            state: ShaderStage::conventional(0, false),
            unit: None,
            live: 0,
            dots: false,
            unit_normals: false,
            lights_alpha: false,
            signed_luminance: false,
        };
        let tested = PlannedShaderStage { state: ShaderStage { operation, ..idle.state }, live: 15, ..idle };
        let shader = &PlannedShader { stages: [tested, idle, idle, idle] };
        let run = with_place([5, 6, 7, 8].map(|n| float(inputs[n])), |at, vertices| {
            let setup = &ShaderSetup::new(shader, &[], vertices);
            let scale = conditions.policies.dependent_scale;
            let chain = Chain { shader, units: &[], setup, textures: &[], vertices, perspective: false, scale };
            chain.run(at, (8, 8), observer)
        });
        run.flatten().map_or([L::ZERO; 5], |[[r, g, b, a], ..]| [L::byte(1), r, g, b, a])
    }
}

impl Unit for CoordinateStage {
    known_as!(
        "coordinate-stage", &["TEX-16", "TSH-9", "TSH-10"],
        "a stage without a texture: None, coordinates (floats) passed through as a colour, or a fragment dropped by the signs of its coordinates", Geometry;
        on NV2A;
        takes [
            Column::names("cfg.operation", &["None", "PassThrough", "CullFragment"]),
            ["s", "t", "r", "q"].map(|name| Column::flag(&format!("cfg.drops_not_negative.{name}"))),
            ["in.s", "in.t", "in.r", "in.q"].map(|name| Column::float(name, true, 8)),
        ];
        gives [Column::result("out.kept", Kind::Unsigned(1)), color_results(["out"])]
    );

    fn fit(&self, inputs: &mut [i64]) {
        // Every other row keeps its fragment.
        for n in 1..5 {
            if inputs[5] & 1 == 0 {
                inputs[n] = 1 - (inputs[n + 4] >> 31);
            }
        }
    }

    computed!(run);
}

/// The offset of a coordinate by a bump map.
pub(super) struct BumpOffset;

impl Unit for BumpOffset {
    known_as!(
        "bump-offset", &["TSH-7"],
        "u in 1/256 texel of a coordinate (a float) that blue and green (two's complement) move", Geometry; on NV2A;
        takes [
            Column::listed("cfg.size", Kind::Unsigned(13), &[1, 2, 64, 256, 4096]),
            ["in.entry_blue", "in.entry_green"].map(|name| Column::float(name, true, 3)),
            ["in.blue", "in.green"].map(Column::byte),
            Column::float("in.s", true, 5),
        ];
        gives [Column::result("mid.offset", Kind::Hex(32)), Column::result("out.u", Kind::Signed(26))]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let entries = [1, 2].map(|n| float(inputs[n]));
        let (offset, s) = (shader::offset(entries, [inputs[3] as u8, inputs[4] as u8]), Binary::new(float(inputs[5])));
        results[0] = if offset.is_nan() { f32::NAN } else { offset }.to_bits().into();
        results[1] = shader::moved(s, offset.to_bits().into(), inputs[0], 8, COORDINATE_LIMIT);
    }
}

/// The luminance of a bump map.
pub(super) struct Luminance;

impl Unit for Luminance {
    known_as!(
        "bump-luminance", &["TSH-8", "NUM-6"],
        "a channel times R / 255 scale + offset, in 4096ths and as a byte", Direct; on NV2A;
        takes [
            ["in.channel", "in.red"].map(Column::byte),
            ["in.scale", "in.offset"].map(|name| Column::float(name, true, 3)),
        ];
        gives [Column::result("mid.value", Kind::Unsigned(21)), Column::result("out.byte", Kind::Unsigned(8))]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        results[0] = shader::luminance(inputs[0], inputs[1], [2, 3].map(|n| Binary::from_bits(inputs[n])));
        results[1] = shader::luminance_byte(results[0]);
    }
}

/// The coordinate of a byte, or of a result of the dot unit.
pub(super) struct Dependent;

impl Unit for Dependent {
    known_as!(
        "dependent-coordinate", &["TSH-4", "TSH-6"],
        "a byte as a coordinate of a dependent read, and a float as one of the dot unit, in 1/256 texel", Geometry; on NV2A;
        takes [
            Column::listed("cfg.size", Kind::Unsigned(13), &[1, 2, 16, 64, 256, 1024, 4096]),
            Column::byte("in.byte"),
            Column::float("in.float", true, 6),
        ];
        gives [Column::result("out.of_byte", Kind::Unsigned(21)), Column::result("out.of_float", Kind::Signed(28))]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        // A float whose coordinate fits; in this domain all do.
        split(float(inputs[2])).1 < 16
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        results[0] = shader::dependent(inputs[1], inputs[0], conditions.policies.dependent_scale);
        results[1] = shader::coordinate(inputs[2], inputs[0]);
    }
}
