//! The pixels that surface clip and window clip leave.

use super::{Column, Conditions, Kind, Reach, Unit};
use ninebit::plan::windows::windows;
use ninebit::state::{Draw, Rectangle, SurfaceFormat, Target, WindowClip};

/// Number of columns and of rows of the target.
const SIDE: u32 = 4096;

/// Whether a pixel is drawn.
pub(super) struct Clip;

fn rectangle(inputs: &[i64]) -> Rectangle {
    let [x, y, width, height] = [0, 1, 2, 3].map(|n| inputs[n] as u32);
    Rectangle { x, y, width, height }
}

impl Unit for Clip {
    known_as!(
        "clip", &["CLP-1", "CLP-2"],
        "whether a pixel of a surface of 4096 x 4096 is drawn, by the surface clip and two rectangles of the window clip", Geometry;
        gives [Column::result("out.drawn", Kind::Unsigned(1))]
    );

    fn inputs(&self) -> Vec<Column> {
        let mut columns = vec![Column::names("cfg.window_clip", &["Off", "Inclusive", "Exclusive"])];
        for name in ["surface", "first", "second"] {
            columns.extend(["x", "y", "width", "height"].map(|side| {
                let last = if side == "x" || side == "y" { SIDE - 1 } else { SIDE };
                Column::unsigned(&format!("in.{name}.{side}"), 13, last.into())
            }));
        }
        columns.extend(["in.column", "in.row"].map(|name| Column::unsigned(name, 12, i64::from(SIDE) - 1)));
        columns
    }

    fn regressions(&self) -> Vec<Vec<i64>> {
        // Around two rectangles that overlap, and around the surface clip.
        let row = |kind, column, row| vec![kind, 1, 1, 9, 9, 2, 3, 4, 4, 4, 5, 4, 4, column, row];
        (0..3).flat_map(|kind| (0..11).flat_map(move |y| [0, 1, 2, 4, 6, 8, 9, 10].map(|x| row(kind, x, y)))).collect()
    }

    fn fit(&self, inputs: &mut [i64]) {
        // Usually near an edge of one of the rectangles, none of which is small.
        let (which, side) = (inputs[13] as usize % 4, inputs[14] as usize % 4);
        for first in [1, 5, 9] {
            inputs[first] &= 511;
            inputs[first + 1] &= 511;
            inputs[first + 2] |= if inputs[first + 2] & 15 == 0 { 0 } else { 256 };
            inputs[first + 3] |= if inputs[first + 3] & 15 == 0 { 0 } else { 256 };
        }
        if which < 3 {
            let all = rectangle(&inputs[1 + 4 * which..]);
            let (left, top) = (i64::from(all.x), i64::from(all.y));
            let (right, bottom) = (left + i64::from(all.width), top + i64::from(all.height));
            let within = |n: i64, from: i64, to: i64| from + n.rem_euclid((to - from).max(1));
            let (column, row) = (inputs[13], inputs[14]);
            let [x, y] = match side {
                0 => [left - (column >> 2 & 1), within(row, top, bottom)],
                1 => [right - (column >> 2 & 1), within(row, top, bottom)],
                2 => [within(column, left, right), top - (row >> 2 & 1)],
                _ => [within(column, left, right), bottom - (row >> 2 & 1)],
            };
            [inputs[13], inputs[14]] = [x, y].map(|n| n.clamp(0, i64::from(SIDE) - 1));
        }
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let clip = Some(rectangle(&inputs[1..]));
        let target = Target { clip, ..Target::new(SIDE, SIDE, SurfaceFormat::A8R8G8B8) };
        let rectangles = vec![rectangle(&inputs[5..]), rectangle(&inputs[9..])];
        let window_clip = (inputs[0] != 0).then_some(WindowClip { rectangles, exclusive: inputs[0] == 2 });
        let [column, row] = [13, 14].map(|n| inputs[n] as u32);
        let inside = |window: &Rectangle| {
            let within = |n: u32, first: u32, count: u32| (first..first.saturating_add(count)).contains(&n);
            within(column, window.x, window.width) && within(row, window.y, window.height)
        };
        let found = windows(&Draw { window_clip, ..Draw::default() }, &target).iter().filter(|w| inside(w)).count();
        results[0] = found as i64;
    }
}
