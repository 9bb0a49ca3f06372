//! Reports on renders, as text and as JSON.
//!
//! * [`trace_text`], [`trace_json`] and [`side_by_side`](fn@side_by_side): the integers of one pixel, and of two compared.
//! * [`compare`]: comparison with the same frame in ideal float64 arithmetic, split by the rules that cause differences.
//! * [`explain`]: what a plan computes, as equations, and what it costs.
//! * [`planes`]: values that traces name as arrays, of all pixels of a rectangle.
//! * [`ShadingWork`]: how many pixels a scene shades, and about how long that takes.
//! * [`vocabulary`]: the fields, names and operations of traces.

pub mod compare;
pub mod explain;
mod json;
pub mod planes;
mod side_by_side;
mod text;
pub mod vocabulary;
mod work;

pub use json::origins;
pub use json::{policies_value, steps_value, trace_json, trace_value, write_trace_json, write_traces_json};
pub use side_by_side::{SideBySideLine, side_by_side, side_by_side_text};
pub use text::{policies_text, steps_text, trace_text, write_trace_text};
pub use work::ShadingWork;

/// Returns what `write` writes.
fn written(write: impl FnOnce(&mut String) -> std::fmt::Result) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write(&mut out);
    out
}
