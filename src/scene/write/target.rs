//! Writes render targets.
#![allow(clippy::float_arithmetic, reason = "DEP-2: a clear is given as a float")]

use super::draw::{rectangle, within};
use super::node::{Fields, Node};
use crate::lower::depth_word;
use ninebit::state::*;

/// Returns a target; `contents` has the names of the images that its colours and its depths begin as.
pub(super) fn target(target: &Target, name: &str, contents: [Option<&str>; 2]) -> Fields {
    let mut fields = Fields::new("");
    fields.put("name", Node::text(name));
    fields.put("width", Node::whole(target.width));
    fields.put("height", Node::whole(target.height));
    fields.word("format", target.format, SurfaceFormat::A8R8G8B8);
    if let Some(depth) = &target.depth {
        fields.put("depth", Node::word(depth.format.name()));
    }
    let mut clear = Fields::new("");
    clear.color("color", target.clear_color, [0, 0, 0, 255]);
    if let Some(buffer) = &target.depth {
        if buffer.clear != buffer.format.largest() {
            match depth(buffer) {
                Some(depth) => clear.put("depth", Node::number(depth)),
                None => clear.put("depth_word", Node::word(format!("0x{:x}", buffer.clear))),
            }
        }
        clear.whole("stencil", buffer.clear_stencil, 0);
    }
    fields.put_some("clear", clear);
    for (field, contents) in ["contents", "depth_contents"].into_iter().zip(contents) {
        if let Some(contents) = contents {
            fields.put(field, Node::text(contents));
        }
    }
    if let Some(clip) = &target.clip {
        fields.put("clip", rectangle(&within(clip, target)));
    }
    fields
}

/// Returns a depth that a clear stores as the buffer's word, if there is one.
fn depth(buffer: &DepthBuffer) -> Option<f32> {
    let DepthBuffer { format, clear, .. } = *buffer;
    let depth = match format {
        _ if clear == 0 => 0.0,
        // At most 2^24, so the quotient is exact.
        DepthFormat::Z16 | DepthFormat::Z24S8 => (clear + 1) as f32 / (format.largest() + 1) as f32,
        DepthFormat::Z24S8F => f32::from_bits(clear << 7),
        // Twelve bits of fraction, and a bias of 7.
        DepthFormat::Z16F => f32::from_bits((clear << 11).wrapping_add((127 - 7) << 23)),
    };
    (depth.is_finite() && depth >= 0.0 && depth_word(format, depth) == clear).then_some(depth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_of_a_depth_is_stored_by_a_clear() {
        for format in DepthFormat::ALL.iter().copied() {
            let step = if format.bits() == 16 { 1 } else { 251 };
            let mut missing = 0;
            for clear in (0..=format.largest()).step_by(step) {
                let found = depth(&DepthBuffer { format, clear, clear_stencil: 0 });
                assert!(found.is_none_or(|depth| depth_word(format, depth) == clear), "{format:?} {clear:#x}");
                missing += usize::from(found.is_none());
            }
            // Of floats, those below the smallest normal number, and above the largest.
            let allowed = match format {
                DepthFormat::Z16 | DepthFormat::Z24S8 => 0,
                DepthFormat::Z16F => (1 << 12) - 1,
                DepthFormat::Z24S8F => 2 * (1 << 16) / step + 2,
            };
            assert!(missing <= allowed, "{format:?}: {missing}");
        }
    }
}
