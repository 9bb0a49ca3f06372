//! Checks that `docs/rules`, the handbook of rules, agrees with the sources, and computes every example of the handbook.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test binary")]

mod agreement;
#[path = "../common/bench.rs"]
mod bench;
#[path = "../common/build.rs"]
mod build;
mod catalogue;
mod handbook;
#[path = "../common/pages.rs"]
mod pages;
mod pixel;
#[path = "../common/repository.rs"]
mod repository;
#[path = "../common/settings.rs"]
mod settings;

mod final_combiner;
mod fog;
mod general_stage;
mod interpolation;
mod numbers;
mod raster_operations;
mod rasteriser;
mod sampling;
mod texture_formats;
mod texture_levels;
mod texture_shader;
mod texture_units;
mod vertex;
