//! CMB-7 to CMB-12, FIN-1 to FIN-4: the programs of Combiner, which change one state from draw to draw.

use super::draws::{Canvas, WHOLE, abgr, corners, draw, nearest, pasted, sized, unprojected, vertex, without_alpha};
use super::images::{self, checker};
use super::{Drawn, Frames, space};
use ninebit::state::{
    Bias, CombinerInput, Combiners, Component, Draw, FinalCombiner, FinalInput, FinalRegister, GeneralStage,
    InputMapping, MuxSelect, Portion, Register, Scale, TextureFormat, Topology, Vertex, VertexColor,
};

fn input(register: Register, component: Component) -> CombinerInput {
    CombinerInput { register, component, mapping: InputMapping::UnsignedIdentity }
}

const fn one(component: Component) -> CombinerInput {
    CombinerInput { register: Register::Zero, component, mapping: InputMapping::UnsignedInvert }
}

/// Red, green and blue of a register, and 1.
fn rgb(register: Register) -> CombinerInput {
    input(register, Component::Rgb)
}
const ONE: CombinerInput = one(Component::Rgb);

fn final_rgb(register: FinalRegister) -> FinalInput {
    FinalInput { register, component: Component::Rgb, invert: false }
}

const FINAL_ONE: FinalInput = FinalInput { register: FinalRegister::Zero, component: Component::Rgb, invert: true };

/// A colour of floats as the programs make bytes of it.
fn bytes(color: [f32; 4]) -> [u8; 4] {
    color.map(|value| (value * 255.0) as u8)
}

/// The combiners' state, of which the first `used` stages take part.
#[derive(Clone)]
struct State {
    stages: [GeneralStage; 8],
    used: usize,
    mux: MuxSelect,
    last: FinalCombiner,
}

impl State {
    /// The primary colour through one stage.
    fn new() -> State {
        let mut stages = [GeneralStage::default(); 8];
        stages[0] = GeneralStage::initial([[0; 4]; 2]);
        let last = FinalCombiner { color_sum_clamp: true, ..FinalCombiner::showing(FinalRegister::Spare0) };
        State { stages, used: 1, mux: MuxSelect::Msb, last }
    }

    fn inputs(portion: &mut Portion, component: Component, inputs: &[CombinerInput]) {
        portion.inputs = [CombinerInput::zero(component); 4];
        portion.inputs[..inputs.len()].copy_from_slice(inputs);
    }

    fn rgb_inputs(&mut self, stage: usize, inputs: &[CombinerInput]) {
        State::inputs(&mut self.stages[stage].rgb, Component::Rgb, inputs);
    }

    fn alpha_inputs(&mut self, stage: usize, inputs: &[CombinerInput]) {
        State::inputs(&mut self.stages[stage].alpha, Component::Alpha, inputs);
    }

    fn rgb_outputs(&mut self, stage: usize, outputs: Portion) {
        self.stages[stage].rgb = Portion { inputs: self.stages[stage].rgb.inputs, ..outputs };
    }

    fn alpha_outputs(&mut self, stage: usize, outputs: Portion) {
        self.stages[stage].alpha = Portion { inputs: self.stages[stage].alpha.inputs, ..outputs };
    }

    fn constant(&mut self, stage: usize, number: usize, color: [f32; 4]) {
        self.stages[stage].constants[number] = bytes(color);
    }

    /// Inputs A to D of the final combiner.
    fn colors(&mut self, inputs: [Option<FinalInput>; 4]) {
        for (n, input) in inputs.into_iter().enumerate() {
            self.last.inputs[n] = input.unwrap_or(FinalInput::zero(Component::Rgb));
        }
    }

    /// rgb = D = a register.
    fn shows(&mut self, register: FinalRegister) {
        self.colors([None, None, None, Some(final_rgb(register))]);
    }

    /// The rest of the final combiner: E, F and G, without a limit and without inversion.
    fn rest(&mut self, alpha: FinalInput) {
        let zero = FinalInput::zero(Component::Rgb);
        (self.last.inputs[4], self.last.inputs[5], self.last.g) = (zero, zero, alpha);
        (self.last.color_sum_clamp, self.last.invert_spare0, self.last.invert_secondary) = (false, false, false);
    }

    fn opaque(&mut self) {
        self.rest(FinalInput { component: Component::Alpha, ..FINAL_ONE });
    }

    fn with_alpha_of(&mut self, register: FinalRegister) {
        self.rest(FinalInput { register, component: Component::Alpha, invert: false });
    }

    fn on(&self, draw: &Draw) -> Draw {
        let (stages, final_combiner) = (self.stages[..self.used].to_vec(), self.last);
        Draw { combiners: Combiners { stages, mux_select: self.mux, final_combiner }, ..draw.clone() }
    }
}

