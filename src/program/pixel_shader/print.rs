//! Prints shaders as text.

use super::*;

/// Prints a shader, one instruction in a line. [`parse`] reads the same shader from the text.
pub fn print(program: &PixelShader) -> String {
    let mut text = format!("{}\n", program.version.name());
    for Definition { index, value: [r, g, b, a], .. } in &program.definitions {
        text.push_str(&format!("def c{index}, {r}, {g}, {b}, {a}\n"));
    }
    for TextureInstruction { operation, unit, source, eye, .. } in &program.textures {
        text.push_str(&format!("{} t{}", operation.name(), unit.value));
        if let Some(Spanned { value: TextureSource { unit, signed_scale }, .. }) = source {
            text.push_str(&format!(", t{unit}{}", if *signed_scale { "_bx2" } else { "" }));
        }
        if let Some(eye) = eye {
            text.push_str(&format!(", c{}", eye.value));
        }
        text.push('\n');
    }
    for arithmetic in &program.arithmetic {
        text.push_str(&instruction(arithmetic));
        text.push('\n');
    }
    text
}

/// Prints an arithmetic instruction.
pub fn instruction(arithmetic: &Arithmetic) -> String {
    let Arithmetic { operation, scale, saturate, target: Spanned { value: target, .. }, sources, paired, .. } =
        arithmetic;
    let plus = if *paired { "+ " } else { "" };
    let scale = words::SCALES.iter().find(|(_, known)| known == scale);
    let scale = scale.map_or(String::new(), |(name, _)| format!("_{name}"));
    let saturate = if *saturate { "_sat" } else { "" };
    let mut text = format!("{plus}{}{scale}{saturate} {}{}", operation.name(), target.register, target.mask.name());
    for Spanned { value: Source { register, selector, modifier, negate }, .. } in sources {
        let minus = if *negate { "-" } else { "" };
        let (before, after) = match modifier {
            Modifier::Invert => ("1-", ""),
            other => ("", other.name()),
        };
        text.push_str(&format!(", {minus}{before}{register}{after}{}", selector.name()));
    }
    text
}
