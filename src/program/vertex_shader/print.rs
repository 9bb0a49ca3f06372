//! Prints programs as text; reading the text gives the same program.

use std::fmt::Write;

use ninebit::vertex::shader::{Destination, DestinationRegister, Source, SourceRegister, VertexShader};

/// Prints the program, one instruction in a line.
pub fn print(shader: &VertexShader) -> String {
    let mut out = String::from("vs.1.1\n");
    for (index, values) in &shader.definitions {
        let values = values.map(|value| value.to_string()).join(", ");
        // Writing to a string cannot fail.
        let _ = writeln!(out, "def c{index}, {values}");
    }
    for instruction in &shader.instructions {
        let _ = write!(out, "{} {}", instruction.opcode.word(), destination(&instruction.destination));
        for operand in &instruction.sources {
            let _ = write!(out, ", {}", source(operand));
        }
        out.push('\n');
    }
    out
}

pub(super) fn letters(components: impl IntoIterator<Item = usize>) -> String {
    components.into_iter().filter_map(|k| "xyzw".chars().nth(k)).collect()
}

fn destination(destination: &Destination) -> String {
    let name = match destination.register {
        DestinationRegister::Temporary(index) => format!("r{index}"),
        DestinationRegister::Address => "a0".to_owned(),
        DestinationRegister::Position => "oPos".to_owned(),
        DestinationRegister::Fog => "oFog".to_owned(),
        DestinationRegister::PointSize => "oPts".to_owned(),
        DestinationRegister::Color(index) => format!("oD{index}"),
        DestinationRegister::Coordinates(index) => format!("oT{index}"),
    };
    if destination.mask == 15 {
        return name;
    }
    format!("{name}.{}", letters((0..4).filter(|k| destination.mask >> k & 1 != 0)))
}

pub(super) fn name(register: SourceRegister) -> String {
    match register {
        SourceRegister::Input(index) => format!("v{index}"),
        SourceRegister::Temporary(index) => format!("r{index}"),
        SourceRegister::Constant { index, relative: false } => format!("c{index}"),
        SourceRegister::Constant { index: 0, relative: true } => "c[a0.x]".to_owned(),
        SourceRegister::Constant { index, relative: true } => format!("c[a0.x + {index}]"),
    }
}

fn source(source: &Source) -> String {
    let sign = if source.negate { "-" } else { "" };
    let name = name(source.register);
    if source.swizzle == [0, 1, 2, 3] {
        return format!("{sign}{name}");
    }
    // The last letter is repeated when it is read, so letters equal to it at the end are left out.
    let last = source.swizzle[3];
    let kept = source.swizzle.iter().rposition(|k| *k != last).map_or(1, |at| at + 2);
    format!("{sign}{name}.{}", letters(source.swizzle.into_iter().take(kept)))
}
