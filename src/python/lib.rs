//! The native part of the Python package `ninebit`. It passes texts, bytes and arrays; the package makes classes of them.

mod evaluate;
mod fail;
mod picture;
mod scene;
mod units;

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the program with these arguments, the first of which is its name. Returns the exit status.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| ninebit::run(&arguments))
}

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::evaluate::evaluate;
    #[pymodule_export]
    use super::main;
    #[pymodule_export]
    use super::picture::{difference, encode_png, read_picture};
    #[pymodule_export]
    use super::scene::{Scene, policies, scene_text, value_text};
    #[pymodule_export]
    use super::units::{unit, unit_names};
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
