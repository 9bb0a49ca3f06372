//! The pieces of the texture shader.

use ninebit::state::*;
use ninebit::texture::dot;
use ninebit::texture::shader::finite_vector;
use ninebit::texture::stage::{PlannedShader, PlannedShaderStage};
use ninebit_program::registers::unit::DOT_MAPPINGS;

use super::reader::{AT, planned};
use super::unit::{CLASSES, SIGNS, copied};
use crate::generic::pieces::{Case, Maker, Piece, piece};
use crate::stage::{Single, byte, lit, moved};
use crate::triangle::ANY_UNIT;

const REGISTER: (i64, i64) = (-256, 255);
const NORMAL: [&str; 3] = ["normal[0]", "normal[1]", "normal[2]"];

/// Returns a shader whose first stage samples a unit, and may have a luminance.
fn shader(luminance: bool) -> PlannedShader {
    let operation = if luminance {
        ShaderOperation::BumpEnvironment { matrix: [0.0; 4], luminance: Some([0.0; 2]) }
    } else {
        ShaderOperation::Sample
    };
    let stage = PlannedShaderStage {
        state: ShaderStage { operation, ..ShaderStage::conventional(0, true) },
        unit: Some(0),
        live: 15,
        dots: false,
        unit_normals: false,
        lights_alpha: false,
        signed_luminance: false,
    };
    PlannedShader { stages: [stage; TEXTURE_UNITS] }
}

pub(super) fn pieces(maker: &Maker) -> Vec<Piece> {
    let passed = maker.case(0, "", |reader| {
        let sample = reader.sample();
        [0, 1, 2, 3].map(|n| reader.interpolator().passed(ANY_UNIT, n, &sample)).to_vec()
    });
    let drops = maker.case(0, "", |reader| {
        let not_negative = reader.truths(["not_negative[0]", "not_negative[1]", "not_negative[2]", "not_negative[3]"]);
        let drops = reader.interpolator().drops(ANY_UNIT, not_negative, &reader.sample());
        vec![reader.flag(drops)]
    });
    let doubled: Vec<Case> = CLASSES
        .iter()
        .enumerate()
        .flat_map(|(class, format)| [(class, format, false), (class, format, true)])
        .map(|(class, format, luminance)| {
            let name = if luminance { format!("{}, luminance", format.name()) } else { format.name().to_string() };
            maker.case(class as u32 + 4 * u32::from(luminance), &name, |reader| {
                let signs = reader.all(SIGNS, (0, 1));
                let of = |channel: usize, signed: [bool; 4]| {
                    let mut unit = planned(TextureKind::TwoDimensional, *format);
                    unit.state.signed = signed;
                    shader(luminance).doubled(0, &[unit])[channel]
                };
                (0..4).map(|channel| copied(signs, |signed| of(channel, signed))).collect()
            })
        })
        .collect();
    let bytes = maker.case(0, "", |reader| {
        reader.code.by("TSH-1");
        vec![byte(reader.local("held", REGISTER), reader.truth("is_doubled"))]
    });
    let dots = DOT_MAPPINGS
        .iter()
        .map(|(mapping, code)| {
            maker.case(*code, mapping.name(), |reader| {
                let bytes = reader.all(["bytes[0]", "bytes[1]", "bytes[2]", "bytes[3]"], (0, 255));
                vec![reader.interpolator().dot(ANY_UNIT, *mapping, bytes, &reader.sample()).0]
            })
        })
        .collect();
    let eye = maker.case(0, "", |reader| vec![reader.interpolator().rounded(ANY_UNIT, 3, &reader.sample()).0]);
    let finite = maker.case(0, "", |reader| {
        reader.code.by("TEX-13");
        finite_vector(reader.patterns(NORMAL)).to_vec()
    });
    let reflected = maker.case(0, "", |reader| {
        let [normal, eye] = [NORMAL, ["eye[0]", "eye[1]", "eye[2]"]].map(|names| reader.patterns(names).map(Single));
        let vector = dot::reflect(normal, eye).vector;
        reader.code.by("TEX-13");
        finite_vector(vector.map(|component| component.0)).to_vec()
    });
    let bumped = maker.case(0, "", |reader| {
        let m = reader.patterns(["m[0]", "m[1]", "m[2]", "m[3]"]).map(Single);
        let blue_green = reader.all(["bytes[2]", "bytes[1]"], (0, 255));
        moved([[m[0], m[3]], [m[1], m[2]]], blue_green).to_vec()
    });
    let lit = maker.case(0, "", |reader| {
        let line = reader.patterns(["scale", "offset"]).map(|pattern| reader.number_of(pattern).operand(reader.code));
        vec![lit(reader.code, reader.local("channel", REGISTER), reader.local("red", (0, 255)), line)]
    });
    vec![
        piece("nb_passed", "Coordinates as a colour.", AT, vec![passed]).filling("loaded[4]"),
        piece(
            "nb_drops",
            "Whether a coordinate has a sign that is dropped.",
            "@triangle, @uint unit, @in @binary b[4], @in @int not_negative[4]",
            vec![drops],
        ),
        piece("nb_doubled", "The channels of a register that hold twice their byte.", "@in @int signs[4]", doubled)
            .by("halves")
            .filling("doubled[4]"),
        piece("nb_byte", "The byte of a channel of a register.", "@int held, @int is_doubled", vec![bytes]),
        piece(
            "nb_dot",
            "A dot product of coordinates and a colour.",
            "@triangle, @uint unit, @in @binary b[4], @in @int bytes[4]",
            dots,
        )
        .by("mapping"),
        piece("nb_eye", "A component of the eye vector.", AT, vec![eye]),
        piece("nb_finite", "A vector; 0 if a component is not finite.", "@in @long normal[3]", vec![finite])
            .filling("given[3]"),
        piece(
            "nb_reflected",
            "The eye vector reflected about a normal.",
            "@in @long normal[3], @in @long eye[3]",
            vec![reflected],
        )
        .filling("given[3]"),
        piece("nb_bumped", "Displacements in 128ths of the image.", "@in @long m[4], @in @int bytes[4]", vec![bumped])
            .filling("given[3]"),
        piece(
            "nb_lit",
            "A channel times the luminance.",
            "@int channel, @int red, @long scale, @long offset",
            vec![lit],
        ),
    ]
}
