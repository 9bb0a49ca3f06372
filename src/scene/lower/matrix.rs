//! Lowers matrices: four rows, or built from a few parameters. Vectors are columns: a position p becomes M p.
#![allow(clippy::float_arithmetic, reason = "vertices are 32-bit floats; + - * / and roots in a fixed order")]

use super::*;
use crate::mesh::half_tangent;
use ninebit::vertex::Rows;

pub(super) const IDENTITY: Rows =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// Deepest nesting of products: each level reads its text again.
const MAX_PRODUCT_DEPTH: usize = 16;

const KINDS: &[&str] = &[
    "Identity",
    "Rows",
    "Product",
    "Transpose",
    "Translate",
    "Scale",
    "Rotate",
    "Frustum",
    "Orthographic",
    "Perspective",
    "LookAt",
];

/// Reads a matrix that is not a name. A matrix that is not finite is an error.
pub(super) fn literal<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Matrix>) -> Option<Rows> {
    if reader.depth > MAX_PRODUCT_DEPTH {
        let place = reader.opening(raw.text);
        let message = format!("more than {MAX_PRODUCT_DEPTH} products inside each other");
        let help = "a product takes any number of matrices: write them side by side";
        return reader.refuse(finding("NB0602", place, message, "one level too many", help));
    }
    let (kind, rest) = reader.variant(raw, "matrix", KINDS)?;
    let matrix = match KINDS[kind] {
        "Identity" => IDENTITY,
        "Rows" => rows(reader, &Raw::new(rest))?,
        "Product" => product(reader, &Raw::new(rest))?,
        "Transpose" => transpose(reader, &Raw::new(rest))?,
        "Translate" => {
            let [x, y, z, _] = vector(reader, rest, "a translation", 3)?;
            [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]]
        }
        "Scale" => {
            let [x, y, z, _] = vector(reader, rest, "a scale", 3)?;
            [[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0], [0.0, 0.0, 0.0, 1.0]]
        }
        "Rotate" => rotation(vector(reader, rest, "a rotation (a unit quaternion x, y, z, w)", 4)?),
        "Perspective" => perspective(reader, &Raw::new(rest))?,
        "LookAt" => look_at(reader, &Raw::new(rest))?,
        kind => projection(reader, &Raw::new(rest), kind == "Frustum")?,
    };
    if matrix.iter().flatten().all(|value| value.is_finite()) {
        return Some(matrix);
    }
    let place = reader.span(raw);
    let label = "a division by zero, or numbers too large";
    let help = "near and far, left and right, bottom and top, eye and center must differ; a rotation must not be zero";
    reader.refuse(finding("NB0207", place, "this matrix is not finite", label, help))
}

fn vector<'a>(reader: &mut Reader<'a>, text: &'a str, what: &str, count: usize) -> Option<[f32; 4]> {
    reader.numbers(&Raw::<Numbers>::new(text), what, count..=count, [0.0; 4])
}

/// Reads four rows of four numbers.
fn rows<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, Tuple<'a, Numbers>>) -> Option<Rows> {
    let parts = reader.read(raw)?.0;
    if parts.len() != 4 {
        let message = format!("a matrix has four rows, not {}", parts.len());
        let label = format!("{} here", parts.len());
        return reader.refuse(Diagnostic::error("NB0211", reader.span(raw), message).label(label));
    }
    let mut rows = IDENTITY;
    for (row, part) in rows.iter_mut().zip(&parts) {
        *row = reader.numbers(part, "a row of a matrix", 4..=4, [0.0; 4])?;
    }
    Some(rows)
}

/// Reads a product. It is multiplied from left to right, so the last matrix acts on a position first.
fn product<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, Tuple<'a, source::Matrix>>) -> Option<Rows> {
    let mut result = IDENTITY;
    for (index, part) in reader.read(raw)?.0.iter().enumerate() {
        let factor = reader.deeper(|reader| reader.value(part))?;
        result = if index == 0 { factor } else { multiply(&result, &factor) };
    }
    Some(result)
}

fn transpose<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, Tuple<'a, source::Matrix>>) -> Option<Rows> {
    let [part] = reader.read(raw)?.0[..] else {
        let help = "write `Transpose(\"world\")`";
        return reader.refuse(finding("NB0211", reader.span(raw), "one matrix is transposed at a time", "here", help));
    };
    let matrix = reader.deeper(|reader| reader.value(&part))?;
    Some(std::array::from_fn(|row| std::array::from_fn(|column| matrix[column][row])))
}

/// Returns the product a b.
fn multiply(a: &Rows, b: &Rows) -> Rows {
    let mut result = [[0.0; 4]; 4];
    for (row, left) in result.iter_mut().zip(a) {
        for (column, value) in row.iter_mut().enumerate() {
            *value = left[0] * b[0][column] + left[1] * b[1][column] + left[2] * b[2][column] + left[3] * b[3][column];
        }
    }
    result
}

/// Returns the rotation of a quaternion of any length but zero.
fn rotation([x, y, z, w]: [f32; 4]) -> Rows {
    let s = 2.0 / (x * x + y * y + z * z + w * w);
    [
        [1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w), 0.0],
        [s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w), 0.0],
        [s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y), 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ]
}

