//! Renders scenes and composes pictures.

use crate::repository::at;
use ninebit::engine::{RenderOptions, render, walk};
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::raster::interpolate::Sample;
use ninebit::raster::setup::Triangle;
use ninebit::state::{Scene, TriangleVertices};
use ninebit::texture::coordinates::{Coordinates, SampleCoordinates, VertexCoordinates};
use ninebit::texture::lod;
use ninebit::texture::planned::PlannedUnit;
use ninebit_lab::chart::tiles::Tile;
use ninebit_scene as scene;

/// Folder of the scenes.
pub const FOLDER: &str = "vectors/scenes/stability";

/// A picture of R, G, B, row by row.
#[derive(Clone, PartialEq)]
pub struct Picture {
    pub width: usize,
    pub height: usize,
    pub pixels: Vec<[u8; 3]>,
}

impl Picture {
    pub fn filled(width: usize, height: usize, color: [u8; 3]) -> Picture {
        Picture { width, height, pixels: vec![color; width * height] }
    }

    pub fn from(width: usize, height: usize, color: impl Fn(usize, usize) -> [u8; 3]) -> Picture {
        let pixels = (0..width * height).map(|n| color(n % width, n / width)).collect();
        Picture { width, height, pixels }
    }

    pub fn at(&self, x: usize, y: usize) -> [u8; 3] {
        self.pixels[y * self.width + x]
    }

    /// Returns a part of the picture.
    pub fn part(&self, x: usize, y: usize, width: usize, height: usize) -> Picture {
        Picture::from(width, height, |i, j| self.at(x + i, y + j))
    }

    /// Returns the picture with each pixel as a square of pixels.
    pub fn enlarged(&self, times: usize) -> Picture {
        Picture::from(self.width * times, self.height * times, |x, y| self.at(x / times, y / times))
    }

    /// Returns the picture with a caption.
    pub fn tile(self, caption: impl Into<String>) -> Tile {
        Tile { caption: caption.into(), width: self.width, pixels: self.pixels }
    }
}

pub fn scene(name: &str) -> Scene {
    super::content::bless();
    let loaded = scene::load(&at(FOLDER).join(name), &Limits::default());
    loaded.unwrap_or_else(|error| panic!("{}", error.render(false))).scene
}

pub fn plan(scene: &Scene) -> Plan {
    Plan::compile(scene, &PlanOptions::default()).unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// Renders the first target of a plan.
pub fn draw(plan: &Plan) -> Picture {
    let frames = render(plan, &RenderOptions::default());
    let surface = &frames.surfaces[0];
    let pixels = surface.rgba8().into_iter().map(|[r, g, b, _]| [r, g, b]).collect();
    Picture { width: surface.width as usize, height: surface.height as usize, pixels }
}

/// Returns the root of the mean square of the differences in the red channel.
pub fn rms(a: &Picture, b: &Picture) -> f64 {
    let squares = a.pixels.iter().zip(&b.pixels).map(|(a, b)| f64::from(a[0].abs_diff(b[0])).powi(2));
    (squares.sum::<f64>() / a.pixels.len() as f64).sqrt()
}

/// A pixel that a triangle covers.
pub struct Covered<'a> {
    pub draw: usize,
    pub triangle: &'a Triangle,
    pub vertices: TriangleVertices<'a>,
    pub unit: &'a PlannedUnit,
    pub pixel: (i64, i64),
}

impl Covered<'_> {
    pub fn sample(&self) -> Sample<'_> {
        Sample::new(self.triangle, self.triangle.edges(self.pixel.0, self.pixel.1))
    }

    /// Returns the texture coordinates s, t, r, q of the vertices.
    pub fn coordinates(&self) -> [[f32; 4]; 3] {
        self.vertices.coordinates(self.unit.stage.coordinate_set)
    }

    pub fn w(&self) -> [f32; 3] {
        self.vertices.position(3)
    }

    /// TEX-10, TEX-11: returns 256 times the lod of the model, before bias and limits.
    pub fn lod(&self) -> i32 {
        let coordinates = Coordinates::new(self.coordinates(), self.unit);
        let at = self.sample();
        let place = VertexCoordinates {
            unit: self.unit,
            coordinates: &coordinates,
            at: &at,
            pixel: self.pixel,
            vertices: self.vertices,
            perspective: true,
        };
        lod::log2_ratio(place.quad())
    }

    /// Returns 256 times the lod in real numbers, from the derivatives at this pixel.
    pub fn exact_lod(&self) -> f64 {
        let (vertices, w, t) = (self.coordinates(), self.w(), self.triangle);
        let e = t.edges(self.pixel.0, self.pixel.1);
        let sides = self.unit.scale(&self.unit.levels[0]);
        // u = S / W, where S and W are linear on the screen, so its derivative is (S' - u W') / W.
        let linear = |values: [f64; 3], e: [i64; 3]| -> f64 { (0..3).map(|k| values[k] * e[k] as f64).sum() };
        let inverse = w.map(|w| 1.0 / f64::from(w));
        let at = linear(inverse, e);
        let squared = |slope: [i64; 3]| -> f64 {
            (0..2)
                .map(|n| {
                    let values: [f64; 3] = std::array::from_fn(|k| f64::from(vertices[k][n]) * inverse[k]);
                    let u = linear(values, e) / at;
                    (f64::from(sides[n]) * (linear(values, slope) - u * linear(inverse, slope)) / at).powi(2)
                })
                .sum()
        };
        let slopes = |i, j| std::array::from_fn(|k| t.edges(i, j)[k] - t.edges(0, 0)[k]);
        128.0 * squared(slopes(1, 0)).max(squared(slopes(0, 1))).log2()
    }
}

/// Visits every pixel that the triangles of a plan cover, in order. Each draw uses unit 0.
pub fn visit(plan: &Plan, mut visit: impl FnMut(&Covered<'_>)) {
    for (draw, planned) in plan.draws().iter().enumerate() {
        let whole = (0, i64::from(plan.targets()[planned.target].height));
        // No clip rectangle splits these scenes, so there is at most one window.
        let Some((rows, columns)) = walk::windows(planned, whole).next() else { continue };
        for number in 0..planned.assembly.triangles.len() {
            let vertices = planned.assembly.triangle(number);
            let Some(triangle) = Triangle::new(vertices.positions(), true, plan.profile) else { continue };
            for j in triangle.rows.0.max(rows.0)..triangle.rows.1.min(rows.1) {
                let (low, high) = triangle.span(j, columns);
                for i in low..high {
                    let unit = &planned.units[0];
                    visit(&Covered { draw, triangle: &triangle, vertices, unit, pixel: (i, j) });
                }
            }
        }
    }
}
