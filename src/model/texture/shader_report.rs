//! The reports of the texture shader to an observer. Nothing here computes a value that is used.

use super::dependent::{Dependent, Target};
use super::dot::Reflection;
use super::report::{COORDINATES, Report, block, component};
use super::stage::{Color, Dot};
use crate::combiner::registers::channel_name;
use crate::number::Lane;
use crate::raster::interpolate::Sample;
use crate::state::{DependentScale, DotMapping, Level, Named};
use crate::trace::{Observer, Operand, Step, byte, float, float_step, plain, report};

const AXES: [&str; 3] = ["x", "y", "z"];

fn name(index: usize, suffix: &str) -> String {
    format!("unit{index}.{suffix}")
}

fn step(index: usize, rule: &'static str, suffix: &str, value: impl Into<i64>) -> Step {
    Step::plain(&block(index), rule, name(index, suffix), value)
}

/// Returns a step that yields a single-precision number.
fn single(index: usize, rule: &'static str, suffix: &str, value: f32, ideal: f64) -> Step {
    float_step(&block(index), rule, name(index, suffix), value, ideal)
}

/// Reports the register of a stage whose result is the same for every pixel.
pub(super) fn constant<L: Lane, O: Observer>(
    index: usize,
    rule: &'static str,
    live: u8,
    register: &[L; 4],
    observer: &mut O,
) {
    for n in (0..4).filter(|n| live >> n & 1 != 0) {
        let name = format!("texture{index}.{}", channel_name(n));
        observer.step(report::register_step(&block(index), rule, name, register[n]));
    }
}

