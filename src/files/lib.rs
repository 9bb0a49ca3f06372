//! Files are read within [limits](ninebit::limits) and written as a whole or not at all. Besides: pictures, texels, and panics that do not end
//! the program.

pub mod catch_panic;
mod error;
pub mod files;
pub mod leftover;
pub mod output;
pub mod pending;
pub mod picture;
pub mod read;
pub mod texels;
