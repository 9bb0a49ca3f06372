//! Ninebit: a deterministic, bit-accurate fixed-point model of GeForce-256-class texture units and register combiners.

<<<<<<< HEAD
pub mod engine;
pub mod frame;
pub mod plan;
=======
pub mod combiner;
pub mod engine;
pub mod frame;
pub mod generate;
mod guard;
pub mod number;
pub mod output;
pub mod picture;
pub mod plan;
pub mod raster;
pub mod rop;
pub mod scene;
>>>>>>> 1d98b68
pub mod state;
pub mod texture;
pub mod trace;
