//! Finds the texture format that the pixel format of a DDS file describes: its masks have to agree bit by bit.

use ninebit::state::{Named, TextureFormat};
use ninebit_files::texels::{can_pack, word};

const ALPHA_BESIDE: u32 = 0x1;
const ALPHA_ALONE: u32 = 0x2;
const FOUR_CHARACTERS: u32 = 0x4;
const PALETTE_OF_256: u32 = 0x20;
const COLORS: u32 = 0x40;
const LUMINANCE: u32 = 0x2_0000;

/// The pixel format as the header has it.
pub(super) struct PixelFormat {
    pub(super) flags: u32,
    pub(super) four_characters: [u8; 4],
    /// Number of bits of a texel.
    pub(super) bits: u32,
    /// Masks of red (or luminance), green, blue and alpha.
    pub(super) masks: [u32; 4],
}

/// Formats with their number of bits and their masks of luminance and alpha.
const BY_LUMINANCE: [(TextureFormat, u32, [u32; 2]); 3] = [
    (TextureFormat::L8, 8, [0xff, 0]),
    (TextureFormat::A8L8, 16, [0xff, 0xff00]),
    (TextureFormat::Y16, 16, [0xffff, 0]),
];

impl PixelFormat {
    /// Returns whether a second header follows, whose DXGI number tells the format.
    pub(super) fn has_further_header(&self) -> bool {
        self.flags & FOUR_CHARACTERS != 0 && self.four_characters == *b"DX10"
    }

    /// Returns the texture format; the error says what the file holds instead.
    pub(super) fn format(&self) -> Result<TextureFormat, String> {
        if self.flags & FOUR_CHARACTERS != 0 {
            return of_four_characters(self.four_characters);
        }
        let [red, green, blue, mut alpha] = self.masks;
        if self.flags & PALETTE_OF_256 != 0 && self.bits == 8 {
            return Ok(TextureFormat::P8);
        }
        if self.flags & (COLORS | LUMINANCE) == 0 && self.flags & ALPHA_ALONE != 0 && (self.bits, alpha) == (8, 0xff) {
            return Ok(TextureFormat::A8);
        }
        if self.flags & ALPHA_BESIDE == 0 {
            alpha = 0;
        }
        let known = match self.flags & (COLORS | LUMINANCE) {
            0 => None,
            COLORS => of_masks(self.bits, [red, green, blue, alpha]),
            _ => {
                let known = BY_LUMINANCE.iter().find(|(_, bits, masks)| (*bits, *masks) == (self.bits, [red, alpha]));
                known.map(|(format, ..)| *format)
            }
        };
        if let Some(format) = known {
            return Ok(format);
        }
        let of = if self.flags & LUMINANCE != 0 {
            format!("luminance {red:#x}")
        } else {
            format!("red {red:#x}, green {green:#x}, blue {blue:#x}")
        };
        Err(format!("texels of {} bits ({of}, alpha {alpha:#x})", self.bits))
    }
}

/// Returns the first format of so many bits that keeps red, green, blue and alpha in these.
fn of_masks(bits: u32, masks: [u32; 4]) -> Option<TextureFormat> {
    let full = |n: usize| std::array::from_fn(|channel| if channel == n { 255 } else { 0 });
    let stores = |format: TextureFormat| [0, 1, 2, 3].map(|n| word(full(n), format));
    let has_colors = !masks[..3].contains(&0);
    let is_packable = |format: &TextureFormat| has_colors && can_pack(*format) && !format.is_paired();
    let mut packable = TextureFormat::ALL.iter().copied().filter(is_packable);
    packable.find(|format| 8 * format.bytes() == bits && stores(*format) == masks)
}

fn of_four_characters(text: [u8; 4]) -> Result<TextureFormat, String> {
    match &text {
        b"DXT1" => Ok(TextureFormat::Dxt1),
        // The blocks are the same. Colours were multiplied by alpha beforehand, which is up to whoever uses them.
        b"DXT2" | b"DXT3" => Ok(TextureFormat::Dxt3),
        b"DXT4" | b"DXT5" => Ok(TextureFormat::Dxt5),
        _ if text.iter().all(u8::is_ascii_graphic) => Err(format!("{} texels", text.escape_ascii())),
        _ => {
            let number = u32::from_le_bytes(text);
            Err(match DEPTHS.iter().find(|(known, _)| *known == number) {
                Some((_, name)) => format!("depths ({name})"),
                None => format!("texels of Direct3D format {number}"),
            })
        }
    }
}

/// Returns the texture format of a DXGI number; the error says what the file holds instead.
pub(super) fn of_number(number: u32) -> Result<TextureFormat, String> {
    Ok(match number {
        28 => TextureFormat::A8B8G8R8,
        65 => TextureFormat::A8,
        71 => TextureFormat::Dxt1,
        74 => TextureFormat::Dxt3,
        77 => TextureFormat::Dxt5,
        85 => TextureFormat::R5G6B5,
        86 => TextureFormat::A1R5G5B5,
        87 => TextureFormat::A8R8G8B8,
        88 => TextureFormat::X8R8G8B8,
        115 => TextureFormat::A4R4G4B4,
        _ => {
            return Err(match REFUSED.iter().find(|(known, _)| *known == number) {
                Some((_, name)) => format!("{name} texels"),
                None => format!("texels of DXGI format {number}"),
            });
        }
    })
}

/// Direct3D's numbers of depth formats, which make shadow maps: a texture unit compares with them.
const DEPTHS: [(u32, &str); 7] =
    [(70, "D16_LOCKABLE"), (71, "D32"), (73, "D15S1"), (75, "D24S8"), (77, "D24X8"), (79, "D24X4S4"), (80, "D16")];

/// Names of DXGI formats that are often met and not supported.
const REFUSED: [(u32, &str); 15] = [
    (2, "R32G32B32A32_FLOAT"),
    (10, "R16G16B16A16_FLOAT"),
    (29, "R8G8B8A8_UNORM_SRGB"),
    (40, "D32_FLOAT"),
    (45, "D24_UNORM_S8_UINT"),
    (55, "D16_UNORM"),
    (72, "BC1_UNORM_SRGB"),
    (75, "BC2_UNORM_SRGB"),
    (78, "BC3_UNORM_SRGB"),
    (80, "BC4_UNORM"),
    (83, "BC5_UNORM"),
    (91, "B8G8R8A8_UNORM_SRGB"),
    (95, "BC6H_UF16"),
    (98, "BC7_UNORM"),
    (107, "YUY2"),
];
