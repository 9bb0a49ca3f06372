//! The parts that errors are told apart by.

use crate::state::named;

named! {
    /// Where on its way a value picks up an error.
    pub enum Part {
        /// Vertex colours, weights, coordinates, fog.
        Interpolation = "interpolation",
        /// Texels and their filter.
        Filtering = "filtering",
        /// Input mappings (CMB-2 to CMB-5).
        Expansion = "expansion",
        /// Products, sums, bias, scale, saturation, the final combiner.
        Product = "product and sum",
        /// Blend and store.
        Store = "store",
    }
}
