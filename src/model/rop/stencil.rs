//! STN-1: the stencil test.

use crate::number::Integer;
use crate::state::{StencilOperation, StencilTest};

/// Returns whether a stored stencil byte passes the test.
#[inline(always)]
pub fn passes(test: &StencilTest, stored: u8) -> bool {
    compared(test, i32::from(stored))
}

/// [`passes`] of any whole number.
#[inline(always)]
pub fn compared<I: Integer>(test: &StencilTest, stored: I) -> I::Choice {
    I::new((test.reference & test.mask).into()).compared(test.function, stored.masked(test.mask.into()))
}

/// Returns the operation that applies after the stencil test and, if it passed, the depth test.
#[inline]
pub fn operation(test: &StencilTest, passed: bool, depth_passed: bool) -> StencilOperation {
    match (passed, depth_passed) {
        (false, _) => test.fail,
        (true, false) => test.depth_fail,
        (true, true) => test.pass,
    }
}

/// Returns the stencil byte that an operation stores.
#[inline(always)]
pub fn written(test: &StencilTest, operation: StencilOperation, stored: u8) -> u8 {
    replaced(test, operation, i32::from(stored)) as u8
}

/// [`written`] of any whole number.
#[inline(always)]
pub fn replaced<I: Integer>(test: &StencilTest, operation: StencilOperation, stored: I) -> I {
    let new = operated(operation, I::new(test.reference.into()), stored);
    stored.masked((!test.write_mask).into()) + new.masked(test.write_mask.into())
}

/// Returns the stencil byte that an operation makes of a stored one, before a mask selects bits.
#[inline(always)]
pub fn operated<I: Integer>(operation: StencilOperation, reference: I, stored: I) -> I {
    let of = |n: i64| I::new(n);
    match operation {
        StencilOperation::Keep => stored,
        StencilOperation::Zero => of(0),
        StencilOperation::Replace => reference,
        StencilOperation::IncrementSaturate => (stored + of(1)).least(of(255)),
        StencilOperation::DecrementSaturate => (stored - of(1)).greatest(of(0)),
        StencilOperation::Invert => of(255) - stored,
        StencilOperation::Increment => (stored + of(1)).masked(255),
        StencilOperation::Decrement => (stored + of(255)).masked(255),
    }
}

/// Returns whether the test can change a stored byte.
pub fn writes(test: &StencilTest) -> bool {
    test.write_mask != 0 && [test.fail, test.depth_fail, test.pass].iter().any(|o| *o != StencilOperation::Keep)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::{CompareFunction, Named};

    /// The captured stacks of Stencil_func: sequences of operations, and the byte that results.
    #[test]
    fn operations_wrap_or_saturate() {
        let test = StencilTest {
            function: CompareFunction::Always,
            reference: 0x7f,
            mask: 255,
            write_mask: 255,
            fail: StencilOperation::Keep,
            depth_fail: StencilOperation::Keep,
            pass: StencilOperation::Keep,
        };
        use StencilOperation::*;
        for (operations, expected) in [
            (&[Zero][..], 0),
            (&[Replace, Decrement], 0x7e),
            (&[Replace], 0x7f),
            (&[Replace, Increment], 0x80),
            (&[Zero, Invert], 255),
            (&[Zero, Decrement], 255),
            (&[Zero, DecrementSaturate], 0),
            (&[Zero, Invert, Increment], 0),
            (&[Zero, Invert, IncrementSaturate], 255),
        ] {
            let stored = operations.iter().fold(0x80, |stored, operation| written(&test, *operation, stored));
            assert_eq!(stored, expected, "{operations:?}");
        }
    }

    /// Masked bits do not change and do not affect the test.
    #[test]
    fn masks_hold() {
        for operation in StencilOperation::ALL {
            for stored in 0..=255_u8 {
                for mask in [0, 1, 0x0f, 0x80, 0xff] {
                    let test = StencilTest {
                        function: CompareFunction::Equal,
                        reference: 0x35,
                        mask,
                        write_mask: mask,
                        fail: *operation,
                        depth_fail: *operation,
                        pass: *operation,
                    };
                    assert_eq!(written(&test, *operation, stored) & !mask, stored & !mask);
                    assert_eq!(passes(&test, stored), (stored ^ 0x35) & mask == 0);
                }
            }
        }
    }
}
