//! Incremental digest of rows: selects the results that are hashed and their widths in bytes.

use sha2::{Digest, Sha256};

use super::Column;

/// Number of bytes that are hashed at once.
pub(super) const BUFFER: usize = 1 << 16;

/// A result column that is hashed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Output {
    /// Index among the results.
    pub(super) index: usize,
    /// Size of a number in bytes.
    pub(super) bytes: usize,
    least: i64,
    greatest: i64,
}

impl Output {
    /// Returns the hashed columns among a unit's result columns: those named `out.`.
    pub(super) fn from_columns(results: &[Column]) -> Vec<Output> {
        let outputs = results.iter().enumerate().filter(|(_, column)| column.name.starts_with("out."));
        let output = |(index, column): (usize, &Column)| {
            let (least, greatest) = column.kind.range();
            Output { index, bytes: column.kind.bits().div_ceil(8) as usize, least, greatest }
        };
        outputs.map(output).collect()
    }

    /// Decodes a number from its little-endian bytes.
    pub(super) fn read(&self, bytes: &[u8]) -> i64 {
        let negative = self.least < 0 && bytes.last().is_some_and(|byte| byte & 0x80 != 0);
        bytes.iter().rev().fold(if negative { -1 } else { 0 }, |number, byte| number << 8 | i64::from(*byte))
    }
}

/// An incremental digest of rows.
#[derive(Debug)]
pub struct Digesting<'s> {
    outputs: &'s [Output],
    hash: Sha256,
    /// Bytes to be hashed. It has room for one row more than [`BUFFER`], because every number is written as eight bytes.
    buffer: Vec<u8>,
    /// Number of bytes in `buffer` that are not hashed yet.
    filled: usize,
    /// Size of a row in bytes.
    pub(super) width: usize,
    /// Number of rows so far.
    pub(super) rows: u64,
    /// Number of rows with an output that is the least, and with one that is the greatest, of its column's type.
    pub(super) ends: [u64; 2],
}

impl<'s> Digesting<'s> {
    pub(super) fn new(outputs: &'s [Output]) -> Self {
        Digesting {
            outputs,
            hash: Sha256::new(),
            buffer: vec![0; BUFFER + 8 * outputs.len()],
            filled: 0,
            width: outputs.iter().map(|output| output.bytes).sum(),
            rows: 0,
            ends: [0; 2],
        }
    }

    /// Appends the results of the next rows, at most as many as fit into [`BUFFER`]. `write` fills in their bytes and returns the numbers of rows at
    /// the lower and upper end. Returns `false` if `write` returned `None` and nothing was appended.
    pub(super) fn take_block(&mut self, rows: u64, write: impl FnOnce(&mut [u8]) -> Option<[u64; 2]>) -> bool {
        let bytes = self.width * rows as usize;
        if self.filled + bytes > BUFFER {
            self.flush();
        }
        let Some(ends) = write(&mut self.buffer[self.filled..self.filled + bytes]) else { return false };
        self.filled += bytes;
        self.rows += rows;
        self.ends = [self.ends[0] + ends[0], self.ends[1] + ends[1]];
        true
    }

    /// Appends the results of the next row.
    #[inline]
    pub fn take(&mut self, results: &[i64]) {
        let (mut low, mut high) = (false, false);
        for output in self.outputs {
            let value = results[output.index];
            low |= value == output.least;
            high |= value == output.greatest;
            // Always eight bytes: the next number overwrites the excess.
            self.buffer[self.filled..self.filled + 8].copy_from_slice(&value.to_le_bytes());
            self.filled += output.bytes;
        }
        self.rows += 1;
        self.ends[0] += u64::from(low);
        self.ends[1] += u64::from(high);
        if self.filled >= BUFFER {
            self.flush();
        }
    }

    fn flush(&mut self) {
        self.hash.update(&self.buffer[..self.filled]);
        self.filled = 0;
    }

    pub(super) fn finish(mut self) -> [u8; 32] {
        self.flush();
        self.hash.finalize().into()
    }
}
