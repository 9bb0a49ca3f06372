//! Alpha test, blending and surfaces.

use super::{
    CHANNELS, Column, Conditions, Kind, Reach, Unit, block, bytes, channels, color_results, colors, named, paired, put,
};
use ninebit::combiner::direct::Direct;
use ninebit::number::Lane;
use ninebit::rop::{blend, surface};
use ninebit::state::{self, BlendEquation, BlendFactor, CompareFunction, SurfaceFormat};
use ninebit::trace::{Observer, Recorder, Silent};

/// The alpha test of a fragment.
pub(super) struct AlphaTest;

impl AlphaTest {
    fn run<L: Lane>(
        &self,
        inputs: &[i64],
        at: impl Fn(usize) -> L,
        _: &Conditions,
        observer: &mut impl Observer,
    ) -> [bool; 1] {
        let test = state::AlphaTest { function: named(inputs[0]), reference: inputs[1] as u8 };
        [blend::alpha_test(&test, at(2), observer)]
    }
}

impl Unit for AlphaTest {
    known_as!(
        "alpha-test", &["ROP-1"], "whether a fragment of this alpha passes", Direct;
        takes [Column::choice::<CompareFunction>("cfg.function"), ["cfg.reference", "in.alpha"].map(Column::byte)];
        gives [Column::result("out.passes", Kind::Unsigned(1))]
    );

    computed!(run);
}

/// A fragment that is blended with the surface.
pub(super) struct Blend;

impl Blend {
    #[inline(always)]
    fn run<L: Lane, O: Observer>(
        &self,
        inputs: &[i64],
        at: impl Fn(usize) -> L,
        _: &Conditions,
        observer: &mut O,
    ) -> ([i64; 8], [L; 4]) {
        let state =
            state::Blend { equation: named(inputs[0]), source: named(inputs[1]), destination: named(inputs[2]) };
        let color = |first: usize| [at(first), at(first + 1), at(first + 2), at(first + 3)];
        let [source, destination, constant] = [3, 7, 11].map(color);
        if O::ON {
            blend::run(&state, 15, bytes(&inputs[11..15]), &source, &destination, observer);
        }
        let mut silent = Silent;
        let mut direct = Direct::plain(&mut silent);
        let values = [0, 1, 2, 3].map(|c| blend::evaluate(&state, c, &source, &destination, &constant, &mut direct));
        let factors = std::array::from_fn(|n| values[n % 4].factors[n / 4].observe().0);
        (factors, values.map(|value| value.blended))
    }
}

impl Unit for Blend {
    known_as!(
        "blend", &["ROP-2", "ROP-3", "ROP-4"],
        "a fragment blended with what a surface of eight bits a channel holds", Direct;
        takes [
            Column::choice::<BlendEquation>("cfg.equation"),
            ["cfg.source_factor", "cfg.destination_factor"].map(Column::choice::<BlendFactor>),
            colors(&["source", "destination", "constant"]),
        ];
        gives [color_results(["mid.source_factor", "mid.destination_factor", "out"])]
    );

    computed!(run; bytes from 3);
}

/// Returns all bits of a word of the surface format of that number.
fn all_bits(format: i64) -> i64 {
    (1 << (8 * named::<SurfaceFormat>(format).bytes())) - 1
}

/// A store under a colour mask.
pub(super) struct WriteMask;

impl Unit for WriteMask {
    known_as!(
        "write-mask", &["ROP-6"],
        "the bits of a surface's word that a colour mask writes, and the word after a store", Geometry;
        takes [
            Column::choice::<SurfaceFormat>("cfg.format"),
            CHANNELS.map(|channel| Column::flag(&format!("cfg.writes.{channel}"))),
            ["in.stored", "in.word"].map(|name| Column::word(name, 32)),
        ];
        gives [Column::results(["mid.mask", "out.stored"], Kind::Hex(32))]
    );

    fn accepts(&self, inputs: &[i64], _: state::Profile) -> bool {
        inputs[5..].iter().all(|word| *word <= all_bits(inputs[0]))
    }

    fn fit(&self, inputs: &mut [i64]) {
        let all = all_bits(inputs[0]);
        inputs[5..].iter_mut().for_each(|word| *word &= all);
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let mask = surface::write_mask(named(inputs[0]), [1, 2, 3, 4].map(|n| inputs[n] != 0));
        put(results, [mask, surface::masked(inputs[5] as u32, inputs[6] as u32, mask)]);
    }
}

/// Bytes that are stored as a surface's word.
pub(super) struct SurfaceStore;

impl Unit for SurfaceStore {
    known_as!(
        "surface-store", &["ROP-5", "CLR-1"], "a colour as the word that a surface of this format keeps", Direct;
        takes [Column::choice::<SurfaceFormat>("cfg.format"), channels("in", CHANNELS, Column::byte)];
        gives [Column::result("out.word", Kind::Hex(32))]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        results[0] = surface::pack(named(inputs[0]), bytes(&inputs[1..])).into();
    }
}

/// Bytes that blending reads from a surface's word.
pub(super) struct SurfaceLoad;

impl Unit for SurfaceLoad {
    known_as!(
        "surface-load", &["ROP-5", "CLR-1"], "the word of a surface as the colour that a blend reads", Direct;
        takes [Column::choice::<SurfaceFormat>("cfg.format"), Column::word("in.word", 32)];
        gives [color_results(["out"])]
    );

    fn accepts(&self, inputs: &[i64], _: state::Profile) -> bool {
        inputs[1] <= all_bits(inputs[0])
    }

    fn fit(&self, inputs: &mut [i64]) {
        inputs[1] &= all_bits(inputs[0]);
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        put(results, surface::read(named(inputs[0]), inputs[1] as u32));
    }
}
