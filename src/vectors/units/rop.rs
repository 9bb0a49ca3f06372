//! Alpha test, blending and surfaces.

use super::{
    CHANNELS, Column, Conditions, Kind, Reach, Unit, block, bytes, channels, color_results, colors, named, paired, put,
};
use ninebit::combiner::direct::Direct;
use ninebit::number::{Lane, Lanes16};
use ninebit::rop::{blend, surface};
use ninebit::state::{self, BlendEquation, BlendFactor, CompareFunction, SurfaceFormat};
use ninebit::trace::{Recorder, Silent};

/// Returns source, destination and constant of a row of blending.
fn blended_colors<L: Lane>(at: impl Fn(usize) -> L) -> [[L; 4]; 3] {
    [3, 7, 11].map(|first| [at(first), at(first + 1), at(first + 2), at(first + 3)])
}

fn alpha_test(inputs: &[i64]) -> state::AlphaTest {
    state::AlphaTest { function: named(inputs[0]), reference: inputs[1] as u8 }
}

/// The alpha test of a fragment.
pub(super) struct AlphaTest;

impl Unit for AlphaTest {
    known_as!(
        "alpha-test", &["ROP-1"], "whether a fragment of this alpha passes", Direct;
        takes [Column::choice::<CompareFunction>("cfg.function"), ["cfg.reference", "in.alpha"].map(Column::byte)];
        gives [Column::result("out.passes", Kind::Unsigned(1))]
    );

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        results[0] = blend::alpha_test(&alpha_test(inputs), inputs[2] as i32, &mut Silent).into();
    }

    fn trace(&self, inputs: &[i64], _: &Conditions, recorder: &mut Recorder) {
        blend::alpha_test(&alpha_test(inputs), paired(inputs[2]), recorder);
    }
}

/// A fragment that is blended with the surface.
pub(super) struct Blend;

fn blend_state(inputs: &[i64]) -> state::Blend {
    state::Blend { equation: named(inputs[0]), source: named(inputs[1]), destination: named(inputs[2]) }
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

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let state = blend_state(inputs);
        let [source, destination, constant] = blended_colors(|n| inputs[n] as i32);
        let (mut silent, mut results) = (Silent, results.chunks_exact_mut(4));
        let mut direct = Direct::plain(&mut silent);
        let values = [0, 1, 2, 3].map(|c| blend::evaluate(&state, c, &source, &destination, &constant, &mut direct));
        let columns = [values.map(|v| v.factors[0]), values.map(|v| v.factors[1]), values.map(|v| v.blended)];
        columns.into_iter().zip(&mut results).for_each(|(column, results)| put(results, column));
    }

    fn trace(&self, inputs: &[i64], _: &Conditions, recorder: &mut Recorder) {
        let [source, destination, _] = blended_colors(|n| paired(inputs[n]));
        blend::run(&blend_state(inputs), 15, bytes(&inputs[11..15]), &source, &destination, recorder);
    }

    fn block(&self, inputs: &[i64], varying: usize, _: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
        let state = blend_state(inputs);
        (varying >= 3).then(|| {
            let mut lanes: [Lanes16<i32>; 12] = std::array::from_fn(|n| Lanes16::all(inputs[3 + n] as i32));
            block::bytes(inputs, varying, out, |rows| {
                lanes[varying - 3] = rows.numbers();
                let [source, destination, constant] = lanes.as_chunks().0 else { return [Lanes16::all(0); 4] };
                let channel = |channel: usize| {
                    let mut silent = Silent;
                    let mut direct = Direct::plain(&mut silent);
                    blend::evaluate(&state, channel, source, destination, constant, &mut direct).blended
                };
                [channel(0), channel(1), channel(2), channel(3)]
            })
        })
    }
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
        inputs[5..].iter().all(|word| word >> (8 * named::<SurfaceFormat>(inputs[0]).bytes()) == 0)
    }

    fn fit(&self, inputs: &mut [i64]) {
        let all = (1 << (8 * named::<SurfaceFormat>(inputs[0]).bytes())) - 1;
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
        "surface-store", &["ROP-5"], "a colour as the word that a surface of this format keeps", Direct;
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
        "surface-load", &["ROP-5"], "the word of a surface as the colour that a blend reads", Direct;
        takes [Column::choice::<SurfaceFormat>("cfg.format"), Column::word("in.word", 32)];
        gives [color_results(["out"])]
    );

    fn accepts(&self, inputs: &[i64], _: state::Profile) -> bool {
        let bytes = named::<SurfaceFormat>(inputs[0]).bytes();
        inputs[1] >> (8 * bytes) == 0
    }

    fn fit(&self, inputs: &mut [i64]) {
        inputs[1] &= (1 << (8 * named::<SurfaceFormat>(inputs[0]).bytes())) - 1;
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        put(results, surface::read(named(inputs[0]), inputs[1] as u32));
    }
}
