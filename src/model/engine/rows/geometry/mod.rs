//! The geometry of a triangle: its edge functions, the columns that it covers, and the weights of its vertices.

pub(super) mod shape;
pub(super) mod spans;
pub(super) mod weights;
