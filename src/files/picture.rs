//! Computes digests of pictures.

use sha2::{Digest, Sha256};

use ninebit::frame::Surface;

/// Returns the digest of a surface: SHA-256, in lower-case hexadecimal, of width and height (four bytes each, little-endian) and the bytes of
/// [`Surface::rgba8`].
///
/// The digest identifies what the picture shows, independently of the surface's format and of the compression of a PNG.
pub fn surface_digest(surface: &Surface) -> String {
    digest(surface.width, surface.height, &surface.rgba8())
}

/// Returns the digest of a picture; see [`surface_digest`].
pub fn digest(width: u32, height: u32, pixels: &[[u8; 4]]) -> String {
    let mut hash = Sha256::new();
    hash.update(width.to_le_bytes());
    hash.update(height.to_le_bytes());
    hash.update(pixels.as_flattened());
    hexadecimal(&hash.finalize())
}

/// Writes bytes as two hexadecimal digits each.
pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_digest_tells_shapes_apart() {
        let pixels = vec![[1, 2, 3, 4]; 6];
        assert_ne!(digest(2, 3, &pixels), digest(3, 2, &pixels));
        // sha256sum gives this for the twelve bytes 01 00 00 00, 01 00 00 00, 00 00 00 00.
        assert_eq!(digest(1, 1, &[[0; 4]]), "7d450465ceb49083708a6970827f0e0b116ed285072a95b451e55f583f56da8d");
    }
}
