//! Ninebit: a deterministic, bit-accurate fixed-point model of GeForce-256-class texture units and register combiners.

pub mod engine;
pub mod frame;
pub mod plan;
pub mod state;
