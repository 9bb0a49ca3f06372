//! The pieces of what a triangle gives a pixel: weights, colours, fog and depth, and of the tests.

use ninebit::number::{Integer, Register as _};
use ninebit::raster::binary::Binary;
use ninebit::raster::depth;
use ninebit::raster::fog::not_finite;
use ninebit::rop::stencil;
use ninebit::state::*;
use ninebit::texture::single;
use ninebit_program::registers::raster;
use ninebit_program::registers::unit::{FOG_MODES, SHADOW_FUNCTIONS, STENCIL_OPERATIONS};

use crate::generic::pieces::{Case, Maker, Piece, Reader, piece};
use crate::input::Input;
use crate::number::Number;
use crate::triangle::Field;
use crate::whole::Outcome;

const E: [&str; 3] = ["e[0]", "e[1]", "e[2]"];
/// The range of edge functions.
const EDGE: (i64, i64) = (-(1 << 41), 1 << 41);
const V: [&str; 2] = ["v[0]", "@narrow(v[1])"];
/// The range of depths.
const DEPTH: (i64, i64) = (0, 0xff_ffff);
const BYTE: (i64, i64) = (0, 255);

fn weights<'a>(reader: &Reader<'a>) -> Vec<Number<'a>> {
    let sample = reader.interpolator().sample::<false>(reader.all(E, EDGE));
    sample.b.into_iter().chain([sample.sum]).map(|number| reader.result(number)).collect()
}

/// FOG-2: returns the byte by a mode; that of a line whose parameters are not finite is fixed.
fn fog_byte<'a>(reader: &Reader<'a>, mode: Option<FogMode>) -> Number<'a> {
    let (of, value) = (reader.interpolator(), reader.binary("coordinate"));
    let none = [Binary::whole(Number::ZERO); 2];
    let Some(mode) = mode else { return of.fog_by(None, none, value) };
    if !mode.is_linear() {
        return of.fog_or_fixed(of.fog_by(Some(mode), none, value));
    }
    let line = reader.patterns(["p0", "p1"]);
    let [p0, p1] = line.map(|pattern| reader.number_of(pattern).parts(reader.code, (-(1 << 24), 1 << 24)));
    let byte = of.fog_or_fixed(of.fog_by(Some(mode), [p0, p1], value));
    reader.code.by("FOG-5");
    let [first, second] = line.map(single::is_finite);
    byte.or(first & second, Number::Constant(not_finite(mode).into()))
}

fn fog_cases(maker: &Maker, of: impl for<'a> Fn(&mut Reader<'a>, Option<FogMode>) -> Vec<Number<'a>>) -> Vec<Case> {
    let mut cases = vec![maker.case(0, "the vertices' factors", |reader| of(reader, None))];
    cases.extend(FOG_MODES.map(|(mode, code)| maker.case(code, mode.name(), |reader| of(reader, Some(mode)))));
    cases
}

/// Makes a piece of one case that fills an array.
fn one(name: &'static str, about: &'static str, parameters: &'static str, array: &'static str, case: Case) -> Piece {
    piece(name, about, parameters, vec![case]).filling(array)
}

fn attributes(maker: &Maker) -> Vec<Piece> {
    let edges = maker.case(0, "", |reader| {
        let of = reader.interpolator();
        let [x, y] = [Input::X, Input::Y].map(|input| of.input(input));
        of.edges(x, y, false).to_vec()
    });
    let weights = maker.case(0, "", |reader| weights(reader));
    let colors = maker.case(0, "", |reader| {
        let of = reader.interpolator();
        let both = of.color_weights(&reader.sample());
        [0, 1].map(|set| of.color(set, both)).concat()
    });
    let fog = fog_cases(maker, |reader, mode| vec![fog_byte(reader, mode)]);
    let coordinate = maker.case(0, "", |reader| {
        let of = reader.interpolator().linear(Field::Fog);
        vec![reader.result(of.at(reader.sample().b))]
    });
    let fixed = fog_cases(maker, |_, mode| vec![Number::Constant(mode.map_or(-1, |mode| not_finite(mode).into()))]);
    let sample = "@triangle, @in @binary b[3]";
    vec![
        one("nb_edges", "The edge functions of a pixel.", "@triangle, @int x, @int y", "e[3]", edges).wide(),
        one(
            "nb_weights",
            "The weights of a pixel, and the sum of its edge numbers.",
            "@triangle, @in @long e[3]",
            "b[3]",
            weights,
        )
        .binary(),
        one("nb_colors", "The primary and the secondary colour.", sample, "colors[8]", colors),
        piece(
            "nb_fog",
            "The fog factor as a byte, by the mode.",
            "@triangle, @binary coordinate, @long p0, @long p1",
            fog,
        )
        .by("mode"),
        piece("nb_fog_coordinate", "The fog coordinate.", sample, vec![coordinate]).binary(),
        piece("nb_fixed_fog", "The fog byte where a coordinate is not finite; -1 if there is none.", "", fixed)
            .by("mode"),
    ]
}

