//! Speed against accuracy: everything measured afresh, as pictures, tables and data.
//!
//! | file | knows |
//! |---|---|
//! | `techniques.rs` | scenes with a truth, found in folders: how exact, how fast, at what cost |
//! | `evaluators.rs` | the ways in which a scene can be evaluated here |
//! | `surfaces.rs` | one surface with more and more state |
//! | `curves.rs` | how cost grows with pixels, draws, triangles and stages |
//! | `timing.rs` | medians of frames |
//! | `pareto.rs` | what nothing beats at both |
//! | `questions.rs` | which techniques mean the same picture, and what is asked about it |
//! | `dots.rs`, `strip.rs` | what a chip pays for a light, and the pictures of all ways to it |
//! | `picture.rs`, `labels.rs`, `canvas.rs` | drawings in both formats, and names that do not overlap |
//! | `answers.rs` | what the figures say to five questions |
//! | `report.rs`, `tables.rs`, `data.rs` | the files of the page |
//! | `page.rs` | templates, tables, numbers as text |
#![allow(clippy::float_arithmetic, reason = "times and errors; nothing of this is stored in a frame")]

pub mod answers;
pub mod canvas;
pub mod curves;
pub mod data;
pub mod dots;
pub mod evaluators;
pub mod labels;
pub mod page;
pub mod pareto;
pub mod picture;
pub mod questions;
pub mod report;
pub mod strip;
pub mod surfaces;
pub mod tables;
pub mod techniques;
pub mod timing;
