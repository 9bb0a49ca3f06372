//! The fast engine draws blocks of up to 384 pixels.
//!
//! 1. The pixels that a triangle covers become lanes of a block: those of one large triangle, or of many small ones.
//! 2. For each lane the edge functions yield the weights of the vertices (WGT-1), once for all functions of the draw.
//! 3. Every number that varies is one linear function of these weights, computed exactly in doubles: colours, coordinates, fog, depths, numbers.
//! 4. Textures, which are decoded to tables, are read at these coordinates, and the draw's combiners and blending, compiled to a list of
//!    operations on rows of 16-bit numbers, run for all lanes.
//! 5. What remains after the tests is stored; the bytes are the scalar engine's, because every rule is the same text, or exact.
//!
//! | folder | knows |
//! |---|---|
//! | `draw` | who calls what: triangles to lanes, lanes to blocks, the parts for each instruction set |
//! | `store` | surfaces: what blending reads, the tests, the store |
//! | `shading` | what a draw computes, as a graph of rows; texture shaders, stage by stage |
//! | `interpolate` | one file for each kind of number that varies |
//! | `sampling` | textures as tables, levels of detail, fetches, filters |
//! | `geometry` | edge functions, spans and weights of a triangle |
//! | `lanes` | one number for each pixel of a block, and the arithmetic of loops over them |
//!
//! Each imports from those below it only. What rows do not sample (levels of volumes, tables that would not pay) is drawn by the scalar engine.

mod draw;
#[cfg(test)]
mod equivalence_tests;
mod geometry;
mod interpolate;
mod lanes;
#[cfg(test)]
mod lattice;
#[cfg(test)]
mod limit_tests;
mod sampling;
mod shading;
mod store;

pub use draw::Isa;
pub(crate) use draw::{Block, Kernels, Rows, run};
