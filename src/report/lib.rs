//! What a render did, for people and for programs.
//!
//! * [`trace_text`], [`trace_json`] and [`beside`](fn@beside): the integers of one pixel, and of two.
//! * [`compare`]: the same frame in ideal float64 arithmetic, and which rule causes which part of the difference.
//! * [`explain`]: what a plan computes, as equations, and what it costs.
//! * [`vocabulary`]: the fields, names and operations of traces.

mod beside;
pub mod compare;
pub mod explain;
mod json;
mod text;
pub mod vocabulary;

pub use beside::{BesideLine, beside, beside_text};
pub use json::origins;
pub use json::{policies_value, steps_value, trace_json, trace_value, write_trace_json, write_traces_json};
pub use text::planes;
pub use text::{policies_text, steps_text, trace_text, write_trace_text};
