//! Traces as people and programs read them.

mod beside;
mod json;
mod text;

pub use beside::{BesideLine, beside, beside_text};
pub(crate) use json::origins;
pub use json::{policies_value, steps_value, trace_json, trace_value, write_trace_json};
pub(crate) use text::planes;
pub use text::{policies_text, steps_text, trace_text, write_trace_text};
