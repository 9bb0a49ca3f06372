//! Examples of the section "General combiner stages".

use crate::handbook::{example, policy};
use crate::pixel::{Pixel, covering, load_spare0, scene};
use ninebit::combiner::general::{self, PlannedPortion, PlannedStage};
use ninebit::combiner::mapping;
use ninebit::combiner::registers::Registers;
use ninebit::limits::Limits;
use ninebit::state::*;
use ninebit::trace::Silent;
use std::path::Path;

const DEFAULT: Policies = Policies::DEFAULT;

/// Where A, B, C and D of [`products`] come from; any value can be loaded there.
const SOURCES: [Register; 4] = [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3];

/// An RGB portion that leaves AB, CD and their sum in SPARE0, SPARE1 and PRIMARY. Inputs are taken as they are.
fn products() -> Portion {
    let mut portion = Portion::idle(Component::Rgb);
    for (input, register) in portion.inputs.iter_mut().zip(SOURCES) {
        *input = CombinerInput { register, mapping: InputMapping::SignedIdentity, ..*input };
    }
    let [ab_output, cd_output, sum_output] = [Register::Spare0, Register::Spare1, Register::PrimaryColor];
    Portion { ab_output, cd_output, sum_output, ..portion }
}

/// Runs one stage whose alpha portion is idle.
fn run(rgb: Portion, select: MuxSelect, policies: &Policies, registers: &mut Registers<i32>) {
    run_both(rgb, Portion::idle(Component::Alpha), select, policies, registers);
}

fn run_both(rgb: Portion, alpha: Portion, select: MuxSelect, policies: &Policies, registers: &mut Registers<i32>) {
    let stage = PlannedStage {
        index: 0,
        rgb: PlannedPortion::whole(rgb, 7),
        alpha: PlannedPortion::whole(alpha, 8),
        constants: [[0; 4]; 2],
        reads_constants: false,
    };
    general::run(&stage, select, policies, registers, &mut Silent);
}

/// AB, CD and the sum of [`products`] for grey inputs, as registers.
fn outputs(rgb: Portion, abcd: [i32; 4], policies: Policies) -> [i32; 3] {
    let mut registers = Registers::new();
    for (register, value) in SOURCES.into_iter().zip(abcd) {
        registers.load(register, [value; 4]);
    }
    run(rgb, MuxSelect::Msb, &policies, &mut registers);
    [rgb.ab_output, rgb.cd_output, rgb.sum_output].map(|register| registers.read(register, 0))
}

/// A mapped value, halves and all.
fn mapped(x: i32, mapping: InputMapping, policies: Policies) -> f64 {
    let [factor] = mapping::map([x], mapping, &policies);
    f64::from(factor.0) / 2.0
}

/// What a mux takes for a value of SPARE0.a.
fn mux(spare0_alpha: i32, select: MuxSelect, policies: Policies) -> &'static str {
    let mut registers = Registers::new();
    for (register, value) in SOURCES.into_iter().zip([1, 255, 2, 255]) {
        registers.load(register, [value; 4]);
    }
    registers.write(Register::Spare0, 3, spare0_alpha);
    run(Portion { mux: true, ..products() }, select, &policies, &mut registers);
    ["", "AB", "CD"][registers.read(Register::PrimaryColor, 0) as usize]
}

