//! The formats of vertex arrays (SET_VERTEX_DATA_ARRAY_FORMAT, 0x1760 + 4 n).
//!
//! INFERRED from the register definitions of nxdk and from xemu: normalised numbers are divided by the largest one.
#![allow(clippy::float_arithmetic, reason = "attributes are f32")]

use super::DEFAULT;

/// The type of the numbers in an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberType {
    /// Type 0, UB_D3D: four bytes blue, green, red, alpha, where 255 is 1.
    BytesBgra,
    /// Type 1, S1: signed 16-bit numbers, where 32767 is 1. Below -1 they are -1.
    Normalized,
    /// Type 2, F: binary32.
    Float,
    /// Type 4, UB_OGL: bytes red, green, blue, alpha, where 255 is 1.
    BytesRgba,
    /// Type 5, S32K: signed 16-bit integers.
    Integer,
    /// Type 6, CMP: one word of signed numbers with 11, 11 and 10 bits, x in the lowest, where 1023, 1023 and 511 are 1.
    Packed,
}

impl NumberType {
    /// Returns how many bytes a number takes, which is also how numbers are aligned in an inline array.
    pub fn bytes(self) -> usize {
        match self {
            NumberType::BytesBgra | NumberType::BytesRgba => 1,
            NumberType::Normalized | NumberType::Integer => 2,
            NumberType::Float | NumberType::Packed => 4,
        }
    }
}

/// The format of one attribute in an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArrayFormat {
    /// The type of the numbers.
    pub number: NumberType,
    /// How many numbers a vertex has, 1 to 4.
    pub count: usize,
    /// Whether three numbers are x, y and w (size 7).
    pub skips_z: bool,
    /// The distance from one vertex to the next, in bytes.
    pub stride: u32,
}

/// A word that is no format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FormatError {
    /// There is no such type.
    Type(u32),
    /// The type does not have this size.
    Size(u32),
}

impl ArrayFormat {
    /// Reads a word: type in bits 0 to 3, size in 4 to 7, stride in 8 to 31. Returns `None` for an attribute without an
    /// array, whose size is 0.
    ///
    /// # Errors
    /// A type that does not exist, or a size that the type does not have.
    pub fn read(word: u32) -> Result<Option<ArrayFormat>, FormatError> {
        let (kind, size, stride) = (word & 15, word >> 4 & 15, word >> 8);
        if size == 0 {
            return Ok(None);
        }
        let number = match kind {
            0 => NumberType::BytesBgra,
            1 => NumberType::Normalized,
            2 => NumberType::Float,
            4 => NumberType::BytesRgba,
            5 => NumberType::Integer,
            6 => NumberType::Packed,
            _ => return Err(FormatError::Type(kind)),
        };
        let skips_z = size == 7 && number.bytes() > 1 && number != NumberType::Packed;
        let exists = match number {
            NumberType::BytesBgra => size == 4,
            NumberType::Packed => size == 1,
            _ => size <= 4 || skips_z,
        };
        let count = if skips_z { 3 } else { size as usize };
        if exists { Ok(Some(ArrayFormat { number, count, skips_z, stride })) } else { Err(FormatError::Size(size)) }
    }

    /// Returns the word of this format.
    pub fn word(&self) -> u32 {
        let kind = match self.number {
            NumberType::BytesBgra => 0,
            NumberType::Normalized => 1,
            NumberType::Float => 2,
            NumberType::BytesRgba => 4,
            NumberType::Integer => 5,
            NumberType::Packed => 6,
        };
        let size = if self.skips_z { 7 } else { self.count as u32 };
        kind | size << 4 | self.stride << 8
    }

    /// Returns how many bytes the attribute of a vertex takes.
    pub fn bytes(&self) -> usize {
        self.number.bytes() * self.count
    }

    /// Returns the attribute that begins with `bytes`, or `None` if there are too few of them. Components that the array
    /// does not have are 0, 0, 0 and 1.
    pub fn value(&self, bytes: &[u8]) -> Option<[f32; 4]> {
        let bytes = bytes.get(..self.bytes())?;
        let mut value = DEFAULT;
        if self.number == NumberType::Packed {
            value[..3].copy_from_slice(&unpacked(u32::from_le_bytes(bytes.try_into().ok()?)));
            return Some(value);
        }
        for (k, number) in bytes.chunks_exact(self.number.bytes()).enumerate() {
            value[self.component(k)] = self.number(number);
        }
        Some(value)
    }

    /// Returns the component that the number at place `k` gives.
    fn component(&self, k: usize) -> usize {
        match (self.number, k) {
            (NumberType::BytesBgra, 0 | 2) => 2 - k,
            (_, 2) if self.skips_z => 3,
            _ => k,
        }
    }

