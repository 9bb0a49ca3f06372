//! CMB-7 to CMB-12, FIN-1 to FIN-4: the programs of the suite Combiner, in the combiner language. A colour component c of the programs is written as
//! the byte 255 c, truncated.

use super::*;

/// Returns the draw with a combiner program in place of its own.
fn with(draw: &Draw, text: &str) -> Draw {
    Draw { combiners: program(text), ..draw.clone() }
}

const OPAQUE: &str = "out.a = unsigned_invert(zero);";
const INVERTED_SPARE0: &str = "color_sum = unsigned_invert(spare0) + col1;";
const INVERTED_SECONDARY: &str = "color_sum = spare0 + unsigned_invert(col1);";

/// Returns six rectangles in two rows, each of two triangles.
fn six() -> Vec<Draw> {
    let (left, right, top, bottom, gap) = (-2.75_f32, 2.75_f32, 1.85_f32, -1.75_f32, 0.1_f32);
    let width = ((right - left) - 3.0 * gap) / 4.0;
    let height = ((top - bottom) - 2.0 * gap) / 3.0;
    let colors = [[0.0, 1.0, 0.0], [0.25; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    let (mut x, mut y) = (left, top - gap);
    let mut draws = Vec::new();
    for _ in 0..6 {
        let corners = corners([x, y, x + width, y - height]);
        let corner = |n: usize| {
            let ([x, y], [r, g, b]) = (corners[n], colors[n]);
            let diffuse = VertexColor::Floats([r, g, b, 1.0]);
            Vertex { position: space::flat([x, y, 1.0, 1.0]), diffuse, ..Vertex::default() }
        };
        draws.push(draw(Topology::Triangles, [0, 1, 2, 0, 2, 3].map(corner).to_vec()));
        x += width + gap;
        if x >= right - width {
            (x, y) = (left, y - (height + gap * 4.0));
        }
    }
    draws
}

/// Fills the frame buffer with a grey chequered background.
fn chequered(canvas: &mut Canvas) {
    let colors = [abgr(0xff33_3333), abgr(0xff44_4444)];
    let texture = canvas.texture(&images::texture(TextureFormat::A8B8G8R8, [256, 256], checker(colors, 8)));
    let draw = pasted(unprojected([0.0, 0.0, 640.0, 480.0]), 0, nearest(texture), WHOLE);
    canvas.draw(without_alpha(draw, FinalRegister::Texture0));
}

/// Returns a rectangle that interpolates four colours, one for each corner.
fn gradient(edges: [f32; 4], colors: [[f32; 4]; 4]) -> Draw {
    let corners = corners(unprojected(edges)).into_iter().zip(colors);
    draw(Topology::Quads, corners.map(|(corner, color)| vertex(corner, VertexColor::Floats(color))).collect())
}

/// Draws the mux, which selects by the most or least significant bit of SPARE0's alpha.
fn mux(canvas: &mut Canvas) {
    let mut combiners = program(
        "{ rgb { spare0 = unsigned_invert(zero); } alpha { spare0 = unsigned(const0.a); } }
         { const0 = bytes(255, 0, 0, 255); const1 = bytes(0, 0, 255, 255);
           rgb { discard = unsigned(const0); discard = unsigned(const1); col0 = mux(); } alpha { col0 = unsigned_invert(zero); } }
         out.rgb = col0; out.a = col0.a;",
    );
    for (n, (value, place)) in [0x82, 0x82, 0x81, 0x81, 0, 0].into_iter().zip(six()).enumerate() {
        combiners.stages[0].constants[0] = [0, 0, 0, value];
        combiners.mux_select = if n % 2 == 1 { MuxSelect::Msb } else { MuxSelect::Lsb };
        canvas.draw(Draw { combiners: combiners.clone(), ..place });
    }
}

/// Draws the proof that both products of a stage are computed before either is written.
fn independence(canvas: &mut Canvas) {
    let places = six();
    let colors = "{ const0 = bytes(0, 255, 0, 255); rgb { spare0 = unsigned(const0); } }
        { const0 = bytes(255, 0, 0, 255); rgb { spare0 = unsigned(const0); spare1 = unsigned(spare0); } }";
    // The same for blue that is written to alpha.
    let blue = "{ const0 = bytes(0, 0, 63, 0); rgb { spare0 = unsigned(const0); } }
        { const0 = bytes(0, 0, 191, 0);
          rgb { spare0 = unsigned(const0), blue_to_alpha; spare1 = unsigned(spare0), blue_to_alpha; } }
        { rgb { spare0 = unsigned(spare0.a); spare1 = unsigned(spare1.a); } }";
    for (place, stages, shown) in [(0, colors, "spare1"), (2, blue, "spare1"), (4, blue, "spare0")] {
        canvas.draw(with(&places[place], &format!("{stages} out.rgb = {shown}; {OPAQUE}")));
    }
}

/// Draws the proof that the alpha portion reads registers as they were before the RGB portion of its stage wrote.
fn color_and_alpha(canvas: &mut Canvas) {
    let place = |[x, y]: [f32; 2]| {
        let diffuse = VertexColor::Floats([0.1, 1.0, 0.1, 1.0]);
        Vertex { position: space::flat([x, y, 0.0, 1.0]), diffuse, ..Vertex::default() }
    };
    let whole = draw(Topology::Quads, corners([-2.75, 1.75, 2.75, -1.75]).map(place).to_vec());
    canvas.draw(with(&whole, &format!("out.rgb = col0; {OPAQUE}")));
    let stages = "{ rgb { spare0 = unsigned(const0); } }
        { const0 = bytes(0, 0, 255, 255); rgb { spare0 = unsigned(const0); } alpha { spare1 = unsigned(spare0.b); } }";
    canvas.draw(with(&whole, &format!("{stages} out.rgb = spare0; out.a = spare1.a;")));
}

/// Draws the final combiner's colour sum: clamped or not, and with either term inverted.
fn flags(canvas: &mut Canvas) {
    let both = "const0 = bytes(127, 127, 127, 127);
        { rgb { col1 = unsigned_invert(zero); spare0 = unsigned_invert(zero); } } out.rgb = const0 * color_sum;";
    let spare0 = "{ const0 = bytes(191, 191, 191, 191); rgb { col1 = zero * zero; spare0 = unsigned(const0); } }
        out.rgb = unsigned_invert(zero) * color_sum;";
    let secondary = "{ const0 = bytes(191, 191, 191, 191); rgb { spare0 = zero * zero; col1 = unsigned(const0); } }
        out.rgb = unsigned_invert(zero) * color_sum;";
    let programs = [
        (both, ""),
        (both, "clamp_color_sum();"),
        (spare0, ""),
        (spare0, INVERTED_SPARE0),
        (secondary, ""),
        (secondary, INVERTED_SECONDARY),
    ];
    for (place, (text, flag)) in six().iter().zip(programs) {
        canvas.draw(with(place, &format!("{text} {flag} {OPAQUE}")));
    }
}

/// Draws the colours and alphas of texture registers whose units have no texture.
fn unbound(canvas: &mut Canvas) {
    let colors = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], [0.5, 0.5, 0.5, 1.0]];
    for (n, corner) in (0..8).zip(places([252.0, 96.0], [72.0; 2], 2)) {
        let component = ["", ".a"][n % 2];
        let draw = gradient(sized(corner, [64.0, 64.0]), colors);
        canvas.draw(with(&draw, &format!("out.rgb = tex{}{component}; {OPAQUE}", n / 2)));
    }
}

