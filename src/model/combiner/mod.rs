//! Register combiners: the register file, the general stages and the final combiner.

pub mod direct;
pub mod final_combiner;
pub mod general;
pub mod mapping;
pub mod output;
pub mod registers;
mod report;
