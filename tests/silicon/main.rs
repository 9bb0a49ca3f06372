//! Compares the model with a real NV2A: single measured pixels (`probes`) and whole captured frames (`frames`).
#![allow(
    clippy::float_arithmetic,
    clippy::unwrap_used,
    missing_docs,
    unreachable_pub,
    reason = "a test that gives floats to the model"
)]

mod blend_probes;
#[path = "../common/build.rs"]
mod build;
mod cases;
mod combiner_probes;
mod fog;
mod frames;
mod picture;
mod probes;
mod raster_probes;
#[path = "../common/repository.rs"]
mod repository;
#[path = "../common/settings.rs"]
mod settings;
mod sheet;
mod table;
mod unit_probes;
mod weights;
