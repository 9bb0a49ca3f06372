//! Ninebit: a deterministic, bit-accurate fixed-point model of GeForce-256-class texture units and register combiners.
//!
//! A scene (vertices, state, textures) goes in; stored bytes come out, and for any pixel a trace of every integer on the way. The
//! model counts values, not cycles.
//!
//! # The way of a scene
//!
//! ```text
//! text -> ninebit-scene -> state -> plan -> engine -> frames, traces -> ninebit-report
//!                                             |
//!                      number . raster . texture . combiner . rop
//! ```
//!
//! * [`state`] is what there is to draw: plain data in the chip's own terms, built as below or read by the crate `ninebit-scene`.
//! * [`plan`] keeps what can reach a frame. Whatever can fail has failed when a [`plan::Plan`] exists; [`limits`] says how much it accepts.
//! * [`engine`] draws: by default blocks of 256 pixels at a time, or pixel by pixel as the definition reads. Both run the rules of
//!   [`raster`], [`texture`], [`combiner`] and [`rop`] and store the same bytes.
//! * [`number`] holds the lanes: the integers of the definition, the real numbers of the ideal, and both side by side. Each rule is one
//!   text, generic over the lane.
//! * [`trace`] is how the blocks report what they do; the crate `ninebit-report` prints it.
//!
//! This crate opens no file, asks for no time and, without its feature `threads`, starts no thread.
//!
//! Every rule has an id (`CMB-3`), a grade that says how well it is known, a source and a test: `docs/numerics.md`.
//!
//! # Example
//!
//! One pixel: a white triangle, its colour halved by the final combiner (128 of 255, times 255, rounded to the nearest 255th).
//!
//! ```
#![doc = include_str!("examples/pixel.rs")]
//! ```

pub mod algebra;
pub mod combiner;
pub mod diagnostic;
pub mod engine;
pub mod frame;
pub mod legality;
pub mod limits;
pub mod number;
pub mod place;
pub mod plan;
pub mod random;
pub mod raster;
pub mod rop;
pub mod shown;
pub mod state;
pub mod texture;
pub mod threads;
pub mod trace;
pub mod vertex;
