//! Tests how DDS files are read, and the errors for those with false headers.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::dds;

use dds::*;
use ninebit::state::TextureFormat;
use ninebit_scene::dds::{Dds, decode};
use ninebit_scene::image::{Contents, ImageError, ImageLimits, open};
use proptest::prelude::*;
use std::path::Path;

fn read(file: &File) -> Result<Dds, ImageError> {
    decode(&file.bytes(), Path::new("rock.dds"), &ImageLimits::default())
}

/// Returns the code and the text of the error.
fn refused(file: &File) -> String {
    let error = read(file).expect_err("must be refused");
    assert!(!error.help().is_empty());
    format!("{}: {error}", error.code())
}

#[test]
fn masks_say_the_format() {
    use TextureFormat::*;
    for (flags, bits, masks, format) in [
        (0x41, 32, [0xff_0000, 0xff00, 0xff, 0xff00_0000], A8R8G8B8),
        (0x40, 32, [0xff_0000, 0xff00, 0xff, 0], X8R8G8B8),
        // The flag decides whether there is an alpha channel, even if there is a mask for it.
        (0x40, 32, [0xff_0000, 0xff00, 0xff, 0xff00_0000], X8R8G8B8),
        (0x41, 32, [0xff, 0xff00, 0xff_0000, 0xff00_0000], A8B8G8R8),
        (0x41, 32, [0xff00, 0xff_0000, 0xff00_0000, 0xff], B8G8R8A8),
        (0x41, 32, [0xff00_0000, 0xff_0000, 0xff00, 0xff], R8G8B8A8),
        (0x40, 16, [0xf800, 0x7e0, 0x1f, 0], R5G6B5),
        (0x40, 16, [0xfc00, 0x3e0, 0x1f, 0], R6G5B5),
        (0x40, 16, [0x7c00, 0x3e0, 0x1f, 0], X1R5G5B5),
        (0x41, 16, [0x7c00, 0x3e0, 0x1f, 0x8000], A1R5G5B5),
        (0x41, 16, [0xf00, 0xf0, 0xf, 0xf000], A4R4G4B4),
        (0x2_0000, 8, [0xff, 0, 0, 0], L8),
        (0x2_0001, 16, [0xff, 0, 0, 0xff00], A8L8),
        (0x2_0000, 16, [0xffff, 0, 0, 0], Y16),
        (0x2, 8, [0, 0, 0, 0xff], A8),
    ] {
        let texels: Vec<u8> = (1..=bits as u8 / 8 * 2).collect();
        let image = read(&File::plain((flags, bits, masks), 2, 1, 1, texels)).unwrap();
        assert_eq!((image.format, image.width, image.height, image.levels), (format, 2, 1, 1));
        let first = match bits {
            8 => 0x01,
            16 => 0x0201,
            _ => 0x0403_0201,
        };
        let ignored = if format == X8R8G8B8 { 0xff00_0000 } else { 0 };
        assert_eq!(image.words[0], first & !ignored, "{format:?}");
    }
}

#[test]
fn blocks_levels_and_faces_in_their_order() {
    let blocks: Vec<u8> = (0..8 * 3).collect();
    let image = read(&File::coded(b"DXT1", 4, 4, 3, blocks)).unwrap();
    assert_eq!((image.format, image.levels, image.cube), (TextureFormat::Dxt1, 3, false));
    // Levels of 4, 2 and 1 texels take a block each. A block has colours first, then indices, both little-endian.
    assert_eq!(image.words, [0x0302_0100, 0x0706_0504, 0x0b0a_0908, 0x0f0e_0d0c, 0x1312_1110, 0x1716_1514]);
    for (code, format) in [
        (b"DXT2", TextureFormat::Dxt3),
        (b"DXT3", TextureFormat::Dxt3),
        (b"DXT4", TextureFormat::Dxt5),
        (b"DXT5", TextureFormat::Dxt5),
    ] {
        assert_eq!(read(&File::coded(code, 8, 4, 1, vec![0; 32])).unwrap().format, format);
    }
    let cube = read(&File::plain(L8, 2, 2, 2, (0..30).collect()).with(CAPS2, CUBE)).unwrap();
    assert!(cube.cube && cube.words == (0..30).collect::<Vec<u32>>());
}

