//! The cheap reports to an observer: the rule that yielded a value, the decision that was taken, the work that was
//! done.

use crate::number::Part;
use crate::state::named;

named! {
    /// The rules by which a value can deviate from the ideal, with the ids of `docs/rules`.
    pub enum Rule =>
    /// Returns the part of the pipeline that the rule's error is attributed to.
    part: Part {
        /// Vertex colours given as floats.
        Num4 = "NUM-4" => Part::Interpolation,
        /// Bytes of fog factors.
        Num6 = "NUM-6" => Part::Interpolation,
        /// Linear fog: the numbers of the light unit, the linear function, and the byte of its factor.
        Fog2 = "FOG-2" => Part::Interpolation,
        /// Exponential fog: the numbers of the light unit, and the table.
        Fog4 = "FOG-4" => Part::Interpolation,
        /// Interpolated vertex colours.
        Int2 = "INT-2" => Part::Interpolation,
        /// The alpha of smooth edges.
        Smo1 = "SMO-1" => Part::Interpolation,
        /// Vertex colours where smooth edges do not cover the centre.
        Smo2 = "SMO-2" => Part::Interpolation,
        /// Texture coordinates, as weights of the filter.
        Int4 = "INT-4" => Part::Interpolation,
        /// Texture coordinates that are divided by q.
        Tex15 = "TEX-15" => Part::Interpolation,
        /// Texture coordinates on a face of a cube map.
        Tex12 = "TEX-12" => Part::Interpolation,
        /// Texture coordinates on an image of another kind than the stage's.
        Tex20 = "TEX-20" => Part::Interpolation,
        /// Dependent coordinates from the dot unit, as weights of the filter.
        Tsh4 = "TSH-4" => Part::Interpolation,
        /// Dependent coordinates from bytes, as weights of the filter.
        Tsh6 = "TSH-6" => Part::Interpolation,
        /// Texture coordinates displaced by a bump environment map.
        Tsh7 = "TSH-7" => Part::Interpolation,
        /// Luminance of a bump environment map.
        Tsh8 = "TSH-8" => Part::Filtering,
        /// Texture coordinates as colours.
        Tsh9 = "TSH-9" => Part::Interpolation,
        /// Texels of few bits, and bytes of 16-bit halves.
        Tex1 = "TEX-1" => Part::Filtering,
        /// Texels of compressed formats.
        Tex2 = "TEX-2" => Part::Filtering,
        /// DXT1 with dither.
        Tex3 = "TEX-3" => Part::Filtering,
        /// DXT1 mixed in few bits.
        Tex4 = "TEX-4" => Part::Filtering,
        /// The weight of the second level.
        Tex9 = "TEX-9" => Part::Filtering,
        /// One linear step of the filter.
        Tex6 = "TEX-6" => Part::Filtering,
        /// The weight of an anisotropic tap.
        Tex17 = "TEX-17" => Part::Filtering,
        /// Signed texels after filtering.
        Tex18 = "TEX-18" => Part::Filtering,
        /// Colours that are converted from YUV.
        Tex19 = "TEX-19" => Part::Filtering,
        /// The unsigned input mappings.
        Cmb2 = "CMB-2" => Part::Expansion,
        /// The expand input mappings.
        Cmb3 = "CMB-3" => Part::Expansion,
        /// The half-bias input mappings.
        Cmb4 = "CMB-4" => Part::Expansion,
        /// The signed input mappings.
        Cmb5 = "CMB-5" => Part::Expansion,
        /// Products of two inputs.
        Cmb6 = "CMB-6" => Part::Product,
        /// Sums of products.
        Cmb7 = "CMB-7" => Part::Product,
        /// Sums of three products.
        Cmb8 = "CMB-8" => Part::Product,
        /// Bias and scale.
        Cmb9 = "CMB-9" => Part::Product,
        /// The limits of a register.
        Num3 = "NUM-3" => Part::Product,
        /// The linear interpolation of the final combiner.
        Fin2 = "FIN-2" => Part::Product,
        /// E times F in the final combiner.
        Fin4 = "FIN-4" => Part::Product,
        /// The blend equations and their rounding.
        Rop2 = "ROP-2" => Part::Store,
        /// The bits that a surface keeps.
        Rop5 = "ROP-5" => Part::Store,
    }
}

named! {
    /// A value that is decided rather than computed.
    pub enum Decision {
        /// Which pixels a triangle covers.
        Coverage = "coverage",
        /// Which face of a cube map is sampled.
        Face = "face",
        /// Which filter and levels are used.
        Level = "level",
        /// Which layer of a volume is read.
        Layer = "layer",
        /// Which texels are read.
        Texel = "texel",
        /// Which texel a dependent read addresses.
        Dependent = "dependent texel",
        /// Which fragments the texture shader drops.
        Kill = "texture shader",
        /// Which product a mux selects.
        Mux = "mux",
        /// The result of comparing with a depth texture.
        Shadow = "shadow comparison",
        /// The result of the alpha test.
        AlphaTest = "alpha test",
        /// The result of the depth test.
        DepthTest = "depth test",
        /// The sign of a source byte (ROP-3).
        Sign = "sign of a source",
    }
}

named! {
    /// A kind of work that is counted.
    pub enum Work {
        /// Texels that are looked up, including border colours.
        Texels = "texels",
        /// Linear steps of filters.
        Lerps = "filter steps",
        /// Products of general stages and of the final combiner.
        Products = "products",
        /// Roundings to 255ths.
        Roundings = "roundings",
        /// Products and sums of the dot unit in single precision (TSH-4, TSH-5).
        Dots = "dot operations",
        /// Channels that are blended with the surface.
        Blends = "blended channels",
        /// Bytes of colour read from surfaces.
        BytesRead = "bytes read",
        /// Bytes of colour written to surfaces.
        BytesWritten = "bytes written",
    }
}
