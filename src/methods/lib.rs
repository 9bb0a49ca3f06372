//! Methods of the chip's 3D class: logs of real programs become scenes, and scenes become methods.

pub mod vertex;
