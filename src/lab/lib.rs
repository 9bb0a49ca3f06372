//! Experiments: the accuracy of techniques, their cost, and their limits.
//!
//! * [`accuracy`]: a technique's frame against the ground truth of its scene, with the error by cause.
//! * [`chart`]: speed against accuracy, measured on this machine.
//! * [`experiments`]: one parameter varied until a method fails.

pub mod accuracy;
pub mod chart;
pub mod experiments;
mod stages;
