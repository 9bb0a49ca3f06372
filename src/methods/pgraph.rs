//! State from the registers of the graphics engine, as tracers dump them: 8 KiB from PGRAPH's first on.
//!
//! The registers hold what methods set, packed and with codes of their own; `data/pgraph.tsv` says where. Addresses, fields and codes are facts of the
//! public register headers (envytools, xemu's `nv2a_regs.h`). Matrices, lights, vertex arrays and programs lie elsewhere.

use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Bytes of a dump.
pub const DUMP_BYTES: usize = 0x2000;

const TABLE: &str = include_str!("data/pgraph.tsv");

/// Bits of registers that are bits of methods.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Field {
    /// Address of the first register; others follow word by word.
    register: usize,
    /// Number of registers.
    count: u32,
    /// The bits of a register.
    bits: u32,
    /// The first method, in bytes.
    method: u32,
    /// Bytes from method to method.
    step: u32,
    /// Where the bits lie in the method's word.
    shift: u32,
    /// Codes of the register and values of the method; if there are none, both are the same.
    values: Vec<(u32, u32)>,
}

impl Field {
    fn from_row(row: &str) -> Option<Field> {
        let mut cells = row.split('\t');
        let hexadecimal = |text: &str| u32::from_str_radix(text, 16).ok();
        let (register, count, bits) = (cells.next()?, cells.next()?.parse().ok()?, hexadecimal(cells.next()?)?);
        let (method, step, shift) =
            (hexadecimal(cells.next()?)?, cells.next()?.parse().ok()?, cells.next()?.parse().ok()?);
        let pair = |pair: &str| {
            let (code, value) = pair.split_once(':')?;
            Some((hexadecimal(code)?, hexadecimal(value)?))
        };
        let values = cells.next()?.split(',').filter(|pair| !pair.is_empty()).map(pair).collect::<Option<_>>()?;
        Some(Field { register: hexadecimal(register)? as usize, count, bits, method, step, shift, values })
    }

    /// Returns the bits that a register's word gives to its method; `None` for a code without a value.
    fn value(&self, word: u32) -> Option<u32> {
        let code = (word & self.bits) >> self.bits.trailing_zeros();
        let value = match self.values.is_empty() {
            true => code,
            false => self.values.iter().find(|(known, _)| *known == code)?.1,
        };
        Some(value << self.shift)
    }
}

fn fields() -> &'static [Field] {
    static FIELDS: OnceLock<Vec<Field>> = OnceLock::new();
    FIELDS.get_or_init(|| TABLE.lines().skip(1).filter_map(Field::from_row).collect())
}

/// Returns the methods that the registers of a dump say, with their words. A method of which a field has an unknown code is left out.
pub fn methods(dump: &[u8]) -> BTreeMap<u32, u32> {
    let mut words: BTreeMap<u32, Option<u32>> = BTreeMap::new();
    for field in fields() {
        for n in 0..field.count {
            let at = field.register + 4 * n as usize;
            let Some(bytes) = dump.get(at..).and_then(|rest| rest.first_chunk()) else { continue };
            let value = field.value(u32::from_le_bytes(*bytes));
            let word = words.entry(field.method + n * field.step).or_insert(Some(0));
            *word = word.zip(value).map(|(word, value)| word | value);
        }
    }
    words.into_iter().filter_map(|(method, word)| Some((method, word?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::{Family, Treatment};

    #[test]
    fn every_row_is_a_field_of_a_method_that_is_followed() {
        assert_eq!(fields().len(), TABLE.lines().count() - 1);
        for field in fields() {
            assert!(field.register + 4 * field.count as usize <= DUMP_BYTES && field.bits != 0, "{field:?}");
            let largest = field.values.iter().map(|(_, value)| *value).max();
            let largest = largest.unwrap_or(field.bits >> field.bits.trailing_zeros());
            assert!(u64::from(largest) << field.shift <= u64::from(u32::MAX), "{field:?}");
            for n in 0..field.count {
                let place = Family::Kelvin.find(field.method + n * field.step);
                let treatment = place.map(|place| place.method.treatment);
                assert!(matches!(treatment, Some(Treatment::State | Treatment::Open)), "{field:?} {n}: {treatment:?}");
            }
        }
    }

    #[test]
    fn registers_are_unpacked() {
        let mut dump = vec![0; DUMP_BYTES];
        let mut put = |at: usize, word: u32| dump[at..at + 4].copy_from_slice(&word.to_le_bytes());
        put(0x194c, 0x2900_0000 | 3 << 16 | 1 << 14 | 1 << 12 | 4 << 8 | 0x80);
        put(0x1804, 2 | 1 << 3 | 4 << 4 | 5 << 8);
        put(0x1908, 0x0420_0000);
        put(0x1a08, 0x0ba1_0600 | 0x80 | 8 | 2);
        put(0x1980, 0x1122_3344);
        put(0x1990, 1 << 28 | 1 << 23 | 2 << 21);
        put(0x710, 1);
        put(0x804, 8 << 12 | 2 << 18);
        let methods = methods(&dump);
        let word = |method| methods.get(&method).copied();
        // Red and blue are written, and depths; passes where the depth is less or equal; alpha greater than 0x80.
        assert_eq!(
            [0x358, 0x35c, 0x354, 0x30c, 0x300, 0x33c, 0x340].map(word),
            [0x1_0001, 1, 0x203, 1, 1, 0x204, 0x80].map(Some)
        );
        assert_eq!([0x350, 0x304, 0x344, 0x348].map(word), [0x8006, 1, 0x302, 0x303].map(Some));
        assert_eq!((word(0xac8), word(0x1b44), word(0x2a8)), (Some(0x0420_0000), Some(0x0ba1_062a), Some(0x1144_3322)));
        assert_eq!([0x308, 0x3a0, 0x39c, 0x208].map(word), [1, 0x901, 0x405, 0x128].map(Some));
        // A code that no stencil operation has.
        assert_eq!(word(0x370), None);
        assert!(super::methods(&[]).is_empty());
    }
}
