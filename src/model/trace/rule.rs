//! What an observer is told without words: which rule yielded a value, which decision was taken, how much work was done.

use crate::number::Part;
use crate::state::named;

named! {
    /// The rules that can move a value away from the ideal, by the ids of `docs/numerics.md`.
    pub enum Rule =>
    /// The part that the rule's error counts in.
    part: Part {
        /// Vertex colours given as floats.
        Num4 = "NUM-4" => Part::Interpolation,
        /// Fog factors.
        Num6 = "NUM-6" => Part::Interpolation,
        /// Linear fog: the light unit's part, the line, and the byte made of its factor.
        Fog2 = "FOG-2" => Part::Interpolation,
        /// Exponential fog: the light unit's part and the table.
        Fog4 = "FOG-4" => Part::Interpolation,
        /// Interpolated colours.
        Int2 = "INT-2" => Part::Interpolation,
        /// Texture coordinates, as the weights of the filter.
        Int4 = "INT-4" => Part::Interpolation,
        /// Texture coordinates that are divided by q.
        Tex15 = "TEX-15" => Part::Interpolation,
        /// Texture coordinates on a face of a cube map.
        Tex12 = "TEX-12" => Part::Interpolation,
        /// Dependent coordinates of the dot unit, as the weights of the filter.
        Tsh4 = "TSH-4" => Part::Interpolation,
        /// The same of dependent reads by bytes.
        Tsh6 = "TSH-6" => Part::Interpolation,
        /// Texture coordinates moved by a bump environment map.
        Tsh7 = "TSH-7" => Part::Interpolation,
        /// Luminance.
        Tsh8 = "TSH-8" => Part::Filtering,
        /// Coordinates as colours.
        Tsh9 = "TSH-9" => Part::Interpolation,
        /// Texels of few bits, and bytes of 16-bit halves.
        Tex1 = "TEX-1" => Part::Filtering,
        /// Compressed texels.
        Tex2 = "TEX-2" => Part::Filtering,
        /// DXT1, dithered.
        Tex3 = "TEX-3" => Part::Filtering,
        /// DXT1 in few bits.
        Tex4 = "TEX-4" => Part::Filtering,
        /// The weight of a level.
        Tex9 = "TEX-9" => Part::Filtering,
        /// One linear step of the filter.
        Tex6 = "TEX-6" => Part::Filtering,
        /// The weight of a tap.
        Tex17 = "TEX-17" => Part::Filtering,
        /// Signed texels, filtered.
        Tex18 = "TEX-18" => Part::Filtering,
        /// Unsigned mappings.
        Cmb2 = "CMB-2" => Part::Expansion,
        /// Expand mappings.
        Cmb3 = "CMB-3" => Part::Expansion,
        /// Half-bias mappings.
        Cmb4 = "CMB-4" => Part::Expansion,
        /// Signed mappings.
        Cmb5 = "CMB-5" => Part::Expansion,
        /// Products.
        Cmb6 = "CMB-6" => Part::Product,
        /// Sums of products.
        Cmb7 = "CMB-7" => Part::Product,
        /// Dot products.
        Cmb8 = "CMB-8" => Part::Product,
        /// Bias and scale.
        Cmb9 = "CMB-9" => Part::Product,
        /// Saturation.
        Num3 = "NUM-3" => Part::Product,
        /// The final lerp.
        Fin2 = "FIN-2" => Part::Product,
        /// E times F.
        Fin4 = "FIN-4" => Part::Product,
        /// Blend equations.
        Rop2 = "ROP-2" => Part::Store,
        /// What a surface keeps.
        Rop5 = "ROP-5" => Part::Store,
    }
}

named! {
    /// Something that is decided and not computed.
    pub enum Decision {
        /// Which pixels a triangle covers.
        Coverage = "coverage",
        /// Which face of a cube map.
        Face = "face",
        /// Which filter and levels.
        Level = "level",
        /// Which layer of a volume.
        Layer = "layer",
        /// Which texels are read.
        Texel = "texel",
        /// Which texel a dependent read is sent to.
        Dependent = "dependent texel",
        /// What the texture shader drops.
        Kill = "texture shader",
        /// What a mux takes.
        Mux = "mux",
        /// What a depth texture's comparison yields.
        Shadow = "shadow comparison",
        /// The alpha test.
        AlphaTest = "alpha test",
        /// The depth test.
        DepthTest = "depth test",
        /// The sign of a source byte (ROP-3).
        Sign = "sign of a source",
    }
}

named! {
    /// Work that is counted.
    pub enum Work {
        /// Texels looked up, border colours included.
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
