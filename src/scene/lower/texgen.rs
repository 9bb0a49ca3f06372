//! Lowers the coordinate sets of a draw: generators and texture matrices.

use super::*;
use ninebit::vertex::texgen::{CoordinateSet, Emboss, Generator};
use ninebit_program::texture_stages::Generation;

/// Words that generate whole sets, as in Direct3D 7.
const WHOLE: [&str; 3] = ["CameraSpacePosition", "CameraSpaceNormal", "CameraSpaceReflectionVector"];

/// Reads both lists. Returns `None` if there are none: all sets are then used as they are given.
pub(super) fn sets<'a>(
    reader: &mut Reader<'a>,
    generators: &Option<Raw<'a, source::List<'a, source::CoordinateSource>>>,
    matrices: &Option<Raw<'a, source::List<'a, source::Matrix>>>,
) -> Option<[CoordinateSet; 4]> {
    let mut sets = [0, 1, 2, 3].map(CoordinateSet::given);
    for (index, raw) in written(reader, generators) {
        if exists(reader, index, reader.span(&raw)).is_some() {
            sets[index] = set(reader, &raw, index).unwrap_or(sets[index]);
        }
    }
    for (index, raw) in written(reader, matrices) {
        if exists(reader, index, reader.span(&raw)).is_some() {
            sets[index].matrix = reader.value(&raw);
        }
    }
    (generators.is_some() || matrices.is_some()).then_some(sets)
}

/// Returns the entries of a list that are not `None`, with their indices.
fn written<'a, T>(
    reader: &mut Reader<'a>,
    list: &Option<Raw<'a, source::List<'a, T>>>,
) -> impl Iterator<Item = (usize, Raw<'a, T>)> + use<'a, T> {
    let list = list.as_ref().and_then(|raw| reader.read(raw)).unwrap_or_default();
    list.into_iter().enumerate().filter(|(_, raw)| raw.split() != ("None", ""))
}

/// Checks that the chip has a coordinate set. Returns `None` after recording that it has not.
fn exists(reader: &mut Reader<'_>, index: usize, place: Span) -> Option<()> {
    if index >= TEXTURE_UNITS {
        let message = format!("there is no coordinate set {index}");
        let help = "sets 0 to 3 are the entries of this list";
        return reader.refuse(finding("NB0319", place, message, "one too many", help).rule("TSH-11"));
    }
    let (what, lacks) = (format!("coordinate set {index}"), index >= reader.profile.texture_units());
    reader.accept(target::needs_nv2a(reader.profile, lacks, "NB0319", place, &what, "TSH-11"))
}

fn set<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::CoordinateSource>, index: usize) -> Option<CoordinateSet> {
    let mut set = CoordinateSet::given(index);
    let (head, rest) = raw.split();
    if head == "Emboss" {
        return emboss(reader, raw, rest, index);
    }
    if !head.is_empty() {
        let (word, rest) =
            reader.variant(raw, "coordinate generation", &["None", WHOLE[0], WHOLE[1], WHOLE[2], "Emboss"])?;
        if !rest.is_empty() {
            return reader.unknown_variant(raw, "coordinate generation", &WHOLE);
        }
        set.generators = whole(match word {
            1 => Generation::CameraSpacePosition,
            2 => Generation::CameraSpaceNormal,
            _ => Generation::CameraSpaceReflectionVector,
        });
        return Some(set);
    }
    let fields = reader.read(&raw.as_other::<source::CoordinateSet<'a>>())?;
    if fields.input.is_some() {
        set.input = fields.input(reader)? as usize;
    }
    for (component, field) in [&fields.s, &fields.t, &fields.r, &fields.q].into_iter().enumerate() {
        if let Some(raw) = field {
            set.generators[component] = Some(generator(reader, raw, component)?);
        }
    }
    Some(set)
}

/// Returns the generators of a whole set.
pub(super) fn whole(generation: Generation) -> [Option<Generator>; 4] {
    let axis = |k: usize| std::array::from_fn(|n| if n == k { 1.0 } else { 0.0 });
    let three = |generator| [Some(generator), Some(generator), Some(generator), None];
    match generation {
        Generation::CameraSpacePosition => [0, 1, 2, 3].map(|k| Some(Generator::EyeLinear(axis(k)))),
        Generation::CameraSpaceNormal => three(Generator::NormalMap),
        Generation::CameraSpaceReflectionVector => three(Generator::ReflectionMap),
        Generation::SphereMap => [Some(Generator::SphereMap), Some(Generator::SphereMap), None, None],
    }
}

const GENERATORS: &[&str] = &["ObjectLinear", "EyeLinear", "SphereMap", "NormalMap", "ReflectionMap"];

fn generator<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Generator>, component: usize) -> Option<Generator> {
    let (kind, rest) = reader.variant(raw, "coordinate generator", GENERATORS)?;
    if kind < 2 {
        let plane = reader.numbers(&Raw::<Numbers>::new(rest), "a plane", 4..=4, [0.0; 4])?;
        return Some(if kind == 0 { Generator::ObjectLinear(plane) } else { Generator::EyeLinear(plane) });
    }
    if !rest.is_empty() {
        return reader.unknown_variant(raw, "coordinate generator", GENERATORS);
    }
    let (generator, components) = match kind {
        2 => (Generator::SphereMap, 2),
        3 => (Generator::NormalMap, 3),
        _ => (Generator::ReflectionMap, 3),
    };
    if component >= components {
        let name = ["s", "t", "r", "q"][component];
        let message = format!("{} makes no {name}", GENERATORS[kind]);
        let help = if components == 2 { "it makes s and t" } else { "it makes s, t and r" };
        reader.push(finding("NB0224", reader.span(raw), message, "not for this component", help).rule("TSH-11"));
        return None;
    }
    Some(generator)
}

/// Reads Emboss, which exists on NV10 alone and makes set 1 from set 0, moved toward a light.
fn emboss<'a>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, source::CoordinateSource>,
    rest: &'a str,
    index: usize,
) -> Option<CoordinateSet> {
    let place = reader.range(raw.split().0);
    if reader.profile != Profile::Nv10 {
        let (message, help) =
            ("Emboss exists on Nv10 only", "write `profile: Nv10`, or give the moved coordinates with the vertices");
        return reader.refuse(finding("NB0324", place, message, "not on this chip", help).rule("TSH-11"));
    }
    if index != 1 {
        let message = "Emboss makes coordinate set 1 only";
        let help = "write `texgen: [None, Emboss(...)]`: set 1 becomes set 0, moved";
        return reader.refuse(finding("NB0224", place, message, format!("this is set {index}"), help).rule("TSH-11"));
    }
    let fields = source::Emboss { opening: raw.split().0, ..reader.read(&Raw::new(rest))? };
    let (light, scale) = (fields.light(reader), fields.scale(reader));
    let ([x, y, z, _], [s, t, ..]) = (light?, scale?);
    Some(CoordinateSet { emboss: Some(Emboss { light: [x, y, z], scale: [s, t] }), ..CoordinateSet::given(1) })
}
