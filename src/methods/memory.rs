//! An image of the console's memory, and how textures lie in it.

use ninebit::state::TextureFormat;

/// Bytes of memory that a console has; development kits have twice as much.
pub const LARGEST_MEMORY: u64 = 128 << 20;

/// An image of memory from address 0.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    bytes: Vec<u8>,
}

impl Memory {
    /// Makes memory of an image.
    pub fn new(bytes: Vec<u8>) -> Memory {
        Memory { bytes }
    }

    /// Returns whether there is none.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Returns the number of bytes.
    pub fn len(&self) -> usize {
        self.bytes.len()
    }

    /// Returns `count` bytes at an address; `None` if some lie outside.
    pub fn slice(&self, address: u64, count: u64) -> Option<&[u8]> {
        let (first, end) = (usize::try_from(address).ok()?, usize::try_from(address.checked_add(count)?).ok()?);
        self.bytes.get(first..end)
    }

    /// Returns the word at an address.
    pub fn word(&self, address: u64) -> Option<u32> {
        Some(u32::from_le_bytes(self.slice(address, 4)?.try_into().ok()?))
    }
}

/// Returns the place of a texel in a swizzled image whose sides are 2^`logarithms`: the bits of the coordinates alternate, the first coordinate's
/// lowest, as long as a coordinate has bits.
pub fn swizzled(coordinates: [u32; 3], logarithms: [u32; 3]) -> u64 {
    let (mut place, mut bit) = (0, 0);
    for level in 0..logarithms.into_iter().max().unwrap_or(0) {
        for (coordinate, logarithm) in coordinates.into_iter().zip(logarithms) {
            if level < logarithm {
                place |= u64::from(coordinate >> level & 1) << bit;
                bit += 1;
            }
        }
    }
    place
}

/// How texels lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// By the bits of their coordinates.
    Swizzled,
    /// Row after row, each so many bytes behind the one before.
    Pitch(u32),
}

/// Returns the words of an image row after row, each texel or part of a block as [`Texels::words`](ninebit::state::Texels::words) has it; `None` if
/// memory does not hold it whole. `size` has columns, rows and layers.
pub fn words(
    memory: &Memory,
    address: u64,
    format: TextureFormat,
    [width, height, depth]: [u32; 3],
    layout: Layout,
) -> Option<Vec<u32>> {
    let bytes = u64::from(format.bytes());
    if format.is_compressed() {
        let blocks = u64::from(width.div_ceil(4)) * u64::from(height.div_ceil(4)) * u64::from(depth);
        let bytes = memory.slice(address, blocks * bytes)?;
        return Some(
            bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect(),
        );
    }
    let texels = u64::from(width) * u64::from(height) * u64::from(depth);
    let extent = match layout {
        Layout::Swizzled => texels * bytes,
        Layout::Pitch(pitch) => {
            (u64::from(height) * u64::from(depth)).checked_sub(1)? * u64::from(pitch) + u64::from(width) * bytes
        }
    };
    let image = memory.slice(address, extent)?;
    let logarithms = [width, height, depth].map(u32::ilog2);
    let mut words = Vec::with_capacity(texels as usize);
    for z in 0..depth {
        for y in 0..height {
            for x in 0..width {
                let at = match layout {
                    Layout::Swizzled => swizzled([x, y, z], logarithms) * bytes,
                    Layout::Pitch(pitch) => u64::from(z * height + y) * u64::from(pitch) + u64::from(x) * bytes,
                } as usize;
                words.push(
                    image[at..at + bytes as usize].iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte)),
                );
            }
        }
    }
    Some(words)
}

/// Returns the bytes of an image as [`words`] reads them, the reverse.
pub fn bytes(words: &[u32], format: TextureFormat, [width, height, depth]: [u32; 3], layout: Layout) -> Vec<u8> {
    if format.is_compressed() {
        return words.iter().flat_map(|word| word.to_le_bytes()).collect();
    }
    let bytes = format.bytes() as usize;
    let extent = match layout {
        Layout::Swizzled => width as usize * height as usize * depth as usize * bytes,
        Layout::Pitch(pitch) => height as usize * depth as usize * pitch as usize,
    };
    let mut image = vec![0; extent];
    let logarithms = [width, height, depth].map(u32::ilog2);
    let mut words = words.iter();
    for z in 0..depth {
        for y in 0..height {
            for x in 0..width {
                let at = match layout {
                    Layout::Swizzled => swizzled([x, y, z], logarithms) as usize * bytes,
                    Layout::Pitch(pitch) => (z * height + y) as usize * pitch as usize + x as usize * bytes,
                };
                if let Some(word) = words.next() {
                    image[at..at + bytes].copy_from_slice(&word.to_le_bytes()[..bytes]);
                }
            }
        }
    }
    image
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn swizzles_alternate_while_there_are_bits() {
        assert_eq!([[0, 0, 0], [1, 0, 0], [0, 1, 0], [3, 3, 0]].map(|at| swizzled(at, [2, 2, 0])), [0, 1, 2, 15]);
        // 8 x 2: the third bit of x stands alone.
        assert_eq!([[1, 0, 0], [0, 1, 0], [2, 0, 0], [4, 0, 0]].map(|at| swizzled(at, [3, 1, 0])), [1, 2, 4, 8]);
        assert_eq!([[1, 0, 0], [0, 1, 0], [0, 0, 1], [2, 0, 0]].map(|at| swizzled(at, [2, 2, 2])), [1, 2, 4, 8]);
        for logarithms in [[3, 0, 0], [0, 3, 0], [2, 4, 0], [3, 1, 2], [1, 1, 1]] {
            let [w, h, d] = logarithms.map(|n: u32| 1_u32 << n);
            let mut places: Vec<u64> =
                (0..w * h * d).map(|n| swizzled([n % w, n / w % h, n / w / h], logarithms)).collect();
            places.sort_unstable();
            assert!(places.iter().copied().eq(0..u64::from(w * h * d)), "{logarithms:?}");
        }
    }

    #[test]
    fn images_go_there_and_back() {
        let cases = [
            (TextureFormat::A8R8G8B8, [8, 4, 1], Layout::Swizzled),
            (TextureFormat::R5G6B5, [4, 16, 1], Layout::Swizzled),
            (TextureFormat::L8, [4, 4, 4], Layout::Swizzled),
            (TextureFormat::A8R8G8B8, [5, 3, 1], Layout::Pitch(64)),
            (TextureFormat::Dxt1, [8, 8, 1], Layout::Swizzled),
        ];
        for (format, size, layout) in cases {
            let count = format.words(size[0], size[1]) * size[2] as usize;
            let largest = if format.is_compressed() { u32::MAX } else { ((1_u64 << (8 * format.bytes())) - 1) as u32 };
            let all: Vec<u32> = (0..count as u32).map(|n| n.wrapping_mul(0x9e37_79b9) & largest).collect();
            let mut image = vec![0xee; 16];
            image.extend(bytes(&all, format, size, layout));
            let memory = Memory::new(image);
            assert_eq!(words(&memory, 16, format, size, layout), Some(all), "{format:?}");
            assert_eq!(words(&memory, 17 + memory.len() as u64, format, size, layout), None);
            assert_eq!(words(&memory, u64::MAX - 3, format, size, layout), None);
        }
    }
}