#[test]
fn examples_of_the_general_stage() {
    let cmb1 = example(
        "CMB-1",
        "AB = SPARE0 to SPARE1 and CD = SPARE1 to SPARE0 in one stage exchanges them; its alpha portion reads the blue of \
         SPARE0 as it was.",
    );
    let mut exchange = products();
    exchange.inputs[0].register = Register::Spare0;
    exchange.inputs[2].register = Register::Spare1;
    (exchange.ab_output, exchange.cd_output) = (Register::Spare1, Register::Spare0);
    let mut alpha = load_spare0(Component::Alpha, Register::Spare0);
    alpha.inputs[0].component = Component::Blue;
    let mut registers = Registers::new();
    registers.load(Register::Spare0, [10, 20, 30, 0]);
    registers.load(Register::Spare1, [-40, -50, -60, 0]);
    registers.load(Register::Texture1, [255; 4]);
    registers.load(Register::Texture3, [255; 4]);
    run_both(exchange, alpha, MuxSelect::Msb, &DEFAULT, &mut registers);
    cmb1.gives("SPARE0", registers.values[Register::Spare0 as usize], [-40, -50, -60, 30]);
    cmb1.gives("SPARE1", registers.values[Register::Spare1 as usize], [10, 20, 30, 0]);

    mappings();

    let cmb6 = example("CMB-6", "100 * 200 = 20000, written as 78.");
    cmb6.gives("AB", outputs(products(), [100, 200, 0, 0], DEFAULT)[0], 78);

    let cmb7 = example("CMB-7", "100 * 200 twice: rnd255(40000) = 157; each: 78 + 78 = 156.");
    let twice = [100, 200, 100, 200];
    cmb7.gives("AB, CD, sum", outputs(products(), twice, DEFAULT), [78, 78, 157]);
    cmb7.gives("the same under CMB-7=each", outputs(products(), twice, policy("CMB-7=each")), [78, 78, 156]);

    let cmb8 = example("CMB-8", "(100, 100, 100) . (200, 200, 200): rnd255(60000) = 235; each: 3 * 78 = 234.");
    let dot = Portion { ab_dot_product: true, ..products() };
    cmb8.gives("AB", outputs(dot, [100, 200, 0, 0], DEFAULT)[0], 235);
    cmb8.gives("AB under CMB-8=each", outputs(dot, [100, 200, 0, 0], policy("CMB-8=each"))[0], 234);

    let cmb9 = example(
        "CMB-9",
        "100 * 200 with x2: 78 * 2 = 156; after: rnd255(40000) = 157. -1 halved is (-1 + 1) >> 1 = 0.",
    );
    let scaled =
        |scale, ab: [i32; 2], policies| outputs(Portion { scale, ..products() }, [ab[0], ab[1], 0, 0], policies)[0];
    cmb9.gives("x2", scaled(Scale::Two, [100, 200], DEFAULT), 156);
    cmb9.gives("x2 under CMB-9=after", scaled(Scale::Two, [100, 200], policy("CMB-9=after")), 157);
    cmb9.gives("-1 halved", scaled(Scale::Half, [-1, 255], DEFAULT), 0);

    let cmb10 = example(
        "CMB-10",
        "0x82 takes CD by its top bit and AB by its low bit; -1 takes AB, or CD under bit7, and CD by its low bit.",
    );
    cmb10.gives("0x82, top bit", mux(0x82, MuxSelect::Msb, DEFAULT), "CD");
    cmb10.gives("0x82, low bit", mux(0x82, MuxSelect::Lsb, DEFAULT), "AB");
    cmb10.gives("-1, top bit", mux(-1, MuxSelect::Msb, DEFAULT), "AB");
    cmb10.gives("-1, top bit, under CMB-10=bit7", mux(-1, MuxSelect::Msb, policy("CMB-10=bit7")), "CD");
    cmb10.gives("-1, low bit", mux(-1, MuxSelect::Lsb, DEFAULT), "CD");

    let cmb11 = example("CMB-11", "AB of (10, 20, 50) * 255 leaves (10, 20, 50, 50).");
    let mut registers = Registers::new();
    registers.load(Register::Texture0, [10, 20, 50, 0]);
    registers.load(Register::Texture1, [255; 4]);
    run(Portion { ab_blue_to_alpha: true, ..products() }, MuxSelect::Msb, &DEFAULT, &mut registers);
    cmb11.gives("SPARE0", registers.values[Register::Spare0 as usize], [10, 20, 50, 50]);

    let cmb12 = example("CMB-12", "three stages under `profile: Nv10` are refused (NB0301).");
    let refused = |profile: &str| {
        let program = "(stages: [(rgb: (a: Texture0, ab: Spare0)), (), (rgb: (a: Spare0, ab: Spare1))])";
        let text = format!(
            "(version: 1, profile: {profile}, draws: [(vertices: Window([(position: (0, 0)), (position: (0, 9)), \
             (position: (9, 9))]), program: Combiners{program})])"
        );
        let read = ninebit_scene::parse(&text, Path::new("test.ron"), &Limits::default());
        read.err().map(|e| e.diagnostics.iter().map(|d| (d.code, d.rule)).collect::<Vec<_>>())
    };
    cmb12.gives("Nv10", refused("Nv10"), Some(vec![("NB0301", Some("CMB-12"))])).gives("Nv2a", refused("Nv2a"), None);

    let cmb13 = example("CMB-13", "without textures SPARE0 starts as (0, 0, 0, 255).");
    let draw = Draw { combiners: Combiners::showing(FinalRegister::Spare0), ..covering(Vertex::default()) };
    let scene = scene(Profile::Nv10, SurfaceFormat::A8R8G8B8, [1, 2, 3, 4], vec![draw]);
    let shown = Pixel::from_scene(&scene, DEFAULT);
    cmb13.gives("the word that shows it", shown.word, 0xff00_0000);
    cmb13.gives("a read of what no document defines is marked", shown.step("spare0.r").note.is_some(), true);
}

