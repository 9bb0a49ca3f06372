//! The model of ninebit: texture units and register combiners of the GeForce 256 class, bit by bit.
//!
//! The crate `ninebit` hands all of this on under its own name, with front ends beside it: its documentation begins with the way from a scene to a
//! frame, and has examples. Programs depend on that one, `use ninebit::state::*`; this one has the model alone.
//!
//! This crate opens no file and reads no clock. Without its feature `threads` it starts no thread.

pub mod algebra;
pub mod combiner;
pub mod diagnostic;
pub mod engine;
#[doc(hidden)]
pub mod faults;
pub mod frame;
pub mod legality;
pub mod limits;
pub mod number;
pub mod place;
pub mod plan;
pub mod random;
pub mod raster;
pub mod rop;
pub mod shortcut;
pub mod shown;
pub mod state;
pub mod texture;
pub mod threads;
pub mod trace;
pub mod vertex;
