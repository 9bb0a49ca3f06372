//! Traces as people and programs read them.

mod json;
mod text;

pub use json::{trace_json, trace_value};
pub use text::trace_text;
