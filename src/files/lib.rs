//! Files: read within [limits](ninebit::limits), written whole or not at all, frames as pictures, texels as words, and panics that do not end the program.

pub mod catch_panic;
pub mod files;
pub mod output;
pub mod picture;
pub mod read;
pub mod texels;
