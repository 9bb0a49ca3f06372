//! Examples of the section "Numbers".

use crate::handbook::{example, policy};
use crate::pixel::load_spare0;
use ninebit::combiner::general::{self, PlannedPortion, PlannedStage};
use ninebit::combiner::registers::Registers;
use ninebit::limits::Limits;
use ninebit::number::{Factor, Register as _, Sum, convert};
use ninebit::raster::interpolate::Sample;
use ninebit::raster::setup::Triangle;
use ninebit::state::{Component, MuxSelect, Policies, Portion, Profile, Register};
use ninebit::trace::{Silent, report};
use ninebit_scene as scene;
use std::path::Path;

#[test]
fn examples_of_numbers() {
    let num0 = example("NUM-0", "0.5 becomes floor(127.5 + 0.5) = 128.");
    num0.gives("a constant of 0.5", convert::constant(0.5), 128);
    let text = "(version: 1, profile: Nv10, targets: [(clear: (color: Float(0.5, 0, 0)))], draws: [])";
    let cleared = scene::parse(text, Path::new("test.ron"), &Limits::default()).unwrap_or_else(|e| panic!("{e}"));
    num0.gives("0.5 in a scene", cleared.scene.targets[0].clear_color, [128, 0, 0, 255]);

    let num1 = example("NUM-1", "255 is 1.0, 51 is 0.2, -255 is -1.0.");
    let real = |n: i32| report::register_step("", "NUM-1", "", n).real();
    num1.gives("255", real(255), 1.0).gives("51", real(51), 0.2).gives("-255", real(-255), -1.0);

    let num2 = example("NUM-2", "rnd255(20000) = floor(40255 / 510) = 78 (78.43); rnd255(-20000) = -78.");
    let product = |a: i32, b: i32| a.factor().product(b.factor()).rounded();
    num2.gives("rnd255(100 * 200)", product(100, 200), 78).gives("rnd255(-100 * 200)", product(-100, 200), -78);
    num2.shows("20000 / 255", 20_000.0 / 255.0, 2, "78.43");

    let num3 = example("NUM-3", "300 becomes 255; -300 becomes -256, or -255 under the alternative.");
    let limited = |n: i32, policies: Policies| n.saturated(policies.register_floor);
    num3.gives("300", limited(300, Policies::DEFAULT), 255);
    num3.gives("-300", limited(-300, Policies::DEFAULT), -256);
    num3.gives("-300 under NUM-3=255", limited(-300, policy("NUM-3=255")), -255);

    let num4 = example(
        "NUM-4",
        "0.1 is 13421773 / 2^27; cut to 13421568 / 2^27 it gives floor(25.4996 + 0.5) = 25, where the uncut number \
         (25.50000038) would give 26.",
    );
    num4.gives("0.1", convert::split(0.1), (13_421_773, -27));
    num4.gives("cut to 14 bits", 13_421_773 >> 10 << 10, 13_421_568);
    num4.shows("255 times the cut number", 255.0 * 13_421_568.0 / 2_f64.powi(27), 4, "25.4996");
    num4.shows("255 times the uncut number", 255.0 * 13_421_773.0 / 2_f64.powi(27), 8, "25.50000038");
    num4.gives("a vertex colour of 0.1", convert::vertex_color(0.1), 25);
    // NUM-0 does not cut.
    num4.gives("0.1 uncut", convert::constant(0.1), 26);

    let num5 = example("NUM-5", "constant byte 127 is the register value 127, not 128.");
    num5.gives("constant byte 127", constant_in_spare0(127), 127);

    let num6 = example("NUM-6", "f = 0.25: v = 1024, (1024 - 4) >> 4 = 63. f = 1: (4096 - 16) >> 4 = 255.");
    num6.gives("v of 0.25", in_4096ths(0.25), 1024).gives("the byte of 0.25", convert::factor_byte(1024), 63);
    num6.gives("v of 1", in_4096ths(1.0), 4096).gives("the byte of 1", convert::factor_byte(4096), 255);
}

/// What a general stage reads from a constant, through the mapping that changes nothing.
fn constant_in_spare0(byte: u8) -> i32 {
    let planned = PlannedPortion::whole;
    let stage = PlannedStage {
        index: 0,
        rgb: planned(load_spare0(Component::Rgb, Register::ConstantColor0), 7),
        alpha: planned(Portion::idle(Component::Alpha), 8),
        constants: [[byte; 4], [0; 4]],
        reads_constants: true,
    };
    let mut registers = Registers::<i32>::new();
    general::run(&stage, MuxSelect::Msb, &Policies::DEFAULT, &mut registers, &mut Silent);
    registers.read(Register::Spare0, 0)
}

/// NUM-6: floor(4096 f) of a factor that all three vertices share.
fn in_4096ths(f: f32) -> i64 {
    let corners = [[0.0, 0.0, 0.0, 1.0], [96.0, 0.0, 0.0, 1.0], [0.0, 96.0, 0.0, 1.0]];
    let triangle = Triangle::new(corners, true, Profile::Nv2a).unwrap();
    Sample::new(&triangle, triangle.edges(10, 2)).factor(&triangle.factor([f; 3]))
}
