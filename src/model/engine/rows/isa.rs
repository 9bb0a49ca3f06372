//! Compiles the engine for several instruction sets, and chooses one at run time.

use super::band::{self, Block};
use super::compiled::{CompiledDraw, Job};
use super::draw;
use super::filter::Vectors;
use super::setup::Covered;
use super::small::Boxes;
use super::triangle::Interpolators;
use crate::engine::context::TriangleContext;
use crate::engine::walk::Band;
use crate::state::{Named, named};
use multiversion::multiversion;
use multiversion::target::match_target;

named! {
    /// Instruction sets that the fast engine is compiled for.
    pub enum Isa {
        /// The instruction set that the program was compiled for.
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
    /// Returns whether this machine has the instruction set.
    pub fn is_available(self) -> bool {
        match self {
            Isa::Baseline => true,
            Isa::V2 => v2::is_available(),
            Isa::V3 => v3::is_available(),
            Isa::V4 => v4::is_available(),
        }
    }

    /// Returns the widest instruction set of this machine.
    pub fn best() -> Isa {
        Isa::ALL.iter().rev().copied().find(|isa| isa.is_available()).unwrap_or(Isa::Baseline)
    }
}

/// Defines the engine's parts for an instruction set. They are separate functions, so that the code of one loop does not depend on the
/// number of loops in the same function.
///
/// If the machine lacks the set, parts do nothing and `run` returns `None`. The constant tells each part whether the set has fused
/// multiply-add.
macro_rules! text {
    ({ $($version:ident: $target:literal, $wide:literal;)* } $parts:tt) => {
        text!(@parts $parts);
        $(text!(@version $version, $target, $wide, $parts);)*
    };
    (@parts { $($(#[$meta:meta])* fn $part:ident($($name:ident: $type:ty),*) $(-> $out:ty)?;)* }) => {
        pub(super) trait Kernels {
            $($(#[$meta])* fn $part($($name: $type),*) $(-> $out)?;)*
        }

        /// The instruction set that the program was compiled for.
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
            pub(super) fn run(job: &Job<'_>, band: &mut Band<'_>, block: &mut Block) -> Option<u64> {
                match_target! { $target => Some(draw::run::<Version>(job, band, block)), _ => { let _ = (job, band, block); None } }
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
        /// Calls [`band::flush`] with this instruction set.
        fn flush(job: &Job<'_>, block: &mut Block, band: &mut Band<'_>);
        /// Calls [`band::set_up`] with this instruction set.
        fn set_up(contexts: &[TriangleContext<'_>], compiled: &CompiledDraw, width: u32, boxes: &mut Boxes);
        /// Calls [`band::set_up_more`] with this instruction set.
        fn set_up_more(context: &TriangleContext<'_>, compiled: &CompiledDraw, boxes: &mut Boxes);
        /// Calls [`band::more`] with this instruction set.
        fn more(context: &TriangleContext<'_>, compiled: &CompiledDraw, block: &mut Block) -> bool;
        /// Calls [`band::plain`] with this instruction set.
        fn plain(context: &TriangleContext<'_>, compiled: &CompiledDraw, block: &mut Block) -> bool;
        /// Calls [`band::tied`] with this instruction set.
        fn tied(context: &TriangleContext<'_>, compiled: &CompiledDraw, block: &mut Block) -> bool;
        /// Calls [`band::in_box`] with this instruction set.
        fn in_box(interpolators: &Interpolators<'_>, job: &Job<'_>, block: &mut Block);
        /// Calls [`band::row`] with this instruction set.
        fn row(pixel: (i64, i64), count: usize, lane: usize, covered: Covered, interpolators: &Interpolators<'_>, job: &Job<'_>, block: &mut Block);
        /// Calls [`band::row_attributes`] with this instruction set.
        fn row_attributes(pixel: (i64, i64), count: usize, lane: usize, covered: Covered, context: &TriangleContext<'_>, job: &Job<'_>, block: &mut Block);
        /// Calls [`band::box_attributes`] with this instruction set.
        fn box_attributes(context: &TriangleContext<'_>, job: &Job<'_>, block: &mut Block);
        /// Calls [`band::row_depths`] with this instruction set.
        fn row_depths(pixel: (i64, i64), count: usize, lane: usize, context: &TriangleContext<'_>, job: &Job<'_>, block: &mut Block, band: &mut Band<'_>) -> bool;
        /// Calls [`band::box_depths`] with this instruction set.
        fn box_depths(first: usize, context: &TriangleContext<'_>, job: &Job<'_>, block: &mut Block, band: &mut Band<'_>) -> bool;
        /// Calls [`band::shade`] with this instruction set.
        fn shade(job: &Job<'_>, block: &mut Block, band: &mut Band<'_>);
    }
}

fn run_baseline(job: &Job<'_>, band: &mut Band<'_>, block: &mut Block) -> u64 {
    draw::run::<Baseline>(job, band, block)
}

/// Draws the part of a draw that lies in a band, with an instruction set of this machine. Returns the number of covered pixels.
pub(crate) fn run(isa: Isa, job: Job<'_>, band: &mut Band<'_>, block: &mut Block) -> u64 {
    let vectors = match isa {
        Isa::Baseline | Isa::V2 => Vectors::Portable,
        Isa::V3 => Vectors::Avx2,
        Isa::V4 => Vectors::Avx512,
    };
    let job = &Job { vectors, ..job };
    let shaded = match isa {
        Isa::Baseline => None,
        Isa::V2 => v2::run(job, band, block),
        Isa::V3 => v3::run(job, band, block),
        Isa::V4 => v4::run(job, band, block),
    };
    shaded.unwrap_or_else(|| run_baseline(job, band, block))
}
