//! The words of state of one draw, as texts read them that draw every state.

use ninebit::plan::PlannedDraw;
use ninebit::raster::fog::Curve;
use ninebit::state::{FogFunction, Scene};

use super::memory::MemoryMap;
use super::{ExportError, Words, state, units};
use crate::class::{self, Family};

/// Returns the words of state of draw `number` of a scene, with their methods: Kelvin's, but the chip's own of the combiners. `planned` is the same
/// draw of its plan. Fog whose factors the vertices have is mode 0. Addresses and vertices are not among them.
///
/// # Errors
/// The draw says what no word says.
pub fn draw_words(scene: &Scene, planned: &PlannedDraw, number: usize) -> Result<Vec<(u32, u32)>, ExportError> {
    let of_draw = |error: ExportError| ExportError { draw: Some(number), ..error };
    let mut words = Words { family: Family::Kelvin, ..Words::default() };
    let placed = MemoryMap::nowhere(scene);
    let mut draw = scene.draws[number].clone();
    let target = &scene.targets[draw.target];
    // Windows are whoever's that walks the pixels.
    draw.window_clip = None;
    let has_factors = draw.fog.enabled && draw.fog.function.is_none();
    draw.fog.enabled &= !has_factors;
    if let Some(function) = &mut draw.fog.function {
        if let Some(Curve::Line(line)) = Curve::new(function) {
            *function = FogFunction { p0: line.p0, p1: line.p1, ..*function };
        }
        function.per_vertex = false;
    }
    state::bind(&mut words, &placed, draw.target, target);
    state::draw(&mut words, scene, &draw).map_err(of_draw)?;
    units::units(&mut words, scene, &placed, &draw).map_err(of_draw)?;
    if has_factors {
        words.set(class::SET_FOG_ENABLE, 1);
        words.set(class::SET_FOG_MODE, 0);
    }
    words.set(class::SET_DEPTH_TEST_ENABLE, planned.depth_test.is_some().into());
    words.set(class::SET_STENCIL_TEST_ENABLE, planned.stencil_test.is_some().into());
    if planned.depth_test.is_some_and(|test| test.range.is_none()) {
        // No limit but that of the buffer.
        words.number(class::SET_CLIP_MAX, f32::INFINITY);
    }
    Ok(words.writes)
}
