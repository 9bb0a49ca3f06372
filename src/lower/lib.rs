//! Prints the rules in other languages: a pixel of a draw, or of a program alone, as one function of C99, GLSL, WGSL or Verilog.
//!
//! No rule is repeated here. The order of a pixel is read through [`Algebra`](ninebit::algebra::Algebra), by a reader whose values are lines of
//! integer operations; the rules of numbers are read in a lane of their own. Each line knows its range, so that what cannot happen is left out and no
//! width is guessed. The four languages differ only in their syntax.
//!
//! The example `shader` prints a combiner program as GLSL.

mod binary;
mod body;
pub mod code;
mod coordinates;
mod draw;
mod generic;
mod helper;
mod input;
mod kind;
mod language;
mod number;
mod operation;
mod order;
mod pixel;
mod place;
mod setup;
mod stage;
mod texel;
mod triangle;
mod truth;
mod whole;

pub use draw::unprinted;
pub use generic::{Generic, Sources, with_all_levels};
pub use input::{Input, Local, Weight};
pub use language::{Draw, Language, NamedFunction, Shaders};
pub use pixel::{Function, Options, Result, Textures};
pub use setup::Setup;
pub use triangle::{Attribute, Field, Part};