/// Where products and the sum go.
fn to(component: Component, ab: Register, cd: Register, sum: Register) -> Portion {
    Portion { ab_output: ab, cd_output: cd, sum_output: sum, ..Portion::idle(component) }
}

/// AB goes to a register.
fn ab(component: Component, register: Register) -> Portion {
    to(component, register, Register::Zero, Register::Zero)
}

/// AB and CD go to registers.
fn ab_cd(first: Register, second: Register) -> Portion {
    to(Component::Rgb, first, second, Register::Zero)
}

/// Six rectangles in two rows, of two triangles each.
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

/// The frame buffer over which a grey chequered field is drawn.
fn chequered() -> Canvas {
    let mut canvas = Canvas::new(0xff6a_6a6a);
    let colors = [abgr(0xff33_3333), abgr(0xff44_4444)];
    let texture = canvas.texture(&images::texture(TextureFormat::A8B8G8R8, [256, 256], checker(colors, 8)));
    let draw = pasted(unprojected([0.0, 0.0, 640.0, 480.0]), 0, nearest(texture), WHOLE);
    canvas.draw(without_alpha(draw, FinalRegister::Texture0));
    canvas
}

/// A rectangle in four colours, one a corner.
fn gradient(edges: [f32; 4], colors: [[f32; 4]; 4]) -> Draw {
    let corners = corners(unprojected(edges)).into_iter().zip(colors);
    draw(Topology::Quads, corners.map(|(corner, color)| vertex(corner, VertexColor::Floats(color))).collect())
}

/// The mux, by bits of SPARE0's alpha.
fn mux() -> Drawn {
    let mut state = State::new();
    state.used = 2;
    state.rgb_inputs(0, &[ONE, ONE]);
    state.rgb_outputs(0, ab(Component::Rgb, Register::Spare0));
    state.alpha_inputs(0, &[input(Register::ConstantColor0, Component::Alpha), one(Component::Alpha)]);
    state.alpha_outputs(0, ab(Component::Alpha, Register::Spare0));
    state.constant(1, 0, [1.0, 0.0, 0.0, 1.0]);
    state.constant(1, 1, [0.0, 0.0, 1.0, 1.0]);
    state.rgb_inputs(1, &[rgb(Register::ConstantColor0), ONE, rgb(Register::ConstantColor1), ONE]);
    let selected = to(Component::Rgb, Register::Zero, Register::Zero, Register::PrimaryColor);
    state.rgb_outputs(1, Portion { mux: true, ..selected });
    state.alpha_inputs(1, &[one(Component::Alpha); 2]);
    state.alpha_outputs(1, ab(Component::Alpha, Register::PrimaryColor));
    state.shows(FinalRegister::PrimaryColor);
    state.with_alpha_of(FinalRegister::PrimaryColor);
    let mut canvas = Canvas::new(0xff30_3030);
    let values = [0x82, 0x82, 0x81, 0x81, 0, 0];
    for (n, (value, place)) in values.into_iter().zip(six()).enumerate() {
        state.stages[0].constants[0] = [0, 0, 0, value];
        state.mux = if n % 2 == 1 { MuxSelect::Msb } else { MuxSelect::Lsb };
        canvas.draw(state.on(&place));
    }
    canvas.colors()
}

/// Both products of a stage are computed before either is written.
fn independence() -> Drawn {
    let (spare0, spare1) = (Register::Spare0, Register::Spare1);
    let (places, mut canvas, mut state) = (six(), Canvas::new(0xff30_3030), State::new());
    state.used = 2;
    state.constant(0, 0, [0.0, 1.0, 0.0, 1.0]);
    state.rgb_inputs(0, &[rgb(Register::ConstantColor0), ONE]);
    state.rgb_outputs(0, ab(Component::Rgb, spare0));
    state.constant(1, 0, [1.0, 0.0, 0.0, 1.0]);
    state.rgb_inputs(1, &[rgb(Register::ConstantColor0), ONE, rgb(spare0), ONE]);
    state.rgb_outputs(1, ab_cd(spare0, spare1));
    state.shows(FinalRegister::Spare1);
    state.opaque();
    canvas.draw(state.on(&places[0]));
    // The same of blue that goes to alpha.
    state.used = 3;
    state.constant(0, 0, [0.0, 0.0, 0.25, 0.0]);
    state.constant(1, 0, [0.0, 0.0, 0.75, 0.0]);
    state.rgb_outputs(1, Portion { ab_blue_to_alpha: true, cd_blue_to_alpha: true, ..ab_cd(spare0, spare1) });
    let alpha = |register| input(register, Component::Alpha);
    state.rgb_inputs(2, &[alpha(spare0), ONE, alpha(spare1), ONE]);
    state.rgb_outputs(2, ab_cd(spare0, spare1));
    canvas.draw(state.on(&places[2]));
    state.shows(FinalRegister::Spare0);
    canvas.draw(state.on(&places[4]));
    canvas.colors()
}

