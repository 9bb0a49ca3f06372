//! Probes of the combiners and of their inputs.

use crate::probes::{Answers, single};
use crate::sheet::{OVER, Sheet, bind, cell, input, opaque};
use crate::table::Row;
use ninebit::state::*;
use ninebit::vertex::fog::passed;

fn frame(sheet: &mut Sheet) -> usize {
    sheet.target(SurfaceFormat::A8R8G8B8, [0, 0, 0, 255])
}

/// Draws each row in one cell of a common frame.
fn each(rows: &[Row], draw: impl Fn(&Row, Draw) -> Draw) -> Vec<[u8; 4]> {
    let mut sheet = Sheet::new();
    let frame = frame(&mut sheet);
    for (n, row) in rows.iter().enumerate() {
        sheet.draw(draw(row, cell(frame, n, [255; 4])));
    }
    sheet.show(frame, rows.len())
}

/// CMB-2: returns an input of a general stage that is 1.
fn one(component: Component) -> CombinerInput {
    CombinerInput { mapping: InputMapping::UnsignedInvert, ..CombinerInput::zero(component) }
}

/// Writes `register` times one to SPARE0, with the bias and scale of the portion.
fn load(portion: &mut Portion, register: Register, component: Component) {
    portion.inputs[0].register = register;
    portion.inputs[1] = one(component);
    portion.ab_output = Register::Spare0;
}

fn output(row: &Row, draw: &mut Draw) {
    let [r, g, b] = row.bytes("input");
    draw.combiners = Combiners::showing(FinalRegister::Spare0);
    let stage = &mut draw.combiners.stages[0];
    (stage.rgb.bias, stage.rgb.scale) = (row.named("bias"), row.named("scale"));
    load(&mut stage.rgb, Register::ConstantColor0, Component::Rgb);
    stage.constants[0] = [r, g, b, 0];
}

/// Draws the rows of `combiner-output`.
pub fn outputs(rows: &[Row]) -> Answers {
    single(each(rows, |row, mut draw| {
        output(row, &mut draw);
        opaque(&mut draw);
        draw
    }))
}

/// Draws the rows of `combiner-output-alpha` over each of the backgrounds.
pub fn outputs_alpha(rows: &[Row]) -> Answers {
    let mut answers: Answers = vec![vec![]; rows.len()];
    for alternative in 0..2 {
        let mut sheet = Sheet::new();
        let frame = frame(&mut sheet);
        for (n, row) in rows.iter().enumerate() {
            let grey: u8 = row.list("backgrounds")[alternative].parse().unwrap();
            sheet.draw(cell(frame, n, [grey, grey, grey, 255]));
            let mut draw = cell(frame, n, [255; 4]);
            output(row, &mut draw);
            let stage = &mut draw.combiners.stages[0];
            (stage.alpha.bias, stage.alpha.scale) = (stage.rgb.bias, stage.rgb.scale);
            load(&mut stage.alpha, Register::ConstantColor0, Component::Alpha);
            stage.constants[0][3] = row.number("alpha");
            draw.blend = Some(OVER);
            sheet.draw(draw);
        }
        let shown = sheet.show(frame, rows.len());
        answers.iter_mut().zip(shown).for_each(|(answer, pixel)| answer.push(pixel));
    }
    answers
}

/// Loads SPARE0 and SECONDARY with the given colours.
fn sum(row: &Row, draw: &mut Draw, spare0: [u8; 3], secondary: [u8; 3]) {
    let opaque = |[r, g, b]: [u8; 3]| [r, g, b, 255];
    let stage = &mut draw.combiners.stages[0];
    load(&mut stage.rgb, Register::ConstantColor0, Component::Rgb);
    stage.constants[0] = opaque(spare0);
    draw.vertices.update(|_, vertex| vertex.specular = VertexColor::Bytes(opaque(secondary)));
    let combiner = &mut draw.combiners.final_combiner;
    combiner.inputs = [FinalInput::zero(Component::Rgb); 6];
    combiner.color_sum_clamp = row.flag("clamp");
    combiner.invert_spare0 = row.flag("invert_spare0");
    combiner.invert_secondary = row.flag("invert_secondary");
}

/// Draws the rows of `final-product-sum`: A is constant 0 and B is the sum.
pub fn product_sum(rows: &[Row]) -> Answers {
    single(each(rows, |row, mut draw| {
        sum(row, &mut draw, [row.number("spare0"); 3], [row.number("secondary"); 3]);
        let combiner = &mut draw.combiners.final_combiner;
        combiner.inputs[0] = input(FinalRegister::ConstantColor0);
        combiner.inputs[1] = input(FinalRegister::Spare0PlusSecondary);
        combiner.constants[0] = [row.number("a_input"); 4];
        draw
    }))
}

/// Draws the rows of `final-sum`: D is the sum.
pub fn final_sum(rows: &[Row]) -> Answers {
    single(each(rows, |row, mut draw| {
        sum(row, &mut draw, row.bytes("spare0"), row.bytes("secondary"));
        draw.combiners.final_combiner.inputs[3] = input(FinalRegister::Spare0PlusSecondary);
        draw
    }))
}

