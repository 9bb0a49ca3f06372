//! Textures on rows: where the lanes of a block sample, which levels, and what they read.

pub(super) mod facing;
pub(super) mod fetch;
pub(super) mod filter;
pub(super) mod levels;
pub(super) mod lods;
pub(super) mod pairs;
pub(super) mod place;
pub(super) mod quads;
pub(super) mod sampler;
pub(super) mod table;
pub(super) mod taps;