#[test]
fn numbers_of_the_further_header() {
    for (number, format, bytes) in [
        (28, TextureFormat::A8B8G8R8, 64),
        (65, TextureFormat::A8, 16),
        (71, TextureFormat::Dxt1, 8),
        (74, TextureFormat::Dxt3, 16),
        (77, TextureFormat::Dxt5, 16),
        (85, TextureFormat::R5G6B5, 32),
        (86, TextureFormat::A1R5G5B5, 32),
        (87, TextureFormat::A8R8G8B8, 64),
        (88, TextureFormat::X8R8G8B8, 64),
        (115, TextureFormat::A4R4G4B4, 32),
    ] {
        assert_eq!(read(&File::numbered(number, 3, 0, 1, 4, 4, &vec![0; bytes])).unwrap().format, format);
    }
    assert!(read(&File::numbered(71, 3, 4, 1, 4, 4, &[0; 48])).unwrap().cube);
}

#[test]
fn palettes_come_along() {
    let palette: Vec<u8> = (0..256_u32).flat_map(|n| [n as u8, 1, 2, 0x80]).collect();
    let image = read(&File::plain(P8, 2, 1, 1, [palette, vec![7, 255]].concat())).unwrap();
    assert_eq!((image.format, image.words.as_slice()), (TextureFormat::P8, &[7, 255][..]));
    let palette = image.palette.unwrap();
    assert_eq!((palette.len(), palette[7]), (256, 0x8007_0102));
}

/// Rows of 3 and 1 texels of 16 bits may be padded to 8 and 4 bytes. This is recognised by the pitch together with the length of the file.
#[test]
fn padded_rows() {
    let padded = [1, 0, 2, 0, 3, 0, 99, 99, 4, 0, 5, 0, 6, 0, 99, 99, 7, 0, 99, 99];
    let tight = [1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0, 7, 0];
    for pitch in [0, 6, 8, 1234] {
        let image = read(&File::plain(R5G6B5, 3, 2, 2, tight.to_vec()).with(PITCH, pitch)).unwrap();
        assert_eq!(image.words, [1, 2, 3, 4, 5, 6, 7], "pitch {pitch}");
    }
    let image = read(&File::plain(R5G6B5, 3, 2, 2, padded.to_vec()).with(PITCH, 8)).unwrap();
    assert_eq!(image.words, [1, 2, 3, 4, 5, 6, 7]);
    assert_eq!(
        refused(&File::plain(R5G6B5, 3, 2, 2, padded.to_vec()).with(PITCH, 6)),
        "NB0517: image `rock.dds` is damaged: it is longer than its header says: 20 bytes of texels, 14 are expected"
    );
}

