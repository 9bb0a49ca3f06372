//! Random vertex programs, legal or not, as far as they can be written as text.

use ninebit::vertex::shader::*;
use proptest::prelude::*;

fn source() -> impl Strategy<Value = Source> {
    let register = prop_oneof![
        2 => (0..INPUTS).prop_map(SourceRegister::Input),
        4 => (0..TEMPORARIES).prop_map(SourceRegister::Temporary),
        3 => (0..CONSTANTS, prop::bool::weighted(0.2))
            .prop_map(|(index, relative)| SourceRegister::Constant { index, relative }),
    ];
    let swizzle = prop_oneof![Just([0, 1, 2, 3]), prop::array::uniform4(0..4_usize), (0..4_usize).prop_map(|k| [k; 4])];
    (register, swizzle, any::<bool>()).prop_map(|(register, swizzle, negate)| Source { register, swizzle, negate })
}

fn destination(opcode: Opcode) -> impl Strategy<Value = Destination> {
    let register = prop_oneof![
        4 => (0..TEMPORARIES).prop_map(DestinationRegister::Temporary),
        1 => Just(DestinationRegister::Position),
        1 => (0..2_usize).prop_map(DestinationRegister::Color),
        1 => (0..COORDINATES).prop_map(DestinationRegister::Coordinates),
        1 => prop::sample::select(vec![DestinationRegister::Fog, DestinationRegister::PointSize, DestinationRegister::Address]),
    ];
    (register, 1..16_u8).prop_map(move |(register, mask)| {
        let single = [DestinationRegister::Fog, DestinationRegister::PointSize, DestinationRegister::Address];
        let rows = opcode.matrix().map_or(mask, |(rows, _)| (1 << rows) - 1);
        Destination { register, mask: if single.contains(&register) { 1 } else { rows } }
    })
}

pub fn instruction() -> BoxedStrategy<Instruction> {
    prop::sample::select(Opcode::ALL.to_vec())
        .prop_flat_map(|opcode| {
            (destination(opcode), prop::collection::vec(source(), opcode.sources()))
                .prop_map(move |(destination, sources)| Instruction { opcode, destination, sources })
        })
        .boxed()
}

pub fn shader() -> BoxedStrategy<VertexShader> {
    let number = prop_oneof![Just(0.5_f32), Just(-0.0), -1e6_f32..1e6, Just(1e-30), Just(3e38)];
    let definitions = prop::collection::btree_map(0..CONSTANTS, prop::array::uniform4(number), 0..4);
    (definitions, prop::collection::vec(instruction(), 0..20))
        .prop_map(|(definitions, instructions)| VertexShader {
            definitions: definitions.into_iter().collect(),
            instructions,
        })
        .boxed()
}
