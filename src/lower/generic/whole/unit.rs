//! The pieces of a texture unit.

use ninebit::number::{Integer, Register as _};
use ninebit::state::*;
use ninebit::texture::color_key;
use ninebit::texture::filter::{bilinear, lerp};
use ninebit::texture::lod::Selection;
use ninebit::texture::planned::PlannedUnit;
use ninebit_program::registers::unit::{ADDRESS_MODES, COLOR_KEYS, FORMATS, MIN_FILTERS};

use super::reader::{LANE, OWN, plain, planned};
use crate::coordinates::{Facing, log2_ratio, pairs_of_quad};
use crate::generic::pieces::{Case, Maker, Piece, Reader, piece};
use crate::input::Input;
use crate::number::Number;
use crate::place::{Place, Projection, side};
use crate::texel::Sampler;

/// How a unit gets its coordinates.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    Own,
    Face,
    Plane,
    OnFace,
    Point,
    Moved,
    Bytes,
    Floats,
    Ends,
}

/// All ways, with the names of their codes in the text and what they are.
pub(super) const WAYS: [(Way, &str, &str); 9] = [
    (Way::Own, "WAY_OWN", "s/q and t/q"),
    (Way::Face, "WAY_FACE", "toward a cube map"),
    (Way::Plane, "WAY_PLANE", "toward an image of two dimensions"),
    (Way::OnFace, "WAY_ON_FACE", "s/q and t/q on a face"),
    (Way::Point, "WAY_POINT", "in a point"),
    (Way::Moved, "WAY_MOVED", "displaced"),
    (Way::Bytes, "WAY_BYTES", "two bytes"),
    (Way::Floats, "WAY_FLOATS", "two dot products"),
    (Way::Ends, "WAY_ENDS", "ends of a face by two dot products"),
];

/// Classes of formats: bytes, or halves.
pub(super) const CLASSES: [TextureFormat; 3] = [TextureFormat::A8R8G8B8, TextureFormat::R16B16, TextureFormat::Y16];

const D: [&str; 3] = ["d[0]", "d[1]", "d[2]"];
const TEXELS: [&str; 4] = ["t[0]", "t[1]", "t[2]", "t[3]"];
const LANES: [&str; 4] = ["lanes[0]", "lanes[1]", "lanes[2]", "lanes[3]"];
pub(super) const SIGNS: [&str; 4] = ["signs[0]", "signs[1]", "signs[2]", "signs[3]"];
const SIDE: (i64, i64) = (1, 4096);
const COORDINATE: (i64, i64) = (-(1 << 25), 1 << 25);
const LEVEL: (i64, i64) = (0, 15);
/// The range of coordinates of quads.
const FAR: (i64, i64) = (-(1 << 61) - (1 << 32), (1 << 61) + (1 << 32));

const QUAD: [[&str; 2]; 3] = [["quad[0]", "quad[1]"], ["quad[2]", "quad[3]"], ["quad[4]", "quad[5]"]];

/// Returns the place of a unit by a way.
fn place<'a>(maker: &Maker, reader: &Reader<'a>, way: Way) -> (Place<'a>, bool) {
    let given = ["given[0]", "given[1]"];
    let place = match way {
        Way::Own | Way::OnFace => Place::Own(Projection::Ratio),
        Way::Point => Place::Own(Projection::Plane),
        Way::Face | Way::Plane => Place::OnFace(reader.binaries(["face[0]", "face[1]", "face[2]"])),
        Way::Moved => Place::Moved(reader.patterns(given)),
        Way::Floats => Place::Floats(reader.patterns(given)),
        Way::Ends => Place::Ends(reader.patterns(given)),
        Way::Bytes => {
            let bytes = reader.all(["@narrow(given[0])", "@narrow(given[1])"], (0, 255));
            Place::Bytes(bytes, maker.policies.dependent_scale)
        }
    };
    (place, way == Way::Point)
}

/// Returns a unit that samples by a way.
fn unit_of(way: Way) -> PlannedUnit {
    let has_faces = matches!(way, Way::Face | Way::OnFace | Way::Ends);
    let kind = if has_faces { TextureKind::Cube } else { TextureKind::TwoDimensional };
    let mut unit = planned(kind, TextureFormat::A8R8G8B8);
    if way == Way::OnFace {
        unit.stage.operation = ShaderOperation::Sample2D;
    }
    unit
}

