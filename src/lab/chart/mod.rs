//! Speed against accuracy: everything measured afresh, as pictures, tables and data.
//!
//! | file | knows |
//! |---|---|
//! | `techniques.rs` | scenes with a truth, found in folders: how exact, how fast, at what cost |
//! | `evaluators.rs` | the ways in which a scene can be evaluated here |
//! | `surfaces.rs` | one surface with more and more state |
//! | `curves.rs` | how cost grows with pixels, draws, triangles and stages |
//! | `timing.rs` | medians of frames |
//! | `front.rs` | what nothing beats at both |
//! | `picture.rs`, `labels.rs` | charts, and names that do not overlap |
//! | `report.rs` | the files of the page |
//! | `page.rs` | templates, tables, numbers as text |
#![allow(clippy::float_arithmetic, reason = "times and errors; nothing of this is stored in a frame")]

pub mod curves;
pub mod evaluators;
pub mod front;
pub mod labels;
pub mod page;
pub mod picture;
pub mod report;
pub mod surfaces;
pub mod techniques;
pub mod timing;
