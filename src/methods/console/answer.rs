//! Surfaces as the program keeps them: a line that describes them, then their bytes.
//!
//! ```text
//! ninebit-surface 1 X8R8G8B8O 256 192 pitch 1024
//! ninebit-surface 1 R5G6B5 64 64 swizzled
//! ```

use ninebit::frame::Surface;
use ninebit::state::{Named, SurfaceFormat, Target};

use crate::export::pitch;
use crate::memory::{Layout, Memory, raw, words};

/// The first words of the line.
const FORMAT: &str = "ninebit-surface 1";

/// Longest side of a surface.
const LARGEST: u32 = 4096;

/// Returns how a target lies in memory.
pub(super) fn layout(target: &Target, is_swizzled: bool) -> Layout {
    if is_swizzled { Layout::Swizzled } else { Layout::Pitch(pitch(target.width, target.format.bytes())) }
}

/// Returns the line that describes a target.
pub(super) fn head(target: &Target, layout: Layout) -> String {
    let layout = match layout {
        Layout::Swizzled => "swizzled".to_owned(),
        Layout::Pitch(pitch) => format!("pitch {pitch}"),
    };
    format!("{FORMAT} {} {} {} {layout}\n", target.format.name(), target.width, target.height)
}

/// Reads a surface.
///
/// # Errors
/// The bytes are not a surface, or not a whole one.
pub fn surface(bytes: &[u8]) -> Result<Surface, String> {
    let end = bytes.iter().take(256).position(|byte| *byte == b'\n').ok_or("it has no first line")?;
    let (line, rest) = (String::from_utf8_lossy(&bytes[..end]), &bytes[end + 1..]);
    let described =
        line.strip_prefix(FORMAT).ok_or_else(|| format!("its first line does not begin with `{FORMAT}`"))?;
    let side = |word: &str| word.parse().ok().filter(|side| (1..=LARGEST).contains(side));
    let parsed = || {
        let words: Vec<&str> = described.split(' ').collect();
        let ["", format, width, height, layout @ ..] = &words[..] else { return None };
        let (width, height) = (side(width)?, side(height)?);
        let format = SurfaceFormat::ALL.iter().copied().find(|known| known.name() == *format)?;
        let layout = match layout {
            ["swizzled"] if width.is_power_of_two() && height.is_power_of_two() => Layout::Swizzled,
            ["pitch", pitch] => Layout::Pitch(pitch.parse().ok().filter(|pitch| *pitch >= width * format.bytes())?),
            _ => return None,
        };
        Some((format, [width, height, 1], layout))
    };
    let (format, size, layout) = parsed().ok_or("its first line does not describe a surface")?;
    let wanted = layout.extent(size, format.bytes().into());
    if rest.len() as u64 != wanted {
        return Err(format!("it has {} bytes behind its first line, not {wanted}", rest.len()));
    }
    let words = words(&Memory::new(rest.to_vec()), 0, raw(format), size, layout).ok_or("it is cut off")?;
    Ok(Surface { width: size[0], height: size[1], format, words, depth: Vec::new() })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;
    use crate::memory::bytes;

    #[test]
    fn surfaces_of_both_layouts_are_read() {
        let words: Vec<u32> = (0..32).map(|n| n * 77).collect();
        let target = Target::new(8, 4, SurfaceFormat::R5G6B5);
        for is_swizzled in [false, true] {
            let layout = layout(&target, is_swizzled);
            let mut file = head(&target, layout).into_bytes();
            file.extend(bytes(&words, raw(target.format), [8, 4, 1], layout));
            let read = surface(&file).unwrap();
            assert_eq!((read.width, read.height, read.format, &read.words), (8, 4, SurfaceFormat::R5G6B5, &words));
            assert!(surface(&file[..file.len() - 1]).unwrap_err().contains("bytes behind its first line"));
        }
    }

    #[test]
    fn what_is_no_surface_is_refused() {
        for (text, reason) in [
            ("", "no first line"),
            ("ninebit-surface 2 R5G6B5 1 1 pitch 64\n", "does not begin with"),
            ("ninebit-surface 1 R5G6B5 1 1 pitch 1\n", "does not describe"),
            ("ninebit-surface 1 R5G6B5 0 1 pitch 64\n", "does not describe"),
            ("ninebit-surface 1 R5G6B5 3 1 swizzled\n", "does not describe"),
            ("ninebit-surface 1 R9G9B9 1 1 pitch 64\n", "does not describe"),
            ("ninebit-surface 1 R5G6B5 1 1 pitch 64 \nab", "does not describe"),
        ] {
            let error = surface(text.as_bytes()).unwrap_err();
            assert!(error.contains(reason), "{text}: {error}");
        }
    }
}