#[test]
fn files_that_lie_are_refused() {
    let good = || File::plain(A8R8G8B8, 2, 2, 1, vec![0; 16]);
    let cases: &[(File, &str)] = &[
        (
            good().with(0, 123),
            "NB0517: image `rock.dds` is damaged: the sizes in its header are not those of a DDS file",
        ),
        (
            good().with(18, 0),
            "NB0517: image `rock.dds` is damaged: the sizes in its header are not those of a DDS file",
        ),
        (good().with(WIDTH, 0), "NB0517: image `rock.dds` is damaged: it is 0 x 2"),
        (good().with(HEIGHT, 0), "NB0517: image `rock.dds` is damaged: it is 2 x 0"),
        (
            good().with(WIDTH, 4),
            "NB0517: image `rock.dds` is damaged: it is cut off: 16 bytes of texels, 32 are expected",
        ),
        (
            good().with(WIDTH, 1),
            "NB0517: image `rock.dds` is damaged: it is longer than its header says: 16 bytes of texels, 8 are expected",
        ),
        (
            good().with(LEVELS, 3),
            "NB0517: image `rock.dds` is damaged: it claims 3 levels, and 2 x 2 texels have 2 at most",
        ),
        (
            good().with(LEVELS, u32::MAX),
            "NB0517: image `rock.dds` is damaged: it claims 4294967295 levels, and 2 x 2 texels have 2 at most",
        ),
        (
            good().with(LEVELS, 2),
            "NB0517: image `rock.dds` is damaged: it is cut off: 16 bytes of texels, 20 are expected",
        ),
        (
            good().with(WIDTH, u32::MAX),
            "NB0515: image `rock.dds` is 4294967295 x 2; a side may have 4096 pixels at most",
        ),
        (
            File::coded(b"DXT1", 4096, 4096, 1, vec![]),
            "NB0517: image `rock.dds` is damaged: it is cut off: 0 bytes of texels, 8388608 are expected",
        ),
        (
            good().with(WIDTH, 4096).with(HEIGHT, 4096).with(CAPS2, CUBE),
            "NB0516: image `rock.dds` decodes to 402653184 bytes; 67108864 are allowed",
        ),
        (good().with(CAPS2, 0x200), "NB0520: image `rock.dds` is a cube map without +X, -X, +Y, -Y, +Z, -Z"),
        (good().with(CAPS2, CUBE & !0x800), "NB0520: image `rock.dds` is a cube map without -X"),
        (good().with(CAPS2, CUBE & !0x8000), "NB0520: image `rock.dds` is a cube map without -Z"),
        (
            good().with(CAPS2, CUBE).with(HEIGHT, 4),
            "NB0517: image `rock.dds` is damaged: faces of a cube map are square, and it is 2 x 4",
        ),
        (good().with(CAPS2, VOLUME), "NB0517: image `rock.dds` is damaged: it has 0 layers, and 1 to 512 can be"),
        (
            good().with(PIXEL_FLAGS, 0),
            "NB0519: image `rock.dds` holds texels of 32 bits (red 0xff0000, green 0xff00, blue 0xff, alpha 0x0), which this program does not read",
        ),
        (
            File::plain((0x40, 24, [0xff_0000, 0xff00, 0xff, 0]), 2, 2, 1, vec![0; 12]),
            "NB0519: image `rock.dds` holds texels of 24 bits (red 0xff0000, green 0xff00, blue 0xff, alpha 0x0), which this program does not read",
        ),
        (
            File::plain((0x2_0000, 8, [0xf, 0, 0, 0]), 2, 2, 1, vec![0; 4]),
            "NB0519: image `rock.dds` holds texels of 8 bits (luminance 0xf, alpha 0x0), which this program does not read",
        ),
        (
            File::coded(b"YUY2", 2, 2, 1, vec![0; 8]),
            "NB0519: image `rock.dds` holds YUY2 texels, which this program does not read",
        ),
        (
            File::coded(b"UYVY", 2, 2, 1, vec![0; 8]),
            "NB0519: image `rock.dds` holds UYVY texels, which this program does not read",
        ),
        (
            File::coded(&[113, 0, 0, 0], 2, 2, 1, vec![0; 32]),
            "NB0519: image `rock.dds` holds texels of Direct3D format 113, which this program does not read",
        ),
        (
            File::coded(&[75, 0, 0, 0], 2, 2, 1, vec![0; 32]),
            "NB0519: image `rock.dds` holds depths (D24S8), which this program does not read",
        ),
        (
            File::numbered(55, 3, 0, 1, 4, 4, &[0; 32]),
            "NB0519: image `rock.dds` holds D16_UNORM texels, which this program does not read",
        ),
        (
            File::numbered(98, 3, 0, 1, 4, 4, &[0; 16]),
            "NB0519: image `rock.dds` holds BC7_UNORM texels, which this program does not read",
        ),
        (
            File::numbered(72, 3, 0, 1, 4, 4, &[0; 8]),
            "NB0519: image `rock.dds` holds BC1_UNORM_SRGB texels, which this program does not read",
        ),
        (
            File::numbered(7777, 3, 0, 1, 4, 4, &[0; 16]),
            "NB0519: image `rock.dds` holds texels of DXGI format 7777, which this program does not read",
        ),
        (
            File::numbered(71, 4, 0, 1, 4, 4, &[0; 8]),
            "NB0517: image `rock.dds` is damaged: it has 0 layers, and 1 to 512 can be",
        ),
        (
            File::numbered(71, 2, 0, 1, 4, 1, &[0; 8]),
            "NB0519: image `rock.dds` holds a texture of one dimension, which this program does not read",
        ),
        (
            File::numbered(71, 3, 0, 9, 4, 4, &[0; 72]),
            "NB0519: image `rock.dds` holds an array of 9 textures, which this program does not read",
        ),
        (File::coded(b"DX10", 4, 4, 1, vec![0; 19]), "NB0517: image `rock.dds` is damaged: the header is cut off"),
        (File::plain(P8, 1, 1, 1, vec![0; 1023]), "NB0517: image `rock.dds` is damaged: its palette is cut off"),
        (
            File::plain(P8, 2, 1, 1, vec![0; 1025]),
            "NB0517: image `rock.dds` is damaged: it is cut off: 1 bytes of texels, 2 are expected",
        ),
    ];
    for (file, said) in cases {
        assert_eq!(refused(file), *said);
    }
}

