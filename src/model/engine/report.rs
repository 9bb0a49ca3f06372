//! Reports of a pixel to an observer, outside the blocks that report for themselves. No value here is used elsewhere.

use super::context::TriangleContext;
use super::pixel::DepthStencil;
use crate::combiner::registers::{self, channel_name};
use crate::combiner::report::constants;
use crate::number::{Lane, light};
use crate::plan::PlannedDraw;
use crate::raster::fog::{FogFactor, FogPlane, FogStep, limited};
use crate::raster::interpolate::Sample;
use crate::raster::stroke::{self, Figure};
use crate::raster::{depth, report as raster};
use crate::rop::{blend, surface};
use crate::state::*;
use crate::trace::{Observer, Operand, Step, byte, float, float_step, part, plain, report};
use crate::vertex::fog as vertex_fog;

const RASTER: &str = "rasteriser";
const INTERPOLATION: &str = "interpolation";
const FOG: &str = "fog";
const DEPTH: &str = "depth test";

/// Reports edge functions and weights. `w` holds those of the vertices as the chip takes them, `ideal` the weights of the ideal.
pub(super) fn setup<O: Observer>(
    draw: &PlannedDraw,
    sample: &Sample<'_>,
    pixel: (i64, i64),
    w: [f32; 3],
    ideal: [f64; 3],
    observer: &mut O,
) {
    let triangle = sample.triangle;
    let rule = match (triangle.figure, draw.assembly.lines.rasterization) {
        (Figure::Triangle, _) => "RAS-3",
        (Figure::Line, LineRasterization::Rectangular | LineRasterization::RectangularSmooth) => "LIN-1",
        (Figure::Line, LineRasterization::Bresenham) => "LIN-2",
        (Figure::Point, _) => "PNT-1",
    };
    raster::edges(RASTER, (rule, ""), triangle, pixel, observer);
    match (triangle.figure, &draw.polygon_stipple) {
        (Figure::Triangle, None) => {}
        (Figure::Triangle, Some(stipple)) => pattern(stipple, pixel, observer),
        _ => raster::stroke(RASTER, rule, triangle, pixel, observer),
    }
    raster::ratios(INTERPOLATION, triangle, w, observer);
    raster::weights(INTERPOLATION, "", (sample.e, triangle.ratios), sample.weights(), Some(ideal), observer);
}

/// STP-1: reports the bit of a pattern, which is 1 where a triangle is drawn.
fn pattern<O: Observer>(stipple: &PolygonStipple, (x, y): (i64, i64), observer: &mut O) {
    let word = stipple.0[31 - (y & 31) as usize];
    let row = observer.tell(Step::plain(RASTER, "STP-1", "stipple.row", word).note(format!("{word:#010x}")));
    let step = Step::plain(RASTER, "STP-1", "stipple.bit", stroke::stipples(stipple, x, y));
    observer.step(step.by("stipple_bit", vec![row, plain("x", x)]));
}

/// SMO-1: reports the samples of a pixel, and the fragment's alpha.
pub(super) fn covered_alpha<L: Lane, O: Observer>(alpha: L, samples: i64, covered: L, observer: &mut O) {
    let samples = observer.tell(Step::plain(RASTER, "SMO-1", "samples", samples));
    let inputs = vec![report::register("fragment.a", alpha), samples];
    observer.step(report::register_step(RASTER, "SMO-1", "fragment.a", covered).by("cover", inputs));
}

/// CMB-13: reports registers that are read before they are written.
pub(super) fn undefined<O: Observer>(read: u64, observer: &mut O) {
    for register in [Register::Spare0, Register::Spare1] {
        for channel in (0..4).filter(|c| read & registers::bit(register, *c) != 0) {
            let name = format!("{}.{}", registers::name(register), channel_name(channel));
            let note = "no document defines this register here; taken as 0".to_string();
            observer.step(Step::plain("registers", "CMB-13", name, 0).per(255).ideal(0.0).note(note));
        }
    }
}

