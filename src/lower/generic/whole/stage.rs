//! The pieces of the texture shader.

use ninebit::state::*;
use ninebit::texture::dot;
use ninebit::texture::shader::finite_vector;
use ninebit::texture::stage::{PlannedShader, PlannedShaderStage};
use ninebit::texture::yuv;
use ninebit_program::registers::unit::DOT_MAPPINGS;

use super::reader::{OWN, planned};
use super::unit::{CLASSES, SIGNS, copied};
use crate::generic::pieces::{Case, Maker, Piece, piece};
use crate::stage::{Single, byte, lit, moved};
use crate::triangle::{ANY_COMPONENT, ANY_UNIT, Field};

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

/// What stages make of coordinates, bytes and registers.
fn registers(maker: &Maker) -> Vec<Piece> {
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
    let lit = maker.case(0, "", |reader| {
        let line = reader.patterns(["scale", "offset"]).map(|pattern| reader.number_of(pattern).operand(reader.code));
        vec![lit(reader.code, reader.local("channel", REGISTER), reader.local("red", (0, 255)), line)]
    });
    let converted = maker.case(0, "", |reader| {
        reader.code.by("TEX-19");
        let held = reader.all(["held[0]", "held[1]", "held[2]"], REGISTER);
        [0, 1, 2].map(|channel| yuv::converted(channel, held)).to_vec()
    });
    vec![
        piece("nb_converted", "A colour of Y, Cb and Cr.", "@in @int held[3]", vec![converted]).filling("converted[3]"),
        piece("nb_passed", "Coordinates as a colour.", OWN, vec![passed]).filling("loaded[4]"),
        piece(
            "nb_drops",
            "Whether a coordinate has a sign that is dropped.",
            "@in @binary own[4], @in @int not_negative[4]",
            vec![drops],
        ),
        piece("nb_doubled", "The channels of a register that hold twice their byte.", "@in @int signs[4]", doubled)
            .by("halves")
            .filling("doubled[4]"),
        piece("nb_byte", "The byte of a channel of a register.", "@int held, @int is_doubled", vec![bytes]),
        piece(
            "nb_lit",
            "A channel times the luminance.",
            "@int channel, @int red, @long scale, @long offset",
            vec![lit],
        ),
    ]
}

/// The dot unit.
fn dots(maker: &Maker) -> Vec<Piece> {
    let fractions = DOT_MAPPINGS
        .iter()
        .map(|(mapping, code)| {
            maker.case(*code, mapping.name(), |reader| {
                reader.code.by("TSH-1");
                let bytes = reader.all(["bytes[0]", "bytes[1]", "bytes[2]", "bytes[3]"], (0, 255));
                dot::fractions(*mapping, bytes).into_iter().flat_map(|(n, d)| [n, d]).collect()
            })
        })
        .collect();
    let component = maker.case(0, "", |reader| {
        let b = reader.binaries(["b[0]", "b[1]"]);
        let of = reader.interpolator().linear(|part| Field::Coordinate(ANY_UNIT, ANY_COMPONENT, part));
        reader.code.by("WGT-1");
        vec![reader.result(of.at(b))]
    });
    let rounded = maker.case(0, "", |reader| vec![Single::rounded(reader.code, reader.binary("number")).0]);
    let fraction = maker.case(0, "", |reader| {
        reader.code.by("TSH-1");
        let (n, d) = (reader.local("numerator", (-(1 << 16), 1 << 16)), reader.local("denominator", (1, 1 << 30)));
        vec![Single::fraction((n, d)).0]
    });
    let product = maker.case(0, "", |reader| {
        reader.code.by("TSH-1");
        let [m, n] = [["m[0]", "m[1]", "m[2]"], ["n[0]", "n[1]", "n[2]"]].map(|of| reader.patterns(of).map(Single));
        vec![dot::dot(m, n).0]
    });
    let finite = maker.case(0, "", |reader| {
        reader.code.by("TEX-13");
        finite_vector(reader.patterns(NORMAL)).to_vec()
    });
    let reflected = maker.case(0, "", |reader| {
        reader.code.by("TSH-5");
        let [toward, square, normal, eye] = reader.patterns(["toward", "square", "normal", "eye"]).map(Single);
        vec![dot::reflected([dot::scale(toward), square], [normal, eye]).0]
    });
    let bumped = maker.case(0, "", |reader| {
        reader.code.by("TSH-7");
        vec![moved(reader.patterns(["m", "n"]).map(Single), reader.all(["blue", "green"], (0, 255))).0]
    });
    vec![
        piece(
            "nb_component",
            "A component of a unit's coordinates.",
            "@triangle, @uint unit, @int n, @in @binary b[3]",
            vec![component],
        )
        .binary(),
        piece(
            "nb_fractions",
            "What the bytes of a colour stand for: numerators and denominators.",
            "@in @int bytes[4]",
            fractions,
        )
        .by("mapping")
        .filling("fractions[6]"),
        piece("nb_rounded", "A number in binary32.", "@binary number", vec![rounded]),
        piece("nb_fraction", "A fraction in binary32.", "@int numerator, @int denominator", vec![fraction]),
        piece("nb_dot", "A dot product.", "@in @long m[3], @in @long n[3]", vec![product]),
        piece("nb_finite", "A vector; 0 if a component is not finite.", "@in @long normal[3]", vec![finite])
            .filling("given[3]"),
        piece(
            "nb_reflected",
            "A component of a reflection, by n . e and n . n.",
            "@long toward, @long square, @long normal, @long eye",
            vec![reflected],
        ),
        piece(
            "nb_bumped",
            "A displacement in 128ths of the image.",
            "@long m, @long n, @int blue, @int green",
            vec![bumped],
        ),
    ]
}

pub(super) fn pieces(maker: &Maker) -> Vec<Piece> {
    [registers(maker), dots(maker)].into_iter().flatten().collect()
}
