//! Finds the point of a mesh that each pixel shows, and computes the light there.

use std::sync::Arc;

use super::{Equation, Field, NormalSource, Space, Truth, VectorAttribute, lighting};
use crate::mesh::Mesh;
use crate::vector::{Vector, dot, unit_or_zero, wide};
use ninebit::engine::walk::{self, Band};
use ninebit::engine::{RenderOptions, TextureWords, cleared, render};
use ninebit::plan::Plan;
use ninebit::raster::ideal::Outline;
use ninebit::state::{TriangleVertices, Vertex, VertexColor};
use ninebit::trace::Silent;

/// Length below which a given normal counts as the zero vector. Bytes of 128 stand for that vector, but decode to half a step beside it.
const MIN_NORMAL_LENGTH: f64 = 1.0 / 64.0;

/// The truth of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// R, G and B, 0 to 1.
    pub color: [f64; 3],
    /// Unit normal in object space that the light was computed with.
    pub normal: [f64; 3],
    /// Unit tangent, binormal and normal of the mesh, in object space.
    pub(crate) basis: [[f64; 3]; 3],
}

impl Pixel {
    /// Converts a vector from the given space of this pixel into object space.
    pub fn object(&self, vector: [f64; 3], space: Space) -> [f64; 3] {
        match space {
            Space::Object => vector,
            Space::Tangent => from_tangent(&self.basis, vector),
        }
    }
}

/// The truth of a target.
#[derive(Clone, Debug, PartialEq)]
pub struct TruthFrame {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Pixels row by row from the top. `None` where no draw with a truth is seen, or where clipping has cut a triangle.
    pub pixels: Vec<Option<Pixel>>,
}

/// Computes the truth of a target. Each pixel shows the last draw with a truth that stored a fragment there.
pub fn evaluate(plan: &Plan, truth: &Truth, target: usize) -> TruthFrame {
    let visible = Visible::new(plan, truth, target);
    let (width, height) = visible.size();
    TruthFrame { width, height, pixels: (0..height).flat_map(|row| visible.row(row, |_| None)).collect() }
}

/// The triangle that each pixel of a target shows, of which the truth can be computed several times.
#[derive(Clone, Debug)]
pub struct Visible<'a> {
    plan: &'a Plan,
    truth: &'a Truth,
    target: usize,
    /// Index of the draw and of its triangle, row by row.
    shown: Vec<Option<(usize, usize)>>,
}

impl<'a> Visible<'a> {
    /// Finds the triangle of each pixel, which belongs to the last draw with a truth that stored a fragment there.
    pub fn new(plan: &'a Plan, truth: &'a Truth, target: usize) -> Self {
        // The words of other targets matter only where alpha, and so a test, depends on them.
        let reads = plan.draws().iter().any(|planned| planned.target == target && plan.reads_target(planned));
        let others = reads.then(|| render(plan, &RenderOptions::default()));
        let texture_words =
            TextureWords::new(plan, plan.draws(), others.as_ref().map_or(&[], |frames| &frames.surfaces));
        let images = texture_words.images();
        let mut surface = cleared(plan).surfaces.swap_remove(target);
        let width = surface.width as usize;
        let mut shown = vec![None; surface.words.len()];
        let mut band = Band { first_row: 0, width, words: &mut surface.words, depth: &mut surface.depth };
        for (number, planned) in plan.draws().iter().enumerate().filter(|(_, planned)| planned.target == target) {
            let described = truth.meshes.get(number).is_some_and(Option::is_some);
            let stores_all = planned.stores_all();
            walk::covered(plan, planned, band.rows(), |context, i, j| {
                let stored = stores_all || walk::pixel(context, &images, &mut band, i, j, &mut Silent);
                if stored && described {
                    shown[j as usize * width + i as usize] = Some((number, context.number));
                }
            });
        }
        Visible { plan, truth, target, shown }
    }

    /// Returns width and height of the target in pixels.
    pub fn size(&self) -> (u32, u32) {
        let target = &self.plan.targets()[self.target];
        (target.width, target.height)
    }

    /// Computes the truth of the pixels of a row. For a pixel's index in the target, `given` may return a normal of any length with its space, in place of
    /// the truth's own.
    pub fn row(&self, row: u32, given: impl Fn(usize) -> Option<(Vector, Space)>) -> Vec<Option<Pixel>> {
        let width = self.size().0 as usize;
        // Neighbours mostly belong to one triangle.
        let mut last: Option<((usize, usize), Option<Corners<'_>>)> = None;
        let pixels = (0..width).map(|column| {
            let at = row as usize * width + column;
            let shown = self.shown[at]?;
            if last.as_ref().is_none_or(|(triangle, _)| *triangle != shown) {
                last = Some((shown, self.corners(shown)));
            }
            let corners = last.as_ref()?.1.as_ref()?;
            Some(shade(self.truth, &corners.point((column as u32, row)), given(at)))
        });
        pixels.collect()
    }

    /// Returns a triangle of a mesh; `None` if clipping has made a corner of it, or if it has no area.
    fn corners(&self, (draw, triangle): (usize, usize)) -> Option<Corners<'_>> {
        let mesh = self.truth.meshes.get(draw)?.as_ref()?;
        let planned = &self.plan.draws()[draw];
        let triangles = &planned.assembly.triangles;
        if triangle >= triangles.len() {
            return None;
        }
        let corners = triangles.vertices(triangle).map(|v| v as usize);
        if corners.iter().any(|corner| *corner >= mesh.positions.len()) {
            return None;
        }
        let vertices = planned.assembly.triangle(triangle);
        let outline = Outline::new(vertices.positions(), planned.perspective)?;
        Some(Corners { mesh, corners, vertices, outline })
    }
}

