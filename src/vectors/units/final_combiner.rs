//! The final combiner: one colour channel, and alpha.

use super::{Column, Conditions, Kind, Reach, Unit, block, named, paired, put};
use ninebit::combiner::final_combiner::{self, PlannedFinal};
use ninebit::combiner::registers::Registers;
use ninebit::number::Lane;
use ninebit::state::{self, Component, FinalInput, FinalRegister, Register, named as enumeration};
use ninebit::trace::{Observer, Recorder, Silent};

enumeration! {
    /// The source of an input A to D in these vectors.
    pub(crate) enum Source {
        /// A register of its own.
        Own,
        /// SPARE0 + SECONDARY.
        Sum,
        /// E times F.
        Product,
    }
}

impl Source {
    /// Returns the register that an input reads; `own` is the one of its own.
    pub(crate) const fn register(self, own: FinalRegister) -> FinalRegister {
        match self {
            Self::Own => own,
            Self::Sum => FinalRegister::Spare0PlusSecondary,
            Self::Product => FinalRegister::ETimesF,
        }
    }
}

/// A B + (1 - A) C + D, with the values of its inputs.
pub(super) struct FinalCombiner;

/// The registers of A, B, C, D, E and F, if they read one of their own.
pub(crate) const OWN: [FinalRegister; 6] = [
    FinalRegister::Texture0,
    FinalRegister::Texture1,
    FinalRegister::PrimaryColor,
    FinalRegister::Fog,
    FinalRegister::Texture2,
    FinalRegister::Texture3,
];

/// Number of columns of configuration.
const CONFIGURATION: usize = 14;

/// The registers of the inputs in their order. The last input is the alpha of SPARE1.
const REGISTERS: [Register; 8] = [
    Register::Texture0,
    Register::Texture1,
    Register::PrimaryColor,
    Register::Fog,
    Register::Texture2,
    Register::Texture3,
    Register::Spare0,
    Register::SecondaryColor,
];

/// Returns the final combiner of a row.
fn planned(inputs: &[i64]) -> PlannedFinal {
    let flag = |n: usize| inputs[n] != 0;
    let mut sources: [FinalInput; 6] = [FinalInput::zero(Component::Rgb); 6];
    for (n, (own, source)) in OWN.into_iter().zip(&mut sources).enumerate() {
        source.register = if n < 4 { named::<Source>(inputs[n]).register(own) } else { own };
        source.invert = flag(4 + n);
    }
    let state = state::FinalCombiner {
        inputs: sources,
        g: FinalInput { register: FinalRegister::Spare1, component: Component::Alpha, invert: flag(10) },
        color_sum_clamp: flag(11),
        invert_spare0: flag(12),
        invert_secondary: flag(13),
        constants: [[0; 4]; 2],
    };
    // The columns show one colour channel.
    PlannedFinal { live: 9, product: 1, sum: 1, ..PlannedFinal::whole(state) }
}

impl FinalCombiner {
    #[inline(always)]
    fn run<L: Lane>(
        &self,
        inputs: &[i64],
        at: impl Fn(usize) -> L,
        Conditions { profile, policies }: &Conditions,
        observer: &mut impl Observer,
    ) -> ([i64; 7], [L; 2]) {
        let mut file = Registers::new();
        for (n, register) in REGISTERS.into_iter().enumerate() {
            file.load(register, [at(CONFIGURATION + n); 4]);
        }
        file.write(Register::Spare1, 3, at(CONFIGURATION + REGISTERS.len()));
        let values = final_combiner::values(&planned(inputs), *profile, policies, &mut file, observer);
        let [sum, product] = [values.specials.sum, values.specials.product].map(|channels| channels[0]);
        let [a, b, c, d, ..] = values.inputs.map(|channels| channels[0]);
        let mid = [sum, product, a, b, c, d, values.raw[0]].map(|value| value.observe().0);
        (mid, [values.fragment[0], values.fragment[3]])
    }
}

impl Unit for FinalCombiner {
    known_as!(
        "final-combiner", &["FIN-1", "FIN-2", "FIN-3", "FIN-4", "FIN-5"],
        "A B + (1 - A) C + D of red, G of alpha; an input is a register of its own, SPARE0 + SECONDARY, or E F";
        shows CONFIGURATION.. => 7..;
        takes [
            ["cfg.source_a", "cfg.source_b", "cfg.source_c", "cfg.source_d"].map(Column::choice::<Source>),
            ["a", "b", "c", "d", "e", "f", "g"].map(|name| Column::flag(&format!("cfg.invert_{name}"))),
            ["cfg.sum_clamp", "cfg.invert_spare0", "cfg.invert_secondary"].map(Column::flag),
            ["in.a", "in.b", "in.c", "in.d", "in.e", "in.f", "in.spare0", "in.secondary", "in.g"].map(Column::register),
        ];
        gives [
            Column::result("mid.sum", Kind::Unsigned(9)),
            Column::result("mid.product", Kind::Unsigned(8)),
            Column::results(["mid.a", "mid.b", "mid.c", "mid.d"], Kind::Unsigned(9)),
            Column::result("mid.unclamped", Kind::Signed(12)),
            Column::results(["out.r", "out.a"], Kind::Unsigned(8)),
        ]
    );

    computed!(run; bytes from CONFIGURATION);
}