/// CMB-2 to CMB-5.
fn mappings() {
    use InputMapping::*;

    let cmb2 = example("CMB-2", "37 gives 37 and 218; -5 gives 0 and 255.");
    let unsigned = |x| [UnsignedIdentity, UnsignedInvert].map(|mapping| mapped(x, mapping, DEFAULT));
    cmb2.gives("37", unsigned(37), [37.0, 218.0]).gives("-5", unsigned(-5), [0.0, 255.0]);

    let cmb3 = example("CMB-3", "0, 128, 255 give -256, 0, 254; negate gives 255, 0, -254.");
    let of = |x: [i32; 3], mapping, policies| x.map(|x| mapped(x, mapping, policies));
    cmb3.gives("normal", of([0, 128, 255], ExpandNormal, DEFAULT), [-256.0, 0.0, 254.0]);
    cmb3.gives("negate", of([0, 128, 255], ExpandNegate, DEFAULT), [255.0, 0.0, -254.0]);
    // From the line of its policy: 127 gives -1, 128 gives 1; no zero.
    cmb3.gives("under CMB-3=literal", of([0, 127, 128], ExpandNormal, policy("CMB-3=literal")), [-255.0, -1.0, 1.0]);

    let cmb4 = example(
        "CMB-4",
        "0, 128, 200 give -128, 0, 72. Under 127.5, 200 is 72.5, and 72.5 * 100 rounds to 28 (28.43).",
    );
    cmb4.gives("normal", of([0, 128, 200], HalfBiasNormal, DEFAULT), [-128.0, 0.0, 72.0]);
    cmb4.gives("200 under CMB-4=127", mapped(200, HalfBiasNormal, policy("CMB-4=127")), 73.0);
    let halves = policy("CMB-4=127.5");
    cmb4.gives("200 under CMB-4=127.5", mapped(200, HalfBiasNormal, halves), 72.5);
    let mut product = products();
    product.inputs[0].mapping = HalfBiasNormal;
    cmb4.gives("its product with 100", outputs(product, [200, 100, 0, 0], halves)[0], 28);
    cmb4.shows("the real product", 72.5 * 100.0 / 255.0, 2, "28.43");

    let cmb5 = example("CMB-5", "negate of -256 is 255, of 255 is -255.");
    cmb5.gives("-256", mapped(-256, SignedNegate, DEFAULT), 255.0);
    cmb5.gives("255", mapped(255, SignedNegate, DEFAULT), -255.0);
}
