//! Tests `ninebit diff`: the comparison itself, against a naive one, and the command.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::bench;

use bench::{Bench, Run};
use ninebit_files::output::{Compression, encode_png};
use ninebit_scene::diff::{Options, compare};
use ninebit_scene::image::{ImageLimits, Rgba, load};
use proptest::prelude::*;
use serde_json::Value;

/// Returns the regions that differ, found pixel by pixel.
fn naive_regions(a: &Rgba, b: &Rgba) -> Vec<Vec<(u32, u32)>> {
    let differs = |x: u32, y: u32| {
        let at = (y * a.width() + x) as usize;
        a.pixels()[at] != b.pixels()[at]
    };
    let mut seen = vec![false; a.pixels().len()];
    let mut regions = Vec::new();
    for (y, x) in (0..a.height()).flat_map(|y| (0..a.width()).map(move |x| (y, x))) {
        let mut region = Vec::new();
        let mut waiting = vec![(x, y)];
        while let Some((x, y)) = waiting.pop() {
            let at = (y * a.width() + x) as usize;
            if seen[at] || !differs(x, y) {
                continue;
            }
            seen[at] = true;
            region.push((y, x));
            for (y, x) in (y.saturating_sub(1)..=y + 1).flat_map(|y| (x.saturating_sub(1)..=x + 1).map(move |x| (y, x)))
            {
                if x < a.width() && y < a.height() {
                    waiting.push((x, y));
                }
            }
        }
        if !region.is_empty() {
            region.sort_unstable();
            regions.push(region);
        }
    }
    regions.sort_by_key(|region| (std::cmp::Reverse(region.len()), region[0]));
    regions
}

fn pictures() -> impl Strategy<Value = (Rgba, Rgba)> {
    (1_u32..24, 1_u32..24, 1_u8..8).prop_flat_map(|(width, height, rarity)| {
        let count = (width * height) as usize;
        let pixel = (any::<[u8; 4]>(), any::<[u8; 4]>(), 0..rarity);
        prop::collection::vec(pixel, count).prop_map(move |pixels| {
            let a = pixels.iter().map(|(a, _, _)| *a).collect();
            let b = pixels.iter().map(|(a, b, keep)| if *keep == 0 { *b } else { *a }).collect();
            (Rgba::new(width, a), Rgba::new(width, b))
        })
    })
}

proptest! {
    /// Counts, histograms and regions equal those of a naive comparison, which does not work by rows and runs.
    #[test]
    fn counts_are_those_of_a_naive_comparison((a, b) in pictures()) {
        let found = compare(&a, &b, &Options { ignore_alpha: false, regions: 1000 }).unwrap();
        let pairs: Vec<_> = a.pixels().iter().zip(b.pixels()).collect();
        prop_assert_eq!(found.different, pairs.iter().filter(|(a, b)| a != b).count() as u64);
        for n in 0..4 {
            let steps: Vec<i16> = pairs.iter().map(|(a, b)| i16::from(b[n]) - i16::from(a[n])).collect();
            for step in (-255..=255).filter(|step| *step != 0) {
                let count = steps.iter().filter(|s| **s == step).count() as u64;
                prop_assert_eq!(found.channels[n].between(step, step), count);
            }
            let buckets: u64 = found.channels[n].buckets().iter().map(|bucket| bucket.pixels).sum();
            prop_assert_eq!((buckets, found.channels[n].different()), (buckets, buckets));
            prop_assert_eq!(u16::from(found.channels[n].largest()), steps.iter().map(|s| s.unsigned_abs()).max().unwrap());
        }
        let naive = naive_regions(&a, &b);
        prop_assert_eq!(found.region_count, naive.len() as u64);
        for (region, pixels) in found.regions.iter().zip(&naive) {
            prop_assert_eq!(region.pixels, pixels.len() as u64);
            prop_assert_eq!((region.first.1, region.first.0), pixels[0]);
            let columns = || pixels.iter().map(|pixel| pixel.1);
            let (left, right) = (columns().min().unwrap(), columns().max().unwrap());
            let (top, bottom) = (pixels[0].0, pixels[pixels.len() - 1].0);
            prop_assert_eq!((region.x, region.width), (left, right - left + 1));
            prop_assert_eq!((region.y, region.height), (top, bottom - top + 1));
        }
        let few = compare(&a, &b, &Options { ignore_alpha: false, regions: 2 }).unwrap();
        prop_assert_eq!(&few.regions[..], &found.regions[..found.regions.len().min(2)]);
    }
}

