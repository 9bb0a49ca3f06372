//! Reads colours, as bytes or as floats.
#![allow(clippy::float_arithmetic, reason = "NUM-0: constants given as floats become bytes here")]

use super::*;
use crate::raw::Few;

/// Reads a constant colour.
pub(super) fn constant<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Color>) -> Option<[u8; 4]> {
    reader.value(raw).map(bytes)
}

/// Converts a colour into the four bytes of a constant.
pub(super) fn bytes(color: VertexColor) -> [u8; 4] {
    match color {
        VertexColor::Bytes(bytes) => bytes,
        VertexColor::Floats(floats) => floats.map(byte),
    }
}

/// Reads the constants 0 and 1; those that are not written are zero.
pub(super) fn constants<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, Tuple<'a, source::Color>>) -> [[u8; 4]; 2] {
    let mut constants = [[0; 4]; 2];
    let Some(parts) = reader.read(raw) else { return constants };
    if parts.0.len() > 2 || parts.0.is_empty() {
        let message = format!("there are two constant colours, not {}", parts.0.len());
        let place = reader.span(raw);
        let help = "write `constants: ((255, 0, 0, 255), (0, 255, 0, 255))`";
        reader.push(finding("NB0211", place, message, format!("{} here", parts.0.len()), help));
        return constants;
    }
    for (slot, part) in constants.iter_mut().zip(&parts.0) {
        *slot = constant(reader, part).unwrap_or_default();
    }
    constants
}

/// Converts a float to a byte by NUM-0: clamped to 0..1, then floor(255 c + 0.5), which is exact in 64 bits.
fn byte(value: f32) -> u8 {
    (255.0 * f64::from(value.clamp(0.0, 1.0)) + 0.5).floor() as u8
}

/// Converts a colour into floats: a byte n becomes n / 255, which NUM-0 turns into the same byte again.
pub(super) fn floats(color: VertexColor) -> [f32; 4] {
    match color {
        VertexColor::Floats(floats) => floats,
        VertexColor::Bytes(bytes) => bytes.map(|byte| f32::from(byte) / 255.0),
    }
}

/// Reads a colour that is not a name.
pub(super) fn literal<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Color>) -> Option<VertexColor> {
    let (head, rest) = raw.split();
    if head.is_empty() && raw.text.starts_with('(') {
        return three_or_four(reader, raw);
    }
    if head == "Vector" {
        let vector = texture_source::only::<Numbers>(reader, rest, "a vector or its name")?;
        let [x, y, z, _] = reader.numbers(&vector, "a vector as a colour", 3..=3, [0.0; 4])?;
        return Some(VertexColor::Floats([0.5 + 0.5 * x, 0.5 + 0.5 * y, 0.5 + 0.5 * z, 1.0]));
    }
    if head != "Float" {
        let found = if head.is_empty() { raw.text } else { head };
        let place = reader.range(found);
        let message = format!("expected a colour, found `{}`", shorten(found));
        let help = "write bytes `(255, 128, 0, 255)`, floats `Float(1.0, 0.5, 0.0, 1.0)`, `Vector((0, 0, 1))`, or \"the name of a colour\"";
        return reader.refuse(finding("NB0205", place, message, "not a colour", help));
    }
    let mut numbers = Raw::<Numbers>::new(rest);
    if Raw::<Numbers>::new(rest.strip_prefix('(').unwrap_or(rest)).is_text() {
        numbers = texture_source::only(reader, rest, "the name of a vector")?;
    }
    reader.numbers(&numbers, "a colour", 3..=4, [0.0, 0.0, 0.0, 1.0]).map(VertexColor::Floats)
}

/// Reads a colour of three or four bytes.
fn three_or_four<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Color>) -> Option<VertexColor> {
    match reader.attempt::<Few<u8>>(raw.text) {
        Some(Few { values: [r, g, b, _], count: 3 }) => return Some(VertexColor::Bytes([r, g, b, 255])),
        Some(Few { values, count: 4 }) => return Some(VertexColor::Bytes(values)),
        _ => {}
    }
    // Something is wrong: this finds out what.
    let parts = reader.read(&raw.as_other::<Tuple<'a, u8>>())?.0;
    let mut wrong = false;
    for part in &parts {
        if reader.attempt::<u8>(part.text).is_none() {
            wrong = true;
            let place = reader.span(part);
            let message = format!("`{}` is not a byte of a colour", shorten(part.text));
            let help = "for 0.0 to 1.0 write `Float(1.0, 0.5, 0.0, 1.0)`";
            reader.push(finding("NB0206", place, message, "bytes are whole numbers from 0 to 255", help));
        }
    }
    if !wrong {
        let place = reader.span(raw);
        let message = format!("a colour has 3 or 4 bytes, not {}", parts.len());
        let help = "write `(255, 128, 0)` or `(255, 128, 0, 255)`";
        reader.push(finding("NB0211", place, message, "R, G, B and perhaps A", help));
    }
    None
}