/// Draws the rows of `final-ef`: E and F are the constants and D is their product.
pub fn final_ef(rows: &[Row]) -> Answers {
    single(each(rows, |row, mut draw| {
        let combiner = &mut draw.combiners.final_combiner;
        combiner.inputs[3] = input(FinalRegister::ETimesF);
        for (n, (column, register)) in
            [("e", FinalRegister::ConstantColor0), ("f", FinalRegister::ConstantColor1)].into_iter().enumerate()
        {
            let [r, g, b] = row.bytes(column);
            combiner.constants[n] = [r, g, b, 255];
            combiner.inputs[4 + n] = input(register);
        }
        draw
    }))
}

/// Draws the rows of `fog-curve`: fog of a coordinate by FOG-1 to FOG-4.
pub fn fog_curve(rows: &[Row]) -> Answers {
    single(each(rows, |row, draw| {
        let [p0, p1, d] = ["p0", "p1", "d"].map(|column| row.number(column));
        let function = FogFunction { mode: row.named("mode"), p0, p1, p2: 0.0, per_vertex: false };
        let passed = passed(&function, Profile::Nv2a, d);
        let mut draw = fogged(draw, passed, row.bytes("b_input"), row.bytes("c_input"));
        draw.fog.function = Some(function);
        draw
    }))
}

/// Adds fog to a draw: A is the fog factor, B the primary colour and C the fog colour.
fn fogged(mut draw: Draw, fog: f32, b: [u8; 3], c: [u8; 3]) -> Draw {
    draw.vertices.update(|_, vertex| {
        vertex.fog = fog;
        vertex.diffuse = VertexColor::Bytes([b[0], b[1], b[2], 255]);
    });
    draw.fog = Fog { enabled: true, color: c, function: None };
    let zero = FinalInput::zero(Component::Rgb);
    let factor = FinalInput { register: FinalRegister::Fog, component: Component::Alpha, invert: false };
    let (b, c) = (input(FinalRegister::PrimaryColor), input(FinalRegister::Fog));
    draw.combiners.final_combiner.inputs = [factor, b, c, zero, zero, zero];
    draw
}

/// Draws the rows of `fog-factor`: a known factor by NUM-6.
pub fn fog_factor(rows: &[Row]) -> Answers {
    single(each(rows, |row, draw| fogged(draw, row.number("fog"), row.bytes("b_input"), row.bytes("c_input"))))
}

/// Draws the rows of `fog-lerp` with every byte of the fog factor.
pub fn fog_lerp(rows: &[Row]) -> Answers {
    let (b, c) = (rows[0].text("b_input"), rows[0].text("c_input"));
    assert!(rows.iter().all(|row| (row.text("b_input"), row.text("c_input")) == (b, c)));
    let mut sheet = Sheet::new();
    let frame = frame(&mut sheet);
    for byte in 0..256 {
        // The inverse of NUM-6: 4096ths that yield this byte.
        let fog = (16 * byte + byte / 16 + 1) as f32 / 4096.0;
        let draw = fogged(cell(frame, byte, [255; 4]), fog, rows[0].bytes("b_input"), rows[0].bytes("c_input"));
        sheet.draw(draw);
    }
    let shown = sheet.show(frame, 256);
    vec![shown; rows.len()]
}

fn float_color(row: &Row, draw: &mut Draw) {
    let [r, g, b] = ["red", "green", "blue"].map(|column| row.number(column));
    draw.vertices.update(|_, vertex| vertex.diffuse = VertexColor::Floats([r, g, b, 1.0]));
}

/// Draws the rows of `vertex-color`: float colours by NUM-4.
pub fn vertex_color(rows: &[Row]) -> Answers {
    single(each(rows, |row, mut draw| {
        float_color(row, &mut draw);
        draw
    }))
}

/// Draws the rows of `texel-times-diffuse` with each of the texels.
pub fn texel_times_diffuse(rows: &[Row]) -> Answers {
    let mut answers: Answers = vec![vec![]; rows.len()];
    for alternative in 0..2 {
        let mut sheet = Sheet::new();
        let frame = frame(&mut sheet);
        let texel = |row: &Row| row.list("texels")[alternative].parse::<u8>().unwrap();
        let texture = sheet.texels(rows.iter().map(|row| [texel(row), texel(row), texel(row), 255]));
        for (n, row) in rows.iter().enumerate() {
            let mut draw = cell(frame, n, [255; 4]);
            float_color(row, &mut draw);
            bind(&mut draw, 0, texture);
            let combiner = &mut draw.combiners.final_combiner;
            combiner.inputs = [FinalInput::zero(Component::Rgb); 6];
            combiner.inputs[0] = input(FinalRegister::Texture0);
            combiner.inputs[1] = input(FinalRegister::PrimaryColor);
            sheet.draw(draw);
        }
        let shown = sheet.show(frame, rows.len());
        answers.iter_mut().zip(shown).for_each(|(answer, pixel)| answer.push(pixel));
    }
    answers
}

/// Draws the rows of `unbound-texture`: colour or alpha of a unit without a texture.
pub fn unbound(rows: &[Row]) -> Answers {
    use FinalRegister::{Texture0, Texture1, Texture2, Texture3};
    single(each(rows, |row, mut draw| {
        let register = [Texture0, Texture1, Texture2, Texture3][row.number::<usize>("unit")];
        draw.combiners = Combiners::showing(register);
        if row.text("component") == "alpha" {
            draw.combiners.final_combiner.inputs[3].component = Component::Alpha;
        }
        opaque(&mut draw);
        draw
    }))
}
