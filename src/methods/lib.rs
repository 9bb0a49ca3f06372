//! Methods of the chip's 3D class: logs of real programs become scenes, and scenes become methods.

pub mod class;
mod draw;
pub mod dumps;
pub mod export;
pub mod frame;
pub mod gap;
pub mod import;
pub mod log;
pub mod memory;
pub mod pgraph;
pub mod pushbuffer;
pub mod state;
pub mod vertex;
