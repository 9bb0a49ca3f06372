//! The stencil test.

use super::{Column, Conditions, Kind, Reach, Unit, named};
use ninebit::rop::stencil;
use ninebit::state::{self, CompareFunction, Named, StencilOperation};

/// The stencil test of a fragment, and the stored stencil.
pub(super) struct StencilTest;

impl Unit for StencilTest {
    known_as!(
        "stencil-test", &["STN-1"],
        "whether a fragment passes the stencil test, and the byte that is stored, given what the depth test says", Geometry;
        takes [
            Column::choice::<CompareFunction>("cfg.function"),
            ["cfg.fail", "cfg.depth_fail", "cfg.pass"].map(Column::choice::<StencilOperation>),
            ["in.reference", "in.mask", "in.write_mask", "in.stored"].map(Column::byte),
            Column::flag("in.depth_passes"),
        ];
        gives [
            Column::result("mid.operation", Kind::Name(StencilOperation::NAMES)),
            Column::result("out.passes", Kind::Unsigned(1)),
            Column::result("out.stored", Kind::Unsigned(8)),
        ]
    );

    fn regressions(&self) -> Vec<Vec<i64>> {
        // Every operation at both ends and around the middle, with each of the three operations chosen.
        let row = |operation: i64, stored: i64, place: usize| {
            let mut operations = [2, 5, 1];
            operations[place] = operation;
            let function = if place == 0 { CompareFunction::Never } else { CompareFunction::Always };
            let mut row = vec![function as i64];
            row.extend(operations);
            row.extend([0x7f, 255, 255, stored, i64::from(place == 2)]);
            row
        };
        let operations = 0..8;
        operations.flat_map(|o| [0, 1, 127, 128, 254, 255].map(|s| row(o, s, (o + s) as usize % 3))).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        // In one row of four, bytes that are equal in the compared bits.
        if inputs[4] & 3 == 0 {
            inputs[7] = inputs[4] ^ (inputs[7] & !inputs[5] & 255);
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let [reference, mask, write_mask, stored] = [4, 5, 6, 7].map(|n| inputs[n] as u8);
        let test = state::StencilTest {
            function: named(inputs[0]),
            reference,
            mask,
            write_mask,
            fail: named(inputs[1]),
            depth_fail: named(inputs[2]),
            pass: named(inputs[3]),
        };
        let passes = stencil::passes(&test, stored);
        let operation = stencil::operation(&test, passes, inputs[8] != 0);
        results[0] = operation as i64;
        results[1] = passes.into();
        results[2] = stencil::written(&test, operation, stored).into();
    }
}