/// TSH-9: reports one channel of a coordinate as a colour.
pub(super) fn pass_through<L: Lane, O: Observer>(
    index: usize,
    n: usize,
    (values, at): ([f32; 3], &Sample<'_>),
    v: i64,
    value: L,
    observer: &mut O,
) {
    let inputs = vec![component(index, n, ("", values), at, observer)];
    let part = step(index, "TSH-9", &format!("{}.4096", COORDINATES[n]), v).per(4096).by("floor_number", inputs);
    let inputs = vec![observer.tell(part)];
    let register = format!("texture{index}.{}", channel_name(n));
    observer.step(report::register_step(&block(index), "TSH-9", register, value).by("factor_byte", inputs));
}

/// TSH-10: reports whether one coordinate drops the fragment.
pub(super) fn sign<O: Observer>(
    index: usize,
    n: usize,
    (values, at): ([f32; 3], &Sample<'_>),
    (drops_not_negative, negative): (bool, bool),
    observer: &mut O,
) {
    let inputs = vec![component(index, n, ("", values), at, observer)];
    let operation = if drops_not_negative { "is_not_negative" } else { "is_negative" };
    let dropped = negative != drops_not_negative;
    let note = dropped.then(|| "the fragment is dropped".to_string());
    let step = step(index, "TSH-10", &format!("{}.drops", COORDINATES[n]), dropped);
    observer.step(step.by(operation, inputs).note(note));
}

/// Reports a coordinate that is rounded to single precision, and returns it as an operand.
pub(super) fn rounded<O: Observer>(
    index: usize,
    n: usize,
    (values, at): ([f32; 3], &Sample<'_>),
    value: f32,
    ideal: f64,
    observer: &mut O,
) -> Operand {
    let inputs = vec![component(index, n, ("", values), at, observer)];
    let step = single(index, "TSH-4", &format!("{}.rounded", COORDINATES[n]), value, ideal);
    observer.tell(step.by("nearest_float", inputs))
}

/// Reports the bytes of the earlier unit's colour that a stage reads.
pub(super) fn previous<O: Observer>(index: usize, color: &Color, channels: &[usize], observer: &mut O) {
    for &n in channels {
        let register = format!("texture{}.{}", color.unit, channel_name(n));
        let value = i64::from(color.bytes[n]);
        let operation = if color.doubled[n] { "byte_of_double" } else { "byte_of_register" };
        let step = Step::plain(&block(index), "NUM-1", previous_name(index, n), value);
        observer.step(step.by(operation, vec![byte(register, color.held[n])]));
    }
}

fn previous_name(index: usize, channel: usize) -> String {
    name(index, &format!("previous.{}", channel_name(channel)))
}

/// The parts of a dot product.
pub(super) struct DotParts {
    pub(super) mapping: DotMapping,
    /// s, t and r of the vertices.
    pub(super) values: [[f32; 3]; 3],
    pub(super) coordinates: [f32; 3],
    pub(super) vector: [f32; 3],
    pub(super) products: [f32; 3],
    pub(super) dot: Dot,
}

/// TSH-1 to TSH-4: reports a dot product. `real` holds the ideal's coordinates and its remapped colour.
pub(super) fn dot<O: Observer>(
    index: usize,
    color: &Color,
    parts: &DotParts,
    real: ([f64; 3], [f64; 3]),
    at: &Sample<'_>,
    observer: &mut O,
) {
    let hilo = matches!(parts.mapping, DotMapping::Hilo1 | DotMapping::HiloHemisphere);
    previous(index, color, if hilo { &[3, 0, 1, 2] } else { &[0, 1, 2] }, observer);
    let read = |n: usize| plain(previous_name(index, n), color.bytes[n]);
    let mut factors = Vec::new();
    for n in 0..3 {
        let coordinate = rounded(index, n, (parts.values[n], at), parts.coordinates[n], real.0[n], observer);
        let halves = [vec![read(3), read(0)], vec![read(1), read(2)]];
        let (rule, operation, inputs) = match (parts.mapping, n) {
            (DotMapping::ZeroToOne, _) => ("TSH-1", "remap_zero_to_one", vec![read(n)]),
            (DotMapping::MinusOneToOneD3d, _) => ("TSH-2", "remap_d3d", vec![read(n)]),
            (DotMapping::MinusOneToOneGl, _) => ("TSH-2", "remap_gl", vec![read(n)]),
            (DotMapping::MinusOneToOne, _) => ("TSH-2", "remap_twos_complement", vec![read(n)]),
            (DotMapping::Hilo1, 2) => ("TSH-3", "float_one", Vec::new()),
            (DotMapping::Hilo1, _) => ("TSH-3", "remap_half", halves[n].clone()),
            (DotMapping::HiloHemisphere, 2) => ("TSH-3", "third_of_unit", halves.concat()),
            (DotMapping::HiloHemisphere, _) => ("TSH-3", "remap_half_signed", halves[n].clone()),
        };
        let vector = single(index, rule, &format!("vector.{}", AXES[n]), parts.vector[n], real.1[n]);
        factors.push([coordinate, observer.tell(vector.by(operation, inputs))]);
    }
    let mut inputs = Vec::new();
    for (n, factors) in factors.into_iter().enumerate() {
        let suffix = format!("product.{}", AXES[n]);
        let product = single(index, "TSH-4", &suffix, parts.products[n], product_of(real, n));
        inputs.push(observer.tell(product.by("float_product", factors.to_vec())));
    }
    observer.step(single(index, "TSH-4", "dot", parts.dot.fixed, parts.dot.real).by("float_sum", inputs));
}

#[allow(clippy::float_arithmetic, reason = "the ideal's product")]
fn product_of((a, b): ([f64; 3], [f64; 3]), n: usize) -> f64 {
    a[n] * b[n]
}

/// TSH-5: reports a reflection. The eye vector is a constant of the scene, or the q of the three stages.
pub(super) fn reflection<O: Observer>(
    index: usize,
    normal: [Dot; 3],
    (eye, constant): ([f32; 3], bool),
    fixed: &Reflection<f32>,
    real: &Reflection<f64>,
    observer: &mut O,
) {
    let step = |what: &str, value: f32, ideal: f64| single(index, "TSH-5", what, value, ideal);
    let eyes = [0, 1, 2].map(|n| match constant {
        true => observer.tell(step(&format!("eye.{}", AXES[n]), eye[n], f64::from(eye[n]))),
        false => float(name(n + 1, "q.rounded"), eye[n]),
    });
    let eyes = |n: usize| eyes[n].clone();
    let normals = |n: usize| float(name(n + 1, "dot"), normal[n].fixed);
    let toward = (0..3).flat_map(|n| [normals(n), eyes(n)]).collect();
    let toward = observer.tell(step("toward", fixed.toward, real.toward).by("float_dot", toward));
    let square = (0..3).flat_map(|n| [normals(n), normals(n)]).collect();
    let square = observer.tell(step("square", fixed.square, real.square).by("float_dot", square));
    let scale = observer.tell(step("scale", fixed.scale, real.scale).by("float_double", vec![toward]));
    for n in 0..3 {
        let inputs = vec![scale.clone(), normals(n), square.clone(), eyes(n)];
        let vector = step(&format!("reflection.{}", AXES[n]), fixed.vector[n], real.vector[n]);
        observer.step(vector.by("float_reflection", inputs));
    }
}

/// TSH-8: reports scale and offset of the luminance.
pub(super) fn luminance_state<O: Observer>(index: usize, luminance: [f32; 2], observer: &mut O) {
    for (what, value) in ["luminance.scale", "luminance.offset"].into_iter().zip(luminance) {
        observer.step(single(index, "TSH-8", what, value, f64::from(value)));
    }
}

/// TSH-8: reports one channel: the colour as sampled, the product in 4096ths and the result.
pub(super) fn luminance<L: Lane, O: Observer>(
    index: usize,
    n: usize,
    (sampled, v, value): (L, i64, L),
    red: u8,
    luminance: [f32; 2],
    observer: &mut O,
) {
    let register = format!("texture{index}.{}", channel_name(n));
    let inputs = vec![
        report::register(register.clone(), sampled),
        plain(previous_name(index, 0), red),
        float(name(index, "luminance.scale"), luminance[0]),
        float(name(index, "luminance.offset"), luminance[1]),
    ];
    let part = step(index, "TSH-8", &format!("luminance.{}", channel_name(n)), v).per(4096).by("luminance", inputs);
    let inputs = vec![observer.tell(part)];
    observer.step(report::register_step(&block(index), "TSH-8", register, value).by("luminance_byte", inputs));
}

/// Reports how the coordinates of a dependent read on a level are computed.
pub(super) fn coordinates<O: Observer>(
    place: &Dependent<'_>,
    report: &Report<'_>,
    level: &Level,
    floored: [i64; 2],
    ideal: [f64; 2],
    observer: &mut O,
) {
    let (unit, index) = (place.unit, place.unit.index);
    let sides = unit.scale(level);
    let vector = if let Target::Vector(vector) = place.target { Some((vector, vector_names(place))) } else { None };
    let direction: Vec<Operand> =
        vector.iter().flat_map(|(vector, names)| (0..3).map(|n| float(names[n].clone(), vector[n]))).collect();
    if vector.is_some() {
        let face = place.target.face();
        let step = report.step("TEX-12", "face", face as i64);
        observer.step(step.by("float_face", direction.clone()).note(Named::name(face).to_string()));
    }
    for (axis, letter) in ["u", "v"].into_iter().enumerate() {
        let size = plain("size", sides[axis]);
        let (rule, operation, inputs) = match place.target {
            Target::Moved(moved) => {
                let [along_blue, along_green] = [0, 1].map(|n| {
                    let (entry, value) = ([["m0", "m3"], ["m1", "m2"]][axis][n], moved.entries()[axis][n]);
                    observer.tell(single(index, "TSH-7", entry, value, f64::from(value)))
                });
                let [blue, green] =
                    [(2, 0), (1, 1)].map(|(channel, n)| plain(previous_name(index, channel), moved.blue_green[n]));
                let offset = moved.offsets()[axis];
                let step = float_step(
                    &report.block(),
                    "TSH-7",
                    report.name(&format!("offset_{letter}")),
                    offset,
                    f64::from(offset),
                );
                let offset = observer.tell(step.by("bump_offset", vec![along_blue, along_green, blue, green]));
                let set = moved.vertices.coordinates(unit.stage.coordinate_set);
                let number = report.component(axis, "", set.map(|vertex| vertex[axis]), moved.at, observer);
                ("TSH-7", "floor_moved", vec![number, offset, size])
            }
            Target::Bytes(bytes, scale) => {
                let channel = dependent_channels(place)[axis];
                let operation = match scale {
                    DependentScale::Over255 => "dependent_255",
                    DependentScale::Over256 => "dependent_256",
                };
                ("TSH-6", operation, vec![plain(previous_name(index, channel), bytes[axis]), size])
            }
            Target::Floats(floats) => {
                let dot = float(name(first_dot(place) + axis, "dot"), floats[axis]);
                ("TSH-4", "floor_float", vec![dot, size])
            }
            Target::Ends(dots) => {
                let dot = float(name(first_dot(place) + axis, "dot"), dots[axis]);
                ("TEX-20", ["end_of_face_u", "end_of_face_v"][axis], vec![dot, size])
            }
            Target::Vector(_) => {
                let mut inputs = direction.clone();
                inputs.push(plain(report.name("face"), place.target.face() as i64));
                inputs.push(size);
                let (rule, operations) = if unit.is_other_kind() {
                    ("TEX-20", ["floor_float_on_plane_u", "floor_float_on_plane_v"])
                } else {
                    ("TEX-12", ["floor_float_face_u", "floor_float_face_v"])
                };
                (rule, operations[axis], inputs)
            }
        };
        report.coordinate(rule, letter, floored[axis], ideal[axis], (operation, inputs), observer);
    }
}

/// Returns the stage of the first of two dot products that a unit samples at.
fn first_dot(place: &Dependent<'_>) -> usize {
    let before = if place.unit.stage.operation == crate::state::ShaderOperation::DotProduct3D { 2 } else { 1 };
    place.unit.index - before
}

/// Returns the names under which the components of the vector that a unit samples with were reported.
fn vector_names(place: &Dependent<'_>) -> [String; 3] {
    use crate::state::ShaderOperation as Op;
    let index = place.unit.index;
    match place.unit.stage.operation {
        Op::DotReflectSpecular | Op::DotReflectConstantEye { .. } => {
            AXES.map(|axis| name(index, &format!("reflection.{axis}")))
        }
        _ => [1, 2, 3].map(|index| name(index, "dot")),
    }
}

/// Returns the channels that a dependent read uses as u and v.
fn dependent_channels(place: &Dependent<'_>) -> [usize; 2] {
    match place.unit.stage.operation {
        crate::state::ShaderOperation::DependentAlphaRed => [3, 0],
        _ => [1, 2],
    }
}

/// TEX-11: reports u and v at the quad, where the same chain computes them.
pub(super) fn quad<O: Observer>(place: &Dependent<'_>, report: &Report<'_>, observer: &mut O) {
    let Some(quad) = place.quad else { return };
    for (n, uv) in quad.fixed.iter().enumerate() {
        for (axis, letter) in ["u", "v"].into_iter().enumerate() {
            report.quad_coordinate((n, letter), uv[axis], ("chain", Vec::new()), observer);
        }
    }
}