fn by_way(maker: &Maker, of: impl for<'a> Fn(&mut Reader<'a>, Way) -> Vec<Number<'a>>) -> Vec<Case> {
    WAYS.iter().map(|(way, _, name)| maker.case(*way as u32, name, |reader| of(reader, *way))).collect()
}

/// The images whose sides are addressed alike, with what their code adds to that of a mode.
const SIDES: [(&str, TextureKind, bool, u32); 3] = [
    ("", TextureKind::TwoDimensional, false, 0),
    (", border texels", TextureKind::TwoDimensional, true, 8),
    (", rectangle", TextureKind::Rectangle, false, 16),
];

/// Makes a case for each address mode and each of the first `images` of [`SIDES`].
fn by_mode(
    maker: &Maker,
    images: usize,
    of: impl for<'a> Fn(&mut Reader<'a>, &PlannedUnit) -> Vec<Number<'a>>,
) -> Vec<Case> {
    let all = ADDRESS_MODES.iter().flat_map(|mode| SIDES[..images].iter().map(move |side| (mode, side)));
    all.map(|((mode, code), (image, kind, border, add))| {
        let mut unit = planned(*kind, TextureFormat::A8R8G8B8);
        (unit.border, unit.state.address_s, unit.state.address_r) = (*border, *mode, *mode);
        maker.case(code + add, &format!("{}{image}", mode.name()), |reader| {
            if *kind == TextureKind::Rectangle {
                reader.code.allow_any_divisors();
            }
            of(reader, &unit)
        })
    })
    .collect()
}

fn by_class(maker: &Maker, of: impl for<'a> Fn(&mut Reader<'a>, &PlannedUnit) -> Vec<Number<'a>>) -> Vec<Case> {
    let case = |(class, format): (usize, &TextureFormat)| {
        let unit = planned(TextureKind::TwoDimensional, *format);
        maker.case(class as u32, format.name(), |reader| of(reader, &unit))
    };
    CLASSES.iter().enumerate().map(case).collect()
}

/// Returns what `of` copies of the four flags of signed channels: the flag, or 0 if it copies none.
pub(super) fn copied<'a>(signs: [Number<'a>; 4], of: impl Fn([bool; 4]) -> bool) -> Number<'a> {
    let channel = (0..4).find(|channel| of(std::array::from_fn(|n| n == *channel)));
    channel.map_or(Number::ZERO, |channel| signs[channel])
}

/// The directions in which units sample.
fn directions(maker: &Maker) -> Vec<Piece> {
    let direction = maker.case(0, "", |reader| {
        let place = Place::Own(Projection::Direction);
        let direction = reader.on(&plain(), (place, false), |unit| unit.direction(place, unit.sample));
        direction.into_iter().flatten().map(|number| reader.result(number)).collect()
    });
    let vector = maker.case(0, "", |reader| {
        let of = reader.patterns(["given[0]", "given[1]", "given[2]"]);
        of.map(|pattern| reader.result(reader.number_of(pattern))).to_vec()
    });
    let facing = maker.case(0, "", |reader| {
        let direction = reader.binaries(D);
        let facing = reader.on(&plain(), (Place::Vector(direction), false), |unit| unit.facing(direction));
        let flags = [facing.is_x, facing.is_y, facing.negative].map(|truth| reader.flag(truth));
        flags.into_iter().chain([facing.number()]).collect()
    });
    let face = maker.case(0, "", |reader| {
        let direction = reader.binaries(D);
        let [is_x, is_y, negative] = reader.truths(["facing[0]", "facing[1]", "facing[2]"]);
        let of = Facing { is_x, is_y, negative };
        let face = reader.on(&plain(), (Place::Vector(direction), false), |unit| unit.on_face(direction, of));
        face.map(|number| reader.result(number)).to_vec()
    });
    vec![
        piece("nb_direction", "A unit's own direction into a cube map.", OWN, vec![direction]).filling("d[3]").binary(),
        piece("nb_vector", "A direction of the dot unit.", "@in @long given[3]", vec![vector]).filling("d[3]").binary(),
        piece(
            "nb_facing",
            "The face that a direction meets: whether it is on x, on y, negative; its number.",
            "@in @binary d[3]",
            vec![facing],
        )
        .filling("facing[4]"),
        piece("nb_face", "sc, tc and |ma| on a face.", "@in @binary d[3], @in @int facing[4]", vec![face])
            .filling("face[3]")
            .binary(),
    ]
}

