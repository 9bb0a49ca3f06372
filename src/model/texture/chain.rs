//! TSH-1 to TSH-10: runs the stages of a texture shader in order, for one pixel.

use super::coordinates::{Coordinates, VertexCoordinates, quad_pixels, quad_samples, real_coordinate};
use super::dependent::{Dependent, Displacement, QuadTargets, Target};
use super::filter::nearest;
use super::planned::{Image, PlannedUnit};
use super::real::{self, RealColor, RealTarget};
use super::stage::{Color, Dot, PlannedShader, PlannedShaderStage, ShaderSetup, StageSetup};
use super::{dot, shader, shader_report as report, unit};
use crate::number::{Lane, convert};
use crate::raster::binary::Binary;
use crate::raster::fog::factor;
use crate::raster::ideal;
use crate::raster::interpolate::Sample;
use crate::state::{
    DependentScale, ShaderOperation, ShaderStage, TEXTURE_UNITS, TextureFormat, TextureKind, TriangleVertices,
};
use crate::trace::{Decision, Observer, Rule, Silent, Work};

/// A texture shader with everything that it reads.
#[derive(Debug)]
pub struct Chain<'a, L> {
    /// The stages, one for each texture unit.
    pub shader: &'a PlannedShader,
    /// The units of the draw.
    pub units: &'a [PlannedUnit],
    /// The coordinates of the triangle.
    pub setup: &'a ShaderSetup,
    /// The images, indexed by the number of the texture.
    pub textures: &'a [Image<'a, L>],
    /// The triangle's vertices, for the ideal.
    pub vertices: TriangleVertices<'a>,
    /// Whether the ideal divides by the w of the vertices.
    pub perspective: bool,
    /// How the bytes of a dependent read become coordinates (TSH-6).
    pub scale: DependentScale,
}

/// The results of the stages so far.
struct State<L> {
    registers: [[L; 4]; TEXTURE_UNITS],
    dots: [Option<Dot>; TEXTURE_UNITS],
}

/// The pixel that the stages run for.
#[derive(Clone, Copy)]
struct At<'s> {
    sample: &'s Sample<'s>,
    pixel: (i64, i64),
}

/// Returns opaque black (TEX-16).
fn black<L: Lane>() -> [L; 4] {
    [L::ZERO, L::ZERO, L::ZERO, L::ONE]
}

