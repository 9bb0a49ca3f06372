//! The surfaces that a draw or a clear goes into.

use ninebit::legality;
use ninebit::state::{DepthFormat, Named, Rectangle, SurfaceFormat};
use ninebit_program::registers::raster::{self, SURFACE_COLOR};

use super::view::View;
use crate::class;
use crate::gap::Gap;

/// The surfaces that are bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Surface {
    /// Address of the colours.
    pub color: u32,
    /// Format of the colours.
    pub format: SurfaceFormat,
    /// Address of the depths.
    pub zeta: u32,
    /// Format of the depths.
    pub depth: DepthFormat,
    /// The pixels that are drawn.
    pub clip: Rectangle,
    /// Columns and rows if it is swizzled.
    pub swizzled: Option<[u32; 2]>,
    /// Bytes from row to row of the colours.
    pub pitch: u32,
    /// Bytes from row to row of the depths.
    pub zeta_pitch: u32,
}

/// Reads the surfaces; `None` if the model has no such ones, which is noted.
pub(crate) fn surface(view: &mut View<'_>) -> Option<Surface> {
    let word = view.get(class::SET_SURFACE_FORMAT);
    let format = SurfaceFormat::ALL
        .iter()
        .copied()
        .find(|format| raster::surface_format(*format) == SURFACE_COLOR.value_in(word));
    let float = view.get(class::SET_CONTROL0) >> 12 & 1 != 0;
    let depth = match (word >> 4 & 0xf, float) {
        (1, false) => DepthFormat::Z16,
        (1, true) => DepthFormat::Z16F,
        (_, false) => DepthFormat::Z24S8,
        (_, true) => DepthFormat::Z24S8F,
    };
    let swizzled = (word >> 8 & 0xf == 2).then_some([16, 24].map(|shift| 1_u32 << (word >> shift & 0xf).min(12)));
    if word >> 12 & 0xf != 0 {
        view.note(Gap::NotModelled("an antialiased surface".into()));
    }
    let mut axis = |method| {
        let word = view.get(method);
        (word & 0xffff, word >> 16)
    };
    let ((x, width), (y, height)) = (axis(class::SET_SURFACE_CLIP_HORIZONTAL), axis(class::SET_SURFACE_CLIP_VERTICAL));
    let clip = Rectangle { x, y, width, height };
    let (color, zeta) = (view.get(class::SET_SURFACE_COLOR_OFFSET), view.get_or(class::SET_SURFACE_ZETA_OFFSET, 0));
    let pitches = view.get_or(class::SET_SURFACE_PITCH, 0);
    let (pitch, zeta_pitch) = (pitches & 0xffff, pitches >> 16);
    let Some(format) = format else {
        view.bad(class::SET_SURFACE_FORMAT);
        return None;
    };
    let chip = view.family().profile();
    if legality::surface::format(format, chip, None).is_some() {
        view.bad(class::SET_SURFACE_FORMAT);
        return None;
    }
    if legality::surface::depth_format(depth, chip, None).is_some() {
        view.bad(class::SET_CONTROL0);
        return None;
    }
    if width == 0 || height == 0 || x + width > 4096 || y + height > 4096 {
        let what = format!("a surface of {width} x {height} pixels at {x}, {y}");
        view.note(Gap::NotModelled(what));
        return None;
    }
    Some(Surface { color, format, zeta, depth, clip, swizzled, pitch, zeta_pitch })
}

impl Surface {
    /// Returns columns and rows that the surface has at least.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.swizzled.unwrap_or([self.clip.x + self.clip.width, self.clip.y + self.clip.height])
    }
}
