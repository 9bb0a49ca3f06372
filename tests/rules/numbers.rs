//! Computes the examples of the section "Numbers".

use crate::handbook::{beside_rows, example};
use ninebit::limits::Limits;
use ninebit::number::convert;
use ninebit::trace::report;
use ninebit_scene as scene;
use std::path::Path;

#[test]
fn examples_of_numbers() {
    let num0 = beside_rows("NUM-0");
    let text = "(version: 1, profile: Nv10, targets: [(clear: (color: Float(0.5, 0, 0)))], draws: [])";
    let cleared = scene::parse(text, Path::new("test.ron"), &Limits::default()).unwrap_or_else(|e| panic!("{e}"));
    num0.gives("0.5 in a scene", cleared.scene.targets[0].clear_color, [128, 0, 0, 255]);

    let num1 = example("NUM-1", "255 is 1.0, 51 is 0.2, -255 is -1.0.");
    let real = |n: i32| report::register_step("", "NUM-1", "", n).real();
    num1.gives("255", real(255), 1.0).gives("51", real(51), 0.2).gives("-255", real(-255), -1.0);

    let num2 = beside_rows("NUM-2");
    num2.shows("20000 / 255", 20_000.0 / 255.0, 2, "78.43");

    let num4 = beside_rows("NUM-4");
    num4.gives("0.1", convert::split(0.1), (13_421_773, -27));
    num4.gives("cut to 14 bits", 13_421_773 >> 10 << 10, 13_421_568);
    num4.shows("255 times the cut number", 255.0 * 13_421_568.0 / 2_f64.powi(27), 4, "25.4996");
    num4.shows("255 times the uncut number", 255.0 * 13_421_773.0 / 2_f64.powi(27), 8, "25.50000038");
}
