//! Computes the examples of the section "Final combiner".

use crate::handbook::beside_rows;
use crate::pixel::{Pixel, covering, load_spare0, scene};
use ninebit::state::*;

#[test]
fn examples_of_the_final_combiner() {
    beside_rows("FIN-2").gives("A B + (255 - A) C", 100 * 200 + 155 * 37, 25_735);
    beside_rows("FIN-4").shows("the real number", 127.0 * 127.0 / 255.0, 2, "63.25");

    let fin5 = beside_rows("FIN-5");
    for (profile, marked) in [(Profile::Nv10, true), (Profile::Nv2a, false)] {
        let [diffuse, specular] = [100, 200].map(|byte| VertexColor::Bytes([byte; 4]));
        let mut draw = covering(Vertex { diffuse, specular, ..Vertex::default() });
        draw.combiners.stages[0].rgb = load_spare0(Component::Rgb, Register::PrimaryColor);
        let zero = FinalInput::zero(Component::Rgb);
        let sum = FinalInput { register: FinalRegister::Spare0PlusSecondary, ..zero };
        let last = &mut draw.combiners.final_combiner;
        last.inputs[..4].copy_from_slice(&[FinalInput { invert: true, ..zero }, sum, zero, sum]);
        let pixel = Pixel::from_scene(&scene(profile, SurfaceFormat::A8R8G8B8, [0; 4], vec![draw]), Policies::DEFAULT);
        let note = pixel.step("final.rgb.r").note.as_ref();
        fin5.gives("marked", note.is_some_and(|note| note.contains("FIN-5")), marked);
    }
}
