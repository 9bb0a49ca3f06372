//! The scorecard: pictures of another renderer against those of the chip, and the rules that explain what differs.
//!
//! A [`Subject`] is a frame with the picture that the chip, or the model, shows. [`score`] compares the other renderer's picture with it and
//! draws the frame again with each [`Shortcut`](ninebit::shortcut::Shortcut) that can change it, and with pairs. A wrong pixel is *explained*
//! where such a variant yields the other renderer's bytes and the rules yield the chip's. [`causes`] chooses the smallest set of shortcuts
//! that explains the most, and drops those that explain no more than chance.

pub mod causes;
mod chance;
mod explain;
mod folder;
mod json;
mod pixels;
mod run;
mod show;
mod subject;

pub use chance::Chance;
pub use explain::{Class, Counts, Explained, FrameScore, score};
pub use folder::{Pictures, beside_scenes, find};
pub use json::document;
pub use pixels::{COLORS, Sample};
pub use run::{Run, Total, other, run, truth};
pub use show::{Evidence, Exhibit, evidence, exhibits};
pub use subject::{Drawing, Subject, Truth, captured, of_scene};
