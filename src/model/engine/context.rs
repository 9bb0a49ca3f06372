//! The set-up of one triangle of a draw. It goes in steps, because the fast engine takes only some of them for most triangles.

use crate::plan::{Plan, PlannedDraw};
use crate::raster::assemble::Corner;
use crate::raster::depth::DepthPlane;
use crate::raster::fog::FogPlane;
use crate::raster::setup::{Triangle, area_seen, clockwise_area, is_front};
use crate::raster::stroke::{self, Figure};
use crate::state::*;
use crate::texture::coordinates::Coordinates;
use crate::texture::stage::ShaderSetup;

/// A triangle of a draw, set up.
#[derive(Debug)]
pub struct TriangleContext<'a> {
    pub(super) plan: &'a Plan,
    /// The draw of the triangle.
    pub draw: &'a PlannedDraw,
    /// Number of the triangle in the draw.
    pub number: usize,
    /// The set-up of the triangle.
    pub triangle: Triangle,
    pub(super) primary: [[u8; 4]; 3],
    pub(super) secondary: [[u8; 4]; 3],
    pub(super) coordinates: [Option<Coordinates>; 4],
    /// Set-up of the texture shader, if there is one. Units have none of their own then.
    pub(super) shader: Option<Box<ShaderSetup>>,
    /// Fog of the vertices; `None` if fog is off or the fog register's alpha is not read.
    pub fog: Option<FogPlane>,
    /// Depths of the vertices, if there is a depth test.
    pub depth: DepthPlane,
}

/// Returns the corners of a triangle of a draw.
#[inline(always)]
fn corners(draw: &PlannedDraw, number: usize) -> [&Corner; 3] {
    let ([first, second, third], all) = (draw.assembly.triangles.vertices(number), &draw.assembly.corners);
    [&all[first as usize], &all[second as usize], &all[third as usize]]
}

/// Returns x and y of corners.
#[inline(always)]
fn positions([a, b, c]: &[&Corner; 3]) -> ([i64; 3], [i64; 3]) {
    let [[ax, ay], [bx, by], [cx, cy]] = [a.position, b.position, c.position];
    ([ax.into(), bx.into(), cx.into()], [ay.into(), by.into(), cy.into()])
}

impl<'a> TriangleContext<'a> {
    /// Sets up triangle `number`. Returns `None` if it is culled, empty, or outside `rows`.
    pub fn new(plan: &'a Plan, draw: &'a PlannedDraw, number: usize, rows: (i64, i64)) -> Option<Self> {
        let mut context = TriangleContext::vacant(plan, draw);
        if !context.set_up(number, rows) {
            return None;
        }
        context.complete();
        Some(context)
    }

    /// Returns a context in which one triangle of a draw after the other can be [set up](Self::set_up).
    pub(super) fn vacant(plan: &'a Plan, draw: &'a PlannedDraw) -> Self {
        TriangleContext {
            plan,
            draw,
            number: 0,
            triangle: Triangle::default(),
            primary: [[0; 4]; 3],
            secondary: [[0; 4]; 3],
            coordinates: [None; 4],
            shader: None,
            fog: None,
            depth: DepthPlane::default(),
        }
    }

    /// Sets up edge functions and depths of triangle `number`. Returns `false` if it is culled, empty, or outside `rows`; then the context is not
    /// valid. [`complete`](Self::complete) sets up the rest.
    #[inline(always)]
    pub(super) fn set_up(&mut self, number: usize, rows: (i64, i64)) -> bool {
        Self::may_cover(self.draw, number, rows) && self.place(number)
    }

    /// Returns whether triangle `number` of a draw may cover pixels in `rows`: it is not culled, it has an area, and its bounding box holds centres
    /// of pixels.
    #[inline(always)]
    pub(super) fn may_cover(draw: &PlannedDraw, number: usize, rows: (i64, i64)) -> bool {
        let [(left, right), (top, bottom)] = [0, 1].map(|axis| draw.assembly.bounds(number, axis));
        let (figure, area) = (draw.assembly.triangles.figure(number), Self::clockwise_area(draw, number));
        let is_drawn = figure != Figure::Triangle || (area != 0 && !Self::is_culled(draw, area));
        (bottom > rows.0.max(top)) & (top < rows.1) & (left < right) & is_drawn
    }

    /// Returns the doubled area of triangle `number` of a draw, which is positive if it turns clockwise for the viewer.
    pub(super) fn clockwise_area(draw: &PlannedDraw, number: usize) -> i64 {
        let corners = corners(draw, number);
        let (x, y) = positions(&corners);
        let area = clockwise_area(x, y);
        if draw.assembly.is_far { area_seen(area, corners.map(|corner| corner.w)) } else { area }
    }

    /// Returns whether a triangle of that [area](Self::clockwise_area) is culled.
    #[inline(always)]
    pub(super) fn is_culled(draw: &PlannedDraw, clockwise_area: i64) -> bool {
        let front = is_front(clockwise_area, draw.front_face);
        match draw.cull {
            Cull::None => false,
            Cull::Front => front,
            Cull::Back => !front,
        }
    }

