//! Examples of the section "Final combiner".

use crate::handbook::{example, policy};
use crate::pixel::{Pixel, covering, load_spare0, scene};
use ninebit::state::*;

const SUM: FinalRegister = FinalRegister::Spare0PlusSecondary;

fn input(register: FinalRegister) -> FinalInput {
    FinalInput { register, ..FinalInput::zero(Component::Rgb) }
}

fn inverted(register: FinalRegister) -> FinalInput {
    FinalInput { invert: true, ..input(register) }
}

/// A final combiner with A, B, C, D; E and F are the constants, G is 255.
fn combiner(abcd: [FinalInput; 4], constants: [u8; 2]) -> FinalCombiner {
    let [a, b, c, d] = abcd;
    FinalCombiner {
        inputs: [a, b, c, d, input(FinalRegister::ConstantColor0), input(FinalRegister::ConstantColor1)],
        g: FinalInput { component: Component::Alpha, ..inverted(FinalRegister::Zero) },
        constants: constants.map(|byte| [byte; 4]),
        ..Combiners::showing(FinalRegister::Zero).final_combiner
    }
}

/// A pixel of grey colours; SPARE0 holds the primary one.
fn drawn(final_combiner: FinalCombiner, primary: u8, secondary: u8, profile: Profile, policies: Policies) -> Pixel {
    let [diffuse, specular] = [primary, secondary].map(|byte| VertexColor::Bytes([byte; 4]));
    let mut draw = covering(Vertex { diffuse, specular, ..Vertex::default() });
    draw.combiners.stages[0].rgb = load_spare0(Component::Rgb, Register::PrimaryColor);
    // nv10 has one pair of constants for the whole program.
    draw.combiners.stages[0].constants = final_combiner.constants;
    draw.combiners.final_combiner = final_combiner;
    Pixel::from_scene(&scene(profile, SurfaceFormat::A8R8G8B8, [0; 4], vec![draw]), policies)
}

#[test]
fn examples_of_the_final_combiner() {
    use FinalRegister::{ConstantColor0, ConstantColor1, ETimesF, PrimaryColor, SecondaryColor, Zero};
    let on_nv10 = |combiner, primary, secondary| drawn(combiner, primary, secondary, Profile::Nv10, Policies::DEFAULT);
    let zero = input(Zero);

    let fin1 = example("FIN-1", "a sum of 300 inverted is 0; as A it counts as 255.");
    let seen = on_nv10(combiner([zero, zero, zero, inverted(SUM)], [0; 2]), 100, 200);
    fin1.gives("the sum", seen.value("final.sum.r"), 300).gives("inverted", seen.value("final.D.r"), 0);
    // B = 100 alone: nothing of C = 50 is left, nor taken away.
    let seen = on_nv10(combiner([input(SUM), input(ConstantColor0), input(ConstantColor1), zero], [100, 50]), 100, 200);
    fin1.gives("A", seen.value("final.A.r"), 300).gives("A B + (1 - A) C", seen.value("fragment.r"), 100);

    let fin2 = example("FIN-2", "A, B, C, D = 100, 200, 37, 10: rnd255(25735) + 10 = 111; twice: 78 + 22 + 10 = 110.");
    let abcd = [ConstantColor0, PrimaryColor, ConstantColor1, SecondaryColor].map(input);
    let seen = on_nv10(combiner(abcd, [100, 37]), 200, 10);
    let names = ["final.A.r", "final.B.r", "final.C.r", "final.D.r"];
    fin2.gives("A, B, C, D", names.map(|name| seen.value(name)), [100, 200, 37, 10]);
    fin2.gives("A B + (255 - A) C", 100 * 200 + 155 * 37, 25_735).gives("once", seen.value("fragment.r"), 111);
    let seen = drawn(combiner(abcd, [100, 37]), 200, 10, Profile::Nv10, policy("FIN-2=twice"));
    fin2.gives("under FIN-2=twice", seen.value("fragment.r"), 110);

    let fin3 = example("FIN-3", "200 + 255 = 455; clamped 255; with SPARE0 inverted 55 + 255 = 310.");
    let plain = combiner([zero, zero, zero, input(SUM)], [0; 2]);
    let sum = |combiner| on_nv10(combiner, 200, 255).value("final.sum.r");
    fin3.gives("200 + 255", sum(plain), 455);
    fin3.gives("clamped", sum(FinalCombiner { color_sum_clamp: true, ..plain }), 255);
    fin3.gives("with SPARE0 inverted", sum(FinalCombiner { invert_spare0: true, ..plain }), 310);

    let fin4 = example("FIN-4", "127 * 127 gives 63 (63.25).");
    let seen = on_nv10(combiner([zero, zero, zero, input(ETimesF)], [127; 2]), 0, 0);
    fin4.gives("E F", seen.value("final.EF.r"), 63).shows("the real number", 127.0 * 127.0 / 255.0, 2, "63.25");

    let fin5 =
        example("FIN-5", "A = 255, B = D = SPARE0+SECONDARY = 300: 600 before the clamp, 255 stored, marked on nv10.");
    for (profile, marked) in [(Profile::Nv10, true), (Profile::Nv2a, false)] {
        let above = combiner([inverted(Zero), input(SUM), zero, input(SUM)], [0; 2]);
        let seen = drawn(above, 100, 200, profile, Policies::DEFAULT);
        fin5.gives("before the clamp", seen.value("final.rgb.r"), 600).gives("stored", seen.word, 0xffff_ffff);
        let note = seen.step("final.rgb.r").note.as_ref();
        fin5.gives("marked", note.is_some_and(|note| note.contains("FIN-5")), marked);
    }
}
