//! Experiments: how exact techniques are, what they cost, and where they fail.
//!
//! * [`accuracy`]: a technique's frame against the ground truth of its scene, cause by cause.
//! * [`chart`]: speed against accuracy, measured on this machine.
//! * [`experiments`]: one parameter varied until a method fails.

pub mod accuracy;
pub mod chart;
pub mod experiments;
mod stages;
