//! Ninebit: a deterministic, bit-accurate fixed-point model of GeForce-256-class texture units and register combiners.

pub mod combiner;
pub mod engine;
pub mod frame;
pub mod generate;
mod guard;
pub mod limits;
pub mod number;
pub mod output;
pub mod picture;
pub mod plan;
pub mod raster;
pub mod rop;
pub mod scene;
pub mod state;
pub mod texture;
pub mod trace;
