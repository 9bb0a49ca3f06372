//! Speed against accuracy: measured afresh, as pictures, tables and data.
//!
//! | file | contents |
//! |---|---|
//! | `techniques.rs` | scenes with a truth, found in folders: accuracy, speed and cost |
//! | `evaluators.rs` | the evaluators of a scene |
//! | `surfaces.rs` | one surface with more and more state |
//! | `curves.rs` | how cost grows with pixels, draws, triangles and stages |
//! | `timing.rs` | medians of frames |
//! | `pareto.rs` | the Pareto front |
//! | `questions.rs` | the techniques for the same light, and the questions about it |
//! | `dots.rs`, `strip.rs` | the cost of a light on the chip, and the pictures of its techniques |
//! | `bars.rs` | the list of evaluators |
//! | `tiles.rs` | pictures side by side, each with its caption |
//! | `picture.rs`, `labels.rs`, `canvas.rs` | charts with two axes, and drawings as SVG and PNG |
//! | `answers.rs` | answers to five questions |
//! | `report.rs`, `tables.rs`, `data.rs` | the files of the page |
//! | `page.rs` | templates, tables, numbers as text |
#![allow(clippy::float_arithmetic, reason = "times and errors; nothing of this is stored in a frame")]

mod answers;
mod bars;
mod canvas;
pub mod curves;
pub mod data;
mod dots;
pub mod evaluators;
pub mod labels;
pub mod page;
mod pareto;
pub mod picture;
mod questions;
pub mod report;
mod strip;
pub mod surfaces;
mod tables;
pub mod techniques;
pub mod tiles;
pub mod timing;
