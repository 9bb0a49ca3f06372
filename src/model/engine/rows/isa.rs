//! One text, compiled for several instruction sets, and the choice among them.

use super::band::{self, Block, Entered};
use super::boxes::BoxCoverage;
use super::compiled::{CompiledDraw, Job};
use super::setup::PixelBatch;
use super::triangle::Interpolators;
use crate::engine::pixel::TriangleContext;
use crate::engine::walk::{Band, Window};
use crate::raster::setup::Triangle;
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
            Isa::V2 => v2::is_available(),
            Isa::V3 => v3::is_available(),
            Isa::V4 => v4::is_available(),
        }
    }

    /// The widest that this machine has.
    pub fn best() -> Isa {
        Isa::ALL.iter().rev().copied().find(|isa| isa.is_available()).unwrap_or(Isa::Baseline)
    }
}

/// The text for an instruction set: parts of their own, because what compilers do to one loop should not hang on how many others stand in the
/// same function.
///
/// Where the machine lacks a set, its parts do nothing and its `run` says so. Each part is told whether the set fuses multiplications with
/// additions and, as all that do so, stores lanes one by one.
macro_rules! text {
    ({ $($version:ident: $target:literal, $wide:literal;)* } $parts:tt) => {
        text!(@parts $parts);
        $(text!(@version $version, $target, $wide, $parts);)*
    };
    (@parts { $($(#[$meta:meta])* fn $part:ident($($name:ident: $type:ty),*) $(-> $out:ty)?;)* }) => {
        pub(super) trait Kernels {
            $($(#[$meta])* fn $part($($name: $type),*) $(-> $out)?;)*
        }

        /// What the program was compiled for.
        struct Baseline;

        impl Kernels for Baseline {
            $(fn $part($($name: $type),*) $(-> $out)? {
                band::$part::<false>($($name),*)
            })*
        }
    };
    (@version $version:ident, $target:literal, $wide:literal,
        { $($(#[$meta:meta])* fn $part:ident($($name:ident: $type:ty),*) $(-> $out:ty)?;)* }) => {
        #[cfg_attr(not(target_arch = "x86_64"), allow(dead_code, reason = "elsewhere nothing but the baseline runs"))]
        mod $version {
            use super::*;

            struct Version;

            impl Kernels for Version {
                $(fn $part($($name: $type),*) $(-> $out)? {
                    $part($($name),*)
                })*
            }

            #[multiversion(targets($target))]
            pub(super) fn is_available() -> bool {
                match_target! { $target => true, _ => false }
            }

            #[multiversion(targets($target))]
            pub(super) fn run(job: Job<'_>, band: &mut Band<'_>, block: &mut Block) -> Option<u64> {
                match_target! { $target => Some(band::run::<Version>(job, band, block)), _ => { let _ = (job, band, block); None } }
            }

            $(#[multiversion(targets($target))]
            fn $part($($name: $type),*) $(-> $out)? {
                match_target! { $target => band::$part::<$wide>($($name),*), _ => { let _ = ($($name),*); Default::default() } }
            })*
        }
    };
}
text! {
    {
        v2: "x86_64+cmpxchg16b+popcnt+sse3+sse4.1+sse4.2+ssse3", false;
        v3: "x86_64+avx+avx2+bmi1+bmi2+cmpxchg16b+f16c+fma+lzcnt+movbe+popcnt+sse3+sse4.1+sse4.2+ssse3+xsave", true;
        v4: "x86_64+avx+avx2+avx512bw+avx512cd+avx512dq+avx512f+avx512vl+bmi1+bmi2+cmpxchg16b+f16c+fma+lzcnt+movbe+popcnt+sse3+sse4.1+sse4.2+ssse3+xsave", true;
    }
    {
        /// [`band::flush`].
        fn flush(job: Job<'_>, block: &mut Block, band: &mut Band<'_>);
        /// [`band::enter`].
        fn enter(context: &mut TriangleContext<'_>, number: usize, window: Window, coverage: &mut BoxCoverage) -> Entered;
        /// [`band::cover`].
        fn cover(triangle: &Triangle, window: Window, coverage: &mut BoxCoverage);
        /// [`band::plain`].
        fn plain(context: &mut TriangleContext<'_>, compiled: &CompiledDraw, block: &mut Block) -> bool;
        /// [`band::coverage`].
        fn coverage(context: &TriangleContext<'_>, job: Job<'_>, block: &mut Block);
        /// [`band::row`].
        fn row(interpolators: &Interpolators<'_>, batch: PixelBatch<'_>, job: Job<'_>, block: &mut Block);
        /// [`band::row_attributes`].
        fn row_attributes(context: &TriangleContext<'_>, batch: PixelBatch<'_>, job: Job<'_>, block: &mut Block);
        /// [`band::box_attributes`].
        fn box_attributes(context: &TriangleContext<'_>, job: Job<'_>, block: &mut Block);
        /// [`band::row_depths`].
        fn row_depths(context: &TriangleContext<'_>, batch: PixelBatch<'_>, block: &mut Block);
        /// [`band::box_depths`].
        fn box_depths(context: &TriangleContext<'_>, block: &mut Block);
        /// [`band::shade`].
        fn shade(job: Job<'_>, block: &mut Block, band: &mut Band<'_>);
    }
}

fn run_baseline(job: Job<'_>, band: &mut Band<'_>, block: &mut Block) -> u64 {
    band::run::<Baseline>(job, band, block)
}

/// Draws what of a draw falls into a band, by an instruction set that the machine has; covered pixels.
pub(crate) fn run(isa: Isa, job: Job<'_>, band: &mut Band<'_>, block: &mut Block) -> u64 {
    let shaded = match isa {
        Isa::Baseline => None,
        Isa::V2 => v2::run(job, band, block),
        Isa::V3 => v3::run(job, band, block),
        Isa::V4 => v4::run(job, band, block),
    };
    shaded.unwrap_or_else(|| run_baseline(job, band, block))
}
