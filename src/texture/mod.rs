//! Texture units: texel expansion, addressing, filtering.

pub mod address;
pub mod compressed;
pub mod filter;
pub mod format;
pub mod unit;
