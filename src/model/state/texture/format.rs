//! Formats of texels.

use crate::state::{DepthFormat, Profile, named};

named! {
    /// How the bits of a texel encode R, G, B, A (TEX-1 to TEX-4).
    pub enum TextureFormat {
        /// 32 bits, A in the top byte.
        A8R8G8B8,
        /// 32 bits, top byte ignored, alpha is 255.
        X8R8G8B8,
        /// 32 bits, A in the top byte, then B, G, R (nv2a).
        A8B8G8R8,
        /// 32 bits, B in the top byte, then G, R, A (nv2a).
        B8G8R8A8,
        /// 32 bits, R in the top byte, then G, B, A (nv2a).
        R8G8B8A8,
        /// 16 bits, alpha is 255.
        R5G6B5,
        /// 16 bits with 6, 5 and 5 bits a channel; alpha is 255 (nv2a).
        R6G5B5,
        /// 16 bits, top bit ignored, alpha is 255.
        X1R5G5B5,
        /// 16 bits; the top bit is alpha, 0 or 255.
        A1R5G5B5,
        /// 16 bits, 4 bits a channel.
        A4R4G4B4,
        /// Luminance byte: L, L, L, 255.
        L8,
        /// Intensity byte (the Xbox's AY8): L, L, L, L.
        I8,
        /// Alpha byte: 255, 255, 255, A.
        A8,
        /// 16 bits, A in the high byte: L, L, L, A (nv2a).
        A8L8,
        /// 16 bits, G in the high byte: R = B, A = G (nv2a).
        G8B8,
        /// 16 bits, R in the high byte: G = B, A = R (nv2a).
        R8B8,
        /// Two 16-bit halves, filtered at 16 bits and read as the bytes of A8R8G8B8 (nv2a; HILO).
        R16B16,
        /// 16 bits, filtered at 16 bits: R is 255, G the high byte, B the low byte, A is 255 (nv2a).
        Y16,
        /// Pairs of texels in 32 bits, from the lowest byte: Y, Cb, Y, Cr. A word of the state has Y, Cb and Cr of its texel from the top of 24 bits,
        /// which are read as R, G, B; Cb and Cr are those of the pair (nv2a; rectangles).
        Yuy2 = "YUY2",
        /// Pairs of texels in 32 bits, from the lowest byte: Cb, Y, Cr, Y. Words are those of YUY2 (nv2a; rectangles).
        Uyvy = "UYVY",
        /// Index byte into the unit's palette, masked to the palette's length.
        P8,
        /// Blocks of 4 x 4 texels in 8 bytes; dithered on nv2a (TEX-3, TEX-4).
        Dxt1 = "DXT1",
        /// Blocks of 4 x 4 texels in 16 bytes, with 4 bits of alpha for each texel.
        Dxt3 = "DXT3",
        /// Blocks of 4 x 4 texels in 16 bytes, with alpha interpolated between two bytes.
        Dxt5 = "DXT5",
        /// 16 bits of depth, which the unit compares (SHD-1; nv2a).
        Z16,
        /// 24 bits of depth above eight ignored bits, which the unit compares (SHD-1; nv2a).
        Z24S8,
        /// A float depth of 16 bits, which the unit compares (SHD-1; nv2a).
        Z16F,
        /// A float depth of 24 bits above eight ignored bits, which the unit compares (SHD-1; nv2a).
        Z24S8F,
    }
}

impl TextureFormat {
    /// Returns whether texels have their own alpha.
    pub fn has_alpha(self) -> bool {
        !matches!(
            self,
            TextureFormat::X8R8G8B8
                | TextureFormat::R5G6B5
                | TextureFormat::R6G5B5
                | TextureFormat::X1R5G5B5
                | TextureFormat::L8
                | TextureFormat::Y16
                | TextureFormat::Yuy2
                | TextureFormat::Uyvy
        ) && self.depth().is_none()
    }

    /// Returns the depth format of texels that are depths, which a unit compares (SHD-1); `None` for colours.
    #[inline(always)]
    pub fn depth(self) -> Option<DepthFormat> {
        match self {
            TextureFormat::Z16 => Some(DepthFormat::Z16),
            TextureFormat::Z24S8 => Some(DepthFormat::Z24S8),
            TextureFormat::Z16F => Some(DepthFormat::Z16F),
            TextureFormat::Z24S8F => Some(DepthFormat::Z24S8F),
            _ => None,
        }
    }

    /// Returns whether texels lie in pairs, whose chroma they share.
    pub fn is_paired(self) -> bool {
        matches!(self, TextureFormat::Yuy2 | TextureFormat::Uyvy)
    }

    /// Returns the bytes of one texel in memory, or of one block of a compressed format.
    pub fn bytes(self) -> u32 {
        match self {
            TextureFormat::Dxt3 | TextureFormat::Dxt5 => 16,
            TextureFormat::Dxt1 => 8,
            TextureFormat::A8R8G8B8
            | TextureFormat::X8R8G8B8
            | TextureFormat::A8B8G8R8
            | TextureFormat::B8G8R8A8
            | TextureFormat::R8G8B8A8
            | TextureFormat::R16B16
            | TextureFormat::Z24S8
            | TextureFormat::Z24S8F => 4,
            TextureFormat::R5G6B5
            | TextureFormat::R6G5B5
            | TextureFormat::X1R5G5B5
            | TextureFormat::A1R5G5B5
            | TextureFormat::A4R4G4B4
            | TextureFormat::A8L8
            | TextureFormat::G8B8
            | TextureFormat::R8B8
            | TextureFormat::Y16
            | TextureFormat::Yuy2
            | TextureFormat::Uyvy
            | TextureFormat::Z16
            | TextureFormat::Z16F => 2,
            TextureFormat::L8 | TextureFormat::I8 | TextureFormat::A8 | TextureFormat::P8 => 1,
        }
    }

    /// Returns the bits of a word, of which each texel has one, or each block two (DXT1) or four.
    pub fn word_bits(self) -> u32 {
        if self.is_paired() { 24 } else { 8 * self.bytes().min(4) }
    }

    /// Returns whether texels are stored in compressed blocks of 4 x 4.
    pub fn is_compressed(self) -> bool {
        matches!(self, TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5)
    }

    /// Returns whether only nv2a has the format.
    pub fn is_nv2a_only(self) -> bool {
        matches!(
            self,
            TextureFormat::A8B8G8R8
                | TextureFormat::B8G8R8A8
                | TextureFormat::R8G8B8A8
                | TextureFormat::R6G5B5
                | TextureFormat::A8L8
                | TextureFormat::G8B8
                | TextureFormat::R8B8
                | TextureFormat::R16B16
                | TextureFormat::Y16
                | TextureFormat::Yuy2
                | TextureFormat::Uyvy
        ) || self.depth().is_some()
    }

    /// Returns whether the chip has a linear layout of the format, which rectangle textures need.
    pub fn is_linear(self, profile: Profile) -> bool {
        match profile {
            Profile::Nv2a => self != TextureFormat::P8 && !self.is_compressed(),
            Profile::Nv10 => matches!(
                self,
                TextureFormat::A1R5G5B5 | TextureFormat::R5G6B5 | TextureFormat::A8R8G8B8 | TextureFormat::I8
            ),
        }
    }

    /// Returns the number of words of a level of this size: one for each texel of any size, two (DXT1) or four for each
    /// block.
    pub fn words(self, width: u32, height: u32) -> usize {
        if self.is_compressed() {
            (self.bytes() / 4 * width.div_ceil(4) * height.div_ceil(4)) as usize
        } else {
            width as usize * height as usize
        }
    }
}