#[test]
fn cut_off_anywhere() {
    let whole = File::coded(b"DXT5", 8, 8, 4, vec![0x55; 16 * 7]).bytes();
    for length in 4..whole.len() {
        let error = decode(&whole[..length], Path::new("x"), &ImageLimits::default()).unwrap_err();
        assert_eq!(error.code(), "NB0517", "{length}");
    }
    assert!(decode(&whole, Path::new("x"), &ImageLimits::default()).is_ok());
}

#[test]
fn limits_hold_before_anything_is_made() {
    let limits = ImageLimits { maximum_side: u32::MAX, maximum_decoded_bytes: u64::MAX, maximum_file_bytes: u64::MAX };
    let file = File::plain(L8, u32::MAX, u32::MAX, 1, vec![]);
    assert_eq!(decode(&file.bytes(), Path::new("x"), &limits).unwrap_err().code(), "NB0515");
    let small = ImageLimits { maximum_decoded_bytes: 63, ..limits };
    let file = File::plain(L8, 4, 4, 1, vec![0; 16]);
    assert_eq!(decode(&file.bytes(), Path::new("x"), &small).unwrap_err().code(), "NB0516");
}

#[test]
fn a_dds_is_known_by_its_contents() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rock.png");
    std::fs::write(&path, File::plain(L8, 1, 1, 1, vec![9]).bytes()).unwrap();
    let Contents::Texture(image) = open(&path, &ImageLimits::default()).unwrap() else { panic!("a texture") };
    assert_eq!(image.words, [9]);
    std::fs::write(&path, b"DDT nothing").unwrap();
    let error = open(&path, &ImageLimits::default()).unwrap_err();
    assert_eq!((error.code(), error.to_string().ends_with("is neither a PNG, a TGA nor a DDS file")), ("NB0513", true));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]
    /// Any header yields an image with the right number of words, or an error.
    #[test]
    fn any_header_is_an_image_or_an_error(
        words in proptest::collection::vec(prop_oneof![Just(0_u32), 0..40_u32, any::<u32>()], 31),
        code in prop_oneof![Just(0_u32), Just(u32::from_le_bytes(*b"DXT1")), Just(u32::from_le_bytes(*b"DX10"))],
        sides in (0..20_u32, 0..20_u32), flags in prop_oneof![Just(4_u32), Just(0x41), Just(0x2_0000), any::<u32>()],
        rest in proptest::collection::vec(any::<u8>(), 0..1500),
    ) {
        let mut file = File { words: words.try_into().unwrap(), rest };
        (file.words[0], file.words[18], file.words[PIXEL_FLAGS], file.words[FOUR_CHARACTERS]) = (124, 32, flags, code);
        (file.words[WIDTH], file.words[HEIGHT]) = sides;
        if let Ok(image) = read(&file) {
            let (_, face) = ninebit::state::Level::chain(image.format, image.width, image.height, image.levels, false);
            let faces = if image.cube { 6 } else { image.layers.map_or(1, |layers| layers as usize) };
            prop_assert_eq!(image.words.len(), face * faces);
        }
    }
}
