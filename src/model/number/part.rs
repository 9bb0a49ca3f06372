//! The parts of the pipeline that errors are attributed to.

use crate::state::named;

named! {
    /// The part of the pipeline where a value picks up an error.
    pub enum Part {
        /// Vertex colours, weights, coordinates, fog.
        Interpolation = "interpolation",
        /// Texels and their filters.
        Filtering = "filtering",
        /// Input mappings (CMB-2 to CMB-5).
        Expansion = "expansion",
        /// Products, sums, bias, scale, saturation, the final combiner.
        Product = "product and sum",
        /// Blending and stores.
        Store = "store",
    }
}