/// Reports the 8-bit weights of the colours.
pub(super) fn weights<O: Observer>(sample: &Sample<'_>, [w0, w2]: [i64; 2], barycentrics: [f64; 3], observer: &mut O) {
    #[allow(clippy::float_arithmetic, reason = "display of the ideal")]
    let ideal = barycentrics.map(|b| Some(256.0 * b));
    let (rule, operation) = if sample.is_outside() { ("SMO-2", "signed_weight") } else { ("INT-2", "floor_weight") };
    let step = |name: &str, value: i64| Step::plain(INTERPOLATION, rule, name, value).per(256);
    for (k, value) in [(0, w0), (2, w2)] {
        let inputs = vec![raster::number(format!("b{k}"), sample.weights().b[k])];
        observer.step(step(&format!("W{k}"), value).by(operation, inputs).ideal(ideal[k]));
    }
    let inputs = vec![part("W0", w0), part("W2", w2)];
    observer.step(step("W1", 256 - w0 - w2).by("remainder_weight", inputs).ideal(ideal[1]));
}

/// Reports one interpolated channel, and the vertices' bytes that it comes from. `output` is the register of the vertex program that has
/// them.
pub(super) fn color<L: Lane, O: Observer>(
    register: &str,
    channel: usize,
    (sources, output): ([VertexColor; 3], Option<&str>),
    corners: [L; 3],
    (&[w0, w2], is_outside): (&[i64; 2], bool),
    value: L,
    observer: &mut O,
) {
    let name = format!("{register}.{}", channel_name(channel));
    let mut inputs: Vec<Operand> = Vec::new();
    for k in 0..3 {
        let corner = format!("vertex{k}.{name}");
        let (rule, note) = match sources[k] {
            VertexColor::Bytes(_) => ("INT-2", None),
            VertexColor::Floats(floats) => {
                let given = output.map(|output| format!("{output}.{} = ", ["x", "y", "z", "w"][channel]));
                ("NUM-4", Some(format!("from {}{}", given.unwrap_or_default(), floats[channel])))
            }
        };
        inputs.push(observer.tell(report::register_step(INTERPOLATION, rule, corner, corners[k]).note(note)));
    }
    inputs.extend([part("W0", w0), part("W1", 256 - w0 - w2), part("W2", w2)]);
    let (rule, operation) = if is_outside { ("SMO-2", "interpolate_within") } else { ("INT-2", "interpolate") };
    observer.step(report::register_step(INTERPOLATION, rule, name, value).by(operation, inputs));
}

