//! Tests reading of image files, well-formed and broken.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

use ninebit_files::output::{Compression, encode_png};
use ninebit_scene::image::{ImageError, ImageLimits, Rgba, decode, load};
use proptest::prelude::*;

/// Returns the CRC-32 that ends every chunk of a PNG.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { (c >> 1) ^ 0xedb8_8320 } else { c >> 1 })
    })
}

fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let body = [kind.as_slice(), data].concat();
    [&(data.len() as u32).to_be_bytes()[..], &body, &crc32(&body).to_be_bytes()].concat()
}

fn header(width: u32, height: u32, depth: u8, color_type: u8) -> Vec<u8> {
    let fields = [&width.to_be_bytes()[..], &height.to_be_bytes(), &[depth, color_type, 0, 0, 0]].concat();
    chunk(b"IHDR", &fields)
}

fn png(chunks: &[Vec<u8>]) -> Vec<u8> {
    [b"\x89PNG\r\n\x1a\n".to_vec(), chunks.concat()].concat()
}

/// Two zero bytes, compressed: a filter byte, and one pixel whose index or grey is 0.
const TWO_ZEROS: [u8; 10] = [0x78, 0x9c, 0x63, 0x60, 0x00, 0x00, 0x00, 0x02, 0x00, 0x01];

fn end() -> Vec<u8> {
    chunk(b"IEND", &[])
}

fn tga(kind: u8, width: u16, height: u16, bits: u8, descriptor: u8, data: &[u8]) -> Vec<u8> {
    let [w, h] = [width, height].map(u16::to_le_bytes);
    [&[0, 0, kind, 0, 0, 0, 0, 0, 0, 0, 0, 0, w[0], w[1], h[0], h[1], bits, descriptor][..], data].concat()
}

fn decode_as(name: &str, bytes: &[u8]) -> Result<Rgba, ImageError> {
    decode(bytes, Path::new(name), &ImageLimits::default())
}

fn code(result: Result<Rgba, ImageError>) -> &'static str {
    let error = result.expect_err("must be refused");
    assert!(!error.to_string().is_empty() && !error.help().is_empty());
    error.code()
}

#[test]
fn pngs_of_every_kind_become_rgba() {
    let pixels = [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12], [0, 0, 0, 0], [255, 255, 255, 255], [128, 1, 128, 0]];
    let file = encode_png(3, 2, &pixels, Compression::Small).unwrap();
    let image = decode_as("any name", &file).unwrap();
    assert_eq!((image.width(), image.height(), image.pixels()), (3, 2, &pixels[..]));

    let grey = png(&[header(1, 1, 8, 0), chunk(b"IDAT", &TWO_ZEROS), end()]);
    assert_eq!(decode_as("x", &grey).unwrap().pixels(), [[0, 0, 0, 255]]);
    let palette = chunk(b"PLTE", &[10, 20, 30]);
    let indexed = png(&[header(1, 1, 8, 3), palette.clone(), chunk(b"IDAT", &TWO_ZEROS), end()]);
    assert_eq!(decode_as("x", &indexed).unwrap().pixels(), [[10, 20, 30, 255]]);
    let transparent = png(&[header(1, 1, 8, 3), palette, chunk(b"tRNS", &[99]), chunk(b"IDAT", &TWO_ZEROS), end()]);
    assert_eq!(decode_as("x", &transparent).unwrap().pixels(), [[10, 20, 30, 99]]);
}

#[test]
fn gamma_and_profiles_change_nothing_and_are_never_unpacked() {
    let grey = png(&[
        header(1, 1, 8, 0),
        chunk(b"gAMA", &[0, 0, 0, 1]),
        chunk(b"iCCP", b"p\0\0not a compressed profile"),
        chunk(b"zTXt", b"k\0\0not compressed text"),
        chunk(b"IDAT", &TWO_ZEROS),
        end(),
    ]);
    assert_eq!(decode_as("x", &grey).unwrap().pixels(), [[0, 0, 0, 255]]);
}