fn coordinates(maker: &Maker) -> Vec<Piece> {
    let near = by_way(maker, |reader, way| {
        let sides = reader.all(["width", "height"], SIDE);
        reader.on(&unit_of(way), place(maker, reader, way), |unit| {
            let uv = unit.coordinates(sides, None);
            uv.map(|at| at.within(COORDINATE.0, COORDINATE.1)).to_vec()
        })
    });
    let far = by_way(maker, |reader, way| {
        let sides = reader.all(["width", "height"], SIDE);
        let pixel = [Input::X, Input::Y].map(|input| reader.interpolator().input(input));
        reader.on(&unit_of(way), place(maker, reader, way), |unit| {
            let (uv, behind) = unit.far_coordinates(pixel, sides, None);
            uv.into_iter().chain([reader.flag(behind)]).collect()
        })
    });
    let placed = "@triangle, @in @binary own[4], @in @long given[3], @in @binary face[3], @int x, @int y, @int width, @int height";
    let far_placed = "@triangle, @in @binary own[4], @binary sum, @in @long given[3], @in @binary face[3], @int x, @int y, @int width, @int height";
    vec![
        piece("nb_coordinates", "u and v in 1/256 texel.", placed, near).by("way").filling("uv[2]"),
        piece(
            "nb_far_coordinates",
            "u and v of a quad's pixel in 1/65536 texel, and whether it lies behind the viewer.",
            far_placed,
            far,
        )
        .by("way")
        .filling("far[3]")
        .wide(),
    ]
}

/// The third coordinate: of volumes, and the reference of depths.
fn third(maker: &Maker) -> Vec<Piece> {
    let place = (Place::Own(Projection::Ratio), false);
    let layer = by_mode(maker, 1, |reader, unit| {
        let layers = reader.local("layers", (1, 512));
        let w = reader.local("w", COORDINATE);
        let (layer, beyond) = reader.on(unit, place, |unit| unit.layer_at(w, layers, Number::Constant(1)));
        vec![layer, reader.flag(beyond)]
    });
    let across = maker.case(0, "", |reader| {
        let layers = reader.local("layers", (1, 512));
        vec![reader.on(&plain(), place, |unit| unit.across_layers(layers)).within(COORDINATE.0, COORDINATE.1)]
    });
    let reference = maker.case(0, "", |reader| {
        let third = reader.on(&plain(), place, |unit| unit.third(Projection::Ratio));
        reader.parts(third)
    });
    vec![
        piece(
            "nb_across_layers",
            "The coordinate in 1/256 layer of a volume.",
            "@in @binary own[4], @int layers",
            vec![across],
        ),
        piece("nb_layer", "The layer at a coordinate, and whether it is beyond them.", "@int w, @int layers", layer)
            .by("mode")
            .filling("layer[2]"),
        piece("nb_reference", "r/q: mantissa and exponent.", OWN, vec![reference]).filling("v[2]").wide(),
    ]
}

fn levels(maker: &Maker) -> Vec<Piece> {
    let lod = maker.case(0, "", |reader| {
        let far = QUAD.map(|names| reader.all(names, FAR));
        vec![log2_ratio(reader.code, far, reader.truth("behind"))]
    });
    let taps = maker.case(0, "", |reader| {
        let far = QUAD.map(|names| reader.all(names, FAR));
        reader.code.by("TEX-17");
        let limit = reader.local("limit", (2, 8));
        let pairs = pairs_of_quad(far, reader.truth("behind"), limit);
        pairs.into_iter().flat_map(|([u, v], weight)| [u, v, weight]).collect()
    });
    let chosen = maker.cases(
        |filter: MipFilter| filter as u32,
        |reader, filter| {
            let log = reader.local("log", (-(1 << 15), 1 << 15));
            let (bias, last) = (reader.local("bias", (-4096, 4095)), reader.local("last", LEVEL));
            let [least, most] = reader.all(["least", "most"], (0, 4095));
            let selection = Selection::new(filter, last, [bias, least, most]);
            let place = (Place::Own(Projection::Plane), false);
            let (first, next, weight, magnifies) = reader.on(&plain(), place, |unit| unit.chosen(selection, log));
            vec![first, next, weight, reader.flag(magnifies)]
        },
    );
    let filters: Vec<Case> = MIN_FILTERS
        .iter()
        .map(|((filter, mip), code)| {
            maker.case(*code, &format!("{}, {}", filter.name(), mip.name()), |_| {
                vec![Number::Constant((*filter == Filter::Linear).into()), Number::Constant(*mip as i64)]
            })
        })
        .collect();
    vec![
        piece("nb_lod", "The lod of a quad.", "@in @long quad[6], @int behind", vec![lod]),
        piece(
            "nb_taps",
            "Four pairs of taps of a quad: offsets along u and v, and weight.",
            "@in @long quad[6], @int behind, @int limit",
            vec![taps],
        )
        .filling("taps[12]"),
        piece(
            "nb_levels",
            "First and second level, weight of the second, whether the image is magnified.",
            "@int log, @int bias, @int least, @int most, @int last",
            chosen,
        )
        .by("mip")
        .filling("levels[4]"),
        piece("nb_min_filter", "Whether a minification filter mixes texels, and how it mixes levels.", "", filters)
            .by("code")
            .filling("filters[2]"),
    ]
}