impl TriangleContext<'_> {
    /// FOG-1 to FOG-5, INT-5n: reports the fog factor, from factors of the vertices or from a function of their coordinates.
    pub(super) fn report_fog<L: Lane, O: Observer>(
        &self,
        sample: &Sample<'_>,
        plane: &FogPlane,
        found: FogFactor,
        factor: L,
        observer: &mut O,
    ) {
        let interpolated = |observer: &mut O, rule, name: &str| {
            let fog = self.vertices().fog();
            let values = if self.draw.fog.function.is_some() { fog } else { fog.map(limited) };
            raster::linear(raster::Place { block: FOG, rule, name, prefix: "" }, values, sample.weights().b, observer)
        };
        if let Some(function) = &self.draw.fog.function {
            self.report_passed_fog(function, observer);
        }
        let factor_in_4096ths = |observer: &mut O, rule, v: i64, operation, inputs| {
            let factor = observer.tell(Step::plain(FOG, rule, "fog.4096", v).per(4096).by(operation, inputs));
            ("NUM-6", "factor_byte", vec![factor])
        };
        let (rule, operation, inputs) = match (plane, found.from) {
            (FogPlane::Linear(line, _), FogStep::Linear(v, d)) => {
                let whole = interpolated(observer, "FOG-2", "fog.d");
                let cut = raster::number_step(FOG, "FOG-2", "fog.d.24", d).by("cut_24", vec![whole]);
                let cut = observer.tell(cut);
                let [p0, p1] = [("fog.p0", line.p0), ("fog.p1", line.p1)]
                    .map(|(name, p)| observer.tell(float_step(FOG, "FOG-2", name, p, f64::from(p))));
                let operation = if line.absolute { "fog_linear_abs" } else { "fog_linear" };
                factor_in_4096ths(observer, "FOG-2", v, operation, vec![p0, p1, cut])
            }
            (FogPlane::Exponential(mode, _), FogStep::Exponential(q)) => {
                let e = interpolated(observer, "FOG-4", "fog.e");
                let steps = Step::plain(FOG, "FOG-4", "fog.q", q).per(4096).by("fog_steps", vec![e]);
                let operation = match mode {
                    FogMode::Exp => "fog_exp",
                    FogMode::ExpAbs => "fog_exp_abs",
                    _ => "fog_exp2",
                };
                ("FOG-4", operation, vec![observer.tell(steps)])
            }
            (FogPlane::Factor(_), FogStep::Factor(v)) => {
                let f = interpolated(observer, "INT-5n", "fog.f");
                factor_in_4096ths(observer, "INT-5n", v, "floor_factor", vec![f])
            }
            _ => {
                let linear = self.draw.fog.function.is_some_and(|function| function.mode.is_linear());
                let step = report::register_step(FOG, if linear { "FOG-5" } else { "FOG-4" }, "fog.a", factor);
                let what = "d' or e of a vertex, or a parameter, is not finite".to_string();
                return observer.step(step.note(what));
            }
        };
        observer.step(report::register_step(FOG, rule, "fog.a", factor).by(operation, inputs));
    }

    /// FOG-1 to FOG-3, INT-5n: reports the fog coordinates that the vertices pass on.
    fn report_passed_fog<O: Observer>(&self, function: &FogFunction, observer: &mut O) {
        let word = |observer: &mut O, rule, name: String, value: u32, operation, inputs| {
            let step = Step::plain(FOG, rule, name, value).by(operation, inputs);
            observer.tell(step.note(f32::from_bits(value).to_string()))
        };
        let pattern = |observer: &mut O, name: String, value: f32| {
            observer.tell(Step::plain(FOG, "FOG-1", name, value.to_bits()).note(value.to_string()))
        };
        let vertices = self.vertices();
        let (passed, coordinates) = (vertices.fog(), vertices.fog_coordinates());
        let made = [0, 1, 2].map(|k| {
            let d = coordinates[k]?;
            let same = vertex_fog::passed(function, self.plan.profile, d).to_bits() == passed[k].to_bits();
            same.then_some(d)
        });
        let mut parameters: Vec<Operand> = Vec::new();
        if function.takes_e() && made.iter().any(Option::is_some) {
            for (n, p) in [function.p0, function.p1, function.p2].into_iter().enumerate() {
                let given = pattern(observer, format!("fog.p{n}.pattern"), p);
                let name = format!("fog.p{n}.word");
                parameters.push(word(observer, "FOG-1", name, light::word(p.to_bits()), "light_word", vec![given]));
            }
        }
        for (k, (passed, made)) in passed.into_iter().zip(made).enumerate() {
            let name = |what: &str| format!("vertex{k}.fog.{what}");
            let Some(d) = made else {
                let note = "made at the nearest w, or given".to_string();
                observer.step(Step::plain(FOG, "RAS-0", name("passed"), passed.to_bits()).note(note));
                continue;
            };
            let given = pattern(observer, name("coordinate"), d);
            let [p0, p1, p2] = parameters.as_slice() else {
                word(observer, "FOG-2", name("passed"), passed.to_bits(), "light_word", vec![given]);
                continue;
            };
            let unit = vertex_fog::LightFog::new(function, d);
            let square = vertex_fog::square(d).to_bits();
            let square = word(observer, "FOG-3", name("square"), square, "square_f32", vec![given.clone()]);
            let [d, squared] = unit.coordinates;
            let d = word(observer, "FOG-1", name("word"), d, "light_word", vec![given]);
            let squared = word(observer, "FOG-1", name("square.word"), squared, "light_word", vec![square]);
            let product = |observer: &mut O, n: usize, p: &Operand, of| {
                word(
                    observer,
                    "FOG-3",
                    name(&format!("product{n}")),
                    unit.products[n - 1],
                    "light_product",
                    vec![p.clone(), of],
                )
            };
            let first = product(observer, 1, p1, d);
            let second = product(observer, 2, p2, squared);
            let inputs = vec![p0.clone(), first, second];
            if self.plan.profile == Profile::Nv10 {
                let e = word(observer, "FOG-3", name("e"), unit.sum, "light_sum", inputs);
                word(observer, "INT-5n", name("passed"), passed.to_bits(), "copy_bit_11", vec![e]);
            } else {
                word(observer, "FOG-3", name("passed"), passed.to_bits(), "light_sum", inputs);
            }
        }
    }

    /// DEP-1, DEP-3 to DEP-5: reports the depth. `word` is the result, or `None` if the pixel is outside the range.
    pub(super) fn report_depth<O: Observer>(&self, sample: &Sample<'_>, word: Option<u32>, observer: &mut O) {
        let draw = self.draw;
        let Some(test) = &draw.depth_test else { return };
        let largest = i64::from(draw.depth_format.largest());
        // Fractions of a fixed-point buffer are whole numbers of steps.
        let whole = test.vertex_depths == VertexDepths::Fractions && !draw.depth_format.is_float();
        let mut inputs = Vec::new();
        let (letter, values) = self.depth.w.map_or(("z", self.depth.z), |w| ("w", w));
        let first = if test.w_buffer { "DEP-6" } else { "DEP-1" };
        for (k, z) in values.iter().enumerate() {
            let name = format!("vertex{k}.{letter}");
            inputs.push(observer.tell(match whole && !test.w_buffer {
                true => Step::plain(DEPTH, "DEP-1", name, *z as i64),
                false => float_step(DEPTH, first, name, *z, f64::from(*z)),
            }));
        }
        inputs.extend((0..3).map(|k| plain(format!("E{k}"), sample.e[k])));
        if !test.w_buffer {
            let weights = depth::weights(sample.e);
            raster::shares(DEPTH, ("DEP-1", "", "depth."), (sample.e, None), &weights, observer);
        }
        let triangle = sample.triangle;
        if test.offset != PolygonOffset::default() && triangle.figure == Figure::Triangle {
            inputs.extend([float("bias", test.offset.bias), float("factor", test.offset.factor)]);
            inputs.extend((0..3).map(|k| plain(format!("dE{k}/dx"), triangle.a[k])));
            inputs.extend((0..3).map(|k| plain(format!("dE{k}/dy"), triangle.b[k])));
            inputs.push(plain("area", triangle.doubled_area));
        }
        if let Some(range) = test.range {
            inputs.extend([float("lowest", range.lowest), float("highest", range.highest)]);
            if !range.clamps {
                let step = Step::plain(DEPTH, "DEP-4", "depth_range.inside", word.is_some());
                let note = word.is_none().then(|| "outside: the fragment is dropped".to_owned());
                observer
                    .step(step.by(["depth_inside", "w_inside"][usize::from(test.w_buffer)], inputs.clone()).note(note));
            }
        }
        let Some(word) = word else { return };
        inputs.push(plain("z_max", largest));
        let operation = match (draw.depth_format, test.w_buffer) {
            (DepthFormat::Z16 | DepthFormat::Z24S8, false) => "depth",
            (DepthFormat::Z16F, false) => "depth_float_16",
            (DepthFormat::Z24S8F, false) => "depth_float_24",
            (DepthFormat::Z16 | DepthFormat::Z24S8, true) => "w",
            (DepthFormat::Z16F, true) => "w_float_16",
            (DepthFormat::Z24S8F, true) => "w_float_24",
        };
        let rule = if draw.depth_format.is_float() { "DEP-3" } else { first };
        let step = Step::plain(DEPTH, rule, "z", word).per(self.depth_unit()).by(operation, inputs);
        observer.step(step.ideal(self.ideal_depth(sample)));
    }

    /// Returns the denominator of a depth word: the largest word, or 1 if words are floats.
    fn depth_unit(&self) -> i64 {
        let format = self.draw.depth_format;
        if format.is_float() { 1 } else { i64::from(format.largest()) }
    }

    /// DEP-2: reports the depth test.
    pub(super) fn report_depth_test<O: Observer>(
        &self,
        test: &DepthTest,
        z: i64,
        stored: i64,
        passed: bool,
        observer: &mut O,
    ) {
        observer.step(Step::plain(DEPTH, "", "z.stored", stored).per(self.depth_unit()));
        let depth = |name: &str, value: i64| Operand { per_one: self.depth_unit(), ..plain(name, value) };
        let inputs = vec![depth("z", z), depth("z.stored", stored)];
        observer.step(
            Step::plain(DEPTH, "DEP-2", "depth_test.passed", passed)
                .by(blend::compare_operation(test.function), inputs)
                .note(if passed { "passes" } else { "fails: the fragment is dropped" }.to_string()),
        );
    }

    pub(super) fn report_blend_operands<L: Lane, O: Observer>(
        &self,
        source: &[L; 4],
        truncated: &[L; 4],
        word: u32,
        destination: &[L; 4],
        observer: &mut O,
    ) {
        const BLOCK: &str = "blend";
        let draw = self.draw;
        let dropped = surface::dropped_bits(draw.surface);
        for channel in (0..4).filter(|c| draw.final_combiner.live >> c & 1 != 0) {
            let suffix = channel_name(channel);
            let operation = match dropped.get(channel) {
                Some(3) => "drop_3_bits",
                Some(2) => "drop_2_bits",
                _ => "write",
            };
            let inputs = vec![report::register(format!("fragment.{suffix}"), source[channel])];
            let name = format!("source.{suffix}");
            observer.step(report::register_step(BLOCK, "ROP-5", name, truncated[channel]).by(operation, inputs));
        }
        observer.step(Step::plain(BLOCK, "", "destination.word", word).note(format!("{word:#010x}")));
        for (channel, value) in destination.iter().enumerate() {
            let inputs = vec![
                plain("destination.word", word),
                plain(draw.surface.name(), 0),
                plain(channel_name(channel), channel as i64),
            ];
            let name = format!("destination.{}", channel_name(channel));
            observer.step(report::register_step(BLOCK, "ROP-5", name, *value).by("read_surface", inputs));
        }
        for (channel, value) in draw.blend_constant.into_iter().enumerate() {
            let name = format!("blend_constant.{}", channel_name(channel));
            observer.step(Step::plain(BLOCK, "NUM-5", name, value).per(255).ideal(f64::from(value)));
        }
    }

    pub(super) fn report_store<L: Lane, O: Observer>(
        &self,
        channels: &[L; 4],
        old: u32,
        word: u32,
        memory: &DepthStencil,
        observer: &mut O,
    ) {
        const BLOCK: &str = "store";
        let draw = self.draw;
        let bits = surface::channel_bits(draw.surface);
        let mut inputs =
            vec![plain(draw.surface.name(), 0), plain("surface.word", old), plain("write_mask", draw.write_mask)];
        observer.step(Step::plain(BLOCK, "", "surface.word", old).note(format!("{old:#010x}")));
        for channel in (0..4).filter(|c| bits[*c] & draw.write_mask != 0 && draw.final_combiner.live >> c & 1 != 0) {
            let from = if draw.blend.is_some() && draw.blended >> channel & 1 != 0 { "blend" } else { "fragment" };
            let value = channels[channel].observe().0;
            inputs.push(byte([from, ".", channel_name(channel)].concat(), value));
        }
        let note = format!("{word:#010x}");
        observer.step(Step::plain(BLOCK, "ROP-5", "stored.word", word).by("store", inputs).note(note));
        let shown = surface::show(draw.surface, word);
        for channel in 0..4 {
            if !observer.wants(&["stored.", channel_name(channel)]) {
                continue;
            }
            let name = ["stored.", channel_name(channel)].concat();
            let kept = draw.written >> channel & 1 != 0;
            let ideal = channels[channel].observe().1.filter(|_| kept);
            let inputs = vec![
                plain("stored.word", word),
                plain(draw.surface.texture_format().name(), 0),
                plain(channel_name(channel), channel as i64),
            ];
            observer.step(
                Step::plain(BLOCK, "TEX-1", name, shown[channel]).per(255).by("expand_texel", inputs).ideal(ideal),
            );
        }
        if draw.depth_test.is_some_and(|test| test.write) {
            let z = memory.depth;
            let inputs = vec![Operand { per_one: self.depth_unit(), ..plain("z", z) }];
            observer.step(Step::plain(BLOCK, "DEP-2", "stored.z", z).per(self.depth_unit()).by("write", inputs));
        }
    }
}