impl<L: Lane> Chain<'_, L> {
    /// Runs the stages and returns the four texture registers, or `None` if the fragment is dropped (TSH-10, KEY-1).
    pub fn run<O: Observer>(
        &self,
        sample: &Sample<'_>,
        pixel: (i64, i64),
        observer: &mut O,
    ) -> Option<[[L; 4]; TEXTURE_UNITS]> {
        let mut state = State::new();
        for index in 0..TEXTURE_UNITS {
            if !self.stage(index, At { sample, pixel }, &mut state, observer) {
                return None;
            }
        }
        Some(state.registers)
    }

    /// Runs the stages before `last` at another pixel of the quad, where nothing is dropped.
    fn before(&self, last: usize, at: At<'_>) -> State<L> {
        let mut state = State::new();
        for index in 0..last {
            self.stage(index, at, &mut state, &mut Silent);
        }
        state
    }

    /// Returns whether anything uses real numbers.
    fn wants_real<O: Observer>() -> bool {
        O::ON || O::MEASURES || L::DECIDES
    }

    /// Runs one stage. Returns `false` if it drops the fragment.
    fn stage<O: Observer>(&self, index: usize, at: At<'_>, state: &mut State<L>, observer: &mut O) -> bool {
        let planned = &self.shader.stages[index];
        if !planned.runs() {
            return true;
        }
        let operation = planned.state.operation;
        if planned.dots {
            self.dot(index, at, state, observer);
        }
        let mut kept = true;
        let mut sampled = |(register, dropped): ([L; 4], bool)| {
            kept = !dropped;
            register
        };
        let register = match operation {
            ShaderOperation::None => black(),
            ShaderOperation::PassThrough => self.pass_through(index, at, observer),
            ShaderOperation::CullFragment { drops_not_negative } => {
                let dropped = self.drops(index, drops_not_negative, at, observer);
                if O::ON && !dropped {
                    report::constant(index, "TSH-10", planned.live, &black::<L>(), observer);
                }
                state.registers[index] = black();
                return !dropped;
            }
            ShaderOperation::DotProduct => {
                if O::ON {
                    report::constant(index, "TSH-4", planned.live, &[L::ZERO; 4], observer);
                }
                [L::ZERO; 4]
            }
            operation if operation.samples_own() => sampled(self.sampled(index, at, observer)),
            _ => sampled(self.dependent(index, at, state, observer)),
        };
        state.registers[index] = register;
        kept
    }

    /// Returns the vertices' coordinate set of a stage.
    fn set(&self, index: usize) -> [[f32; 4]; 3] {
        self.vertices.coordinates(self.shader.stages[index].state.coordinate_set)
    }

    /// Returns a component of the vertices' coordinate set of a stage.
    fn component(&self, index: usize, n: usize) -> [f32; 3] {
        self.set(index).map(|vertex| vertex[n])
    }

    /// Returns the ideal's weights of the vertices.
    fn weights(&self, at: &Sample<'_>) -> [f64; 3] {
        at.ideal.unwrap_or_else(|| ideal::barycentrics(at.triangle, at.e, self.vertices.position(3), self.perspective))
    }

    /// Returns the ideal's interpolated coordinates of a stage.
    fn real_coordinates(&self, index: usize, at: &Sample<'_>) -> [f64; 4] {
        let (weights, set) = (self.weights(at), self.set(index));
        [0, 1, 2, 3].map(|n| ideal::mix(weights, set.map(|v| f64::from(v[n]))))
    }

    /// Samples at the stage's own coordinates. Returns the colour, and whether the fragment is dropped.
    fn sampled<O: Observer>(&self, index: usize, at: At<'_>, observer: &mut O) -> ([L; 4], bool) {
        let (Some(unit), StageSetup::Places(coordinates)) = (self.unit(index), &self.setup.0[index]) else {
            return (black(), false);
        };
        let (vertices, perspective) = (self.vertices, self.perspective);
        let place = VertexCoordinates { unit, coordinates, at: at.sample, pixel: at.pixel, vertices, perspective };
        unit::sample::<L, O>(unit, &self.textures[unit.state.texture], &place, observer)
    }

    fn unit(&self, index: usize) -> Option<&PlannedUnit> {
        self.shader.stages[index].unit.map(|unit| &self.units[unit])
    }

    /// TSH-9: returns the coordinates, limited, as a colour.
    fn pass_through<O: Observer>(&self, index: usize, at: At<'_>, observer: &mut O) -> [L; 4] {
        let StageSetup::Numbers(numbers) = &self.setup.0[index] else { return black() };
        let live = self.shader.stages[index].live;
        let real = if Self::wants_real::<O>() { self.real_coordinates(index, at.sample) } else { [0.0; 4] };
        std::array::from_fn(|n| {
            if live >> n & 1 == 0 {
                return L::ZERO;
            }
            let v = factor(at.sample.value(&numbers[n]));
            let value = L::value(i32::from(convert::factor_byte(v)), || real::pass_through(real[n]));
            let value = observer.observe(Rule::Tsh9, value);
            if O::ON {
                report::pass_through(index, n, (self.component(index, n), at.sample), v, value, observer);
            }
            value
        })
    }

    /// TSH-10: returns whether a coordinate has the sign that is dropped.
    fn drops<O: Observer>(&self, index: usize, not_negative: [bool; 4], at: At<'_>, observer: &mut O) -> bool {
        let StageSetup::Numbers(numbers) = &self.setup.0[index] else { return false };
        let fixed: [bool; 4] = std::array::from_fn(|n| {
            let negative = at.sample.value(&numbers[n]).mantissa < 0;
            if O::ON {
                report::sign(index, n, (self.component(index, n), at.sample), (not_negative[n], negative), observer);
            }
            negative != not_negative[n]
        });
        let real = || {
            let coordinates = self.real_coordinates(index, at.sample);
            (0..4).any(|n| (coordinates[n] < 0.0) != not_negative[n])
        };
        let dropped = if L::DECIDES { real() } else { fixed.contains(&true) };
        observer.decided(Decision::Kill, i64::from(dropped), || i64::from(real()));
        dropped
    }

    /// Returns the colour of an earlier unit. Channels that are not live have no meaning.
    fn color<O: Observer>(&self, unit: usize, state: &State<L>) -> Color {
        let register = state.registers[unit];
        let (sampled, doubled) = (self.unit(unit), self.shader.doubled(unit, self.units));
        let held = register.map(Lane::decision);
        let bytes = std::array::from_fn(|n| (held[n] >> u32::from(doubled[n])) as u8);
        let mut real = RealColor::default();
        if Self::wants_real::<O>() {
            let values = register.map(|lane| lane.observe().1.unwrap_or(0.0));
            let wide = sampled.is_some_and(|unit| unit.is_wide());
            real = RealColor::of_registers(values, doubled, wide);
        }
        Color { unit, bytes, held: held.map(i64::from), doubled, real }
    }

    /// TSH-1 to TSH-4: returns the dot product of a stage, which is computed once.
    fn dot<O: Observer>(&self, index: usize, at: At<'_>, state: &mut State<L>, observer: &mut O) -> Dot {
        if let Some(dot) = state.dots[index] {
            return dot;
        }
        let StageSetup::Numbers(numbers) = &self.setup.0[index] else { return Dot::default() };
        let ShaderStage { previous, mapping, .. } = self.shader.stages[index].state;
        let color = self.color::<O>(previous, state);
        let coordinates = [0, 1, 2].map(|n| at.sample.value(&numbers[n]).nearest_f32());
        let vector = dot::remap(mapping, color.bytes);
        let products = dot::products(coordinates, vector);
        observer.count(Work::Dots, dot::DOT_OPERATIONS);
        let mut dot = Dot { fixed: dot::Number::sum(products), real: 0.0 };
        if Self::wants_real::<O>() {
            let [s, t, r, _] = self.real_coordinates(index, at.sample);
            let real = color.real.remap(mapping);
            dot.real = dot::dot([s, t, r], real);
            if O::ON {
                let values = [0, 1, 2].map(|n| self.component(index, n));
                let parts = report::DotParts { mapping, values, coordinates, vector, products, dot };
                report::dot(index, &color, &parts, ([s, t, r], real), at.sample, observer);
            }
        }
        state.dots[index] = Some(dot);
        dot
    }

    /// Returns the dot products of stages 1 to 3.
    fn normal<O: Observer>(&self, at: At<'_>, state: &mut State<L>, observer: &mut O) -> [Dot; 3] {
        [1, 2, 3].map(|index| self.dot(index, at, state, observer))
    }

    /// Returns where a stage that depends on an earlier one samples, and where the ideal would sample by its own
    /// numbers.
    fn target<'t, O: Observer>(
        &'t self,
        index: usize,
        at: At<'t>,
        state: &mut State<L>,
        observer: &mut O,
    ) -> (Target<'t>, RealTarget) {
        let ShaderStage { operation, previous, .. } = self.shader.stages[index].state;
        let real = |of: &dyn Fn() -> RealTarget| {
            if Self::wants_real::<O>() { of() } else { RealTarget::Coordinates([0.0; 2]) }
        };
        match operation {
            ShaderOperation::DotProduct2D => {
                let dots = [index - 1, index].map(|index| self.dot(index, at, state, observer));
                (Target::Floats(dots.map(|d| d.fixed)), real(&|| RealTarget::Coordinates(dots.map(|d| d.real))))
            }
            ShaderOperation::DotProduct3D => {
                let dots = [index - 2, index - 1].map(|index| self.dot(index, at, state, observer));
                let (fixed, long) = (dots.map(|d| d.fixed), dots.map(|d| d.real));
                if self.unit(index).is_some_and(|unit| unit.kind == TextureKind::Cube) {
                    (Target::Ends(fixed), real(&|| RealTarget::ends(long)))
                } else {
                    (Target::Floats(fixed), real(&|| RealTarget::Coordinates(long)))
                }
            }
            ShaderOperation::DotReflectSpecular | ShaderOperation::DotReflectConstantEye { .. } => {
                let normal = self.normal(at, state, observer);
                let (eye, real_eye) = self.eye(index, at.sample, observer);
                let (short, long) = (normal.map(|d| d.fixed), normal.map(|d| d.real));
                let unit = self.shader.stages[index].unit_normals;
                let fixed = dot::reflect_about(short, if unit { 1.0 } else { dot::dot(short, short) }, eye);
                observer.count(Work::Dots, dot::REFLECTION_OPERATIONS);
                let reflected = || dot::reflect_about(long, if unit { 1.0 } else { dot::dot(long, long) }, real_eye);
                if O::ON {
                    let constant = matches!(operation, ShaderOperation::DotReflectConstantEye { .. });
                    report::reflection(index, normal, (eye, constant), &fixed, &reflected(), observer);
                }
                (Target::Vector(fixed.vector), real(&|| RealTarget::Vector(reflected().vector)))
            }
            ShaderOperation::DependentAlphaRed | ShaderOperation::DependentGreenBlue => {
                let channels = if operation == ShaderOperation::DependentAlphaRed { [3, 0] } else { [1, 2] };
                let color = self.color::<O>(previous, state);
                if O::ON {
                    report::previous(index, &color, &channels, observer);
                }
                let own = real(&|| RealTarget::bytes(channels.map(|n| color.real.bytes[n]), 255.0));
                (Target::Bytes(channels.map(|n| color.bytes[n]), self.scale), own)
            }
            ShaderOperation::BumpEnvironment { matrix, luminance } => {
                let color = self.color::<O>(previous, state);
                if O::ON {
                    // The luminance affects colours only. If only alpha is read, red need not have been sampled.
                    let lit = luminance.is_some() && self.shader.stages[index].live & 7 != 0;
                    let red: &[usize] = if lit { &[0, 1, 2] } else { &[1, 2] };
                    report::previous(index, &color, red, observer);
                }
                let blue_green = [color.bytes[2], color.bytes[1]];
                let StageSetup::Places(Coordinates::Plane(st)) = &self.setup.0[index] else {
                    return (Target::Bytes([0; 2], self.scale), RealTarget::Coordinates([0.0; 2]));
                };
                let own = real(&|| {
                    let [s, t, ..] = self.real_coordinates(index, at.sample);
                    RealTarget::moved([s, t], real::offset(matrix, &color.real))
                });
                (Target::Moved(Displacement { st, at: at.sample, vertices: self.vertices, matrix, blue_green }), own)
            }
            // DotProductCube and DotReflectDiffuse.
            _ => {
                let normal = self.normal(at, state, observer);
                (Target::Vector(normal.map(|d| d.fixed)), real(&|| RealTarget::Vector(normal.map(|d| d.real))))
            }
        }
    }

    /// TSH-5: returns the eye vector of the definition and of the ideal.
    fn eye<O: Observer>(&self, index: usize, at: &Sample<'_>, observer: &mut O) -> ([f32; 3], [f64; 3]) {
        if let ShaderOperation::DotReflectConstantEye { eye } = self.shader.stages[index].state.operation {
            return (eye, eye.map(f64::from));
        }
        let mut real = [0.0; 3];
        let fixed = std::array::from_fn(|n| {
            let StageSetup::Numbers(numbers) = &self.setup.0[n + 1] else { return 0.0 };
            let q = at.value(&numbers[3]).nearest_f32();
            if Self::wants_real::<O>() {
                real[n] = self.real_coordinates(n + 1, at)[3];
            }
            if O::ON {
                report::rounded(n + 1, 3, (self.component(n + 1, 3), at), q, real[n], observer);
            }
            q
        });
        (fixed, real)
    }

    /// Samples where an earlier stage points to. Returns the colour, and whether the fragment is dropped.
    fn dependent<O: Observer>(
        &self,
        index: usize,
        at: At<'_>,
        state: &mut State<L>,
        observer: &mut O,
    ) -> ([L; 4], bool) {
        let Some(unit) = self.unit(index) else { return (black(), false) };
        let (target, own) = self.target(index, at, state, observer);
        let real = if Self::wants_real::<O>() { self.followed(index, &target, own, at.sample) } else { own };
        if O::MEASURES {
            let texel = |face: i64, [u, v]: [i64; 2]| face << 60 ^ nearest(u) << 30 ^ nearest(v);
            let sides = unit.scale(&unit.levels[0]);
            let on = |real: RealTarget| {
                let real = real.real(unit.kind, None);
                let uv = [0, 1].map(|n| unit::floored(real_coordinate(real.st[n], sides[n])));
                texel(real.face as i64, uv)
            };
            let fixed = texel(target.face() as i64, target.on(unit, &unit.levels[0]));
            observer.decided(Decision::Dependent, if L::DECIDES { on(real) } else { fixed }, || on(own));
        }
        let quad = if unit.needs_lod() { self.quad(index, unit, at) } else { None };
        let place = Dependent { unit, target, real, quad };
        let (color, dropped) = unit::sample::<L, O>(unit, &self.textures[unit.state.texture], &place, observer);
        let color = match self.shader.stages[index].state.operation {
            ShaderOperation::BumpEnvironment { luminance: Some(luminance), .. } => {
                self.luminance(index, color, luminance, state, observer)
            }
            _ => color,
        };
        (color, dropped)
    }

    /// Returns the coordinates at which the ideal samples: its own if the lane decides by its own numbers, otherwise
    /// those of the definition.
    fn followed(&self, index: usize, target: &Target<'_>, own: RealTarget, at: &Sample<'_>) -> RealTarget {
        if L::DECIDES {
            return own;
        }
        target.followed(|| {
            let [s, t, ..] = self.real_coordinates(index, at);
            [s, t]
        })
    }

    /// TEX-11 for a dependent read: runs the chain at the three pixels of the quad. Returns `None` if a pixel lies
    /// behind the viewer or the face.
    fn quad(&self, index: usize, unit: &PlannedUnit, at: At<'_>) -> Option<QuadTargets> {
        let samples = quad_samples(at.sample.triangle, at.pixel);
        if samples.iter().any(Sample::is_behind) {
            return None;
        }
        let mut fixed = [[0; 2]; 3];
        let mut real = [[0.0; 2]; 3];
        let (mut face, mut real_face) = (None, None);
        for (n, (sample, pixel)) in samples.iter().zip(quad_pixels(at.pixel)).enumerate() {
            let at = At { sample, pixel };
            let mut state = self.before(index, at);
            let (target, own) = self.target(index, at, &mut state, &mut Silent);
            let place = self.followed(index, &target, own, sample);
            let face = *face.get_or_insert_with(|| target.face());
            let real_face =
                *real_face.get_or_insert_with(|| if L::DECIDES { place.real(unit.kind, None).face } else { face });
            fixed[n] = target.at_quad(unit, face)?;
            real[n] = place.real(unit.kind, Some(real_face)).st;
        }
        Some(QuadTargets { fixed, real, face: face? })
    }

    /// TSH-8: multiplies the texel by the scaled luminance.
    fn luminance<O: Observer>(
        &self,
        index: usize,
        color: [L; 4],
        luminance: [f32; 2],
        results: &State<L>,
        observer: &mut O,
    ) -> [L; 4] {
        let PlannedShaderStage { live, lights_alpha, signed_luminance, state, .. } = self.shader.stages[index];
        let previous = self.color::<O>(state.previous, results);
        let red = if L::DECIDES { previous.real.bytes[0] } else { f64::from(previous.bytes[0]) };
        let red = if signed_luminance { real::signed_luminance(red) } else { red };
        if O::ON && live & 7 != 0 {
            report::luminance_state(index, luminance, observer);
        }
        std::array::from_fn(|n| {
            if n == 3 && !lights_alpha || live >> n & 1 == 0 {
                return color[n];
            }
            let v = shader::luminance(color[n].decision().into(), previous.bytes[0].into(), luminance.map(Binary::new));
            let byte = shader::luminance_byte(v) as i32;
            let value = observer.observe(Rule::Tsh8, color[n].multiplied(byte, || real::luminance(red, luminance)));
            if O::ON {
                report::luminance(index, n, (color[n], v, value), previous.bytes[0], luminance, observer);
            }
            value
        })
    }
}