/// Reads OpenGL's frustum or orthographic box: the viewer looks along -z, and depth is -1 at `near` and 1 at `far`.
fn projection<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Frustum<'a>>, perspective: bool) -> Option<Rows> {
    let box_ = reader.read(raw)?;
    let (l, r) = (box_.left(reader), box_.right(reader));
    let (b, t) = (box_.bottom(reader), box_.top(reader));
    let (n, f) = (box_.near(reader), box_.far(reader));
    if perspective {
        let ends = [above_0(reader, "near", &box_.near), above_0(reader, "far", &box_.far)];
        ends.into_iter().collect::<Option<()>>()?;
    }
    let (l, r, b, t, n, f) = (l?, r?, b?, t?, n?, f?);
    let (width, height, depth) = (r - l, t - b, f - n);
    Some(if perspective {
        [
            [2.0 * n / width, 0.0, (r + l) / width, 0.0],
            [0.0, 2.0 * n / height, (t + b) / height, 0.0],
            [0.0, 0.0, -(f + n) / depth, -2.0 * f * n / depth],
            [0.0, 0.0, -1.0, 0.0],
        ]
    } else {
        [
            [2.0 / width, 0.0, 0.0, -(r + l) / width],
            [0.0, 2.0 / height, 0.0, -(t + b) / height],
            [0.0, 0.0, -2.0 / depth, -(f + n) / depth],
            [0.0, 0.0, 0.0, 1.0],
        ]
    })
}

/// Reads OpenGL's perspective of a field of view, which is a frustum with equal halves.
fn perspective<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Perspective<'a>>) -> Option<Rows> {
    let view = reader.read(raw)?;
    let (fov, aspect, n, f) = (view.fov(reader), view.aspect(reader), view.near(reader), view.far(reader));
    let fields = [("fov", &view.fov), ("aspect", &view.aspect), ("near", &view.near), ("far", &view.far)];
    let positive = fields.map(|(name, field)| above_0(reader, name, field));
    let (fov, aspect, n, f) = (fov?, aspect?, n?, f?);
    if let Some(raw) = view.fov.filter(|_| fov >= 180.0) {
        let help = "write degrees, above 0 and below 180";
        reader.push(finding("NB0206", reader.span(&raw), format!("`fov` is {fov}"), "out of range", help));
        return None;
    }
    positive.into_iter().collect::<Option<()>>()?;
    let near = (1.0 / half_tangent(fov.into())) as f32;
    let depth = f - n;
    Some([
        [near / aspect, 0.0, 0.0, 0.0],
        [0.0, near, 0.0, 0.0],
        [0.0, 0.0, -(f + n) / depth, -2.0 * f * n / depth],
        [0.0, 0.0, -1.0, 0.0],
    ])
}

/// Refuses a number that is not above 0. One that cannot be read has been refused already.
fn above_0<'a>(reader: &mut Reader<'a>, name: &str, field: &Option<Raw<'a, f32>>) -> Option<()> {
    let raw = field.as_ref()?;
    match reader.attempt::<f32>(raw.text) {
        Some(value) if value <= 0.0 => {
            let message = format!("`{name}` of a perspective is {value}");
            let help = match name {
                "near" | "far" => "write a number above 0: the distance from the viewer along the line of sight",
                _ => "write a number above 0",
            };
            reader.refuse(finding("NB0206", reader.span(raw), message, "not above 0", help))
        }
        _ => Some(()),
    }
}

/// Returns whether x, y and w behind the matrix depend on one another, whatever the position: all triangles are then without area.
pub(super) fn flattens(matrix: &Rows) -> bool {
    let [x, y, w] = [0, 1, 3].map(|row| matrix[row].map(f64::from));
    (0..4).all(|left_out| {
        let kept: Vec<usize> = (0..4).filter(|column| *column != left_out).collect();
        let [a, b, c] = [kept[0], kept[1], kept[2]];
        let plus = [x[a] * y[b] * w[c], x[b] * y[c] * w[a], x[c] * y[a] * w[b]];
        let minus = [x[c] * y[b] * w[a], x[a] * y[c] * w[b], x[b] * y[a] * w[c]];
        let (minor, size) = plus
            .iter()
            .zip(&minus)
            .fold((0.0, 0.0), |(minor, size), (plus, minus)| (minor + plus - minus, size + plus.abs() + minus.abs()));
        // What the sum and the products of 48 bits lose.
        minor.abs() <= 4.0 * f64::EPSILON * size
    })
}

/// Reads the matrix from world space to a viewer at `eye` who looks at `center`.
fn look_at<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::LookAt<'a>>) -> Option<Rows> {
    let view = reader.read(raw)?;
    let (eye, center, up) = (view.eye(reader), view.center(reader), view.up(reader));
    let (eye, center, up) = (point(eye?), point(center?), point(up));
    let forward = normalize(subtract(center, eye));
    let side = normalize(cross(forward, up));
    let up = cross(side, forward);
    Some([
        [side[0], side[1], side[2], -dot(side, eye)],
        [up[0], up[1], up[2], -dot(up, eye)],
        [-forward[0], -forward[1], -forward[2], dot(forward, eye)],
        [0.0, 0.0, 0.0, 1.0],
    ])
}

fn point([x, y, z, _]: [f32; 4]) -> [f32; 3] {
    [x, y, z]
}

pub(super) fn subtract(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the vector of unit length in the same direction; NaN for the zero vector.
pub(super) fn normalize(v: [f32; 3]) -> [f32; 3] {
    let length = dot(v, v).sqrt();
    v.map(|component| component / length)
}