/// Draws a white square. Its left half is opaque; its right half has the alpha of SPARE0.
fn halves(canvas: &mut Canvas, stages: &str, [left, top]: [f32; 2]) {
    for (left, alpha) in [(left, OPAQUE), (left + 32.0, "out.a = spare0.a;")] {
        let half = gradient(sized([left, top], [32.0, 64.0]), [[1.0, 1.0, 1.0, 0.0]; 4]);
        canvas.draw(with(&half, &format!("{stages} out.rgb = spare0; {alpha}")));
    }
}

/// Draws squares whose alpha is the blue of the AB or of the CD product.
fn alpha_from_blue(canvas: &mut Canvas) {
    chequered(canvas);
    for (top, before) in [(192.0, ""), (264.0, "discard = zero * zero;")] {
        let product = format!("{before} spare0 = unsigned(const0) * unsigned(col0), blue_to_alpha;");
        for (blue, corner) in [255, 191, 127, 63, 0].into_iter().zip(places([128.0, top], [72.0; 2], 5)) {
            let stage = format!("{{ const0 = bytes(63, 127, {blue}, 0); rgb {{ {product} }} }}");
            halves(canvas, &stage, corner);
        }
    }
}

/// Draws every combination of output scale and bias.
fn operations(canvas: &mut Canvas) {
    chequered(canvas);
    for (operation, corner) in [
        ("", [200.0, 74.0]),
        ("bias_by_negative_one_half();", [200.0, 146.0]),
        ("scale_by_two();", [200.0, 218.0]),
        ("bias_by_negative_one_half_scale_by_two();", [200.0, 290.0]),
        ("scale_by_four();", [200.0, 362.0]),
        ("scale_by_one_half();", [500.0, 74.0]),
    ] {
        let rgb = format!("rgb {{ spare0 = unsigned(const0); {operation} }}");
        let alpha = format!("alpha {{ spare0 = unsigned(const0.b); {operation} }}");
        halves(canvas, &format!("{{ const0 = bytes(25, 63, 255, 127); {rgb} {alpha} }}"), corner);
    }
}

/// Draws the product E F, and the colour sum plain and with either term inverted.
fn special_inputs(canvas: &mut Canvas) {
    chequered(canvas);
    let product = "const0 = bytes(255, 191, 127, 255); const1 = bytes(127, 127, 127, 127);
        final_product = const0 * const1; out.rgb = final_product;";
    let sum = "{ const0 = bytes(63, 127, 191, 0); const1 = bytes(178, 127, 38, 127);
          rgb { spare0 = unsigned(const0); col1 = unsigned(const1); } } out.rgb = color_sum;";
    for (text, flag, corner) in [
        (product, "", [200.0, 74.0]),
        (sum, "", [200.0, 170.0]),
        (sum, INVERTED_SPARE0, [500.0, 170.0]),
        (sum, INVERTED_SECONDARY, [200.0, 242.0]),
    ] {
        let square = gradient(sized(corner, [64.0, 64.0]), [[1.0; 4]; 4]);
        canvas.draw(with(&square, &format!("{text} {flag} {OPAQUE}")));
    }
}

/// Adds the frames of Combiner.
pub(super) fn frames(frames: &mut Frames) {
    frames.paint("Mux", 0xff30_3030, mux);
    frames.paint("Independence", 0xff30_3030, independence);
    frames.paint("ColorAlphaIndependence", 0xff30_3030, color_and_alpha);
    frames.paint("Flags", 0xff30_3030, flags);
    frames.paint("UnboundTexSampler", 0xff6a_6a6a, unbound);
    frames.paint("AlphaFromBlue", 0xff6a_6a6a, alpha_from_blue);
    frames.paint("CombinerOps", 0xff6a_6a6a, operations);
    frames.paint("SpecialInputs", 0xff6a_6a6a, special_inputs);
}
