//! The scorecard: pictures of another renderer against those of the chip, and the rules that explain what differs.
//!
//! A [`Subject`] is a frame with the picture that the chip, or the model, shows. [`score`] compares the other renderer's picture with it and
//! draws a sample of the frame again with each [`Shortcut`](ninebit::shortcut::Shortcut) that can change it, and with several. [`causes`]
//! chooses the smallest set of shortcuts that yields the most, and drops those that yield no more than chance. [`run()`] then draws every wrong
//! pixel with the chosen ones: it is *explained* where one yields the other renderer's bytes and the rules yield the chip's. [`of_answers`] scores
//! what a card or driver answered to a pack of vectors.

pub mod causes;
mod chance;
mod explain;
mod folder;
mod json;
mod pixels;
mod rows;
mod run;
mod search;
mod show;
mod subject;

pub use chance::Chance;
pub use explain::{Class, Counts, FrameScore, score};
pub use folder::{Pictures, beside_scenes, find};
pub use json::document;
pub use pixels::{COLORS, Sample};
pub use rows::of_answers;
pub use run::{Run, Total, other, run, truth};
pub use search::Explanation;
pub use show::{Evidence, Exhibit, evidence, exhibits};
pub use subject::{Drawing, Renderer, Subject, Truth, captured, of_scene};
