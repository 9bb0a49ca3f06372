//! Tests programs of other APIs against the formulas of these APIs: Direct3D texture stages, pixel shaders, and the OpenGL texture
//! environment.
//!
//! The tests have formulas of their own in float64, written from the APIs' specifications without reference to combiners.

mod calls;
mod direct3d;
mod opengl;
mod pages;
mod pasted;
mod pixel_shader;
mod run;
mod scenes;

use ninebit::random::Random;

/// A source of random choices.
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

    /// Returns four random bytes. The ends of the range are more frequent.
    fn color(&mut self) -> [u8; 4] {
        std::array::from_fn(|_| match self.below(6) {
            0 => 0,
            1 => 255,
            _ => self.number() as u8,
        })
    }
}