const SCENE: &str = r#"(
    version: 1,
    profile: Nv2a,
    targets: [(name: "frame", width: 8, height: 4), (name: "spare", width: 2, height: 2)],
    draws: [(name: "triangle", vertices: Window([
        (position: (0, 0), diffuse: (255, 0, 0, 255)),
        (position: (0, 4), diffuse: (255, 0, 0, 255)),
        (position: (8, 4), diffuse: (255, 0, 0, 255)),
    ]))],
)"#;

/// Returns a folder with the frame of the scene as `a.png`, and the same frame with four changed pixels as `b.png`.
fn bench() -> Bench {
    let bench = Bench::new();
    bench.write("scene.ron", SCENE);
    bench.run("render scene.ron -o a.png").data();
    let mut picture = load(&bench.path("a.png"), &ImageLimits::default()).unwrap();
    for (x, y, pixel) in
        [(0, 3, [250, 0, 1, 255]), (1, 3, [250, 0, 0, 255]), (2, 2, [255, 90, 0, 255]), (7, 0, [0, 0, 0, 0])]
    {
        picture.pixels_mut()[y * 8 + x] = pixel;
    }
    write(&bench, "b.png", &picture);
    bench
}

fn write(bench: &Bench, name: &str, picture: &Rgba) {
    let bytes = encode_png(picture.width(), picture.height(), picture.pixels(), Compression::Small).unwrap();
    bench.write(name, bytes);
}

/// Checks that the pictures differ: status 1, and nothing on stderr. Returns the report on stdout.
fn different(run: Run) -> String {
    assert_eq!((run.status, run.stderr.as_str()), (1, ""));
    String::from_utf8(run.stdout).unwrap()
}

#[test]
fn differences_are_reported() {
    let bench = bench();
    snapbox::assert_data_eq!(different(bench.run("diff a.png b.png")), snapbox::file!["cli/diff.txt"]);
    let few = different(bench.run("diff a.png b.png --regions 1 --ignore-alpha"));
    assert!(few.contains("alpha not compared") && !few.contains("alpha\n"), "{few}");
    assert!(few.contains("\n1 region\n"), "only alpha differs in the other region: {few}");
    assert!(different(bench.run("diff a.png b.png --regions 0")).contains("and 2 more"));
}

#[test]
fn equal_pictures_are_status_0() {
    let bench = bench();
    let text = bench.run("diff a.png a.png").text();
    assert!(text.ends_with("\nequal\n"), "{text}");
    let json: Value = serde_json::from_str(&bench.run("diff a.png a.png --format json").text()).unwrap();
    assert_eq!((&json["equal"], &json["regions"]), (&true.into(), &Value::Array(vec![])));
}

/// The missing alpha of a screenshot in a 24-bit TGA counts as 255.
#[test]
fn a_picture_without_alpha_is_opaque() {
    let bench = bench();
    let picture = load(&bench.path("a.png"), &ImageLimits::default()).unwrap();
    let mut tga = vec![0; 18];
    (tga[2], tga[12], tga[14], tga[16], tga[17]) = (2, 8, 4, 24, 0x20);
    tga.extend(picture.pixels().iter().flat_map(|[r, g, b, _]| [*b, *g, *r]));
    bench.write("a.tga", &tga);
    assert!(bench.run("diff a.png a.tga").text().ends_with("\nequal\n"));
    let glass = Rgba::new(picture.width(), picture.pixels().iter().map(|[r, g, b, _]| [*r, *g, *b, 9]).collect());
    write(&bench, "glass.png", &glass);
    assert!(different(bench.run("diff glass.png a.tga")).contains("32 of 32 pixels (100.00 %), by 246 at most"));
    bench.run("diff glass.png a.tga --ignore-alpha").data();
}

#[test]
fn the_scene_tells_who_is_right() {
    let bench = bench();
    let text = different(bench.run("diff b.png a.png --scene scene.ron"));
    assert!(text.contains("A differs from it in 4 pixels\n  B equals it"), "{text}");
    let trace = bench.run("trace scene.ron --pixel 2,2").text();
    assert!(text.contains(&trace), "the first pixel of the largest region is 2,2: {text}");
    let json: Value =
        serde_json::from_str(&different(bench.run("diff b.png a.png --scene scene.ron --format json"))).unwrap();
    let trace: Value = serde_json::from_str(&bench.run("trace scene.ron --pixel 2,2 --format json").text()).unwrap();
    assert_eq!(json["format"], "ninebit-diff-1");
    assert_eq!(json["regions"][0]["trace"], trace);
    assert_eq!((&json["scene"]["a_differs"], &json["scene"]["b_differs"]), (&4.into(), &0.into()));
    assert_eq!((&json["different"], &json["region_count"], &json["largest"]), (&4.into(), &2.into(), &255.into()));
    let text = bench.run("diff a.png a.png --scene scene.ron --target frame --policy CMB-7=each").text();
    assert!(text.contains("A equals it\n  B equals it"), "{text}");
}

