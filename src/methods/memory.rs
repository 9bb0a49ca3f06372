//! An image of the console's memory, and how textures lie in it.

use std::collections::BTreeMap;
use std::sync::Arc;

use ninebit::state::{SurfaceFormat, TextureFormat};
use ninebit_files::texels;

/// Bytes of memory that a console has; development kits have twice as much.
pub const LARGEST_MEMORY: u64 = 128 << 20;

/// An image of memory from address 0, and newer parts of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    bytes: Arc<[u8]>,
    parts: BTreeMap<u64, Vec<u8>>,
}

impl Memory {
    /// Makes memory of an image.
    pub fn new(bytes: Vec<u8>) -> Memory {
        Memory { bytes: bytes.into(), parts: BTreeMap::new() }
    }

    /// Puts newer bytes at an address. Returns whether memory did not hold them.
    pub fn put(&mut self, address: u64, bytes: Vec<u8>) -> bool {
        if self.slice(address, bytes.len() as u64) == Some(&bytes) {
            return false;
        }
        let end = address.saturating_add(bytes.len() as u64);
        self.parts.retain(|first, part| *first >= end || first.saturating_add(part.len() as u64) <= address);
        self.parts.insert(address, bytes);
        true
    }

    /// Returns whether there is none.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty() && self.parts.is_empty()
    }

    /// Returns the number of bytes.
    pub fn len(&self) -> usize {
        self.bytes.len()
    }

    /// Returns `count` bytes at an address; `None` if some lie outside.
    pub fn slice(&self, address: u64, count: u64) -> Option<&[u8]> {
        if let Some((first, part)) = self.parts.range(..=address).next_back()
            && let Ok(from) = usize::try_from(address - first)
            && from < part.len()
        {
            return part.get(from..from.checked_add(usize::try_from(count).ok()?)?);
        }
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

impl Layout {
    /// Returns the bytes that an image takes from its first to its last; `size` has columns, rows and layers, of texels of so many bytes.
    pub(crate) fn extent(self, [width, height, depth]: [u32; 3], bytes: u64) -> u64 {
        let [width, rows] = [width.into(), u64::from(height) * u64::from(depth)];
        match self {
            Layout::Swizzled => width * rows * bytes,
            Layout::Pitch(pitch) => rows.saturating_sub(1) * u64::from(pitch) + width * bytes,
        }
    }

    /// Returns where each texel lies, row after row, in bytes.
    fn places(self, [width, height, depth]: [u32; 3], bytes: usize) -> impl Iterator<Item = usize> {
        let logarithms = [width, height, depth].map(u32::ilog2);
        let rows = (0..depth).flat_map(move |z| (0..height).map(move |y| (y, z)));
        let texels = rows.flat_map(move |(y, z)| (0..width).map(move |x| [x, y, z]));
        texels.map(move |[x, y, z]| match self {
            Layout::Swizzled => swizzled([x, y, z], logarithms) as usize * bytes,
            Layout::Pitch(pitch) => (z * height + y) as usize * pitch as usize + x as usize * bytes,
        })
    }
}

/// Returns the words of an image row after row, each texel or part of a block as [`Texels::words`](ninebit::state::Texels::words) has it; `None` if
/// memory does not hold it whole. `size` has columns, rows and layers.
pub fn words(memory: &Memory, address: u64, format: TextureFormat, size: [u32; 3], layout: Layout) -> Option<Vec<u32>> {
    let bytes = format.bytes() as usize;
    if format.is_compressed() {
        let [width, height, depth] = size.map(u64::from);
        let blocks = width.div_ceil(4) * height.div_ceil(4) * depth;
        return Some(texels::from_bytes(memory.slice(address, blocks * bytes as u64)?, format));
    }
    let image = memory.slice(address, layout.extent(size, bytes as u64))?;
    let rows: Vec<u8> = layout.places(size, bytes).flat_map(|at| &image[at..at + bytes]).copied().collect();
    Some(texels::from_bytes(&rows, format))
}

/// Returns the bytes of an image as [`words`] reads them, the reverse.
pub fn bytes(words: &[u32], format: TextureFormat, size: [u32; 3], layout: Layout) -> Vec<u8> {
    let rows = texels::to_bytes(words, format);
    if format.is_compressed() {
        return rows;
    }
    let bytes = format.bytes() as usize;
    let mut image = vec![0; layout.extent(size, bytes as u64) as usize];
    for (at, texel) in layout.places(size, bytes).zip(rows.chunks_exact(bytes)) {
        image[at..at + bytes].copy_from_slice(texel);
    }
    image
}

/// Returns a format of textures that has the bits of a surface's words as they are, those that no channel uses included.
pub(crate) fn raw(format: SurfaceFormat) -> TextureFormat {
    match format.bytes() {
        4 => TextureFormat::A8R8G8B8,
        2 => TextureFormat::R5G6B5,
        _ => TextureFormat::L8,
    }
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
    fn depths_stand_above_the_stencil_in_memory() {
        let memory = Memory::new(0x1234_56ab_u32.to_le_bytes().to_vec());
        let read = words(&memory, 0, TextureFormat::Z24S8, [1, 1, 1], Layout::Swizzled).unwrap();
        assert_eq!(read[0] & 0xff_ffff, 0x12_3456);
        let read = words(&memory, 0, TextureFormat::X8R8G8B8, [1, 1, 1], Layout::Pitch(4)).unwrap();
        assert_eq!(read, [0x34_56ab]);
    }

    #[test]
    fn images_go_there_and_back() {
        let cases = [
            (TextureFormat::A8R8G8B8, [8, 4, 1], Layout::Swizzled),
            (TextureFormat::R5G6B5, [4, 16, 1], Layout::Swizzled),
            (TextureFormat::L8, [4, 4, 4], Layout::Swizzled),
            (TextureFormat::A8R8G8B8, [5, 3, 1], Layout::Pitch(64)),
            (TextureFormat::Dxt1, [8, 8, 1], Layout::Swizzled),
            (TextureFormat::Yuy2, [6, 3, 1], Layout::Pitch(64)),
            (TextureFormat::Uyvy, [6, 3, 1], Layout::Pitch(12)),
        ];
        for (format, size, layout) in cases {
            let count = format.words(size[0], size[1]) * size[2] as usize;
            let largest = u32::MAX >> (32 - format.word_bits());
            let noise = |n: u32| n.wrapping_mul(0x9e37_79b9) & largest;
            // Both texels of a pair have the chroma of the first.
            let shared =
                |n: u32| if format.is_paired() { noise(n) & !0xffff | noise(n & !1) & 0xffff } else { noise(n) };
            let all: Vec<u32> = (0..count as u32).map(shared).collect();
            let mut image = vec![0xee; 16];
            image.extend(bytes(&all, format, size, layout));
            let memory = Memory::new(image);
            assert_eq!(words(&memory, 16, format, size, layout), Some(all), "{format:?}");
            assert_eq!(words(&memory, 17 + memory.len() as u64, format, size, layout), None);
            assert_eq!(words(&memory, u64::MAX - 3, format, size, layout), None);
        }
    }
}
