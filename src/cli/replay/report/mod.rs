//! Reports of a replay. The same scenes give the same bytes: reports contain neither times nor machines.

mod github;
mod html;
mod json;
mod junit;
mod text;

pub(crate) use github::{annotations, step_summary};
pub use html::html;
pub(crate) use json::histograms;
pub use json::json;
pub(crate) use junit::junit;
pub use text::text;