    fn number(&self, bytes: &[u8]) -> f32 {
        match (self.number, bytes) {
            (NumberType::Float, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
            (NumberType::Integer, &[a, b]) => f32::from(i16::from_le_bytes([a, b])),
            (NumberType::Normalized, &[a, b]) => normalized(i16::from_le_bytes([a, b])),
            (_, &[byte]) => f32::from(byte) / 255.0,
            _ => 0.0,
        }
    }
}

/// Returns the number that 16 bits of S1 mean.
pub fn normalized(number: i16) -> f32 {
    (f32::from(number) / 32767.0).max(-1.0)
}

/// Returns x, y and z of a word of CMP. The lowest numbers are a little below -1.
pub fn unpacked(word: u32) -> [f32; 3] {
    let signed = |low: u32, width: u32| (word << (32 - low - width)) as i32 >> (32 - width);
    [signed(0, 11) as f32 / 1023.0, signed(11, 11) as f32 / 1023.0, signed(22, 10) as f32 / 511.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(word: u32) -> ArrayFormat {
        ArrayFormat::read(word).unwrap().unwrap()
    }

    /// Every word that can be read is written back, and the others name what is wrong with them.
    #[test]
    fn all_words() {
        let mut known = 0;
        for low in 0..256 {
            for stride in [0, 12, 0xff_ffff] {
                let word = stride << 8 | low;
                match ArrayFormat::read(word) {
                    Ok(Some(format)) => {
                        known += 1;
                        assert_eq!((format.word(), format.stride), (word, stride));
                        assert!(format.value(&vec![0; format.bytes() - 1]).is_none());
                        assert!(format.value(&vec![0; format.bytes()]).is_some());
                    }
                    Ok(None) => assert_eq!(low >> 4, 0),
                    Err(FormatError::Type(kind)) => assert!(kind == low & 15 && ![0, 1, 2, 4, 5, 6].contains(&kind)),
                    Err(FormatError::Size(size)) => assert_eq!(size, low >> 4),
                }
            }
        }
        // S1, F, S32K have sizes 1 to 4 and 7, UB_OGL 1 to 4, UB_D3D and CMP one.
        assert_eq!(known, 3 * (3 * 5 + 4 + 2));
    }

    #[test]
    fn floats_of_all_sizes() {
        let bytes: Vec<u8> = [1.5_f32, -2.0, 3.25, 4.0].iter().flat_map(|x| x.to_le_bytes()).collect();
        let expected = [[1.5, 0.0, 0.0, 1.0], [1.5, -2.0, 0.0, 1.0], [1.5, -2.0, 3.25, 1.0], [1.5, -2.0, 3.25, 4.0]];
        for (size, expected) in (1..).zip(expected) {
            let format = read(0x1002 | size << 4);
            assert_eq!((format.bytes(), format.value(&bytes)), (4 * size as usize, Some(expected)));
        }
        assert_eq!(read(0x72).value(&bytes), Some([1.5, -2.0, 0.0, 3.25]));
        assert_eq!(read(0x72).bytes(), 12);
    }

    #[test]
    fn shorts_are_numbers_or_parts_of_one() {
        for number in i16::MIN..=i16::MAX {
            let bytes = number.to_le_bytes();
            let expected = (f64::from(number) / 32767.0).max(-1.0) as f32;
            assert_eq!(read(0x11).value(&bytes), Some([expected, 0.0, 0.0, 1.0]));
            assert_eq!(read(0x15).value(&bytes), Some([f32::from(number), 0.0, 0.0, 1.0]));
        }
        let bytes = [1, 0, 0xff, 0xff, 2, 0, 0xfe, 0xff];
        assert_eq!(read(0x45).value(&bytes), Some([1.0, -1.0, 2.0, -2.0]));
        assert_eq!(read(0x75).value(&bytes), Some([1.0, -1.0, 0.0, 2.0]));
        assert_eq!((normalized(i16::MAX), normalized(i16::MIN), normalized(-32767)), (1.0, -1.0, -1.0));
    }

    #[test]
    fn bytes_have_two_orders() {
        for byte in 0..=255_u8 {
            let part = f32::from(byte) / 255.0;
            assert_eq!(read(0x44).value(&[byte, 0, 255, 0]), Some([part, 0.0, 1.0, 0.0]));
            assert_eq!(read(0x40).value(&[byte, 0, 255, 51]), Some([1.0, 0.0, part, 0.2]));
            // A byte that became a part of 1 becomes the same byte again.
            assert_eq!((part * 255.0).round(), f32::from(byte));
        }
        assert_eq!(read(0x24).value(&[255, 0]), Some([1.0, 0.0, 0.0, 1.0]));
        assert_eq!(ArrayFormat::read(0x30), Err(FormatError::Size(3)));
    }

    #[test]
    fn packed_numbers() {
        for x in -1024..1024_i32 {
            let word = x as u32 & 0x7ff | (-x as u32 & 0x7ff) << 11 | ((x / 2) as u32 & 0x3ff) << 22;
            let [a, b, c] = unpacked(word);
            // 1024 does not fit in eleven bits.
            let negated = if x == -1024 { -1024 } else { -x };
            assert_eq!([a, b, c], [x as f32 / 1023.0, negated as f32 / 1023.0, (x / 2) as f32 / 511.0]);
        }
        assert_eq!(read(0x16).value(&0x7fdf_fbff_u32.to_le_bytes()), Some([1.0, 1.0, 1.0, 1.0]));
        assert_eq!(read(0x16).bytes(), 4);
    }
}