const STENCIL_BLOCK: &str = "stencil test";

/// STN-1: reports the comparison, and whether it passes.
pub(super) fn stencil_test<O: Observer>(test: &StencilTest, stored: u8, passed: bool, observer: &mut O) {
    let mut masked = |name: &str, value: u8| {
        let given = Step::plain(STENCIL_BLOCK, "", name, value);
        observer.step(given.note(format!("{value:#04x}")));
        let inputs = vec![plain(name, value), plain("stencil_test.mask", test.mask)];
        observer
            .tell(Step::plain(STENCIL_BLOCK, "STN-1", format!("{name}.masked"), value & test.mask).by("and", inputs))
    };
    let inputs = vec![masked("stencil_test.reference", test.reference), masked("stencil.stored", stored)];
    observer.step(
        Step::plain(STENCIL_BLOCK, "STN-1", "stencil_test.passed", passed)
            .by(blend::compare_operation(test.function), inputs)
            .note(if passed { "passes" } else { "fails: the fragment is dropped" }.to_string()),
    );
}

/// STN-1: reports the stored stencil.
pub(super) fn stencil<O: Observer>(
    test: &StencilTest,
    operation: StencilOperation,
    stored: u8,
    written: u8,
    observer: &mut O,
) {
    let inputs = [
        ("stencil.stored", stored),
        ("stencil_test.reference", test.reference),
        ("stencil_test.write_mask", test.write_mask),
    ];
    let inputs = inputs.map(|(name, value)| plain(name, value)).to_vec();
    let name = match operation {
        StencilOperation::Keep => "stencil_keep",
        StencilOperation::Zero => "stencil_zero",
        StencilOperation::Replace => "stencil_replace",
        StencilOperation::IncrementSaturate => "stencil_increment_saturate",
        StencilOperation::DecrementSaturate => "stencil_decrement_saturate",
        StencilOperation::Invert => "stencil_invert",
        StencilOperation::Increment => "stencil_increment",
        StencilOperation::Decrement => "stencil_decrement",
    };
    let step = Step::plain(STENCIL_BLOCK, "STN-1", "stencil", written);
    observer.step(step.by(name, inputs).note(format!("{written:#04x}")));
}

/// Reports the constants of the first stage whose number is at least `next`, or of the final combiner.
pub(super) fn stage_constants<O: Observer>(next: usize, draw: &PlannedDraw, observer: &mut O) {
    match draw.stages.iter().find(|s| s.index >= next) {
        Some(stage) if !stage.reads_constants => {}
        Some(stage) => constants(&format!("general stage {}", stage.index), stage.constants, observer),
        None if !draw.final_combiner.reads_constants => {}
        None => constants("final combiner", draw.final_combiner.state.constants, observer),
    }
}
