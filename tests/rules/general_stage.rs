//! Computes the examples of the section "General combiner stages".

use crate::handbook::{beside_rows, example};
use crate::pixel::{Pixel, covering, load_spare0, scene};
use ninebit::combiner::general::{self, PlannedStage};
use ninebit::combiner::registers::Registers;
use ninebit::limits::Limits;
use ninebit::state::*;
use ninebit::trace::Silent;
use std::path::Path;

const DEFAULT: Policies = Policies::DEFAULT;

/// The registers that [`products`] reads as A, B, C and D. Tests load them with arbitrary values.
const SOURCES: [Register; 4] = [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3];

/// Returns an RGB portion that writes AB, CD and their sum to SPARE0, SPARE1 and PRIMARY. Inputs are not mapped.
fn products() -> Portion {
    let mut portion = Portion::idle(Component::Rgb);
    for (input, register) in portion.inputs.iter_mut().zip(SOURCES) {
        *input = CombinerInput { register, mapping: InputMapping::SignedIdentity, ..*input };
    }
    let [ab_output, cd_output, sum_output] = [Register::Spare0, Register::Spare1, Register::PrimaryColor];
    Portion { ab_output, cd_output, sum_output, ..portion }
}

fn run_both(rgb: Portion, alpha: Portion, select: MuxSelect, policies: &Policies, registers: &mut Registers<i32>) {
    let stage = PlannedStage::whole(0, &GeneralStage { rgb, alpha, constants: [[0; 4]; 2] });
    general::run(&stage, select, policies, registers, &mut Silent);
}

#[test]
fn examples_of_the_general_stage() {
    let cmb1 = beside_rows("CMB-1");
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

    beside_rows("CMB-4").shows("the real product", 72.5 * 100.0 / 255.0, 2, "28.43");

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

    let cmb13 = beside_rows("CMB-13");
    let draw = Draw { combiners: Combiners::showing(FinalRegister::Spare0), ..covering(Vertex::default()) };
    let scene = scene(Profile::Nv10, SurfaceFormat::A8R8G8B8, [1, 2, 3, 4], vec![draw]);
    let shown = Pixel::from_scene(&scene, DEFAULT);
    cmb13.gives("the word that shows it", shown.word, 0xff00_0000);
    cmb13.gives("a read of what no document defines is marked", shown.step("spare0.r").note.is_some(), true);
}
