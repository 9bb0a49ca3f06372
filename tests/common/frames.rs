//! The first difference of two renders.

use ninebit::frame::Frames;

/// Describes the first pixel at which a render differs from another, which is called `name`, or returns `None`.
pub fn difference(got: &Frames, expected: &Frames, name: &str) -> Option<String> {
    for (target, (got, expected)) in got.surfaces.iter().zip(&expected.surfaces).enumerate() {
        for (what, got, expected, width) in
            [("word", &got.words, &expected.words, got.width), ("depth", &got.depth, &expected.depth, got.width)]
        {
            // Comparing whole buffers first is faster, since they are nearly always equal.
            if got == expected {
                continue;
            }
            let differing = (0..got.len()).filter(|at| got.get(*at) != expected.get(*at));
            if let Some(at) = differing.clone().next() {
                let (x, y) = (at as u32 % width, at as u32 / width);
                let (got, expected, count) =
                    (got[at], expected.get(at).copied().unwrap_or_default(), differing.count());
                return Some(format!(
                    "target {target} ({x}, {y}): {what} {got:#010x}, {name} {expected:#010x}; {count} differ"
                ));
            }
        }
    }
    None
}
