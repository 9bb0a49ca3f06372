//! Lowers `Program(...)`: vertices that a vertex program computes.
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule")]

mod constants;
mod inputs;

use super::geometry::{Geometry, Objects, VertexOrigin, viewport, with_clip_depth};
use super::program_text::ProgramText;
use super::vertex::VertexData;
use super::*;
use inputs::Input;
use ninebit::vertex::point::eighths;
use ninebit::vertex::shader::{Constants, DestinationRegister, Inputs, Outputs, VertexShader, evaluate};
use ninebit_program::c_source::Style;
use ninebit_program::vertex_shader::{self, ShaderText, print};

/// Runs the program over the vertices. Returns `None` after recording what is wrong.
pub(super) fn geometry<'a>(reader: &mut Reader<'a>, target: usize, text: &'a str) -> Option<Geometry> {
    let opening = reader.opening(text);
    let fields = reader.read(&Raw::<source::ProgramVertices<'a>>::new(text))?;
    let viewport = viewport(reader, &fields.viewport, target);
    let viewport = with_clip_depth(viewport, fields.clip_depth(reader));
    let given = VertexOrigin::read(reader, &fields.vertices, &fields.mesh, opening.clone());
    let program = program(reader, &fields, opening);
    let constants = constants::constants(reader, &fields.constants, program.as_ref());
    let (given, (written, text)) = (given?, program?);
    let sources = inputs::sources(reader, &fields.inputs, &given, (&written, &text));
    if reader.errors > 0 {
        // The scene is refused in any case, so the program need not run over a mesh that may be large, for every draw.
        return None;
    }
    let (vertices, fog_coordinates, point_sizes) = run(reader, &written.shader, &constants, &sources, &given)?;
    Some(Geometry {
        positions: Positions::Clip(viewport),
        vertices,
        spans: given.spans(),
        mesh: given.mesh().cloned(),
        objects: Objects::Program { fog_coordinates, point_sizes },
        model_view: matrix::IDENTITY,
        program: Some(origin(&written.shader)),
    })
}

/// Makes the summary of a program that stays in the scene's state.
fn origin(shader: &VertexShader) -> VertexProgram {
    VertexProgram {
        text: print(shader),
        instructions: shader.instructions.len(),
        slots: shader.slots(),
        writes_fog: shader.written(DestinationRegister::Fog) != 0,
    }
}

fn program<'a>(
    reader: &mut Reader<'a>,
    fields: &source::ProgramVertices<'a>,
    opening: Span,
) -> Option<(ShaderText, ProgramText)> {
    let text = match (&fields.text, &fields.file) {
        (Some(raw), None) => ProgramText::inline(reader, raw)?,
        (None, Some(raw)) => ProgramText::file(reader, raw)?,
        (Some(first), Some(second)) => {
            let (first, second) = (reader.span(first), reader.span(second));
            let message = "the vertex program is given twice";
            let help = "keep one of `text` and `file`";
            return reader.refuse(finding("NB0388", second, message, "again here", help).related(first, "first here"));
        }
        (None, None) => {
            let message = "this vertex program has neither `text` nor `file`";
            let help = "write `text: r#\"vs.1.1 ...\"#`, or `file: \"name.vsh\"`";
            return reader.refuse(finding("NB0202", opening, message, "in here", help));
        }
    };
    let text = text.expanded(reader, Style::Assembler)?;
    let written = text.parsed(reader, vertex_shader::read(&text.text))?;
    text.push(reader, written.warnings.clone());
    Some((written, text))
}

/// Runs the program over all vertices by VTX-3. Also returns the fog coordinate of each vertex, and the size of its point if the program writes it.
fn run(
    reader: &mut Reader<'_>,
    shader: &VertexShader,
    constants: &Constants,
    sources: &[Input],
    given: &VertexOrigin,
) -> Option<(Vertices, Vec<f32>, Option<Vec<u16>>)> {
    let written = Registers::from_shader(shader);
    let mut fog_coordinates = Vec::with_capacity(given.count());
    let mut point_sizes = Vec::new();
    let vertices = (0..given.count()).map(|index| {
        let mut registers: Inputs = [[0.0; 4]; ninebit::vertex::shader::INPUTS];
        for (register, source) in registers.iter_mut().zip(sources) {
            *register = inputs::value(source, given, index);
        }
        let outputs = evaluate(shader, constants, &registers);
        if let Some(what) = written.not_finite(&outputs) {
            let spans = DrawSpans { draw: 0..0, vertices: given.spans(), ..DrawSpans::default() };
            let message = format!("{what} of vertex {index} is not finite");
            let label = "what the vertex program makes of it";
            let help = "look for rcp or rsq of 0, log of 0, and numbers too large";
            return reader.refuse(finding("NB0207", spans.vertex(index), message, label, help).rule("VTX-3"));
        }
        fog_coordinates.push(outputs.fog[0]);
        if written.point_size {
            point_sizes.push(eighths(outputs.point_size[0].into()));
        }
        Some(written.vertex(&outputs))
    });
    let vertices = vertices.collect::<Option<Vertices>>()?;
    Some((vertices, fog_coordinates, written.point_size.then_some(point_sizes)))
}

/// The output registers that a program writes.
struct Registers {
    colors: [bool; 2],
    coordinates: [bool; 4],
    fog: bool,
    point_size: bool,
}

impl Registers {
    fn from_shader(shader: &VertexShader) -> Registers {
        let written = |register| shader.written(register) != 0;
        Registers {
            colors: [0, 1].map(|n| written(DestinationRegister::Color(n))),
            coordinates: [0, 1, 2, 3].map(|n| written(DestinationRegister::Coordinates(n))),
            fog: written(DestinationRegister::Fog),
            point_size: written(DestinationRegister::PointSize),
        }
    }

    /// Returns the name of an output that cannot be used. Infinite colours can be: they are clamped. oFog is left to the fog.
    fn not_finite(&self, outputs: &Outputs) -> Option<String> {
        if !outputs.position.iter().all(|value| value.is_finite()) {
            return Some("oPos".to_owned());
        }
        let color = (0..2).find(|n| self.colors[*n] && outputs.colors[*n].iter().any(|value| value.is_nan()));
        let set =
            (0..4).find(|n| self.coordinates[*n] && !outputs.coordinates[*n].iter().all(|value| value.is_finite()));
        color.map(|n| format!("oD{n}")).or(set.map(|n| format!("oT{n}")))
    }

    /// Makes the vertex that the rasteriser takes. Attributes that the program does not write have their defaults.
    fn vertex(&self, outputs: &Outputs) -> Vertex {
        let absent = Vertex::default();
        let limited = |value: f32| value.clamp(0.0, 1.0);
        let color = |n: usize, absent: VertexColor| {
            if self.colors[n] { VertexColor::Floats(outputs.colors[n].map(limited)) } else { absent }
        };
        Vertex {
            position: outputs.position,
            diffuse: color(0, absent.diffuse),
            specular: color(1, absent.specular),
            fog: if self.fog { limited(outputs.fog[0]) } else { absent.fog },
            fog_coordinate: None,
            texture_coordinates: outputs.coordinates,
        }
    }
}
