//! Files are read within [limits](ninebit::limits) and written as a whole or not at all. Besides: pictures, texels, and panics that do not end
//! the program.

pub mod catch_panic;
pub mod files;
pub mod output;
pub mod picture;
pub mod read;
pub mod texels;
