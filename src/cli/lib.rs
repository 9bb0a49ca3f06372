//! Ninebit: a deterministic, bit-accurate fixed-point model of GeForce-256-class texture units and register combiners.
//!
//! The input is a scene: vertices, state and textures. The output is the bytes that the chip stores and, for any pixel,
//! a trace of every integer that leads to them. The crate models values, not timing.
//!
//! # From a scene to a frame
//!
//! ```text
//! text -> scene -> state -> plan -> engine -> frames, traces -> report
//!                                     |
//!              number . raster . texture . combiner . rop
//! ```
//!
//! * [`state`] describes what to draw: plain data in the chip's own terms, built in code as below or read by `scene`.
//! * [`plan`] reduces a scene to what can reach a frame. Once a [`plan::Plan`] exists, nothing can fail any more;
//!   [`limits`] says how much it accepts.
//! * [`engine`] draws: by default in blocks of 384 pixels, or pixel by pixel in the order in which the definition is
//!   written. Both run the rules of [`raster`], [`texture`], [`combiner`] and [`rop`] and store the same bytes.
//! * [`number`] holds the lanes, which are the types that rules compute with: the integers of the definition, the real
//!   numbers of the ideal, and both side by side. Each rule is written once, generic over the lane.
//! * [`trace`] defines how the blocks report what they do; `report` prints the reports.
//!
//! Every rule has an id (such as `CMB-3`), a grade that says how well it is known, a source and a test: `ninebit rule CMB-3` prints them.
//!
//! # Features
//!
//! Without features this crate is the model, which opens no file, reads no clock and starts no thread.
//!
//! | feature | adds |
//! |---|---|
//! | `threads` | bands of a target are drawn by several threads |
//! | `scene` | the module `scene`, which reads scenes in RON, images and meshes |
//! | `languages` | the module `languages`: programs in the combiner language, as register words, in terms of Direct3D and OpenGL |
//! | `report` | the module `report`: traces as text and JSON, comparison with real numbers |
//! | `program` | all of these and the program `ninebit`. On by default: turn default features off for a library alone |
//!
//! The crates `ninebit-lower` and `ninebit-vectors` print rules in other languages, and tables of what units yield.
//!
//! # Examples
//!
//! A whole scene: a map of two normals, lit by one dot product a pixel.
//!
//! ```
#![doc = include_str!("examples/lit.rs")]
//! ```
//!
//! One pixel of a white triangle, whose colour the final combiner halves: 128/255 times 255, rounded to the nearest
//! 255th.
//!
//! ```
#![doc = include_str!("examples/pixel.rs")]
//! ```

// The program and its tests say `ninebit` to the model, as everyone does.
extern crate self as ninebit;

#[doc(inline)]
pub use ninebit_model::*;
#[cfg(feature = "languages")]
#[doc(inline)]
pub use ninebit_program as languages;
#[cfg(feature = "report")]
#[doc(inline)]
pub use ninebit_report as report;
#[cfg(feature = "scene")]
#[doc(inline)]
pub use ninebit_scene as scene;

#[cfg(feature = "program")]
mod commands;
#[cfg(feature = "program")]
pub mod expectation;
#[cfg(feature = "program")]
mod page;
#[cfg(feature = "program")]
pub mod replay;
#[cfg(feature = "program")]
pub mod shard;
#[cfg(feature = "program")]
mod undecided;

#[cfg(feature = "program")]
pub use commands::main;

/// Runs a command line in this process, with the program's name first. Returns its exit status. Does not catch panics.
#[cfg(feature = "program")]
pub fn run(arguments: &[std::ffi::OsString]) -> u8 {
    commands::run(arguments) as u8
}
