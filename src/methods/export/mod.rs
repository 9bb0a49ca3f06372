//! Scenes as methods: the words that set the same state and draw the same vertices, and the memory that they read.

mod memory;
mod print;
mod state;
mod transform;
mod units;
mod vertices;
mod words;

use std::fmt;

use ninebit::plan::Plan;
use ninebit::state::{Profile, Scene};

pub use memory::FIRST;
pub(crate) use memory::pitch;
pub use print::{push_buffer, trace};
pub use words::draw_words;

use crate::celsius;
use crate::class::{self, Family};
use crate::export::memory::MemoryMap;
use crate::vertex::{attribute, microcode};

/// A scene as methods of the 3D class.
#[derive(Clone, Debug, PartialEq)]
pub struct Methods {
    /// The family of the class.
    pub family: Family,
    /// Methods in bytes, with their words, in order.
    pub writes: Vec<(u32, u32)>,
    /// The image of memory from address 0 on that they read.
    pub memory: Vec<u8>,
    /// The places of the scene's targets in memory, in their order.
    pub surfaces: Vec<u32>,
    /// Whether the targets are swizzled.
    pub swizzled: Vec<bool>,
}

/// The reason for which a scene has no methods.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExportError {
    /// Index of the draw, if it is one draw's.
    pub draw: Option<usize>,
    /// The reason.
    pub message: String,
}

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.draw {
            Some(draw) => write!(f, "draw {draw}: {}", self.message),
            None => f.write_str(&self.message),
        }
    }
}

impl std::error::Error for ExportError {}

fn refuse<T>(message: impl Into<String>) -> Result<T, ExportError> {
    Err(ExportError { draw: None, message: message.into() })
}

/// Collects words. A word of state that is as it was is not sent again.
#[derive(Debug, Default)]
struct Words {
    family: Family,
    writes: Vec<(u32, u32)>,
    state: std::collections::HashMap<u32, u32>,
    /// Kelvin's number of the first state that the class does not have.
    lacking: Option<u32>,
}

impl Words {
    /// Sets a word of state, by Kelvin's number.
    fn set(&mut self, method: u32, word: u32) {
        match self.family {
            Family::Kelvin => self.own(method, word),
            Family::Celsius => match celsius::own(method, word) {
                Some((number, word)) => self.own(number, word),
                // Nothing to say where the class always is as the scene asks.
                None if celsius::constant(method) == Some(word) => {}
                None => _ = self.lacking.get_or_insert(method),
            },
        }
    }

    /// Sets a word of state, by the class's own number.
    fn own(&mut self, method: u32, word: u32) {
        if self.state.insert(method, word) != Some(word) {
            self.writes.push((method, word));
        }
    }

    /// Sets a word of state that is a number.
    fn number(&mut self, method: u32, number: f32) {
        self.set(method, number.to_bits());
    }

    /// Sends a word that does something, by Kelvin's number.
    fn send(&mut self, method: u32, word: u32) {
        match self.family.own(method) {
            Some(number) => self.writes.push((number, word)),
            None => _ = self.lacking.get_or_insert(method),
        }
    }
}

/// Returns the methods of a scene. `plan` is the plan of the same scene, without pruning or with. A scene of nv10 becomes methods of Celsius, which
/// has no clears: its targets begin as memory is.
///
/// # Errors
/// The scene says what no word says.
pub fn export(scene: &Scene, plan: &Plan) -> Result<Methods, ExportError> {
    let family = match scene.profile {
        Profile::Nv2a => Family::Kelvin,
        Profile::Nv10 => Family::Celsius,
    };
    let mut words = Words { family, ..Words::default() };
    let placed = MemoryMap::new(scene)?;
    match family {
        Family::Kelvin => {
            program(&mut words);
            for (index, target) in scene.targets.iter().enumerate() {
                state::clear(&mut words, &placed, index, target);
            }
        }
        Family::Celsius => transform::initial(&mut words),
    }
    for (index, draw) in scene.draws.iter().enumerate() {
        let of_draw = |error: ExportError| ExportError { draw: Some(index), ..error };
        let Some(clip) = state::surface(&mut words, scene, &placed, draw) else { continue };
        words.set(class::SET_SURFACE_CLIP_HORIZONTAL, clip.x | clip.width << 16);
        words.set(class::SET_SURFACE_CLIP_VERTICAL, clip.y | clip.height << 16);
        state::draw(&mut words, scene, draw).map_err(of_draw)?;
        units::units(&mut words, scene, &placed, draw).map_err(of_draw)?;
        let planned = &plan.draws()[index];
        vertices::vertices(&mut words, scene, draw, &planned.assembly).map_err(of_draw)?;
        if let Some(method) = words.lacking {
            let message = format!("the class of GeForce 256 has nothing in place of {}", Family::Kelvin.label(method));
            return Err(ExportError { draw: Some(index), message });
        }
    }
    if family == Family::Kelvin {
        words.send(class::FLIP_STALL, 0);
    }
    let MemoryMap { bytes: memory, surfaces, swizzled, .. } = placed;
    Ok(Methods { family, writes: words.writes, memory, surfaces, swizzled })
}

/// Sends the vertex program that hands vertices through, and makes it the transform.
fn program(words: &mut Words) {
    words.set(class::SET_TRANSFORM_EXECUTION_MODE, 2);
    words.set(class::SET_TRANSFORM_PROGRAM_LOAD, 0);
    for slot in microcode::passthrough() {
        for (part, word) in (0..).zip(slot) {
            words.send(class::SET_TRANSFORM_PROGRAM + 4 * part, word);
        }
    }
    words.set(class::SET_TRANSFORM_PROGRAM_START, 0);
    words.set(class::SET_SPECULAR_ENABLE, 1);
    words.set(class::SET_LIGHT_TWO_SIDE_ENABLE, 0);
    for attribute in 0..16 {
        // A float of no component: nothing comes from arrays.
        words.set(class::SET_VERTEX_DATA_ARRAY_FORMAT + 4 * attribute, 2);
    }
    words.set(class::SET_EDGE_FLAG, 1);
    // The program reads these whether or not a draw has them.
    words.number(vertices::SET_FOG_COORD, 0.0);
    let point_size = class::SET_VERTEX_DATA4F_M + 16 * attribute::POINT_SIZE as u32;
    (0..).zip([1.0, 0.0, 0.0, 1.0]).for_each(|(n, number)| words.number(point_size + 4 * n, number));
}
