//! Compares the lod of a quad with the lod of each pixel, in `lod-plane.ron`.

use super::page::{Section, cells};
use super::view::{Picture, draw, plan, scene, visit};

pub fn section() -> Section {
    let plan = plan(&scene("lod-plane.ron"));
    let frame = draw(&plan);
    // Results for each band of lod: number of pixels, sum of errors, largest error.
    const BANDS: usize = 5;
    let names = ["below 0 (magnified)", "0 to 1", "1 to 2", "2 to 3", "above 3"];
    let mut errors = [(0_u32, 0.0, 0.0_f64); BANDS];
    let (mut other, mut minified) = (0_u32, 0_u32);
    let mut lods = vec![None; frame.pixels.len()];
    visit(&plan, |covered| {
        let (lod, exact) = (covered.lod(), covered.exact_lod());
        let (i, j) = covered.pixel;
        lods[j as usize * frame.width + i as usize] = Some((lod, exact));
        if covered.draw != 0 {
            return;
        }
        let band = ((exact / 256.0).floor() + 1.0).clamp(0.0, 4.0) as usize;
        let error = (f64::from(lod) - exact).abs();
        let (count, sum, most) = &mut errors[band];
        (*count, *sum, *most) = (*count + 1, *sum + error, most.max(error));
        // TEX-9: returns the nearest level of a lod.
        let level = |lod: i64| (lod + 128) >> 8;
        if exact > 0.0 {
            minified += 1;
            other += u32::from(level(i64::from(lod.max(0))) != level(exact.floor() as i64));
        }
    });
    let mut rows = vec![cells(["exact lod of the pixel", "pixels", "lod of its quad off by, mean, 1/256", "largest"])];
    for (name, (count, sum, most)) in names.iter().zip(errors) {
        rows.push(vec![
            name.to_string(),
            count.to_string(),
            format!("{:.1}", sum / f64::from(count)),
            format!("{most:.0}"),
        ]);
    }
    let steps = steps(&frame, &lods);
    let counted = vec![
        cells(["what shows", "value"]),
        vec![
            "pixels that read another level than their own lod would (left)".to_string(),
            format!("{:.1} % of {minified}", 100.0 * f64::from(other) / f64::from(minified)),
        ],
        vec!["largest step of a channel from one quad to the next (right)".to_string(), format!("{} of 255", steps)],
    ];
    let close = frame.part(80, 70, 64, 48);
    Section {
        name: "lod",
        tables: vec![rows, counted],
        pictures: vec![(
            "lod-plane.svg",
            vec![vec![
                frame.part(0, 0, 256, 192).tile("nearest level"),
                frame.part(256, 0, 256, 192).tile("two levels mixed"),
                close.tile("nearest level, a part four times as large"),
            ]],
        )],
        charts: vec![],
    }
}

/// Returns the largest difference of a channel between adjacent pixels of the right half that are both minified.
fn steps(frame: &Picture, lods: &[Option<(i32, f64)>]) -> u8 {
    let minified = |x: usize, y: usize| lods[y * frame.width + x].is_some_and(|(lod, _)| lod > 0);
    let mut most = 0;
    for y in 0..frame.height - 1 {
        for x in 256..frame.width - 1 {
            for (i, j) in [(x + 1, y), (x, y + 1)] {
                if minified(x, y) && minified(i, j) {
                    let (a, b) = (frame.at(x, y), frame.at(i, j));
                    most = (0..3).map(|n| a[n].abs_diff(b[n])).max().unwrap().max(most);
                }
            }
        }
    }
    most
}
