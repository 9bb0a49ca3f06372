//! One pixel: the order in which the blocks of the chip process it.

use super::context::TriangleContext;
use super::report as reports;
use crate::combiner::direct::Direct;
use crate::combiner::registers::{Registers, channel_name};
use crate::combiner::{final_combiner, general};
use crate::number::Lane;
use crate::raster::depth;
use crate::raster::ideal;
use crate::raster::interpolate::{self, Sample};
use crate::raster::setup::significant;
use crate::raster::smooth;
use crate::rop::{blend, stencil, surface};
use crate::state::*;
use crate::texture::chain::Chain;
use crate::texture::coordinates::VertexCoordinates;
use crate::texture::planned::{Image, PlannedUnit};
use crate::texture::{unit, yuv};
use crate::trace::{Decision, Observer, Rule, Step, Work, report};
use std::cell::OnceCell;

/// A covered pixel before shading.
#[derive(Clone, Copy, Debug)]
pub struct Fragment {
    /// Column and row.
    pub pixel: (i64, i64),
    /// Edge functions E_k at the pixel (RAS-2).
    pub e: [i64; 3],
    /// The word of the surface.
    pub stored: u32,
    /// The ideal's weights of the vertices, if they differ from those of the snapped triangle.
    pub weights: Option<[f64; 3]>,
}

/// Depth and stencil of a pixel. Shading changes them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DepthStencil {
    /// The depth, in the lane's representation.
    pub depth: i64,
    /// The stencil, 0 to 255.
    pub stencil: u8,
}

impl DepthStencil {
    /// Splits an entry of [`Surface::depth`](crate::frame::Surface::depth).
    #[inline]
    pub fn new(word: u32) -> Self {
        DepthStencil { depth: i64::from(depth_of(word)), stencil: stencil_of(word) }
    }

    /// Returns the entry, for a depth that is an integer.
    #[inline]
    pub fn word(self) -> u32 {
        depth_stencil(self.depth as u32, self.stencil)
    }
}

/// The result of a fragment.
#[derive(Clone, Copy, Debug)]
pub struct FragmentResult<L> {
    /// The new word of the surface.
    pub word: u32,
    /// The blended channels before the store, and which of them are written: the contents of an ideal surface.
    pub channels: [L; 4],
}

