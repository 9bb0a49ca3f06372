//! One arithmetic instruction of ps.1.1.

use super::program::{self, Through, lowered_by};
use super::{CHANNELS, Column, Conditions, Reach, Unit, channels, named, paired, put};
use ninebit::state::{Combiners, Profile, Register, Scale};
use ninebit::trace::{Recorder, Silent};
use ninebit_program::Spanned;
use ninebit_program::pixel_shader::{
    Arithmetic, Bank, Context, Mask, Modifier, Operation, PixelShader, Selector, ShaderRegister, Source, Target,
    TextureInstruction, TextureOperation, Version, lower,
};

/// `mov r0, t3`, followed by the instruction, which reads t0, t1 and v0 and writes r0.
pub(super) struct Instruction;

/// The sources a, b, c.
const SOURCES: [(Bank, u8); 3] = [(Bank::Texture, 0), (Bank::Texture, 1), (Bank::Color, 0)];

/// Number of columns before those of the sources.
const FIRST_SOURCE: usize = 5;

/// Number of columns of a source's configuration.
const COLUMNS_PER_SOURCE: usize = 3;

/// Number of columns of configuration.
const CONFIGURATION: usize = FIRST_SOURCE + 3 * COLUMNS_PER_SOURCE;

/// Returns the columns of a source's configuration.
fn configuration(name: &str) -> [Column; COLUMNS_PER_SOURCE] {
    [
        Column::names(&format!("cfg.selector_{name}"), &["own", "a", "b"]),
        Column::names(&format!("cfg.modifier_{name}"), &["plain", "bias", "bx2", "invert"]),
        Column::flag(&format!("cfg.negate_{name}")),
    ]
}

fn register(bank: Bank, index: u8) -> ShaderRegister {
    ShaderRegister { bank, index }
}

fn arithmetic(operation: Operation, target: Target, sources: Vec<Source>) -> Arithmetic {
    Arithmetic {
        operation,
        scale: Scale::One,
        saturate: false,
        target: Spanned::default_of(target),
        sources: sources.into_iter().map(Spanned::default_of).collect(),
        paired: false,
        span: 0..0,
    }
}

fn plain(register: ShaderRegister) -> Source {
    Source { register, selector: Selector::All, modifier: Modifier::Plain, negate: false }
}

/// Returns the shader of a row.
fn shader(inputs: &[i64]) -> PixelShader {
    let operation: Operation = named(inputs[0]);
    let r0 = register(Bank::Temporary, 0);
    let sources = (0..operation.sources()).map(|n| {
        let own = &inputs[FIRST_SOURCE + COLUMNS_PER_SOURCE * n..];
        let (bank, index) = SOURCES[n];
        // Only r0.a can be the condition.
        let is_condition = operation == Operation::Cnd && n == 0;
        Source {
            register: if is_condition { r0 } else { register(bank, index) },
            selector: if is_condition { Selector::Alpha } else { named(own[0]) },
            modifier: named(own[1]),
            negate: own[2] != 0,
        }
    });
    let target = Target { register: r0, mask: named(inputs[3]) };
    let tested = Arithmetic {
        scale: named(inputs[1]),
        saturate: inputs[2] != 0,
        ..arithmetic(operation, target, sources.collect())
    };
    let before = Target { register: r0, mask: Mask::All };
    let textures = [0, 1, 3].map(|unit| TextureInstruction {
        operation: TextureOperation::Tex,
        unit: Spanned::default_of(unit),
        source: None,
        eye: None,
        span: 0..0,
    });
    PixelShader {
        version: Version::Ps11,
        definitions: Vec::new(),
        textures: textures.to_vec(),
        arithmetic: vec![arithmetic(Operation::Mov, before, vec![plain(register(Bank::Texture, 3))]), tested],
    }
}

fn lowered(inputs: &[i64], profile: Profile) -> Option<Combiners> {
    let signed = inputs[4] != 0;
    let context = Context { signed: [signed, signed, false, signed], ..Context::new(profile) };
    lower(&shader(inputs), &context).ok().map(|lowered| lowered.combiners)
}

/// Registers of the inputs.
const PLACES: [(Register, usize); 4] = [
    (Register::Texture0, CONFIGURATION),
    (Register::Texture1, CONFIGURATION + 4),
    (Register::PrimaryColor, CONFIGURATION + 8),
    (Register::Texture3, CONFIGURATION + 12),
];

impl Unit for Instruction {
    known_as!(
        "pixel-shader",
        &[
            "CMB-1", "CMB-2", "CMB-3", "CMB-4", "CMB-5", "CMB-6", "CMB-7", "CMB-8", "CMB-9", "CMB-10", "CMB-11",
            "NUM-2", "NUM-3", "FIN-1", "FIN-2",
        ],
        "an instruction of ps.1.1 from a = t0, b = t1, c = v0 to r0, after mov r0, t3 (before); the a of cnd is r0.a; with signed textures t0, t1, t3 may be negative";
        shows CONFIGURATION.. => 8..; on &[Profile::Nv2a];
        takes [
            Column::choice::<Operation>("cfg.operation"),
            Column::choice::<Scale>("cfg.scale"),
            Column::flag("cfg.saturate"),
            Column::names("cfg.mask", &["rgba", "rgb", "a"]),
            Column::flag("cfg.signed_textures"),
            ["a", "b", "c"].map(configuration).concat(),
            channels("in.a", CHANNELS, Column::register),
            channels("in.b", CHANNELS, Column::register),
            channels("in.c", CHANNELS, Column::byte),
            channels("in.before", CHANNELS, Column::register),
        ];
        gives [program::results()]
    );

    fn accepts(&self, inputs: &[i64], profile: Profile) -> bool {
        let mut fitting = inputs.to_vec();
        self.fit(&mut fitting);
        fitting == inputs && lowered(inputs, profile).is_some()
    }

    fn fit(&self, inputs: &mut [i64]) {
        let operation: Operation = named(inputs[0]);
        for (n, own) in inputs[FIRST_SOURCE..CONFIGURATION].chunks_exact_mut(COLUMNS_PER_SOURCE).enumerate() {
            if n >= operation.sources() || (n == 0 && operation == Operation::Cnd) {
                own.fill(0);
            }
        }
        let (configuration, values) = inputs.split_at_mut(CONFIGURATION);
        if configuration[4] == 0 {
            // Texels without a sign are bytes.
            values.iter_mut().filter(|value| **value < 0).for_each(|value| *value += 256);
        }
        let alpha_only = named::<Mask>(configuration[3]) == Mask::Alpha;
        for own in configuration[FIRST_SOURCE..].chunks_exact_mut(COLUMNS_PER_SOURCE) {
            if named::<Modifier>(own[1]) == Modifier::Invert {
                own[2] = 0;
            }
            if named::<Selector>(own[0]) == Selector::Blue && !alpha_only {
                own[0] = 0;
            }
        }
    }

    lowered_by!(lowered, |_| PLACES, through);
}

/// Returns the use of an input. The last decides which source cnd takes.
fn through(inputs: &[i64], varying: usize) -> Option<Through> {
    let decides = named::<Operation>(inputs[0]) == Operation::Cnd && varying == inputs.len() - 1;
    (varying >= CONFIGURATION).then_some(if decides { Through::Decision } else { Through::Register })
}
