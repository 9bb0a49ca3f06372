//! Vertices, sent one by one.
#![allow(clippy::float_arithmetic, reason = "sizes of points in pixels")]

use ninebit::number::convert::{self, snap};
use ninebit::raster::assemble::Assembly;
use ninebit::raster::stroke::Figure;
use ninebit::state::{
    DepthFormat, Draw, PolygonModes, Positions, Scene, ShadeModel, Topology, Vertex, VertexColor, VertexDepths,
};

use super::state::code;
use super::{ExportError, Words, refuse, transform};
use crate::celsius;
use crate::class::{self, Family};
use crate::draw::raster::TOPOLOGIES;
use crate::vertex::attribute;

const SET_VERTEX4F: u32 = 0x1518;
const SET_DIFFUSE_COLOR4F: u32 = 0x1550;
const SET_TEXCOORD0_4F: u32 = 0x15a0;
const SET_VERTEX_DATA4UB: u32 = 0x1940;
pub(super) const SET_FOG_COORD: u32 = 0x1698;

/// Sends the vertices of a draw. `assembly` has them as the rasteriser gets them.
pub(super) fn vertices(words: &mut Words, scene: &Scene, draw: &Draw, assembly: &Assembly) -> Result<(), ExportError> {
    let depth = scene.targets[draw.target].depth.map_or(DepthFormat::Z24S8, |depth| depth.format);
    if words.family == Family::Celsius {
        transform::choose(words, draw.fog.enabled);
    }
    let mut sender = Sender { words, draw, depth };
    if draw.positions == Positions::Window {
        sender.begin(draw.topology);
        for index in draw.indices.iter() {
            let size = draw.point_sizes.as_ref().map(|sizes| sizes[*index as usize]);
            let flag = draw.edge_flags.as_ref().is_none_or(|flags| flags[*index as usize]);
            sender.words.set(class::SET_EDGE_FLAG, flag.into());
            sender.vertex(&draw.vertices.at(*index as usize), None, size)?;
        }
        sender.end();
        return Ok(());
    }
    clipped(&mut sender, draw, assembly)
}

/// Sends what clipping has left.
fn clipped(sender: &mut Sender<'_>, draw: &Draw, assembly: &Assembly) -> Result<(), ExportError> {
    if draw.topology.has_faces() && draw.polygon_modes != PolygonModes::FILL {
        return refuse(
            "polygons drawn as lines or points after clipping have no words: state their vertices as `Window`",
        );
    }
    let mut open: Option<Figure> = None;
    for number in 0..assembly.triangles.len() {
        let assembled = assembly.triangles.at(number);
        if open != Some(assembled.figure) {
            if open.is_some() {
                sender.end();
            }
            open = Some(assembled.figure);
            sender.begin(match assembled.figure {
                Figure::Triangle => Topology::Triangles,
                Figure::Line => Topology::Lines,
                Figure::Point => Topology::Points,
            });
        }
        let flat = draw.shade_model == ShadeModel::Flat;
        let colors = flat.then(|| assembly.vertices.at(assembled.provoking as usize));
        let corners: &[usize] = match assembled.figure {
            Figure::Triangle => &[0, 1, 2],
            Figure::Line => &[1, 2],
            Figure::Point => &[0],
        };
        for corner in corners {
            let index = assembled.vertices[*corner] as usize;
            let size = assembly.point_sizes.as_ref().map(|sizes| sizes[index]);
            sender.vertex(&assembly.vertices.at(index), colors.as_ref(), size)?;
        }
    }
    if open.is_some() {
        sender.end();
    }
    Ok(())
}

/// Returns a number whose inverse is w in the 16 significant bits that the chip keeps (INT-6).
fn inverse(w: f32) -> f32 {
    let near = 1.0 / w;
    let kept = |w: f32| w.to_bits() >> 8;
    let candidates = [0, 1, -1, 2, -2, 3, -3].map(|step: i32| f32::from_bits(near.to_bits().wrapping_add_signed(step)));
    candidates.into_iter().find(|number| kept(1.0 / number) == kept(w)).unwrap_or(near)
}

struct Sender<'a> {
    words: &'a mut Words,
    draw: &'a Draw,
    depth: DepthFormat,
}