/// The alpha portion reads what was there before the RGB portion of its stage.
fn color_and_alpha() -> Drawn {
    let (mut canvas, mut state) = (Canvas::new(0xff30_3030), State::new());
    let place = |[x, y]: [f32; 2]| {
        let diffuse = VertexColor::Floats([0.1, 1.0, 0.1, 1.0]);
        Vertex { position: space::flat([x, y, 0.0, 1.0]), diffuse, ..Vertex::default() }
    };
    let whole = draw(Topology::Quads, corners([-2.75, 1.75, 2.75, -1.75]).map(place).to_vec());
    state.shows(FinalRegister::PrimaryColor);
    state.opaque();
    canvas.draw(state.on(&whole));
    state.used = 2;
    state.constant(0, 0, [0.0; 4]);
    state.rgb_inputs(0, &[rgb(Register::ConstantColor0), ONE]);
    state.rgb_outputs(0, ab(Component::Rgb, Register::Spare0));
    state.constant(1, 0, [0.0, 0.0, 1.0, 1.0]);
    state.rgb_inputs(1, &[rgb(Register::ConstantColor0), ONE]);
    state.rgb_outputs(1, ab(Component::Rgb, Register::Spare0));
    state.alpha_inputs(1, &[input(Register::Spare0, Component::Blue), one(Component::Alpha)]);
    state.alpha_outputs(1, ab(Component::Alpha, Register::Spare1));
    state.alpha_inputs(0, &[]);
    state.alpha_outputs(0, Portion::idle(Component::Alpha));
    state.shows(FinalRegister::Spare0);
    state.with_alpha_of(FinalRegister::Spare1);
    canvas.draw(state.on(&whole));
    canvas.colors()
}

/// The final combiner's sum, limited or not, with either part inverted.
fn flags() -> Drawn {
    let (places, mut canvas, mut state) = (six(), Canvas::new(0xff30_3030), State::new());
    let sum = Some(final_rgb(FinalRegister::Spare0PlusSecondary));
    state.rgb_inputs(0, &[ONE; 4]);
    state.rgb_outputs(0, ab_cd(Register::SecondaryColor, Register::Spare0));
    state.last.constants[0] = bytes([0.5; 4]);
    state.colors([Some(final_rgb(FinalRegister::ConstantColor0)), sum, None, None]);
    state.opaque();
    canvas.draw(state.on(&places[0]));
    state.last.color_sum_clamp = true;
    canvas.draw(state.on(&places[1]));
    state.constant(0, 0, [0.75; 4]);
    let zero = CombinerInput::zero(Component::Rgb);
    state.rgb_inputs(0, &[zero, zero, rgb(Register::ConstantColor0), ONE]);
    state.colors([Some(FINAL_ONE), sum, None, None]);
    state.opaque();
    canvas.draw(state.on(&places[2]));
    state.last.invert_spare0 = true;
    canvas.draw(state.on(&places[3]));
    state.rgb_outputs(0, ab_cd(Register::Spare0, Register::SecondaryColor));
    state.opaque();
    canvas.draw(state.on(&places[4]));
    state.last.invert_secondary = true;
    canvas.draw(state.on(&places[5]));
    canvas.colors()
}

/// Colours and alphas of units that have no texture.
fn unbound() -> Drawn {
    let (mut canvas, mut state) = (Canvas::new(0xff6a_6a6a), State::new());
    state.opaque();
    let colors = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], [0.5, 0.5, 0.5, 1.0]];
    let mut top = 96.0;
    for register in super::draws::FETCHED {
        for (component, left) in [(Component::Rgb, 252.0), (Component::Alpha, 324.0)] {
            state.colors([None, None, None, Some(FinalInput { register, component, invert: false })]);
            canvas.draw(state.on(&gradient(sized([left, top], [64.0, 64.0]), colors)));
        }
        top += 72.0;
    }
    canvas.colors()
}

/// A white square without alpha, its left half opaque and its right half with the alpha of SPARE0.
fn halves(canvas: &mut Canvas, state: &mut State, [left, top]: [f32; 2]) {
    let white = [[1.0, 1.0, 1.0, 0.0]; 4];
    state.opaque();
    canvas.draw(state.on(&gradient(sized([left, top], [32.0, 64.0]), white)));
    state.with_alpha_of(FinalRegister::Spare0);
    canvas.draw(state.on(&gradient(sized([left + 32.0, top], [32.0, 64.0]), white)));
}