fn depths(maker: &Maker) -> Vec<Piece> {
    let between = maker.flagged(["z", "w"], |reader, w_buffer| {
        reader.parts(reader.interpolator().depth_between(w_buffer, reader.all(E, EDGE)))
    });
    let moved = maker.case(0, "", |reader| {
        let depth = Binary {
            mantissa: reader.local("@narrow(v[0])", (-(1 << 31) + 1, (1 << 31) - 1)),
            exponent: reader.local(V[1], crate::code::EXPONENT),
        };
        reader.parts(reader.interpolator().depth_moved(depth))
    });
    let limited = maker.case(0, "", |reader| {
        let limits = reader
            .patterns(["lowest", "highest"])
            .map(|pattern| reader.number_of(pattern).parts(reader.code, (-(1 << 24), 1 << 24)));
        reader.code.by("DEP-4");
        let (depth, outside) = depth::limited_to(limits, reader.wide(V));
        let mut results = reader.parts(depth);
        results.push(reader.flag(outside));
        results
    });
    let words = maker.cases(
        |format: DepthFormat| format as u32,
        |reader, format| {
            reader.code.by("DEP-3");
            vec![depth::stored(format, reader.wide(V)).within(0, format.largest().into())]
        },
    );
    vec![
        piece("nb_depth", "z or w: mantissa and exponent.", "@triangle, @in @long e[3]", between)
            .by("w_buffer")
            .filling("v[2]")
            .wide(),
        one("nb_moved_depth", "A depth with the triangle's offset.", "@triangle, @in @long v[2]", "moved[2]", moved)
            .wide(),
        one(
            "nb_limited_depth",
            "A depth within its range, and whether it was outside.",
            "@in @long v[2], @long lowest, @long highest",
            "limited[3]",
            limited,
        )
        .wide(),
        piece("nb_depth_word", "The word of a depth.", "@in @long v[2]", words).by("format"),
    ]
}

fn tests(maker: &Maker) -> Vec<Piece> {
    let operated = maker.cases(
        |operation: StencilOperation| STENCIL_OPERATIONS[operation as usize],
        |reader, operation| {
            reader.code.by("STN-1");
            let [reference, stored] = reader.all(["reference", "stored"], BYTE);
            vec![stencil::operated(operation, reference, stored).within(0, 255)]
        },
    );
    let settled = maker.case(0, "", |reader| {
        let [kept, stencil_passed, depth_passed] = reader.truths(["kept", "stencil_passed", "depth_passed"]);
        let [depth, held_depth] = reader.all(["depth", "held_depth"], DEPTH);
        let stencils = reader.all(["stencils[0]", "stencils[1]", "stencils[2]"], BYTE);
        let held_stencil = reader.local("held_stencil", BYTE);
        reader.code.by("STN-1");
        let outcome = Outcome { kept, stencil_passed, depth_passed, stencils, held_stencil, depth, held_depth };
        let (stored, [depth, stencil]) = outcome.settled();
        vec![reader.flag(stored), depth, stencil]
    });
    let compared = maker.cases(raster::compare_function, |reader, function: CompareFunction| {
        let [a, b] = reader.all(["a", "b"], DEPTH);
        vec![Integer::compared(a, function, b).number()]
    });
    let shadow = SHADOW_FUNCTIONS.iter().map(|(function, code)| {
        maker.case(*code, function.name(), |reader| {
            reader.code.by("SHD-1");
            let [a, b] = reader.all(["a", "b"], DEPTH);
            vec![Integer::compared(a, *function, b).number()]
        })
    });
    let outcome = "@int kept, @int stencil_passed, @int depth_passed, @in @int stencils[3], @int held_stencil, @int depth, @int held_depth";
    vec![
        piece("nb_compared", "A comparison.", "@int a, @int b", compared).by("function"),
        piece(
            "nb_shadow_compared",
            "The comparison of a depth that a unit fetches.",
            "@int a, @int b",
            shadow.collect(),
        )
        .by("function"),
        piece("nb_stencil", "A stencil that an operation makes.", "@int reference, @int stored", operated)
            .by("operation"),
        one(
            "nb_settled",
            "What tests leave: whether the fragment is stored, the depth, the stencil.",
            outcome,
            "left[3]",
            settled,
        ),
    ]
}

pub(super) fn pieces(maker: &Maker) -> Vec<Piece> {
    [attributes(maker), depths(maker), tests(maker)].into_iter().flatten().collect()
}
