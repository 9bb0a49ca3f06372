//! The final combiner, one colour channel and alpha.

use super::{named, step};
use crate::combiner::final_combiner::{self, PlannedFinal};
use crate::combiner::registers::Registers;
use crate::state::{self, Component, FinalInput, FinalRegister, Register, named as enumeration};
use crate::trace::Recorder;
use crate::vectors::column::{Column, Kind};
use crate::vectors::unit::{Conditions, Reach, Unit};

enumeration! {
    /// What an input of A to D reads in these vectors.
    enum Source {
        /// A register of its own.
        Own,
        /// SPARE0 + SECONDARY.
        Sum,
        /// E times F.
        Product,
    }
}

/// A B + (1 - A) C + D with everything that feeds it.
#[derive(Debug)]
pub(super) struct FinalCombiner;

/// Registers of A, B, C, D, E, F where they have one of their own.
const OWN: [(FinalRegister, Register); 6] = [
    (FinalRegister::Texture0, Register::Texture0),
    (FinalRegister::Texture1, Register::Texture1),
    (FinalRegister::PrimaryColor, Register::PrimaryColor),
    (FinalRegister::Fog, Register::Fog),
    (FinalRegister::Texture2, Register::Texture2),
    (FinalRegister::Texture3, Register::Texture3),
];

impl Unit for FinalCombiner {
    fn name(&self) -> &'static str {
        "final-combiner"
    }

    fn about(&self) -> &'static str {
        "A B + (1 - A) C + D of red, G of alpha; an input is a register of its own, SPARE0 + SECONDARY, or E F"
    }

    fn rules(&self) -> &'static [&'static str] {
        &["FIN-1", "FIN-2", "FIN-3", "FIN-4", "FIN-5"]
    }

    fn inputs(&self) -> Vec<Column> {
        let mut columns: Vec<Column> =
            ["a", "b", "c", "d"].map(|name| Column::choice::<Source>(&format!("cfg.source_{name}"))).to_vec();
        columns.extend(["a", "b", "c", "d", "e", "f", "g"].map(|name| Column::flag(&format!("cfg.invert_{name}"))));
        columns.extend(["cfg.sum_clamp", "cfg.invert_spare0", "cfg.invert_secondary"].map(Column::flag));
        let names = ["in.a", "in.b", "in.c", "in.d", "in.e", "in.f", "in.spare0", "in.secondary", "in.g"];
        columns.extend(names.map(Column::register));
        columns
    }

    fn results(&self) -> Vec<Column> {
        let mut columns =
            vec![Column::result("mid.sum", Kind::Unsigned(9)), Column::result("mid.product", Kind::Unsigned(8))];
        columns.extend(["mid.a", "mid.b", "mid.c", "mid.d"].map(|name| Column::result(name, Kind::Unsigned(9))));
        columns.push(Column::result("mid.unclamped", Kind::Signed(12)));
        columns.extend(["out.r", "out.a"].map(|name| Column::result(name, Kind::Unsigned(8))));
        columns
    }

    fn evaluate(&self, inputs: &[i64], conditions: &Conditions, results: &mut [i64]) {
        let flag = |n: usize| inputs[n] != 0;
        let mut file = Registers::new();
        let mut sources: [FinalInput; 6] = [FinalInput::zero(Component::Rgb); 6];
        for (n, ((own, register), source)) in OWN.into_iter().zip(&mut sources).enumerate() {
            file.load(register, [inputs[14 + n] as i32; 4]);
            source.register = match inputs.get(n).filter(|_| n < 4).map(|chosen| named::<Source>(*chosen)) {
                Some(Source::Sum) => FinalRegister::Spare0PlusSecondary,
                Some(Source::Product) => FinalRegister::ETimesF,
                Some(Source::Own) | None => own,
            };
            source.invert = flag(4 + n);
        }
        file.load(Register::Spare0, [inputs[20] as i32; 4]);
        file.load(Register::SecondaryColor, [inputs[21] as i32; 4]);
        file.write(Register::Spare1, 3, inputs[22] as i32);
        let state = state::FinalCombiner {
            inputs: sources,
            g: FinalInput { register: FinalRegister::Spare1, component: Component::Alpha, invert: flag(10) },
            color_sum_clamp: flag(11),
            invert_spare0: flag(12),
            invert_secondary: flag(13),
            constants: [[0; 4]; 2],
        };
        let planned = PlannedFinal { state, live: 9, product: 1, sum: 1, reads_constants: false, lerps: true };
        let mut recorder = Recorder::default();
        let (profile, policies) = (conditions.profile, &conditions.policies);
        let out = final_combiner::run(&planned, profile, policies, &mut file, &mut recorder);
        let names = ["final.sum.r", "final.EF.r", "final.A.r", "final.B.r", "final.C.r", "final.D.r", "final.rgb.r"];
        for (result, name) in results.iter_mut().zip(names) {
            *result = step(&recorder.steps, name);
        }
        (results[7], results[8]) = (out[0].into(), out[3].into());
    }

    fn reach(&self, inputs: &[i64], results: &[i64]) -> Reach {
        Reach::of(&inputs[14..], &results[7..])
    }
}