impl Sender<'_> {
    fn begin(&mut self, topology: Topology) {
        self.words.send(class::SET_BEGIN_END, code(&TOPOLOGIES, topology));
    }

    fn end(&mut self) {
        self.words.send(class::SET_BEGIN_END, 0);
    }

    /// Sends a vertex, with the colours of another one if they are flat.
    fn vertex(&mut self, vertex: &Vertex, colors: Option<&Vertex>, size: Option<u16>) -> Result<(), ExportError> {
        let colored = colors.unwrap_or(vertex);
        self.color(attribute::DIFFUSE, colored.diffuse);
        self.color(attribute::SPECULAR, colored.specular);
        if self.draw.fog.enabled {
            let coordinate = self.fog(vertex)?;
            self.words.number(SET_FOG_COORD, coordinate);
        }
        if let Some(size) = size {
            self.attribute(attribute::POINT_SIZE, [f32::from(size) / 8.0, 0.0, 0.0, 1.0]);
        }
        let units = self.words.family.profile().texture_units();
        for (unit, stage) in self.draw.texture_shader[..units].iter().enumerate() {
            self.attribute(attribute::TEXTURE + unit, vertex.texture_coordinates[stage.coordinate_set]);
        }
        let [x, y, z, w] = vertex.position;
        let position = match self.words.family {
            Family::Kelvin => [x, y, self.depth(z), w],
            Family::Celsius => self.celsius_position([x, y, self.depth(z), w])?,
        };
        for (n, number) in (0..).zip(position) {
            self.words.send(SET_VERTEX4F + 4 * n, number.to_bits());
        }
        Ok(())
    }

    /// Returns what becomes this position on Celsius. The window's coordinates are rounded as the rasteriser does, so that nothing is lost by the origin.
    fn celsius_position(&self, [x, y, z, w]: [f32; 4]) -> Result<[f32; 4], ExportError> {
        let in_class = |c: f32| snap(c) as f32 / 16.0 - celsius::ORIGIN;
        let (x, y) = (in_class(x), in_class(y));
        if !self.draw.fog.enabled {
            return Ok([x, y, z, inverse(w)]);
        }
        // The pipe divides by w.
        if w.to_bits() << 9 != 0 {
            return refuse(
                "fog where w is no power of two has no words: only the fixed-function pipe has fog, and it divides by w",
            );
        }
        Ok([x * w, y * w, z * w, w])
    }

    /// Returns a depth in steps.
    fn depth(&self, z: f32) -> f32 {
        match self.draw.depth_test {
            Some(test) if test.vertex_depths == VertexDepths::Fractions && !self.depth.is_float() => {
                // Integers of 24 bits are exact in binary32.
                convert::depth(z, self.depth.bits()) as f32
            }
            _ => z,
        }
    }

    /// Returns the fog coordinate of a vertex.
    fn fog(&self, vertex: &Vertex) -> Result<f32, ExportError> {
        let known = match self.draw.fog.function {
            Some(function) => function.coordinate(vertex),
            None => vertex.fog_coordinate,
        };
        known.map_or_else(|| refuse("the fog coordinate of a vertex is not known"), Ok)
    }

    fn color(&mut self, attribute: usize, color: VertexColor) {
        match color {
            VertexColor::Bytes(bytes) => {
                // The same attribute has two methods: neither knows of the other's word.
                (0..4).for_each(|n| self.forget(self.floats(attribute) + 4 * n));
                self.words.set(self.bytes(attribute), u32::from_le_bytes(bytes));
            }
            VertexColor::Floats(numbers) => {
                self.forget(self.bytes(attribute));
                self.attribute(attribute, numbers);
            }
        }
    }

    /// Sends an attribute if it differs from what it is.
    fn attribute(&mut self, attribute: usize, numbers: [f32; 4]) {
        for (n, number) in (0..).zip(numbers) {
            self.words.number(self.floats(attribute) + 4 * n, number);
        }
    }

    fn forget(&mut self, method: u32) {
        if let Some(number) = self.words.family.own(method) {
            self.words.state.remove(&number);
        }
    }

    /// Returns the method of four floats of an attribute: of each, or on Celsius the one that the attribute has.
    fn floats(&self, attribute: usize) -> u32 {
        match (self.words.family, attribute) {
            (Family::Celsius, attribute::DIFFUSE) => SET_DIFFUSE_COLOR4F,
            (Family::Celsius, attribute::SPECULAR) => SET_DIFFUSE_COLOR4F + 0x20,
            (Family::Celsius, attribute::TEXTURE) => SET_TEXCOORD0_4F,
            (Family::Celsius, _) if attribute == attribute::TEXTURE + 1 => SET_TEXCOORD0_4F + 0x28,
            _ => class::SET_VERTEX_DATA4F_M + 16 * attribute as u32,
        }
    }

    /// Returns the method of four bytes of a colour.
    fn bytes(&self, attribute: usize) -> u32 {
        match self.words.family {
            Family::Kelvin => SET_VERTEX_DATA4UB + 4 * attribute as u32,
            Family::Celsius => SET_DIFFUSE_COLOR4F + 0x1c + if attribute == attribute::SPECULAR { 0x20 } else { 0 },
        }
    }
}
