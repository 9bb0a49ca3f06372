//! Texture units: coordinates, choice of levels, texel fetch, formats, filters, and texture shaders.

pub mod address;
pub mod anisotropy;
pub mod chain;
pub mod color_key;
pub mod compressed;
pub mod coordinates;
pub mod cube;
pub mod dependent;
pub mod dot;
pub mod fetch;
pub mod filter;
pub mod format;
pub mod lod;
mod memory;
pub mod other_kind;
pub mod planned;
pub mod real;
pub mod report;
pub mod shader;
mod shader_report;
pub mod shadow;
pub mod show;
pub mod single;
pub mod stage;
pub mod unit;
pub mod yuv;
