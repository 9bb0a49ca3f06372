//! Methods of the chips' 3D classes: logs of real programs become scenes, and scenes become methods.

mod celsius;
pub mod class;
pub mod console;
mod draw;
pub mod dumps;
pub mod explain;
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