impl<L: Lane> State<L> {
    /// Returns the initial state, in which every unit is opaque black (TEX-16).
    fn new() -> Self {
        State { registers: [black(); TEXTURE_UNITS], dots: [None; TEXTURE_UNITS] }
    }
}

impl PlannedShader {
    /// Returns whether each channel of a stage's register holds twice its two's complement byte.
    pub fn doubled(&self, index: usize, units: &[PlannedUnit]) -> [bool; 4] {
        let PlannedShaderStage { state, unit, .. } = &self.stages[index];
        let has_luminance = matches!(state.operation, ShaderOperation::BumpEnvironment { luminance: Some(_), .. });
        let holds = |n: usize| unit.is_some_and(|unit| holds_double(&units[unit], n));
        [0, 1, 2, 3].map(|n: usize| !(has_luminance && n < 3) && holds(n))
    }
}

/// Returns whether the register holds twice the two's complement byte of a channel (TEX-18).
pub(crate) fn holds_double(unit: &PlannedUnit, channel: usize) -> bool {
    match (unit.format, channel) {
        (TextureFormat::R16B16 | TextureFormat::Y16, 3) => unit.signed_lane(0),
        (TextureFormat::R16B16 | TextureFormat::Y16, 1) => unit.signed_lane(1),
        (TextureFormat::R16B16 | TextureFormat::Y16, _) => false,
        (_, channel) => unit.state.signed[channel],
    }
}