/// A point of a mesh.
struct Point<'a> {
    position: Vector,
    /// Unit tangent, binormal and normal.
    basis: [Vector; 3],
    coordinates: [f64; 2],
    planned: TriangleVertices<'a>,
    weights: [f64; 3],
}

/// A triangle of a mesh.
struct Corners<'a> {
    mesh: &'a Mesh,
    corners: [usize; 3],
    vertices: TriangleVertices<'a>,
    outline: Outline,
}

impl<'a> Corners<'a> {
    /// Finds the point at the centre of a pixel.
    fn point(&self, (column, row): (u32, u32)) -> Point<'a> {
        let (mesh, corners) = (self.mesh, self.corners);
        let weights = self.outline.weights(i64::from(column), i64::from(row));
        let mix = |values: &[[f32; 3]]| mixed(weights, corners.map(|corner| wide(values[corner])));
        let texture = corners.map(|corner| mesh.texture_coordinates[corner].map(f64::from));
        let coordinates = [0, 1].map(|n| (0..3).map(|k| weights[k] * texture[k][n]).sum());
        Point {
            position: mix(&mesh.positions),
            basis: [mix(&mesh.tangents), mix(&mesh.binormals), mix(&mesh.normals)].map(unit_or_zero),
            coordinates,
            planned: self.vertices,
            weights,
        }
    }
}

fn mixed(weights: [f64; 3], values: [Vector; 3]) -> Vector {
    [0, 1, 2].map(|n| (0..3).map(|k| weights[k] * values[k][n]).sum())
}

fn from_tangent(basis: &[Vector; 3], v: Vector) -> Vector {
    [0, 1, 2].map(|n| basis[0][n] * v[0] + basis[1][n] * v[1] + basis[2][n] * v[2])
}

/// Returns R, G and B of a colour; 1 is full.
pub(crate) fn real_color(color: &VertexColor) -> [f64; 3] {
    let [r, g, b, _] = match color {
        VertexColor::Bytes(bytes) => bytes.map(|byte| f64::from(byte) / 255.0),
        VertexColor::Floats(floats) => floats.map(f64::from),
    };
    [r, g, b]
}

/// Interpolates a vector of the vertices.
fn interpolated(point: &Point<'_>, what: VectorAttribute) -> Vector {
    let signed = |color: &VertexColor| real_color(color).map(|c| 2.0 * c - 1.0);
    let set = |vertex: &Vertex, n: usize| {
        let [s, t, r, _] = vertex.texture_coordinates[n].map(f64::from);
        [s, t, r]
    };
    let values = point.planned.all().map(|vertex| match what {
        VectorAttribute::PrimaryColor => signed(&vertex.diffuse),
        VectorAttribute::SecondaryColor => signed(&vertex.specular),
        VectorAttribute::T0 => set(&vertex, 0),
        VectorAttribute::T1 => set(&vertex, 1),
        VectorAttribute::T2 => set(&vertex, 2),
        VectorAttribute::T3 => set(&vertex, 3),
    });
    mixed(point.weights, values)
}

/// Returns the unit normal of the surface in object space.
fn normal(truth: &Truth, point: &Point<'_>) -> Vector {
    let mapped = |vector: Vector| from_tangent(&point.basis, vector);
    unit_or_zero(match &truth.normal {
        NormalSource::Mesh => point.basis[2],
        NormalSource::Radial { center } => crate::vector::minus(point.position, *center),
        NormalSource::Hemisphere { zero_outside } => {
            mapped(crate::generate::hemisphere::normal_at(point.coordinates, *zero_outside))
        }
        NormalSource::Map(field) => mapped(field.at(point.coordinates)),
    })
}

fn shade(truth: &Truth, point: &Point<'_>, given: Option<(Vector, Space)>) -> Pixel {
    let mut pixel = Pixel { color: [0.0; 3], normal: [0.0; 3], basis: point.basis };
    pixel.normal = match given {
        Some((vector, _)) if dot(vector, vector) < MIN_NORMAL_LENGTH * MIN_NORMAL_LENGTH => [0.0; 3],
        Some((vector, space)) => unit_or_zero(pixel.object(vector, space)),
        None => normal(truth, point),
    };
    let [s, t] = point.coordinates;
    pixel.color = match truth.equation {
        Equation::Lighting => light(truth, point, pixel.normal),
        Equation::SignedProduct => [(2.0 * s - 1.0) * (2.0 * t - 1.0); 3],
        Equation::Difference => [s - t; 3],
        Equation::DotProduct(a, b) => [dot(interpolated(point, a), interpolated(point, b)); 3],
    }
    .map(|c| c.clamp(0.0, 1.0));
    pixel
}

fn light(truth: &Truth, point: &Point<'_>, normal: Vector) -> [f64; 3] {
    let mut sum = truth.material.ambient;
    let mut add = |term: [f64; 3]| sum.iter_mut().zip(term).for_each(|(sum, term)| *sum += term);
    for light in &truth.lights {
        add(lighting::light(light, truth.eye.as_ref(), &truth.material, point.position, normal));
    }
    if let Some(hemisphere) = &truth.hemisphere {
        let reached = truth.occlusion.as_ref().map_or(1.0, |field: &Arc<Field<1>>| field.at(point.coordinates)[0]);
        add(hemisphere.at(normal).map(|c| c * reached));
    }
    let map = truth.color_map.as_ref().map_or([1.0; 3], |field| field.at(point.coordinates));
    [0, 1, 2].map(|n| sum[n] * map[n])
}
