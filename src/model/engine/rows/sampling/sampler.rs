//! A texture unit that rows can sample.

use super::table::{self, Axis, Table};
use crate::plan::PlannedDraw;
use crate::state::{DepthFormat, Filter, SPRITE_UNIT, ShaderOperation, TextureKind, TextureUnit};
use crate::texture::chain::holds_double;
use std::sync::Arc;

/// A texture unit that rows can sample.
#[derive(Clone, Debug)]
pub(crate) struct Sampler {
    /// Index among the draw's units.
    pub(crate) index: usize,
    /// Number of the texture unit, 0 to 3.
    pub(crate) unit: usize,
    /// Whether it reads footprints of four texels.
    pub(crate) filters: bool,
    /// Whether it has faces.
    pub(crate) cube: bool,
    /// Whether its coordinates are a direction.
    pub(crate) direction: bool,
    /// Sides of the image in texels; 1 if coordinates are given in texels.
    pub(crate) sides: [u32; 2],
    pub(crate) signed: [bool; 4],
    /// Whether it needs a level of detail.
    pub(crate) mixes: bool,
    /// Value and mask that entries of the table are compared with, if such texels drop the fragment (KEY-1).
    pub(crate) key: Option<(u32, u32)>,
    /// Whether a stage of the texture shader computes its coordinates.
    pub(crate) depends: bool,
    /// Whether that stage moves interpolated coordinates (TSH-7).
    pub(crate) moves: bool,
    /// Largest number of pairs of taps of a pixel (TEX-17); 0 if there is one tap.
    pub(crate) pairs: usize,
    /// The use of the coordinate r.
    pub(crate) third: Option<Third>,
    /// Whether points have coordinates of their own (PNT-2).
    pub(crate) is_sprite: bool,
    /// Index of an earlier sampler that has the same coordinates.
    pub(crate) shares: Option<usize>,
    /// The decoded texture; `None` if the scene draws the image, so that it is decoded for each draw.
    pub(crate) table: Option<Arc<Table>>,
}

/// The use of the coordinate r.
#[derive(Clone, Debug)]
pub(crate) enum Third {
    /// Selects the layer of a volume: the number of layers, and their axis.
    Layer(u32, Axis),
    /// Is compared with depths of this format.
    Reference(DepthFormat),
}

impl Sampler {
    /// Returns the sampler of a draw's unit.
    pub(crate) fn new(draw: &PlannedDraw, index: usize, depends: bool, table: Option<Arc<Table>>) -> Sampler {
        let unit = &draw.units[index];
        let third = match table::layers(unit) {
            Some(axis) => Some(Third::Layer(unit.layers, axis)),
            None => table::compares_r(unit).map(|_| Third::Reference(unit.format.depth().unwrap_or(DepthFormat::Z16))),
        };
        Sampler {
            index,
            unit: unit.index,
            filters: unit.state.mag_filter == Filter::Linear,
            cube: unit.kind == TextureKind::Cube,
            direction: unit.takes_direction(),
            sides: unit.scale(&unit.levels[0]),
            signed: [0, 1, 2, 3].map(|n| holds_double(unit, n)),
            mixes: unit.needs_lod(),
            key: unit.state.color_key.filter(|_| unit.state.kills()).map(|key| table::entry_of_key(unit, &key)),
            depends,
            moves: depends && matches!(unit.stage.operation, ShaderOperation::BumpEnvironment { .. }),
            pairs: unit.state.anisotropy as usize / 2,
            third,
            is_sprite: draw.point_sprite && unit.index == SPRITE_UNIT,
            shares: None,
            table,
        }
    }

    /// Returns what is subtracted from coordinates, in 1/256 texel: half a texel if the sampler filters a single level.
    pub(crate) fn bias(&self) -> i32 {
        if self.filters && !self.mixes { 128 } else { 0 }
    }

    /// Returns whether its coordinates are those of another kind than the image (TEX-20).
    pub(crate) fn is_other_kind(&self) -> bool {
        self.cube != self.direction
    }

    /// Returns the [bias](Self::bias), or 0 if coordinates are not yet those of the image.
    pub(crate) fn early_bias(&self) -> i32 {
        if self.is_other_kind() { 0 } else { self.bias() }
    }

    /// Returns the side of the face on which directions lie. A two-dimensional image takes one of twice its longer side.
    pub(crate) fn side_of_face(&self) -> u32 {
        let [width, height] = self.sides;
        if self.cube { width } else { 2 * width.max(height) }
    }

    /// Returns whether it has faces or layers.
    pub(crate) fn has_images(&self) -> bool {
        self.cube || matches!(self.third, Some(Third::Layer(..)))
    }

    /// Returns whether its own coordinates are interpolated.
    pub(crate) fn interpolates(&self) -> bool {
        self.shares.is_none() && (self.moves || !self.depends)
    }

    /// Returns whether something follows from how its coordinates change across quads: levels, or taps.
    pub(crate) fn takes_quads(&self) -> bool {
        self.mixes || self.pairs > 0
    }
}

/// Returns whether two samplers have the same coordinates at all vertices, and so everywhere.
pub(crate) fn share(draw: &PlannedDraw, one: &Sampler, other: &Sampler) -> bool {
    let [a, b] = [one, other].map(|sampler| &draw.units[sampler.index]);
    let [first, second] = [a, b].map(|unit| unit.stage.coordinate_set);
    // All that decides, beside coordinates, which levels a unit reads and where.
    let levels =
        |state: &TextureUnit| (state.min_filter, state.mip_filter, state.lod_bias, state.min_lod, state.max_lod);
    !(one.cube || other.cube || one.depends || other.depends || one.is_sprite || other.is_sprite)
        && (one.third.is_none() && other.third.is_none())
        && (one.filters, one.mixes) == (other.filters, other.mixes)
        && (!one.mixes || levels(&a.state) == levels(&b.state))
        && one.pairs + other.pairs == 0
        && (a.kind, a.levels[0]) == (b.kind, b.levels[0])
        && a.state.cylindrical_wrap == b.state.cylindrical_wrap
        // Coordinates are limited in place, so the axes have to be equal.
        && table::axes(a) == table::axes(b)
        && draw.assembly.vertices.same_coordinates(first, second)
}
