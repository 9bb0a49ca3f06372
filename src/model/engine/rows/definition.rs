//! What the definition computes of a batch where estimates prove nothing, or where rows lack what textures ask for.

use super::fetch::PerLane;
use super::kernels::Lanes256;
use super::planes::Plane;
use super::third::Third;
use super::triangle::{PixelBatch, Setup, Varying};
use super::{CompiledDraw, Reason, Sampler};
use crate::combiner::registers::Registers;
use crate::raster::interpolate::Sample;
use crate::state::{Register, TEXTURE_UNITS};
use crate::texture::place::Place;
use crate::texture::planned::Image;
use crate::trace::Silent;

impl Setup<'_> {
    /// One of the batch's pixels as a sample of the triangle.
    pub(super) fn sample(&self, batch: PixelBatch<'_>, n: usize) -> Sample<'_> {
        batch.sample(n, &self.context.triangle)
    }

    /// Coordinates by the definition, pixel by pixel.
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

    /// The same of one of them.
    pub(super) fn defined_lane(
        &self,
        batch: PixelBatch<'_>,
        n: usize,
        sampler: &Sampler,
        numbers: &mut [PerLane<i32>; 2],
        faces: &mut PerLane<u32>,
    ) {
        self.tell(Reason::Coordinates, 1);
        let unit = &self.context.draw.units[sampler.index];
        let sample = self.sample(batch, n);
        let Some(place) = self.context.place(unit, &sample, batch.pixel(n)) else { return };
        let [u, v] = match sampler.third {
            Some(Third::Counts) => [place.layer(unit.layers); 2],
            _ => place.on(&unit.levels[0]),
        };
        let lane = batch.lane + n;
        (numbers[0][lane], numbers[1][lane]) = (u.value as i32 - sampler.bias(), v.value as i32 - sampler.bias());
        faces[lane] = place.face() as u32;
    }

    /// Texture units that rows do not sample.
    pub(super) fn pixel_by_pixel(
        &self,
        batch: PixelBatch<'_>,
        compiled: &CompiledDraw,
        textures: &[Image<'_, i32>],
        varying: &mut Varying,
        rows: &mut [Lanes256],
    ) {
        self.tell(Reason::Textures, batch.count);
        for n in 0..batch.count {
            let (sample, lane) = (self.sample(batch, n), batch.lane + n);
            let mut registers = Registers::<i32>::new();
            let lives = self.context.sample_textures(&sample, batch.pixel(n), &mut registers, textures, &mut Silent);
            varying.alive[lane] = lives.is_some();
            compiled.put_textures(&registers, lane, rows);
        }
    }
}

impl CompiledDraw {
    /// Puts the texture registers of a pixel into the rows that want them.
    pub(super) fn put_textures(&self, registers: &Registers<i32>, lane: usize, rows: &mut [Lanes256]) {
        const UNITS: [Register; TEXTURE_UNITS] =
            [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3];
        for (slots, register) in self.textures.iter().zip(UNITS) {
            for (channel, slot) in slots.iter().enumerate() {
                if let Some(slot) = slot {
                    rows[usize::from(*slot)].0[lane] = registers.read(register, channel) as i16;
                }
            }
        }
    }
}

/// INT-4 of a plane, less a bias.
pub(super) fn defined_coordinate(sample: &Sample<'_>, plane: &Plane, bias: i32) -> i32 {
    sample.coordinate(&plane.g).value as i32 - bias
}
