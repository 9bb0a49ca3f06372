//! Compiles the engine for several instruction sets, and chooses one at run time.

use super::BLOCK;
use super::band::{self, Block};
use super::base_level::BaseLevel;
use super::compiled::{CompiledDraw, Sampler};
use super::direction;
use super::fetch::Workspace;
use super::filter::{self, Footprint};
use super::job::Job;
use super::kernels::{Lanes, PerLane};
use super::levels::{self, Fetches, Floors, MipFetches, Placing};
use super::quads::{Exact, Quads};
use super::quotient::Reciprocals;
use super::setup::{BatchSetup, Covered, PixelBatch, Planes, Setup};
use super::short::Short;
use super::small::Boxes;
use super::table::Column;
use super::taps::{self, Footprints};
use super::triangle::{InterpolatorKernels, Interpolators, Varying};
use crate::engine::context::TriangleContext;
use crate::engine::walk::Band;
use crate::plan::{Plan, PlannedDraw};
use crate::state::{Named, named};
use crate::texture::planned::{Image, PlannedUnit};
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

impl Kernels {
    /// Returns the job of drawing triangles of a draw.
    pub(crate) fn job<'a>(
        &self,
        plan: &'a Plan,
        draw: &'a PlannedDraw,
        compiled: &'a CompiledDraw,
        textures: &'a [Image<'a, i32>],
        triangles: &'a [u32],
    ) -> Job<'a> {
        let Kernels { filter, sample, coordinates, levels, fetches, taps, .. } = *self;
        let interpolators = InterpolatorKernels { coordinates, levels, fetches, taps };
        Job { plan, draw, compiled, textures, triangles, filter, sample, interpolators }
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
            $(pub(super) $part: fn($($type),*) $(-> $out)?,)*
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
            pub(super) fn kernels() -> Option<Kernels> {
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
        fn band::begin(compiled: &CompiledDraw, block: &mut Block, band: &Band<'_>);
        fn band::flush(job: &Job<'_>, block: &mut Block, band: &mut Band<'_>);
        fn band::set_up(contexts: &[TriangleContext<'_>], compiled: &CompiledDraw, width: u32, boxes: &mut Boxes);
        fn band::set_up_more(context: &TriangleContext<'_>, compiled: &CompiledDraw, boxes: &mut Boxes);
        fn band::more(context: &TriangleContext<'_>, job: &Job<'_>, block: &mut Block) -> bool;
        fn band::plain(context: &TriangleContext<'_>, compiled: &CompiledDraw, block: &mut Block) -> bool;
        fn band::tied(context: &TriangleContext<'_>, compiled: &CompiledDraw, block: &mut Block) -> bool;
        fn levels::levels(setup: &Setup<'_>, fetches: Fetches, batch: PixelBatch<'_>, of: (&Sampler, &Planes), known: (&BatchSetup, &Reciprocals, Floors<'_>), work: (&mut Short, &mut Quads, &mut Placing), reads: &mut MipFetches);
        fn direction::coordinates(setup: &Setup<'_>, batch: PixelBatch<'_>, of: (&Sampler, &Planes), local: (&BatchSetup, &Reciprocals), out: (&mut [PerLane<i32>; 2], &mut PerLane<u32>), work: (&mut Short, &mut PerLane<i32>));
        fn taps::taps(setup: &Setup<'_>, batch: PixelBatch<'_>, of: (&Sampler, &Planes), local: &BatchSetup, quads: &mut Quads, footprints: &mut Footprints);
        fn levels::fetches(batch: PixelBatch<'_>, of: (&PlannedUnit, &Sampler, &BaseLevel<'_>), exact: Option<Exact<'_>>, known: (&Reciprocals, Floors<'_>), work: (&mut Short, &mut Quads, &mut Placing), reads: &mut MipFetches) -> bool;
        fn band::in_box(interpolators: &Interpolators<'_>, job: &Job<'_>, block: &mut Block);
        fn band::begin_row(pixel: (i64, i64), columns: i64, interpolators: &Interpolators<'_>, job: &Job<'_>, block: &mut Block);
        fn band::row(pixel: (i64, i64), count: usize, lane: usize, covered: Covered, interpolators: &Interpolators<'_>, job: &Job<'_>, block: &mut Block);
        fn band::row_attributes(pixel: (i64, i64), count: usize, lane: usize, covered: Covered, context: &TriangleContext<'_>, job: &Job<'_>, block: &mut Block);
        fn band::box_attributes(context: &TriangleContext<'_>, job: &Job<'_>, block: &mut Block);
        fn band::row_depths(pixel: (i64, i64), count: usize, lane: usize, context: &TriangleContext<'_>, job: &Job<'_>, block: &mut Block, band: &mut Band<'_>) -> bool;
        fn band::box_depths(first: usize, context: &TriangleContext<'_>, job: &Job<'_>, block: &mut Block, band: &mut Band<'_>) -> bool;
        fn filter::filter(lanes: Lanes, columns: &[Column], entries: &[u32; BLOCK], at: [&[i32; BLOCK]; 2], footprints: &mut [Footprint; BLOCK], channels: [&mut [i16; BLOCK]; 4]);
        fn band::sample(job: &Job<'_>, sampler: usize, varying: &mut Varying, work: &mut Workspace, rows: &mut [PerLane<i16>]);
        fn band::shade(job: &Job<'_>, block: &mut Block, band: &mut Band<'_>);
    }
}