#[test]
fn the_difference_is_drawn() {
    let bench = bench();
    let text = different(bench.run("diff a.png b.png -o d.png --ignore-alpha"));
    assert!(text.contains("d.png: |B - A| times 2 where"), "{text}");
    let drawn = load(&bench.path("d.png"), &ImageLimits::default()).unwrap();
    let at = |x: usize, y: usize| drawn.pixels()[y * 8 + x];
    assert_eq!((drawn.width(), drawn.height()), (8, 4));
    assert_eq!((at(2, 2), at(0, 3), at(1, 2)), ([0, 180, 0, 255], [10, 0, 2, 255], [21, 21, 21, 255]));
    let json: Value = serde_json::from_str(&different(bench.run("diff a.png b.png -o d.png --format json"))).unwrap();
    assert_eq!((&json["picture"]["path"], &json["picture"]["scale"]), (&"d.png".into(), &1.into()));
}

/// Compares two depth buffers with each other and with the scene that produced one of them.
#[test]
fn depth_buffers_are_compared() {
    let bench = bench();
    for (name, depth) in [("near", "0.25"), ("far", "0.75")] {
        let scene = format!(
            "(version: 1, profile: Nv10, targets: [(name: \"frame\", width: 8, height: 4, depth: Z24S8, clear: (depth: {depth}))], draws: [])"
        );
        bench.write(&format!("{name}.ron"), scene);
        assert_eq!(bench.run(&format!("render {name}.ron -o {name}.png --depth {name}-depth.png")).status, 0);
    }
    assert_eq!(bench.run("diff near-depth.png near-depth.png --scene near.ron").status, 0);
    let run = bench.run("diff near-depth.png far-depth.png --scene near.ron");
    assert_eq!(run.status, 1);
    let text = String::from_utf8(run.stdout).unwrap();
    assert!(text.contains("A equals it\n  B differs from it in 32 pixels"), "{text}");
    assert!(text.contains("R 128 G 0 B 0 A 0"), "{text}");
    for (command, code) in
        [("diff near-depth.png near.png", "NB0521"), ("diff near-depth.png near-depth.png --scene scene.ron", "NB0522")]
    {
        let run = bench.run(command);
        assert_eq!(run.status, 3, "{command}: {}", run.stderr);
        assert!(run.stderr.contains(code), "{command}: {}", run.stderr);
    }
}

#[test]
fn errors_say_what_to_do() {
    let bench = bench();
    write(&bench, "small.png", &Rgba::new(2, vec![[0; 4]; 4]));
    bench.write("not.png", "GIF89a").write("broken.ron", "(version: 1,");
    for (command, status, said) in [
        ("diff a.png", 2, "<B.png>"),
        (
            "diff a.png small.png",
            3,
            "error[NB0521]: the pictures differ in size: `a.png` is 8 x 4, `small.png` is 2 x 2",
        ),
        ("diff small.png small.png --scene scene.ron", 3, "error[NB0522]: target `frame` of `scene.ron` is 8 x 4"),
        ("diff small.png small.png --scene scene.ron --target attic", 2, "its targets: `frame`, `spare`"),
        ("diff a.png elsewhere-entirely.png", 4, "help: check the spelling and the folder"),
        ("diff a.png not.png", 3, "error[NB0513]"),
        ("diff a.png b.png --scene none.ron", 4, "none.ron"),
        ("diff a.png b.png --scene broken.ron", 3, "broken.ron"),
        ("diff a.png b.png --target frame", 2, "--scene"),
        ("diff a.png b.png --policy CMB-7=each", 2, "`--scene SCENE`"),
        ("diff a.png b.png --scene scene.ron --policy CMB-7=never", 2, "once, each"),
        ("diff a.png b.png --regions 1001", 2, "not a number from 0 to 1000"),
        ("diff a.png b.png -o -", 2, "cannot both go to stdout"),
        ("diff a.png b.png -o a.png", 2, "is the input"),
        ("diff a.png b.png -o none/d.png", 7, "create its folder first"),
    ] {
        bench.run(command).failed(status, said);
    }
}
