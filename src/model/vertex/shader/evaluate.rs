//! VTX-1: runs a program on one vertex.
#![allow(clippy::float_arithmetic, reason = "vertex programs are single precision by rule")]

use super::function::{exponential, logarithm, parts, power};
use super::*;

/// The output registers. Components that nothing writes are 0, 0, 0, 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outputs {
    /// oPos, the position in clip space.
    pub position: [f32; 4],
    /// oD0 and oD1, the colours.
    pub colors: [[f32; 4]; 2],
    /// oT0 to oT3, the texture coordinates.
    pub coordinates: [[f32; 4]; COORDINATES],
    /// oFog, whose x is the fog factor.
    pub fog: [f32; 4],
    /// oPts, whose x is the point size.
    pub point_size: [f32; 4],
}

/// The value of an output register before anything writes it.
const INITIAL: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// Runs a program. `constants` must already contain its [`definitions`](VertexShader::definitions).
pub fn evaluate(shader: &VertexShader, constants: &Constants, inputs: &Inputs) -> Outputs {
    let mut machine = Machine { constants, inputs, temporaries: [[0.0; 4]; TEMPORARIES], address: 0.0 };
    let mut outputs = Outputs {
        position: INITIAL,
        colors: [INITIAL; 2],
        coordinates: [INITIAL; COORDINATES],
        fog: INITIAL,
        point_size: INITIAL,
    };
    for instruction in &shader.instructions {
        let result = machine.result(instruction);
        let destination = instruction.destination;
        let register = match destination.register {
            DestinationRegister::Temporary(index) => &mut machine.temporaries[index],
            DestinationRegister::Address => {
                machine.address = result[0].floor();
                continue;
            }
            DestinationRegister::Position => &mut outputs.position,
            DestinationRegister::Fog => &mut outputs.fog,
            DestinationRegister::PointSize => &mut outputs.point_size,
            DestinationRegister::Color(index) => &mut outputs.colors[index],
            DestinationRegister::Coordinates(index) => &mut outputs.coordinates[index],
        };
        for (k, value) in result.into_iter().enumerate() {
            if destination.mask >> k & 1 != 0 {
                register[k] = value;
            }
        }
    }
    outputs
}

struct Machine<'a> {
    constants: &'a Constants,
    inputs: &'a Inputs,
    temporaries: [[f32; 4]; TEMPORARIES],
    address: f32,
}

impl Machine<'_> {
    /// Returns the value of a register, or of the register `row` places after it.
    fn register(&self, register: SourceRegister, row: usize) -> [f32; 4] {
        match register {
            SourceRegister::Input(index) => self.inputs.get(index + row).copied().unwrap_or_default(),
            SourceRegister::Temporary(index) => self.temporaries.get(index + row).copied().unwrap_or_default(),
            SourceRegister::Constant { index, relative } => {
                let base = if relative { self.address } else { 0.0 };
                // Integers of this size are exact.
                let at = base + (index + row) as f32;
                let inside = (0.0..CONSTANTS as f32).contains(&at);
                if inside { self.constants[at as usize] } else { [0.0; 4] }
            }
        }
    }

    fn source(&self, source: &Source, row: usize) -> [f32; 4] {
        let value = self.register(source.register, row);
        source.swizzle.map(|k| if source.negate { -value[k] } else { value[k] })
    }

    fn result(&self, instruction: &Instruction) -> [f32; 4] {
        let source = |n: usize| instruction.sources.get(n).map_or([0.0; 4], |source| self.source(source, 0));
        let each = |f: fn(f32, f32) -> f32| {
            let (s, t) = (source(0), source(1));
            std::array::from_fn(|k| f(s[k], t[k]))
        };
        if let Some((rows, columns)) = instruction.opcode.matrix() {
            let s = source(0);
            let row = |n: usize| instruction.sources.get(1).map_or([0.0; 4], |source| self.source(source, n));
            return std::array::from_fn(|k| if k < rows { dot(&s[..columns], &row(k)) } else { 0.0 });
        }
        match instruction.opcode {
            Opcode::Mov => source(0),
            Opcode::Add => each(|s, t| s + t),
            Opcode::Sub => each(|s, t| s - t),
            Opcode::Mul => each(product),
            Opcode::Mad => {
                let (s, t, u) = (source(0), source(1), source(2));
                std::array::from_fn(|k| product(s[k], t[k]) + u[k])
            }
            Opcode::Min => each(|s, t| if s < t { s } else { t }),
            Opcode::Max => each(|s, t| if s >= t { s } else { t }),
            Opcode::Slt => each(|s, t| if s < t { 1.0 } else { 0.0 }),
            Opcode::Sge => each(|s, t| if s >= t { 1.0 } else { 0.0 }),
            Opcode::Dp3 => [dot(&source(0)[..3], &source(1)); 4],
            Opcode::Dp4 => [dot(&source(0), &source(1)); 4],
            Opcode::Dst => {
                let (s, t) = (source(0), source(1));
                [1.0, product(s[1], t[1]), s[2], t[3]]
            }
            Opcode::Rcp => [1.0 / source(0)[3]; 4],
            Opcode::Rsq => [(1.0 / f64::from(source(0)[3].abs()).sqrt()) as f32; 4],
            Opcode::Frc => source(0).map(|s| s - s.floor()),
            Opcode::Exp => [exponential(source(0)[3]); 4],
            Opcode::Expp => {
                let w = source(0)[3];
                [exponential(w.floor()), w - w.floor(), exponential(w), 1.0]
            }
            Opcode::Log => [logarithm(source(0)[3]); 4],
            Opcode::Logp => {
                let w = source(0)[3];
                let (exponent, mantissa) = parts(w);
                [exponent, mantissa, logarithm(w), 1.0]
            }
            Opcode::Lit => lit(source(0)),
            // These are computed above.
            Opcode::M3x2 | Opcode::M3x3 | Opcode::M3x4 | Opcode::M4x3 | Opcode::M4x4 => [0.0; 4],
        }
    }
}

/// Multiplies two numbers. The product is +0 if a factor is zero, whatever the other is.
fn product(a: f32, b: f32) -> f32 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// Adds products from left to right, where each operation is rounded.
fn dot(a: &[f32], b: &[f32; 4]) -> f32 {
    let mut terms = a.iter().zip(b).map(|(a, b)| product(*a, *b));
    let first = terms.next().unwrap_or(0.0);
    terms.fold(first, |sum, term| sum + term)
}

/// Largest magnitude of the exponent that `lit` uses.
const MAX_POWER: f32 = 128.0 - 1.0 / 256.0;

fn lit([x, y, _, w]: [f32; 4]) -> [f32; 4] {
    let specular = if x > 0.0 && y > 0.0 { power(y, w.clamp(-MAX_POWER, MAX_POWER)) } else { 0.0 };
    [1.0, if x > 0.0 { x } else { 0.0 }, specular, 1.0]
}
