//! Normals that filtering shortens, drawn by `filtered-length.ron` and `seams.ron`.

use super::chart::{line, lines};
use super::content::{BALL, PAIRS, dot, length, pair, pair_angle, unit};
use super::page::{Section, cells};
use super::view::{Picture, draw, plan, scene};
use crate::repository::at;
use ninebit::texture::filter::lerp;
use ninebit_lab::chart::picture::{Axis, Drawing};

pub fn section() -> Section {
    let frame = draw(&plan(&scene("filtered-length.ron")));
    let mut rows = vec![cells(["angle", "length", "of the chip", "N . L renormalised", "of the chip", "steps lost"])];
    for angle in [0, 15, 30, 45, 60, 90, 120, 150, 180] {
        let row = (0..PAIRS).find(|row| pair_angle(*row) == f64::from(angle)).unwrap();
        let mixed = mix(row, 128);
        // The light direction is half way between the two normals, where a ridge should be brightest.
        let light = round_255(mixed[2] * expand_normal(255));
        let exact = (f64::from(angle) / 2.0).to_radians().cos();
        let renormalised = if angle == 180 { "none".to_string() } else { "255".to_string() };
        rows.push(vec![
            format!("{angle} degrees"),
            format!("{exact:.3}"),
            format!("{:.3}", fixed_length(mixed)),
            renormalised,
            light.to_string(),
            (255 - light).to_string(),
        ]);
    }

    let (mut worst, mut at) = (0.0_f64, (0, 0));
    for row in 0..PAIRS {
        for weight in 0..256 {
            let mixed = mix(row, weight);
            // The scene shows the same value.
            let shown = i32::from(frame.at(weight as usize, row)[0]);
            assert_eq!(shown, round_255(mixed.iter().map(|n| n * n).sum::<i32>()).min(255), "{row} {weight}");
            let difference = (fixed_length(mixed) - exact_length(row, weight)).abs();
            if difference > worst {
                (worst, at) = (difference, (row, weight));
            }
        }
    }
    let balls = draw(&plan(&scene("seams.ron")));
    let exact = renormalised();
    let error = |panel: usize| {
        let (mut most, mut squares) = (0.0_f64, 0.0);
        for (n, want) in exact.iter().enumerate() {
            let error = f64::from(balls.at(256 * panel + n % 256, n / 256)[0]) - want;
            (most, squares) = (most.min(error), squares + error * error);
        }
        vec![format!("{:.1}", -most), format!("{:.1}", (squares / exact.len() as f64).sqrt())]
    };
    let of = |label: &str, values: Vec<String>| [vec![label.to_string()], values].concat();
    let highlight = vec![
        cells(["highlight (N . H)^8, against renormalising exactly", "largest loss, steps", "rms, steps"]),
        of("N as the filter gives it", error(0)),
        of("one step of Newton's method before", error(1)),
    ];
    let fixed = vec![
        cells(["chip against float64", "value"]),
        of(
            "largest difference of the lengths, every weight and angle",
            vec![format!("{worst:.4} (at {:.0} degrees, weight {}/256)", pair_angle(at.0), at.1)],
        ),
    ];
    let wanted = Picture::from(256, 256, |x, y| [exact[256 * y + x].round() as u8; 3]);
    let panels = vec![
        balls.part(0, 0, 256, 256).tile("as the filter gives it: creases"),
        balls.part(256, 0, 256, 256).tile("one step of Newton's method"),
        wanted.tile("renormalised exactly"),
    ];
    Section {
        name: "lengths",
        tables: vec![rows, fixed, highlight],
        pictures: vec![
            ("filtered-length.svg", vec![vec![frame.tile("N . N: weight across, angle down")]]),
            ("seams.svg", vec![panels]),
        ],
        charts: vec![("filtered-lengths.svg", length_chart())],
    }
}

/// Returns the mix of the two normals of a row, in 255ths, as a combiner input reads it.
fn mix(row: usize, weight: i32) -> [i32; 3] {
    let [a, b] = pair(row);
    std::array::from_fn(|n| expand_normal(lerp(i32::from(a[n]), i32::from(b[n]), weight)))
}

fn fixed_length(v: [i32; 3]) -> f64 {
    length(v.map(|n| f64::from(n) / 255.0))
}

fn exact_length(row: usize, weight: i32) -> f64 {
    let half = pair_angle(row).to_radians() / 2.0;
    let t = 2.0 * f64::from(weight) / 256.0 - 1.0;
    length([t * half.sin(), 0.0, half.cos()])
}

/// Returns the highlight of `seams.ron`, in 255ths, with the filtered normals renormalised in float64.
fn renormalised() -> Vec<f64> {
    let map = image::open(at("vectors/scenes/stability/ball-normal.png")).unwrap().to_rgb8();
    let last = i64::from(BALL) - 1;
    let normal = |x: i64, y: i64| {
        let pixel = map.get_pixel(x.clamp(0, last) as u32, y.clamp(0, last) as u32);
        pixel.0.map(|byte| (f64::from(byte) - 128.0) / 127.0)
    };
    let half = unit([109.0, 141.0, 253.0].map(|byte| (byte - 128.0) / 127.0));
    let value = |n: usize| {
        let along = |pixel: usize| (pixel as f64 + 0.5) * 0.75 * f64::from(BALL) / 256.0;
        let [u, v] = [along(n % 256), along(n / 256)];
        let (x, y) = (u.floor(), v.floor());
        let mut mixed = [0.0; 3];
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let share = |d: i64, fraction: f64| if d == 1 { fraction } else { 1.0 - fraction };
            let weight = share(dx, u - x) * share(dy, v - y);
            let texel = normal(x as i64 + dx, y as i64 + dy);
            mixed = std::array::from_fn(|n| mixed[n] + weight * texel[n]);
        }
        255.0 * dot(unit(mixed), half).max(0.0).powi(8)
    };
    (0..256 * 256).map(value).collect()
}

fn length_chart() -> Drawing {
    let over = |length: &dyn Fn(f64) -> f64| {
        (0..=240).map(|row| [pair_angle(row), length(fixed_length(mix(row, 128)))]).collect::<Vec<_>>()
    };
    Drawing {
        title: "Half-way between two normals".to_string(),
        x: Axis::linear("angle between the two texels, degrees", [0.0, 180.0].into_iter(), true),
        y: Axis::linear("length", [0.0, 1.0].into_iter(), true),
        ..lines(vec![
            line(0, "after one step of Newton's method", over(&|length| length * (3.0 - length * length) / 2.0)),
            line(1, "as the filter gives it", over(&|length| length)),
        ])
    }
}

/// CMB-3: returns the expanded byte in 255ths.
fn expand_normal(byte: i32) -> i32 {
    2 * (byte - 128)
}

/// NUM-2: divides by 255 and rounds to nearest.
fn round_255(n: i32) -> i32 {
    (2 * n + 255).div_euclid(510)
}
