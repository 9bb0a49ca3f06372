//! The vertices of a draw: attributes from arrays ([`formats`]), vertex programs as microcode ([`microcode`]), and the
//! fixed-function pipe ([`fixed`]).
//!
//! Arrays give [`Attributes`]; a program or the fixed-function pipe turns them into [`Outputs`]. No capture isolates the
//! numbers of this module: they are INFERRED from public register models, which each file names.

pub mod fixed;
pub mod formats;
pub mod microcode;
#[cfg(test)]
mod random;

/// Number of attributes of a vertex.
pub const ATTRIBUTES: usize = 16;

/// The attributes of a vertex, by the numbers of [`attribute`].
pub type Attributes = [[f32; 4]; ATTRIBUTES];

/// The components that nothing gives.
pub const DEFAULT: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// The numbers of attributes in a vertex. Vertex programs name them `v0` to `v15`, and the outputs of a program have the
/// same numbers.
pub mod attribute {
    /// The position.
    pub const POSITION: usize = 0;
    /// The weights of the model-view matrices.
    pub const WEIGHT: usize = 1;
    /// The normal.
    pub const NORMAL: usize = 2;
    /// The primary colour.
    pub const DIFFUSE: usize = 3;
    /// The secondary colour.
    pub const SPECULAR: usize = 4;
    /// The fog coordinate.
    pub const FOG: usize = 5;
    /// The size of a point.
    pub const POINT_SIZE: usize = 6;
    /// The primary colour of the back.
    pub const BACK_DIFFUSE: usize = 7;
    /// The secondary colour of the back.
    pub const BACK_SPECULAR: usize = 8;
    /// The first of four sets of texture coordinates.
    pub const TEXTURE: usize = 9;
}

/// A vertex as it leaves the transform unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outputs {
    /// The position: of a program, in the window, with w; of the fixed-function pipe, in clip space.
    pub position: [f32; 4],
    /// The primary colour, not limited.
    pub diffuse: [f32; 4],
    /// The secondary colour, not limited.
    pub specular: [f32; 4],
    /// The primary colour of the back.
    pub back_diffuse: [f32; 4],
    /// The secondary colour of the back.
    pub back_specular: [f32; 4],
    /// The fog coordinate.
    pub fog: f32,
    /// The size of a point in pixels, which counts where point parameters are enabled (0x0318).
    pub point_size: f32,
    /// The texture coordinates.
    pub coordinates: [[f32; 4]; 4],
}
