//! A draw compiled to rows, and the statistics of its pixels.

use super::kernels::PerLane;
use super::node::Node;
use super::shader::Shader;
use super::table::{Axis, Table};
use crate::combiner::registers::Registers;
use crate::engine::context::TriangleContext;
use crate::state::{DepthFormat, Named, Register, TEXTURE_UNITS, named};
use std::sync::Arc;

named! {
    /// The reason why the definition computed something of a pixel for the fast engine.
    pub enum Reason {
        /// Rows do not support the draw's textures, or decoding them would not pay.
        Textures = "textures that rows do not sample",
        /// A value of the texture shader was a tie, or too close to one.
        Shader = "texture shader not proved",
        /// A level, or a coordinate on a level, was a tie or too close to one.
        Levels = "levels not proved",
        /// A coordinate was a tie or too close to one, or a plane's quotients were too coarse.
        Coordinates = "coordinates not proved",
        /// Weights of colours were too coarse.
        Weights = "weights not proved",
        /// A depth was too close to a border of two weights, or numbers of a w buffer were too large or too small.
        Depths = "depths not proved",
        /// A depth to compare with was a tie or too close to one.
        References = "depths to compare with not proved",
        /// A fog factor was a tie or too close to one.
        Fog = "fog not proved",
    }
}

/// Number of pixels for each [`Reason`].
pub(crate) type Reasons = [u64; Reason::ALL.len()];

/// A texture unit that rows can sample.
#[derive(Clone, Debug)]
pub(crate) struct Sampler {
    /// Index among the draw's units.
    pub(super) index: usize,
    /// Number of the texture unit, 0 to 3.
    pub(super) unit: usize,
    /// Whether it reads footprints of four texels.
    pub(super) filters: bool,
    pub(super) cube: bool,
    /// Sides of the image in texels; 1 if coordinates are given in texels.
    pub(super) sides: [u32; 2],
    /// What is [added](super::planes::up) to estimates of u and v, 1/256 texel.
    pub(super) up: [f64; 2],
    pub(super) signed: [bool; 4],
    /// Whether it needs a level of detail.
    pub(super) mixes: bool,
    /// Value and mask that entries of the table are compared with, if such texels drop the fragment (KEY-1).
    pub(super) key: Option<(u32, u32)>,
    /// Whether a stage of the texture shader computes its coordinates.
    pub(super) depends: bool,
    /// Largest number of pairs of taps of a pixel (TEX-17); 0 if there is one tap.
    pub(super) pairs: usize,
    /// The use of the coordinate r.
    pub(super) third: Option<Third>,
    /// Index of an earlier sampler that has the same coordinates.
    pub(super) shares: Option<usize>,
    /// The decoded texture; `None` if the scene draws the image, so that it is decoded for each draw.
    pub(super) table: Option<Arc<Table>>,
}

impl Sampler {
    /// Returns what is subtracted from coordinates, in 1/256 texel: half a texel if the sampler filters a single level.
    pub(super) fn bias(&self) -> i32 {
        if self.filters && !self.mixes { 128 } else { 0 }
    }

    /// Returns whether it needs nothing for each pixel but two coordinates, and perhaps a level of detail or a depth to compare with.
    pub(super) fn is_plain(&self) -> bool {
        !(self.pairs > 0 || self.has_images())
    }

    /// Returns whether it has faces or layers.
    pub(super) fn has_images(&self) -> bool {
        self.cube || matches!(self.third, Some(Third::Layer(..)))
    }
}

/// The use of the coordinate r.
#[derive(Clone, Debug)]
pub(crate) enum Third {
    /// Selects the layer of a volume: a sampler both of whose coordinates are r, and the axis of the layers.
    Layer(Box<Sampler>, Axis),
    /// Counts layers: the use in that sampler.
    Counts,
    /// Is compared with depths of this format.
    Reference(DepthFormat),
}

/// A draw compiled to rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct CompiledDraw {
    /// Operations in order, each with the row of its result.
    pub(super) operations: Vec<(Node, usize)>,
    /// What each row is filled with when a draw begins, unless an operation computes it.
    pub(super) rows: Vec<Option<i16>>,
    pub(super) primary: [Option<u16>; 4],
    pub(super) secondary: [Option<u16>; 4],
    pub(super) fog: Option<u16>,
    pub(super) textures: [[Option<u16>; 4]; TEXTURE_UNITS],
    pub(super) destination: [Option<u16>; 4],
    /// Rows of the stored R, G, B and A.
    pub(super) stored: [u16; 4],
    /// Row of the alpha that is tested.
    pub(super) alpha: u16,
    /// Channels of the primary and of the secondary colour that are read, as masks of bytes.
    pub(super) read: [u32; 2],
    pub(super) samplers: Vec<Sampler>,
    /// The texture shader, if rows run it.
    pub(super) shader: Option<Arc<Shader>>,
    /// Whether each pixel needs estimates besides coordinates: taps, layers or depths to compare with.
    pub(super) estimates: bool,
    /// Whether nothing is interpolated but colours, depths, fog, inputs of the texture shader, and coordinates of textures that are neither cube maps nor
    /// volumes; and no quads are completed.
    pub(super) plain: bool,
    /// Whether there are depths, and those of small triangles are set up together.
    pub(super) depths_together: bool,
    /// Whether small triangles need not be placed and weighed one by one, unless something is not proved: neither for depths nor for bump stages.
    pub(super) together: bool,
    /// Whether the definition samples the texture units, pixel by pixel.
    pub(super) samples_pixels: bool,
    /// Whether quads are drawn with all of their pixels: a dependent read has levels, which follow from the results of all.
    pub(super) completes_quads: bool,
    /// Whether the surface or its depths are read when a block is computed: for blending, or for tests that are late.
    pub(super) reads_surface: bool,
    /// Whether something other than the depth test can drop fragments. If nothing else can, depths are tested before anything else.
    pub(super) drops_late: bool,
    /// Whether parts of the surface's words may stay: bits that are not written, or dropped fragments.
    pub(super) merges: bool,
    /// Whether all bits of a pixel are written.
    pub(super) writes_whole: bool,
}

impl CompiledDraw {
    /// Returns whether a colour that is read varies across a triangle.
    #[inline(always)]
    pub(super) fn varies(&self, context: &TriangleContext<'_>) -> bool {
        let [primary, secondary] = [&context.primary, &context.secondary].map(|colors| {
            let [a, b, c] = colors.map(u32::from_le_bytes);
            (a ^ b) | (b ^ c)
        });
        (primary & self.read[0]) | (secondary & self.read[1]) != 0
    }

    /// Returns whether something besides colours is divided by D.
    #[inline(always)]
    pub(super) fn divides(&self) -> bool {
        self.shader.is_some() || self.fog.is_some() || !self.samplers.is_empty()
    }

    /// Returns whether a plain draw reads depths to compare with, fog, or numbers of the texture shader.
    pub(super) fn reads_ratios(&self) -> bool {
        self.estimates || self.fog.is_some() || self.of_numbers().is_some()
    }

    /// Returns the texture shader if all of its inputs are numbers.
    #[inline(always)]
    pub(super) fn of_numbers(&self) -> Option<&Shader> {
        self.shader.as_deref().filter(|shader| shader.moved.is_empty())
    }

    /// Puts the texture registers of a pixel into the rows that read them.
    pub(super) fn put_textures(&self, registers: &Registers<i32>, lane: usize, rows: &mut [PerLane<i16>]) {
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
