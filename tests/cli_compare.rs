//! Tests `ninebit compare` from outside.
#![allow(clippy::unwrap_used, missing_docs, unreachable_pub, dead_code, reason = "a test fails by panicking")]

use crate::bench;

use bench::Bench;
use std::fs;

/// A white triangle, which is exact, and the same triangle through a half-bias product, which is not.
const EXACT: &str = "(version: 1, profile: Nv10, targets: [(name: \"frame\", width: 8, height: 8)], draws: [(vertices: Window([\
                     (position: (0, 0)), (position: (8, 0)), (position: (0, 8))]))])";
const OFF: &str = "(version: 1, profile: Nv10, targets: [(name: \"frame\", width: 8, height: 8)], draws: [(vertices: Window([\
                   (position: (0, 0)), (position: (8, 0)), (position: (0, 8))]), program: Combiners(stages: [(rgb: (\
                   a: ExpandNormal(PrimaryColor), b: (PrimaryColor), ab: Spare0))], final_combiner: (d: (Spare0))))])";

fn bench() -> Bench {
    let bench = Bench::new();
    bench.write("exact.ron", EXACT).write("off.ron", OFF);
    bench
}

#[test]
fn text_and_json_say_the_same() {
    let bench = bench();
    let text = bench.run("compare off.ron --mode follow").text();
    assert!(text.contains("expansion") && !text.contains("CMB-3"), "{text}");
    let value: serde_json::Value =
        serde_json::from_str(&bench.run("compare off.ron --mode follow --format json").text()).unwrap();
    assert_eq!(value["format"], "ninebit-comparison-1");
    assert_eq!(value["channels"]["r"]["max"], 1.0);
    assert!(text.contains("1.0000"), "{text}");
    let same = bench.run("compare off.ron --mode follow --json").text();
    assert_eq!(serde_json::from_str::<serde_json::Value>(&same).unwrap(), value);
    let rules = bench.run("compare off.ron --mode per-op").text();
    assert!(rules.contains("CMB-3") && rules.contains("-1.000 to 1.000") && !rules.contains("EXCEEDED"), "{rules}");
    let literal = bench.run("compare off.ron --policy CMB-3=literal").text();
    assert!(literal.contains("policy CMB-3=literal") && literal.contains("exact"), "{literal}");
}

#[test]
fn heat_maps_are_written_or_refused() {
    let bench = bench();
    bench.run("compare off.ron --heatmap heat.png").text();
    let picture = image::load_from_memory(&fs::read(bench.path("heat.png")).unwrap()).unwrap().to_rgba8();
    // The legend is wider than this frame, and makes the picture wider.
    assert!(picture.width() > 300 && picture.height() == 8 + 36);
    assert_eq!(picture.get_pixel(0, 0).0, [22, 50, 120, 255], "one step");
    assert_eq!(picture.get_pixel(7, 7).0, [40, 40, 40, 255], "not drawn");
    bench.run("compare exact.ron --heatmap none.png").failed(3, "error[NB0523]");
    bench.run("compare off.ron --mode per-op --heatmap none.png").failed(2, "belong to no pixel");
    bench.run("compare off.ron --heatmap -").failed(2, "cannot both go to stdout");
    bench.run("compare off.ron --heatmap off.ron").failed(2, "is the input");
    assert!(!bench.path("none.png").exists());
}

#[test]
fn wrong_arguments_are_told() {
    let bench = bench();
    bench.run("compare off.ron --mode exact").failed(2, "free");
    bench.run("compare off.ron --target other").failed(2, "no target `other`");
    bench.run("compare missing.ron").failed(4, "NB0111");
    bench.run("compare off.ron --json --format text").failed(2, "cannot be used with");
}