/// Where levels and their texels are.
fn addresses(maker: &Maker) -> Vec<Piece> {
    let half = maker.case(0, "", |reader| vec![side(reader.local("first", SIDE), reader.local("level", LEVEL))]);
    let axis = by_mode(maker, SIDES.len(), |reader, unit| {
        let (at, size) = (reader.local("at", COORDINATE), reader.local("size", SIDE));
        let is_linear = reader.truth("is_linear");
        let place = (Place::Own(Projection::Plane), false);
        let ([first, second], weight) =
            reader.on(unit, place, |of| of.along(unit.state.address_s, at, size, is_linear));
        vec![first.0, reader.flag(first.1), second.0, reader.flag(second.1), weight]
    });
    let offset = maker.flagged(["none", "border texels"], |reader, border| {
        let [x, y] = reader.all(["x", "y"], (-4, 4099));
        vec![PlannedUnit { border, ..plain() }.texel_offset(reader.local("width", SIDE), x, y)]
    });
    let words = maker.flagged(["none", "border texels"], |reader, border| {
        // The index of the texel that would be the first after the last row.
        let beyond = Number::Constant(if border { BORDER_TEXELS.into() } else { 0 });
        let [width, height] = reader.all(["width", "height"], SIDE);
        vec![PlannedUnit { border, ..plain() }.texel_offset(width, Number::ZERO - beyond, height + beyond)]
    });
    vec![
        piece("nb_side", "The side of a level.", "@int first, @int level", vec![half]),
        piece(
            "nb_axis",
            "Along an axis: two texels, each with whether it is the border colour, and the weight of the second.",
            "@int at, @int size, @int is_linear",
            axis,
        )
        .by("mode")
        .filling("axis[5]"),
        piece("nb_texel_offset", "The index of a texel in its level.", "@int width, @int x, @int y", offset)
            .by("border"),
        piece("nb_level_words", "The number of words of a level.", "@int width, @int height", words).by("border"),
    ]
}

fn texels(maker: &Maker) -> Vec<Piece> {
    let formats = |of: &dyn for<'a> Fn(&mut Reader<'a>, &PlannedUnit, bool) -> Vec<Number<'a>>| -> Vec<Case> {
        FORMATS
            .iter()
            .map(|(code, format, linear)| {
                let unit = planned(TextureKind::TwoDimensional, *format);
                maker.case(*code, format.name(), |reader| of(reader, &unit, *linear))
            })
            .collect()
    };
    let traits = formats(&|_, unit, linear| {
        let class = CLASSES.iter().position(|class| unit.is_wide() && *class == unit.format).unwrap_or(0);
        let depth = unit.format.depth().map_or(0, |format| format as i64 + 1);
        let all = color_key::compared(unit) == 4;
        [linear.into(), class as i64, depth, all.into()].map(Number::Constant).to_vec()
    });
    let inside = formats(&|reader, unit, _| Sampler::new(unit).inside(reader.word("word"), reader.code).to_vec());
    let beyond = by_class(maker, |reader, unit| {
        Sampler::new(unit).beyond(reader.all(["color[0]", "color[1]", "color[2]", "color[3]"], (0, 255))).to_vec()
    });
    let read = by_class(maker, |reader, unit| {
        let bits = if unit.is_wide() { 16 } else { 8 };
        let lane = reader.local("lane", (0, (1 << bits) - 1));
        vec![Sampler::new(unit).read(lane, reader.truth("is_signed"))]
    });
    let signed = by_class(maker, |reader, unit| {
        let signs = reader.all(SIGNS, (0, 1));
        let lane = |lane: usize| {
            copied(signs, |signed| {
                PlannedUnit { state: TextureUnit { signed, ..unit.state }, ..unit.clone() }.signed_lane(lane)
            })
        };
        (0..4).map(lane).collect()
    });
    vec![
        piece(
            "nb_format",
            "A format: in rows; 1 or 2 if it has halves; 1 to 4 if it is a depth; whether a key compares alpha.",
            "",
            traits,
        )
        .by("code")
        .filling("traits[4]"),
        piece("nb_inside", "The lanes of a texel: R, G, B, A, or halves.", "@uint word", inside)
            .by("code")
            .filling("lanes[4]"),
        piece("nb_beyond", "The lanes of the border colour.", "@in @int color[4]", beyond)
            .by("halves")
            .filling("lanes[4]"),
        piece("nb_read", "A lane, which may be signed.", "@int lane, @int is_signed", read).by("halves"),
        piece("nb_signed", "The lanes that are signed, of the channels that are.", "@in @int signs[4]", signed)
            .by("halves")
            .filling("lanes[4]"),
    ]
}

