//! Many rows at once, for sweeps: the text of the rules, run on lanes.

use multiversion::multiversion;

use ninebit::combiner::output::finished;
use ninebit::number::{Factor, LANES, Lanes16, Sum};
use ninebit::state::{Bias, RegisterFloor, Scale};

/// Computes `sum` + `c` d, rounded and saturated, for d from `first` on, and writes the low byte first. Returns the numbers of results that
/// are -256 and 255.
///
/// `sum` is at full width, in 1/65025. Registers have sixteen bits, and the function is compiled for several instruction sets.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2+fma", "aarch64+neon"))]
pub(super) fn multiply_add(sum: i32, c: i16, first: i16, out: &mut [[u8; 2]]) -> [u64; 2] {
    let (mut low, mut high) = (0_u32, 0_u32);
    for n in 0..out.len() {
        let d = first.wrapping_add(n as i16);
        let value = finished((sum + c.product(d)).rounded(), Bias::None, Scale::One, RegisterFloor::Full);
        low += u32::from(value == -256);
        high += u32::from(value == 255);
        out[n] = value.to_le_bytes();
    }
    [low.into(), high.into()]
}

/// The inputs of sixteen consecutive rows. They are equal except for one input, which counts up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sixteen<'i> {
    inputs: &'i [i64],
    varying: usize,
    numbers: Lanes16<i32>,
}

impl Sixteen<'_> {
    /// Returns the input that counts up.
    #[inline(always)]
    pub(super) fn numbers(&self) -> Lanes16<i32> {
        self.numbers
    }

    /// Returns input `n` of all rows of the block.
    #[inline(always)]
    pub(super) fn at(&self, n: usize) -> Lanes16<i32> {
        if n == self.varying { self.numbers } else { Lanes16::all(self.inputs[n] as i32) }
    }
}

/// Computes rows of N outputs of a byte each, sixteen rows at a time. Returns the numbers of rows that have a 0 and a 255.
///
/// `inputs` are those of the first row; `varying` is the index of the input that counts up.
#[inline(always)]
pub(super) fn bytes<const N: usize>(
    inputs: &[i64],
    varying: usize,
    out: &mut [u8],
    rows: impl FnMut(&Sixteen) -> [Lanes16<i32>; N],
) -> [u64; 2] {
    run::<N, 1>(inputs, varying, out, [0, 255], rows)
}

/// Computes rows of N outputs of nine bits, in two bytes each. Returns the numbers of rows that have a -256 and a 255.
#[inline(always)]
pub(super) fn registers<const N: usize>(
    inputs: &[i64],
    varying: usize,
    out: &mut [u8],
    rows: impl FnMut(&Sixteen) -> [Lanes16<i32>; N],
) -> [u64; 2] {
    run::<N, 2>(inputs, varying, out, [-256, 255], rows)
}

#[inline(always)]
fn run<const N: usize, const WIDTH: usize>(
    inputs: &[i64],
    varying: usize,
    out: &mut [u8],
    [least, greatest]: [i32; 2],
    mut rows: impl FnMut(&Sixteen) -> [Lanes16<i32>; N],
) -> [u64; 2] {
    let mut ends = [0; 2];
    let mut first = inputs[varying] as i32;
    for out in out.chunks_mut(LANES * N * WIDTH) {
        let mut numbers = [first; LANES];
        for (n, number) in (0..).zip(&mut numbers) {
            *number += n;
        }
        let values = rows(&Sixteen { inputs, varying, numbers: Lanes16(numbers) });
        first += LANES as i32;
        for (row, out) in out.chunks_exact_mut(N * WIDTH).enumerate() {
            let (mut low, mut high) = (false, false);
            for (value, out) in values.iter().zip(out.chunks_exact_mut(WIDTH)) {
                let value = value.0[row];
                low |= value == least;
                high |= value == greatest;
                out.copy_from_slice(&value.to_le_bytes()[..WIDTH]);
            }
            ends[0] += u64::from(low);
            ends[1] += u64::from(high);
        }
    }
    ends
}
