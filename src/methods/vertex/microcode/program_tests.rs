#![allow(clippy::float_arithmetic, reason = "compares with floats")]

use super::*;
use crate::vertex::microcode::encode;
use crate::vertex::random::Random;

const A: [f32; 4] = [1.0, -2.0, 3.0, 0.5];
const B: [f32; 4] = [4.0, 5.0, -6.0, 2.0];
const C: [f32; 4] = [10.0, 20.0, 30.0, 40.0];

/// Runs one operation of the vector unit on an input, a constant and a temporary register, as words of slots.
fn vector_of(mac: Mac, a: [f32; 4], b: [f32; 4], c: [f32; 4]) -> [f32; 4] {
    let load = Instruction {
        mac: Mac::Mov,
        operands: [Operand::new(Source::Constant), Operand::default(), Operand::default()],
        constant: 7,
        temporary: 3,
        vector_mask: 15,
        ..Instruction::default()
    };
    let compute = Instruction {
        mac,
        operands: [
            Operand::new(Source::Input),
            Operand::new(Source::Constant),
            Operand { temporary: 3, ..Operand::new(Source::Temporary) },
        ],
        input: 9,
        constant: 100,
        output_mask: 15,
        is_last: true,
        ..Instruction::default()
    };
    let (mut constants, mut inputs) = ([[0.0; 4]; CONSTANTS], [[0.0; 4]; 16]);
    (constants[7], constants[100], inputs[9]) = (c, b, a);
    Program::decode(&[encode(&load), encode(&compute)], 0).run(&mut constants, &inputs).position
}

/// Runs one operation of the scalar unit.
fn scalar_of(scalar: Scalar, c: [f32; 4]) -> [f32; 4] {
    let compute = Instruction {
        scalar,
        operands: [Operand::default(), Operand::default(), Operand::new(Source::Input)],
        output_mask: 15,
        output_is_scalar: true,
        is_last: true,
        ..Instruction::default()
    };
    let mut inputs = [[0.0; 4]; 16];
    inputs[0] = c;
    Program::decode(&[encode(&compute)], 0).run(&mut [[0.0; 4]; CONSTANTS], &inputs).position
}

#[test]
fn operations_of_the_vector_unit() {
    let of = |mac| vector_of(mac, A, B, C);
    assert_eq!(of(Mac::Mov), A);
    assert_eq!(of(Mac::Mul), [4.0, -10.0, -18.0, 1.0]);
    assert_eq!(of(Mac::Add), [11.0, 18.0, 33.0, 40.5]);
    assert_eq!(of(Mac::Mad), [14.0, 10.0, 12.0, 41.0]);
    assert_eq!(of(Mac::Dp3), [-24.0; 4]);
    assert_eq!(of(Mac::Dph), [-22.0; 4]);
    assert_eq!(of(Mac::Dp4), [-23.0; 4]);
    assert_eq!(of(Mac::Dst), [1.0, -10.0, 3.0, 2.0]);
    assert_eq!(of(Mac::Min), [1.0, -2.0, -6.0, 0.5]);
    assert_eq!(of(Mac::Max), [4.0, 5.0, 3.0, 2.0]);
    assert_eq!(of(Mac::Slt), [1.0, 1.0, 0.0, 1.0]);
    assert_eq!(of(Mac::Sge), [0.0, 0.0, 1.0, 0.0]);
    // Nothing is written.
    for mac in [Mac::Nop, Mac::Reserved14, Mac::Reserved15, Mac::Arl] {
        assert_eq!(of(mac), DEFAULT);
    }
    assert_eq!(vector_of(Mac::Mul, [0.0; 4], [f32::INFINITY, f32::NAN, 1.0, -1.0], C), [0.0; 4]);
    assert_eq!(vector_of(Mac::Slt, [-0.0; 4], [0.0; 4], C), [1.0; 4]);
    // Of 1/3 and 1/5 in binary32 the product is cut; the nearest number is one step up.
    let product = vector_of(Mac::Mul, [1.0 / 3.0; 4], [0.2; 4], C)[0];
    assert_eq!([product.to_bits(), (1.0_f32 / 3.0 * 0.2).to_bits()], [0x3d88_8888, 0x3d88_8889]);
}

