//! The digest of rows under way: which of their results are hashed, and as how many bytes.

use sha2::{Digest, Sha256};

use super::Column;

/// Bytes that are hashed at once.
pub(super) const BUFFER: usize = 1 << 16;

/// A result column that is hashed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Output {
    /// Its place among the results.
    pub(super) index: usize,
    /// How many bytes a number takes.
    pub(super) bytes: usize,
    least: i64,
    greatest: i64,
}

impl Output {
    /// Those of a unit with these results.
    pub(super) fn from_columns(results: &[Column]) -> Vec<Output> {
        let outputs = results.iter().enumerate().filter(|(_, column)| column.name.starts_with("out."));
        let output = |(index, column): (usize, &Column)| {
            let (least, greatest) = column.kind.range();
            Output { index, bytes: column.kind.bits().div_ceil(8) as usize, least, greatest }
        };
        outputs.map(output).collect()
    }

    /// A number out of its bytes.
    pub(super) fn read(&self, bytes: &[u8]) -> i64 {
        let negative = self.least < 0 && bytes.last().is_some_and(|byte| byte & 0x80 != 0);
        bytes.iter().rev().fold(if negative { -1 } else { 0 }, |number, byte| number << 8 | i64::from(*byte))
    }
}

/// A digest under way.
#[derive(Debug)]
pub struct Digesting<'s> {
    outputs: &'s [Output],
    hash: Sha256,
    /// Longer than [`BUFFER`] by a row, each number of which is written as eight bytes.
    buffer: Vec<u8>,
    /// Bytes of it that wait for the hash.
    filled: usize,
    /// Bytes of a row.
    pub(super) width: usize,
    pub(super) rows: u64,
    /// Rows at the lower and at the upper end.
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

    /// The results of the next rows, no more than [`BUFFER`] has room for, in the bytes that `write` fills; it says how many rows are at the lower and at
    /// the upper end. `false`: it has written none.
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

    /// The results of the next row.
    #[inline]
    pub fn take(&mut self, results: &[i64]) {
        let (mut low, mut high) = (false, false);
        for output in self.outputs {
            let value = results[output.index];
            low |= value == output.least;
            high |= value == output.greatest;
            // Eight bytes whatever the width: what is too much is written over by the next number.
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
