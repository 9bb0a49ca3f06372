//! Ninebit: a deterministic, bit-accurate fixed-point model of GeForce-256-class texture units and register combiners.
//!
//! The input is a scene: vertices, state and textures. The output is the bytes that the chip stores and, for any pixel,
//! a trace of every integer that leads to them. The crate models values, not timing.
//!
//! # From a scene to a frame
//!
//! ```text
//! text -> ninebit-scene -> state -> plan -> engine -> frames, traces -> ninebit-report
//!                                             |
//!                      number . raster . texture . combiner . rop
//! ```
//!
//! * [`state`] describes what to draw: plain data in the chip's own terms, built in code as below or read by the crate
//!   `ninebit-scene`.
//! * [`plan`] reduces a scene to what can reach a frame. Once a [`plan::Plan`] exists, nothing can fail any more;
//!   [`limits`] says how much it accepts.
//! * [`engine`] draws: by default in blocks of 384 pixels, or pixel by pixel in the order in which the definition is
//!   written. Both run the rules of [`raster`], [`texture`], [`combiner`] and [`rop`] and store the same bytes.
//! * [`number`] holds the lanes, which are the types that rules compute with: the integers of the definition, the real
//!   numbers of the ideal, and both side by side. Each rule is written once, generic over the lane.
//! * [`trace`] defines how the blocks report what they do; the crate `ninebit-report` prints the reports.
//!
//! This crate opens no file and reads no clock. Without its feature `threads` it starts no thread.
//!
//! Every rule has an id (such as `CMB-3`), a grade that says how well it is known, a source and a test; see
//! `docs/numerics.md`.
//!
//! # Example
//!
//! One pixel of a white triangle, whose colour the final combiner halves: 128/255 times 255, rounded to the nearest
//! 255th.
//!
//! ```
#![doc = include_str!("examples/pixel.rs")]
//! ```
//!
//! [`state::Draw::texture`] has the same with a texture.

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
pub mod shown;
pub mod state;
pub mod texture;
pub mod threads;
pub mod trace;
pub mod vertex;
