//! Draws scenes on a GPU by the rules as `ninebit-lower` prints them: for each draw a function of WGSL from a pixel, the constants of its triangle
//! and the memories of textures to the stored words.
//!
//! Triangles are sorted into tiles, in order. Each pixel of a tile is an invocation that runs the function for each triangle which covers it, so that
//! neither order nor colours need atomics. Set-up is the printed one, evaluated on the CPU.

mod adapter;
mod bins;
mod comparison;
mod failure;
mod renderer;
mod text;

pub use adapter::{Gpu, adapters, description};
pub use comparison::difference;
pub use failure::Failure;
pub use renderer::{Renderer, Text};
