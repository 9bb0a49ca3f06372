//! A draw compiled to rows, and what its pixels are counted by.

use super::kernels::Lanes256;
use super::node::Node;
use super::shader::Shader;
use super::table::{Axis, Table};
use crate::combiner::registers::Registers;
use crate::engine::pixel::TriangleContext;
use crate::plan::{Plan, PlannedDraw};
use crate::state::{DepthFormat, Named, Register, TEXTURE_UNITS, named};
use crate::texture::planned::Image;
use std::sync::Arc;

named! {
    /// Why the definition computed something of a pixel in the fast engine.
    pub enum Reason {
        /// Rows lack what its draw's textures ask for, or decoding them would not pay.
        Textures = "textures that rows do not sample",
        /// Something in its texture shader was a tie, or too close to one.
        Shader = "texture shader not proved",
        /// A level or a place on one was.
        Levels = "levels not proved",
        /// A coordinate of a cube map or divided by q was, or a plane's quotients were too coarse.
        Coordinates = "coordinates not proved",
        /// Weights of colours were too coarse.
        Weights = "weights not proved",
        /// A depth to compare with was.
        References = "depths to compare with not proved",
        /// A fog factor was.
        Fog = "fog not proved",
    }
}

/// Pixels of each [`Reason`].
pub(crate) type Reasons = [u64; Reason::ALL.len()];

/// A unit that rows sample.
#[derive(Clone, Debug)]
pub(crate) struct Sampler {
    /// Its index among the draw's units.
    pub(super) index: usize,
    /// The number of its texture unit, 0 to 3.
    pub(super) unit: usize,
    /// It reads footprints of four texels.
    pub(super) filters: bool,
    pub(super) cube: bool,
    /// Texels of its sides; 1 where coordinates are texels.
    pub(super) sides: [u32; 2],
    pub(super) signed: [bool; 4],
    /// The lod counts.
    pub(super) mixes: bool,
    /// Texels that drop the fragment (KEY-1): what entries of its table are compared with, and in which bits.
    pub(super) key: Option<(u32, u32)>,
    /// A stage of the texture shader makes its coordinates.
    pub(super) depends: bool,
    /// Most taps of a pixel (TEX-17), two and two; 0: there is one.
    pub(super) pairs: usize,
    /// What r is for.
    pub(super) third: Option<Third>,
    /// An earlier sampler whose coordinates are this one's.
    pub(super) shares: Option<usize>,
    /// `None`: of an image that is drawn by this scene, made anew for each draw.
    pub(super) table: Option<Arc<Table>>,
}

impl Sampler {
    /// What is taken off coordinates, 1/256 texel: half a texel where it filters.
    pub(super) fn bias(&self) -> i32 {
        if self.filters { 128 } else { 0 }
    }

    /// Faces or layers.
    pub(super) fn has_images(&self) -> bool {
        self.cube || matches!(self.third, Some(Third::Layer(..)))
    }
}

/// What a sampler takes r for.
#[derive(Clone, Debug)]
pub(crate) enum Third {
    /// The layer of a volume: a sampler whose coordinates are both r, and where its layers lie.
    Layer(Box<Sampler>, Axis),
    /// Of that sampler: it counts layers.
    Counts,
    /// What depths in this format are compared with.
    Reference(DepthFormat),
}

/// A draw compiled to rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct CompiledDraw {
    /// What is computed, and into which row.
    pub(super) operations: Vec<(Node, usize)>,
    /// Each row's constant; 0 where it is computed.
    pub(super) rows: Vec<i16>,
    pub(super) primary: [Option<u16>; 4],
    pub(super) secondary: [Option<u16>; 4],
    pub(super) fog: Option<u16>,
    pub(super) textures: [[Option<u16>; 4]; TEXTURE_UNITS],
    pub(super) destination: [Option<u16>; 4],
    /// Rows of R, G, B, A as they are stored.
    pub(super) stored: [u16; 4],
    /// Row of the alpha that is tested.
    pub(super) alpha: u16,
    /// Channels of the primary and the secondary colour that are read: all bits of their bytes.
    pub(super) read: [u32; 2],
    pub(super) samplers: Vec<Sampler>,
    /// The texture shader, if rows run it.
    pub(super) shader: Option<Arc<Shader>>,
    /// Something is estimated at every pixel besides coordinates: taps, layers, depths to compare with.
    pub(super) estimates: bool,
    /// Nothing varies but colours, depth, what a texture shader's stages take, and coordinates of textures on planes, of one level.
    pub(super) plain: bool,
    /// Texture units are the definition's, pixel by pixel.
    pub(super) samples_pixels: bool,
    /// What the surface holds is read: by the blend, because not all bits are written, or because fragments can be dropped.
    pub(super) reads_surface: bool,
    /// Fragments can be dropped.
    pub(super) drops: bool,
    /// Some of what the surface holds stays: bits that are not written, or dropped fragments.
    pub(super) merges: bool,
    /// All bits of a pixel are written.
    pub(super) writes_whole: bool,
}

impl CompiledDraw {
    /// Whether a colour that is read varies on a triangle.
    #[inline(always)]
    pub(super) fn varies(&self, context: &TriangleContext<'_>) -> bool {
        let [primary, secondary] = [&context.primary, &context.secondary].map(|colors| {
            let [a, b, c] = colors.map(u32::from_le_bytes);
            (a ^ b) | (b ^ c)
        });
        (primary & self.read[0]) | (secondary & self.read[1]) != 0
    }

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

/// Everything of a draw that is the same for all of its blocks.
#[derive(Clone, Copy)]
pub(crate) struct Job<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) draw: &'a PlannedDraw,
    pub(crate) compiled: &'a CompiledDraw,
    pub(crate) textures: &'a [Image<'a, i32>],
    /// The numbers of the triangles to look at, in order; `None`: all.
    pub(crate) triangles: Option<&'a [u32]>,
}