/// Blue of either product as alpha.
fn alpha_from_blue() -> Drawn {
    let (mut canvas, mut state) = (chequered(), State::new());
    state.alpha_outputs(0, Portion::idle(Component::Alpha));
    state.shows(FinalRegister::Spare0);
    let product = [rgb(Register::ConstantColor0), rgb(Register::PrimaryColor)];
    state.rgb_inputs(0, &[product[0], product[1], product[0], product[1]]);
    let first = Portion { ab_blue_to_alpha: true, ..ab(Component::Rgb, Register::Spare0) };
    let second = Portion { cd_blue_to_alpha: true, ..ab_cd(Register::Zero, Register::Spare0) };
    for (top, outputs) in [(192.0, first), (264.0, second)] {
        state.rgb_outputs(0, outputs);
        let mut left = 128.0;
        for blue in [1.0, 0.75, 0.5, 0.25, 0.0] {
            state.constant(0, 0, [0.25, 0.5, blue, 0.0]);
            halves(&mut canvas, &mut state, [left, top]);
            left += 72.0;
        }
    }
    canvas.colors()
}

/// Scale and bias of the outputs.
fn operations() -> Drawn {
    let (mut canvas, mut state) = (chequered(), State::new());
    state.rgb_inputs(0, &[rgb(Register::ConstantColor0), ONE]);
    state.alpha_inputs(0, &[input(Register::ConstantColor0, Component::Blue), one(Component::Alpha)]);
    state.shows(FinalRegister::Spare0);
    state.constant(0, 0, [0.1, 0.25, 1.0, 0.5]);
    for (scale, bias, corner) in [
        (Scale::One, Bias::None, [200.0, 74.0]),
        (Scale::One, Bias::NegativeHalf, [200.0, 146.0]),
        (Scale::Two, Bias::None, [200.0, 218.0]),
        (Scale::Two, Bias::NegativeHalf, [200.0, 290.0]),
        (Scale::Four, Bias::None, [200.0, 362.0]),
        (Scale::Half, Bias::None, [500.0, 74.0]),
    ] {
        state.rgb_outputs(0, Portion { scale, bias, ..ab(Component::Rgb, Register::Spare0) });
        state.alpha_outputs(0, Portion { scale, bias, ..ab(Component::Alpha, Register::Spare0) });
        halves(&mut canvas, &mut state, corner);
    }
    canvas.colors()
}

/// E F, and the sum with either part inverted.
fn special_inputs() -> Drawn {
    let (mut canvas, mut state) = (chequered(), State::new());
    state.last.constants = [bytes([1.0, 0.75, 0.5, 1.0]), bytes([0.5; 4])];
    let square = |corner| gradient(sized(corner, [64.0, 64.0]), [[1.0; 4]; 4]);
    let product = |state: &mut State| {
        state.opaque();
        state.last.inputs[4] = final_rgb(FinalRegister::ConstantColor0);
        state.last.inputs[5] = final_rgb(FinalRegister::ConstantColor1);
    };
    state.shows(FinalRegister::ETimesF);
    product(&mut state);
    canvas.draw(state.on(&square([200.0, 74.0])));
    state.constant(0, 0, [0.25, 0.5, 0.75, 0.0]);
    state.constant(0, 1, [0.7, 0.5, 0.15, 0.5]);
    state.rgb_inputs(0, &[rgb(Register::ConstantColor0), ONE, rgb(Register::ConstantColor1), ONE]);
    let blue = |register| input(register, Component::Blue);
    let unit = one(Component::Alpha);
    state.alpha_inputs(0, &[blue(Register::ConstantColor0), unit, blue(Register::ConstantColor1), unit]);
    state.rgb_outputs(0, ab_cd(Register::Spare0, Register::SecondaryColor));
    state.shows(FinalRegister::Spare0PlusSecondary);
    canvas.draw(state.on(&square([200.0, 170.0])));
    state.last.invert_spare0 = true;
    canvas.draw(state.on(&square([500.0, 170.0])));
    product(&mut state);
    state.last.invert_secondary = true;
    canvas.draw(state.on(&square([200.0, 242.0])));
    canvas.colors()
}

/// Combiner.
pub(super) fn frames(frames: &mut Frames) {
    frames.make("Mux", mux);
    frames.make("Independence", independence);
    frames.make("ColorAlphaIndependence", color_and_alpha);
    frames.make("Flags", flags);
    frames.make("UnboundTexSampler", unbound);
    frames.make("AlphaFromBlue", alpha_from_blue);
    frames.make("CombinerOps", operations);
    frames.make("SpecialInputs", special_inputs);
}
