//! Values that the definition computes for a batch: those that estimates do not prove, and those of textures that rows do not support.

use super::compiled::{CompiledDraw, Reason, Sampler, Third};
use super::kernels::PerLane;
use super::setup::{PixelBatch, Setup};
use crate::combiner::registers::Registers;
use crate::texture::coordinates::SampleCoordinates;
use crate::texture::planned::Image;
use crate::trace::Silent;

impl Setup<'_> {
    /// Computes coordinates by the definition, pixel by pixel.
    pub(super) fn defined(
        &self,
        batch: PixelBatch<'_>,
        sampler: &Sampler,
        numbers: &mut [PerLane<i32>; 2],
        faces: &mut PerLane<u32>,
    ) {
        for n in 0..batch.count {
            self.defined_lane(batch, n, sampler, numbers, faces);
        }
    }

    /// Computes the coordinates of one pixel by the definition.
    pub(super) fn defined_lane(
        &self,
        batch: PixelBatch<'_>,
        n: usize,
        sampler: &Sampler,
        numbers: &mut [PerLane<i32>; 2],
        faces: &mut PerLane<u32>,
    ) {
        self.count_defined(Reason::Coordinates, 1);
        let unit = &self.context.draw.units[sampler.index];
        let sample = self.sample(batch, n);
        let Some(place) = self.context.sample_coordinates(unit, &sample, batch.pixel(n)) else { return };
        let [u, v] = match sampler.third {
            Some(Third::Counts) => [place.layer(unit.layers); 2],
            _ => place.on(&unit.levels[0]),
        };
        let lane = batch.lane + n;
        (numbers[0][lane], numbers[1][lane]) = (u.value as i32 - sampler.bias(), v.value as i32 - sampler.bias());
        faces[lane] = place.face() as u32;
    }

    /// Samples all texture units of a batch by the definition.
    pub(super) fn pixel_by_pixel(
        &self,
        batch: PixelBatch<'_>,
        compiled: &CompiledDraw,
        textures: &[Image<'_, i32>],
        alive: &mut PerLane<bool>,
        rows: &mut [PerLane<i16>],
    ) {
        self.count_defined(Reason::Textures, batch.count);
        for n in 0..batch.count {
            let (sample, lane) = (self.sample(batch, n), batch.lane + n);
            let mut registers = Registers::<i32>::new();
            let lives = self.context.sample_textures(&sample, batch.pixel(n), &mut registers, textures, &mut Silent);
            alive[lane] = lives.is_some();
            compiled.put_textures(&registers, lane, rows);
        }
    }
}
