//! Programs of APIs, against the formulas of the APIs: Direct3D texture stages and pixel shaders, and the OpenGL texture environment.
//!
//! The formulas stand here a second time, in float64 and from the APIs' own text, and know nothing of combiners.

mod calls;
mod direct3d;
mod opengl;
mod pages;
mod pasted;
mod pixel_shader;
mod run;
mod scenes;

use ninebit::random::Random;

/// Choices of a seed.
struct Choices(Random);

impl Choices {
    fn new(seed: u64) -> Choices {
        Choices(Random::seeded(seed))
    }

    fn number(&mut self) -> u64 {
        self.0.bits()
    }

    fn below(&mut self, most: usize) -> usize {
        (self.number() % most as u64) as usize
    }

    fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }

    fn flag(&mut self) -> bool {
        self.number() & 1 != 0
    }

    /// Bytes, the ends of the range more often.
    fn color(&mut self) -> [u8; 4] {
        std::array::from_fn(|_| match self.below(6) {
            0 => 0,
            1 => 255,
            _ => self.number() as u8,
        })
    }
}
