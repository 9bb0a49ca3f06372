//! Vertices, sent one by one.
#![allow(clippy::float_arithmetic, reason = "sizes of points in pixels")]

use ninebit::number::convert;
use ninebit::raster::assemble::Assembly;
use ninebit::raster::stroke::Figure;
use ninebit::state::{
    DepthFormat, Draw, PolygonModes, Positions, Scene, ShadeModel, Topology, Vertex, VertexColor, VertexDepths,
};

use super::state::code;
use super::{ExportError, Words, refuse};
use crate::class;
use crate::draw::raster::TOPOLOGIES;
use crate::vertex::attribute;

const SET_VERTEX4F: u32 = 0x1518;
const SET_VERTEX_DATA4UB: u32 = 0x1940;
pub(super) const SET_FOG_COORD: u32 = 0x1698;

/// Sends the vertices of a draw. `assembly` has them as the rasteriser gets them.
pub(super) fn vertices(words: &mut Words, scene: &Scene, draw: &Draw, assembly: &Assembly) -> Result<(), ExportError> {
    let depth = scene.targets[draw.target].depth.map_or(DepthFormat::Z24S8, |depth| depth.format);
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
        for (unit, stage) in self.draw.texture_shader.iter().enumerate() {
            self.attribute(attribute::TEXTURE + unit, vertex.texture_coordinates[stage.coordinate_set]);
        }
        let [x, y, z, w] = vertex.position;
        for (n, number) in (0..).zip([x, y, self.depth(z), w]) {
            self.words.send(SET_VERTEX4F + 4 * n, number.to_bits());
        }
        Ok(())
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
        match (vertex.fog_coordinate, self.draw.fog.function) {
            (Some(coordinate), _) => Ok(coordinate),
            (None, Some(function)) if !function.takes_e() => Ok(vertex.fog),
            _ => refuse("the fog coordinate of a vertex is not known"),
        }
    }

    fn color(&mut self, attribute: usize, color: VertexColor) {
        match color {
            VertexColor::Bytes(bytes) => {
                let method = SET_VERTEX_DATA4UB + 4 * attribute as u32;
                // The same attribute has two methods: neither knows of the other's word.
                (0..4).for_each(|n| {
                    self.words.state.remove(&(class::SET_VERTEX_DATA4F_M + 16 * attribute as u32 + 4 * n));
                });
                self.words.set(method, u32::from_le_bytes(bytes));
            }
            VertexColor::Floats(numbers) => {
                self.words.state.remove(&(SET_VERTEX_DATA4UB + 4 * attribute as u32));
                self.attribute(attribute, numbers);
            }
        }
    }

    /// Sends an attribute if it differs from what it is.
    fn attribute(&mut self, attribute: usize, numbers: [f32; 4]) {
        for (n, number) in (0..).zip(numbers) {
            self.words.number(class::SET_VERTEX_DATA4F_M + 16 * attribute as u32 + 4 * n, number);
        }
    }
}