impl TriangleContext<'_> {
    /// Runs the whole pipe for one pixel. Returns `None` if the texture shader or a test drops the fragment.
    ///
    /// `memory` has the depth and the stencil of the pixel; a dropped fragment can change the stencil. `destination` is the ideal's stored colour,
    /// if the lane has one; otherwise the stored word is used.
    #[inline]
    pub fn shade<L: Lane, O: Observer>(
        &self,
        fragment: &Fragment,
        memory: &mut DepthStencil,
        destination: Option<[L; 4]>,
        textures: &[Image<'_, L>],
        observer: &mut O,
    ) -> Option<FragmentResult<L>> {
        let draw = self.draw;
        let mut sample = Sample::new(&self.triangle, fragment.e);
        sample.ideal = fragment.weights;
        if O::ON && observer.wants_any(&["E", "e", "w", "r0", "r2", "S", "R", "b", "side", "stipple"]) {
            let w = significant(self.vertices().position(3), self.plan.profile);
            reports::setup(draw, &sample, fragment.pixel, w, self.barycentrics(&sample), observer);
        }
        let mut registers = Registers::<L>::new();
        self.interpolate_colors(&sample, &mut registers, observer);
        self.sample_textures(&sample, fragment.pixel, &mut registers, textures, observer)?;
        let constants = O::ON && observer.wants(&["constant"]);
        if constants {
            reports::stage_constants(0, draw, observer);
        }
        for stage in &draw.stages {
            general::run(stage, draw.mux_select, &self.plan.policies, &mut registers, observer);
            if constants {
                // The next stage may have other constants.
                reports::stage_constants(stage.index + 1, draw, observer);
            }
        }
        let (profile, policies) = (self.plan.profile, &self.plan.policies);
        let mut source = final_combiner::run(&draw.final_combiner, profile, policies, &mut registers, observer);
        // Nothing reads an alpha that is not live.
        if self.triangle.is_smooth && draw.final_combiner.live & 8 != 0 {
            source[3] = self.cover_alpha(source[3], fragment.pixel, observer);
        }
        self.depth_stencil_test(&source, &sample, memory, observer)?;
        self.raster_operations(source, fragment, memory, destination, observer)
    }

    /// SMO-1: returns the alpha of a pixel that smooth edges may cover in part.
    #[cold]
    fn cover_alpha<L: Lane, O: Observer>(&self, alpha: L, (i, j): (i64, i64), observer: &mut O) -> L {
        let samples = self.triangle.covered_samples(i, j);
        let fixed = smooth::covered_alpha(alpha.decision().into(), samples) as i32;
        #[allow(clippy::float_arithmetic, reason = "the ideal's part")]
        let covered = alpha.multiplied(fixed, || samples as f64 / smooth::SAMPLES as f64);
        let covered = observer.observe(Rule::Smo1, covered);
        if O::ON && observer.wants_any(&["samples", "fragment."]) {
            reports::covered_alpha(alpha, samples, covered, observer);
        }
        covered
    }

    /// INT-2: loads PRIMARY, SECONDARY and FOG.
    #[inline]
    fn interpolate_colors<L: Lane, O: Observer>(
        &self,
        sample: &Sample<'_>,
        registers: &mut Registers<L>,
        observer: &mut O,
    ) {
        let draw = self.draw;
        let constant = |colors: &[[u8; 4]; 3]| colors[0] == colors[1] && colors[1] == colors[2];
        let sets = [
            (Register::PrimaryColor, draw.primary, &self.primary, "primary"),
            (Register::SecondaryColor, draw.secondary, &self.secondary, "secondary"),
        ];
        let is_outside = sample.is_outside();
        // Equal bytes at all three vertices need no weights, because C W0 + C W1 + C W2 is 256 C.
        let weights = if O::ON || sets.iter().any(|s| s.1 != 0 && !constant(s.2)) {
            let weights = sample.color_weights();
            if O::ON && sets.iter().any(|s| s.1 != 0) && observer.wants(&["W"]) {
                reports::weights(sample, weights, self.barycentrics(sample), observer);
            }
            weights
        } else {
            [0; 2]
        };
        let lane = |n: usize| {
            let k = 2 * n;
            #[allow(clippy::float_arithmetic, reason = "the ideal's weight")]
            L::weight(weights[n] as i32, || 256.0 * self.barycentrics(sample)[k])
        };
        let outer = if is_outside { None } else { Some((lane(0), lane(1))) };
        for (register, live, colors, name) in sets.into_iter().filter(|set| set.1 != 0) {
            let sources = OnceCell::new();
            let source = |k: usize| sources.get_or_init(|| [0, 1, 2].map(|k| self.source(register, k)))[k];
            let corners: [[L; 3]; 4] = std::array::from_fn(|channel| {
                std::array::from_fn(|k| {
                    let corner = L::value(i32::from(colors[k][channel]), || ideal::color_channel(&source(k), channel));
                    // Bytes are exact.
                    if O::MEASURES && matches!(source(k), VertexColor::Floats(_)) {
                        observer.observe(Rule::Num4, corner)
                    } else {
                        corner
                    }
                })
            });
            let mut value = [L::ZERO; 4];
            for (channel, value) in value.iter_mut().enumerate() {
                *value = corners[channel][0];
                if O::ON || !constant(colors) {
                    *value = match outer {
                        Some((w0, w2)) => interpolate::color(corners[channel], w0, w2),
                        None => {
                            let fixed = smooth::color(colors.map(|color| color[channel]), weights);
                            let real = |values| ideal::limited_mix(self.barycentrics(sample), values);
                            L::mixed(corners[channel], fixed.into(), real)
                        }
                    };
                    if O::MEASURES && live >> channel & 1 != 0 {
                        *value = observer.observe(if is_outside { Rule::Smo2 } else { Rule::Int2 }, *value);
                    }
                }
            }
            if O::ON && observer.wants_any(&[name, "vertex"]) {
                let output = if register == Register::PrimaryColor { "oD0" } else { "oD1" };
                for channel in (0..4).filter(|c| live >> c & 1 != 0) {
                    reports::color(
                        name,
                        channel,
                        ([0, 1, 2].map(source), draw.vertex_program.then_some(output)),
                        corners[channel],
                        (&weights, is_outside),
                        value[channel],
                        observer,
                    );
                }
            }
            registers.load(register, value);
        }
        if draw.fog_channels != 0 {
            self.load_fog(sample, registers, observer);
        }
    }

    /// Loads the fog register: its colour, and in alpha the fog factor (NUM-6), which is 255 with fog off (CMB-13).
    fn load_fog<L: Lane, O: Observer>(&self, sample: &Sample<'_>, registers: &mut Registers<L>, observer: &mut O) {
        let draw = self.draw;
        let [r, g, b] = draw.fog.color.map(L::byte);
        let factor = if let Some(plane) = &self.fog {
            let found = plane.at(sample);
            let vertices = self.vertices();
            let ideal = || {
                ideal::fog(&draw.fog.function, self.barycentrics(sample), vertices.fog(), vertices.fog_coordinates())
            };
            let rule = match draw.fog.function {
                None => Rule::Num6,
                Some(function) if function.mode.is_linear() => Rule::Fog2,
                Some(_) => Rule::Fog4,
            };
            let factor = observer.observe(rule, L::value(i32::from(found.byte), ideal));
            if O::ON && observer.wants_any(&["fog", "vertex"]) {
                self.report_fog(sample, plane, found, factor, observer);
            }
            factor
        } else {
            if O::ON {
                observer.step(Step::plain("fog", "CMB-13", "fog.a", 255).per(255).ideal(255.0));
            }
            L::ONE
        };
        if O::ON && observer.wants(&["fog"]) {
            for (channel, value) in [r, g, b].into_iter().enumerate() {
                let name = format!("fog.{}", channel_name(channel));
                observer.step(report::register_step("fog", "NUM-5", name, value));
            }
        }
        registers.load(Register::Fog, [r, g, b, factor]);
    }

    /// Loads TEXTURE0 to TEXTURE3, and SPARE0's alpha (CMB-13). Returns `None` if the texture shader or a colour key drops the fragment.
    #[inline]
    pub(super) fn sample_textures<L: Lane, O: Observer>(
        &self,
        sample: &Sample<'_>,
        pixel: (i64, i64),
        registers: &mut Registers<L>,
        textures: &[Image<'_, L>],
        observer: &mut O,
    ) -> Option<()> {
        const UNITS: [Register; 4] = [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3];
        for (n, register) in UNITS.into_iter().enumerate() {
            if self.draw.unbound[n] != 0 {
                // TEX-16.
                registers.load(register, self.draw.unbound_color.map(L::byte));
                if O::ON {
                    for channel in (0..4).filter(|c| self.draw.unbound[n] >> c & 1 != 0) {
                        let name = format!("texture{n}.{}", channel_name(channel));
                        let value = self.draw.unbound_color[channel];
                        let block = format!("texture unit {n}");
                        let ideal = Some(f64::from(value));
                        observer.step(Step::plain(&block, "TEX-16", name, value).per(255).ideal(ideal));
                    }
                }
            }
        }
        if let (Some(shader), Some(setup)) = (&self.draw.shader, &self.shader) {
            let (units, vertices, scale) = (&self.draw.units, self.vertices(), self.plan.policies.dependent_scale);
            let chain = Chain { shader, units, setup, textures, vertices, perspective: self.draw.perspective, scale };
            let values = chain.run(sample, pixel, observer)?;
            for (register, value) in UNITS.into_iter().zip(values) {
                registers.load(register, value);
            }
        }
        let units = if self.draw.shader.is_none() { &self.draw.units[..] } else { &[] };
        for planned in units {
            let Some(place) = self.sample_coordinates(planned, sample, pixel) else { continue };
            let image = &textures[planned.state.texture];
            let (value, dropped) = unit::sample::<L, O>(planned, image, &place, observer);
            if dropped {
                return None;
            }
            registers.load(UNITS[planned.index], value);
        }
        for n in (0..UNITS.len()).filter(|n| self.draw.yuv[*n]) {
            let color = registers.values[UNITS[n] as usize];
            registers.load(UNITS[n], yuv::convert(n, color, observer));
        }
        if O::ON {
            reports::undefined(self.draw.undefined, observer);
        }
        if !self.draw.spare0_alpha {
            return Some(());
        }
        let alpha = registers.read(Register::Texture0, 3);
        registers.values[Register::Spare0 as usize][3] = alpha;
        if O::ON {
            let inputs = vec![report::register("texture0.a", alpha)];
            observer.step(report::register_step("registers", "CMB-13", "spare0.a", alpha).by("write", inputs));
        }
        Some(())
    }

    /// Returns where a unit samples at its own coordinates.
    #[inline]
    pub(super) fn sample_coordinates<'s>(
        &'s self,
        unit: &'s PlannedUnit,
        sample: &'s Sample<'s>,
        pixel: (i64, i64),
    ) -> Option<VertexCoordinates<'s>> {
        let coordinates = self.coordinates_of(unit.index)?;
        let (vertices, perspective) = (self.vertices(), self.draw.perspective);
        Some(VertexCoordinates { unit, coordinates, at: sample, pixel, vertices, perspective })
    }

    /// ROP-1, STN-1, DEP-1, DEP-2: runs the tests in their order. Returns `None` if the fragment is dropped.
    #[inline]
    fn depth_stencil_test<L: Lane, O: Observer>(
        &self,
        source: &[L; 4],
        sample: &Sample<'_>,
        memory: &mut DepthStencil,
        observer: &mut O,
    ) -> Option<()> {
        let draw = self.draw;
        if let Some(test) = &draw.alpha_test
            && !blend::alpha_test(test, source[3], observer)
        {
            return None;
        }
        if draw.depth_test.as_ref().is_some_and(DepthTest::drops_by_range) && self.depth_word(sample).is_none() {
            if O::ON {
                self.report_depth(sample, None, observer);
            }
            return None;
        }
        let stencil_passed = draw.stencil_test.is_none_or(|test| stencil::passes(&test, memory.stencil));
        if let Some(test) = &draw.stencil_test
            && O::ON
        {
            reports::stencil_test(test, memory.stencil, stencil_passed, observer);
        }
        let mut depth_passed = true;
        if let Some(test) = draw.depth_test.as_ref().filter(|_| stencil_passed) {
            let word = self.depth_word(sample)?;
            let word = observer.observe_depth(word, draw.depth_format.largest(), || self.ideal_depth(sample));
            if O::ON {
                self.report_depth(sample, Some(word), observer);
            }
            let z = L::depth(i64::from(word), || self.ideal_depth(sample));
            depth_passed = test.function.passes(z, memory.depth);
            observer.decided(Decision::DepthTest, i64::from(depth_passed), || i64::from(depth_passed));
            if O::ON {
                self.report_depth_test(test, z, memory.depth, depth_passed, observer);
            }
            if depth_passed && test.write {
                memory.depth = z;
            }
        }
        if let Some(test) = &draw.stencil_test {
            let operation = stencil::operation(test, stencil_passed, depth_passed);
            let written = stencil::written(test, operation, memory.stencil);
            if O::ON {
                reports::stencil(test, operation, memory.stencil, written, observer);
            }
            memory.stencil = written;
        }
        (stencil_passed && depth_passed).then_some(())
    }

    /// DEP-1, DEP-3 to DEP-5: returns the depth of a pixel as the buffer stores it, or `None` if it is outside the range, and dropped.
    #[inline]
    pub(super) fn depth_word(&self, sample: &Sample<'_>) -> Option<u32> {
        let range = self.draw.depth_test.as_ref().and_then(|test| test.range.as_ref());
        let depth = depth::ranged(range, self.depth.at(sample.e))?;
        Some(depth::word(self.draw.depth_format, depth))
    }

    /// ROP-2 to ROP-6: blends and stores.
    #[inline]
    fn raster_operations<L: Lane, O: Observer>(
        &self,
        source: [L; 4],
        fragment: &Fragment,
        memory: &DepthStencil,
        destination: Option<[L; 4]>,
        observer: &mut O,
    ) -> Option<FragmentResult<L>> {
        let draw = self.draw;
        let channels = match &draw.blend {
            None => source,
            Some(state) => {
                let mut direct = Direct::new(&self.plan.policies, observer);
                let truncated = blend::truncated(draw.surface, source, &mut direct);
                observer.count(Work::BytesRead, u64::from(draw.surface.bytes()));
                let stored = surface::read(draw.surface, fragment.stored);
                let destination = match destination {
                    Some(held) => held.map(|held| observer.observe(Rule::Rop5, held)),
                    None => stored.map(L::byte),
                };
                if O::ON {
                    self.report_blend_operands(&source, &truncated, fragment.stored, &destination, observer);
                }
                let constant = draw.blend_constant;
                blend::run(state, draw.blended, constant, &truncated, &destination, observer)
            }
        };
        let bytes = channels.map(|channel| channel.decision().clamp(0, 255) as u8);
        let word = surface::pack(draw.surface, observer.observe_store(draw.surface, bytes));
        let word = surface::masked(fragment.stored, word, draw.write_mask);
        if draw.write_mask != 0 {
            observer.count(Work::BytesWritten, u64::from(draw.surface.bytes()));
        }
        if O::ON && observer.wants_any(&["sto", "surface"]) {
            self.report_store(&channels, fragment.stored, word, memory, observer);
        }
        Some(FragmentResult { word, channels })
    }

    /// Returns the ideal's depth in words of the buffer, with a fraction.
    pub(super) fn ideal_depth(&self, sample: &Sample<'_>) -> f64 {
        let linear = sample.ideal.map_or_else(
            || ideal::barycentrics(&self.triangle, sample.e, [1.0; 3], false),
            |weights| ideal::linear(weights, self.vertices().position(3), self.draw.perspective),
        );
        let Some(test) = &self.draw.depth_test else { return 0.0 };
        let vertices = self.vertices();
        let values = (vertices.position(2), vertices.position(3));
        ideal::depth(linear, values, test, self.draw.depth_format, &self.triangle)
    }

    /// Returns the ideal's weights of the three vertices.
    fn barycentrics(&self, sample: &Sample<'_>) -> [f64; 3] {
        if let Some(weights) = sample.ideal {
            return weights;
        }
        ideal::barycentrics(&self.triangle, sample.e, self.vertices().position(3), self.draw.perspective)
    }
}
