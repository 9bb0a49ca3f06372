//! Compiles the engine for several instruction sets, and chooses one at run time.

use super::block::{self, Block};
use super::{Job, triangle};
use crate::engine::context::TriangleContext;
use crate::engine::rows::geometry::shape::Shape;
use crate::engine::rows::geometry::spans::{self, Spans};
use crate::engine::rows::geometry::weights::Pixels;
use crate::engine::rows::lanes::{BLOCK, Lanes, PerLane};
use crate::engine::rows::sampling::fetch::{self, Reader, Workspace};
use crate::engine::rows::sampling::filter::{self, Footprint};
use crate::engine::rows::sampling::place::Place;
use crate::engine::rows::sampling::quads::Quads;
use crate::engine::rows::sampling::table::Column;
use crate::engine::rows::shading::compiled::CompiledDraw;
use crate::engine::walk::Band;
use crate::raster::setup::Triangle;
use crate::state::{Named, named};
use multiversion::target::match_target;
use multiversion::{multiversion, target};

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
        self.kernels().is_some()
    }

    /// Returns the engine's parts for the instruction set if this machine has it.
    pub(crate) fn kernels(self) -> Option<Kernels> {
        match self {
            Isa::Baseline => Some(Kernels::BASELINE),
            Isa::V2 => v2::kernels(),
            Isa::V3 => v3::kernels(),
            Isa::V4 => v4::kernels(),
        }
    }

    /// Returns the widest instruction set of this machine.
    pub fn best() -> Isa {
        Isa::ALL.iter().rev().copied().find(|isa| isa.is_available()).unwrap_or(Isa::Baseline)
    }
}

/// Defines the engine's parts for each instruction set. They are separate functions, so that the code of one loop does not depend on the
/// number of loops in the same function, and so that those with several callers are compiled once for each set. The constant tells each
/// part whether the set has fused multiply-add, and the path names its filter.
macro_rules! kernels {
    ({ $($version:ident: $isa:ident, $target:literal, $wide:literal, $filter:path;)* } $parts:tt) => {
        kernels!(@parts $parts);
        $(kernels!(@version $version, $isa, $target, $wide, $filter, $parts);)*
    };
    (@parts { $(fn $module:ident::$part:ident($($name:ident: $type:ty),*) $(-> $out:ty)?;)* }) => {
        /// The engine's parts, compiled for an instruction set that this machine has. What calls them is compiled once.
        #[derive(Clone, Copy, Debug)]
        pub(crate) struct Kernels {
            pub(crate) isa: Isa,
            $(pub(crate) $part: fn($($type),*) $(-> $out)?,)*
        }

        impl Kernels {
            pub(crate) const BASELINE: Kernels =
                Kernels { isa: Isa::Baseline, $($part: $module::$part::<false>,)* };
        }
    };
    (@version $version:ident, $isa:ident, $target:literal, $wide:literal, $filter:path,
        { $(fn $module:ident::$part:ident($($name:ident: $type:ty),*) $(-> $out:ty)?;)* }) => {
        mod $version {
            use super::*;

            $(#[target($target)]
            fn $part($($name: $type),*) $(-> $out)? {
                $module::$part::<$wide>($($name),*)
            })*

            #[multiversion(targets($target))]
            pub(crate) fn kernels() -> Option<Kernels> {
                match_target! {
                    $target => Some(Kernels { filter: $filter, ..Kernels { isa: Isa::$isa, $($part,)* } }),
                    _ => None,
                }
            }
        }
    };
}

kernels! {
    {
        v2: V2, "x86_64+cmpxchg16b+popcnt+sse3+sse4.1+sse4.2+ssse3", false, filter;
        v3: V3, "x86_64+avx+avx2+bmi1+bmi2+cmpxchg16b+f16c+fma+lzcnt+movbe+popcnt+sse3+sse4.1+sse4.2+ssse3+xsave", true, filter::x86::filter_256;
        v4: V4, "x86_64+avx+avx2+avx512bw+avx512cd+avx512dq+avx512f+avx512vl+bmi1+bmi2+cmpxchg16b+f16c+fma+lzcnt+movbe+popcnt+sse3+sse4.1+sse4.2+ssse3+xsave", true, filter::x86::filter_512;
    }
    {
        fn block::begin(compiled: &CompiledDraw, block: &mut Block, band: &Band<'_>);
        fn spans::find_spans(figure: &Triangle, top: i64, columns: (i64, i64)) -> Spans;
        fn triangle::set_up(context: &TriangleContext<'_>, shape: &Shape, job: &Job<'_>, block: &mut Block);
        fn block::test_depths(context: &TriangleContext<'_>, shape: &Shape, job: &Job<'_>, block: &mut Block, of: (usize, usize), band: &mut Band<'_>);
        fn triangle::interpolate(context: &TriangleContext<'_>, shape: &Shape, job: &Job<'_>, block: &mut Block, of: (usize, usize));
        fn fetch::sample(reader: Reader<'_>, pixels: &Pixels, place: &mut Place, quads: &mut Quads, work: &mut Workspace, alive: &mut [bool], rows: &mut [PerLane<i16>]);
        fn filter::filter(lanes: Lanes, columns: &[Column], entries: &[u32; BLOCK], at: [&[i32; BLOCK]; 2], footprints: &mut [Footprint; BLOCK], channels: [&mut [i16; BLOCK]; 4]);
        fn block::shade(job: &Job<'_>, block: &mut Block);
        fn block::flush(job: &Job<'_>, block: &mut Block, band: &mut Band<'_>);
    }
}