#[test]
fn operations_of_the_scalar_unit() {
    assert_eq!(scalar_of(Scalar::Mov, A), A);
    assert_eq!(scalar_of(Scalar::Rcp, [4.0, 9.0, 9.0, 9.0]), [0.25; 4]);
    assert_eq!(scalar_of(Scalar::Rcp, [-0.0; 4]), [f32::NEG_INFINITY; 4]);
    assert_eq!(scalar_of(Scalar::Rcc, [0.0; 4]), [2.0_f32.powi(64); 4]);
    assert_eq!(scalar_of(Scalar::Rcc, [-1e30; 4]), [-(2.0_f32.powi(-64)); 4]);
    assert_eq!(scalar_of(Scalar::Rcc, [-8.0; 4]), [-0.125; 4]);
    // The root of 1 is one step low.
    assert_eq!(scalar_of(Scalar::Rsq, [1.0; 4])[0].to_bits(), ONE - 1);
    assert_eq!(scalar_of(Scalar::Rsq, [0.0; 4]), [f32::INFINITY; 4]);
    assert_eq!(scalar_of(Scalar::Rsq, [-f32::INFINITY; 4]), [0.0; 4]);
    assert_eq!(scalar_of(Scalar::Exp, [3.0; 4]), [8.0, 0.0, 8.0, 1.0]);
    // 2^2.5 lies on the start of a line: 4 (1 + 6787 / 2^14).
    assert_eq!(scalar_of(Scalar::Exp, [2.5; 4]), [4.0, 0.5, 4.0 * (1.0 + 6787.0 / 16384.0), 1.0]);
    assert_eq!(scalar_of(Scalar::Exp, [-0.25; 4])[..2], [0.5, 0.75]);
    assert_eq!(scalar_of(Scalar::Log, [-8.0; 4]), [3.0, 1.0, 3.0, 1.0]);
    // log2 6 = 2 + log2 1.5, whose line starts at 153374 / 2^18.
    assert_eq!(scalar_of(Scalar::Log, [6.0; 4]), [2.0, 1.5, 2.0 + 153374.0 / 262144.0, 1.0]);
    assert_eq!(scalar_of(Scalar::Log, [0.0; 4]), [f32::NEG_INFINITY, 1.0, f32::NEG_INFINITY, 1.0]);
    assert_eq!(scalar_of(Scalar::Lit, [0.5, 0.5, 9.0, 2.0]), [1.0, 0.5, 0.25, 1.0]);
    assert_eq!(scalar_of(Scalar::Lit, [-0.5, 0.5, 9.0, 2.0]), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(scalar_of(Scalar::Lit, [0.5, -1.0, 9.0, 2.0]), [1.0, 0.5, 0.0, 1.0]);
    assert_eq!(scalar_of(Scalar::Lit, [0.5, 0.0, 9.0, 0.0]), [1.0, 0.5, 1.0, 1.0]);
    assert_eq!(scalar_of(Scalar::Nop, A), DEFAULT);
}

fn temporary(number: u8) -> Operand {
    Operand { temporary: number, ..Operand::new(Source::Temporary) }
}

#[test]
fn units_read_before_they_write() {
    let input = Instruction {
        mac: Mac::Mov,
        operands: [Operand::new(Source::Input), Operand::default(), Operand::default()],
        temporary: 1,
        vector_mask: 15,
        ..Instruction::default()
    };
    // MOV R2, R1 + RCP R1.x, R1.y: R2 gets the old R1, and the new one is 1 / y.
    let both = Instruction {
        mac: Mac::Mov,
        scalar: Scalar::Rcp,
        operands: [temporary(1), Operand::default(), Operand { swizzle: [1; 4], ..temporary(1) }],
        temporary: 2,
        vector_mask: 15,
        scalar_mask: 1,
        ..Instruction::default()
    };
    let output = |register, address, is_last| Instruction {
        mac: Mac::Mov,
        operands: [temporary(register), Operand::default(), Operand::default()],
        output_mask: 15,
        output_address: address,
        is_last,
        ..Instruction::default()
    };
    let slots = [input, both, output(1, 3, false), output(2, 4, true)].map(|slot| encode(&slot));
    let mut inputs = [[0.0; 4]; 16];
    inputs[0] = [1.0, 4.0, 3.0, 2.0];
    let outputs = Program::decode(&slots, 0).run(&mut [[0.0; 4]; CONSTANTS], &inputs);
    assert_eq!([outputs.diffuse, outputs.specular], [[0.25, 4.0, 3.0, 2.0], [1.0, 4.0, 3.0, 2.0]]);
}

#[test]
fn constants_by_address_and_written_ones() {
    let load = Instruction {
        mac: Mac::Arl,
        operands: [Operand::new(Source::Input), Operand::default(), Operand::default()],
        ..Instruction::default()
    };
    // MOV c[20].y, c[A0+10]
    let copy = Instruction {
        mac: Mac::Mov,
        operands: [Operand::new(Source::Constant), Operand::default(), Operand::default()],
        constant: 10,
        is_relative: true,
        output_mask: 2,
        output_address: 20,
        writes_constant: true,
        is_last: true,
        ..Instruction::default()
    };
    let program = Program::decode(&[encode(&load), encode(&copy)], 0);
    assert!(program.writes_constants());
    for (address, expected) in [(2.9, 12.0), (-1.5, 8.0), (-11.0, 0.0), (1e9, 0.0), (f32::NAN, 10.0), (181.0, 191.0)] {
        let mut constants = std::array::from_fn(|n| [n as f32; 4]);
        let mut inputs = [[0.0; 4]; 16];
        inputs[0][0] = address;
        program.run(&mut constants, &inputs);
        assert_eq!(constants[20], [20.0, expected, 20.0, 20.0], "{address}");
    }
}

/// R12 reads the position, and fog takes the first component that is written.
#[test]
fn position_and_fog() {
    let position = Instruction {
        mac: Mac::Mov,
        operands: [Operand::new(Source::Input), Operand::default(), Operand::default()],
        output_mask: 7,
        ..Instruction::default()
    };
    let fog = Instruction {
        mac: Mac::Mov,
        operands: [temporary(12), Operand::default(), Operand::default()],
        output_mask: 0b1100,
        output_address: 5,
        is_last: true,
        ..Instruction::default()
    };
    let mut inputs = [[0.0; 4]; 16];
    inputs[0] = [1.0, 2.0, 3.0, 4.0];
    let outputs = Program::decode(&[encode(&position), encode(&fog)], 0).run(&mut [[0.0; 4]; CONSTANTS], &inputs);
    assert_eq!((outputs.position, outputs.fog), ([1.0, 2.0, 3.0, 1.0], 3.0));
}

#[test]
fn programs_without_an_end() {
    let slots = vec![[0, 0x0020_001b, 0x0836_106c, 0x2070_f800]; 300];
    let program = Program::decode(&slots, 130);
    assert_eq!((program.instructions().len(), program.is_complete()), (6, false));
    assert!(program.print().ends_with("MOV oPos.xyzw, v0\n// The program has no end.\n"));
    assert!(Program::decode(&slots, 136).instructions().is_empty());
    assert!(!Program::decode(&[], usize::MAX).is_complete());
    assert_eq!(program.inputs(), std::array::from_fn(|n| n == 0));
    assert_eq!(program.constants(), ([false; CONSTANTS], false));
}

#[test]
fn any_words_are_harmless() {
    let mut random = Random::new(1);
    for _ in 0..20_000 {
        let slots: Vec<Slot> = (0..random.below(8)).map(|_| random.words()).collect();
        let program = Program::decode(&slots, random.below(2) as usize);
        let inputs = std::array::from_fn(|_| random.words().map(f32::from_bits));
        let mut constants = std::array::from_fn(|n| inputs[n % 16]);
        program.run(&mut constants, &inputs);
        assert!(program.print().lines().count() >= program.instructions().len());
        let _ = program.vertex_shader();
    }
}
