//! Faults that tests plant: the n-th read, write or start of a thread in this process fails, as on a disk that is full or broken, or a system
//! without threads left.
//!
//! Where nothing is planted, an operation costs one load of a number.

use std::io;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What may fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// To open a file, or to read a part of it.
    Read,
    /// To make, write, flush or rename a file or folder, or to write to standard output.
    Write,
    /// To start a thread.
    Start,
}

/// For each operation the number of calls up to the one that fails; 0 if none does.
static LEFT: [AtomicUsize; 3] = [const { AtomicUsize::new(0) }; 3];

/// Lets the `n`-th operation from now on fail, counted from 1; none if `n` is 0.
pub fn plant(operation: Operation, n: usize) {
    LEFT[operation as usize].store(n, Ordering::Relaxed);
}

/// Returns whether a planted fault has not come yet.
pub fn is_due(operation: Operation) -> bool {
    LEFT[operation as usize].load(Ordering::Relaxed) != 0
}

/// Fails where the fault is planted. Called before each operation.
///
/// # Errors
/// The error that the system would give.
#[inline]
pub fn check(operation: Operation) -> io::Result<()> {
    if is_due(operation) { count(operation) } else { Ok(()) }
}

#[cold]
fn count(operation: Operation) -> io::Result<()> {
    let less = |left: usize| left.checked_sub(1);
    match LEFT[operation as usize].fetch_update(Ordering::Relaxed, Ordering::Relaxed, less) {
        Ok(1) => Err(match operation {
            Operation::Read => io::Error::other("a test has planted this error"),
            Operation::Write => io::ErrorKind::StorageFull.into(),
            Operation::Start => io::ErrorKind::WouldBlock.into(),
        }),
        _ => Ok(()),
    }
}
