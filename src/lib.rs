//! Ninebit: a deterministic, bit-accurate fixed-point model of GeForce-256-class texture units and register combiners.

pub mod combiner;
pub mod engine;
pub mod frame;
pub mod number;
pub mod plan;
pub mod raster;
pub mod report;
pub mod rop;
pub mod state;
pub mod texture;
pub mod trace;
