//! Pictures: PNG files, and differences of two arrays.

use ninebit_files::output::{Compression, encode_png as encode};
use ninebit_report::planes::CHANNELS;
use ninebit_scene::diff::{Options, compare};
use ninebit_scene::image::{ImageLimits, Rgba, load};
use numpy::{PyArray1, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::fail::{Failure, detached, exception};

/// Returns a picture of R, G, B, A bytes, (height, width, 4).
fn rgba(py: Python<'_>, pixels: &PyReadonlyArray3<'_, u8>) -> PyResult<Rgba> {
    let shape = pixels.shape();
    let [height, width] = [shape[0], shape[1]].map(u32::try_from);
    match (width, height, pixels.as_array().to_slice()) {
        (Ok(width), Ok(height), Some(bytes)) if shape[2] == 4 && width > 0 && height > 0 => {
            let (pixels, _) = bytes.as_chunks();
            Ok(Rgba::new(width, pixels.to_vec()))
        }
        _ => {
            let help = "pass an array of uint8 in rows, columns, and the channels R, G, B, A";
            Err(exception(py, Failure::argument("this array is no picture", help)))
        }
    }
}

/// Returns a picture, uint8 of (height, width, 4), as a PNG.
#[pyfunction]
pub(crate) fn encode_png<'py>(py: Python<'py>, pixels: PyReadonlyArray3<'py, u8>) -> PyResult<Bound<'py, PyBytes>> {
    let picture = rgba(py, &pixels)?;
    let bytes = detached(py, || {
        encode(picture.width(), picture.height(), picture.pixels(), Compression::Fast)
            .map_err(|error| Failure::argument(error.to_string(), "pass a smaller picture"))
    })?;
    Ok(PyBytes::new(py, &bytes))
}

/// Reads a PNG, TGA or DDS file. Returns its width, its height, and its R, G, B, A bytes.
#[pyfunction]
pub(crate) fn read_picture<'py>(
    py: Python<'py>,
    path: std::path::PathBuf,
) -> PyResult<(u32, u32, Bound<'py, PyArray1<u8>>)> {
    let picture = detached(py, || {
        load(&path, &ImageLimits::default())
            .map_err(|error| Failure::Plain(Some(error.code()), error.to_string(), error.help().to_owned()))
    })?;
    Ok((picture.width(), picture.height(), PyArray1::from_slice(py, picture.pixels().as_flattened())))
}

/// Compares two pictures. Returns the number of differing pixels, the largest difference, and the regions of differing pixels that touch.
#[pyfunction]
pub(crate) fn difference<'py>(
    py: Python<'py>,
    a: PyReadonlyArray3<'py, u8>,
    b: PyReadonlyArray3<'py, u8>,
    ignore_alpha: bool,
    regions: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let (a, b) = (rgba(py, &a)?, rgba(py, &b)?);
    let found = detached(py, || {
        compare(&a, &b, &Options { ignore_alpha, regions })
            .map_err(|error| Failure::argument(error.to_string(), "compare pictures of one size"))
    })?;
    let dict = PyDict::new(py);
    dict.set_item("different", found.different)?;
    dict.set_item("largest", found.largest())?;
    dict.set_item("region_count", found.region_count)?;
    let regions: Vec<_> = found.regions.iter().map(|r| (r.x, r.y, r.width, r.height, r.pixels)).collect();
    dict.set_item("regions", regions)?;
    let channels: Vec<_> =
        CHANNELS.iter().zip(&found.channels).map(|(name, c)| (*name, c.different(), c.largest())).collect();
    dict.set_item("channels", channels)?;
    Ok(dict)
}
