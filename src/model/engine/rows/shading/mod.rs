//! What a draw computes of its interpolated numbers and texels: combiners and blending as a graph of rows, and texture shaders stage by stage.

pub(super) mod build;
pub(super) mod compiled;
pub(super) mod dot;
pub(super) mod graph;
pub(super) mod kernels;
pub(super) mod node;
pub(super) mod shader;
#[cfg(test)]
pub(super) mod shader_tests;
pub(super) mod stages;
