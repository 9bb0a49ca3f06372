//! CLP-1, CLP-2: the pixels that a draw may write, as rectangles that do not overlap.

use crate::state::{Draw, Rectangle, Target};
use std::ops::Range;

/// Returns the pixels of the target that surface clip, scissor and window clip leave, as rectangles that are not empty,
/// from the top down.
///
/// The result for a pixel does not depend on the rectangle that contains it, so the engines draw one rectangle after
/// the other without further tests.
pub fn windows(draw: &Draw, target: &Target) -> Vec<Rectangle> {
    let whole = Rectangle { x: 0, y: 0, width: target.width, height: target.height };
    let bounds = [target.clip, draw.scissor].into_iter().flatten().fold(whole, Rectangle::intersection);
    if bounds.width == 0 || bounds.height == 0 {
        return Vec::new();
    }
    let Some(clip) = &draw.window_clip else { return vec![bounds] };
    let (columns, rows) = (columns(&bounds), rows(&bounds));
    // All rows between two edges of rectangles are equal.
    let mut edges: Vec<u32> = clip.rectangles.iter().map(self::rows).flat_map(|rows| [rows.start, rows.end]).collect();
    edges.retain(|edge| rows.contains(edge));
    edges.extend([rows.start, rows.end]);
    edges.sort_unstable();
    edges.dedup();
    let mut windows: Vec<Rectangle> = Vec::new();
    for rows in edges.windows(2).map(|pair| pair[0]..pair[1]) {
        let meets = |rectangle: &&Rectangle| self::rows(rectangle).contains(&rows.start);
        let mut spans: Vec<Range<u32>> = clip.rectangles.iter().filter(meets).map(self::columns).collect();
        spans.sort_unstable_by_key(|span| span.start);
        let mut free = Vec::new();
        let mut at = columns.start;
        for span in &spans {
            // First the part before the span, which is in no span; then the part of the span that no earlier span had.
            for (part, inside) in [(at..span.start, false), (at.max(span.start)..span.end, true)] {
                let part = part.start.max(columns.start)..part.end.min(columns.end);
                if inside != clip.exclusive && !part.is_empty() {
                    free.push(part);
                }
            }
            at = at.max(span.end);
        }
        if clip.exclusive && at < columns.end {
            free.push(at..columns.end);
        }
        for span in free {
            let (x, width, height) = (span.start, span.end - span.start, rows.end - rows.start);
            match windows.iter_mut().find(|w| w.y + w.height == rows.start && (w.x, w.width) == (x, width)) {
                Some(above) => above.height += height,
                None => windows.push(Rectangle { x, y: rows.start, width, height }),
            }
        }
    }
    windows
}

fn columns(rectangle: &Rectangle) -> Range<u32> {
    rectangle.x..rectangle.x.saturating_add(rectangle.width)
}

fn rows(rectangle: &Rectangle) -> Range<u32> {
    rectangle.y..rectangle.y.saturating_add(rectangle.height)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::state::{SurfaceFormat, WindowClip};

    /// Compares with the definition, pixel by pixel: every pixel that may be drawn is in exactly one window, and no
    /// other is in any.
    #[test]
    fn windows_are_the_pixels_that_are_left() {
        let mut random = Random::seeded(11);
        for _ in 0..3000 {
            let mut target = Target::new(12, 9, SurfaceFormat::A8R8G8B8);
            let mut draw = Draw::default();
            let mut number = |most: u128| random.below(most) as u32;
            let mut rectangle = || Rectangle { x: number(14), y: number(11), width: number(9), height: number(9) };
            target.clip = (rectangle().x < 4).then(&mut rectangle);
            draw.scissor = (rectangle().x < 4).then(&mut rectangle);
            let clip = WindowClip {
                exclusive: rectangle().x < 7,
                rectangles: (0..=rectangle().x % 8).map(|_| rectangle()).collect(),
            };
            draw.window_clip = (rectangle().x < 11).then_some(clip);
            let holds = |r: &Rectangle, x, y| columns(r).contains(&x) && rows(r).contains(&y);
            let found = windows(&draw, &target);
            assert!(found.iter().all(|window| window.width > 0 && window.height > 0));
            for (x, y) in (0..9).flat_map(|y| (0..12).map(move |x| (x, y))) {
                let clipped = draw
                    .window_clip
                    .as_ref()
                    .is_some_and(|clip| clip.rectangles.iter().any(|r| holds(r, x, y)) == clip.exclusive);
                let outside = [target.clip, draw.scissor].iter().flatten().any(|r| !holds(r, x, y));
                let count = found.iter().filter(|window| holds(window, x, y)).count();
                assert_eq!(count, usize::from(!clipped && !outside), "{x},{y} {draw:?} {found:?}");
            }
        }
    }
}
