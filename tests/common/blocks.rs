//! Compares decoders of compressed blocks.

use ninebit::random::Random;
use ninebit::state::TextureFormat;
use ninebit::texture::compressed::decode;

/// Returns the lowest and the highest difference (ours - theirs) in each channel over 200,000 random blocks. `theirs` decodes one block to
/// 4 x 4 pixels R, G, B, A.
pub fn differences(format: TextureFormat, dithered: bool, theirs: &dyn Fn(&[u8], &mut [u8])) -> [(i32, i32); 4] {
    let mut random = Random::seeded(1);
    let mut found = [(0, 0); 4];
    for _ in 0..200_000 {
        let bytes: Vec<u8> = (0..format.bytes() / 8).flat_map(|_| random.bits().to_le_bytes()).collect();
        let words: Vec<u32> = bytes.as_chunks().0.iter().map(|four| u32::from_le_bytes(*four)).collect();
        let mut decoded = [0; 64];
        theirs(&bytes, &mut decoded);
        for (n, pixel) in decoded.as_chunks::<4>().0.iter().enumerate() {
            let ours = decode(format, dithered, &words, n as u32 % 4, n as u32 / 4).bytes;
            for channel in 0..4 {
                let difference = i32::from(ours[channel]) - i32::from(pixel[channel]);
                let (low, high) = &mut found[channel];
                (*low, *high) = (difference.min(*low), difference.max(*high));
            }
        }
    }
    found
}
