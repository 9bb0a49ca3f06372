//! One text, compiled for several instruction sets, and the choice among them.

use super::band::{self, Block, Job};
use crate::engine::walk::Band;
use crate::state::{Named, named};
use multiversion::multiversion;
use multiversion::target::match_target;

named! {
    /// Instruction sets that the fast engine is compiled for.
    pub enum Isa {
        /// What the program was compiled for.
        Baseline = "baseline",
        /// x86-64 with SSE4.2.
        V2 = "x86-64-v2",
        /// x86-64 with AVX2 and FMA.
        V3 = "x86-64-v3",
        /// x86-64 with AVX-512.
        V4 = "x86-64-v4",
    }
}

impl Isa {
    /// Whether this machine has it.
    pub fn is_available(self) -> bool {
        match self {
            Isa::Baseline => true,
            Isa::V2 => has_v2(),
            Isa::V3 => has_v3(),
            Isa::V4 => has_v4(),
        }
    }

    /// The widest that this machine has.
    pub fn best() -> Isa {
        Isa::ALL.iter().rev().copied().find(|isa| isa.is_available()).unwrap_or(Isa::Baseline)
    }
}

/// A version of the text for a target; where the machine lacks it, a version that does nothing and says so.
macro_rules! version {
    ($has:ident, $run:ident, $target:literal, $fma:literal) => {
        #[multiversion(targets($target))]
        fn $has() -> bool {
            match_target! { $target => true, _ => false }
        }

        #[multiversion(targets($target))]
        fn $run(job: Job<'_>, band: &mut Band<'_>, block: &mut Block) -> Option<u64> {
            match_target! { $target => Some(band::run::<$fma>(job, band, block)), _ => { let _ = (job, band, block); None } }
        }
    };
}
version!(has_v2, run_v2, "x86_64+cmpxchg16b+popcnt+sse3+sse4.1+sse4.2+ssse3", false);
version!(
    has_v3,
    run_v3,
    "x86_64+avx+avx2+bmi1+bmi2+cmpxchg16b+f16c+fma+lzcnt+movbe+popcnt+sse3+sse4.1+sse4.2+ssse3+xsave",
    true
);
version!(
    has_v4,
    run_v4,
    "x86_64+avx+avx2+avx512bw+avx512cd+avx512dq+avx512f+avx512vl+bmi1+bmi2+cmpxchg16b+f16c+fma+lzcnt+movbe+popcnt+sse3+sse4.1+sse4.2+ssse3+xsave",
    true
);

fn run_baseline(job: Job<'_>, band: &mut Band<'_>, block: &mut Block) -> u64 {
    band::run::<false>(job, band, block)
}

/// Draws what of a draw falls into a band, by an instruction set that the machine has; covered pixels.
pub(crate) fn run(isa: Isa, job: Job<'_>, band: &mut Band<'_>, block: &mut Block) -> u64 {
    let shaded = match isa {
        Isa::Baseline => None,
        Isa::V2 => run_v2(job, band, block),
        Isa::V3 => run_v3(job, band, block),
        Isa::V4 => run_v4(job, band, block),
    };
    shaded.unwrap_or_else(|| run_baseline(job, band, block))
}
