//! Product sums in block lanes, for sweeps: the rules' own text on sixteen-bit registers, compiled for several instruction sets.

use multiversion::multiversion;

use crate::combiner::general::output;
use crate::number::Factor;
use crate::state::{Bias, RegisterFloor, Scale};

/// `sum` + `c` d, rounded and saturated, for d from `first` on; low byte first. Returns how many results are -256, and how many are 255.
///
/// `sum` is at full width, in 1/65025.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2+fma", "aarch64+neon"))]
pub(super) fn multiply_add(sum: i32, c: i16, first: i16, out: &mut [[u8; 2]]) -> [u64; 2] {
    let (mut low, mut high) = (0_u32, 0_u32);
    for n in 0..out.len() {
        let d = first.wrapping_add(n as i16);
        let value = output(sum + c.product(d), Bias::None, Scale::One, RegisterFloor::Full, |_, v| v);
        low += u32::from(value == -256);
        high += u32::from(value == 255);
        out[n] = value.to_le_bytes();
    }
    [low.into(), high.into()]
}