#[test]
fn a_palette_of_four_bytes_is_refused_without_a_panic() {
    let file = png(&[header(1, 1, 8, 3), chunk(b"PLTE", &[0, 255, 0, 0x1c]), chunk(b"IDAT", &TWO_ZEROS), end()]);
    assert_eq!(file.len(), 83);
    let error = decode_as("x.png", &file).expect_err("must be refused");
    assert_eq!(error.code(), "NB0517");
    assert!(error.to_string().contains("palette"), "{error}");
    for length in [0, 1, 2, 767, 769, 771] {
        let file = png(&[header(1, 1, 8, 3), chunk(b"PLTE", &vec![0; length]), chunk(b"IDAT", &TWO_ZEROS), end()]);
        assert_eq!(code(decode_as("x.png", &file)), "NB0517", "{length}");
    }
}

#[test]
fn headers_are_held_against_the_limits_before_anything_is_decoded() {
    let huge = png(&[header(100_000, 100_000, 8, 6), chunk(b"IDAT", &TWO_ZEROS[..8]), end()]);
    assert_eq!(huge.len(), 65);
    let error = decode_as("x.png", &huge).expect_err("must be refused");
    assert!(error.is_limit() && error.code() == "NB0515", "{error}");
    let wide = tga(2, 65_535, 65_535, 32, 0, &[]);
    assert_eq!(code(decode_as("x.tga", &wide)), "NB0515");
    let narrow = ImageLimits { maximum_decoded_bytes: 3, ..ImageLimits::default() };
    let grey = png(&[header(1, 1, 8, 0), chunk(b"IDAT", &TWO_ZEROS), end()]);
    assert_eq!(code(decode(&grey, Path::new("x"), &narrow)), "NB0516");
    assert_eq!(code(decode_as("x.png", &png(&[header(0, 1, 8, 0), end()]))), "NB0517");
    assert_eq!(code(decode_as("x.tga", &tga(2, 0, 1, 32, 0, &[]))), "NB0517");
}

#[test]
fn sixteen_bits_are_refused() {
    let file = png(&[header(1, 1, 16, 0), chunk(b"IDAT", &TWO_ZEROS), end()]);
    assert_eq!(code(decode_as("x.png", &file)), "NB0518");
}

#[test]
fn every_truncation_is_an_error() {
    let pixels: Vec<[u8; 4]> = (0..64u8).map(|i| [i, i.wrapping_mul(37), 255 - i, i]).collect();
    let file = encode_png(8, 8, &pixels, Compression::Small).unwrap();
    // The last twelve bytes are the end chunk, which may be missing.
    for length in 0..file.len() - 12 {
        let result = decode_as("x.png", &file[..length]);
        assert!(["NB0513", "NB0517"].contains(&code(result)), "{length} bytes");
    }
    let file = tga(2, 2, 2, 32, 8, &[1; 16]);
    for length in 0..file.len() {
        assert_eq!(code(decode_as("x.tga", &file[..length])), "NB0517", "{length} bytes");
    }
}

#[test]
fn structure_is_checked() {
    let end_first = png(&[end(), header(1, 1, 8, 0)]);
    let twice = png(&[header(1, 1, 8, 0), header(2, 1, 8, 0), chunk(b"IDAT", &TWO_ZEROS), end()]);
    let unknown = png(&[header(1, 1, 8, 0), chunk(b"NEED", &[]), chunk(b"IDAT", &TWO_ZEROS), end()]);
    let mut checksum = png(&[header(1, 1, 8, 0), chunk(b"IDAT", &TWO_ZEROS), end()]);
    checksum[30] ^= 1;
    for (name, file) in [("end first", end_first), ("twice", twice), ("unknown", unknown), ("checksum", checksum)] {
        assert_eq!(code(decode_as("x.png", &file)), "NB0517", "{name}");
    }
}

