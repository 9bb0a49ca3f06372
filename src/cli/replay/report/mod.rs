//! What a replay found, in words and for programs. The same scenes give the same bytes: no times, no machine.

mod github;
mod html;
mod json;
mod junit;
mod text;

pub use github::{annotations, step_summary};
pub use html::html;
pub(crate) use json::histograms;
pub use json::json;
pub use junit::junit;
pub use text::text;
