//! All tests that need no binary of their own, in one binary, because linking forty binaries would take longer than running them.
//!
//! `cargo test --test suite trace::` runs those of `tests/trace.rs`.
#![allow(
    unreachable_pub,
    dead_code,
    missing_docs,
    missing_debug_implementations,
    clippy::unwrap_used,
    clippy::float_arithmetic,
    reason = "tests fail by panicking, and modules share files of which each uses its part"
)]

#[path = "common/bench.rs"]
mod bench;
#[path = "common/dds.rs"]
mod dds;
#[path = "common/operations.rs"]
mod operations;
#[path = "common/pages.rs"]
mod pages;
#[path = "common/repository.rs"]
mod repository;
#[path = "common/scene_files.rs"]
mod scene_files;
#[path = "common/settings.rs"]
mod settings;
#[path = "common/third_party.rs"]
mod third_party;

mod answers;
mod api_programs;
mod architecture;
mod assets_images;
mod assets_output;
mod assets_scenes;
mod bad_scenes;
mod blocks;
mod captures;
mod circles;
mod cli;
mod cli_chart;
mod cli_compare;
mod cli_measure;
mod cli_names;
mod cli_outputs;
mod cli_scenes;
mod cli_texture;
mod clipping;
mod combiner_language;
mod compare;
mod compressed;
mod dds_files;
mod deciding;
mod diff;
mod docs;
mod engines;
mod error_codes;
mod explain;
mod files;
mod import;
mod metamorphic;
mod op;
mod oracle;
mod planes;
mod readme;
mod registers;
mod replay;
mod results;
mod rule;
mod scene_format;
mod scene_hostile;
mod scene_in_code;
mod scene_writer;
mod score;
mod stability;
mod tables;
mod techniques;
mod texture_lattice;
mod texture_properties;
mod textures;
mod third_party_harness;
mod third_party_pipeline;
mod third_party_pixel_shader;
mod third_party_registers;
mod third_party_stages;
mod trace;
mod trace_format;
mod truth;
mod vectors;
mod vectors_committed;
mod vectors_operations;
mod vectors_sweep;
mod vertex_memory;
mod vertex_programs;
mod vertex_scenes;