#[test]
fn tgas_of_every_kind_become_rgba() {
    // Texels are stored as blue, green, red, alpha. The first row is the bottom one unless bit 5 is set.
    let two_rows = [1, 2, 3, 4, 5, 6, 7, 8];
    let bottom_up = decode_as("x.TGA", &tga(2, 1, 2, 32, 8, &two_rows)).unwrap();
    assert_eq!(bottom_up.pixels(), [[7, 6, 5, 8], [3, 2, 1, 4]]);
    let top_down = decode_as("x.tga", &tga(2, 1, 2, 32, 0x28, &two_rows)).unwrap();
    assert_eq!(top_down.pixels(), [[3, 2, 1, 4], [7, 6, 5, 8]]);
    let rgb = decode_as("x.tga", &tga(2, 1, 1, 24, 0, &[1, 2, 3])).unwrap();
    assert_eq!(rgb.pixels(), [[3, 2, 1, 255]]);
    let grey = decode_as("x.tga", &tga(3, 2, 1, 8, 0, &[9, 8])).unwrap();
    assert_eq!(grey.pixels(), [[9, 9, 9, 255], [8, 8, 8, 255]]);
    let runs = decode_as("x.tga", &tga(10, 3, 1, 24, 0, &[0x81, 1, 2, 3, 0x00, 4, 5, 6])).unwrap();
    assert_eq!(runs.pixels(), [[3, 2, 1, 255], [3, 2, 1, 255], [6, 5, 4, 255]]);
    let mut mapped = tga(1, 1, 1, 8, 0, &[1, 2, 3, 4, 5, 6, 1]);
    (mapped[1], mapped[5], mapped[7]) = (1, 2, 24);
    assert_eq!(decode_as("x.tga", &mapped).unwrap().pixels(), [[6, 5, 4, 255]]);
}

#[test]
fn files_are_told_apart_by_what_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| -> PathBuf { folder.path().join(name) };
    let limits = ImageLimits::default();

    let missing = load(&place("missing.png"), &limits).expect_err("missing");
    assert!(missing.is_missing() && !missing.is_limit() && missing.code() == "NB0510");
    assert_eq!(code(load(folder.path(), &limits)), "NB0511");
    fs::write(place("empty.png"), b"").unwrap();
    assert_eq!(code(load(&place("empty.png"), &limits)), "NB0513");
    fs::write(place("empty.tga"), b"").unwrap();
    assert_eq!(code(load(&place("empty.tga"), &limits)), "NB0517");
    fs::write(place("picture.jpg"), b"\xff\xd8\xff\xe0 and so on").unwrap();
    assert_eq!(code(load(&place("picture.jpg"), &limits)), "NB0513");

    let file = encode_png(1, 1, &[[1, 2, 3, 4]], Compression::Small).unwrap();
    fs::write(place("png-inside.tga"), &file).unwrap();
    assert_eq!(load(&place("png-inside.tga"), &limits).unwrap().pixels(), [[1, 2, 3, 4]]);
    let small = ImageLimits { maximum_file_bytes: file.len() as u64 - 1, ..limits };
    let error = load(&place("png-inside.tga"), &small).expect_err("too large");
    assert!(error.is_limit() && error.code() == "NB0514");
    assert!(load(&place("png-inside.tga"), &ImageLimits { maximum_file_bytes: file.len() as u64, ..limits }).is_ok());
}

#[cfg(unix)]
#[test]
fn devices_are_not_read() {
    assert_eq!(code(load(Path::new("/dev/zero"), &ImageLimits::default())), "NB0511");
}

proptest! {
    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = decode_as("x.png", &bytes);
        let _ = decode_as("x.tga", &bytes);
        let _ = decode_as("x.png", &png(&[bytes]));
    }

    #[test]
    fn damaged_pngs_never_panic(
        width in 1u32..40, height in 1u32..40, color_type in 0u8..7, depth in 0u8..17,
        palette in prop::collection::vec(any::<u8>(), 0..20), data in prop::collection::vec(any::<u8>(), 0..80),
    ) {
        let file = png(&[header(width, height, depth, color_type), chunk(b"PLTE", &palette), chunk(b"IDAT", &data), end()]);
        let _ = decode_as("x.png", &file);
    }

    #[test]
    fn damaged_tgas_never_panic(head in any::<[u8; 18]>(), data in prop::collection::vec(any::<u8>(), 0..200)) {
        let mut head = head;
        // Sizes stay small enough to be decoded.
        (head[13], head[15], head[6]) = (head[13] & 1, head[15] & 1, head[6] & 1);
        let _ = decode_as("x.tga", &[&head[..], &data].concat());
    }

    #[test]
    fn what_is_encoded_comes_back(width in 1u32..20, pixels in prop::collection::vec(any::<[u8; 4]>(), 20..60)) {
        let height = pixels.len() as u32 / width;
        let pixels = &pixels[..(width * height) as usize];
        let image = decode_as("x", &encode_png(width, height, pixels, Compression::Small).unwrap()).unwrap();
        prop_assert_eq!(image.pixels(), pixels);
    }
}