    /// Sets up edge functions, depths and colours of triangle `number`, which [may cover](Self::may_cover) pixels. Returns `false` if its depths drop it.
    #[inline(always)]
    pub(super) fn place(&mut self, number: usize) -> bool {
        let draw = self.draw;
        self.number = number;
        let colored = match draw.shade_model {
            ShadeModel::Smooth => corners(draw, number),
            ShadeModel::Flat => [&draw.assembly.corners[draw.assembly.triangles.provoking(number) as usize]; 3],
        };
        self.primary = colored.map(|c| c.primary);
        self.secondary = colored.map(|c| c.secondary);
        let (x, y) = positions(&self.corners());
        match draw.assembly.triangles.figure(number) {
            Figure::Triangle => {
                self.triangle.place_corners(x, y);
                if draw.assembly.smooth_polygons {
                    self.triangle = self.triangle.smooth();
                }
                if draw.assembly.is_far {
                    self.triangle.turn_behind(self.corners().map(|corner| corner.w));
                }
            }
            Figure::Line => self.triangle.place_line([[x[1], y[1]], [x[2], y[2]]], draw.assembly.lines),
            Figure::Point => {
                let size = draw.assembly.size_of(number);
                self.triangle.place_point([x[1], y[1]], size, draw.assembly.point_rasterization);
            }
        }
        if let Some(test) = &draw.depth_test {
            let (z, w) = (self.vertices().position(2), test.w_buffer.then(|| self.vertices().position(3)));
            match DepthPlane::new(test, draw.depth_format, &self.triangle, (z, w)) {
                Some(plane) => self.depth = plane,
                None => return false,
            }
        }
        true
    }

    /// Returns the corners of the triangle.
    #[inline(always)]
    pub(super) fn corners(&self) -> [&'a Corner; 3] {
        corners(self.draw, self.number)
    }

    /// Sets up weights, texture coordinates and fog of a triangle that is [set up](Self::set_up) otherwise.
    pub(super) fn complete(&mut self) {
        let draw = self.draw;
        self.triangle.weigh(self.corners().map(|c| c.w), draw.perspective, self.plan.profile);
        if let Some(shader) = &draw.shader {
            self.shader = Some(Box::new(ShaderSetup::new(shader, &draw.units, self.vertices())));
        } else {
            for unit in &draw.units {
                let sets = self.coordinate_set(unit.stage.coordinate_set);
                self.coordinates[unit.index] = Some(Coordinates::new(sets, unit));
            }
        }
        if draw.point_sprite && self.triangle.figure == Figure::Point {
            self.place_sprite();
        }
        if draw.fog.enabled && draw.fog_channels & 8 != 0 {
            self.fog = Some(FogPlane::new(draw.fog.function, self.vertices().fog()));
        }
    }

    /// PNT-2: gives the sprite's unit the coordinates of the point.
    #[cold]
    fn place_sprite(&mut self) {
        let corner = self.corners()[1];
        let sprite =
            Coordinates::Sprite { at: corner.position.map(i64::from), size: self.draw.assembly.size_of(self.number) };
        match &mut self.shader {
            Some(shader) => shader.replace_coordinates(SPRITE_UNIT, sprite),
            None => self.coordinates[SPRITE_UNIT] = Some(sprite),
        }
    }

    /// Returns x and y of the corners in 1/16 pixel.
    pub fn positions(&self) -> [[i32; 2]; 3] {
        self.corners().map(|corner| corner.position)
    }

    /// Returns the primary and the secondary colour of the corners.
    pub fn colors(&self) -> [[[u8; 4]; 3]; 2] {
        [self.primary, self.secondary]
    }

    /// STP-1, SMO-1: returns whether the pattern of filled triangles leaves out a pixel of a [span](Triangle::span), or whether smooth edges have no sample
    /// there.
    #[inline]
    pub fn is_left_out(&self, i: i64, j: i64) -> bool {
        let stipple = self.draw.polygon_stipple.as_ref().filter(|_| self.triangle.figure == Figure::Triangle);
        stipple.is_some_and(|stipple| !stroke::stipples(stipple, i, j))
            || (self.triangle.is_smooth && self.triangle.covered_samples(i, j) == 0)
    }

    /// Returns the triangle's vertices.
    #[inline(always)]
    pub fn vertices(&self) -> TriangleVertices<'a> {
        self.draw.assembly.triangle(self.number)
    }

    /// Returns s, t, r and q of its vertices.
    #[inline(always)]
    pub(super) fn coordinate_set(&self, set: usize) -> [[f32; 4]; 3] {
        self.vertices().coordinates(set)
    }

    /// Returns a colour of vertex `corner` as it was given: its own, or the provoking vertex's.
    pub(super) fn source(&self, register: Register, corner: usize) -> VertexColor {
        let assembly = &self.draw.assembly;
        let vertex = match self.draw.shade_model {
            ShadeModel::Smooth => assembly.triangles.vertices(self.number)[corner],
            ShadeModel::Flat => assembly.triangles.provoking(self.number),
        };
        if register == Register::PrimaryColor {
            assembly.vertices.diffuse(vertex as usize)
        } else {
            assembly.vertices.specular(vertex as usize)
        }
    }

    /// Returns the coordinates of a unit before any stage moves them, or `None` if it has none of its own.
    #[inline]
    pub(super) fn coordinates_of(&self, unit: usize) -> Option<&Coordinates> {
        match &self.shader {
            None => self.coordinates[unit].as_ref(),
            Some(shader) => shader.coordinates(unit),
        }
    }
}