fn filters(maker: &Maker) -> Vec<Piece> {
    let mixed = maker.case(0, "", |reader| {
        reader.code.by("TEX-6");
        let (texels, [u, v]) = (reader.all(TEXELS, LANE), reader.all(["u", "v"], (0, 255)));
        vec![bilinear(texels, u, v, |step| step.between(&texels))]
    });
    let between = maker.case(0, "", |reader| {
        reader.code.by("TEX-9");
        let [a, b] = reader.all(["a", "b"], LANE);
        vec![lerp(a, b, reader.local("weight", (0, 255))).between(&[a, b])]
    });
    let summed = maker.case(0, "", |reader| {
        reader.code.by("TEX-17");
        let sum = reader.local("sum", (-(1 << 26), 1 << 26));
        vec![ninebit::number::Blend::round8(sum).within(LANE.0, LANE.1)]
    });
    let keyed: Vec<Case> = COLOR_KEYS
        .iter()
        .flat_map(|(mode, code)| [(mode, code, TextureFormat::X8R8G8B8), (mode, code, TextureFormat::A8R8G8B8)])
        .map(|(mode, code, format)| {
            let unit = planned(TextureKind::TwoDimensional, format);
            let all = u32::from(color_key::compared(&unit) == 4);
            maker.case(code + 4 * all, &format!("{}, {}", mode.name(), format.name()), |reader| {
                let lanes = reader.all(LANES, LANE);
                let wanted = reader.all(["wanted[0]", "wanted[1]", "wanted[2]", "wanted[3]"], LANE);
                let (lanes, dropped) = Sampler::new(&unit).keyed_by(*mode, wanted, lanes, reader.code);
                lanes.into_iter().chain([reader.flag(dropped)]).collect()
            })
        })
        .collect();
    let loaded = by_class(maker, |reader, unit| {
        let sampler = Sampler::new(unit);
        if unit.is_wide() {
            let lanes = reader.all(LANES, LANE);
            return sampler.bytes(lanes, reader.truths([SIGNS[0], SIGNS[1]]), reader.code).to_vec();
        }
        sampler.doubled(reader.all(LANES, (-128, 255)), reader.truths(SIGNS), reader.code).to_vec()
    });
    vec![
        piece("nb_mixed", "Four texels mixed.", "@in @int t[4], @int u, @int v", vec![mixed]),
        piece("nb_between", "Two levels mixed.", "@int a, @int b, @int weight", vec![between]),
        piece("nb_summed", "A sum of taps in 1/256.", "@int sum", vec![summed]),
        piece(
            "nb_keyed",
            "Lanes after a colour key, and whether it drops the fragment.",
            "@in @int lanes[4], @in @int wanted[4]",
            keyed,
        )
        .by("key")
        .filling("left[5]"),
        piece("nb_loaded", "The register that lanes become.", "@in @int lanes[4], @in @int signs[4]", loaded)
            .by("halves")
            .filling("loaded[4]"),
    ]
}

pub(super) fn pieces(maker: &Maker) -> Vec<Piece> {
    let of_texels = [levels(maker), addresses(maker), texels(maker), filters(maker)];
    [directions(maker), coordinates(maker), third(maker)].into_iter().chain(of_texels).flatten().collect()
}
