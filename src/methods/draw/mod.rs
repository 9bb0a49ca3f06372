//! A draw of the log as a draw of a scene.

pub(crate) mod raster;
pub(crate) mod shader;
pub(crate) mod surface;
pub(crate) mod texture;
pub(crate) mod vertices;
pub(crate) mod view;
